/* Views: tone maps against their formulas, displays against their standards, looks, and what files
 * say about them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "color/color.h"
#include "color/display_tag.h"
#include "color/icc.h"
#include "imageio/scratch.h"

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

static ppm_color *open_color(const char *config, const char *space)
{
    const ppm_color_options options = {
        .size = sizeof options, .config_path = config ? config : "", .working_space = space};
    ppm_color *color = NULL;
    assert_int_equal(ppm_color_create_with(context, &options, &color), PPM_STATUS_OK);
    return color;
}

/* A pixel of linear Rec.709. */
static void show(const ppm_color *color, ppmi_view_choice choice, const float rgb[3], float out[4])
{
    memcpy(out, rgb, 3 * sizeof *out);
    out[3] = 1;
    assert_int_equal(ppmi_color_show(context, color, &choice, &ppmi_working_space_rec709, out, 1),
                     PPM_STATUS_OK);
}

static double srgb_encoded(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static const float colours[][3] = {
    {0, 0, 0},           {0.18f, 0.18f, 0.18f},
    {0.5f, 0.5f, 0.5f},  {0.8f, 0.02f, 0.05f},
    {0.03f, 0.4f, 0.2f}, {1, 1, 1},
    {5, 0.3f, 0.1f},     {0.2f, 0.4f, 30},
    {100, 90, 80},       {0.01f, 0.05f, 0.07f},
};
enum { COLOURS = sizeof colours / sizeof colours[0] };

/* ---- tone maps ------------------------------------------------------------------------------- */

/* Section by section as the specification has it. */
static void neutral_by_specification(const float rgb[3], double out[3])
{
    double c[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]};
    const double x = fmin(c[0], fmin(c[1], c[2]));
    const double f = x <= 0.08 ? x - x * x / (4 * 0.04) : 0.04;
    for (int i = 0; i < 3; i++)
        c[i] -= f;
    const double p = fmax(c[0], fmax(c[1], c[2]));
    const double ks = 0.8 - 0.04, kd = 0.15;
    for (int i = 0; i < 3; i++)
        out[i] = c[i];
    if (p <= ks) return;
    const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks);
    const double g = 1 / (kd * (p - pn) + 1);
    for (int i = 0; i < 3; i++)
        out[i] = c[i] * pn / p * g + pn * (1 - g);
}

static void neutral_is_the_published_formula(void **state)
{
    (void)state;
    static const char *const spaces[] = {NULL, "ACEScg"};
    for (int k = 0; k < 2; k++) {
        ppm_color *const color = open_color(NULL, spaces[k]);
        for (int i = 0; i < COLOURS; i++) {
            float out[4];
            double expected[3];
            show(color, (ppmi_view_choice){.view = "Khronos PBR Neutral"}, colours[i], out);
            neutral_by_specification(colours[i], expected);
            for (int c = 0; c < 3; c++)
                assert_float_equal(out[c], srgb_encoded(expected[c]), 2e-4);
        }
        ppm_color_destroy(color);
    }
}

static void neutral_returns_base_colours(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL, NULL);
    /* a surface of 0.5 and the 4 % that it reflects of white surroundings */
    const float rgb[3] = {0.54f, 0.24f, 0.14f};
    float out[4];
    show(color, (ppmi_view_choice){.view = "Khronos PBR Neutral"}, rgb, out);
    assert_float_equal(out[0], srgb_encoded(0.5), 1e-4);
    assert_float_equal(out[1], srgb_encoded(0.2), 1e-4);
    assert_float_equal(out[2], srgb_encoded(0.1), 1e-4);
    ppm_color_destroy(color);
}

static void agx_keeps_greys_and_fades_lights_to_white(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL, NULL);
    const ppmi_view_choice choice = {.view = "AgX"};
    float before = -1, out[4];
    for (int stop = -8; stop <= 6; stop++) {
        const float value = 0.18f * exp2f((float)stop), rgb[3] = {value, value, value};
        show(color, choice, rgb, out);
        assert_true(out[0] >= before && out[0] <= 1.0f);
        assert_float_equal(out[1], out[0], 2e-3);
        assert_float_equal(out[2], out[0], 2e-3);
        /* the pivot of Sobotka's curve: middle grey is half of the code values */
        if (stop == 0) assert_float_equal(out[0], 0.5f, 0.01f);
        before = out[0];
    }
    assert_true(before > 0.95f);
    const float dim[3] = {0.01f, 0.02f, 0.3f}, bright[3] = {10, 20, 300};
    show(color, choice, dim, out);
    assert_true(out[2] - out[0] > 0.3f);
    show(color, choice, bright, out);
    assert_true(out[2] - out[0] < 0.2f);
    ppm_color_destroy(color);
}

static void what_is_not_light_is_black(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL, NULL);
    static const char *const views[] = {"Khronos PBR Neutral", "AgX"};
    const float rgb[3] = {NAN, -1, -INFINITY};
    for (int i = 0; i < 2; i++) {
        float out[4];
        show(color, (ppmi_view_choice){.view = views[i]}, rgb, out);
        for (int c = 0; c < 3; c++)
            assert_true(out[c] >= 0.0f && out[c] < 0.01f);
    }
    ppm_color_destroy(color);
}

static void a_view_shows_the_same_from_any_working_space(void **state)
{
    (void)state;
    ppm_color *const rec709 = open_color(NULL, NULL), *const acescg = open_color(NULL, "ACEScg");
    for (uint32_t d = 0; d < ppm_color_display_count(rec709); d++) {
        const char *const display = ppm_color_display_name(rec709, d);
        for (uint32_t v = 0; v + 1 < ppm_color_view_count(rec709, display); v++) { /* not Raw */
            const ppmi_view_choice choice = {.display = display,
                                             .view = ppm_color_view_name(rec709, display, v)};
            for (int i = 0; i < COLOURS; i++) {
                float a[4], b[4];
                show(rec709, choice, colours[i], a);
                show(acescg, choice, colours[i], b);
                for (int c = 0; c < 3; c++)
                    assert_float_equal(a[c], b[c], 1e-3f * fmaxf(1, fabsf(a[c])));
            }
        }
    }
    ppm_color_destroy(rec709);
    ppm_color_destroy(acescg);
}

/* ---- displays -------------------------------------------------------------------------------- */

static void displays_follow_their_standards(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL, NULL);
    const float grey[3] = {0.5f, 0.5f, 0.5f}, red[3] = {1, 0, 0}, white[3] = {1, 1, 1};
    float out[4];
    show(color, (ppmi_view_choice){.display = "Rec.1886", .view = "Standard"}, grey, out);
    assert_float_equal(out[1], pow(0.5, 1 / 2.4), 1e-4);
    show(color, (ppmi_view_choice){.display = "Display P3", .view = "Standard"}, grey, out);
    assert_float_equal(out[1], srgb_encoded(0.5), 1e-4);
    show(color, (ppmi_view_choice){.display = "Display P3", .view = "Standard"}, red, out);
    assert_float_equal(out[0], 0.9175, 5e-4); /* CSS Color 4: color(display-p3 ...) of #f00 */
    assert_float_equal(out[1], 0.2003, 5e-4);
    assert_float_equal(out[2], 0.1386, 5e-4);
    show(color, (ppmi_view_choice){.display = "Rec.2100-PQ", .view = "Standard"}, white, out);
    assert_float_equal(out[1], 0.5081, 5e-4); /* SMPTE ST 2084: 100 of 10000 nit */
    ppm_color_destroy(color);
}

static void gamma_comes_last(void **state)
{
    (void)state;
    ppm_color *const color = open_color(NULL, NULL);
    const float rgb[3] = {0.5f, 0.1f, 0};
    float plain[4], out[4];
    show(color, (ppmi_view_choice){.view = "Standard"}, rgb, plain);
    show(color, (ppmi_view_choice){.view = "Standard", .gamma = 2}, rgb, out);
    for (int c = 0; c < 3; c++)
        assert_float_equal(out[c], sqrt((double)plain[c]), 1e-5);
    ppm_color_destroy(color);
}

/* ---- looks ----------------------------------------------------------------------------------- */

static const char config_with_looks[] =
    "ocio_profile_version: 2\n"
    "search_path: .\n"
    "roles: {scene_linear: lin_srgb, default: lin_srgb}\n"
    "file_rules:\n"
    "  - !<Rule> {name: Default, colorspace: default}\n"
    "displays:\n"
    "  screen:\n"
    "    - !<View> {name: plain, colorspace: lin_srgb}\n"
    "    - !<View> {name: doubled, colorspace: lin_srgb, looks: Double}\n"
    "looks:\n"
    "  - !<Look> {name: Double, process_space: lin_srgb, transform: !<CDLTransform> {slope: [2, 2, "
    "2]}}\n"
    "  - !<Look> {name: Triple - strong, process_space: lin_srgb, transform: !<CDLTransform> "
    "{slope: "
    "[3, 3, 3]}}\n"
    "  - !<Look> {name: Broken, process_space: lin_srgb, transform: !<FileTransform> {src: "
    "missing.cube}}\n"
    "colorspaces:\n"
    "  - !<ColorSpace> {name: lin_srgb}\n";

static void assert_error_names(const char *part)
{
    char message[1024];
    ppm_context_last_error(context, message, sizeof message);
    if (!strstr(message, part)) fail_msg("\"%s\" is not in \"%s\"", part, message);
}

static void a_look_takes_the_place_of_the_views_own(void **state)
{
    (void)state;
    scratch_write_text("looks.ocio", config_with_looks);
    ppm_color *const color = open_color(scratch_path("looks.ocio"), NULL);
    assert_int_equal(ppm_color_look_count(color), 3);
    assert_string_equal(ppm_color_look_name(color, 0), "Double");
    assert_null(ppm_color_look_name(color, 3));
    const struct {
        const char *view, *look;
        float expected;
    } cases[] = {
        {"plain", NULL, 0.1f},
        {"plain", "double", 0.2f},
        {"doubled", NULL, 0.2f},
        {"doubled", "", 0.2f},
        {"doubled", "none", 0.1f},
        {"doubled", "triple - Strong", 0.3f},
        {"plain", "Double, Triple - strong", 0.6f},
    };
    const float rgb[3] = {0.1f, 0.1f, 0.1f};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        float out[4];
        show(color, (ppmi_view_choice){.view = cases[i].view, .look = cases[i].look}, rgb, out);
        assert_float_equal(out[0], cases[i].expected, 1e-5);
    }
    ppm_color_destroy(color);
}

static void a_look_that_cannot_be_used_is_found_before(void **state)
{
    (void)state;
    scratch_write_text("looks.ocio", config_with_looks);
    ppm_color *const color = open_color(scratch_path("looks.ocio"), NULL);
    assert_int_equal(ppm_color_check_look(context, color, NULL, NULL, "Dooble"),
                     PPM_STATUS_NOT_FOUND);
    assert_error_names("did you mean \"Double\"");
    assert_int_equal(ppm_color_check_look(context, color, NULL, NULL, "Broken"),
                     PPM_STATUS_INPUT_INVALID);
    assert_error_names("missing.cube");
    assert_int_equal(ppm_color_check_look(context, color, NULL, NULL, "Double, Dooble"),
                     PPM_STATUS_INPUT_INVALID);
    assert_int_equal(ppm_color_check_look(context, color, NULL, NULL, "Double"), PPM_STATUS_OK);
    ppm_color_destroy(color);
}

/* ---- tags ------------------------------------------------------------------------------------ */

static void displays_are_known_by_their_names(void **state)
{
    (void)state;
    static const struct {
        const char *space, *display;
        uint8_t primaries, transfer; /* of H.273; 0: no tag, 255: a tag without code points */
    } cases[] = {
        {"sRGB - Display", "sRGB", 1, 13},
        {"Filmic sRGB", "sRGB", 1, 13},
        {"Rec.1886 Rec.709 - Display", "", 1, 1},
        {"Display P3 - Display", "Display P3", 12, 13},
        {"Rec.2100-PQ - Display", "", 9, 16},
        {"ST2084-P3-D65 - Display", "", 12, 16},
        {"Output - Rec.2020 ST2084 (1000 nits)", "ACES", 9, 16},
        {"Rec.2100-HLG - Display", "", 9, 18},
        {"P3-D65 - Display", "", 255, 0},
        {"Output - P3-DCI", "sRGB", 0, 0},
        {"Linear Rec.709 (sRGB)", "sRGB", 0, 0},
        {"False Color", "sRGB", 1, 13},
        {"something", "monitor", 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const ppmi_display_tag *const tag =
            ppmi_display_tag_of_names(cases[i].space, cases[i].display);
        if (cases[i].primaries == 0) {
            if (tag && cases[i].primaries == 0) {
                fail_msg("%s is taken for %s", cases[i].space, tag->name);
            }
            continue;
        }
        if (!tag) fail_msg("%s is not known", cases[i].space);
        const bool has_points = cases[i].primaries != 255;
        assert_int_equal(tag->cicp[0], has_points ? cases[i].primaries : 0);
        assert_int_equal(tag->cicp[1], cases[i].transfer);
    }
}

static uint32_t u32_at(const uint8_t *bytes, size_t offset)
{
    return (uint32_t)bytes[offset] << 24 | (uint32_t)bytes[offset + 1] << 16 |
           (uint32_t)bytes[offset + 2] << 8 | bytes[offset + 3];
}

/* The place of a tag's data; 0: there is none. */
static size_t find_tag(const uint8_t *icc, const char *signature)
{
    for (uint32_t i = 0; i < u32_at(icc, 128); i++) {
        const size_t entry = 132 + 12 * (size_t)i;
        if (memcmp(icc + entry, signature, 4) == 0) return u32_at(icc, entry + 4);
    }
    return 0;
}

static void profiles_are_whole_and_white_is_d50(void **state)
{
    (void)state;
    static const char *const names[] = {"sRGB", "Display P3", "Rec.1886", "P3-D65", "Rec.2020"};
    static const double d50[3] = {0.9642, 1.0, 0.8249};
    for (int i = 0; i < 5; i++) {
        uint8_t icc[PPMI_ICC_BYTES_MAX];
        const size_t size = ppmi_icc_write(ppmi_display_tag_of_names(names[i], NULL), icc);
        assert_true(size > 128 && size <= sizeof icc);
        assert_int_equal(u32_at(icc, 0), size);
        assert_memory_equal(icc + 36, "acsp", 4);
        for (uint32_t t = 0; t < u32_at(icc, 128); t++) {
            const size_t entry = 132 + 12 * (size_t)t;
            assert_true(u32_at(icc, entry + 4) % 4 == 0);
            assert_true(u32_at(icc, entry + 4) + u32_at(icc, entry + 8) <= size);
        }
        const size_t red = find_tag(icc, "rXYZ"), green = find_tag(icc, "gXYZ"),
                     blue = find_tag(icc, "bXYZ");
        assert_true(red && green && blue && find_tag(icc, "rTRC") && find_tag(icc, "chad"));
        for (size_t c = 0; c < 3; c++) {
            const double sum = ((double)(int32_t)u32_at(icc, red + 8 + 4 * c) +
                                (double)(int32_t)u32_at(icc, green + 8 + 4 * c) +
                                (double)(int32_t)u32_at(icc, blue + 8 + 4 * c)) /
                               65536;
            assert_float_equal(sum, d50[c], 1e-4);
        }
    }
}

/* As in the sRGB profiles of the ICC. */
static void the_colorants_of_srgb_are_the_usual_ones(void **state)
{
    (void)state;
    static const double red[3] = {0.4360, 0.2225, 0.0139};
    uint8_t icc[PPMI_ICC_BYTES_MAX];
    ppmi_icc_write(ppmi_display_tag_of_names("sRGB", NULL), icc);
    const size_t at = find_tag(icc, "rXYZ");
    for (size_t c = 0; c < 3; c++)
        assert_float_equal((double)u32_at(icc, at + 8 + 4 * c) / 65536, red[c], 3e-4);
}

static void no_profile_says_pq(void **state)
{
    (void)state;
    uint8_t icc[PPMI_ICC_BYTES_MAX];
    assert_int_equal(ppmi_icc_write(ppmi_display_tag_of_names("Rec.2100-PQ", NULL), icc), 0);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(neutral_is_the_published_formula),
        TEST(neutral_returns_base_colours),
        TEST(agx_keeps_greys_and_fades_lights_to_white),
        TEST(what_is_not_light_is_black),
        TEST(a_view_shows_the_same_from_any_working_space),
        TEST(displays_follow_their_standards),
        TEST(gamma_comes_last),
        TEST(a_look_takes_the_place_of_the_views_own),
        TEST(a_look_that_cannot_be_used_is_found_before),
        TEST(displays_are_known_by_their_names),
        TEST(profiles_are_whole_and_white_is_d50),
        TEST(the_colorants_of_srgb_are_the_usual_ones),
        TEST(no_profile_says_pq),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
