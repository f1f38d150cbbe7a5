/* Filling the photon map. */
#include "photon/map.h"

ppm_status ppmi_photon_map_fill(ppm_context *context, ppmi_photon_map *map,
                                const ppmi_photon_walk *walk, float typical_radius,
                                uint64_t *out_rays)
{
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++)
        map->photons[kind].count = 0;
    ppm_status status = ppmi_photon_walk_run(context, walk, &map->scratch, map->photons, out_rays);
    for (int kind = 0; kind < PPMI_PHOTON_KINDS && status == PPM_STATUS_OK; kind++) {
        status = ppmi_photon_grid_build(context, &map->grids[kind], map->photons[kind].photons,
                                        map->photons[kind].count, typical_radius, walk->threads);
    }
    return status;
}

void ppmi_photon_map_deinit(ppm_context *context, ppmi_photon_map *map)
{
    ppmi_photon_scratch_deinit(context, &map->scratch);
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++) {
        ppmi_photon_list_deinit(context, &map->photons[kind]);
        ppmi_photon_grid_deinit(context, &map->grids[kind]);
    }
}

uint64_t ppmi_photon_map_count(const ppmi_photon_map *map)
{
    uint64_t count = 0;
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++)
        count += map->photons[kind].count;
    return count;
}
