/* Directions are drawn with the density that is stated: chi-squared over bins of the sphere, the
 * density integrated in each bin; and weights are f |cos| / pdf.
 *
 * Narrow lobes: above the surface the bins lie around the mirror direction, below it around the
 * refracted one, and grow with the distance from it, so that each lobe is spread over many. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "support/near.h"
#include "support/statistics.h"

enum { RINGS = 24, SECTORS = 12, SIDES = 2, BINS = SIDES * RINGS * SECTORS };

/* Bins of one side (above, below) around its axis: rings by the versine 1 - cos = 2 t^4, t even in
 * 0..1; sectors by azimuth. */
typedef struct bins {
    ppmi_frame frames[SIDES];
    ppmi_vec3 normal;
} bins;

static int side_of(const bins *b, ppmi_vec3 d)
{
    return vec3_dot(d, b->normal) > 0.0f ? 0 : 1;
}

static ppmi_vec3 bin_direction(const bins *b, int side, double ring, double sector)
{
    const double t = ring / RINGS, versine = 2.0 * t * t * t * t;
    const double sine = sqrt(versine * (2.0 - versine)), phi = 2.0 * M_PI * sector / SECTORS;
    const ppmi_vec3 local =
        vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)(1.0 - versine));
    return vec3_normalize(ppmi_frame_to_world(&b->frames[side], local));
}

static int bin_of(const bins *b, ppmi_vec3 d)
{
    const int side = side_of(b, d);
    const ppmi_frame *frame = &b->frames[side];
    const ppmi_vec3 local = ppmi_frame_to_local(frame, d);
    /* the versine from the chord: 1 - cos loses the small ones */
    const double chord = (double)vec3_length(vec3_sub(d, frame->n));
    const int ring = (int)(sqrt(0.5 * chord) * RINGS);
    double turn = atan2((double)local.y, (double)local.x) / (2.0 * M_PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    const int sector = (int)(turn * SECTORS);
    return (side * RINGS + (ring < RINGS ? ring : RINGS - 1)) * SECTORS +
           (sector < SECTORS ? sector : SECTORS - 1);
}

/* Midpoint rule inside a bin, with the solid angle's density along t. */
static double bin_integral(const bins *b, const ppmi_bsdf *bsdf, int bin, int steps)
{
    const int side = bin / (RINGS * SECTORS), ring = bin / SECTORS % RINGS, sector = bin % SECTORS;
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        const double r = ring + (i + 0.5) / steps, t = r / RINGS;
        const double solid_angle = 8.0 * t * t * t / RINGS * 2.0 * M_PI / SECTORS;
        for (int k = 0; k < steps; k++) {
            const ppmi_vec3 d = bin_direction(b, side, r, sector + (k + 0.5) / steps);
            if (side_of(b, d) != side) continue;
            sum += solid_angle * (double)ppmi_bsdf_pdf(bsdf, d, PPMI_LOBE_ALL);
        }
    }
    return sum / (steps * steps);
}

static bins make_bins(const ppmi_bsdf *bsdf)
{
    const ppmi_vec3 wo = bsdf->wo;
    const float eta = bsdf->is_thin || bsdf->eta == 0.0f ? 1.0f : bsdf->eta;
    /* in total reflection the lobe below clings to the surface */
    const float sine2 = ppmi_min((1.0f - wo.z * wo.z) / (eta * eta), 1.0f);
    const ppmi_vec3 below = vec3_normalize(vec3(-wo.x / eta, -wo.y / eta, -sqrtf(1.0f - sine2)));
    const bool is_retro = bsdf->is_layered && bsdf->layers.retro == 1.0f;
    const ppmi_vec3 above = is_retro ? wo : vec3(-wo.x, -wo.y, wo.z);
    return (bins){{ppmi_frame_from_normal(ppmi_frame_to_world(&bsdf->frame, vec3_normalize(above))),
                   ppmi_frame_from_normal(ppmi_frame_to_world(&bsdf->frame, below))},
                  bsdf->ng};
}

typedef struct density_test {
    test_family family;
    uint64_t seed;
} density_test;

static double integrate_bin(const bins *b, const ppmi_bsdf *bsdf, int bin)
{
    const double coarse = bin_integral(b, bsdf, bin, 4), fine = bin_integral(b, bsdf, bin, 8);
    /* once more where the density varies much */
    const bool is_smooth = fabs(fine - coarse) < 1e-3 * fine + 1e-7;
    return is_smooth ? fine : bin_integral(b, bsdf, bin, 40);
}

/* The bins are fine around one direction, and there not finer along one axis than the other. */
static bool bins_can_tell(const bsdf_case *item, const ppmi_bsdf *bsdf)
{
    const uint32_t both = PPMI_LOBE_SPEC | PPMI_LOBE_RETRO;
    const bool is_wide = bsdf->is_layered && bsdf->layers.anisotropy > 0.0f;
    return item->roughness >= 0.5f || (!is_wide && (bsdf->lobes & both) != both);
}

/* What is not drawn, be it absorbed or delta, has a cell of its own. */
static void check_density(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user)
{
    if ((bsdf->lobes & ~bsdf->delta_lobes) == 0) return;
    if (!bins_can_tell(item, bsdf)) return;
    density_test *test = user;
    const uint32_t count = TEST_EFFORT(60000);
    const bins b = make_bins(bsdf);
    double observed[BINS + 1] = {0.0}, expected[BINS + 1], total = 0.0;
    for (int i = 0; i < BINS; i++) {
        const double integral = integrate_bin(&b, bsdf, i);
        total += integral;
        /* a bin that the horizon cuts may have all its midpoints below */
        expected[i] = integral * count + 1e-3;
    }
    if (total > 1.002) fail_msg("%s: the density integrates to %g", item->name, total);
    expected[BINS] = fmax(0.0, 1.0 - total) * count + 1e-3;
    ppmi_rng rng = ppmi_rng_start(test->seed++, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_bsdf_sample sample;
        const bool is_drawn = bsdf_draw(bsdf, &rng, PPMI_TRANSPORT_POWER, &sample);
        observed[is_drawn && !sample.is_delta ? bin_of(&b, sample.wi) : BINS] += 1.0;
    }
    family_add(&test->family, p_counts(observed, expected, BINS + 1), "%s", item->name);
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
    for (int k = 0; k < 200; k++) {
        const ppmi_vec3 wi = bsdf_random_direction(rng);
        double sum = 0.0, shares = 0.0;
        for (uint32_t i = 0; i < PPMI_LOBE_COUNT; i++) {
            const uint32_t lobe = 1u << i;
            if (lobe == PPMI_LOBE_PHASE) continue;
            const double share = (double)ppmi_bsdf_probability(bsdf, lobe);
            sum += share * (double)ppmi_bsdf_pdf(bsdf, wi, lobe);
            shares += share;
        }
        assert_near(shares, 1.0, 1e-5);
        const double all = (double)ppmi_bsdf_pdf(bsdf, wi, PPMI_LOBE_ALL);
        assert_near(sum, all, 1e-5 * all);
        ppmi_vec3 f = vec3_splat(0.0f);
        for (uint32_t i = 0; i < PPMI_LOBE_COUNT; i++) {
            const uint32_t lobe = 1u << i;
            if (lobe == PPMI_LOBE_PHASE) continue;
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
