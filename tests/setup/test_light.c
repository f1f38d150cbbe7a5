/* Lights of a setup file: units, shapes and places against the same by calls; black bodies. */
#include <math.h>
#include <string.h>

#include "setup/setup_file.h"
#include "setup/setup_fixture.h"
#include "support/near.h"

#define PI 3.14159265358979323846
#define LIGHT(words) "{ \"lights\": [ { " words " } ] }"
#define HIGH "\"position\": [0.5, 2, 1]"
#define DOWN HIGH ", \"direction\": [0, -1, 0]"

static const char profile[] = "IESNA:LM-63-2002\n[TEST] x\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n"
                              "1 1 100\n0 45 90\n0\n100 50 10\n";

static void what_does_not_go_together_is_refused(void **state)
{
    setup_fixture *f = *state;
    static const struct {
        const char *text, *expected;
    } cases[] = {
        {LIGHT(HIGH ", \"candela\": 1"), "no \"kind\""},
        {LIGHT("\"kind\": \"point\", " HIGH), "none found, expected one of \"candela\""},
        {LIGHT("\"kind\": \"point\", " HIGH ", \"candela\": 1, \"lumen\": 1"),
         "\"candela\", \"lumen\" found, expected one"},
        {LIGHT("\"kind\": \"point\", \"candela\": 1"), "no \"position\""},
        {LIGHT("\"kind\": \"point\", " HIGH ", \"nit\": 1"), "\"nit\": not of a point light"},
        {LIGHT("\"kind\": \"point\", " HIGH ", \"candela\": -1"), "candela: -1 found"},
        {LIGHT("\"kind\": \"point\", " HIGH ", \"candela\": 1, \"kelvin\": 100"),
         "kelvin: 100 found, expected a number from 800 to 40000"},
        {LIGHT("\"kind\": \"point\", " HIGH ", \"candela\": 1, \"width\": 1"), "\"width\": not of"},
        {LIGHT("\"kind\": \"point\", " HIGH ", \"factor\": 1"), "multiplies a \"profile\""},
        {LIGHT("\"kind\": \"spot\", " HIGH ", \"candela\": 1"), "no \"target\", \"direction\""},
        {LIGHT("\"kind\": \"spot\", " DOWN ", \"candela\": 1, \"inner_cone\": 50"),
         "inner_cone 50 is wider than outer_cone 45"},
        {LIGHT("\"kind\": \"spot\", " DOWN ", \"candela\": 1, \"outer_cone\": 91"),
         "outer_cone: 91 found"},
        {LIGHT("\"kind\": \"sun\", \"direction\": [0, -1, 0], \"candela\": 1"), "not of a sun"},
        {LIGHT("\"kind\": \"sun\", \"elevation\": 40, \"lux\": 1"), "go together"},
        {LIGHT("\"kind\": \"sun\", \"elevation\": 40, \"azimuth\": 9, "
               "\"direction\": [0, -1, 0], \"lux\": 1"),
         "in place of \"direction\""},
        {LIGHT("\"kind\": \"rectangle\", " DOWN ", \"nit\": 1, \"width\": 1"),
         "\"width\" and \"height\" expected"},
        {LIGHT("\"kind\": \"disk\", " DOWN ", \"nit\": 1, \"width\": 1, \"height\": 1, "
               "\"radius\": 1"),
         "a disk has either"},
        {LIGHT("\"kind\": \"disk\", " DOWN ", \"nit\": 1, \"radius\": 0"), "a disk has either"},
        {LIGHT("\"kind\": \"rectangle\", " DOWN ", \"watt\": 1e12, \"color\": 1e6, "
               "\"width\": 1e-6, \"height\": 1e-6"),
         "too large"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_refused(f, cases[i].text, cases[i].expected);
}

static void a_profile_that_is_none_is_refused(void **state)
{
    setup_fixture *f = *state;
    setup_write(f, "inner/a.ies", "no profile");
    setup_write(f, "inner/b.ies", "");
    assert_refused(f, LIGHT("\"kind\": \"point\", " HIGH ", \"profile\": \"a.ies\""),
                   "lights[0].profile: \"a.ies\" is no IES profile");
    assert_refused(f, LIGHT("\"kind\": \"point\", " HIGH ", \"profile\": \"b.ies\""), "is empty");
    assert_refused(f,
                   LIGHT("\"kind\": \"point\", " HIGH ", \"profile\": \"a.ies\", \"candela\": 1"),
                   "the profile has the candela");
}

/* Adds the light by calls to a room, with a camera, and compares. */
static void check(setup_fixture *f, const char *text, const ppm_light_desc *by_calls)
{
    ppm_light_id id;
    ppm_camera_id camera;
    ppm_light_desc desc = *by_calls;
    ppm_scene *other = setup_make_room(f->context);
    desc.size = sizeof desc;
    if (setup_apply(f, text) != PPM_STATUS_OK) fail_msg("%s\n%s", text, f->log);
    assert_int_equal(ppm_scene_add_light(other, &desc, &id), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_framing_camera(f->scene, 1.0f, &camera), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_framing_camera(other, 1.0f, &camera), PPM_STATUS_OK);
    assert_same_picture(f, other, 1);
}

/* At (0.5, 2, 1), shining down, up in the picture being north. */
#define DOWNWARDS                                                                                  \
    {                                                                                              \
        1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0.5f, 2, 1, 1                                         \
    }

static void a_point_is_that_of_the_calls(void **state)
{
    setup_fixture *f = *state;
    const ppm_light_desc desc = {.kind = PPM_LIGHT_POINT,
                                 .transform = DOWNWARDS,
                                 .intensity = {2.0f, 4.0f, 8.0f},
                                 .radius_m = 0.25f,
                                 .is_hidden = 1};
    check(f,
          LIGHT("\"kind\": \"point\", " DOWN ", \"candela\": 4, \"color\": [0.5, 1, 2], "
                "\"radius\": 0.25, \"visible\": false"),
          &desc);
}

static void a_spot_is_that_of_the_calls(void **state)
{
    setup_fixture *f = *state;
    const ppm_light_desc desc = {.kind = PPM_LIGHT_SPOT,
                                 .transform = DOWNWARDS,
                                 .intensity = {4.0f, 4.0f, 4.0f},
                                 .inner_cone_rad = (float)(20.0 * PI / 180.0),
                                 .outer_cone_rad = (float)(30.0 * PI / 180.0)};
    check(f,
          LIGHT("\"kind\": \"spot\", " HIGH ", \"target\": [0.5, 0, 1], \"candela\": 4, "
                "\"inner_cone\": 20, \"outer_cone\": 30"),
          &desc);
}

static void a_rectangle_and_a_disk_are_those_of_the_calls(void **state)
{
    setup_fixture *f = *state;
    ppm_light_desc desc = {.kind = PPM_LIGHT_RECTANGLE,
                           .transform = DOWNWARDS,
                           .intensity = {4.0f, 4.0f, 4.0f},
                           .width_m = 0.5f,
                           .height_m = 0.25f};
    check(f,
          LIGHT("\"kind\": \"rectangle\", " DOWN ", \"nit\": 4, \"width\": 0.5, \"height\": 0.25"),
          &desc);
    desc.kind = PPM_LIGHT_DISK;
    desc.height_m = 0.5f;
    check(f, LIGHT("\"kind\": \"disk\", " DOWN ", \"nit\": 4, \"radius\": 0.25"), &desc);
}

static void a_sun_is_that_of_the_calls(void **state)
{
    setup_fixture *f = *state;
    const ppm_light_desc desc = {.kind = PPM_LIGHT_DIRECTIONAL,
                                 .transform = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1},
                                 .intensity = {4.0f, 4.0f, 4.0f},
                                 .angular_radius_rad = (float)(PI / 180.0)};
    check(f,
          LIGHT("\"kind\": \"sun\", \"direction\": [0, -1, 0], \"lux\": 4, "
                "\"angular_diameter\": 2"),
          &desc);
}

static void a_sun_by_angles_stands_where_sun_and_sky_put_it(void **state)
{
    setup_fixture *f = *state;
    ppm_sun_sky_desc desc;
    ppm_light_id id;
    ppm_sun_sky_desc_init(&desc);
    desc.elevation_rad = (float)(35.0 * PI / 180.0);
    desc.azimuth_rad = (float)(110.0 * PI / 180.0);
    desc.sun_only = 1;
    assert_int_equal(
        setup_apply(f, LIGHT("\"kind\": \"sun\", \"elevation\": 35, \"azimuth\": 110, \"lux\": 1")),
        PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_sun_sky(f->scene, &desc, &id), PPM_STATUS_OK);
    const ppmi_vec3 a = f->scene->punctuals[0].direction, b = f->scene->punctuals[1].direction;
    assert_near(vec3_dot(a, b), 1.0, 1e-6);
}

static void a_profile_hangs_down_and_is_multiplied(void **state)
{
    setup_fixture *f = *state;
    setup_write(f, "inner/a.ies", profile);
    assert_int_equal(setup_apply(f, LIGHT("\"kind\": \"point\", " HIGH ", \"profile\": \"a.ies\", "
                                          "\"factor\": 2, \"color\": [1, 0.5, 1]")),
                     PPM_STATUS_OK);
    const ppmi_punctual *light = &f->scene->punctuals[0];
    assert_int_equal(light->profile, 1);
    assert_near(light->direction.y, -1.0, 1e-6);
    assert_near(light->intensity.x, 2.0, 1e-6);
    assert_near(light->intensity.y, 1.0, 1e-6);
    assert_near(f->scene->profiles[0].candela[0], 100.0, 1e-3);
}

/* ---- units ----------------------------------------------------------------------------------- */

static double green_of(setup_fixture *f, const char *text)
{
    if (setup_apply(f, text) != PPM_STATUS_OK) fail_msg("%s\n%s", text, f->log);
    return f->scene->punctuals[0].intensity.y;
}

/* The spot's flux is the integral of its intensity over the sphere, summed here ring by ring. */
static double spot_lumens(double candela, double inner, double outer)
{
    const double ci = cos(inner * PI / 180.0), co = cos(outer * PI / 180.0);
    const int rings = 100000;
    double sum = 0.0;
    for (int i = 0; i < rings; i++) {
        const double cosine = 1.0 - (i + 0.5) / rings * (1.0 - co);
        const double ramp = fmin(fmax((cosine - co) / (ci - co), 0.0), 1.0);
        sum += ramp * ramp * (1.0 - co) / rings;
    }
    return candela * 2.0 * PI * sum;
}

static void lumens_and_watts_are_the_flux_of_the_light(void **state)
{
    setup_fixture *f = *state;
    const double point = green_of(f, LIGHT("\"kind\": \"point\", " HIGH ", \"lumen\": 100"));
    assert_near(point * 4.0 * PI, 100.0, 1e-4);
    const double watts = green_of(f, LIGHT("\"kind\": \"point\", " HIGH ", \"watt\": 2"));
    assert_near(watts * 4.0 * PI, 2.0 * 683.0, 1e-3);
    const double spot = green_of(f, LIGHT("\"kind\": \"spot\", " DOWN ", \"lumen\": 100, "
                                          "\"inner_cone\": 10, \"outer_cone\": 40"));
    assert_near(spot_lumens(spot, 10.0, 40.0), 100.0, 1e-3);
    const double flat = green_of(f, LIGHT("\"kind\": \"rectangle\", " DOWN ", \"lumen\": 100, "
                                          "\"width\": 0.5, \"height\": 2"));
    assert_near(flat * PI * 1.0, 100.0, 1e-4);
    const double disk = green_of(f, LIGHT("\"kind\": \"disk\", " DOWN ", \"lumen\": 100, "
                                          "\"radius\": 0.5"));
    assert_near(disk * PI * PI * 0.25, 100.0, 1e-4);
    const double straight = green_of(f, LIGHT("\"kind\": \"disk\", " DOWN ", \"candela\": 100, "
                                              "\"radius\": 0.5"));
    assert_near(straight * PI * 0.25, 100.0, 1e-4);
}

static void a_temperature_changes_the_colour_and_not_the_luminance(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(
        setup_apply(f, LIGHT("\"kind\": \"point\", " HIGH ", \"candela\": 10, \"kelvin\": 2700")),
        PPM_STATUS_OK);
    const ppmi_vec3 i = f->scene->punctuals[0].intensity;
    assert_near(0.2126 * i.x + 0.7152 * i.y + 0.0722 * i.z, 10.0, 1e-4);
    assert_true(i.x > i.y && i.y > i.z);
}

/* Chromaticities of the Planckian locus: CIE illuminant A (2856 K by its definition) is at 0.44757
 * 0.40745 (CIE 15:2004); 6500 K at 0.3135 0.3237 and 10000 K at 0.2807 0.2884 (Wyszecki and Stiles
 * 1982, table 1(3.11)). The fits of the observer are good to about 0.005 there. */
static void black_bodies_have_the_published_chromaticities(void **state)
{
    (void)state;
    static const struct {
        double kelvin, x, y;
    } cases[] = {{2856.0, 0.44757, 0.40745}, {6500.0, 0.3135, 0.3237}, {10000.0, 0.2807, 0.2884}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double c[3];
        ppmi_setup_black_body(cases[i].kelvin, c);
        const double x = 0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2];
        const double y = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        const double z = 0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2];
        assert_near(x / (x + y + z), cases[i].x, 0.006);
        assert_near(y / (x + y + z), cases[i].y, 0.006);
        assert_near(y, 1.0, 1e-4);
    }
}

static void the_coolest_black_body_has_no_negative_blue(void **state)
{
    (void)state;
    double c[3];
    ppmi_setup_black_body(800.0, c);
    assert_true(c[0] > 1.0 && c[1] >= 0.0 && c[2] == 0.0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup_setup, setup_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_does_not_go_together_is_refused),
        TEST(a_profile_that_is_none_is_refused),
        TEST(a_point_is_that_of_the_calls),
        TEST(a_spot_is_that_of_the_calls),
        TEST(a_rectangle_and_a_disk_are_those_of_the_calls),
        TEST(a_sun_is_that_of_the_calls),
        TEST(a_sun_by_angles_stands_where_sun_and_sky_put_it),
        TEST(a_profile_hangs_down_and_is_multiplied),
        TEST(lumens_and_watts_are_the_flux_of_the_light),
        TEST(a_temperature_changes_the_colour_and_not_the_luminance),
        TEST(black_bodies_have_the_published_chromaticities),
        TEST(the_coolest_black_body_has_no_negative_blue),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
