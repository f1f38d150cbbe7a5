/* Things are taken as a whole where they are small, then split top down as in a bounding volume
 * hierarchy, while that leaves much less to be lit. */
#include "photon/target_clusters.h"

#include <stdlib.h>
#include <string.h>

/* Clusters are split while their parts together have less than this share of their size (the square
 * of the largest semi-axis, about the area that light has to be sent through). */
static const float split_gain = 0.6f;

static ppmi_target around_found(const ppmi_found *found, uint32_t count)
{
    ppmi_vec3 low = vec3_splat(INFINITY), high = vec3_splat(-INFINITY);
    for (uint32_t i = 0; i < count; i++) {
        low = vec3_lower(low, vec3_sub(found[i].target.center, found[i].target.half));
        high = vec3_upper(high, vec3_add(found[i].target.center, found[i].target.half));
    }
    return (ppmi_target){vec3_scale(vec3_add(low, high), 0.5f),
                         vec3_scale(vec3_sub(high, low), 0.5f)};
}

/* ---- things ---------------------------------------------------------------------------------- */

typedef void (*vertex_step)(ppmi_vec3 p, void *data);

/* Calls step for all places of the used vertices, over the shutter. */
static void for_vertices(const ppmi_instance *instance, const ppmi_primitive *primitive,
                         vertex_step step, void *data)
{
    for (uint32_t pose = 0; pose < instance->motion_steps; pose++) {
        const ppmi_transform *m = pose > 0 ? &instance->motion[pose] : &instance->to_world;
        for (uint32_t k = 0; k < primitive->motion_steps; k++) {
            const float *positions = primitive->positions + 3 * (size_t)k * primitive->vertex_count;
            for (size_t i = 0; i < 3 * (size_t)primitive->triangle_count; i++) {
                const ppmi_vec3 p = vec3_load(positions + 3 * (size_t)primitive->indices[i]);
                step(ppmi_transform_point(m, p), data);
            }
        }
    }
}

typedef struct vertex_bounds {
    ppmi_vec3 low, high;
} vertex_bounds;

static void grow_bounds(ppmi_vec3 p, void *data)
{
    vertex_bounds *bounds = data;
    bounds->low = vec3_lower(bounds->low, p);
    bounds->high = vec3_upper(bounds->high, p);
}

typedef struct vertex_reach {
    ppmi_target target;
    float reach2; /* in the target's scaled space */
} vertex_reach;

static void grow_reach(ppmi_vec3 p, void *data)
{
    vertex_reach *reach = data;
    const ppmi_vec3 way = vec3_sub(p, reach->target.center), half = reach->target.half;
    const ppmi_vec3 scaled = vec3(way.x / half.x, way.y / half.y, way.z / half.z);
    reach->reach2 = ppmi_max(reach->reach2, vec3_length2(scaled));
}

/* The ellipsoid around all triangles of a primitive. False where it has none. */
static bool around_primitive(const ppm_scene *scene, uint32_t instance, uint32_t primitive,
                             ppmi_target *out_target)
{
    const float slack = 1.002f, flattest = 0.02f;
    const ppmi_instance *there = &scene->instances[instance];
    const ppmi_primitive *thing = &scene->meshes[there->mesh].primitives[primitive];
    vertex_bounds bounds = {vec3_splat(INFINITY), vec3_splat(-INFINITY)};
    for_vertices(there, thing, grow_bounds, &bounds);
    if (!(bounds.low.x <= bounds.high.x)) return false;
    vertex_reach reach = {.target = {vec3_scale(vec3_add(bounds.low, bounds.high), 0.5f),
                                     vec3_scale(vec3_sub(bounds.high, bounds.low), 0.5f)}};
    const float most = ppmi_max(vec3_max_component(reach.target.half), 1e-20f);
    reach.target.half = vec3_upper(reach.target.half, vec3_splat(flattest * most));
    for_vertices(there, thing, grow_reach, &reach);
    *out_target = reach.target;
    out_target->half = vec3_scale(reach.target.half, slack * sqrtf(reach.reach2));
    return true;
}

static int by_thing(const void *a, const void *b)
{
    const ppmi_found *left = a, *right = b;
    if (left->instance != right->instance) return left->instance < right->instance ? -1 : 1;
    return (left->primitive > right->primitive) - (left->primitive < right->primitive);
}

/* Puts one place for each thing that is not much larger than what was found of it. Returns how many
 * are left. */
static uint32_t take_wholes(const ppm_scene *scene, ppmi_found *found, uint32_t count)
{
    const float much = 4.0f;
    qsort(found, count, sizeof *found, by_thing);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count;) {
        uint32_t end = i + 1;
        while (end < count && by_thing(&found[end], &found[i]) == 0)
            end++;
        const ppmi_target seen = around_found(found + i, end - i);
        ppmi_found whole = found[i];
        if (whole.instance != UINT32_MAX &&
            around_primitive(scene, whole.instance, whole.primitive, &whole.target) &&
            vec3_max_component(whole.target.half) <= much * vec3_max_component(seen.half)) {
            found[kept++] = whole;
        } else {
            memmove(found + kept, found + i, (end - i) * sizeof *found);
            kept += end - i;
        }
        i = end;
    }
    return kept;
}

/* ---- clusters -------------------------------------------------------------------------------- */

typedef struct cluster {
    uint32_t begin, end;
    float size2;
    uint32_t split; /* 0: is not worth while */
} cluster;

static int compare(float a, float b)
{
    return (a > b) - (a < b);
}

static int by_x(const void *a, const void *b)
{
    return compare(((const ppmi_found *)a)->target.center.x,
                   ((const ppmi_found *)b)->target.center.x);
}

static int by_y(const void *a, const void *b)
{
    return compare(((const ppmi_found *)a)->target.center.y,
                   ((const ppmi_found *)b)->target.center.y);
}

static int by_z(const void *a, const void *b)
{
    return compare(((const ppmi_found *)a)->target.center.z,
                   ((const ppmi_found *)b)->target.center.z);
}

static float size2_of(ppmi_vec3 low, ppmi_vec3 high)
{
    return ppmi_sqr(0.5f * vec3_max_component(vec3_sub(high, low)));
}

/* Sizes of all that begins a run, from the front or from the end. */
static void sweep(const ppmi_found *found, uint32_t count, bool from_end, float *sizes2)
{
    ppmi_vec3 low = vec3_splat(INFINITY), high = vec3_splat(-INFINITY);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t k = from_end ? count - 1 - i : i;
        low = vec3_lower(low, vec3_sub(found[k].target.center, found[k].target.half));
        high = vec3_upper(high, vec3_add(found[k].target.center, found[k].target.half));
        sizes2[k] = size2_of(low, high);
    }
}

/* Finds a cluster's best cut, and sorts it for it. scratch: 2 floats a place. */
static void find_split(ppmi_found *found, cluster *c, float *scratch)
{
    const uint32_t count = c->end - c->begin;
    ppmi_found *first = found + c->begin;
    const ppmi_target all = around_found(first, count);
    c->size2 = ppmi_sqr(vec3_max_component(all.half));
    c->split = 0;
    if (count < 2) return;
    const bool is_x = all.half.x >= all.half.y && all.half.x >= all.half.z;
    qsort(first, count, sizeof *first, is_x ? by_x : all.half.y >= all.half.z ? by_y : by_z);
    float *front = scratch, *back = scratch + count;
    sweep(first, count, false, front);
    sweep(first, count, true, back);
    float best = split_gain * c->size2;
    for (uint32_t i = 1; i < count; i++) {
        if (!(front[i - 1] + back[i] < best)) continue;
        best = front[i - 1] + back[i];
        c->split = i;
    }
}

/* The largest cluster that is worth a split; count for none. */
static uint32_t next_to_split(const cluster *clusters, uint32_t count)
{
    uint32_t best = count;
    for (uint32_t i = 0; i < count; i++) {
        if (clusters[i].split == 0) continue;
        if (best == count || clusters[i].size2 > clusters[best].size2) best = i;
    }
    return best;
}

static ppmi_target target_of(const ppmi_found *found, const cluster *c)
{
    if (c->end - c->begin == 1) return found[c->begin].target;
    enum { DIRECT = 64 };
    ppmi_target parts[DIRECT];
    const uint32_t count = c->end - c->begin, step = (count + DIRECT - 1) / DIRECT;
    uint32_t filled = 0;
    for (uint32_t i = 0; i < count; i += step) {
        const uint32_t left = count - i < step ? count - i : step;
        parts[filled++] =
            left == 1 ? found[c->begin + i].target : around_found(found + c->begin + i, left);
    }
    return ppmi_target_around(parts, filled);
}

ppm_status ppmi_cluster_found(ppm_context *context, const ppm_scene *scene, ppmi_found *found,
                              uint32_t count, ppmi_target *out_targets, uint32_t most,
                              uint32_t *out_count)
{
    *out_count = 0;
    if (count == 0 || most == 0) return PPM_STATUS_OK;
    float *scratch = ppmi_alloc(context, 2 * (size_t)count, sizeof *scratch);
    cluster *clusters = ppmi_alloc(context, most, sizeof *clusters);
    const bool has_memory = scratch && clusters;
    if (has_memory) {
        uint32_t clusters_count = 1;
        clusters[0] = (cluster){.end = take_wholes(scene, found, count)};
        find_split(found, &clusters[0], scratch);
        uint32_t next;
        while (clusters_count < most &&
               (next = next_to_split(clusters, clusters_count)) < clusters_count) {
            cluster *left = &clusters[next], *right = &clusters[clusters_count++];
            *right = (cluster){.begin = left->begin + left->split, .end = left->end};
            left->end = right->begin;
            find_split(found, left, scratch);
            find_split(found, right, scratch);
        }
        for (uint32_t i = 0; i < clusters_count; i++)
            out_targets[i] = target_of(found, &clusters[i]);
        *out_count = clusters_count;
    }
    ppmi_free(context, scratch);
    ppmi_free(context, clusters);
    return has_memory ? PPM_STATUS_OK
                      : ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: targets");
}
