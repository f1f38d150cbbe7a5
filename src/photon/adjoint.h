/* Scattering of photons where normals lean over: by normal maps, or on coarse smooth meshes.
 *
 * Radiance is scattered by the shading normal's cosine, and by a BSDF that is made for the
 * direction of the eye (its normal is bent until the eye sees it). Photons arrive and leave by the
 * geometric cosine, and their BSDF is made for where they came from. They are made to do exactly
 * the same by drawing a direction first and asking then what an eye that looks from there would see
 * (Veach 1997, section 5.3.2; equation 5.19 is this for normals that are not bent). */
#ifndef PPMI_PHOTON_ADJOINT_H
#define PPMI_PHOTON_ADJOINT_H

#include "transport/world.h"

/* Factor of light that arrives by the cosine to the geometric normal and counts by that to the
 * shading normal: their ratio. For light that grazes the surface the reciprocal c^-1 is not
 * bounded, and its variance is infinite. Below 0.05 a straight line takes its place, (4 - 3 c /
 * 0.05) / 0.05, which joins it and keeps the sum over all c: light that is even there, as far as 3
 * degrees up from the surface, is neither lost nor made; a lamp's there is within a third of what
 * it is above 0.6 degrees. */
static inline float ppmi_adjoint_arrival(float shading_cosine, float geometric_cosine)
{
    const float least = 0.05f, c = fabsf(geometric_cosine);
    const float reciprocal = c >= least ? 1.0f / c : (4.0f - 3.0f * c / least) / least;
    return fabsf(shading_cosine) * reciprocal;
}

/* Whether it makes a difference: at a surface whose normals are not the same. */
static inline bool ppmi_adjoint_leans(const ppmi_bsdf *bsdf)
{
    return !ppmi_bsdf_is_phase(bsdf) && vec3_dot(bsdf->frame.n, bsdf->ng) < 1.0f - 1e-6f;
}

/* How many photons one that came from wi should go on as, each with its share of the power: few
 * photons meet a triangle that they graze, and stand there for all that the shading normal sees. */
uint32_t ppmi_adjoint_split(const ppmi_bsdf *bsdf, ppmi_vec3 wi);

/* Draws where a photon goes that came from wi to a vertex that leans; bsdf is made for wi.
 * out_sample->weight is the factor of its power. False where it ends. */
bool ppmi_adjoint_draw(ppmi_walker *walker, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                       ppmi_vec3 wi, ppmi_bsdf_sample *out_sample);

#endif
