/* Nodes: the scene's hierarchy, walked without recursion, and what hangs on it. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_animation.h"
#include "gltf/gltf_belong.h"
#include "gltf/gltf_choice.h"
#include "gltf/gltf_deform.h"
#include "gltf/gltf_light.h"
#include "gltf/gltf_matrix.h"
#include "gltf/gltf_placement.h"
#include "gltf/gltf_pose.h"
#include "gltf/gltf_reader.h"

/* The walk: parents come before their children. */
typedef struct walk {
    int32_t *stack;   /* nodes to visit; each is pushed once at most */
    int32_t *parents; /* -1: a root; -2: not reached */
    size_t depth;
} walk;

enum { NO_PARENT = -1, NOT_REACHED = -2 };

/* ---- instances ------------------------------------------------------------------------------- */

/* Instance number ordinal of a node, at local inside of it (NULL: at the node itself). */
static ppm_status add_instance(ppmi_gltf_reader *reader, int32_t index, ppm_mesh_id mesh,
                               size_t ordinal, const double *local)
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    const char *node_name = node->name[0] ? node->name : reader->document->meshes[node->mesh].name;
    /* a skinned mesh is in the world already */
    const bool is_skinned = node->skin >= 0;
    const uint32_t steps = is_skinned ? 1 : reader->pose->node_steps[index];
    static const double identity[16] = {[0] = 1.0, [5] = 1.0, [10] = 1.0, [15] = 1.0};
    char name[PPMI_GLTF_PLACE], place[PPMI_GLTF_PLACE];
    char asset[PPMI_GLTF_PLACE], group[PPMI_GLTF_PLACE];
    ppm_instance_desc desc = {
        .size = sizeof desc,
        .name = ppmi_gltf_printable(node_name, strlen(node_name), name, sizeof name),
        .mesh = mesh,
        .asset = ppmi_gltf_asset_name(reader, index, asset, sizeof asset),
        .light_group = ppmi_gltf_light_group(reader, index, "", group, sizeof group),
        .is_catcher = node->is_catcher};
    float motion[16 * PPM_MAX_MOTION_STEPS];
    double base[3] = {0.0, 0.0, 0.0};
    if (!ppmi_gltf_is_deformed(reader, index)) {
        const ppm_status status = ppmi_gltf_mesh_base(reader, node->mesh, base);
        if (status != PPM_STATUS_OK) return status;
    }
    for (uint32_t i = 0; i < steps; ++i) {
        const double *world =
            is_skinned ? identity : ppmi_gltf_pose_world(reader->pose, index, i, steps);
        double product[16];
        ppmi_gltf_matrix_multiply(world, local ? local : identity, product);
        ppmi_gltf_matrix_apply(product, base, product + 12);
        if (ppmi_gltf_matrix_to_floats(product, motion + 16 * (size_t)i)) continue;
        ppmi_gltf_place(place, "nodes[%d]", (int)index);
        return ppmi_gltf_invalid(reader, place, "its transform in the world is too large");
    }
    memcpy(desc.transform, motion, sizeof desc.transform);
    if (steps > 1) {
        desc.motion_steps = steps;
        desc.motion = motion;
    }
    return ppmi_gltf_put_instance(reader, index, ordinal, reader->pose->is_visible[index], &desc);
}

/* One attribute of EXT_mesh_gpu_instancing; *out stays NULL when it is absent. */
static ppm_status read_instance_attribute(ppmi_gltf_reader *reader, const ppmi_gltf_node *node,
                                          const char *place, const char *name, uint32_t components,
                                          double **out, size_t *count)
{
    const ppmi_gltf_format format = {components, components, components, true};
    char inner[PPMI_GLTF_PLACE];
    size_t this_count;
    for (uint32_t i = 0; i < node->instance_attribute_count; ++i) {
        if (strcmp(node->instance_attributes[i].name, name) != 0) continue;
        ppmi_gltf_place(inner, "%s.%s", place, name);
        const ppm_status status = ppmi_gltf_read_doubles(
            reader, node->instance_attributes[i].accessor, inner, &format, out, &this_count);
        if (status != PPM_STATUS_OK) return status;
        if (*count != 0 && *count != this_count) {
            return ppmi_gltf_invalid(reader, inner, "%zu elements, others have %zu", this_count,
                                     *count);
        }
        *count = this_count;
    }
    return PPM_STATUS_OK;
}

/* EXT_mesh_gpu_instancing: each instance has a transform of its own inside of the node's. */
static ppm_status add_gpu_instances(ppmi_gltf_reader *reader, int32_t index, ppm_mesh_id mesh)
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    char place[PPMI_GLTF_PLACE];
    double *translations = NULL, *rotations = NULL, *scales = NULL;
    size_t count = 0;
    ppmi_gltf_place(place, "nodes[%d].extensions.EXT_mesh_gpu_instancing.attributes", (int)index);
    ppm_status status =
        read_instance_attribute(reader, node, place, "TRANSLATION", 3, &translations, &count);
    if (status == PPM_STATUS_OK) {
        status = read_instance_attribute(reader, node, place, "ROTATION", 4, &rotations, &count);
    }
    if (status == PPM_STATUS_OK) {
        status = read_instance_attribute(reader, node, place, "SCALE", 3, &scales, &count);
    }
    for (size_t i = 0; i < count && status == PPM_STATUS_OK; ++i) {
        double t[3] = {0.0, 0.0, 0.0}, r[4] = {0.0, 0.0, 0.0, 1.0}, s[3] = {1.0, 1.0, 1.0};
        double local[16];
        if (translations) memcpy(t, translations + 3 * i, sizeof t);
        if (rotations) memcpy(r, rotations + 4 * i, sizeof r);
        if (scales) memcpy(s, scales + 3 * i, sizeof s);
        ppmi_gltf_matrix_compose(t, r, s, local);
        status = add_instance(reader, index, mesh, i, local);
    }
    ppmi_free(reader->context, translations);
    ppmi_free(reader->context, rotations);
    ppmi_free(reader->context, scales);
    return status;
}

/* What will never be seen is not even read. */
static bool is_never_seen(const ppmi_gltf_reader *reader, int32_t index)
{
    return !reader->pose->is_visible[index] && reader->document->animation_count == 0;
}

static ppm_status update_vertices(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform)
{
    ppm_status status = PPM_STATUS_OK;
    for (uint32_t i = 0; i < deform->primitive_count && status == PPM_STATUS_OK; ++i) {
        ppm_primitive_desc desc = {0};
        status = ppmi_gltf_deform_pose(reader, deform, i, &desc);
        if (status == PPM_STATUS_OK) {
            status = ppm_scene_set_mesh_vertices(reader->scene, deform->mesh, i, &desc);
        }
        ppmi_gltf_deform_release(reader->context, deform);
    }
    return status;
}

/* A mesh with vertices of its own: *out_id is 0 when nothing in it can be drawn. */
static ppm_status use_deformed_mesh(ppmi_gltf_reader *reader, int32_t index, ppm_mesh_id *out_id)
{
    ppmi_gltf_deform **deform = &reader->placements->deforms[index];
    char place[PPMI_GLTF_PLACE];
    ppm_status status = PPM_STATUS_OK;
    ppmi_gltf_place(place, "nodes[%d].mesh", (int)index);
    if (!*deform) {
        const int32_t mesh = reader->document->nodes[index].mesh;
        status = ppmi_gltf_require(reader, PPMI_GLTF_MESHES, mesh, place);
        if (status == PPM_STATUS_OK) status = ppmi_gltf_deform_create(reader, index, deform);
        if (status == PPM_STATUS_OK) status = ppmi_gltf_add_deformed_mesh(reader, *deform);
    } else if ((*deform)->mesh != 0 && ppmi_gltf_deform_has_moved(reader, *deform)) {
        status = update_vertices(reader, *deform);
    }
    *out_id = *deform ? (*deform)->mesh : 0;
    return status;
}

static ppm_status use_mesh(ppmi_gltf_reader *reader, int32_t index, ppm_mesh_id *out_id)
{
    char place[PPMI_GLTF_PLACE];
    if (ppmi_gltf_is_deformed(reader, index)) return use_deformed_mesh(reader, index, out_id);
    ppmi_gltf_place(place, "nodes[%d].mesh", (int)index);
    return ppmi_gltf_use_mesh(reader, reader->document->nodes[index].mesh, place, out_id);
}

static ppm_status emit_mesh(ppmi_gltf_reader *reader, int32_t index)
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    ppm_mesh_id mesh;
    if (is_never_seen(reader, index)) return PPM_STATUS_OK;
    const ppm_status status = use_mesh(reader, index, &mesh);
    if (status != PPM_STATUS_OK || mesh == 0) return status;
    if (reader->is_posed_again && !reader->pose->has_moved[index]) return PPM_STATUS_OK;
    if (node->is_instanced && node->skin < 0) return add_gpu_instances(reader, index, mesh);
    if (node->is_instanced && !reader->is_posed_again) {
        char place[PPMI_GLTF_PLACE];
        ppmi_gltf_place(place, "nodes[%d].extensions.EXT_mesh_gpu_instancing", (int)index);
        ppmi_gltf_warn(reader, place,
                       "left out: the node has a skin, whose joints say where the mesh is");
    }
    return add_instance(reader, index, mesh, 0, NULL);
}

static bool is_due(const ppmi_gltf_reader *reader, int32_t node, int32_t list, int32_t index)
{
    return !reader->is_posed_again || reader->pose->has_moved[node] ||
           ppmi_gltf_animations_change(reader, list, index);
}

/* A light profile's values are those of the node. */
static bool are_lights_due(const ppmi_gltf_reader *reader, int32_t index)
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    return is_due(reader, index, PPMI_GLTF_LIGHTS, node->light) ||
           ppmi_gltf_animations_change(reader, PPMI_GLTF_AREA_LIGHTS, node->area_light) ||
           (node->profile >= 0 && ppmi_gltf_animations_change(reader, PPMI_GLTF_NODES, index));
}

/* What one node carries: added, or moved to where it is now. */
static ppm_status emit_node(ppmi_gltf_reader *reader, int32_t index)
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    ppm_status status = PPM_STATUS_OK;
    if (node->mesh >= 0) status = emit_mesh(reader, index);
    if (status == PPM_STATUS_OK && node->camera >= 0 &&
        is_due(reader, index, PPMI_GLTF_CAMERAS, node->camera)) {
        status = ppmi_gltf_add_camera(reader, index);
    }
    if (status == PPM_STATUS_OK && !is_never_seen(reader, index) && are_lights_due(reader, index)) {
        status = ppmi_gltf_add_lights(reader, index, reader->pose->middle[index]);
    }
    return status;
}

/* ---- the walk -------------------------------------------------------------------------------- */

/* Whether node is ancestor itself or below it. */
static bool is_below(const walk *w, int32_t node, int32_t ancestor)
{
    for (; node >= 0; node = w->parents[node]) {
        if (node == ancestor) return true;
    }
    return false;
}

/* Puts a node on the stack, once: a second way to it is a cycle or a second parent. */
static ppm_status push(ppmi_gltf_reader *reader, walk *w, int32_t node, int32_t parent,
                       const char *place)
{
    const ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_NODES, node, place);
    if (status != PPM_STATUS_OK) return status;
    if (w->parents[node] != NOT_REACHED) {
        return ppmi_gltf_invalid(reader, place,
                                 is_below(w, parent, node)
                                     ? "nodes[%d] is its own ancestor: the hierarchy is cyclic"
                                     : "nodes[%d] is reached twice: it has two parents",
                                 (int)node);
    }
    w->parents[node] = parent;
    w->stack[w->depth++] = node;
    return PPM_STATUS_OK;
}

static ppm_status check_matrix(ppmi_gltf_reader *reader, int32_t index)
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    const double *m = node->matrix;
    char place[PPMI_GLTF_PLACE];
    if (!node->has_matrix) return PPM_STATUS_OK;
    /* what single precision makes of 0 0 0 1 after a few products is less */
    const double error = fabs(m[3]) + fabs(m[7]) + fabs(m[11]) + fabs(m[15] - 1.0);
    if (error <= 1e-4) return PPM_STATUS_OK;
    ppmi_gltf_place(place, "nodes[%d].matrix", (int)index);
    return ppmi_gltf_invalid(reader, place, "not affine: its last row is not 0 0 0 1");
}

static ppm_status visit(ppmi_gltf_reader *reader, walk *w)
{
    const int32_t index = w->stack[--w->depth];
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    char place[PPMI_GLTF_PLACE];
    ppm_status status = check_matrix(reader, index);
    reader->pose->order[reader->pose->order_count++] = index;
    for (uint32_t i = node->child_count; i > 0 && status == PPM_STATUS_OK; --i) {
        ppmi_gltf_place(place, "nodes[%d].children[%u]", (int)index, (unsigned)(i - 1));
        status = push(reader, w, node->children[i - 1], index, place);
    }
    return status;
}

static ppm_status walk_from(ppmi_gltf_reader *reader, walk *w, int32_t root, const char *place)
{
    ppm_status status = push(reader, w, root, NO_PARENT, place);
    while (status == PPM_STATUS_OK && w->depth > 0) {
        status = visit(reader, w);
    }
    return status;
}

/* Without scenes every node that is nobody's child is a root. */
static ppm_status walk_all(ppmi_gltf_reader *reader, walk *w)
{
    const ppmi_gltf_document *document = reader->document;
    bool *is_child = ppmi_alloc_zeroed(reader->context, document->node_count, sizeof *is_child);
    ppm_status status = is_child ? PPM_STATUS_OK : ppmi_gltf_out_of_memory(reader, "nodes");
    size_t roots = 0;
    for (size_t i = 0; is_child && i < document->node_count; ++i) {
        for (uint32_t k = 0; k < document->nodes[i].child_count; ++k) {
            const int32_t child = document->nodes[i].children[k];
            if ((size_t)child < document->node_count) is_child[child] = true;
        }
    }
    for (size_t i = 0; status == PPM_STATUS_OK && i < document->node_count; ++i) {
        if (is_child[i]) continue;
        ++roots;
        status = walk_from(reader, w, (int32_t)i, "nodes");
    }
    if (status == PPM_STATUS_OK && roots == 0) {
        status =
            ppmi_gltf_invalid(reader, "nodes", "every one is a child: the hierarchy is cyclic");
    }
    ppmi_free(reader->context, is_child);
    return status;
}

/* The scene that is asked for, or else the file's default one, or else the first. */
ppm_status ppmi_gltf_choose_scene(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    reader->chosen_scene = document->default_scene < 0 ? 0 : document->default_scene;
    if (!reader->options->scene) return PPM_STATUS_OK;
    const char **names = ppmi_alloc(reader->context, document->scene_count + 1, sizeof *names);
    if (!names) return ppmi_gltf_out_of_memory(reader, "scenes");
    for (size_t i = 0; i < document->scene_count; ++i) {
        names[i] = document->scenes[i].name;
    }
    const ppm_status status = ppmi_gltf_choose(reader, "scene", reader->options->scene, names,
                                               document->scene_count, true, &reader->chosen_scene);
    ppmi_free(reader->context, names);
    return status;
}

static ppm_status walk_scene(ppmi_gltf_reader *reader, walk *w)
{
    const ppmi_gltf_document *document = reader->document;
    const int32_t index = reader->chosen_scene;
    char place[PPMI_GLTF_PLACE];
    ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_SCENES, index, "scene");
    if (status != PPM_STATUS_OK) return status;
    const ppmi_gltf_scene *scene = &document->scenes[index];
    for (uint32_t i = 0; i < scene->node_count && status == PPM_STATUS_OK; ++i) {
        ppmi_gltf_place(place, "scenes[%d].nodes[%u]", (int)index, (unsigned)i);
        status = walk_from(reader, w, scene->nodes[i], place);
    }
    return status;
}

/* Places a joint that is not in the scene, by the root above it. */
static ppm_status walk_to_joint(ppmi_gltf_reader *reader, walk *w, const int32_t *above,
                                int32_t joint, const char *place)
{
    int32_t root = joint;
    if (w->parents[joint] != NOT_REACHED) return PPM_STATUS_OK;
    for (size_t i = 0; above[root] >= 0; ++i) {
        root = above[root];
        if (i < reader->document->node_count) continue;
        return ppmi_gltf_invalid(reader, place, "nodes[%d] is below itself", (int)joint);
    }
    ppmi_gltf_warn(reader, place, "nodes[%d] is not in the scene: it is placed by what is above it",
                   (int)joint);
    ppmi_gltf_note_feature(reader, "joints outside of the scene", PPM_FEATURE_IGNORED,
                           "that they are: they move their skins");
    return walk_from(reader, w, root, place);
}

/* The joints of the skins of the scene, as other viewers place them, wherever they are. */
static ppm_status walk_joints(ppmi_gltf_reader *reader, walk *w)
{
    const ppmi_gltf_document *d = reader->document;
    int32_t *above = ppmi_alloc(reader->context, d->node_count + 1, sizeof *above);
    ppm_status status = above ? PPM_STATUS_OK : ppmi_gltf_out_of_memory(reader, "nodes");
    char place[PPMI_GLTF_PLACE];
    for (size_t i = 0; above && i < d->node_count; ++i) {
        above[i] = -1;
    }
    for (size_t i = 0; above && i < d->node_count; ++i) {
        for (uint32_t k = 0; k < d->nodes[i].child_count; ++k) {
            const int32_t child = d->nodes[i].children[k];
            if (child >= 0 && (size_t)child < d->node_count) above[child] = (int32_t)i;
        }
    }
    for (size_t k = 0; k < reader->pose->shown_count && status == PPM_STATUS_OK; ++k) {
        const int32_t index = d->nodes[reader->pose->order[k]].skin;
        if (index < 0 || (size_t)index >= d->skin_count) continue;
        const ppmi_gltf_skin *skin = &d->skins[index];
        for (uint32_t i = 0; i < skin->joint_count && status == PPM_STATUS_OK; ++i) {
            const int32_t joint = skin->joints[i];
            if (joint < 0 || (size_t)joint >= d->node_count) continue;
            ppmi_gltf_place(place, "skins[%d].joints[%u]", (int)index, (unsigned)i);
            status = walk_to_joint(reader, w, above, joint, place);
        }
    }
    ppmi_free(reader->context, above);
    return status;
}

static ppm_status walk_nodes(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    const bool has_scene =
        document->scene_count > 0 || document->default_scene >= 0 || reader->options->scene;
    if (document->node_count == 0 && !has_scene) return PPM_STATUS_OK;
    walk w = {.stack = ppmi_alloc(reader->context, document->node_count + 1, sizeof *w.stack),
              .parents = reader->pose->parents};
    if (!w.stack) return ppmi_gltf_out_of_memory(reader, "nodes");
    ppm_status status = has_scene ? walk_scene(reader, &w) : walk_all(reader, &w);
    reader->pose->shown_count = reader->pose->order_count;
    if (status == PPM_STATUS_OK && document->skin_count > 0) status = walk_joints(reader, &w);
    ppmi_free(reader->context, w.stack);
    return status;
}

static ppm_status emit_nodes(ppmi_gltf_reader *reader)
{
    ppm_status status = PPM_STATUS_OK;
    for (size_t i = 0; i < reader->pose->shown_count && status == PPM_STATUS_OK; ++i) {
        status = emit_node(reader, reader->pose->order[i]);
    }
    return status;
}

ppm_status ppmi_gltf_import_nodes(ppmi_gltf_reader *reader)
{
    ppm_status status = ppmi_gltf_pose_create(reader);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_placements_create(reader);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_animations_check_name(reader);
    if (status == PPM_STATUS_OK) status = walk_nodes(reader);
    if (status == PPM_STATUS_OK) ppmi_gltf_belong_find(reader);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_pose_choose_origin(reader);
    if (status == PPM_STATUS_OK) status = ppmi_gltf_pose_take(reader, &reader->options->pose);
    return status == PPM_STATUS_OK ? emit_nodes(reader) : status;
}

ppm_status ppmi_gltf_pose_nodes(ppmi_gltf_reader *reader, const ppm_pose *when)
{
    reader->is_posed_again = true;
    ppm_status status = ppmi_gltf_pose_take(reader, when);
    for (size_t i = 0; i < reader->document->material_count && status == PPM_STATUS_OK; ++i) {
        if (reader->materials[i] == 0) continue;
        if (!ppmi_gltf_animations_change(reader, PPMI_GLTF_MATERIALS, (int32_t)i)) continue;
        status = ppmi_gltf_update_material(reader, (int32_t)i);
    }
    if (status == PPM_STATUS_OK) status = emit_nodes(reader);
    /* the scene is between two poses: to the next one all is new */
    if (status != PPM_STATUS_OK) reader->pose->sample_count = 0;
    return status;
}
