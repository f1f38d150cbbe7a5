/* Photon passes and first radii. */
#include "render/photon_pass.h"

#include <omp.h>
#include <string.h>

#include "render/layer_list.h"

/* First radius, in sides of the pixel's footprint, and how often its disk or ball may double where
 * a pilot pass finds fewer photons than this: smooth light may be averaged over more than a
 * caustic, which has photons enough within a few pixels. */
static const float first_scale = 3.0f;
enum { PILOT_DOUBLINGS_DISK = 6, PILOT_DOUBLINGS_BALL = 9, PILOT_PHOTONS = 16 }; /* radius x 8 */

/* No radius is larger than this share of the scene's bounding sphere. */
static const float largest_share = 0.05f;

void ppmi_photon_pass_deinit(const ppmi_job *job, ppmi_photon_pass *photons)
{
    ppmi_photon_map_deinit(job->context, &photons->map);
    ppmi_photon_aim_deinit(job->context, &photons->aim);
}

/* A radius that few visible points are below: the smallest footprint over a coarse raster, without
 * the nearest outliers. */
static float measure_first_radius(const ppmi_job *job, float largest_radius)
{
    if (job->options->radius_m > 0.0f) return job->options->radius_m;
    enum { SIDE = 32 };
    float smallest = INFINITY, second = INFINITY;
    ppmi_walker walker = {.world = &job->world};
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const float x = ((float)(i % SIDE) + 0.5f) / SIDE, y = ((float)(i / SIDE) + 0.5f) / SIDE;
        const ppmi_camera_ray ray =
            ppmi_camera_view_ray(&job->view, x * job->view.width, y * job->view.height);
        ppmi_walker_start(&walker, ppmi_rng_start(0, PPMI_STREAM_EYE, i), 0, i, 0, 0);
        ppmi_vertex vertex;
        if (ppmi_walk(&walker, ray.ray, PPMI_RAY_CAMERA, &vertex) == PPMI_ESCAPED) continue;
        const float footprint = ray.base_width + ray.spread * vertex.distance;
        if (footprint < smallest) {
            second = smallest;
            smallest = footprint;
        } else {
            second = ppmi_min(second, footprint);
        }
    }
    const float radius = first_scale * (isfinite(second) ? second : smallest);
    return ppmi_min(radius, largest_radius);
}

ppm_status ppmi_photon_pass_init(const ppmi_job *job, ppmi_photon_pass *photons)
{
    photons->per_pass = job->options->photons_per_pass;
    ppmi_vec3 low, high;
    if (!ppmi_scene_bounds(job->world.scene, &low, &high)) { /* an empty frame: any will do */
        low = vec3_splat(-1.0f);
        high = vec3_splat(1.0f);
    }
    photons->largest_radius = largest_share * 0.5f * vec3_length(vec3_sub(high, low));
    photons->first_radius = measure_first_radius(job, photons->largest_radius);
    return PPM_STATUS_OK;
}

float ppmi_photon_pass_first_scale(const ppmi_job *job)
{
    return job->options->radius_m > 0.0f ? 1.0f : first_scale;
}

static ppmi_photon_walk walk_of(const ppmi_job *job, const ppmi_photon_pass *photons, uint64_t pass)
{
    const uint64_t per_pass = photons->per_pass;
    return (ppmi_photon_walk){
        .world = &job->world,
        .seed = job->options->seed,
        .first_index = pass * per_pass,
        .count = (uint32_t)per_pass,
        .max_depth = job->options->max_depth,
        .first_depth = job->options->direct == PPM_DIRECT_PHOTONS ? 0 : 1,
        .aim = photons->aim.aim,
        .guide = photons->aim.rounds > 0 ? photons->aim.guide : NULL,
        .tags_photons =
            ppmi_layers_have(job->options, PPM_LAYER_DIFFUSE_DIRECT, PPM_LAYER_GROUP_CAUSTICS) ||
            ppmi_layers_have(job->options, PPM_LAYER_LIGHT_VARIANCE, PPM_LAYER_LIGHT_VARIANCE),
        .groups = job->groups,
        .shutter_is_open = ppmi_shutter_is_open(job),
        .has_one_time = job->pass_has_one_time,
        .time = photons->time,
        .threads = job->options->threads,
        .cancel = job->cancel,
    };
}

static ppm_status run(const ppmi_job *job, ppmi_photon_pass *photons, const ppmi_photon_walk *walk,
                      float radius_share, ppm_render_stats *stats)
{
    const double start = omp_get_wtime();
    const ppm_status status = ppmi_photon_map_fill(
        job->context, &photons->map, walk, photons->first_radius * radius_share, &stats->rays);
    photons->in_map = walk->count;
    stats->seconds_photons += omp_get_wtime() - start;
    return status;
}

ppm_status ppmi_photon_pass_run(const ppmi_job *job, ppmi_photon_pass *photons, uint64_t pass,
                                float radius_share, ppm_render_stats *stats)
{
    const ppmi_photon_walk walk = walk_of(job, photons, pass);
    return run(job, photons, &walk, radius_share, stats);
}

/* ---- the pilot ------------------------------------------------------------------------------- */

/* Pass numbers that no pass reaches. */
static uint64_t pilot_pass(const ppmi_job *job, uint64_t number)
{
    return PPMI_PILOT_PASS / job->options->photons_per_pass + number;
}

/* Pilots by their numbers. */
enum { PILOT_OF_RADII, PILOT_OF_EVEN, PILOTS_OF_ROUNDS };

static ppmi_photon_walk pilot_walk(const ppmi_job *job, const ppmi_photon_pass *photons,
                                   uint64_t number, uint64_t count)
{
    ppmi_photon_walk walk = walk_of(job, photons, pilot_pass(job, number));
    walk.count = (uint32_t)count;
    return walk;
}

/* Half of a pass's photons, if they are not too few to learn from. */
static ppmi_photon_walk round_walk(const ppmi_job *job, const ppmi_photon_pass *photons)
{
    const uint64_t least = 1 << 14, half = photons->per_pass / 2;
    const uint64_t number = PILOTS_OF_ROUNDS + photons->aim.rounds;
    return pilot_walk(job, photons, number, half > least ? half : least);
}

bool ppmi_photon_pass_wants_round(const ppmi_job *job, const ppmi_photon_pass *photons)
{
    return job->options->aim != PPM_AIM_EVEN && !photons->aim.is_learnt;
}

/* Traces a pilot's photons; *out_cost: rays and photons kept of each one emitted. */
static ppm_status run_pilot(const ppmi_job *job, ppmi_photon_pass *photons,
                            const ppmi_photon_walk *walk, ppm_render_stats *stats, double *out_cost)
{
    const uint64_t rays = stats->rays;
    const ppm_status status = run(job, photons, walk, 1.0f, stats);
    const uint64_t kept = ppmi_photon_map_count(&photons->map);
    *out_cost = (double)(stats->rays - rays + kept) / (double)walk->count;
    return status;
}

static ppm_status measure_even(const ppmi_job *job, ppmi_photon_pass *photons,
                               ppm_render_stats *stats)
{
    const uint64_t share = 8;
    const uint64_t count = photons->per_pass / share + 1;
    const ppmi_photon_walk walk = pilot_walk(job, photons, PILOT_OF_EVEN, count);
    return run_pilot(job, photons, &walk, stats, &photons->aim.even_cost);
}

ppm_status ppmi_photon_pass_begin_round(const ppmi_job *job, ppmi_photon_pass *photons,
                                        ppm_render_stats *stats)
{
    ppm_status status = PPM_STATUS_OK;
    if (!photons->aim.aim) {
        if (job->photons_are_free) status = measure_even(job, photons, stats);
        if (status == PPM_STATUS_OK) {
            status = ppmi_photon_aim_begin(job, &photons->aim, &stats->rays);
        }
    }
    if (status != PPM_STATUS_OK) return status;
    const ppmi_photon_walk walk = round_walk(job, photons);
    status = run_pilot(job, photons, &walk, stats, &photons->aim.aimed_cost);
    if (status != PPM_STATUS_OK) return status;
    return ppmi_photon_map_begin_marks(job->context, &photons->map);
}

bool ppmi_photon_pass_looks_from(const ppmi_job *job, const ppmi_photon_pass *photons, size_t pixel)
{
    const uint64_t wanted = 1 << 14;
    const uint64_t stride = ppmi_film_pixel_count(&job->film) / wanted;
    if (stride <= 1) return true;
    return ppmi_hash64(((uint64_t)photons->aim.rounds << 48) + pixel) % stride == 0;
}

/* Nothing stays known where things move from pass to pass. */
static ppmi_plain_disk *known_of(const ppmi_job *job, ppmi_plain_disk *known)
{
    return job->pass_has_one_time ? NULL : known;
}

/* A point's radius in a round: that which it would be given to begin with. */
static float round_radius(const ppmi_job *job, const ppmi_photon_pass *photons,
                          const ppmi_visible_point *point, ppmi_plain_disk *known)
{
    float scale = ppmi_photon_pass_first_scale(job);
    if (ppmi_photon_pass_wants_radii(job)) {
        ppmi_photon_pass_grow(job, photons, point, known, &scale);
    }
    return scale * ppmi_photon_pass_unit(job, photons, point, scale);
}

/* The point that the pixel's plain disk is of; count: none. */
static size_t first_surface(const ppmi_visible_point *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (ppmi_photon_pass_keeps_plain(&points[i])) return i;
    }
    return count;
}

void ppmi_photon_pass_see(const ppmi_job *job, const ppmi_photon_pass *photons,
                          const ppmi_visible_point *points, size_t count, ppmi_plain_disk *plain,
                          ppmi_vec3 light)
{
    enum { MOST = 32 };
    float radii[MOST], scales[MOST];
    if (count > MOST) count = MOST;
    const size_t first = first_surface(points, count);
    float all = vec3_mean(light);
    for (size_t i = 0; i < count; i++) {
        ppmi_plain_disk *known = i == first ? plain : NULL;
        radii[i] = round_radius(job, photons, &points[i], known);
        scales[i] = 1.0f / ((float)photons->in_map *
                            ppmi_extent_of(radii[i], ppmi_dimension_of(&points[i])));
        const ppmi_gathered gathered = ppmi_photon_map_gather(
            &photons->map, job->world.albedo, &points[i], radii[i], known_of(job, known));
        all += vec3_mean(vec3_mul(gathered.flux, points[i].throughput)) * scales[i];
        if (!(gathered.count > 0.0f)) scales[i] = 0.0f;
    }
    if (!(all > 0.0f) || !isfinite(all)) return;
    for (size_t i = 0; i < count; i++) {
        if (!(scales[i] > 0.0f)) continue;
        ppmi_photon_map_mark(&photons->map, job->world.albedo, &points[i], radii[i],
                             known_of(job, i == first ? plain : NULL), scales[i] / all);
    }
}

ppm_status ppmi_photon_pass_end_round(const ppmi_job *job, ppmi_photon_pass *photons)
{
    const double most = 3.0;
    const ppmi_photon_walk walk = round_walk(job, photons);
    const ppm_status status = ppmi_photon_aim_learn(job, &photons->aim, &photons->map, &walk);
    if (status != PPM_STATUS_OK || !photons->aim.is_learnt) return status;
    const bool is_sppm = job->options->integrator == PPM_INTEGRATOR_SPPM;
    const double gain = fmin(photons->aim.aimed_cost / photons->aim.even_cost, most);
    if (is_sppm && job->photons_are_free && gain > 1.0) {
        photons->per_pass = (uint64_t)((double)photons->per_pass / gain);
    }
    return PPM_STATUS_OK;
}

bool ppmi_photon_pass_wants_radii(const ppmi_job *job)
{
    return !(job->options->radius_m > 0.0f);
}

ppm_status ppmi_photon_pass_begin_radii(const ppmi_job *job, ppmi_photon_pass *photons,
                                        ppm_render_stats *stats)
{
    return ppmi_photon_pass_run(job, photons, pilot_pass(job, PILOT_OF_RADII), 1.0f, stats);
}

/* Doubles the disk until it has enough photons. In a hurry regions of gathering are left alone
 * until the whole disk has enough, or is the last; false if it is crowded then: a smaller one may
 * have been. */
static bool grow(const ppmi_job *job, const ppmi_photon_pass *photons,
                 const ppmi_visible_point *point, ppmi_plain_disk *known, bool in_hurry,
                 float *scale)
{
    const ppmi_dimension dimension = ppmi_dimension_of(point);
    const float step = ppmi_root_of(2.0f, dimension), enough = (float)PILOT_PHOTONS;
    const int doublings = dimension == PPMI_DISK ? PILOT_DOUBLINGS_DISK : PILOT_DOUBLINGS_BALL;
    const ppmi_photon_map *map = &photons->map;
    for (int i = 0; i < doublings; i++, *scale *= step) {
        const float radius = *scale * ppmi_photon_pass_unit(job, photons, point, *scale);
        const bool is_largest = 1.5f * radius > photons->largest_radius;
        if (in_hurry && !is_largest && i + 1 < doublings &&
            ppmi_photon_map_gather_whole(map, job->world.albedo, point, radius).count < enough) {
            continue;
        }
        const ppmi_gathered gathered =
            ppmi_photon_map_gather(map, job->world.albedo, point, radius, known);
        if (gathered.is_crowded) return !in_hurry || i == 0;
        if (gathered.count >= enough || is_largest) return true;
    }
    return true;
}

void ppmi_photon_pass_grow(const ppmi_job *job, const ppmi_photon_pass *photons,
                           const ppmi_visible_point *point, ppmi_plain_disk *known, float *scale)
{
    const float first = *scale;
    known = known_of(job, known);
    if (grow(job, photons, point, known, true, scale)) return;
    *scale = first;
    grow(job, photons, point, known, false, scale);
}

void ppmi_photon_pass_add_use(const ppmi_photon_pass *photons, ppm_render_stats *stats)
{
    if (!photons->aim.is_learnt) return;
    stats->photons_used_share = photons->aim.used_share;
    stats->light_uses = photons->aim.uses;
    stats->light_use_count = photons->aim.use_count;
}

/* ---- layers ---------------------------------------------------------------------------------- */

ppmi_gathered ppmi_photon_pass_gather_layers(const ppmi_job *job, const ppmi_photon_pass *photons,
                                             const ppmi_visible_point *point, float radius,
                                             ppmi_plain_disk *known, ppmi_pixel_layers *layers)
{
    const ppmi_dimension dimension = ppmi_dimension_of(point);
    const double emitted = (double)photons->per_pass;
    const float extent = ppmi_extent_of(radius, dimension);
    const float scale = (float)(1.0 / (emitted * (double)extent));
    const ppmi_light_sink sink = ppmi_light_film_sink(layers->film, layers->gathered, NULL);
    const ppmi_gather_layers gather = {.sink = &sink,
                                       .factor = vec3_scale(point->throughput, scale)};
    ppmi_gathered gathered = ppmi_photon_map_gather_with_layers(&photons->map, job->world.albedo,
                                                                point, radius, known, &gather);
    gathered.flux = vec3_mul(gathered.flux, point->throughput);
    layers->gathered_light = vec3_mad(layers->gathered_light, gathered.flux, scale);
    layers->radius_sum_m += radius;
    layers->point_count++;
    if (dimension == PPMI_DISK) {
        layers->surface_count++;
        layers->pass.photons_per_area += gathered.count / (extent * gathered.share);
    }
    return gathered;
}

void ppmi_pixel_layers_keep(ppmi_pixel_layers *layers, bool is_kept)
{
    const size_t count = layers->film->planes.count;
    if (is_kept) {
        for (size_t i = 0; i < count; i++)
            layers->planes[i] = vec3_add(layers->planes[i], layers->gathered[i]);
        layers->pass.combined = vec3_add(layers->pass.combined, layers->gathered_light);
    }
    memset(layers->gathered, 0, count * sizeof *layers->gathered);
    layers->gathered_light = vec3_splat(0.0f);
}

const ppmi_light_pass *ppmi_pixel_layers_finish(ppmi_pixel_layers *layers)
{
    ppmi_light_pass *pass = &layers->pass;
    pass->planes = layers->planes;
    if (layers->point_count > 0) pass->radius_m = layers->radius_sum_m / (float)layers->point_count;
    if (layers->surface_count > 0) pass->photons_per_area /= (float)layers->surface_count;
    return pass;
}

ppmi_eye_settings ppmi_eye_settings_of(const ppmi_job *job, const ppmi_photon_pass *photons)
{
    const int32_t split_depth = job->options->split_depth;
    return (ppmi_eye_settings){
        .max_depth = job->options->max_depth,
        .split_depth = split_depth > 0 ? (uint32_t)split_depth : 0,
        .media_depth = 2,
        .samples_lights = job->options->direct != PPM_DIRECT_PHOTONS,
        .photons = (float)photons->per_pass,
        .radius_m = job->options->radius_m,
    };
}
