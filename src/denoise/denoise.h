/* Takes noise out of a picture of light whose variance is known: non-local means, guided by
 * features, after Rousselle, Manzi, Zwicker 2013, "Robust Denoising using Feature and Color
 * Information" (Computer Graphics Forum 32(7)).
 *
 * Several filters are run; Stein's unbiased risk estimate (SURE) tells pixel by pixel which comes
 * closest to the truth, with "no filter" among them. */
#ifndef PPMI_DENOISE_DENOISE_H
#define PPMI_DENOISE_DENOISE_H

#include "base/context.h"

/* Pictures without noise, or nearly so, that tell what belongs together. Row by row. */
typedef struct ppmi_denoise_guide {
    uint32_t width, height;
    const float *albedo; /* 3 a pixel */
    const float *normal; /* 3 a pixel */
    const float *depth;  /* 1 a pixel, positive; any unit */
    uint32_t threads;
} ppmi_denoise_guide;

/* What is known of the error of light. */
typedef struct ppmi_denoise_noise {
    const float *variance; /* of each value, as estimated: 3 a pixel, finite, not negative */
    float correlation_px;  /* radius of the disks over which noise is alike, as of photons that
                            * several pixels gather; 0 where each pixel's noise is its own */
    bool is_blurred;       /* has an error besides noise that a filter adds to, as caustics have */
} ppmi_denoise_noise;

/* Filters light, 3 finite floats a pixel that are not negative, in place. The same bits with any
 * number of threads. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_denoise(ppm_context *context, const ppmi_denoise_guide *guide,
                        const ppmi_denoise_noise *noise, float *light);

#endif
