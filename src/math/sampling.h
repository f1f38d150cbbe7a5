/* Maps from the unit square to the domains that are sampled. All have the stated density. */
#ifndef PPMI_MATH_SAMPLING_H
#define PPMI_MATH_SAMPLING_H

#include "math/vec.h"

typedef struct ppmi_vec2 {
    float x, y;
} ppmi_vec2;

/* Uniform on the unit disk; Shirley and Chiu 1997, "A Low Distortion Map". */
static inline ppmi_vec2 ppmi_sample_disk(float u, float v)
{
    const float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
    if (a == 0.0f && b == 0.0f) return (ppmi_vec2){0.0f, 0.0f};
    float r, phi;
    if (fabsf(a) > fabsf(b)) {
        r = a;
        phi = (PPMI_PI / 4.0f) * (b / a);
    } else {
        r = b;
        phi = (PPMI_PI / 2.0f) - (PPMI_PI / 4.0f) * (a / b);
    }
    return (ppmi_vec2){r * cosf(phi), r * sinf(phi)};
}

/* Density cos(theta) / pi on the hemisphere around +z (Malley's method). */
static inline ppmi_vec3 ppmi_sample_cosine_hemisphere(float u, float v)
{
    const ppmi_vec2 d = ppmi_sample_disk(u, v);
    return vec3(d.x, d.y, sqrtf(ppmi_max(0.0f, 1.0f - d.x * d.x - d.y * d.y)));
}

/* The direction with the given cosine to +z, at azimuth 2 pi v. */
static inline ppmi_vec3 ppmi_direction_at(float cos_theta, float v)
{
    const float sin_theta = sqrtf(ppmi_max(0.0f, 1.0f - cos_theta * cos_theta));
    const float phi = 2.0f * PPMI_PI * v;
    return vec3(sin_theta * cosf(phi), sin_theta * sinf(phi), cos_theta);
}

/* Density 1 / (4 pi). */
static inline ppmi_vec3 ppmi_sample_sphere(float u, float v)
{
    return ppmi_direction_at(1.0f - 2.0f * u, v);
}

/* Density 1 / (2 pi height) on the part of the unit sphere with z >= 1 - height; exact for caps so
 * small that a cosine could not tell their points apart. */
static inline ppmi_vec3 ppmi_sample_cap(float height, float u, float v)
{
    const float depth = u * height;
    const float sin_theta = sqrtf(depth * (2.0f - depth)), phi = 2.0f * PPMI_PI * v;
    return vec3(sin_theta * cosf(phi), sin_theta * sinf(phi), 1.0f - depth);
}

/* Density 1 / (2 pi (1 - cos_max)) on the cone around +z. */
static inline ppmi_vec3 ppmi_sample_cone(float cos_max, float u, float v)
{
    return ppmi_direction_at(1.0f - u * (1.0f - cos_max), v);
}

/* Barycentric weights (of the second and third vertex), uniform over a triangle; Heitz 2019,
 * "A Low-Distortion Map Between Triangle and Square". */
static inline ppmi_vec2 ppmi_sample_triangle(float u, float v)
{
    if (v > u) {
        u *= 0.5f;
        v -= u;
    } else {
        v *= 0.5f;
        u -= v;
    }
    return (ppmi_vec2){u, v};
}

/* Power heuristic, exponent 2 (Veach 1997, section 9.2.4). */
static inline float ppmi_mis_weight(float pdf, float other_pdf)
{
    if (!(pdf > 0.0f)) return 0.0f;
    const float ratio = other_pdf / pdf; /* the densities' own squares may overflow */
    return isinf(pdf) ? 1.0f : 1.0f / (1.0f + ratio * ratio);
}

#endif
