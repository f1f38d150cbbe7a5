/* FLIP of pictures whose error is known. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare/flip.h"
#include "compare/opponent.h"
#include "support/near.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE };

static ppm_context *context;
static float test[3 * PIXELS], reference[3 * PIXELS], errors[PIXELS];

static int setup(void **state)
{
    (void)state;
    return ppm_context_create(NULL, &context) == PPM_STATUS_OK ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    return live == 0 ? 0 : -1;
}

static void fill(float *picture, float red, float green, float blue)
{
    for (int i = 0; i < PIXELS; i++) {
        picture[3 * i] = red;
        picture[3 * i + 1] = green;
        picture[3 * i + 2] = blue;
    }
}

/* Patterns that are rich in edges, points and colours, in code values of a display. */
static void fill_patterns(void)
{
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            float *const r = reference + 3 * (y * SIDE + x), *const t = test + 3 * (y * SIDE + x);
            r[0] = (float)((x * 7 + y * 13) % 32) / 31,
            t[0] = (float)((x * 7 + y * 13 + 4) % 32) / 31;
            r[1] = (float)((x * 5 + y * 3) % 16) / 15,
            t[1] = (float)((x * 5 + y * 3 + 2) % 16) / 15;
            r[2] = (float)((x + y * 11) % 8) / 7, t[2] = (float)((x + y * 11 + (x > 12)) % 8) / 7;
        }
    }
    for (int i = 0; i < 3 * PIXELS; i++) {
        reference[i] = ppmi_compare_srgb_decode(reference[i]);
        test[i] = ppmi_compare_srgb_decode(test[i]);
    }
}

static double flip_ldr(double pixels_per_degree)
{
    ppmi_compare_flip *flip = NULL;
    assert_int_equal(ppmi_compare_flip_create(context, SIDE, SIDE, pixels_per_degree, &flip),
                     PPM_STATUS_OK);
    ppmi_compare_flip_ldr(flip, test, reference, errors);
    ppmi_compare_flip_destroy(flip);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += (double)errors[i];
    return sum / PIXELS;
}

static void equal_pictures_have_no_error(void **state)
{
    (void)state;
    fill_patterns();
    memcpy(test, reference, sizeof test);
    assert_near(flip_ldr(67), 0, 0);
}

/* Without features the error is that of the colours: HyAB 100, to the power of 0.7, above the knee
 * of the largest (Hunt-adjusted green to blue in CIELAB: 87.73, -75.61, 72.98; 32.30, 25.58,
 * -34.84). */
static void black_against_white_is_what_the_formulas_say(void **state)
{
    (void)state;
    fill(test, 0, 0, 0);
    fill(reference, 1, 1, 1);
    const double largest = pow(55.43 + hypot(101.19, 107.82), 0.7), knee = 0.4 * largest;
    const double expected = 0.95 + 0.05 * (pow(100, 0.7) - knee) / (largest - knee);
    assert_true(expected > 0.96 && expected < 0.97);
    assert_near(flip_ldr(67), expected, 1e-4);
}

static void green_against_blue_is_the_largest_error(void **state)
{
    (void)state;
    fill(test, 0, 1, 0);
    fill(reference, 0, 0, 1);
    assert_near(flip_ldr(67), 1, 1e-5);
}

/* Greys have no a and b: HyAB is the difference of L = 116 cbrt(Y) - 16. */
static void small_grey_differences_follow_the_formula(void **state)
{
    (void)state;
    fill(test, 0.2f, 0.2f, 0.2f);
    fill(reference, 0.25f, 0.25f, 0.25f);
    const double distance = 116 * (cbrt(0.25) - cbrt(0.2));
    const double knee = 0.4 * pow(55.43 + hypot(101.19, 107.82), 0.7);
    assert_near(flip_ldr(67), 0.95 * pow(distance, 0.7) / knee, 1e-3);
}

static void order_of_the_pictures_does_not_matter(void **state)
{
    (void)state;
    fill_patterns();
    flip_ldr(67);
    float forward[PIXELS], kept[3 * PIXELS];
    memcpy(forward, errors, sizeof errors);
    memcpy(kept, test, sizeof test);
    memcpy(test, reference, sizeof test);
    memcpy(reference, kept, sizeof test);
    flip_ldr(67);
    for (int i = 0; i < PIXELS; i++)
        assert_near(errors[i], forward[i], 0);
}

/* Expected values: the paper's formulas written down once more, with square kernels and in double
 * precision, in another language. */
static void patterns_agree_with_a_dense_evaluation(void **state)
{
    (void)state;
    static const struct {
        double density, mean, first, middle, last;
    } cases[] = {{67, 0.269810270, 0.405937924, 0.319986340, 0.562257165},
                 {20, 0.647562155, 0.513803140, 0.532541963, 0.985362202}};
    for (size_t i = 0; i < 2; i++) {
        fill_patterns();
        assert_near(flip_ldr(cases[i].density), cases[i].mean, 1e-4);
        assert_near(errors[0], cases[i].first, 3e-4);
        assert_near(errors[12 * SIDE + 13], cases[i].middle, 3e-4);
        assert_near(errors[23 * SIDE + 5], cases[i].last, 3e-4);
    }
}

/* From afar, a checkerboard one pixel wide is the grey of the same light. */
static void patterns_too_fine_to_see_hardly_count(void **state)
{
    (void)state;
    for (int i = 0; i < PIXELS; i++) {
        const float value = (i % SIDE + i / SIDE) % 2 ? 0.6f : 0.4f;
        for (int c = 0; c < 3; c++)
            test[3 * i + c] = value;
    }
    fill(reference, 0.5f, 0.5f, 0.5f);
    flip_ldr(67);
    assert_true(errors[12 * SIDE + 12] < 0.05f);
    const float near = errors[12 * SIDE + 12];
    flip_ldr(10);
    assert_true(errors[12 * SIDE + 12] > 3 * near);
}

static void one_pixel_is_a_picture_too(void **state)
{
    (void)state;
    ppmi_compare_flip *flip = NULL;
    const float black[3] = {0}, white[3] = {1, 1, 1};
    float error = 0;
    assert_int_equal(ppmi_compare_flip_create(context, 1, 1, 67, &flip), PPM_STATUS_OK);
    ppmi_compare_flip_ldr(flip, black, white, &error);
    ppmi_compare_flip_destroy(flip);
    assert_true(error > 0.96f && error < 0.97f);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    for (size_t n = 1; n <= 2; n++) {
        ppmi_compare_flip *flip = NULL;
        ppmi_alloc_fail_at(context, n);
        assert_int_equal(ppmi_compare_flip_create(context, SIDE, SIDE, 67, &flip),
                         PPM_STATUS_OUT_OF_MEMORY);
        assert_null(flip);
        assert_int_equal(ppmi_alloc_live(context), 0);
    }
    ppmi_alloc_fail_at(context, 0);
}

/* ---- HDR ------------------------------------------------------------------------------------- */

static ppmi_compare_exposures exposures_of_reference(void)
{
    float sorted[PIXELS];
    return ppmi_compare_find_exposures(reference, PIXELS, sorted);
}

static double flip_hdr(const ppmi_compare_exposures *exposures)
{
    ppmi_compare_flip *flip = NULL;
    assert_int_equal(ppmi_compare_flip_create(context, SIDE, SIDE, 67, &flip), PPM_STATUS_OK);
    assert_int_equal(ppmi_compare_flip_hdr(flip, test, reference, exposures, errors),
                     PPM_STATUS_OK);
    ppmi_compare_flip_destroy(flip);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += (double)errors[i];
    return sum / PIXELS;
}

static void exposures_show_the_brightest_and_the_median_at_0_85(void **state)
{
    (void)state;
    fill(reference, 0.5f, 0.5f, 0.5f);
    for (int c = 0; c < 3; c++)
        reference[c] = 32;
    const ppmi_compare_exposures range = exposures_of_reference();
    assert_near(ppmi_compare_tone_map((float)(32 * exp2(range.start_ev))), 0.85, 1e-5);
    assert_near(ppmi_compare_tone_map((float)(0.5 * exp2(range.stop_ev))), 0.85, 1e-5);
    assert_near(range.stop_ev - range.start_ev, 6, 1e-5);
    assert_true(range.count == 6 || range.count == 7); /* the ceiling of a rounded 6 */
}

static void a_median_of_black_is_that_of_the_rest(void **state)
{
    (void)state;
    fill(reference, 0, 0, 0);
    for (int i = 0; i < 3 * 101; i++)
        reference[i] = i < 3 ? 8.0f : 2.0f;
    const ppmi_compare_exposures range = exposures_of_reference();
    assert_near(ppmi_compare_tone_map((float)(2 * exp2(range.stop_ev))), 0.85, 1e-5);
    fill(reference, 0, 0, 0);
    assert_int_equal(exposures_of_reference().count, 1);
}

static void the_largest_float_is_a_light_too(void **state)
{
    (void)state;
    fill(reference, 0.5f, 0.5f, 0.5f);
    reference[0] = reference[1] = reference[2] = FLT_MAX;
    const ppmi_compare_exposures range = exposures_of_reference();
    assert_near(range.start_ev + 127, 0, 2);
    assert_true(range.count > 100 && range.count < 140);
}

static void tone_curve_rises_from_black_to_white(void **state)
{
    (void)state;
    assert_near(ppmi_compare_tone_map(0), 0, 0);
    assert_near(ppmi_compare_tone_map(-1), 0, 0);
    assert_near(ppmi_compare_tone_map(3e38f), 1, 0);
    for (float light = 1e-4f; light < 100; light *= 2)
        assert_true(ppmi_compare_tone_map(2 * light) >= ppmi_compare_tone_map(light));
}

static void equal_light_has_no_error(void **state)
{
    (void)state;
    fill_patterns();
    for (int i = 0; i < 3 * PIXELS; i++)
        test[i] = reference[i] *= 1000;
    const ppmi_compare_exposures range = exposures_of_reference();
    assert_near(flip_hdr(&range), 0, 0);
}

/* Both above a display's white: one exposure sees no difference, HDR-FLIP does. */
static void differences_in_highlights_are_seen(void **state)
{
    (void)state;
    fill(test, 20, 20, 20);
    fill(reference, 80, 80, 80);
    assert_near(flip_ldr(67), 0, 0);
    const ppmi_compare_exposures range = exposures_of_reference();
    assert_true(flip_hdr(&range) > 0.3);
}

static void brighter_light_alone_changes_nothing(void **state)
{
    (void)state;
    fill_patterns();
    ppmi_compare_exposures range = exposures_of_reference();
    const double before = flip_hdr(&range);
    for (int i = 0; i < 3 * PIXELS; i++) {
        test[i] *= 1024;
        reference[i] *= 1024;
    }
    range = exposures_of_reference();
    assert_near(flip_hdr(&range), before, 1e-5);
    assert_true(before > 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_have_no_error),
        cmocka_unit_test(black_against_white_is_what_the_formulas_say),
        cmocka_unit_test(green_against_blue_is_the_largest_error),
        cmocka_unit_test(small_grey_differences_follow_the_formula),
        cmocka_unit_test(order_of_the_pictures_does_not_matter),
        cmocka_unit_test(patterns_agree_with_a_dense_evaluation),
        cmocka_unit_test(patterns_too_fine_to_see_hardly_count),
        cmocka_unit_test(one_pixel_is_a_picture_too),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(exposures_show_the_brightest_and_the_median_at_0_85),
        cmocka_unit_test(a_median_of_black_is_that_of_the_rest),
        cmocka_unit_test(the_largest_float_is_a_light_too),
        cmocka_unit_test(tone_curve_rises_from_black_to_white),
        cmocka_unit_test(equal_light_has_no_error),
        cmocka_unit_test(differences_in_highlights_are_seen),
        cmocka_unit_test(brighter_light_alone_changes_nothing),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
