// Cameras and lights, of all extensions and extras: from tinygltf to plain structs.
#include "gltf/gltf_shim_parts.hpp"

namespace ppmi_gltf
{
namespace
{
// A boolean; Blender writes a checkbox as 0 or 1, or as one. -1: neither.
int switch_of(const Value &value)
{
    if (value.IsBool()) return value.Get<bool>() ? 1 : 0;
    if (value.IsNumber()) return value.GetNumberAsDouble() != 0.0 ? 1 : 0;
    return -1;
}

// extras of a light or a node that carries one.
ppmi_gltf_lamp_extras copy_lamp_extras(const Value &extras)
{
    ppmi_gltf_lamp_extras out = {
        number_or(extras, "ppm_radius", -1.0), number_or(extras, "ppm_angle", -1.0),
        switch_of(member(extras, "ppm_visible")), number_or(extras, "ppm_blend", -1.0),
        text_or_empty(extras, "ppm_light_group")};
    return out;
}

ppmi_gltf_area_extras copy_area_extras(const Value &area)
{
    ppmi_gltf_area_extras out = {};
    out.is_given = area.IsObject();
    out.shape = text_or_empty(area, "shape");
    numbers_or(area, "size", out.size, 2, number_or(area, "size", 0.0));
    out.radiance = number_or(area, "radiance", -1.0);
    out.power_w = number_or(area, "power_w", -1.0);
    numbers_or(area, "color", out.color, 3, 1.0);
    return out;
}

// Nine rows of three numbers; false for anything else.
bool copy_irradiance(const Value &from, double out[9][3])
{
    const Value &rows = member(from, "irradianceCoefficients");
    if (!rows.IsArray() || rows.ArrayLen() != 9) return false;
    for (int i = 0; i < 9; ++i) {
        const Value &row = rows.Get(i);
        if (!row.IsArray() || row.ArrayLen() != 3) return false;
        for (int k = 0; k < 3; ++k) {
            if (!row.Get(k).IsNumber()) return false;
            out[i][k] = row.Get(k).GetNumberAsDouble();
        }
    }
    return true;
}
} // namespace

void copy_node_lights(const tinygltf::Node &from, ppmi_gltf_node *out)
{
    const Value &ies = extension(from.extensions, "EXT_lights_ies");
    out->light = index_or(extension(from.extensions, "KHR_lights_punctual"), "light", -1);
    out->area_light = index_or(extension(from.extensions, "EXT_lights_area"), "light", -1);
    out->profile = index_or(ies, "light", -1);
    out->profile_factor = number_or(ies, "multiplier", 1.0);
    numbers_or(ies, "color", out->profile_color, 3, 1.0);
    out->lamp = copy_lamp_extras(from.extras);
    out->is_catcher = switch_of(member(from.extras, "ppm_catcher")) == 1;
    out->area = copy_area_extras(member(from.extras, "ppm_area"));
}

ppmi_gltf_camera copy_camera(const tinygltf::Camera &from)
{
    const bool is_orthographic = from.type == "orthographic";
    ppmi_gltf_camera out = {from.name.c_str(),
                            is_orthographic,
                            from.perspective.yfov,
                            from.perspective.aspectRatio,
                            from.orthographic.xmag,
                            from.orthographic.ymag,
                            is_orthographic ? from.orthographic.znear : from.perspective.znear,
                            is_orthographic ? from.orthographic.zfar : from.perspective.zfar,
                            {0.0, 0.0},
                            false,
                            0.0,
                            {0.0, 0.0},
                            0.0,
                            0.0};
    numbers_or(from.extras, "ppm_shift", out.shift, 2, 0.0);
    const auto physical = from.extensions.find("EXT_camera_physical");
    if (physical == from.extensions.end()) return out;
    out.is_physical = true;
    out.focal_length_m = number_or(physical->second, "focalLength", 0.0);
    numbers_or(physical->second, "sensorSize", out.sensor_m, 2, 0.0);
    out.f_stop = number_or(physical->second, "fStop", 0.0);
    out.focus_distance_m = number_or(physical->second, "focusDistance", 0.0);
    return out;
}

ppmi_gltf_light copy_light(const tinygltf::Light &from)
{
    ppmi_gltf_light out = {};
    out.name = from.name.c_str();
    out.kind = from.type == "spot"          ? PPMI_GLTF_LIGHT_SPOT
               : from.type == "directional" ? PPMI_GLTF_LIGHT_DIRECTIONAL
                                            : PPMI_GLTF_LIGHT_POINT;
    copy_numbers(from.color, out.color, 3, 1.0);
    out.intensity = from.intensity;
    out.inner_cone_rad = from.spot.innerConeAngle;
    out.outer_cone_rad = from.spot.outerConeAngle;
    out.range_m = from.range;
    out.lamp = copy_lamp_extras(from.extras);
    return out;
}

ppmi_gltf_area_light copy_area_light(const Value &from)
{
    ppmi_gltf_area_light out = {};
    out.name = text_or_empty(from, "name");
    out.is_disk = std::string(text_or_empty(from, "type")) == "disk";
    numbers_or(from, "color", out.color, 3, 1.0);
    out.intensity = number_or(from, "intensity", 1000.0);
    out.size = number_or(from, "size", 1.0);
    out.aspect = number_or(member(from, "rect"), "aspect", 1.0);
    out.lamp = copy_lamp_extras(member(from, "extras"));
    return out;
}

ppmi_gltf_light_profile copy_profile(const Value &from)
{
    const Value &uri = member(from, "uri");
    return {text_or_empty(from, "name"), text_or_empty(from, "uri"),
            uri.IsString() ? uri.Get<std::string>().size() : 0, index_or(from, "bufferView", -1)};
}

ppmi_gltf_image_light copy_image_light(const Value &from)
{
    ppmi_gltf_image_light out = {};
    out.name = text_or_empty(from, "name");
    out.intensity = number_or(from, "intensity", 1.0);
    out.rotation[3] = 1.0;
    if (member(from, "rotation").IsArray()) numbers_or(from, "rotation", out.rotation, 4, 0.0);
    const Value &levels = member(from, "specularImages");
    const Value none, &faces = levels.IsArray() && levels.ArrayLen() > 0 ? levels.Get(0) : none;
    out.has_faces = faces.IsArray() && faces.ArrayLen() == 6;
    for (int i = 0; i < 6; ++i) {
        const bool is_index = out.has_faces && faces.Get(i).IsInt();
        out.faces[i] = is_index ? faces.Get(i).GetNumberAsInt() : -1;
    }
    out.has_irradiance = copy_irradiance(from, out.irradiance);
    return out;
}

ppmi_gltf_cubemap copy_cubemap(const Value &from)
{
    return {index_or(from, "source", -1), index_or(from, "layer", 0),
            number_or(from, "intensity", 1.0)};
}

ppmi_gltf_environment_map copy_environment_map(const Value &from)
{
    ppmi_gltf_environment_map out = {};
    out.cubemap = index_or(from, "cubemap", -1);
    out.has_box =
        member(from, "boundingBoxMin").IsArray() || member(from, "boundingBoxMax").IsArray();
    out.has_other_ior = number_or(from, "ior", 1.0) != 1.0;
    out.has_irradiance = copy_irradiance(from, out.irradiance);
    out.irradiance_factor = number_or(from, "irradianceFactor", 1.0);
    return out;
}
} // namespace ppmi_gltf
