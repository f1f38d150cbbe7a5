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

/* Filters light, 3 floats a pixel, in place. variance: of each of its values, as estimated;
 * correlation_px: the radius in pixels of the disks over which noise is alike, as of photons that
 * several pixels gather, and 0 where each pixel's noise is its own. The same bits with any number
 * of threads. Values and variances are finite and not negative. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_denoise(ppm_context *context, const ppmi_denoise_guide *guide,
                        const float *variance, float correlation_px, float *light);

#endif
