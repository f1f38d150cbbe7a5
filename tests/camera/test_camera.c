/* Camera rays. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "camera/camera.h"
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

static void assert_direction(ppmi_vec3 d, float x, float y, float z)
{
    const ppmi_vec3 expected = vec3_normalize(vec3(x, y, z));
    assert_near(vec3_length(vec3_sub(d, expected)), 0.0, 1e-6);
}

static ppmi_camera_view view_of(ppm_camera_id id, uint32_t width, uint32_t height)
{
    ppmi_camera_view view;
    ppmi_camera_view_init(&test.scene->cameras[id - 1], width, height, &view);
    return view;
}

static void the_picture_is_upright_and_its_first_row_is_on_top(void **state)
{
    (void)state;
    const ppm_camera_id id =
        camera_perspective(test.scene, vec3(1, 2, 3), vec3(1, 2, -7), 2.0f * atanf(0.5f));
    const ppmi_camera_view view = view_of(id, 200, 100);
    assert_direction(ppmi_camera_view_ray(&view, 100, 50).ray.direction, 0, 0, -1);
    assert_direction(ppmi_camera_view_ray(&view, 0, 0).ray.direction, -1, 0.5f, -1);
    assert_direction(ppmi_camera_view_ray(&view, 200, 100).ray.direction, 1, -0.5f, -1);
    assert_near(ppmi_camera_view_ray(&view, 0, 0).ray.origin.x, 1.0, 0.0);
}

/* The angle stays vertical whatever the picture's aspect. */
static void the_vertical_angle_does_not_depend_on_the_aspect(void **state)
{
    (void)state;
    const ppm_camera_id id =
        camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 2.0f * atanf(0.5f));
    const uint32_t widths[] = {10, 100, 1000};
    for (int i = 0; i < 3; i++) {
        const ppmi_camera_view view = view_of(id, widths[i], 100);
        const float middle = 0.5f * (float)widths[i];
        assert_direction(ppmi_camera_view_ray(&view, middle, 0).ray.direction, 0, 0.5f, -1);
    }
}

static void the_cone_is_as_wide_as_a_pixel(void **state)
{
    (void)state;
    const ppm_camera_id id =
        camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 2.0f * atanf(0.5f));
    const ppmi_camera_view view = view_of(id, 100, 100);
    const ppmi_camera_ray ray = ppmi_camera_view_ray(&view, 50, 50);
    assert_near(ray.base_width, 0.0, 0.0);
    assert_near(ray.spread, 0.01, 1e-6);
    const ppmi_camera_ray next = ppmi_camera_view_ray(&view, 51, 50);
    assert_near(vec3_length(vec3_sub(next.ray.direction, ray.ray.direction)), ray.spread, 1e-4);
}

static void orthographic_rays_are_parallel(void **state)
{
    (void)state;
    const ppm_camera_id id = camera_orthographic(test.scene, vec3(0, 5, 0), vec3(0, 0, 0), 2.0f);
    const ppmi_camera_view view = view_of(id, 80, 80);
    const ppmi_camera_ray corner = ppmi_camera_view_ray(&view, 0, 0);
    const ppmi_camera_ray opposite = ppmi_camera_view_ray(&view, 80, 80);
    assert_direction(corner.ray.direction, 0, -1, 0);
    assert_direction(opposite.ray.direction, 0, -1, 0);
    assert_near(vec3_length(vec3_sub(corner.ray.origin, opposite.ray.origin)), 4.0 * sqrt(2.0),
                1e-5);
    assert_near(corner.base_width, 0.05, 1e-6);
    assert_near(corner.spread, 0.0, 0.0);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(the_picture_is_upright_and_its_first_row_is_on_top),
        WITH_SCENE(the_vertical_angle_does_not_depend_on_the_aspect),
        WITH_SCENE(the_cone_is_as_wide_as_a_pixel),
        WITH_SCENE(orthographic_rays_are_parallel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
