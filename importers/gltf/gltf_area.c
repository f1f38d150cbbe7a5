/* Area lights: EXT_lights_area (draft), and extras.ppm_area for tools that write no area lights:
 * Blender's exporter leaves the node of one as an empty one (docs/light-units.md). */
#include <math.h>
#include <string.h>

#include "gltf/gltf_belong.h"
#include "gltf/gltf_light.h"
#include "gltf/gltf_placement.h"
#include "gltf/gltf_rigid.h"

#define PI 3.14159265358979323846

static double column_length(const double world[16], int column)
{
    return hypot(hypot(world[4 * column], world[4 * column + 1]), world[4 * column + 2]);
}

/* Sizes that the scene takes, in metres. */
static const char *set_size(double width, double height, ppm_light_desc *desc)
{
    const double least = 1.001e-6, most = 1e15;
    if (!(width >= least && height >= least && width < most && height < most)) {
        return "its size must be within 1e-6 .. 1e15 m";
    }
    desc->width_m = (float)width;
    desc->height_m = (float)height;
    return NULL;
}

static ppm_status add(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_light_way way,
                      const char *place, const char *fault, const double world[16],
                      ppm_light_desc *desc)
{
    if (!fault) fault = ppmi_gltf_rigid_transform(world, true, desc->transform);
    if (fault) {
        ppmi_gltf_warn(reader, place, "left out: %s", fault);
        return ppmi_gltf_darken_light(reader, node, way);
    }
    return ppmi_gltf_put_light(reader, node, way, desc);
}

/* The draft scales both sides by the largest component of the node's scale. */
ppm_status ppmi_gltf_add_area_light(ppmi_gltf_reader *reader, int32_t node, const double world[16])
{
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    char place[PPMI_GLTF_PLACE], name[PPMI_GLTF_PLACE], group[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d].extensions.EXT_lights_area.light", (int)node);
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_AREA_LIGHTS, from->area_light, place)) {
        return PPM_STATUS_OK;
    }
    const ppmi_gltf_area_light *light = &reader->document->area_lights[from->area_light];
    const ppmi_gltf_lamp_extras extras = ppmi_gltf_merge_extras(&light->lamp, &from->lamp);
    const double scale =
        fmax(fmax(column_length(world, 0), column_length(world, 1)), column_length(world, 2));
    const double height = light->size * scale;
    ppm_light_desc desc = {
        .size = sizeof desc,
        .name = ppmi_gltf_choose_name(light->name, from->name, name, sizeof name),
        .kind = light->is_disk ? PPM_LIGHT_DISK : PPM_LIGHT_RECTANGLE,
        .is_hidden = ppmi_gltf_is_hidden(&extras),
        .light_group =
            ppmi_gltf_light_group(reader, node, light->lamp.light_group, group, sizeof group)};
    const char *fault = ppmi_gltf_light_intensity(light->color, light->intensity, desc.intensity);
    if (!fault) fault = set_size(light->is_disk ? height : height * light->aspect, height, &desc);
    return add(reader, node, PPMI_GLTF_WAY_AREA, place, fault, world, &desc);
}

/* ---- extras.ppm_area ------------------------------------------------------------------------- */

static const char *set_shape(const char *shape, ppm_light_desc *desc)
{
    if (strcmp(shape, "rect") == 0 || strcmp(shape, "square") == 0) {
        desc->kind = PPM_LIGHT_RECTANGLE;
    } else if (strcmp(shape, "disk") == 0 || strcmp(shape, "ellipse") == 0) {
        desc->kind = PPM_LIGHT_DISK;
    } else {
        return "shape must be rect, square, disk or ellipse";
    }
    return NULL;
}

/* A Lambertian lamp of flux P and area A has the radiance P / (pi A). */
static const char *set_strength(const ppmi_gltf_reader *reader, const ppmi_gltf_area_extras *area,
                                ppm_light_desc *desc)
{
    double surface = (double)desc->width_m * (double)desc->height_m;
    if (desc->kind == PPM_LIGHT_DISK) surface *= 0.25 * PI;
    if ((area->radiance < 0.0) == (area->power_w < 0.0)) {
        return "it needs either radiance or power_w, at least 0";
    }
    double radiance = area->radiance;
    if (area->power_w >= 0.0) {
        radiance =
            area->power_w * ppmi_gltf_watt_factor(ppmi_gltf_light_units(reader)) / (PI * surface);
    }
    return ppmi_gltf_light_intensity(area->color, radiance, desc->intensity);
}

/* As Blender's lamps are, the shape is scaled with its node. */
ppm_status ppmi_gltf_add_area_extras(ppmi_gltf_reader *reader, int32_t node, const double world[16])
{
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    const ppmi_gltf_area_extras *area = &from->area;
    char place[PPMI_GLTF_PLACE], name[PPMI_GLTF_PLACE], group[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d].extras.ppm_area", (int)node);
    ppm_light_desc desc = {.size = sizeof desc,
                           .name = ppmi_gltf_choose_name(from->name, "", name, sizeof name),
                           .is_hidden = ppmi_gltf_is_hidden(&from->lamp),
                           .light_group =
                               ppmi_gltf_light_group(reader, node, "", group, sizeof group)};
    const char *fault = set_shape(area->shape, &desc);
    if (!fault) {
        fault = set_size(area->size[0] * column_length(world, 0),
                         area->size[1] * column_length(world, 1), &desc);
    }
    if (!fault) fault = set_strength(reader, area, &desc);
    if (!fault && area->power_w >= 0.0) reader->tally.punctual_lights++;
    return add(reader, node, PPMI_GLTF_WAY_EXTRAS, place, fault, world, &desc);
}
