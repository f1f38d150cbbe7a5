/* The yardstick: a unidirectional path tracer with light sampling, multiple importance sampling and
 * Russian roulette (Kajiya 1986; Veach 1997, chapters 9 and 10). */
#include <omp.h>

#include "render/integrator.h"

enum { ROULETTE_DEPTH = 4 };

/* Sums over passes, RGB per pixel; a pass adds to a copy, so that a cancelled one leaves no trace.
 */
typedef struct path_state {
    ppmi_vec3 *sums, *next_sums;
} path_state;

static void path_destroy(const ppmi_job *job, void *opaque)
{
    path_state *state = opaque;
    if (!state) return;
    ppmi_free(job->context, state->sums);
    ppmi_free(job->context, state->next_sums);
    ppmi_free(job->context, state);
}

static ppm_status path_create(const ppmi_job *job, void **out_state)
{
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    path_state *state = ppmi_alloc_zeroed(job->context, 1, sizeof *state);
    if (state) {
        state->sums = ppmi_alloc_zeroed(job->context, pixels, sizeof *state->sums);
        state->next_sums = ppmi_alloc_zeroed(job->context, pixels, sizeof *state->next_sums);
    }
    if (!state || !state->sums || !state->next_sums) {
        path_destroy(job, state);
        return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu pixels",
                         pixels);
    }
    *out_state = state;
    return PPM_STATUS_OK;
}

/* eta_scale: of the throughput by refraction; a path in glass is not worth less for it. */
static bool survives(ppmi_walker *walker, ppmi_vec3 *throughput, float eta_scale, uint32_t depth)
{
    if (depth < ROULETTE_DEPTH) return true;
    const float survival = ppmi_min(1.0f, vec3_max_component(*throughput) / eta_scale);
    if (ppmi_rng_float(&walker->rng) >= survival) return false;
    *throughput = vec3_scale(*throughput, 1.0f / survival);
    return true;
}

static ppmi_vec3 sky(const ppmi_walker *walker, ppmi_vec3 direction, uint32_t depth,
                     const ppmi_origin *origin)
{
    return depth == 0 ? ppmi_lights_backdrop(walker->world->lights, direction)
                      : ppmi_walk_environment(walker, direction, origin);
}

static ppmi_vec3 trace_path(ppmi_walker *walker, ppmi_ray ray, uint32_t max_depth)
{
    ppmi_vec3 radiance = vec3_splat(0.0f), throughput = vec3_splat(1.0f);
    ppmi_origin origin = {.is_delta = true};
    float eta_scale = 1.0f;
    for (uint32_t depth = 0; depth < max_depth; depth++) {
        ppmi_vertex vertex;
        const ppmi_ray_kind kind = depth == 0 ? PPMI_RAY_CAMERA : PPMI_RAY_OTHER;
        walker->origin = &origin;
        const ppmi_arrival arrival = ppmi_walk(walker, ray, kind, &vertex);
        walker->origin = NULL;
        radiance = vec3_add(radiance, vec3_mul(throughput, vertex.lamplight));
        throughput = vec3_mul(throughput, vertex.transmittance);
        if (arrival == PPMI_ESCAPED) {
            const ppmi_vec3 light = sky(walker, ray.direction, depth, &origin);
            return vec3_add(radiance, vec3_mul(throughput, light));
        }
        if (arrival == PPMI_AT_SURFACE) {
            const ppmi_vec3 emission = ppmi_walk_emission(walker, &vertex, ray.direction, &origin);
            radiance = vec3_add(radiance, vec3_mul(throughput, emission));
        }
        if (!survives(walker, &throughput, eta_scale, depth)) return radiance;

        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(walker, &vertex, ray.direction, &bsdf);
        const ppmi_vec3 light = ppmi_walk_light_sample(walker, &vertex, &bsdf);
        radiance = vec3_add(radiance, vec3_mul(throughput, light));
        const float u_lobe = ppmi_walker_float(walker);
        const float u = ppmi_walker_float(walker), v = ppmi_walker_float(walker);
        ppmi_bsdf_sample sample;
        if (!ppmi_bsdf_draw(&bsdf, walker->world->albedo, PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE,
                            u_lobe, u, v, &sample)) {
            return radiance;
        }
        throughput = vec3_mul(throughput, sample.weight);
        eta_scale *= sample.eta_scale;
        origin = (ppmi_origin){.position = vertex.surface.position,
                               .pdf = sample.pdf,
                               .normal = ppmi_bsdf_normal(&bsdf),
                               .is_delta = sample.is_delta};
        ray = ppmi_walk_leave(walker, &vertex, &sample, &throughput);
    }
    return radiance;
}

static void render_tile(const ppmi_job *job, path_state *state, uint32_t index, uint64_t pass,
                        uint64_t *rays)
{
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    ppmi_walker walker = {.world = &job->world};
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            const ppmi_camera_ray camera_ray = ppmi_start_camera_path(job, &walker, x, y, pass);
            const ppmi_vec3 radiance = trace_path(&walker, camera_ray.ray, job->options->max_depth);
            const size_t pixel = (size_t)y * job->film.width + x;
            state->next_sums[pixel] = vec3_is_finite(radiance)
                                          ? vec3_add(state->sums[pixel], radiance)
                                          : state->sums[pixel];
        }
    }
    *rays += walker.rays;
}

static ppm_status path_pass(const ppmi_job *job, void *opaque, uint64_t pass,
                            ppm_render_stats *stats)
{
    path_state *state = opaque;
    const double start = omp_get_wtime();
    const uint32_t tiles = ppmi_tile_count(&job->film);
    uint64_t rays = 0;
#pragma omp parallel for num_threads((int)job->options->threads) schedule(dynamic, 1)             \
    reduction(+ : rays)
    for (uint32_t i = 0; i < tiles; i++) {
        if (!atomic_load_explicit(job->cancel, memory_order_relaxed)) {
            render_tile(job, state, i, pass, &rays);
        }
    }
    if (atomic_load(job->cancel)) return PPM_STATUS_CANCELLED;
    ppmi_vec3 *sums = state->sums;
    state->sums = state->next_sums;
    state->next_sums = sums;
    stats->rays += rays;
    stats->eye_paths += ppmi_film_pixel_count(&job->film);
    stats->seconds_eye += omp_get_wtime() - start;
    return PPM_STATUS_OK;
}

static void path_resolve(const ppmi_job *job, const void *opaque, uint64_t passes, float *rgba)
{
    const path_state *state = opaque;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    for (size_t i = 0; i < pixels; i++) {
        vec3_store(rgba + 4 * i, vec3_scale(state->sums[i], 1.0f / (float)passes));
        rgba[4 * i + 3] = 1.0f;
    }
}

const ppmi_integrator ppmi_integrator_path = {
    .name = "path",
    .create = path_create,
    .destroy = path_destroy,
    .pass = path_pass,
    .resolve = path_resolve,
};
