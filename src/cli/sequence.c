/* INPUT is opened and imported once. For each picture only what moves is brought to its moment; the
 * scene keeps what stands still, with its acceleration structures. A session lives for a picture.
 */
#include "sequence.h"

#include <stdlib.h>
#include <string.h>

#include "auto_view.h"
#include "clock.h"
#include "render_picture.h"
#include "setup_file.h"
#include "signals.h"

/* How far it is. */
typedef struct run_state {
    size_t left;       /* pictures still to be rendered, by what was on disk at the beginning */
    uint64_t rendered; /* and written */
    uint64_t skipped;  /* since their files were there */
    double seconds;    /* that the rendered ones took */
    bool is_interrupted;
} run_state;

/* Whether there may be more than one picture; one of --frame is a picture alone. */
static bool is_sequence(const cli_sequence *s)
{
    return s->options->frames.is_range || s->options->all_cameras;
}

int sequence_check(const cli_sequence *s)
{
    const cli_picture first = pictures_at(s->pictures, 0);
    int result = outputs_select(s->outputs, &first);
    if (result == EXIT_DONE) result = outputs_check_names(s->outputs, s->console);
    if (result == EXIT_DONE) result = outputs_check(s->outputs, s->context);
    return result;
}

static bool is_there(const cli_sequence *s, const cli_picture *picture)
{
    if (!s->options->skips_existing) return false;
    return outputs_select(s->outputs, picture) == EXIT_DONE && outputs_exist(s->outputs);
}

/* Counts the pictures to render; *out_first is the first of them. */
static size_t count_left(const cli_sequence *s, cli_picture *out_first)
{
    const size_t count = pictures_count(s->pictures);
    size_t left = 0;
    *out_first = pictures_at(s->pictures, 0);
    for (size_t i = 0; i < count; i++) {
        const cli_picture picture = pictures_at(s->pictures, i);
        if (is_there(s, &picture)) continue;
        if (left++ == 0) *out_first = picture;
    }
    return left;
}

/* ---- one picture ----------------------------------------------------------------------------- */

static int record(const cli_sequence *s, const picture_task *task, const ppm_render *render,
                  const run_state *state)
{
    const stats_source source = {.asset = s->input->asset,
                                 .setup = s->input->setup,
                                 .scene = s->input->scene,
                                 .picture = task->picture,
                                 .outputs = s->outputs,
                                 .render = render,
                                 .skipped = state->skipped,
                                 .import_s = s->input->seconds};
    return stats_add(s->stats, s->console, &source);
}

/* The catchers alone, where there are any. False: there is to be no picture. */
static bool render_plate(picture_task *task, float **out_plate, int *result)
{
    *out_plate = NULL;
    if (ppm_scene_catcher_count(task->scene) == 0) return true;
    *result = picture_render_plate(task, out_plate);
    task->plate = *out_plate;
    return *result == EXIT_DONE && *out_plate;
}

/* A picture that could not be written has its statistics all the same. */
static int render_and_record(const cli_sequence *s, picture_task *task, run_state *state)
{
    ppm_render *render = NULL;
    picture_result done = {0};
    int result = EXIT_DONE;
    float *plate;
    if (render_plate(task, &plate, &result)) {
        result = picture_prepare(task, &render);
        if (result == EXIT_DONE) result = picture_render(task, render, &done);
    }
    free(plate);
    if (done.passes > 0 && !done.is_dropped) {
        const int recorded = record(s, task, render, state);
        if (result == EXIT_DONE) result = recorded;
    }
    state->rendered += done.is_written;
    state->is_interrupted = signals_stop_requested();
    if (task->label && state->left > 0) {
        signals_leave_picture();
    } else {
        signals_leave_render();
    }
    ppm_render_destroy(render);
    s->console->is_repeating = true;
    return result;
}

static int render_one(const cli_sequence *s, const cli_picture *picture, run_state *state)
{
    char label[200];
    const double begin = clock_seconds();
    int result = outputs_check(s->outputs, s->context);
    if (result == EXIT_DONE) {
        result = input_set_moment(s->input, s->console, s->color, s->context, s->options, picture);
    }
    if (result != EXIT_DONE) return result;
    outputs_set_origin(s->outputs, s->input->asset);
    if (state->left > 0) state->left--;
    cli_picture shown = *picture; /* by the setup's camera, where nothing says another */
    if (shown.camera == 0) shown.camera = ppm_setup_camera(s->input->setup);
    picture_task task = {
        .console = s->console,
        .options = s->options,
        .picture = &shown,
        .scene = s->input->scene,
        .outputs = s->outputs,
        .is_whole_or_nothing = is_sequence(s) || s->options->skips_existing,
        .is_first = state->rendered == 0,
        .label = is_sequence(s) ? pictures_label(s->pictures, picture, label, sizeof label) : NULL,
        .pictures_after = state->left,
        .seconds_per_picture = state->rendered > 0 ? state->seconds / (double)state->rendered : 0.0,
    };
    result = render_and_record(s, &task, state);
    state->seconds += clock_seconds() - begin;
    return result;
}

static void say_skipped(const cli_sequence *s, const cli_picture *picture)
{
    char label[200];
    pictures_label(s->pictures, picture, label, sizeof label);
    console_message(s->console, PPM_LOG_INFO, "%s: %s is there already: skipped",
                    is_sequence(s) ? label : s->options->input, s->outputs->paths[0]);
}

/* ---- all of them ----------------------------------------------------------------------------- */

static int render_all(const cli_sequence *s, run_state *state)
{
    const size_t count = pictures_count(s->pictures);
    int result = EXIT_DONE;
    for (size_t i = 0; i < count && result == EXIT_DONE && !state->is_interrupted; i++) {
        const cli_picture picture = pictures_at(s->pictures, i);
        result = outputs_select(s->outputs, &picture);
        if (result != EXIT_DONE) break;
        if (s->options->skips_existing && outputs_exist(s->outputs)) {
            say_skipped(s, &picture);
            state->skipped++;
        } else {
            result = render_one(s, &picture, state);
        }
    }
    return result;
}

/* The names of cameras are known once the file is imported. A file without any has one picture, by
 * the camera that frames it. */
static int take_cameras(const cli_sequence *s, run_state *state, cli_picture *first)
{
    const bool has_cameras = ppm_asset_count(s->input->asset, PPM_ASSET_CAMERAS) > 0 ||
                             setup_file_has_cameras(s->input->setup);
    if (!s->options->all_cameras || !has_cameras) return EXIT_DONE;
    int result = input_set_moment(s->input, s->console, s->color, s->context, s->options, first);
    if (result == EXIT_DONE) result = pictures_take_cameras(s->pictures, s->input->scene);
    if (result != EXIT_DONE) return result;
    state->left = count_left(s, first);
    return EXIT_DONE;
}

static int say_how_it_ended(const cli_sequence *s, const run_state *state, int result)
{
    const unsigned long long rendered = state->rendered, skipped = state->skipped;
    const size_t count = pictures_count(s->pictures);
    const bool is_complete = rendered + skipped == count;
    if (state->is_interrupted && !is_complete && result == EXIT_DONE) {
        console_always(s->console, "%llu of %zu pictures are there", rendered + skipped, count);
        return EXIT_SIGNAL;
    }
    if (is_sequence(s) && result == EXIT_DONE) {
        console_message(s->console, PPM_LOG_INFO, "%llu picture%s rendered, %llu skipped", rendered,
                        rendered == 1 ? "" : "s", skipped);
    }
    return result;
}

/* An open shutter blurs what moves; without a frame nothing does. */
static void say_idle_shutter(const cli_sequence *s)
{
    const shutter_times *const shutter = &s->options->shutter;
    if (s->options->frames.is_given || !(shutter->close > shutter->open)) return;
    console_message(s->console, PPM_LOG_INFO,
                    "--shutter blurs what moves: that needs --frame or --frames");
}

static int open_and_render(const cli_sequence *s, cli_picture *first, run_state *state)
{
    int result = input_open(s->input, s->console, s->context, s->options, first);
    if (result != EXIT_DONE) return result;
    if (s->options->has_auto_view) {
        s->outputs->options.view = auto_view_choose(s->console, s->context, s->color, s->options,
                                                    ppm_asset_generator(s->input->asset));
    }
    input_say_animations(s->input, s->console, s->options);
    say_idle_shutter(s);
    result = take_cameras(s, state, first);
    return result == EXIT_DONE ? render_all(s, state) : result;
}

int sequence_run(const cli_sequence *s)
{
    run_state state = {0};
    cli_picture first;
    state.left = count_left(s, &first);
    const bool is_known = !s->options->all_cameras; /* else the names of cameras are in the file */
    const int result =
        state.left == 0 && is_known ? render_all(s, &state) : open_and_render(s, &first, &state);
    return say_how_it_ended(s, &state, result);
}
