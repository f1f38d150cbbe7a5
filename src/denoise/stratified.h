/* Variances of means over samples that are stratified against each other. */
#ifndef PPMI_DENOISE_STRATIFIED_H
#define PPMI_DENOISE_STRATIFIED_H

#include <stdint.h>

typedef struct ppmi_stratified_means {
    uint32_t width, height;
    const float *all;   /* means over all samples, 3 floats a pixel, row by row */
    const float *first; /* and over the first of them */
    float first_share;  /* of the samples, in 0..1 */
} ppmi_stratified_means;

/* Lowers variances that were estimated as if the samples were independent, 3 floats a pixel, in
 * place: where the first samples' mean is nearer to that of all of them than they say. scratch:
 * three floats a pixel. */
void ppmi_denoise_lower_variance(const ppmi_stratified_means *means, float *variance,
                                 float *scratch);

#endif
