/* The kernels, and pairs of them against the square of taps that they stand for. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare/filter.h"
#include "support/near.h"

static const double pi = 3.14159265358979323846;
enum { WIDTH = 41, HEIGHT = 33, PIXELS = WIDTH * HEIGHT };

static double sum_of(const ppmi_compare_kernel *kernel, int side)
{
    double sum = 0;
    for (int32_t k = 0; k <= 2 * kernel->radius; k++) {
        const double tap = (double)kernel->taps[k];
        if (side == 0 || tap * side > 0) sum += tap;
    }
    return sum;
}

static void contrast_filters_sum_to_one(void **state)
{
    (void)state;
    static const double densities[] = {1, 20, 67, 1000};
    static ppmi_compare_csf csf;
    for (int channel = 0; channel < 3; channel++) {
        for (size_t d = 0; d < 4; d++) {
            ppmi_compare_csf_make(channel, densities[d], &csf);
            double weights = 0;
            for (int32_t i = 0; i < csf.term_count; i++) {
                weights += (double)csf.weights[i];
                assert_near(sum_of(&csf.kernels[i], 0), 1, 1e-5);
            }
            assert_near(weights, 1, 1e-6);
        }
    }
}

static void detectors_are_balanced(void **state)
{
    (void)state;
    static const double densities[] = {1, 20, 67, 1000};
    static ppmi_compare_detector detector;
    for (size_t d = 0; d < 4; d++) {
        ppmi_compare_detector_make(densities[d], &detector);
        assert_near(sum_of(&detector.gaussian, 0), 1, 1e-5);
        assert_near(sum_of(&detector.edge, 1), 1, 1e-5);
        assert_near(sum_of(&detector.edge, -1), -1, 1e-5);
        assert_near(sum_of(&detector.point, 1), 1, 1e-5);
        assert_near(sum_of(&detector.point, -1), -1, 1e-5);
    }
}

/* The published square: a sum of Gaussians over the sum of all its taps. */
static double dense_csf(const float *plane, int x, int y, int radius, const double *a,
                        const double *b, int terms, double density)
{
    double sum = 0, total = 0;
    for (int dy = -radius; dy <= radius; dy++) {
        for (int dx = -radius; dx <= radius; dx++) {
            const double r2 = (dx * dx + dy * dy) / (density * density);
            double tap = 0;
            for (int i = 0; i < terms; i++)
                tap += a[i] * sqrt(pi / b[i]) * exp(-pi * pi * r2 / b[i]);
            const int from_x = x + dx < 0 ? 0 : x + dx >= WIDTH ? WIDTH - 1 : x + dx;
            const int from_y = y + dy < 0 ? 0 : y + dy >= HEIGHT ? HEIGHT - 1 : y + dy;
            sum += tap * (double)plane[from_y * WIDTH + from_x];
            total += tap;
        }
    }
    return sum / total;
}

static void fill(float *plane)
{
    for (int i = 0; i < PIXELS; i++)
        plane[i] = (float)((i * 7919) % 101) / 101;
}

static void pairs_of_kernels_are_the_published_square(void **state)
{
    (void)state;
    static float plane[PIXELS], across[PIXELS], down[PIXELS], result[PIXELS];
    static ppmi_compare_csf csf;
    const double density = 67, a[2] = {34.1, 13.5}, b[2] = {0.04, 0.025};
    fill(plane);
    memset(result, 0, sizeof result);
    ppmi_compare_csf_make(PPMI_COMPARE_BLUE_YELLOW, density, &csf);
    assert_int_equal(csf.kernels[0].radius, 10); /* 3 sqrt(0.04 / 2 pi^2) 67 is 9.05 */
    for (int32_t i = 0; i < csf.term_count; i++) {
        ppmi_compare_filter_rows(plane, across, WIDTH, HEIGHT, &csf.kernels[i]);
        ppmi_compare_filter_columns(across, down, WIDTH, HEIGHT, &csf.kernels[i]);
        for (int p = 0; p < PIXELS; p++)
            result[p] += csf.weights[i] * down[p];
    }
    static const int places[][2] = {{0, 0}, {20, 16}, {40, 32}, {3, 30}, {37, 2}};
    for (size_t i = 0; i < 5; i++) {
        const int x = places[i][0], y = places[i][1];
        assert_near(result[y * WIDTH + x], dense_csf(plane, x, y, 10, a, b, 2, density), 2e-6);
    }
}

static void rows_and_columns_are_each_other_turned(void **state)
{
    (void)state;
    static float plane[PIXELS], turned[PIXELS], rows[PIXELS], columns[PIXELS];
    static ppmi_compare_detector detector;
    ppmi_compare_detector_make(67, &detector);
    fill(plane);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            turned[x * HEIGHT + y] = plane[y * WIDTH + x];
    }
    ppmi_compare_filter_rows(plane, rows, WIDTH, HEIGHT, &detector.edge);
    ppmi_compare_filter_columns(turned, columns, HEIGHT, WIDTH, &detector.edge);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            assert_near(rows[y * WIDTH + x], columns[x * HEIGHT + y], 1e-6);
    }
}

/* A step of height 1 lies wholly under the positive half of the derivative. */
static void edge_detector_answers_one_at_a_step(void **state)
{
    (void)state;
    static float plane[PIXELS], edges[PIXELS], points[PIXELS];
    static ppmi_compare_detector detector;
    ppmi_compare_detector_make(67, &detector);
    for (int i = 0; i < PIXELS; i++)
        plane[i] = i % WIDTH > 20 ? 1 : 0;
    ppmi_compare_filter_rows(plane, edges, WIDTH, HEIGHT, &detector.edge);
    assert_near(fabs((double)edges[16 * WIDTH + 20]), 1, 1e-5);
    assert_near(edges[16 * WIDTH + 2], 0, 1e-6);
    assert_near(edges[16 * WIDTH + 38], 0, 1e-6);
    ppmi_compare_filter_columns(plane, points, WIDTH, HEIGHT, &detector.edge);
    assert_near(points[16 * WIDTH + 20], 0, 1e-6);
}

/* A line one pixel wide has the point detector's centre, a trough, as its answer. */
static void point_detector_answers_to_a_line(void **state)
{
    (void)state;
    static float plane[PIXELS], points[PIXELS], edges[PIXELS];
    static ppmi_compare_detector detector;
    ppmi_compare_detector_make(67, &detector);
    for (int i = 0; i < PIXELS; i++)
        plane[i] = i % WIDTH == 20 ? 1 : 0;
    ppmi_compare_filter_rows(plane, points, WIDTH, HEIGHT, &detector.point);
    ppmi_compare_filter_rows(plane, edges, WIDTH, HEIGHT, &detector.edge);
    const int32_t centre = detector.point.radius;
    assert_near(points[16 * WIDTH + 20], detector.point.taps[centre], 1e-7);
    assert_true(detector.point.taps[centre] < -0.1f);
    assert_near(edges[16 * WIDTH + 20], 0, 1e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contrast_filters_sum_to_one),
        cmocka_unit_test(detectors_are_balanced),
        cmocka_unit_test(pairs_of_kernels_are_the_published_square),
        cmocka_unit_test(rows_and_columns_are_each_other_turned),
        cmocka_unit_test(edge_detector_answers_one_at_a_step),
        cmocka_unit_test(point_detector_answers_to_a_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
