/* Which spaces of a configuration are the ones that the renderer means. */
#ifndef PPMI_COLOR_SPACES_H
#define PPMI_COLOR_SPACES_H

#include "color/ocio_shim.h"

typedef enum ppmi_working_kind {
    PPMI_WORKING_REC709, /* the space is linear Rec.709 */
    PPMI_WORKING_ACES,   /* the space is ACES2065-1: a matrix goes between */
    PPMI_WORKING_GUESS   /* only a scene-linear space of unknown primaries */
} ppmi_working_kind;

typedef struct ppmi_working_space {
    const char *name; /* borrowed from the configuration */
    ppmi_working_kind kind;
} ppmi_working_space;

/* How linear Rec.709 enters or leaves config. False: there is not even a scene-linear space. */
bool ppmi_color_find_working_space(const ppmi_ocio_config *config, ppmi_working_space *out_space);

/* The space of sRGB-encoded textures, or NULL. */
const char *ppmi_color_find_srgb_texture(const ppmi_ocio_config *config);

#endif
