/* Cameras: checked and turned into unit vectors. */
#include <string.h>

#include "scene/scene.h"

static ppm_status fail_memory(ppm_scene *scene)
{
    return ppmi_fail(scene->context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for scene arrays");
}

/* The axes of a transform as an orthonormal frame; scale and shear are dropped. The camera looks
 * and a light shines along -z. False for singular transforms. */
static bool unit_axes(const ppmi_transform *m, ppmi_vec3 *right, ppmi_vec3 *up, ppmi_vec3 *back)
{
    if (!ppmi_transform_is_finite(m) || vec3_max_abs(m->origin) > PPMI_FARTHEST_M) return false;
    *back = vec3_normalize(m->z);
    *right = vec3_normalize(vec3_cross(m->y, *back));
    *up = vec3_cross(*back, *right);
    /* a mirrored transform shows a mirrored picture; cameras are not mirrored by the specification
     */
    return vec3_length2(*back) > 0.5f && vec3_length2(*right) > 0.5f;
}

/* A pose from a matrix; false for singular ones. */
static bool load_pose(const float matrix[16], ppmi_camera_pose *pose)
{
    const ppmi_transform m = ppmi_transform_load(matrix);
    ppmi_vec3 back;
    if (!unit_axes(&m, &pose->right, &pose->up, &back)) return false;
    pose->forward = vec3_neg(back);
    pose->origin = pose->given_origin = m.origin;
    return true;
}

/* Fills in how the camera moves, and where it is at the opening. Poses that are all alike are no
 * motion. */
static ppm_status load_motion(ppm_scene *scene, const ppm_camera_desc *desc, const char *name,
                              ppmi_camera *camera)
{
    const bool has_motion = desc->motion && desc->motion_steps > 0;
    const uint32_t steps = has_motion ? desc->motion_steps : 1;
    const float *matrices = has_motion ? desc->motion : desc->transform;
    if (desc->motion_steps > PPM_MAX_MOTION_STEPS || (desc->motion_steps > 1 && !desc->motion)) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                         "camera '%s': %u motion steps %s; at most %d, and a transform for each",
                         name, desc->motion_steps, desc->motion ? "given" : "without transforms",
                         PPM_MAX_MOTION_STEPS);
    }
    ppmi_camera_pose *poses = ppmi_alloc(scene->context, steps, sizeof *poses);
    if (!poses) return fail_memory(scene);
    bool is_at_rest = true;
    for (uint32_t i = 0; i < steps; i++) {
        const float *matrix = matrices + 16 * (size_t)i;
        if (!load_pose(matrix, &poses[i])) {
            ppmi_free(scene->context, poses);
            return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT,
                             "camera '%s': angle, size, aspect, lens or transform out of range",
                             name);
        }
        is_at_rest = is_at_rest && memcmp(matrices, matrix, 16 * sizeof *matrix) == 0;
    }
    camera->origin = camera->given_origin = poses[0].origin;
    camera->right = poses[0].right;
    camera->up = poses[0].up;
    camera->forward = poses[0].forward;
    camera->motion_steps = is_at_rest ? 1 : steps;
    camera->motion = is_at_rest ? NULL : poses;
    if (is_at_rest) ppmi_free(scene->context, poses);
    return PPM_STATUS_OK;
}

static bool camera_is_valid(const ppm_camera_desc *desc)
{
    if (desc->kind == PPM_CAMERA_PERSPECTIVE) {
        return desc->y_fov_rad > 0.0f && desc->y_fov_rad < PPMI_PI && desc->aspect >= 0.0f &&
               isfinite(desc->aspect);
    }
    return desc->kind == PPM_CAMERA_ORTHOGRAPHIC && desc->half_height_m > 0.0f &&
           desc->half_width_m > 0.0f && isfinite(desc->half_height_m) &&
           isfinite(desc->half_width_m);
}

ppm_status ppm_scene_add_camera(ppm_scene *scene, const ppm_camera_desc *desc,
                                ppm_camera_id *out_id)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!desc || !out_id || desc->size < sizeof *desc) return PPM_STATUS_INVALID_ARGUMENT;
    const char *name = desc->name ? desc->name : "";
    const bool lens_is_valid = desc->f_number >= 0.0f && desc->focus_distance_m >= 0.0f &&
                               isfinite(desc->focus_distance_m);
    const bool shift_is_valid = fabsf(desc->shift[0]) <= 100.0f && fabsf(desc->shift[1]) <= 100.0f;
    const bool clip_is_valid = desc->near_m >= 0.0f && isfinite(desc->near_m) &&
                               (desc->far_m == 0.0f || desc->far_m > desc->near_m);
    if (!lens_is_valid || !shift_is_valid || !clip_is_valid || !camera_is_valid(desc)) {
        return ppmi_fail(
            scene->context, PPM_STATUS_INVALID_ARGUMENT,
            "camera '%s': angle, size, aspect, lens, shift, clipping or transform out of "
            "range",
            name);
    }
    ppmi_camera *cameras =
        ppmi_scene_grow(scene->context, scene->cameras, scene->camera_count, sizeof *cameras);
    if (!cameras) return PPM_STATUS_OUT_OF_MEMORY;
    scene->cameras = cameras;
    const bool is_orthographic = desc->kind == PPM_CAMERA_ORTHOGRAPHIC;
    ppmi_camera camera = {
        .kind = desc->kind,
        .y_fov_rad = desc->y_fov_rad,
        .half_width_m = desc->half_width_m,
        .half_height_m = desc->half_height_m,
        .aspect = is_orthographic ? desc->half_width_m / desc->half_height_m : desc->aspect,
        .f_number = desc->f_number,
        .focus_distance_m = desc->focus_distance_m,
        .shift = {desc->shift[0], desc->shift[1]},
        .near_m = desc->near_m,
        .far_m = isfinite(desc->far_m) ? desc->far_m : 0.0f,
    };
    status = load_motion(scene, desc, name, &camera);
    if (status != PPM_STATUS_OK) return status;
    camera.name = ppmi_string_copy(scene->context, name);
    if (!camera.name) {
        ppmi_free(scene->context, camera.motion);
        return fail_memory(scene);
    }
    cameras[scene->camera_count] = camera;
    *out_id = ++scene->camera_count;
    return PPM_STATUS_OK;
}

/* Made and checked as an added one, which then takes the old one's place. */
ppm_status ppm_scene_set_camera(ppm_scene *scene, ppm_camera_id id, const ppm_camera_desc *desc)
{
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (id == 0 || id > scene->camera_count) {
        return ppmi_fail(scene->context, PPM_STATUS_INVALID_ARGUMENT, "camera %u of %u", id,
                         scene->camera_count);
    }
    ppm_camera_id added;
    status = ppm_scene_add_camera(scene, desc, &added);
    if (status != PPM_STATUS_OK) return status;
    ppmi_camera *last = &scene->cameras[--scene->camera_count];
    ppmi_free(scene->context, last->name);
    ppmi_free(scene->context, scene->cameras[id - 1].motion);
    last->name = scene->cameras[id - 1].name;
    scene->cameras[id - 1] = *last;
    return PPM_STATUS_OK;
}

uint32_t ppm_scene_camera_count(const ppm_scene *scene)
{
    return scene ? scene->camera_count : 0;
}

const char *ppm_scene_camera_name(const ppm_scene *scene, ppm_camera_id id)
{
    if (!scene || id == 0 || id > scene->camera_count) return NULL;
    return scene->cameras[id - 1].name;
}

float ppm_scene_camera_aspect(const ppm_scene *scene, ppm_camera_id id)
{
    if (!scene || id == 0 || id > scene->camera_count) return 0.0f;
    return scene->cameras[id - 1].aspect;
}

ppm_status ppm_scene_camera_transform(const ppm_scene *scene, ppm_camera_id id,
                                      float out_transform[16])
{
    if (!scene || id == 0 || id > scene->camera_count || !out_transform) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    const ppmi_camera *camera = &scene->cameras[id - 1];
    const ppmi_vec3 columns[4] = {camera->right, camera->up, vec3_neg(camera->forward),
                                  vec3_add(camera->origin, scene->shift)};
    for (int i = 0; i < 4; i++) {
        vec3_store(out_transform + 4 * i, columns[i]);
        out_transform[4 * i + 3] = i == 3 ? 1.0f : 0.0f;
    }
    return PPM_STATUS_OK;
}

/* Distance from which a box, seen along -back, just fits into the view. */
static float framing_distance(ppmi_vec3 half, ppmi_vec3 right, ppmi_vec3 up, ppmi_vec3 back,
                              float tan_x, float tan_y)
{
    float distance = 0.0f;
    for (uint32_t i = 0; i < 8; i++) {
        const ppmi_vec3 p =
            vec3(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
        const float depth = vec3_dot(p, back);
        distance = ppmi_max(distance, depth + fabsf(vec3_dot(p, right)) / tan_x);
        distance = ppmi_max(distance, depth + fabsf(vec3_dot(p, up)) / tan_y);
    }
    return distance;
}

ppm_status ppm_scene_add_framing_camera(ppm_scene *scene, float aspect, ppm_camera_id *out_id)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!out_id || !(aspect > 0.0f) || !isfinite(aspect)) return PPM_STATUS_INVALID_ARGUMENT;
    ppmi_vec3 low, high;
    if (!ppmi_scene_bounds(scene, &low, &high) && !ppmi_scene_bounds_of_all(scene, &low, &high)) {
        low = vec3_splat(-1.0f);
        high = vec3_splat(1.0f);
    }
    const float y_fov_rad = 0.6f; /* about a 58 mm lens on a 36 x 24 mm sensor: little distortion */
    const float margin = 1.08f;
    const ppmi_vec3 center = vec3_scale(vec3_add(low, high), 0.5f);
    const ppmi_vec3 half = vec3_scale(vec3_sub(high, low), 0.5f * margin);
    const ppmi_vec3 back = vec3_normalize(vec3(0.62f, 0.42f, 1.0f));
    const ppmi_vec3 right = vec3_normalize(vec3_cross(vec3(0.0f, 1.0f, 0.0f), back));
    const ppmi_vec3 up = vec3_cross(back, right);
    const float tan_y = tanf(0.5f * y_fov_rad);
    const float distance = framing_distance(half, right, up, back, tan_y * aspect, tan_y);
    const ppmi_vec3 origin = vec3_mad(center, back, ppmi_max(distance, 1e-6f));
    ppm_camera_desc desc = {
        .size = sizeof desc,
        .name = "(framing)",
        .kind = PPM_CAMERA_PERSPECTIVE,
        .transform = {right.x, right.y, right.z, 0.0f, up.x, up.y, up.z, 0.0f, back.x, back.y,
                      back.z, 0.0f, origin.x, origin.y, origin.z, 1.0f},
        .y_fov_rad = y_fov_rad,
        .aspect = aspect,
    };
    return ppm_scene_add_camera(scene, &desc, out_id);
}
