/* Cameras, and punctual lights (KHR_lights_punctual). One that is invalid is left out with a
 * warning: the rest of the scene can be shown. Light units: docs/light-units.md. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_placement.h"
#include "gltf/gltf_pose.h"
#include "gltf/gltf_reader.h"

#define PI 3.14159265358979323846
/* what Blender's exporter takes for the luminous efficacy of a watt */
#define LUMENS_PER_WATT 683.0

/* The item's own name, else the node's. */
static const char *choose_name(const char *own, const char *node, char *buffer, size_t size)
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

/* The place and the direction (+Z to the back, +Y up as far as it goes) of a node, without scale,
 * so that tiny and huge scales do no harm. Where only the place matters, nothing else is needed.
 * NULL when it went well. */
static const char *rigid_transform(const double world[16], bool has_direction, float out[16])
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
        if (!(fabs(world[12 + i]) < 1e30)) return "it is too far away";
        out[i] = (float)right[i];
        out[4 + i] = (float)up[i];
        out[8 + i] = (float)back[i];
        out[12 + i] = (float)world[12 + i];
    }
    out[3] = out[7] = out[11] = 0.0f;
    out[15] = 1.0f;
    return NULL;
}

static const char *camera_fault(const ppmi_gltf_camera *camera)
{
    if (camera->is_orthographic) {
        const bool ok = fabs(camera->x_mag) > 1e-30 && fabs(camera->y_mag) > 1e-30;
        return ok ? NULL : "xmag and ymag must not be 0";
    }
    if (!(camera->y_fov_rad > 0.0 && camera->y_fov_rad < PI)) return "yfov must be in 0 .. pi";
    return camera->aspect < 0.0 ? "aspectRatio must be above 0" : NULL;
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
    ppm_camera_desc desc = {.size = sizeof desc,
                            .name = choose_name(camera->name, from->name, name, sizeof name),
                            .kind = camera->is_orthographic ? PPM_CAMERA_ORTHOGRAPHIC
                                                            : PPM_CAMERA_PERSPECTIVE,
                            .y_fov_rad = (float)camera->y_fov_rad,
                            .half_width_m = (float)fabs(camera->x_mag),
                            .half_height_m = (float)fabs(camera->y_mag),
                            .aspect = (float)camera->aspect};
    const char *fault = camera_fault(camera);
    for (uint32_t i = 0; i < steps && !fault; ++i) {
        fault = rigid_transform(ppmi_gltf_pose_world(reader->pose, node, i, steps), true,
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

int32_t ppmi_gltf_light_units(const ppmi_gltf_reader *reader)
{
    if (reader->options->light_units != PPM_LIGHT_UNITS_AUTO) return reader->options->light_units;
    return reader->from_blender ? PPM_LIGHT_UNITS_BLENDER : PPM_LIGHT_UNITS_GLTF;
}

/* From the file's number to candela or lux. */
static double unit_factor(const ppmi_gltf_reader *reader, int32_t kind)
{
    switch (ppmi_gltf_light_units(reader)) {
    case PPM_LIGHT_UNITS_BLENDER:
        return 1.0 / LUMENS_PER_WATT;
    case PPM_LIGHT_UNITS_RAW:
        return kind == PPMI_GLTF_LIGHT_DIRECTIONAL ? 1.0 : 0.25 / PI;
    default:
        return 1.0;
    }
}

static const char *light_fault(const ppmi_gltf_light *light)
{
    if (!(light->intensity >= 0.0)) return "intensity must not be negative";
    for (int i = 0; i < 3; ++i) {
        if (!(light->color[i] >= 0.0 && light->color[i] * light->intensity < 1e18)) {
            return "color must not be negative, nor the product with intensity that large";
        }
    }
    if (light->kind != PPMI_GLTF_LIGHT_SPOT) return NULL;
    if (!(light->inner_cone_rad >= 0.0)) return "innerConeAngle must not be negative";
    /* a little above for pi/2 in single precision */
    if (!(light->outer_cone_rad > 0.0 && light->outer_cone_rad <= 0.5 * PI + 1e-5)) {
        return "outerConeAngle must be in 0 .. pi/2";
    }
    /* equal is against the letter of the extension; Blender writes it for a blend of 0 */
    if (light->inner_cone_rad > light->outer_cone_rad) {
        return "innerConeAngle must be less than outerConeAngle";
    }
    return NULL;
}

ppm_status ppmi_gltf_add_light(ppmi_gltf_reader *reader, int32_t node, const double world[16])
{
    static const int32_t kinds[] = {[PPMI_GLTF_LIGHT_POINT] = PPM_LIGHT_POINT,
                                    [PPMI_GLTF_LIGHT_SPOT] = PPM_LIGHT_SPOT,
                                    [PPMI_GLTF_LIGHT_DIRECTIONAL] = PPM_LIGHT_DIRECTIONAL};
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    char place[PPMI_GLTF_PLACE], name[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d].extensions.KHR_lights_punctual.light", (int)node);
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_LIGHTS, from->light, place)) return PPM_STATUS_OK;
    const ppmi_gltf_light *light = &reader->document->lights[from->light];
    const double seen = reader->pose->is_visible[node] ? 1.0 : 0.0;
    const double factor = seen * light->intensity * unit_factor(reader, light->kind);
    ppm_light_desc desc = {.size = sizeof desc,
                           .name = choose_name(light->name, from->name, name, sizeof name),
                           .kind = kinds[light->kind],
                           .inner_cone_rad = (float)light->inner_cone_rad,
                           .outer_cone_rad = (float)fmin(light->outer_cone_rad, 0.5 * PI)};
    if (light->kind != PPMI_GLTF_LIGHT_SPOT) desc.inner_cone_rad = desc.outer_cone_rad = 0.0f;
    for (int i = 0; i < 3; ++i) {
        desc.intensity[i] = (float)(light->color[i] * factor);
    }
    const char *fault = light_fault(light);
    if (!fault) {
        fault = rigid_transform(world, light->kind != PPMI_GLTF_LIGHT_POINT, desc.transform);
    }
    if (fault) {
        ppmi_gltf_warn(reader, place, "left out: lights[%d]: %s", (int)from->light, fault);
        return ppmi_gltf_darken_light(reader, node);
    }
    reader->tally.punctual_lights++;
    return ppmi_gltf_put_light(reader, node, &desc);
}
