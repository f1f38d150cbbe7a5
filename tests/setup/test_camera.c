/* Cameras of a setup file, against the same by calls. */
#include <math.h>
#include <string.h>

#include "setup/setup_fixture.h"
#include "support/near.h"

#define CAMERA(words) "{ \"cameras\": [ { " words " } ] }"

static void what_does_not_go_together_is_refused(void **state)
{
    setup_fixture *f = *state;
    static const struct {
        const char *text, *expected;
    } cases[] = {
        {CAMERA("\"fov\": 40"), "no \"position\" and no \"matrix\""},
        {CAMERA("\"position\": [0, 0, 1], \"fov\": 40"), "no \"target\", \"direction\""},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 1], \"fov\": 40"), "no direction"},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 0], \"up\": [0, 0, 2], \"fov\": 40"),
         "\"up\" is zero or along"},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 0], \"direction\": [1, 0, 0]"),
         "both \"target\" and \"direction\""},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 0]"),
         "none found, expected one of \"fov\", \"focal_mm\""},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 0], \"fov\": 40, \"focal_mm\": 50"),
         "\"fov\", \"focal_mm\" found"},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 0], \"fov\": 180"),
         "cameras[0].fov: 180 found, expected a number from 0.001 to 179.9"},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 0], \"fov\": 40, "
                "\"sensor_mm\": [36, 24]"),
         "belongs to \"focal_mm\""},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 0], \"fov\": 40, \"width\": 1"),
         "orthographic camera only"},
        {CAMERA("\"position\": [0, 0, 1], \"target\": [0, 0, 0], \"fov\": 40, "
                "\"focus_distance\": 1, \"focus_node\": \"Box\""),
         "expected at most one of"},
        {CAMERA("\"kind\": \"orthographic\", \"position\": [0, 0, 1], \"target\": [0, 0, 0], "
                "\"width\": 2"),
         "needs \"width\" and \"height\""},
        {CAMERA("\"kind\": \"orthographic\", \"position\": [0, 0, 1], \"target\": [0, 0, 0], "
                "\"fov\": 2"),
         "not of an orthographic camera"},
        {CAMERA("\"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1], \"fov\": 40"),
         "expected 16 numbers"},
        {CAMERA("\"matrix\": [1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], \"fov\": 40"),
         "columns come one after the other"},
        {CAMERA("\"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "
                "\"position\": [0, 0, 0], \"fov\": 40"),
         "expected either it or them"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_refused(f, cases[i].text, cases[i].expected);
}

static void a_node_that_is_not_there_or_is_behind_cannot_be_focused_on(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(setup_apply(f, CAMERA("\"position\": [0, 0, 3], \"target\": [0, 0, 0], "
                                           "\"fov\": 40, \"focus_node\": \"Bax\"")),
                     PPM_STATUS_INPUT_INVALID);
    assert_setup_logged(f, 'E',
                        "cameras[0].focus_node: there is no node with a surface \"Bax\"; "
                        "did you mean \"Box\"?");
    assert_int_equal(setup_apply(f, CAMERA("\"position\": [0, 0, 3], \"target\": [0, 0, 9], "
                                           "\"fov\": 40, \"focus_node\": \"Box\"")),
                     PPM_STATUS_INPUT_INVALID);
    assert_setup_logged(f, 'E', "not before it");
}

/* From (0, 1, 3) to (0, 0.4, 0). */
static ppm_camera_desc looking_down(void)
{
    const double length = sqrt(0.6 * 0.6 + 3.0 * 3.0);
    const float s = (float)(0.6 / length), c = (float)(3.0 / length);
    return (ppm_camera_desc){.size = sizeof(ppm_camera_desc),
                             .transform = {1, 0, 0, 0, 0, c, -s, 0, 0, s, c, 0, 0, 1, 3, 1}};
}

static void check_against(setup_fixture *f, const ppm_camera_desc *desc)
{
    ppm_camera_id id;
    ppm_scene *other = setup_make_room(f->context);
    assert_int_equal(ppm_scene_add_camera(other, desc, &id), PPM_STATUS_OK);
    assert_int_equal(ppm_setup_camera(f->setup), 1);
    assert_same_picture(f, other, 1);
}

static void a_perspective_camera_is_that_of_the_calls(void **state)
{
    setup_fixture *f = *state;
    ppm_camera_desc desc = looking_down();
    desc.y_fov_rad = (float)(40.0 * 3.14159265358979323846 / 180.0);
    desc.shift[0] = 0.1f;
    desc.shift[1] = -0.2f;
    assert_int_equal(setup_apply(f, CAMERA("\"name\": \"A\", \"position\": [0, 1, 3], "
                                           "\"target\": [0, 0.4, 0], \"fov\": 40, "
                                           "\"shift\": [0.1, -0.2]")),
                     PPM_STATUS_OK);
    assert_string_equal(ppm_scene_camera_name(f->scene, 1), "A");
    check_against(f, &desc);
}

static void a_matrix_is_taken_as_it_is(void **state)
{
    setup_fixture *f = *state;
    ppm_camera_desc desc = {.size = sizeof desc,
                            .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.25f, 0.5f, 3, 1},
                            .y_fov_rad = (float)(30.0 * 3.14159265358979323846 / 180.0)};
    assert_int_equal(
        setup_apply(f, CAMERA("\"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.25, 0.5, 3, 1], "
                              "\"fov\": 30")),
        PPM_STATUS_OK);
    check_against(f, &desc);
}

static void an_orthographic_camera_sees_its_width_and_height(void **state)
{
    setup_fixture *f = *state;
    ppm_camera_desc desc = looking_down();
    desc.kind = PPM_CAMERA_ORTHOGRAPHIC;
    desc.half_width_m = 0.75f;
    desc.half_height_m = 0.75f;
    assert_int_equal(
        setup_apply(f, CAMERA("\"kind\": \"orthographic\", \"position\": [0, 1, 3], "
                              "\"direction\": [0, -0.6, -3], \"width\": 1.5, \"height\": 1.5")),
        PPM_STATUS_OK);
    check_against(f, &desc);
}

/* A 50 mm lens at f/2 on a sensor 18 mm wide has a diameter of 25 mm; one with the same angle on 36
 * mm has 100 mm, and f/4. */
static void focal_length_and_sensor_keep_angle_and_lens(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(setup_apply(f, CAMERA("\"position\": [0, 1, 3], \"target\": [0, 0.4, 0], "
                                           "\"focal_mm\": 50, \"sensor_mm\": [18, 12], "
                                           "\"f_number\": 2, \"focus_node\": \"Box\"")),
                     PPM_STATUS_OK);
    const ppmi_camera *camera = &f->scene->cameras[0];
    assert_near(camera->y_fov_rad, 2.0 * atan(6.0 / 50.0), 1e-6);
    assert_near(camera->aspect, 1.5, 1e-6);
    assert_near(camera->f_number, 4.0, 1e-6);
    assert_near(camera->focus_distance_m, sqrt(0.6 * 0.6 + 9.0), 1e-5);
    ppm_camera_desc desc = looking_down();
    desc.y_fov_rad = (float)(2.0 * atan(6.0 / 50.0));
    desc.aspect = 1.5f;
    desc.f_number = 4.0f;
    desc.focus_distance_m = camera->focus_distance_m;
    check_against(f, &desc);
}

static void a_camera_straight_down_has_north_above(void **state)
{
    setup_fixture *f = *state;
    float m[16];
    assert_int_equal(setup_apply(f, CAMERA("\"position\": [0, 3, 0], \"target\": [0, 0, 0], "
                                           "\"fov\": 40")),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_scene_camera_transform(f->scene, 1, m), PPM_STATUS_OK);
    assert_near(m[6], -1.0, 1e-6); /* up is -Z */
    assert_near(m[0], 1.0, 1e-6);
}

static void cameras_come_after_those_of_the_scene(void **state)
{
    setup_fixture *f = *state;
    ppm_camera_id id;
    assert_int_equal(setup_apply(f, CAMERA("\"position\": [0, 1, 3], \"target\": [0, 0, 0], "
                                           "\"fov\": 40")),
                     PPM_STATUS_OK);
    ppm_scene_destroy(f->scene);
    f->scene = setup_make_room(f->context);
    assert_int_equal(ppm_scene_add_framing_camera(f->scene, 1.0f, &id), PPM_STATUS_OK);
    assert_int_equal(ppm_setup_apply(f->setup, f->scene, PPM_SETUP_CAMERAS), PPM_STATUS_OK);
    assert_int_equal(ppm_setup_camera(f->setup), 2);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup_setup, setup_teardown)

/* Of a site whose origin is elsewhere: places are subtracted in double precision. */
static void places_count_from_the_point_0_of_the_file(void **state)
{
    setup_fixture *f = *state;
    const double origin[3] = {3133805.0, 5447441.0, -992859.0};
    ppm_scene *scene = NULL;
    assert_int_equal(setup_open(f, "{ \"cameras\": [ "
                                   "{ \"position\": [3133805.01, 5447441.25, -992859], "
                                   "\"target\": [3133805.01, 5447441.25, -992860], \"fov\": 40 }, "
                                   "{ \"matrix\": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, "
                                   "3133805, 5447441.125, -992859.02, 1], \"fov\": 40 } ] }"),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_scene_create(f->context, NULL, &scene), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_origin(scene, origin), PPM_STATUS_OK);
    assert_int_equal(ppm_setup_apply(f->setup, scene, PPM_SETUP_ALL), PPM_STATUS_OK);
    const ppmi_vec3 first = scene->cameras[0].origin, second = scene->cameras[1].origin;
    assert_near(first.x, 0.01, 1e-8);
    assert_near(first.y, 0.25, 1e-8);
    assert_near(second.y, 0.125, 1e-8);
    assert_near(second.z, -0.02, 1e-8);
    assert_near(scene->cameras[0].forward.z, -1.0, 1e-7);
    ppm_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(places_count_from_the_point_0_of_the_file),
        TEST(what_does_not_go_together_is_refused),
        TEST(a_node_that_is_not_there_or_is_behind_cannot_be_focused_on),
        TEST(a_perspective_camera_is_that_of_the_calls),
        TEST(a_matrix_is_taken_as_it_is),
        TEST(an_orthographic_camera_sees_its_width_and_height),
        TEST(focal_length_and_sensor_keep_angle_and_lens),
        TEST(a_camera_straight_down_has_north_above),
        TEST(cameras_come_after_those_of_the_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
