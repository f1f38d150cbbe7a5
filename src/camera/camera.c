/* Camera rays. */
#include "camera/camera.h"

#include "scene/motion.h"

void ppmi_camera_view_init(const ppmi_camera *camera, uint32_t width, uint32_t height,
                           ppmi_camera_view *out_view)
{
    const float aspect = (float)width / (float)height;
    const bool is_perspective = camera->kind == PPM_CAMERA_PERSPECTIVE;
    const float half_height =
        is_perspective ? tanf(0.5f * camera->y_fov_rad) : camera->half_height_m;
    const float pixel = 2.0f * half_height / (float)height;
    *out_view = (ppmi_camera_view){
        .origin = camera->origin,
        .forward = camera->forward,
        .right = vec3_scale(camera->right, half_height * aspect),
        .up = vec3_scale(camera->up, half_height),
        .width = (float)width,
        .height = (float)height,
        .shift_x = 2.0f * camera->shift[0] / aspect,
        .shift_y = 2.0f * camera->shift[1],
        .spread = is_perspective ? pixel : 0.0f,
        .base_width = is_perspective ? 0.0f : pixel,
        .is_perspective = is_perspective,
        .near_m = camera->near_m,
        .far_m = camera->far_m > 0.0f ? camera->far_m : INFINITY,
        .motion_steps = camera->motion_steps,
        .motion = camera->motion,
    };
}

/* ---- motion ---------------------------------------------------------------------------------- */

typedef struct quaternion {
    float x, y, z, w;
} quaternion;

/* From three orthonormal columns (Shepperd 1978): by the largest of the four squares. */
static quaternion turn_of(ppmi_vec3 x, ppmi_vec3 y, ppmi_vec3 z)
{
    const float trace = x.x + y.y + z.z;
    if (trace > 0.0f) {
        const float s = 2.0f * sqrtf(1.0f + trace);
        return (quaternion){(y.z - z.y) / s, (z.x - x.z) / s, (x.y - y.x) / s, 0.25f * s};
    }
    if (x.x > y.y && x.x > z.z) {
        const float s = 2.0f * sqrtf(1.0f + x.x - y.y - z.z);
        return (quaternion){0.25f * s, (y.x + x.y) / s, (z.x + x.z) / s, (y.z - z.y) / s};
    }
    if (y.y > z.z) {
        const float s = 2.0f * sqrtf(1.0f + y.y - x.x - z.z);
        return (quaternion){(y.x + x.y) / s, 0.25f * s, (z.y + y.z) / s, (z.x - x.z) / s};
    }
    const float s = 2.0f * sqrtf(1.0f + z.z - x.x - y.y);
    return (quaternion){(z.x + x.z) / s, (z.y + y.z) / s, 0.25f * s, (x.y - y.x) / s};
}

/* The shorter way round. */
static quaternion slerp(quaternion a, quaternion b, float share)
{
    float cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
    const float sign = cosine < 0.0f ? -1.0f : 1.0f;
    cosine = ppmi_min(fabsf(cosine), 1.0f);
    float from = 1.0f - share, to = share;
    if (cosine < 0.9999f) { /* else the chord is the arc, to rounding */
        const float angle = acosf(cosine);
        from = sinf(from * angle) / sinf(angle);
        to = sinf(to * angle) / sinf(angle);
    }
    to *= sign;
    const quaternion q = {from * a.x + to * b.x, from * a.y + to * b.y, from * a.z + to * b.z,
                          from * a.w + to * b.w};
    const float scale = 1.0f / sqrtf(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return (quaternion){q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}

ppmi_camera_view ppmi_camera_view_at(const ppmi_camera_view *view, float time)
{
    ppmi_camera_view result = *view;
    if (view->motion_steps <= 1) return result;
    const ppmi_motion_place at = ppmi_motion_at(view->motion_steps, time);
    const ppmi_camera_pose *a = &view->motion[at.step], *b = a + 1;
    const quaternion q = slerp(turn_of(a->right, a->up, vec3_neg(a->forward)),
                               turn_of(b->right, b->up, vec3_neg(b->forward)), at.share);
    const ppmi_vec3 right = vec3(1.0f - 2.0f * (q.y * q.y + q.z * q.z),
                                 2.0f * (q.x * q.y + q.w * q.z), 2.0f * (q.x * q.z - q.w * q.y));
    const ppmi_vec3 up = vec3(2.0f * (q.x * q.y - q.w * q.z), 1.0f - 2.0f * (q.x * q.x + q.z * q.z),
                              2.0f * (q.y * q.z + q.w * q.x));
    result.origin = vec3_lerp(a->origin, b->origin, at.share);
    result.forward = vec3_neg(vec3_cross(right, up));
    result.right = vec3_scale(right, vec3_length(view->right));
    result.up = vec3_scale(up, vec3_length(view->up));
    result.lens_right = vec3_scale(right, vec3_length(view->lens_right));
    result.lens_up = vec3_scale(up, vec3_length(view->lens_up));
    return result;
}

/* ---- rays ------------------------------------------------------------------------------------ */

ppmi_vec3 ppmi_camera_view_start(const ppmi_camera_view *view)
{
    return vec3_mad(view->origin, view->forward, view->near_m);
}

float ppmi_camera_view_focal_length(const ppmi_camera_view *view)
{
    const float longer_half = ppmi_max(vec3_length(view->right), vec3_length(view->up));
    return 0.5f * PPMI_SENSOR_SIDE_M / longer_half;
}

void ppmi_camera_view_set_lens(ppmi_camera_view *view, float f_number, float focus_distance_m)
{
    if (!view->is_perspective || isinf(f_number)) return;
    const float radius = ppmi_camera_view_focal_length(view) / (2.0f * f_number);
    view->lens_right = vec3_scale(vec3_normalize(view->right), radius);
    view->lens_up = vec3_scale(vec3_normalize(view->up), radius);
    view->inverse_focus = 1.0f / focus_distance_m;
    view->has_lens = true;
}

/* Change of a unit vector when a vector along it, of length 1 / scale, changes by step. */
static ppmi_vec3 unit_change(ppmi_vec3 unit, ppmi_vec3 step, float scale)
{
    return vec3_scale(vec3_mad(step, unit, -vec3_dot(unit, step)), scale);
}

/* Lets a ray begin at the near plane and end at the far one; along is what it gains along forward
 * over its length. step_x and step_y: how the point at distance 1 along forward changes. */
static void clip(const ppmi_camera_view *view, float along, ppmi_vec3 step_x, ppmi_vec3 step_y,
                 ppmi_camera_ray *ray)
{
    if (view->near_m > 0.0f) {
        const float skipped = view->near_m / along;
        ray->ray.origin = vec3_mad(ray->ray.origin, ray->ray.direction, skipped);
        ray->base_width += ray->spread * skipped;
        if (view->is_perspective) {
            ray->position_dx = vec3_scale(step_x, view->near_m);
            ray->position_dy = vec3_scale(step_y, view->near_m);
        }
    }
    ray->ray.t_max = (view->far_m - view->near_m) / along;
}

ppmi_camera_ray ppmi_camera_view_lens_ray(const ppmi_camera_view *view, float x, float y,
                                          ppmi_vec2 lens)
{
    const float sx = 2.0f * x / view->width - 1.0f + view->shift_x;
    const float sy = 1.0f - 2.0f * y / view->height + view->shift_y;
    ppmi_vec3 offset = vec3_mad(vec3_scale(view->right, sx), view->up, sy);
    ppmi_camera_ray result = {
        .ray = {.origin = view->origin, .t_max = INFINITY, .direction = view->forward},
        .base_width = view->base_width,
        .spread = view->spread,
    };
    const ppmi_vec3 step_x = vec3_scale(view->right, 2.0f / view->width);
    const ppmi_vec3 step_y = vec3_scale(view->up, -2.0f / view->height);
    if (!view->is_perspective) {
        result.ray.origin = vec3_add(view->origin, offset);
        result.position_dx = step_x;
        result.position_dy = step_y;
        clip(view, 1.0f, step_x, step_y, &result);
        return result;
    }
    if (view->has_lens) { /* all points of the lens aim at one point of the sharp plane */
        const ppmi_vec3 shift =
            vec3_mad(vec3_scale(view->lens_right, lens.x), view->lens_up, lens.y);
        result.ray.origin = vec3_add(view->origin, shift);
        offset = vec3_mad(offset, shift, -view->inverse_focus);
    }
    const ppmi_vec3 through = vec3_add(view->forward, offset);
    result.ray.direction = vec3_normalize(through);
    const float scale = 1.0f / vec3_length(through);
    result.direction_dx = unit_change(result.ray.direction, step_x, scale);
    result.direction_dy = unit_change(result.ray.direction, step_y, scale);
    clip(view, scale, step_x, step_y, &result);
    return result;
}

ppmi_camera_ray ppmi_camera_view_ray(const ppmi_camera_view *view, float x, float y)
{
    return ppmi_camera_view_lens_ray(view, x, y, (ppmi_vec2){0.0f, 0.0f});
}
