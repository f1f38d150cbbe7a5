/* Names that compositors know (docs/compositing.md).
 *
 * The picture has R, G, B and A without a layer, and depth is Z: what OpenEXR reserves for them,
 * and what every program shows first. Other channels are LAYER.CHANNEL. A dot in the name of a
 * light group would split it: programs take what is behind the last dots for the pass and the
 * channel.
 *
 * The DWA compressions treat channels called R, G, B, Y, RY and BY as colours, which they round;
 * the small letters are packed without loss (OpenEXR's ImfDwaCompressor, rules by the channel's
 * suffix). Ids and other exact colours go by small letters therefore, as Blender writes its own
 * Cryptomattes; all that is not light is kept from lossy compressions by parts of its own
 * (output_layers.c). */
#include "api/layer_channels.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "render/crypto_name.h"

/* Blender leaves out what is longer; OpenEXR's names have at most 255 bytes. Of a channel's name, a
 * dot and a letter are not the layer's. */
enum { CHANNEL_NAME_MAX = 63, LAYER_NAME_MAX = CHANNEL_NAME_MAX - 2, NAME_SIZE = 512 };

/* The name of one light group as a part of a channel's name. */
static void clean_group_name(char *name)
{
    for (; *name; name++) {
        const unsigned char letter = (unsigned char)*name;
        if (letter == '.' || iscntrl(letter)) *name = '_';
    }
}

/* At most length, and not within a letter of UTF-8. */
static size_t whole_letters(const char *name, size_t length)
{
    while (length > 0 && ((unsigned char)name[length] & 0xc0) == 0x80)
        length--;
    return length;
}

/* Cuts a name to length bytes, of which the last nine are a mark and a hash of the whole: names
 * that begin alike stay apart, and each is the same in every file. */
static void shorten_name(char *name, size_t length)
{
    enum { HASH_SIZE = 9 };
    const uint32_t hash = ppmi_murmur3(name, strlen(name), 0);
    if (strlen(name) <= length) return;
    const size_t end = whole_letters(name, length - HASH_SIZE);
    snprintf(name + end, HASH_SIZE + 1, "~%08x", hash);
}

static bool is_of_group(int32_t kind)
{
    return kind == PPM_LAYER_LIGHT_GROUP || kind == PPM_LAYER_GROUP_CAUSTICS;
}

static bool is_taken(const ppmi_layer_channels *all, uint32_t count, const char *name)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(all->layer_names[i], name) == 0) return true;
    }
    return false;
}

/* "light.Key.001" is called "light.Key_001"; a second one of that name "light.Key_001_2". */
static char *name_layer(ppm_context *context, const ppmi_layer_channels *all, uint32_t index)
{
    const ppm_layer_info *const layer = &all->layers[index];
    const char *const dot = is_of_group(layer->kind) ? strchr(layer->name, '.') : NULL;
    if (!dot) return ppmi_string_copy(context, layer->name);
    char base[NAME_SIZE], name[NAME_SIZE];
    snprintf(base, sizeof base, "%s", layer->name);
    shorten_name(base, LAYER_NAME_MAX);
    clean_group_name(base + (dot + 1 - layer->name));
    snprintf(name, sizeof name, "%s", base);
    for (uint32_t number = 2; is_taken(all, index, name); number++) {
        snprintf(name, sizeof name, "%.400s_%u", base, number);
        if (strlen(name) <= LAYER_NAME_MAX) continue;
        const size_t most = whole_letters(base, LAYER_NAME_MAX - 11);
        snprintf(name, sizeof name, "%.*s_%u", (int)most, base, number);
    }
    return ppmi_string_copy(context, name);
}

static char *name_channel(ppm_context *context, const ppm_layer_info *layer, const char *layer_name,
                          uint32_t index)
{
    char name[NAME_SIZE], channel[16];
    snprintf(channel, sizeof channel, "%s", layer->channel_names[index]);
    if (layer->is_exact && strcmp(layer->channel_names[0], "R") == 0) {
        channel[0] = (char)tolower((unsigned char)channel[0]);
    }
    const bool is_bare = layer->kind == PPM_LAYER_COMBINED || layer->kind == PPM_LAYER_DEPTH;
    snprintf(name, sizeof name, "%.480s%s%s", is_bare ? "" : layer_name, is_bare ? "" : ".",
             channel);
    return ppmi_string_copy(context, name);
}

static bool fill_layer(ppm_context *context, ppmi_layer_channels *all, uint32_t index, bool is_half)
{
    const ppm_layer_info *const layer = &all->layers[index];
    all->layer_names[index] = name_layer(context, all, index);
    if (!all->layer_names[index]) return false;
    for (uint32_t c = 0; c < layer->channel_count; c++) {
        const uint32_t at = all->first[index] + c;
        all->channel_names[at] = name_channel(context, layer, all->layer_names[index], c);
        if (!all->channel_names[at]) return false;
        all->channels[at] = (ppmi_layered_channel){
            .name = all->channel_names[at],
            .store = is_half && !layer->is_exact ? PPMI_STORE_HALF : PPMI_STORE_FLOAT};
    }
    return true;
}

bool ppmi_layer_is_data(const ppm_layer_info *layer)
{
    return layer->is_exact || strcmp(layer->channel_names[0], "R") != 0;
}

/* The layers that are data or those that are not, behind those that are listed. */
static ppm_status list_some(const ppm_render *render, uint32_t count, bool is_any, bool is_data,
                            ppmi_layer_channels *all)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t at = all->layer_count;
        ppm_layer_info layer = {.size = sizeof layer};
        const ppm_status status = ppm_render_get_layer(render, i, &layer);
        if (status != PPM_STATUS_OK) return status;
        if (!is_any && ppmi_layer_is_data(&layer) != is_data) continue;
        all->layers[at] = layer;
        all->numbers[at] = i;
        all->first[at + 1] = all->first[at] + layer.channel_count;
        all->layer_count++;
    }
    return PPM_STATUS_OK;
}

static ppm_status list_layers(ppm_context *context, const ppm_render *render, bool has_layers,
                              bool is_sorted, ppmi_layer_channels *all)
{
    const uint32_t count = has_layers ? ppm_render_layer_count(render) : 1;
    all->layers = ppmi_alloc_zeroed(context, count, sizeof *all->layers);
    all->layer_names = ppmi_alloc_zeroed(context, count, sizeof *all->layer_names);
    all->first = ppmi_alloc_zeroed(context, count + 1, sizeof *all->first);
    all->numbers = ppmi_alloc_zeroed(context, count, sizeof *all->numbers);
    if (!all->layers || !all->layer_names || !all->first || !all->numbers) {
        return PPM_STATUS_OUT_OF_MEMORY;
    }
    ppm_status status = list_some(render, count, !is_sorted, false, all);
    all->data_begin = all->layer_count;
    if (status == PPM_STATUS_OK && is_sorted) status = list_some(render, count, false, true, all);
    return status;
}

ppm_status ppmi_layer_channels_init(ppm_context *context, const ppm_render *render, bool is_half,
                                    bool has_layers, bool is_sorted, ppmi_layer_channels *all)
{
    *all = (ppmi_layer_channels){0};
    ppm_status status = list_layers(context, render, has_layers, is_sorted, all);
    if (status == PPM_STATUS_OK) {
        const uint32_t count = all->first[all->layer_count];
        all->channel_names = ppmi_alloc_zeroed(context, count, sizeof *all->channel_names);
        all->channels = ppmi_alloc_zeroed(context, count, sizeof *all->channels);
        bool has_memory = all->channel_names && all->channels;
        for (uint32_t i = 0; i < all->layer_count && has_memory; i++)
            has_memory = fill_layer(context, all, i, is_half);
        if (!has_memory) status = PPM_STATUS_OUT_OF_MEMORY;
    }
    if (status != PPM_STATUS_OUT_OF_MEMORY) return status;
    return ppmi_fail(context, status, "out of memory: names of layers");
}

/* ---- the manifest of names ------------------------------------------------------------------- */

static bool is_renamed(const ppmi_layer_channels *all, uint32_t i)
{
    return strcmp(all->layer_names[i], all->layers[i].name) != 0;
}

/* Room for one pair, or for both ends, by what surrounds it: {"":"",} and a zero. */
static size_t manifest_room(const ppmi_layer_channels *all)
{
    size_t room = 0;
    for (uint32_t i = 0; i < all->layer_count; i++) {
        if (!is_renamed(all, i)) continue;
        room += ppmi_crypto_json_room(all->layer_names[i]) +
                ppmi_crypto_json_room(all->layers[i].name) + 8;
    }
    return room;
}

ppm_status ppmi_layer_channels_manifest(ppm_context *context, const ppmi_layer_channels *all,
                                        char **out_text)
{
    const size_t room = manifest_room(all);
    *out_text = NULL;
    if (room == 0) return PPM_STATUS_OK;
    char *const text = ppmi_alloc(context, room + 3, 1);
    if (!text)
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: names of layers");
    char *to = text;
    *to++ = '{';
    for (uint32_t i = 0; i < all->layer_count; i++) {
        if (!is_renamed(all, i)) continue;
        if (to > text + 1) *to++ = ',';
        to += ppmi_crypto_json_write(all->layer_names[i], to);
        *to++ = ':';
        to += ppmi_crypto_json_write(all->layers[i].name, to);
    }
    *to++ = '}';
    *to = '\0';
    *out_text = text;
    return PPM_STATUS_OK;
}

void ppmi_layer_channels_deinit(ppm_context *context, ppmi_layer_channels *all)
{
    const uint32_t channel_count = all->channel_names ? all->first[all->layer_count] : 0;
    for (uint32_t i = 0; i < channel_count; i++)
        ppmi_free(context, all->channel_names[i]);
    for (uint32_t i = 0; i < all->layer_count; i++)
        ppmi_free(context, all->layer_names[i]);
    ppmi_free(context, all->channels);
    ppmi_free(context, all->channel_names);
    ppmi_free(context, all->first);
    ppmi_free(context, all->numbers);
    ppmi_free(context, all->layer_names);
    ppmi_free(context, all->layers);
    *all = (ppmi_layer_channels){0};
}
