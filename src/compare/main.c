/* ppm-compare: two pictures in, numbers out, and a heat map if wanted.
 *
 * The command line and the heat map's path are checked before anything is read. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include "base/printable.h"
#include "compare/heat.h"
#include "compare/options.h"
#include "compare/report.h"
#include "imageio/imageio.h"

typedef struct compare_program {
    compare_options options;
    ppm_context *context;
    comparison result;
    float *flip_errors; /* for each pixel of the pair */
} compare_program;

static void say(void *user, ppm_log_level level, const char *message)
{
    (void)user;
    if (level > PPM_LOG_WARNING) return;
    ppmi_print(stderr, "ppm-compare: %s: %s\n", level == PPM_LOG_ERROR ? "error" : "warning",
               message);
}

static size_t pixel_count(const compare_program *program)
{
    return (size_t)program->result.pair.width * program->result.pair.height;
}

/* count floats for each pixel */
static ppm_status take_floats(compare_program *program, size_t count, float **out_floats)
{
    *out_floats = ppmi_alloc(program->context, pixel_count(program), count * sizeof(float));
    if (*out_floats) return PPM_STATUS_OK;
    return ppmi_fail(program->context, PPM_STATUS_OUT_OF_MEMORY, "no memory for %zu pixels",
                     pixel_count(program));
}

/* ---- FLIP ------------------------------------------------------------------------------------ */

/* Both pictures at one exposure, as a display without a tone curve shows them. */
static ppm_status flip_at_exposure(compare_program *program, ppmi_compare_flip *flip)
{
    const ppmi_compare_pair *const pair = &program->result.pair;
    const size_t value_count = 3 * pixel_count(program);
    float *shown = NULL;
    const ppm_status status = take_floats(program, 6, &shown);
    if (status != PPM_STATUS_OK) return status;
    const float factor = exp2f((float)program->result.flip.exposure_ev);
    for (size_t i = 0; i < value_count; i++) {
        shown[i] = factor * pair->test[i];
        shown[value_count + i] = factor * pair->reference[i];
    }
    ppmi_compare_flip_ldr(flip, shown, shown + value_count, program->flip_errors);
    ppmi_free(program->context, shown);
    return PPM_STATUS_OK;
}

static ppm_status flip_through_exposures(compare_program *program, ppmi_compare_flip *flip)
{
    const ppmi_compare_pair *const pair = &program->result.pair;
    flip_summary *const summary = &program->result.flip;
    summary->exposures =
        ppmi_compare_find_exposures(pair->reference, pixel_count(program), program->flip_errors);
    return ppmi_compare_flip_hdr(flip, pair->test, pair->reference, &summary->exposures,
                                 program->flip_errors);
}

static void summarise_flip(compare_program *program)
{
    const ppmi_compare_pair *const pair = &program->result.pair;
    double sum = 0, largest = 0;
    for (size_t i = 0; i < pixel_count(program); i++) {
        if (pair->is_broken[i]) continue;
        sum += (double)program->flip_errors[i];
        largest = fmax(largest, (double)program->flip_errors[i]);
    }
    program->result.flip.mean = sum / (double)pair->measured;
    program->result.flip.largest = largest;
}

static ppm_status measure_flip(compare_program *program)
{
    const ppmi_compare_pair *const pair = &program->result.pair;
    const compare_options *const options = &program->options;
    flip_summary *const summary = &program->result.flip;
    summary->is_hdr = pair->is_linear && !options->exposure_ev.is_given;
    summary->exposure_ev = options->exposure_ev.value;
    summary->pixels_per_degree = options->pixels_per_degree.value;
    ppmi_compare_flip *flip = NULL;
    ppm_status status = take_floats(program, 1, &program->flip_errors);
    if (status == PPM_STATUS_OK) {
        status = ppmi_compare_flip_create(program->context, pair->width, pair->height,
                                          summary->pixels_per_degree, &flip);
    }
    if (status == PPM_STATUS_OK) {
        status = summary->is_hdr ? flip_through_exposures(program, flip)
                                 : flip_at_exposure(program, flip);
    }
    ppmi_compare_flip_destroy(flip);
    if (status == PPM_STATUS_OK) summarise_flip(program);
    return status;
}

/* ---- heat map -------------------------------------------------------------------------------- */

/* values[i] of the error that the map is to show. */
static void find_heat(const compare_program *program, float *values)
{
    const ppmi_compare_pair *const pair = &program->result.pair;
    for (size_t i = 0; i < pixel_count(program); i++) {
        switch (program->options.heat_of) {
        case HEAT_RELATIVE:
            values[i] = (float)fmin(ppmi_compare_relative_error(pair, i), (double)FLT_MAX);
            break;
        case HEAT_SQUARED:
            values[i] = (float)fmin(ppmi_compare_squared_error(pair, i), (double)FLT_MAX);
            break;
        default:
            values[i] = program->flip_errors[i];
        }
    }
}

static double heat_top(const compare_program *program, const float *values, float *sorted)
{
    const compare_options *const options = &program->options;
    if (options->heat_top.is_given) return options->heat_top.value;
    if (options->heat_of == HEAT_FLIP) return 1;
    const double top =
        ppmi_compare_heat_top(values, program->result.pair.is_broken, pixel_count(program), sorted);
    return top > 0 ? top : 1;
}

static ppm_status write_heat(compare_program *program)
{
    const ppmi_compare_pair *const pair = &program->result.pair;
    float *values = NULL;
    ppm_status status = take_floats(program, 2, &values);
    if (status != PPM_STATUS_OK) return status;
    find_heat(program, values);
    const double top = heat_top(program, values, values + pixel_count(program));
    status = ppmi_compare_heat_write(program->context, program->options.heat, values,
                                     pair->is_broken, pair->width, pair->height, top);
    ppmi_free(program->context, values);
    return status;
}

/* ---- the program ----------------------------------------------------------------------------- */

static int compare(compare_program *program)
{
    const compare_options *const options = &program->options;
    comparison *const result = &program->result;
    if (options->heat) {
        const ppm_status status = ppmi_imageio_check_output(program->context, options->heat);
        if (status != PPM_STATUS_OK) return exit_status_of(status, EXIT_USAGE);
    }
    ppm_status status =
        ppmi_compare_pair_read(program->context, options->test, options->reference, &result->pair);
    if (status == PPM_STATUS_OK) {
        status = ppmi_compare_measure(program->context, &result->pair, options->trim.value,
                                      options->peak.value, &result->metrics);
    }
    if (status == PPM_STATUS_OK) status = measure_flip(program);
    if (status != PPM_STATUS_OK) return exit_status_of(status, EXIT_INPUT);
    int done = report_print(result, options);
    if (options->heat) {
        const int written = exit_status_of(write_heat(program), EXIT_OUTPUT);
        if (done == EXIT_DONE) done = written;
    }
    return done == EXIT_DONE ? report_check_limits(result, options) : done;
}

static int run(compare_program *program, int argc, char **argv)
{
    const int result = compare_options_parse(argc, argv, &program->options);
    if (result != EXIT_DONE) return result;
    if (program->options.action == ACTION_HELP) {
        compare_options_print_help(stdout);
        return report_finish();
    }
    if (program->options.action == ACTION_VERSION) {
        printf("ppm-compare %d.%d.%d\n", PPM_VERSION_MAJOR, PPM_VERSION_MINOR, PPM_VERSION_PATCH);
        return report_finish();
    }
    const ppm_context_desc desc = {.size = sizeof desc, .log = say};
    const ppm_status status = ppm_context_create(&desc, &program->context);
    return status == PPM_STATUS_OK ? compare(program) : exit_status_of(status, EXIT_RESOURCES);
}

int main(int argc, char **argv)
{
    compare_program program = {0};
    const int result = run(&program, argc, argv);
    if (program.context) {
        ppmi_compare_pair_free(program.context, &program.result.pair);
        ppmi_free(program.context, program.flip_errors);
    }
    ppm_context_destroy(program.context);
    return result;
}
