/* Morph targets and skins, applied to the vertices of a primitive.
 *
 * A skinned vertex is moved by the weighted sum of its joints' matrices, each of which leads from
 * the mesh at rest to the world; the node's own transform has no say. Normals go with the cofactors
 * of that sum, which is its inverse transpose up to a factor, and tangents with the sum itself. */
#include "gltf/gltf_deform.h"

#include <math.h>
#include <string.h>

#include "gltf/gltf_matrix.h"
#include "gltf/gltf_pose.h"

enum { SMALL = 2048 }; /* vertices that are not worth a second thread */

/* ---- which nodes ----------------------------------------------------------------------------- */

static bool has_targets(const ppmi_gltf_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->primitive_count; ++i) {
        if (mesh->primitives[i].target_count > 0) return true;
    }
    return false;
}

static bool may_change_weights(const ppmi_gltf_document *d)
{
    for (size_t i = 0; i < d->animation_count; ++i) {
        for (uint32_t k = 0; k < d->animations[i].channel_count; ++k) {
            const ppmi_gltf_channel *c = &d->animations[i].channels[k];
            if (strstr(c->pointer ? c->pointer : c->path, "weights")) return true;
        }
    }
    return false;
}

bool ppmi_gltf_is_deformed(const ppmi_gltf_reader *reader, int32_t index)
{
    const ppmi_gltf_document *d = reader->document;
    const ppmi_gltf_node *node = &d->nodes[index];
    if (node->mesh < 0 || (size_t)node->mesh >= d->mesh_count) return false;
    if (node->skin >= 0) return true;
    if (!has_targets(&d->meshes[node->mesh])) return false;
    for (size_t i = reader->pose->first_weight[index]; i < reader->pose->first_weight[index + 1];
         ++i) {
        if (reader->pose->weights[i] != 0.0) return true;
    }
    return may_change_weights(d);
}

/* ---- skins ----------------------------------------------------------------------------------- */

static ppm_status check_joints(ppmi_gltf_reader *reader, int32_t index)
{
    const ppmi_gltf_skin *skin = &reader->document->skins[index];
    char place[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "skins[%d].joints", (int)index);
    if (skin->joint_count == 0) return ppmi_gltf_invalid(reader, place, "there are none");
    for (uint32_t i = 0; i < skin->joint_count; ++i) {
        ppmi_gltf_place(place, "skins[%d].joints[%u]", (int)index, (unsigned)i);
        const ppm_status status =
            ppmi_gltf_require(reader, PPMI_GLTF_NODES, skin->joints[i], place);
        if (status != PPM_STATUS_OK) return status;
        if (reader->pose->parents[skin->joints[i]] >= -1) continue;
        return ppmi_gltf_invalid(reader, place, "nodes[%d] is not in the scene",
                                 (int)skin->joints[i]);
    }
    return PPM_STATUS_OK;
}

/* Identities where the skin gives none. */
static ppm_status read_inverse_binds(ppmi_gltf_reader *reader, int32_t index,
                                     ppmi_gltf_deform *deform)
{
    static const ppmi_gltf_format matrix = {16, 16, 16, false};
    const ppmi_gltf_skin *skin = &reader->document->skins[index];
    char place[PPMI_GLTF_PLACE];
    float *values = NULL;
    size_t count = 0;
    ppmi_gltf_place(place, "skins[%d].inverseBindMatrices", (int)index);
    deform->inverse_binds =
        ppmi_alloc_zeroed(reader->context, skin->joint_count, sizeof *deform->inverse_binds);
    if (!deform->inverse_binds) return ppmi_gltf_out_of_memory(reader, place);
    if (skin->inverse_bind_matrices >= 0) {
        const ppm_status status = ppmi_gltf_read_floats(reader, skin->inverse_bind_matrices, place,
                                                        &matrix, &values, &count);
        if (status != PPM_STATUS_OK) return status;
    }
    const bool is_short = values && count < skin->joint_count;
    for (size_t i = 0; i < skin->joint_count && !is_short; ++i) {
        for (size_t k = 0; k < 16; ++k) {
            deform->inverse_binds[i][k] = values ? (double)values[16 * i + k] : k % 5 == 0;
        }
    }
    ppmi_free(reader->context, values);
    if (!is_short) return PPM_STATUS_OK;
    return ppmi_gltf_invalid(reader, place, "%zu matrices for %u joints", count,
                             (unsigned)skin->joint_count);
}

static ppm_status read_skin(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform)
{
    const int32_t index = reader->document->nodes[deform->node].skin;
    char place[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d].skin", (int)deform->node);
    ppm_status status = ppmi_gltf_require(reader, PPMI_GLTF_SKINS, index, place);
    if (status == PPM_STATUS_OK) status = check_joints(reader, index);
    if (status == PPM_STATUS_OK) status = read_inverse_binds(reader, index, deform);
    if (status != PPM_STATUS_OK) return status;
    deform->joint_count = reader->document->skins[index].joint_count;
    deform->joints = reader->document->skins[index].joints;
    return PPM_STATUS_OK;
}

/* ---- memory ---------------------------------------------------------------------------------- */

ppm_status ppmi_gltf_deform_create(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_deform **out)
{
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    const uint32_t count = reader->document->meshes[from->mesh].primitive_count;
    char place[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d]", (int)node);
    ppmi_gltf_deform *deform = ppmi_alloc_zeroed(reader->context, 1, sizeof *deform);
    *out = deform;
    if (!deform) return ppmi_gltf_out_of_memory(reader, place);
    deform->node = node;
    deform->primitives =
        ppmi_alloc_zeroed(reader->context, (size_t)count + 1, sizeof *deform->primitives);
    if (!deform->primitives) return ppmi_gltf_out_of_memory(reader, place);
    return from->skin >= 0 ? read_skin(reader, deform) : PPM_STATUS_OK;
}

static void free_delta(ppm_context *context, ppmi_gltf_delta *delta)
{
    ppmi_free(context, delta->vertices);
    ppmi_free(context, delta->values);
}

static void free_primitive(ppm_context *context, ppmi_gltf_deform_primitive *p)
{
    for (uint32_t i = 0; p->targets && i < p->target_count; ++i) {
        free_delta(context, &p->targets[i].position);
        free_delta(context, &p->targets[i].normal);
        free_delta(context, &p->targets[i].tangent);
        free_delta(context, &p->targets[i].color);
        for (size_t k = 0; k < PPM_MAX_UV_SETS; ++k) {
            free_delta(context, &p->targets[i].uvs[k]);
        }
    }
    ppmi_free(context, p->targets);
    ppmi_free(context, p->colors);
    for (size_t k = 0; k < PPM_MAX_UV_SETS; ++k) {
        ppmi_free(context, p->uvs[k]);
    }
    ppmi_free(context, p->positions);
    ppmi_free(context, p->normals);
    ppmi_free(context, p->tangents);
    ppmi_free(context, p->joints);
    ppmi_free(context, p->weights);
    ppmi_free(context, p->buffer);
}

void ppmi_gltf_deform_destroy(ppm_context *context, ppmi_gltf_deform *deform)
{
    if (!deform) return;
    for (uint32_t i = 0; deform->primitives && i < deform->primitive_count; ++i) {
        free_primitive(context, &deform->primitives[i]);
    }
    ppmi_free(context, deform->primitives);
    ppmi_free(context, deform->inverse_binds);
    ppmi_free(context, deform);
}

/* ---- reading --------------------------------------------------------------------------------- */

/* One primitive that is being read. */
typedef struct source {
    ppmi_gltf_reader *reader;
    const ppmi_gltf_primitive *primitive;
    const char *place;
    const ppmi_gltf_geometry *geometry;
    size_t count; /* of vertices in the file */
} source;

static int32_t find_attribute(const ppmi_gltf_attribute *attributes, uint32_t count,
                              const char *name)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (strcmp(attributes[i].name, name) == 0) return attributes[i].accessor;
    }
    return -1;
}

/* The number in the file of a vertex that was kept. */
static size_t source_index(const source *s, size_t vertex)
{
    return s->geometry->sources ? s->geometry->sources[vertex] : vertex;
}

/* An attribute of as many elements as POSITION has. */
static ppm_status read_values(const source *s, int32_t accessor, const char *place,
                              const ppmi_gltf_format *format, float **out)
{
    size_t count;
    const ppm_status status =
        ppmi_gltf_read_floats(s->reader, accessor, place, format, out, &count);
    if (status != PPM_STATUS_OK || count == s->count) return status;
    ppmi_free(s->reader->context, *out);
    *out = NULL;
    return ppmi_gltf_invalid(s->reader, place, "%zu elements, POSITION has %zu", count, s->count);
}

/* ---- morph targets --------------------------------------------------------------------------- */

static bool is_zero(const float *values, uint32_t width)
{
    for (uint32_t i = 0; i < width; ++i) {
        if (values[i] != 0.0f) return false;
    }
    return true;
}

/* values has stride per vertex of the file, of which the first out->width count. */
static ppm_status keep_delta(const source *s, const float *values, size_t stride, const char *place,
                             ppmi_gltf_delta *out)
{
    const size_t vertex_count = s->geometry->vertex_count;
    uint32_t count = 0;
    for (size_t i = 0; i < vertex_count; ++i) {
        const float *value = values + stride * source_index(s, i);
        for (uint32_t k = 0; k < out->width; ++k) {
            if (isfinite(value[k])) continue;
            return ppmi_gltf_invalid(s->reader, place, "element %zu is not a finite number",
                                     source_index(s, i));
        }
        count += !is_zero(value, out->width);
    }
    if (count == 0) return PPM_STATUS_OK;
    out->vertices = ppmi_alloc(s->reader->context, count, sizeof *out->vertices);
    out->values = ppmi_alloc(s->reader->context, count, out->width * sizeof *out->values);
    if (!out->vertices || !out->values) return ppmi_gltf_out_of_memory(s->reader, place);
    for (size_t i = 0; i < vertex_count; ++i) {
        const float *value = values + stride * source_index(s, i);
        if (is_zero(value, out->width)) continue;
        memcpy(out->values + out->width * (size_t)out->count, value, out->width * sizeof *value);
        out->vertices[out->count++] = (uint32_t)i;
    }
    return PPM_STATUS_OK;
}

/* One attribute of a target. base is what it is added to; NULL where the primitive has none. */
static ppm_status read_delta(const source *s, uint32_t target, const char *name,
                             const ppmi_gltf_format *format, const float *base,
                             ppmi_gltf_delta *out)
{
    const ppmi_gltf_target *from = &s->primitive->targets[target];
    const int32_t accessor = find_attribute(from->attributes, from->attribute_count, name);
    char place[PPMI_GLTF_PLACE];
    float *values = NULL;
    if (accessor < 0 || !base) return PPM_STATUS_OK;
    ppmi_gltf_place(place, "%s.targets[%u].%s", s->place, (unsigned)target, name);
    ppm_status status = read_values(s, accessor, place, format, &values);
    if (status == PPM_STATUS_OK) {
        /* three of four where a colour has no alpha */
        out->width = s->reader->document->accessors[accessor].component_count;
        status = keep_delta(s, values, format->out_components, place, out);
    }
    ppmi_free(s->reader->context, values);
    return status;
}

static ppm_status read_target(const source *s, uint32_t index, ppmi_gltf_morph *target)
{
    static const ppmi_gltf_format vec2 = {2, 2, 2, false}, vec3 = {3, 3, 3, false};
    static const ppmi_gltf_format color = {3, 4, 4, true};
    const ppmi_gltf_geometry *g = s->geometry;
    const struct {
        const char *name;
        const ppmi_gltf_format *format;
        const float *base;
        ppmi_gltf_delta *delta;
    } parts[] = {{"POSITION", &vec3, g->positions, &target->position},
                 {"NORMAL", &vec3, g->normals, &target->normal},
                 {"TANGENT", &vec3, g->tangents, &target->tangent},
                 {"COLOR_0", &color, g->colors, &target->color}};
    ppm_status status = PPM_STATUS_OK;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0] && status == PPM_STATUS_OK; ++i) {
        status =
            read_delta(s, index, parts[i].name, parts[i].format, parts[i].base, parts[i].delta);
    }
    char name[] = "TEXCOORD_0";
    for (size_t i = 0; i < PPM_MAX_UV_SETS && status == PPM_STATUS_OK; ++i) {
        name[9] = (char)('0' + i);
        status = read_delta(s, index, name, &vec2, g->uvs[i], &target->uvs[i]);
    }
    return status;
}

/* A copy of what a target changes, for all to be added to; *out stays NULL without one. */
static ppm_status keep_base(const source *s, const float *values, size_t width, bool is_changed,
                            float **out)
{
    const size_t count = s->geometry->vertex_count;
    if (!is_changed || *out) return PPM_STATUS_OK;
    *out = ppmi_alloc(s->reader->context, count, width * sizeof **out);
    if (!*out) return ppmi_gltf_out_of_memory(s->reader, s->place);
    memcpy(*out, values, count * width * sizeof **out);
    return PPM_STATUS_OK;
}

static ppm_status keep_colors_and_uvs(const source *s, const ppmi_gltf_morph *target,
                                      ppmi_gltf_deform_primitive *p)
{
    const ppmi_gltf_geometry *g = s->geometry;
    ppm_status status = keep_base(s, g->colors, 4, target->color.count > 0, &p->colors);
    for (size_t i = 0; i < PPM_MAX_UV_SETS && status == PPM_STATUS_OK; ++i) {
        status = keep_base(s, g->uvs[i], 2, target->uvs[i].count > 0, &p->uvs[i]);
    }
    return status;
}

static ppm_status read_targets(const source *s, ppmi_gltf_deform_primitive *p)
{
    ppm_status status = PPM_STATUS_OK;
    if (s->primitive->target_count == 0) return PPM_STATUS_OK;
    p->targets =
        ppmi_alloc_zeroed(s->reader->context, s->primitive->target_count, sizeof *p->targets);
    if (!p->targets) return ppmi_gltf_out_of_memory(s->reader, s->place);
    p->target_count = s->primitive->target_count;
    for (uint32_t i = 0; i < p->target_count && status == PPM_STATUS_OK; ++i) {
        status = read_target(s, i, &p->targets[i]);
        if (status == PPM_STATUS_OK) status = keep_colors_and_uvs(s, &p->targets[i], p);
    }
    return status;
}

/* ---- influences ------------------------------------------------------------------------------ */

/* Sets of four joints and weights: JOINTS_0 and WEIGHTS_0, JOINTS_1 and WEIGHTS_1, ... */
static uint32_t count_sets(const ppmi_gltf_primitive *p)
{
    uint32_t count = 0;
    for (char name[] = "JOINTS_0"; count < 10; name[7] = (char)('0' + ++count)) {
        if (find_attribute(p->attributes, p->attribute_count, name) < 0) break;
    }
    return count;
}

static ppm_status read_joint(const source *s, uint32_t joint_count, const char *place, float value,
                             float weight, uint16_t *out)
{
    *out = 0;
    if (value >= 0.0f && value < (float)joint_count && value == floorf(value)) {
        *out = (uint16_t)value;
        return PPM_STATUS_OK;
    }
    if (weight == 0.0f) return PPM_STATUS_OK; /* it has no say */
    return ppmi_gltf_invalid(s->reader, place, "joint %g, the skin has %u", (double)value,
                             (unsigned)joint_count);
}

static ppm_status read_set(const source *s, uint32_t set, uint32_t joint_count,
                           ppmi_gltf_deform_primitive *p)
{
    static const ppmi_gltf_format joint_format = {4, 4, 4, false}, weight_format = {4, 4, 4, true};
    const ppmi_gltf_primitive *from = s->primitive;
    char joints_name[] = "JOINTS_0", weights_name[] = "WEIGHTS_0", place[PPMI_GLTF_PLACE];
    float *joints = NULL, *weights = NULL;
    joints_name[7] = weights_name[8] = (char)('0' + set);
    ppmi_gltf_place(place, "%s.attributes.%s", s->place, weights_name);
    const int32_t accessor = find_attribute(from->attributes, from->attribute_count, weights_name);
    if (accessor < 0) return ppmi_gltf_invalid(s->reader, place, "missing beside %s", joints_name);
    ppm_status status = read_values(s, accessor, place, &weight_format, &weights);
    if (status == PPM_STATUS_OK) {
        ppmi_gltf_place(place, "%s.attributes.%s", s->place, joints_name);
        status =
            read_values(s, find_attribute(from->attributes, from->attribute_count, joints_name),
                        place, &joint_format, &joints);
    }
    for (size_t i = 0; i < p->vertex_count && status == PPM_STATUS_OK; ++i) {
        const size_t to = i * p->influence_count + 4 * (size_t)set, at = 4 * source_index(s, i);
        for (size_t k = 0; k < 4 && status == PPM_STATUS_OK; ++k) {
            const float weight = weights[at + k];
            p->weights[to + k] = isfinite(weight) ? fmaxf(weight, 0.0f) : 0.0f;
            status = read_joint(s, joint_count, place, joints[at + k], p->weights[to + k],
                                &p->joints[to + k]);
        }
    }
    ppmi_free(s->reader->context, joints);
    ppmi_free(s->reader->context, weights);
    return status;
}

/* A sum of 1 for each vertex. One without any weight follows its first joint. Returns how many of
 * these there were. */
static size_t normalize_weights(ppmi_gltf_deform_primitive *p)
{
    size_t without = 0;
    for (size_t i = 0; i < p->vertex_count; ++i) {
        float *weights = p->weights + i * p->influence_count;
        double sum = 0.0;
        for (uint32_t k = 0; k < p->influence_count; ++k) {
            sum += (double)weights[k];
        }
        if (!(sum > 0.0)) {
            weights[0] = 1.0f;
            ++without;
            continue;
        }
        for (uint32_t k = 0; k < p->influence_count; ++k) {
            weights[k] = (float)((double)weights[k] / sum);
        }
    }
    return without;
}

static ppm_status read_influences(const source *s, uint32_t joint_count,
                                  ppmi_gltf_deform_primitive *p)
{
    const uint32_t sets = count_sets(s->primitive);
    ppm_status status = PPM_STATUS_OK;
    if (sets == 0) {
        ppmi_gltf_warn(s->reader, s->place, "no JOINTS_0 for the skin: it follows the node");
        return PPM_STATUS_OK;
    }
    p->influence_count = 4 * sets;
    const size_t count = (size_t)p->vertex_count * p->influence_count;
    p->joints = ppmi_alloc(s->reader->context, count, sizeof *p->joints);
    p->weights = ppmi_alloc(s->reader->context, count, sizeof *p->weights);
    if (!p->joints || !p->weights) return ppmi_gltf_out_of_memory(s->reader, s->place);
    for (uint32_t i = 0; i < sets && status == PPM_STATUS_OK; ++i) {
        status = read_set(s, i, joint_count, p);
    }
    if (status != PPM_STATUS_OK) return status;
    const size_t without = normalize_weights(p);
    if (without > 0) {
        ppmi_gltf_warn(s->reader, s->place, "%zu vertices without weights follow their first joint",
                       without);
    }
    return PPM_STATUS_OK;
}

/* ---- matrices -------------------------------------------------------------------------------- */

/* From the mesh at rest to the world, for each joint. */
static void joint_matrices(const ppmi_gltf_pose *pose, const ppmi_gltf_deform *deform,
                           uint32_t step, uint32_t steps, double (*out)[16])
{
    for (uint32_t i = 0; i < deform->joint_count; ++i) {
        ppmi_gltf_matrix_multiply(ppmi_gltf_pose_world(pose, deform->joints[i], step, steps),
                                  deform->inverse_binds[i], out[i]);
    }
}

/* Whether the joints turn the mesh inside out, as a mirrored armature does. */
static bool is_mirrored(const ppmi_gltf_pose *pose, const ppmi_gltf_deform *deform)
{
    int32_t balance = 0;
    for (uint32_t i = 0; i < deform->joint_count; ++i) {
        double m[16];
        ppmi_gltf_matrix_multiply(ppmi_gltf_pose_world(pose, deform->joints[i], 0, 1),
                                  deform->inverse_binds[i], m);
        const double determinant = ppmi_gltf_matrix_determinant(m);
        balance += (determinant > 0.0) - (determinant < 0.0);
    }
    return balance < 0;
}

ppm_status ppmi_gltf_deform_read(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform,
                                 const ppmi_gltf_primitive *primitive, const char *place,
                                 ppmi_gltf_geometry *g)
{
    ppmi_gltf_deform_primitive *p = &deform->primitives[deform->primitive_count++];
    const int32_t position =
        find_attribute(primitive->attributes, primitive->attribute_count, "POSITION");
    const source s = {reader, primitive, place, g, reader->document->accessors[position].count};
    p->vertex_count = (uint32_t)g->vertex_count;
    ppm_status status = read_targets(&s, p);
    if (status == PPM_STATUS_OK && deform->joint_count > 0) {
        status = read_influences(&s, deform->joint_count, p);
    }
    const bool has_sides = g->kind == PPM_PRIMITIVE_TRIANGLES && p->influence_count > 0;
    for (size_t i = 0; has_sides && i < g->triangle_count; ++i) {
        if (i == 0 && !is_mirrored(reader->pose, deform)) break;
        const uint32_t second = g->indices[3 * i + 1];
        g->indices[3 * i + 1] = g->indices[3 * i + 2];
        g->indices[3 * i + 2] = second;
    }
    p->positions = g->positions;
    p->normals = g->normals;
    p->tangents = g->tangents;
    g->is_taken = true;
    return status;
}

/* ---- a pose ---------------------------------------------------------------------------------- */

static uint32_t count_steps(const ppmi_gltf_pose *pose, const ppmi_gltf_deform *deform)
{
    uint32_t most = pose->weight_steps[deform->node];
    for (uint32_t i = 0; i < deform->joint_count; ++i) {
        const uint32_t steps = pose->node_steps[deform->joints[i]];
        if (steps > most) most = steps;
    }
    if (deform->joint_count > 0 && pose->node_steps[deform->node] > most) {
        most = pose->node_steps[deform->node]; /* primitives that follow the node */
    }
    return most;
}

bool ppmi_gltf_deform_has_moved(const ppmi_gltf_reader *reader, const ppmi_gltf_deform *deform)
{
    const ppmi_gltf_pose *pose = reader->pose;
    if (pose->has_changed_weights[deform->node]) return true;
    for (uint32_t i = 0; i < deform->joint_count; ++i) {
        if (pose->has_moved[deform->joints[i]]) return true;
    }
    return deform->joint_count > 0 && pose->has_moved[deform->node];
}

/* values has width per vertex: the delta's, or one more. */
static void add_delta(const ppmi_gltf_delta *delta, float weight, size_t width, float *values)
{
    const float *from = delta->values;
    const uint32_t count = delta->count;
#pragma omp parallel for if (count > SMALL)
    for (uint32_t i = 0; i < count; ++i) {
        for (size_t k = 0; k < delta->width; ++k) {
            values[width * delta->vertices[i] + k] += weight * from[delta->width * (size_t)i + k];
        }
    }
}

/* Colours and texture coordinates, one value a picture; returns where the next array may go. */
static float *add_to_copy(const ppmi_gltf_deform_primitive *p, const double *weights, size_t width,
                          const float *base, size_t offset, float *out)
{
    memcpy(out, base, width * p->vertex_count * sizeof *out);
    for (uint32_t i = 0; i < p->target_count; ++i) {
        const ppmi_gltf_delta *delta =
            (const ppmi_gltf_delta *)(const void *)((const unsigned char *)&p->targets[i] + offset);
        if (weights[i] != 0.0) add_delta(delta, (float)weights[i], width, out);
    }
    return out + width * p->vertex_count;
}

static void morph_colors_and_uvs(const ppmi_gltf_deform_primitive *p, const double *weights,
                                 float *out, ppm_primitive_desc *desc)
{
    if (p->colors) {
        desc->colors = out;
        float *end = add_to_copy(p, weights, 4, p->colors, offsetof(ppmi_gltf_morph, color), out);
        for (; out < end; ++out) {
            *out = fminf(fmaxf(*out, 0.0f), 1.0f); /* as the specification asks for */
        }
    }
    for (size_t i = 0; i < PPM_MAX_UV_SETS; ++i) {
        if (!p->uvs[i]) continue;
        desc->uvs[i] = out;
        out = add_to_copy(p, weights, 2, p->uvs[i],
                          offsetof(ppmi_gltf_morph, uvs) + i * sizeof(ppmi_gltf_delta), out);
    }
}

/* Floats per vertex that do not move but change. */
static size_t count_changing(const ppmi_gltf_deform_primitive *p)
{
    size_t width = p->colors ? 4 : 0;
    for (size_t i = 0; i < PPM_MAX_UV_SETS; ++i) {
        width += p->uvs[i] ? 2 : 0;
    }
    return width;
}

/* One moment of a primitive: where its arrays are written. */
typedef struct block {
    float *positions, *normals, *tangents;
} block;

static void morph(const ppmi_gltf_deform_primitive *p, const double *weights, const block *b)
{
    const size_t count = p->vertex_count;
    memcpy(b->positions, p->positions, 3 * count * sizeof *b->positions);
    if (p->normals) memcpy(b->normals, p->normals, 3 * count * sizeof *b->normals);
    if (p->tangents) memcpy(b->tangents, p->tangents, 4 * count * sizeof *b->tangents);
    for (uint32_t i = 0; i < p->target_count; ++i) {
        const float weight = (float)weights[i];
        if (weight == 0.0f) continue;
        add_delta(&p->targets[i].position, weight, 3, b->positions);
        if (p->normals) add_delta(&p->targets[i].normal, weight, 3, b->normals);
        if (p->tangents) add_delta(&p->targets[i].tangent, weight, 4, b->tangents);
    }
}

static void blend(const ppmi_gltf_deform_primitive *p, size_t vertex, double (*matrices)[16],
                  double out[16])
{
    const uint16_t *joints = p->joints + vertex * p->influence_count;
    const float *weights = p->weights + vertex * p->influence_count;
    memset(out, 0, 16 * sizeof *out);
    for (uint32_t k = 0; k < p->influence_count; ++k) {
        if (weights[k] == 0.0f) continue;
        for (size_t i = 0; i < 16; ++i) {
            out[i] += (double)weights[k] * matrices[joints[k]][i];
        }
    }
}

static void move_point(const double m[16], float p[3])
{
    const double x = (double)p[0], y = (double)p[1], z = (double)p[2];
    for (size_t i = 0; i < 3; ++i) {
        p[i] = (float)(m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i]);
    }
}

static void store_unit(const double v[3], float out[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (size_t i = 0; i < 3; ++i) {
        out[i] = length > 0.0 ? (float)(v[i] / length) : 0.0f;
    }
}

static void move_direction(const double m[16], float d[3])
{
    double v[3];
    for (size_t i = 0; i < 3; ++i) {
        v[i] = m[i] * (double)d[0] + m[4 + i] * (double)d[1] + m[8 + i] * (double)d[2];
    }
    store_unit(v, d);
}

static void move_normal(const double m[16], float n[3])
{
    const double sign = ppmi_gltf_matrix_determinant(m) < 0.0 ? -1.0 : 1.0;
    const double x = sign * (double)n[0], y = sign * (double)n[1], z = sign * (double)n[2];
    double v[3];
    for (size_t i = 0; i < 3; ++i) {
        const size_t j = (i + 1) % 3, k = (i + 2) % 3;
        v[i] = x * (m[4 + j] * m[8 + k] - m[4 + k] * m[8 + j]) +
               y * (m[8 + j] * m[k] - m[8 + k] * m[j]) + z * (m[j] * m[4 + k] - m[k] * m[4 + j]);
    }
    store_unit(v, n);
}

/* With one matrix for all, or the sum of each vertex's joints. */
static void skin(const ppmi_gltf_deform_primitive *p, double (*matrices)[16], const double *whole,
                 const block *b)
{
#pragma omp parallel for if (p->vertex_count > SMALL)
    for (uint32_t i = 0; i < p->vertex_count; ++i) {
        double sum[16];
        if (!whole) blend(p, i, matrices, sum);
        const double *m = whole ? whole : sum;
        move_point(m, b->positions + 3 * (size_t)i);
        if (p->normals) move_normal(m, b->normals + 3 * (size_t)i);
        if (p->tangents) move_direction(m, b->tangents + 4 * (size_t)i);
    }
}

static ppm_status fill(ppmi_gltf_reader *reader, const ppmi_gltf_deform *deform,
                       const ppmi_gltf_deform_primitive *p, uint32_t steps, const block *first)
{
    const ppmi_gltf_pose *pose = reader->pose;
    const size_t count = p->vertex_count;
    double(*matrices)[16] =
        ppmi_alloc(reader->context, (size_t)deform->joint_count + 1, sizeof *matrices);
    if (!matrices) return ppmi_gltf_out_of_memory(reader, "skins");
    for (uint32_t i = 0; i < steps; ++i) {
        const block b = {first->positions + 3 * i * count,
                         p->normals ? first->normals + 3 * i * count : NULL,
                         p->tangents ? first->tangents + 4 * i * count : NULL};
        morph(p, ppmi_gltf_pose_weights_at(pose, deform->node, i, steps), &b);
        if (deform->joint_count == 0) continue;
        joint_matrices(pose, deform, i, steps, matrices);
        skin(p, matrices,
             p->influence_count == 0 ? ppmi_gltf_pose_world(pose, deform->node, i, steps) : NULL,
             &b);
    }
    ppmi_free(reader->context, matrices);
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_deform_pose(ppmi_gltf_reader *reader, ppmi_gltf_deform *deform, uint32_t index,
                                 ppm_primitive_desc *desc)
{
    ppmi_gltf_deform_primitive *p = &deform->primitives[index];
    const uint32_t steps = count_steps(reader->pose, deform);
    const size_t count = (size_t)steps * p->vertex_count;
    const size_t width = 3 + (p->normals ? 3 : 0) + (p->tangents ? 4 : 0);
    ppmi_free(reader->context, p->buffer);
    p->buffer = ppmi_alloc(reader->context, count * width + count_changing(p) * p->vertex_count,
                           sizeof *p->buffer);
    if (!p->buffer) return ppmi_gltf_out_of_memory(reader, "skins and morph targets");
    const block b = {p->buffer, p->normals ? p->buffer + 3 * count : NULL,
                     p->tangents ? p->buffer + (p->normals ? 6 : 3) * count : NULL};
    desc->positions = b.positions;
    desc->normals = b.normals;
    desc->tangents = b.tangents;
    desc->motion_steps = steps;
    desc->vertex_count = p->vertex_count;
    morph_colors_and_uvs(p, reader->pose->weights + reader->pose->first_weight[deform->node],
                         p->buffer + count * width, desc);
    return fill(reader, deform, p, steps, &b);
}

void ppmi_gltf_deform_release(ppm_context *context, ppmi_gltf_deform *deform)
{
    for (uint32_t i = 0; i < deform->primitive_count; ++i) {
        ppmi_free(context, deform->primitives[i].buffer);
        deform->primitives[i].buffer = NULL;
    }
}
