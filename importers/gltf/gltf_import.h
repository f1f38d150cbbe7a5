/* glTF 2.0 in, public scene calls out. */
#ifndef PPMI_GLTF_IMPORT_H
#define PPMI_GLTF_IMPORT_H

#include "base/context.h"
#include "ppm/import.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ppm_scene_import for .gltf and .glb; context is the scene's. options is never NULL. */
ppm_status ppmi_gltf_import(ppm_context *context, ppm_scene *scene, const char *path,
                            const ppm_import_options *options);

#ifdef __cplusplus
}
#endif

#endif
