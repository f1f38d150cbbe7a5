/* Which image formats are read and written, and how a file is recognised. */
#ifndef PPMI_IMAGEIO_FORMAT_H
#define PPMI_IMAGEIO_FORMAT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "imageio/imageio.h"

typedef struct ppmi_image_format {
    const char *label; /* for people: "PNG" */
    const char *oiio;  /* OpenImageIO's name; NULL: recognised, but cannot be read */
    /* More pixels than this for each byte of a file are a lie; 0: the encoding has no such bound */
    uint32_t pixels_per_byte_max;
    bool keeps_alpha_straight; /* OpenImageIO hands alpha on as it is, whatever it says */
} ppmi_image_format;

/* By the first bytes, else (Targa, which has no mark) by the ending of name. NULL: unknown. */
const ppmi_image_format *ppmi_imageio_format_of_input(const void *bytes, size_t byte_count,
                                                      const char *name);

typedef struct ppmi_output_format {
    const char *label;
    const char *oiio;
    const char *compression; /* as OpenImageIO writes it; NULL: the format has only one */
    uint32_t stores;         /* bit 1 << PPMI_STORE_ for each that the format holds */
    int32_t usual_store;     /* PPMI_STORE_ of a file when nobody asks for another */
    bool has_alpha;
    bool is_scene_linear; /* holds light, not the code values of a display */
} ppmi_output_format;

/* By the ending of path, in any letter case. NULL: none that can be written. */
const ppmi_output_format *ppmi_imageio_format_of_output(const char *path);

#endif
