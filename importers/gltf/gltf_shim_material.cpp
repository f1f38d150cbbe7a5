// Textures and materials: from tinygltf to plain structs.
#include "gltf/gltf_shim_parts.hpp"

namespace ppmi_gltf
{
namespace
{
ppmi_gltf_texture_info texture_info(int index, int uv_set, const Value &transform)
{
    ppmi_gltf_texture_info info = {};
    info.texture = index;
    info.uv_set = index_or(transform, "texCoord", uv_set);
    info.scale = 1.0;
    info.has_transform = transform.IsObject();
    numbers_or(transform, "offset", info.offset, 2, 0.0);
    info.rotation_rad = number_or(transform, "rotation", 0.0);
    numbers_or(transform, "scale", info.uv_scale, 2, 1.0);
    return info;
}

template <typename Info> ppmi_gltf_texture_info core_texture(const Info &info)
{
    return texture_info(info.index, info.texCoord,
                        extension(info.extensions, "KHR_texture_transform"));
}

ppmi_gltf_texture_info extension_texture(const Value &object, const char *key)
{
    const Value &info = member(object, key);
    ppmi_gltf_texture_info out =
        texture_info(index_or(info, "index", -1), index_or(info, "texCoord", 0),
                     member(member(info, "extensions"), "KHR_texture_transform"));
    out.scale = number_or(info, "scale", 1.0);
    return out;
}

void copy_clearcoat_and_sheen(const tinygltf::ExtensionMap &map, ppmi_gltf_layers *out)
{
    const Value &coat = extension(map, "KHR_materials_clearcoat");
    out->clearcoat = number_or(coat, "clearcoatFactor", 0.0);
    out->clearcoat_texture = extension_texture(coat, "clearcoatTexture");
    out->clearcoat_roughness = number_or(coat, "clearcoatRoughnessFactor", 0.0);
    out->clearcoat_roughness_texture = extension_texture(coat, "clearcoatRoughnessTexture");
    out->clearcoat_normal_texture = extension_texture(coat, "clearcoatNormalTexture");

    const Value &sheen = extension(map, "KHR_materials_sheen");
    numbers_or(sheen, "sheenColorFactor", out->sheen_color, 3, 0.0);
    out->sheen_color_texture = extension_texture(sheen, "sheenColorTexture");
    out->sheen_roughness = number_or(sheen, "sheenRoughnessFactor", 0.0);
    out->sheen_roughness_texture = extension_texture(sheen, "sheenRoughnessTexture");
}

void copy_coat(const tinygltf::ExtensionMap &map, ppmi_gltf_coat *out)
{
    const Value &coat = extension(map, "KHR_materials_coat");
    out->is_given = coat.IsObject();
    out->factor = number_or(coat, "coatFactor", 0.0);
    out->texture = extension_texture(coat, "coatTexture");
    out->roughness = number_or(coat, "coatRoughnessFactor", 0.0);
    out->roughness_texture = extension_texture(coat, "coatRoughnessTexture");
    out->normal_texture = extension_texture(coat, "coatNormalTexture");
    out->ior = number_or(coat, "coatIor", 1.5);
    numbers_or(coat, "coatColorFactor", out->color, 3, 1.0);
    out->color_texture = extension_texture(coat, "coatColorTexture");
    out->darkening = number_or(coat, "coatDarkeningFactor", 1.0);
    out->anisotropy = number_or(coat, "coatAnisotropyStrength", 0.0);
    out->anisotropy_rotation_rad = number_or(coat, "coatAnisotropyRotation", 0.0);
    out->anisotropy_texture = extension_texture(coat, "coatAnisotropyTexture");
}

void copy_fuzz(const tinygltf::ExtensionMap &map, ppmi_gltf_fuzz *out)
{
    const Value &fuzz = extension(map, "KHR_materials_fuzz");
    out->is_given = fuzz.IsObject();
    out->factor = number_or(fuzz, "fuzzFactor", 0.0);
    out->texture = extension_texture(fuzz, "fuzzTexture");
    numbers_or(fuzz, "fuzzColorFactor", out->color, 3, 1.0);
    out->color_texture = extension_texture(fuzz, "fuzzColorTexture");
    out->roughness = number_or(fuzz, "fuzzRoughnessFactor", 0.5);
    out->roughness_texture = extension_texture(fuzz, "fuzzRoughnessTexture");
}

// Of retroreflection both the draft of Khronos and the extension that it grew out of.
void copy_highlights(const tinygltf::ExtensionMap &map, ppmi_gltf_layers *out)
{
    const Value &film = extension(map, "KHR_materials_iridescence");
    out->iridescence = number_or(film, "iridescenceFactor", 0.0);
    out->iridescence_texture = extension_texture(film, "iridescenceTexture");
    out->iridescence_ior = number_or(film, "iridescenceIor", 1.3);
    out->iridescence_min_nm = number_or(film, "iridescenceThicknessMinimum", 100.0);
    out->iridescence_max_nm = number_or(film, "iridescenceThicknessMaximum", 400.0);
    out->iridescence_thickness_texture = extension_texture(film, "iridescenceThicknessTexture");

    const Value &anisotropy = extension(map, "KHR_materials_anisotropy");
    out->anisotropy = number_or(anisotropy, "anisotropyStrength", 0.0);
    out->anisotropy_rotation_rad = number_or(anisotropy, "anisotropyRotation", 0.0);
    out->anisotropy_texture = extension_texture(anisotropy, "anisotropyTexture");

    const Value &draft = extension(map, "KHR_materials_retroreflection");
    const Value &retro = draft.IsObject() ? draft : extension(map, "EXT_materials_retroreflection");
    out->retroreflection = number_or(retro, "retroreflectionFactor", 0.0);
    out->retroreflection_texture = extension_texture(retro, "retroreflectionTexture");

    const Value &rough = extension(map, "KHR_materials_diffuse_roughness");
    out->diffuse_roughness = number_or(rough, "diffuseRoughnessFactor", 0.0);
    out->diffuse_roughness_texture = extension_texture(rough, "diffuseRoughnessTexture");
}

// The colour of KHR_materials_volume_scatter has had two names so far. KHR_materials_scatter, which
// is to replace it, has the latter, another default, and a strength.
void copy_scattering(const tinygltf::ExtensionMap &map, ppmi_gltf_scattering *out)
{
    const Value &diffuse = extension(map, "KHR_materials_diffuse_transmission");
    out->diffuse_transmission = number_or(diffuse, "diffuseTransmissionFactor", 0.0);
    out->diffuse_transmission_texture = extension_texture(diffuse, "diffuseTransmissionTexture");
    numbers_or(diffuse, "diffuseTransmissionColorFactor", out->diffuse_transmission_color, 3, 1.0);
    out->diffuse_transmission_color_texture =
        extension_texture(diffuse, "diffuseTransmissionColorTexture");

    const Value &newer = extension(map, "KHR_materials_scatter");
    out->is_scatter = newer.IsObject();
    const Value &scatter = out->is_scatter ? newer : extension(map, "KHR_materials_volume_scatter");
    out->scatter_strength = out->is_scatter ? number_or(newer, "scatterStrengthFactor", 0.0) : 1.0;
    out->scatter_strength_texture = extension_texture(newer, "scatterStrengthTexture");
    const bool is_factor = member(scatter, "multiscatterColorFactor").IsArray();
    numbers_or(scatter, is_factor ? "multiscatterColorFactor" : "multiscatterColor",
               out->multiscatter_color, 3, out->is_scatter ? 1.0 : 0.0);
    out->multiscatter_color_texture = extension_texture(scatter, "multiscatterColorTexture");
    out->scatter_anisotropy = number_or(scatter, "scatterAnisotropy", 0.0);
}

void copy_specular_glossiness(const tinygltf::ExtensionMap &map, ppmi_gltf_specular_glossiness *out)
{
    const Value &from = extension(map, "KHR_materials_pbrSpecularGlossiness");
    out->is_given = from.IsObject();
    numbers_or(from, "diffuseFactor", out->diffuse, 4, 1.0);
    out->diffuse_texture = extension_texture(from, "diffuseTexture");
    numbers_or(from, "specularFactor", out->specular, 3, 1.0);
    out->glossiness = number_or(from, "glossinessFactor", 1.0);
    out->specular_glossiness_texture = extension_texture(from, "specularGlossinessTexture");
}

// KHR_materials_*; the defaults are the extensions'.
void copy_material_extensions(const tinygltf::Material &from, ppmi_gltf_material *out)
{
    const auto &map = from.extensions;
    out->is_unlit = extension(map, "KHR_materials_unlit").IsObject();
    out->emissive_strength =
        number_or(extension(map, "KHR_materials_emissive_strength"), "emissiveStrength", 1.0);
    out->ior = number_or(extension(map, "KHR_materials_ior"), "ior", 1.5);

    const Value &specular = extension(map, "KHR_materials_specular");
    out->specular = number_or(specular, "specularFactor", 1.0);
    out->specular_texture = extension_texture(specular, "specularTexture");
    numbers_or(specular, "specularColorFactor", out->specular_color, 3, 1.0);
    out->specular_color_texture = extension_texture(specular, "specularColorTexture");
    const Value &edge =
        member(member(member(specular, "extensions"), "EXT_materials_specular_edge_color"),
               "specularEdgeColorEnabled");
    out->specular_is_edge_color = edge.IsBool() && edge.Get<bool>();

    const Value &transmission = extension(map, "KHR_materials_transmission");
    out->transmission = number_or(transmission, "transmissionFactor", 0.0);
    out->transmission_texture = extension_texture(transmission, "transmissionTexture");

    const Value &volume = extension(map, "KHR_materials_volume");
    out->thickness = number_or(volume, "thicknessFactor", 0.0);
    out->attenuation_distance = number_or(volume, "attenuationDistance", HUGE_VAL);
    numbers_or(volume, "attenuationColor", out->attenuation_color, 3, 1.0);
    out->dispersion = number_or(extension(map, "KHR_materials_dispersion"), "dispersion", 0.0);
    copy_clearcoat_and_sheen(map, &out->layers);
    copy_highlights(map, &out->layers);
    copy_coat(map, &out->layers.coat);
    copy_fuzz(map, &out->layers.fuzz);
    copy_scattering(map, &out->scattering);
    copy_specular_glossiness(map, &out->specular_glossiness);
}
} // namespace

ppmi_gltf_material copy_material(const tinygltf::Material &from)
{
    ppmi_gltf_material out = {};
    const tinygltf::PbrMetallicRoughness &pbr = from.pbrMetallicRoughness;
    out.name = from.name.c_str();
    copy_numbers(pbr.baseColorFactor, out.base_color, 4, 1.0);
    out.metallic = pbr.metallicFactor;
    out.roughness = pbr.roughnessFactor;
    copy_numbers(from.emissiveFactor, out.emissive, 3, 0.0);
    out.base_color_texture = core_texture(pbr.baseColorTexture);
    out.metallic_roughness_texture = core_texture(pbr.metallicRoughnessTexture);
    out.normal_texture = core_texture(from.normalTexture);
    out.normal_texture.scale = from.normalTexture.scale;
    out.emissive_texture = core_texture(from.emissiveTexture);
    out.alpha_mode = from.alphaMode.c_str();
    out.alpha_cutoff = from.alphaCutoff;
    out.double_sided = from.doubleSided;
    out.has_occlusion = from.occlusionTexture.index >= 0;
    copy_material_extensions(from, &out);
    out.priority = number_or(from.extras, "ppm_priority", 0.0);
    return out;
}

ppmi_gltf_texture copy_texture(const tinygltf::Texture &from)
{
    return {from.source,
            index_or(extension(from.extensions, "EXT_texture_webp"), "source", -1),
            index_or(extension(from.extensions, "KHR_texture_basisu"), "source", -1),
            index_or(extension(from.extensions, "EXT_texture_avif"), "source", -1),
            index_or(extension(from.extensions, "MSFT_texture_dds"), "source", -1),
            index_or(extension(from.extensions, "EXT_texture_astc"), "source", -1),
            from.sampler};
}
} // namespace ppmi_gltf
