/* What is known of the lights by place: how much of what a choice promises arrives there.
 *
 * Neither distance nor direction know of walls. Probes, places that the camera's paths meet, have
 * tried each choice by a shadow ray; cells of some probes each, parted by the side that their
 * normals face and then by place, hold what came of it (compare Vevoda, Kondapaneni, Krivanek 2018,
 * "Bayesian online regression for adaptive direct illumination sampling"). Cells are as small as
 * probes are dense, so that the scale of a scene does not matter. */
#ifndef PPMI_LIGHT_LIGHT_CELLS_H
#define PPMI_LIGHT_LIGHT_CELLS_H

#include "light/lights.h"

enum { PPMI_CELL_SIDES = 7 }; /* six that a normal may face, and no normal */

typedef struct ppmi_light_cell {
    float at;      /* places below that are in the first child */
    uint32_t next; /* the second child: the first one follows; of a leaf its row of worth */
    uint32_t axis; /* 0 .. 2; 3: a leaf */
} ppmi_light_cell;

typedef struct ppmi_light_cells {
    uint32_t choices;
    uint32_t roots[PPMI_CELL_SIDES]; /* cell, or UINT32_MAX: no probe */
    uint32_t cell_count, row_count;
    ppmi_light_cell *cells;
    float *worth; /* rows of choices; the first one is that of all probes */
} ppmi_light_cells;

/* Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_light_cells_init(ppm_context *context, ppmi_light_cells *cells,
                                 const ppmi_light_probe *probes, uint32_t count, uint32_t choices);
void ppmi_light_cells_deinit(ppm_context *context, ppmi_light_cells *cells);

/* For each choice the root of the mean square of what arrives at a place like the receiver's, over
 * what its importance promises; NULL if nothing is known. */
const float *ppmi_light_cells_worth(const ppmi_light_cells *cells, const ppmi_receiver *receiver);

#endif
