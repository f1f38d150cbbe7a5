/* Maps of materials: the image, which is read once for each role, and its options. What is missing
 * or broken is left out with a warning, and the material's value alone is used. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "obj/obj_reader.h"

/* What a map is for, in messages. */
typedef struct place {
    const ppmi_obj_reader *reader;
    const ppmi_obj_material *material;
    const char *statement;
} place;

static const char *library_path(const place *p)
{
    return ppmi_obj_names_get(&p->reader->libraries, p->material->library);
}

static void warn(const place *p, const char *name, const char *reason)
{
    ppmi_log(p->reader->context, PPM_LOG_WARNING, "%s: line %zu: %s '%s': %s", library_path(p),
             p->material->line, p->statement, name, reason);
}

/* ---- images ---------------------------------------------------------------------------------- */

/* Statuses after which the import goes on without the image. */
static bool is_about_input(ppm_status status)
{
    return status == PPM_STATUS_INPUT_NOT_FOUND || status == PPM_STATUS_INPUT_INVALID ||
           status == PPM_STATUS_INPUT_UNSUPPORTED;
}

static ppm_status add_image(ppmi_obj_reader *r, const place *p, const char *folder,
                            const char *name, int32_t role, ppm_image_id *out_id)
{
    char *path = NULL;
    bool is_elsewhere = false;
    ppm_status status = ppmi_obj_find_file(r, folder, name, &path, &is_elsewhere);
    if (status != PPM_STATUS_OK) return status;
    if (!path) {
        warn(p, name, "left out: there is no such file in the folder of the OBJ");
        return PPM_STATUS_OK;
    }
    if (is_elsewhere) {
        ppmi_log(r->context, PPM_LOG_WARNING, "%s: line %zu: %s '%s': read from %s",
                 library_path(p), p->material->line, p->statement, name, path);
    }
    const ppm_image_desc desc = {.size = sizeof desc, .name = path, .role = role, .path = path};
    status = ppm_scene_add_image(r->scene, &desc, out_id);
    ppmi_free(r->context, path);
    if (!is_about_input(status)) return status;
    warn(p, name, "left out: see the message above");
    return PPM_STATUS_OK;
}

/* The image of a name in a role, from the table if it was asked for before. */
static ppm_status find_or_add_image(ppmi_obj_reader *r, const place *p, char *key,
                                    size_t folder_length, const char *name, int32_t role,
                                    ppm_image_id *out_id)
{
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
    key[2 + folder_length] = 0; /* now the folder in it is a string */
    const ppm_status status = add_image(r, p, key + 2, name, role, id);
    *out_id = *id;
    return status;
}

static ppm_status use_image(ppmi_obj_reader *r, const place *p, const char *name, int32_t role,
                            ppm_image_id *out_id)
{
    const char *library = library_path(p) + ppmi_obj_folder_length(r->path);
    const size_t folder_length = ppmi_obj_folder_length(library);
    const size_t size = folder_length + strlen(name) + 4;
    char *key = ppmi_alloc(r->context, size, 1); /* "role|folder|name" */
    if (!key) return ppmi_obj_out_of_memory(r);
    snprintf(key, size, "%d|%.*s|%s", (int)role, (int)folder_length, library, name);
    const ppm_status status = find_or_add_image(r, p, key, folder_length, name, role, out_id);
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

static void warn_of_options(const place *p, const ppmi_obj_map *map, const char *name)
{
    if (map->turbulence[0] != 0.0f || map->turbulence[1] != 0.0f) {
        warn(p, name, "-t (turbulence) has no effect");
    }
    if (map->base != 0.0f || map->gain != 1.0f) warn(p, name, "-mm has no effect");
}

ppm_status ppmi_obj_use_map(ppmi_obj_reader *r, const ppmi_obj_material *material,
                            const ppmi_obj_map *map, const char *statement, int32_t role,
                            ppm_texture *out_texture)
{
    const place p = {r, material, statement};
    ppm_image_id image = 0;
    *out_texture = (ppm_texture){0};
    if (map->name[0] == 0) return PPM_STATUS_OK;
    char *name = ppmi_obj_utf8(r->context, map->name, strlen(map->name));
    if (!name) return ppmi_obj_out_of_memory(r);
    const ppm_status status =
        use_image(r, &p, name, map->is_linear ? PPM_IMAGE_DATA : role, &image);
    if (status == PPM_STATUS_OK && image != 0) {
        out_texture->image = image;
        out_texture->wrap_u = out_texture->wrap_v = map->clamp ? PPM_WRAP_CLAMP : PPM_WRAP_REPEAT;
        apply_transform(map, out_texture);
        warn_of_options(&p, map, name);
    }
    ppmi_free(r->context, name);
    return status;
}
