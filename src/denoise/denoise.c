/* Gets a picture ready for the filter, and chooses among what comes of it. */
#include "denoise/denoise.h"

#include <math.h>
#include <string.h>

#include "denoise/choice.h"
#include "math/vec.h"

/* An estimate of variance from few passes is noise itself: it is averaged over a neighbourhood. A
 * few pixels with far more of it than the rest, as a glint has, do not speak for the others: with
 * their variance all around them any blur would pass for harmless. So the largest are left out. */
enum { VARIANCE_RADIUS = 2, VARIANCES = 25, LEFT_OUT = 5 };

/* Features differ if they do so by more than this, squared, or than they do to the next pixel
 * (tau and k of Rousselle et al. 2013, section 4). */
static const float feature_tau = 1e-3f, feature_k2 = 0.6f * 0.6f;

typedef struct filter_memory {
    float *planes;
    float *scratch;
    ppmi_nl_output candidates[PPMI_DENOISE_CANDIDATES];
} filter_memory;

/* ---- planes ---------------------------------------------------------------------------------- */

static void split(const float *from, size_t pixels, float *planes)
{
    for (size_t c = 0; c < 3; c++) {
        for (size_t i = 0; i < pixels; i++)
            planes[c * pixels + i] = from[3 * i + c];
    }
}

/* The lesser of the differences to both sides: it is that of the surface, also beside an edge. */
static float slope_at(const float *values, size_t stride, uint32_t at, uint32_t count)
{
    const float before = at > 0 ? values[0] - values[-(ptrdiff_t)stride] : INFINITY;
    const float after = at + 1 < count ? values[stride] - values[0] : INFINITY;
    const float least = fabsf(before) < fabsf(after) ? before : after;
    return isinf(least) ? 0.0f : least;
}

/* Of the three planes of a feature: the sum of squared slopes. */
static float steepness(const float *planes, const ppmi_denoise_guide *guide, uint32_t x, uint32_t y)
{
    const size_t pixels = (size_t)guide->width * guide->height;
    const size_t at = (size_t)y * guide->width + x;
    float sum = 0.0f;
    for (size_t c = 0; c < 3; c++) {
        const float *values = planes + c * pixels + at;
        const float right = slope_at(values, 1, x, guide->width);
        const float down = slope_at(values, guide->width, y, guide->height);
        sum += right * right + down * down;
    }
    return sum;
}

static void fill_guide(const ppmi_denoise_guide *guide, float *planes)
{
    const size_t pixels = (size_t)guide->width * guide->height;
    float *albedo = planes + PPMI_NL_ALBEDO * pixels, *normal = planes + PPMI_NL_NORMAL * pixels;
    float *nearness = planes + PPMI_NL_NEARNESS * pixels;
    float *slopes = planes + PPMI_NL_SLOPE * pixels, *scales = planes + PPMI_NL_SCALE * pixels;
    split(guide->albedo, pixels, albedo);
    split(guide->normal, pixels, normal);
    for (size_t i = 0; i < pixels; i++)
        nearness[i] = 1.0f / ppmi_max(guide->depth[i], 1e-6f);
    for (uint32_t y = 0; y < guide->height; y++) {
        for (uint32_t x = 0; x < guide->width; x++) {
            const size_t i = (size_t)y * guide->width + x;
            slopes[i] = slope_at(nearness + i, 1, x, guide->width);
            slopes[pixels + i] = slope_at(nearness + i, guide->width, y, guide->height);
            scales[i] = 1.0f / (feature_k2 * ppmi_max(feature_tau, steepness(albedo, guide, x, y)));
            scales[pixels + i] =
                1.0f / (feature_k2 * ppmi_max(feature_tau, steepness(normal, guide, x, y)));
        }
    }
}

/* Collects the neighbourhood's values, the largest LEFT_OUT of them in order at the end. */
static size_t collect(const float *values, uint32_t width, uint32_t height, uint32_t x, uint32_t y,
                      float collected[VARIANCES])
{
    size_t count = 0;
    for (int64_t ny = (int64_t)y - VARIANCE_RADIUS; ny <= (int64_t)y + VARIANCE_RADIUS; ny++) {
        for (int64_t nx = (int64_t)x - VARIANCE_RADIUS; nx <= (int64_t)x + VARIANCE_RADIUS; nx++) {
            if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
            collected[count++] = values[(size_t)ny * width + (size_t)nx];
        }
    }
    for (size_t last = count; last > 1 && count - last < LEFT_OUT; last--) {
        for (size_t i = 0; i + 1 < last; i++) {
            const float low = ppmi_min(collected[i], collected[i + 1]);
            collected[i + 1] = ppmi_max(collected[i], collected[i + 1]);
            collected[i] = low;
        }
    }
    return count;
}

/* The mean of the neighbourhood without its largest fifth, and no less than the pixel's own. */
static void smooth_variance(uint32_t width, uint32_t height, float *variance, float *scratch)
{
    memcpy(scratch, variance, (size_t)width * height * sizeof *scratch);
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            float values[VARIANCES];
            const size_t i = (size_t)y * width + x;
            const size_t count = collect(scratch, width, height, x, y, values);
            const size_t kept = count - count * LEFT_OUT / VARIANCES;
            float sum = 0.0f;
            for (size_t k = 0; k < kept; k++)
                sum += values[k];
            variance[i] = ppmi_max(sum / (float)kept, scratch[i]);
        }
    }
}

static void fill_light(const ppmi_denoise_guide *guide, const float *light, const float *variance,
                       const filter_memory *memory)
{
    const size_t pixels = (size_t)guide->width * guide->height;
    float *variances = memory->planes + PPMI_NL_VARIANCE * pixels;
    split(light, pixels, memory->planes + PPMI_NL_LIGHT * pixels);
    split(variance, pixels, variances);
    for (size_t c = 0; c < 3; c++)
        smooth_variance(guide->width, guide->height, variances + c * pixels, memory->scratch);
}

/* ---- the filter ------------------------------------------------------------------------------ */

static bool is_noisy(const float *variance, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (variance[i] > 0.0f) return true;
    }
    return false;
}

static void give_memory_back(ppm_context *context, filter_memory *memory)
{
    ppmi_free(context, memory->planes);
    ppmi_free(context, memory->scratch);
    for (int i = 0; i < PPMI_DENOISE_CANDIDATES; i++) {
        ppmi_free(context, memory->candidates[i].light);
        ppmi_free(context, memory->candidates[i].risk);
    }
}

static bool take_memory(ppm_context *context, size_t pixels, filter_memory *memory)
{
    *memory = (filter_memory){.planes = ppmi_alloc(context, pixels, PPMI_NL_PLANES * sizeof(float)),
                              .scratch = ppmi_alloc(context, pixels, sizeof(float))};
    bool has_all = memory->planes && memory->scratch;
    for (int i = 0; i < PPMI_DENOISE_CANDIDATES && has_all; i++) {
        ppmi_nl_output *output = &memory->candidates[i];
        output->light = ppmi_alloc(context, pixels, 3 * sizeof(float));
        output->risk = ppmi_alloc(context, pixels, sizeof(float));
        has_all = output->light && output->risk;
    }
    return has_all;
}

ppm_status ppmi_denoise(ppm_context *context, const ppmi_denoise_guide *guide,
                        const ppmi_denoise_noise *noise, float *light)
{
    const size_t pixels = (size_t)guide->width * guide->height;
    if (!is_noisy(noise->variance, 3 * pixels)) return PPM_STATUS_OK;
    filter_memory memory;
    if (!take_memory(context, pixels, &memory)) {
        give_memory_back(context, &memory);
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: denoising %u x %u",
                         guide->width, guide->height);
    }
    fill_guide(guide, memory.planes);
    fill_light(guide, light, noise->variance, &memory);
    const ppmi_nl_input input = {guide->width, guide->height, guide->threads, noise->correlation_px,
                                 memory.planes};
    const ppm_status status = ppmi_nl_means(context, &input, memory.candidates);
    if (status == PPM_STATUS_OK) {
        ppmi_denoise_choose(guide->width, guide->height, memory.candidates, noise->is_blurred,
                            memory.scratch, light);
    }
    give_memory_back(context, &memory);
    return status;
}
