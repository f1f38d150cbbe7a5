/* Caustics on surfaces too narrow to gather all light: photons and paths share them by weights that
 * sum to 1, and a lamp without size is not lost where lobes become narrow. */
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

/* A glass ball over metal of some roughness, seen from above. */
static void add_ball_over_metal(float roughness)
{
    ppm_scene *scene = test.scene;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    vec3_store(desc.base_color, vec3(0.9f, 0.8f, 0.7f));
    desc.metallic = 1.0f;
    desc.roughness = roughness;
    add_quad(scene, material_add(scene, &desc), vec3(-2, 0, -2), vec3(0, 0, 4), vec3(4, 0, 0));
    shape_place_at(scene, shape_sphere(scene, material_glass(scene, 1.5f, 0.0f), 0.4f, 32, true),
                   vec3(0, 0.6f, 0));
    camera_perspective(scene, vec3(1.6f, 1.6f, 0), vec3(0.3f, 0.1f, 0), 0.8f);
}

/* The lamp is wide enough for paths to find it through the ball. */
static void methods_agree_on_metal(float roughness)
{
    add_ball_over_metal(roughness);
    ppm_scene *scene = test.scene;
    light_environment(scene, vec3_splat(0.5f), 0, 0.0f);
    const ppm_material_id lamp = material_emitter(scene, 8.0f, 0.0f, false);
    shape_place_at(scene, shape_sphere(scene, lamp, 0.4f, 8, false), vec3(-1.5f, 1.8f, 0));
    const method_comparison how = {.width = 45,
                                   .path_passes = 160,
                                   .passes = 10,
                                   .photons = 20000,
                                   .radius_m = 0.015f,
                                   .bias = 0.02,
                                   .resolution = 0.06,
                                   .seeds = 8,
                                   .left_out = METHODS_OF_OTHER_RADII | 1 << 2 | 1 << 5};
    methods_agree(scene, &how);
}

static void roughness_0_1(void **state)
{
    (void)state;
    methods_agree_on_metal(0.1f);
}

static void roughness_0_25(void **state)
{
    (void)state;
    methods_agree_on_metal(0.25f);
}

static void roughness_0_4(void **state)
{
    (void)state;
    methods_agree_on_metal(0.4f);
}

static test_mean mean_under_a_point_lamp(float roughness)
{
    test_scene *scene = &test;
    scene_open(scene);
    add_ball_over_metal(roughness);
    light_point(scene->scene, vec3(-1.5f, 1.8f, 0), vec3_splat(10.0f));
    ppm_render_options options = method_options(&photon_methods[0], 45, 20000);
    options.radius_m = 0.02f;
    const test_mean mean = render_green(scene->scene, &options, 10, 8);
    scene_close(scene);
    return mean;
}

/* Metal of roughness 0.46 gathers all light, of 0.44 only what paths cannot find. */
static void a_caustic_of_a_point_lamp_does_not_vanish_below_a_roughness(void **state)
{
    (void)state;
    const test_mean wide = mean_under_a_point_lamp(0.455f);
    const test_mean narrow = mean_under_a_point_lamp(0.44f);
    mean_check_power(&wide, 0.02);
    mean_check_power(&narrow, 0.02);
    if (fabs(narrow.mean / wide.mean - 1.0) > 0.05) {
        fail_msg("roughness 0.44: %.4g, 0.455: %.4g", narrow.mean, wide.mean);
    }
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(roughness_0_1),
        WITH_SCENE(roughness_0_25),
        WITH_SCENE(roughness_0_4),
        cmocka_unit_test(a_caustic_of_a_point_lamp_does_not_vanish_below_a_roughness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
