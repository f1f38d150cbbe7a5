/* Profiles, their integrals, and tables of the inverses.
 *
 * Gaussian: standard deviation a sixth of the width, cut off at three of them. Blackman-Harris: the
 * four-term window of Harris 1978, "On the Use of Windows for Harmonic Analysis", table 1; at its
 * default width of 3 it is the filter that Blender's Cycles calls 1.5 pixels wide. */
#include "camera/filter.h"

static const double PI = 3.14159265358979323846;

float ppmi_pixel_filter_default_width(int32_t kind)
{
    return kind == PPM_PIXEL_FILTER_BOX ? 1.0f : 3.0f;
}

/* The share below x, in widths, of a window sum over k of a_k cos(2 pi k x) on -1/2 .. 1/2. */
static double blackman_harris_cdf(double x)
{
    static const double a[4] = {0.35875, 0.48829, 0.14128, 0.01168};
    double share = 0.5 + x;
    for (int k = 1; k < 4; k++)
        share += a[k] / a[0] * sin(2.0 * PI * k * x) / (2.0 * PI * k);
    return share;
}

/* The share below x, in widths, of a Gaussian that is cut off at 3 standard deviations. */
static double gaussian_cdf(double x)
{
    const double reach = 3.0 / sqrt(2.0);
    return 0.5 + 0.5 * erf(2.0 * reach * x) / erf(reach);
}

double ppmi_pixel_filter_cdf(int32_t kind, double width, double x)
{
    const double in_widths = x / width;
    if (in_widths <= -0.5) return 0.0;
    if (in_widths >= 0.5) return 1.0;
    switch (kind) {
    case PPM_PIXEL_FILTER_GAUSSIAN:
        return gaussian_cdf(in_widths);
    case PPM_PIXEL_FILTER_BLACKMAN_HARRIS:
        return blackman_harris_cdf(in_widths);
    }
    return 0.5 + in_widths; /* the box */
}

/* Where the cdf has a value, by bisection between the centre and the upper end. */
static double invert_cdf(int32_t kind, double width, double value)
{
    double low = 0.0, high = 0.5 * width;
    for (int i = 0; i < 48; i++) {
        const double middle = 0.5 * (low + high);
        if (ppmi_pixel_filter_cdf(kind, width, middle) < value) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

/* Steps of the table shrink, as shares, towards the end of the profile: linear interpolation in
 * equal shares would flatten the tails. The last cell holds a millionth. */
void ppmi_pixel_filter_init(ppmi_pixel_filter *filter, int32_t kind, float width)
{
    filter->kind = kind;
    filter->width = width;
    for (int i = 0; i <= PPMI_FILTER_CELLS; i++) {
        const double left = 1.0 - (double)i / PPMI_FILTER_CELLS;
        const double share_below = 1.0 - 0.5 * left * left;
        filter->quantiles[i] = (float)invert_cdf(kind, (double)width, share_below);
    }
}

float ppmi_pixel_filter_offset(const ppmi_pixel_filter *filter, float u)
{
    if (filter->kind == PPM_PIXEL_FILTER_BOX) return (u - 0.5f) * filter->width;
    const float side = 2.0f * u - 1.0f; /* exact, as is 1 - |side| */
    const float place = (1.0f - sqrtf(1.0f - fabsf(side))) * (float)PPMI_FILTER_CELLS;
    const int cell = place < (float)PPMI_FILTER_CELLS ? (int)place : PPMI_FILTER_CELLS - 1;
    const float part = place - (float)cell;
    const float *q = filter->quantiles + cell;
    return copysignf(q[0] + (q[1] - q[0]) * part, side);
}
