/* The eye pass of stochastic progressive photon mapping (Hachisuka and Jensen 2009).
 *
 * The choice between gathering and going on is made lobe by lobe: at each surface the path draws
 * either the group of lobes that gather (and ends there) or the group that goes on, by their
 * albedos. A plastic thus shows its diffuse base by photons and its reflections by tracing. */
#include "photon/eye.h"

/* Paths are not ended by chance before this depth: chains of glass need them. */
enum { ROULETTE_DEPTH = 6 };

typedef struct eye_state {
    ppmi_ray ray;
    ppmi_origin origin;
    ppmi_vec3 throughput;       /* for what the path meets next by going on */
    ppmi_vec3 light_throughput; /* for emission that it meets next: all lobes, not the group's */
    ppmi_vec3 radiance;
    float cone_width, cone_spread;
} eye_state;

static void add(eye_state *state, ppmi_vec3 throughput, ppmi_vec3 radiance)
{
    state->radiance = vec3_add(state->radiance, vec3_mul(throughput, radiance));
}

/* Side of a square with the area of the pixel's footprint on the surface. */
static float footprint(const eye_state *state, const ppmi_bsdf *bsdf)
{
    const float cosine = fabsf(vec3_dot(state->ray.direction, bsdf->ng));
    return state->cone_width / sqrtf(ppmi_max(cosine, 0.1f));
}

static void record(const eye_state *state, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                   float probability, ppmi_visible_points *points, uint32_t i)
{
    points->is_valid[i] = 1;
    points->x[i] = vertex->surface.position.x;
    points->y[i] = vertex->surface.position.y;
    points->z[i] = vertex->surface.position.z;
    points->footprint[i] = footprint(state, bsdf);
    points->throughput[i] = vec3_scale(state->throughput, 1.0f / probability);
    points->bsdf[i] = *bsdf;
}

/* The other half of MIS where the path ends: a direction from the gathering lobes may meet a light.
 */
static void add_bsdf_sampled_light(ppmi_walker *walker, eye_state *state, const ppmi_vertex *vertex,
                                   const ppmi_bsdf *bsdf)
{
    const float u_lobe = ppmi_walker_float(walker), u = ppmi_walker_float(walker),
                v = ppmi_walker_float(walker);
    ppmi_bsdf_sample sample;
    if (!ppmi_bsdf_draw(bsdf, walker->world->albedo, bsdf->gather_lobes, PPMI_TRANSPORT_RADIANCE,
                        u_lobe, u, v, &sample)) {
        return;
    }
    const ppmi_vec3 f = ppmi_bsdf_eval(bsdf, walker->world->albedo, sample.wi, PPMI_LOBE_ALL,
                                       PPMI_TRANSPORT_RADIANCE);
    const float pdf = ppmi_bsdf_pdf(bsdf, sample.wi, PPMI_LOBE_ALL);
    if (!(pdf > 0.0f)) return;
    const ppmi_origin origin = {.pdf = pdf, .normal = bsdf->frame.n};
    const float cosine = fabsf(ppmi_bsdf_cosine(bsdf, sample.wi));
    const ppmi_vec3 throughput = vec3_mul(state->throughput, vec3_scale(f, cosine / pdf));
    ppmi_vertex next;
    const ppmi_ray ray = ppmi_surface_ray(&vertex->surface, sample.wi);
    if (ppmi_walk_to_surface(walker, ray, PPMI_RAY_OTHER, &next)) {
        add(state, vec3_mul(throughput, next.transmittance),
            ppmi_walk_emission(walker, &next, sample.wi, &origin));
    } else {
        add(state, throughput, ppmi_walk_environment(walker, sample.wi, &origin));
    }
}

/* Goes on by the lobes that do not gather. Emission met next is weighed with all lobes and their
 * full density, since light sampling here stood for all of them. */
static bool go_on(ppmi_walker *walker, eye_state *state, const ppmi_vertex *vertex,
                  const ppmi_bsdf *bsdf, uint32_t mask, float probability)
{
    const ppmi_albedo_table *albedo = walker->world->albedo;
    const float u_lobe = ppmi_walker_float(walker), u = ppmi_walker_float(walker),
                v = ppmi_walker_float(walker);
    ppmi_bsdf_sample sample;
    if (!ppmi_bsdf_draw(bsdf, albedo, mask, PPMI_TRANSPORT_RADIANCE, u_lobe, u, v, &sample)) {
        return false;
    }
    const ppmi_vec3 weight = vec3_scale(sample.weight, 1.0f / probability);
    state->light_throughput = state->throughput;
    state->throughput = vec3_mul(state->throughput, weight);
    state->origin = (ppmi_origin){.is_delta = sample.is_delta, .normal = bsdf->frame.n};
    if (sample.is_delta) {
        state->light_throughput = state->throughput;
    } else {
        state->origin.pdf = ppmi_bsdf_pdf(bsdf, sample.wi, PPMI_LOBE_ALL);
        const ppmi_vec3 f =
            ppmi_bsdf_eval(bsdf, albedo, sample.wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE);
        const float cosine = fabsf(ppmi_bsdf_cosine(bsdf, sample.wi));
        state->light_throughput =
            vec3_mul(state->light_throughput, vec3_scale(f, cosine / state->origin.pdf));
    }
    state->ray = ppmi_surface_ray(&vertex->surface, sample.wi);
    return true;
}

static bool survives_roulette(ppmi_walker *walker, eye_state *state, uint32_t depth)
{
    if (depth < ROULETTE_DEPTH) return true;
    const float survival = ppmi_min(1.0f, vec3_max_component(state->throughput));
    if (ppmi_rng_float(&walker->rng) >= survival) return false;
    state->throughput = vec3_scale(state->throughput, 1.0f / survival);
    state->light_throughput = vec3_scale(state->light_throughput, 1.0f / survival);
    return true;
}

ppmi_vec3 ppmi_eye_path(ppmi_walker *walker, const ppmi_camera_ray *camera_ray, uint32_t max_depth,
                        ppmi_visible_points *points, uint32_t i)
{
    eye_state state = {
        .ray = camera_ray->ray,
        .origin = {.is_delta = true},
        .throughput = vec3_splat(1.0f),
        .light_throughput = vec3_splat(1.0f),
        .cone_width = camera_ray->base_width,
        .cone_spread = camera_ray->spread,
    };
    points->is_valid[i] = 0;
    for (uint32_t depth = 0; depth < max_depth; depth++) {
        ppmi_vertex vertex;
        const ppmi_ray_kind kind = depth == 0 ? PPMI_RAY_CAMERA : PPMI_RAY_OTHER;
        if (!ppmi_walk_to_surface(walker, state.ray, kind, &vertex)) {
            if (depth == 0) return ppmi_lights_backdrop(walker->world->lights, state.ray.direction);
            add(&state, state.light_throughput,
                ppmi_walk_environment(walker, state.ray.direction, &state.origin));
            break;
        }
        state.cone_width += state.cone_spread * vertex.distance;
        state.throughput = vec3_mul(state.throughput, vertex.transmittance);
        state.light_throughput = vec3_mul(state.light_throughput, vertex.transmittance);
        add(&state, state.light_throughput,
            ppmi_walk_emission(walker, &vertex, state.ray.direction, &state.origin));
        if (!survives_roulette(walker, &state, depth)) break;

        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(walker, &vertex, state.ray.direction, &bsdf);
        if (bsdf.lobes == 0) break;
        add(&state, state.throughput, ppmi_walk_light_sample(walker, &vertex.surface, &bsdf));
        const float gathering = ppmi_bsdf_probability(&bsdf, bsdf.gather_lobes);
        if (gathering > 0.0f && ppmi_walker_float(walker) < gathering) {
            add_bsdf_sampled_light(walker, &state, &vertex, &bsdf);
            record(&state, &vertex, &bsdf, gathering, points, i);
            break;
        }
        const uint32_t others = (uint32_t)(bsdf.lobes & ~bsdf.gather_lobes);
        if (!go_on(walker, &state, &vertex, &bsdf, others, 1.0f - gathering)) break;
    }
    return state.radiance;
}
