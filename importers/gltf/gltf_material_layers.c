/* The extensions that lay something on a surface or bend its highlight: KHR_materials_clearcoat,
 * _sheen, _iridescence, _anisotropy, and the drafts _retroreflection and _diffuse_roughness. */
#include <math.h>

#include "gltf/gltf_material.h"

#define TWO_PI 6.28318530717958647693
#define MAX_FILM_NM 1e6 /* a millimetre: far beyond any interference that could be seen */

static void convert_clearcoat(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_layers *from = &c->from->layers;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_clearcoat.clearcoatFactor", &from->clearcoat, 1, 0.0, 1.0,
                  &desc->clearcoat);
    ppmi_gltf_set_texture(c, "KHR_materials_clearcoat.clearcoatTexture", &from->clearcoat_texture,
                          PPM_IMAGE_DATA, &desc->clearcoat_texture);
    ppmi_gltf_set(c, "KHR_materials_clearcoat.clearcoatRoughnessFactor", &from->clearcoat_roughness,
                  1, 0.0, 1.0, &desc->clearcoat_roughness);
    ppmi_gltf_set_texture(c, "KHR_materials_clearcoat.clearcoatRoughnessTexture",
                          &from->clearcoat_roughness_texture, PPM_IMAGE_DATA,
                          &desc->clearcoat_roughness_texture);
    ppmi_gltf_set_texture(c, "KHR_materials_clearcoat.clearcoatNormalTexture",
                          &from->clearcoat_normal_texture, PPM_IMAGE_DATA,
                          &desc->clearcoat_normal_texture);
    ppmi_gltf_set(c, "KHR_materials_clearcoat.clearcoatNormalTexture.scale",
                  &from->clearcoat_normal_texture.scale, 1, -PPMI_GLTF_HUGE, PPMI_GLTF_HUGE,
                  &desc->clearcoat_normal_scale);
}

static void convert_sheen(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_layers *from = &c->from->layers;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_sheen.sheenColorFactor", from->sheen_color, 3, 0.0, 1.0,
                  desc->sheen_color);
    ppmi_gltf_set_texture(c, "KHR_materials_sheen.sheenColorTexture", &from->sheen_color_texture,
                          PPM_IMAGE_COLOR, &desc->sheen_color_texture);
    ppmi_gltf_set(c, "KHR_materials_sheen.sheenRoughnessFactor", &from->sheen_roughness, 1, 0.0,
                  1.0, &desc->sheen_roughness);
    ppmi_gltf_set_texture(
        c, "KHR_materials_sheen.sheenRoughnessTexture", &from->sheen_roughness_texture,
        ppmi_gltf_alpha_role(c, &from->sheen_roughness_texture, &from->sheen_color_texture),
        &desc->sheen_roughness_texture);
}

static void convert_iridescence(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_layers *from = &c->from->layers;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_iridescence.iridescenceFactor", &from->iridescence, 1, 0.0, 1.0,
                  &desc->iridescence);
    ppmi_gltf_set_texture(c, "KHR_materials_iridescence.iridescenceTexture",
                          &from->iridescence_texture, PPM_IMAGE_DATA, &desc->iridescence_texture);
    ppmi_gltf_set(c, "KHR_materials_iridescence.iridescenceIor", &from->iridescence_ior, 1, 1.0,
                  1000.0, &desc->iridescence_ior);
    ppmi_gltf_set(c, "KHR_materials_iridescence.iridescenceThicknessMinimum",
                  &from->iridescence_min_nm, 1, 0.0, MAX_FILM_NM,
                  &desc->iridescence_thickness_min_nm);
    ppmi_gltf_set(c, "KHR_materials_iridescence.iridescenceThicknessMaximum",
                  &from->iridescence_max_nm, 1, 0.0, MAX_FILM_NM,
                  &desc->iridescence_thickness_max_nm);
    ppmi_gltf_set_texture(c, "KHR_materials_iridescence.iridescenceThicknessTexture",
                          &from->iridescence_thickness_texture, PPM_IMAGE_DATA,
                          &desc->iridescence_thickness_texture);
}

static void convert_anisotropy(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_layers *from = &c->from->layers;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_anisotropy.anisotropyStrength", &from->anisotropy, 1, 0.0, 1.0,
                  &desc->anisotropy);
    /* many turns would cost a float its digits */
    desc->anisotropy_rotation_rad = (float)remainder(from->anisotropy_rotation_rad, TWO_PI);
    ppmi_gltf_set_texture(c, "KHR_materials_anisotropy.anisotropyTexture",
                          &from->anisotropy_texture, PPM_IMAGE_DATA, &desc->anisotropy_texture);
}

static void convert_retroreflection(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_layers *from = &c->from->layers;
    ppmi_gltf_set(c, "KHR_materials_retroreflection.retroreflectionFactor", &from->retroreflection,
                  1, 0.0, 1.0, &c->desc.retroreflection);
    ppmi_gltf_set_texture(c, "KHR_materials_retroreflection.retroreflectionTexture",
                          &from->retroreflection_texture, PPM_IMAGE_DATA,
                          &c->desc.retroreflection_texture);
}

static void convert_diffuse_roughness(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_layers *from = &c->from->layers;
    ppmi_gltf_set(c, "KHR_materials_diffuse_roughness.diffuseRoughnessFactor",
                  &from->diffuse_roughness, 1, 0.0, 1.0, &c->desc.diffuse_roughness);
    ppmi_gltf_set_texture(c, "KHR_materials_diffuse_roughness.diffuseRoughnessTexture",
                          &from->diffuse_roughness_texture, PPM_IMAGE_DATA,
                          &c->desc.diffuse_roughness_texture);
}

void ppmi_gltf_convert_layers(ppmi_gltf_conversion *c)
{
    if (c->from->layers.coat.is_given) {
        ppmi_gltf_convert_coat(c);
    } else {
        convert_clearcoat(c);
    }
    if (c->from->layers.fuzz.is_given) {
        ppmi_gltf_convert_fuzz(c);
    } else {
        convert_sheen(c);
    }
    convert_diffuse_roughness(c);
    convert_iridescence(c);
    convert_anisotropy(c);
    convert_retroreflection(c);
}
