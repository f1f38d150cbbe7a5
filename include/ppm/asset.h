/* A file with a scene, opened: what is in it by name, what of it is understood, and its import at
 * one time after the other. ppm_scene_import (import.h) does all of this at once, for one time. */
#ifndef PPM_ASSET_H
#define PPM_ASSET_H

#include "ppm/import.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppm_asset ppm_asset;

/* Reads and checks the file's description; buffers and images are read when they are used. options
 * may be NULL; its strings are copied. The context must outlive the asset. One thread at a time
 * uses an asset. Returns what ppm_scene_import does. */
PPM_API ppm_status ppm_asset_open(ppm_context *context, const char *path,
                                  const ppm_import_options *options, ppm_asset **out_asset);
/* NULL is fine. The scene that it was imported into stays as it is. */
PPM_API void ppm_asset_close(ppm_asset *asset);

/* ---- what is in it --------------------------------------------------------------------------- */

enum {
    PPM_ASSET_SCENES = 0,
    PPM_ASSET_CAMERAS = 1, /* uses of cameras by nodes */
    PPM_ASSET_NODES = 2,
    PPM_ASSET_MESHES = 3,
    PPM_ASSET_MATERIALS = 4,
    PPM_ASSET_LIGHTS = 5, /* uses of lights by nodes */
    PPM_ASSET_VARIANTS = 6,
    PPM_ASSET_ANIMATIONS = 7,
    PPM_ASSET_IMAGES = 8,
    PPM_ASSET_KINDS = 9
};

/* Strings are valid until the asset is closed, and never NULL. */
typedef struct ppm_asset_item {
    uint32_t size;      /* sizeof(ppm_asset_item), set by the caller */
    const char *name;   /* "" for none */
    const char *detail; /* one phrase for people: "perspective, 39.6 degrees", "0 .. 2.5 s" */
    double begin_s;     /* of animations: first and last key, seconds */
    double end_s;
} ppm_asset_item;

PPM_API uint32_t ppm_asset_count(const ppm_asset *asset, int32_t kind);
/* index counts from 0. Returns OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_asset_get_item(const ppm_asset *asset, int32_t kind, uint32_t index,
                                      ppm_asset_item *out_item);
/* asset.generator, or "". */
PPM_API const char *ppm_asset_generator(const ppm_asset *asset);
/* asset.copyright, or "". */
PPM_API const char *ppm_asset_copyright(const ppm_asset *asset);
/* The metadata of the asset as a whole (KHR_xmp_json_ld), JSON text as it stands in the file; "".
 */
PPM_API const char *ppm_asset_xmp(const ppm_asset *asset);
/* How the numbers of punctual lights are read, in a phrase; "" when there are none. */
PPM_API const char *ppm_asset_light_units(const ppm_asset *asset);

/* ---- what of it is understood ---------------------------------------------------------------- */

enum { PPM_FEATURE_HONOURED = 0, PPM_FEATURE_APPROXIMATED = 1, PPM_FEATURE_IGNORED = 2 };

/* An extension, or a part of the core format that not every file uses. */
typedef struct ppm_asset_feature {
    uint32_t size;    /* sizeof(ppm_asset_feature), set by the caller */
    const char *name; /* "KHR_materials_sheen", "skins", "lines" */
    int32_t verdict;  /* PPM_FEATURE_ */
    const char *note; /* how it is approximated, or what is missing; "" */
} ppm_asset_feature;

/* Complete once the asset has been imported; before, what the description alone tells. */
PPM_API uint32_t ppm_asset_feature_count(const ppm_asset *asset);
PPM_API ppm_status ppm_asset_get_feature(const ppm_asset *asset, uint32_t index,
                                         ppm_asset_feature *out_feature);

/* ---- import ---------------------------------------------------------------------------------- */

/* Adds the chosen scene of the file to scene, in the pose of the options; once for an asset.
 * scene must outlive the asset's last pose. Returns what ppm_scene_import does. */
PPM_API ppm_status ppm_asset_import(ppm_asset *asset, ppm_scene *scene);

/* Moves what has been imported to another time: transforms, skins, morph targets, cameras, lights,
 * and material values that are animated. Nothing else is touched: what stands still keeps its
 * acceleration structure. No render session of the scene may be alive (WRONG_STATE). */
PPM_API ppm_status ppm_asset_set_pose(ppm_asset *asset, const ppm_pose *pose);

#ifdef __cplusplus
}
#endif

#endif
