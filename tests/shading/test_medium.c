/* Media: distances and directions are drawn with the densities that are stated, and weights have
 * the means that the integrals say. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "shading/medium.h"
#include "support/near.h"
#include "support/statistics.h"

/* Grey, coloured, clear in one channel, absorbing only in one. */
enum { MEDIA = 4, LENGTHS = 3, BINS = 40 };
static const ppmi_medium media[MEDIA] = {
    {.sigma_s = {1.0f, 1.0f, 1.0f}, .sigma_a = {0.5f, 0.5f, 0.5f}},
    {.sigma_s = {2.0f, 0.5f, 0.1f}, .sigma_a = {0.1f, 0.3f, 0.0f}},
    {.sigma_s = {1.5f, 0.4f, 0.0f}},
    {.sigma_s = {1.0f, 0.0f, 0.3f}, .sigma_a = {0.0f, 0.8f, 0.2f}},
};
static const float lengths[LENGTHS] = {0.5f, 3.0f, INFINITY};

static double sigma_t(const ppmi_medium *medium, int k)
{
    const ppmi_vec3 sum = vec3_add(medium->sigma_s, medium->sigma_a);
    return (double)(k == 0 ? sum.x : k == 1 ? sum.y : sum.z);
}

static void transmittance_is_exponential(void **state)
{
    (void)state;
    const ppmi_vec3 t = ppmi_medium_transmittance(&media[1], 2.0f);
    assert_near(t.x, exp(-4.2), 1e-6);
    assert_near(t.y, exp(-1.6), 1e-6);
    assert_near(t.z, exp(-0.2), 1e-6);
    assert_near(ppmi_medium_transmittance(&media[1], 0.0f).x, 1.0, 0.0);
}

/* The mean over the channels of exponential distributions, cut off at the length. */
static void distances_follow_the_extinction(void **state)
{
    (void)state;
    test_family family = {0};
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    const uint32_t count = TEST_EFFORT(100000);
    for (int m = 0; m < MEDIA; m++) {
        for (int l = 0; l < LENGTHS; l++) {
            double observed[BINS + 1] = {0.0}, expected[BINS + 1] = {0.0};
            const double range = isinf(lengths[l]) ? 8.0 : (double)lengths[l];
            for (int k = 0; k < 3; k++) {
                for (int i = 0; i < BINS; i++) {
                    const double a = range * i / BINS, b = range * (i + 1) / BINS;
                    const double s = sigma_t(&media[m], k);
                    expected[i] += (exp(-s * a) - exp(-s * b)) * count / 3.0;
                }
            }
            expected[BINS] = count;
            for (int i = 0; i < BINS; i++)
                expected[BINS] -= expected[i];
            for (uint32_t i = 0; i < count; i++) {
                const float c = ppmi_rng_float(&rng), u = ppmi_rng_float(&rng);
                const ppmi_medium_sample s =
                    ppmi_medium_sample_distance(&media[m], lengths[l], c, u);
                const int bin = (int)((double)s.distance / range * BINS);
                const bool is_inside = s.is_scattered && bin < BINS;
                observed[is_inside ? bin : BINS] += 1.0;
                assert_true(s.is_scattered || s.distance == lengths[l]);
            }
            family_add(&family, p_counts(observed, expected, BINS + 1), "medium %d, length %g", m,
                       (double)lengths[l]);
        }
    }
    family_check(&family);
}

/* Weights of what arrives have the mean exp(-sigma l), of what is scattered the integral of the
 * transmittance over the way, in each channel by itself. */
static void weights_have_the_means_of_the_integrals(void **state)
{
    (void)state;
    test_family family = {0};
    ppmi_rng rng = ppmi_rng_start(2, PPMI_STREAM_EYE, 0);
    for (int m = 0; m < MEDIA; m++) {
        for (int l = 0; l < LENGTHS; l++) {
            test_mean arrived[3] = {{0}}, scattered[3] = {{0}};
            for (uint32_t i = 0; i < TEST_EFFORT(100000); i++) {
                const float c = ppmi_rng_float(&rng), u = ppmi_rng_float(&rng);
                const ppmi_medium_sample s =
                    ppmi_medium_sample_distance(&media[m], lengths[l], c, u);
                const float w[3] = {s.weight.x, s.weight.y, s.weight.z};
                for (int k = 0; k < 3; k++) {
                    assert_true(isfinite(w[k]) && w[k] >= 0.0f);
                    mean_add(&arrived[k], s.is_scattered ? 0.0 : (double)w[k]);
                    mean_add(&scattered[k], s.is_scattered ? (double)w[k] : 0.0);
                }
            }
            for (int k = 0; k < 3; k++) {
                const double sigma = sigma_t(&media[m], k), length = (double)lengths[l];
                const double through = sigma > 0.0 ? exp(-sigma * length) : 1.0;
                family_add_mean(&family, &arrived[k], through, 1e-6, "arrived, %d, %d, %d", m, l,
                                k);
                if (isinf(lengths[l]) && !(sigma > 0.0)) continue; /* the integral has no end */
                const double integral = sigma > 0.0 ? (1.0 - through) / sigma : length;
                family_add_mean(&family, &scattered[k], integral, 1e-6, "scattered, %d, %d, %d", m,
                                l, k);
            }
        }
    }
    family_check(&family);
}

static const float asymmetries[] = {-0.9f, -0.5f, -0.01f, 0.0f, 1e-4f, 0.3f, 0.7f, 0.9f};
enum { ASYMMETRIES = 8 };

static void the_phase_function_integrates_to_1_with_mean_cosine_g(void **state)
{
    (void)state;
    const int steps = 200000;
    for (int i = 0; i < ASYMMETRIES; i++) {
        double sum = 0.0, cosines = 0.0;
        for (int k = 0; k < steps; k++) {
            const double cosine = -1.0 + 2.0 * (k + 0.5) / steps;
            const double value = (double)ppmi_phase(asymmetries[i], (float)cosine);
            sum += value * 4.0 * M_PI / steps;
            cosines += value * cosine * 4.0 * M_PI / steps;
        }
        assert_near(sum, 1.0, 1e-4);
        assert_near(cosines, asymmetries[i], 1e-4);
    }
}

/* Bins of equal solid angle along the cosine, and quarters by azimuth. */
static void directions_follow_the_phase_function(void **state)
{
    (void)state;
    test_family family = {0};
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_EYE, 0);
    const uint32_t count = TEST_EFFORT(100000);
    for (int a = 0; a < ASYMMETRIES; a++) {
        double observed[4 * BINS] = {0.0}, expected[4 * BINS] = {0.0};
        test_mean cosines = {0};
        for (uint32_t i = 0; i < count; i++) {
            const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
            const ppmi_vec3 d = ppmi_phase_sample(asymmetries[a], u, v);
            assert_near(vec3_length(d), 1.0, 1e-5);
            int bin = (int)((1.0 + (double)d.z) * 0.5 * BINS);
            bin = bin < BINS ? bin : BINS - 1;
            observed[4 * bin + (d.x > 0.0f) + 2 * (d.y > 0.0f)] += 1.0;
            mean_add(&cosines, (double)d.z);
        }
        for (int i = 0; i < BINS; i++) {
            const int steps = 200;
            double sum = 0.0;
            for (int k = 0; k < steps; k++) {
                const double cosine = -1.0 + 2.0 * (i + (k + 0.5) / steps) / BINS;
                sum += (double)ppmi_phase(asymmetries[a], (float)cosine);
            }
            for (int q = 0; q < 4; q++)
                expected[4 * i + q] = sum / steps * 4.0 * M_PI / BINS / 4.0 * count;
        }
        family_add(&family, p_counts(observed, expected, 4 * BINS), "g %g", (double)asymmetries[a]);
        /* below 1e-3 directions are even */
        family_add_mean(&family, &cosines, (double)asymmetries[a], 1e-4, "mean cosine, g %g",
                        (double)asymmetries[a]);
    }
    family_check(&family);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transmittance_is_exponential),
        cmocka_unit_test(distances_follow_the_extinction),
        cmocka_unit_test(weights_have_the_means_of_the_integrals),
        cmocka_unit_test(the_phase_function_integrates_to_1_with_mean_cosine_g),
        cmocka_unit_test(directions_follow_the_phase_function),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
