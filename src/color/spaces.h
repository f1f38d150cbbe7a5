/* Which spaces of a configuration are the ones that the renderer means. */
#ifndef PPMI_COLOR_SPACES_H
#define PPMI_COLOR_SPACES_H

#include "color/ocio_shim.h"

/* What linear Rec.709 is in config: a space, else by way of its ACES2065-1. name is borrowed from
 * the configuration. False: nothing says what it is. */
bool ppmi_color_find_rec709(const ppmi_ocio_config *config, ppmi_ocio_space *out_space);

/* The space of sRGB-encoded textures, or NULL. */
const char *ppmi_color_find_srgb_texture(const ppmi_ocio_config *config);

#endif
