/* Hits to surfaces.
 *
 * Positions come from the triangle's vertices, not from the ray, so that their error does not grow
 * with the ray's length (Waechter and Binder, "A Fast and Robust Method for Avoiding
 * Self-Intersection", Ray Tracing Gems 2019, ch. 6). The error bound follows the largest coordinate
 * that took part in the sum: scenes may be millimetres or kilometres. */
#include "shading/surface.h"

#include <float.h>

#include "accel/round.h"
#include "scene/motion.h"
#include "shading/texture.h"

/* Roundings in: object to world (4 products and sums), interpolation, Embree's own edge tests. */
static const float error_ulps = 24.0f;

static const uint32_t *triangle_of(const ppmi_surface *surface)
{
    return surface->primitive->indices + 3 * (size_t)surface->triangle;
}

/* Between the vertices of a triangle, of values that move with them. */
static ppmi_vec3 interpolate3(const ppmi_surface *surface, const float *values)
{
    const ppmi_primitive *primitive = surface->primitive;
    const uint32_t *triangle = triangle_of(surface);
    const float u = surface->u, v = surface->v, time = surface->time;
    const ppmi_vec3 a = ppmi_vertex_at(primitive, values, triangle[0], time);
    const ppmi_vec3 b = ppmi_vertex_at(primitive, values, triangle[1], time);
    const ppmi_vec3 c = ppmi_vertex_at(primitive, values, triangle[2], time);
    return vec3_mad(vec3_mad(vec3_scale(a, 1.0f - u - v), b, u), c, v);
}

static ppmi_vec3 shading_normal(const ppmi_surface *surface, const ppmi_transform *normals)
{
    if (!surface->primitive->normals) return surface->ng;
    const ppmi_vec3 local = interpolate3(surface, surface->primitive->normals);
    const ppmi_vec3 world = ppmi_transform_vector(normals, local);
    const float length = vec3_length(world);
    if (!(length > 1e-6f)) return surface->ng;
    const ppmi_vec3 ns = vec3_scale(world, 1.0f / length);
    return vec3_dot(ns, surface->ng) < 0.0f ? vec3_neg(ns) : ns;
}

static float error_bound(const ppmi_instance *instance, float local)
{
    const float origin =
        instance->motion ? ppmi_instance_reach(instance) : vec3_max_abs(instance->to_world.origin);
    return error_ulps * FLT_EPSILON * ppmi_max(instance->scale * local, origin);
}

/* The vertices of the triangle: their first, and the edges from it. Returns the largest coordinate
 * that took part. */
static float load_triangle(const ppmi_surface *surface, ppmi_vec3 *a, ppmi_vec3 *ab, ppmi_vec3 *ac)
{
    const ppmi_primitive *primitive = surface->primitive;
    const uint32_t *triangle = triangle_of(surface);
    const float time = surface->time;
    *a = ppmi_position_at(primitive, triangle[0], time);
    *ab = vec3_sub(ppmi_position_at(primitive, triangle[1], time), *a);
    *ac = vec3_sub(ppmi_position_at(primitive, triangle[2], time), *a);
    if (primitive->motion_steps == 1) return 0.0f;
    return ppmi_max(vec3_max_abs(primitive->bounds_min), vec3_max_abs(primitive->bounds_max));
}

static void place_on_triangle(ppmi_surface *surface, const ppmi_transform *to_world,
                              const ppmi_transform *normals)
{
    ppmi_vec3 a, ab, ac;
    const float moved = load_triangle(surface, &a, &ab, &ac);
    const ppmi_vec3 local = vec3_mad(vec3_mad(a, ab, surface->u), ac, surface->v);
    surface->position = ppmi_transform_point(to_world, local);
    surface->ng = vec3_normalize(ppmi_transform_vector(normals, vec3_cross(ab, ac)));
    const float edge = ppmi_max(vec3_max_abs(ab), vec3_max_abs(ac));
    const float extent = ppmi_max(vec3_max_abs(local), edge);
    surface->error = error_bound(surface->instance, ppmi_max(extent, moved));
    surface->ns = shading_normal(surface, normals);
}

/* Embree finds balls and segments by other sums than ours, from where its ray comes near: the bound
 * is some times that of triangles. */
static void place_on_round(ppmi_surface *surface, const ppmi_transform *to_world,
                           const ppmi_transform *normals)
{
    const float more = 4.0f;
    const ppmi_primitive *primitive = surface->primitive;
    const ppmi_round round = ppmi_round_of(primitive, surface->triangle, surface->time);
    const ppmi_round_point point = ppmi_round_at(&round, surface->u, surface->v);
    surface->position = ppmi_transform_point(to_world, point.position);
    surface->ng = vec3_normalize(ppmi_transform_vector(normals, point.normal));
    surface->ns = surface->ng;
    const float extent =
        primitive->motion_steps > 1
            ? ppmi_max(vec3_max_abs(primitive->bounds_min), vec3_max_abs(primitive->bounds_max))
            : ppmi_max(vec3_max_abs(round.first), vec3_max_abs(round.last)) + round.radius;
    surface->error = more * error_bound(surface->instance, extent);
}

void ppmi_surface_from_hit(const ppm_scene *scene, const ppmi_hit *hit, ppmi_surface *out_surface)
{
    ppmi_surface *surface = out_surface;
    const ppmi_instance *instance = &scene->instances[hit->instance];
    surface->instance = instance;
    surface->primitive = &scene->meshes[instance->mesh].primitives[hit->primitive];
    surface->material = &scene->materials[surface->primitive->material];
    surface->triangle = hit->triangle;
    surface->u = hit->u;
    surface->v = hit->v;
    surface->time = hit->time;

    ppmi_transform to_world, normals;
    const ppmi_transform *pose = &instance->to_world, *normal_pose = &instance->normals;
    if (instance->motion) {
        to_world = ppmi_instance_at(instance, hit->time);
        normals = ppmi_transform_normals(&to_world);
        pose = &to_world;
        normal_pose = &normals;
    }
    if (surface->primitive->kind == PPM_PRIMITIVE_TRIANGLES) {
        place_on_triangle(surface, pose, normal_pose);
    } else {
        place_on_round(surface, pose, normal_pose);
    }
}

float ppmi_surface_area(const ppmi_surface *surface)
{
    const ppmi_primitive *primitive = surface->primitive;
    const ppmi_transform to_world = ppmi_instance_at(surface->instance, surface->time);
    if (primitive->kind == PPM_PRIMITIVE_TRIANGLES) {
        ppmi_vec3 a, ab, ac;
        load_triangle(surface, &a, &ab, &ac);
        return 0.5f * vec3_length(vec3_cross(ppmi_transform_vector(&to_world, ab),
                                             ppmi_transform_vector(&to_world, ac)));
    }
    const ppmi_round round = ppmi_round_of(primitive, surface->triangle, surface->time);
    const ppmi_round_point point = ppmi_round_at(&round, surface->u, surface->v);
    const ppmi_transform cofactors = ppmi_transform_cofactors(&to_world);
    const float stretch = vec3_length(ppmi_transform_vector(&cofactors, point.normal));
    return ppmi_round_area(&round) * stretch;
}

/* Values at the ends of a line, or of a point. */
static void blend_round(const ppmi_surface *surface, const float *values, uint32_t width,
                        float *out_values)
{
    const bool is_line = surface->primitive->kind == PPM_PRIMITIVE_LINES;
    const uint32_t *ends =
        surface->primitive->indices + (is_line ? 2 : 1) * (size_t)surface->triangle;
    const float along = is_line ? ppmi_clampf(surface->u, 0.0f, 1.0f) : 0.0f;
    for (uint32_t i = 0; i < width; i++) {
        out_values[i] = (1.0f - along) * values[width * (size_t)ends[0] + i] +
                        along * values[width * (size_t)ends[is_line ? 1 : 0] + i];
    }
}

ppmi_vec2 ppmi_surface_uv(const ppmi_surface *surface, uint32_t set)
{
    const float *uvs = surface->primitive->uvs[set];
    if (!uvs) return (ppmi_vec2){0.0f, 0.0f};
    if (surface->primitive->kind != PPM_PRIMITIVE_TRIANGLES) {
        float uv[2];
        blend_round(surface, uvs, 2, uv);
        return (ppmi_vec2){uv[0], uv[1]};
    }
    const uint32_t *triangle = triangle_of(surface);
    const float *a = uvs + 2 * (size_t)triangle[0];
    const float *b = uvs + 2 * (size_t)triangle[1];
    const float *c = uvs + 2 * (size_t)triangle[2];
    const float u = surface->u, v = surface->v, w = 1.0f - u - v;
    return (ppmi_vec2){w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1]};
}

void ppmi_surface_vertex_color(const ppmi_surface *surface, float out_rgba[4])
{
    const float *colors = surface->primitive->colors;
    if (colors && surface->primitive->kind != PPM_PRIMITIVE_TRIANGLES) {
        blend_round(surface, colors, 4, out_rgba);
        return;
    }
    const uint32_t *triangle = triangle_of(surface);
    const float u = surface->u, v = surface->v, w = 1.0f - u - v;
    for (uint32_t i = 0; i < 4; i++) {
        out_rgba[i] = colors ? w * colors[4 * (size_t)triangle[0] + i] +
                                   u * colors[4 * (size_t)triangle[1] + i] +
                                   v * colors[4 * (size_t)triangle[2] + i]
                             : 1.0f;
    }
}

static ppmi_vec3 tangent_at(const ppmi_primitive *primitive, uint32_t vertex, float time)
{
    const float *tangents = primitive->tangents;
    if (primitive->motion_steps == 1) return vec3_load(tangents + 4 * (size_t)vertex);
    const ppmi_motion_place at = ppmi_motion_at(primitive->motion_steps, time);
    const float *block = tangents + 4 * ((size_t)at.step * primitive->vertex_count + vertex);
    return vec3_lerp(vec3_load(block), vec3_load(block + 4 * (size_t)primitive->vertex_count),
                     at.share);
}

/* From the mesh: bitangent = cross(normal, tangent) * w in object space (glTF 2.0, 3.7.2.1). */
static bool mesh_tangents(const ppmi_surface *surface, ppmi_vec3 *tangent, ppmi_vec3 *bitangent)
{
    const ppmi_primitive *primitive = surface->primitive;
    if (!primitive->tangents || !primitive->normals) return false;
    const uint32_t *triangle = triangle_of(surface);
    const float u = surface->u, v = surface->v, time = surface->time;
    const ppmi_vec3 a = tangent_at(primitive, triangle[0], time);
    const ppmi_vec3 b = tangent_at(primitive, triangle[1], time);
    const ppmi_vec3 c = tangent_at(primitive, triangle[2], time);
    const ppmi_vec3 t = vec3_mad(vec3_mad(vec3_scale(a, 1.0f - u - v), b, u), c, v);
    const float sign = primitive->tangents[4 * (size_t)triangle[0] + 3] < 0.0f ? -1.0f : 1.0f;
    const ppmi_vec3 n = interpolate3(surface, primitive->normals);
    const ppmi_transform to_world = ppmi_instance_at(surface->instance, time);
    *tangent = vec3_normalize(ppmi_transform_vector(&to_world, t));
    *bitangent =
        vec3_normalize(ppmi_transform_vector(&to_world, vec3_scale(vec3_cross(n, t), sign)));
    return vec3_length2(*tangent) > 0.5f && vec3_length2(*bitangent) > 0.5f;
}

/* From the derivatives of the coordinates over the triangle; v runs down, the bitangent up. */
static bool uv_tangents(const ppmi_surface *surface, uint32_t uv_set, ppmi_vec3 *tangent,
                        ppmi_vec3 *bitangent)
{
    const float *uvs = surface->primitive->uvs[uv_set];
    if (!uvs) return false;
    const uint32_t *triangle = triangle_of(surface);
    const float *a = uvs + 2 * (size_t)triangle[0];
    const float *b = uvs + 2 * (size_t)triangle[1];
    const float *c = uvs + 2 * (size_t)triangle[2];
    ppmi_vec3 origin, e1, e2;
    load_triangle(surface, &origin, &e1, &e2);
    const float du1 = b[0] - a[0], dv1 = b[1] - a[1], du2 = c[0] - a[0], dv2 = c[1] - a[1];
    const float determinant = du1 * dv2 - du2 * dv1;
    if (determinant == 0.0f || !isfinite(determinant)) return false;
    const float sign = determinant > 0.0f ? 1.0f : -1.0f;
    const ppmi_vec3 dpdu = vec3_scale(vec3_sub(vec3_scale(e1, dv2), vec3_scale(e2, dv1)), sign);
    const ppmi_vec3 dpdv = vec3_scale(vec3_sub(vec3_scale(e2, du1), vec3_scale(e1, du2)), sign);
    const ppmi_transform to_world = ppmi_instance_at(surface->instance, surface->time);
    *tangent = vec3_normalize(ppmi_transform_vector(&to_world, dpdu));
    *bitangent = vec3_neg(vec3_normalize(ppmi_transform_vector(&to_world, dpdv)));
    return vec3_length2(*tangent) > 0.5f && vec3_length2(*bitangent) > 0.5f;
}

bool ppmi_surface_tangents(const ppmi_surface *surface, uint32_t uv_set, ppmi_vec3 *out_tangent,
                           ppmi_vec3 *out_bitangent)
{
    if (surface->primitive->kind != PPM_PRIMITIVE_TRIANGLES) return false;
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
    if (texture->image > 0) {
        alpha *= ppmi_texture_lookup(scene, texture, ppmi_surface_uv(surface, texture->uv_set)).a;
    }
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
        const ppmi_texel texel =
            ppmi_texture_lookup(scene, texture, ppmi_surface_uv(surface, texture->uv_set));
        radiance = vec3_mul(radiance, vec3(ppmi_max(texel.r, 0.0f), ppmi_max(texel.g, 0.0f),
                                           ppmi_max(texel.b, 0.0f)));
    }
    return radiance;
}
