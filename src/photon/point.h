/* Visible points: where eye paths end and photons are gathered ("hit points" of Hachisuka, Ogaki,
 * Jensen 2008). */
#ifndef PPMI_PHOTON_POINT_H
#define PPMI_PHOTON_POINT_H

#include "shading/bsdf.h"

/* Lobes that are too narrow to leave them to photons, and that photons help with. */
static inline uint32_t ppmi_narrow_lobes(const ppmi_bsdf *bsdf)
{
    return bsdf->lobes & ~(uint32_t)(bsdf->gather_lobes | bsdf->delta_lobes);
}

/* How likely photons are to bring light from wi over the narrow lobes to a disk, for a crowding of
 * 1, by how likely a path is to go there that goes on by them: the density of merging by that of
 * sampling (Georgiev, Krivanek, Davidovic, Slusallek 2012, "Light Transport Simulation with Vertex
 * Connection and Merging", section 4). What lies beyond, mirrors and smooth glass, is the same for
 * both, and the extent of a beam stays the same through it. narrow: mask; 0 where the path cannot
 * go there. */
static inline float ppmi_merging(const ppmi_bsdf *bsdf, uint32_t narrow, float merge_area_m2,
                                 ppmi_vec3 wi)
{
    const float pdf = ppmi_bsdf_pdf(bsdf, wi, narrow) * ppmi_bsdf_probability(bsdf, narrow);
    return pdf > 0.0f ? merge_area_m2 * fabsf(vec3_dot(wi, bsdf->ng)) / pdf : 0.0f;
}

typedef struct ppmi_visible_point {
    ppmi_vec3 position;
    float footprint;      /* side of the pixel's footprint there, metres */
    ppmi_vec3 throughput; /* of the eye path up to the point */
    uint32_t owner;       /* whose it is: a pixel of a tile or of the film */
    int32_t eye_class;    /* of the eye path's first vertex, where there is a sink for layers of
                             light: PPM_LAYER_, 0 if it is this one */
    float merge_area_m2;  /* 0 where all photons count. Where the path goes on by the lobes that
                             gather here (narrow ones), only those count that came over mirrors
                             and smooth glass, by a share: photons of a pass by the disk's area */
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
