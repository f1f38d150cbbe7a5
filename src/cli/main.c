/* ppm-render: one glTF file in, pictures out.
 *
 * Everything that can be wrong with the command line or the output files is found before the scene
 * is read, and everything that only the scene can tell before rendering begins. */
#include <stdio.h>

#include "brightness.h"
#include "clock.h"
#include "console.h"
#include "info.h"
#include "options.h"
#include "outputs.h"
#include "ppm/ppm.h"
#include "progress.h"
#include "setup.h"
#include "signals.h"
#include "stats_json.h"

/* What the steps share. Everything after console may be NULL or empty until its step. */
typedef struct cli_program {
    cli_options options;
    cli_console console;
    double seconds_begin; /* on the clock */
    double seconds_import;
    ppm_context *context;
    ppm_color *color;
    cli_outputs outputs;
    ppm_scene *scene;
    ppm_render *render;
} cli_program;

static int open_library(cli_program *program)
{
    const ppm_context_desc desc = {
        .size = sizeof desc, .log = console_log, .log_user = &program->console};
    ppm_status status = ppm_context_create(&desc, &program->context);
    if (status == PPM_STATUS_OK) {
        status = ppm_color_create(program->context, program->options.ocio, &program->color);
    }
    return exit_status_of(status, EXIT_INPUT);
}

/* Hours of rendering must not end at a folder that does not exist. */
static int check_outputs(cli_program *program, int argc, char **argv)
{
    const cli_options *const options = &program->options;
    int result = outputs_init(&program->outputs, options, program->color, argc, argv);
    if (result == EXIT_DONE) {
        const ppm_status status =
            ppm_color_check_view(program->context, program->color, options->display, options->view);
        result = exit_status_of(status, EXIT_USAGE);
    }
    if (result == EXIT_DONE) result = outputs_check(&program->outputs, program->context);
    if (result == EXIT_DONE && options->stats) {
        result = stats_json_check(&program->console, options->stats);
    }
    return result;
}

static int load_scene(cli_program *program)
{
    const double begin = clock_seconds();
    const ppm_status status = ppm_scene_create(program->context, program->color, &program->scene);
    if (status != PPM_STATUS_OK) return exit_status_of(status, EXIT_RESOURCES);
    const int result = setup_scene(program->scene, &program->options);
    program->seconds_import = clock_seconds() - begin;
    return result;
}

static int create_render(cli_program *program)
{
    ppm_render_options wanted, resolved;
    const int result =
        setup_render_options(&program->console, program->scene, &program->options, &wanted);
    if (result != EXIT_DONE) return result;
    const ppm_status usable = ppm_render_options_resolve(program->scene, &wanted, &resolved);
    if (usable != PPM_STATUS_OK) return exit_status_of(usable, EXIT_USAGE);
    const ppm_status status = ppm_render_create(program->scene, &wanted, &program->render);
    return exit_status_of(status, EXIT_INPUT); /* WRONG_STATE: nothing in it to render */
}

static void say_what_begins(cli_console *console, const ppm_render *render)
{
    const ppm_render_options *const options = ppm_render_get_options(render);
    const uint32_t *const crop = options->crop;
    const uint32_t width = crop[2] - crop[0], height = crop[3] - crop[1];
    char whole[48] = "";
    if (width < options->width || height < options->height) {
        snprintf(whole, sizeof whole, " of %u x %u", options->width, options->height);
    }
    console_message(console, PPM_LOG_INFO, "rendering %u x %u%s pixels, seed %llu", width, height,
                    whole, (unsigned long long)options->seed);
}

/* After a finished pass. */
static void show_and_refresh(cli_program *program, cli_progress *progress, double elapsed)
{
    ppm_render_stats stats = {.size = sizeof stats};
    if (ppm_render_get_stats(program->render, &stats) != PPM_STATUS_OK) return;
    progress_show(progress, &program->console, &stats, elapsed);
    outputs_refresh(&program->outputs, program->render, elapsed);
}

/* Epochs are whole passes. */
static uint64_t pass_limit(const cli_program *program)
{
    if (program->options.epochs == 0) return program->options.passes;
    const ppm_render_options *const options = ppm_render_get_options(program->render);
    const uint64_t per_epoch =
        (options->photons_per_epoch + options->photons_per_pass - 1) / options->photons_per_pass;
    return program->options.epochs * per_epoch;
}

/* Passes until a stop, a signal or a failure. *out_passes counts the finished ones. */
static int run_passes(cli_program *program, uint64_t *out_passes)
{
    cli_progress progress;
    progress_init(&progress, pass_limit(program), program->options.seconds);
    signals_enter_first_pass(program->render);
    say_what_begins(&program->console, program->render);
    const double begin = clock_seconds();
    ppm_status status = PPM_STATUS_OK;
    uint64_t passes = 0;
    while (!(passes > 0 && signals_stop_requested())) {
        status = ppm_render_advance(program->render);
        if (status != PPM_STATUS_OK) break;
        if (++passes == 1) signals_enter_passes();
        const double elapsed = clock_seconds() - begin;
        if (progress_is_done(&progress, passes, elapsed)) break;
        show_and_refresh(program, &progress, elapsed);
    }
    console_clear_line(&program->console);
    *out_passes = passes;
    return status == PPM_STATUS_CANCELLED ? EXIT_DONE : exit_status_of(status, EXIT_RESOURCES);
}

static void say_how_it_ended(cli_program *program, uint64_t passes, bool is_stopped)
{
    cli_console *const console = &program->console;
    const unsigned long long count = passes;
    const char *const plural = passes == 1 ? "" : "es";
    if (is_stopped) {
        console_always(console, "stopped by a signal after %llu pass%s", count, plural);
        return;
    }
    ppm_render_stats stats = {.size = sizeof stats};
    if (ppm_render_get_stats(program->render, &stats) != PPM_STATUS_OK) return;
    console_message(console, PPM_LOG_INFO, "%llu pass%s in %.1f s", count, plural,
                    stats.seconds_render);
}

static int write_stats(cli_program *program)
{
    if (!program->options.stats) return EXIT_DONE;
    const stats_times times = {.total_s = clock_seconds() - program->seconds_begin,
                               .import_s = program->seconds_import};
    return stats_json_write(&program->console, program->options.stats, program->scene,
                            program->render, &times);
}

static int first_failure(int earlier, int later)
{
    return earlier != EXIT_DONE ? earlier : later;
}

/* A failed pass does not cost the passes before it. */
static int render_and_write(cli_program *program)
{
    uint64_t passes = 0;
    int result = run_passes(program, &passes);
    if (passes == 0) return result;
    const bool is_stopped = signals_stop_requested();
    result = first_failure(result, outputs_write(&program->outputs, program->render));
    result = first_failure(result, write_stats(program));
    say_how_it_ended(program, passes, is_stopped);
    brightness_advise(&program->console, program->render, program->options.exposure_ev);
    return result;
}

static int run(cli_program *program, int argc, char **argv)
{
    program->seconds_begin = clock_seconds();
    int result = cli_options_parse(argc, argv, &program->options);
    if (result != EXIT_DONE) return result;
    if (program->options.action == ACTION_HELP) return info_print_help();
    if (program->options.action == ACTION_VERSION) return info_print_version();
    console_init(&program->console, program->options.verbosity);

    result = open_library(program);
    if (result != EXIT_DONE) return result;
    if (program->options.action == ACTION_LIST_VIEWS) return info_print_views(program->color);

    signals_install();
    result = check_outputs(program, argc, argv);
    if (result == EXIT_DONE) result = load_scene(program);
    if (result == EXIT_DONE) result = create_render(program);
    if (result == EXIT_DONE) result = render_and_write(program);
    signals_leave_render();
    return result;
}

static void release(cli_program *program)
{
    ppm_render_destroy(program->render);
    ppm_scene_destroy(program->scene);
    outputs_deinit(&program->outputs);
    ppm_color_destroy(program->color);
    ppm_context_destroy(program->context);
    cli_options_deinit(&program->options);
}

int main(int argc, char **argv)
{
    cli_program program = {0};
    const int result = run(&program, argc, argv);
    release(&program);
    return result;
}
