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

static bool keep_folders(ppm_asset *asset, const ppm_import_options *options)
{
    const uint32_t count = options->texture_folder_count;
    asset->options.texture_folder_count = 0;
    asset->options.texture_folders = NULL;
    if (count == 0) return true;
    asset->texture_folders =
        ppmi_alloc_zeroed(asset->context, count, sizeof *asset->texture_folders);
    if (!asset->texture_folders) return false;
    asset->options.texture_folders = (const char *const *)asset->texture_folders;
    for (uint32_t i = 0; i < count; ++i) {
        asset->options.texture_folder_count = i + 1;
        const char *folder = options->texture_folders[i];
        if (!keep(asset->context, folder, &asset->texture_folders[i])) return false;
    }
    return true;
}

static ppm_status check_obj_options(ppm_context *context, const ppm_import_options *o)
{
    const char *wrong = NULL;
    if (!(o->crease_rad >= 0.0f && o->crease_rad <= 3.1416f)) wrong = "crease_rad, 0 .. pi";
    if (!(o->unit_scale >= 0.0f && o->unit_scale <= 1e9f)) wrong = "unit_scale, 0 .. 1e9";
    if (o->up != PPM_UP_Y && o->up != PPM_UP_Z) wrong = "up, a PPM_UP_ value";
    if (!(o->line_radius_m >= 0.0f && o->line_radius_m <= 1e9f)) wrong = "line_radius_m, 0 .. 1e9";
    if (o->texture_folder_count > 0 && !o->texture_folders) wrong = "texture_folders, not NULL";
    for (uint32_t i = 0; !wrong && i < o->texture_folder_count; ++i) {
        if (!o->texture_folders[i]) wrong = "texture_folders, none of them NULL";
    }
    if (!wrong) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INVALID_ARGUMENT, "import: expected %s", wrong);
}

static ppm_status keep_request(ppm_asset *asset, const char *path,
                               const ppm_import_options *options)
{
    ppm_context *context = asset->context;
    const ppm_status status = check_obj_options(context, options);
    if (status != PPM_STATUS_OK) return status;
    asset->options = *options;
    if (!keep_folders(asset, options) || !keep(context, path, &asset->path) ||
        !keep(context, options->scene, &asset->scene_name) ||
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

/* A glTF file is in metres with +Y up, is flat where it has no normals, and names its images by
 * URIs. */
static void warn_of_obj_options(const ppm_asset *asset)
{
    const ppm_import_options *o = &asset->options;
    const bool is_any =
        o->crease_rad > 0.0f || o->unit_scale > 0.0f || o->up != 0 || o->texture_folder_count > 0;
    if (!is_any) return;
    ppmi_log(asset->context, PPM_LOG_WARNING,
             "%s: crease angle, unit scale, up axis and texture folders are for OBJ files and have "
             "no effect",
             asset->path);
}

static ppm_status open_file(ppm_asset *asset)
{
    const char *dot = strrchr(asset->path, '.');
    if (dot && (strcasecmp(dot, ".gltf") == 0 || strcasecmp(dot, ".glb") == 0)) {
        warn_of_obj_options(asset);
        return ppmi_gltf_asset_open(asset->context, asset->path, &asset->options, &asset->gltf);
    }
    if (dot && strcasecmp(dot, ".obj") == 0) {
        return ppmi_obj_asset_open(asset->context, asset->path, &asset->options, &asset->obj);
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
    for (uint32_t i = 0; i < asset->options.texture_folder_count && asset->texture_folders; ++i) {
        ppmi_free(asset->context, asset->texture_folders[i]);
    }
    ppmi_free(asset->context, asset->texture_folders);
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
