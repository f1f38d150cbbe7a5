/* What the grid of BSDFs does not show: leaning shading normals, odd indices, what gathers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "support/near.h"
#include "support/statistics.h"

static ppmi_material_point plain(void)
{
    return (ppmi_material_point){.base_color = {0.8f, 0.8f, 0.8f},
                                 .roughness = 0.5f,
                                 .ior = 1.5f,
                                 .specular = 1.0f,
                                 .specular_color = {1.0f, 1.0f, 1.0f},
                                 .ns = {0.0f, 0.0f, 1.0f}};
}

static ppmi_bsdf make(const ppmi_material_point *point, ppmi_vec3 wo)
{
    const ppmi_surface surface = {.ng = {0.0f, 0.0f, 1.0f}, .ns = point->ns};
    ppmi_bsdf bsdf;
    ppmi_bsdf_make(bsdf_albedo(), &surface, point, vec3_normalize(wo), &bsdf);
    return bsdf;
}

static void black_reflects_nothing(void **state)
{
    (void)state;
    ppmi_material_point point = plain();
    point.base_color = vec3_splat(0.0f);
    point.specular = 0.0f;
    const ppmi_bsdf bsdf = make(&point, vec3(0, 0, 1));
    assert_int_equal(bsdf.lobes, 0);
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    ppmi_bsdf_sample sample;
    assert_false(bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_RADIANCE, &sample));
    assert_near(ppmi_bsdf_pdf(&bsdf, vec3(0, 0, 1), PPMI_LOBE_ALL), 0.0, 0.0);
}

static void a_mirror_reflects_in_one_direction(void **state)
{
    (void)state;
    ppmi_material_point point = plain();
    point.metallic = 1.0f;
    point.roughness = 0.0f;
    point.base_color = vec3(1.0f, 0.5f, 0.25f);
    const ppmi_bsdf bsdf = make(&point, vec3(0.6f, 0.0f, 0.8f));
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    ppmi_bsdf_sample sample;
    assert_true(bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_RADIANCE, &sample));
    assert_true(sample.is_delta && !sample.is_transmission);
    assert_near(sample.wi.x, -0.6, 1e-6);
    assert_near(sample.wi.z, 0.8, 1e-6);
    const double schlick = pow(1.0 - 0.8, 5.0);
    assert_near(sample.weight.y, 0.5 + 0.5 * schlick, 1e-5);
}

static void opaque_surfaces_look_the_same_from_behind(void **state)
{
    (void)state;
    const ppmi_material_point point = plain();
    const ppmi_bsdf front = make(&point, vec3(0.3f, 0.2f, 0.9f));
    const ppmi_bsdf back = make(&point, vec3(0.3f, 0.2f, -0.9f));
    assert_true(back.ng.z < 0.0f);
    const ppmi_vec3 wi = vec3_normalize(vec3(-0.5f, 0.1f, 0.6f));
    const ppmi_vec3 f =
        ppmi_bsdf_eval(&front, bsdf_albedo(), wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE);
    const ppmi_vec3 g = ppmi_bsdf_eval(&back, bsdf_albedo(), vec3(wi.x, wi.y, -wi.z), PPMI_LOBE_ALL,
                                       PPMI_TRANSPORT_RADIANCE);
    assert_near(f.x, g.x, 1e-5f * f.x);
}

/* Whatever the shading normal does: nothing that is drawn or evaluated goes through an opaque
 * surface, and transmission does. */
static void leaning_normals_do_not_leak(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(2, PPMI_STREAM_EYE, 0);
    for (int i = 0; i < 20000; i++) {
        ppmi_material_point point = plain();
        point.ns = bsdf_random_direction(&rng);
        point.ns.z = fabsf(point.ns.z) + 0.01f;
        point.ns = vec3_normalize(point.ns);
        point.metallic = i % 3 == 0 ? 1.0f : 0.0f;
        point.transmission = i % 3 == 1 ? 1.0f : 0.0f;
        point.roughness = i % 2 ? 0.4f : 0.0f;
        const ppmi_bsdf bsdf = make(&point, bsdf_random_direction(&rng));
        ppmi_bsdf_sample sample;
        if (bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_RADIANCE, &sample)) {
            const float side = vec3_dot(sample.wi, bsdf.ng);
            assert_int_equal(side < 0.0f, sample.is_transmission);
            assert_true(vec3_is_finite(sample.weight));
            assert_near(vec3_length(sample.wi), 1.0, 1e-5);
        }
        if (point.transmission > 0.0f) continue;
        const ppmi_vec3 behind = vec3_neg(bsdf.ng);
        const ppmi_vec3 wi = vec3_normalize(vec3_mad(bsdf_random_direction(&rng), behind, 1.001f));
        const ppmi_vec3 f =
            ppmi_bsdf_eval(&bsdf, bsdf_albedo(), wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE);
        assert_near(f.x, 0.0, 0.0);
        assert_near(ppmi_bsdf_pdf(&bsdf, wi, PPMI_LOBE_ALL), 0.0, 0.0);
    }
}

static void glass_without_an_index_step_passes_straight(void **state)
{
    (void)state;
    ppmi_material_point point = plain();
    point.transmission = 1.0f;
    point.ior = 1.0f;
    const ppmi_vec3 wo = vec3_normalize(vec3(0.5f, -0.3f, 0.4f));
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_EYE, 0);
    for (int side = -1; side <= 1; side += 2) {
        const ppmi_bsdf bsdf = make(&point, vec3_scale(wo, (float)side));
        for (int i = 0; i < 100; i++) {
            ppmi_bsdf_sample sample;
            assert_true(bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_RADIANCE, &sample));
            assert_true(sample.is_transmission);
            assert_near(vec3_dot(sample.wi, vec3_scale(wo, (float)-side)), 1.0, 1e-6);
            assert_near(sample.weight.y, 0.8, 1e-5);
        }
    }
}

static void index_zero_means_full_reflection(void **state)
{
    (void)state;
    ppmi_material_point point = plain();
    point.ior = 0.0f;
    point.roughness = 0.0f;
    const ppmi_bsdf bsdf = make(&point, vec3(0, 0, 1));
    assert_true(ppmi_bsdf_probability(&bsdf, PPMI_LOBE_SPEC) > 0.998f);
    assert_near(bsdf.f0.x, 1.0, 1e-3);
}

static void without_specular_a_surface_is_lambert(void **state)
{
    (void)state;
    ppmi_material_point point = plain();
    point.specular = 0.0f;
    for (float roughness = 0.0f; roughness <= 1.0f; roughness += 0.25f) {
        point.roughness = roughness;
        const ppmi_bsdf bsdf = make(&point, vec3(0.9f, 0.0f, 0.1f));
        assert_int_equal(bsdf.lobes, PPMI_LOBE_WIDE);
        const ppmi_vec3 f = ppmi_bsdf_eval(&bsdf, bsdf_albedo(), vec3(0, 0, 1), PPMI_LOBE_ALL,
                                           PPMI_TRANSPORT_RADIANCE);
        assert_near(f.x, 0.8 / M_PI, 1e-6);
    }
}

static void only_wide_lobes_gather(void **state)
{
    (void)state;
    ppmi_material_point point = plain();
    const float roughnesses[] = {0.0f, 0.1f, 0.3f, 0.6f, 1.0f};
    for (int i = 0; i < 5; i++) {
        point.roughness = roughnesses[i];
        const ppmi_bsdf bsdf = make(&point, vec3(0, 0, 1));
        assert_true(bsdf.gather_lobes & PPMI_LOBE_WIDE);
        assert_int_equal((bsdf.gather_lobes & PPMI_LOBE_SPEC) != 0, roughnesses[i] >= 0.5f);
        assert_int_equal(bsdf.gather_lobes & bsdf.delta_lobes, 0);
        assert_int_equal(bsdf.gather_lobes & ~bsdf.lobes, 0);
    }
    point.transmission = 1.0f;
    const ppmi_bsdf glass = make(&point, vec3(0, 0, 1));
    assert_int_equal(glass.gather_lobes, 0);
}

/* At its rim an object's shading normal turns away from the eye: still a finite, sane BSDF. */
static void normals_seen_from_behind_are_bent(void **state)
{
    (void)state;
    ppmi_material_point point = plain();
    point.ns = vec3_normalize(vec3(1.0f, 0.0f, 0.05f));
    const ppmi_bsdf bsdf = make(&point, vec3(-0.9f, 0.0f, 0.05f));
    assert_true(bsdf.wo.z >= 0.02f && bsdf.wo.z < 0.5f);
    assert_near(vec3_length(bsdf.frame.n), 1.0, 1e-5);
    assert_near(vec3_length(bsdf.wo), 1.0, 1e-4);
}

/* A path that follows all branches carries what one that draws them carries in the mean. */
static void branches_are_the_mean_of_draws(void **state)
{
    (void)state;
    static const int kinds[] = {KIND_PLASTIC,    KIND_GLASS,      KIND_GLASS_INSIDE,
                                KIND_THIN_GLASS, KIND_HALF_GLASS, KIND_WATER_TO_GLASS};
    test_family family = {0};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        bsdf_case item;
        ppmi_bsdf bsdf;
        bsdf_make_case(kinds[k], 0.0f, 0.7f, &item, &bsdf);
        ppmi_bsdf_sample branches[PPMI_BSDF_MAX_BRANCHES];
        const uint32_t count = ppmi_bsdf_branches(&bsdf, bsdf_albedo(), PPMI_LOBE_ALL,
                                                  PPMI_TRANSPORT_RADIANCE, branches);
        assert_true(count >= 1);
        double expected = 0.0;
        for (uint32_t i = 0; i < count; i++) {
            assert_true(branches[i].is_delta);
            assert_near(vec3_length(branches[i].wi), 1.0, 1e-5);
            expected += (double)branches[i].weight.y;
        }
        test_mean mean = {0};
        ppmi_rng rng = ppmi_rng_start(k, PPMI_STREAM_EYE, 0);
        for (uint32_t i = 0; i < TEST_EFFORT(20000); i++) {
            ppmi_bsdf_sample sample;
            const bool is_drawn = bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_RADIANCE, &sample);
            mean_add(&mean, is_drawn && sample.is_delta ? (double)sample.weight.y : 0.0);
        }
        family_add_mean(&family, &mean, expected, 1e-5, "%s", item.name);
    }
    family_check(&family);
}

/* The scattering of a medium: sigma_s times the phase function, without a cosine or a normal. */
static void a_point_in_a_medium_scatters_by_its_phase_function(void **state)
{
    (void)state;
    const ppmi_medium medium = {.sigma_s = {0.5f, 0.3f, 0.1f}, .asymmetry_g = 0.6f};
    const ppmi_vec3 wo = vec3_normalize(vec3(0.3f, -0.4f, 0.8f));
    ppmi_bsdf bsdf;
    ppmi_bsdf_make_phase(&medium, wo, &bsdf);
    assert_int_equal(bsdf.lobes, PPMI_LOBE_PHASE);
    assert_int_equal(bsdf.gather_lobes, PPMI_LOBE_PHASE);
    assert_near(vec3_length(ppmi_bsdf_normal(&bsdf)), 0.0, 0.0);
    ppmi_rng rng = ppmi_rng_start(8, PPMI_STREAM_EYE, 0);
    test_mean forward = {0};
    for (int i = 0; i < 5000; i++) {
        ppmi_bsdf_sample sample;
        assert_true(bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_RADIANCE, &sample));
        const float cosine = vec3_dot(sample.wi, vec3_neg(wo));
        const float phase = ppmi_phase(0.6f, cosine);
        assert_near(sample.pdf, phase, 1e-3f * phase);
        assert_near(ppmi_bsdf_pdf(&bsdf, sample.wi, PPMI_LOBE_ALL), phase, 1e-3f * phase);
        const ppmi_vec3 f =
            ppmi_bsdf_eval(&bsdf, bsdf_albedo(), sample.wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_POWER);
        assert_near(f.x, 0.5f * phase, 1e-3f * phase);
        assert_near(sample.weight.y, 0.3, 1e-6);
        assert_near(ppmi_bsdf_cosine(&bsdf, sample.wi), 1.0, 0.0);
        mean_add(&forward, (double)cosine);
    }
    test_family family = {0};
    family_add_mean(&family, &forward, 0.6, 0.0, "mean cosine");
    family_check(&family);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(black_reflects_nothing),
        cmocka_unit_test(a_mirror_reflects_in_one_direction),
        cmocka_unit_test(opaque_surfaces_look_the_same_from_behind),
        cmocka_unit_test(leaning_normals_do_not_leak),
        cmocka_unit_test(glass_without_an_index_step_passes_straight),
        cmocka_unit_test(index_zero_means_full_reflection),
        cmocka_unit_test(without_specular_a_surface_is_lambert),
        cmocka_unit_test(only_wide_lobes_gather),
        cmocka_unit_test(normals_seen_from_behind_are_bent),
        cmocka_unit_test(branches_are_the_mean_of_draws),
        cmocka_unit_test(a_point_in_a_medium_scatters_by_its_phase_function),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
