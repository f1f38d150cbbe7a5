/* OpenEXR files of many channels: written strip by strip, so that a picture of a hundred layers
 * needs the memory of a few rows beside what its owner keeps. */
#ifndef PPMI_IMAGEIO_LAYERED_H
#define PPMI_IMAGEIO_LAYERED_H

#include "imageio/imageio.h"

typedef struct ppmi_layered_channel {
    const char *name; /* "caustics.R"; unique in its part */
    int32_t store;    /* PPMI_STORE_HALF, PPMI_STORE_FLOAT */
} ppmi_layered_channel;

typedef struct ppmi_layered_part {
    const char *name; /* unique in the file; NULL in a file of one part */
    uint32_t channel_count;
    const ppmi_layered_channel *channels;
    const char *compression; /* NULL: the file's */
} ppmi_layered_part;

/* Whether a compression makes channels of R, G, B and Y of what they are by a cosine transform,
 * which overshoots beside what is bright (DWAA, DWAB). */
bool ppmi_layered_has_ringing(const char *compression);

typedef struct ppmi_layered_file {
    uint32_t width, height;                 /* what is stored */
    uint32_t full_width, full_height, x, y; /* as in ppmi_image_file */
    const char *compression;                /* as ppmi_layered_compression gives it */
    uint32_t tile_side;                     /* 0: scanlines */
    uint32_t part_count;
    const ppmi_layered_part *parts;
    uint32_t attribute_count; /* of the first part, */
    const ppmi_image_attribute *attributes;
    uint32_t repeated_count; /* and how many of them, from the first on, are in the others too */
    /* Fills row_count rows of a part, from y on (0: the first that is stored): for each pixel its
     * channels, packed. Called for each part in turn, from the first row to the last. */
    ppm_status (*read_rows)(void *user, uint32_t part, uint32_t y, uint32_t row_count,
                            float *values);
    void *user;
} ppmi_layered_file;

/* Writes a new file beside path, flushes it and renames it to path; on failure path is untouched.
 * What is brighter than half floats can be is stored in them as their largest value, and with DWAA
 * and DWAB what is beside it as much lower as it takes to be read as finite. Returns OK,
 * OUTPUT_NOT_WRITABLE, OUT_OF_MEMORY, or what read_rows returned. */
ppm_status ppmi_imageio_write_layered(ppm_context *context, const char *path,
                                      const ppmi_layered_file *file);

#endif
