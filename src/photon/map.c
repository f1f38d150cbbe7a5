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

void ppmi_photon_map_end_marks(ppm_context *context, ppmi_photon_map *map)
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
    ppmi_photon_map_end_marks(context, map);
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

ppmi_gathered ppmi_photon_map_gather_whole(const ppmi_photon_map *map,
                                           const ppmi_albedo_table *albedo,
                                           const ppmi_visible_point *point, float radius)
{
    return ppmi_gather(&map->grids[kind_of(point)], albedo, point, radius, NULL);
}

/* Whether nothing is gathered there, whatever the region: narrow lobes mostly find nothing. */
static bool is_vain(const ppmi_photon_map *map, const ppmi_albedo_table *albedo,
                    const ppmi_visible_point *point, float radius)
{
    if (!ppmi_gather_has_candidates(&map->grids[kind_of(point)], point, radius)) return true;
    return point->merge_area_m2 > 0.0f &&
           ppmi_photon_map_gather_whole(map, albedo, point, radius).count == 0.0f;
}

/* NULL in a medium, and where there is nothing to gather. */
static const ppmi_gather_region *find_region(const ppmi_photon_map *map,
                                             const ppmi_albedo_table *albedo,
                                             const ppmi_visible_point *point, float radius,
                                             ppmi_plain_disk *known, ppmi_gather_region *region)
{
    if (!map->accel || kind_of(point) == PPMI_PHOTONS_VOLUME) return NULL;
    if (is_vain(map, albedo, point, radius)) return NULL;
    ppmi_region_find(map->accel, point, radius, map->time, known, region);
    return region;
}

ppmi_gathered ppmi_photon_map_gather(const ppmi_photon_map *map, const ppmi_albedo_table *albedo,
                                     const ppmi_visible_point *point, float radius,
                                     ppmi_plain_disk *known)
{
    ppmi_gather_region region;
    return ppmi_gather(&map->grids[kind_of(point)], albedo, point, radius,
                       find_region(map, albedo, point, radius, known, &region));
}

ppmi_gathered ppmi_photon_map_gather_with_layers(const ppmi_photon_map *map,
                                                 const ppmi_albedo_table *albedo,
                                                 const ppmi_visible_point *point, float radius,
                                                 ppmi_plain_disk *known,
                                                 const ppmi_gather_layers *layers)
{
    const int kind = kind_of(point);
    ppmi_gather_region region;
    ppmi_gather_layers of_kind = *layers;
    of_kind.photons = map->photons[kind].photons;
    return ppmi_gather_with_layers(&map->grids[kind], albedo, point, radius,
                                   find_region(map, albedo, point, radius, known, &region),
                                   &of_kind);
}

void ppmi_photon_map_mark(const ppmi_photon_map *map, const ppmi_albedo_table *albedo,
                          const ppmi_visible_point *point, float radius, ppmi_plain_disk *known,
                          float scale)
{
    const int kind = kind_of(point);
    ppmi_gather_region region;
    const ppmi_gather_marks marks = {map->marks[kind], scale * PPMI_PHOTON_MARK};
    ppmi_gather_mark(&map->grids[kind], albedo, point, radius,
                     find_region(map, albedo, point, radius, known, &region), &marks);
}

/* ---- marks ----------------------------------------------------------------------------------- */

ppm_status ppmi_photon_map_begin_marks(ppm_context *context, ppmi_photon_map *map)
{
    ppmi_photon_map_end_marks(context, map);
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++) {
        map->marks[kind] =
            ppmi_alloc_zeroed(context, map->photons[kind].count + 1, sizeof **map->marks);
        if (!map->marks[kind]) {
            ppmi_photon_map_end_marks(context, map);
            return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: photon marks");
        }
    }
    return PPM_STATUS_OK;
}

void ppmi_photon_map_sum_marks(const ppmi_photon_map *map, uint64_t *out_sums)
{
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++) {
        const ppmi_photon_list *list = &map->photons[kind];
        for (size_t i = 0; i < list->count; i++) {
            out_sums[list->photons[i].path] +=
                atomic_load_explicit(&map->marks[kind][i], memory_order_relaxed);
        }
    }
}
