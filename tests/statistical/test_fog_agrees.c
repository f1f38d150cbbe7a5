/* All integrators agree in coloured fog around a glass ball. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "statistical/methods.h"
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

/* Disks and balls of 5 cm lose photons at the walls: within a radius of an edge a quarter, with 2 m
 * of edges a square metre at most 2.5 % of a block's light; in the fog less, on a way of a metre.
 */
static void a_foggy_box_with_a_glass_ball(void **state)
{
    (void)state;
    add_lit_box(test.scene, vec3(0.6f, 0.5f, 0.4f), vec3(0, -0.1f, -1));
    ppm_scene *scene = test.scene;
    scene_fog(scene, vec3(0.2f, 0.3f, 0.4f), vec3(0.1f, 0.05f, 0.0f), 0.5f);
    shape_place_at(scene, shape_sphere(scene, material_glass(scene, 1.5f, 0.0f), 0.4f, 32, true),
                   vec3(0.3f, -0.4f, -0.3f));
    const method_comparison how = {.width = 60,
                                   .path_passes = 48,
                                   .passes = 10,
                                   .photons = 20000,
                                   .radius_m = 0.05f,
                                   .bias = 0.025,
                                   .resolution = 0.03,
                                   .seeds = 12};
    methods_agree(scene, &how);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_foggy_box_with_a_glass_ball, open_scene, close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
