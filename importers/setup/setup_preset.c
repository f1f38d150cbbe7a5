/* Materials by the name of their substance, with published numbers.
 *
 * Dielectrics: refractive index n_d at 587.6 nm. Glasses by Schott's data sheets (N-BK7, SF11);
 * fused silica: Malitson 1965; water, 20 C: IAPWS R9-97; ice: Warren and Brandt 2008; acrylic
 * (PMMA) and polycarbonate: Sultanova, Kasarova, Nikolov 2009; diamond: Peter 1923; sapphire
 * (ordinary ray): Malitson and Dodge 1972.
 * Metals: linear Rec.709 reflectance at normal incidence, Hoffman 2013, "Background: Physics and
 * Math of Shading" (SIGGRAPH course notes), table 1. */
#include <string.h>

#include "base/suggest.h"
#include "setup/setup_file.h"

static const struct {
    const char *name;
    float ior;      /* 0: a metal */
    float color[3]; /* of a metal */
} presets[] = {
    {"glass", 1.5168f, {0}},
    {"flint glass", 1.7847f, {0}},
    {"fused silica", 1.4585f, {0}},
    {"water", 1.333f, {0}},
    {"ice", 1.31f, {0}},
    {"acrylic", 1.4906f, {0}},
    {"polycarbonate", 1.5848f, {0}},
    {"diamond", 2.4175f, {0}},
    {"sapphire", 1.7682f, {0}},
    {"gold", 0.0f, {1.0f, 0.71f, 0.29f}},
    {"silver", 0.0f, {0.95f, 0.93f, 0.88f}},
    {"copper", 0.0f, {0.95f, 0.64f, 0.54f}},
    {"aluminium", 0.0f, {0.91f, 0.92f, 0.92f}},
    {"iron", 0.0f, {0.56f, 0.57f, 0.58f}},
};
enum { PRESET_COUNT = sizeof presets / sizeof presets[0] };

static ppm_status no_such_preset(const ppmi_setup_value *value, const char *text)
{
    const char *names[PRESET_COUNT];
    for (size_t i = 0; i < PRESET_COUNT; i++)
        names[i] = presets[i].name;
    const char *nearest = ppmi_suggest(text, names, PRESET_COUNT);
    return ppmi_setup_fail(value, "there is no preset \"%s\"%s%s%s (docs/setup.md lists them)",
                           text, nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                           nearest ? "\"?" : "");
}

ppm_status ppmi_setup_use_preset(const ppmi_setup_value *value, ppm_material_desc *desc)
{
    const char *text = json_string_value(value->json);
    size_t i = 0;
    if (!text) return ppmi_setup_refuse(value, "the name of a preset, like \"glass\"");
    while (i < PRESET_COUNT && strcmp(presets[i].name, text) != 0)
        i++;
    if (i == PRESET_COUNT) return no_such_preset(value, text);
    const bool is_metal = presets[i].ior == 0.0f;
    const ppm_material_desc before = *desc;
    ppm_material_desc_init(desc);
    desc->name = before.name;
    desc->normal_texture = before.normal_texture;
    desc->normal_scale = before.normal_scale;
    desc->double_sided = before.double_sided;
    desc->nested_priority = before.nested_priority;
    desc->roughness = 0.0f;
    desc->metallic = is_metal ? 1.0f : 0.0f;
    desc->transmission = is_metal ? 0.0f : 1.0f;
    if (is_metal) {
        memcpy(desc->base_color, presets[i].color, sizeof presets[i].color);
    } else {
        desc->ior = presets[i].ior;
    }
    return PPM_STATUS_OK;
}
