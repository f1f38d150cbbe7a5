#include "render/layer_list.h"

#include <stdio.h>
#include <string.h>

typedef struct layer_row {
    const char *name;
    uint32_t channel_count;
    const char *channel_names[4];
    bool is_exact;
} layer_row;

/* Names that compositors know; channels as OpenEXR and Blender name them. */
static const layer_row rows[PPM_LAYER_KINDS] = {
    [PPM_LAYER_COMBINED] = {"combined", 4, {"R", "G", "B", "A"}, false},
    [PPM_LAYER_DIFFUSE_DIRECT] = {"diffuse_direct", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_DIFFUSE_INDIRECT] = {"diffuse_indirect", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_GLOSSY_DIRECT] = {"glossy_direct", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_GLOSSY_INDIRECT] = {"glossy_indirect", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_TRANSMISSION] = {"transmission", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_EMISSION] = {"emission", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_ENVIRONMENT] = {"environment", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_CAUSTICS] = {"caustics", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_VOLUME] = {"volume", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_LIGHT_GROUP] = {"light", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_GROUP_CAUSTICS] = {"caustics", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_VARIANCE] = {"variance", 3, {"R", "G", "B"}, true},
    [PPM_LAYER_PHOTON_DENSITY] = {"photon_density", 1, {"V"}, true},
    [PPM_LAYER_RADIUS] = {"radius", 1, {"V"}, true},
    [PPM_LAYER_ALBEDO] = {"albedo", 3, {"R", "G", "B"}, false},
    [PPM_LAYER_NORMAL] = {"normal", 3, {"X", "Y", "Z"}, false},
    [PPM_LAYER_POSITION] = {"position", 3, {"X", "Y", "Z"}, true},
    [PPM_LAYER_DEPTH] = {"depth", 1, {"Z"}, true},
    [PPM_LAYER_UV] = {"uv", 2, {"U", "V"}, true},
    [PPM_LAYER_OBJECT_INDEX] = {"object_index", 1, {"V"}, true},
    [PPM_LAYER_MATERIAL_INDEX] = {"material_index", 1, {"V"}, true},
    [PPM_LAYER_MOTION] = {"motion", 4, {"X", "Y", "Z", "W"}, true},
    [PPM_LAYER_CRYPTO_OBJECT] = {"CryptoObject", 4, {"R", "G", "B", "A"}, true},
    [PPM_LAYER_CRYPTO_MATERIAL] = {"CryptoMaterial", 4, {"R", "G", "B", "A"}, true},
    [PPM_LAYER_CRYPTO_ASSET] = {"CryptoAsset", 4, {"R", "G", "B", "A"}, true},
    [PPM_LAYER_CATCHER] = {"catcher", 4, {"R", "G", "B", "A"}, false},
    [PPM_LAYER_LIGHT_VARIANCE] = {"variance", 3, {"R", "G", "B"}, true},
    [PPM_LAYER_DENOISED] = {"denoised", 4, {"R", "G", "B", "A"}, false},
};

const char *ppm_layer_kind_name(int32_t kind)
{
    return kind >= 0 && kind < PPM_LAYER_KINDS ? rows[kind].name : NULL;
}

static bool is_crypto(int32_t kind)
{
    return kind >= PPM_LAYER_CRYPTO_OBJECT && kind <= PPM_LAYER_CRYPTO_ASSET;
}

static bool is_of_group(int32_t kind)
{
    return kind == PPM_LAYER_LIGHT_GROUP || kind == PPM_LAYER_GROUP_CAUSTICS;
}

/* How many layers a kind has. */
static uint32_t count_of(const ppmi_job *job, int32_t kind)
{
    if (kind == PPM_LAYER_COMBINED) return 1;
    if (!(job->options->layers & PPM_LAYER_BIT(kind))) return 0;
    if (is_crypto(kind)) return job->options->cryptomatte_ranks / 2;
    if (is_of_group(kind)) return job->groups ? job->groups->count : 0;
    if (kind == PPM_LAYER_CATCHER) return ppm_scene_catcher_count(job->world.scene) > 0;
    if (kind == PPM_LAYER_LIGHT_VARIANCE) return PPM_LAYER_VOLUME; /* classes count from 1 */
    return 1;
}

static void name_layer(const ppmi_job *job, const ppmi_layer *layer, char *name, size_t size)
{
    const char *const row_name = rows[layer->kind].name;
    if (is_crypto(layer->kind)) {
        snprintf(name, size, "%s%02u", row_name, layer->number);
    } else if (is_of_group(layer->kind)) {
        snprintf(name, size, "%s.%s", row_name, job->groups->names[layer->number]);
    } else if (layer->kind == PPM_LAYER_LIGHT_VARIANCE) {
        snprintf(name, size, "%s.%s", row_name,
                 rows[PPM_LAYER_DIFFUSE_DIRECT + layer->number].name);
    } else {
        snprintf(name, size, "%s", row_name);
    }
}

static bool add_layer(const ppmi_job *job, ppmi_layer_list *list, int32_t kind, uint32_t number)
{
    char name[512];
    ppmi_layer layer = {.kind = kind,
                        .number = number,
                        .channel_count = rows[kind].channel_count,
                        .channel_names = rows[kind].channel_names,
                        .is_exact = rows[kind].is_exact};
    name_layer(job, &layer, name, sizeof name);
    layer.name = ppmi_string_copy(job->context, name);
    if (!layer.name) return false;
    list->layers[list->count++] = layer;
    return true;
}

ppm_status ppmi_layer_list_init(const ppmi_job *job, ppmi_layer_list *list)
{
    size_t count = 0;
    for (int32_t kind = 0; kind < PPM_LAYER_KINDS; kind++)
        count += count_of(job, kind);
    *list = (ppmi_layer_list){0};
    list->layers = ppmi_alloc_zeroed(job->context, count, sizeof *list->layers);
    bool has_memory = list->layers != NULL;
    for (int32_t kind = 0; kind < PPM_LAYER_KINDS; kind++) {
        for (uint32_t i = 0; has_memory && i < count_of(job, kind); i++)
            has_memory = add_layer(job, list, kind, i);
    }
    if (has_memory) return PPM_STATUS_OK;
    ppmi_layer_list_deinit(job->context, list);
    return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu layers", count);
}

void ppmi_layer_list_deinit(ppm_context *context, ppmi_layer_list *list)
{
    for (uint32_t i = 0; i < list->count; i++)
        ppmi_free(context, list->layers[i].name);
    ppmi_free(context, list->layers);
    *list = (ppmi_layer_list){0};
}

bool ppmi_layers_have(const ppm_render_options *options, int32_t first, int32_t last)
{
    uint64_t kept = options->layers;
    if (kept & PPM_LAYER_BIT(PPM_LAYER_DENOISED)) kept |= PPMI_LAYERS_TO_DENOISE;
    for (int32_t kind = first; kind <= last; kind++) {
        if (kept & PPM_LAYER_BIT(kind)) return true;
    }
    return false;
}
