/* A picture alone is refreshed while it runs and written when it is interrupted: something to look
 * at is better than nothing. One in a sequence is not: whoever finds the file, such as
 * --skip-existing the next day, takes it for finished. */
#include "render_picture.h"

#include <math.h>
#include <stdio.h>

#include "brightness.h"
#include "catchers.h"
#include "clock.h"
#include "setup.h"
#include "signals.h"

int picture_prepare(const picture_task *task, ppm_render **out_render)
{
    ppm_render_options wanted, resolved;
    const int result =
        setup_render_options(task->console, task->scene, task->options, task->picture, &wanted);
    if (result != EXIT_DONE) return result;
    const ppm_status usable = ppm_render_options_resolve(task->scene, &wanted, &resolved);
    if (usable != PPM_STATUS_OK) return exit_status_of(usable, EXIT_USAGE);
    if (task->is_plate) {
        wanted.layers = PPM_LAYER_BIT(PPM_LAYER_CATCHER);
        wanted.denoise = 0;
    }
    if (task->focus_distance_m > 0.0f) wanted.focus_distance_m = task->focus_distance_m;
    ppm_status status = ppm_render_create(task->scene, &wanted, out_render);
    if (status == PPM_STATUS_OK && task->plate) {
        status = ppm_render_set_plate(*out_render, task->plate, task->plate_count);
    }
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

/* Of the time that is given, the plate takes so much: its scene is the simpler one, so that the
 * other render can make as many passes in the rest. */
static const double PLATE_SHARE = 0.3;

static double seconds_of(const picture_task *task)
{
    const double seconds = task->options->seconds;
    if (task->is_plate) return seconds * PLATE_SHARE;
    return task->plate ? seconds * (1.0 - PLATE_SHARE) : seconds;
}

/* Epochs are whole passes. */
static uint64_t passes_asked_for(const cli_options *cli, const ppm_render *render)
{
    if (cli->epochs == 0) return cli->passes;
    const ppm_render_options *const options = ppm_render_get_options(render);
    const uint64_t per_epoch =
        (options->photons_per_epoch + options->photons_per_pass - 1) / options->photons_per_pass;
    return cli->epochs * per_epoch;
}

/* Passes of the same numbers have the same noise, which cancels where nothing was changed: more of
 * them than the plate has would be noisier. */
static uint64_t pass_limit(const picture_task *task, const ppm_render *render)
{
    const uint64_t asked_for = passes_asked_for(task->options, render);
    if (!task->plate || task->plate_passes == 0) return asked_for;
    return asked_for > 0 && asked_for < task->plate_passes ? asked_for : task->plate_passes;
}

/* Of a sequence, or of catchers alone. */
static bool is_quiet_start(const picture_task *task)
{
    return task->is_whole_or_nothing || task->is_plate;
}

/* After a finished pass. */
static void show_and_refresh(const picture_task *task, ppm_render *render, cli_progress *progress,
                             double elapsed)
{
    ppm_render_stats stats = {.size = sizeof stats};
    if (ppm_render_get_stats(render, &stats) != PPM_STATUS_OK) return;
    progress_show(progress, task->console, &stats, elapsed);
    if (!is_quiet_start(task)) outputs_refresh(task->outputs, render, elapsed);
}

static void begin_passes(const picture_task *task, ppm_render *render, cli_progress *progress,
                         char *label, size_t label_size)
{
    progress_init(progress, pass_limit(task, render), seconds_of(task));
    if (task->label) {
        snprintf(label, label_size, "%s  ", task->label);
        progress_set_sequence(progress, label, task->pictures_after, task->seconds_per_picture);
    }
    if (is_quiet_start(task)) {
        signals_enter_passes(render);
    } else {
        signals_enter_first_pass(render);
    }
    if (task->is_first) say_what_begins(task->console, render);
}

/* Passes until a stop, a signal or a failure. *out_is_whole: all that are asked for are done. */
static int run_passes(const picture_task *task, ppm_render *render, uint64_t *out_passes,
                      bool *out_is_whole)
{
    char label[256];
    cli_progress progress;
    begin_passes(task, render, &progress, label, sizeof label);
    const double begin = clock_seconds();
    const bool may_be_empty = is_quiet_start(task);
    ppm_status status = PPM_STATUS_OK;
    uint64_t passes = 0;
    while (!((passes > 0 || may_be_empty) && signals_stop_requested())) {
        status = ppm_render_advance(render);
        if (status != PPM_STATUS_OK) break;
        if (++passes == 1) signals_enter_passes(render);
        const double elapsed = clock_seconds() - begin;
        *out_is_whole = progress_is_done(&progress, passes, elapsed);
        if (*out_is_whole) break;
        show_and_refresh(task, render, &progress, elapsed);
    }
    console_clear_line(task->console);
    *out_passes = passes;
    return status == PPM_STATUS_CANCELLED ? EXIT_DONE : exit_status_of(status, EXIT_RESOURCES);
}

static void say_how_it_ended(const picture_task *task, const ppm_render *render,
                             const picture_result *result)
{
    const unsigned long long count = result->passes;
    const char *const plural = result->passes == 1 ? "" : "es";
    if (result->is_stopped) {
        console_always(task->console, "stopped by a signal after %llu pass%s%s%s%s", count, plural,
                       task->label ? " of " : "", task->label ? task->label : "",
                       result->is_dropped ? "; that picture is not written" : "");
        return;
    }
    ppm_render_stats stats = {.size = sizeof stats};
    if (ppm_render_get_stats(render, &stats) != PPM_STATUS_OK) return;
    console_message(task->console, PPM_LOG_INFO, "%s%s%llu pass%s in %.1f s",
                    task->label ? task->label : "", task->label ? ": " : "", count, plural,
                    stats.seconds_render);
}

static int first_failure(int earlier, int later)
{
    return earlier != EXIT_DONE ? earlier : later;
}

/* A pass that fails does not cost the passes before it, unless the picture is to be whole. */
int picture_render(const picture_task *task, ppm_render *render, picture_result *out_result)
{
    picture_result result = {0};
    bool is_whole = false;
    int status = run_passes(task, render, &result.passes, &is_whole);
    result.is_stopped = !is_whole && signals_stop_requested();
    result.is_dropped = task->is_whole_or_nothing && !is_whole;
    if (result.passes > 0 && !result.is_dropped) {
        const int written = outputs_finish(task->outputs, task->console, render);
        result.is_written = written == EXIT_DONE;
        status = first_failure(status, written);
    }
    *out_result = result;
    if (result.passes == 0 && !result.is_stopped) return status;
    say_how_it_ended(task, render, &result);
    /* what lies over a photograph is as bright as that */
    if (task->is_first && result.passes > 0 && !task->plate) {
        brightness_advise(task->console, render, task->options->exposure_ev);
    }
    return status;
}

/* A camera that frames the scene, and a lens that focuses on what is before it, do so with all
 * things there: for the plate, too. */
static int settle_view(picture_task *task)
{
    ppm_render *render = NULL;
    const int result = picture_prepare(task, &render);
    if (result != EXIT_DONE) return result;
    const ppm_render_options *const options = ppm_render_get_options(render);
    if (!isinf(options->aperture_f_number)) task->focus_distance_m = options->focus_distance_m;
    ppm_render_destroy(render);
    task->console->is_repeating = true;
    return EXIT_DONE;
}

int picture_render_plate(picture_task *task, float **out_plate)
{
    *out_plate = NULL;
    int result = settle_view(task);
    if (result != EXIT_DONE) return result;
    picture_task plate_task = *task;
    plate_task.is_plate = true;
    plate_task.label = "catchers alone";
    plate_task.is_first = false; /* what begins is told of the picture */
    ppm_render *render = NULL;
    bool is_whole = false;
    if (ppm_scene_show_catchers_alone(task->scene, 1) != PPM_STATUS_OK) return EXIT_RESOURCES;
    result = picture_prepare(&plate_task, &render);
    if (result == EXIT_DONE)
        result = run_passes(&plate_task, render, &task->plate_passes, &is_whole);
    if (result == EXIT_DONE && is_whole)
        result = catchers_read(render, out_plate, &task->plate_count);
    signals_leave_picture();
    ppm_render_destroy(render);
    ppm_scene_show_catchers_alone(task->scene, 0);
    return result;
}
