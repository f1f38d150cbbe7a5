/* Directional lights with a size: by light sampling, by sampling directions and by photons the same
 * light. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "light/sun.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;
static test_family family;

static const ppmi_vec3 nothing = {0.0f, 0.0f, 0.0f};

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    family = (test_family){0};
    /* something to shine on */
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

/* ---- the disk -------------------------------------------------------------------------------- */

static ppmi_sun sun_of(ppmi_vec3 direction, float radius)
{
    const ppmi_punctual light = {.kind = PPM_LIGHT_DIRECTIONAL,
                                 .direction = vec3_normalize(direction),
                                 .intensity = {1, 2, 3},
                                 .angular_radius_rad = radius};
    return ppmi_sun_of(&light);
}

/* A unit vector at an angle from the sun's middle, made with digits to spare. */
static ppmi_vec3 at_angle(const ppmi_sun *sun, double angle, double turn)
{
    const ppmi_vec3 local =
        vec3((float)(sin(angle) * cos(turn)), (float)(sin(angle) * sin(turn)), (float)cos(angle));
    return vec3_normalize(ppmi_frame_to_world(&sun->frame, local));
}

static const float radii[] = {1e-4f, 0.00465f, 0.1f, 1.5f};

static void the_disk_ends_at_its_radius(void **state)
{
    (void)state;
    world_open(&world, &test);
    for (int i = 0; i < 4; i++) {
        const ppmi_sun sun = sun_of(vec3(0.3f, -0.8f, 0.2f), radii[i]);
        const double step = 3e-7 + 1e-4 * (double)radii[i]; /* coordinates have 24 bits */
        for (int k = 0; k < 16; k++) {
            const double turn = k * M_PI / 8.0;
            assert_true(ppmi_sun_holds(&sun, at_angle(&sun, (double)radii[i] - step, turn)));
            assert_false(ppmi_sun_holds(&sun, at_angle(&sun, (double)radii[i] + step, turn)));
        }
        assert_true(ppmi_sun_holds(&sun, sun.frame.n));
        assert_false(ppmi_sun_holds(&sun, vec3_neg(sun.frame.n)));
        const double r = (double)radii[i];
        assert_near(sun.solid_angle / (4.0 * M_PI * pow(sin(0.5 * r), 2.0)), 1.0, 1e-5);
        assert_near(sun.radiance.y * (float)(M_PI * sin(r) * sin(r)), 2.0, 1e-4);
    }
}

static void directions_are_even_over_the_disk(void **state)
{
    (void)state;
    world_open(&world, &test);
    enum { RINGS = 8, SECTORS = 8, CELLS = RINGS * SECTORS };
    const uint32_t count = TEST_EFFORT(100000);
    for (int i = 0; i < 4; i++) {
        const ppmi_sun sun = sun_of(vec3(0.0f, -0.6f, 0.8f), radii[i]);
        double observed[CELLS] = {0.0}, expected[CELLS], off = 0.0;
        ppmi_rng rng = ppmi_rng_start((uint64_t)i, PPMI_STREAM_EYE, 0);
        for (uint32_t k = 0; k < count; k++) {
            const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
            const ppmi_vec3 d = ppmi_sun_sample(&sun, u, v);
            assert_near(vec3_length(d), 1.0, 1e-6);
            off += !ppmi_sun_holds(&sun, d);
            const ppmi_vec3 way = vec3_sub(d, sun.frame.n);
            const ppmi_vec3 local = ppmi_frame_to_local(&sun.frame, way);
            const double share = (double)(vec3_length2(way) / (2.0f * sun.height));
            const double turn = atan2((double)local.y, (double)local.x) / (2.0 * M_PI) + 0.5;
            const int ring = (int)(share * RINGS), sector = (int)(turn * SECTORS);
            observed[(ring < RINGS ? ring : RINGS - 1) * SECTORS + sector % SECTORS] += 1.0;
        }
        for (int k = 0; k < CELLS; k++)
            expected[k] = (double)count / CELLS;
        family_add(&family, p_counts(observed, expected, CELLS), "radius %g", (double)radii[i]);
        /* at the rim rounding decides: 1e-7 of a chord of 1e-4 */
        assert_true(off < 3e-3 * count);
    }
    family_check(&family);
}

static float density_of_far_light(ppmi_vec3 n, ppmi_vec3 wi)
{
    const ppmi_receiver at = {.position = nothing, .normal = n};
    return ppmi_lights_pdf_environment(world.lights, &at, wi);
}

/* ---- the same light in three ways ------------------------------------------------------------ */

/* Irradiance on a plane by light sampling; with n zero, the radiance of all directions. */
static test_mean by_light_sampling(ppmi_vec3 n, uint32_t count)
{
    test_mean mean = {0};
    ppmi_rng rng = ppmi_rng_start(family.count + 1, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < count; i++) {
        const double pick = ppmi_rng_double(&rng);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_light_sample s;
        double value = 0.0;
        if (ppmi_lights_sample(world.lights, nothing, n, pick, u, v, &s)) {
            assert_true(s.is_far && s.pdf > 0.0f && vec3_is_finite(s.radiance));
            assert_near(density_of_far_light(n, s.wi) / s.pdf, 1.0, 1e-3);
            assert_near(ppmi_lights_environment(world.lights, s.wi).y, s.radiance.y, 0.0);
            const float cosine = vec3_length2(n) > 0.0f ? vec3_dot(s.wi, n) : 1.0f;
            value = (double)(s.radiance.y * ppmi_max(cosine, 0.0f) / s.pdf);
        }
        mean_add(&mean, value);
    }
    return mean;
}

/* By directions with the density of the cosine, as a Lambert surface draws them. */
static test_mean by_bsdf_sampling(ppmi_vec3 n, uint32_t count)
{
    test_mean mean = {0};
    const ppmi_frame frame = ppmi_frame_from_normal(n);
    ppmi_rng rng = ppmi_rng_start(family.count + 1, PPMI_STREAM_EYE, 1);
    for (uint32_t i = 0; i < count; i++) {
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        const ppmi_vec3 wi = ppmi_frame_to_world(&frame, ppmi_sample_cosine_hemisphere(u, v));
        mean_add(&mean, M_PI * (double)ppmi_lights_environment(world.lights, wi).y);
    }
    return mean;
}

/* Both, weighed by the power heuristic. */
static test_mean by_both(ppmi_vec3 n, uint32_t count)
{
    test_mean mean = {0};
    const ppmi_frame frame = ppmi_frame_from_normal(n);
    ppmi_rng rng = ppmi_rng_start(family.count + 1, PPMI_STREAM_EYE, 2);
    for (uint32_t i = 0; i < count; i++) {
        const double pick = ppmi_rng_double(&rng);
        float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_light_sample s;
        float value = 0.0f;
        if (ppmi_lights_sample(world.lights, nothing, n, pick, u, v, &s)) {
            const float cosine = ppmi_max(vec3_dot(s.wi, n), 0.0f);
            value += s.radiance.y * cosine / s.pdf * ppmi_mis_weight(s.pdf, cosine * PPMI_INV_PI);
        }
        u = ppmi_rng_float(&rng);
        v = ppmi_rng_float(&rng);
        const ppmi_vec3 local = ppmi_sample_cosine_hemisphere(u, v);
        const ppmi_vec3 wi = ppmi_frame_to_world(&frame, local);
        const float pdf = local.z * PPMI_INV_PI;
        value += PPMI_PI * ppmi_lights_environment(world.lights, wi).y *
                 ppmi_mis_weight(pdf, density_of_far_light(n, wi));
        mean_add(&mean, (double)value);
    }
    return mean;
}

/* Through a small disk across n in the middle of the scene, by area. */
static test_mean by_photons(ppmi_vec3 n, uint32_t count)
{
    const ppmi_vec3 middle = {0.0f, -2.5f, 0.0f};
    const float r = 0.4f;
    test_mean mean = {0};
    for (uint64_t seed = 1; seed <= 16; seed++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < count / 16; i++) {
            const ppmi_sample4 sample = ppmi_sobol4(i, 0, seed);
            float u[4];
            for (int k = 0; k < 4; k++)
                u[k] = ppmi_unit_float(sample.bits[k]);
            ppmi_emission e;
            if (!ppmi_lights_emit(world.lights, ppmi_sobol1(i, 0, seed), u, &e)) continue;
            const float towards = -vec3_dot(e.ray.direction, n);
            if (!(towards > 0.0f)) continue;
            const float t = vec3_dot(vec3_sub(e.ray.origin, middle), n) / towards;
            const ppmi_vec3 p = vec3_mad(e.ray.origin, e.ray.direction, t);
            if (vec3_length(vec3_sub(p, middle)) < r) sum += (double)e.power.y;
        }
        mean_add(&mean, sum / (count / 16) / (M_PI * (double)(r * r)));
    }
    return mean;
}

static void compare_all_ways(const char *name, ppmi_vec3 n, double expected)
{
    const uint32_t count = TEST_EFFORT(200000);
    const test_mean means[] = {by_light_sampling(n, count), by_bsdf_sampling(n, 4 * count),
                               by_both(n, count), by_photons(n, 4 * count)};
    static const char *const ways[] = {"light sampling", "BSDF sampling", "both", "photons"};
    for (int i = 0; i < 4; i++) {
        mean_check_power(&means[i], 0.03);
        family_add_mean(&family, &means[i], expected, 2e-5 * expected, "%s by %s", name, ways[i]);
    }
}

static void a_disk_gives_its_lux_by_the_cosine(void **state)
{
    (void)state;
    light_sun(test.scene, vec3(0.3f, -0.8f, 0.52f), vec3(1, 7, 2), 0.2f);
    world_open(&world, &test);
    const ppmi_vec3 axis = vec3_normalize(vec3(-0.3f, 0.8f, -0.52f));
    compare_all_ways("facing", axis, 7.0);
    compare_all_ways("level", vec3(0, 1, 0), 7.0 * (double)axis.y);
    family_check(&family);
}

/* Too small for a BSDF to find by chance. */
static void the_size_of_the_sun_changes_no_lux(void **state)
{
    (void)state;
    light_sun(test.scene, vec3(3, -4, 0), vec3(1, 1e5f, 2), 0.00465f);
    world_open(&world, &test);
    const ppmi_vec3 up = vec3(0, 1, 0);
    const test_mean sampled = by_light_sampling(up, TEST_EFFORT(20000));
    const test_mean emitted = by_photons(up, TEST_EFFORT(400000));
    mean_check_power(&sampled, 1e-3);
    mean_check_power(&emitted, 0.02);
    family_add_mean(&family, &sampled, 8e4, 4.0, "light sampling");
    family_add_mean(&family, &emitted, 8e4, 4.0, "photons");
    family_check(&family);
}

static void disks_and_sky_add_up_where_they_overlap(void **state)
{
    (void)state;
    const float pixels[3 * 4 * 2] = {0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 2, 0,
                                     0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
    light_environment(test.scene, vec3_splat(1.0f), image_rgb(test.scene, 4, 2, pixels), 0.0f);
    light_sun(test.scene, vec3(0, -1, 0), vec3_splat(3.0f), 0.5f);
    light_sun(test.scene, vec3(0.3f, -1, 0), vec3_splat(2.0f), 0.3f);
    light_directional(test.scene, vec3(0, -1, 0), vec3_splat(0.0f));
    world_open(&world, &test);
    const ppmi_vec3 up = vec3(0, 1, 0);
    double sky = 0.0; /* the image by itself, on a fine grid of the disk: Malley's method */
    const int steps = 1000;
    for (int i = 0; i < steps * steps; i++) {
        const ppmi_vec3 d = ppmi_sample_cosine_hemisphere(((float)(i / steps) + 0.5f) / 1000.0f,
                                                          ((float)(i % steps) + 0.5f) / 1000.0f);
        float suns = 0.0f;
        const ppmi_vec3 wi = vec3(d.x, d.z, d.y);
        const ppmi_sun a = sun_of(vec3(0, -1, 0), 0.5f), b = sun_of(vec3(0.3f, -1, 0), 0.3f);
        if (ppmi_sun_holds(&a, wi)) suns += 1.5f * a.radiance.y;
        if (ppmi_sun_holds(&b, wi)) suns += b.radiance.y;
        sky += M_PI * (double)(ppmi_lights_environment(world.lights, wi).y - suns) / steps / steps;
    }
    compare_all_ways("all", up, sky + 3.0 + 2.0 / sqrt(1.09));
    family_check(&family);
}

static void a_constant_sky_adds_to_the_disk(void **state)
{
    (void)state;
    light_environment(test.scene, vec3_splat(2.0f), 0, 0.0f);
    light_sun(test.scene, vec3(1, -1, 0), vec3_splat(5.0f), 0.15f);
    world_open(&world, &test);
    compare_all_ways("both", vec3(0, 1, 0), 2.0 * M_PI + 5.0 * sqrt(0.5));
    family_check(&family);
}

/* ---- in a medium ----------------------------------------------------------------------------- */

static void without_a_normal_every_direction_counts(void **state)
{
    (void)state;
    light_environment(test.scene, vec3_splat(2.0f), 0, 0.0f);
    light_sun(test.scene, vec3(1, -1, 0), vec3_splat(5.0f), 0.15f);
    light_sun(test.scene, vec3(1, 1, 0), vec3_splat(4.0f), 0.2f);
    world_open(&world, &test);
    const double disks =
        5.0 * 4.0 * pow(sin(0.075) / sin(0.15), 2.0) + 4.0 * 4.0 * pow(sin(0.1) / sin(0.2), 2.0);
    const test_mean mean = by_light_sampling(nothing, TEST_EFFORT(200000));
    mean_check_power(&mean, 0.01);
    family_add_mean(&family, &mean, 8.0 * M_PI + disks, 1e-3, "fluence");
    family_check(&family);
    /* away from the disks, half of the samples go evenly over the sphere */
    const float pdf = density_of_far_light(nothing, vec3(0, 0, 1));
    assert_near(pdf, 0.5 * 0.25 / M_PI, 1e-6);
}

static void without_a_normal_an_image_is_drawn_by_its_power(void **state)
{
    (void)state;
    const float pixels[3 * 4 * 2] = {0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 2, 0,
                                     0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
    light_environment(test.scene, vec3_splat(1.0f), image_rgb(test.scene, 4, 2, pixels), 0.0f);
    world_open(&world, &test);
    double fluence = 0.0;
    const int steps = 1000;
    for (int i = 0; i < steps * steps; i++) {
        const ppmi_vec3 d = ppmi_sample_sphere(((float)(i / steps) + 0.5f) / 1000.0f,
                                               ((float)(i % steps) + 0.5f) / 1000.0f);
        fluence += 4.0 * M_PI * (double)ppmi_lights_environment(world.lights, d).y / steps / steps;
    }
    const test_mean mean = by_light_sampling(nothing, TEST_EFFORT(200000));
    mean_check_power(&mean, 0.01);
    family_add_mean(&family, &mean, fluence, 1e-4 * fluence, "fluence");
    family_check(&family);
}

/* ---- the camera ------------------------------------------------------------------------------ */

static void the_camera_sees_the_disk_unless_there_is_a_backdrop(void **state)
{
    (void)state;
    light_sun(test.scene, vec3(0, 0, 1), vec3_splat(5.0f), 0.1f);
    world_open(&world, &test);
    const double radiance = 5.0 / (M_PI * pow(sin(0.1), 2.0));
    assert_near(ppmi_lights_backdrop(world.lights, vec3(0, 0, -1)).y, radiance, 1e-3);
    assert_near(ppmi_lights_backdrop(world.lights, vec3(0, 0.6f, -0.8f)).y, 0.0, 0.0);
    test.scene->environment.has_backdrop = true;
    test.scene->environment.backdrop = vec3_splat(0.25f);
    assert_near(ppmi_lights_backdrop(world.lights, vec3(0, 0, -1)).y, 0.25, 0.0);
    assert_near(ppmi_lights_environment(world.lights, vec3(0, 0, -1)).y, radiance, 1e-3);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(the_disk_ends_at_its_radius),
        WITH_SCENE(directions_are_even_over_the_disk),
        WITH_SCENE(a_disk_gives_its_lux_by_the_cosine),
        WITH_SCENE(the_size_of_the_sun_changes_no_lux),
        WITH_SCENE(disks_and_sky_add_up_where_they_overlap),
        WITH_SCENE(a_constant_sky_adds_to_the_disk),
        WITH_SCENE(without_a_normal_every_direction_counts),
        WITH_SCENE(without_a_normal_an_image_is_drawn_by_its_power),
        WITH_SCENE(the_camera_sees_the_disk_unless_there_is_a_backdrop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
