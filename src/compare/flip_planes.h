/* The inside of ppmi_compare_flip, for flip.c and hdr_flip.c. */
#ifndef PPMI_COMPARE_FLIP_PLANES_H
#define PPMI_COMPARE_FLIP_PLANES_H

#include "compare/filter.h"
#include "compare/flip.h"

enum {
    PLANE_Y,
    PLANE_CX,
    PLANE_CZ,
    PLANE_SCRATCH,
    PLANE_SCRATCH_2,
    PLANE_TEST,                       /* what is seen of a picture: three of colour, */
    PLANE_REFERENCE = PLANE_TEST + 5, /* edges, points */
    PLANES = PLANE_REFERENCE + 5
};

struct ppmi_compare_flip {
    ppm_context *context;
    uint32_t width, height;
    size_t pixel_count;
    float *memory; /* of all planes */
    float *planes[PLANES];
    ppmi_compare_csf csf[3];
    ppmi_compare_detector detector;
};

#endif
