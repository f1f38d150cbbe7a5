/* Balls, rectangles and ellipses that shine.
 *
 * A ball of intensity I(w) has the radiance I(w) / (pi r^2) along w wherever its surface faces w:
 * seen from far away along w its outline has the area pi r^2. So a point light's angular
 * distribution stays what it was, and a photon is the point light's, moved sideways within the
 * outline. */
#include "light/lamp.h"

#include "math/sampling.h"

ppmi_lamp ppmi_lamp_of(const ppmi_punctual *light, uint32_t emitter)
{
    const float rounding = 4e-7f;
    const float size =
        ppmi_max(light->radius_m, ppmi_max(light->half_width_m, light->half_height_m));
    ppmi_lamp lamp = {.light = light, .emitter = emitter};
    lamp.error = rounding * (vec3_max_abs(light->position) + size);
    if (light->radius_m > 0.0f) {
        lamp.shape = PPMI_LAMP_BALL;
        lamp.area = PPMI_PI * ppmi_sqr(light->radius_m);
    } else if (light->kind == PPM_LIGHT_RECTANGLE) {
        lamp.shape = PPMI_LAMP_RECTANGLE;
        lamp.area = 4.0f * light->half_width_m * light->half_height_m;
    } else {
        lamp.shape = PPMI_LAMP_ELLIPSE;
        lamp.area = PPMI_PI * light->half_width_m * light->half_height_m;
    }
    return lamp;
}

/* ---- balls ----------------------------------------------------------------------------------- */

/* Distance along a line to where it enters the ball; lines that miss by rounding touch it. */
static float ball_entry(const ppmi_punctual *light, ppmi_vec3 origin, ppmi_vec3 direction,
                        float *out_miss2)
{
    const ppmi_vec3 to_center = vec3_sub(light->position, origin);
    const float middle = vec3_dot(to_center, direction);
    /* the foot of the perpendicular: no difference of large squares */
    const ppmi_vec3 off_axis = vec3_sub(to_center, vec3_scale(direction, middle));
    const float half2 = ppmi_sqr(light->radius_m) - vec3_length2(off_axis);
    *out_miss2 = half2;
    return middle - sqrtf(ppmi_max(half2, 0.0f));
}

/* 1 - cosine of the half angle at which the ball is seen; 0 from inside. */
static float ball_height(const ppmi_punctual *light, ppmi_vec3 position)
{
    const float distance2 = vec3_length2(vec3_sub(light->position, position));
    const float radius2 = ppmi_sqr(light->radius_m);
    if (!(distance2 > radius2)) return 0.0f;
    const float sine2 = radius2 / distance2;
    return sine2 / (1.0f + sqrtf(1.0f - sine2));
}

static float ball_pdf(const ppmi_punctual *light, ppmi_vec3 position)
{
    const float solid_angle = 2.0f * PPMI_PI * ball_height(light, position);
    return solid_angle > 1e-30f ? 1.0f / solid_angle : 0.0f;
}

static float sample_ball(const ppmi_lamp *lamp, ppmi_vec3 position, float u, float v,
                         ppmi_vec3 *out_wi, ppmi_vec3 *out_target)
{
    const ppmi_punctual *light = lamp->light;
    const float pdf = ball_pdf(light, position);
    if (!(pdf > 0.0f)) return 0.0f;
    const ppmi_vec3 axis = vec3_normalize(vec3_sub(light->position, position));
    const ppmi_frame frame = ppmi_frame_from_normal(axis);
    const ppmi_vec3 local = ppmi_sample_cap(ball_height(light, position), u, v);
    *out_wi = vec3_normalize(ppmi_frame_to_world(&frame, local));
    float miss2;
    const float t = ball_entry(light, position, *out_wi, &miss2);
    *out_target = vec3_mad(position, *out_wi, t - lamp->error);
    return pdf;
}

ppmi_vec3 ppmi_lamp_ball_origin(const ppmi_punctual *light, ppmi_vec3 direction, float u, float v)
{
    const ppmi_frame frame = ppmi_frame_from_normal(direction);
    return ppmi_lamp_ball_origin_at(light, &frame, ppmi_sample_disk(u, v));
}

ppmi_vec3 ppmi_lamp_ball_origin_at(const ppmi_punctual *light, const ppmi_frame *frame,
                                   ppmi_vec2 at)
{
    const float ahead = sqrtf(ppmi_max(0.0f, 1.0f - at.x * at.x - at.y * at.y));
    return vec3_mad(light->position, ppmi_frame_to_world(frame, vec3(at.x, at.y, ahead)),
                    light->radius_m);
}

/* ---- flat lamps ------------------------------------------------------------------------------ */

static ppmi_vec3 flat_point(const ppmi_lamp *lamp, float u, float v)
{
    const ppmi_punctual *light = lamp->light;
    ppmi_vec2 at = {2.0f * u - 1.0f, 2.0f * v - 1.0f};
    if (lamp->shape == PPMI_LAMP_ELLIPSE) at = ppmi_sample_disk(u, v);
    const ppmi_vec3 across = vec3_scale(light->right, at.x * light->half_width_m);
    return vec3_add(light->position, vec3_mad(across, light->up, at.y * light->half_height_m));
}

static bool intersect_flat(const ppmi_lamp *lamp, const ppmi_ray *ray, float *out_t)
{
    const ppmi_punctual *light = lamp->light;
    const float cosine = -vec3_dot(ray->direction, light->direction);
    if (!(cosine > 1e-6f)) return false;
    const ppmi_vec3 from_center = vec3_sub(ray->origin, light->position);
    const float t = vec3_dot(from_center, light->direction) / cosine;
    if (!(t > 0.0f)) return false;
    const ppmi_vec3 at = vec3_mad(from_center, ray->direction, t);
    const float x = vec3_dot(at, light->right) / light->half_width_m;
    const float y = vec3_dot(at, light->up) / light->half_height_m;
    *out_t = t;
    if (lamp->shape == PPMI_LAMP_ELLIPSE) return x * x + y * y <= 1.0f;
    return fabsf(x) <= 1.0f && fabsf(y) <= 1.0f;
}

static float sample_flat(const ppmi_lamp *lamp, ppmi_vec3 position, float u, float v,
                         ppmi_vec3 *out_wi, ppmi_vec3 *out_target)
{
    const ppmi_vec3 point = flat_point(lamp, u, v), way = vec3_sub(point, position);
    const float distance = vec3_length(way);
    if (!(distance > 0.0f)) return 0.0f;
    *out_wi = vec3_scale(way, 1.0f / distance);
    *out_target = vec3_mad(point, lamp->light->direction, lamp->error);
    return ppmi_lamp_pdf(lamp, position, *out_wi, distance);
}

ppmi_vec3 ppmi_lamp_flat_origin(const ppmi_lamp *lamp, float u, float v)
{
    return vec3_mad(flat_point(lamp, u, v), lamp->light->direction, lamp->error);
}

ppmi_ray ppmi_lamp_flat_ray(const ppmi_lamp *lamp, const float u[4])
{
    const ppmi_vec3 n = lamp->light->direction;
    const ppmi_frame frame = ppmi_frame_from_normal(n);
    const ppmi_vec3 local = ppmi_sample_cosine_hemisphere(u[2], u[3]);
    return (ppmi_ray){.origin = ppmi_lamp_flat_origin(lamp, u[0], u[1]),
                      .t_max = INFINITY,
                      .direction = vec3_normalize(ppmi_frame_to_world(&frame, local))};
}

/* ---- all ------------------------------------------------------------------------------------- */

bool ppmi_lamp_intersect(const ppmi_lamp *lamp, const ppmi_ray *ray, float *out_t)
{
    if (lamp->shape != PPMI_LAMP_BALL) {
        return intersect_flat(lamp, ray, out_t) && *out_t < ray->t_max;
    }
    float miss2;
    *out_t = ball_entry(lamp->light, ray->origin, ray->direction, &miss2);
    return miss2 >= 0.0f && *out_t > 0.0f && *out_t < ray->t_max;
}

ppmi_vec3 ppmi_lamp_radiance(const ppm_scene *scene, const ppmi_lamp *lamp, ppmi_vec3 direction)
{
    if (lamp->shape != PPMI_LAMP_BALL) return lamp->light->intensity;
    return vec3_scale(ppmi_punctual_intensity(scene, lamp->light, direction), 1.0f / lamp->area);
}

float ppmi_lamp_sample(const ppmi_lamp *lamp, ppmi_vec3 position, float u, float v,
                       ppmi_vec3 *out_wi, ppmi_vec3 *out_target)
{
    return lamp->shape == PPMI_LAMP_BALL ? sample_ball(lamp, position, u, v, out_wi, out_target)
                                         : sample_flat(lamp, position, u, v, out_wi, out_target);
}

float ppmi_lamp_pdf(const ppmi_lamp *lamp, ppmi_vec3 position, ppmi_vec3 wi, float distance)
{
    if (lamp->shape == PPMI_LAMP_BALL) return ball_pdf(lamp->light, position);
    const float cosine = -vec3_dot(wi, lamp->light->direction);
    return cosine > 1e-6f ? distance * distance / (cosine * lamp->area) : 0.0f;
}
