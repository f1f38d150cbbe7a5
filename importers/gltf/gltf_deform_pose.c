/* Morph targets and skins, applied to the vertices of a primitive.
 *
 * A skinned vertex is moved by the weighted sum of its joints' matrices, each of which leads from
 * the mesh at rest to the world; the node's own transform has no say. Normals go with the cofactors
 * of that sum, which is its inverse transpose up to a factor, and tangents with the sum itself. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_deform.h"
#include "gltf/gltf_matrix.h"
#include "gltf/gltf_pose.h"

enum { SMALL = 2048 }; /* vertices that are not worth a second thread */

/* From the mesh at rest to the world, for each joint. */
static void joint_matrices(const ppmi_gltf_pose *pose, const ppmi_gltf_deform *deform,
                           uint32_t step, uint32_t steps, double (*out)[16])
{
    for (uint32_t i = 0; i < deform->joint_count; ++i) {
        ppmi_gltf_matrix_multiply(ppmi_gltf_pose_world(pose, deform->joints[i], step, steps),
                                  deform->inverse_binds[i], out[i]);
    }
}

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
