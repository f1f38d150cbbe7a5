/* The context: reporting, last error, counted memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/context.h"

typedef struct log_record {
    int count;
    ppm_log_level level;
    char text[128];
} log_record;

static void record(void *user, ppm_log_level level, const char *message)
{
    log_record *log = user;
    log->count++;
    log->level = level;
    strncpy(log->text, message, sizeof log->text - 1);
}

static void refuses_missing_out(void **state)
{
    (void)state;
    assert_int_equal(ppm_context_create(NULL, NULL), PPM_STATUS_INVALID_ARGUMENT);
    const ppm_context_desc too_small = {.size = 4};
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(&too_small, &context), PPM_STATUS_INVALID_ARGUMENT);
    assert_null(context);
}

static void failure_is_logged_and_kept(void **state)
{
    (void)state;
    log_record log = {0};
    const ppm_context_desc desc = {.size = sizeof desc, .log = record, .log_user = &log};
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(&desc, &context), PPM_STATUS_OK);
    assert_int_equal(ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "file %d", 7),
                     PPM_STATUS_INPUT_INVALID);
    assert_int_equal(log.count, 1);
    assert_int_equal(log.level, PPM_LOG_ERROR);
    assert_string_equal(log.text, "file 7");
    char kept[4];
    assert_int_equal(ppm_context_last_error(context, kept, sizeof kept), 6);
    assert_string_equal(kept, "fil");
    ppm_context_destroy(context);
}

static void control_characters_are_shown_and_not_obeyed(void **state)
{
    (void)state;
    log_record log = {0};
    const ppm_context_desc desc = {.size = sizeof desc, .log = record, .log_user = &log};
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(&desc, &context), PPM_STATUS_OK);
    ppmi_log(context, PPM_LOG_WARNING, "a%sb",
             "\x1b[31m\a\x7f\n\xc2\x9b"
             "2J \xc3\xa9");
    assert_string_equal(log.text, "a\\x1b[31m\\x07\\x7f\\x0a\\xc2\\x9b2J \xc3\xa9"
                                  "b");
    char many[4000];
    memset(many, '\x1b', sizeof many - 1);
    many[sizeof many - 1] = '\0';
    ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s", many);
    assert_memory_equal(log.text, "\\x1b\\x1b", 8);
    ppm_context_destroy(context);
}

static void memory_is_counted_and_can_fail(void **state)
{
    (void)state;
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(NULL, &context), PPM_STATUS_OK);
    assert_null(ppmi_alloc(context, 0, 8));
    assert_null(ppmi_alloc(context, SIZE_MAX / 2, 8));
    void *block = ppmi_alloc(context, 3, 5);
    assert_non_null(block);
    assert_int_equal((uintptr_t)block % 64, 0);
    assert_int_equal(ppmi_alloc_live(context), 1);
    ppmi_alloc_fail_at(context, 2);
    void *first = ppmi_alloc(context, 1, 1);
    assert_non_null(first);
    assert_null(ppmi_alloc(context, 1, 1));
    void *third = ppmi_alloc(context, 1, 1);
    assert_non_null(third);
    ppmi_free(context, block);
    ppmi_free(context, first);
    ppmi_free(context, third);
    assert_int_equal(ppmi_alloc_live(context), 0);
    ppm_context_destroy(context);
}

static void a_fork_keeps_its_messages_until_it_is_joined(void **state)
{
    (void)state;
    log_record log = {0};
    const ppm_context_desc desc = {.size = sizeof desc, .log = record, .log_user = &log};
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(&desc, &context), PPM_STATUS_OK);
    ppm_context *first = ppmi_context_fork(context), *second = ppmi_context_fork(context);
    ppmi_log(second, PPM_LOG_WARNING, "early");
    ppmi_fail(first, PPM_STATUS_INPUT_INVALID, "one");
    ppmi_log(first, PPM_LOG_WARNING, "two");
    assert_int_equal(log.count, 0);
    ppmi_context_join(first);
    assert_int_equal(log.count, 2);
    assert_string_equal(log.text, "two");
    char error[8];
    ppm_context_last_error(context, error, sizeof error);
    assert_string_equal(error, "one");
    ppmi_context_join(second);
    assert_string_equal(log.text, "early");
    ppmi_context_join(NULL);
    ppm_context_destroy(context);
}

static void a_fork_uses_the_memory_of_its_parent(void **state)
{
    (void)state;
    ppm_context *context = NULL;
    assert_int_equal(ppm_context_create(NULL, &context), PPM_STATUS_OK);
    ppm_context *fork = ppmi_context_fork(context);
    void *block = ppmi_alloc(fork, 10, 1);
    assert_int_equal(ppmi_alloc_live(context), 1);
    ppmi_alloc_fail_at(context, 1);
    assert_null(ppmi_alloc(fork, 10, 1));
    ppmi_context_join(fork);
    ppmi_free(context, block); /* lives on */
    assert_int_equal(ppmi_alloc_live(context), 0);
    ppm_context_destroy(context);
}

static void every_status_has_a_name(void **state)
{
    (void)state;
    assert_string_equal(ppm_status_name(PPM_STATUS_OUT_OF_MEMORY), "OUT_OF_MEMORY");
    assert_string_equal(ppm_status_name(12345), "UNKNOWN");
    assert_string_equal(ppm_status_text(PPM_STATUS_OK), "success");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refuses_missing_out),
        cmocka_unit_test(failure_is_logged_and_kept),
        cmocka_unit_test(control_characters_are_shown_and_not_obeyed),
        cmocka_unit_test(memory_is_counted_and_can_fail),
        cmocka_unit_test(a_fork_keeps_its_messages_until_it_is_joined),
        cmocka_unit_test(a_fork_uses_the_memory_of_its_parent),
        cmocka_unit_test(every_status_has_a_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
