/* The denoised picture of a session: its light layers, filtered one by one. */
#ifndef PPMI_RENDER_DENOISED_H
#define PPMI_RENDER_DENOISED_H

#include "render/features.h"

/* What it is made from, after at least two passes. */
typedef struct ppmi_denoised_source {
    const ppmi_job *job;
    const ppmi_integrator *integrator;
    const void *state;
    const ppmi_features *features;
    uint64_t passes;
    bool has_plate; /* the picture holds catchers less their plate: those are left as they are */
} ppmi_denoised_source;

/* Takes the noise out of the session's picture: adds what the filter changes of each light layer.
 * Alpha stays. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_denoised_apply(const ppmi_denoised_source *source, float *rgba);

#endif
