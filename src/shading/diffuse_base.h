/* The diffuse base of a BSDF: Lambert's, or rough. Used by bsdf.c and layers.c. */
#ifndef PPMI_SHADING_DIFFUSE_BASE_H
#define PPMI_SHADING_DIFFUSE_BASE_H

#include "shading/bsdf.h"
#include "shading/rough_diffuse.h"

/* pi f of a share of the base; color: what its facets reflect or, mirrored at the surface, let
 * through; wi on the upper side. */
static inline ppmi_vec3 ppmi_bsdf_diffuse(const ppmi_bsdf *bsdf, ppmi_vec3 share, ppmi_vec3 color,
                                          ppmi_vec3 wi)
{
    if (bsdf->diffuse_roughness == 0.0f) return share;
    return vec3_mul(share, ppmi_rough_diffuse_factor(bsdf->diffuse_roughness, color,
                                                     bsdf->diffuse_lost, bsdf->wo, wi));
}

/* Its albedo as it would be without what lies above. */
static inline ppmi_vec3 ppmi_bsdf_diffuse_albedo(const ppmi_bsdf *bsdf, ppmi_vec3 share,
                                                 ppmi_vec3 color)
{
    if (bsdf->diffuse_roughness == 0.0f) return share;
    return vec3_mul(share,
                    ppmi_rough_diffuse_albedo(bsdf->diffuse_roughness, color, bsdf->diffuse_lost));
}

#endif
