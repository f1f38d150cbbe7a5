/* Numbers on the command line: the whole word or nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../src/cli/values.h"

static void words_that_are_no_integers_are_refused(void **state)
{
    (void)state;
    static const char *const words[] = {
        "", " 1", "1 ", "+1", "-1", "1.0", "1k", "0x1F", "abc", "1e3", "18446744073709551616"};
    uint64_t value = 7;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (value_parse_integer(words[i], &value)) fail_msg("'%s' was taken", words[i]);
    }
    assert_int_equal(value, 7);
}

static void integers_reach_to_the_end_of_64_bits(void **state)
{
    (void)state;
    uint64_t value = 0;
    assert_true(value_parse_integer("18446744073709551615", &value));
    assert_true(value == UINT64_MAX);
    assert_true(value_parse_integer("0042", &value));
    assert_int_equal(value, 42);
}

static void counts_take_binary_multiples(void **state)
{
    (void)state;
    uint64_t value = 0;
    assert_true(value_parse_count("256k", &value));
    assert_int_equal(value, 262144);
    assert_true(value_parse_count("1M", &value));
    assert_int_equal(value, 1048576);
    assert_true(value_parse_count("2G", &value));
    assert_int_equal(value, UINT64_C(2147483648));
    assert_true(value_parse_count("12", &value));
    assert_int_equal(value, 12);
}

static void counts_that_overflow_or_trail_are_refused(void **state)
{
    (void)state;
    uint64_t value = 7;
    assert_false(value_parse_count("18014398509481984k", &value)); /* 2^54 k */
    assert_false(value_parse_count("k", &value));
    assert_false(value_parse_count("1kk", &value));
    assert_false(value_parse_count("1m", &value)); /* milli? */
    assert_int_equal(value, 7);
}

static void words_that_are_no_numbers_are_refused(void **state)
{
    (void)state;
    static const char *const words[] = {"",    "nan", "inf", "-inf", "1e999", "1,5",
                                        "0x1", " 1",  "1 ",  ".",    "e",     "--1"};
    double value = 7.0;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (value_parse_real(words[i], &value)) fail_msg("'%s' was taken", words[i]);
    }
    assert_true(value == 7.0);
}

static void numbers_may_have_sign_point_and_exponent(void **state)
{
    (void)state;
    double value = 0.0;
    assert_true(value_parse_real("-2.5e-1", &value));
    assert_true(value == -0.25);
    assert_true(value_parse_real(".5", &value));
    assert_true(value == 0.5);
}

static void sizes_are_two_integers(void **state)
{
    (void)state;
    uint32_t width = 1, height = 1;
    assert_true(value_parse_size("640x480", &width, &height));
    assert_int_equal(width, 640);
    assert_int_equal(height, 480);
    static const char *const words[] = {"",        "640",    "640x",  "x480",
                                        "640*480", "640x-1", "6x4x2", "4294967296x1"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (value_parse_size(words[i], &width, &height)) fail_msg("'%s' was taken", words[i]);
    }
    assert_int_equal(width, 640);
}

static void lists_have_as_many_numbers_as_are_wanted(void **state)
{
    (void)state;
    double values[3] = {7.0, 7.0, 7.0};
    assert_true(value_parse_reals("0.5,-1,2e1", values, 3));
    assert_true(values[0] == 0.5 && values[1] == -1.0 && values[2] == 20.0);
    static const char *const words[] = {"",     "1",     "1,2",    "1,2,3,4", "1,2,",
                                        ",2,3", "1,x,3", "1, 2,3", "1;2;3"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (value_parse_reals(words[i], values, 3)) fail_msg("'%s' was taken", words[i]);
    }
    assert_true(values[0] == 0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_that_are_no_integers_are_refused),
        cmocka_unit_test(integers_reach_to_the_end_of_64_bits),
        cmocka_unit_test(counts_take_binary_multiples),
        cmocka_unit_test(counts_that_overflow_or_trail_are_refused),
        cmocka_unit_test(words_that_are_no_numbers_are_refused),
        cmocka_unit_test(numbers_may_have_sign_point_and_exponent),
        cmocka_unit_test(sizes_are_two_integers),
        cmocka_unit_test(lists_have_as_many_numbers_as_are_wanted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
