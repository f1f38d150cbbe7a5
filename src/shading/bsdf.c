/* Building, evaluating and sampling the lobes.
 *
 * The layering follows glTF 2.0 appendix B, but the diffuse base is weighed by the albedo that the
 * coat leaves over in both directions, (1 - E(o)) (1 - E(i)) / (1 - E_avg) (Kelemen and
 * Szirmay-Kalos 2001; Kulla and Conty 2017), instead of 1 - F(v.h): the appendix's form makes
 * energy at grazing angles and loses it elsewhere, this one returns exactly 1 in a white furnace
 * and is reciprocal. */
#include "shading/bsdf.h"

#include <stddef.h>
#include <string.h>

#include "shading/diffuse_base.h"
#include "shading/glass_lobe.h"
#include "shading/layers.h"
#include "shading/layers_top.h"
#include "shading/microfacet.h"

/* A GGX lobe at least this wide is worth estimating from photon density: below, few photons fall
 * into it and the path goes on by sampling it instead. */
static const float gather_alpha = 0.2f;

/* ---- building -------------------------------------------------------------------------------- */

static void make_wide(ppmi_bsdf *bsdf, ppmi_albedo_pair at_o, ppmi_albedo_pair average,
                      const ppmi_material_point *point, float opaque, float metallic)
{
    const float left_o = 1.0f - ppmi_albedo_value(at_o, bsdf->coat_f0, bsdf->coat_f90);
    const float left_average = 1.0f - ppmi_albedo_value(average, bsdf->coat_f0, bsdf->coat_f90);
    const float coat = opaque * (1.0f - metallic) * left_o / ppmi_max(left_average, 1e-4f);
    bsdf->coat_base = vec3_scale(point->base_color, coat);

    /* Kulla and Conty: F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg)) */
    const float e_average = average.a + average.b;
    const float lost_average = 1.0f - e_average;
    if (metallic > 0.0f && lost_average > 1e-4f) {
        const ppmi_vec3 f = vec3_lerp(point->base_color, vec3_splat(1.0f), 1.0f / 21.0f);
        const ppmi_vec3 f_ms = vec3(f.x * f.x * e_average / (1.0f - f.x * lost_average),
                                    f.y * f.y * e_average / (1.0f - f.y * lost_average),
                                    f.z * f.z * e_average / (1.0f - f.z * lost_average));
        const float metal = opaque * metallic * (1.0f - at_o.a - at_o.b) / lost_average;
        bsdf->metal_base = vec3_scale(f_ms, ppmi_max(metal, 0.0f));
    }
}

/* Which lobes are there, and how often each is drawn; albedos beyond count are 0. */
static void choose_by_albedo(ppmi_bsdf *bsdf, const float *albedos, uint32_t count)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < count; i++)
        sum += albedos[i];
    for (uint32_t i = 0; i < count; i++) {
        if (!(albedos[i] > 1e-6f)) continue;
        bsdf->lobe_probability[i] = albedos[i] / sum;
        bsdf->lobes |= (uint8_t)(1u << i);
    }
    bsdf->gather_lobes &= bsdf->lobes;
    bsdf->delta_lobes &= bsdf->lobes;
}

static void make_lobe_masks(ppmi_bsdf *bsdf, ppmi_albedo_pair at_o, ppmi_albedo_pair average)
{
    const float coat_left = 1.0f - ppmi_albedo_value(average, bsdf->coat_f0, bsdf->coat_f90);
    float albedos[3];
    albedos[0] = vec3_max_component(bsdf->coat_base) * coat_left +
                 vec3_max_component(bsdf->metal_base) * (1.0f - average.a - average.b);
    albedos[1] = at_o.a * vec3_max_component(bsdf->f0) + at_o.b * vec3_max_component(bsdf->f90);
    albedos[2] = bsdf->glass_weight;
    if (bsdf->alpha < PPMI_SMOOTH_ALPHA) bsdf->delta_lobes |= PPMI_LOBE_SPEC;
    if (bsdf->glass_alpha < PPMI_SMOOTH_ALPHA) bsdf->delta_lobes |= PPMI_LOBE_GLASS;
    bsdf->gather_lobes = PPMI_LOBE_WIDE;
    if (bsdf->alpha >= gather_alpha) bsdf->gather_lobes |= PPMI_LOBE_SPEC;
    choose_by_albedo(bsdf, albedos, 3);
}

/* The index ratio and roughness of the glass lobe. */
static void make_glass(ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                       const ppmi_material_point *point, bool is_outside)
{
    const float index = ppmi_dielectric_index(point->ior);
    bsdf->is_thin = point->is_thin;
    bsdf->glass_weight = point->transmission * (1.0f - point->metallic);
    bsdf->tint = point->base_color;
    bsdf->eta = is_outside || point->is_thin ? index : 1.0f / index;
    if (point->relative_index > 0.0f && !point->is_thin) bsdf->eta = point->relative_index;
    bsdf->glass_alpha = bsdf->alpha;
    /* without an index step there is no half vector: the ray goes straight on */
    if (fabsf(bsdf->eta - 1.0f) < 1e-3f) bsdf->glass_alpha = 0.0f;
    if (bsdf->glass_weight > 0.0f && bsdf->glass_alpha >= PPMI_SMOOTH_ALPHA) {
        ppmi_glass_lobe_make(bsdf, albedo);
    }
}

/* Nothing reflects but the diffuse base: the albedo table is not needed. */
static bool is_lambert(const ppmi_bsdf *bsdf)
{
    return vec3_is_black(bsdf->f0) && vec3_is_black(bsdf->f90);
}

/* A shading normal that wo sees from behind would be black: it is bent until wo just sees it, but
 * never beyond the geometric normal, which on a flat surface is the right one at any angle. */
static ppmi_vec3 visible_normal(ppmi_vec3 ns, ppmi_vec3 ng, ppmi_vec3 wo)
{
    const float least = ppmi_min(0.02f, vec3_dot(ng, wo));
    const float cosine = vec3_dot(ns, wo);
    if (cosine >= least) return ns;
    return vec3_normalize(vec3_mad(ns, wo, least - cosine));
}

__attribute__((noinline)) static void make_layered(ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                                   const ppmi_material_point *point, ppmi_vec3 wo,
                                                   ppmi_vec3 dielectric_f0, float opaque)
{
    const ppmi_base_shares shares = {dielectric_f0, opaque,
                                     opaque > 0.0f ? point->metallic / opaque : 0.0f};
    ppmi_vec3 normal = point->layers.coat_normal;
    if (vec3_dot(normal, bsdf->ng) < 0.0f) normal = vec3_neg(normal);
    normal = visible_normal(normal, bsdf->ng, wo);
    ppmi_lobe_albedos albedos;
    ppmi_layers_make(bsdf, albedo, point, &shares, normal, &albedos);
    choose_by_albedo(bsdf, albedos.of, PPMI_LOBE_COUNT);
}

/* F0 and F90 of the dielectric, and of both what the diffuse base is left: f = F0 + (F90 - F0)
 * schlick. By KHR_materials_specular the colour is that of F0. */
static ppmi_vec3 make_dielectric(ppmi_bsdf *bsdf, const ppmi_material_point *point)
{
    const float index = ppmi_dielectric_index(point->ior);
    const float r0 = ppmi_sqr((index - 1.0f) / (index + 1.0f));
    const ppmi_vec3 f0 = vec3(ppmi_min(r0 * point->specular_color.x, 1.0f) * point->specular,
                              ppmi_min(r0 * point->specular_color.y, 1.0f) * point->specular,
                              ppmi_min(r0 * point->specular_color.z, 1.0f) * point->specular);
    bsdf->f90 = vec3_splat(point->specular);
    bsdf->coat_f0 = vec3_max_component(f0);
    bsdf->coat_f90 = point->specular;
    return f0;
}

/* By EXT_materials_specular_edge_color it is that of the whole lobe, and takes nothing from the
 * base: what is beyond 1 of it counts as weight. */
static ppmi_vec3 make_edge_colored_dielectric(ppmi_bsdf *bsdf, const ppmi_material_point *point)
{
    const float index = ppmi_dielectric_index(point->ior);
    const float r0 = ppmi_sqr((index - 1.0f) / (index + 1.0f));
    const float most = ppmi_max(vec3_max_component(point->specular_color), 1.0f);
    const ppmi_vec3 color = vec3_scale(point->specular_color, 1.0f / most);
    bsdf->coat_f0 = ppmi_min(r0 * point->specular * most, 1.0f);
    bsdf->coat_f90 = ppmi_min(point->specular * most, 1.0f);
    bsdf->f90 = vec3_scale(color, bsdf->coat_f90);
    return vec3_scale(color, bsdf->coat_f0);
}

void ppmi_bsdf_make(const ppmi_albedo_table *albedo, const ppmi_surface *surface,
                    const ppmi_material_point *point, ppmi_vec3 wo, ppmi_bsdf *out_bsdf)
{
    ppmi_bsdf *bsdf = out_bsdf;
    memset(bsdf, 0, offsetof(ppmi_bsdf, layers));
    const bool is_outside = vec3_dot(wo, surface->ng) >= 0.0f;
    bsdf->ng = is_outside ? surface->ng : vec3_neg(surface->ng);
    const ppmi_vec3 ns = is_outside ? point->ns : vec3_neg(point->ns);
    bsdf->frame = ppmi_frame_from_normal(visible_normal(ns, bsdf->ng, wo));
    bsdf->wo = ppmi_frame_to_local(&bsdf->frame, wo);
    bsdf->wo.z = ppmi_max(bsdf->wo.z, 1e-4f);
    bsdf->roughness = point->roughness;
    bsdf->alpha = point->roughness * point->roughness;

    const ppmi_vec3 dielectric_f0 = point->edge_color ? make_edge_colored_dielectric(bsdf, point)
                                                      : make_dielectric(bsdf, point);
    const float opaque = 1.0f - point->transmission * (1.0f - point->metallic);
    /* the dielectric's share of the opaque part, with its metallic blend */
    const float metal = opaque > 0.0f ? point->metallic / opaque : 0.0f;
    bsdf->f0 = vec3_scale(vec3_lerp(dielectric_f0, point->base_color, metal), opaque);
    bsdf->f90 = vec3_scale(vec3_lerp(bsdf->f90, vec3_splat(1.0f), metal), opaque);
    make_glass(bsdf, albedo, point, is_outside);
    if (point->diffuse_roughness > 0.0f) {
        bsdf->diffuse_roughness = point->diffuse_roughness;
        bsdf->diffuse_lost = ppmi_rough_diffuse_lost(point->diffuse_roughness, bsdf->wo.z);
    }
    if (point->is_layered) {
        make_layered(bsdf, albedo, point, wo, dielectric_f0, opaque);
        return;
    }
    ppmi_albedo_pair at_o = {0.0f, 0.0f}, average = {0.0f, 0.0f};
    if (!is_lambert(bsdf)) {
        at_o = ppmi_albedo_directional(albedo, bsdf->roughness, bsdf->wo.z);
        average = ppmi_albedo_average(albedo, bsdf->roughness);
    }
    make_wide(bsdf, at_o, average, point, opaque, metal);
    make_lobe_masks(bsdf, at_o, average);
}

void ppmi_bsdf_make_phase(const ppmi_medium *medium, ppmi_vec3 wo, ppmi_bsdf *out_bsdf)
{
    *out_bsdf = (ppmi_bsdf){
        .frame = ppmi_frame_from_normal(vec3_neg(wo)),
        .wo = {0.0f, 0.0f, -1.0f},
        .sigma_s = medium->sigma_s,
        .asymmetry_g = medium->asymmetry_g,
        .lobe_probability = {[3] = 1.0f},
        .lobes = PPMI_LOBE_PHASE,
        .gather_lobes = PPMI_LOBE_PHASE,
    };
}

/* ---- evaluation ------------------------------------------------------------------------------ */

static ppmi_vec3 wide_eval(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi)
{
    const ppmi_vec3 base = ppmi_bsdf_diffuse(bsdf, bsdf->coat_base, bsdf->tint, wi);
    if (bsdf->coat_f90 == 0.0f && bsdf->coat_f0 == 0.0f && vec3_is_black(bsdf->metal_base)) {
        return vec3_scale(base, PPMI_INV_PI); /* nothing above it */
    }
    const ppmi_albedo_pair at_i = ppmi_albedo_directional(albedo, bsdf->roughness, wi.z);
    const float coat = 1.0f - ppmi_albedo_value(at_i, bsdf->coat_f0, bsdf->coat_f90);
    const float metal = ppmi_max(1.0f - at_i.a - at_i.b, 0.0f);
    return vec3_scale(vec3_mad(vec3_scale(base, coat), bsdf->metal_base, metal), PPMI_INV_PI);
}

static ppmi_vec3 spec_fresnel(const ppmi_bsdf *bsdf, float cos_h)
{
    return vec3_lerp(bsdf->f0, bsdf->f90, ppmi_schlick_weight(cos_h));
}

static ppmi_vec3 spec_eval(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const ppmi_vec3 h = vec3_normalize(vec3_add(bsdf->wo, wi));
    const float d = ppmi_ggx_d(bsdf->alpha, h);
    const float g = ppmi_ggx_g2(bsdf->alpha, bsdf->wo.z, wi.z);
    return vec3_scale(spec_fresnel(bsdf, vec3_dot(wi, h)), d * g / (4.0f * bsdf->wo.z * wi.z));
}

static float spec_pdf(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const ppmi_vec3 h = vec3_normalize(vec3_add(bsdf->wo, wi));
    const float cos_oh = vec3_dot(bsdf->wo, h);
    if (cos_oh <= 0.0f) return 0.0f;
    return ppmi_ggx_visible_d(bsdf->alpha, bsdf->wo, h) / (4.0f * cos_oh);
}

/* Both normals must agree on which side wi is: light does not leak through the surface where the
 * shading normal leans over. side: wi's cosine to the geometric normal. */
static bool sides_agree(float side, float local_z)
{
    return local_z * side > 0.0f;
}

/* The coat reflects about a normal of its own: it alone may reach below the base's horizon. */
__attribute__((noinline)) static ppmi_vec3 layered_eval(const ppmi_bsdf *bsdf,
                                                        const ppmi_albedo_table *albedo, float side,
                                                        ppmi_vec3 wi, uint32_t mask,
                                                        ppmi_transport transport)
{
    ppmi_vec3 f = vec3_splat(0.0f);
    if (sides_agree(side, wi.z)) {
        f = ppmi_layers_eval_base(bsdf, albedo, wi, mask);
        if (mask & PPMI_LOBE_GLASS) {
            f = vec3_add(f, vec3_mul(ppmi_glass_lobe_eval(bsdf, albedo, wi, transport),
                                     ppmi_layers_glass_passing(bsdf, albedo, wi)));
        }
    }
    if (mask & PPMI_LOBE_COAT && side > 0.0f) {
        f = vec3_add(f, ppmi_layers_eval_coat(bsdf, albedo, wi, transport));
    }
    return f;
}

static inline ppmi_vec3 eval(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                             ppmi_vec3 wi_world, float side, uint32_t mask,
                             ppmi_transport transport)
{
    const ppmi_vec3 wi = ppmi_frame_to_local(&bsdf->frame, wi_world);
    if (mask & bsdf->lobes & PPMI_LOBE_PHASE) {
        return vec3_scale(bsdf->sigma_s, ppmi_phase(bsdf->asymmetry_g, wi.z));
    }
    mask &= (uint32_t)(bsdf->lobes & ~bsdf->delta_lobes);
    if (bsdf->is_layered) return layered_eval(bsdf, albedo, side, wi, mask, transport);
    ppmi_vec3 f = vec3_splat(0.0f);
    if (!sides_agree(side, wi.z)) return f;
    if (wi.z > 0.0f) {
        if (mask & PPMI_LOBE_WIDE) f = wide_eval(bsdf, albedo, wi);
        if (mask & PPMI_LOBE_SPEC) f = vec3_add(f, spec_eval(bsdf, wi));
    }
    if (mask & PPMI_LOBE_GLASS) f = vec3_add(f, ppmi_glass_lobe_eval(bsdf, albedo, wi, transport));
    return f;
}

ppmi_vec3 ppmi_bsdf_eval(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi_world,
                         uint32_t mask, ppmi_transport transport)
{
    return eval(bsdf, albedo, wi_world, vec3_dot(wi_world, bsdf->ng), mask, transport);
}

ppmi_vec3 ppmi_bsdf_eval_from(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                              ppmi_vec3 wi_world, ppmi_vec3 ng, uint32_t mask,
                              ppmi_transport transport)
{
    return eval(bsdf, albedo, wi_world, vec3_dot(wi_world, ng), mask, transport);
}

float ppmi_bsdf_probability(const ppmi_bsdf *bsdf, uint32_t mask)
{
    float sum = 0.0f;
    mask &= bsdf->lobes;
    for (uint32_t i = 0; mask >> i != 0; i++) {
        if (mask >> i & 1) sum += bsdf->lobe_probability[i];
    }
    return sum;
}

__attribute__((noinline)) static float layered_pdf(const ppmi_bsdf *bsdf, ppmi_vec3 wi_world,
                                                   ppmi_vec3 wi, uint32_t mask)
{
    float pdf = 0.0f;
    if (sides_agree(vec3_dot(wi_world, bsdf->ng), wi.z)) {
        pdf = ppmi_layers_pdf_base(bsdf, wi, mask);
        if (mask & PPMI_LOBE_GLASS)
            pdf += bsdf->lobe_probability[2] * ppmi_glass_lobe_pdf(bsdf, wi);
    }
    if (mask & PPMI_LOBE_COAT && vec3_dot(wi_world, bsdf->ng) > 0.0f) {
        pdf += bsdf->lobe_probability[4] * ppmi_layers_pdf_coat(bsdf, wi);
    }
    return pdf;
}

float ppmi_bsdf_pdf(const ppmi_bsdf *bsdf, ppmi_vec3 wi_world, uint32_t mask)
{
    const ppmi_vec3 wi = ppmi_frame_to_local(&bsdf->frame, wi_world);
    if (mask & bsdf->lobes & PPMI_LOBE_PHASE) return ppmi_phase(bsdf->asymmetry_g, wi.z);
    const float total = ppmi_bsdf_probability(bsdf, mask);
    if (total <= 0.0f) return 0.0f;
    mask &= (uint32_t)(bsdf->lobes & ~bsdf->delta_lobes);
    if (bsdf->is_layered) return layered_pdf(bsdf, wi_world, wi, mask) / total;
    if (!sides_agree(vec3_dot(wi_world, bsdf->ng), wi.z)) return 0.0f;
    float pdf = 0.0f;
    if (wi.z > 0.0f) {
        if (mask & PPMI_LOBE_WIDE) pdf += bsdf->lobe_probability[0] * wi.z * PPMI_INV_PI;
        if (mask & PPMI_LOBE_SPEC) pdf += bsdf->lobe_probability[1] * spec_pdf(bsdf, wi);
    }
    if (mask & PPMI_LOBE_GLASS) pdf += bsdf->lobe_probability[2] * ppmi_glass_lobe_pdf(bsdf, wi);
    return pdf / total;
}

/* ---- sampling -------------------------------------------------------------------------------- */

/* A mirrored direction that a leaning shading normal sent below the surface comes back out: a
 * black rim at silhouettes would be worse than this small turn. */
static ppmi_vec3 lift_reflection(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const float below = vec3_dot(wi, bsdf->ng);
    if (below > 0.0f) return wi;
    return vec3_normalize(vec3_mad(wi, bsdf->ng, 1e-3f - 2.0f * below));
}

static bool draw_layered_mirror(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                uint32_t lobe, ppmi_transport transport, float probability,
                                ppmi_bsdf_sample *sample)
{
    ppmi_vec3 wi, weight;
    if (!ppmi_layers_mirror(bsdf, albedo, lobe, transport, &wi, &weight)) return false;
    sample->wi = lift_reflection(bsdf, ppmi_frame_to_world(&bsdf->frame, wi));
    sample->weight = vec3_scale(weight, 1.0f / probability);
    return true;
}

/* A delta lobe that reflects: SPEC, of layered materials COAT and RETRO too. */
static bool draw_mirror(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t lobe,
                        ppmi_transport transport, float probability, ppmi_bsdf_sample *sample)
{
    if (bsdf->is_layered) {
        return draw_layered_mirror(bsdf, albedo, lobe, transport, probability, sample);
    }
    const ppmi_vec3 local = vec3(-bsdf->wo.x, -bsdf->wo.y, bsdf->wo.z);
    sample->wi = lift_reflection(bsdf, ppmi_frame_to_world(&bsdf->frame, local));
    sample->weight = vec3_scale(spec_fresnel(bsdf, bsdf->wo.z), 1.0f / probability);
    return true;
}

static const ppmi_vec3 local_up = {0.0f, 0.0f, 1.0f};

/* What layers on top leave of a weight. */
static void cover(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 local,
                  ppmi_bsdf_sample *sample)
{
    if (!bsdf->is_layered) return;
    sample->weight = vec3_mul(sample->weight, ppmi_layers_glass_passing(bsdf, albedo, local));
}

/* Reflection at the smooth interface, with share times what is reflected as weight. */
static void reflect_at_glass(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                             ppmi_vec3 reflected, float share, ppmi_bsdf_sample *sample)
{
    const ppmi_vec3 local = ppmi_reflect_about(bsdf->wo, local_up);
    sample->wi = lift_reflection(bsdf, ppmi_frame_to_world(&bsdf->frame, local));
    sample->weight = vec3_scale(reflected, share);
    cover(bsdf, albedo, local, sample);
}

/* Transmission through the smooth interface, with share times tint as weight. */
static bool transmit_at_glass(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                              ppmi_transport transport, float cos_t, float share,
                              ppmi_bsdf_sample *sample)
{
    const ppmi_vec3 local = bsdf->is_thin
                                ? vec3_neg(bsdf->wo)
                                : ppmi_refract_about(bsdf->wo, local_up, bsdf->eta, cos_t);
    sample->wi = vec3_normalize(ppmi_frame_to_world(&bsdf->frame, local));
    sample->is_transmission = true;
    sample->eta_scale = ppmi_glass_transmitted_scale(bsdf, transport);
    sample->weight = vec3_scale(bsdf->tint, share * sample->eta_scale);
    cover(bsdf, albedo, local, sample);
    /* at a leaning shading normal the refracted ray may stay above the surface: absorbed */
    return vec3_dot(sample->wi, bsdf->ng) < 0.0f;
}

/* Fresnel decides, so the weight is that of the lobe alone. */
static bool draw_smooth_glass(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                              ppmi_transport transport, float probability, float u,
                              ppmi_bsdf_sample *sample)
{
    float cos_t;
    const float reflectance = ppmi_glass_reflectance(bsdf, bsdf->wo.z, &cos_t);
    const float share = bsdf->glass_weight / probability;
    if (u >= reflectance) {
        return transmit_at_glass(bsdf, albedo, transport, cos_t, share, sample);
    }
    const ppmi_vec3 tone =
        ppmi_layers_have_film(bsdf)
            ? vec3_scale(ppmi_glass_film_reflectance(bsdf, bsdf->wo.z), 1.0f / reflectance)
            : vec3_splat(1.0f);
    reflect_at_glass(bsdf, albedo, tone, share, sample);
    return true;
}

static uint32_t glass_branches(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                               ppmi_transport transport, ppmi_bsdf_sample *samples)
{
    uint32_t count = 0;
    float cos_t;
    const float reflectance = ppmi_glass_reflectance(bsdf, bsdf->wo.z, &cos_t);
    if (reflectance > 0.0f) {
        const ppmi_vec3 tone = ppmi_glass_tone(bsdf, bsdf->wo.z, reflectance);
        reflect_at_glass(bsdf, albedo, tone, bsdf->glass_weight, &samples[count++]);
    }
    const float left = bsdf->glass_weight * (1.0f - reflectance);
    if (left > 0.0f) {
        count += transmit_at_glass(bsdf, albedo, transport, cos_t, left, &samples[count]);
    }
    return count;
}

uint32_t ppmi_bsdf_branches(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask,
                            ppmi_transport transport,
                            ppmi_bsdf_sample out_samples[PPMI_BSDF_MAX_BRANCHES])
{
    static const uint32_t mirrors[] = {PPMI_LOBE_SPEC, PPMI_LOBE_COAT, PPMI_LOBE_RETRO};
    uint32_t count = 0;
    mask &= bsdf->delta_lobes;
    for (uint32_t i = 0; i < PPMI_BSDF_MAX_BRANCHES; i++)
        out_samples[i] = (ppmi_bsdf_sample){.is_delta = true, .eta_scale = 1.0f};
    for (uint32_t i = 0; i < sizeof mirrors / sizeof mirrors[0]; i++) {
        if (!(mask & mirrors[i])) continue;
        count += draw_mirror(bsdf, albedo, mirrors[i], transport, 1.0f, &out_samples[count]);
    }
    if (mask & PPMI_LOBE_GLASS) {
        count += glass_branches(bsdf, albedo, transport, &out_samples[count]);
    }
    return count;
}

ppmi_vec3 ppmi_bsdf_straight(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo)
{
    ppmi_vec3 passing = vec3_splat(0.0f);
    if (!bsdf->is_thin || !(bsdf->delta_lobes & PPMI_LOBE_GLASS)) return passing;
    ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
    const uint32_t count =
        ppmi_bsdf_branches(bsdf, albedo, PPMI_LOBE_GLASS, PPMI_TRANSPORT_RADIANCE, samples);
    for (uint32_t i = 0; i < count; i++) {
        if (ppmi_bsdf_goes_straight(bsdf, &samples[i])) passing = samples[i].weight;
    }
    return passing;
}

static void draw_phase(const ppmi_bsdf *bsdf, float u, float v, ppmi_bsdf_sample *sample)
{
    const ppmi_vec3 local = ppmi_phase_sample(bsdf->asymmetry_g, u, v);
    sample->wi = vec3_normalize(ppmi_frame_to_world(&bsdf->frame, local));
    sample->weight = bsdf->sigma_s;
    sample->pdf = ppmi_phase(bsdf->asymmetry_g, local.z);
}

/* Which lobe of the mask u falls to; what is left of u is uniform again. */
static uint32_t choose_lobe(const ppmi_bsdf *bsdf, uint32_t mask, float total, float *u)
{
    float x = *u * total;
    uint32_t last = PPMI_LOBE_COUNT;
    for (uint32_t i = 0; i < PPMI_LOBE_COUNT; i++) {
        const float p = bsdf->lobe_probability[i];
        if (!(mask >> i & 1) || p <= 0.0f) continue;
        last = i;
        if (x < p) {
            *u = x / p;
            return i;
        }
        x -= p;
    }
    *u = 0.5f;
    return last;
}

bool ppmi_bsdf_draw(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask,
                    ppmi_transport transport, float u_lobe, float u, float v,
                    ppmi_bsdf_sample *out_sample)
{
    mask &= bsdf->lobes;
    const float total = ppmi_bsdf_probability(bsdf, mask);
    if (total <= 0.0f) return false;
    const uint32_t lobe = choose_lobe(bsdf, mask, total, &u_lobe);
    *out_sample = (ppmi_bsdf_sample){.eta_scale = 1.0f};
    if (1u << lobe == PPMI_LOBE_PHASE) {
        draw_phase(bsdf, u, v, out_sample);
        return true;
    }
    if (bsdf->delta_lobes >> lobe & 1) {
        out_sample->is_delta = true;
        const float probability = bsdf->lobe_probability[lobe] / total;
        return 1u << lobe == PPMI_LOBE_GLASS
                   ? draw_smooth_glass(bsdf, albedo, transport, probability, u_lobe, out_sample)
                   : draw_mirror(bsdf, albedo, 1u << lobe, transport, probability, out_sample);
    }
    ppmi_vec3 wi;
    if (bsdf->is_layered && 1u << lobe != PPMI_LOBE_GLASS) {
        if (!ppmi_layers_draw(bsdf, 1u << lobe, u, v, &wi)) return false;
    } else if (1u << lobe == PPMI_LOBE_WIDE) {
        wi = ppmi_sample_cosine_hemisphere(u, v);
    } else if (1u << lobe == PPMI_LOBE_SPEC) {
        wi = ppmi_reflect_about(bsdf->wo, ppmi_ggx_sample_visible(bsdf->alpha, bsdf->wo, u, v));
        if (wi.z <= 0.0f) return false;
    } else if (!ppmi_glass_lobe_draw(bsdf, u_lobe, u, v, &wi)) {
        return false;
    }
    out_sample->wi = vec3_normalize(ppmi_frame_to_world(&bsdf->frame, wi));
    out_sample->is_transmission = vec3_dot(out_sample->wi, bsdf->ng) < 0.0f;
    if (out_sample->is_transmission && 1u << lobe == PPMI_LOBE_GLASS) {
        out_sample->eta_scale = ppmi_glass_transmitted_scale(bsdf, transport);
    }
    out_sample->pdf = ppmi_bsdf_pdf(bsdf, out_sample->wi, mask);
    if (!(out_sample->pdf > 0.0f)) return false;
    const ppmi_vec3 f = ppmi_bsdf_eval(bsdf, albedo, out_sample->wi, mask, transport);
    out_sample->weight =
        vec3_scale(f, fabsf(ppmi_bsdf_cosine(bsdf, out_sample->wi)) / out_sample->pdf);
    return !vec3_is_black(out_sample->weight);
}

/* ---- albedo ---------------------------------------------------------------------------------- */

/* Schlick's albedo by channel, and the base by what the coat leaves over on average; both exact,
 * but for a rough base under a coat, which leaves over more of some directions than of others. */
static ppmi_vec3 plain_albedo(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask)
{
    ppmi_vec3 sum = vec3_splat(0.0f);
    ppmi_albedo_pair at_o = {0.0f, 0.0f}, average = {0.0f, 0.0f};
    if (!is_lambert(bsdf)) {
        at_o = ppmi_albedo_directional(albedo, bsdf->roughness, bsdf->wo.z);
        average = ppmi_albedo_average(albedo, bsdf->roughness);
    }
    if (mask & PPMI_LOBE_WIDE) {
        const float left = 1.0f - ppmi_albedo_value(average, bsdf->coat_f0, bsdf->coat_f90);
        sum = vec3_scale(ppmi_bsdf_diffuse_albedo(bsdf, bsdf->coat_base, bsdf->tint), left);
        sum = vec3_mad(sum, bsdf->metal_base, 1.0f - average.a - average.b);
    }
    if (mask & PPMI_LOBE_SPEC) {
        sum = vec3_mad(vec3_mad(sum, bsdf->f0, at_o.a), bsdf->f90, at_o.b);
    }
    return sum;
}

/* With the Fresnel term of the smooth surface, and below what coat and sheen leave over along the
 * smooth surface's directions. */
static ppmi_vec3 glass_albedo(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo)
{
    float cos_t;
    const float reflected = ppmi_glass_reflectance(bsdf, bsdf->wo.z, &cos_t);
    ppmi_vec3 tone = ppmi_glass_tone(bsdf, bsdf->wo.z, reflected);
    ppmi_vec3 through = vec3_scale(bsdf->tint, 1.0f - reflected);
    if (bsdf->is_layered) {
        const ppmi_vec3 wo = bsdf->wo, mirrored = ppmi_reflect_about(wo, local_up);
        const ppmi_vec3 refracted =
            bsdf->is_thin ? vec3_neg(wo) : ppmi_refract_about(wo, local_up, bsdf->eta, cos_t);
        tone = vec3_mul(tone, ppmi_layers_glass_passing(bsdf, albedo, mirrored));
        through = vec3_mul(through, ppmi_layers_glass_passing(bsdf, albedo, refracted));
    }
    return vec3_scale(vec3_add(tone, through), bsdf->glass_weight);
}

ppmi_vec3 ppmi_bsdf_albedo(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask)
{
    mask &= bsdf->lobes;
    const ppmi_vec3 sum = bsdf->is_layered ? ppmi_layers_albedo(bsdf, albedo, mask)
                                           : plain_albedo(bsdf, albedo, mask);
    return mask & PPMI_LOBE_GLASS ? vec3_add(sum, glass_albedo(bsdf, albedo)) : sum;
}
