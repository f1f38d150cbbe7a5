/* Smaller copies of images, for look-ups that cover many texels (Williams 1983, "Pyramidal
 * Parametrics"). */
#ifndef PPMI_SCENE_MIPMAP_H
#define PPMI_SCENE_MIPMAP_H

#include "scene/scene.h"

/* Gives every image that has none its levels, except the environment's, which is looked up at its
 * finest only. In parallel; what comes out does not depend on the number of threads. May be called
 * again after more images. Returns OK, OUT_OF_MEMORY (reported). */
ppm_status ppmi_scene_build_mipmaps(ppm_scene *scene);

/* Level 0 is the image itself; there are image->mip_count more. */
static inline ppmi_image_level ppmi_image_level_at(const ppmi_image *image, uint32_t level)
{
    if (level == 0) {
        return (ppmi_image_level){image->width, image->height, image->u8, image->f32};
    }
    return image->mips[level - 1];
}

#endif
