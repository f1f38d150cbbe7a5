/* ppm-compare as a script would use it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <jansson.h>
#include <unistd.h>

#include "cli/program.h"
#include "imageio/imageio.h"
#include "support/near.h"

enum { SIDE = 16, LARGE = 80 }; /* large: enough for several threads */

static void write_picture(ppm_context *context, const char *path, uint32_t side, float value,
                          float first)
{
    static float pixels[3 * LARGE * LARGE];
    for (size_t i = 0; i < 3 * (size_t)side * side; i++)
        pixels[i] = i < 3 ? first : value;
    const bool is_light = strstr(path, ".exr") != NULL;
    const ppmi_image_file file = {.width = side,
                                  .height = side,
                                  .channels = 3,
                                  .pixels = pixels,
                                  .store = is_light ? PPMI_STORE_FLOAT : PPMI_STORE_U8};
    assert_int_equal(ppmi_imageio_write_file(context, path, &file), PPM_STATUS_OK);
}

static int pictures_setup(void **state)
{
    ppm_context *context = NULL;
    if (folder_setup(state) != 0) return -1;
    if (ppm_context_create(NULL, &context) != PPM_STATUS_OK) return -1;
    write_picture(context, "a.exr", SIDE, 0.5f, 0.5f);
    write_picture(context, "b.exr", SIDE, 0.6f, 0.6f);
    write_picture(context, "nan.exr", SIDE, 0.5f, NAN);
    write_picture(context, "firefly.exr", SIDE, 0.5f, 100);
    write_picture(context, "small.exr", 8, 0.5f, 0.5f);
    write_picture(context, "large.exr", LARGE, 0.5f, 0.5f);
    write_picture(context, "large-firefly.exr", LARGE, 0.6f, 100);
    write_picture(context, "black.png", SIDE, 0, 0);
    write_picture(context, "white.png", SIDE, 1, 1);
    ppm_context_destroy(context);
    return 0;
}

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

static void wrong_usage_is_explained(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"--trm 0.1 a.exr b.exr", "unknown option '--trm'; did you mean '--trim'?"},
        {"--expo 1 a.exr b.exr", "unknown option '--expo'; did you mean '--exposure'?"},
        {"-Z a.exr b.exr", "unknown option '-Z'"},
        {"--trim 1 a.exr b.exr", "--trim: '1' is not a number from 0 to 0.999"},
        {"--ppd 0 a.exr b.exr", "--ppd: '0'"},
        {"--peak nan a.exr b.exr", "--peak: 'nan'"},
        {"--json=1 a.exr b.exr", "--json takes no value"},
        {"a.exr b.exr --trim", "--trim needs a value"},
        {"--heat h.png --heat-of flop a.exr b.exr", "did you mean 'flip'?"},
        {"--heat-top 2 a.exr b.exr", "need --heat FILE"},
        {"--fail-above flop=1 a.exr b.exr", "did you mean 'flip'?"},
        {"--fail-above flip a.exr b.exr", "like flip=0.05"},
        {"--fail-above flip=-1 a.exr b.exr", "like flip=0.05"},
        {"--fail-above psnr=30 a.exr b.exr", "take mse"},
        {"--heat h.xyz a.exr b.exr", "h.xyz: pictures can be written as"},
        {"", "TEST and REFERENCE; there are 0"},
        {"a.exr", "there is 1"},
        {"a.exr b.exr a.exr", "there are 3"},
    };
    ASSERT_ALL_REFUSED(cases, 1);
}

static void unusable_inputs_end_with_two(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"none.exr a.exr", "none.exr: cannot be opened"},
        {"a.exr tiny.gltf", "tiny.gltf: not a known image format"},
        {"a.exr small.exr", "small.exr has 8 x 8"},
    };
    ASSERT_ALL_REFUSED(cases, 2);
}

static void a_heat_map_that_cannot_be_written_ends_with_three_at_once(void **state)
{
    (void)state;
    static const refusal cases[] = {{"--heat none/h.png none.exr a.exr", "none/h.png"}};
    ASSERT_ALL_REFUSED(cases, 3);
}

static void output_that_cannot_be_shown_is_no_success(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) != 0) skip();
    assert_int_equal(run_program("a.exr b.exr >/dev/full").status, 3);
}

static void help_and_version_are_shown(void **state)
{
    (void)state;
    const outcome help = run_program("--help"), version = run_program("--version");
    assert_int_equal(help.status, 0);
    assert_contains(help.out, "Usage: ppm-compare [options] TEST REFERENCE");
    assert_contains(help.out, "--fail-above METRIC=X");
    assert_int_equal(version.status, 0);
    assert_contains(version.out, "ppm-compare 0.");
}

static void differences_alone_are_no_failure(void **state)
{
    (void)state;
    const outcome result = run_program("a.exr b.exr");
    assert_int_equal(result.status, 0);
    assert_string_equal(result.err, "");
    assert_contains(result.out, "pixels        256 of 16 x 16\n");
    assert_contains(result.out, "MSE           0.01\n");
    assert_contains(result.out, "PSNR          15.5630 dB  (peak 0.6)"); /* 20 log10 6 */
}

static void display_pictures_get_ldr_flip(void **state)
{
    (void)state;
    const outcome result = run_program("black.png white.png");
    assert_int_equal(result.status, 0);
    assert_contains(result.out, "PSNR          0.0000 dB  (peak 1)");
    assert_contains(result.out, "(LDR, 67 pixels per degree;");
}

static json_t *run_json(const char *arguments)
{
    const outcome result = run_program(arguments);
    assert_int_equal(result.status, 0);
    json_t *const root = json_loads(result.out, 0, NULL);
    if (!root) fail_msg("no JSON: %s", result.out);
    return root;
}

static void json_has_the_numbers(void **state)
{
    (void)state;
    json_t *const root = run_json("--json --trim 0.01 firefly.exr a.exr");
    const json_t *const area = json_object_get(root, "area");
    assert_int_equal(json_integer_value(json_object_get(area, "trimmed")), 2);
    assert_near(json_real_value(json_object_get(root, "mse")), 0, 0);
    assert_true(json_is_null(json_object_get(root, "psnr_db"))); /* infinite */
    const json_t *const flip = json_object_get(root, "flip");
    assert_string_equal(json_string_value(json_object_get(flip, "kind")), "HDR");
    assert_true(json_real_value(json_object_get(flip, "mean")) > 0);
    json_decref(root);
}

static void pixels_that_are_no_numbers_are_reported(void **state)
{
    (void)state;
    const outcome result = run_program("nan.exr a.exr");
    assert_int_equal(result.status, 0);
    assert_contains(result.out, "broken        1 pixels left out: 1 of TEST, 0 of REFERENCE");
    assert_contains(result.out, "MSE           0\n");
    assert_contains(result.out, "FLIP          0 ");
}

static void limits_end_with_five(void **state)
{
    (void)state;
    assert_int_equal(run_program("--fail-above mse=0.02 a.exr b.exr").status, 0);
    assert_int_equal(run_program("--fail-above flip=0 a.exr a.exr").status, 0);
    const outcome above = run_program("--fail-above mse=0.005 --fail-above relmse=9 a.exr b.exr");
    assert_int_equal(above.status, 5);
    assert_contains(above.err, "ppm-compare: mse is 0.01, above 0.005");
    assert_contains(above.out, "MSE");
    assert_int_equal(run_program("--fail-above broken=0 nan.exr a.exr").status, 5);
    assert_int_equal(run_program("--fail-above relmse=0.01 a.exr b.exr").status, 5);
    assert_int_equal(run_program("--fail-above flip=0.001 a.exr b.exr").status, 5);
}

static void threads_do_not_change_a_digit(void **state)
{
    (void)state;
    setenv("OMP_NUM_THREADS", "1", 1);
    setenv("OMP_WAIT_POLICY", "passive", 1); /* more threads than processors must not spin */
    char *const one = strdup(run_program("--json large-firefly.exr large.exr").out);
    setenv("OMP_NUM_THREADS", "3", 1);
    const outcome three = run_program("--json large-firefly.exr large.exr");
    unsetenv("OMP_NUM_THREADS");
    unsetenv("OMP_WAIT_POLICY");
    assert_contains(one, "largest");
    assert_string_equal(one, three.out);
    free(one);
}

static void read_back(const char *path, ppmi_pixels *pixels)
{
    assert_int_equal(ppmi_imageio_read_file(NULL, path, path, pixels), PPM_STATUS_OK);
    assert_int_equal(pixels->width, SIDE);
    assert_int_equal(pixels->height, SIDE);
}

static void heat_maps_show_where(void **state)
{
    (void)state;
    assert_int_equal(run_program("--heat h.exr --heat-of squared firefly.exr a.exr").status, 0);
    ppmi_pixels pixels;
    read_back("h.exr", &pixels);
    assert_int_equal(pixels.channels, 1);
    assert_near(pixels.f32[0], 99.5 * 99.5, 1e-2);
    assert_near(pixels.f32[1], 0, 0);
    ppmi_imageio_pixels_free(NULL, &pixels);

    assert_int_equal(run_program("--heat h.png --heat-of relative nan.exr b.exr").status, 0);
    read_back("h.png", &pixels);
    const uint8_t green[3] = {0, 255, 0}, top[3] = {252, 253, 191};
    assert_memory_equal(pixels.u8, green, 3);
    assert_memory_equal(pixels.u8 + 3, top, 3); /* the same error in all others */
    ppmi_imageio_pixels_free(NULL, &pixels);
}

static void control_characters_of_names_are_shown(void **state)
{
    (void)state;
    static const char *const cases[] = {"\"$E.exr\" \"$E.exr\"", "--heat \"no/$E.png\" a.exr b.exr",
                                        "--\"$E\"", "--trim \"$E\" a b"};
    setenv("E", "\x1b[2Jx", 1);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const outcome result = run_program(cases[i]);
        if (result.status == 0 || strchr(result.err, '\x1b') || !strstr(result.err, "\\x1b[2Jx")) {
            fail_msg("%s\nstatus %d, said: %s", cases[i], result.status, result.err);
        }
    }
    unsetenv("E");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control_characters_of_names_are_shown),
        cmocka_unit_test(wrong_usage_is_explained),
        cmocka_unit_test(unusable_inputs_end_with_two),
        cmocka_unit_test(a_heat_map_that_cannot_be_written_ends_with_three_at_once),
        cmocka_unit_test(output_that_cannot_be_shown_is_no_success),
        cmocka_unit_test(help_and_version_are_shown),
        cmocka_unit_test(differences_alone_are_no_failure),
        cmocka_unit_test(display_pictures_get_ldr_flip),
        cmocka_unit_test(json_has_the_numbers),
        cmocka_unit_test(pixels_that_are_no_numbers_are_reported),
        cmocka_unit_test(limits_end_with_five),
        cmocka_unit_test(threads_do_not_change_a_digit),
        cmocka_unit_test(heat_maps_show_where),
    };
    return cmocka_run_group_tests(tests, pictures_setup, folder_teardown);
}
