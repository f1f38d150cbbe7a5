/* Image files, through OpenImageIO. C interface of a C++ shim: no exception leaves it. */
#ifndef PPMI_IMAGEIO_H
#define PPMI_IMAGEIO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decoded pixels: width * height * channels values, row 0 on top, packed. 8-bit files give u8,
 * everything else f32. Free with ppmi_imageio_pixels_free. */
typedef struct ppmi_pixels {
    uint32_t width, height, channels; /* channels 1..4: grey, grey+alpha, RGB, RGBA */
    uint8_t *u8;                      /* or NULL */
    float *f32;                       /* or NULL */
    bool is_linear;                   /* the file holds scene-linear values (HDR, EXR) */
    /* The part that the file stores (OpenEXR's data window, cut to the picture); everything else is
     * zero. Elsewhere the whole picture. */
    uint32_t stored_x, stored_y, stored_width, stored_height;
    /* What the file says of its values: chromaticities of red, green, blue and white (OpenEXR), and
     * the name of a space (colorInteropID); "": nothing. */
    bool has_chromaticities;
    float chromaticities[8];
    char color_space[64];
    bool is_cut; /* the file lacks its end, though no pixel: a warning has told it */
} ppmi_pixels;

/* Decodes a file. name is used in messages. Files of more than 4 channels give the first four, in
 * OpenEXR files R, G, B (and A) of the layer without a name, else of the one called Combined, else
 * of the first that has them; alpha is returned unassociated. Refuses images of more than 2^30
 * values (INPUT_UNSUPPORTED). Returns OK, INPUT_NOT_FOUND, INPUT_INVALID,
 * INPUT_UNSUPPORTED, OUT_OF_MEMORY. Any thread.
 */
ppm_status ppmi_imageio_read_file(ppm_context *context, const char *path, const char *name,
                                  ppmi_pixels *out_pixels);
ppm_status ppmi_imageio_read_memory(ppm_context *context, const void *bytes, size_t byte_count,
                                    const char *name, ppmi_pixels *out_pixels);
void ppmi_imageio_pixels_free(ppm_context *context, ppmi_pixels *pixels);

enum {
    PPMI_ATTRIBUTE_STRING,
    PPMI_ATTRIBUTE_INT,
    PPMI_ATTRIBUTE_FLOAT,
    PPMI_ATTRIBUTE_FLOATS,
    PPMI_ATTRIBUTE_RATIONAL,
    PPMI_ATTRIBUTE_MATRIX,
    PPMI_ATTRIBUTE_PAIR
};

/* One header entry. */
typedef struct ppmi_image_attribute {
    const char *name;
    int32_t type; /* PPMI_ATTRIBUTE_ */
    const char *text;
    int64_t integer;     /* written as int where it fits, else as a decimal string */
    const float *floats; /* FLOATS: float_count values (8: chromaticities); FLOAT: the first;
                            MATRIX: 16, for row vectors, rows one after the other; PAIR: 2 */
    uint32_t float_count;
    int32_t rational[2]; /* RATIONAL: numerator and denominator */
} ppmi_image_attribute;

enum { PPMI_STORE_U8, PPMI_STORE_U16, PPMI_STORE_HALF, PPMI_STORE_FLOAT };

typedef struct ppmi_image_file {
    uint32_t width, height, channels;
    /* The picture that the pixels are a part of, and where they stand in it: OpenEXR's display
     * window, and the corner of its data window. The other formats hold the part alone. full_width
     * 0: the pixels are all there is. */
    uint32_t full_width, full_height, x, y;
    /* width * height * channels, row 0 on top. Alpha, the second or fourth channel, multiplies the
     * colours in OpenEXR, by its convention, and does not in the other formats. */
    const float *pixels;
    const char *const *channel_names; /* channels names, or NULL: Y, Y A, R G B, R G B A */
    int32_t store;                    /* PPMI_STORE_ */
    bool is_dithered;                 /* U8: noise before rounding, by the place in the picture */
    uint32_t jpeg_quality;            /* 1 .. 100; 0: 95 */
    /* What the values are, as the formats have it: "sRGB" or NULL; an ICC profile or NULL (not in a
     * PNG file that says sRGB: one excludes the other); code points of H.273 (PNG) where has_cicp.
     */
    const char *color_space;
    const uint8_t *icc;
    size_t icc_bytes;
    bool has_cicp;
    uint8_t cicp[4];
    uint32_t attribute_count;
    const ppmi_image_attribute *attributes;
} ppmi_image_file;

/* Writes a file whose format follows the ending of path: to a new temporary file in the same
 * folder, flushed, then renamed over path. On failure path is untouched and the temporary is gone.
 * Formats that cannot hold alpha (JPEG) get the first three channels.
 * Returns OK, INVALID_ARGUMENT (ending; pixels that the format cannot store), OUTPUT_NOT_WRITABLE
 * (the message has path and reason), OUT_OF_MEMORY. */
ppm_status ppmi_imageio_write_file(ppm_context *context, const char *path,
                                   const ppmi_image_file *file);

/* Whether ppmi_imageio_write_file could write to path now: an ending that is known, a folder that
 * takes new files. Returns OK, INVALID_ARGUMENT (ending), OUTPUT_NOT_WRITABLE, OUT_OF_MEMORY. */
ppm_status ppmi_imageio_check_output(ppm_context *context, const char *path);

/* "OpenImageIO 2.4.7.1". Static. */
const char *ppmi_imageio_version(void);

#ifdef __cplusplus
}
#endif

#endif
