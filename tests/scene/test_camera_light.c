/* Cameras and punctual lights: what is refused, scale in transforms, the framing camera. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/scenes.h"

static test_scene test;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static const ppm_camera_desc good_camera = {
    .size = sizeof good_camera,
    .y_fov_rad = 1.0f,
    .transform = {3, 0, 0, 0, 0, 0.1f, 0, 0, 0, 0, 20, 0, 1, 2, 3, 1}};

static void assert_camera_refused(ppm_camera_desc desc)
{
    ppm_camera_id id = 77;
    assert_int_equal(ppm_scene_add_camera(test.scene, &desc, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(id, 77);
}

static void cameras_out_of_range_are_refused(void **state)
{
    (void)state;
    ppm_camera_desc bad = good_camera;
    const float angles[] = {0.0f, -1.0f, 3.2f, NAN};
    for (int i = 0; i < 4; i++) {
        bad.y_fov_rad = angles[i];
        assert_camera_refused(bad);
    }
    bad = good_camera;
    bad.kind = 2;
    assert_camera_refused(bad);
    bad = good_camera;
    bad.kind = PPM_CAMERA_ORTHOGRAPHIC;
    assert_camera_refused(bad);
    bad = good_camera;
    bad.transform[12] = NAN;
    assert_camera_refused(bad);
    bad = good_camera;
    bad.transform[10] = 0.0f;
    assert_camera_refused(bad);
}

static void scale_in_a_camera_transform_is_ignored(void **state)
{
    (void)state;
    ppm_camera_id id;
    assert_int_equal(ppm_scene_add_camera(test.scene, &good_camera, &id), PPM_STATUS_OK);
    const ppmi_camera *camera = &test.scene->cameras[id - 1];
    assert_near(camera->right.x, 1.0, 1e-6);
    assert_near(camera->up.y, 1.0, 1e-6);
    assert_near(camera->forward.z, -1.0, 1e-6);
    assert_near(camera->origin.y, 2.0, 0.0);
    assert_string_equal(ppm_scene_camera_name(test.scene, id), "");
    assert_null(ppm_scene_camera_name(test.scene, id + 1));
    assert_null(ppm_scene_camera_name(test.scene, 0));
}

static void lights_out_of_range_are_refused(void **state)
{
    (void)state;
    const ppm_light_desc good = {.size = sizeof good,
                                 .kind = PPM_LIGHT_SPOT,
                                 .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                 .intensity = {1, 1, 1},
                                 .inner_cone_rad = 0.1f,
                                 .outer_cone_rad = 0.2f};
    ppm_light_desc bad[9];
    for (int i = 0; i < 9; i++)
        bad[i] = good;
    bad[0].kind = 3;
    bad[1].intensity[0] = NAN;
    bad[2].intensity[1] = -1.0f;
    bad[3].inner_cone_rad = 0.3f; /* wider than the outer */
    bad[4].outer_cone_rad = 1.8f;
    bad[5].inner_cone_rad = NAN;
    bad[6].outer_cone_rad = 0.0f;
    bad[7].transform[14] = INFINITY;
    bad[8].transform[8] = bad[8].transform[9] = bad[8].transform[10] = 0.0f;
    ppm_light_id id = 77;
    for (int i = 0; i < 9; i++) {
        assert_int_equal(ppm_scene_add_light(test.scene, &bad[i], &id),
                         PPM_STATUS_INVALID_ARGUMENT);
    }
    assert_int_equal(id, 77);
    assert_int_equal(ppm_scene_add_light(test.scene, &good, &id), PPM_STATUS_OK);
    assert_near(test.scene->punctuals[0].direction.z, -1.0, 0.0);
}

static void the_size_of_a_directional_light_is_checked(void **state)
{
    (void)state;
    const ppm_light_desc good = {.size = sizeof good,
                                 .kind = PPM_LIGHT_DIRECTIONAL,
                                 .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                 .intensity = {1, 1, 1},
                                 .angular_radius_rad = 0.1f};
    const float bad[] = {-0.1f, NAN, INFINITY, 1.5708f};
    ppm_light_desc desc = good;
    ppm_light_id id = 77;
    for (int i = 0; i < 4; i++) {
        desc.angular_radius_rad = bad[i];
        assert_int_equal(ppm_scene_add_light(test.scene, &desc, &id), PPM_STATUS_INVALID_ARGUMENT);
    }
    assert_int_equal(id, 77);
    assert_int_equal(ppm_scene_add_light(test.scene, &good, &id), PPM_STATUS_OK);
    assert_near(test.scene->punctuals[id - 1].angular_radius_rad, 0.1, 1e-7);
    desc.angular_radius_rad = 5e-5f; /* parallel light */
    assert_int_equal(ppm_scene_add_light(test.scene, &desc, &id), PPM_STATUS_OK);
    assert_near(test.scene->punctuals[id - 1].angular_radius_rad, 0.0, 0.0);
    desc.kind = PPM_LIGHT_POINT; /* has none */
    desc.angular_radius_rad = 0.1f;
    assert_int_equal(ppm_scene_add_light(test.scene, &desc, &id), PPM_STATUS_OK);
    assert_near(test.scene->punctuals[id - 1].angular_radius_rad, 0.0, 0.0);
}

static void framing_needs_an_aspect(void **state)
{
    (void)state;
    ppm_camera_id id = 77;
    shape_place(test.scene, shape_box(test.scene, 0, vec3_splat(0.0f), vec3_splat(1.0f), 1, false));
    assert_int_equal(ppm_scene_add_framing_camera(test.scene, 0.0f, &id),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_add_framing_camera(test.scene, NAN, &id),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(id, 77);
}

/* Where the framing camera stands, which says how large the scene is to it. */
static ppmi_vec3 framed_from(void)
{
    ppm_camera_id id = 0;
    assert_int_equal(ppm_scene_add_framing_camera(test.scene, 1.0f, &id), PPM_STATUS_OK);
    return test.scene->cameras[id - 1].origin;
}

static void where_nothing_is_visible_the_hidden_is_framed(void **state)
{
    (void)state;
    const ppmi_vec3 empty = framed_from(); /* of the cube -1 .. 1 */
    const ppm_mesh_id box = shape_box(test.scene, 0, vec3_splat(-1.0f), vec3_splat(1.0f), 1, false);
    shape_place(test.scene, box);
    assert_near(vec3_length(vec3_sub(framed_from(), empty)), 0.0, 1e-6);
    assert_int_equal(ppm_scene_set_instance_visible(test.scene, 1, 0), PPM_STATUS_OK);
    assert_near(vec3_length(vec3_sub(framed_from(), empty)), 0.0, 1e-6);
    shape_place_at(test.scene, box, vec3(5.0f, 0.0f, 0.0f));
    assert_near(framed_from().x, 5.0f + empty.x, 1e-5);
}

/* Where a point is in the picture, -1..1 each way where it is seen. */
static void project(const ppmi_camera *camera, float aspect, ppmi_vec3 p, double *x, double *y)
{
    const ppmi_vec3 d = vec3_sub(p, camera->origin);
    const double depth = (double)vec3_dot(d, camera->forward);
    assert_true(depth > 0.0);
    const double tan_y = tan(0.5 * (double)camera->y_fov_rad);
    *x = (double)vec3_dot(d, camera->right) / (depth * tan_y * (double)aspect);
    *y = (double)vec3_dot(d, camera->up) / (depth * tan_y);
}

/* All corners are seen, and the box fills the picture one way. */
static void assert_framed(ppmi_vec3 low, ppmi_vec3 high, float aspect)
{
    scene_open(&test);
    shape_place(test.scene, shape_box(test.scene, 0, low, high, 1, false));
    ppm_camera_id id;
    assert_int_equal(ppm_scene_add_framing_camera(test.scene, aspect, &id), PPM_STATUS_OK);
    const ppmi_camera *camera = &test.scene->cameras[id - 1];
    double widest = 0.0;
    for (int i = 0; i < 8; i++) {
        double x, y;
        project(camera, aspect,
                vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z), &x,
                &y);
        assert_true(fabs(x) < 1.0 && fabs(y) < 1.0);
        widest = fmax(widest, fmax(fabs(x), fabs(y)));
    }
    assert_true(widest > 0.8);
    scene_close(&test);
}

static void a_camera_tells_where_it_stands(void **state)
{
    (void)state;
    float transform[16] = {0};
    assert_int_equal(ppm_scene_camera_transform(test.scene, 1, transform),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_camera_transform(NULL, 1, transform), PPM_STATUS_INVALID_ARGUMENT);
    ppm_camera_id id;
    assert_int_equal(ppm_scene_add_camera(test.scene, &good_camera, &id), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_camera_transform(test.scene, id, NULL), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_camera_transform(test.scene, id, transform), PPM_STATUS_OK);
    const float expected[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}; /* no scale */
    for (int i = 0; i < 16; i++)
        assert_near(transform[i], expected[i], 1e-6);
}

static void the_framing_camera_sees_all_corners(void **state)
{
    (void)state;
    const float aspects[] = {0.3f, 1.0f, 16.0f / 9.0f, 4.0f};
    for (int i = 0; i < 4; i++) {
        assert_framed(vec3(0, 0, 0), vec3(1, 1, 1), aspects[i]);
        assert_framed(vec3(-1e-3f, 0, 0), vec3(1e-3f, 2e-3f, 5e-3f), aspects[i]);
        assert_framed(vec3(-1e4f, 0, -1e4f), vec3(1e4f, 10.0f, 1e4f), aspects[i]);
        assert_framed(vec3(100, -50, 7), vec3(101, 50, 8), aspects[i]);
        assert_framed(vec3(0, 0, -30), vec3(0.5f, 0.5f, 30), aspects[i]);
    }
}

static void the_framing_camera_looks_from_right_front_and_above(void **state)
{
    (void)state;
    shape_place(test.scene,
                shape_box(test.scene, 0, vec3_splat(-1.0f), vec3_splat(1.0f), 1, false));
    ppm_camera_id id;
    assert_int_equal(ppm_scene_add_framing_camera(test.scene, 1.0f, &id), PPM_STATUS_OK);
    const ppmi_vec3 origin = test.scene->cameras[id - 1].origin;
    assert_true(origin.x > 0.0f && origin.y > 0.0f && origin.z > 0.0f);
    assert_true(test.scene->cameras[id - 1].up.y > 0.5f);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(cameras_out_of_range_are_refused),
        WITH_SCENE(scale_in_a_camera_transform_is_ignored),
        WITH_SCENE(lights_out_of_range_are_refused),
        WITH_SCENE(the_size_of_a_directional_light_is_checked),
        WITH_SCENE(framing_needs_an_aspect),
        WITH_SCENE(where_nothing_is_visible_the_hidden_is_framed),
        WITH_SCENE(a_camera_tells_where_it_stands),
        cmocka_unit_test(the_framing_camera_sees_all_corners),
        WITH_SCENE(the_framing_camera_looks_from_right_front_and_above),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
