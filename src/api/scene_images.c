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

/* NaN and infinity in an HDR file would spread over the picture. */
static void clean_floats(float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(values[i] < 1e30f && values[i] > -1e30f)) values[i] = 0.0f;
    }
}

/* One image decoded, not in the scene yet; on failure nothing is left. Any thread. */
static ppm_status decode_image(ppm_context *context, const ppm_image_desc *desc,
                               ppmi_image *out_image)
{
    const char *name = desc->name ? desc->name : desc->path ? desc->path : "image";
    ppmi_pixels pixels = {0};
    ppm_status status = load_pixels(context, desc, name, &pixels);
    if (status != PPM_STATUS_OK) return status;

    const bool is_color = desc->role == PPM_IMAGE_COLOR;
    if (pixels.f32) {
        const size_t count = (size_t)pixels.width * pixels.height;
        clean_floats(pixels.f32, count * pixels.channels);
        if (is_color && !pixels.is_linear && pixels.channels >= 3) {
            status = ppmi_color_srgb_decode(context, NULL, pixels.f32, count, pixels.channels);
        }
    }
    *out_image = (ppmi_image){
        .name = ppmi_string_copy(context, name),
        .width = pixels.width,
        .height = pixels.height,
        .channels = pixels.channels,
        .u8 = pixels.u8,
        .f32 = pixels.f32,
        .is_srgb = is_color && pixels.u8,
    };
    if (status == PPM_STATUS_OK && !out_image->name) {
        status = ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for an image");
    }
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, out_image->name);
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
    status = decode_image(scene->context, desc, &image);
    return status == PPM_STATUS_OK ? take(scene, &image, out_id) : status;
}

/* ---- several at once ------------------------------------------------------------------------- */

/* An image on its way, with the messages about it. */
typedef struct decoding {
    ppm_context *context;
    ppmi_image image;
} decoding;

static void decode_all(ppm_context *context, const ppm_image_desc *descs, uint32_t count,
                       decoding *all, ppm_status *statuses)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (uint32_t i = 0; i < count; i++) {
        statuses[i] = PPM_STATUS_OUT_OF_MEMORY;
        all[i].context = ppmi_context_fork(context);
        if (all[i].context) {
            statuses[i] = decode_image(all[i].context, &descs[i], &all[i].image);
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
    decode_all(scene->context, descs, count, all, out_statuses);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_context_join(all[i].context);
        out_ids[i] = 0;
        if (out_statuses[i] != PPM_STATUS_OK) continue;
        out_statuses[i] = take(scene, &all[i].image, &out_ids[i]);
    }
    ppmi_free(scene->context, all);
    return PPM_STATUS_OK;
}
