/* The guide: the density that is returned is the one that is drawn. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "photon/guide.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static ppm_context *context;
static ppmi_photon_guide guide;

static int open_context(void **state)
{
    (void)state;
    return ppm_context_create(NULL, &context) == PPM_STATUS_OK ? 0 : -1;
}

static int close_context(void **state)
{
    (void)state;
    ppm_context_destroy(context);
    return 0;
}

static ppmi_emission_sample even_sample(ppmi_rng *rng)
{
    ppmi_emission_sample sample;
    for (int k = 0; k < PPMI_GUIDE_AXES; k++)
        sample.x[k] = ppmi_rng_double(rng);
    return sample;
}

/* A box within the cube, 0.9 % of it, not along any cell. */
static bool is_useful(const ppmi_emission_sample *sample)
{
    return sample->x[0] < 0.37 && sample->x[1] > 0.6 && fabs(sample->x[3] - 0.5) < 0.03;
}

/* Learns from photons of that box; those at its upper end bring more. */
static void learn(uint32_t photons)
{
    ppmi_guide_seen *seen = calloc(photons, sizeof *seen);
    assert_non_null(seen);
    size_t count = 0;
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_PHOTON, 0);
    for (uint32_t i = 0; i < photons; i++) {
        const ppmi_emission_sample sample = even_sample(&rng);
        if (is_useful(&sample)) seen[count++] = (ppmi_guide_seen){sample, 1.0 + sample.x[1], 1.0};
    }
    assert_int_equal(ppmi_guide_learn(context, &guide, seen, count, (double)photons),
                     PPM_STATUS_OK);
    free(seen);
}

/* The mean of a function by guided samples over their density is its mean by even ones. */
static void means_by_density_are_those_of_even_samples(void **state)
{
    (void)state;
    learn(300000);
    assert_true(guide.count > 20);
    test_mean means[3] = {{0}};
    ppmi_rng rng = ppmi_rng_start(2, PPMI_STREAM_PHOTON, 0);
    for (uint32_t i = 0; i < TEST_EFFORT(400000); i++) {
        ppmi_emission_sample sample = even_sample(&rng);
        const double density = ppmi_guide_warp(&guide, &sample);
        assert_true(density >= 0.999 * PPMI_GUIDE_EVEN_SHARE);
        assert_near(ppmi_guide_density(&guide, &sample) / density, 1.0, 1e-9);
        for (int k = 0; k < PPMI_GUIDE_AXES; k++)
            assert_true(sample.x[k] >= 0.0 && sample.x[k] < 1.0);
        mean_add(&means[0], 1.0 / density);
        mean_add(&means[1], sample.x[0] * sample.x[1] * sample.x[4] / density);
        mean_add(&means[2], sample.x[2] * sample.x[2] * sample.x[3] / density);
    }
    test_family family = {0};
    const double expected[3] = {1.0, 0.125, 1.0 / 6.0};
    for (int i = 0; i < 3; i++) {
        mean_check_power(&means[i], 0.02);
        family_add_mean(&family, &means[i], expected[i], 0.0, "function %d", i);
    }
    family_check(&family);
}

static void the_density_integrates_to_one(void **state)
{
    (void)state;
    learn(300000);
    test_mean mean = {0};
    ppmi_rng rng = ppmi_rng_start(4, PPMI_STREAM_PHOTON, 0);
    for (uint32_t i = 0; i < TEST_EFFORT(400000); i++) {
        const ppmi_emission_sample sample = even_sample(&rng);
        mean_add(&mean, ppmi_guide_density(&guide, &sample));
    }
    test_family family = {0};
    mean_check_power(&mean, 0.03);
    family_add_mean(&family, &mean, 1.0, 0.0, "integral");
    family_check(&family);
}

static void samples_go_where_photons_were_seen(void **state)
{
    (void)state;
    learn(300000);
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_PHOTON, 0);
    uint32_t useful = 0;
    const uint32_t count = TEST_EFFORT(20000);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_emission_sample sample = even_sample(&rng);
        ppmi_guide_warp(&guide, &sample);
        useful += is_useful(&sample);
    }
    /* 0.9 % of even samples; cells that hold some of the box hold what is beside it too */
    assert_true(useful > 0.6 * count);
}

/* Strata of an axis are moved, not torn: the order of numbers along it stays. */
static void the_order_along_an_axis_stays(void **state)
{
    (void)state;
    learn(300000);
    ppmi_emission_sample before = {{0.2, 0.7, 0.5, 0.0, 0.5}};
    for (int i = 0; i < 1000; i++) {
        ppmi_emission_sample sample = {{0.2, 0.7, 0.5, (i + 0.5) / 1000.0, 0.5}};
        ppmi_guide_warp(&guide, &sample);
        if (i > 0) assert_true(sample.x[3] >= before.x[3]);
        before = sample;
    }
}

/* Two halves of the cube: all photons of the lower one bring 1; of the upper one, which brings
 * times as much in all, one in rarity. Returns the upper one's density. */
static double density_of_rare_half(uint32_t rarity, double times)
{
    enum { PHOTONS = 40000 };
    ppmi_guide_seen *seen = calloc(PHOTONS, sizeof *seen);
    assert_non_null(seen);
    size_t count = 0;
    ppmi_rng rng = ppmi_rng_start(5, PPMI_STREAM_PHOTON, 0);
    for (uint32_t i = 0; i < PHOTONS; i++) {
        const ppmi_emission_sample sample = even_sample(&rng);
        const bool is_rare = sample.x[2] >= 0.5;
        if (is_rare && ppmi_rng_float(&rng) * (float)rarity >= 1.0f) continue;
        seen[count++] = (ppmi_guide_seen){sample, is_rare ? times * rarity : 1.0, 1.0};
    }
    assert_int_equal(ppmi_guide_learn(context, &guide, seen, count, PHOTONS), PPM_STATUS_OK);
    free(seen);
    const ppmi_emission_sample middle = {{0.3, 0.3, 0.7, 0.3, 0.3}};
    return ppmi_guide_density(&guide, &middle);
}

static void where_few_photons_bring_much_more_are_sent(void **state)
{
    (void)state;
    const double even = PPMI_GUIDE_EVEN_SHARE;
    /* by the root of the share: 4 times as many for a sixteenth */
    assert_near(density_of_rare_half(16, 4.0), even + (1.0 - even) * 2.0 * 16.0 / 17.0, 0.05);
    /* here that would leave less than half of all to be of use */
    const double by_mean = even + (1.0 - even) * 2.0 / 5.0;
    const double upper = density_of_rare_half(16, 0.25);
    assert_true(upper > 1.1 * by_mean);
    assert_near(0.5 * (2.0 - upper) + 0.5 * upper / 16.0, 0.56, 0.02);
}

static void without_photons_the_guide_is_even(void **state)
{
    (void)state;
    assert_int_equal(ppmi_guide_learn(context, &guide, NULL, 0, 1.0), PPM_STATUS_OK);
    ppmi_emission_sample sample = {{0.1, 0.2, 0.3, 0.4, 0.5}};
    assert_near(ppmi_guide_warp(&guide, &sample), 1.0, 1e-12);
    assert_near(sample.x[3], 0.4, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_by_density_are_those_of_even_samples),
        cmocka_unit_test(the_density_integrates_to_one),
        cmocka_unit_test(samples_go_where_photons_were_seen),
        cmocka_unit_test(the_order_along_an_axis_stays),
        cmocka_unit_test(where_few_photons_bring_much_more_are_sent),
        cmocka_unit_test(without_photons_the_guide_is_even),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
