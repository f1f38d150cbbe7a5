/* "OpenEXR File Layout": behind magic number and version come attributes, each a name and a type,
 * both ended by a zero, a size in four bytes, the lowest first, and so many bytes. An empty name
 * ends a header, an empty header those of a file of many parts. */
#include "imageio/exr_check.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { HEADERS_AT = 8, VERSION_AT = 5, MANY_PARTS = 1 << 4 /* bit 12 of the version */ };

/* Moves *at behind a zero-ended text; false when there is no end of it. */
static bool skip_text(const uint8_t *bytes, size_t count, size_t *at)
{
    const uint8_t *const end = memchr(bytes + *at, 0, count - *at);
    if (!end) return false;
    *at = (size_t)(end - bytes) + 1;
    return true;
}

/* Moves *at behind an attribute. */
static bool skip_attribute(const uint8_t *bytes, size_t count, size_t *at)
{
    if (!skip_text(bytes, count, at) || !skip_text(bytes, count, at)) return false;
    if (count - *at < 4) return false;
    const uint8_t *const size = bytes + *at;
    const uint32_t length = (uint32_t)size[0] | (uint32_t)size[1] << 8 | (uint32_t)size[2] << 16 |
                            (uint32_t)size[3] << 24;
    *at += 4;
    if (length > count - *at) return false;
    *at += length;
    return true;
}

ppm_status ppmi_imageio_exr_check(ppm_context *context, const void *bytes, size_t byte_count,
                                  const char *name)
{
    const uint8_t *const file = bytes;
    const bool has_parts = byte_count > VERSION_AT && (file[VERSION_AT] & MANY_PARTS) != 0;
    bool is_empty = true; /* the header that is being read */
    for (size_t at = HEADERS_AT; at < byte_count;) {
        if (file[at] == 0) {
            if (!has_parts || is_empty) return PPM_STATUS_OK;
            is_empty = true;
            at++;
            continue;
        }
        is_empty = false;
        const size_t begin = at;
        if (!skip_attribute(file, byte_count, &at)) {
            return ppmi_fail(
                context, PPM_STATUS_INPUT_INVALID,
                "%s: attribute '%.40s' of its header is larger than the file, or cut "
                "off",
                name,
                memchr(file + begin, 0, byte_count - begin) ? (const char *)file + begin : "?");
        }
    }
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: its header is cut off", name);
}
