/* Nodes: the scene's hierarchy, walked without recursion, and what hangs on it. Transforms are
 * composed in double precision. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_reader.h"

/* The walk: parents come before their children. */
typedef struct walk {
    int32_t *stack;       /* nodes to visit; each is pushed once at most */
    int32_t *parents;     /* -1: a root; -2: not reached */
    double (*worlds)[16]; /* local to world, of visited nodes */
    size_t depth;
} walk;

enum { NO_PARENT = -1, NOT_REACHED = -2 };

/* ---- matrices, column-major ------------------------------------------------------------------ */

static void multiply(const double a[16], const double b[16], double out[16])
{
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            double sum = 0.0;
            for (int k = 0; k < 4; ++k) {
                sum += a[4 * k + row] * b[4 * column + k];
            }
            out[4 * column + row] = sum;
        }
    }
}

/* translation * rotation * scale. A quaternion need not have unit length; zero is no rotation. */
static void compose(const double t[3], const double r[4], const double s[3], double out[16])
{
    const double length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    const bool is_rotation = length > 0.0 && isfinite(length);
    const double x = is_rotation ? r[0] / length : 0.0, y = is_rotation ? r[1] / length : 0.0;
    const double z = is_rotation ? r[2] / length : 0.0, w = is_rotation ? r[3] / length : 1.0;
    const double m[16] = {s[0] * (1.0 - 2.0 * (y * y + z * z)),
                          s[0] * 2.0 * (x * y + z * w),
                          s[0] * 2.0 * (x * z - y * w),
                          0.0,
                          s[1] * 2.0 * (x * y - z * w),
                          s[1] * (1.0 - 2.0 * (x * x + z * z)),
                          s[1] * 2.0 * (y * z + x * w),
                          0.0,
                          s[2] * 2.0 * (x * z + y * w),
                          s[2] * 2.0 * (y * z - x * w),
                          s[2] * (1.0 - 2.0 * (x * x + y * y)),
                          0.0,
                          t[0],
                          t[1],
                          t[2],
                          1.0};
    memcpy(out, m, sizeof m);
}

static ppm_status local_matrix(ppmi_gltf_reader *reader, int32_t index, double out[16])
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    char place[PPMI_GLTF_PLACE];
    if (!node->has_matrix) {
        compose(node->translation, node->rotation, node->scale, out);
        return PPM_STATUS_OK;
    }
    const double *m = node->matrix;
    const double error = fabs(m[3]) + fabs(m[7]) + fabs(m[11]) + fabs(m[15] - 1.0);
    if (error > 1e-4) { /* what single precision makes of 0 0 0 1 after a few products is less */
        ppmi_gltf_place(place, "nodes[%d].matrix", (int)index);
        return ppmi_gltf_invalid(reader, place, "not affine: its last row is not 0 0 0 1");
    }
    memcpy(out, m, sizeof node->matrix);
    out[3] = out[7] = out[11] = 0.0;
    out[15] = 1.0;
    return PPM_STATUS_OK;
}

/* False when a value is too large for a float. */
static bool to_floats(const double m[16], float out[16])
{
    for (int i = 0; i < 16; ++i) {
        if (!(fabs(m[i]) < 1e30)) return false;
        out[i] = (float)m[i];
    }
    return true;
}

/* ---- instances ------------------------------------------------------------------------------- */

static ppm_status add_instance(ppmi_gltf_reader *reader, int32_t index, ppm_mesh_id mesh,
                               const double world[16])
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    const char *node_name = node->name[0] ? node->name : reader->document->meshes[node->mesh].name;
    char name[PPMI_GLTF_PLACE], place[PPMI_GLTF_PLACE];
    ppm_instance_id id;
    ppm_instance_desc desc = {
        .size = sizeof desc,
        .name = ppmi_gltf_printable(node_name, strlen(node_name), name, sizeof name),
        .mesh = mesh};
    if (!to_floats(world, desc.transform)) {
        ppmi_gltf_place(place, "nodes[%d]", (int)index);
        return ppmi_gltf_invalid(reader, place, "its transform in the world is too large");
    }
    const ppm_status status = ppm_scene_add_instance(reader->scene, &desc, &id);
    if (status == PPM_STATUS_OK && id != 0) reader->tally.instances++;
    return status;
}

/* One attribute of EXT_mesh_gpu_instancing; *out stays NULL when it is absent. */
static ppm_status read_instance_attribute(ppmi_gltf_reader *reader, const ppmi_gltf_node *node,
                                          const char *place, const char *name, uint32_t components,
                                          float **out, size_t *count)
{
    const ppmi_gltf_format format = {components, components, components, true};
    char inner[PPMI_GLTF_PLACE];
    size_t this_count;
    for (uint32_t i = 0; i < node->instance_attribute_count; ++i) {
        if (strcmp(node->instance_attributes[i].name, name) != 0) continue;
        ppmi_gltf_place(inner, "%s.%s", place, name);
        const ppm_status status = ppmi_gltf_read_floats(
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

static void widen(const float *from, size_t count, double *out)
{
    for (size_t i = 0; i < count; ++i) {
        out[i] = (double)from[i];
    }
}

/* EXT_mesh_gpu_instancing: each instance has a transform of its own inside of the node's. */
static ppm_status add_gpu_instances(ppmi_gltf_reader *reader, int32_t index, ppm_mesh_id mesh,
                                    const double world[16])
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    char place[PPMI_GLTF_PLACE];
    float *translations = NULL, *rotations = NULL, *scales = NULL;
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
        double local[16], product[16];
        if (translations) widen(translations + 3 * i, 3, t);
        if (rotations) widen(rotations + 4 * i, 4, r);
        if (scales) widen(scales + 3 * i, 3, s);
        compose(t, r, s, local);
        multiply(world, local, product);
        status = add_instance(reader, index, mesh, product);
    }
    ppmi_free(reader->context, translations);
    ppmi_free(reader->context, rotations);
    ppmi_free(reader->context, scales);
    return status;
}

static ppm_status emit_mesh(ppmi_gltf_reader *reader, int32_t index, const double world[16])
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    char place[PPMI_GLTF_PLACE];
    ppm_mesh_id mesh;
    ppmi_gltf_place(place, "nodes[%d].mesh", (int)index);
    const ppm_status status = ppmi_gltf_use_mesh(reader, node->mesh, place, &mesh);
    if (status != PPM_STATUS_OK || mesh == 0) return status;
    if (node->is_instanced) return add_gpu_instances(reader, index, mesh, world);
    return add_instance(reader, index, mesh, world);
}

/* What one node carries. */
static ppm_status emit_node(ppmi_gltf_reader *reader, int32_t index, const double world[16])
{
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    ppm_status status = PPM_STATUS_OK;
    if (node->mesh >= 0) status = emit_mesh(reader, index, world);
    if (status == PPM_STATUS_OK && node->camera >= 0) {
        status = ppmi_gltf_add_camera(reader, index, world);
    }
    if (status == PPM_STATUS_OK && node->light >= 0) {
        status = ppmi_gltf_add_light(reader, index, world);
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

static ppm_status visit(ppmi_gltf_reader *reader, walk *w)
{
    const int32_t index = w->stack[--w->depth];
    const ppmi_gltf_node *node = &reader->document->nodes[index];
    char place[PPMI_GLTF_PLACE];
    double local[16];
    ppm_status status = local_matrix(reader, index, local);
    if (status != PPM_STATUS_OK) return status;
    if (w->parents[index] >= 0) {
        multiply(w->worlds[w->parents[index]], local, w->worlds[index]);
    } else {
        memcpy(w->worlds[index], local, sizeof local);
    }
    status = emit_node(reader, index, w->worlds[index]);
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

static ppm_status walk_scene(ppmi_gltf_reader *reader, walk *w)
{
    const ppmi_gltf_document *document = reader->document;
    const int32_t index = document->default_scene < 0 ? 0 : document->default_scene;
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

ppm_status ppmi_gltf_import_nodes(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    const size_t count = document->node_count;
    const bool has_scene = document->scene_count > 0 || document->default_scene >= 0;
    if (count == 0 && !has_scene) return PPM_STATUS_OK;
    /* one more, so that no nodes at all is no case of its own */
    walk w = {.stack = ppmi_alloc(reader->context, count + 1, sizeof *w.stack),
              .parents = ppmi_alloc(reader->context, count + 1, sizeof *w.parents),
              .worlds = ppmi_alloc(reader->context, count + 1, sizeof *w.worlds)};
    ppm_status status = PPM_STATUS_OK;
    if (!w.stack || !w.parents || !w.worlds) status = ppmi_gltf_out_of_memory(reader, "nodes");
    for (size_t i = 0; status == PPM_STATUS_OK && i < count; ++i) {
        w.parents[i] = NOT_REACHED;
    }
    if (status == PPM_STATUS_OK) {
        status = has_scene ? walk_scene(reader, &w) : walk_all(reader, &w);
    }
    ppmi_free(reader->context, w.stack);
    ppmi_free(reader->context, w.parents);
    ppmi_free(reader->context, w.worlds);
    return status;
}
