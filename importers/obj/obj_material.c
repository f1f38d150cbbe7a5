/* Materials: MTL's illumination models and its PBR extension to the metallic-roughness model.
 * docs/obj.md has the mapping in words.
 *
 * Roughness: a Phong exponent n and the Beckmann width a with the same shape near the mirror
 * direction have a^2 = 2 / (n + 2) (Walter et al. 2007, "Microfacet Models for Refraction through
 * Rough Surfaces", section 5.2 about alpha_p); a is taken for GGX, whose perceptual roughness is
 * sqrt(a).
 * Specular: F0 = 0.08 Ks, as in Burley 2012, "Physically-Based Shading at Disney", where 0.5 is
 * the index 1.5; exporters write that parameter as Ks. */
#include <math.h>
#include <string.h>

#include "obj/obj_material.h"

void ppmi_obj_material_warn(const ppmi_obj_conversion *c, const char *text)
{
    const ppmi_obj_reader *r = c->reader;
    ppmi_log(r->context, PPM_LOG_WARNING, "%s: line %zu: material '%s': %s",
             ppmi_obj_names_get(&r->libraries, c->material->library), c->material->line, c->name,
             text);
}

static void set_color(float *out, const float *from, float high)
{
    for (int i = 0; i < 3; ++i) {
        out[i] = ppmi_obj_limit(from[i], 0.0f, high);
    }
}

static void set_even(float *out, float value)
{
    out[0] = out[1] = out[2] = value;
}

static float largest(const float *color)
{
    return fmaxf(color[0], fmaxf(color[1], color[2]));
}

/* ---- what sort of material ------------------------------------------------------------------- */

static int32_t illumination(const ppmi_obj_conversion *c)
{
    return ppmi_obj_has(c, PPMI_OBJ_HAS_ILLUM) ? c->from->illum : 2;
}

/* Maya writes illum 4, Ni 1 and Tf for all of its materials, and never d; Tf 1 is opaque there. */
static bool is_of_maya(const ppmi_obj_conversion *c)
{
    return illumination(c) == 4 && ppmi_obj_has(c, PPMI_OBJ_HAS_NI) && c->from->ior == 1.0f &&
           ppmi_obj_has(c, PPMI_OBJ_HAS_TF) && !ppmi_obj_has(c, PPMI_OBJ_HAS_D);
}

/* What has a map of alpha is a cut-out, whatever else it says. */
static bool is_glass(const ppmi_obj_conversion *c)
{
    const int32_t illum = illumination(c);
    const bool is_filter =
        ppmi_obj_has(c, PPMI_OBJ_HAS_TF) && largest(c->from->transmittance) > 0.0f;
    if (ppmi_obj_has_map(c, PPMI_OBJ_MAP_D) || is_of_maya(c)) return false;
    return illum == 4 || illum == 6 || illum == 7 || illum == 9 ||
           (is_filter && c->from->dissolve < 1.0f);
}

static bool is_mirror(const ppmi_obj_conversion *c)
{
    const int32_t illum = illumination(c);
    return (illum == 3 || illum == 5) && !ppmi_obj_has(c, PPMI_OBJ_HAS_PM) &&
           !ppmi_obj_has_map(c, PPMI_OBJ_MAP_PM) && largest(c->from->specular) > 0.0f;
}

/* The highest value, 1000, means a perfect polish. */
float ppmi_obj_roughness_of(float shininess)
{
    if (shininess >= 1000.0f) return 0.0f;
    return sqrtf(sqrtf(2.0f / (fmaxf(shininess, 0.0f) + 2.0f)));
}

/* Pr if there is one; else from Ns. */
static float roughness(const ppmi_obj_conversion *c, float otherwise)
{
    if (ppmi_obj_has(c, PPMI_OBJ_HAS_PR)) return ppmi_obj_limit(c->from->roughness, 0.0f, 1.0f);
    if (!ppmi_obj_has(c, PPMI_OBJ_HAS_NS)) return otherwise;
    return ppmi_obj_roughness_of(c->from->shininess);
}

/* ---- groups of values ------------------------------------------------------------------------ */

static void convert_glass(ppmi_obj_conversion *c)
{
    ppm_material_desc *desc = &c->desc;
    const float *filter = c->from->transmittance;
    desc->transmission = 1.0f;
    desc->transmission_kind = PPM_TRANSMISSION_SOLID;
    desc->ior = c->from->ior > 1.0f ? ppmi_obj_limit(c->from->ior, 1.0f, 1000.0f) : 1.5f;
    desc->roughness = roughness(c, 0.0f);
    set_even(desc->base_color, 1.0f);
    if (ppmi_obj_has(c, PPMI_OBJ_HAS_TF) && largest(filter) > 0.0f) {
        set_color(desc->base_color, filter, 1.0f);
    }
    ppmi_obj_use_color(c, PPMI_OBJ_MAP_TF, &desc->base_color_texture);
    ppmi_obj_use_roughness_and_metal(c, true);
}

static void convert_mirror(ppmi_obj_conversion *c)
{
    c->desc.metallic = 1.0f;
    c->desc.roughness = ppmi_obj_has(c, PPMI_OBJ_HAS_PR) ? roughness(c, 0.0f) : 0.0f;
    set_color(c->desc.base_color, c->from->specular, 1.0f);
    ppmi_obj_use_color(c, PPMI_OBJ_MAP_KS, &c->desc.base_color_texture);
    ppmi_obj_use_roughness_and_metal(c, false);
}

/* Kd of a map without one, or with a black one, which some programs write, is white. */
static void convert_diffuse(ppmi_obj_conversion *c)
{
    const ppmi_obj_mtl *from = c->from;
    ppm_material_desc *desc = &c->desc;
    set_even(desc->base_color, 0.8f);
    if (ppmi_obj_has(c, PPMI_OBJ_HAS_KD)) set_color(desc->base_color, from->diffuse, 1.0f);
    ppmi_obj_use_color_and_alpha(c, &desc->base_color_texture);
    if (!ppmi_obj_has_map(c, PPMI_OBJ_MAP_KD) || desc->base_color_texture.image == 0) return;
    if (!ppmi_obj_has(c, PPMI_OBJ_HAS_KD) || largest(from->diffuse) <= 0.0f) {
        set_even(desc->base_color, 1.0f);
    }
}

/* F0 = 0.04 specular_color specular, F90 = specular (KHR_materials_specular with ior 1.5). */
static void convert_specular(ppmi_obj_conversion *c)
{
    const ppmi_obj_mtl *from = c->from;
    ppm_material_desc *desc = &c->desc;
    float color[3] = {1.0f, 1.0f, 1.0f};
    const bool is_mapped = ppmi_obj_has_map(c, PPMI_OBJ_MAP_KS);
    const bool is_dull = ppmi_obj_has(c, PPMI_OBJ_HAS_ILLUM) && from->illum < 2;
    if (ppmi_obj_has(c, PPMI_OBJ_HAS_KS) || !is_mapped) set_color(color, from->specular, 1.0f);
    const float most = is_dull ? 0.0f : largest(color);
    desc->specular = ppmi_obj_limit(2.0f * most, 0.0f, 1.0f);
    for (int i = 0; i < 3 && most > 0.0f; ++i) {
        desc->specular_color[i] = 2.0f * color[i] / desc->specular;
    }
    if (most > 0.0f) ppmi_obj_use_color(c, PPMI_OBJ_MAP_KS, &desc->specular_color_texture);
}

/* An alpha of 0, which would hide the surface, is nearly always a program that means "opaque". */
static void convert_alpha(ppmi_obj_conversion *c)
{
    const ppmi_obj_mtl *from = c->from;
    const float *filter = from->transmittance;
    float alpha = ppmi_obj_limit(from->dissolve, 0.0f, 1.0f);
    if (is_of_maya(c)) {
        alpha = ppmi_obj_limit((filter[0] + filter[1] + filter[2]) / 3.0f, 0.0f, 1.0f);
    }
    if (alpha <= 0.0f) {
        ppmi_obj_material_warn(c, "d 0 or Tr 1 would hide it: it is taken as opaque");
        alpha = 1.0f;
    }
    c->desc.base_color[3] = alpha;
    const bool is_mapped =
        ppmi_obj_has_map(c, PPMI_OBJ_MAP_D) && c->desc.base_color_texture.image != 0;
    if (alpha < 1.0f || is_mapped) c->desc.alpha_mode = PPM_ALPHA_BLEND;
}

static void convert_opaque(ppmi_obj_conversion *c)
{
    convert_diffuse(c);
    convert_specular(c);
    c->desc.roughness = roughness(c, 0.5f);
    if (ppmi_obj_has(c, PPMI_OBJ_HAS_PM)) {
        c->desc.metallic = ppmi_obj_limit(c->from->metallic, 0.0f, 1.0f);
    }
    ppmi_obj_use_roughness_and_metal(c, true);
    convert_alpha(c);
}

static void convert_emission(ppmi_obj_conversion *c)
{
    ppm_material_desc *desc = &c->desc;
    set_color(desc->emission, c->from->emission, PPMI_OBJ_HUGE);
    ppmi_obj_use_color(c, PPMI_OBJ_MAP_KE, &desc->emission_texture);
    const bool is_mapped = desc->emission_texture.image != 0;
    if (is_mapped && largest(c->from->emission) <= 0.0f) set_even(desc->emission, 1.0f);
}

/* ---- layers ---------------------------------------------------------------------------------- */

/* A value of 0 .. 1: what is given, else 1 with a map and otherwise without. */
static float share(const ppmi_obj_conversion *c, uint32_t statement, float given,
                   const ppm_texture *map, float otherwise)
{
    if (ppmi_obj_has(c, statement)) return ppmi_obj_limit(given, 0.0f, 1.0f);
    return map->image != 0 ? 1.0f : otherwise;
}

/* The extension has no roughness of the sheen; 0.5 is that of Blender, which writes Ps. */
static void convert_sheen(ppmi_obj_conversion *c)
{
    ppm_material_desc *desc = &c->desc;
    ppmi_obj_use_scalar(c, PPMI_OBJ_MAP_PS, &desc->sheen_color_texture);
    set_even(desc->sheen_color,
             share(c, PPMI_OBJ_HAS_PS, c->from->sheen, &desc->sheen_color_texture, 0.0f));
    if (desc->sheen_color[0] > 0.0f) desc->sheen_roughness = 0.5f;
}

static void convert_clearcoat(ppmi_obj_conversion *c)
{
    ppm_material_desc *desc = &c->desc;
    const ppmi_obj_mtl *from = c->from;
    ppm_texture *coat = &desc->clearcoat_texture, *rough = &desc->clearcoat_roughness_texture;
    ppmi_obj_use_scalar(c, PPMI_OBJ_MAP_PC, coat);
    desc->clearcoat = share(c, PPMI_OBJ_HAS_PC, from->clearcoat, coat, 0.0f);
    if (!(desc->clearcoat > 0.0f)) return;
    ppmi_obj_use_scalar(c, PPMI_OBJ_MAP_PCR, rough);
    desc->clearcoat_roughness = share(c, PPMI_OBJ_HAS_PCR, from->clearcoat_roughness, rough, 0.0f);
}

/* anisor counts turns, as in Blender and Disney's model; a negative aniso lies across. */
static void convert_anisotropy(ppmi_obj_conversion *c)
{
    const float two_pi = 6.28318530718f;
    ppm_material_desc *desc = &c->desc;
    const float strength = c->from->anisotropy;
    const float turns = ppmi_obj_limit(c->from->anisotropy_rotation, -1e3f, 1e3f);
    desc->anisotropy = ppmi_obj_limit(fabsf(strength), 0.0f, 1.0f);
    desc->anisotropy_rotation_rad = two_pi * (turns + (strength < 0.0f ? 0.25f : 0.0f));
    ppmi_obj_use_anisotropy(c);
}

static void convert(ppmi_obj_conversion *c)
{
    if (is_glass(c)) {
        convert_glass(c);
    } else if (is_mirror(c)) {
        convert_mirror(c);
    } else {
        convert_opaque(c);
    }
    convert_emission(c);
    convert_sheen(c);
    convert_clearcoat(c);
    convert_anisotropy(c);
    ppmi_obj_use_relief(c);
    c->reader->tally.reflections += ppmi_obj_has_map(c, PPMI_OBJ_MAP_REFL);
}

/* ---- use ------------------------------------------------------------------------------------- */

static ppm_status add_material(ppmi_obj_reader *r, uint32_t index, const char *name)
{
    ppmi_obj_material *material = (ppmi_obj_material *)r->materials.items + index;
    ppmi_obj_conversion c = {
        .reader = r, .material = material, .from = material->mtl, .name = name};
    ppm_material_desc_init(&c.desc);
    c.desc.name = name;
    convert(&c);
    if (c.status != PPM_STATUS_OK) return c.status;
    material->is_added = true;
    material->needs_tangents = c.desc.normal_texture.image != 0 || c.desc.anisotropy > 0.0f;
    r->tally.glass += c.desc.transmission > 0.0f;
    return ppm_scene_add_material(r->scene, &c.desc, &material->id);
}

/* By its name in the library. */
static ppm_status add_named(ppmi_obj_reader *r, uint32_t index)
{
    char *name = ppmi_string_copy(r->context, ppmi_obj_names_get(&r->library_materials, index));
    if (!name) return ppmi_obj_out_of_memory(r);
    name[ppmi_obj_material_name_length(r, index)] = 0;
    const ppm_status status = add_material(r, index, name);
    ppmi_free(r->context, name);
    return status;
}

ppm_status ppmi_obj_use_material(ppmi_obj_reader *r, uint32_t used, ppm_material_id *out_id,
                                 bool *out_needs_tangents)
{
    uint32_t index;
    ppm_status status = PPM_STATUS_OK;
    const char *name = ppmi_obj_names_get(&r->used_materials, used);
    *out_id = 0;
    *out_needs_tangents = false;
    if (!ppmi_obj_find_material(r, name, &index)) {
        /* once for each name: the table of what is missing says whether it was told */
        const uint32_t told = ppmi_obj_names_count(&r->missing_materials);
        if (!ppmi_obj_names_add(r->context, &r->missing_materials, name, strlen(name), &index)) {
            return ppmi_obj_out_of_memory(r);
        }
        if (index < told) return PPM_STATUS_OK;
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: usemtl '%s': no library has it; a grey default is used", r->path, name);
        return PPM_STATUS_OK;
    }
    const ppmi_obj_material *material = (const ppmi_obj_material *)r->materials.items + index;
    if (!material->is_added) status = add_named(r, index);
    *out_id = material->id;
    *out_needs_tangents = material->needs_tangents;
    return status;
}
