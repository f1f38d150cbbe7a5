/* Paths from places all over the whole picture, each to its first few surfaces and points in media
 * that light is sampled at; there every choice of light sampling (up to some, in turn) is tried by
 * a shadow ray. A photon mapper's paths end where they gather, as those of its passes. */
#include "render/light_pilot.h"

#include <omp.h>

enum { LEAST_PATHS = 1024, MOST_PATHS = 16384 };
enum { PATH_PROBES = 4, MOST_TRIED = 8, MOST_VERTICES = 16, ROULETTE_DEPTH = 4 };

typedef struct light_pilot {
    const ppmi_job *job;
    uint32_t paths, choices;
    ppmi_light_probe *probes; /* PATH_PROBES for each path */
    uint32_t *counts;         /* of them that there are, by path */
} light_pilot;

/* What a choice brings to a vertex over what it promises; below 0 where it promises nothing. */
static float try_choice(ppmi_walker *walker, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                        const ppmi_receiver *receiver, uint32_t choice)
{
    const float most = 32.0f; /* one sample must not outweigh all others */
    const double u_pick = ppmi_rng_double(&walker->rng);
    const float u = ppmi_rng_float(&walker->rng), v = ppmi_rng_float(&walker->rng);
    ppmi_light_sample light;
    float importance;
    if (!ppmi_lights_sample_choice(walker->world->lights, choice, receiver, walker->time, u_pick, u,
                                   v, &light, &importance)) {
        return importance > 0.0f ? 0.0f : -1.0f;
    }
    float cosine = 1.0f;
    if (ppmi_receiver_is_surface(receiver)) {
        cosine = vec3_dot(light.wi, receiver->normal);
        if (receiver->is_open) cosine = fabsf(cosine);
    }
    if (!(cosine > 0.0f)) return 0.0f;
    const ppmi_vec3 passed = ppmi_walk_light_visibility(walker, vertex, bsdf, &light);
    const float arrives = vec3_mean(vec3_mul(light.radiance, passed)) * cosine / light.pdf;
    const float share = arrives / importance;
    return isfinite(share) ? ppmi_min(share, most) : 0.0f;
}

static void probe(const light_pilot *pilot, ppmi_walker *walker, const ppmi_vertex *vertex,
                  const ppmi_bsdf *bsdf, uint32_t turn, ppmi_light_probe *out_probe)
{
    out_probe->receiver = ppmi_walk_receiver(vertex, bsdf);
    for (uint32_t c = 0; c < pilot->choices; c++)
        out_probe->shares[c] = -1.0f;
    const uint32_t tried = pilot->choices < MOST_TRIED ? pilot->choices : MOST_TRIED;
    for (uint32_t i = 0; i < tried; i++) {
        const uint32_t c = (turn * MOST_TRIED + i) % pilot->choices;
        out_probe->shares[c] = try_choice(walker, vertex, bsdf, &out_probe->receiver, c);
    }
}

/* The path ends by chance, or where photons are gathered. */
static bool goes_on(const light_pilot *pilot, ppmi_walker *walker, const ppmi_bsdf *bsdf,
                    uint32_t depth, ppmi_vec3 *throughput, ppmi_ray *ray, ppmi_vertex *vertex)
{
    const bool gathers = pilot->job->options->integrator != PPM_INTEGRATOR_PATH;
    uint32_t lobes = PPMI_LOBE_ALL;
    if (gathers) {
        lobes = (uint32_t)(bsdf->lobes & ~bsdf->gather_lobes);
        if (ppmi_rng_float(&walker->rng) < ppmi_bsdf_probability(bsdf, bsdf->gather_lobes)) {
            return false;
        }
    }
    const float u_lobe = ppmi_rng_float(&walker->rng);
    const float u = ppmi_rng_float(&walker->rng), v = ppmi_rng_float(&walker->rng);
    ppmi_bsdf_sample sample;
    if (!ppmi_bsdf_draw(bsdf, walker->world->albedo, lobes, PPMI_TRANSPORT_RADIANCE, u_lobe, u, v,
                        &sample)) {
        return false;
    }
    *throughput = vec3_mul(*throughput, sample.weight);
    *ray = ppmi_walk_leave(walker, vertex, &sample, throughput);
    if (depth < ROULETTE_DEPTH) return true;
    const float survival = ppmi_min(1.0f, vec3_max_component(*throughput));
    if (ppmi_rng_float(&walker->rng) >= survival) return false;
    *throughput = vec3_scale(*throughput, 1.0f / survival);
    return true;
}

static void follow(const light_pilot *pilot, ppmi_walker *walker, ppmi_ray ray, uint32_t index)
{
    ppmi_light_probe *probes = pilot->probes + (size_t)index * PATH_PROBES;
    uint32_t *count = &pilot->counts[index];
    ppmi_vec3 throughput = vec3_splat(1.0f);
    for (uint32_t depth = 0; depth < MOST_VERTICES && *count < PATH_PROBES; depth++) {
        ppmi_vertex vertex;
        const ppmi_ray_kind kind = depth == 0 ? PPMI_RAY_CAMERA : PPMI_RAY_OTHER;
        if (ppmi_walk(walker, ray, kind, &vertex) == PPMI_ESCAPED) return;
        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(walker, &vertex, ray.direction, &bsdf);
        if ((bsdf.lobes & ~bsdf.delta_lobes) != 0) {
            probe(pilot, walker, &vertex, &bsdf, index + *count, &probes[*count]);
            ++*count;
        }
        if (bsdf.lobes == 0) return;
        if (!goes_on(pilot, walker, &bsdf, depth, &throughput, &ray, &vertex)) return;
    }
}

/* Pixels of the whole picture, which the film is a window of. */
static void trace_path(const light_pilot *pilot, ppmi_walker *walker, uint32_t index)
{
    const ppmi_job *job = pilot->job;
    const ppmi_sample4 at = ppmi_sobol4(index, 0, ppmi_hash64(job->options->seed));
    const uint32_t x = (uint32_t)(ppmi_unit_float(at.bits[0]) * (float)job->options->width);
    const uint32_t y = (uint32_t)(ppmi_unit_float(at.bits[1]) * (float)job->options->height);
    const ppmi_camera_ray ray = ppmi_start_camera_path(job, walker, x - job->film.x0,
                                                       y - job->film.y0, PPMI_PILOT_PASS + index);
    follow(pilot, walker, ray.ray, index);
}

static void trace(light_pilot *pilot, ppm_render_stats *stats)
{
    uint64_t rays = 0;
#pragma omp parallel for num_threads((int)pilot->job->options->threads) schedule(dynamic, 64)     \
    reduction(+ : rays)
    for (uint32_t i = 0; i < pilot->paths; i++) {
        if (atomic_load_explicit(pilot->job->cancel, memory_order_relaxed)) continue;
        ppmi_walker walker = {.world = &pilot->job->world};
        trace_path(pilot, &walker, i);
        rays += walker.rays;
    }
    stats->rays += rays;
}

/* Moves all probes to the front, in the order of paths; returns their number. */
static uint32_t compact(light_pilot *pilot)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pilot->paths; i++) {
        for (uint32_t k = 0; k < pilot->counts[i]; k++)
            pilot->probes[count++] = pilot->probes[(size_t)i * PATH_PROBES + k];
    }
    return count;
}

static bool samples_lights(const ppm_render_options *options)
{
    return options->integrator == PPM_INTEGRATOR_PATH || options->direct != PPM_DIRECT_PHOTONS;
}

ppm_status ppmi_light_pilot(const ppmi_job *job, ppmi_lights *lights, ppm_render_stats *stats)
{
    light_pilot pilot = {.job = job, .choices = ppmi_lights_choice_count(lights)};
    if (pilot.choices < 2 || !samples_lights(job->options)) return PPM_STATUS_OK;
    const uint64_t pixels = (uint64_t)job->options->width * job->options->height;
    pilot.paths = pixels < LEAST_PATHS  ? LEAST_PATHS
                  : pixels < MOST_PATHS ? (uint32_t)pixels
                                        : MOST_PATHS;
    pilot.probes = ppmi_alloc(job->context, pilot.paths, PATH_PROBES * sizeof *pilot.probes);
    pilot.counts = ppmi_alloc_zeroed(job->context, pilot.paths, sizeof *pilot.counts);
    ppm_status status = PPM_STATUS_OK;
    if (!pilot.probes || !pilot.counts) {
        status = ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: light probes");
    } else {
        trace(&pilot, stats);
        if (atomic_load(job->cancel)) status = PPM_STATUS_CANCELLED;
    }
    if (status == PPM_STATUS_OK) status = ppmi_lights_learn(lights, pilot.probes, compact(&pilot));
    ppmi_free(job->context, pilot.probes);
    ppmi_free(job->context, pilot.counts);
    return status;
}
