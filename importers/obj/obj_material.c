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

#include "obj/obj_reader.h"

#define HUGE_VALUE 1e18f

/* One material on its way to the scene. */
typedef struct conversion {
    ppmi_obj_reader *reader;
    const ppmi_obj_material *material;
    const ppmi_obj_mtl *from;
    const char *name;
    ppm_material_desc desc;
    ppm_status status; /* the first failure */
} conversion;

static bool has(const conversion *c, uint32_t statement)
{
    return (c->material->given & statement) != 0;
}

static void warn(const conversion *c, const char *text)
{
    const ppmi_obj_reader *r = c->reader;
    ppmi_log(r->context, PPM_LOG_WARNING, "%s: line %zu: material '%s': %s",
             ppmi_obj_names_get(&r->libraries, c->material->library), c->material->line, c->name,
             text);
}

static float limit(float value, float low, float high)
{
    return fminf(fmaxf(value, low), high);
}

static void set_color(float *out, const float *from, float high)
{
    for (int i = 0; i < 3; ++i) {
        out[i] = limit(from[i], 0.0f, high);
    }
}

static void set_white(float *out)
{
    out[0] = out[1] = out[2] = 1.0f;
}

static float largest(const float *color)
{
    return fmaxf(color[0], fmaxf(color[1], color[2]));
}

static bool is_named(const ppmi_obj_map *map)
{
    return map->name[0] != 0;
}

static void use_map(conversion *c, const ppmi_obj_map *map, const char *statement, int32_t role,
                    ppm_texture *out)
{
    if (c->status != PPM_STATUS_OK) return;
    c->status = ppmi_obj_use_map(c->reader, c->material, map, statement, role, out);
}

/* ---- what sort of material ------------------------------------------------------------------- */

static int32_t illumination(const conversion *c)
{
    return has(c, PPMI_OBJ_HAS_ILLUM) ? c->from->illum : 2;
}

static bool is_glass(const conversion *c)
{
    const int32_t illum = illumination(c);
    const bool is_filter = has(c, PPMI_OBJ_HAS_TF) && largest(c->from->transmittance) > 0.0f;
    return illum == 4 || illum == 6 || illum == 7 || illum == 9 ||
           (is_filter && c->from->dissolve < 1.0f);
}

static bool is_mirror(const conversion *c)
{
    const int32_t illum = illumination(c);
    return (illum == 3 || illum == 5) && !has(c, PPMI_OBJ_HAS_PM) &&
           largest(c->from->specular) > 0.0f;
}

/* Pr if there is one; else from Ns, whose highest value, 1000, means a perfect polish. */
static float roughness(const conversion *c, float otherwise)
{
    if (has(c, PPMI_OBJ_HAS_PR)) return limit(c->from->roughness, 0.0f, 1.0f);
    if (!has(c, PPMI_OBJ_HAS_NS)) return otherwise;
    if (c->from->shininess >= 1000.0f) return 0.0f;
    return sqrtf(sqrtf(2.0f / (fmaxf(c->from->shininess, 0.0f) + 2.0f)));
}

/* ---- groups of values ------------------------------------------------------------------------ */

static void convert_glass(conversion *c)
{
    ppm_material_desc *desc = &c->desc;
    const float *filter = c->from->transmittance;
    desc->transmission = 1.0f;
    desc->transmission_kind = PPM_TRANSMISSION_SOLID;
    desc->ior = c->from->ior > 1.0f ? limit(c->from->ior, 1.0f, 1000.0f) : 1.5f;
    desc->roughness = roughness(c, 0.0f);
    set_white(desc->base_color);
    if (has(c, PPMI_OBJ_HAS_TF) && largest(filter) > 0.0f) {
        set_color(desc->base_color, filter, 1.0f);
    }
}

static void convert_mirror(conversion *c)
{
    c->desc.metallic = 1.0f;
    c->desc.roughness = has(c, PPMI_OBJ_HAS_PR) ? roughness(c, 0.0f) : 0.0f;
    set_color(c->desc.base_color, c->from->specular, 1.0f);
    use_map(c, &c->from->map_ks, "map_Ks", PPM_IMAGE_COLOR, &c->desc.base_color_texture);
}

/* Kd of a map without one, or with a black one, which some programs write, is white. */
static void convert_diffuse(conversion *c)
{
    const ppmi_obj_mtl *from = c->from;
    ppm_material_desc *desc = &c->desc;
    const bool is_mapped = is_named(&from->map_kd);
    desc->base_color[0] = desc->base_color[1] = desc->base_color[2] = 0.8f;
    if (has(c, PPMI_OBJ_HAS_KD)) set_color(desc->base_color, from->diffuse, 1.0f);
    if (is_mapped && (!has(c, PPMI_OBJ_HAS_KD) || largest(from->diffuse) <= 0.0f)) {
        set_white(desc->base_color);
    }
    use_map(c, &from->map_kd, "map_Kd", PPM_IMAGE_COLOR, &desc->base_color_texture);
}

/* F0 = 0.04 specular_color specular, F90 = specular (KHR_materials_specular with ior 1.5). */
static void convert_specular(conversion *c)
{
    const ppmi_obj_mtl *from = c->from;
    ppm_material_desc *desc = &c->desc;
    float color[3] = {1.0f, 1.0f, 1.0f};
    const bool is_mapped = is_named(&from->map_ks);
    const bool is_dull = has(c, PPMI_OBJ_HAS_ILLUM) && from->illum < 2;
    if (has(c, PPMI_OBJ_HAS_KS) || !is_mapped) set_color(color, from->specular, 1.0f);
    const float most = is_dull ? 0.0f : largest(color);
    desc->specular = limit(2.0f * most, 0.0f, 1.0f);
    for (int i = 0; i < 3 && most > 0.0f; ++i) {
        desc->specular_color[i] = 2.0f * color[i] / desc->specular;
    }
    if (most > 0.0f) {
        use_map(c, &from->map_ks, "map_Ks", PPM_IMAGE_COLOR, &desc->specular_color_texture);
    }
}

/* The renderer takes roughness and metalness from one image: green and blue. A grey image serves
 * for roughness where nothing is metal, and one image for both is meant so. */
static void convert_pbr_maps(conversion *c)
{
    const ppmi_obj_map *pr = &c->from->map_pr, *pm = &c->from->map_pm;
    ppm_material_desc *desc = &c->desc;
    if (!is_named(pr) && !is_named(pm)) return;
    const bool is_both = strcmp(pr->name, pm->name) == 0;
    if (!is_both && (is_named(pm) || desc->metallic > 0.0f)) {
        warn(c, "map_Pr and map_Pm have no effect: only one image for both, or map_Pr without "
                "metal, can be used");
        return;
    }
    if (!has(c, PPMI_OBJ_HAS_PR)) desc->roughness = 1.0f;
    if (is_both && !has(c, PPMI_OBJ_HAS_PM)) desc->metallic = 1.0f;
    use_map(c, pr, "map_Pr", PPM_IMAGE_DATA, &desc->metallic_roughness_texture);
}

static void convert_opaque(conversion *c)
{
    convert_diffuse(c);
    convert_specular(c);
    c->desc.roughness = roughness(c, 0.5f);
    if (has(c, PPMI_OBJ_HAS_PM)) c->desc.metallic = limit(c->from->metallic, 0.0f, 1.0f);
    convert_pbr_maps(c);
}

/* An alpha of 0, which would hide the surface, is nearly always a program that means "opaque". */
static void convert_alpha(conversion *c)
{
    const ppmi_obj_mtl *from = c->from;
    float alpha = limit(from->dissolve, 0.0f, 1.0f);
    if (alpha <= 0.0f) {
        warn(c, "d 0 or Tr 1 would hide it: it is taken as opaque");
        alpha = 1.0f;
    }
    c->desc.base_color[3] = alpha;
    if (alpha < 1.0f) c->desc.alpha_mode = PPM_ALPHA_BLEND;
    if (!is_named(&from->map_d)) return;
    if (strcmp(from->map_d.name, from->map_kd.name) == 0) {
        c->desc.alpha_mode = PPM_ALPHA_BLEND;
    } else {
        warn(c, "map_d has no effect: only the alpha of the image of map_Kd can be used");
    }
}

static void convert_emission(conversion *c)
{
    const ppmi_obj_mtl *from = c->from;
    set_color(c->desc.emission, from->emission, HUGE_VALUE);
    if (!is_named(&from->map_ke)) return;
    if (largest(from->emission) <= 0.0f) set_white(c->desc.emission);
    use_map(c, &from->map_ke, "map_Ke", PPM_IMAGE_COLOR, &c->desc.emission_texture);
    if (c->desc.emission_texture.image == 0)
        set_color(c->desc.emission, from->emission, HUGE_VALUE);
}

static void convert(conversion *c)
{
    if (is_glass(c)) {
        convert_glass(c);
    } else if (is_mirror(c)) {
        convert_mirror(c);
    } else {
        convert_opaque(c);
        convert_alpha(c);
    }
    convert_emission(c);
    c->desc.normal_scale = limit(c->from->norm.bump, -HUGE_VALUE, HUGE_VALUE);
    use_map(c, &c->from->norm, "norm", PPM_IMAGE_DATA, &c->desc.normal_texture);
}

/* ---- use ------------------------------------------------------------------------------------- */

static ppm_status add_material(ppmi_obj_reader *r, uint32_t index, const char *name)
{
    ppmi_obj_material *material = (ppmi_obj_material *)r->materials.items + index;
    conversion c = {.reader = r, .material = material, .from = material->mtl, .name = name};
    ppm_material_desc_init(&c.desc);
    c.desc.name = name;
    convert(&c);
    if (c.status != PPM_STATUS_OK) return c.status;
    material->is_added = true;
    material->needs_tangents = c.desc.normal_texture.image != 0 || c.desc.anisotropy > 0.0f;
    r->tally.glass += c.desc.transmission > 0.0f;
    return ppm_scene_add_material(r->scene, &c.desc, &material->id);
}

ppm_status ppmi_obj_use_material(ppmi_obj_reader *r, uint32_t used, ppm_material_id *out_id,
                                 bool *out_needs_tangents)
{
    uint32_t index;
    ppm_status status = PPM_STATUS_OK;
    const char *name = ppmi_obj_names_get(&r->used_materials, used);
    *out_id = 0;
    *out_needs_tangents = false;
    if (!ppmi_obj_names_find(&r->library_materials, name, &index)) {
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
    if (!material->is_added) status = add_material(r, index, name);
    *out_id = material->id;
    *out_needs_tangents = material->needs_tangents;
    return status;
}
