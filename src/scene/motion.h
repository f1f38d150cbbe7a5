/* Where moving things are at a time within the shutter, 0 .. 1: interpolated as Embree does it,
 * linearly between the steps on both sides. */
#ifndef PPMI_SCENE_MOTION_H
#define PPMI_SCENE_MOTION_H

#include "scene/scene.h"

typedef struct ppmi_motion_place {
    uint32_t step; /* the step before, never the last one */
    float share;   /* of the step after, 0 .. 1 */
} ppmi_motion_place;

/* steps: at least 2. */
static inline ppmi_motion_place ppmi_motion_at(uint32_t steps, float time)
{
    const float place = ppmi_clampf(time, 0.0f, 1.0f) * (float)(steps - 1);
    const uint32_t step = (uint32_t)place, last = steps - 2;
    ppmi_motion_place result = {.step = step < last ? step : last};
    result.share = place - (float)result.step;
    return result;
}

/* A vertex's three floats in an array of blocks, one a step. */
static inline ppmi_vec3 ppmi_vertex_at(const ppmi_primitive *primitive, const float *values,
                                       uint32_t vertex, float time)
{
    if (primitive->motion_steps == 1) return vec3_load(values + 3 * (size_t)vertex);
    const ppmi_motion_place at = ppmi_motion_at(primitive->motion_steps, time);
    const float *block = values + 3 * ((size_t)at.step * primitive->vertex_count + vertex);
    return vec3_lerp(vec3_load(block), vec3_load(block + 3 * (size_t)primitive->vertex_count),
                     at.share);
}

static inline ppmi_vec3 ppmi_position_at(const ppmi_primitive *primitive, uint32_t vertex,
                                         float time)
{
    return ppmi_vertex_at(primitive, primitive->positions, vertex, time);
}

/* The transform of an instance. */
static inline ppmi_transform ppmi_instance_at(const ppmi_instance *instance, float time)
{
    if (!instance->motion) return instance->to_world;
    const ppmi_motion_place at = ppmi_motion_at(instance->motion_steps, time);
    return ppmi_transform_lerp(&instance->motion[at.step], &instance->motion[at.step + 1],
                               at.share);
}

/* The largest coordinate of the instance's origin at any step, for bounds of rounding. */
static inline float ppmi_instance_reach(const ppmi_instance *instance)
{
    float reach = vec3_max_abs(instance->to_world.origin);
    for (uint32_t i = 1; i < instance->motion_steps; i++)
        reach = ppmi_max(reach, vec3_max_abs(instance->motion[i].origin));
    return reach;
}

#endif
