/* Colour management: one OpenColorIO configuration, behind a handle.
 *
 * The renderer works in scene-linear Rec.709 primaries (D65). The configuration says how that goes
 * to a display, and how textures come in. */
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

/* Whether a display and view can be used: makes the transform once and says what is wrong.
 * NULL or "" for either means its default. Returns OK, NOT_FOUND (the message names the nearest
 * that exist), or INPUT_INVALID when the configuration cannot build the transform. */
PPM_API ppm_status ppm_color_check_view(ppm_context *context, const ppm_color *color,
                                        const char *display, const char *view);

#ifdef __cplusplus
}
#endif

#endif
