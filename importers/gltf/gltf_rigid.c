/* Cameras and lights on nodes: their names, and transforms without scale. */
#include "gltf/gltf_rigid.h"

#include <math.h>
#include <string.h>

const char *ppmi_gltf_choose_name(const char *own, const char *node, char *buffer, size_t size)
{
    const char *name = own[0] ? own : node;
    return ppmi_gltf_printable(name, strlen(name), buffer, size);
}

static bool normalize(const double v[3], double out[3])
{
    const double length = hypot(hypot(v[0], v[1]), v[2]);
    for (int i = 0; i < 3; ++i) {
        out[i] = v[i] / length;
    }
    return length > 0.0 && isfinite(length);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

const char *ppmi_gltf_rigid_transform(const double world[16], bool has_direction, float out[16])
{
    double right[3] = {1.0, 0.0, 0.0}, up[3] = {0.0, 1.0, 0.0}, back[3] = {0.0, 0.0, 1.0};
    if (has_direction) {
        double unit_y[3], side[3];
        if (!normalize(world + 8, back) || !normalize(world + 4, unit_y)) return "zero scale";
        cross(unit_y, back, side);
        if (!normalize(side, right)) return "its axes are parallel";
        cross(back, right, up);
    }
    for (int i = 0; i < 3; ++i) {
        if (!(fabs(world[12 + i]) < 1e15)) return "it is further away than 1e15 m";
        out[i] = (float)right[i];
        out[4 + i] = (float)up[i];
        out[8 + i] = (float)back[i];
        out[12 + i] = (float)world[12 + i];
    }
    out[3] = out[7] = out[11] = 0.0f;
    out[15] = 1.0f;
    return NULL;
}
