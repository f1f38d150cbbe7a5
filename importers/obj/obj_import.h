/* Wavefront OBJ and MTL in, public scene calls out (docs/obj.md). */
#ifndef PPMI_OBJ_IMPORT_H
#define PPMI_OBJ_IMPORT_H

#include "base/context.h"
#include "ppm/import.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ppm_scene_import for .obj; context is the scene's. options is never NULL; of it the line
 * radius, crease angle, unit, up axis, texture folders and allow_outside count. */
ppm_status ppmi_obj_import(ppm_context *context, ppm_scene *scene, const char *path,
                           const ppm_import_options *options);

typedef struct ppmi_obj_asset ppmi_obj_asset;

/* The same in two steps. Opening reads the statements; path and options must stay as they are until
 * the asset is closed. Nothing in an OBJ moves. */
ppm_status ppmi_obj_asset_open(ppm_context *context, const char *path,
                               const ppm_import_options *options, ppmi_obj_asset **out_asset);
/* Adds it to scene; once. */
ppm_status ppmi_obj_asset_import(ppmi_obj_asset *asset, ppm_scene *scene);
/* NULL is fine. */
void ppmi_obj_asset_close(ppmi_obj_asset *asset);

typedef struct ppmi_obj_reader ppmi_obj_reader;

/* What has been read, for the lists of what is in it. */
const ppmi_obj_reader *ppmi_obj_asset_reader(const ppmi_obj_asset *asset);

#ifdef __cplusplus
}
#endif

#endif
