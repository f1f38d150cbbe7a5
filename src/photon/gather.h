/* The gathering of photons around visible points: density estimation. */
#ifndef PPMI_PHOTON_GATHER_H
#define PPMI_PHOTON_GATHER_H

#include <stdatomic.h>

#include "photon/grid.h"
#include "photon/region.h"
#include "transport/light_layers.h"

/* What photons bring to one visible point. */
typedef struct ppmi_gathered {
    ppmi_vec3 flux;  /* sum of f * power * kernel, unnormalised; throughput is not in it */
    float count;     /* photons that contributed, by the shares that narrow lobes take of them */
    float share;     /* of the disk or ball that was asked for: measure of what was searched */
    bool is_crowded; /* the disk had to be smaller than asked for */
} ppmi_gathered;

/* Gathers at a point within radius (metres): in the disk around a surface point, in the ball around
 * one in a medium. grid holds photons of that kind. At a surface a photon counts only if it lies
 * in the region (of that radius; NULL: the whole disk), on a surface that faces the same way (or
 * the other way, where light passes diffusely), and the BSDF lets some of it through: what brings
 * nothing must not shrink the radius (mitsuba-renderer/mitsuba#145). The flux is scaled to what a
 * whole disk would have. */
ppmi_gathered ppmi_gather(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
                          const ppmi_visible_point *point, float radius,
                          const ppmi_gather_region *region);

/* Whether the whole disk around a surface point has photons on surfaces that face the right way: if
 * not, nothing is gathered there. */
bool ppmi_gather_has_candidates(const ppmi_photon_grid *grid, const ppmi_visible_point *point,
                                float radius);

/* The same as ppmi_gather, with layers of light: what each photon brings, times factor, goes into
 * sink by its tag; photons is the list that the grid was built from. */
typedef struct ppmi_gather_layers {
    const ppmi_light_sink *sink;
    const ppmi_photon *photons;
    ppmi_vec3 factor;
} ppmi_gather_layers;
ppmi_gathered ppmi_gather_with_layers(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
                                      const ppmi_visible_point *point, float radius,
                                      const ppmi_gather_region *region,
                                      const ppmi_gather_layers *layers);

/* Adds to each photon that a gathering there would count, at its place in the list that the grid
 * was built from, the mean of what it brings times scale, rounded: whole numbers are summed in any
 * order alike. Any thread. */
typedef struct ppmi_gather_marks {
    _Atomic uint64_t *sums;
    float scale;
} ppmi_gather_marks;
void ppmi_gather_mark(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
                      const ppmi_visible_point *point, float radius,
                      const ppmi_gather_region *region, const ppmi_gather_marks *marks);

#endif
