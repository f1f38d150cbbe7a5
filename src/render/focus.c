/* Focusing on what is in the middle of the picture. */
#include "render/integrator.h"
#include "transport/passing.h"

/* Through veils and backs that the camera looks through (docs/conventions.md). */
bool ppmi_distance_in_the_middle(const ppmi_world *world, const ppmi_camera_view *view,
                                 float *out_distance_m)
{
    const ppmi_ray ray = ppmi_camera_view_ray(view, 0.5f * view->width, 0.5f * view->height).ray;
    ppmi_hit hit;
    ppmi_surface surface;
    if (!ppmi_passing_intersect_rounded(world, &ray, PPMI_RAY_CAMERA, &hit)) return false;
    ppmi_surface_from_hit(world->scene, &hit, &surface);
    *out_distance_m = vec3_dot(vec3_sub(surface.position, view->origin), view->forward);
    return *out_distance_m > 0.0f;
}
