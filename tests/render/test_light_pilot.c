/* Lamps that do not reach the picture: what they cost, and that nothing else depends on the pilot.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
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

/* A closed room with one lamp, and beside it one that is seen from nowhere in the first. */
static void add_rooms(void)
{
    const ppm_material_id white = material_lambert(test.scene, 0.5f);
    shape_place(test.scene, shape_box(test.scene, white, vec3(0, 0, 0), vec3(3, 2, 3), 1, true));
    shape_place(test.scene, shape_box(test.scene, white, vec3(3.1f, 0, 0), vec3(9, 2, 3), 1, true));
    light_point(test.scene, vec3(1.2f, 1.1f, 1.4f), vec3_splat(10.0f));
    camera_perspective(test.scene, vec3(0.3f, 1, 0.2f), vec3(2, 0.7f, 2), 1.0f);
}

static void add_lamps_next_door(uint32_t count, float candela)
{
    for (uint32_t i = 0; i < count; i++) {
        const float x = 3.3f + 5.5f * ((float)i + 0.5f) / (float)count;
        light_point(test.scene, vec3(x, 1.9f, 0.1f + 0.28f * (float)(i % 11)), vec3_splat(candela));
    }
}

/* Mean squared difference of two seeds over the squared mean. */
static double noise(int32_t integrator)
{
    ppm_render_options options = render_options(integrator, 32, 2000);
    options.max_depth = 2; /* direct light */
    options.seed = 1;
    float *a = render_picture(test.scene, &options, 4);
    options.seed = 2;
    float *b = render_picture(test.scene, &options, 4);
    double difference2 = 0.0, sum = 0.0;
    for (size_t i = 1; i < 4 * 32 * 32; i += 4) {
        difference2 += pow((double)(a[i] - b[i]), 2.0);
        sum += (double)(a[i] + b[i]);
    }
    free(a);
    free(b);
    return 32.0 * 32.0 * difference2 / (sum * sum);
}

static void lamps_in_another_room_cost_no_noise(void **state)
{
    (void)state;
    add_rooms();
    const double without = noise(PPM_INTEGRATOR_PATH);
    add_lamps_next_door(1, 2000.0f);
    const double with_one = noise(PPM_INTEGRATOR_PATH);
    add_lamps_next_door(400, 50.0f);
    const double with_many = noise(PPM_INTEGRATOR_PATH);
    print_message("variance %.3g without, %.3g with a lamp, %.3g with 401\n", without, with_one,
                  with_many);
    assert_true(without > 0.0);
    assert_true(with_one < 1.2 * without && with_many < 1.44 * without);
}

/* A sky that no window lets in takes nothing from the lamp, nor does a sun. */
static void light_outside_costs_no_noise(void **state)
{
    (void)state;
    add_rooms();
    const double without = noise(PPM_INTEGRATOR_PATH);
    light_environment(test.scene, vec3_splat(5000.0f), 0, 0.0f);
    light_sun(test.scene, vec3(1, -2, 0.3f), vec3_splat(1e5f), 0.005f);
    const double with = noise(PPM_INTEGRATOR_PATH);
    print_message("variance %.3g without, %.3g with sun and sky\n", without, with);
    assert_true(with < 1.2 * without);
}

static void a_crop_is_a_part_with_any_threads(void **state)
{
    (void)state;
    add_rooms();
    add_lamps_next_door(9, 100.0f);
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 24, 0);
    float *whole = render_picture(test.scene, &options, 2);
    options.threads = 3;
    options.crop[0] = 5;
    options.crop[1] = 9;
    options.crop[2] = 17;
    options.crop[3] = 20;
    float *part = render_picture(test.scene, &options, 2);
    for (size_t y = 0; y < 11; y++)
        assert_memory_equal(part + 4 * 12 * y, whole + 4 * (24 * (9 + y) + 5),
                            4 * 12 * sizeof(float));
    free(whole);
    free(part);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(lamps_in_another_room_cost_no_noise),
        WITH_SCENE(light_outside_costs_no_noise),
        WITH_SCENE(a_crop_is_a_part_with_any_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
