/* Assets with one animated triangle, posed at one time after the other. */
#ifndef PPM_TESTS_GLTF_MOTION_H
#define PPM_TESTS_GLTF_MOTION_H

#include "gltf/gltf_asset.h"
#include "gltf_fixture.h"

/* Keys of one property. Outputs are floats. */
typedef struct gltf_keys {
    const char *interpolation;
    const char *type;   /* of the output accessor */
    const float *times; /* count */
    size_t count;
    const float *values; /* value_count elements, of width floats */
    size_t value_count, width;
} gltf_keys;

/* Writes a document, in which ' stands for ", whose scene is node 0. The mesh 0 is a triangle
 * (0 0 0) (1 0 0) (0 1 0), and accessors 1 and 2 are the keys' times and values; middle is the
 * rest of its members, without a comma at the end. Opens and imports it in the pose of f->options.
 * *out_asset is NULL after a failure. */
ppm_status gltf_open_keys(gltf_fixture *f, const gltf_keys *keys, const char *middle,
                          ppmi_gltf_asset **out_asset);

/* The same for one channel of node 0, whose other members are in node ("" or with a comma at the
 * end). */
ppm_status gltf_open_channel(gltf_fixture *f, const gltf_keys *keys, const char *path,
                             const char *node, ppmi_gltf_asset **out_asset);

/* Opens and imports text, or a file that lives longer than the asset. */
ppm_status gltf_open_text(gltf_fixture *f, const char *json, ppmi_gltf_asset **out_asset);
ppm_status gltf_open_path(gltf_fixture *f, const char *path, ppmi_gltf_asset **out_asset);

/* The pose at a moment, or while the shutter is open. */
ppm_pose gltf_at(double time_s);
ppm_pose gltf_between(double open_s, double close_s);

/* A sum over all that a pose changes in a scene; equal scenes have equal ones. */
uint64_t gltf_scene_hash(const ppm_scene *scene);

#endif
