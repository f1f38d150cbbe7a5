// Values of a tinygltf document that may be absent, and the parts of its copy that stand in files
// of their own. For the shim's files alone.
#ifndef PPMI_GLTF_SHIM_PARTS_HPP
#define PPMI_GLTF_SHIM_PARTS_HPP

#include <cmath>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "gltf/gltf_shim.h"

namespace ppmi_gltf
{
using tinygltf::Value;

// ---- values: each has an answer for a member that is absent or of another type
// -------------------

// The member of an object; a null value for anything else.
inline const Value &member(const Value &object, const char *key)
{
    static const Value null_value;
    return object.IsObject() ? object.Get(std::string(key)) : null_value;
}

inline const Value &extension(const tinygltf::ExtensionMap &map, const char *name)
{
    static const Value null_value;
    const auto it = map.find(name);
    return it == map.end() ? null_value : it->second;
}

inline double number_or(const Value &object, const char *key, double otherwise)
{
    const Value &value = member(object, key);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

// A size in bytes, up to 2^53; SIZE_MAX for a number that is none.
inline size_t size_or(const Value &object, const char *key, size_t otherwise)
{
    const Value &value = member(object, key);
    if (!value.IsNumber()) return otherwise;
    const double number = value.IsInt() ? value.GetNumberAsInt() : value.GetNumberAsDouble();
    const bool is_size =
        number >= 0.0 && number <= 9007199254740992.0 && number == std::floor(number);
    return is_size ? static_cast<size_t>(number) : SIZE_MAX;
}

inline int32_t index_or(const Value &object, const char *key, int32_t otherwise)
{
    const Value &value = member(object, key);
    return value.IsInt() ? value.GetNumberAsInt() : otherwise;
}

inline void numbers_or(const Value &object, const char *key, double *out, int count,
                       double otherwise)
{
    const Value &value = member(object, key);
    const bool is_given = value.IsArray() && value.ArrayLen() == static_cast<size_t>(count);
    for (int i = 0; i < count; ++i) {
        out[i] = is_given && value.Get(i).IsNumber() ? value.Get(i).GetNumberAsDouble() : otherwise;
    }
}

inline void copy_numbers(const std::vector<double> &from, double *out, size_t count,
                         double otherwise)
{
    for (size_t i = 0; i < count; ++i) {
        out[i] = from.size() == count ? from[i] : otherwise;
    }
}

// The text of a string that lives on in the model; "" for anything else.
inline const char *text_or_empty(const Value &object, const char *key)
{
    const Value &value = member(object, key);
    return value.IsString() ? value.Get<std::string>().c_str() : "";
}

// ---- gltf_shim_material.cpp ---------------------------------------------------------------------

ppmi_gltf_material copy_material(const tinygltf::Material &from);
ppmi_gltf_texture copy_texture(const tinygltf::Texture &from);

// ---- gltf_shim_light.cpp: cameras and lights ----------------------------------------------------

ppmi_gltf_camera copy_camera(const tinygltf::Camera &from);
void copy_node_lights(const tinygltf::Node &from, ppmi_gltf_node *out);
ppmi_gltf_light copy_light(const tinygltf::Light &from);
ppmi_gltf_area_light copy_area_light(const Value &from);
ppmi_gltf_light_profile copy_profile(const Value &from);
ppmi_gltf_image_light copy_image_light(const Value &from);
ppmi_gltf_cubemap copy_cubemap(const Value &from);
ppmi_gltf_environment_map copy_environment_map(const Value &from);
} // namespace ppmi_gltf

#endif
