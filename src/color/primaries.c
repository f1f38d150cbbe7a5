/* Chromaticities to matrices. */
#include "color/primaries.h"

#include <math.h>
#include <string.h>

/* ITU-R BT.709, SMPTE EG 432-1 with D65, ITU-R BT.2020. */
const ppmi_primaries ppmi_primaries_rec709 = {{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}};
const ppmi_primaries ppmi_primaries_p3_d65 = {
    {0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290}};
const ppmi_primaries ppmi_primaries_rec2020 = {
    {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}};

const ppmi_known_primaries *ppmi_primaries_known(int index)
{
    static const ppmi_known_primaries known[] = {
        {"lin_rec709_scene", {{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}}},
        /* S-2014-004 and SMPTE ST 2065-1 */
        {"lin_ap1_scene", {{0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767}}},
        {"lin_ap0_scene", {{0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.0770, 0.32168, 0.33767}}},
        {"lin_p3d65_scene", {{0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290}}},
        {"lin_rec2020_scene", {{0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}}},
        {"lin_adobergb_scene", {{0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.3290}}},
    };
    const int count = (int)(sizeof known / sizeof known[0]);
    return index >= 0 && index < count ? &known[index] : NULL;
}

void ppmi_matrix_multiply(const double a[9], const double b[9], double out[9])
{
    double product[9];
    for (int i = 0; i < 9; i++) {
        const double *const row = a + i / 3 * 3, *const column = b + i % 3;
        product[i] = row[0] * column[0] + row[1] * column[3] + row[2] * column[6];
    }
    memcpy(out, product, sizeof product);
}

bool ppmi_matrix_invert(const double m[9], double out[9])
{
    double cofactors[9];
    for (int i = 0; i < 9; i++) { /* transposed; the cyclic order gives the signs */
        const int r1 = (i % 3 + 1) % 3, r2 = (i % 3 + 2) % 3;
        const int c1 = (i / 3 + 1) % 3, c2 = (i / 3 + 2) % 3;
        cofactors[i] = m[3 * r1 + c1] * m[3 * r2 + c2] - m[3 * r1 + c2] * m[3 * r2 + c1];
    }
    const double determinant = m[0] * cofactors[0] + m[1] * cofactors[3] + m[2] * cofactors[6];
    if (!(fabs(determinant) > 1e-9) || isinf(determinant)) return false;
    for (int i = 0; i < 9; i++)
        out[i] = cofactors[i] / determinant;
    return true;
}

static void xyz_of(const double xy[2], double out[3])
{
    out[0] = xy[0] / xy[1];
    out[1] = 1;
    out[2] = (1 - xy[0] - xy[1]) / xy[1];
}

static void apply(const double m[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
}

bool ppmi_primaries_to_xyz(const ppmi_primaries *primaries, double out[9])
{
    const double *const xy = primaries->xy;
    double columns[9], inverse[9], white[3], scale[3];
    for (int i = 0; i < 8; i++) {
        if (!(fabs(xy[i]) < 10)) return false;
    }
    if (!(xy[7] > 0)) return false;
    for (int i = 0; i < 3; i++) { /* as x, y, z: a primary's y may be 0 */
        columns[i] = xy[2 * i];
        columns[3 + i] = xy[2 * i + 1];
        columns[6 + i] = 1 - xy[2 * i] - xy[2 * i + 1];
    }
    if (!ppmi_matrix_invert(columns, inverse)) return false;
    xyz_of(xy + 6, white);
    apply(inverse, white, scale);
    for (int i = 0; i < 9; i++)
        out[i] = columns[i] * scale[i % 3];
    return true;
}

void ppmi_white_adaptation(const double from_xy[2], const double to_xy[2], double out[9])
{
    static const double bradford[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                       0.0367, 0.0389, -0.0685, 1.0296};
    double inverse[9], from[3], to[3], from_cone[3], to_cone[3], scaled[9];
    xyz_of(from_xy, from);
    xyz_of(to_xy, to);
    apply(bradford, from, from_cone);
    apply(bradford, to, to_cone);
    for (int i = 0; i < 9; i++)
        scaled[i] = bradford[i] * to_cone[i / 3] / from_cone[i / 3];
    ppmi_matrix_invert(bradford, inverse);
    ppmi_matrix_multiply(inverse, scaled, out);
}

bool ppmi_primaries_between(const ppmi_primaries *from, const ppmi_primaries *to, double out[9])
{
    double from_rgb[9], to_rgb[9], adaptation[9];
    if (!ppmi_primaries_to_xyz(from, from_rgb) || !ppmi_primaries_to_xyz(to, to_rgb) ||
        !ppmi_matrix_invert(to_rgb, to_rgb)) {
        return false;
    }
    ppmi_white_adaptation(from->xy + 6, to->xy + 6, adaptation);
    ppmi_matrix_multiply(adaptation, from_rgb, out);
    ppmi_matrix_multiply(to_rgb, out, out);
    return true;
}
