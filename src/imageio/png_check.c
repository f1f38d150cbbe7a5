/* The chunks of a PNG file: lengths, checksums, order and header values (W3C PNG, second edition,
 * sections 5, 11.2.2 and annex D).
 *
 * libpng would find the same faults, but it prints them to stderr and leaves by longjmp through
 * OpenImageIO's C++ frames, which leaks. Damage that agrees with the checksums remains its work. */
#include "imageio/png_check.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { SIGNATURE_BYTES = 8, IHDR_BYTES = 13, CHUNK_OVERHEAD = 12 };

static uint32_t big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* CRC-32 by nibbles: a table of 16 is small enough to write down, and fast enough for files. */
static uint32_t crc32_of(const uint8_t *bytes, size_t count)
{
    static const uint32_t table[16] = {
        0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac, 0x76dc4190, 0x6b6b51f4,
        0x4db26158, 0x5005713c, 0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
        0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c,
    };
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        crc = table[crc & 15] ^ crc >> 4;
        crc = table[crc & 15] ^ crc >> 4;
    }
    return ~crc;
}

/* Whether the header's values may be together (table 11.1). */
static bool header_is_valid(const uint8_t *data)
{
    /* allowed bit depths as bits of a mask, by colour type */
    static const uint32_t depths[7] = {
        [0] = 1 << 1 | 1 << 2 | 1 << 4 | 1 << 8 | 1 << 16,
        [2] = 1 << 8 | 1 << 16,
        [3] = 1 << 1 | 1 << 2 | 1 << 4 | 1 << 8,
        [4] = 1 << 8 | 1 << 16,
        [6] = 1 << 8 | 1 << 16,
    };
    const uint32_t width = big_endian(data), height = big_endian(data + 4);
    const uint8_t depth = data[8], color_type = data[9];
    if (width == 0 || width > INT32_MAX || height == 0 || height > INT32_MAX) return false;
    if (depth > 16 || color_type > 6 || (depths[color_type] >> depth & 1) == 0) return false;
    return data[10] == 0 && data[11] == 0 && data[12] <= 1;
}

static bool type_is_valid(const uint8_t *type)
{
    for (int i = 0; i < 4; i++) {
        const uint8_t letter = type[i] | 0x20; /* small */
        if (letter < 'a' || letter > 'z') return false;
    }
    return true;
}

/* Critical chunks have a capital first letter; a fault in another one does no harm. */
static bool is_critical(const uint8_t *type)
{
    return (type[0] & 0x20) == 0;
}

/* What is wrong with a chunk whose bytes are all there, or NULL. */
static const char *chunk_fault(const uint8_t *chunk, uint32_t length, bool is_first)
{
    const uint8_t *const type = chunk + 4, *const data = chunk + 8;
    const bool is_header = memcmp(type, "IHDR", 4) == 0;
    if (is_first != is_header) return "the header is not the first chunk";
    if (!type_is_valid(type)) return "the chunk's type is not of letters";
    if (!is_critical(type)) return NULL;
    if (crc32_of(type, (size_t)length + 4) != big_endian(data + length)) return "checksum is wrong";
    if (is_header && (length != IHDR_BYTES || !header_is_valid(data))) {
        return "the header has values that are not allowed";
    }
    return NULL;
}

/* Whether the chunk that the rest of the file does not hold is one that no pixel needs: IEND, or
 * one of text and the like before it. Less than a type is the beginning of anything. */
static bool cut_chunk_is_needless(const uint8_t *chunk, size_t byte_count)
{
    if (byte_count < 8) return true;
    return memcmp(chunk + 4, "IEND", 4) == 0 ||
           (type_is_valid(chunk + 4) && !is_critical(chunk + 4));
}

/* Walks the chunks up to the last. Returns what is wrong at *out_offset, or NULL; *out_is_cut is
 * set where all pixels are there, and nothing is wrong but that the file ends at *out_offset. */
static const char *file_fault(const uint8_t *file, size_t byte_count, size_t *out_offset,
                              bool *out_is_cut)
{
    bool has_pixels = false;
    size_t offset = SIGNATURE_BYTES;
    for (;;) {
        *out_offset = offset;
        const uint8_t *const chunk = file + offset;
        const size_t left = byte_count - offset;
        const uint32_t length = left < 4 ? 0 : big_endian(chunk);
        if (left < CHUNK_OVERHEAD || length > left - CHUNK_OVERHEAD) {
            *out_is_cut = has_pixels && cut_chunk_is_needless(chunk, left);
            if (*out_is_cut) return NULL;
            return left < CHUNK_OVERHEAD ? "the file ends early"
                                         : "a chunk is longer than the rest of the file";
        }
        const char *const fault = chunk_fault(chunk, length, offset == SIGNATURE_BYTES);
        if (fault) return fault;
        if (memcmp(chunk + 4, "IDAT", 4) == 0) has_pixels = true;
        if (memcmp(chunk + 4, "IEND", 4) == 0) return has_pixels ? NULL : "there are no pixels";
        offset += (size_t)length + CHUNK_OVERHEAD;
    }
}

const uint8_t ppmi_imageio_png_end[PPMI_PNG_END_BYTES] = {0,   0,   0,    0,    'I',  'E',
                                                          'N', 'D', 0xae, 0x42, 0x60, 0x82};

ppm_status ppmi_imageio_png_check(ppm_context *context, const void *bytes, size_t byte_count,
                                  const char *name, size_t *out_cut_at)
{
    size_t offset = 0;
    bool is_cut = false;
    const char *const fault = file_fault(bytes, byte_count, &offset, &is_cut);
    *out_cut_at = is_cut ? offset : 0;
    if (!fault) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: broken PNG at byte %zu: %s", name,
                     offset, fault);
}
