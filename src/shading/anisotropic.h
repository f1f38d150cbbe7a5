/* GGX with two widths: alpha.x along the local x axis, alpha.y along y. Directions are in the local
 * frame, normal (0, 0, 1).
 *
 * Burley 2012, "Physically-Based Shading at Disney", the addenda, for the distribution; Heitz 2014,
 * "Understanding the Masking-Shadowing Function" (JCGT 3.2), section 5.4, for masking; Dupuy and
 * Benyoub 2023 for sampling. */
#ifndef PPMI_SHADING_ANISOTROPIC_H
#define PPMI_SHADING_ANISOTROPIC_H

#include "shading/microfacet.h"

/* Distribution of normals for a unit h. */
static inline float ppmi_ggx2_d(ppmi_vec2 alpha, ppmi_vec3 h)
{
    const float x = h.x / alpha.x, y = h.y / alpha.y;
    const float c = x * x + y * y + h.z * h.z;
    return h.z > 0.0f ? 1.0f / (PPMI_PI * alpha.x * alpha.y * c * c) : 0.0f;
}

/* Smith's Lambda of a direction on the upper side. */
static inline float ppmi_ggx2_lambda(ppmi_vec2 alpha, ppmi_vec3 w)
{
    const float stretched2 = ppmi_sqr(alpha.x * w.x) + ppmi_sqr(alpha.y * w.y);
    return 0.5f * (sqrtf(1.0f + stretched2 / ppmi_max(w.z * w.z, 1e-12f)) - 1.0f);
}

static inline float ppmi_ggx2_g2(ppmi_vec2 alpha, ppmi_vec3 wo, ppmi_vec3 wi)
{
    return 1.0f / (1.0f + ppmi_ggx2_lambda(alpha, wo) + ppmi_ggx2_lambda(alpha, wi));
}

/* Density of normals visible from wo. */
static inline float ppmi_ggx2_visible_d(ppmi_vec2 alpha, ppmi_vec3 wo, ppmi_vec3 h)
{
    const float cos_oh = vec3_dot(wo, h);
    if (cos_oh <= 0.0f || wo.z <= 0.0f) return 0.0f;
    return cos_oh * ppmi_ggx2_d(alpha, h) / (wo.z * (1.0f + ppmi_ggx2_lambda(alpha, wo)));
}

/* Draws a visible normal. wo.z > 0. */
static inline ppmi_vec3 ppmi_ggx2_sample_visible(ppmi_vec2 alpha, ppmi_vec3 wo, float u, float v)
{
    const ppmi_vec3 w = vec3_normalize(vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
    const ppmi_vec3 h = vec3_add(ppmi_ggx_sample_cap(w, u, v), w);
    return vec3_normalize(vec3(alpha.x * h.x, alpha.y * h.y, ppmi_max(h.z, 1e-9f)));
}

#endif
