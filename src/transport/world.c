/* Steps of a path: to the next surface, to the lights, to emission that lies on the way. */
#include "transport/world.h"

#include "transport/media.h"
#include "transport/passing.h"
#include "transport/solid.h"

/* Surfaces inside of solids that count for more: a ray ends after so many. */
enum { MAX_SURFACES_PASSED = 4096 };

void ppmi_world_init(ppmi_world *world, const ppm_scene *scene, const ppmi_accel *accel,
                     const ppmi_lights *lights, const ppmi_albedo_table *albedo,
                     const ppmi_spectrum *spectrum, const ppmi_contacts *contacts)
{
    *world = (ppmi_world){.scene = scene,
                          .accel = accel,
                          .lights = lights,
                          .albedo = albedo,
                          .spectrum = spectrum,
                          .contacts = contacts};
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const ppmi_material *material = &scene->materials[i];
        world->has_alpha = world->has_alpha || material->has_alpha;
        world->has_sheets = world->has_sheets || material->is_sheet;
        if (!material->desc.double_sided && !material->is_solid_glass)
            world->has_single_sided = true;
        world->has_scattering = world->has_scattering || ppmi_medium_scatters(&material->inside);
    }
    ppmi_columns_init(&world->columns, scene);
    world->has_lamps = lights && ppmi_lights_have_lamps(lights);
    for (uint32_t i = 0; i < scene->image_count; i++)
        world->has_textures = world->has_textures || scene->images[i].mip_count > 0;
    ppmi_vec3 low, high;
    world->has_fog = !ppmi_medium_is_empty(&scene->fog) && ppmi_scene_bounds(scene, &low, &high);
    if (!world->has_fog) return;
    world->has_scattering = world->has_scattering || ppmi_medium_scatters(&scene->fog);
    world->fog_center = vec3_scale(vec3_add(low, high), 0.5f);
    world->fog_radius = 0.5f * vec3_length(vec3_sub(high, low)) * 1.0001f;
}

static bool trace(ppmi_walker *walker, const ppmi_ray *ray, ppmi_ray_kind kind, ppmi_vertex *vertex)
{
    walker->rays++;
    if (!ppmi_passing_intersect(walker, ray, kind, &vertex->hit)) return false;
    ppmi_surface_from_hit(walker->world->scene, &vertex->hit, &vertex->surface);
    return true;
}

/* Puts the vertex into the medium, at t along the ray. */
static void scatter_at(ppmi_vertex *vertex, const ppmi_medium *medium, const ppmi_ray *ray, float t)
{
    vertex->medium = medium;
    vertex->surface =
        (ppmi_surface){.position = vec3_mad(ray->origin, ray->direction, t), .time = ray->time};
    vertex->distance += t;
}

/* Of the vertices that a path's segments offer, each place keeps one, by how much the segments
 * scatter (reservoir sampling): weights are divided by the chance of having been kept. */
typedef struct scatter_choice {
    ppmi_vertex *vertices;
    uint32_t count;
    float mass;                          /* of all that were offered */
    float kept_mass[PPMI_MAX_SCATTERED]; /* of what each place holds */
} scatter_choice;

static void offer(ppmi_walker *walker, const ppmi_medium_span *span, const ppmi_ray *ray,
                  ppmi_vec3 passing, const ppmi_vertex *arrival, scatter_choice *choice)
{
    const float mass =
        vec3_mean(vec3_mul(arrival->transmittance, vec3_sub(vec3_splat(1.0f), passing)));
    choice->mass += mass;
    if (!(mass > 0.0f)) return;
    const float u_channel = ppmi_rng_float(&walker->rng), u = ppmi_walker_float(walker);
    if (choice->count == 0) return;
    const float share = 1.0f / (float)choice->count;
    for (uint32_t i = 0; i < choice->count; i++) {
        float distance;
        ppmi_vec3 weight;
        if (!ppmi_medium_sample_within(span->medium, span->end - span->begin, u_channel,
                                       share * ((float)i + u), &distance, &weight)) {
            return;
        }
        if (ppmi_rng_float(&walker->rng) * choice->mass >= mass) continue;
        choice->kept_mass[i] = mass;
        ppmi_vertex *vertex = &choice->vertices[i];
        *vertex = (ppmi_vertex){.distance = arrival->distance,
                                .transmittance =
                                    vec3_scale(vec3_mul(arrival->transmittance, weight), share)};
        scatter_at(vertex, span->medium, ray, span->begin + distance);
    }
}

/* Takes the path through the medium before a hit (at t_max; infinite: none). False where it is
 * scattered on the way; a path with a choice never is, but offers it where it could be. */
static bool cross_filled(ppmi_walker *walker, const ppmi_ray *ray, float t_max, ppmi_vertex *vertex,
                         scatter_choice *choice)
{
    const ppmi_medium_span span = ppmi_media_span(walker->world, &walker->interior, ray, t_max);
    if (!span.medium) return true;
    const float length = span.end - span.begin;
    const bool scatters = ppmi_medium_scatters(span.medium);
    if (!scatters || choice) {
        const ppmi_vec3 passing = ppmi_medium_transmittance(span.medium, length);
        if (scatters) offer(walker, &span, ray, passing, vertex, choice);
        vertex->transmittance = vec3_mul(vertex->transmittance, passing);
        return true;
    }
    const float u_channel = ppmi_rng_float(&walker->rng), u = ppmi_walker_float(walker);
    const ppmi_medium_sample sample =
        ppmi_medium_sample_distance(span.medium, length, u_channel, u);
    vertex->transmittance = vec3_mul(vertex->transmittance, sample.weight);
    if (!sample.is_scattered) return true;
    scatter_at(vertex, span.medium, ray, span.begin + sample.distance);
    return false;
}

static inline bool cross_medium(ppmi_walker *walker, const ppmi_ray *ray, float t_max,
                                ppmi_vertex *vertex, scatter_choice *choice)
{
    const bool is_empty = !walker->world->has_fog && walker->interior.count == 0;
    return is_empty || cross_filled(walker, ray, t_max, vertex, choice);
}

/* What photons leave to a path of the light that it meets beyond mirrors (the balance heuristic).
 */
static float left_by_photons(const ppmi_world *world, const ppmi_origin *origin, ppmi_vec3 radiance)
{
    if (origin->merging == 0.0f) return 1.0f;
    return 1.0f / (1.0f + origin->merging * ppmi_lights_crowding(world->lights, radiance));
}

/* Adds what a lamp sends along the ray that meets it, at distance from where the path comes from.
 */
static void add_lamp(const ppmi_walker *walker, const ppmi_ray *ray, const ppmi_lamp_hit *lamp,
                     ppmi_vertex *vertex)
{
    const ppmi_origin *origin = walker->origin;
    float weight = left_by_photons(walker->world, origin, lamp->radiance);
    if (!origin->is_delta) {
        const float light_pdf =
            ppmi_lights_pdf_lamp(walker->world->lights, &origin->receiver, lamp->lamp,
                                 ray->direction, origin->distance + vertex->distance);
        weight = ppmi_mis_weight(origin->pdf, light_pdf);
    }
    const ppmi_vec3 light = vec3_scale(vec3_mul(vertex->transmittance, lamp->radiance), weight);
    vertex->lamplight = vec3_add(vertex->lamplight, light);
    if (walker->lamp_witness) walker->lamp_witness->see(walker->lamp_witness, lamp->emitter, light);
}

/* Takes an eye path past the lamps before a hit (at ray->t_max; infinite: none), and the ray with
 * it. False where a medium scatters it on the way. */
__attribute__((noinline)) static bool pass_lamps(ppmi_walker *walker, ppmi_ray *ray,
                                                 ppmi_ray_kind kind, ppmi_vertex *vertex,
                                                 scatter_choice *choice)
{
    const ppmi_ray whole = *ray;
    ppmi_lamp_hit lamp = {.t = 0.0f};
    float passed = 0.0f;
    while (ppmi_lights_next_lamp(walker->world->lights, &whole, kind == PPMI_RAY_CAMERA, &lamp)) {
        const float way = lamp.t - passed;
        if (!cross_medium(walker, ray, way, vertex, choice)) return false;
        passed = lamp.t;
        vertex->distance += way;
        ray->origin = vec3_mad(whole.origin, whole.direction, passed);
        ray->t_max = whole.t_max - passed;
        add_lamp(walker, ray, &lamp, vertex);
    }
    return true;
}

static ppmi_arrival follow(ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind,
                           ppmi_vertex *vertex, scatter_choice *choice)
{
    vertex->medium = NULL;
    vertex->distance = 0.0f;
    vertex->transmittance = vec3_splat(1.0f);
    vertex->lamplight = vec3_splat(0.0f);
    vertex->relative_index = vertex->drawn_wavelength = 0.0f;
    const bool sees_lamps = walker->world->has_lamps && walker->origin;
    const float reach = ray.t_max; /* of a camera that clips; else infinite */
    for (int i = 0; i < MAX_SURFACES_PASSED; i++) {
        const bool is_hit = trace(walker, &ray, kind, vertex);
        if (is_hit) ray.t_max = vertex->hit.t;
        const bool is_solid = is_hit && vertex->surface.material->is_solid_glass;
        const bool is_seen = !is_solid || ppmi_solid_arrive(walker, ray.direction, vertex);
        if (sees_lamps && !pass_lamps(walker, &ray, kind, vertex, choice)) return PPMI_IN_MEDIUM;
        if (!cross_medium(walker, &ray, ray.t_max, vertex, choice)) return PPMI_IN_MEDIUM;
        if (!is_hit) return PPMI_ESCAPED;
        vertex->distance += ray.t_max;
        if (!is_seen) {
            walker->interior = vertex->behind;
        } else {
            if (vertex->surface.material->is_solid_glass) {
                ppmi_solid_refract(walker, ray.direction, vertex);
            }
            return PPMI_AT_SURFACE;
        }
        ray = ppmi_surface_ray(&vertex->surface, ray.direction);
        ray.t_max = ppmi_max(reach - vertex->distance, 0.0f);
    }
    vertex->transmittance = vec3_splat(0.0f);
    return PPMI_ESCAPED;
}

/* What a sheet lets straight through is looked up by shadow rays at its finest: a path that may
 * find the same light beside them sees the same. */
static void see_sheet_as_shadow_rays_do(const ppmi_walker *walker, ppmi_vertex *vertex)
{
    if (!walker->differential.is_scattered || !vertex->surface.material->is_sheet) return;
    vertex->surface.uv_dx = vertex->surface.uv_dy = (ppmi_vec2){0.0f, 0.0f};
}

static ppmi_arrival walk(ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind, ppmi_vertex *vertex,
                         scatter_choice *choice)
{
    const ppmi_arrival arrival = follow(walker, ray, kind, vertex, choice);
    if (!walker->differential.is_known) return arrival;
    if (arrival == PPMI_AT_SURFACE) {
        ppmi_differential_meet(&walker->differential, vertex->distance, &vertex->surface);
        see_sheet_as_shadow_rays_do(walker, vertex);
    } else if (arrival == PPMI_IN_MEDIUM) {
        ppmi_differential_advance(&walker->differential, vertex->distance);
    }
    return arrival;
}

ppmi_arrival ppmi_walk(ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind,
                       ppmi_vertex *out_vertex)
{
    return walk(walker, ray, kind, out_vertex, NULL);
}

ppmi_arrival ppmi_walk_both_ways(ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind,
                                 ppmi_vertex *out_vertex, ppmi_vertex *out_scattered,
                                 uint32_t count)
{
    scatter_choice choice = {.vertices = out_scattered, .count = count};
    for (uint32_t i = 0; i < count; i++)
        out_scattered[i].medium = NULL;
    const ppmi_arrival arrival = walk(walker, ray, kind, out_vertex, &choice);
    for (uint32_t i = 0; i < count; i++) {
        if (!out_scattered[i].medium) continue;
        out_scattered[i].transmittance =
            vec3_scale(out_scattered[i].transmittance, choice.mass / choice.kept_mass[i]);
    }
    return arrival;
}

static ppmi_vec3 media_transmittance(const ppmi_world *world, const ppmi_interior *interior,
                                     const ppmi_ray *ray, float t_max)
{
    if (!world->has_fog && interior->count == 0) return vec3_splat(1.0f);
    const ppmi_medium_span span = ppmi_media_span(world, interior, ray, t_max);
    return span.medium ? ppmi_medium_transmittance(span.medium, span.end - span.begin)
                       : vec3_splat(1.0f);
}

ppmi_vec3 ppmi_walk_visibility(ppmi_walker *walker, ppmi_ray ray, const ppmi_interior *interior)
{
    walker->rays++;
    const ppmi_vec3 visibility = ppmi_passing_visibility(walker->world, &ray);
    if (vec3_is_black(visibility)) return visibility;
    return vec3_mul(media_transmittance(walker->world, interior, &ray, ray.t_max), visibility);
}

/* From surface to light. Both ends are moved off their surfaces; what is left of rounding grows
 * with the distance, and is taken off it. */
static ppmi_ray shadow_ray(const ppmi_surface *surface, const ppmi_light_sample *light)
{
    const float rounding = 4e-6f;
    ppmi_ray ray = ppmi_surface_ray(surface, light->wi);
    if (light->is_far) return ray;
    const ppmi_vec3 way = vec3_sub(light->target, ray.origin);
    const float distance = vec3_length(way);
    if (!(distance > 0.0f)) return ray;
    ray.direction = vec3_scale(way, 1.0f / distance);
    ray.t_max = distance * (1.0f - rounding);
    return ray;
}

/* What is on the side of a vertex that wi points to, and what a path costs that goes there. */
static const ppmi_interior *interior_towards(const ppmi_walker *walker, const ppmi_vertex *vertex,
                                             const ppmi_bsdf *bsdf, ppmi_vec3 wi,
                                             ppmi_vec3 *out_weight)
{
    *out_weight = vec3_splat(1.0f);
    const bool is_transmission = !vertex->medium && vertex->surface.material->is_solid_glass &&
                                 vec3_dot(wi, bsdf->ng) < 0.0f;
    if (vertex->drawn_wavelength > 0.0f && (is_transmission || vertex->splits_always)) {
        *out_weight = ppmi_spectrum_weight(walker->world->spectrum, vertex->drawn_wavelength);
    }
    return is_transmission ? &vertex->behind : &walker->interior;
}

ppmi_vec3 ppmi_walk_light_visibility(ppmi_walker *walker, const ppmi_vertex *vertex,
                                     const ppmi_bsdf *bsdf, const ppmi_light_sample *light)
{
    ppmi_vec3 weight;
    const ppmi_interior *interior = interior_towards(walker, vertex, bsdf, light->wi, &weight);
    return ppmi_walk_visibility(walker, shadow_ray(&vertex->surface, light), interior);
}

typedef struct light_numbers {
    double u_pick;
    float u, v;
} light_numbers;

/* The second turn takes the first one's choice further, and what is rare is not stratified. */
static light_numbers draw_numbers(ppmi_walker *walker, ppmi_light_turn *turn)
{
    light_numbers numbers;
    if (turn->has_another) {
        numbers.u_pick = turn->u_pick + 1.0;
        numbers.u = ppmi_rng_float(&walker->rng);
        numbers.v = ppmi_rng_float(&walker->rng);
    } else {
        numbers.u_pick = turn->u_pick = ppmi_walker_double(walker);
        numbers.u = ppmi_walker_float(walker);
        numbers.v = ppmi_walker_float(walker);
    }
    return numbers;
}

ppmi_vec3 ppmi_walk_light_sample_of(ppmi_walker *walker, const ppmi_vertex *vertex,
                                    const ppmi_bsdf *bsdf, ppmi_light_turn *turn, ppmi_lit *out_lit)
{
    const ppmi_vec3 black = vec3_splat(0.0f);
    if ((bsdf->lobes & ~bsdf->delta_lobes) == 0) return black;
    const ppmi_world *world = walker->world;
    const light_numbers numbers = draw_numbers(walker, turn);
    const ppmi_receiver receiver = ppmi_walk_receiver(vertex, bsdf);
    ppmi_light_sample light;
    const bool is_lit = ppmi_lights_sample_at(world->lights, &receiver, walker->time,
                                              numbers.u_pick, numbers.u, numbers.v, &light);
    turn->has_another = light.has_another;
    if (!is_lit) return black;
    const ppmi_vec3 f =
        ppmi_bsdf_eval(bsdf, world->albedo, light.wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE);
    if (vec3_is_black(f)) return black;
    ppmi_vec3 weight;
    const ppmi_interior *interior = interior_towards(walker, vertex, bsdf, light.wi, &weight);
    const ppmi_ray ray = shadow_ray(&vertex->surface, &light);
    const ppmi_vec3 visibility = ppmi_walk_visibility(walker, ray, interior);
    if (vec3_is_black(visibility)) return black;
    const float bsdf_pdf = light.is_delta ? 0.0f : ppmi_bsdf_pdf(bsdf, light.wi, PPMI_LOBE_ALL);
    const float scale =
        fabsf(ppmi_bsdf_cosine(bsdf, light.wi)) * ppmi_mis_weight(light.pdf, bsdf_pdf) / light.pdf;
    weight = vec3_mul(weight, vec3_scale(visibility, scale));
    if (out_lit) *out_lit = (ppmi_lit){light, vec3_mul(f, weight)};
    return vec3_mul(vec3_mul(f, light.radiance), weight);
}

void ppmi_walk_bsdf(const ppmi_walker *walker, const ppmi_vertex *vertex, ppmi_vec3 direction,
                    ppmi_bsdf *out_bsdf)
{
    if (vertex->medium) {
        ppmi_bsdf_make_phase(vertex->medium, vec3_neg(direction), out_bsdf);
        return;
    }
    ppmi_material_point point;
    ppmi_material_evaluate(walker->world->scene, &vertex->surface, &point);
    point.relative_index = vertex->relative_index;
    ppmi_bsdf_make(walker->world->albedo, &vertex->surface, &point, vec3_neg(direction), out_bsdf);
}

void ppmi_walk_bsdf_from(const ppmi_walker *walker, const ppmi_vertex *vertex,
                         const ppmi_bsdf *bsdf, ppmi_vec3 wo, ppmi_bsdf *out_bsdf)
{
    ppmi_material_point point;
    ppmi_material_evaluate(walker->world->scene, &vertex->surface, &point);
    point.relative_index = vertex->relative_index;
    if (point.relative_index > 0.0f && vec3_dot(wo, bsdf->ng) < 0.0f) {
        point.relative_index = 1.0f / point.relative_index;
    }
    ppmi_bsdf_make(walker->world->albedo, &vertex->surface, &point, wo, out_bsdf);
}

/* How neighbouring rays leave. */
__attribute__((noinline)) static void leave_with_neighbours(ppmi_walker *walker,
                                                            const ppmi_vertex *vertex,
                                                            const ppmi_bsdf_sample *sample)
{
    ppmi_differential *differential = &walker->differential;
    if (!sample->is_delta) {
        ppmi_differential_scatter(differential, sample->wi, sample->pdf);
    } else if (!sample->is_transmission) {
        ppmi_differential_reflect(differential, &vertex->surface, sample->wi);
    } else if (vertex->surface.material->is_solid_glass) {
        ppmi_differential_refract(differential, &vertex->surface, vertex->relative_index,
                                  sample->wi);
    }
    differential->direction = sample->wi;
}

ppmi_ray ppmi_walk_leave(ppmi_walker *walker, const ppmi_vertex *vertex,
                         const ppmi_bsdf_sample *sample, ppmi_vec3 *throughput)
{
    const ppmi_ray ray = ppmi_surface_ray(&vertex->surface, sample->wi);
    if (walker->differential.is_known) leave_with_neighbours(walker, vertex, sample);
    if (vertex->medium || !vertex->surface.material->is_solid_glass) return ray;
    if (sample->is_transmission) walker->interior = vertex->behind;
    if (vertex->drawn_wavelength > 0.0f && (sample->is_transmission || vertex->splits_always)) {
        walker->wavelength_nm = vertex->drawn_wavelength;
        *throughput = vec3_mul(
            *throughput, ppmi_spectrum_weight(walker->world->spectrum, vertex->drawn_wavelength));
    }
    return ray;
}

/* Emission has one radiance for all ways of finding it: light sampling and photons see textures at
 * their finest, and where a path may find it beside them it sees the same, or the weights of MIS
 * would stand for different things. What is seen from the camera by mirrors alone is found in one
 * way only, and is filtered over the pixel as other textures are. */
static ppmi_vec3 emission_seen(const ppmi_walker *walker, const ppmi_surface *surface, ppmi_vec3 wo,
                               bool is_delta)
{
    const ppm_scene *scene = walker->world->scene;
    if (!walker->differential.is_known || (is_delta && !walker->differential.is_scattered)) {
        return ppmi_surface_emission(scene, surface, wo);
    }
    ppmi_surface finest = *surface;
    finest.uv_dx = finest.uv_dy = (ppmi_vec2){0.0f, 0.0f};
    return ppmi_surface_emission(scene, &finest, wo);
}

ppmi_vec3 ppmi_walk_emission(const ppmi_walker *walker, const ppmi_vertex *vertex,
                             ppmi_vec3 direction, const ppmi_origin *origin)
{
    const ppmi_world *world = walker->world;
    if (!vertex->surface.material->emits) return vec3_splat(0.0f);
    const ppmi_vec3 radiance =
        emission_seen(walker, &vertex->surface, vec3_neg(direction), origin->is_delta);
    if (origin->is_delta || vec3_is_black(radiance)) {
        return vec3_scale(radiance, left_by_photons(world, origin, radiance));
    }
    const float light_pdf =
        ppmi_lights_pdf_surface(world->lights, &origin->receiver, &vertex->hit, &vertex->surface,
                                direction, origin->distance + vertex->distance);
    return vec3_scale(radiance, ppmi_mis_weight(origin->pdf, light_pdf));
}

ppmi_vec3 ppmi_walk_environment_weighed(const ppmi_walker *walker, ppmi_vec3 direction,
                                        const ppmi_origin *origin, float *out_weight)
{
    const ppmi_lights *lights = walker->world->lights;
    const ppmi_vec3 radiance = ppmi_lights_environment(lights, direction);
    *out_weight = left_by_photons(walker->world, origin, radiance);
    if (origin->is_delta || vec3_is_black(radiance)) return vec3_scale(radiance, *out_weight);
    const float light_pdf = ppmi_lights_pdf_environment(lights, &origin->receiver, direction);
    *out_weight = ppmi_mis_weight(origin->pdf, light_pdf);
    return vec3_scale(radiance, *out_weight);
}
