/* Lights with an extent, against formulas: what arrives at a point, what photons carry, what rays
 * meet. */
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
    /* something for the light to fall on: a floor that faces up */
    add_quad(test.scene, 0, vec3(-2, 0, -2), vec3(0, 0, 4), vec3(4, 0, 0));
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

/* Shines down from position. */
static ppm_light_desc lamp_above(int32_t kind, float x, float y, float z)
{
    return (ppm_light_desc){.size = sizeof(ppm_light_desc),
                            .kind = kind,
                            .transform = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, x, y, z, 1},
                            .intensity = {1.0f, 2.0f, 3.0f}};
}

static ppm_light_id add_light(const ppm_light_desc *desc)
{
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(test.scene, desc, &id), PPM_STATUS_OK);
    return id;
}

/* Irradiance at a point of normal n by light sampling, in green; each seed a mean of its own. */
static test_mean irradiance(ppmi_vec3 position, ppmi_vec3 n)
{
    test_mean mean = {0};
    for (uint64_t seed = 1; seed <= 16; seed++) {
        const uint32_t count = TEST_EFFORT(4096);
        double sum = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            const ppmi_sample4 at = ppmi_sobol4(i, 0, seed);
            ppmi_light_sample sample;
            if (!ppmi_lights_sample(world.lights, position, n, 0.5, ppmi_unit_float(at.bits[0]),
                                    ppmi_unit_float(at.bits[1]), &sample)) {
                continue;
            }
            assert_false(sample.is_delta);
            assert_near(vec3_length(sample.wi), 1.0, 1e-5);
            const float cosine = ppmi_max(vec3_dot(n, sample.wi), 0.0f);
            sum += (double)(sample.radiance.y * cosine / sample.pdf);
        }
        mean_add(&mean, sum / count);
    }
    return mean;
}

static void compare_irradiance(const char *name, ppmi_vec3 position, double expected)
{
    const test_mean mean = irradiance(position, vec3(0, 1, 0));
    mean_check_power(&mean, 0.01);
    family_add_mean(&family, &mean, expected, 2e-5 * expected, "%s", name);
}

/* A ball that is all above the horizon gives what its middle would: I cos / d^2. */
static void a_ball_gives_the_irradiance_of_its_middle(void **state)
{
    (void)state;
    ppm_light_desc lamp = lamp_above(PPM_LIGHT_POINT, 0.5f, 1.0f, 0.0f);
    lamp.radius_m = 0.4f;
    add_light(&lamp);
    world_open(&world, &test);
    compare_irradiance("below", vec3(0.5f, 0, 0), 2.0);
    compare_irradiance("aside", vec3(-0.5f, 0, 0.5f), 2.0 / pow(2.25, 1.5));
    compare_irradiance("close", vec3(0.5f, 0.59f, 0), 2.0 / (0.41 * 0.41));
    family_check(&family);
    world_close(&world);
}

/* From a disk of radius R at height h: pi L R^2 / (R^2 + h^2) on its axis. */
static void a_disk_gives_the_irradiance_of_the_formula_on_its_axis(void **state)
{
    (void)state;
    ppm_light_desc lamp = lamp_above(PPM_LIGHT_DISK, 0.0f, 0.8f, 0.0f);
    lamp.width_m = lamp.height_m = 1.2f;
    add_light(&lamp);
    world_open(&world, &test);
    compare_irradiance("disk", vec3_splat(0.0f), M_PI * 2.0 * 0.36 / (0.36 + 0.64));
    family_check(&family);
    world_close(&world);
}

/* Over the lamp's area, by midpoints: L h^2 / d^4 for a level lamp at height h. */
static double flat_irradiance(double half_x, double half_z, double height, bool is_ellipse)
{
    enum { STEPS = 800 };
    double sum = 0.0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        const double x = 2.0 * (i % STEPS + 0.5) / STEPS - 1.0;
        const double z = 2.0 * (i / STEPS + 0.5) / STEPS - 1.0;
        if (is_ellipse && x * x + z * z > 1.0) continue;
        const double d2 = x * x * half_x * half_x + z * z * half_z * half_z + height * height;
        sum += height * height / (d2 * d2);
    }
    return sum * 4.0 * half_x * half_z / ((double)STEPS * STEPS);
}

static void width_lies_along_x_and_height_along_y(void **state)
{
    (void)state;
    for (int32_t kind = PPM_LIGHT_RECTANGLE; kind <= PPM_LIGHT_DISK; kind++) {
        ppm_light_desc lamp = lamp_above(kind, 0.0f, 0.7f, 0.0f);
        lamp.width_m = 2.0f; /* local Y is the world's -Z here */
        lamp.height_m = 0.6f;
        const ppm_light_id id = add_light(&lamp);
        world_open(&world, &test);
        const test_mean mean = irradiance(vec3_splat(0.0f), vec3(0, 1, 0));
        const double exact = 2.0 * flat_irradiance(1.0, 0.3, 0.7, kind == PPM_LIGHT_DISK);
        family_add_mean(&family, &mean, exact, 2e-4 * exact, "kind %d", (int)kind);
        /* the ends of the long side are met, beyond those of the short side there is nothing */
        ppmi_lamp_hit along = {0}, across = {0};
        const ppmi_ray up[2] = {
            {.origin = vec3(0.9f, 0, 0), .t_max = INFINITY, .direction = vec3(0, 1, 0)},
            {.origin = vec3(0, 0, 0.9f), .t_max = INFINITY, .direction = vec3(0, 1, 0)}};
        assert_true(ppmi_lights_next_lamp(world.lights, &up[0], false, &along));
        assert_near(along.t, 0.7, 1e-6);
        assert_false(ppmi_lights_next_lamp(world.lights, &up[1], false, &across));
        world_close(&world);
        close_scene(NULL);
        const test_family kept = family;
        open_scene(NULL);
        family = kept;
        (void)id;
    }
    family_check(&family);
}

static void the_back_of_a_flat_lamp_is_dark_and_lets_rays_pass(void **state)
{
    (void)state;
    ppm_light_desc lamp = lamp_above(PPM_LIGHT_RECTANGLE, 0.0f, 1.0f, 0.0f);
    lamp.width_m = lamp.height_m = 1.0f;
    add_light(&lamp);
    world_open(&world, &test);
    const ppmi_ray down = {.origin = vec3(0, 2, 0), .t_max = INFINITY, .direction = vec3(0, -1, 0)};
    ppmi_lamp_hit hit = {0};
    assert_false(ppmi_lights_next_lamp(world.lights, &down, false, &hit));
    ppmi_light_sample sample;
    assert_false(
        ppmi_lights_sample(world.lights, vec3(0, 2, 0), vec3(0, -1, 0), 0.5, 0.5f, 0.5f, &sample));
    world_close(&world);
}

/* Nothing is met twice, not even lamps in one place. */
static void a_ray_meets_each_lamp_once_in_order(void **state)
{
    (void)state;
    ppm_light_desc lamp = lamp_above(PPM_LIGHT_RECTANGLE, 0.0f, 2.0f, 0.0f);
    lamp.width_m = lamp.height_m = 1.0f;
    add_light(&lamp);
    add_light(&lamp);
    lamp = lamp_above(PPM_LIGHT_POINT, 0.0f, 1.0f, 0.0f);
    lamp.radius_m = 0.25f;
    lamp.is_hidden = 1;
    add_light(&lamp);
    world_open(&world, &test);
    const ppmi_ray up = {.t_max = 10.0f, .direction = vec3(0, 1, 0)};
    const float places[3] = {0.75f, 2.0f, 2.0f};
    ppmi_lamp_hit hit = {0};
    for (int i = 0; i < 3; i++) {
        assert_true(ppmi_lights_next_lamp(world.lights, &up, false, &hit));
        assert_near(hit.t, places[i], 1e-6);
    }
    assert_near(hit.radiance.y, 2.0, 0.0);
    assert_false(ppmi_lights_next_lamp(world.lights, &up, false, &hit));
    hit = (ppmi_lamp_hit){0}; /* the camera does not see the hidden one */
    assert_true(ppmi_lights_next_lamp(world.lights, &up, true, &hit));
    assert_near(hit.t, 2.0, 1e-6);
    world_close(&world);
}

/* Directions that rays find by chance must get the density that light sampling has. */
static void densities_agree_with_the_draw(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        ppm_light_desc lamp = lamp_above(kind == 0   ? PPM_LIGHT_SPOT
                                         : kind == 1 ? PPM_LIGHT_RECTANGLE
                                                     : PPM_LIGHT_DISK,
                                         0.3f, 1.0f, -0.2f);
        lamp.inner_cone_rad = lamp.outer_cone_rad = 1.0f;
        lamp.radius_m = 0.3f;
        lamp.width_m = 0.5f;
        lamp.height_m = 0.9f;
        add_light(&lamp);
        world_open(&world, &test);
        for (uint32_t i = 0; i < 256; i++) {
            const ppmi_sample4 at = ppmi_sobol4(i, 0, 7);
            const ppmi_vec3 position = vec3(0.1f, 0.0f, 0.2f);
            ppmi_light_sample sample;
            assert_true(ppmi_lights_sample(world.lights, position, vec3(0, 1, 0), 0.5,
                                           ppmi_unit_float(at.bits[0]), ppmi_unit_float(at.bits[1]),
                                           &sample));
            const ppmi_ray ray = {.origin = position, .t_max = INFINITY, .direction = sample.wi};
            ppmi_lamp_hit hit = {0};
            if (!ppmi_lights_next_lamp(world.lights, &ray, false, &hit)) continue; /* the rim */
            const ppmi_receiver receiver = {.position = position, .normal = vec3(0, 1, 0)};
            const float pdf =
                ppmi_lights_pdf_lamp(world.lights, &receiver, hit.lamp, sample.wi, hit.t);
            assert_near(pdf / sample.pdf, 1.0, 1e-4);
            assert_near(hit.radiance.y / sample.radiance.y, 1.0, 1e-3);
            const ppmi_vec3 target = vec3_mad(position, sample.wi, hit.t);
            assert_near(vec3_length(vec3_sub(target, sample.target)), 0.0, 1e-4);
        }
        world_close(&world);
        close_scene(NULL);
        open_scene(NULL);
    }
}

/* ---- photons --------------------------------------------------------------------------------- */

static void compare_flux(const char *name, double expected)
{
    test_mean mean = {0};
    for (uint64_t seed = 1; seed <= 16; seed++) {
        const uint32_t count = TEST_EFFORT(4096);
        double sum = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            const ppmi_sample4 at = ppmi_sobol4(i, 0, seed);
            float u[4];
            for (int k = 0; k < 4; k++)
                u[k] = ppmi_unit_float(at.bits[k]);
            ppmi_emission emission;
            if (!ppmi_lights_emit(world.lights, ppmi_sobol1(i, 0, seed), u, &emission)) continue;
            sum += (double)emission.power.y;
        }
        mean_add(&mean, sum / count);
    }
    family_add_mean(&family, &mean, expected, 1e-5 * expected, "%s", name);
}

static void photons_carry_the_flux_of_each_kind(void **state)
{
    (void)state;
    const struct {
        const char *name;
        int32_t kind;
        double flux;
    } rows[] = {
        {"ball", PPM_LIGHT_POINT, 8.0 * M_PI},
        {"spot", PPM_LIGHT_SPOT, 4.0 * M_PI * ((1.0 - cos(0.5)) + (cos(0.5) - cos(0.8)) / 3.0)},
        {"rectangle", PPM_LIGHT_RECTANGLE, 2.0 * M_PI * 0.5 * 0.8},
        {"disk", PPM_LIGHT_DISK, 2.0 * M_PI * M_PI * 0.25 * 0.4},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        ppm_light_desc lamp = lamp_above(rows[i].kind, 0.0f, 0.5f, 0.0f);
        lamp.radius_m = 0.2f;
        lamp.width_m = 0.5f;
        lamp.height_m = 0.8f;
        lamp.inner_cone_rad = 0.5f;
        lamp.outer_cone_rad = 0.8f;
        add_light(&lamp);
        world_open(&world, &test);
        compare_flux(rows[i].name, rows[i].flux);
        world_close(&world);
        close_scene(NULL);
        const test_family kept = family;
        open_scene(NULL);
        family = kept;
    }
    family_check(&family);
}

/* ---- bad input ------------------------------------------------------------------------------- */

static void sizes_out_of_range_are_refused(void **state)
{
    (void)state;
    const float bad[] = {-1.0f, NAN, INFINITY, 1e30f};
    ppm_light_id id = 77;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        ppm_light_desc lamp = lamp_above(PPM_LIGHT_POINT, 0, 1, 0);
        lamp.radius_m = bad[i];
        assert_int_equal(ppm_scene_add_light(test.scene, &lamp, &id), PPM_STATUS_INVALID_ARGUMENT);
        lamp = lamp_above(PPM_LIGHT_DISK, 0, 1, 0);
        lamp.width_m = 1.0f;
        lamp.height_m = bad[i];
        assert_int_equal(ppm_scene_add_light(test.scene, &lamp, &id), PPM_STATUS_INVALID_ARGUMENT);
    }
    ppm_light_desc flat = lamp_above(PPM_LIGHT_RECTANGLE, 0, 1, 0);
    assert_int_equal(ppm_scene_add_light(test.scene, &flat, &id), PPM_STATUS_INVALID_ARGUMENT);
    flat.kind = 5;
    assert_int_equal(ppm_scene_add_light(test.scene, &flat, &id), PPM_STATUS_INVALID_ARGUMENT);
    ppm_light_desc lamp = lamp_above(PPM_LIGHT_POINT, 0, 1, 0);
    lamp.profile = 1;
    assert_int_equal(ppm_scene_add_light(test.scene, &lamp, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(id, 77);
}

static void a_ball_of_hardly_any_size_is_a_point(void **state)
{
    (void)state;
    ppm_light_desc lamp = lamp_above(PPM_LIGHT_POINT, 0, 1, 0);
    lamp.radius_m = 1e-7f;
    add_light(&lamp);
    world_open(&world, &test);
    ppmi_light_sample sample;
    assert_true(ppmi_lights_sample(world.lights, vec3_splat(0.0f), vec3(0, 1, 0), 0.5, 0.5f, 0.5f,
                                   &sample));
    assert_true(sample.is_delta);
    assert_false(ppmi_lights_have_lamps(world.lights));
    world_close(&world);
}

static void a_light_can_be_replaced(void **state)
{
    (void)state;
    ppm_light_desc lamp = lamp_above(PPM_LIGHT_POINT, 0, 1, 0);
    const ppm_light_id id = add_light(&lamp);
    lamp.intensity[1] = 8.0f;
    lamp.name = "other";
    assert_int_equal(ppm_scene_set_light(test.scene, id + 1, &lamp), PPM_STATUS_INVALID_ARGUMENT);
    lamp.radius_m = -1.0f;
    assert_int_equal(ppm_scene_set_light(test.scene, id, &lamp), PPM_STATUS_INVALID_ARGUMENT);
    assert_near(test.scene->punctuals[0].intensity.y, 2.0, 0.0);
    lamp.radius_m = 0.0f;
    assert_int_equal(ppm_scene_set_light(test.scene, id, &lamp), PPM_STATUS_OK);
    assert_near(test.scene->punctuals[0].intensity.y, 8.0, 0.0);
    assert_string_equal(test.scene->punctuals[0].name, "other");
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(sizes_out_of_range_are_refused),
        CASE(a_ball_of_hardly_any_size_is_a_point),
        CASE(a_light_can_be_replaced),
        CASE(a_ball_gives_the_irradiance_of_its_middle),
        CASE(a_disk_gives_the_irradiance_of_the_formula_on_its_axis),
        CASE(width_lies_along_x_and_height_along_y),
        CASE(the_back_of_a_flat_lamp_is_dark_and_lets_rays_pass),
        CASE(a_ray_meets_each_lamp_once_in_order),
        CASE(densities_agree_with_the_draw),
        CASE(photons_carry_the_flux_of_each_kind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
