/* Pixel filters, by importance sampling: every camera ray belongs to one pixel with weight 1, and
 * its offset from the pixel's centre has the filter as its density (Ernst, Stamminger, Greiner
 * 2006, "Filter Importance Sampling"). Statistics that are kept for a pixel, such as those of
 * progressive photon mapping, then need no weights and nothing of other pixels. */
#ifndef PPMI_CAMERA_FILTER_H
#define PPMI_CAMERA_FILTER_H

#include "math/sampling.h"
#include "ppm/render.h"

enum { PPMI_FILTER_CELLS = 1024 };

/* A filter is the product of one profile in x and the same in y. */
typedef struct ppmi_pixel_filter {
    int32_t kind; /* PPM_PIXEL_FILTER_, not DEFAULT */
    float width;  /* full, pixels */
    /* distances from the centre, of the upper half of the profile: entry i is exceeded by a share
     * of (1 - i / PPMI_FILTER_CELLS)^2 */
    float quantiles[PPMI_FILTER_CELLS + 1];
} ppmi_pixel_filter;

/* The full width, in pixels, that a kind has by default. */
float ppmi_pixel_filter_default_width(int32_t kind);

/* kind is not DEFAULT, width above 0. */
void ppmi_pixel_filter_init(ppmi_pixel_filter *filter, int32_t kind, float width);

/* Share of the profile below offset x from the pixel's centre, both in pixels. */
double ppmi_pixel_filter_cdf(int32_t kind, double width, double x);

/* The offset, in pixels, below which lies the share u (0 <= u < 1) of the profile: monotone, so
 * that stratified numbers give stratified offsets. */
float ppmi_pixel_filter_offset(const ppmi_pixel_filter *filter, float u);

#endif
