/* UASTC LDR 4x4 blocks; see the header. What the numbers in a block stand for is as in ASTC
 * (Khronos Data Format 1.3, chapter 23); there are no blue contraction and no grids of fewer
 * weights. Colours are interpolated as ASTC does those that are not sRGB, whatever the file says,
 * because that is what the transcoder of Basis Universal does when it decodes to bytes. */
#include "gltf/basis_uastc.h"

#include <stdbool.h>
#include <string.h>

enum { BLOCK = 16, TEXELS = 16, MODES = 19, SOLID = 8, MERGED = 7, ALPHA = 3 };
enum { MOST_VALUES = 18, PATTERNS_2 = 30, PATTERNS_MERGED = 19, PATTERNS_3 = 11 };

/* A row of the table of modes. An endpoint's value has digit * 2^bits + the rest, of so many
 * digits: 3 and 5 are a trit and a quint, 1 is none. */
typedef struct mode {
    uint8_t code, code_bits; /* how a block begins, the first bit as the lowest */
    uint8_t hint_bits;       /* for transcoding to formats of graphics cards: skipped */
    uint8_t channels;        /* of endpoints; 2: luminance and alpha */
    uint8_t subsets, planes; /* of two planes, one channel has weights of its own */
    uint8_t digits, value_bits;
    uint8_t weight_bits;
} mode;

static const mode modes[MODES] = {
    {0x01, 4, 15, 3, 1, 1, 3, 6, 4}, {0x35, 6, 15, 3, 1, 1, 1, 8, 2},
    {0x1d, 5, 15, 3, 2, 1, 1, 4, 3}, {0x03, 5, 15, 3, 3, 1, 3, 2, 2},
    {0x13, 5, 15, 3, 2, 1, 5, 3, 2}, {0x0b, 5, 15, 3, 1, 1, 1, 8, 3},
    {0x1b, 5, 15, 3, 1, 2, 5, 5, 2}, {0x07, 5, 15, 3, 2, 1, 5, 3, 2},
    {0x17, 5, 0, 4, 1, 1, 1, 8, 0},  {0x0f, 5, 23, 4, 2, 1, 1, 4, 2},
    {0x02, 3, 17, 4, 1, 1, 3, 4, 4}, {0x00, 2, 17, 4, 1, 2, 3, 4, 2},
    {0x06, 3, 17, 4, 1, 1, 3, 6, 3}, {0x1f, 5, 23, 4, 1, 2, 1, 8, 1},
    {0x0d, 5, 23, 4, 1, 1, 1, 8, 2}, {0x05, 7, 23, 2, 1, 1, 1, 8, 4},
    {0x15, 6, 23, 2, 2, 1, 1, 8, 2}, {0x25, 6, 23, 2, 1, 2, 1, 8, 2},
    {0x09, 4, 15, 3, 1, 1, 1, 5, 5},
};

/* The subset of each texel, two bits each from the lowest on: those of ASTC's partitions that BC7
 * has too, and in PATTERNS_MERGED once two subsets of BC7's three are taken together. ASTC's
 * function of partitions gives them from the seeds beside them. */
static const uint32_t patterns_2[PATTERNS_2] = {
    0x50505050, 0x40404040, 0x01010101, 0x54505040, /* 28, 20, 16, 29 */
    0x05151555, 0x55545450, 0x00010515, 0x01051555, /* 91, 9, 107, 72 */
    0x50400000, 0x00000105, 0x55544000, 0x01155555, /* 149, 204, 50, 114 */
    0x00000115, 0x00005555, 0x55555500, 0x00555555, /* 496, 17, 78, 39 */
    0x55551501, 0x40545555, 0x00405054, 0x00004050, /* 252, 828, 43, 156 */
    0x15050100, 0x50545555, 0x15050501, 0x00404050, /* 116, 210, 476, 273 */
    0x50545455, 0x14141414, 0x55000055, 0x11111111, /* 684, 359, 246, 195 */
    0x00550055, 0x05145041,                         /* 694, 524 */
};
static const uint32_t patterns_merged[PATTERNS_MERGED] = {
    0x00005500, 0x10101010, 0x00010505, 0x50504000, /* 36, 48, 61, 137 */
    0x55005555, 0x04040404, 0x55555040, 0x50505054, /* 161, 183, 226, 281 */
    0x05500005, 0x00005454, 0x15150000, 0x05000005, /* 302, 307, 479, 495 */
    0x00005054, 0x55554000, 0x14555555, 0x01050505, /* 593, 594, 605, 799 */
    0x01015555, 0x01051450, 0x00005455,             /* 812, 988, 993 */
};
static const uint32_t patterns_3[PATTERNS_3] = {
    0xa5a50000, 0xaa005555, 0xaa000055, 0x0000aa55, /* 260, 74, 32, 156 */
    0x25252525, 0x94949494, 0x58585858, 0x56560202, /* 183, 15, 745, 0 */
    0x92929292, 0x55aa0055, 0xa05050a0,             /* 335, 902, 254 */
};

/* The rest of a block, the next bit as the lowest. */
typedef struct block_bits {
    uint64_t low, high;
} block_bits;

static block_bits load(const unsigned char *block)
{
    block_bits out = {0, 0};
    for (int i = 0; i < 8; ++i) {
        out.low |= (uint64_t)block[i] << (8 * i);
        out.high |= (uint64_t)block[8 + i] << (8 * i);
    }
    return out;
}

/* At most 32 bits; past the end come zeros. */
static uint32_t take(block_bits *bits, uint32_t count)
{
    if (count == 0) return 0;
    const uint32_t value = (uint32_t)(bits->low & ((UINT64_C(1) << count) - 1));
    bits->low = bits->low >> count | bits->high << (64 - count);
    bits->high >>= count;
    return value;
}

/* ---- endpoints ------------------------------------------------------------------------------- */

/* Trits or quints: five or three together in as few bits as they need. */
static void read_digits(block_bits *bits, uint32_t digits, uint32_t count, uint8_t *out)
{
    static const uint8_t trit_bits[] = {0, 2, 4, 5, 7, 8}, quint_bits[] = {0, 3, 5, 7};
    const uint32_t group = digits == 3 ? 5 : 3;
    for (uint32_t i = 0; i < count; i += group) {
        const uint32_t n = count - i < group ? count - i : group;
        uint32_t packed = take(bits, digits == 3 ? trit_bits[n] : quint_bits[n]);
        for (uint32_t k = 0; k < n; ++k, packed /= digits)
            out[i + k] = (uint8_t)(packed % digits);
    }
}

/* ASTC's rule for trits and quints: D * C + B, mirrored by the lowest bit. */
static uint8_t mirror(uint32_t sum, uint32_t value)
{
    const uint32_t a = value & 1 ? 511 : 0, t = sum ^ a;
    return (uint8_t)((a & 0x80) | t >> 2);
}

/* The byte that a value stands for; the constants are those of ASTC's table of endpoints. */
static uint8_t unquantize(uint32_t digits, uint32_t bits, uint32_t digit, uint32_t value)
{
    const uint32_t x = value >> 1;
    switch (digits << bits) { /* how many values there are */
    case 12:
        return mirror(digit * 93 + (x << 8 | x << 4 | x << 2 | x << 1), value);
    case 16:
        return (uint8_t)(value << 4 | value);
    case 32:
        return (uint8_t)(value << 3 | value >> 2);
    case 40:
        return mirror(digit * 26 + (x << 7 | x << 1 | x >> 1), value);
    case 48:
        return mirror(digit * 22 + (x << 6 | x), value);
    case 160:
        return mirror(digit * 6 + (x << 5 | x >> 3), value);
    case 192:
        return mirror(digit * 5 + (x << 4 | x >> 4), value);
    default: /* 256 */
        return (uint8_t)value;
    }
}

/* The two ends of each subset. */
static void read_endpoints(block_bits *bits, const mode *m, uint8_t out[3][2][4])
{
    uint8_t digits[MOST_VALUES] = {0}, values[MOST_VALUES];
    const uint32_t count = 2u * m->channels * m->subsets;
    if (m->digits > 1) read_digits(bits, m->digits, count, digits);
    for (uint32_t i = 0; i < count; ++i)
        values[i] = unquantize(m->digits, m->value_bits, digits[i], take(bits, m->value_bits));
    for (uint32_t i = 0; i < 2u * m->subsets; ++i) {
        const uint8_t *v = values + (size_t)(i / 2) * 2 * m->channels + i % 2;
        uint8_t *end = out[i / 2][i % 2];
        for (uint32_t c = 0; c < ALPHA; ++c)
            end[c] = m->channels == 2 ? v[0] : v[(size_t)2 * c];
        end[ALPHA] = m->channels == 3 ? 255 : v[(size_t)2 * (m->channels - 1u)];
    }
}

/* ---- texels ---------------------------------------------------------------------------------- */

/* From 0 to 64: the bits repeated to six of them, with a step left out in the middle. */
static uint32_t unquantize_weight(uint32_t value, uint32_t bits)
{
    static const uint8_t repeat[] = {0, 63, 21, 9};
    const uint32_t six = bits <= 3   ? value * repeat[bits]
                         : bits == 4 ? value << 2 | value >> 2
                                     : value << 1 | value >> 4;
    return six > 32 ? six + 1 : six;
}

static uint8_t interpolate(uint32_t from, uint32_t to, uint32_t weight)
{
    return (uint8_t)((257 * from * (64 - weight) + 257 * to * weight + 32) >> 14);
}

/* Weights, a texel's of both planes beside each other. A subset's first one has a bit less: it is
 * of the lower half. */
static void read_texels(block_bits *bits, const mode *m, uint32_t pattern, uint32_t second_channel,
                        const uint8_t ends[3][2][4], uint8_t out[TEXELS][4])
{
    uint32_t seen = 0;
    for (uint32_t i = 0; i < TEXELS; ++i) {
        const uint32_t subset = pattern >> (2 * i) & 3;
        const uint32_t is_first = ~seen >> subset & 1;
        uint32_t weights[2] = {0, 0};
        for (uint32_t p = 0; p < m->planes; ++p)
            weights[p] = unquantize_weight(take(bits, m->weight_bits - is_first), m->weight_bits);
        for (uint32_t c = 0; c < 4; ++c) {
            const uint32_t weight = weights[m->planes == 2 && c == second_channel];
            out[i][c] = interpolate(ends[subset][0][c], ends[subset][1][c], weight);
        }
        seen |= 1u << subset;
    }
}

/* ---- blocks ---------------------------------------------------------------------------------- */

static const mode *find_mode(block_bits *bits)
{
    for (int i = 0; i < MODES; ++i) {
        if ((bits->low & ((1u << modes[i].code_bits) - 1)) != modes[i].code) continue;
        take(bits, modes[i].code_bits);
        return &modes[i];
    }
    return NULL;
}

/* False where the number of the pattern is none. */
static bool read_pattern(block_bits *bits, const mode *m, uint32_t *out)
{
    *out = 0;
    if (m->subsets == 1) return true;
    const uint32_t at = take(bits, m->subsets == 3 ? 4 : 5);
    const bool is_merged = m == &modes[MERGED];
    const uint32_t count = m->subsets == 3 ? PATTERNS_3 : is_merged ? PATTERNS_MERGED : PATTERNS_2;
    const uint32_t *patterns = m->subsets == 3 ? patterns_3
                               : is_merged     ? patterns_merged
                                               : patterns_2;
    if (at >= count) return false;
    *out = patterns[at];
    return true;
}

static void fill(block_bits *bits, uint8_t out[TEXELS][4])
{
    for (int c = 0; c < 4; ++c)
        out[0][c] = (uint8_t)take(bits, 8);
    for (int i = 1; i < TEXELS; ++i)
        memcpy(out[i], out[0], 4);
}

/* Returns what is wrong, or NULL. */
static const char *decode_block(const unsigned char *block, uint8_t out[TEXELS][4])
{
    block_bits bits = load(block);
    uint8_t ends[3][2][4] = {0};
    uint32_t pattern, second_channel = ALPHA;
    const mode *m = find_mode(&bits);
    if (!m) return "a block of its UASTC is of no mode";
    if (m == &modes[SOLID]) {
        fill(&bits, out);
        return NULL;
    }
    take(&bits, m->hint_bits);
    if (m->planes == 2 && m->channels > 2) second_channel = take(&bits, 2);
    if (!read_pattern(&bits, m, &pattern)) return "a block of its UASTC is of no pattern";
    read_endpoints(&bits, m, ends);
    read_texels(&bits, m, pattern, second_channel, ends, out);
    return NULL;
}

ppm_status ppmi_basis_decode_uastc(const unsigned char *blocks, uint32_t width, uint32_t height,
                                   uint8_t *out, const char **reason)
{
    uint8_t texels[TEXELS][4];
    for (uint32_t top = 0; top < height; top += 4) {
        for (uint32_t left = 0; left < width; left += 4, blocks += BLOCK) {
            *reason = decode_block(blocks, texels);
            if (*reason) return PPM_STATUS_INPUT_INVALID;
            const uint32_t count = width - left < 4 ? width - left : 4;
            for (uint32_t y = 0; y < 4 && top + y < height; ++y)
                memcpy(out + 4 * ((size_t)(top + y) * width + left), texels[(size_t)4 * y],
                       (size_t)4 * count);
        }
    }
    return PPM_STATUS_OK;
}
