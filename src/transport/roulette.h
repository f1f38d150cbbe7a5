/* Russian roulette by length: how paths end that nothing absorbs.
 *
 * Roulette by throughput ends paths as surfaces absorb; where nothing does (a closed white room,
 * mirrors face to face) it never ends any. From PPMI_ROULETTE_OF_ vertices on a path
 * therefore survives vertex d with a chance of at most 1 - 1 / d. The product of these chances
 * telescopes: a path that nothing absorbs gets to vertex d with a chance of about first / d, and
 * its weight grows in line with d, not exponentially as under any fixed chance below 1. Its
 * expected length up to a bound D is first (1 + ln(D / first)): 187 vertices of 4096 with first
 * = 32. Where the albedo is a, the limit does nothing from d = 1 / (1 - a) on. */
#ifndef PPMI_TRANSPORT_ROULETTE_H
#define PPMI_TRANSPORT_ROULETTE_H

#include <stdint.h>

/* Vertices before the limit. Photons are kept at each, and cost memory. */
enum { PPMI_ROULETTE_OF_EYE = 32, PPMI_ROULETTE_OF_PHOTONS = 16 };

/* The chance to go on at vertex number depth, counted from 0, of a path that is to survive by its
 * throughput with the chance kept (from 1 on: for sure). */
static inline float ppmi_roulette_survival(float kept, uint32_t depth, uint32_t first)
{
    const float most = depth < first ? 1.0f : 1.0f - 1.0f / (float)(depth + 1);
    return most < kept ? most : kept;
}

#endif
