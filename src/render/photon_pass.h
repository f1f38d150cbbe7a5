/* What the photon mapping integrators share: photon passes, and first radii that need no tuning. */
#ifndef PPMI_RENDER_PHOTON_PASS_H
#define PPMI_RENDER_PHOTON_PASS_H

#include "photon/eye.h"
#include "photon/map.h"
#include "photon/statistics.h"
#include "render/light_film.h"
#include "render/photon_aim.h"

/* Zero it to begin with. */
typedef struct ppmi_photon_pass {
    ppmi_photon_map map; /* of the latest pass */
    ppmi_photon_aim aim;
    uint64_t per_pass;  /* photons to emit */
    uint64_t in_map;    /* photons that were emitted for it */
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

/* Where photons are aimed this is learnt in rounds: photons are traced, the points of the round's
 * pixels see them, and the round ends. */
bool ppmi_photon_pass_wants_round(const ppmi_job *job, const ppmi_photon_pass *photons);
ppm_status ppmi_photon_pass_begin_round(const ppmi_job *job, ppmi_photon_pass *photons,
                                        ppm_render_stats *stats);
/* Whether a pixel is one of the round's: some 16,000, others in each round. */
bool ppmi_photon_pass_looks_from(const ppmi_job *job, const ppmi_photon_pass *photons,
                                 size_t pixel);
/* count points of one pixel, which has light besides. Any thread. */
void ppmi_photon_pass_see(const ppmi_job *job, const ppmi_photon_pass *photons,
                          const ppmi_visible_point *points, size_t count, ppmi_plain_disk *plain,
                          ppmi_vec3 light);
/* Aimed photons meet more: where nobody said how many, sppm goes on with as many as take the time
 * that even ones take. */
ppm_status ppmi_photon_pass_end_round(const ppmi_job *job, ppmi_photon_pass *photons);

/* What has been learnt goes into stats. */
void ppmi_photon_pass_add_use(const ppmi_photon_pass *photons, ppm_render_stats *stats);

/* Then photons that are aimed as those of the passes to come choose first radii, by
 * ppmi_photon_pass_grow; where the options do not give one. */
bool ppmi_photon_pass_wants_radii(const ppmi_job *job);
ppm_status ppmi_photon_pass_begin_radii(const ppmi_job *job, ppmi_photon_pass *photons,
                                        ppm_render_stats *stats);

/* Grows a first radius until the pilot's photons suffice. Choosing the radius by the photons that
 * it then gathers would bias the picture. */
void ppmi_photon_pass_grow(const ppmi_job *job, const ppmi_photon_pass *photons,
                           const ppmi_visible_point *point, ppmi_plain_disk *known, float *scale);

/* What is known of the surface around is kept for the first point of a pixel of which this is true
 * (ppmi_region_find); nothing of other points, and NULL does for it. */
static inline bool ppmi_photon_pass_keeps_plain(const ppmi_visible_point *point)
{
    return ppmi_dimension_of(point) == PPMI_DISK && !(point->merge_area_m2 > 0.0f);
}

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
                                             ppmi_plain_disk *known, ppmi_pixel_layers *layers);

/* Photons found around a point within scale times unit; flux includes the throughput. known: what
 * is known of the surface around the pixel's or point's place (ppmi_region_find), or NULL; layers
 * may be NULL. */
static inline ppmi_gathered ppmi_photon_pass_gather(const ppmi_job *job,
                                                    const ppmi_photon_pass *photons,
                                                    const ppmi_visible_point *point, float scale,
                                                    float unit, ppmi_plain_disk *known,
                                                    ppmi_pixel_layers *layers)
{
    const float radius = scale * unit;
    if (job->pass_has_one_time) known = NULL; /* things move from pass to pass */
    if (layers) return ppmi_photon_pass_gather_layers(job, photons, point, radius, known, layers);
    ppmi_gathered gathered =
        ppmi_photon_map_gather(&photons->map, job->world.albedo, point, radius, known);
    gathered.flux = vec3_mul(gathered.flux, point->throughput);
    return gathered;
}

/* What the eye paths of the job's options do; photons->per_pass is set. */
ppmi_eye_settings ppmi_eye_settings_of(const ppmi_job *job, const ppmi_photon_pass *photons);

#endif
