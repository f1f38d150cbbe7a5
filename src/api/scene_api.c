/* Public scene calls that need more than the scene: images through imageio and color. */
#include <stdlib.h>
#include <string.h>

#include "color/color.h"
#include "imageio/imageio.h"
#include "scene/scene.h"

ppm_status ppm_scene_create(ppm_context *context, const ppm_color *color, ppm_scene **out_scene)
{
    if (!context || !out_scene) return PPM_STATUS_INVALID_ARGUMENT;
    ppm_scene *scene = ppmi_alloc_zeroed(context, 1, sizeof *scene);
    if (!scene) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for a scene");
    scene->context = context;
    const ppm_status status = ppmi_color_srgb_decode_table(context, color, scene->srgb_to_linear);
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, scene);
        return status;
    }
    *out_scene = scene;
    return PPM_STATUS_OK;
}

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

ppm_status ppm_scene_add_image(ppm_scene *scene, const ppm_image_desc *desc, ppm_image_id *out_id)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || !out_id || desc->size < sizeof *desc || !image_source_is_valid(desc)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "image: needs exactly one of path, bytes and pixels, and a role");
    }
    ppm_context *context = scene->context;
    const char *name = desc->name ? desc->name : desc->path ? desc->path : "image";
    ppmi_pixels pixels = {0};
    status = load_pixels(context, desc, name, &pixels);
    if (status != PPM_STATUS_OK) return status;

    const bool is_color = desc->role == PPM_IMAGE_COLOR;
    if (pixels.f32) {
        const size_t count = (size_t)pixels.width * pixels.height;
        clean_floats(pixels.f32, count * pixels.channels);
        if (is_color && !pixels.is_linear && pixels.channels >= 3) {
            status = ppmi_color_srgb_decode(context, NULL, pixels.f32, count, pixels.channels);
        }
    }
    const ppmi_image image = {
        .name = ppmi_string_copy(context, name),
        .width = pixels.width,
        .height = pixels.height,
        .channels = pixels.channels,
        .u8 = pixels.u8,
        .f32 = pixels.f32,
        .is_srgb = is_color && pixels.u8,
    };
    if (status == PPM_STATUS_OK && !image.name) status = PPM_STATUS_OUT_OF_MEMORY;
    if (status == PPM_STATUS_OK) status = ppmi_scene_take_image(scene, &image, out_id);
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, image.name);
        ppmi_imageio_pixels_free(context, &pixels);
    }
    return status;
}
