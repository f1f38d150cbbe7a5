/* Where every node is while the shutter is open. Transforms are composed in double precision.
 *
 * Renderers move what is between two steps on straight lines, matrices element by element. A turn
 * shrinks on the way, by 1 - cos(angle / 2) in the middle. So the shutter is looked at at many
 * times, and each node keeps as few of them as show its way to a part in 500: a turn of 7 degrees
 * needs the two ends. */
#include "gltf/gltf_pose.h"

#include <math.h>
#include <string.h>

#include "gltf/gltf_animation.h"
#include "gltf/gltf_matrix.h"

enum {
    MOST_SAMPLES = 33,       /* that are chosen by themselves; 2^n + 1 */
    MOST_MATRICES = 1 << 21, /* of all nodes and samples: 256 MB */
    NOT_IN_SCENE = -2
};
#define TOLERANCE 0.002 /* of a matrix, by its longest column, and of a way, by its extent */

/* ---- memory ---------------------------------------------------------------------------------- */

static uint32_t count_targets(const ppmi_gltf_document *d, const ppmi_gltf_node *node)
{
    uint32_t most = 0;
    if (node->mesh < 0 || (size_t)node->mesh >= d->mesh_count) return 0;
    const ppmi_gltf_mesh *mesh = &d->meshes[node->mesh];
    for (uint32_t i = 0; i < mesh->primitive_count; ++i) {
        const uint32_t count = mesh->primitives[i].target_count;
        if (count > most) most = count;
    }
    return most;
}

/* The node's own weights, or else its mesh's, or else zeros. */
static void set_default_weights(const ppmi_gltf_document *d, const ppmi_gltf_node *node,
                                double *weights, size_t count)
{
    const bool has_own = node->weight_count > 0;
    const ppmi_gltf_mesh *mesh = &d->meshes[node->mesh];
    const double *from = has_own ? node->weights : mesh->weights;
    const uint32_t given = has_own ? node->weight_count : mesh->weight_count;
    for (size_t i = 0; i < count; ++i) {
        weights[i] = i < given ? from[i] : 0.0;
    }
}

static bool allocate(ppm_context *context, ppmi_gltf_pose *p, size_t count)
{
    const size_t n = count + 1; /* so that no nodes at all is no case of its own */
    p->node_count = count;
    p->order = ppmi_alloc(context, n, sizeof *p->order);
    p->parents = ppmi_alloc(context, n, sizeof *p->parents);
    p->assets = ppmi_alloc(context, n, sizeof *p->assets);
    p->groups = ppmi_alloc(context, n, sizeof *p->groups);
    p->first_weight = ppmi_alloc_zeroed(context, n, sizeof *p->first_weight);
    p->middle = ppmi_alloc_zeroed(context, n, sizeof *p->middle);
    p->is_visible = ppmi_alloc_zeroed(context, n, sizeof *p->is_visible);
    p->node_steps = ppmi_alloc_zeroed(context, n, sizeof *p->node_steps);
    p->weight_steps = ppmi_alloc_zeroed(context, n, sizeof *p->weight_steps);
    p->has_moved = ppmi_alloc_zeroed(context, n, sizeof *p->has_moved);
    p->has_changed_weights = ppmi_alloc_zeroed(context, n, sizeof *p->has_changed_weights);
    return p->order && p->parents && p->assets && p->groups && p->first_weight && p->middle &&
           p->is_visible && p->node_steps && p->weight_steps && p->has_moved &&
           p->has_changed_weights;
}

ppm_status ppmi_gltf_pose_create(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *d = reader->document;
    ppmi_gltf_pose *p = ppmi_alloc_zeroed(reader->context, 1, sizeof *p);
    reader->pose = p;
    if (!p || !allocate(reader->context, p, d->node_count)) {
        return ppmi_gltf_out_of_memory(reader, "nodes");
    }
    for (size_t i = 0; i < p->node_count; ++i) {
        p->parents[i] = NOT_IN_SCENE;
        p->first_weight[i + 1] = p->first_weight[i] + count_targets(d, &d->nodes[i]);
    }
    p->weights = ppmi_alloc(reader->context, p->first_weight[p->node_count] + 1, sizeof(double));
    if (!p->weights) return ppmi_gltf_out_of_memory(reader, "nodes");
    for (size_t i = 0; i < p->node_count; ++i) {
        const size_t first = p->first_weight[i], count = p->first_weight[i + 1] - first;
        if (count > 0) set_default_weights(d, &d->nodes[i], p->weights + first, count);
    }
    return PPM_STATUS_OK;
}

void ppmi_gltf_pose_destroy(ppm_context *context, ppmi_gltf_pose *p)
{
    if (!p) return;
    ppmi_free(context, p->order);
    ppmi_free(context, p->parents);
    ppmi_free(context, p->assets);
    ppmi_free(context, p->groups);
    ppmi_free(context, p->first_weight);
    ppmi_free(context, p->weights);
    ppmi_free(context, p->worlds);
    ppmi_free(context, p->sampled_weights);
    ppmi_free(context, p->middle);
    ppmi_free(context, p->is_visible);
    ppmi_free(context, p->node_steps);
    ppmi_free(context, p->weight_steps);
    ppmi_free(context, p->has_moved);
    ppmi_free(context, p->has_changed_weights);
    ppmi_free(context, p);
}

/* ---- one time -------------------------------------------------------------------------------- */

static void local_matrix(const ppmi_gltf_node *node, double out[16])
{
    if (!node->has_matrix) {
        ppmi_gltf_matrix_compose(node->translation, node->rotation, node->scale, out);
        return;
    }
    memcpy(out, node->matrix, sizeof node->matrix);
    out[3] = out[7] = out[11] = 0.0;
    out[15] = 1.0;
}

/* The places of all nodes with the values that the document has now. */
static void place_all(const ppmi_gltf_reader *reader, const ppmi_gltf_pose *p, double (*worlds)[16])
{
    for (size_t k = 0; k < p->order_count; ++k) {
        const int32_t node = p->order[k], parent = p->parents[node];
        double local[16];
        local_matrix(&reader->document->nodes[node], local);
        if (parent >= 0) {
            ppmi_gltf_matrix_multiply(worlds[parent], local, worlds[node]);
        } else {
            memcpy(worlds[node], local, sizeof local);
            for (int i = 0; i < 3; ++i) {
                worlds[node][12 + i] -= p->origin_m[i];
            }
        }
    }
}

/* ---- the origin ------------------------------------------------------------------------------ */

/* The node at which a node's mesh is, at rest; -1: nowhere. */
static int32_t node_of_mesh(const ppmi_gltf_reader *reader, const ppmi_gltf_pose *p, int32_t index)
{
    const ppmi_gltf_document *d = reader->document;
    const ppmi_gltf_node *node = &d->nodes[index];
    if (node->mesh < 0) return -1;
    if (node->skin < 0) return index;
    if ((size_t)node->skin >= d->skin_count || d->skins[node->skin].joint_count == 0) return -1;
    const int32_t joint = d->skins[node->skin].joints[0];
    const bool is_there =
        joint >= 0 && (size_t)joint < d->node_count && p->parents[joint] != NOT_IN_SCENE;
    return is_there ? joint : -1;
}

/* Where it is; false where it is nowhere. */
static bool place_of_mesh(ppmi_gltf_reader *reader, const ppmi_gltf_pose *p, int32_t index,
                          double out[3])
{
    const int32_t node = node_of_mesh(reader, p, index);
    double base[3] = {0.0, 0.0, 0.0};
    if (node < 0) return false;
    /* a broken one is told where it is read */
    if (node == index &&
        ppmi_gltf_mesh_base(reader, reader->document->nodes[index].mesh, base) != PPM_STATUS_OK) {
        return false;
    }
    ppmi_gltf_matrix_apply(p->middle[node], base, out);
    return true;
}

/* The middle of the places of all meshes; false when there are none. */
static bool find_middle(ppmi_gltf_reader *reader, const ppmi_gltf_pose *p, double middle[3],
                        double *out_size)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < p->shown_count; ++k) {
        double at[3];
        const bool is_there = place_of_mesh(reader, p, p->order[k], at);
        for (int i = 0; is_there && i < 3; ++i) {
            low[i] = fmin(low[i], at[i]);
            high[i] = fmax(high[i], at[i]);
        }
    }
    *out_size = 0.0;
    for (int i = 0; i < 3; ++i) {
        middle[i] = nearbyint(0.5 * (low[i] + high[i]));
        *out_size = fmax(*out_size, high[i] - low[i]);
    }
    return low[0] <= high[0];
}

ppm_status ppmi_gltf_pose_choose_origin(ppmi_gltf_reader *reader)
{
    const double near_m = 1000.0, far_in_sizes = 8.0;
    ppmi_gltf_pose *p = reader->pose;
    double middle[3], size;
    ppm_scene_info info = {.size = sizeof info};
    const ppm_status status = ppm_scene_get_info(reader->scene, &info);
    if (status != PPM_STATUS_OK) return status;
    ppm_scene_get_origin(reader->scene, p->origin_m);
    if (info.instances + info.cameras + info.lights > 0) return PPM_STATUS_OK;
    place_all(reader, p, p->middle);
    if (!find_middle(reader, p, middle, &size)) return PPM_STATUS_OK;
    const double far = fmax(fabs(middle[0]), fmax(fabs(middle[1]), fabs(middle[2])));
    if (!(far > fmax(near_m, far_in_sizes * size)) || !(far < 1e15)) return PPM_STATUS_OK;
    memcpy(p->origin_m, middle, sizeof middle);
    ppmi_log(reader->context, PPM_LOG_INFO,
             "%s: lies around %.0f %.0f %.0f m, which is the point 0 of the scene", reader->path,
             middle[0], middle[1], middle[2]);
    return ppm_scene_set_origin(reader->scene, middle);
}

/* ---- how many samples are needed ------------------------------------------------------------- */

/* Vectors of width values at the samples; stride apart. */
typedef struct series {
    const double *values;
    size_t width, stride;
    uint32_t count;
} series;

static double at(const series *s, uint32_t sample, size_t i)
{
    return s->values[sample * s->stride + i];
}

static bool is_at_rest(const series *s)
{
    for (uint32_t k = 1; k < s->count; ++k) {
        if (memcmp(s->values, s->values + k * s->stride, s->width * sizeof *s->values) != 0) {
            return false;
        }
    }
    return true;
}

/* Largest difference between value i and the straight lines through every step-th sample. */
static double line_error(const series *s, size_t i, uint32_t step)
{
    double most = 0.0;
    for (uint32_t k = 0; k < s->count; ++k) {
        const uint32_t begin = k / step * step,
                       end = begin + step < s->count ? begin + step : begin;
        const double t = (double)(k - begin) / step;
        const double line = (1.0 - t) * at(s, begin, i) + t * at(s, end, i);
        most = fmax(most, fabs(at(s, k, i) - line));
    }
    return most;
}

static double extent(const series *s, size_t i)
{
    double low = at(s, 0, i), high = low;
    for (uint32_t k = 1; k < s->count; ++k) {
        low = fmin(low, at(s, k, i));
        high = fmax(high, at(s, k, i));
    }
    return high - low;
}

/* Whether every step-th sample of a matrix is enough. */
static bool is_matrix_shown(const series *s, uint32_t step)
{
    double longest = 0.0, way = 0.0;
    for (int column = 0; column < 3; ++column) {
        const double x = at(s, 0, 4 * (size_t)column), y = at(s, 0, 4 * (size_t)column + 1);
        const double z = at(s, 0, 4 * (size_t)column + 2);
        longest = fmax(longest, sqrt(x * x + y * y + z * z));
        way = fmax(way, extent(s, 12 + (size_t)column));
    }
    for (size_t i = 0; i < 16; ++i) {
        if (i % 4 == 3) continue;
        if (line_error(s, i, step) > TOLERANCE * (i < 12 ? longest : way)) return false;
    }
    return true;
}

static bool are_weights_shown(const series *s, uint32_t step)
{
    for (size_t i = 0; i < s->width; ++i) {
        if (line_error(s, i, step) > TOLERANCE * fmax(1.0, extent(s, i))) return false;
    }
    return true;
}

/* The fewest samples that are enough; as many as there are when they were asked for. */
static uint32_t choose_steps(const series *s, bool is_asked_for,
                             bool (*is_shown)(const series *s, uint32_t step))
{
    if (is_at_rest(s)) return 1;
    for (uint32_t step = s->count - 1; !is_asked_for && step > 1; step /= 2) {
        if (is_shown(s, step)) return (s->count - 1) / step + 1;
    }
    return s->count;
}

static void choose_all_steps(ppmi_gltf_pose *p, bool is_asked_for)
{
    const size_t weight_count = p->first_weight[p->node_count];
    for (size_t k = 0; k < p->order_count; ++k) {
        const int32_t i = p->order[k];
        const size_t first = p->first_weight[i];
        const series place = {p->worlds[i], 16, 16 * p->node_count, p->sample_count};
        const series weights = {p->sampled_weights + first, p->first_weight[i + 1] - first,
                                weight_count, p->sample_count};
        p->node_steps[i] = choose_steps(&place, is_asked_for, is_matrix_shown);
        p->weight_steps[i] = choose_steps(&weights, is_asked_for, are_weights_shown);
    }
}

/* ---- samples --------------------------------------------------------------------------------- */

static uint32_t choose_sample_count(const ppmi_gltf_pose *p, const ppm_pose *when)
{
    uint32_t count = MOST_SAMPLES;
    if (!when->is_animated || !(when->close_s > when->open_s)) return 1;
    if (when->motion_steps > 0) return when->motion_steps;
    while (count > 2 && count * p->node_count > MOST_MATRICES) {
        count = (count + 1) / 2;
    }
    return count;
}

static void sample_all(ppmi_gltf_reader *reader, ppmi_gltf_pose *p, const ppm_pose *when)
{
    const size_t weight_count = p->first_weight[p->node_count];
    const double span = when->close_s - when->open_s;
    for (uint32_t k = 0; k < p->sample_count; ++k) {
        const double t = p->sample_count > 1 ? (double)k / (p->sample_count - 1) : 0.0;
        if (when->is_animated) ppmi_gltf_animations_apply(reader, when->open_s + t * span);
        place_all(reader, p, p->worlds + k * p->node_count);
        memcpy(p->sampled_weights + k * weight_count, p->weights,
               weight_count * sizeof *p->weights);
    }
    if (when->is_animated) ppmi_gltf_animations_apply(reader, when->open_s + 0.5 * span);
    place_all(reader, p, p->middle);
}

/* ---- what is different ----------------------------------------------------------------------- */

/* What the pose before was. */
typedef struct earlier {
    uint32_t sample_count; /* 0: there was none */
    double (*worlds)[16];
    double *weights;
} earlier;

/* Whether a series has other values than before. steps are what it needs now. */
static bool is_other(const series *now, const series *before, uint32_t steps)
{
    if (before->count == 0) return true;
    const bool was_at_rest = is_at_rest(before);
    if (steps == 1 && was_at_rest) {
        return memcmp(now->values, before->values, now->width * sizeof *now->values) != 0;
    }
    if (now->count != before->count || was_at_rest) return true;
    for (uint32_t k = 0; k < now->count; ++k) {
        if (memcmp(now->values + k * now->stride, before->values + k * before->stride,
                   now->width * sizeof *now->values) != 0) {
            return true;
        }
    }
    return false;
}

static void find_changes(ppmi_gltf_reader *reader, ppmi_gltf_pose *p, const earlier *before)
{
    const size_t count = p->node_count, weight_count = p->first_weight[count];
    for (size_t k = 0; k < p->order_count; ++k) {
        const int32_t i = p->order[k], parent = p->parents[i];
        const size_t first = p->first_weight[i], width = p->first_weight[i + 1] - first;
        const bool is_visible =
            reader->document->nodes[i].visibility > 0.5 && (parent < 0 || p->is_visible[parent]);
        const series place = {p->worlds[i], 16, 16 * count, p->sample_count};
        series old_place = place,
               weights = {p->sampled_weights + first, width, weight_count, p->sample_count};
        series old_weights = weights;
        old_place.count = old_weights.count = before->sample_count;
        if (before->sample_count > 0) {
            old_place.values = before->worlds[i];
            old_weights.values = before->weights + first;
        }
        p->has_moved[i] =
            is_visible != p->is_visible[i] || is_other(&place, &old_place, p->node_steps[i]);
        p->has_changed_weights[i] = is_other(&weights, &old_weights, p->weight_steps[i]);
        p->is_visible[i] = is_visible;
    }
}

/* Its warnings are new, even when the import is long over. */
static ppm_status bind(ppmi_gltf_reader *reader)
{
    const bool is_posed_again = reader->is_posed_again;
    reader->is_posed_again = false;
    const ppm_status status = ppmi_gltf_animations_bind(reader);
    reader->is_posed_again = is_posed_again;
    return status;
}

ppm_status ppmi_gltf_pose_take(ppmi_gltf_reader *reader, const ppm_pose *when)
{
    ppmi_gltf_pose *p = reader->pose;
    const earlier before = {p->sample_count, p->worlds, p->sampled_weights};
    if (when->is_animated) {
        const ppm_status status = bind(reader);
        if (status != PPM_STATUS_OK) return status;
    } else {
        ppmi_gltf_animations_rest(reader);
    }
    p->sample_count = choose_sample_count(p, when);
    p->worlds =
        ppmi_alloc_zeroed(reader->context, p->sample_count * p->node_count + 1, sizeof *p->worlds);
    p->sampled_weights = ppmi_alloc(
        reader->context, p->sample_count * p->first_weight[p->node_count] + 1, sizeof(double));
    ppm_status status = PPM_STATUS_OK;
    if (p->worlds && p->sampled_weights) {
        sample_all(reader, p, when);
        choose_all_steps(p, when->motion_steps > 0);
        find_changes(reader, p, &before);
    } else {
        status = ppmi_gltf_out_of_memory(reader, "nodes");
    }
    ppmi_free(reader->context, before.worlds);
    ppmi_free(reader->context, before.weights);
    return status;
}

/* ---- looking --------------------------------------------------------------------------------- */

static uint32_t sample_of(const ppmi_gltf_pose *p, uint32_t i, uint32_t steps)
{
    return steps > 1 ? i * ((p->sample_count - 1) / (steps - 1)) : 0;
}

const double *ppmi_gltf_pose_world(const ppmi_gltf_pose *p, int32_t node, uint32_t i,
                                   uint32_t steps)
{
    return p->worlds[sample_of(p, i, steps) * p->node_count + (size_t)node];
}

const double *ppmi_gltf_pose_weights_at(const ppmi_gltf_pose *p, int32_t node, uint32_t i,
                                        uint32_t steps)
{
    return p->sampled_weights + sample_of(p, i, steps) * p->first_weight[p->node_count] +
           p->first_weight[node];
}

double *ppmi_gltf_pose_weights(ppmi_gltf_reader *reader, int32_t node, uint32_t *out_count)
{
    ppmi_gltf_pose *p = reader->pose;
    *out_count = (uint32_t)(p->first_weight[node + 1] - p->first_weight[node]);
    return *out_count > 0 ? p->weights + p->first_weight[node] : NULL;
}
