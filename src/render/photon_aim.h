/* Learning where photons go: targets, then rounds of photons that are not used for the picture. */
#ifndef PPMI_RENDER_PHOTON_AIM_H
#define PPMI_RENDER_PHOTON_AIM_H

#include "photon/map.h"
#include "render/integrator.h"

/* Zero it to begin with. */
typedef struct ppmi_photon_aim {
    ppmi_aim *aim;            /* NULL: photons are emitted evenly, by power */
    ppmi_photon_guide *guide; /* what has been learnt, */
    uint32_t rounds;          /* in so many rounds; 0: nothing yet */
    bool is_learnt;
    ppmi_guide_seen *seen; /* while there are more to come: all photons that were gathered */
    size_t seen_count, seen_capacity;
    double even_cost;    /* rays and photons kept of one that is emitted evenly, */
    double aimed_cost;   /* and of one of the last round */
    double used_share;   /* photons of the last round that were gathered, of those emitted */
    ppm_light_use *uses; /* the same by light */
    uint32_t use_count;
} ppmi_photon_aim;

void ppmi_photon_aim_deinit(ppm_context *context, ppmi_photon_aim *aim);

/* Finds the targets. Adds to *rays. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_photon_aim_begin(const ppmi_job *job, ppmi_photon_aim *aim, uint64_t *rays);

/* Learns from a round: map, of walk, has the marks. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_photon_aim_learn(const ppmi_job *job, ppmi_photon_aim *aim, ppmi_photon_map *map,
                                 const ppmi_photon_walk *walk);

#endif
