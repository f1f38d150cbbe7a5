/* GGX (Trowbridge-Reitz): distribution, height-correlated Smith masking, visible-normal sampling,
 * and Fresnel. Directions are in the local frame, normal (0, 0, 1).
 *
 * Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces" (EGSR); Heitz 2014,
 * "Understanding the Masking-Shadowing Function" (JCGT 3.2); Dupuy and Benyoub 2023, "Sampling
 * Visible GGX Normals with Spherical Caps" (CGF 42). */
#ifndef PPMI_SHADING_MICROFACET_H
#define PPMI_SHADING_MICROFACET_H

#include "math/sampling.h"

/* Below this GGX alpha a lobe is a mirror: its width is under a tenth of a degree. */
#define PPMI_SMOOTH_ALPHA 1e-3f

/* Distribution of normals, equation 33 of Walter et al., for a unit h. With x^2 + y^2 for
 * 1 - cos^2 nothing cancels near the peak of a narrow lobe. */
static inline float ppmi_ggx_d(float alpha, ppmi_vec3 h)
{
    const float alpha2 = alpha * alpha;
    const float c = alpha2 * h.z * h.z + h.x * h.x + h.y * h.y;
    return h.z > 0.0f ? alpha2 / (PPMI_PI * c * c) : 0.0f;
}

/* Smith's Lambda. */
static inline float ppmi_ggx_lambda(float alpha, float cos_theta)
{
    const float cos2 = cos_theta * cos_theta;
    const float tan2 = ppmi_max(0.0f, 1.0f - cos2) / ppmi_max(cos2, 1e-12f);
    return 0.5f * (sqrtf(1.0f + alpha * alpha * tan2) - 1.0f);
}

static inline float ppmi_ggx_g1(float alpha, float cos_theta)
{
    return 1.0f / (1.0f + ppmi_ggx_lambda(alpha, cos_theta));
}

/* Height-correlated masking and shadowing, both directions on the upper side. */
static inline float ppmi_ggx_g2(float alpha, float cos_o, float cos_i)
{
    return 1.0f / (1.0f + ppmi_ggx_lambda(alpha, cos_o) + ppmi_ggx_lambda(alpha, cos_i));
}

/* Density of normals visible from wo: G1(wo) max(0, wo.h) D(h) / wo.z. */
static inline float ppmi_ggx_visible_d(float alpha, ppmi_vec3 wo, ppmi_vec3 h)
{
    const float cos_oh = vec3_dot(wo, h);
    if (cos_oh <= 0.0f || wo.z <= 0.0f) return 0.0f;
    return ppmi_ggx_g1(alpha, wo.z) * cos_oh * ppmi_ggx_d(alpha, h) / wo.z;
}

/* A direction evenly over the spherical cap above -w. */
static inline ppmi_vec3 ppmi_ggx_sample_cap(ppmi_vec3 w, float u, float v)
{
    const float phi = 2.0f * PPMI_PI * u;
    const float z = (1.0f - v) * (1.0f + w.z) - w.z;
    const float sin_theta = sqrtf(ppmi_clampf(1.0f - z * z, 0.0f, 1.0f));
    return vec3(sin_theta * cosf(phi), sin_theta * sinf(phi), z);
}

/* Draws a visible normal. wo.z > 0. */
static inline ppmi_vec3 ppmi_ggx_sample_visible(float alpha, ppmi_vec3 wo, float u, float v)
{
    const ppmi_vec3 w = vec3_normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    const ppmi_vec3 h = vec3_add(ppmi_ggx_sample_cap(w, u, v), w);
    return vec3_normalize(vec3(alpha * h.x, alpha * h.y, ppmi_max(h.z, 1e-9f)));
}

/* Fresnel reflectance of a dielectric, unpolarised. eta: index behind the surface by the one in
 * front of it; cos_i > 0. *out_cos_t gets the cosine of the refracted ray, 0 at total reflection.
 */
static inline float ppmi_fresnel_dielectric(float cos_i, float eta, float *out_cos_t)
{
    const float sin2_t = ppmi_max(0.0f, 1.0f - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1.0f) {
        *out_cos_t = 0.0f;
        return 1.0f;
    }
    const float cos_t = sqrtf(1.0f - sin2_t);
    *out_cos_t = cos_t;
    const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/* (1 - c)^5 of Schlick 1994. */
static inline float ppmi_schlick_weight(float cos_theta)
{
    const float m = ppmi_clampf(1.0f - cos_theta, 0.0f, 1.0f);
    return m * m * m * m * m;
}

/* Schlick's curve up to 1. */
static inline float ppmi_schlick(float f0, float cos_theta)
{
    return f0 + (1.0f - f0) * ppmi_schlick_weight(cos_theta);
}

/* Of metals with another colour at their edges: F = schlick - coefficient * shape, where the shape
 * is that of Lazanyi and Szirmay-Kalos 2005 and the coefficient makes F that of Schlick times edge
 * at 82 degrees, a cosine of 1/7 (Kutz, Hasan and Edmondson 2021, "Novel aspects of the Adobe
 * Standard Material"). */
static inline float ppmi_f82_shape(float cos_theta)
{
    const float m = ppmi_clampf(1.0f - cos_theta, 0.0f, 1.0f);
    return cos_theta * m * m * m * m * m * m;
}

static inline float ppmi_f82_coefficient(float f0, float edge)
{
    const float cosine = 1.0f / 7.0f;
    return ppmi_schlick(f0, cosine) * (1.0f - edge) / ppmi_f82_shape(cosine);
}

/* Reflection at a facet. */
static inline ppmi_vec3 ppmi_reflect_about(ppmi_vec3 wo, ppmi_vec3 h)
{
    return vec3_sub(vec3_scale(h, 2.0f * vec3_dot(wo, h)), wo);
}

/* Refraction at a facet; cos_t from Fresnel. */
static inline ppmi_vec3 ppmi_refract_about(ppmi_vec3 wo, ppmi_vec3 h, float eta, float cos_t)
{
    return vec3_mad(vec3_scale(wo, -1.0f / eta), h, vec3_dot(wo, h) / eta - cos_t);
}

#endif
