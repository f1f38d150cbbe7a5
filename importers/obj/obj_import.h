/* Wavefront OBJ and MTL in, public scene calls out (docs/obj.md). */
#ifndef PPMI_OBJ_IMPORT_H
#define PPMI_OBJ_IMPORT_H

#include "base/context.h"
#include "ppm/import.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ppm_scene_import for .obj; context is the scene's. options is never NULL; it holds nothing yet
 * that an OBJ could say. */
ppm_status ppmi_obj_import(ppm_context *context, ppm_scene *scene, const char *path,
                           const ppm_import_options *options);

#ifdef __cplusplus
}
#endif

#endif
