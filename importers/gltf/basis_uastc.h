/* UASTC LDR 4x4 pictures (Basis Universal, "UASTC LDR 4x4 Texture Specification"): blocks of 4 x 4
 * texels in 16 bytes, a part of what ASTC can say, in bits of another order. */
#ifndef PPMI_GLTF_BASIS_UASTC_H
#define PPMI_GLTF_BASIS_UASTC_H

#include <stdint.h>

#include "ppm/status.h"

/* Decodes the blocks of a picture, row by row, ceil(width / 4) * ceil(height / 4) of them, into
 * out, width * height texels of 4 bytes, values as stored (sRGB or linear). Returns OK or
 * INPUT_INVALID, unreported, with the reason. Any thread. */
ppm_status ppmi_basis_decode_uastc(const unsigned char *blocks, uint32_t width, uint32_t height,
                                   uint8_t *out, const char **reason);

#endif
