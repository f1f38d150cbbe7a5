/* Light tables, light sampling and photon emission.
 *
 * Lights are chosen by power for photons. Light sampling at surfaces first chooses a class, those
 * that are there evenly: near lights (triangles, points, spots), directional lights, the
 * environment. The power of the far ones grows with the size of the scene and says little about
 * what arrives at a point. Within the first two classes the choice is by power. */
#include "light/lights.h"

#include "math/sampling.h"

#define NO_EMITTER UINT32_MAX

typedef enum emitter_kind { EMITTER_TRIANGLE, EMITTER_PUNCTUAL, EMITTER_ENVIRONMENT } emitter_kind;

/* One light. For triangles instance, primitive, triangle; for punctual lights triangle is the index
 * among them. */
typedef struct emitter {
    uint32_t instance, primitive, triangle;
    uint16_t kind; /* emitter_kind */
    uint16_t sides;
    float area; /* world, of triangles */
} emitter;

struct ppmi_lights {
    ppm_context *context;
    const ppm_scene *scene;
    ppmi_vec3 center; /* bounding sphere of the scene */
    float radius;
    ppmi_environment_map environment;
    bool has_environment;

    uint32_t count; /* emitters: near lights, directional lights, the environment */
    emitter *emitters;
    ppmi_alias by_power;     /* all emitters, for photons */
    ppmi_alias near_lights;  /* the first near_count emitters, for light sampling */
    ppmi_alias directionals; /* the next directional_count */
    uint32_t near_count, directional_count;
    float class_share;       /* of light samples, for each class that is there */
    uint32_t *first_slot;    /* per instance: where its primitives start in first_emitter */
    uint32_t *first_emitter; /* per instance and primitive: emitter of triangle 0, or NO_EMITTER */
};

/* ---- building -------------------------------------------------------------------------------- */

static const ppmi_primitive *emitter_primitive(const ppm_scene *scene, const emitter *e)
{
    return &scene->meshes[scene->instances[e->instance].mesh].primitives[e->primitive];
}

static float triangle_area(const ppm_scene *scene, const emitter *e)
{
    const ppmi_primitive *primitive = emitter_primitive(scene, e);
    const ppmi_transform *m = &scene->instances[e->instance].to_world;
    const uint32_t *triangle = primitive->indices + 3 * (size_t)e->triangle;
    const ppmi_vec3 a = vec3_load(primitive->positions + 3 * (size_t)triangle[0]);
    const ppmi_vec3 b = vec3_load(primitive->positions + 3 * (size_t)triangle[1]);
    const ppmi_vec3 c = vec3_load(primitive->positions + 3 * (size_t)triangle[2]);
    const ppmi_vec3 ab = ppmi_transform_vector(m, vec3_sub(b, a));
    const ppmi_vec3 ac = ppmi_transform_vector(m, vec3_sub(c, a));
    return 0.5f * vec3_length(vec3_cross(ab, ac));
}

static void surface_on_emitter(const ppmi_lights *lights, const emitter *e, float u, float v,
                               ppmi_surface *out_surface)
{
    const ppmi_hit hit = {.instance = e->instance,
                          .primitive = e->primitive,
                          .triangle = e->triangle,
                          .u = u,
                          .v = v};
    ppmi_surface_from_hit(lights->scene, &hit, out_surface);
}

/* Mean emission by a few lookups, never below a share of the factor: a texture's bright spot
 * between the lookups must be able to send photons. */
static float triangle_power(const ppmi_lights *lights, const emitter *e)
{
    static const float points[4][2] = {
        {1.0f / 3, 1.0f / 3}, {0.15f, 0.15f}, {0.7f, 0.15f}, {0.15f, 0.7f}};
    const ppmi_material *material =
        &lights->scene->materials[emitter_primitive(lights->scene, e)->material];
    float mean = vec3_mean(vec3_load(material->desc.emission));
    if (material->desc.emission_texture.image > 0) {
        const float floor_share = 0.05f;
        float sum = 0.0f;
        for (int i = 0; i < 4; i++) {
            ppmi_surface surface;
            surface_on_emitter(lights, e, points[i][0], points[i][1], &surface);
            sum += vec3_mean(ppmi_surface_emission(lights->scene, &surface, surface.ng));
        }
        mean = mean * floor_share + 0.25f * sum;
    }
    return PPMI_PI * mean * e->area * (float)e->sides;
}

/* Integral of the falloff of a spot over its cone: full inside, squared ramp of the cosine between
 * the cones (KHR_lights_punctual). */
static float spot_solid_angle(const ppmi_punctual *light)
{
    return 2.0f * PPMI_PI *
           ((1.0f - light->cos_inner) + (light->cos_inner - light->cos_outer) / 3.0f);
}

/* Cosine of the cone from a point that holds the scene's bounding sphere; -1 from inside it. */
static float aim_cosine(const ppmi_lights *lights, ppmi_vec3 position)
{
    const float distance2 = vec3_length2(vec3_sub(lights->center, position));
    const float radius2 = lights->radius * lights->radius * 1.01f;
    return distance2 > radius2 ? sqrtf(1.0f - radius2 / distance2) : -1.0f;
}

static float punctual_power(const ppmi_lights *lights, const ppmi_punctual *light)
{
    const float intensity = vec3_mean(light->intensity);
    switch (light->kind) {
    case PPM_LIGHT_POINT:
        return intensity * 2.0f * PPMI_PI * (1.0f - aim_cosine(lights, light->position));
    case PPM_LIGHT_SPOT:
        return intensity * spot_solid_angle(light);
    default:
        return intensity * PPMI_PI * lights->radius * lights->radius;
    }
}

static float environment_power(const ppmi_lights *lights)
{
    return vec3_mean(lights->environment.integral) * PPMI_PI * lights->radius * lights->radius;
}

static float emitter_power(const ppmi_lights *lights, const emitter *e)
{
    float power;
    switch (e->kind) {
    case EMITTER_TRIANGLE:
        power = triangle_power(lights, e);
        break;
    case EMITTER_PUNCTUAL:
        power = punctual_power(lights, &lights->scene->punctuals[e->triangle]);
        break;
    default:
        power = environment_power(lights);
    }
    return isfinite(power) ? power : 0.0f;
}

static bool primitive_emits(const ppm_scene *scene, const ppmi_primitive *primitive)
{
    return scene->materials[primitive->material].emits;
}

/* Counts emissive triangles and instance-primitive slots. */
static void count_emitters(const ppm_scene *scene, uint64_t *out_triangles, uint64_t *out_slots)
{
    *out_triangles = 0;
    *out_slots = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        *out_slots += mesh->primitive_count;
        for (uint32_t k = 0; k < mesh->primitive_count; k++) {
            if (primitive_emits(scene, &mesh->primitives[k])) {
                *out_triangles += mesh->primitives[k].triangle_count;
            }
        }
    }
}

static void add_triangles(ppmi_lights *lights, uint32_t instance, uint32_t primitive_index,
                          const ppmi_primitive *primitive)
{
    const bool both = lights->scene->materials[primitive->material].desc.double_sided != 0;
    for (uint32_t t = 0; t < primitive->triangle_count; t++) {
        emitter *e = &lights->emitters[lights->count++];
        *e = (emitter){.instance = instance,
                       .primitive = primitive_index,
                       .triangle = t,
                       .kind = EMITTER_TRIANGLE,
                       .sides = both ? 2 : 1};
        e->area = triangle_area(lights->scene, e);
    }
}

static void add_punctuals(ppmi_lights *lights, bool directional)
{
    for (uint32_t i = 0; i < lights->scene->punctual_count; i++) {
        if ((lights->scene->punctuals[i].kind == PPM_LIGHT_DIRECTIONAL) == directional) {
            lights->emitters[lights->count++] = (emitter){.kind = EMITTER_PUNCTUAL, .triangle = i};
        }
    }
}

static void add_emitters(ppmi_lights *lights)
{
    const ppm_scene *scene = lights->scene;
    uint32_t slot = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const ppmi_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        lights->first_slot[i] = slot;
        for (uint32_t k = 0; k < mesh->primitive_count; k++, slot++) {
            const bool emits = primitive_emits(scene, &mesh->primitives[k]);
            lights->first_emitter[slot] = emits ? lights->count : NO_EMITTER;
            if (emits) add_triangles(lights, i, k, &mesh->primitives[k]);
        }
    }
    add_punctuals(lights, false);
    lights->near_count = lights->count;
    add_punctuals(lights, true);
    lights->directional_count = lights->count - lights->near_count;
    if (lights->has_environment) {
        lights->emitters[lights->count++] = (emitter){.kind = EMITTER_ENVIRONMENT};
    }
    const int classes = (lights->near_count > 0) + (lights->directional_count > 0) +
                        (lights->has_environment ? 1 : 0);
    lights->class_share = classes > 0 ? 1.0f / (float)classes : 0.0f;
}

static ppm_status build_tables(ppmi_lights *lights)
{
    ppm_context *context = lights->context;
    if (lights->count == 0) return PPM_STATUS_OK;
    float *powers = ppmi_alloc(context, lights->count, sizeof *powers);
    if (!powers) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: lights");
    for (uint32_t i = 0; i < lights->count; i++) {
        powers[i] = emitter_power(lights, &lights->emitters[i]);
    }
    ppm_status status = ppmi_alias_init(context, &lights->by_power, powers, lights->count);
    if (status == PPM_STATUS_OK && lights->near_count > 0) {
        status = ppmi_alias_init(context, &lights->near_lights, powers, lights->near_count);
    }
    if (status == PPM_STATUS_OK && lights->directional_count > 0) {
        status = ppmi_alias_init(context, &lights->directionals, powers + lights->near_count,
                                 lights->directional_count);
    }
    ppmi_free(context, powers);
    return status;
}

static ppm_status build(ppmi_lights *lights)
{
    const ppm_scene *scene = lights->scene;
    uint64_t triangles, slots;
    count_emitters(scene, &triangles, &slots);
    const uint64_t count = triangles + scene->punctual_count + (lights->has_environment ? 1 : 0);
    if (count >= NO_EMITTER || slots >= NO_EMITTER) {
        return ppmi_fail(lights->context, PPM_STATUS_OUT_OF_MEMORY,
                         "more than 2^32 emissive triangles");
    }
    lights->emitters = ppmi_alloc(lights->context, count + 1, sizeof *lights->emitters);
    lights->first_slot =
        ppmi_alloc(lights->context, scene->instance_count + 1u, sizeof *lights->first_slot);
    lights->first_emitter = ppmi_alloc(lights->context, slots + 1, sizeof *lights->first_emitter);
    if (!lights->emitters || !lights->first_slot || !lights->first_emitter) {
        return ppmi_fail(lights->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: lights");
    }
    add_emitters(lights);
    return build_tables(lights);
}

ppm_status ppmi_lights_create(ppm_context *context, const ppm_scene *scene,
                              ppmi_lights **out_lights)
{
    ppmi_lights *lights = ppmi_alloc_zeroed(context, 1, sizeof *lights);
    if (!lights) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: lights");
    lights->context = context;
    lights->scene = scene;
    ppmi_vec3 low, high;
    if (ppmi_scene_bounds(scene, &low, &high)) {
        lights->center = vec3_scale(vec3_add(low, high), 0.5f);
        lights->radius = 0.5f * vec3_length(vec3_sub(high, low)) * 1.0001f;
    }
    ppm_status status = ppmi_environment_map_init(context, scene, &lights->environment);
    lights->has_environment = !vec3_is_black(lights->environment.integral);
    if (status == PPM_STATUS_OK) status = build(lights);
    if (status != PPM_STATUS_OK) {
        ppmi_lights_destroy(lights);
        return status;
    }
    *out_lights = lights;
    return PPM_STATUS_OK;
}

void ppmi_lights_destroy(ppmi_lights *lights)
{
    if (!lights) return;
    ppm_context *context = lights->context;
    ppmi_environment_map_deinit(context, &lights->environment);
    ppmi_alias_deinit(context, &lights->by_power);
    ppmi_alias_deinit(context, &lights->near_lights);
    ppmi_alias_deinit(context, &lights->directionals);
    ppmi_free(context, lights->emitters);
    ppmi_free(context, lights->first_slot);
    ppmi_free(context, lights->first_emitter);
    ppmi_free(context, lights);
}

uint64_t ppmi_lights_count(const ppmi_lights *lights)
{
    return lights->count;
}

/* ---- light sampling -------------------------------------------------------------------------- */

static float spot_falloff(const ppmi_punctual *light, float cosine)
{
    const float range = ppmi_max(light->cos_inner - light->cos_outer, 1e-6f);
    const float x = ppmi_clampf((cosine - light->cos_outer) / range, 0.0f, 1.0f);
    return x * x;
}

static bool sample_punctual(const ppmi_punctual *light, ppmi_vec3 position,
                            ppmi_light_sample *sample)
{
    sample->is_delta = true;
    if (light->kind == PPM_LIGHT_DIRECTIONAL) {
        sample->wi = vec3_neg(light->direction);
        sample->is_far = true;
        sample->radiance = light->intensity;
        return true;
    }
    const ppmi_vec3 to_light = vec3_sub(light->position, position);
    const float distance2 = vec3_length2(to_light);
    if (!(distance2 > 0.0f)) return false;
    sample->target = light->position;
    sample->wi = vec3_normalize(to_light);
    float scale = 1.0f / distance2;
    if (light->kind == PPM_LIGHT_SPOT) {
        scale *= spot_falloff(light, -vec3_dot(sample->wi, light->direction));
    }
    sample->radiance = vec3_scale(light->intensity, scale);
    return scale > 0.0f;
}

/* Rays meet a surface with alpha as often as it is opaque, and see its emission then. */
static ppmi_vec3 covered_emission(const ppmi_lights *lights, const ppmi_surface *surface,
                                  ppmi_vec3 wo)
{
    return vec3_scale(ppmi_surface_emission(lights->scene, surface, wo),
                      ppmi_surface_opacity(lights->scene, surface));
}

static bool sample_triangle(const ppmi_lights *lights, const emitter *e, ppmi_vec3 position,
                            float u, float v, ppmi_light_sample *sample)
{
    const ppmi_vec2 at = ppmi_sample_triangle(u, v);
    ppmi_surface surface;
    surface_on_emitter(lights, e, at.x, at.y, &surface);
    const ppmi_vec3 to_light = vec3_sub(surface.position, position);
    const float distance2 = vec3_length2(to_light);
    if (!(distance2 > 0.0f)) return false;
    const float distance = sqrtf(distance2);
    sample->wi = vec3_scale(to_light, 1.0f / distance);
    const float cosine = fabsf(vec3_dot(sample->wi, surface.ng));
    if (!(cosine > 1e-6f)) return false;
    sample->radiance = covered_emission(lights, &surface, vec3_neg(sample->wi));
    const float side = vec3_dot(sample->wi, surface.ng) < 0.0f ? 1.0f : -1.0f;
    sample->target = vec3_mad(surface.position, surface.ng, side * surface.error);
    sample->pdf *= distance2 / (cosine * e->area);
    return !vec3_is_black(sample->radiance);
}

/* A constant environment is sampled by the cosine, an image by its power. */
static bool sample_environment(const ppmi_lights *lights, ppmi_vec3 n, double u_cell, float u,
                               float v, ppmi_light_sample *sample)
{
    const ppmi_environment_map *map = &lights->environment;
    sample->is_far = true;
    if (ppmi_environment_map_is_constant(map)) {
        const ppmi_frame frame = ppmi_frame_from_normal(n);
        const ppmi_vec3 local = ppmi_sample_cosine_hemisphere(u, v);
        sample->wi = ppmi_frame_to_world(&frame, local);
        sample->pdf *= local.z * PPMI_INV_PI;
    } else {
        sample->pdf *= ppmi_environment_map_sample(map, u_cell, u, v, &sample->wi);
    }
    sample->radiance = ppmi_environment_map_radiance(map, sample->wi);
    return sample->pdf > 0.0f && !vec3_is_black(sample->radiance);
}

/* Draws from a class of finite choices; first is the class's first emitter. */
static bool sample_by_power(const ppmi_lights *lights, const ppmi_alias *table, uint32_t first,
                            ppmi_vec3 position, double u_pick, float u, float v,
                            ppmi_light_sample *sample)
{
    const uint32_t i = ppmi_alias_sample(table, u_pick, NULL);
    const emitter *e = &lights->emitters[first + i];
    sample->pdf *= ppmi_alias_probability(table, i);
    if (!(sample->pdf > 0.0f)) return false;
    if (e->kind == EMITTER_PUNCTUAL) {
        return sample_punctual(&lights->scene->punctuals[e->triangle], position, sample);
    }
    return sample_triangle(lights, e, position, u, v, sample);
}

bool ppmi_lights_sample(const ppmi_lights *lights, ppmi_vec3 position, ppmi_vec3 n, double u_pick,
                        float u, float v, ppmi_light_sample *out_sample)
{
    if (lights->count == 0) return false;
    const double share = (double)lights->class_share;
    *out_sample = (ppmi_light_sample){.pdf = lights->class_share};
    if (lights->has_environment) {
        if (u_pick < share) {
            return sample_environment(lights, n, u_pick / share, u, v, out_sample);
        }
        u_pick -= share;
    }
    if (lights->directional_count > 0) {
        if (u_pick < share || lights->near_count == 0) {
            return sample_by_power(lights, &lights->directionals, lights->near_count, position,
                                   u_pick / share, u, v, out_sample);
        }
        u_pick -= share;
    }
    if (lights->near_count == 0) return false;
    return sample_by_power(lights, &lights->near_lights, 0, position, u_pick / share, u, v,
                           out_sample);
}

float ppmi_lights_pdf_surface(const ppmi_lights *lights, const ppmi_hit *hit,
                              const ppmi_surface *surface, ppmi_vec3 wi, float distance)
{
    const uint32_t slot = lights->first_slot[hit->instance] + hit->primitive;
    const uint32_t first = lights->first_emitter[slot];
    if (first == NO_EMITTER) return 0.0f;
    const uint32_t i = first + hit->triangle;
    const float cosine = fabsf(vec3_dot(wi, surface->ng));
    const float area = lights->emitters[i].area;
    if (!(cosine > 1e-6f) || !(area > 0.0f)) return 0.0f;
    return lights->class_share * ppmi_alias_probability(&lights->near_lights, i) * distance *
           distance / (cosine * area);
}

float ppmi_lights_pdf_environment(const ppmi_lights *lights, ppmi_vec3 n, ppmi_vec3 wi)
{
    const ppmi_environment_map *map = &lights->environment;
    const float pdf = ppmi_environment_map_is_constant(map)
                          ? ppmi_max(vec3_dot(n, wi), 0.0f) * PPMI_INV_PI
                          : ppmi_environment_map_pdf(map, wi);
    return lights->has_environment ? lights->class_share * pdf : 0.0f;
}

ppmi_vec3 ppmi_lights_environment(const ppmi_lights *lights, ppmi_vec3 wi)
{
    if (!lights->has_environment) return vec3_splat(0.0f);
    return ppmi_environment_map_radiance(&lights->environment, wi);
}

ppmi_vec3 ppmi_lights_backdrop(const ppmi_lights *lights, ppmi_vec3 direction)
{
    const ppmi_environment *environment = &lights->scene->environment;
    return environment->has_backdrop ? environment->backdrop
                                     : ppmi_lights_environment(lights, direction);
}

/* ---- photon emission ------------------------------------------------------------------------- */

static bool emit_triangle(const ppmi_lights *lights, const emitter *e, const float u[4],
                          ppmi_emission *emission)
{
    const ppmi_vec2 at = ppmi_sample_triangle(u[0], u[1]);
    ppmi_surface surface;
    surface_on_emitter(lights, e, at.x, at.y, &surface);
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
    const ppmi_vec3 radiance = covered_emission(lights, &surface, n);
    emission->power = vec3_scale(radiance, PPMI_PI * e->area * (float)e->sides);
    return true;
}

/* A disk across the bounding sphere, from where parallel light comes in. */
static ppmi_ray ray_from_far(const ppmi_lights *lights, ppmi_vec3 direction, float u, float v)
{
    const ppmi_frame frame = ppmi_frame_from_normal(direction);
    const ppmi_vec2 d = ppmi_sample_disk(u, v);
    const float r = lights->radius;
    const ppmi_vec3 offset = ppmi_frame_to_world(&frame, vec3(d.x * r, d.y * r, -1.01f * r));
    return (ppmi_ray){
        .origin = vec3_add(lights->center, offset), .t_max = INFINITY, .direction = direction};
}

static bool emit_point(const ppmi_lights *lights, const ppmi_punctual *light, const float u[4],
                       ppmi_emission *emission)
{
    const float cos_max = aim_cosine(lights, light->position);
    const ppmi_vec3 local = ppmi_sample_cone(cos_max, u[2], u[3]);
    const ppmi_vec3 axis = cos_max > -1.0f
                               ? vec3_normalize(vec3_sub(lights->center, light->position))
                               : vec3(0.0f, 0.0f, 1.0f);
    const ppmi_frame frame = ppmi_frame_from_normal(axis);
    emission->ray = (ppmi_ray){.origin = light->position,
                               .t_max = INFINITY,
                               .direction = vec3_normalize(ppmi_frame_to_world(&frame, local))};
    emission->power = vec3_scale(light->intensity, 2.0f * PPMI_PI * (1.0f - cos_max));
    return true;
}

/* The falloff is sampled exactly: its integral between the cones grows as the cube of the ramp. */
static bool emit_spot(const ppmi_punctual *light, const float u[4], ppmi_emission *emission)
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
    emission->ray = (ppmi_ray){.origin = light->position,
                               .t_max = INFINITY,
                               .direction = vec3_normalize(ppmi_frame_to_world(&frame, local))};
    emission->power = vec3_scale(light->intensity, spot_solid_angle(light));
    return true;
}

static bool emit_punctual(const ppmi_lights *lights, const ppmi_punctual *light, const float u[4],
                          ppmi_emission *emission)
{
    if (light->kind == PPM_LIGHT_POINT) return emit_point(lights, light, u, emission);
    if (light->kind == PPM_LIGHT_SPOT) return emit_spot(light, u, emission);
    emission->ray = ray_from_far(lights, light->direction, u[0], u[1]);
    emission->power = vec3_scale(light->intensity, PPMI_PI * lights->radius * lights->radius);
    return true;
}

static bool emit_environment(const ppmi_lights *lights, double u_cell, const float u[4],
                             ppmi_emission *emission)
{
    ppmi_vec3 towards;
    const float pdf =
        ppmi_environment_map_sample(&lights->environment, u_cell, u[2], u[3], &towards);
    if (!(pdf > 0.0f)) return false;
    emission->ray = ray_from_far(lights, vec3_neg(towards), u[0], u[1]);
    emission->power = vec3_scale(ppmi_environment_map_radiance(&lights->environment, towards),
                                 PPMI_PI * lights->radius * lights->radius / pdf);
    return true;
}

bool ppmi_lights_emit(const ppmi_lights *lights, double u_pick, const float u[4],
                      ppmi_emission *out_emission)
{
    if (lights->count == 0) return false;
    double rest;
    const uint32_t i = ppmi_alias_sample(&lights->by_power, u_pick, &rest);
    const emitter *e = &lights->emitters[i];
    const float probability = ppmi_alias_probability(&lights->by_power, i);
    bool emitted;
    if (e->kind == EMITTER_TRIANGLE) {
        emitted = emit_triangle(lights, e, u, out_emission);
    } else if (e->kind == EMITTER_PUNCTUAL) {
        emitted = emit_punctual(lights, &lights->scene->punctuals[e->triangle], u, out_emission);
    } else {
        emitted = emit_environment(lights, rest, u, out_emission);
    }
    if (!emitted || !(probability > 0.0f)) return false;
    out_emission->power = vec3_scale(out_emission->power, 1.0f / probability);
    return !vec3_is_black(out_emission->power);
}
