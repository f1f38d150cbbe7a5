/* Supercompression of KTX files (KTX 2.0, 3.8): the whole level in one stream. */
#include "gltf/ktx2.h"

#if PPM_HAS_ZLIB
#include <zlib.h>
#endif
#if PPM_HAS_ZSTD
#include <zstd.h>
#endif

enum { ZSTANDARD = 2, ZLIB = 3 };

#if PPM_HAS_ZSTD
static bool unpack_zstandard(const unsigned char *bytes, size_t count, unsigned char *out,
                             size_t out_count)
{
    /* an error is a size that no level has */
    return ZSTD_decompress(out, out_count, bytes, count) == out_count;
}
#endif

#if PPM_HAS_ZLIB
static bool unpack_zlib(const unsigned char *bytes, size_t count, unsigned char *out,
                        size_t out_count)
{
    uLongf length = (uLongf)out_count;
    return uncompress(out, &length, bytes, (uLong)count) == Z_OK && length == out_count;
}
#endif

ppm_status ppmi_ktx2_unpack(uint32_t scheme, const unsigned char *bytes, size_t count,
                            unsigned char *out, size_t out_count, const char **reason)
{
    bool is_whole = false;
#if !PPM_HAS_ZSTD || !PPM_HAS_ZLIB
    (void)bytes, (void)count, (void)out, (void)out_count;
#endif
    switch (scheme) {
#if PPM_HAS_ZSTD
    case ZSTANDARD:
        is_whole = unpack_zstandard(bytes, count, out, out_count);
        break;
#else
    case ZSTANDARD:
        *reason = "the picture is packed by Zstandard, and this build has no libzstd";
        return PPM_STATUS_INPUT_UNSUPPORTED;
#endif
#if PPM_HAS_ZLIB
    case ZLIB:
        is_whole = unpack_zlib(bytes, count, out, out_count);
        break;
#else
    case ZLIB:
        *reason = "the picture is packed by ZLIB, and this build has no zlib";
        return PPM_STATUS_INPUT_UNSUPPORTED;
#endif
    default:
        *reason = "the picture is packed in a way that is not known";
        return PPM_STATUS_INPUT_UNSUPPORTED;
    }
    if (is_whole) return PPM_STATUS_OK;
    *reason = "the packed picture is broken, or not of the size that the header says";
    return PPM_STATUS_INPUT_INVALID;
}
