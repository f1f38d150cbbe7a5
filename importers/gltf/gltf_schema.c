/* What the members of a glTF 2.0 document must look like (glTF 2.0 specification, chapter 5, and
 * the extensions' schemas), as far as the importer uses them. VITAL marks what decides about
 * geometry, and what tinygltf refuses a whole document for. */
#include "gltf/gltf_schema.h"

#include "gltf/gltf_check.h"

#define INDEX_MAX 2147483647.0
#define SIZE_MAX_EXACT 9007199254740992.0 /* 2^53 */

#define FIELD(name, what, ...)                                                                     \
    {                                                                                              \
        .key = name, .kind = what, __VA_ARGS__                                                     \
    }
#define INDEX(name, bits) FIELD(name, GLTF_INTEGER, .flags = (bits), .max = INDEX_MAX)
#define SIZE(name, bits) FIELD(name, GLTF_INTEGER, .flags = (bits), .max = SIZE_MAX_EXACT)
#define NUMBER(name) FIELD(name, GLTF_NUMBER)
#define NUMBERS(name, count, bits)                                                                 \
    FIELD(name, GLTF_NUMBERS, .flags = (bits), .min_items = (count), .max_items = (count))
#define STRING(name) FIELD(name, GLTF_STRING)
#define OBJECT(name, table) FIELD(name, GLTF_OBJECT, .fields = table)
#define VITAL_OBJECT(name, table, bits)                                                            \
    FIELD(name, GLTF_OBJECT, .flags = GLTF_VITAL | (bits), .fields = table)
#define END                                                                                        \
    {                                                                                              \
        .key = 0                                                                                   \
    }

/* ---- geometry -------------------------------------------------------------------------------- */

static const gltf_field sparse_indices[] = {
    INDEX("bufferView", GLTF_VITAL | GLTF_REQUIRED), INDEX("byteOffset", GLTF_VITAL),
    FIELD("componentType", GLTF_INTEGER, .flags = GLTF_VITAL | GLTF_REQUIRED, .min = 5120,
          .max = 5126),
    END};
static const gltf_field sparse_values[] = {INDEX("bufferView", GLTF_VITAL | GLTF_REQUIRED),
                                           INDEX("byteOffset", GLTF_VITAL), END};
static const gltf_field sparse[] = {
    FIELD("count", GLTF_INTEGER, .flags = GLTF_VITAL | GLTF_REQUIRED, .min = 1, .max = INDEX_MAX),
    VITAL_OBJECT("indices", sparse_indices, GLTF_REQUIRED),
    VITAL_OBJECT("values", sparse_values, GLTF_REQUIRED), END};
static const gltf_field accessor[] = {
    INDEX("bufferView", GLTF_VITAL),
    SIZE("byteOffset", GLTF_VITAL),
    FIELD("componentType", GLTF_INTEGER, .flags = GLTF_VITAL | GLTF_REQUIRED | GLTF_COMPONENT_TYPE,
          .min = 5120, .max = 5131),
    FIELD("normalized", GLTF_BOOLEAN, .flags = GLTF_VITAL),
    FIELD("count", GLTF_INTEGER, .flags = GLTF_VITAL | GLTF_REQUIRED, .min = 1,
          .max = SIZE_MAX_EXACT),
    FIELD("type", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED,
          .choices = " SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4 "),
    VITAL_OBJECT("sparse", sparse, 0),
    END};
static const gltf_field buffer[] = {FIELD("uri", GLTF_STRING, .flags = GLTF_VITAL),
                                    FIELD("byteLength", GLTF_INTEGER,
                                          .flags = GLTF_VITAL | GLTF_REQUIRED, .min = 1,
                                          .max = SIZE_MAX_EXACT),
                                    END};
/* Sizes as NUMBER, as tinygltf reads integers beyond an int wrongly; the shim looks at them. */
static const gltf_field meshopt[] = {
    INDEX("buffer", GLTF_VITAL | GLTF_REQUIRED),
    FIELD("byteOffset", GLTF_NUMBER, .flags = GLTF_VITAL),
    FIELD("byteLength", GLTF_NUMBER, .flags = GLTF_VITAL | GLTF_REQUIRED),
    FIELD("byteStride", GLTF_INTEGER, .flags = GLTF_VITAL | GLTF_REQUIRED, .min = 1, .max = 256),
    FIELD("count", GLTF_NUMBER, .flags = GLTF_VITAL | GLTF_REQUIRED),
    FIELD("mode", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED,
          .choices = " ATTRIBUTES TRIANGLES INDICES "),
    FIELD("filter", GLTF_STRING, .flags = GLTF_VITAL,
          .choices = " NONE OCTAHEDRAL QUATERNION EXPONENTIAL COLOR "),
    END};
static const gltf_field buffer_view_extensions[] = {
    VITAL_OBJECT("EXT_meshopt_compression", meshopt, 0),
    VITAL_OBJECT("KHR_meshopt_compression", meshopt, 0), END};
static const gltf_field buffer_view[] = {
    INDEX("buffer", GLTF_VITAL | GLTF_REQUIRED),
    SIZE("byteOffset", GLTF_VITAL),
    FIELD("byteLength", GLTF_INTEGER, .flags = GLTF_VITAL | GLTF_REQUIRED, .min = 1,
          .max = SIZE_MAX_EXACT),
    FIELD("byteStride", GLTF_INTEGER, .flags = GLTF_VITAL, .max = 252, .step = 4),
    OBJECT("extensions", buffer_view_extensions),
    END};

/* tinygltf refuses indices whose accessor has no buffer view or does not exist. Under the key
 * "extras" it hands the number on as it is; the shim takes it from there. */
static const gltf_field variant_mapping[] = {
    INDEX("material", GLTF_REQUIRED),
    FIELD("variants", GLTF_INTEGERS, .flags = GLTF_REQUIRED, .max = INDEX_MAX), END};
static const gltf_field primitive_variants[] = {
    FIELD("mappings", GLTF_OBJECTS, .flags = GLTF_REQUIRED, .fields = variant_mapping), END};
static const gltf_field draco[] = {
    INDEX("bufferView", GLTF_VITAL | GLTF_REQUIRED),
    FIELD("attributes", GLTF_INDEX_MAP, .flags = GLTF_VITAL | GLTF_REQUIRED), END};
static const gltf_field primitive_extensions[] = {
    VITAL_OBJECT("KHR_draco_mesh_compression", draco, 0),
    OBJECT("KHR_materials_variants", primitive_variants), END};
static const gltf_field primitive[] = {
    FIELD("attributes", GLTF_INDEX_MAP, .flags = GLTF_VITAL | GLTF_REQUIRED),
    FIELD("indices", GLTF_INTEGER, .flags = GLTF_VITAL, .max = INDEX_MAX, .rename = "extras"),
    FIELD("extras", GLTF_ANY, .rename = "_"),
    INDEX("material", GLTF_VITAL),
    FIELD("mode", GLTF_INTEGER, .flags = GLTF_VITAL, .max = 6),
    OBJECT("extensions", primitive_extensions),
    FIELD("targets", GLTF_INDEX_MAPS, .flags = GLTF_VITAL),
    END};
static const gltf_field mesh[] = {
    STRING("name"),
    FIELD("primitives", GLTF_OBJECTS, .flags = GLTF_VITAL | GLTF_REQUIRED, .fields = primitive),
    FIELD("weights", GLTF_NUMBERS, .flags = GLTF_VITAL), END};

/* ---- nodes ----------------------------------------------------------------------------------- */

/* extras may be anything (specification, 3.4); ours are objects with these members */
static const gltf_field area_extras[] = {STRING("shape"), NUMBER("radiance"), NUMBER("power_w"),
                                         NUMBERS("color", 3, 0), END};
static const gltf_field lamp_extras[] = {NUMBER("ppm_radius"), NUMBER("ppm_angle"),
                                         NUMBER("ppm_blend"), STRING("ppm_light_group"), END};
static const gltf_field node_extras[] = {NUMBER("ppm_radius"),      NUMBER("ppm_angle"),
                                         NUMBER("ppm_blend"),       OBJECT("ppm_area", area_extras),
                                         STRING("ppm_light_group"), END};
static const gltf_field node_light[] = {INDEX("light", GLTF_REQUIRED), END};
static const gltf_field node_instancing[] = {
    FIELD("attributes", GLTF_INDEX_MAP, .flags = GLTF_VITAL | GLTF_REQUIRED), END};
static const gltf_field node_visibility[] = {FIELD("visible", GLTF_BOOLEAN), END};
static const gltf_field node_light_ies[] = {INDEX("light", GLTF_REQUIRED), NUMBER("multiplier"),
                                            NUMBERS("color", 3, 0), END};
static const gltf_field node_extensions[] = {
    OBJECT("KHR_lights_punctual", node_light),
    OBJECT("EXT_lights_area", node_light),
    OBJECT("EXT_lights_ies", node_light_ies),
    VITAL_OBJECT("EXT_mesh_gpu_instancing", node_instancing, 0),
    OBJECT("KHR_node_visibility", node_visibility),
    END};
static const gltf_field node[] = {
    STRING("name"),
    INDEX("mesh", GLTF_VITAL),
    INDEX("camera", 0),
    INDEX("skin", GLTF_VITAL),
    FIELD("children", GLTF_INTEGERS, .flags = GLTF_VITAL, .max = INDEX_MAX),
    NUMBERS("matrix", 16, GLTF_VITAL),
    NUMBERS("translation", 3, GLTF_VITAL),
    NUMBERS("rotation", 4, GLTF_VITAL),
    NUMBERS("scale", 3, GLTF_VITAL),
    FIELD("weights", GLTF_NUMBERS, .flags = GLTF_VITAL),
    OBJECT("extensions", node_extensions),
    FIELD("extras", GLTF_OBJECT, .flags = GLTF_FREE_FORM, .fields = node_extras),
    END};
static const gltf_field scene_environment[] = {INDEX("environment_map", GLTF_REQUIRED), END};
static const gltf_field scene_extensions[] = {OBJECT("EXT_lights_image_based", node_light),
                                              OBJECT("KHR_environment_map", scene_environment),
                                              END};
static const gltf_field scene[] = {
    STRING("name"), FIELD("nodes", GLTF_INTEGERS, .flags = GLTF_VITAL, .max = INDEX_MAX),
    OBJECT("extensions", scene_extensions), END};

static const gltf_field skin[] = {
    STRING("name"), INDEX("inverseBindMatrices", GLTF_VITAL),
    FIELD("joints", GLTF_INTEGERS, .flags = GLTF_VITAL | GLTF_REQUIRED, .max = INDEX_MAX), END};

/* ---- animations ------------------------------------------------------------------------------ */

static const gltf_field animation_pointer[] = {
    FIELD("pointer", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED), END};
static const gltf_field animation_extensions[] = {
    VITAL_OBJECT("KHR_animation_pointer", animation_pointer, 0), END};
static const gltf_field animation_target[] = {
    INDEX("node", GLTF_VITAL), FIELD("path", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED),
    VITAL_OBJECT("extensions", animation_extensions, 0), END};
static const gltf_field animation_channel[] = {
    INDEX("sampler", GLTF_VITAL | GLTF_REQUIRED),
    VITAL_OBJECT("target", animation_target, GLTF_REQUIRED), END};
static const gltf_field animation_sampler[] = {
    INDEX("input", GLTF_VITAL | GLTF_REQUIRED), INDEX("output", GLTF_VITAL | GLTF_REQUIRED),
    FIELD("interpolation", GLTF_STRING, .flags = GLTF_VITAL,
          .choices = " LINEAR STEP CUBICSPLINE "),
    END};
static const gltf_field animation[] = {
    STRING("name"),
    FIELD("channels", GLTF_OBJECTS, .flags = GLTF_VITAL | GLTF_REQUIRED, .min_items = 1,
          .fields = animation_channel),
    FIELD("samplers", GLTF_OBJECTS, .flags = GLTF_VITAL | GLTF_REQUIRED, .min_items = 1,
          .fields = animation_sampler),
    END};

/* ---- cameras and lights ---------------------------------------------------------------------- */

static const gltf_field perspective[] = {
    NUMBER("aspectRatio"), FIELD("yfov", GLTF_NUMBER, .flags = GLTF_VITAL | GLTF_REQUIRED),
    FIELD("znear", GLTF_NUMBER, .flags = GLTF_VITAL | GLTF_REQUIRED), NUMBER("zfar"), END};
static const gltf_field orthographic[] = {
    FIELD("xmag", GLTF_NUMBER, .flags = GLTF_VITAL | GLTF_REQUIRED),
    FIELD("ymag", GLTF_NUMBER, .flags = GLTF_VITAL | GLTF_REQUIRED),
    FIELD("zfar", GLTF_NUMBER, .flags = GLTF_VITAL | GLTF_REQUIRED),
    FIELD("znear", GLTF_NUMBER, .flags = GLTF_VITAL | GLTF_REQUIRED), END};
static const gltf_field camera_extras[] = {NUMBERS("ppm_shift", 2, 0), END};
static const gltf_field physical_camera[] = {
    FIELD("focalLength", GLTF_NUMBER, .flags = GLTF_REQUIRED),
    NUMBERS("sensorSize", 2, GLTF_REQUIRED), NUMBER("fStop"), NUMBER("focusDistance"), END};
static const gltf_field camera_extensions[] = {OBJECT("EXT_camera_physical", physical_camera), END};
static const gltf_field camera[] = {
    STRING("name"),
    FIELD("extras", GLTF_OBJECT, .flags = GLTF_FREE_FORM, .fields = camera_extras),
    FIELD("type", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED | GLTF_NAMES_MEMBER,
          .choices = " perspective orthographic "),
    VITAL_OBJECT("perspective", perspective, 0),
    VITAL_OBJECT("orthographic", orthographic, 0),
    OBJECT("extensions", camera_extensions),
    END};

static const gltf_field spot[] = {NUMBER("innerConeAngle"), NUMBER("outerConeAngle"), END};
static const gltf_field light[] = {
    STRING("name"),
    NUMBERS("color", 3, 0),
    NUMBER("intensity"),
    NUMBER("range"),
    FIELD("type", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED | GLTF_NAMES_MEMBER,
          .choices = " point spot directional "),
    VITAL_OBJECT("spot", spot, 0),
    FIELD("extras", GLTF_OBJECT, .flags = GLTF_FREE_FORM, .fields = lamp_extras),
    END};

/* EXT_lights_area (draft of 2025), EXT_lights_ies, EXT_lights_image_based */
static const gltf_field rect[] = {NUMBER("aspect"), END};
static const gltf_field area_light[] = {
    STRING("name"),
    NUMBERS("color", 3, 0),
    NUMBER("intensity"),
    NUMBER("size"),
    FIELD("type", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED, .choices = " rect disk "),
    OBJECT("rect", rect),
    FIELD("extras", GLTF_OBJECT, .flags = GLTF_FREE_FORM, .fields = lamp_extras),
    END};
static const gltf_field light_profile[] = {
    STRING("name"), FIELD("uri", GLTF_STRING, .flags = GLTF_VITAL), STRING("mimeType"),
    INDEX("bufferView", GLTF_VITAL), END};
static const gltf_field image_light[] = {STRING("name"), NUMBER("intensity"),
                                         NUMBERS("rotation", 4, 0), NUMBER("specularImageSize"),
                                         END};

/* KHR_environment_map, by the text of its draft; its schema files have other names */
static const gltf_field cubemap[] = {INDEX("source", GLTF_VITAL | GLTF_REQUIRED), INDEX("layer", 0),
                                     NUMBER("intensity"), END};
static const gltf_field environment_map[] = {STRING("name"),
                                             INDEX("cubemap", 0),
                                             NUMBER("irradianceFactor"),
                                             NUMBERS("boundingBoxMin", 3, 0),
                                             NUMBERS("boundingBoxMax", 3, 0),
                                             NUMBER("ior"),
                                             END};

/* ---- materials ------------------------------------------------------------------------------- */

static const gltf_field texture_transform[] = {NUMBERS("offset", 2, 0), NUMBER("rotation"),
                                               NUMBERS("scale", 2, 0), INDEX("texCoord", 0), END};
static const gltf_field texture_info_extensions[] = {
    OBJECT("KHR_texture_transform", texture_transform), END};
static const gltf_field texture_info[] = {INDEX("index", GLTF_REQUIRED),
                                          INDEX("texCoord", 0),
                                          NUMBER("scale"),
                                          NUMBER("strength"),
                                          OBJECT("extensions", texture_info_extensions),
                                          END};
static const gltf_field pbr[] = {NUMBERS("baseColorFactor", 4, 0),
                                 OBJECT("baseColorTexture", texture_info),
                                 NUMBER("metallicFactor"),
                                 NUMBER("roughnessFactor"),
                                 OBJECT("metallicRoughnessTexture", texture_info),
                                 END};
static const gltf_field dispersion[] = {NUMBER("dispersion"), END};
static const gltf_field emissive_strength[] = {NUMBER("emissiveStrength"), END};
static const gltf_field ior[] = {NUMBER("ior"), END};
static const gltf_field specular_edge_color[] = {FIELD("specularEdgeColorEnabled", GLTF_BOOLEAN),
                                                 END};
static const gltf_field specular_extensions[] = {
    OBJECT("EXT_materials_specular_edge_color", specular_edge_color), END};
static const gltf_field specular[] = {NUMBER("specularFactor"),
                                      OBJECT("specularTexture", texture_info),
                                      NUMBERS("specularColorFactor", 3, 0),
                                      OBJECT("specularColorTexture", texture_info),
                                      OBJECT("extensions", specular_extensions),
                                      END};
static const gltf_field transmission[] = {NUMBER("transmissionFactor"),
                                          OBJECT("transmissionTexture", texture_info), END};
static const gltf_field volume[] = {
    NUMBER("thicknessFactor"), OBJECT("thicknessTexture", texture_info),
    NUMBER("attenuationDistance"), NUMBERS("attenuationColor", 3, 0), END};
static const gltf_field no_fields[] = {END};
static const gltf_field anisotropy[] = {NUMBER("anisotropyStrength"), NUMBER("anisotropyRotation"),
                                        OBJECT("anisotropyTexture", texture_info), END};
static const gltf_field clearcoat[] = {NUMBER("clearcoatFactor"),
                                       OBJECT("clearcoatTexture", texture_info),
                                       NUMBER("clearcoatRoughnessFactor"),
                                       OBJECT("clearcoatRoughnessTexture", texture_info),
                                       OBJECT("clearcoatNormalTexture", texture_info),
                                       END};
static const gltf_field coat[] = {NUMBER("coatFactor"),
                                  OBJECT("coatTexture", texture_info),
                                  NUMBER("coatRoughnessFactor"),
                                  OBJECT("coatRoughnessTexture", texture_info),
                                  OBJECT("coatNormalTexture", texture_info),
                                  NUMBER("coatIor"),
                                  NUMBERS("coatColorFactor", 3, 0),
                                  OBJECT("coatColorTexture", texture_info),
                                  NUMBER("coatDarkeningFactor"),
                                  NUMBER("coatAnisotropyStrength"),
                                  NUMBER("coatAnisotropyRotation"),
                                  OBJECT("coatAnisotropyTexture", texture_info),
                                  END};
static const gltf_field diffuse_roughness[] = {
    NUMBER("diffuseRoughnessFactor"), OBJECT("diffuseRoughnessTexture", texture_info), END};
static const gltf_field fuzz[] = {NUMBER("fuzzFactor"),
                                  OBJECT("fuzzTexture", texture_info),
                                  NUMBERS("fuzzColorFactor", 3, 0),
                                  OBJECT("fuzzColorTexture", texture_info),
                                  NUMBER("fuzzRoughnessFactor"),
                                  OBJECT("fuzzRoughnessTexture", texture_info),
                                  END};
static const gltf_field diffuse_transmission[] = {
    NUMBER("diffuseTransmissionFactor"), OBJECT("diffuseTransmissionTexture", texture_info),
    NUMBERS("diffuseTransmissionColorFactor", 3, 0),
    OBJECT("diffuseTransmissionColorTexture", texture_info), END};
static const gltf_field iridescence[] = {NUMBER("iridescenceFactor"),
                                         OBJECT("iridescenceTexture", texture_info),
                                         NUMBER("iridescenceIor"),
                                         NUMBER("iridescenceThicknessMinimum"),
                                         NUMBER("iridescenceThicknessMaximum"),
                                         OBJECT("iridescenceThicknessTexture", texture_info),
                                         END};
static const gltf_field retroreflection[] = {NUMBER("retroreflectionFactor"),
                                             OBJECT("retroreflectionTexture", texture_info), END};
static const gltf_field sheen[] = {
    NUMBERS("sheenColorFactor", 3, 0), OBJECT("sheenColorTexture", texture_info),
    NUMBER("sheenRoughnessFactor"), OBJECT("sheenRoughnessTexture", texture_info), END};
static const gltf_field specular_glossiness[] = {NUMBERS("diffuseFactor", 4, 0),
                                                 OBJECT("diffuseTexture", texture_info),
                                                 NUMBERS("specularFactor", 3, 0),
                                                 NUMBER("glossinessFactor"),
                                                 OBJECT("specularGlossinessTexture", texture_info),
                                                 END};
static const gltf_field volume_scatter[] = {
    NUMBERS("multiscatterColor", 3, 0), NUMBERS("multiscatterColorFactor", 3, 0),
    OBJECT("multiscatterColorTexture", texture_info), NUMBER("scatterAnisotropy"), END};
static const gltf_field scatter[] = {NUMBER("scatterStrengthFactor"),
                                     OBJECT("scatterStrengthTexture", texture_info),
                                     NUMBERS("multiscatterColorFactor", 3, 0),
                                     OBJECT("multiscatterColorTexture", texture_info),
                                     NUMBER("scatterAnisotropy"),
                                     END};
static const gltf_field material_extensions[] = {
    OBJECT("EXT_materials_retroreflection", retroreflection),
    OBJECT("KHR_materials_anisotropy", anisotropy),
    OBJECT("KHR_materials_clearcoat", clearcoat),
    OBJECT("KHR_materials_coat", coat),
    OBJECT("KHR_materials_diffuse_roughness", diffuse_roughness),
    OBJECT("KHR_materials_diffuse_transmission", diffuse_transmission),
    OBJECT("KHR_materials_dispersion", dispersion),
    OBJECT("KHR_materials_emissive_strength", emissive_strength),
    OBJECT("KHR_materials_fuzz", fuzz),
    OBJECT("KHR_materials_ior", ior),
    OBJECT("KHR_materials_iridescence", iridescence),
    OBJECT("KHR_materials_pbrSpecularGlossiness", specular_glossiness),
    OBJECT("KHR_materials_retroreflection", retroreflection),
    OBJECT("KHR_materials_scatter", scatter),
    OBJECT("KHR_materials_sheen", sheen),
    OBJECT("KHR_materials_specular", specular),
    OBJECT("KHR_materials_transmission", transmission),
    OBJECT("KHR_materials_unlit", no_fields),
    OBJECT("KHR_materials_volume", volume),
    OBJECT("KHR_materials_volume_scatter", volume_scatter),
    END};
/* extras may be anything (specification, 3.4); ours is an object with this member */
static const gltf_field material_extras[] = {NUMBER("ppm_priority"), END};
static const gltf_field material[] = {
    STRING("name"),
    OBJECT("pbrMetallicRoughness", pbr),
    OBJECT("normalTexture", texture_info),
    OBJECT("occlusionTexture", texture_info),
    OBJECT("emissiveTexture", texture_info),
    NUMBERS("emissiveFactor", 3, 0),
    FIELD("alphaMode", GLTF_STRING, .choices = " OPAQUE MASK BLEND "),
    NUMBER("alphaCutoff"),
    FIELD("doubleSided", GLTF_BOOLEAN),
    OBJECT("extensions", material_extensions),
    FIELD("extras", GLTF_OBJECT, .flags = GLTF_FREE_FORM, .fields = material_extras),
    END};

static const gltf_field texture_source[] = {INDEX("source", GLTF_REQUIRED), END};
static const gltf_field texture_extensions[] = {
    OBJECT("EXT_texture_webp", texture_source), OBJECT("EXT_texture_avif", texture_source),
    OBJECT("MSFT_texture_dds", texture_source), OBJECT("KHR_texture_basisu", texture_source),
    OBJECT("EXT_texture_astc", texture_source), END};
static const gltf_field texture[] = {INDEX("sampler", 0), INDEX("source", 0),
                                     OBJECT("extensions", texture_extensions), END};
static const gltf_field image[] = {STRING("name"), FIELD("uri", GLTF_STRING, .flags = GLTF_VITAL),
                                   STRING("mimeType"), INDEX("bufferView", GLTF_VITAL), END};
static const gltf_field sampler[] = {INDEX("magFilter", 0), INDEX("minFilter", 0),
                                     INDEX("wrapS", 0), INDEX("wrapT", 0), END};

/* ---- the root -------------------------------------------------------------------------------- */

#define LIST(name, id, bits, table, instead)                                                       \
    FIELD(name, GLTF_LIST, .flags = (bits), .list = (id), .fields = table, .placeholder = instead)

static const gltf_field punctual[] = {
    LIST("lights", PPMI_GLTF_LIGHTS, 0, light, "{\"type\":\"point\"}"), END};
static const gltf_field area_lights[] = {
    LIST("lights", PPMI_GLTF_AREA_LIGHTS, GLTF_KEEPS_EMPTY, area_light, "{\"type\":\"disk\"}"),
    END};
static const gltf_field light_profiles[] = {
    LIST("lights", PPMI_GLTF_LIGHT_PROFILES, GLTF_KEEPS_EMPTY, light_profile, "{\"_\":0}"), END};
static const gltf_field image_lights[] = {
    LIST("lights", PPMI_GLTF_IMAGE_LIGHTS, GLTF_KEEPS_EMPTY, image_light, "{\"_\":0}"), END};
static const gltf_field environment_maps[] = {
    LIST("cubemaps", PPMI_GLTF_CUBEMAPS, GLTF_KEEPS_EMPTY, cubemap, "{\"_\":0}"),
    LIST("environment_maps", PPMI_GLTF_ENVIRONMENT_MAPS, GLTF_KEEPS_EMPTY, environment_map,
         "{\"_\":0}"),
    END};
static const gltf_field variant[] = {
    FIELD("name", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED), END};
static const gltf_field variants[] = {
    LIST("variants", PPMI_GLTF_VARIANTS, 0, variant, "{\"name\":\"\"}"), END};
static const gltf_field root_extensions[] = {OBJECT("KHR_lights_punctual", punctual),
                                             OBJECT("EXT_lights_area", area_lights),
                                             OBJECT("EXT_lights_ies", light_profiles),
                                             OBJECT("EXT_lights_image_based", image_lights),
                                             OBJECT("KHR_environment_map", environment_maps),
                                             OBJECT("KHR_materials_variants", variants),
                                             END};
static const gltf_field asset_xmp[] = {INDEX("packet", 0), END};
static const gltf_field asset_extensions[] = {OBJECT("KHR_xmp_json_ld", asset_xmp), END};
static const gltf_field asset[] = {
    FIELD("version", GLTF_STRING, .flags = GLTF_VITAL | GLTF_REQUIRED),
    STRING("generator"),
    STRING("copyright"),
    STRING("minVersion"),
    OBJECT("extensions", asset_extensions),
    END};

const gltf_field ppmi_gltf_schema[] = {
    VITAL_OBJECT("asset", asset, GLTF_REQUIRED), FIELD("extensionsUsed", GLTF_STRINGS),
    FIELD("extensionsRequired", GLTF_STRINGS, .flags = GLTF_VITAL),
    FIELD("scene", GLTF_INTEGER, .flags = GLTF_VITAL, .max = INDEX_MAX),
    LIST("scenes", PPMI_GLTF_SCENES, GLTF_VITAL, scene, "{}"),
    LIST("nodes", PPMI_GLTF_NODES, GLTF_VITAL, node, "{}"),
    LIST("meshes", PPMI_GLTF_MESHES, GLTF_VITAL, mesh, "{\"primitives\":[]}"),
    LIST("accessors", PPMI_GLTF_ACCESSORS, GLTF_VITAL, accessor,
         "{\"componentType\":5121,\"count\":1,\"type\":\"SCALAR\"}"),
    LIST("bufferViews", PPMI_GLTF_BUFFER_VIEWS, GLTF_VITAL, buffer_view,
         "{\"buffer\":0,\"byteLength\":1}"),
    LIST("buffers", PPMI_GLTF_BUFFERS, GLTF_VITAL | GLTF_EMPTY_FOR_TINYGLTF, buffer, "{}"),
    LIST("materials", PPMI_GLTF_MATERIALS, 0, material, "{}"),
    LIST("textures", PPMI_GLTF_TEXTURES, 0, texture, "{}"),
    LIST("images", PPMI_GLTF_IMAGES, GLTF_EMPTY_FOR_TINYGLTF, image, "{}"),
    LIST("samplers", PPMI_GLTF_SAMPLERS, 0, sampler, "{}"),
    LIST("cameras", PPMI_GLTF_CAMERAS, 0, camera,
         "{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}"),
    /* tinygltf drops channels without a node, which KHR_animation_pointer has. Under the key
     * "extras" it hands the list on as it is, but for what is empty. */
    FIELD("animations", GLTF_LIST, .list = PPMI_GLTF_ANIMATIONS, .fields = animation,
          .placeholder = "{\"name\":\"\"}", .rename = "extras"),
    FIELD("extras", GLTF_ANY, .rename = "_"),
    LIST("skins", PPMI_GLTF_SKINS, GLTF_VITAL, skin, "{\"joints\":[]}"),
    OBJECT("extensions", root_extensions), END};
