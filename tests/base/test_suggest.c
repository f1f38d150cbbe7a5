/* Suggestions for names that were mistyped. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/suggest.h"

static const char *const views[] = {"Standard", "Filmic", "Filmic Log", "ACES 1.0 - SDR Video",
                                    NULL,       "Raw"};
enum { VIEW_COUNT = sizeof views / sizeof views[0] };

static const char *nearest_view(const char *word)
{
    return ppmi_suggest(word, views, VIEW_COUNT);
}

static void nothing_is_suggested_for_nothing(void **state)
{
    (void)state;
    assert_null(ppmi_suggest(NULL, views, VIEW_COUNT));
    assert_null(ppmi_suggest("Raw", NULL, 3));
    assert_null(ppmi_suggest("Raw", views, 0));
    assert_null(nearest_view(""));
}

static void each_kind_of_slip_is_found(void **state)
{
    (void)state;
    assert_string_equal(nearest_view("Filmc"), "Filmic");
    assert_string_equal(nearest_view("Filmmic"), "Filmic");
    assert_string_equal(nearest_view("Fulmic"), "Filmic");
    assert_string_equal(nearest_view("Flimic"), "Filmic");
    assert_string_equal(nearest_view("rwa"), "Raw");
}

static void letter_case_is_no_mistake(void **state)
{
    (void)state;
    assert_string_equal(nearest_view("STANDARD"), "Standard");
}

static void a_swap_is_one_mistake(void **state)
{
    (void)state;
    /* two letters allow one mistake: "ba" is a swap away, "xy" two replacements */
    const char *const candidates[] = {"xy", "ba"};
    assert_string_equal(ppmi_suggest("ab", candidates, 2), "ba");
    assert_null(ppmi_suggest("ab", candidates, 1));
}

static void a_name_cut_short_is_completed(void **state)
{
    (void)state;
    assert_string_equal(nearest_view("aces"), "ACES 1.0 - SDR Video");
    assert_string_equal(nearest_view("Stand"), "Standard");
}

static void an_exact_name_beats_a_longer_one(void **state)
{
    (void)state;
    assert_string_equal(nearest_view("filmic"), "Filmic");
    assert_string_equal(nearest_view("Filmic Lgo"), "Filmic Log");
}

static void words_far_from_all_names_get_no_suggestion(void **state)
{
    (void)state;
    assert_null(nearest_view("Cinematic"));
    assert_null(nearest_view("zzz"));
    char longest[300];
    memset(longest, 'R', sizeof longest);
    longest[sizeof longest - 1] = '\0';
    assert_null(nearest_view(longest));
    const char *const only_long[] = {longest};
    assert_null(ppmi_suggest("RRRR", only_long, 1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_suggested_for_nothing),
        cmocka_unit_test(each_kind_of_slip_is_found),
        cmocka_unit_test(letter_case_is_no_mistake),
        cmocka_unit_test(a_swap_is_one_mistake),
        cmocka_unit_test(a_name_cut_short_is_completed),
        cmocka_unit_test(an_exact_name_beats_a_longer_one),
        cmocka_unit_test(words_far_from_all_names_get_no_suggestion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
