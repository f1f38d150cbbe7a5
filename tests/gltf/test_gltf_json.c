/* importers/gltf/gltf_json.c */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "gltf/gltf_json.h"

static ppmi_gltf_json scan(const char *text)
{
    return (ppmi_gltf_json){.text = text, .length = strlen(text)};
}

static bool is_utf8(const char *text)
{
    size_t bad = 0;
    return ppmi_gltf_json_is_utf8(text, strlen(text), &bad);
}

static void utf8_of_every_length_is_accepted(void **state)
{
    (void)state;
    assert_true(is_utf8("a \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80 \xf4\x8f\xbf\xbf"));
}

static void bytes_that_are_not_utf8_are_found(void **state)
{
    (void)state;
    size_t bad = 99;
    assert_false(ppmi_gltf_json_is_utf8("ab\xff", 3, &bad));
    assert_int_equal(bad, 2);
    assert_false(is_utf8("\xc0\xaf"));         /* overlong */
    assert_false(is_utf8("\xed\xa0\x80"));     /* a surrogate */
    assert_false(is_utf8("\xf4\x90\x80\x80")); /* above U+10FFFF */
    assert_false(is_utf8("\xe2\x82"));         /* cut */
}

static void numbers_have_their_value(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
        bool is_integer;
    } cases[] = {{"0", 0, true},      {"-12", -12, true},  {"2147483648", 2147483648.0, true},
                 {"1.5", 1.5, false}, {"2e2", 200, false}, {"-2.5E-1", -0.25, false}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        ppmi_gltf_json json = scan(cases[i].text);
        ppmi_gltf_number number;
        assert_true(ppmi_gltf_json_number(&json, &number));
        assert_float_equal(number.value, cases[i].value, 1e-12);
        assert_int_equal(number.is_integer, cases[i].is_integer);
        assert_false(number.overflows);
        assert_int_equal(json.at, json.length);
    }
}

static void numbers_beyond_double_overflow(void **state)
{
    (void)state;
    const char *cases[] = {"1e999", "-1e400", "1e99999999999999999999"};
    for (size_t i = 0; i < 3; ++i) {
        ppmi_gltf_json json = scan(cases[i]);
        ppmi_gltf_number number;
        assert_true(ppmi_gltf_json_number(&json, &number));
        assert_true(number.overflows);
    }
}

static void malformed_numbers_are_refused(void **state)
{
    (void)state;
    const char *cases[] = {"-", "01", "1.", "1e", "1e+", "-x"};
    for (size_t i = 0; i < 6; ++i) {
        ppmi_gltf_json json = scan(cases[i]);
        ppmi_gltf_number number;
        assert_false(ppmi_gltf_json_number(&json, &number));
        assert_non_null(json.error);
    }
}

static void malformed_strings_are_refused(void **state)
{
    (void)state;
    const char *cases[] = {"\"abc", "\"a\\x\"", "\"\\u12g4\"", "\"a\nb\"", "\"a\\"};
    for (size_t i = 0; i < 5; ++i) {
        ppmi_gltf_json json = scan(cases[i]);
        ppmi_gltf_span span;
        assert_false(ppmi_gltf_json_string(&json, &span));
    }
}

static void escapes_are_decoded(void **state)
{
    (void)state;
    ppmi_gltf_json json = scan("\"a\\/\\n\\u00e9\\ud83d\\ude00\\ud800!\"");
    ppmi_gltf_span span;
    char out[64];
    assert_true(ppmi_gltf_json_string(&json, &span));
    const size_t count = ppmi_gltf_json_unescape(json.text, span, out);
    const char *expected = "a/\n\xc3\xa9\xf0\x9f\x98\x80\xef\xbf\xbd!";
    assert_int_equal(count, strlen(expected));
    assert_memory_equal(out, expected, count);
}

static void a_place_has_line_and_column(void **state)
{
    (void)state;
    ppmi_gltf_json json = scan("{\n  x");
    size_t line, column;
    json.at = 4;
    ppmi_gltf_json_place(&json, &line, &column);
    assert_int_equal(line, 2);
    assert_int_equal(column, 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(utf8_of_every_length_is_accepted),
        cmocka_unit_test(bytes_that_are_not_utf8_are_found),
        cmocka_unit_test(numbers_have_their_value),
        cmocka_unit_test(numbers_beyond_double_overflow),
        cmocka_unit_test(malformed_numbers_are_refused),
        cmocka_unit_test(malformed_strings_are_refused),
        cmocka_unit_test(escapes_are_decoded),
        cmocka_unit_test(a_place_has_line_and_column),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
