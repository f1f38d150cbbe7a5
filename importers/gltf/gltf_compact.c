/* Drops unused vertices of a primitive, keeping the order of the others. */
#include <string.h>

#include "gltf/gltf_geometry.h"

#define UNUSED UINT32_MAX

/* Replaces *values by its used elements, of width floats each. */
static bool compact_array(ppm_context *context, float **values, size_t width,
                          const uint32_t *new_index, size_t vertex_count, size_t used)
{
    if (!*values) return true;
    float *kept = ppmi_alloc(context, used, width * sizeof *kept);
    if (!kept) return false;
    for (size_t i = 0; i < vertex_count; ++i) {
        if (new_index[i] == UNUSED) continue;
        memcpy(kept + new_index[i] * width, *values + i * width, width * sizeof *kept);
    }
    ppmi_free(context, *values);
    *values = kept;
    return true;
}

/* Remembers where the used vertices came from. */
static bool compact_sources(ppm_context *context, ppmi_gltf_geometry *g, const uint32_t *new_index,
                            size_t used)
{
    uint32_t *kept = ppmi_alloc(context, used, sizeof *kept);
    if (!kept) return false;
    for (size_t i = 0; i < g->vertex_count; ++i) {
        if (new_index[i] != UNUSED) kept[new_index[i]] = g->sources ? g->sources[i] : (uint32_t)i;
    }
    ppmi_free(context, g->sources);
    g->sources = kept;
    return true;
}

/* The new index of every vertex, or UNUSED. Returns how many are used. */
static size_t number_used(const ppmi_gltf_geometry *g, uint32_t *new_index)
{
    uint32_t used = 0;
    for (size_t i = 0; i < g->vertex_count; ++i) {
        new_index[i] = UNUSED;
    }
    for (size_t i = 0; i < 3 * g->triangle_count; ++i) {
        new_index[g->indices[i]] = 0;
    }
    for (size_t i = 0; i < g->vertex_count; ++i) {
        if (new_index[i] != UNUSED) new_index[i] = used++;
    }
    return used;
}

bool ppmi_gltf_compact(ppm_context *context, ppmi_gltf_geometry *g)
{
    uint32_t *new_index = ppmi_alloc(context, g->vertex_count, sizeof *new_index);
    if (!new_index) return false;
    const size_t count = g->vertex_count, used = number_used(g, new_index);
    bool ok = true;
    if (used < count) {
        ok = compact_array(context, &g->positions, 3, new_index, count, used) &&
             compact_array(context, &g->normals, 3, new_index, count, used) &&
             compact_array(context, &g->tangents, 4, new_index, count, used) &&
             compact_array(context, &g->colors, 4, new_index, count, used) &&
             compact_sources(context, g, new_index, used);
        for (size_t i = 0; ok && i < PPM_MAX_UV_SETS; ++i) {
            ok = compact_array(context, &g->uvs[i], 2, new_index, count, used);
        }
        for (size_t i = 0; ok && i < 3 * g->triangle_count; ++i) {
            g->indices[i] = new_index[g->indices[i]];
        }
        g->vertex_count = used;
    }
    ppmi_free(context, new_index);
    return ok;
}
