/* Headers of OpenEXR files that claim more than there is. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "imageio/exr_check.h"
#include "imageio/file.h"
#include "imageio/imageio.h"
#include "imageio/layered.h"
#include "imageio/scratch.h"

enum { WIDTH = 4, HEIGHT = 3 };

static ppm_status check(const void *bytes, size_t byte_count)
{
    return ppmi_imageio_exr_check(NULL, bytes, byte_count, "test.exr");
}

static ppm_status read_rows(void *user, uint32_t part, uint32_t y, uint32_t row_count,
                            float *values)
{
    (void)user;
    (void)part;
    (void)y;
    memset(values, 0, (size_t)row_count * WIDTH * sizeof *values);
    return PPM_STATUS_OK;
}

/* A file of one part or of two; its bytes are to be freed. */
static uint8_t *make_file(uint32_t part_count, size_t *out_count)
{
    static const ppmi_layered_channel channel = {"Y", PPMI_STORE_FLOAT};
    const ppmi_layered_part parts[2] = {{part_count > 1 ? "a" : NULL, 1, &channel, NULL},
                                        {"b", 1, &channel, NULL}};
    const ppmi_layered_file file = {.width = WIDTH,
                                    .height = HEIGHT,
                                    .compression = "none",
                                    .part_count = part_count,
                                    .parts = parts,
                                    .read_rows = read_rows};
    void *bytes = NULL;
    scratch_create();
    const char *const path = scratch_path("a.exr");
    assert_int_equal(ppmi_imageio_write_layered(NULL, path, &file), PPM_STATUS_OK);
    assert_int_equal(ppmi_imageio_file_read(NULL, path, path, &bytes, out_count), PPM_STATUS_OK);
    scratch_remove();
    return bytes;
}

static void whole_files_pass_and_headers_that_are_cut_off_do_not(void **state)
{
    (void)state;
    for (uint32_t parts = 1; parts <= 2; parts++) {
        size_t count = 0;
        uint8_t *const bytes = make_file(parts, &count);
        assert_int_equal(check(bytes, count), PPM_STATUS_OK);
        for (size_t length = 0; length < 200; length++)
            assert_int_equal(check(bytes, length), PPM_STATUS_INPUT_INVALID);
        ppmi_free(NULL, bytes);
    }
}

/* 29 bytes for which OpenEXR would take 2 GiB. */
static void an_attribute_that_is_larger_than_the_file_is_refused(void **state)
{
    (void)state;
    static const char bytes[] = "v/1\1\2\0\0\0a\0string\0\377\377\377\177xxxxxxxx";
    ppmi_pixels pixels;
    assert_int_equal(check(bytes, sizeof bytes - 1), PPM_STATUS_INPUT_INVALID);
    assert_int_equal(ppmi_imageio_read_memory(NULL, bytes, sizeof bytes - 1, "test.exr", &pixels),
                     PPM_STATUS_INPUT_INVALID);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_files_pass_and_headers_that_are_cut_off_do_not),
        cmocka_unit_test(an_attribute_that_is_larger_than_the_file_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
