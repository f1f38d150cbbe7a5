/* Materials of a setup file: what is named changes, and nothing else. */
#include <stdio.h>
#include <string.h>

#include "setup/setup_fixture.h"
#include "support/near.h"

#define RULE(words) "{ \"materials\": [ { " words " } ] }"

static ppm_material_desc material(const ppm_scene *scene, ppm_material_id id)
{
    ppm_material_desc desc;
    memset(&desc, 0, sizeof desc);
    desc.size = sizeof desc;
    assert_int_equal(ppm_scene_get_material(scene, id, &desc), PPM_STATUS_OK);
    return desc;
}

static void what_is_out_of_range_is_refused(void **state)
{
    setup_fixture *f = *state;
    assert_refused(f, RULE("\"roughness\": 1"), "materials[0]: no \"match\"");
    assert_refused(f, RULE("\"match\": []"), "materials[0].match: [] found");
    assert_refused(f, RULE("\"match\": [\"a\", 1]"), "materials[0].match: [\"a\",1] found");
    assert_refused(f, RULE("\"match\": \"a\", \"metallic\": 2"),
                   "materials[0].metallic: 2 found, expected a number from 0 to 1");
    assert_refused(f, RULE("\"match\": \"a\", \"base_color\": [1, 1]"), "base_color: [1,1] found");
    assert_refused(f, RULE("\"match\": \"a\", \"preset\": \"watr\""),
                   "materials[0].preset: there is no preset \"watr\"; did you mean \"water\"?");
    assert_refused(f, RULE("\"match\": \"a\", \"preset\": 1"), "preset: 1 found");
    assert_refused(f, RULE("\"match\": \"a\", \"alpha_mode\": \"MASK\""),
                   "expected one of \"opaque\", \"mask\", \"blend\"; did you mean \"mask\"?");
    assert_refused(f, RULE("\"match\": \"a\", \"normal_texture\": 3"),
                   "3 found, expected the name of a file, an object with \"image\", or null");
    assert_refused(f, RULE("\"match\": \"a\", \"normal_texture\": { \"uv_set\": 1 }"),
                   "normal_texture: no \"image\"");
    assert_refused(f, RULE("\"match\": \"a\", \"normal_texture\": { \"wrp\": 1 }"),
                   "normal_texture: unknown key \"wrp\"; did you mean \"wrap\"?");
}

static void only_what_is_named_changes(void **state)
{
    setup_fixture *f = *state;
    ppm_scene *plain = setup_make_room(f->context);
    assert_int_equal(setup_apply(f, RULE("\"match\": \"Glass\", \"roughness\": 0.25, "
                                         "\"base_color\": [0.1, 0.2, 0.3], "
                                         "\"transmission_kind\": \"thin\"")),
                     PPM_STATUS_OK);
    ppm_material_desc expected = material(plain, 2), found = material(f->scene, 2);
    expected.roughness = 0.25f;
    expected.base_color[0] = 0.1f;
    expected.base_color[1] = 0.2f;
    expected.base_color[2] = 0.3f;
    expected.transmission_kind = PPM_TRANSMISSION_THIN;
    assert_string_equal(found.name, "Glass");
    expected.name = found.name = NULL;
    assert_memory_equal(&found, &expected, sizeof found);
    for (ppm_material_id id = 1; id <= 4; id++) {
        if (id == 2) continue;
        expected = material(plain, id);
        found = material(f->scene, id);
        expected.name = found.name = NULL;
        assert_memory_equal(&found, &expected, sizeof found);
    }
    ppm_scene_destroy(plain);
}

static void patterns_fit_as_in_the_shell(void **state)
{
    setup_fixture *f = *state;
    static const struct {
        const char *match;
        int fits[4]; /* Floor, Glass, Glass clear, Lamp */
    } cases[] = {
        {"\"Glass\"", {0, 1, 0, 0}},
        {"\"Glass*\"", {0, 1, 1, 0}},
        {"\"?l*\"", {1, 1, 1, 0}},
        {"\"[GL]*\"", {0, 1, 1, 1}},
        {"[\"Floor\", \"La*\"]", {1, 0, 0, 1}},
        {"\"*\"", {1, 1, 1, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[200];
        snprintf(text, sizeof text, RULE("\"match\": %s, \"roughness\": 0.125"), cases[i].match);
        assert_int_equal(setup_apply(f, text), PPM_STATUS_OK);
        for (ppm_material_id id = 1; id <= 4; id++) {
            const int is_changed = material(f->scene, id).roughness == 0.125f;
            if (is_changed != cases[i].fits[id - 1]) fail_msg("%s, material %u", text, id);
        }
    }
}

static void a_pattern_that_fits_nothing_is_a_warning(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(setup_apply(f, RULE("\"match\": \"glas\", \"roughness\": 0")), PPM_STATUS_OK);
    assert_setup_logged(f, 'W',
                        "materials[0].match: \"glas\" fits no material: nothing changes; "
                        "did you mean \"Glass\"?");
}

static void later_rules_come_over_earlier_ones(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(setup_apply(f, "{ \"materials\": [ { \"match\": \"*\", \"roughness\": 0.5, "
                                    "\"metallic\": 1 }, { \"match\": \"Glass\", "
                                    "\"roughness\": 0.25 } ] }"),
                     PPM_STATUS_OK);
    assert_near(material(f->scene, 2).roughness, 0.25, 0.0);
    assert_near(material(f->scene, 2).metallic, 1.0, 0.0);
    assert_near(material(f->scene, 1).roughness, 0.5, 0.0);
}

/* Every key of the reference, each with a value that is not the default. */
static void each_field_is_set_by_its_name(void **state)
{
    setup_fixture *f = *state;
    ppm_material_desc expected;
    assert_int_equal(
        setup_apply(
            f, RULE("\"match\": \"Lamp\", \"base_color\": [0.1, 0.2, 0.3, 0.4], \"metallic\": 0.1,"
                    "\"roughness\": 0.2, \"normal_scale\": 2, \"emission\": [1, 2, 3],"
                    "\"ior\": 1.7, \"specular\": 0.3, \"specular_color\": [0.4, 0.5, 0.6],"
                    "\"transmission\": 0.7, \"transmission_kind\": \"thin\","
                    "\"attenuation_color\": [0.7, 0.8, 0.9], \"attenuation_distance_m\": 0.5,"
                    "\"dispersion\": 0.25, \"nested_priority\": 3, \"alpha_mode\": \"mask\","
                    "\"alpha_cutoff\": 0.3, \"double_sided\": false, \"clearcoat\": 0.11,"
                    "\"clearcoat_roughness\": 0.12, \"clearcoat_normal_scale\": 3,"
                    "\"sheen_color\": 0.13, \"sheen_roughness\": 0.14, \"iridescence\": 0.15,"
                    "\"iridescence_ior\": 1.6, \"iridescence_thickness_min_nm\": 200,"
                    "\"iridescence_thickness_max_nm\": 500, \"anisotropy\": 0.16,"
                    "\"anisotropy_rotation_rad\": 0.17, \"diffuse_transmission\": 0.18,"
                    "\"diffuse_transmission_color\": 0.19, \"multiscatter_color\": 0.2,"
                    "\"scatter_anisotropy_g\": 0.21, \"retroreflection\": 0.22,"
                    "\"roughness_is_glossiness\": true, \"emission_takes_vertex_color\": true,"
                    "\"diffuse_roughness\": 0.23, \"specular_is_edge_color\": true,"
                    "\"coat_ior\": 1.24, \"coat_color\": [0.25, 0.26, 0.27],"
                    "\"coat_darkening\": 0.28, \"coat_anisotropy\": 0.29,"
                    "\"coat_anisotropy_rotation_rad\": 0.3, \"emission_is_above_coat\": true,"
                    "\"fuzz\": 0.31")),
        PPM_STATUS_OK);
    memset(&expected, 0, sizeof expected);
    expected = (ppm_material_desc){.size = sizeof expected,
                                   .base_color = {0.1f, 0.2f, 0.3f, 0.4f},
                                   .metallic = 0.1f,
                                   .roughness = 0.2f,
                                   .normal_scale = 2.0f,
                                   .emission = {1.0f, 2.0f, 3.0f},
                                   .ior = 1.7f,
                                   .specular = 0.3f,
                                   .specular_color = {0.4f, 0.5f, 0.6f},
                                   .transmission = 0.7f,
                                   .transmission_kind = PPM_TRANSMISSION_THIN,
                                   .attenuation_color = {0.7f, 0.8f, 0.9f},
                                   .attenuation_distance_m = 0.5f,
                                   .dispersion = 0.25f,
                                   .nested_priority = 3,
                                   .alpha_mode = PPM_ALPHA_MASK,
                                   .alpha_cutoff = 0.3f,
                                   .clearcoat = 0.11f,
                                   .clearcoat_roughness = 0.12f,
                                   .clearcoat_normal_scale = 3.0f,
                                   .sheen_color = {0.13f, 0.13f, 0.13f},
                                   .sheen_roughness = 0.14f,
                                   .iridescence = 0.15f,
                                   .iridescence_ior = 1.6f,
                                   .iridescence_thickness_min_nm = 200.0f,
                                   .iridescence_thickness_max_nm = 500.0f,
                                   .anisotropy = 0.16f,
                                   .anisotropy_rotation_rad = 0.17f,
                                   .diffuse_transmission = 0.18f,
                                   .diffuse_transmission_color = {0.19f, 0.19f, 0.19f},
                                   .multiscatter_color = {0.2f, 0.2f, 0.2f},
                                   .scatter_anisotropy_g = 0.21f,
                                   .retroreflection = 0.22f,
                                   .roughness_is_glossiness = 1,
                                   .emission_takes_vertex_color = 1,
                                   .diffuse_roughness = 0.23f,
                                   .specular_is_edge_color = 1,
                                   .coat_ior = 1.24f,
                                   .coat_color = {0.25f, 0.26f, 0.27f},
                                   .coat_darkening = 0.28f,
                                   .coat_anisotropy = 0.29f,
                                   .coat_anisotropy_rotation_rad = 0.3f,
                                   .emission_is_above_coat = 1,
                                   .fuzz = 0.31f};
    ppm_material_desc found = material(f->scene, 4);
    found.name = NULL;
    assert_memory_equal(&found, &expected,
                        offsetof(ppm_material_desc, fuzz_texture) + sizeof expected.fuzz_texture);
}

static void an_overridden_material_renders_as_by_calls(void **state)
{
    setup_fixture *f = *state;
    ppm_camera_id camera;
    ppm_scene *other = setup_make_room(f->context);
    ppm_material_desc desc = material(other, 2);
    desc.base_color[0] = desc.base_color[1] = desc.base_color[2] = 1.0f;
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    desc.ior = 1.333f;
    assert_int_equal(ppm_scene_set_material(other, 2, &desc), PPM_STATUS_OK);
    assert_int_equal(setup_apply(f, RULE("\"match\": \"Glass\", \"preset\": \"water\"")),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_framing_camera(f->scene, 1.0f, &camera), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_framing_camera(other, 1.0f, &camera), PPM_STATUS_OK);
    assert_same_picture(f, other, 1);
}

static void a_preset_comes_before_all_keys_and_keeps_the_normal_map(void **state)
{
    setup_fixture *f = *state;
    setup_write_picture(f, "inner/n.hdr");
    assert_int_equal(
        setup_apply(f, "{ \"materials\": [ { \"match\": \"Glass\", \"normal_texture\": \"n.hdr\", "
                       "\"metallic_roughness_texture\": \"n.hdr\", \"nested_priority\": 2 }, "
                       "{ \"match\": \"Glass\", \"roughness\": 0.3, \"preset\": \"gold\" } ] }"),
        PPM_STATUS_OK);
    const ppm_material_desc found = material(f->scene, 2);
    assert_near(found.roughness, 0.3, 1e-7);
    assert_near(found.metallic, 1.0, 0.0);
    assert_near(found.base_color[1], 0.71, 1e-6);
    assert_true(found.normal_texture.image != 0);
    assert_int_equal(found.metallic_roughness_texture.image, 0);
    assert_int_equal(found.nested_priority, 2);
}

static void textures_are_loaded_once_for_each_role(void **state)
{
    setup_fixture *f = *state;
    setup_write_picture(f, "inner/t.hdr");
    assert_int_equal(
        setup_apply(f, RULE("\"match\": \"Gl*\", \"base_color_texture\": { \"image\": \"t.hdr\", "
                            "\"uv_set\": 1, \"wrap\": \"clamp\", \"wrap_v\": \"mirror\", "
                            "\"filter\": \"nearest\", \"scale\": [2, 3], \"offset\": [0.5, 0.25] },"
                            "\"emission_texture\": \"t.hdr\", \"normal_texture\": \"t.hdr\"")),
        PPM_STATUS_OK);
    const ppm_material_desc found = material(f->scene, 3);
    const ppm_texture *texture = &found.base_color_texture;
    assert_int_equal(f->scene->image_count, 2);
    assert_int_equal(texture->image, found.emission_texture.image);
    assert_true(found.normal_texture.image != texture->image);
    assert_int_equal(texture->uv_set, 1);
    assert_int_equal(texture->wrap_u, PPM_WRAP_CLAMP);
    assert_int_equal(texture->wrap_v, PPM_WRAP_MIRROR);
    assert_int_equal(texture->filter, PPM_FILTER_NEAREST);
    assert_int_equal(texture->has_transform, 1);
    const float expected[6] = {2.0f, 0.0f, 0.5f, 0.0f, 3.0f, 0.25f};
    for (int i = 0; i < 6; i++)
        assert_near(texture->uv_transform[i], expected[i], 1e-7);
    assert_int_equal(
        setup_apply(f, "{ \"materials\": [ { \"match\": \"*\", \"normal_texture\": \"t.hdr\" }, "
                       "{ \"match\": \"Glass\", \"normal_texture\": null } ] }"),
        PPM_STATUS_OK);
    assert_int_equal(material(f->scene, 2).normal_texture.image, 0);
    assert_true(material(f->scene, 3).normal_texture.image != 0);
}

static void what_an_animation_changes_is_put_back(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(setup_apply(f, RULE("\"match\": \"Glass\", \"roughness\": 0.25")),
                     PPM_STATUS_OK);
    ppm_material_desc desc = material(f->scene, 2);
    desc.roughness = 0.75f; /* as a pose does, which knows nothing of the setup */
    desc.metallic = 0.5f;
    assert_int_equal(ppm_scene_set_material(f->scene, 2, &desc), PPM_STATUS_OK);
    assert_int_equal(ppm_setup_reapply(f->setup, f->scene), PPM_STATUS_OK);
    assert_near(material(f->scene, 2).roughness, 0.25, 0.0);
    assert_near(material(f->scene, 2).metallic, 0.5, 0.0);
    assert_setup_logged(f, 'I', "material 'Glass' is animated");
}

static void a_setup_is_not_put_back_into_another_scene(void **state)
{
    setup_fixture *f = *state;
    ppm_scene *other = setup_make_room(f->context);
    assert_int_equal(setup_apply(f, RULE("\"match\": \"Glass\", \"roughness\": 0.25")),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_setup_reapply(f->setup, other), PPM_STATUS_INVALID_ARGUMENT);
    ppm_scene_destroy(other);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup_setup, setup_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_is_out_of_range_is_refused),
        TEST(only_what_is_named_changes),
        TEST(patterns_fit_as_in_the_shell),
        TEST(a_pattern_that_fits_nothing_is_a_warning),
        TEST(later_rules_come_over_earlier_ones),
        TEST(each_field_is_set_by_its_name),
        TEST(an_overridden_material_renders_as_by_calls),
        TEST(a_preset_comes_before_all_keys_and_keeps_the_normal_map),
        TEST(textures_are_loaded_once_for_each_role),
        TEST(what_an_animation_changes_is_put_back),
        TEST(a_setup_is_not_put_back_into_another_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
