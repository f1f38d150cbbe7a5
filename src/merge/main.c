/* ppm-merge: pictures with different noise in, one with less out.
 *
 * The command line and the output are checked before anything is read, and whether the files belong
 * together before any pixel is. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/printable.h"
#include "cli/exit_status.h"
#include "imageio/imageio.h"
#include "merge/check.h"
#include "merge/options.h"
#include "merge/output.h"

typedef struct merge_program {
    merge_options options;
    char *command;
    ppm_context *context;
    merge_source *sources;
    merge_plan plan;
    merge_mixer mixer;
    merge_totals totals;
} merge_program;

static void say(void *user, ppm_log_level level, const char *message)
{
    const merge_program *const program = user;
    const ppm_log_level least = program->options.is_quiet ? PPM_LOG_ERROR : PPM_LOG_WARNING;
    if (level > least) return;
    ppmi_print(stderr, "ppm-merge: %s: %s\n", level == PPM_LOG_ERROR ? "error" : "warning",
               message);
}

/* The words as they came, before options are moved to the front. */
static char *join_command(int argc, char **argv)
{
    size_t room = sizeof "ppm-merge";
    for (int i = 1; i < argc; i++)
        room += strlen(argv[i]) + 1;
    char *const command = malloc(room);
    if (!command) return NULL;
    char *end = stpcpy(command, "ppm-merge");
    for (int i = 1; i < argc; i++)
        end = stpcpy(stpcpy(end, " "), argv[i]);
    return command;
}

/* A file that is read must not be the one that is written, by whatever name. */
static ppm_status check_output(merge_program *program)
{
    const merge_options *const options = &program->options;
    struct stat output, input;
    const bool is_there = stat(options->output, &output) == 0;
    for (size_t i = 0; i < options->input_count && is_there; i++) {
        const char *const path = options->inputs[i];
        if (stat(path, &input) != 0) continue;
        if (input.st_dev != output.st_dev || input.st_ino != output.st_ino) continue;
        return ppmi_fail(program->context, PPM_STATUS_INVALID_ARGUMENT,
                         "%s is the input %s, too: give the merged file a name of its own",
                         options->output, path);
    }
    return ppmi_imageio_check_output(program->context, options->output);
}

static ppm_status open_sources(merge_program *program)
{
    const size_t count = program->options.input_count;
    program->sources = ppmi_alloc_zeroed(program->context, count, sizeof *program->sources);
    if (!program->sources) {
        return ppmi_fail(program->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu files",
                         count);
    }
    for (size_t i = 0; i < count; i++) {
        const ppm_status status =
            merge_source_open(program->context, program->options.inputs[i], &program->sources[i]);
        if (status != PPM_STATUS_OK) return status;
    }
    merge_sources_prepare(program->sources, count);
    return merge_check(program->context, program->sources, count);
}

static ppm_status write_all(merge_program *program)
{
    const size_t count = program->options.input_count;
    ppm_context *const context = program->context;
    ppm_status status = merge_totals_init(context, program->sources, count, &program->totals);
    if (status == PPM_STATUS_OK) {
        status = merge_plan_init(context, program->sources, count, &program->plan);
    }
    if (status == PPM_STATUS_OK) {
        status = merge_mixer_init(context, program->sources, &program->plan, &program->mixer);
    }
    if (status == PPM_STATUS_OK) {
        status =
            merge_write(&program->mixer, &program->options, program->command, &program->totals);
    }
    return status;
}

static void say_what_is_there(const merge_program *program)
{
    const merge_totals *const totals = &program->totals;
    if (program->options.is_quiet) return;
    ppmi_print(stderr, "%s: %zu files, %llu passes, %llu photons, %.1f s\n",
               program->options.output, program->options.input_count,
               (unsigned long long)totals->passes, (unsigned long long)totals->photons,
               totals->seconds);
}

static int merge(merge_program *program)
{
    const ppm_status writable = check_output(program);
    if (writable != PPM_STATUS_OK) return exit_status_of(writable, EXIT_USAGE);
    ppm_status status = open_sources(program);
    if (status == PPM_STATUS_OK) status = write_all(program);
    if (status != PPM_STATUS_OK) return exit_status_of(status, EXIT_INPUT);
    say_what_is_there(program);
    return EXIT_DONE;
}

static int print(const char *text)
{
    return fputs(text, stdout) < 0 || fflush(stdout) != 0 ? EXIT_OUTPUT : EXIT_DONE;
}

static int run(merge_program *program, int argc, char **argv)
{
    program->command = join_command(argc, argv);
    const int result = merge_options_parse(argc, argv, &program->options);
    if (result != EXIT_DONE) return result;
    if (program->options.action == MERGE_ACTION_HELP) {
        merge_options_print_help(stdout);
        return print("");
    }
    if (program->options.action == MERGE_ACTION_VERSION) {
        char text[64];
        snprintf(text, sizeof text, "ppm-merge %d.%d.%d\n", PPM_VERSION_MAJOR, PPM_VERSION_MINOR,
                 PPM_VERSION_PATCH);
        return print(text);
    }
    signal(SIGXFSZ, SIG_IGN); /* a file that grows too large is an error to be told */
    const ppm_context_desc desc = {.size = sizeof desc, .log = say, .log_user = program};
    const ppm_status status = ppm_context_create(&desc, &program->context);
    return status == PPM_STATUS_OK ? merge(program) : exit_status_of(status, EXIT_RESOURCES);
}

static void release(merge_program *program)
{
    ppm_context *const context = program->context;
    if (context) {
        merge_mixer_deinit(&program->mixer);
        merge_plan_deinit(context, &program->plan);
        ppmi_free(context, program->totals.seeds);
        for (size_t i = 0; program->sources && i < program->options.input_count; i++)
            merge_source_close(context, &program->sources[i]);
        ppmi_free(context, program->sources);
    }
    ppm_context_destroy(context);
    free(program->command);
}

int main(int argc, char **argv)
{
    merge_program program = {0};
    const int result = run(&program, argc, argv);
    release(&program);
    return result;
}
