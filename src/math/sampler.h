/* Random numbers as a function of (seed, stream, index): a path draws the same numbers on whatever
 * thread it runs.
 *
 * The first numbers of a path come from an Owen-scrambled Sobol' sequence over the index (Burley
 * 2020, "Practical Hash-based Owen Scrambling", JCGT), so that paths of one stream stratify each
 * other; what follows is PCG (O'Neill 2014), keyed by the same triple. */
#ifndef PPMI_MATH_SAMPLER_H
#define PPMI_MATH_SAMPLER_H

#include <stdint.h>

enum { PPMI_STREAM_EYE = 1, PPMI_STREAM_PHOTON = 2 };

/* Four consecutive dimensions of the sequence, as 32-bit fractions. */
typedef struct ppmi_sample4 {
    uint32_t bits[4];
} ppmi_sample4;

/* 64-bit finaliser of MurmurHash3 with Stafford's constants (mix 13). */
static inline uint64_t ppmi_hash64(uint64_t x)
{
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9u;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/* 24 bits of x as a float in [0, 1). */
static inline float ppmi_unit_float(uint32_t x)
{
    return (float)(x >> 8) * 0x1p-24f;
}

/* Four scrambled Sobol' dimensions of point index; set chooses an independent scrambling, so that
 * sets may be used side by side (padding). */
ppmi_sample4 ppmi_sobol4(uint32_t index, uint32_t set, uint64_t seed);

/* A scrambled van der Corput point: one more stratified dimension, cheap, in 32 bits. */
double ppmi_sobol1(uint32_t index, uint32_t set, uint64_t seed);

/* A stream of independent numbers. */
typedef struct ppmi_rng {
    uint64_t state;
} ppmi_rng;

/* index is 64-bit: a whole render may draw more than 2^32 paths. */
static inline ppmi_rng ppmi_rng_start(uint64_t seed, uint32_t stream, uint64_t index)
{
    return (ppmi_rng){ppmi_hash64(index ^ ppmi_hash64(seed + 0x9e3779b97f4a7c15u * stream))};
}

static inline uint32_t ppmi_rng_u32(ppmi_rng *rng)
{
    const uint64_t old = rng->state;
    rng->state = old * 6364136223846793005u + 1442695040888963407u;
    const uint32_t xorshifted = (uint32_t)(((old >> 18) ^ old) >> 27);
    const uint32_t rotation = (uint32_t)(old >> 59);
    return (xorshifted >> rotation) | (xorshifted << ((0u - rotation) & 31u));
}

static inline float ppmi_rng_float(ppmi_rng *rng)
{
    return ppmi_unit_float(ppmi_rng_u32(rng));
}

/* 32 bits in [0, 1): for choices among many. */
static inline double ppmi_rng_double(ppmi_rng *rng)
{
    return (double)ppmi_rng_u32(rng) * 0x1p-32;
}

#endif
