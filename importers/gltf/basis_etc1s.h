/* ETC1S pictures in BasisLZ (KTX 2.0, "BasisLZ Global Data" and "BasisLZ/ETC1S Bitstream
 * Specification"): codebooks that all pictures of a file share, and slices of indices into them. */
#ifndef PPMI_GLTF_BASIS_ETC1S_H
#define PPMI_GLTF_BASIS_ETC1S_H

#include <stdint.h>

#include "base/context.h"

/* Where the parts are; nothing of it has been checked. */
typedef struct ppmi_basis_source {
    const unsigned char *global; /* the file's global data */
    size_t global_count;
    const unsigned char *level; /* the level's slices */
    size_t level_count;
    uint32_t images;        /* descriptions in the global data: of all levels */
    uint32_t image;         /* wanted one */
    uint32_t width, height; /* its texels */
} ppmi_basis_source;

/* Decodes a picture into out, width * height texels of 4 bytes, row by row, values as stored (sRGB
 * or linear). Without a second slice alpha is 255. Returns OK, OUT_OF_MEMORY, INPUT_INVALID or
 * INPUT_UNSUPPORTED (frames of a video), unreported, with the reason. Any thread. */
ppm_status ppmi_basis_decode_etc1s(ppm_context *context, const ppmi_basis_source *source,
                                   uint8_t *out, const char **reason);

#endif
