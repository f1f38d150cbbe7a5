/* The start of camera paths, for all integrators. */
#include "render/integrator.h"

/* Dimensions that are stratified over the passes of a pixel: place in the pixel and on the lens,
 * then the first vertices' lights and lobes. The place on the lens and the time are drawn only if
 * they matter: a pinhole's paths have the rest of the first set for their vertices, and a lens gets
 * a set more. Time has a set of its own, beyond those of the path. */
enum { STRATIFIED_SETS = 4, TIME_SET = 64 };

/* Textures are filtered over this part of a pixel in a pass. One pass alone has to filter over the
 * whole pixel; many that fall all over it need less and less, and what they filter is blur that
 * stays (Pharr, Jakob, Humphreys 2023, "Physically Based Rendering", section 10.1.3, scales by the
 * square root of the samples a pixel, down to an eighth; here their number is open). */
static float filtered_part(uint64_t pass)
{
    enum { FULL = 64 };
    return pass < FULL ? 1.0f / sqrtf((float)(pass + 1)) : 0.125f;
}

static ppmi_differential differential_of(const ppmi_camera_ray *ray, float part)
{
    return (ppmi_differential){
        .is_known = true,
        .direction = ray->ray.direction,
        .position_dx = vec3_scale(ray->position_dx, part),
        .position_dy = vec3_scale(ray->position_dy, part),
        .direction_dx = vec3_scale(ray->direction_dx, part),
        .direction_dy = vec3_scale(ray->direction_dy, part),
    };
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
    ppmi_camera_ray result =
        ppmi_camera_view_lens_ray(&job->view, (float)x + (0.5f + dx), (float)y + (0.5f + dy), lens);
    if (job->options->shutter_close > job->options->shutter_open) {
        walker->time = (float)ppmi_sobol1((uint32_t)pass, TIME_SET, seed);
        result.ray.time = walker->time;
    }
    if (job->world.has_textures) {
        walker->differential = differential_of(&result, filtered_part(pass));
    }
    return result;
}
