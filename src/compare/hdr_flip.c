/* HDR-FLIP: Andersson, Nilsson, Shirley and Akenine-Moller, "Visualizing Errors in Rendered High
 * Dynamic Range Images" (Eurographics short papers 2021).
 *
 * No single exposure shows everything in a picture of light. Both pictures are shown at exposures
 * about a stop apart: from one where the reference's brightest pixel is at 0.85 of the display's
 * white to one where its median is. A pixel's error is the largest of all. */
#include "compare/flip.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "compare/flip_planes.h"

/* The filmic curve (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5): Narkowicz's fit to ACES (2016), on 0.6
 * x, which takes back the exposure that his fit includes. */
static const double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03;
static const double k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

float ppmi_compare_tone_map(float light)
{
    const float bright = 1e8f; /* the curve has long passed 1, and squares are still finite */
    const double x = (double)fminf(fmaxf(light, 0), bright);
    const double shown = (k0 * x * x + k1 * x) / (k3 * x * x + k4 * x + k5);
    return (float)fmin(shown, 1);
}

/* The light that the curve shows as 0.85: the positive root of its quadratic equation. */
static double light_shown_bright(void)
{
    const double shown = 0.85;
    const double a = k0 - k3 * shown, b = k1 - k4 * shown, c = -k5 * shown;
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}

static int by_value(const void *first, const void *second)
{
    const float a = *(const float *)first, b = *(const float *)second;
    return (a > b) - (a < b);
}

/* The middle luminance; where half the picture is black, the middle one of those that are not. */
static double median_above_zero(const float *sorted, size_t count)
{
    if (sorted[count / 2] > 0) {
        return 0.5 * ((double)sorted[(count - 1) / 2] + (double)sorted[count / 2]);
    }
    size_t first = count / 2;
    while (first < count && !(sorted[first] > 0))
        first++;
    return (double)sorted[first + (count - first) / 2];
}

ppmi_compare_exposures ppmi_compare_find_exposures(const float *reference, size_t pixel_count,
                                                   float *sorted)
{
    for (size_t i = 0; i < pixel_count; i++) {
        const float *const rgb = reference + 3 * i;
        const float luminance = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
        sorted[i] = fminf(fmaxf(luminance, 0), FLT_MAX);
    }
    qsort(sorted, pixel_count, sizeof *sorted, by_value);
    const double brightest = (double)sorted[pixel_count - 1];
    if (!(brightest > 0)) return (ppmi_compare_exposures){0, 0, 1};
    const double bright = light_shown_bright();
    ppmi_compare_exposures result = {
        .start_ev = log2(bright / brightest),
        .stop_ev = log2(bright / median_above_zero(sorted, pixel_count)),
    };
    const double steps = ceil(result.stop_ev - result.start_ev);
    result.count = steps > 2 ? (uint32_t)steps : 2;
    return result;
}

static void expose(const float *light, size_t value_count, double exposure_ev, float *shown)
{
    const double factor = exp2(exposure_ev);
#pragma omp parallel for schedule(static) if (value_count >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t i = 0; i < (int64_t)value_count; i++)
        shown[i] = ppmi_compare_tone_map((float)((double)light[i] * factor));
}

ppm_status ppmi_compare_flip_hdr(ppmi_compare_flip *flip, const float *test, const float *reference,
                                 const ppmi_compare_exposures *exposures, float *errors)
{
    const size_t value_count = 3 * flip->pixel_count;
    float *const memory = ppmi_alloc(flip->context, flip->pixel_count, 7 * sizeof(float));
    if (!memory) {
        return ppmi_fail(flip->context, PPM_STATUS_OUT_OF_MEMORY,
                         "no memory for FLIP of %u x %u pixels", flip->width, flip->height);
    }
    float *const shown_test = memory, *const shown_reference = memory + value_count;
    float *const latest = memory + 2 * value_count;
    for (uint32_t i = 0; i < exposures->count; i++) {
        const double share = exposures->count > 1 ? (double)i / (exposures->count - 1) : 0;
        const double ev = exposures->start_ev + share * (exposures->stop_ev - exposures->start_ev);
        expose(test, value_count, ev, shown_test);
        expose(reference, value_count, ev, shown_reference);
        ppmi_compare_flip_ldr(flip, shown_test, shown_reference, latest);
        for (size_t pixel = 0; pixel < flip->pixel_count; pixel++)
            errors[pixel] = i == 0 ? latest[pixel] : fmaxf(errors[pixel], latest[pixel]);
    }
    ppmi_free(flip->context, memory);
    return PPM_STATUS_OK;
}
