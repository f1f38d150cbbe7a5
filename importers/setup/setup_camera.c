/* Cameras: angles in degrees, or a focal length and its sensor, become what the scene keeps. */
#include <math.h>
#include <string.h>

#include "setup/setup_file.h"

#define PI 3.14159265358979323846

typedef struct camera_words {
    ppmi_setup_pose pose;
    const char *name, *focus_node;
    int32_t kind;
    double fov, focal_mm, sensor_mm[2], width, height, aspect;
    double f_number, focus_distance, shift[2];
} camera_words;

/* In the order of keys; the first five are those of the pose. */
enum {
    FOV = 1 << 7,
    FOCAL = 1 << 8,
    SENSOR = 1 << 9,
    WIDTH = 1 << 10,
    HEIGHT = 1 << 11,
    ASPECT = 1 << 12,
    F_NUMBER = 1 << 13,
    FOCUS_DISTANCE = 1 << 14,
    FOCUS_NODE = 1 << 15,
    PERSPECTIVE_ONLY = FOV | FOCAL | SENSOR | ASPECT | F_NUMBER | FOCUS_DISTANCE | FOCUS_NODE
};

static const ppmi_setup_word kinds[] = {
    {"perspective", PPM_CAMERA_PERSPECTIVE}, {"orthographic", PPM_CAMERA_ORTHOGRAPHIC}, {NULL, 0}};
#define FIELD(member) .field = offsetof(camera_words, member)
static const ppmi_setup_key keys[] = {
    PPMI_SETUP_POSE_KEYS,
    {"name", PPMI_SETUP_TEXT, FIELD(name)},
    {"kind", PPMI_SETUP_WORD, FIELD(kind), .words = kinds},
    {"fov", PPMI_SETUP_REAL, FIELD(fov), 0.001, 179.9},
    {"focal_mm", PPMI_SETUP_REAL, FIELD(focal_mm), 0.01, 1e6},
    {"sensor_mm", PPMI_SETUP_REALS, FIELD(sensor_mm), 0.01, 1e6, .count = 2},
    {"width", PPMI_SETUP_REAL, FIELD(width), 1e-9, 1e15},
    {"height", PPMI_SETUP_REAL, FIELD(height), 1e-9, 1e15},
    {"aspect", PPMI_SETUP_REAL, FIELD(aspect), 0.001, 1000},
    {"f_number", PPMI_SETUP_REAL, FIELD(f_number), 0.001, 1e6},
    {"focus_distance", PPMI_SETUP_REAL, FIELD(focus_distance), 1e-6, 1e15},
    {"focus_node", PPMI_SETUP_TEXT, FIELD(focus_node)},
    {"shift", PPMI_SETUP_REALS, FIELD(shift), -100, 100, .count = 2},
};
#undef FIELD
enum { KEY_COUNT = sizeof keys / sizeof keys[0] };

/* ---- the picture's size, and the lens -------------------------------------------------------- */

static ppm_status read_orthographic(const ppmi_setup_value *camera, const camera_words *words,
                                    uint64_t given, ppm_camera_desc *desc)
{
    const ppm_status status =
        ppmi_setup_check_none(camera, keys, KEY_COUNT, given, PERSPECTIVE_ONLY,
                              "not of an orthographic camera, which has \"width\" and \"height\"");
    if (status != PPM_STATUS_OK) return status;
    if (!(given & WIDTH) || !(given & HEIGHT)) {
        return ppmi_setup_fail(camera, "an orthographic camera needs \"width\" and \"height\": "
                                       "what it sees, in metres");
    }
    desc->half_width_m = (float)(0.5 * words->width);
    desc->half_height_m = (float)(0.5 * words->height);
    return PPM_STATUS_OK;
}

/* The scene's f-number is that of a sensor whose longer side is 36 mm: the lens keeps its diameter.
 */
static ppm_status read_perspective(const ppmi_setup_value *camera, const camera_words *words,
                                   uint64_t given, ppm_camera_desc *desc)
{
    ppm_status status =
        ppmi_setup_check_none(camera, keys, KEY_COUNT, given, WIDTH | HEIGHT,
                              "of an orthographic camera only; expected \"fov\" or \"focal_mm\"");
    if (status == PPM_STATUS_OK) {
        status = ppmi_setup_check_one(camera, keys, KEY_COUNT, given, FOV | FOCAL, false);
    }
    if (status == PPM_STATUS_OK && given & FOV) {
        status = ppmi_setup_check_none(camera, keys, KEY_COUNT, given, SENSOR,
                                       "belongs to \"focal_mm\", which is not there");
    }
    if (status != PPM_STATUS_OK) return status;
    const double *sensor = words->sensor_mm;
    desc->y_fov_rad = given & FOV ? (float)(words->fov * PI / 180.0)
                                  : (float)(2.0 * atan(0.5 * sensor[1] / words->focal_mm));
    if (given & SENSOR) desc->aspect = (float)(sensor[0] / sensor[1]);
    if (given & ASPECT) desc->aspect = (float)words->aspect;
    if (given & F_NUMBER) {
        desc->f_number = (float)(words->f_number * 36.0 / fmax(sensor[0], sensor[1]));
    }
    if (given & FOCUS_DISTANCE) desc->focus_distance_m = (float)words->focus_distance;
    return ppmi_setup_check_one(camera, keys, KEY_COUNT, given, FOCUS_DISTANCE | FOCUS_NODE, true);
}

static ppm_status read_camera(const ppmi_setup_value *camera, camera_words *words,
                              ppm_camera_desc *desc)
{
    uint64_t given = 0;
    *words = (camera_words){.sensor_mm = {36.0, 24.0}};
    *desc = (ppm_camera_desc){.size = sizeof *desc};
    ppm_status status = ppmi_setup_read_object(camera, keys, KEY_COUNT, words, &given);
    if (status != PPM_STATUS_OK) return status;
    desc->name = words->name ? words->name : "setup";
    desc->kind = words->kind;
    desc->shift[0] = (float)words->shift[0];
    desc->shift[1] = (float)words->shift[1];
    status = ppmi_setup_pose_transform(camera, &words->pose, given, true, true, desc->transform);
    if (status != PPM_STATUS_OK) return status;
    return words->kind == PPM_CAMERA_ORTHOGRAPHIC ? read_orthographic(camera, words, given, desc)
                                                  : read_perspective(camera, words, given, desc);
}

/* ---- focus ----------------------------------------------------------------------------------- */

static const char *instance_name(const ppm_scene *scene, uint32_t id)
{
    return ppm_scene_instance_name(scene, id);
}

/* The middle of the box around all nodes of that name, along the camera's axis. */
static ppm_status focus_on_node(const ppmi_setup_value *camera, const char *name,
                                ppm_camera_desc *desc)
{
    ppm_scene *scene = camera->setup->scene;
    const ppmi_setup_value place =
        ppmi_setup_member(camera, "focus_node", json_object_get(camera->json, "focus_node"));
    const uint32_t count = ppm_scene_instance_count(scene);
    double low[3] = {0}, high[3] = {0}, distance = 0.0;
    bool is_found = false;
    for (ppm_instance_id id = 1; id <= count; id++) {
        float min[3], max[3];
        if (strcmp(ppm_scene_instance_name(scene, id), name) != 0) continue;
        if (ppm_scene_instance_bounds(scene, id, min, max) != PPM_STATUS_OK) continue;
        for (int i = 0; i < 3; i++) {
            low[i] = is_found ? fmin(low[i], min[i]) : min[i];
            high[i] = is_found ? fmax(high[i], max[i]) : max[i];
        }
        is_found = true;
    }
    if (!is_found) return ppmi_setup_no_such(&place, "node with a surface", instance_name, count);
    double back[3], length = 0.0;
    for (int i = 0; i < 3; i++) {
        back[i] = desc->transform[8 + i];
        length += back[i] * back[i];
    }
    for (int i = 0; i < 3; i++) {
        distance -= back[i] / sqrt(length) * (0.5 * (low[i] + high[i]) - desc->transform[12 + i]);
    }
    if (!(distance >= 1e-6)) {
        return ppmi_setup_fail(&place, "\"%s\" is at %g m along the camera's axis, not before it",
                               name, distance);
    }
    desc->focus_distance_m = (float)distance;
    return PPM_STATUS_OK;
}

ppm_status ppmi_setup_camera_section(const ppmi_setup_value *camera)
{
    camera_words words;
    ppm_camera_desc desc;
    ppm_camera_id id = 0;
    ppm_setup *setup = camera->setup;
    ppm_status status = read_camera(camera, &words, &desc);
    if (status != PPM_STATUS_OK || !setup->scene) return status;
    if (words.focus_node) status = focus_on_node(camera, words.focus_node, &desc);
    if (status == PPM_STATUS_OK) status = ppm_scene_add_camera(setup->scene, &desc, &id);
    if (status == PPM_STATUS_OK && setup->first_camera == 0) setup->first_camera = id;
    if (status == PPM_STATUS_INVALID_ARGUMENT) {
        return ppmi_setup_fail(camera, "see the message above");
    }
    return status;
}
