/* extensionsRequired and extensionsUsed. A required extension that is not read changes what the
 * geometry is, or what the author thought indispensable: the file is refused by its name. */
#include "gltf/gltf_extensions.h"

#include <string.h>

enum { MAX_LISTED = 64 }; /* of the used ones */

#define NO_EFFECT "no effect on the picture"

/* One row per extension, by name: what becomes of it, and how it is approximated or what is
 * missing. Of those that are ignored only those that people meet and can do something about.
 * docs/gltf.md has the same rows. */
static const struct {
    const char *name;
    int32_t verdict;
    const char *note;
} rows[] = {
    {"AGI_articulations", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"AGI_stk_metadata", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"CESIUM_RTC", PPM_FEATURE_HONOURED, "the whole scene is moved as one; " NO_EFFECT},
    {"CESIUM_primitive_outline", PPM_FEATURE_IGNORED, "no outlines are drawn"},
    {"EXT_camera_physical", PPM_FEATURE_HONOURED,
     "the proposal of 2026: the lens, from fStop and focusDistance"},
    {"EXT_instance_features", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"EXT_lights_area", PPM_FEATURE_HONOURED, "the proposal"},
    {"EXT_lights_ies", PPM_FEATURE_HONOURED, ""},
    {"EXT_lights_image_based", PPM_FEATURE_HONOURED, ""},
    {"EXT_materials_retroreflection", PPM_FEATURE_HONOURED,
     "as KHR_materials_retroreflection, which it became"},
    {"EXT_materials_specular_edge_color", PPM_FEATURE_HONOURED, "the draft of 2025"},
    {"EXT_mesh_features", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"EXT_mesh_gpu_instancing", PPM_FEATURE_HONOURED, ""},
    {"EXT_mesh_manifold", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"EXT_mesh_opacity_micromap", PPM_FEATURE_HONOURED,
     "a help to find what alpha cuts out; " NO_EFFECT},
    {"EXT_mesh_primitive_edge_visibility", PPM_FEATURE_IGNORED, "no edges are drawn"},
    {"EXT_mesh_primitive_restart", PPM_FEATURE_HONOURED,
     "the primitives that a group joins are shown as they are: the same picture"},
    {"EXT_meshopt_compression", PPM_FEATURE_HONOURED, ""},
    {"EXT_structural_metadata", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"EXT_texture_astc", PPM_FEATURE_HONOURED, ""},
    {"EXT_texture_avif", PPM_FEATURE_HONOURED, ""},
    {"EXT_texture_webp", PPM_FEATURE_HONOURED, ""},
    {"FB_geometry_metadata", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"FB_ngon_encoding", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"GODOT_single_root", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"GRIFFEL_bim_data", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"KHR_accessor_float16", PPM_FEATURE_HONOURED, "the draft of 2025"},
    {"KHR_accessor_float64", PPM_FEATURE_HONOURED,
     "the draft of 2024: positions and keys are rounded once they are near the point 0"},
    {"KHR_animation_pointer", PPM_FEATURE_HONOURED, ""},
    {"KHR_audio_emitter", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"KHR_audio_graph", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"KHR_collision_shapes", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"KHR_draco_mesh_compression", PPM_FEATURE_HONOURED, ""},
    {"KHR_environment_map", PPM_FEATURE_HONOURED,
     "the draft; bounding boxes are not used (warned about), the cube is infinitely far away"},
    {"KHR_gaussian_splatting", PPM_FEATURE_APPROXIMATED, "splats are shown as points"},
    {"KHR_implicit_shapes", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"KHR_interactivity", PPM_FEATURE_APPROXIMATED,
     "nobody interacts: the file is shown as it begins"},
    {"KHR_lights_punctual", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_anisotropy", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_clearcoat", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_coat", PPM_FEATURE_HONOURED, "the draft of 2025"},
    {"KHR_materials_diffuse_roughness", PPM_FEATURE_HONOURED, "the draft of 2025"},
    {"KHR_materials_diffuse_transmission", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_dispersion", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_emissive_strength", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_fuzz", PPM_FEATURE_HONOURED,
     "the draft of 2025, with the fibres of KHR_materials_sheen"},
    {"KHR_materials_ior", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_iridescence", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_pbrSpecularGlossiness", PPM_FEATURE_HONOURED,
     "as a dielectric whose reflectance along the normal is the specular colour"},
    {"KHR_materials_retroreflection", PPM_FEATURE_HONOURED, "the draft of 2026"},
    {"KHR_materials_scatter", PPM_FEATURE_HONOURED, "the draft of 2026"},
    {"KHR_materials_sheen", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_specular", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_transmission", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_unlit", PPM_FEATURE_APPROXIMATED,
     "such a material shines with its base colour, 1 nit for white, and reflects nothing"},
    {"KHR_materials_variants", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_volume", PPM_FEATURE_HONOURED,
     "the true distance through the solid counts; thicknessTexture is not used"},
    {"KHR_materials_volume_scatter", PPM_FEATURE_HONOURED, "the draft of 2025"},
    {"KHR_mesh_primitive_restart", PPM_FEATURE_HONOURED, "the draft of 2026"},
    {"KHR_mesh_quantization", PPM_FEATURE_HONOURED, ""},
    {"KHR_meshopt_compression", PPM_FEATURE_HONOURED, ""},
    {"KHR_node_hoverability", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"KHR_node_selectability", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"KHR_node_visibility", PPM_FEATURE_HONOURED, ""},
    {"KHR_physics_rigid_bodies", PPM_FEATURE_APPROXIMATED,
     "nothing is simulated: bodies are where the file places them"},
    {"KHR_texture_basisu", PPM_FEATURE_HONOURED,
     "KTX2 files in ETC1S and UASTC, and of plain and BC formats"},
    {"KHR_texture_transform", PPM_FEATURE_HONOURED, ""},
    {"KHR_xmp", PPM_FEATURE_HONOURED, NO_EFFECT},
    {"KHR_xmp_json_ld", PPM_FEATURE_HONOURED, "the asset's packet, into the EXR's metadata"},
    {"MSFT_lod", PPM_FEATURE_HONOURED, "the finest level is shown"},
    {"MSFT_packing_normalRoughnessMetallic", PPM_FEATURE_APPROXIMATED,
     "the plain textures beside it are used"},
    {"MSFT_packing_occlusionRoughnessMetallic", PPM_FEATURE_APPROXIMATED,
     "the plain textures beside it are used"},
    {"MSFT_texture_dds", PPM_FEATURE_HONOURED, ""},
    {"NV_materials_mdl", PPM_FEATURE_IGNORED, "the glTF material beside it is shown"},
};
enum { ROW_COUNT = sizeof rows / sizeof rows[0] };

/* The row of an extension, or ROW_COUNT. */
static size_t find_row(const char *name)
{
    size_t i = 0;
    while (i < ROW_COUNT && strcmp(rows[i].name, name) != 0)
        ++i;
    return i;
}

/* A required extension that is not read, with what to do about it. */
static ppm_status refuse(ppmi_gltf_reader *reader, size_t index, const char *shown, size_t row)
{
    return ppmi_fail(reader->context, PPM_STATUS_INPUT_UNSUPPORTED,
                     "%s: extensionsRequired[%zu]: %s is not supported%s%s", reader->path, index,
                     shown, row < ROW_COUNT ? ": " : "", row < ROW_COUNT ? rows[row].note : "");
}

void ppmi_gltf_note_extension(ppmi_gltf_reader *reader, const char *name)
{
    char shown[128];
    const size_t row = find_row(name);
    ppmi_gltf_printable(name, strlen(name), shown, sizeof shown);
    ppmi_gltf_note_feature(reader, shown, row < ROW_COUNT ? rows[row].verdict : PPM_FEATURE_IGNORED,
                           row < ROW_COUNT ? rows[row].note : "the extension is not known");
}

/* One line for each of a list; the report drops those that come twice. */
static void note(ppmi_gltf_reader *reader, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count && i < MAX_LISTED; ++i) {
        ppmi_gltf_note_extension(reader, names[i]);
    }
    if (count > MAX_LISTED) {
        ppmi_gltf_note_feature(reader, "further extensions", PPM_FEATURE_IGNORED,
                               "the list of them is too long to be looked at as a whole");
    }
}

/* Whether all textures have an image that can be read: else, where an extension of KTX2 files is
 * required, the file would be shown without them. */
static ppm_status check_ktx2(ppmi_gltf_reader *reader, size_t required, const char *name)
{
    const bool is_astc = strcmp(name, "EXT_texture_astc") == 0;
    const ppmi_gltf_document *document = reader->document;
    char encoding[64];
    for (size_t i = 0; i < document->texture_count; ++i) {
        const ppmi_gltf_texture *texture = &document->textures[i];
        const bool has_other = texture->source >= 0 || texture->webp_source >= 0 ||
                               texture->avif_source >= 0 || texture->dds_source >= 0 ||
                               (texture->astc_source >= 0 && texture->basisu_source >= 0);
        const int32_t source = is_astc ? texture->astc_source : texture->basisu_source;
        if (has_other || source < 0) continue;
        if (!ppmi_gltf_image_is_unread(reader, source, encoding)) continue;
        return ppmi_fail(reader->context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: extensionsRequired[%zu]: %s: images[%d] is %s, which "
                         "is not supported; write it as PNG, JPEG or WebP",
                         reader->path, required, name, (int)source, encoding);
    }
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_check_extensions(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    char shown[128];
    for (size_t i = 0; i < document->required_count; ++i) {
        const char *name = document->extensions_required[i];
        const size_t row = find_row(name);
        if (strcmp(name, "KHR_texture_basisu") == 0 || strcmp(name, "EXT_texture_astc") == 0) {
            const ppm_status status = check_ktx2(reader, i, name);
            if (status != PPM_STATUS_OK) return status;
        }
        if (row < ROW_COUNT && rows[row].verdict != PPM_FEATURE_IGNORED) continue;
        ppmi_gltf_printable(name, strlen(name), shown, sizeof shown);
        return refuse(reader, i, shown, row);
    }
    note(reader, document->extensions_used, document->used_count);
    note(reader, document->extensions_required, document->required_count);
    return PPM_STATUS_OK;
}
