/* Setup files: cameras, lights, surroundings, fog, materials and render options that a small JSON
 * file adds to an imported scene (docs/setup.md). The order is: open, import, apply, pose.
 *
 *     ppm_setup_open_beside(context, "vase.obj", NULL, &setup);   // vase.ppm.json, or NULL
 *     ppm_scene_import(scene, "vase.obj", NULL);
 *     if (setup) ppm_setup_apply(setup, scene, PPM_SETUP_ALL);
 *     options.camera = ppm_setup_camera(setup);
 */
#ifndef PPM_SETUP_H
#define PPM_SETUP_H

#include "ppm/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppm_setup ppm_setup;

typedef struct ppm_setup_options {
    uint32_t size;          /* sizeof(ppm_setup_options) */
    uint32_t allow_outside; /* non-zero: files outside of the setup file's folder may be read */
} ppm_setup_options;

/* Reads and checks a setup file: every key, value and path, so that what is wrong is told before
 * anything is imported. Messages name the file, the place in its JSON (or the line where it is no
 * JSON), what was found and what was expected. options may be NULL. The context must outlive the
 * setup. One thread at a time uses a setup.
 * Returns OK, INVALID_ARGUMENT, INPUT_NOT_FOUND (the file, or one that it names), INPUT_INVALID,
 * OUT_OF_MEMORY. */
PPM_API ppm_status ppm_setup_open(ppm_context *context, const char *path,
                                  const ppm_setup_options *options, ppm_setup **out_setup);

/* Opens the setup file that lies beside a model: its path with .ppm.json in place of the ending.
 * OK and NULL where there is none. Returns what ppm_setup_open does. */
PPM_API ppm_status ppm_setup_open_beside(ppm_context *context, const char *model_path,
                                         const ppm_setup_options *options, ppm_setup **out_setup);

/* NULL is fine. The scenes that it was applied to stay as they are. */
PPM_API void ppm_setup_close(ppm_setup *setup);

/* The file's path, valid until the setup is closed. */
PPM_API const char *ppm_setup_path(const ppm_setup *setup);

/* Parts of a setup file, as bits. */
enum {
    PPM_SETUP_CAMERAS = 1,
    PPM_SETUP_LIGHTS = 2,
    PPM_SETUP_ENVIRONMENT = 4,
    PPM_SETUP_FOG = 8,
    PPM_SETUP_MATERIALS = 16,
    PPM_SETUP_NODES = 32,
    PPM_SETUP_ALL = 63
};

/* Adds to a scene, and changes in it, what the file says; parts are PPM_SETUP_ bits. Cameras that
 * focus on a node do so as it stands now. A pattern that fits nothing is a warning. No render
 * session of the scene may be alive. After an error the scene may hold some of it: destroy it.
 * Returns OK, INVALID_ARGUMENT, INPUT_NOT_FOUND, INPUT_INVALID (also: a node or a material that is
 * named is not there), OUT_OF_MEMORY, WRONG_STATE. */
PPM_API ppm_status ppm_setup_apply(ppm_setup *setup, ppm_scene *scene, uint32_t parts);

/* After ppm_asset_set_pose: what the file says of materials and of the visibility of nodes is put
 * back where an animation of the asset has changed it; all else is untouched by poses. To the scene
 * of the last ppm_setup_apply. Returns what that does. */
PPM_API ppm_status ppm_setup_reapply(ppm_setup *setup, ppm_scene *scene);

/* The first camera that the last ppm_setup_apply has added; 0 for none, and for NULL. */
PPM_API ppm_camera_id ppm_setup_camera(const ppm_setup *setup);

/* What is in the file, in its order. Strings are valid until the setup is closed. */
typedef struct ppm_setup_item {
    uint32_t size;      /* sizeof(ppm_setup_item), set by the caller */
    uint32_t part;      /* PPM_SETUP_ bit; 0: an entry of "render" */
    const char *name;   /* of a camera or light; the pattern of materials and nodes; the name of a
                           render option */
    const char *detail; /* a phrase for people; the value of a render option */
} ppm_setup_item;

PPM_API uint32_t ppm_setup_count(const ppm_setup *setup);
/* index counts from 0. Returns OK, INVALID_ARGUMENT. */
PPM_API ppm_status ppm_setup_get_item(const ppm_setup *setup, uint32_t index,
                                      ppm_setup_item *out_item);

/* The entries of "render": options of the program's command line by their long names, with values
 * as they are written there ("" for an option without one). They are names and texts only: a host
 * takes those that it knows; ppm-render checks them as it does its own. */
PPM_API uint32_t ppm_setup_option_count(const ppm_setup *setup);
PPM_API ppm_status ppm_setup_get_option(const ppm_setup *setup, uint32_t index,
                                        const char **out_name, const char **out_value);

#ifdef __cplusplus
}
#endif

#endif
