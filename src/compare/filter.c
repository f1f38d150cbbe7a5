/* Filters of FLIP (Andersson et al., HPG 2020).
 *
 * Section 4.1.1: contrast sensitivity as sums of Gaussians a sqrt(pi / b) exp(-pi^2 r^2 / b), r in
 * degrees, with table 1's a and b (after Johnson and Fairchild 2003). Section 4.2: features seen
 * through a Gaussian derivative whose peak and trough are 0.082 degrees apart (Fogel and Sagi
 * 1989). Both are normalised over a square of pixels. Every term is a product of a function of x
 * and one of y, so a square of n^2 taps costs two rows of n. */
#include "compare/filter.h"

#include <math.h>
#include <string.h>

/* ---- kernels --------------------------------------------------------------------------------- */

static const double pi = 3.14159265358979323846;

/* The widest standard deviation of a CSF's spatial term, that of b = 0.04, sets the square of all:
 * three of it. */
static int32_t csf_radius(double pixels_per_degree)
{
    const double widest_b = 0.04;
    return (int32_t)ceil(3 * sqrt(widest_b / (2 * pi * pi)) * pixels_per_degree);
}

/* Taps exp(-pi^2 (x / pixels_per_degree)^2 / b) that sum to 1. Returns the sum before. */
static double make_gaussian(double exponent, int32_t radius, ppmi_compare_kernel *out_kernel)
{
    double sum = 0;
    for (int32_t x = -radius; x <= radius; x++)
        sum += exp(-exponent * x * x);
    out_kernel->radius = radius;
    for (int32_t x = -radius; x <= radius; x++)
        out_kernel->taps[x + radius] = (float)(exp(-exponent * x * x) / sum);
    return sum;
}

void ppmi_compare_csf_make(int channel, double pixels_per_degree, ppmi_compare_csf *out_csf)
{
    static const struct {
        int32_t count;
        double a[PPMI_COMPARE_TERMS_MAX], b[PPMI_COMPARE_TERMS_MAX];
    } table[] = {
        [PPMI_COMPARE_ACHROMATIC] = {1, {1.0}, {0.0047}},
        [PPMI_COMPARE_RED_GREEN] = {1, {1.0}, {0.0053}},
        [PPMI_COMPARE_BLUE_YELLOW] = {2, {34.1, 13.5}, {0.04, 0.025}},
    };
    const int32_t radius = csf_radius(pixels_per_degree);
    double shares[PPMI_COMPARE_TERMS_MAX] = {0}, total = 0;
    out_csf->term_count = table[channel].count;
    for (int32_t i = 0; i < out_csf->term_count; i++) {
        const double b = table[channel].b[i];
        const double sum = make_gaussian(pi * pi / (b * pixels_per_degree * pixels_per_degree),
                                         radius, &out_csf->kernels[i]);
        shares[i] = table[channel].a[i] * sqrt(pi / b) * sum * sum;
        total += shares[i];
    }
    for (int32_t i = 0; i < out_csf->term_count; i++)
        out_csf->weights[i] = (float)(shares[i] / total);
}

/* Scales the taps above zero to a sum of 1, those below to one of -1. */
static void normalise_sides(const double *taps, ppmi_compare_kernel *kernel)
{
    double above = 0, below = 0;
    for (int32_t k = 0; k <= 2 * kernel->radius; k++) {
        if (taps[k] > 0) above += taps[k];
        if (taps[k] < 0) below -= taps[k];
    }
    for (int32_t k = 0; k <= 2 * kernel->radius; k++)
        kernel->taps[k] = (float)(taps[k] / (taps[k] > 0 ? above : below));
}

void ppmi_compare_detector_make(double pixels_per_degree, ppmi_compare_detector *out_detector)
{
    const double deviation = 0.5 * 0.082 * pixels_per_degree;
    const double variance = deviation * deviation;
    const int32_t radius = (int32_t)ceil(3 * deviation);
    double edge[2 * PPMI_COMPARE_RADIUS_MAX + 1], point[2 * PPMI_COMPARE_RADIUS_MAX + 1];
    for (int32_t x = -radius; x <= radius; x++) {
        const double gaussian = exp(-x * x / (2 * variance));
        edge[x + radius] = -x * gaussian;
        point[x + radius] = (x * x / variance - 1) * gaussian;
    }
    make_gaussian(1 / (2 * variance), radius, &out_detector->gaussian);
    out_detector->edge.radius = out_detector->point.radius = radius;
    normalise_sides(edge, &out_detector->edge);
    normalise_sides(point, &out_detector->point);
}

/* ---- application ----------------------------------------------------------------------------- */

static int64_t clamp(int64_t value, int64_t low, int64_t high)
{
    return value < low ? low : value > high ? high : value;
}

/* out[x] += weight * in[x + shift], in continued by its ends. */
static void add_shifted(float *restrict out, const float *restrict in, int64_t count, int64_t shift,
                        float weight)
{
    const int64_t begin = clamp(-shift, 0, count), end = clamp(count - shift, 0, count);
    for (int64_t x = 0; x < begin; x++)
        out[x] += weight * in[0];
    for (int64_t x = begin; x < end; x++)
        out[x] += weight * in[x + shift];
    for (int64_t x = end; x < count; x++)
        out[x] += weight * in[count - 1];
}

void ppmi_compare_filter_rows(const float *in, float *out, uint32_t width, uint32_t height,
                              const ppmi_compare_kernel *kernel)
{
#pragma omp parallel for schedule(static) if ((size_t)width * height >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t y = 0; y < height; y++) {
        float *const row = out + y * width;
        memset(row, 0, width * sizeof *row);
        for (int32_t k = 0; k <= 2 * kernel->radius; k++)
            add_shifted(row, in + y * width, width, k - kernel->radius, kernel->taps[k]);
    }
}

void ppmi_compare_filter_columns(const float *in, float *out, uint32_t width, uint32_t height,
                                 const ppmi_compare_kernel *kernel)
{
#pragma omp parallel for schedule(static) if ((size_t)width * height >= PPMI_COMPARE_PARALLEL_MIN)
    for (int64_t y = 0; y < height; y++) {
        float *const row = out + y * width;
        memset(row, 0, width * sizeof *row);
        for (int32_t k = 0; k <= 2 * kernel->radius; k++) {
            const int64_t from = clamp(y + k - kernel->radius, 0, (int64_t)height - 1);
            add_shifted(row, in + from * width, width, 0, kernel->taps[k]);
        }
    }
}
