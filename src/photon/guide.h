/* Where photons are worth sending: the numbers of emission that led to photons which were gathered.
 *
 * After Hachisuka and Jensen 2011, "Robust Adaptive Photon Tracing Using Photon Path Visibility":
 * the primary samples of a photon (choice of part and light, place, direction) are drawn more
 * densely where pilot passes had photons that were gathered, and the power is divided by the
 * density. Instead of a Markov chain a tree is learnt: each inner node halves its cell of the
 * five-dimensional unit cube, leaves have a density each (as the trees of Müller, Gross, Novák
 * 2017, "Practical Path Guiding", in the space of the numbers). A share of all photons is spread
 * evenly, so that none is worth much more than without. */
#ifndef PPMI_PHOTON_GUIDE_H
#define PPMI_PHOTON_GUIDE_H

#include <stdint.h>

#include "base/context.h"

enum { PPMI_GUIDE_AXES = 5, PPMI_GUIDE_MAX_NODES = 8191 };

/* Least density. */
#define PPMI_GUIDE_EVEN_SHARE 0.2

/* The numbers that a photon is emitted by, each in [0, 1): x[0] chooses part and light. */
typedef struct ppmi_emission_sample {
    double x[PPMI_GUIDE_AXES];
} ppmi_emission_sample;

typedef struct ppmi_guide_node {
    double lower;      /* share of its lower half */
    uint16_t children; /* index of the lower half's node, the upper one's follows; 0: a leaf */
    uint16_t axis;
} ppmi_guide_node;

typedef struct ppmi_photon_guide {
    uint32_t count;
    ppmi_guide_node nodes[PPMI_GUIDE_MAX_NODES];
} ppmi_photon_guide;

/* A photon that was gathered. weight: what it brought, with the power that it had; volume: the part
 * of the numbers' cube that it stands for, by its density and the count of photons. */
typedef struct ppmi_guide_seen {
    ppmi_emission_sample sample;
    double weight, volume;
} ppmi_guide_seen;

/* Learns from count photons, which are put into another order; whole: the volume of the cube in the
 * photons' measure. The density of a cell is in proportion to what its photons bring for its size,
 * and more where few of them bring it. (By the mean square itself, which would make the variance
 * least, too few photons decide too much.) Returns OK, OUT_OF_MEMORY.
 */
ppm_status ppmi_guide_learn(ppm_context *context, ppmi_photon_guide *guide, ppmi_guide_seen *seen,
                            size_t count, double whole);

/* Density of a sample, by that of even ones: at least PPMI_GUIDE_EVEN_SHARE. */
double ppmi_guide_density(const ppmi_photon_guide *guide, const ppmi_emission_sample *sample);

/* Turns an even sample into one of the guide's density, which is returned. Numbers that are
 * stratified along an axis stay so. */
double ppmi_guide_warp(const ppmi_photon_guide *guide, ppmi_emission_sample *sample);

#endif
