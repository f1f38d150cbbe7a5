/* Tangents for normal maps, as the programs that bake such maps compute them: the tangent space of
 * M. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited" (2008), chapter 4 and appendix A, known
 * as MikkTSpace, which glTF 2.0 asks for in section 3.7.2.1. A map looks seamless only when it is
 * read in the frames in which it was made.
 *
 * In short: corners with the same position, normal and coordinates are one vertex. Around a vertex,
 * triangles that share an edge and whose coordinates turn the same way form a group. The tangent
 * of a group is the sum of its triangles' directions of growing u, in the plane of the normal, each
 * of unit length and weighted by the angle of its corner.
 *
 * Departures, on input for which no tangent is right: where more than two triangles share an edge
 * they are paired around each vertex, not in one list of edges; a triangle without area in the
 * coordinates may belong to groups of different turns at its corners; directions of a group that
 * are opposite to each other are summed. */
#ifndef PPMI_TANGENT_H
#define PPMI_TANGENT_H

#include <stdint.h>

#include "base/context.h"

/* All arrays are the caller's. Normals need not have unit length. */
typedef struct ppmi_tangent_mesh {
    const float *positions; /* 3 * vertex_count */
    const float *normals;   /* 3 * vertex_count */
    const float *uvs;       /* 2 * vertex_count */
    bool v_runs_down;       /* the bitangent is to point against growing v, as in glTF */
    uint32_t vertex_count;
    const uint32_t *indices; /* 3 * triangle_count, each below vertex_count */
    uint32_t triangle_count;
} ppmi_tangent_mesh;

/* A vertex whose triangles lie in several groups is split: the first vertex_count vertices of the
 * result are those of the mesh, further ones are copies. */
typedef struct ppmi_tangent_result {
    uint32_t vertex_count;
    float *tangents;   /* 4 * vertex_count: unit x y z, and w: bitangent = w * cross(normal, xyz);
                          zeros where no triangle has a direction */
    uint32_t *sources; /* vertex_count: the vertex of the mesh that it is a copy of */
    uint32_t *indices; /* 3 * triangle_count */
} ppmi_tangent_result;

/* Free the result with ppmi_tangent_result_deinit, also after a failure. Does not depend on the
 * number of threads. Returns OK or OUT_OF_MEMORY, unreported. */
ppm_status ppmi_tangent_compute(ppm_context *context, const ppmi_tangent_mesh *mesh,
                                ppmi_tangent_result *out);
/* Replaces *values, of width floats a vertex of the mesh, by those of the result's vertices; NULL
 * stays NULL. False when memory is out: they stay as they were. */
bool ppmi_tangent_spread(ppm_context *context, float **values, size_t width,
                         const ppmi_tangent_result *result);
void ppmi_tangent_result_deinit(ppm_context *context, ppmi_tangent_result *result);

#endif
