/* Images in and out: what is read, how large it may be, what alpha means and how values are
 * rounded. Encoding and decoding itself is OpenImageIO's work (oiio_shim.cpp). */
#include "imageio/imageio.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "imageio/dither.h"
#include "imageio/exr_check.h"
#include "imageio/file.h"
#include "imageio/format.h"
#include "imageio/heif_check.h"
#include "imageio/oiio_shim.h"
#include "imageio/png_check.h"
#include "imageio/png_cicp.h"

/* ---- reading --------------------------------------------------------------------------------- */

/* The channels that are read: count of them from first on. */
typedef struct kept_channels {
    int32_t first, count;
} kept_channels;

/* Without layers: the first four, and a fourth or second one only if it is alpha (an OpenEXR file
 * may hold RGB and depth). */
static int32_t count_without_layers(const ppmi_oiio_info *info)
{
    if (info->channels >= 4) return info->alpha_channel == 3 ? 4 : 3;
    if (info->channels == 3) return info->alpha_channel == 1 ? 2 : 3;
    return info->channels == 2 && info->alpha_channel == 1 ? 2 : 1;
}

/* The length of the layer's name in "layer.R", with its dot; 0 where there is none. */
static size_t layer_length(const char *name)
{
    const char *const dot = strrchr(name, '.');
    return dot ? (size_t)(dot + 1 - name) : 0;
}

/* Whether the channel at index is called like letter in the layer that layer begins with. */
static bool is_channel(const ppmi_oiio_reader *reader, const ppmi_oiio_info *info, int32_t index,
                       const char *layer, const char *letter)
{
    if (index >= info->channels) return false;
    const char *const name = ppmi_oiio_channel_name(reader, index);
    const size_t length = layer_length(layer);
    return layer_length(name) == length && strncmp(name, layer, length) == 0 &&
           strcmp(name + length, letter) == 0;
}

static bool begins_rgb(const ppmi_oiio_reader *reader, const ppmi_oiio_info *info, int32_t index)
{
    const char *const name = ppmi_oiio_channel_name(reader, index);
    return is_channel(reader, info, index, name, "R") &&
           is_channel(reader, info, index + 1, name, "G") &&
           is_channel(reader, info, index + 2, name, "B");
}

/* "Combined.R", "ViewLayer.Combined.R": what Blender calls the picture itself. */
static bool is_combined(const char *name)
{
    const char ending[] = "Combined.R";
    const size_t length = strlen(name), ending_length = sizeof ending - 1;
    return length >= ending_length && strcmp(name + length - ending_length, ending) == 0;
}

/* OpenImageIO puts the layer without a name first, and R, G, B, A of a layer side by side. */
static kept_channels channels_to_keep(const ppmi_oiio_reader *reader, const ppmi_oiio_info *info)
{
    int32_t first = -1;
    for (int32_t i = 0; i + 2 < info->channels; i++) {
        if (!begins_rgb(reader, info, i)) continue;
        const char *const name = ppmi_oiio_channel_name(reader, i);
        if (first < 0 || is_combined(name)) first = i;
        if (layer_length(name) == 0 || is_combined(name)) break;
    }
    if (first < 0 || layer_length(ppmi_oiio_channel_name(reader, first)) == 0) {
        return (kept_channels){0, count_without_layers(info)};
    }
    const char *const layer = ppmi_oiio_channel_name(reader, first);
    return (kept_channels){first, is_channel(reader, info, first + 3, layer, "A") ? 4 : 3};
}

/* Whether only a part of the picture is stored (OpenEXR's data window). Elsewhere offsets are
 * hints for page layout. */
static bool is_part(const ppmi_image_format *format, const ppmi_oiio_info *info)
{
    return strcmp(format->oiio, "openexr") == 0 &&
           (info->x != info->full_x || info->y != info->full_y || info->width != info->full_width ||
            info->height != info->full_height);
}

static ppm_status check_area(ppm_context *context, const char *name, int32_t width, int32_t height,
                             int32_t channels)
{
    const int64_t values_max = INT64_C(1) << 30;
    if (width <= 0 || height <= 0) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: an image of %d x %d pixels", name,
                         width, height);
    }
    if ((int64_t)width * height > values_max / channels) {
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: %d x %d pixels of %d channels are more than 2^30 values", name, width,
                         height, channels);
    }
    return PPM_STATUS_OK;
}

/* A header may claim any size. Before memory is taken, it must be one that so few bytes can hold
 * and that the renderer is ready to keep. */
static ppm_status check_header(ppm_context *context, const char *name,
                               const ppmi_image_format *format, size_t byte_count,
                               const ppmi_oiio_info *info, int32_t channels)
{
    if (info->is_deep) {
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED, "%s: deep images are not supported",
                         name);
    }
    if (info->channels < 1) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: an image without channels", name);
    }
    /* where the encoding has no bound, an even picture of 8k x 8k may be a few bytes; more than
     * that has to look like a picture */
    const double free_pixels = 0x1p26, usual_bound = 1032 * 8;
    const double pixels = (double)info->width * info->height;
    const double most = format->pixels_per_byte_max > 0
                            ? (double)format->pixels_per_byte_max * (double)byte_count
                            : fmax(free_pixels, usual_bound * (double)byte_count);
    if (pixels > most) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s: claims %d x %d pixels, more than its %zu bytes can hold", name,
                         info->width, info->height, byte_count);
    }
    const ppm_status status = check_area(context, name, info->width, info->height, channels);
    if (status != PPM_STATUS_OK || !is_part(format, info)) return status;
    return check_area(context, name, info->full_width, info->full_height, channels);
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Copies the stored pixels to their place in the full picture; the rest is zero. */
static void place_part(const ppmi_oiio_info *info, const uint8_t *part, size_t pixel_bytes,
                       uint8_t *full)
{
    const int64_t shift_x = (int64_t)info->x - info->full_x;
    const int64_t shift_y = (int64_t)info->y - info->full_y;
    const int64_t begin = larger(0, shift_x);
    const int64_t end = smaller(info->full_width, shift_x + info->width);
    memset(full, 0, (size_t)info->full_width * (size_t)info->full_height * pixel_bytes);
    if (end <= begin) return;
    for (int64_t y = 0; y < info->height; y++) {
        const int64_t full_y = y + shift_y;
        if (full_y < 0 || full_y >= info->full_height) continue;
        memcpy(full + (size_t)(full_y * info->full_width + begin) * pixel_bytes,
               part + (size_t)(y * info->width + begin - shift_x) * pixel_bytes,
               (size_t)(end - begin) * pixel_bytes);
    }
}

static void unassociate_u8(uint8_t *pixels, size_t pixel_count, uint32_t channels)
{
    for (size_t i = 0; i < pixel_count; i++) {
        uint8_t *const pixel = pixels + i * channels;
        const uint32_t alpha = pixel[channels - 1];
        if (alpha == 0 || alpha == 255) continue;
        for (uint32_t c = 0; c + 1 < channels; c++) {
            const uint32_t value = (pixel[c] * 255u + alpha / 2) / alpha;
            pixel[c] = (uint8_t)(value < 255 ? value : 255);
        }
    }
}

static void unassociate_f32(float *pixels, size_t pixel_count, uint32_t channels)
{
    for (size_t i = 0; i < pixel_count; i++) {
        float *const pixel = pixels + i * channels;
        const float alpha = pixel[channels - 1];
        if (!(alpha > 0) || alpha == 1) continue;
        for (uint32_t c = 0; c + 1 < channels; c++)
            pixel[c] /= alpha;
    }
}

static void unassociate(ppmi_pixels *pixels)
{
    const size_t pixel_count = (size_t)pixels->width * pixels->height;
    if (pixels->channels != 2 && pixels->channels != 4) return;
    if (pixels->u8) unassociate_u8(pixels->u8, pixel_count, pixels->channels);
    if (pixels->f32) unassociate_f32(pixels->f32, pixel_count, pixels->channels);
}

/* Decodes to a packed buffer of the full picture. */
static ppm_status decode_samples(ppm_context *context, ppmi_oiio_reader *reader, const char *name,
                                 const ppmi_image_format *format, const ppmi_oiio_info *info,
                                 kept_channels kept, void **out_samples)
{
    const size_t pixel_bytes = (size_t)kept.count * (info->is_u8 ? 1 : sizeof(float));
    void *stored = NULL, *full = NULL;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    /* zeroed: what a decoder leaves out of a damaged file must not be old memory */
    stored = ppmi_alloc_zeroed(context, (size_t)info->width * (size_t)info->height, pixel_bytes);
    if (!stored) goto fail_memory;
    status = ppmi_oiio_read(context, reader, name, kept.first, kept.count, info->is_u8, stored);
    if (status != PPM_STATUS_OK) goto fail;
    if (!is_part(format, info)) {
        *out_samples = stored;
        return PPM_STATUS_OK;
    }
    status = PPM_STATUS_OUT_OF_MEMORY;
    full = ppmi_alloc(context, (size_t)info->full_width * (size_t)info->full_height, pixel_bytes);
    if (!full) goto fail_memory;
    place_part(info, stored, pixel_bytes, full);
    ppmi_free(context, stored);
    *out_samples = full;
    return PPM_STATUS_OK;

fail_memory:
    ppmi_fail(context, status, "%s: no memory for %d x %d pixels", name, info->full_width,
              info->full_height);
fail:
    ppmi_free(context, stored);
    return status;
}

static void set_stored(const ppmi_oiio_info *info, bool part, ppmi_pixels *pixels)
{
    const int64_t shift_x = part ? (int64_t)info->x - info->full_x : 0;
    const int64_t shift_y = part ? (int64_t)info->y - info->full_y : 0;
    const int64_t begin_x = larger(0, shift_x), begin_y = larger(0, shift_y);
    pixels->stored_x = (uint32_t)smaller(begin_x, pixels->width);
    pixels->stored_y = (uint32_t)smaller(begin_y, pixels->height);
    pixels->stored_width =
        (uint32_t)larger(0, smaller(pixels->width, shift_x + info->width) - begin_x);
    pixels->stored_height =
        (uint32_t)larger(0, smaller(pixels->height, shift_y + info->height) - begin_y);
}

static ppm_status decode(ppm_context *context, ppmi_oiio_reader *reader, const char *name,
                         const ppmi_image_format *format, size_t byte_count,
                         const ppmi_oiio_info *info, ppmi_pixels *out_pixels)
{
    const kept_channels kept = channels_to_keep(reader, info);
    ppm_status status = check_header(context, name, format, byte_count, info, kept.count);
    if (status != PPM_STATUS_OK) return status;
    void *samples = NULL;
    status = decode_samples(context, reader, name, format, info, kept, &samples);
    if (status != PPM_STATUS_OK) return status;
    const bool part = is_part(format, info);
    *out_pixels = (ppmi_pixels){
        .width = (uint32_t)(part ? info->full_width : info->width),
        .height = (uint32_t)(part ? info->full_height : info->height),
        .channels = (uint32_t)kept.count,
        .u8 = info->is_u8 ? samples : NULL,
        .f32 = info->is_u8 ? NULL : samples,
        .is_linear = info->is_float,
        .has_chromaticities = info->has_chromaticities,
    };
    memcpy(out_pixels->chromaticities, info->chromaticities, sizeof info->chromaticities);
    memcpy(out_pixels->color_space, info->color_space, sizeof info->color_space);
    set_stored(info, part, out_pixels);
    if (info->is_associated && !format->keeps_alpha_straight) unassociate(out_pixels);
    return PPM_STATUS_OK;
}

static ppm_status open_and_decode(ppm_context *context, const ppmi_image_format *format,
                                  const void *bytes, size_t byte_count, const char *name,
                                  ppmi_pixels *out_pixels)
{
    ppmi_oiio_reader *reader = NULL;
    ppmi_oiio_info info;
    ppm_status status =
        ppmi_oiio_open(context, format->oiio, bytes, byte_count, name, &reader, &info);
    if (status != PPM_STATUS_OK) return status;
    status = decode(context, reader, name, format, byte_count, &info, out_pixels);
    ppmi_oiio_close(reader);
    return status;
}

/* The decoder gets the end that the file lacks. */
static ppm_status read_cut_png(ppm_context *context, const ppmi_image_format *format,
                               const void *bytes, size_t byte_count, const char *name,
                               ppmi_pixels *out_pixels)
{
    uint8_t *const whole = ppmi_alloc(context, byte_count + PPMI_PNG_END_BYTES, 1);
    if (!whole) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to read it", name);
    }
    memcpy(whole, bytes, byte_count);
    memcpy(whole + byte_count, ppmi_imageio_png_end, PPMI_PNG_END_BYTES);
    const ppm_status status =
        open_and_decode(context, format, whole, byte_count + PPMI_PNG_END_BYTES, name, out_pixels);
    ppmi_free(context, whole);
    if (status != PPM_STATUS_OK) return status;
    out_pixels->is_cut = true;
    ppmi_log(context, PPM_LOG_WARNING,
             "%s: the PNG file ends at byte %zu without the chunk that says so (IEND); its pixels "
             "are all there",
             name, byte_count);
    return PPM_STATUS_OK;
}

ppm_status ppmi_imageio_read_memory(ppm_context *context, const void *bytes, size_t byte_count,
                                    const char *name, ppmi_pixels *out_pixels)
{
    size_t cut_at = 0;
    if (!bytes || byte_count == 0) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: no image data", name);
    }
    const ppmi_image_format *const format = ppmi_imageio_format_of_input(bytes, byte_count, name);
    if (!format) {
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED, "%s: not a known image format",
                         name);
    }
    if (!format->oiio) {
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED, "%s: %s images are not supported",
                         name, format->label);
    }
    ppm_status status = PPM_STATUS_OK;
    if (strcmp(format->oiio, "png") == 0) {
        status = ppmi_imageio_png_check(context, bytes, byte_count, name, &cut_at);
    } else if (strcmp(format->oiio, "heif") == 0) {
        status = ppmi_imageio_heif_check(context, bytes, byte_count, name);
    } else if (strcmp(format->oiio, "openexr") == 0) {
        status = ppmi_imageio_exr_check(context, bytes, byte_count, name);
    }
    if (status != PPM_STATUS_OK) return status;
    if (cut_at > 0) return read_cut_png(context, format, bytes, cut_at, name, out_pixels);
    return open_and_decode(context, format, bytes, byte_count, name, out_pixels);
}

ppm_status ppmi_imageio_read_file(ppm_context *context, const char *path, const char *name,
                                  ppmi_pixels *out_pixels)
{
    void *bytes = NULL;
    size_t byte_count = 0;
    ppm_status status = ppmi_imageio_file_read(context, path, name, &bytes, &byte_count);
    if (status != PPM_STATUS_OK) return status;
    status = ppmi_imageio_read_memory(context, bytes, byte_count, name, out_pixels);
    ppmi_free(context, bytes);
    return status;
}

void ppmi_imageio_pixels_free(ppm_context *context, ppmi_pixels *pixels)
{
    if (!pixels) return;
    ppmi_free(context, pixels->u8);
    ppmi_free(context, pixels->f32);
    *pixels = (ppmi_pixels){0};
}

/* ---- writing --------------------------------------------------------------------------------- */

/* 0..1 to 0..top, to the nearest; not-a-number becomes 0. */
static uint32_t quantised(float value, float top)
{
    if (!(value > 0)) return 0;
    return (uint32_t)((value < 1 ? value : 1) * top + 0.5f);
}

/* Half ends at 65504; what is brighter must not become infinite. */
static float within_half(float value)
{
    const float half_max = 65504;
    return isnan(value) ? value : fminf(fmaxf(value, -half_max), half_max);
}

static void store_value(void *samples, size_t index, int32_t store, float value)
{
    switch (store) {
    case PPMI_STORE_U8:
        ((uint8_t *)samples)[index] = (uint8_t)quantised(value, 255);
        break;
    case PPMI_STORE_U16:
        ((uint16_t *)samples)[index] = (uint16_t)quantised(value, 65535);
        break;
    case PPMI_STORE_HALF:
        ((float *)samples)[index] = within_half(value);
        break;
    default:
        ((float *)samples)[index] = value;
    }
}

static float noise_at(const ppmi_image_file *file, size_t pixel, float value)
{
    const float clamped = value > 0 ? fminf(value, 1) : 0, top = 255;
    return clamped - value +
           ppmi_dither(file->x + (uint32_t)(pixel % file->width),
                       file->y + (uint32_t)(pixel / file->width), clamped * top, top) /
               top;
}

/* The first channels of each pixel as the values that the file will hold. */
static void *make_samples(ppm_context *context, const ppmi_image_file *file, uint32_t channels)
{
    const size_t pixel_count = (size_t)file->width * file->height;
    const size_t sample_bytes = file->store == PPMI_STORE_U8    ? sizeof(uint8_t)
                                : file->store == PPMI_STORE_U16 ? sizeof(uint16_t)
                                                                : sizeof(float);
    void *const samples = ppmi_alloc(context, pixel_count, channels * sample_bytes);
    if (!samples) return NULL;
    const bool is_dithered = file->is_dithered && file->store == PPMI_STORE_U8;
    const uint32_t colors = channels % 2 == 0 ? channels - 1 : channels; /* alpha has no bands */
    for (size_t i = 0; i < pixel_count; i++) {
        for (uint32_t c = 0; c < channels; c++) {
            const float value = file->pixels[i * file->channels + c];
            const float noise = is_dithered && c < colors ? noise_at(file, i, value) : 0.0f;
            store_value(samples, i * channels + c, file->store, value + noise);
        }
    }
    return samples;
}

static ppm_status find_format(ppm_context *context, const char *path,
                              const ppmi_output_format **out_format)
{
    *out_format = ppmi_imageio_format_of_output(path);
    if (*out_format) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                     "%s: pictures can be written as .exr .png .jpg .jpeg .tif .tiff", path);
}

static ppm_status add_cicp(ppm_context *context, const char *path, const uint8_t cicp[4],
                           void **bytes, size_t *byte_count)
{
    uint8_t *const tagged = ppmi_alloc(context, *byte_count + PPMI_PNG_CICP_BYTES, 1);
    if (!tagged) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it", path);
    }
    ppmi_png_add_cicp(*bytes, *byte_count, cicp, tagged);
    ppmi_free(context, *bytes);
    *bytes = tagged;
    *byte_count += PPMI_PNG_CICP_BYTES;
    return PPM_STATUS_OK;
}

/* "jpeg:95" as OpenImageIO takes it, in text where another quality is asked for. */
static const char *compression_of(const ppmi_output_format *format, const ppmi_image_file *file,
                                  char *text, size_t size)
{
    if (strcmp(format->oiio, "jpeg") != 0 || file->jpeg_quality == 0) return format->compression;
    snprintf(text, size, "jpeg:%u", (unsigned)file->jpeg_quality);
    return text;
}

ppm_status ppmi_imageio_write_file(ppm_context *context, const char *path,
                                   const ppmi_image_file *file)
{
    const ppmi_output_format *format = NULL;
    ppm_status status = find_format(context, path, &format);
    if (status != PPM_STATUS_OK) return status;
    if ((format->stores & 1u << file->store) == 0) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "%s: %s cannot store such pixels",
                         path, format->label);
    }
    ppmi_image_file stored = *file;
    if (!format->has_alpha && stored.channels > 3) stored.channels = 3;
    if (!format->has_alpha && stored.channels == 2) stored.channels = 1;
    void *const samples = make_samples(context, file, stored.channels);
    if (!samples) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it", path);
    }
    void *bytes = NULL;
    size_t byte_count = 0;
    char compression[16];
    status = ppmi_oiio_encode(context, format->oiio,
                              compression_of(format, file, compression, sizeof compression), path,
                              &stored, samples, &bytes, &byte_count);
    ppmi_free(context, samples);
    if (status == PPM_STATUS_OK && file->has_cicp && strcmp(format->oiio, "png") == 0) {
        status = add_cicp(context, path, file->cicp, &bytes, &byte_count);
    }
    if (status == PPM_STATUS_OK) {
        status = ppmi_imageio_file_replace(context, path, bytes, byte_count);
    }
    ppmi_free(context, bytes);
    return status;
}

ppm_status ppmi_imageio_check_output(ppm_context *context, const char *path)
{
    const ppmi_output_format *format = NULL;
    const ppm_status status = find_format(context, path, &format);
    return status == PPM_STATUS_OK ? ppmi_imageio_file_check(context, path) : status;
}

const char *ppmi_imageio_version(void)
{
    return ppmi_oiio_version();
}
