/* Files that fit each other, and files that do not. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare/pair.h"
#include "imageio/file.h"
#include "imageio/imageio.h"
#include "imageio/scratch.h"
#include "support/near.h"

enum { WIDTH = 4, HEIGHT = 3, PIXELS = WIDTH * HEIGHT };

static ppm_context *context;
static ppmi_compare_pair pair;

static int setup(void **state)
{
    (void)state;
    pair = (ppmi_compare_pair){0};
    scratch_create();
    return ppm_context_create(NULL, &context) == PPM_STATUS_OK ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    ppmi_compare_pair_free(context, &pair);
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    scratch_remove();
    return live == 0 ? 0 : -1;
}

static void write_picture(const char *name, uint32_t width, uint32_t height, uint32_t channels,
                          const float *pixels, int32_t store)
{
    const ppmi_image_file file = {
        .width = width, .height = height, .channels = channels, .pixels = pixels, .store = store};
    assert_int_equal(ppmi_imageio_write_file(context, scratch_path(name), &file), PPM_STATUS_OK);
}

/* RGBA whose red is base + the pixel's number. */
static void write_numbered(const char *name, float base)
{
    float pixels[4 * PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        const float pixel[4] = {base + (float)i, 0.5f, 0.25f, 1};
        memcpy(pixels + 4 * (size_t)i, pixel, sizeof pixel);
    }
    write_picture(name, WIDTH, HEIGHT, 4, pixels, PPMI_STORE_FLOAT);
}

/* Makes the stored pixels of an OpenEXR file a part of a larger picture: by its display window. */
static void set_display_window(const char *name, const int32_t box[4])
{
    static const char key[] = "displayWindow\0box2i";
    void *bytes = NULL;
    size_t byte_count = 0;
    const char *const path = scratch_path(name);
    assert_int_equal(ppmi_imageio_file_read(context, path, path, &bytes, &byte_count),
                     PPM_STATUS_OK);
    char *const place = memmem(bytes, byte_count, key, sizeof key);
    assert_non_null(place);
    memcpy(place + sizeof key + 4, box, 16);
    scratch_write(name, bytes, byte_count);
    ppmi_free(context, bytes);
}

static ppm_status read_pair(const char *test, const char *reference)
{
    return ppmi_compare_pair_read(context, scratch_path(test), scratch_path(reference), &pair);
}

static void assert_last_error(const char *part)
{
    char text[512];
    ppm_context_last_error(context, text, sizeof text);
    if (!strstr(text, part)) fail_msg("no '%s' in: %s", part, text);
}

static void missing_and_broken_files_are_refused(void **state)
{
    (void)state;
    write_numbered("a.exr", 0);
    scratch_write_text("broken.exr", "\x76\x2f\x31\x01 not much of a picture");
    assert_int_equal(read_pair("none.exr", "a.exr"), PPM_STATUS_INPUT_NOT_FOUND);
    assert_int_equal(read_pair("a.exr", "none.exr"), PPM_STATUS_INPUT_NOT_FOUND);
    assert_int_equal(read_pair("a.exr", "broken.exr"), PPM_STATUS_INPUT_INVALID);
}

static void sizes_that_differ_are_named(void **state)
{
    (void)state;
    static const float pixels[3 * 30];
    write_numbered("a.exr", 0);
    write_picture("b.exr", 5, 6, 3, pixels, PPMI_STORE_FLOAT);
    assert_int_equal(read_pair("a.exr", "b.exr"), PPM_STATUS_INPUT_INVALID);
    assert_last_error("a.exr has 4 x 3 pixels");
    assert_last_error("b.exr has 5 x 6");
}

static void windows_apart_are_refused(void **state)
{
    (void)state;
    write_numbered("a.exr", 0);
    write_numbered("b.exr", 0);
    set_display_window("a.exr", (const int32_t[4]){-6, 0, 3, 2}); /* the right 4 of 10 columns */
    set_display_window("b.exr", (const int32_t[4]){0, 0, 9, 2});  /* the left ones */
    assert_int_equal(read_pair("a.exr", "b.exr"), PPM_STATUS_INPUT_INVALID);
    assert_last_error("do not overlap");
}

static void equal_windows_are_compared_where_they_are(void **state)
{
    (void)state;
    static const int32_t box[4] = {-2, -1, 7, 4};
    write_numbered("a.exr", 0);
    write_numbered("b.exr", 10);
    set_display_window("a.exr", box);
    set_display_window("b.exr", box);
    assert_int_equal(read_pair("a.exr", "b.exr"), PPM_STATUS_OK);
    assert_int_equal(pair.width, 4);
    assert_int_equal(pair.height, 3);
    assert_int_equal(pair.x, 2);
    assert_int_equal(pair.y, 1);
    assert_int_equal(pair.picture_width, 10);
    assert_int_equal(pair.picture_height, 6);
    assert_near(pair.test[0], 0, 0);
    assert_near(pair.reference[3 * (PIXELS - 1)], 10 + 11, 1e-5);
}

static void overlap_is_compared(void **state)
{
    (void)state;
    write_numbered("a.exr", 0);
    write_numbered("b.exr", 0);
    set_display_window("a.exr", (const int32_t[4]){-3, 0, 3, 2}); /* columns 3..6 of 7 */
    set_display_window("b.exr", (const int32_t[4]){0, 0, 6, 2});  /* columns 0..3 */
    assert_int_equal(read_pair("a.exr", "b.exr"), PPM_STATUS_OK);
    assert_int_equal(pair.width, 1);
    assert_int_equal(pair.height, 3);
    assert_int_equal(pair.x, 3);
    assert_near(pair.test[3], 4, 1e-5);      /* its first column, second row */
    assert_near(pair.reference[3], 7, 1e-5); /* its last */
}

static void pixels_that_are_no_numbers_are_set_aside(void **state)
{
    (void)state;
    float pixels[3 * PIXELS];
    for (int i = 0; i < 3 * PIXELS; i++)
        pixels[i] = 0.5f;
    write_picture("b.exr", WIDTH, HEIGHT, 3, pixels, PPMI_STORE_FLOAT);
    pixels[3 * 2 + 1] = NAN;
    pixels[3 * 5] = INFINITY;
    write_picture("a.exr", WIDTH, HEIGHT, 3, pixels, PPMI_STORE_FLOAT);
    assert_int_equal(read_pair("a.exr", "b.exr"), PPM_STATUS_OK);
    assert_int_equal(pair.test_broken, 2);
    assert_int_equal(pair.reference_broken, 0);
    assert_int_equal(pair.measured, PIXELS - 2);
    assert_true(pair.is_broken[2] && pair.is_broken[5] && !pair.is_broken[3]);
    assert_near(pair.test[3 * 2 + 1], 0.5, 0);
    ppmi_compare_pair_free(context, &pair);
    assert_int_equal(read_pair("b.exr", "a.exr"), PPM_STATUS_OK);
    assert_int_equal(pair.reference_broken, 2);
    assert_near(pair.test[3 * 2 + 1], 0, 0);
    assert_near(pair.reference[3 * 2 + 1], 0, 0);
}

static void pictures_without_a_whole_pixel_are_refused(void **state)
{
    (void)state;
    const float pixels[3] = {NAN, 0, 0};
    write_picture("a.exr", 1, 1, 3, pixels, PPMI_STORE_FLOAT);
    assert_int_equal(read_pair("a.exr", "a.exr"), PPM_STATUS_INPUT_INVALID);
    assert_last_error("no pixel that is finite");
}

static void display_values_are_decoded(void **state)
{
    (void)state;
    const float code = 128.0f / 255, pixels[3] = {code, 0, 1};
    write_picture("a.png", 1, 1, 3, pixels, PPMI_STORE_U8);
    write_picture("b.png", 1, 1, 3, pixels, PPMI_STORE_U16);
    assert_int_equal(read_pair("a.png", "b.png"), PPM_STATUS_OK);
    assert_false(pair.is_linear);
    assert_near(pair.test[0], pow(((double)code + 0.055) / 1.055, 2.4), 1e-5);
    assert_near(pair.reference[0], pair.test[0], 1e-4);
    assert_near(pair.test[2], 1, 1e-6);
}

static void alpha_multiplies_colours(void **state)
{
    (void)state;
    const float light[8] = {0.2f, 0.1f, 0, 0.5f, 0.3f, 0, 0, 0}; /* as OpenEXR: multiplied */
    const float straight[8] = {1, 1, 1, 0.5f, 1, 1, 1, 0};       /* as PNG: not */
    write_picture("a.exr", 2, 1, 4, light, PPMI_STORE_FLOAT);
    write_picture("b.png", 2, 1, 4, straight, PPMI_STORE_U16);
    assert_int_equal(read_pair("a.exr", "b.png"), PPM_STATUS_OK);
    assert_true(pair.is_linear);
    assert_near(pair.test[0], 0.2, 1e-6);
    assert_near(pair.test[3], 0.3, 1e-6); /* light where there is no surface */
    assert_near(pair.reference[0], 0.5, 1e-4);
    assert_near(pair.reference[3], 0, 0);
}

static void grey_is_three_equal_channels(void **state)
{
    (void)state;
    const float grey = 0.7f, rgb[3] = {0.7f, 0.7f, 0.7f};
    write_picture("a.exr", 1, 1, 1, &grey, PPMI_STORE_FLOAT);
    write_picture("b.exr", 1, 1, 3, rgb, PPMI_STORE_FLOAT);
    assert_int_equal(read_pair("a.exr", "b.exr"), PPM_STATUS_OK);
    for (int c = 0; c < 3; c++)
        assert_near(pair.test[c], pair.reference[c], 0);
}

int main(void)
{
#define CASE(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        CASE(missing_and_broken_files_are_refused),
        CASE(sizes_that_differ_are_named),
        CASE(windows_apart_are_refused),
        CASE(equal_windows_are_compared_where_they_are),
        CASE(overlap_is_compared),
        CASE(pixels_that_are_no_numbers_are_set_aside),
        CASE(pictures_without_a_whole_pixel_are_refused),
        CASE(display_values_are_decoded),
        CASE(alpha_multiplies_colours),
        CASE(grey_is_three_equal_channels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
