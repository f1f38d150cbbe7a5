/* importers/obj/obj_lines.c: what counts as a statement. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "obj/obj_lines.h"
#include "obj_fixture.h"

/* Writes bytes to a file and its statements to out, "number:text|". */
static void read_statements(obj_fixture *f, const char *bytes, size_t count, char *out, size_t size)
{
    ppmi_obj_lines lines;
    size_t used = 0, length;
    obj_write(f, "lines", bytes, count);
    char path[160];
    snprintf(path, sizeof path, "%s", obj_path(f, "lines"));
    assert_int_equal(ppmi_obj_lines_open(f->context, path, &lines), PPM_STATUS_OK);
    out[0] = 0;
    for (char *text; (text = ppmi_obj_lines_next(&lines, &length));) {
        assert_int_equal(text[length], '\n');
        used +=
            (size_t)snprintf(out + used, size - used, "%zu:%.*s|", lines.number, (int)length, text);
        assert_true(used < size);
    }
    assert_int_equal(lines.status, PPM_STATUS_OK);
    ppmi_obj_lines_close(&lines);
}

static void check(obj_fixture *f, const char *text, const char *expected)
{
    char out[256];
    read_statements(f, text, strlen(text), out, sizeof out);
    assert_string_equal(out, expected);
}

static void line_ends_may_be_lf_crlf_or_cr(void **state)
{
    check(*state, "a\nb\n", "1:a|2:b|");
    check(*state, "a\r\nb\r\n", "1:a|2:b|");
    check(*state, "a\rb\r", "1:a|2:b|");
    check(*state, "a\r\rb\r\n\nc\rd\n", "1:a|3:b|5:c|6:d|");
}

static void the_last_line_needs_no_end(void **state)
{
    check(*state, "a\nb", "1:a|2:b|");
    check(*state, "a\rb", "1:a|2:b|");
    check(*state, "a\\", "1:a\\|");
    check(*state, "", "");
}

static void blanks_comments_and_a_byte_order_mark_are_left_out(void **state)
{
    check(*state,
          "\xef\xbb\xbf"
          " \t a  b\t \n\n  # c\n#d\ne",
          "1:a  b|5:e|");
}

static void a_backslash_at_the_end_continues_a_line(void **state)
{
    check(*state, "a \\\nb\\\r\nc\nd\\e\n", "1:a   b   c|4:d\\e|");
    check(*state, "a\\\rb\rc\n", "1:a  b|3:c|");
}

static void a_comment_does_not_continue(void **state)
{
    check(*state, " # made in C:\\files\\\nv 1\n", "2:v 1|");
}

static void lines_may_be_longer_than_the_buffer_and_lie_across_its_end(void **state)
{
    obj_fixture *f = *state;
    enum { LINE = 700000, SHORT = 37 };
    const size_t count = (size_t)LINE + 40000u * SHORT;
    char *text = malloc(count);
    assert_non_null(text);
    memset(text, 'x', count);
    text[LINE - 1] = '\n';
    for (size_t i = 0; i < 40000; ++i) {
        text[LINE + i * SHORT + SHORT - 1] = '\n';
    }
    obj_write(f, "lines", text, count);
    free(text);
    ppmi_obj_lines lines;
    size_t length;
    char path[160];
    snprintf(path, sizeof path, "%s", obj_path(f, "lines"));
    assert_int_equal(ppmi_obj_lines_open(f->context, path, &lines), PPM_STATUS_OK);
    assert_non_null(ppmi_obj_lines_next(&lines, &length));
    assert_int_equal(length, LINE - 1);
    size_t more = 0;
    while (ppmi_obj_lines_next(&lines, &length)) {
        assert_int_equal(length, SHORT - 1);
        ++more;
    }
    assert_int_equal(more, 40000);
    ppmi_obj_lines_close(&lines);
}

static void a_missing_file_and_a_folder_are_refused(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import_file(f, "sub/none.obj"), PPM_STATUS_INPUT_NOT_FOUND);
    assert_obj_logged(f, 'E', "sub/none.obj");
    assert_obj_status(f, obj_import_file(f, "sub"), PPM_STATUS_INPUT_INVALID);
    assert_obj_logged(f, 'E', "cannot be read");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(line_ends_may_be_lf_crlf_or_cr, obj_setup, obj_teardown),
        cmocka_unit_test_setup_teardown(the_last_line_needs_no_end, obj_setup, obj_teardown),
        cmocka_unit_test_setup_teardown(blanks_comments_and_a_byte_order_mark_are_left_out,
                                        obj_setup, obj_teardown),
        cmocka_unit_test_setup_teardown(a_backslash_at_the_end_continues_a_line, obj_setup,
                                        obj_teardown),
        cmocka_unit_test_setup_teardown(a_comment_does_not_continue, obj_setup, obj_teardown),
        cmocka_unit_test_setup_teardown(lines_may_be_longer_than_the_buffer_and_lie_across_its_end,
                                        obj_setup, obj_teardown),
        cmocka_unit_test_setup_teardown(a_missing_file_and_a_folder_are_refused, obj_setup,
                                        obj_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
