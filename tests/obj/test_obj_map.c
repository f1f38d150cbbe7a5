/* importers/obj/obj_map.c: names and options of maps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/context.h"
#include "obj/obj_map.h"

static ppm_context *context;

static int setup(void **state)
{
    (void)state;
    const ppm_context_desc desc = {.size = sizeof desc};
    return ppm_context_create(&desc, &context) == PPM_STATUS_OK ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    return live == 0 ? 0 : -1;
}

/* Reads a statement without its word; the name is copied to a buffer of the test's. */
static ppmi_obj_map read_map(const char *text)
{
    static char name[256];
    ppmi_obj_map map = {0};
    assert_true(ppmi_obj_map_read(context, text, strlen(text), &map));
    name[0] = 0;
    if (map.name) strncpy(name, map.name, sizeof name - 1);
    ppmi_obj_map_deinit(context, &map);
    map.name = name;
    return map;
}

static void statements_are_known_in_any_letter_case(void **state)
{
    (void)state;
    assert_int_equal(ppmi_obj_map_find("map_Kd"), PPMI_OBJ_MAP_KD);
    assert_int_equal(ppmi_obj_map_find("map_kd"), PPMI_OBJ_MAP_KD);
    assert_int_equal(ppmi_obj_map_find("map_bump"), PPMI_OBJ_MAP_BUMP);
    assert_int_equal(ppmi_obj_map_find("bump"), PPMI_OBJ_MAP_BUMP);
    assert_int_equal(ppmi_obj_map_find("Kd"), -1);
    assert_int_equal(ppmi_obj_map_find("map_"), -1);
    for (int32_t i = 0; i < PPMI_OBJ_MAP_COUNT; ++i) {
        assert_int_equal(ppmi_obj_map_find(ppmi_obj_map_word(i)), i);
    }
}

static void a_statement_without_a_name_is_none(void **state)
{
    (void)state;
    ppmi_obj_map map = {0};
    const char *const texts[] = {"", "-s 1 2 3", "-bm", "-clamp", "-imfchan", "-o"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        assert_true(ppmi_obj_map_read(context, texts[i], strlen(texts[i]), &map));
        assert_false(ppmi_obj_map_is_named(&map));
    }
    /* and takes an earlier one away */
    assert_true(ppmi_obj_map_read(context, "a.png", 5, &map));
    assert_true(ppmi_obj_map_read(context, "", 0, &map));
    assert_false(ppmi_obj_map_is_named(&map));
}

static void names_may_have_blanks_quotes_and_leading_digits(void **state)
{
    (void)state;
    assert_string_equal(read_map("my wood 2.png").name, "my wood 2.png");
    assert_string_equal(read_map("\"my wood.png\"").name, "my wood.png");
    assert_string_equal(read_map("-s 2 3 1 4.png").name, "4.png");
    assert_string_equal(read_map("-s 2 1e.png").name, "1e.png");
    assert_string_equal(read_map("-odd 1.png").name, "-odd 1.png");
    assert_string_equal(read_map("K\xe4se.png").name, "K\xc3\xa4se.png"); /* Latin-1 */
}

static void every_option_is_read(void **state)
{
    (void)state;
    const ppmi_obj_map map =
        read_map("-blendu off -blendv off -boost 2 -cc on -clamp on -imfchan g -mm 0.25 2 -o 1 2 3 "
                 "-s 4 5 6 -t 0 0 1 -texres 512 -bm 0.5 -type cube_top -colorspace linear a b.png");
    assert_string_equal(map.name, "a b.png");
    assert_true(map.is_sharp);
    assert_true(map.clamp);
    assert_true(map.is_linear);
    assert_true(map.has_turbulence);
    assert_int_equal(map.channel, 'g');
    const float expected[] = {0.25f, 2.0f, 1.0f, 2.0f, 4.0f, 5.0f, 0.5f};
    const float got[] = {map.base,     map.gain,     map.offset[0], map.offset[1],
                         map.scale[0], map.scale[1], map.bump};
    assert_memory_equal(got, expected, sizeof expected);
}

static void numbers_that_are_left_out_have_their_defaults(void **state)
{
    (void)state;
    const ppmi_obj_map plain = read_map("a.png");
    assert_true(ppmi_obj_map_is_plain(&plain));
    assert_float_equal(plain.scale[0], 1.0f, 0.0f);
    assert_float_equal(plain.bump, 1.0f, 0.0f);
    const ppmi_obj_map one = read_map("-s 2 -o 3 -mm 0.5 a.png");
    assert_float_equal(one.scale[0], 2.0f, 0.0f);
    assert_float_equal(one.scale[1], 1.0f, 0.0f);
    assert_float_equal(one.offset[0], 3.0f, 0.0f);
    assert_float_equal(one.offset[1], 0.0f, 0.0f);
    assert_float_equal(one.base, 0.5f, 0.0f);
    assert_float_equal(one.gain, 1.0f, 0.0f);
    assert_float_equal(read_map("-bm 1e999 a.png").bump, 0.0f, 1.0f); /* finite */
    assert_int_equal(read_map("-imfchan z a.png").channel, 0); /* a depth that no file here has */
}

static void options_without_a_value_leave_the_name(void **state)
{
    (void)state;
    const char *const options[] = {"-clamp", "-cc",    "-blendu",     "-imfchan", "-bm",
                                   "-mm",    "-boost", "-texres",     "-type",    "-s",
                                   "-o",     "-t",     "-colorspace", "-blendv"};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; ++i) {
        char text[64];
        snprintf(text, sizeof text, "%s tex.png", options[i]);
        assert_string_equal(read_map(text).name, "tex.png");
    }
    assert_true(read_map("-clamp tex.png").clamp);
    assert_false(read_map("-clamp off tex.png").clamp);
}

static void numbers_may_have_decimal_commas(void **state)
{
    (void)state;
    const ppmi_obj_map map = read_map("-bm 0,5 -s 2,0 1,5 tex.png");
    assert_true(map.has_comma);
    assert_float_equal(map.bump, 0.5f, 0.0f);
    assert_float_equal(map.scale[1], 1.5f, 0.0f);
    assert_string_equal(map.name, "tex.png");
    assert_false(read_map("-bm 0.5 a,b.png").has_comma);
}

static void options_may_be_behind_the_name(void **state)
{
    (void)state;
    ppmi_obj_map map = {0};
    const char *const texts[] = {"a b.png -bm 0.25 -clamp on", "-clamp on a b.png -bm 0.25",
                                 "\"a b.png\" -bm 0.25 -clamp"};
    for (size_t i = 0; i < 3; ++i) {
        assert_true(ppmi_obj_map_read_behind(context, texts[i], strlen(texts[i]), &map));
        assert_string_equal(map.name, "a b.png");
        assert_float_equal(map.bump, 0.25f, 0.0f);
        assert_true(map.clamp);
    }
    const char *const names[] = {"a -b.png", "a -bm 1 b.png", "a-bm 1"};
    for (size_t i = 0; i < 3; ++i) {
        assert_true(ppmi_obj_map_read_behind(context, names[i], strlen(names[i]), &map));
        assert_string_equal(map.name, names[i]);
        assert_float_equal(map.bump, 1.0f, 0.0f);
    }
    ppmi_obj_map_deinit(context, &map);
    map = read_map("a.png -bm 0.25"); /* as it stands */
    assert_string_equal(map.name, "a.png -bm 0.25");
    assert_true(ppmi_obj_map_may_hold_more(&map));
    map = read_map("a#1-b.png");
    assert_false(ppmi_obj_map_may_hold_more(&map));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statements_are_known_in_any_letter_case),
        cmocka_unit_test(a_statement_without_a_name_is_none),
        cmocka_unit_test(names_may_have_blanks_quotes_and_leading_digits),
        cmocka_unit_test(every_option_is_read),
        cmocka_unit_test(numbers_that_are_left_out_have_their_defaults),
        cmocka_unit_test(options_without_a_value_leave_the_name),
        cmocka_unit_test(numbers_may_have_decimal_commas),
        cmocka_unit_test(options_may_be_behind_the_name),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
