/* Rough glass, solid and thin: all light comes back, of any index, roughness and angle, and the
 * same way forth and back. That directions are drawn with their density is in test_bsdf_density.c.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "shading/microfacet.h"
#include "support/near.h"
#include "support/statistics.h"

static const float indices[] = {1.05f, 1.2f, 1.5f, 2.0f, 2.5f};
static const float roughnesses[] = {0.04f, 0.1f, 0.2f, 0.35f, 0.5f, 0.75f, 1.0f};
static const float cosines[] = {1.0f, 0.7f, 0.4f, 0.15f, 0.05f};
enum { INDICES = 5, ROUGHS = 7, ANGLES = 5 };

typedef struct glass_case {
    float index, roughness;
    bool is_thin;
    ppmi_vec3 color;
} glass_case;

static void make(const glass_case *glass, ppmi_vec3 wo, ppmi_bsdf *bsdf)
{
    const ppmi_vec3 up = vec3(0.0f, 0.0f, 1.0f);
    const ppmi_surface surface = {.ng = up, .ns = up};
    const ppmi_material_point point = {.base_color = glass->color,
                                       .roughness = glass->roughness,
                                       .ior = glass->index,
                                       .specular = 1.0f,
                                       .specular_color = {1.0f, 1.0f, 1.0f},
                                       .transmission = 1.0f,
                                       .is_thin = glass->is_thin,
                                       .ns = up};
    ppmi_bsdf_make(bsdf_albedo(), &surface, &point, wo, bsdf);
}

/* z: cosine, below 0 from inside. */
static ppmi_vec3 direction(float z)
{
    return vec3(sqrtf(ppmi_max(0.0f, 1.0f - z * z)), 0.0f, z);
}

typedef void (*glass_check)(const glass_case *glass, float z, void *user);

/* Solid from both sides, thin from one. */
static void for_all(glass_check check, void *user)
{
    for (int side = 0; side < 3; side++) {
        for (int n = 0; n < INDICES; n++) {
            for (int r = 0; r < ROUGHS; r++) {
                const glass_case glass = {
                    indices[n], roughnesses[r], side == 2, {1.0f, 1.0f, 1.0f}};
                for (int c = 0; c < ANGLES; c++)
                    check(&glass, side == 1 ? -cosines[c] : cosines[c], user);
            }
        }
    }
}

typedef struct glass_test {
    test_family family;
    ppmi_rng rng;
    double worst; /* the widest spread of weights */
} glass_test;

static void add_name(test_family *family, const test_mean *mean, double expected, double error,
                     const glass_case *glass, float z)
{
    family_add_mean(family, mean, expected, error, "%s, index %g, roughness %g, cosine %g",
                    glass->is_thin ? "thin" : "solid", (double)glass->index,
                    (double)glass->roughness, (double)z);
}

/* ---- energy -----------------------------------------------------------------------------------
 */

static void check_is_white(const glass_case *glass, float z, void *user)
{
    glass_test *test = user;
    ppmi_bsdf bsdf;
    make(glass, direction(z), &bsdf);
    assert_int_equal(bsdf.delta_lobes, 0);
    test_mean mean = {0};
    const uint32_t count = TEST_EFFORT(10000);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_bsdf_sample s;
        const bool is_drawn = bsdf_draw(&bsdf, &test->rng, PPMI_TRANSPORT_POWER, &s);
        mean_add(&mean, is_drawn ? (double)s.weight.y : 0.0);
    }
    mean_check_power(&mean, 0.01);
    test->worst = fmax(test->worst, mean.squares / (double)mean.count);
    /* 1 %: the table between its entries */
    add_name(&test->family, &mean, 1.0, 0.01, glass, z);
}

static void white_rough_glass_returns_all_light(void **state)
{
    (void)state;
    glass_test test = {.rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0)};
    for_all(check_is_white, &test);
    family_check(&test.family);
    /* what multiple scattering returns is drawn by about its own density; by the cosine alone the
     * squares of the weights would be many times as much */
    assert_true(test.worst < 1.0);
}

/* ---- colour -----------------------------------------------------------------------------------
 */

/* Light is tinted once where it goes through, however often it was scattered, and not where it is
 * reflected. */
static void only_what_goes_through_is_tinted(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(2, PPMI_STREAM_EYE, 0);
    for (int thin = 0; thin < 2; thin++) {
        for (int k = 0; k < 1000; k++) {
            const glass_case white = {1.5f, 0.8f, thin == 1, {1.0f, 1.0f, 1.0f}};
            const glass_case tinted = {1.5f, 0.8f, thin == 1, {0.25f, 0.5f, 1.0f}};
            const ppmi_vec3 wo = bsdf_random_direction(&rng), wi = bsdf_random_direction(&rng);
            ppmi_bsdf plain, colored;
            make(&white, wo, &plain);
            make(&tinted, wo, &colored);
            const ppmi_vec3 f =
                ppmi_bsdf_eval(&plain, bsdf_albedo(), wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_POWER);
            const ppmi_vec3 g =
                ppmi_bsdf_eval(&colored, bsdf_albedo(), wi, PPMI_LOBE_ALL, PPMI_TRANSPORT_POWER);
            const bool is_through = wo.z * wi.z < 0.0f;
            assert_near(g.x, is_through ? 0.25f * f.x : f.x, 1e-5f * f.x);
            assert_near(g.y, is_through ? 0.5f * f.y : f.y, 1e-5f * f.y);
            assert_near(g.z, f.z, 1e-5f * f.z);
        }
    }
}

/* ---- both ways --------------------------------------------------------------------------------
 */

/* n_o^2 f(i -> o) = n_i^2 f(o -> i) (Veach 1997, equation 5.14). Only what multiple scattering
 * returns: single scattering is in test_bsdf_energy.c, and its rounding would hide the small part.
 */
static void check_is_reciprocal(const glass_case *glass, float z, void *user)
{
    ppmi_rng *rng = user;
    ppmi_bsdf here, there;
    for (int k = 0; k < 40; k++) {
        const ppmi_vec3 wo = direction(z), wi = bsdf_random_direction(rng);
        if (fabsf(wi.z) < 0.025f) continue; /* there the shading normal is bent */
        make(glass, wo, &here);
        make(glass, wi, &there);
        const bool is_through = wo.z * wi.z < 0.0f;
        const double eta2 = is_through && !glass->is_thin ? (double)(here.eta * here.eta) : 1.0;
        const float lost_there = there.glass_lost, lost_here = here.glass_lost;
        const double forth =
            (double)((is_through ? here.glass_through : here.glass_back) * lost_there);
        const double back =
            (double)((is_through ? there.glass_through : there.glass_back) * lost_here);
        assert_near(forth, back * eta2, 1e-5 * forth + 1e-12);
    }
}

static void multiple_scattering_is_reciprocal(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_EYE, 0);
    for_all(check_is_reciprocal, &rng);
}

/* Light within a closed box of rough glass is in balance with light outside: what goes in, index^2
 * times as dense, is what comes out. */
static void check_is_balanced(const glass_case *glass, void *user)
{
    test_family *family = user;
    test_mean passed[2] = {{0}};
    ppmi_rng rng = ppmi_rng_start(4, PPMI_STREAM_EYE, 0);
    const uint32_t count = TEST_EFFORT(40000);
    for (int side = 0; side < 2; side++) {
        for (uint32_t i = 0; i < count; i++) {
            const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
            ppmi_vec3 wo = ppmi_sample_cosine_hemisphere(u, v);
            if (side == 1) wo.z = -wo.z;
            if (fabsf(wo.z) < 1e-3f) continue;
            ppmi_bsdf bsdf;
            ppmi_bsdf_sample s;
            make(glass, wo, &bsdf);
            const bool is_drawn = bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_POWER, &s);
            mean_add(&passed[side], is_drawn && s.is_transmission ? (double)s.weight.y : 0.0);
        }
    }
    const double n2 = (double)(glass->index * glass->index);
    const double error = n2 * mean_error(&passed[1]);
    const double both = sqrt(error * error + mean_error(&passed[0]) * mean_error(&passed[0]));
    family_add(family, p_normal((n2 * passed[1].mean - passed[0].mean) / both),
               "index %g, roughness %g: %g in, %g out", (double)glass->index,
               (double)glass->roughness, passed[0].mean, n2 * passed[1].mean);
}

static void what_goes_in_and_out_is_in_balance(void **state)
{
    (void)state;
    test_family family = {0};
    for (int n = 0; n < INDICES; n++) {
        for (int r = 2; r < ROUGHS; r += 2) {
            const glass_case glass = {indices[n], roughnesses[r], false, {1.0f, 1.0f, 1.0f}};
            check_is_balanced(&glass, &family);
        }
    }
    family_check(&family);
}

/* ---- from facet to facet ------------------------------------------------------------------------
 */

/* Of heights even over -1..1, the share below. */
static double below(double height)
{
    return fmin(fmax(0.5 * (height + 1.0), 0.0), 1.0);
}

/* Smith's Lambda for flight up or down. */
static double flight_lambda(double alpha, double z)
{
    const double tan2 = fmax(1.0 - z * z, 0.0) / (z * z);
    return 0.5 * (copysign(sqrt(1.0 + alpha * alpha * tan2), z) - 1.0);
}

/* The height at which flight along w meets the microsurface; false when it leaves. Heitz et al.
 * 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model" (SIGGRAPH), algorithm 2. */
static bool fly(double alpha, ppmi_vec3 w, double u, double *height)
{
    if (w.z > 0.9999f) return false;
    if (w.z < -0.9999f) {
        *height = 2.0 * u * below(*height) - 1.0;
        return true;
    }
    if (fabsf(w.z) < 1e-4f) return true;
    const double lambda = flight_lambda(alpha, (double)w.z);
    if (w.z > 0.0f && u > 1.0 - pow(below(*height), lambda)) return false;
    *height = 2.0 * below(*height) / pow(1.0 - u, 1.0 / lambda) - 1.0;
    return true;
}

/* A facet's normal as seen from v, which may come from below the horizon. */
static ppmi_vec3 facet_seen(float alpha, ppmi_vec3 v, ppmi_rng *rng)
{
    const ppmi_vec3 w = vec3_normalize(vec3(alpha * v.x, alpha * v.y, v.z));
    const float u1 = ppmi_rng_float(rng), u2 = ppmi_rng_float(rng);
    const ppmi_vec3 h = vec3_add(ppmi_ggx_sample_cap(w, u1, u2), w);
    return vec3_normalize(vec3(alpha * h.x, alpha * h.y, ppmi_max(h.z, 1e-9f)));
}

/* Follows light that arrives from wo (z > 0) on the microsurface; true if it comes back. */
static bool walk_returns(float alpha, float eta, ppmi_vec3 wo, ppmi_rng *rng)
{
    ppmi_vec3 w = vec3_neg(wo); /* the far side is seen upside down */
    bool is_beyond = false;
    double height = 1.0;
    for (int i = 0; i < 1000 && fly((double)alpha, w, (double)ppmi_rng_float(rng), &height); i++) {
        const ppmi_vec3 v = vec3_neg(w), h = facet_seen(alpha, v, rng);
        const float cosine = ppmi_max(vec3_dot(v, h), 1e-6f), ratio = is_beyond ? 1.0f / eta : eta;
        float cos_t;
        const float reflectance = ppmi_fresnel_dielectric(cosine, ratio, &cos_t);
        if (ppmi_rng_float(rng) < reflectance) {
            w = vec3_sub(vec3_scale(h, 2.0f * cosine), v);
            continue;
        }
        w = vec3_normalize(vec3_mad(vec3_scale(v, -1.0f / ratio), h, cosine / ratio - cos_t));
        w.z = -w.z;
        height = -height;
        is_beyond = !is_beyond;
    }
    return !is_beyond;
}

/* What is reflected in all, of light from either side, is what a walk over the facets gives. The
 * walk masks what is transmitted by Smith's terms of both sides apart, the lobe by both together,
 * and at grazing angles passes more: up to 0.04. */
static void as_much_is_reflected_as_on_a_walk_over_facets(void **state)
{
    (void)state;
    test_family family = {0};
    ppmi_rng rng = ppmi_rng_start(6, PPMI_STREAM_EYE, 0);
    const uint32_t count = TEST_EFFORT(20000);
    for (int k = 0; k < 24; k++) {
        const glass_case glass = {k & 1 ? 1.5f : 1.3f, k & 2 ? 0.35f : 0.6f, false, {1, 1, 1}};
        const float cosine = cosines[k / 4 % 3], z = k < 12 ? cosine : -cosine;
        ppmi_bsdf bsdf;
        make(&glass, direction(z), &bsdf);
        test_mean walk = {0}, drawn = {0};
        for (uint32_t i = 0; i < count; i++) {
            mean_add(&walk, walk_returns(bsdf.glass_alpha, bsdf.eta, direction(cosine), &rng));
            ppmi_bsdf_sample s;
            const bool is_drawn = bsdf_draw(&bsdf, &rng, PPMI_TRANSPORT_POWER, &s);
            mean_add(&drawn, is_drawn && !s.is_transmission ? (double)s.weight.y : 0.0);
        }
        const double error = hypot(mean_error(&walk), mean_error(&drawn));
        const double apart = fmax(fabs(walk.mean - drawn.mean) - 0.04, 0.0);
        family_add(&family, p_normal(apart / error), "index %g, roughness %g, cosine %g: %g, %g",
                   (double)glass.index, (double)glass.roughness, (double)z, walk.mean, drawn.mean);
    }
    family_check(&family);
}

/* ---- smooth -----------------------------------------------------------------------------------
 */

/* Smooth glass asks no table: it costs nothing. */
static void smooth_glass_needs_no_table(void **state)
{
    (void)state;
    ppmi_albedo_table bare = *bsdf_albedo();
    bare.glass = NULL;
    const ppmi_vec3 up = vec3(0.0f, 0.0f, 1.0f);
    const ppmi_surface surface = {.ng = up, .ns = up};
    const ppmi_material_point point = {.base_color = {1.0f, 1.0f, 1.0f},
                                       .ior = 1.5f,
                                       .specular = 1.0f,
                                       .specular_color = {1.0f, 1.0f, 1.0f},
                                       .transmission = 1.0f,
                                       .ns = up};
    ppmi_bsdf bsdf;
    ppmi_bsdf_make(&bare, &surface, &point, direction(0.5f), &bsdf);
    assert_int_equal(bsdf.delta_lobes, PPMI_LOBE_GLASS);
    ppmi_bsdf_sample s;
    assert_true(
        ppmi_bsdf_draw(&bsdf, &bare, PPMI_LOBE_ALL, PPMI_TRANSPORT_POWER, 0.5f, 0.5f, 0.5f, &s));
    assert_near(s.weight.y, 1.0, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_rough_glass_returns_all_light),
        cmocka_unit_test(only_what_goes_through_is_tinted),
        cmocka_unit_test(multiple_scattering_is_reciprocal),
        cmocka_unit_test(what_goes_in_and_out_is_in_balance),
        cmocka_unit_test(as_much_is_reflected_as_on_a_walk_over_facets),
        cmocka_unit_test(smooth_glass_needs_no_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
