/* What nodes have put into the scene, to find it again when it moves. */
#ifndef PPMI_GLTF_PLACEMENT_H
#define PPMI_GLTF_PLACEMENT_H

#include "gltf/gltf_reader.h"

enum { PPMI_GLTF_NO_INSTANCE = -1 };

/* The ways in which a node can carry a light. */
typedef enum ppmi_gltf_light_way {
    PPMI_GLTF_WAY_PUNCTUAL,
    PPMI_GLTF_WAY_AREA,
    PPMI_GLTF_WAY_IES,
    PPMI_GLTF_WAY_EXTRAS,
    PPMI_GLTF_WAY_COUNT
} ppmi_gltf_light_way;

typedef struct ppmi_gltf_placements {
    int64_t *first_instance;           /* per node, in instances; -1: none yet */
    ppm_camera_id *cameras;            /* per node; 0: none yet */
    ppm_light_id *lights;              /* per node and way */
    struct ppmi_gltf_deform **deforms; /* per node; NULL: none */
    size_t instance_count, instance_capacity;
    ppm_instance_id *instances;
} ppmi_gltf_placements;

ppm_status ppmi_gltf_placements_create(ppmi_gltf_reader *reader);
void ppmi_gltf_placements_destroy(ppmi_gltf_reader *reader);

/* Each adds what a node has at its first call, and changes it at the later ones. ordinal counts the
 * instances of a node from 0, in order. */
ppm_status ppmi_gltf_put_instance(ppmi_gltf_reader *reader, int32_t node, size_t ordinal,
                                  bool is_visible, const ppm_instance_desc *desc);
ppm_status ppmi_gltf_put_camera(ppmi_gltf_reader *reader, int32_t node,
                                const ppm_camera_desc *desc);
/* A light of a node that is not visible gives none. */
ppm_status ppmi_gltf_put_light(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_light_way way,
                               const ppm_light_desc *desc);
/* Of a light that cannot be as it is now: takes the light of the pose before away, if there is one.
 * One that a scale of zero takes away is in the scene all the same, and dark: the file has light.
 */
ppm_status ppmi_gltf_darken_light(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_light_way way);

#endif
