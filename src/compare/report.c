/* Text in columns, or JSON by jansson. Infinity, which JSON has not, is null there. */
#include "compare/report.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include <jansson.h>

#include "base/printable.h"
#include "ppm/context.h"

int report_finish(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) return EXIT_DONE;
    perror("ppm-compare: error: standard output");
    return EXIT_OUTPUT;
}

static uint64_t broken_pixels(const ppmi_compare_pair *pair)
{
    return (uint64_t)pair->width * pair->height - pair->measured;
}

/* ---- text ------------------------------------------------------------------------------------ */

static void print_pixels(const comparison *result)
{
    const ppmi_compare_pair *const pair = &result->pair;
    printf("pixels        %" PRIu64 " of %u x %u", result->metrics.pixels, pair->width,
           pair->height);
    if (pair->width != pair->picture_width || pair->height != pair->picture_height) {
        printf(" at %u,%u in %u x %u", pair->x, pair->y, pair->picture_width, pair->picture_height);
    }
    if (result->metrics.trimmed > 0) printf(", %" PRIu64 " trimmed", result->metrics.trimmed);
    putchar('\n');
    if (broken_pixels(pair) > 0) {
        printf("broken        %" PRIu64 " pixels left out: %" PRIu64 " of TEST, %" PRIu64
               " of REFERENCE are no numbers\n",
               broken_pixels(pair), pair->test_broken, pair->reference_broken);
    }
}

static void print_flip(const flip_summary *flip)
{
    printf("FLIP          %.6g  (%s, %g pixels per degree", flip->mean,
           flip->is_hdr ? "HDR" : "LDR", flip->pixels_per_degree);
    if (flip->is_hdr) {
        printf(", %u exposures from %+.2f to %+.2f EV", flip->exposures.count,
               flip->exposures.start_ev, flip->exposures.stop_ev);
    } else if (flip->exposure_ev != 0) {
        printf(", %+g EV", flip->exposure_ev);
    }
    printf("; largest %.6g)\n", flip->largest);
}

static int print_text(const comparison *result)
{
    const ppmi_compare_metrics *const metrics = &result->metrics;
    print_pixels(result);
    printf("MSE           %.6g\n", metrics->mse);
    printf("relative MSE  %.6g\n", metrics->relative_mse);
    printf("PSNR          %.4f dB  (peak %g)\n", metrics->psnr_db, metrics->peak);
    print_flip(&result->flip);
    return report_finish();
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static json_t *count_json(uint64_t count)
{
    return json_integer((json_int_t)count);
}

static json_t *real_json(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *area_json(const comparison *result)
{
    const ppmi_compare_pair *const pair = &result->pair;
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}",                           //
                     "x", count_json(pair->x), "y", count_json(pair->y),                   //
                     "width", count_json(pair->width), "height", count_json(pair->height), //
                     "pixels", count_json(result->metrics.pixels),                         //
                     "trimmed", count_json(result->metrics.trimmed),                       //
                     "broken_test", count_json(pair->test_broken),                         //
                     "broken_reference", count_json(pair->reference_broken));
}

static json_t *flip_json(const flip_summary *flip)
{
    json_t *const exposures = json_array();
    if (flip->is_hdr) {
        const ppmi_compare_exposures *const range = &flip->exposures;
        json_array_append_new(exposures, json_real(range->start_ev));
        json_array_append_new(exposures, json_real(range->stop_ev));
    } else {
        json_array_append_new(exposures, json_real(flip->exposure_ev));
        json_array_append_new(exposures, json_real(flip->exposure_ev));
    }
    return json_pack("{s:s, s:f, s:f, s:f, s:o, s:o}",                                       //
                     "kind", flip->is_hdr ? "HDR" : "LDR", "mean", flip->mean,               //
                     "largest", flip->largest, "pixels_per_degree", flip->pixels_per_degree, //
                     "exposures_ev", exposures,                                              //
                     "exposure_count", count_json(flip->is_hdr ? flip->exposures.count : 1));
}

static int print_json(const comparison *result, const compare_options *options)
{
    const ppmi_compare_metrics *const metrics = &result->metrics;
    /* a path need not be UTF-8, JSON must: s* would refuse it, so such names become null */
    json_t *const test = json_string(options->test);
    json_t *const reference = json_string(options->reference);
    json_t *const root = json_pack(
        "{s:o, s:o, s:o, s:f, s:f, s:o, s:f, s:o}",                                            //
        "test", test ? test : json_null(), "reference", reference ? reference : json_null(),   //
        "area", area_json(result), "mse", metrics->mse, "relative_mse", metrics->relative_mse, //
        "psnr_db", real_json(metrics->psnr_db), "peak", metrics->peak,                         //
        "flip", flip_json(&result->flip));
    if (!root) {
        fputs("ppm-compare: error: out of memory\n", stderr);
        return EXIT_RESOURCES;
    }
    json_dumpf(root, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    json_decref(root);
    putchar('\n');
    return report_finish();
}

int report_print(const comparison *result, const compare_options *options)
{
    return options->json ? print_json(result, options) : print_text(result);
}

/* ---- limits ---------------------------------------------------------------------------------- */

int report_check_limits(const comparison *result, const compare_options *options)
{
    const double values[LIMIT_COUNT] = {
        [LIMIT_MSE] = result->metrics.mse,
        [LIMIT_RELATIVE_MSE] = result->metrics.relative_mse,
        [LIMIT_FLIP] = result->flip.mean,
        [LIMIT_BROKEN] = (double)broken_pixels(&result->pair),
    };
    int status = EXIT_DONE;
    for (size_t i = 0; i < LIMIT_COUNT; i++) {
        const real_option limit = options->limits[i];
        if (!limit.is_given || values[i] <= limit.value) continue;
        ppmi_print(stderr, "ppm-compare: %s is %.6g, above %g\n", limit_names[i], values[i],
                   limit.value);
        status = EXIT_ABOVE;
    }
    return status;
}
