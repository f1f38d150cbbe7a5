/* Photons of the sun and the sky start where they can meet something.
 *
 * Seen along a direction, the three faces of a box that look towards the light tile its shadow, and
 * a point that is even over a face is even over the face's part of the shadow. So a shadow is
 * sampled exactly by a choice among three faces. A flat scene has a far smaller shadow than the
 * ball around it. */
#include "light/extent.h"

#include "math/sampling.h"

ppmi_light_extent ppmi_light_extent_of(const ppm_scene *scene)
{
    ppmi_light_extent extent = {0};
    ppmi_vec3 low, high;
    if (!ppmi_scene_bounds(scene, &low, &high)) return extent;
    const float slack = 1e-4f; /* what lies in the box's own faces must not be missed */
    extent.center = vec3_scale(vec3_add(low, high), 0.5f);
    extent.radius = 0.5f * vec3_length(vec3_sub(high, low)) * (1.0f + slack);
    extent.half =
        vec3_add(vec3_scale(vec3_sub(high, low), 0.5f), vec3_splat(extent.radius * slack));
    extent.is_ball = !vec3_is_black(vec3_add(scene->fog.sigma_s, scene->fog.sigma_a));
    return extent;
}

static float disk_area(const ppmi_light_extent *extent)
{
    return PPMI_PI * ppmi_sqr(extent->radius);
}

/* The parts of the shadow that the faces across x, y and z cast. */
static ppmi_vec3 face_shadows(const ppmi_light_extent *extent, ppmi_vec3 direction)
{
    const ppmi_vec3 h = extent->half;
    return vec3(4.0f * h.y * h.z * fabsf(direction.x), 4.0f * h.z * h.x * fabsf(direction.y),
                4.0f * h.x * h.y * fabsf(direction.z));
}

float ppmi_light_extent_shadow(const ppmi_light_extent *extent, ppmi_vec3 direction)
{
    if (extent->is_ball) return disk_area(extent);
    const ppmi_vec3 faces = face_shadows(extent, direction);
    return faces.x + faces.y + faces.z;
}

/* Cauchy's formula: a convex body's mean shadow is a quarter of its surface. */
float ppmi_light_extent_mean_shadow(const ppmi_light_extent *extent)
{
    if (extent->is_ball) return disk_area(extent);
    const ppmi_vec3 h = extent->half;
    return 2.0f * (h.x * h.y + h.y * h.z + h.z * h.x);
}

/* Takes share of *u with its probability; what is left of *u is even again. */
static bool take_share(float *u, float share)
{
    if (*u < share) {
        *u /= share;
        return true;
    }
    *u = (*u - share) / (1.0f - share);
    return false;
}

/* From the center to an even point of the shadow, on the side where the light comes from. */
static ppmi_vec3 offset_on_box(const ppmi_light_extent *extent, ppmi_vec3 direction, float u,
                               float v)
{
    const ppmi_vec3 faces = face_shadows(extent, direction);
    const ppmi_vec3 h = extent->half;
    const ppmi_vec3 lit = vec3(copysignf(h.x, -direction.x), copysignf(h.y, -direction.y),
                               copysignf(h.z, -direction.z));
    const float tiny = 1e-30f; /* an empty scene has no shadow to share */
    const float others = ppmi_max(faces.y + faces.z, tiny);
    const float b = 2.0f * v - 1.0f;
    if (take_share(&u, faces.x / (faces.x + others))) {
        return vec3(lit.x, h.y * (2.0f * u - 1.0f), h.z * b);
    }
    if (take_share(&u, faces.y / others)) return vec3(h.x * b, lit.y, h.z * (2.0f * u - 1.0f));
    return vec3(h.x * (2.0f * u - 1.0f), h.y * b, lit.z);
}

static ppmi_vec3 offset_on_disk(const ppmi_light_extent *extent, ppmi_vec3 direction, float u,
                                float v)
{
    const ppmi_frame frame = ppmi_frame_from_normal(direction);
    const ppmi_vec2 d = ppmi_sample_disk(u, v);
    const float r = extent->radius;
    return ppmi_frame_to_world(&frame, vec3(d.x * r, d.y * r, -r));
}

ppmi_ray ppmi_light_extent_ray(const ppmi_light_extent *extent, ppmi_vec3 direction, float u,
                               float v)
{
    const ppmi_vec3 offset = extent->is_ball ? offset_on_disk(extent, direction, u, v)
                                             : offset_on_box(extent, direction, u, v);
    const ppmi_vec3 start = vec3_mad(offset, direction, -0.01f * extent->radius);
    return (ppmi_ray){
        .origin = vec3_add(extent->center, start), .t_max = INFINITY, .direction = direction};
}

float ppmi_light_extent_cone(const ppmi_light_extent *extent, ppmi_vec3 position, float margin)
{
    const float distance2 = vec3_length2(vec3_sub(extent->center, position));
    const float radius2 = ppmi_sqr(extent->radius + margin) * 1.01f;
    return distance2 > radius2 ? sqrtf(1.0f - radius2 / distance2) : -1.0f;
}
