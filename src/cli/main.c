/* ppm-render: a glTF or OBJ file in, pictures out.
 *
 * Everything that can be wrong with the command line or the output files is found before the scene
 * is read, and everything that only the scene can tell before rendering begins. */
#include "clock.h"
#include "console.h"
#include "info.h"
#include "input.h"
#include "list.h"
#include "options.h"
#include "outputs.h"
#include "pictures.h"
#include "ppm/ppm.h"
#include "sequence.h"
#include "setup_file.h"
#include "signals.h"
#include "stats_json.h"

/* What the steps share. Everything after console may be NULL or empty until its step. */
typedef struct cli_program {
    cli_options options;
    cli_console console;
    double seconds_begin; /* on the clock */
    ppm_context *context;
    ppm_color *color;
    cli_outputs outputs;
    cli_pictures pictures;
    cli_stats stats;
    cli_input input;
} cli_program;

static int open_library(cli_program *program)
{
    const ppm_context_desc desc = {
        .size = sizeof desc, .log = console_log, .log_user = &program->console};
    return exit_status_of(ppm_context_create(&desc, &program->context), EXIT_INPUT);
}

static int open_color(cli_program *program)
{
    const cli_options *const options = &program->options;
    const ppm_color_options wanted = {.size = sizeof wanted,
                                      .config_path = options->ocio,
                                      .working_space = options->working_space,
                                      .texture_space_count = options->texture_space_count,
                                      .texture_spaces = options->texture_spaces};
    const ppm_status status = ppm_color_create_with(program->context, &wanted, &program->color);
    return exit_status_of(status, EXIT_USAGE); /* NOT_FOUND: a space */
}

/* The setup file and what it says of options; then nothing is missing of them. */
static int complete_options(cli_program *program, int argc, char **argv)
{
    cli_options *const options = &program->options;
    if (options->action != ACTION_RENDER && options->action != ACTION_LIST) return EXIT_DONE;
    const int result =
        setup_file_open(&program->console, program->context, options, &program->input.setup);
    if (result != EXIT_DONE) return result;
    return cli_options_complete(argc, argv, program->input.setup, options);
}

static cli_sequence sequence_of(cli_program *program)
{
    return (cli_sequence){.console = &program->console,
                          .options = &program->options,
                          .context = program->context,
                          .color = program->color,
                          .input = &program->input,
                          .outputs = &program->outputs,
                          .pictures = &program->pictures,
                          .stats = &program->stats};
}

/* Hours of rendering must not end at a folder that does not exist. */
static int check_outputs(cli_program *program, int argc, char **argv)
{
    const cli_options *const options = &program->options;
    pictures_init(&program->pictures, options);
    stats_init(&program->stats, options, program->seconds_begin);
    int result = outputs_init(&program->outputs, options, program->color, argc, argv);
    if (result == EXIT_DONE) {
        const ppm_status status = ppm_color_check_look(
            program->context, program->color, options->display, options->view, options->look);
        result = exit_status_of(status, EXIT_USAGE);
    }
    const cli_sequence sequence = sequence_of(program);
    const cli_picture first = pictures_at(&program->pictures, 0);
    if (result == EXIT_DONE) result = sequence_check(&sequence);
    if (result == EXIT_DONE) result = stats_check(&program->stats, &program->console, &first);
    return result;
}

static int render(cli_program *program, int argc, char **argv)
{
    signals_install();
    int result = check_outputs(program, argc, argv);
    const cli_sequence sequence = sequence_of(program);
    if (result == EXIT_DONE) result = sequence_run(&sequence);
    signals_leave_render();
    return result;
}

static int list(cli_program *program)
{
    const cli_picture still = {0};
    const int result =
        input_open(&program->input, &program->console, program->context, &program->options, &still);
    if (result != EXIT_DONE) return result;
    return list_print(program->input.asset, program->input.setup, program->options.input,
                      program->options.list);
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
    if (result == EXIT_DONE) result = complete_options(program, argc, argv);
    if (result == EXIT_DONE) result = open_color(program);
    if (result != EXIT_DONE) return result;
    if (program->options.action == ACTION_LIST_VIEWS) return info_print_views(program->color);
    if (program->options.action == ACTION_LIST) return list(program);
    return render(program, argc, argv);
}

static void release(cli_program *program)
{
    input_deinit(&program->input);
    stats_deinit(&program->stats);
    pictures_deinit(&program->pictures);
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
