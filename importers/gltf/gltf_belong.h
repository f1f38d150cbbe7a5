/* What a node belongs to beyond its parent: the asset it is a part of, its light group. */
#ifndef PPMI_GLTF_BELONG_H
#define PPMI_GLTF_BELONG_H

#include "gltf/gltf_reader.h"

/* Finds both for all nodes of the scene, once their order is known. */
void ppmi_gltf_belong_find(ppmi_gltf_reader *reader);

/* The name of the topmost ancestor that has one, in buffer; NULL where nothing above the node has.
 */
const char *ppmi_gltf_asset_name(const ppmi_gltf_reader *reader, int32_t node, char *buffer,
                                 size_t size);

/* extras.ppm_light_group of what hangs on the node (own; "": it says nothing), else of the node,
 * else of the nearest ancestor that has one, in buffer; NULL where nobody has. */
const char *ppmi_gltf_light_group(const ppmi_gltf_reader *reader, int32_t node, const char *own,
                                  char *buffer, size_t size);

#endif
