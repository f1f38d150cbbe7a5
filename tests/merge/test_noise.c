/* Renders with different seeds, merged: the noise falls as that of independent samples does. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cli/program.h"
#include "imageio/imageio.h"
#include "ppm/ppm.h"
#include "support/renders.h"
#include "support/scenes.h"

enum { SIDE = 16, VALUES = 4 * SIDE * SIDE, PASSES = 8, PAIRS = 6 };

static test_scene test;

/* A floor under a lamp and a sky. */
static int scene_setup(void **state)
{
    if (folder_setup(state) != 0) return -1;
    scene_open(&test);
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    add_quad(test.scene, grey, vec3(-4, -4, 0), vec3(8, 0, 0), vec3(0, 8, 0));
    camera_perspective(test.scene, vec3(0, 0, 3), vec3(0, 0, 0), 0.8f);
    light_point(test.scene, vec3(1, 1, 1), vec3(3, 3, 3));
    light_environment(test.scene, vec3(0.3f, 0.3f, 0.3f), 0, 0);
    return 0;
}

static int scene_teardown(void **state)
{
    scene_close(&test);
    return folder_teardown(state);
}

static void write_render(const char *path, int32_t integrator, uint64_t seed, uint32_t passes)
{
    ppm_render_options options = render_options(integrator, SIDE, 500);
    options.seed = seed;
    options.direct = PPM_DIRECT_PHOTONS; /* else photons would have nothing to do here */
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    for (uint32_t i = 0; i < passes; i++)
        assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
    assert_int_equal(ppm_render_write(render, NULL, path, NULL), PPM_STATUS_OK);
    ppm_render_destroy(render);
}

static void read_render(const char *path, float rgba[VALUES])
{
    ppmi_pixels pixels = {0};
    assert_int_equal(ppmi_imageio_read_file(NULL, path, path, &pixels), PPM_STATUS_OK);
    assert_int_equal(pixels.channels, 4);
    memcpy(rgba, pixels.f32, VALUES * sizeof *rgba);
    ppmi_imageio_pixels_free(NULL, &pixels);
}

static void merge_two(void)
{
    const outcome result = run_program("-q -o all.exr a.exr b.exr");
    if (result.status != 0) fail_msg("status %d: %s", result.status, result.err);
}

static double squared_error(const float *rgba, const float *reference)
{
    double sum = 0;
    for (int i = 0; i < VALUES; i++) {
        const double error = (double)rgba[i] - (double)reference[i];
        sum += error * error;
    }
    return sum;
}

static void paths_merge_to_the_mean_of_all_passes(void **state)
{
    (void)state;
    static float a[VALUES], b[VALUES], all[VALUES];
    write_render("a.exr", PPM_INTEGRATOR_PATH, 1, 3);
    write_render("b.exr", PPM_INTEGRATOR_PATH, 2, 5);
    merge_two();
    read_render("a.exr", a);
    read_render("b.exr", b);
    read_render("all.exr", all);
    for (int i = 0; i < VALUES; i++) {
        const double sum = 3 * (double)a[i] + 5 * (double)b[i];
        assert_true(fabs(8 * (double)all[i] - sum) <= 1e-6 * fabs(sum));
    }
}

/* The mean of two independent errors of equal variance has half of it. The logarithm of the ratio
 * of squared errors, pair by pair, is to be that of one half; the reference's own error, a 64th of
 * one render's, raises the ratio to (1/2 + 1/64) / (1 + 1/64) = 0.508. */
static void assert_error_is_halved(int32_t integrator)
{
    static float reference[VALUES], a[VALUES], b[VALUES], all[VALUES];
    test_family family = {0};
    test_mean logarithm = {0};
    write_render("reference.exr", integrator, 1000, 64 * PASSES);
    read_render("reference.exr", reference);
    for (uint64_t pair = 0; pair < PAIRS; pair++) {
        write_render("a.exr", integrator, 2 * pair + 1, PASSES);
        write_render("b.exr", integrator, 2 * pair + 2, PASSES);
        merge_two();
        read_render("a.exr", a);
        read_render("b.exr", b);
        read_render("all.exr", all);
        const double one = 0.5 * (squared_error(a, reference) + squared_error(b, reference));
        assert_true(one > 0);
        mean_add(&logarithm, log(squared_error(all, reference) / one));
    }
    print_message("squared error of two: %.4f of that of one, +- %.1f %%\n", exp(logarithm.mean),
                  100 * mean_error(&logarithm));
    family_add_mean(&family, &logarithm, log(0.5), log(0.508 / 0.5), "squared error");
    family_check(&family);
    /* and it is far from that of one */
    if (logarithm.mean > log(0.7)) fail_msg("the error falls by %g only", exp(logarithm.mean));
}

static void two_renders_of_paths_have_half_the_squared_error(void **state)
{
    (void)state;
    assert_error_is_halved(PPM_INTEGRATOR_PATH);
}

static void two_renders_of_photons_have_half_the_squared_error(void **state)
{
    (void)state;
    assert_error_is_halved(PPM_INTEGRATOR_SPPM);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_merge_to_the_mean_of_all_passes),
        cmocka_unit_test(two_renders_of_paths_have_half_the_squared_error),
        cmocka_unit_test(two_renders_of_photons_have_half_the_squared_error),
    };
    return cmocka_run_group_tests(tests, scene_setup, scene_teardown);
}
