/* Points and segments from the modes that are no triangles (glTF 2.0 specification, section
 * 3.7.2.1), and the size that they are drawn with. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_geometry.h"

static size_t element_count(int32_t mode, size_t count)
{
    switch (mode) {
    case PPMI_GLTF_POINTS:
        return count;
    case PPMI_GLTF_LINES:
        return count / 2;
    case PPMI_GLTF_LINE_LOOP:
        return count < 2 ? 0 : count;
    default:
        return count < 2 ? 0 : count - 1;
    }
}

/* Adds the elements of a run of indices without restarts; returns how many there are then. */
static size_t add_run(int32_t mode, const uint32_t *indices, size_t count, uint32_t *out,
                      size_t kept)
{
    const size_t elements = element_count(mode, count);
    const size_t sides = mode == PPMI_GLTF_POINTS ? 1 : 2;
    for (size_t i = 0; i < elements; ++i, ++kept) {
        const size_t begin = mode == PPMI_GLTF_LINES ? 2 * i : i;
        for (size_t k = 0; k < sides; ++k) {
            out[sides * kept + k] = indices[(begin + k) % count]; /* a loop ends where it began */
        }
    }
    return kept;
}

ppm_status ppmi_gltf_points_and_lines(ppm_context *context, int32_t mode, const uint32_t *indices,
                                      size_t count, uint32_t **out_indices, size_t *out_elements)
{
    const ppmi_gltf_runs runs = {mode, element_count(mode, count), 2, add_run};
    return ppmi_gltf_join_runs(context, &runs, indices, count, out_indices, out_elements);
}

float ppmi_gltf_line_radius(const ppmi_gltf_geometry *primitives, size_t count)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; ++i) {
        for (size_t v = 0; v < primitives[i].vertex_count; ++v) {
            for (size_t k = 0; k < 3; ++k) {
                const float x = primitives[i].positions[3 * v + k];
                low[k] = fminf(low[k], x);
                high[k] = fmaxf(high[k], x);
            }
        }
    }
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    const float diagonal = sqrtf(x * x + y * y + z * z);
    const bool has_size = diagonal > 0.0f && diagonal < 1e15f;
    return has_size ? PPMI_GLTF_RADIUS_SHARE * diagonal : PPMI_GLTF_RADIUS_OF_A_POINT_M;
}
