/* One primitive's arrays on their way to the scene. */
#ifndef PPMI_GLTF_GEOMETRY_H
#define PPMI_GLTF_GEOMETRY_H

#include "gltf/gltf_reader.h"

/* All arrays are owned until the scene has copied them. */
typedef struct ppmi_gltf_geometry {
    size_t vertex_count, triangle_count;
    float *positions, *normals, *tangents, *colors;
    bool is_taken; /* the first three belong to what deforms the mesh */
    float *uvs[PPM_MAX_UV_SETS];
    uint32_t *indices;
    uint32_t *sources; /* the number in the file of each vertex, or NULL: its own */
    ppm_material_id material;
} ppmi_gltf_geometry;

/* The triangle list of count indices in a mode (PPMI_GLTF_TRIANGLES, _STRIP, _FAN). *out_indices is
 * the caller's; NULL for no triangle. Returns OK or OUT_OF_MEMORY, unreported. */
ppm_status ppmi_gltf_triangles(ppm_context *context, int32_t mode, const uint32_t *indices,
                               size_t count, uint32_t **out_indices, size_t *out_triangles);

/* Drops the vertices that no triangle uses: primitives often share one long vertex list, each with
 * its own part of it. False when memory is out. */
bool ppmi_gltf_compact(ppm_context *context, ppmi_gltf_geometry *geometry);

#endif
