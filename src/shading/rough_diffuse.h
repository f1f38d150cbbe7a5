/* A rough diffuse surface: V-shaped grooves of Lambert's facets, with the light that goes to and
 * fro in them (EON: Portsmouth, Kutz and Hill 2025, "EON: A practical energy-preserving rough
 * diffuse BRDF", JCGT 14.1). A roughness of 0 is Lambert.
 *
 * All is told by Lambert's f = color / pi: a factor of it, so that what lies above and what shares
 * the base multiplies it as before. Directions are local, on the upper side; lost_o and lost_i are
 * 1 - E of the single scattering, of wo and of wi. */
#ifndef PPMI_SHADING_ROUGH_DIFFUSE_H
#define PPMI_SHADING_ROUGH_DIFFUSE_H

#include <math.h>

#include "math/vec.h"

/* A of the fujii model, whose B is roughness times that: what is left of Lambert seen straight. */
static inline float ppmi_rough_diffuse_scale(float roughness)
{
    return 1.0f / (1.0f + (0.5f - 2.0f / 3.0f * PPMI_INV_PI) * roughness);
}

/* What single scattering loses of light from a direction of this cosine: 1 - E (equation 14,
 * exact).
 */
static inline float ppmi_rough_diffuse_lost(float roughness, float cosine)
{
    const float c = ppmi_clampf(cosine, 1e-4f, 1.0f), s2 = 1.0f - c * c, s = sqrtf(s2);
    const float g = s * (acosf(c) - s * c) + 2.0f / 3.0f * (s / c * (1.0f - s * s2) - s);
    return 1.0f - ppmi_rough_diffuse_scale(roughness) * (1.0f + roughness * g * PPMI_INV_PI);
}

/* The same of even light from all directions (equation 16). */
static inline float ppmi_rough_diffuse_lost_average(float roughness)
{
    const float slope = 2.0f / 3.0f - 28.0f / 15.0f * PPMI_INV_PI;
    return 1.0f - ppmi_rough_diffuse_scale(roughness) * (1.0f + slope * roughness);
}

/* What scattering more than once brings back of the light that is lost, by a share of the color:
 * colors that absorb lose more each time (equation 19). */
static inline ppmi_vec3 ppmi_rough_diffuse_returned(float lost_average, ppmi_vec3 color)
{
    const float e = 1.0f - lost_average;
    return vec3(color.x * e / (1.0f - color.x * lost_average),
                color.y * e / (1.0f - color.y * lost_average),
                color.z * e / (1.0f - color.z * lost_average));
}

/* f by that of Lambert: equations 13 (single scattering) and 18. */
static inline ppmi_vec3 ppmi_rough_diffuse_factor(float roughness, ppmi_vec3 color, float lost_o,
                                                  ppmi_vec3 wo, ppmi_vec3 wi)
{
    const float s = wo.x * wi.x + wo.y * wi.y;
    const float s_by_t = s > 0.0f ? s / ppmi_max(wo.z, wi.z) : s;
    const float single = ppmi_rough_diffuse_scale(roughness) * (1.0f + roughness * s_by_t);
    const float lost_i = ppmi_rough_diffuse_lost(roughness, wi.z);
    const float average = ppmi_rough_diffuse_lost_average(roughness);
    const float multiple = ppmi_max(lost_o, 0.0f) * ppmi_max(lost_i, 0.0f) / average;
    return vec3_mad(vec3_splat(single), ppmi_rough_diffuse_returned(average, color), multiple);
}

/* Albedo by that of Lambert. */
static inline ppmi_vec3 ppmi_rough_diffuse_albedo(float roughness, ppmi_vec3 color, float lost_o)
{
    const float average = ppmi_rough_diffuse_lost_average(roughness);
    return vec3_mad(vec3_splat(1.0f - lost_o), ppmi_rough_diffuse_returned(average, color), lost_o);
}

#endif
