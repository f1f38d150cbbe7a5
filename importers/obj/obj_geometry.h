/* The arrays of one primitive while it is made. */
#ifndef PPMI_OBJ_GEOMETRY_H
#define PPMI_OBJ_GEOMETRY_H

#include "obj/obj_reader.h"

typedef struct ppmi_obj_geometry {
    int32_t kind;              /* PPM_PRIMITIVE_ */
    ppmi_obj_triples vertices; /* position, uv, normal */
    size_t vertex_count;
    uint32_t *indices;
    size_t element_count;                                 /* triangles, points or segments */
    bool has_uvs, has_normals;                            /* of some corner */
    bool lacks_normals;                                   /* of some corner */
    float *positions, *normals, *tangents, *uvs, *colors; /* NULL: none */
} ppmi_obj_geometry;

/* obj_tangent.c: tangents for triangles with normals and texture coordinates. Vertices may be
 * split. False when memory is out. */
bool ppmi_obj_add_tangents(ppm_context *context, ppmi_obj_geometry *geometry);

#endif
