/* The filter on pictures whose truth and whose noise are known. */
#include "denoise/denoise.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 72, HEIGHT = 50, PIXELS = WIDTH * HEIGHT, VALUES = 3 * PIXELS };

static const float sigma = 0.1f;

typedef struct picture {
    float truth[VALUES], light[VALUES], variance[VALUES];
    float albedo[VALUES], normal[VALUES], depth[PIXELS];
    uint32_t threads;
} picture;

static ppm_context *context;
static picture noisy;

static int open_context(void **state)
{
    (void)state;
    context = NULL;
    return ppm_context_create(NULL, &context) == PPM_STATUS_OK ? 0 : 1;
}

static int close_context(void **state)
{
    (void)state;
    assert_int_equal(ppmi_alloc_live(context), 0);
    ppm_context_destroy(context);
    return 0;
}

/* ---- pictures -------------------------------------------------------------------------------- */

/* Uniform in 0..1; splitmix64 (Steele, Lea, Flood 2014). */
static double draw(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return ((double)((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
}

/* Box and Muller 1958. */
static float draw_normal(uint64_t *state)
{
    const double radius = sqrt(-2.0 * log(draw(state)));
    return (float)(radius * cos(6.283185307179586 * draw(state)));
}

/* Even light on a grey wall that faces the camera. */
static void start_wall(void)
{
    memset(&noisy, 0, sizeof noisy);
    noisy.threads = 1;
    for (size_t i = 0; i < PIXELS; i++) {
        noisy.depth[i] = 2.0f;
        noisy.normal[3 * i + 2] = 1.0f;
    }
    for (size_t i = 0; i < VALUES; i++) {
        noisy.albedo[i] = 0.5f;
        noisy.truth[i] = 1.0f;
    }
}

static bool is_in_disk(size_t pixel)
{
    const double x = (double)(pixel % WIDTH) - 35.5, y = (double)(pixel / WIDTH) - 24.5;
    return x * x + y * y < 15.0 * 15.0;
}

/* A bright spot on the wall, of which no feature tells. */
static void start_spot(float brightness)
{
    start_wall();
    for (size_t i = 0; i < PIXELS; i++) {
        for (size_t c = 0; c < 3; c++)
            noisy.truth[3 * i + c] = is_in_disk(i) ? brightness : 1.0f;
    }
}

/* Noise of each value by itself. */
static void add_noise(uint64_t seed)
{
    uint64_t state = seed;
    for (size_t i = 0; i < VALUES; i++) {
        noisy.light[i] = noisy.truth[i] + sigma * draw_normal(&state);
        noisy.variance[i] = sigma * sigma;
    }
}

/* Noise that neighbours share: of disks of a radius in pixels, as photons make it. */
static void add_blotches(uint64_t seed, int radius)
{
    static float white[3][HEIGHT + 32][WIDTH + 32];
    uint64_t state = seed;
    for (size_t i = 0; i < sizeof white / sizeof(float); i++)
        (&white[0][0][0])[i] = draw_normal(&state);
    for (size_t i = 0; i < VALUES; i++) {
        const int x = (int)(i / 3 % WIDTH) + 16, y = (int)(i / 3 / WIDTH) + 16;
        float sum = 0.0f, count = 0.0f;
        for (int dy = -radius; dy <= radius; dy++) {
            for (int dx = -radius; dx <= radius; dx++) {
                if (dx * dx + dy * dy > radius * radius) continue;
                sum += white[i % 3][y + dy][x + dx];
                count += 1.0f;
            }
        }
        noisy.light[i] = noisy.truth[i] + sigma * sum / sqrtf(count);
        noisy.variance[i] = sigma * sigma;
    }
}

static ppm_status denoise(float correlation_px)
{
    const ppmi_denoise_guide guide = {.width = WIDTH,
                                      .height = HEIGHT,
                                      .albedo = noisy.albedo,
                                      .normal = noisy.normal,
                                      .depth = noisy.depth,
                                      .threads = noisy.threads};
    const ppmi_denoise_noise noise = {.variance = noisy.variance, .correlation_px = correlation_px};
    return ppmi_denoise(context, &guide, &noise, noisy.light);
}

static double mean_square_error(void)
{
    double sum = 0.0;
    for (size_t i = 0; i < VALUES; i++) {
        const double error = (double)noisy.light[i] - (double)noisy.truth[i];
        sum += error * error;
    }
    return sum / VALUES;
}

/* The error after the filter by the error before. */
static double error_ratio(float correlation_px)
{
    const double before = mean_square_error();
    assert_int_equal(denoise(correlation_px), PPM_STATUS_OK);
    return mean_square_error() / before;
}

static double mean_where(bool in_disk)
{
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < PIXELS; i++) {
        if (is_in_disk(i) != in_disk) continue;
        sum += (double)noisy.light[3 * i + 1];
        count += 1.0;
    }
    return sum / count;
}

/* ---- tests ----------------------------------------------------------------------------------- */

static void test_memory_that_is_out_is_reported_wherever_it_is(void **state)
{
    (void)state;
    for (size_t i = 1; i <= 9; i++) {
        start_wall();
        add_noise(1);
        ppmi_alloc_fail_at(context, i);
        assert_int_equal(denoise(0.0f), PPM_STATUS_OUT_OF_MEMORY);
        assert_int_equal(ppmi_alloc_live(context), 0);
    }
    assert_int_equal(denoise(0.0f), PPM_STATUS_OK);
}

static void test_a_picture_without_noise_stays_as_it_is(void **state)
{
    (void)state;
    start_spot(3.0f);
    memcpy(noisy.light, noisy.truth, sizeof noisy.light);
    assert_int_equal(denoise(0.0f), PPM_STATUS_OK);
    assert_memory_equal(noisy.light, noisy.truth, sizeof noisy.light);
}

static void test_even_light_loses_nearly_all_its_noise(void **state)
{
    (void)state;
    start_wall();
    add_noise(2);
    const double ratio = error_ratio(0.0f);
    if (!(ratio < 0.02)) fail_msg("%.4f of the squared error is left", ratio);
}

static void test_light_is_neither_made_nor_lost(void **state)
{
    (void)state;
    start_spot(1.5f);
    add_noise(3);
    const double inside = mean_where(true), outside = mean_where(false);
    assert_int_equal(denoise(0.0f), PPM_STATUS_OK);
    assert_true(fabs(mean_where(true) / inside - 1.0) < 0.01);
    assert_true(fabs(mean_where(false) / outside - 1.0) < 0.01);
}

/* The step at the edge, of means along it: of pixels just inside and just outside. */
static double step_at_the_edge(void)
{
    double sums[2] = {0.0, 0.0}, counts[2] = {0.0, 0.0};
    for (size_t i = 0; i < PIXELS; i++) {
        const double x = (double)(i % WIDTH) - 35.5, y = (double)(i / WIDTH) - 24.5;
        if (fabs(sqrt(x * x + y * y) - 15.0) > 1.0) continue;
        sums[is_in_disk(i)] += (double)noisy.light[3 * i + 1];
        counts[is_in_disk(i)] += 1.0;
    }
    return sums[1] / counts[1] - sums[0] / counts[0];
}

static void test_the_edge_of_a_spot_stays_sharp(void **state)
{
    (void)state;
    start_spot(2.0f);
    add_noise(4);
    const double ratio = error_ratio(0.0f);
    if (!(ratio < 0.3)) fail_msg("%.4f of the squared error is left", ratio);
    const double step = step_at_the_edge();
    if (!(step > 0.95)) fail_msg("a step of 1 became one of %.4f", step);
}

/* Light that differs by less than its noise on two sides of an edge of a feature. */
static void check_features(float *feature, size_t channels, float other)
{
    start_wall();
    for (size_t i = 0; i < PIXELS; i++) {
        if (i % WIDTH < WIDTH / 2) continue;
        for (size_t c = 0; c < 3; c++)
            noisy.truth[3 * i + c] = 1.1f;
        for (size_t c = 0; c < channels; c++)
            feature[channels * i + c] = other;
    }
    add_noise(5);
    const double ratio = error_ratio(0.0f);
    if (!(ratio < 0.04)) fail_msg("%.4f of the squared error is left", ratio);
}

static void test_light_does_not_mix_across_edges_of_features(void **state)
{
    (void)state;
    check_features(noisy.albedo, 3, 0.8f);
    check_features(noisy.normal, 3, 0.5f);
    check_features(noisy.depth, 1, 2.5f);
}

static void test_a_slanted_plane_is_one_surface(void **state)
{
    (void)state;
    start_wall();
    for (size_t i = 0; i < PIXELS; i++)
        noisy.depth[i] = 1.0f / (0.02f + 0.02f * (float)(i / WIDTH));
    add_noise(6);
    const double ratio = error_ratio(0.0f);
    if (!(ratio < 0.02)) fail_msg("%.4f of the squared error is left", ratio);
}

/* Finer than any feature: only the risk's estimate can tell it from noise. */
static void test_a_pattern_of_light_is_not_taken_for_noise(void **state)
{
    (void)state;
    start_wall();
    for (size_t i = 0; i < VALUES; i++)
        noisy.truth[i] = 1.0f + 0.3f * (float)((i / 3 % WIDTH + i / 3 / WIDTH) % 2);
    add_noise(7);
    const double ratio = error_ratio(0.0f);
    if (!(ratio < 1.0)) fail_msg("%.4f of the squared error is left", ratio);
}

static void test_blotches_do_not_make_it_worse_and_spots_stay(void **state)
{
    (void)state;
    for (int radius = 1; radius <= 6; radius += 1) {
        start_spot(1.3f);
        add_blotches(8, radius);
        const double ratio = error_ratio((float)radius);
        if (!(ratio <= 1.0)) {
            fail_msg("blotches of radius %d: %.4f times the squared error", radius, ratio);
        }
    }
}

static void test_threads_change_no_bit(void **state)
{
    (void)state;
    static float first[VALUES];
    start_spot(2.0f);
    add_noise(9);
    assert_int_equal(denoise(0.0f), PPM_STATUS_OK);
    memcpy(first, noisy.light, sizeof first);
    start_spot(2.0f);
    add_noise(9);
    noisy.threads = 3;
    assert_int_equal(denoise(0.0f), PPM_STATUS_OK);
    assert_memory_equal(noisy.light, first, sizeof first);
}

static void test_the_unit_of_light_does_not_matter(void **state)
{
    (void)state;
    static float first[VALUES];
    const float scale = 0x1p-20f;
    start_spot(2.0f);
    add_noise(10);
    assert_int_equal(denoise(0.0f), PPM_STATUS_OK);
    memcpy(first, noisy.light, sizeof first);
    add_noise(10);
    for (size_t i = 0; i < VALUES; i++) {
        noisy.light[i] *= scale;
        noisy.variance[i] *= scale * scale;
    }
    assert_int_equal(denoise(0.0f), PPM_STATUS_OK);
    for (size_t i = 0; i < VALUES; i++)
        assert_true(fabsf(noisy.light[i] / scale - first[i]) < 1e-4f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory_that_is_out_is_reported_wherever_it_is),
        cmocka_unit_test(test_a_picture_without_noise_stays_as_it_is),
        cmocka_unit_test(test_even_light_loses_nearly_all_its_noise),
        cmocka_unit_test(test_light_is_neither_made_nor_lost),
        cmocka_unit_test(test_the_edge_of_a_spot_stays_sharp),
        cmocka_unit_test(test_light_does_not_mix_across_edges_of_features),
        cmocka_unit_test(test_a_slanted_plane_is_one_surface),
        cmocka_unit_test(test_a_pattern_of_light_is_not_taken_for_noise),
        cmocka_unit_test(test_blotches_do_not_make_it_worse_and_spots_stay),
        cmocka_unit_test(test_threads_change_no_bit),
        cmocka_unit_test(test_the_unit_of_light_does_not_matter),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
