/* Objects and groups are the nodes; materials are the ones that faces name, which the libraries,
 * read on import, may or may not have. */
#include "obj/obj_list.h"

#include <stdio.h>

#include "obj/obj_reader.h"

/* What is in each object, by kind. NULL when memory is out. */
typedef struct tally {
    size_t counts[3]; /* by PPM_PRIMITIVE_ */
} tally;

static tally *count_elements(const ppmi_obj_reader *r)
{
    const ppmi_obj_run *runs = r->runs.items;
    const uint32_t *faces = r->faces.items;
    tally *tallies = ppmi_alloc_zeroed(r->context, ppmi_obj_names_count(&r->objects) + (size_t)1,
                                       sizeof *tallies);
    for (size_t i = 0; tallies && i < r->runs.count; ++i) {
        size_t *count = &tallies[runs[i].object].counts[runs[i].kind];
        for (size_t k = runs[i].first_face; k < runs[i].end_face; ++k) {
            const bool is_face = runs[i].kind == PPM_PRIMITIVE_TRIANGLES;
            *count += is_face ? 1 : ppmi_obj_element_count(runs[i].kind, faces[k]);
        }
    }
    return tallies;
}

/* "12 faces, 1 point" */
static void describe(const tally *t, char *out, size_t size)
{
    static const char *const nouns[] = {"face", "point", "segment"};
    size_t used = 0;
    out[0] = 0;
    for (int kind = 0; kind < 3 && used < size; ++kind) {
        if (t->counts[kind] == 0) continue;
        const int n = snprintf(out + used, size - used, "%s%zu %s%s", used > 0 ? ", " : "",
                               t->counts[kind], nouns[kind], t->counts[kind] == 1 ? "" : "s");
        used += n > 0 ? (size_t)n : 0;
    }
}

void ppmi_obj_fill_catalog(const ppmi_obj_asset *asset, ppmi_catalog *catalog)
{
    const ppmi_obj_reader *r = ppmi_obj_asset_reader(asset);
    tally *tallies = count_elements(r);
    if (!tallies) catalog->is_out_of_memory = true;
    for (uint32_t i = 0; tallies && i < ppmi_obj_names_count(&r->objects); ++i) {
        char phrase[96];
        const char *name = ppmi_obj_names_get(&r->objects, i);
        describe(&tallies[i], phrase, sizeof phrase);
        ppmi_catalog_add(catalog, PPM_ASSET_NODES, *name ? name : r->stem, phrase);
    }
    for (uint32_t i = 0; i < ppmi_obj_names_count(&r->used_materials); ++i) {
        ppmi_catalog_add(catalog, PPM_ASSET_MATERIALS, ppmi_obj_names_get(&r->used_materials, i),
                         "");
    }
    ppmi_free(r->context, tallies);
}
