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

/* By a quarter of the height to the right and half of it up: whatever the aspect. */
static void a_shift_moves_the_picture_in_its_plane(void **state)
{
    (void)state;
    const ppm_camera_id id =
        camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 2.0f * atanf(0.5f));
    test.scene->cameras[id - 1].shift[0] = 0.25f;
    test.scene->cameras[id - 1].shift[1] = 0.5f;
    for (uint32_t width = 50; width <= 200; width += 150) {
        const ppmi_camera_view view = view_of(id, width, 100);
        const float x = 0.5f * (float)width;
        assert_direction(ppmi_camera_view_ray(&view, x, 50).ray.direction, 0.25f, 0.5f, -1);
        assert_direction(ppmi_camera_view_ray(&view, x, 100).ray.direction, 0.25f, 0, -1);
    }
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

/* ---- the lens -------------------------------------------------------------------------------- */

static ppmi_camera_view lens_view(uint32_t width, uint32_t height, float f_number, float focus)
{
    const ppm_camera_id id =
        camera_perspective(test.scene, vec3(1, 2, 3), vec3(2, -1, 0), 2.0f * atanf(0.5f));
    ppmi_camera_view view = view_of(id, width, height);
    ppmi_camera_view_set_lens(&view, f_number, focus);
    return view;
}

/* Where a ray is at a distance along the axis. */
static ppmi_vec3 at_depth(const ppmi_camera_view *view, const ppmi_ray *ray, float depth)
{
    const float t = depth / vec3_dot(ray->direction, view->forward);
    return vec3_mad(ray->origin, ray->direction, t);
}

/* A vertical angle of 2 atan(1/2) on a sensor 36 mm wide and 18 mm high is a lens of 18 mm; on one
 * 18 mm wide and 36 mm high one of 36 mm. */
static void the_longer_side_of_the_sensor_is_36_mm(void **state)
{
    (void)state;
    const struct {
        uint32_t width, height;
        float focal_length_m;
    } cases[] = {{200, 100, 0.018f}, {100, 200, 0.036f}, {100, 100, 0.036f}};
    for (int i = 0; i < 3; i++) {
        const ppmi_camera_view view = lens_view(cases[i].width, cases[i].height, 2.0f, 1.0f);
        const float focal = ppmi_camera_view_focal_length(&view);
        assert_near(focal, cases[i].focal_length_m, 1e-7);
        const ppmi_camera_ray rim =
            ppmi_camera_view_lens_ray(&view, 30, 20, (ppmi_vec2){0.6f, 0.8f});
        assert_near(vec3_length(vec3_sub(rim.ray.origin, view.origin)), focal / 4.0f, 1e-6);
        assert_near(vec3_dot(vec3_sub(rim.ray.origin, view.origin), view.forward), 0.0, 1e-6);
    }
}

/* In front of the sharp plane and behind it, a place of the picture is a disk of radius
 * R |z - d| / d: what similar triangles say. */
static void rays_of_a_place_meet_in_the_plane_of_focus_and_nowhere_else(void **state)
{
    (void)state;
    const float focus = 3.0f;
    const ppmi_camera_view view = lens_view(200, 100, 0.1f, focus);
    const float radius = ppmi_camera_view_focal_length(&view) / 0.2f;
    const ppmi_vec2 places[] = {{100, 50}, {0, 0}, {170, 90}, {-3, 104}};
    const ppmi_vec2 rim[] = {{1, 0}, {0, 1}, {-0.6f, 0.8f}, {0, -1}};
    for (int p = 0; p < 4; p++) {
        const ppmi_ray middle = ppmi_camera_view_ray(&view, places[p].x, places[p].y).ray;
        for (int i = 0; i < 4; i++) {
            const ppmi_ray ray =
                ppmi_camera_view_lens_ray(&view, places[p].x, places[p].y, rim[i]).ray;
            assert_near(vec3_length(ray.direction), 1.0, 1e-6);
            for (float z = 0.0f; z < 10.0f; z += 1.0f) {
                const ppmi_vec3 shift =
                    vec3_sub(at_depth(&view, &ray, z), at_depth(&view, &middle, z));
                assert_near(vec3_length(shift), radius * fabsf(z - focus) / focus, 1e-5);
            }
        }
    }
}

static void nothing_but_a_perspective_camera_with_an_aperture_has_a_lens(void **state)
{
    (void)state;
    const ppmi_camera_view pinhole = lens_view(200, 100, INFINITY, 1.0f);
    assert_false(pinhole.has_lens);
    const ppm_camera_id id = camera_orthographic(test.scene, vec3(0, 5, 0), vec3(0, 0, 0), 2.0f);
    ppmi_camera_view parallel = view_of(id, 80, 80);
    ppmi_camera_view_set_lens(&parallel, 1.0f, 1.0f);
    assert_false(parallel.has_lens);
    const ppmi_ray ray = ppmi_camera_view_lens_ray(&parallel, 40, 40, (ppmi_vec2){1, 0}).ray;
    assert_direction(ray.direction, 0, -1, 0);
    assert_near(ray.origin.x, 0.0, 1e-6);
}

/* The same rays, from the near plane to the far one, with the same cone at the same point. */
static void clipped_rays_begin_and_end_at_planes(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        const ppm_camera_id id =
            i == 1 ? camera_orthographic(test.scene, vec3(1, 2, 3), vec3(1, 2, -7), 2.0f)
                   : camera_perspective(test.scene, vec3(1, 2, 3), vec3(1, 2, -7), 1.0f);
        ppmi_camera_view whole = view_of(id, 200, 100), clipped;
        test.scene->cameras[id - 1].near_m = 2.0f;
        test.scene->cameras[id - 1].far_m = 7.0f;
        clipped = view_of(id, 200, 100);
        if (i == 2) ppmi_camera_view_set_lens(&whole, 0.1f, 3.0f);
        if (i == 2) ppmi_camera_view_set_lens(&clipped, 0.1f, 3.0f);
        const ppmi_vec2 lens = {0.5f, -0.25f};
        const ppmi_camera_ray a = ppmi_camera_view_lens_ray(&whole, 20, 70, lens);
        const ppmi_camera_ray b = ppmi_camera_view_lens_ray(&clipped, 20, 70, lens);
        const ppmi_camera_ray c = ppmi_camera_view_lens_ray(&clipped, 21, 70, lens);
        const ppmi_vec3 end = vec3_mad(b.ray.origin, b.ray.direction, b.ray.t_max);
        const float skipped = vec3_length(vec3_sub(b.ray.origin, a.ray.origin));
        assert_true(isinf(a.ray.t_max));
        assert_near(b.ray.origin.z, 1.0, 1e-6);
        assert_near(end.z, -4.0, 1e-5);
        assert_near(vec3_length(vec3_sub(b.ray.direction, a.ray.direction)), 0.0, 0.0);
        assert_near(b.base_width, a.base_width + a.spread * skipped, 1e-7);
        assert_near(vec3_length(vec3_sub(vec3_sub(c.ray.origin, b.ray.origin), b.position_dx)), 0.0,
                    1e-6);
    }
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(the_picture_is_upright_and_its_first_row_is_on_top),
        WITH_SCENE(a_shift_moves_the_picture_in_its_plane),
        WITH_SCENE(the_vertical_angle_does_not_depend_on_the_aspect),
        WITH_SCENE(the_cone_is_as_wide_as_a_pixel),
        WITH_SCENE(orthographic_rays_are_parallel),
        WITH_SCENE(clipped_rays_begin_and_end_at_planes),
        WITH_SCENE(the_longer_side_of_the_sensor_is_36_mm),
        WITH_SCENE(rays_of_a_place_meet_in_the_plane_of_focus_and_nowhere_else),
        WITH_SCENE(nothing_but_a_perspective_camera_with_an_aperture_has_a_lens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
