/* P-values by the incomplete gamma and beta functions: series and continued fractions as in Press
 * et al., "Numerical Recipes", chapter 6 (the method; the code is ours). */
#include "support/statistics.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static const double family_level = 1e-4;

/* ---- p-values -------------------------------------------------------------------------------- */

double p_normal(double z)
{
    return erfc(fabs(z) / sqrt(2.0));
}

/* Lower regularised gamma by its series, for x < a + 1. */
static double gamma_series(double a, double x)
{
    double term = 1.0 / a, sum = term;
    for (int n = 1; n < 10000 && term > sum * 1e-16; n++) {
        term *= x / (a + n);
        sum += term;
    }
    return sum * exp(a * log(x) - x - lgamma(a));
}

static double not_zero(double x)
{
    return fabs(x) < 1e-300 ? 1e-300 : x;
}

/* Upper regularised gamma by Lentz's continued fraction, for x >= a + 1. */
static double gamma_fraction(double a, double x)
{
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
    for (int i = 1; i < 10000; i++) {
        const double an = -i * (i - a);
        b += 2.0;
        d = 1.0 / not_zero(an * d + b);
        c = not_zero(b + an / c);
        const double step = d * c;
        h *= step;
        if (fabs(step - 1.0) < 1e-15) break;
    }
    return h * exp(a * log(x) - x - lgamma(a));
}

double p_chi_squared(double x, double freedom)
{
    const double a = 0.5 * freedom;
    x *= 0.5;
    if (!(x > 0.0)) return 1.0;
    return x < a + 1.0 ? 1.0 - gamma_series(a, x) : gamma_fraction(a, x);
}

/* The continued fraction of the incomplete beta function. */
static double beta_fraction(double a, double b, double x)
{
    double c = 1.0, d = 1.0 / not_zero(1.0 - (a + b) * x / (a + 1.0)), h = d;
    for (int m = 1; m < 10000; m++) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1.0 / not_zero(1.0 + even * d);
        c = not_zero(1.0 + even / c);
        h *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1.0 / not_zero(1.0 + odd * d);
        c = not_zero(1.0 + odd / c);
        const double step = d * c;
        h *= step;
        if (fabs(step - 1.0) < 1e-15) break;
    }
    return h;
}

static double beta_regularised(double a, double b, double x)
{
    if (!(x > 0.0)) return 0.0;
    if (x >= 1.0) return 1.0;
    const double front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log(1.0 - x));
    if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
    return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

double p_student(double t, double freedom)
{
    return beta_regularised(0.5 * freedom, 0.5, freedom / (freedom + t * t));
}

double p_counts(const double *observed, const double *expected, size_t cells)
{
    const double least_expected = 8.0;
    double sum = 0.0, pooled_observed = 0.0, pooled_expected = 0.0;
    double total_observed = 0.0, total_expected = 0.0;
    size_t pools = 0;
    for (size_t i = 0; i < cells; i++) {
        if (expected[i] <= 0.0 && observed[i] > 0.0) return 0.0;
        total_observed += observed[i];
        total_expected += expected[i];
        pooled_observed += observed[i];
        pooled_expected += expected[i];
        if (pooled_expected < least_expected) continue;
        const double difference = pooled_observed - pooled_expected;
        sum += difference * difference / pooled_expected;
        pools++;
        pooled_observed = pooled_expected = 0.0;
    }
    if (pooled_expected > 0.0) {
        /* the rest is too small for a cell of its own: as a variance it still counts */
        const double difference = pooled_observed - pooled_expected;
        sum += difference * difference / (pooled_expected + least_expected);
        pools++;
    }
    /* equal totals were given, not found: they cost one degree of freedom */
    const bool is_bound = fabs(total_observed - total_expected) < 0.5;
    const double freedom = (double)pools - (is_bound ? 1.0 : 0.0);
    return freedom >= 1.0 ? p_chi_squared(sum, freedom) : 1.0;
}

/* ---- means ----------------------------------------------------------------------------------- */

void mean_add(test_mean *mean, double value)
{
    mean->count++;
    const double before = value - mean->mean;
    mean->mean += before / (double)mean->count;
    mean->squares += before * (value - mean->mean);
}

double mean_error(const test_mean *mean)
{
    const double n = (double)mean->count;
    return mean->count > 1 ? sqrt(mean->squares / (n - 1.0) / n) : INFINITY;
}

/* ---- families -------------------------------------------------------------------------------- */

static void family_note(test_family *family, double p, const char *format, va_list arguments)
{
    if (family->count == 0 || p < family->least || isnan(p)) {
        family->least = isnan(p) ? 0.0 : p;
        vsnprintf(family->least_label, sizeof family->least_label, format, arguments);
    }
    family->count++;
}

void family_add(test_family *family, double p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    family_note(family, p, format, arguments);
    va_end(arguments);
}

/* Student's p of a deviation beyond what is allowed. A mean without any variance has to be right
 * to the last float bits. */
static double p_deviation(const test_mean *mean, double deviation, double scale)
{
    const double error = mean_error(mean);
    if (isnan(deviation) || isinf(error)) return 0.0;
    if (!(deviation > 0.0)) return 1.0;
    const double rounding = 1e-6 * fabs(scale);
    if (error < rounding) return deviation < 3.0 * rounding ? 1.0 : 0.0;
    return p_student(deviation / error, (double)mean->count - 1.0);
}

static void note_mean(test_family *family, double p, const test_mean *mean, double expected,
                      const char *format, va_list arguments)
{
    char label[128];
    vsnprintf(label, sizeof label, format, arguments);
    family_add(family, p, "%s: %.6g +- %.2g, expected %.6g", label, mean->mean, mean_error(mean),
               expected);
}

void family_add_mean(test_family *family, const test_mean *mean, double expected, double systematic,
                     const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const double deviation = fabs(mean->mean - expected) - systematic;
    note_mean(family, p_deviation(mean, deviation, expected), mean, expected, format, arguments);
    va_end(arguments);
}

void family_add_at_most(test_family *family, const test_mean *mean, double most, const char *format,
                        ...)
{
    va_list arguments;
    va_start(arguments, format);
    note_mean(family, p_deviation(mean, mean->mean - most, most), mean, most, format, arguments);
    va_end(arguments);
}

void family_check(const test_family *family)
{
    if (family->count == 0) fail_msg("no comparison was made");
    const double threshold = -expm1(log1p(-family_level) / family->count);
    if (!(family->least >= threshold)) {
        fail_msg("least p of %u comparisons is %.3g, below %.3g, at: %s", family->count,
                 family->least, threshold, family->least_label);
    }
}

void mean_check_power(const test_mean *mean, double resolution)
{
    if (TEST_EFFORT_PERCENT < 100) return;
    const double relative = mean_error(mean) / fabs(mean->mean);
    if (!(relative <= resolution)) {
        fail_msg("standard error of %.6g is %.3g of it: the test needs %.3g", mean->mean, relative,
                 resolution);
    }
}
