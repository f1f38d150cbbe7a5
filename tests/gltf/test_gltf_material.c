/* importers/gltf/gltf_material.c */
#include <stdio.h>

#include "material_fixture.h"

static void the_defaults_are_those_of_the_specification(void **state)
{
    const ppm_material_desc *m = import_material(*state, "x", "");
    assert_values(m->base_color, 4, (const float[]){1, 1, 1, 1});
    assert_values(&m->metallic, 1, (const float[]){1});
    assert_values(&m->roughness, 1, (const float[]){1});
    assert_values(m->emission, 3, (const float[]){0, 0, 0});
    assert_values(&m->ior, 1, (const float[]){1.5f});
    assert_values(&m->specular, 1, (const float[]){1});
    assert_values(m->specular_color, 3, (const float[]){1, 1, 1});
    assert_values(&m->transmission, 1, (const float[]){0});
    assert_values(&m->attenuation_distance_m, 1, (const float[]){0});
    assert_values(&m->alpha_cutoff, 1, (const float[]){0.5f});
    assert_int_equal(m->alpha_mode, PPM_ALPHA_OPAQUE);
    assert_int_equal(m->double_sided, 0);
    assert_int_equal(m->base_color_texture.image, 0);
}

static void primitives_without_a_material_are_white_and_rough(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_OK);
    assert_int_equal(f->scene->material_count, 1);
    assert_values(f->scene->materials[0].desc.base_color, 4, (const float[]){1, 1, 1, 1});
    assert_values(&f->scene->materials[0].desc.metallic, 1, (const float[]){1});
    assert_values(&f->scene->materials[0].desc.roughness, 1, (const float[]){1});
}

static void core_values_are_read(void **state)
{
    const ppm_material_desc *m = import_material(
        *state, "x",
        "'name':'paint','pbrMetallicRoughness':{'baseColorFactor':[0.1,0.2,0.3,0.4],"
        "'metallicFactor':0,'roughnessFactor':0.25},'emissiveFactor':[0.5,1,0],"
        "'alphaMode':'MASK','alphaCutoff':0.75,'doubleSided':true,"
        "'normalTexture':{'index':0,'scale':2},"
        "'extensions':{'KHR_materials_emissive_strength':{'emissiveStrength':8}}");
    assert_values(m->base_color, 4, (const float[]){0.1f, 0.2f, 0.3f, 0.4f});
    assert_values(&m->metallic, 1, (const float[]){0});
    assert_values(&m->roughness, 1, (const float[]){0.25f});
    assert_values(m->emission, 3, (const float[]){4, 8, 0});
    assert_int_equal(m->alpha_mode, PPM_ALPHA_MASK);
    assert_values(&m->alpha_cutoff, 1, (const float[]){0.75f});
    assert_int_not_equal(m->double_sided, 0);
    assert_values(&m->normal_scale, 1, (const float[]){2});
    const gltf_fixture *f = *state;
    assert_string_equal(f->scene->materials[0].name, "paint");
}

/* Infinity, which does not absorb, is what leaving it out means; 0 is none that is allowed. */
static void a_distance_of_attenuation_that_is_not_above_0_is_told(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *distance;
        float distance_m;
        bool is_told;
    } cases[] = {{"", 0.0f, false},
                 {",'attenuationDistance':0", 0.0f, true},
                 {",'attenuationDistance':-1", 0.0f, true},
                 {",'attenuationDistance':0.25", 0.25f, false}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[256];
        snprintf(text, sizeof text,
                 "'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},"
                 "'KHR_materials_volume':{'thicknessFactor':1,'attenuationColor':[1,0,0]%s}}",
                 cases[i].distance);
        const ppm_material_desc *m = import_material(f, "x", text);
        assert_values(&m->attenuation_distance_m, 1, &cases[i].distance_m);
        assert_int_equal(
            gltf_logged(f, 'W', "materials[0]: KHR_materials_volume.attenuationDistance is"),
            cases[i].is_told);
        gltf_reset(f);
    }
}

static void dielectric_extensions_are_read(void **state)
{
    const ppm_material_desc *m = import_material(
        *state, "x",
        "'extensions':{'KHR_materials_ior':{'ior':1.33},'KHR_materials_specular':{"
        "'specularFactor':0.5,'specularColorFactor':[2,1,0],'specularTexture':{'index':0},"
        "'specularColorTexture':{'index':0,'texCoord':1}},"
        "'KHR_materials_transmission':{'transmissionFactor':0.75},'KHR_materials_volume':{"
        "'thicknessFactor':1,'attenuationDistance':0.5,'attenuationColor':[1,0.5,0.25]}}");
    assert_values(&m->ior, 1, (const float[]){1.33f});
    assert_values(&m->specular, 1, (const float[]){0.5f});
    assert_values(m->specular_color, 3, (const float[]){2, 1, 0});
    assert_values(&m->transmission, 1, (const float[]){0.75f});
    assert_values(&m->attenuation_distance_m, 1, (const float[]){0.5f});
    assert_values(m->attenuation_color, 3, (const float[]){1, 0.5f, 0.25f});
    assert_int_not_equal(m->specular_texture.image, 0);
    assert_int_not_equal(m->specular_color_texture.image, 0);
    /* alpha is a number in either role, so the image is kept once */
    assert_int_equal(m->specular_texture.image, m->specular_color_texture.image);
    assert_int_equal(m->specular_color_texture.uv_set, 1);
}

static void an_ior_of_0_keeps_its_meaning(void **state)
{
    const ppm_material_desc *m =
        import_material(*state, "x", "'extensions':{'KHR_materials_ior':{'ior':0}}");
    assert_values(&m->ior, 1, (const float[]){0});
}

static void values_out_of_range_are_brought_into_it_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m = import_material(
        f, "x",
        "'pbrMetallicRoughness':{'baseColorFactor':[2,-1,0.5,1],'metallicFactor':7},"
        "'emissiveFactor':[-1,0,0],'extensions':{'KHR_materials_ior':{'ior':0.5}}");
    assert_values(m->base_color, 4, (const float[]){1, 0, 0.5f, 1});
    assert_values(&m->metallic, 1, (const float[]){1});
    assert_values(m->emission, 3, (const float[]){0, 0, 0});
    assert_values(&m->ior, 1, (const float[]){1});
    assert_gltf_logged(f, 'W', "materials[0]: baseColorFactor is brought into 0 .. 1");
    assert_gltf_logged(f, 'W', "metallicFactor");
    assert_gltf_logged(f, 'W', "emissiveFactor");
    assert_gltf_logged(f, 'W', "ior");
}

static void an_unlit_material_shines_with_its_base_colour(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x",
                        "'pbrMetallicRoughness':{'baseColorFactor':[0.1,0.2,0.3,0.4],"
                        "'baseColorTexture':{'index':0}},'emissiveFactor':[1,1,1],"
                        "'extensions':{'KHR_materials_unlit':{}}");
    assert_values(m->emission, 3, (const float[]){0.1f, 0.2f, 0.3f});
    assert_values(m->base_color, 4, (const float[]){0, 0, 0, 0.4f});
    assert_values(&m->metallic, 1, (const float[]){0});
    assert_values(&m->specular, 1, (const float[]){0});
    assert_int_equal(m->emission_texture.image, m->base_color_texture.image);
    assert_int_not_equal(m->emission_takes_vertex_color, 0);
    assert_gltf_logged(f, 'I', "KHR_materials_unlit");
}

/* ---- glass ----------------------------------------------------------------------------------- */

#define GLASS "'extensions':{'KHR_materials_transmission':{'transmissionFactor':1}"
static const char blender[] = "Khronos glTF Blender I/O v4.0.44";

static void check_glass(gltf_fixture *f, const char *generator, int32_t policy, double thickness,
                        int32_t expected)
{
    char material[200];
    f->options.transmission = policy;
    snprintf(material, sizeof material, GLASS ",'KHR_materials_volume':{'thicknessFactor':%g}}",
             thickness);
    assert_int_equal(import_material(f, generator, material)->transmission_kind, expected);
    assert_gltf_logged(f, 'I', expected == PPM_TRANSMISSION_SOLID ? "1 solid" : "1 thin");
    assert_gltf_logged(f, 'I', "--transmission");
}

static void thickness_generator_and_option_decide_about_glass(void **state)
{
    gltf_fixture *f = *state;
    check_glass(f, "x", PPM_TRANSMISSION_POLICY_AUTO, 0.0, PPM_TRANSMISSION_THIN);
    check_glass(f, "x", PPM_TRANSMISSION_POLICY_AUTO, 0.1, PPM_TRANSMISSION_SOLID);
    check_glass(f, blender, PPM_TRANSMISSION_POLICY_AUTO, 0.0, PPM_TRANSMISSION_SOLID);
    check_glass(f, "x", PPM_TRANSMISSION_POLICY_SOLID, 0.0, PPM_TRANSMISSION_SOLID);
    check_glass(f, "x", PPM_TRANSMISSION_POLICY_THIN, 0.1, PPM_TRANSMISSION_THIN);
    check_glass(f, blender, PPM_TRANSMISSION_POLICY_THIN, 0.1, PPM_TRANSMISSION_THIN);
}

static void glass_without_a_volume_is_thin(void **state)
{
    assert_int_equal(import_material(*state, "x", GLASS "}")->transmission_kind,
                     PPM_TRANSMISSION_THIN);
}

static void dispersion_is_read_as_a_supported_extension(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x", GLASS ",'KHR_materials_dispersion':{'dispersion':0.75}}");
    assert_values(&m->dispersion, 1, (const float[]){0.75f});
    assert_values(&import_material(f, "x", GLASS "}")->dispersion, 1, (const float[]){0});
    gltf_reset(f);
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'extensionsRequired':["
                       "'KHR_materials_dispersion'],'extensionsUsed':["
                       "'KHR_materials_dispersion'],'nodes':[{'mesh':0}]," GLTF_TRIANGLE "}"),
        PPM_STATUS_OK);
    assert_false(gltf_logged(f, 'W', "KHR_materials_dispersion"));
}

static void bad_dispersion_is_told_and_ignored_or_brought_into_range(void **state)
{
    static const struct {
        const char *value, *warning;
        float expected;
    } cases[] = {
        {"'strong'", "materials[0].extensions.KHR_materials_dispersion.dispersion: expected a", 0},
        {"1e300", "materials[0].extensions.KHR_materials_dispersion.dispersion: the number is", 0},
        {"1e30", "materials[0]: KHR_materials_dispersion.dispersion is brought into 0 .. 1000",
         1000},
        {"-1", "materials[0]: KHR_materials_dispersion.dispersion is brought into 0 .. 1000", 0},
    };
    gltf_fixture *f = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char material[200];
        snprintf(material, sizeof material, GLASS ",'KHR_materials_dispersion':{'dispersion':%s}}",
                 cases[i].value);
        const ppm_material_desc *m = import_material(f, "x", material);
        assert_values(&m->dispersion, 1, &cases[i].expected);
        assert_gltf_logged(f, 'W', cases[i].warning);
    }
}

static void the_priority_of_overlapping_solids_is_read_from_extras(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x", "'extras':{'author':{'name':'x'},'ppm_priority':7}");
    assert_int_equal(m->nested_priority, 7);
    m = import_material(f, "x", "'extras':{'ppm_priority':-2147483648}");
    assert_int_equal(m->nested_priority, INT32_MIN);
    m = import_material(f, "x", "'extras':{'ppm_priority':2147483647}");
    assert_int_equal(m->nested_priority, INT32_MAX);
    assert_int_equal(import_material(f, "x", "'extras':{}")->nested_priority, 0);
    assert_false(gltf_logged(f, 'W', ""));
}

static void a_bad_priority_is_told_and_ignored(void **state)
{
    static const char *const cases[][2] = {
        {"'high'", "materials[0].extras.ppm_priority: expected a number"},
        {"[1]", "materials[0].extras.ppm_priority: expected a number"},
        {"1e300", "materials[0].extras.ppm_priority: the number is too large"},
        {"2147483648", "materials[0]: extras.ppm_priority is 2.14748e+09"},
        {"-1e30", "materials[0]: extras.ppm_priority is -1e+30"},
        {"1.5", "materials[0]: extras.ppm_priority is 1.5, expected an integer"},
    };
    gltf_fixture *f = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char material[100];
        snprintf(material, sizeof material, "'extras':{'ppm_priority':%s}", cases[i][0]);
        assert_int_equal(import_material(f, "x", material)->nested_priority, 0);
        assert_gltf_logged(f, 'W', cases[i][1]);
    }
}

/* The specification lets extras be any value, so only ours is looked at. */
static void extras_of_another_kind_are_fine(void **state)
{
    static const char *const cases[] = {"'text'", "3", "[1,'two',{}]", "true", "null"};
    gltf_fixture *f = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char material[100];
        snprintf(material, sizeof material, "'extras':%s", cases[i]);
        assert_int_equal(import_material(f, "x", material)->nested_priority, 0);
        assert_false(gltf_logged(f, 'W', ""));
    }
}

static void glass_is_not_mentioned_without_any(void **state)
{
    gltf_fixture *f = *state;
    import_material(f, "x", "'extensions':{'KHR_materials_volume':{'thicknessFactor':1}}");
    assert_false(gltf_logged(f, 'I', "--transmission"));
}

/* ---- textures -------------------------------------------------------------------------------- */

static void samplers_set_wrap_and_filter(void **state)
{
    const ppm_material_desc *m =
        import_material(*state, "x", "'emissiveFactor':[1,1,1],'emissiveTexture':{'index':0}");
    assert_int_not_equal(m->emission_texture.image, 0);
    assert_int_equal(m->emission_texture.wrap_u, PPM_WRAP_CLAMP);
    assert_int_equal(m->emission_texture.wrap_v, PPM_WRAP_MIRROR);
    assert_int_equal(m->emission_texture.filter, PPM_FILTER_NEAREST);
    assert_int_equal(m->emission_texture.has_transform, 0);
}

/* The extension's example: the lower left quarter, turned. */
static void texture_transforms_turn_counter_clockwise(void **state)
{
    const ppm_material_desc *m = import_material(
        *state, "x",
        "'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'texCoord':2,'extensions':{"
        "'KHR_texture_transform':{'offset':[0,1],'rotation':1.5707963267948966,"
        "'scale':[0.5,0.25],'texCoord':1}}}}");
    const ppm_texture *t = &m->base_color_texture;
    assert_int_not_equal(t->has_transform, 0);
    assert_int_equal(t->uv_set, 1);
    assert_values(t->uv_transform, 6, (const float[]){0, 0.25f, 0, -0.5f, 0, 1});
}

static void a_texture_coordinate_set_that_is_too_high_is_left_out(void **state)
{
    gltf_fixture *f = *state;
    const ppm_material_desc *m =
        import_material(f, "x", "'normalTexture':{'index':0,'texCoord':8}");
    assert_int_equal(m->normal_texture.image, 0);
    assert_gltf_logged(f, 'W', "TEXCOORD_8");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_distance_of_attenuation_that_is_not_above_0_is_told),
        TEST(the_defaults_are_those_of_the_specification),
        TEST(primitives_without_a_material_are_white_and_rough),
        TEST(core_values_are_read),
        TEST(dielectric_extensions_are_read),
        TEST(an_ior_of_0_keeps_its_meaning),
        TEST(values_out_of_range_are_brought_into_it_with_a_warning),
        TEST(an_unlit_material_shines_with_its_base_colour),
        TEST(thickness_generator_and_option_decide_about_glass),
        TEST(glass_without_a_volume_is_thin),
        TEST(glass_is_not_mentioned_without_any),
        TEST(dispersion_is_read_as_a_supported_extension),
        TEST(bad_dispersion_is_told_and_ignored_or_brought_into_range),
        TEST(the_priority_of_overlapping_solids_is_read_from_extras),
        TEST(a_bad_priority_is_told_and_ignored),
        TEST(extras_of_another_kind_are_fine),
        TEST(samplers_set_wrap_and_filter),
        TEST(texture_transforms_turn_counter_clockwise),
        TEST(a_texture_coordinate_set_that_is_too_high_is_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
