/* The colours of heat maps. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare/heat.h"
#include "support/near.h"

static void heat_gets_lighter_all_the_way(void **state)
{
    (void)state;
    double before = -1;
    for (int i = 0; i <= 100; i++) {
        float rgb[3];
        ppmi_compare_heat_colour(i / 100.0, rgb);
        const double lightness =
            0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
        assert_true(lightness > before);
        before = lightness;
    }
}

static void heat_ends_where_its_range_ends(void **state)
{
    (void)state;
    float inside[3], outside[3];
    ppmi_compare_heat_colour(1, inside);
    ppmi_compare_heat_colour(7, outside);
    assert_memory_equal(inside, outside, sizeof inside);
    assert_near(inside[0], 0.987053, 1e-6);
    ppmi_compare_heat_colour(-1, outside);
    assert_near(outside[2], 0.013866, 1e-6);
}

static void top_of_heat_is_a_percentile_of_whole_pixels(void **state)
{
    (void)state;
    float values[201], sorted[201];
    uint8_t broken[201] = {0};
    for (int i = 0; i < 201; i++)
        values[i] = (float)(200 - i);
    assert_near(ppmi_compare_heat_top(values, broken, 201, sorted), 198, 0);
    memset(broken, 1, 100);
    assert_near(ppmi_compare_heat_top(values, broken, 201, sorted), 99, 0);
    memset(broken, 1, sizeof broken);
    assert_near(ppmi_compare_heat_top(values, broken, 201, sorted), 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heat_gets_lighter_all_the_way),
        cmocka_unit_test(heat_ends_where_its_range_ends),
        cmocka_unit_test(top_of_heat_is_a_percentile_of_whole_pixels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
