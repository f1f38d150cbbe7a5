/* The layers that are facts: sampled ones, a camera ray a pass, and those of one ray for all.
 *
 * A photon mapper's epoch (ppm) is one set of eye paths for many passes; its features then are of
 * the same paths, as often, so that mattes fit the picture's edges there too. */
#include "render/features.h"

#include <omp.h>
#include <string.h>

#include "render/crypto_layer.h"
#include "render/facts.h"

/* Mirrors in mirrors are followed so far, and then described themselves. */
enum { FOLLOWED_MOST = 64 };

enum { CRYPTO_COUNT = PPM_LAYER_CRYPTO_ASSET - PPM_LAYER_CRYPTO_OBJECT + 1 };

struct ppmi_features {
    ppmi_vec3 *albedo, *normal; /* sums over samples; NULL where the layer is not wanted */
    ppmi_facts facts;
    bool has_facts;                          /* some layer of theirs is wanted */
    ppmi_crypto_layer cryptos[CRYPTO_COUNT]; /* without counts where it is not wanted */
    bool has_samples;                        /* some sampled layer is wanted */
    uint64_t samples;                        /* in the sums, of each pixel */
};

static bool is_wanted(const ppmi_job *job, int32_t kind)
{
    return ppmi_layers_have(job->options, kind, kind);
}

/* ---- creation -------------------------------------------------------------------------------- */

ppm_status ppmi_features_check(ppm_context *context, const ppm_render_options *options)
{
    const uint32_t ranks = options->cryptomatte_ranks;
    if (ranks % 2 == 0 && ranks <= PPMI_CRYPTO_MAX_RANKS) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                     "%u ranks of Cryptomatte: expected an even number, at most %d", ranks,
                     PPMI_CRYPTO_MAX_RANKS);
}

void ppmi_features_destroy(const ppmi_job *job, ppmi_features *features)
{
    if (!features) return;
    ppmi_free(job->context, features->albedo);
    ppmi_free(job->context, features->normal);
    for (int i = 0; i < PPMI_FACT_COUNT; i++)
        ppmi_free(job->context, features->facts.values[i]);
    for (int i = 0; i < CRYPTO_COUNT; i++)
        ppmi_crypto_layer_deinit(job->context, &features->cryptos[i]);
    ppmi_free(job->context, features);
}

/* A picture of zeros; false when memory is out. */
static bool make_sums(const ppmi_job *job, int32_t kind, ppmi_vec3 **out_sums)
{
    if (!is_wanted(job, kind)) return true;
    *out_sums =
        ppmi_alloc_zeroed(job->context, ppmi_film_pixel_count(&job->film), sizeof **out_sums);
    return *out_sums != NULL;
}

static bool make_facts(const ppmi_job *job, ppmi_facts *facts)
{
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    for (int32_t kind = PPMI_FACT_FIRST; kind <= PPMI_FACT_LAST; kind++) {
        if (!is_wanted(job, kind)) continue;
        float **values = &facts->values[kind - PPMI_FACT_FIRST];
        *values =
            ppmi_alloc_zeroed(job->context, pixels, ppmi_fact_channels(kind) * sizeof **values);
        if (!*values) return false;
    }
    return true;
}

static ppm_status make_cryptos(const ppmi_job *job, ppmi_features *features)
{
    ppm_status status = PPM_STATUS_OK;
    for (int32_t i = 0; i < CRYPTO_COUNT && status == PPM_STATUS_OK; i++) {
        const int32_t kind = PPM_LAYER_CRYPTO_OBJECT + i;
        if (!is_wanted(job, kind)) continue;
        status = ppmi_crypto_layer_init(job->context, job->world.scene, kind,
                                        job->options->cryptomatte_ranks,
                                        ppmi_film_pixel_count(&job->film), &features->cryptos[i]);
    }
    return status;
}

ppm_status ppmi_features_create(const ppmi_job *job, ppmi_features **out_features)
{
    ppmi_features *features = ppmi_alloc_zeroed(job->context, 1, sizeof *features);
    if (!features || !make_sums(job, PPM_LAYER_ALBEDO, &features->albedo) ||
        !make_sums(job, PPM_LAYER_NORMAL, &features->normal) ||
        !make_facts(job, &features->facts)) {
        ppmi_features_destroy(job, features);
        return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: layers");
    }
    const ppm_status status = make_cryptos(job, features);
    if (status != PPM_STATUS_OK) {
        ppmi_features_destroy(job, features);
        return status;
    }
    features->has_facts = ppmi_layers_have(job->options, PPMI_FACT_FIRST, PPMI_FACT_LAST);
    features->has_samples =
        ppmi_layers_have(job->options, PPM_LAYER_ALBEDO, PPM_LAYER_NORMAL) ||
        ppmi_layers_have(job->options, PPM_LAYER_CRYPTO_OBJECT, PPM_LAYER_CRYPTO_ASSET);
    *out_features = features;
    return PPM_STATUS_OK;
}

/* ---- albedo and normal ----------------------------------------------------------------------- */

/* The surface that a path describes. */
typedef struct appearance {
    ppmi_vec3 albedo, normal;
} appearance;

/* On the side that the path came from, as the camera turns it if that is asked for. */
static ppmi_vec3 normal_of(const ppmi_job *job, const ppmi_walker *walker,
                           const ppmi_vertex *vertex, ppmi_vec3 direction)
{
    ppmi_material_point point;
    ppmi_material_evaluate(job->world.scene, &vertex->surface, &point);
    const bool is_back = vec3_dot(direction, vertex->surface.ng) > 0.0f;
    const ppmi_vec3 n = is_back ? vec3_neg(point.ns) : point.ns;
    if (!job->options->normals_of_camera) return n;
    const ppmi_camera_view view = ppmi_camera_view_at(&job->view, walker->time);
    return vec3(vec3_dot(n, vec3_normalize(view.right)), vec3_dot(n, vec3_normalize(view.up)),
                -vec3_dot(n, view.forward));
}

static appearance describe(const ppmi_job *job, const ppmi_walker *walker,
                           const ppmi_vertex *vertex, const ppmi_bsdf *bsdf, ppmi_vec3 direction,
                           uint32_t lobes)
{
    return (appearance){
        .albedo = ppmi_bsdf_albedo(bsdf, job->world.albedo, lobes),
        .normal = normal_of(job, walker, vertex, direction),
    };
}

/* Goes on by a lobe that is too narrow to be described. False where nothing goes on. */
static bool pass_on(ppmi_walker *walker, const ppmi_vertex *vertex, const ppmi_bsdf *bsdf,
                    uint32_t lobes, ppmi_vec3 *throughput, ppmi_ray *ray)
{
    const float u_lobe = ppmi_walker_float(walker);
    const float u = ppmi_walker_float(walker), v = ppmi_walker_float(walker);
    ppmi_bsdf_sample sample;
    if (!ppmi_bsdf_draw(bsdf, walker->world->albedo, lobes, PPMI_TRANSPORT_RADIANCE, u_lobe, u, v,
                        &sample)) {
        return false;
    }
    ppmi_vec3 cost = vec3_splat(1.0f); /* of dispersion: 1 on average, and only colour noise here */
    *ray = ppmi_walk_leave(walker, vertex, &sample, &cost);
    *throughput = vec3_scale(vec3_mul(*throughput, sample.weight), 1.0f / sample.eta_scale);
    return true;
}

/* What is seen at a vertex; with follows_specular, by mirrors and glass, or in them: each lobe is
 * followed or described as often as it returns light, so that the albedo is right on average. */
static appearance follow(const ppmi_job *job, ppmi_walker *walker, ppmi_vertex *vertex,
                         ppmi_ray ray)
{
    const appearance nothing = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    ppmi_vec3 throughput = vec3_splat(1.0f);
    const uint32_t last =
        job->options->max_depth < FOLLOWED_MOST ? job->options->max_depth : FOLLOWED_MOST;
    for (uint32_t depth = 1;; depth++) {
        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(walker, vertex, ray.direction, &bsdf);
        const uint32_t narrow = (uint32_t)(bsdf.lobes & ~bsdf.gather_lobes);
        if (!job->options->follows_specular || narrow == 0 || depth >= last) {
            appearance seen = describe(job, walker, vertex, &bsdf, ray.direction, PPMI_LOBE_ALL);
            seen.albedo = vec3_mul(seen.albedo, throughput);
            return seen;
        }
        const float gathering = ppmi_bsdf_probability(&bsdf, bsdf.gather_lobes);
        if (gathering > 0.0f && ppmi_walker_float(walker) < gathering) {
            appearance seen =
                describe(job, walker, vertex, &bsdf, ray.direction, bsdf.gather_lobes);
            seen.albedo = vec3_scale(vec3_mul(seen.albedo, throughput), 1.0f / gathering);
            return seen;
        }
        throughput = vec3_scale(throughput, 1.0f / (1.0f - gathering));
        if (!pass_on(walker, vertex, &bsdf, narrow, &throughput, &ray)) return nothing;
        if (ppmi_walk_both_ways(walker, ray, PPMI_RAY_OTHER, vertex, NULL, 0) != PPMI_AT_SURFACE) {
            return nothing;
        }
    }
}

/* ---- passes ---------------------------------------------------------------------------------- */

static void add_sum(ppmi_vec3 *sums, size_t pixel, ppmi_vec3 value)
{
    if (sums && vec3_is_finite(value)) sums[pixel] = vec3_add(sums[pixel], value);
}

static void sample_pixel(const ppmi_job *job, ppmi_features *features, ppmi_walker *walker,
                         uint32_t x, uint32_t y, uint64_t sample)
{
    const ppmi_camera_ray camera_ray = ppmi_start_camera_path(job, walker, x, y, sample);
    const ppmi_origin camera = {.is_delta = true};
    const size_t pixel = (size_t)y * job->film.width + x;
    ppmi_vertex vertex;
    /* the integrators look for lamps here: the same numbers then go to the same decisions */
    walker->origin = &camera;
    const ppmi_arrival arrival =
        ppmi_walk_both_ways(walker, camera_ray.ray, PPMI_RAY_CAMERA, &vertex, NULL, 0);
    walker->origin = NULL;
    if (arrival != PPMI_AT_SURFACE) return;
    for (int32_t i = 0; i < CRYPTO_COUNT; i++) {
        const bool is_of_material = PPM_LAYER_CRYPTO_OBJECT + i == PPM_LAYER_CRYPTO_MATERIAL;
        if (!features->cryptos[i].counts) continue;
        ppmi_crypto_layer_add(&features->cryptos[i], pixel,
                              is_of_material ? vertex.surface.primitive->material
                                             : vertex.hit.instance);
    }
    if (!features->albedo && !features->normal) return;
    const appearance seen = follow(job, walker, &vertex, camera_ray.ray);
    add_sum(features->albedo, pixel, seen.albedo);
    add_sum(features->normal, pixel, seen.normal);
}

/* The camera paths that pass number pass of the integrator shows. */
static uint64_t sample_of(const ppmi_job *job, uint64_t pass)
{
    const ppm_render_options *options = job->options;
    if (options->integrator != PPM_INTEGRATOR_PPM) return pass;
    if (options->photons_per_epoch == 0) return 0;
    const uint64_t passes =
        (options->photons_per_epoch - 1) / options->photons_per_pass + 1; /* an epoch */
    return pass / passes;
}

/* What a pass has to do. */
typedef struct feature_work {
    bool samples, facts;
    uint64_t sample;
} feature_work;

static uint64_t do_tile(const ppmi_job *job, ppmi_features *features, uint32_t index,
                        const feature_work *work)
{
    const ppmi_tile tile = ppmi_tile_at(&job->film, index);
    ppmi_walker walker = {.world = &job->world};
    uint64_t rays = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            if (work->facts) rays += ppmi_facts_find(job, &features->facts, x, y);
            if (work->samples) sample_pixel(job, features, &walker, x, y, work->sample);
        }
    }
    return rays + walker.rays;
}

void ppmi_features_pass(const ppmi_job *job, ppmi_features *features, uint64_t pass,
                        ppm_render_stats *stats)
{
    const double start = omp_get_wtime();
    const uint64_t sample = sample_of(job, pass);
    const bool is_one_for_all =
        job->options->integrator == PPM_INTEGRATOR_PPM && job->options->photons_per_epoch == 0;
    const feature_work work = {.samples = features->has_samples && (pass == 0 || !is_one_for_all),
                               .facts = features->has_facts && pass == 0,
                               .sample = sample};
    const uint32_t tiles = ppmi_tile_count(&job->film);
    if (!work.samples && !work.facts) return;
    uint64_t rays = 0;
#pragma omp parallel for num_threads((int)job->options->threads) schedule(dynamic, 1)             \
    reduction(+ : rays)
    for (uint32_t i = 0; i < tiles; i++)
        rays += do_tile(job, features, i, &work);
    features->samples += work.samples;
    stats->rays += rays;
    stats->seconds_eye += omp_get_wtime() - start;
}

/* ---- reading --------------------------------------------------------------------------------- */

static void read_mean(const ppmi_job *job, const ppmi_vec3 *sums, uint64_t samples, float *values)
{
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const float scale = (float)(1.0 / (double)samples);
    for (size_t i = 0; i < pixels; i++)
        vec3_store(values + 3 * i, vec3_scale(sums[i], scale));
}

void ppmi_features_read(const ppmi_job *job, const ppmi_features *features, const ppmi_layer *layer,
                        float *values)
{
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    if (layer->kind == PPM_LAYER_ALBEDO) {
        read_mean(job, features->albedo, features->samples, values);
    } else if (layer->kind == PPM_LAYER_NORMAL) {
        read_mean(job, features->normal, features->samples, values);
    } else if (layer->kind <= PPMI_FACT_LAST) {
        memcpy(values, features->facts.values[layer->kind - PPMI_FACT_FIRST],
               pixels * layer->channel_count * sizeof *values);
    } else {
        ppmi_crypto_layer_read(&features->cryptos[layer->kind - PPM_LAYER_CRYPTO_OBJECT], pixels,
                               layer->number, features->samples, values);
    }
}

const char *ppmi_features_manifest(const ppmi_features *features, int32_t kind)
{
    if (!features || kind < PPM_LAYER_CRYPTO_OBJECT || kind > PPM_LAYER_CRYPTO_ASSET) return NULL;
    return features->cryptos[kind - PPM_LAYER_CRYPTO_OBJECT].manifest;
}
