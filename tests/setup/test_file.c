/* Setup files as files: what is broken, what is found, what is listed. */
#include <stdio.h>
#include <string.h>

#include "setup/setup_fixture.h"

static void broken_json_is_refused_with_its_line(void **state)
{
    setup_fixture *f = *state;
    assert_refused(f, "", "line 1");
    assert_refused(f, "{\n  \"lights\": [\n}\n", "line 3");
    assert_refused(f, "{ \"fog\": { \"g\": NaN } }", "line 1, column");
    assert_refused(f, "{ \"fog\": { \"g\": 1e999 } }", "line 1");
    assert_refused(f, "{ \"fog\": {}, \"fog\": {} }", "duplicate");
    assert_refused(f, "{} {}", "line 1");
    assert_refused(f, "{ \"render\": { \"view\": \"\xff\" } }", "unable to decode byte 0xff");
}

static void wrong_types_are_refused_with_their_place(void **state)
{
    setup_fixture *f = *state;
    assert_refused(f, "[]", "[] found, expected an object");
    assert_refused(f, "{ \"lights\": {} }", "lights: {} found, expected a list");
    assert_refused(f, "{ \"lights\": [3] }", "lights[0]: 3 found, expected an object");
    assert_refused(f, "{ \"fog\": [] }", "fog: [] found, expected an object");
    assert_refused(f, "{ \"fog\": { \"g\": \"x\" } }",
                   "fog.g: \"x\" found, expected a number from -0.999999 to 0.999999");
    assert_refused(f, "{ \"fog\": { \"sigma_s\": [1, 2] } }", "fog.sigma_s: [1,2] found");
    assert_refused(f, "{ \"fog\": { \"sigma_s\": [1, 2, null] } }", "fog.sigma_s: [1,2,null]");
    assert_refused(f, "{ \"fog\": { \"sigma_s\": -1 } }", "fog.sigma_s: -1 found");
    assert_refused(f, "{ \"nodes\": [ { \"match\": \"a\", \"visible\": 1 } ] }",
                   "nodes[0].visible: 1 found, expected true or false");
    assert_refused(f, "{ \"nodes\": [ { \"match\": \"a\", \"nested_priority\": 1.5 } ] }",
                   "nodes[0].nested_priority: 1.5 found, expected a whole number");
    assert_refused(f, "{ \"cameras\": [ { \"name\": \"\" } ] }", "cameras[0].name: \"\" found");
    assert_refused(f, "{ \"render\": [] }", "render: [] found");
    assert_refused(f, "{ \"render\": { \"size\": null } }", "render.size: null found");
    assert_refused(f, "{ \"render\": { \"crop\": [[1]] } }", "render.crop: [[1]] found");
}

static void unknown_keys_are_answered_with_the_nearest(void **state)
{
    setup_fixture *f = *state;
    assert_refused(f, "{ \"light\": [] }", "unknown key \"light\"; did you mean \"lights\"?");
    assert_refused(f, "{ \"fog\": { \"sigma_d\": 1 } }", "fog: unknown key \"sigma_d\"");
    assert_refused(f, "{ \"materials\": [ { \"match\": \"a\", \"rougness\": 1 } ] }",
                   "materials[0]: unknown key \"rougness\"; did you mean \"roughness\"?");
    assert_refused(f, "{ \"lights\": [ { \"kind\": \"pont\" } ] }",
                   "lights[0].kind: \"pont\" found, expected one of \"point\", \"spot\"");
}

static void remarks_are_not_read(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(setup_open(f, "\xef\xbb\xbf{ \"_\": 1, \"fog\": { \"_why\": [], \"g\": 0 } }"),
                     PPM_STATUS_OK);
}

static void files_that_are_not_there_are_told(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(ppm_setup_open(f->context, setup_path(f, "none.json"), NULL, &f->setup),
                     PPM_STATUS_INPUT_NOT_FOUND);
    assert_int_equal(ppm_setup_open(f->context, setup_path(f, "inner"), NULL, &f->setup),
                     PPM_STATUS_INPUT_NOT_FOUND);
    assert_refused(f, "{ \"environment\": { \"image\": \"sky.hdr\" } }",
                   "environment.image: cannot read");
    assert_refused(f,
                   "{ \"lights\": [ { \"kind\": \"point\", \"position\": [0, 1, 0], "
                   "\"profile\": \"a.ies\" } ] }",
                   "lights[0].profile: cannot read");
    assert_refused(f, "{ \"materials\": [ { \"match\": \"a\", \"normal_texture\": \"n.png\" } ] }",
                   "materials[0].normal_texture: cannot read");
}

static void paths_that_leave_the_folder_are_refused_unless_allowed(void **state)
{
    setup_fixture *f = *state;
    const ppm_setup_options trusted = {.size = sizeof trusted, .allow_outside = 1};
    setup_write_picture(f, "out.hdr");
    setup_write_picture(f, "inner/in.hdr");
    const char *const climbing[] = {"../out.hdr", "a/../../out.hdr", "/etc/passwd"};
    for (size_t i = 0; i < sizeof climbing / sizeof climbing[0]; i++) {
        char text[200];
        snprintf(text, sizeof text, "{ \"environment\": { \"image\": \"%s\" } }", climbing[i]);
        assert_refused(f, text, "outside of the setup file's folder");
    }
    assert_int_equal(setup_open(f, "{ \"environment\": { \"image\": \"./in.hdr\" } }"),
                     PPM_STATUS_OK);
    assert_refused(f, "{ \"environment\": { \"image\": \"../out.hdr\" } }", "--allow-outside");
    assert_int_equal(
        ppm_setup_open(f->context, setup_path(f, "inner/s.ppm.json"), &trusted, &f->setup),
        PPM_STATUS_OK);
}

static void the_file_beside_a_model_is_found(void **state)
{
    setup_fixture *f = *state;
    const char *const models[] = {"inner/a.b.obj", "inner/a.b.glb"};
    setup_write(f, "inner/a.b.ppm.json", "{}");
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(
            ppm_setup_open_beside(f->context, setup_path(f, models[i]), NULL, &f->setup),
            PPM_STATUS_OK);
        assert_non_null(f->setup);
        assert_non_null(strstr(ppm_setup_path(f->setup), "inner/a.b.ppm.json"));
        ppm_setup_close(f->setup);
        f->setup = NULL;
    }
    assert_int_equal(
        ppm_setup_open_beside(f->context, setup_path(f, "inner/a.obj"), NULL, &f->setup),
        PPM_STATUS_OK);
    assert_null(f->setup);
}

static void items_and_options_are_listed(void **state)
{
    setup_fixture *f = *state;
    static const struct {
        uint32_t part;
        const char *name, *detail;
    } items[] = {
        {0, "size", "640x480"},
        {0, "crop", "0.0,0.5,1.0,1.0"},
        {0, "exposure", "-2"},
        {0, "strict", ""},
        {PPM_SETUP_MATERIALS, "Gl*, ...", "preset gold, roughness"},
        {PPM_SETUP_CAMERAS, "Main", "perspective"},
        {PPM_SETUP_LIGHTS, "", "sun"},
        {PPM_SETUP_FOG, "", "g"},
    };
    assert_int_equal(
        setup_open(f,
                   "{ \"fog\": { \"g\": 0.5 },\n"
                   "\"render\": { \"size\": \"640x480\", \"crop\": [0.0, 0.5, 1.0, 1.0],\n"
                   "  \"exposure\": -2, \"strict\": true, \"quiet\": false },\n"
                   "\"lights\": [ { \"kind\": \"sun\", \"lux\": 1, \"direction\": [0, -1, 0] } ],\n"
                   "\"cameras\": [ { \"name\": \"Main\", \"position\": [0, 0, 1],\n"
                   "  \"target\": [0, 0, 0], \"fov\": 30 } ],\n"
                   "\"materials\": [ { \"match\": [\"Gl*\", \"b\"], \"preset\": \"gold\",\n"
                   "  \"roughness\": 0.1 } ] }"),
        PPM_STATUS_OK);
    const uint32_t count = sizeof items / sizeof items[0];
    assert_int_equal(ppm_setup_count(f->setup), count);
    assert_int_equal(ppm_setup_option_count(f->setup), 4);
    for (uint32_t i = 0; i < count; i++) {
        ppm_setup_item item = {.size = sizeof item};
        assert_int_equal(ppm_setup_get_item(f->setup, i, &item), PPM_STATUS_OK);
        assert_int_equal(item.part, items[i].part);
        assert_string_equal(item.name, items[i].name);
        assert_string_equal(item.detail, items[i].detail);
    }
    const char *name, *value;
    assert_int_equal(ppm_setup_get_option(f->setup, 1, &name, &value), PPM_STATUS_OK);
    assert_string_equal(name, "crop");
    assert_string_equal(value, "0.0,0.5,1.0,1.0");
    assert_int_equal(ppm_setup_get_option(f->setup, 4, &name, &value), PPM_STATUS_INVALID_ARGUMENT);
}

static void calls_without_a_setup_are_refused(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(ppm_setup_open(f->context, NULL, NULL, &f->setup),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_setup_apply(NULL, NULL, PPM_SETUP_ALL), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_setup_camera(NULL), 0);
    assert_int_equal(ppm_setup_count(NULL), 0);
    assert_int_equal(ppm_setup_option_count(NULL), 0);
    assert_int_equal(setup_apply(f, "{}"), PPM_STATUS_OK);
    assert_int_equal(ppm_setup_apply(f->setup, f->scene, 64), PPM_STATUS_INVALID_ARGUMENT);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup_setup, setup_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(broken_json_is_refused_with_its_line),
        TEST(wrong_types_are_refused_with_their_place),
        TEST(unknown_keys_are_answered_with_the_nearest),
        TEST(remarks_are_not_read),
        TEST(files_that_are_not_there_are_told),
        TEST(paths_that_leave_the_folder_are_refused_unless_allowed),
        TEST(the_file_beside_a_model_is_found),
        TEST(items_and_options_are_listed),
        TEST(calls_without_a_setup_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
