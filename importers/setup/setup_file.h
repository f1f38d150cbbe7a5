/* An opened setup file, and how its sections are read. A section's reader runs twice: as the file
 * is opened, to check it, and as it is applied. */
#ifndef PPMI_SETUP_FILE_H
#define PPMI_SETUP_FILE_H

#include "setup/setup_json.h"

typedef struct ppmi_setup_image {
    char *path;
    int32_t role; /* PPM_IMAGE_ */
    ppm_image_id id;
} ppmi_setup_image;

/* A render option as text; or what else is in the file. All strings are owned. */
typedef struct ppmi_setup_entry {
    uint32_t part; /* PPM_SETUP_ bit; 0: a render option */
    char *name, *detail;
} ppmi_setup_entry;

/* A material with a nested priority of its own. */
typedef struct ppmi_setup_clone {
    ppm_material_id from, to;
    int32_t nested_priority;
} ppmi_setup_clone;

struct ppm_setup {
    ppm_context *context;
    char *path;
    bool allows_outside;
    json_t *root;
    ppm_scene *scene; /* that it is applied to; NULL: only checked */
    ppm_camera_id first_camera;

    ppmi_setup_entry *entries;
    size_t entry_count, entry_capacity;
    ppmi_setup_image *images; /* of scene */
    size_t image_count, image_capacity;
    ppmi_setup_clone *clones; /* of scene */
    size_t clone_count, clone_capacity;
    ppm_material_desc *overridden; /* as they were left, by id - 1; size 0: not touched */
    bool *is_told;                 /* by id - 1: that an animation changes it */
    uint32_t overridden_count;
    uint32_t applied_parts;
};

ppm_status ppmi_setup_out_of_memory(ppm_setup *setup);

/* Makes room for one more element; false when memory is out. */
bool ppmi_setup_grow(ppm_context *context, void **items, size_t count, size_t *capacity,
                     size_t element_size);

/* Adds to what ppm_setup_get_item lists; strings are copied. */
ppm_status ppmi_setup_add_entry(ppm_setup *setup, uint32_t part, const char *name,
                                const char *detail);

/* ---- sections: each reads what it is given, and adds it to setup->scene if there is one -------
 */

ppm_status ppmi_setup_camera_section(const ppmi_setup_value *camera);
ppm_status ppmi_setup_light_section(const ppmi_setup_value *light);
ppm_status ppmi_setup_environment_section(const ppmi_setup_value *environment);
ppm_status ppmi_setup_fog_section(const ppmi_setup_value *fog);
ppm_status ppmi_setup_material_section(const ppmi_setup_value *rule);
ppm_status ppmi_setup_node_section(const ppmi_setup_value *rule);
/* Turns the entries of "render" into texts. */
ppm_status ppmi_setup_render_section(const ppmi_setup_value *render);

/* Remembers the materials as they are left, and puts back what an animation has changed. */
ppm_status ppmi_setup_remember_materials(ppm_setup *setup);
ppm_status ppmi_setup_restore_materials(ppm_setup *setup);
/* Puts back what animations have changed of the visibility of nodes. */
ppm_status ppmi_setup_restore_nodes(ppm_setup *setup);

/* ---- shared by sections ---------------------------------------------------------------------- */

/* The path of a file that is named, by the folder of the setup file; the caller's. Fails for paths
 * that leave the folder without permission, and for files that cannot be read. */
ppm_status ppmi_setup_find_file(const ppmi_setup_value *value, const char *name, char **out_path);
/* The image of a file that is named, once for each role; 0 while setup is only checked. */
ppm_status ppmi_setup_use_image(const ppmi_setup_value *value, const char *name, int32_t role,
                                ppm_image_id *out_id);
/* A texture slot: a name, an object or null. */
ppm_status ppmi_setup_read_texture(const ppmi_setup_value *value, int32_t role, ppm_texture *out);

/* Replaces *desc by a preset, but for its name, its normal map, double_sided and nested_priority.
 */
ppm_status ppmi_setup_use_preset(const ppmi_setup_value *value, ppm_material_desc *desc);

/* "match" of materials and nodes: a text or a list of them. */
typedef struct ppmi_setup_match {
    ppmi_setup_value value; /* json NULL: not given */
} ppmi_setup_match;
ppm_status ppmi_setup_read_match(const ppmi_setup_value *value, const ppmi_setup_key *key,
                                 void *target);
bool ppmi_setup_fits(const ppmi_setup_match *match, const char *name);
/* Warns that the pattern fits none of count names. */
ppm_status ppmi_setup_warn_no_match(const ppmi_setup_match *match, const char *thing,
                                    const char *(*name_of)(const ppm_scene *scene, uint32_t id),
                                    uint32_t count);
/* Fails: the text of value is no thing of that name; with the nearest that there is. */
ppm_status ppmi_setup_no_such(const ppmi_setup_value *value, const char *thing,
                              const char *(*name_of)(const ppm_scene *scene, uint32_t id),
                              uint32_t count);
const char *ppmi_setup_material_name(const ppm_scene *scene, uint32_t id);
/* The material of exactly that name; fails with the nearest. */
ppm_status ppmi_setup_find_material(const ppmi_setup_value *value, const char *name,
                                    ppm_material_id *out_id);

/* Where a camera or a light is and how it is turned; reals, in the file's own terms. */
typedef struct ppmi_setup_pose {
    double position[3], target[3], direction[3], up[3], matrix[16];
} ppmi_setup_pose;
/* Bits of what of it is given. */
enum {
    PPMI_SETUP_POSITION = 1,
    PPMI_SETUP_TARGET = 2,
    PPMI_SETUP_DIRECTION = 4,
    PPMI_SETUP_UP = 8,
    PPMI_SETUP_MATRIX = 16
};
/* Entries of a key table for a pose at the beginning of the target; their bits are those above. */
#define PPMI_SETUP_POSE_KEYS                                                                       \
    {"position", PPMI_SETUP_REALS, offsetof(ppmi_setup_pose, position), -1e15, 1e15, .count = 3},  \
        {"target", PPMI_SETUP_REALS, offsetof(ppmi_setup_pose, target), -1e15, 1e15, .count = 3},  \
        {"direction", PPMI_SETUP_REALS, offsetof(ppmi_setup_pose, direction), -1e15,               \
         1e15,        .count = 3},                                                                 \
        {"up", PPMI_SETUP_REALS, offsetof(ppmi_setup_pose, up), -1e15, 1e15, .count = 3},          \
    {                                                                                              \
        "matrix", PPMI_SETUP_REALS, offsetof(ppmi_setup_pose, matrix), -1e15, 1e15, .count = 16    \
    }
/* The transform that looks or shines along -Z. needs_direction: without one it is an error. */
ppm_status ppmi_setup_pose_transform(const ppmi_setup_value *object, const ppmi_setup_pose *pose,
                                     uint64_t given, bool needs_position, bool needs_direction,
                                     float out_transform[16]);

/* Linear Rec.709 of a black body, with a luminance of 1; kelvin 800 .. 40000. */
void ppmi_setup_black_body(double kelvin, double out_rgb[3]);

#endif
