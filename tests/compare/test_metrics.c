/* Numbers that can be worked out by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare/metrics.h"
#include "support/near.h"

enum { PIXELS = 4 };

static ppm_context *context;
static float test[3 * PIXELS], reference[3 * PIXELS];
static uint8_t is_broken[PIXELS];
static ppmi_compare_pair pair;

/* Grey reference of 0.3 and tests that are off by 0, 0.1, 0.2, 0.4 in every channel. */
static int setup(void **state)
{
    (void)state;
    static const float off[PIXELS] = {0, 0.1f, 0.2f, 0.4f};
    for (int i = 0; i < 3 * PIXELS; i++) {
        reference[i] = 0.3f;
        test[i] = 0.3f + off[i / 3];
    }
    memset(is_broken, 0, sizeof is_broken);
    pair = (ppmi_compare_pair){.width = 2,
                               .height = 2,
                               .picture_width = 2,
                               .picture_height = 2,
                               .test = test,
                               .reference = reference,
                               .is_broken = is_broken,
                               .measured = PIXELS,
                               .is_linear = true};
    return ppm_context_create(NULL, &context) == PPM_STATUS_OK ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    return live == 0 ? 0 : -1;
}

static ppmi_compare_metrics measure(double trim, double peak)
{
    ppmi_compare_metrics metrics;
    assert_int_equal(ppmi_compare_measure(context, &pair, trim, peak, &metrics), PPM_STATUS_OK);
    return metrics;
}

static void means_are_over_pixels_and_channels(void **state)
{
    (void)state;
    const ppmi_compare_metrics metrics = measure(0, 0);
    assert_int_equal(metrics.pixels, 4);
    assert_near(metrics.mse, 0.21 / 4, 1e-8);
    assert_near(metrics.relative_mse, 0.21 / 4 / (0.09 + 0.01), 1e-7);
}

static void one_channel_counts_a_third(void **state)
{
    (void)state;
    memcpy(test, reference, sizeof test);
    test[1] += 0.3f;
    assert_near(measure(0, 0).mse, 0.09 / 12, 1e-8);
}

static void trimming_leaves_the_worst_out_of_all_numbers(void **state)
{
    (void)state;
    const ppmi_compare_metrics metrics = measure(0.25, 1);
    assert_int_equal(metrics.trimmed, 1);
    assert_int_equal(metrics.pixels, 3);
    assert_near(metrics.mse, 0.05 / 3, 1e-8);
    assert_near(metrics.relative_mse, 0.5 / 3, 1e-6);
    assert_near(metrics.psnr_db, 10 * log10(3 / 0.05), 1e-5);
    assert_int_equal(measure(0.24, 1).trimmed, 0); /* rounds down */
    assert_int_equal(measure(0.999, 1).pixels, 1);
}

static void worst_is_meant_relative_to_the_reference(void **state)
{
    (void)state;
    for (int c = 0; c < 3; c++) { /* off by 1 beside 10: large, but relatively small */
        reference[c] = 10;
        test[c] = 11;
    }
    assert_near(measure(0.25, 1).mse, (1 + 0.01 + 0.04) / 3, 1e-6);
}

static void psnr_takes_its_peak_from_the_pictures(void **state)
{
    (void)state;
    reference[0] = test[0] = 8;
    const ppmi_compare_metrics light = measure(0, 0);
    assert_near(light.peak, 8, 0);
    assert_near(light.psnr_db, 10 * log10(64 / light.mse), 1e-9);
    pair.is_linear = false;
    assert_near(measure(0, 0).peak, 1, 0);
    assert_near(measure(0, 2).peak, 2, 0);
}

static void equal_pictures_have_infinite_psnr(void **state)
{
    (void)state;
    memcpy(test, reference, sizeof test);
    const ppmi_compare_metrics metrics = measure(0, 0);
    assert_near(metrics.mse, 0, 0);
    assert_true(isinf(metrics.psnr_db) && metrics.psnr_db > 0);
}

static void broken_pixels_do_not_count(void **state)
{
    (void)state;
    is_broken[3] = 1;
    pair.measured = 3;
    const ppmi_compare_metrics metrics = measure(0, 0);
    assert_int_equal(metrics.pixels, 3);
    assert_near(metrics.mse, 0.05 / 3, 1e-8);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    for (size_t n = 1; n <= 2; n++) {
        ppmi_compare_metrics metrics;
        ppmi_alloc_fail_at(context, n);
        assert_int_equal(ppmi_compare_measure(context, &pair, 0.5, 0, &metrics),
                         PPM_STATUS_OUT_OF_MEMORY);
        assert_int_equal(ppmi_alloc_live(context), 0);
    }
    ppmi_alloc_fail_at(context, 0);
}

int main(void)
{
#define CASE(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        CASE(means_are_over_pixels_and_channels),
        CASE(one_channel_counts_a_third),
        CASE(trimming_leaves_the_worst_out_of_all_numbers),
        CASE(worst_is_meant_relative_to_the_reference),
        CASE(psnr_takes_its_peak_from_the_pictures),
        CASE(equal_pictures_have_infinite_psnr),
        CASE(broken_pixels_do_not_count),
        CASE(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
