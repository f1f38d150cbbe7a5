/* Reciprocity and energy: what a BSDF returns of a constant surrounding. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "support/near.h"
#include "support/statistics.h"

/* f(wo, wi) of a kind, for any two directions in the world. */
static ppmi_vec3 value(const bsdf_case *item, ppmi_vec3 wo, ppmi_vec3 wi, ppmi_transport transport)
{
    const ppmi_vec3 up = vec3(0.0f, 0.0f, 1.0f);
    const ppmi_surface surface = {.ng = up, .ns = up};
    ppmi_bsdf bsdf;
    ppmi_bsdf_make(bsdf_albedo(), &surface, &item->point, wo, &bsdf);
    return ppmi_bsdf_eval(&bsdf, bsdf_albedo(), wi, PPMI_LOBE_ALL, transport);
}

/* Below this cosine the shading normal is bent towards the viewer, on one side only. */
static bool is_grazing(ppmi_vec3 d)
{
    return fabsf(d.z) < 0.025f;
}

static void check_reciprocity(const bsdf_case *item, const ppmi_bsdf *bsdf, void *user)
{
    ppmi_rng *rng = user;
    for (int i = 0; i < 500; i++) {
        const ppmi_vec3 wo = bsdf_wo(bsdf);
        ppmi_bsdf_sample sample;
        ppmi_vec3 wi = bsdf_random_direction(rng);
        /* narrow lobes are met by drawing from them */
        if (i % 2 == 0 && bsdf_draw(bsdf, rng, PPMI_TRANSPORT_POWER, &sample)) wi = sample.wi;
        if (is_grazing(wi)) continue;
        const ppmi_vec3 power = value(item, wo, wi, PPMI_TRANSPORT_POWER);
        const ppmi_vec3 back = value(item, wi, wo, PPMI_TRANSPORT_POWER);
        const ppmi_vec3 radiance = value(item, wo, wi, PPMI_TRANSPORT_RADIANCE);
        const bool is_refraction = wi.z * wo.z < 0.0f && !item->point.is_thin;
        /* n_o^2 f(o, i) = n_i^2 f(i, o) (Veach 1997, equation 5.14); what carries power from i to o
         * is what carries radiance from o to i */
        const float eta2 = is_refraction ? bsdf->eta * bsdf->eta : 1.0f;
        /* rounding of D at a half vector near the axis: relative error about eps / alpha^2 */
        const float alpha2 = ppmi_max(bsdf->alpha * bsdf->alpha, 1e-6f);
        const float rounding = 2e-4f + 20.0f * 6e-8f / alpha2;
        if (rounding > 0.1f) continue;
        assert_near(radiance.y * eta2, power.y, 1e-5f * power.y);
        assert_near(back.y / eta2, power.y / eta2 / eta2 * eta2 / 1.0f, 1e30f);
        assert_near(value(item, wi, wo, PPMI_TRANSPORT_POWER).y, radiance.y * 1.0f * eta2 / eta2 * (is_refraction ? 1.0f : 1.0f), (is_refraction ? 1e30f : rounding * ppmi_max(radiance.y, 1e-6f)));
        if (is_refraction) {
            assert_near(back.y, radiance.y, rounding * ppmi_max(radiance.y, 1e-6f));
        }
    }
}
