/* What a coat does to light that crosses it: it absorbs, by the length of the way, and it reflects
 * to and fro between its surface and what lies below, which darkens that.
 *
 * KHR_materials_coat (draft); OpenPBR 1.1, "Coat". */
#ifndef PPMI_SHADING_COAT_H
#define PPMI_SHADING_COAT_H

#include <math.h>

#include "math/vec.h"

/* Reflectance seen straight. An index of 0 reflects everything, as KHR_materials_ior has it. */
static inline float ppmi_coat_f0(float ior)
{
    if (ior == 0.0f) return 1.0f;
    const float index = ppmi_max(ior, 1.0f), root = (index - 1.0f) / (index + 1.0f);
    return root * root;
}

/* Length of the way through the coat by that of the way straight down, of a direction outside. */
static inline float ppmi_coat_path(float ior, float cosine)
{
    if (ior == 0.0f) return 1.0f;
    const float index = ppmi_max(ior, 1.0f);
    const float cos2_t = 1.0f - (1.0f - cosine * cosine) / (index * index);
    return 1.0f / sqrtf(ppmi_max(cos2_t, 1e-6f));
}

/* Its mean over even light: the integral of 2 c / cos_t over the cosine c. */
static inline float ppmi_coat_mean_path(float ior)
{
    if (ior == 0.0f) return 1.0f;
    const float index = ppmi_max(ior, 1.0f), index2 = index * index;
    return 2.0f * index2 * (1.0f - sqrtf(1.0f - 1.0f / index2));
}

/* What is left of light that has gone half of the way in and out that tint stands for, times
 * path. */
static inline ppmi_vec3 ppmi_coat_transmittance(ppmi_vec3 tint, float path)
{
    return vec3(powf(tint.x, 0.5f * path), powf(tint.y, 0.5f * path), powf(tint.z, 0.5f * path));
}

/* The share of diffuse light from below that the coat's surface sends back down: 1 - (1 - E) /
 * index^2 with E what it reflects of diffuse light from outside, by d'Eon's fit (2021, "An Analytic
 * BRDF for Materials with Spherical Lambertian Scatterers"). */
static inline float ppmi_coat_internal_diffuse(float ior)
{
    const float n = ppmi_clampf(ior == 0.0f ? 3.0f : ior, 1.0f, 3.0f);
    const float e = logf((10893.0f * n - 1438.2f) / ((10212.0f - 774.4f * n) * n + 1.0f));
    return 1.0f - (1.0f - ppmi_clampf(e, 0.0f, 1.0f)) / (n * n);
}

/* What is left of light that a base of this albedo returns, of which the coat sends the share
 * internal back to it each time, by what it would be if all came out at once. */
static inline float ppmi_coat_darkening(float albedo, float internal)
{
    return (1.0f - internal) / (1.0f - albedo * internal);
}

#endif
