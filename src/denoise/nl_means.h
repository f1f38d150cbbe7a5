/* Candidates of the filter, run together over one picture: non-local means with patches of two
 * sizes (Buades, Coll, Morel 2005, with the distance of Rousselle et al. 2012), and a filter by the
 * features alone. */
#ifndef PPMI_DENOISE_NL_MEANS_H
#define PPMI_DENOISE_NL_MEANS_H

#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

enum {
    PPMI_DENOISE_FINE,     /* patches of 3 x 3 */
    PPMI_DENOISE_COARSE,   /* patches of 7 x 7 */
    PPMI_DENOISE_FEATURES, /* no look at the light */
    PPMI_DENOISE_CANDIDATES
};

/* Planes of one float a pixel, all in one block of memory: PPMI_NL_PLANES of width * height. */
enum {
    PPMI_NL_LIGHT = 0,     /* 3 */
    PPMI_NL_VARIANCE = 3,  /* 3, smoothed */
    PPMI_NL_ALBEDO = 6,    /* 3 */
    PPMI_NL_NORMAL = 9,    /* 3 */
    PPMI_NL_NEARNESS = 12, /* 1 / depth: linear in the picture where a surface is flat */
    PPMI_NL_SLOPE = 13,    /* 2: of nearness, a pixel to the right and down */
    PPMI_NL_SCALE = 15,    /* 2: what squared differences of albedo and normal are multiplied by */
    PPMI_NL_PLANES = 17
};

typedef struct ppmi_nl_input {
    uint32_t width, height, threads;
    float correlation_px; /* as in ppmi_denoise */
    const float *planes;
} ppmi_nl_input;

/* What a candidate makes of a picture. */
typedef struct ppmi_nl_output {
    float *light; /* 3 a pixel */
    float *risk;  /* SURE, the sum over the channels, by the sum of the variances: 1 where it is as
                     good as no filter. 1 a pixel */
} ppmi_nl_output;

/* Runs all candidates. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_nl_means(ppm_context *context, const ppmi_nl_input *input,
                         const ppmi_nl_output outputs[PPMI_DENOISE_CANDIDATES]);

#endif
