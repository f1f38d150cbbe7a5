/* Files of many channels: what is written is read again, and what cannot be written leaves nothing.
 */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "imageio/layered.h"
#include "imageio/layered_input.h"
#include "imageio/scratch.h"

enum { WIDTH = 70, HEIGHT = 45, CHANNELS = 6 };

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

/* A number of its own for each value; half floats cannot hold it. */
static float value_at(uint32_t channel, uint32_t x, uint32_t y)
{
    return (float)(channel + 1) + (float)(y * WIDTH + x) / 8192.0f;
}

static const ppmi_layered_channel channels[CHANNELS] = {
    {"R", PPMI_STORE_HALF},          {"G", PPMI_STORE_HALF},  {"B", PPMI_STORE_HALF},
    {"caustics.R", PPMI_STORE_HALF}, {"Z", PPMI_STORE_FLOAT}, {"Crypto00.r", PPMI_STORE_FLOAT}};
static const ppmi_layered_part whole = {NULL, CHANNELS, channels, NULL};
static const ppmi_layered_part parts[] = {{"rgba", 3, channels, NULL},
                                          {"caustics", 1, channels + 3, NULL},
                                          {"depth", 1, channels + 4, NULL},
                                          {"Crypto00", 1, channels + 5, NULL}};
static const uint32_t first_channel[] = {0, 3, 4, 5};

static bool rows_fail;

static ppm_status read_rows(void *user, uint32_t part, uint32_t y, uint32_t row_count,
                            float *values)
{
    const ppmi_layered_file *const file = user;
    const uint32_t count = file->parts[part].channel_count;
    if (rows_fail && y + row_count == file->height) {
        return ppmi_fail(context, PPM_STATUS_INTERNAL, "no more rows");
    }
    for (size_t i = 0; i < (size_t)row_count * file->width; i++) {
        for (uint32_t c = 0; c < count; c++) {
            values[i * count + c] = value_at(first_channel[part] + c, (uint32_t)(i % file->width),
                                             y + (uint32_t)(i / file->width));
        }
    }
    return PPM_STATUS_OK;
}

static ppmi_layered_file plain_file(void)
{
    return (ppmi_layered_file){.width = WIDTH,
                               .height = HEIGHT,
                               .compression = "zips",
                               .part_count = 1,
                               .parts = &whole,
                               .read_rows = read_rows};
}

static ppmi_layered_file file_of_parts(void)
{
    ppmi_layered_file file = plain_file();
    file.part_count = 4;
    file.parts = parts;
    return file;
}

static ppm_status write_layered(const char *name, ppmi_layered_file file)
{
    file.user = &file;
    return ppmi_imageio_write_layered(context, scratch_path(name), &file);
}

static ppmi_layered_input *open_layered(const char *name, ppmi_layered_info *info)
{
    ppmi_layered_input *input = NULL;
    assert_int_equal(ppmi_layered_input_open(context, scratch_path(name), &input, info),
                     PPM_STATUS_OK);
    return input;
}

/* By name, whatever the order in the file. */
static void assert_holds_all(const char *name, double tolerance_of_exact)
{
    ppmi_layered_info info;
    ppmi_layered_input *const input = open_layered(name, &info);
    float *const values = calloc((size_t)WIDTH * HEIGHT * CHANNELS, sizeof *values);
    assert_non_null(values);
    assert_int_equal(info.width, WIDTH);
    assert_int_equal(info.height, HEIGHT);
    assert_int_equal(info.channel_count, CHANNELS);
    for (uint32_t y = 0; y < HEIGHT; y += 7) { /* not as it was written */
        const uint32_t rows = HEIGHT - y < 7 ? HEIGHT - y : 7;
        assert_int_equal(
            ppmi_layered_input_read(context, input, y, rows, values + (size_t)y * WIDTH * CHANNELS),
            PPM_STATUS_OK);
    }
    for (uint32_t c = 0; c < CHANNELS; c++) {
        uint32_t at = 0;
        while (at < CHANNELS &&
               strcmp(ppmi_layered_input_channel(input, at), channels[c].name) != 0)
            at++;
        if (at == CHANNELS) fail_msg("%s has no channel %s", name, channels[c].name);
        const bool is_half = channels[c].store == PPMI_STORE_HALF;
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const double expected = (double)value_at(c, i % WIDTH, i / WIDTH);
            const double error = fabs((double)values[(size_t)i * CHANNELS + at] - expected);
            /* half floats have 11 bits */
            if (error > (is_half ? expected / 2048 : tolerance_of_exact)) {
                fail_msg("%s: %s at %u,%u is off by %g", name, channels[c].name, i % WIDTH,
                         i / WIDTH, error);
            }
        }
    }
    free(values);
    ppmi_layered_input_close(context, input);
}

/* ---- what cannot be written ------------------------------------------------------------------ */

static void assert_error_names(const char *part)
{
    char message[1024];
    ppm_context_last_error(context, message, sizeof message);
    if (!strstr(message, part)) fail_msg("\"%s\" is not in \"%s\"", part, message);
}

static void a_missing_folder_is_named(void **state)
{
    (void)state;
    assert_int_equal(write_layered("none/a.exr", plain_file()), PPM_STATUS_OUTPUT_NOT_WRITABLE);
    assert_error_names("none/a.exr");
}

static void rows_that_fail_leave_the_old_file(void **state)
{
    (void)state;
    const ppmi_layered_file files[] = {plain_file(), file_of_parts()};
    scratch_write_text("kept.exr", "old");
    rows_fail = true;
    for (int i = 0; i < 2; i++)
        assert_int_equal(write_layered("kept.exr", files[i]), PPM_STATUS_INTERNAL);
    rows_fail = false;
    assert_error_names("no more rows");
    assert_int_equal(scratch_count(), 1);
    char text[8] = "";
    FILE *const file = fopen(scratch_path("kept.exr"), "r");
    assert_non_null(file);
    assert_non_null(fgets(text, sizeof text, file));
    fclose(file);
    assert_string_equal(text, "old");
}

/* In a process of its own; the limit cannot be taken back. */
static int status_with_limit(const char *name, const ppmi_layered_file *file, rlim_t limit)
{
    const pid_t child = fork();
    if (child == 0) {
        const struct rlimit most = {.rlim_cur = limit, .rlim_max = limit};
        signal(SIGXFSZ, SIG_IGN);
        if (setrlimit(RLIMIT_FSIZE, &most) != 0) _exit(100);
        _exit(write_layered(name, *file));
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

/* Wherever the room ends, at the last byte too. The first of the tests: OpenEXR's threads, once
 * there are some, do not survive a fork. */
static void a_full_disk_leaves_nothing(void **state)
{
    (void)state;
    const ppmi_layered_file files[] = {plain_file(), file_of_parts()};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(status_with_limit("room.exr", &files[i], RLIM_INFINITY), 0);
        FILE *const file = fopen(scratch_path("room.exr"), "r");
        assert_non_null(file);
        assert_int_equal(fseek(file, 0, SEEK_END), 0);
        const long size = ftell(file);
        fclose(file);
        const long limits[] = {0, 100, 1000, size / 2, size - 1000, size - 1};
        for (size_t k = 0; k < sizeof limits / sizeof limits[0]; k++) {
            const int status = status_with_limit("full.exr", &files[i], (rlim_t)limits[k]);
            if (status != (PPM_STATUS_OUTPUT_NOT_WRITABLE & 0xff)) {
                fail_msg("file %d, %ld of %ld bytes: status %d", i, limits[k], size, status);
            }
            assert_int_equal(scratch_count(), 1);
        }
    }
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    int failures = 0;
    for (size_t n = 1; status == PPM_STATUS_OUT_OF_MEMORY; n++) {
        ppmi_alloc_fail_at(context, n);
        status = write_layered("a.exr", file_of_parts());
        ppmi_alloc_fail_at(context, 0);
        if (status != PPM_STATUS_OUT_OF_MEMORY) break;
        assert_int_equal(scratch_count(), 0);
        failures++;
    }
    assert_int_equal(status, PPM_STATUS_OK);
    assert_true(failures > 3);
}

/* ---- what can -------------------------------------------------------------------------------- */

static void channels_of_two_depths_are_read_again(void **state)
{
    (void)state;
    static const char *const packings[] = {"none", "rle", "zip", "zips", "piz"};
    for (size_t i = 0; i < sizeof packings / sizeof packings[0]; i++) {
        ppmi_layered_file file = plain_file();
        file.compression = packings[i];
        assert_int_equal(write_layered("a.exr", file), PPM_STATUS_OK);
        assert_holds_all("a.exr", 0);
    }
}

/* Ids have small letters and survive what rounds colours. */
static void lossy_packing_spares_channels_that_are_no_colours(void **state)
{
    (void)state;
    ppmi_layered_file file = plain_file();
    file.compression = "dwaa:1000";
    assert_int_equal(write_layered("a.exr", file), PPM_STATUS_OK);
    ppmi_layered_info info;
    ppmi_layered_input *const input = open_layered("a.exr", &info);
    float *const values = calloc((size_t)WIDTH * HEIGHT * CHANNELS, sizeof *values);
    assert_int_equal(ppmi_layered_input_read(context, input, 0, HEIGHT, values), PPM_STATUS_OK);
    for (uint32_t c = 0; c < CHANNELS; c++) {
        const char *const name = ppmi_layered_input_channel(input, c);
        if (strcmp(name, "Z") != 0 && strcmp(name, "Crypto00.r") != 0) continue;
        const uint32_t given = strcmp(name, "Z") == 0 ? 4 : 5;
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const float expected = value_at(given, i % WIDTH, i / WIDTH);
            assert_true(values[(size_t)i * CHANNELS + c] == expected);
        }
    }
    free(values);
    ppmi_layered_input_close(context, input);
}

/* Bright pixels, alone and in patches, on a dark ramp; a noise of its own in each channel. */
static ppm_status read_hot_rows(void *user, uint32_t part, uint32_t y, uint32_t row_count,
                                float *values)
{
    const ppmi_layered_file *const file = user;
    const uint32_t count = file->parts[part].channel_count;
    for (uint32_t i = 0; i < row_count * file->width; i++) {
        const uint32_t x = i % file->width, row = y + i / file->width;
        for (uint32_t c = 0; c < count; c++) {
            const uint32_t noise = (x * 7919u + row * 104729u + c * 1299709u) * 2654435761u >> 16;
            const bool is_hot = noise % 23 == 0 || (x > 30 && x < 41 && row > 12 && row < 19);
            values[(size_t)i * count + c] =
                is_hot ? 30000.0f + 40000.0f * (float)(noise % 64) : 0.01f * (float)x;
        }
    }
    return PPM_STATUS_OK;
}

/* The cosine transform overshoots beside bright pixels: nothing finite may come back as infinite,
 * whatever the level, nor may it be darkened more than it takes. */
static void lossy_packing_of_bright_pixels_stays_finite(void **state)
{
    (void)state;
    static const char *const kinds[] = {"dwaa", "dwab"};
    static const int levels[] = {1, 45, 200, 1000, 4000, 10000};
    static const ppmi_layered_channel colors[2][4] = {{{"R", PPMI_STORE_FLOAT},
                                                       {"G", PPMI_STORE_FLOAT},
                                                       {"B", PPMI_STORE_FLOAT},
                                                       {"light.Y", PPMI_STORE_HALF}},
                                                      {{"R", PPMI_STORE_HALF},
                                                       {"G", PPMI_STORE_HALF},
                                                       {"B", PPMI_STORE_HALF},
                                                       {"depth.Y", PPMI_STORE_FLOAT}}};
    float *const values = calloc((size_t)WIDTH * HEIGHT * 4, sizeof *values);
    for (int i = 0; i < 24; i++) {
        char compression[24];
        snprintf(compression, sizeof compression, "%s:%d", kinds[i % 2], levels[i / 4]);
        const ppmi_layered_part part = {NULL, 4, colors[i / 2 % 2], NULL};
        ppmi_layered_file file = plain_file();
        file.compression = compression;
        file.parts = &part;
        file.read_rows = read_hot_rows;
        file.tile_side = i % 3 == 1 ? 20 : 0;
        assert_int_equal(write_layered("a.exr", file), PPM_STATUS_OK);
        ppmi_layered_info info;
        ppmi_layered_input *const input = open_layered("a.exr", &info);
        assert_int_equal(ppmi_layered_input_read(context, input, 0, HEIGHT, values), PPM_STATUS_OK);
        ppmi_layered_input_close(context, input);
        float most = 0;
        for (uint32_t k = 0; k < WIDTH * HEIGHT * 4; k++) {
            if (!isfinite(values[k]))
                fail_msg("%s: value %u is %g", compression, k, (double)values[k]);
            most = fmaxf(most, values[k]);
        }
        if (levels[i / 4] <= 200) assert_true(most > 40000.0f); /* no more than is needed */
    }
    free(values);
}

static void parts_are_read_as_one_file(void **state)
{
    (void)state;
    assert_int_equal(write_layered("a.exr", file_of_parts()), PPM_STATUS_OK);
    assert_holds_all("a.exr", 0);
    assert_int_equal(scratch_count(), 1);
}

static void tiles_are_read_in_rows(void **state)
{
    (void)state;
    ppmi_layered_file files[] = {plain_file(), file_of_parts()};
    for (int i = 0; i < 2; i++) {
        files[i].tile_side = 16;
        assert_int_equal(write_layered("a.exr", files[i]), PPM_STATUS_OK);
        assert_holds_all("a.exr", 0);
    }
}

static void windows_and_attributes_are_kept(void **state)
{
    (void)state;
    static const float matrix[16] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    static const float pair[2] = {0.25f, 0.5f};
    const ppmi_image_attribute attributes[] = {
        {.name = "worldToCamera", .type = PPMI_ATTRIBUTE_MATRIX, .floats = matrix},
        {.name = "screenWindowCenter", .type = PPMI_ATTRIBUTE_PAIR, .floats = pair},
        {.name = "ppm:seed", .type = PPMI_ATTRIBUTE_INT, .integer = INT64_MAX},
        {.name = "ppm:passes", .type = PPMI_ATTRIBUTE_INT, .integer = 7},
    };
    ppmi_layered_file file = plain_file();
    file.full_width = 200;
    file.full_height = 100;
    file.x = 20;
    file.y = 10;
    file.attributes = attributes;
    file.attribute_count = 4;
    assert_int_equal(write_layered("a.exr", file), PPM_STATUS_OK);
    ppmi_layered_info info;
    ppmi_layered_input *const input = open_layered("a.exr", &info);
    assert_int_equal(info.full_width, 200);
    assert_int_equal(info.full_height, 100);
    assert_int_equal(info.x, 20);
    assert_int_equal(info.y, 10);
    const ppmi_image_attribute *found = ppmi_layered_input_find(input, "worldToCamera");
    assert_non_null(found);
    assert_int_equal(found->type, PPMI_ATTRIBUTE_MATRIX);
    assert_memory_equal(found->floats, matrix, sizeof matrix);
    found = ppmi_layered_input_find(input, "screenWindowCenter");
    assert_non_null(found);
    assert_int_equal(found->type, PPMI_ATTRIBUTE_PAIR);
    assert_memory_equal(found->floats, pair, sizeof pair);
    found = ppmi_layered_input_find(input, "ppm:seed");
    assert_non_null(found);
    assert_string_equal(found->text, "9223372036854775807");
    found = ppmi_layered_input_find(input, "ppm:passes");
    assert_non_null(found);
    assert_int_equal(found->integer, 7);
    assert_null(ppmi_layered_input_find(input, "none"));
    ppmi_layered_input_close(context, input);
}

static void what_is_no_exr_is_refused(void **state)
{
    (void)state;
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    scratch_write_text("a.exr", "hello");
    scratch_write("b.exr", "\x76\x2f\x31\x01\x02\0\0\0garbage", 15);
    assert_int_equal(ppmi_layered_input_open(context, scratch_path("a.exr"), &input, &info),
                     PPM_STATUS_INPUT_INVALID);
    assert_error_names("not an OpenEXR file");
    assert_int_equal(ppmi_layered_input_open(context, scratch_path("b.exr"), &input, &info),
                     PPM_STATUS_INPUT_INVALID);
    assert_error_names("b.exr");
    assert_int_equal(ppmi_layered_input_open(context, scratch_path("c.exr"), &input, &info),
                     PPM_STATUS_INPUT_NOT_FOUND);
    assert_int_equal(ppmi_layered_input_open(context, scratch_path(""), &input, &info),
                     PPM_STATUS_INPUT_INVALID);
    assert_error_names("not a regular file");
}

static void a_file_that_was_cut_off_is_refused(void **state)
{
    (void)state;
    assert_int_equal(write_layered("a.exr", plain_file()), PPM_STATUS_OK);
    assert_int_equal(truncate(scratch_path("a.exr"), 3000), 0);
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    ppm_status status = ppmi_layered_input_open(context, scratch_path("a.exr"), &input, &info);
    if (status == PPM_STATUS_OK) {
        float *const values = calloc((size_t)WIDTH * HEIGHT * CHANNELS, sizeof *values);
        status = ppmi_layered_input_read(context, input, 0, HEIGHT, values);
        free(values);
        ppmi_layered_input_close(context, input);
    }
    assert_int_equal(status, PPM_STATUS_INPUT_INVALID);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_full_disk_leaves_nothing),
        TEST(a_missing_folder_is_named),
        TEST(rows_that_fail_leave_the_old_file),
        TEST(every_allocation_may_fail),
        TEST(channels_of_two_depths_are_read_again),
        TEST(lossy_packing_spares_channels_that_are_no_colours),
        TEST(lossy_packing_of_bright_pixels_stays_finite),
        TEST(parts_are_read_as_one_file),
        TEST(tiles_are_read_in_rows),
        TEST(windows_and_attributes_are_kept),
        TEST(what_is_no_exr_is_refused),
        TEST(a_file_that_was_cut_off_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
