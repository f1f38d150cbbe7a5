/* FLIP: how different two pictures look to somebody who flips between them. */
#ifndef PPMI_COMPARE_FLIP_H
#define PPMI_COMPARE_FLIP_H

#include <stdint.h>

#include "base/context.h"

/* Filters and planes for pictures of one size. */
typedef struct ppmi_compare_flip ppmi_compare_flip;

/* pixels_per_degree: of the observer's field of view, 1 .. 1000; 67 is 0.7 m from a 4K display that
 * is 0.7 m wide. width, height: at least 1. Returns OK or OUT_OF_MEMORY. */
ppm_status ppmi_compare_flip_create(ppm_context *context, uint32_t width, uint32_t height,
                                    double pixels_per_degree, ppmi_compare_flip **out_flip);
void ppmi_compare_flip_destroy(ppmi_compare_flip *flip);

/* LDR-FLIP. test and reference: width * height * 3 linear Rec.709 values as a display shows them,
 * clamped to 0..1 here, finite. errors: width * height values, 0 (equal) .. 1. All threads; the
 * result does not depend on their number. */
void ppmi_compare_flip_ldr(ppmi_compare_flip *flip, const float *test, const float *reference,
                           float *errors);

/* The exposures that HDR-FLIP looks through: start, ..., stop, count of them in equal steps. */
typedef struct ppmi_compare_exposures {
    double start_ev, stop_ev;
    uint32_t count; /* at least 2, or 1 for a black reference */
} ppmi_compare_exposures;

/* From the reference's luminances (values * 3, finite). sorted is room for pixel_count floats. */
ppmi_compare_exposures ppmi_compare_find_exposures(const float *reference, size_t pixel_count,
                                                   float *sorted);

/* HDR-FLIP: for each pixel the largest LDR-FLIP among the exposures, each tone-mapped. test and
 * reference: scene-linear Rec.709. Returns OK or OUT_OF_MEMORY. */
ppm_status ppmi_compare_flip_hdr(ppmi_compare_flip *flip, const float *test, const float *reference,
                                 const ppmi_compare_exposures *exposures, float *errors);

/* The filmic curve that HDR-FLIP shows pictures by: linear light in, linear display values out. */
float ppmi_compare_tone_map(float light);

#endif
