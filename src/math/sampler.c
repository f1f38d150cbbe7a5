/* Hash-scrambled Sobol' points: Burley 2020, "Practical Hash-based Owen Scrambling", with the
 * direction numbers of Joe and Kuo 2008 for dimensions 2 to 4 (dimension 1 is bit reversal). */
#include "math/sampler.h"

static const uint32_t sobol_directions[3][32] = {
    {0x80000000u, 0xc0000000u, 0xa0000000u, 0xf0000000u, 0x88000000u, 0xcc000000u, 0xaa000000u,
     0xff000000u, 0x80800000u, 0xc0c00000u, 0xa0a00000u, 0xf0f00000u, 0x88880000u, 0xcccc0000u,
     0xaaaa0000u, 0xffff0000u, 0x80008000u, 0xc000c000u, 0xa000a000u, 0xf000f000u, 0x88008800u,
     0xcc00cc00u, 0xaa00aa00u, 0xff00ff00u, 0x80808080u, 0xc0c0c0c0u, 0xa0a0a0a0u, 0xf0f0f0f0u,
     0x88888888u, 0xccccccccu, 0xaaaaaaaau, 0xffffffffu},
    {0x80000000u, 0xc0000000u, 0x60000000u, 0x90000000u, 0xe8000000u, 0x5c000000u, 0x8e000000u,
     0xc5000000u, 0x68800000u, 0x9cc00000u, 0xee600000u, 0x55900000u, 0x80680000u, 0xc09c0000u,
     0x60ee0000u, 0x90550000u, 0xe8808000u, 0x5cc0c000u, 0x8e606000u, 0xc5909000u, 0x6868e800u,
     0x9c9c5c00u, 0xeeee8e00u, 0x5555c500u, 0x8000e880u, 0xc0005cc0u, 0x60008e60u, 0x9000c590u,
     0xe8006868u, 0x5c009c9cu, 0x8e00eeeeu, 0xc5005555u},
    {0x80000000u, 0xc0000000u, 0x20000000u, 0x50000000u, 0xf8000000u, 0x74000000u, 0xa2000000u,
     0x93000000u, 0xd8800000u, 0x25400000u, 0x59e00000u, 0xe6d00000u, 0x78080000u, 0xb40c0000u,
     0x82020000u, 0xc3050000u, 0x208f8000u, 0x51474000u, 0xfbea2000u, 0x75d93000u, 0xa0858800u,
     0x914e5400u, 0xdbe79e00u, 0x25db6d00u, 0x58800080u, 0xe54000c0u, 0x79e00020u, 0xb6d00050u,
     0x800800f8u, 0xc00c0074u, 0x200200a2u, 0x50050093u},
};

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
    uint32_t x1 = 0, x2 = 0, x3 = 0;
    for (uint32_t bit = 0; bit < 32; bit++) {
        const uint32_t mask = 0u - ((shuffled >> bit) & 1u);
        x1 ^= sobol_directions[0][bit] & mask;
        x2 ^= sobol_directions[1][bit] & mask;
        x3 ^= sobol_directions[2][bit] & mask;
    }
    /* dimension 1 is the index reversed, so its reversal for the scrambling is the index itself */
    const uint32_t x0 = reverse_bits(scramble_reversed(shuffled, (uint32_t)keys_a));
    return (ppmi_sample4){{
        x0,
        owen_scramble(x1, (uint32_t)(keys_a >> 32)),
        owen_scramble(x2, (uint32_t)keys_b),
        owen_scramble(x3, (uint32_t)(keys_b >> 32)),
    }};
}

double ppmi_sobol1(uint32_t index, uint32_t set, uint64_t seed)
{
    const uint64_t key = ppmi_hash64(seed ^ ((uint64_t)(set + 1) << 32) ^ 0x5851f42d4c957f2du);
    return (double)reverse_bits(scramble_reversed(index, (uint32_t)key)) * 0x1p-32;
}
