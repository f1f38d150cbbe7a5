/* Bits and Huffman codes of BasisLZ; see the header. */
#include "gltf/basis_huffman.h"

#include <string.h>

enum { LENGTH_CODES = 21 };

uint32_t ppmi_basis_get(ppmi_basis_bits *bits, uint32_t count)
{
    uint32_t value = 0;
    for (uint32_t i = 0; i < count; ++i, ++bits->at) {
        const size_t byte = bits->at / 8;
        if (byte >= bits->count) {
            bits->is_over = true;
            return value;
        }
        value |= (uint32_t)(bits->bytes[byte] >> bits->at % 8 & 1) << i;
    }
    return value;
}

/* The code of these lengths, 0 for symbols that it has not; false where they take more than there
 * is (Kraft's inequality). */
static bool build(const uint8_t *lengths, uint32_t count, ppmi_basis_code *out)
{
    uint32_t next[PPMI_BASIS_LONGEST + 2] = {0};
    int32_t left = 1;
    memset(out->counts, 0, sizeof out->counts);
    for (uint32_t i = 0; i < count; ++i)
        ++out->counts[lengths[i]];
    out->counts[0] = 0;
    for (uint32_t length = 1; length <= PPMI_BASIS_LONGEST; ++length) {
        left = 2 * left - out->counts[length];
        if (left < 0) return false;
        next[length + 1] = next[length] + out->counts[length];
    }
    for (uint32_t i = 0; i < count; ++i) {
        if (lengths[i] > 0) out->symbols[next[lengths[i]]++] = (uint16_t)i;
    }
    return true;
}

uint32_t ppmi_basis_symbol(ppmi_basis_bits *bits, const ppmi_basis_code *code)
{
    int32_t value = 0, first = 0, before = 0; /* first: code of this length; before: symbols */
    for (uint32_t length = 1; length <= PPMI_BASIS_LONGEST; ++length) {
        value |= (int32_t)ppmi_basis_get(bits, 1);
        if (bits->is_over) return PPMI_BASIS_NO_SYMBOL;
        if (value - first < code->counts[length]) return code->symbols[before + value - first];
        before += code->counts[length];
        first = (first + code->counts[length]) << 1;
        value <<= 1;
    }
    return PPMI_BASIS_NO_SYMBOL;
}

/* A symbol of the code of lengths: a length itself, or from 17 on a run of zeros or of the length
 * before. Returns how many lengths it stands for, 0 where it is broken. */
static uint32_t read_run(ppmi_basis_bits *bits, uint32_t symbol, uint32_t before, uint8_t *length)
{
    static const struct {
        uint8_t bits, least;
    } runs[] = {{3, 3}, {7, 11}, {2, 3}, {7, 7}};
    if (symbol >= LENGTH_CODES) return 0;
    if (symbol <= PPMI_BASIS_LONGEST) {
        *length = (uint8_t)symbol;
        return 1;
    }
    const bool is_repeated = symbol >= 19;
    if (is_repeated && before == 0) return 0;
    *length = (uint8_t)(is_repeated ? before : 0);
    return runs[symbol - 17].least + ppmi_basis_get(bits, runs[symbol - 17].bits);
}

bool ppmi_basis_read_code(ppmi_basis_bits *bits, ppmi_basis_code *out)
{
    static const uint8_t order[LENGTH_CODES] = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
    uint8_t lengths[PPMI_BASIS_SYMBOLS] = {0}, small[LENGTH_CODES] = {0};
    const uint32_t total = ppmi_basis_get(bits, 14);
    memset(out->counts, 0, sizeof out->counts);
    if (total == 0) return !bits->is_over;
    const uint32_t codes = ppmi_basis_get(bits, 5);
    if (codes < 1 || codes > LENGTH_CODES) return false;
    for (uint32_t i = 0; i < codes; ++i)
        small[order[i]] = (uint8_t)ppmi_basis_get(bits, 3);
    if (!build(small, LENGTH_CODES, out)) return false;
    for (uint32_t i = 0; i < total;) {
        uint8_t length = 0;
        const uint32_t symbol = ppmi_basis_symbol(bits, out);
        const uint32_t run = read_run(bits, symbol, i > 0 ? lengths[i - 1] : 0, &length);
        if (run == 0 || run > total - i || bits->is_over) return false;
        memset(lengths + i, length, run);
        i += run;
    }
    return build(lengths, total, out);
}
