/* Material evaluation: factors times textures. */
#include "shading/material.h"

#include "shading/coat.h"
#include "shading/microfacet.h"

static ppmi_texel lookup(const ppm_scene *scene, const ppmi_surface *surface,
                         const ppm_texture *texture)
{
    return ppmi_surface_texture(scene, surface, texture);
}

static float unit(float x)
{
    return ppmi_clampf(x, 0.0f, 1.0f);
}

__attribute__((noinline)) static ppmi_vec3 look_up_normal(const ppm_scene *scene,
                                                          const ppmi_surface *surface,
                                                          const ppm_texture *texture, float scale)
{
    ppmi_vec3 tangent, bitangent;
    if (!ppmi_surface_tangents(surface, texture, &tangent, &bitangent)) {
        return surface->ns;
    }
    const ppmi_texel texel = lookup(scene, surface, texture);
    const float x = (2.0f * texel.r - 1.0f) * scale;
    const float y = (2.0f * texel.g - 1.0f) * scale;
    const float z = 2.0f * texel.b - 1.0f;
    const ppmi_vec3 n = vec3_normalize(
        vec3_mad(vec3_mad(vec3_scale(tangent, x), bitangent, y), surface->ns, ppmi_max(z, 1e-3f)));
    return vec3_dot(n, surface->ng) > 0.0f && vec3_is_finite(n) ? n : surface->ns;
}

static inline ppmi_vec3 mapped_normal(const ppm_scene *scene, const ppmi_surface *surface,
                                      const ppm_texture *texture, float scale)
{
    return texture->image == 0 ? surface->ns : look_up_normal(scene, surface, texture, scale);
}

/* KHR_materials_pbrSpecularGlossiness has its glossiness in alpha, beside the specular colour. */
static float roughness(const ppm_material_desc *desc, ppmi_texel texel)
{
    if (desc->roughness_is_glossiness) return 1.0f - desc->roughness * texel.a;
    return desc->roughness * texel.g;
}

static float metallic(const ppm_material_desc *desc, ppmi_texel texel)
{
    return desc->roughness_is_glossiness ? desc->metallic : desc->metallic * texel.b;
}

/* ---- layers ---------------------------------------------------------------------------------- */

typedef struct anisotropy_source {
    float strength, rotation_rad;
    const ppm_texture *texture;
    const ppm_texture *normal_texture; /* of the surface whose highlight it is */
} anisotropy_source;

/* Strength and direction (KHR_materials_anisotropy): the texture's vector, turned, in the tangent
 * space of the texture, else along the tangent of the normal map's coordinates. Returns the
 * strength; 0 where there is no direction. */
static float evaluate_anisotropy(const ppm_scene *scene, const ppmi_surface *surface,
                                 const anisotropy_source *source, ppmi_vec3 *out_tangent)
{
    const ppm_texture mesh_axes = {.uv_set = source->normal_texture->uv_set};
    const bool is_mapped = source->texture->image > 0;
    const ppm_texture *axes = is_mapped ? source->texture : &mesh_axes;
    ppmi_vec3 tangent, bitangent;
    *out_tangent = vec3_splat(0.0f);
    if (!(source->strength > 0.0f) || !ppmi_surface_tangents(surface, axes, &tangent, &bitangent)) {
        return 0.0f;
    }
    float x = 1.0f, y = 0.0f, strength = source->strength;
    if (is_mapped) {
        const ppmi_texel texel = lookup(scene, surface, source->texture);
        x = 2.0f * texel.r - 1.0f;
        y = 2.0f * texel.g - 1.0f;
        strength *= texel.b;
    }
    const float c = cosf(source->rotation_rad), s = sinf(source->rotation_rad);
    *out_tangent = vec3_mad(vec3_scale(tangent, c * x - s * y), bitangent, s * x + c * y);
    return unit(strength);
}

static void evaluate_film(const ppm_scene *scene, const ppmi_surface *surface,
                          ppmi_layer_point *layers)
{
    const ppm_material_desc *desc = &surface->material->desc;
    const float t = lookup(scene, surface, &desc->iridescence_thickness_texture).g;
    const float least = desc->iridescence_thickness_min_nm;
    layers->film = unit(desc->iridescence * lookup(scene, surface, &desc->iridescence_texture).r);
    layers->film_ior = desc->iridescence_ior;
    layers->space = &scene->working;
    layers->film_nm = ppmi_max(least + (desc->iridescence_thickness_max_nm - least) * t, 0.0f);
}

static ppmi_vec3 color_at(const ppm_scene *scene, const ppmi_surface *surface,
                          const float factor[3], const ppm_texture *texture)
{
    const ppmi_texel texel = lookup(scene, surface, texture);
    return vec3(unit(factor[0] * texel.r), unit(factor[1] * texel.g), unit(factor[2] * texel.b));
}

static void evaluate_coat(const ppm_scene *scene, const ppmi_surface *surface,
                          ppmi_layer_point *layers)
{
    const ppm_material_desc *desc = &surface->material->desc;
    layers->coat = unit(desc->clearcoat * lookup(scene, surface, &desc->clearcoat_texture).r);
    layers->coat_roughness = unit(desc->clearcoat_roughness *
                                  lookup(scene, surface, &desc->clearcoat_roughness_texture).g);
    layers->coat_normal = mapped_normal(scene, surface, &desc->clearcoat_normal_texture,
                                        desc->clearcoat_normal_scale);
    layers->coat_tint = color_at(scene, surface, desc->coat_color, &desc->coat_color_texture);
    layers->coat_ior = desc->coat_ior;
    layers->coat_darkening = desc->coat_darkening;
    const anisotropy_source source = {desc->coat_anisotropy, desc->coat_anisotropy_rotation_rad,
                                      &desc->coat_anisotropy_texture,
                                      &desc->clearcoat_normal_texture};
    layers->coat_anisotropy = evaluate_anisotropy(scene, surface, &source, &layers->coat_tangent);
}

/* KHR_materials_fuzz says its share and its colour apart; the colour of a sheen is both. */
static void evaluate_sheen(const ppm_scene *scene, const ppmi_surface *surface,
                           ppmi_layer_point *layers)
{
    const ppm_material_desc *desc = &surface->material->desc;
    layers->sheen_color = color_at(scene, surface, desc->sheen_color, &desc->sheen_color_texture);
    layers->sheen_share = vec3_max_component(layers->sheen_color);
    layers->sheen_roughness =
        unit(desc->sheen_roughness * lookup(scene, surface, &desc->sheen_roughness_texture).a);
    layers->sheen_is_on_top = desc->fuzz > 0.0f;
    if (!layers->sheen_is_on_top) return;
    layers->sheen_share = unit(desc->fuzz * lookup(scene, surface, &desc->fuzz_texture).r);
    layers->sheen_color = vec3_scale(layers->sheen_color, layers->sheen_share);
}

__attribute__((noinline)) static void
evaluate_layers(const ppm_scene *scene, const ppmi_surface *surface, ppmi_layer_point *layers)
{
    const ppm_material_desc *desc = &surface->material->desc;
    *layers = (ppmi_layer_point){
        .through = unit(desc->diffuse_transmission *
                        lookup(scene, surface, &desc->diffuse_transmission_texture).a),
        .through_color = color_at(scene, surface, desc->diffuse_transmission_color,
                                  &desc->diffuse_transmission_color_texture),
        .retro =
            unit(desc->retroreflection * lookup(scene, surface, &desc->retroreflection_texture).r),
    };
    evaluate_coat(scene, surface, layers);
    evaluate_sheen(scene, surface, layers);
    if (desc->iridescence > 0.0f) evaluate_film(scene, surface, layers);
    const anisotropy_source source = {desc->anisotropy, desc->anisotropy_rotation_rad,
                                      &desc->anisotropy_texture, &desc->normal_texture};
    layers->anisotropy = evaluate_anisotropy(scene, surface, &source, &layers->tangent);
}

static float diffuse_roughness(const ppm_scene *scene, const ppmi_surface *surface)
{
    const ppm_material_desc *desc = &surface->material->desc;
    if (!(desc->diffuse_roughness > 0.0f)) return 0.0f;
    return unit(desc->diffuse_roughness *
                lookup(scene, surface, &desc->diffuse_roughness_texture).r);
}

void ppmi_material_evaluate(const ppm_scene *scene, const ppmi_surface *surface,
                            ppmi_material_point *out_point)
{
    const ppm_material_desc *desc = &surface->material->desc;
    float vertex[4];
    ppmi_surface_vertex_color(surface, vertex);
    const ppmi_texel base = lookup(scene, surface, &desc->base_color_texture);
    const ppmi_texel rough = lookup(scene, surface, &desc->metallic_roughness_texture);
    const ppmi_texel specular_color = lookup(scene, surface, &desc->specular_color_texture);
    out_point->base_color = vec3(unit(desc->base_color[0] * base.r * vertex[0]),
                                 unit(desc->base_color[1] * base.g * vertex[1]),
                                 unit(desc->base_color[2] * base.b * vertex[2]));
    out_point->metallic = unit(metallic(desc, rough));
    out_point->roughness = unit(roughness(desc, rough));
    out_point->ior = desc->ior;
    out_point->specular = unit(desc->specular * lookup(scene, surface, &desc->specular_texture).a);
    out_point->specular_color = vec3(ppmi_max(desc->specular_color[0] * specular_color.r, 0.0f),
                                     ppmi_max(desc->specular_color[1] * specular_color.g, 0.0f),
                                     ppmi_max(desc->specular_color[2] * specular_color.b, 0.0f));
    out_point->edge_color = desc->specular_is_edge_color != 0;
    out_point->diffuse_roughness = diffuse_roughness(scene, surface);
    out_point->transmission =
        unit(desc->transmission * lookup(scene, surface, &desc->transmission_texture).r);
    out_point->is_thin = desc->transmission_kind == PPM_TRANSMISSION_THIN;
    out_point->relative_index = 0.0f;
    out_point->ns = mapped_normal(scene, surface, &desc->normal_texture, desc->normal_scale);
    out_point->is_layered = surface->material->is_layered;
    if (out_point->is_layered) evaluate_layers(scene, surface, &out_point->layers);
}

float ppmi_material_coat_passing(const ppm_scene *scene, const ppmi_surface *surface, ppmi_vec3 wo)
{
    const ppm_material_desc *desc = &surface->material->desc;
    if (desc->emission_is_above_coat) return 1.0f;
    const float coat = unit(desc->clearcoat * lookup(scene, surface, &desc->clearcoat_texture).r);
    const ppmi_vec3 normal = mapped_normal(scene, surface, &desc->clearcoat_normal_texture,
                                           desc->clearcoat_normal_scale);
    return 1.0f - coat * ppmi_schlick(ppmi_coat_f0(desc->coat_ior), fabsf(vec3_dot(normal, wo)));
}
