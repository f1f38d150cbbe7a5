/* Samples of a low-discrepancy sequence differ by far more than their mean is off: at the edge
 * between two surfaces each sample sees one or the other, their mean the right share of both, and
 * the variance by single samples is ten times too large. A filter that believes it blurs the edge.
 *
 * Parts of the sequence are stratified as the whole is. Of means over the first share a of n
 * samples and over all of them, E (first - all)^2 = V (1 - a) / a, with V the variance of the mean
 * over all if the two parts are independent, and no less than V if they are stratified against each
 * other. So (first - all)^2 a / (1 - a) is an estimate of V, of one degree of freedom: it only
 * scales the other, neighbourhood by neighbourhood. */
#include "denoise/stratified.h"

#include <stddef.h>

#include "denoise/choice.h"

enum { NEIGHBOURHOOD_RADIUS = 3 };

static float square_of_difference(const float *a, const float *b)
{
    float sum = 0.0f;
    for (size_t c = 0; c < 3; c++)
        sum += (a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

void ppmi_denoise_lower_variance(const ppmi_stratified_means *means, float *variance,
                                 float *scratch)
{
    const size_t pixels = (size_t)means->width * means->height;
    const float scale = means->first_share / (1.0f - means->first_share);
    float *by_parts = scratch, *by_samples = scratch + pixels, *blurred = scratch + 2 * pixels;
    for (size_t i = 0; i < pixels; i++) {
        by_parts[i] = scale * square_of_difference(means->first + 3 * i, means->all + 3 * i);
        by_samples[i] = variance[3 * i] + variance[3 * i + 1] + variance[3 * i + 2];
    }
    ppmi_denoise_blur(means->width, means->height, NEIGHBOURHOOD_RADIUS, by_parts, blurred);
    ppmi_denoise_blur(means->width, means->height, NEIGHBOURHOOD_RADIUS, by_samples, blurred);
    for (size_t i = 0; i < 3 * pixels; i++) {
        if (by_parts[i / 3] < by_samples[i / 3]) variance[i] *= by_parts[i / 3] / by_samples[i / 3];
    }
}
