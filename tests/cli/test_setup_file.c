/* --setup, the setup file beside the model, and who wins. */
#include <math.h>
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
#include "imageio/imageio.h"

#define QUICK "-i path -s 16x16 -n 2 -q "

static void write_text(const char *path, const char *text)
{
    FILE *const file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static outcome run_well(const char *arguments)
{
    const outcome result = run_program(arguments);
    if (result.status != 0) fail_msg("%s\nstatus %d: %s", arguments, result.status, result.err);
    return result;
}

/* The setup s.json is text; the program ends with status, saying expected. */
static void assert_refused(const char *text, const char *arguments, int status,
                           const char *expected)
{
    write_text("s.json", text);
    const outcome result = run_program(arguments);
    if (result.status != status || !strstr(result.err, expected)) {
        fail_msg("%s\n%s\nstatus %d, expected %d\nexpected: %s\nsaid: %s", text, arguments,
                 result.status, status, expected, result.err);
    }
}

static bool pictures_are_equal(const char *path_a, const char *path_b)
{
    ppmi_pixels a = {0}, b = {0};
    assert_int_equal(ppmi_imageio_read_file(NULL, path_a, path_a, &a), PPM_STATUS_OK);
    assert_int_equal(ppmi_imageio_read_file(NULL, path_b, path_b, &b), PPM_STATUS_OK);
    bool are_equal = a.width == b.width && a.height == b.height && a.channels == b.channels;
    if (are_equal) {
        are_equal = memcmp(a.f32, b.f32, sizeof(float) * a.width * a.height * a.channels) == 0;
    }
    ppmi_imageio_pixels_free(NULL, &a);
    ppmi_imageio_pixels_free(NULL, &b);
    return are_equal;
}

static json_t *render_stats(const char *path)
{
    json_error_t error;
    json_t *const root = json_load_file(path, 0, &error);
    if (!root) fail_msg("%s: %s", path, error.text);
    return root;
}

static json_int_t number(const json_t *root, const char *key)
{
    return json_integer_value(json_object_get(json_object_get(root, "render"), key));
}

/* ---- what is wrong --------------------------------------------------------------------------- */

static void a_missing_or_broken_setup_is_an_input_error(void **state)
{
    (void)state;
    assert_refused("{", "--setup s.json tiny.gltf", 2, "s.json: line 1");
    assert_refused("{}", "--setup t.json tiny.gltf", 2, "t.json: cannot read");
    assert_refused("{ \"fog\": { \"gg\": 1 } }", "--setup s.json --list tiny.gltf", 2,
                   "did you mean \"g\"?");
    assert_refused("{}", "--setup '' tiny.gltf", 1, "--setup: ''");
    assert_refused("{ \"cameras\": [ { \"position\": [0, 1, 2], \"target\": [0, 0, 0], "
                   "\"fov\": 40, \"focus_node\": \"Flor\" } ] }",
                   QUICK "--setup s.json -o x.exr tiny.gltf", 2, "did you mean \"Floor\"?");
}

static void render_options_pass_the_checks_of_the_command_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *expected;
    } cases[] = {
        {"{ \"render\": { \"passes\": 0 } }", "s.json: render.passes: '0' is not a whole number"},
        {"{ \"render\": { \"passes\": 2.5 } }", "render.passes: '2.5'"},
        {"{ \"render\": { \"size\": [640, 480] } }", "render.size: '640,480' is not a size"},
        {"{ \"render\": { \"integrator\": \"spm\" } }",
         "render.integrator: 'spm' is not one of sppm, ppm, path; did you mean 'sppm'?"},
        {"{ \"render\": { \"pases\": 3 } }",
         "s.json: render: unknown option 'pases'; did you mean 'passes'?"},
        {"{ \"render\": { \"passes\": true } }", "render.passes: '' is not a value"},
        {"{ \"render\": { \"strict\": 3 } }", "render.strict: '3' is not true or false"},
        {"{ \"render\": { \"output\": \"a.exr\" } }", "render.output: which files are read"},
        {"{ \"render\": { \"allow-outside\": true } }", "render.allow-outside: which files"},
        {"{ \"render\": { \"help\": true } }", "render.help: it is for the command line alone"},
        {"{ \"render\": { \"fog\": [1, 0] } }", "render.fog: the setup file has sections"},
        {"{ \"render\": { \"passes\": 3, \"epochs\": 3 } }", "both say when to stop"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const int status = i + 1 < sizeof cases / sizeof cases[0] ? 2 : 1;
        assert_refused(cases[i].text, "--setup s.json tiny.gltf", status, cases[i].expected);
    }
}

static void a_broken_setup_beside_the_model_tells_how_to_do_without(void **state)
{
    (void)state;
    write_text("tiny.ppm.json", "[]");
    const outcome result = run_program("--list tiny.gltf");
    assert_int_equal(result.status, 2);
    assert_contains(result.err, "tiny.ppm.json: [] found");
    assert_contains(result.err, "--setup none");
    run_well("--setup none --list tiny.gltf");
    assert_int_equal(unlink("tiny.ppm.json"), 0);
}

/* ---- who wins -------------------------------------------------------------------------------- */

static void the_command_line_wins_over_the_setup(void **state)
{
    (void)state;
    write_text("s.json", "{ \"render\": { \"size\": \"24x12\", \"passes\": 3, \"seed\": 5, "
                         "\"integrator\": \"path\", \"max-depth\": 7 } }");
    run_well("-q --setup s.json --stats a.stats -o a.exr tiny.gltf");
    run_well("-q --setup s.json --stats b.stats -o b.exr -s 8x8 --seed 6 -t 1000 -n 2 tiny.gltf");
    json_t *const a = render_stats("a.stats"), *const b = render_stats("b.stats");
    assert_int_equal(number(a, "full_width"), 24);
    assert_int_equal(number(a, "passes"), 3);
    assert_int_equal(number(a, "seed"), 5);
    assert_int_equal(number(a, "max_depth"), 7);
    assert_string_equal(json_string_value(json_object_get(a, "setup")), "s.json");
    assert_int_equal(number(b, "full_width"), 8);
    assert_int_equal(number(b, "passes"), 2);
    assert_int_equal(number(b, "seed"), 6);
    assert_int_equal(number(b, "max_depth"), 7);
    json_decref(a);
    json_decref(b);
}

static void another_way_to_stop_takes_the_place_of_the_setups(void **state)
{
    (void)state;
    write_text("s.json", "{ \"render\": { \"passes\": 2, \"frames\": \"1-9\", \"fps\": 12 } }");
    run_well("-q -i ppm -s 8x8 -p 512 --photons-per-epoch 512 --epochs 1 --setup s.json --frame 1 "
             "-o c.exr --stats c.stats moving.gltf");
    json_t *const c = render_stats("c.stats");
    assert_int_equal(number(c, "passes"), 1);
    assert_true(fabs(json_real_value(json_object_get(c, "time_s")) - 1.0 / 12.0) < 1e-9);
    json_decref(c);
    write_text("s.json", "{ \"render\": { \"fps\": 12 } }"); /* idle, and no mistake */
    run_well(QUICK "--setup s.json -o c.exr tiny.gltf");
}

static void options_of_the_setup_and_of_the_command_line_make_the_same_picture(void **state)
{
    (void)state;
    write_text("s.json", "{ \"render\": { \"crop\": [0.0, 0.0, 0.5, 1.0], \"filter\": \"box,1\", "
                         "\"camera\": \"Side\" } }");
    run_well(QUICK "--setup s.json -o s.exr tiny.gltf");
    run_well(QUICK "--crop 0.0,0.0,0.5,1.0 --filter box,1 --camera Side -o d.exr tiny.gltf");
    run_well(QUICK "-o plain.exr tiny.gltf");
    assert_true(pictures_are_equal("s.exr", "d.exr"));
    assert_false(pictures_are_equal("s.exr", "plain.exr"));
}

/* Front's place and angle, from the scene. */
#define FRONT_CAMERA                                                                               \
    "{ \"name\": \"Mine\", \"matrix\": [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 3, 1, 0, 1], "        \
    "\"fov\": 45.83662 }"

static void the_first_camera_of_the_setup_is_rendered(void **state)
{
    (void)state;
    write_text("s.json", "{ \"cameras\": [ " FRONT_CAMERA " ] }");
    run_well(QUICK "--setup s.json -o e.exr --stats e.stats tiny.gltf");
    json_t *const e = render_stats("e.stats");
    assert_string_equal(json_string_value(json_object_get(e, "camera")), "Mine");
    json_decref(e);
    run_well(QUICK "--setup s.json --camera Front -o e.exr tiny.gltf");
    run_well(QUICK "-o f.exr tiny.gltf");
    assert_true(pictures_are_equal("e.exr", "f.exr"));
    run_well(QUICK "--setup s.json --camera 3 -o g.exr tiny.gltf");
    assert_false(pictures_are_equal("g.exr", "f.exr"));
}

static void surroundings_of_the_command_line_replace_the_setups(void **state)
{
    (void)state;
    write_text("s.json", "{ \"environment\": { \"color\": [0.5, 1, 2], \"backdrop\": 3 }, "
                         "\"fog\": { \"sigma_s\": 0.2 } }");
    run_well(QUICK "--setup s.json --sun 40,20 --fog 0,0 -o h.exr tiny.gltf");
    run_well(QUICK "--sun 40,20 -o i.exr tiny.gltf");
    assert_true(pictures_are_equal("h.exr", "i.exr"));
    write_text("s.json", "{ \"environment\": { \"color\": [0.5, 1, 2], \"backdrop\": 3 } }");
    run_well(QUICK "--setup s.json --background env -o h.exr tiny.gltf");
    write_text("s.json", "{ \"environment\": { \"color\": [0.5, 1, 2] } }");
    run_well(QUICK "--setup s.json -o i.exr tiny.gltf");
    assert_true(pictures_are_equal("h.exr", "i.exr"));
}

/* ---- beside the model, frames, lists --------------------------------------------------------- */

static void the_setup_beside_the_model_is_used_and_told(void **state)
{
    (void)state;
    const char *const text = "{ \"materials\": [ { \"match\": \"Grey\", \"base_color\": 0.9 } ] }";
    write_text("tiny.ppm.json", text);
    write_text("s.json", text);
    const outcome result = run_well("-i path -s 16x16 -n 2 -o j.exr tiny.gltf");
    assert_contains(result.err, "setup file: tiny.ppm.json, found beside the model");
    run_well(QUICK "--setup none -o k.exr tiny.gltf");
    assert_int_equal(unlink("tiny.ppm.json"), 0);
    run_well(QUICK "--setup s.json -o l.exr tiny.gltf");
    run_well(QUICK "-o m.exr tiny.gltf");
    assert_true(pictures_are_equal("j.exr", "l.exr"));
    assert_true(pictures_are_equal("k.exr", "m.exr"));
    assert_false(pictures_are_equal("j.exr", "k.exr"));
}

static void a_frame_has_the_same_bits_alone_as_in_a_sequence(void **state)
{
    (void)state;
    write_text("s.json", "{ \"cameras\": [ { \"position\": [0, 1, 4], \"target\": [0, 0.5, 0], "
                         "\"fov\": 40, \"f_number\": 0.5, \"focus_node\": \"Lamp\" } ], "
                         "\"materials\": [ { \"match\": \"Grey\", \"roughness\": 0.2 } ] }");
    run_well(QUICK "--setup s.json --frames 4-6 -o n.####.exr moving.gltf");
    run_well(QUICK "--setup s.json --frame 6 -o o.exr moving.gltf");
    assert_true(pictures_are_equal("n.0006.exr", "o.exr"));
    assert_false(pictures_are_equal("n.0004.exr", "o.exr"));
}

static void all_cameras_are_those_of_the_setup_too(void **state)
{
    (void)state;
    write_text("s.json", "{ \"cameras\": [ " FRONT_CAMERA " ] }");
    run_well(QUICK "--setup s.json --camera all -o p.%c.exr tiny.gltf");
    assert_int_equal(access("p.Front.exr", F_OK), 0);
    assert_int_equal(access("p.Side.exr", F_OK), 0);
    assert_int_equal(access("p.Mine.exr", F_OK), 0);
}

static void lists_name_the_setup_and_what_it_adds(void **state)
{
    (void)state;
    write_text("s.json", "{ \"cameras\": [ " FRONT_CAMERA " ], \"render\": { \"passes\": 4 } }");
    const outcome table = run_well("--setup s.json --list tiny.gltf");
    assert_contains(table.out, "Setup file (--setup): s.json\n");
    assert_contains(table.out, "camera       Mine: perspective\n");
    assert_contains(table.out, "render       passes: 4\n");
    const outcome json = run_well("--setup s.json --list=json tiny.gltf");
    json_t *const root = json_loads(json.out, 0, NULL);
    json_t *const setup = json_object_get(root, "setup");
    assert_string_equal(json_string_value(json_object_get(setup, "file")), "s.json");
    assert_int_equal(json_array_size(json_object_get(setup, "items")), 2);
    json_decref(root);
    const outcome none = run_well("--list=json tiny.gltf");
    json_t *const bare = json_loads(none.out, 0, NULL);
    assert_true(json_is_null(json_object_get(bare, "setup")));
    json_decref(bare);
}

static int make_folder(void **state)
{
    const int result = folder_setup(state);
    return result == 0 && tiny_scene_write_moving("moving.gltf") ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_missing_or_broken_setup_is_an_input_error),
        cmocka_unit_test(render_options_pass_the_checks_of_the_command_line),
        cmocka_unit_test(a_broken_setup_beside_the_model_tells_how_to_do_without),
        cmocka_unit_test(the_command_line_wins_over_the_setup),
        cmocka_unit_test(another_way_to_stop_takes_the_place_of_the_setups),
        cmocka_unit_test(options_of_the_setup_and_of_the_command_line_make_the_same_picture),
        cmocka_unit_test(the_first_camera_of_the_setup_is_rendered),
        cmocka_unit_test(surroundings_of_the_command_line_replace_the_setups),
        cmocka_unit_test(the_setup_beside_the_model_is_used_and_told),
        cmocka_unit_test(a_frame_has_the_same_bits_alone_as_in_a_sequence),
        cmocka_unit_test(all_cameras_are_those_of_the_setup_too),
        cmocka_unit_test(lists_name_the_setup_and_what_it_adds),
    };
    return cmocka_run_group_tests(tests, make_folder, folder_teardown);
}
