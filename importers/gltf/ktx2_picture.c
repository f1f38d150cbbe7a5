/* Pictures of a KTX file as images: texels of plain formats as 8-bit values or floats, blocks as a
 * DDS file in memory, which OpenImageIO decodes. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf/basis_etc1s.h"
#include "gltf/basis_uastc.h"
#include "gltf/ktx2.h"
#include "gltf/ktx2_astc.h"

/* ---- values ---------------------------------------------------------------------------------- */

static uint32_t little_16(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8;
}

static uint32_t little_32(const unsigned char *p)
{
    return little_16(p) | little_16(p + 2) << 16;
}

/* A float without a sign: five bits of exponent over those of the mantissa (Vulkan 1.3, 3.4.3 to
 * 3.4.5; a half without its sign has ten). */
static float small_float(uint32_t bits, int mantissa_bits)
{
    const uint32_t mantissa = bits & ((1u << mantissa_bits) - 1);
    const int exponent = (int)(bits >> mantissa_bits) & 31;
    if (exponent == 0) return ldexpf((float)mantissa, -14 - mantissa_bits);
    if (exponent == 31) return mantissa ? NAN : INFINITY;
    return ldexpf((float)(mantissa | 1u << mantissa_bits), exponent - 15 - mantissa_bits);
}

static float half_float(uint32_t bits)
{
    const float size = small_float(bits & 0x7fff, 10);
    return bits & 0x8000 ? -size : size;
}

static float srgb_to_linear(float v)
{
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

/* The texel's channels as numbers; alpha is not sRGB, nor is the second of two channels' formats
 * anything else than green. */
static void read_texel(const ppmi_ktx2_format *format, const unsigned char *p, float out[4])
{
    const uint32_t word = format->bytes >= 4 ? little_32(p) : 0;
    for (uint32_t i = 0; i < format->channels; ++i) {
        const uint32_t c = format->is_bgr && i < 3 ? 2 - i : i;
        switch (format->kind) {
        case PPMI_KTX2_U8:
            out[c] = (float)p[i] / 255.0f;
            break;
        case PPMI_KTX2_U16:
            out[c] = (float)little_16(p + 2 * (size_t)i) / 65535.0f;
            break;
        case PPMI_KTX2_F16:
            out[c] = half_float(little_16(p + 2 * (size_t)i));
            break;
        case PPMI_KTX2_F32:
            memcpy(&out[c], p + 4 * (size_t)i, sizeof out[c]);
            break;
        case PPMI_KTX2_B10G11R11:
            out[c] = i == 2 ? small_float(word >> 22, 5) : small_float(word >> (11 * i) & 2047, 6);
            break;
        case PPMI_KTX2_E5B9G9R9: /* three mantissas without a leading one share the exponent */
            out[c] = ldexpf((float)(word >> (9 * i) & 511), (int)(word >> 27) - 15 - 9);
            break;
        case PPMI_KTX2_BLOCKS:
        case PPMI_KTX2_ASTC:
        case PPMI_KTX2_UASTC:
        case PPMI_KTX2_ETC1S:
            break;
        }
        if (format->is_srgb && c < 3) out[c] = srgb_to_linear(out[c]);
    }
}

/* ---- texels ---------------------------------------------------------------------------------- */

/* Where a channel comes from: 0..3, or 4 for zero and 5 for one; channels that a format does not
 * have are 0, and alpha 1 (Vulkan 1.3, 16.3.4). */
static void channel_sources(const ppmi_ktx2 *file, uint32_t out[4])
{
    for (int i = 0; i < 4; ++i) {
        const uint32_t from = (uint32_t)(strchr("rgba01", file->swizzle[i]) - "rgba01");
        const uint32_t has = file->format.channels;
        out[i] = from < has || from > 3 ? from : from == 3 ? 5 : 4;
    }
}

static const unsigned char *texel_at(const ppmi_ktx2 *file, const unsigned char *picture,
                                     uint32_t x, uint32_t y)
{
    const uint32_t from_x = file->is_flipped[0] ? file->width - 1 - x : x;
    const uint32_t from_y = file->is_flipped[1] ? file->height - 1 - y : y;
    return picture + ((size_t)from_y * file->width + from_x) * file->format.bytes;
}

static void fill_bytes(const ppmi_ktx2 *file, const unsigned char *picture,
                       const uint32_t sources[4], uint32_t channels, uint8_t *out)
{
    const bool is_bgr = file->format.is_bgr;
    for (uint32_t y = 0; y < file->height; ++y) {
        for (uint32_t x = 0; x < file->width; ++x) {
            const unsigned char *texel = texel_at(file, picture, x, y);
            for (uint32_t c = 0; c < channels; ++c) {
                const uint32_t from = sources[c];
                const uint32_t at = is_bgr && from < 3 ? 2 - from : from;
                *out++ = from < 4 ? texel[at] : from == 4 ? 0 : 255;
            }
        }
    }
}

static void fill_floats(const ppmi_ktx2 *file, const unsigned char *picture,
                        const uint32_t sources[4], uint32_t channels, float *out)
{
    float values[6] = {0, 0, 0, 0, 0, 1};
    for (uint32_t y = 0; y < file->height; ++y) {
        for (uint32_t x = 0; x < file->width; ++x) {
            read_texel(&file->format, texel_at(file, picture, x, y), values);
            for (uint32_t c = 0; c < channels; ++c)
                *out++ = values[sources[c]];
        }
    }
}

static ppm_status read_texels(ppm_context *context, ppmi_ktx2 *file, const unsigned char *picture,
                              ppm_image_desc *desc, void **out_owned)
{
    uint32_t sources[4];
    channel_sources(file, sources);
    const bool is_u8 = file->format.kind == PPMI_KTX2_U8 &&
                       file->format.is_srgb == (desc->role == PPM_IMAGE_COLOR);
    const uint32_t channels = sources[3] == 5 ? 3 : 4;
    const size_t count = (size_t)file->width * file->height;
    void *pixels = ppmi_alloc(context, count, channels * (is_u8 ? 1 : sizeof(float)));
    if (!pixels) {
        snprintf(file->reason, sizeof file->reason, "out of memory");
        return PPM_STATUS_OUT_OF_MEMORY;
    }
    if (is_u8) {
        fill_bytes(file, picture, sources, channels, pixels);
    } else {
        fill_floats(file, picture, sources, channels, pixels);
    }
    desc->pixels = *out_owned = pixels;
    desc->pixel_type = is_u8 ? PPM_PIXELS_U8 : PPM_PIXELS_F32;
    desc->width = file->width;
    desc->height = file->height;
    desc->channels = channels;
    return PPM_STATUS_OK;
}

/* ---- blocks ---------------------------------------------------------------------------------- */

static void put_32(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; ++i)
        at[i] = (unsigned char)(value >> (8 * i));
}

/* The header of a DDS file with one picture (Microsoft, "Programming Guide for DDS"); formats that
 * have no four letters have a number in a second header. */
static size_t put_dds_header(const ppmi_ktx2 *file, unsigned char *out)
{
    enum { CAPS_SIZE_FORMAT = 0x81007, HAS_LETTERS = 4, IS_TEXTURE = 0x1000, FLAT = 3 };
    const uint32_t format = file->format.dds;
    const bool has_letters = format > 0xffff;
    memcpy(out, "DDS ", 4);
    put_32(out + 4, 124);
    put_32(out + 8, CAPS_SIZE_FORMAT);
    put_32(out + 12, file->height);
    put_32(out + 16, file->width);
    put_32(out + 20, (uint32_t)file->picture_bytes);
    put_32(out + 76, 32);
    put_32(out + 80, HAS_LETTERS);
    if (has_letters) {
        put_32(out + 84, format);
    } else {
        memcpy(out + 84, "DX10", 4);
    }
    put_32(out + 108, IS_TEXTURE);
    if (has_letters) return 128;
    put_32(out + 128, format);
    put_32(out + 132, FLAT);
    put_32(out + 140, 1);
    return 148;
}

static ppm_status wrap_blocks(ppm_context *context, ppmi_ktx2 *file, const unsigned char *picture,
                              ppm_image_desc *desc, void **out_owned)
{
    unsigned char header[148] = {0};
    const size_t header_size = put_dds_header(file, header);
    if (memcmp(file->swizzle, "rgba", 4) != 0 || file->is_flipped[0] || file->is_flipped[1]) {
        snprintf(file->reason, sizeof file->reason,
                 "its blocks are to be turned (KTXorientation) or their channels to be exchanged "
                 "(KTXswizzle)");
        return PPM_STATUS_INPUT_UNSUPPORTED;
    }
    unsigned char *bytes = ppmi_alloc(context, header_size + file->picture_bytes, 1);
    if (!bytes) {
        snprintf(file->reason, sizeof file->reason, "out of memory");
        return PPM_STATUS_OUT_OF_MEMORY;
    }
    memcpy(bytes, header, header_size);
    memcpy(bytes + header_size, picture, file->picture_bytes);
    desc->bytes = *out_owned = bytes;
    desc->byte_count = header_size + file->picture_bytes;
    const bool is_half = file->format.dds == 95 || file->format.dds == 96;
    if (!is_half && file->format.is_srgb != (desc->role == PPM_IMAGE_COLOR)) {
        file->colors_note = file->format.is_srgb ? "its blocks are sRGB, and read as plain numbers"
                                                 : "its blocks are not sRGB, but read as such";
    }
    return PPM_STATUS_OK;
}

/* ---- blocks that become texels of four bytes ------------------------------------------------- */

static ppm_status decode_astc(const ppmi_ktx2 *file, uint32_t index, uint8_t *out,
                              const char **reason)
{
    const unsigned char *picture = file->level + index * file->picture_bytes;
    *reason = "its ASTC blocks cannot be decoded";
    return ppmi_ktx2_decode_astc(picture, file->picture_bytes, file->format.block,
                                 file->format.is_srgb, file->width, file->height, out);
}

static ppm_status decode_etc1s(ppm_context *context, const ppmi_ktx2 *file, uint32_t index,
                               uint8_t *out, const char **reason)
{
    const ppmi_basis_source source = {file->global,      file->global_bytes, file->level,
                                      file->level_bytes, file->images,       index,
                                      file->width,       file->height};
    return ppmi_basis_decode_etc1s(context, &source, out, reason);
}

/* Of two channels the second is decoded as alpha is. */
static ppm_status decode_basis(ppm_context *context, const ppmi_ktx2 *file, uint32_t index,
                               uint8_t *out, const char **reason)
{
    const unsigned char *picture = file->level + index * file->picture_bytes;
    const ppm_status status =
        file->format.kind == PPMI_KTX2_ETC1S
            ? decode_etc1s(context, file, index, out, reason)
            : ppmi_basis_decode_uastc(picture, file->width, file->height, out, reason);
    if (status != PPM_STATUS_OK || file->format.channels != 2) return status;
    for (size_t i = 0; i < (size_t)file->width * file->height; ++i)
        out[4 * i + 1] = out[4 * i + 3];
    return PPM_STATUS_OK;
}

static ppm_status decode(ppm_context *context, ppmi_ktx2 *file, uint32_t index,
                         ppm_image_desc *desc, void **out_owned)
{
    const ppmi_ktx2_format blocks = file->format;
    const char *reason = "";
    uint8_t *decoded = ppmi_alloc(context, (size_t)file->width * file->height, 4);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    if (decoded && blocks.kind == PPMI_KTX2_ASTC) {
        status = decode_astc(file, index, decoded, &reason);
    } else if (decoded) {
        status = decode_basis(context, file, index, decoded, &reason);
    }
    if (status == PPM_STATUS_OK) {
        file->format = (ppmi_ktx2_format){.kind = PPMI_KTX2_U8,
                                          .channels = blocks.channels,
                                          .bytes = 4,
                                          .is_srgb = blocks.is_srgb};
        status = read_texels(context, file, decoded, desc, out_owned);
        file->format = blocks;
    } else {
        snprintf(file->reason, sizeof file->reason, "%s",
                 status == PPM_STATUS_OUT_OF_MEMORY ? "out of memory" : reason);
    }
    ppmi_free(context, decoded);
    return status;
}

ppm_status ppmi_ktx2_picture(ppm_context *context, ppmi_ktx2 *file, uint32_t layer, uint32_t face,
                             ppm_image_desc *desc, void **out_owned)
{
    if (layer >= file->layers || face >= file->faces) {
        snprintf(file->reason, sizeof file->reason, "it has no layer %u", layer);
        return PPM_STATUS_INPUT_UNSUPPORTED;
    }
    const uint32_t index = layer * file->faces + face;
    const unsigned char *picture = file->level + index * file->picture_bytes;
    desc->bytes = desc->path = NULL;
    desc->byte_count = 0;
    switch (file->format.kind) {
    case PPMI_KTX2_BLOCKS:
        return wrap_blocks(context, file, picture, desc, out_owned);
    case PPMI_KTX2_ASTC:
    case PPMI_KTX2_UASTC:
    case PPMI_KTX2_ETC1S:
        return decode(context, file, index, desc, out_owned);
    default:
        return read_texels(context, file, picture, desc, out_owned);
    }
}
