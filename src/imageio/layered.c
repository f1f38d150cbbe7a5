/* Strips of rows between who knows the pixels and the encoder, each converted and let go. */
#include "imageio/layered.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "imageio/file.h"
#include "imageio/oiio_shim.h"
#include "imageio/ringing.h"

/* Rows that are held at once: whole rows of tiles, and of the largest block that a compression has
 * but DWAB's; no more than some 64 MiB. */
static uint32_t strip_rows(const ppmi_layered_file *file, uint32_t channels)
{
    const size_t strip_values = (size_t)1 << 24, blocks = 32;
    const size_t unit = file->tile_side > 0 ? file->tile_side : 1;
    const size_t row_values = (size_t)file->width * channels;
    size_t rows = strip_values / row_values;
    if (rows >= blocks && blocks % unit == 0) rows -= rows % blocks;
    rows -= rows % unit;
    if (rows < unit) rows = unit;
    return rows < file->height ? (uint32_t)rows : file->height;
}

static const char *compression_of(const ppmi_layered_file *file, const ppmi_layered_part *part)
{
    return part->compression ? part->compression : file->compression;
}

/* Half floats end at 65504; what is brighter must not become infinite. DWAA and DWAB make halves of
 * all that they transform. */
static void fit_halves(const ppmi_layered_part *part, bool has_ringing, size_t pixel_count,
                       float *values)
{
    const float half_max = 65504;
    for (uint32_t c = 0; c < part->channel_count; c++) {
        if (part->channels[c].store != PPMI_STORE_HALF && !has_ringing) continue;
        for (size_t i = 0; i < pixel_count; i++) {
            float *const value = &values[i * part->channel_count + c];
            if (!isnan(*value)) *value = fminf(fmaxf(*value, -half_max), half_max);
        }
    }
}

static ppm_status fit_rows(ppm_context *context, const char *path, const ppmi_layered_file *file,
                           const ppmi_layered_part *part, uint32_t row_count, float *values)
{
    const char *const compression = compression_of(file, part);
    const bool has_ringing = ppmi_layered_has_ringing(compression);
    fit_halves(part, has_ringing, (size_t)row_count * file->width, values);
    if (!has_ringing) return PPM_STATUS_OK;
    const ppmi_ringing_strip strip = {.path = path,
                                      .compression = compression,
                                      .part = part,
                                      .tile_side = file->tile_side,
                                      .width = file->width,
                                      .row_count = row_count,
                                      .values = values};
    return ppmi_imageio_limit_ringing(context, &strip);
}

static ppm_status write_part(ppm_context *context, const char *path, const ppmi_layered_file *file,
                             uint32_t index, ppmi_oiio_writer *writer)
{
    const ppmi_layered_part *const part = &file->parts[index];
    const uint32_t rows_max = strip_rows(file, part->channel_count);
    const size_t row_values = (size_t)file->width * part->channel_count;
    float *const values = ppmi_alloc(context, row_values, rows_max * sizeof *values);
    if (!values) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY,
                         "%s: no memory for %u rows of %u pixels", path, rows_max, file->width);
    }
    ppm_status status = ppmi_oiio_begin_part(context, writer, path, index);
    for (uint32_t y = 0; y < file->height && status == PPM_STATUS_OK; y += rows_max) {
        const uint32_t left = file->height - y, rows = left < rows_max ? left : rows_max;
        status = file->read_rows(file->user, index, y, rows, values);
        if (status != PPM_STATUS_OK) break;
        status = fit_rows(context, path, file, part, rows, values);
        if (status != PPM_STATUS_OK) break;
        status = ppmi_oiio_write_rows(context, writer, path, y, rows, values);
    }
    ppmi_free(context, values);
    return status;
}

/* What the encoder says is "write error"; what the system said is the reason. */
static int write_bytes(void *user, const void *bytes, size_t byte_count, uint64_t offset)
{
    return ppmi_imageio_file_write_at(user, bytes, byte_count, offset);
}

/* Parts are written by OpenEXR's own stream, which does not tell when its last bytes find no room:
 * what can be read again is there. */
static ppm_status check_last_row(ppm_context *context, const char *path, const char *temporary,
                                 const ppmi_layered_file *file, uint32_t index)
{
    const size_t row_values = (size_t)file->width * file->parts[index].channel_count;
    ppm_context *const quiet = NULL; /* the reason that is told is the writer's */
    ppmi_oiio_part *part = NULL;
    ppmi_oiio_part_info info;
    float *const row = ppmi_alloc(context, row_values, sizeof *row);
    if (!row) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to check it", path);
    }
    ppm_status status = ppmi_oiio_part_open(quiet, temporary, index, &part, &info);
    if (status == PPM_STATUS_OK) {
        status = ppmi_oiio_part_read(quiet, part, temporary, file->height - 1, 1, row);
    }
    ppmi_oiio_part_close(part);
    ppmi_free(context, row);
    if (status == PPM_STATUS_OK) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_OUTPUT_NOT_WRITABLE,
                     "%s: cannot be written: it is not whole; is the disk full?", path);
}

ppm_status ppmi_imageio_write_layered(ppm_context *context, const char *path,
                                      const ppmi_layered_file *file)
{
    ppmi_file_replacement *replacement = NULL;
    ppmi_oiio_writer *writer = NULL;
    ppm_status status = ppmi_imageio_file_begin(context, path, &replacement);
    if (status != PPM_STATUS_OK) return status;
    const char *const temporary = ppmi_imageio_file_temporary(replacement);
    const ppmi_oiio_sink sink = {.path = temporary, .write = write_bytes, .user = replacement};
    status = ppmi_oiio_create_layered(context, path, file, &sink, &writer);
    for (uint32_t i = 0; i < file->part_count && status == PPM_STATUS_OK; i++)
        status = write_part(context, path, file, i, writer);
    if (writer) {
        const ppm_status closed =
            ppmi_oiio_close_writer(context, writer, path, status == PPM_STATUS_OK);
        if (status == PPM_STATUS_OK) status = closed;
    }
    for (uint32_t i = 0; i < file->part_count && file->part_count > 1; i++) {
        if (status == PPM_STATUS_OK) status = check_last_row(context, path, temporary, file, i);
    }
    if (status == PPM_STATUS_OK) return ppmi_imageio_file_finish(context, replacement);
    ppmi_imageio_file_cancel(context, replacement);
    return status;
}
