/* Where photons are worth sending: the numbers of emission that led to photons which somebody saw.
 *
 * After Hachisuka and Jensen 2011, "Robust Adaptive Photon Tracing Using Photon Path Visibility":
 * the primary samples of a photon (choice of light, place, direction) are drawn more densely where
 * a pilot pass had photons that were gathered, and the power is divided by the density. Instead of
 * a Markov chain a histogram is learnt once: of the choice, and for each light of its two planes of
 * numbers. A share of all photons ignores it, so that no photon is worth much more than without. */
#ifndef PPMI_PHOTON_GUIDE_H
#define PPMI_PHOTON_GUIDE_H

#include <stdint.h>

#include "light/lights.h"

enum { PPMI_GUIDE_PICKS = 64, PPMI_GUIDE_SIDE = 16, PPMI_GUIDE_GROUPS = 16 };

/* The numbers that a photon is emitted by, each in [0, 1). */
typedef struct ppmi_emission_sample {
    double pick; /* of the light */
    float u[4];
} ppmi_emission_sample;

/* A piecewise constant density over the unit square, by cumulative sums. */
typedef struct ppmi_guide_plane {
    float rows[PPMI_GUIDE_SIDE + 1];
    float columns[PPMI_GUIDE_SIDE][PPMI_GUIDE_SIDE + 1]; /* of each row */
} ppmi_guide_plane;

typedef struct ppmi_photon_guide {
    float picks[PPMI_GUIDE_PICKS + 1];
    ppmi_guide_plane planes[PPMI_GUIDE_GROUPS]
                           [2]; /* u[0], u[1] and u[2], u[3] by group of lights */
} ppmi_photon_guide;

/* What a guide is learnt from: photons that were seen, by the bins of their samples. */
typedef struct ppmi_guide_counts {
    uint32_t picks[PPMI_GUIDE_PICKS];
    uint32_t planes[PPMI_GUIDE_GROUPS][2][PPMI_GUIDE_SIDE][PPMI_GUIDE_SIDE];
} ppmi_guide_counts;

/* Counts an even sample that led to a photon which was seen. */
void ppmi_guide_count(ppmi_guide_counts *counts, const ppmi_lights *lights,
                      const ppmi_emission_sample *sample);
void ppmi_guide_learn(ppmi_photon_guide *guide, const ppmi_guide_counts *counts);

/* Density of a sample, by that of even ones: at least PPMI_GUIDE_EVEN_SHARE. */
#define PPMI_GUIDE_EVEN_SHARE 0.3f
float ppmi_guide_density(const ppmi_photon_guide *guide, const ppmi_lights *lights,
                         const ppmi_emission_sample *sample);

/* Turns an even sample into one of the guide's density, which is returned. */
float ppmi_guide_warp(const ppmi_photon_guide *guide, const ppmi_lights *lights,
                      ppmi_emission_sample *sample);

#endif
