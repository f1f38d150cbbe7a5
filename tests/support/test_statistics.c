/* The p-values against tables, and that a wrong sampler is seen. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/statistics.h"

static void p_values_match_tables(void **state)
{
    (void)state;
    assert_near(p_normal(1.959964), 0.05, 1e-6);
    assert_near(p_normal(-4.891638), 1e-6, 1e-10);
    assert_near(p_student(2.228139, 10.0), 0.05, 1e-6);
    assert_near(p_student(63.656741, 1.0), 0.01, 1e-7);
    assert_near(p_chi_squared(18.307038, 10.0), 0.05, 1e-7);
    assert_near(p_chi_squared(149.449253, 100.0), 0.001, 1e-7);
    assert_near(p_chi_squared(3.841459, 1.0), 0.05, 1e-7);
    assert_near(p_chi_squared(0.0, 5.0), 1.0, 0.0);
}

static void counts_that_fit_pass_and_others_do_not(void **state)
{
    (void)state;
    const double expected[4] = {100.0, 100.0, 100.0, 100.0};
    const double near[4] = {95.0, 108.0, 103.0, 94.0}, far[4] = {60.0, 140.0, 100.0, 100.0};
    assert_true(p_counts(near, expected, 4) > 0.3);
    assert_true(p_counts(far, expected, 4) < 1e-5);
    const double none[2] = {0.0, 10.0}, one[2] = {1.0, 9.0};
    assert_true(p_counts(one, none, 2) == 0.0);
}

static void means_know_their_error(void **state)
{
    (void)state;
    test_mean mean = {0};
    for (int i = 1; i <= 9; i++)
        mean_add(&mean, (double)i);
    assert_near(mean.mean, 5.0, 1e-12);
    assert_near(mean_error(&mean), sqrt(7.5 / 9.0), 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(p_values_match_tables),
        cmocka_unit_test(counts_that_fit_pass_and_others_do_not),
        cmocka_unit_test(means_know_their_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
