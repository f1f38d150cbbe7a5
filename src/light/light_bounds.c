/* Bounds of each near light for the light tree: place over the whole shutter, directions, energy.
 */
#include "light/light_bounds.h"

#include "accel/round.h"

static const float half_turn = PPMI_PI;

static void grow(ppmi_light_bounds *bounds, ppmi_vec3 p)
{
    bounds->low = vec3(ppmi_min(bounds->low.x, p.x), ppmi_min(bounds->low.y, p.y),
                       ppmi_min(bounds->low.z, p.z));
    bounds->high = vec3(ppmi_max(bounds->high.x, p.x), ppmi_max(bounds->high.y, p.y),
                        ppmi_max(bounds->high.z, p.z));
}

/* By the transforms at all steps: between them places move on straight lines. */
static void grow_by_instance(ppmi_light_bounds *bounds, const ppmi_instance *instance, ppmi_vec3 p)
{
    grow(bounds, ppmi_transform_point(&instance->to_world, p));
    for (uint32_t i = 1; i < instance->motion_steps; i++)
        grow(bounds, ppmi_transform_point(&instance->motion[i], p));
}

static void grow_by_round(ppmi_light_bounds *bounds, const ppmi_instance *instance,
                          const ppmi_round *round)
{
    for (uint32_t i = 0; i < 16; i++) {
        const ppmi_vec3 sides =
            vec3(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f);
        const ppmi_vec3 end = i & 8 ? round->last : round->first;
        grow_by_instance(bounds, instance, vec3_mad(end, sides, round->radius));
    }
}

static void bound_element(const ppmi_instance *instance, const ppmi_primitive *primitive,
                          uint32_t element, ppmi_light_bounds *bounds)
{
    for (uint32_t step = 0; step < primitive->motion_steps; step++) {
        if (primitive->kind != PPM_PRIMITIVE_TRIANGLES) {
            const float last = (float)(primitive->motion_steps - 1);
            const float time = step > 0 ? (float)step / last : 0.0f;
            const ppmi_round round = ppmi_round_of(primitive, element, time);
            grow_by_round(bounds, instance, &round);
            continue;
        }
        const float *positions = primitive->positions + 3 * (size_t)step * primitive->vertex_count;
        for (uint32_t k = 0; k < 3; k++) {
            const size_t vertex = primitive->indices[3 * (size_t)element + k];
            grow_by_instance(bounds, instance, vec3_load(positions + 3 * vertex));
        }
    }
}

/* power: that of the tables. What moves or is round may face anywhere, and a round thing shows a
 * quarter of its area. */
static void bound_triangle(const ppmi_lights *lights, const ppmi_emitter *e, float power,
                           ppmi_light_bounds *bounds)
{
    const ppmi_instance *instance = &lights->scene->instances[e->instance];
    const ppmi_primitive *primitive =
        &lights->scene->meshes[instance->mesh].primitives[e->primitive];
    bound_element(instance, primitive, e->triangle, bounds);
    bounds->area = e->area;
    bounds->energy = power * PPMI_INV_PI / (float)e->sides;
    if (primitive->kind != PPM_PRIMITIVE_TRIANGLES) bounds->energy *= 0.25f;
    bounds->cone.theta_e = 0.5f * half_turn;
    if (e->has_own_area) {
        bounds->cone.theta_o = half_turn;
        return;
    }
    ppmi_surface surface;
    ppmi_emitter_surface(lights, e, 1.0f / 3, 1.0f / 3, 0.0f, &surface);
    bounds->cone.axis = surface.ng;
    bounds->cone.is_two_sided = e->sides == 2;
}

/* Where its profile shines is not told apart. */
static void bound_ball(const ppmi_lights *lights, const ppmi_punctual *light,
                       ppmi_light_bounds *bounds)
{
    grow(bounds, vec3_sub(light->position, vec3_splat(light->radius_m)));
    grow(bounds, vec3_add(light->position, vec3_splat(light->radius_m)));
    bounds->energy = vec3_mean(light->intensity);
    if (light->profile > 0) {
        bounds->energy *= lights->profiles[light->profile - 1].flux * (0.25f * PPMI_INV_PI);
    }
    if (light->kind == PPM_LIGHT_SPOT) {
        bounds->cone.theta_o = acosf(ppmi_clampf(light->cos_inner, -1.0f, 1.0f));
        bounds->cone.theta_e = ppmi_max(
            acosf(ppmi_clampf(light->cos_outer, -1.0f, 1.0f)) - bounds->cone.theta_o, 0.0f);
    } else {
        bounds->cone.theta_o = half_turn;
        bounds->cone.theta_e = 0.5f * half_turn;
    }
}

static void bound_punctual(const ppmi_lights *lights, const ppmi_punctual *light,
                           ppmi_light_bounds *bounds)
{
    bounds->cone.axis = light->direction;
    if (light->kind == PPM_LIGHT_POINT || light->kind == PPM_LIGHT_SPOT) {
        bound_ball(lights, light, bounds);
        return;
    }
    for (uint32_t i = 0; i < 4; i++) {
        const ppmi_vec3 side = vec3_mad(light->position, light->right,
                                        i & 1 ? light->half_width_m : -light->half_width_m);
        grow(bounds,
             vec3_mad(side, light->up, i & 2 ? light->half_height_m : -light->half_height_m));
    }
    bounds->area = ppmi_lamp_of(light, 0).area;
    bounds->energy = vec3_mean(light->intensity) * bounds->area;
    bounds->cone.theta_e = 0.5f * half_turn;
}

bool ppmi_light_bounds_of(const ppmi_lights *lights, uint32_t emitter, float power,
                          ppmi_light_bounds *out_bounds)
{
    const ppmi_emitter *e = &lights->emitters[emitter];
    *out_bounds = (ppmi_light_bounds){.low = vec3_splat(INFINITY),
                                      .high = vec3_splat(-INFINITY),
                                      .cone = {.axis = {0.0f, 0.0f, 1.0f}},
                                      .emitter = emitter};
    if (e->kind == PPMI_EMITTER_TRIANGLE) {
        bound_triangle(lights, e, power, out_bounds);
    } else {
        bound_punctual(lights, &lights->scene->punctuals[e->triangle], out_bounds);
    }
    return out_bounds->energy > 0.0f && isfinite(out_bounds->energy) &&
           vec3_is_finite(out_bounds->low) && vec3_is_finite(out_bounds->high) &&
           vec3_is_finite(out_bounds->cone.axis);
}
