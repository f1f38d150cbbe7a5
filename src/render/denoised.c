/* Layer by layer: each kind of light has noise of its own, and the edge of a caustic is far sharper
 * against its own layer than in the noise of all light together. */
#include "render/denoised.h"

#include "denoise/denoise.h"
#include "denoise/stratified.h"
#include "render/light_film.h"

/* Pictures of three floats a pixel but for depth and share. */
typedef struct denoised_memory {
    float *albedo, *normal, *depth, *light, *filtered, *variance, *first, *scratch;
    float *share; /* of what the filter changes that the picture takes; NULL: all of it */
} denoised_memory;

static float *make_plane(const ppmi_job *job, size_t channels)
{
    return ppmi_alloc(job->context, ppmi_film_pixel_count(&job->film), channels * sizeof(float));
}

static void give_memory_back(const ppmi_job *job, denoised_memory *memory)
{
    ppmi_free(job->context, memory->albedo);
    ppmi_free(job->context, memory->normal);
    ppmi_free(job->context, memory->depth);
    ppmi_free(job->context, memory->light);
    ppmi_free(job->context, memory->filtered);
    ppmi_free(job->context, memory->variance);
    ppmi_free(job->context, memory->first);
    ppmi_free(job->context, memory->scratch);
    ppmi_free(job->context, memory->share);
}

static ppm_status take_memory(const ppmi_job *job, denoised_memory *memory)
{
    *memory = (denoised_memory){make_plane(job, 3), make_plane(job, 3), make_plane(job, 1),
                                make_plane(job, 3), make_plane(job, 3), make_plane(job, 3),
                                make_plane(job, 3), make_plane(job, 3), NULL};
    if (memory->albedo && memory->normal && memory->depth && memory->light && memory->filtered &&
        memory->variance && memory->first && memory->scratch) {
        return PPM_STATUS_OK;
    }
    give_memory_back(job, memory);
    return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: denoising %u x %u",
                     job->film.width, job->film.height);
}

/* A catcher's picture is its light less that of the plate, whose noise is much the same and goes
 * with it; to filter one of the two alone would bring the other's noise back. */
static ppm_status leave_catchers_out(const ppmi_denoised_source *source, denoised_memory *memory)
{
    const ppmi_job *job = source->job;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    float *catchers = make_plane(job, 4);
    memory->share = make_plane(job, 1);
    if (!catchers || !memory->share) {
        ppmi_free(job->context, catchers);
        return ppmi_fail(job->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: denoising %u x %u",
                         job->film.width, job->film.height);
    }
    source->integrator->read_layer(job, source->state, PPM_LAYER_CATCHER, 0, source->passes,
                                   catchers);
    for (size_t i = 0; i < pixels; i++)
        memory->share[i] = ppmi_clampf(1.0f - catchers[4 * i + 3], 0.0f, 1.0f);
    ppmi_free(job->context, catchers);
    return PPM_STATUS_OK;
}

static void read_feature(const ppmi_denoised_source *source, int32_t kind, uint32_t channels,
                         float *values)
{
    const ppmi_layer layer = {.kind = kind, .channel_count = channels};
    ppmi_features_read(source->job, source->features, &layer, values);
}

/* Whether the layer's light is what photons bring, which neighbouring pixels share. Lamps that the
 * eye's vertices look at give each pixel noise of its own. */
static bool is_of_photons(const ppmi_job *job, int32_t kind)
{
    const bool is_direct = kind == PPM_LAYER_DIFFUSE_DIRECT || kind == PPM_LAYER_GLOSSY_DIRECT;
    if (job->options->integrator == PPM_INTEGRATOR_PATH) return false;
    return !is_direct || job->options->direct == PPM_DIRECT_PHOTONS;
}

/* The mean radius of gathering in pixels, 0 where nothing gathers. depth: the layer; radius: room
 * for one. A lens, slanted surfaces and what is seen in mirrors are left aside. */
static float radius_in_pixels(const ppmi_denoised_source *source, const float *depth, float *radius)
{
    const ppmi_job *job = source->job;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const float side = 2.0f * vec3_length(job->view.up) / (float)job->options->height;
    double sum = 0.0, count = 0.0;
    source->integrator->read_layer(job, source->state, PPM_LAYER_RADIUS, 0, source->passes, radius);
    for (size_t i = 0; i < pixels; i++) {
        const float here = job->view.is_perspective ? side * depth[i] : side;
        if (!(radius[i] > 0.0f && here > 0.0f)) continue;
        sum += (double)(radius[i] / here);
        count += 1.0;
    }
    return count > 0.0 ? (float)(sum / count) : 0.0f;
}

/* The eye's own samples of lamps, and of the surfaces that it sees, are stratified from pass to
 * pass. Highlights are left out: a few bright pixels would speak for all around them. */
static void read_variance(const ppmi_denoised_source *source, int32_t kind,
                          const denoised_memory *memory)
{
    const ppmi_job *job = source->job;
    source->integrator->read_layer(job, source->state, PPM_LAYER_LIGHT_VARIANCE,
                                   (uint32_t)(kind - PPM_LAYER_DIFFUSE_DIRECT), source->passes,
                                   memory->variance);
    if (kind != PPM_LAYER_DIFFUSE_DIRECT || source->passes < 3) return;
    source->integrator->read_layer(job, source->state, PPMI_LAYER_FIRST_PASSES, 0, source->passes,
                                   memory->first);
    const float first = (float)ppmi_light_first_passes(source->passes);
    const ppmi_stratified_means means = {job->film.width, job->film.height, memory->light,
                                         memory->first, first / (float)source->passes};
    ppmi_denoise_lower_variance(&means, memory->variance, memory->scratch);
}

static ppm_status filter_layer(const ppmi_denoised_source *source, int32_t kind,
                               const ppmi_denoise_guide *guide, float radius_px,
                               const denoised_memory *memory, float *rgba)
{
    const ppmi_job *job = source->job;
    const size_t pixels = ppmi_film_pixel_count(&job->film);
    const ppmi_integrator *integrator = source->integrator;
    integrator->read_layer(job, source->state, kind, 0, source->passes, memory->light);
    integrator->read_layer(job, source->state, kind, 0, source->passes, memory->filtered);
    read_variance(source, kind, memory);
    const bool is_smooth = is_of_photons(job, kind);
    const ppmi_denoise_noise noise = {memory->variance, is_smooth ? radius_px : 0.0f,
                                      is_smooth && kind == PPM_LAYER_CAUSTICS};
    const ppm_status status = ppmi_denoise(job->context, guide, &noise, memory->filtered);
    if (status != PPM_STATUS_OK) return status;
    for (size_t i = 0; i < 3 * pixels; i++) {
        const float share = memory->share ? memory->share[i / 3] : 1.0f;
        rgba[4 * (i / 3) + i % 3] += share * (memory->filtered[i] - memory->light[i]);
    }
    return PPM_STATUS_OK;
}

ppm_status ppmi_denoised_apply(const ppmi_denoised_source *source, float *rgba)
{
    const ppmi_job *job = source->job;
    denoised_memory memory;
    ppm_status status = take_memory(job, &memory);
    if (status != PPM_STATUS_OK) return status;
    if (source->has_plate) status = leave_catchers_out(source, &memory);
    read_feature(source, PPM_LAYER_ALBEDO, 3, memory.albedo);
    read_feature(source, PPM_LAYER_NORMAL, 3, memory.normal);
    read_feature(source, PPM_LAYER_DEPTH, 1, memory.depth);
    const ppmi_denoise_guide guide = {.width = job->film.width,
                                      .height = job->film.height,
                                      .albedo = memory.albedo,
                                      .normal = memory.normal,
                                      .depth = memory.depth,
                                      .threads = job->options->threads};
    const float radius_px = radius_in_pixels(source, memory.depth, memory.light);
    for (int32_t kind = PPM_LAYER_DIFFUSE_DIRECT;
         kind <= PPM_LAYER_VOLUME && status == PPM_STATUS_OK; kind++) {
        if (kind == PPM_LAYER_EMISSION || kind == PPM_LAYER_ENVIRONMENT) continue;
        status = filter_layer(source, kind, &guide, radius_px, &memory, rgba);
    }
    give_memory_back(job, &memory);
    return status;
}
