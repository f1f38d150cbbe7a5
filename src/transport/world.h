/* What paths travel through, and the steps that eye paths and photons share. */
#ifndef PPMI_TRANSPORT_WORLD_H
#define PPMI_TRANSPORT_WORLD_H

#include "accel/accel.h"
#include "light/lights.h"
#include "math/sampler.h"
#include "shading/bsdf.h"
#include "shading/footprint.h"
#include "shading/spectrum.h"
#include "transport/columns.h"
#include "transport/contact.h"
#include "transport/interior.h"

/* Everything is const while paths are traced. */
typedef struct ppmi_world {
    const ppm_scene *scene;
    const ppmi_accel *accel;
    const ppmi_lights *lights;
    const ppmi_albedo_table *albedo;
    const ppmi_spectrum *spectrum;
    const ppmi_contacts *contacts;
    bool has_alpha;        /* some material lets rays pass */
    bool has_sheets;       /* some material lets light straight through */
    bool has_single_sided; /* some material's back is not seen by the camera */
    bool has_textures;     /* some image has mipmaps: footprints matter */
    bool has_lamps;        /* some light has an extent and no surface */
    bool has_fog;
    bool has_scattering;  /* some medium scatters */
    ppmi_vec3 fog_center; /* the ball that the fog fills */
    float fog_radius;
    ppmi_columns columns; /* where photons may begin in solids */
} ppmi_world;

/* Fills in a world over parts that must outlive it; the scene is frozen. */
void ppmi_world_init(ppmi_world *world, const ppm_scene *scene, const ppmi_accel *accel,
                     const ppmi_lights *lights, const ppmi_albedo_table *albedo,
                     const ppmi_spectrum *spectrum, const ppmi_contacts *contacts);

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

    ppmi_interior interior;           /* where the path is now */
    float wavelength_nm;              /* of a path that dispersion has split; 0: all of them */
    float time;                       /* within the shutter, 0 .. 1 */
    const struct ppmi_origin *origin; /* of the next segments of an eye path, which then sees lights
                                         with an extent on the way; NULL: photons and probes */
    const struct ppmi_lamp_witness *lamp_witness; /* is told of them one by one; or NULL */
    ppmi_differential differential;               /* of the path's last ray; unknown for photons */
    bool rounds_opacity; /* alpha stops the path from one half on, not by chance */
} ppmi_walker;

/* Starts a path, outside of all solids: index counts paths of the stream, stratified_index those
 * that stratify each other under stratified_seed; sets first_set .. set_end - 1 are used. */
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
    walker->interior.count = 0;
    walker->wavelength_nm = 0.0f;
    walker->time = 0.0f;
    walker->differential.is_known = false;
    walker->origin = NULL;
    walker->rounds_opacity = false;
    walker->lamp_witness = NULL;
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

/* A vertex of a path: on a surface, or in a medium. There only surface.position is set, the error
 * bound and normals are 0. */
typedef struct ppmi_vertex {
    ppmi_hit hit;
    ppmi_surface surface;
    const ppmi_medium *medium; /* that scattered the path here; NULL at a surface */
    float distance;            /* from the ray's origin, along all segments through alpha */
    ppmi_vec3 transmittance;   /* of the media on the way, over the probability of coming this far
                                  where they scatter */
    ppmi_vec3 lamplight;       /* of lights with an extent that were met on the way, by an eye path;
                                  weighed by MIS, transmittance included */

    /* at solids */
    float relative_index;   /* beyond the surface by this side, at the path's wavelength */
    ppmi_interior behind;   /* what a path is in that goes through */
    float drawn_wavelength; /* if it goes through and had none; else 0 */
    bool splits_always;     /* colours part in reflection too: near total reflection */
} ppmi_vertex;

/* Whoever wants to know each lamp that adds to vertex.lamplight: light is its part. */
typedef struct ppmi_lamp_witness {
    void (*see)(const struct ppmi_lamp_witness *witness, uint32_t emitter, ppmi_vec3 light);
} ppmi_lamp_witness;

/* Whether the ray comes straight from the camera: it then sees through the back of single-sided
 * surfaces. Everything else meets both sides, so that light does not leak through walls. */
typedef enum ppmi_ray_kind { PPMI_RAY_CAMERA, PPMI_RAY_OTHER } ppmi_ray_kind;

typedef enum ppmi_arrival { PPMI_AT_SURFACE, PPMI_IN_MEDIUM, PPMI_ESCAPED } ppmi_arrival;

/* Follows a ray (unit direction) to where something happens to it: a surface, a scattering in a
 * medium, or out of the scene. Surfaces with alpha stop it with their opacity as probability;
 * surfaces inside of solids that count for more are passed. out_vertex->transmittance and distance
 * are set in all cases. */
ppmi_arrival ppmi_walk(ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind,
                       ppmi_vertex *out_vertex);

/* The same for a path that goes both ways at media: it always arrives, with the media's
 * transmittance as weight, and out_scattered gets count vertices drawn from the media on the way,
 * spread over it, that share the weight (medium NULL where there is none). With a count of 0 it
 * just arrives. */
enum { PPMI_MAX_SCATTERED = 8 };
ppmi_arrival ppmi_walk_both_ways(ppmi_walker *walker, ppmi_ray ray, ppmi_ray_kind kind,
                                 ppmi_vertex *out_vertex, ppmi_vertex *out_scattered,
                                 uint32_t count);

/* Light that passes along a ray (unit direction) up to t_max, from within interior: 0 behind
 * anything opaque, else the product of 1 - opacity through alpha, of what thin sheets let straight
 * through, and of the media's transmittance. */
ppmi_vec3 ppmi_walk_visibility(ppmi_walker *walker, ppmi_ray ray, const ppmi_interior *interior);

/* A vertex as light sampling knows it. */
static inline ppmi_receiver ppmi_walk_receiver(const ppmi_vertex *vertex, const ppmi_bsdf *bsdf)
{
    return (ppmi_receiver){.position = vertex->surface.position,
                           .normal = ppmi_bsdf_normal(bsdf),
                           .is_open = (bsdf->lobes & (PPMI_LOBE_GLASS | PPMI_LOBE_THROUGH)) != 0};
}

/* Where the light of a light sample came from: radiance towards wo is light.radiance * weight. */
typedef struct ppmi_lit {
    ppmi_light_sample light;
    ppmi_vec3 weight;
} ppmi_lit;

/* The light samples of a vertex, one by one: begin with zeros and go on while has_another. */
typedef struct ppmi_light_turn {
    bool has_another;
    double u_pick; /* of the first */
} ppmi_light_turn;

/* Radiance towards wo from one light sample at a vertex, all lobes that are not delta, weighed by
 * MIS against sampling the BSDF. out_lit is set where it is not black; it may be NULL. */
ppmi_vec3 ppmi_walk_light_sample_of(ppmi_walker *walker, const ppmi_vertex *vertex,
                                    const ppmi_bsdf *bsdf, ppmi_light_turn *turn,
                                    ppmi_lit *out_lit);

/* Of all of them. */
static inline ppmi_vec3 ppmi_walk_light_sample(ppmi_walker *walker, const ppmi_vertex *vertex,
                                               const ppmi_bsdf *bsdf)
{
    ppmi_light_turn turn = {0};
    ppmi_vec3 sum = {0.0f, 0.0f, 0.0f};
    do {
        sum = vec3_add(sum, ppmi_walk_light_sample_of(walker, vertex, bsdf, &turn, NULL));
    } while (turn.has_another);
    return sum;
}

/* Share of a light sample's light that arrives at a vertex. */
ppmi_vec3 ppmi_walk_light_visibility(ppmi_walker *walker, const ppmi_vertex *vertex,
                                     const ppmi_bsdf *bsdf, const ppmi_light_sample *light);

/* Makes the BSDF of a vertex for a ray that came along direction; in a medium its phase function.
 */
void ppmi_walk_bsdf(const ppmi_walker *walker, const ppmi_vertex *vertex, ppmi_vec3 direction,
                    ppmi_bsdf *out_bsdf);

/* Makes the BSDF of a surface vertex anew for another direction wo (unit, away from it), on any
 * side; bsdf: the vertex's. */
void ppmi_walk_bsdf_from(const ppmi_walker *walker, const ppmi_vertex *vertex,
                         const ppmi_bsdf *bsdf, ppmi_vec3 wo, ppmi_bsdf *out_bsdf);

/* Leaves a vertex in a sampled direction: into the solid or out of it, with one wavelength from
 * dispersion on. Multiplies *throughput by what the latter costs, not by the sample's weight. */
ppmi_ray ppmi_walk_leave(ppmi_walker *walker, const ppmi_vertex *vertex,
                         const ppmi_bsdf_sample *sample, ppmi_vec3 *throughput);

/* Where a path comes from, for the MIS weight of emission that it meets: its last vertex that is
 * not passed straight through a thin sheet, since light sampling there looks through sheets too. */
typedef struct ppmi_origin {
    ppmi_receiver receiver; /* what light sampling there chooses by; irrelevant if is_delta */
    float pdf;              /* by solid angle of its direction; irrelevant if is_delta */
    bool is_delta;          /* camera, mirror or smooth glass: light sampling cannot do it */
    float distance;         /* of the last sheet that was passed, from the origin */
    float merging;          /* where photons bring the same light to an earlier vertex: how likely
                               they are to, for a crowding of 1, by how likely this path is; else 0 */
} ppmi_origin;

/* The origin beyond a vertex where the path goes straight through a thin sheet. */
static inline ppmi_origin ppmi_origin_beyond(const ppmi_origin *origin, const ppmi_vertex *sheet)
{
    ppmi_origin beyond = *origin;
    beyond.distance += sheet->distance;
    return beyond;
}

/* Emission of a surface vertex towards where the ray (unit direction) came from, weighed by MIS. */
ppmi_vec3 ppmi_walk_emission(const ppmi_walker *walker, const ppmi_vertex *vertex,
                             ppmi_vec3 direction, const ppmi_origin *origin);

/* Radiance of the environment for a ray that left the scene, weighed by MIS. */
ppmi_vec3 ppmi_walk_environment_weighed(const ppmi_walker *walker, ppmi_vec3 direction,
                                        const ppmi_origin *origin, float *out_weight);

static inline ppmi_vec3 ppmi_walk_environment(const ppmi_walker *walker, ppmi_vec3 direction,
                                              const ppmi_origin *origin)
{
    float weight;
    return ppmi_walk_environment_weighed(walker, direction, origin, &weight);
}

#endif
