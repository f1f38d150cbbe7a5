/* One primitive's arrays on their way to the scene. */
#ifndef PPMI_GLTF_GEOMETRY_H
#define PPMI_GLTF_GEOMETRY_H

#include "gltf/gltf_reader.h"

/* All arrays are owned until the scene has copied them. */
typedef struct ppmi_gltf_geometry {
    size_t vertex_count, triangle_count;
    int32_t kind;         /* PPM_PRIMITIVE_ */
    size_t element_count; /* points or segments, 0 for triangles */
    size_t index_count;   /* 0: nothing to draw */
    float *positions, *normals, *tangents, *colors;
    bool is_taken; /* the first three belong to what deforms the mesh */
    float *uvs[PPM_MAX_UV_SETS];
    uint32_t *indices;
    size_t source_count; /* vertices in the accessors, or the Draco stream */
    uint32_t *sources;   /* of each vertex: its place among these; NULL: the same */
    ppm_material_id material;
} ppmi_gltf_geometry;

/* In place of an index: a strip, fan or loop ends, and another one begins behind it. */
#define PPMI_GLTF_RESTART UINT32_MAX

/* How lists become elements. */
typedef struct ppmi_gltf_runs {
    int32_t mode;   /* PPMI_GLTF_POINTS .. */
    size_t most;    /* elements that a list without restarts has: with them it has no more */
    size_t corners; /* indices of an element, at most */
    /* Adds the elements of a part without restarts behind kept ones; returns how many there are. */
    size_t (*add)(int32_t mode, const uint32_t *indices, size_t count, uint32_t *out, size_t kept);
} ppmi_gltf_runs;

/* The elements of all parts between restarts, one after the other. *out_indices is the caller's;
 * NULL for none. Returns OK or OUT_OF_MEMORY, unreported. */
ppm_status ppmi_gltf_join_runs(ppm_context *context, const ppmi_gltf_runs *runs,
                               const uint32_t *indices, size_t count, uint32_t **out_indices,
                               size_t *out_elements);

/* The triangle list of count indices in a mode (PPMI_GLTF_TRIANGLES, _STRIP, _FAN). *out_indices is
 * the caller's; NULL for no triangle. Returns OK or OUT_OF_MEMORY, unreported. */
ppm_status ppmi_gltf_triangles(ppm_context *context, int32_t mode, const uint32_t *indices,
                               size_t count, uint32_t **out_indices, size_t *out_triangles);

/* The points or segments (pairs of indices) of count indices in a mode (PPMI_GLTF_POINTS to
 * _LINE_STRIP), in the same way. */
ppm_status ppmi_gltf_points_and_lines(ppm_context *context, int32_t mode, const uint32_t *indices,
                                      size_t count, uint32_t **out_indices, size_t *out_elements);

/* Points and lines have no size in glTF. This share of the diagonal of their mesh's box is the
 * radius that they get; a mesh that is one point has no diagonal, and gets a millimetre. */
#define PPMI_GLTF_RADIUS_SHARE 0.002f
#define PPMI_GLTF_RADIUS_OF_A_POINT_M 0.001f

/* That radius, from the vertices of all primitives of a mesh. */
float ppmi_gltf_line_radius(const ppmi_gltf_geometry *primitives, size_t count);

/* The set of coordinates that the material's tangents belong to; -1 where it needs none. */
int32_t ppmi_gltf_tangent_set(const ppmi_gltf_reader *reader, int32_t material);

/* Computes tangents for triangles that have normals, coordinates and no tangents, where a material
 * (its number in the file) has a normal map. Vertices may be added. */
ppm_status ppmi_gltf_add_tangents(ppmi_gltf_reader *reader, int32_t material, const char *place,
                                  ppmi_gltf_geometry *geometry);

/* Drops the vertices that no element uses: primitives often share one long vertex list, each with
 * its own part of it. False when memory is out. */
bool ppmi_gltf_compact(ppm_context *context, ppmi_gltf_geometry *geometry);

#endif
