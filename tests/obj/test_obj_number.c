/* importers/obj/obj_number.c: words, commas, comments. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "obj/obj_number.h"

static int kind(const char *word)
{
    return ppmi_obj_number_kind(word, strlen(word));
}

static void numbers_are_told_from_other_words(void **state)
{
    (void)state;
    const char *const numbers[] = {"0", "-1.5e1", "+.25", "2E-2", "7.", "1e+9"};
    const char *const others[] = {"",     "-",    ".",     "1e",    "abc",
                                  "1.5x", "0x10", "1.2.3", "1,2,3", "5.#IND"};
    const char *const commas[] = {"0,5", "-,5", "96,07", "1,", "1,5e3"};
    const char *const none[] = {"nan",       "-NaN",     "inf",    "-Infinity", "1.#IND",
                                "-1.#IND00", "1.#QNAN0", "1.#INF", "-1.#J",     "1,#INF"};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i) {
        assert_int_equal(kind(numbers[i]), PPMI_OBJ_NUMBER);
    }
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        assert_int_equal(kind(others[i]), PPMI_OBJ_NO_NUMBER);
    }
    for (size_t i = 0; i < sizeof commas / sizeof commas[0]; ++i) {
        assert_int_equal(kind(commas[i]), PPMI_OBJ_DECIMAL_COMMA);
    }
    for (size_t i = 0; i < sizeof none / sizeof none[0]; ++i) {
        assert_int_equal(kind(none[i]), PPMI_OBJ_NOT_FINITE);
    }
}

static void commas_become_points_or_blanks(void **state)
{
    (void)state;
    static const struct {
        const char *before, *after;
    } cases[] = {{"0,5 0,25 1", "0.5 0.25 1"}, {"1,0,0", "1 0 0"},
                 {"0.5,0.25,1", "0.5 0.25 1"}, {"0,5, 0,2", "0.5  0.2"},
                 {"0.5 0.25", "0.5 0.25"},     {"-1,5e1", "-1.5e1"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[32];
        strcpy(text, cases[i].before);
        assert_int_equal(ppmi_obj_mend_commas(text, strlen(text)),
                         strchr(cases[i].before, ',') != NULL);
        assert_string_equal(text, cases[i].after);
    }
}

static void comments_begin_at_a_mark_that_is_in_no_number(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t at;
    } cases[] = {{"v 1 2 3 # x", 8},
                 {"v 1 2 3#x", 7},
                 {"v 1.#IND 1.#INF #", 16},
                 {"v -1.#IND00", 11},
                 {"v 1 2 21.#INF", 9},
                 {"v 1 2 1.#2 is a comment", 8},
                 {"#", 0},
                 {"v 1.#QNAN 2#1.#IND", 11}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_int_equal(ppmi_obj_comment_of_numbers(cases[i].text, strlen(cases[i].text)),
                         cases[i].at);
    }
}

static void comments_of_names_begin_behind_a_blank(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t last, plain; /* lengths without the last comment, and as a name of its own */
    } cases[] = {{"Red # paint", 3, 3},  {"Red", 3, 3},           {"Red#1", 5, 5},
                 {"Red #1 # one", 6, 6}, {"a # b # c", 5, 1},     {"# all", 5, 0},
                 {"Red\t#colour", 3, 3}, {"my tex #1.png", 6, 13}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const size_t length = strlen(cases[i].name);
        assert_int_equal(ppmi_obj_name_without_comment(cases[i].name, length), cases[i].last);
        assert_int_equal(ppmi_obj_plain_name_length(cases[i].name, length), cases[i].plain);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_told_from_other_words),
        cmocka_unit_test(commas_become_points_or_blanks),
        cmocka_unit_test(comments_begin_at_a_mark_that_is_in_no_number),
        cmocka_unit_test(comments_of_names_begin_behind_a_blank),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
