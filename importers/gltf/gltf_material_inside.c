/* What lets light to the other side, and what is there: KHR_materials_transmission, _volume,
 * _dispersion, _diffuse_transmission, and the drafts _volume_scatter and _scatter. */
#include <math.h>

#include "gltf/gltf_material.h"

/* Henyey and Greenstein's function is a pulse at 1 and at -1, which the draft excludes. */
#define MAX_SCATTER_ANISOTROPY 0.999

/* include/ppm/import.h, PPM_TRANSMISSION_POLICY_. Blender's exporter leaves out the thickness of
 * glass, but what only lets light seep through is a leaf or a shade for it as well. */
static int32_t transmission_kind(const ppmi_gltf_reader *reader, const ppmi_gltf_material *from)
{
    const bool is_blender_glass = reader->from_blender && from->transmission > 0.0;
    switch (reader->options->transmission) {
    case PPM_TRANSMISSION_POLICY_SOLID:
        return PPM_TRANSMISSION_SOLID;
    case PPM_TRANSMISSION_POLICY_THIN:
        return PPM_TRANSMISSION_THIN;
    default:
        return from->thickness > 0.0 || is_blender_glass ? PPM_TRANSMISSION_SOLID
                                                         : PPM_TRANSMISSION_THIN;
    }
}

static void convert_transmission(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_material *from = c->from;
    ppmi_gltf_set(c, "KHR_materials_transmission.transmissionFactor", &from->transmission, 1, 0.0,
                  1.0, &c->desc.transmission);
    ppmi_gltf_set_texture(c, "KHR_materials_transmission.transmissionTexture",
                          &from->transmission_texture, PPM_IMAGE_DATA,
                          &c->desc.transmission_texture);
    ppmi_gltf_set(c, "KHR_materials_dispersion.dispersion", &from->dispersion, 1, 0.0, 1000.0,
                  &c->desc.dispersion);
}

static void convert_diffuse_transmission(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_scattering *from = &c->from->scattering;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_diffuse_transmission.diffuseTransmissionFactor",
                  &from->diffuse_transmission, 1, 0.0, 1.0, &desc->diffuse_transmission);
    ppmi_gltf_set_texture(c, "KHR_materials_diffuse_transmission.diffuseTransmissionTexture",
                          &from->diffuse_transmission_texture,
                          ppmi_gltf_alpha_role(c, &from->diffuse_transmission_texture,
                                               &from->diffuse_transmission_color_texture),
                          &desc->diffuse_transmission_texture);
    ppmi_gltf_set(c, "KHR_materials_diffuse_transmission.diffuseTransmissionColorFactor",
                  from->diffuse_transmission_color, 3, 0.0, 1.0, desc->diffuse_transmission_color);
    ppmi_gltf_set_texture(c, "KHR_materials_diffuse_transmission.diffuseTransmissionColorTexture",
                          &from->diffuse_transmission_color_texture, PPM_IMAGE_COLOR,
                          &desc->diffuse_transmission_color_texture);
}

/* Multiplies the medium's colour by the mean of a texture, of one channel or, for -1, of three: a
 * picture of the surface cannot say what is where inside. */
static void apply_mean(ppmi_gltf_conversion *c, const char *name,
                       const ppmi_gltf_texture_info *info, int32_t role, int channel)
{
    ppm_texture texture = {0};
    float mean[4];
    ppmi_gltf_set_texture(c, name, info, role, &texture);
    if (ppm_scene_image_mean(c->reader->scene, texture.image, mean) != PPM_STATUS_OK) return;
    for (int i = 0; i < 3; ++i) {
        c->desc.multiscatter_color[i] *= fminf(fmaxf(mean[channel < 0 ? i : channel], 0.0f), 1.0f);
    }
    ppmi_gltf_note_feature(
        c->reader,
        c->from->scattering.is_scatter ? "KHR_materials_scatter" : "KHR_materials_volume_scatter",
        PPM_FEATURE_APPROXIMATED,
        "the medium inside is the same everywhere, of the mean of multiscatterColorTexture");
}

static void convert_medium_color(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_scattering *from = &c->from->scattering;
    float strength = 1.0f;
    ppmi_gltf_set(c, "KHR_materials_scatter.scatterStrengthFactor", &from->scatter_strength, 1, 0.0,
                  1.0, &strength);
    ppmi_gltf_set(c, "KHR_materials_volume_scatter.multiscatterColorFactor",
                  from->multiscatter_color, 3, 0.0, 1.0, c->desc.multiscatter_color);
    for (int i = 0; i < 3; ++i)
        c->desc.multiscatter_color[i] *= strength;
    apply_mean(c, "KHR_materials_volume_scatter.multiscatterColorTexture",
               &from->multiscatter_color_texture, PPM_IMAGE_COLOR, -1);
    apply_mean(c, "KHR_materials_scatter.scatterStrengthTexture", &from->scatter_strength_texture,
               PPM_IMAGE_DATA, 3);
}

/* The scene's albedo is 1 - s^2 of the colour c, with s as Kulla and Conty 2017 fit it; the draft
 * KHR_materials_scatter has (1 - s^2) / (1 - g s^2), which keeps the colour where g is not 0. This
 * is the c whose 1 - s^2 that is; 4.20863^2 is 17.7126, so that inverting the fit is linear in c.
 */
static float color_for_anisotropy(float color, float g)
{
    const double c = color;
    const double s =
        fmin(fmax(4.09712 + 4.20863 * c - sqrt(9.59217 + 41.6808 * c + 17.7126 * c * c), 0.0), 1.0);
    const double rest = 4.09712 - s * sqrt((1.0 - g) / (1.0 - g * s * s));
    const double out = (rest * rest - 9.59217) / (41.6808 - 2.0 * 4.20863 * rest);
    return (float)fmin(fmax(out, 0.0), 1.0);
}

/* The extension wants more than 0, and has infinity for what does not absorb. Its sample viewer
 * takes 0 for that, too; by the formula, c^(x / 0), a solid of colour would be black. */
static void convert_attenuation_distance(ppmi_gltf_conversion *c)
{
    const double *distance_m = &c->from->attenuation_distance;
    c->desc.attenuation_distance_m = 0.0f; /* no absorption */
    if (isinf(*distance_m)) return;
    if (*distance_m > 0.0) {
        ppmi_gltf_set(c, "KHR_materials_volume.attenuationDistance", distance_m, 1, 0.0,
                      PPMI_GLTF_HUGE, &c->desc.attenuation_distance_m);
        return;
    }
    ppmi_gltf_warn(c->reader, c->place,
                   "KHR_materials_volume.attenuationDistance is %g and must be above 0: nothing is "
                   "absorbed, as without it",
                   *distance_m);
    ppmi_gltf_note_feature(c->reader, "attenuationDistance of 0 or less", PPM_FEATURE_IGNORED,
                           c->place);
}

static void convert_volume(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_material *from = c->from;
    const ppmi_gltf_scattering *scattering = &from->scattering;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_volume.attenuationColor", from->attenuation_color, 3, 0.0, 1.0,
                  desc->attenuation_color);
    convert_attenuation_distance(c);
    convert_medium_color(c);
    ppmi_gltf_set(c, "KHR_materials_volume_scatter.scatterAnisotropy",
                  &scattering->scatter_anisotropy, 1, -MAX_SCATTER_ANISOTROPY,
                  MAX_SCATTER_ANISOTROPY, &desc->scatter_anisotropy_g);
    if (!scattering->is_scatter || desc->scatter_anisotropy_g == 0.0f) return;
    for (int i = 0; i < 3; ++i) {
        desc->multiscatter_color[i] =
            color_for_anisotropy(desc->multiscatter_color[i], desc->scatter_anisotropy_g);
    }
}

void ppmi_gltf_convert_inside(ppmi_gltf_conversion *c)
{
    if (!(c->from->transmission > 0.0 || c->from->scattering.diffuse_transmission > 0.0)) return;
    convert_transmission(c);
    convert_diffuse_transmission(c);
    c->desc.transmission_kind = transmission_kind(c->reader, c->from);
    if (c->from->scattering.is_scatter && c->desc.transmission_kind == PPM_TRANSMISSION_THIN) {
        ppmi_gltf_convert_sheet_scatter(c);
    } else {
        convert_volume(c);
    }
    if (c->desc.transmission_kind == PPM_TRANSMISSION_SOLID) {
        c->reader->tally.solid_glass++;
    } else {
        c->reader->tally.thin_glass++;
    }
}
