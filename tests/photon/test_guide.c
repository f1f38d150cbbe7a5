/* Guided emission: the density that is returned is the one that is drawn. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "photon/guide.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;
static ppmi_photon_guide guide;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    shape_place(test.scene, shape_box(test.scene, material_lambert(test.scene, 0.5f), vec3_splat(0),
                                      vec3_splat(1), 1, true));
    light_point(test.scene, vec3(0.4f, 0.6f, 0.3f), vec3_splat(1.0f));
    light_point(test.scene, vec3(0.6f, 0.6f, 0.3f), vec3_splat(2.0f));
    add_quad(test.scene, material_emitter(test.scene, 5.0f, 0.0f, false), vec3(0.2f, 0.9f, 0.2f),
             vec3(0.1f, 0, 0), vec3(0, 0, 0.1f));
    world_open(&world, &test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    world_close(&world);
    scene_close(&test);
    return 0;
}

static ppmi_emission_sample even_sample(ppmi_rng *rng)
{
    ppmi_emission_sample sample = {.pick = ppmi_rng_double(rng)};
    for (int k = 0; k < 4; k++)
        sample.u[k] = ppmi_rng_float(rng);
    return sample;
}

/* Learns from samples of a corner of the first plane and a stripe of the second. */
static void learn(void)
{
    static ppmi_guide_counts counts;
    memset(&counts, 0, sizeof counts);
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_PHOTON, 0);
    for (int i = 0; i < 20000; i++) {
        const ppmi_emission_sample sample = even_sample(&rng);
        if (sample.u[0] < 0.3f && sample.u[1] > 0.6f && fabsf(sample.u[2] - 0.5f) < 0.1f) {
            ppmi_guide_count(&counts, world.world.lights, &sample);
        }
    }
    ppmi_guide_learn(&guide, &counts);
}

/* The mean of a function by guided samples over their density is its mean by even ones. */
static void means_by_density_are_those_of_even_samples(void **state)
{
    (void)state;
    learn();
    test_mean means[3] = {{0}};
    ppmi_rng rng = ppmi_rng_start(2, PPMI_STREAM_PHOTON, 0);
    for (uint32_t i = 0; i < TEST_EFFORT(200000); i++) {
        ppmi_emission_sample sample = even_sample(&rng);
        const float density = ppmi_guide_warp(&guide, world.world.lights, &sample);
        assert_true(density >= PPMI_GUIDE_EVEN_SHARE);
        assert_true(sample.pick >= 0.0 && sample.pick < 1.0);
        for (int k = 0; k < 4; k++)
            assert_true(sample.u[k] >= 0.0f && sample.u[k] < 1.0f);
        const double weight = 1.0 / (double)density;
        mean_add(&means[0], weight);
        mean_add(&means[1], weight * (double)(sample.u[0] * sample.u[1]) * sample.pick);
        mean_add(&means[2], weight * (double)(sample.u[2] * sample.u[2] * sample.u[3]));
    }
    test_family family = {0};
    const double expected[3] = {1.0, 0.125, 1.0 / 6.0};
    for (int i = 0; i < 3; i++) {
        mean_check_power(&means[i], 0.01);
        family_add_mean(&family, &means[i], expected[i], 0.0, "function %d", i);
    }
    family_check(&family);
}

static void samples_go_where_photons_were_seen(void **state)
{
    (void)state;
    learn();
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_PHOTON, 0);
    uint32_t there = 0;
    const uint32_t count = TEST_EFFORT(20000);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_emission_sample sample = even_sample(&rng);
        ppmi_guide_warp(&guide, world.world.lights, &sample);
        there += sample.u[0] < 0.3f && sample.u[1] > 0.6f && fabsf(sample.u[2] - 0.5f) < 0.1f;
    }
    /* 2.4 % of even samples; here at least half of the share that follows the guide */
    assert_true(there > 0.35 * count);
}

/* Every light has a group, and lights of the same kind of numbers share one only when they must. */
static void lamps_have_groups_of_their_own(void **state)
{
    (void)state;
    bool is_used[PPMI_GUIDE_GROUPS] = {false};
    uint32_t used = 0;
    for (int i = 0; i < 1000; i++) {
        const uint32_t group =
            ppmi_lights_group(world.world.lights, (i + 0.5) / 1000.0, PPMI_GUIDE_GROUPS);
        assert_true(group < PPMI_GUIDE_GROUPS);
        used += !is_used[group];
        is_used[group] = true;
    }
    assert_int_equal(used, 4); /* two lamps, two triangles */
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(means_by_density_are_those_of_even_samples),
        WITH_SCENE(samples_go_where_photons_were_seen),
        WITH_SCENE(lamps_have_groups_of_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
