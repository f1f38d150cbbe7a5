/* The JSON is built and written by jansson. */
#include "stats_json.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <jansson.h>

#include "clock.h"
#include "features_json.h"

/* ---- the file -------------------------------------------------------------------------------- */

typedef struct new_file {
    char *path; /* beside the name that it will get; NULL: written in place */
    FILE *stream;
} new_file;

/* mkstemp makes files that only their owner may read; statistics are for others too, as far as the
 * umask allows. Without that they are still usable, so a failure does not matter. */
static void widen_mode(int descriptor)
{
    const mode_t mask = umask(0);
    umask(mask);
    const int ignored = fchmod(descriptor, 0666 & ~mask);
    (void)ignored;
}

/* A device or pipe must not be replaced by a file. */
static bool is_special(const char *path)
{
    struct stat found;
    return stat(path, &found) == 0 && !S_ISREG(found.st_mode) && !S_ISDIR(found.st_mode);
}

static int open_beside(new_file *file, const char *path)
{
    static const char suffix[] = ".XXXXXX.tmp";
    file->path = malloc(strlen(path) + sizeof suffix);
    if (!file->path) return ENOMEM;
    strcpy(stpcpy(file->path, path), suffix);
    const int descriptor = mkstemps(file->path, 4);
    file->stream = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    if (file->stream) {
        widen_mode(descriptor);
        return 0;
    }
    const int error = errno;
    if (descriptor >= 0) {
        close(descriptor);
        unlink(file->path);
    }
    free(file->path);
    return error;
}

/* Returns 0 or an errno. */
static int new_file_open(new_file *file, const char *path)
{
    if (!is_special(path)) return open_beside(file, path);
    file->path = NULL;
    file->stream = fopen(path, "w");
    return file->stream ? 0 : errno;
}

static void new_file_drop(new_file *file)
{
    fclose(file->stream);
    if (file->path) unlink(file->path);
    free(file->path);
}

/* Gives the complete file its name. Returns 0 or an errno. */
static int new_file_publish(new_file *file, const char *path)
{
    int error = fflush(file->stream) == 0 ? 0 : errno;
    if (error == 0 && file->path && fsync(fileno(file->stream)) != 0) error = errno;
    if (fclose(file->stream) != 0 && error == 0) error = errno;
    if (error == 0 && file->path && rename(file->path, path) != 0) error = errno;
    if (error != 0 && file->path) unlink(file->path);
    free(file->path);
    return error;
}

static int report(cli_console *console, const char *path, int error)
{
    console_message(console, PPM_LOG_ERROR, "%s: cannot write: %s", path, strerror(error));
    return error == ENOMEM ? EXIT_RESOURCES : EXIT_OUTPUT;
}

static int check_path(cli_console *console, const char *path)
{
    struct stat found;
    if (stat(path, &found) == 0 && S_ISDIR(found.st_mode)) return report(console, path, EISDIR);
    new_file file;
    const int error = new_file_open(&file, path);
    if (error != 0) return report(console, path, error);
    new_file_drop(&file);
    return EXIT_DONE;
}

/* ---- the contents ---------------------------------------------------------------------------- */

static json_t *count_json(uint64_t count)
{
    return json_integer((json_int_t)count);
}

static double per_second(uint64_t count, double seconds)
{
    return seconds > 0.0 ? (double)count / seconds : 0.0;
}

static uint64_t peak_memory_bytes(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return (uint64_t)usage.ru_maxrss * 1024; /* Linux counts in KiB */
}

static json_t *scene_json(const ppm_scene *scene)
{
    ppm_scene_info info = {.size = sizeof info};
    if (ppm_scene_get_info(scene, &info) != PPM_STATUS_OK) return NULL;
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}",        //
                     "triangles", count_json(info.triangles), //
                     "instances", count_json(info.instances), //
                     "meshes", count_json(info.meshes),       //
                     "materials", count_json(info.materials), //
                     "textures", count_json(info.textures),   //
                     "lights", count_json(info.lights));
}

static const char *integrator_name(int32_t integrator)
{
    if (integrator == PPM_INTEGRATOR_PATH) return "path";
    return integrator == PPM_INTEGRATOR_PPM ? "ppm" : "sppm";
}

static json_t *crop_json(const uint32_t crop[4])
{
    return json_pack("[o, o, o, o]", count_json(crop[0]), count_json(crop[1]), count_json(crop[2]),
                     count_json(crop[3]));
}

/* The three parts keep each json_pack readable: settings, counts, times. */
static json_t *settings_json(const ppm_render_options *options)
{
    const uint32_t *const crop = options->crop;
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:f, s:o}",      //
                     "integrator", integrator_name(options->integrator),        //
                     "width", count_json(crop[2] - crop[0]),                    //
                     "height", count_json(crop[3] - crop[1]),                   //
                     "full_width", count_json(options->width),                  //
                     "full_height", count_json(options->height),                //
                     "crop", crop_json(crop),                                   //
                     "photons_per_pass", count_json(options->photons_per_pass), //
                     "max_depth", count_json(options->max_depth),               //
                     "alpha", (double)options->alpha,                           //
                     "seed", count_json(options->seed));
}

static json_t *counts_json(const ppm_render_stats *stats)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}",                      //
                     "passes", count_json(stats->passes),                   //
                     "photons_emitted", count_json(stats->photons_emitted), //
                     "photons_stored", count_json(stats->photons_stored),   //
                     "eye_paths", count_json(stats->eye_paths),             //
                     "rays", count_json(stats->rays),                       //
                     "threads", count_json(stats->threads));
}

/* The share of photons that were of use, in all and by light; null where nobody knows. */
static void add_use(json_t *object, const ppm_render_stats *stats)
{
    const bool is_known = stats->photons_used_share >= 0.0;
    json_object_set_new(object, "photons_used_share",
                        is_known ? json_real(stats->photons_used_share) : json_null());
    json_t *const lights = json_array();
    for (uint32_t i = 0; lights && i < stats->light_use_count; i++) {
        const ppm_light_use *const use = &stats->light_uses[i];
        json_array_append_new(lights, json_pack("{s:o, s:f, s:f}", "light", text_json(use->name),
                                                "sent_share", use->sent_share, "used_share",
                                                use->used_share));
    }
    json_object_set_new(object, "photons_by_light", lights);
}

static json_t *times_json(const ppm_render_stats *stats, double total_s, double import_s)
{
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:o}", //
                     "seconds_total", total_s,                             //
                     "seconds_import", import_s,                           //
                     "seconds_build", stats->seconds_build,                //
                     "seconds_render", stats->seconds_render,              //
                     "seconds_eye", stats->seconds_eye,                    //
                     "seconds_photons", stats->seconds_photons,            //
                     "seconds_gather", stats->seconds_gather,              //
                     "photons_per_second",
                     per_second(stats->photons_emitted, stats->seconds_render),         //
                     "rays_per_second", per_second(stats->rays, stats->seconds_render), //
                     "peak_memory_bytes", count_json(peak_memory_bytes()));
}

static json_t *render_json(const ppm_render *render, double total_s, double import_s)
{
    ppm_render_stats stats = {.size = sizeof stats};
    if (ppm_render_get_stats(render, &stats) != PPM_STATUS_OK) return NULL;
    json_t *const result = settings_json(ppm_render_get_options(render));
    if (!result) return NULL;
    json_object_update_new(result, counts_json(&stats));
    add_use(result, &stats);
    json_object_update_new(result, times_json(&stats, total_s, import_s));
    return result;
}

static json_t *files_json(const cli_outputs *outputs)
{
    json_t *const files = json_array();
    for (size_t i = 0; files && i < outputs->count; i++)
        json_array_append_new(files, text_json(outputs->paths[i]));
    return files;
}

/* Which picture it is, and its render. */
static json_t *picture_json(const cli_stats *stats, const stats_source *source)
{
    const ppm_camera_id camera = ppm_render_get_options(source->render)->camera;
    const double total_s = clock_seconds() - stats->seconds_begin;
    json_t *const result = json_object();
    if (source->picture->has_frame) {
        json_object_set_new(result, "frame", json_integer(source->picture->frame));
        json_object_set_new(result, "time_s", json_real(source->picture->time_s));
    }
    json_object_set_new(result, "camera", text_json(ppm_scene_camera_name(source->scene, camera)));
    json_object_set_new(result, "files", files_json(source->outputs));
    json_object_set_new(result, "render", render_json(source->render, total_s, source->import_s));
    return result;
}

/* NULL when memory is out. */
static json_t *root_json(const cli_stats *stats, const stats_source *source, json_t *picture)
{
    json_t *const root = json_object();
    json_object_set_new(root, "version", json_string(ppm_version()));
    json_object_set_new(root, "scene", scene_json(source->scene));
    json_object_set_new(root, "setup",
                        source->setup ? text_json(ppm_setup_path(source->setup)) : json_null());
    json_object_set_new(root, "features", features_json(source->asset));
    if (!stats->is_list) {
        json_object_update(root, picture);
        return root;
    }
    json_object_set_new(root, "skipped", count_json(source->skipped));
    json_object_set(root, "pictures", stats->pictures);
    return root;
}

/* ---- writing --------------------------------------------------------------------------------- */

/* Returns 0 or an errno. */
static int write_root(const char *path, const json_t *root)
{
    new_file file;
    const size_t layout = JSON_INDENT(2) | JSON_REAL_PRECISION(9);
    const int error = new_file_open(&file, path);
    if (error != 0) return error;
    if (json_dumpf(root, file.stream, layout) == 0 && fputc('\n', file.stream) != EOF) {
        return new_file_publish(&file, path);
    }
    const int failure = errno ? errno : EIO;
    new_file_drop(&file);
    return failure;
}

/* A name with a place in it is one of a file for each picture; without one it is taken as it is. */
void stats_init(cli_stats *stats, const cli_options *options, double seconds_begin)
{
    const pattern_use all = {.has_frame = options->frames.is_given,
                             .needs_frame = options->frames.is_range,
                             .has_camera = options->all_cameras};
    const bool is_sequence = options->frames.is_range || options->all_cameras;
    *stats = (cli_stats){.pattern = options->stats, .seconds_begin = seconds_begin};
    if (!options->stats) return;
    if (pattern_has_place(options->stats)) {
        stats->use = all;
    } else {
        stats->is_list = is_sequence;
    }
    if (stats->is_list) stats->pictures = json_array();
}

void stats_deinit(cli_stats *stats)
{
    json_decref(stats->pictures);
    stats->pictures = NULL;
}

static char *path_of(const cli_stats *stats, const cli_picture *picture)
{
    const char *const camera = picture->camera_name ? picture->camera_name : "camera";
    return pattern_fill(stats->pattern, &stats->use, picture->frame, camera);
}

int stats_check(const cli_stats *stats, cli_console *console, const cli_picture *first)
{
    if (!stats->pattern) return EXIT_DONE;
    const char *const fault = pattern_fault(stats->pattern, &stats->use);
    if (fault) {
        console_message(console, PPM_LOG_ERROR, "--stats: '%s': %s", stats->pattern, fault);
        return EXIT_USAGE;
    }
    char *const path = path_of(stats, first);
    const int result = path ? check_path(console, path) : report(console, stats->pattern, ENOMEM);
    free(path);
    return result;
}

int stats_add(cli_stats *stats, cli_console *console, const stats_source *source)
{
    if (!stats->pattern) return EXIT_DONE;
    char *const path = path_of(stats, source->picture);
    json_t *const picture = picture_json(stats, source);
    if (stats->is_list && picture) json_array_append(stats->pictures, picture);
    json_t *const root = picture ? root_json(stats, source, picture) : NULL;
    const int error = path && root ? write_root(path, root) : ENOMEM;
    const int result = error == 0 ? EXIT_DONE : report(console, stats->pattern, error);
    json_decref(root);
    json_decref(picture);
    free(path);
    return result;
}
