/* KTX 2.0 files: a container of pictures as graphics cards take them (Khronos, "KTX File Format
 * Specification", version 2.0). What is read are the pictures of the largest level, of formats that
 * hold plain values, or blocks that a DDS file may hold too, ASTC, and ETC1S and UASTC of Basis
 * Universal. */
#ifndef PPMI_GLTF_KTX2_H
#define PPMI_GLTF_KTX2_H

#include <stdint.h>

#include "base/context.h"
#include "ppm/scene.h"

enum { PPMI_KTX2_REASON = 160 };

/* How a format stores a picture. */
typedef enum ppmi_ktx2_kind {
    PPMI_KTX2_U8,
    PPMI_KTX2_U16,
    PPMI_KTX2_F16,
    PPMI_KTX2_F32,
    PPMI_KTX2_B10G11R11,
    PPMI_KTX2_E5B9G9R9,
    PPMI_KTX2_BLOCKS, /* 4 x 4 texels together */
    PPMI_KTX2_ASTC,   /* the same, of other sizes */
    PPMI_KTX2_UASTC,  /* Basis Universal, 4 x 4 texels */
    PPMI_KTX2_ETC1S   /* the same in BasisLZ: of no fixed size */
} ppmi_ktx2_kind;

/* A row of the table of formats. */
typedef struct ppmi_ktx2_format {
    uint32_t vulkan; /* VkFormat */
    ppmi_ktx2_kind kind;
    uint32_t channels;
    uint32_t bytes; /* of a texel, or of a block */
    bool is_srgb;
    bool is_bgr;
    uint32_t dds;     /* of blocks: the four letters of a DDS file, or DXGI's number */
    uint8_t block[2]; /* texels of a block, across and down; 0: one or, of BLOCKS, four */
} ppmi_ktx2_format;

/* An open file. */
typedef struct ppmi_ktx2 {
    ppmi_ktx2_format format;
    uint32_t width, height;
    uint32_t layers, faces;     /* pictures in the level: layers * faces, layer by layer */
    const unsigned char *level; /* the level's pictures */
    size_t picture_bytes;       /* 0 of ETC1S */
    size_t level_bytes;
    const unsigned char *global; /* of ETC1S: the file's global data, with so many descriptions */
    size_t global_bytes;         /* of pictures */
    uint32_t images;
    unsigned char *owned;          /* level, if it had to be unpacked */
    char swizzle[4];               /* which of r g b a 0 1 each channel is */
    bool is_flipped[2];            /* x runs to the left, y up */
    const char *colors_note;       /* what a reader of blocks does not know about them, or NULL */
    char reason[PPMI_KTX2_REASON]; /* after a failure: what was found */
} ppmi_ktx2;

/* Whether a file begins like one. */
bool ppmi_ktx2_is(const unsigned char *bytes, size_t count);

/* The encoding of a file that can be opened no further, for messages: "BC4"; NULL where it is one
 * that is read. */
const char *ppmi_ktx2_unread_encoding(const unsigned char *bytes, size_t count);

/* Checks all sizes against the file's, and unpacks the largest level. bytes must outlive out.
 * Returns OK, INPUT_INVALID, INPUT_UNSUPPORTED, OUT_OF_MEMORY, unreported, with out->reason; closed
 * with ppmi_ktx2_close in any case. */
ppm_status ppmi_ktx2_open(ppm_context *context, const unsigned char *bytes, size_t count,
                          ppmi_ktx2 *out);
void ppmi_ktx2_close(ppm_context *context, ppmi_ktx2 *file);

/* One picture as the source of an image: fills in desc's pixels, or its bytes with a DDS file. Its
 * role decides about 8-bit values: those that are not what the role takes become floats. What desc
 * points to is *out_owned, the caller's. Returns OK, INPUT_UNSUPPORTED, OUT_OF_MEMORY, unreported,
 * with file->reason. */
ppm_status ppmi_ktx2_picture(ppm_context *context, ppmi_ktx2 *file, uint32_t layer, uint32_t face,
                             ppm_image_desc *desc, void **out_owned);

/* ---- between the parts ----------------------------------------------------------------------- */

/* ktx2_unpack.c: undoes a supercompression (Zstandard 2, ZLIB 3) into out_count bytes. Returns OK,
 * INPUT_INVALID, INPUT_UNSUPPORTED with the reason. */
ppm_status ppmi_ktx2_unpack(uint32_t scheme, const unsigned char *bytes, size_t count,
                            unsigned char *out, size_t out_count, const char **reason);

/* ktx2_format.c: a format by VkFormat and, where that is 0, by the colour model of the file's
 * descriptor. False where it is not read. */
bool ppmi_ktx2_find_format(uint32_t vulkan, uint32_t color_model, ppmi_ktx2_format *out);
/* The name of a format that is not read, by VkFormat and the colour model of the file's descriptor;
 * NULL for one without a name here. */
const char *ppmi_ktx2_format_name(uint32_t vulkan, uint32_t color_model);

#endif
