/* Spans of media along rays. */
#include "transport/media.h"

/* Where the ray is within the fog's ball. False when nowhere. */
static bool clip_to_fog(const ppmi_world *world, const ppmi_ray *ray, ppmi_medium_span *span)
{
    const ppmi_vec3 to_center = vec3_sub(world->fog_center, ray->origin);
    const float middle = vec3_dot(to_center, ray->direction);
    /* the foot of the perpendicular: no difference of large squares */
    const ppmi_vec3 off_axis = vec3_sub(to_center, vec3_scale(ray->direction, middle));
    const float half2 = world->fog_radius * world->fog_radius - vec3_length2(off_axis);
    if (!(half2 > 0.0f)) return false;
    const float half = sqrtf(half2);
    span->begin = ppmi_max(span->begin, middle - half);
    span->end = ppmi_min(span->end, middle + half);
    return span->begin < span->end;
}

ppmi_medium_span ppmi_media_span(const ppmi_world *world, const ppmi_interior *interior,
                                 const ppmi_ray *ray, float t_max)
{
    ppmi_medium_span span = {.begin = 0.0f, .end = t_max};
    const uint32_t material = ppmi_interior_material(interior, world->scene);
    if (material == PPMI_OUTSIDE) {
        if (world->has_fog && clip_to_fog(world, ray, &span)) span.medium = &world->scene->fog;
        return span;
    }
    const ppmi_medium *inside = &world->scene->materials[material].inside;
    if (!ppmi_medium_is_empty(inside) && !isinf(t_max)) span.medium = inside;
    return span;
}
