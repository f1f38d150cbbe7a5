/* Where a camera or a light is: by position and target or direction, or by a matrix. */
#include <math.h>

#include "setup/setup_file.h"

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalize(double v[3])
{
    const double length = sqrt(dot(v, v));
    if (!(length > 1e-30)) return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

/* A place in the file's coordinates, in those of the scene. */
static void to_scene(const ppmi_setup_value *object, const double place[3], double out[3])
{
    ppm_scene_get_origin(object->setup->scene, out);
    for (int i = 0; i < 3; i++)
        out[i] = place[i] - out[i];
}

static void store_matrix(const double right[3], const double up[3], const double back[3],
                         const double origin[3], float out[16])
{
    const double *const columns[4] = {right, up, back, origin};
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++)
            out[4 * i + k] = (float)columns[i][k];
        out[4 * i + 3] = i == 3 ? 1.0f : 0.0f;
    }
}

/* The axes of something that looks along forward. Straight up or down, north (-Z) is the upper
 * side, as on a map, unless the file says what is up. */
static ppm_status look_along(const ppmi_setup_value *object, const ppmi_setup_pose *pose,
                             uint64_t given, const double forward[3], float out[16])
{
    double back[3] = {-forward[0], -forward[1], -forward[2]}, right[3], up[3];
    const double standard[2][3] = {{0.0, 1.0, 0.0}, {0.0, 0.0, -1.0}};
    if (!normalize(back)) {
        return ppmi_setup_fail(object, "it has no direction: the target is at the position, or the "
                                       "direction is zero");
    }
    const bool is_vertical = fabs(back[1]) > 1.0 - 1e-9;
    const double *hint = given & PPMI_SETUP_UP ? pose->up : standard[is_vertical ? 1 : 0];
    cross(hint, back, right);
    if (!normalize(right)) {
        return ppmi_setup_fail(object, "\"up\" is zero or along the direction; expected another");
    }
    cross(back, right, up);
    double position[3];
    to_scene(object, pose->position, position);
    store_matrix(right, up, back, position, out);
    return PPM_STATUS_OK;
}

static ppm_status take_matrix(const ppmi_setup_value *object, const ppmi_setup_pose *pose,
                              float out[16])
{
    const double *m = pose->matrix;
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
        return ppmi_setup_fail(object,
                               "\"matrix\": entries 3, 7, 11 and 15 are %g %g %g %g, "
                               "expected 0 0 0 1: columns come one after the other",
                               m[3], m[7], m[11], m[15]);
    }
    double place[3];
    to_scene(object, m + 12, place);
    for (int i = 0; i < 16; i++)
        out[i] = (float)(i >= 12 && i < 15 ? place[i - 12] : m[i]);
    return PPM_STATUS_OK;
}

ppm_status ppmi_setup_pose_transform(const ppmi_setup_value *object, const ppmi_setup_pose *pose,
                                     uint64_t given, bool needs_position, bool needs_direction,
                                     float out_transform[16])
{
    const uint64_t others =
        PPMI_SETUP_POSITION | PPMI_SETUP_TARGET | PPMI_SETUP_DIRECTION | PPMI_SETUP_UP;
    const bool has_target = given & PPMI_SETUP_TARGET;
    double forward[3] = {0.0, 0.0, -1.0};
    if (given & PPMI_SETUP_MATRIX) {
        if (!(given & others)) return take_matrix(object, pose, out_transform);
        return ppmi_setup_fail(object, "\"matrix\" says all of position, target, direction and up; "
                                       "expected either it or them");
    }
    if ((needs_position || has_target) && !(given & PPMI_SETUP_POSITION)) {
        return ppmi_setup_fail(object, "no \"position\" and no \"matrix\"; expected one of them");
    }
    if (has_target && given & PPMI_SETUP_DIRECTION) {
        return ppmi_setup_fail(object, "both \"target\" and \"direction\" found, expected one");
    }
    if (!has_target && !(given & PPMI_SETUP_DIRECTION) && needs_direction) {
        return ppmi_setup_fail(object, "no \"target\", \"direction\" or \"matrix\"; expected one");
    }
    for (int i = 0; i < 3; i++) {
        if (has_target) forward[i] = pose->target[i] - pose->position[i];
        if (given & PPMI_SETUP_DIRECTION) forward[i] = pose->direction[i];
    }
    return look_along(object, pose, given, forward, out_transform);
}
