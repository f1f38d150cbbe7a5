/* Directions are drawn with the density that is stated: chi-squared over bins of the sphere, the
 * density integrated in each bin; and weights are f |cos| / pdf.
 *
 * Narrow lobes: bins are placed around the lobe's own axis, with sizes that grow with the distance
 * from it, so that each lobe is spread over many. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "support/near.h"
#include "support/statistics.h"

enum { RINGS = 24, SECTORS = 12, BINS = RINGS * SECTORS };

/* Bins around an axis: rings by the versine 1 - cos = 2 t^4, t even in 0..1; sectors by azimuth. */
typedef struct bins {
    ppmi_frame frame;
} bins;

static ppmi_vec3 bin_direction(const bins *b, double ring, double sector)
{
    const double t = ring / RINGS, versine = 2.0 * t * t * t * t;
    const double sine = sqrt(versine * (2.0 - versine)), phi = 2.0 * M_PI * sector / SECTORS;
    return ppmi_frame_to_world(&b->frame, vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)),
                                               (float)(1.0 - versine)));
}

static int bin_of(const bins *b, ppmi_vec3 d)
{
    const ppmi_vec3 local = ppmi_frame_to_local(&b->frame, d);
    /* the versine from the chord: 1 - cos loses the small ones */
    const double chord = (double)vec3_length(vec3_sub(d, b->frame.n));
    const double t = sqrt(sqrt(0.25 * chord * chord));
    int ring = (int)(t * RINGS);
    ring = ring < RINGS ? ring : RINGS - 1;
    double turn = atan2((double)local.y, (double)local.x) / (2.0 * M_PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    const int sector = (int)(turn * SECTORS);
    return ring * SECTORS + (sector < SECTORS ? sector : SECTORS - 1);
}

/* Midpoint rule inside a bin, with the solid angle's density along t. */
static double bin_integral(const bins *b, const ppmi_bsdf *bsdf, int bin, int steps)
{
    const int ring = bin / SECTORS, sector = bin % SECTORS;
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        const double r = ring + (i + 0.5) / steps, t = r / RINGS;
        const double solid_angle = 8.0 * t * t * t / RINGS * 2.0 * M_PI / SECTORS;
        for (int k = 0; k < steps; k++) {
            const ppmi_vec3 d = bin_direction(b, r, sector + (k + 0.5) / steps);
            sum += solid_angle *
                   (double)ppmi_bsdf_pdf(bsdf, vec3_normalize(d), PPMI_LOBE_ALL);
        }
    }
    return sum / (steps * steps);
}

/* Where the lobes are: the mirror direction, and the refracted one. */
static uint32_t lobe_axes(const ppmi_bsdf *bsdf, ppmi_vec3 axes[3])
{
    const ppmi_vec3 wo = bsdf->wo;
    axes[0] = ppmi_frame_to_world(&bsdf->frame, vec3(-wo.x, -wo.y, wo.z));
    if (!(bsdf->lobes & PPMI_LOBE_GLASS)) return 1;
    const float eta = bsdf->is_thin ? 1.0f : bsdf->eta;
    const float sine2 = (1.0f - wo.z * wo.z) / (eta * eta);
    if (sine2 >= 1.0f) return 1;
    axes[1] = ppmi_frame_to_world(&bsdf->frame,
                                  vec3(-wo.x / eta, -wo.y / eta, -sqrtf(1.0f - sine2)));
    return 2;
}

typedef struct density_test {
    test_family family;
    uint64_t seed;
} density_test;

/* What is not drawn, be it absorbed or delta, has a cell of its own. */
static void compare_around(const bsdf_case *item, const ppmi_bsdf *bsdf, ppmi_vec3 axis,
                           density_test *test)
{
    const uint32_t count = TEST_EFFORT(40000);
    const bins b = {ppmi_frame_from_normal(vec3_normalize(axis))};
    double observed[BINS + 1] = {0.0}, expected[BINS + 1], total = 0.0;
    for (int i = 0; i < BINS; i++) {
        const double coarse = bin_integral(&b, bsdf, i, 4), fine = bin_integral(&b, bsdf, i, 8);
        /* the bin is integrated again where its density varies much */
        const bool is_smooth = fabs(fine - coarse) < 1e-3 * fine + 1e-7;
        expected[i] = is_smooth ? fine : bin_integral(&b, bsdf, i, 40);
        total += expected[i];
        /* a bin that the horizon cuts may have all its midpoints below */
        expected[i] = expected[i] * count + 1e-3;
    }
    if (total > 1.02) fail_msg("%s: the density integrates to %g", item->name, total);
    expected[BINS] = fmax(0.0, 1.0 - total) * count;
    if (expected[BINS] < 1e-3 * count) expected[BINS] += 1e-3; /* rounding of a whole density */
    ppmi_rng rng = ppmi_rng_start(test->seed++, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_bsdf_sample sample;
        const bool is_drawn = bsdf_draw(bsdf, &rng, PPMI_TRANSPORT_POWER, &sample);
        observed[is_drawn && !sample.is_delta ? bin_of(&b, sample.wi) : BINS] += 1.0;
    }
    {double p=p_counts(observed, expected, BINS + 1); if(p<1e-5) { printf("P %s: %g total %g none %g/%g\n", item->name, p, total, observed[BINS], expected[BINS]); int k=0; for(int i=0;i<BINS&&k<6;i++) { double z=(observed[i]-expected[i])/sqrt(expected[i]+1); if(fabs(z)>4) {k++;printf("   ring %d sec %d obs %g exp %g\n",i/SECTORS,i%SECTORS,observed[i],expected[i]);} } } }
    family_add(&test->family, p_counts(observed, expected, BINS + 1), "%s", item->name);
}

static void check_density(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user)
{
    if ((bsdf->lobes & ~bsdf->delta_lobes) == 0) return;
    ppmi_vec3 axes[3];
    const uint32_t count = lobe_axes(bsdf, axes);
    for (uint32_t i = 0; i < count; i++)
        compare_around(item, bsdf, axes[i], user);
}

static void directions_are_drawn_with_their_density(void **state)
{
    (void)state;
    density_test test = {.seed = 1};
    bsdf_for_all(check_density, &test);
    family_check(&test.family);
    assert_true(test.family.count > 200);
}

/* The pdf of a sample is the density at its direction, and its weight the value by that density. */
static void check_weights(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user)
{
    ppmi_rng *rng = user;
    const uint32_t count = TEST_EFFORT(2000);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_bsdf_sample s;
        const ppmi_transport transport = i % 2 ? PPMI_TRANSPORT_RADIANCE : PPMI_TRANSPORT_POWER;
        if (!bsdf_draw(bsdf, rng, transport, &s)) continue;
        assert_near(vec3_length(s.wi), 1.0, 1e-5);
        assert_true(vec3_is_finite(s.weight) && s.weight.x >= 0.0f);
        const bool is_below = vec3_dot(s.wi, bsdf->ng) < 0.0f;
        assert_int_equal(s.is_transmission, is_below);
        if (s.is_delta) {
            assert_near(s.pdf, 0.0, 0.0);
            continue;
        }
        assert_near(s.pdf / ppmi_bsdf_pdf(bsdf, s.wi, PPMI_LOBE_ALL), 1.0, 1e-5);
        const ppmi_vec3 f = ppmi_bsdf_eval(bsdf, bsdf_albedo(), s.wi, PPMI_LOBE_ALL, transport);
        const double expected = (double)(f.y * fabsf(ppmi_bsdf_cosine(bsdf, s.wi)) / s.pdf);
        assert_near(s.weight.y, expected, 1e-5 * expected);
    }
    (void)item;
}

static void weights_are_value_times_cosine_by_density(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(2, PPMI_STREAM_EYE, 0);
    bsdf_for_all(check_weights, &rng);
}

/* Each lobe drawn alone has its own density, and the densities add up by their shares. */
static void check_lobes(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user)
{
    ppmi_rng *rng = user;
    (void)item;
    for (int i = 0; i < 200; i++) {
        const ppmi_vec3 wi = bsdf_random_direction(rng);
        double sum = 0.0, shares = 0.0;
        for (uint32_t lobe = 1; lobe <= 4; lobe *= 2) {
            const double share = (double)ppmi_bsdf_probability(bsdf, lobe);
            sum += share * (double)ppmi_bsdf_pdf(bsdf, wi, lobe);
            shares += share;
        }
        assert_near(shares, 1.0, 1e-5);
        const double all = (double)ppmi_bsdf_pdf(bsdf, wi, PPMI_LOBE_ALL);
        assert_near(sum, all, 1e-5 * all);
        ppmi_vec3 f = vec3_splat(0.0f);
        for (uint32_t lobe = 1; lobe <= 4; lobe *= 2) {
            f = vec3_add(f, ppmi_bsdf_eval(bsdf, bsdf_albedo(), wi, lobe, PPMI_TRANSPORT_POWER));
        }
        const ppmi_vec3 whole =
            ppmi_bsdf_eval(bsdf, bsdf_albedo(), wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_POWER);
        assert_near(f.x, whole.x, 1e-5f * whole.x);
    }
}

static void lobes_add_up(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_EYE, 0);
    bsdf_for_all(check_lobes, &rng);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_are_drawn_with_their_density),
        cmocka_unit_test(weights_are_value_times_cosine_by_density),
        cmocka_unit_test(lobes_add_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
