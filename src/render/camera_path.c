/* The start of camera paths, for all integrators. */
#include "render/integrator.h"
#include "transport/solid.h"

/* Dimensions that are stratified over the passes of a pixel: place in the pixel and on the lens,
 * then the first vertices' lights and lobes. The place on the lens and the time are drawn only if
 * they matter: a pinhole's paths have the rest of the first set for their vertices, and a lens gets
 * a set more. Time has a set of its own, beyond those of the path. */
enum { STRATIFIED_SETS = 4, TIME_SET = 64 };

/* Side of the square that textures are filtered over in a pass, in pixels. One pass alone has to
 * filter over about the whole pixel; the n-th finds n - 1 others spread over it, and stands for its
 * n-th part. What is filtered more than that is blur that stays, so there is no least side. The
 * factor is for the look-up, whose filter is broader than its footprint: box and tent together have
 * the variance of a box of sqrt(3) times the side. (docs/textures.md has what was measured.) */
static float filtered_side(uint64_t pass)
{
    return 0.7f / sqrtf((float)pass + 1.0f);
}

static ppmi_differential differential_of(const ppmi_camera_ray *ray, float side)
{
    return (ppmi_differential){
        .is_known = true,
        .direction = ray->ray.direction,
        .position_dx = vec3_scale(ray->position_dx, side),
        .position_dy = vec3_scale(ray->position_dy, side),
        .direction_dx = vec3_scale(ray->direction_dx, side),
        .direction_dy = vec3_scale(ray->direction_dy, side),
    };
}

/* The pilot's photons stand for all times: their pass is of the middle. */
float ppmi_time_of_pass(const ppmi_job *job, uint64_t pass)
{
    if (pass >= PPMI_PILOT_PASS) return 0.5f;
    return (float)ppmi_sobol1((uint32_t)pass, TIME_SET, ppmi_hash64(job->options->seed));
}

ppmi_camera_ray ppmi_start_camera_path(const ppmi_job *job, ppmi_walker *walker, uint32_t x,
                                       uint32_t y, uint64_t pass)
{
    /* numbers belong to the pixel of the whole picture: a crop shows what the whole would */
    x += job->film.x0;
    y += job->film.y0;
    const uint64_t pixel = (uint64_t)y * job->options->width + x;
    const uint64_t pixel_count = (uint64_t)job->options->width * job->options->height;
    const uint64_t seed = ppmi_hash64(job->options->seed) ^ ppmi_hash64(~pixel);
    const uint32_t sets = job->view.has_lens ? STRATIFIED_SETS + 1 : STRATIFIED_SETS;
    ppmi_walker_start(
        walker, ppmi_rng_start(job->options->seed, PPMI_STREAM_EYE, pass * pixel_count + pixel),
        seed, (uint32_t)pass, 0, sets);
    walker->interior = job->around_camera;
    const float dx = ppmi_pixel_filter_offset(&job->filter, ppmi_walker_float(walker));
    const float dy = ppmi_pixel_filter_offset(&job->filter, ppmi_walker_float(walker));
    ppmi_vec2 lens = {0.0f, 0.0f};
    if (job->view.has_lens) {
        const float u = ppmi_walker_float(walker), v = ppmi_walker_float(walker);
        lens = ppmi_sample_disk(u, v);
    }
    const float px = (float)x + (0.5f + dx), py = (float)y + (0.5f + dy);
    ppmi_camera_ray result;
    if (ppmi_shutter_is_open(job)) {
        walker->time = job->pass_has_one_time ? ppmi_time_of_pass(job, pass)
                                              : (float)ppmi_sobol1((uint32_t)pass, TIME_SET, seed);
        const ppmi_camera_view view = ppmi_camera_view_at(&job->view, walker->time);
        if (job->around_camera_changes) {
            walker->interior =
                ppmi_solids_around_at(&job->world, ppmi_camera_view_start(&view), walker->time);
        }
        result = ppmi_camera_view_lens_ray(&view, px, py, lens);
        result.ray.time = walker->time;
    } else {
        result = ppmi_camera_view_lens_ray(&job->view, px, py, lens);
    }
    if (job->world.has_textures) {
        walker->differential = differential_of(&result, filtered_side(pass));
    }
    return result;
}
