/* OpenImageIO, as far as it is needed: encoded bytes to pixels and back. All choices (formats,
 * limits, alpha, rounding) are made in imageio.c; no exception leaves the shim. */
#ifndef PPMI_IMAGEIO_OIIO_SHIM_H
#define PPMI_IMAGEIO_OIIO_SHIM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "imageio/imageio.h"
#include "imageio/layered.h"

#ifdef __cplusplus
#define PPMI_NOEXCEPT noexcept
extern "C" {
#else
#define PPMI_NOEXCEPT
#endif

typedef struct ppmi_oiio_reader ppmi_oiio_reader;

/* What the header of an image says; nothing of it has been checked. */
typedef struct ppmi_oiio_info {
    int32_t x, y, width, height;                     /* the pixels that are stored */
    int32_t full_x, full_y, full_width, full_height; /* the picture that they are a part of */
    int32_t channels;
    int32_t alpha_channel; /* or -1 */
    bool is_u8;            /* samples of at most 8 bits */
    bool is_float;         /* half or float samples */
    bool is_associated;    /* colours come multiplied by alpha */
    bool has_chromaticities;
    float chromaticities[8];
    char color_space[64]; /* colorInteropID; "": none */
    bool is_deep;         /* several samples in a pixel: cannot be read */
} ppmi_oiio_info;

/* Opens the image in bytes, which must outlive the reader, as the OpenImageIO format.
 * Returns OK, INPUT_INVALID, INPUT_UNSUPPORTED, OUT_OF_MEMORY. */
ppm_status ppmi_oiio_open(ppm_context *context, const char *format, const void *bytes,
                          size_t byte_count, const char *name, ppmi_oiio_reader **out_reader,
                          ppmi_oiio_info *out_info) PPMI_NOEXCEPT;
/* "R", "diffuse.R"; index is below info.channels. Valid until the reader is closed. */
const char *ppmi_oiio_channel_name(const ppmi_oiio_reader *reader, int32_t index) PPMI_NOEXCEPT;
/* channels channels, from first on, of all stored pixels, packed: uint8_t where as_u8, else float.
 */
ppm_status ppmi_oiio_read(ppm_context *context, ppmi_oiio_reader *reader, const char *name,
                          int32_t first, int32_t channels, bool as_u8,
                          void *out_pixels) PPMI_NOEXCEPT;
void ppmi_oiio_close(ppmi_oiio_reader *reader) PPMI_NOEXCEPT;

/* Encodes file, whose pixels member is not used: pixels are uint8_t for PPMI_STORE_U8, uint16_t
 * for PPMI_STORE_U16, else float. compression may be NULL. *out_bytes is freed with ppmi_free.
 * Returns OK, OUTPUT_NOT_WRITABLE, OUT_OF_MEMORY. */
ppm_status ppmi_oiio_encode(ppm_context *context, const char *format, const char *compression,
                            const char *path, const ppmi_image_file *file, const void *pixels,
                            void **out_bytes, size_t *out_byte_count) PPMI_NOEXCEPT;

/* Where encoded bytes go. write returns 0 or an errno. OpenImageIO 2.4 writes files of several
 * parts by their path alone: those go to path, and full disks may go unnoticed. */
typedef struct ppmi_oiio_sink {
    const char *path;
    int (*write)(void *user, const void *bytes, size_t byte_count, uint64_t offset);
    void *user;
} ppmi_oiio_sink;

/* Encodes an OpenEXR file strip by strip: for each part in turn begin, then all its rows. read_rows
 * of file is not used; file and what sink points to must outlive the writer. Close with is_complete
 * false gives up. Return OK, OUTPUT_NOT_WRITABLE, OUT_OF_MEMORY. */
typedef struct ppmi_oiio_writer ppmi_oiio_writer;
ppm_status ppmi_oiio_create_layered(ppm_context *context, const char *path,
                                    const ppmi_layered_file *file, const ppmi_oiio_sink *sink,
                                    ppmi_oiio_writer **out_writer) PPMI_NOEXCEPT;
ppm_status ppmi_oiio_begin_part(ppm_context *context, ppmi_oiio_writer *writer, const char *path,
                                uint32_t part) PPMI_NOEXCEPT;
ppm_status ppmi_oiio_write_rows(ppm_context *context, ppmi_oiio_writer *writer, const char *path,
                                uint32_t y, uint32_t row_count, const float *values) PPMI_NOEXCEPT;
ppm_status ppmi_oiio_close_writer(ppm_context *context, ppmi_oiio_writer *writer, const char *path,
                                  bool is_complete) PPMI_NOEXCEPT;

/* One part of an OpenEXR file. Nothing of the info has been checked. */
typedef struct ppmi_oiio_part ppmi_oiio_part;

typedef struct ppmi_oiio_part_info {
    int32_t x, y, width, height;
    int32_t full_x, full_y, full_width, full_height;
    int32_t channel_count;
    int32_t part_count; /* of the file; as far as it is known with part 0 */
    bool is_deep;
} ppmi_oiio_part_info;

/* Return OK, INPUT_INVALID, INPUT_UNSUPPORTED, OUT_OF_MEMORY. */
ppm_status ppmi_oiio_part_open(ppm_context *context, const char *path, uint32_t index,
                               ppmi_oiio_part **out_part,
                               ppmi_oiio_part_info *out_info) PPMI_NOEXCEPT;
/* Rows are counted from the first that is stored. */
ppm_status ppmi_oiio_part_read(ppm_context *context, ppmi_oiio_part *part, const char *path,
                               uint32_t y, uint32_t row_count, float *values) PPMI_NOEXCEPT;
/* All valid until the part is closed. The part's name is "" where it has none. */
const char *ppmi_oiio_part_name(const ppmi_oiio_part *part) PPMI_NOEXCEPT;
const char *ppmi_oiio_part_channel(const ppmi_oiio_part *part, int32_t index) PPMI_NOEXCEPT;
uint32_t ppmi_oiio_part_attribute_count(const ppmi_oiio_part *part) PPMI_NOEXCEPT;
const ppmi_image_attribute *ppmi_oiio_part_attribute(const ppmi_oiio_part *part,
                                                     uint32_t index) PPMI_NOEXCEPT;
void ppmi_oiio_part_close(ppmi_oiio_part *part) PPMI_NOEXCEPT;

/* "OpenImageIO 2.4.7.1". Static. */
const char *ppmi_oiio_version(void) PPMI_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#undef PPMI_NOEXCEPT

#endif
