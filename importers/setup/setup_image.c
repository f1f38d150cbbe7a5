/* Files that a setup names, and textures made of them. A name is a path from the setup file's
 * folder; whoever is sent a setup file must not read outside of it by accident. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/path.h"
#include "setup/setup_file.h"

static ppm_status check_file(const ppmi_setup_value *value, const char *path)
{
    struct stat found;
    const char *reason = NULL;
    if (stat(path, &found) != 0 || access(path, R_OK) != 0) {
        reason = strerror(errno);
    } else if (S_ISDIR(found.st_mode)) {
        reason = "it is a folder";
    }
    if (!reason) return PPM_STATUS_OK;
    return ppmi_fail(value->setup->context, PPM_STATUS_INPUT_NOT_FOUND,
                     "%s: %s: cannot read %s: %s", value->setup->path, value->place, path, reason);
}

ppm_status ppmi_setup_find_file(const ppmi_setup_value *value, const char *name, char **out_path)
{
    ppm_setup *setup = value->setup;
    const char *slash = strrchr(setup->path, '/');
    const size_t folder = slash && name[0] != '/' ? (size_t)(slash - setup->path) + 1 : 0;
    if (!setup->allows_outside && (name[0] == '/' || !ppmi_path_stays_inside(name))) {
        return ppmi_setup_fail(value,
                               "\"%s\" lies outside of the setup file's folder; such files "
                               "are read only if that is allowed (--allow-outside)",
                               name);
    }
    char *path = ppmi_alloc(setup->context, folder + strlen(name) + 1, 1);
    if (!path) return ppmi_setup_out_of_memory(setup);
    memcpy(path, setup->path, folder);
    strcpy(path + folder, name);
    const ppm_status status = check_file(value, path);
    if (status == PPM_STATUS_OK) {
        *out_path = path;
    } else {
        ppmi_free(setup->context, path);
    }
    return status;
}

/* Takes path. */
static ppm_status add_image(const ppmi_setup_value *value, const char *name, char *path,
                            int32_t role, ppm_image_id *out_id)
{
    ppm_setup *setup = value->setup;
    const ppm_image_desc desc = {.size = sizeof desc, .name = name, .role = role, .path = path};
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    if (ppmi_setup_grow(setup->context, (void **)&setup->images, setup->image_count,
                        &setup->image_capacity, sizeof *setup->images)) {
        status = ppm_scene_add_image(setup->scene, &desc, out_id);
    }
    if (status != PPM_STATUS_OK) {
        ppmi_free(setup->context, path);
        return status == PPM_STATUS_OUT_OF_MEMORY
                   ? ppmi_setup_out_of_memory(setup)
                   : ppmi_setup_fail(value, "\"%s\": see the message above", name);
    }
    setup->images[setup->image_count++] =
        (ppmi_setup_image){.path = path, .role = role, .id = *out_id};
    return PPM_STATUS_OK;
}

ppm_status ppmi_setup_use_image(const ppmi_setup_value *value, const char *name, int32_t role,
                                ppm_image_id *out_id)
{
    ppm_setup *setup = value->setup;
    char *path = NULL;
    *out_id = 0;
    const ppm_status status = ppmi_setup_find_file(value, name, &path);
    if (status != PPM_STATUS_OK) return status;
    for (size_t i = 0; setup->scene && i < setup->image_count; i++) {
        const ppmi_setup_image *image = &setup->images[i];
        if (image->role == role && strcmp(image->path, path) == 0) *out_id = image->id;
    }
    if (setup->scene && *out_id == 0) return add_image(value, name, path, role, out_id);
    ppmi_free(setup->context, path);
    return PPM_STATUS_OK;
}

/* ---- textures -------------------------------------------------------------------------------- */

typedef struct texture_words {
    const char *image;
    int32_t uv_set, wrap, wrap_u, wrap_v, filter;
    double scale[2], offset[2], rotation;
} texture_words;

enum { IMAGE = 1, WRAP = 4, WRAP_U = 8, WRAP_V = 16, SCALE = 64, OFFSET = 128, ROTATION = 256 };

static const ppmi_setup_word wraps[] = {
    {"repeat", PPM_WRAP_REPEAT}, {"clamp", PPM_WRAP_CLAMP}, {"mirror", PPM_WRAP_MIRROR}, {NULL, 0}};
static const ppmi_setup_word filters[] = {
    {"linear", PPM_FILTER_LINEAR}, {"nearest", PPM_FILTER_NEAREST}, {NULL, 0}};
#define FIELD(member) .field = offsetof(texture_words, member)
static const ppmi_setup_key keys[] = {
    {"image", PPMI_SETUP_TEXT, FIELD(image)},
    {"uv_set", PPMI_SETUP_INTEGER, FIELD(uv_set), 0, PPM_MAX_UV_SETS - 1},
    {"wrap", PPMI_SETUP_WORD, FIELD(wrap), .words = wraps},
    {"wrap_u", PPMI_SETUP_WORD, FIELD(wrap_u), .words = wraps},
    {"wrap_v", PPMI_SETUP_WORD, FIELD(wrap_v), .words = wraps},
    {"filter", PPMI_SETUP_WORD, FIELD(filter), .words = filters},
    {"scale", PPMI_SETUP_REALS, FIELD(scale), -1e6, 1e6, .count = 2},
    {"offset", PPMI_SETUP_REALS, FIELD(offset), -1e6, 1e6, .count = 2},
    {"rotation", PPMI_SETUP_REAL, FIELD(rotation), -360, 360},
};
#undef FIELD

/* As KHR_texture_transform: translation * rotation * scale, coordinates with v down. */
static void fill_transform(const texture_words *words, ppm_texture *out)
{
    const double angle = words->rotation * 3.14159265358979323846 / 180.0;
    const double c = cos(angle), s = sin(angle);
    const double m[6] = {words->scale[0] * c,  words->scale[1] * s, words->offset[0],
                         -words->scale[0] * s, words->scale[1] * c, words->offset[1]};
    out->has_transform = 1;
    for (int i = 0; i < 6; i++)
        out->uv_transform[i] = (float)m[i];
}

ppm_status ppmi_setup_read_texture(const ppmi_setup_value *value, int32_t role, ppm_texture *out)
{
    texture_words words = {.scale = {1.0, 1.0}};
    uint64_t given = 0;
    ppm_texture texture = {0};
    ppm_status status = PPM_STATUS_OK;
    if (json_is_null(value->json)) {
        *out = texture;
        return PPM_STATUS_OK;
    }
    if (json_is_object(value->json)) {
        status = ppmi_setup_read_object(value, keys, sizeof keys / sizeof keys[0], &words, &given);
        if (status == PPM_STATUS_OK && !(given & IMAGE)) {
            status = ppmi_setup_fail(value, "no \"image\": expected the name of a file");
        }
    } else if (json_is_string(value->json)) {
        status = ppmi_setup_read_value(value, &keys[0], &words);
    } else {
        status = ppmi_setup_refuse(value, "the name of a file, an object with \"image\", or null");
    }
    if (status == PPM_STATUS_OK) {
        status = ppmi_setup_use_image(value, words.image, role, &texture.image);
    }
    if (status != PPM_STATUS_OK) return status;
    texture.uv_set = (uint32_t)words.uv_set;
    texture.wrap_u = given & WRAP_U ? words.wrap_u : words.wrap;
    texture.wrap_v = given & WRAP_V ? words.wrap_v : words.wrap;
    texture.filter = words.filter;
    if (given & (SCALE | OFFSET | ROTATION)) fill_transform(&words, &texture);
    *out = texture;
    return PPM_STATUS_OK;
}
