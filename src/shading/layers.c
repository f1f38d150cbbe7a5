/* Layered lobes.
 *
 * What reflects without a diffuse base beneath is weighed by what the layers above leave over in
 * the direction where they leave less, min(T(o), T(i)): reciprocal, exact for mirrors, never too
 * much. Whatever all these lobes together do not reflect, E_tot, the diffuse base gets in both
 * directions, (1 - E_tot(o)) (1 - E_tot(i)) / (1 - E_tot,avg) (Kelemen and Szirmay-Kalos 2001), so
 * that white layers over a white base return exactly what falls on them. */
#include "shading/layers.h"

#include "shading/anisotropic.h"
#include "shading/coat.h"
#include "shading/diffuse_base.h"
#include "shading/iridescence.h"
#include "shading/layers_top.h"
#include "shading/sheen.h"

static const float gather_alpha = 0.2f; /* as in bsdf.c */

/* ---- the base's speculars -------------------------------------------------------------------- */

static bool is_mirror(const ppmi_bsdf_layers *layers)
{
    return ppmi_max(layers->alpha.x, layers->alpha.y) < PPMI_SMOOTH_ALPHA;
}

static ppmi_vec3 film_at(const ppmi_bsdf_layers *layers, ppmi_vec3 f0, float cosine)
{
    return ppmi_film_reflectance(layers->film_ior, layers->film_nm, f0, cosine,
                                 layers->space ? layers->space : &ppmi_working_space_rec709);
}

static ppmi_vec3 spec_fresnel(const ppmi_bsdf *bsdf, float cos_h)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    ppmi_vec3 plain = vec3_lerp(bsdf->f0, bsdf->f90, ppmi_schlick_weight(cos_h));
    if (layers->has_metal_edge) {
        plain = vec3_mad(plain, layers->metal_edge, -ppmi_f82_shape(cos_h));
        plain = vec3(ppmi_max(plain.x, 0.0f), ppmi_max(plain.y, 0.0f), ppmi_max(plain.z, 0.0f));
    }
    if (!(layers->film > 0.0f)) return plain;
    ppmi_vec3 film = vec3_splat(0.0f);
    if (layers->metallic < 1.0f) {
        film = vec3_scale(film_at(layers, layers->film_f0, cos_h), 1.0f - layers->metallic);
    }
    if (layers->metallic > 0.0f) {
        /* f0 = opaque (dielectric (1 - metallic) + metal metallic) */
        const ppmi_vec3 metal =
            vec3_scale(vec3_sub(vec3_scale(bsdf->f0, 1.0f / layers->opaque),
                                vec3_scale(layers->film_f0, 1.0f - layers->metallic)),
                       1.0f / layers->metallic);
        film = vec3_mad(film, film_at(layers, metal, cos_h), layers->metallic);
    }
    return vec3_lerp(plain, vec3_scale(film, layers->opaque), layers->film);
}

static ppmi_albedo_pair spec_pair(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                  ppmi_vec3 w)
{
    const float strength = bsdf->layers.anisotropy;
    if (!(strength > 0.0f)) return ppmi_albedo_directional(albedo, bsdf->roughness, w.z);
    return ppmi_lobe_wide_albedo(albedo->lobes, bsdf->roughness, strength, w);
}

/* Cosines that stand for the whole lobe. Returns their number. */
static int spec_nodes(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, float cosine,
                      ppmi_lobe_nodes *nodes)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    if (is_mirror(layers)) {
        nodes->cos_i[0] = nodes->cos_h[0] = cosine;
        return 1;
    }
    ppmi_lobe_ggx_nodes(albedo->lobes, ppmi_mean_roughness(layers->alpha), cosine, nodes);
    return PPMI_LOBE_NODES;
}

/* Albedo of the speculars under the film, by its strongest channel. Schlick's curve between the
 * film's ends is integrated by the table, only what the film adds to it by the nodes: the horizon
 * would need many. */
static float film_albedo(const ppmi_bsdf_layers *layers, ppmi_albedo_pair pair,
                         const ppmi_lobe_nodes *nodes, int count)
{
    const float f0 = vec3_max_component(film_at(layers, layers->film_f0, 1.0f));
    float beyond = 0.0f;
    for (int k = 0; k < count; k++) {
        const float c = nodes->cos_h[k];
        beyond += vec3_max_component(film_at(layers, layers->film_f0, c)) - ppmi_schlick(f0, c);
    }
    return ppmi_albedo_value(pair, f0, 1.0f) + (pair.a + pair.b) * beyond / (float)count;
}

/* Share of the lobe that passes the layers above. */
static float spec_passing(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo,
                          float here, const ppmi_lobe_nodes *nodes, int count)
{
    float passing = 0.0f;
    for (int k = 0; k < count; k++) {
        const float c = nodes->cos_i[k];
        passing += ppmi_min(here, ppmi_top_left_over(layers, albedo, ppmi_coat_at_cosine(c), c));
    }
    return passing / (float)count;
}

static bool has_speculars(const ppmi_bsdf *bsdf)
{
    return !vec3_is_black(bsdf->f0) || !vec3_is_black(bsdf->f90) || bsdf->layers.film > 0.0f;
}

/* ---- what is left to the diffuse base -------------------------------------------------------- */

typedef struct leftovers {
    float dielectric, metal; /* 1 - E_tot over each kind of base; of the metal as if white */
} leftovers;

/* w is on the upper side; w_coat: the same in the coat's frame. */
static leftovers leftovers_at(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                              ppmi_vec3 w_coat, ppmi_vec3 w)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    const bool is_covered = ppmi_has_top(layers);
    const ppmi_top_albedos parts = is_covered ? ppmi_top_albedos_at(layers, albedo, w_coat, w.z)
                                              : (ppmi_top_albedos){0.0f, 0.0f};
    const float top = parts.coat + parts.sheen;
    leftovers left = {1.0f - top, 1.0f - top};
    if (!has_speculars(bsdf)) return left;
    const ppmi_albedo_pair pair = spec_pair(bsdf, albedo, w);
    float dielectric = ppmi_albedo_value(pair, bsdf->coat_f0, bsdf->coat_f90),
          metal = pair.a + pair.b;
    /* under a pure metal nothing asks for the dielectric's share, and a film is costly */
    const bool has_film = layers->film > 0.0f && layers->metallic < 1.0f;
    if (is_covered || has_film) {
        ppmi_lobe_nodes nodes;
        const int count = spec_nodes(bsdf, albedo, w.z, &nodes);
        if (has_film) {
            const float film = film_albedo(layers, pair, &nodes, count);
            dielectric += (film - dielectric) * layers->film;
        }
        if (is_covered) {
            const float here = ppmi_top_left_over(layers, albedo, w_coat, w.z);
            const float passing = spec_passing(layers, albedo, here, &nodes, count);
            dielectric *= passing;
            metal *= passing;
        }
    }
    left.dielectric = ppmi_max(left.dielectric - dielectric, 0.0f);
    left.metal = ppmi_max(left.metal - metal, 0.0f);
    return left;
}

/* Means over directions, by cosine: Gauss and Legendre's rule in the root of the cosine, since all
 * that varies does so at the horizon. */
static leftovers average_leftovers(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo)
{
    static const float roots[5] = {0.046910f, 0.230765f, 0.5f, 0.769235f, 0.953090f};
    static const float weights[5] = {0.118463f, 0.239314f, 0.284444f, 0.239314f, 0.118463f};
    static const float azimuths[2][2] = {{0.92388f, 0.38268f}, {0.38268f, 0.92388f}};
    const bool is_turned = bsdf->layers.anisotropy > 0.0f || bsdf->layers.coat_anisotropy > 0.0f;
    const int turns = is_turned ? 2 : 1;
    leftovers mean = {0.0f, 0.0f};
    for (int i = 0; i < 5; i++) {
        const float t = roots[i], cosine = t * t, sine = sqrtf(1.0f - cosine * cosine);
        const float weight = weights[i] * 4.0f * t * t * t / (float)turns;
        for (int k = 0; k < turns; k++) {
            const ppmi_vec3 w = vec3(sine * azimuths[k][0], sine * azimuths[k][1], cosine);
            const leftovers left = leftovers_at(bsdf, albedo, w, w);
            mean.dielectric += weight * left.dielectric;
            mean.metal += weight * left.metal;
        }
    }
    return mean;
}

/* ---- making ---------------------------------------------------------------------------------- */

/* Turns the frame so that its x axis follows the direction of anisotropy. */
static void turn_frame(ppmi_bsdf *bsdf, ppmi_vec3 tangent)
{
    const ppmi_vec3 n = bsdf->frame.n;
    const ppmi_vec3 flat = vec3_mad(tangent, n, -vec3_dot(tangent, n));
    if (!(vec3_length2(flat) > 1e-8f)) return;
    const ppmi_vec3 wo = ppmi_frame_to_world(&bsdf->frame, bsdf->wo);
    bsdf->frame.s = vec3_normalize(flat);
    bsdf->frame.t = vec3_cross(n, bsdf->frame.s);
    bsdf->wo = ppmi_frame_to_local(&bsdf->frame, wo);
    bsdf->wo.z = ppmi_max(bsdf->wo.z, 1e-4f);
}

static void set_layers(ppmi_bsdf *bsdf, const ppmi_layer_point *point,
                       const ppmi_base_shares *shares)
{
    const float narrow = ppmi_max(bsdf->alpha, PPMI_SMOOTH_ALPHA);
    const bool is_wide = point->anisotropy > 0.0f;
    bsdf->layers = (ppmi_bsdf_layers){
        .sheen_color = point->sheen_color,
        .sheen_share = point->sheen_share,
        .sheen_is_on_top = point->sheen_is_on_top,
        .sheen_roughness = ppmi_max(point->sheen_roughness, PPMI_SHEEN_LEAST_ROUGHNESS),
        .passing = 1.0f,
        .film = point->film_nm > 0.0f ? point->film : 0.0f,
        .film_ior = point->film_ior,
        .film_nm = point->film_nm,
        .space = point->space,
        .film_f0 = shares->dielectric_f0,
        .alpha = {bsdf->alpha, bsdf->alpha},
        .anisotropy = point->anisotropy,
        .retro = point->retro,
        .opaque = shares->opaque,
        .metallic = shares->metallic,
    };
    if (is_wide) {
        bsdf->layers.alpha = (ppmi_vec2){ppmi_wide_alpha(narrow, point->anisotropy), narrow};
    }
}

static void set_coat(ppmi_bsdf *bsdf, const ppmi_layer_point *point)
{
    ppmi_bsdf_layers *layers = &bsdf->layers;
    const float alpha = ppmi_sqr(point->coat_roughness);
    layers->coat = point->coat;
    layers->coat_f0 = ppmi_coat_f0(point->coat_ior);
    layers->coat_ior = point->coat_ior;
    layers->coat_alpha = (ppmi_vec2){alpha, alpha};
    layers->coat_roughness = point->coat_roughness;
    layers->coat_tangent = ppmi_frame_to_local(&bsdf->frame, point->coat_tangent);
    if (!(point->coat_anisotropy > 0.0f)) return;
    const float narrow = ppmi_max(alpha, PPMI_SMOOTH_ALPHA);
    const float wide = ppmi_wide_alpha(narrow, point->coat_anisotropy);
    layers->coat_alpha = (ppmi_vec2){wide, narrow};
    layers->coat_anisotropy = point->coat_anisotropy;
}

/* Of the diffuse base and of a metal, by its roughness: a smooth one gets back what its own
 * direction says, on average over all. */
static float darkened(const ppmi_bsdf_layers *layers, float roughness, float color)
{
    const float diffuse = ppmi_coat_internal_diffuse(layers->coat_ior);
    const float smooth = layers->coat_f0 + (1.0f - layers->coat_f0) / 21.0f;
    const float metal = smooth + (diffuse - smooth) * roughness;
    return (1.0f - layers->metallic) * ppmi_coat_darkening(color, diffuse) +
           layers->metallic * ppmi_coat_darkening(color, metal);
}

static void set_coat_color(ppmi_bsdf *bsdf, const ppmi_material_point *point)
{
    ppmi_bsdf_layers *layers = &bsdf->layers;
    const ppmi_vec3 white = vec3_splat(1.0f), color = point->base_color;
    layers->coat_tint = point->layers.coat_tint;
    layers->coat_darkened = white;
    if (point->layers.coat_darkening > 0.0f) {
        const ppmi_vec3 all = vec3(darkened(layers, bsdf->roughness, color.x),
                                   darkened(layers, bsdf->roughness, color.y),
                                   darkened(layers, bsdf->roughness, color.z));
        layers->coat_darkened = vec3_lerp(white, all, point->layers.coat_darkening);
    }
    const ppmi_vec3 both = vec3_mul(layers->coat_tint, layers->coat_darkened);
    layers->is_coat_tinted =
        layers->coat > 0.0f && (both.x < 1.0f || both.y < 1.0f || both.z < 1.0f);
}

static void set_metal_edge(ppmi_bsdf *bsdf, const ppmi_material_point *point)
{
    ppmi_bsdf_layers *layers = &bsdf->layers;
    layers->has_metal_edge = point->edge_color && layers->metallic > 0.0f;
    if (!layers->has_metal_edge) return;
    const float weight = point->specular, share = layers->opaque * layers->metallic;
    const ppmi_vec3 f0 = point->base_color, edge = point->specular_color;
    layers->metal_edge = vec3(share * ppmi_f82_coefficient(f0.x, ppmi_min(edge.x * weight, 1.0f)),
                              share * ppmi_f82_coefficient(f0.y, ppmi_min(edge.y * weight, 1.0f)),
                              share * ppmi_f82_coefficient(f0.z, ppmi_min(edge.z * weight, 1.0f)));
}

/* Kulla and Conty: F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg)), of a metal's colour. */
static float multiple_scattering(float color, float e_average)
{
    const float f = color + (1.0f - color) / 21.0f;
    return f * f * e_average / (1.0f - f * (1.0f - e_average));
}

static void set_diffuse(ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                        const ppmi_material_point *point, const leftovers *average)
{
    ppmi_bsdf_layers *layers = &bsdf->layers;
    const leftovers left =
        leftovers_at(bsdf, albedo, ppmi_coat_direction(layers, bsdf->wo), bsdf->wo);
    const float dielectric = layers->opaque * (1.0f - layers->metallic) * left.dielectric /
                             ppmi_max(average->dielectric, 1e-4f);
    const float through = point->layers.through;
    bsdf->coat_base = vec3_scale(point->base_color, dielectric * (1.0f - through));
    layers->through = vec3_scale(point->layers.through_color, dielectric * through);
    layers->through_color = point->layers.through_color;
    if (!(layers->metallic > 0.0f) || !(average->metal > 1e-4f)) return;
    const ppmi_albedo_pair pair = ppmi_albedo_average(albedo, bsdf->roughness);
    const float e = pair.a + pair.b;
    const ppmi_vec3 c = point->base_color;
    const ppmi_vec3 f_ms =
        vec3(multiple_scattering(c.x, e), multiple_scattering(c.y, e), multiple_scattering(c.z, e));
    bsdf->metal_base =
        vec3_scale(f_ms, layers->opaque * layers->metallic * left.metal / average->metal);
}

static void set_masks(ppmi_bsdf *bsdf)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    const uint8_t speculars = PPMI_LOBE_SPEC | PPMI_LOBE_RETRO;
    bsdf->gather_lobes = PPMI_LOBE_WIDE | PPMI_LOBE_SHEEN | PPMI_LOBE_THROUGH;
    if (ppmi_min(layers->alpha.x, layers->alpha.y) >= gather_alpha) {
        bsdf->gather_lobes |= speculars;
    }
    if (ppmi_min(layers->coat_alpha.x, layers->coat_alpha.y) >= gather_alpha) {
        bsdf->gather_lobes |= PPMI_LOBE_COAT;
    }
    bsdf->delta_lobes = 0;
    if (is_mirror(layers)) bsdf->delta_lobes |= speculars;
    if (ppmi_coat_is_mirror(layers)) bsdf->delta_lobes |= PPMI_LOBE_COAT;
    if (bsdf->glass_alpha < PPMI_SMOOTH_ALPHA) bsdf->delta_lobes |= PPMI_LOBE_GLASS;
}

static float spec_albedo(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo)
{
    if (!has_speculars(bsdf)) return 0.0f;
    const ppmi_albedo_pair pair = spec_pair(bsdf, albedo, bsdf->wo);
    if (bsdf->layers.film > 0.0f) {
        return (pair.a + pair.b) * vec3_max_component(spec_fresnel(bsdf, bsdf->wo.z));
    }
    return ppmi_albedo_value(pair, vec3_max_component(bsdf->f0), vec3_max_component(bsdf->f90));
}

/* What the fibres reflect of what they stop, by the strongest channel. */
static float sheen_whiteness(const ppmi_bsdf_layers *layers)
{
    const float share = layers->sheen_share;
    return share > 0.0f ? vec3_max_component(layers->sheen_color) / share : 0.0f;
}

void ppmi_layers_make(ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                      const ppmi_material_point *point, const ppmi_base_shares *shares,
                      ppmi_vec3 coat_normal, ppmi_lobe_albedos *out_albedos)
{
    ppmi_bsdf_layers *layers = &bsdf->layers;
    bsdf->is_layered = true;
    set_layers(bsdf, &point->layers, shares);
    if (layers->anisotropy > 0.0f) turn_frame(bsdf, point->layers.tangent);
    layers->coat_normal = ppmi_frame_to_local(&bsdf->frame, coat_normal);
    set_coat(bsdf, &point->layers);
    set_coat_color(bsdf, point);
    set_metal_edge(bsdf, point);
    const ppmi_vec3 w_coat = ppmi_coat_direction(layers, bsdf->wo);
    const float cosine = bsdf->wo.z;
    if (ppmi_has_top(layers)) layers->passing = ppmi_top_left_over(layers, albedo, w_coat, cosine);
    const leftovers average = average_leftovers(bsdf, albedo);
    set_diffuse(bsdf, albedo, point, &average);
    set_masks(bsdf);
    const ppmi_top_albedos top = ppmi_top_albedos_at(layers, albedo, w_coat, cosine);
    const float speculars = layers->passing * spec_albedo(bsdf, albedo);
    *out_albedos = (ppmi_lobe_albedos){{
        vec3_max_component(bsdf->coat_base) * average.dielectric +
            vec3_max_component(bsdf->metal_base) * average.metal,
        speculars * (1.0f - layers->retro),
        bsdf->glass_weight * layers->passing,
        0.0f,
        top.coat,
        top.sheen * sheen_whiteness(layers),
        vec3_max_component(layers->through) * average.dielectric,
        speculars * layers->retro,
    }};
}

/* ---- albedo ---------------------------------------------------------------------------------- */

/* As film_albedo, by channel and of the whole base: what the film adds to Schlick's curve between
 * its ends. */
static ppmi_vec3 film_beyond(const ppmi_bsdf *bsdf, ppmi_vec3 f0, ppmi_vec3 f90,
                             const ppmi_lobe_nodes *nodes, int count)
{
    ppmi_vec3 sum = vec3_splat(0.0f);
    for (int k = 0; k < count; k++) {
        const float c = nodes->cos_h[k];
        const ppmi_vec3 curve = vec3_lerp(f0, f90, ppmi_schlick_weight(c));
        sum = vec3_add(sum, vec3_sub(spec_fresnel(bsdf, c), curve));
    }
    return vec3_scale(sum, 1.0f / (float)count);
}

/* What metals lack of Schlick's curve at their edges, over the lobe. */
static ppmi_vec3 edge_albedo(const ppmi_bsdf *bsdf, ppmi_albedo_pair pair,
                             const ppmi_lobe_nodes *nodes, int count)
{
    float shape = 0.0f;
    for (int k = 0; k < count; k++)
        shape += ppmi_f82_shape(nodes->cos_h[k]);
    return vec3_scale(bsdf->layers.metal_edge, (pair.a + pair.b) * shape / (float)count);
}

static ppmi_vec3 colored_spec_albedo(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    if (!has_speculars(bsdf)) return vec3_splat(0.0f);
    const bool has_film = layers->film > 0.0f, is_covered = ppmi_has_top(layers);
    const ppmi_albedo_pair pair = spec_pair(bsdf, albedo, bsdf->wo);
    const ppmi_vec3 f0 = has_film ? spec_fresnel(bsdf, 1.0f) : bsdf->f0;
    const ppmi_vec3 f90 =
        has_film ? vec3_lerp(bsdf->f90, vec3_splat(layers->opaque), layers->film) : bsdf->f90;
    ppmi_vec3 sum = vec3_mad(vec3_scale(f0, pair.a), f90, pair.b);
    if (!has_film && !is_covered && !layers->has_metal_edge) return sum;
    ppmi_lobe_nodes nodes;
    const int count = spec_nodes(bsdf, albedo, bsdf->wo.z, &nodes);
    if (has_film) {
        const ppmi_vec3 beyond = film_beyond(bsdf, f0, f90, &nodes, count);
        sum = vec3_mad(sum, beyond, pair.a + pair.b);
    } else if (layers->has_metal_edge) {
        sum = vec3_sub(sum, edge_albedo(bsdf, pair, &nodes, count));
    }
    if (!is_covered) return sum;
    sum = vec3_mul(sum, ppmi_base_tint_to(bsdf, bsdf->wo));
    return vec3_scale(sum, spec_passing(layers, albedo, layers->passing, &nodes, count));
}

static ppmi_vec3 diffuse_albedo(const ppmi_bsdf *bsdf, const leftovers *average, uint32_t mask)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    ppmi_vec3 sum = vec3_splat(0.0f);
    if (mask & PPMI_LOBE_WIDE) {
        sum = vec3_scale(ppmi_bsdf_diffuse_albedo(bsdf, bsdf->coat_base, bsdf->tint),
                         average->dielectric);
        sum = vec3_mad(sum, bsdf->metal_base, average->metal);
    }
    if (mask & PPMI_LOBE_THROUGH) {
        sum = vec3_mad(sum, ppmi_bsdf_diffuse_albedo(bsdf, layers->through, layers->through_color),
                       average->dielectric);
    }
    return vec3_mul(sum, ppmi_base_tint(bsdf, ppmi_coat_mean_path(layers->coat_ior)));
}

ppmi_vec3 ppmi_layers_albedo(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t mask)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    const ppmi_top_albedos top =
        ppmi_top_albedos_at(layers, albedo, ppmi_coat_direction(layers, bsdf->wo), bsdf->wo.z);
    ppmi_vec3 sum = vec3_splat(mask & PPMI_LOBE_COAT ? top.coat : 0.0f);
    if (mask & (PPMI_LOBE_WIDE | PPMI_LOBE_THROUGH)) {
        const leftovers average = average_leftovers(bsdf, albedo);
        sum = vec3_add(sum, diffuse_albedo(bsdf, &average, mask));
    }
    const float share = (mask & PPMI_LOBE_SPEC ? 1.0f - layers->retro : 0.0f) +
                        (mask & PPMI_LOBE_RETRO ? layers->retro : 0.0f);
    if (share > 0.0f) sum = vec3_mad(sum, colored_spec_albedo(bsdf, albedo), share);
    if (mask & PPMI_LOBE_SHEEN && layers->sheen_share > 0.0f) {
        const ppmi_vec3 sheen = vec3_scale(layers->sheen_color, top.sheen / layers->sheen_share);
        const bool is_below = !layers->sheen_is_on_top;
        sum = vec3_add(sum, is_below ? vec3_mul(sheen, ppmi_sheen_tint_to(bsdf, bsdf->wo)) : sheen);
    }
    return sum;
}

/* ---- evaluation ------------------------------------------------------------------------------ */

/* wo, or for the retroreflective half of the speculars its mirror image: Portsmouth et al. 2026,
 * "The Minimal Retroreflective Microfacet Model" (JCGT 15.1). */
static ppmi_vec3 spec_origin(const ppmi_bsdf *bsdf, uint32_t lobe)
{
    const ppmi_vec3 wo = bsdf->wo;
    return lobe == PPMI_LOBE_RETRO ? vec3(-wo.x, -wo.y, wo.z) : wo;
}

static ppmi_vec3 spec_eval(const ppmi_bsdf *bsdf, ppmi_vec3 wo, ppmi_vec3 wi)
{
    const ppmi_vec2 alpha = bsdf->layers.alpha;
    const ppmi_vec3 h = vec3_normalize(vec3_add(wo, wi));
    const float dg = ppmi_ggx2_d(alpha, h) * ppmi_ggx2_g2(alpha, wo, wi);
    return vec3_scale(spec_fresnel(bsdf, vec3_dot(wi, h)), dg / (4.0f * wo.z * wi.z));
}

static float spec_pdf(const ppmi_bsdf *bsdf, ppmi_vec3 wo, ppmi_vec3 wi)
{
    const ppmi_vec3 h = vec3_normalize(vec3_add(wo, wi));
    const float cos_oh = vec3_dot(wo, h);
    if (cos_oh <= 0.0f) return 0.0f;
    return ppmi_ggx2_visible_d(bsdf->layers.alpha, wo, h) / (4.0f * cos_oh);
}

/* Share of the speculars that is in a lobe. */
static float spec_share(const ppmi_bsdf_layers *layers, uint32_t lobe)
{
    return lobe == PPMI_LOBE_RETRO ? layers->retro : 1.0f - layers->retro;
}

static ppmi_vec3 speculars_eval(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                ppmi_vec3 wi, uint32_t mask)
{
    ppmi_vec3 f = vec3_splat(0.0f);
    for (uint32_t lobe = PPMI_LOBE_SPEC; lobe != 0;
         lobe = lobe == PPMI_LOBE_SPEC ? PPMI_LOBE_RETRO : 0) {
        if (!(mask & lobe)) continue;
        f = vec3_mad(f, spec_eval(bsdf, spec_origin(bsdf, lobe), wi),
                     spec_share(&bsdf->layers, lobe));
    }
    f = vec3_mul(f, ppmi_base_tint_to(bsdf, wi));
    return vec3_scale(f, ppmi_top_passing(bsdf, albedo, wi));
}

static ppmi_vec3 sheen_eval(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    const float alpha = layers->sheen_roughness * layers->sheen_roughness;
    float f = ppmi_sheen_value(alpha, bsdf->wo, ppmi_sheen_lambda(bsdf->wo.z, alpha), wi,
                               ppmi_sheen_lambda(wi.z, alpha));
    f *= ppmi_min(ppmi_lobe_sheen_bound(albedo->lobes, layers->sheen_roughness, bsdf->wo.z),
                  ppmi_lobe_sheen_bound(albedo->lobes, layers->sheen_roughness, wi.z));
    if (layers->sheen_is_on_top || !(layers->coat > 0.0f)) {
        return vec3_scale(layers->sheen_color, f);
    }
    f *= 1.0f - ppmi_max(ppmi_coat_albedo(layers, albedo, ppmi_coat_direction(layers, bsdf->wo)),
                         ppmi_coat_albedo(layers, albedo, ppmi_coat_direction(layers, wi)));
    return vec3_scale(vec3_mul(layers->sheen_color, ppmi_sheen_tint_to(bsdf, wi)), f);
}

/* The diffuse base to one side or the other. */
static ppmi_vec3 diffuse_eval(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    const ppmi_vec3 upper = vec3(wi.x, wi.y, fabsf(wi.z));
    const leftovers left = leftovers_at(bsdf, albedo, ppmi_coat_direction(layers, wi), upper);
    ppmi_vec3 f;
    if (wi.z > 0.0f) {
        f = vec3_scale(ppmi_bsdf_diffuse(bsdf, bsdf->coat_base, bsdf->tint, upper),
                       left.dielectric);
        f = vec3_mad(f, bsdf->metal_base, left.metal);
    } else {
        f = vec3_scale(ppmi_bsdf_diffuse(bsdf, layers->through, layers->through_color, upper),
                       left.dielectric);
    }
    return vec3_scale(vec3_mul(f, ppmi_base_tint_to(bsdf, wi)), PPMI_INV_PI);
}

ppmi_vec3 ppmi_layers_eval_base(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                ppmi_vec3 wi, uint32_t mask)
{
    const bool is_reflection = wi.z > 0.0f;
    ppmi_vec3 f = vec3_splat(0.0f);
    if (mask & (is_reflection ? PPMI_LOBE_WIDE : PPMI_LOBE_THROUGH)) {
        f = diffuse_eval(bsdf, albedo, wi);
    }
    if (!is_reflection) return f;
    if (mask & (PPMI_LOBE_SPEC | PPMI_LOBE_RETRO)) {
        f = vec3_add(f, speculars_eval(bsdf, albedo, wi, mask));
    }
    if (mask & PPMI_LOBE_SHEEN) f = vec3_add(f, sheen_eval(bsdf, albedo, wi));
    return f;
}

float ppmi_layers_pdf_base(const ppmi_bsdf *bsdf, ppmi_vec3 wi, uint32_t mask)
{
    const float *p = bsdf->lobe_probability;
    if (wi.z < 0.0f) return mask & PPMI_LOBE_THROUGH ? -p[6] * wi.z * PPMI_INV_PI : 0.0f;
    float pdf = 0.0f;
    if (mask & PPMI_LOBE_WIDE) pdf += p[0] * wi.z * PPMI_INV_PI;
    if (mask & PPMI_LOBE_SPEC) pdf += p[1] * spec_pdf(bsdf, bsdf->wo, wi);
    if (mask & PPMI_LOBE_SHEEN) pdf += p[5] * 0.5f * PPMI_INV_PI;
    if (mask & PPMI_LOBE_RETRO) {
        pdf += p[7] * spec_pdf(bsdf, spec_origin(bsdf, PPMI_LOBE_RETRO), wi);
    }
    return pdf;
}

/* ---- the coat -------------------------------------------------------------------------------- */

/* What turns the coat's f so that the base's cosine makes it right: radiance is gathered by the
 * cosine of where light comes from, which for power is wo. */
static float coat_cosine_ratio(const ppmi_bsdf *bsdf, ppmi_vec3 wi, float coat_o, float coat_i,
                               ppmi_transport transport)
{
    const float base = transport == PPMI_TRANSPORT_RADIANCE ? fabsf(wi.z) : bsdf->wo.z;
    const float coat = transport == PPMI_TRANSPORT_RADIANCE ? coat_i : coat_o;
    return coat / ppmi_max(base, 1e-4f);
}

ppmi_vec3 ppmi_layers_eval_coat(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                ppmi_vec3 wi, ppmi_transport transport)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    const ppmi_frame frame = ppmi_coat_frame(layers);
    const ppmi_vec3 o = ppmi_frame_to_local(&frame, bsdf->wo), i = ppmi_frame_to_local(&frame, wi);
    if (o.z <= 0.0f || i.z <= 0.0f) return vec3_splat(0.0f);
    const ppmi_vec2 alpha = layers->coat_alpha;
    const ppmi_vec3 h = vec3_normalize(vec3_add(o, i));
    const float dg = ppmi_ggx2_d(alpha, h) * ppmi_ggx2_g2(alpha, o, i);
    const float share = layers->coat * ppmi_fuzz_passing(bsdf, albedo, wi.z);
    const float f = share * ppmi_schlick(layers->coat_f0, vec3_dot(i, h)) * dg / (4.0f * o.z * i.z);
    return vec3_splat(f * coat_cosine_ratio(bsdf, wi, o.z, i.z, transport));
}

float ppmi_layers_pdf_coat(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const ppmi_frame frame = ppmi_coat_frame(&bsdf->layers);
    const ppmi_vec3 o = ppmi_frame_to_local(&frame, bsdf->wo), i = ppmi_frame_to_local(&frame, wi);
    const ppmi_vec3 h = vec3_normalize(vec3_add(o, i));
    const float cos_oh = vec3_dot(o, h);
    if (o.z <= 0.0f || i.z <= 0.0f || cos_oh <= 0.0f) return 0.0f;
    return ppmi_ggx2_visible_d(bsdf->layers.coat_alpha, o, h) / (4.0f * cos_oh);
}

/* ---- sampling -------------------------------------------------------------------------------- */

static ppmi_vec3 reflect_about(ppmi_vec3 wo, ppmi_vec3 h)
{
    return vec3_sub(vec3_scale(h, 2.0f * vec3_dot(wo, h)), wo);
}

static bool draw_coat(const ppmi_bsdf *bsdf, float u, float v, ppmi_vec3 *wi)
{
    const ppmi_frame frame = ppmi_coat_frame(&bsdf->layers);
    const ppmi_vec3 o = ppmi_frame_to_local(&frame, bsdf->wo);
    if (o.z <= 0.0f) return false;
    const ppmi_vec3 i =
        reflect_about(o, ppmi_ggx2_sample_visible(bsdf->layers.coat_alpha, o, u, v));
    *wi = ppmi_frame_to_world(&frame, i);
    return i.z > 0.0f;
}

bool ppmi_layers_draw(const ppmi_bsdf *bsdf, uint32_t lobe, float u, float v, ppmi_vec3 *out_wi)
{
    const ppmi_vec3 wo = spec_origin(bsdf, lobe);
    switch (lobe) {
    case PPMI_LOBE_WIDE:
        *out_wi = ppmi_sample_cosine_hemisphere(u, v);
        return true;
    case PPMI_LOBE_THROUGH:
        *out_wi = vec3_neg(ppmi_sample_cosine_hemisphere(u, v));
        return true;
    case PPMI_LOBE_SHEEN: /* strong at the horizon: evenly */
        *out_wi = ppmi_direction_at(1.0f - u, v);
        return true;
    case PPMI_LOBE_COAT:
        return draw_coat(bsdf, u, v, out_wi);
    default:
        *out_wi = reflect_about(wo, ppmi_ggx2_sample_visible(bsdf->layers.alpha, wo, u, v));
        return out_wi->z > 0.0f;
    }
}

bool ppmi_layers_mirror(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, uint32_t lobe,
                        ppmi_transport transport, ppmi_vec3 *out_wi, ppmi_vec3 *out_weight)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    if (lobe == PPMI_LOBE_COAT) {
        const float cosine = vec3_dot(bsdf->wo, layers->coat_normal);
        if (cosine <= 0.0f) return false;
        *out_wi = reflect_about(bsdf->wo, layers->coat_normal);
        float weight = layers->coat * ppmi_schlick(layers->coat_f0, cosine);
        weight *= ppmi_fuzz_passing(bsdf, albedo, out_wi->z);
        /* power: by the base's cosines, as for the rough coat; the coat's cancel */
        if (transport == PPMI_TRANSPORT_POWER) weight *= fabsf(out_wi->z) / bsdf->wo.z;
        *out_weight = vec3_splat(weight);
        return true;
    }
    const ppmi_vec3 wo = spec_origin(bsdf, lobe);
    *out_wi = vec3(-wo.x, -wo.y, wo.z);
    const float share = spec_share(layers, lobe) * ppmi_top_passing(bsdf, albedo, *out_wi);
    *out_weight =
        vec3_scale(vec3_mul(spec_fresnel(bsdf, wo.z), ppmi_base_tint_to(bsdf, *out_wi)), share);
    return true;
}

/* ---- glass ----------------------------------------------------------------------------------- */

ppmi_vec3 ppmi_layers_glass(const ppmi_bsdf *bsdf, float plain, float cos_outside)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    const float f0 = ppmi_sqr((bsdf->eta - 1.0f) / (bsdf->eta + 1.0f));
    const ppmi_vec3 film = film_at(layers, vec3_splat(f0), cos_outside);
    return vec3_lerp(vec3_splat(plain), film, layers->film);
}
