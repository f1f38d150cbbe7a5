/* Images written and read back, and images that lie. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmocka.h>

#include "imageio/file.h"
#include "imageio/imageio.h"
#include "imageio/scratch.h"

enum { WIDTH = 5, HEIGHT = 3, PIXELS = WIDTH * HEIGHT };

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

static ppm_status write_image(const char *name, const float *pixels, uint32_t channels,
                              int32_t store)
{
    const ppmi_image_file file = {
        .width = WIDTH, .height = HEIGHT, .channels = channels, .pixels = pixels, .store = store};
    return ppmi_imageio_write_file(context, scratch_path(name), &file);
}

static ppmi_pixels read_image(const char *name)
{
    ppmi_pixels pixels = {0};
    assert_int_equal(ppmi_imageio_read_file(context, scratch_path(name), name, &pixels),
                     PPM_STATUS_OK);
    assert_int_equal(pixels.width, WIDTH);
    assert_int_equal(pixels.height, HEIGHT);
    return pixels;
}

/* Different values everywhere, alpha between 0.5 and 1. */
static void fill(float *pixels, uint32_t channels)
{
    for (uint32_t i = 0; i < PIXELS * channels; i++) {
        const bool is_alpha = channels % 2 == 0 && i % channels == channels - 1;
        pixels[i] = is_alpha ? 1 - (float)(i % 50) / 100 : (float)(i * 37 % 256) / 255;
    }
}

static void assert_round_trip(const char *name, uint32_t channels, int32_t store, float tolerance)
{
    float written[PIXELS * 4];
    fill(written, channels);
    assert_int_equal(write_image(name, written, channels, store), PPM_STATUS_OK);
    ppmi_pixels pixels = read_image(name);
    assert_int_equal(pixels.channels, channels);
    assert_int_equal(pixels.u8 != NULL, store == PPMI_STORE_U8);
    assert_int_equal(pixels.f32 != NULL, store != PPMI_STORE_U8);
    for (uint32_t i = 0; i < PIXELS * channels; i++) {
        const float value = pixels.u8 ? (float)pixels.u8[i] / 255 : pixels.f32[i];
        assert_float_equal(value, written[i], tolerance);
    }
    ppmi_imageio_pixels_free(context, &pixels);
    assert_null(pixels.u8);
}

static void png_keeps_grey_and_colour_and_straight_alpha(void **state)
{
    (void)state;
    for (uint32_t channels = 1; channels <= 4; channels++) {
        assert_round_trip("a.png", channels, PPMI_STORE_U8, 0.5f / 255 + 1e-6f);
        assert_round_trip("b.png", channels, PPMI_STORE_U16, 0.5f / 65535 + 1e-6f);
    }
}

static void tiff_keeps_grey_and_colour_and_straight_alpha(void **state)
{
    (void)state;
    for (uint32_t channels = 1; channels <= 4; channels++) {
        assert_round_trip("a.tif", channels, PPMI_STORE_U16, 0.5f / 65535 + 1e-6f);
    }
}

static void exr_keeps_floats_exactly(void **state)
{
    (void)state;
    assert_round_trip("a.exr", 3, PPMI_STORE_FLOAT, 0);
    assert_round_trip("half.exr", 3, PPMI_STORE_HALF, 1.0f / 2048);
    float values[PIXELS * 3] = {1e-30f, -2.5f, 1e30f, 65505, INFINITY};
    assert_int_equal(write_image("b.exr", values, 3, PPMI_STORE_FLOAT), PPM_STATUS_OK);
    ppmi_pixels pixels = read_image("b.exr");
    assert_memory_equal(pixels.f32, values, sizeof values);
    assert_true(pixels.is_linear);
    ppmi_imageio_pixels_free(context, &pixels);
}

static void exr_alpha_is_divided_out_on_reading(void **state)
{
    (void)state;
    float values[PIXELS * 4] = {0.25f, 0.5f, 1, 0.5f, 7, 8, 9, 0};
    assert_int_equal(write_image("a.exr", values, 4, PPMI_STORE_FLOAT), PPM_STATUS_OK);
    ppmi_pixels pixels = read_image("a.exr");
    const float expected[8] = {0.5f, 1, 2, 0.5f, 7, 8, 9, 0};
    assert_memory_equal(pixels.f32, expected, sizeof expected);
    ppmi_imageio_pixels_free(context, &pixels);
}

static void half_floats_do_not_become_infinite(void **state)
{
    (void)state;
    float values[PIXELS * 3] = {1e10f, -1e10f, 3};
    assert_int_equal(write_image("a.exr", values, 3, PPMI_STORE_HALF), PPM_STATUS_OK);
    ppmi_pixels pixels = read_image("a.exr");
    assert_float_equal(pixels.f32[0], 65504, 0);
    assert_float_equal(pixels.f32[1], -65504, 0);
    assert_float_equal(pixels.f32[2], 3, 0);
    ppmi_imageio_pixels_free(context, &pixels);
}

static void values_are_rounded_and_limited(void **state)
{
    (void)state;
    const float step = 1.0f / 255;
    float values[PIXELS] = {-1, 0, 0.49f * step, 0.51f * step, 1.49f * step, 1, 7, NAN, INFINITY};
    const uint8_t expected[9] = {0, 0, 0, 1, 1, 255, 255, 0, 255};
    assert_int_equal(write_image("a.png", values, 1, PPMI_STORE_U8), PPM_STATUS_OK);
    ppmi_pixels pixels = read_image("a.png");
    assert_memory_equal(pixels.u8, expected, sizeof expected);
    ppmi_imageio_pixels_free(context, &pixels);
}

static void jpeg_leaves_alpha_out(void **state)
{
    (void)state;
    float values[PIXELS * 4];
    for (int i = 0; i < PIXELS * 4; i++)
        values[i] = 0.5f;
    assert_int_equal(write_image("a.JPG", values, 4, PPMI_STORE_U8), PPM_STATUS_OK);
    ppmi_pixels pixels = read_image("a.JPG");
    assert_int_equal(pixels.channels, 3);
    for (int i = 0; i < PIXELS * 3; i++)
        assert_in_range(pixels.u8[i], 126, 130);
    ppmi_imageio_pixels_free(context, &pixels);
}

static void memory_is_read_whatever_the_name_says(void **state)
{
    (void)state;
    float values[PIXELS * 3];
    fill(values, 3);
    assert_int_equal(write_image("a.png", values, 3, PPMI_STORE_U8), PPM_STATUS_OK);
    void *bytes = NULL;
    size_t byte_count = 0;
    assert_int_equal(
        ppmi_imageio_file_read(context, scratch_path("a.png"), "a.png", &bytes, &byte_count),
        PPM_STATUS_OK);
    ppmi_pixels pixels = {0};
    assert_int_equal(
        ppmi_imageio_read_memory(context, bytes, byte_count, "scene.glb: images[0]", &pixels),
        PPM_STATUS_OK);
    assert_int_equal(pixels.width, WIDTH);
    assert_int_equal(pixels.u8[0], 0);
    assert_int_equal(pixels.u8[1], 37);
    ppmi_imageio_pixels_free(context, &pixels);
    ppmi_free(context, bytes);
}

static void equal_pictures_give_equal_files(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.png", "a.jpg", "a.tif"};
    static const int32_t stores[] = {PPMI_STORE_FLOAT, PPMI_STORE_U8, PPMI_STORE_U8,
                                     PPMI_STORE_U16};
    float values[PIXELS * 3];
    fill(values, 3);
    for (int i = 0; i < 4; i++) {
        void *bytes[2] = {NULL, NULL};
        size_t byte_counts[2] = {0, 0};
        for (int time = 0; time < 2; time++) {
            assert_int_equal(write_image(names[i], values, 3, stores[i]), PPM_STATUS_OK);
            assert_int_equal(ppmi_imageio_file_read(context, scratch_path(names[i]), names[i],
                                                    &bytes[time], &byte_counts[time]),
                             PPM_STATUS_OK);
            /* a time stamp of a second would tell them apart */
            if (time == 0) usleep(i == 0 ? 1100000 : 0);
        }
        assert_int_equal(byte_counts[0], byte_counts[1]);
        assert_memory_equal(bytes[0], bytes[1], byte_counts[0]);
        ppmi_free(context, bytes[0]);
        ppmi_free(context, bytes[1]);
    }
}

static bool contains(const char *bytes, size_t byte_count, const void *part, size_t part_count)
{
    for (size_t i = 0; i + part_count <= byte_count; i++) {
        if (memcmp(bytes + i, part, part_count) == 0) return true;
    }
    return false;
}

static void exr_header_has_all_kinds_of_attributes(void **state)
{
    (void)state;
    static const float numbers[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    const ppmi_image_attribute attributes[] = {
        {.name = "chromaticities",
         .type = PPMI_ATTRIBUTE_FLOATS,
         .floats = numbers,
         .float_count = 8},
        {.name = "ppm:number", .type = PPMI_ATTRIBUTE_INT, .integer = 1234567},
        {.name = "ppm:large", .type = PPMI_ATTRIBUTE_INT, .integer = INT64_C(5000000000)},
        {.name = "ppm:text", .type = PPMI_ATTRIBUTE_STRING, .text = "some words"},
        {.name = "ppm:float", .type = PPMI_ATTRIBUTE_FLOAT, .floats = numbers},
    };
    const float values[PIXELS * 3] = {0};
    const ppmi_image_file file = {.width = WIDTH,
                                  .height = HEIGHT,
                                  .channels = 3,
                                  .pixels = values,
                                  .store = PPMI_STORE_FLOAT,
                                  .attribute_count = 5,
                                  .attributes = attributes};
    assert_int_equal(ppmi_imageio_write_file(context, scratch_path("a.exr"), &file), PPM_STATUS_OK);
    void *bytes = NULL;
    size_t byte_count = 0;
    assert_int_equal(
        ppmi_imageio_file_read(context, scratch_path("a.exr"), "a.exr", &bytes, &byte_count),
        PPM_STATUS_OK);
    /* OpenEXR's layout: name, type, size, value */
    static const char chromaticities[] =
        "chromaticities\0chromaticities\0\x20\0\0\0\x0a\xd7\x23\x3f";
    static const char number[] = "ppm:number\0int\0\4\0\0\0\x87\xd6\x12";
    static const char large[] = "ppm:large\0string\0\x0a\0\0\0"
                                "5000000000";
    static const char text[] = "ppm:text\0string\0\x0a\0\0\0some words";
    static const char single[] = "ppm:float\0float\0\4\0\0\0\x0a\xd7\x23\x3f";
    assert_true(contains(bytes, byte_count, chromaticities, sizeof chromaticities - 1));
    assert_true(contains(bytes, byte_count, number, sizeof number));
    assert_true(contains(bytes, byte_count, large, sizeof large - 1));
    assert_true(contains(bytes, byte_count, text, sizeof text - 1));
    assert_true(contains(bytes, byte_count, single, sizeof single - 1));
    ppmi_free(context, bytes);
}

static void endings_that_cannot_be_written_are_refused(void **state)
{
    (void)state;
    const float values[PIXELS * 3] = {0};
    assert_int_equal(write_image("a.gif", values, 3, PPMI_STORE_U8), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(write_image("exr", values, 3, PPMI_STORE_U8), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(write_image("a.exr", values, 3, PPMI_STORE_U8), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppmi_imageio_check_output(context, scratch_path("a")),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppmi_imageio_check_output(context, scratch_path("none/a.png")),
                     PPM_STATUS_OUTPUT_NOT_WRITABLE);
    assert_int_equal(ppmi_imageio_check_output(context, scratch_path("a.Exr")), PPM_STATUS_OK);
    assert_int_equal(scratch_count(), 0);
}

/* Writes while no file may grow beyond 64 bytes. No child process: OpenEXR's threads would not be
 * there. */
static ppm_status write_on_full_disk(const char *name, int32_t store)
{
    float values[PIXELS * 3];
    fill(values, 3);
    struct rlimit usual;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &usual), 0);
    const struct rlimit tight = {.rlim_cur = 64, .rlim_max = usual.rlim_max};
    void (*const handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
    const ppm_status status = write_image(name, values, 3, store);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &usual), 0);
    signal(SIGXFSZ, handler);
    return status;
}

static void a_full_disk_fails_every_format_and_keeps_the_old_file(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.png", "a.jpg", "a.tif"};
    static const int32_t stores[] = {PPMI_STORE_FLOAT, PPMI_STORE_U8, PPMI_STORE_U8,
                                     PPMI_STORE_U16};
    for (int i = 0; i < 4; i++) {
        scratch_write_text(names[i], "old");
        assert_int_equal(write_on_full_disk(names[i], stores[i]), PPM_STATUS_OUTPUT_NOT_WRITABLE);
        void *bytes = NULL;
        size_t byte_count = 0;
        assert_int_equal(
            ppmi_imageio_file_read(context, scratch_path(names[i]), names[i], &bytes, &byte_count),
            PPM_STATUS_OK);
        assert_int_equal(byte_count, 3);
        ppmi_free(context, bytes);
    }
    assert_int_equal(scratch_count(), 4);
}

static ppm_status read_bytes(const char *name, const void *bytes, size_t byte_count)
{
    ppmi_pixels pixels = {0};
    const ppm_status status = ppmi_imageio_read_memory(context, bytes, byte_count, name, &pixels);
    if (status != PPM_STATUS_OK) {
        assert_null(pixels.u8);
        assert_null(pixels.f32);
    }
    ppmi_imageio_pixels_free(context, &pixels);
    return status;
}

static void unknown_data_is_unsupported(void **state)
{
    (void)state;
    assert_int_equal(read_bytes("a.png", NULL, 0), PPM_STATUS_INPUT_INVALID);
    assert_int_equal(read_bytes("a.png", "x", 1), PPM_STATUS_INPUT_UNSUPPORTED);
    assert_int_equal(read_bytes("a.png", "<html></html>", 13), PPM_STATUS_INPUT_UNSUPPORTED);
    assert_int_equal(read_bytes("a.ktx2", "\xabKTX 20\xbb\r\n\x1a\n", 12),
                     PPM_STATUS_INPUT_UNSUPPORTED);
}

static void a_small_file_cannot_claim_a_huge_picture(void **state)
{
    (void)state;
    /* BMP: 60000 x 60000 pixels of 24 bits in 58 bytes */
    uint8_t bmp[58] = {'B', 'M', 58, 0,    0,    0, 0, 0,    0,    0, 54, 0, 0, 0,  40,
                       0,   0,   0,  0x60, 0xea, 0, 0, 0x60, 0xea, 0, 0,  1, 0, 24, 0};
    assert_int_equal(read_bytes("a.bmp", bmp, sizeof bmp), PPM_STATUS_INPUT_INVALID);
    /* Radiance: the same in 70 */
    static const char hdr[] =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n\2\2\xea\x60";
    assert_int_equal(read_bytes("a.hdr", hdr, sizeof hdr - 1), PPM_STATUS_INPUT_INVALID);
    /* Targa, run-length encoded: 65535 x 65535 */
    const uint8_t tga[18 + 4] = {0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 24, 0};
    assert_int_equal(read_bytes("a.tga", tga, sizeof tga), PPM_STATUS_INPUT_INVALID);
    /* PPM text header */
    static const char ppm[] = "P6 60000 60000 255\n123";
    assert_int_equal(read_bytes("a.ppm", ppm, sizeof ppm - 1), PPM_STATUS_INPUT_INVALID);
}

static void cut_off_files_are_read_or_refused_without_harm(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.png", "a.jpg", "a.tif"};
    static const int32_t stores[] = {PPMI_STORE_FLOAT, PPMI_STORE_U8, PPMI_STORE_U8,
                                     PPMI_STORE_U16};
    float values[PIXELS * 3];
    fill(values, 3);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(write_image(names[i], values, 3, stores[i]), PPM_STATUS_OK);
        void *bytes = NULL;
        size_t byte_count = 0;
        assert_int_equal(
            ppmi_imageio_file_read(context, scratch_path(names[i]), names[i], &bytes, &byte_count),
            PPM_STATUS_OK);
        int refused = 0;
        for (size_t size = 0; size < byte_count; size++) {
            /* a copy of exactly that size: reading beyond it is seen by the sanitizer */
            void *const part = ppmi_alloc(context, size, 1);
            if (part) memcpy(part, bytes, size);
            refused += read_bytes(names[i], part, size) != PPM_STATUS_OK;
            ppmi_free(context, part);
        }
        assert_true(refused > 0);
        assert_int_equal(read_bytes(names[i], bytes, byte_count), PPM_STATUS_OK);
        ppmi_free(context, bytes);
    }
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    float values[PIXELS * 3];
    fill(values, 3);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    for (size_t n = 1; status == PPM_STATUS_OUT_OF_MEMORY; n++) {
        ppmi_alloc_fail_at(context, n);
        status = write_image("a.png", values, 3, PPMI_STORE_U8);
        assert_true(status == PPM_STATUS_OK || n < 20);
    }
    assert_int_equal(status, PPM_STATUS_OK);
    status = PPM_STATUS_OUT_OF_MEMORY;
    for (size_t n = 1; status == PPM_STATUS_OUT_OF_MEMORY; n++) {
        ppmi_pixels pixels = {0};
        ppmi_alloc_fail_at(context, n);
        status = ppmi_imageio_read_file(context, scratch_path("a.png"), "a.png", &pixels);
        ppmi_imageio_pixels_free(context, &pixels);
        assert_true(status == PPM_STATUS_OK ? n > 2 : n < 20);
    }
    assert_int_equal(status, PPM_STATUS_OK);
    ppmi_alloc_fail_at(context, 0);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(png_keeps_grey_and_colour_and_straight_alpha),
        TEST(tiff_keeps_grey_and_colour_and_straight_alpha),
        TEST(exr_keeps_floats_exactly),
        TEST(exr_alpha_is_divided_out_on_reading),
        TEST(half_floats_do_not_become_infinite),
        TEST(values_are_rounded_and_limited),
        TEST(jpeg_leaves_alpha_out),
        TEST(memory_is_read_whatever_the_name_says),
        TEST(equal_pictures_give_equal_files),
        TEST(exr_header_has_all_kinds_of_attributes),
        TEST(endings_that_cannot_be_written_are_refused),
        TEST(a_full_disk_fails_every_format_and_keeps_the_old_file),
        TEST(unknown_data_is_unsupported),
        TEST(a_small_file_cannot_claim_a_huge_picture),
        TEST(cut_off_files_are_read_or_refused_without_harm),
        TEST(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
