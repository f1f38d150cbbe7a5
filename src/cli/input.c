/* Names are looked up as soon as the file is open, so that a wrong one is answered with those that
 * there are, before anything is imported. */
#include "input.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "catchers.h"
#include "choose.h"
#include "clock.h"
#include "setup.h"
#include "setup_file.h"

void input_deinit(cli_input *input)
{
    ppm_asset_close(input->asset);
    ppm_scene_destroy(input->scene);
    ppm_setup_close(input->setup);
    *input = (cli_input){0};
}

/* ---- names ----------------------------------------------------------------------------------- */

typedef struct item_source {
    const ppm_asset *asset;
    int32_t kind; /* PPM_ASSET_ */
} item_source;

static const char *item_name(const void *user, uint32_t index)
{
    const item_source *const source = user;
    ppm_asset_item item = {.size = sizeof item};
    const ppm_status status = ppm_asset_get_item(source->asset, source->kind, index, &item);
    return status == PPM_STATUS_OK ? item.name : "";
}

static int choose_item(cli_console *console, const ppm_asset *asset, int32_t kind,
                       const char *option, const char *text, uint32_t *out_index)
{
    static const char *const things[PPM_ASSET_KINDS] = {[PPM_ASSET_SCENES] = "scene",
                                                        [PPM_ASSET_VARIANTS] = "variant",
                                                        [PPM_ASSET_ANIMATIONS] = "animation"};
    const item_source source = {asset, kind};
    const choice_list list = {.option = option,
                              .thing = things[kind],
                              .has_numbers = kind == PPM_ASSET_SCENES,
                              .count = ppm_asset_count(asset, kind),
                              .name_of = item_name,
                              .user = &source};
    return choose(console, &list, text, out_index);
}

/* Whether the names are in the file. */
static int check_names(cli_console *console, const ppm_asset *asset, const cli_options *options)
{
    const struct {
        const char *option, *text;
        int32_t kind;
    } names[] = {{"--scene", options->scene, PPM_ASSET_SCENES},
                 {"--variant", options->variant, PPM_ASSET_VARIANTS},
                 {"--animation", options->animation, PPM_ASSET_ANIMATIONS}};
    int result = EXIT_DONE;
    for (size_t i = 0; i < sizeof names / sizeof names[0] && result == EXIT_DONE; i++) {
        uint32_t index = 0;
        if (!names[i].text) continue;
        result = choose_item(console, asset, names[i].kind, names[i].option, names[i].text, &index);
    }
    return result;
}

/* The library knows a scene by its name or by its number from 0; a scene may be called "0". */
static void write_scene(const ppm_asset *asset, uint32_t index, char *buffer, size_t size)
{
    const item_source source = {asset, PPM_ASSET_SCENES};
    const char *const name = item_name(&source, index);
    uint32_t first = 0;
    while (strcmp(item_name(&source, first), name) != 0)
        first++;
    if (*name && first == index && strlen(name) < size) {
        strcpy(buffer, name);
    } else {
        snprintf(buffer, size, "%u", index);
    }
}

/* ---- opening --------------------------------------------------------------------------------- */

/* The shutter is open around the frame; without --shutter it is a moment. */
static ppm_pose pose_of(const cli_options *options, const cli_picture *picture)
{
    if (!picture->has_frame) return (ppm_pose){0};
    return (ppm_pose){.is_animated = 1,
                      .open_s = (picture->frame + options->shutter.open) / options->fps,
                      .close_s = (picture->frame + options->shutter.close) / options->fps,
                      .motion_steps = (uint32_t)options->motion_steps};
}

static ppm_import_options plain_options(const cli_options *options)
{
    return (ppm_import_options){.size = sizeof(ppm_import_options),
                                .light_units = options->light_units,
                                .transmission = options->transmission,
                                .line_radius_m = (float)options->line_radius_m,
                                .crease_rad =
                                    (float)(options->crease_deg * (3.14159265358979323846 / 180.0)),
                                .unit_scale = (float)options->unit_scale,
                                .up = options->up,
                                .texture_folders = options->texture_folders,
                                .texture_folder_count = (uint32_t)options->texture_folder_count,
                                .allow_outside = options->allows_outside != 0,
                                .no_clip = options->has_no_clip != 0,
                                .strict = options->is_strict != 0};
}

/* Looks up the names that are asked for, and finds what the library calls the scene: the file is
 * opened for them alone, so that a wrong one is told as the option that it came by. Warnings are
 * for the opening that counts. */
static int look_up_names(cli_console *console, ppm_context *context, const cli_options *options,
                         char *scene, size_t size)
{
    ppm_asset *asset = NULL;
    uint32_t index = 0;
    const ppm_import_options plain = plain_options(options);
    const int32_t verbosity = console->verbosity;
    console->verbosity = VERBOSITY_QUIET;
    const ppm_status status = ppm_asset_open(context, options->input, &plain, &asset);
    console->verbosity = verbosity;
    if (status != PPM_STATUS_OK) return exit_status_of(status, EXIT_INPUT);
    int result = check_names(console, asset, options);
    if (result == EXIT_DONE && options->scene) {
        result = choose_item(console, asset, PPM_ASSET_SCENES, "--scene", options->scene, &index);
        if (result == EXIT_DONE) write_scene(asset, index, scene, size);
    }
    ppm_asset_close(asset);
    return result;
}

int input_open(cli_input *input, cli_console *console, ppm_context *context,
               const cli_options *options, const cli_picture *picture)
{
    char scene[512];
    const double begin = clock_seconds();
    ppm_import_options wanted = plain_options(options);
    wanted.pose = input->pose = pose_of(options, picture);
    wanted.variant = options->variant;
    wanted.animation = options->animation;
    if (options->scene || options->variant || options->animation) {
        const int result = look_up_names(console, context, options, scene, sizeof scene);
        if (result != EXIT_DONE) return result;
        wanted.scene = options->scene ? scene : NULL;
    }
    const ppm_status status = ppm_asset_open(context, options->input, &wanted, &input->asset);
    input->seconds = clock_seconds() - begin;
    return exit_status_of(status, EXIT_INPUT);
}

/* ---- moments --------------------------------------------------------------------------------- */

static bool is_same_pose(const ppm_pose *a, const ppm_pose *b)
{
    return a->is_animated == b->is_animated && a->open_s == b->open_s && a->close_s == b->close_s;
}

static ppm_status import(cli_input *input, const ppm_color *color, ppm_context *context)
{
    ppm_status status = ppm_scene_create(context, color, &input->scene);
    if (status == PPM_STATUS_OK) status = ppm_asset_import(input->asset, input->scene);
    return status;
}

static int set_pose(cli_input *input, const ppm_pose *pose)
{
    if (is_same_pose(pose, &input->pose)) return EXIT_DONE;
    input->pose = *pose;
    return exit_status_of(ppm_asset_set_pose(input->asset, pose), EXIT_INPUT);
}

/* A camera that frames the scene does so in the static pose: it must neither follow what moves nor
 * depend on the frame that a run begins with. A scene of nothing is left to the render to refuse.
 */
static int frame_static_pose(cli_input *input, cli_console *console, const cli_options *options)
{
    ppm_scene_info info = {.size = sizeof info};
    const ppm_pose still = {0};
    if (ppm_scene_get_info(input->scene, &info) != PPM_STATUS_OK) return EXIT_INPUT;
    if (info.cameras > 0 || info.instances == 0) return EXIT_DONE;
    const int result = set_pose(input, &still);
    return result == EXIT_DONE ? setup_missing_camera(console, input->scene, options) : result;
}

/* In the static pose, as cameras may focus on what moves. */
static int apply_setup(cli_input *input, const cli_options *options, bool has_frame)
{
    const ppm_pose still = {0};
    if (!input->setup) return EXIT_DONE;
    const int result = has_frame ? set_pose(input, &still) : EXIT_DONE;
    if (result != EXIT_DONE) return result;
    return exit_status_of(ppm_setup_apply(input->setup, input->scene, setup_file_parts(options)),
                          EXIT_INPUT);
}

int input_set_moment(cli_input *input, cli_console *console, const ppm_color *color,
                     ppm_context *context, const cli_options *options, const cli_picture *picture)
{
    const double begin = clock_seconds();
    const bool is_first = !input->scene;
    const ppm_pose pose = pose_of(options, picture);
    int result = EXIT_DONE;
    if (is_first) {
        result = exit_status_of(import(input, color, context), EXIT_INPUT);
        if (result == EXIT_DONE) result = apply_setup(input, options, picture->has_frame);
        if (result == EXIT_DONE) result = catchers_choose(console, input->scene, options);
        if (result == EXIT_DONE) {
            result = exit_status_of(setup_surroundings(input->scene, options), EXIT_INPUT);
        }
    }
    if (is_first && result == EXIT_DONE && picture->has_frame) {
        result = frame_static_pose(input, console, options);
    }
    if (result == EXIT_DONE) result = set_pose(input, &pose);
    if (result == EXIT_DONE && input->setup && picture->has_frame) {
        result = exit_status_of(ppm_setup_reapply(input->setup, input->scene), EXIT_INPUT);
    }
    input->seconds += clock_seconds() - begin;
    return result;
}

/* ---- what is said of animations -------------------------------------------------------------- */

/* The first and the last key of all animations, in seconds; false when there are none. */
static bool animated_time(const ppm_asset *asset, double *out_begin, double *out_end)
{
    const uint32_t count = ppm_asset_count(asset, PPM_ASSET_ANIMATIONS);
    bool is_found = false;
    for (uint32_t i = 0; i < count; i++) {
        ppm_asset_item item = {.size = sizeof item};
        if (ppm_asset_get_item(asset, PPM_ASSET_ANIMATIONS, i, &item) != PPM_STATUS_OK) continue;
        *out_begin = is_found ? fmin(*out_begin, item.begin_s) : item.begin_s;
        *out_end = is_found ? fmax(*out_end, item.end_s) : item.end_s;
        is_found = true;
    }
    return is_found;
}

void input_say_animations(const cli_input *input, cli_console *console, const cli_options *options)
{
    const uint32_t count = ppm_asset_count(input->asset, PPM_ASSET_ANIMATIONS);
    const char *const plural = count == 1 ? "" : "s";
    double begin = 0.0, end = 0.0;
    if (!animated_time(input->asset, &begin, &end)) {
        if (options->frames.is_given) {
            console_message(console, PPM_LOG_WARNING,
                            "%s has no animation: all frames show the same", options->input);
        }
        return;
    }
    if (!options->frames.is_given) {
        const double slack = 1e-3; /* of a frame: keys are rounded to single precision */
        const double first = ceil(begin * options->fps - slack) + 0.0; /* no -0 */
        const double last = floor(end * options->fps + slack);
        console_message(console, PPM_LOG_INFO,
                        "%u animation%s not played: this is the file's static pose; --frame N or "
                        "--frames %.0f-%.0f (%g to %g s) plays %s",
                        count, plural, first, fmax(first, last), begin, end,
                        count == 1 ? "it" : "them");
    } else if (count > 1 && !options->animation) {
        console_message(console, PPM_LOG_INFO,
                        "%u animations are played together; --animation NAME plays one", count);
    }
}
