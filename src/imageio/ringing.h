/* Keeps what DWAA and DWAB make of bright pixels finite. */
#ifndef PPMI_IMAGEIO_RINGING_H
#define PPMI_IMAGEIO_RINGING_H

#include "imageio/layered.h"

/* Rows of one part as they are to be written: the first begins a block of the compression, and a
 * tile. */
typedef struct ppmi_ringing_strip {
    const char *path;        /* for messages */
    const char *compression; /* "dwaa:45" */
    const ppmi_layered_part *part;
    uint32_t tile_side;
    uint32_t width, row_count;
    float *values; /* of all channels, packed; within half floats */
} ppmi_ringing_strip;

/* Lowers values until none that is finite is read back as infinite. Returns OK, OUT_OF_MEMORY, or
 * OUTPUT_NOT_WRITABLE when the encoder fails. */
ppm_status ppmi_imageio_limit_ringing(ppm_context *context, const ppmi_ringing_strip *strip);

#endif
