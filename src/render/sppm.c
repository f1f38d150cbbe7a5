/* Stochastic progressive photon mapping (Hachisuka and Jensen 2009): a photon pass, an eye pass
 * with new paths through each pixel, and statistics that belong to the pixel
 * (photon/statistics.h has the formulas).
 *
 * Radii are kept in units of the pixel's footprint at each eye vertex, so that one statistic serves
 * a pixel whose paths end near and far (edges, mirrors). A pixel has one statistic for surfaces
 * and, where there is fog, one for media.
 *
 * With the memoryless schedule (Knaus and Zwicker 2011, "Progressive Photon Mapping: A
 * Probabilistic Approach", section 4) a pass is a picture of its own with the radius of its number,
 * and the pictures are averaged:  v_{i+1} = v_i (i + alpha) / (i + 1)  for the disk's area or
 * ball's volume v.
 */
#include <omp.h>

#include "render/photon_pass.h"

typedef struct pixel_statistics {
    ppmi_vec3 direct; /* sum over passes of what needs no statistics */
    ppmi_gather_statistics surface;
} pixel_statistics;

/* The pixels of a picture; volumes is NULL without fog. */
typedef struct sppm_pixels {
    pixel_statistics *surfaces;
    ppmi_gather_statistics *volumes;
} sppm_pixels;

typedef struct sppm_state {
    sppm_pixels now, next;       /* a pass reads the first and writes the second */
    ppmi_plain_disk *plain;      /* of each pixel's first surface */
    ppmi_visible_points *points; /* one list a thread, for a tile each */
    ppmi_photon_pass photons;
    ppmi_light_film layers;
    bool has_pilot;
    float memoryless_extent; /* of disks and balls in this pass by the first one's */
} sppm_state;

/* What one pass's tiles add up to. */
typedef struct tile_totals {
    uint64_t rays;
    double seconds_eye, seconds_gather; /* of all threads */
    bool failed;
} tile_totals;

/* One tile while it is rendered: the light of its pixels, and which points are whose. */
typedef struct tile_eye {
    ppmi_vec3 radiance[PPMI_TILE_PIXELS];
    const ppmi_visible_point *points;
    uint32_t first_point[PPMI_TILE_PIXELS + 1];
    const ppmi_light_film *layers; /* NULL: none are kept */
    ppmi_vec3 *planes;             /* a set a pixel, and one for gathering */
    ppmi_light_seen seen[PPMI_TILE_PIXELS];
} tile_eye;

static void pixels_deinit(const ppmi_job *job, sppm_pixels *pixels)
{
    ppmi_free(job->context, pixels->surfaces);
    ppmi_free(job->context, pixels->volumes);
}

static void set_first_scales(const ppmi_job *job, sppm_pixels *pixels)
{
    const size_t count = ppmi_film_pixel_count(&job->film);
    for (size_t i = 0; i < count; i++) {
        pixels->surfaces[i].surface.scale = ppmi_photon_pass_first_scale(job);
        if (pixels->volumes) pixels->volumes[i].scale = ppmi_photon_pass_first_scale(job);
    }
}

static bool pixels_init(const ppmi_job *job, sppm_pixels *pixels)
{
    const size_t count = ppmi_film_pixel_count(&job->film);
    pixels->surfaces = ppmi_alloc_zeroed(job->context, count, sizeof *pixels->surfaces);
    if (job->world.has_scattering) {
        pixels->volumes = ppmi_alloc_zeroed(job->context, count, sizeof *pixels->volumes);
    }
    if (!pixels->surfaces || (job->world.has_scattering && !pixels->volumes)) return false;
    set_first_scales(job, pixels);
    return true;
}

static void sppm_destroy(const ppmi_job *job, void *opaque)
{
    sppm_state *state = opaque;
    if (!state) return;
    pixels_deinit(job, &state->now);
    pixels_deinit(job, &state->next);
    ppmi_free(job->context, state->plain);
    for (uint32_t i = 0; state->points && i < job->options->threads; i++) {
        ppmi_visible_points_deinit(job->context, &state->points[i]);
    }
    ppmi_free(job->context, state->points);
    ppmi_photon_pass_deinit(job, &state->photons);
    ppmi_light_film_deinit(job, &state->layers);
    ppmi_free(job->context, state);
}

static ppm_status sppm_create(const ppmi_job *job, void **out_state)
{
    sppm_state *state = ppmi_alloc_zeroed(job->context, 1, sizeof *state);
    bool has_memory = state && pixels_init(job, &state->now) && pixels_init(job, &state->next);
    if (has_memory) {
        state->plain = ppmi_alloc_zeroed(job->context, ppmi_film_pixel_count(&job->film),
                                         sizeof *state->plain);
        has_memory = state->plain != NULL;
    }
    if (has_memory) {
        state->points =
            ppmi_alloc_zeroed(job->context, job->options->threads, sizeof *state->points);
        has_memory = state->points != NULL;
    }
    for (uint32_t i = 0; has_memory && i < job->options->threads; i++) {
        has_memory = ppmi_visible_points_reserve(job->context, &state->points[i], PPMI_TILE_PIXELS);
    }
    if (!has_memory) {
        sppm_destroy(job, state);
        return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu pixels",
                         ppmi_film_pixel_count(&job->film));
    }
    ppm_status status = ppmi_photon_pass_init(job, &state->photons);
    if (status == PPM_STATUS_OK) {
        status = ppmi_light_film_init(job, PPMI_TILE_PIXELS + 1, &state->layers);
    }
    if (status != PPM_STATUS_OK) {
        sppm_destroy(job, state);
        return status;
    }
    *out_state = state;
    return PPM_STATUS_OK;
}

static bool is_memoryless(const ppmi_job *job)
{
    return job->options->schedule == PPM_SCHEDULE_MEMORYLESS;
}

/* ---- eye paths ------------------------------------------------------------------------------- */

/* Where the layers of a pixel's path go. */
static ppmi_light_sink sink_of(tile_eye *eye, uint32_t slot)
{
    eye->seen[slot] = (ppmi_light_seen){0};
    return ppmi_light_film_sink(eye->layers, ppmi_light_film_set(eye->layers, eye->planes, slot),
                                &eye->seen[slot]);
}

/* One path a pixel. */
static bool trace_tile(const ppmi_job *job, sppm_state *state, ppmi_tile tile, uint64_t pass,
                       tile_eye *eye, uint64_t *rays)
{
    const ppmi_eye_settings settings = ppmi_eye_settings_of(job, &state->photons);
    ppmi_visible_points *points = &state->points[omp_get_thread_num()];
    ppmi_walker walker = {.world = &job->world};
    uint32_t slot = 0;
    points->count = 0;
    if (eye->layers) eye->planes = ppmi_light_film_clear_scratch(eye->layers);
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++, slot++) {
            if (ppmi_job_is_cancelled(job)) return true; /* the caller looks, too */
            const ppmi_camera_ray ray = ppmi_start_camera_path(job, &walker, x, y, pass);
            eye->radiance[slot] = vec3_splat(0.0f);
            eye->first_point[slot] = (uint32_t)points->count;
            ppmi_light_sink sink;
            if (eye->layers) sink = sink_of(eye, slot);
            if (!ppmi_eye_path(job->context, &walker, &ray, &settings, slot, points,
                               &eye->radiance[slot], eye->layers ? &sink : NULL)) {
                return false;
            }
        }
    }
    eye->first_point[slot] = (uint32_t)points->count;
    eye->points = points->points;
    *rays += walker.rays;
    return true;
}

/* ---- the pilot ------------------------------------------------------------------------------- */

/* What a pilot does with the points of a pixel. */
typedef void (*pilot_step)(const ppmi_job *job, sppm_state *state, size_t pixel,
                           const tile_eye *eye, uint32_t slot);

static void mark_photons(const ppmi_job *job, sppm_state *state, size_t pixel, const tile_eye *eye,
                         uint32_t slot)
{
    const uint32_t first = eye->first_point[slot], count = eye->first_point[slot + 1] - first;
    if (!ppmi_photon_pass_looks_from(job, &state->photons, pixel)) return;
    ppmi_photon_pass_see(job, &state->photons, eye->points + first, count, &state->plain[pixel],
                         eye->radiance[slot]);
}

/* Narrow lobes want few photons: they say what radius is wanted only where nothing else does. */
static bool has_better(const tile_eye *eye, uint32_t slot, uint32_t i)
{
    if (eye->points[i].merge_area_m2 == 0.0f) return false;
    for (uint32_t k = i + 1; k < eye->first_point[slot + 1]; k++) {
        const ppmi_visible_point *point = &eye->points[k];
        if (ppmi_dimension_of(point) == PPMI_DISK && point->merge_area_m2 == 0.0f) return true;
    }
    return false;
}

/* By the first point of each kind. */
static void grow_radii(const ppmi_job *job, sppm_state *state, size_t pixel, const tile_eye *eye,
                       uint32_t slot)
{
    bool has_grown[2] = {false, false};
    for (uint32_t i = eye->first_point[slot]; i < eye->first_point[slot + 1]; i++) {
        const ppmi_visible_point *point = &eye->points[i];
        const bool is_volume = ppmi_dimension_of(point) == PPMI_BALL;
        if (has_grown[is_volume] || has_better(eye, slot, i)) continue;
        has_grown[is_volume] = true;
        ppmi_gather_statistics *statistics =
            is_volume ? &state->now.volumes[pixel] : &state->now.surfaces[pixel].surface;
        ppmi_plain_disk *known = ppmi_photon_pass_keeps_plain(point) ? &state->plain[pixel] : NULL;
        ppmi_photon_pass_grow(job, &state->photons, point, known, &statistics->scale);
    }
}

static bool pilot_tile(const ppmi_job *job, sppm_state *state, uint32_t index, pilot_step step)
{
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    tile_eye eye;
    eye.layers = NULL;
    uint64_t rays = 0;
    if (!trace_tile(job, state, tile, PPMI_PILOT_PASS, &eye, &rays)) {
        return false;
    }
    if (ppmi_job_is_cancelled(job)) return true;
    uint32_t slot = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++, slot++)
            step(job, state, (size_t)y * job->film.width + x, &eye, slot);
    }
    return true;
}

static ppm_status pilot_tiles(const ppmi_job *job, sppm_state *state, pilot_step step)
{
    const uint32_t tiles = ppmi_tile_count(&job->film);
    bool failed = false;
#pragma omp parallel for num_threads((int)job->options->threads) schedule(dynamic, 1)              \
    reduction(||                                                                                   \
              : failed)
    for (uint32_t i = 0; i < tiles; i++) {
        if (!atomic_load_explicit(job->cancel, memory_order_relaxed)) {
            failed = !pilot_tile(job, state, i, step) || failed;
        }
    }
    if (failed) return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: points");
    return atomic_load(job->cancel) ? PPM_STATUS_CANCELLED : PPM_STATUS_OK;
}

static ppm_status pilot_passes(const ppmi_job *job, sppm_state *state, ppm_render_stats *stats)
{
    ppm_status status = PPM_STATUS_OK;
    state->photons.time = ppmi_time_of_pass(job, PPMI_PILOT_PASS);
    while (status == PPM_STATUS_OK && ppmi_photon_pass_wants_round(job, &state->photons)) {
        status = ppmi_photon_pass_begin_round(job, &state->photons, stats);
        if (status == PPM_STATUS_OK) status = pilot_tiles(job, state, mark_photons);
        if (status == PPM_STATUS_OK) status = ppmi_photon_pass_end_round(job, &state->photons);
    }
    if (status != PPM_STATUS_OK || !ppmi_photon_pass_wants_radii(job)) return status;
    set_first_scales(job, &state->now); /* a pilot that failed may have grown some */
    status = ppmi_photon_pass_begin_radii(job, &state->photons, stats);
    return status == PPM_STATUS_OK ? pilot_tiles(job, state, grow_radii) : status;
}

/* ---- a pass ---------------------------------------------------------------------------------- */

/* The extent that a disk or ball has left in a pass: the product of (i + alpha) / (i + 1) over the
 * passes before, which count from 1. */
static float memoryless_extent(float alpha, uint64_t pass)
{
    const double log_extent = lgamma((double)pass + 1.0 + (double)alpha) -
                              lgamma(1.0 + (double)alpha) - lgamma((double)pass + 2.0);
    return (float)exp(log_extent);
}

/* A picture by the photons of this pass alone. */
static ppmi_vec3 estimate(const ppmi_job *job, const sppm_state *state,
                          const ppmi_visible_point *point, float first, ppmi_plain_disk *known,
                          ppmi_pixel_layers *layers)
{
    const ppmi_dimension dimension = ppmi_dimension_of(point);
    const float scale = first * ppmi_root_of(state->memoryless_extent, dimension);
    const float unit = ppmi_photon_pass_unit(job, &state->photons, point, first);
    const ppmi_gathered gathered =
        ppmi_photon_pass_gather(job, &state->photons, point, scale, unit, known, layers);
    const double emitted = (double)state->photons.per_pass;
    const double extent = (double)ppmi_extent_of(scale * unit, dimension);
    return vec3_scale(gathered.flux, (float)(1.0 / (emitted * extent)));
}

/* What the photons of this pass bring to the pixel's points of one kind. */
static void gather_points(const ppmi_job *job, const sppm_state *state, const tile_eye *eye,
                          uint32_t slot, ppmi_dimension dimension,
                          ppmi_gather_statistics *statistics, ppmi_plain_disk *plain,
                          ppmi_vec3 *direct, ppmi_pixel_layers *layers)
{
    ppmi_gathered sum = {0}; /* flux by footprint area or volume */
    for (uint32_t i = eye->first_point[slot]; i < eye->first_point[slot + 1]; i++) {
        const ppmi_visible_point *point = &eye->points[i];
        if (ppmi_dimension_of(point) != dimension) continue;
        ppmi_plain_disk *known = ppmi_photon_pass_keeps_plain(point) ? plain : NULL;
        if (known) plain = NULL; /* it is of the first one */
        if (is_memoryless(job)) {
            const ppmi_vec3 radiance =
                estimate(job, state, point, statistics->scale, known, layers);
            const bool is_finite = vec3_is_finite(radiance);
            if (is_finite) *direct = vec3_add(*direct, radiance);
            if (layers) ppmi_pixel_layers_keep(layers, is_finite);
            continue;
        }
        const float unit = ppmi_photon_pass_unit(job, &state->photons, point, statistics->scale);
        const ppmi_gathered gathered = ppmi_photon_pass_gather(
            job, &state->photons, point, statistics->scale, unit, known, layers);
        sum.flux = vec3_mad(sum.flux, gathered.flux, 1.0f / ppmi_power_of(unit, dimension));
        sum.count += gathered.count;
    }
    ppmi_statistics_update(statistics, dimension, job->options->alpha, sum.flux, sum.count);
    if (layers) ppmi_pixel_layers_keep(layers, vec3_is_finite(sum.flux));
}

static void start_layers(const tile_eye *eye, uint32_t slot, ppmi_pixel_layers *layers)
{
    *layers = (ppmi_pixel_layers){
        .film = eye->layers,
        .pass = {.combined = eye->radiance[slot], .seen = eye->seen[slot]},
        .planes = ppmi_light_film_set(eye->layers, eye->planes, slot),
        .gathered = ppmi_light_film_set(eye->layers, eye->planes, PPMI_TILE_PIXELS),
    };
}

static void update_pixel(const ppmi_job *job, sppm_state *state, uint64_t pass, size_t pixel,
                         const tile_eye *eye, uint32_t slot)
{
    ppmi_pixel_layers gathered, *layers = NULL;
    if (eye->layers) start_layers(eye, slot, layers = &gathered);
    pixel_statistics next = state->now.surfaces[pixel];
    next.direct = vec3_add(next.direct, eye->radiance[slot]);
    gather_points(job, state, eye, slot, PPMI_DISK, &next.surface, &state->plain[pixel],
                  &next.direct, layers);
    if (state->now.volumes) {
        ppmi_gather_statistics volume = state->now.volumes[pixel];
        gather_points(job, state, eye, slot, PPMI_BALL, &volume, NULL, &next.direct, layers);
        state->next.volumes[pixel] = volume;
    }
    state->next.surfaces[pixel] = next;
    if (!layers) return;
    ppmi_light_film_add(&state->layers, pixel, pass, ppmi_pixel_layers_finish(layers));
}

static void render_tile(const ppmi_job *job, sppm_state *state, uint32_t index, uint64_t pass,
                        tile_totals *totals)
{
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    tile_eye eye;
    eye.layers = ppmi_light_film_is_kept(&state->layers) ? &state->layers : NULL;
    const double start = omp_get_wtime();
    if (!trace_tile(job, state, tile, pass, &eye, &totals->rays)) {
        totals->failed = true;
        return;
    }
    if (ppmi_job_is_cancelled(job)) return;
    const double middle = omp_get_wtime();
    uint32_t slot = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++, slot++) {
            update_pixel(job, state, pass, (size_t)y * job->film.width + x, &eye, slot);
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
    bool failed = false;
#pragma omp parallel for num_threads((int)job->options->threads) schedule(dynamic, 1)             \
    reduction(+ : rays, seconds_eye, seconds_gather) reduction(|| : failed)
    for (uint32_t i = 0; i < tiles; i++) {
        if (atomic_load_explicit(job->cancel, memory_order_relaxed)) continue;
        tile_totals totals = {0};
        render_tile(job, state, i, pass, &totals);
        rays += totals.rays;
        seconds_eye += totals.seconds_eye;
        seconds_gather += totals.seconds_gather;
        failed = failed || totals.failed;
    }
    *out_totals = (tile_totals){rays, seconds_eye, seconds_gather, failed};
    if (failed) return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: points");
    return atomic_load(job->cancel) ? PPM_STATUS_CANCELLED : PPM_STATUS_OK;
}

static ppm_status sppm_pass(const ppmi_job *job, void *opaque, uint64_t pass,
                            ppm_render_stats *stats)
{
    sppm_state *state = opaque;
    ppm_render_stats added = *stats;
    ppm_status status = PPM_STATUS_OK;
    if (!state->has_pilot) {
        status = pilot_passes(job, state, &added);
        if (status != PPM_STATUS_OK) return status;
        state->has_pilot = true;
    }
    /* the expected course of the radius: i^((alpha - 1) / 2) */
    const float shrunk = powf((float)(pass + 1), 0.5f * (job->options->alpha - 1.0f));
    state->photons.time = ppmi_time_of_pass(job, pass);
    status = ppmi_photon_pass_run(job, &state->photons, pass, shrunk, &added);
    if (status != PPM_STATUS_OK) return status;
    state->memoryless_extent = memoryless_extent(job->options->alpha, pass);
    tile_totals totals;
    status = eye_and_gather(job, state, pass, &totals);
    if (status != PPM_STATUS_OK) return status;

    const sppm_pixels pixels = state->now;
    state->now = state->next;
    state->next = pixels;
    ppmi_light_film_commit(&state->layers);
    const double threads = (double)job->options->threads;
    added.rays += totals.rays;
    added.seconds_eye += totals.seconds_eye / threads;
    added.seconds_gather += totals.seconds_gather / threads;
    added.photons_emitted += state->photons.per_pass;
    added.photons_stored += ppmi_photon_map_count(&state->photons.map);
    ppmi_photon_pass_add_use(&state->photons, &added);
    added.eye_paths += ppmi_film_pixel_count(&job->film);
    *stats = added;
    return PPM_STATUS_OK;
}

static void sppm_resolve(const ppmi_job *job, const void *opaque, uint64_t passes, float *rgba)
{
    const sppm_state *state = opaque;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const double emitted = (double)passes * (double)state->photons.per_pass;
    for (size_t i = 0; i < pixels; i++) {
        const pixel_statistics *pixel = &state->now.surfaces[i];
        ppmi_vec3 radiance = vec3_mad(ppmi_statistics_radiance(&pixel->surface, PPMI_DISK, emitted),
                                      pixel->direct, 1.0f / (float)passes);
        if (state->now.volumes) {
            radiance = vec3_add(
                radiance, ppmi_statistics_radiance(&state->now.volumes[i], PPMI_BALL, emitted));
        }
        vec3_store(rgba + 4 * i, radiance);
        rgba[4 * i + 3] = ppmi_light_film_alpha(&state->layers, i, passes);
    }
}

static void sppm_read_layer(const ppmi_job *job, const void *opaque, int32_t kind, uint32_t number,
                            uint64_t passes, float *values)
{
    const sppm_state *state = opaque;
    ppmi_light_film_read(job, &state->layers, kind, number, passes, values);
}

const ppmi_integrator ppmi_integrator_sppm = {
    .name = "sppm",
    .create = sppm_create,
    .destroy = sppm_destroy,
    .pass = sppm_pass,
    .resolve = sppm_resolve,
    .read_layer = sppm_read_layer,
};
