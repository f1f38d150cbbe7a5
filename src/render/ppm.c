/* Progressive photon mapping (Hachisuka, Ogaki, Jensen 2008): one eye pass whose visible points are
 * kept, then photon passes without end that refine the radius, N and tau of each point
 * (photon/statistics.h has the formulas). With alpha 1 the radius stays: the classic photon map of
 * two passes (Jensen 1996), with photons that need not be stored.
 *
 * A pixel is as good as its eye paths: what they miss stays missing. Two remedies: paths split at
 * glass and follow all branches; and epochs, the report's improvement (Weng 2016): after so many
 * photons the eye pass is drawn anew, at other places in the pixels, statistics begin afresh, and
 * the pictures of the epochs are averaged by their photons.
 */
#include <omp.h>
#include <string.h>

#include "render/photon_pass.h"

/* One visible point, with what it has gathered in this epoch. */
typedef struct hit_statistics {
    ppmi_gather_statistics now, next; /* a pass reads the first and writes the second */
    ppmi_plain_disk plain;
} hit_statistics;

typedef struct ppm_state {
    ppmi_visible_points *tiles; /* of each tile, owned by pixels of the film */
    hit_statistics **statistics;
    ppmi_vec3 *direct; /* per pixel: what needs no photons, of this epoch's eye paths */
    float *past;       /* 3 per pixel: sum over past epochs of radiance times photons */
    ppmi_photon_pass photons;
    ppmi_light_film layers;
    ppmi_vec3 *direct_planes; /* as direct, of the layers: a set a pixel */
    ppmi_light_seen *seen;    /* per pixel, of this epoch's eye paths; or NULL */
    uint64_t pass;            /* that is gathered now */
    double past_emitted;      /* photons of past epochs */
    double epoch_emitted;     /* of this one */
    uint64_t epoch;
    bool has_points;
} ppm_state;

static void free_points(const ppmi_job *job, ppm_state *state)
{
    const uint32_t tiles = ppmi_tile_count(&job->film);
    for (uint32_t i = 0; i < tiles; i++) {
        if (state->tiles) ppmi_visible_points_deinit(job->context, &state->tiles[i]);
        if (!state->statistics) continue;
        ppmi_free(job->context, state->statistics[i]);
        state->statistics[i] = NULL;
    }
    state->has_points = false;
}

static void ppm_destroy(const ppmi_job *job, void *opaque)
{
    ppm_state *state = opaque;
    if (!state) return;
    free_points(job, state);
    ppmi_free(job->context, state->tiles);
    ppmi_free(job->context, state->statistics);
    ppmi_free(job->context, state->direct);
    ppmi_free(job->context, state->past);
    ppmi_free(job->context, state->direct_planes);
    ppmi_free(job->context, state->seen);
    ppmi_light_film_deinit(job, &state->layers);
    ppmi_photon_pass_deinit(job, &state->photons);
    ppmi_free(job->context, state);
}

static ppm_status create_layers(const ppmi_job *job, ppm_state *state)
{
    const ppm_status status = ppmi_light_film_init(job, 2, &state->layers);
    if (status != PPM_STATUS_OK || !ppmi_light_film_is_kept(&state->layers)) return status;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const size_t set = state->layers.planes.count * sizeof *state->direct_planes;
    state->direct_planes = ppmi_alloc_zeroed(job->context, pixels + 1, set > 0 ? set : 1);
    state->seen = ppmi_alloc_zeroed(job->context, pixels, sizeof *state->seen);
    if (state->direct_planes && state->seen) return PPM_STATUS_OK;
    return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: layers");
}

static ppm_status ppm_create(const ppmi_job *job, void **out_state)
{
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const uint32_t tiles = ppmi_tile_count(&job->film);
    ppm_state *state = ppmi_alloc_zeroed(job->context, 1, sizeof *state);
    if (state) {
        state->tiles = ppmi_alloc_zeroed(job->context, tiles, sizeof *state->tiles);
        state->statistics = ppmi_alloc_zeroed(job->context, tiles, sizeof *state->statistics);
        state->direct = ppmi_alloc_zeroed(job->context, pixels, sizeof *state->direct);
        state->past = ppmi_alloc_zeroed(job->context, pixels, 3 * sizeof *state->past);
    }
    if (!state || !state->tiles || !state->statistics || !state->direct || !state->past) {
        ppm_destroy(job, state);
        return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu pixels",
                         pixels);
    }
    ppm_status status = ppmi_photon_pass_init(job, &state->photons);
    if (status == PPM_STATUS_OK) status = create_layers(job, state);
    if (status != PPM_STATUS_OK) {
        ppm_destroy(job, state);
        return status;
    }
    *out_state = state;
    return PPM_STATUS_OK;
}

/* ---- the eye pass ---------------------------------------------------------------------------- */

static bool has_layers(const ppm_state *state)
{
    return ppmi_light_film_is_kept(&state->layers);
}

/* Where the layers of a pixel's eye path go. */
static ppmi_light_sink sink_of(ppm_state *state, size_t pixel)
{
    const size_t count = state->layers.planes.count;
    ppmi_vec3 *planes = state->direct_planes + pixel * count;
    memset(planes, 0, count * sizeof *planes);
    state->seen[pixel] = (ppmi_light_seen){0};
    return ppmi_light_film_sink(&state->layers, planes, &state->seen[pixel]);
}

/* The visible points of a tile, pixel by pixel. */
static bool trace_tile(const ppmi_job *job, ppm_state *state, uint32_t index, uint64_t *rays)
{
    const ppmi_eye_settings settings = ppmi_eye_settings_of(job, &state->photons);
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    ppmi_visible_points *points = &state->tiles[index];
    ppmi_walker walker = {.world = &job->world};
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            if (ppmi_job_is_cancelled(job)) return true;
            const ppmi_camera_ray ray = ppmi_start_camera_path(job, &walker, x, y, state->epoch);
            const uint32_t pixel = y * job->film.width + x;
            state->direct[pixel] = vec3_splat(0.0f);
            ppmi_light_sink sink;
            if (has_layers(state)) sink = sink_of(state, pixel);
            if (!ppmi_eye_path(job->context, &walker, &ray, &settings, pixel, points,
                               &state->direct[pixel], has_layers(state) ? &sink : NULL)) {
                return false;
            }
        }
    }
    *rays += walker.rays;
    if (points->count == 0) return true;
    state->statistics[index] =
        ppmi_alloc_zeroed(job->context, points->count, sizeof **state->statistics);
    if (!state->statistics[index]) return false;
    for (size_t i = 0; i < points->count; i++)
        state->statistics[index][i].now.scale = ppmi_photon_pass_first_scale(job);
    return true;
}

static ppm_status trace_tiles(const ppmi_job *job, ppm_state *state, ppm_render_stats *stats)
{
    const double start = omp_get_wtime();
    const uint32_t tiles = ppmi_tile_count(&job->film);
    uint64_t rays = 0;
    bool failed = false;
#pragma omp parallel for num_threads((int)job->options->threads) schedule(dynamic, 1)             \
    reduction(+ : rays) reduction(|| : failed)
    for (uint32_t i = 0; i < tiles; i++) {
        if (!atomic_load_explicit(job->cancel, memory_order_relaxed)) {
            failed = !trace_tile(job, state, i, &rays) || failed;
        }
    }
    stats->rays += rays;
    stats->eye_paths += ppmi_film_pixel_count(&job->film);
    stats->seconds_eye += omp_get_wtime() - start;
    if (failed) {
        return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY,
                         "out of memory: visible points (a smaller split depth needs less)");
    }
    return atomic_load(job->cancel) ? PPM_STATUS_CANCELLED : PPM_STATUS_OK;
}

typedef void (*tile_step)(const ppmi_job *job, ppm_state *state, uint32_t index);

static void mark_tile(const ppmi_job *job, ppm_state *state, uint32_t index)
{
    const ppmi_visible_points *points = &state->tiles[index];
    for (size_t i = 0, end; i < points->count; i = end) {
        const uint32_t owner = points->points[i].owner;
        for (end = i + 1; end < points->count && points->points[end].owner == owner;)
            end++;
        if (!ppmi_photon_pass_looks_from(job, &state->photons, owner)) continue;
        ppmi_photon_pass_see(job, &state->photons, points->points + i, end - i,
                             &state->statistics[index][i].plain, state->direct[owner]);
    }
}

static void grow_tile(const ppmi_job *job, ppm_state *state, uint32_t index)
{
    for (size_t i = 0; i < state->tiles[index].count; i++) {
        hit_statistics *statistics = &state->statistics[index][i];
        ppmi_photon_pass_grow(job, &state->photons, &state->tiles[index].points[i],
                              &statistics->plain, &statistics->now.scale);
    }
}

static ppm_status for_tiles(const ppmi_job *job, ppm_state *state, tile_step step)
{
    const uint32_t tiles = ppmi_tile_count(&job->film);
#pragma omp parallel for num_threads((int)job->options->threads) schedule(dynamic, 1)
    for (uint32_t i = 0; i < tiles; i++) {
        if (!atomic_load_explicit(job->cancel, memory_order_relaxed)) step(job, state, i);
    }
    return atomic_load(job->cancel) ? PPM_STATUS_CANCELLED : PPM_STATUS_OK;
}

static ppm_status eye_pass(const ppmi_job *job, ppm_state *state, ppm_render_stats *stats)
{
    ppm_status status = trace_tiles(job, state, stats);
    while (status == PPM_STATUS_OK && ppmi_photon_pass_wants_round(job, &state->photons)) {
        status = ppmi_photon_pass_begin_round(job, &state->photons, stats);
        if (status == PPM_STATUS_OK) status = for_tiles(job, state, mark_tile);
        if (status == PPM_STATUS_OK) status = ppmi_photon_pass_end_round(job, &state->photons);
    }
    if (status == PPM_STATUS_OK && ppmi_photon_pass_wants_radii(job)) {
        status = ppmi_photon_pass_begin_radii(job, &state->photons, stats);
        if (status == PPM_STATUS_OK) status = for_tiles(job, state, grow_tile);
    }
    return status;
}

/* ---- epochs ---------------------------------------------------------------------------------- */

static void add_to(float *sum, ppmi_vec3 radiance, double weight)
{
    vec3_store(sum, vec3_mad(vec3_load(sum), radiance, (float)weight));
}

/* Adds this epoch's picture, times its photons, to sums: stride floats a pixel. */
static void add_epoch(const ppmi_job *job, const ppm_state *state, float *sums, size_t stride)
{
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const uint32_t tiles = ppmi_tile_count(&job->film);
    const double emitted = state->epoch_emitted;
    for (size_t i = 0; i < pixels; i++)
        add_to(sums + stride * i, state->direct[i], emitted);
    for (uint32_t t = 0; t < tiles; t++) {
        for (size_t i = 0; i < state->tiles[t].count; i++) {
            const ppmi_visible_point *point = &state->tiles[t].points[i];
            const ppmi_vec3 radiance = ppmi_statistics_radiance(&state->statistics[t][i].now,
                                                                ppmi_dimension_of(point), emitted);
            add_to(sums + stride * point->owner, radiance, emitted);
        }
    }
}

/* Whether the pass begins an epoch. */
static bool is_due(const ppmi_job *job, const ppm_state *state)
{
    const uint64_t per_epoch = job->options->photons_per_epoch;
    return !state->has_points || (per_epoch > 0 && state->epoch_emitted >= (double)per_epoch);
}

static ppm_status begin_epoch(const ppmi_job *job, ppm_state *state, ppm_render_stats *stats)
{
    if (state->has_points) {
        add_epoch(job, state, state->past, 3);
        state->past_emitted += state->epoch_emitted;
        state->epoch_emitted = 0.0;
        state->epoch++;
    }
    free_points(job, state);
    state->photons.time = ppmi_time_of_pass(job, state->epoch);
    const ppm_status status = eye_pass(job, state, stats);
    if (status != PPM_STATUS_OK) {
        free_points(job, state);
        /* the picture of the epochs before is still there */
        memset(state->direct, 0, ppmi_film_pixel_count(&job->film) * sizeof *state->direct);
        return status;
    }
    state->has_points = true;
    return PPM_STATUS_OK;
}

/* ---- photon passes --------------------------------------------------------------------------- */

static void gather_point(const ppmi_job *job, ppm_state *state, const ppmi_visible_point *point,
                         hit_statistics *statistics, ppmi_pixel_layers *layers)
{
    statistics->next = statistics->now;
    const float scale = statistics->now.scale;
    const float unit = ppmi_photon_pass_unit(job, &state->photons, point, scale);
    const ppmi_gathered gathered = ppmi_photon_pass_gather(job, &state->photons, point, scale, unit,
                                                           &statistics->plain, layers);
    const ppmi_dimension dimension = ppmi_dimension_of(point);
    const ppmi_vec3 tau = vec3_scale(gathered.flux, 1.0f / ppmi_power_of(unit, dimension));
    ppmi_statistics_update(&statistics->next, dimension, job->options->alpha, tau, gathered.count);
    if (layers) ppmi_pixel_layers_keep(layers, vec3_is_finite(tau));
}

/* Begins a pixel's layers with what its eye path met. */
static void start_layers(const ppm_state *state, size_t pixel, ppmi_pixel_layers *layers)
{
    const size_t count = state->layers.planes.count;
    ppmi_vec3 *scratch = ppmi_light_film_clear_scratch(&state->layers);
    *layers = (ppmi_pixel_layers){
        .film = &state->layers,
        .pass = {.combined = state->direct[pixel], .seen = state->seen[pixel]},
        .planes = scratch,
        .gathered = ppmi_light_film_set(&state->layers, scratch, 1),
    };
    memcpy(scratch, state->direct_planes + pixel * count, count * sizeof *scratch);
}

/* Points are in the order of their pixels. */
static void gather_tile_layers(const ppmi_job *job, ppm_state *state, uint32_t index)
{
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    const ppmi_visible_points *points = &state->tiles[index];
    size_t i = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            const size_t pixel = (size_t)y * job->film.width + x;
            ppmi_pixel_layers layers;
            start_layers(state, pixel, &layers);
            for (; i < points->count && points->points[i].owner == pixel; i++) {
                gather_point(job, state, &points->points[i], &state->statistics[index][i], &layers);
            }
            ppmi_light_film_add(&state->layers, pixel, state->pass,
                                ppmi_pixel_layers_finish(&layers));
        }
    }
}

static void gather_tile(const ppmi_job *job, ppm_state *state, uint32_t index)
{
    if (has_layers(state)) {
        gather_tile_layers(job, state, index);
        return;
    }
    const ppmi_visible_points *points = &state->tiles[index];
    for (size_t i = 0; i < points->count; i++)
        gather_point(job, state, &points->points[i], &state->statistics[index][i], NULL);
}

static ppm_status gather_pass(const ppmi_job *job, ppm_state *state, ppm_render_stats *stats)
{
    const double start = omp_get_wtime();
    const ppm_status status = for_tiles(job, state, gather_tile);
    stats->seconds_gather += omp_get_wtime() - start;
    if (status != PPM_STATUS_OK) return status;
    const uint32_t tiles = ppmi_tile_count(&job->film);
    for (uint32_t t = 0; t < tiles; t++) {
        for (size_t i = 0; i < state->tiles[t].count; i++)
            state->statistics[t][i].now = state->statistics[t][i].next;
    }
    return PPM_STATUS_OK;
}

static ppm_status ppm_pass(const ppmi_job *job, void *opaque, uint64_t pass,
                           ppm_render_stats *stats)
{
    ppm_state *state = opaque;
    ppm_render_stats added = *stats;
    ppm_status status = PPM_STATUS_OK;
    if (is_due(job, state)) {
        status = begin_epoch(job, state, &added);
        if (status != PPM_STATUS_OK) return status;
    }
    const double per_pass = (double)state->photons.per_pass;
    const float passed = (float)(state->epoch_emitted / per_pass);
    const float shrunk = powf(passed + 1.0f, 0.5f * (job->options->alpha - 1.0f));
    status = ppmi_photon_pass_run(job, &state->photons, pass, shrunk, &added);
    state->pass = pass;
    if (status == PPM_STATUS_OK) status = gather_pass(job, state, &added);
    if (status != PPM_STATUS_OK) return status;
    ppmi_light_film_commit(&state->layers);
    state->epoch_emitted += per_pass;
    added.photons_emitted += state->photons.per_pass;
    added.photons_stored += ppmi_photon_map_count(&state->photons.map);
    ppmi_photon_pass_add_use(&state->photons, &added);
    *stats = added;
    return PPM_STATUS_OK;
}

/* Epochs are weighed by their photons, and so are layers by passes: all have as many. */
static void ppm_resolve(const ppmi_job *job, const void *opaque, uint64_t passes, float *rgba)
{
    const ppm_state *state = opaque;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    for (size_t i = 0; i < pixels; i++) {
        memcpy(rgba + 4 * i, state->past + 3 * i, 3 * sizeof *rgba);
        rgba[4 * i + 3] = ppmi_light_film_alpha(&state->layers, i, passes);
    }
    add_epoch(job, state, rgba, 4);
    const float scale = (float)(1.0 / (state->past_emitted + state->epoch_emitted));
    for (size_t i = 0; i < pixels; i++) {
        vec3_store(rgba + 4 * i, vec3_scale(vec3_load(rgba + 4 * i), scale));
    }
}

static void ppm_read_layer(const ppmi_job *job, const void *opaque, int32_t kind, uint32_t number,
                           uint64_t passes, float *values)
{
    const ppm_state *state = opaque;
    ppmi_light_film_read(job, &state->layers, kind, number, passes, values);
}

const ppmi_integrator ppmi_integrator_ppm = {
    .name = "ppm",
    .create = ppm_create,
    .destroy = ppm_destroy,
    .pass = ppm_pass,
    .resolve = ppm_resolve,
    .read_layer = ppm_read_layer,
};
