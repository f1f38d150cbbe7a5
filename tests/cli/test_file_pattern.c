/* Names of files with places for the frame and the camera. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../src/cli/file_pattern.h"

static const pattern_use no_use = {0};
static const pattern_use one_frame = {.has_frame = true};
static const pattern_use frames = {.has_frame = true, .needs_frame = true};
static const pattern_use cameras = {.has_camera = true};
static const pattern_use both = {.has_frame = true, .needs_frame = true, .has_camera = true};

static void assert_fault(const char *path, const pattern_use *use, const char *part)
{
    const char *const fault = pattern_fault(path, use);
    if (!fault || !strstr(fault, part)) {
        fail_msg("%s: expected '%s', said '%s'", path, part, fault ? fault : "(nothing)");
    }
}

static void assert_filled(const char *path, const pattern_use *use, int32_t frame,
                          const char *expected)
{
    const char *const fault = pattern_fault(path, use);
    if (fault) fail_msg("%s: %s", path, fault);
    char *const name = pattern_fill(path, use, frame, "Front");
    assert_string_equal(name, expected);
    free(name);
}

static void other_conversions_are_faults(void **state)
{
    (void)state;
    static const char *const paths[] = {
        "a%s.exr",    "a%04x.exr",  "a%4d.exr", "a%i.exr",   "a%n.exr",
        "a%.exr",     "a%",         "a%0d.exr", "a%-4d.exr", "a%04",
        "a%021d.exr", "a%04ld.exr", "a%*d.exr", "a%1$d.exr", "a%99999999999999999999d"};
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++)
        assert_fault(paths[i], &frames, "is not followed by d, 0Nd");
}

static void there_is_one_place_of_each_kind(void **state)
{
    (void)state;
    assert_fault("%04d_%04d.exr", &frames, "more than one place for the frame");
    assert_fault("%d_##.exr", &frames, "more than one place for the frame");
    assert_fault("#_#.exr", &frames, "more than one place for the frame");
    assert_fault("%c%c.exr", &cameras, "more than one place for the camera");
    assert_fault("a%04d.exr", &cameras, "neither --frame nor --frames");
    assert_fault("a%c.exr", &frames, "no --camera all");
}

static void without_a_use_a_name_is_what_it_is(void **state)
{
    (void)state;
    assert_filled("100%.exr", &no_use, 7, "100%.exr");
    assert_filled("#1 %s %04d.exr", &no_use, 7, "#1 %s %04d.exr");
}

static void places_are_filled_in(void **state)
{
    (void)state;
    assert_filled("a.%04d.exr", &frames, 7, "a.0007.exr");
    assert_filled("a%d.exr", &frames, 12345, "a12345.exr");
    assert_filled("a_####.exr", &frames, 12345, "a_12345.exr");
    assert_filled("a##b.png", &frames, 7, "a07b.png");
    assert_filled("#.png", &frames, 7, "7.png");
    assert_filled("%05d%%.png", &frames, -7, "-0007%.png");
    assert_filled("%#%d.png", &frames, 7, "#7.png");
    assert_filled("%c_%03d.png", &both, 7, "Front_007.png");
}

static void folders_are_taken_as_they_are(void **state)
{
    (void)state;
    assert_filled("shot#2/100%/a.%04d.exr", &frames, 7, "shot#2/100%/a.0007.exr");
    assert_filled("%04d/a.exr", &frames, 7, "%04d/a.0007.exr");
}

static void a_missing_place_is_put_in(void **state)
{
    (void)state;
    assert_filled("a.exr", &frames, 7, "a.0007.exr");
    assert_filled("a.b/walk", &frames, 7, "a.b/walk.0007");
    assert_filled(".exr", &frames, 7, ".exr.0007");
    assert_filled("a.exr", &one_frame, 7, "a.exr"); /* one picture needs no number */
    assert_filled("a.exr", &cameras, 0, "a.Front.exr");
    assert_filled("a.exr", &both, 7, "a.Front.0007.exr");
    assert_filled("b/a_####.exr", &both, 7, "b/a_Front_0007.exr");
    assert_filled("b/####.exr", &both, 7, "b/Front.0007.exr");
    assert_filled("a%04d.exr", &both, 7, "a.Front.0007.exr");
    assert_filled("a.%c.exr", &both, 7, "a.Front.0007.exr");
}

/* An INPUT whose name looks like a pattern, as the default output has it. */
static void an_escaped_name_is_filled_in_as_itself(void **state)
{
    (void)state;
    static const char *const names[] = {"100% #1 %04d.exr", "plain.exr", "%%.exr"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char *const pattern = pattern_escape(names[i], &one_frame);
        assert_filled(pattern, &one_frame, 7, names[i]);
        free(pattern);
        char *const same = pattern_escape(names[i], &no_use);
        assert_filled(same, &no_use, 7, names[i]);
        free(same);
    }
}

static void assert_safe(const char *name, const char *expected)
{
    char *const safe = pattern_safe_name(name);
    assert_string_equal(safe, expected);
    free(safe);
}

static void names_of_cameras_are_made_safe(void **state)
{
    (void)state;
    assert_safe("Camera.001", "Camera.001");
    assert_safe("../../etc/passwd", "_._.._etc_passwd");
    assert_safe("a b\n\x1b[2J%d#", "a_b___2J_d_");
    assert_safe("Kamera vorn \xc3\xbc", "Kamera_vorn_\xc3\xbc");
    char name[200];
    memset(name, 'a', sizeof name);
    name[sizeof name - 1] = '\0';
    memcpy(name + 79, "\xc3\xbc", 2); /* the 80th byte is within a letter */
    char *const safe = pattern_safe_name(name);
    assert_int_equal(strlen(safe), 79);
    free(safe);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_conversions_are_faults),
        cmocka_unit_test(there_is_one_place_of_each_kind),
        cmocka_unit_test(without_a_use_a_name_is_what_it_is),
        cmocka_unit_test(places_are_filled_in),
        cmocka_unit_test(folders_are_taken_as_they_are),
        cmocka_unit_test(a_missing_place_is_put_in),
        cmocka_unit_test(an_escaped_name_is_filled_in_as_itself),
        cmocka_unit_test(names_of_cameras_are_made_safe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
