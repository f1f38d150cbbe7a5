/* The alias method draws by weight. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/alias.h"
#include "math/sampler.h"
#include "support/near.h"
#include "support/statistics.h"

enum { SAMPLES = 400000, MOST = 1000 };

static ppm_context *make_context(void)
{
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(NULL, &context), PPM_STATUS_OK);
    return context;
}

static void nothing_to_choose_from_is_refused(void **state)
{
    (void)state;
    ppm_context *context = make_context();
    ppmi_alias table = {0};
    assert_int_equal(ppmi_alias_init(context, &table, NULL, 0), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppmi_alloc_live(context), 0);
    ppm_context_destroy(context);
}

static void every_failed_allocation_is_reported_and_leaves_nothing(void **state)
{
    (void)state;
    ppm_context *context = make_context();
    const float weights[3] = {1.0f, 2.0f, 3.0f};
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 1;
    for (; status != PPM_STATUS_OK; n++) {
        assert_true(n < 10);
        ppmi_alias table = {0};
        ppmi_alloc_fail_at(context, n);
        status = ppmi_alias_init(context, &table, weights, 3);
        ppmi_alloc_fail_at(context, 0);
        if (status == PPM_STATUS_OK) ppmi_alias_deinit(context, &table);
        assert_int_equal(ppmi_alloc_live(context), 0);
    }
    assert_true(n > 3);
    ppm_context_destroy(context);
}

static double draw_p(ppm_context *context, const float *weights, uint32_t count, uint64_t seed)
{
    ppmi_alias table = {0};
    assert_int_equal(ppmi_alias_init(context, &table, weights, count), PPM_STATUS_OK);
    double sum = 0.0, probabilities = 0.0;
    for (uint32_t i = 0; i < count; i++)
        sum += (double)weights[i];
    double observed[MOST] = {0.0}, expected[MOST];
    for (uint32_t i = 0; i < count; i++) {
        const double p = sum > 0.0 ? (double)weights[i] / sum : 1.0 / count;
        assert_near(ppmi_alias_probability(&table, i), p, 1e-6);
        probabilities += (double)ppmi_alias_probability(&table, i);
        expected[i] = p * SAMPLES;
    }
    assert_near(probabilities, 1.0, 1e-5);
    ppmi_rng rng = ppmi_rng_start(seed, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < SAMPLES; i++)
        observed[ppmi_alias_sample(&table, ppmi_rng_double(&rng), NULL)] += 1.0;
    ppmi_alias_deinit(context, &table);
    return p_counts(observed, expected, count);
}

static void entries_are_drawn_by_weight(void **state)
{
    (void)state;
    ppm_context *context = make_context();
    float equal[MOST], random[MOST], steep[40], rare[3] = {0.0f, 1.0f, 1e-4f}, one[1] = {5.0f};
    float zeros[7] = {0.0f};
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    for (int i = 0; i < MOST; i++) {
        equal[i] = 3.0f;
        random[i] = i % 5 == 0 ? 0.0f : ppmi_rng_float(&rng);
    }
    for (int i = 0; i < 40; i++)
        steep[i] = i == 0 ? 1e10f : steep[i - 1] * 0.5f;
    test_family family = {0};
    family_add(&family, draw_p(context, equal, MOST, 1), "equal");
    family_add(&family, draw_p(context, random, MOST, 2), "random with zeros");
    family_add(&family, draw_p(context, steep, 40, 3), "powers of two");
    family_add(&family, draw_p(context, rare, 3, 4), "one rare, one impossible");
    family_add(&family, draw_p(context, one, 1, 5), "only one");
    family_add(&family, draw_p(context, zeros, 7, 6), "all zero: even");
    family_check(&family);
    assert_int_equal(ppmi_alloc_live(context), 0);
    ppm_context_destroy(context);
}

static void what_is_left_of_the_number_is_uniform(void **state)
{
    (void)state;
    ppm_context *context = make_context();
    const float weights[5] = {1.0f, 0.0f, 10.0f, 0.3f, 2.5f};
    ppmi_alias table = {0};
    assert_int_equal(ppmi_alias_init(context, &table, weights, 5), PPM_STATUS_OK);
    double observed[5][20] = {{0.0}}, expected[20];
    double draws[5] = {0.0};
    ppmi_rng rng = ppmi_rng_start(8, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double rest;
        const uint32_t entry = ppmi_alias_sample(&table, ppmi_rng_double(&rng), &rest);
        assert_true(rest >= 0.0 && rest < 1.0);
        observed[entry][(int)(rest * 20.0)] += 1.0;
        draws[entry] += 1.0;
    }
    test_family family = {0};
    for (int entry = 0; entry < 5; entry++) {
        if (entry == 1) continue;
        for (int i = 0; i < 20; i++)
            expected[i] = draws[entry] / 20.0;
        family_add(&family, p_counts(observed[entry], expected, 20), "entry %d", entry);
    }
    family_check(&family);
    assert_true(draws[1] == 0.0);
    ppmi_alias_deinit(context, &table);
    ppm_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_to_choose_from_is_refused),
        cmocka_unit_test(every_failed_allocation_is_reported_and_leaves_nothing),
        cmocka_unit_test(entries_are_drawn_by_weight),
        cmocka_unit_test(what_is_left_of_the_number_is_uniform),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
