/* The start of camera paths, for all integrators. */
#include "render/integrator.h"

/* Dimensions that are stratified over the passes of a pixel: place in the pixel, then the first
 * vertices' lights and lobes. */
enum { STRATIFIED_SETS = 4 };

ppmi_camera_ray ppmi_start_camera_path(const ppmi_job *job, ppmi_walker *walker, uint32_t x,
                                       uint32_t y, uint64_t pass)
{
    /* numbers belong to the pixel of the whole picture: a crop shows what the whole would */
    x += job->film.x0;
    y += job->film.y0;
    const uint64_t pixel = (uint64_t)y * job->options->width + x;
    const uint64_t pixel_count = (uint64_t)job->options->width * job->options->height;
    const uint64_t seed = ppmi_hash64(job->options->seed) ^ ppmi_hash64(~pixel);
    ppmi_walker_start(
        walker, ppmi_rng_start(job->options->seed, PPMI_STREAM_EYE, pass * pixel_count + pixel),
        seed, (uint32_t)pass, 0, STRATIFIED_SETS);
    const float dx = ppmi_walker_float(walker), dy = ppmi_walker_float(walker);
    return ppmi_camera_view_ray(&job->view, (float)x + dx, (float)y + dy);
}
