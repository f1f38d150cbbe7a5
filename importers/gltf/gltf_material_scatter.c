/* KHR_materials_scatter (a draft of 2026, KhronosGroup/glTF pull request 2579) on sheets, where it
 * makes what passes diffuse. Inside solids it says what KHR_materials_volume_scatter says
 * (gltf_material_inside.c).
 *
 * With transmission T, strength S, colour m, anisotropy g and base colour b the draft's base is
 *     (1 - T) b R  +  T (1 - S) b G  +  T S m ((1 + g) / 2 D + (1 - g) / 2 R),
 * R and D Lambert's lobes on this side and beyond, G that of thin glass. The scene's material is
 *     t b G  +  (1 - t) ((1 - d) b R + d m D)
 * of its transmission t and diffuse transmission d. So t = T (1 - S), and d follows; the colour of
 * R becomes a mixture of b and m, of which b alone, m alone, or both without textures are exact. */
#include <math.h>

#include "gltf/gltf_material.h"

#define EXTENSION "KHR_materials_scatter"

/* A factor times the mean of its texture: shares that vary over the sheet have no place of their
 * own in the scene's material. */
static double mean_share(ppmi_gltf_conversion *c, const char *name,
                         const ppmi_gltf_texture_info *info, int channel, double factor,
                         bool *is_exact)
{
    ppm_texture texture = {0};
    float mean[4];
    ppmi_gltf_set_texture(c, name, info, PPM_IMAGE_DATA, &texture);
    if (ppm_scene_image_mean(c->reader->scene, texture.image, mean) != PPM_STATUS_OK) return factor;
    *is_exact = false;
    return factor * fmin(fmax((double)mean[channel], 0.0), 1.0);
}

/* Makes the colour of what comes back a mixture; mix is the share of the scattered colour. */
static bool mix_reflected(ppm_material_desc *desc, double mix)
{
    const ppm_texture none = {0};
    const bool has_textures =
        desc->base_color_texture.image != 0 || desc->diffuse_transmission_color_texture.image != 0;
    if (mix < 1e-6) return true;
    if (mix > 1.0 - 1e-6) {
        for (int i = 0; i < 3; ++i)
            desc->base_color[i] = desc->diffuse_transmission_color[i];
        /* alpha is the base colour's texture's */
        if (desc->alpha_mode != PPM_ALPHA_OPAQUE && has_textures) return false;
        desc->base_color_texture = desc->diffuse_transmission_color_texture;
    } else {
        if (has_textures) return false;
        desc->base_color_texture = none;
        for (int i = 0; i < 3; ++i) {
            const double from = desc->base_color[i], to = desc->diffuse_transmission_color[i];
            desc->base_color[i] = (float)(from + mix * (to - from));
        }
    }
    return desc->metallic == 0.0f && desc->transmission == 0.0f;
}

void ppmi_gltf_convert_sheet_scatter(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_scattering *from = &c->from->scattering;
    ppm_material_desc *desc = &c->desc;
    float strength;
    bool is_exact = true;
    ppmi_gltf_set(c, EXTENSION ".scatterStrengthFactor", &from->scatter_strength, 1, 0.0, 1.0,
                  &strength);
    const double s = mean_share(c, EXTENSION ".scatterStrengthTexture",
                                &from->scatter_strength_texture, 3, strength, &is_exact);
    if (!(s > 0.0)) return;
    const double t = mean_share(c, "KHR_materials_transmission.transmissionTexture",
                                &c->from->transmission_texture, 0, desc->transmission, &is_exact);
    float g = 0.0f;
    ppmi_gltf_set(c, EXTENSION ".scatterAnisotropy", &from->scatter_anisotropy, 1, -1.0, 1.0, &g);
    ppmi_gltf_set(c, EXTENSION ".multiscatterColorFactor", from->multiscatter_color, 3, 0.0, 1.0,
                  desc->diffuse_transmission_color);
    ppmi_gltf_set_texture(c, EXTENSION ".multiscatterColorTexture",
                          &from->multiscatter_color_texture, PPM_IMAGE_COLOR,
                          &desc->diffuse_transmission_color_texture);
    const double through = t * s * (1.0 + g) / 2.0, back = t * s * (1.0 - g) / 2.0;
    const double glass = t * (1.0 - s), reflected = 1.0 - t + back;
    desc->transmission = (float)glass;
    desc->transmission_texture = (ppm_texture){0};
    desc->diffuse_transmission_texture = (ppm_texture){0};
    desc->diffuse_transmission = (float)(through > 0.0 ? through / (through + reflected) : 0.0);
    if (reflected > 0.0 && !mix_reflected(desc, back / reflected)) is_exact = false;
    if (!is_exact) {
        ppmi_gltf_note_feature(c->reader, EXTENSION, PPM_FEATURE_APPROXIMATED,
                               "on sheets, shares are the means of their textures, and what comes "
                               "back has the plain colour where it mixes with one");
    }
}
