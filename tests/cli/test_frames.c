/* Ranges of frames, and their seeds. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../src/cli/frames.h"

static void what_is_no_range_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",    "-",       "--", "a",  "1-", "1-2-3", "1/2",       "1-5/", "1-5/0", "1-5/-1",
        "1.5", "1-5/2/2", " 1", "1 ", "+1", "1..5",  "999999999", "0x10", "1-5x2", "0-1000000"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        frame_range range = {11, 12, 13};
        if (frames_parse(texts[i], &range)) fail_msg("'%s' was taken for frames", texts[i]);
        assert_int_equal(range.first, 11);
    }
}

static void what_is_no_frame_is_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {"", "-", "1-2", "1.0", "1e3", "10000001", "--1"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        int32_t frame = 11;
        if (frames_parse_one(texts[i], &frame)) fail_msg("'%s' was taken for a frame", texts[i]);
        assert_int_equal(frame, 11);
    }
}

/* frames of text, ended by 99 */
static void assert_frames(const char *text, const int32_t *expected)
{
    frame_range range;
    if (!frames_parse(text, &range)) fail_msg("'%s' was not taken for frames", text);
    size_t count = 0;
    for (; expected[count] != 99; count++)
        if (count < frames_count(&range)) {
            assert_int_equal(frames_at(&range, count), expected[count]);
        }
    assert_int_equal(frames_count(&range), count);
}

static void ranges_go_forwards_and_backwards_by_steps(void **state)
{
    (void)state;
    assert_frames("7", (const int32_t[]){7, 99});
    assert_frames("-7", (const int32_t[]){-7, 99});
    assert_frames("0", (const int32_t[]){0, 99});
    assert_frames("1-4", (const int32_t[]){1, 2, 3, 4, 99});
    assert_frames("3-3/5", (const int32_t[]){3, 99});
    assert_frames("1-10/4", (const int32_t[]){1, 5, 9, 99});
    assert_frames("4-1", (const int32_t[]){4, 3, 2, 1, 99});
    assert_frames("10-1/4", (const int32_t[]){10, 6, 2, 99});
    assert_frames("-2-1", (const int32_t[]){-2, -1, 0, 1, 99});
    assert_frames("-5--1/2", (const int32_t[]){-5, -3, -1, 99});
    assert_frames("1--1", (const int32_t[]){1, 0, -1, 99});
}

static int compare(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* 64 seeds of 64 frames from -32 on: 4096 numbers of 63 bits that are all different by chance with
 * a probability of 1 - 1e-12. */
static void no_two_frames_of_any_seed_share_their_noise(void **state)
{
    (void)state;
    enum { COUNT = 64 };
    static uint64_t seeds[COUNT * COUNT];
    for (int i = 0; i < COUNT * COUNT; i++) {
        seeds[i] = frames_seed((uint64_t)(i / COUNT), i % COUNT - COUNT / 2);
        assert_true(seeds[i] <= INT64_MAX);
    }
    qsort(seeds, COUNT * COUNT, sizeof seeds[0], compare);
    for (int i = 1; i < COUNT * COUNT; i++)
        assert_true(seeds[i] != seeds[i - 1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_no_range_is_refused),
        cmocka_unit_test(what_is_no_frame_is_refused),
        cmocka_unit_test(ranges_go_forwards_and_backwards_by_steps),
        cmocka_unit_test(no_two_frames_of_any_seed_share_their_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
