/* Stochastic progressive photon mapping (Hachisuka and Jensen 2009): a photon pass, an eye pass
 * with new paths through each pixel, and statistics that belong to the pixel.
 *
 * Radii are kept in units of the pixel's footprint at each eye vertex, so that one statistic serves
 * a pixel whose paths end near and far (edges, mirrors). With side p of the footprint, scale s and
 * M photons within s p of the vertex that bring tauM:
 *
 *     N' = N + alpha M,  g = N' / (N + M),  s' = s sqrt(g),  tau' = (tau + tauM / p^2) g
 *     L  = L_direct + tau / (photons emitted * pi s^2)
 */
#include <omp.h>

#include "photon/eye.h"
#include "photon/walk.h"
#include "render/integrator.h"

/* First radius, in sides of the pixel's footprint, and how often its disk may double in area where
 * a pilot pass finds fewer photons than this: smooth light may be averaged over more than a
 * caustic, which has photons enough within a few pixels. */
static const float first_scale = 3.0f;
enum { PILOT_DOUBLINGS = 6, PILOT_PHOTONS = 16 };

/* No radius is larger than this share of the scene's bounding sphere. */
static const float largest_share = 0.05f;

/* The pilot's paths: a pass number that no pass reaches. */
#define PILOT_PASS (UINT64_MAX >> 24)

typedef struct pixel_statistics {
    ppmi_vec3 direct; /* sum over passes of what needs no photons */
    ppmi_vec3 tau;    /* flux by footprint area */
    float count;      /* N */
    float scale;      /* s */
} pixel_statistics;

typedef struct sppm_state {
    pixel_statistics *pixels, *next_pixels; /* a pass reads the first and writes the second */
    ppmi_visible_points *points;            /* one a thread, for a tile each */
    ppmi_photon_list photons;
    ppmi_photon_scratch scratch;
    ppmi_photon_grid grid;
    float first_radius; /* typical small one, metres */
    float largest_radius;
    bool has_pilot;
} sppm_state;

/* What one pass's tiles add up to. */
typedef struct tile_totals {
    uint64_t rays;
    double seconds_eye, seconds_gather; /* of all threads */
} tile_totals;

static void sppm_destroy(const ppmi_job *job, void *opaque)
{
    sppm_state *state = opaque;
    if (!state) return;
    ppmi_free(job->context, state->pixels);
    ppmi_free(job->context, state->next_pixels);
    for (uint32_t i = 0; state->points && i < job->options->threads; i++) {
        ppmi_visible_points_deinit(job->context, &state->points[i]);
    }
    ppmi_free(job->context, state->points);
    ppmi_photon_list_deinit(job->context, &state->photons);
    ppmi_photon_scratch_deinit(job->context, &state->scratch);
    ppmi_photon_grid_deinit(job->context, &state->grid);
    ppmi_free(job->context, state);
}

static ppm_status allocate(const ppmi_job *job, sppm_state *state)
{
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    state->pixels = ppmi_alloc_zeroed(job->context, pixels, sizeof *state->pixels);
    state->next_pixels = ppmi_alloc_zeroed(job->context, pixels, sizeof *state->next_pixels);
    state->points = ppmi_alloc_zeroed(job->context, job->options->threads, sizeof *state->points);
    if (!state->pixels || !state->next_pixels || !state->points) {
        return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu pixels",
                         pixels);
    }
    for (size_t i = 0; i < pixels; i++) {
        state->pixels[i].scale = job->options->radius_m > 0.0f ? 1.0f : first_scale;
    }
    for (uint32_t i = 0; i < job->options->threads; i++) {
        const ppm_status status =
            ppmi_visible_points_init(job->context, &state->points[i], PPMI_TILE_PIXELS);
        if (status != PPM_STATUS_OK) return status;
    }
    return PPM_STATUS_OK;
}

static ppm_status sppm_create(const ppmi_job *job, void **out_state)
{
    sppm_state *state = ppmi_alloc_zeroed(job->context, 1, sizeof *state);
    if (!state) return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: sppm");
    const ppm_status status = allocate(job, state);
    if (status != PPM_STATUS_OK) {
        sppm_destroy(job, state);
        return status;
    }
    ppmi_vec3 low, high;
    ppmi_scene_bounds(job->world.scene, &low, &high);
    state->largest_radius = largest_share * 0.5f * vec3_length(vec3_sub(high, low));
    *out_state = state;
    return PPM_STATUS_OK;
}

/* Side of the footprint that the radius at a visible point counts in. */
static float unit_at(const ppmi_job *job, const sppm_state *state,
                     const ppmi_visible_points *points, uint32_t slot, float scale)
{
    if (job->options->radius_m > 0.0f) return job->options->radius_m;
    return ppmi_min(points->footprint[slot], state->largest_radius / scale);
}

/* ---- photons --------------------------------------------------------------------------------- */

static ppm_status photon_pass(const ppmi_job *job, sppm_state *state, uint64_t pass,
                              float typical_radius, ppm_render_stats *stats)
{
    const double start = omp_get_wtime();
    const uint64_t per_pass = job->options->photons_per_pass;
    const ppmi_photon_walk walk = {
        .world = &job->world,
        .seed = job->options->seed,
        .first_index = pass * per_pass,
        .count = (uint32_t)per_pass,
        .max_depth = job->options->max_depth,
        .threads = job->options->threads,
        .cancel = job->cancel,
    };
    state->photons.count = 0;
    ppm_status status =
        ppmi_photon_walk_run(job->context, &walk, &state->scratch, &state->photons, &stats->rays);
    if (status == PPM_STATUS_OK) {
        status =
            ppmi_photon_grid_build(job->context, &state->grid, state->photons.photons,
                                   state->photons.count, typical_radius, job->options->threads);
    }
    stats->seconds_photons += omp_get_wtime() - start;
    return status;
}

/* ---- the first radius ------------------------------------------------------------------------ */

static void eye_tile(const ppmi_job *job, ppmi_visible_points *points, ppmi_tile tile,
                     uint64_t pass, ppmi_vec3 *radiance, uint64_t *rays)
{
    ppmi_walker walker = {.world = &job->world};
    uint32_t slot = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++, slot++) {
            const ppmi_camera_ray ray = ppmi_start_camera_path(job, &walker, x, y, pass);
            radiance[slot] = ppmi_eye_path(&walker, &ray, job->options->max_depth, points, slot);
        }
    }
    *rays += walker.rays;
}

/* A radius that few visible points are below: the smallest footprint over a coarse raster, without
 * the nearest outliers. */
static float measure_first_radius(const ppmi_job *job, const sppm_state *state)
{
    if (job->options->radius_m > 0.0f) return job->options->radius_m;
    enum { SIDE = 32 };
    float smallest = INFINITY, second = INFINITY;
    ppmi_walker walker = {.world = &job->world};
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const float x = ((float)(i % SIDE) + 0.5f) / SIDE, y = ((float)(i / SIDE) + 0.5f) / SIDE;
        const ppmi_camera_ray ray =
            ppmi_camera_view_ray(&job->view, x * job->view.width, y * job->view.height);
        walker.rng = ppmi_rng_start(0, PPMI_STREAM_EYE, i);
        ppmi_vertex vertex;
        if (!ppmi_walk_to_surface(&walker, ray.ray, PPMI_RAY_CAMERA, &vertex)) continue;
        const float footprint = ray.base_width + ray.spread * vertex.distance;
        if (footprint < smallest) {
            second = smallest;
            smallest = footprint;
        } else {
            second = ppmi_min(second, footprint);
        }
    }
    const float radius = first_scale * (isfinite(second) ? second : smallest);
    return ppmi_min(radius, state->largest_radius);
}

/* Doubles the pixel's radius until the pilot's photons suffice. The pilot's photons are not used
 * for the picture: choosing the radius by the photons that it then gathers would bias it. */
static void grow_radius(const ppmi_job *job, const sppm_state *state,
                        const ppmi_visible_points *points, uint32_t slot, float *scale)
{
    for (int i = 0; i < PILOT_DOUBLINGS; i++) {
        const float radius = *scale * unit_at(job, state, points, slot, *scale);
        const ppmi_gathered gathered =
            ppmi_gather(&state->grid, job->world.albedo, points, slot, radius);
        if (gathered.count >= (float)PILOT_PHOTONS || 1.5f * radius > state->largest_radius) return;
        *scale *= sqrtf(2.0f);
    }
}

static void pilot_tile(const ppmi_job *job, sppm_state *state, uint32_t index)
{
    ppmi_visible_points *points = &state->points[omp_get_thread_num()];
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    ppmi_vec3 radiance[PPMI_TILE_PIXELS];
    uint64_t rays = 0;
    eye_tile(job, points, tile, PILOT_PASS, radiance, &rays);
    uint32_t slot = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++, slot++) {
            if (!points->is_valid[slot]) continue;
            const size_t pixel = (size_t)y * job->film.width + x;
            grow_radius(job, state, points, slot, &state->pixels[pixel].scale);
        }
    }
}

static ppm_status pilot_pass(const ppmi_job *job, sppm_state *state, ppm_render_stats *stats)
{
    state->first_radius = measure_first_radius(job, state);
    if (job->options->radius_m > 0.0f) return PPM_STATUS_OK;
    const ppm_status status = photon_pass(job, state, PILOT_PASS / job->options->photons_per_pass,
                                          state->first_radius, stats);
    if (status != PPM_STATUS_OK) return status;
    const uint32_t tiles = ppmi_tile_count(&job->film);
#pragma omp parallel for num_threads((int)job->options->threads) schedule(dynamic, 1)
    for (uint32_t i = 0; i < tiles; i++) {
        if (!atomic_load_explicit(job->cancel, memory_order_relaxed)) pilot_tile(job, state, i);
    }
    return atomic_load(job->cancel) ? PPM_STATUS_CANCELLED : PPM_STATUS_OK;
}

/* ---- a pass ---------------------------------------------------------------------------------- */

static pixel_statistics update(const ppmi_job *job, const sppm_state *state,
                               const ppmi_visible_points *points, uint32_t slot,
                               pixel_statistics old)
{
    if (!points->is_valid[slot]) return old;
    const float unit = unit_at(job, state, points, slot, old.scale);
    const ppmi_gathered gathered =
        ppmi_gather(&state->grid, job->world.albedo, points, slot, old.scale * unit);
    const ppmi_vec3 tau =
        vec3_scale(vec3_mul(points->throughput[slot], gathered.flux), 1.0f / (unit * unit));
    if (!(gathered.count > 0.0f) || !vec3_is_finite(tau)) return old;
    const float kept = old.count + job->options->alpha * gathered.count;
    const float g = kept / (old.count + gathered.count);
    return (pixel_statistics){
        .direct = old.direct,
        .tau = vec3_scale(vec3_add(old.tau, tau), g),
        .count = kept,
        .scale = old.scale * sqrtf(g),
    };
}

static void render_tile(const ppmi_job *job, sppm_state *state, uint32_t index, uint64_t pass,
                        tile_totals *totals)
{
    ppmi_visible_points *points = &state->points[omp_get_thread_num()];
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    ppmi_vec3 radiance[PPMI_TILE_PIXELS];
    const double start = omp_get_wtime();
    eye_tile(job, points, tile, pass, radiance, &totals->rays);
    const double middle = omp_get_wtime();
    uint32_t slot = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++, slot++) {
            const size_t pixel = (size_t)y * job->film.width + x;
            pixel_statistics next = update(job, state, points, slot, state->pixels[pixel]);
            if (vec3_is_finite(radiance[slot])) {
                next.direct = vec3_add(next.direct, radiance[slot]);
            }
            state->next_pixels[pixel] = next;
        }
    }
    totals->seconds_eye += middle - start;
    totals->seconds_gather += omp_get_wtime() - middle;
}

static ppm_status eye_and_gather(const ppmi_job *job, sppm_state *state, uint64_t pass,
                                 tile_totals *out_totals)
{
    const uint32_t tiles = ppmi_tile_count(&job->film);
    uint64_t rays = 0;
    double seconds_eye = 0.0, seconds_gather = 0.0;
#pragma omp parallel for num_threads((int)job->options->threads) schedule(dynamic, 1)             \
    reduction(+ : rays, seconds_eye, seconds_gather)
    for (uint32_t i = 0; i < tiles; i++) {
        if (atomic_load_explicit(job->cancel, memory_order_relaxed)) continue;
        tile_totals totals = {0};
        render_tile(job, state, i, pass, &totals);
        rays += totals.rays;
        seconds_eye += totals.seconds_eye;
        seconds_gather += totals.seconds_gather;
    }
    *out_totals = (tile_totals){rays, seconds_eye, seconds_gather};
    return atomic_load(job->cancel) ? PPM_STATUS_CANCELLED : PPM_STATUS_OK;
}

static ppm_status sppm_pass(const ppmi_job *job, void *opaque, uint64_t pass,
                            ppm_render_stats *stats)
{
    sppm_state *state = opaque;
    ppm_render_stats added = *stats;
    ppm_status status = PPM_STATUS_OK;
    if (!state->has_pilot) {
        status = pilot_pass(job, state, &added);
        if (status != PPM_STATUS_OK) return status;
        state->has_pilot = true;
    }
    /* the expected course of the radius: i^((alpha - 1) / 2) */
    const float shrunk = powf((float)(pass + 1), 0.5f * (job->options->alpha - 1.0f));
    status = photon_pass(job, state, pass, state->first_radius * shrunk, &added);
    if (status != PPM_STATUS_OK) return status;
    tile_totals totals;
    status = eye_and_gather(job, state, pass, &totals);
    if (status != PPM_STATUS_OK) return status;

    pixel_statistics *pixels = state->pixels;
    state->pixels = state->next_pixels;
    state->next_pixels = pixels;
    const double threads = (double)job->options->threads;
    added.rays += totals.rays;
    added.seconds_eye += totals.seconds_eye / threads;
    added.seconds_gather += totals.seconds_gather / threads;
    added.photons_emitted += job->options->photons_per_pass;
    added.photons_stored += state->photons.count;
    added.eye_paths += ppmi_film_pixel_count(&job->film);
    *stats = added;
    return PPM_STATUS_OK;
}

static void sppm_resolve(const ppmi_job *job, const void *opaque, uint64_t passes, float *rgba)
{
    const sppm_state *state = opaque;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const double emitted = (double)passes * (double)job->options->photons_per_pass;
    for (size_t i = 0; i < pixels; i++) {
        const pixel_statistics *pixel = &state->pixels[i];
        const double area = (double)PPMI_PI * (double)pixel->scale * (double)pixel->scale;
        const ppmi_vec3 radiance = vec3_mad(vec3_scale(pixel->direct, 1.0f / (float)passes),
                                            pixel->tau, (float)(1.0 / (emitted * area)));
        vec3_store(rgba + 4 * i, radiance);
        rgba[4 * i + 3] = 1.0f;
    }
}

const ppmi_integrator ppmi_integrator_sppm = {
    .name = "sppm",
    .create = sppm_create,
    .destroy = sppm_destroy,
    .pass = sppm_pass,
    .resolve = sppm_resolve,
};
