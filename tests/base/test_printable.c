/* src/base/printable.c */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/printable.h"

static void control_characters_are_shown_by_their_numbers(void **state)
{
    (void)state;
    static const struct {
        const char *text, *shown;
    } cases[] = {
        {"", ""},
        {"plain, \xc3\xa9\xe2\x82\xac", "plain, \xc3\xa9\xe2\x82\xac"},
        {"\x1b]0;x\x07", "\\x1b]0;x\\x07"},
        {"a\nb\r\tc\x7f", "a\\x0ab\\x0d\\x09c\\x7f"},
        {"\xc2\x9b"
         "2J\xc2\xa0",
         "\\xc2\\x9b"
         "2J\xc2\xa0"}, /* C1's CSI; a no-break space */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char shown[64];
        ppmi_printable(cases[i].text, shown, sizeof shown);
        assert_string_equal(shown, cases[i].shown);
    }
}

static void what_has_no_room_is_cut_off(void **state)
{
    (void)state;
    for (size_t size = 1; size < 40; size++) {
        char shown[48];
        memset(shown, '?', sizeof shown);
        ppmi_printable("\x1b\x1b\x1b\x1b\x1b\x1b\x1b\x1b\x1b\x1b", shown, size);
        assert_true(strlen(shown) < size);
        assert_int_equal(strlen(shown) % 4, 0);
        assert_int_equal(shown[size], '?');
    }
}

static void newlines_of_the_format_stay(void **state)
{
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *const stream = open_memstream(&text, &size);
    assert_non_null(stream);
    ppmi_print(stream, "\n\n%s: %d\n", "a\nb\x1b", 7);
    ppmi_print(stream, "%s", "c\n");
    ppmi_print(stream, "\n");
    assert_int_equal(fclose(stream), 0);
    assert_string_equal(text, "\n\na\\x0ab\\x1b: 7\nc\\x0a\n");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control_characters_are_shown_by_their_numbers),
        cmocka_unit_test(what_has_no_room_is_cut_off),
        cmocka_unit_test(newlines_of_the_format_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
