/* Camera rays. */
#include "camera/camera.h"

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
        .spread = is_perspective ? pixel : 0.0f,
        .base_width = is_perspective ? 0.0f : pixel,
        .is_perspective = is_perspective,
    };
}

ppmi_camera_ray ppmi_camera_view_ray(const ppmi_camera_view *view, float x, float y)
{
    const float sx = 2.0f * x / view->width - 1.0f;
    const float sy = 1.0f - 2.0f * y / view->height;
    const ppmi_vec3 offset = vec3_mad(vec3_scale(view->right, sx), view->up, sy);
    ppmi_camera_ray result = {
        .ray = {.origin = view->origin, .t_max = INFINITY, .direction = view->forward},
        .base_width = view->base_width,
        .spread = view->spread,
    };
    if (view->is_perspective) {
        result.ray.direction = vec3_normalize(vec3_add(view->forward, offset));
    } else {
        result.ray.origin = vec3_add(view->origin, offset);
    }
    return result;
}
