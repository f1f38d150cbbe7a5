/* Light tables: every emitter with what it is chosen by.
 *
 * Photons choose lights by power. Light sampling chooses by what arrives at a place: the power of
 * far lights grows with the size of the scene and says little about that (light_choice.h). */
#include "light/light_bounds.h"
#include "light/light_choice.h"

static const ppmi_primitive *emitter_primitive(const ppm_scene *scene, const ppmi_emitter *e)
{
    return &scene->meshes[scene->instances[e->instance].mesh].primitives[e->primitive];
}

/* The largest at any step: something that opens like a fan must be sampled while it is open. */
static float area_over_shutter(const ppmi_lights *lights, const ppmi_emitter *e)
{
    const ppmi_instance *instance = &lights->scene->instances[e->instance];
    const uint32_t vertices = emitter_primitive(lights->scene, e)->motion_steps;
    const uint32_t steps = vertices > instance->motion_steps ? vertices : instance->motion_steps;
    float area = 0.0f;
    for (uint32_t i = 0; i < steps; i++) {
        const float time = steps > 1 ? (float)i / (float)(steps - 1) : 0.0f;
        ppmi_surface surface;
        ppmi_emitter_surface(lights, e, 0.3f, 0.3f, time, &surface);
        area = ppmi_max(area, ppmi_surface_area(&surface));
    }
    return area;
}

static float triangle_area(const ppm_scene *scene, const ppmi_emitter *e)
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

static float triangle_power(const ppmi_emitter *e)
{
    return PPMI_PI * e->radiance * e->area * (float)e->sides;
}

/* Of a spot with a profile: by the profile's mean, since its peak may lie in the cone. */
static float spot_power(const ppmi_lights *lights, const ppmi_punctual *light)
{
    float factor = 1.0f;
    if (light->profile > 0) {
        const ppmi_profile_table *table = &lights->profiles[light->profile - 1];
        factor = table->flux * (0.25f * PPMI_INV_PI);
    }
    return vec3_mean(light->intensity) * factor * ppmi_spot_solid_angle(light);
}

static float punctual_power(const ppmi_lights *lights, const ppmi_punctual *light)
{
    const float intensity = vec3_mean(light->intensity);
    switch (light->kind) {
    case PPM_LIGHT_POINT:
        if (light->profile > 0) return intensity * lights->profiles[light->profile - 1].flux;
        return intensity * 2.0f * PPMI_PI *
               (1.0f - ppmi_light_extent_cone(&lights->extent, light->position, light->radius_m));
    case PPM_LIGHT_SPOT:
        return spot_power(lights, light);
    case PPM_LIGHT_RECTANGLE:
    case PPM_LIGHT_DISK:
        return intensity * PPMI_PI * ppmi_lamp_of(light, 0).area;
    default:
        return intensity * ppmi_light_extent_shadow(&lights->extent, light->direction);
    }
}

/* Whatever the direction, the extent's shadow is taken for its mean. */
static float environment_power(const ppmi_lights *lights)
{
    return vec3_mean(lights->environment.integral) * ppmi_light_extent_mean_shadow(&lights->extent);
}

static float emitter_power(const ppmi_lights *lights, const ppmi_emitter *e)
{
    float power;
    switch (e->kind) {
    case PPMI_EMITTER_TRIANGLE:
        power = triangle_power(e);
        break;
    case PPMI_EMITTER_PUNCTUAL:
    case PPMI_EMITTER_LAMP:
    case PPMI_EMITTER_SUN:
        power = punctual_power(lights, &lights->scene->punctuals[e->triangle]);
        break;
    default:
        power = environment_power(lights);
    }
    return isfinite(power) ? power : 0.0f;
}

static bool primitive_emits(const ppm_scene *scene, const ppmi_instance *instance,
                            const ppmi_primitive *primitive)
{
    return ppmi_instance_is_there(instance) && scene->materials[primitive->material].emits;
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
            if (primitive_emits(scene, &scene->instances[i], &mesh->primitives[k])) {
                *out_triangles += mesh->primitives[k].element_count;
            }
        }
    }
}

static void add_triangles(ppmi_lights *lights, uint32_t instance, uint32_t primitive_index,
                          const ppmi_primitive *primitive)
{
    const ppmi_material *material = &lights->scene->materials[primitive->material];
    const bool is_round = primitive->kind != PPM_PRIMITIVE_TRIANGLES;
    /* what shines inwards of something round and opaque stays there */
    const bool both = material->desc.double_sided != 0 &&
                      (!is_round || material->has_alpha || material->desc.transmission > 0.0f ||
                       material->desc.diffuse_transmission > 0.0f);
    const bool moves =
        primitive->motion_steps > 1 || lights->scene->instances[instance].motion != NULL;
    for (uint32_t t = 0; t < primitive->element_count; t++) {
        ppmi_emitter *e = &lights->emitters[lights->count++];
        *e = (ppmi_emitter){.instance = instance,
                            .primitive = primitive_index,
                            .triangle = t,
                            .kind = PPMI_EMITTER_TRIANGLE,
                            .sides = both ? 2 : 1,
                            .has_own_area = is_round || moves,
                            .glow = PPMI_GLOW_EVEN};
        e->area = e->has_own_area ? area_over_shutter(lights, e) : triangle_area(lights->scene, e);
    }
}

static void add_punctuals(ppmi_lights *lights, bool directional)
{
    for (uint32_t i = 0; i < lights->scene->punctual_count; i++) {
        const ppmi_punctual *light = &lights->scene->punctuals[i];
        if ((light->kind == PPM_LIGHT_DIRECTIONAL) != directional) continue;
        ppmi_emitter *e = &lights->emitters[lights->count++];
        *e = (ppmi_emitter){.kind = PPMI_EMITTER_PUNCTUAL, .triangle = i};
        if (light->angular_radius_rad > 0.0f) {
            e->kind = PPMI_EMITTER_SUN;
            e->primitive = lights->sun_count;
            lights->suns[lights->sun_count++] = ppmi_sun_of(light);
        }
        if (ppmi_punctual_is_lamp(light)) {
            e->kind = PPMI_EMITTER_LAMP;
            e->primitive = lights->lamp_count;
            lights->lamps[lights->lamp_count++] = ppmi_lamp_of(light, lights->count - 1);
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
            const bool emits = primitive_emits(scene, &scene->instances[i], &mesh->primitives[k]);
            lights->first_emitter[slot] = emits ? lights->count : PPMI_NO_EMITTER;
            if (emits) add_triangles(lights, i, k, &mesh->primitives[k]);
        }
    }
    lights->triangle_count = lights->count;
    add_punctuals(lights, false);
    lights->near_count = lights->count;
    add_punctuals(lights, true);
    lights->directional_count = lights->count - lights->near_count;
    if (lights->has_environment) {
        lights->emitters[lights->count++] = (ppmi_emitter){.kind = PPMI_EMITTER_ENVIRONMENT};
    }
}

/* By what arrives, not by power: that depends on how the scene lies to the light. */
static ppm_status build_directionals(ppmi_lights *lights, float *weights)
{
    const ppmi_emitter *first = lights->emitters + lights->near_count;
    for (uint32_t i = 0; i < lights->directional_count; i++) {
        weights[i] = vec3_mean(lights->scene->punctuals[first[i].triangle].intensity);
        lights->directional_lux += weights[i];
    }
    const ppm_status status =
        ppmi_alias_init(lights->context, &lights->directionals, weights, lights->directional_count);
    if (status != PPM_STATUS_OK) return status;
    for (uint32_t i = 0; i < lights->directional_count; i++) {
        if (first[i].kind != PPMI_EMITTER_SUN) continue;
        lights->suns[first[i].primitive].choice = ppmi_alias_probability(&lights->directionals, i);
    }
    return PPM_STATUS_OK;
}

static ppm_status build_tree(ppmi_lights *lights, const float *power)
{
    ppm_context *context = lights->context;
    ppmi_light_bounds *bounds = ppmi_alloc(context, lights->near_count, sizeof *bounds);
    if (!bounds) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: lights");
    uint32_t count = 0;
    for (uint32_t i = 0; i < lights->near_count; i++)
        count += ppmi_light_bounds_of(lights, i, power[i], &bounds[count]) ? 1u : 0u;
    const ppm_status status =
        ppmi_light_tree_init(context, &lights->near_lights, bounds, count, lights->near_count);
    ppmi_free(context, bounds);
    return status;
}

static ppm_status build_tables(ppmi_lights *lights)
{
    ppm_context *context = lights->context;
    if (lights->count == 0) return PPM_STATUS_OK;
    float *weights = ppmi_alloc(context, lights->count, sizeof *weights);
    if (!weights) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: lights");
    for (uint32_t i = 0; i < lights->count; i++) {
        weights[i] = emitter_power(lights, &lights->emitters[i]);
        lights->power += weights[i];
    }
    ppm_status status = ppmi_alias_init(context, &lights->by_power, weights, lights->count);
    if (status == PPM_STATUS_OK && lights->near_count > 0) {
        status = build_tree(lights, weights);
    }
    if (status == PPM_STATUS_OK && lights->directional_count > 0) {
        status = build_directionals(lights, weights);
    }
    ppmi_free(context, weights);
    return status;
}

static ppm_status build(ppmi_lights *lights)
{
    const ppm_scene *scene = lights->scene;
    uint64_t triangles, slots;
    count_emitters(scene, &triangles, &slots);
    const uint64_t count = triangles + scene->punctual_count + (lights->has_environment ? 1 : 0);
    if (count >= PPMI_NO_EMITTER || slots >= PPMI_NO_EMITTER) {
        return ppmi_fail(lights->context, PPM_STATUS_OUT_OF_MEMORY,
                         "more than 2^32 emissive triangles");
    }
    lights->emitters = ppmi_alloc(lights->context, count + 1, sizeof *lights->emitters);
    lights->first_slot =
        ppmi_alloc(lights->context, scene->instance_count + 1u, sizeof *lights->first_slot);
    lights->first_emitter = ppmi_alloc(lights->context, slots + 1, sizeof *lights->first_emitter);
    lights->suns = ppmi_alloc(lights->context, scene->punctual_count + 1u, sizeof *lights->suns);
    lights->lamps = ppmi_alloc(lights->context, scene->punctual_count + 1u, sizeof *lights->lamps);
    if (!lights->emitters || !lights->first_slot || !lights->first_emitter || !lights->suns ||
        !lights->lamps) {
        return ppmi_fail(lights->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: lights");
    }
    add_emitters(lights);
    const ppm_status status = ppmi_lights_build_glow(lights);
    return status == PPM_STATUS_OK ? build_tables(lights) : status;
}

static ppm_status build_profiles(ppmi_lights *lights)
{
    const ppm_scene *scene = lights->scene;
    lights->profiles =
        ppmi_alloc_zeroed(lights->context, scene->profile_count + 1u, sizeof *lights->profiles);
    if (!lights->profiles) {
        return ppmi_fail(lights->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: lights");
    }
    ppm_status status = PPM_STATUS_OK;
    for (uint32_t i = 0; i < scene->profile_count && status == PPM_STATUS_OK; i++) {
        status =
            ppmi_profile_table_init(lights->context, &scene->profiles[i], &lights->profiles[i]);
    }
    return status;
}

ppm_status ppmi_lights_create(ppm_context *context, const ppm_scene *scene,
                              ppmi_lights **out_lights)
{
    ppmi_lights *lights = ppmi_alloc_zeroed(context, 1, sizeof *lights);
    if (!lights) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: lights");
    lights->context = context;
    lights->scene = scene;
    lights->extent = ppmi_light_extent_of(scene);
    ppm_status status = ppmi_environment_map_init(context, scene, &lights->environment);
    lights->has_environment = !vec3_is_black(lights->environment.integral);
    if (status == PPM_STATUS_OK) status = build_profiles(lights);
    if (status == PPM_STATUS_OK) status = build(lights);
    if (status == PPM_STATUS_OK) ppmi_light_choices_init(lights);
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
    ppmi_light_tree_deinit(context, &lights->near_lights);
    ppmi_light_cells_deinit(context, &lights->cells);
    ppmi_alias_deinit(context, &lights->directionals);
    ppmi_free(context, lights->emitters);
    ppmi_glow_deinit(context, &lights->glow);
    for (uint32_t i = 0; lights->profiles && i < lights->scene->profile_count; i++) {
        ppmi_profile_table_deinit(context, &lights->profiles[i]);
    }
    ppmi_free(context, lights->profiles);
    ppmi_free(context, lights->lamps);
    ppmi_free(context, lights->suns);
    ppmi_free(context, lights->first_slot);
    ppmi_free(context, lights->first_emitter);
    ppmi_free(context, lights);
}

uint32_t ppmi_lights_choice_count(const ppmi_lights *lights)
{
    return lights->choice_count;
}

ppm_status ppmi_lights_learn(ppmi_lights *lights, const ppmi_light_probe *probes, uint32_t count)
{
    ppmi_light_cells_deinit(lights->context, &lights->cells);
    return ppmi_light_cells_init(lights->context, &lights->cells, probes, count,
                                 lights->choice_count);
}

uint64_t ppmi_lights_count(const ppmi_lights *lights)
{
    return lights->count;
}

size_t ppmi_lights_source(const ppmi_lights *lights, uint32_t emitter)
{
    const ppmi_emitter *e = &lights->emitters[emitter];
    const size_t lamps = lights->scene->punctual_count;
    if (e->kind == PPMI_EMITTER_TRIANGLE) return lamps + e->instance;
    if (e->kind == PPMI_EMITTER_ENVIRONMENT) return lamps + lights->scene->instance_count;
    return e->triangle;
}
