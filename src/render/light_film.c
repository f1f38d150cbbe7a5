/* Layers of the integrators. */
#include "render/light_film.h"

#include <omp.h>
#include <string.h>

#include "render/layer_list.h"

enum { FIRST_CLASS = PPM_LAYER_DIFFUSE_DIRECT, CLASSES = PPM_LAYER_VOLUME };

/* ---- what is kept ---------------------------------------------------------------------------- */

static bool wants(const ppmi_job *job, int32_t kind)
{
    return ppmi_layers_have(job->options, kind, kind);
}

static ppmi_light_planes choose_planes(const ppmi_job *job)
{
    ppmi_light_planes planes = {.lights = job->world.lights,
                                .groups = job->groups,
                                .of_group = -1,
                                .of_group_caustics = -1};
    const bool all_classes = wants(job, PPM_LAYER_LIGHT_VARIANCE);
    for (int32_t kind = 0; kind <= PPM_LAYER_VOLUME; kind++) {
        const bool is_kept = kind >= FIRST_CLASS && (all_classes || wants(job, kind));
        planes.of_class[kind] = is_kept ? (int32_t)planes.count++ : -1;
    }
    if (!job->groups) return planes;
    if (wants(job, PPM_LAYER_LIGHT_GROUP)) {
        planes.of_group = (int32_t)planes.count;
        planes.count += job->groups->count;
    }
    if (wants(job, PPM_LAYER_GROUP_CAUSTICS)) {
        planes.of_group_caustics = (int32_t)planes.count;
        planes.count += job->groups->count;
    }
    return planes;
}

static size_t place(ppmi_light_record *record, bool is_kept, size_t floats)
{
    if (!is_kept) return SIZE_MAX;
    const size_t at = record->size;
    record->size += floats;
    return at;
}

static bool keeps_catchers(const ppmi_job *job)
{
    return wants(job, PPM_LAYER_CATCHER) || ppm_scene_catcher_count(job->world.scene) > 0;
}

static ppmi_light_record lay_out(const ppmi_job *job, const ppmi_light_planes *planes)
{
    ppmi_light_record record = {0};
    const bool has_variance = wants(job, PPM_LAYER_VARIANCE);
    record.planes = place(&record, planes->count > 0, 3 * (size_t)planes->count);
    record.combined = place(&record, has_variance, 3);
    record.variance = place(&record, has_variance, 3);
    record.class_variance =
        place(&record, wants(job, PPM_LAYER_LIGHT_VARIANCE), 3 * (size_t)CLASSES);
    record.first_passes = place(&record, wants(job, PPM_LAYER_DENOISED), 3);
    record.density = place(&record, wants(job, PPM_LAYER_PHOTON_DENSITY), 1);
    record.radius = place(&record, wants(job, PPM_LAYER_RADIUS), 1);
    record.catcher = place(&record, keeps_catchers(job), 4);
    record.seen_through = place(&record, job->options->is_transparent != 0, 1);
    return record;
}

ppm_status ppmi_light_film_init(const ppmi_job *job, size_t scratch_sets, ppmi_light_film *film)
{
    *film = (ppmi_light_film){.planes = choose_planes(job)};
    film->record = lay_out(job, &film->planes);
    if (!ppmi_light_film_is_kept(film)) return PPM_STATUS_OK;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const size_t bytes = film->record.size * sizeof(float);
    film->scratch_planes = scratch_sets * film->planes.count;
    film->now = ppmi_alloc_zeroed(job->context, pixels, bytes);
    film->next = ppmi_alloc_zeroed(job->context, pixels, bytes);
    film->scratch = ppmi_alloc_zeroed(job->context, job->options->threads,
                                      (film->scratch_planes + 1) * sizeof *film->scratch);
    if (film->now && film->next && film->scratch) return PPM_STATUS_OK;
    ppmi_light_film_deinit(job, film);
    return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY,
                     "out of memory: %zu pixels of %zu bytes for layers", pixels, 2 * bytes);
}

void ppmi_light_film_deinit(const ppmi_job *job, ppmi_light_film *film)
{
    ppmi_free(job->context, film->now);
    ppmi_free(job->context, film->next);
    ppmi_free(job->context, film->scratch);
    *film = (ppmi_light_film){0};
}

/* ---- a pass ---------------------------------------------------------------------------------- */

ppmi_vec3 *ppmi_light_film_clear_scratch(const ppmi_light_film *film)
{
    ppmi_vec3 *scratch = film->scratch + (size_t)omp_get_thread_num() * (film->scratch_planes + 1);
    memset(scratch, 0, film->scratch_planes * sizeof *scratch);
    return scratch;
}

ppmi_light_sink ppmi_light_film_sink(const ppmi_light_film *film, ppmi_vec3 *planes,
                                     ppmi_light_seen *seen)
{
    return (ppmi_light_sink){&film->planes, planes, seen, film->record.seen_through != SIZE_MAX};
}

/* The sum of squared differences from the mean (Welford 1962), of which sum is the sum before x. */
static void add_square(float *squares, const float *sum, ppmi_vec3 x, uint64_t count)
{
    if (count == 0) return;
    const ppmi_vec3 before = vec3_load(sum);
    const ppmi_vec3 mean = vec3_scale(before, 1.0f / (float)count);
    const ppmi_vec3 next_mean = vec3_scale(vec3_add(before, x), 1.0f / ((float)count + 1.0f));
    const ppmi_vec3 square = vec3_mul(vec3_sub(x, mean), vec3_sub(x, next_mean));
    vec3_store(squares, vec3_add(vec3_load(squares), square));
}

static void add_to(float *sum, ppmi_vec3 x)
{
    vec3_store(sum, vec3_add(vec3_load(sum), x));
}

static void add_class_squares(const ppmi_light_film *film, float *record, uint64_t pass,
                              const ppmi_light_pass *light)
{
    for (int32_t kind = FIRST_CLASS; kind <= PPM_LAYER_VOLUME; kind++) {
        const size_t plane = (size_t)film->planes.of_class[kind];
        add_square(record + film->record.class_variance + 3 * (size_t)(kind - FIRST_CLASS),
                   record + film->record.planes + 3 * plane, light->planes[plane], pass);
    }
}

/* Keeps the sum over the passes so far if their number is a power of two. */
static void keep_first_passes(const ppmi_light_film *film, float *record, uint64_t passes)
{
    if (passes == 0 || (passes & (passes - 1)) != 0) return;
    const size_t plane = (size_t)film->planes.of_class[PPM_LAYER_DIFFUSE_DIRECT];
    memcpy(record + film->record.first_passes, record + film->record.planes + 3 * plane,
           3 * sizeof *record);
}

void ppmi_light_film_add(ppmi_light_film *film, size_t pixel, uint64_t pass,
                         const ppmi_light_pass *light)
{
    const ppmi_light_record *at = &film->record;
    float *record = film->next + pixel * at->size;
    memcpy(record, film->now + pixel * at->size, at->size * sizeof *record);
    if (at->class_variance != SIZE_MAX) add_class_squares(film, record, pass, light);
    if (at->first_passes != SIZE_MAX) keep_first_passes(film, record, pass);
    for (size_t i = 0; i < film->planes.count; i++)
        add_to(record + at->planes + 3 * i, light->planes[i]);
    if (at->variance != SIZE_MAX) {
        add_square(record + at->variance, record + at->combined, light->combined, pass);
        add_to(record + at->combined, light->combined);
    }
    if (at->density != SIZE_MAX) record[at->density] += light->photons_per_area;
    if (at->radius != SIZE_MAX && light->radius_m > 0.0f) record[at->radius] = light->radius_m;
    if (at->seen_through != SIZE_MAX) record[at->seen_through] += light->seen.through;
    if (at->catcher != SIZE_MAX && light->seen.is_catcher) {
        add_to(record + at->catcher, light->combined);
        record[at->catcher + 3] += 1.0f;
    }
}

void ppmi_light_film_commit(ppmi_light_film *film)
{
    float *now = film->now;
    film->now = film->next;
    film->next = now;
}

/* ---- reading --------------------------------------------------------------------------------- */

float ppmi_light_film_alpha(const ppmi_light_film *film, size_t pixel, uint64_t passes)
{
    if (!film->now || film->record.seen_through == SIZE_MAX) return 1.0f;
    const float sum = film->now[pixel * film->record.size + film->record.seen_through];
    return ppmi_clampf(1.0f - sum / (float)passes, 0.0f, 1.0f);
}

/* Where a layer's first value is in the records. */
static size_t place_of(const ppmi_light_film *film, int32_t kind, uint32_t number)
{
    const ppmi_light_record *at = &film->record;
    const ppmi_light_planes *planes = &film->planes;
    switch (kind) {
    case PPM_LAYER_LIGHT_GROUP:
        return at->planes + 3 * ((size_t)planes->of_group + number);
    case PPM_LAYER_GROUP_CAUSTICS:
        return at->planes + 3 * ((size_t)planes->of_group_caustics + number);
    case PPM_LAYER_VARIANCE:
        return at->variance;
    case PPM_LAYER_LIGHT_VARIANCE:
        return at->class_variance + 3 * (size_t)number;
    case PPMI_LAYER_FIRST_PASSES:
        return at->first_passes;
    case PPM_LAYER_CATCHER:
        return at->catcher;
    case PPM_LAYER_PHOTON_DENSITY:
        return at->density;
    case PPM_LAYER_RADIUS:
        return at->radius;
    default:
        return at->planes + 3 * (size_t)planes->of_class[kind];
    }
}

uint64_t ppmi_light_first_passes(uint64_t passes)
{
    uint64_t first = 1;
    while (2 * first < passes)
        first *= 2;
    return first;
}

/* What a value is multiplied by. */
static float scale_of(int32_t kind, uint64_t passes)
{
    switch (kind) {
    case PPM_LAYER_VARIANCE:
    case PPM_LAYER_LIGHT_VARIANCE: /* of the mean; one pass tells nothing of it */
        return passes > 1 ? (float)(1.0 / ((double)passes * (double)(passes - 1))) : 0.0f;
    case PPM_LAYER_PHOTON_DENSITY:
    case PPM_LAYER_RADIUS:
        return 1.0f;
    case PPMI_LAYER_FIRST_PASSES:
        return 1.0f / (float)ppmi_light_first_passes(passes);
    default:
        return 1.0f / (float)passes;
    }
}

void ppmi_light_film_read(const ppmi_job *job, const ppmi_light_film *film, int32_t kind,
                          uint32_t number, uint64_t passes, float *values)
{
    const bool is_single = kind == PPM_LAYER_PHOTON_DENSITY || kind == PPM_LAYER_RADIUS;
    const size_t channels = is_single ? 1 : kind == PPM_LAYER_CATCHER ? 4 : 3;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const size_t place = place_of(film, kind, number);
    const float scale = scale_of(kind, passes);
    for (size_t i = 0; i < pixels; i++) {
        const float *from = film->now + i * film->record.size + place;
        for (size_t c = 0; c < channels; c++)
            values[channels * i + c] = scale * from[c];
    }
}
