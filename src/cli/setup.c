/* The library's own checks come last: what only the scene can tell, such as a camera's name. */
#include "setup.h"

#include <stdlib.h>
#include <string.h>

#include "base/suggest.h"
#include "values.h"

static ppm_status add_environment(ppm_scene *scene, const char *path)
{
    const ppm_image_desc image = {
        .size = sizeof image, .name = path, .role = PPM_IMAGE_COLOR, .path = path};
    ppm_environment_desc environment = {.size = sizeof environment, .radiance = {1.0f, 1.0f, 1.0f}};
    const ppm_status status = ppm_scene_add_image(scene, &image, &environment.image);
    return status == PPM_STATUS_OK ? ppm_scene_set_environment(scene, &environment) : status;
}

static ppm_status add_fog(ppm_scene *scene, const fog_values *fog)
{
    const float s = (float)fog->sigma_s, a = (float)fog->sigma_a;
    const ppm_fog_desc desc = {.size = sizeof desc,
                               .sigma_s = {s, s, s},
                               .sigma_a = {a, a, a},
                               .asymmetry_g = (float)fog->g};
    return s > 0.0f || a > 0.0f ? ppm_scene_set_fog(scene, &desc) : PPM_STATUS_OK;
}

int setup_scene(ppm_scene *scene, const cli_options *options)
{
    const ppm_import_options import_options = {.size = sizeof import_options,
                                               .light_units = options->light_units,
                                               .transmission = options->transmission};
    ppm_status status = ppm_scene_import(scene, options->input, &import_options);
    if (status == PPM_STATUS_OK && options->environment) {
        status = add_environment(scene, options->environment);
    }
    if (status == PPM_STATUS_OK) status = add_fog(scene, &options->fog);
    return exit_status_of(status, EXIT_INPUT);
}

static int no_such_camera(cli_console *console, const ppm_scene *scene, const char *text)
{
    const uint32_t count = ppm_scene_camera_count(scene);
    if (count == 0) {
        console_message(console, PPM_LOG_ERROR, "--camera: '%s': the file has no camera", text);
        return EXIT_USAGE;
    }
    const char **names = calloc(count, sizeof *names);
    if (!names) return EXIT_RESOURCES;
    for (uint32_t i = 0; i < count; i++)
        names[i] = ppm_scene_camera_name(scene, i + 1);
    const char *const nearest = ppmi_suggest(text, names, count);
    console_message(console, PPM_LOG_ERROR,
                    "--camera: no camera '%s'; there %s %u, the first is '%s'%s%s%s", text,
                    count == 1 ? "is" : "are", count, names[0], nearest ? "; did you mean '" : "",
                    nearest ? nearest : "", nearest ? "'?" : "");
    free(names);
    return EXIT_USAGE;
}

/* A name wins over a number: a camera may be called "2". Ids count from 1 in the file's order. */
static int find_camera(cli_console *console, const ppm_scene *scene, const char *text,
                       ppm_camera_id *out_camera)
{
    const uint32_t count = ppm_scene_camera_count(scene);
    for (ppm_camera_id id = 1; id <= count; id++) {
        if (strcmp(ppm_scene_camera_name(scene, id), text) == 0) {
            *out_camera = id;
            return EXIT_DONE;
        }
    }
    uint64_t number = 0;
    if (!value_parse_integer(text, &number) || number < 1 || number > count) {
        return no_such_camera(console, scene, text);
    }
    *out_camera = (ppm_camera_id)number;
    return EXIT_DONE;
}

int setup_render_options(cli_console *console, const ppm_scene *scene, const cli_options *options,
                         ppm_render_options *out_render_options)
{
    *out_render_options = (ppm_render_options){
        .size = sizeof *out_render_options,
        .integrator = options->integrator,
        .schedule = options->schedule,
        .direct = options->direct,
        .photons_per_epoch = options->photons_per_epoch,
        .split_depth = options->split_depth,
        .width = options->size.width,
        .height = options->size.height,
        .photons_per_pass = options->photons,
        .max_depth = (uint32_t)options->max_depth,
        .radius_m = (float)options->radius_m,
        .alpha = (float)options->alpha,
        .seed = options->seed,
        .threads = (uint32_t)options->threads,
    };
    if (!options->camera) return EXIT_DONE;
    return find_camera(console, scene, options->camera, &out_render_options->camera);
}
