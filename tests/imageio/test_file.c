/* Files are replaced whole or not at all. */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "imageio/file.h"
#include "imageio/scratch.h"

static ppm_context *context;

static int setup(void **state)
{
    (void)state;
    scratch_create();
    return ppm_context_create(NULL, &context);
}

static int teardown(void **state)
{
    (void)state;
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    scratch_remove();
    return live == 0 ? 0 : 1;
}

static void assert_holds(const char *name, const char *text)
{
    void *bytes = NULL;
    size_t byte_count = 0;
    assert_int_equal(ppmi_imageio_file_read(context, scratch_path(name), name, &bytes, &byte_count),
                     PPM_STATUS_OK);
    assert_int_equal(byte_count, strlen(text));
    assert_memory_equal(bytes, text, byte_count);
    ppmi_free(context, bytes);
}

static ppm_status replace(const char *name, const char *text)
{
    return ppmi_imageio_file_replace(context, scratch_path(name), text, strlen(text));
}

static void assert_error_names(const char *part)
{
    char message[1024];
    ppm_context_last_error(context, message, sizeof message);
    if (!strstr(message, part)) fail_msg("\"%s\" is not in \"%s\"", part, message);
}

/* Runs body in a child process, which may then change what it is allowed to. */
static void in_child(void (*body)(void))
{
    fflush(NULL);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        body();
        _exit(0);
    }
    int result = 0;
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_true(WIFEXITED(result));
    assert_int_equal(WEXITSTATUS(result), 0);
}

static void check_in_child(bool is_true, const char *text)
{
    if (is_true) return;
    fprintf(stderr, "in the child process: not true: %s\n", text);
    _exit(1);
}
#define CHECK_IN_CHILD(condition) check_in_child(condition, #condition)

static void what_is_written_can_be_read(void **state)
{
    (void)state;
    assert_int_equal(replace("new.txt", "first"), PPM_STATUS_OK);
    assert_holds("new.txt", "first");
    assert_int_equal(replace("new.txt", "second one"), PPM_STATUS_OK);
    assert_holds("new.txt", "second one");
    assert_int_equal(scratch_count(), 1);
}

static void missing_and_empty_files_and_folders_are_not_read(void **state)
{
    (void)state;
    void *bytes = NULL;
    size_t byte_count = 0;
    assert_int_equal(
        ppmi_imageio_file_read(context, scratch_path("none"), "none", &bytes, &byte_count),
        PPM_STATUS_INPUT_NOT_FOUND);
    scratch_write("empty", "", 0);
    assert_int_equal(
        ppmi_imageio_file_read(context, scratch_path("empty"), "empty", &bytes, &byte_count),
        PPM_STATUS_INPUT_INVALID);
    assert_int_equal(ppmi_imageio_file_read(context, scratch_path(""), "dir", &bytes, &byte_count),
                     PPM_STATUS_INPUT_INVALID);
    assert_null(bytes);
}

static void a_pipe_is_refused_and_not_waited_for(void **state)
{
    (void)state;
    assert_int_equal(mkfifo(scratch_path("pipe"), 0600), 0);
    void *bytes = NULL;
    size_t byte_count = 0;
    assert_int_equal(
        ppmi_imageio_file_read(context, scratch_path("pipe"), "pipe", &bytes, &byte_count),
        PPM_STATUS_INPUT_INVALID);
    assert_int_equal(replace("pipe", "text"), PPM_STATUS_OUTPUT_NOT_WRITABLE);
    struct stat facts;
    assert_int_equal(stat(scratch_path("pipe"), &facts), 0);
    assert_true(S_ISFIFO(facts.st_mode));
}

static void a_missing_folder_is_named(void **state)
{
    (void)state;
    assert_int_equal(replace("no/such/file.txt", "text"), PPM_STATUS_OUTPUT_NOT_WRITABLE);
    assert_error_names("no/such/file.txt");
    assert_error_names("No such file or directory");
    assert_int_equal(ppmi_imageio_file_check(context, scratch_path("no/such/file.txt")),
                     PPM_STATUS_OUTPUT_NOT_WRITABLE);
}

static void write_in_locked_folder(void)
{
    /* the superuser may write everywhere */
    if (geteuid() == 0) CHECK_IN_CHILD(setuid(65534) == 0);
    CHECK_IN_CHILD(replace("kept.txt", "new") == PPM_STATUS_OUTPUT_NOT_WRITABLE);
    CHECK_IN_CHILD(ppmi_imageio_file_check(context, scratch_path("kept.txt")) ==
                   PPM_STATUS_OUTPUT_NOT_WRITABLE);
}

static void a_folder_without_permission_keeps_its_file(void **state)
{
    (void)state;
    scratch_write_text("kept.txt", "old");
    assert_int_equal(chmod(scratch_path(""), 0555), 0);
    in_child(write_in_locked_folder);
    assert_int_equal(chmod(scratch_path(""), 0755), 0);
    assert_holds("kept.txt", "old");
    assert_int_equal(scratch_count(), 1);
}

static void write_beyond_limit(void)
{
    enum { LIMIT = 10000 };
    static char large[3 * LIMIT];
    const struct rlimit limit = {.rlim_cur = LIMIT, .rlim_max = LIMIT};
    signal(SIGXFSZ, SIG_IGN);
    CHECK_IN_CHILD(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    CHECK_IN_CHILD(ppmi_imageio_file_replace(context, scratch_path("kept.txt"), large,
                                             sizeof large) == PPM_STATUS_OUTPUT_NOT_WRITABLE);
}

static void a_write_that_falls_short_keeps_the_old_file(void **state)
{
    (void)state;
    scratch_write_text("kept.txt", "old");
    in_child(write_beyond_limit);
    assert_holds("kept.txt", "old");
    assert_int_equal(scratch_count(), 1);
}

static void a_folder_of_that_name_is_refused(void **state)
{
    (void)state;
    assert_int_equal(mkdir(scratch_path("folder.png"), 0755), 0);
    assert_int_equal(replace("folder.png", "text"), PPM_STATUS_OUTPUT_NOT_WRITABLE);
    assert_error_names("not a regular file");
    assert_int_equal(scratch_count(), 1);
}

static void a_link_is_followed(void **state)
{
    (void)state;
    scratch_write_text("target.txt", "old");
    assert_int_equal(symlink("target.txt", scratch_path("link.txt")), 0);
    assert_int_equal(replace("link.txt", "new"), PPM_STATUS_OK);
    assert_holds("target.txt", "new");
    struct stat facts;
    assert_int_equal(lstat(scratch_path("link.txt"), &facts), 0);
    assert_true(S_ISLNK(facts.st_mode));
}

static void permissions_are_kept(void **state)
{
    (void)state;
    scratch_write_text("private.txt", "old");
    assert_int_equal(chmod(scratch_path("private.txt"), 0600), 0);
    assert_int_equal(replace("private.txt", "new"), PPM_STATUS_OK);
    struct stat facts;
    assert_int_equal(stat(scratch_path("private.txt"), &facts), 0);
    assert_int_equal(facts.st_mode & 0777, 0600);
}

static void a_check_leaves_nothing(void **state)
{
    (void)state;
    assert_int_equal(ppmi_imageio_file_check(context, scratch_path("a.png")), PPM_STATUS_OK);
    assert_int_equal(scratch_count(), 0);
}

static void a_name_as_long_as_names_may_be_works(void **state)
{
    (void)state;
    char name[256];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    assert_int_equal(replace(name, "text"), PPM_STATUS_OK);
    assert_holds(name, "text");
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    scratch_write_text("kept.txt", "old");
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    int failures = 0;
    for (size_t n = 1; status == PPM_STATUS_OUT_OF_MEMORY; n++) {
        assert_holds("kept.txt", "old");
        ppmi_alloc_fail_at(context, n);
        status = replace("kept.txt", "new");
        ppmi_alloc_fail_at(context, 0);
        assert_int_equal(scratch_count(), 1);
        if (status == PPM_STATUS_OUT_OF_MEMORY) failures++;
    }
    assert_int_equal(status, PPM_STATUS_OK);
    assert_true(failures >= 2);
    assert_holds("kept.txt", "new");
}

static void a_link_to_where_no_file_is_yet_is_followed(void **state)
{
    (void)state;
    char target[512], folder[512];
    snprintf(target, sizeof target, "%s", scratch_path("target.txt"));
    assert_int_equal(symlink("target.txt", scratch_path("relative")), 0);
    assert_int_equal(symlink(target, scratch_path("absolute")), 0);
    assert_int_equal(symlink("relative", scratch_path("twice")), 0);
    static const char *const links[] = {"relative", "absolute", "twice"};
    for (int i = 0; i < 3; i++) {
        struct stat facts;
        assert_int_equal(ppmi_imageio_file_check(context, scratch_path(links[i])), PPM_STATUS_OK);
        assert_int_equal(replace(links[i], "new"), PPM_STATUS_OK);
        assert_holds("target.txt", "new");
        assert_int_equal(lstat(scratch_path(links[i]), &facts), 0);
        assert_true(S_ISLNK(facts.st_mode));
        assert_int_equal(remove(target), 0);
    }
    snprintf(folder, sizeof folder, "%s", scratch_path("missing/target.txt"));
    assert_int_equal(symlink(folder, scratch_path("nowhere")), 0);
    assert_int_equal(replace("nowhere", "new"), PPM_STATUS_OUTPUT_NOT_WRITABLE);
}

static void a_read_only_file_is_not_replaced(void **state)
{
    (void)state;
    assert_int_equal(replace("kept.txt", "old"), PPM_STATUS_OK);
    assert_int_equal(chmod(scratch_path("kept.txt"), 0444), 0);
    assert_int_equal(ppmi_imageio_file_check(context, scratch_path("kept.txt")),
                     PPM_STATUS_OUTPUT_NOT_WRITABLE);
    assert_int_equal(replace("kept.txt", "new"), PPM_STATUS_OUTPUT_NOT_WRITABLE);
    assert_error_names("read-only");
    assert_holds("kept.txt", "old");
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(what_is_written_can_be_read),
        TEST(missing_and_empty_files_and_folders_are_not_read),
        TEST(a_pipe_is_refused_and_not_waited_for),
        TEST(a_missing_folder_is_named),
        TEST(a_folder_without_permission_keeps_its_file),
        TEST(a_write_that_falls_short_keeps_the_old_file),
        TEST(a_folder_of_that_name_is_refused),
        TEST(a_link_is_followed),
        TEST(permissions_are_kept),
        TEST(a_check_leaves_nothing),
        TEST(a_name_as_long_as_names_may_be_works),
        TEST(every_allocation_may_fail),
        TEST(a_link_to_where_no_file_is_yet_is_followed),
        TEST(a_read_only_file_is_not_replaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
