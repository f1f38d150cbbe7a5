/* Nodes: instances by name; whether they are there, of which material they are, and which of solids
 * that overlap is there. The material is one of the mesh: all instances of it share it. */
#include <string.h>

#include "setup/setup_file.h"

typedef struct node_words {
    ppmi_setup_match match;
    uint32_t visible, catcher;
    const char *material;
    int32_t nested_priority;
} node_words;

enum { MATCH = 1, VISIBLE = 2, MATERIAL = 4, PRIORITY = 8, CATCHER = 16 };

#define FIELD(member) .field = offsetof(node_words, member)
static const ppmi_setup_key keys[] = {
    {"match", PPMI_SETUP_OWN, FIELD(match), .read = ppmi_setup_read_match},
    {"visible", PPMI_SETUP_FLAG, FIELD(visible)},
    {"material", PPMI_SETUP_TEXT, FIELD(material)},
    {"nested_priority", PPMI_SETUP_INTEGER, FIELD(nested_priority), -1e6, 1e6},
    {"catcher", PPMI_SETUP_FLAG, FIELD(catcher)},
};
#undef FIELD
enum { KEY_COUNT = sizeof keys / sizeof keys[0] };

static const char *instance_name(const ppm_scene *scene, uint32_t id)
{
    return ppm_scene_instance_name(scene, id);
}

/* A copy of a material with another priority; the same copy for all that ask for it. */
static ppm_status clone_material(ppm_setup *setup, ppm_material_id from, int32_t priority,
                                 ppm_material_id *out_id)
{
    ppm_material_desc desc = {.size = sizeof desc};
    for (size_t i = 0; i < setup->clone_count; i++) {
        const ppmi_setup_clone *clone = &setup->clones[i];
        const bool is_one = clone->from == from || clone->to == from;
        if (!is_one || clone->nested_priority != priority) continue;
        *out_id = clone->to;
        return PPM_STATUS_OK;
    }
    ppm_status status = ppm_scene_get_material(setup->scene, from, &desc);
    if (status != PPM_STATUS_OK) return status;
    *out_id = from;
    if (desc.nested_priority == priority) return PPM_STATUS_OK;
    if (!ppmi_setup_grow(setup->context, (void **)&setup->clones, setup->clone_count,
                         &setup->clone_capacity, sizeof *setup->clones)) {
        return ppmi_setup_out_of_memory(setup);
    }
    desc.nested_priority = priority;
    status = ppm_scene_add_material(setup->scene, &desc, out_id);
    if (status != PPM_STATUS_OK) return status;
    setup->clones[setup->clone_count++] =
        (ppmi_setup_clone){.from = from, .to = *out_id, .nested_priority = priority};
    return PPM_STATUS_OK;
}

static ppm_status change_mesh(ppm_setup *setup, ppm_mesh_id mesh, ppm_material_id material,
                              const node_words *words, uint64_t given)
{
    const uint32_t count = ppm_scene_primitive_count(setup->scene, mesh);
    ppm_status status = PPM_STATUS_OK;
    for (uint32_t i = 0; i < count && status == PPM_STATUS_OK; i++) {
        ppm_material_id id = material;
        if (id == 0) id = ppm_scene_primitive_material(setup->scene, mesh, i);
        if (given & PRIORITY) status = clone_material(setup, id, words->nested_priority, &id);
        if (status == PPM_STATUS_OK) {
            status = ppm_scene_set_primitive_material(setup->scene, mesh, i, id);
        }
    }
    return status;
}

/* Another instance of a mesh that the rule is not meant for, or 0. */
static ppm_instance_id stranger(const ppm_scene *scene, const node_words *words, ppm_mesh_id mesh)
{
    for (ppm_instance_id id = 1; id <= ppm_scene_instance_count(scene); id++) {
        if (ppm_scene_instance_mesh(scene, id) != mesh) continue;
        if (!ppmi_setup_fits(&words->match, ppm_scene_instance_name(scene, id))) return id;
    }
    return 0;
}

static ppm_status change_node(const ppmi_setup_value *rule, const node_words *words, uint64_t given,
                              ppm_material_id material, ppm_instance_id id)
{
    ppm_setup *setup = rule->setup;
    ppm_status status = PPM_STATUS_OK;
    if (given & VISIBLE) {
        status = ppm_scene_set_instance_visible(setup->scene, id, words->visible);
    }
    if (status == PPM_STATUS_OK && given & CATCHER) {
        status = ppm_scene_set_instance_catcher(setup->scene, id, words->catcher);
    }
    if (status != PPM_STATUS_OK || !(given & (MATERIAL | PRIORITY))) return status;
    const ppm_mesh_id mesh = ppm_scene_instance_mesh(setup->scene, id);
    const ppm_instance_id other = stranger(setup->scene, words, mesh);
    if (other != 0) {
        ppmi_setup_warn(rule, "node \"%s\" shows the same mesh as \"%s\", which changes with it",
                        ppm_scene_instance_name(setup->scene, other),
                        ppm_scene_instance_name(setup->scene, id));
    }
    return change_mesh(setup, mesh, material, words, given);
}

static ppm_status read_rule(const ppmi_setup_value *rule, node_words *words, uint64_t *given)
{
    *words = (node_words){0};
    const ppm_status status = ppmi_setup_read_object(rule, keys, KEY_COUNT, words, given);
    if (status != PPM_STATUS_OK || *given & MATCH) return status;
    return ppmi_setup_fail(rule, "no \"match\": expected the name of nodes, or a pattern");
}

ppm_status ppmi_setup_node_section(const ppmi_setup_value *rule)
{
    node_words words;
    uint64_t given = 0;
    ppm_material_id material = 0;
    bool is_used = false;
    ppm_scene *scene = rule->setup->scene;
    ppm_status status = read_rule(rule, &words, &given);
    if (status != PPM_STATUS_OK || !scene) return status;
    if (given & MATERIAL) {
        const ppmi_setup_value place =
            ppmi_setup_member(rule, "material", json_object_get(rule->json, "material"));
        status = ppmi_setup_find_material(&place, words.material, &material);
    }
    const uint32_t count = ppm_scene_instance_count(scene);
    for (ppm_instance_id id = 1; id <= count && status == PPM_STATUS_OK; id++) {
        if (!ppmi_setup_fits(&words.match, ppm_scene_instance_name(scene, id))) continue;
        status = change_node(rule, &words, given, material, id);
        is_used = true;
    }
    if (status != PPM_STATUS_OK || is_used) return status;
    return ppmi_setup_warn_no_match(&words.match, "node", instance_name, count);
}

ppm_status ppmi_setup_restore_nodes(ppm_setup *setup)
{
    const ppmi_setup_value root = {.setup = setup, .json = setup->root};
    const json_t *rules = json_object_get(setup->root, "nodes");
    const ppmi_setup_value list = ppmi_setup_member(&root, "nodes", rules);
    const uint32_t count = ppm_scene_instance_count(setup->scene);
    ppm_status status = PPM_STATUS_OK;
    for (size_t i = 0; i < json_array_size(rules); i++) {
        node_words words;
        uint64_t given = 0;
        const ppmi_setup_value rule = ppmi_setup_element(&list, i);
        status = read_rule(&rule, &words, &given);
        if (status != PPM_STATUS_OK) return status;
        for (ppm_instance_id id = 1; given & VISIBLE && id <= count; id++) {
            if (!ppmi_setup_fits(&words.match, ppm_scene_instance_name(setup->scene, id))) continue;
            status = ppm_scene_set_instance_visible(setup->scene, id, words.visible);
            if (status != PPM_STATUS_OK) return status;
        }
    }
    return status;
}
