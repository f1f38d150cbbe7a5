/* What rays pass on their way: surfaces that alpha takes away, backs that the camera does not see,
 * and thin sheets, which do not bend light, for shadow rays. All is decided within one search of
 * the acceleration structure (ppmi_accel_intersect_filtered): any number is passed, and nothing
 * behind them is jumped over, however close. */
#ifndef PPMI_TRANSPORT_PASSING_H
#define PPMI_TRANSPORT_PASSING_H

#include "transport/world.h"

/* Alpha that is rounded: a surface is there from one half on. */
bool ppmi_is_cut_away(const ppm_scene *scene, const ppmi_surface *surface);

/* The closest hit of a path's ray where it is stopped: alpha is decided by chance, hit by hit, or
 * rounded (walker->rounds_opacity). */
bool ppmi_passing_intersect(ppmi_walker *walker, const ppmi_ray *ray, ppmi_ray_kind kind,
                            ppmi_hit *out_hit);

/* The same with rounded alpha, for what is no path. */
bool ppmi_passing_intersect_rounded(const ppmi_world *world, const ppmi_ray *ray,
                                    ppmi_ray_kind kind, ppmi_hit *out_hit);

/* The product, by channel, of what all surfaces in (0, t_max) leave of light that comes along the
 * ray to its origin: 1 - opacity, and what goes straight through thin sheets. */
ppmi_vec3 ppmi_passing_visibility(const ppmi_world *world, const ppmi_ray *ray);

#endif
