/* A part of the scene that photons are sent to: an ellipsoid with its axes along the world's.
 *
 * Scaled to the unit ball it is what rays are easily drawn towards: parallel ones evenly over its
 * shadow, those from a point within a cone. Scaling takes even lines to even lines, and solid
 * angles by a factor that is known, so that both densities are exact. All is done in double
 * precision: the target may be a thing of centimetres, kilometres from the light. */
#ifndef PPMI_LIGHT_TARGET_H
#define PPMI_LIGHT_TARGET_H

#include "light/extent.h"
#include "math/sampling.h"

typedef struct ppmi_target {
    ppmi_vec3 center;
    ppmi_vec3 half; /* semi-axes, above 0 */
} ppmi_target;

/* Whether a half-line meets the target, or starts in it. */
bool ppmi_target_is_met(const ppmi_target *target, ppmi_vec3 origin, ppmi_vec3 direction);

/* Area of the shadow that parallel light along direction (unit) casts of the target. */
double ppmi_target_shadow(const ppmi_target *target, ppmi_vec3 direction);

/* The line along direction (unit) through a point of that shadow, even over it by u and v: from
 * where it enters the extent. False where it passes the extent. */
bool ppmi_target_far_ray(const ppmi_target *target, const ppmi_light_extent *extent,
                         ppmi_vec3 direction, float u, float v, ppmi_ray *out_ray);

/* A target as it is seen from a point. */
typedef struct ppmi_target_cone {
    ppmi_vec3 axis;     /* to the centre, of the scaled space, unit */
    double height;      /* of the cone's cap there, 1 - cosine */
    double volume;      /* product of the semi-axes, m3 */
    double solid_angle; /* about, sr; 4 pi from inside */
} ppmi_target_cone;

ppmi_target_cone ppmi_target_cone_from(const ppmi_target *target, ppmi_vec3 position);

/* A direction (unit) within the cone, which must not be seen from inside; *out_inverse_pdf is 1
 * over its density by solid angle. */
ppmi_vec3 ppmi_target_cone_sample(const ppmi_target *target, const ppmi_target_cone *cone, float u,
                                  float v, float *out_inverse_pdf);

/* A target that holds all of count > 0 others. */
ppmi_target ppmi_target_around(const ppmi_target *targets, uint32_t count);

#endif
