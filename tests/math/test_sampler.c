/* Random numbers by index: stratification, independence of sets, reproducibility. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "support/statistics.h"

enum { SEEDS = 20 };

static void the_first_2_to_the_n_points_hold_one_per_interval(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        for (uint32_t set = 0; set < 3; set++) {
            for (uint32_t bits = 1; bits <= 10; bits++) {
                for (uint32_t dimension = 0; dimension < 4; dimension++) {
                    uint8_t seen[1024] = {0};
                    for (uint32_t i = 0; i < 1u << bits; i++) {
                        const ppmi_sample4 sample = ppmi_sobol4(i, set, seed);
                        seen[sample.bits[dimension] >> (32 - bits)]++;
                    }
                    for (uint32_t i = 0; i < 1u << bits; i++)
                        assert_int_equal(seen[i], 1);
                }
            }
        }
    }
}

static void every_aligned_block_is_stratified_too(void **state)
{
    (void)state;
    for (uint32_t block = 0; block < 1000; block++) {
        uint32_t seen[4] = {0};
        for (uint32_t i = 0; i < 16; i++) {
            const ppmi_sample4 sample = ppmi_sobol4(block * 16 + i, 1, 7);
            for (uint32_t k = 0; k < 4; k++)
                seen[k] |= 1u << (sample.bits[k] >> 28);
        }
        for (uint32_t k = 0; k < 4; k++)
            assert_int_equal(seen[k], 0xffff);
    }
}

/* A (0, m, 2)-net in base 2: every elementary rectangle of area 2^-m holds one of 2^m points. */
static void assert_is_net(uint32_t set, uint64_t seed, uint32_t bits)
{
    for (uint32_t x_bits = 0; x_bits <= bits; x_bits++) {
        uint8_t seen[256] = {0};
        for (uint32_t i = 0; i < 1u << bits; i++) {
            const ppmi_sample4 sample = ppmi_sobol4(i, set, seed);
            const uint64_t x = (uint64_t)sample.bits[0] >> (32 - x_bits);
            const uint64_t y = (uint64_t)sample.bits[1] >> (32 - bits + x_bits);
            seen[x << (bits - x_bits) | y]++;
        }
        for (uint32_t i = 0; i < 1u << bits; i++)
            assert_int_equal(seen[i], 1);
    }
}

static void dimensions_0_and_1_are_a_net(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        for (uint32_t bits = 1; bits <= 8; bits++)
            assert_is_net((uint32_t)seed % 4, seed, bits);
    }
}

static void the_single_dimension_is_stratified(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        uint8_t seen[256] = {0};
        for (uint32_t i = 0; i < 256; i++)
            seen[(uint32_t)(ppmi_sobol1(i, 0, seed) * 256.0)]++;
        for (uint32_t i = 0; i < 256; i++)
            assert_int_equal(seen[i], 1);
    }
}

static void the_same_triple_gives_the_same_number(void **state)
{
    (void)state;
    const ppmi_sample4 a = ppmi_sobol4(12345, 2, 99), b = ppmi_sobol4(12345, 2, 99);
    assert_memory_equal(&a, &b, sizeof a);
    ppmi_rng first = ppmi_rng_start(5, PPMI_STREAM_EYE, UINT64_C(1) << 40);
    ppmi_rng second = ppmi_rng_start(5, PPMI_STREAM_EYE, UINT64_C(1) << 40);
    for (int i = 0; i < 10; i++)
        assert_int_equal(ppmi_rng_u32(&first), ppmi_rng_u32(&second));
}

static void seed_set_stream_and_index_all_matter(void **state)
{
    (void)state;
    const ppmi_sample4 base = ppmi_sobol4(1, 0, 0);
    const ppmi_sample4 others[] = {ppmi_sobol4(2, 0, 0), ppmi_sobol4(1, 1, 0),
                                   ppmi_sobol4(1, 0, 1)};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        for (int k = 0; k < 4; k++)
            assert_int_not_equal(base.bits[k], others[i].bits[k]);
    }
    ppmi_rng streams[] = {ppmi_rng_start(0, PPMI_STREAM_EYE, 0),
                          ppmi_rng_start(1, PPMI_STREAM_EYE, 0),
                          ppmi_rng_start(0, PPMI_STREAM_PHOTON, 0),
                          ppmi_rng_start(0, PPMI_STREAM_EYE, UINT64_C(1) << 33)};
    uint32_t numbers[4];
    for (size_t i = 0; i < 4; i++) {
        numbers[i] = ppmi_rng_u32(&streams[i]);
        for (size_t k = 0; k < i; k++)
            assert_int_not_equal(numbers[i], numbers[k]);
    }
}

/* Counts of pairs in an 8 by 8 grid against an even spread. */
static double pair_p(const uint32_t *x, const uint32_t *y, uint32_t count)
{
    double observed[64] = {0.0}, expected[64];
    for (uint32_t i = 0; i < count; i++)
        observed[(x[i] >> 29) * 8 + (y[i] >> 29)] += 1.0;
    for (int i = 0; i < 64; i++)
        expected[i] = count / 64.0;
    return p_counts(observed, expected, 64);
}

/* Over seeds, the numbers of one index are independent: no dimension follows another, and no index
 * another one. */
static void scrambles_are_independent_over_seeds(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    static uint32_t numbers[12][COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        const ppmi_sample4 a = ppmi_sobol4(3, 0, i), b = ppmi_sobol4(3, 1, i),
                           c = ppmi_sobol4(1000000, 0, i);
        for (int k = 0; k < 4; k++) {
            numbers[k][i] = a.bits[k];
            numbers[4 + k][i] = b.bits[k];
            numbers[8 + k][i] = c.bits[k];
        }
    }
    test_family family = {0};
    for (int a = 0; a < 12; a++) {
        for (int b = 0; b < a; b++)
            family_add(&family, pair_p(numbers[a], numbers[b], COUNT), "numbers %d, %d", a, b);
    }
    family_check(&family);
}

static void neighbouring_streams_are_independent(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    static uint32_t numbers[4][COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        ppmi_rng here = ppmi_rng_start(0, PPMI_STREAM_EYE, i);
        ppmi_rng next = ppmi_rng_start(0, PPMI_STREAM_EYE, i + 1);
        ppmi_rng other = ppmi_rng_start(0, PPMI_STREAM_PHOTON, i);
        numbers[0][i] = ppmi_rng_u32(&here);
        numbers[1][i] = ppmi_rng_u32(&here);
        numbers[2][i] = ppmi_rng_u32(&next);
        numbers[3][i] = ppmi_rng_u32(&other);
    }
    test_family family = {0};
    for (int a = 0; a < 4; a++) {
        for (int b = 0; b < a; b++)
            family_add(&family, pair_p(numbers[a], numbers[b], COUNT), "numbers %d, %d", a, b);
    }
    family_check(&family);
}

static void unit_floats_stay_below_1(void **state)
{
    (void)state;
    assert_true(ppmi_unit_float(UINT32_MAX) < 1.0f);
    assert_true(ppmi_unit_float(0) == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_2_to_the_n_points_hold_one_per_interval),
        cmocka_unit_test(every_aligned_block_is_stratified_too),
        cmocka_unit_test(dimensions_0_and_1_are_a_net),
        cmocka_unit_test(the_single_dimension_is_stratified),
        cmocka_unit_test(the_same_triple_gives_the_same_number),
        cmocka_unit_test(seed_set_stream_and_index_all_matter),
        cmocka_unit_test(scrambles_are_independent_over_seeds),
        cmocka_unit_test(neighbouring_streams_are_independent),
        cmocka_unit_test(unit_floats_stay_below_1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
