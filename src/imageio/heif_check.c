/* AVIF and HEIC: the size is in "ispe" boxes (ISO/IEC 23008-12, 6.5.3), one for each item of the
 * file: 20 bytes of length, name, version and flags, width and height. The name alone is searched
 * for: a box of another kind that holds these letters by chance makes a size that is checked too.
 */
#include "imageio/heif_check.h"

#include <stdint.h>
#include <string.h>

enum { AFTER_NAME = 16 }; /* name, version and flags, width, height */

static uint32_t big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static bool is_size(const uint8_t *box)
{
    return memcmp(box - 4, "\0\0\0\x14ispe\0\0\0\0", 12) == 0;
}

ppm_status ppmi_imageio_heif_check(ppm_context *context, const void *bytes, size_t byte_count,
                                   const char *name)
{
    const uint64_t most = UINT64_C(1) << 26;
    const uint8_t *const file = bytes;
    bool has_size = false;
    for (size_t i = 4; i + AFTER_NAME <= byte_count; i++) {
        if (file[i] != 'i' || !is_size(file + i)) continue;
        const uint32_t width = big_endian(file + i + 8), height = big_endian(file + i + 12);
        has_size = true;
        if (width == 0 || height == 0) {
            return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: an image of %u x %u pixels",
                             name, width, height);
        }
        if ((uint64_t)width * height > most) {
            return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED,
                             "%s: %u x %u pixels are more than 2^26, the most that is read of "
                             "this format",
                             name, width, height);
        }
    }
    if (has_size) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: the file says no size", name);
}
