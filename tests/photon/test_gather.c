/* Which photons count at a visible point, and for how much. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "math/sampling.h"
#include "photon/gather.h"
#include "support/near.h"
#include "support/statistics.h"

static ppm_context *context;
static ppmi_albedo_table albedo;
static ppmi_lobe_table lobes;
static ppmi_glass_table glass;
static ppmi_visible_point point;

static const ppmi_vec3 up = {0.0f, 0.0f, 1.0f};

static int start(void **state)
{
    (void)state;
    ppmi_albedo_table_init(&albedo);
    ppmi_lobe_table_init(&lobes);
    ppmi_glass_table_init(&glass);
    albedo.lobes = &lobes;
    albedo.glass = &glass;
    return ppm_context_create(NULL, &context) == PPM_STATUS_OK ? 0 : -1;
}

static int finish(void **state)
{
    (void)state;
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    return live == 0 ? 0 : -1;
}

static ppmi_material_point lambert(float reflectance)
{
    return (ppmi_material_point){
        .base_color = vec3_splat(reflectance), .roughness = 1.0f, .ior = 1.5f, .ns = up};
}

/* The visible point at the origin of the xy plane, seen from above, of the given material. */
static void look_at(const ppmi_material_point *material)
{
    const ppmi_surface surface = {.ng = up, .ns = material->ns};
    point = (ppmi_visible_point){.footprint = 1.0f};
    ppmi_bsdf_make(&albedo, &surface, material, up, &point.bsdf);
}

static ppmi_photon photon_at(float x, float y, float z)
{
    return (ppmi_photon){.position = {x, y, z}, .wi = up, .power = {1.0f, 2.0f, 3.0f}, .ng = up};
}

static ppmi_gathered gather(const ppmi_photon *photons, size_t count, float radius)
{
    ppmi_photon_grid grid = {0};
    assert_int_equal(ppmi_photon_grid_build(context, &grid, photons, count, radius, 1),
                     PPM_STATUS_OK);
    const ppmi_gathered gathered = ppmi_gather(&grid, &albedo, &point, radius, NULL);
    ppmi_photon_grid_deinit(context, &grid);
    return gathered;
}

static void assert_counts(const ppmi_photon *photon, bool counts)
{
    const ppmi_gathered gathered = gather(photon, 1, 1.0f);
    assert_near(gathered.count, counts ? 1.0 : 0.0, 0.0);
    assert_int_equal(gathered.flux.x > 0.0f, counts);
}

/* A photon that has come from below a sheet, its normal on that side. */
static void light_from_behind_counts_where_it_passes_diffusely(void **state)
{
    (void)state;
    ppmi_photon photon = photon_at(0.5f, 0.0f, 0.0f);
    photon.wi = photon.ng = vec3_neg(up);
    ppmi_material_point material = lambert(0.6f);
    look_at(&material);
    assert_counts(&photon, false);
    material.is_layered = true;
    material.layers =
        (ppmi_layer_point){.coat_normal = up, .through = 0.25f, .through_color = vec3_splat(0.8f)};
    look_at(&material);
    assert_counts(&photon, true);
    const ppmi_gathered gathered = gather(&photon, 1, 1.0f);
    const double kernel = 2.0 * (1.0 - 0.25);
    assert_near(gathered.flux.x, kernel * 0.25 * 0.8 / M_PI, 1e-4);
    photon.ng = vec3_normalize(vec3(1.0f, 0.0f, -0.2f)); /* of something else */
    assert_counts(&photon, false);
}

static void a_photon_brings_power_times_reflectance(void **state)
{
    (void)state;
    const ppmi_material_point material = lambert(0.6f);
    look_at(&material);
    const ppmi_photon photon = photon_at(0.5f, 0.0f, 0.0f);
    const ppmi_gathered gathered = gather(&photon, 1, 1.0f);
    const double kernel = 2.0 * (1.0 - 0.25); /* Epanechnikov's */
    assert_near(gathered.flux.x, kernel * 0.6 / M_PI, 1e-5);
    assert_near(gathered.flux.z, 3.0 * kernel * 0.6 / M_PI, 1e-5);
    assert_near(gathered.count, 1.0, 0.0);
}

static void the_radius_bounds_the_disk(void **state)
{
    (void)state;
    const ppmi_material_point material = lambert(0.6f);
    look_at(&material);
    ppmi_photon photon = photon_at(0.999f, 0.0f, 0.0f);
    assert_counts(&photon, true);
    photon = photon_at(1.001f, 0.0f, 0.0f);
    assert_counts(&photon, false);
    photon = photon_at(0.8f, 0.8f, 0.0f);
    assert_counts(&photon, false);
}

static void photons_off_the_plane_do_not_count(void **state)
{
    (void)state;
    const ppmi_material_point material = lambert(0.6f);
    look_at(&material);
    for (float side = -1.0f; side <= 1.0f; side += 2.0f) {
        ppmi_photon photon = photon_at(0.1f, 0.0f, side * 0.01f);
        assert_counts(&photon, true);
        photon = photon_at(0.1f, 0.0f, side * 0.5f);
        assert_counts(&photon, false);
        /* beside one that counts, in the same cell: the grid alone does not sort it out */
        const ppmi_photon pair[2] = {photon_at(0.1f, 0.0f, 0.0f), photon};
        assert_near(gather(pair, 2, 1.0f).count, 1.0, 0.0);
    }
}

static void photons_on_other_surfaces_do_not_count(void **state)
{
    (void)state;
    const ppmi_material_point material = lambert(0.6f);
    look_at(&material);
    ppmi_photon photon = photon_at(0.1f, 0.0f, 0.0f);
    photon.ng = vec3_neg(up); /* the other side of a thin wall */
    assert_counts(&photon, false);
    photon.ng = vec3(1.0f, 0.0f, 0.0f); /* a wall that stands on the plane */
    assert_counts(&photon, false);
    photon.ng = vec3_normalize(vec3(0.3f, 0.0f, 1.0f)); /* a round surface */
    assert_counts(&photon, true);
}

static void photons_from_below_do_not_count(void **state)
{
    (void)state;
    const ppmi_material_point material = lambert(0.6f);
    look_at(&material);
    ppmi_photon photon = photon_at(0.1f, 0.0f, 0.0f);
    photon.wi = vec3_normalize(vec3(0.5f, 0.0f, -0.5f));
    assert_counts(&photon, false);
    photon.wi = vec3_normalize(vec3(1.0f, 0.0f, 0.05f));
    assert_counts(&photon, true);
}

/* What brings nothing must not shrink the radius. */
static void photons_that_the_bsdf_drops_do_not_count(void **state)
{
    (void)state;
    ppmi_material_point red = lambert(0.0f);
    red.base_color.x = 0.5f;
    look_at(&red);
    ppmi_photon photon = photon_at(0.1f, 0.0f, 0.0f);
    photon.power = vec3(0.0f, 1.0f, 1.0f); /* cyan light on red */
    assert_counts(&photon, false);
    photon.power = vec3(1.0f, 0.0f, 0.0f);
    assert_counts(&photon, true);
}

/* A mirror-like lobe does not gather, its diffuse base does. */
static void only_gathering_lobes_count(void **state)
{
    (void)state;
    ppmi_material_point plastic = lambert(0.6f);
    plastic.specular = 1.0f;
    plastic.specular_color = vec3_splat(1.0f);
    plastic.roughness = 0.1f;
    look_at(&plastic);
    const ppmi_photon photon = photon_at(0.0f, 0.0f, 0.0f); /* in the very mirror direction */
    const ppmi_gathered gathered = gather(&photon, 1, 1.0f);
    assert_true(gathered.flux.x > 0.0f && (double)gathered.flux.x < 2.1 * 0.6 / M_PI);
    ppmi_material_point metal = plastic;
    metal.metallic = 1.0f;
    look_at(&metal);
    const ppmi_photon on_metal = photon_at(0.1f, 0.0f, 0.0f);
    assert_true(gather(&on_metal, 1, 1.0f).flux.x < 1e-2f);
}

/* With normals that differ, photons by the geometric cosine are weighed by the shading one's. */
static void shading_normals_weigh_by_the_ratio_of_cosines(void **state)
{
    (void)state;
    ppmi_material_point material = lambert(0.6f);
    material.ns = vec3_normalize(vec3(0.5f, 0.0f, 1.0f));
    look_at(&material);
    ppmi_photon photon = photon_at(0.0f, 0.0f, 0.0f);
    photon.wi = vec3_normalize(vec3(1.0f, 0.0f, 1.0f));
    const double ratio = (double)(vec3_dot(photon.wi, material.ns) / vec3_dot(photon.wi, up));
    assert_near(gather(&photon, 1, 1.0f).flux.x, 2.0 * 0.6 / M_PI * ratio, 1e-5);
}

/* A photon on a neighbouring facet of a smooth mesh came by that facet's cosine, and is above it.
 */
static void a_neighbouring_facet_weighs_by_its_own_cosine(void **state)
{
    (void)state;
    const ppmi_material_point material = lambert(0.6f);
    look_at(&material);
    ppmi_photon photon = photon_at(0.0f, 0.0f, 0.0f);
    photon.ng = vec3_normalize(vec3(0.5f, 0.0f, 1.0f));
    photon.wi = vec3_normalize(vec3(1.0f, 0.0f, 0.2f));
    const double ratio = (double)(photon.wi.z / vec3_dot(photon.wi, photon.ng));
    assert_near(gather(&photon, 1, 1.0f).flux.x, 2.0 * 0.6 / M_PI * ratio, 1e-5);
    /* the point's own facet faces away from the light, its shading normal does not */
    ppmi_material_point leaning = lambert(0.6f);
    leaning.ns = photon.ng;
    look_at(&leaning);
    photon.wi = vec3_normalize(vec3(1.0f, 0.0f, -0.1f));
    assert_near(gather(&photon, 1, 1.0f).flux.x, 2.0 * 0.6 / M_PI, 1e-5);
}

/* An even density gives the irradiance without bias, whatever the radius. */
static void an_even_density_gives_the_irradiance(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    static ppmi_photon photons[COUNT];
    const ppmi_material_point white = lambert(1.0f);
    look_at(&white);
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_PHOTON, 0);
    const float radii[3] = {0.1f, 0.3f, 0.7f};
    test_mean means[3] = {{0}};
    for (uint32_t trial = 0; trial < TEST_EFFORT(40); trial++) {
        for (int i = 0; i < COUNT; i++) {
            const float x = 2.0f * ppmi_rng_float(&rng) - 1.0f;
            photons[i] = photon_at(x, 2.0f * ppmi_rng_float(&rng) - 1.0f, 0.0f);
            photons[i].power = vec3_splat(4.0f / COUNT); /* irradiance 1 over 2 by 2 */
        }
        for (int k = 0; k < 3; k++) {
            const double area = M_PI * (double)radii[k] * (double)radii[k];
            mean_add(&means[k], (double)gather(photons, COUNT, radii[k]).flux.x / area * M_PI);
        }
    }
    test_family family = {0};
    for (int k = 0; k < 3; k++) {
        mean_check_power(&means[k], 0.02);
        family_add_mean(&family, &means[k], 1.0, 0.0, "radius %g", (double)radii[k]);
    }
    family_check(&family);
}

/* ---- in media -------------------------------------------------------------------------------- */

static void look_into_fog(float asymmetry_g)
{
    const ppmi_medium fog = {.sigma_s = {2.0f, 1.0f, 0.5f}, .asymmetry_g = asymmetry_g};
    point = (ppmi_visible_point){.footprint = 1.0f};
    ppmi_bsdf_make_phase(&fog, up, &point.bsdf);
}

static void in_a_medium_the_radius_bounds_the_ball(void **state)
{
    (void)state;
    look_into_fog(0.5f);
    ppmi_photon photon = photon_at(0.0f, 0.0f, 0.999f);
    photon.ng = vec3_splat(0.0f);
    assert_counts(&photon, true);
    photon.position = vec3(0.6f, -0.6f, 0.6f);
    assert_counts(&photon, false);
    photon.position = vec3(-0.5f, 0.5f, -0.5f);
    photon.wi = vec3_neg(up); /* from anywhere */
    assert_counts(&photon, true);
}

/* Power times sigma_s times the phase function, from the direction of flight to that of the eye. */
static void in_a_medium_a_photon_brings_power_times_phase(void **state)
{
    (void)state;
    look_into_fog(0.5f);
    ppmi_photon photon = photon_at(0.0f, 0.0f, 0.5f);
    const double kernel = 2.5 * (1.0 - 0.25);
    /* it comes from where the eye is, and is scattered back */
    double phase = (1.0 - 0.25) / (4.0 * M_PI * pow(1.0 + 0.25 + 1.0, 1.5));
    assert_near(gather(&photon, 1, 1.0f).flux.x, 2.0 * kernel * phase, 1e-6);
    assert_near(gather(&photon, 1, 1.0f).flux.z, 3.0 * 0.5 * kernel * phase, 1e-6);
    /* it flies towards the eye */
    photon.wi = vec3_neg(up);
    phase = (1.0 - 0.25) / (4.0 * M_PI * pow(1.0 + 0.25 - 1.0, 1.5));
    assert_near(gather(&photon, 1, 1.0f).flux.x, 2.0 * kernel * phase, 1e-5);
}

/* An even density in a ball gives the fluence without bias, whatever the radius. */
static void in_a_medium_an_even_density_gives_the_fluence(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    static ppmi_photon photons[COUNT];
    look_into_fog(0.0f);
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_PHOTON, 0);
    const float radii[3] = {0.3f, 0.5f, 0.9f};
    test_mean means[3] = {{0}};
    for (uint32_t trial = 0; trial < TEST_EFFORT(40); trial++) {
        for (int i = 0; i < COUNT; i++) {
            const float x = 2.0f * ppmi_rng_float(&rng) - 1.0f;
            const float y = 2.0f * ppmi_rng_float(&rng) - 1.0f;
            photons[i] = photon_at(x, y, 2.0f * ppmi_rng_float(&rng) - 1.0f);
            photons[i].power = vec3_splat(8.0f / COUNT); /* fluence 1 over 2 by 2 by 2 */
            photons[i].ng = vec3_splat(0.0f);
        }
        for (int k = 0; k < 3; k++) {
            const double volume = 4.0 / 3.0 * M_PI * pow((double)radii[k], 3.0);
            /* sigma_s / 4 pi of the fluence */
            const double flux = (double)gather(photons, COUNT, radii[k]).flux.y;
            mean_add(&means[k], flux / volume * 4.0 * M_PI);
        }
    }
    test_family family = {0};
    for (int k = 0; k < 3; k++) {
        mean_check_power(&means[k], 0.02);
        family_add_mean(&family, &means[k], 1.0, 0.0, "radius %g", (double)radii[k]);
    }
    family_check(&family);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_photon_brings_power_times_reflectance),
        cmocka_unit_test(light_from_behind_counts_where_it_passes_diffusely),
        cmocka_unit_test(the_radius_bounds_the_disk),
        cmocka_unit_test(photons_off_the_plane_do_not_count),
        cmocka_unit_test(photons_on_other_surfaces_do_not_count),
        cmocka_unit_test(photons_from_below_do_not_count),
        cmocka_unit_test(photons_that_the_bsdf_drops_do_not_count),
        cmocka_unit_test(only_gathering_lobes_count),
        cmocka_unit_test(shading_normals_weigh_by_the_ratio_of_cosines),
        cmocka_unit_test(a_neighbouring_facet_weighs_by_its_own_cosine),
        cmocka_unit_test(an_even_density_gives_the_irradiance),
        cmocka_unit_test(in_a_medium_the_radius_bounds_the_ball),
        cmocka_unit_test(in_a_medium_a_photon_brings_power_times_phase),
        cmocka_unit_test(in_a_medium_an_even_density_gives_the_fluence),
    };
    return cmocka_run_group_tests(tests, start, finish);
}
