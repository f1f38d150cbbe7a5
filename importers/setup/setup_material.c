/* Materials: each field of ppm_material_desc by its name, written over what the importer made. */
#include <string.h>

#include "setup/setup_file.h"

typedef struct material_words {
    ppmi_setup_match match;
    ppm_material_desc desc;
} material_words;

/* ---- keys ------------------------------------------------------------------------------------ */

static ppm_status read_color_image(const ppmi_setup_value *value, const ppmi_setup_key *key,
                                   void *target)
{
    return ppmi_setup_read_texture(value, PPM_IMAGE_COLOR,
                                   (ppm_texture *)((char *)target + key->field));
}

static ppm_status read_data_image(const ppmi_setup_value *value, const ppmi_setup_key *key,
                                  void *target)
{
    return ppmi_setup_read_texture(value, PPM_IMAGE_DATA,
                                   (ppm_texture *)((char *)target + key->field));
}

/* RGB leaves alpha as it is. */
static ppm_status read_base_color(const ppmi_setup_value *value, const ppmi_setup_key *key,
                                  void *target)
{
    ppmi_setup_key numbers = *key;
    const bool has_alpha = json_array_size(value->json) == 4;
    numbers.kind = has_alpha ? PPMI_SETUP_FLOATS : PPMI_SETUP_COLOR;
    numbers.count = 4;
    return ppmi_setup_read_value(value, &numbers, target);
}

/* It has been read already, before all other keys. */
static ppm_status skip(const ppmi_setup_value *value, const ppmi_setup_key *key, void *target)
{
    (void)value, (void)key, (void)target;
    return PPM_STATUS_OK;
}

static const ppmi_setup_word alpha_modes[] = {
    {"opaque", PPM_ALPHA_OPAQUE}, {"mask", PPM_ALPHA_MASK}, {"blend", PPM_ALPHA_BLEND}, {NULL, 0}};
static const ppmi_setup_word transmission_kinds[] = {
    {"solid", PPM_TRANSMISSION_SOLID}, {"thin", PPM_TRANSMISSION_THIN}, {NULL, 0}};

#define FIELD(member) .field = offsetof(material_words, desc.member)
#define REAL(member, least, most)                                                                  \
    {                                                                                              \
#member, PPMI_SETUP_FLOAT, FIELD(member), least, most                                      \
    }
#define COLOR(member, most)                                                                        \
    {                                                                                              \
#member, PPMI_SETUP_COLOR, FIELD(member), 0, most                                          \
    }
#define IMAGE(member, reader)                                                                      \
    {                                                                                              \
#member, PPMI_SETUP_OWN, FIELD(member), .read = reader                                     \
    }
static const ppmi_setup_key keys[] = {
    {"match", PPMI_SETUP_OWN, .field = offsetof(material_words, match),
     .read = ppmi_setup_read_match},
    {"preset", PPMI_SETUP_OWN, .read = skip},
    {"base_color", PPMI_SETUP_OWN, FIELD(base_color), 0, 1, .read = read_base_color},
    IMAGE(base_color_texture, read_color_image),
    REAL(metallic, 0, 1),
    REAL(roughness, 0, 1),
    IMAGE(metallic_roughness_texture, read_data_image),
    IMAGE(normal_texture, read_data_image),
    REAL(normal_scale, -1e6, 1e6),
    COLOR(emission, 1e15),
    IMAGE(emission_texture, read_color_image),
    REAL(ior, 0, 1e3),
    REAL(specular, 0, 1),
    IMAGE(specular_texture, read_data_image),
    COLOR(specular_color, 1e6),
    IMAGE(specular_color_texture, read_color_image),
    REAL(transmission, 0, 1),
    IMAGE(transmission_texture, read_data_image),
    {"transmission_kind", PPMI_SETUP_WORD, FIELD(transmission_kind), .words = transmission_kinds},
    COLOR(attenuation_color, 1),
    REAL(attenuation_distance_m, 0, 1e15),
    REAL(dispersion, 0, 1e3),
    {"nested_priority", PPMI_SETUP_INTEGER, FIELD(nested_priority), -1e6, 1e6},
    {"alpha_mode", PPMI_SETUP_WORD, FIELD(alpha_mode), .words = alpha_modes},
    REAL(alpha_cutoff, 0, 1e6),
    {"double_sided", PPMI_SETUP_FLAG, FIELD(double_sided)},
    REAL(clearcoat, 0, 1),
    IMAGE(clearcoat_texture, read_data_image),
    REAL(clearcoat_roughness, 0, 1),
    IMAGE(clearcoat_roughness_texture, read_data_image),
    IMAGE(clearcoat_normal_texture, read_data_image),
    REAL(clearcoat_normal_scale, -1e6, 1e6),
    COLOR(sheen_color, 1),
    IMAGE(sheen_color_texture, read_color_image),
    REAL(sheen_roughness, 0, 1),
    IMAGE(sheen_roughness_texture, read_data_image),
    REAL(iridescence, 0, 1),
    IMAGE(iridescence_texture, read_data_image),
    REAL(iridescence_ior, 1, 1e3),
    REAL(iridescence_thickness_min_nm, 0, 1e9),
    REAL(iridescence_thickness_max_nm, 0, 1e9),
    IMAGE(iridescence_thickness_texture, read_data_image),
    REAL(anisotropy, 0, 1),
    REAL(anisotropy_rotation_rad, -1e6, 1e6),
    IMAGE(anisotropy_texture, read_data_image),
    REAL(diffuse_transmission, 0, 1),
    IMAGE(diffuse_transmission_texture, read_data_image),
    COLOR(diffuse_transmission_color, 1),
    IMAGE(diffuse_transmission_color_texture, read_color_image),
    COLOR(multiscatter_color, 1),
    REAL(scatter_anisotropy_g, -0.999999, 0.999999),
    REAL(retroreflection, 0, 1),
    IMAGE(retroreflection_texture, read_data_image),
    {"roughness_is_glossiness", PPMI_SETUP_FLAG, FIELD(roughness_is_glossiness)},
    {"emission_takes_vertex_color", PPMI_SETUP_FLAG, FIELD(emission_takes_vertex_color)},
    REAL(diffuse_roughness, 0, 1),
    IMAGE(diffuse_roughness_texture, read_data_image),
    {"specular_is_edge_color", PPMI_SETUP_FLAG, FIELD(specular_is_edge_color)},
    REAL(coat_ior, 0, 1e3),
    COLOR(coat_color, 1),
    IMAGE(coat_color_texture, read_color_image),
    REAL(coat_darkening, 0, 1),
    REAL(coat_anisotropy, 0, 1),
    REAL(coat_anisotropy_rotation_rad, -1e6, 1e6),
    IMAGE(coat_anisotropy_texture, read_data_image),
    {"emission_is_above_coat", PPMI_SETUP_FLAG, FIELD(emission_is_above_coat)},
    REAL(fuzz, 0, 1),
    IMAGE(fuzz_texture, read_data_image),
};
#undef FIELD
#undef REAL
#undef COLOR
#undef IMAGE
enum { KEY_COUNT = sizeof keys / sizeof keys[0] };

/* ---- one rule -------------------------------------------------------------------------------- */

/* The preset comes first, wherever it stands among the keys. */
static ppm_status read_rule(const ppmi_setup_value *rule, material_words *words)
{
    ppm_status status = PPM_STATUS_OK;
    const json_t *preset = json_object_get(rule->json, "preset");
    if (preset) {
        const ppmi_setup_value place = ppmi_setup_member(rule, "preset", preset);
        status = ppmi_setup_use_preset(&place, &words->desc);
    }
    if (status == PPM_STATUS_OK) {
        status = ppmi_setup_read_object(rule, keys, KEY_COUNT, words, NULL);
    }
    if (status == PPM_STATUS_OK && !words->match.value.json) {
        status =
            ppmi_setup_fail(rule, "no \"match\": expected the name of materials, or a pattern");
    }
    return status;
}

const char *ppmi_setup_material_name(const ppm_scene *scene, uint32_t id)
{
    ppm_material_desc desc = {.size = sizeof desc};
    return ppm_scene_get_material(scene, id, &desc) == PPM_STATUS_OK ? desc.name : NULL;
}

static ppm_status override(const ppmi_setup_value *rule, ppm_material_id id)
{
    material_words words = {.desc = {.size = sizeof words.desc}};
    ppm_scene *scene = rule->setup->scene;
    ppm_status status = ppm_scene_get_material(scene, id, &words.desc);
    if (status == PPM_STATUS_OK) status = read_rule(rule, &words);
    if (status == PPM_STATUS_OK) status = ppm_scene_set_material(scene, id, &words.desc);
    if (status == PPM_STATUS_INVALID_ARGUMENT) {
        return ppmi_setup_fail(rule, "see the message above");
    }
    return status;
}

ppm_status ppmi_setup_material_section(const ppmi_setup_value *rule)
{
    material_words words = {0};
    ppm_scene *scene = rule->setup->scene;
    bool is_used = false;
    ppm_material_desc_init(&words.desc);
    ppm_status status = read_rule(rule, &words);
    if (status != PPM_STATUS_OK || !scene) return status;
    const uint32_t count = ppm_scene_material_count(scene);
    for (ppm_material_id id = 1; id <= count && status == PPM_STATUS_OK; id++) {
        if (!ppmi_setup_fits(&words.match, ppmi_setup_material_name(scene, id))) continue;
        status = override(rule, id);
        is_used = true;
    }
    if (status != PPM_STATUS_OK || is_used) return status;
    return ppmi_setup_warn_no_match(&words.match, "material", ppmi_setup_material_name, count);
}

ppm_status ppmi_setup_find_material(const ppmi_setup_value *value, const char *name,
                                    ppm_material_id *out_id)
{
    ppm_scene *scene = value->setup->scene;
    const uint32_t count = ppm_scene_material_count(scene);
    for (ppm_material_id id = 1; id <= count; id++) {
        if (strcmp(ppmi_setup_material_name(scene, id), name) != 0) continue;
        *out_id = id;
        return PPM_STATUS_OK;
    }
    return ppmi_setup_no_such(value, "material", ppmi_setup_material_name, count);
}

/* ---- animated materials ---------------------------------------------------------------------- */

static bool is_overridden(ppm_setup *setup, const char *name)
{
    const json_t *rules = json_object_get(setup->root, "materials");
    for (size_t i = 0; i < json_array_size(rules); i++) {
        const json_t *match = json_object_get(json_array_get(rules, i), "match");
        const ppmi_setup_match pattern = {.value = {.setup = setup, .json = match}};
        if (ppmi_setup_fits(&pattern, name)) return true;
    }
    return false;
}

static ppm_material_desc current(const ppm_scene *scene, ppm_material_id id)
{
    ppm_material_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.size = sizeof desc;
    ppm_scene_get_material(scene, id, &desc);
    return desc;
}

ppm_status ppmi_setup_remember_materials(ppm_setup *setup)
{
    const uint32_t count = ppm_scene_material_count(setup->scene);
    ppmi_free(setup->context, setup->overridden);
    ppmi_free(setup->context, setup->is_told);
    setup->overridden = NULL;
    setup->is_told = NULL;
    setup->overridden_count = 0;
    if (count == 0) return PPM_STATUS_OK;
    setup->overridden = ppmi_alloc_zeroed(setup->context, count, sizeof *setup->overridden);
    setup->is_told = ppmi_alloc_zeroed(setup->context, count, sizeof *setup->is_told);
    if (!setup->overridden || !setup->is_told) return ppmi_setup_out_of_memory(setup);
    setup->overridden_count = count;
    for (ppm_material_id id = 1; id <= count; id++) {
        if (is_overridden(setup, ppmi_setup_material_name(setup->scene, id))) {
            setup->overridden[id - 1] = current(setup->scene, id);
        }
    }
    return PPM_STATUS_OK;
}

/* The animation has set all fields of a material that is not as it was left; the rules then say
 * again what they name, in their order. */
static ppm_status restore(ppm_setup *setup, ppm_material_id id)
{
    const ppmi_setup_value root = {.setup = setup, .json = setup->root};
    const json_t *rules = json_object_get(setup->root, "materials");
    const ppmi_setup_value list = ppmi_setup_member(&root, "materials", rules);
    const char *name = ppmi_setup_material_name(setup->scene, id);
    ppm_status status = PPM_STATUS_OK;
    if (!setup->is_told[id - 1]) {
        setup->is_told[id - 1] = true;
        ppmi_log(setup->context, PPM_LOG_INFO,
                 "%s: material '%s' is animated: what the setup names of it stays as it says",
                 setup->path, name);
    }
    for (size_t i = 0; i < json_array_size(rules) && status == PPM_STATUS_OK; i++) {
        const ppmi_setup_value rule = ppmi_setup_element(&list, i);
        const json_t *match = json_object_get(rule.json, "match");
        const ppmi_setup_match pattern = {.value = {.setup = setup, .json = match}};
        if (ppmi_setup_fits(&pattern, name)) status = override(&rule, id);
    }
    setup->overridden[id - 1] = current(setup->scene, id);
    return status;
}

ppm_status ppmi_setup_restore_materials(ppm_setup *setup)
{
    ppm_status status = PPM_STATUS_OK;
    for (ppm_material_id id = 1; id <= setup->overridden_count; id++) {
        if (setup->overridden[id - 1].size == 0) continue;
        const ppm_material_desc now = current(setup->scene, id);
        if (memcmp(&now, &setup->overridden[id - 1], sizeof now) == 0) continue;
        status = restore(setup, id);
        if (status != PPM_STATUS_OK) break;
    }
    return status;
}
