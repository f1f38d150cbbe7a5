/* The progressive estimate of one pixel or visible point: N, tau and the radius (Hachisuka, Ogaki,
 * Jensen 2008, section 4; for volumes with balls in place of disks).
 *
 * The radius is s footprints. With side p of the footprint and M photons within s p that bring
 * tauM:
 *
 *     N' = N + alpha M,  g = N' / (N + M),  tau' = (tau + tauM / p^d) g,  s' = s g^(1/d)
 *     L  = tau / (photons emitted * v s^d)
 *
 * with d = 2 and v = pi on surfaces, d = 3 and v = 4 pi / 3 in media. */
#ifndef PPMI_PHOTON_STATISTICS_H
#define PPMI_PHOTON_STATISTICS_H

#include "photon/gather.h"

typedef enum ppmi_dimension { PPMI_DISK = 2, PPMI_BALL = 3 } ppmi_dimension;

typedef struct ppmi_gather_statistics {
    ppmi_vec3 tau; /* flux by footprint area or volume */
    float count;   /* N */
    float scale;   /* s */
} ppmi_gather_statistics;

static inline ppmi_dimension ppmi_dimension_of(const ppmi_visible_point *point)
{
    return ppmi_bsdf_is_phase(&point->bsdf) ? PPMI_BALL : PPMI_DISK;
}

static inline float ppmi_power_of(float x, ppmi_dimension dimension)
{
    return dimension == PPMI_DISK ? x * x : x * x * x;
}

static inline float ppmi_root_of(float x, ppmi_dimension dimension)
{
    return dimension == PPMI_DISK ? sqrtf(x) : cbrtf(x);
}

/* Area or volume within a radius of s. */
static inline float ppmi_extent_of(float s, ppmi_dimension dimension)
{
    const float unit = dimension == PPMI_DISK ? PPMI_PI : 4.0f * PPMI_PI / 3.0f;
    return unit * ppmi_power_of(s, dimension);
}

/* tau: what the pass's photons bring by footprint area or volume, times the eye path's throughput;
 * count: of these photons. */
static inline void ppmi_statistics_update(ppmi_gather_statistics *statistics,
                                          ppmi_dimension dimension, float alpha, ppmi_vec3 tau,
                                          float count)
{
    if (!(count > 0.0f) || !vec3_is_finite(tau)) return;
    const float kept = statistics->count + alpha * count;
    const float g = kept / (statistics->count + count);
    statistics->tau = vec3_scale(vec3_add(statistics->tau, tau), g);
    statistics->count = kept;
    statistics->scale *= ppmi_root_of(g, dimension);
}

static inline ppmi_vec3 ppmi_statistics_radiance(const ppmi_gather_statistics *statistics,
                                                 ppmi_dimension dimension, double emitted)
{
    const double extent = (double)ppmi_extent_of(statistics->scale, dimension);
    return vec3_scale(statistics->tau, emitted > 0.0 ? (float)(1.0 / (emitted * extent)) : 0.0f);
}

#endif
