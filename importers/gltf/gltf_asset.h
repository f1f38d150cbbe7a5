/* A glTF file that stays open: imported once, then posed at one time after the other. */
#ifndef PPMI_GLTF_ASSET_H
#define PPMI_GLTF_ASSET_H

#include "base/context.h"
#include "gltf/gltf_reader.h"
#include "ppm/import.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppmi_gltf_asset ppmi_gltf_asset;

/* Reads, checks and parses the file. path and options (never NULL, strings and all) must stay as
 * they are until the asset is closed. */
ppm_status ppmi_gltf_asset_open(ppm_context *context, const char *path,
                                const ppm_import_options *options, ppmi_gltf_asset **out_asset);
/* NULL is fine. */
void ppmi_gltf_asset_close(ppmi_gltf_asset *asset);

/* Adds the chosen scene in the pose of the options; once. */
ppm_status ppmi_gltf_asset_import(ppmi_gltf_asset *asset, ppm_scene *scene);

/* Moves what has been imported to another time. */
ppm_status ppmi_gltf_asset_set_pose(ppmi_gltf_asset *asset, const ppm_pose *pose);

/* What has been read, for the lists of what is in it. */
const ppmi_gltf_reader *ppmi_gltf_asset_reader(const ppmi_gltf_asset *asset);

#ifdef __cplusplus
}
#endif

#endif
