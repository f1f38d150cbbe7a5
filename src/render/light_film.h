/* The layers that an integrator keeps itself: planes of light by class and by group, variance,
 * density of photons, radius, and how far the picture is transparent.
 *
 * All integrators' pictures are means over their passes, so each layer is a mean of what passes
 * add. Of the progressive estimate that is so because radius and tau shrink alike
 * (photon/statistics.h: tau' / A' = tau / A + tauM / A, with A the disk's area before the pass):
 * what a pass's photons bring, by the area in which they were looked for, adds up to tau / A.
 * Layers need no tau of their own, and N / A is the sum of M / A. */
#ifndef PPMI_RENDER_LIGHT_FILM_H
#define PPMI_RENDER_LIGHT_FILM_H

#include "render/integrator.h"
#include "transport/light_layers.h"

/* Where a pixel's values are, in floats; SIZE_MAX: is not kept. */
typedef struct ppmi_light_record {
    size_t planes, combined, variance, class_variance, first_passes, density, radius, seen_through,
        catcher;
    size_t size;
} ppmi_light_record;

typedef struct ppmi_light_film {
    ppmi_light_planes planes;
    ppmi_light_record record;
    float *now, *next; /* a record a pixel; a pass reads the first and writes the second */
    ppmi_vec3 *scratch;
    size_t scratch_planes; /* of a thread */
} ppmi_light_film;

/* What a pass adds to a pixel. */
typedef struct ppmi_light_pass {
    const ppmi_vec3 *planes;
    ppmi_vec3 combined;
    ppmi_light_seen seen;   /* by the pixel's path */
    float photons_per_area; /* 1/m2 */
    float radius_m;         /* 0: it had no visible point */
} ppmi_light_pass;

/* scratch_sets: of planes that a thread needs. Where the options ask for nothing, nothing is
 * kept. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_light_film_init(const ppmi_job *job, size_t scratch_sets, ppmi_light_film *film);
void ppmi_light_film_deinit(const ppmi_job *job, ppmi_light_film *film);

static inline bool ppmi_light_film_is_kept(const ppmi_light_film *film)
{
    return film->record.size > 0;
}

/* Whether any of the planes of light is kept. */
static inline bool ppmi_light_film_has_planes(const ppmi_light_film *film)
{
    return film->planes.count > 0;
}

/* The calling thread's sets of planes, all black. */
ppmi_vec3 *ppmi_light_film_clear_scratch(const ppmi_light_film *film);

/* Planes of one of the scratch's sets. */
static inline ppmi_vec3 *ppmi_light_film_set(const ppmi_light_film *film, ppmi_vec3 *scratch,
                                             size_t set)
{
    return scratch + set * film->planes.count;
}

/* A sink into planes of a pixel. */
ppmi_light_sink ppmi_light_film_sink(const ppmi_light_film *film, ppmi_vec3 *planes,
                                     ppmi_light_seen *seen);

/* Adds pass number pass (from 0) to a pixel. Each pixel once a pass, by any thread; committed when
 * the pass is finished. */
void ppmi_light_film_add(ppmi_light_film *film, size_t pixel, uint64_t pass,
                         const ppmi_light_pass *light);
void ppmi_light_film_commit(ppmi_light_film *film);

/* Coverage of a pixel after passes finished passes. */
float ppmi_light_film_alpha(const ppmi_light_film *film, size_t pixel, uint64_t passes);

/* As ppmi_integrator.read_layer. */
void ppmi_light_film_read(const ppmi_job *job, const ppmi_light_film *film, int32_t kind,
                          uint32_t number, uint64_t passes, float *values);

/* The number of passes that PPMI_LAYER_FIRST_PASSES is of: the largest power of two below passes,
 * which are at least two. */
uint64_t ppmi_light_first_passes(uint64_t passes);

#endif
