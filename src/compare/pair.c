/* From files to values that may be subtracted.
 *
 * What is compared is the light that a picture adds: linear, and multiplied by alpha, as the
 * renderer's film and OpenEXR have it. */
#include "compare/pair.h"

#include <math.h>
#include <string.h>

#include "compare/opponent.h"
#include "imageio/imageio.h"

/* ---- values ---------------------------------------------------------------------------------- */

/* One stored value as a colour: light as it is, a display's code value decoded. */
static float colour_value(const ppmi_pixels *pixels, size_t index)
{
    if (pixels->u8) return ppmi_compare_srgb_decode((float)pixels->u8[index] / 255);
    return pixels->is_linear ? pixels->f32[index] : ppmi_compare_srgb_decode(pixels->f32[index]);
}

static float alpha_value(const ppmi_pixels *pixels, size_t index)
{
    return pixels->u8 ? (float)pixels->u8[index] / 255 : pixels->f32[index];
}

/* What the reader divided by alpha is multiplied again. It leaves pixels of alpha 0 as they are: in
 * a file of light they are light without a surface, such as a glow. */
static void read_pixel(const ppmi_pixels *pixels, size_t pixel, float rgb[3])
{
    const uint32_t channels = pixels->channels;
    const size_t first = pixel * channels;
    const bool is_grey = channels < 3, has_alpha = channels == 2 || channels == 4;
    float factor = has_alpha ? alpha_value(pixels, first + channels - 1) : 1;
    if (pixels->is_linear && !(factor > 0)) factor = 1;
    for (uint32_t c = 0; c < 3; c++)
        rgb[c] = factor * colour_value(pixels, first + (is_grey ? 0 : c));
}

static void read_window(const ppmi_pixels *pixels, const ppmi_compare_pair *window, float *out_rgb)
{
#pragma omp parallel for schedule(static)
    for (int64_t y = 0; y < window->height; y++) {
        const size_t first = (size_t)(window->y + y) * pixels->width + window->x;
        float *const row = out_rgb + 3 * (size_t)y * window->width;
        for (uint32_t x = 0; x < window->width; x++)
            read_pixel(pixels, first + x, row + 3 * (size_t)x);
    }
}

/* ---- broken pixels --------------------------------------------------------------------------- */

static bool is_finite(const float rgb[3])
{
    return isfinite(rgb[0]) && isfinite(rgb[1]) && isfinite(rgb[2]);
}

/* Filters must not carry a broken pixel to its neighbours, nor find a difference there. */
static void set_broken_aside(ppmi_compare_pair *pair)
{
    const size_t pixel_count = (size_t)pair->width * pair->height;
    for (size_t i = 0; i < pixel_count; i++) {
        float *const test = pair->test + 3 * i, *const reference = pair->reference + 3 * i;
        const bool test_is_broken = !is_finite(test), reference_is_broken = !is_finite(reference);
        pair->test_broken += test_is_broken;
        pair->reference_broken += reference_is_broken;
        pair->is_broken[i] = test_is_broken || reference_is_broken;
        if (!pair->is_broken[i]) pair->measured++;
        if (reference_is_broken) memset(reference, 0, 3 * sizeof *reference);
        if (pair->is_broken[i]) memcpy(test, reference, 3 * sizeof *test);
    }
}

/* ---- windows --------------------------------------------------------------------------------- */

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static bool is_same_window(const ppmi_pixels *a, const ppmi_pixels *b)
{
    return a->stored_x == b->stored_x && a->stored_y == b->stored_y &&
           a->stored_width == b->stored_width && a->stored_height == b->stored_height;
}

/* The pixels that both files store. */
static ppm_status find_window(ppm_context *context, const char *test_path, const ppmi_pixels *test,
                              const char *reference_path, const ppmi_pixels *reference,
                              ppmi_compare_pair *pair)
{
    if (test->width != reference->width || test->height != reference->height) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s has %u x %u pixels, %s has %u x %u: pictures of the same size can be "
                         "compared",
                         test_path, test->width, test->height, reference_path, reference->width,
                         reference->height);
    }
    pair->picture_width = test->width;
    pair->picture_height = test->height;
    pair->x = larger(test->stored_x, reference->stored_x);
    pair->y = larger(test->stored_y, reference->stored_y);
    const uint32_t end_x =
        smaller(test->stored_x + test->stored_width, reference->stored_x + reference->stored_width);
    const uint32_t end_y = smaller(test->stored_y + test->stored_height,
                                   reference->stored_y + reference->stored_height);
    if (end_x <= pair->x || end_y <= pair->y) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s and %s are parts of a picture that do not overlap", test_path,
                         reference_path);
    }
    pair->width = end_x - pair->x;
    pair->height = end_y - pair->y;
    if (!is_same_window(test, reference)) {
        ppmi_log(context, PPM_LOG_WARNING,
                 "%s and %s store different parts; compared is what both have: %u x %u pixels at "
                 "%u,%u",
                 test_path, reference_path, pair->width, pair->height, pair->x, pair->y);
    }
    return PPM_STATUS_OK;
}

/* ---- the pair -------------------------------------------------------------------------------- */

static ppm_status take_memory(ppm_context *context, ppmi_compare_pair *pair)
{
    const size_t pixel_count = (size_t)pair->width * pair->height;
    pair->test = ppmi_alloc(context, pixel_count, 3 * sizeof(float));
    pair->reference = ppmi_alloc(context, pixel_count, 3 * sizeof(float));
    pair->is_broken = ppmi_alloc_zeroed(context, pixel_count, 1);
    if (pair->test && pair->reference && pair->is_broken) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "no memory for %u x %u pixels", pair->width,
                     pair->height);
}

static ppm_status make_pair(ppm_context *context, const char *test_path, const ppmi_pixels *test,
                            const char *reference_path, const ppmi_pixels *reference,
                            ppmi_compare_pair *pair)
{
    ppm_status status = find_window(context, test_path, test, reference_path, reference, pair);
    if (status == PPM_STATUS_OK) status = take_memory(context, pair);
    if (status != PPM_STATUS_OK) return status;
    pair->is_linear = test->is_linear || reference->is_linear;
    if (test->is_linear != reference->is_linear) {
        ppmi_log(context, PPM_LOG_WARNING,
                 "%s holds light, %s values for a display, whose view is not undone",
                 test->is_linear ? test_path : reference_path,
                 test->is_linear ? reference_path : test_path);
    }
    read_window(test, pair, pair->test);
    read_window(reference, pair, pair->reference);
    set_broken_aside(pair);
    if (pair->measured > 0) return PPM_STATUS_OK;
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                     "%s and %s have no pixel that is finite in both", test_path, reference_path);
}

ppm_status ppmi_compare_pair_read(ppm_context *context, const char *test_path,
                                  const char *reference_path, ppmi_compare_pair *out_pair)
{
    ppmi_pixels test = {0}, reference = {0};
    ppmi_compare_pair pair = {0};
    ppm_status status = ppmi_imageio_read_file(context, test_path, test_path, &test);
    if (status == PPM_STATUS_OK) {
        status = ppmi_imageio_read_file(context, reference_path, reference_path, &reference);
    }
    if (status == PPM_STATUS_OK) {
        status = make_pair(context, test_path, &test, reference_path, &reference, &pair);
    }
    ppmi_imageio_pixels_free(context, &test);
    ppmi_imageio_pixels_free(context, &reference);
    if (status == PPM_STATUS_OK) {
        *out_pair = pair;
    } else {
        ppmi_compare_pair_free(context, &pair);
    }
    return status;
}

void ppmi_compare_pair_free(ppm_context *context, ppmi_compare_pair *pair)
{
    ppmi_free(context, pair->test);
    ppmi_free(context, pair->reference);
    ppmi_free(context, pair->is_broken);
    *pair = (ppmi_compare_pair){0};
}
