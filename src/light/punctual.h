/* What a point or spot light sends where: candela by direction. */
#ifndef PPMI_LIGHT_PUNCTUAL_H
#define PPMI_LIGHT_PUNCTUAL_H

#include "light/profile.h"

/* Squared ramp of the cosine between the cones (KHR_lights_punctual). cosine: to the axis. */
static inline float ppmi_spot_falloff(const ppmi_punctual *light, float cosine)
{
    const float range = ppmi_max(light->cos_inner - light->cos_outer, 1e-6f);
    const float x = ppmi_clampf((cosine - light->cos_outer) / range, 0.0f, 1.0f);
    return x * x;
}

/* Integral of that over directions. */
static inline float ppmi_spot_solid_angle(const ppmi_punctual *light)
{
    return 2.0f * PPMI_PI *
           ((1.0f - light->cos_inner) + (light->cos_inner - light->cos_outer) / 3.0f);
}

/* The factor of its profile along direction (unit, away from the light). */
static inline float ppmi_punctual_profile(const ppm_scene *scene, const ppmi_punctual *light,
                                          ppmi_vec3 direction)
{
    if (light->profile == 0) return 1.0f;
    const ppmi_vec3 local = vec3(vec3_dot(direction, light->right), vec3_dot(direction, light->up),
                                 -vec3_dot(direction, light->direction));
    return ppmi_light_profile_value(&scene->profiles[light->profile - 1], local);
}

/* Candela along direction (unit, away from the light) of a point or spot light. */
static inline ppmi_vec3 ppmi_punctual_intensity(const ppm_scene *scene, const ppmi_punctual *light,
                                                ppmi_vec3 direction)
{
    float factor = ppmi_punctual_profile(scene, light, direction);
    if (light->kind == PPM_LIGHT_SPOT) {
        factor *= ppmi_spot_falloff(light, vec3_dot(direction, light->direction));
    }
    return vec3_scale(light->intensity, factor);
}

#endif
