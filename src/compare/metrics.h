/* Errors that are counted pixel by pixel. */
#ifndef PPMI_COMPARE_METRICS_H
#define PPMI_COMPARE_METRICS_H

#include <stdint.h>

#include "base/context.h"
#include "compare/pair.h"

typedef struct ppmi_compare_metrics {
    uint64_t pixels;  /* that were averaged: neither broken nor trimmed */
    uint64_t trimmed; /* left out as the worst */
    double mse;
    double relative_mse;
    double peak;
    double psnr_db; /* infinite where mse is 0 */
} ppmi_compare_metrics;

/* Mean over R, G, B of (test - reference)^2 in one pixel. */
double ppmi_compare_squared_error(const ppmi_compare_pair *pair, size_t pixel);
/* Mean over R, G, B of (test - reference)^2 / (reference^2 + 0.01). */
double ppmi_compare_relative_error(const ppmi_compare_pair *pair, size_t pixel);

/* trim: the share of the pixels that are left out of all three numbers, those with the largest
 * relative error, 0 .. 0.999; of equal ones those that come first stay. peak: of PSNR; 0: the
 * largest value of the reference for pictures of light, 1 for others. Returns OK or OUT_OF_MEMORY.
 */
ppm_status ppmi_compare_measure(ppm_context *context, const ppmi_compare_pair *pair, double trim,
                                double peak, ppmi_compare_metrics *out_metrics);

#endif
