/* All integrators render the same picture: sppm in both schedules, ppm with and without epochs,
 * direct light by sampling and by photons, against the path tracer. */
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

/* Within a radius of an edge a disk reaches beyond its wall, and loses there on average a quarter
 * of its photons. A block has up to 2 m of edges a square metre: with radii of 2 cm at most 2 *
 * 0.02 / 4 = 1 % of its light. */
static const double edge_bias = 0.01;

static void a_box_of_plastic_and_rough_metal(void **state)
{
    (void)state;
    add_lit_box(test.scene, vec3(0.6f, 0.5f, 0.4f), vec3(0, -0.1f, -1));
    ppm_scene *scene = test.scene;
    const ppm_material_desc plastic = material_desc_rgb(vec3(0.2f, 0.5f, 0.7f), 0.0f, 0.35f);
    const ppm_material_desc metal = material_desc_rgb(vec3(0.9f, 0.7f, 0.4f), 1.0f, 0.7f);
    shape_place(scene, shape_box(scene, material_add(scene, &plastic), vec3(-0.6f, -1, -0.7f),
                                 vec3(0.0f, -0.2f, -0.1f), 1, false));
    shape_place_at(scene, shape_sphere(scene, material_add(scene, &metal), 0.35f, 32, true),
                   vec3(0.5f, -0.6f, -0.3f));
    const method_comparison how = {.width = 60,
                                   .path_passes = 32,
                                   .passes = 6,
                                   .photons = 10000,
                                   .radius_m = 0.02f,
                                   .bias = edge_bias,
                                   .resolution = 0.05,
                                   .seeds = 8};
    methods_agree(scene, &how);
}

/* A sky with a bright half, on a ball of plastic and one of rough metal over a floor. */
static void things_under_a_sky(void **state)
{
    (void)state;
    ppm_scene *scene = test.scene;
    const float pixels[2 * 2 * 3] = {0.3f, 0.6f, 1.2f, 2.5f, 2.0f, 1.5f,
                                     0.2f, 0.2f, 0.2f, 0.4f, 0.3f, 0.2f};
    light_environment(scene, vec3_splat(1.0f), image_rgb(scene, 2, 2, pixels), 0.4f);
    add_quad(scene, material_lambert_rgb(scene, vec3(0.7f, 0.6f, 0.5f)), vec3(-2, 0, -2),
             vec3(0, 0, 4), vec3(4, 0, 0));
    const ppm_material_desc plastic = material_desc_rgb(vec3(0.7f, 0.2f, 0.2f), 0.0f, 0.2f);
    const ppm_material_desc metal = material_desc_rgb(vec3(0.9f, 0.7f, 0.4f), 1.0f, 0.4f);
    shape_place_at(scene, shape_sphere(scene, material_add(scene, &plastic), 0.5f, 32, true),
                   vec3(-0.6f, 0.5f, 0));
    shape_place_at(scene, shape_sphere(scene, material_add(scene, &metal), 0.5f, 32, true),
                   vec3(0.6f, 0.5f, 0));
    camera_perspective(scene, vec3(0, 1.5f, 2.5f), vec3(0, 0.4f, 0), 0.7f);
    const method_comparison how = {.width = 60,
                                   .path_passes = 16,
                                   .passes = 10,
                                   .photons = 20000,
                                   .radius_m = 0.02f,
                                   .bias = edge_bias,
                                   .resolution = 0.05,
                                   .seeds = 8};
    methods_agree(scene, &how);
}

/* Glass that paths can handle: rough, and smooth before a wide lamp. */
static void a_box_of_glass(void **state)
{
    (void)state;
    add_lit_box(test.scene, vec3(0.6f, 0.5f, 0.4f), vec3(0, -0.1f, -1));
    ppm_scene *scene = test.scene;
    shape_place(scene, shape_box(scene, material_glass(scene, 1.5f, 0.5f),
                                 vec3(-0.7f, -0.9f, -0.7f), vec3(-0.1f, -0.1f, -0.1f), 1, false));
    shape_place_at(scene, shape_sphere(scene, material_glass(scene, 1.4f, 0.0f), 0.35f, 32, true),
                   vec3(0.5f, -0.5f, -0.3f));
    const method_comparison how = {.width = 60,
                                   .path_passes = 64,
                                   .passes = 6,
                                   .photons = 10000,
                                   .radius_m = 0.02f,
                                   .bias = edge_bias,
                                   .resolution = 0.08,
                                   .seeds = 8};
    methods_agree(scene, &how);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_box_of_plastic_and_rough_metal),
        WITH_SCENE(things_under_a_sky),
        WITH_SCENE(a_box_of_glass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
