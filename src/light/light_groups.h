/* Groups of lights: which part of the light is whose, for layers that show each group alone. */
#ifndef PPMI_LIGHT_GROUPS_H
#define PPMI_LIGHT_GROUPS_H

#include "light/lights.h"

/* Every emitter is in one group. Names are unique; they are those of the scene's light_group
 * fields, of lights, or "rest", in the order in which they are first met: punctual lights,
 * instances that shine, the environment. Where lights have groups of their own, the given ones come
 * first, and a light whose name is taken gets a number behind it. */
typedef struct ppmi_light_groups {
    uint32_t count;
    char **names;
    uint16_t *of_punctual; /* by index in the scene */
    uint16_t *of_instance; /* of what its emissive surfaces shine */
    uint16_t of_environment;
} ppmi_light_groups;

/* mode: PPM_LIGHT_GROUPS_, of a frozen scene that must outlive the groups. Returns OK,
 * INVALID_ARGUMENT (more than 4096 groups), OUT_OF_MEMORY. */
ppm_status ppmi_light_groups_create(ppm_context *context, const ppm_scene *scene, int32_t mode,
                                    ppmi_light_groups **out_groups);
void ppmi_light_groups_destroy(ppm_context *context, ppmi_light_groups *groups);

/* The group of an emitter of the scene's lights. */
uint32_t ppmi_light_groups_of(const ppmi_light_groups *groups, const ppmi_lights *lights,
                              uint32_t emitter);

#endif
