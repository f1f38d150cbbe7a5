/* Filling the photon map. */
#include "photon/map.h"

ppm_status ppmi_photon_map_fill(ppm_context *context, ppmi_photon_map *map,
                                const ppmi_photon_walk *walk, float typical_radius,
                                uint64_t *out_rays)
{
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++)
        map->photons[kind].count = 0;
    map->accel = walk->world->accel;
    map->time = walk->has_one_time ? walk->time : 0.0f;
    ppm_status status = ppmi_photon_walk_run(context, walk, &map->scratch, map->photons, out_rays);
    for (int kind = 0; kind < PPMI_PHOTON_KINDS && status == PPM_STATUS_OK; kind++) {
        status = ppmi_photon_grid_build(context, &map->grids[kind], map->photons[kind].photons,
                                        map->photons[kind].count, typical_radius, walk->threads);
    }
    return status;
}

static void free_marks(ppm_context *context, ppmi_photon_map *map)
{
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++) {
        ppmi_free(context, map->marks[kind]);
        map->marks[kind] = NULL;
    }
}

void ppmi_photon_map_deinit(ppm_context *context, ppmi_photon_map *map)
{
    ppmi_photon_scratch_deinit(context, &map->scratch);
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++) {
        ppmi_photon_list_deinit(context, &map->photons[kind]);
        ppmi_photon_grid_deinit(context, &map->grids[kind]);
    }
    free_marks(context, map);
}

uint64_t ppmi_photon_map_count(const ppmi_photon_map *map)
{
    uint64_t count = 0;
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++)
        count += map->photons[kind].count;
    return count;
}

/* ---- gathering ------------------------------------------------------------------------------- */

static int kind_of(const ppmi_visible_point *point)
{
    return ppmi_bsdf_is_phase(&point->bsdf) ? PPMI_PHOTONS_VOLUME : PPMI_PHOTONS_SURFACE;
}

/* Narrow lobes mostly find nothing: no region is looked for then. */
static bool is_vain(const ppmi_photon_map *map, const ppmi_albedo_table *albedo,
                    const ppmi_visible_point *point, float radius)
{
    return point->merge_area_m2 > 0.0f &&
           ppmi_gather(&map->grids[kind_of(point)], albedo, point, radius, NULL).count == 0.0f;
}

/* NULL in a medium. */
static const ppmi_gather_region *find_region(const ppmi_photon_map *map,
                                             const ppmi_albedo_table *albedo,
                                             const ppmi_visible_point *point, float radius,
                                             ppmi_gather_region *region)
{
    if (!map->accel || kind_of(point) == PPMI_PHOTONS_VOLUME) return NULL;
    if (is_vain(map, albedo, point, radius)) return NULL;
    ppmi_region_find(map->accel, point, radius, map->time, region);
    return region;
}

ppmi_gathered ppmi_photon_map_gather(const ppmi_photon_map *map, const ppmi_albedo_table *albedo,
                                     const ppmi_visible_point *point, float radius)
{
    ppmi_gather_region region;
    return ppmi_gather(&map->grids[kind_of(point)], albedo, point, radius,
                       find_region(map, albedo, point, radius, &region));
}

ppmi_gathered ppmi_photon_map_gather_with_layers(const ppmi_photon_map *map,
                                                 const ppmi_albedo_table *albedo,
                                                 const ppmi_visible_point *point, float radius,
                                                 const ppmi_gather_layers *layers)
{
    const int kind = kind_of(point);
    ppmi_gather_region region;
    ppmi_gather_layers of_kind = *layers;
    of_kind.photons = map->photons[kind].photons;
    return ppmi_gather_with_layers(&map->grids[kind], albedo, point, radius,
                                   find_region(map, albedo, point, radius, &region), &of_kind);
}

void ppmi_photon_map_mark(const ppmi_photon_map *map, const ppmi_albedo_table *albedo,
                          const ppmi_visible_point *point, float radius)
{
    const int kind = kind_of(point);
    ppmi_gather_region region;
    ppmi_gather_mark(&map->grids[kind], albedo, point, radius,
                     find_region(map, albedo, point, radius, &region), map->marks[kind]);
}

/* ---- the guide ------------------------------------------------------------------------------- */

ppm_status ppmi_photon_map_begin_marks(ppm_context *context, ppmi_photon_map *map)
{
    free_marks(context, map);
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++) {
        map->marks[kind] =
            ppmi_alloc_zeroed(context, map->photons[kind].count + 1, sizeof **map->marks);
        if (!map->marks[kind]) {
            free_marks(context, map);
            return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: photon marks");
        }
    }
    return PPM_STATUS_OK;
}

/* Photons of one path are one after the other: each path counts once. Returns the number of paths
 * that were seen. */
static uint64_t count_seen(const ppmi_photon_map *map, const ppmi_photon_walk *walk, int kind,
                           ppmi_guide_counts *counts)
{
    const ppmi_photon_list *list = &map->photons[kind];
    uint64_t seen = 0;
    uint32_t last_path = UINT32_MAX;
    for (size_t i = 0; i < list->count; i++) {
        const uint32_t path = list->photons[i].path;
        const bool is_seen = atomic_load_explicit(&map->marks[kind][i], memory_order_relaxed) != 0;
        if (!is_seen || path == last_path) continue;
        last_path = path;
        const ppmi_emission_sample sample = ppmi_photon_walk_sample(walk, path);
        ppmi_guide_count(counts, walk->world->lights, &sample);
        seen++;
    }
    return seen;
}

/* A photon that was kept will be met as much more often as its sample is drawn. */
static double gain_of(const ppmi_photon_map *map, const ppmi_photon_walk *walk,
                      const ppmi_photon_guide *guide)
{
    double kept = 0.0, will_be_kept = 0.0, density = 1.0;
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++) {
        const ppmi_photon_list *list = &map->photons[kind];
        uint32_t last_path = UINT32_MAX;
        for (size_t i = 0; i < list->count; i++) {
            if (list->photons[i].path != last_path) {
                last_path = list->photons[i].path;
                const ppmi_emission_sample sample = ppmi_photon_walk_sample(walk, last_path);
                density = (double)ppmi_guide_density(guide, walk->world->lights, &sample);
            }
            kept += 1.0;
            will_be_kept += density;
        }
    }
    return kept > 0.0 ? will_be_kept / kept : 1.0;
}

ppm_status ppmi_photon_map_learn(ppm_context *context, ppmi_photon_map *map,
                                 const ppmi_photon_walk *walk, ppmi_photon_guide *guide,
                                 double *out_gain)
{
    enum { LEAST_SEEN = 256 };
    ppmi_guide_counts *counts = ppmi_alloc_zeroed(context, 1, sizeof *counts);
    if (!counts) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: guide");
    uint64_t seen = 0;
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++)
        seen += count_seen(map, walk, kind, counts);
    *out_gain = 0.0;
    if (seen >= LEAST_SEEN) {
        ppmi_guide_learn(guide, counts);
        *out_gain = gain_of(map, walk, guide);
    }
    ppmi_free(context, counts);
    free_marks(context, map);
    return PPM_STATUS_OK;
}
