/* Everything that shines: choice by power, light sampling at surfaces, emission of photons. */
#ifndef PPMI_LIGHT_LIGHTS_H
#define PPMI_LIGHT_LIGHTS_H

#include "light/environment.h"
#include "math/alias.h"
#include "shading/surface.h"

typedef struct ppmi_lights ppmi_lights;

/* Tables over a frozen scene, which must outlive them. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_lights_create(ppm_context *context, const ppm_scene *scene,
                              ppmi_lights **out_lights);
void ppmi_lights_destroy(ppmi_lights *lights);

/* Number of emitters: punctual lights, emissive triangles, 1 for an environment. */
uint64_t ppmi_lights_count(const ppmi_lights *lights);

/* Whose light an emitter's is: 0 .. of the scene's lamps, then of its instances, then of the
 * environment. */
size_t ppmi_lights_source(const ppmi_lights *lights, uint32_t emitter);

/* Who asks for light: what lights are chosen by. */
typedef struct ppmi_receiver {
    ppmi_vec3 position;
    ppmi_vec3 normal; /* shading normal on the side that receives; 0 in a medium, where light counts
                         from every side */
    bool is_open;     /* a surface that light gets through: it counts from behind too */
} ppmi_receiver;

static inline bool ppmi_receiver_is_surface(const ppmi_receiver *receiver)
{
    return vec3_length2(receiver->normal) > 0.0f;
}

/* Light that arrives at a point from one sampled emitter, before visibility. */
typedef struct ppmi_light_sample {
    ppmi_vec3 wi;       /* towards the light, unit */
    ppmi_vec3 target;   /* point on the light, moved off its surface by the error bound; not set for
                           far lights */
    bool is_far;        /* directional light, sun or environment */
    ppmi_vec3 radiance; /* for delta lights: irradiance on a plane that faces them */
    float pdf;          /* by solid angle, choice included; of the choice alone for delta lights */
    bool has_another;   /* set in all cases: u_pick + 1 gives another one */
    bool is_delta;
    uint32_t emitter; /* that it comes from; not of far light that is not delta: see
                         ppmi_lights_far_part */
} ppmi_light_sample;

/* Samples one light for a receiver. time is within the shutter. False when nothing arrives.
 *
 * A place has one light sample, with u_pick in [0, 1), and now and then a second one, with
 * u_pick + 1: samples add up, and densities are those of their expected number. */
bool ppmi_lights_sample_at(const ppmi_lights *lights, const ppmi_receiver *receiver, float time,
                           double u_pick, float u, float v, ppmi_light_sample *out_sample);

/* The same for an opaque surface, as the shutter opens. */
static inline bool ppmi_lights_sample(const ppmi_lights *lights, ppmi_vec3 position, ppmi_vec3 n,
                                      double u_pick, float u, float v,
                                      ppmi_light_sample *out_sample)
{
    const ppmi_receiver receiver = {.position = position, .normal = n};
    return ppmi_lights_sample_at(lights, &receiver, 0.0f, u_pick, u, v, out_sample);
}

/* ---- learning ---------------------------------------------------------------------------------
 *
 * A light sample first makes one of few choices: a cluster of near lights, directional lights, the
 * environment. How they are shared out at a place may be learned before the picture is begun. */

enum { PPMI_LIGHT_CLUSTERS = 16, PPMI_LIGHT_CHOICES = PPMI_LIGHT_CLUSTERS + 2 };

/* A place where choices were tried: what arrived by each, over what its importance promises; below
 * 0: not tried. */
typedef struct ppmi_light_probe {
    ppmi_receiver receiver;
    float shares[PPMI_LIGHT_CHOICES];
} ppmi_light_probe;

uint32_t ppmi_lights_choice_count(const ppmi_lights *lights);

/* Samples light by one choice, as ppmi_lights_sample_at does once it is made; the density is
 * without the choice's probability. *out_importance: what it promises, in lux; 0: nothing at all.
 */
bool ppmi_lights_sample_choice(const ppmi_lights *lights, uint32_t choice,
                               const ppmi_receiver *receiver, float time, double u_pick, float u,
                               float v, ppmi_light_sample *out_sample, float *out_importance);

/* From now on light is sampled by what the probes have found. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_lights_learn(ppmi_lights *lights, const ppmi_light_probe *probes, uint32_t count);

/* ---- densities ------------------------------------------------------------------------------- */

/* Density with which ppmi_lights_sample_at draws for a receiver the emissive surface (on it, at
 * distance along wi) or far light in direction wi: the environment or any directional light that
 * has a size. */
float ppmi_lights_pdf_surface(const ppmi_lights *lights, const ppmi_receiver *receiver,
                              const ppmi_hit *hit, const ppmi_surface *surface, ppmi_vec3 wi,
                              float distance);
float ppmi_lights_pdf_environment(const ppmi_lights *lights, const ppmi_receiver *receiver,
                                  ppmi_vec3 wi);

/* A light with an extent that a ray meets: they stop no ray, so that one may meet several. */
typedef struct ppmi_lamp_hit {
    float t;       /* 0 to begin with */
    uint32_t next; /* 0 to begin with: what is not met again */
    uint32_t lamp;
    uint32_t emitter;
    ppmi_vec3 radiance; /* towards the ray's origin */
} ppmi_lamp_hit;

bool ppmi_lights_have_lamps(const ppmi_lights *lights);

/* Goes from hit to the next lamp along the ray (unit direction), within its t_max; false when there
 * is none. For rays straight from the camera hidden lights are not there. */
bool ppmi_lights_next_lamp(const ppmi_lights *lights, const ppmi_ray *ray, bool is_camera,
                           ppmi_lamp_hit *hit);

/* Density with which ppmi_lights_sample_at draws for a receiver that lamp in direction wi, which it
 * is met in at distance. */
float ppmi_lights_pdf_lamp(const ppmi_lights *lights, const ppmi_receiver *receiver, uint32_t lamp,
                           ppmi_vec3 wi, float distance);

/* Radiance from infinitely far in direction wi: the environment's and that of all directional
 * lights whose disk holds wi. */
ppmi_vec3 ppmi_lights_environment(const ppmi_lights *lights, ppmi_vec3 wi);

/* What ppmi_lights_environment adds up: of part 0, the environment, and of the parts beyond, the
 * directional lights (black where the disk does not hold wi). False beyond the last part. */
bool ppmi_lights_far_part(const ppmi_lights *lights, ppmi_vec3 wi, uint32_t part,
                          ppmi_vec3 *out_radiance, uint32_t *out_emitter);

bool ppmi_lights_has_backdrop(const ppmi_lights *lights);

/* What a camera ray sees that meets nothing: the backdrop, or else what is infinitely far. */
ppmi_vec3 ppmi_lights_backdrop(const ppmi_lights *lights, ppmi_vec3 direction);

/* A photon as it leaves a light. power is that of all light through this one photon: divide by the
 * number of photons of a pass. */
typedef struct ppmi_emission {
    ppmi_ray ray;
    ppmi_vec3 power;
    float crowding; /* ppmi_lights_crowding of the light's radiance along the ray; infinite where no
                       other ray meets the light: of delta lights */
    uint32_t emitter;
    bool is_far; /* from a directional light, a sun or the environment */
} ppmi_emission;

/* About how densely photons leave a light that has this radiance: for each one of a pass, per metre
 * squared and steradian (of projected area, as radiance). Where none is aimed, it is that exactly.
 */
float ppmi_lights_crowding(const ppmi_lights *lights, ppmi_vec3 radiance);

/* u: four numbers, stratified where possible; time: within the shutter. False for a photon that
 * carries nothing. */
bool ppmi_lights_emit_at(const ppmi_lights *lights, float time, double u_pick, const float u[4],
                         ppmi_emission *out_emission);

/* The same as the shutter opens. */
static inline bool ppmi_lights_emit(const ppmi_lights *lights, double u_pick, const float u[4],
                                    ppmi_emission *out_emission)
{
    return ppmi_lights_emit_at(lights, 0.0f, u_pick, u, out_emission);
}

#endif
