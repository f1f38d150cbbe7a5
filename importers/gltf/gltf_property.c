/* Tables from paths to places (glTF 2.0 Asset Object Model, and the object models of the extensions
 * that the importer reads). */
#include "gltf/gltf_property.h"

#include <stdio.h>
#include <string.h>

#include "gltf/gltf_pose.h"

enum { MAX_POINTER = 256 };

/* A path below an element, and where its value is in the element's struct. */
typedef struct entry {
    const char *path;
    size_t offset;
    uint32_t count;
} entry;

#define NODE(path, member, count)                                                                  \
    {                                                                                              \
        path, offsetof(ppmi_gltf_node, member), count                                              \
    }
#define MATERIAL(path, member, count)                                                              \
    {                                                                                              \
        path, offsetof(ppmi_gltf_material, member), count                                          \
    }
#define CAMERA(path, member)                                                                       \
    {                                                                                              \
        path, offsetof(ppmi_gltf_camera, member), 1                                                \
    }
#define LIGHT(path, member, count)                                                                 \
    {                                                                                              \
        path, offsetof(ppmi_gltf_light, member), count                                             \
    }
#define AREA_LIGHT(path, member, count)                                                            \
    {                                                                                              \
        path, offsetof(ppmi_gltf_area_light, member), count                                        \
    }
#define END                                                                                        \
    {                                                                                              \
        NULL, 0, 0                                                                                 \
    }

static const entry node_entries[] = {
    NODE("translation", translation, 3),
    NODE("rotation", rotation, 4),
    NODE("scale", scale, 3),
    NODE("extensions/KHR_node_visibility/visible", visibility, 1),
    NODE("extensions/EXT_lights_ies/multiplier", profile_factor, 1),
    NODE("extensions/EXT_lights_ies/color", profile_color, 3),
    END};

static const entry camera_entries[] = {CAMERA("perspective/znear", z_near),
                                       CAMERA("perspective/zfar", z_far),
                                       CAMERA("orthographic/znear", z_near),
                                       CAMERA("orthographic/zfar", z_far),
                                       CAMERA("perspective/yfov", y_fov_rad),
                                       CAMERA("perspective/aspectRatio", aspect),
                                       CAMERA("orthographic/xmag", x_mag),
                                       CAMERA("orthographic/ymag", y_mag),
                                       END};

static const entry light_entries[] = {LIGHT("color", color, 3), LIGHT("intensity", intensity, 1),
                                      LIGHT("spot/innerConeAngle", inner_cone_rad, 1),
                                      LIGHT("spot/outerConeAngle", outer_cone_rad, 1), END};

static const entry area_light_entries[] = {
    AREA_LIGHT("color", color, 3), AREA_LIGHT("intensity", intensity, 1),
    AREA_LIGHT("size", size, 1), AREA_LIGHT("rect/aspect", aspect, 1), END};

static const entry material_entries[] = {
    MATERIAL("pbrMetallicRoughness/baseColorFactor", base_color, 4),
    MATERIAL("pbrMetallicRoughness/metallicFactor", metallic, 1),
    MATERIAL("pbrMetallicRoughness/roughnessFactor", roughness, 1),
    MATERIAL("normalTexture/scale", normal_texture.scale, 1),
    MATERIAL("emissiveFactor", emissive, 3),
    MATERIAL("alphaCutoff", alpha_cutoff, 1),
    MATERIAL("extensions/KHR_materials_emissive_strength/emissiveStrength", emissive_strength, 1),
    MATERIAL("extensions/KHR_materials_ior/ior", ior, 1),
    MATERIAL("extensions/KHR_materials_specular/specularFactor", specular, 1),
    MATERIAL("extensions/KHR_materials_specular/specularColorFactor", specular_color, 3),
    MATERIAL("extensions/KHR_materials_transmission/transmissionFactor", transmission, 1),
    MATERIAL("extensions/KHR_materials_volume/thicknessFactor", thickness, 1),
    MATERIAL("extensions/KHR_materials_volume/attenuationDistance", attenuation_distance, 1),
    MATERIAL("extensions/KHR_materials_volume/attenuationColor", attenuation_color, 3),
    MATERIAL("extensions/KHR_materials_dispersion/dispersion", dispersion, 1),
    MATERIAL("extensions/KHR_materials_clearcoat/clearcoatFactor", layers.clearcoat, 1),
    MATERIAL("extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor",
             layers.clearcoat_roughness, 1),
    MATERIAL("extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale",
             layers.clearcoat_normal_texture.scale, 1),
    MATERIAL("extensions/KHR_materials_sheen/sheenColorFactor", layers.sheen_color, 3),
    MATERIAL("extensions/KHR_materials_sheen/sheenRoughnessFactor", layers.sheen_roughness, 1),
    MATERIAL("extensions/KHR_materials_iridescence/iridescenceFactor", layers.iridescence, 1),
    MATERIAL("extensions/KHR_materials_iridescence/iridescenceIor", layers.iridescence_ior, 1),
    MATERIAL("extensions/KHR_materials_iridescence/iridescenceThicknessMinimum",
             layers.iridescence_min_nm, 1),
    MATERIAL("extensions/KHR_materials_iridescence/iridescenceThicknessMaximum",
             layers.iridescence_max_nm, 1),
    MATERIAL("extensions/KHR_materials_anisotropy/anisotropyStrength", layers.anisotropy, 1),
    MATERIAL("extensions/KHR_materials_anisotropy/anisotropyRotation",
             layers.anisotropy_rotation_rad, 1),
    MATERIAL("extensions/KHR_materials_coat/coatFactor", layers.coat.factor, 1),
    MATERIAL("extensions/KHR_materials_coat/coatRoughnessFactor", layers.coat.roughness, 1),
    MATERIAL("extensions/KHR_materials_coat/coatNormalTexture/scale",
             layers.coat.normal_texture.scale, 1),
    MATERIAL("extensions/KHR_materials_coat/coatIor", layers.coat.ior, 1),
    MATERIAL("extensions/KHR_materials_coat/coatColorFactor", layers.coat.color, 3),
    MATERIAL("extensions/KHR_materials_coat/coatDarkeningFactor", layers.coat.darkening, 1),
    MATERIAL("extensions/KHR_materials_coat/coatAnisotropyStrength", layers.coat.anisotropy, 1),
    MATERIAL("extensions/KHR_materials_coat/coatAnisotropyRotation",
             layers.coat.anisotropy_rotation_rad, 1),
    MATERIAL("extensions/KHR_materials_diffuse_roughness/diffuseRoughnessFactor",
             layers.diffuse_roughness, 1),
    MATERIAL("extensions/KHR_materials_fuzz/fuzzFactor", layers.fuzz.factor, 1),
    MATERIAL("extensions/KHR_materials_fuzz/fuzzColorFactor", layers.fuzz.color, 3),
    MATERIAL("extensions/KHR_materials_fuzz/fuzzRoughnessFactor", layers.fuzz.roughness, 1),
    MATERIAL("extensions/KHR_materials_retroreflection/retroreflectionFactor",
             layers.retroreflection, 1),
    MATERIAL("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor",
             scattering.diffuse_transmission, 1),
    MATERIAL("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
             scattering.diffuse_transmission_color, 3),
    MATERIAL("extensions/KHR_materials_scatter/multiscatterColorFactor",
             scattering.multiscatter_color, 3),
    MATERIAL("extensions/KHR_materials_scatter/scatterAnisotropy", scattering.scatter_anisotropy,
             1),
    MATERIAL("extensions/KHR_materials_scatter/scatterStrengthFactor", scattering.scatter_strength,
             1),
    MATERIAL("extensions/KHR_materials_volume_scatter/multiscatterColor",
             scattering.multiscatter_color, 3),
    MATERIAL("extensions/KHR_materials_volume_scatter/multiscatterColorFactor",
             scattering.multiscatter_color, 3),
    MATERIAL("extensions/KHR_materials_volume_scatter/scatterAnisotropy",
             scattering.scatter_anisotropy, 1),
    MATERIAL("extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor",
             specular_glossiness.diffuse, 4),
    MATERIAL("extensions/KHR_materials_pbrSpecularGlossiness/specularFactor",
             specular_glossiness.specular, 3),
    MATERIAL("extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor",
             specular_glossiness.glossiness, 1),
    END};

/* Textures of a material, whose KHR_texture_transform may move. */
static const entry texture_entries[] = {
    MATERIAL("pbrMetallicRoughness/baseColorTexture", base_color_texture, 0),
    MATERIAL("pbrMetallicRoughness/metallicRoughnessTexture", metallic_roughness_texture, 0),
    MATERIAL("normalTexture", normal_texture, 0),
    MATERIAL("emissiveTexture", emissive_texture, 0),
    MATERIAL("extensions/KHR_materials_specular/specularTexture", specular_texture, 0),
    MATERIAL("extensions/KHR_materials_specular/specularColorTexture", specular_color_texture, 0),
    MATERIAL("extensions/KHR_materials_transmission/transmissionTexture", transmission_texture, 0),
    MATERIAL("extensions/KHR_materials_clearcoat/clearcoatTexture", layers.clearcoat_texture, 0),
    MATERIAL("extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
             layers.clearcoat_roughness_texture, 0),
    MATERIAL("extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
             layers.clearcoat_normal_texture, 0),
    MATERIAL("extensions/KHR_materials_sheen/sheenColorTexture", layers.sheen_color_texture, 0),
    MATERIAL("extensions/KHR_materials_sheen/sheenRoughnessTexture", layers.sheen_roughness_texture,
             0),
    MATERIAL("extensions/KHR_materials_iridescence/iridescenceTexture", layers.iridescence_texture,
             0),
    MATERIAL("extensions/KHR_materials_iridescence/iridescenceThicknessTexture",
             layers.iridescence_thickness_texture, 0),
    MATERIAL("extensions/KHR_materials_anisotropy/anisotropyTexture", layers.anisotropy_texture, 0),
    MATERIAL("extensions/KHR_materials_coat/coatTexture", layers.coat.texture, 0),
    MATERIAL("extensions/KHR_materials_coat/coatRoughnessTexture", layers.coat.roughness_texture,
             0),
    MATERIAL("extensions/KHR_materials_coat/coatNormalTexture", layers.coat.normal_texture, 0),
    MATERIAL("extensions/KHR_materials_coat/coatColorTexture", layers.coat.color_texture, 0),
    MATERIAL("extensions/KHR_materials_coat/coatAnisotropyTexture", layers.coat.anisotropy_texture,
             0),
    MATERIAL("extensions/KHR_materials_diffuse_roughness/diffuseRoughnessTexture",
             layers.diffuse_roughness_texture, 0),
    MATERIAL("extensions/KHR_materials_fuzz/fuzzTexture", layers.fuzz.texture, 0),
    MATERIAL("extensions/KHR_materials_fuzz/fuzzColorTexture", layers.fuzz.color_texture, 0),
    MATERIAL("extensions/KHR_materials_fuzz/fuzzRoughnessTexture", layers.fuzz.roughness_texture,
             0),
    MATERIAL("extensions/KHR_materials_retroreflection/retroreflectionTexture",
             layers.retroreflection_texture, 0),
    MATERIAL("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionTexture",
             scattering.diffuse_transmission_texture, 0),
    MATERIAL("extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture",
             scattering.diffuse_transmission_color_texture, 0),
    MATERIAL("extensions/KHR_materials_scatter/multiscatterColorTexture",
             scattering.multiscatter_color_texture, 0),
    MATERIAL("extensions/KHR_materials_scatter/scatterStrengthTexture",
             scattering.scatter_strength_texture, 0),
    MATERIAL("extensions/KHR_materials_volume_scatter/multiscatterColorTexture",
             scattering.multiscatter_color_texture, 0),
    MATERIAL("extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
             specular_glossiness.diffuse_texture, 0),
    MATERIAL("extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
             specular_glossiness.specular_glossiness_texture, 0),
    END};

#define TRANSFORM(path, member, count)                                                             \
    {                                                                                              \
        "/extensions/KHR_texture_transform/" path, offsetof(ppmi_gltf_texture_info, member), count \
    }
static const entry transform_entries[] = {TRANSFORM("offset", offset, 2),
                                          TRANSFORM("rotation", rotation_rad, 1),
                                          TRANSFORM("scale", uv_scale, 2), END};

static const entry *find_entry(const entry *entries, const char *path)
{
    for (; entries->path; ++entries) {
        if (strcmp(entries->path, path) == 0) return entries;
    }
    return NULL;
}

static double *place_at(void *element, size_t offset)
{
    return (double *)(void *)((unsigned char *)element + offset);
}

/* ---- nodes ----------------------------------------------------------------------------------- */

static bool weights_property(ppmi_gltf_reader *reader, int32_t node, ppmi_gltf_property *out)
{
    out->values = ppmi_gltf_pose_weights(reader, node, &out->count);
    out->is_list = true;
    return out->values != NULL;
}

bool ppmi_gltf_node_property(ppmi_gltf_reader *reader, int32_t node, const char *path,
                             ppmi_gltf_property *out)
{
    ppmi_gltf_node *nodes = ppmi_gltf_document_edit(reader->document).nodes;
    *out = (ppmi_gltf_property){.list = PPMI_GLTF_NODES, .index = node};
    if (strcmp(path, "weights") == 0) return weights_property(reader, node, out);
    const entry *e = find_entry(node_entries, path);
    if (!e) return false;
    out->values = place_at(&nodes[node], e->offset);
    out->count = e->count;
    out->is_rotation = strcmp(path, "rotation") == 0;
    out->is_flag = strstr(path, "visible") != NULL;
    return true;
}

/* "weights/3": one of them. */
static bool weight_property(ppmi_gltf_reader *reader, int32_t node, const char *path,
                            ppmi_gltf_property *out)
{
    unsigned index;
    char end;
    if (sscanf(path, "weights/%9u%c", &index, &end) != 1) return false;
    *out = (ppmi_gltf_property){.list = PPMI_GLTF_NODES, .index = node};
    if (!weights_property(reader, node, out) || index >= out->count) return false;
    out->values += index;
    out->count = 1;
    out->is_list = false;
    return true;
}

/* ---- materials ------------------------------------------------------------------------------- */

static bool transform_property(ppmi_gltf_material *material, const char *path,
                               ppmi_gltf_property *out)
{
    for (const entry *e = texture_entries; e->path; ++e) {
        const size_t length = strlen(e->path);
        if (strncmp(e->path, path, length) != 0) continue;
        const entry *inner = find_entry(transform_entries, path + length);
        if (!inner) continue;
        out->texture = (ppmi_gltf_texture_info *)(void *)((unsigned char *)material + e->offset);
        out->values = place_at(out->texture, inner->offset);
        out->count = inner->count;
        return true;
    }
    return false;
}

static bool element_property(void *element, const entry *entries, const char *path,
                             ppmi_gltf_property *out)
{
    const entry *e = find_entry(entries, path);
    if (!e) return false;
    out->values = place_at(element, e->offset);
    out->count = e->count;
    return true;
}

/* ---- pointers -------------------------------------------------------------------------------- */

/* "/LIST/INDEX/": what follows it, or NULL. */
static const char *after_index(const char *pointer, const char *list, int32_t *out_index)
{
    const size_t length = strlen(list);
    if (strncmp(pointer, list, length) != 0) return NULL;
    const char *at = pointer + length;
    int64_t index = 0;
    if (*at < '0' || *at > '9' || (*at == '0' && at[1] != '/')) return NULL;
    for (; *at >= '0' && *at <= '9' && index <= INT32_MAX; ++at) {
        index = 10 * index + (*at - '0');
    }
    if (*at != '/' || index > INT32_MAX) return NULL;
    *out_index = (int32_t)index;
    return at + 1;
}

/* Undoes the escapes of RFC 6901: ~1 is a slash and ~0 a tilde. None of our names has either. */
static bool unescape(const char *pointer, char out[MAX_POINTER])
{
    size_t n = 0;
    for (; *pointer; ++pointer) {
        const bool is_escape = pointer[0] == '~' && (pointer[1] == '0' || pointer[1] == '1');
        if (n + 1 >= MAX_POINTER) return false;
        out[n++] = is_escape ? (pointer[1] == '1' ? '\x01' : '~') : *pointer;
        if (is_escape) ++pointer;
    }
    out[n] = 0;
    return true;
}

static bool find_in(ppmi_gltf_reader *reader, const char *path, ppmi_gltf_property *out)
{
    const ppmi_gltf_editable d = ppmi_gltf_document_edit(reader->document);
    const int32_t index = out->index;
    switch (out->list) {
    case PPMI_GLTF_NODES:
        return ppmi_gltf_node_property(reader, index, path, out) ||
               weight_property(reader, index, path, out);
    case PPMI_GLTF_MATERIALS:
        return element_property(&d.materials[index], material_entries, path, out) ||
               transform_property(&d.materials[index], path, out);
    case PPMI_GLTF_CAMERAS:
        return element_property(&d.cameras[index], camera_entries, path, out);
    case PPMI_GLTF_LIGHTS:
        return element_property(&d.lights[index], light_entries, path, out);
    case PPMI_GLTF_AREA_LIGHTS:
        return element_property(&d.area_lights[index], area_light_entries, path, out);
    default: /* meshes */
        return strcmp(path, "weights") == 0;
    }
}

ppmi_gltf_pointer_result ppmi_gltf_resolve_pointer(ppmi_gltf_reader *reader, const char *pointer,
                                                   ppmi_gltf_property *out)
{
    static const struct {
        const char *begin;
        int32_t list;
    } lists[] = {{"/nodes/", PPMI_GLTF_NODES},
                 {"/materials/", PPMI_GLTF_MATERIALS},
                 {"/cameras/", PPMI_GLTF_CAMERAS},
                 {"/extensions/KHR_lights_punctual/lights/", PPMI_GLTF_LIGHTS},
                 {"/extensions/EXT_lights_area/lights/", PPMI_GLTF_AREA_LIGHTS},
                 {"/meshes/", PPMI_GLTF_MESHES}};
    char text[MAX_POINTER], reason[2 * PPMI_GLTF_PLACE];
    if (pointer[0] != '/') return PPMI_GLTF_POINTER_BROKEN;
    if (!unescape(pointer, text)) return PPMI_GLTF_POINTER_IGNORED;
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; ++i) {
        *out = (ppmi_gltf_property){.list = lists[i].list};
        const char *path = after_index(text, lists[i].begin, &out->index);
        if (!path) continue;
        if (!ppmi_gltf_is_usable(reader, out->list, out->index, reason, sizeof reason)) {
            return PPMI_GLTF_POINTER_BROKEN;
        }
        return find_in(reader, path, out) ? PPMI_GLTF_POINTER_FOUND : PPMI_GLTF_POINTER_IGNORED;
    }
    return PPMI_GLTF_POINTER_IGNORED;
}
