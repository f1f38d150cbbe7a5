/* The maps from the unit square have the densities that they state. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "math/sampling.h"
#include "support/near.h"
#include "support/statistics.h"

enum { SAMPLES = 200000, BINS = 16 };

/* Two coordinates that are uniform over the unit square where the map has its density. */
typedef struct square {
    double x, y;
} square;

static double turn(ppmi_vec3 d)
{
    const double phi = atan2((double)d.y, (double)d.x) / (2.0 * (double)PPMI_PI);
    return phi < 0.0 ? phi + 1.0 : phi;
}

static square disk(float u, float v)
{
    const ppmi_vec2 d = ppmi_sample_disk(u, v);
    return (square){turn(vec3(d.x, d.y, 0.0f)), (double)(d.x * d.x + d.y * d.y)};
}

static square cosine_hemisphere(float u, float v)
{
    const ppmi_vec3 d = ppmi_sample_cosine_hemisphere(u, v);
    assert_near(vec3_length(d), 1.0f, 1e-6f);
    assert_true(d.z >= 0.0f);
    return (square){turn(d), (double)(d.z * d.z)};
}

static square sphere(float u, float v)
{
    const ppmi_vec3 d = ppmi_sample_sphere(u, v);
    assert_near(vec3_length(d), 1.0f, 1e-6f);
    return (square){turn(d), 0.5 + 0.5 * (double)d.z};
}

static square cone(float u, float v)
{
    const ppmi_vec3 d = ppmi_sample_cone(0.7f, u, v);
    assert_near(vec3_length(d), 1.0f, 1e-6f);
    return (square){turn(d), ((double)d.z - 0.7) / 0.3};
}

static square cap(float u, float v)
{
    const float height = 1e-5f;
    const ppmi_vec3 d = ppmi_sample_cap(height, u, v);
    assert_near(vec3_length(d), 1.0f, 1e-6f);
    /* z is too coarse; sin^2 = depth (2 - depth) */
    const double sin2 = (double)(d.x * d.x) + (double)(d.y * d.y);
    return (square){turn(d), (1.0 - sqrt(1.0 - sin2)) / (double)height};
}

/* Conditional on x + y, x is uniform; and (x + y)^2 is uniform. */
static square triangle(float u, float v)
{
    const ppmi_vec2 t = ppmi_sample_triangle(u, v);
    const double sum = (double)t.x + (double)t.y;
    assert_true(t.x >= 0.0f && t.y >= 0.0f && sum <= 1.0 + 1e-6);
    return (square){sum > 0.0 ? (double)t.x / sum : 0.0, sum * sum};
}

static double even_p(square (*map)(float, float), uint64_t seed)
{
    double observed[BINS * BINS] = {0.0}, expected[BINS * BINS];
    ppmi_rng rng = ppmi_rng_start(seed, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        const square s = map(u, v);
        const int x = (int)(s.x * BINS), y = (int)(s.y * BINS);
        observed[(x < BINS ? x : BINS - 1) * BINS + (y > 0 ? y < BINS ? y : BINS - 1 : 0)] += 1.0;
    }
    for (int i = 0; i < BINS * BINS; i++)
        expected[i] = (double)SAMPLES / (BINS * BINS);
    return p_counts(observed, expected, BINS * BINS);
}

static void maps_have_their_densities(void **state)
{
    (void)state;
    const struct {
        const char *name;
        square (*map)(float, float);
    } maps[] = {{"disk", disk},     {"cosine hemisphere", cosine_hemisphere},
                {"sphere", sphere}, {"cone", cone},
                {"cap", cap},       {"triangle", triangle}};
    test_family family = {0};
    for (size_t i = 0; i < sizeof maps / sizeof maps[0]; i++)
        family_add(&family, even_p(maps[i].map, i), "%s", maps[i].name);
    family_check(&family);
}

static void moments_of_the_cosine_hemisphere_are_right(void **state)
{
    (void)state;
    test_mean z = {0}, x2 = {0};
    ppmi_rng rng = ppmi_rng_start(11, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        const ppmi_vec3 d = ppmi_sample_cosine_hemisphere(u, v);
        mean_add(&z, (double)d.z);
        mean_add(&x2, (double)(d.x * d.x));
    }
    test_family family = {0};
    family_add_mean(&family, &z, 2.0 / 3.0, 0.0, "mean cosine");
    family_add_mean(&family, &x2, 0.25, 0.0, "mean x^2");
    family_check(&family);
}

static void corners_of_the_square_map_to_finite_points(void **state)
{
    (void)state;
    const float ends[3] = {0.0f, 0.5f, 0x1.fffffep-1f};
    for (int i = 0; i < 9; i++) {
        const float u = ends[i % 3], v = ends[i / 3];
        const ppmi_vec2 d = ppmi_sample_disk(u, v);
        assert_true(d.x * d.x + d.y * d.y <= 1.000001f);
        assert_true(vec3_is_finite(ppmi_sample_cosine_hemisphere(u, v)));
        assert_true(vec3_is_finite(ppmi_sample_sphere(u, v)));
    }
}

static void mis_weights_sum_to_1_and_bear_infinity(void **state)
{
    (void)state;
    for (float a = 1e-6f; a < 1e6f; a *= 7.0f) {
        for (float b = 1e-6f; b < 1e6f; b *= 5.0f)
            assert_near(ppmi_mis_weight(a, b) + ppmi_mis_weight(b, a), 1.0f, 1e-6f);
    }
    assert_true(ppmi_mis_weight(INFINITY, 1.0f) == 1.0f);
    assert_true(ppmi_mis_weight(0.0f, 0.0f) == 0.0f);
    assert_true(ppmi_mis_weight(1.0f, 0.0f) == 1.0f);
}

/* A light that subtends almost nothing has densities whose squares overflow. */
static void mis_weights_of_huge_densities_are_numbers(void **state)
{
    (void)state;
    assert_near(ppmi_mis_weight(1e25f, 1.0f), 1.0f, 1e-6f);
    assert_near(ppmi_mis_weight(1.0f, 1e25f), 0.0f, 1e-6f);
    assert_near(ppmi_mis_weight(1e25f, 1e25f), 0.5f, 1e-6f);
    assert_near(ppmi_mis_weight(1e-25f, 1e-25f), 0.5f, 1e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_have_their_densities),
        cmocka_unit_test(moments_of_the_cosine_hemisphere_are_right),
        cmocka_unit_test(corners_of_the_square_map_to_finite_points),
        cmocka_unit_test(mis_weights_sum_to_1_and_bear_infinity),
        cmocka_unit_test(mis_weights_of_huge_densities_are_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
