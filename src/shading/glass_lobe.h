/* The rough interface of glass: reflection and refraction by GGX facets (Walter et al. 2007,
 * "Microfacet Models for Refraction through Rough Surfaces"), and what single scattering loses,
 * given back on both sides (Kulla and Conty 2017). Its Fresnel terms serve smooth glass too.
 * Directions are in the local frame. For bsdf.c alone, which inlines it. */
#ifndef PPMI_SHADING_GLASS_LOBE_H
#define PPMI_SHADING_GLASS_LOBE_H

#include "shading/bsdf.h"
#include "shading/layers.h"
#include "shading/microfacet.h"

/* ---- building -------------------------------------------------------------------------------- */

/* 1 - E of a rough glass lobe on the side where eta is the index beyond. A thin sheet transmits
 * what it reflects, mirrored: its E is that of a surface that reflects all. */
static inline float ppmi_glass_lobe_lost(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                         float eta, float cosine)
{
    if (!bsdf->is_thin) return ppmi_glass_lost(albedo->glass, bsdf->roughness, eta, cosine);
    const ppmi_albedo_pair pair = ppmi_albedo_directional(albedo, bsdf->roughness, cosine);
    return ppmi_max(1.0f - pair.a - pair.b, 0.0f);
}

static inline float ppmi_glass_lobe_lost_average(const ppmi_bsdf *bsdf,
                                                 const ppmi_albedo_table *albedo, float eta)
{
    if (!bsdf->is_thin) return ppmi_glass_lost_average(albedo->glass, bsdf->roughness, eta);
    const ppmi_albedo_pair pair = ppmi_albedo_average(albedo, bsdf->roughness);
    return ppmi_max(1.0f - pair.a - pair.b, 0.0f);
}

/* What single scattering loses comes back on both sides, by m(w) = 1 - E(w) of either direction
 * (Kulla and Conty 2017). With M the mean of m, weighted by the cosine, and a share t of it that
 * goes through,
 *
 *     f(o, i) = (1 - t) m(o) m(i) / (pi M)    on o's side,
 *     f(o, i) = t m(o) m'(i) / (pi M')        beyond (primed), for power,
 *
 * all that is lost comes back. It is the same both ways if t / (n'^2 M') = t' / (n^2 M), n the
 * index. Fresnel's mean transmittance T has n^2 T = n'^2 T'; so t = T min(1, M' / M). */
__attribute__((noinline)) static void ppmi_glass_lobe_make(ppmi_bsdf *bsdf,
                                                           const ppmi_albedo_table *albedo)
{
    const float eta = bsdf->eta, beyond = bsdf->is_thin ? eta : 1.0f / eta;
    const float here_average = ppmi_max(ppmi_glass_lobe_lost_average(bsdf, albedo, eta), 1e-7f);
    const float beyond_average =
        ppmi_max(ppmi_glass_lobe_lost_average(bsdf, albedo, beyond), 1e-7f);
    float through = bsdf->is_thin ? ppmi_glass_sheet_transmitted_average(albedo->glass, eta)
                                  : ppmi_glass_transmitted_average(albedo->glass, eta);
    through *= ppmi_min(1.0f, beyond_average / here_average);
    bsdf->glass_lost = ppmi_glass_lobe_lost(bsdf, albedo, eta, bsdf->wo.z);
    bsdf->glass_returned = 1.0f - through;
    const float lost = bsdf->glass_weight * bsdf->glass_lost * PPMI_INV_PI;
    bsdf->glass_back = lost * (1.0f - through) / here_average;
    bsdf->glass_through = lost * through / beyond_average;
}

/* ---- evaluation ------------------------------------------------------------------------------ */

/* Reflectance of a thin sheet: both faces and the light that goes to and fro between them,
 * R + T R T + T R^3 T + ... = 2 R / (1 + R). */
static inline float ppmi_glass_fold_faces(const ppmi_bsdf *bsdf, float r)
{
    return bsdf->is_thin ? 2.0f * r / (1.0f + r) : r;
}

/* Under a film reflection has a colour. */
static inline ppmi_vec3 ppmi_glass_film_reflectance(const ppmi_bsdf *bsdf, float cos_h)
{
    float cos_t;
    const float r = ppmi_fresnel_dielectric(cos_h, bsdf->eta, &cos_t);
    if (cos_t == 0.0f) return vec3_splat(1.0f);
    const ppmi_vec3 film = ppmi_layers_glass(bsdf, r, bsdf->eta < 1.0f ? cos_t : cos_h);
    return vec3(ppmi_glass_fold_faces(bsdf, film.x), ppmi_glass_fold_faces(bsdf, film.y),
                ppmi_glass_fold_faces(bsdf, film.z));
}

/* What is not transmitted; under a film the most of all channels. */
static inline float ppmi_glass_reflectance(const ppmi_bsdf *bsdf, float cos_h, float *out_cos_t)
{
    const float r = ppmi_fresnel_dielectric(cos_h, bsdf->eta, out_cos_t);
    if (ppmi_layers_have_film(bsdf))
        return vec3_max_component(ppmi_glass_film_reflectance(bsdf, cos_h));
    return ppmi_glass_fold_faces(bsdf, r);
}

/* What is reflected, where ppmi_glass_reflectance is reflectance. */
static inline ppmi_vec3 ppmi_glass_tone(const ppmi_bsdf *bsdf, float cos_h, float reflectance)
{
    return ppmi_layers_have_film(bsdf) ? ppmi_glass_film_reflectance(bsdf, cos_h)
                                       : vec3_splat(reflectance);
}

/* A thin sheet's transmission lobe is the reflection lobe, flipped through the sheet. */
static inline ppmi_vec3 ppmi_glass_thin_fold(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    return bsdf->is_thin && wi.z < 0.0f ? vec3(wi.x, wi.y, -wi.z) : wi;
}

/* The half vector of a direction pair, on the side of wo; for refraction equation 16 of Walter et
 * al. False where no microfacet connects the two. */
static inline bool ppmi_glass_half(const ppmi_bsdf *bsdf, ppmi_vec3 wi, ppmi_vec3 *out_h)
{
    const bool is_reflection = wi.z > 0.0f;
    ppmi_vec3 h = is_reflection ? vec3_add(bsdf->wo, wi) : vec3_mad(bsdf->wo, wi, bsdf->eta);
    if (vec3_length2(h) < 1e-16f) return false;
    h = vec3_normalize(h);
    if (h.z < 0.0f) h = vec3_neg(h);
    *out_h = h;
    const float cos_i = vec3_dot(wi, h);
    return vec3_dot(bsdf->wo, h) > 0.0f && (is_reflection ? cos_i > 0.0f : cos_i < 0.0f);
}

/* Density of wi per density of its half vector: equations 14 and 17 of Walter et al. */
static inline float ppmi_glass_jacobian(const ppmi_bsdf *bsdf, ppmi_vec3 wi, ppmi_vec3 h)
{
    if (wi.z > 0.0f) return 1.0f / (4.0f * vec3_dot(wi, h));
    const float denominator = vec3_dot(bsdf->wo, h) + bsdf->eta * vec3_dot(wi, h);
    return bsdf->eta * bsdf->eta * fabsf(vec3_dot(wi, h)) /
           ppmi_max(denominator * denominator, 1e-12f);
}

/* Radiance is squeezed into a smaller cone where it enters a denser solid, power is not. */
static inline float ppmi_glass_transmitted_scale(const ppmi_bsdf *bsdf, ppmi_transport transport)
{
    if (transport != PPMI_TRANSPORT_RADIANCE || bsdf->is_thin) return 1.0f;
    return 1.0f / (bsdf->eta * bsdf->eta);
}

/* What comes back of what single scattering loses. Light that goes through is tinted once. */
static inline ppmi_vec3 ppmi_glass_lobe_eval_multiple(const ppmi_bsdf *bsdf,
                                                      const ppmi_albedo_table *albedo, ppmi_vec3 wi,
                                                      ppmi_transport transport)
{
    if (wi.z > 0.0f) {
        return vec3_splat(bsdf->glass_back * ppmi_glass_lobe_lost(bsdf, albedo, bsdf->eta, wi.z));
    }
    const float beyond = bsdf->is_thin ? bsdf->eta : 1.0f / bsdf->eta;
    return vec3_scale(bsdf->tint, bsdf->glass_through *
                                      ppmi_glass_lobe_lost(bsdf, albedo, beyond, -wi.z) *
                                      ppmi_glass_transmitted_scale(bsdf, transport));
}

static inline ppmi_vec3 ppmi_glass_lobe_eval_single(const ppmi_bsdf *bsdf, ppmi_vec3 wi,
                                                    ppmi_transport transport)
{
    const bool is_transmission = wi.z < 0.0f;
    const ppmi_vec3 folded = ppmi_glass_thin_fold(bsdf, wi);
    ppmi_vec3 h;
    if (!ppmi_glass_half(bsdf, folded, &h)) return vec3_splat(0.0f);
    const float cos_oh = vec3_dot(bsdf->wo, h);
    float cos_t;
    const float reflectance = ppmi_glass_reflectance(bsdf, cos_oh, &cos_t);
    const float d = ppmi_ggx_d(bsdf->glass_alpha, h);
    const float g = ppmi_ggx_g2(bsdf->glass_alpha, bsdf->wo.z, fabsf(wi.z));
    const float common = bsdf->glass_weight * d * g * cos_oh *
                         ppmi_glass_jacobian(bsdf, folded, h) / (bsdf->wo.z * fabsf(wi.z));
    if (!is_transmission) return vec3_scale(ppmi_glass_tone(bsdf, cos_oh, reflectance), common);
    return vec3_scale(bsdf->tint, common * (1.0f - reflectance) *
                                      ppmi_glass_transmitted_scale(bsdf, transport));
}

__attribute__((noinline)) static ppmi_vec3 ppmi_glass_lobe_eval(const ppmi_bsdf *bsdf,
                                                                const ppmi_albedo_table *albedo,
                                                                ppmi_vec3 wi,
                                                                ppmi_transport transport)
{
    return vec3_add(ppmi_glass_lobe_eval_single(bsdf, wi, transport),
                    ppmi_glass_lobe_eval_multiple(bsdf, albedo, wi, transport));
}

/* Of directions by the cosine c, c / (c^2 + alpha^2) normalised: 1 - E falls with the cosine's
 * square beyond alpha, so that its product with the cosine is about this. */
static inline float ppmi_glass_lobe_pdf_multiple(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const float alpha2 = bsdf->glass_alpha * bsdf->glass_alpha, c = fabsf(wi.z);
    const float share = wi.z > 0.0f ? bsdf->glass_returned : 1.0f - bsdf->glass_returned;
    return share * c / ((c * c + alpha2) * log1pf(1.0f / alpha2)) * PPMI_INV_PI;
}

static inline ppmi_vec3 ppmi_glass_lobe_draw_multiple(const ppmi_bsdf *bsdf, float u_side, float u,
                                                      float v)
{
    const float alpha2 = bsdf->glass_alpha * bsdf->glass_alpha;
    const float c2 = ppmi_min(alpha2 * expm1f(u * log1pf(1.0f / alpha2)), 1.0f);
    const float sine = sqrtf(1.0f - c2), phi = 2.0f * PPMI_PI * v;
    const float c = ppmi_max(sqrtf(c2), 1e-6f);
    return vec3(sine * cosf(phi), sine * sinf(phi), u_side < bsdf->glass_returned ? c : -c);
}

static inline float ppmi_glass_lobe_pdf_single(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const bool is_transmission = wi.z < 0.0f;
    const ppmi_vec3 folded = ppmi_glass_thin_fold(bsdf, wi);
    ppmi_vec3 h;
    if (!ppmi_glass_half(bsdf, folded, &h)) return 0.0f;
    float cos_t;
    const float reflectance = ppmi_glass_reflectance(bsdf, vec3_dot(bsdf->wo, h), &cos_t);
    return (is_transmission ? 1.0f - reflectance : reflectance) *
           ppmi_ggx_visible_d(bsdf->glass_alpha, bsdf->wo, h) *
           ppmi_glass_jacobian(bsdf, folded, h);
}

__attribute__((noinline)) static float ppmi_glass_lobe_pdf(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    return (1.0f - bsdf->glass_lost) * ppmi_glass_lobe_pdf_single(bsdf, wi) +
           bsdf->glass_lost * ppmi_glass_lobe_pdf_multiple(bsdf, wi);
}

/* ---- sampling -------------------------------------------------------------------------------- */

/* A direction of the rough glass lobe, local. u_side decides between single scattering and the
 * rest, then between the sides. */
static inline bool ppmi_glass_lobe_draw(const ppmi_bsdf *bsdf, float u_side, float u, float v,
                                        ppmi_vec3 *wi)
{
    if (u_side < bsdf->glass_lost) {
        *wi = ppmi_glass_lobe_draw_multiple(bsdf, u_side / bsdf->glass_lost, u, v);
        return true;
    }
    u_side = (u_side - bsdf->glass_lost) / (1.0f - bsdf->glass_lost);
    const ppmi_vec3 h = ppmi_ggx_sample_visible(bsdf->glass_alpha, bsdf->wo, u, v);
    float cos_t;
    const float reflectance = ppmi_glass_reflectance(bsdf, vec3_dot(bsdf->wo, h), &cos_t);
    if (u_side < reflectance) {
        *wi = ppmi_reflect_about(bsdf->wo, h);
        return wi->z > 0.0f;
    }
    if (bsdf->is_thin) {
        *wi = ppmi_reflect_about(bsdf->wo, h);
        wi->z = -wi->z;
    } else {
        *wi = vec3_normalize(ppmi_refract_about(bsdf->wo, h, bsdf->eta, cos_t));
    }
    return wi->z < 0.0f;
}

#endif
