/* importers/gltf/ies.c: files of the IESNA LM-63 formats. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/ies.h"
#include "gltf_fixture.h"
#include "support/near.h"

#define PI 3.14159265358979323846

static ppm_status parse(gltf_fixture *f, const char *text, ppmi_ies_profile *profile,
                        const char **reason)
{
    *reason = "";
    return ppmi_ies_parse(f->context, text, strlen(text), profile, reason);
}

/* Expects a profile of these counts and first and last angles, in degrees. */
static void expect(gltf_fixture *f, const char *text, uint32_t polar, uint32_t azimuths,
                   double last_polar, double last_azimuth, double turn)
{
    ppmi_ies_profile p;
    const char *reason;
    if (parse(f, text, &p, &reason) != PPM_STATUS_OK) fail_msg("%s: %s", reason, text);
    assert_int_equal(p.polar_count, polar);
    assert_int_equal(p.azimuth_count, azimuths);
    assert_near(p.polar_rad[polar - 1] * 180 / PI, last_polar, 1e-4);
    assert_float_equal(p.azimuth_rad[0], 0.0, 0.0);
    assert_near(p.azimuth_rad[azimuths - 1] * 180 / PI, last_azimuth, 1e-4);
    assert_near(p.turn_rad * 180 / PI, turn, 1e-4);
    ppmi_ies_deinit(f->context, &p);
}

static void broken_files_are_refused_with_a_reason(void **state)
{
    gltf_fixture *f = *state;
    static const char *const rows[][2] = {
        {"", "no line begins with TILT="},
        {"IESNA:LM-63-2002\n", "no line begins with TILT="},
        {"\n\n\r\r", "no line begins with TILT="},
        {"TILT=NONE", "13 numbers"},
        {"TILT=NONE\n1 2 3", "13 numbers"},
        {"TILT=NONE\n1 x 1 2 1 1 2 0 0 0 1 1 1", "13 numbers"},
        {"TILT=NONE\n1 1 1 0 1 1 2 0 0 0 1 1 1", "numbers of angles"},
        {"TILT=NONE\n1 1 1 -2 1 1 2 0 0 0 1 1 1", "numbers of angles"},
        {"TILT=NONE\n1 1 1 1.5 1 1 2 0 0 0 1 1 1", "numbers of angles"},
        {"TILT=NONE\n1 1 1 1e9 1e9 1 2 0 0 0 1 1 1", "numbers of angles"},
        {"TILT=NONE\n1 1 1 8000 8000 1 2 0 0 0 1 1 1", "numbers of angles"},
        {"TILT=NONE\n1 1 1 2 1 4 2 0 0 0 1 1 1", "photometric type"},
        {"TILT=NONE\n1 1 -1 2 1 1 2 0 0 0 1 1 1", "multiplier"},
        {"TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 90\n0\n5", "ends within"},
        {"TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n90 0\n0\n5 5", "vertical angles"},
        {"TILT=NONE\n1 1 1 2 1 1 2 0 0 0 1 1 1\n0 181\n0\n5 5", "vertical angles"},
        {"TILT=NONE\n1 1 1 2 1 2 2 0 0 0 1 1 1\n0 91\n0\n5 5", "within -90 .. 90"},
        {"TILT=NONE\n1 1 1 1 2 1 2 0 0 0 1 1 1\n0\n0 361\n5 5", "horizontal angles"},
        {"TILT=NONE\n1 1 1 1 2 1 2 0 0 0 1 1 1\n0\n0 45\n5 5", "horizontal angles"},
        {"TILT=NONE\n1 1 1 1 2 1 2 0 0 0 1 1 1\n0\n10 180\n5 5", "horizontal angles"},
        {"TILT=NONE\n1 1 1 1 1 1 2 0 0 0 1 1 1\n0\n0\n1e40", "too large"},
        {"TILT=NONE\n1 1 1 1 1 1 2 0 0 0 1 1 1\n0\n0\n1e999", "ends within"},
        {"TILT=NONE\n1 1 1 1 1 1 2 0 0 0 1 1 1\n0\n0\nnan", "ends within"},
        {"TILT=INCLUDE\n1\n2\n0 90\n1", "TILT=INCLUDE"},
        {"TILT=INCLUDE\n1\n-2\n0 90\n1 1", "TILT=INCLUDE"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        ppmi_ies_profile p;
        const char *reason;
        assert_int_equal(parse(f, rows[i][0], &p, &reason), PPM_STATUS_INPUT_INVALID);
        if (!strstr(reason, rows[i][1])) fail_msg("row %zu: %s", i, reason);
        ppmi_ies_deinit(f->context, &p);
    }
}

/* Cut anywhere, a file is refused and nothing is read beyond its end. */
static void every_cut_of_a_file_is_refused(void **state)
{
    gltf_fixture *f = *state;
    static const char text[] = "IESNA:LM-63-1995\n[TEST] cut\nTILT=INCLUDE\n1\n2\n0 90\n1 0.8\n"
                               "1 1000 1 3 2 1 2 0 0 0 1 1 50\n0 45 90\n0 90\n9 8 7\n6 5 4";
    for (size_t count = 0; count + 1 < sizeof text - 1; ++count) {
        char *cut = malloc(count + 1);
        assert_non_null(cut);
        memcpy(cut, text, count);
        ppmi_ies_profile p;
        const char *reason;
        assert_int_equal(ppmi_ies_parse(f->context, cut, count, &p, &reason),
                         PPM_STATUS_INPUT_INVALID);
        ppmi_ies_deinit(f->context, &p);
        free(cut);
    }
    expect(f, text, 3, 2, 90, 90, 0);
}

static void all_versions_are_read(void **state)
{
    gltf_fixture *f = *state;
    static const char *const heads[] = {
        "a plain title of 1986\nTILT=NONE\n",
        "IESNA91\n[TEST]1\n[MORE]TILT=SIDEWAYS\nTILT=NONE\n",
        "IESNA:LM-63-1995\r\n[TEST] 2\r\nTILT=NONE\r\n",
        "IESNA:LM-63-2002\rTILT=NONE\r",
        "IES:LM-63-2019\n[_OWN] 4\nTILT=lamp.tlt\n",
        "IESNA:LM-63-2002\nTILT=INCLUDE\n1\n3\n0 45 90\n1 .9 .8\n",
    };
    for (size_t i = 0; i < sizeof heads / sizeof heads[0]; ++i) {
        char text[512];
        snprintf(text, sizeof text, "%s1,-1 1.0E0 +2 1 1 2 .0 0. -0 1 1 5e1\n0\t90\n0\n10,\n 5",
                 heads[i]);
        expect(f, text, 2, 1, 90, 0, 0);
    }
}

static void type_c_is_kept_with_its_mirror_planes(void **state)
{
    gltf_fixture *f = *state;
#define C(counts, angles) "TILT=NONE\n1 -1 1 " counts " 1 2 0 0 0 1 1 1\n" angles
    expect(f, C("2 1", "0 90\n0\n1 2"), 2, 1, 90, 0, 0);
    expect(f, C("2 1", "90 180\n0\n1 2"), 2, 1, 180, 0, 0);
    expect(f, C("2 3", "0 180\n0 45 90\n1 2 3 4 5 6"), 2, 3, 180, 90, 0);
    expect(f, C("2 2", "0 180\n0 180\n1 2 3 4"), 2, 2, 180, 180, 0);
    expect(f, C("1 3", "0\n0 180 360\n1 2 1"), 1, 3, 0, 360, 0);
    expect(f, C("1 4", "0\n0 90 180 270\n1 2 3 4"), 1, 5, 0, 360, 0); /* closed */
    expect(f, C("1 3", "0\n90 180 270\n1 2 3"), 1, 3, 0, 180, 90);
#undef C
}

static void multipliers_apply_to_the_candela(void **state)
{
    gltf_fixture *f = *state;
    ppmi_ies_profile p;
    const char *reason;
    assert_int_equal(
        parse(f, "TILT=NONE\n1 -1 2 2 1 1 2 0 0 0 .5 3 1\n0 90\n0\n10 -5", &p, &reason),
        PPM_STATUS_OK);
    assert_float_equal(p.candela[0], 30.0f, 1e-5f);
    assert_float_equal(p.candela[1], 0.0f, 0.0f); /* noise below 0 */
    ppmi_ies_deinit(f->context, &p);
}

/* The flux of the resampled profile, by the same rule as it is looked up: midpoints. */
static double flux(const ppmi_ies_profile *p)
{
    double sum = 0.0;
    for (uint32_t k = 0; k + 1 < p->azimuth_count; ++k) {
        for (uint32_t i = 0; i + 1 < p->polar_count; ++i) {
            const float *row = p->candela + (size_t)k * p->polar_count + i;
            const double mean =
                0.25 * (row[0] + row[1] + row[p->polar_count] + row[p->polar_count + 1]);
            sum += mean * (cos(p->polar_rad[i]) - cos(p->polar_rad[i + 1])) *
                   (p->azimuth_rad[k + 1] - p->azimuth_rad[k]);
        }
    }
    return sum;
}

/* A profile of 1 within +-v and +-h degrees fills a known part of the sphere: for type A 2 h sin v
 * twice over, for type B the same with the angles' parts exchanged. */
static void types_a_and_b_keep_their_flux_and_sides(void **state)
{
    gltf_fixture *f = *state;
    for (int type = 2; type <= 3; ++type) {
        char text[256];
        ppmi_ies_profile p;
        const char *reason;
        snprintf(text, sizeof text,
                 "TILT=NONE\n1 -1 1 2 2 %d 2 0 0 0 1 1 1\n-20 20\n-50 50\n7 7 7 7", type);
        assert_int_equal(parse(f, text, &p, &reason), PPM_STATUS_OK);
        const double v = 20 * PI / 180, h = 50 * PI / 180;
        const double solid_angle = type == 3 ? 4 * h * sin(v) : 4 * v * sin(h);
        assert_near(flux(&p) / (7 * solid_angle), 1.0, 0.02);
        /* vertical along X, horizontal along Y: 30 degrees off the axis */
        const uint32_t off = 60, along_x = 0, along_y = 30;
        assert_float_equal(p.candela[along_x * p.polar_count + off], 0.0f, 0.0f);
        assert_float_equal(p.candela[along_y * p.polar_count + off], 7.0f, 1e-4f);
        ppmi_ies_deinit(f->context, &p);
    }
}

/* Horizontal angles are clockwise: positive ones lie towards -Y. One side stands for both. */
static void horizontal_angles_of_types_a_and_b_run_clockwise(void **state)
{
    gltf_fixture *f = *state;
    ppmi_ies_profile p;
    const char *reason;
    assert_int_equal(
        parse(f, "TILT=NONE\n1 -1 1 2 3 3 2 0 0 0 1 1 1\n0 90\n-90 0 90\n0 0 0 0 9 9", &p, &reason),
        PPM_STATUS_OK);
    const uint32_t off = 60, plus_y = 30, minus_y = 90;
    assert_float_equal(p.candela[plus_y * p.polar_count + off], 0.0f, 1e-4f);
    assert_float_equal(p.candela[minus_y * p.polar_count + off], 3.0f, 1e-3f);
    ppmi_ies_deinit(f->context, &p);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(broken_files_are_refused_with_a_reason),
        TEST(every_cut_of_a_file_is_refused),
        TEST(all_versions_are_read),
        TEST(type_c_is_kept_with_its_mirror_planes),
        TEST(multipliers_apply_to_the_candela),
        TEST(types_a_and_b_keep_their_flux_and_sides),
        TEST(horizontal_angles_of_types_a_and_b_run_clockwise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
