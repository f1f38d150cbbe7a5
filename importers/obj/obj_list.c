/* Objects and groups are the nodes; materials are the ones that faces name, which the libraries,
 * read on import, may or may not have. */
#include "obj/obj_list.h"

#include <stdio.h>

#include "obj/obj_reader.h"

/* Faces of each object; NULL when memory is out. */
static size_t *count_faces(const ppmi_obj_reader *r)
{
    const ppmi_obj_run *runs = r->runs.items;
    size_t *counts = ppmi_alloc_zeroed(r->context, ppmi_obj_names_count(&r->objects) + (size_t)1,
                                       sizeof *counts);
    for (size_t i = 0; counts && i < r->runs.count; ++i) {
        counts[runs[i].object] += runs[i].end_face - runs[i].first_face;
    }
    return counts;
}

void ppmi_obj_fill_catalog(const ppmi_obj_asset *asset, ppmi_catalog *catalog)
{
    const ppmi_obj_reader *r = ppmi_obj_asset_reader(asset);
    size_t *counts = count_faces(r);
    if (!counts) catalog->is_out_of_memory = true;
    for (uint32_t i = 0; counts && i < ppmi_obj_names_count(&r->objects); ++i) {
        char phrase[64];
        snprintf(phrase, sizeof phrase, "%zu face%s", counts[i], counts[i] == 1 ? "" : "s");
        ppmi_catalog_add(catalog, PPM_ASSET_NODES, ppmi_obj_names_get(&r->objects, i), phrase);
    }
    for (uint32_t i = 0; i < ppmi_obj_names_count(&r->used_materials); ++i) {
        ppmi_catalog_add(catalog, PPM_ASSET_MATERIALS, ppmi_obj_names_get(&r->used_materials, i),
                         "");
    }
    ppmi_free(r->context, counts);
}
