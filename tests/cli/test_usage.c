/* Wrong and informative command lines: nothing is rendered here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/program.h"

/* arguments that have to end with status, saying text on standard error */
typedef struct refusal {
    const char *arguments;
    const char *text;
} refusal;

static void assert_all_refused(const refusal *cases, size_t count, int status)
{
    for (size_t i = 0; i < count; i++) {
        const outcome result = run_program(cases[i].arguments);
        if (result.status != status || !strstr(result.err, cases[i].text)) {
            fail_msg("%s\nstatus %d, expected %d\nexpected: %s\nsaid: %s", cases[i].arguments,
                     result.status, status, cases[i].text, result.err);
        }
        assert_string_equal(result.out, "");
    }
}
#define ASSERT_ALL_REFUSED(cases, status)                                                          \
    assert_all_refused(cases, sizeof(cases) / sizeof((cases)[0]), status)

static void denoising_one_pass_is_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"--denoise -n 1 tiny.gltf", "--denoise tells noise by the differences between passes"},
        {"--aov denoised -n 1 tiny.gltf", "it needs 2 at least"},
    };
    ASSERT_ALL_REFUSED(cases, 1);
}

static void unknown_options_name_the_nearest(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"--phtons 5 tiny.gltf", "unknown option '--phtons'; did you mean '--photons'?"},
        {"--ouptut=a.exr tiny.gltf", "unknown option '--ouptut'; did you mean '--output'?"},
        {"tiny.gltf --expo 1", "unknown option '--expo'; did you mean '--exposure'?"},
        {"--zzzzzz tiny.gltf", "unknown option '--zzzzzz'\n"},
        {"-S 3x3 tiny.gltf", "unknown option '-S'; did you mean '-s' (--size)?"},
        {"-Z tiny.gltf", "unknown option '-Z'\n"},
    };
    ASSERT_ALL_REFUSED(cases, 1);
}

/* Whatever is wrong with a name that would clear the screen, none of it reaches the terminal. */
static void control_characters_of_the_command_line_are_shown(void **state)
{
    (void)state;
    static const char *const cases[] = {
        "\"$E\"",
        "\"$E.gltf\"",
        "tiny.gltf -o \"$E\"",
        "tiny.gltf -o \"no/$E.png\"",
        "tiny.gltf -s \"$E\"",
        "tiny.gltf -i \"$E\"",
        "tiny.gltf --aov \"$E\"",
        "tiny.gltf --view \"$E\"",
        "tiny.gltf --ocio \"$E\"",
        "tiny.gltf --camera \"$E\"",
        "tiny.gltf --setup \"$E\"",
        "tiny.gltf --env \"$E\"",
        "tiny.gltf --stats \"no/$E\" -n 1 -s 4x4",
        "tiny.gltf --\"$E\"",
        "tiny.gltf \"$E\"",
    };
    setenv("E", "\x1b[2Jx", 1);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const outcome result = run_program(cases[i]);
        if (result.status == 0 || strchr(result.err, '\x1b') || !strstr(result.err, "\\x1b[2Jx")) {
            fail_msg("%s\nstatus %d, said: %s", cases[i], result.status, result.err);
        }
    }
    unsetenv("E");
}

/* Those that go well: the picture is written and named, and the scene is listed. */
static void control_characters_of_files_that_are_fine_are_shown(void **state)
{
    (void)state;
    setenv("E", "\x1b[2Jx", 1);
    assert_int_equal(system("cp tiny.gltf \"$E.gltf\""), 0);
    static const char *const cases[] = {
        "-n 1 -s 4x4 -i path -v -o \"$E.png\" \"$E.gltf\"",
        "-n 1 -s 4x4 -i path --frames 1-2 -o \"$E.##.png\" \"$E.gltf\"",
        "--list \"$E.gltf\"",
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const outcome result = run_program(cases[i]);
        if (result.status != 0 || strchr(result.err, '\x1b') || strchr(result.out, '\x1b') ||
            (!strstr(result.err, "\\x1b[2Jx") && !strstr(result.out, "\\x1b[2Jx"))) {
            fail_msg("%s\nstatus %d, said: %s%s", cases[i], result.status, result.err, result.out);
        }
    }
    unsetenv("E");
}

static void bad_values_name_option_and_value(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"-n 0 tiny.gltf", "--passes: '0'"},
        {"-n -3 tiny.gltf", "--passes: '-3'"},
        {"-t 0 tiny.gltf", "--time: '0'"},
        {"-t nan tiny.gltf", "--time: 'nan'"},
        {"-s 640 tiny.gltf", "--size: '640'"},
        {"-s 0x10 tiny.gltf", "--size: '0x10'"},
        {"-s 65537x10 tiny.gltf", "--size: '65537x10'"},
        {"-p many tiny.gltf", "--photons: 'many'"},
        {"--radius -1 tiny.gltf", "--radius: '-1'"},
        {"--alpha 0 tiny.gltf", "--alpha: '0'"},
        {"--alpha 1.5 tiny.gltf", "--alpha: '1.5'"},
        {"--max-depth 0 tiny.gltf", "--max-depth: '0'"},
        {"--seed -1 tiny.gltf", "--seed: '-1'"},
        {"--threads 2.5 tiny.gltf", "--threads: '2.5'"},
        {"--exposure inf tiny.gltf", "--exposure: 'inf'"},
        {"-i spm tiny.gltf", "'spm' is not one of sppm, ppm, path; did you mean 'sppm'?"},
        {"--env-rotation 361 --env a.hdr tiny.gltf", "--env-rotation: '361'"},
        {"--env-intensity 0 --env a.hdr tiny.gltf", "--env-intensity: '0'"},
        {"--sun 30 tiny.gltf", "--sun: '30' is not ELEVATION,AZIMUTH"},
        {"--sun 30,1,3,4 tiny.gltf", "--sun: '30,1,3,4' is not ELEVATION,AZIMUTH"},
        {"--sun -1,0 tiny.gltf", "an elevation from 0 to 90 degrees"},
        {"--sun 91,0 tiny.gltf", "an elevation from 0 to 90 degrees"},
        {"--sun 30,400 tiny.gltf", "an azimuth from -360 to 360 degrees"},
        {"--sun 30,1,1.5 tiny.gltf", "a turbidity from 2 to 10"},
        {"--sun 30,1,0 tiny.gltf", "a turbidity from 2 to 10"},
        {"--background white tiny.gltf", "--background: 'white' is not env, black, or a radiance"},
        {"--background 1,2 tiny.gltf", "--background: '1,2' is not env"},
        {"--background -1 tiny.gltf", "--background: '-1' is not env"},
        {"--background 1,2,1e10 tiny.gltf", "a radiance from 0 to 1e+09"},
        {"--fog 0.1 tiny.gltf", "--fog: '0.1' is not like 0.1,0.01"},
        {"--fog 0.1,-1 tiny.gltf", "--fog: '0.1,-1' is not like"},
        {"--fog 0.1,0,1 tiny.gltf", "a number between -1 and 1"},
        {"--fog nan,0 tiny.gltf", "--fog: 'nan,0' is not like"},
        {"--schedule memoryles tiny.gltf", "did you mean 'memoryless'?"},
        {"--direct photon tiny.gltf", "did you mean 'photons'?"},
        {"--aim evn tiny.gltf", "did you mean 'even'?"},
        {"--epochs 0 tiny.gltf", "--epochs: '0' is not a whole number from 1"},
        {"--epochs 2 -n 3 tiny.gltf", "--epochs and --passes both say when to stop"},
        {"--photons-per-epoch 1.5 tiny.gltf", "--photons-per-epoch: '1.5'"},
        {"--split-depth 13 tiny.gltf", "--split-depth: '13' is not a whole number from 0 to 12"},
        {"--light-units blendr tiny.gltf", "did you mean 'blender'?"},
        {"--transmission sold tiny.gltf", "did you mean 'solid'?"},
        {"--output '' tiny.gltf", "--output: ''"},
        {"tiny.gltf -o", "--output needs a value"},
        {"--quiet=yes tiny.gltf", "--quiet takes no value"},
    };
    ASSERT_ALL_REFUSED(cases, 1);
}

static void options_that_would_do_nothing_are_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"--env-rotation 90 tiny.gltf", "--env-rotation turns the picture of --env"},
        {"--env-rotation 90 --sun 30,0 tiny.gltf", "--env-rotation turns the picture of --env"},
        {"--env-intensity 2 tiny.gltf", "--env-intensity is about --env and --sun"},
    };
    ASSERT_ALL_REFUSED(cases, 1);
}

static void there_is_exactly_one_input(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"", "no INPUT"},
        {"tiny.gltf other.gltf", "'other.gltf'"},
    };
    ASSERT_ALL_REFUSED(cases, 1);
}

static void names_that_only_the_files_know_are_checked(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"--camera Frnt tiny.gltf", "did you mean 'Front'?"},
        {"--camera 3 tiny.gltf", "no camera '3'; there are 2"},
        {"--camera 0 tiny.gltf", "no camera '0'"},
        {"--view no-such-view tiny.gltf", "no-such-view"},
        {"--display no-such-display tiny.gltf", "no-such-display"},
        {"-o picture.xyz tiny.gltf", "picture.xyz"},
    };
    ASSERT_ALL_REFUSED(cases, 1);
}

static void unusable_inputs_end_with_two(void **state)
{
    (void)state;
    FILE *const broken = fopen("broken.gltf", "w");
    assert_non_null(broken);
    fputs("{\"asset\": {\"version\": ", broken);
    fclose(broken);
    static const refusal cases[] = {
        {"missing.gltf", "missing.gltf"},
        {"broken.gltf", "broken.gltf"},
        {"broken.txt", "broken.txt"},
        {"--ocio missing.ocio tiny.gltf", "missing.ocio"},
        {"--ocio broken.gltf tiny.gltf", "broken.gltf"},
        {"--env missing.hdr tiny.gltf", "missing.hdr"},
    };
    ASSERT_ALL_REFUSED(cases, 2);
}

/* missing.gltf would end with 2: the outputs are checked first */
static void unwritable_outputs_end_with_three_before_anything_is_read(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"-o no/such/folder/a.exr missing.gltf", "no/such/folder/a.exr"},
        {"-o fine.png -o no/such/folder/a.png missing.gltf", "no/such/folder/a.png"},
        {"--stats no/such/folder/a.json missing.gltf", "no/such/folder/a.json"},
        {"--stats . missing.gltf", "cannot write"},
    };
    ASSERT_ALL_REFUSED(cases, 3);
    assert_int_equal(access("fine.png", F_OK), -1);
}

static void help_shows_every_option_and_an_example(void **state)
{
    (void)state;
    static const char *const options[] = {"-o, --output FILE",
                                          "-s, --size WxH",
                                          "-i, --integrator NAME",
                                          "-n, --passes N",
                                          "-t, --time SECONDS",
                                          "-p, --photons N",
                                          "--radius R",
                                          "--alpha A",
                                          "--max-depth N",
                                          "--camera NAME|N",
                                          "--env FILE",
                                          "--env-rotation DEGREES",
                                          "--env-intensity FACTOR",
                                          "--sun ELEVATION,AZIMUTH[,TURBIDITY]",
                                          "--background WHAT",
                                          "--seed N",
                                          "--threads N",
                                          "--exposure EV",
                                          "--display NAME",
                                          "--view NAME",
                                          "--ocio FILE",
                                          "--list-views",
                                          "--stats FILE.json",
                                          "--light-units",
                                          "--transmission",
                                          "--crease DEGREES",
                                          "--unit-scale F",
                                          "--up AXIS",
                                          "--texture-path DIR",
                                          "-q, --quiet",
                                          "-v, --verbose",
                                          "--version",
                                          "-h, --help",
                                          "Example:",
                                          "256",
                                          "1280"};
    const outcome result = run_program("--help");
    assert_int_equal(result.status, 0);
    assert_string_equal(result.err, "");
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++) {
        assert_contains(result.out, options[i]);
    }
    assert_string_equal(run_program("-h").out, result.out);
}

static void version_names_the_build(void **state)
{
    (void)state;
    const outcome result = run_program("--version");
    assert_int_equal(result.status, 0);
    assert_string_equal(result.err, "");
    assert_contains(result.out, "ppm-render 0.");
    assert_contains(result.out, "Embree");
}

static void views_are_listed_without_an_input(void **state)
{
    (void)state;
    const outcome result = run_program("--list-views");
    assert_int_equal(result.status, 0);
    assert_string_equal(result.err, "");
    assert_contains(result.out, "(default)");
    assert_contains(result.out, "ACEScg");
}

static void output_that_cannot_be_shown_is_no_success(void **state)
{
    (void)state;
    assert_int_equal(run_program("--help >/dev/full").status, 3);
    assert_int_equal(run_program("--list-views >/dev/full").status, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control_characters_of_the_command_line_are_shown),
        cmocka_unit_test(control_characters_of_files_that_are_fine_are_shown),
        cmocka_unit_test(denoising_one_pass_is_refused),
        cmocka_unit_test(unknown_options_name_the_nearest),
        cmocka_unit_test(bad_values_name_option_and_value),
        cmocka_unit_test(options_that_would_do_nothing_are_refused),
        cmocka_unit_test(there_is_exactly_one_input),
        cmocka_unit_test(names_that_only_the_files_know_are_checked),
        cmocka_unit_test(unusable_inputs_end_with_two),
        cmocka_unit_test(unwritable_outputs_end_with_three_before_anything_is_read),
        cmocka_unit_test(help_shows_every_option_and_an_example),
        cmocka_unit_test(version_names_the_build),
        cmocka_unit_test(views_are_listed_without_an_input),
        cmocka_unit_test(output_that_cannot_be_shown_is_no_success),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
