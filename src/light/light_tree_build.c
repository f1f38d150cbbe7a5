/* Building the light tree: lights are parted where energy, extent and spread of directions of the
 * two halves are least together (the surface area orientation heuristic of Conty Estevez and Kulla
 * 2018, section 4.4, with the squared diagonal for the area, which lights in a row have not). */
#include "light/light_tree.h"

#include <stdlib.h>

enum { BUCKETS = 12, MAX_TURNS = 62 };

/* ---- bounds ---------------------------------------------------------------------------------- */

static const ppmi_light_cone every_direction = {
    .axis = {0.0f, 0.0f, 1.0f}, .theta_o = PPMI_PI, .theta_e = 0.5f * PPMI_PI};

static ppmi_vec3 turned(ppmi_vec3 v, ppmi_vec3 axis, float angle)
{
    const float cosine = cosf(angle), along = vec3_dot(axis, v) * (1.0f - cosine);
    const ppmi_vec3 across = vec3_mad(vec3_scale(v, cosine), vec3_cross(axis, v), sinf(angle));
    return vec3_normalize(vec3_mad(across, axis, along));
}

/* The least cone around two; theta_o of a is not below that of b. */
static void widen(const ppmi_light_cone *a, const ppmi_light_cone *b, ppmi_light_cone *out)
{
    const float rounding = 1e-3f; /* of angles by their cosines */
    const ppmi_vec3 normal = vec3_cross(a->axis, b->axis);
    const float apart = atan2f(vec3_length(normal), vec3_dot(a->axis, b->axis));
    if (ppmi_min(apart + b->theta_o, PPMI_PI) <= a->theta_o) {
        out->axis = a->axis;
        out->theta_o = a->theta_o;
        return;
    }
    out->theta_o = 0.5f * (a->theta_o + apart + b->theta_o) + rounding;
    if (out->theta_o >= PPMI_PI) {
        *out = every_direction;
        return;
    }
    out->axis = vec3_length2(normal) > 0.0f
                    ? turned(a->axis, vec3_normalize(normal), out->theta_o - a->theta_o)
                    : a->axis;
    if (!(vec3_length2(normal) > 0.0f) && apart > 0.0f) *out = every_direction;
}

static ppmi_light_cone united_cone(const ppmi_light_cone *a, const ppmi_light_cone *b)
{
    ppmi_light_cone cone = every_direction;
    if (a->theta_o >= b->theta_o) {
        widen(a, b, &cone);
    } else {
        widen(b, a, &cone);
    }
    cone.theta_e = ppmi_max(a->theta_e, b->theta_e);
    cone.is_two_sided = a->is_two_sided || b->is_two_sided;
    return cone;
}

static ppmi_light_bounds united(const ppmi_light_bounds *a, const ppmi_light_bounds *b)
{
    if (!(a->energy > 0.0f)) return *b;
    if (!(b->energy > 0.0f)) return *a;
    return (ppmi_light_bounds){
        .low = vec3(ppmi_min(a->low.x, b->low.x), ppmi_min(a->low.y, b->low.y),
                    ppmi_min(a->low.z, b->low.z)),
        .high = vec3(ppmi_max(a->high.x, b->high.x), ppmi_max(a->high.y, b->high.y),
                     ppmi_max(a->high.z, b->high.z)),
        .cone = united_cone(&a->cone, &b->cone),
        .energy = a->energy + b->energy,
        .area = a->area + b->area,
    };
}

/* Solid angle that the lights shine into, weighed by the cosine beyond theta_o. */
static float spread(const ppmi_light_cone *cone)
{
    const float o = cone->theta_o, end = ppmi_min(o + cone->theta_e, PPMI_PI);
    const float cos_o = cosf(o), sin_o = sinf(o);
    const float beyond = 2.0f * end * sin_o - cosf(o - 2.0f * end) - 2.0f * o * sin_o + cos_o;
    const float all = 2.0f * PPMI_PI * (1.0f - cos_o) + 0.5f * PPMI_PI * beyond;
    return cone->is_two_sided ? 2.0f * all : all;
}

static float cost(const ppmi_light_bounds *bounds)
{
    if (!(bounds->energy > 0.0f)) return 0.0f;
    return bounds->energy * spread(&bounds->cone) *
           vec3_length2(vec3_sub(bounds->high, bounds->low));
}

static ppmi_light_node node_of(const ppmi_light_bounds *bounds)
{
    /* enlarged by what rounding moves a point of the ball by */
    const float margin = 1.0f + 1e-5f;
    const ppmi_vec3 half = vec3_scale(vec3_sub(bounds->high, bounds->low), 0.5f);
    const float theta_o = ppmi_min(bounds->cone.theta_o, PPMI_PI);
    return (ppmi_light_node){
        .center = vec3_add(bounds->low, half),
        .radius2 = vec3_length2(half) * margin,
        .axis = bounds->cone.axis,
        .cos_o = theta_o >= PPMI_PI ? -1.0f : cosf(theta_o),
        .sin_o = theta_o >= PPMI_PI ? 0.0f : sinf(theta_o),
        .cos_e = cosf(ppmi_min(bounds->cone.theta_e, PPMI_PI)),
        .energy = bounds->energy,
        .area = bounds->area,
        .is_two_sided = bounds->cone.is_two_sided,
    };
}

/* ---- parting --------------------------------------------------------------------------------- */

static float component(ppmi_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static float middle(const ppmi_light_bounds *light, int axis)
{
    return 0.5f * component(light->low, axis) + 0.5f * component(light->high, axis);
}

/* An axis cut into buckets by the lights' middles. */
typedef struct tree_cut {
    int axis;
    float low, scale; /* bucket = (middle - low) * scale */
    uint32_t last;    /* bucket of the first half */
    float cost;
} tree_cut;

static uint32_t bucket_of(const tree_cut *cut, const ppmi_light_bounds *light)
{
    const float at = (middle(light, cut->axis) - cut->low) * cut->scale;
    return at < (float)(BUCKETS - 1) ? (uint32_t)ppmi_max(at, 0.0f) : BUCKETS - 1;
}

/* Sets the best place of cut->axis; its cost stays INFINITY where all lights are at one place. */
static void find_place(const ppmi_light_bounds *lights, uint32_t count, tree_cut *cut)
{
    float high = -INFINITY;
    cut->low = INFINITY;
    cut->cost = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        cut->low = ppmi_min(cut->low, middle(&lights[i], cut->axis));
        high = ppmi_max(high, middle(&lights[i], cut->axis));
    }
    cut->scale = (float)BUCKETS / (high - cut->low);
    if (!(high > cut->low) || !isfinite(cut->scale)) return;
    ppmi_light_bounds buckets[BUCKETS] = {0}, ends[BUCKETS] = {0};
    for (uint32_t i = 0; i < count; i++) {
        ppmi_light_bounds *bucket = &buckets[bucket_of(cut, &lights[i])];
        *bucket = united(bucket, &lights[i]);
    }
    for (uint32_t i = BUCKETS - 1; i > 0; i--)
        ends[i - 1] = united(&ends[i], &buckets[i]);
    ppmi_light_bounds start = {0};
    for (uint32_t i = 0; i + 1 < BUCKETS; i++) {
        start = united(&start, &buckets[i]);
        const float sum = cost(&start) + cost(&ends[i]);
        if (!(start.energy > 0.0f) || !(ends[i].energy > 0.0f) || !(sum < cut->cost)) continue;
        cut->last = i;
        cut->cost = sum;
    }
}

/* Moves those of the first half to the front; returns their number. */
static uint32_t part(ppmi_light_bounds *lights, uint32_t count, const tree_cut *cut)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (bucket_of(cut, &lights[i]) > cut->last) continue;
        const ppmi_light_bounds light = lights[i];
        lights[i] = lights[first];
        lights[first++] = light;
    }
    return first;
}

static uint32_t turns_of_halving(uint32_t count)
{
    uint32_t turns = 0;
    while (((uint64_t)1 << turns) < count)
        turns++;
    return turns;
}

static uint32_t split(ppmi_light_bounds *lights, uint32_t count, uint32_t depth,
                      const ppmi_light_bounds *all)
{
    tree_cut best = {.cost = INFINITY};
    const ppmi_vec3 extent = vec3_sub(all->high, all->low);
    const float longest = vec3_max_component(extent);
    for (int axis = 0; axis < 3 && depth + turns_of_halving(count) < MAX_TURNS; axis++) {
        tree_cut cut = {.axis = axis};
        find_place(lights, count, &cut);
        cut.cost *= longest / component(extent, axis); /* thin boxes are bad ones */
        if (cut.cost < best.cost) best = cut;
    }
    const uint32_t first = isfinite(best.cost) ? part(lights, count, &best) : 0;
    return first > 0 && first < count ? first : count / 2;
}

/* ---- the tree -------------------------------------------------------------------------------- */

/* Returns the bounds of the lights below the node that is added. */
static ppmi_light_bounds add_nodes(ppmi_light_tree *tree, ppmi_light_bounds *lights, uint32_t count,
                                   uint64_t trail, uint32_t depth)
{
    const uint32_t index = tree->node_count++;
    if (count == 1) {
        tree->nodes[index] = node_of(&lights[0]);
        tree->nodes[index].is_leaf = true;
        tree->nodes[index].next = lights[0].emitter;
        tree->trails[lights[0].emitter] = trail;
        return lights[0];
    }
    ppmi_light_bounds all = lights[0];
    for (uint32_t i = 1; i < count; i++) {
        all.low = vec3(ppmi_min(all.low.x, lights[i].low.x), ppmi_min(all.low.y, lights[i].low.y),
                       ppmi_min(all.low.z, lights[i].low.z));
        all.high =
            vec3(ppmi_max(all.high.x, lights[i].high.x), ppmi_max(all.high.y, lights[i].high.y),
                 ppmi_max(all.high.z, lights[i].high.z));
    }
    const uint32_t first = split(lights, count, depth, &all);
    const ppmi_light_bounds a = add_nodes(tree, lights, first, trail, depth + 1);
    const uint32_t second = tree->node_count;
    const ppmi_light_bounds b =
        add_nodes(tree, lights + first, count - first, trail | (uint64_t)1 << depth, depth + 1);
    all = united(&a, &b);
    tree->nodes[index] = node_of(&all);
    tree->nodes[index].next = second;
    return all;
}

ppm_status ppmi_light_tree_init(ppm_context *context, ppmi_light_tree *tree,
                                ppmi_light_bounds *lights, uint32_t count, uint32_t emitter_count)
{
    *tree = (ppmi_light_tree){.emitter_count = emitter_count};
    if (count == 0) return PPM_STATUS_OK;
    tree->nodes = ppmi_alloc(context, 2 * (uint64_t)count, sizeof *tree->nodes);
    tree->trails = ppmi_alloc(context, emitter_count, sizeof *tree->trails);
    if (!tree->nodes || !tree->trails) {
        ppmi_light_tree_deinit(context, tree);
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %u lights", count);
    }
    for (uint32_t i = 0; i < emitter_count; i++)
        tree->trails[i] = PPMI_NO_TRAIL;
    add_nodes(tree, lights, count, 0, 0);
    return PPM_STATUS_OK;
}

void ppmi_light_tree_deinit(ppm_context *context, ppmi_light_tree *tree)
{
    ppmi_free(context, tree->nodes);
    ppmi_free(context, tree->trails);
    *tree = (ppmi_light_tree){0};
}
