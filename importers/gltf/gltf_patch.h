/* Replacements in a text: collected while it is walked, then applied in one copy. */
#ifndef PPMI_GLTF_PATCH_H
#define PPMI_GLTF_PATCH_H

#include "base/context.h"

enum { PPMI_GLTF_PATCH_SHORT = 24 };

/* begin..end becomes text. */
typedef struct ppmi_gltf_patch_item {
    size_t begin, end;
    const char *text; /* NULL: short_text */
    char short_text[PPMI_GLTF_PATCH_SHORT];
} ppmi_gltf_patch_item;

/* By place, not overlapping. Freeing items frees all. */
typedef struct ppmi_gltf_patches {
    ppmi_gltf_patch_item *items;
    size_t count, capacity;
} ppmi_gltf_patches;

/* Room for one more item: items itself, or a copy of twice the size when it is full, with the rest
 * zeroed. NULL when memory is out; items then stay as they are. */
void *ppmi_gltf_grow(ppm_context *context, void *items, size_t count, size_t *capacity,
                     size_t item_size);

/* Adds a replacement by a text that lives on, or by a copy of a short one. Those at or behind begin
 * are forgotten: they lie inside of it. False when memory is out. */
bool ppmi_gltf_patch(ppm_context *context, ppmi_gltf_patches *patches, size_t begin, size_t end,
                     const char *text);
bool ppmi_gltf_patch_short(ppm_context *context, ppmi_gltf_patches *patches, size_t begin,
                           size_t end, const char *text);

/* A copy of text with the replacements, ended by a zero; the caller's. False when memory is out. */
bool ppmi_gltf_apply_patches(ppm_context *context, const ppmi_gltf_patches *patches,
                             const char *text, size_t length, char **out_text, size_t *out_length);

#endif
