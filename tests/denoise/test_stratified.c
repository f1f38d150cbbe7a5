/* Variances of means, told from parts of the samples. */
#include "denoise/stratified.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

enum { WIDTH = 64, HEIGHT = 64, PIXELS = WIDTH * HEIGHT, SAMPLES = 16, FIRST = 8 };

static const float edge = 0.4f; /* of a pixel: what is below is white, the rest black */

typedef struct picture {
    float all[3 * PIXELS], first[3 * PIXELS], variance[3 * PIXELS], scratch[3 * PIXELS];
} picture;

static picture told;

static float draw(void)
{
    return (float)rand() / ((float)RAND_MAX + 1.0f);
}

/* Where in the pixel sample i is: anywhere, or in its own part by van der Corput's sequence, all
 * shifted alike. */
static float place(uint32_t i, bool is_stratified, float shift)
{
    if (!is_stratified) return draw();
    float radical_inverse = 0.0f;
    for (float digit = 0.5f; i > 0; i >>= 1, digit *= 0.5f)
        radical_inverse += (float)(i & 1u) * digit;
    return fmodf(radical_inverse + shift, 1.0f);
}

/* Each pixel's mean, and its variance as if samples were independent. Returns the true variance of
 * the means. */
static double fill(bool is_stratified)
{
    double error = 0.0;
    srand(7);
    for (size_t i = 0; i < PIXELS; i++) {
        const float shift = draw();
        float sum = 0.0f, first = 0.0f;
        for (uint32_t k = 0; k < SAMPLES; k++) {
            sum += place(k, is_stratified, shift) < edge ? 1.0f : 0.0f;
            if (k + 1 == FIRST) first = sum;
        }
        const float mean = sum / SAMPLES;
        for (size_t c = 3 * i; c < 3 * i + 3; c++) {
            told.all[c] = mean;
            told.first[c] = first / FIRST;
            told.variance[c] = mean * (1.0f - mean) / (SAMPLES - 1);
        }
        error += (double)((mean - edge) * (mean - edge)) / PIXELS;
    }
    return error;
}

static double mean_variance(void)
{
    double sum = 0.0;
    for (size_t i = 0; i < 3 * PIXELS; i++)
        sum += (double)told.variance[i] / (3 * PIXELS);
    return sum;
}

static void lower(void)
{
    const ppmi_stratified_means means = {WIDTH, HEIGHT, told.all, told.first,
                                         (float)FIRST / SAMPLES};
    ppmi_denoise_lower_variance(&means, told.variance, told.scratch);
}

/* The estimate by parts has a noise of its own, and only lowers: over 49 pixels its standard
 * deviation is sqrt(2 / 49) = 0.2 of the variance, of which 0.08 is lost on average. */
static void independent_samples_keep_their_variance(void **state)
{
    (void)state;
    const double truth = fill(false);
    lower();
    assert_true(fabs(mean_variance() / truth - 1.0) < 0.15);
}

/* Samples tell some ten times too much; what is told from parts is above the truth still. */
static void stratified_samples_lose_most_of_it(void **state)
{
    (void)state;
    const double truth = fill(true);
    assert_true(mean_variance() > 8.0 * truth);
    lower();
    assert_true(mean_variance() < 4.0 * truth);
    assert_true(mean_variance() > truth);
}

static void nothing_is_raised_or_made_of_nothing(void **state)
{
    (void)state;
    fill(false);
    for (size_t i = 0; i < 3 * PIXELS; i++) {
        told.variance[i] = i % 2 == 0 ? 1e-6f : 0.0f;
        told.first[i] = i < PIXELS ? told.all[i] : 5.0f;
    }
    lower();
    for (size_t i = 0; i < 3 * PIXELS; i++)
        assert_true(told.variance[i] >= 0.0f && told.variance[i] <= (i % 2 == 0 ? 1e-6f : 0.0f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(independent_samples_keep_their_variance),
        cmocka_unit_test(stratified_samples_lose_most_of_it),
        cmocka_unit_test(nothing_is_raised_or_made_of_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
