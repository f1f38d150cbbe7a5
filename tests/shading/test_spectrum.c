/* Wavelengths: drawn as the table says, white together, and indices with the Abbe number. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "shading/spectrum.h"
#include "support/near.h"
#include "support/statistics.h"

static ppmi_spectrum spectrum;

static int start(void **state)
{
    (void)state;
    ppmi_spectrum_init(&spectrum, &ppmi_working_space_rec709);
    return 0;
}

static void weights_are_not_negative_and_have_mean_1(void **state)
{
    (void)state;
    double sum[3] = {0.0};
    for (int i = 0; i < PPMI_SPECTRUM_BINS; i++) {
        const ppmi_vec3 w = spectrum.weight[i];
        const float probability = spectrum.cumulative[i + 1] - spectrum.cumulative[i];
        assert_true(w.x >= 0.0f && w.y >= 0.0f && w.z >= 0.0f && probability >= 0.0f);
        if (probability > 0.0f) assert_near(vec3_mean(w), 1.0, 1e-4);
        sum[0] += (double)(probability * w.x);
        sum[1] += (double)(probability * w.y);
        sum[2] += (double)(probability * w.z);
    }
    for (int k = 0; k < 3; k++)
        assert_near(sum[k], 1.0, 1e-4);
    assert_near(spectrum.cumulative[PPMI_SPECTRUM_BINS], 1.0, 0.0);
}

static void wavelengths_are_drawn_as_the_table_says(void **state)
{
    (void)state;
    static double observed[PPMI_SPECTRUM_BINS], expected[PPMI_SPECTRUM_BINS];
    test_mean means[3] = {{0}};
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    const uint32_t count = TEST_EFFORT(200000);
    for (uint32_t i = 0; i < count; i++) {
        const float w = ppmi_spectrum_sample(&spectrum, ppmi_rng_float(&rng));
        assert_true(w >= PPMI_SPECTRUM_FIRST_NM && w < PPMI_SPECTRUM_LAST_NM);
        observed[(int)w - PPMI_SPECTRUM_FIRST_NM] += 1.0;
        const ppmi_vec3 weight = ppmi_spectrum_weight(&spectrum, w);
        mean_add(&means[0], (double)weight.x);
        mean_add(&means[1], (double)weight.y);
        mean_add(&means[2], (double)weight.z);
    }
    for (int i = 0; i < PPMI_SPECTRUM_BINS; i++)
        expected[i] = (double)(spectrum.cumulative[i + 1] - spectrum.cumulative[i]) * count;
    test_family family = {0};
    family_add(&family, p_counts(observed, expected, PPMI_SPECTRUM_BINS), "wavelengths");
    for (int k = 0; k < 3; k++)
        family_add_mean(&family, &means[k], 1.0, 1e-4, "weights, channel %d", k);
    family_check(&family);
}

static void the_ends_of_u_are_within_the_table(void **state)
{
    (void)state;
    const float first = ppmi_spectrum_sample(&spectrum, 0.0f);
    const float last = ppmi_spectrum_sample(&spectrum, 0.99999994f);
    assert_true(first >= PPMI_SPECTRUM_FIRST_NM && last < PPMI_SPECTRUM_LAST_NM && last > 650.0f);
    assert_true(vec3_is_black(ppmi_spectrum_weight(&spectrum, 200.0f)));
    assert_true(vec3_is_black(ppmi_spectrum_weight(&spectrum, 900.0f)));
}

/* Blue, green and red light look so. */
static void colours_lie_where_they_should(void **state)
{
    (void)state;
    const ppmi_vec3 blue = ppmi_spectrum_weight(&spectrum, 450.0f);
    const ppmi_vec3 green = ppmi_spectrum_weight(&spectrum, 530.0f);
    const ppmi_vec3 red = ppmi_spectrum_weight(&spectrum, 640.0f);
    assert_true(blue.z > 5.0f * blue.y && blue.z > 5.0f * blue.x);
    assert_true(green.y > 5.0f * green.x && green.y > 5.0f * green.z);
    assert_true(red.x > 5.0f * red.y && red.x > 5.0f * red.z);
}

/* V_d = (n_d - 1) / (n_F - n_C). */
static void indices_have_the_abbe_number(void **state)
{
    (void)state;
    const struct {
        float index, abbe;
    } glasses[3] = {{1.5168f, 64.17f}, {1.6200f, 36.37f}, {1.7847f, 25.68f}};
    for (int i = 0; i < 3; i++) {
        const float dispersion = 20.0f / glasses[i].abbe;
        const double d = (double)ppmi_cauchy_index(glasses[i].index, dispersion, 587.6f);
        const double f = (double)ppmi_cauchy_index(glasses[i].index, dispersion, 486.1f);
        const double c = (double)ppmi_cauchy_index(glasses[i].index, dispersion, 656.3f);
        assert_near(d, glasses[i].index, 1e-6);
        assert_near((d - 1.0) / (f - c), glasses[i].abbe, 0.01 * (double)glasses[i].abbe);
        assert_true(f > d && d > c);
    }
    assert_near(ppmi_cauchy_index(1.5f, 0.0f, 400.0f), 1.5, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_are_not_negative_and_have_mean_1),
        cmocka_unit_test(wavelengths_are_drawn_as_the_table_says),
        cmocka_unit_test(the_ends_of_u_are_within_the_table),
        cmocka_unit_test(colours_lie_where_they_should),
        cmocka_unit_test(indices_have_the_abbe_number),
    };
    return cmocka_run_group_tests(tests, start, NULL);
}
