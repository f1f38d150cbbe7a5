/* The eye pass: camera paths through mirrors and glass to the first surface that gathers. */
#ifndef PPMI_PHOTON_EYE_H
#define PPMI_PHOTON_EYE_H

#include "camera/camera.h"
#include "photon/gather.h"
#include "transport/world.h"

/* Follows one camera path. Light that needs no photons (emission, the environment, light sampling)
 * is returned; where the path ends at a gathering surface, slot i of points is filled, else marked
 * as not valid. */
ppmi_vec3 ppmi_eye_path(ppmi_walker *walker, const ppmi_camera_ray *camera_ray, uint32_t max_depth,
                        ppmi_visible_points *points, uint32_t i);

#endif
