/* The state of one import, shared by its passes: file -> check -> parse -> nodes, which pull in the
 * meshes, materials and images that they use. */
#ifndef PPMI_GLTF_READER_H
#define PPMI_GLTF_READER_H

#include <stdint.h>

#include "gltf/gltf_check.h"
#include "gltf/gltf_map.h"
#include "gltf/gltf_report.h"
#include "gltf/gltf_shim.h"
#include "ppm/import.h"

enum { PPMI_GLTF_PLACE = 256 }; /* bytes for a JSON path in a message */

/* A loaded buffer. */
typedef struct ppmi_gltf_bytes {
    const unsigned char *data; /* NULL: not loaded yet */
    unsigned char *owned;      /* data of a data URI */
    ppmi_gltf_map map;         /* data of a file */
    size_t count;
} ppmi_gltf_bytes;

/* An image in one role. */
typedef struct ppmi_gltf_image_use {
    bool is_tried;
    bool is_wanted;  /* by a material that has been looked at (gltf_image_batch.c) */
    ppm_image_id id; /* 0 after a failure */
} ppmi_gltf_image_use;

/* A light profile, read at its first use. */
typedef struct ppmi_gltf_profile_use {
    bool is_tried;
    ppm_light_profile_id id; /* 0 after a failure */
    float turn_rad;          /* of the lights that use it, about their axis */
} ppmi_gltf_profile_use;

/* What is counted and told once, at the end. */
typedef struct ppmi_gltf_tally {
    size_t instances;
    size_t punctual_lights; /* KHR_lights_punctual and lamps whose numbers depend on the units */
    size_t doubtful_suns;
    size_t broken_counts, no_positions;
    size_t solid_glass, thin_glass;
    uint32_t turned_meshes; /* solids wound inside out */
} ppmi_gltf_tally;

typedef struct ppmi_gltf_decoded ppmi_gltf_decoded; /* gltf_decoded.h */

struct ppmi_gltf_reader {
    ppm_context *context;
    ppm_scene *scene;
    const ppm_import_options *options;
    const char *path; /* of the file; also its name in messages */

    ppmi_gltf_map file_map;
    const unsigned char *file; /* the whole file */
    size_t file_size;
    const char *json; /* parts of it */
    size_t json_length;
    const unsigned char *chunk; /* the GLB's BIN chunk, or NULL */
    size_t chunk_length;

    ppmi_gltf_outline outline;
    const ppmi_gltf_document *document;

    ppmi_gltf_bytes *buffers;         /* one per buffer */
    ppmi_gltf_decoded *decoded;       /* what was compressed; NULL: nothing yet */
    ppmi_gltf_image_use *images;      /* two per image: colour, data */
    ppmi_gltf_profile_use *profiles;  /* one per light profile */
    struct ppmi_gltf_blend *blends;   /* falloffs of spots so far (gltf_blend.c) */
    ppm_material_id *materials;       /* one per material; 0: not added yet */
    ppm_mesh_id *meshes;              /* one per mesh; 0: not added yet */
    bool *empty_meshes;               /* one per mesh: nothing in it can be drawn */
    ppm_material_id default_material; /* 0: not added yet */
    bool is_looking_at_textures;      /* textures are noted, not loaded (gltf_image_batch.c) */
    uint32_t uv_sets_seen;            /* bit n: a texture that was looked at uses TEXCOORD_n */
    size_t zero_elements;             /* of accessors that have no bytes in the file */
    int32_t chosen_scene;             /* by the options or the file; may not exist */
    uint32_t variant;                 /* that is shown, from 1; 0: the plain materials */
    bool from_blender;                /* asset.generator is Khronos' Blender exporter */
    ppmi_gltf_tally tally;
    ppmi_gltf_report report;
    char *xmp; /* the asset's metadata, JSON text; NULL: none */

    struct ppmi_gltf_animations *animations;
    struct ppmi_gltf_pose *pose;             /* made by the import */
    struct ppmi_gltf_placements *placements; /* made by the import */
    bool is_posed_again; /* what has been told at the import is not told again */
};

/* ---- gltf_file.c: files, GLB, buffers -------------------------------------------------------- */

/* Reads reader->path and finds the JSON and the BIN chunk in it. */
ppm_status ppmi_gltf_read_file(ppmi_gltf_reader *reader);

/* Gives back memory of mapped files; what is needed of them comes again. */
void ppmi_gltf_forget_files(ppmi_gltf_reader *reader);
/* Closes the file and the buffers' files. */
void ppmi_gltf_close_files(ppmi_gltf_reader *reader);

/* The bytes of a buffer view, decoded where they are compressed. place is the JSON path of the
 * reference, for messages. The bytes stay valid until the reader ends. */
ppm_status ppmi_gltf_view_bytes(ppmi_gltf_reader *reader, int32_t view, const char *place,
                                const unsigned char **out_bytes, size_t *out_count);

/* byte_length bytes of a buffer from byte_offset on, for as long. place names who asks. */
ppm_status ppmi_gltf_buffer_bytes(ppmi_gltf_reader *reader, int32_t buffer, size_t byte_offset,
                                  size_t byte_length, const char *place,
                                  const unsigned char **out_bytes);
/* The bytes that a URI without escapes names, data or a file of the asset's folder; the caller's.
 * Returns OK, INPUT_NOT_FOUND, INPUT_INVALID, OUT_OF_MEMORY, unreported, with the reason. */
ppm_status ppmi_gltf_read_uri(ppmi_gltf_reader *reader, const char *uri, size_t length,
                              unsigned char **out_bytes, size_t *out_count, const char **reason);

/* A URI without JSON escapes. Data URIs are long and have none, as a rule, so it is copied only if
 * need be: *out_owned is then the caller's to free. NULL when memory is out. */
const char *ppmi_gltf_unescape_uri(ppmi_gltf_reader *reader, ppmi_gltf_span span,
                                   size_t *out_length, char **out_owned);

/* ---- gltf_reader.c: references --------------------------------------------------------------- */

/* Whether element index of a list exists and is sound; otherwise why not, in reason. */
bool ppmi_gltf_is_usable(const ppmi_gltf_reader *reader, int list, int32_t index, char *reason,
                         size_t reason_size);

/* The same as an error of the file (vital parts) or as a warning (parts that can be left out). */
ppm_status ppmi_gltf_require(ppmi_gltf_reader *reader, int list, int32_t index, const char *place);
bool ppmi_gltf_accept(ppmi_gltf_reader *reader, int list, int32_t index, const char *place);

/* The accessor of an attribute, or -1. */
int32_t ppmi_gltf_find_attribute(const ppmi_gltf_attribute *attributes, uint32_t count,
                                 const char *name);

/* Writes a JSON path for messages; one that is too long is cut. */
void ppmi_gltf_place(char place[PPMI_GLTF_PLACE], const char *format, ...) PPMI_PRINTF(2, 3);

/* INPUT_INVALID with file, place and reason. */
ppm_status ppmi_gltf_invalid(ppmi_gltf_reader *reader, const char *place, const char *format, ...)
    PPMI_PRINTF(3, 4);
/* A warning with file and place. */
void ppmi_gltf_warn(ppmi_gltf_reader *reader, const char *place, const char *format, ...)
    PPMI_PRINTF(3, 4);
ppm_status ppmi_gltf_out_of_memory(ppmi_gltf_reader *reader, const char *place);

/* text without control characters, cut to size, for messages. Returns buffer. */
const char *ppmi_gltf_printable(const char *text, size_t length, char *buffer, size_t size);

/* ---- gltf_accessor.c ------------------------------------------------------------------------- */

/* What an attribute may look like, and what comes out of it. */
typedef struct ppmi_gltf_format {
    uint32_t min_components, max_components; /* of the accessor */
    uint32_t out_components;                 /* of the result; missing ones are 1 */
    bool integers_are_normalized;            /* even where the accessor does not say so */
} ppmi_gltf_format;

enum { PPMI_GLTF_FAULT = 80 }; /* bytes for what is wrong with an accessor */

/* Whether an accessor's type or componentType is none that the format allows; fault says which. */
bool ppmi_gltf_type_is_wrong(const ppmi_gltf_accessor *accessor, const ppmi_gltf_format *format,
                             char fault[PPMI_GLTF_FAULT]);

/* Reads an accessor as floats, count * format->out_components of them; matrices, where a format
 * asks for 9 or 16 components, column by column and tightly packed. *out_values is the caller's to
 * free, NULL on failure. */
ppm_status ppmi_gltf_read_floats(ppmi_gltf_reader *reader, int32_t accessor, const char *place,
                                 const ppmi_gltf_format *format, float **out_values,
                                 size_t *out_count);

/* The same as doubles, for what is composed before it is rounded. */
ppm_status ppmi_gltf_read_doubles(ppmi_gltf_reader *reader, int32_t accessor, const char *place,
                                  const ppmi_gltf_format *format, double **out_values,
                                  size_t *out_count);

/* Positions less base, subtracted before they are rounded to floats. */
ppm_status ppmi_gltf_read_positions(ppmi_gltf_reader *reader, int32_t accessor, const char *place,
                                    const double base[3], float **out_values, size_t *out_count);

/* The place that is the point 0 of a mesh in the scene, in the mesh's own coordinates: whole metres
 * beside its first vertex where positions are doubles (KHR_accessor_float64), else 0. Instances are
 * moved by it, in double precision. */
ppm_status ppmi_gltf_mesh_base(ppmi_gltf_reader *reader, int32_t mesh, double base[3]);

/* Reads an accessor of unsigned integers. */
ppm_status ppmi_gltf_read_indices(ppmi_gltf_reader *reader, int32_t accessor, const char *place,
                                  uint32_t **out_values, size_t *out_count);

/* ---- the passes ------------------------------------------------------------------------------ */

/* gltf_node.c: finds the scene of the options, which becomes reader->chosen_scene. Returns OK,
 * INVALID_ARGUMENT (no such scene), OUT_OF_MEMORY. */
ppm_status ppmi_gltf_choose_scene(ppmi_gltf_reader *reader);

/* gltf_node.c: walks the scene and adds instances, cameras and lights, in the options' pose. */
ppm_status ppmi_gltf_import_nodes(ppmi_gltf_reader *reader);
/* Moves them to another time, and materials that change with them. */
ppm_status ppmi_gltf_pose_nodes(ppmi_gltf_reader *reader, const ppm_pose *when);

/* gltf_mesh.c: the mesh's id, adding it at its first use; 0 when nothing in it can be drawn. */
ppm_status ppmi_gltf_use_mesh(ppmi_gltf_reader *reader, int32_t mesh, const char *place,
                              ppm_mesh_id *out_id);

/* gltf_material.c: the material's id, adding it at its first use; -1 is the default material. */
ppm_status ppmi_gltf_use_material(ppmi_gltf_reader *reader, int32_t material, const char *place,
                                  ppm_material_id *out_id);
/* Hands the values that a material has now to the scene, which has the material already. */
ppm_status ppmi_gltf_update_material(ppmi_gltf_reader *reader, int32_t material);

/* gltf_variants.c: finds the variant of the options, which becomes reader->variant. Returns OK,
 * INVALID_ARGUMENT (no variant of that name). */
ppm_status ppmi_gltf_choose_variant(ppmi_gltf_reader *reader);

/* The material of a primitive in the chosen variant. */
int32_t ppmi_gltf_variant_material(const ppmi_gltf_reader *reader,
                                   const ppmi_gltf_primitive *primitive);

/* gltf_xmp.c: fills in reader->xmp with the asset's metadata (KHR_xmp_json_ld) as it stands in the
 * file. A packet that does not exist is warned about. Returns OK, OUT_OF_MEMORY. */
ppm_status ppmi_gltf_read_xmp(ppmi_gltf_reader *reader);

/* Goes through the textures of a material, silently and without adding anything. */
void ppmi_gltf_visit_material(ppmi_gltf_reader *reader, int32_t material);

/* The sets of coordinates that the textures of a material use: bit n for TEXCOORD_n. */
uint32_t ppmi_gltf_material_uv_sets(ppmi_gltf_reader *reader, int32_t material);

/* gltf_image_batch.c: adds the images that the materials of the chosen scene use, in parallel. What
 * it does not foresee is added at its first use. */
ppm_status ppmi_gltf_load_images(ppmi_gltf_reader *reader);

/* gltf_image.c: adds images, each in a role (2 * index, plus 1 for PPM_IMAGE_DATA), in parallel;
 * what cannot be had is left out with a warning. */
ppm_status ppmi_gltf_add_images(ppmi_gltf_reader *reader, const size_t *uses, size_t count);

/* gltf_image.c: an image in a role, added at its first use; 0 when it cannot be had. */
ppm_status ppmi_gltf_use_image(ppmi_gltf_reader *reader, int32_t index, int32_t role,
                               const char *place, ppm_image_id *out_id);

/* gltf_image.c: the six faces of a cube, a layer of a KTX file, as colours; all 0, with a warning,
 * when they cannot be had. Returns OK, OUT_OF_MEMORY, WRONG_STATE. */
ppm_status ppmi_gltf_use_cube(ppmi_gltf_reader *reader, int32_t index, uint32_t layer,
                              const char *place, ppm_image_id faces[6]);

/* gltf_image.c: whether an image is a KTX file of an encoding that is not read, and its name. */
bool ppmi_gltf_image_is_unread(ppmi_gltf_reader *reader, int32_t index, char shown[64]);

/* gltf_image.c: a texture in a role (PPM_IMAGE_), with its image added at its first use. What
 * cannot be had is left out with a warning: out_texture->image is then 0. */
ppm_status ppmi_gltf_use_texture(ppmi_gltf_reader *reader, const ppmi_gltf_texture_info *info,
                                 int32_t role, const char *place, ppm_texture *out_texture);

/* gltf_camera.c: adds the camera of a node, or changes what has been added. Lights are in
 * gltf_light.h. */
ppm_status ppmi_gltf_add_camera(ppmi_gltf_reader *reader, int32_t node);

#endif
