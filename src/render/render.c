/* The render session: options, set-up, passes, picture. */
#include "render/render.h"

#include <omp.h>
#include <string.h>

#include "photon/eye.h"
#include "render/catcher.h"
#include "render/denoised.h"
#include "render/features.h"
#include "render/integrator.h"
#include "render/layer_list.h"
#include "render/light_pilot.h"
#include "scene/mipmap.h"
#include "scene/orient.h"
#include "transport/solid.h"

/* Roulette ends paths long before; it is for mirrors without loss. */
enum { DEFAULT_MAX_DEPTH = 4096 };

struct ppm_render {
    ppm_context *context;
    ppm_scene *scene;
    ppm_render_options options;
    bool photons_are_free;
    ppmi_accel *accel;
    ppmi_lights *lights;
    ppmi_albedo_table *albedo;
    ppmi_lobe_table *lobes;  /* NULL unless some material has layers */
    ppmi_glass_table *glass; /* NULL unless some material is rough glass */
    ppmi_spectrum *spectrum;
    ppmi_contacts *contacts;
    const ppmi_integrator *integrator;
    void *state;
    bool has_light_pilot;
    ppmi_job job;
    ppmi_light_groups *groups;
    ppmi_layer_list layers;
    float *plate;            /* RGBA of catchers alone; NULL: not given */
    ppmi_features *features; /* NULL: none is wanted */
    ppm_render_stats stats;
    atomic_bool cancel;
};

/* ---- options --------------------------------------------------------------------------------- */

static float camera_aspect(const ppm_scene *scene, ppm_camera_id camera)
{
    const float aspect = ppm_scene_camera_aspect(scene, camera);
    return aspect > 0.0f ? aspect : 16.0f / 9.0f;
}

static uint32_t at_least_one(float pixels)
{
    return pixels < 1.0f ? 1 : (uint32_t)(pixels + 0.5f);
}

static void resolve_size(const ppm_scene *scene, ppm_render_options *options)
{
    const float aspect = camera_aspect(scene, options->camera);
    if (options->width == 0 && options->height > 0) {
        options->width = at_least_one((float)options->height * aspect);
    }
    if (options->width == 0) options->width = 1280;
    if (options->height == 0) options->height = at_least_one((float)options->width / aspect);
}

static ppm_status resolve_crop(const ppm_scene *scene, ppm_render_options *options)
{
    uint32_t *crop = options->crop;
    if (crop[0] == 0 && crop[1] == 0 && crop[2] == 0 && crop[3] == 0) {
        crop[2] = options->width;
        crop[3] = options->height;
    }
    if (crop[0] >= crop[2] || crop[1] >= crop[3] || crop[2] > options->width ||
        crop[3] > options->height) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "crop %u,%u,%u,%u is empty or not within the picture of %ux%u", crop[0],
                         crop[1], crop[2], crop[3], options->width, options->height);
    }
    return PPM_STATUS_OK;
}

/* A number of the lens or shutter, from least to most. */
static ppm_status check_range(const ppm_scene *scene, const char *name, float value, float least,
                              float most)
{
    if (value >= least && value <= most) return PPM_STATUS_OK;
    return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT, "%s %g: expected %g to %g", name,
                     (double)value, (double)least, (double)most);
}

/* What the options do not say is the camera's. An aperture without a distance stays so: the session
 * focuses on what is in the middle of the picture. */
static ppm_status resolve_lens(const ppm_scene *scene, ppm_render_options *options)
{
    const ppmi_camera none = {0};
    const ppmi_camera *camera = options->camera > 0 ? &scene->cameras[options->camera - 1] : &none;
    if (options->aperture_f_number == 0.0f) options->aperture_f_number = camera->f_number;
    if (options->focus_distance_m == 0.0f) options->focus_distance_m = camera->focus_distance_m;
    if (options->aperture_f_number == 0.0f || camera->kind == PPM_CAMERA_ORTHOGRAPHIC) {
        options->aperture_f_number = INFINITY;
    }
    ppm_status status = check_range(scene, "f-number", options->aperture_f_number, 1e-3f, INFINITY);
    if (status == PPM_STATUS_OK && options->focus_distance_m != 0.0f) {
        status = check_range(scene, "focus distance", options->focus_distance_m, 1e-6f, 1e18f);
    }
    return status;
}

static ppm_status check_shutter(const ppm_scene *scene, const ppm_render_options *options)
{
    const float most = 1e6f;
    ppm_status status = check_range(scene, "shutter: open", options->shutter_open, -most, most);
    if (status == PPM_STATUS_OK) { /* it must not close before it opens */
        status = check_range(scene, "shutter: close", options->shutter_close, options->shutter_open,
                             most);
    }
    return status;
}

static ppm_status resolve_filter(const ppm_scene *scene, ppm_render_options *options)
{
    if (options->pixel_filter < PPM_PIXEL_FILTER_DEFAULT ||
        options->pixel_filter > PPM_PIXEL_FILTER_BLACKMAN_HARRIS) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "no pixel filter of number %d", (int)options->pixel_filter);
    }
    if (options->pixel_filter == PPM_PIXEL_FILTER_DEFAULT) {
        options->pixel_filter = PPM_PIXEL_FILTER_BLACKMAN_HARRIS;
    }
    if (options->pixel_filter_width == 0.0f) {
        options->pixel_filter_width = ppmi_pixel_filter_default_width(options->pixel_filter);
    }
    return check_range(scene, "pixel filter width", options->pixel_filter_width, 1e-3f, 100.0f);
}

static ppm_status resolve_camera(const ppm_scene *scene, ppm_render_options *options)
{
    resolve_size(scene, options);
    ppm_status status = resolve_crop(scene, options);
    if (status == PPM_STATUS_OK) status = resolve_lens(scene, options);
    if (status == PPM_STATUS_OK) status = check_shutter(scene, options);
    if (status == PPM_STATUS_OK) status = resolve_filter(scene, options);
    return status;
}

static ppm_status check_options(const ppm_scene *scene, const ppm_render_options *options)
{
    ppm_context *context = scene->context;
    const uint32_t largest_side = 65536;
    if (options->width > largest_side || options->height > largest_side) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "size %ux%u: more than %u a side",
                         options->width, options->height, largest_side);
    }
    if (options->integrator < PPM_INTEGRATOR_DEFAULT || options->integrator > PPM_INTEGRATOR_PPM) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "no integrator of number %d",
                         (int)options->integrator);
    }
    if (options->schedule < PPM_SCHEDULE_DEFAULT || options->schedule > PPM_SCHEDULE_MEMORYLESS ||
        options->direct < PPM_DIRECT_DEFAULT || options->direct > PPM_DIRECT_PHOTONS ||
        options->aim < PPM_AIM_DEFAULT || options->aim > PPM_AIM_EVEN) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "no schedule of number %d, direct light of number %d or aim of number %d",
                         (int)options->schedule, (int)options->direct, (int)options->aim);
    }
    if (options->schedule == PPM_SCHEDULE_MEMORYLESS &&
        options->integrator != PPM_INTEGRATOR_DEFAULT &&
        options->integrator != PPM_INTEGRATOR_SPPM) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "the memoryless schedule needs the integrator sppm");
    }
    if (options->photons_per_epoch > 0 && options->integrator != PPM_INTEGRATOR_PPM) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "epochs need the integrator ppm");
    }
    if (options->split_depth > PPMI_MAX_SPLIT_DEPTH) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "split depth %d: at most %d",
                         (int)options->split_depth, PPMI_MAX_SPLIT_DEPTH);
    }
    if (options->photons_per_pass > (uint64_t)1 << 30) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "%llu photons per pass: at most 2^30 (use more passes)",
                         (unsigned long long)options->photons_per_pass);
    }
    if (!(options->radius_m >= 0.0f) || isinf(options->radius_m) || !(options->alpha >= 0.0f) ||
        options->alpha > 1.0f) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "radius %g must be a positive length, alpha %g within 0 .. 1",
                         (double)options->radius_m, (double)options->alpha);
    }
    if (options->layers >= PPM_LAYER_BIT(PPM_LAYER_KINDS) ||
        options->light_groups < PPM_LIGHT_GROUPS_DEFAULT ||
        options->light_groups > PPM_LIGHT_GROUPS_NAMED) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT,
                         "layers 0x%llx: bits beyond kind %d, or no light groups of number %d",
                         (unsigned long long)options->layers, PPM_LAYER_KINDS - 1,
                         (int)options->light_groups);
    }
    const ppm_status features = ppmi_features_check(context, options);
    if (features != PPM_STATUS_OK) return features;
    if (options->camera > scene->camera_count) {
        return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "camera %u of %u", options->camera,
                         scene->camera_count);
    }
    return PPM_STATUS_OK;
}

ppm_status ppm_render_options_resolve(const ppm_scene *scene, const ppm_render_options *options,
                                      ppm_render_options *out_resolved)
{
    if (!scene || !out_resolved || (options && options->size < sizeof *options)) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    ppm_render_options resolved = {0};
    if (options) resolved = *options;
    resolved.size = sizeof resolved;
    ppm_status status = check_options(scene, &resolved);
    if (status != PPM_STATUS_OK) return status;
    if (resolved.integrator == PPM_INTEGRATOR_DEFAULT) resolved.integrator = PPM_INTEGRATOR_SPPM;
    if (resolved.camera == 0 && scene->camera_count > 0) resolved.camera = 1;
    status = resolve_camera(scene, &resolved);
    if (status != PPM_STATUS_OK) return status;
    if (resolved.photons_per_pass == 0) {
        const uint64_t pixels = (uint64_t)resolved.width * resolved.height;
        const uint64_t least = 262144, most = (uint64_t)1 << 22;
        resolved.photons_per_pass = pixels < least ? least : pixels > most ? most : pixels;
    }
    if (resolved.schedule == PPM_SCHEDULE_DEFAULT) resolved.schedule = PPM_SCHEDULE_PROGRESSIVE;
    if (resolved.direct == PPM_DIRECT_DEFAULT) resolved.direct = PPM_DIRECT_SAMPLE;
    if (resolved.aim == PPM_AIM_DEFAULT) resolved.aim = PPM_AIM_LEARNT;
    if (ppm_scene_catcher_count(scene) > 0) resolved.is_transparent = 1;
    if (resolved.cryptomatte_ranks == 0) resolved.cryptomatte_ranks = 6;
    if (resolved.denoise) resolved.layers |= PPM_LAYER_BIT(PPM_LAYER_DENOISED);
    if (resolved.light_groups == PPM_LIGHT_GROUPS_DEFAULT) {
        resolved.light_groups = PPM_LIGHT_GROUPS_GIVEN;
    }
    if (resolved.split_depth == 0) resolved.split_depth = 4;
    if (resolved.max_depth == 0) resolved.max_depth = DEFAULT_MAX_DEPTH;
    if (resolved.alpha == 0.0f) resolved.alpha = 2.0f / 3.0f;
    if (resolved.threads == 0) resolved.threads = (uint32_t)omp_get_num_procs();
    if (resolved.threads > 4096) resolved.threads = 4096;
    *out_resolved = resolved;
    return PPM_STATUS_OK;
}

/* ---- creation -------------------------------------------------------------------------------- */

/* What the scene needs to be rendered and does not have. */
static ppm_status complete_scene(ppm_scene *scene, const ppm_render_options *options)
{
    if (scene->is_frozen) return PPM_STATUS_OK;
    ppm_status status = PPM_STATUS_OK;
    if (scene->camera_count == 0) {
        float aspect = 16.0f / 9.0f;
        if (options && options->width > 0 && options->height > 0) {
            aspect = (float)options->width / (float)options->height;
        }
        ppm_camera_id id;
        status = ppm_scene_add_framing_camera(scene, aspect, &id);
        if (status != PPM_STATUS_OK) return status;
        ppmi_log(scene->context, PPM_LOG_INFO,
                 "no camera in the scene: the model is framed from a three-quarter view");
    }
    if (!ppmi_scene_has_light(scene)) {
        /* white things before a white sky could not be seen: the camera sees a grey */
        const ppm_environment_desc environment = {.size = sizeof environment,
                                                  .radiance = {1.0f, 1.0f, 1.0f},
                                                  .has_backdrop = 1,
                                                  .backdrop = {0.25f, 0.25f, 0.25f}};
        status = ppm_scene_set_environment(scene, &environment);
        scene->environment_is_assumed = status == PPM_STATUS_OK;
        ppmi_log(scene->context, PPM_LOG_INFO,
                 "no light in the scene but emissive textures at most: lit by a uniform "
                 "environment of 1 nit, before a grey backdrop");
    }
    return status;
}

static bool has_layers(const ppm_scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (scene->materials[i].is_layered) return true;
    }
    return false;
}

/* A roughness of 0 stays 0 under a texture; glossiness does not. */
static bool has_rough_glass(const ppm_scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const ppm_material_desc *desc = &scene->materials[i].desc;
        if (desc->transmission > 0.0f &&
            (desc->roughness > 0.0f || desc->roughness_is_glossiness)) {
            return true;
        }
    }
    return false;
}

static ppm_status build_glass_table(ppm_render *render)
{
    if (!has_rough_glass(render->scene)) return PPM_STATUS_OK;
    render->glass = ppmi_alloc(render->context, 1, sizeof *render->glass);
    if (!render->glass) {
        return ppmi_fail(render->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: tables");
    }
    ppmi_glass_table_init(render->glass);
    render->albedo->glass = render->glass;
    return PPM_STATUS_OK;
}

static ppm_status build_world(ppm_render *render)
{
    render->albedo = ppmi_alloc(render->context, 1, sizeof *render->albedo);
    render->spectrum = ppmi_alloc(render->context, 1, sizeof *render->spectrum);
    if (!render->albedo || !render->spectrum) {
        return ppmi_fail(render->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: tables");
    }
    ppmi_albedo_table_init(render->albedo);
    if (has_layers(render->scene)) {
        render->lobes = ppmi_alloc(render->context, 1, sizeof *render->lobes);
        if (!render->lobes) {
            return ppmi_fail(render->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: tables");
        }
        ppmi_lobe_table_init(render->lobes);
        render->albedo->lobes = render->lobes;
    }
    ppmi_spectrum_init(render->spectrum, &render->scene->working);
    ppm_status status = build_glass_table(render);
    if (status == PPM_STATUS_OK) {
        status = ppmi_accel_create(render->context, render->scene, &render->accel);
    }
    if (status == PPM_STATUS_OK) {
        status = ppmi_lights_create(render->context, render->scene, &render->lights);
    }
    if (status == PPM_STATUS_OK) {
        status = ppmi_contacts_create(render->context, render->scene, &render->contacts);
    }
    return status;
}

static const ppmi_integrator *integrator_of(int32_t number)
{
    switch (number) {
    case PPM_INTEGRATOR_PATH:
        return &ppmi_integrator_path;
    case PPM_INTEGRATOR_PPM:
        return &ppmi_integrator_ppm;
    default:
        return &ppmi_integrator_sppm;
    }
}

static bool has_solids(const ppm_scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (scene->materials[i].is_solid_glass) return true;
    }
    return false;
}

static void set_up_shutter(ppm_render *render)
{
    ppmi_job *job = &render->job;
    if (!ppmi_shutter_is_open(job)) return;
    const bool moves = ppmi_scene_moves(render->scene);
    job->pass_has_one_time = moves && job->options->integrator != PPM_INTEGRATOR_PATH;
    job->around_camera_changes = (moves || job->view.motion_steps > 1) && has_solids(render->scene);
    if (moves && job->options->integrator == PPM_INTEGRATOR_PPM &&
        job->options->photons_per_epoch == 0) {
        ppmi_log(render->context, PPM_LOG_WARNING,
                 "the integrator ppm without epochs shows one moment of what moves: no motion "
                 "blur");
    }
}

/* The view with its lens; fills in the distance that is in focus where nobody said it. */
static ppm_status set_up_camera(ppm_render *render)
{
    ppm_render_options *options = &render->options;
    ppmi_camera_view *view = &render->job.view;
    ppmi_camera_view_init(&render->scene->cameras[options->camera - 1], options->width,
                          options->height, view);
    ppmi_pixel_filter_init(&render->job.filter, options->pixel_filter, options->pixel_filter_width);
    render->job.around_camera =
        ppmi_solids_around(&render->job.world, ppmi_camera_view_start(view));
    set_up_shutter(render);
    if (isinf(options->aperture_f_number)) return PPM_STATUS_OK;
    if (options->focus_distance_m == 0.0f) {
        if (!ppmi_distance_in_the_middle(&render->job.world, view, &options->focus_distance_m)) {
            return ppmi_fail(render->context, PPM_STATUS_INVALID_ARGUMENT,
                             "aperture f/%g without a focus distance: there is nothing in the "
                             "middle of the picture to focus on",
                             (double)options->aperture_f_number);
        }
        ppmi_log(render->context, PPM_LOG_INFO,
                 "focused on what is in the middle of the picture, at %.4g m",
                 (double)options->focus_distance_m);
    }
    ppmi_camera_view_set_lens(view, options->aperture_f_number, options->focus_distance_m);
    return PPM_STATUS_OK;
}

static ppm_status start(ppm_render *render)
{
    const double begin = omp_get_wtime();
    ppm_status status = build_world(render);
    if (status != PPM_STATUS_OK) return status;
    render->job = (ppmi_job){
        .context = render->context,
        .options = &render->options,
        .photons_are_free = render->photons_are_free,
        .cancel = &render->cancel,
    };
    ppmi_world_init(&render->job.world, render->scene, render->accel, render->lights,
                    render->albedo, render->spectrum, render->contacts);
    const uint32_t *crop = render->options.crop;
    render->job.film = (ppmi_film){crop[0], crop[1], crop[2] - crop[0], crop[3] - crop[1]};
    status = set_up_camera(render);
    if (status != PPM_STATUS_OK) return status;
    render->integrator = integrator_of(render->options.integrator);
    render->stats.size = sizeof render->stats;
    render->stats.threads = render->options.threads;
    render->stats.photons_used_share = -1.0;
    render->stats.seconds_build = omp_get_wtime() - begin;
    if (ppmi_layers_have(&render->options, PPM_LAYER_LIGHT_GROUP, PPM_LAYER_GROUP_CAUSTICS)) {
        status = ppmi_light_groups_create(render->context, render->scene,
                                          render->options.light_groups, &render->groups);
        if (status != PPM_STATUS_OK) return status;
        render->job.groups = render->groups;
    }
    status = ppmi_layer_list_init(&render->job, &render->layers);
    if (status != PPM_STATUS_OK) return status;
    if (ppmi_features_are_wanted(&render->options)) {
        status = ppmi_features_create(&render->job, &render->features);
        if (status != PPM_STATUS_OK) return status;
    }
    return render->integrator->create(&render->job, &render->state);
}

static void warn_about_the_lens(const ppm_scene *scene, const ppm_render_options *asked,
                                const ppm_render_options *resolved)
{
    if (!asked || !isinf(resolved->aperture_f_number)) return;
    const ppmi_camera *camera = &scene->cameras[resolved->camera - 1];
    if (asked->aperture_f_number > 0.0f && !isinf(asked->aperture_f_number)) {
        ppmi_log(scene->context, PPM_LOG_WARNING,
                 "camera '%s' is orthographic: the aperture is ignored, all is in focus",
                 camera->name);
    } else if (asked->focus_distance_m > 0.0f) {
        ppmi_log(scene->context, PPM_LOG_WARNING,
                 "a focus distance without an aperture changes nothing: all is in focus");
    }
}

/* A frame in which nothing is to be seen is a picture of the surroundings; a scene to which nobody
 * gave anything is a mistake. */
static bool has_anything(const ppm_scene *scene)
{
    return scene->instance_count > 0 || scene->camera_count > 0 || scene->punctual_count > 0;
}

ppm_status ppm_render_create(ppm_scene *scene, const ppm_render_options *options,
                             ppm_render **out_render)
{
    if (!scene || !out_render) return PPM_STATUS_INVALID_ARGUMENT;
    uint32_t turned;
    if (!has_anything(scene)) {
        return ppmi_fail(scene->context, PPM_STATUS_WRONG_STATE,
                         "there is nothing to render: the scene has no triangles, points or lines, "
                         "no camera and no light");
    }
    ppm_status status = complete_scene(scene, options);
    if (status == PPM_STATUS_OK && !scene->is_frozen) status = ppmi_scene_orient(scene, &turned);
    if (status != PPM_STATUS_OK) return status;
    ppmi_scene_freeze(scene);
    ppm_render_options resolved;
    status = ppm_render_options_resolve(scene, options, &resolved);
    ppm_render *render = NULL;
    if (status == PPM_STATUS_OK) {
        render = ppmi_alloc_zeroed(scene->context, 1, sizeof *render);
        if (!render) status = ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory");
    }
    if (status != PPM_STATUS_OK) {
        ppmi_scene_thaw(scene);
        return status;
    }
    render->context = scene->context;
    render->scene = scene;
    render->options = resolved;
    render->photons_are_free = !options || options->photons_per_pass == 0;
    warn_about_the_lens(scene, options, &resolved);
    status = ppmi_scene_build_mipmaps(scene);
    if (status == PPM_STATUS_OK) status = start(render);
    if (status != PPM_STATUS_OK) {
        ppm_render_destroy(render);
        return status;
    }
    *out_render = render;
    return PPM_STATUS_OK;
}

void ppm_render_destroy(ppm_render *render)
{
    if (!render) return;
    if (render->state) render->integrator->destroy(&render->job, render->state);
    ppmi_features_destroy(&render->job, render->features);
    ppmi_layer_list_deinit(render->context, &render->layers);
    ppmi_light_groups_destroy(render->context, render->groups);
    ppmi_free(render->context, render->plate);
    ppmi_contacts_destroy(render->context, render->contacts);
    ppmi_lights_destroy(render->lights);
    ppmi_accel_destroy(render->accel);
    ppmi_free(render->context, render->albedo);
    ppmi_free(render->context, render->lobes);
    ppmi_free(render->context, render->glass);
    ppmi_free(render->context, render->spectrum);
    ppmi_scene_thaw(render->scene);
    ppmi_free(render->context, render);
}

/* ---- passes ---------------------------------------------------------------------------------- */

ppm_status ppm_render_advance(ppm_render *render)
{
    if (!render) return PPM_STATUS_INVALID_ARGUMENT;
    if (atomic_load(&render->cancel)) return PPM_STATUS_CANCELLED;
    const double begin = omp_get_wtime();
    ppm_status status = PPM_STATUS_OK;
    if (!render->has_light_pilot) {
        ppm_render_stats added = render->stats;
        status = ppmi_light_pilot(&render->job, render->lights, &added);
        if (status != PPM_STATUS_OK) return status;
        render->stats = added;
        render->has_light_pilot = true;
    }
    status =
        render->integrator->pass(&render->job, render->state, render->stats.passes, &render->stats);
    if (status != PPM_STATUS_OK) return status;
    if (render->features) {
        ppmi_features_pass(&render->job, render->features, render->stats.passes, &render->stats);
    }
    render->stats.passes++;
    render->stats.seconds_render += omp_get_wtime() - begin;
    return PPM_STATUS_OK;
}

void ppm_render_cancel(ppm_render *render)
{
    if (render) atomic_store(&render->cancel, true);
}

const ppm_render_options *ppm_render_get_options(const ppm_render *render)
{
    return render ? &render->options : NULL;
}

ppm_status ppm_render_get_stats(const ppm_render *render, ppm_render_stats *out_stats)
{
    if (!render || !out_stats || out_stats->size < sizeof *out_stats) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    *out_stats = render->stats;
    return PPM_STATUS_OK;
}

static ppm_status take_plate(const ppm_render *render, float *rgba)
{
    const size_t pixels = ppmi_film_pixel_count(&render->job.film);
    float *catchers = ppmi_alloc(render->context, pixels, 4 * sizeof *catchers);
    if (!catchers) {
        return ppmi_fail(render->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: %zu pixels",
                         pixels);
    }
    render->integrator->read_layer(&render->job, render->state, PPM_LAYER_CATCHER, 0,
                                   render->stats.passes, catchers);
    ppmi_catcher_take_plate(catchers, render->plate, pixels, rgba);
    ppmi_free(render->context, catchers);
    return PPM_STATUS_OK;
}

ppm_status ppm_render_read_image(const ppm_render *render, float *rgba, size_t rgba_count)
{
    if (!render || !rgba) return PPM_STATUS_INVALID_ARGUMENT;
    const size_t needed = 4 * ppmi_film_pixel_count(&render->job.film);
    if (rgba_count != needed) {
        return ppmi_fail(render->context, PPM_STATUS_INVALID_ARGUMENT,
                         "the picture has %zu floats, the buffer %zu", needed, rgba_count);
    }
    if (render->stats.passes == 0) {
        return ppmi_fail(render->context, PPM_STATUS_WRONG_STATE, "no pass is finished yet");
    }
    render->integrator->resolve(&render->job, render->state, render->stats.passes, rgba);
    return render->plate ? take_plate(render, rgba) : PPM_STATUS_OK;
}

ppm_status ppm_render_set_plate(ppm_render *render, const float *rgba, size_t value_count)
{
    if (!render || !rgba) return PPM_STATUS_INVALID_ARGUMENT;
    const size_t needed = 4 * ppmi_film_pixel_count(&render->job.film);
    if (value_count != needed) {
        return ppmi_fail(render->context, PPM_STATUS_INVALID_ARGUMENT,
                         "the picture has %zu floats, the plate %zu", needed, value_count);
    }
    if (ppm_scene_catcher_count(render->scene) == 0) {
        return ppmi_fail(render->context, PPM_STATUS_WRONG_STATE,
                         "a plate needs a catcher in the scene");
    }
    float *plate = ppmi_alloc(render->context, needed, sizeof *plate);
    if (!plate) {
        return ppmi_fail(render->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory: the plate");
    }
    memcpy(plate, rgba, needed * sizeof *plate);
    ppmi_free(render->context, render->plate);
    render->plate = plate;
    return PPM_STATUS_OK;
}

ppm_context *ppmi_render_context(const ppm_render *render)
{
    return render->context;
}

const ppm_scene *ppmi_render_scene(const ppm_render *render)
{
    return render->scene;
}

const ppmi_camera_view *ppmi_render_view(const ppm_render *render)
{
    return &render->job.view;
}

const char *ppmi_render_integrator_name(const ppm_render *render)
{
    return render->integrator->name;
}

/* ---- layers ---------------------------------------------------------------------------------- */

uint32_t ppm_render_layer_count(const ppm_render *render)
{
    return render ? render->layers.count : 0;
}

ppm_status ppm_render_get_layer(const ppm_render *render, uint32_t index, ppm_layer_info *out_info)
{
    if (!render || !out_info || out_info->size < sizeof *out_info ||
        index >= render->layers.count) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    const ppmi_layer *layer = &render->layers.layers[index];
    *out_info = (ppm_layer_info){.size = sizeof *out_info,
                                 .kind = layer->kind,
                                 .name = layer->name,
                                 .channel_count = layer->channel_count,
                                 .is_exact = layer->is_exact};
    for (uint32_t i = 0; i < layer->channel_count; i++)
        out_info->channel_names[i] = layer->channel_names[i];
    return PPM_STATUS_OK;
}

static ppm_status read_denoised(const ppm_render *render, float *rgba, size_t value_count)
{
    const ppm_status status = ppm_render_read_image(render, rgba, value_count);
    if (status != PPM_STATUS_OK) return status;
    if (render->stats.passes < 2) {
        ppmi_log(render->context, PPM_LOG_WARNING,
                 "one pass does not tell light from noise: nothing is denoised");
        return PPM_STATUS_OK;
    }
    const ppmi_denoised_source source = {.job = &render->job,
                                         .integrator = render->integrator,
                                         .state = render->state,
                                         .features = render->features,
                                         .passes = render->stats.passes,
                                         .has_plate = render->plate != NULL};
    return ppmi_denoised_apply(&source, rgba);
}

ppm_status ppm_render_read_layer(const ppm_render *render, uint32_t index, float *values,
                                 size_t value_count)
{
    if (!render || !values || index >= render->layers.count) return PPM_STATUS_INVALID_ARGUMENT;
    const ppmi_layer *layer = &render->layers.layers[index];
    if (layer->kind == PPM_LAYER_COMBINED) {
        return ppm_render_read_image(render, values, value_count);
    }
    const size_t needed = layer->channel_count * ppmi_film_pixel_count(&render->job.film);
    if (value_count != needed) {
        return ppmi_fail(render->context, PPM_STATUS_INVALID_ARGUMENT,
                         "layer '%s' has %zu floats, the buffer %zu", layer->name, needed,
                         value_count);
    }
    if (render->stats.passes == 0) {
        return ppmi_fail(render->context, PPM_STATUS_WRONG_STATE, "no pass is finished yet");
    }
    if (ppmi_features_have(layer->kind)) {
        ppmi_features_read(&render->job, render->features, layer, values);
        return PPM_STATUS_OK;
    }
    if (layer->kind == PPM_LAYER_DENOISED) return read_denoised(render, values, value_count);
    render->integrator->read_layer(&render->job, render->state, layer->kind, layer->number,
                                   render->stats.passes, values);
    return PPM_STATUS_OK;
}

ppm_status ppm_render_cryptomatte_manifest(const ppm_render *render, int32_t kind,
                                           const char **out_json)
{
    if (!render || !out_json) return PPM_STATUS_INVALID_ARGUMENT;
    const char *manifest = ppmi_features_manifest(render->features, kind);
    if (!manifest) {
        return ppmi_fail(render->context, PPM_STATUS_INVALID_ARGUMENT,
                         "the session has no Cryptomatte of layer kind %d", (int)kind);
    }
    *out_json = manifest;
    return PPM_STATUS_OK;
}
