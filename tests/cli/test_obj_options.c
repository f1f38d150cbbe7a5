/* What is said for an OBJ on the command line, as its format does not: --unit-scale, --up,
 * --crease, --line-radius, --texture-path. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "cli/program.h"
#include "imageio/imageio.h"

#define QUICK "-s 32x32 -n 1 -p 1k -i path "

static bool write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (!file) return false;
    fputs(text, file);
    return fclose(file) == 0;
}

static int setup(void **state)
{
    if (folder_setup(state) != 0 || mkdir("textures", 0700) != 0) return -1;
    const bool ok =
        write_text("roof.obj", "mtllib roof.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\n"
                               "v 0 0 1\nv 0 2 1\nvt 0 0\nf 1/1 2/1 3/1 4/1\nf 1/1 4/1 6/1 5/1\n"
                               "l 1 3\n") &&
        write_text("roof.mtl", "newmtl m\nmap_Kd C:\\maps\\paint.ppm\n") &&
        write_text("textures/paint.ppm", "P6 1 1 255\nabc");
    return ok ? 0 : -1;
}

static outcome run_well(const char *arguments)
{
    const outcome result = run_program(arguments);
    if (result.status != 0) fail_msg("%s\nstatus %d: %s", arguments, result.status, result.err);
    return result;
}

/* Whether an option changes the picture. */
static bool changes_the_picture(const char *option)
{
    char arguments[256];
    ppmi_pixels a = {0}, b = {0};
    snprintf(arguments, sizeof arguments, QUICK "-o with.exr %s roof.obj", option);
    run_well(arguments);
    run_well(QUICK "-o without.exr roof.obj");
    assert_int_equal(ppmi_imageio_read_file(NULL, "with.exr", "with", &a), PPM_STATUS_OK);
    assert_int_equal(ppmi_imageio_read_file(NULL, "without.exr", "without", &b), PPM_STATUS_OK);
    const size_t size = (size_t)a.width * a.height * a.channels * sizeof *a.f32;
    const bool differs = memcmp(a.f32, b.f32, size) != 0;
    ppmi_imageio_pixels_free(NULL, &a);
    ppmi_imageio_pixels_free(NULL, &b);
    return differs;
}

static void bad_values_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"--crease 0 roof.obj", "--crease: '0'"},
        {"--crease 181 roof.obj", "--crease: '181'"},
        {"--unit-scale 0 roof.obj", "--unit-scale: '0'"},
        {"--unit-scale cm roof.obj", "--unit-scale: 'cm'"},
        {"--up x roof.obj", "--up: 'x' is not one of y, z"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const outcome result = run_program(cases[i][0]);
        assert_int_equal(result.status, 1);
        assert_contains(result.err, cases[i][1]);
    }
}

static void each_option_changes_the_picture(void **state)
{
    (void)state;
    assert_true(changes_the_picture("--crease 100"));
    assert_true(changes_the_picture("--up z"));
    assert_true(changes_the_picture("--line-radius 0.1"));
    assert_true(changes_the_picture("--texture-path textures"));
    assert_false(changes_the_picture("--up y --crease 80")); /* the roof bends by 90 degrees */
}

/* The picture frames the model, so a scale shows only in what is in metres. */
static void the_unit_scales_the_scene(void **state)
{
    (void)state;
    const outcome far = run_well(QUICK "-o a.exr --aperture 8 roof.obj");
    const outcome near = run_well(QUICK "-o a.exr --aperture 8 --unit-scale 0.001 roof.obj");
    const char *const metres[2] = {strstr(far.err, "focus"), strstr(near.err, "focus")};
    double distances[2];
    for (int i = 0; i < 2; i++) {
        assert_non_null(metres[i]);
        const char *digits = metres[i] + strcspn(metres[i], "0123456789");
        distances[i] = strtod(digits, NULL);
    }
    const double ratio = distances[0] / distances[1];
    if (!(ratio > 990.0 && ratio < 1010.0)) {
        fail_msg("%g m and %g m", distances[0], distances[1]);
    }
}

static void texture_paths_are_searched_in_their_order(void **state)
{
    (void)state;
    assert_contains(run_well(QUICK "-o a.exr roof.obj").err, "nor in a texture path");
    const outcome found =
        run_well(QUICK "-o a.exr --texture-path nowhere --texture-path=textures roof.obj");
    assert_contains(found.err,
                    "line 2: map_Kd 'C:\\maps\\paint.ppm': read from textures/paint.ppm");
}

static void a_gltf_file_is_told_that_they_do_not_apply(void **state)
{
    (void)state;
    static const char *const options[] = {"--crease 30", "--unit-scale 2", "--up z",
                                          "--texture-path textures"};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++) {
        char arguments[128];
        snprintf(arguments, sizeof arguments, "--list %s tiny.gltf", options[i]);
        assert_contains(run_well(arguments).err, "are for OBJ files and have no effect");
    }
}

static void nodes_are_listed_with_what_they_hold(void **state)
{
    (void)state;
    const outcome list = run_well("--list roof.obj");
    assert_contains(list.out, "1  roof  2 faces, 1 segment");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(each_option_changes_the_picture),
        cmocka_unit_test(the_unit_scales_the_scene),
        cmocka_unit_test(texture_paths_are_searched_in_their_order),
        cmocka_unit_test(a_gltf_file_is_told_that_they_do_not_apply),
        cmocka_unit_test(nodes_are_listed_with_what_they_hold),
    };
    return cmocka_run_group_tests(tests, setup, folder_teardown);
}
