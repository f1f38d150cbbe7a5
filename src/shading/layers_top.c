/* What lies on top of layered materials. */
#include "shading/layers_top.h"

#include "shading/coat.h"
#include "shading/microfacet.h"

bool ppmi_coat_is_mirror(const ppmi_bsdf_layers *layers)
{
    return ppmi_max(layers->coat_alpha.x, layers->coat_alpha.y) < PPMI_SMOOTH_ALPHA;
}

/* ---- what they reflect ----------------------------------------------------------------------- */

ppmi_frame ppmi_coat_frame(const ppmi_bsdf_layers *layers)
{
    const ppmi_vec3 n = layers->coat_normal, t = layers->coat_tangent;
    ppmi_frame frame = ppmi_frame_from_normal(n);
    if (!(layers->coat_anisotropy > 0.0f)) return frame;
    const ppmi_vec3 flat = vec3_mad(t, n, -vec3_dot(t, n));
    if (!(vec3_length2(flat) > 1e-8f)) return frame;
    frame.s = vec3_normalize(flat);
    frame.t = vec3_cross(n, frame.s);
    return frame;
}

ppmi_vec3 ppmi_coat_direction(const ppmi_bsdf_layers *layers, ppmi_vec3 w)
{
    if (!(layers->coat > 0.0f)) return vec3(0.0f, 0.0f, 1.0f);
    if (!(layers->coat_anisotropy > 0.0f)) {
        return vec3(0.0f, 0.0f, fabsf(vec3_dot(layers->coat_normal, w)));
    }
    const ppmi_frame frame = ppmi_coat_frame(layers);
    const ppmi_vec3 local = ppmi_frame_to_local(&frame, w);
    return vec3(local.x, local.y, fabsf(local.z));
}

ppmi_vec3 ppmi_coat_at_cosine(float cosine)
{
    const float side = sqrtf(ppmi_max(0.5f * (1.0f - cosine * cosine), 0.0f));
    return vec3(side, side, cosine);
}

float ppmi_coat_albedo(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo, ppmi_vec3 w)
{
    if (!(layers->coat > 0.0f)) return 0.0f;
    if (ppmi_coat_is_mirror(layers)) return layers->coat * ppmi_schlick(layers->coat_f0, w.z);
    const ppmi_albedo_pair pair =
        layers->coat_anisotropy > 0.0f
            ? ppmi_lobe_wide_albedo(albedo->lobes, layers->coat_roughness, layers->coat_anisotropy,
                                    w)
            : ppmi_albedo_directional(albedo, layers->coat_roughness, w.z);
    return layers->coat * ppmi_albedo_value(pair, layers->coat_f0, 1.0f);
}

float ppmi_sheen_albedo(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo,
                        float cosine)
{
    const float share = layers->sheen_share;
    if (!(share > 0.0f)) return 0.0f;
    return ppmi_min(share * ppmi_lobe_sheen_albedo(albedo->lobes, layers->sheen_roughness, cosine),
                    1.0f);
}

float ppmi_top_left_over(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo,
                         ppmi_vec3 w_coat, float cosine)
{
    return (1.0f - ppmi_coat_albedo(layers, albedo, w_coat)) *
           (1.0f - ppmi_sheen_albedo(layers, albedo, cosine));
}

bool ppmi_has_top(const ppmi_bsdf_layers *layers)
{
    return layers->coat > 0.0f || layers->sheen_share > 0.0f;
}

float ppmi_top_passing(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, ppmi_vec3 wi)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    if (!ppmi_has_top(layers)) return 1.0f;
    return ppmi_min(
        layers->passing,
        ppmi_top_left_over(layers, albedo, ppmi_coat_direction(layers, wi), fabsf(wi.z)));
}

float ppmi_fuzz_passing(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo, float cos_i)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    if (!layers->sheen_is_on_top) return 1.0f;
    return 1.0f - ppmi_max(ppmi_sheen_albedo(layers, albedo, bsdf->wo.z),
                           ppmi_sheen_albedo(layers, albedo, fabsf(cos_i)));
}

float ppmi_mean_roughness(ppmi_vec2 alpha)
{
    return sqrtf(sqrtf(0.5f * (ppmi_sqr(alpha.x) + ppmi_sqr(alpha.y))));
}

static float sheen_under_coat(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo,
                              float coat, float cosine)
{
    float nodes[PPMI_LOBE_NODES];
    ppmi_lobe_sheen_nodes(albedo->lobes, layers->sheen_roughness, cosine, nodes);
    float passing = 0.0f;
    for (int k = 0; k < PPMI_LOBE_NODES; k++)
        passing += ppmi_min(1.0f - coat,
                            1.0f - ppmi_coat_albedo(layers, albedo, ppmi_coat_at_cosine(nodes[k])));
    return passing / PPMI_LOBE_NODES;
}

static float coat_under_sheen(const ppmi_bsdf_layers *layers, const ppmi_albedo_table *albedo,
                              float sheen, float cosine)
{
    if (ppmi_coat_is_mirror(layers)) return 1.0f - sheen;
    ppmi_lobe_nodes nodes;
    ppmi_lobe_ggx_nodes(albedo->lobes, ppmi_mean_roughness(layers->coat_alpha), cosine, &nodes);
    float passing = 0.0f;
    for (int k = 0; k < PPMI_LOBE_NODES; k++)
        passing += ppmi_min(1.0f - sheen, 1.0f - ppmi_sheen_albedo(layers, albedo, nodes.cos_i[k]));
    return passing / PPMI_LOBE_NODES;
}

ppmi_top_albedos ppmi_top_albedos_at(const ppmi_bsdf_layers *layers,
                                     const ppmi_albedo_table *albedo, ppmi_vec3 w_coat,
                                     float cosine)
{
    ppmi_top_albedos top = {ppmi_coat_albedo(layers, albedo, w_coat),
                            ppmi_sheen_albedo(layers, albedo, cosine)};
    if (top.coat == 0.0f || top.sheen == 0.0f) return top;
    if (layers->sheen_is_on_top) {
        top.coat *= coat_under_sheen(layers, albedo, top.sheen, cosine);
    } else {
        top.sheen *= sheen_under_coat(layers, albedo, top.coat, cosine);
    }
    return top;
}

/* ---- the coat's colour ----------------------------------------------------------------------- */

/* What the coat leaves of light on a way through it of this length by a straight one: of the share
 * that is coated. */
static ppmi_vec3 tint_of(const ppmi_bsdf_layers *layers, float path)
{
    return vec3_lerp(vec3_splat(1.0f), ppmi_coat_transmittance(layers->coat_tint, path),
                     layers->coat);
}

ppmi_vec3 ppmi_base_tint(const ppmi_bsdf *bsdf, float path_in)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    if (!layers->is_coat_tinted) return vec3_splat(1.0f);
    const float path_out =
        ppmi_coat_path(layers->coat_ior, ppmi_coat_direction(layers, bsdf->wo).z);
    const ppmi_vec3 passed = vec3_mul(
        ppmi_coat_transmittance(layers->coat_tint, path_in + path_out), layers->coat_darkened);
    return vec3_lerp(vec3_splat(1.0f), passed, layers->coat);
}

ppmi_vec3 ppmi_base_tint_to(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    if (!layers->is_coat_tinted) return vec3_splat(1.0f);
    return ppmi_base_tint(bsdf,
                          ppmi_coat_path(layers->coat_ior, ppmi_coat_direction(layers, wi).z));
}

/* The sheen lies below the coat, without reflections to and fro. */
ppmi_vec3 ppmi_sheen_tint_to(const ppmi_bsdf *bsdf, ppmi_vec3 wi)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    if (!layers->is_coat_tinted) return vec3_splat(1.0f);
    return tint_of(layers,
                   ppmi_coat_path(layers->coat_ior, ppmi_coat_direction(layers, bsdf->wo).z) +
                       ppmi_coat_path(layers->coat_ior, ppmi_coat_direction(layers, wi).z));
}

/* Through the glass light crosses the coat once. */
ppmi_vec3 ppmi_layers_glass_passing(const ppmi_bsdf *bsdf, const ppmi_albedo_table *albedo,
                                    ppmi_vec3 wi)
{
    const ppmi_bsdf_layers *layers = &bsdf->layers;
    const ppmi_vec3 passing = vec3_splat(ppmi_top_passing(bsdf, albedo, wi));
    if (!layers->is_coat_tinted) return passing;
    const float path = ppmi_coat_path(layers->coat_ior, ppmi_coat_direction(layers, bsdf->wo).z) +
                       ppmi_coat_path(layers->coat_ior, ppmi_coat_direction(layers, wi).z);
    return vec3_mul(passing, tint_of(layers, wi.z > 0.0f ? path : 0.5f * path));
}
