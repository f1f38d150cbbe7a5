/* --list, as a table and as JSON; --strict. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <jansson.h>

#include "cli/program.h"
#include "cli/tiny_scene.h"

static outcome run_well(const char *arguments)
{
    const outcome result = run_program(arguments);
    if (result.status != 0) fail_msg("%s\nstatus %d: %s", arguments, result.status, result.err);
    return result;
}

static void bad_calls_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *arguments;
        int status;
        const char *text;
    } cases[] = {
        {"--list", 1, "no INPUT"},
        {"--list=jsn moving.gltf", 1, "'jsn' is not one of table, json; did you mean 'json'?"},
        {"--list= moving.gltf", 1, "--list: ''"},
        {"--list json moving.gltf", 1, "write --list=json"},
        {"--lis moving.gltf", 1, "did you mean '--list'?"},
        {"--list missing.gltf", 2, "missing.gltf"},
        {"--list moving.gltf >/dev/full", 3, "standard output"},
        {"--list=json moving.gltf >/dev/full", 3, "standard output"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const outcome result = run_program(cases[i].arguments);
        if (result.status != cases[i].status || !strstr(result.err, cases[i].text)) {
            fail_msg("%s\nstatus %d: %s", cases[i].arguments, result.status, result.err);
        }
    }
}

static void the_table_shows_what_is_there(void **state)
{
    (void)state;
    static const char *const parts[] = {"moving.gltf, written by ppm tests\n",
                                        "Scenes (--scene): 1\n",
                                        "4 root nodes, the file's default",
                                        "Cameras (--camera): 2\n",
                                        "    2  Side   perspective, 45.8 degrees high\n",
                                        "    1  Front  perspective, 45.8 degrees high, 2:1\n",
                                        "Animations (--animation): 2\n",
                                        "    1  Slide      0 .. 1 s, 1 channel\n",
                                        "    2  Lamp   mesh 2\n",
                                        "    3  Front  camera 'Front'\n",
                                        "2 triangles, 1 primitive",
                                        "    2  Light  metal, roughness 1, emissive\n",
                                        "    1  Wood  file wood%20floor.png\n"};
    const outcome result = run_well("--list moving.gltf");
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        assert_contains(result.out, parts[i]);
    assert_null(strstr(result.out, "Variants"));
    assert_string_equal(run_well("--list=table moving.gltf").out, result.out);
    assert_int_equal(access("moving.exr", F_OK), -1); /* nothing is rendered */
}

/* A name must not ring the bell, nor clear the screen. */
static void names_hold_nothing_that_a_terminal_obeys(void **state)
{
    (void)state;
    const outcome result = run_well("--list moving.gltf");
    assert_contains(result.out, "    2  Bell??[2J");
    assert_null(strpbrk(result.out, "\a\x1b"));
}

static const char *name_at(const json_t *root, const char *kind, size_t index)
{
    const json_t *const item = json_array_get(json_object_get(root, kind), index);
    assert_int_equal(json_integer_value(json_object_get(item, "number")), index + 1);
    assert_true(json_is_string(json_object_get(item, "detail")));
    return json_string_value(json_object_get(item, "name"));
}

static void the_json_has_every_list_and_its_names(void **state)
{
    (void)state;
    static const struct {
        const char *kind;
        size_t count;
    } lists[] = {{"scenes", 1},   {"cameras", 2},    {"lights", 0},
                 {"variants", 0}, {"animations", 2}, {"nodes", 4},
                 {"meshes", 2},   {"materials", 2},  {"images", 1}};
    const outcome result = run_well("-q --list=json moving.gltf");
    assert_string_equal(result.err, "");
    json_error_t error;
    json_t *const root = json_loads(result.out, 0, &error);
    if (!root) fail_msg("%s\n%s", error.text, result.out);
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        const json_t *const list = json_object_get(root, lists[i].kind);
        assert_true(json_is_array(list));
        assert_int_equal(json_array_size(list), lists[i].count);
    }
    assert_string_equal(name_at(root, "cameras", 1), "Side");
    assert_string_equal(name_at(root, "nodes", 0), "Floor");
    assert_string_equal(name_at(root, "materials", 1), "Light");
    assert_string_equal(name_at(root, "animations", 0), "Slide");
    assert_string_equal(name_at(root, "images", 0), "Wood");
    const json_t *const slide = json_array_get(json_object_get(root, "animations"), 0);
    assert_true(json_real_value(json_object_get(slide, "begin_s")) == 0.0);
    assert_true(json_real_value(json_object_get(slide, "end_s")) == 1.0);
    assert_string_equal(json_string_value(json_object_get(root, "generator")), "ppm tests");
    assert_string_equal(json_string_value(json_object_get(root, "light_units")), "");
    assert_true(json_is_array(json_object_get(root, "features")));
    json_decref(root);
}

static void objects_of_an_obj_are_its_nodes(void **state)
{
    (void)state;
    FILE *const file = fopen("bare.obj", "w");
    assert_non_null(file);
    fputs("o Plate\nusemtl Tin\nv 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\nf 3 2 1\no Lid\nf 1 3 2\n",
          file);
    fclose(file);
    const outcome result = run_well("--list bare.obj");
    assert_contains(result.out, "    1  Plate  2 faces\n");
    assert_contains(result.out, "    2  Lid    1 face\n");
    assert_contains(result.out, "    1  Tin\n");
}

/* An extension that nobody will ever read. */
static void write_strange_scene(void)
{
    FILE *const file = fopen("strange.gltf", "w");
    assert_non_null(file);
    fputs("{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"TEST_not_there\"],\n"
          " \"scenes\": [{\"nodes\": []}]}",
          file);
    fclose(file);
}

static void what_is_ignored_is_listed_and_refused_when_strict(void **state)
{
    (void)state;
    write_strange_scene();
    assert_contains(run_well("--list strange.gltf").out, "  ignored       TEST_not_there");
    const outcome strict = run_program("--strict -o strange.exr strange.gltf");
    assert_int_equal(strict.status, 2);
    assert_contains(strict.err, "TEST_not_there");
    run_well("--strict -s 16x8 -n 1 -i path -o fine.exr tiny.gltf");
}

static int setup(void **state)
{
    return folder_setup(state) == 0 && tiny_scene_write_moving("moving.gltf") ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_calls_are_refused),
        cmocka_unit_test(the_table_shows_what_is_there),
        cmocka_unit_test(names_hold_nothing_that_a_terminal_obeys),
        cmocka_unit_test(the_json_has_every_list_and_its_names),
        cmocka_unit_test(objects_of_an_obj_are_its_nodes),
        cmocka_unit_test(what_is_ignored_is_listed_and_refused_when_strict),
    };
    return cmocka_run_group_tests(tests, setup, folder_teardown);
}
