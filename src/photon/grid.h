/* A hash grid over photons, with cells of every size.
 *
 * Photons are sorted along the Morton curve of integer coordinates (21 bits an axis over their
 * bounding cube). A cell of the grid with 2^level finest cells a side is then one run of photons,
 * and a hash table from (level, cell) to the run serves look-ups with any radius: each takes the
 * level whose cells are just larger than the radius. Neither a large world nor radii of very
 * different sizes cost precision or speed. Distances are compared as they are: cells only narrow
 * the search.
 *
 * The table replaces a grid of visible points (as in Hachisuka and Jensen 2009) because runs of
 * photons are read in order, and summed in a fixed order by one thread: no atomics, and the same
 * bits with any number of threads. */
#ifndef PPMI_PHOTON_GRID_H
#define PPMI_PHOTON_GRID_H

#include "photon/photon.h"

enum { PPMI_GRID_BITS = 21, PPMI_GRID_MAX_RUNS = 27 };

/* What the gathering loop reads of a photon after its position. */
typedef struct ppmi_photon_payload {
    ppmi_vec3 wi, power, ng;
    float crowding;
} ppmi_photon_payload;

typedef struct ppmi_grid_entry {
    uint64_t key; /* level and cell; all bits set: free */
    uint32_t begin, end;
} ppmi_grid_entry;

typedef struct ppmi_photon_grid {
    uint32_t count;
    uint32_t capacity; /* of the arrays */
    float *x, *y, *z;  /* sorted; structure of arrays for the distance test */
    ppmi_photon_payload *payloads;

    ppmi_vec3 origin; /* lower corner of the bounding cube */
    float cell;       /* side of a finest cell, metres */
    float inverse_cell;
    float magnitude;       /* largest coordinate, for rounding bounds */
    uint32_t finest_level; /* finest one in the table */

    uint64_t *codes, *codes_swap;
    uint32_t *order, *order_swap;
    uint32_t *histograms;
    uint32_t histogram_threads;
    ppmi_grid_entry *table;
    uint64_t table_capacity, table_mask;
} ppmi_photon_grid;

typedef struct ppmi_photon_run {
    uint32_t begin, end;
} ppmi_photon_run;

/* Fills the grid with at most 2^32 - 1 photons. typical_radius: a radius that few look-ups are much
 * below (smaller ones work, with more candidates). Memory is kept for the next build.
 * Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_photon_grid_build(ppm_context *context, ppmi_photon_grid *grid,
                                  const ppmi_photon *photons, size_t count, float typical_radius,
                                  uint32_t threads);
void ppmi_photon_grid_deinit(ppm_context *context, ppmi_photon_grid *grid);

/* The runs that hold every photon within radius of p and, along the unit normal n, within
 * thickness of the plane through p. Returns their number. Any thread. */
uint32_t ppmi_photon_grid_lookup(const ppmi_photon_grid *grid, ppmi_vec3 p, float radius,
                                 ppmi_vec3 n, float thickness,
                                 ppmi_photon_run out_runs[PPMI_GRID_MAX_RUNS]);

#endif
