/* What paths travel through, and the steps that eye paths and photons share. */
#ifndef PPMI_TRANSPORT_WORLD_H
#define PPMI_TRANSPORT_WORLD_H

#include "accel/accel.h"
#include "light/lights.h"
#include "math/sampler.h"
#include "shading/bsdf.h"

/* Everything is const while paths are traced. */
typedef struct ppmi_world {
    const ppm_scene *scene;
    const ppmi_accel *accel;
    const ppmi_lights *lights;
    const ppmi_albedo_table *albedo;
    bool has_alpha; /* some material lets rays pass */
} ppmi_world;

/* What one path changes.
 *
 * Its numbers come first from sets of stratified dimensions, so that the paths of one pixel, or the
 * photons of one light, spread evenly over their first decisions, then from the independent
 * stream. */
typedef struct ppmi_walker {
    const ppmi_world *world;
    uint64_t rays; /* traced */
    ppmi_rng rng;
    uint64_t stratified_seed;
    uint32_t stratified_index;
    uint32_t set, set_end; /* next set of four dimensions, and where they end */
    uint32_t used;         /* of the current set */
    ppmi_sample4 sample;
} ppmi_walker;

/* Starts a path: index counts paths of the stream, stratified_index those that stratify each other
 * under stratified_seed; sets first_set .. set_end - 1 are used. */
static inline void ppmi_walker_start(ppmi_walker *walker, ppmi_rng rng, uint64_t stratified_seed,
                                     uint32_t stratified_index, uint32_t first_set,
                                     uint32_t set_end)
{
    walker->rng = rng;
    walker->stratified_seed = stratified_seed;
    walker->stratified_index = stratified_index;
    walker->set = first_set;
    walker->set_end = set_end;
    walker->used = 4;
}

static inline uint32_t ppmi_walker_u32(ppmi_walker *walker)
{
    if (walker->used < 4) return walker->sample.bits[walker->used++];
    if (walker->set == walker->set_end) return ppmi_rng_u32(&walker->rng);
    walker->sample = ppmi_sobol4(walker->stratified_index, walker->set++, walker->stratified_seed);
    walker->used = 1;
    return walker->sample.bits[0];
}

static inline float ppmi_walker_float(ppmi_walker *walker)
{
    return ppmi_unit_float(ppmi_walker_u32(walker));
}

/* For choices among many. */
static inline double ppmi_walker_double(ppmi_walker *walker)
{
    return (double)ppmi_walker_u32(walker) * 0x1p-32;
}

/* A vertex of a path. */
typedef struct ppmi_vertex {
    ppmi_hit hit;
    ppmi_surface surface;
    float distance;          /* from the ray's origin, along all segments through alpha */
    ppmi_vec3 transmittance; /* of the solid that the ray went through */
} ppmi_vertex;

/* Whether the ray comes straight from the camera: it then sees through the back of single-sided
 * surfaces. Everything else meets both sides, so that light does not leak through walls. */
typedef enum ppmi_ray_kind { PPMI_RAY_CAMERA, PPMI_RAY_OTHER } ppmi_ray_kind;

/* Follows a ray (unit direction) to the next surface. Surfaces with alpha stop it with their
 * opacity as probability. False when it leaves the scene. */
bool ppmi_walk_to_surface(ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind,
                          ppmi_vertex *out_vertex);

/* Share of light that passes along a ray (unit direction) up to t_max: 0 behind anything opaque,
 * the product of 1 - opacity through alpha. */
float ppmi_walk_visibility(ppmi_walker *walker, ppmi_ray ray);

/* Radiance towards wo from one light sample at a surface, all lobes that are not delta, weighed by
 * MIS against sampling the BSDF. */
ppmi_vec3 ppmi_walk_light_sample(ppmi_walker *walker, const ppmi_surface *surface,
                                 const ppmi_bsdf *bsdf);

/* Makes the BSDF of a vertex for a ray that came along direction. */
void ppmi_walk_bsdf(const ppmi_walker *walker, const ppmi_vertex *vertex, ppmi_vec3 direction,
                    ppmi_bsdf *out_bsdf);

/* Where a path comes from, for the MIS weight of emission that it meets. */
typedef struct ppmi_origin {
    float pdf;        /* by solid angle of its direction; irrelevant if is_delta */
    ppmi_vec3 normal; /* shading normal there */
    bool is_delta;    /* camera, mirror or smooth glass: light sampling cannot do it */
} ppmi_origin;

/* Emission of a vertex towards where the ray (unit direction) came from, weighed by MIS. */
ppmi_vec3 ppmi_walk_emission(const ppmi_walker *walker, const ppmi_vertex *vertex,
                             ppmi_vec3 direction, const ppmi_origin *origin);

/* Radiance of the environment for a ray that left the scene, weighed by MIS. */
ppmi_vec3 ppmi_walk_environment(const ppmi_walker *walker, ppmi_vec3 direction,
                                const ppmi_origin *origin);

#endif
