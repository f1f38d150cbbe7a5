/* Image formats by mark and ending.
 *
 * Input is recognised by its first bytes, since files with a wrong ending and data without any are
 * common in glTF. Only formats on the list are handed to OpenImageIO: its own guessing would try
 * every decoder it has, from video to volumes, on data that nobody has vouched for. */
#include "imageio/format.h"

#include <ctype.h>
#include <string.h>

/* Deflate packs at most 1032 bytes into one, each of up to eight 1-bit pixels. JPEG (at least one
 * bit for a block of 64), run lengths and plain formats stay below that. */
enum { DEFLATE_BOUND = 1032 * 8 };
/* OpenEXR's DWAB leaves one number for 64 pixels and deflates those. */
enum { OPENEXR_BOUND = 1032 * 64 };

typedef struct magic {
    const char *bytes;
    uint32_t length;
    uint32_t offset;
    ppmi_image_format format;
} magic;

#define MARK(text) text, sizeof(text) - 1, 0
static const magic magics[] = {
    {MARK("\x89PNG\r\n\x1a\n"), {"PNG", "png", DEFLATE_BOUND, false}},
    {MARK("\xff\xd8\xff"), {"JPEG", "jpeg", DEFLATE_BOUND, false}},
    {MARK("\x76\x2f\x31\x01"), {"OpenEXR", "openexr", OPENEXR_BOUND, false}},
    {MARK("#?"), {"Radiance HDR", "hdr", DEFLATE_BOUND, false}},
    {MARK("II*\0"), {"TIFF", "tiff", 0, false}},
    {MARK("MM\0*"), {"TIFF", "tiff", 0, false}},
    {MARK("II+\0"), {"BigTIFF", "tiff", 0, false}},
    {MARK("MM\0+"), {"BigTIFF", "tiff", 0, false}},
    {"WEBP", 4, 8, {"WebP", "webp", 0, false}},
    {"ftypavif", 8, 4, {"AVIF", "heif", 0, false}},
    {"ftypheic", 8, 4, {"HEIC", "heif", 0, false}},
    {MARK("GIF8"), {"GIF", "gif", DEFLATE_BOUND, false}},
    {MARK("DDS "), {"DDS", "dds", DEFLATE_BOUND, true}},
    {MARK("BM"), {"BMP", "bmp", DEFLATE_BOUND, true}},
    {MARK("PF"), {"PFM", "pnm", DEFLATE_BOUND, false}},
    {MARK("Pf"), {"PFM", "pnm", DEFLATE_BOUND, false}},
    {MARK("P5"), {"PGM", "pnm", DEFLATE_BOUND, false}},
    {MARK("P6"), {"PPM", "pnm", DEFLATE_BOUND, false}},
    {MARK("\xabKTX "), {"KTX (Basis Universal)", NULL, 0, false}},
    {MARK("8BPS"), {"Photoshop", NULL, 0, false}},
    {MARK("\0\0\0\x0cjP  "), {"JPEG 2000", NULL, 0, false}},
    {MARK("\xff\x4f\xff\x51"), {"JPEG 2000", NULL, 0, false}},
};
#undef MARK

static const ppmi_image_format targa = {"Targa", "targa", DEFLATE_BOUND, false};

static bool ends_with(const char *name, const char *ending)
{
    const size_t name_length = strlen(name), ending_length = strlen(ending);
    if (name_length < ending_length) return false;
    const char *const tail = name + name_length - ending_length;
    for (size_t i = 0; i < ending_length; i++) {
        if (tolower((unsigned char)tail[i]) != ending[i]) return false;
    }
    return true;
}

const ppmi_image_format *ppmi_imageio_format_of_input(const void *bytes, size_t byte_count,
                                                      const char *name)
{
    for (size_t i = 0; i < sizeof magics / sizeof magics[0]; i++) {
        const magic *const mark = &magics[i];
        if (byte_count < mark->offset + mark->length) continue;
        if (memcmp((const char *)bytes + mark->offset, mark->bytes, mark->length) == 0) {
            return &mark->format;
        }
    }
    return ends_with(name, ".tga") ? &targa : NULL;
}

const ppmi_output_format *ppmi_imageio_format_of_output(const char *path)
{
    enum { U8 = 1 << PPMI_STORE_U8, U16 = 1 << PPMI_STORE_U16 };
    enum { FLOATS = 1 << PPMI_STORE_HALF | 1 << PPMI_STORE_FLOAT };
    static const struct {
        const char *ending;
        ppmi_output_format format;
    } formats[] = {
        {".exr", {"OpenEXR", "openexr", "zips", FLOATS, PPMI_STORE_FLOAT, true, true}},
        {".png", {"PNG", "png", NULL, U8 | U16, PPMI_STORE_U8, true, false}},
        {".jpg", {"JPEG", "jpeg", "jpeg:95", U8, PPMI_STORE_U8, false, false}},
        {".jpeg", {"JPEG", "jpeg", "jpeg:95", U8, PPMI_STORE_U8, false, false}},
        {".tif", {"TIFF", "tiff", "zip", U8 | U16, PPMI_STORE_U16, true, false}},
        {".tiff", {"TIFF", "tiff", "zip", U8 | U16, PPMI_STORE_U16, true, false}},
    };
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        if (ends_with(path, formats[i].ending)) return &formats[i].format;
    }
    return NULL;
}
