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
#include "shading/material.h"

/* Roundings in: object to world (4 products and sums), interpolation, Embree's own edge tests. */
static const float error_ulps = 24.0f;

static const uint32_t *triangle_of(const ppmi_surface *surface)
{
    return surface->primitive->indices + 3 * (size_t)surface->triangle;
}

static inline ppmi_vec3 interpolate_still(const float *values, const uint32_t *triangle, float u,
                                          float v)
{
    const ppmi_vec3 a = vec3_load(values + 3 * (size_t)triangle[0]);
    const ppmi_vec3 b = vec3_load(values + 3 * (size_t)triangle[1]);
    const ppmi_vec3 c = vec3_load(values + 3 * (size_t)triangle[2]);
    return vec3_mad(vec3_mad(vec3_scale(a, 1.0f - u - v), b, u), c, v);
}

/* The corners' values at the surface's time: three floats a vertex, in blocks. */
static void load_moving(const ppmi_surface *surface, const float *values, ppmi_vec3 *a,
                        ppmi_vec3 *b, ppmi_vec3 *c)
{
    const uint32_t *triangle = triangle_of(surface);
    *a = ppmi_vertex_at(surface->primitive, values, triangle[0], surface->time);
    *b = ppmi_vertex_at(surface->primitive, values, triangle[1], surface->time);
    *c = ppmi_vertex_at(surface->primitive, values, triangle[2], surface->time);
}

static ppmi_vec3 interpolate_moving(const ppmi_surface *surface, const float *values)
{
    const float u = surface->u, v = surface->v;
    ppmi_vec3 a, b, c;
    load_moving(surface, values, &a, &b, &c);
    return vec3_mad(vec3_mad(vec3_scale(a, 1.0f - u - v), b, u), c, v);
}

/* The mesh's normal, object space, not normalised. */
static inline ppmi_vec3 local_normal(const ppmi_surface *surface)
{
    const ppmi_primitive *primitive = surface->primitive;
    return primitive->motion_steps == 1
               ? interpolate_still(primitive->normals, triangle_of(surface), surface->u, surface->v)
               : interpolate_moving(surface, primitive->normals);
}

/* From the mesh's normal, object space. */
static inline ppmi_vec3 shading_normal(const ppmi_surface *surface, const ppmi_transform *normals,
                                       ppmi_vec3 local)
{
    const ppmi_vec3 world = ppmi_transform_vector(normals, local);
    const float length = vec3_length(world);
    if (!(length > 1e-6f)) return surface->ng;
    const ppmi_vec3 ns = vec3_scale(world, 1.0f / length);
    return vec3_dot(ns, surface->ng) < 0.0f ? vec3_neg(ns) : ns;
}

/* The first corner of the triangle, and the edges from it. */
static inline void load_triangle(const ppmi_surface *surface, ppmi_vec3 *a, ppmi_vec3 *ab,
                                 ppmi_vec3 *ac)
{
    const float *positions = surface->primitive->positions;
    ppmi_vec3 b, c;
    if (surface->primitive->motion_steps == 1) {
        const uint32_t *triangle = triangle_of(surface);
        *a = vec3_load(positions + 3 * (size_t)triangle[0]);
        b = vec3_load(positions + 3 * (size_t)triangle[1]);
        c = vec3_load(positions + 3 * (size_t)triangle[2]);
    } else {
        load_moving(surface, positions, a, &b, &c);
    }
    *ab = vec3_sub(b, *a);
    *ac = vec3_sub(c, *a);
}

/* Where an instance is at a time, and the largest coordinates that take part in placing a point
 * beside those at the time: the ones at the steps before and after. */
typedef struct pose {
    ppmi_transform to_world, normals;
    float local_reach, origin_reach;
} pose;

static pose pose_at(const ppmi_surface *surface)
{
    const ppmi_instance *instance = surface->instance;
    const ppmi_primitive *primitive = surface->primitive;
    pose result = {.to_world = instance->to_world,
                   .normals = instance->normals,
                   .origin_reach = vec3_max_abs(instance->to_world.origin)};
    if (instance->motion) {
        result.to_world = ppmi_instance_at(instance, surface->time);
        result.normals = ppmi_transform_normals(&result.to_world);
        result.origin_reach = ppmi_instance_reach(instance);
    }
    if (primitive->motion_steps > 1) {
        result.local_reach =
            ppmi_max(vec3_max_abs(primitive->bounds_min), vec3_max_abs(primitive->bounds_max));
    }
    return result;
}

/* Embree finds balls and segments by other sums than ours, from where its ray comes near: the bound
 * is some times that of triangles. */
static void place_on_round(ppmi_surface *surface)
{
    const float more = 4.0f;
    const pose at = pose_at(surface);
    const ppmi_round round = ppmi_round_of(surface->primitive, surface->triangle, surface->time);
    const ppmi_round_point point = ppmi_round_at(&round, surface->u, surface->v);
    surface->position = ppmi_transform_point(&at.to_world, point.position);
    surface->ng = vec3_normalize(ppmi_transform_vector(&at.normals, point.normal));
    surface->ns = surface->ng;
    const float ends = ppmi_max(vec3_max_abs(round.first), vec3_max_abs(round.last)) + round.radius;
    const float extent = ppmi_max(ends, at.local_reach);
    const float magnitude = ppmi_max(surface->instance->scale * extent, at.origin_reach);
    surface->error = more * error_ulps * FLT_EPSILON * magnitude;
}

/* Inlined twice: most hits are of triangles at rest. */
__attribute__((always_inline)) static inline void
place_on_triangle(ppmi_surface *surface, const ppmi_transform *to_world,
                  const ppmi_transform *normals, ppmi_vec3 a, ppmi_vec3 ab, ppmi_vec3 ac,
                  float local_reach, float origin_reach)
{
    const ppmi_vec3 local = vec3_mad(vec3_mad(a, ab, surface->u), ac, surface->v);
    surface->position = ppmi_transform_point(to_world, local);
    surface->ng = vec3_normalize(ppmi_transform_vector(normals, vec3_cross(ab, ac)));

    const float edge = ppmi_max(vec3_max_abs(ab), vec3_max_abs(ac));
    const float extent = ppmi_max(ppmi_max(vec3_max_abs(local), edge), local_reach);
    const float magnitude = ppmi_max(surface->instance->scale * extent, origin_reach);
    surface->error = error_ulps * FLT_EPSILON * magnitude;
}

__attribute__((noinline)) static void place_at_time(ppmi_surface *surface)
{
    if (surface->primitive->kind != PPM_PRIMITIVE_TRIANGLES) {
        place_on_round(surface);
        return;
    }
    const pose at = pose_at(surface);
    ppmi_vec3 a, ab, ac;
    load_triangle(surface, &a, &ab, &ac);
    place_on_triangle(surface, &at.to_world, &at.normals, a, ab, ac, at.local_reach,
                      at.origin_reach);
    surface->ns = surface->primitive->normals
                      ? shading_normal(surface, &at.normals, local_normal(surface))
                      : surface->ng;
}

void ppmi_surface_from_hit(const ppm_scene *scene, const ppmi_hit *hit, ppmi_surface *out_surface)
{
    ppmi_surface *surface = out_surface;
    const ppmi_instance *instance = &scene->instances[hit->instance];
    const ppmi_primitive *primitive = &scene->meshes[instance->mesh].primitives[hit->primitive];
    surface->instance = instance;
    surface->primitive = primitive;
    surface->material = &scene->materials[primitive->material];
    surface->triangle = hit->triangle;
    surface->u = hit->u;
    surface->v = hit->v;
    surface->uv_dx = surface->uv_dy = (ppmi_vec2){0.0f, 0.0f};
    surface->time = hit->time;
    if (primitive->motion_steps > 1 || primitive->kind != PPM_PRIMITIVE_TRIANGLES ||
        instance->motion) {
        place_at_time(surface);
        return;
    }
    const uint32_t *triangle = primitive->indices + 3 * (size_t)hit->triangle;
    const float *positions = primitive->positions;
    const ppmi_vec3 a = vec3_load(positions + 3 * (size_t)triangle[0]);
    const ppmi_vec3 ab = vec3_sub(vec3_load(positions + 3 * (size_t)triangle[1]), a);
    const ppmi_vec3 ac = vec3_sub(vec3_load(positions + 3 * (size_t)triangle[2]), a);
    place_on_triangle(surface, &instance->to_world, &instance->normals, a, ab, ac, 0.0f,
                      vec3_max_abs(instance->to_world.origin));
    surface->ns = surface->ng;
    if (!primitive->normals) return;
    const ppmi_vec3 n = interpolate_still(primitive->normals, triangle, surface->u, surface->v);
    surface->ns = shading_normal(surface, &instance->normals, n);
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

/* ---- footprint ------------------------------------------------------------------------------- */

/* The triangle's edges from its first vertex, world space. */
static void world_edges(const ppmi_surface *surface, ppmi_vec3 *ab, ppmi_vec3 *ac)
{
    ppmi_vec3 a, local_ab, local_ac;
    load_triangle(surface, &a, &local_ab, &local_ac);
    const ppmi_transform to_world = ppmi_instance_at(surface->instance, surface->time);
    *ab = ppmi_transform_vector(&to_world, local_ab);
    *ac = ppmi_transform_vector(&to_world, local_ac);
}

/* p = u ab + v ac in the plane: u is the volume of (p, ac, n) by that of (ab, ac, n), n = ab x ac;
 * v likewise. */
void ppmi_surface_set_footprint(ppmi_surface *surface, ppmi_vec3 position_dx, ppmi_vec3 position_dy)
{
    ppmi_vec3 ab, ac;
    if (surface->primitive->kind != PPM_PRIMITIVE_TRIANGLES) return; /* textures at their finest */
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

/* What takes normals to the world at the surface's time; moved is room for it. */
static const ppmi_transform *normals_at(const ppmi_surface *surface, ppmi_transform *moved)
{
    if (!surface->instance->motion) return &surface->instance->normals;
    const ppmi_transform to_world = ppmi_instance_at(surface->instance, surface->time);
    *moved = ppmi_transform_normals(&to_world);
    return moved;
}

void ppmi_surface_normal_derivatives(const ppmi_surface *surface, ppmi_vec3 n, ppmi_vec3 *out_n_dx,
                                     ppmi_vec3 *out_n_dy)
{
    *out_n_dx = *out_n_dy = vec3_splat(0.0f);
    const ppmi_primitive *primitive = surface->primitive;
    if (!primitive->normals || primitive->kind != PPM_PRIMITIVE_TRIANGLES) return;
    const uint32_t *triangle = triangle_of(surface);
    ppmi_transform moved;
    const ppmi_transform *to_world = normals_at(surface, &moved);
    const float *normals = primitive->normals, time = surface->time;
    const ppmi_vec3 local_a = ppmi_vertex_at(primitive, normals, triangle[0], time);
    const ppmi_vec3 local_b = ppmi_vertex_at(primitive, normals, triangle[1], time);
    const ppmi_vec3 local_c = ppmi_vertex_at(primitive, normals, triangle[2], time);
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

/* Derivatives of the position by the coordinates over the triangle, object space, both times the
 * same positive factor. */
static bool uv_derivatives(const ppmi_surface *surface, uint32_t uv_set, ppmi_vec3 *out_dpdu,
                           ppmi_vec3 *out_dpdv)
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
    *out_dpdu = vec3_scale(vec3_sub(vec3_scale(e1, dv2), vec3_scale(e2, dv1)), sign);
    *out_dpdv = vec3_scale(vec3_sub(vec3_scale(e2, du1), vec3_scale(e1, du2)), sign);
    return true;
}

/* Sign of the determinant of the texture's transform where that turns or mirrors the axes of the
 * picture against those of the coordinates; else, or where it is singular, 0. */
static float turning(const ppm_texture *texture)
{
    const float *m = texture->uv_transform;
    if (!texture->has_transform) return 0.0f;
    if (m[1] == 0.0f && m[3] == 0.0f && m[0] > 0.0f && m[4] > 0.0f) return 0.0f;
    const float determinant = m[0] * m[4] - m[1] * m[3];
    if (determinant == 0.0f || !isfinite(determinant)) return 0.0f;
    return determinant > 0.0f ? 1.0f : -1.0f;
}

/* Tangents of a mesh have directions but no lengths, and with an uneven transform the axes of the
 * picture depend on both: the lengths are the triangle's. The bitangent stays perpendicular, as if
 * the tangents had been computed for the transformed coordinates. */
static void turn_mesh_tangents(const ppmi_surface *surface, const ppm_texture *texture,
                               float turned, ppmi_vec3 *tangent, ppmi_vec3 *bitangent)
{
    const float *m = texture->uv_transform;
    const ppmi_vec3 t = vec3_normalize(*tangent), b = vec3_normalize(*bitangent);
    ppmi_vec3 dpdu, dpdv;
    float along = m[4] * turned, across = m[3] * turned;
    if (uv_derivatives(surface, texture->uv_set, &dpdu, &dpdv)) {
        along *= vec3_length(dpdu);
        across *= vec3_length(dpdv);
    }
    *tangent = vec3_mad(vec3_scale(t, along), b, across);
    *bitangent = vec3_mad(vec3_scale(t, -across * turned), b, along * turned);
}

/* From the mesh: bitangent = cross(normal, tangent) * w in object space (glTF 2.0, 3.7.2.1). */
static bool mesh_tangents(const ppmi_surface *surface, const ppm_texture *texture,
                          ppmi_vec3 *tangent, ppmi_vec3 *bitangent)
{
    const ppmi_primitive *primitive = surface->primitive;
    if (!primitive->tangents || !primitive->normals) return false;
    const uint32_t *triangle = triangle_of(surface);
    const float u = surface->u, v = surface->v, time = surface->time;
    const ppmi_vec3 a = tangent_at(primitive, triangle[0], time);
    const ppmi_vec3 b = tangent_at(primitive, triangle[1], time);
    const ppmi_vec3 c = tangent_at(primitive, triangle[2], time);
    ppmi_vec3 t = vec3_mad(vec3_mad(vec3_scale(a, 1.0f - u - v), b, u), c, v);
    const float sign = primitive->tangents[4 * (size_t)triangle[0] + 3] < 0.0f ? -1.0f : 1.0f;
    ppmi_vec3 across = vec3_scale(vec3_cross(local_normal(surface), t), sign);
    const float turned = turning(texture);
    if (turned != 0.0f) turn_mesh_tangents(surface, texture, turned, &t, &across);
    const ppmi_transform to_world = ppmi_instance_at(surface->instance, time);
    *tangent = vec3_normalize(ppmi_transform_vector(&to_world, t));
    *bitangent = vec3_normalize(ppmi_transform_vector(&to_world, across));
    return vec3_length2(*tangent) > 0.5f && vec3_length2(*bitangent) > 0.5f;
}

/* v runs down, the bitangent up. The axes of the picture are the columns of the inverse of the
 * texture's transform. */
static bool uv_tangents(const ppmi_surface *surface, const ppm_texture *texture, ppmi_vec3 *tangent,
                        ppmi_vec3 *bitangent)
{
    ppmi_vec3 dpdu, dpdv;
    if (!uv_derivatives(surface, texture->uv_set, &dpdu, &dpdv)) return false;
    const float turned = turning(texture);
    if (turned != 0.0f) {
        const float *m = texture->uv_transform;
        const ppmi_vec3 u = vec3_scale(dpdu, turned), v = vec3_scale(dpdv, turned);
        dpdu = vec3_mad(vec3_scale(u, m[4]), v, -m[3]);
        dpdv = vec3_mad(vec3_scale(v, m[0]), u, -m[1]);
    }
    const ppmi_transform to_world = ppmi_instance_at(surface->instance, surface->time);
    *tangent = vec3_normalize(ppmi_transform_vector(&to_world, dpdu));
    *bitangent = vec3_neg(vec3_normalize(ppmi_transform_vector(&to_world, dpdv)));
    return vec3_length2(*tangent) > 0.5f && vec3_length2(*bitangent) > 0.5f;
}

bool ppmi_surface_tangents(const ppmi_surface *surface, const ppm_texture *texture,
                           ppmi_vec3 *out_tangent, ppmi_vec3 *out_bitangent)
{
    if (surface->primitive->kind != PPM_PRIMITIVE_TRIANGLES) return false;
    return mesh_tangents(surface, texture, out_tangent, out_bitangent) ||
           uv_tangents(surface, texture, out_tangent, out_bitangent);
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
    if (material->desc.emission_takes_vertex_color) {
        float vertex[4];
        ppmi_surface_vertex_color(surface, vertex);
        for (int i = 0; i < 3; i++)
            vertex[i] = ppmi_max(vertex[i], 0.0f);
        radiance = vec3_mul(radiance, vec3_load(vertex));
    }
    if (material->desc.clearcoat > 0.0f) {
        radiance = vec3_scale(radiance, ppmi_material_coat_passing(scene, surface, wo));
    }
    return radiance;
}
