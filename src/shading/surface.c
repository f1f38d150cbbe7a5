/* Hits to surfaces.
 *
 * Positions come from the triangle's vertices, not from the ray, so that their error does not grow
 * with the ray's length (Waechter and Binder, "A Fast and Robust Method for Avoiding
 * Self-Intersection", Ray Tracing Gems 2019, ch. 6). The error bound follows the largest coordinate
 * that took part in the sum: scenes may be millimetres or kilometres. */
#include "shading/surface.h"

#include <float.h>

/* Roundings in: object to world (4 products and sums), interpolation, Embree's own edge tests. */
static const float error_ulps = 24.0f;

static ppmi_vec3 interpolate3(const float *values, const uint32_t *triangle, float u, float v)
{
    const ppmi_vec3 a = vec3_load(values + 3 * (size_t)triangle[0]);
    const ppmi_vec3 b = vec3_load(values + 3 * (size_t)triangle[1]);
    const ppmi_vec3 c = vec3_load(values + 3 * (size_t)triangle[2]);
    return vec3_mad(vec3_mad(vec3_scale(a, 1.0f - u - v), b, u), c, v);
}

static ppmi_vec3 shading_normal(const ppmi_surface *surface, const uint32_t *triangle)
{
    if (!surface->primitive->normals) return surface->ng;
    const ppmi_vec3 local =
        interpolate3(surface->primitive->normals, triangle, surface->u, surface->v);
    const ppmi_vec3 world = ppmi_transform_vector(&surface->instance->normals, local);
    const float length = vec3_length(world);
    if (!(length > 1e-6f)) return surface->ng;
    const ppmi_vec3 ns = vec3_scale(world, 1.0f / length);
    return vec3_dot(ns, surface->ng) < 0.0f ? vec3_neg(ns) : ns;
}

void ppmi_surface_from_hit(const ppm_scene *scene, const ppmi_hit *hit, ppmi_surface *out_surface)
{
    ppmi_surface *surface = out_surface;
    surface->instance = &scene->instances[hit->instance];
    surface->primitive = &scene->meshes[surface->instance->mesh].primitives[hit->primitive];
    surface->material = &scene->materials[surface->primitive->material];
    surface->triangle = hit->triangle;
    surface->u = hit->u;
    surface->v = hit->v;
    surface->uv_dx = surface->uv_dy = (ppmi_vec2){0.0f, 0.0f};

    const ppmi_instance *instance = surface->instance;
    const uint32_t *triangle = surface->primitive->indices + 3 * (size_t)hit->triangle;
    const float *positions = surface->primitive->positions;
    const ppmi_vec3 a = vec3_load(positions + 3 * (size_t)triangle[0]);
    const ppmi_vec3 ab = vec3_sub(vec3_load(positions + 3 * (size_t)triangle[1]), a);
    const ppmi_vec3 ac = vec3_sub(vec3_load(positions + 3 * (size_t)triangle[2]), a);
    const ppmi_vec3 local = vec3_mad(vec3_mad(a, ab, hit->u), ac, hit->v);
    surface->position = ppmi_transform_point(&instance->to_world, local);
    surface->ng = vec3_normalize(ppmi_transform_vector(&instance->normals, vec3_cross(ab, ac)));

    const float edge = ppmi_max(vec3_max_abs(ab), vec3_max_abs(ac));
    const float magnitude = ppmi_max(instance->scale * ppmi_max(vec3_max_abs(local), edge),
                                     vec3_max_abs(instance->to_world.origin));
    surface->error = error_ulps * FLT_EPSILON * magnitude;
    surface->ns = shading_normal(surface, triangle);
}

/* ---- footprint ------------------------------------------------------------------------------- */

/* The triangle's edges from its first vertex, world space. */
static void world_edges(const ppmi_surface *surface, ppmi_vec3 *ab, ppmi_vec3 *ac)
{
    const uint32_t *triangle = surface->primitive->indices + 3 * (size_t)surface->triangle;
    const float *positions = surface->primitive->positions;
    const ppmi_vec3 a = vec3_load(positions + 3 * (size_t)triangle[0]);
    const ppmi_vec3 b = vec3_load(positions + 3 * (size_t)triangle[1]);
    const ppmi_vec3 c = vec3_load(positions + 3 * (size_t)triangle[2]);
    const ppmi_transform *to_world = &surface->instance->to_world;
    *ab = ppmi_transform_vector(to_world, vec3_sub(b, a));
    *ac = ppmi_transform_vector(to_world, vec3_sub(c, a));
}

/* p = u ab + v ac in the plane: u is the volume of (p, ac, n) by that of (ab, ac, n), n = ab x ac;
 * v likewise. */
void ppmi_surface_set_footprint(ppmi_surface *surface, ppmi_vec3 position_dx, ppmi_vec3 position_dy)
{
    ppmi_vec3 ab, ac;
    world_edges(surface, &ab, &ac);
    const ppmi_vec3 n = vec3_cross(ab, ac);
    const float scale = 1.0f / vec3_length2(n);
    if (!isfinite(scale)) return;
    const ppmi_vec3 to_u = vec3_scale(vec3_cross(ac, n), scale);
    const ppmi_vec3 to_v = vec3_scale(vec3_cross(n, ab), scale);
    surface->uv_dx = (ppmi_vec2){vec3_dot(position_dx, to_u), vec3_dot(position_dx, to_v)};
    surface->uv_dy = (ppmi_vec2){vec3_dot(position_dy, to_u), vec3_dot(position_dy, to_v)};
}

/* The normal's direction changes with its part across itself. */
static ppmi_vec3 unit_change(ppmi_vec3 n, ppmi_vec3 ab, ppmi_vec3 ac, float inverse_length,
                             ppmi_vec2 step)
{
    const ppmi_vec3 change = vec3_mad(vec3_scale(ab, step.x), ac, step.y);
    return vec3_scale(vec3_mad(change, n, -vec3_dot(change, n)), inverse_length);
}

void ppmi_surface_normal_derivatives(const ppmi_surface *surface, ppmi_vec3 n, ppmi_vec3 *out_n_dx,
                                     ppmi_vec3 *out_n_dy)
{
    *out_n_dx = *out_n_dy = vec3_splat(0.0f);
    const float *normals = surface->primitive->normals;
    if (!normals) return;
    const uint32_t *triangle = surface->primitive->indices + 3 * (size_t)surface->triangle;
    const ppmi_transform *to_world = &surface->instance->normals;
    const ppmi_vec3 local_a = vec3_load(normals + 3 * (size_t)triangle[0]);
    const ppmi_vec3 local_b = vec3_load(normals + 3 * (size_t)triangle[1]);
    const ppmi_vec3 local_c = vec3_load(normals + 3 * (size_t)triangle[2]);
    const ppmi_vec3 a = ppmi_transform_vector(to_world, local_a);
    const ppmi_vec3 ab = ppmi_transform_vector(to_world, vec3_sub(local_b, local_a));
    const ppmi_vec3 ac = ppmi_transform_vector(to_world, vec3_sub(local_c, local_a));
    const ppmi_vec3 sum = vec3_mad(vec3_mad(a, ab, surface->u), ac, surface->v);
    const float length = vec3_length(sum);
    if (!(length > 1e-6f)) return;
    const float scale = (vec3_dot(sum, n) < 0.0f ? -1.0f : 1.0f) / length;
    *out_n_dx = unit_change(n, ab, ac, scale, surface->uv_dx);
    *out_n_dy = unit_change(n, ab, ac, scale, surface->uv_dy);
}

/* ---- textures -------------------------------------------------------------------------------- */

ppmi_vec2 ppmi_surface_uv(const ppmi_surface *surface, uint32_t set)
{
    const float *uvs = surface->primitive->uvs[set];
    if (!uvs) return (ppmi_vec2){0.0f, 0.0f};
    const uint32_t *triangle = surface->primitive->indices + 3 * (size_t)surface->triangle;
    const float *a = uvs + 2 * (size_t)triangle[0];
    const float *b = uvs + 2 * (size_t)triangle[1];
    const float *c = uvs + 2 * (size_t)triangle[2];
    const float u = surface->u, v = surface->v, w = 1.0f - u - v;
    return (ppmi_vec2){w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1]};
}

ppmi_texel ppmi_surface_lookup_finest(const ppm_scene *scene, const ppmi_surface *surface,
                                      const ppm_texture *texture)
{
    return ppmi_texture_lookup(scene, texture, ppmi_surface_uv(surface, texture->uv_set));
}

static ppmi_vec2 combine(const float *a, const float *b, const float *c, ppmi_vec2 step)
{
    return (ppmi_vec2){(b[0] - a[0]) * step.x + (c[0] - a[0]) * step.y,
                       (b[1] - a[1]) * step.x + (c[1] - a[1]) * step.y};
}

ppmi_texel ppmi_surface_lookup(const ppm_scene *scene, const ppmi_surface *surface,
                               const ppm_texture *texture)
{
    const ppmi_vec2 uv = ppmi_surface_uv(surface, texture->uv_set);
    const ppmi_vec2 dx = surface->uv_dx, dy = surface->uv_dy;
    const float *uvs = surface->primitive->uvs[texture->uv_set];
    if (!uvs || (dx.x == 0.0f && dx.y == 0.0f && dy.x == 0.0f && dy.y == 0.0f)) {
        return ppmi_texture_lookup(scene, texture, uv);
    }
    const uint32_t *triangle = surface->primitive->indices + 3 * (size_t)surface->triangle;
    const float *a = uvs + 2 * (size_t)triangle[0];
    const float *b = uvs + 2 * (size_t)triangle[1];
    const float *c = uvs + 2 * (size_t)triangle[2];
    return ppmi_texture_filtered(scene, texture, uv, combine(a, b, c, dx), combine(a, b, c, dy));
}

void ppmi_surface_vertex_color(const ppmi_surface *surface, float out_rgba[4])
{
    const float *colors = surface->primitive->colors;
    const uint32_t *triangle = surface->primitive->indices + 3 * (size_t)surface->triangle;
    const float u = surface->u, v = surface->v, w = 1.0f - u - v;
    for (uint32_t i = 0; i < 4; i++) {
        out_rgba[i] = colors ? w * colors[4 * (size_t)triangle[0] + i] +
                                   u * colors[4 * (size_t)triangle[1] + i] +
                                   v * colors[4 * (size_t)triangle[2] + i]
                             : 1.0f;
    }
}

/* From the mesh: bitangent = cross(normal, tangent) * w in object space (glTF 2.0, 3.7.2.1). */
static bool mesh_tangents(const ppmi_surface *surface, ppmi_vec3 *tangent, ppmi_vec3 *bitangent)
{
    const ppmi_primitive *primitive = surface->primitive;
    if (!primitive->tangents || !primitive->normals) return false;
    const uint32_t *triangle = primitive->indices + 3 * (size_t)surface->triangle;
    const float *a = primitive->tangents + 4 * (size_t)triangle[0];
    const float *b = primitive->tangents + 4 * (size_t)triangle[1];
    const float *c = primitive->tangents + 4 * (size_t)triangle[2];
    const float u = surface->u, v = surface->v, w = 1.0f - u - v;
    const ppmi_vec3 t = vec3(w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1],
                             w * a[2] + u * b[2] + v * c[2]);
    const ppmi_vec3 n = interpolate3(primitive->normals, triangle, u, v);
    const ppmi_transform *to_world = &surface->instance->to_world;
    *tangent = vec3_normalize(ppmi_transform_vector(to_world, t));
    *bitangent = vec3_normalize(
        ppmi_transform_vector(to_world, vec3_scale(vec3_cross(n, t), a[3] < 0.0f ? -1.0f : 1.0f)));
    return vec3_length2(*tangent) > 0.5f && vec3_length2(*bitangent) > 0.5f;
}

/* From the derivatives of the coordinates over the triangle; v runs down, the bitangent up. */
static bool uv_tangents(const ppmi_surface *surface, uint32_t uv_set, ppmi_vec3 *tangent,
                        ppmi_vec3 *bitangent)
{
    const float *uvs = surface->primitive->uvs[uv_set];
    if (!uvs) return false;
    const uint32_t *triangle = surface->primitive->indices + 3 * (size_t)surface->triangle;
    const float *a = uvs + 2 * (size_t)triangle[0];
    const float *b = uvs + 2 * (size_t)triangle[1];
    const float *c = uvs + 2 * (size_t)triangle[2];
    const float *positions = surface->primitive->positions;
    const ppmi_vec3 origin = vec3_load(positions + 3 * (size_t)triangle[0]);
    const ppmi_vec3 e1 = vec3_sub(vec3_load(positions + 3 * (size_t)triangle[1]), origin);
    const ppmi_vec3 e2 = vec3_sub(vec3_load(positions + 3 * (size_t)triangle[2]), origin);
    const float du1 = b[0] - a[0], dv1 = b[1] - a[1], du2 = c[0] - a[0], dv2 = c[1] - a[1];
    const float determinant = du1 * dv2 - du2 * dv1;
    if (determinant == 0.0f || !isfinite(determinant)) return false;
    const float sign = determinant > 0.0f ? 1.0f : -1.0f;
    const ppmi_vec3 dpdu = vec3_scale(vec3_sub(vec3_scale(e1, dv2), vec3_scale(e2, dv1)), sign);
    const ppmi_vec3 dpdv = vec3_scale(vec3_sub(vec3_scale(e2, du1), vec3_scale(e1, du2)), sign);
    const ppmi_transform *to_world = &surface->instance->to_world;
    *tangent = vec3_normalize(ppmi_transform_vector(to_world, dpdu));
    *bitangent = vec3_neg(vec3_normalize(ppmi_transform_vector(to_world, dpdv)));
    return vec3_length2(*tangent) > 0.5f && vec3_length2(*bitangent) > 0.5f;
}

bool ppmi_surface_tangents(const ppmi_surface *surface, uint32_t uv_set, ppmi_vec3 *out_tangent,
                           ppmi_vec3 *out_bitangent)
{
    return mesh_tangents(surface, out_tangent, out_bitangent) ||
           uv_tangents(surface, uv_set, out_tangent, out_bitangent);
}

float ppmi_surface_opacity(const ppm_scene *scene, const ppmi_surface *surface)
{
    const ppm_material_desc *desc = &surface->material->desc;
    if (desc->alpha_mode == PPM_ALPHA_OPAQUE) return 1.0f;
    float rgba[4];
    ppmi_surface_vertex_color(surface, rgba);
    float alpha = desc->base_color[3] * rgba[3];
    const ppm_texture *texture = &desc->base_color_texture;
    if (texture->image > 0) alpha *= ppmi_surface_lookup_finest(scene, surface, texture).a;
    if (desc->alpha_mode == PPM_ALPHA_MASK) return alpha >= desc->alpha_cutoff ? 1.0f : 0.0f;
    return ppmi_clampf(alpha, 0.0f, 1.0f);
}

ppmi_vec3 ppmi_surface_emission(const ppm_scene *scene, const ppmi_surface *surface, ppmi_vec3 wo)
{
    const ppmi_material *material = surface->material;
    if (!material->emits) return vec3_splat(0.0f);
    if (!material->desc.double_sided && vec3_dot(wo, surface->ng) <= 0.0f) return vec3_splat(0.0f);
    ppmi_vec3 radiance = vec3_load(material->desc.emission);
    const ppm_texture *texture = &material->desc.emission_texture;
    if (texture->image > 0) {
        const ppmi_texel texel = ppmi_surface_lookup(scene, surface, texture);
        radiance = vec3_mul(radiance, vec3(ppmi_max(texel.r, 0.0f), ppmi_max(texel.g, 0.0f),
                                           ppmi_max(texel.b, 0.0f)));
    }
    return radiance;
}
