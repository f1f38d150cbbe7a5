/* extensionsRequired and extensionsUsed. A required extension that is not read changes what the
 * geometry is, or what the author thought indispensable: the file is refused by its name. */
#include "gltf/gltf_extensions.h"

#include <string.h>

enum { MAX_LISTED = 64 }; /* of the used ones */

/* One row per extension, by name: what becomes of it, and how it is approximated or what is
 * missing. Of those that are ignored only those that people meet and can do something about. */
static const struct {
    const char *name;
    int32_t verdict;
    const char *note;
} rows[] = {
    {"EXT_mesh_gpu_instancing", PPM_FEATURE_HONOURED, ""},
    {"EXT_meshopt_compression", PPM_FEATURE_IGNORED,
     "the geometry is compressed; write the file without mesh compression"},
    {"EXT_texture_webp", PPM_FEATURE_HONOURED, ""},
    {"KHR_draco_mesh_compression", PPM_FEATURE_IGNORED,
     "the geometry is compressed; write the file without mesh compression"},
    {"KHR_animation_pointer", PPM_FEATURE_HONOURED, ""},
    {"KHR_lights_punctual", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_dispersion", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_emissive_strength", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_ior", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_specular", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_transmission", PPM_FEATURE_HONOURED, ""},
    {"KHR_materials_unlit", PPM_FEATURE_APPROXIMATED,
     "such a material shines with its base colour, 1 nit for white, and reflects nothing"},
    {"KHR_materials_volume", PPM_FEATURE_HONOURED,
     "the true distance through the solid counts; thicknessTexture is not used"},
    {"KHR_mesh_quantization", PPM_FEATURE_HONOURED, ""},
    {"KHR_meshopt_compression", PPM_FEATURE_IGNORED,
     "the geometry is compressed; write the file without mesh compression"},
    {"KHR_node_visibility", PPM_FEATURE_HONOURED, ""},
    {"KHR_texture_basisu", PPM_FEATURE_IGNORED,
     "the textures are KTX2 files; write them as PNG, JPEG or WebP"},
    {"KHR_texture_transform", PPM_FEATURE_HONOURED, ""},
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

static bool contains(const char *const *names, size_t count, const char *name)
{
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(names[i], name) == 0) return true;
    }
    return false;
}

/* A required extension that is not read, with what to do about it. */
static ppm_status refuse(ppmi_gltf_reader *reader, size_t index, const char *shown, size_t row)
{
    return ppmi_fail(reader->context, PPM_STATUS_INPUT_UNSUPPORTED,
                     "%s: extensionsRequired[%zu]: %s is not supported%s%s", reader->path, index,
                     shown, row < ROW_COUNT ? ": " : "", row < ROW_COUNT ? rows[row].note : "");
}

ppm_status ppmi_gltf_check_extensions(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    char shown[128];
    for (size_t i = 0; i < document->required_count; ++i) {
        const char *name = document->extensions_required[i];
        const size_t row = find_row(name);
        if (row < ROW_COUNT && rows[row].verdict != PPM_FEATURE_IGNORED) continue;
        ppmi_gltf_printable(name, strlen(name), shown, sizeof shown);
        return refuse(reader, i, shown, row);
    }
    for (size_t i = 0; i < document->used_count && i < MAX_LISTED; ++i) {
        const char *name = document->extensions_used[i];
        const size_t row = find_row(name);
        if (contains(document->extensions_used, i, name)) continue;
        ppmi_gltf_printable(name, strlen(name), shown, sizeof shown);
        ppmi_gltf_note_feature(reader, shown,
                               row < ROW_COUNT ? rows[row].verdict : PPM_FEATURE_IGNORED,
                               row < ROW_COUNT ? rows[row].note : "the extension is not known");
    }
    return PPM_STATUS_OK;
}
