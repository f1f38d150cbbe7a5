/* Lights with an extent: balls, rectangles and disks, met and sampled by their exact shapes.
 *
 * They are no geometry. A ray meets their lit side, gets their light and goes on. */
#ifndef PPMI_LIGHT_LAMP_H
#define PPMI_LIGHT_LAMP_H

#include "accel/accel.h"
#include "light/punctual.h"
#include "math/sampling.h"

typedef enum ppmi_lamp_shape {
    PPMI_LAMP_BALL,
    PPMI_LAMP_RECTANGLE,
    PPMI_LAMP_ELLIPSE
} ppmi_lamp_shape;

typedef struct ppmi_lamp {
    ppmi_lamp_shape shape;
    const ppmi_punctual *light;
    uint32_t emitter; /* its index among the emitters */
    float area;       /* of a flat lamp, or the ball's cross-section */
    float error;      /* bound of rounding in its positions */
} ppmi_lamp;

/* Whether a light has an extent that rays can meet. */
static inline bool ppmi_punctual_is_lamp(const ppmi_punctual *light)
{
    return light->radius_m > 0.0f || light->half_width_m > 0.0f;
}

ppmi_lamp ppmi_lamp_of(const ppmi_punctual *light, uint32_t emitter);

/* Whether a ray (unit direction) meets the lit side within its t_max, and where. */
bool ppmi_lamp_intersect(const ppmi_lamp *lamp, const ppmi_ray *ray, float *out_t);

/* Radiance along direction (unit, away from the lamp). */
ppmi_vec3 ppmi_lamp_radiance(const ppm_scene *scene, const ppmi_lamp *lamp, ppmi_vec3 direction);

/* Draws a point of the lit side, seen from position; *out_target is it, off the lamp by the error
 * bound. Returns the density by solid angle of *out_wi; 0 where nothing is lit. */
float ppmi_lamp_sample(const ppmi_lamp *lamp, ppmi_vec3 position, float u, float v,
                       ppmi_vec3 *out_wi, ppmi_vec3 *out_target);

/* The density of that for a direction wi that meets the lamp at distance. */
float ppmi_lamp_pdf(const ppmi_lamp *lamp, ppmi_vec3 position, ppmi_vec3 wi, float distance);

/* A flat lamp's photon: origin and direction, by the cosine. */
ppmi_ray ppmi_lamp_flat_ray(const ppmi_lamp *lamp, const float u[4]);

/* Where that starts: a place of the flat lamp, off it by the error bound. */
ppmi_vec3 ppmi_lamp_flat_origin(const ppmi_lamp *lamp, float u, float v);

/* Where a photon along direction leaves the ball: even over the outline seen from there, or
 * at a place of that outline as a unit disk; frame.n: the direction. */
ppmi_vec3 ppmi_lamp_ball_origin(const ppmi_punctual *light, ppmi_vec3 direction, float u, float v);
ppmi_vec3 ppmi_lamp_ball_origin_at(const ppmi_punctual *light, const ppmi_frame *frame,
                                   ppmi_vec2 at);

#endif
