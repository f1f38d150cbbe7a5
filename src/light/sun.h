/* Directional lights with a size: a disk of even radiance in the sky.
 *
 * Whether a direction lies in the disk is told by the chord to its middle: the cosine of a small
 * angle has hardly any digits left in a float. */
#ifndef PPMI_LIGHT_SUN_H
#define PPMI_LIGHT_SUN_H

#include "math/sampling.h"
#include "scene/scene.h"

typedef struct ppmi_sun {
    ppmi_frame frame;   /* n: from the scene to the middle of the disk */
    ppmi_vec3 radiance; /* nit */
    float height;       /* 1 - cosine of the disk's angular radius */
    float solid_angle;
    float choice; /* probability that light sampling draws this light */
} ppmi_sun;

/* light: directional, with an angular radius. A plane that faces the disk gets the light's lux: the
 * integral of the cosine over the disk is pi sin^2 r. */
static inline ppmi_sun ppmi_sun_of(const ppmi_punctual *light)
{
    const float r = light->angular_radius_rad;
    const float height = 2.0f * ppmi_sqr(sinf(0.5f * r));
    return (ppmi_sun){
        .frame = ppmi_frame_from_normal(vec3_neg(light->direction)),
        .radiance = vec3_scale(light->intensity, PPMI_INV_PI / ppmi_sqr(sinf(r))),
        .height = height,
        .solid_angle = 2.0f * PPMI_PI * height,
    };
}

/* Whether the unit vector towards points into the disk. */
static inline bool ppmi_sun_holds(const ppmi_sun *sun, ppmi_vec3 towards)
{
    return vec3_length2(vec3_sub(towards, sun->frame.n)) <= 2.0f * sun->height;
}

/* A direction into the disk, of density 1 / solid_angle. */
static inline ppmi_vec3 ppmi_sun_sample(const ppmi_sun *sun, float u, float v)
{
    const ppmi_vec3 local = ppmi_sample_cap(sun->height, u, v);
    return vec3_normalize(ppmi_frame_to_world(&sun->frame, local));
}

#endif
