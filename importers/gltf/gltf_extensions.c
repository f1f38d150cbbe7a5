/* extensionsRequired and extensionsUsed. A required extension that is not read changes what the
 * geometry is, or what the author thought indispensable: the file is refused by its name. */
#include "gltf/gltf_extensions.h"

#include <string.h>

enum { MAX_LISTED = 64 }; /* of the used ones */

static const char *const supported[] = {
    "EXT_lights_area",
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
};

static bool is_supported(const char *name)
{
    for (size_t i = 0; i < sizeof supported / sizeof supported[0]; ++i) {
        if (strcmp(supported[i], name) == 0) return true;
    }
    return false;
}

/* What to do about one that people meet. */
static const char *advice(const char *name)
{
    if (strcmp(name, "KHR_draco_mesh_compression") == 0 || strstr(name, "meshopt_compression")) {
        return ": the geometry is compressed; write the file without mesh compression";
    }
    if (strcmp(name, "KHR_texture_basisu") == 0) {
        return ": the textures are KTX2 files; write them as PNG, JPEG or WebP";
    }
    return "";
}

static bool contains(const char *const *names, size_t count, const char *name)
{
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(names[i], name) == 0) return true;
    }
    return false;
}

ppm_status ppmi_gltf_check_extensions(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    char shown[128];
    for (size_t i = 0; i < document->required_count; ++i) {
        const char *name = document->extensions_required[i];
        if (is_supported(name)) continue;
        return ppmi_fail(reader->context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: extensionsRequired[%zu]: %s is not supported%s", reader->path, i,
                         ppmi_gltf_printable(name, strlen(name), shown, sizeof shown),
                         advice(name));
    }
    for (size_t i = 0; i < document->used_count && i < MAX_LISTED; ++i) {
        const char *name = document->extensions_used[i];
        const bool is_repeated = contains(document->extensions_used, i, name);
        if (is_supported(name) || is_repeated) continue;
        ppmi_log(reader->context, PPM_LOG_WARNING,
                 "%s: extensionsUsed[%zu]: %s is not supported and left out", reader->path, i,
                 ppmi_gltf_printable(name, strlen(name), shown, sizeof shown));
    }
    return PPM_STATUS_OK;
}
