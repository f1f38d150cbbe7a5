#include "obj/obj_picture.h"

#include <math.h>
#include <string.h>

static ppm_status load(ppmi_obj_picture *p, const char *path, int32_t role)
{
    const ppm_image_desc desc = {.size = sizeof desc, .name = path, .role = role, .path = path};
    ppm_status status = ppm_scene_add_image(p->scene, &desc, &p->id);
    if (status == PPM_STATUS_OK) status = ppm_scene_get_image_info(p->scene, p->id, &p->info);
    if (status == PPM_STATUS_OK) status = ppm_scene_image_mean(p->scene, p->id, p->mean);
    return status;
}

ppm_status ppmi_obj_picture_open(ppmi_obj_reader *r, const ppmi_obj_map *map, const char *path,
                                 int32_t role, ppmi_obj_picture *out)
{
    *out = (ppmi_obj_picture){.info.size = sizeof out->info, .map = map, .channel = map->channel};
    ppm_status status = ppm_scene_create(r->context, NULL, &out->scene);
    if (status != PPM_STATUS_OK) return status;
    status = load(out, path, role);
    if (status == PPM_STATUS_OK) {
        out->rows = ppmi_alloc(r->context, out->info.width, 8 * sizeof *out->rows);
        if (!out->rows) status = ppmi_obj_out_of_memory(r);
    }
    if (status != PPM_STATUS_OK) ppmi_obj_picture_close(r, out);
    return status;
}

void ppmi_obj_picture_close(ppmi_obj_reader *r, ppmi_obj_picture *p)
{
    ppm_scene_destroy(p->scene);
    ppmi_free(r->context, p->rows);
    p->scene = NULL;
    p->rows = NULL;
}

static float channel_of(char channel, const float rgba[4])
{
    switch (channel) {
    case 'r':
        return rgba[0];
    case 'g':
        return rgba[1];
    case 'b':
        return rgba[2];
    case 'm':
        return rgba[3];
    default:
        return ppmi_obj_luminance(rgba);
    }
}

void ppmi_obj_picture_row(const ppmi_obj_picture *p, uint32_t row, float *out)
{
    const ppmi_obj_map *map = p->map;
    ppm_scene_read_image_row(p->scene, p->id, row, out);
    for (size_t x = 0; x < p->info.width; ++x) {
        float *rgba = out + 4 * x;
        if (p->channel != 0) rgba[0] = rgba[1] = rgba[2] = channel_of(p->channel, rgba);
        for (int i = 0; i < 3; ++i) {
            rgba[i] = map->base + map->gain * rgba[i];
        }
    }
}

/* Two neighbours among count pixels, and how far between them the middle of pixel i of n lies. */
static float between(uint32_t i, uint32_t n, uint32_t count, size_t out[2])
{
    const double at = ((double)i + 0.5) * (double)count / (double)n - 0.5;
    const double low = fmax(floor(at), 0.0);
    out[0] = (size_t)low;
    out[1] = out[0] + 1 < count ? out[0] + 1 : out[0];
    return (float)fmax(at - low, 0.0);
}

void ppmi_obj_picture_row_of(ppmi_obj_picture *p, uint32_t width, uint32_t height, uint32_t row,
                             float *out)
{
    const size_t own = p->info.width;
    size_t rows[2];
    if (width == p->info.width && height == p->info.height) {
        ppmi_obj_picture_row(p, row, out);
        return;
    }
    const float v = between(row, height, p->info.height, rows);
    for (size_t i = 0; i < 2; ++i) {
        ppmi_obj_picture_row(p, (uint32_t)rows[i], p->rows + i * 4 * own);
    }
    for (uint32_t x = 0; x < width; ++x) {
        size_t columns[2];
        const float u = between(x, width, p->info.width, columns);
        for (size_t i = 0; i < 4; ++i) {
            const float *upper = p->rows + i, *lower = p->rows + 4 * own + i;
            const float a = upper[4 * columns[0]] * (1.0f - u) + upper[4 * columns[1]] * u;
            const float b = lower[4 * columns[0]] * (1.0f - u) + lower[4 * columns[1]] * u;
            out[4 * (size_t)x + i] = a * (1.0f - v) + b * v;
        }
    }
}
