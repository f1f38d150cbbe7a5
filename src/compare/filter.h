/* Filters of FLIP, as pairs of one-dimensional ones, and their application to planes of floats. */
#ifndef PPMI_COMPARE_FILTER_H
#define PPMI_COMPARE_FILTER_H

#include <stdint.h>

enum { PPMI_COMPARE_RADIUS_MAX = 160, PPMI_COMPARE_TERMS_MAX = 2 };

/* Pictures of fewer pixels are done before other threads have woken up. */
enum { PPMI_COMPARE_PARALLEL_MIN = 4096 };

/* tap[k] weighs the pixel k - radius to the right (or below). */
typedef struct ppmi_compare_kernel {
    int32_t radius; /* at most RADIUS_MAX */
    float taps[2 * PPMI_COMPARE_RADIUS_MAX + 1];
} ppmi_compare_kernel;

/* A contrast sensitivity function as a sum of weight * (kernel across, then kernel down). */
typedef struct ppmi_compare_csf {
    int32_t term_count;
    float weights[PPMI_COMPARE_TERMS_MAX];               /* sum to 1 */
    ppmi_compare_kernel kernels[PPMI_COMPARE_TERMS_MAX]; /* each sums to 1 */
} ppmi_compare_csf;

enum { PPMI_COMPARE_ACHROMATIC, PPMI_COMPARE_RED_GREEN, PPMI_COMPARE_BLUE_YELLOW };

/* The filter of a channel for pixels_per_degree, 1 .. 1000. */
void ppmi_compare_csf_make(int channel, double pixels_per_degree, ppmi_compare_csf *out_csf);

/* The detectors of features: a Gaussian across the feature's length, and its first derivative
 * (edges) or second derivative (points) in the other direction. The Gaussian sums to 1, the
 * positive taps of each derivative to 1, the negative ones to -1. */
typedef struct ppmi_compare_detector {
    ppmi_compare_kernel gaussian, edge, point;
} ppmi_compare_detector;

void ppmi_compare_detector_make(double pixels_per_degree, ppmi_compare_detector *out_detector);

/* Correlates a plane with a kernel, along rows or columns; beyond the border its last pixel goes
 * on. in and out are different planes of width * height, width and height at least 1. All threads;
 * the result does not depend on their number. */
void ppmi_compare_filter_rows(const float *in, float *out, uint32_t width, uint32_t height,
                              const ppmi_compare_kernel *kernel);
void ppmi_compare_filter_columns(const float *in, float *out, uint32_t width, uint32_t height,
                                 const ppmi_compare_kernel *kernel);

#endif
