/* Reciprocity and energy: what a BSDF returns of a constant surrounding. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "support/near.h"
#include "support/statistics.h"

/* f(wo, wi) of a kind, for any two directions in the world. */
static ppmi_vec3 value(const bsdf_case *item, ppmi_vec3 wo, ppmi_vec3 wi, ppmi_transport transport)
{
    const ppmi_vec3 up = vec3(0.0f, 0.0f, 1.0f);
    const ppmi_surface surface = {.ng = up, .ns = up};
    ppmi_material_point point = item->point;
    if (point.relative_index > 0.0f && (wo.z < 0.0f) != item->from_back) {
        point.relative_index = 1.0f / point.relative_index;
    }
    ppmi_bsdf bsdf;
    ppmi_bsdf_make(bsdf_albedo(), &surface, &point, wo, &bsdf);
    return ppmi_bsdf_eval(&bsdf, bsdf_albedo(), wi, PPMI_LOBE_ALL, transport);
}

/* Below this cosine the shading normal is bent towards the viewer, on one side only. */
static bool is_grazing(ppmi_vec3 d)
{
    return fabsf(d.z) < 0.025f;
}

/* Relative rounding of the cosine to the facet that refracts, the difference of products near 1: it
 * shows where the facet is seen at a grazing angle. */
static float refraction_rounding(const ppmi_bsdf *bsdf, ppmi_vec3 wo, ppmi_vec3 wi)
{
    const ppmi_vec3 h = vec3_mad(wo, wi, bsdf->eta);
    return 5e-7f * vec3_length(h) / ppmi_max(fabsf(vec3_dot(wo, h)), 1e-9f);
}

/* n_o^2 f(i -> o) = n_i^2 f(o -> i) (Veach 1997, equation 5.14); and what carries power one way is
 * what carries radiance the other way. */
static void check_reciprocity(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user)
{
    ppmi_rng *rng = user;
    /* rounding of the half vector's cosine, against the width of the lobe in D */
    const float alpha2 = ppmi_max(bsdf->alpha * bsdf->alpha, 1e-12f);
    const float rounding = 2e-4f + 2e-6f / alpha2;
    if (rounding > 0.1f && bsdf->delta_lobes == 0 && item->point.specular > 0.0f) return;
    for (int i = 0; i < 500; i++) {
        const ppmi_vec3 wo = bsdf_wo(bsdf);
        ppmi_bsdf_sample sample;
        ppmi_vec3 wi = bsdf_random_direction(rng);
        /* narrow lobes are met by drawing from them */
        if (i % 2 == 0 && bsdf_draw(bsdf, rng, PPMI_TRANSPORT_POWER, &sample)) wi = sample.wi;
        if (is_grazing(wi)) continue;
        const bool is_refraction =
            wi.z * wo.z < 0.0f && !item->point.is_thin && item->point.transmission > 0.0f;
        const float eta2 = is_refraction ? bsdf->eta * bsdf->eta : 1.0f;
        const ppmi_vec3 power = value(item, wo, wi, PPMI_TRANSPORT_POWER);
        const ppmi_vec3 radiance = value(item, wo, wi, PPMI_TRANSPORT_RADIANCE);
        const ppmi_vec3 back = value(item, wi, wo, PPMI_TRANSPORT_RADIANCE);
        assert_near(radiance.y * eta2, power.y, 1e-5f * power.y);
        float tolerance = bsdf->delta_lobes ? 2e-4f : rounding;
        if (is_refraction) tolerance += refraction_rounding(bsdf, wo, wi);
        assert_near(back.x, power.x, tolerance * power.x + 1e-5f);
        assert_near(back.y, power.y, tolerance * power.y + 1e-5f);
    }
}

static void bsdfs_are_reciprocal(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    bsdf_for_all(check_reciprocity, &rng);
}

/* ---- energy ---------------------------------------------------------------------------------- */

static test_mean albedo_of(const ppmi_bsdf *bsdf, uint32_t count, uint64_t seed)
{
    test_mean mean = {0};
    ppmi_rng rng = ppmi_rng_start(seed, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_bsdf_sample sample;
        const bool is_drawn = bsdf_draw(bsdf, &rng, PPMI_TRANSPORT_POWER, &sample);
        mean_add(&mean, is_drawn ? (double)vec3_max_component(sample.weight) : 0.0);
    }
    return mean;
}

/* The albedo table is interpolated between 32 roughnesses and cosines. */
static const double table_error = 0.01;

typedef struct energy_test {
    test_family family;
    uint64_t seed;
} energy_test;

static void check_at_most_one(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user)
{
    energy_test *test = user;
    const test_mean mean = albedo_of(bsdf, TEST_EFFORT(20000), test->seed++);
    family_add_at_most(&test->family, &mean, 1.0 + table_error, "%s", item->name);
}

static void no_bsdf_makes_energy(void **state)
{
    (void)state;
    energy_test test = {.seed = 1};
    bsdf_for_all(check_at_most_one, &test);
    family_check(&test.family);
}

static void check_kind_is_white_within(energy_test *test, int kind, double error)
{
    static const float roughnesses[] = {0.0f, 0.05f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f};
    static const float cosines[] = {1.0f, 0.7f, 0.3f, 0.08f};
    for (int r = 0; r < 7; r++) {
        for (int c = 0; c < 4; c++) {
            bsdf_case item;
            ppmi_bsdf bsdf;
            bsdf_make_case(kind, roughnesses[r], cosines[c], &item, &bsdf);
            const test_mean mean = albedo_of(&bsdf, TEST_EFFORT(100000), test->seed++);
            mean_check_power(&mean, 0.005);
            family_add_mean(&test->family, &mean, 1.0, error, "%s", item.name);
        }
    }
}

static void check_kind_is_white(energy_test *test, int kind)
{
    check_kind_is_white_within(test, kind, table_error);
}

static void white_plastic_and_metal_return_all_light(void **state)
{
    (void)state;
    energy_test test = {.seed = 1000};
    check_kind_is_white(&test, KIND_WHITE_PLASTIC);
    check_kind_is_white(&test, KIND_WHITE_METAL);
    check_kind_is_white(&test, KIND_WHITE_ROUGH_LAMBERT);
    /* a rough base sends light back where it came from: at a grazing angle more than its share
     * meets the coat there, which the weights by cosines do not know */
    check_kind_is_white_within(&test, KIND_WHITE_ROUGH_PLASTIC, 0.02);
    family_check(&test.family);
}

static void white_layers_return_all_light(void **state)
{
    (void)state;
    static const int kinds[] = {
        KIND_WHITE_COATED_PLASTIC, KIND_WHITE_COATED_METAL, KIND_WHITE_ROUGH_COATED_METAL,
        KIND_WHITE_SHEEN,          KIND_WHITE_SMOOTH_SHEEN, KIND_WHITE_COATED_SHEEN_METAL,
        KIND_WHITE_BRUSHED_METAL,  KIND_WHITE_LEAF,         KIND_WHITE_RETRO_METAL,
        KIND_WHITE_EVERYTHING,     KIND_WHITE_BRUSHED_COAT, KIND_WHITE_FUZZ,
        KIND_WHITE_FUZZ_ON_COAT};
    energy_test test = {.seed = 3000};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++)
        check_kind_is_white(&test, kinds[k]);
    family_check(&test.family);
}

static void lambert_returns_its_colour(void **state)
{
    (void)state;
    bsdf_case item;
    ppmi_bsdf bsdf;
    ppmi_rng rng = ppmi_rng_start(5, PPMI_STREAM_EYE, 0);
    bsdf_make_case(KIND_LAMBERT, 0.5f, 0.3f, &item, &bsdf);
    assert_int_equal(bsdf.lobes, PPMI_LOBE_WIDE);
    for (int i = 0; i < 1000; i++) {
        ppmi_bsdf_sample sample;
        assert_true(bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_RADIANCE, &sample));
        assert_near(sample.weight.x, 0.8, 1e-5);
        assert_near(sample.weight.y, 0.5, 1e-5);
        assert_near(sample.weight.z, 0.2, 1e-5);
        const ppmi_vec3 f =
            ppmi_bsdf_eval(&bsdf, bsdf_albedo(), sample.wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE);
        assert_near(f.x, 0.8 / M_PI, 1e-6);
    }
}

/* ---- glass ----------------------------------------------------------------------------------- */

/* Fresnel's equations from the angles: an independent form. */
static double fresnel(double cosine, double eta)
{
    const double i = acos(cosine), sine = sin(i) / eta;
    if (sine >= 1.0) return 1.0;
    const double t = asin(sine);
    if (i < 1e-6) return (eta - 1.0) * (eta - 1.0) / ((eta + 1.0) * (eta + 1.0));
    const double s = sin(i - t) / sin(i + t), p = tan(i - t) / tan(i + t);
    return 0.5 * (s * s + p * p);
}

static void smooth_glass_splits_light_as_fresnel_says(void **state)
{
    (void)state;
    static const float cosines[] = {1.0f, 0.8f, 0.5f, 0.2f, 0.08f};
    static const int kinds[] = {KIND_GLASS, KIND_GLASS_INSIDE, KIND_THIN_GLASS};
    test_family family = {0};
    ppmi_rng rng = ppmi_rng_start(7, PPMI_STREAM_EYE, 0);
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 5; c++) {
            bsdf_case item;
            ppmi_bsdf bsdf;
            bsdf_make_case(kinds[k], 0.0f, cosines[c], &item, &bsdf);
            const double eta = kinds[k] == KIND_GLASS_INSIDE ? 1.0 / 1.5 : 1.5;
            double expected = fresnel((double)cosines[c], eta);
            if (item.point.is_thin) expected = 2.0 * expected / (1.0 + expected);
            test_mean reflected = {0};
            const uint32_t count = TEST_EFFORT(100000);
            for (uint32_t i = 0; i < count; i++) {
                ppmi_bsdf_sample s;
                assert_true(bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_RADIANCE, &s));
                assert_true(s.is_delta);
                mean_add(&reflected, s.is_transmission ? 0.0 : 1.0);
                const double scale =
                    s.is_transmission && !item.point.is_thin ? 1.0 / (eta * eta) : 1.0;
                const double tint = s.is_transmission ? (double)item.point.base_color.y : 1.0;
                assert_near(s.weight.y, scale * tint, 1e-5);
                if (!s.is_transmission) continue;
                /* Snell: the sines' ratio, in the plane of incidence */
                const ppmi_vec3 wo = bsdf_wo(&bsdf);
                const double bend = item.point.is_thin ? 1.0 : eta;
                assert_near(s.wi.x * bend, -wo.x, 1e-5);
                assert_near(s.wi.y, 0.0, 1e-6);
            }
            family_add_mean(&family, &reflected, expected, 0.0, "%s", item.name);
        }
    }
    family_check(&family);
}

/* A rough interface loses to single scattering only: little when it is nearly smooth, and what goes
 * through follows Fresnel there. */
static void nearly_smooth_glass_is_like_smooth_glass(void **state)
{
    (void)state;
    test_family family = {0};
    static const int kinds[] = {KIND_GLASS, KIND_GLASS_INSIDE, KIND_THIN_GLASS};
    ppmi_rng rng = ppmi_rng_start(9, PPMI_STREAM_EYE, 0);
    for (int k = 0; k < 3; k++) {
        bsdf_case item;
        ppmi_bsdf bsdf;
        bsdf_make_case(kinds[k], 0.06f, 0.85f, &item, &bsdf);
        assert_int_equal(bsdf.delta_lobes, 0);
        double reflectance = fresnel(0.85, k == 1 ? 1.0 / 1.5 : 1.5);
        if (item.point.is_thin) reflectance = 2.0 * reflectance / (1.0 + reflectance);
        test_mean all = {0}, through = {0};
        const uint32_t count = TEST_EFFORT(200000);
        for (uint32_t i = 0; i < count; i++) {
            ppmi_bsdf_sample s;
            const bool is_drawn = bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_POWER, &s);
            mean_add(&all, is_drawn ? (double)s.weight.x : 0.0);
            mean_add(&through, is_drawn && s.is_transmission ? (double)s.weight.x : 0.0);
        }
        /* alpha = 0.0036: facets lean by less than that, Fresnel changes by less than 1e-3 */
        family_add_mean(&family, &all, 1.0, 1e-3, "%s: all", item.name);
        family_add_mean(&family, &through, 1.0 - reflectance, 1e-3, "%s: through", item.name);
    }
    family_check(&family);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bsdfs_are_reciprocal),
        cmocka_unit_test(no_bsdf_makes_energy),
        cmocka_unit_test(white_plastic_and_metal_return_all_light),
        cmocka_unit_test(white_layers_return_all_light),
        cmocka_unit_test(lambert_returns_its_colour),
        cmocka_unit_test(smooth_glass_splits_light_as_fresnel_says),
        cmocka_unit_test(nearly_smooth_glass_is_like_smooth_glass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
