/* The images of a file, loaded together before anything else: they are independent of each other,
 * and decoding them is most of the time that many files take. The nodes of the scene are followed
 * to their materials for that; what is overlooked is loaded when it is used, one by one. */
#include "gltf/gltf_reader.h"

/* What has been reached. */
typedef struct survey {
    bool *nodes, *materials;
    int32_t *stack;
    size_t depth;
} survey;

static void reach_node(const ppmi_gltf_reader *reader, survey *s, int32_t node)
{
    if (node < 0 || (size_t)node >= reader->document->node_count || s->nodes[node]) return;
    s->nodes[node] = true;
    s->stack[s->depth++] = node;
}

static void reach_materials(const ppmi_gltf_reader *reader, survey *s, int32_t index)
{
    const ppmi_gltf_document *document = reader->document;
    if (index < 0 || (size_t)index >= document->mesh_count) return;
    const ppmi_gltf_mesh *mesh = &document->meshes[index];
    for (uint32_t i = 0; i < mesh->primitive_count; ++i) {
        const ppmi_gltf_primitive *primitive = &mesh->primitives[i];
        const int32_t material = ppmi_gltf_variant_material(reader, primitive);
        const bool exists = material >= 0 && (size_t)material < document->material_count;
        if (exists) s->materials[material] = true;
    }
}

/* The roots of the chosen scene; without one, all nodes. */
static void reach_roots(const ppmi_gltf_reader *reader, survey *s)
{
    const ppmi_gltf_document *document = reader->document;
    const int32_t index = reader->chosen_scene;
    if ((size_t)index < document->scene_count) {
        const ppmi_gltf_scene *scene = &document->scenes[index];
        for (uint32_t i = 0; i < scene->node_count; ++i)
            reach_node(reader, s, scene->nodes[i]);
        return;
    }
    for (size_t i = 0; i < document->node_count; ++i)
        reach_node(reader, s, (int32_t)i);
}

static void run_survey(const ppmi_gltf_reader *reader, survey *s)
{
    reach_roots(reader, s);
    while (s->depth > 0) {
        const ppmi_gltf_node *node = &reader->document->nodes[s->stack[--s->depth]];
        reach_materials(reader, s, node->mesh);
        for (uint32_t i = 0; i < node->child_count; ++i)
            reach_node(reader, s, node->children[i]);
    }
}

/* Notes the images of the materials; each is in one state after, whatever way led to it. */
static void look_at_materials(ppmi_gltf_reader *reader, const survey *s)
{
    reader->is_looking_at_textures = true;
    for (size_t i = 0; i < reader->document->material_count; ++i) {
        char reason[PPMI_GLTF_PLACE];
        const bool is_sound =
            ppmi_gltf_is_usable(reader, PPMI_GLTF_MATERIALS, (int32_t)i, reason, sizeof reason);
        if (s->materials[i] && is_sound) ppmi_gltf_visit_material(reader, (int32_t)i);
    }
    reader->is_looking_at_textures = false;
}

static ppm_status load_wanted(ppmi_gltf_reader *reader)
{
    const size_t count = 2 * reader->outline.images.count;
    size_t *uses = ppmi_alloc(reader->context, count + 1, sizeof *uses), wanted = 0;
    if (!uses) return ppmi_gltf_out_of_memory(reader, "images");
    for (size_t i = 0; i < count; ++i) {
        if (reader->images[i].is_wanted) uses[wanted++] = i;
    }
    const ppm_status status = ppmi_gltf_add_images(reader, uses, wanted);
    ppmi_free(reader->context, uses);
    return status;
}

ppm_status ppmi_gltf_load_images(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    ppm_context *context = reader->context;
    if (reader->outline.images.count == 0) return PPM_STATUS_OK;
    survey s = {.nodes = ppmi_alloc_zeroed(context, document->node_count + 1, sizeof *s.nodes),
                .materials =
                    ppmi_alloc_zeroed(context, document->material_count + 1, sizeof *s.materials),
                .stack = ppmi_alloc(context, document->node_count + 1, sizeof *s.stack)};
    ppm_status status = PPM_STATUS_OK;
    if (s.nodes && s.materials && s.stack) {
        run_survey(reader, &s);
        look_at_materials(reader, &s);
    } else {
        status = ppmi_gltf_out_of_memory(reader, "images");
    }
    ppmi_free(context, s.nodes);
    ppmi_free(context, s.materials);
    ppmi_free(context, s.stack);
    return status == PPM_STATUS_OK ? load_wanted(reader) : status;
}
