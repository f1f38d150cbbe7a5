/* Visible points: where eye paths end and photons are gathered ("hit points" of Hachisuka, Ogaki,
 * Jensen 2008). */
#ifndef PPMI_PHOTON_POINT_H
#define PPMI_PHOTON_POINT_H

#include "shading/bsdf.h"

typedef struct ppmi_visible_point {
    ppmi_vec3 position;
    float footprint;      /* side of the pixel's footprint there, metres */
    ppmi_vec3 throughput; /* of the eye path up to the point */
    uint32_t owner;       /* whose it is: a pixel of a tile or of the film */
    int32_t eye_class;    /* of the eye path's first vertex, where there is a sink for layers of
                             light: PPM_LAYER_, 0 if it is this one */
    ppmi_bsdf bsdf;       /* of a surface, or a medium's phase function */
} ppmi_visible_point;

/* A list that grows by doubling and keeps its memory. */
typedef struct ppmi_visible_points {
    ppmi_visible_point *points;
    size_t count, capacity;
} ppmi_visible_points;

/* False when memory is out; the point is then dropped. */
bool ppmi_visible_points_push(ppm_context *context, ppmi_visible_points *list,
                              const ppmi_visible_point *point);
bool ppmi_visible_points_reserve(ppm_context *context, ppmi_visible_points *list, size_t capacity);
void ppmi_visible_points_deinit(ppm_context *context, ppmi_visible_points *list);

#endif
