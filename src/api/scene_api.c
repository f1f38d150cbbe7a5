/* Public scene calls that need more than the scene: creation with colour, import. */
#include <string.h>
#include <strings.h>

#include "color/color.h"
#include "gltf/gltf_import.h"
#include "obj/obj_import.h"
#include "ppm/import.h"
#include "scene/scene.h"

ppm_status ppm_scene_create(ppm_context *context, const ppm_color *color, ppm_scene **out_scene)
{
    if (!context || !out_scene) return PPM_STATUS_INVALID_ARGUMENT;
    ppm_scene *scene = ppmi_alloc_zeroed(context, 1, sizeof *scene);
    if (!scene) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for a scene");
    scene->context = context;
    const ppm_status status = ppmi_color_srgb_decode_table(context, color, scene->srgb_to_linear);
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, scene);
        return status;
    }
    *out_scene = scene;
    return PPM_STATUS_OK;
}

ppm_status ppm_scene_import(ppm_scene *scene, const char *path, const ppm_import_options *options)
{
    const ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    if (!path || (options && options->size < sizeof *options)) return PPM_STATUS_INVALID_ARGUMENT;
    const ppm_import_options defaults = {.size = sizeof defaults};
    if (!options) options = &defaults;
    const char *dot = strrchr(path, '.');
    if (dot && (strcasecmp(dot, ".gltf") == 0 || strcasecmp(dot, ".glb") == 0)) {
        return ppmi_gltf_import(scene->context, scene, path, options);
    }
    if (dot && strcasecmp(dot, ".obj") == 0) {
        return ppmi_obj_import(scene->context, scene, path, options);
    }
    return ppmi_fail(scene->context, PPM_STATUS_INPUT_UNSUPPORTED,
                     "%s: the ending is none of .gltf, .glb and .obj", path);
}
