/* ppmi_bsdf_albedo against what the BSDF returns when it is drawn from. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "support/near.h"
#include "support/statistics.h"

static test_family family;

static float albedo_of(const ppmi_bsdf *bsdf, uint32_t mask)
{
    return ppmi_bsdf_albedo(bsdf, bsdf_albedo(), mask).y;
}

/* What is returned of even light from all sides, without the gain of refraction. */
static test_mean drawn(const ppmi_bsdf *bsdf, uint32_t mask, ppmi_rng *rng)
{
    test_mean mean = {0};
    for (uint32_t i = 0; i < TEST_EFFORT(4000); i++) {
        const float u_lobe = ppmi_rng_float(rng), u = ppmi_rng_float(rng), v = ppmi_rng_float(rng);
        ppmi_bsdf_sample sample;
        double value = 0.0;
        if (ppmi_bsdf_draw(bsdf, bsdf_albedo(), mask, PPMI_TRANSPORT_RADIANCE, u_lobe, u, v,
                           &sample)) {
            value = (double)(sample.weight.y / sample.eta_scale);
        }
        mean_add(&mean, value);
    }
    return mean;
}

/* Rough glass takes the Fresnel term of its mean plane, and what facets hide from each other is
 * lost to it: neither is what the closed form is for. */
static bool is_rough_glass(const ppmi_bsdf *bsdf)
{
    return bsdf->lobes & PPMI_LOBE_GLASS && !(bsdf->delta_lobes & PPMI_LOBE_GLASS);
}

/* Of the tables of albedos: 0.006 at most (test_albedo.c); that of stretched lobes is coarser, by
 * up to 0.021 where they are narrow and seen at a grazing angle. */
static double table_error(const ppmi_bsdf *bsdf)
{
    return bsdf->is_layered && bsdf->layers.anisotropy > 0.0f ? 0.022 : 0.006;
}

static void compare(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user)
{
    ppmi_rng *rng = user;
    if (is_rough_glass(bsdf)) return;
    const uint32_t masks[] = {PPMI_LOBE_ALL, bsdf->gather_lobes};
    for (int i = 0; i < 2; i++) {
        if (ppmi_bsdf_probability(bsdf, masks[i]) == 0.0f) continue;
        const test_mean mean = drawn(bsdf, masks[i], rng);
        const double albedo = (double)albedo_of(bsdf, masks[i]);
        family_add_mean(&family, &mean, albedo, table_error(bsdf), "%s, mask %d", item->name, i);
    }
}

static void it_is_what_even_light_gives(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    family = (test_family){0};
    bsdf_for_all(compare, &rng);
    family_check(&family);
    assert_true(family.count > 100);
}

static void clear_glass_is_white(void **state)
{
    (void)state;
    const int kinds[] = {KIND_GLASS, KIND_GLASS_INSIDE, KIND_THIN_GLASS};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        for (int k = 0; k < 3; k++) {
            bsdf_case item;
            ppmi_bsdf bsdf;
            bsdf_make_case(kinds[i], 0.4f * (float)k, 0.7f, &item, &bsdf);
            bsdf.tint = vec3_splat(1.0f);
            assert_near(albedo_of(&bsdf, PPMI_LOBE_ALL), 1.0, 1e-6);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_what_even_light_gives),
        cmocka_unit_test(clear_glass_is_white),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
