/* Visible points and the gathering of photons around them. */
#ifndef PPMI_PHOTON_GATHER_H
#define PPMI_PHOTON_GATHER_H

#include "photon/grid.h"
#include "shading/bsdf.h"

/* Where eye paths ended on a surface that gathers: structure of arrays, one slot a pixel of a
 * tile. */
typedef struct ppmi_visible_points {
    uint32_t capacity;
    uint8_t *is_valid;
    float *x, *y, *z;
    float *footprint;      /* side of the pixel's footprint there, metres */
    ppmi_vec3 *throughput; /* of the eye path up to the point */
    ppmi_bsdf *bsdf;
} ppmi_visible_points;

ppm_status ppmi_visible_points_init(ppm_context *context, ppmi_visible_points *points,
                                    uint32_t capacity);
void ppmi_visible_points_deinit(ppm_context *context, ppmi_visible_points *points);

/* What photons bring to one visible point. */
typedef struct ppmi_gathered {
    ppmi_vec3 flux; /* sum of f * power * kernel, unnormalised; throughput is not in it */
    float count;    /* photons that contributed */
} ppmi_gathered;

/* Gathers at slot i within radius (metres). A photon counts only if it lies near the tangent
 * plane, on a surface that faces the same way, and the BSDF lets some of it through: what brings
 * nothing must not shrink the radius (mitsuba-renderer/mitsuba#145). */
ppmi_gathered ppmi_gather(const ppmi_photon_grid *grid, const ppmi_albedo_table *albedo,
                          const ppmi_visible_points *points, uint32_t i, float radius);

#endif
