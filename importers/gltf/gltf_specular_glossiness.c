/* KHR_materials_pbrSpecularGlossiness, archived and still met. It is preferred to the values of the
 * core where a material has both, as it asks for.
 *
 * It is converted as Khronos does in KHR_materials_specular ("Conversions"): a dielectric of index
 * 0, whose reflectance is 1 at normal incidence before the specular colour scales it. So
 *   F0 = specular, F90 = 1, roughness = 1 - glossiness, per texel,
 * and the diffuse part gets what the reflection leaves: diffuse * (1 - max(F)), which is the
 * extension's diffuse * (1 - max(specular)) where one looks along the normal. */
#include "gltf/gltf_material.h"

void ppmi_gltf_convert_specular_glossiness(ppmi_gltf_conversion *c)
{
    const ppmi_gltf_specular_glossiness *from = &c->from->specular_glossiness;
    const char *const texture = "KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture";
    ppm_material_desc *desc = &c->desc;
    desc->metallic = 0.0f;
    desc->ior = 0.0f;
    ppmi_gltf_set(c, "KHR_materials_pbrSpecularGlossiness.diffuseFactor", from->diffuse, 4, 0.0,
                  1.0, desc->base_color);
    ppmi_gltf_set_texture(c, "KHR_materials_pbrSpecularGlossiness.diffuseTexture",
                          &from->diffuse_texture, PPM_IMAGE_COLOR, &desc->base_color_texture);
    ppmi_gltf_set(c, "KHR_materials_pbrSpecularGlossiness.specularFactor", from->specular, 3, 0.0,
                  1.0, desc->specular_color);
    ppmi_gltf_set_texture(c, texture, &from->specular_glossiness_texture, PPM_IMAGE_COLOR,
                          &desc->specular_color_texture);
    ppmi_gltf_set(c, "KHR_materials_pbrSpecularGlossiness.glossinessFactor", &from->glossiness, 1,
                  0.0, 1.0, &desc->roughness);
    desc->roughness_is_glossiness = 1;
    /* one image for both: its alpha is a number in either role */
    desc->metallic_roughness_texture = desc->specular_color_texture;
}
