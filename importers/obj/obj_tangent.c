/* Tangents for materials that have a use for them: those that the programs compute which bake
 * normal maps (importers/tangent). */
#include <string.h>

#include "obj/obj_geometry.h"
#include "tangent/tangent.h"

static bool take_vertices(ppm_context *context, ppmi_obj_geometry *g,
                          const ppmi_tangent_result *result)
{
    if (result->vertex_count == g->vertex_count) return true;
    g->vertex_count = result->vertex_count;
    return ppmi_tangent_spread(context, &g->positions, 3, result) &&
           ppmi_tangent_spread(context, &g->normals, 3, result) &&
           ppmi_tangent_spread(context, &g->uvs, 2, result) &&
           ppmi_tangent_spread(context, &g->colors, 4, result);
}

bool ppmi_obj_add_tangents(ppm_context *context, ppmi_obj_geometry *g)
{
    const ppmi_tangent_mesh mesh = {.positions = g->positions,
                                    .normals = g->normals,
                                    .uvs = g->uvs,
                                    .v_runs_down = true,
                                    .vertex_count = (uint32_t)g->vertex_count,
                                    .indices = g->indices,
                                    .triangle_count = (uint32_t)g->element_count};
    ppmi_tangent_result result;
    const bool ok = ppmi_tangent_compute(context, &mesh, &result) == PPM_STATUS_OK &&
                    take_vertices(context, g, &result);
    if (ok) {
        uint32_t *const indices = g->indices;
        g->tangents = result.tangents;
        g->indices = result.indices;
        result.tangents = NULL;
        result.indices = indices;
    }
    ppmi_tangent_result_deinit(context, &result);
    return ok;
}
