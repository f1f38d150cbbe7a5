/* The sheen of cloth: a forest of fibres that stand up from the surface.
 *
 * Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF" (SIGGRAPH course): the
 * distribution "Charlie", equation 2, and the fit of its masking, equation 3, with Fresnel left
 * out; alpha is the square of KHR_materials_sheen's roughness. Directions are in the local frame.
 */
#ifndef PPMI_SHADING_SHEEN_H
#define PPMI_SHADING_SHEEN_H

#include "math/sampling.h"

/* Below this roughness the lobe clings to the horizon and carries next to nothing. */
#define PPMI_SHEEN_LEAST_ROUGHNESS 0.05f

/* Exponent of the Lambda fit. */
static inline float ppmi_sheen_fit(float cosine, float alpha)
{
    const float t = ppmi_sqr(1.0f - alpha);
    const float a = 21.5473f + (25.3245f - 21.5473f) * t;
    const float b = 3.82987f + (3.32435f - 3.82987f) * t;
    const float c = 0.19823f + (0.16801f - 0.19823f) * t;
    const float d = -1.97760f + (-1.27393f + 1.97760f) * t;
    const float e = -4.32054f + (-4.85967f + 4.32054f) * t;
    return a / (1.0f + b * powf(cosine, c)) + d * cosine + e;
}

static inline float ppmi_sheen_lambda(float cosine, float alpha)
{
    if (cosine < 0.5f) return expf(ppmi_sheen_fit(cosine, alpha));
    return expf(2.0f * ppmi_sheen_fit(0.5f, alpha) - ppmi_sheen_fit(1.0f - cosine, alpha));
}

/* f of a white sheen by the Lambdas of both directions, which are on the upper side. */
static inline float ppmi_sheen_value(float alpha, ppmi_vec3 wo, float lambda_o, ppmi_vec3 wi,
                                     float lambda_i)
{
    const ppmi_vec3 h = vec3_normalize(vec3_add(wo, wi));
    const float inverse = 1.0f / alpha;
    const float sin2 = ppmi_max(h.x * h.x + h.y * h.y, 0.0f);
    const float d = (2.0f + inverse) * powf(sin2, 0.5f * inverse) / (2.0f * PPMI_PI);
    return d / ((1.0f + lambda_o + lambda_i) * 4.0f * wo.z * wi.z);
}

#endif
