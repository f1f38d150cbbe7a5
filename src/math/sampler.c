/* Hash-scrambled Sobol' points: Burley 2020, "Practical Hash-based Owen Scrambling". */
#include "math/sampler.h"

#include "math/sobol_table.h"

static inline uint32_t reverse_bits(uint32_t x)
{
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}

/* Owen scrambling of reversed bits: each bit is flipped by a hash of the bits below it only.
 * Form: Laine and Karras 2011; constants: Vegdahl 2021, "Building a Better LK Hash". */
static inline uint32_t scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

static inline uint32_t owen_scramble(uint32_t x, uint32_t seed)
{
    return reverse_bits(scramble_reversed(reverse_bits(x), seed));
}

ppmi_sample4 ppmi_sobol4(uint32_t index, uint32_t set, uint64_t seed)
{
    const uint64_t key = ppmi_hash64(seed ^ ((uint64_t)(set + 1) << 32));
    const uint64_t keys_a = ppmi_hash64(key + 1), keys_b = ppmi_hash64(key + 2);
    const uint32_t shuffled = owen_scramble(index, (uint32_t)key);
    uint32_t x[4] = {0, 0, 0, 0};
    for (uint32_t n = 0; n < 8; n++) {
        const uint32_t *entry = sobol_table[n][(shuffled >> (4 * n)) & 15u];
        for (int d = 0; d < 4; d++)
            x[d] ^= entry[d];
    }
    return (ppmi_sample4){{
        owen_scramble(x[0], (uint32_t)keys_a),
        owen_scramble(x[1], (uint32_t)(keys_a >> 32)),
        owen_scramble(x[2], (uint32_t)keys_b),
        owen_scramble(x[3], (uint32_t)(keys_b >> 32)),
    }};
}

double ppmi_sobol1(uint32_t index, uint32_t set, uint64_t seed)
{
    const uint64_t key = ppmi_hash64(seed ^ ((uint64_t)(set + 1) << 32) ^ 0x5851f42d4c957f2du);
    return (double)reverse_bits(scramble_reversed(index, (uint32_t)key)) * 0x1p-32;
}
