/* What the photon mapping integrators share: photon passes, and first radii that need no tuning. */
#ifndef PPMI_RENDER_PHOTON_PASS_H
#define PPMI_RENDER_PHOTON_PASS_H

#include "photon/eye.h"
#include "photon/map.h"
#include "photon/statistics.h"
#include "render/light_film.h"

/* Zero it to begin with. */
typedef struct ppmi_photon_pass {
    ppmi_photon_map map; /* of the latest pass */
    ppmi_photon_guide *guide;
    bool has_guide;     /* it has been learnt */
    uint64_t per_pass;  /* photons to emit */
    float time;         /* of the eye paths that they are for, where passes have one time */
    float first_radius; /* typical small one, metres */
    float largest_radius;
} ppmi_photon_pass;

/* Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_photon_pass_init(const ppmi_job *job, ppmi_photon_pass *photons);
void ppmi_photon_pass_deinit(const ppmi_job *job, ppmi_photon_pass *photons);

/* Traces the photons of a pass into the map. radius_share: about how far radii have shrunk since
 * the first. Adds to stats. Returns OK, CANCELLED, OUT_OF_MEMORY. */
ppm_status ppmi_photon_pass_run(const ppmi_job *job, ppmi_photon_pass *photons, uint64_t pass,
                                float radius_share, ppm_render_stats *stats);

/* ---- the pilot: photons that are not used for the picture ------------------------------------ */

/* Passes with the pilot's photons. The first one learns where photons are worth sending, by those
 * that ppmi_photon_pass_see marks; the second one, aimed as the passes to come, chooses first
 * radii, by ppmi_photon_pass_grow. Either is left out where the options make it needless. */
bool ppmi_photon_pass_wants_guide(const ppmi_job *job, const ppmi_photon_pass *photons);
ppm_status ppmi_photon_pass_begin_guide(const ppmi_job *job, ppmi_photon_pass *photons,
                                        ppm_render_stats *stats);
void ppmi_photon_pass_see(const ppmi_job *job, const ppmi_photon_pass *photons,
                          const ppmi_visible_point *point);
/* With a guide fewer photons do as much: where nobody said how many, sppm goes on with as many as
 * keep the number that was kept without. */
ppm_status ppmi_photon_pass_end_guide(const ppmi_job *job, ppmi_photon_pass *photons);

bool ppmi_photon_pass_wants_radii(const ppmi_job *job);
ppm_status ppmi_photon_pass_begin_radii(const ppmi_job *job, ppmi_photon_pass *photons,
                                        ppm_render_stats *stats);

/* Grows a first radius until the pilot's photons suffice. Choosing the radius by the photons that
 * it then gathers would bias the picture. */
void ppmi_photon_pass_grow(const ppmi_job *job, const ppmi_photon_pass *photons,
                           const ppmi_visible_point *point, float *scale);

/* ---- radii ----------------------------------------------------------------------------------- */

/* The scale that statistics begin with. */
float ppmi_photon_pass_first_scale(const ppmi_job *job);

/* Side of the footprint that the radius at a visible point counts in, metres. */
static inline float ppmi_photon_pass_unit(const ppmi_job *job, const ppmi_photon_pass *photons,
                                          const ppmi_visible_point *point, float scale)
{
    if (job->options->radius_m > 0.0f) return job->options->radius_m;
    return ppmi_min(point->footprint, photons->largest_radius / scale);
}

/* What a pixel's visible points gather in a pass for its layers. */
typedef struct ppmi_pixel_layers {
    const ppmi_light_film *film;
    ppmi_light_pass pass; /* with what needs no photons to begin with */
    ppmi_vec3 *planes;    /* of pass */
    ppmi_vec3 *gathered;  /* planes of photons that are not kept yet; black to begin with */
    ppmi_vec3 gathered_light;
    float radius_sum_m;
    uint32_t point_count, surface_count;
} ppmi_pixel_layers;

/* Adds what has been gathered to the pass, unless the picture leaves it out: is_kept. */
void ppmi_pixel_layers_keep(ppmi_pixel_layers *layers, bool is_kept);

/* The pass, when all is gathered. */
const ppmi_light_pass *ppmi_pixel_layers_finish(ppmi_pixel_layers *layers);

/* ppmi_photon_pass_gather with layers. */
ppmi_gathered ppmi_photon_pass_gather_layers(const ppmi_job *job, const ppmi_photon_pass *photons,
                                             const ppmi_visible_point *point, float radius,
                                             ppmi_pixel_layers *layers);

/* Photons found around a point within scale times unit; flux includes the throughput. layers may be
 * NULL. */
static inline ppmi_gathered ppmi_photon_pass_gather(const ppmi_job *job,
                                                    const ppmi_photon_pass *photons,
                                                    const ppmi_visible_point *point, float scale,
                                                    float unit, ppmi_pixel_layers *layers)
{
    if (layers) return ppmi_photon_pass_gather_layers(job, photons, point, scale * unit, layers);
    ppmi_gathered gathered =
        ppmi_photon_map_gather(&photons->map, job->world.albedo, point, scale * unit);
    gathered.flux = vec3_mul(gathered.flux, point->throughput);
    return gathered;
}

/* What the eye paths of the job's options do; photons->per_pass is set. */
ppmi_eye_settings ppmi_eye_settings_of(const ppmi_job *job, const ppmi_photon_pass *photons);

#endif
