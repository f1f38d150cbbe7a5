/* The layer of motion: ways of points in the picture, in scenes where they are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/layer_fixture.h"
#include "support/near.h"

static test_scene test;

enum { WIDTH = 8, PIXELS = WIDTH * WIDTH };

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

static void add_sky(void)
{
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
}

/* The place of a pixel's centre in the picture, -1 .. 1 to the right and up. */
static ppmi_vec2 centre_of(size_t pixel)
{
    return (ppmi_vec2){2.0f * ((float)(pixel % WIDTH) + 0.5f) / WIDTH - 1.0f,
                       1.0f - 2.0f * ((float)(pixel / WIDTH) + 0.5f) / WIDTH};
}

/* A wall at z = 0 that faces +z, 20 m wide, and one of 0.5 m at z = 1 before its lower left. */
static ppm_instance_id add_wall(void)
{
    add_sky();
    return layers_add_quad(test.scene, "wall", material_lambert(test.scene, 0.5f),
                           vec3(-10, -10, 0), vec3(20, 0, 0), vec3(0, 20, 0));
}

static float *motion_layer(float open, float close)
{
    ppm_render_options options = layers_options(WIDTH, PPM_LAYER_MOTION);
    options.shutter_open = open;
    options.shutter_close = close;
    return layers_picture(test.scene, &options, 2, PPM_LAYER_MOTION);
}

/* Across the picture by 1 m to the right and 0.5 m up during 0.5 frames; a pixel is 0.25 m. Blender
 * 3.4 has these signs: a plane that moves by (1 m, 0.8 m) to a frame and by (1 m, 1.4 m) to the
 * next, at half a metre a pixel, has (-2, -1.6, -2, -2.8) there. */
static void motion_is_pixels_a_frame_as_blender_has_it(void **state)
{
    (void)state;
    add_sky();
    layers_add_moving_wall(test.scene, vec3(0, 0, 0), vec3(1, 0.5f, 0));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    float *values = motion_layer(-0.25f, 0.25f);
    for (size_t i = 0; i < PIXELS; i++) {
        const float *m = values + 4 * i;
        assert_near(m[0], -8.0, 1e-4);
        assert_near(m[1], -4.0, 1e-4);
        assert_near(m[2], -8.0, 1e-4);
        assert_near(m[3], -4.0, 1e-4);
    }
    free(values);
}

/* Towards the eye: places in the picture go outwards as 1 / depth. */
static void motion_is_that_of_the_projection(void **state)
{
    (void)state;
    add_sky();
    layers_add_moving_wall(test.scene, vec3(0, 0, 0), vec3(0, 0, 2)); /* depth 6, 5, 4 */
    camera_perspective(test.scene, vec3(0, 0, 6), vec3_splat(0.0f), 1.0f);
    float *values = motion_layer(0.0f, 1.0f);
    for (size_t i = 0; i < PIXELS; i++) {
        const ppmi_vec2 centre = centre_of(i);
        const double x = 0.5 * WIDTH * (double)centre.x, y = 0.5 * WIDTH * (double)centre.y;
        const double back = 2.0 * (5.0 / 6.0 - 1.0), forth = 2.0 * (1.0 - 5.0 / 4.0);
        assert_near(values[4 * i], back * x, 1e-4);
        assert_near(values[4 * i + 1], back * y, 1e-4);
        assert_near(values[4 * i + 2], forth * x, 1e-4);
        assert_near(values[4 * i + 3], forth * y, 1e-4);
    }
    free(values);
}

static void a_moving_camera_moves_all_the_other_way(void **state)
{
    (void)state;
    float motion[32];
    layers_at_place(vec3(0, 0, 5), motion);
    layers_at_place(vec3(0.5f, 0, 5), motion + 16);
    add_wall();
    const ppm_camera_desc desc = {.size = sizeof desc,
                                  .kind = PPM_CAMERA_ORTHOGRAPHIC,
                                  .half_width_m = 1.0f,
                                  .half_height_m = 1.0f,
                                  .motion_steps = 2,
                                  .motion = motion};
    ppm_camera_id id = 0;
    assert_int_equal(ppm_scene_add_camera(test.scene, &desc, &id), PPM_STATUS_OK);
    float *values = motion_layer(0.0f, 1.0f);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_near(values[4 * i], 2.0, 1e-4);
        assert_near(values[4 * i + 2], 2.0, 1e-4);
        assert_near(values[4 * i + 1], 0.0, 1e-4);
        assert_near(values[4 * i + 3], 0.0, 1e-4);
    }
    free(values);
}

static void moving_vertices_move_their_points(void **state)
{
    (void)state;
    /* stretched along x to twice its width: points at x go to 2 x */
    static const float positions[24] = {-8,  -8, 0, 8,  -8, 0, 8,  8, 0, -8,  8, 0,
                                        -16, -8, 0, 16, -8, 0, 16, 8, 0, -16, 8, 0};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const ppm_primitive_desc primitive = {.vertex_count = 4,
                                          .triangle_count = 2,
                                          .positions = positions,
                                          .indices = indices,
                                          .material = material_lambert(test.scene, 0.5f),
                                          .motion_steps = 2};
    add_sky();
    shape_place(test.scene, shape_mesh(test.scene, &primitive));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    float *values = motion_layer(0.0f, 1.0f);
    for (size_t i = 0; i < PIXELS; i++) {
        const double x = 0.5 * WIDTH * (double)centre_of(i).x; /* in the middle, at 1.5 times */
        assert_near(values[4 * i], 2.0 * (1.0 / 1.5 - 1.0) * x, 1e-4);
        assert_near(values[4 * i + 2], 2.0 * (1.0 - 2.0 / 1.5) * x, 1e-4);
    }
    free(values);
}

static void with_the_shutter_closed_nothing_moves(void **state)
{
    (void)state;
    add_sky();
    layers_add_moving_wall(test.scene, vec3(0, 0, 0), vec3(1, 0.5f, 0));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    float *values = motion_layer(0.0f, 0.0f);
    for (size_t i = 0; i < 4 * PIXELS; i++)
        assert_true(values[i] == 0.0f);
    free(values);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(motion_is_pixels_a_frame_as_blender_has_it),
        WITH_SCENE(motion_is_that_of_the_projection),
        WITH_SCENE(a_moving_camera_moves_all_the_other_way),
        WITH_SCENE(moving_vertices_move_their_points),
        WITH_SCENE(with_the_shutter_closed_nothing_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
