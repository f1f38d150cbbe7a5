// The only file that sees tinygltf. It reads the checked text (gltf_check.c) and copies what the
// importer uses into plain structs.
//
// tinygltf gets neither buffers nor images: it would stop at the first one that is broken, whether
// used or not, and copies them once more. So it opens no file, and Debian's shared library serves
// as well as the header alone.
#include "gltf/gltf_shim.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <tiny_gltf.h>

namespace
{
using tinygltf::Value;

// tinygltf's model, whose strings the C structs point into, and those structs.
struct Document : ppmi_gltf_document {
    tinygltf::Model model;
    std::vector<const char *> used_names, required_names;
    std::vector<ppmi_gltf_scene> scene_items;
    std::vector<ppmi_gltf_node> node_items;
    std::vector<ppmi_gltf_mesh> mesh_items;
    std::vector<ppmi_gltf_accessor> accessor_items;
    std::vector<ppmi_gltf_buffer_view> buffer_view_items;
    std::vector<ppmi_gltf_material> material_items;
    std::vector<ppmi_gltf_texture> texture_items;
    std::vector<ppmi_gltf_sampler> sampler_items;
    std::vector<ppmi_gltf_camera> camera_items;
    std::vector<ppmi_gltf_light> light_items;
    // deques: what is in them stays where it is
    std::deque<std::vector<ppmi_gltf_attribute>> attribute_lists;
    std::deque<std::vector<ppmi_gltf_primitive>> primitive_lists;
    std::deque<std::map<std::string, int>> instance_maps, draco_maps;
    std::deque<std::string> meshopt_words;
};

// ---- extension values ---------------------------------------------------------------------------

// The member of an object; a null value for anything else.
const Value &member(const Value &object, const char *key)
{
    static const Value null_value;
    return object.IsObject() ? object.Get(std::string(key)) : null_value;
}

const Value &extension(const tinygltf::ExtensionMap &map, const char *name)
{
    static const Value null_value;
    const auto it = map.find(name);
    return it == map.end() ? null_value : it->second;
}

double number_or(const Value &object, const char *key, double otherwise)
{
    const Value &value = member(object, key);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

// A size in bytes, up to 2^53; SIZE_MAX for a number that is none.
size_t size_or(const Value &object, const char *key, size_t otherwise)
{
    const Value &value = member(object, key);
    if (!value.IsNumber()) return otherwise;
    const double number = value.IsInt() ? value.GetNumberAsInt() : value.GetNumberAsDouble();
    const bool is_size =
        number >= 0.0 && number <= 9007199254740992.0 && number == std::floor(number);
    return is_size ? static_cast<size_t>(number) : SIZE_MAX;
}

int32_t index_or(const Value &object, const char *key, int32_t otherwise)
{
    const Value &value = member(object, key);
    return value.IsInt() ? value.GetNumberAsInt() : otherwise;
}

void numbers_or(const Value &object, const char *key, double *out, int count, double otherwise)
{
    const Value &value = member(object, key);
    const bool is_given = value.IsArray() && value.ArrayLen() == static_cast<size_t>(count);
    for (int i = 0; i < count; ++i) {
        out[i] = is_given && value.Get(i).IsNumber() ? value.Get(i).GetNumberAsDouble() : otherwise;
    }
}

void copy_numbers(const std::vector<double> &from, double *out, size_t count, double otherwise)
{
    for (size_t i = 0; i < count; ++i) {
        out[i] = from.size() == count ? from[i] : otherwise;
    }
}

// ---- textures and materials ---------------------------------------------------------------------

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
    return texture_info(index_or(info, "index", -1), index_or(info, "texCoord", 0),
                        member(member(info, "extensions"), "KHR_texture_transform"));
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

    const Value &transmission = extension(map, "KHR_materials_transmission");
    out->transmission = number_or(transmission, "transmissionFactor", 0.0);
    out->transmission_texture = extension_texture(transmission, "transmissionTexture");

    const Value &volume = extension(map, "KHR_materials_volume");
    out->thickness = number_or(volume, "thicknessFactor", 0.0);
    out->attenuation_distance = number_or(volume, "attenuationDistance", 0.0);
    numbers_or(volume, "attenuationColor", out->attenuation_color, 3, 1.0);
    out->dispersion = number_or(extension(map, "KHR_materials_dispersion"), "dispersion", 0.0);
}

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
    copy_material_extensions(from, &out);
    out.priority = number_or(from.extras, "ppm_priority", 0.0);
    return out;
}

ppmi_gltf_texture copy_texture(const tinygltf::Texture &from)
{
    return {from.source, index_or(extension(from.extensions, "EXT_texture_webp"), "source", -1),
            index_or(extension(from.extensions, "KHR_texture_basisu"), "source", -1), from.sampler};
}

// ---- geometry -----------------------------------------------------------------------------------

// Sets components and columns; both are 0 for a type that does not exist.
void copy_shape(int type, ppmi_gltf_accessor *out)
{
    switch (type) {
    case TINYGLTF_TYPE_SCALAR:
    case TINYGLTF_TYPE_VEC2:
    case TINYGLTF_TYPE_VEC3:
    case TINYGLTF_TYPE_VEC4:
    case TINYGLTF_TYPE_MAT2:
    case TINYGLTF_TYPE_MAT3:
    case TINYGLTF_TYPE_MAT4:
        break;
    default:
        return;
    }
    const bool is_matrix =
        type == TINYGLTF_TYPE_MAT2 || type == TINYGLTF_TYPE_MAT3 || type == TINYGLTF_TYPE_MAT4;
    out->component_count = static_cast<uint32_t>(tinygltf::GetNumComponentsInType(type));
    out->column_count = !is_matrix                   ? 1
                        : type == TINYGLTF_TYPE_MAT2 ? 2
                        : type == TINYGLTF_TYPE_MAT3 ? 3
                                                     : 4;
}

ppmi_gltf_accessor copy_accessor(const tinygltf::Accessor &from)
{
    ppmi_gltf_accessor out = {};
    out.buffer_view = from.bufferView;
    out.byte_offset = from.byteOffset;
    out.component_type = from.componentType;
    copy_shape(from.type, &out);
    out.normalized = from.normalized;
    out.count = from.count;
    if (from.sparse.isSparse) {
        out.sparse_count = static_cast<size_t>(from.sparse.count);
        out.sparse_indices_view = from.sparse.indices.bufferView;
        out.sparse_indices_type = from.sparse.indices.componentType;
        out.sparse_indices_offset = static_cast<size_t>(from.sparse.indices.byteOffset);
        out.sparse_values_view = from.sparse.values.bufferView;
        out.sparse_values_offset = static_cast<size_t>(from.sparse.values.byteOffset);
    }
    return out;
}

const char *keep_word(Document *document, const Value &object, const char *key)
{
    const Value &value = member(object, key);
    if (!value.IsString()) return "";
    document->meshopt_words.push_back(value.Get<std::string>());
    return document->meshopt_words.back().c_str();
}

void copy_meshopt(Document *document, const tinygltf::ExtensionMap &map, ppmi_gltf_meshopt *out)
{
    out->name = "KHR_meshopt_compression";
    if (map.count(out->name) == 0) out->name = "EXT_meshopt_compression";
    const Value *from = &extension(map, out->name);
    out->is_given = from->IsObject();
    if (!out->is_given) return;
    out->buffer = index_or(*from, "buffer", -1);
    out->byte_offset = size_or(*from, "byteOffset", 0);
    out->byte_length = size_or(*from, "byteLength", SIZE_MAX);
    out->byte_stride = size_or(*from, "byteStride", SIZE_MAX);
    out->count = size_or(*from, "count", SIZE_MAX);
    out->mode = keep_word(document, *from, "mode");
    out->filter = keep_word(document, *from, "filter");
}

ppmi_gltf_buffer_view copy_buffer_view(Document *document, const tinygltf::BufferView &from)
{
    ppmi_gltf_buffer_view out = {};
    out.buffer = from.buffer;
    out.byte_offset = from.byteOffset;
    out.byte_length = from.byteLength;
    out.byte_stride = from.byteStride;
    copy_meshopt(document, from.extensions, &out.meshopt);
    return out;
}

// The attributes of a map whose strings live on; sets count.
const ppmi_gltf_attribute *copy_attributes(Document *document,
                                           const std::map<std::string, int> &from, uint32_t *count)
{
    std::vector<ppmi_gltf_attribute> list;
    list.reserve(from.size());
    for (const auto &entry : from) {
        list.push_back({entry.first.c_str(), entry.second});
    }
    *count = static_cast<uint32_t>(list.size());
    document->attribute_lists.push_back(std::move(list));
    return document->attribute_lists.back().data();
}

// The object name -> integer "attributes" of an extension.
const ppmi_gltf_attribute *copy_attribute_object(Document *document, const Value &attributes,
                                                 std::deque<std::map<std::string, int>> *maps,
                                                 uint32_t *count)
{
    std::map<std::string, int> map;
    for (const std::string &key : attributes.Keys()) {
        map[key] = index_or(attributes, key.c_str(), -1);
    }
    maps->push_back(std::move(map));
    return copy_attributes(document, maps->back(), count);
}

void copy_draco(Document *document, const Value &from, ppmi_gltf_primitive *out)
{
    out->is_draco = from.IsObject();
    out->draco_view = index_or(from, "bufferView", -1);
    if (!out->is_draco) return;
    out->draco_attributes = copy_attribute_object(
        document, member(from, "attributes"), &document->draco_maps, &out->draco_attribute_count);
}

ppmi_gltf_primitive copy_primitive(Document *document, const tinygltf::Primitive &from)
{
    ppmi_gltf_primitive out = {};
    out.mode = from.mode;
    out.indices = from.extras.IsInt() ? from.extras.GetNumberAsInt() : -1; // gltf_schema.c
    out.material = from.material;
    out.attributes = copy_attributes(document, from.attributes, &out.attribute_count);
    out.has_targets = !from.targets.empty();
    copy_draco(document, extension(from.extensions, "KHR_draco_mesh_compression"), &out);
    return out;
}

ppmi_gltf_mesh copy_mesh(Document *document, const tinygltf::Mesh &from)
{
    std::vector<ppmi_gltf_primitive> list;
    list.reserve(from.primitives.size());
    for (const tinygltf::Primitive &primitive : from.primitives) {
        list.push_back(copy_primitive(document, primitive));
    }
    document->primitive_lists.push_back(std::move(list));
    const auto &kept = document->primitive_lists.back();
    return {from.name.c_str(), static_cast<uint32_t>(kept.size()), kept.data()};
}

// ---- nodes --------------------------------------------------------------------------------------

void copy_instancing(Document *document, const Value &from, ppmi_gltf_node *out)
{
    out->is_instanced = from.IsObject();
    if (!out->is_instanced) return;
    out->instance_attributes =
        copy_attribute_object(document, member(from, "attributes"), &document->instance_maps,
                              &out->instance_attribute_count);
}

ppmi_gltf_node copy_node(Document *document, const tinygltf::Node &from)
{
    ppmi_gltf_node out = {};
    out.name = from.name.c_str();
    out.mesh = from.mesh;
    out.camera = from.camera;
    out.skin = from.skin;
    out.light = index_or(extension(from.extensions, "KHR_lights_punctual"), "light", -1);
    out.child_count = static_cast<uint32_t>(from.children.size());
    out.children = from.children.data();
    out.has_matrix = from.matrix.size() == 16;
    copy_numbers(from.matrix, out.matrix, 16, 0.0);
    copy_numbers(from.translation, out.translation, 3, 0.0);
    copy_numbers(from.rotation, out.rotation, 4, 0.0);
    if (from.rotation.size() != 4) out.rotation[3] = 1.0;
    copy_numbers(from.scale, out.scale, 3, 1.0);
    copy_instancing(document, extension(from.extensions, "EXT_mesh_gpu_instancing"), &out);
    return out;
}

ppmi_gltf_camera copy_camera(const tinygltf::Camera &from)
{
    return {from.name.c_str(),      from.type == "orthographic",
            from.perspective.yfov,  from.perspective.aspectRatio,
            from.orthographic.xmag, from.orthographic.ymag};
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
    return out;
}

// ---- the document -------------------------------------------------------------------------------

template <typename From, typename To, typename Copy>
void copy_all(const std::vector<From> &from, std::vector<To> *items, const To **out_items,
              size_t *out_count, Copy copy)
{
    items->reserve(from.size());
    for (const From &item : from) {
        items->push_back(copy(item));
    }
    *out_items = items->data();
    *out_count = items->size();
}

void copy_model(Document *d)
{
    const tinygltf::Model &model = d->model;
    const auto text = [](const std::string &s) { return s.c_str(); };
    const char *const *names = nullptr;
    copy_all(model.extensionsUsed, &d->used_names, &names, &d->used_count, text);
    d->extensions_used = d->used_names.data();
    copy_all(model.extensionsRequired, &d->required_names, &names, &d->required_count, text);
    d->extensions_required = d->required_names.data();
    d->generator = model.asset.generator.c_str();
    d->default_scene = model.defaultScene;
    copy_all(model.scenes, &d->scene_items, &d->scenes, &d->scene_count,
             [](const tinygltf::Scene &s) {
                 return ppmi_gltf_scene{static_cast<uint32_t>(s.nodes.size()), s.nodes.data()};
             });
    copy_all(model.nodes, &d->node_items, &d->nodes, &d->node_count,
             [d](const tinygltf::Node &n) { return copy_node(d, n); });
    copy_all(model.meshes, &d->mesh_items, &d->meshes, &d->mesh_count,
             [d](const tinygltf::Mesh &m) { return copy_mesh(d, m); });
    copy_all(model.accessors, &d->accessor_items, &d->accessors, &d->accessor_count, copy_accessor);
    copy_all(model.bufferViews, &d->buffer_view_items, &d->buffer_views, &d->buffer_view_count,
             [d](const tinygltf::BufferView &v) { return copy_buffer_view(d, v); });
    copy_all(model.materials, &d->material_items, &d->materials, &d->material_count, copy_material);
    copy_all(model.textures, &d->texture_items, &d->textures, &d->texture_count, copy_texture);
    copy_all(model.samplers, &d->sampler_items, &d->samplers, &d->sampler_count,
             [](const tinygltf::Sampler &s) {
                 return ppmi_gltf_sampler{s.magFilter, s.wrapS, s.wrapT};
             });
    copy_all(model.cameras, &d->camera_items, &d->cameras, &d->camera_count, copy_camera);
    copy_all(model.lights, &d->light_items, &d->lights, &d->light_count, copy_light);
}

ppm_status load(ppm_context *context, const char *file, const char *text, size_t length,
                const ppmi_gltf_document **out_document)
{
    auto document = std::make_unique<Document>();
    tinygltf::TinyGLTF loader;
    std::string error, warning;
    if (length > 0xffffffffu) {
        return ppmi_fail(context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: more than 4 GB of JSON without buffers and images", file);
    }
    const bool ok = loader.LoadASCIIFromString(&document->model, &error, &warning, text,
                                               static_cast<unsigned>(length), "");
    // it also reports what it then leaves at its default; the check has warned about that
    if (!ok) {
        std::replace(error.begin(), error.end(), '\n', ' ');
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: %s", file, error.c_str());
    }
    copy_model(document.get());
    *out_document = document.release();
    return PPM_STATUS_OK;
}
} // namespace

ppm_status ppmi_gltf_document_create(ppm_context *context, const char *file, const char *text,
                                     size_t length, const ppmi_gltf_document **out_document)
{
    try {
        return load(context, file, text, length, out_document);
    } catch (const std::bad_alloc &) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", file);
    } catch (const std::exception &e) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: %s", file, e.what());
    } catch (...) {
        return ppmi_fail(context, PPM_STATUS_INTERNAL, "%s: unknown error in the JSON parser",
                         file);
    }
}

void ppmi_gltf_document_destroy(const ppmi_gltf_document *document)
{
    delete static_cast<const Document *>(document);
}
