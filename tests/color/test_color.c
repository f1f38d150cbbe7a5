/* Configurations, displays and views. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "color/color.h"
#include "imageio/scratch.h"

static const char blender_config[] = "/usr/share/blender/datafiles/colormanagement/config.ocio";

/* yaml-cpp 0.7 loses a buffer when a text is no YAML at all. Read by LeakSanitizer, if it is there.
 */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libyaml-cpp";
}

static ppm_context *context;
static int warning_count;

static void count_warnings(void *user, ppm_log_level level, const char *message)
{
    (void)user;
    (void)message;
    if (level == PPM_LOG_WARNING) warning_count++;
}

static int setup(void **state)
{
    (void)state;
    unsetenv("OCIO");
    scratch_create();
    warning_count = 0;
    const ppm_context_desc desc = {.size = sizeof desc, .log = count_warnings};
    return ppm_context_create(&desc, &context);
}

static int teardown(void **state)
{
    (void)state;
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    scratch_remove();
    return live == 0 ? 0 : 1;
}

static ppm_color *open_color(const char *path)
{
    ppm_color *color = NULL;
    assert_int_equal(ppm_color_create(context, path, &color), PPM_STATUS_OK);
    return color;
}

static ppm_color *open_text(const char *text)
{
    scratch_write_text("config.ocio", text);
    return open_color(scratch_path("config.ocio"));
}

static ppm_color *open_or_skip(const char *path)
{
    if (access(path, R_OK) != 0) {
        print_message("skipped: %s is not here\n", path);
        skip();
    }
    return open_color(path);
}

static void assert_error_names(const char *part)
{
    char message[2048];
    ppm_context_last_error(context, message, sizeof message);
    if (!strstr(message, part)) fail_msg("\"%s\" is not in \"%s\"", part, message);
}

/* One pixel of linear Rec.709 through a view. */
static void show(const ppm_color *color, const char *view, float exposure_ev, float rgba[4])
{
    const ppmi_view_choice choice = {.view = view, .exposure_ev = exposure_ev};
    assert_int_equal(ppmi_color_show(context, color, &choice, &ppmi_working_space_rec709, rgba, 1),
                     PPM_STATUS_OK);
}

static float srgb_encoded(float linear)
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

static void built_in_configuration_has_no_fault(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL);
    assert_int_equal(warning_count, 0);
    assert_string_equal(ppm_color_source(color), "built-in");
    assert_string_equal(ppm_color_default_display(color), "sRGB");
    assert_string_equal(ppm_color_default_view(color, "sRGB"), "ACES 1.0 - SDR Video");
    ppm_color_destroy(color);
}

static void built_in_names_are_listed_and_end(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL);
    assert_int_equal(ppm_color_display_count(color), 4);
    assert_string_equal(ppm_color_display_name(color, 0), "sRGB");
    assert_string_equal(ppm_color_display_name(color, 2), "Display P3");
    assert_null(ppm_color_display_name(color, 4));
    assert_int_equal(ppm_color_view_count(color, "sRGB"), 5);
    assert_string_equal(ppm_color_view_name(color, "sRGB", 3), "Standard");
    assert_null(ppm_color_view_name(color, "sRGB", 5));
    assert_int_equal(ppm_color_view_count(color, "none"), 0);
    const uint32_t spaces = ppm_color_space_count(color);
    assert_true(spaces >= 6);
    for (uint32_t i = 0; i < spaces; i++)
        assert_non_null(ppm_color_space_name(color, i));
    assert_null(ppm_color_space_name(color, spaces));
    ppm_color_destroy(color);
}

static void no_configuration_has_no_names(void **state)
{
    (void)state;
    assert_null(ppm_color_source(NULL));
    assert_int_equal(ppm_color_display_count(NULL), 0);
    assert_null(ppm_color_display_name(NULL, 0));
    assert_null(ppm_color_default_view(NULL, "sRGB"));
    assert_int_equal(ppm_color_create(context, NULL, NULL), PPM_STATUS_INVALID_ARGUMENT);
    ppm_color_destroy(NULL);
}

static void standard_view_is_the_srgb_curve(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL);
    for (int i = 0; i <= 100; i++) {
        const float value = (float)i / 100;
        float rgba[4] = {value, 1 - value, 0.25f, 0.3f};
        show(color, "Standard", 0, rgba);
        assert_float_equal(rgba[0], srgb_encoded(value), 1e-4);
        assert_float_equal(rgba[1], srgb_encoded(1 - value), 1e-4);
        assert_float_equal(rgba[2], srgb_encoded(0.25f), 1e-4);
        assert_float_equal(rgba[3], 0.3f, 0); /* alpha is not a colour */
    }
    ppm_color_destroy(color);
}

static void aces_view_rolls_highlights_off(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL);
    float grey[4] = {0.18f, 0.18f, 0.18f, 1};
    show(color, NULL, 0, grey);
    /* ACES puts mid grey at 10 nit of 100: sRGB 0.349, a little more with its dim surround */
    assert_float_equal(grey[0], 0.356f, 0.01f);
    assert_float_equal(grey[1], grey[0], 1e-4);
    assert_float_equal(grey[2], grey[0], 1e-4);
    float before = 0;
    for (int stop = -6; stop <= 6; stop++) {
        float pixel[4] = {0.18f, 0.18f, 0.18f, 1};
        show(color, NULL, (float)stop, pixel);
        assert_true(pixel[0] > before);
        assert_true(pixel[0] <= 1.0001f);
        before = pixel[0];
    }
    assert_true(before > 0.98f);
    ppm_color_destroy(color);
}

static void exposure_is_in_stops(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL);
    float rgba[4] = {0.1f, 0.2f, 0.05f, 0.5f};
    show(color, "Raw", 2, rgba);
    assert_float_equal(rgba[0], 0.4f, 1e-6);
    assert_float_equal(rgba[1], 0.8f, 1e-6);
    assert_float_equal(rgba[2], 0.2f, 1e-6);
    assert_float_equal(rgba[3], 0.5f, 0);
    ppm_color_destroy(color);
}

static void unknown_names_get_a_suggestion(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL);
    assert_int_equal(ppm_color_check_view(context, color, "sRGB", "Standrad"),
                     PPM_STATUS_NOT_FOUND);
    assert_error_names("did you mean \"Standard\"");
    assert_error_names("\"Raw\"");
    assert_int_equal(ppm_color_check_view(context, color, "sRBG", NULL), PPM_STATUS_NOT_FOUND);
    assert_error_names("did you mean \"sRGB\"");
    float rgba[4] = {1, 1, 1, 1};
    const ppmi_view_choice unknown = {.display = "", .view = "zzz"};
    assert_int_equal(
        ppmi_color_show(context, color, &unknown, ppmi_color_working_space(color), rgba, 1),
        PPM_STATUS_NOT_FOUND);
    assert_float_equal(rgba[0], 1, 0);
    ppm_color_destroy(color);
}

static void names_are_found_in_any_letter_case(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL);
    assert_int_equal(ppm_color_check_view(context, color, "SRGB", "standard"), PPM_STATUS_OK);
    assert_int_equal(ppm_color_check_view(context, color, "", ""), PPM_STATUS_OK);
    ppm_color_destroy(color);
}

#define REC709_SPACE "  - !<ColorSpace> {name: lin_srgb}\n"
#define SMALL_CONFIG(roles, spaces)                                                                \
    "ocio_profile_version: 1\n"                                                                    \
    "search_path: .\n"                                                                             \
    "roles:\n" roles "displays:\n"                                                                 \
    "  screen:\n"                                                                                  \
    "    - !<View> {name: plain, colorspace: working}\n"                                           \
    "    - !<View> {name: lut, colorspace: with_lut}\n"                                            \
    "colorspaces:\n"                                                                               \
    "  - !<ColorSpace> {name: working}\n"                                                          \
    "  - !<ColorSpace>\n"                                                                          \
    "    name: with_lut\n"                                                                         \
    "    from_reference: !<FileTransform> {src: missing.spi1d, interpolation: linear}\n" spaces

static void environment_variable_names_the_configuration(void **state)
{
    (void)state;
    scratch_write_text("config.ocio", SMALL_CONFIG("  default: working\n", REC709_SPACE));
    setenv("OCIO", scratch_path("config.ocio"), 1);
    ppm_color *color = open_color(NULL);
    assert_string_equal(ppm_color_source(color), scratch_path("config.ocio"));
    assert_string_equal(ppm_color_default_display(color), "screen");
    ppm_color_destroy(color);
    setenv("OCIO", "", 1);
    color = open_color(NULL);
    assert_string_equal(ppm_color_source(color), "built-in");
    ppm_color_destroy(color);
    unsetenv("OCIO");
}

static void a_configuration_that_does_not_know_rec709_is_refused(void **state)
{
    (void)state;
    ppm_color *color = NULL;
    scratch_write_text("config.ocio", SMALL_CONFIG("  scene_linear: working\n", ""));
    assert_int_equal(ppm_color_create(context, scratch_path("config.ocio"), &color),
                     PPM_STATUS_INPUT_INVALID);
    assert_null(color);
    assert_error_names("aces_interchange");
}

static void an_aces_configuration_gets_a_matrix(void **state)
{
    (void)state;
    ppm_color *const color =
        open_text(SMALL_CONFIG("  scene_linear: working\n  aces_interchange: working\n", ""));
    float rgba[4] = {1, 0, 0, 1};
    show(color, "plain", 0, rgba);
    /* the Rec.709 red in ACES2065-1 (Bradford adapted) */
    assert_float_equal(rgba[0], 0.43963f, 1e-4);
    assert_float_equal(rgba[1], 0.08978f, 1e-4);
    assert_float_equal(rgba[2], 0.01754f, 1e-4);
    ppm_color_destroy(color);
}

static void a_missing_table_fails_only_its_view(void **state)
{
    (void)state;
    ppm_color *const color = open_text(SMALL_CONFIG("  default: working\n", REC709_SPACE));
    assert_int_equal(ppm_color_check_view(context, color, NULL, "plain"), PPM_STATUS_OK);
    assert_int_equal(ppm_color_check_view(context, color, NULL, "lut"), PPM_STATUS_INPUT_INVALID);
    assert_error_names("missing.spi1d");
    ppm_color_destroy(color);
}

static void broken_configurations_are_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",
        "not a configuration",
        "ocio_profile_version: 99\n",
        "ocio_profile_version: 2\nroles: [",
        "ocio_profile_version: 1\ncolorspaces:\n  - !<ColorSpace> {name: }\n",
        "\x89PNG\r\n\x1a\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        scratch_write_text("config.ocio", texts[i]);
        ppm_color *color = NULL;
        assert_int_equal(ppm_color_create(context, scratch_path("config.ocio"), &color),
                         PPM_STATUS_INPUT_INVALID);
        assert_null(color);
        assert_error_names("config.ocio");
    }
}

static void a_missing_configuration_is_named(void **state)
{
    (void)state;
    ppm_color *color = NULL;
    assert_int_equal(ppm_color_create(context, scratch_path("none.ocio"), &color),
                     PPM_STATUS_INPUT_NOT_FOUND);
    assert_error_names("none.ocio");
    assert_int_equal(ppm_color_create(context, scratch_path(""), &color), PPM_STATUS_INPUT_INVALID);
    assert_null(color);
}

static void broken_tables_fail_with_their_name(void **state)
{
    (void)state;
    static const char *const names[] = {
        "array_bad_dimension",
        "array_too_many_values",
        "cdl_bad_slope",
        "cdl_missing_power",
        "exponent_bad_value",
        "log_bad_param",
        "lut3d_unequal_size",
        "transform_corrupted_tag",
        "transform_missing",
        "range_bad_noclamp",
        "lut1d_half_domain_missing_values",
    };
    static const char folder[] = PPM_ASSETS_DIR "/bad/ocio";
    if (access(folder, R_OK) != 0) {
        print_message("skipped: %s is not here\n", folder);
        skip();
    }
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char text[4096];
        snprintf(text, sizeof text,
                 "ocio_profile_version: 1\nsearch_path: %s\nroles:\n  default: lin_srgb\n"
                 "displays:\n  screen:\n    - !<View> {name: lut, colorspace: with_lut}\n"
                 "colorspaces:\n  - !<ColorSpace> {name: lin_srgb}\n"
                 "  - !<ColorSpace>\n    name: with_lut\n"
                 "    from_reference: !<FileTransform> {src: %s.clf}\n",
                 folder, names[i]);
        ppm_color *const color = open_text(text);
        assert_int_equal(ppm_color_check_view(context, color, NULL, NULL),
                         PPM_STATUS_INPUT_INVALID);
        assert_error_names(names[i]);
        ppm_color_destroy(color);
    }
}

static void blender_filmic_works(void **state)
{
    (void)state;
    ppm_color *const color = open_or_skip(blender_config);
    assert_int_equal(warning_count, 0);
    float grey[4] = {0.18f, 0.18f, 0.18f, 1};
    show(color, "Filmic", 0, grey);
    assert_float_equal(grey[0], 0.5f, 0.01f); /* what Filmic is made for */
    assert_float_equal(grey[1], grey[0], 1e-4);
    float standard[4] = {0.5f, 0.1f, 0.9f, 1};
    show(color, "Standard", 0, standard);
    assert_float_equal(standard[0], srgb_encoded(0.5f), 1e-3);
    assert_float_equal(standard[1], srgb_encoded(0.1f), 1e-3);
    assert_float_equal(standard[2], srgb_encoded(0.9f), 1e-3);
    ppm_color_destroy(color);
}

static void aswf_configuration_agrees_with_the_built_in_one(void **state)
{
    (void)state;
    ppm_color *const aswf =
        open_or_skip(PPM_ASSETS_DIR "/ocio/cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio");
    ppm_color *const builtin = open_color(NULL);
    float a[4] = {2.0f, 0.3f, 0.05f, 1}, b[4] = {2.0f, 0.3f, 0.05f, 1};
    show(aswf, "ACES 1.0 - SDR Video", 0, a);
    show(builtin, "ACES 1.0 - SDR Video", 0, b);
    for (int i = 0; i < 4; i++)
        assert_float_equal(a[i], b[i], 1e-4);
    ppm_color_destroy(aswf);
    ppm_color_destroy(builtin);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(built_in_configuration_has_no_fault),
        TEST(built_in_names_are_listed_and_end),
        TEST(no_configuration_has_no_names),
        TEST(standard_view_is_the_srgb_curve),
        TEST(aces_view_rolls_highlights_off),
        TEST(exposure_is_in_stops),
        TEST(unknown_names_get_a_suggestion),
        TEST(names_are_found_in_any_letter_case),
        TEST(environment_variable_names_the_configuration),
        TEST(a_configuration_that_does_not_know_rec709_is_refused),
        TEST(an_aces_configuration_gets_a_matrix),
        TEST(a_missing_table_fails_only_its_view),
        TEST(broken_configurations_are_refused),
        TEST(a_missing_configuration_is_named),
        TEST(broken_tables_fail_with_their_name),
        TEST(blender_filmic_works),
        TEST(aswf_configuration_agrees_with_the_built_in_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
