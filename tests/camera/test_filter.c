/* Pixel filters: offsets against the published profiles. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "camera/filter.h"
#include "math/sampler.h"
#include "support/near.h"
#include "support/statistics.h"

static const double pi = 3.14159265358979323846;

static const struct {
    int32_t kind;
    float width;
} cases[] = {
    {PPM_PIXEL_FILTER_BOX, 1.0f},
    {PPM_PIXEL_FILTER_BOX, 2.5f},
    {PPM_PIXEL_FILTER_GAUSSIAN, 3.0f},
    {PPM_PIXEL_FILTER_GAUSSIAN, 0.7f},
    {PPM_PIXEL_FILTER_BLACKMAN_HARRIS, 3.0f},
    {PPM_PIXEL_FILTER_BLACKMAN_HARRIS, 8.0f},
};
enum { CASES = sizeof cases / sizeof cases[0] };

/* Profiles as they are published, not scaled: t is in widths. The four-term window of Harris 1978
 * runs from 0 to 1. */
static double profile(int32_t kind, double t)
{
    if (fabs(t) > 0.5) return 0.0;
    switch (kind) {
    case PPM_PIXEL_FILTER_GAUSSIAN:
        return exp(-0.5 * (6.0 * t) * (6.0 * t));
    case PPM_PIXEL_FILTER_BLACKMAN_HARRIS: {
        const double phase = 2.0 * pi * (t + 0.5);
        return 0.35875 - 0.48829 * cos(phase) + 0.14128 * cos(2.0 * phase) -
               0.01168 * cos(3.0 * phase);
    }
    }
    return 1.0;
}

/* The integral of t^power * profile from -1/2 to a bound, by the midpoint rule. */
static double moment(int32_t kind, int power, double bound)
{
    enum { STEPS = 4000 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double t = -0.5 + (bound + 0.5) * (i + 0.5) / STEPS;
        sum += pow(t, power) * profile(kind, t);
    }
    return sum * (bound + 0.5) / STEPS;
}

static void the_integral_is_that_of_the_profile(void **state)
{
    (void)state;
    for (int c = 0; c < CASES; c++) {
        const double width = (double)cases[c].width;
        assert_near(ppmi_pixel_filter_cdf(cases[c].kind, width, -0.51 * width), 0.0, 0.0);
        assert_near(ppmi_pixel_filter_cdf(cases[c].kind, width, 0.51 * width), 1.0, 0.0);
        for (int i = 0; i <= 10; i++) {
            const double t = -0.5 + 0.1 * i;
            const double share = moment(cases[c].kind, 0, t) / moment(cases[c].kind, 0, 0.5);
            assert_near(ppmi_pixel_filter_cdf(cases[c].kind, width, t * width), share, 1e-6);
        }
    }
}

/* Bins in pixels, from one end of the filter to the other. */
static void offsets_have_the_profile_as_density(void **state)
{
    (void)state;
    enum { BINS = 60 };
    const uint32_t samples = TEST_EFFORT(2000000);
    test_family family = {0};
    for (int c = 0; c < CASES; c++) {
        const double width = (double)cases[c].width;
        ppmi_pixel_filter filter;
        ppmi_pixel_filter_init(&filter, cases[c].kind, cases[c].width);
        double observed[BINS] = {0}, expected[BINS];
        for (int i = 0; i < BINS; i++) {
            const double below =
                ppmi_pixel_filter_cdf(filter.kind, width, width * i / BINS - 0.5 * width);
            const double upto =
                ppmi_pixel_filter_cdf(filter.kind, width, width * (i + 1) / BINS - 0.5 * width);
            expected[i] = samples * (upto - below);
        }
        ppmi_rng rng = ppmi_rng_start(1, 99, (uint64_t)c);
        for (uint32_t i = 0; i < samples; i++) {
            const double x = (double)ppmi_pixel_filter_offset(&filter, ppmi_rng_float(&rng));
            assert_true(x >= -0.5 * width && x <= 0.5 * width);
            const int bin = (int)((x / width + 0.5) * BINS);
            observed[bin < BINS ? bin : BINS - 1] += 1.0;
        }
        family_add(&family, p_counts(observed, expected, BINS), "filter %d of width %g",
                   (int)filter.kind, width);
    }
    family_check(&family);
}

/* By even shares instead of random numbers: the error is the table's. */
static void offsets_have_the_moments_of_the_profile(void **state)
{
    (void)state;
    enum { SHARES = 1 << 16 };
    for (int c = 0; c < CASES; c++) {
        const double width = (double)cases[c].width;
        ppmi_pixel_filter filter;
        ppmi_pixel_filter_init(&filter, cases[c].kind, cases[c].width);
        double sums[5] = {0};
        for (int i = 0; i < SHARES; i++) {
            const float u = ((float)i + 0.5f) / SHARES;
            const double x = (double)ppmi_pixel_filter_offset(&filter, u) / width;
            for (int power = 1; power < 5; power++)
                sums[power] += pow(x, power) / SHARES;
        }
        const double area = moment(filter.kind, 0, 0.5);
        for (int power = 1; power < 5; power++)
            assert_near(sums[power], moment(filter.kind, power, 0.5) / area, 2e-6);
    }
}

/* Or stratified numbers would not give stratified offsets. */
static void offsets_grow_with_the_number(void **state)
{
    (void)state;
    for (int c = 0; c < CASES; c++) {
        ppmi_pixel_filter filter;
        ppmi_pixel_filter_init(&filter, cases[c].kind, cases[c].width);
        float before = -INFINITY;
        for (uint32_t i = 0; i < 1u << 24; i += 997) {
            const float x = ppmi_pixel_filter_offset(&filter, ppmi_unit_float(i << 8));
            assert_true(x >= before);
            before = x;
        }
        assert_near(ppmi_pixel_filter_offset(&filter, 0.0f), -0.5 * (double)filter.width, 1e-6);
        assert_near(ppmi_pixel_filter_offset(&filter, 0.5f), 0.0, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_integral_is_that_of_the_profile),
        cmocka_unit_test(offsets_have_the_profile_as_density),
        cmocka_unit_test(offsets_have_the_moments_of_the_profile),
        cmocka_unit_test(offsets_grow_with_the_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
