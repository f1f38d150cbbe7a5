/* Importing a file into a scene. */
#ifndef PPM_IMPORT_H
#define PPM_IMPORT_H

#include "ppm/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How the numbers of punctual lights are read (docs/light-units.md). */
enum {
    PPM_LIGHT_UNITS_AUTO = 0,    /* by asset.generator: RAW and BLENDER for older and newer versions
                                    of Khronos' Blender exporter, else GLTF */
    PPM_LIGHT_UNITS_GLTF = 1,    /* candela and lux as written */
    PPM_LIGHT_UNITS_BLENDER = 2, /* divided by 683 lm/W, to match emissive strength and Cycles */
    PPM_LIGHT_UNITS_RAW = 3      /* Blender's "raw": watts; point and spot divided by 4 pi */
};

/* How KHR_materials_transmission without a thickness is read. */
enum {
    PPM_TRANSMISSION_POLICY_AUTO = 0,  /* thickness > 0: solid; else solid from Khronos' Blender
                                          exporter, thin otherwise */
    PPM_TRANSMISSION_POLICY_SOLID = 1, /* every transmissive material is a solid */
    PPM_TRANSMISSION_POLICY_THIN = 2   /* every one is a thin sheet */
};

/* What is up in a file that does not say it. */
enum {
    PPM_UP_Y = 0,
    PPM_UP_Z = 1 /* as CAD and Blender have it; turned so that its +Z is up and its +Y is away */
};

/* A time, or a shutter's, in the seconds of the file's animations. What has one value for a picture
 * (visibility, lights, materials, the angle of a camera) has that of the middle. */
typedef struct ppm_pose {
    uint32_t is_animated;  /* 0: the pose that the nodes have without animation; the rest is not
                              read */
    double open_s;         /* when the shutter opens */
    double close_s;        /* when it closes; equal to open_s: nothing is blurred */
    uint32_t motion_steps; /* times at which what moves is looked at, both ends among them; 1: only
                              the opening; 0: for each thing as many as show its way, up to 33 */
} ppm_pose;

typedef struct ppm_import_options {
    uint32_t size;        /* sizeof(ppm_import_options) */
    int32_t light_units;  /* PPM_LIGHT_UNITS_ */
    int32_t transmission; /* PPM_TRANSMISSION_POLICY_ */

    const char *scene;      /* the scene's name, or its number from 0; NULL: the file's default */
    const char *variant;    /* a name of KHR_materials_variants; NULL: the plain materials */
    const char *animation;  /* a name, or NULL: all at once */
    uint32_t allow_outside; /* non-zero: files outside of the asset's folder may be read */
    uint32_t strict;        /* non-zero: a feature that is ignored makes the file an error,
                               INPUT_UNSUPPORTED, after all such features have been reported */
    ppm_pose pose;          /* when; all 0: the static pose of the file */
    float line_radius_m;    /* of the points and lines of a file, in the space of their mesh; 0:
                               0.2 % of the diagonal of its box, in an OBJ of that of all
                               vertices */
    /* of an OBJ, whose format says none of it; a glTF file is told that they do not apply */
    float crease_rad; /* faces without normals, in a file without smoothing groups, are smooth
                         across edges that bend by this angle at most; 0: flat .. pi: all smooth */
    float unit_scale; /* metres of one unit, above 0, at most 1e9; 0: 1 */
    int32_t up;       /* PPM_UP_ */
    const char *const *texture_folders; /* where images and material libraries are looked for that
                                           are not beside the file, in this order */
    uint32_t texture_folder_count;
    uint32_t no_clip; /* non-zero: a glTF camera's znear and zfar are not used */
} ppm_import_options;

/* Reads path (.gltf, .glb, .obj; the ending decides, letter case does not matter) into scene, which
 * may already hold other things. options may be NULL. Choices and omissions are logged: INFO for
 * policies, WARNING for what is left out.
 *
 * Missing or broken images and unused broken parts are left out with a warning. Anything that
 * would make the geometry wrong is an error; the message names file, JSON path and reason. After
 * an error the scene may hold a part of the file: destroy it.
 * Returns OK, INVALID_ARGUMENT, INPUT_NOT_FOUND, INPUT_INVALID, INPUT_UNSUPPORTED, OUT_OF_MEMORY,
 * WRONG_STATE. */
PPM_API ppm_status ppm_scene_import(ppm_scene *scene, const char *path,
                                    const ppm_import_options *options);

#ifdef __cplusplus
}
#endif

#endif
