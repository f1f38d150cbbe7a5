// The document: with gltf_shim_material.cpp and gltf_shim_light.cpp what sees tinygltf, and nothing
// else does. They read the checked text (gltf_check.c) and copy what the importer uses into plain
// structs.
//
// tinygltf gets neither buffers nor images: it would stop at the first one that is broken, whether
// used or not, and copies them once more. So it opens no file, and Debian's shared library serves
// as well as the header alone.
#include "gltf/gltf_shim.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "gltf/gltf_shim_parts.hpp"

namespace
{
using namespace ppmi_gltf;

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
    std::vector<ppmi_gltf_skin> skin_items;
    std::vector<ppmi_gltf_animation> animation_items;
    std::vector<ppmi_gltf_area_light> area_light_items;
    std::vector<ppmi_gltf_light_profile> profile_items;
    std::vector<ppmi_gltf_image_light> image_light_items;
    std::vector<ppmi_gltf_cubemap> cubemap_items;
    std::vector<ppmi_gltf_environment_map> environment_map_items;
    // deques: what is in them stays where it is
    std::deque<std::vector<ppmi_gltf_attribute>> attribute_lists;
    std::deque<std::vector<ppmi_gltf_primitive>> primitive_lists;
    std::deque<std::map<std::string, int>> instance_maps, draco_maps;
    std::deque<std::string> meshopt_words;
    std::deque<std::vector<ppmi_gltf_mapping>> mapping_lists;
    std::deque<std::vector<int32_t>> variant_lists;
    std::deque<std::string> variant_strings;
    std::vector<const char *> variant_names;
    std::deque<std::vector<ppmi_gltf_target>> target_lists;
    std::deque<std::vector<ppmi_gltf_channel>> channel_lists;
    std::deque<std::vector<ppmi_gltf_animation_sampler>> sampler_lists;
    std::deque<std::string> strings;
};

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
    out.component_type = from.componentType == PPMI_GLTF_HALF_FOR_TINYGLTF
                             ? static_cast<int32_t>(PPMI_GLTF_HALF)
                             : from.componentType;
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

// The numbers of an array; what is no integer is left out.
const int32_t *copy_integers(Document *document, const Value &from, uint32_t *count)
{
    std::vector<int32_t> list;
    for (size_t i = 0; i < from.ArrayLen(); ++i) {
        if (from.Get(static_cast<int>(i)).IsInt()) {
            list.push_back(from.Get(static_cast<int>(i)).GetNumberAsInt());
        }
    }
    *count = static_cast<uint32_t>(list.size());
    document->variant_lists.push_back(std::move(list));
    return document->variant_lists.back().data();
}

void copy_mappings(Document *document, const Value &from, ppmi_gltf_primitive *out)
{
    std::vector<ppmi_gltf_mapping> list;
    for (size_t i = 0; i < from.ArrayLen(); ++i) {
        const Value &item = from.Get(static_cast<int>(i));
        ppmi_gltf_mapping mapping = {};
        mapping.material = index_or(item, "material", -1);
        mapping.variants =
            copy_integers(document, member(item, "variants"), &mapping.variant_count);
        list.push_back(mapping);
    }
    if (list.empty()) return;
    out->mapping_count = static_cast<uint32_t>(list.size());
    document->mapping_lists.push_back(std::move(list));
    out->mappings = document->mapping_lists.back().data();
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

const ppmi_gltf_target *copy_targets(Document *document, const tinygltf::Primitive &from,
                                     uint32_t *count)
{
    std::vector<ppmi_gltf_target> list;
    list.reserve(from.targets.size());
    for (const auto &map : from.targets) {
        ppmi_gltf_target target = {};
        target.attributes = copy_attributes(document, map, &target.attribute_count);
        list.push_back(target);
    }
    *count = static_cast<uint32_t>(list.size());
    document->target_lists.push_back(std::move(list));
    return document->target_lists.back().data();
}

ppmi_gltf_primitive copy_primitive(Document *document, const tinygltf::Primitive &from)
{
    ppmi_gltf_primitive out = {};
    out.mode = from.mode;
    out.indices = from.extras.IsInt() ? from.extras.GetNumberAsInt() : -1; // gltf_schema.c
    out.material = from.material;
    out.attributes = copy_attributes(document, from.attributes, &out.attribute_count);
    out.targets = copy_targets(document, from, &out.target_count);
    copy_draco(document, extension(from.extensions, "KHR_draco_mesh_compression"), &out);
    copy_mappings(document,
                  member(extension(from.extensions, "KHR_materials_variants"), "mappings"), &out);
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
    return {from.name.c_str(), static_cast<uint32_t>(kept.size()), kept.data(),
            static_cast<uint32_t>(from.weights.size()), from.weights.data()};
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
    copy_node_lights(from, &out);
    out.child_count = static_cast<uint32_t>(from.children.size());
    out.children = from.children.data();
    out.has_matrix = from.matrix.size() == 16;
    copy_numbers(from.matrix, out.matrix, 16, 0.0);
    copy_numbers(from.translation, out.translation, 3, 0.0);
    copy_numbers(from.rotation, out.rotation, 4, 0.0);
    if (from.rotation.size() != 4) out.rotation[3] = 1.0;
    copy_numbers(from.scale, out.scale, 3, 1.0);
    copy_instancing(document, extension(from.extensions, "EXT_mesh_gpu_instancing"), &out);
    out.weight_count = static_cast<uint32_t>(from.weights.size());
    out.weights = from.weights.data();
    const Value &visible = member(extension(from.extensions, "KHR_node_visibility"), "visible");
    out.visibility = visible.IsBool() && !visible.Get<bool>() ? 0.0 : 1.0;
    return out;
}

ppmi_gltf_skin copy_skin(const tinygltf::Skin &from)
{
    return {from.name.c_str(), from.inverseBindMatrices, static_cast<uint32_t>(from.joints.size()),
            from.joints.data()};
}

// ---- animations ---------------------------------------------------------------------------------

// A string of a value, kept by the document; "" for anything else.
const char *keep_string(Document *document, const Value &value)
{
    document->strings.push_back(value.IsString() ? value.Get<std::string>() : std::string());
    return document->strings.back().c_str();
}

ppmi_gltf_channel copy_channel(Document *document, const Value &from)
{
    const Value &target = member(from, "target");
    const Value &pointer =
        member(member(member(target, "extensions"), "KHR_animation_pointer"), "pointer");
    ppmi_gltf_channel out = {};
    out.sampler = index_or(from, "sampler", -1);
    out.node = index_or(target, "node", -1);
    out.path = keep_string(document, member(target, "path"));
    out.pointer = pointer.IsString() ? keep_string(document, pointer) : nullptr;
    return out;
}

ppmi_gltf_animation_sampler copy_animation_sampler(const Value &from)
{
    const Value &word = member(from, "interpolation");
    const std::string interpolation = word.IsString() ? word.Get<std::string>() : std::string();
    return {index_or(from, "input", -1), index_or(from, "output", -1),
            interpolation == "STEP"          ? PPMI_GLTF_STEP
            : interpolation == "CUBICSPLINE" ? PPMI_GLTF_CUBICSPLINE
                                             : PPMI_GLTF_LINEAR};
}

ppmi_gltf_animation copy_animation(Document *document, const Value &from)
{
    const Value &channels = member(from, "channels"), &samplers = member(from, "samplers");
    const size_t channel_count = channels.IsArray() ? channels.ArrayLen() : 0;
    const size_t sampler_count = samplers.IsArray() ? samplers.ArrayLen() : 0;
    document->channel_lists.emplace_back();
    document->sampler_lists.emplace_back();
    auto &channel_list = document->channel_lists.back();
    auto &sampler_list = document->sampler_lists.back();
    for (size_t i = 0; i < channel_count; ++i) {
        channel_list.push_back(copy_channel(document, channels.Get(i)));
    }
    for (size_t i = 0; i < sampler_count; ++i) {
        sampler_list.push_back(copy_animation_sampler(samplers.Get(i)));
    }
    return {keep_string(document, member(from, "name")), static_cast<uint32_t>(sampler_count),
            static_cast<uint32_t>(channel_count), sampler_list.data(), channel_list.data()};
}

// They stand where gltf_schema.c has put them.
void copy_animations(Document *document)
{
    const Value &list = document->model.extras;
    const size_t count = list.IsArray() ? list.ArrayLen() : 0;
    for (size_t i = 0; i < count; ++i) {
        document->animation_items.push_back(copy_animation(document, list.Get(i)));
    }
    document->animations = document->animation_items.data();
    document->animation_count = count;
}

// The elements of a root extension's list.
template <typename To, typename Copy>
void copy_extension_list(const tinygltf::Model &model, const char *name, const char *key,
                         std::vector<To> *items, const To **out_items, size_t *out_count, Copy copy)
{
    const Value &list = member(extension(model.extensions, name), key);
    const size_t count = list.IsArray() ? list.ArrayLen() : 0;
    for (size_t i = 0; i < count; ++i) {
        items->push_back(copy(list.Get(i)));
    }
    *out_items = items->data();
    *out_count = items->size();
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

// The names of KHR_materials_variants; the check has made an object with a name of each.
void copy_variants(Document *d)
{
    const Value &list =
        member(extension(d->model.extensions, "KHR_materials_variants"), "variants");
    for (size_t i = 0; i < list.ArrayLen(); ++i) {
        const Value &name = member(list.Get(static_cast<int>(i)), "name");
        d->variant_strings.push_back(name.IsString() ? name.Get<std::string>() : "");
        d->variant_names.push_back(d->variant_strings.back().c_str());
    }
    d->variants = d->variant_names.data();
    d->variant_count = d->variant_names.size();
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
    d->copyright = model.asset.copyright.c_str();
    d->xmp_packet = index_or(extension(model.asset.extensions, "KHR_xmp_json_ld"), "packet", -1);
    copy_variants(d);
    d->default_scene = model.defaultScene;
    copy_all(
        model.scenes, &d->scene_items, &d->scenes, &d->scene_count, [](const tinygltf::Scene &s) {
            return ppmi_gltf_scene{
                s.name.c_str(), static_cast<uint32_t>(s.nodes.size()), s.nodes.data(),
                index_or(extension(s.extensions, "EXT_lights_image_based"), "light", -1),
                index_or(extension(s.extensions, "KHR_environment_map"), "environment_map", -1)};
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
    copy_all(model.skins, &d->skin_items, &d->skins, &d->skin_count, copy_skin);
    copy_animations(d);
    copy_extension_list(model, "EXT_lights_area", "lights", &d->area_light_items, &d->area_lights,
                        &d->area_light_count, copy_area_light);
    copy_extension_list(model, "EXT_lights_ies", "lights", &d->profile_items, &d->profiles,
                        &d->profile_count, copy_profile);
    copy_extension_list(model, "EXT_lights_image_based", "lights", &d->image_light_items,
                        &d->image_lights, &d->image_light_count, copy_image_light);
    copy_extension_list(model, "KHR_environment_map", "cubemaps", &d->cubemap_items, &d->cubemaps,
                        &d->cubemap_count, copy_cubemap);
    copy_extension_list(model, "KHR_environment_map", "environment_maps", &d->environment_map_items,
                        &d->environment_maps, &d->environment_map_count, copy_environment_map);
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

ppmi_gltf_editable ppmi_gltf_document_edit(const ppmi_gltf_document *document)
{
    // every document is made above, and is not const there
    auto *d = const_cast<Document *>(static_cast<const Document *>(document));
    return {d->node_items.data(), d->material_items.data(), d->camera_items.data(),
            d->light_items.data(), d->area_light_items.data()};
}

void ppmi_gltf_document_destroy(const ppmi_gltf_document *document)
{
    delete static_cast<const Document *>(document);
}
