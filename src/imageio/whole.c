/* What is written last tells that a file was finished: a copy that broke off, a disk that was full
 * or a program that was killed leave the beginning. */
#include "imageio/whole.h"

#include <string.h>

#include "imageio/file.h"
#include "imageio/format.h"
#include "imageio/imageio.h"
#include "imageio/layered_input.h"
#include "imageio/png_check.h"

/* Errors are answers here. */
static ppm_context *const quiet = NULL;

static bool is_whole_exr(const char *path, uint32_t *width, uint32_t *height)
{
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    bool is_whole = false;
    if (ppmi_layered_input_open(quiet, path, &input, &info) != PPM_STATUS_OK) return false;
    float *const row = ppmi_alloc(quiet, (size_t)info.width * info.channel_count, sizeof *row);
    if (row) {
        is_whole = ppmi_layered_input_read(quiet, input, info.height - 1, 1, row) == PPM_STATUS_OK;
    }
    *width = info.full_width;
    *height = info.full_height;
    ppmi_free(quiet, row);
    ppmi_layered_input_close(quiet, input);
    return is_whole;
}

static bool ends_with(const uint8_t *bytes, size_t count, const void *end, size_t length)
{
    return count >= length && memcmp(bytes + count - length, end, length) == 0;
}

/* The size of a PNG is in its first chunk (PNG specification, 11.2.1). */
static bool is_whole_png(const uint8_t *bytes, size_t count, uint32_t size[2])
{
    if (count < 33 || !ends_with(bytes, count, ppmi_imageio_png_end, PPMI_PNG_END_BYTES)) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        const uint8_t *const at = bytes + 16 + 4 * i;
        size[i] = (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
    }
    return memcmp(bytes, "\x89PNG", 4) == 0;
}

static bool is_whole_other(const uint8_t *bytes, size_t count, const char *path, uint32_t size[2])
{
    ppmi_pixels pixels = {0};
    if (ppmi_imageio_read_memory(quiet, bytes, count, path, &pixels) != PPM_STATUS_OK) return false;
    size[0] = pixels.width;
    size[1] = pixels.height;
    ppmi_imageio_pixels_free(quiet, &pixels);
    return true;
}

bool ppmi_imageio_is_whole(const char *path, uint32_t *out_width, uint32_t *out_height)
{
    const ppmi_output_format *const format = ppmi_imageio_format_of_output(path);
    uint32_t size[2] = {0, 0};
    void *bytes = NULL;
    size_t count = 0;
    bool is_whole = false;
    if (!format) return false;
    if (format->is_scene_linear) {
        is_whole = is_whole_exr(path, &size[0], &size[1]);
    } else if (ppmi_imageio_file_read(quiet, path, path, &bytes, &count) == PPM_STATUS_OK) {
        const bool is_png = strcmp(format->oiio, "png") == 0;
        const bool is_jpeg = strcmp(format->oiio, "jpeg") == 0;
        if (is_png) is_whole = is_whole_png(bytes, count, size);
        if (is_jpeg && !ends_with(bytes, count, "\xff\xd9", 2)) count = 0;
        if (!is_png && count > 0) is_whole = is_whole_other(bytes, count, path, size);
    }
    ppmi_free(quiet, bytes);
    if (out_width) *out_width = size[0];
    if (out_height) *out_height = size[1];
    return is_whole;
}
