/* assert_float_equal lets NaN pass; this does not. */
#ifndef TEST_SUPPORT_NEAR_H
#define TEST_SUPPORT_NEAR_H

#include <math.h>

/* Fails unless the two numbers differ by at most tolerance. Include cmocka.h before use. */
#define assert_near(actual, expected, tolerance)                                                   \
    do {                                                                                           \
        const double near_actual = (double)(actual), near_expected = (double)(expected);           \
        if (!(fabs(near_actual - near_expected) <= (double)(tolerance))) {                         \
            fail_msg("%s is %.9g, expected %.9g within %.3g", #actual, near_actual, near_expected, \
                     (double)(tolerance));                                                         \
        }                                                                                          \
    } while (0)

#endif
