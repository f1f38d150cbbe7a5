/* OpenEXR files of several layers: which one is the picture. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "imageio/imageio.h"
#include "imageio/scratch.h"

static ppm_context *context;

/* Writes one pixel whose channels are 0, 1, 2, ... in the order of names, and reads it. */
static void assert_reads(const char *const *names, uint32_t count, const float *expected,
                         uint32_t expected_count)
{
    float values[16];
    for (uint32_t i = 0; i < count; i++)
        values[i] = (float)i;
    const ppmi_image_file file = {.width = 1,
                                  .height = 1,
                                  .channels = count,
                                  .pixels = values,
                                  .channel_names = names,
                                  .store = PPMI_STORE_FLOAT};
    scratch_create();
    const char *const path = scratch_path("layers.exr");
    assert_int_equal(ppmi_imageio_write_file(context, path, &file), PPM_STATUS_OK);
    ppmi_pixels pixels;
    assert_int_equal(ppmi_imageio_read_file(context, path, path, &pixels), PPM_STATUS_OK);
    assert_int_equal(pixels.channels, expected_count);
    assert_memory_equal(pixels.f32, expected, expected_count * sizeof *expected);
    ppmi_imageio_pixels_free(context, &pixels);
    scratch_remove();
}

static void the_layer_without_a_name_comes_first(void **state)
{
    (void)state;
    static const char *const names[] = {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B"};
    assert_reads(names, 6, (const float[]){0, 1, 2}, 3);
}

static void combined_is_the_picture_where_all_have_names(void **state)
{
    (void)state;
    static const char *const names[] = {"View.AO.R",       "View.AO.G",       "View.AO.B",
                                        "View.Combined.R", "View.Combined.G", "View.Combined.B",
                                        "View.Depth.Z"};
    assert_reads(names, 7, (const float[]){3, 4, 5}, 3);
}

static void else_the_first_layer_with_colours_is(void **state)
{
    (void)state;
    static const char *const names[] = {"depth.Z", "left.R",  "left.G", "left.B",
                                        "right.R", "right.G", "right.B"};
    assert_reads(names, 7, (const float[]){1, 2, 3}, 3);
}

/* Alpha is 4 here: what is read has been divided by it. */
static void a_layer_has_its_own_alpha(void **state)
{
    (void)state;
    static const char *const names[] = {"depth.Z", "left.R", "left.G", "left.B", "left.A"};
    assert_reads(names, 5, (const float[]){0.25f, 0.5f, 0.75f, 4}, 4);
}

int main(void)
{
    if (ppm_context_create(NULL, &context) != PPM_STATUS_OK) return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_layer_without_a_name_comes_first),
        cmocka_unit_test(combined_is_the_picture_where_all_have_names),
        cmocka_unit_test(else_the_first_layer_with_colours_is),
        cmocka_unit_test(a_layer_has_its_own_alpha),
    };
    const int failures = cmocka_run_group_tests(tests, NULL, NULL);
    ppm_context_destroy(context);
    return failures;
}
