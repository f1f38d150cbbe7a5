/* Mean squared error, its relative form and PSNR.
 *
 * The relative error is after Rousselle, Knaus and Zwicker, "Adaptive Sampling and Reconstruction
 * using Greedy Error Minimization" (SIGGRAPH Asia 2011); its 0.01 keeps dark pixels from ruling the
 * mean. Rendered pictures have outliers, fireflies, that decide a mean of squares
 * all by themselves; trimming takes a fixed share of the worst pixels out. */
#include "compare/metrics.h"

#include <math.h>
#include <stdlib.h>

double ppmi_compare_squared_error(const ppmi_compare_pair *pair, size_t pixel)
{
    double sum = 0;
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; i++) {
        const double difference = (double)pair->test[i] - (double)pair->reference[i];
        sum += difference * difference;
    }
    return sum / 3;
}

double ppmi_compare_relative_error(const ppmi_compare_pair *pair, size_t pixel)
{
    double sum = 0;
    for (size_t i = 3 * pixel; i < 3 * pixel + 3; i++) {
        const double reference = (double)pair->reference[i];
        const double difference = (double)pair->test[i] - reference;
        sum += difference * difference / (reference * reference + 0.01);
    }
    return sum / 3;
}

typedef struct ranked_pixel {
    double error; /* relative */
    size_t pixel;
} ranked_pixel;

static int by_error(const void *first, const void *second)
{
    const ranked_pixel *const a = first, *const b = second;
    if (a->error != b->error) return a->error < b->error ? -1 : 1;
    return (a->pixel > b->pixel) - (a->pixel < b->pixel);
}

/* Sets is_left_out for the trimmed pixels. */
static ppm_status trim_worst(ppm_context *context, const ppmi_compare_pair *pair, uint64_t trimmed,
                             uint8_t *is_left_out)
{
    ranked_pixel *const ranking = ppmi_alloc(context, pair->measured, sizeof *ranking);
    if (!ranking) return PPM_STATUS_OUT_OF_MEMORY;
    const size_t pixel_count = (size_t)pair->width * pair->height;
    size_t count = 0;
    for (size_t i = 0; i < pixel_count; i++) {
        if (pair->is_broken[i]) continue;
        ranking[count++] = (ranked_pixel){ppmi_compare_relative_error(pair, i), i};
    }
    qsort(ranking, count, sizeof *ranking, by_error);
    for (size_t i = count - trimmed; i < count; i++)
        is_left_out[ranking[i].pixel] = 1;
    ppmi_free(context, ranking);
    return PPM_STATUS_OK;
}

static double largest_value(const ppmi_compare_pair *pair)
{
    const size_t pixel_count = (size_t)pair->width * pair->height;
    float largest = 0;
    for (size_t i = 0; i < 3 * pixel_count; i++) {
        if (!pair->is_broken[i / 3]) largest = fmaxf(largest, pair->reference[i]);
    }
    return (double)largest;
}

static void average(const ppmi_compare_pair *pair, const uint8_t *is_left_out,
                    ppmi_compare_metrics *metrics)
{
    const size_t pixel_count = (size_t)pair->width * pair->height;
    double squares = 0, relative = 0;
    for (size_t i = 0; i < pixel_count; i++) {
        if (pair->is_broken[i] || is_left_out[i]) continue;
        squares += ppmi_compare_squared_error(pair, i);
        relative += ppmi_compare_relative_error(pair, i);
    }
    metrics->mse = squares / (double)metrics->pixels;
    metrics->relative_mse = relative / (double)metrics->pixels;
}

ppm_status ppmi_compare_measure(ppm_context *context, const ppmi_compare_pair *pair, double trim,
                                double peak, ppmi_compare_metrics *out_metrics)
{
    const size_t pixel_count = (size_t)pair->width * pair->height;
    ppmi_compare_metrics metrics = {.peak = peak};
    metrics.trimmed = (uint64_t)(trim * (double)pair->measured);
    metrics.pixels = pair->measured - metrics.trimmed;
    uint8_t *const is_left_out = ppmi_alloc_zeroed(context, pixel_count, 1);
    ppm_status status = is_left_out ? PPM_STATUS_OK : PPM_STATUS_OUT_OF_MEMORY;
    if (status == PPM_STATUS_OK && metrics.trimmed > 0) {
        status = trim_worst(context, pair, metrics.trimmed, is_left_out);
    }
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, is_left_out);
        return ppmi_fail(context, status, "no memory to measure %u x %u pixels", pair->width,
                         pair->height);
    }
    average(pair, is_left_out, &metrics);
    ppmi_free(context, is_left_out);
    if (!(metrics.peak > 0) && pair->is_linear) metrics.peak = largest_value(pair);
    if (!(metrics.peak > 0)) metrics.peak = 1; /* display values; a black reference */
    metrics.psnr_db =
        metrics.mse > 0 ? 10 * log10(metrics.peak * metrics.peak / metrics.mse) : (double)INFINITY;
    *out_metrics = metrics;
    return PPM_STATUS_OK;
}
