/* KHR_materials_coat and KHR_materials_fuzz: drafts that are to replace KHR_materials_clearcoat and
 * KHR_materials_sheen, and have all that these have. */
#include <math.h>

#include "gltf/gltf_material.h"

#define TWO_PI 6.28318530717958647693

static void convert_coat_surface(ppmi_gltf_conversion *c, const ppmi_gltf_coat *from)
{
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_coat.coatFactor", &from->factor, 1, 0.0, 1.0, &desc->clearcoat);
    ppmi_gltf_set_texture(c, "KHR_materials_coat.coatTexture", &from->texture, PPM_IMAGE_DATA,
                          &desc->clearcoat_texture);
    ppmi_gltf_set(c, "KHR_materials_coat.coatRoughnessFactor", &from->roughness, 1, 0.0, 1.0,
                  &desc->clearcoat_roughness);
    ppmi_gltf_set_texture(c, "KHR_materials_coat.coatRoughnessTexture", &from->roughness_texture,
                          PPM_IMAGE_DATA, &desc->clearcoat_roughness_texture);
    ppmi_gltf_set_texture(c, "KHR_materials_coat.coatNormalTexture", &from->normal_texture,
                          PPM_IMAGE_DATA, &desc->clearcoat_normal_texture);
    ppmi_gltf_set(c, "KHR_materials_coat.coatNormalTexture.scale", &from->normal_texture.scale, 1,
                  -PPMI_GLTF_HUGE, PPMI_GLTF_HUGE, &desc->clearcoat_normal_scale);
    ppmi_gltf_set(c, "KHR_materials_coat.coatAnisotropyStrength", &from->anisotropy, 1, 0.0, 1.0,
                  &desc->coat_anisotropy);
    /* many turns would cost a float its digits */
    desc->coat_anisotropy_rotation_rad = (float)remainder(from->anisotropy_rotation_rad, TWO_PI);
    ppmi_gltf_set_texture(c, "KHR_materials_coat.coatAnisotropyTexture", &from->anisotropy_texture,
                          PPM_IMAGE_DATA, &desc->coat_anisotropy_texture);
}

void ppmi_gltf_convert_coat(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_coat *from = &c->from->layers.coat;
    ppm_material_desc *desc = &c->desc;
    convert_coat_surface(c, from);
    ppmi_gltf_set(c, "KHR_materials_coat.coatIor", &from->ior, 1, 0.0, 1000.0, &desc->coat_ior);
    if (desc->coat_ior > 0.0f && desc->coat_ior < 1.0f) { /* 0 is a special value */
        ppmi_gltf_warn(c->reader, c->place, "KHR_materials_coat.coatIor is less than 1; 1 is used");
        desc->coat_ior = 1.0f;
    }
    ppmi_gltf_set(c, "KHR_materials_coat.coatColorFactor", from->color, 3, 0.0, 1.0,
                  desc->coat_color);
    ppmi_gltf_set_texture(c, "KHR_materials_coat.coatColorTexture", &from->color_texture,
                          PPM_IMAGE_COLOR, &desc->coat_color_texture);
    ppmi_gltf_set(c, "KHR_materials_coat.coatDarkeningFactor", &from->darkening, 1, 0.0, 1.0,
                  &desc->coat_darkening);
    desc->emission_is_above_coat = 1;
}

void ppmi_gltf_convert_fuzz(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_fuzz *from = &c->from->layers.fuzz;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_fuzz.fuzzFactor", &from->factor, 1, 0.0, 1.0, &desc->fuzz);
    if (!(desc->fuzz > 0.0f)) return; /* the colour would be that of a sheen */
    ppmi_gltf_set_texture(c, "KHR_materials_fuzz.fuzzTexture", &from->texture, PPM_IMAGE_DATA,
                          &desc->fuzz_texture);
    ppmi_gltf_set(c, "KHR_materials_fuzz.fuzzColorFactor", from->color, 3, 0.0, 1.0,
                  desc->sheen_color);
    ppmi_gltf_set_texture(c, "KHR_materials_fuzz.fuzzColorTexture", &from->color_texture,
                          PPM_IMAGE_COLOR, &desc->sheen_color_texture);
    ppmi_gltf_set(c, "KHR_materials_fuzz.fuzzRoughnessFactor", &from->roughness, 1, 0.0, 1.0,
                  &desc->sheen_roughness);
    ppmi_gltf_set_texture(c, "KHR_materials_fuzz.fuzzRoughnessTexture", &from->roughness_texture,
                          ppmi_gltf_alpha_role(c, &from->roughness_texture, &from->color_texture),
                          &desc->sheen_roughness_texture);
}
