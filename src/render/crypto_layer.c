#include "render/crypto_layer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ppm/render.h"
#include "render/crypto_name.h"

/* ---- names ----------------------------------------------------------------------------------- */

/* A name of the scene; where it has none it is told from others by its number, an id of the API. */
typedef struct crypto_name {
    const char *given;
    char made[24];
} crypto_name;

static const char *text_of(const crypto_name *name)
{
    return name->given[0] ? name->given : name->made;
}

static crypto_name name_of(const char *given, uint32_t index)
{
    crypto_name name = {.given = given};
    snprintf(name.made, sizeof name.made, "unnamed.%u", index + 1);
    return name;
}

static crypto_name name_at(const ppm_scene *scene, int32_t kind, uint32_t index)
{
    if (kind == PPM_LAYER_CRYPTO_MATERIAL) return name_of(scene->materials[index].name, index);
    const ppmi_instance *instance = &scene->instances[index];
    const bool is_asset = kind == PPM_LAYER_CRYPTO_ASSET && instance->asset[0];
    return name_of(is_asset ? instance->asset : instance->name, index);
}

static uint32_t count_names(const ppm_scene *scene, int32_t kind)
{
    return kind == PPM_LAYER_CRYPTO_MATERIAL ? scene->material_count : scene->instance_count;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(text_of(a), text_of(b));
}

/* ---- the manifest ---------------------------------------------------------------------------- */

static void mark_used(const ppm_scene *scene, int32_t kind, bool *is_used)
{
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_instance *instance = &scene->instances[i];
        if (!ppmi_instance_is_there(instance)) continue;
        if (kind != PPM_LAYER_CRYPTO_MATERIAL) {
            is_used[i] = true;
            continue;
        }
        const ppmi_mesh *mesh = &scene->meshes[instance->mesh];
        for (uint32_t k = 0; k < mesh->primitive_count; k++)
            is_used[mesh->primitives[k].material] = true;
    }
}

static char *write_manifest(ppm_context *context, const crypto_name *names, uint32_t count)
{
    const size_t per_id = sizeof ":\"00000000\",";
    size_t room = sizeof "{}";
    for (uint32_t i = 0; i < count; i++)
        room += ppmi_crypto_json_room(text_of(&names[i])) + per_id;
    char *manifest = ppmi_alloc(context, room, 1);
    if (!manifest) return NULL;
    char *to = manifest;
    *to++ = '{';
    for (uint32_t i = 0; i < count; i++) {
        if (i > 0 && compare_names(&names[i - 1], &names[i]) == 0) continue;
        if (i > 0) *to++ = ',';
        to += ppmi_crypto_json_write(text_of(&names[i]), to);
        to += snprintf(to, per_id, ":\"%08x\"", (unsigned)ppmi_crypto_id(text_of(&names[i])));
    }
    memcpy(to, "}", sizeof "}");
    return manifest;
}

/* Of the names in use, each once, in the order of their bytes. */
static char *make_manifest(ppm_context *context, const ppm_scene *scene, int32_t kind)
{
    const uint32_t most = count_names(scene, kind);
    crypto_name *names = ppmi_alloc(context, most, sizeof *names);
    bool *is_used = ppmi_alloc_zeroed(context, most, sizeof *is_used);
    char *manifest = NULL;
    if (names && is_used) {
        uint32_t count = 0;
        mark_used(scene, kind, is_used);
        for (uint32_t i = 0; i < most; i++) {
            if (is_used[i]) names[count++] = name_at(scene, kind, i);
        }
        qsort(names, count, sizeof *names, compare_names);
        manifest = write_manifest(context, names, count);
    }
    ppmi_free(context, names);
    ppmi_free(context, is_used);
    return manifest;
}

/* ---- pixels ---------------------------------------------------------------------------------- */

ppm_status ppmi_crypto_layer_init(ppm_context *context, const ppm_scene *scene, int32_t kind,
                                  uint32_t ranks, size_t pixel_count, ppmi_crypto_layer *layer)
{
    const uint32_t names = count_names(scene, kind);
    *layer = (ppmi_crypto_layer){.capacity = 2 * ranks};
    layer->ids = ppmi_alloc(context, names, sizeof *layer->ids);
    layer->manifest = make_manifest(context, scene, kind);
    layer->counts =
        ppmi_alloc_zeroed(context, pixel_count, layer->capacity * sizeof *layer->counts);
    if (!layer->ids || !layer->manifest || !layer->counts) {
        ppmi_crypto_layer_deinit(context, layer);
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY,
                         "out of memory: Cryptomatte of %zu pixels, %u ranks", pixel_count, ranks);
    }
    for (uint32_t i = 0; i < names; i++) {
        const crypto_name name = name_at(scene, kind, i);
        layer->ids[i] = ppmi_crypto_id(text_of(&name));
    }
    return PPM_STATUS_OK;
}

void ppmi_crypto_layer_deinit(ppm_context *context, ppmi_crypto_layer *layer)
{
    ppmi_free(context, layer->ids);
    ppmi_free(context, layer->manifest);
    ppmi_free(context, layer->counts);
    *layer = (ppmi_crypto_layer){0};
}

void ppmi_crypto_layer_add(ppmi_crypto_layer *layer, size_t pixel, uint32_t index)
{
    const uint32_t id = layer->ids[index];
    ppmi_crypto_count *counts = layer->counts + pixel * layer->capacity, *least = counts;
    for (uint32_t i = 0; i < layer->capacity; i++) {
        if (counts[i].id == id || counts[i].id == 0) {
            counts[i].id = id;
            counts[i].samples++;
            return;
        }
        if (counts[i].samples <= least->samples) least = &counts[i];
    }
    least->id = id;
    least->samples++;
}

/* By coverage, then by id: the order of arrival is not part of the picture. */
static bool is_before(const ppmi_crypto_count *a, const ppmi_crypto_count *b)
{
    return a->samples != b->samples ? a->samples > b->samples : a->id < b->id;
}

/* The two of the ranks of the pair, with samples 0 where there are less. */
static void find_pair(const ppmi_crypto_count *counts, uint32_t capacity, uint32_t pair,
                      ppmi_crypto_count found[2])
{
    ppmi_crypto_count sorted[2 * PPMI_CRYPTO_MAX_RANKS + 2] = {{0, 0}};
    for (uint32_t i = 0; i < capacity && counts[i].id != 0; i++) {
        uint32_t place = i;
        for (; place > 0 && is_before(&counts[i], &sorted[place - 1]); place--)
            sorted[place] = sorted[place - 1];
        sorted[place] = counts[i];
    }
    found[0] = sorted[2 * pair];
    found[1] = sorted[2 * pair + 1];
}

void ppmi_crypto_layer_read(const ppmi_crypto_layer *layer, size_t pixel_count, uint32_t pair,
                            uint64_t samples, float *values)
{
    for (size_t pixel = 0; pixel < pixel_count; pixel++) {
        ppmi_crypto_count found[2];
        find_pair(layer->counts + pixel * layer->capacity, layer->capacity, pair, found);
        for (int i = 0; i < 2; i++) {
            float *value = values + 4 * pixel + 2 * i;
            memcpy(value, &found[i].id, sizeof *value);
            value[1] = (float)((double)found[i].samples / (double)samples);
        }
    }
}
