/* Materials: the metallic-roughness model and its extensions, value by value. */
#include <math.h>
#include <string.h>

#include "gltf/gltf_extensions.h"
#include "gltf/gltf_material.h"

typedef ppmi_gltf_conversion conversion;

/* ---- values ---------------------------------------------------------------------------------- */

void ppmi_gltf_set(conversion *c, const char *name, const double *from, int count, double low,
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

void ppmi_gltf_set_texture(conversion *c, const char *name, const ppmi_gltf_texture_info *info,
                           int32_t role, ppm_texture *out)
{
    char place[PPMI_GLTF_PLACE];
    if (c->status != PPM_STATUS_OK || info->texture < 0) return;
    ppmi_gltf_place(place, "%s.%s", c->place, name);
    c->status = ppmi_gltf_use_texture(c->reader, info, role, place, out);
}

int32_t ppmi_gltf_alpha_role(const conversion *c, const ppmi_gltf_texture_info *alpha,
                             const ppmi_gltf_texture_info *color)
{
    const ppmi_gltf_document *document = c->reader->document;
    const size_t a = (size_t)alpha->texture, b = (size_t)color->texture; /* -1: huge */
    if (a >= document->texture_count || b >= document->texture_count) return PPM_IMAGE_DATA;
    return document->textures[a].source == document->textures[b].source ? PPM_IMAGE_COLOR
                                                                        : PPM_IMAGE_DATA;
}

/* ---- groups of values ------------------------------------------------------------------------ */

static void convert_metallic_roughness(conversion *c)
{
    const ppmi_gltf_material *from = c->from;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "baseColorFactor", from->base_color, 4, 0.0, 1.0, desc->base_color);
    ppmi_gltf_set_texture(c, "pbrMetallicRoughness.baseColorTexture", &from->base_color_texture,
                          PPM_IMAGE_COLOR, &desc->base_color_texture);
    ppmi_gltf_set(c, "metallicFactor", &from->metallic, 1, 0.0, 1.0, &desc->metallic);
    ppmi_gltf_set(c, "roughnessFactor", &from->roughness, 1, 0.0, 1.0, &desc->roughness);
    ppmi_gltf_set_texture(c, "pbrMetallicRoughness.metallicRoughnessTexture",
                          &from->metallic_roughness_texture, PPM_IMAGE_DATA,
                          &desc->metallic_roughness_texture);
}

/* What every model of a surface has. */
static void convert_surface(conversion *c)
{
    const ppmi_gltf_material *from = c->from;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set_texture(c, "normalTexture", &from->normal_texture, PPM_IMAGE_DATA,
                          &desc->normal_texture);
    ppmi_gltf_set(c, "normalTexture.scale", &from->normal_texture.scale, 1, -PPMI_GLTF_HUGE,
                  PPMI_GLTF_HUGE, &desc->normal_scale);
    desc->double_sided = from->double_sided;
    desc->alpha_mode = strcmp(from->alpha_mode, "MASK") == 0    ? PPM_ALPHA_MASK
                       : strcmp(from->alpha_mode, "BLEND") == 0 ? PPM_ALPHA_BLEND
                                                                : PPM_ALPHA_OPAQUE;
    ppmi_gltf_set(c, "alphaCutoff", &from->alpha_cutoff, 1, 0.0, PPMI_GLTF_HUGE,
                  &desc->alpha_cutoff);
}

/* KHR_materials_emissive_strength makes the product a luminance in nit. */
static void convert_emission(conversion *c)
{
    double emission[3];
    for (int i = 0; i < 3; ++i) {
        emission[i] = c->from->emissive[i] * c->from->emissive_strength;
    }
    ppmi_gltf_set(c, "emissiveFactor (with emissiveStrength)", emission, 3, 0.0, PPMI_GLTF_HUGE,
                  c->desc.emission);
    ppmi_gltf_set_texture(c, "emissiveTexture", &c->from->emissive_texture, PPM_IMAGE_COLOR,
                          &c->desc.emission_texture);
}

static void convert_dielectric(conversion *c)
{
    const ppmi_gltf_material *from = c->from;
    ppm_material_desc *desc = &c->desc;
    ppmi_gltf_set(c, "KHR_materials_ior.ior", &from->ior, 1, 0.0, 1000.0, &desc->ior);
    if (desc->ior > 0.0f && desc->ior < 1.0f) { /* 0 is the extension's own special value */
        ppmi_gltf_warn(c->reader, c->place, "KHR_materials_ior.ior is less than 1; 1 is used");
        desc->ior = 1.0f;
    }
    ppmi_gltf_set(c, "KHR_materials_specular.specularFactor", &from->specular, 1, 0.0, 1.0,
                  &desc->specular);
    ppmi_gltf_set_texture(
        c, "KHR_materials_specular.specularTexture", &from->specular_texture,
        ppmi_gltf_alpha_role(c, &from->specular_texture, &from->specular_color_texture),
        &desc->specular_texture);
    ppmi_gltf_set(c, "KHR_materials_specular.specularColorFactor", from->specular_color, 3, 0.0,
                  PPMI_GLTF_HUGE, desc->specular_color);
    ppmi_gltf_set_texture(c, "KHR_materials_specular.specularColorTexture",
                          &from->specular_color_texture, PPM_IMAGE_COLOR,
                          &desc->specular_color_texture);
    desc->specular_is_edge_color = from->specular_is_edge_color;
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
    desc->emission_takes_vertex_color = 1;
    memset(desc->base_color, 0, sizeof desc->emission);
    desc->metallic = 0.0f;
    desc->roughness = 1.0f;
    desc->metallic_roughness_texture = (ppm_texture){0};
    desc->normal_texture = (ppm_texture){0};
    desc->specular = 0.0f;
    ppmi_gltf_note_extension(c->reader, "KHR_materials_unlit");
}

/* The extensions exclude each other where they are not called for one material. */
static void convert(conversion *c)
{
    const bool is_glossy = c->from->specular_glossiness.is_given && !c->from->is_unlit;
    if (is_glossy) {
        ppmi_gltf_convert_specular_glossiness(c);
    } else {
        convert_metallic_roughness(c);
    }
    convert_surface(c);
    if (c->from->is_unlit) {
        convert_unlit(c);
        return;
    }
    convert_emission(c);
    convert_priority(c);
    if (is_glossy) return;
    convert_dielectric(c);
    ppmi_gltf_convert_layers(c);
    ppmi_gltf_convert_inside(c);
}

ppm_status ppmi_gltf_convert_material(ppmi_gltf_reader *reader, int32_t index,
                                      const ppmi_gltf_material *from, ppm_material_desc *out_desc)
{
    conversion c = {.reader = reader, .from = from};
    ppmi_gltf_place(c.place, "materials[%d]", (int)index);
    ppm_material_desc_init(&c.desc);
    convert(&c);
    *out_desc = c.desc;
    return c.status;
}

/* ---- use ------------------------------------------------------------------------------------- */

/* Adds the material, or changes the one that *id is. */
static ppm_status put_material(ppmi_gltf_reader *reader, int32_t index, ppm_material_id *id)
{
    const ppmi_gltf_material *from = &reader->document->materials[index];
    char name[PPMI_GLTF_PLACE];
    ppm_material_desc desc;
    const ppm_status status = ppmi_gltf_convert_material(reader, index, from, &desc);
    if (status != PPM_STATUS_OK) return status;
    desc.name = ppmi_gltf_printable(from->name, strlen(from->name), name, sizeof name);
    if (*id != 0) return ppm_scene_set_material(reader->scene, *id, &desc);
    return ppm_scene_add_material(reader->scene, &desc, id);
}

ppm_status ppmi_gltf_update_material(ppmi_gltf_reader *reader, int32_t material)
{
    return put_material(reader, material, &reader->materials[material]);
}

void ppmi_gltf_visit_material(ppmi_gltf_reader *reader, int32_t material)
{
    ppm_context *const context = reader->context;
    const ppmi_gltf_tally tally = reader->tally;
    conversion c = {.reader = reader, .from = &reader->document->materials[material]};
    reader->context = NULL; /* messages come when the material is used */
    convert(&c);
    reader->context = context;
    reader->tally = tally;
}

uint32_t ppmi_gltf_material_uv_sets(ppmi_gltf_reader *reader, int32_t material)
{
    char reason[PPMI_GLTF_PLACE];
    const bool was_looking = reader->is_looking_at_textures;
    if (!ppmi_gltf_is_usable(reader, PPMI_GLTF_MATERIALS, material, reason, sizeof reason)) {
        return 0;
    }
    reader->uv_sets_seen = 0;
    reader->is_looking_at_textures = true;
    ppmi_gltf_visit_material(reader, material);
    reader->is_looking_at_textures = was_looking;
    return reader->uv_sets_seen;
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
