/* Where photons matter, found by paths from the camera before any photon is traced.
 *
 * Trial and error by photons never finds a glass ball of centimetres on kilometres of ground. Paths
 * from the camera do (importons: Peter and Pietrek 1998, "Importance Driven Construction of Photon
 * Maps"): mirrors and glass that they meet, seen by the camera or by what it sees, are targets, and
 * so are the surroundings of what it sees, in steps of size from the nearest half of the visible
 * points to the whole scene. */
#ifndef PPMI_PHOTON_SEEK_H
#define PPMI_PHOTON_SEEK_H

#include "camera/camera.h"
#include "light/aim.h"
#include "transport/world.h"

typedef struct ppmi_seek {
    const ppmi_world *world;
    const ppmi_camera_view *view;
    float x0, y0, width, height; /* pixels of the view that are rendered */
    const ppmi_interior *around_camera;
    bool shutter_is_open;
} ppmi_seek;

/* Targets with their shares of photons to begin with, as for ppmi_aim_create. The same for the same
 * scene and view. Adds to *rays. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_seek_targets(ppm_context *context, const ppmi_seek *seek,
                             ppmi_target out_targets[PPMI_AIM_TARGETS],
                             double out_shares[PPMI_AIM_TARGETS + 1], uint32_t *out_count,
                             uint64_t *rays);

#endif
