/* Images of a scene: decoded by imageio, brought to linear light by color. Decoding is most of the
 * time that many files take to import, so several images are decoded at once. */
#include <string.h>

#include "color/color.h"
#include "imageio/imageio.h"
#include "scene/scene.h"

/* Exactly one of path, bytes and pixels. */
static bool image_source_is_valid(const ppm_image_desc *desc)
{
    const int sources = (desc->path != NULL) + (desc->bytes != NULL) + (desc->pixels != NULL);
    if (sources != 1 || (desc->role != PPM_IMAGE_COLOR && desc->role != PPM_IMAGE_DATA)) {
        return false;
    }
    if (!desc->pixels) return true;
    return (desc->pixel_type == PPM_PIXELS_U8 || desc->pixel_type == PPM_PIXELS_F32) &&
           desc->width > 0 && desc->height > 0 && desc->channels >= 1 && desc->channels <= 4 &&
           (uint64_t)desc->width * desc->height <= (uint64_t)1 << 31;
}

static ppm_status copy_pixels(ppm_context *context, const ppm_image_desc *desc,
                              ppmi_pixels *out_pixels)
{
    const size_t count = (size_t)desc->width * desc->height * desc->channels;
    const bool is_u8 = desc->pixel_type == PPM_PIXELS_U8;
    const size_t value_size = is_u8 ? sizeof(uint8_t) : sizeof(float);
    void *copy = ppmi_alloc(context, count, value_size);
    if (!copy) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for an image");
    memcpy(copy, desc->pixels, count * value_size);
    *out_pixels = (ppmi_pixels){
        .width = desc->width,
        .height = desc->height,
        .channels = desc->channels,
        .u8 = is_u8 ? copy : NULL,
        .f32 = is_u8 ? NULL : copy,
        .is_linear = true,
    };
    return PPM_STATUS_OK;
}

static ppm_status load_pixels(ppm_context *context, const ppm_image_desc *desc, const char *name,
                              ppmi_pixels *out_pixels)
{
    if (desc->pixels) return copy_pixels(context, desc, out_pixels);
    if (desc->bytes) {
        return ppmi_imageio_read_memory(context, desc->bytes, desc->byte_count, name, out_pixels);
    }
    return ppmi_imageio_read_file(context, desc->path, name, out_pixels);
}

/* NaN and infinity in an HDR file would spread over the picture. Infinite is what was too bright
 * for the program or the format, mostly the sun in half floats: it becomes as bright as those can
 * be, or as the brightest texel if that is more. */
static void clean_floats(ppm_context *context, const char *name, float *values, size_t count)
{
    const float too_large = 1e30f, half_max = 65504.0f;
    size_t infinite = 0, no_numbers = 0;
    float most = half_max;
    for (size_t i = 0; i < count; i++) {
        const float size = fabsf(values[i]);
        if (size < too_large) most = fmaxf(most, size);
    }
    for (size_t i = 0; i < count; i++) {
        if (isnan(values[i])) {
            values[i] = 0.0f;
            no_numbers++;
        } else if (!(fabsf(values[i]) < too_large)) {
            values[i] = copysignf(most, values[i]);
            infinite++;
        }
    }
    if (infinite > 0) {
        ppmi_log(context, PPM_LOG_WARNING,
                 "%s: %zu of its values are infinite: they are taken as %g, the largest", name,
                 infinite, (double)most);
    }
    if (no_numbers > 0) {
        ppmi_log(context, PPM_LOG_WARNING,
                 "%s: %zu of its values are not numbers: they are taken as 0", name, no_numbers);
    }
}

/* No surface reflects less than nothing, and no light takes light away. */
static void clean_negatives(ppm_context *context, const char *name, ppmi_pixels *pixels)
{
    const uint32_t channels = pixels->channels, colors = channels < 3 ? 1 : 3;
    const size_t count = (size_t)pixels->width * pixels->height;
    const float of_filtering = -1e-4f;
    size_t negative = 0;
    for (size_t i = 0; i < count; i++) {
        float *const color = pixels->f32 + i * channels;
        bool is_negative = false;
        for (uint32_t c = 0; c < colors; c++) {
            is_negative = is_negative || color[c] < of_filtering;
            color[c] = color[c] > 0.0f ? color[c] : 0.0f;
        }
        negative += is_negative;
    }
    if (negative == 0) return;
    ppmi_log(context, PPM_LOG_WARNING,
             "%s: %zu of its %zu pixels have a negative colour: it is taken as 0", name, negative,
             count);
}

/* Wider than it was: grey becomes three channels, 8 bits floats of 0..1. OpenColorIO takes no less.
 */
static ppm_status widen(ppm_context *context, const char *name, ppmi_pixels *pixels)
{
    const uint32_t from = pixels->channels, to = from < 3 ? from + 2 : from;
    const size_t count = (size_t)pixels->width * pixels->height;
    if (pixels->f32 && from == to) return PPM_STATUS_OK;
    float *const wide = ppmi_alloc(context, count * to, sizeof *wide);
    if (!wide) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory for an image", name);
    }
    for (size_t i = 0; i < count * to; i++) {
        const uint32_t channel = (uint32_t)(i % to);
        const bool is_alpha = channel == 3;
        const size_t at = i / to * from + (from >= 3 ? channel : is_alpha ? 1u : 0u);
        wide[i] = pixels->u8 ? (float)pixels->u8[at] / 255.0f : pixels->f32[at];
    }
    ppmi_free(context, pixels->u8);
    ppmi_free(context, pixels->f32);
    pixels->u8 = NULL;
    pixels->f32 = wide;
    pixels->channels = to;
    return PPM_STATUS_OK;
}

/* A colour that the working space does not hold has a negative channel: no surface reflects less
 * than nothing. */
static void clamp_gamut(ppm_context *context, const ppm_color *color, const char *name,
                        ppmi_pixels *pixels)
{
    const size_t count = (size_t)pixels->width * pixels->height;
    size_t outside = 0;
    for (size_t i = 0; i < count; i++) {
        float *const rgb = pixels->f32 + i * pixels->channels, least = -1e-4f;
        outside += rgb[0] < least || rgb[1] < least || rgb[2] < least;
        for (int c = 0; c < 3; c++)
            rgb[c] = rgb[c] > 0.0f ? rgb[c] : 0.0f;
    }
    if (outside == 0) return;
    ppmi_log(context, PPM_LOG_INFO,
             "%s: %.3g %% of its pixels lie outside of the working space \"%s\"; what would be "
             "negative is 0",
             name, 100.0 * (double)outside / (double)count,
             color ? ppm_color_working_space(color) : ppmi_working_space_rec709.name);
}

/* 8-bit sRGB stays as it is; whoever looks it up decodes it. All else becomes floats of the working
 * space. */
static ppm_status to_working_space(ppm_context *context, const ppm_color *color,
                                   const ppm_image_desc *desc, const char *name,
                                   ppmi_pixels *pixels, ppmi_image *image)
{
    const ppmi_color_input input = ppmi_color_choose_input(
        color,
        desc->path    ? desc->path
        : desc->label ? desc->label
                      : desc->name,
        pixels->f32 && pixels->is_linear, *pixels->color_space ? pixels->color_space : NULL,
        pixels->has_chromaticities && pixels->is_linear ? pixels->chromaticities : NULL);
    const bool differs = ppmi_color_working_space(color)->differs;
    const size_t count = (size_t)pixels->width * pixels->height;
    if (input.kind == PPMI_INPUT_NUMBERS) return PPM_STATUS_OK;
    if (pixels->u8 && input.kind == PPMI_INPUT_SRGB) {
        image->is_srgb = true;
        image->is_rec709 = differs && pixels->channels >= 3;
        return PPM_STATUS_OK;
    }
    const bool is_kept = input.kind == PPMI_INPUT_REC709 && (!differs || pixels->channels < 3);
    if (is_kept && pixels->f32) {
        clean_negatives(context, name, pixels);
        return PPM_STATUS_OK;
    }
    ppm_status status = widen(context, name, pixels);
    if (status != PPM_STATUS_OK) return status;
    float *const values = pixels->f32;
    const uint32_t channels = pixels->channels;
    image->is_working = differs;
    if (input.kind == PPMI_INPUT_SPACE) {
        status = ppmi_color_from_space(context, color, input.space, values, count, channels);
    } else if (input.kind == PPMI_INPUT_PRIMARIES) {
        if (!ppmi_color_from_primaries(color, pixels->chromaticities, values, count, channels)) {
            ppmi_log(context, PPM_LOG_WARNING,
                     "%s: its chromaticities are those of no colour space; taken as linear Rec.709",
                     name);
            ppmi_color_from_rec709(color, values, count, channels);
        }
    } else {
        if (input.kind == PPMI_INPUT_SRGB) {
            status = ppmi_color_srgb_decode(context, color, values, count, channels);
        }
        ppmi_color_from_rec709(color, values, count, channels);
    }
    if (status == PPM_STATUS_OK && (differs || input.kind >= PPMI_INPUT_PRIMARIES)) {
        clamp_gamut(context, color, name, pixels);
    }
    return status;
}

/* One image decoded, not in the scene yet; on failure nothing is left. Any thread. */
static ppm_status decode_image(ppm_context *context, const ppm_color *color,
                               const ppm_image_desc *desc, ppmi_image *out_image)
{
    const char *name = desc->name ? desc->name : desc->path ? desc->path : "image";
    ppmi_pixels pixels = {0};
    ppm_status status = load_pixels(context, desc, name, &pixels);
    if (status != PPM_STATUS_OK) return status;
    if (pixels.is_cut && desc->strict) {
        ppmi_imageio_pixels_free(context, &pixels);
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: strict: the file is cut off",
                         name);
    }

    ppmi_image image = {.width = pixels.width, .height = pixels.height};
    if (pixels.f32) {
        clean_floats(context, name, pixels.f32,
                     (size_t)pixels.width * pixels.height * pixels.channels);
    }
    if (desc->role == PPM_IMAGE_COLOR) {
        status = to_working_space(context, color, desc, name, &pixels, &image);
    }
    image.name = ppmi_string_copy(context, name);
    image.channels = pixels.channels;
    image.u8 = pixels.u8;
    image.f32 = pixels.f32;
    if (status == PPM_STATUS_OK && !image.name) {
        status = ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for an image");
    }
    if (status == PPM_STATUS_OK) {
        *out_image = image;
    } else {
        ppmi_free(context, image.name);
        ppmi_imageio_pixels_free(context, &pixels);
    }
    return status;
}

static ppm_status check_desc(ppm_scene *scene, const ppm_image_desc *desc)
{
    if (desc && desc->size >= sizeof *desc && image_source_is_valid(desc)) return PPM_STATUS_OK;
    return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                     "image: needs exactly one of path, bytes and pixels, and a role");
}

/* Hands a decoded image to the scene. */
static ppm_status take(ppm_scene *scene, const ppmi_image *image, ppm_image_id *out_id)
{
    const ppm_status status = ppmi_scene_take_image(scene, image, out_id);
    if (status == PPM_STATUS_OK) return status;
    ppmi_free(scene->context, image->name);
    ppmi_free(scene->context, image->u8);
    ppmi_free(scene->context, image->f32);
    return status;
}

ppm_status ppm_scene_add_image(ppm_scene *scene, const ppm_image_desc *desc, ppm_image_id *out_id)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!out_id) return PPM_STATUS_INVALID_ARGUMENT;
    status = check_desc(scene, desc);
    if (status != PPM_STATUS_OK) return status;
    ppmi_image image;
    status = decode_image(scene->context, scene->color, desc, &image);
    return status == PPM_STATUS_OK ? take(scene, &image, out_id) : status;
}

/* ---- several at once ------------------------------------------------------------------------- */

/* An image on its way, with the messages about it. */
typedef struct decoding {
    ppm_context *context;
    ppmi_image image;
} decoding;

static void decode_all(ppm_context *context, const ppm_color *color, const ppm_image_desc *descs,
                       uint32_t count, decoding *all, ppm_status *statuses)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (uint32_t i = 0; i < count; i++) {
        statuses[i] = PPM_STATUS_OUT_OF_MEMORY;
        all[i].context = ppmi_context_fork(context);
        if (all[i].context) {
            statuses[i] = decode_image(all[i].context, color, &descs[i], &all[i].image);
        }
    }
}

ppm_status ppm_scene_add_images(ppm_scene *scene, const ppm_image_desc *descs, uint32_t count,
                                ppm_image_id *out_ids, ppm_status *out_statuses)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK || count == 0) return status;
    if (!descs || !out_ids || !out_statuses) return PPM_STATUS_INVALID_ARGUMENT;
    for (uint32_t i = 0; i < count && status == PPM_STATUS_OK; i++)
        status = check_desc(scene, &descs[i]);
    if (status != PPM_STATUS_OK) return status;
    decoding *all = ppmi_alloc_zeroed(scene->context, count, sizeof *all);
    if (!all) {
        return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for images");
    }
    decode_all(scene->context, scene->color, descs, count, all, out_statuses);
    for (uint32_t i = 0; i < count; i++) {
        if (out_statuses[i] == PPM_STATUS_OUT_OF_MEMORY) {
            ppmi_context_join(all[i].context);
        } else {
            ppmi_context_join_as_warnings(all[i].context);
        }
        out_ids[i] = 0;
        if (out_statuses[i] != PPM_STATUS_OK) continue;
        out_statuses[i] = take(scene, &all[i].image, &out_ids[i]);
    }
    ppmi_free(scene->context, all);
    return PPM_STATUS_OK;
}
