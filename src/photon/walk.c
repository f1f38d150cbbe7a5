/* The photon pass: emission, bounces, Russian roulette (Jensen 2001, "Realistic Image Synthesis
 * Using Photon Mapping", chapter 5). */
#include "photon/walk.h"

#include <omp.h>
#include <string.h>

#include "photon/adjoint.h"
#include "photon/point.h"

#include "transport/roulette.h"
#include "transport/solid.h"

/* Photons are handed to threads by the chunk; a chunk's photons stay together, so that their order
 * can be restored. */
enum { CHUNK = 512 };

/* Emission and the first bounce are stratified. */
enum { STRATIFIED_SETS = 2 };

/* Of sobol1, beside that of the choice of light. */
enum { TIME_SET = 1 };

typedef struct ppmi_photon_chunk {
    uint32_t thread; /* that walked it */
    size_t begin[PPMI_PHOTON_KINDS], count[PPMI_PHOTON_KINDS];
} ppmi_photon_chunk;

/* A photon on its way. */
typedef struct photon_state {
    ppmi_ray ray;
    ppmi_vec3 power;
    ppmi_photon_history history;
    float crowding;  /* of its light, as long as it met mirrors and smooth glass only; else 0 */
    uint32_t depth;  /* number of its next vertex */
    uint32_t passed; /* of those before it: thin sheets, straight from the light */
} photon_state;

/* What a walk's photons have in common. */
typedef struct photon_path {
    ppm_context *context;
    const ppmi_photon_walk *walk;
    ppmi_walker *walker;
    ppmi_photon_list *lists;
    uint32_t path, group;
} photon_path;

static bool draw(ppmi_walker *walker, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                 ppmi_vec3 direction, ppmi_bsdf_sample *sample)
{
    if (ppmi_adjoint_leans(bsdf)) {
        return ppmi_adjoint_draw(walker, vertex, bsdf, vec3_neg(direction), sample);
    }
    const float u_lobe = ppmi_walker_float(walker), u = ppmi_walker_float(walker),
                v = ppmi_walker_float(walker);
    return ppmi_bsdf_draw(bsdf, walker->world->albedo, PPMI_LOBE_ALL, PPMI_TRANSPORT_POWER, u_lobe,
                          u, v, sample);
}

/* One bounce; false when the photon ends. Roulette keeps the power of survivors at what it was
 * before the way here: absorption on the way counts too. */
static bool bounce(const photon_path *path, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                   float power_before, photon_state *photon)
{
    ppmi_walker *walker = path->walker;
    ppmi_bsdf_sample sample;
    if (!draw(walker, vertex, bsdf, photon->ray.direction, &sample)) return false;
    const ppmi_vec3 next = vec3_mul(photon->power, sample.weight);
    const float survival = ppmi_roulette_survival(vec3_max_component(next) / power_before,
                                                  photon->depth, PPMI_ROULETTE_OF_PHOTONS);
    if (!(survival > 0.0f) || ppmi_rng_float(&walker->rng) >= survival) return false;
    photon->power = vec3_scale(next, 1.0f / survival);
    photon->ray = ppmi_walk_leave(walker, vertex, &sample, &photon->power);
    if (photon->passed == photon->depth && ppmi_bsdf_goes_straight(bsdf, &sample)) {
        photon->passed++;
    }
    photon->depth++;
    if (!sample.is_delta) photon->crowding = 0.0f;
    if (path->walk->tags_photons) {
        ppmi_photon_history_scatter(&photon->history, bsdf, walker->world->albedo, sample.wi,
                                    sample.is_delta);
    }
    return true;
}

/* A half transparent surface stops its share of the photons, as it does of eye paths: those that
 * are stopped stand for all that came, or its opacity would count twice. */
static ppmi_vec3 arriving_power(const ppm_scene *scene, const ppmi_vertex *vertex, ppmi_vec3 power)
{
    if (vertex->medium || !vertex->surface.material->has_alpha) return power;
    return vec3_scale(power, 1.0f / ppmi_surface_opacity(scene, &vertex->surface));
}

static uint8_t of_255(float share)
{
    return (uint8_t)(255.0f * ppmi_clampf(share, 0.0f, 1.0f) + 0.5f);
}

static ppmi_photon_tag tag_of(const ppmi_photon_history *history, uint32_t group, bool is_in_medium)
{
    const ppmi_vec3 caustic = ppmi_photon_history_caustic(history, is_in_medium);
    return (ppmi_photon_tag){.group = group,
                             .is_straight = history->is_straight,
                             .caustic = {of_255(caustic.x), of_255(caustic.y), of_255(caustic.z)}};
}

static bool store(const photon_path *path, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                  const photon_state *photon)
{
    const ppmi_photon_walk *walk = path->walk;
    ppmi_photon landed = {
        .position = vertex->surface.position,
        .wi = vec3_neg(photon->ray.direction),
        .power = arriving_power(walk->world->scene, vertex, photon->power),
        .ng = bsdf->ng,
        .crowding = photon->crowding,
        .path = path->path,
    };
    if (walk->tags_photons) {
        landed.tag = tag_of(&photon->history, path->group, vertex->medium != NULL);
    }
    const int kind = vertex->medium ? PPMI_PHOTONS_VOLUME : PPMI_PHOTONS_SURFACE;
    return ppmi_photon_list_push(path->context, &path->lists[kind], &landed);
}

/* Narrow lobes want photons that came over mirrors and smooth glass only. */
static bool counts_somewhere(const ppmi_bsdf *bsdf, const photon_state *photon)
{
    return bsdf->gather_lobes != 0 || (photon->crowding > 0.0f && ppmi_narrow_lobes(bsdf) != 0);
}

static bool follow(const photon_path *path, photon_state photon);

/* The others of those that a photon splits into. False when memory is out. */
static bool follow_copies(const photon_path *path, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                          float power_before, const photon_state *photon, uint32_t count)
{
    ppmi_walker *walker = path->walker;
    const ppmi_interior interior = walker->interior;
    const float wavelength = walker->wavelength_nm;
    for (uint32_t i = 0; i < count; i++) {
        photon_state copy = *photon;
        if (bounce(path, vertex, bsdf, power_before, &copy) && !follow(path, copy)) return false;
        walker->interior = interior;
        walker->wavelength_nm = wavelength;
    }
    return true;
}

/* Follows a photon to its end. False when memory is out. */
static bool follow(const photon_path *path, photon_state photon)
{
    const ppmi_photon_walk *walk = path->walk;
    while (photon.depth < walk->max_depth) {
        ppmi_vertex vertex;
        if (ppmi_walk(path->walker, photon.ray, PPMI_RAY_OTHER, &vertex) == PPMI_ESCAPED) {
            return true;
        }
        const float power_before = vec3_max_component(photon.power);
        photon.power = vec3_mul(photon.power, vertex.transmittance);
        if (vec3_is_black(photon.power)) return true;
        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(path->walker, &vertex, photon.ray.direction, &bsdf);
        if (photon.depth - photon.passed >= walk->first_depth && counts_somewhere(&bsdf, &photon) &&
            !store(path, &vertex, &bsdf, &photon)) {
            return false;
        }
        const uint32_t split = ppmi_adjoint_split(&bsdf, vec3_neg(photon.ray.direction));
        photon.power = vec3_scale(photon.power, 1.0f / (float)split);
        if (split > 1 && !follow_copies(path, &vertex, &bsdf, power_before, &photon, split - 1)) {
            return false;
        }
        if (!bounce(path, &vertex, &bsdf, power_before, &photon)) return true;
    }
    return true;
}

/* False when memory is out. */
static bool walk_photon(ppm_context *context, const ppmi_photon_walk *walk, ppmi_walker *walker,
                        ppmi_emission emission, uint32_t index, ppmi_photon_list *lists)
{
    const ppmi_lights *lights = walk->world->lights;
    const photon_path path = {
        .context = context,
        .walk = walk,
        .walker = walker,
        .lists = lists,
        .path = index,
        .group = walk->groups ? ppmi_light_groups_of(walk->groups, lights, emission.emitter) : 0};
    return follow(&path, (photon_state){.ray = emission.ray,
                                        .power = emission.power,
                                        .crowding = emission.crowding,
                                        .history = ppmi_photon_history_start()});
}

/* The sequence has 2^32 points; each block of that many is scrambled anew. */
static uint64_t stratified_seed(const ppmi_photon_walk *walk, uint64_t index)
{
    return walk->seed ^ ppmi_hash64((index >> 32) + PPMI_STREAM_PHOTON);
}

/* Draws the numbers of a photon's emission; returns their density. */
static double start_photon(const ppmi_photon_walk *walk, ppmi_walker *walker, uint32_t i,
                           ppmi_emission_sample *sample)
{
    const uint64_t index = walk->first_index + i;
    const uint64_t seed = stratified_seed(walk, index);
    ppmi_walker_start(walker, ppmi_rng_start(walk->seed, PPMI_STREAM_PHOTON, index), seed,
                      (uint32_t)index, 0, STRATIFIED_SETS);
    if (walk->shutter_is_open) {
        walker->time =
            walk->has_one_time ? walk->time : (float)ppmi_sobol1((uint32_t)index, TIME_SET, seed);
    }
    sample->x[0] = ppmi_sobol1((uint32_t)index, 0, seed);
    for (int k = 1; k < PPMI_GUIDE_AXES; k++)
        sample->x[k] = ppmi_walker_double(walker);
    return walk->guide ? ppmi_guide_warp(walk->guide, sample) : 1.0;
}

double ppmi_photon_walk_sample(const ppmi_photon_walk *walk, uint32_t i,
                               ppmi_emission_sample *out_sample)
{
    ppmi_walker walker;
    return start_photon(walk, &walker, i, out_sample);
}

static float unit_float(double x)
{
    const float value = (float)x;
    return value < 1.0f ? value : 0x1.fffffep-1f;
}

static bool emit(const ppmi_photon_walk *walk, const ppmi_emission_sample *sample, float time,
                 ppmi_emission *out_emission)
{
    const float u[4] = {unit_float(sample->x[1]), unit_float(sample->x[2]),
                        unit_float(sample->x[3]), unit_float(sample->x[4])};
    return walk->aim
               ? ppmi_aim_emit(walk->aim, time, sample->x[0], u, out_emission)
               : ppmi_lights_emit_at(walk->world->lights, time, sample->x[0], u, out_emission);
}

static bool walk_chunk(ppm_context *context, const ppmi_photon_walk *walk, uint32_t begin,
                       uint32_t end, ppmi_photon_list *lists, uint64_t *rays)
{
    ppmi_walker walker = {.world = walk->world};
    ppmi_solids_memory memory = {.is_known = false};
    for (uint32_t i = begin; i < end; i++) {
        if (atomic_load_explicit(walk->cancel, memory_order_relaxed)) break;
        ppmi_emission_sample sample;
        const double density = start_photon(walk, &walker, i, &sample);
        ppmi_emission emission;
        if (!emit(walk, &sample, walker.time, &emission)) continue;
        emission.power = vec3_scale(emission.power, (float)(1.0 / density));
        walker.interior =
            ppmi_solids_around_photon(walk->world, &emission.ray, emission.is_far, &memory);
        if (!walk_photon(context, walk, &walker, emission, i, lists)) return false;
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
    for (uint32_t i = 0; i < scratch->list_count; i++) {
        for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++)
            scratch->lists[i][kind].count = 0;
    }
    return PPM_STATUS_OK;
}

/* Appends the chunks in order of emission. */
static ppm_status collect(ppm_context *context, const ppmi_photon_scratch *scratch,
                          uint32_t chunk_count, int kind, ppmi_photon_list *out_photons)
{
    size_t total = out_photons->count;
    for (uint32_t i = 0; i < chunk_count; i++)
        total += scratch->chunks[i].count[kind];
    if (!ppmi_photon_list_reserve(context, out_photons, total)) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu photons", total);
    }
    for (uint32_t i = 0; i < chunk_count; i++) {
        const ppmi_photon_chunk *chunk = &scratch->chunks[i];
        if (chunk->count[kind] == 0) continue;
        memcpy(out_photons->photons + out_photons->count,
               scratch->lists[chunk->thread][kind].photons + chunk->begin[kind],
               chunk->count[kind] * sizeof *out_photons->photons);
        out_photons->count += chunk->count[kind];
    }
    return PPM_STATUS_OK;
}

/* One chunk by the calling thread. False when memory is out. */
static bool run_chunk(ppm_context *context, const ppmi_photon_walk *walk,
                      const ppmi_photon_scratch *scratch, uint32_t index, uint64_t *rays)
{
    const uint32_t thread = (uint32_t)omp_get_thread_num();
    ppmi_photon_list *lists = scratch->lists[thread];
    ppmi_photon_chunk *chunk = &scratch->chunks[index];
    const uint32_t begin = index * CHUNK;
    const uint32_t end = walk->count - begin < CHUNK ? walk->count : begin + CHUNK;
    chunk->thread = thread;
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++)
        chunk->begin[kind] = lists[kind].count;
    const bool is_done = walk_chunk(context, walk, begin, end, lists, rays);
    for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++)
        chunk->count[kind] = lists[kind].count - chunk->begin[kind];
    return is_done;
}

ppm_status ppmi_photon_walk_run(ppm_context *context, const ppmi_photon_walk *walk,
                                ppmi_photon_scratch *scratch,
                                ppmi_photon_list out_photons[PPMI_PHOTON_KINDS], uint64_t *out_rays)
{
    const uint32_t chunk_count = (walk->count + CHUNK - 1) / CHUNK;
    if (chunk_count == 0) return PPM_STATUS_OK;
    ppm_status status = prepare(context, walk, chunk_count, scratch);
    if (status != PPM_STATUS_OK) return status;
    uint64_t rays = 0;
    atomic_bool failed = false;
#pragma omp parallel for num_threads((int)walk->threads) reduction(+ : rays) schedule(dynamic, 1)
    for (uint32_t c = 0; c < chunk_count; c++) {
        if (atomic_load_explicit(walk->cancel, memory_order_relaxed) ||
            atomic_load_explicit(&failed, memory_order_relaxed)) {
            continue;
        }
        if (!run_chunk(context, walk, scratch, c, &rays)) {
            atomic_store_explicit(&failed, true, memory_order_relaxed);
        }
    }
    *out_rays += rays;
    if (atomic_load(walk->cancel)) return PPM_STATUS_CANCELLED;
    if (atomic_load(&failed)) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: photons");
    }
    for (int kind = 0; kind < PPMI_PHOTON_KINDS && status == PPM_STATUS_OK; kind++) {
        status = collect(context, scratch, chunk_count, kind, &out_photons[kind]);
    }
    return status;
}

void ppmi_photon_scratch_deinit(ppm_context *context, ppmi_photon_scratch *scratch)
{
    for (uint32_t i = 0; i < scratch->list_count; i++) {
        for (int kind = 0; kind < PPMI_PHOTON_KINDS; kind++) {
            ppmi_photon_list_deinit(context, &scratch->lists[i][kind]);
        }
    }
    ppmi_free(context, scratch->lists);
    ppmi_free(context, scratch->chunks);
    *scratch = (ppmi_photon_scratch){0};
}
