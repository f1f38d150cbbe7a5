/* How far a picture is from middle grey. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../src/cli/brightness.h"

static void middle_grey_is_no_stops_away(void **state)
{
    (void)state;
    const float grey[4] = {0.18f, 0.18f, 0.18f, 1.0f};
    assert_true(fabs(brightness_stops_over_grey(grey, 1)) < 1e-5);
}

static void stops_are_averaged(void **state)
{
    (void)state;
    const float pixels[8] = {0.36f, 0.36f, 0.36f, 1.0f, 1.44f, 1.44f, 1.44f, 1.0f}; /* 1 and 3 */
    assert_true(fabs(brightness_stops_over_grey(pixels, 2) - 2.0) < 1e-5);
}

static void black_clear_and_broken_pixels_do_not_count(void **state)
{
    (void)state;
    const float pixels[16] = {0.0f, 0.0f,     0.0f, 1.0f, 1.0f,  1.0f,  1.0f,  0.0f,
                              1.0f, INFINITY, 1.0f, 1.0f, 0.72f, 0.72f, 0.72f, 1.0f};
    assert_true(fabs(brightness_stops_over_grey(pixels, 4) - 2.0) < 1e-5);
    assert_true(isnan(brightness_stops_over_grey(pixels, 3)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(middle_grey_is_no_stops_away),
        cmocka_unit_test(stops_are_averaged),
        cmocka_unit_test(black_clear_and_broken_pixels_do_not_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
