/* The photon map of one pass: photons at surfaces and in media, each in its grid. */
#ifndef PPMI_PHOTON_MAP_H
#define PPMI_PHOTON_MAP_H

#include "photon/gather.h"
#include "photon/walk.h"

/* Zero it to begin with. Memory is kept from pass to pass. */
typedef struct ppmi_photon_map {
    ppmi_photon_scratch scratch;
    ppmi_photon_list photons[PPMI_PHOTON_KINDS];
    ppmi_photon_grid grids[PPMI_PHOTON_KINDS];
    _Atomic uint64_t
        *marks[PPMI_PHOTON_KINDS]; /* what photons brought, while that is learnt from */
    const ppmi_accel *accel; /* what the photons landed on; NULL: disks are taken to be whole */
    float time;              /* of the photons, or any where nothing moves */
} ppmi_photon_map;

/* Traces the photons of walk and sorts them, in place of what the map held. typical_radius: see
 * ppmi_photon_grid_build. Adds to *out_rays. Returns OK, CANCELLED, OUT_OF_MEMORY. */
ppm_status ppmi_photon_map_fill(ppm_context *context, ppmi_photon_map *map,
                                const ppmi_photon_walk *walk, float typical_radius,
                                uint64_t *out_rays);
void ppmi_photon_map_deinit(ppm_context *context, ppmi_photon_map *map);

uint64_t ppmi_photon_map_count(const ppmi_photon_map *map);

/* Learning what photons do: marks are made, visible points mark the photons that they see (any
 * thread; scale: of a photon's contribution to the share of all light there), and the paths of
 * those are told. */
#define PPMI_PHOTON_MARK 0x1p20f /* of a photon that is all the light of a pixel */
ppm_status ppmi_photon_map_begin_marks(ppm_context *context, ppmi_photon_map *map);
void ppmi_photon_map_end_marks(ppm_context *context, ppmi_photon_map *map);
void ppmi_photon_map_mark(const ppmi_photon_map *map, const ppmi_albedo_table *albedo,
                          const ppmi_visible_point *point, float radius, ppmi_plain_disk *known,
                          float scale);

/* Adds up the marks of each path: out_sums, one for each of count paths, zero to begin with. */
void ppmi_photon_map_sum_marks(const ppmi_photon_map *map, uint64_t *out_sums);

/* Gathers at a visible point, of either kind, what lies in the region of gathering around it.
 * known: as for ppmi_region_find. */
ppmi_gathered ppmi_photon_map_gather(const ppmi_photon_map *map, const ppmi_albedo_table *albedo,
                                     const ppmi_visible_point *point, float radius,
                                     ppmi_plain_disk *known);

/* What the whole disk or ball around it would bring: no fewer photons, and cheaper to tell. */
ppmi_gathered ppmi_photon_map_gather_whole(const ppmi_photon_map *map,
                                           const ppmi_albedo_table *albedo,
                                           const ppmi_visible_point *point, float radius);

/* The same as ppmi_photon_map_gather, with layers of light; layers->photons is not used. */
ppmi_gathered ppmi_photon_map_gather_with_layers(const ppmi_photon_map *map,
                                                 const ppmi_albedo_table *albedo,
                                                 const ppmi_visible_point *point, float radius,
                                                 ppmi_plain_disk *known,
                                                 const ppmi_gather_layers *layers);

#endif
