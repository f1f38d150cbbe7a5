/* OpenEXR's DWA compressions (ImfDwaCompressor.h) bring colours to a logarithmic scale above 1,
 *
 *     f(x) = ln(x) / 2.2 + 1,
 *
 * transform blocks of 8 x 8 by a cosine transform, of Y'CbCr where there are R, G and B, and drop
 * bits of the coefficients within LEVEL / 100000 times the tables of JPEG (ITU-T T.81, K.1 and K.2)
 * over their least entries. What comes back overshoots beside edges, and beyond f(65504) the
 * inverse is infinite: an error of 0.01 is 2 %.
 *
 * The transform is orthonormal, so an error of the coefficients whose sum of squares is e^2 moves
 * no pixel by more than e. The norms of JPEG's tables, 561 for K.1 and 728 for K.2, give at most 56
 * LEVEL 1e-5 for Y and 43 LEVEL 1e-5 for Cb and Cr, of which B gets 1.86. Below what that allows
 * nothing is to be done. Above it the rows are encoded and read back, and what is infinite, and its
 * neighbours in the block, are lowered, until all is finite. */
#include "imageio/ringing.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "imageio/oiio_shim.h"

enum { BLOCK = 8, ATTEMPTS_MAX = 40 };

static const float half_max = 65504;

bool ppmi_layered_has_ringing(const char *compression)
{
    return compression && strncmp(compression, "dwa", 3) == 0;
}

/* The largest value that is certain to be read as finite. */
static float certain_limit(const char *compression)
{
    const char *const colon = strchr(compression, ':');
    const float level = colon ? strtof(colon + 1, NULL) : 45.0f;
    const float of_tables = (56.0f + 1.86f * 43.0f) * 1e-5f, of_halves = 0.05f;
    return half_max * expf(-2.2f * (level * of_tables + of_halves));
}

static size_t value_count(const ppmi_ringing_strip *strip)
{
    return (size_t)strip->width * strip->row_count * strip->part->channel_count;
}

static bool is_certain(const ppmi_ringing_strip *strip)
{
    const float limit = certain_limit(strip->compression);
    const size_t count = value_count(strip);
    for (size_t i = 0; i < count; i++) {
        if (fabsf(strip->values[i]) > limit) return false;
    }
    return true;
}

/* ---- encoding in memory ---------------------------------------------------------------------- */

typedef struct buffer {
    ppm_context *context;
    char *bytes;
    size_t count, capacity;
} buffer;

static int write_bytes(void *user, const void *bytes, size_t byte_count, uint64_t offset)
{
    buffer *const b = user;
    const size_t end = (size_t)offset + byte_count;
    if (end > b->capacity) {
        const size_t capacity = end > 2 * b->capacity ? end : 2 * b->capacity;
        char *const grown = ppmi_alloc_zeroed(b->context, capacity, 1);
        if (!grown) return ENOMEM;
        if (b->count > 0) memcpy(grown, b->bytes, b->count);
        ppmi_free(b->context, b->bytes);
        b->bytes = grown;
        b->capacity = capacity;
    }
    memcpy(b->bytes + offset, bytes, byte_count);
    if (end > b->count) b->count = end;
    return 0;
}

static ppm_status encode(ppm_context *context, const ppmi_ringing_strip *strip, buffer *out)
{
    ppmi_layered_part part = *strip->part;
    part.name = NULL;
    const ppmi_layered_file file = {.width = strip->width,
                                    .height = strip->row_count,
                                    .compression = strip->compression,
                                    .tile_side = strip->tile_side,
                                    .part_count = 1,
                                    .parts = &part};
    const ppmi_oiio_sink sink = {.path = strip->path, .write = write_bytes, .user = out};
    ppmi_oiio_writer *writer = NULL;
    ppm_status status = ppmi_oiio_create_layered(context, strip->path, &file, &sink, &writer);
    if (status != PPM_STATUS_OK) return status;
    status = ppmi_oiio_begin_part(context, writer, strip->path, 0);
    if (status == PPM_STATUS_OK) {
        status =
            ppmi_oiio_write_rows(context, writer, strip->path, 0, strip->row_count, strip->values);
    }
    const ppm_status closed =
        ppmi_oiio_close_writer(context, writer, strip->path, status == PPM_STATUS_OK);
    return status == PPM_STATUS_OK ? closed : status;
}

/* Which channel of the part a channel of the file is; the file has them in the order of OpenEXR. */
static uint32_t channel_of(const ppmi_ringing_strip *strip, const char *name)
{
    uint32_t c = 0;
    while (c + 1 < strip->part->channel_count && strcmp(strip->part->channels[c].name, name) != 0)
        c++;
    return c;
}

static ppm_status decode(ppm_context *context, const ppmi_ringing_strip *strip, const buffer *from,
                         float *out, uint32_t *out_channels)
{
    ppmi_oiio_reader *reader = NULL;
    ppmi_oiio_info info;
    ppm_status status =
        ppmi_oiio_open(context, "openexr", from->bytes, from->count, strip->path, &reader, &info);
    if (status != PPM_STATUS_OK) return PPM_STATUS_OUTPUT_NOT_WRITABLE;
    const int32_t count = (int32_t)strip->part->channel_count;
    for (int32_t c = 0; c < count; c++)
        out_channels[c] = channel_of(strip, ppmi_oiio_channel_name(reader, c));
    status = ppmi_oiio_read(context, reader, strip->path, 0, count, false, out);
    ppmi_oiio_close(reader);
    return status == PPM_STATUS_OK ? status : PPM_STATUS_OUTPUT_NOT_WRITABLE;
}

/* ---- lowering -------------------------------------------------------------------------------- */

/* All that may be in one block with a pixel. */
static void lower_around(const ppmi_ringing_strip *strip, uint32_t x, uint32_t y, float limit)
{
    const uint32_t reach = BLOCK - 1, channels = strip->part->channel_count;
    const uint32_t x0 = x > reach ? x - reach : 0, y0 = y > reach ? y - reach : 0;
    const uint32_t x1 = x + reach < strip->width ? x + reach : strip->width - 1;
    const uint32_t y1 = y + reach < strip->row_count ? y + reach : strip->row_count - 1;
    for (uint32_t row = y0; row <= y1; row++) {
        float *const values = strip->values + ((size_t)row * strip->width + x0) * channels;
        for (size_t i = 0; i < (size_t)(x1 - x0 + 1) * channels; i++) {
            if (!isnan(values[i])) values[i] = fminf(fmaxf(values[i], -limit), limit);
        }
    }
}

/* Whether all that is finite is read so; else it is lowered. */
static bool lower(const ppmi_ringing_strip *strip, const float *read, const uint32_t *channels,
                  float limit)
{
    const uint32_t count = strip->part->channel_count;
    bool is_finite = true;
    for (size_t i = 0; i < value_count(strip); i++) {
        if (isfinite(read[i])) continue;
        const size_t pixel = i / count;
        if (!isfinite(strip->values[pixel * count + channels[i % count]])) continue;
        is_finite = false;
        lower_around(strip, (uint32_t)(pixel % strip->width), (uint32_t)(pixel / strip->width),
                     limit);
    }
    return is_finite;
}

static ppm_status try_until_finite(ppm_context *context, const ppmi_ringing_strip *strip,
                                   float *read, uint32_t *channels)
{
    ppm_status status = PPM_STATUS_OK;
    bool is_finite = false;
    float limit = half_max;
    for (int i = 0; i < ATTEMPTS_MAX && !is_finite && status == PPM_STATUS_OK; i++) {
        buffer encoded = {.context = context};
        limit *= 0.75f;
        status = encode(context, strip, &encoded);
        if (status == PPM_STATUS_OK) status = decode(context, strip, &encoded, read, channels);
        if (status == PPM_STATUS_OK) is_finite = lower(strip, read, channels, limit);
        ppmi_free(context, encoded.bytes);
    }
    return status;
}

ppm_status ppmi_imageio_limit_ringing(ppm_context *context, const ppmi_ringing_strip *strip)
{
    if (is_certain(strip)) return PPM_STATUS_OK;
    float *const read = ppmi_alloc(context, value_count(strip), sizeof *read);
    uint32_t *const channels = ppmi_alloc(context, strip->part->channel_count, sizeof *channels);
    const ppm_status status =
        read && channels ? try_until_finite(context, strip, read, channels)
                         : ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY,
                                     "%s: no memory to look at what is bright", strip->path);
    ppmi_free(context, channels);
    ppmi_free(context, read);
    return status;
}
