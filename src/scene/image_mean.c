/* What images hold, for callers: their pixels, and the mean colour, for what a picture of a surface
 * can only tell as one number. */
#include "scene/scene.h"

/* One texel, RGBA; grey and alpha spread as texture lookups do. */
static void texel(const ppm_scene *scene, const ppmi_image *image, size_t index, float out[4])
{
    const uint32_t channels = image->channels, colors = channels < 3 ? 1 : 3;
    for (uint32_t i = 0; i < 4; i++) {
        const bool is_alpha = i == 3;
        const size_t at = index * channels + (is_alpha ? channels - 1 : i % colors);
        if (is_alpha && channels % 2 == 1) {
            out[i] = 1.0f;
        } else if (image->f32) {
            out[i] = image->f32[at];
        } else if (image->is_srgb && !is_alpha) {
            out[i] = scene->srgb_to_linear[image->u8[at]];
        } else {
            out[i] = (float)image->u8[at] / 255.0f;
        }
    }
}

ppm_status ppm_scene_image_mean(const ppm_scene *scene, ppm_image_id id, float out_rgba[4])
{
    if (!scene || id == 0 || id > scene->image_count || !out_rgba)
        return PPM_STATUS_INVALID_ARGUMENT;
    const ppmi_image *image = &scene->images[id - 1];
    const size_t count = (size_t)image->width * image->height;
    double sums[4] = {0.0, 0.0, 0.0, 0.0};
    for (size_t k = 0; k < count; k++) {
        float rgba[4];
        texel(scene, image, k, rgba);
        for (int i = 0; i < 4; i++)
            sums[i] += (double)rgba[i];
    }
    for (int i = 0; i < 4; i++)
        out_rgba[i] = (float)(sums[i] / (double)count);
    if (image->is_working) ppmi_matrix_apply(scene->working.to_rec709, out_rgba, out_rgba);
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_get_image_info(const ppm_scene *scene, ppm_image_id id,
                                    ppm_image_info *out_info)
{
    if (!scene || id == 0 || id > scene->image_count || !out_info ||
        out_info->size < sizeof *out_info) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    const ppmi_image *image = &scene->images[id - 1];
    *out_info = (ppm_image_info){.size = out_info->size,
                                 .width = image->width,
                                 .height = image->height,
                                 .channels = image->channels,
                                 .pixel_type = image->u8 ? PPM_PIXELS_U8 : PPM_PIXELS_F32};
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_read_image_row(const ppm_scene *scene, ppm_image_id id, uint32_t row,
                                    float *out_rgba)
{
    if (!scene || id == 0 || id > scene->image_count || !out_rgba)
        return PPM_STATUS_INVALID_ARGUMENT;
    const ppmi_image *image = &scene->images[id - 1];
    if (row >= image->height) return PPM_STATUS_INVALID_ARGUMENT;
    for (size_t x = 0; x < image->width; x++)
        texel(scene, image, (size_t)row * image->width + x, out_rgba + 4 * x);
    return PPM_STATUS_OK;
}
