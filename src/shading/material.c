/* Material evaluation: factors times textures. */
#include "shading/material.h"

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

/* Strength and direction (KHR_materials_anisotropy): the texture's vector, turned, in the tangent
 * space of the texture, else along the tangent of the normal map's coordinates. */
static void evaluate_anisotropy(const ppm_scene *scene, const ppmi_surface *surface,
                                ppmi_layer_point *layers)
{
    const ppm_material_desc *desc = &surface->material->desc;
    const ppm_texture *texture = &desc->anisotropy_texture;
    const ppm_texture mesh_axes = {.uv_set = desc->normal_texture.uv_set};
    const ppm_texture *axes = texture->image > 0 ? texture : &mesh_axes;
    ppmi_vec3 tangent, bitangent;
    layers->anisotropy = 0.0f;
    if (!(desc->anisotropy > 0.0f) || !ppmi_surface_tangents(surface, axes, &tangent, &bitangent)) {
        return;
    }
    float x = 1.0f, y = 0.0f, strength = desc->anisotropy;
    if (texture->image > 0) {
        const ppmi_texel texel = lookup(scene, surface, texture);
        x = 2.0f * texel.r - 1.0f;
        y = 2.0f * texel.g - 1.0f;
        strength *= texel.b;
    }
    const float c = cosf(desc->anisotropy_rotation_rad), s = sinf(desc->anisotropy_rotation_rad);
    layers->tangent = vec3_mad(vec3_scale(tangent, c * x - s * y), bitangent, s * x + c * y);
    layers->anisotropy = unit(strength);
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

__attribute__((noinline)) static void
evaluate_layers(const ppm_scene *scene, const ppmi_surface *surface, ppmi_layer_point *layers)
{
    const ppm_material_desc *desc = &surface->material->desc;
    const ppmi_texel sheen = lookup(scene, surface, &desc->sheen_color_texture);
    const ppmi_texel through = lookup(scene, surface, &desc->diffuse_transmission_color_texture);
    *layers = (ppmi_layer_point){
        .coat = unit(desc->clearcoat * lookup(scene, surface, &desc->clearcoat_texture).r),
        .coat_roughness = unit(desc->clearcoat_roughness *
                               lookup(scene, surface, &desc->clearcoat_roughness_texture).g),
        .coat_normal = mapped_normal(scene, surface, &desc->clearcoat_normal_texture,
                                     desc->clearcoat_normal_scale),
        .sheen_color = {unit(desc->sheen_color[0] * sheen.r), unit(desc->sheen_color[1] * sheen.g),
                        unit(desc->sheen_color[2] * sheen.b)},
        .sheen_roughness =
            unit(desc->sheen_roughness * lookup(scene, surface, &desc->sheen_roughness_texture).a),
        .through = unit(desc->diffuse_transmission *
                        lookup(scene, surface, &desc->diffuse_transmission_texture).a),
        .through_color = {unit(desc->diffuse_transmission_color[0] * through.r),
                          unit(desc->diffuse_transmission_color[1] * through.g),
                          unit(desc->diffuse_transmission_color[2] * through.b)},
        .retro =
            unit(desc->retroreflection * lookup(scene, surface, &desc->retroreflection_texture).r),
    };
    if (desc->iridescence > 0.0f) evaluate_film(scene, surface, layers);
    evaluate_anisotropy(scene, surface, layers);
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
    const float coat = unit(desc->clearcoat * lookup(scene, surface, &desc->clearcoat_texture).r);
    const ppmi_vec3 normal = mapped_normal(scene, surface, &desc->clearcoat_normal_texture,
                                           desc->clearcoat_normal_scale);
    return 1.0f - coat * ppmi_coat_fresnel(fabsf(vec3_dot(normal, wo)));
}
