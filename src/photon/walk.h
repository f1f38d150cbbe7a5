/* The photon pass: photons from the lights through the scene. */
#ifndef PPMI_PHOTON_WALK_H
#define PPMI_PHOTON_WALK_H

#include <stdatomic.h>

#include "light/aim.h"
#include "photon/guide.h"
#include "photon/photon.h"
#include "transport/light_layers.h"

typedef struct ppmi_photon_walk {
    const ppmi_world *world;
    uint64_t seed;
    uint64_t first_index; /* of this call's first photon in the whole render */
    uint32_t count;       /* photons to emit */
    uint32_t max_depth;
    uint32_t first_depth; /* photons are kept from this vertex on: 1 leaves what comes straight from
                             a light to light sampling, 0 keeps it; thin sheets that they pass
                             straight from the light are no vertices */
    const ppmi_aim *aim;  /* where to send photons; NULL: evenly, by power */
    const ppmi_photon_guide *guide;  /* what is learnt about the numbers that aim takes, or NULL */
    bool tags_photons;               /* for layers of light, */
    const ppmi_light_groups *groups; /* with groups of lights; or NULL */
    bool shutter_is_open;            /* each photon has a time within it, */
    bool has_one_time;               /* this one for all, */
    float time;                      /* or else its own */
    uint32_t threads;
    const atomic_bool *cancel;
} ppmi_photon_walk;

/* Scratch of the walk, kept between passes. */
typedef struct ppmi_photon_scratch {
    ppmi_photon_list (*lists)[PPMI_PHOTON_KINDS]; /* one of each kind a thread */
    uint32_t list_count;
    struct ppmi_photon_chunk *chunks;
    uint32_t chunk_capacity;
} ppmi_photon_scratch;

void ppmi_photon_scratch_deinit(ppm_context *context, ppmi_photon_scratch *scratch);

/* The numbers that photon i of the walk is emitted by; returns their density. */
double ppmi_photon_walk_sample(const ppmi_photon_walk *walk, uint32_t i,
                               ppmi_emission_sample *out_sample);

/* Emits count photons and appends those that land on gathering surfaces or are scattered in media
 * to the list of their kind, in the order of emission whatever the number of threads. Adds to
 * *out_rays. Returns OK, CANCELLED, OUT_OF_MEMORY. */
ppm_status ppmi_photon_walk_run(ppm_context *context, const ppmi_photon_walk *walk,
                                ppmi_photon_scratch *scratch,
                                ppmi_photon_list out_photons[PPMI_PHOTON_KINDS],
                                uint64_t *out_rays);

#endif
