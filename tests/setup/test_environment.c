/* Surroundings and fog of a setup file, against the same by calls. */
#include <string.h>

#include "setup/setup_fixture.h"
#include "support/near.h"

#define DEGREES (3.14159265358979323846 / 180.0)
#define ENVIRONMENT(words) "{ \"environment\": { " words " } }"

static void what_does_not_go_together_is_refused(void **state)
{
    setup_fixture *f = *state;
    setup_write_picture(f, "inner/sky.hdr");
    assert_refused(f, ENVIRONMENT(""), "environment: it is empty");
    assert_refused(f, ENVIRONMENT("\"color\": 1, \"rotation\": 2"),
                   "\"rotation\": of an \"image\"");
    assert_refused(f, ENVIRONMENT("\"sun_sky\": { \"elevation\": 20 }"), "\"azimuth\"");
    assert_refused(f, ENVIRONMENT("\"sun_sky\": { \"elevation\": 91, \"azimuth\": 0 }"),
                   "environment.sun_sky.elevation: 91 found");
    assert_refused(f,
                   ENVIRONMENT("\"color\": 1, \"sun_sky\": { \"elevation\": 20, \"azimuth\": 0 }"),
                   "has its own");
    assert_refused(f, ENVIRONMENT("\"image\": \"sky.hdr\", \"rotation\": 400"), "rotation: 400");
    assert_refused(f, "{ \"fog\": { \"g\": 1 } }", "fog.g: 1 found");
}

static void an_image_that_is_none_is_told_as_it_is_applied(void **state)
{
    setup_fixture *f = *state;
    setup_write(f, "inner/sky.hdr", "no picture");
    assert_int_equal(setup_apply(f, ENVIRONMENT("\"image\": \"sky.hdr\"")),
                     PPM_STATUS_INPUT_INVALID);
    assert_setup_logged(f, 'E', "environment.image: \"sky.hdr\"");
}

/* A room with a camera that sees the surroundings too. */
static ppm_scene *other_room(setup_fixture *f)
{
    return setup_make_room(f->context);
}

static void compare(setup_fixture *f, ppm_scene *other)
{
    ppm_camera_id id;
    const ppm_camera_desc desc = {.size = sizeof desc,
                                  .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.8f, 3, 1},
                                  .y_fov_rad = 1.4f};
    assert_int_equal(ppm_scene_add_camera(f->scene, &desc, &id), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_camera(other, &desc, &id), PPM_STATUS_OK);
    assert_same_picture(f, other, 1);
}

static void a_colour_and_a_backdrop_are_those_of_the_calls(void **state)
{
    setup_fixture *f = *state;
    const ppm_environment_desc desc = {.size = sizeof desc,
                                       .radiance = {1.0f, 2.0f, 0.5f},
                                       .has_backdrop = 1,
                                       .backdrop = {0.25f, 0.25f, 0.25f}};
    ppm_scene *other = other_room(f);
    assert_int_equal(setup_apply(f, ENVIRONMENT("\"color\": [1, 2, 0.5], \"backdrop\": 0.25")),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_environment(other, &desc), PPM_STATUS_OK);
    compare(f, other);
}

static void a_picture_is_turned_and_multiplied(void **state)
{
    setup_fixture *f = *state;
    setup_write_picture(f, "inner/sky.hdr");
    ppm_scene *other = other_room(f);
    const ppm_image_desc image = {
        .size = sizeof image, .role = PPM_IMAGE_COLOR, .path = setup_path(f, "inner/sky.hdr")};
    ppm_environment_desc desc = {.size = sizeof desc,
                                 .radiance = {3.0f, 3.0f, 1.5f},
                                 .rotation_rad = (float)(70.0 * DEGREES)};
    assert_int_equal(ppm_scene_add_image(other, &image, &desc.image), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_environment(other, &desc), PPM_STATUS_OK);
    assert_int_equal(setup_apply(f, ENVIRONMENT("\"image\": \"sky.hdr\", \"rotation\": 70, "
                                                "\"intensity\": 3, \"color\": [1, 1, 0.5]")),
                     PPM_STATUS_OK);
    compare(f, other);
}

static void sun_and_sky_are_those_of_the_calls(void **state)
{
    setup_fixture *f = *state;
    ppm_sun_sky_desc desc;
    ppm_scene *other = other_room(f);
    ppm_sun_sky_desc_init(&desc);
    desc.elevation_rad = (float)(30.0 * DEGREES);
    desc.azimuth_rad = (float)(-100.0 * DEGREES);
    desc.turbidity = 5.0f;
    desc.factor = 0.001f;
    desc.ground_albedo = 0.5f;
    assert_int_equal(ppm_scene_add_sun_sky(other, &desc, NULL), PPM_STATUS_OK);
    assert_int_equal(
        setup_apply(f, ENVIRONMENT("\"sun_sky\": { \"elevation\": 30, \"azimuth\": -100, "
                                   "\"turbidity\": 5, \"intensity\": 0.001, "
                                   "\"ground_albedo\": 0.5 }")),
        PPM_STATUS_OK);
    compare(f, other);
}

static void a_backdrop_alone_leaves_the_surroundings(void **state)
{
    setup_fixture *f = *state;
    const ppm_environment_desc before = {.size = sizeof before, .radiance = {1.0f, 2.0f, 3.0f}};
    ppm_environment_desc after = {.size = sizeof after};
    f->scene = setup_make_room(f->context);
    assert_int_equal(ppm_scene_set_environment(f->scene, &before), PPM_STATUS_OK);
    assert_int_equal(setup_open(f, ENVIRONMENT("\"backdrop\": 0.5")), PPM_STATUS_OK);
    assert_int_equal(ppm_setup_apply(f->setup, f->scene, PPM_SETUP_ALL), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_get_environment(f->scene, &after), PPM_STATUS_OK);
    assert_near(after.radiance[2], 3.0, 0.0);
    assert_int_equal(after.has_backdrop, 1);
    assert_near(after.backdrop[0], 0.5, 0.0);
}

static void fog_is_that_of_the_calls(void **state)
{
    setup_fixture *f = *state;
    const ppm_fog_desc desc = {.size = sizeof desc,
                               .sigma_s = {0.25f, 0.25f, 0.25f},
                               .sigma_a = {0.0f, 0.125f, 0.25f},
                               .asymmetry_g = 0.5f};
    ppm_scene *other = other_room(f);
    assert_int_equal(setup_apply(f, "{ \"fog\": { \"sigma_s\": 0.25, "
                                    "\"sigma_a\": [0, 0.125, 0.25], \"g\": 0.5 } }"),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_fog(other, &desc), PPM_STATUS_OK);
    compare(f, other);
}

static void parts_that_are_not_asked_for_are_left_out(void **state)
{
    setup_fixture *f = *state;
    ppm_environment_desc after = {.size = sizeof after};
    f->scene = setup_make_room(f->context);
    assert_int_equal(setup_open(f, "{ \"environment\": { \"color\": 1 }, \"fog\": { "
                                   "\"sigma_s\": 1 } }"),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_setup_apply(f->setup, f->scene, PPM_SETUP_ALL & ~PPM_SETUP_ENVIRONMENT),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_scene_get_environment(f->scene, &after), PPM_STATUS_OK);
    assert_near(after.radiance[0], 0.0, 0.0);
    assert_near(f->scene->fog.sigma_s.x, 1.0, 0.0);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup_setup, setup_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_does_not_go_together_is_refused),
        TEST(an_image_that_is_none_is_told_as_it_is_applied),
        TEST(a_colour_and_a_backdrop_are_those_of_the_calls),
        TEST(a_picture_is_turned_and_multiplied),
        TEST(sun_and_sky_are_those_of_the_calls),
        TEST(a_backdrop_alone_leaves_the_surroundings),
        TEST(fog_is_that_of_the_calls),
        TEST(parts_that_are_not_asked_for_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
