/* Public scene calls that need more than the scene: creation with colour, import. */
#include "color/color.h"
#include "scene/scene.h"

ppm_status ppm_scene_create(ppm_context *context, const ppm_color *color, ppm_scene **out_scene)
{
    if (!context || !out_scene) return PPM_STATUS_INVALID_ARGUMENT;
    ppm_scene *scene = ppmi_alloc_zeroed(context, 1, sizeof *scene);
    if (!scene) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "out of memory for a scene");
    scene->context = context;
    scene->color = color;
    scene->working = *ppmi_color_working_space(color);
    const ppm_status status = ppmi_color_srgb_decode_table(context, color, scene->srgb_to_linear);
    if (status != PPM_STATUS_OK) {
        ppmi_free(context, scene);
        return status;
    }
    *out_scene = scene;
    return PPM_STATUS_OK;
}
