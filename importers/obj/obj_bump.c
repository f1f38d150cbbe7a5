/* Height maps as normal maps (Blinn 1978, "Simulation of Wrinkled Surfaces", with the heights'
 * derivatives by central differences). A height of 1 stands SCALE of the image's width above the
 * surface where -bm is 1: MTL does not say how high a bump is, and so its look depends neither on
 * the resolution of the image nor on the size of the mesh.
 *
 * Blender's exporter writes normal maps as map_Bump. An image that is mostly the blue of a normal
 * map, (0.5, 0.5, 1), is taken for one. */
#include <math.h>
#include <string.h>

#include "obj/obj_picture.h"

#define SCALE 0.01f

static bool is_normal_map(const ppmi_obj_picture *p)
{
    return p->info.channels >= 3 && fabsf(p->mean[0] - 0.5f) < 0.1f &&
           fabsf(p->mean[1] - 0.5f) < 0.1f && p->mean[2] > 0.75f;
}

static ppm_status read_heights(ppmi_obj_reader *r, ppmi_obj_picture *p, float *out)
{
    const size_t width = p->info.width;
    float *row = ppmi_alloc(r->context, width, 4 * sizeof *row);
    if (!row) return ppmi_obj_out_of_memory(r);
    for (uint32_t y = 0; y < p->info.height; ++y) {
        ppmi_obj_picture_row(p, y, row);
        for (size_t x = 0; x < width; ++x) {
            out[y * width + x] = ppmi_obj_luminance(row + 4 * x);
        }
    }
    ppmi_free(r->context, row);
    return PPM_STATUS_OK;
}

/* The neighbours of i among count, around the edge or not beyond it, and how far they are apart. */
static float neighbours(size_t i, size_t count, bool clamp, size_t *before, size_t *after)
{
    *before = i > 0 ? i - 1 : clamp ? 0 : count - 1;
    *after = i + 1 < count ? i + 1 : clamp ? count - 1 : 0;
    return clamp && (i == 0 || i + 1 == count) ? 1.0f : 2.0f;
}

/* The slope along columns goes with u, that along rows against v, which points up in the map. */
static void write_normal(const ppmi_obj_picture *p, const float *heights, size_t x, size_t y,
                         float *out)
{
    const size_t width = p->info.width, height = p->info.height;
    size_t left, right, upper, lower;
    const float scale = SCALE * (float)width;
    const float across = neighbours(x, width, p->map->clamp, &left, &right);
    const float down = neighbours(y, height, p->map->clamp, &upper, &lower);
    const float du = scale * (heights[y * width + right] - heights[y * width + left]) / across;
    const float dv = scale * (heights[upper * width + x] - heights[lower * width + x]) / down;
    const float length = sqrtf(du * du + dv * dv + 1.0f);
    out[0] = 0.5f - 0.5f * du / length;
    out[1] = 0.5f - 0.5f * dv / length;
    out[2] = 0.5f + 0.5f / length;
}

static ppm_status add_normals(ppmi_obj_reader *r, const ppmi_obj_picture *p, const float *heights,
                              const char *path, ppm_image_id *out_id)
{
    const size_t width = p->info.width, height = p->info.height;
    float *normals = ppmi_alloc(r->context, width * height, 3 * sizeof *normals);
    if (!normals) return ppmi_obj_out_of_memory(r);
    for (size_t y = 0; y < height; ++y) {
        for (size_t x = 0; x < width; ++x) {
            write_normal(p, heights, x, y, normals + 3 * (y * width + x));
        }
    }
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .name = path,
                                 .role = PPM_IMAGE_DATA,
                                 .pixels = normals,
                                 .pixel_type = PPM_PIXELS_F32,
                                 .width = p->info.width,
                                 .height = p->info.height,
                                 .channels = 3};
    const ppm_status status = ppm_scene_add_image(r->scene, &desc, out_id);
    ppmi_free(r->context, normals);
    return status;
}

static ppm_status add_bump(ppmi_obj_reader *r, ppmi_obj_picture *p, const char *path,
                           ppm_image_id *out_id)
{
    float *heights =
        ppmi_alloc(r->context, (size_t)p->info.width * p->info.height, sizeof *heights);
    if (!heights) return ppmi_obj_out_of_memory(r);
    ppm_status status = read_heights(r, p, heights);
    if (status == PPM_STATUS_OK) status = add_normals(r, p, heights, path, out_id);
    ppmi_free(r->context, heights);
    return status;
}

ppm_status ppmi_obj_bump_image(ppmi_obj_reader *r, const ppmi_obj_map *map, const char *path,
                               ppm_image_id *out_id)
{
    ppmi_obj_picture p;
    const ppm_image_desc as_it_is = {
        .size = sizeof as_it_is, .name = path, .role = PPM_IMAGE_DATA, .path = path};
    ppm_status status = ppmi_obj_picture_open(r, map, path, PPM_IMAGE_DATA, &p);
    if (status != PPM_STATUS_OK) return status;
    const bool is_normals = map->channel == 0 && is_normal_map(&p);
    if (!is_normals) status = add_bump(r, &p, path, out_id);
    ppmi_obj_picture_close(r, &p);
    if (!is_normals) return status;
    ppmi_log(r->context, PPM_LOG_INFO,
             "%s: named as a bump map, taken as the normal map it looks "
             "like",
             path);
    return ppm_scene_add_image(r->scene, &as_it_is, out_id);
}
