/* What the other files of this folder need of instances. */
#ifndef PPMI_SCENE_INSTANCE_H
#define PPMI_SCENE_INSTANCE_H

#include "scene/scene.h"

/* Puts the instance where it was given, less shift. */
void ppmi_instance_shift(ppmi_instance *instance, ppmi_vec3 shift);

/* World bounds over the whole shutter; false when there is nothing to hit. */
bool ppmi_instance_bounds(const ppm_scene *scene, const ppmi_instance *instance, ppmi_vec3 *out_min,
                          ppmi_vec3 *out_max);
/* Whether a corner of bounds is beyond what is traced. */
bool ppmi_is_far(ppmi_vec3 p);
void ppmi_instance_deinit(ppm_context *context, ppmi_instance *instance);

#endif
