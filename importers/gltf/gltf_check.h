/* The check of a document's JSON before tinygltf reads it.
 *
 * tinygltf 2.7 gives up a whole document for one bad image or camera, skips values of a wrong type
 * without a word, and reads out of bounds on some files. So the text is walked once against tables
 * of what we use: types, ranges and lengths. What comes out is
 *   - a text for tinygltf in which broken elements are replaced by a harmless one of their kind,
 *     broken optional values by null, and buffers and images by empty lists;
 *   - for every element whether it was broken and why: using it is then an error or a warning;
 *   - buffers and images, as places in the original text. */
#ifndef PPMI_GLTF_CHECK_H
#define PPMI_GLTF_CHECK_H

#include "base/context.h"
#include "gltf/gltf_json.h"

enum {
    PPMI_GLTF_SCENES,
    PPMI_GLTF_NODES,
    PPMI_GLTF_MESHES,
    PPMI_GLTF_ACCESSORS,
    PPMI_GLTF_BUFFER_VIEWS,
    PPMI_GLTF_BUFFERS,
    PPMI_GLTF_MATERIALS,
    PPMI_GLTF_TEXTURES,
    PPMI_GLTF_IMAGES,
    PPMI_GLTF_SAMPLERS,
    PPMI_GLTF_CAMERAS,
    PPMI_GLTF_LIGHTS,
    PPMI_GLTF_AREA_LIGHTS,      /* EXT_lights_area */
    PPMI_GLTF_LIGHT_PROFILES,   /* EXT_lights_ies */
    PPMI_GLTF_IMAGE_LIGHTS,     /* EXT_lights_image_based */
    PPMI_GLTF_CUBEMAPS,         /* KHR_environment_map */
    PPMI_GLTF_ENVIRONMENT_MAPS, /* KHR_environment_map */
    PPMI_GLTF_ANIMATIONS,
    PPMI_GLTF_SKINS,
    PPMI_GLTF_VARIANTS,
    PPMI_GLTF_LIST_COUNT
};

/* The elements of one list. */
typedef struct ppmi_gltf_list {
    size_t count, capacity;
    char **broken; /* per element: the path and reason, or NULL when it is fine */
} ppmi_gltf_list;

/* What a buffer or an image says. */
typedef struct ppmi_gltf_source {
    bool has_uri;
    ppmi_gltf_span uri;  /* the inside of the JSON string */
    ppmi_gltf_span name; /* the same; empty: none */
    uint64_t byte_length;
    int32_t buffer_view; /* -1: none */
} ppmi_gltf_source;

typedef struct ppmi_gltf_sources {
    size_t count, capacity;
    ppmi_gltf_source *items;
} ppmi_gltf_sources;

typedef struct ppmi_gltf_outline {
    char *text; /* for tinygltf */
    size_t text_length;
    ppmi_gltf_list lists[PPMI_GLTF_LIST_COUNT];
    ppmi_gltf_sources buffers, images;
} ppmi_gltf_outline;

/* Checks text (length bytes of JSON, without a byte order mark). file is for messages. Free with
 * ppmi_gltf_outline_deinit, also after a failure. Returns OK, INPUT_INVALID (not JSON, nested too
 * deeply, or broken at the root), INPUT_UNSUPPORTED (not glTF 2), OUT_OF_MEMORY. */
ppm_status ppmi_gltf_check(ppm_context *context, const char *file, const char *text, size_t length,
                           ppmi_gltf_outline *out_outline);
void ppmi_gltf_outline_deinit(ppm_context *context, ppmi_gltf_outline *outline);

#endif
