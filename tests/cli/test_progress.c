/* When a render stops, and what is said on the way. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../src/cli/progress.h"

static cli_progress stops(uint64_t pass_limit, double seconds_limit)
{
    cli_progress progress;
    progress_init(&progress, pass_limit, seconds_limit);
    return progress;
}

static void nothing_is_done_before_the_first_pass(void **state)
{
    (void)state;
    const cli_progress progress = stops(1, 1.0);
    assert_false(progress_is_done(&progress, 0, 100.0));
}

static void the_pass_limit_stops(void **state)
{
    (void)state;
    const cli_progress progress = stops(10, 0.0);
    assert_false(progress_is_done(&progress, 9, 1e6));
    assert_true(progress_is_done(&progress, 10, 0.1));
}

static void the_time_is_met_at_the_nearest_end_of_a_pass(void **state)
{
    (void)state;
    const cli_progress progress = stops(0, 10.0);
    /* passes of 3 s: after 3 there is 1 s left, after 2 there are 4 s */
    assert_false(progress_is_done(&progress, 2, 6.0));
    assert_true(progress_is_done(&progress, 3, 9.0));
    /* passes of 4 s: a third one ends 2 s late, the second 2 s early */
    assert_true(progress_is_done(&progress, 2, 8.0));
}

static void whichever_stop_is_nearest_counts(void **state)
{
    (void)state;
    const cli_progress progress = stops(100, 10.0);
    const ppm_render_stats stats = {.size = sizeof stats,
                                    .passes = 25,
                                    .photons_emitted = 25000000,
                                    .rays = 1,
                                    .seconds_render = 5.0};
    char line[160];
    assert_string_equal(progress_line(&progress, &stats, 5.0, line, sizeof line),
                        "pass 25/100   50%  5.00 M photons/s  0:05 left");
}

static void a_path_tracer_counts_rays(void **state)
{
    (void)state;
    const cli_progress progress = stops(0, 7200.0);
    const ppm_render_stats stats = {
        .size = sizeof stats, .passes = 1, .rays = 500000, .seconds_render = 1.0};
    char line[160];
    assert_string_equal(progress_line(&progress, &stats, 0.0, line, sizeof line),
                        "pass 1    0%  500 k rays/s  2:00:00 left");
}

/* Half of a picture of 10 s is left, and three more: they take as long as this one seems to, or,
 * where there were pictures before, as long as those did. */
static void the_time_left_of_a_sequence_is_that_of_all_its_pictures(void **state)
{
    (void)state;
    cli_progress progress = stops(10, 0.0);
    const ppm_render_stats stats = {
        .size = sizeof stats, .passes = 5, .rays = 5000000, .seconds_render = 5.0};
    char line[160];
    progress_set_sequence(&progress, "frame 7 (2 of 5)  ", 3, 0.0);
    assert_string_equal(progress_line(&progress, &stats, 5.0, line, sizeof line),
                        "frame 7 (2 of 5)  pass 5/10   50%  1.00 M rays/s  0:35 left");
    progress_set_sequence(&progress, "", 3, 20.0);
    assert_string_equal(progress_line(&progress, &stats, 5.0, line, sizeof line),
                        "pass 5/10   50%  1.00 M rays/s  1:05 left");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_done_before_the_first_pass),
        cmocka_unit_test(the_pass_limit_stops),
        cmocka_unit_test(the_time_is_met_at_the_nearest_end_of_a_pass),
        cmocka_unit_test(whichever_stop_is_nearest_counts),
        cmocka_unit_test(a_path_tracer_counts_rays),
        cmocka_unit_test(the_time_left_of_a_sequence_is_that_of_all_its_pictures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
