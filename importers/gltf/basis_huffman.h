/* Bits and Huffman codes of BasisLZ (KTX 2.0, "BasisLZ/ETC1S Bitstream Specification", "Compressed
 * Huffman Tables"): canonical codes as in Deflate (RFC 1951, 3.2.2), of up to 16383 symbols. */
#ifndef PPMI_GLTF_BASIS_HUFFMAN_H
#define PPMI_GLTF_BASIS_HUFFMAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PPMI_BASIS_LONGEST = 16, PPMI_BASIS_SYMBOLS = 16383, PPMI_BASIS_NO_SYMBOL = 0xffff };

/* Bytes read bit by bit, the lowest first. Past the end come zeros, and is_over stays set. */
typedef struct ppmi_basis_bits {
    const unsigned char *bytes;
    size_t count; /* of bytes */
    size_t at;    /* next bit */
    bool is_over;
} ppmi_basis_bits;

/* A canonical code: how many symbols each length has, and the symbols by length, then by number. */
typedef struct ppmi_basis_code {
    uint16_t counts[PPMI_BASIS_LONGEST + 1];
    uint16_t symbols[PPMI_BASIS_SYMBOLS];
} ppmi_basis_code;

/* The next bits, at most 16, the first as the lowest. */
uint32_t ppmi_basis_get(ppmi_basis_bits *bits, uint32_t count);

/* Reads a code. False where it is broken: too many symbols, more codes than its lengths allow, or
 * an end too early. A code without symbols is one that is never used. */
bool ppmi_basis_read_code(ppmi_basis_bits *bits, ppmi_basis_code *out);

/* The next symbol; PPMI_BASIS_NO_SYMBOL where the bits are none or have ended. */
uint32_t ppmi_basis_symbol(ppmi_basis_bits *bits, const ppmi_basis_code *code);

#endif
