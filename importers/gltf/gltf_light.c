/* Punctual lights (KHR_lights_punctual), and what all lights share. One that is invalid is left out
 * with a warning: the rest of the scene can be shown. Light units: docs/light-units.md. */
#include "gltf/gltf_light.h"

#include <math.h>

#include "gltf/gltf_belong.h"
#include "gltf/gltf_placement.h"
#include "gltf/gltf_rigid.h"

#define PI 3.14159265358979323846

int32_t ppmi_gltf_light_units(const ppmi_gltf_reader *reader)
{
    if (reader->options->light_units != PPM_LIGHT_UNITS_AUTO) return reader->options->light_units;
    const ppmi_gltf_unit_row *row = ppmi_gltf_find_units(reader->document->generator);
    return row ? row->units : PPM_LIGHT_UNITS_GLTF;
}

ppmi_gltf_lamp_extras ppmi_gltf_merge_extras(const ppmi_gltf_lamp_extras *own,
                                             const ppmi_gltf_lamp_extras *node)
{
    ppmi_gltf_lamp_extras merged = *own;
    if (merged.radius_m < 0.0) merged.radius_m = node->radius_m;
    if (merged.angle_rad < 0.0) merged.angle_rad = node->angle_rad;
    if (merged.visible < 0) merged.visible = node->visible;
    if (merged.blend < 0.0) merged.blend = node->blend;
    return merged;
}

uint32_t ppmi_gltf_is_hidden(const ppmi_gltf_lamp_extras *extras)
{
    return extras->visible != 1;
}

const char *ppmi_gltf_light_intensity(const double color[3], double factor, float out[3])
{
    if (!(factor >= 0.0)) return "intensity must not be negative";
    for (int i = 0; i < 3; ++i) {
        const double value = color[i] * factor;
        if (!(color[i] >= 0.0 && value < 1e18)) {
            return "color must not be negative, nor the product with intensity that large";
        }
        out[i] = (float)value;
    }
    return NULL;
}

/* ---- KHR_lights_punctual --------------------------------------------------------------------- */

static const char *spot_fault(const ppmi_gltf_light *light)
{
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

/* ppm_radius and ppm_angle; what is out of range is left out, not the light. */
static void apply_extras(ppmi_gltf_reader *reader, const char *place,
                         const ppmi_gltf_lamp_extras *extras, ppm_light_desc *desc)
{
    desc->is_hidden = ppmi_gltf_is_hidden(extras);
    if (desc->kind == PPM_LIGHT_DIRECTIONAL) {
        if (extras->angle_rad < 0.0) return;
        desc->angular_radius_rad = (float)(0.5 * extras->angle_rad);
        if (extras->angle_rad < PI - 1e-4) return;
        desc->angular_radius_rad = 0.0f;
        ppmi_gltf_warn(reader, place, "extras.ppm_angle %g left out: it must be in 0 .. pi",
                       extras->angle_rad);
        return;
    }
    if (extras->radius_m < 0.0) return;
    desc->radius_m = (float)extras->radius_m;
    if (extras->radius_m < 1e15) return;
    desc->radius_m = 0.0f;
    ppmi_gltf_warn(reader, place, "extras.ppm_radius %g left out: it is too large",
                   extras->radius_m);
}

static void count_light(ppmi_gltf_reader *reader, const ppmi_gltf_light *light)
{
    const ppmi_gltf_unit_row *row = ppmi_gltf_find_units(reader->document->generator);
    const bool is_sun = light->kind == PPMI_GLTF_LIGHT_DIRECTIONAL;
    const double default_sun = 683.0;
    reader->tally.punctual_lights++;
    if (row && row->suns_are_doubtful && is_sun && light->intensity == default_sun) {
        reader->tally.doubtful_suns++;
    }
}

static ppm_status add_punctual(ppmi_gltf_reader *reader, int32_t node, const double world[16])
{
    static const int32_t kinds[] = {[PPMI_GLTF_LIGHT_POINT] = PPM_LIGHT_POINT,
                                    [PPMI_GLTF_LIGHT_SPOT] = PPM_LIGHT_SPOT,
                                    [PPMI_GLTF_LIGHT_DIRECTIONAL] = PPM_LIGHT_DIRECTIONAL};
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    char place[PPMI_GLTF_PLACE], name[PPMI_GLTF_PLACE], group[PPMI_GLTF_PLACE];
    ppmi_gltf_place(place, "nodes[%d].extensions.KHR_lights_punctual.light", (int)node);
    if (!ppmi_gltf_accept(reader, PPMI_GLTF_LIGHTS, from->light, place)) return PPM_STATUS_OK;
    const ppmi_gltf_light *light = &reader->document->lights[from->light];
    const double factor = ppmi_gltf_unit_factor(ppmi_gltf_light_units(reader), light->kind);
    ppm_light_desc desc = {.size = sizeof desc,
                           .name =
                               ppmi_gltf_choose_name(light->name, from->name, name, sizeof name),
                           .kind = kinds[light->kind],
                           .inner_cone_rad = (float)light->inner_cone_rad,
                           .outer_cone_rad = (float)fmin(light->outer_cone_rad, 0.5 * PI)};
    if (light->kind != PPMI_GLTF_LIGHT_SPOT) desc.inner_cone_rad = desc.outer_cone_rad = 0.0f;
    const char *fault =
        ppmi_gltf_light_intensity(light->color, light->intensity * factor, desc.intensity);
    if (!fault) fault = spot_fault(light);
    if (!fault) {
        fault =
            ppmi_gltf_rigid_transform(world, light->kind != PPMI_GLTF_LIGHT_POINT, desc.transform);
    }
    if (fault) {
        ppmi_gltf_warn(reader, place, "left out: lights[%d]: %s", (int)from->light, fault);
        return ppmi_gltf_darken_light(reader, node, PPMI_GLTF_WAY_PUNCTUAL);
    }
    const ppmi_gltf_lamp_extras extras = ppmi_gltf_merge_extras(&light->lamp, &from->lamp);
    apply_extras(reader, place, &extras, &desc);
    desc.light_group =
        ppmi_gltf_light_group(reader, node, light->lamp.light_group, group, sizeof group);
    const ppm_status status = ppmi_gltf_blend_spot(reader, place, extras.blend, &desc);
    if (status != PPM_STATUS_OK) return status;
    count_light(reader, light);
    return ppmi_gltf_put_light(reader, node, PPMI_GLTF_WAY_PUNCTUAL, &desc);
}

ppm_status ppmi_gltf_add_lights(ppmi_gltf_reader *reader, int32_t node, const double world[16])
{
    const ppmi_gltf_node *from = &reader->document->nodes[node];
    ppm_status status = PPM_STATUS_OK;
    if (from->light >= 0) status = add_punctual(reader, node, world);
    if (status == PPM_STATUS_OK && from->area_light >= 0) {
        status = ppmi_gltf_add_area_light(reader, node, world);
    }
    if (status == PPM_STATUS_OK && from->profile >= 0) {
        status = ppmi_gltf_add_ies_light(reader, node, world);
    }
    if (status == PPM_STATUS_OK && from->area.is_given) {
        status = ppmi_gltf_add_area_extras(reader, node, world);
    }
    return status;
}

/* ---- the report ------------------------------------------------------------------------------ */

void ppmi_gltf_report_lights(const ppmi_gltf_reader *reader)
{
    static const char *const readings[] = {
        [PPM_LIGHT_UNITS_GLTF] = "candela and lux as written",
        [PPM_LIGHT_UNITS_BLENDER] = "divided by 683 lm/W, as Blender's Cycles shows them",
        [PPM_LIGHT_UNITS_RAW] = "watts as Blender's raw mode writes them"};
    const ppmi_gltf_tally *tally = &reader->tally;
    const ppmi_gltf_unit_row *row = ppmi_gltf_find_units(reader->document->generator);
    const bool is_auto = reader->options->light_units == PPM_LIGHT_UNITS_AUTO;
    if (tally->punctual_lights == 0) return;
    ppmi_log(reader->context, PPM_LOG_INFO,
             "%s: %zu punctual light%s: %s (%s%s); --light-units gltf|blender|raw changes it",
             reader->path, tally->punctual_lights, tally->punctual_lights == 1 ? "" : "s",
             readings[ppmi_gltf_light_units(reader)], is_auto ? "asset.generator is " : "",
             !is_auto ? "asked for"
             : row    ? row->versions
                      : "not Blender's exporter");
    if (tally->doubtful_suns > 0) {
        ppmi_log(
            reader->context, PPM_LOG_WARNING,
            "%s: %zu suns of 683 lux: Blender 5.0 to 5.1.1 writes that whatever their strength "
            "is (docs/light-units.md)",
            reader->path, tally->doubtful_suns);
    }
}
