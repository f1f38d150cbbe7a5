/* Colours into the working space. */
#include "base/working_space.h"

#include <math.h>
#include <string.h>

/* ITU-R BT.709 and IEC 61966-2-1. */
const ppmi_working_space ppmi_working_space_rec709 = {
    .differs = false,
    .name = "Linear Rec.709 (sRGB)",
    .interop_id = "lin_rec709_scene",
    .from_rec709 = {1, 0, 0, 0, 1, 0, 0, 0, 1},
    .to_rec709 = {1, 0, 0, 0, 1, 0, 0, 0, 1},
    .from_xyz = {3.2404542f, -1.5371385f, -0.4985314f, -0.9692660f, 1.8760108f, 0.0415560f,
                 0.0556434f, -0.2040259f, 1.0572252f},
    .chromaticities = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f},
};

void ppmi_matrix_apply(const float m[9], const float in[3], float out[3])
{
    const float r = in[0], g = in[1], b = in[2];
    for (int i = 0; i < 3; i++)
        out[i] = m[3 * i] * r + m[3 * i + 1] * g + m[3 * i + 2] * b;
}

void ppmi_working_light(const ppmi_working_space *space, const float rec709[3], float out[3])
{
    if (!space->differs) {
        memmove(out, rec709, 3 * sizeof *out);
        return;
    }
    ppmi_matrix_apply(space->from_rec709, rec709, out);
    for (int i = 0; i < 3; i++)
        out[i] = fmaxf(out[i], 0.0f);
}

void ppmi_working_reflectance(const ppmi_working_space *space, const float rec709[3], float out[3])
{
    ppmi_working_light(space, rec709, out);
    if (!space->differs) return;
    for (int i = 0; i < 3; i++)
        out[i] = fminf(out[i], 1.0f);
}

void ppmi_working_medium(const ppmi_working_space *space, const float sigma_s[3],
                         const float sigma_a[3], float out_sigma_s[3], float out_sigma_a[3])
{
    float left[3], albedo[3], mean = 0;
    for (int i = 0; i < 3; i++)
        mean += (sigma_s[i] + sigma_a[i]) / 3;
    if (!space->differs || !(mean > 0)) {
        memmove(out_sigma_s, sigma_s, 3 * sizeof *sigma_s);
        memmove(out_sigma_a, sigma_a, 3 * sizeof *sigma_a);
        return;
    }
    for (int i = 0; i < 3; i++) {
        const float sigma_t = sigma_s[i] + sigma_a[i];
        left[i] = expf(-sigma_t / mean);
        albedo[i] = sigma_t > 0 ? sigma_s[i] / sigma_t : 0;
    }
    ppmi_working_reflectance(space, left, left);
    ppmi_working_reflectance(space, albedo, albedo);
    for (int i = 0; i < 3; i++) {
        const float sigma_t = -logf(fmaxf(left[i], 1e-30f)) * mean;
        out_sigma_s[i] = sigma_t * albedo[i];
        out_sigma_a[i] = sigma_t - out_sigma_s[i];
    }
}
