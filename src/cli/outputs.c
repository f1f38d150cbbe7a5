/* Paths, the schedule of refreshes, and the command line as one string. */
#include "outputs.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"
#include "rescue.h"

static const double REFRESH_FIRST_S = 2.0;
static const double REFRESH_MIN_S = 5.0;
static const double REFRESH_SHARE_OF_ELAPSED = 0.1;
static const double REFRESH_COST_FACTOR = 20.0;

/* The last part of a path without its ending: "scenes/hall.v2.glb" gives "hall.v2". */
static char *stem_with_ending(const char *path, const char *ending)
{
    const char *const slash = strrchr(path, '/');
    const char *const name = slash ? slash + 1 : path;
    const char *const dot = strrchr(name, '.');
    const size_t length = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    char *const result = malloc(length + strlen(ending) + 1);
    if (!result) return NULL;
    memcpy(result, name, length);
    strcpy(result + length, ending);
    return result;
}

/* INPUT's name with an ending. What looks like a place in it is none. */
static char *default_pattern(const cli_outputs *outputs, const char *input, const char *ending)
{
    char *const name = stem_with_ending(input, ending);
    char *const pattern = name ? pattern_escape(name, &outputs->use) : NULL;
    free(name);
    return pattern;
}

static bool add_patterns(cli_outputs *outputs, const cli_options *options)
{
    static const char *const default_endings[] = {".exr", ".png"};
    const size_t count = options->output_count ? options->output_count : 2;
    outputs->patterns = calloc(count, sizeof *outputs->patterns);
    outputs->paths = calloc(count, sizeof *outputs->paths);
    if (!outputs->patterns || !outputs->paths) return false;
    for (; outputs->count < count; outputs->count++) {
        const size_t i = outputs->count;
        char *const path = options->output_count
                               ? strdup(options->outputs[i])
                               : default_pattern(outputs, options->input, default_endings[i]);
        if (!path) return false;
        outputs->patterns[outputs->count] = path;
    }
    return true;
}

static bool is_plain(const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "-_=+.,:/@%";
    return *word != '\0' && word[strspn(word, plain)] == '\0';
}

/* Appends word as a shell would take it: in quotes unless it is plain. */
static char *append_quoted(char *end, const char *word)
{
    if (is_plain(word)) return stpcpy(end, word);
    *end++ = '\'';
    for (; *word; word++) {
        if (*word == '\'') {
            end = stpcpy(end, "'\\''");
        } else {
            *end++ = *word;
        }
    }
    *end++ = '\'';
    *end = '\0';
    return end;
}

static char *join_command(int argc, char **argv)
{
    size_t room = 1;
    for (int i = 0; i < argc; i++)
        room += 4 * strlen(argv[i]) + 3;
    char *const command = malloc(room);
    if (!command) return NULL;
    char *end = stpcpy(command, "ppm-render");
    for (int i = 1; i < argc; i++) {
        *end++ = ' ';
        end = append_quoted(end, argv[i]);
    }
    return command;
}

int outputs_init(cli_outputs *outputs, const cli_options *options, const ppm_color *color, int argc,
                 char **argv)
{
    memset(outputs, 0, sizeof *outputs);
    outputs->command = join_command(argc, argv);
    outputs->color = color;
    outputs->width = options->size.width;
    outputs->height = options->size.height;
    outputs->is_cropped = options->crop.is_given;
    outputs->options = (ppm_output_options){
        .size = sizeof outputs->options,
        .exposure_ev = (float)options->exposure_ev,
        .display = options->display,
        .view = options->view,
        .look = options->look,
        .gamma = (float)options->gamma,
        .bits = options->bits,
        .dither = options->has_no_dither ? PPM_DITHER_OFF : PPM_DITHER_DEFAULT,
        .jpeg_quality = (uint32_t)options->jpeg_quality,
        .command = outputs->command,
        .frames_per_second = options->fps,
        .depth = options->depth,
        .compression = options->packing.kind,
        .compression_level = (float)options->packing.level,
        .is_multipart = options->is_multipart != 0,
        .tile_side = options->tile_side,
    };
    outputs->use = (pattern_use){.has_frame = options->frames.is_given,
                                 .needs_frame = options->frames.is_range,
                                 .has_camera = options->all_cameras};
    if (outputs->command && add_patterns(outputs, options)) return EXIT_DONE;
    fputs("ppm-render: error: out of memory\n", stderr);
    return EXIT_RESOURCES;
}

void outputs_deinit(cli_outputs *outputs)
{
    for (size_t i = 0; i < outputs->count; i++) {
        free(outputs->patterns[i]);
        free(outputs->paths[i]);
    }
    free(outputs->patterns);
    free(outputs->paths);
    free(outputs->command);
}

int outputs_check_names(const cli_outputs *outputs, cli_console *console)
{
    const char *unnumbered = NULL;
    for (size_t i = 0; i < outputs->count; i++) {
        const char *const pattern = outputs->patterns[i];
        const char *const fault = pattern_fault(pattern, &outputs->use);
        if (fault) {
            console_message(console, PPM_LOG_ERROR, "--output: '%s': %s", pattern, fault);
            return EXIT_USAGE;
        }
        if (!unnumbered && !pattern_has_frame(pattern)) unnumbered = pattern;
    }
    if (outputs->use.needs_frame && unnumbered) {
        console_message(console, PPM_LOG_INFO,
                        "'%s' has no place for the frame (%%04d or ####): it is put before the "
                        "ending, as in %s",
                        unnumbered, outputs->paths[0]);
    }
    return EXIT_DONE;
}

int outputs_select(cli_outputs *outputs, const cli_picture *picture)
{
    const char *const camera = picture->camera_name ? picture->camera_name : "camera";
    for (size_t i = 0; i < outputs->count; i++) {
        free(outputs->paths[i]);
        outputs->paths[i] =
            pattern_fill(outputs->patterns[i], &outputs->use, picture->frame, camera);
        if (!outputs->paths[i]) return EXIT_RESOURCES;
    }
    outputs->options.has_frame = picture->has_frame;
    outputs->options.frame = picture->frame;
    outputs->seconds_refreshed = 0.0;
    return EXIT_DONE;
}

void outputs_set_origin(cli_outputs *outputs, const ppm_asset *asset)
{
    outputs->options.copyright = ppm_asset_copyright(asset);
    outputs->options.xmp = ppm_asset_xmp(asset);
}

/* A picture of another size than is asked for is another picture. */
static bool is_there(const cli_outputs *outputs, const char *path)
{
    uint32_t width, height;
    if (!ppm_output_is_whole(path, &width, &height)) return false;
    const bool is_part = outputs->is_cropped && !rescue_is_exr(path); /* no window is told */
    return is_part || ((outputs->width == 0 || width == outputs->width) &&
                       (outputs->height == 0 || height == outputs->height));
}

bool outputs_exist(const cli_outputs *outputs)
{
    for (size_t i = 0; i < outputs->count; i++) {
        if (!is_there(outputs, outputs->paths[i])) return false;
    }
    return true;
}

int outputs_check(const cli_outputs *outputs, ppm_context *context)
{
    for (size_t i = 0; i < outputs->count; i++) {
        const ppm_status status = ppm_output_check(context, outputs->paths[i]);
        if (status != PPM_STATUS_OK) return exit_status_of(status, EXIT_USAGE);
    }
    return EXIT_DONE;
}

int outputs_write(const cli_outputs *outputs, const ppm_render *render)
{
    int result = EXIT_DONE;
    for (size_t i = 0; i < outputs->count; i++) {
        const ppm_status status =
            ppm_render_write(render, outputs->color, outputs->paths[i], &outputs->options);
        if (result == EXIT_DONE) result = exit_status_of(status, EXIT_OUTPUT);
    }
    return result;
}

int outputs_finish(const cli_outputs *outputs, cli_console *console, const ppm_render *render)
{
    int result = EXIT_DONE;
    bool has_exr = false;
    const char *lost = NULL;
    for (size_t i = 0; i < outputs->count; i++) {
        const char *const path = outputs->paths[i];
        const ppm_status status = ppm_render_write(render, outputs->color, path, &outputs->options);
        if (result == EXIT_DONE) result = exit_status_of(status, EXIT_OUTPUT);
        has_exr = has_exr || (rescue_is_exr(path) && status == PPM_STATUS_OK);
        if (status != PPM_STATUS_OK && !lost) lost = path;
    }
    if (lost && !has_exr) {
        rescue_picture(console, render, outputs->color, lost, &outputs->options);
    }
    return result;
}

static bool refresh_is_due(const cli_outputs *outputs, double elapsed)
{
    if (outputs->seconds_refreshed <= 0.0) return elapsed >= REFRESH_FIRST_S;
    const double wait = fmax(fmax(REFRESH_MIN_S, REFRESH_SHARE_OF_ELAPSED * elapsed),
                             REFRESH_COST_FACTOR * outputs->refresh_cost_s);
    return elapsed - outputs->seconds_refreshed >= wait;
}

void outputs_refresh(cli_outputs *outputs, const ppm_render *render, double elapsed)
{
    if (!refresh_is_due(outputs, elapsed)) return;
    const double begin = clock_seconds();
    outputs_write(outputs, render);
    outputs->refresh_cost_s = clock_seconds() - begin;
    outputs->seconds_refreshed = elapsed + outputs->refresh_cost_s;
}
