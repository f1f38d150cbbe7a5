/* Colour management: one OpenColorIO configuration, behind a handle.
 *
 * The configuration says how textures come in, how pictures go to a display, and which scene-linear
 * space is worked in between (the working space). Colours in this API's structs are linear Rec.709
 * (D65) whatever the working space is: they are converted where they enter the scene. */
#ifndef PPM_COLOR_H
#define PPM_COLOR_H

#include <stdint.h>

#include "ppm/context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ppm_color ppm_color;

/* Opens a configuration.
 *
 * config_path  a config.ocio file (or an .ocioz archive where OpenColorIO reads it); NULL: the file
 *              that $OCIO names if that is set and not empty, else the configuration built in
 * Returns OK, INPUT_NOT_FOUND, INPUT_INVALID, OUT_OF_MEMORY.
 * The handle is immutable and may be used by several threads at once. */
PPM_API ppm_status ppm_color_create(ppm_context *context, const char *config_path,
                                    ppm_color **out_color);

/* Colour textures whose name matches pattern (a shell pattern: * ? [...]; without a slash it is
 * about the name behind the last one) hold values of space. */
typedef struct ppm_texture_space {
    const char *pattern;
    const char
        *space; /* a space, alias or role; one that holds data: values are taken as they are */
} ppm_texture_space;

typedef struct ppm_color_options {
    uint32_t size;             /* sizeof(ppm_color_options) */
    const char *config_path;   /* as in ppm_color_create; "" is the configuration built in */
    const char *working_space; /* a scene-linear space, alias or role; NULL or "": the role
                                  scene_linear, without it linear Rec.709 */
    uint32_t texture_space_count;
    const ppm_texture_space *texture_spaces; /* the first that matches counts */
} ppm_color_options;

/* As ppm_color_create, with choices. All strings are copied. Returns the same, and NOT_FOUND for a
 * space that is not in the configuration, INVALID_ARGUMENT; INPUT_INVALID also for a working space
 * that is not scene-linear, and where nothing says what linear Rec.709 is in the configuration. */
PPM_API ppm_status ppm_color_create_with(ppm_context *context, const ppm_color_options *options,
                                         ppm_color **out_color);
PPM_API void ppm_color_destroy(ppm_color *color);

/* Where the configuration came from: a path, or "built-in". Valid until ppm_color_destroy. */
PPM_API const char *ppm_color_source(const ppm_color *color);

/* Displays and their views, in the configuration's order; names are valid until
 * ppm_color_destroy, NULL when out of range. */
PPM_API uint32_t ppm_color_display_count(const ppm_color *color);
PPM_API const char *ppm_color_display_name(const ppm_color *color, uint32_t index);
PPM_API const char *ppm_color_default_display(const ppm_color *color);
PPM_API uint32_t ppm_color_view_count(const ppm_color *color, const char *display);
PPM_API const char *ppm_color_view_name(const ppm_color *color, const char *display,
                                        uint32_t index);
PPM_API const char *ppm_color_default_view(const ppm_color *color, const char *display);
/* Scene-referred and display-referred spaces of the configuration, in its order. */
PPM_API uint32_t ppm_color_space_count(const ppm_color *color);
PPM_API const char *ppm_color_space_name(const ppm_color *color, uint32_t index);

/* Looks of the configuration, in its order. */
PPM_API uint32_t ppm_color_look_count(const ppm_color *color);
PPM_API const char *ppm_color_look_name(const ppm_color *color, uint32_t index);

/* The working space, as the configuration calls it; NULL for NULL. Valid until ppm_color_destroy.
 */
PPM_API const char *ppm_color_working_space(const ppm_color *color);

/* Whether a display and view can be used: makes the transform once and says what is wrong.
 * NULL or "" for either means its default. Returns OK, NOT_FOUND (the message names the nearest
 * that exist), or INPUT_INVALID when the configuration cannot build the transform. */
PPM_API ppm_status ppm_color_check_view(ppm_context *context, const ppm_color *color,
                                        const char *display, const char *view);
/* The same with a look, or several as OpenColorIO writes them ("one, -two"): NULL or "" for the
 * view's own, "none" for none. */
PPM_API ppm_status ppm_color_check_look(ppm_context *context, const ppm_color *color,
                                        const char *display, const char *view, const char *look);

#ifdef __cplusplus
}
#endif

#endif
