/* Public calls that open, import and pose files: the ending of the name chooses the importer. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "api/asset.h"
#include "scene/scene.h"

/* ---- what is asked for ----------------------------------------------------------------------- */

static ppm_status check_pose(ppm_context *context, const ppm_pose *pose)
{
    if (!pose->is_animated) return PPM_STATUS_OK;
    if (!isfinite(pose->open_s) || !isfinite(pose->close_s) || pose->close_s < pose->open_s) {
        return ppmi_fail(
            context, PPM_STATUS_INVALID_ARGUMENT,
            "pose: the shutter opens at %g s and closes at %g s; expected finite times "
            "in this order",
            pose->open_s, pose->close_s);
    }
    if (pose->motion_steps <= PPM_MAX_MOTION_STEPS) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "pose: %u motion_steps; the most are %d",
                     (unsigned)pose->motion_steps, PPM_MAX_MOTION_STEPS);
}

/* A copy of text that the asset owns; NULL stays NULL. False when memory is out. */
static bool keep(ppm_context *context, const char *text, char **out)
{
    *out = ppmi_string_copy(context, text);
    return *out || !text;
}

static ppm_status keep_request(ppm_asset *asset, const char *path,
                               const ppm_import_options *options)
{
    ppm_context *context = asset->context;
    asset->options = *options;
    if (!keep(context, path, &asset->path) || !keep(context, options->scene, &asset->scene_name) ||
        !keep(context, options->variant, &asset->variant) ||
        !keep(context, options->animation, &asset->animation)) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", path);
    }
    asset->options.scene = asset->scene_name;
    asset->options.variant = asset->variant;
    asset->options.animation = asset->animation;
    return check_pose(context, &options->pose);
}

/* ---- open and close -------------------------------------------------------------------------- */

static ppm_status open_file(ppm_asset *asset)
{
    const char *dot = strrchr(asset->path, '.');
    if (dot && (strcasecmp(dot, ".gltf") == 0 || strcasecmp(dot, ".glb") == 0)) {
        return ppmi_gltf_asset_open(asset->context, asset->path, &asset->options, &asset->gltf);
    }
    if (dot && strcasecmp(dot, ".obj") == 0) {
        return ppmi_obj_asset_open(asset->context, asset->path, &asset->obj);
    }
    return ppmi_fail(asset->context, PPM_STATUS_INPUT_UNSUPPORTED,
                     "%s: the ending is none of .gltf, .glb and .obj", asset->path);
}

ppm_status ppm_asset_open(ppm_context *context, const char *path, const ppm_import_options *options,
                          ppm_asset **out_asset)
{
    const ppm_import_options defaults = {.size = sizeof defaults};
    if (!context || !path || !out_asset || (options && options->size < sizeof *options)) {
        return PPM_STATUS_INVALID_ARGUMENT;
    }
    ppm_asset *asset = ppmi_alloc_zeroed(context, 1, sizeof *asset);
    if (!asset) return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", path);
    asset->context = context;
    ppm_status status = keep_request(asset, path, options ? options : &defaults);
    if (status == PPM_STATUS_OK) status = open_file(asset);
    if (status == PPM_STATUS_OK) status = ppmi_asset_fill_catalog(asset);
    if (status != PPM_STATUS_OK) {
        ppm_asset_close(asset);
        return status;
    }
    *out_asset = asset;
    return PPM_STATUS_OK;
}

void ppm_asset_close(ppm_asset *asset)
{
    if (!asset) return;
    ppmi_catalog_deinit(&asset->catalog);
    ppmi_gltf_asset_close(asset->gltf);
    ppmi_obj_asset_close(asset->obj);
    ppmi_free(asset->context, asset->path);
    ppmi_free(asset->context, asset->scene_name);
    ppmi_free(asset->context, asset->variant);
    ppmi_free(asset->context, asset->animation);
    ppmi_free(asset->context, asset);
}

/* ---- import ---------------------------------------------------------------------------------- */

ppm_status ppm_asset_import(ppm_asset *asset, ppm_scene *scene)
{
    if (!asset || !scene) return PPM_STATUS_INVALID_ARGUMENT;
    if (asset->scene) {
        return ppmi_fail(asset->context, PPM_STATUS_WRONG_STATE,
                         "%s: it has been imported already; open it once more", asset->path);
    }
    ppm_status status = ppmi_scene_check_open(scene);
    if (status != PPM_STATUS_OK) return status;
    asset->scene = scene;
    status = asset->gltf ? ppmi_gltf_asset_import(asset->gltf, scene)
                         : ppmi_obj_asset_import(asset->obj, scene);
    asset->is_imported = status == PPM_STATUS_OK;
    return status;
}

ppm_status ppm_asset_set_pose(ppm_asset *asset, const ppm_pose *pose)
{
    if (!asset || !pose) return PPM_STATUS_INVALID_ARGUMENT;
    if (!asset->is_imported) {
        return ppmi_fail(asset->context, PPM_STATUS_WRONG_STATE,
                         "%s: it must be imported before it is posed", asset->path);
    }
    ppm_status status = ppmi_scene_check_open(asset->scene);
    if (status == PPM_STATUS_OK) status = check_pose(asset->context, pose);
    if (status == PPM_STATUS_OK && asset->gltf) {
        status = ppmi_gltf_asset_set_pose(asset->gltf, pose);
    }
    return status;
}

ppm_status ppm_scene_import(ppm_scene *scene, const char *path, const ppm_import_options *options)
{
    ppm_asset *asset = NULL;
    ppm_status status = ppmi_scene_check_open(scene);
    if (status == PPM_STATUS_OK) status = ppm_asset_open(scene->context, path, options, &asset);
    if (status == PPM_STATUS_OK) status = ppm_asset_import(asset, scene);
    ppm_asset_close(asset);
    return status;
}
