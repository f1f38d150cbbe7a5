/* Photon emission: every light sends photons in proportion to its power, far ones towards the scene
 * only. */
#include "light/tables.h"
#include "math/sampling.h"

static bool emit_triangle(const ppmi_lights *lights, const ppmi_emitter *e, float time,
                          const float u[4], ppmi_emission *emission)
{
    ppmi_surface surface;
    const float pdf = ppmi_emitter_sample(lights, e, u[0], u[1], time, &surface);
    if (!(pdf > 0.0f)) return false;
    float side = 1.0f, u_direction = u[2];
    if (e->sides == 2) {
        side = u_direction < 0.5f ? 1.0f : -1.0f;
        u_direction = u_direction < 0.5f ? 2.0f * u_direction : 2.0f * u_direction - 1.0f;
    }
    const ppmi_vec3 n = vec3_scale(surface.ng, side);
    const ppmi_frame frame = ppmi_frame_from_normal(n);
    const ppmi_vec3 direction = vec3_normalize(
        ppmi_frame_to_world(&frame, ppmi_sample_cosine_hemisphere(u_direction, u[3])));
    emission->ray = ppmi_surface_ray(&surface, direction);
    const ppmi_vec3 radiance = ppmi_emitter_radiance(lights, &surface, direction);
    emission->power = vec3_scale(radiance, PPMI_PI * (float)e->sides / pdf);
    const float opacity = ppmi_surface_opacity(lights->scene, &surface);
    emission->crowding = ppmi_lights_crowding(lights, vec3_scale(radiance, 1.0f / opacity));
    return true;
}

/* A photon of a point or spot along direction: from its middle, or its ball's surface. */
static void leave(const ppmi_punctual *light, ppmi_vec3 direction, const float u[4],
                  ppmi_emission *emission)
{
    emission->ray =
        (ppmi_ray){.origin = light->position, .t_max = INFINITY, .direction = direction};
    if (light->radius_m > 0.0f) {
        emission->ray.origin = ppmi_lamp_ball_origin(light, direction, u[0], u[1]);
    }
}

/* By the profile, in all directions: what it sends past the scene is its own. */
static bool emit_profile(const ppmi_lights *lights, const ppmi_punctual *light, const float u[4],
                         ppmi_emission *emission)
{
    ppmi_vec3 local;
    const float pdf =
        ppmi_profile_table_sample(&lights->profiles[light->profile - 1], u[2], u[3], &local);
    const ppmi_vec3 across = vec3_mad(vec3_scale(light->right, local.x), light->up, local.y);
    const ppmi_vec3 direction = vec3_normalize(vec3_mad(across, light->direction, -local.z));
    if (!(pdf > 0.0f)) return false;
    leave(light, direction, u, emission);
    emission->power =
        vec3_scale(ppmi_punctual_intensity(lights->scene, light, direction), 1.0f / pdf);
    return true;
}

static bool emit_point(const ppmi_lights *lights, const ppmi_punctual *light, const float u[4],
                       ppmi_emission *emission)
{
    if (light->profile > 0) return emit_profile(lights, light, u, emission);
    const float cos_max = ppmi_light_extent_cone(&lights->extent, light->position, light->radius_m);
    const ppmi_vec3 local = ppmi_sample_cone(cos_max, u[2], u[3]);
    const ppmi_vec3 axis = cos_max > -1.0f
                               ? vec3_normalize(vec3_sub(lights->extent.center, light->position))
                               : vec3(0.0f, 0.0f, 1.0f);
    const ppmi_frame frame = ppmi_frame_from_normal(axis);
    leave(light, vec3_normalize(ppmi_frame_to_world(&frame, local)), u, emission);
    emission->power = vec3_scale(light->intensity, 2.0f * PPMI_PI * (1.0f - cos_max));
    return true;
}

/* The falloff is sampled exactly: its integral between the cones grows as the cube of the ramp. */
static bool emit_spot(const ppmi_lights *lights, const ppmi_punctual *light, const float u[4],
                      ppmi_emission *emission)
{
    const float ramp = (light->cos_inner - light->cos_outer) / 3.0f;
    const float flat = 1.0f - light->cos_inner;
    const float x = u[2] * (ramp + flat);
    float cosine;
    if (x < ramp) {
        cosine = light->cos_outer + (light->cos_inner - light->cos_outer) * cbrtf(x / ramp);
    } else {
        cosine = light->cos_inner + (x - ramp);
    }
    const ppmi_frame frame = ppmi_frame_from_normal(light->direction);
    const ppmi_vec3 local = ppmi_direction_at(ppmi_min(cosine, 1.0f), u[3]);
    const ppmi_vec3 direction = vec3_normalize(ppmi_frame_to_world(&frame, local));
    leave(light, direction, u, emission);
    const float factor = ppmi_punctual_profile(lights->scene, light, direction);
    emission->power = vec3_scale(light->intensity, factor * ppmi_spot_solid_angle(light));
    return true;
}

static bool emit_punctual(const ppmi_lights *lights, const ppmi_punctual *light, const float u[4],
                          ppmi_emission *emission)
{
    if (light->kind == PPM_LIGHT_POINT) return emit_point(lights, light, u, emission);
    if (light->kind == PPM_LIGHT_SPOT) return emit_spot(lights, light, u, emission);
    emission->ray = ppmi_light_extent_ray(&lights->extent, light->direction, u[0], u[1]);
    emission->power =
        vec3_scale(light->intensity, ppmi_light_extent_shadow(&lights->extent, light->direction));
    return true;
}

static bool emit_lamp(const ppmi_lights *lights, const ppmi_lamp *lamp, const float u[4],
                      ppmi_emission *emission)
{
    if (lamp->shape == PPMI_LAMP_BALL) {
        if (!emit_punctual(lights, lamp->light, u, emission)) return false;
    } else {
        emission->ray = ppmi_lamp_flat_ray(lamp, u);
        emission->power = vec3_scale(lamp->light->intensity, PPMI_PI * lamp->area);
    }
    const ppmi_vec3 radiance = ppmi_lamp_radiance(lights->scene, lamp, emission->ray.direction);
    emission->crowding = ppmi_lights_crowding(lights, radiance);
    return true;
}

/* Parallel light from one point of the sky, which was drawn with density pdf. */
static void emit_far(const ppmi_lights *lights, ppmi_vec3 towards, ppmi_vec3 radiance, float pdf,
                     const float u[4], ppmi_emission *emission)
{
    const ppmi_vec3 direction = vec3_neg(towards);
    emission->ray = ppmi_light_extent_ray(&lights->extent, direction, u[0], u[1]);
    emission->power =
        vec3_scale(radiance, ppmi_light_extent_shadow(&lights->extent, direction) / pdf);
    emission->crowding = ppmi_lights_crowding(lights, ppmi_lights_environment(lights, towards));
}

static void emit_sun(const ppmi_lights *lights, const ppmi_sun *sun, const float u[4],
                     ppmi_emission *emission)
{
    const ppmi_vec3 towards = ppmi_sun_sample(sun, u[2], u[3]);
    emit_far(lights, towards, sun->radiance, 1.0f / sun->solid_angle, u, emission);
}

static bool emit_environment(const ppmi_lights *lights, double u_cell, const float u[4],
                             ppmi_emission *emission)
{
    ppmi_vec3 towards;
    const float pdf =
        ppmi_environment_map_sample(&lights->environment, u_cell, u[2], u[3], &towards);
    if (!(pdf > 0.0f)) return false;
    emit_far(lights, towards, ppmi_environment_map_radiance(&lights->environment, towards), pdf, u,
             emission);
    return true;
}

float ppmi_lights_crowding(const ppmi_lights *lights, ppmi_vec3 radiance)
{
    return lights->power > 0.0f ? vec3_max_component(radiance) / lights->power : 0.0f;
}

bool ppmi_lights_emit_of(const ppmi_lights *lights, uint32_t emitter, float time, double u_cell,
                         const float u[4], ppmi_emission *out_emission)
{
    const ppmi_emitter *e = &lights->emitters[emitter];
    bool emitted = true;
    out_emission->crowding = INFINITY;
    if (e->kind == PPMI_EMITTER_TRIANGLE) {
        emitted = emit_triangle(lights, e, time, u, out_emission);
    } else if (e->kind == PPMI_EMITTER_PUNCTUAL) {
        emitted = emit_punctual(lights, &lights->scene->punctuals[e->triangle], u, out_emission);
    } else if (e->kind == PPMI_EMITTER_LAMP) {
        emitted = emit_lamp(lights, &lights->lamps[e->primitive], u, out_emission);
    } else if (e->kind == PPMI_EMITTER_SUN) {
        emit_sun(lights, &lights->suns[e->primitive], u, out_emission);
    } else {
        emitted = emit_environment(lights, u_cell, u, out_emission);
    }
    out_emission->ray.time = time;
    out_emission->emitter = emitter;
    out_emission->is_far = emitter >= lights->near_count;
    return emitted;
}

bool ppmi_lights_emit_at(const ppmi_lights *lights, float time, double u_pick, const float u[4],
                         ppmi_emission *out_emission)
{
    if (lights->count == 0) return false;
    double rest;
    const uint32_t i = ppmi_alias_sample(&lights->by_power, u_pick, &rest);
    const float probability = ppmi_alias_probability(&lights->by_power, i);
    if (!ppmi_lights_emit_of(lights, i, time, rest, u, out_emission) || !(probability > 0.0f)) {
        return false;
    }
    out_emission->power = vec3_scale(out_emission->power, 1.0f / probability);
    return !vec3_is_black(out_emission->power);
}
