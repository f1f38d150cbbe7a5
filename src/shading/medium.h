/* Participating media: transmittance, distances to the next scattering, the phase function.
 *
 * Henyey and Greenstein 1941; distances and phase function are sampled as in Pharr, Jakob,
 * Humphreys, "Physically Based Rendering" (3rd ed.), 15.2. */
#ifndef PPMI_SHADING_MEDIUM_H
#define PPMI_SHADING_MEDIUM_H

#include "math/sampling.h"
#include "scene/scene.h"

static inline bool ppmi_medium_scatters(const ppmi_medium *medium)
{
    return !vec3_is_black(medium->sigma_s);
}

static inline bool ppmi_medium_is_empty(const ppmi_medium *medium)
{
    return vec3_is_black(medium->sigma_s) && vec3_is_black(medium->sigma_a);
}

/* exp(-(sigma_s + sigma_a) distance). */
ppmi_vec3 ppmi_medium_transmittance(const ppmi_medium *medium, float distance);

/* A distance drawn by the extinction of one channel, chosen evenly. */
typedef struct ppmi_medium_sample {
    bool is_scattered; /* before the end; else the light arrives there */
    float distance;
    ppmi_vec3 weight; /* transmittance by the density of the distance (by the probability of
                         arriving there), over all channels: the balance heuristic */
} ppmi_medium_sample;

/* length: of the way through a medium that scatters; may be infinite. u_channel, u in [0, 1). */
ppmi_medium_sample ppmi_medium_sample_distance(const ppmi_medium *medium, float length,
                                               float u_channel, float u);

/* The same for a distance that must lie before the end, for a path that goes both ways: weight is
 * transmittance by the density within length. False where nothing can scatter. */
bool ppmi_medium_sample_within(const ppmi_medium *medium, float length, float u_channel, float u,
                               float *out_distance, ppmi_vec3 *out_weight);

/* Phase function by the cosine between the direction of flight before and after: 1/sr, integrates
 * to 1. */
float ppmi_phase(float asymmetry_g, float cosine);

/* A direction around +z, the direction of flight, with the phase function as density. */
ppmi_vec3 ppmi_phase_sample(float asymmetry_g, float u, float v);

#endif
