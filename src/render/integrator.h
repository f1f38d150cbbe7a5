/* What an integrator is to a render session: passes into a picture. */
#ifndef PPMI_RENDER_INTEGRATOR_H
#define PPMI_RENDER_INTEGRATOR_H

#include <stdatomic.h>

#include "camera/camera.h"
#include "camera/filter.h"
#include "light/light_groups.h"
#include "ppm/render.h"
#include "transport/world.h"

/* The pixels that are rendered: a window of the whole picture. Inside the integrators x and y count
 * from the window's corner. */
typedef struct ppmi_film {
    uint32_t x0, y0; /* in the whole picture */
    uint32_t width, height;
} ppmi_film;

static inline size_t ppmi_film_pixel_count(const ppmi_film *film)
{
    return (size_t)film->width * film->height;
}

/* What a pass reads. Const while it runs, but for cancel. */
typedef struct ppmi_job {
    ppm_context *context;
    const ppm_render_options *options; /* resolved */
    bool photons_are_free;             /* nobody said how many photons a pass has */
    ppmi_world world;
    ppmi_camera_view view; /* of the whole picture */
    ppmi_pixel_filter filter;
    ppmi_film film;
    ppmi_interior around_camera;     /* solids that it stands in, */
    bool around_camera_changes;      /* or that have to be looked for at each path's time */
    bool pass_has_one_time;          /* see ppmi_time_of_pass */
    const ppmi_light_groups *groups; /* NULL: no layer asks for them */
    const atomic_bool *cancel;
} ppmi_job;

/* Asked before each path: one may take long, where thousands of surfaces lie in one place. */
static inline bool ppmi_job_is_cancelled(const ppmi_job *job)
{
    return atomic_load_explicit(job->cancel, memory_order_relaxed);
}

/* One way of computing pictures. state is the integrator's own. */
typedef struct ppmi_integrator {
    const char *name;
    ppm_status (*create)(const ppmi_job *job, void **out_state);
    void (*destroy)(const ppmi_job *job, void *state);
    /* Renders pass number pass (from 0) and adds to stats; state is as before if it fails or is
     * cancelled. */
    ppm_status (*pass)(const ppmi_job *job, void *state, uint64_t pass, ppm_render_stats *stats);
    /* The film's picture after passes finished passes: RGBA, row 0 on top. */
    void (*resolve)(const ppmi_job *job, const void *state, uint64_t passes, float *rgba);
    /* One of the layers that are the integrator's own (PPM_LAYER_DIFFUSE_DIRECT .. RADIUS,
     * LIGHT_VARIANCE and FIRST_PASSES), number counts groups or classes; values as in
     * ppm_render_read_layer. */
    void (*read_layer)(const ppmi_job *job, const void *state, int32_t kind, uint32_t number,
                       uint64_t passes, float *values);
} ppmi_integrator;

extern const ppmi_integrator ppmi_integrator_sppm;
extern const ppmi_integrator ppmi_integrator_ppm;
extern const ppmi_integrator ppmi_integrator_path;

/* A layer for the denoiser alone, kept with DENOISED: DIFFUSE_DIRECT as it was after the first
 * ppmi_light_first_passes of the passes. */
enum { PPMI_LAYER_FIRST_PASSES = PPM_LAYER_KINDS };

/* The pilot's paths: a pass number that no pass reaches. */
#define PPMI_PILOT_PASS (UINT64_MAX >> 24)

/* Images are worked on in tiles of this side, which threads take one by one. */
enum { PPMI_TILE = 16, PPMI_TILE_PIXELS = PPMI_TILE * PPMI_TILE };

typedef struct ppmi_tile {
    uint32_t x0, y0, x1, y1; /* pixels, the upper bounds excluded */
} ppmi_tile;

static inline uint32_t ppmi_tile_count(const ppmi_film *film)
{
    return ((film->width + PPMI_TILE - 1) / PPMI_TILE) *
           ((film->height + PPMI_TILE - 1) / PPMI_TILE);
}

static inline ppmi_tile ppmi_tile_at(const ppmi_film *film, uint32_t index)
{
    const uint32_t columns = (film->width + PPMI_TILE - 1) / PPMI_TILE;
    const uint32_t x0 = index % columns * PPMI_TILE, y0 = index / columns * PPMI_TILE;
    const uint32_t x1 = x0 + PPMI_TILE, y1 = y0 + PPMI_TILE;
    return (ppmi_tile){x0, y0, x1 < film->width ? x1 : film->width,
                       y1 < film->height ? y1 : film->height};
}

static inline bool ppmi_shutter_is_open(const ppmi_job *job)
{
    return job->options->shutter_close > job->options->shutter_open;
}

/* Photons light eye paths of their own time only: where surfaces move, all photons and eye paths of
 * a photon mapper's pass have one time, and passes spread evenly over the shutter, whatever their
 * number. (Photons that carry times and are gathered across them are blurred where a moving surface
 * gathers them: Cammarano and Jensen 2002, "Time Dependent Photon Mapping".) */
float ppmi_time_of_pass(const ppmi_job *job, uint64_t pass);

/* Starts the camera path of a pixel in a pass: the walker's numbers and a ray through a point that
 * is drawn from the pixel's filter, a point of the lens, and a time within the shutter. The paths
 * of one pixel stratify each other over the passes. */
ppmi_camera_ray ppmi_start_camera_path(const ppmi_job *job, ppmi_walker *walker, uint32_t x,
                                       uint32_t y, uint64_t pass);

/* What is in the middle of the whole picture: distance along the camera's axis to the first surface
 * that the camera sees there, at least half opaque. False when there is none. view is that of the
 * pinhole. */
bool ppmi_distance_in_the_middle(const ppmi_world *world, const ppmi_camera_view *view,
                                 float *out_distance_m);

#endif
