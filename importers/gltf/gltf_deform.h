/* Meshes that change their shape: morph targets, then skins (glTF 2.0 specification, 3.7.2.2 and
 * 3.7.3.3). Each node with such a mesh has vertices of its own. */
#ifndef PPMI_GLTF_DEFORM_H
#define PPMI_GLTF_DEFORM_H

#include "gltf/gltf_geometry.h"
#include "gltf/gltf_reader.h"

/* What a target adds to one attribute, where it adds anything. */
typedef struct ppmi_gltf_delta {
    uint32_t count, width;
    uint32_t *vertices; /* each once */
    float *values;      /* width per vertex */
} ppmi_gltf_delta;

typedef struct ppmi_gltf_morph {
    ppmi_gltf_delta position, normal, tangent, color, uvs[PPM_MAX_UV_SETS];
} ppmi_gltf_morph;

/* One primitive at rest, and what moves it. */
typedef struct ppmi_gltf_deform_primitive {
    uint32_t vertex_count;
    float *positions, *normals, *tangents; /* the last two may be NULL */
    float *colors, *uvs[PPM_MAX_UV_SETS];  /* NULL where no target changes them */
    uint32_t target_count;
    ppmi_gltf_morph *targets;
    uint32_t influence_count; /* per vertex; 0: it follows the node */
    uint16_t *joints;
    float *weights; /* of joints, of sum 1 */
    float *buffer;  /* of the vertices that are being handed to the scene */
} ppmi_gltf_deform_primitive;

typedef struct ppmi_gltf_deform {
    int32_t node;
    ppm_mesh_id mesh;
    uint32_t primitive_count; /* those of the scene's mesh, in order */
    ppmi_gltf_deform_primitive *primitives;
    uint32_t joint_count; /* 0: no skin */
    const int32_t *joints;
    double (*inverse_binds)[16];
} ppmi_gltf_deform;

/* Whether a node's mesh needs vertices of its own, in this pose or a later one. */
bool ppmi_gltf_is_deformed(const ppmi_gltf_reader *reader, int32_t node);

/* For a node and room for its mesh's primitives. *out is the caller's, also after a failure, to be
 * destroyed; NULL is fine there. */
ppm_status ppmi_gltf_deform_create(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_deform **out);
void ppmi_gltf_deform_destroy(ppm_context *context, ppmi_gltf_deform *deform);

/* Reads what moves a primitive, and takes over its positions, normals and tangents. */
ppm_status ppmi_gltf_deform_read(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform,
                                 const ppmi_gltf_primitive *primitive, const char *place,
                                 ppmi_gltf_geometry *geometry);

/* gltf_mesh.c: adds the node's mesh to the scene in the present pose; deform->mesh is 0 when
 * nothing in it can be drawn. */
ppm_status ppmi_gltf_add_deformed_mesh(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform);

/* Whether the vertices are others than in the pose before. */
bool ppmi_gltf_deform_has_moved(const ppmi_gltf_reader *reader, const ppmi_gltf_deform *deform);

/* Sets positions, normals, tangents and motion_steps of desc to primitive number index in the
 * present pose, and colors and uvs that targets change to those at the middle of the shutter. They
 * stay valid until they are released. */
ppm_status ppmi_gltf_deform_pose(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform, uint32_t index,
                                 ppm_primitive_desc *desc);
void ppmi_gltf_deform_release(ppm_context *context, ppmi_gltf_deform *deform);

#endif
