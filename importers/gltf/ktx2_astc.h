/* astcenc behind a C interface: blocks of ASTC in, texels out. C interface of a C++ shim: no
 * exception leaves it. */
#ifndef PPMI_GLTF_KTX2_ASTC_H
#define PPMI_GLTF_KTX2_ASTC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether this build has the decoder. */
bool ppmi_ktx2_has_astc(void);

/* Decodes a picture of width x height texels in blocks of block[0] x block[1] texels and 16 bytes,
 * row by row, into out: RGBA, 8 bits each, sRGB where is_srgb and then encoded. What the format
 * does not allow becomes its error colour, magenta. byte_count has been checked to be that of the
 * blocks. Returns OK, OUT_OF_MEMORY, INPUT_UNSUPPORTED, unreported. Any thread. */
ppm_status ppmi_ktx2_decode_astc(const uint8_t *blocks, size_t byte_count, const uint8_t block[2],
                                 bool is_srgb, uint32_t width, uint32_t height, uint8_t *out);

#ifdef __cplusplus
}
#endif

#endif
