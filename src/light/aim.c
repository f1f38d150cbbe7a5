/* Choice of part, light, place and direction. */
#include "light/aim_tables.h"

/* ---- tables ---------------------------------------------------------------------------------- */

static bool fill_sky(ppmi_aim *aim)
{
    const ppmi_environment_map *map = &aim->lights->environment;
    if (!aim->lights->has_environment || ppmi_environment_map_is_constant(map)) return true;
    aim->sky_rows = ppmi_alloc(aim->context, map->rows + 1u, sizeof *aim->sky_rows);
    aim->sky_columns =
        ppmi_alloc(aim->context, (size_t)map->rows * (map->columns + 1), sizeof *aim->sky_columns);
    if (!aim->sky_rows || !aim->sky_columns) return false;
    double total = 0.0;
    for (uint32_t row = 0; row < map->rows; row++) {
        double *columns = aim->sky_columns + (size_t)row * (map->columns + 1);
        double sum = 0.0;
        for (uint32_t i = 0; i < map->columns; i++) {
            columns[i] = sum;
            sum += (double)ppmi_alias_probability(&map->cells, row * map->columns + i);
        }
        columns[map->columns] = sum;
        aim->sky_rows[row] = total;
        total += sum;
    }
    aim->sky_rows[map->rows] = total;
    return true;
}

/* The solid angle of a cone that a light fills at its greatest intensity with all its power. */
static double own_solid_angle(const ppmi_lights *lights, const ppmi_punctual *light)
{
    double angle = 2.0 * (double)PPMI_PI;
    if (light->kind == PPM_LIGHT_SPOT) {
        angle = fmin(angle, (double)ppmi_spot_solid_angle(light));
    }
    if (light->profile == 0) return angle;
    const ppmi_alias *cells = &lights->profiles[light->profile - 1].cells;
    float peak = 0.0f;
    for (uint32_t i = 0; i < cells->count; i++)
        peak = ppmi_max(peak, ppmi_alias_probability(cells, i));
    return fmin(angle, 4.0 * (double)PPMI_PI / ((double)peak * cells->count));
}

static bool fill_solid_angles(ppmi_aim *aim)
{
    const ppm_scene *scene = aim->lights->scene;
    aim->solid_angles =
        ppmi_alloc(aim->context, scene->punctual_count + 1u, sizeof *aim->solid_angles);
    if (!aim->solid_angles) return false;
    for (uint32_t i = 0; i < scene->punctual_count; i++)
        aim->solid_angles[i] = own_solid_angle(aim->lights, &scene->punctuals[i]);
    return true;
}

ppm_status ppmi_aim_create(ppm_context *context, const ppmi_lights *lights,
                           const ppmi_target *targets, const double *shares, uint32_t count,
                           ppmi_aim **out_aim)
{
    ppmi_aim *aim = ppmi_alloc_zeroed(context, 1, sizeof *aim);
    if (!aim) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: aim");
    *aim = (ppmi_aim){.context = context, .lights = lights, .target_count = count};
    for (uint32_t i = 0; i < count; i++)
        aim->targets[i] = targets[i];
    for (uint32_t i = 0; i <= count; i++)
        aim->parts[i + 1] = aim->parts[i] + shares[i];
    aim->parts[count + 1] = 1.0;
    if (lights->count > 0 &&
        (!ppmi_aim_fill_groups(aim) || !fill_sky(aim) || !fill_solid_angles(aim))) {
        ppmi_aim_destroy(aim);
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: aim");
    }
    *out_aim = aim;
    return PPM_STATUS_OK;
}

void ppmi_aim_destroy(ppmi_aim *aim)
{
    if (!aim) return;
    ppmi_free(aim->context, aim->group_first);
    ppmi_free(aim->context, aim->groups);
    ppmi_free(aim->context, aim->powers);
    ppmi_free(aim->context, aim->sky_rows);
    ppmi_free(aim->context, aim->sky_columns);
    ppmi_free(aim->context, aim->solid_angles);
    ppmi_free(aim->context, aim);
}

/* The entry of sums (count + 1) that holds u, which becomes what is left of it, in [0, 1).
 * Multiplies *probability by the entry's share of all. */
static uint32_t choose(const double *sums, uint32_t count, double *u, double *probability)
{
    const double first = sums[0], whole = sums[count] - first;
    const double at = first + *u * whole;
    uint32_t low = 0, high = count;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if (sums[middle] <= at) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const double width = sums[low + 1] - sums[low];
    *probability *= width / whole;
    const double rest = (at - sums[low]) / width;
    *u = rest >= 0.0 && rest < 1.0 ? rest : 0.5;
    return low;
}

/* ---- directions and places ------------------------------------------------------------------- */

/* A far light's direction towards it; *out_weight is radiance over density, or of light without a
 * size irradiance. */
static ppmi_vec3 far_direction(const ppmi_aim *aim, const ppmi_emitter *e, const float u[4],
                               ppmi_vec3 *out_weight)
{
    const ppmi_lights *lights = aim->lights;
    if (e->kind == PPMI_EMITTER_PUNCTUAL) {
        const ppmi_punctual *light = &lights->scene->punctuals[e->triangle];
        *out_weight = light->intensity;
        return vec3_neg(light->direction);
    }
    if (e->kind == PPMI_EMITTER_SUN) {
        const ppmi_sun *sun = &lights->suns[e->primitive];
        *out_weight = vec3_scale(sun->radiance, sun->solid_angle);
        return ppmi_sun_sample(sun, u[2], u[3]);
    }
    const ppmi_environment_map *map = &lights->environment;
    ppmi_vec3 towards;
    float pdf;
    if (aim->sky_rows) {
        double x = (double)u[2], y = (double)u[3], unused = 1.0;
        const uint32_t row = choose(aim->sky_rows, map->rows, &y, &unused);
        const uint32_t column =
            choose(aim->sky_columns + (size_t)row * (map->columns + 1), map->columns, &x, &unused);
        pdf = ppmi_environment_map_sample_cell(map, row * map->columns + column, (float)x, (float)y,
                                               &towards);
    } else {
        pdf = ppmi_environment_map_sample(map, 0.0, u[2], u[3], &towards);
    }
    *out_weight = pdf > 0.0f ? vec3_scale(ppmi_environment_map_radiance(map, towards), 1.0f / pdf)
                             : vec3_splat(0.0f);
    return towards;
}

/* Parallel light: over the target's shadow or the extent's, whichever is smaller. */
static bool emit_far(const ppmi_aim *aim, const ppmi_target *target, const ppmi_emitter *e,
                     const float u[4], ppmi_emission *emission)
{
    const ppmi_light_extent *extent = &aim->lights->extent;
    ppmi_vec3 weight;
    const ppmi_vec3 direction = vec3_neg(far_direction(aim, e, u, &weight));
    if (vec3_is_black(weight)) return false;
    float shadow = ppmi_light_extent_shadow(extent, direction);
    const float of_target = target ? (float)ppmi_target_shadow(target, direction) : INFINITY;
    if (of_target < shadow) {
        shadow = of_target;
        if (!ppmi_target_far_ray(target, extent, direction, u[0], u[1], &emission->ray)) {
            return false;
        }
    } else {
        emission->ray = ppmi_light_extent_ray(extent, direction, u[0], u[1]);
    }
    emission->power = vec3_scale(weight, shadow);
    if (e->kind != PPMI_EMITTER_PUNCTUAL) {
        emission->crowding = ppmi_lights_crowding(
            aim->lights, ppmi_lights_environment(aim->lights, vec3_neg(direction)));
    }
    return true;
}

/* From a place of a shining surface, that stands for an area. */
static bool emit_triangle(const ppmi_aim *aim, const ppmi_target *target, const ppmi_emitter *e,
                          const ppmi_surface *surface, float area, const ppmi_target_cone *cone,
                          const float u[4], ppmi_emission *emission)
{
    float inverse_pdf;
    const ppmi_vec3 direction = ppmi_target_cone_sample(target, cone, u[2], u[3], &inverse_pdf);
    const float cosine = vec3_dot(surface->ng, direction);
    if (!(cosine > 0.0f) && e->sides != 2) return false;
    emission->ray = ppmi_surface_ray(surface, direction);
    const ppmi_vec3 radiance = ppmi_emitter_radiance(aim->lights, surface, direction);
    emission->power = vec3_scale(radiance, fabsf(cosine) * area * inverse_pdf);
    const float opacity = ppmi_surface_opacity(aim->lights->scene, surface);
    emission->crowding = ppmi_lights_crowding(aim->lights, vec3_scale(radiance, 1.0f / opacity));
    return true;
}

static bool emit_flat(const ppmi_target *target, const ppmi_lamp *lamp, ppmi_vec3 origin,
                      const ppmi_target_cone *cone, const float u[4], ppmi_emission *emission)
{
    float inverse_pdf;
    const ppmi_vec3 direction = ppmi_target_cone_sample(target, cone, u[2], u[3], &inverse_pdf);
    const float cosine = vec3_dot(lamp->light->direction, direction);
    if (!(cosine > 0.0f)) return false;
    emission->ray = (ppmi_ray){.origin = origin, .t_max = INFINITY, .direction = direction};
    emission->power = vec3_scale(lamp->light->intensity, cosine * lamp->area * inverse_pdf);
    return true;
}

/* A photon of a ball is that of its middle, moved sideways within the outline: of a large ball over
 * the part before the target only. Returns the share of the outline. */
static float leave_ball(const ppmi_target *target, const ppmi_punctual *light, const float u[4],
                        ppmi_ray *ray)
{
    const float reach = vec3_max_component(target->half) / light->radius_m;
    if (!(reach < 1.0f)) {
        ray->origin = ppmi_lamp_ball_origin(light, ray->direction, u[0], u[1]);
        return 1.0f;
    }
    const ppmi_frame frame = ppmi_frame_from_normal(ray->direction);
    const ppmi_vec3 way =
        vec3_scale(vec3_sub(target->center, light->position), 1.0f / light->radius_m);
    const ppmi_vec2 disk = ppmi_sample_disk(u[0], u[1]);
    const ppmi_vec2 at = {vec3_dot(way, frame.s) + reach * disk.x,
                          vec3_dot(way, frame.t) + reach * disk.y};
    if (at.x * at.x + at.y * at.y > 1.0f) return 0.0f;
    ray->origin = ppmi_lamp_ball_origin_at(light, &frame, at);
    return reach * reach;
}

/* From a point or a ball. */
static bool emit_point(const ppmi_aim *aim, const ppmi_target *target, const ppmi_target *wide,
                       const ppmi_punctual *light, const ppmi_target_cone *cone, const float u[4],
                       ppmi_emission *emission)
{
    float inverse_pdf;
    const ppmi_vec3 direction = ppmi_target_cone_sample(wide, cone, u[2], u[3], &inverse_pdf);
    emission->ray =
        (ppmi_ray){.origin = light->position, .t_max = INFINITY, .direction = direction};
    if (light->radius_m > 0.0f) inverse_pdf *= leave_ball(target, light, u, &emission->ray);
    const ppmi_vec3 intensity = ppmi_punctual_intensity(aim->lights->scene, light, direction);
    emission->power = vec3_scale(intensity, inverse_pdf);
    if (light->radius_m > 0.0f) {
        const float outline = PPMI_PI * ppmi_sqr(light->radius_m);
        emission->crowding =
            ppmi_lights_crowding(aim->lights, vec3_scale(intensity, 1.0f / outline));
    }
    return inverse_pdf > 0.0f;
}

/* ---- towards a target ------------------------------------------------------------------------ */

/* A cone pays where it is narrower than what the light sends out by itself. */
static bool is_narrower(const ppmi_target_cone *cone, double solid_angle)
{
    return cone->solid_angle < solid_angle;
}

/* Holds all that is within margin of the target. (By support functions: (a + b)^2 is at most
 * (1 + t) a^2 + (1 + 1/t) b^2, and equal where t is b/a.) */
static ppmi_target grown(const ppmi_target *target, float margin)
{
    if (!(margin > 0.0f)) return *target;
    const ppmi_vec3 h = target->half;
    const float t = margin / vec3_max_component(h);
    const float more = (1.0f + 1.0f / t) * margin * margin;
    return (ppmi_target){target->center, vec3(sqrtf((1.0f + t) * h.x * h.x + more),
                                              sqrtf((1.0f + t) * h.y * h.y + more),
                                              sqrtf((1.0f + t) * h.z * h.z + more))};
}

/* The ways that a near light has: towards the target, or as without one. */
static bool emit_near(const ppmi_aim *aim, const ppmi_target *target, uint32_t emitter, float time,
                      const float u[4], ppmi_emission *emission)
{
    const ppmi_lights *lights = aim->lights;
    const ppmi_emitter *e = &lights->emitters[emitter];
    const double half_space = (double)PPMI_PI;
    if (e->kind == PPMI_EMITTER_TRIANGLE) {
        ppmi_surface surface;
        const float pdf = ppmi_emitter_sample(lights, e, u[0], u[1], time, &surface);
        if (!(pdf > 0.0f)) return false;
        const ppmi_target_cone cone = ppmi_target_cone_from(target, surface.position);
        if (is_narrower(&cone, half_space)) {
            return emit_triangle(aim, target, e, &surface, 1.0f / pdf, &cone, u, emission);
        }
    } else if (e->kind == PPMI_EMITTER_LAMP &&
               lights->lamps[e->primitive].shape != PPMI_LAMP_BALL) {
        const ppmi_lamp *lamp = &lights->lamps[e->primitive];
        const ppmi_vec3 origin = ppmi_lamp_flat_origin(lamp, u[0], u[1]);
        const ppmi_target_cone cone = ppmi_target_cone_from(target, origin);
        if (is_narrower(&cone, half_space)) {
            emission->crowding = ppmi_lights_crowding(lights, lamp->light->intensity);
            return emit_flat(target, lamp, origin, &cone, u, emission);
        }
    } else {
        const ppmi_punctual *light = &lights->scene->punctuals[e->triangle];
        const ppmi_target wide = grown(target, light->radius_m);
        const ppmi_target_cone cone = ppmi_target_cone_from(&wide, light->position);
        if (is_narrower(&cone, aim->solid_angles[light - lights->scene->punctuals])) {
            return emit_point(aim, target, &wide, light, &cone, u, emission);
        }
    }
    return ppmi_lights_emit_of(lights, emitter, time, 0.0, u, emission);
}

/* Whether the ray belongs to a part: to none before. */
static bool is_of_part(const ppmi_aim *aim, const ppmi_ray *ray, uint32_t part)
{
    for (uint32_t k = 0; k < part; k++) {
        if (ppmi_target_is_met(&aim->targets[k], ray->origin, ray->direction)) return false;
    }
    return part == aim->target_count ||
           ppmi_target_is_met(&aim->targets[part], ray->origin, ray->direction);
}

/* A part and an emitter, with the probability of both. */
typedef struct choice {
    uint32_t part, emitter;
    double probability;
} choice;

static choice choose_emitter(const ppmi_aim *aim, double pick)
{
    choice c = {.probability = 1.0};
    c.part = choose(aim->parts, aim->target_count + 1, &pick, &c.probability);
    const double *groups = aim->groups + (size_t)c.part * (aim->group_count + 1);
    const uint32_t group = choose(groups, aim->group_count, &pick, &c.probability);
    const uint32_t first = aim->group_first[group], end = aim->group_first[group + 1];
    c.emitter = first + choose(aim->powers + first, end - first, &pick, &c.probability);
    return c;
}

uint32_t ppmi_aim_emitter(const ppmi_aim *aim, double pick)
{
    return choose_emitter(aim, pick).emitter;
}

bool ppmi_aim_emit(const ppmi_aim *aim, float time, double pick, const float u[4],
                   ppmi_emission *out_emission)
{
    const ppmi_lights *lights = aim->lights;
    if (lights->count == 0) return false;
    const choice c = choose_emitter(aim, pick);
    if (!(c.probability > 0.0)) return false;
    const ppmi_target *target = c.part < aim->target_count ? &aim->targets[c.part] : NULL;
    bool emitted;
    out_emission->crowding = INFINITY;
    if (c.emitter >= lights->near_count) {
        emitted = emit_far(aim, target, &lights->emitters[c.emitter], u, out_emission);
    } else if (target) {
        emitted = emit_near(aim, target, c.emitter, time, u, out_emission);
    } else {
        emitted = ppmi_lights_emit_of(lights, c.emitter, time, 0.0, u, out_emission);
    }
    if (!emitted || !is_of_part(aim, &out_emission->ray, c.part)) return false;
    out_emission->ray.time = time;
    out_emission->emitter = c.emitter;
    out_emission->is_far = c.emitter >= lights->near_count;
    out_emission->power = vec3_scale(out_emission->power, (float)(1.0 / c.probability));
    return !vec3_is_black(out_emission->power);
}
