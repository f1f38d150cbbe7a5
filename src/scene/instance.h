/* What the other files of this folder need of instances. */
#ifndef PPMI_SCENE_INSTANCE_H
#define PPMI_SCENE_INSTANCE_H

#include "scene/scene.h"

/* Puts the instance where it was given, less shift. */
void ppmi_instance_shift(ppmi_instance *instance, ppmi_vec3 shift);
void ppmi_instance_deinit(ppm_context *context, ppmi_instance *instance);

#endif
