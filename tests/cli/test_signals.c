/* Stopping a render from outside, and watching its pictures while it runs. */
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/program.h"
#include "imageio/imageio.h"

#define ENDLESS "-s 32x16 -n 1000000000 -p 4096 "

static void take_a_moment(void)
{
    const struct timespec moment = {.tv_nsec = 2000000};
    nanosleep(&moment, NULL);
}

static void assert_complete(const char *path, uint32_t width, uint32_t height)
{
    ppmi_pixels pixels = {0};
    const ppm_status status = ppmi_imageio_read_file(NULL, path, path, &pixels);
    if (status != PPM_STATUS_OK) fail_msg("%s: %s", path, ppm_status_name(status));
    assert_int_equal(pixels.width, width);
    assert_int_equal(pixels.height, height);
    ppmi_imageio_pixels_free(NULL, &pixels);
}

/* A folder takes the place of the file while the program renders. */
static void a_picture_for_display_that_fails_is_saved_as_exr(void **state)
{
    (void)state;
    test_process process;
    start_program(&process, ENDLESS "-o lost.png tiny.gltf");
    wait_for_text(&process, "pass 4/");
    remove("lost.png"); /* may have been refreshed */
    assert_int_equal(mkdir("lost.png", 0777), 0);
    kill(process.pid, SIGINT);
    assert_int_equal(wait_for_end(&process), 3);
    assert_contains(process.err, "lost.png: not written; the picture is saved as lost.exr");
    assert_complete("lost.exr", 32, 16);
    assert_int_equal(rmdir("lost.png"), 0);
    assert_int_equal(remove("lost.exr"), 0);
}

/* Files end at 512 or 1024 bytes: less than any of these takes. */
static void a_full_disk_leaves_nothing_half_written(void **state)
{
    (void)state;
    test_process process;
    start_wrapped_program(&process, "ulimit -f 1;",
                          "-s 64x64 -n 1 -p 4096 -o full.png -o full.exr tiny.gltf");
    assert_int_equal(wait_for_end(&process), 3);
    assert_contains(process.err, "full.png");
    assert_contains(process.err, "could not be saved beside it either");
    assert_int_equal(access("full.png", F_OK), -1);
    assert_int_equal(access("full.exr", F_OK), -1);
    assert_int_equal(access("full.png.exr", F_OK), -1);
}

static void assert_stops_with_pictures(int number, const char *options)
{
    char arguments[256];
    snprintf(arguments, sizeof arguments, ENDLESS "%s -o stopped.exr -o stopped.png tiny.gltf",
             options);
    test_process process;
    start_program(&process, arguments);
    wait_for_text(&process, "pass 4/");
    kill(process.pid, number);
    const int status = wait_for_end(&process);
    if (status != 0) fail_msg("status %d: %s", status, process.err);
    assert_contains(process.err, "stopped by a signal after");
    assert_complete("stopped.exr", 32, 16);
    assert_complete("stopped.png", 32, 16);
    assert_int_equal(remove("stopped.exr"), 0);
    assert_int_equal(remove("stopped.png"), 0);
}

static void an_interrupt_leaves_the_picture_so_far(void **state)
{
    (void)state;
    assert_stops_with_pictures(SIGINT, "");
    assert_stops_with_pictures(SIGINT, "-i path");
}

static void a_termination_leaves_the_picture_so_far(void **state)
{
    (void)state;
    assert_stops_with_pictures(SIGTERM, "");
}

/* A terminal that is closed. */
static void a_hangup_leaves_the_picture_so_far(void **state)
{
    (void)state;
    assert_stops_with_pictures(SIGHUP, "");
}

static void nohup_is_heeded(void **state)
{
    (void)state;
    test_process process;
    start_wrapped_program(&process, "trap '' HUP;", "-s 32x16 -n 1000 -p 100 -o n.exr tiny.gltf");
    wait_for_text(&process, "pass 1/");
    kill(process.pid, SIGHUP);
    assert_int_equal(wait_for_end(&process), 0);
    assert_null(strstr(process.err, "stopped by a signal"));
    assert_int_equal(remove("n.exr"), 0);
}

/* A batch system does not wait for a pass of minutes. */
static void a_termination_during_the_first_pass_ends_at_once(void **state)
{
    (void)state;
    static const int numbers[] = {SIGTERM, SIGHUP};
    static const char *const integrators[] = {"sppm", "path"};
    for (int i = 0; i < 2; i++) {
        char arguments[160];
        test_process process;
        snprintf(arguments, sizeof arguments,
                 "-i %s -s 1024x1024 -n 2 -p 16M --threads 1 -o term.exr tiny.gltf",
                 integrators[i]);
        start_program(&process, arguments);
        wait_for_text(&process, "rendering 1024 x 1024");
        kill(process.pid, numbers[i]);
        const int status = wait_for_end(&process);
        if (status != 130) fail_msg("status %d: %s", status, process.err);
        assert_contains(process.err, "stopped by a signal after 0 passes");
        assert_int_equal(access("term.exr", F_OK), -1);
    }
}

/* The scene is a pipe that nobody fills, so that reading it never ends. */
static void a_signal_while_the_scene_is_read_ends_at_once(void **state)
{
    (void)state;
    assert_int_equal(mkfifo("pipe.gltf", 0666), 0);
    test_process process;
    start_program(&process, "-o pipe.exr pipe.gltf");
    int pipe_end = -1;
    while ((pipe_end = open("pipe.gltf", O_WRONLY | O_NONBLOCK)) < 0) { /* until it is read */
        if (has_ended(&process)) fail_msg("ended early:\n%s", process.err);
        take_a_moment();
    }
    kill(process.pid, SIGINT);
    const int status = wait_for_end(&process);
    close(pipe_end);
    if (status != 130) fail_msg("status %d: %s", status, process.err);
    assert_contains(process.err, "there is no picture");
    assert_int_equal(access("pipe.exr", F_OK), -1);
}

/* A first pass of seconds, so that it cannot end between the two signals. */
static void a_second_signal_ends_at_once(void **state)
{
    (void)state;
    test_process process;
    start_program(&process, "-s 512x512 -n 2 -p 8M -o second.exr tiny.gltf");
    wait_for_text(&process, "rendering 512 x 512");
    kill(process.pid, SIGINT);
    wait_for_text(&process, "stopping after the first pass");
    kill(process.pid, SIGTERM);
    assert_int_equal(wait_for_end(&process), 130);
    assert_int_equal(access("second.exr", F_OK), -1);
}

static void a_signal_during_the_first_pass_lets_it_finish(void **state)
{
    (void)state;
    test_process process;
    start_program(&process, "-s 128x128 -n 1000000000 -p 1M -o first.exr tiny.gltf");
    wait_for_text(&process, "rendering 128 x 128");
    kill(process.pid, SIGINT);
    const int status = wait_for_end(&process);
    if (status != 0) fail_msg("status %d: %s", status, process.err);
    assert_contains(process.err, "stopped by a signal after 1 pass\n");
    assert_complete("first.exr", 128, 128);
}

/* A disk that goes away: what can still be written is, and the status tells. */
static void one_lost_output_does_not_cost_the_others(void **state)
{
    (void)state;
    assert_int_equal(mkdir("lost", 0777), 0);
    test_process process;
    start_program(&process, ENDLESS "--stats kept.json -o lost/a.exr -o kept.exr tiny.gltf");
    wait_for_text(&process, "pass 1/");
    assert_int_equal(rename("lost", "gone"), 0);
    kill(process.pid, SIGINT);
    const int status = wait_for_end(&process);
    if (status != 3) fail_msg("status %d: %s", status, process.err);
    assert_contains(process.err, "lost/a.exr");
    assert_complete("kept.exr", 32, 16);
    assert_int_equal(access("kept.json", F_OK), 0);
}

/* Waits for a file as a viewer would, without help from the program. */
static void wait_for_file(const test_process *process, const char *path)
{
    while (access(path, F_OK) != 0) {
        if (has_ended(process)) fail_msg("no %s:\n%s", path, process->err);
        take_a_moment();
    }
}

/* The pictures are large, so that writing one in place would be caught half way. */
static void pictures_are_complete_from_the_moment_they_appear(void **state)
{
    (void)state;
    test_process process;
    start_program(&process, "-q -s 1024x1024 -n 1000000000 -p 1 -o seen.exr -o seen.png tiny.gltf");
    wait_for_file(&process, "seen.exr");
    assert_complete("seen.exr", 1024, 1024);
    wait_for_file(&process, "seen.png");
    assert_complete("seen.png", 1024, 1024);
    kill(process.pid, SIGINT);
    assert_int_equal(wait_for_end(&process), 0);
    assert_complete("seen.exr", 1024, 1024);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_for_display_that_fails_is_saved_as_exr),
        cmocka_unit_test(a_full_disk_leaves_nothing_half_written),
        cmocka_unit_test(an_interrupt_leaves_the_picture_so_far),
        cmocka_unit_test(a_termination_leaves_the_picture_so_far),
        cmocka_unit_test(a_hangup_leaves_the_picture_so_far),
        cmocka_unit_test(nohup_is_heeded),
        cmocka_unit_test(a_termination_during_the_first_pass_ends_at_once),
        cmocka_unit_test(a_signal_while_the_scene_is_read_ends_at_once),
        cmocka_unit_test(a_second_signal_ends_at_once),
        cmocka_unit_test(a_signal_during_the_first_pass_lets_it_finish),
        cmocka_unit_test(one_lost_output_does_not_cost_the_others),
        cmocka_unit_test(pictures_are_complete_from_the_moment_they_appear),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
