/* The photon pass: emission, bounces, Russian roulette (Jensen 2001, "Realistic Image Synthesis
 * Using Photon Mapping", chapter 5). */
#include "photon/walk.h"

#include <omp.h>
#include <string.h>

/* Photons are handed to threads by the chunk; a chunk's photons stay together, so that their order
 * can be restored. */
enum { CHUNK = 512 };

/* Emission and the first bounce are stratified. */
enum { STRATIFIED_SETS = 2 };

typedef struct ppmi_photon_chunk {
    uint32_t list; /* thread that walked it */
    size_t begin, count;
} ppmi_photon_chunk;

/* Radiance carries the shading normal's cosine, photons the geometric one's: the factor that makes
 * both agree (Veach 1997, equation 5.19). wo is where the photon came from, wi where it goes. */
static float shading_normal_factor(const ppmi_bsdf *bsdf, ppmi_vec3 wo, ppmi_vec3 wi)
{
    const float numerator = fabsf(vec3_dot(wo, bsdf->frame.n) * vec3_dot(wi, bsdf->ng));
    const float denominator = fabsf(vec3_dot(wo, bsdf->ng) * vec3_dot(wi, bsdf->frame.n));
    return denominator > 1e-8f ? ppmi_min(numerator / denominator, 1e2f) : 1.0f;
}

/* One bounce; false when the photon ends. Roulette keeps the power of survivors where it was. */
static bool bounce(ppmi_walker *walker, const ppmi_bsdf *bsdf, const ppmi_surface *surface,
                   ppmi_ray *ray, ppmi_vec3 *power)
{
    const float u_lobe = ppmi_walker_float(walker), u = ppmi_walker_float(walker),
                v = ppmi_walker_float(walker);
    ppmi_bsdf_sample sample;
    if (!ppmi_bsdf_draw(bsdf, walker->world->albedo, PPMI_LOBE_ALL, PPMI_TRANSPORT_POWER, u_lobe, u,
                        v, &sample)) {
        return false;
    }
    const float factor = shading_normal_factor(bsdf, vec3_neg(ray->direction), sample.wi);
    const ppmi_vec3 next = vec3_scale(vec3_mul(*power, sample.weight), factor);
    const float survival = ppmi_min(1.0f, vec3_max_component(next) / vec3_max_component(*power));
    if (!(survival > 0.0f) || ppmi_rng_float(&walker->rng) >= survival) return false;
    *power = vec3_scale(next, 1.0f / survival);
    *ray = ppmi_surface_ray(surface, sample.wi);
    return true;
}

static bool store(ppm_context *context, ppmi_photon_list *list, const ppmi_vertex *vertex,
                  const ppmi_bsdf *bsdf, const ppmi_ray *ray, ppmi_vec3 power)
{
    const ppmi_photon photon = {
        .position = vertex->surface.position,
        .wi = vec3_neg(ray->direction),
        .power = power,
        .ng = bsdf->ng,
    };
    return ppmi_photon_list_push(context, list, &photon);
}

/* Follows one photon to its end. False when memory is out. */
static bool walk_photon(ppm_context *context, ppmi_walker *walker, ppmi_emission emission,
                        uint32_t max_depth, ppmi_photon_list *list)
{
    ppmi_ray ray = emission.ray;
    ppmi_vec3 power = emission.power;
    for (uint32_t depth = 0; depth < max_depth; depth++) {
        ppmi_vertex vertex;
        if (!ppmi_walk_to_surface(walker, ray, PPMI_RAY_OTHER, &vertex)) return true;
        power = vec3_mul(power, vertex.transmittance);
        if (vec3_is_black(power)) return true;
        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(walker, &vertex, ray.direction, &bsdf);
        if (depth > 0 && bsdf.gather_lobes != 0 &&
            !store(context, list, &vertex, &bsdf, &ray, power)) {
            return false;
        }
        if (!bounce(walker, &bsdf, &vertex.surface, &ray, &power)) return true;
    }
    return true;
}

static bool walk_chunk(ppm_context *context, const ppmi_photon_walk *walk, uint32_t begin,
                       uint32_t end, ppmi_photon_list *list, uint64_t *rays)
{
    ppmi_walker walker = {.world = walk->world};
    for (uint32_t i = begin; i < end; i++) {
        const uint64_t index = walk->first_index + i;
        /* the sequence has 2^32 points; each block of that many is scrambled anew */
        const uint64_t seed = walk->seed ^ ppmi_hash64((index >> 32) + PPMI_STREAM_PHOTON);
        const double pick = ppmi_sobol1((uint32_t)index, 0, seed);
        ppmi_walker_start(&walker, ppmi_rng_start(walk->seed, PPMI_STREAM_PHOTON, index), seed,
                          (uint32_t)index, 0, STRATIFIED_SETS);
        float u[4];
        for (int k = 0; k < 4; k++)
            u[k] = ppmi_walker_float(&walker);
        ppmi_emission emission;
        if (!ppmi_lights_emit(walk->world->lights, pick, u, &emission)) continue;
        if (!walk_photon(context, &walker, emission, walk->max_depth, list)) return false;
    }
    *rays += walker.rays;
    return true;
}

static ppm_status prepare(ppm_context *context, const ppmi_photon_walk *walk, uint32_t chunk_count,
                          ppmi_photon_scratch *scratch)
{
    if (!scratch->lists) {
        scratch->lists = ppmi_alloc_zeroed(context, walk->threads, sizeof *scratch->lists);
        scratch->list_count = scratch->lists ? walk->threads : 0;
    }
    if (scratch->chunk_capacity < chunk_count) {
        ppmi_free(context, scratch->chunks);
        scratch->chunks = ppmi_alloc(context, chunk_count, sizeof *scratch->chunks);
        scratch->chunk_capacity = scratch->chunks ? chunk_count : 0;
    }
    if (!scratch->lists || !scratch->chunks) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: photon lists");
    }
    for (uint32_t i = 0; i < scratch->list_count; i++)
        scratch->lists[i].count = 0;
    return PPM_STATUS_OK;
}

/* Appends the chunks in order of emission. */
static ppm_status collect(ppm_context *context, const ppmi_photon_scratch *scratch,
                          uint32_t chunk_count, ppmi_photon_list *out_photons)
{
    size_t total = out_photons->count;
    for (uint32_t i = 0; i < chunk_count; i++)
        total += scratch->chunks[i].count;
    if (!ppmi_photon_list_reserve(context, out_photons, total)) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu photons", total);
    }
    for (uint32_t i = 0; i < chunk_count; i++) {
        const ppmi_photon_chunk *chunk = &scratch->chunks[i];
        if (chunk->count == 0) continue;
        memcpy(out_photons->photons + out_photons->count,
               scratch->lists[chunk->list].photons + chunk->begin,
               chunk->count * sizeof *out_photons->photons);
        out_photons->count += chunk->count;
    }
    return PPM_STATUS_OK;
}

ppm_status ppmi_photon_walk_run(ppm_context *context, const ppmi_photon_walk *walk,
                                ppmi_photon_scratch *scratch, ppmi_photon_list *out_photons,
                                uint64_t *out_rays)
{
    const uint32_t chunk_count = (walk->count + CHUNK - 1) / CHUNK;
    if (chunk_count == 0) return PPM_STATUS_OK;
    const ppm_status status = prepare(context, walk, chunk_count, scratch);
    if (status != PPM_STATUS_OK) return status;
    uint64_t rays = 0;
    atomic_bool failed = false;
#pragma omp parallel num_threads((int)walk->threads) reduction(+ : rays)
    {
        const uint32_t thread = (uint32_t)omp_get_thread_num();
        ppmi_photon_list *list = &scratch->lists[thread];
#pragma omp for schedule(dynamic, 1)
        for (uint32_t c = 0; c < chunk_count; c++) {
            if (atomic_load_explicit(walk->cancel, memory_order_relaxed) ||
                atomic_load_explicit(&failed, memory_order_relaxed)) {
                continue;
            }
            const uint32_t begin = c * CHUNK;
            const uint32_t end = walk->count - begin < CHUNK ? walk->count : begin + CHUNK;
            const size_t first = list->count;
            if (!walk_chunk(context, walk, begin, end, list, &rays)) {
                atomic_store_explicit(&failed, true, memory_order_relaxed);
            }
            scratch->chunks[c] = (ppmi_photon_chunk){thread, first, list->count - first};
        }
    }
    *out_rays += rays;
    if (atomic_load(walk->cancel)) return PPM_STATUS_CANCELLED;
    if (atomic_load(&failed)) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: photons");
    }
    return collect(context, scratch, chunk_count, out_photons);
}

void ppmi_photon_scratch_deinit(ppm_context *context, ppmi_photon_scratch *scratch)
{
    for (uint32_t i = 0; i < scratch->list_count; i++) {
        ppmi_photon_list_deinit(context, &scratch->lists[i]);
    }
    ppmi_free(context, scratch->lists);
    ppmi_free(context, scratch->chunks);
    *scratch = (ppmi_photon_scratch){0};
}
