/* What cameras and lights have in common: a name and a place, but no size. */
#ifndef PPMI_GLTF_RIGID_H
#define PPMI_GLTF_RIGID_H

#include "gltf/gltf_reader.h"

/* The item's own name, else the node's. Returns buffer. */
const char *ppmi_gltf_choose_name(const char *own, const char *node, char *buffer, size_t size);

/* The place and the direction (+Z to the back, +Y up as far as it goes) of a node, without scale,
 * so that tiny and huge scales do no harm. Where only the place matters, nothing else is needed.
 * NULL when it went well. */
const char *ppmi_gltf_rigid_transform(const double world[16], bool has_direction, float out[16]);

#endif
