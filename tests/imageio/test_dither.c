/* Dither: the mean of many pixels is the value, and the ends stay clean. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "imageio/dither.h"
#include "imageio/imageio.h"
#include "imageio/png_cicp.h"
#include "imageio/scratch.h"

enum { SIDE = 256 };

/* Mean and greatest error of a value, in steps, rounded with noise over a field of pixels. */
static double mean_of(float value, float top, double *out_worst)
{
    double sum = 0;
    *out_worst = 0;
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            const double rounded =
                floor((double)value + (double)ppmi_dither(x, y, value, top) + 0.5);
            sum += rounded;
            *out_worst = fmax(*out_worst, fabs(rounded - (double)value));
        }
    }
    return sum / (SIDE * SIDE);
}

static void the_mean_is_the_value(void **state)
{
    (void)state;
    static const float values[] = {0.1f, 0.3f, 0.5f, 0.9f, 100.25f, 128.0f, 200.7f, 254.6f, 254.9f};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        double worst;
        const double mean = mean_of(values[i], 255, &worst);
        /* the rounded value's deviation is at most 0.87 steps: five of the mean's */
        assert_float_equal(mean, values[i], (float)(5 * 0.87 / SIDE));
        assert_true(worst < 1.51);
    }
}

static void black_and_white_stay(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        double worst;
        const float value = i == 0 ? 0 : 255;
        assert_float_equal(mean_of(value, 255, &worst), value, 0);
        assert_float_equal(worst, 0, 0);
    }
}

/* A covariance between neighbours would be seen as lines. */
static void neighbours_are_independent(void **state)
{
    (void)state;
    double sum[2] = {0, 0}, squares = 0;
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++) {
            const double here = (double)ppmi_dither(x, y, 100, 255);
            squares += here * here;
            sum[0] += here * (double)ppmi_dither(x + 1, y, 100, 255);
            sum[1] += here * (double)ppmi_dither(x, y + 1, 100, 255);
        }
    }
    for (int i = 0; i < 2; i++)
        assert_true(fabs(sum[i] / squares) < 5.0 / SIDE);
    assert_float_equal(squares / (SIDE * SIDE), 1.0 / 6, 0.01); /* of a triangle of two steps */
}

/* ---- in files -------------------------------------------------------------------------------- */

static void write_ramp(const char *name, bool is_dithered, uint32_t x, uint32_t first)
{
    float pixels[SIDE * 4];
    for (uint32_t i = 0; i < SIDE; i++) {
        for (int c = 0; c < 3; c++)
            pixels[4 * i + (uint32_t)c] = 0.5f;
        pixels[4 * i + 3] = 0.5f;
    }
    const ppmi_image_file file = {.width = SIDE - first,
                                  .height = 1,
                                  .channels = 4,
                                  .x = x,
                                  .pixels = pixels + 4 * first,
                                  .store = PPMI_STORE_U8,
                                  .is_dithered = is_dithered};
    assert_int_equal(ppmi_imageio_write_file(NULL, scratch_path(name), &file), PPM_STATUS_OK);
}

static ppmi_pixels read_back(const char *name)
{
    ppmi_pixels pixels;
    assert_int_equal(ppmi_imageio_read_file(NULL, scratch_path(name), name, &pixels),
                     PPM_STATUS_OK);
    return pixels;
}

static void files_are_dithered_where_they_are_asked_to(void **state)
{
    (void)state;
    scratch_create();
    write_ramp("plain.png", false, 0, 0);
    write_ramp("noisy.png", true, 0, 0);
    write_ramp("crop.png", true, 100, 100);
    ppmi_pixels plain = read_back("plain.png"), noisy = read_back("noisy.png");
    ppmi_pixels crop = read_back("crop.png");
    int others = 0;
    for (uint32_t i = 0; i < SIDE; i++) {
        const uint8_t *const pixel = noisy.u8 + 4 * i;
        assert_int_equal(plain.u8[4 * i], 128);
        others += pixel[0] != 128;
        assert_true(pixel[0] >= 126 && pixel[0] <= 129);
        assert_int_equal(pixel[1], pixel[0]); /* grey stays grey */
        assert_int_equal(pixel[2], pixel[0]);
        assert_int_equal(pixel[3], 128); /* and alpha is not noisy */
        if (i >= 100) assert_int_equal(crop.u8[4 * (i - 100)], pixel[0]);
    }
    assert_true(others > SIDE / 4);
    ppmi_imageio_pixels_free(NULL, &plain);
    ppmi_imageio_pixels_free(NULL, &noisy);
    ppmi_imageio_pixels_free(NULL, &crop);
    scratch_remove();
}

/* Rec.2100 PQ; the checksum is zlib's. */
static void a_cicp_chunk_stands_behind_the_header(void **state)
{
    (void)state;
    static const uint8_t code_points[4] = {9, 16, 0, 1};
    static const uint8_t chunk[PPMI_PNG_CICP_BYTES] = {0, 0,  0, 4, 'c',  'I',  'C',  'P',
                                                       9, 16, 0, 1, 0x4d, 0x23, 0x23, 0xfe};
    uint8_t png[40], out[40 + PPMI_PNG_CICP_BYTES];
    for (int i = 0; i < 40; i++)
        png[i] = (uint8_t)i;
    ppmi_png_add_cicp(png, sizeof png, code_points, out);
    assert_memory_equal(out, png, 33);
    assert_memory_equal(out + 33, chunk, sizeof chunk);
    assert_memory_equal(out + 33 + sizeof chunk, png + 33, 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mean_is_the_value),
        cmocka_unit_test(black_and_white_stay),
        cmocka_unit_test(neighbours_are_independent),
        cmocka_unit_test(files_are_dithered_where_they_are_asked_to),
        cmocka_unit_test(a_cicp_chunk_stands_behind_the_header),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
