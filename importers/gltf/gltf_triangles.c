/* Triangle lists from lists, strips and fans (glTF 2.0 specification, section 3.7.2.1). */
#include <string.h>

#include "gltf/gltf_geometry.h"

static size_t triangle_count(int32_t mode, size_t count)
{
    if (mode == PPMI_GLTF_TRIANGLES) return count / 3;
    return count < 3 ? 0 : count - 2;
}

/* The places in the index list of triangle i's corners. */
static void corners(int32_t mode, size_t i, size_t out[3])
{
    const size_t odd = i & 1;
    switch (mode) {
    case PPMI_GLTF_TRIANGLE_STRIP:
        out[0] = i;
        out[1] = i + 1 + odd;
        out[2] = i + 2 - odd;
        break;
    case PPMI_GLTF_TRIANGLE_FAN:
        out[0] = i + 1;
        out[1] = i + 2;
        out[2] = 0;
        break;
    default:
        out[0] = 3 * i;
        out[1] = 3 * i + 1;
        out[2] = 3 * i + 2;
        break;
    }
}

/* Adds the triangles of a run of indices without restarts; returns how many there are then. */
static size_t add_run(int32_t mode, const uint32_t *indices, size_t count, uint32_t *out,
                      size_t kept)
{
    const size_t triangles = triangle_count(mode, count);
    for (size_t i = 0; i < triangles; ++i) {
        size_t c[3];
        corners(mode, i, c);
        const uint32_t t[3] = {indices[c[0]], indices[c[1]], indices[c[2]]};
        /* strips repeat an index to start anew; no fault, so the scene need not count it */
        const bool is_empty = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
        if (is_empty && mode != PPMI_GLTF_TRIANGLES) continue;
        memcpy(out + 3 * kept++, t, sizeof t);
    }
    return kept;
}

ppm_status ppmi_gltf_join_runs(ppm_context *context, const ppmi_gltf_runs *runs,
                               const uint32_t *indices, size_t count, uint32_t **out_indices,
                               size_t *out_elements)
{
    size_t kept = 0, end;
    *out_indices = NULL;
    *out_elements = 0;
    if (runs->most == 0) return PPM_STATUS_OK;
    uint32_t *out = ppmi_alloc(context, runs->most, runs->corners * sizeof *out);
    if (!out) return PPM_STATUS_OUT_OF_MEMORY;
    for (size_t begin = 0; begin < count; begin = end + 1) {
        end = begin;
        while (end < count && indices[end] != PPMI_GLTF_RESTART)
            ++end;
        kept = runs->add(runs->mode, indices + begin, end - begin, out, kept);
    }
    *out_indices = out;
    *out_elements = kept;
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_triangles(ppm_context *context, int32_t mode, const uint32_t *indices,
                               size_t count, uint32_t **out_indices, size_t *out_triangles)
{
    const ppmi_gltf_runs runs = {mode, triangle_count(mode, count), 3, add_run};
    return ppmi_gltf_join_runs(context, &runs, indices, count, out_indices, out_triangles);
}
