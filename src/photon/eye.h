/* The eye pass: camera paths through mirrors and glass to the first surface, or scattering in a
 * medium, that gathers. */
#ifndef PPMI_PHOTON_EYE_H
#define PPMI_PHOTON_EYE_H

#include "camera/camera.h"
#include "photon/point.h"
#include "transport/light_layers.h"

enum { PPMI_MAX_SPLIT_DEPTH = 12 };

typedef struct ppmi_eye_settings {
    uint32_t max_depth;
    uint32_t split_depth; /* surfaces at which a path follows all its branches, at most
                             PPMI_MAX_SPLIT_DEPTH; beyond, and with 0, one is drawn */
    uint32_t media_depth; /* segments through media at which a path goes both ways: it is scattered
                             and arrives; beyond, one is drawn */
    bool samples_lights;  /* else photons bring all light that is met where they are gathered */
    float photons;        /* of a pass; 0: narrow lobes leave no light to them */
    float radius_m;       /* that photons are gathered in; 0: by the pixel's footprint */
} ppmi_eye_settings;

/* Follows one camera path. Light that needs no photons (emission, the environment, light sampling)
 * is added to *radiance; visible points are appended to points, with owner: if the path never
 * splits, at most one where all photons count, after those of narrow lobes on the way. sink gets
 * the same light by layers; it may be NULL. False when memory is out. */
bool ppmi_eye_path(ppm_context *context, ppmi_walker *walker, const ppmi_camera_ray *camera_ray,
                   const ppmi_eye_settings *settings, uint32_t owner, ppmi_visible_points *points,
                   ppmi_vec3 *radiance, const ppmi_light_sink *sink);

#endif
