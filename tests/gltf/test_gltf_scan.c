/* importers/gltf/gltf_scan.c */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "gltf/gltf_scan.h"

static const char text[] = "{\"a\": {\"list\": [1, \"two\", {\"b\": [3]}, null], \"n\": -2.5e1},\n"
                           " \"list\" : [ ] , \"s\": \"\\u00fc[\\\"x\\\"]\", \"a\": 7}";

static ppmi_gltf_span member(const char *json, const char *key)
{
    return ppmi_gltf_scan_member(json, ppmi_gltf_scan_root(strlen(json)), key);
}

static bool is_empty(ppmi_gltf_span span)
{
    return span.begin == span.end;
}

static void what_is_not_there_is_empty(void **state)
{
    (void)state;
    const ppmi_gltf_span a = member(text, "a"), list = member(text, "list");
    ppmi_gltf_span element;
    size_t cursor = 0;
    char buffer[8] = "full";
    assert_true(is_empty(member(text, "b")));
    assert_true(is_empty(member("[1, 2]", "b")));
    assert_true(is_empty(member("", "b")));
    assert_true(is_empty(ppmi_gltf_scan_member(text, (ppmi_gltf_span){0, 0}, "a")));
    assert_true(is_empty(ppmi_gltf_scan_member(text, list, "a")));
    assert_false(ppmi_gltf_scan_next(text, list, &cursor, &element));
    assert_false(ppmi_gltf_scan_next(text, a, &cursor, &element));
    assert_true(ppmi_gltf_scan_number(text, list, 5.0) == 5.0);
    assert_string_equal(ppmi_gltf_scan_string(text, a, buffer, sizeof buffer), "");
}

/* Cut anywhere, the text has an end all the same. */
static void a_cut_text_is_not_read_beyond_its_end(void **state)
{
    (void)state;
    for (size_t length = 0; length < sizeof text - 1; length++) {
        const ppmi_gltf_span a = ppmi_gltf_scan_member(text, ppmi_gltf_scan_root(length), "a");
        const ppmi_gltf_span list = ppmi_gltf_scan_member(text, a, "list");
        assert_true(a.end <= length && list.end <= length);
    }
}

static void members_are_those_of_the_object_itself(void **state)
{
    (void)state;
    const ppmi_gltf_span a = member(text, "a");
    assert_true(ppmi_gltf_scan_number(text, ppmi_gltf_scan_member(text, a, "n"), 0.0) == -25.0);
    assert_false(is_empty(member(text, "list")));
    assert_int_not_equal(member(text, "list").begin, ppmi_gltf_scan_member(text, a, "list").begin);
}

static void several_members_are_found_in_one_walk(void **state)
{
    (void)state;
    static const char *const keys[] = {"s", "none", "a"};
    ppmi_gltf_span found[3];
    ppmi_gltf_scan_members(text, ppmi_gltf_scan_root(strlen(text)), keys, 3, found);
    assert_int_equal(found[0].begin, member(text, "s").begin);
    assert_true(is_empty(found[1]));
    assert_int_equal(found[2].begin, member(text, "a").begin); /* the first of two */
    assert_int_equal(text[found[2].begin], '{');
}

static void elements_come_in_their_order(void **state)
{
    (void)state;
    const ppmi_gltf_span list = ppmi_gltf_scan_member(text, member(text, "a"), "list");
    ppmi_gltf_span elements[5];
    size_t cursor = 0, count = 0;
    char buffer[8];
    while (count < 5 && ppmi_gltf_scan_next(text, list, &cursor, &elements[count]))
        count++;
    assert_int_equal(count, 4);
    assert_true(ppmi_gltf_scan_number(text, elements[0], 0.0) == 1.0);
    assert_string_equal(ppmi_gltf_scan_string(text, elements[1], buffer, sizeof buffer), "two");
    assert_false(is_empty(ppmi_gltf_scan_member(text, elements[2], "b")));
    assert_memory_equal(text + elements[3].begin, "null", 4);
}

static void strings_are_decoded_and_cut_between_letters(void **state)
{
    (void)state;
    const ppmi_gltf_span s = member(text, "s");
    char buffer[16];
    assert_string_equal(ppmi_gltf_scan_string(text, s, buffer, 16), "\xc3\xbc[\"x\"]");
    assert_string_equal(ppmi_gltf_scan_string(text, s, buffer, 9), "\xc3\xbc[");
    assert_string_equal(ppmi_gltf_scan_string(text, s, buffer, 5), "");
    static const char plain[] = "{\"s\": \"ab\xc3\xbc\"}";
    assert_string_equal(ppmi_gltf_scan_string(plain, member(plain, "s"), buffer, 4), "ab");
    assert_string_equal(ppmi_gltf_scan_string(plain, member(plain, "s"), buffer, 5), "ab\xc3\xbc");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_not_there_is_empty),
        cmocka_unit_test(a_cut_text_is_not_read_beyond_its_end),
        cmocka_unit_test(members_are_those_of_the_object_itself),
        cmocka_unit_test(several_members_are_found_in_one_walk),
        cmocka_unit_test(elements_come_in_their_order),
        cmocka_unit_test(strings_are_decoded_and_cut_between_letters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
