/* Light sampling at surfaces: irradiance against formulas, and the densities it states. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;
static test_family family;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    family = (test_family){0};
    /* something to stand on, out of the way */
    shape_place(test.scene, shape_box(test.scene, 0, vec3(-1, -3, -1), vec3(1, -2, 1), 1, false));
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    world_close(&world);
    scene_close(&test);
    return 0;
}

/* Irradiance at a point by light sampling, in the channels' mean. */
static test_mean irradiance(ppmi_vec3 p, ppmi_vec3 n, uint32_t count, uint64_t seed)
{
    test_mean mean = {0};
    ppmi_rng rng = ppmi_rng_start(seed, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < count; i++) {
        const double pick = ppmi_rng_double(&rng);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_light_sample s;
        double value = 0.0;
        if (ppmi_lights_sample(world.lights, p, n, pick, u, v, &s)) {
            assert_near(vec3_length(s.wi), 1.0, 1e-5);
            assert_true(s.pdf > 0.0f && vec3_is_finite(s.radiance));
            const float cosine = ppmi_max(vec3_dot(s.wi, n), 0.0f);
            value = (double)(vec3_mean(s.radiance) * cosine / s.pdf);
        }
        mean_add(&mean, value);
    }
    return mean;
}

static void compare(const char *name, ppmi_vec3 p, ppmi_vec3 n, double expected)
{
    const test_mean mean = irradiance(p, n, TEST_EFFORT(100000), family.count + 1);
    if (expected > 0.0) mean_check_power(&mean, 0.02);
    family_add_mean(&family, &mean, expected, 1e-5 * expected, "%s", name);
}

/* Irradiance from a uniform polygon: Lambert's formula, the sum over edges. */
static double polygon_irradiance(const ppmi_vec3 *corners, int count, ppmi_vec3 p, ppmi_vec3 n,
                                 double radiance)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        const ppmi_vec3 a = vec3_normalize(vec3_sub(corners[i], p));
        const ppmi_vec3 b = vec3_normalize(vec3_sub(corners[(i + 1) % count], p));
        const ppmi_vec3 axis = vec3_normalize(vec3_cross(a, b));
        sum += acos((double)vec3_dot(a, b)) * (double)vec3_dot(axis, n);
    }
    return 0.5 * radiance * fabs(sum);
}

static void a_rectangular_light_gives_its_form_factor(void **state)
{
    (void)state;
    const ppm_material_id lamp = material_emitter(test.scene, 5.0f, 0.0f, false);
    const ppmi_vec3 corners[4] = {{-1, 2, -0.5f}, {1, 2, -0.5f}, {1, 2.5f, 0.5f}, {-1, 2.5f, 0.5f}};
    add_quad(test.scene, lamp, corners[0], vec3_sub(corners[1], corners[0]),
             vec3_sub(corners[3], corners[0]));
    world_open(&world, &test);
    const ppmi_vec3 up = vec3(0, 1, 0), tilted = vec3_normalize(vec3(1, 2, 0));
    const ppmi_vec3 points[4] = {{0, 0, 0}, {2, 0, 1}, {-0.5f, 1.5f, 0}, {5, -1, 3}};
    for (int i = 0; i < 4; i++) {
        compare("level", points[i], up, polygon_irradiance(corners, 4, points[i], up, 5.0));
    }
    compare("tilted", points[0], tilted, polygon_irradiance(corners, 4, points[0], tilted, 5.0));
    compare("from behind", vec3(0, 5, 0), vec3(0, -1, 0), 0.0);
    family_check(&family);
}

static void a_point_light_falls_off_by_the_square(void **state)
{
    (void)state;
    light_point(test.scene, vec3(1, 2, 2), vec3(6, 6, 6));
    world_open(&world, &test);
    compare("point", vec3(0, 0, 0), vec3(0, 1, 0), 6.0 / 9.0 * (2.0 / 3.0));
    compare("from below", vec3(0, 0, 0), vec3(0, -1, 0), 0.0);
    family_check(&family);
}

static void a_spot_light_has_its_cones(void **state)
{
    (void)state;
    const double inner = 0.3, outer = 0.6;
    light_spot(test.scene, vec3(0, 4, 0), vec3(0, 0, 0), vec3_splat(8.0f), (float)inner,
               (float)outer);
    world_open(&world, &test);
    const double angles[] = {0.0, 0.2, 0.45, 0.59, 0.65};
    for (int i = 0; i < 5; i++) {
        const double x = (cos(angles[i]) - cos(outer)) / (cos(inner) - cos(outer));
        const double falloff = x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x * x;
        const double distance = 4.0 / cos(angles[i]);
        const ppmi_vec3 p = vec3((float)(4.0 * tan(angles[i])), 0, 0);
        const test_mean mean = irradiance(p, vec3(0, 1, 0), 10, 1);
        assert_near(mean.mean, 8.0 * falloff * cos(angles[i]) / (distance * distance),
                    1e-4 * falloff);
    }
}

static void a_directional_light_is_the_same_everywhere(void **state)
{
    (void)state;
    light_directional(test.scene, vec3(3, -4, 0), vec3_splat(10.0f));
    world_open(&world, &test);
    compare("near", vec3(0, 0, 0), vec3(0, 1, 0), 8.0);
    compare("far", vec3(900, 500, -100), vec3(0, 1, 0), 8.0);
    compare("facing away", vec3(0, 0, 0), vec3(1, 0, 0), 0.0);
    family_check(&family);
}

static void a_constant_environment_gives_pi(void **state)
{
    (void)state;
    light_environment(test.scene, vec3(1, 2, 3), 0, 0.0f);
    world_open(&world, &test);
    compare("constant", vec3(0, 0, 0), vec3_normalize(vec3(1, 1, -1)), 2.0 * M_PI);
    family_check(&family);
}

static void lights_of_all_kinds_add_up(void **state)
{
    (void)state;
    const ppm_material_id lamp = material_emitter(test.scene, 5.0f, 0.0f, true);
    const ppmi_vec3 corners[4] = {{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}};
    add_quad(test.scene, lamp, corners[0], vec3(2, 0, 0), vec3(0, 0, 2));
    light_point(test.scene, vec3(0, 1, 0), vec3_splat(0.01f));
    light_directional(test.scene, vec3(0, -1, 0), vec3_splat(3.0f));
    light_environment(test.scene, vec3_splat(0.5f), 0, 0.0f);
    world_open(&world, &test);
    const ppmi_vec3 p = vec3(0, 0, 0), up = vec3(0, 1, 0);
    compare("all", p, up, polygon_irradiance(corners, 4, p, up, 5.0) + 0.01 + 3.0 + 0.5 * M_PI);
    family_check(&family);
}

/* The density of a sample is what MIS asks for again when the ray meets the triangle. */
static void the_density_of_a_sample_is_that_of_its_surface(void **state)
{
    (void)state;
    const ppm_material_id lamp = material_emitter(test.scene, 5.0f, 0.0f, true);
    const ppm_material_id dim = material_emitter(test.scene, 0.5f, 0.0f, true);
    add_quad(test.scene, lamp, vec3(-1, 2, -1), vec3(2, 0, 0.3f), vec3(0, 0, 2));
    const float transform[16] = {2, 0, 0, 0, 0, 1, 0.5f, 0, 0, 0, -1, 0, 0.5f, 3, 4, 1};
    shape_place_by(test.scene, shape_box(test.scene, dim, vec3_splat(0), vec3_splat(1), 2, false),
                   transform);
    light_environment(test.scene, vec3_splat(0.5f), 0, 0.0f);
    world_open(&world, &test);
    const ppmi_vec3 p = vec3(0.2f, 0.1f, -0.3f), up = vec3(0, 1, 0);
    const ppmi_receiver at = {.position = p, .normal = up};
    ppmi_rng rng = ppmi_rng_start(4, PPMI_STREAM_EYE, 0);
    uint32_t on_surfaces = 0, in_sky = 0;
    for (int i = 0; i < 5000; i++) {
        const double pick = ppmi_rng_double(&rng);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_light_sample s;
        if (!ppmi_lights_sample(world.lights, p, up, pick, u, v, &s)) continue;
        if (s.is_far) {
            assert_near(ppmi_lights_pdf_environment(world.lights, &at, s.wi) / s.pdf, 1.0, 1e-4);
            in_sky++;
            continue;
        }
        const ppmi_ray ray = {.origin = p, .t_max = INFINITY, .direction = s.wi};
        ppmi_hit hit;
        if (!ppmi_accel_intersect(world.accel, &ray, &hit)) continue;
        const float distance = vec3_length(vec3_sub(s.target, p));
        if (fabsf(hit.t - distance) > 1e-3f) continue; /* another one in the way */
        ppmi_surface surface;
        ppmi_surface_from_hit(test.scene, &hit, &surface);
        const float pdf = ppmi_lights_pdf_surface(world.lights, &at, &hit, &surface, s.wi, hit.t);
        const double cosine = fabs((double)vec3_dot(s.wi, surface.ng));
        assert_near(pdf / s.pdf, 1.0, 1e-4 + 1e-5 / cosine);
        on_surfaces++;
    }
    assert_true(on_surfaces > 1000 && in_sky > 2000);
    const ppmi_surface box = world_hit(&world, vec3(0, -1.9f, 0), vec3(0, -1, 0));
    const ppmi_hit dark = {.instance = 0, .triangle = box.triangle};
    assert_near(ppmi_lights_pdf_surface(world.lights, &at, &dark, &box, vec3(0, -1, 0), 1.0f), 0,
                0);
}

/* The target lies off the light's surface, on the side that is lit. */
static void the_way_to_the_target_is_clear_of_the_light(void **state)
{
    (void)state;
    const ppm_material_id lamp = material_emitter(test.scene, 5.0f, 0.0f, true);
    add_quad(test.scene, lamp, vec3(99, 2, -1), vec3(2, 0, 0.3f), vec3(0, 0, 2));
    world_open(&world, &test);
    ppmi_rng rng = ppmi_rng_start(5, PPMI_STREAM_EYE, 0);
    for (int i = 0; i < 20000; i++) {
        const ppmi_vec3 p = vec3(99 + 2 * ppmi_rng_float(&rng), 1.999f * ppmi_rng_float(&rng),
                                 2 * ppmi_rng_float(&rng) - 1);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_light_sample s;
        if (!ppmi_lights_sample(world.lights, p, vec3(0, 1, 0), ppmi_rng_double(&rng), u, v, &s))
            continue;
        const ppmi_ray ray = {
            .origin = p, .t_max = 1.0f - 4e-6f, .direction = vec3_sub(s.target, p)};
        assert_false(ppmi_accel_occluded(world.accel, &ray));
    }
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_rectangular_light_gives_its_form_factor),
        WITH_SCENE(a_point_light_falls_off_by_the_square),
        WITH_SCENE(a_spot_light_has_its_cones),
        WITH_SCENE(a_directional_light_is_the_same_everywhere),
        WITH_SCENE(a_constant_environment_gives_pi),
        WITH_SCENE(lights_of_all_kinds_add_up),
        WITH_SCENE(the_density_of_a_sample_is_that_of_its_surface),
        WITH_SCENE(the_way_to_the_target_is_clear_of_the_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
