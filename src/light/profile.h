/* Light profiles: intensity by direction, looked up and drawn from. */
#ifndef PPMI_LIGHT_PROFILE_H
#define PPMI_LIGHT_PROFILE_H

#include "math/alias.h"
#include "scene/scene.h"

/* Candela along a unit direction in the light's frame: -z is the pole. */
float ppmi_light_profile_value(const ppmi_light_profile *profile, ppmi_vec3 local);

/* Directions by about their intensity: cells even in solid angle, by their mean. */
typedef struct ppmi_profile_table {
    uint32_t rows, columns;
    ppmi_alias cells;
    float flux; /* integral of the profile over all directions, cd sr */
} ppmi_profile_table;

/* Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_profile_table_init(ppm_context *context, const ppmi_light_profile *profile,
                                   ppmi_profile_table *out_table);
void ppmi_profile_table_deinit(ppm_context *context, ppmi_profile_table *table);

/* A direction in the light's frame; returns its density, above 0 wherever the profile is. */
float ppmi_profile_table_sample(const ppmi_profile_table *table, float u, float v,
                                ppmi_vec3 *out_local);

#endif
