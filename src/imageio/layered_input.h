/* OpenEXR files of many channels, read some rows at a time. */
#ifndef PPMI_IMAGEIO_LAYERED_INPUT_H
#define PPMI_IMAGEIO_LAYERED_INPUT_H

#include "imageio/imageio.h"

typedef struct ppmi_layered_input ppmi_layered_input;

typedef struct ppmi_layered_info {
    uint32_t width, height;             /* what is stored */
    int32_t x, y;                       /* its corner, */
    uint32_t full_width, full_height;   /* in the whole picture */
    uint32_t part_count, channel_count; /* channels of all parts */
} ppmi_layered_info;

/* Opens the file at path. All parts must have the same windows. Returns OK, INPUT_NOT_FOUND,
 * INPUT_INVALID (no OpenEXR file, a damaged one), INPUT_UNSUPPORTED (deep pixels, parts of
 * different sizes), OUT_OF_MEMORY. */
ppm_status ppmi_layered_input_open(ppm_context *context, const char *path,
                                   ppmi_layered_input **out_input, ppmi_layered_info *out_info);
void ppmi_layered_input_close(ppm_context *context, ppmi_layered_input *input);

/* "R", "caustics.R": with the name of the part in front where the channel's own has no layer and
 * the part is not the first. index is below channel_count. Valid until the input is closed. */
const char *ppmi_layered_input_channel(const ppmi_layered_input *input, uint32_t index);

/* Attributes of the first part, in no order; those of types that ppmi_image_attribute has not are
 * left out, and those that OpenImageIO makes itself. Valid until the input is closed. */
uint32_t ppmi_layered_input_attribute_count(const ppmi_layered_input *input);
const ppmi_image_attribute *ppmi_layered_input_attribute(const ppmi_layered_input *input,
                                                         uint32_t index);
/* The one of that name, or NULL. */
const ppmi_image_attribute *ppmi_layered_input_find(const ppmi_layered_input *input,
                                                    const char *name);

/* row_count rows from y on (0: the first that is stored), for each pixel all channels, packed.
 * Quickest from the first row to the last. Returns OK, INPUT_INVALID, OUT_OF_MEMORY. */
ppm_status ppmi_layered_input_read(ppm_context *context, ppmi_layered_input *input, uint32_t y,
                                   uint32_t row_count, float *values);

#endif
