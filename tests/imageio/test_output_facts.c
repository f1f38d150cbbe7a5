/* The camera in a file's header takes points to where they are in the picture. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "camera/camera.h"
#include "imageio/layered_input.h"
#include "imageio/scratch.h"
#include "ppm/ppm.h"
#include "support/scenes.h"

enum { WIDTH = 30, HEIGHT = 20 };

static test_scene test;

static int setup(void **state)
{
    (void)state;
    scratch_create();
    scene_open(&test);
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    add_quad(test.scene, grey, vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0));
    light_environment(test.scene, vec3(1, 1, 1), 0, 0);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    scene_close(&test);
    scratch_remove();
    return 0;
}

/* Renders a pass by the first camera, and opens the file; *view is the camera. */
static ppmi_layered_input *render_and_open(float aperture, ppmi_camera_view *view)
{
    ppm_render_options options = {.size = sizeof options,
                                  .integrator = PPM_INTEGRATOR_PATH,
                                  .width = WIDTH,
                                  .height = HEIGHT,
                                  .crop = {3, 2, 20, 18},
                                  .aperture_f_number = aperture,
                                  .focus_distance_m = aperture > 0 ? 2.5f : 0,
                                  .threads = 1};
    ppm_render *render = NULL;
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    const char *const path = scratch_path("a.exr");
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
    assert_int_equal(ppm_render_write(render, NULL, path, NULL), PPM_STATUS_OK);
    ppmi_camera_view_init(&test.scene->cameras[0], WIDTH, HEIGHT, view);
    ppm_render_destroy(render);
    assert_int_equal(ppmi_layered_input_open(test.context, path, &input, &info), PPM_STATUS_OK);
    assert_int_equal(info.x, 3);
    assert_int_equal(info.full_width, WIDTH);
    return input;
}

static const float *matrix_of(const ppmi_layered_input *input, const char *name)
{
    const ppmi_image_attribute *const attribute = ppmi_layered_input_find(input, name);
    assert_non_null(attribute);
    assert_int_equal(attribute->type, PPMI_ATTRIBUTE_MATRIX);
    return attribute->floats;
}

static void transform(const float m[16], ppmi_vec3 p, double out[4])
{
    for (int c = 0; c < 4; c++) {
        out[c] = (double)p.x * (double)m[c] + (double)p.y * (double)m[4 + c] +
                 (double)p.z * (double)m[8 + c] + (double)m[12 + c];
    }
}

static void assert_near(double value, double expected)
{
    if (fabs(value - expected) > 2e-5) fail_msg("%g, expected %g", value, expected);
}

/* Points along camera rays, near and far. */
static void assert_rays_are_found(const ppmi_layered_input *input, const ppmi_camera_view *view)
{
    const float *const to_ndc = matrix_of(input, "worldToNDC");
    const float *const to_camera = matrix_of(input, "worldToCamera");
    for (float y = 0; y <= HEIGHT; y += 5) {
        for (float x = 0; x <= WIDTH; x += 6) {
            const ppmi_camera_ray ray = ppmi_camera_view_ray(view, x, y);
            for (float t = 0.5f; t < 20; t *= 3) {
                const ppmi_vec3 point = vec3_mad(ray.ray.origin, ray.ray.direction, t);
                double ndc[4], camera[4];
                transform(to_ndc, point, ndc);
                transform(to_camera, point, camera);
                assert_near(ndc[0] / ndc[3], (double)(x / WIDTH));
                assert_near(ndc[1] / ndc[3], (double)(y / HEIGHT));
                assert_near(camera[2],
                            (double)vec3_dot(vec3_sub(point, view->origin), view->forward));
                assert_near(camera[3], 1);
            }
        }
    }
}

static void perspective_points_are_found_in_the_picture(void **state)
{
    (void)state;
    ppmi_camera_view view;
    camera_perspective(test.scene, vec3(0.3f, -0.4f, 3), vec3(0.1f, 0.2f, 0), 0.8f);
    test.scene->cameras[0].shift[0] = 0.1f;
    test.scene->cameras[0].shift[1] = -0.05f;
    ppmi_layered_input *const input = render_and_open(0, &view);
    assert_rays_are_found(input, &view);
    assert_null(ppmi_layered_input_find(input, "FNumber"));
    ppmi_layered_input_close(test.context, input);
}

static void orthographic_points_are_found_in_the_picture(void **state)
{
    (void)state;
    ppmi_camera_view view;
    camera_orthographic(test.scene, vec3(0.3f, -0.4f, 3), vec3(0.1f, 0.2f, 0), 1.5f);
    ppmi_layered_input *const input = render_and_open(0, &view);
    assert_rays_are_found(input, &view);
    ppmi_layered_input_close(test.context, input);
}

static float number_of(const ppmi_layered_input *input, const char *name)
{
    const ppmi_image_attribute *const attribute = ppmi_layered_input_find(input, name);
    if (!attribute || attribute->type != PPMI_ATTRIBUTE_FLOAT) fail_msg("no number %s", name);
    return attribute->floats[0];
}

static void the_lens_is_told(void **state)
{
    (void)state;
    ppmi_camera_view view;
    const float angle = 2 * atanf(0.5f); /* half a metre at a metre, upwards; 0.75 sideways */
    camera_perspective(test.scene, vec3(0, 0, 3), vec3(0, 0, 0), angle);
    ppmi_layered_input *const input = render_and_open(4, &view);
    assert_near((double)number_of(input, "FNumber"), 4);
    assert_near((double)number_of(input, "focus"), 2.5);
    assert_near((double)number_of(input, "screenWindowWidth"), 1.5);
    assert_near((double)number_of(input, "nominalFocalLength"), 24); /* 36 mm are 1.5 times it */
    assert_near((double)number_of(input, "ppm:sensor_mm"), 36);
    assert_true(number_of(input, "ppm:seconds") >= 0);
    ppmi_layered_input_close(test.context, input);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(perspective_points_are_found_in_the_picture),
        TEST(orthographic_points_are_found_in_the_picture),
        TEST(the_lens_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
