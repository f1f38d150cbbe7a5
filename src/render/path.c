/* The yardstick: a unidirectional path tracer with light sampling, multiple importance sampling and
 * Russian roulette (Kajiya 1986; Veach 1997, chapters 9 and 10). */
#include <omp.h>

#include "render/light_film.h"
#include "transport/roulette.h"

enum { ROULETTE_DEPTH = 4 };

/* Sums over passes, RGB per pixel; a pass adds to a copy, so that a cancelled one leaves no trace.
 */
typedef struct path_state {
    ppmi_vec3 *sums, *next_sums;
    ppmi_light_film layers;
} path_state;

/* A path on its way. */
typedef struct path_trace {
    ppmi_walker *walker;
    const ppmi_light_sink *sink; /* NULL: no layers are wanted */
    ppmi_eye_history history;    /* where there is a sink */
    ppmi_vec3 radiance;
} path_trace;

static void path_destroy(const ppmi_job *job, void *opaque)
{
    path_state *state = opaque;
    if (!state) return;
    ppmi_free(job->context, state->sums);
    ppmi_free(job->context, state->next_sums);
    ppmi_light_film_deinit(job, &state->layers);
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
    const ppm_status status = ppmi_light_film_init(job, 1, &state->layers);
    if (status != PPM_STATUS_OK) {
        path_destroy(job, state);
        return status;
    }
    *out_state = state;
    return PPM_STATUS_OK;
}

/* eta_scale: of the throughput by refraction; a path in glass is not worth less for it. */
static bool survives(ppmi_walker *walker, ppmi_vec3 *throughput, float eta_scale, uint32_t depth)
{
    if (depth < ROULETTE_DEPTH) return true;
    const float survival = ppmi_roulette_survival(vec3_max_component(*throughput) / eta_scale,
                                                  depth, PPMI_ROULETTE_OF_EYE);
    if (ppmi_rng_float(&walker->rng) >= survival) return false;
    *throughput = vec3_scale(*throughput, 1.0f / survival);
    return true;
}

/* To the path's next vertex. */
static ppmi_arrival walk(path_trace *path, ppmi_ray ray, uint32_t depth, ppmi_vec3 throughput,
                         const ppmi_origin *origin, ppmi_vertex *vertex)
{
    ppmi_walker *walker = path->walker;
    ppmi_lamp_deposit deposit;
    const ppmi_ray_kind kind = depth == 0 ? PPMI_RAY_CAMERA : PPMI_RAY_OTHER;
    walker->origin = origin;
    if (path->sink) {
        ppmi_lamp_deposit_begin(&deposit, walker, path->sink, &path->history, throughput);
    }
    const ppmi_arrival arrival = ppmi_walk(walker, ray, kind, vertex);
    walker->origin = NULL;
    walker->lamp_witness = NULL;
    const ppmi_vec3 light = vec3_mul(throughput, vertex->lamplight);
    path->radiance = vec3_add(path->radiance, light);
    if (path->sink) {
        ppmi_light_sink_add_classes(path->sink, &path->history, PPM_LAYER_EMISSION, light);
    }
    return arrival;
}

/* The path ends in what the camera sees behind everything. */
static void see_backdrop(path_trace *path, ppmi_vec3 direction, ppmi_vec3 throughput)
{
    const ppmi_light_sink *sink = path->sink;
    if (sink && sink->is_transparent) {
        sink->seen->through += vec3_mean(throughput);
        return;
    }
    const ppmi_vec3 light =
        vec3_mul(throughput, ppmi_lights_backdrop(path->walker->world->lights, direction));
    path->radiance = vec3_add(path->radiance, light);
    if (sink) ppmi_light_sink_add_backdrop(sink, &path->history, direction, throughput, light);
}

static void escape(path_trace *path, ppmi_vec3 direction, uint32_t depth, ppmi_vec3 throughput,
                   const ppmi_origin *origin)
{
    if (depth == 0) {
        see_backdrop(path, direction, throughput);
        return;
    }
    float mis;
    const ppmi_vec3 light =
        vec3_mul(throughput, ppmi_walk_environment_weighed(path->walker, direction, origin, &mis));
    path->radiance = vec3_add(path->radiance, light);
    if (path->sink) {
        ppmi_light_sink_add_far(path->sink, &path->history, direction, vec3_scale(throughput, mis),
                                light);
    }
}

static void add_emission(path_trace *path, const ppmi_vertex *vertex, ppmi_vec3 direction,
                         ppmi_vec3 throughput, const ppmi_origin *origin)
{
    const ppmi_vec3 light =
        vec3_mul(throughput, ppmi_walk_emission(path->walker, vertex, direction, origin));
    path->radiance = vec3_add(path->radiance, light);
    if (path->sink) ppmi_light_sink_add_emission(path->sink, &path->history, vertex, light);
}

static void sample_light(path_trace *path, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                         ppmi_vec3 throughput)
{
    ppmi_light_turn turn = {0};
    do {
        ppmi_lit lit;
        const ppmi_vec3 light = vec3_mul(
            throughput, ppmi_walk_light_sample_of(path->walker, vertex, bsdf, &turn, &lit));
        path->radiance = vec3_add(path->radiance, light);
        if (path->sink && !vec3_is_black(light)) {
            ppmi_light_sink_add_sample(path->sink, &path->history, bsdf,
                                       path->walker->world->albedo, &lit, throughput, light);
        }
    } while (turn.has_another);
}

static void trace_path(path_trace *path, ppmi_ray ray, uint32_t max_depth)
{
    ppmi_walker *walker = path->walker;
    ppmi_vec3 throughput = vec3_splat(1.0f);
    ppmi_origin origin = {.is_delta = true};
    float eta_scale = 1.0f;
    for (uint32_t depth = 0; depth < max_depth; depth++) {
        ppmi_vertex vertex;
        const ppmi_arrival arrival = walk(path, ray, depth, throughput, &origin, &vertex);
        throughput = vec3_mul(throughput, vertex.transmittance);
        if (arrival == PPMI_ESCAPED) {
            escape(path, ray.direction, depth, throughput, &origin);
            return;
        }
        if (arrival == PPMI_AT_SURFACE) {
            if (depth == 0 && path->sink) ppmi_light_sink_see(path->sink, walker->world, &vertex);
            add_emission(path, &vertex, ray.direction, throughput, &origin);
        }
        if (!survives(walker, &throughput, eta_scale, depth)) return;

        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(walker, &vertex, ray.direction, &bsdf);
        sample_light(path, &vertex, &bsdf, throughput);
        const float u_lobe = ppmi_walker_float(walker);
        const float u = ppmi_walker_float(walker), v = ppmi_walker_float(walker);
        ppmi_bsdf_sample sample;
        if (!ppmi_bsdf_draw(&bsdf, walker->world->albedo, PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE,
                            u_lobe, u, v, &sample)) {
            return;
        }
        throughput = vec3_mul(throughput, sample.weight);
        eta_scale *= sample.eta_scale;
        origin = ppmi_bsdf_goes_straight(&bsdf, &sample)
                     ? ppmi_origin_beyond(&origin, &vertex)
                     : (ppmi_origin){.receiver = ppmi_walk_receiver(&vertex, &bsdf),
                                     .pdf = sample.pdf,
                                     .is_delta = sample.is_delta};
        ray = ppmi_walk_leave(walker, &vertex, &sample, &throughput);
        if (path->sink) {
            ppmi_eye_history_scatter(&path->history, &bsdf, walker->world->albedo, sample.wi,
                                     PPMI_LOBE_ALL, sample.is_delta);
        }
    }
}

/* A path of a pixel. Returns what it adds to the picture; pass gets what it adds to layers. */
static ppmi_vec3 render_pixel(const ppmi_job *job, path_state *state, ppmi_walker *walker,
                              ppmi_ray ray, ppmi_light_pass *pass)
{
    path_trace path = {.walker = walker};
    ppmi_light_sink sink;
    ppmi_vec3 *planes = NULL;
    if (ppmi_light_film_is_kept(&state->layers)) {
        planes = ppmi_light_film_clear_scratch(&state->layers);
        sink = ppmi_light_film_sink(&state->layers, planes, &pass->seen);
        path.sink = &sink;
        pass->planes = planes;
    }
    trace_path(&path, ray, job->options->max_depth);
    if (!vec3_is_finite(path.radiance)) {
        path.radiance = vec3_splat(0.0f);
        if (planes) ppmi_light_film_clear_scratch(&state->layers);
    }
    return path.radiance;
}

static void render_tile(const ppmi_job *job, path_state *state, uint32_t index, uint64_t pass,
                        uint64_t *rays)
{
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    ppmi_walker walker = {.world = &job->world};
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            if (ppmi_job_is_cancelled(job)) return;
            const ppmi_camera_ray camera_ray = ppmi_start_camera_path(job, &walker, x, y, pass);
            ppmi_light_pass light = {0};
            const size_t pixel = (size_t)y * job->film.width + x;
            light.combined = render_pixel(job, state, &walker, camera_ray.ray, &light);
            state->next_sums[pixel] = vec3_add(state->sums[pixel], light.combined);
            if (ppmi_light_film_is_kept(&state->layers)) {
                ppmi_light_film_add(&state->layers, pixel, pass, &light);
            }
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
    ppmi_light_film_commit(&state->layers);
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
        rgba[4 * i + 3] = ppmi_light_film_alpha(&state->layers, i, passes);
    }
}

static void path_read_layer(const ppmi_job *job, const void *opaque, int32_t kind, uint32_t number,
                            uint64_t passes, float *values)
{
    const path_state *state = opaque;
    ppmi_light_film_read(job, &state->layers, kind, number, passes, values);
}

const ppmi_integrator ppmi_integrator_path = {
    .name = "path",
    .create = path_create,
    .destroy = path_destroy,
    .pass = path_pass,
    .resolve = path_resolve,
    .read_layer = path_read_layer,
};
