/* Where a ray met the scene: position, normals, texture coordinates, material. */
#ifndef PPMI_SHADING_SURFACE_H
#define PPMI_SHADING_SURFACE_H

#include "accel/accel.h"
#include "math/sampling.h"
#include "scene/scene.h"

typedef struct ppmi_surface {
    ppmi_vec3 position;
    ppmi_vec3 ng; /* geometric normal, unit, of the front side */
    ppmi_vec3 ns; /* shading normal, unit, on ng's side, before any normal map */
    float error;  /* bound of the distance between position and the true surface, metres */
    float u, v;   /* of the hit, for attributes */
    float time;   /* of the hit, within the shutter */
    const ppmi_instance *instance;
    const ppmi_primitive *primitive;
    const ppmi_material *material;
    uint32_t triangle; /* or other element */
} ppmi_surface;

void ppmi_surface_from_hit(const ppm_scene *scene, const ppmi_hit *hit, ppmi_surface *out_surface);

/* Texture coordinates of a set; (0, 0) where the mesh has none. */
ppmi_vec2 ppmi_surface_uv(const ppmi_surface *surface, uint32_t set);

/* Vertex colour and alpha; all 1 where the mesh has none. */
void ppmi_surface_vertex_color(const ppmi_surface *surface, float out_rgba[4]);

/* Unit tangent and bitangent for normal maps on the given texture coordinates, from the mesh's
 * tangents, else from the coordinates' derivatives. False where neither exists. */
bool ppmi_surface_tangents(const ppmi_surface *surface, uint32_t uv_set, ppmi_vec3 *out_tangent,
                           ppmi_vec3 *out_bitangent);

/* Opacity at a hit, 0..1, by the alpha mode: without the rest of the material. */
float ppmi_surface_opacity(const ppm_scene *scene, const ppmi_surface *surface);

/* The area, world space, of an element of a moving or round shape by the density of its places: at
 * a place that is drawn evenly over the element as the mesh has it, the density by area is 1 over
 * this. */
float ppmi_surface_area(const ppmi_surface *surface);

/* Radiance that leaves the surface in direction wo (unit, away from it). */
ppmi_vec3 ppmi_surface_emission(const ppm_scene *scene, const ppmi_surface *surface, ppmi_vec3 wo);

/* A ray that leaves the surface: the origin is moved off it along the geometric normal by the error
 * bound, to the side that direction points to. */
static inline ppmi_ray ppmi_surface_ray(const ppmi_surface *surface, ppmi_vec3 direction)
{
    const float side = vec3_dot(direction, surface->ng) >= 0.0f ? 1.0f : -1.0f;
    return (ppmi_ray){
        .origin = vec3_mad(surface->position, surface->ng, side * surface->error),
        .t_max = INFINITY,
        .direction = direction,
        .time = surface->time,
    };
}

#endif
