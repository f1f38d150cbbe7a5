/* The shadow of the scene's box: its area, and that rays are drawn evenly over it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "light/extent.h"
#include "math/sampling.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static ppmi_light_extent extent;

static const ppmi_vec3 low = {-1.0f, 0.5f, 2.0f}, high = {2.0f, 1.5f, 2.5f};
static const ppmi_vec3 directions[] = {
    {1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0.6f, 0, -0.8f}, {-0.48f, 0.6f, 0.64f}, {0.1f, -0.99f, 0.1f},
};
enum { DIRECTIONS = sizeof directions / sizeof directions[0] };

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    shape_place(test.scene, shape_box(test.scene, 0, low, high, 1, false));
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static void without_anything_there_is_no_shadow(void **state)
{
    (void)state;
    scene_close(&test);
    scene_open(&test);
    extent = ppmi_light_extent_of(test.scene);
    assert_near(ppmi_light_extent_shadow(&extent, vec3(0, 1, 0)), 0.0, 0.0);
    assert_near(ppmi_light_extent_mean_shadow(&extent), 0.0, 0.0);
    const ppmi_ray ray = ppmi_light_extent_ray(&extent, vec3(0, 1, 0), 0.5f, 0.5f);
    assert_true(vec3_is_finite(ray.origin));
}

static void the_shadow_of_a_box_is_that_of_three_faces(void **state)
{
    (void)state;
    extent = ppmi_light_extent_of(test.scene);
    for (int i = 0; i < DIRECTIONS; i++) {
        const ppmi_vec3 d = vec3_normalize(directions[i]);
        const double area =
            0.5 * fabs((double)d.x) + 1.5 * fabs((double)d.y) + 3.0 * fabs((double)d.z);
        /* up to the slack of 1e-4 of the ball's radius a side */
        assert_near(ppmi_light_extent_shadow(&extent, d), area, 2e-3);
        assert_true(ppmi_light_extent_shadow(&extent, d) >= (float)area);
    }
    const float ahead[3] = {0.57735027f, 0.57735027f, 0.57735027f};
    scene_close(&test);
    scene_open(&test);
    shape_place(test.scene, shape_box(test.scene, 0, vec3_splat(0), vec3_splat(1), 1, false));
    extent = ppmi_light_extent_of(test.scene);
    assert_near(ppmi_light_extent_shadow(&extent, vec3_load(ahead)), sqrt(3.0), 2e-3);
}

static void the_mean_shadow_is_the_mean(void **state)
{
    (void)state;
    extent = ppmi_light_extent_of(test.scene);
    double sum = 0.0;
    const int steps = 200;
    for (int i = 0; i < steps * steps; i++) {
        sum += (double)ppmi_light_extent_shadow(
            &extent, ppmi_sample_sphere(((float)(i / steps) + 0.5f) / (float)steps,
                                        ((float)(i % steps) + 0.5f) / (float)steps));
    }
    assert_near(ppmi_light_extent_mean_shadow(&extent), sum / (steps * steps), 1e-3);
}

/* Where a ray is across its direction. */
static ppmi_vec2 across(ppmi_ray ray)
{
    const ppmi_frame frame = ppmi_frame_from_normal(ray.direction);
    const ppmi_vec3 p = ppmi_frame_to_local(&frame, vec3_sub(ray.origin, extent.center));
    return (ppmi_vec2){p.x, p.y};
}

/* Whether a line along -direction through a place of the shadow's plane meets the box. */
static bool meets_box(ppmi_vec3 direction, ppmi_vec2 place)
{
    const ppmi_frame frame = ppmi_frame_from_normal(direction);
    const ppmi_vec3 p = ppmi_frame_to_world(&frame, vec3(place.x, place.y, 0.0f));
    const float o[3] = {p.x, p.y, p.z}, d[3] = {direction.x, direction.y, direction.z};
    const float h[3] = {extent.half.x, extent.half.y, extent.half.z};
    float near = -INFINITY, far = INFINITY;
    for (int i = 0; i < 3; i++) {
        if (d[i] == 0.0f) {
            if (fabsf(o[i]) > h[i]) return false;
            continue;
        }
        const float a = (-h[i] - o[i]) / d[i], b = (h[i] - o[i]) / d[i];
        near = fmaxf(near, fminf(a, b));
        far = fminf(far, fmaxf(a, b));
    }
    return near <= far;
}

/* Cells of the plane: what part of the shadow lies in each, by a fine grid, against counts. */
static void rays_are_even_over_the_shadow(void **state)
{
    (void)state;
    enum { CELLS = 8, FINE = 40, SIDE = CELLS * FINE };
    extent = ppmi_light_extent_of(test.scene);
    const uint32_t count = TEST_EFFORT(100000);
    test_family family = {0};
    for (int k = 0; k < DIRECTIONS; k++) {
        const ppmi_vec3 d = vec3_normalize(directions[k]);
        const float shadow = ppmi_light_extent_shadow(&extent, d), r = extent.radius;
        double observed[CELLS * CELLS] = {0.0}, expected[CELLS * CELLS] = {0.0};
        const double part = ppmi_sqr(2.0f * r / SIDE) / shadow;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const ppmi_vec2 place = {r * (2.0f * ((float)(i % SIDE) + 0.5f) / SIDE - 1.0f),
                                     r * (2.0f * ((float)(i / SIDE) + 0.5f) / SIDE - 1.0f)};
            const int cell = i / SIDE / FINE * CELLS + i % SIDE / FINE;
            if (meets_box(d, place)) expected[cell] += part * count;
        }
        ppmi_rng rng = ppmi_rng_start((uint64_t)k, PPMI_STREAM_PHOTON, 0);
        double off = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
            const ppmi_vec2 p = across(ppmi_light_extent_ray(&extent, d, u, v));
            const int x = (int)((p.x / r + 1.0f) * 0.5f * CELLS);
            const int y = (int)((p.y / r + 1.0f) * 0.5f * CELLS);
            observed[y * CELLS + x] += 1.0;
            off += !meets_box(d, (ppmi_vec2){0.9999f * p.x, 0.9999f * p.y});
        }
        assert_near(off, 0.0, 0.0);
        /* the fine grid sees the rim in steps: a cell's share is right to about 1 / FINE of its
         * side, so that only cells that are whole are compared one by one, the rest in sum */
        double rest_observed = 0.0, rest_expected = 0.0;
        const double whole = part * FINE * FINE * count;
        for (int i = 0; i < CELLS * CELLS; i++) {
            if (expected[i] > whole * 0.9999) continue;
            rest_observed += observed[i];
            rest_expected += expected[i];
            observed[i] = expected[i] = 0.0;
        }
        double sum = 0.0;
        for (int i = 0; i < CELLS * CELLS; i++)
            sum += expected[i];
        double all_observed[CELLS * CELLS + 1], all_expected[CELLS * CELLS + 1];
        for (int i = 0; i < CELLS * CELLS; i++) {
            all_observed[i] = observed[i];
            all_expected[i] = expected[i];
        }
        all_observed[CELLS * CELLS] = rest_observed;
        all_expected[CELLS * CELLS] = (double)count - sum;
        assert_near(rest_expected / ((double)count - sum), 1.0, 0.1);
        family_add(&family, p_counts(all_observed, all_expected, CELLS * CELLS + 1), "direction %d",
                   k);
    }
    family_check(&family);
}

static void rays_start_outside(void **state)
{
    (void)state;
    extent = ppmi_light_extent_of(test.scene);
    ppmi_rng rng = ppmi_rng_start(9, PPMI_STREAM_PHOTON, 0);
    for (int i = 0; i < 10000; i++) {
        const ppmi_vec3 d = ppmi_sample_sphere(ppmi_rng_float(&rng), ppmi_rng_float(&rng));
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        const ppmi_ray ray = ppmi_light_extent_ray(&extent, d, u, v);
        const ppmi_vec3 o = ray.origin;
        assert_true(o.x < low.x || o.y < low.y || o.z < low.z || o.x > high.x || o.y > high.y ||
                    o.z > high.z);
    }
}

/* The air around the scene is lit too. */
static void in_fog_the_shadow_is_that_of_the_ball(void **state)
{
    (void)state;
    const ppm_fog_desc fog = {.size = sizeof fog, .sigma_s = {0.0f, 0.1f, 0.0f}};
    assert_int_equal(ppm_scene_set_fog(test.scene, &fog), PPM_STATUS_OK);
    extent = ppmi_light_extent_of(test.scene);
    const double r2 = (9.0 + 1.0 + 0.25) / 4.0;
    test_mean square = {0};
    ppmi_rng rng = ppmi_rng_start(10, PPMI_STREAM_PHOTON, 0);
    for (int i = 0; i < 20000; i++) {
        const ppmi_vec3 d = vec3_normalize(directions[i % DIRECTIONS]);
        assert_near(ppmi_light_extent_shadow(&extent, d), M_PI * r2, 5e-3);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        const ppmi_vec2 p = across(ppmi_light_extent_ray(&extent, d, u, v));
        mean_add(&square, (double)(p.x * p.x + p.y * p.y) / r2);
        assert_true((double)(p.x * p.x + p.y * p.y) < r2 * 1.001);
    }
    test_family family = {0};
    family_add_mean(&family, &square, 0.5, 1e-3, "mean square");
    family_check(&family);
    assert_near(ppmi_light_extent_mean_shadow(&extent), M_PI * r2, 5e-3);
}

static void the_cone_from_outside_holds_the_ball(void **state)
{
    (void)state;
    extent = ppmi_light_extent_of(test.scene);
    const ppmi_vec3 from = vec3(10, 3, -2);
    const float distance = vec3_length(vec3_sub(from, extent.center));
    const float exact = sqrtf(1.0f - ppmi_sqr(extent.radius / distance));
    assert_true(ppmi_light_extent_cone(&extent, from, 0.0f) < exact);
    assert_near(ppmi_light_extent_cone(&extent, from, 0.0f), exact, 1e-3);
    assert_near(ppmi_light_extent_cone(&extent, extent.center, 0.0f), -1.0, 0.0);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(without_anything_there_is_no_shadow),
        WITH_SCENE(the_shadow_of_a_box_is_that_of_three_faces),
        WITH_SCENE(the_mean_shadow_is_the_mean),
        WITH_SCENE(rays_are_even_over_the_shadow),
        WITH_SCENE(rays_start_outside),
        WITH_SCENE(in_fog_the_shadow_is_that_of_the_ball),
        WITH_SCENE(the_cone_from_outside_holds_the_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
