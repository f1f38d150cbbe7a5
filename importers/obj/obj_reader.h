/* The state of one import, shared by its passes: statements -> normals -> meshes, which pull in the
 * materials and images that they use. */
#ifndef PPMI_OBJ_READER_H
#define PPMI_OBJ_READER_H

#include "obj/obj_import.h"
#include "obj/obj_lines.h"
#include "obj/obj_polygon.h"
#include "obj/obj_shim.h"
#include "obj/obj_tables.h"
#include "ppm/import.h"

/* Faces in a row that share their state. */
typedef struct ppmi_obj_run {
    uint32_t object;    /* index of a name */
    uint32_t material;  /* 0: none, else 1 + index of a name in used_materials */
    uint32_t smoothing; /* group; 0: off */
    size_t first_face, first_corner;
    size_t end_face;
} ppmi_obj_run;

/* Which statements a material has. */
enum {
    PPMI_OBJ_HAS_KD = 1 << 0,
    PPMI_OBJ_HAS_KS = 1 << 1,
    PPMI_OBJ_HAS_KE = 1 << 2,
    PPMI_OBJ_HAS_TF = 1 << 3,
    PPMI_OBJ_HAS_NS = 1 << 4,
    PPMI_OBJ_HAS_D = 1 << 5,
    PPMI_OBJ_HAS_ILLUM = 1 << 6,
    PPMI_OBJ_HAS_PR = 1 << 7,
    PPMI_OBJ_HAS_PM = 1 << 8
};

/* A material of a library; its name is library_materials[i]. */
typedef struct ppmi_obj_material {
    const ppmi_obj_mtl *mtl;
    uint32_t given;   /* PPMI_OBJ_HAS_ */
    uint32_t library; /* index of the file's path in libraries */
    size_t line;      /* of its newmtl */
    bool is_added;
    ppm_material_id id;
} ppmi_obj_material;

/* An index that points beyond what there is so far. */
typedef struct ppmi_obj_reach {
    int32_t most; /* from 1 */
    size_t line;
} ppmi_obj_reach;

/* What is counted and told once, at the end. */
typedef struct ppmi_obj_tally {
    size_t lines, points, free_forms, small_faces, unknown, glass;
    size_t unknown_line;
    char unknown_word[32]; /* the first one */
} ppmi_obj_tally;

struct ppmi_obj_reader {
    ppm_context *context;
    ppm_scene *scene;
    const char *path;  /* of the file; also its name in messages */
    char *stem;        /* its name without folder and ending */
    ppm_status status; /* the first failure while statements are read */

    ppmi_obj_lines lines;
    const char *text; /* the statement that is being read */
    size_t text_length;

    ppmi_obj_array positions; /* 3 floats each */
    ppmi_obj_array colors;    /* empty, or 3 floats per position, as written */
    float color_scale;        /* brings them to 0 .. 1 */
    ppmi_obj_array uvs;       /* 2 floats each, v up */
    ppmi_obj_array normals;   /* 3 floats each: the file's, then computed ones */
    ppmi_obj_array corners;   /* ppmi_obj_corner: indices from 0, -1 for none */
    ppmi_obj_array faces;     /* uint32_t: number of corners */
    ppmi_obj_array runs;      /* ppmi_obj_run */
    ppmi_obj_reach position_reach, uv_reach, normal_reach;

    char *object, *group; /* current names, or NULL */
    uint32_t smoothing, material;
    bool is_new_run;
    ppmi_obj_names objects;        /* names of nodes */
    ppmi_obj_array object_lengths; /* size_t: of the part of each that is an object's name */
    ppmi_obj_names used_materials; /* by usemtl */
    ppmi_obj_names library_names;  /* by mtllib, as written */

    ppmi_obj_names libraries;         /* paths of the files that were read */
    ppmi_obj_names library_materials; /* names */
    ppmi_obj_array materials;         /* ppmi_obj_material */
    ppmi_obj_names missing_materials; /* that usemtl names and no library has */
    ppmi_obj_names ignored;           /* statements of materials that have no effect here */
    ppmi_obj_names images;            /* role, folder and name as written */
    ppmi_obj_array image_ids;         /* ppm_image_id; 0: cannot be had */

    ppmi_obj_polygon_workspace polygons;
    ppmi_obj_tally tally;
};

/* ---- obj_import.c ---------------------------------------------------------------------------- */

ppm_status ppmi_obj_out_of_memory(ppmi_obj_reader *reader);

/* ---- the passes ------------------------------------------------------------------------------ */

/* obj_statements.c: reads the file. Afterwards every index is in range. */
ppm_status ppmi_obj_read_statements(ppmi_obj_reader *reader);

/* obj_normals.c: normals for the corners without one that are in a smoothing group. */
ppm_status ppmi_obj_smooth_normals(ppmi_obj_reader *reader);

/* The normal of a polygon times twice its area (Newell's method); zero for one without area. */
void ppmi_obj_face_normal(const ppmi_obj_reader *reader, const ppmi_obj_corner *corners,
                          size_t count, double out[3]);

/* obj_library.c: reads the material libraries. What cannot be found is left out with a warning. */
ppm_status ppmi_obj_read_libraries(ppmi_obj_reader *reader);

/* obj_material.c: the scene's material for one of used_materials; 0 if no library has it. */
ppm_status ppmi_obj_use_material(ppmi_obj_reader *reader, uint32_t used, ppm_material_id *out_id);

/* obj_texture.c: the texture of a map; all zero when it cannot be had. statement is for messages.
 */
ppm_status ppmi_obj_use_map(ppmi_obj_reader *reader, const ppmi_obj_material *material,
                            const ppmi_obj_map *map, const char *statement, int32_t role,
                            ppm_texture *out_texture);

/* obj_mesh.c: one mesh and one instance for each object. */
ppm_status ppmi_obj_emit(ppmi_obj_reader *reader);

/* ---- obj_path.c ------------------------------------------------------------------------------ */

/* Finds a file that the OBJ or one of its libraries names: in folder first (part of a path below
 * the OBJ's folder, "" or with a slash at its end), then beside the OBJ; as written, then in other
 * letter case, then by its last part alone. Nothing outside of the OBJ's folder is found.
 * *out_path is the caller's to free; NULL when there is none. *out_is_elsewhere: it is not where
 * the name says. Returns OK or OUT_OF_MEMORY (reported). */
ppm_status ppmi_obj_find_file(ppmi_obj_reader *reader, const char *folder, const char *name,
                              char **out_path, bool *out_is_elsewhere);

/* Length of the path before its last part: "a/b.obj" has 2. */
size_t ppmi_obj_folder_length(const char *path);

#endif
