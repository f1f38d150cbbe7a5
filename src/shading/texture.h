/* Texture lookup. */
#ifndef PPMI_SHADING_TEXTURE_H
#define PPMI_SHADING_TEXTURE_H

#include "math/sampling.h"
#include "scene/scene.h"

typedef struct ppmi_texel {
    float r, g, b, a;
} ppmi_texel;

/* Colour or data at uv (origin top left, v down), linear, colours in the working space; images
 * without alpha give 1, grey ones the grey in r, g and b. texture->image must not be 0. */
ppmi_texel ppmi_texture_lookup(const ppm_scene *scene, const ppm_texture *texture, ppmi_vec2 uv);

/* The mean around uv over the parallelogram of two steps in uv (before the texture's transform),
 * from the image's mipmaps; without them, and where the parallelogram is no larger than a texel,
 * the look-up above. */
ppmi_texel ppmi_texture_filtered(const ppm_scene *scene, const ppm_texture *texture, ppmi_vec2 uv,
                                 ppmi_vec2 uv_dx, ppmi_vec2 uv_dy);

#endif
