/* Replacements in a text. */
#include "gltf/gltf_patch.h"

#include <stdio.h>
#include <string.h>

void *ppmi_gltf_grow(ppm_context *context, void *items, size_t count, size_t *capacity,
                     size_t item_size)
{
    if (count < *capacity) return items;
    const size_t more = *capacity == 0 ? 16 : *capacity * 2;
    void *block = ppmi_alloc_zeroed(context, more, item_size);
    if (!block) return NULL;
    if (count > 0) memcpy(block, items, count * item_size);
    ppmi_free(context, items);
    *capacity = more;
    return block;
}

static ppmi_gltf_patch_item *add(ppm_context *context, ppmi_gltf_patches *patches, size_t begin,
                                 size_t end)
{
    while (patches->count > 0 && patches->items[patches->count - 1].begin >= begin) {
        --patches->count;
    }
    ppmi_gltf_patch_item *items =
        ppmi_gltf_grow(context, patches->items, patches->count, &patches->capacity, sizeof *items);
    if (!items) return NULL;
    patches->items = items;
    ppmi_gltf_patch_item *added = &items[patches->count++];
    *added = (ppmi_gltf_patch_item){.begin = begin, .end = end};
    return added;
}

bool ppmi_gltf_patch(ppm_context *context, ppmi_gltf_patches *patches, size_t begin, size_t end,
                     const char *text)
{
    ppmi_gltf_patch_item *added = add(context, patches, begin, end);
    if (!added) return false;
    added->text = text;
    return true;
}

bool ppmi_gltf_patch_short(ppm_context *context, ppmi_gltf_patches *patches, size_t begin,
                           size_t end, const char *text)
{
    ppmi_gltf_patch_item *added = add(context, patches, begin, end);
    if (!added) return false;
    snprintf(added->short_text, sizeof added->short_text, "%s", text);
    return true;
}

static const char *text_of(const ppmi_gltf_patch_item *item)
{
    return item->text ? item->text : item->short_text;
}

bool ppmi_gltf_apply_patches(ppm_context *context, const ppmi_gltf_patches *patches,
                             const char *text, size_t length, char **out_text, size_t *out_length)
{
    size_t size = length + 1, count = 0, from = 0;
    for (size_t i = 0; i < patches->count; ++i) {
        size += strlen(text_of(&patches->items[i]));
    }
    char *out = ppmi_alloc(context, size, 1);
    if (!out) return false;
    for (size_t i = 0; i < patches->count; ++i) {
        const ppmi_gltf_patch_item *item = &patches->items[i];
        const size_t replaced = strlen(text_of(item));
        memcpy(out + count, text + from, item->begin - from);
        count += item->begin - from;
        memcpy(out + count, text_of(item), replaced);
        count += replaced;
        from = item->end;
    }
    memcpy(out + count, text + from, length - from);
    count += length - from;
    out[count] = 0;
    *out_text = out;
    *out_length = count;
    return true;
}
