/* Radiance that comes from infinitely far, by direction: constant or a latitude-longitude image. */
#ifndef PPMI_LIGHT_ENVIRONMENT_H
#define PPMI_LIGHT_ENVIRONMENT_H

#include "math/alias.h"
#include "scene/scene.h"

typedef struct ppmi_environment_map {
    const ppm_scene *scene;
    ppm_texture texture; /* image 0: constant */
    ppmi_vec3 radiance;  /* factor */
    float cos_rotation, sin_rotation;
    uint32_t columns, rows; /* cells of the sampling table */
    ppmi_alias cells;       /* by power, with a share spread evenly */
    ppmi_vec3 integral;     /* of radiance over all directions, nit sr */
} ppmi_environment_map;

ppm_status ppmi_environment_map_init(ppm_context *context, const ppm_scene *scene,
                                     ppmi_environment_map *map);
void ppmi_environment_map_deinit(ppm_context *context, ppmi_environment_map *map);

static inline bool ppmi_environment_map_is_constant(const ppmi_environment_map *map)
{
    return map->texture.image == 0;
}

/* Radiance that arrives from direction (unit, towards the sky). */
ppmi_vec3 ppmi_environment_map_radiance(const ppmi_environment_map *map, ppmi_vec3 direction);

/* Draws a direction by power (evenly for a constant map); returns its density by solid angle. */
float ppmi_environment_map_sample(const ppmi_environment_map *map, double u_cell, float u, float v,
                                  ppmi_vec3 *out_direction);

/* The same within a cell of an image that was drawn by its probability. */
float ppmi_environment_map_sample_cell(const ppmi_environment_map *map, uint32_t cell, float u,
                                       float v, ppmi_vec3 *out_direction);
float ppmi_environment_map_pdf(const ppmi_environment_map *map, ppmi_vec3 direction);

#endif
