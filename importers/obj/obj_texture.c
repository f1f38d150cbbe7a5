/* Maps of materials: their images, each of which is read or made once for each use of its kind, and
 * their options. What is missing or broken is left out with a warning, and the material's value
 * alone is used. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "obj/obj_reader.h"

/* ---- messages -------------------------------------------------------------------------------- */

static void warn(const ppmi_obj_reader *r, const ppmi_obj_material *material, int32_t map,
                 const char *reason)
{
    ppmi_log(r->context, PPM_LOG_WARNING, "%s: line %zu: %s '%s': %s",
             ppmi_obj_names_get(&r->libraries, material->library), material->maps[map].line,
             ppmi_obj_map_word(map), material->maps[map].name, reason);
}

/* Statuses after which the import goes on without the image. */
static bool is_about_input(ppm_status status)
{
    return status == PPM_STATUS_INPUT_NOT_FOUND || status == PPM_STATUS_INPUT_INVALID ||
           status == PPM_STATUS_INPUT_UNSUPPORTED;
}

/* The file of a map, the caller's to free; NULL, after a warning, if there is none. */
static ppm_status locate(ppmi_obj_reader *r, const ppmi_obj_material *material, int32_t map,
                         char **out_path)
{
    bool is_elsewhere = false;
    char reason[512];
    const char *library = ppmi_obj_names_get(&r->libraries, material->library);
    const ppm_status status =
        ppmi_obj_find_file(r, library, material->maps[map].name, out_path, &is_elsewhere);
    if (status != PPM_STATUS_OK) return status;
    if (!*out_path) {
        warn(r, material, map,
             "left out: there is no such file in the folder of the OBJ, nor in a texture path");
    } else if (is_elsewhere) {
        snprintf(reason, sizeof reason, "read from %s", *out_path);
        warn(r, material, map, reason);
    }
    return PPM_STATUS_OK;
}

/* ---- images, once ---------------------------------------------------------------------------- */

/* What makes an image that is not there yet. */
typedef struct request {
    ppmi_obj_reader *reader;
    const ppmi_obj_material *material;
    int32_t map, role;
    const ppmi_obj_mixture *mixture;
    ppm_status (*make)(const struct request *request, ppm_image_id *out_id);
} request;

/* The image of a key: from the table, or made and put there. */
static ppm_status find_or_make(const request *q, const char *key, ppm_image_id *out_id)
{
    ppmi_obj_reader *r = q->reader;
    uint32_t index;
    const uint32_t known = ppmi_obj_names_count(&r->images);
    if (!ppmi_obj_names_add(r->context, &r->images, key, strlen(key), &index)) {
        return ppmi_obj_out_of_memory(r);
    }
    if (index < known) {
        *out_id = ((const ppm_image_id *)r->image_ids.items)[index];
        return PPM_STATUS_OK;
    }
    ppm_image_id *id = ppmi_obj_push(r->context, &r->image_ids, 1, sizeof *id);
    if (!id) return ppmi_obj_out_of_memory(r);
    *id = 0;
    const ppm_status status = q->make(q, id);
    *out_id = *id;
    return status;
}

/* What the pixels of a map depend on, but for where the library lies. */
static size_t describe_map(const ppmi_obj_map *map, char *out, size_t size)
{
    if (!ppmi_obj_map_is_named(map)) return (size_t)snprintf(out, size, "-|");
    return (size_t)snprintf(out, size, "%d %d %d %g %g %s|", map->channel, map->is_linear,
                            map->clamp, (double)map->base, (double)map->gain, map->name);
}

static ppm_status use_image(const request *q, const char *kind, ppm_image_id *out_id)
{
    ppmi_obj_reader *r = q->reader;
    const ppmi_obj_map none = {0}, *maps = q->material->maps;
    const ppmi_obj_map *first = &maps[q->map], *second = &none;
    if (q->mixture && q->mixture->maps[1] >= 0) second = &maps[q->mixture->maps[1]];
    const char *library = ppmi_obj_names_get(&r->libraries, q->material->library);
    const int folder = (int)ppmi_obj_folder_length(library);
    const size_t size = strlen(kind) + (size_t)folder + (first->name ? strlen(first->name) : 0) +
                        (second->name ? strlen(second->name) : 0) + 256;
    char *key = ppmi_alloc(r->context, size, 1);
    if (!key) return ppmi_obj_out_of_memory(r);
    size_t used = (size_t)snprintf(key, size, "%s %d|%.*s|", kind, (int)q->role, folder, library);
    used += describe_map(first, key + used, size - used);
    describe_map(second, key + used, size - used);
    const ppm_status status = find_or_make(q, key, out_id);
    ppmi_free(r->context, key);
    return status;
}

/* ---- options --------------------------------------------------------------------------------- */

/* -s and -o are a scale and then an offset of coordinates whose v points up. */
static void apply_transform(const ppmi_obj_map *map, ppm_texture *out)
{
    const float *s = map->scale, *o = map->offset;
    if (s[0] == 1.0f && s[1] == 1.0f && o[0] == 0.0f && o[1] == 0.0f) return;
    const float m[6] = {s[0], 0.0f, o[0], 0.0f, s[1], 1.0f - s[1] - o[1]};
    out->has_transform = 1;
    for (int i = 0; i < 6; ++i) {
        out->uv_transform[i] = fminf(fmaxf(m[i], -1e15f), 1e15f);
    }
}

static bool is_placed_alike(const ppmi_obj_map *a, const ppmi_obj_map *b)
{
    return memcmp(a->scale, b->scale, sizeof a->scale) == 0 &&
           memcmp(a->offset, b->offset, sizeof a->offset) == 0 && a->clamp == b->clamp;
}

static void fill_texture(const request *q, ppm_image_id image, int32_t map, ppm_texture *out)
{
    const ppmi_obj_map *from = &q->material->maps[map];
    if (image == 0) return;
    out->image = image;
    out->wrap_u = out->wrap_v = from->clamp ? PPM_WRAP_CLAMP : PPM_WRAP_REPEAT;
    out->filter = from->is_sharp ? PPM_FILTER_NEAREST : PPM_FILTER_LINEAR;
    apply_transform(from, out);
    if (from->has_turbulence) {
        warn(q->reader, q->material, map, "-t (turbulence) has no effect");
    }
}

/* ---- a map alone ----------------------------------------------------------------------------- */

static ppm_status make_plain(const request *q, ppm_image_id *out_id)
{
    char *path = NULL;
    ppm_status status = locate(q->reader, q->material, q->map, &path);
    if (status != PPM_STATUS_OK || !path) return status;
    const ppm_image_desc desc = {.size = sizeof desc, .name = path, .role = q->role, .path = path};
    status = ppm_scene_add_image(q->reader->scene, &desc, out_id);
    ppmi_free(q->reader->context, path);
    if (!is_about_input(status)) return status;
    warn(q->reader, q->material, q->map, "left out: see the message above");
    return PPM_STATUS_OK;
}

ppm_status ppmi_obj_use_map(ppmi_obj_reader *r, const ppmi_obj_material *material, int32_t map,
                            int32_t role, ppm_texture *out_texture)
{
    ppm_image_id image = 0;
    const ppmi_obj_map *from = &material->maps[map];
    const request q = {.reader = r,
                       .material = material,
                       .map = map,
                       .role = from->is_linear ? PPM_IMAGE_DATA : role,
                       .make = make_plain};
    *out_texture = (ppm_texture){0};
    if (!ppmi_obj_map_is_named(from)) return PPM_STATUS_OK;
    const ppm_status status = use_image(&q, "image", &image);
    if (status == PPM_STATUS_OK) fill_texture(&q, image, map, out_texture);
    return status;
}

/* ---- mixtures -------------------------------------------------------------------------------- */

static ppm_status make_mixture(const request *q, ppm_image_id *out_id)
{
    char *paths[2] = {NULL, NULL};
    ppm_status status = PPM_STATUS_OK;
    for (int i = 0; i < 2 && status == PPM_STATUS_OK; ++i) {
        const int32_t map = q->mixture->maps[i];
        const bool is_named = map >= 0 && ppmi_obj_map_is_named(&q->material->maps[map]);
        if (is_named) status = locate(q->reader, q->material, map, &paths[i]);
    }
    if (status == PPM_STATUS_OK) {
        status = ppmi_obj_mix_images(q->reader, q->material, q->mixture,
                                     (const char *const[2]){paths[0], paths[1]}, out_id);
    }
    ppmi_free(q->reader->context, paths[0]);
    ppmi_free(q->reader->context, paths[1]);
    return status;
}

ppm_status ppmi_obj_use_mixture(ppmi_obj_reader *r, const ppmi_obj_material *material,
                                const ppmi_obj_mixture *mixture, ppm_texture *out_texture)
{
    char kind[96];
    ppm_image_id image = 0;
    const ppmi_obj_map *first = &material->maps[mixture->maps[0]];
    const ppmi_obj_map *second =
        mixture->maps[1] >= 0 ? &material->maps[mixture->maps[1]] : &(ppmi_obj_map){0};
    const bool has_first = ppmi_obj_map_is_named(first), has_second = ppmi_obj_map_is_named(second);
    const request q = {.reader = r,
                       .material = material,
                       .map = mixture->maps[0],
                       .role = mixture->role,
                       .mixture = mixture,
                       .make = make_mixture};
    *out_texture = (ppm_texture){0};
    if (!has_first && !has_second) return PPM_STATUS_OK;
    snprintf(kind, sizeof kind, "%s %g %g %g", mixture->kind, (double)mixture->parameter,
             (double)mixture->missing[0], (double)mixture->missing[1]);
    const ppm_status status = use_image(&q, kind, &image);
    if (status != PPM_STATUS_OK) return status;
    fill_texture(&q, image, mixture->maps[has_first ? 0 : 1], out_texture);
    if (image != 0 && has_first && has_second && !is_placed_alike(first, second)) {
        warn(r, material, mixture->maps[1],
             "-s, -o and -clamp are taken from the map that it is "
             "mixed with, as they differ");
    }
    return PPM_STATUS_OK;
}

/* ---- bumps ----------------------------------------------------------------------------------- */

static ppm_status make_bump(const request *q, ppm_image_id *out_id)
{
    char *path = NULL;
    ppm_status status = locate(q->reader, q->material, q->map, &path);
    if (status != PPM_STATUS_OK || !path) return status;
    status = ppmi_obj_bump_image(q->reader, &q->material->maps[q->map], path, out_id);
    ppmi_free(q->reader->context, path);
    if (!is_about_input(status)) return status;
    warn(q->reader, q->material, q->map, "left out: see the message above");
    return PPM_STATUS_OK;
}

ppm_status ppmi_obj_use_bump(ppmi_obj_reader *r, const ppmi_obj_material *material, int32_t map,
                             ppm_texture *out_texture)
{
    ppm_image_id image = 0;
    const request q = {
        .reader = r, .material = material, .map = map, .role = PPM_IMAGE_DATA, .make = make_bump};
    *out_texture = (ppm_texture){0};
    if (!ppmi_obj_map_is_named(&material->maps[map])) return PPM_STATUS_OK;
    const ppm_status status = use_image(&q, "bump", &image);
    if (status == PPM_STATUS_OK) fill_texture(&q, image, map, out_texture);
    return status;
}
