/* Few targets for the many places that paths from the camera have met. */
#ifndef PPMI_PHOTON_TARGET_CLUSTERS_H
#define PPMI_PHOTON_TARGET_CLUSTERS_H

#include "light/target.h"

/* A place on a surface, as large as the distance to its neighbours. */
typedef struct ppmi_found {
    ppmi_target target;
    uint32_t instance, primitive;
} ppmi_found;

/* At most most targets that hold all count places of found (which is sorted anew); what is not much
 * larger than the places on it is held as a whole. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_cluster_found(ppm_context *context, const ppm_scene *scene, ppmi_found *found,
                              uint32_t count, ppmi_target *out_targets, uint32_t most,
                              uint32_t *out_count);

#endif
