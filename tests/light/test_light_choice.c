/* The first decision of light sampling, with and without what probes have found. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "light/light_choice.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;
static test_family family;
static ppmi_rng rng;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    family = (test_family){0};
    rng = ppmi_rng_start(21, PPMI_STREAM_EYE, 0);
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

static float between(float low, float high)
{
    return low + (high - low) * ppmi_rng_float(&rng);
}

/* Lamps along x, a panel, a sky, a sun and a directional light. */
static void add_lights(void)
{
    for (int i = 0; i < 40; i++)
        light_point(test.scene, vec3((float)i, 2, between(-1, 1)), vec3_splat(between(1, 9)));
    add_quad(test.scene, material_emitter(test.scene, 5.0f, 0.0f, true), vec3(3, 1, 0),
             vec3(1, 0, 0), vec3(0, 0.2f, 1));
    light_environment(test.scene, vec3_splat(0.5f), 0, 0.0f);
    light_directional(test.scene, vec3(0.2f, -1, 0), vec3_splat(3.0f));
    light_sun(test.scene, vec3(-0.3f, -1, 0.1f), vec3_splat(4.0f), 0.2f);
}

/* Places along x where the choices arrive by halves, wholly, or not at all. */
static void learn(void)
{
    enum { PROBES = 600 };
    static ppmi_light_probe probes[PROBES];
    const uint32_t choices = ppmi_lights_choice_count(world.lights);
    for (uint32_t i = 0; i < PROBES; i++) {
        const ppmi_vec3 n = i % 3 == 0   ? vec3(0, 1, 0)
                            : i % 3 == 1 ? vec3(0, -1, 0)
                                         : vec3(0, 0, 0);
        probes[i].receiver =
            (ppmi_receiver){.position = vec3(between(0, 40), 0, between(-1, 1)), .normal = n};
        for (uint32_t c = 0; c < choices; c++) {
            const uint32_t kind = ((uint32_t)probes[i].receiver.position.x / 8 + c + i % 3) % 4;
            probes[i].shares[c] = kind == 0 ? 0.0f : kind == 1 ? 1.0f : (float)((i + c) % 2);
            if (kind == 3 && i % 2) probes[i].shares[c] = -1.0f;
        }
    }
    assert_int_equal(ppmi_lights_learn(world.lights, probes, PROBES), PPM_STATUS_OK);
}

static ppmi_receiver some_receiver(uint32_t i)
{
    const ppmi_vec3 n = i % 3 == 0   ? vec3(0, 1, 0)
                        : i % 3 == 1 ? ppmi_sample_sphere(between(0, 1), between(0, 1))
                                     : vec3(0, 0, 0);
    return (ppmi_receiver){.position = vec3(between(-9, 50), between(-1, 1), between(-2, 2)),
                           .normal = n,
                           .is_open = i % 2 == 0};
}

static void shares_have_a_floor_and_a_sum(void **state)
{
    (void)state;
    add_lights();
    world_open(&world, &test);
    const uint32_t choices = world.lights->choice_count;
    assert_int_equal(choices, PPMI_LIGHT_CHOICES);
    float even[500][PPMI_LIGHT_CHOICES], shares[PPMI_LIGHT_CHOICES];
    ppmi_receiver at[500];
    for (uint32_t i = 0; i < 500; i++) {
        at[i] = some_receiver(i);
        assert_near(ppmi_light_choice_shares(world.lights, &at[i], even[i]), 1.0, 1e-5);
        const float far = even[i][choices - 1];
        assert_near(far, 1.0 / 3.0, 1e-5); /* near lights, directional ones, the environment */
        assert_near(even[i][choices - 2], far, 0.0);
    }
    learn();
    double least = 1.0;
    for (uint32_t i = 0; i < 500; i++) {
        double sum = 0.0;
        const float said = ppmi_light_choice_shares(world.lights, &at[i], shares);
        for (uint32_t c = 0; c < choices; c++) {
            assert_true(shares[c] >= 0.0999f * even[i][c] && shares[c] <= 1.0f);
            least = fmin(least, (double)(shares[c] / even[i][c]));
            sum += (double)shares[c];
        }
        assert_near(said, sum, 1e-5);
        assert_true(sum > 1.0 - 1e-5 && sum <= 1.1 + 1e-5);
    }
    assert_true(least < 0.11);
}

/* Both of a place's samples. */
static void light_is_the_same_whatever_is_known(void **state)
{
    (void)state;
    add_lights();
    world_open(&world, &test);
    test_mean means[2][6] = {0};
    uint32_t second = 0;
    for (uint32_t known = 0; known < 2; known++) {
        if (known) learn();
        rng = ppmi_rng_start(5, PPMI_STREAM_EYE, 0);
        for (uint32_t i = 0; i < 6; i++) {
            const ppmi_receiver at = some_receiver(i);
            ppmi_rng numbers = ppmi_rng_start(9 + known, PPMI_STREAM_EYE, i);
            for (uint32_t k = 0; k < TEST_EFFORT(60000); k++) {
                double pick = ppmi_rng_double(&numbers), value = 0.0;
                ppmi_light_sample s;
                do {
                    const float u = ppmi_rng_float(&numbers), v = ppmi_rng_float(&numbers);
                    if (ppmi_lights_sample_at(world.lights, &at, 0.0f, pick, u, v, &s)) {
                        const float cosine =
                            i % 3 == 2 ? 1.0f : ppmi_max(vec3_dot(at.normal, s.wi), 0.0f);
                        value += (double)(vec3_mean(s.radiance) * cosine / s.pdf);
                    }
                    if (pick >= 1.0) second++;
                    pick += 1.0;
                } while (s.has_another);
                mean_add(&means[known][i], value);
            }
        }
    }
    for (uint32_t i = 0; i < 6; i++) {
        mean_check_power(&means[0][i], 0.03);
        mean_check_power(&means[1][i], 0.03);
        const double apart = means[1][i].mean - means[0][i].mean;
        const double error = hypot(mean_error(&means[0][i]), mean_error(&means[1][i]));
        family_add(&family, p_normal(apart / error), "receiver %u", i);
    }
    family_check(&family);
    assert_true(second > 100);
}

/* What MIS asks for is what samples state: far light, and the panel's triangles. */
static void densities_agree_with_samples(void **state)
{
    (void)state;
    add_lights();
    world_open(&world, &test);
    learn();
    uint32_t far = 0, on_panel = 0;
    for (uint32_t i = 0; i < 20000; i++) {
        const ppmi_receiver at = some_receiver(i);
        ppmi_light_sample s;
        if (!ppmi_lights_sample_at(world.lights, &at, 0.0f, 2.0 * ppmi_rng_double(&rng),
                                   between(0, 1), between(0, 1), &s) ||
            s.is_delta) {
            continue;
        }
        if (s.is_far) {
            assert_near(ppmi_lights_pdf_environment(world.lights, &at, s.wi) / s.pdf, 1.0, 1e-3);
            far++;
            continue;
        }
        const ppmi_ray ray = {.origin = at.position, .t_max = INFINITY, .direction = s.wi};
        ppmi_hit hit;
        if (!ppmi_accel_intersect(world.accel, &ray, &hit)) continue; /* an edge */
        ppmi_surface surface;
        ppmi_surface_from_hit(test.scene, &hit, &surface);
        const double cosine = fabs((double)vec3_dot(s.wi, surface.ng));
        if (cosine < 0.01 || !surface.material->emits) continue;
        const float pdf = ppmi_lights_pdf_surface(world.lights, &at, &hit, &surface, s.wi, hit.t);
        assert_near(pdf / s.pdf, 1.0, 1e-3 + 1e-4 / cosine);
        on_panel++;
    }
    print_message("%u of far light, %u on the panel\n", far, on_panel);
    assert_true(far > 2000 && on_panel > 100);
}

/* It is looked at by second samples only: the other one does not miss a sample for it. */
static void a_lamp_that_never_arrives_takes_a_tenth(void **state)
{
    (void)state;
    light_point(test.scene, vec3(0, 2, 0), vec3_splat(10.0f));
    light_point(test.scene, vec3(8, 2, 0), vec3_splat(20000.0f));
    world_open(&world, &test);
    static ppmi_light_probe probes[1000];
    const ppmi_receiver at = {.position = {0.5f, 0, 0}, .normal = {0, 1, 0}};
    float before[2], after[2];
    ppmi_light_choice_shares(world.lights, &at, before);
    const uint32_t dark = before[0] > before[1] ? 0 : 1;
    assert_true(before[dark] > 0.9f);
    for (uint32_t i = 0; i < 1000; i++) {
        probes[i].receiver = at;
        probes[i].receiver.position.x = between(-1, 1);
        probes[i].shares[dark] = 0.0f;
        probes[i].shares[1 - dark] = 1.0f;
    }
    assert_int_equal(ppmi_lights_learn(world.lights, probes, 1000), PPM_STATUS_OK);
    ppmi_light_choice_shares(world.lights, &at, after);
    assert_true(after[1 - dark] > 0.999f);
    assert_near(after[dark], 0.1f * before[dark], 1e-3);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(shares_have_a_floor_and_a_sum),
        WITH_SCENE(light_is_the_same_whatever_is_known),
        WITH_SCENE(densities_agree_with_samples),
        WITH_SCENE(a_lamp_that_never_arrives_takes_a_tenth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
