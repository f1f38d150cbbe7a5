/* The squared error of the memoryless schedule falls at the rate that theory says, on the caustic
 * box of sample_scenes.
 *
 * After n passes the variance falls as n^-alpha, and the bias, an area's mean over the passes, as
 * n^(alpha - 1) (Knaus and Zwicker 2011, section 4): at alpha = 2 / 3 the squared error has the
 * slope -2 / 3 whichever of the two prevails. What light sampling and the pixel's area add falls
 * faster. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "ppm/import.h"
#include "support/renders.h"
#include "support/scenes.h"

enum { SIDE = 32, FLOATS = 4 * SIDE * SIDE, SEEDS = 6, STEPS = 5, FIRST = 16 };

static test_scene test;
static ppm_camera_id camera;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    const char *path = PPM_SOURCE_DIR "/sample_scenes/caustic_box.glb";
    assert_int_equal(ppm_scene_import(test.scene, path, NULL), PPM_STATUS_OK);
    /* the floor under the glass ball with the caustic; nothing stands between */
    camera = camera_orthographic(test.scene, vec3(0.05f, 0.1f, 0.5f), vec3(0.05f, 0, 0.5f), 0.35f);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static const float first_radius = 0.05f;

/* A third of the radius, a ninth of the bias; and so many photons that its noise is small even
 * against the last step's. */
static float *render_reference(void)
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, SIDE, TEST_EFFORT(250000));
    options.schedule = PPM_SCHEDULE_MEMORYLESS;
    options.direct = PPM_DIRECT_PHOTONS; /* all light has the error in question */
    options.camera = camera;
    options.radius_m = first_radius / 3.0f;
    options.alpha = 1.0f;
    options.seed = 99;
    return render_picture(test.scene, &options, 16);
}

static double squared_error(const float *a, const float *b)
{
    double sum = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        for (int k = 0; k < 3; k++) {
            const double off = (double)(a[4 * i + k] - b[4 * i + k]);
            sum += off * off;
        }
    }
    return sum / (3 * SIDE * SIDE);
}

/* Adds the errors after FIRST, 2 FIRST, 4 FIRST, ... passes of one render. */
static void add_errors(uint64_t seed, const float *reference, double errors[STEPS])
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, SIDE, 1500);
    options.schedule = PPM_SCHEDULE_MEMORYLESS;
    options.direct = PPM_DIRECT_PHOTONS; /* all light has the error in question */
    options.camera = camera;
    options.radius_m = first_radius;
    options.alpha = 2.0f / 3.0f;
    options.seed = seed;
    ppm_render *render = NULL;
    static float rgba[FLOATS];
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    for (int step = 0, pass = 0; step < STEPS; step++) {
        for (; pass < FIRST << step; pass++)
            assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
        assert_int_equal(ppm_render_read_image(render, rgba, FLOATS), PPM_STATUS_OK);
        errors[step] += squared_error(rgba, reference) / SEEDS;
    }
    ppm_render_destroy(render);
}

/* Least squares over the logarithms, base 2. */
static double slope_of(const double errors[STEPS])
{
    double sum_xy = 0.0, sum_xx = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double x = i - 0.5 * (STEPS - 1);
        sum_xy += x * log2(errors[i]);
        sum_xx += x * x;
    }
    return sum_xy / sum_xx;
}

static void the_squared_error_falls_as_theory_says(void **state)
{
    (void)state;
    float *reference = render_reference();
    double errors[STEPS] = {0.0};
    for (uint64_t seed = 1; seed <= SEEDS; seed++)
        add_errors(seed, reference, errors);
    free(reference);
    const double slope = slope_of(errors);
    /* with a reference of few photons only the direction is told */
    const double least = TEST_EFFORT_PERCENT < 100 ? 0.0 : 0.55;
    if (!(slope < -least && slope > -0.8)) {
        fail_msg("slope %.3f over %d .. %d passes: errors %.3g %.3g %.3g %.3g %.3g", slope, FIRST,
                 FIRST << (STEPS - 1), errors[0], errors[1], errors[2], errors[3], errors[4]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_squared_error_falls_as_theory_says, open_scene,
                                        close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
