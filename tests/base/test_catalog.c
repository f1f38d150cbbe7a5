/* src/base/catalog.c */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "base/catalog.h"

static void assert_text(const char *text, const char *expected)
{
    ppmi_catalog catalog = {0};
    char *const safe = ppmi_catalog_text(&catalog, text);
    assert_string_equal(safe, expected);
    ppmi_free(NULL, safe);
}

static void what_a_terminal_would_obey_is_replaced(void **state)
{
    (void)state;
    assert_text("a\nb\x1b[2J\x7f", "a?b?[2J?");
    assert_text("\xc2\x9b"
                "2J",
                "??2J"); /* U+009B, another escape sequence's beginning */
}

static void what_is_no_utf8_is_replaced(void **state)
{
    (void)state;
    assert_text("caf\xe9", "caf?");
    assert_text("\xc0\xaf", "??");           /* overlong */
    assert_text("\xed\xa0\x80", "???");      /* a surrogate */
    assert_text("\xf4\x90\x80\x80", "????"); /* above U+10FFFF */
    assert_text("a\xe2\x82", "a??");         /* cut */
    assert_text("\x80z", "?z");
}

static void letters_of_any_length_stay(void **state)
{
    (void)state;
    assert_text("a \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80",
                "a \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
    assert_text("", "");
}

static void lists_grow_and_keep_their_order(void **state)
{
    (void)state;
    ppmi_catalog catalog = {0};
    for (int i = 0; i < 100; i++) {
        char name[32];
        snprintf(name, sizeof name, "node %d", i);
        ppmi_catalog_item *const item = ppmi_catalog_add(&catalog, PPM_ASSET_NODES, name, "");
        assert_non_null(item);
        item->begin_s = i;
    }
    assert_int_equal(catalog.lists[PPM_ASSET_NODES].count, 100);
    assert_int_equal(catalog.lists[PPM_ASSET_MESHES].count, 0);
    assert_string_equal(catalog.lists[PPM_ASSET_NODES].items[73].name, "node 73");
    assert_true(catalog.lists[PPM_ASSET_NODES].items[73].begin_s == 73.0);
    assert_false(catalog.is_out_of_memory);
    ppmi_catalog_deinit(&catalog);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_a_terminal_would_obey_is_replaced),
        cmocka_unit_test(what_is_no_utf8_is_replaced),
        cmocka_unit_test(letters_of_any_length_stay),
        cmocka_unit_test(lists_grow_and_keep_their_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
