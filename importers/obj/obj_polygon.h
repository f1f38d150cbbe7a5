/* Polygons to triangles. */
#ifndef PPMI_OBJ_POLYGON_H
#define PPMI_OBJ_POLYGON_H

#include "base/context.h"
#include "obj/obj_shim.h"

/* Scratch memory for polygons of any size; zeroed is empty. */
typedef struct ppmi_obj_polygon_workspace {
    double *xy;            /* 2 per corner, in the polygon's plane */
    uint32_t *next, *prev; /* the ring of what is left */
    size_t capacity;
    uint64_t tests;  /* points tested against triangles so far */
    uint64_t forced; /* polygons for which no proper triangulation was found */
} ppmi_obj_polygon_workspace;

void ppmi_obj_polygon_deinit(ppm_context *context, ppmi_obj_polygon_workspace *workspace);

/* Splits a polygon of count >= 3 corners into count - 2 triangles that keep its winding: 3 *
 * (count - 2) corner numbers in out. normal is the polygon's, of any length (Newell's method).
 * False when memory is out. */
bool ppmi_obj_triangulate(ppm_context *context, ppmi_obj_polygon_workspace *workspace,
                          const float *positions, const ppmi_obj_corner *corners, uint32_t count,
                          const double normal[3], uint32_t *out);

#endif
