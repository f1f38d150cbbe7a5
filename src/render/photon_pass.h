/* What the photon mapping integrators share: photon passes, and first radii that need no tuning. */
#ifndef PPMI_RENDER_PHOTON_PASS_H
#define PPMI_RENDER_PHOTON_PASS_H

#include "photon/eye.h"
#include "photon/map.h"
#include "photon/statistics.h"
#include "render/integrator.h"

/* The pilot's paths: a pass number that no pass reaches. */
#define PPMI_PILOT_PASS (UINT64_MAX >> 24)

/* Zero it to begin with. */
typedef struct ppmi_photon_pass {
    ppmi_photon_map map; /* of the latest pass */
    float first_radius;  /* typical small one, metres */
    float largest_radius;
} ppmi_photon_pass;

void ppmi_photon_pass_init(const ppmi_job *job, ppmi_photon_pass *photons);
void ppmi_photon_pass_deinit(const ppmi_job *job, ppmi_photon_pass *photons);

/* Traces the photons of a pass into the map. radius_share: about how far radii have shrunk since
 * the first. Adds to stats. Returns OK, CANCELLED, OUT_OF_MEMORY. */
ppm_status ppmi_photon_pass_run(const ppmi_job *job, ppmi_photon_pass *photons, uint64_t pass,
                                float radius_share, ppm_render_stats *stats);

/* The same for the pilot, whose photons choose first radii and are not used for the picture. */
ppm_status ppmi_photon_pass_run_pilot(const ppmi_job *job, ppmi_photon_pass *photons,
                                      ppm_render_stats *stats);

/* The scale that statistics begin with. */
float ppmi_photon_pass_first_scale(const ppmi_job *job);

/* Side of the footprint that the radius at a visible point counts in, metres. */
static inline float ppmi_photon_pass_unit(const ppmi_job *job, const ppmi_photon_pass *photons,
                                          const ppmi_visible_point *point, float scale)
{
    if (job->options->radius_m > 0.0f) return job->options->radius_m;
    return ppmi_min(point->footprint, photons->largest_radius / scale);
}

/* Grows a first radius until the pilot's photons suffice. The pilot's photons are not used for the
 * picture: choosing the radius by the photons that it then gathers would bias it. */
void ppmi_photon_pass_grow(const ppmi_job *job, const ppmi_photon_pass *photons,
                           const ppmi_visible_point *point, float *scale);

/* Photons found around a point within scale times unit; flux includes the throughput. */
static inline ppmi_gathered ppmi_photon_pass_gather(const ppmi_job *job,
                                                    const ppmi_photon_pass *photons,
                                                    const ppmi_visible_point *point, float scale,
                                                    float unit)
{
    ppmi_gathered gathered =
        ppmi_photon_map_gather(&photons->map, job->world.albedo, point, scale * unit);
    gathered.flux = vec3_mul(gathered.flux, point->throughput);
    return gathered;
}

/* What the eye paths of the job's options do. */
ppmi_eye_settings ppmi_eye_settings_of(const ppmi_job *job);

#endif
