/* The choice among near lights: probabilities, what must not be left out, and what it gains. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "light/tables.h"
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
    rng = ppmi_rng_start(12, PPMI_STREAM_EYE, 0);
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

static ppmi_vec3 place(float size)
{
    return vec3(between(-size, size), between(-size, size), between(-size, size));
}

static ppmi_vec3 direction(void)
{
    return ppmi_sample_sphere(ppmi_rng_float(&rng), ppmi_rng_float(&rng));
}

/* ---- many lights of all kinds ---------------------------------------------------------------- */

static void add_area_lamp(int32_t kind)
{
    const ppmi_frame frame = ppmi_frame_from_normal(direction());
    const ppmi_vec3 at = place(3.0f);
    const ppm_light_desc desc = {
        .size = sizeof desc,
        .kind = kind,
        .transform = {frame.s.x, frame.s.y, frame.s.z, 0, frame.t.x, frame.t.y, frame.t.z, 0,
                      frame.n.x, frame.n.y, frame.n.z, 0, at.x, at.y, at.z, 1},
        .intensity = {between(1.0f, 50.0f), 1.0f, 2.0f},
        .width_m = between(0.01f, 2.0f),
        .height_m = between(0.01f, 2.0f),
    };
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(test.scene, &desc, &id), PPM_STATUS_OK);
}

static void add_lights(uint32_t count)
{
    const ppm_material_id one = material_emitter(test.scene, 5.0f, 0.0f, false);
    const ppm_material_id both = material_emitter(test.scene, 2.0f, 0.0f, true);
    for (uint32_t i = 0; i < count; i++) {
        light_point(test.scene, place(3.0f), vec3_splat(between(0.1f, 20.0f)));
        const ppmi_vec3 at = place(3.0f);
        const float outer = between(0.05f, 1.5f);
        light_spot(test.scene, at, vec3_add(at, direction()), vec3_splat(between(0.1f, 20.0f)),
                   outer * between(0.0f, 0.99f), outer);
        add_area_lamp(PPM_LIGHT_RECTANGLE);
        add_area_lamp(PPM_LIGHT_DISK);
        add_quad(test.scene, i % 2 ? one : both, place(3.0f), direction(), direction());
    }
}

static ppmi_receiver some_receiver(uint32_t i)
{
    ppmi_receiver at = {.position = place(4.0f), .normal = direction(), .is_open = i % 3 == 1};
    if (i % 3 == 2) at.normal = vec3_splat(0.0f);
    return at;
}

/* Radiance or intensity towards the receiver from some place of the emitter, if its surface or
 * medium can be lit from there. */
static bool may_light(uint32_t emitter, const ppmi_receiver *at)
{
    const ppmi_emitter *e = &world.lights->emitters[emitter];
    const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
    ppmi_vec3 wi, radiance, target;
    if (e->kind == PPMI_EMITTER_TRIANGLE) {
        ppmi_surface surface;
        ppmi_emitter_sample(world.lights, e, u, v, 0.0f, &surface);
        wi = vec3_normalize(vec3_sub(surface.position, at->position));
        radiance = ppmi_emitter_radiance(world.lights, &surface, vec3_neg(wi));
    } else if (e->kind == PPMI_EMITTER_LAMP) {
        const ppmi_lamp *lamp = &world.lights->lamps[e->primitive];
        if (!(ppmi_lamp_sample(lamp, at->position, u, v, &wi, &target) > 0.0f)) return false;
        radiance = ppmi_lamp_radiance(test.scene, lamp, vec3_neg(wi));
    } else {
        const ppmi_punctual *light = &test.scene->punctuals[e->triangle];
        wi = vec3_normalize(vec3_sub(light->position, at->position));
        radiance = ppmi_punctual_intensity(test.scene, light, vec3_neg(wi));
    }
    return !vec3_is_black(radiance);
}

static float probability(uint32_t emitter, const ppmi_receiver *at)
{
    return ppmi_light_tree_pdf(&world.lights->near_lights, 0, 0, at, emitter);
}

static void probabilities_add_up_and_leave_no_light_out(void **state)
{
    (void)state;
    add_lights(40);
    world_open(&world, &test);
    const uint32_t count = world.lights->near_count;
    assert_int_equal(count, 40 * 6);
    uint32_t lit = 0;
    double all = 0.0;
    for (uint32_t i = 0; i < TEST_EFFORT(3000); i++) {
        const ppmi_receiver at = some_receiver(i);
        double sum = 0.0;
        for (uint32_t k = 0; k < count; k++) {
            const float p = probability(k, &at);
            sum += (double)p;
            if (!may_light(k, &at)) continue;
            assert_true(p > 0.0f);
            lit++;
        }
        assert_true(sum < 1.0 + 1e-5); /* less where bounds promise what no light keeps */
        all += sum;
    }
    assert_true(all > 0.9 * TEST_EFFORT(3000));
    assert_true(lit > TEST_EFFORT(3000) * 50);
}

static void lights_are_drawn_as_often_as_is_said(void **state)
{
    (void)state;
    add_lights(8);
    world_open(&world, &test);
    const uint32_t count = world.lights->near_count, draws = TEST_EFFORT(200000);
    double observed[49], expected[49];
    assert_int_equal(count, 48);
    for (uint32_t i = 0; i < 6; i++) {
        const ppmi_receiver at = some_receiver(i);
        double sum = 0.0;
        for (uint32_t k = 0; k <= count; k++) { /* the last: none is drawn */
            const double p = k < count ? (double)probability(k, &at) : 1.0 - sum;
            observed[k] = 0.0;
            expected[k] = p > 1e-6 ? p * draws : 0.0;
            sum += p;
        }
        for (uint32_t k = 0; k < draws; k++) {
            uint32_t emitter;
            float pdf;
            if (!ppmi_light_tree_sample(&world.lights->near_lights, 0, &at, ppmi_rng_double(&rng),
                                        &emitter, &pdf)) {
                observed[count] += 1.0;
                continue;
            }
            assert_near(pdf, probability(emitter, &at), 0.0);
            observed[emitter] += 1.0;
        }
        family_add(&family, p_counts(observed, expected, count + 1), "receiver %u", i);
    }
    family_check(&family);
}

/* ---- odd places ------------------------------------------------------------------------------ */

/* All at one place, in a row, or far apart: a tree all the same. */
static void lights_may_be_anywhere(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 100; i++) {
        light_point(test.scene, vec3(1, 1, 1), vec3_splat(1.0f));
        light_point(test.scene, vec3((float)i, 0, 0), vec3_splat(1.0f));
        light_point(test.scene, vec3(ldexpf(1.0f, (int)i % 60 - 30), 2, 0), vec3_splat(1.0f));
        light_point(test.scene, vec3(0, 0, 1e-20f * (float)i),
                    vec3_splat(ldexpf(1.0f, (int)i - 60)));
    }
    shape_place(test.scene, shape_box(test.scene, 0, vec3(-1, -3, -1), vec3(1, -2, 1), 1, false));
    world_open(&world, &test);
    for (uint32_t i = 0; i < 100; i++) {
        ppmi_receiver at = some_receiver(i);
        if (i % 4 == 0) at.position = vec3(1, 1, 1);
        if (i % 4 == 1) at.position = vec3_scale(at.position, 1e12f);
        double sum = 0.0;
        for (uint32_t k = 0; k < world.lights->near_count; k++) {
            assert_true(probability(k, &at) >= 0.0f);
            sum += (double)probability(k, &at);
        }
        assert_near(sum, 1.0, 1e-4);
    }
}

/* ---- what it gains --------------------------------------------------------------------------- */

/* Irradiance from point lights: second moment when a light is drawn by p(k). */
static void a_ceiling_of_lamps_is_less_noisy_than_by_power(void **state)
{
    (void)state;
    enum { SIDE = 32 };
    for (int x = 0; x < SIDE; x++)
        for (int z = 0; z < SIDE; z++)
            light_point(test.scene, vec3((float)x, 3, (float)z), vec3_splat(1.0f));
    shape_place(test.scene, shape_box(test.scene, 0, vec3(-1, -3, -1), vec3(1, -2, 1), 1, false));
    world_open(&world, &test);
    double by_tree = 0.0, by_power = 0.0;
    for (uint32_t i = 0; i < 200; i++) {
        const ppmi_receiver at = {.position = vec3(between(0, SIDE), 0, between(0, SIDE)),
                                  .normal = {0, 1, 0}};
        double sum = 0.0, tree = 0.0, power = 0.0;
        for (uint32_t k = 0; k < SIDE * SIDE; k++) {
            const ppmi_vec3 way = vec3_sub(test.scene->punctuals[k].position, at.position);
            const double value = 3.0 * pow((double)vec3_length(way), -3.0);
            sum += value;
            tree += value * value / (double)probability(k, &at);
            power += value * value * SIDE * SIDE;
        }
        by_tree += tree / (sum * sum) - 1.0;
        by_power += power / (sum * sum) - 1.0;
    }
    print_message("relative variance %.3f by the tree, %.3f by power\n", by_tree / 200.0,
                  by_power / 200.0);
    assert_true(by_tree < 0.15 * by_power);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(probabilities_add_up_and_leave_no_light_out),
        WITH_SCENE(lights_are_drawn_as_often_as_is_said),
        WITH_SCENE(lights_may_be_anywhere),
        WITH_SCENE(a_ceiling_of_lamps_is_less_noisy_than_by_power),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
