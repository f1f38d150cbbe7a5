/* Images that are made of two: the renderer takes roughness and metalness from one image, and alpha
 * from that of the colour, where MTL names an image for each. The result is as large as the larger
 * side of each, and has 8 bits where both files have. */
#include <math.h>
#include <string.h>

#include "obj/obj_picture.h"

enum { MOST_PIXELS = 1 << 28 };

/* An image while it is made. */
typedef struct canvas {
    const ppmi_obj_mixture *mixture;
    ppmi_obj_picture pictures[2];
    ppm_image_desc desc;
    void *pixels;
    float *rows[2]; /* 4 * width floats each */
} canvas;

/* A picture that cannot be read is told by the call, and then missing. */
static ppm_status open_picture(ppmi_obj_reader *r, const ppmi_obj_map *map, const char *path,
                               int32_t role, ppmi_obj_picture *out)
{
    const ppm_status status = ppmi_obj_picture_open(r, map, path, role, out);
    const bool is_about_input = status == PPM_STATUS_INPUT_NOT_FOUND ||
                                status == PPM_STATUS_INPUT_INVALID ||
                                status == PPM_STATUS_INPUT_UNSUPPORTED;
    if (!is_about_input) return status;
    ppmi_log(r->context, PPM_LOG_WARNING, "%s: left out of the materials: see the message above",
             path);
    return PPM_STATUS_OK;
}

/* What stands for the channel that map_d does not name: the matte of an image that has one, or that
 * is the one of the colours; else how bright it is. */
static char matte_channel(const ppmi_obj_picture *p, const char *const paths[2])
{
    const bool is_of_colors = paths[0] && strcmp(paths[0], paths[1]) == 0;
    return is_of_colors || p->mean[3] < 1.0f - 1e-6f ? 'm' : 'l';
}

static ppm_status open_pictures(ppmi_obj_reader *r, const ppmi_obj_material *material, canvas *c,
                                const char *const paths[2])
{
    ppm_status status = PPM_STATUS_OK;
    for (int i = 0; i < 2 && status == PPM_STATUS_OK; ++i) {
        const int32_t map = c->mixture->maps[i];
        if (!paths[i]) continue;
        status = open_picture(r, &material->maps[map], paths[i],
                              i == 0 ? c->desc.role : PPM_IMAGE_DATA, &c->pictures[i]);
        ppmi_obj_picture *p = &c->pictures[i];
        if (p->scene && map == PPMI_OBJ_MAP_D && p->channel == 0)
            p->channel = matte_channel(p, paths);
    }
    return status;
}

/* Size and kind of the result. */
static void plan(canvas *c)
{
    ppm_image_desc *desc = &c->desc;
    desc->pixel_type = PPM_PIXELS_U8;
    for (int i = 0; i < 2; ++i) {
        const ppmi_obj_picture *p = &c->pictures[i];
        if (!p->scene) continue;
        if (p->info.width > desc->width) desc->width = p->info.width;
        if (p->info.height > desc->height) desc->height = p->info.height;
        if (p->info.pixel_type != PPM_PIXELS_U8) desc->pixel_type = PPM_PIXELS_F32;
    }
    const bool has_alpha = c->pictures[0].scene && c->pictures[0].info.channels % 2 == 0;
    desc->channels = c->mixture->channels > 0 ? c->mixture->channels : has_alpha ? 4 : 3;
}

static float encode_srgb(float x)
{
    return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
}

static void store(const canvas *c, const float *rgba, size_t pixel)
{
    const ppm_image_desc *desc = &c->desc;
    for (size_t i = 0; i < desc->channels; ++i) {
        const size_t at = pixel * desc->channels + i;
        if (desc->pixel_type == PPM_PIXELS_F32) {
            ((float *)c->pixels)[at] = rgba[i];
        } else {
            const float x = fminf(fmaxf(rgba[i], 0.0f), 1.0f);
            const bool is_encoded = desc->role == PPM_IMAGE_COLOR && i < 3;
            ((uint8_t *)c->pixels)[at] =
                (uint8_t)lrintf(255.0f * (is_encoded ? encode_srgb(x) : x));
        }
    }
}

static void fill_row(float *row, size_t width, float value)
{
    for (size_t i = 0; i < 4 * width; ++i) {
        row[i] = value;
    }
}

static void mix(canvas *c)
{
    const ppm_image_desc *desc = &c->desc;
    for (uint32_t y = 0; y < desc->height; ++y) {
        for (int i = 0; i < 2; ++i) {
            if (c->pictures[i].scene) {
                ppmi_obj_picture_row_of(&c->pictures[i], desc->width, desc->height, y, c->rows[i]);
            } else if (y == 0) {
                fill_row(c->rows[i], desc->width, c->mixture->missing[i]);
            }
        }
        for (size_t x = 0; x < desc->width; ++x) {
            float rgba[4];
            c->mixture->mix(c->mixture->parameter, c->rows[0] + 4 * x, c->rows[1] + 4 * x, rgba);
            store(c, rgba, (size_t)y * desc->width + x);
        }
    }
}

static ppm_status make(ppmi_obj_reader *r, canvas *c, ppm_image_id *out_id)
{
    ppm_image_desc *desc = &c->desc;
    const size_t value_size = desc->pixel_type == PPM_PIXELS_U8 ? 1 : sizeof(float);
    c->pixels =
        ppmi_alloc(r->context, (size_t)desc->width * desc->height, desc->channels * value_size);
    for (int i = 0; i < 2; ++i) {
        c->rows[i] = ppmi_alloc(r->context, desc->width, 4 * sizeof *c->rows[i]);
    }
    if (!c->pixels || !c->rows[0] || !c->rows[1]) return ppmi_obj_out_of_memory(r);
    mix(c);
    desc->pixels = c->pixels;
    return ppm_scene_add_image(r->scene, desc, out_id);
}

ppm_status ppmi_obj_mix_images(ppmi_obj_reader *r, const ppmi_obj_material *material,
                               const ppmi_obj_mixture *mixture, const char *const paths[2],
                               ppm_image_id *out_id)
{
    const ppmi_obj_map *first = &material->maps[mixture->maps[0]];
    canvas c = {.mixture = mixture,
                .desc = {.size = sizeof c.desc,
                         .name = paths[0] ? paths[0] : paths[1],
                         .role = first->is_linear ? PPM_IMAGE_DATA : mixture->role}};
    ppm_status status = open_pictures(r, material, &c, paths);
    if (status == PPM_STATUS_OK && (c.pictures[0].scene || c.pictures[1].scene)) {
        plan(&c);
        if ((uint64_t)c.desc.width * c.desc.height > MOST_PIXELS) {
            ppmi_log(r->context, PPM_LOG_WARNING,
                     "%s: left out with %s: together they would have %u x %u pixels, more than "
                     "2^28",
                     paths[0], paths[1], (unsigned)c.desc.width, (unsigned)c.desc.height);
        } else {
            status = make(r, &c, out_id);
        }
    }
    for (int i = 0; i < 2; ++i) {
        ppmi_obj_picture_close(r, &c.pictures[i]);
        ppmi_free(r->context, c.rows[i]);
    }
    ppmi_free(r->context, c.pixels);
    return status;
}
