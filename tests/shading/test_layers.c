/* What each layer does, against formulas and independent integrals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shading/bsdf_cases.h"
#include "shading/iridescence.h"
#include "shading/rough_diffuse.h"
#include "shading/sheen.h"
#include "support/near.h"
#include "support/statistics.h"

static const ppmi_vec3 up = {0.0f, 0.0f, 1.0f};

static double schlick(double f0, double cosine)
{
    return f0 + (1.0 - f0) * pow(1.0 - cosine, 5.0);
}

static ppmi_material_point lambert(float r, float g, float b)
{
    return (ppmi_material_point){
        .base_color = {r, g, b},
        .roughness = 0.5f,
        .ior = 1.5f,
        .specular_color = {1.0f, 1.0f, 1.0f},
        .ns = up,
        .is_layered = true,
        .layers = {.coat_normal = up, .coat_ior = 1.5f, .coat_tint = {1.0f, 1.0f, 1.0f}}};
}

static void make(const ppmi_material_point *point, ppmi_vec3 wo, ppmi_bsdf *bsdf)
{
    const ppmi_surface surface = {.ng = up, .ns = up};
    ppmi_bsdf_make(bsdf_albedo(), &surface, point, vec3_normalize(wo), bsdf);
}

static ppmi_vec3 value(const ppmi_bsdf *bsdf, ppmi_vec3 wi, uint32_t mask)
{
    return ppmi_bsdf_eval(bsdf, bsdf_albedo(), vec3_normalize(wi), mask, PPMI_TRANSPORT_RADIANCE);
}

/* ---- no layers ------------------------------------------------------------------------------- */

/* The layered path without a layer, and so anisotropy of strength 0, is the plain material. */
static void layers_that_are_not_there_change_nothing(void **state)
{
    (void)state;
    static const int kinds[] = {KIND_LAMBERT,    KIND_PLASTIC, KIND_METAL,
                                KIND_HALF_METAL, KIND_GLASS,   KIND_HALF_GLASS};
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        for (int i = 0; i < 200; i++) {
            bsdf_case item;
            ppmi_bsdf plain, layered;
            bsdf_make_case(kinds[k], 0.6f, 0.05f + 0.9f * ppmi_rng_float(&rng), &item, &plain);
            item.point.is_layered = true;
            item.point.layers.tangent = vec3(1, 0, 0);
            make(&item.point, bsdf_wo(&plain), &layered);
            const ppmi_vec3 wi = bsdf_random_direction(&rng);
            const float expected = value(&plain, wi, PPMI_LOBE_ALL).y;
            /* the mean of what is left over is by quadrature here, by the table there */
            assert_near(value(&layered, wi, PPMI_LOBE_ALL).y, expected, 3e-3f * expected + 1e-6f);
            const float pdf = ppmi_bsdf_pdf(&plain, wi, PPMI_LOBE_ALL);
            assert_near(ppmi_bsdf_pdf(&layered, wi, PPMI_LOBE_ALL), pdf, 5e-3f * pdf + 1e-6f);
        }
    }
}

/* ---- clearcoat ------------------------------------------------------------------------------- */

/* A mirror under a smooth coat: what the coat reflects, and the rest of it from below. */
static void a_smooth_coat_takes_from_a_mirror_what_it_reflects(void **state)
{
    (void)state;
    for (float c = 0.1f; c < 1.0f; c += 0.2f) {
        ppmi_material_point point = lambert(0.9f, 0.6f, 0.3f);
        point.metallic = 1.0f;
        point.roughness = 0.0f;
        point.layers.coat = 0.7f;
        ppmi_bsdf bsdf;
        make(&point, vec3(sqrtf(1.0f - c * c), 0, c), &bsdf);
        ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
        assert_int_equal(ppmi_bsdf_branches(&bsdf, bsdf_albedo(), PPMI_LOBE_ALL,
                                            PPMI_TRANSPORT_RADIANCE, samples),
                         2);
        const double coat = 0.7 * schlick(0.04, (double)c);
        assert_near(samples[0].weight.y, (1.0 - coat) * schlick(0.6, (double)c), 1e-4);
        assert_near(samples[1].weight.y, coat, 1e-4);
        assert_near(samples[1].weight.x, samples[1].weight.z, 1e-6);
    }
}

static void assert_mirror_about(const ppmi_bsdf *bsdf, ppmi_vec3 wo, ppmi_vec3 normal)
{
    ppmi_bsdf_sample sample;
    assert_true(ppmi_bsdf_draw(bsdf, bsdf_albedo(), PPMI_LOBE_COAT, PPMI_TRANSPORT_RADIANCE, 0.5f,
                               0.5f, 0.5f, &sample));
    assert_true(sample.is_delta);
    const ppmi_vec3 half = vec3_normalize(vec3_add(wo, sample.wi));
    assert_near(vec3_dot(half, normal), 1.0, 1e-5);
}

static void the_coat_has_a_normal_of_its_own(void **state)
{
    (void)state;
    const ppmi_vec3 tilted = vec3_normalize(vec3(0.3f, -0.1f, 1.0f));
    const ppmi_vec3 wo = vec3_normalize(vec3(0.2f, 0.3f, 0.9f));
    ppmi_material_point point = lambert(0.5f, 0.5f, 0.5f);
    point.layers.coat = 1.0f;
    ppmi_bsdf bsdf;
    point.ns = tilted; /* of the base alone */
    make(&point, wo, &bsdf);
    assert_mirror_about(&bsdf, wo, up);
    point.ns = up;
    point.layers.coat_normal = tilted;
    make(&point, wo, &bsdf);
    assert_near(bsdf.frame.n.z, 1.0, 1e-6);
    assert_mirror_about(&bsdf, wo, tilted);
}

/* What carries power one way carries radiance the other way, by the coat's cosines. */
static void a_coat_at_an_angle_is_reciprocal(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_EYE, 0);
    ppmi_material_point point = lambert(0.5f, 0.5f, 0.5f);
    point.layers.coat = 1.0f;
    point.layers.coat_roughness = 0.5f;
    point.layers.coat_normal = vec3_normalize(vec3(0.3f, -0.2f, 1.0f));
    for (int i = 0; i < 500; i++) {
        ppmi_vec3 wo = bsdf_random_direction(&rng), wi = bsdf_random_direction(&rng);
        wo.z = 0.1f + fabsf(wo.z);
        wi.z = 0.1f + fabsf(wi.z);
        wo = vec3_normalize(wo);
        wi = vec3_normalize(wi);
        if (vec3_dot(wo, point.layers.coat_normal) < 0.05f) continue;
        if (vec3_dot(wi, point.layers.coat_normal) < 0.05f) continue;
        ppmi_bsdf forth, back;
        make(&point, wo, &forth);
        make(&point, wi, &back);
        const float power =
            ppmi_bsdf_eval(&forth, bsdf_albedo(), wi, PPMI_LOBE_COAT, PPMI_TRANSPORT_POWER).y;
        const float radiance =
            ppmi_bsdf_eval(&back, bsdf_albedo(), wo, PPMI_LOBE_COAT, PPMI_TRANSPORT_RADIANCE).y;
        assert_near(power, radiance, 1e-4f * radiance + 1e-7f);
    }
}

static ppmi_material_point coated_mirror(float r, float g, float b)
{
    ppmi_material_point point = lambert(r, g, b);
    point.metallic = 1.0f;
    point.roughness = 0.0f;
    point.layers.coat = 1.0f;
    return point;
}

/* Weights of base and coat, both mirrors, at a cosine. */
static ppmi_vec3 mirror_weight(const ppmi_material_point *point, float cosine, int branch)
{
    ppmi_bsdf bsdf;
    make(point, vec3(sqrtf(1.0f - cosine * cosine), 0, cosine), &bsdf);
    ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
    const uint32_t count =
        ppmi_bsdf_branches(&bsdf, bsdf_albedo(), PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE, samples);
    assert_true((uint32_t)branch < count);
    return samples[branch].weight;
}

static void a_coat_tints_by_the_length_of_the_way_through_it(void **state)
{
    (void)state;
    ppmi_material_point point = coated_mirror(0.9f, 0.6f, 0.3f);
    point.layers.coat_ior = 1.6f;
    point.layers.coat_tint = vec3(1.0f, 0.5f, 0.2f);
    const double f0 = pow(0.6 / 2.6, 2.0);
    for (float c = 0.1f; c <= 1.0f; c += 0.3f) {
        const ppmi_vec3 base = mirror_weight(&point, c, 0), coat = mirror_weight(&point, c, 1);
        const double sine = sqrt(1.0 - (double)c * (double)c);
        const double way = 1.0 / cos(asin(sine / 1.6)), passing = 1.0 - schlick(f0, (double)c);
        assert_near(coat.x, schlick(f0, (double)c), 1e-4);
        assert_near(base.x, passing * schlick(0.9, (double)c), 1e-4);
        assert_near(base.y, passing * schlick(0.6, (double)c) * pow(0.5, way), 1e-4);
        assert_near(base.z, passing * schlick(0.3, (double)c) * pow(0.2, way), 1e-4);
    }
}

/* The share of diffuse light that is reflected, from outside: Fresnel's equations by quadrature. */
static double diffuse_fresnel(double index)
{
    double sum = 0.0;
    for (int i = 0; i < 4000; i++) {
        const double c = (i + 0.5) / 4000.0, t = sqrt(1.0 - (1.0 - c * c) / (index * index));
        const double s = (c - index * t) / (c + index * t), p = (index * c - t) / (index * c + t);
        sum += 2.0 * c * 0.5 * (s * s + p * p) / 4000.0;
    }
    return sum;
}

static void a_coat_darkens_by_what_goes_to_and_fro_below_it(void **state)
{
    (void)state;
    for (double index = 1.1; index < 2.5; index += 0.4) {
        ppmi_material_point point = lambert(0.8f, 0.4f, 0.0f);
        point.layers.coat = 1.0f;
        point.layers.coat_ior = (float)index;
        const ppmi_vec3 wo = vec3(0.4f, 0.1f, 0.7f), wi = vec3(-0.2f, 0.5f, 0.6f);
        ppmi_bsdf bsdf;
        make(&point, wo, &bsdf);
        const ppmi_vec3 before = value(&bsdf, wi, PPMI_LOBE_WIDE);
        point.layers.coat_darkening = 1.0f;
        make(&point, wo, &bsdf);
        const ppmi_vec3 after = value(&bsdf, wi, PPMI_LOBE_WIDE);
        const double back = 1.0 - (1.0 - diffuse_fresnel(index)) / (index * index);
        assert_near(after.x / before.x, (1.0 - back) / (1.0 - 0.8 * back), 0.01);
        assert_near(after.y / before.y, (1.0 - back) / (1.0 - 0.4 * back), 0.01);
    }
}

static void a_brushed_coat_stretches_its_highlight(void **state)
{
    (void)state;
    ppmi_material_point point = lambert(0, 0, 0);
    point.layers.coat = 1.0f;
    point.layers.coat_roughness = 0.5f;
    point.layers.coat_anisotropy = 0.8f;
    point.layers.coat_tangent = vec3(1, 1, 0);
    ppmi_bsdf bsdf;
    make(&point, up, &bsdf);
    const float along = value(&bsdf, vec3(0.4f, 0.4f, 1), PPMI_LOBE_COAT).y;
    const float across = value(&bsdf, vec3(0.4f, -0.4f, 1), PPMI_LOBE_COAT).y;
    assert_true(along > 2.0f * across && across > 0.0f);
}

/* ---- sheen and fuzz -------------------------------------------------------------------------- */

/* Black fibres only take; what they leave is grey, whether of the coat or of the base. */
static void dark_fuzz_takes_what_it_stops(void **state)
{
    (void)state;
    ppmi_material_point point = coated_mirror(0.9f, 0.6f, 0.3f);
    const ppmi_material_point bare = point;
    point.layers.sheen_share = 0.7f;
    point.layers.sheen_roughness = 0.5f;
    point.layers.sheen_is_on_top = true;
    for (float c = 0.1f; c <= 1.0f; c += 0.3f) {
        const float left = 1.0f - 0.7f * ppmi_lobe_sheen_albedo(bsdf_albedo()->lobes, 0.5f, c);
        assert_true(left < 1.0f);
        for (int branch = 0; branch < 2; branch++) {
            const ppmi_vec3 with = mirror_weight(&point, c, branch);
            const ppmi_vec3 without = mirror_weight(&bare, c, branch);
            assert_near(with.x, left * without.x, 1e-4);
            assert_near(with.z, left * without.z, 1e-4);
        }
    }
}

static void fuzz_lies_above_the_coat(void **state)
{
    (void)state;
    ppmi_material_point point = lambert(0, 0, 0);
    point.layers.sheen_color = vec3(0.6f, 0.6f, 0.6f);
    point.layers.sheen_share = 0.6f;
    point.layers.sheen_roughness = 0.5f;
    const ppmi_vec3 wo = vec3(0.9f, 0.0f, 0.2f), wi = vec3(-0.5f, 0.6f, 0.3f);
    ppmi_bsdf bsdf;
    make(&point, wo, &bsdf);
    const float bare = value(&bsdf, wi, PPMI_LOBE_SHEEN).y;
    point.layers.coat = 1.0f;
    make(&point, wo, &bsdf);
    assert_true(value(&bsdf, wi, PPMI_LOBE_SHEEN).y < 0.9f * bare);
    point.layers.sheen_is_on_top = true;
    make(&point, wo, &bsdf);
    assert_near(value(&bsdf, wi, PPMI_LOBE_SHEEN).y, bare, 1e-6f * bare);
}

static void the_table_of_the_sheen_is_its_integral(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(4, PPMI_STREAM_EYE, 0);
    test_family family = {0};
    const ppmi_lobe_table *lobes = bsdf_albedo()->lobes;
    for (float roughness = 0.13f; roughness <= 1.0f; roughness += 0.21f) {
        for (float c = 0.06f; c < 1.0f; c += 0.23f) {
            const ppmi_vec3 wo = vec3(sqrtf(1.0f - c * c), 0, c);
            const float alpha = roughness * roughness;
            const float table = ppmi_lobe_sheen_albedo(lobes, roughness, c);
            const float bound = ppmi_lobe_sheen_bound(lobes, roughness, c);
            test_mean mean = {0};
            for (uint32_t i = 0; i < TEST_EFFORT(20000); i++) {
                const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
                const ppmi_vec3 wi = ppmi_direction_at(ppmi_max(u, 1e-4f), v);
                const float f = ppmi_sheen_value(alpha, wo, ppmi_sheen_lambda(c, alpha), wi,
                                                 ppmi_sheen_lambda(wi.z, alpha)) *
                                ppmi_min(bound, ppmi_lobe_sheen_bound(lobes, roughness, wi.z));
                mean_add(&mean, (double)(f * wi.z * 2.0f * PPMI_PI));
            }
            assert_true(table <= 1.0f);
            family_add_mean(&family, &mean, (double)table, 0.01, "roughness %g, cosine %g",
                            (double)roughness, (double)c);
        }
    }
    family_check(&family);
}

/* ---- edge colours ---------------------------------------------------------------------------- */

/* At 82 degrees a metal reflects what Schlick says times its edge's colour. */
static void a_metals_edge_has_its_colour(void **state)
{
    (void)state;
    ppmi_material_point point = lambert(0.9f, 0.6f, 0.3f);
    point.metallic = 1.0f;
    point.roughness = 0.0f;
    point.specular = 1.0f;
    point.specular_color = vec3(1.0f, 0.4f, 0.7f);
    point.edge_color = true;
    const ppmi_vec3 edge = mirror_weight(&point, 1.0f / 7.0f, 0);
    assert_near(edge.x, schlick(0.9, 1.0 / 7.0), 1e-4);
    assert_near(edge.y, 0.4 * schlick(0.6, 1.0 / 7.0), 1e-4);
    assert_near(edge.z, 0.7 * schlick(0.3, 1.0 / 7.0), 1e-4);
    const ppmi_vec3 straight = mirror_weight(&point, 1.0f, 0);
    assert_near(straight.y, 0.6, 1e-5);
}

/* A dielectric's whole reflection is tinted, and the base does not see the tint. */
static void a_dielectrics_reflection_has_the_colour_throughout(void **state)
{
    (void)state;
    ppmi_material_point point = lambert(0.5f, 0.5f, 0.5f);
    point.specular = 0.5f;
    point.roughness = 0.0f;
    point.is_layered = false;
    const ppmi_vec3 wi = vec3(-0.3f, 0.4f, 0.5f);
    ppmi_bsdf bsdf;
    make(&point, vec3(0.4f, 0, 0.3f), &bsdf);
    const float base = value(&bsdf, wi, PPMI_LOBE_WIDE).y;
    point.specular_color = vec3(0.2f, 1.0f, 0.4f);
    point.edge_color = true;
    make(&point, vec3(0.4f, 0, 0.3f), &bsdf);
    assert_near(value(&bsdf, wi, PPMI_LOBE_WIDE).y, base, 1e-6f);
    for (float c = 0.1f; c <= 1.0f; c += 0.3f) {
        const ppmi_vec3 weight = mirror_weight(&point, c, 0);
        assert_near(weight.y, 0.5 * schlick(0.04, (double)c), 1e-4);
        assert_near(weight.x, 0.2 * 0.5 * schlick(0.04, (double)c), 1e-4);
    }
}

/* ---- rough diffuse --------------------------------------------------------------------------- */

/* Single scattering is Fujii's form of Oren and Nayar's; integrated anew. */
static void what_a_rough_base_loses_is_its_integral(void **state)
{
    (void)state;
    for (float roughness = 0.2f; roughness <= 1.0f; roughness += 0.4f) {
        const double a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * M_PI)) * (double)roughness);
        for (float c = 0.1f; c <= 1.0f; c += 0.3f) {
            const double cos_o = (double)c, sin_o = sqrt(1.0 - cos_o * cos_o);
            double returned = 0.0;
            const int n = 400;
            for (int i = 0; i < n * n; i++) {
                const double cos_i = sqrt((i / n + 0.5) / n), phi = 2.0 * M_PI * (i % n + 0.5) / n;
                const double s = sin_o * sqrt(1.0 - cos_i * cos_i) * cos(phi);
                const double t = s > 0.0 ? fmax(cos_o, cos_i) : 1.0;
                returned += a * (1.0 + (double)roughness * s / t) / (n * n);
            }
            assert_near(ppmi_rough_diffuse_lost(roughness, c), 1.0 - returned, 2e-4);
        }
    }
}

static void a_rough_base_sends_light_back(void **state)
{
    (void)state;
    ppmi_material_point point = lambert(0.5f, 0.5f, 0.5f);
    point.is_layered = false;
    const ppmi_vec3 wo = vec3(0.8f, 0, 0.4f);
    ppmi_bsdf smooth, rough;
    make(&point, wo, &smooth);
    point.diffuse_roughness = 1.0f;
    make(&point, wo, &rough);
    const float lambert_value = value(&smooth, wo, PPMI_LOBE_ALL).y;
    assert_true(value(&rough, wo, PPMI_LOBE_ALL).y > 1.2f * lambert_value);
    assert_true(value(&rough, vec3(-0.8f, 0, 0.4f), PPMI_LOBE_ALL).y < 0.8f * lambert_value);
}

/* ---- iridescence ----------------------------------------------------------------------------- */

static void a_film_of_no_thickness_leaves_the_base(void **state)
{
    (void)state;
    static const float indices[] = {1.2f, 1.5f, 2.4f};
    for (int i = 0; i < 3; i++) {
        const ppmi_vec3 f0 = vec3(0.04f, 0.3f, 0.9f);
        const ppmi_vec3 r =
            ppmi_film_reflectance(indices[i], 0.0f, f0, 1.0f, &ppmi_working_space_rec709);
        assert_near(r.x, 0.04, 1e-3);
        assert_near(r.y, 0.3, 1e-3);
        assert_near(r.z, 0.9, 5e-3);
    }
    ppmi_material_point point = lambert(0.9f, 0.5f, 0.2f);
    point.metallic = 1.0f;
    point.layers.film = 1.0f;
    point.layers.film_ior = 1.5f;
    ppmi_bsdf with, without;
    make(&point, vec3(0.5f, 0, 1), &with);
    point.layers.film = 0.0f;
    make(&point, vec3(0.5f, 0, 1), &without);
    const ppmi_vec3 wi = vec3(-0.3f, 0.2f, 0.8f);
    assert_near(value(&with, wi, PPMI_LOBE_ALL).y, value(&without, wi, PPMI_LOBE_ALL).y, 1e-6);
}

/* Lobe of a fit to the colour matching functions: Wyman, Sloan, Shirley 2013 (JCGT 2.2). */
static double lobe(double x, double mean, double below, double above)
{
    const double t = (x - mean) / (x < mean ? below : above);
    return exp(-0.5 * t * t);
}

static double luminosity(double nm)
{
    return 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1);
}

/* Airy's formula at normal incidence, wavelength by wavelength. */
static double airy(double film, double base, double nm_thick, double nm)
{
    const double r1 = (1.0 - film) / (1.0 + film), r2 = (film - base) / (film + base);
    const double phase = 4.0 * M_PI * film * nm_thick / nm, c = cos(phase);
    return (r1 * r1 + r2 * r2 + 2.0 * r1 * r2 * c) / (1.0 + r1 * r1 * r2 * r2 + 2.0 * r1 * r2 * c);
}

static void a_film_reflects_what_its_spectrum_says(void **state)
{
    (void)state;
    static const double indices[][2] = {{1.3, 1.5}, {1.5, 2.25}, {2.0, 1.5}, {1.8, 8.0}};
    for (int i = 0; i < 4; i++) {
        const double film = indices[i][0], base = indices[i][1];
        const double f0 = pow((base - 1.0) / (base + 1.0), 2.0);
        for (double thick = 50.0; thick <= 800.0; thick += 50.0) {
            double sum = 0.0, weight = 0.0;
            for (double nm = 380.0; nm <= 780.0; nm += 1.0) {
                sum += luminosity(nm) * airy(film, base, thick, nm);
                weight += luminosity(nm);
            }
            const ppmi_vec3 rgb = ppmi_film_reflectance(
                (float)film, (float)thick, vec3_splat((float)f0), 1.0f, &ppmi_working_space_rec709);
            /* the Gaussians of the closed form, and what does not fit into Rec.709 */
            assert_near(vec3_luminance(rgb), sum / weight, 0.035);
        }
    }
}

/* A quarter of a wavelength of the root of the base's index: green is put out; seen askew the film
 * is thinner in phase, and what is put out moves to blue. */
static void a_films_colour_moves_to_blue_when_seen_askew(void **state)
{
    (void)state;
    const ppmi_vec3 f0 = vec3_splat(0.148f); /* 2.25 */
    const float nm = 3.0f * 550.0f / (4.0f * 1.5f);
    const ppmi_vec3 straight =
        ppmi_film_reflectance(1.5f, nm, f0, 1.0f, &ppmi_working_space_rec709);
    assert_true(straight.y < 0.03f && straight.y < 0.5f * straight.x &&
                straight.y < 0.5f * straight.z);
    const ppmi_vec3 askew = ppmi_film_reflectance(1.5f, nm, f0, 0.6f, &ppmi_working_space_rec709);
    assert_true(askew.z < askew.y && askew.z < askew.x);
}

/* ---- two widths ------------------------------------------------------------------------------ */

static void brushing_stretches_the_highlight_along_its_direction(void **state)
{
    (void)state;
    ppmi_material_point point = lambert(1, 1, 1);
    point.metallic = 1.0f;
    point.layers.anisotropy = 0.8f;
    point.layers.tangent = vec3(1, 1, 0);
    ppmi_bsdf bsdf;
    make(&point, up, &bsdf);
    const float along = value(&bsdf, vec3(0.4f, 0.4f, 1), PPMI_LOBE_SPEC).y;
    const float across = value(&bsdf, vec3(0.4f, -0.4f, 1), PPMI_LOBE_SPEC).y;
    assert_true(along > 3.0f * across);
    const float other_side = value(&bsdf, vec3(-0.4f, -0.4f, 1), PPMI_LOBE_SPEC).y;
    assert_near(other_side, along, 1e-5f * along);
}

/* ---- diffuse transmission -------------------------------------------------------------------- */

static void a_leaf_shares_its_light_between_its_sides(void **state)
{
    (void)state;
    ppmi_material_point point = lambert(0.2f, 0.5f, 0.1f);
    point.layers.through = 0.3f;
    point.layers.through_color = vec3(0.6f, 0.9f, 0.4f);
    ppmi_bsdf bsdf;
    make(&point, vec3(0.4f, 0.1f, 0.7f), &bsdf);
    assert_near(value(&bsdf, vec3(0.1f, 0.5f, 0.3f), PPMI_LOBE_ALL).y, 0.7 * 0.5 / M_PI, 1e-4);
    assert_near(value(&bsdf, vec3(0.1f, 0.5f, -0.3f), PPMI_LOBE_ALL).y, 0.3 * 0.9 / M_PI, 1e-4);
    assert_int_equal(bsdf.gather_lobes, PPMI_LOBE_WIDE | PPMI_LOBE_THROUGH);
}

/* ---- retroreflection ------------------------------------------------------------------------- */

static void a_retroreflector_sends_light_back(void **state)
{
    (void)state;
    const ppmi_vec3 wo = vec3_normalize(vec3(0.6f, 0.2f, 0.5f));
    ppmi_material_point point = lambert(0.9f, 0.6f, 0.3f);
    point.metallic = 1.0f;
    point.roughness = 0.0f;
    point.layers.retro = 0.25f;
    ppmi_bsdf bsdf;
    make(&point, wo, &bsdf);
    ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
    assert_int_equal(
        ppmi_bsdf_branches(&bsdf, bsdf_albedo(), PPMI_LOBE_ALL, PPMI_TRANSPORT_RADIANCE, samples),
        2);
    const double reflectance = schlick(0.6, (double)wo.z);
    assert_near(samples[0].weight.y, 0.75 * reflectance, 1e-4);
    assert_near(samples[1].weight.y, 0.25 * reflectance, 1e-4);
    assert_near(vec3_dot(samples[1].wi, wo), 1.0, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_that_are_not_there_change_nothing),
        cmocka_unit_test(a_smooth_coat_takes_from_a_mirror_what_it_reflects),
        cmocka_unit_test(the_coat_has_a_normal_of_its_own),
        cmocka_unit_test(a_coat_at_an_angle_is_reciprocal),
        cmocka_unit_test(a_coat_tints_by_the_length_of_the_way_through_it),
        cmocka_unit_test(a_coat_darkens_by_what_goes_to_and_fro_below_it),
        cmocka_unit_test(a_brushed_coat_stretches_its_highlight),
        cmocka_unit_test(dark_fuzz_takes_what_it_stops),
        cmocka_unit_test(fuzz_lies_above_the_coat),
        cmocka_unit_test(the_table_of_the_sheen_is_its_integral),
        cmocka_unit_test(a_metals_edge_has_its_colour),
        cmocka_unit_test(a_dielectrics_reflection_has_the_colour_throughout),
        cmocka_unit_test(what_a_rough_base_loses_is_its_integral),
        cmocka_unit_test(a_rough_base_sends_light_back),
        cmocka_unit_test(a_film_of_no_thickness_leaves_the_base),
        cmocka_unit_test(a_film_reflects_what_its_spectrum_says),
        cmocka_unit_test(a_films_colour_moves_to_blue_when_seen_askew),
        cmocka_unit_test(brushing_stretches_the_highlight_along_its_direction),
        cmocka_unit_test(a_leaf_shares_its_light_between_its_sides),
        cmocka_unit_test(a_retroreflector_sends_light_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
