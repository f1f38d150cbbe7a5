/* Properties that animations change: places in the document's structs, found by a path. */
#ifndef PPMI_GLTF_PROPERTY_H
#define PPMI_GLTF_PROPERTY_H

#include "gltf/gltf_reader.h"

typedef struct ppmi_gltf_property {
    double *values;
    uint32_t count;
    bool is_rotation, is_flag, is_list; /* a list is written scalar by scalar */
    int32_t list, index;                /* whose it is: PPMI_GLTF_NODES, _MATERIALS, _CAMERAS,
                                           _LIGHTS or _AREA_LIGHTS, and which */
    ppmi_gltf_texture_info *texture;    /* whose transform it is, or NULL */
} ppmi_gltf_property;

/* The property of a node that a channel without extension names: translation, rotation, scale,
 * weights. False for any other word, and for weights of a node without morph targets. */
bool ppmi_gltf_node_property(ppmi_gltf_reader *reader, int32_t node, const char *path,
                             ppmi_gltf_property *out);

typedef enum ppmi_gltf_pointer_result {
    PPMI_GLTF_POINTER_FOUND,
    PPMI_GLTF_POINTER_IGNORED, /* nothing that changes the picture here */
    PPMI_GLTF_POINTER_BROKEN   /* no JSON pointer, or its object does not exist */
} ppmi_gltf_pointer_result;

/* Resolves a JSON pointer (RFC 6901) of KHR_animation_pointer. /meshes/N/weights is FOUND with
 * list PPMI_GLTF_MESHES and no values: they are those of the nodes that use the mesh. */
ppmi_gltf_pointer_result ppmi_gltf_resolve_pointer(ppmi_gltf_reader *reader, const char *pointer,
                                                   ppmi_gltf_property *out);

#endif
