/* The library's own checks come last: what only the scene can tell, such as a camera's name. */
#include "setup.h"

#include <math.h>
#include <stdbool.h>

#include "choose.h"
#include "focus.h"

static float radians(double degrees)
{
    return (float)(degrees * 3.14159265358979323846 / 180.0);
}

static float intensity_of(const cli_options *options)
{
    return options->environment_intensity > 0.0 ? (float)options->environment_intensity : 1.0f;
}

/* Where only the backdrop is asked for, the file or its setup may have surroundings: they stay. */
static ppm_status keep_surroundings(const ppm_scene *scene, ppm_environment_desc *environment,
                                    bool *out_is_kept)
{
    ppm_environment_desc before = {.size = sizeof before};
    const ppm_status status = ppm_scene_get_environment(scene, &before);
    *out_is_kept =
        before.radiance[0] > 0.0f || before.radiance[1] > 0.0f || before.radiance[2] > 0.0f;
    if (!*out_is_kept) return status;
    environment->image = before.image;
    environment->rotation_rad = before.rotation_rad;
    for (int i = 0; i < 3; i++)
        environment->radiance[i] = before.radiance[i];
    return status;
}

/* The radiance of all directions while no picture and no sky is asked for. A file without any light
 * gets an even one; the library would add it by itself, with a backdrop of its own. */
static ppm_status default_radiance(const ppm_scene *scene, const cli_options *options,
                                   float *out_radiance)
{
    ppm_scene_info info = {.size = sizeof info};
    const ppm_status status = ppm_scene_get_info(scene, &info);
    *out_radiance = info.has_light || options->sun.is_given ? 0.0f : 1.0f;
    return status;
}

static ppm_status set_environment(ppm_scene *scene, const cli_options *options)
{
    const background_choice *const background = &options->background;
    ppm_environment_desc environment = {
        .size = sizeof environment,
        .rotation_rad = radians(options->environment_rotation_deg),
        .has_backdrop = background->kind == BACKGROUND_RADIANCE,
        .backdrop = {background->radiance[0], background->radiance[1], background->radiance[2]},
    };
    float radiance = intensity_of(options);
    bool is_kept = false;
    ppm_status status = PPM_STATUS_OK;
    if (options->environment) {
        const ppm_image_desc image = {.size = sizeof image,
                                      .name = options->environment,
                                      .role = PPM_IMAGE_COLOR,
                                      .path = options->environment};
        status = ppm_scene_add_image(scene, &image, &environment.image);
    } else {
        status = keep_surroundings(scene, &environment, &is_kept);
        if (status == PPM_STATUS_OK) status = default_radiance(scene, options, &radiance);
    }
    if (status != PPM_STATUS_OK) return status;
    for (int i = 0; i < 3 && !is_kept; i++)
        environment.radiance[i] = radiance;
    return ppm_scene_set_environment(scene, &environment);
}

static ppm_status add_sun(ppm_scene *scene, const cli_options *options)
{
    ppm_sun_sky_desc desc;
    ppm_sun_sky_desc_init(&desc);
    desc.elevation_rad = radians(options->sun.elevation_deg);
    desc.azimuth_rad = radians(options->sun.azimuth_deg);
    if (options->sun.turbidity > 0.0) desc.turbidity = (float)options->sun.turbidity;
    desc.factor = intensity_of(options);
    desc.sun_only = options->environment != NULL;
    return ppm_scene_add_sun_sky(scene, &desc, NULL);
}

static ppm_status add_fog(ppm_scene *scene, const fog_values *fog)
{
    const float s = (float)fog->sigma_s, a = (float)fog->sigma_a;
    const ppm_fog_desc desc = {.size = sizeof desc,
                               .sigma_s = {s, s, s},
                               .sigma_a = {a, a, a},
                               .asymmetry_g = (float)fog->g};
    return fog->is_given ? ppm_scene_set_fog(scene, &desc) : PPM_STATUS_OK;
}

ppm_status setup_surroundings(ppm_scene *scene, const cli_options *options)
{
    const bool is_surrounded =
        options->environment || options->background.kind != BACKGROUND_UNSAID;
    ppm_status status = is_surrounded ? set_environment(scene, options) : PPM_STATUS_OK;
    if (status == PPM_STATUS_OK && options->sun.is_given) status = add_sun(scene, options);
    if (status == PPM_STATUS_OK) status = add_fog(scene, &options->fog);
    return status;
}

static const char *camera_name(const void *user, uint32_t index)
{
    return ppm_scene_camera_name(user, index + 1);
}

/* Ids count from 1 in the file's order. */
static int find_camera(cli_console *console, const ppm_scene *scene, const char *text,
                       ppm_camera_id *out_camera)
{
    const choice_list list = {.option = "--camera",
                              .thing = "camera",
                              .has_numbers = true,
                              .count = ppm_scene_camera_count(scene),
                              .name_of = camera_name,
                              .user = scene};
    uint32_t index = 0;
    const int result = choose(console, &list, text, &index);
    if (result == EXIT_DONE) *out_camera = index + 1;
    return result;
}

int setup_missing_camera(cli_console *console, ppm_scene *scene, const cli_options *options)
{
    if (ppm_scene_camera_count(scene) > 0) return EXIT_DONE;
    const float width = (float)options->size.width, height = (float)options->size.height;
    const float aspect = width > 0.0f && height > 0.0f ? width / height : 16.0f / 9.0f;
    ppm_camera_id id = 0;
    const ppm_status status = ppm_scene_add_framing_camera(scene, aspect, &id);
    if (status != PPM_STATUS_OK) return exit_status_of(status, EXIT_INPUT);
    console_message(console, PPM_LOG_INFO,
                    "no camera in the scene: the model is framed from a three-quarter view");
    return EXIT_DONE;
}

/* Distances are from a camera: one that the library would add as the render begins is needed now.
 */
static int set_focus(cli_console *console, ppm_scene *scene, const cli_options *options,
                     ppm_render_options *render_options)
{
    const char *const focus = options->focus;
    if (focus_is_node(scene, focus)) {
        const int result = setup_missing_camera(console, scene, options);
        if (result != EXIT_DONE) return result;
    }
    const ppm_camera_id camera = render_options->camera ? render_options->camera : 1;
    return focus_find(console, scene, camera, focus, &render_options->focus_distance_m);
}

/* Shares are rounded to whole pixels, so that parts which meet in shares meet in pixels. */
static int set_crop(const ppm_scene *scene, const crop_window *crop,
                    ppm_render_options *render_options)
{
    double sides[4] = {1.0, 1.0, 1.0, 1.0};
    if (crop->is_in_shares) {
        ppm_render_options resolved;
        const ppm_status status = ppm_render_options_resolve(scene, render_options, &resolved);
        if (status != PPM_STATUS_OK) return exit_status_of(status, EXIT_USAGE);
        for (int i = 0; i < 4; i++)
            sides[i] = i % 2 == 0 ? resolved.width : resolved.height;
    }
    for (int i = 0; i < 4; i++)
        render_options->crop[i] = (uint32_t)lround(crop->sides[i] * sides[i]);
    return EXIT_DONE;
}

static int set_camera(cli_console *console, ppm_scene *scene, const cli_options *options,
                      const cli_picture *picture, ppm_render_options *render_options)
{
    int result = EXIT_DONE;
    render_options->camera = picture->camera;
    if (options->camera) {
        result = find_camera(console, scene, options->camera, &render_options->camera);
    }
    if (result == EXIT_DONE && options->focus) {
        result = set_focus(console, scene, options, render_options);
    }
    if (result == EXIT_DONE && options->crop.is_given) {
        result = set_crop(scene, &options->crop, render_options);
    }
    return result;
}

int setup_render_options(cli_console *console, ppm_scene *scene, const cli_options *options,
                         const cli_picture *picture, ppm_render_options *out_render_options)
{
    *out_render_options = (ppm_render_options){
        .size = sizeof *out_render_options,
        .integrator = options->integrator,
        .schedule = options->schedule,
        .direct = options->direct,
        .aim = options->aim,
        .photons_per_epoch = options->photons_per_epoch,
        .split_depth = options->split_depth,
        .width = options->size.width,
        .height = options->size.height,
        .photons_per_pass = options->photons,
        .max_depth = (uint32_t)options->max_depth,
        .radius_m = (float)options->radius_m,
        .alpha = (float)options->alpha,
        .seed = picture->has_frame ? frames_seed(options->seed, picture->frame) : options->seed,
        .threads = (uint32_t)options->threads,
        .aperture_f_number = (float)options->aperture,
        .shutter_open = (float)options->shutter.open,
        .shutter_close = (float)options->shutter.close,
        .pixel_filter = options->filter.kind,
        .pixel_filter_width = (float)options->filter.width,
        .layers = options->layers,
        .light_groups = options->light_groups,
        .is_transparent = options->is_transparent != 0,
        .normals_of_camera = options->normals_of_camera != 0,
        .follows_specular = options->follows_specular != 0,
        .cryptomatte_ranks = (uint32_t)options->cryptomatte_ranks,
        .denoise = options->denoises != 0,
    };
    return set_camera(console, scene, options, picture, out_render_options);
}
