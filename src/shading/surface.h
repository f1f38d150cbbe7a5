/* Where a ray met the scene: position, normals, texture coordinates, material. */
#ifndef PPMI_SHADING_SURFACE_H
#define PPMI_SHADING_SURFACE_H

#include "accel/accel.h"
#include "math/sampling.h"
#include "scene/scene.h"
#include "shading/texture.h"

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
    /* Change of u and v by one step in x and in y of the picture; 0: textures are looked up at
     * their finest. */
    ppmi_vec2 uv_dx, uv_dy;
} ppmi_surface;

void ppmi_surface_from_hit(const ppm_scene *scene, const ppmi_hit *hit, ppmi_surface *out_surface);

/* Texture coordinates of a set; (0, 0) where the mesh has none. */
ppmi_vec2 ppmi_surface_uv(const ppmi_surface *surface, uint32_t set);

/* Tells the surface what it stands for in the picture: how its position changes, in its plane, by
 * one step in x and in y (world space). */
void ppmi_surface_set_footprint(ppmi_surface *surface, ppmi_vec3 position_dx,
                                ppmi_vec3 position_dy);

/* Change of the unit shading normal by the same steps, for n on either side; 0 where the mesh has
 * no normals. */
void ppmi_surface_normal_derivatives(const ppmi_surface *surface, ppmi_vec3 n, ppmi_vec3 *out_n_dx,
                                     ppmi_vec3 *out_n_dy);

/* Looks a texture up at the surface, over its footprint; texture->image must not be 0. */
ppmi_texel ppmi_surface_lookup(const ppm_scene *scene, const ppmi_surface *surface,
                               const ppm_texture *texture);

/* The same without filter. */
ppmi_texel ppmi_surface_lookup_finest(const ppm_scene *scene, const ppmi_surface *surface,
                                      const ppm_texture *texture);

/* A texture at the surface; white where there is none. */
static inline ppmi_texel ppmi_surface_texture(const ppm_scene *scene, const ppmi_surface *surface,
                                              const ppm_texture *texture)
{
    if (texture->image == 0) return (ppmi_texel){1.0f, 1.0f, 1.0f, 1.0f};
    return ppmi_surface_lookup(scene, surface, texture);
}

/* Vertex colour and alpha; all 1 where the mesh has none. */
void ppmi_surface_vertex_color(const ppmi_surface *surface, float out_rgba[4]);

/* Unit tangent and bitangent, world space: where the picture's right and its top point on the
 * surface. From the mesh's tangents, else from the derivatives of the texture's coordinates; turned
 * and mirrored with the texture's transform. texture may be without image. False where there is
 * neither. */
bool ppmi_surface_tangents(const ppmi_surface *surface, const ppm_texture *texture,
                           ppmi_vec3 *out_tangent, ppmi_vec3 *out_bitangent);

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
