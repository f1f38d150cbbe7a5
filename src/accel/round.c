/* Balls and round segments: from a hit to its place and back. */
#include "accel/round.h"

#include "math/sampling.h"
#include "scene/motion.h"

ppmi_round ppmi_round_of(const ppmi_primitive *primitive, uint32_t element, float time)
{
    const bool is_line = primitive->kind == PPM_PRIMITIVE_LINES;
    const uint32_t *ends = primitive->indices + (is_line ? 2 : 1) * (size_t)element;
    ppmi_round round = {.radius = primitive->radius_m, .axis = {0.0f, 0.0f, 1.0f}};
    round.first = round.last = ppmi_position_at(primitive, ends[0], time);
    if (!is_line) return round;
    round.last = ppmi_position_at(primitive, ends[1], time);
    const ppmi_vec3 way = vec3_sub(round.last, round.first);
    round.length = vec3_length(way);
    if (round.length > 0.0f) round.axis = vec3_scale(way, 1.0f / round.length);
    return round;
}

float ppmi_round_area(const ppmi_round *round)
{
    return 2.0f * PPMI_PI * round->radius * (round->length + 2.0f * round->radius);
}

/* The area grows evenly along the axis, on caps as on the body (Archimedes). */
void ppmi_round_sample(const ppmi_round *round, float u, float v, float *out_u, float *out_v)
{
    const float cap = round->radius / (round->length + 2.0f * round->radius);
    *out_v = PPMI_PI * (2.0f * v - 1.0f);
    if (u <= cap) {
        *out_u = asinf(u / cap - 1.0f);
    } else if (u > 1.0f - cap) {
        *out_u = 1.0f + asinf(ppmi_min((u - (1.0f - cap)) / cap, 1.0f));
    } else {
        *out_u = (u - cap) / (1.0f - 2.0f * cap);
    }
}

ppmi_round_point ppmi_round_at(const ppmi_round *round, float u, float v)
{
    const float along = ppmi_clampf(u, 0.0f, 1.0f);
    const float angle = u < 0.0f ? u : u > 1.0f ? u - 1.0f : 0.0f;
    const ppmi_frame frame = ppmi_frame_from_normal(round->axis);
    const float sine = sinf(angle), cosine = cosf(angle);
    const ppmi_vec3 normal =
        vec3_normalize(ppmi_frame_to_world(&frame, vec3(cosine * cosf(v), cosine * sinf(v), sine)));
    return (ppmi_round_point){
        .normal = normal,
        .position = vec3_mad(vec3_lerp(round->first, round->last, along), normal, round->radius),
        .along = along,
    };
}

void ppmi_round_place(const ppm_scene *scene, ppmi_vec3 normal, ppmi_hit *hit)
{
    const ppmi_mesh *mesh = &scene->meshes[scene->instances[hit->instance].mesh];
    const ppmi_primitive *primitive = &mesh->primitives[hit->primitive];
    if (primitive->kind == PPM_PRIMITIVE_TRIANGLES) return;
    const ppmi_round round = ppmi_round_of(primitive, hit->triangle, hit->time);
    const ppmi_frame frame = ppmi_frame_from_normal(round.axis);
    const float x = vec3_dot(normal, frame.s), y = vec3_dot(normal, frame.t);
    const float angle = atan2f(vec3_dot(normal, frame.n), sqrtf(x * x + y * y));
    hit->v = atan2f(y, x);
    if (primitive->kind == PPM_PRIMITIVE_POINTS) {
        hit->u = angle < 0.0f ? angle : 1.0f + angle;
    } else if (hit->u <= 0.0f) {
        hit->u = ppmi_min(angle, 0.0f);
    } else if (hit->u >= 1.0f) {
        hit->u = 1.0f + ppmi_max(angle, 0.0f);
    }
}
