/* Pictures of a session as files: scene-linear OpenEXR, or a display's code values. */
#include "ppm/output.h"

#include <math.h>
#include <string.h>

#include "api/output_facts.h"
#include "api/output_header.h"
#include "api/output_layers.h"
#include "base/context.h"
#include "color/color.h"
#include "color/icc.h"
#include "imageio/format.h"
#include "imageio/imageio.h"
#include "imageio/whole.h"
#include "render/render.h"
#include "scene/scene.h"

int32_t ppm_output_is_whole(const char *path, uint32_t *out_width, uint32_t *out_height)
{
    return path && ppmi_imageio_is_whole(path, out_width, out_height);
}

ppm_status ppm_output_check(ppm_context *context, const char *path)
{
    if (!context || !path) return PPM_STATUS_INVALID_ARGUMENT;
    return ppmi_imageio_check_output(context, path);
}

static ppm_status check_arguments(ppm_context *context, const ppm_color *color, const char *path,
                                  const ppmi_output_format *format,
                                  const ppm_output_options *options)
{
    if (!format) return ppmi_imageio_check_output(context, path); /* says which endings there are */
    if (!color && !format->is_scene_linear) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "%s: a %s file needs a colour configuration", path, format->label);
    }
    if (options->size < sizeof *options) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "ppm_output_options.size is %u",
                         options->size);
    }
    if (options->depth < PPM_DEPTH_DEFAULT || options->depth > PPM_DEPTH_FLOAT) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "ppm_output_options.depth is %d",
                         options->depth);
    }
    if (!isfinite(options->exposure_ev)) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "ppm_output_options.exposure_ev is not finite");
    }
    if (format->is_scene_linear) {
        const ppm_status status = ppmi_output_layers_check(context, options);
        if (status != PPM_STATUS_OK) return status;
    }
    if ((options->bits != 0 && options->bits != 8 && options->bits != 16) ||
        options->dither < PPM_DITHER_DEFAULT || options->dither > PPM_DITHER_OFF ||
        options->jpeg_quality > 100) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "ppm_output_options: bits must be 8 or 16, dither PPM_DITHER_, "
                         "jpeg_quality at most 100");
    }
    if (!(options->gamma >= 0 && options->gamma <= 100)) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "ppm_output_options.gamma is not within 0 .. 100");
    }
    if (options->has_frame &&
        !(options->frames_per_second > 0 && isfinite(options->frames_per_second))) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "ppm_output_options.frames_per_second is not above 0");
    }
    return PPM_STATUS_OK;
}

static ppmi_view_choice view_of(const ppm_output_options *options)
{
    return (ppmi_view_choice){.display = options->display,
                              .view = options->view,
                              .look = options->look,
                              .exposure_ev = options->exposure_ev,
                              .gamma = options->gamma};
}

/* How the picture is meant to be seen, where it can be. */
static void add_view(const ppm_color *color, const ppmi_view_choice *choice,
                     ppmi_output_header *header)
{
    ppmi_view_names names; /* unknown ones are no fault of a picture that does not use them */
    if (!color || ppmi_color_choose_view(NULL, color, choice, &names) != PPM_STATUS_OK) return;
    ppmi_output_header_add_view(header, ppm_color_source(color), names.display, names.view,
                                names.look, choice);
}

static ppm_status write_scene_linear(ppm_context *context, const ppm_render *render,
                                     const ppm_color *color, const char *path,
                                     const ppm_output_options *options)
{
    ppm_render_stats stats = {.size = sizeof stats};
    const ppm_status status = ppm_render_get_stats(render, &stats);
    if (status != PPM_STATUS_OK) return status;
    const ppm_render_options *const rendered = ppm_render_get_options(render);
    const char *const camera = ppm_scene_camera_name(ppmi_render_scene(render), rendered->camera);
    ppmi_output_header header;
    ppmi_output_header_init(&header, rendered, &stats, ppmi_render_integrator_name(render), camera,
                            options->command, &ppmi_render_scene(render)->working);
    const ppmi_view_choice choice = view_of(options);
    add_view(color, &choice, &header);
    if (options->has_frame) {
        ppmi_output_header_add_frame(&header, options->frame, options->frames_per_second);
    }
    ppmi_output_facts facts;
    ppmi_output_header_add_facts(&header, render, &facts);
    header.repeated_count = header.count;
    if (!options->is_picture_only) ppmi_output_header_add_mattes(&header, render, &facts);
    ppmi_output_header_add_origin(&header, options->copyright, options->xmp);
    return ppmi_output_layers_write(context, render, path, options, &header);
}

/* Views are made for colours as they are, not for colours times alpha. Returns whether any pixel is
 * not opaque. */
static bool unpremultiply(float *rgba, size_t pixel_count)
{
    bool is_transparent = false;
    for (size_t i = 0; i < pixel_count; i++) {
        float *const pixel = rgba + 4 * i;
        const float alpha = pixel[3];
        if (alpha >= 1) continue;
        is_transparent = true;
        if (!(alpha > 0)) continue;
        for (int c = 0; c < 3; c++)
            pixel[c] /= alpha;
    }
    return is_transparent;
}

/* Packs RGBA to RGB in place. */
static void drop_alpha(float *rgba, size_t pixel_count)
{
    for (size_t i = 0; i < pixel_count; i++) {
        for (int c = 0; c < 3; c++)
            rgba[3 * i + c] = rgba[4 * i + c];
    }
}

/* Says in the file what its values are, as far as its format and the configuration know. */
static void tag_colours(ppm_context *context, const ppm_color *color, const char *path,
                        const ppmi_view_choice *choice, uint8_t icc[PPMI_ICC_BYTES_MAX],
                        ppmi_image_file *file)
{
    const ppmi_display_tag *const tag = ppmi_color_display_tag(color, choice);
    const char *const format = ppmi_imageio_format_of_output(path)->label;
    const bool is_png = strcmp(format, "PNG") == 0;
    if (!tag) {
        ppmi_log(context, PPM_LOG_DEBUG, "%s: its colour space is not known: not tagged", path);
        return;
    }
    /* OpenImageIO 2.4 spoils a TIFF file in memory by the Exif directory that it makes of this */
    if (tag->is_srgb && strcmp(format, "TIFF") != 0) file->color_space = "sRGB";
    file->has_cicp = tag->cicp[0] > 0;
    memcpy(file->cicp, tag->cicp, sizeof file->cicp);
    const bool needs_profile = !(is_png && (tag->is_srgb || tag->curve == PPMI_CURVE_HDR));
    if (!needs_profile) return;
    file->icc_bytes = ppmi_icc_write(tag, icc);
    file->icc = file->icc_bytes > 0 ? icc : NULL;
    if (!file->icc) {
        ppmi_log(context, PPM_LOG_WARNING, "%s: only .png can say that it is %s: not tagged", path,
                 tag->name);
    }
}

/* How the values are stored, as far as the format leaves a choice. */
static void choose_storage(const char *path, const ppm_output_options *options,
                           const uint32_t *crop, ppmi_image_file *file)
{
    const ppmi_output_format *const format = ppmi_imageio_format_of_output(path);
    const bool has_choice = (format->stores & 1u << PPMI_STORE_U16) != 0;
    if (has_choice && options->bits == 8) file->store = PPMI_STORE_U8;
    if (has_choice && options->bits == 16) file->store = PPMI_STORE_U16;
    file->is_dithered = has_choice && options->dither == PPM_DITHER_DEFAULT;
    file->jpeg_quality = options->jpeg_quality;
    file->x = crop[0];
    file->y = crop[1];
}

static ppm_status write_display(ppm_context *context, const ppm_color *color,
                                const ppmi_working_space *space, const char *path,
                                const ppm_output_options *options, const uint32_t *crop,
                                ppmi_image_file *file, float *rgba)
{
    const size_t pixel_count = (size_t)file->width * file->height;
    const bool is_transparent = unpremultiply(rgba, pixel_count);
    const ppmi_view_choice choice = view_of(options);
    const ppm_status status = ppmi_color_show(context, color, &choice, space, rgba, pixel_count);
    if (status != PPM_STATUS_OK) return status;
    choose_storage(path, options, crop, file);
    if (!is_transparent) {
        drop_alpha(rgba, pixel_count);
        file->channels = 3;
    }
    ppmi_output_header header;
    ppmi_output_header_init_display(&header);
    ppmi_output_header_add_origin(&header, options->copyright, NULL);
    uint8_t icc[PPMI_ICC_BYTES_MAX];
    tag_colours(context, color, path, &choice, icc, file);
    file->attributes = header.attributes;
    file->attribute_count = header.count;
    return ppmi_imageio_write_file(context, path, file);
}

/* What files for display show of a session. */
static ppm_status read_shown(const ppm_render *render, float *rgba, size_t value_count)
{
    const bool is_denoised = ppm_render_get_options(render)->denoise != 0;
    for (uint32_t i = 0; is_denoised && i < ppm_render_layer_count(render); i++) {
        ppm_layer_info layer = {.size = sizeof layer};
        const ppm_status status = ppm_render_get_layer(render, i, &layer);
        if (status != PPM_STATUS_OK) return status;
        if (layer.kind == PPM_LAYER_DENOISED) {
            return ppm_render_read_layer(render, i, rgba, value_count);
        }
    }
    return ppm_render_read_image(render, rgba, value_count);
}

static ppm_status write_for_display(ppm_context *context, const ppm_render *render,
                                    const ppm_color *color, const char *path,
                                    const ppmi_output_format *format,
                                    const ppm_output_options *options)
{
    const uint32_t *const crop = ppm_render_get_options(render)->crop;
    const uint32_t width = crop[2] - crop[0], height = crop[3] - crop[1];
    const size_t value_count = (size_t)width * height * 4;
    float *const rgba = ppmi_alloc(context, value_count, sizeof *rgba);
    if (!rgba) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: no memory for %u x %u pixels",
                         path, width, height);
    }
    ppmi_image_file file = {.width = width,
                            .height = height,
                            .channels = 4,
                            .pixels = rgba,
                            .store = format->usual_store};
    ppm_status status = read_shown(render, rgba, value_count);
    if (status == PPM_STATUS_OK) {
        status = write_display(context, color, &ppmi_render_scene(render)->working, path, options,
                               crop, &file, rgba);
    }
    ppmi_free(context, rgba);
    return status;
}

ppm_status ppm_render_write(const ppm_render *render, const ppm_color *color, const char *path,
                            const ppm_output_options *options)
{
    static const ppm_output_options defaults = {.size = sizeof defaults};
    if (!render || !path) return PPM_STATUS_INVALID_ARGUMENT;
    if (!options) options = &defaults;
    ppm_context *const context = ppmi_render_context(render);
    const ppmi_output_format *const format = ppmi_imageio_format_of_output(path);
    const ppm_status status = check_arguments(context, color, path, format, options);
    if (status != PPM_STATUS_OK) return status;

    if (format->is_scene_linear) return write_scene_linear(context, render, color, path, options);
    return write_for_display(context, render, color, path, format, options);
}
