/* The state of one import, shared by its passes: statements -> normals -> meshes, which pull in the
 * materials and images that they use. */
#ifndef PPMI_OBJ_READER_H
#define PPMI_OBJ_READER_H

#include "obj/obj_import.h"
#include "obj/obj_lines.h"
#include "obj/obj_map.h"
#include "obj/obj_polygon.h"
#include "obj/obj_shim.h"
#include "obj/obj_tables.h"
#include "ppm/import.h"

/* Faces, lines or points in a row that share their state. A line and a row of points count as a
 * face. */
typedef struct ppmi_obj_run {
    uint32_t object;    /* index of a name */
    uint32_t material;  /* 0: none, else 1 + index of a name in used_materials */
    uint32_t smoothing; /* group; 0: off */
    int32_t kind;       /* PPM_PRIMITIVE_ */
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
    PPMI_OBJ_HAS_PM = 1 << 8,
    PPMI_OBJ_HAS_NI = 1 << 9,
    PPMI_OBJ_HAS_PS = 1 << 10,
    PPMI_OBJ_HAS_PC = 1 << 11,
    PPMI_OBJ_HAS_PCR = 1 << 12,
    PPMI_OBJ_HAS_ANISO = 1 << 13,
    PPMI_OBJ_HAS_ANISOR = 1 << 14
};

/* A material of a library; its name is library_materials[i]. */
typedef struct ppmi_obj_material {
    const ppmi_obj_mtl *mtl;
    ppmi_obj_map maps[PPMI_OBJ_MAP_COUNT];
    uint32_t given;   /* PPMI_OBJ_HAS_ */
    uint32_t library; /* index of the file's path in libraries */
    size_t line;      /* of its newmtl */
    bool is_added;
    bool needs_tangents; /* known once it is added */
    ppm_material_id id;
} ppmi_obj_material;

/* An index that points beyond what there is so far. */
typedef struct ppmi_obj_reach {
    int32_t most; /* from 1 */
    size_t line;
    int32_t kind; /* PPM_PRIMITIVE_: what it is an index of */
} ppmi_obj_reach;

/* An index that can point to nothing, whatever comes behind it. */
typedef struct ppmi_obj_fault {
    size_t line;      /* 0: there is none */
    const char *what; /* "an index of 0" */
    int32_t kind;     /* PPM_PRIMITIVE_ */
} ppmi_obj_fault;

/* In place of an index that points to nothing. */
enum { PPMI_OBJ_NOWHERE = -2 };

/* What is counted and told once, at the end. */
typedef struct ppmi_obj_tally {
    size_t broken; /* elements that were not kept since an index is no number */
    size_t no_number_uvs, no_number_normals; /* nan and the like */
    size_t free_forms, small_faces, short_lines, unknown, glass, displaced, reflections;
    size_t flat_faces;      /* without a normal */
    uint32_t turned_meshes; /* solids wound inside out */
    size_t unknown_line;
    char unknown_word[32]; /* the first one */
} ppmi_obj_tally;

struct ppmi_obj_reader {
    ppm_context *context;
    ppm_scene *scene;
    const ppm_import_options *options;
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
    ppmi_obj_array element;   /* ppmi_obj_corner: of the line or points that are read */
    bool has_smoothing;       /* some face is in a group */
    float line_radius;        /* 0: not known yet */
    ppmi_obj_reach position_reach, uv_reach, normal_reach;
    ppmi_obj_fault position_fault, uv_fault, normal_fault; /* the first of each kind */
    bool is_broken_face; /* the statement that is being read has an index that is no number */

    char *object, *group; /* current names, or NULL */
    uint32_t smoothing, material;
    int32_t kind; /* of the latest run */
    bool is_new_run;
    ppmi_obj_names objects;        /* names of nodes */
    ppmi_obj_array object_lengths; /* size_t: of the part of each that is an object's name */
    ppmi_obj_names used_materials; /* by usemtl */
    ppmi_obj_names library_names;  /* by mtllib, as written */

    ppmi_obj_names libraries;         /* paths of the files that were read */
    ppmi_obj_names library_materials; /* names */
    ppmi_obj_names commented;         /* those with a comment, without it */
    ppmi_obj_array commented_ids;     /* uint32_t: which of library_materials each of these is */
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

/* obj_indices.c: leaves out the elements with a vertex that is not there, and takes from others the
 * texture vertices and normals that are not there, with warnings. Returns OK; INPUT_INVALID when
 * nothing is left or when the options are strict. */
ppm_status ppmi_obj_settle_indices(ppmi_obj_reader *reader);
/* "face", "line", "point". Static. */
const char *ppmi_obj_kind_name(int32_t kind);

/* obj_elements.c: the corners of an l or p statement, without its word, as written. False when
 * memory is out. */
bool ppmi_obj_read_corners(ppmi_obj_reader *reader, const char *text, size_t length,
                           ppmi_obj_array *out, bool *out_is_valid);
/* Triangles, points or segments of one statement. */
size_t ppmi_obj_element_count(int32_t kind, size_t corner_count);
/* Of lines and points, in the units of the file: as asked for, or by the box of all vertices. */
float ppmi_obj_line_radius(ppmi_obj_reader *reader);

/* obj_crease.c: normals for the faces of a file without smoothing groups, where a crease angle is
 * asked for. */
ppm_status ppmi_obj_crease_normals(ppmi_obj_reader *reader);

/* The angle at a corner, 0 .. pi; 0 where an edge has no length. */
double ppmi_obj_corner_angle(const ppmi_obj_reader *reader, const ppmi_obj_corner *corners,
                             size_t count, size_t i);

/* Vectors of 3 doubles each, made unit length, behind the file's normals; zero for those without
 * length. False when memory is out. */
bool ppmi_obj_append_normals(ppmi_obj_reader *reader, const double *vectors, size_t count);

/* obj_normals.c: normals for the corners without one that are in a smoothing group. */
ppm_status ppmi_obj_smooth_normals(ppmi_obj_reader *reader);

/* The normal of a polygon times twice its area (Newell's method); zero for one without area. */
void ppmi_obj_face_normal(const ppmi_obj_reader *reader, const ppmi_obj_corner *corners,
                          size_t count, double out[3]);

/* obj_library.c: reads the material libraries. What cannot be found is left out with a warning. */
ppm_status ppmi_obj_read_libraries(ppmi_obj_reader *reader);

/* The number of the library's material of a name: as it stands, else without comments behind one or
 * the other. False when there is none. */
bool ppmi_obj_find_material(const ppmi_obj_reader *reader, const char *name, uint32_t *out_index);
/* Its name without a comment, where no other has that; length bytes of library_materials' name. */
size_t ppmi_obj_material_name_length(const ppmi_obj_reader *reader, uint32_t index);

void ppmi_obj_material_deinit(ppm_context *context, ppmi_obj_material *material);

/* obj_material.c: the scene's material for one of used_materials; 0 if no library has it. */
ppm_status ppmi_obj_use_material(ppmi_obj_reader *reader, uint32_t used, ppm_material_id *out_id,
                                 bool *out_needs_tangents);

/* obj_texture.c: the texture of a map (PPMI_OBJ_MAP_), with its pixels as they are; all zero when
 * it cannot be had. */
ppm_status ppmi_obj_use_map(ppmi_obj_reader *reader, const ppmi_obj_material *material, int32_t map,
                            int32_t role, ppm_texture *out_texture);

/* An image made of the pixels of up to two maps, pixel by pixel. A map that is not there, or cannot
 * be had, is white, or what missing says. */
typedef struct ppmi_obj_mixture {
    const char *kind; /* a word for each mix: images of the same maps may differ */
    int32_t maps[2];  /* PPMI_OBJ_MAP_; the second one may be -1 */
    float missing[2];
    int32_t role;      /* of the first map and of the result; the second map is data */
    uint32_t channels; /* of the result: 1, 3 or 4; 0: 3, or 4 where the first map has alpha */
    float parameter;
    /* a and b: RGBA after -imfchan and -mm */
    void (*mix)(float parameter, const float a[4], const float b[4], float out[4]);
} ppmi_obj_mixture;

/* obj_texture.c: the texture of a mixture; all zero when none of its maps can be had. */
ppm_status ppmi_obj_use_mixture(ppmi_obj_reader *reader, const ppmi_obj_material *material,
                                const ppmi_obj_mixture *mixture, ppm_texture *out_texture);

/* obj_texture.c: the texture of a height map, as a normal map of unit strength. An
 * image that is one already is used as it is. */
ppm_status ppmi_obj_use_bump(ppmi_obj_reader *reader, const ppmi_obj_material *material,
                             int32_t map, ppm_texture *out_texture);

/* obj_mix.c: makes the image of a mixture. paths: of the two maps, NULL for none. Where no map can
 * be read *out_id stays 0. Returns OK, OUT_OF_MEMORY or what the scene does. */
ppm_status ppmi_obj_mix_images(ppmi_obj_reader *reader, const ppmi_obj_material *material,
                               const ppmi_obj_mixture *mixture, const char *const paths[2],
                               ppm_image_id *out_id);
/* obj_bump.c: makes a normal map of heights; an image that is a normal map is added as it is. */
ppm_status ppmi_obj_bump_image(ppmi_obj_reader *reader, const ppmi_obj_map *map, const char *path,
                               ppm_image_id *out_id);

/* Rec.709 luminance. */
static inline float ppmi_obj_luminance(const float rgb[3])
{
    return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
}

/* obj_mesh.c: one mesh and one instance for each object. */
ppm_status ppmi_obj_emit(ppmi_obj_reader *reader);

/* ---- obj_path.c ------------------------------------------------------------------------------ */

/* Finds a file that the OBJ or one of its libraries names; beside is the path of the one that does.
 * It is looked for in the folder of that file, then in that of the OBJ: as written, then in other
 * letter case, then by ever shorter ends of the name; then in the same way in the texture folders.
 * Without allow_outside nothing outside of these folders is found.
 * *out_path is the caller's to free; NULL when there is none. *out_is_elsewhere: it is not where
 * the name says. Returns OK or OUT_OF_MEMORY (reported). */
ppm_status ppmi_obj_find_file(ppmi_obj_reader *reader, const char *beside, const char *name,
                              char **out_path, bool *out_is_elsewhere);

/* Length of the path before its last part: "a/b.obj" has 2. */
size_t ppmi_obj_folder_length(const char *path);

#endif
