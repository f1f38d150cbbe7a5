/* Cameras. One that is invalid is left out with a warning: the rest of the scene can be shown. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_placement.h"
#include "gltf/gltf_pose.h"
#include "gltf/gltf_rigid.h"

#define PI 3.14159265358979323846

static const char *camera_fault(const ppmi_gltf_camera *camera)
{
    if (camera->is_orthographic) {
        const bool ok = fabs(camera->x_mag) > 1e-30 && fabs(camera->y_mag) > 1e-30;
        return ok ? NULL : "xmag and ymag must not be 0";
    }
    if (!(camera->y_fov_rad > 0.0 && camera->y_fov_rad < PI)) return "yfov must be in 0 .. pi";
    return camera->aspect < 0.0 ? "aspectRatio must be above 0" : NULL;
}

/* Blender's shift, which glTF has no word for; one out of range is left out, not the camera. */
static void apply_shift(ppmi_gltf_reader *reader, const char *place, const ppmi_gltf_camera *camera,
                        ppm_camera_desc *desc)
{
    const double x = camera->shift[0], y = camera->shift[1];
    if (fabs(x) <= 100.0 && fabs(y) <= 100.0) {
        desc->shift[0] = (float)x;
        desc->shift[1] = (float)y;
        return;
    }
    ppmi_gltf_warn(reader, place, "extras.ppm_shift [%g, %g] left out: it must be in -100 .. 100",
                   x, y);
}

/* What viewers and Blender do: a camera outside of a wall, with its near plane behind it, shows the
 * room. Planes that make no sense are left out, not the camera. */
static void apply_clipping(ppmi_gltf_reader *reader, const char *place,
                           const ppmi_gltf_camera *camera, ppm_camera_desc *desc)
{
    const double near = camera->z_near, far = camera->z_far;
    if (reader->options->no_clip) return;
    if (!(near >= 0.0 && near < 1e15 && (far == 0.0 || far > near) && (float)near < INFINITY) ||
        (far > 0.0 && (float)far <= (float)near)) {
        ppmi_gltf_warn(reader, place, "znear %g and zfar %g left out: expected 0 <= znear < zfar",
                       near, far);
        return;
    }
    desc->near_m = (float)near;
    desc->far_m = far < 1e30 ? (float)far : 0.0f;
    ppmi_gltf_note_feature(reader, "camera clipping", PPM_FEATURE_HONOURED,
                           "znear and zfar, for what cameras see themselves; --no-clip");
}

/* EXT_camera_physical: the diameter of the lens is focalLength / fStop. The scene's f-number is
 * that of the lens with the same field of view before a sensor whose longer side is 36 mm; the
 * field of view is the core camera's, which the proposal calls authoritative. */
static void apply_lens(ppmi_gltf_reader *reader, const char *place, const ppmi_gltf_camera *camera,
                       ppm_camera_desc *desc)
{
    const double *sensor = camera->sensor_m;
    if (!camera->is_physical || camera->is_orthographic || camera->f_stop == 0.0) return;
    if (!(camera->focal_length_m > 0.0 && sensor[0] > 0.0 && sensor[1] > 0.0 &&
          camera->f_stop > 0.0 && camera->focus_distance_m >= 0.0)) {
        ppmi_gltf_warn(reader, place,
                       "EXT_camera_physical left out: focalLength, sensorSize and fStop must be "
                       "above 0, focusDistance not below");
        return;
    }
    const double aspect = camera->aspect > 0.0 ? camera->aspect : sensor[0] / sensor[1];
    const double focal_36_m = 0.018 / (tan(0.5 * camera->y_fov_rad) * fmax(aspect, 1.0));
    const double f_number = focal_36_m * camera->f_stop / camera->focal_length_m;
    const double focus_m = camera->focus_distance_m;
    if (!(f_number >= 1e-3 && f_number < 1e30) || !(focus_m == 0.0 || focus_m >= 1e-6) ||
        focus_m > 1e18) {
        ppmi_gltf_warn(reader, place, "EXT_camera_physical left out: its lens is of no use");
        return;
    }
    desc->f_number = (float)f_number;
    desc->focus_distance_m = (float)focus_m;
}

ppm_status ppmi_gltf_add_camera(ppmi_gltf_reader *reader, int32_t node)
{
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    const uint32_t steps = reader->pose->node_steps[node];
    char place[PPMI_GLTF_PLACE], name[PPMI_GLTF_PLACE];
    float motion[16 * PPM_MAX_MOTION_STEPS];
    ppmi_gltf_place(place, "nodes[%d].camera", (int)node);
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_CAMERAS, from->camera, place)) return PPM_STATUS_OK;
    const ppmi_gltf_camera *camera = &reader->document->cameras[from->camera];
    ppm_camera_desc desc = {
        .size = sizeof desc,
        .name = ppmi_gltf_choose_name(camera->name, from->name, name, sizeof name),
        .kind = camera->is_orthographic ? PPM_CAMERA_ORTHOGRAPHIC : PPM_CAMERA_PERSPECTIVE,
        .y_fov_rad = (float)camera->y_fov_rad,
        .half_width_m = (float)fabs(camera->x_mag),
        .half_height_m = (float)fabs(camera->y_mag),
        .aspect = (float)camera->aspect};
    apply_shift(reader, place, camera, &desc);
    apply_clipping(reader, place, camera, &desc);
    apply_lens(reader, place, camera, &desc);
    const char *fault = camera_fault(camera);
    for (uint32_t i = 0; i < steps && !fault; ++i) {
        fault = ppmi_gltf_rigid_transform(ppmi_gltf_pose_world(reader->pose, node, i, steps), true,
                                          motion + 16 * (size_t)i);
    }
    if (fault) {
        ppmi_gltf_warn(reader, place, "left out: cameras[%d]: %s", (int)from->camera, fault);
        return PPM_STATUS_OK;
    }
    memcpy(desc.transform, motion, sizeof desc.transform);
    if (steps > 1) {
        desc.motion_steps = steps;
        desc.motion = motion;
    }
    return ppmi_gltf_put_camera(reader, node, &desc);
}
