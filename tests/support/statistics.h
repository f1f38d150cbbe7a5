/* Statistics for tests of random processes.
 *
 * A test gathers the p-values of all its comparisons in a family and checks the least of them
 * against the level of the whole family (1e-4, Sidak's correction). Seeds are fixed: a test that
 * passes once passes always, and the level says how unlikely a right program was to fail when the
 * test was written. Nothing is compared to a tolerance by taste: where a systematic error is known
 * (a table's interpolation, facets of a ball), its bound is an argument. */
#ifndef TEST_SUPPORT_STATISTICS_H
#define TEST_SUPPORT_STATISTICS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifndef TEST_EFFORT_PERCENT
#define TEST_EFFORT_PERCENT 100
#endif

/* A number of samples, fewer where the build is slow. */
#define TEST_EFFORT(n) ((uint32_t)((uint64_t)(n)*TEST_EFFORT_PERCENT / 100 + 1))

/* ---- p-values -------------------------------------------------------------------------------- */

double p_normal(double z);                      /* two-sided */
double p_student(double t, double freedom);     /* two-sided */
double p_chi_squared(double x, double freedom); /* upper tail */

/* Chi-squared of observed counts against expected ones (not below 0; the totals need not agree: a
 * cell for what is missing is the caller's). Cells are pooled until each expects 8. A count where
 * nothing is expected gives 0. */
double p_counts(const double *observed, const double *expected, size_t cells);

/* ---- means ----------------------------------------------------------------------------------- */

typedef struct test_mean {
    uint64_t count;
    double mean, squares; /* sum of squared deviations (Welford 1962) */
} test_mean;

void mean_add(test_mean *mean, double value);
double mean_error(const test_mean *mean); /* standard error */

/* ---- families of comparisons ----------------------------------------------------------------- */

typedef struct test_family {
    uint32_t count;
    double least;
    char least_label[192];
} test_family;

void family_add(test_family *family, double p, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The mean against what it should be, up to systematic, a bound of known systematic errors. */
void family_add_mean(test_family *family, const test_mean *mean, double expected, double systematic,
                     const char *format, ...) __attribute__((format(printf, 5, 6)));

/* As before, but only a mean above most is held against it. */
void family_add_at_most(test_family *family, const test_mean *mean, double most, const char *format,
                        ...) __attribute__((format(printf, 4, 5)));

/* Fails the running test when the least p-value is too small for the family. */
void family_check(const test_family *family);

/* Fails the running test unless the standard error of the mean is at most resolution (relative, in
 * a build at full effort): keeps tests from passing because they see nothing. */
void mean_check_power(const test_mean *mean, double resolution);

#endif
