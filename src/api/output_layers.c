/* Layers are read from the session one by one. A file of one part interleaves them, so all are held
 * while it is written; one of many parts needs only the one that is being written.
 *
 * A lossy compression is for light alone: DWAA and DWAB transform whatever ends in R, G, B or Y,
 * and PXR24 rounds every float. Layers of other numbers then are parts of their own, without loss.
 */
#include "api/output_layers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "api/layer_channels.h"
#include "imageio/layered.h"

enum { TILE_LEAST = 16, TILE_MOST = 4096 };

/* ---- options --------------------------------------------------------------------------------- */

static bool has_level(int32_t compression)
{
    return compression == PPM_COMPRESSION_DWAA || compression == PPM_COMPRESSION_DWAB;
}

ppm_status ppmi_output_layers_check(ppm_context *context, const ppm_output_options *options)
{
    const float level = options->compression_level;
    if (options->compression < PPM_COMPRESSION_DEFAULT ||
        options->compression > PPM_COMPRESSION_DWAB) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "ppm_output_options.compression is %d", options->compression);
    }
    if (!(level >= 0 && level <= 10000) || (level > 0 && !has_level(options->compression))) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "ppm_output_options.compression_level is %g; expected 0, or up to 10000 "
                         "with DWAA and DWAB",
                         (double)level);
    }
    if (options->tile_side > 0 &&
        (options->tile_side < TILE_LEAST || options->tile_side > TILE_MOST)) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "ppm_output_options.tile_side is %u; expected %d to %d",
                         options->tile_side, TILE_LEAST, TILE_MOST);
    }
    return PPM_STATUS_OK;
}

static bool is_lossy(int32_t compression)
{
    return has_level(compression) || compression == PPM_COMPRESSION_PXR24;
}

/* As OpenImageIO writes it: "zips", "dwaa:45". */
static void write_compression(const ppm_output_options *options, char *text, size_t size)
{
    static const char *const names[] = {
        [PPM_COMPRESSION_DEFAULT] = "zips", [PPM_COMPRESSION_NONE] = "none",
        [PPM_COMPRESSION_RLE] = "rle",      [PPM_COMPRESSION_ZIPS] = "zips",
        [PPM_COMPRESSION_ZIP] = "zip",      [PPM_COMPRESSION_PIZ] = "piz",
        [PPM_COMPRESSION_PXR24] = "pxr24",  [PPM_COMPRESSION_DWAA] = "dwaa",
        [PPM_COMPRESSION_DWAB] = "dwab"};
    const char *const name = names[options->compression];
    const double level = options->compression_level > 0 ? (double)options->compression_level : 45;
    if (has_level(options->compression)) {
        snprintf(text, size, "%s:%g", name, level);
    } else {
        snprintf(text, size, "%s", name);
    }
}

/* ---- pixels ---------------------------------------------------------------------------------- */

/* The layers of the parts that are being written. */
typedef struct layer_source {
    ppm_context *context;
    const ppm_render *render;
    const char *path;
    const ppmi_layer_channels *channels;
    uint32_t common; /* layers that are interleaved in the first part; each other has its own */
    uint32_t width;
    size_t pixel_count;
    float **values; /* for each layer: its pixels, or NULL */
} layer_source;

static ppm_status load_layer(layer_source *source, uint32_t index)
{
    const ppm_layer_info *const layer = &source->channels->layers[index];
    const size_t value_count = source->pixel_count * layer->channel_count;
    if (source->values[index]) return PPM_STATUS_OK;
    source->values[index] = ppmi_alloc(source->context, value_count, sizeof(float));
    if (!source->values[index]) {
        return ppmi_fail(source->context, PPM_STATUS_OUT_OF_MEMORY,
                         "%s: no memory for layer '%s'%s", source->path, layer->name,
                         source->common > 1 ? "; a file of many parts needs less" : "");
    }
    return ppm_render_read_layer(source->render, source->channels->numbers[index],
                                 source->values[index], value_count);
}

static void drop_layer(layer_source *source, uint32_t index)
{
    ppmi_free(source->context, source->values[index]);
    source->values[index] = NULL;
}

/* Puts a layer's channels in their place among stride values of each pixel. */
static void interleave(const layer_source *source, uint32_t index, size_t first_pixel,
                       size_t pixel_count, size_t stride, float *values)
{
    const size_t count = source->channels->layers[index].channel_count;
    const float *const layer = source->values[index] + first_pixel * count;
    for (size_t i = 0; i < pixel_count; i++)
        memcpy(values + i * stride, layer + i * count, count * sizeof *values);
}

static ppm_status read_rows(void *user, uint32_t part, uint32_t y, uint32_t row_count,
                            float *values)
{
    layer_source *const source = user;
    const ppmi_layer_channels *const all = source->channels;
    const uint32_t begin = part > 0 ? source->common + part - 1 : 0;
    const uint32_t end = source->common + part;
    const size_t stride = all->first[end] - all->first[begin];
    const size_t first_pixel = (size_t)y * source->width;
    for (uint32_t i = 0; i < begin; i++)
        drop_layer(source, i);
    for (uint32_t i = begin; i < end; i++) {
        const ppm_status status = load_layer(source, i);
        if (status != PPM_STATUS_OK) return status;
        interleave(source, i, first_pixel, (size_t)row_count * source->width, stride,
                   values + (all->first[i] - all->first[begin]));
    }
    return PPM_STATUS_OK;
}

/* ---- the file -------------------------------------------------------------------------------- */

/* The first has the common layers, each other one. That of the picture is called rgba: Nuke shows
 * such a part without its name. How many there are. */
static uint32_t fill_parts(const layer_source *source, const ppm_output_options *options,
                           ppmi_layered_part *parts)
{
    const ppmi_layer_channels *const all = source->channels;
    const uint32_t count = all->layer_count - source->common + 1;
    parts[0] = (ppmi_layered_part){.name = count > 1 ? "rgba" : NULL,
                                   .channel_count = all->first[source->common],
                                   .channels = all->channels};
    for (uint32_t i = 1; i < count; i++) {
        const uint32_t layer = source->common + i - 1;
        const bool is_spared =
            is_lossy(options->compression) && ppmi_layer_is_data(&all->layers[layer]);
        parts[i] = (ppmi_layered_part){.name = all->layer_names[layer],
                                       .channel_count = all->layers[layer].channel_count,
                                       .channels = all->channels + all->first[layer],
                                       .compression = is_spared ? "zip" : NULL};
    }
    return count;
}

static ppm_status write_file(const ppm_output_options *options, const ppmi_output_header *header,
                             layer_source *source, ppmi_layered_part *parts)
{
    const ppm_render_options *const rendered = ppm_render_get_options(source->render);
    char compression[32];
    write_compression(options, compression, sizeof compression);
    const uint32_t part_count = fill_parts(source, options, parts);
    const ppmi_layered_file file = {
        .width = source->width,
        .height = rendered->crop[3] - rendered->crop[1],
        .full_width = rendered->width,
        .full_height = rendered->height,
        .x = rendered->crop[0],
        .y = rendered->crop[1],
        .compression = compression,
        .tile_side = options->tile_side,
        .part_count = part_count,
        .parts = parts,
        .attribute_count = header->count,
        .attributes = header->attributes,
        .repeated_count = header->repeated_count,
        .read_rows = read_rows,
        .user = source,
    };
    return ppmi_imageio_write_layered(source->context, source->path, &file);
}

static ppm_status write_channels(const ppm_output_options *options,
                                 const ppmi_output_header *header, layer_source *source)
{
    const uint32_t count = source->channels->layer_count;
    ppmi_layered_part *const parts = ppmi_alloc_zeroed(source->context, count, sizeof *parts);
    source->values = ppmi_alloc_zeroed(source->context, count, sizeof *source->values);
    ppm_status status;
    if (parts && source->values) {
        status = write_file(options, header, source, parts);
        for (uint32_t i = 0; i < count; i++)
            drop_layer(source, i);
    } else {
        status = ppmi_fail(source->context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory to write it",
                           source->path);
    }
    ppmi_free(source->context, source->values);
    ppmi_free(source->context, parts);
    return status;
}

/* *out_names must outlive the writing. */
static ppm_status add_names(ppm_context *context, const ppmi_layer_channels *channels,
                            ppmi_output_header *header, char **out_names)
{
    const ppm_status status = ppmi_layer_channels_manifest(context, channels, out_names);
    if (status == PPM_STATUS_OK && *out_names) {
        ppmi_output_header_add(header, "ppm:layerNames", PPMI_ATTRIBUTE_STRING)->text = *out_names;
    }
    return status;
}

ppm_status ppmi_output_layers_write(ppm_context *context, const ppm_render *render,
                                    const char *path, const ppm_output_options *options,
                                    ppmi_output_header *header)
{
    const uint32_t *const crop = ppm_render_get_options(render)->crop;
    ppmi_layer_channels channels;
    char *names = NULL;
    const bool is_sorted = is_lossy(options->compression) && !options->is_multipart;
    ppm_status status = ppmi_layer_channels_init(context, render, options->depth == PPM_DEPTH_HALF,
                                                 !options->is_picture_only, is_sorted, &channels);
    if (status == PPM_STATUS_OK) {
        layer_source source = {.context = context,
                               .render = render,
                               .path = path,
                               .channels = &channels,
                               .common = options->is_multipart ? 1 : channels.data_begin,
                               .width = crop[2] - crop[0],
                               .pixel_count = (size_t)(crop[2] - crop[0]) * (crop[3] - crop[1])};
        status = add_names(context, &channels, header, &names);
        if (status == PPM_STATUS_OK) status = write_channels(options, header, &source);
    }
    ppmi_free(context, names);
    ppmi_layer_channels_deinit(context, &channels);
    return status;
}
