/* Emission towards targets: whatever they are, each place gets the light that it gets without. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "light/aim.h"
#include "light/target.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;

/* A flat world, 20 m wide, whose targets are small: one by itself, one within a wide one. */
static const ppmi_target targets[] = {
    {{2.0f, 0.3f, 1.0f}, {0.2f, 0.3f, 0.2f}},
    {{-3.0f, 0.5f, -2.0f}, {0.5f, 0.2f, 0.4f}},
    {{-2.0f, 0.2f, -1.0f}, {3.0f, 0.6f, 2.0f}},
};
enum { TARGETS = sizeof targets / sizeof *targets };
static const double shares[TARGETS + 1] = {0.3, 0.25, 0.25, 0.2};

/* Balls whose light is counted: in a target, across its rim, across two, in none. */
typedef struct probe {
    ppmi_vec3 center;
    float radius;
} probe;
static const probe probes[] = {
    {{2.0f, 0.3f, 1.0f}, 0.1f},   {{2.2f, 0.4f, 1.0f}, 0.3f},  {{-3.0f, 0.5f, -2.0f}, 0.3f},
    {{-2.4f, 0.4f, -1.7f}, 0.5f}, {{5.0f, 0.5f, -4.0f}, 0.7f}, {{0.0f, 0.0f, 0.0f}, 20.0f},
};
enum { PROBES = sizeof probes / sizeof *probes };

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    shape_place(test.scene, shape_box(test.scene, grey, vec3(-10.0f, 0.0f, -10.0f),
                                      vec3(10.0f, 1.0f, 10.0f), 1, false));
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static ppm_light_id add(ppm_light_desc desc, ppmi_vec3 position)
{
    desc.size = sizeof desc;
    /* -z, along which a light shines, is down */
    const float transform[16] = {1, 0, 0, 0, 0,          0,          -1,         0,
                                 0, 1, 0, 0, position.x, position.y, position.z, 1};
    for (int i = 0; i < 16; i++)
        desc.transform[i] = transform[i];
    for (int i = 0; i < 3; i++)
        desc.intensity[i] = 1.0f + (float)i;
    ppm_light_id id = 0;
    assert_int_equal(ppm_scene_add_light(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

static bool meets(const probe *p, const ppmi_ray *ray)
{
    const ppmi_vec3 way = vec3_sub(p->center, ray->origin);
    const float along = vec3_dot(way, ray->direction);
    const ppmi_vec3 off = vec3_mad(way, ray->direction, -along);
    return along > 0.0f && vec3_length2(off) < p->radius * p->radius;
}

/* Power into each probe by one set of photons. */
static void count(const ppmi_aim *aim, uint64_t seed, uint32_t photons, double powers[PROBES])
{
    for (int k = 0; k < PROBES; k++)
        powers[k] = 0.0;
    for (uint32_t i = 0; i < photons; i++) {
        const ppmi_sample4 sample = ppmi_sobol4(i, 0, seed);
        float u[4];
        for (int k = 0; k < 4; k++)
            u[k] = ppmi_unit_float(sample.bits[k]);
        const double pick = ppmi_sobol1(i, 0, seed);
        ppmi_emission emission;
        const bool is_there = aim ? ppmi_aim_emit(aim, 0.0f, pick, u, &emission)
                                  : ppmi_lights_emit(world.lights, pick, u, &emission);
        if (!is_there) continue;
        assert_true(vec3_is_finite(emission.power) && vec3_is_finite(emission.ray.origin));
        assert_near(vec3_length(emission.ray.direction), 1.0, 1e-5);
        for (int k = 0; k < PROBES; k++) {
            if (meets(&probes[k], &emission.ray)) powers[k] += (double)vec3_mean(emission.power);
        }
    }
    for (int k = 0; k < PROBES; k++)
        powers[k] /= photons;
}

/* Compares powers by aimed and by even photons, which are means of independent sets. */
static void compare(const char *name)
{
    enum { SETS = 24 };
    world_open(&world, &test);
    ppmi_aim *aim = NULL;
    assert_int_equal(ppmi_aim_create(test.context, world.lights, targets, shares, TARGETS, &aim),
                     PPM_STATUS_OK);
    test_family family = {0};
    test_mean differences[PROBES] = {{0}}, aimed[PROBES] = {{0}};
    for (uint64_t set = 0; set < SETS; set++) {
        double by_aim[PROBES], evenly[PROBES];
        count(aim, 100 + set, TEST_EFFORT(24000), by_aim);
        count(NULL, 200 + set, TEST_EFFORT(48000), evenly);
        for (int k = 0; k < PROBES; k++) {
            mean_add(&differences[k], by_aim[k] - evenly[k]);
            mean_add(&aimed[k], by_aim[k]);
        }
    }
    for (int k = 0; k < PROBES; k++) {
        if (aimed[k].mean > 0.0) mean_check_power(&aimed[k], k % 2 == 0 && k < 4 ? 0.03 : 0.12);
        /* rays at the rim of a target are told apart by their rounded origins */
        family_add_mean(&family, &differences[k], 0.0, 2e-4 * aimed[k].mean, "%s, probe %d", name,
                        k);
    }
    family_check(&family);
    ppmi_aim_destroy(aim);
    world_close(&world);
}

static void a_point_sends_what_it_did(void **state)
{
    (void)state;
    add((ppm_light_desc){.kind = PPM_LIGHT_POINT}, vec3(1.0f, 2.0f, 0.0f));
    compare("point");
}

static void a_ball_sends_what_it_did(void **state)
{
    (void)state;
    add((ppm_light_desc){.kind = PPM_LIGHT_POINT, .radius_m = 0.1f}, vec3(1.0f, 2.0f, 0.0f));
    compare("ball");
}

static void a_ball_larger_than_the_target_sends_what_it_did(void **state)
{
    (void)state;
    add((ppm_light_desc){.kind = PPM_LIGHT_POINT, .radius_m = 0.8f}, vec3(1.0f, 2.5f, 0.0f));
    compare("large ball");
}

static void a_lamp_in_a_target_sends_what_it_did(void **state)
{
    (void)state;
    add((ppm_light_desc){.kind = PPM_LIGHT_POINT}, vec3(-2.0f, 0.4f, -1.0f));
    compare("inside");
}

static void spots_send_what_they_did(void **state)
{
    (void)state;
    add((ppm_light_desc){.kind = PPM_LIGHT_SPOT, .inner_cone_rad = 0.5f, .outer_cone_rad = 1.2f},
        vec3(1.0f, 2.0f, 0.0f));
    add((ppm_light_desc){.kind = PPM_LIGHT_SPOT, .inner_cone_rad = 0.0f, .outer_cone_rad = 0.4f},
        vec3(-2.5f, 3.0f, -1.5f));
    compare("spots");
}

static void flat_lamps_send_what_they_did(void **state)
{
    (void)state;
    add((ppm_light_desc){.kind = PPM_LIGHT_RECTANGLE, .width_m = 1.0f, .height_m = 0.5f},
        vec3(1.0f, 2.0f, 0.0f));
    add((ppm_light_desc){.kind = PPM_LIGHT_DISK, .width_m = 0.4f, .height_m = 0.4f},
        vec3(-2.0f, 2.0f, -1.0f));
    compare("flat lamps");
}

static void shining_surfaces_send_what_they_did(void **state)
{
    (void)state;
    const ppm_material_id one = material_emitter(test.scene, 5.0f, 0.0f, false);
    const ppm_material_id both = material_emitter(test.scene, 3.0f, 0.0f, true);
    add_quad(test.scene, one, vec3(0.0f, 3.0f, 0.0f), vec3(1.0f, 0, 0), vec3(0, 0, 1.0f));
    add_quad(test.scene, both, vec3(-4.0f, 1.5f, 0.0f), vec3(1.0f, 0.5f, 0), vec3(0, 0.3f, 1.0f));
    compare("surfaces");
}

static void parallel_light_sends_what_it_did(void **state)
{
    (void)state;
    light_directional(test.scene, vec3_normalize(vec3(0.5f, -1.0f, 0.3f)), vec3_splat(2.0f));
    compare("directional");
}

static void a_sun_sends_what_it_did(void **state)
{
    (void)state;
    light_sun(test.scene, vec3_normalize(vec3(-1.0f, -0.6f, 0.3f)), vec3_splat(2.0f), 0.05f);
    compare("sun");
}

static void a_sky_sends_what_it_did(void **state)
{
    (void)state;
    enum { WIDTH = 16, HEIGHT = 8 };
    float pixels[WIDTH * HEIGHT * 3];
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        pixels[i] = (i / 3) % 7 == 0 ? 3.0f : 0.4f;
    light_environment(test.scene, vec3_splat(1.0f), image_rgb(test.scene, WIDTH, HEIGHT, pixels),
                      0.7f);
    compare("sky");
}

static void an_even_sky_in_fog_sends_what_it_did(void **state)
{
    (void)state;
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    scene_fog(test.scene, vec3_splat(0.01f), vec3_splat(0.0f), 0.0f);
    compare("fog");
}

/* The most that one photon brings, and how many leave. */
static double most_power(const ppmi_aim *aim, uint32_t photons, uint32_t *out_left)
{
    double most = 0.0;
    *out_left = 0;
    for (uint32_t i = 0; i < photons; i++) {
        const ppmi_sample4 sample = ppmi_sobol4(i, 0, 7);
        float u[4];
        for (int k = 0; k < 4; k++)
            u[k] = ppmi_unit_float(sample.bits[k]);
        const double pick = ppmi_sobol1(i, 0, 7);
        ppmi_emission emission;
        const bool is_there = aim ? ppmi_aim_emit(aim, 0.0f, pick, u, &emission)
                                  : ppmi_lights_emit(world.lights, pick, u, &emission);
        if (!is_there) continue;
        most = fmax(most, (double)vec3_mean(emission.power));
        ++*out_left;
    }
    return most;
}

/* All rays through the scene are the target's, which has half of the photons. */
static void none_pass_by_the_scene_to_a_larger_target(void **state)
{
    (void)state;
    enum { PHOTONS = 4096 };
    const ppmi_target wide = {{0.0f, 0.5f, 0.0f}, {60.0f, 4.0f, 60.0f}};
    const double halves[2] = {0.5, 0.5};
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    world_open(&world, &test);
    ppmi_aim *aim = NULL;
    assert_int_equal(ppmi_aim_create(test.context, world.lights, &wide, halves, 1, &aim),
                     PPM_STATUS_OK);
    uint32_t evenly, aimed;
    const double even = most_power(NULL, PHOTONS, &evenly);
    const double most = most_power(aim, PHOTONS, &aimed);
    assert_int_equal(evenly, PHOTONS);
    assert_near(aimed, 0.5 * PHOTONS, 2.0);
    assert_true(most <= 2.02 * even);
    ppmi_aim_destroy(aim);
    world_close(&world);
}

/* A box's ellipsoid is at least sqrt(3) times as large as the box. */
static void a_target_around_others_holds_them_and_little_else(void **state)
{
    (void)state;
    const ppmi_target parts[2] = {{{-1.0f, 0.0f, 0.5f}, {1.0f, 0.2f, 3.0f}},
                                  {{2.0f, 0.1f, 0.0f}, {2.0f, 0.3f, 0.1f}}};
    for (uint32_t count = 1; count <= 2; count++) {
        const ppmi_target all = ppmi_target_around(parts, count);
        const float width = count == 1 ? 1.0f : 3.0f;
        assert_true(all.half.x <= 1.7321f * width);
        for (uint32_t i = 0; i < 4096; i++) {
            const ppmi_sample4 sample = ppmi_sobol4(i, 0, 3);
            const ppmi_vec3 way = ppmi_sample_cap(2.0f, ppmi_unit_float(sample.bits[0]),
                                                  ppmi_unit_float(sample.bits[1]));
            const ppmi_target *part = &parts[i % count];
            const ppmi_vec3 rim = vec3_add(part->center, vec3_mul(part->half, way));
            const ppmi_vec3 off = vec3_sub(rim, all.center);
            const ppmi_vec3 scaled =
                vec3(off.x / all.half.x, off.y / all.half.y, off.z / all.half.z);
            assert_true(vec3_length(scaled) <= 1.0001f);
        }
    }
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_point_sends_what_it_did),
        WITH_SCENE(a_ball_sends_what_it_did),
        WITH_SCENE(a_ball_larger_than_the_target_sends_what_it_did),
        WITH_SCENE(a_lamp_in_a_target_sends_what_it_did),
        WITH_SCENE(spots_send_what_they_did),
        WITH_SCENE(flat_lamps_send_what_they_did),
        WITH_SCENE(shining_surfaces_send_what_they_did),
        WITH_SCENE(parallel_light_sends_what_it_did),
        WITH_SCENE(a_sun_sends_what_it_did),
        WITH_SCENE(a_sky_sends_what_it_did),
        WITH_SCENE(an_even_sky_in_fog_sends_what_it_did),
        WITH_SCENE(none_pass_by_the_scene_to_a_larger_target),
        cmocka_unit_test(a_target_around_others_holds_them_and_little_else),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
