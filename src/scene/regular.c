/* The cofactors of a matrix M = U S V' are, up to sign, U S* V', where S* has the products of each
 * two singular values. Where the third is 0 they are s1 s2 u3 v3': the direction that is lost, in
 * the world (u3) and in the mesh (v3). M + d u3 v3' has d in its place. */
#include "scene/regular.h"

#include <math.h>
#include <string.h>

/* Of the longest column: below it the rounding of a turned matrix is as large. */
static const double THINNEST = 5e-7;
/* Of two singular values: below it a shape is a line. */
static const double LINE = 1e-12;

typedef double columns[3][3];

static void load(const ppmi_transform *m, columns out)
{
    const ppmi_vec3 from[3] = {m->x, m->y, m->z};
    for (int i = 0; i < 3; i++) {
        out[i][0] = (double)from[i].x;
        out[i][1] = (double)from[i].y;
        out[i][2] = (double)from[i].z;
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Divides by the longest column, which is returned: products of three stay within doubles. */
static double normalize(columns m)
{
    double longest = 0.0;
    for (int i = 0; i < 3; i++)
        longest = fmax(longest, sqrt(dot(m[i], m[i])));
    for (int i = 0; i < 9 && longest > 0.0; i++)
        m[i / 3][i % 3] /= longest;
    return longest;
}

static void cofactors(columns m, columns out)
{
    for (int i = 0; i < 3; i++)
        cross(m[(i + 1) % 3], m[(i + 2) % 3], out[i]);
}

static double norm(columns m)
{
    return sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]));
}

/* Adds thickness along the direction that is lost, on the side of the determinant. */
static void thicken(columns m, columns c, double thickness)
{
    int largest = 0;
    for (int i = 1; i < 3; i++)
        if (dot(c[i], c[i]) > dot(c[largest], c[largest])) largest = i;
    const double length = sqrt(dot(c[largest], c[largest])), size = norm(c);
    const double sign = dot(m[0], c[0]) < 0.0 ? -1.0 : 1.0;
    for (int i = 0; i < 3; i++) {
        const double v = dot(c[i], c[largest]) / (length * size);
        for (int k = 0; k < 3; k++)
            m[i][k] += sign * thickness * v * c[largest][k] / length;
    }
}

static ppmi_vec3 scaled(const double v[3], double by)
{
    return vec3((float)(v[0] * by), (float)(v[1] * by), (float)(v[2] * by));
}

bool ppmi_make_regular(ppmi_transform *m)
{
    columns unit, c;
    load(m, unit);
    const double longest = normalize(unit);
    if (!(longest > 0.0)) return false;
    cofactors(unit, c);
    const double size = norm(c);
    if (!(size > LINE)) return false;
    if (fabs(dot(unit[0], c[0])) >= THINNEST * size) return true;
    thicken(unit, c, THINNEST);
    m->x = scaled(unit[0], longest);
    m->y = scaled(unit[1], longest);
    m->z = scaled(unit[2], longest);
    return true;
}

double ppmi_least_stretch(const ppmi_transform *m)
{
    columns unit, c;
    load(m, unit);
    const double longest = normalize(unit);
    cofactors(unit, c);
    const double size = norm(c);
    return size > 0.0 ? longest * fabs(dot(unit[0], c[0])) / size : 0.0;
}

static double determinant_at(columns a, columns b, double share)
{
    columns m, c;
    for (int i = 0; i < 9; i++)
        m[i / 3][i % 3] = (1.0 - share) * a[i / 3][i % 3] + share * b[i / 3][i % 3];
    cofactors(m, c);
    return dot(m[0], c[0]);
}

/* The determinant on the way is a cubic in the share of the way: least at its ends or where its
 * derivative is 0. */
bool ppmi_stays_regular(const ppmi_transform *from, const ppmi_transform *to)
{
    columns a, b;
    load(from, a);
    load(to, b);
    const double size = normalize(a);
    for (int i = 0; i < 9 && size > 0.0; i++)
        b[i / 3][i % 3] /= size;
    const double f0 = determinant_at(a, b, 0.0), f1 = determinant_at(a, b, 1.0);
    const double g = determinant_at(a, b, 0.5), h = determinant_at(a, b, 2.0);
    if (f0 * f1 <= 0.0) return false;
    /* f0 + p t + q t^2 + r t^3 through 1/2, 1 and 2 */
    const double u = f1 - f0, v = 8.0 * (g - f0), w = 0.5 * (h - f0);
    const double r = (v - 4.0 * u + 2.0 * (w - u)) / 3.0;
    const double q = (w - u) - 3.0 * r, p = u - q - r;
    const double root = q * q - 3.0 * p * r, least = 1e-4 * fmin(fabs(f0), fabs(f1));
    if (root < 0.0) return true;
    const double s = -(q + copysign(sqrt(root), q));
    const double places[2] = {s != 0.0 ? p / s : -1.0, r != 0.0 ? s / (3.0 * r) : -1.0};
    for (int i = 0; i < 2; i++) {
        if (!(places[i] > 0.0 && places[i] < 1.0)) continue;
        if (determinant_at(a, b, places[i]) * copysign(1.0, f0) < least) return false;
    }
    return true;
}
