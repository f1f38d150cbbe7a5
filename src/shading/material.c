/* Material evaluation: factors times textures. */
#include "shading/material.h"

static ppmi_texel lookup(const ppm_scene *scene, const ppmi_surface *surface,
                         const ppm_texture *texture)
{
    return ppmi_surface_texture(scene, surface, texture);
}

static float unit(float x)
{
    return ppmi_clampf(x, 0.0f, 1.0f);
}

static ppmi_vec3 mapped_normal(const ppm_scene *scene, const ppmi_surface *surface)
{
    const ppm_material_desc *desc = &surface->material->desc;
    ppmi_vec3 tangent, bitangent;
    if (desc->normal_texture.image == 0 ||
        !ppmi_surface_tangents(surface, desc->normal_texture.uv_set, &tangent, &bitangent)) {
        return surface->ns;
    }
    const ppmi_texel texel = lookup(scene, surface, &desc->normal_texture);
    const float x = (2.0f * texel.r - 1.0f) * desc->normal_scale;
    const float y = (2.0f * texel.g - 1.0f) * desc->normal_scale;
    const float z = 2.0f * texel.b - 1.0f;
    const ppmi_vec3 n = vec3_normalize(
        vec3_mad(vec3_mad(vec3_scale(tangent, x), bitangent, y), surface->ns, ppmi_max(z, 1e-3f)));
    return vec3_dot(n, surface->ng) > 0.0f && vec3_is_finite(n) ? n : surface->ns;
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
    *out_point = (ppmi_material_point){
        .base_color = {unit(desc->base_color[0] * base.r * vertex[0]),
                       unit(desc->base_color[1] * base.g * vertex[1]),
                       unit(desc->base_color[2] * base.b * vertex[2])},
        .metallic = unit(desc->metallic * rough.b),
        .roughness = unit(desc->roughness * rough.g),
        .ior = desc->ior,
        .specular = unit(desc->specular * lookup(scene, surface, &desc->specular_texture).a),
        .specular_color = {ppmi_max(desc->specular_color[0] * specular_color.r, 0.0f),
                           ppmi_max(desc->specular_color[1] * specular_color.g, 0.0f),
                           ppmi_max(desc->specular_color[2] * specular_color.b, 0.0f)},
        .transmission =
            unit(desc->transmission * lookup(scene, surface, &desc->transmission_texture).r),
        .is_thin = desc->transmission_kind == PPM_TRANSMISSION_THIN,
        .ns = mapped_normal(scene, surface),
    };
}
