/* Tangents that a file leaves out (glTF 2.0 specification, section 3.7.2.1): computed where the
 * material has a use for them. */
#include <string.h>

#include "gltf/gltf_geometry.h"
#include "tangent/tangent.h"

int32_t ppmi_gltf_tangent_set(const ppmi_gltf_reader *reader, int32_t material)
{
    const ppmi_gltf_document *document = reader->document;
    if (material < 0 || (size_t)material >= document->material_count) return -1;
    const ppmi_gltf_material *from = &document->materials[material];
    const ppmi_gltf_texture_info *const infos[] = {&from->normal_texture,
                                                   &from->layers.clearcoat_normal_texture,
                                                   &from->layers.anisotropy_texture};
    for (size_t i = 0; i < sizeof infos / sizeof infos[0]; ++i) {
        const bool is_used = infos[i]->texture >= 0 && infos[i]->uv_set < PPM_MAX_UV_SETS;
        if (is_used) return infos[i]->uv_set;
    }
    return from->layers.anisotropy > 0.0 ? 0 : -1;
}

static bool copy_sources(ppm_context *context, ppmi_gltf_geometry *g,
                         const ppmi_tangent_result *result)
{
    uint32_t *sources = ppmi_alloc(context, result->vertex_count, sizeof *sources);
    if (!sources) return false;
    for (size_t v = 0; v < result->vertex_count; ++v) {
        sources[v] = g->sources ? g->sources[result->sources[v]] : result->sources[v];
    }
    ppmi_free(context, g->sources);
    g->sources = sources;
    return true;
}

/* Vertices that were split are copied in all attributes. */
static bool take_vertices(ppm_context *context, ppmi_gltf_geometry *g,
                          const ppmi_tangent_result *result)
{
    if (result->vertex_count == g->vertex_count) return true;
    bool ok = ppmi_tangent_spread(context, &g->positions, 3, result) &&
              ppmi_tangent_spread(context, &g->normals, 3, result) &&
              ppmi_tangent_spread(context, &g->colors, 4, result) &&
              copy_sources(context, g, result);
    for (size_t i = 0; ok && i < PPM_MAX_UV_SETS; ++i) {
        ok = ppmi_tangent_spread(context, &g->uvs[i], 2, result);
    }
    g->vertex_count = result->vertex_count;
    return ok;
}

ppm_status ppmi_gltf_add_tangents(ppmi_gltf_reader *reader, int32_t material, const char *place,
                                  ppmi_gltf_geometry *g)
{
    const int32_t set = ppmi_gltf_tangent_set(reader, material);
    if (set < 0 || g->kind != PPM_PRIMITIVE_TRIANGLES || g->tangents || !g->normals ||
        !g->uvs[set]) {
        return PPM_STATUS_OK;
    }
    const ppmi_tangent_mesh mesh = {.positions = g->positions,
                                    .normals = g->normals,
                                    .uvs = g->uvs[set],
                                    .v_runs_down = true,
                                    .vertex_count = (uint32_t)g->vertex_count,
                                    .indices = g->indices,
                                    .triangle_count = (uint32_t)g->triangle_count};
    ppmi_tangent_result result;
    ppm_status status = ppmi_tangent_compute(reader->context, &mesh, &result);
    if (status == PPM_STATUS_OK && !take_vertices(reader->context, g, &result)) {
        status = PPM_STATUS_OUT_OF_MEMORY;
    }
    if (status == PPM_STATUS_OK) {
        g->tangents = result.tangents;
        result.tangents = NULL;
        uint32_t *const indices = g->indices;
        g->indices = result.indices;
        result.indices = indices;
    }
    ppmi_tangent_result_deinit(reader->context, &result);
    return status == PPM_STATUS_OK ? status : ppmi_gltf_out_of_memory(reader, place);
}
