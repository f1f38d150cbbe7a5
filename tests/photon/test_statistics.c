/* The progressive estimate's formulas, in the plane and in space. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "photon/statistics.h"
#include "support/near.h"

static const ppmi_dimension dimensions[2] = {PPMI_DISK, PPMI_BALL};

static double extent(double s, ppmi_dimension d)
{
    return d == PPMI_DISK ? M_PI * s * s : 4.0 / 3.0 * M_PI * s * s * s;
}

static void extents_are_those_of_disk_and_ball(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        assert_near(ppmi_extent_of(1.7f, dimensions[i]), extent(1.7, dimensions[i]), 1e-5);
        assert_near(ppmi_root_of(ppmi_power_of(1.7f, dimensions[i]), dimensions[i]), 1.7, 1e-6);
    }
}

/* N' = N + alpha M, R'^d = R^d N' / (N + M). */
static void one_update_is_as_in_the_paper(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        ppmi_gather_statistics s = {.tau = {3.0f, 2.0f, 1.0f}, .count = 10.0f, .scale = 2.0f};
        ppmi_statistics_update(&s, dimensions[i], 0.7f, vec3(1.0f, 2.0f, 0.0f), 5.0f);
        const double g = 13.5 / 15.0;
        assert_near(s.count, 13.5, 1e-6);
        assert_near(s.tau.x, 4.0 * g, 1e-6);
        assert_near(s.tau.z, 1.0 * g, 1e-6);
        assert_near(extent((double)s.scale, dimensions[i]), extent(2.0, dimensions[i]) * g, 1e-4);
    }
}

static void nothing_found_changes_nothing(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        ppmi_gather_statistics s = {.tau = {3.0f, 2.0f, 1.0f}, .count = 10.0f, .scale = 2.0f};
        ppmi_statistics_update(&s, dimensions[i], 0.7f, vec3_splat(0.0f), 0.0f);
        ppmi_statistics_update(&s, dimensions[i], 0.7f, vec3_splat(NAN), 3.0f);
        ppmi_statistics_update(&s, dimensions[i], 0.7f, vec3_splat(INFINITY), 3.0f);
        assert_near(s.count, 10.0, 0.0);
        assert_near(s.scale, 2.0, 0.0);
        assert_near(s.tau.y, 2.0, 0.0);
    }
}

/* Passes that find what an even density gives leave the radiance at what it is, whatever the
 * radius shrinks to and whatever the footprint's unit is. */
static void an_even_density_keeps_its_radiance(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const ppmi_dimension d = dimensions[i];
        ppmi_gather_statistics s = {.scale = 3.0f};
        double half_way = 0.0;
        const double per_pass = 1000.0, density = 50.0; /* photons by area or volume, a pass */
        for (int pass = 1; pass <= 200; pass++) {
            const float unit = 0.1f + 0.001f * (float)(pass % 7);
            const double found = density * extent((double)(s.scale * unit), d);
            const float tau = (float)found / ppmi_power_of(unit, d);
            ppmi_statistics_update(&s, d, 2.0f / 3.0f, vec3_splat(tau), (float)found);
            if (pass == 100) half_way = (double)s.scale;
            const ppmi_vec3 radiance = ppmi_statistics_radiance(&s, d, pass * per_pass);
            assert_near(radiance.x, density / per_pass, 1e-4 * density / per_pass);
        }
        /* v ~ i^(alpha - 1), but for the first passes */
        assert_near((double)s.scale / half_way, pow(2.0, -1.0 / 3.0 / d), 0.01);
    }
}

static void with_alpha_1_the_radius_stays(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        ppmi_gather_statistics s = {.scale = 3.0f};
        for (int pass = 0; pass < 10; pass++)
            ppmi_statistics_update(&s, dimensions[i], 1.0f, vec3_splat(2.0f), 4.0f);
        assert_near(s.scale, 3.0, 1e-6);
        assert_near(s.count, 40.0, 1e-5);
        assert_near(s.tau.x, 20.0, 1e-4);
    }
}

static void no_photons_are_black(void **state)
{
    (void)state;
    const ppmi_gather_statistics s = {.tau = {1.0f, 1.0f, 1.0f}, .scale = 1.0f};
    assert_near(ppmi_statistics_radiance(&s, PPMI_DISK, 0.0).x, 0.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extents_are_those_of_disk_and_ball),
        cmocka_unit_test(one_update_is_as_in_the_paper),
        cmocka_unit_test(nothing_found_changes_nothing),
        cmocka_unit_test(an_even_density_keeps_its_radiance),
        cmocka_unit_test(with_alpha_1_the_radius_stays),
        cmocka_unit_test(no_photons_are_black),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
