/* Photons carry the flux of their lights: mean power against what the light sends, by hand. */
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
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static bool emit(uint64_t seed, uint32_t i, ppmi_emission *emission)
{
    const ppmi_sample4 sample = ppmi_sobol4(i, 0, seed);
    float u[4];
    for (int k = 0; k < 4; k++)
        u[k] = ppmi_unit_float(sample.bits[k]);
    return ppmi_lights_emit(world.lights, ppmi_sobol1(i, 0, seed), u, emission);
}

/* Power that enters a ball, in one channel; every photon when the radius is infinite. */
static double power_into(ppmi_vec3 center, float radius, uint32_t count, uint64_t seed, int channel)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        ppmi_emission emission;
        if (!emit(seed, i, &emission)) continue;
        assert_true(vec3_is_finite(emission.power) && vec3_is_finite(emission.ray.origin));
        assert_near(vec3_length(emission.ray.direction), 1.0, 1e-5);
        const ppmi_vec3 to_center = vec3_sub(center, emission.ray.origin);
        const float along = vec3_dot(to_center, emission.ray.direction);
        const ppmi_vec3 off = vec3_sub(to_center, vec3_scale(emission.ray.direction, along));
        const bool is_hit = isinf(radius) || (along > 0.0f && vec3_length(off) < radius);
        if (is_hit) {
            sum += (double)(channel == 0   ? emission.power.x
                            : channel == 1 ? emission.power.y
                                           : emission.power.z);
        }
    }
    return sum / count;
}

/* Several randomised sets of photons, each a mean of its own. */
static void compare(const char *name, ppmi_vec3 center, float radius, const double expected[3])
{
    for (int channel = 0; channel < 3; channel++) {
        test_mean mean = {0};
        for (uint64_t seed = 1; seed <= 16; seed++) {
            mean_add(&mean, power_into(center, radius, TEST_EFFORT(8192), seed, channel));
        }
        mean_check_power(&mean, 0.015);
        family_add_mean(&family, &mean, expected[channel], 1e-5 * expected[channel],
                        "%s, channel %d", name, channel);
    }
}

/* A ball of the given radius as the whole scene, so that photons that enter it can be counted. */
static void add_target(float radius)
{
    shape_place(test.scene, shape_sphere(test.scene, 0, radius, 16, false));
}

static void a_point_light_inside_sends_4_pi(void **state)
{
    (void)state;
    add_target(2.0f);
    light_point(test.scene, vec3(0.3f, 0.2f, -0.5f), vec3(1.0f, 2.0f, 5.0f));
    world_open(&world, &test);
    const double flux[3] = {4 * M_PI, 8 * M_PI, 20 * M_PI};
    compare("point", vec3_splat(0.0f), INFINITY, flux);
    family_check(&family);
    world_close(&world);
}

/* From outside, photons are aimed at the scene, and what arrives must not change by that. */
static void a_point_light_outside_lights_what_it_sees(void **state)
{
    (void)state;
    add_target(2.0f);
    light_point(test.scene, vec3(0.0f, 8.0f, 6.0f), vec3(1.0f, 2.0f, 5.0f));
    world_open(&world, &test);
    const double solid_angle = 2.0 * M_PI * (1.0 - sqrt(1.0 - 4.0 / 100.0));
    const double flux[3] = {solid_angle, 2.0 * solid_angle, 5.0 * solid_angle};
    compare("point outside", vec3_splat(0.0f), 2.0f, flux);
    family_check(&family);
    world_close(&world);
}

/* KHR_lights_punctual: ((cos - cos outer) / (cos inner - cos outer))^2 between the cones. */
static double spot_flux(double inner, double outer)
{
    double sum = 0.0;
    const int steps = 200000;
    for (int i = 0; i < steps; i++) {
        const double theta = outer * (i + 0.5) / steps;
        double x = (cos(theta) - cos(outer)) / (cos(inner) - cos(outer));
        x = x > 1.0 ? 1.0 : x;
        sum += 2.0 * M_PI * sin(theta) * x * x * outer / steps;
    }
    return sum;
}

static void a_spot_light_sends_its_falloff(void **state)
{
    (void)state;
    const double cones[3][2] = {{0.2, 0.6}, {0.0, 1.5}, {0.3999, 0.4}};
    for (int i = 0; i < 3; i++) {
        scene_close(&test);
        scene_open(&test);
        add_target(2.0f);
        light_spot(test.scene, vec3(0.0f, 5.0f, 0.0f), vec3(1.0f, 0.0f, 0.0f),
                   vec3(3.0f, 1.0f, 0.5f), (float)cones[i][0], (float)cones[i][1]);
        world_open(&world, &test);
        const double flux = spot_flux(cones[i][0], cones[i][1]);
        const double fluxes[3] = {3.0 * flux, flux, 0.5 * flux};
        compare("spot", vec3_splat(0.0f), INFINITY, fluxes);
        world_close(&world);
    }
    family_check(&family);
}

/* The falloff itself: counts of photons by angle. */
static void a_spot_light_sends_more_where_it_is_brighter(void **state)
{
    (void)state;
    add_target(1.0f);
    const double inner = 0.3, outer = 0.9;
    light_spot(test.scene, vec3_splat(0.0f), vec3(0.0f, -1.0f, 1.0f), vec3_splat(1.0f),
               (float)inner, (float)outer);
    world_open(&world, &test);
    enum { BINS = 30 };
    double observed[BINS] = {0.0}, expected[BINS];
    const uint32_t count = TEST_EFFORT(200000);
    const ppmi_vec3 axis = vec3_normalize(vec3(0.0f, -1.0f, 1.0f));
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_PHOTON, 0);
    for (uint32_t i = 0; i < count; i++) {
        float u[4];
        for (int k = 0; k < 4; k++)
            u[k] = ppmi_rng_float(&rng);
        ppmi_emission emission;
        assert_true(ppmi_lights_emit(world.lights, ppmi_rng_double(&rng), u, &emission));
        const double angle = acos(fmin(1.0, (double)vec3_dot(emission.ray.direction, axis)));
        const int bin = (int)(angle / outer * BINS);
        observed[bin < BINS ? bin : BINS - 1] += 1.0;
    }
    const double flux = spot_flux(inner, outer);
    for (int i = 0; i < BINS; i++) {
        expected[i] = 0.0;
        for (int k = 0; k < 1000; k++) {
            const double theta = outer * (i + (k + 0.5) / 1000.0) / BINS;
            double x = (cos(theta) - cos(outer)) / (cos(inner) - cos(outer));
            x = x > 1.0 ? 1.0 : x;
            expected[i] += 2.0 * M_PI * sin(theta) * x * x * outer / BINS / 1000.0 / flux * count;
        }
    }
    family_add(&family, p_counts(observed, expected, BINS), "falloff");
    family_check(&family);
    world_close(&world);
}

static void a_directional_light_lights_a_disk(void **state)
{
    (void)state;
    add_target(2.0f);
    light_directional(test.scene, vec3(1.0f, -2.0f, 0.5f), vec3(1.0f, 2.0f, 5.0f));
    world_open(&world, &test);
    const double area = M_PI * 0.8 * 0.8;
    const double flux[3] = {area, 2.0 * area, 5.0 * area};
    compare("directional", vec3(0.5f, -0.5f, 0.5f), 0.8f, flux);
    family_check(&family);
    world_close(&world);
}

static void an_emitter_sends_pi_from_each_side(void **state)
{
    (void)state;
    for (int sides = 1; sides <= 2; sides++) {
        scene_close(&test);
        scene_open(&test);
        const ppm_material_id lamp = material_emitter(test.scene, 7.0f, 0.0f, sides == 2);
        const float stretched[16] = {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, -3, 0, 1, 1, 1, 1};
        shape_place_by(
            test.scene,
            shape_quad(test.scene, lamp, vec3_splat(0.0f), vec3(1, 0, 0), vec3(0, 0.5f, 1)),
            stretched);
        world_open(&world, &test);
        const double area = 2.0 * sqrt(0.25 + 9.0), flux = 7.0 * M_PI * area * sides;
        const double fluxes[3] = {flux, flux, flux};
        compare(sides == 2 ? "two sides" : "one side", vec3_splat(0.0f), INFINITY, fluxes);
        /* and from the right side(s) only */
        const ppmi_surface front = world_hit(&world, vec3(2.0f, 1.25f, -5.0f), vec3(0, 0, 1));
        uint32_t behind = 0;
        for (uint32_t i = 0; i < 1000; i++) {
            ppmi_emission emission;
            assert_true(emit(99, i, &emission));
            behind += vec3_dot(emission.ray.direction, front.ng) < 0.0f;
        }
        if (sides == 1) assert_int_equal(behind, 0);
        if (sides == 2) assert_in_range(behind, 450, 550);
        world_close(&world);
    }
    family_check(&family);
}

static void an_emitter_of_part_opacity_sends_that_part(void **state)
{
    (void)state;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    vec3_store(desc.emission, vec3_splat(4.0f));
    desc.alpha_mode = PPM_ALPHA_BLEND;
    desc.base_color[3] = 0.25f;
    desc.double_sided = 0;
    add_quad(test.scene, material_add(test.scene, &desc), vec3_splat(0.0f), vec3(1, 0, 0),
             vec3(0, 1, 0));
    world_open(&world, &test);
    const double fluxes[3] = {M_PI, M_PI, M_PI};
    compare("a quarter opaque", vec3_splat(0.0f), INFINITY, fluxes);
    family_check(&family);
    world_close(&world);
}

/* The mean of Schlick's Fresnel term, weighted by the cosine, is F0 + (1 - F0) / 21. */
static void an_emitter_under_a_clearcoat_sends_what_the_coat_leaves(void **state)
{
    (void)state;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    vec3_store(desc.emission, vec3_splat(4.0f));
    desc.clearcoat = 1.0f;
    desc.double_sided = 0;
    add_quad(test.scene, material_add(test.scene, &desc), vec3_splat(0.0f), vec3(1, 0, 0),
             vec3(0, 1, 0));
    world_open(&world, &test);
    const double left = 4.0 * M_PI * (1.0 - 0.04 - 0.96 / 21.0);
    const double fluxes[3] = {left, left, left};
    compare("coated", vec3_splat(0.0f), INFINITY, fluxes);
    family_check(&family);
    world_close(&world);
}

static void a_textured_emitter_sends_the_mean_of_its_texture(void **state)
{
    (void)state;
    float pixels[3 * 16 * 16];
    double mean[3] = {0.0};
    for (int i = 0; i < 3 * 256; i++) {
        pixels[i] = i / 3 % 7 == 0 ? (float)(i % 5) : 0.0f;
        mean[i % 3] += (double)pixels[i] / 256.0;
    }
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    vec3_store(desc.emission, vec3_splat(2.0f));
    desc.emission_texture.image = image_rgb(test.scene, 16, 16, pixels);
    desc.double_sided = 0;
    add_quad(test.scene, material_add(test.scene, &desc), vec3_splat(0.0f), vec3(3, 0, 0),
             vec3(0, 1, 0));
    world_open(&world, &test);
    const double fluxes[3] = {6.0 * M_PI * mean[0], 6.0 * M_PI * mean[1], 6.0 * M_PI * mean[2]};
    compare("textured", vec3_splat(0.0f), INFINITY, fluxes);
    family_check(&family);
    world_close(&world);
}

/* An isotropic field of radiance L sends L times a ball's projected area, in every direction:
 * pi r^2 * 4 pi L. */
static void a_constant_environment_fills_the_scene(void **state)
{
    (void)state;
    add_target(2.0f);
    light_environment(test.scene, vec3(1.0f, 2.0f, 0.5f), 0, 0.0f);
    world_open(&world, &test);
    const double flux = M_PI * 4.0 * 4.0 * M_PI;
    const double whole[3] = {flux, 2.0 * flux, 0.5 * flux};
    compare("constant", vec3_splat(0.0f), 1.9999f,
            (double[3]){whole[0] * 0.9999, whole[1] * 0.9999, whole[2] * 0.9999});
    const double part[3] = {flux / 16, flux / 8, flux / 32};
    compare("constant, small ball", vec3(0.7f, -0.7f, 0.7f), 0.5f, part);
    family_check(&family);
    world_close(&world);
}

static void an_environment_image_sends_its_integral(void **state)
{
    (void)state;
    enum { WIDTH = 32, HEIGHT = 16 };
    float pixels[3 * WIDTH * HEIGHT];
    double integral[3] = {0.0};
    for (int y = 0; y < HEIGHT; y++) {
        const double solid_angle =
            2.0 * M_PI / WIDTH * (cos(M_PI * y / HEIGHT) - cos(M_PI * (y + 1) / HEIGHT));
        for (int x = 0; x < WIDTH; x++) {
            for (int k = 0; k < 3; k++) {
                float *p = &pixels[3 * (y * WIDTH + x) + k];
                *p = 1.0f + 0.5f * sinf((float)(k + 1) * (float)x * 0.19635f) + 0.1f * (float)y;
                integral[k] += (double)*p * solid_angle;
            }
        }
    }
    add_target(2.0f);
    light_environment(test.scene, vec3(1.0f, 2.0f, 3.0f),
                      image_rgb(test.scene, WIDTH, HEIGHT, pixels), 0.7f);
    world_open(&world, &test);
    const double area = M_PI * 0.25;
    /* texels are filtered: pole rows change by less than 0.1 over half a texel, weighed by 1/16 of
     * the sphere at each pole */
    double flux[3];
    for (int k = 0; k < 3; k++)
        flux[k] = (k + 1) * integral[k] * area;
    for (int channel = 0; channel < 3; channel++) {
        test_mean mean = {0};
        for (uint64_t seed = 1; seed <= 16; seed++) {
            mean_add(&mean,
                     power_into(vec3(0.7f, 0.2f, 0.3f), 0.5f, TEST_EFFORT(20000), seed, channel));
        }
        family_add_mean(&family, &mean, flux[channel], 2e-3 * flux[channel], "channel %d", channel);
    }
    family_check(&family);
    world_close(&world);
}

static void several_lights_add_up(void **state)
{
    (void)state;
    add_target(2.0f);
    const ppm_material_id lamp = material_emitter(test.scene, 2.0f, 0.0f, false);
    add_quad(test.scene, lamp, vec3(-0.5f, 0, 0), vec3(0, 0, 1), vec3(1, 0, 0));
    light_point(test.scene, vec3_splat(0.1f), vec3(1.0f, 0.0f, 0.0f));
    light_point(test.scene, vec3_splat(-0.1f), vec3(0.0f, 0.01f, 100.0f));
    light_point(test.scene, vec3_splat(-0.1f), vec3_splat(0.0f));
    world_open(&world, &test);
    const double quad = 2.0 * M_PI;
    const double flux[3] = {4 * M_PI + quad, 0.04 * M_PI + quad, 400.0 * M_PI + quad};
    for (int channel = 0; channel < 3; channel++) {
        test_mean mean = {0};
        for (uint64_t seed = 1; seed <= 16; seed++) {
            mean_add(&mean,
                     power_into(vec3_splat(0.0f), INFINITY, TEST_EFFORT(20000), seed, channel));
        }
        family_add_mean(&family, &mean, flux[channel], 1e-5 * flux[channel], "channel %d", channel);
    }
    family_check(&family);
    world_close(&world);
}

static void without_lights_nothing_is_sent(void **state)
{
    (void)state;
    add_target(1.0f);
    world_open(&world, &test);
    ppmi_emission emission;
    assert_int_equal(ppmi_lights_count(world.lights), 0);
    assert_false(emit(0, 0, &emission));
    ppmi_light_sample sample;
    assert_false(ppmi_lights_sample(world.lights, vec3_splat(0.0f), vec3(0, 1, 0), 0.5, 0.5f, 0.5f,
                                    &sample));
    world_close(&world);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_point_light_inside_sends_4_pi),
        WITH_SCENE(a_point_light_outside_lights_what_it_sees),
        WITH_SCENE(a_spot_light_sends_its_falloff),
        WITH_SCENE(a_spot_light_sends_more_where_it_is_brighter),
        WITH_SCENE(a_directional_light_lights_a_disk),
        WITH_SCENE(an_emitter_sends_pi_from_each_side),
        WITH_SCENE(an_emitter_of_part_opacity_sends_that_part),
        WITH_SCENE(an_emitter_under_a_clearcoat_sends_what_the_coat_leaves),
        WITH_SCENE(a_textured_emitter_sends_the_mean_of_its_texture),
        WITH_SCENE(a_constant_environment_fills_the_scene),
        WITH_SCENE(an_environment_image_sends_its_integral),
        WITH_SCENE(several_lights_add_up),
        WITH_SCENE(without_lights_nothing_is_sent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
