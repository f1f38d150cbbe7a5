/* An opened file: one of the importers' assets, and what was asked for. */
#ifndef PPMI_API_ASSET_H
#define PPMI_API_ASSET_H

#include <stdbool.h>

#include "base/catalog.h"
#include "gltf/gltf_asset.h"
#include "obj/obj_import.h"
#include "ppm/asset.h"

struct ppm_asset {
    ppm_context *context;
    char *path, *scene_name, *variant, *animation; /* copies, which options points to */
    ppm_import_options options;
    char **texture_folders; /* copies too */
    ppmi_gltf_asset *gltf;  /* one of the two is set */
    ppmi_obj_asset *obj;
    ppm_scene *scene; /* that it has been imported into; NULL before */
    bool is_imported; /* without a failure on the way */
    ppmi_catalog catalog;
};

/* asset_list.c: what is in the file, once it is open. */
ppm_status ppmi_asset_fill_catalog(ppm_asset *asset);

#endif
