/* The albedo table against Monte Carlo. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "shading/microfacet.h"
#include "support/near.h"
#include "support/statistics.h"

/* Even directions over the hemisphere: independent of the visible normals that made the table. */
static void albedo_by_directions(float alpha, float cosine, ppmi_rng *rng, test_mean *a,
                                 test_mean *b)
{
    const ppmi_vec3 wo = vec3(sqrtf(1.0f - cosine * cosine), 0.0f, cosine);
    const uint32_t count = TEST_EFFORT(200000);
    for (uint32_t i = 0; i < count; i++) {
        const float u = ppmi_rng_float(rng), v = ppmi_rng_float(rng);
        const ppmi_vec3 wi = ppmi_sample_cosine_hemisphere(u, v);
        const ppmi_vec3 h = vec3_normalize(vec3_add(wo, wi));
        const double value = (double)(ppmi_ggx_d(alpha, h) * ppmi_ggx_g2(alpha, wo.z, wi.z) /
                                      (4.0f * wo.z * ppmi_max(wi.z, 1e-6f)) * PPMI_PI);
        const double schlick = (double)ppmi_schlick_weight(vec3_dot(wo, h));
        mean_add(a, value * (1.0 - schlick));
        mean_add(b, value * schlick);
    }
}

/* Linear interpolation between 32 entries of a function that bends at grazing angles, and 1024
 * points an entry. */
static const double table_error = 0.006;

static void the_table_agrees_with_monte_carlo(void **state)
{
    (void)state;
    static const float roughnesses[] = {0.4f, 0.5f, 0.63f, 0.8f, 1.0f};
    static const float cosines[] = {1.0f, 0.81f, 0.5f, 0.22f, 0.1f};
    test_family family = {0};
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    for (int r = 0; r < 5; r++) {
        for (int c = 0; c < 5; c++) {
            test_mean a = {0}, b = {0};
            albedo_by_directions(roughnesses[r] * roughnesses[r], cosines[c], &rng, &a, &b);
            const ppmi_albedo_pair pair =
                ppmi_albedo_directional(bsdf_albedo(), roughnesses[r], cosines[c]);
            family_add_mean(&family, &a, (double)pair.a, table_error, "a at %g, %g",
                            (double)roughnesses[r], (double)cosines[c]);
            family_add_mean(&family, &b, (double)pair.b, table_error, "b at %g, %g",
                            (double)roughnesses[r], (double)cosines[c]);
        }
    }
    family_check(&family);
}

static void a_smooth_surface_loses_nothing(void **state)
{
    (void)state;
    for (float cosine = 0.0f; cosine <= 1.0f; cosine += 0.05f) {
        const ppmi_albedo_pair pair = ppmi_albedo_directional(bsdf_albedo(), 0.0f, cosine);
        assert_near(pair.a + pair.b, 1.0, 1e-5);
    }
    const ppmi_albedo_pair average = ppmi_albedo_average(bsdf_albedo(), 0.0f);
    assert_near(average.a + average.b, 1.0, 1e-4);
    /* 2 * integral of (1 - c)^5 c dc = 1 / 21 */
    assert_near(average.b, 1.0 / 21.0, 1e-3);
}

static void no_entry_is_above_1_and_rough_ones_lose(void **state)
{
    (void)state;
    for (float roughness = 0.0f; roughness <= 1.0f; roughness += 0.02f) {
        for (float cosine = 0.0f; cosine <= 1.0f; cosine += 0.02f) {
            const ppmi_albedo_pair pair = ppmi_albedo_directional(bsdf_albedo(), roughness, cosine);
            assert_true(pair.a >= 0.0f && pair.b >= 0.0f && pair.a + pair.b <= 1.0f + 1e-5f);
        }
    }
    const ppmi_albedo_pair rough = ppmi_albedo_average(bsdf_albedo(), 1.0f);
    assert_true(rough.a + rough.b < 0.65f && rough.a + rough.b > 0.4f);
}

static void look_ups_beyond_the_ends_are_the_ends(void **state)
{
    (void)state;
    const ppmi_albedo_pair inside = ppmi_albedo_directional(bsdf_albedo(), 1.0f, 1.0f);
    const ppmi_albedo_pair beyond = ppmi_albedo_directional(bsdf_albedo(), 1.5f, 1.0001f);
    assert_near(inside.a, beyond.a, 0.0);
    const ppmi_albedo_pair strange = ppmi_albedo_directional(bsdf_albedo(), NAN, NAN);
    assert_true(isfinite(strange.a) && isfinite(strange.b));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_agrees_with_monte_carlo),
        cmocka_unit_test(a_smooth_surface_loses_nothing),
        cmocka_unit_test(no_entry_is_above_1_and_rough_ones_lose),
        cmocka_unit_test(look_ups_beyond_the_ends_are_the_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
