/* Spaces by the names that they have in the configurations in use: ASWF CG and Studio (OCIO 2),
 * ACES 1.x (OCIO 1), Blender, nuke-default. A name says more than a role here: the role
 * scene_linear does not tell its primaries. */
#include "color/spaces.h"

static const char *find_first(const ppmi_ocio_config *config, const char *const *names,
                              size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const char *const found = ppmi_ocio_find_space(config, names[i]);
        if (found) return found;
    }
    return NULL;
}

#define FIND_FIRST(config, names) find_first(config, names, sizeof names / sizeof names[0])

bool ppmi_color_find_rec709(const ppmi_ocio_config *config, ppmi_ocio_space *out_space)
{
    static const char *const rec709_names[] = {
        "Linear Rec.709 (sRGB)",
        "lin_rec709_scene",
        "lin_rec709",
        "lin_rec709_srgb",
        "lin_srgb",
        "Utility - Linear - sRGB",
        "Utility - Linear - Rec.709",
        "Linear Rec.709",
        "Linear BT.709",
        "Linear sRGB",
        "scene-linear Rec.709-sRGB",
        "Linear",
        "lnf",
    };
    static const char *const aces_names[] = {"aces_interchange", "ACES2065-1", "ACES - ACES2065-1",
                                             "lin_ap0"};

    const char *const rec709 = FIND_FIRST(config, rec709_names);
    const char *const aces = rec709 ? NULL : FIND_FIRST(config, aces_names);
    if (!rec709 && !aces) return false;
    *out_space = (ppmi_ocio_space){rec709 ? rec709 : aces, !rec709};
    return true;
}

const char *ppmi_color_find_srgb_texture(const ppmi_ocio_config *config)
{
    static const char *const names[] = {
        "sRGB - Texture",           "srgb_tx", "srgb_texture", "srgb_rec709_scene",
        "Utility - sRGB - Texture", "sRGB",    "sRGB encoded", "Input - Generic - sRGB - Texture",
    };
    return FIND_FIRST(config, names);
}
