/* Textures: sRGB code values to linear Rec.709. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "color/color.h"
#include "imageio/scratch.h"

/* IEC 61966-2-1 */
static double srgb_decoded(double code)
{
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}

static ppm_context *context;

static int setup(void **state)
{
    (void)state;
    unsetenv("OCIO");
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

static void assert_table_is_srgb(const ppm_color *color, double tolerance)
{
    float table[256];
    assert_int_equal(ppmi_color_srgb_decode_table(context, color, table), PPM_STATUS_OK);
    for (int i = 0; i < 256; i++) {
        assert_float_equal(table[i], (float)srgb_decoded(i / 255.0), (float)tolerance);
    }
}

static void assert_table_of_file(const char *path, double tolerance)
{
    ppm_color *color = NULL;
    if (access(path, R_OK) != 0) {
        print_message("skipped: %s is not here\n", path);
        skip();
    }
    assert_int_equal(ppm_color_create(context, path, &color), PPM_STATUS_OK);
    assert_table_is_srgb(color, tolerance);
    ppm_color_destroy(color);
}

static void built_in_table_is_the_standard_curve(void **state)
{
    (void)state;
    assert_table_is_srgb(NULL, 5e-6);
}

static void blender_table_is_the_standard_curve(void **state)
{
    (void)state;
    assert_table_of_file("/usr/share/blender/datafiles/colormanagement/config.ocio", 5e-6);
}

static void aswf_table_is_the_standard_curve(void **state)
{
    (void)state;
    assert_table_of_file(PPM_ASSETS_DIR "/ocio/cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio", 5e-6);
}

static void a_configuration_that_knows_no_srgb_gets_the_built_in_curve(void **state)
{
    (void)state;
    scratch_write_text("config.ocio", "ocio_profile_version: 1\n"
                                      "roles:\n  default: lnf\n"
                                      "displays:\n"
                                      "  screen:\n"
                                      "    - !<View> {name: plain, colorspace: lnf}\n"
                                      "colorspaces:\n"
                                      "  - !<ColorSpace> {name: lnf}\n");
    assert_table_of_file(scratch_path("config.ocio"), 5e-6);
}

static void the_curve_of_the_configuration_is_used(void **state)
{
    (void)state;
    scratch_write_text("config.ocio",
                       "ocio_profile_version: 1\n"
                       "roles:\n  default: lin_rec709\n"
                       "displays:\n"
                       "  screen:\n"
                       "    - !<View> {name: plain, colorspace: lin_rec709}\n"
                       "colorspaces:\n"
                       "  - !<ColorSpace> {name: lin_rec709}\n"
                       "  - !<ColorSpace>\n"
                       "    name: srgb_tx\n"
                       "    to_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}\n");
    ppm_color *color = NULL;
    assert_int_equal(ppm_color_create(context, scratch_path("config.ocio"), &color), PPM_STATUS_OK);
    float table[256];
    assert_int_equal(ppmi_color_srgb_decode_table(context, color, table), PPM_STATUS_OK);
    assert_float_equal(table[51], 0.04f, 1e-6);
    assert_float_equal(table[255], 1, 1e-6);
    ppm_color_destroy(color);
}

static void floats_are_decoded_and_alpha_is_left_alone(void **state)
{
    (void)state;
    float rgb[6] = {0, 0.02f, 0.5f, 0.9f, 1, 0.3f};
    const float codes[6] = {0, 0.02f, 0.5f, 0.9f, 1, 0.3f};
    assert_int_equal(ppmi_color_srgb_decode(context, NULL, rgb, 2, 3), PPM_STATUS_OK);
    for (int i = 0; i < 6; i++) {
        assert_float_equal(rgb[i], (float)srgb_decoded((double)codes[i]), 5e-6);
    }
    float rgba[4] = {0.5f, 0.5f, 0.5f, 0.25f};
    assert_int_equal(ppmi_color_srgb_decode(context, NULL, rgba, 1, 4), PPM_STATUS_OK);
    assert_float_equal(rgba[1], (float)srgb_decoded(0.5), 5e-6);
    assert_float_equal(rgba[3], 0.25f, 0);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    float table[256];
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    for (size_t n = 1; status == PPM_STATUS_OUT_OF_MEMORY; n++) {
        ppmi_alloc_fail_at(context, n);
        status = ppmi_color_srgb_decode_table(context, NULL, table);
        assert_true(status == PPM_STATUS_OK ? n > 1 : n < 20);
        assert_int_equal(ppmi_alloc_live(context), 0);
    }
    assert_int_equal(status, PPM_STATUS_OK);
    ppmi_alloc_fail_at(context, 0);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(built_in_table_is_the_standard_curve),
        TEST(blender_table_is_the_standard_curve),
        TEST(aswf_table_is_the_standard_curve),
        TEST(a_configuration_that_knows_no_srgb_gets_the_built_in_curve),
        TEST(the_curve_of_the_configuration_is_used),
        TEST(floats_are_decoded_and_alpha_is_left_alone),
        TEST(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
