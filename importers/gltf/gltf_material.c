/* Materials: the metallic-roughness model and its extensions, value by value. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_reader.h"

#define HUGE_VALUE 1e18

/* One material on its way to the scene. */
typedef struct conversion {
    ppmi_gltf_reader *reader;
    const ppmi_gltf_material *from;
    char place[PPMI_GLTF_PLACE]; /* materials[i] */
    ppm_material_desc desc;
    ppm_status status; /* the first failure */
} conversion;

/* ---- values ---------------------------------------------------------------------------------- */

/* Brings values into low..high, with one warning for all of them. */
static void set(conversion *c, const char *name, const double *from, int count, double low,
                double high, float *out)
{
    bool is_clamped = false;
    for (int i = 0; i < count; ++i) {
        const double value = fmin(fmax(from[i], low), high);
        is_clamped = is_clamped || value != from[i];
        out[i] = (float)value;
    }
    if (is_clamped) {
        ppmi_gltf_warn(c->reader, c->place, "%s is brought into %g .. %g", name, low, high);
    }
}

static void set_texture(conversion *c, const char *name, const ppmi_gltf_texture_info *info,
                        int32_t role, ppm_texture *out)
{
    char place[PPMI_GLTF_PLACE];
    if (c->status != PPM_STATUS_OK || info->texture < 0) return;
    ppmi_gltf_place(place, "%s.%s", c->place, name);
    c->status = ppmi_gltf_use_texture(c->reader, info, role, place, out);
}

/* ---- groups of values ------------------------------------------------------------------------ */

static void convert_core(conversion *c)
{
    const ppmi_gltf_material *from = c->from;
    ppm_material_desc *desc = &c->desc;
    set(c, "baseColorFactor", from->base_color, 4, 0.0, 1.0, desc->base_color);
    set_texture(c, "pbrMetallicRoughness.baseColorTexture", &from->base_color_texture,
                PPM_IMAGE_COLOR, &desc->base_color_texture);
    set(c, "metallicFactor", &from->metallic, 1, 0.0, 1.0, &desc->metallic);
    set(c, "roughnessFactor", &from->roughness, 1, 0.0, 1.0, &desc->roughness);
    set_texture(c, "pbrMetallicRoughness.metallicRoughnessTexture",
                &from->metallic_roughness_texture, PPM_IMAGE_DATA,
                &desc->metallic_roughness_texture);
    set_texture(c, "normalTexture", &from->normal_texture, PPM_IMAGE_DATA, &desc->normal_texture);
    set(c, "normalTexture.scale", &from->normal_texture.scale, 1, -HUGE_VALUE, HUGE_VALUE,
        &desc->normal_scale);
    desc->double_sided = from->double_sided;
    desc->alpha_mode = strcmp(from->alpha_mode, "MASK") == 0    ? PPM_ALPHA_MASK
                       : strcmp(from->alpha_mode, "BLEND") == 0 ? PPM_ALPHA_BLEND
                                                                : PPM_ALPHA_OPAQUE;
    set(c, "alphaCutoff", &from->alpha_cutoff, 1, 0.0, HUGE_VALUE, &desc->alpha_cutoff);
}

/* KHR_materials_emissive_strength makes the product a luminance in nit. */
static void convert_emission(conversion *c)
{
    double emission[3];
    for (int i = 0; i < 3; ++i) {
        emission[i] = c->from->emissive[i] * c->from->emissive_strength;
    }
    set(c, "emissiveFactor (with emissiveStrength)", emission, 3, 0.0, HUGE_VALUE,
        c->desc.emission);
    set_texture(c, "emissiveTexture", &c->from->emissive_texture, PPM_IMAGE_COLOR,
                &c->desc.emission_texture);
}

static void convert_dielectric(conversion *c)
{
    const ppmi_gltf_material *from = c->from;
    ppm_material_desc *desc = &c->desc;
    set(c, "KHR_materials_ior.ior", &from->ior, 1, 0.0, 1000.0, &desc->ior);
    if (desc->ior > 0.0f && desc->ior < 1.0f) { /* 0 is the extension's own special value */
        ppmi_gltf_warn(c->reader, c->place, "KHR_materials_ior.ior is less than 1; 1 is used");
        desc->ior = 1.0f;
    }
    set(c, "KHR_materials_specular.specularFactor", &from->specular, 1, 0.0, 1.0, &desc->specular);
    set_texture(c, "KHR_materials_specular.specularTexture", &from->specular_texture,
                PPM_IMAGE_DATA, &desc->specular_texture);
    set(c, "KHR_materials_specular.specularColorFactor", from->specular_color, 3, 0.0, HUGE_VALUE,
        desc->specular_color);
    set_texture(c, "KHR_materials_specular.specularColorTexture", &from->specular_color_texture,
                PPM_IMAGE_COLOR, &desc->specular_color_texture);
}

/* include/ppm/import.h, PPM_TRANSMISSION_POLICY_ */
static int32_t transmission_kind(const ppmi_gltf_reader *reader, double thickness)
{
    switch (reader->options->transmission) {
    case PPM_TRANSMISSION_POLICY_SOLID:
        return PPM_TRANSMISSION_SOLID;
    case PPM_TRANSMISSION_POLICY_THIN:
        return PPM_TRANSMISSION_THIN;
    default:
        return thickness > 0.0 || reader->from_blender ? PPM_TRANSMISSION_SOLID
                                                       : PPM_TRANSMISSION_THIN;
    }
}

static void convert_transmission(conversion *c)
{
    const ppmi_gltf_material *from = c->from;
    ppm_material_desc *desc = &c->desc;
    if (!(from->transmission > 0.0)) return;
    set(c, "KHR_materials_transmission.transmissionFactor", &from->transmission, 1, 0.0, 1.0,
        &desc->transmission);
    set_texture(c, "KHR_materials_transmission.transmissionTexture", &from->transmission_texture,
                PPM_IMAGE_DATA, &desc->transmission_texture);
    set(c, "KHR_materials_volume.attenuationColor", from->attenuation_color, 3, 0.0, 1.0,
        desc->attenuation_color);
    set(c, "KHR_materials_volume.attenuationDistance", &from->attenuation_distance, 1, 0.0,
        HUGE_VALUE, &desc->attenuation_distance_m);
    set(c, "KHR_materials_dispersion.dispersion", &from->dispersion, 1, 0.0, 1000.0,
        &desc->dispersion);
    desc->transmission_kind = transmission_kind(c->reader, from->thickness);
    if (desc->transmission_kind == PPM_TRANSMISSION_SOLID) {
        c->reader->tally.solid_glass++;
    } else {
        c->reader->tally.thin_glass++;
    }
}

/* glTF has no word for which of two overlapping solids is there, so it is one of ours. */
static void convert_priority(conversion *c)
{
    const double value = c->from->priority;
    if (value == floor(value) && value >= INT32_MIN && value <= INT32_MAX) {
        c->desc.nested_priority = (int32_t)value;
        return;
    }
    ppmi_gltf_warn(c->reader, c->place,
                   "extras.ppm_priority is %g, expected an integer of 32 bits; 0 is used", value);
}

/* KHR_materials_unlit: a surface that looks the same in any light is one that shines and reflects
 * nothing. Base colour keeps its alpha. */
static void convert_unlit(conversion *c)
{
    ppm_material_desc *desc = &c->desc;
    memcpy(desc->emission, desc->base_color, sizeof desc->emission);
    desc->emission_texture = desc->base_color_texture;
    memset(desc->base_color, 0, sizeof desc->emission);
    desc->metallic = 0.0f;
    desc->roughness = 1.0f;
    desc->metallic_roughness_texture = (ppm_texture){0};
    desc->normal_texture = (ppm_texture){0};
    desc->specular = 0.0f;
    ppmi_log(c->reader->context, PPM_LOG_INFO,
             "%s: %s: KHR_materials_unlit: it shines with its base colour, 1 nit for white, and "
             "reflects nothing",
             c->reader->path, c->place);
}

static void convert(conversion *c)
{
    convert_core(c);
    if (c->from->is_unlit) {
        convert_unlit(c);
        return;
    }
    convert_emission(c);
    convert_dielectric(c);
    convert_transmission(c);
    convert_priority(c);
}

/* ---- use ------------------------------------------------------------------------------------- */

/* Adds the material, or changes the one that *id is. */
static ppm_status put_material(ppmi_gltf_reader *reader, int32_t index, ppm_material_id *id)
{
    const ppmi_gltf_material *from = &reader->document->materials[index];
    char name[PPMI_GLTF_PLACE];
    conversion c = {.reader = reader, .from = from};
    ppmi_gltf_place(c.place, "materials[%d]", (int)index);
    ppm_material_desc_init(&c.desc);
    c.desc.name = ppmi_gltf_printable(from->name, strlen(from->name), name, sizeof name);
    convert(&c);
    if (c.status != PPM_STATUS_OK) return c.status;
    if (*id != 0) return ppm_scene_set_material(reader->scene, *id, &c.desc);
    return ppm_scene_add_material(reader->scene, &c.desc, id);
}

ppm_status ppmi_gltf_update_material(ppmi_gltf_reader *reader, int32_t material)
{
    return put_material(reader, material, &reader->materials[material]);
}

/* The specification's material for primitives that name none: white metal, rough. */
static ppm_status use_default(ppmi_gltf_reader *reader, ppm_material_id *out_id)
{
    ppm_status status = PPM_STATUS_OK;
    if (reader->default_material == 0) {
        ppm_material_desc desc;
        ppm_material_desc_init(&desc);
        desc.name = "(glTF default)";
        desc.metallic = 1.0f;
        desc.roughness = 1.0f;
        desc.double_sided = 0;
        status = ppm_scene_add_material(reader->scene, &desc, &reader->default_material);
    }
    *out_id = reader->default_material;
    return status;
}

ppm_status ppmi_gltf_use_material(ppmi_gltf_reader *reader, int32_t material, const char *place,
                                  ppm_material_id *out_id)
{
    ppm_status status = PPM_STATUS_OK;
    if (material < 0 || !ppmi_gltf_accept(reader, PPMI_GLTF_MATERIALS, material, place)) {
        return use_default(reader, out_id);
    }
    if (reader->materials[material] == 0) {
        status = put_material(reader, material, &reader->materials[material]);
    }
    *out_id = reader->materials[material];
    return status;
}
