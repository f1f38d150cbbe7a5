/* Focusing on what is in the middle of the picture. */
#include "render/integrator.h"

/* So many layers of veils and of backs that the camera looks through. */
enum { LAYERS_MAX = 64 };

/* The camera looks through the backs of single-sided surfaces (docs/conventions.md). */
static bool is_seen(const ppmi_world *world, const ppmi_surface *surface, ppmi_vec3 direction)
{
    const ppmi_material *material = surface->material;
    const bool is_back = vec3_dot(direction, surface->ng) > 0.0f;
    if (is_back && !material->desc.double_sided && !material->is_solid_glass) return false;
    return ppmi_surface_opacity(world->scene, surface) >= 0.5f;
}

bool ppmi_distance_in_the_middle(const ppmi_world *world, const ppmi_camera_view *view,
                                 float *out_distance_m)
{
    ppmi_ray ray = ppmi_camera_view_ray(view, 0.5f * view->width, 0.5f * view->height).ray;
    for (int i = 0; i < LAYERS_MAX; i++) {
        ppmi_hit hit;
        ppmi_surface surface;
        if (!ppmi_accel_intersect(world->accel, &ray, &hit)) return false;
        ppmi_surface_from_hit(world->scene, &hit, &surface);
        if (is_seen(world, &surface, ray.direction)) {
            *out_distance_m = vec3_dot(vec3_sub(surface.position, view->origin), view->forward);
            return *out_distance_m > 0.0f;
        }
        ray = ppmi_surface_ray(&surface, ray.direction);
    }
    return false;
}
