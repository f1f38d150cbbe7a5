/* Light sampling: what arrives at a point from one light that is drawn, and how likely it was to be
 * drawn. */
#include "accel/round.h"
#include "light/light_choice.h"
#include "math/sampling.h"

/* A point in a medium has no normal: light counts from every side. */
static bool is_surface(ppmi_vec3 n)
{
    return vec3_length2(n) > 0.0f;
}

/* ---- near lights ----------------------------------------------------------------------------- */

static bool sample_punctual(const ppm_scene *scene, const ppmi_punctual *light, ppmi_vec3 position,
                            ppmi_light_sample *sample)
{
    sample->is_delta = true;
    const ppmi_vec3 to_light = vec3_sub(light->position, position);
    const float distance2 = vec3_length2(to_light);
    if (!(distance2 > 0.0f)) return false;
    sample->target = light->position;
    sample->wi = vec3_normalize(to_light);
    const ppmi_vec3 intensity = ppmi_punctual_intensity(scene, light, vec3_neg(sample->wi));
    sample->radiance = vec3_scale(intensity, 1.0f / distance2);
    return !vec3_is_black(sample->radiance);
}

static bool sample_lamp(const ppm_scene *scene, const ppmi_lamp *lamp, ppmi_vec3 position, float u,
                        float v, ppmi_light_sample *sample)
{
    sample->pdf *= ppmi_lamp_sample(lamp, position, u, v, &sample->wi, &sample->target);
    if (!(sample->pdf > 0.0f)) return false;
    sample->radiance = ppmi_lamp_radiance(scene, lamp, vec3_neg(sample->wi));
    return !vec3_is_black(sample->radiance);
}

ppmi_vec2 ppmi_emitter_place(const ppmi_lights *lights, const ppmi_emitter *e, float u, float v,
                             float time)
{
    const uint32_t mesh = lights->scene->instances[e->instance].mesh;
    const ppmi_primitive *primitive = &lights->scene->meshes[mesh].primitives[e->primitive];
    if (primitive->kind == PPM_PRIMITIVE_TRIANGLES) return ppmi_sample_triangle(u, v);
    const ppmi_round round = ppmi_round_of(primitive, e->triangle, time);
    ppmi_vec2 at;
    ppmi_round_sample(&round, u, v, &at.x, &at.y);
    return at;
}

static bool sample_triangle(const ppmi_lights *lights, const ppmi_emitter *e, ppmi_vec3 position,
                            float time, float u, float v, ppmi_light_sample *sample)
{
    ppmi_surface surface;
    const float pdf = ppmi_emitter_sample(lights, e, u, v, time, &surface);
    const ppmi_vec3 to_light = vec3_sub(surface.position, position);
    const float distance2 = vec3_length2(to_light);
    if (!(distance2 > 0.0f)) return false;
    const float distance = sqrtf(distance2);
    sample->wi = vec3_scale(to_light, 1.0f / distance);
    const float cosine = fabsf(vec3_dot(sample->wi, surface.ng));
    if (!(cosine > 1e-6f) || !(pdf > 0.0f)) return false;
    sample->radiance = ppmi_emitter_radiance(lights, &surface, vec3_neg(sample->wi));
    const float side = vec3_dot(sample->wi, surface.ng) < 0.0f ? 1.0f : -1.0f;
    sample->target = vec3_mad(surface.position, surface.ng, side * surface.error);
    sample->pdf *= pdf * distance2 / cosine;
    return !vec3_is_black(sample->radiance);
}

/* ---- far light: the environment and the suns before it --------------------------------------- */

static float suns_pdf(const ppmi_lights *lights, ppmi_vec3 wi)
{
    float pdf = 0.0f;
    for (uint32_t i = 0; i < lights->sun_count; i++) {
        const ppmi_sun *sun = &lights->suns[i];
        if (ppmi_sun_holds(sun, wi)) pdf += sun->choice / sun->solid_angle;
    }
    return pdf;
}

/* A constant environment is sampled by the cosine, in a medium evenly; an image by its power. */
static float environment_pdf(const ppmi_lights *lights, ppmi_vec3 n, ppmi_vec3 wi)
{
    if (!lights->has_environment) return 0.0f;
    const ppmi_environment_map *map = &lights->environment;
    if (!ppmi_environment_map_is_constant(map) || !is_surface(n)) {
        return ppmi_environment_map_pdf(map, wi);
    }
    return ppmi_max(vec3_dot(n, wi), 0.0f) * PPMI_INV_PI;
}

/* Probabilities of the choices of far light, where a sample is drawn. */
typedef struct far_shares {
    float directional, environment;
} far_shares;

static far_shares far_shares_of(const ppmi_lights *lights, const float *shares)
{
    return (far_shares){
        .directional = lights->directional_count > 0 ? shares[lights->directional_choice] : 0.0f,
        .environment = lights->has_environment ? shares[lights->environment_choice] : 0.0f,
    };
}

/* Far light has one radiance and one density a direction, whichever of it a sample was drawn for:
 * where disks and a bright sky overlap, each stands in for the others. environment: density of wi
 * by the environment, given its choice. */
static bool finish_far(const ppmi_lights *lights, const far_shares *shares, ppmi_vec3 wi,
                       float environment, ppmi_light_sample *sample)
{
    sample->wi = wi;
    sample->is_far = true;
    sample->pdf = shares->environment * environment + shares->directional * suns_pdf(lights, wi);
    sample->radiance = ppmi_lights_environment(lights, wi);
    return sample->pdf > 0.0f && !vec3_is_black(sample->radiance);
}

static bool sample_environment(const ppmi_lights *lights, const far_shares *shares, ppmi_vec3 n,
                               double u_cell, float u, float v, ppmi_light_sample *sample)
{
    const ppmi_environment_map *map = &lights->environment;
    ppmi_vec3 wi;
    float pdf;
    if (ppmi_environment_map_is_constant(map) && is_surface(n)) {
        const ppmi_frame frame = ppmi_frame_from_normal(n);
        const ppmi_vec3 local = ppmi_sample_cosine_hemisphere(u, v);
        wi = ppmi_frame_to_world(&frame, local);
        pdf = local.z * PPMI_INV_PI;
    } else {
        pdf = ppmi_environment_map_sample(map, u_cell, u, v, &wi);
    }
    return finish_far(lights, shares, wi, pdf, sample);
}

static bool sample_directional(const ppmi_lights *lights, const far_shares *shares, ppmi_vec3 n,
                               double u_pick, float u, float v, ppmi_light_sample *sample)
{
    const uint32_t i = ppmi_alias_sample(&lights->directionals, u_pick, NULL);
    const ppmi_emitter *e = &lights->emitters[lights->near_count + i];
    sample->emitter = lights->near_count + i;
    if (e->kind == PPMI_EMITTER_SUN) {
        const ppmi_vec3 wi = ppmi_sun_sample(&lights->suns[e->primitive], u, v);
        return finish_far(lights, shares, wi, environment_pdf(lights, n, wi), sample);
    }
    const ppmi_punctual *light = &lights->scene->punctuals[e->triangle];
    sample->pdf = shares->directional * ppmi_alias_probability(&lights->directionals, i);
    sample->is_delta = true;
    sample->is_far = true;
    sample->wi = vec3_neg(light->direction);
    sample->radiance = light->intensity;
    return sample->pdf > 0.0f;
}

/* ---- all of it ------------------------------------------------------------------------------- */

/* share: probability of the cluster. */
static bool sample_cluster(const ppmi_lights *lights, uint32_t cluster, float share,
                           const ppmi_receiver *receiver, float time, double u_pick, float u,
                           float v, ppmi_light_sample *sample)
{
    float pdf;
    if (!ppmi_light_tree_sample(&lights->near_lights, lights->clusters[cluster].node, receiver,
                                u_pick, &sample->emitter, &pdf)) {
        return false;
    }
    sample->pdf = share * pdf;
    if (!(sample->pdf > 0.0f)) return false;
    const ppmi_emitter *e = &lights->emitters[sample->emitter];
    const ppmi_vec3 position = receiver->position;
    if (e->kind == PPMI_EMITTER_PUNCTUAL) {
        return sample_punctual(lights->scene, &lights->scene->punctuals[e->triangle], position,
                               sample);
    }
    if (e->kind == PPMI_EMITTER_LAMP) {
        return sample_lamp(lights->scene, &lights->lamps[e->primitive], position, u, v, sample);
    }
    return sample_triangle(lights, e, position, time, u, v, sample);
}

/* shares: of all choices. */
static bool sample_by(const ppmi_lights *lights, uint32_t choice, const float *shares,
                      const ppmi_receiver *receiver, float time, double u_pick, float u, float v,
                      ppmi_light_sample *sample)
{
    *sample = (ppmi_light_sample){0};
    if (choice < lights->cluster_count) {
        return sample_cluster(lights, choice, shares[choice], receiver, time, u_pick, u, v, sample);
    }
    const far_shares far = far_shares_of(lights, shares);
    if (choice == lights->directional_choice && lights->directional_count > 0) {
        return sample_directional(lights, &far, receiver->normal, u_pick, u, v, sample);
    }
    return sample_environment(lights, &far, receiver->normal, u_pick, u, v, sample);
}

bool ppmi_lights_sample_at(const ppmi_lights *lights, const ppmi_receiver *receiver, float time,
                           double u_pick, float u, float v, ppmi_light_sample *out_sample)
{
    *out_sample = (ppmi_light_sample){0};
    if (lights->choice_count == 0) return false;
    float shares[PPMI_LIGHT_CHOICES];
    const float sum = ppmi_light_choice_shares(lights, receiver, shares);
    const bool has_another = u_pick + 1.0 < (double)sum;
    out_sample->has_another = has_another;
    for (uint32_t c = 0; c < lights->choice_count; c++) {
        const double share = (double)shares[c];
        if (u_pick < share) {
            const bool is_lit =
                sample_by(lights, c, shares, receiver, time, u_pick / share, u, v, out_sample);
            out_sample->has_another = has_another;
            return is_lit;
        }
        u_pick -= share;
    }
    return false;
}

bool ppmi_lights_sample_choice(const ppmi_lights *lights, uint32_t choice,
                               const ppmi_receiver *receiver, float time, double u_pick, float u,
                               float v, ppmi_light_sample *out_sample, float *out_importance)
{
    float shares[PPMI_LIGHT_CHOICES] = {0};
    shares[choice] = 1.0f;
    *out_importance = ppmi_light_choice_importance(lights, choice, receiver);
    return *out_importance > 0.0f &&
           sample_by(lights, choice, shares, receiver, time, u_pick, u, v, out_sample);
}

/* Probability that a near light is drawn. */
static float near_choice(const ppmi_lights *lights, const ppmi_receiver *receiver, uint32_t emitter)
{
    uint32_t depth;
    const uint32_t choice = ppmi_light_choice_of(lights, emitter, &depth);
    if (choice == lights->choice_count) return 0.0f;
    float shares[PPMI_LIGHT_CHOICES];
    ppmi_light_choice_shares(lights, receiver, shares);
    return shares[choice] * ppmi_light_tree_pdf(&lights->near_lights, lights->clusters[choice].node,
                                                depth, receiver, emitter);
}

float ppmi_lights_pdf_surface(const ppmi_lights *lights, const ppmi_receiver *receiver,
                              const ppmi_hit *hit, const ppmi_surface *surface, ppmi_vec3 wi,
                              float distance)
{
    const uint32_t slot = lights->first_slot[hit->instance] + hit->primitive;
    const uint32_t first = lights->first_emitter[slot];
    if (first == PPMI_NO_EMITTER) return 0.0f;
    const uint32_t i = first + hit->triangle;
    const float cosine = fabsf(vec3_dot(wi, surface->ng));
    if (!(cosine > 1e-6f)) return 0.0f;
    const float pdf = ppmi_emitter_pdf(lights, &lights->emitters[i], surface);
    if (!(pdf > 0.0f)) return 0.0f;
    return near_choice(lights, receiver, i) * pdf * distance * distance / cosine;
}

bool ppmi_lights_next_lamp(const ppmi_lights *lights, const ppmi_ray *ray, bool is_camera,
                           ppmi_lamp_hit *hit)
{
    const float from = hit->t;
    const uint32_t after = hit->next;
    uint32_t nearest = PPMI_NO_EMITTER;
    float nearest_t = ray->t_max;
    for (uint32_t i = 0; i < lights->lamp_count; i++) {
        const ppmi_lamp *lamp = &lights->lamps[i];
        float t;
        if ((is_camera && lamp->light->is_hidden) || !ppmi_lamp_intersect(lamp, ray, &t)) continue;
        if (t < from || (t == from && i < after) || !(t < nearest_t)) continue;
        nearest = i;
        nearest_t = t;
    }
    if (nearest == PPMI_NO_EMITTER) return false;
    *hit = (ppmi_lamp_hit){.t = nearest_t, .next = nearest + 1, .lamp = nearest};
    hit->emitter = lights->lamps[nearest].emitter;
    hit->radiance =
        ppmi_lamp_radiance(lights->scene, &lights->lamps[nearest], vec3_neg(ray->direction));
    return true;
}

float ppmi_lights_pdf_lamp(const ppmi_lights *lights, const ppmi_receiver *receiver, uint32_t lamp,
                           ppmi_vec3 wi, float distance)
{
    const ppmi_lamp *of = &lights->lamps[lamp];
    return near_choice(lights, receiver, of->emitter) *
           ppmi_lamp_pdf(of, receiver->position, wi, distance);
}

bool ppmi_lights_have_lamps(const ppmi_lights *lights)
{
    return lights->lamp_count > 0;
}

float ppmi_lights_pdf_environment(const ppmi_lights *lights, const ppmi_receiver *receiver,
                                  ppmi_vec3 wi)
{
    if (lights->choice_count == lights->cluster_count) return 0.0f; /* no far light */
    float shares[PPMI_LIGHT_CHOICES];
    ppmi_light_choice_shares(lights, receiver, shares);
    const far_shares far = far_shares_of(lights, shares);
    return far.environment * environment_pdf(lights, receiver->normal, wi) +
           far.directional * suns_pdf(lights, wi);
}

ppmi_vec3 ppmi_lights_environment(const ppmi_lights *lights, ppmi_vec3 wi)
{
    ppmi_vec3 radiance = vec3_splat(0.0f);
    if (lights->has_environment) {
        radiance = ppmi_environment_map_radiance(&lights->environment, wi);
    }
    for (uint32_t i = 0; i < lights->sun_count; i++) {
        const ppmi_sun *sun = &lights->suns[i];
        if (ppmi_sun_holds(sun, wi)) radiance = vec3_add(radiance, sun->radiance);
    }
    return radiance;
}

bool ppmi_lights_far_part(const ppmi_lights *lights, ppmi_vec3 wi, uint32_t part,
                          ppmi_vec3 *out_radiance, uint32_t *out_emitter)
{
    *out_radiance = vec3_splat(0.0f);
    *out_emitter = lights->count - 1; /* the environment is the last, where there is one */
    if (part > lights->directional_count) return false;
    if (part == 0) {
        if (lights->has_environment) {
            *out_radiance = ppmi_environment_map_radiance(&lights->environment, wi);
        }
        return true;
    }
    *out_emitter = lights->near_count + part - 1;
    const ppmi_emitter *e = &lights->emitters[*out_emitter];
    if (e->kind != PPMI_EMITTER_SUN) return true;
    const ppmi_sun *sun = &lights->suns[e->primitive];
    if (ppmi_sun_holds(sun, wi)) *out_radiance = sun->radiance;
    return true;
}

bool ppmi_lights_has_backdrop(const ppmi_lights *lights)
{
    return lights->scene->environment.has_backdrop;
}

ppmi_vec3 ppmi_lights_backdrop(const ppmi_lights *lights, ppmi_vec3 direction)
{
    const ppmi_environment *environment = &lights->scene->environment;
    return environment->has_backdrop ? environment->backdrop
                                     : ppmi_lights_environment(lights, direction);
}
