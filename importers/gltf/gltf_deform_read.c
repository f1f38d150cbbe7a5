/* Reading what moves a primitive: its morph targets, and the joints that its vertices follow. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_deform.h"
#include "gltf/gltf_matrix.h"
#include "gltf/gltf_pose.h"

/* One primitive that is being read. */
typedef struct source {
    ppmi_gltf_reader *reader;
    const ppmi_gltf_primitive *primitive;
    const char *place;
    const ppmi_gltf_geometry *geometry;
    size_t count; /* of vertices in the file */
} source;

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
    const int32_t accessor =
        ppmi_gltf_find_attribute(from->attributes, from->attribute_count, name);
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
        if (ppmi_gltf_find_attribute(p->attributes, p->attribute_count, name) < 0) break;
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
    const int32_t accessor =
        ppmi_gltf_find_attribute(from->attributes, from->attribute_count, weights_name);
    if (accessor < 0) return ppmi_gltf_invalid(s->reader, place, "missing beside %s", joints_name);
    ppm_status status = read_values(s, accessor, place, &weight_format, &weights);
    if (status == PPM_STATUS_OK) {
        ppmi_gltf_place(place, "%s.attributes.%s", s->place, joints_name);
        status = read_values(
            s, ppmi_gltf_find_attribute(from->attributes, from->attribute_count, joints_name),
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

/* ---- a primitive ----------------------------------------------------------------------------- */

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
    const source s = {reader, primitive, place, g, g->source_count};
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
