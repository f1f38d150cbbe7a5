/* Dispersion: a prism bends each colour by Snell's law, and all colours together are white. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "photon/walk.h"
#include "statistical/methods.h"
#include "support/near.h"
#include "support/scenes.h"

static test_scene test;
static test_family family;

enum { SEEDS = 12 };

/* Dense flint (SF11): strong dispersion. */
static const float index_d = 1.7847f, abbe = 25.68f;
static const double apex = M_PI / 3.0;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    family = (test_family){0};
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static ppm_material_id dispersive_glass(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    desc.ior = index_d;
    desc.dispersion = 20.0f / abbe;
    return material_add(test.scene, &desc);
}

/* An upright prism: an equilateral triangle in the xy plane, apex up, 2 metres deep. */
static void add_prism(void)
{
    const float h = 0.8660254f;
    const float positions[18] = {-0.5f, 0, 1,  0.5f, 0, 1,  0, h, 1,
                                 -0.5f, 0, -1, 0.5f, 0, -1, 0, h, -1};
    static const uint32_t indices[24] = {0, 1, 2, 3, 5, 4, 0, 2, 5, 0, 5, 3,
                                         1, 4, 5, 1, 5, 2, 0, 3, 4, 0, 4, 1};
    const ppm_primitive_desc primitive = {.vertex_count = 6,
                                          .triangle_count = 8,
                                          .positions = positions,
                                          .indices = indices,
                                          .material = dispersive_glass()};
    shape_place(test.scene, shape_mesh(test.scene, &primitive));
}

/* Cauchy's formula with the Abbe number, in its own words. */
static double cauchy(double wavelength_nm)
{
    const double f = 486.1, c = 656.3, d = 587.6;
    const double b = ((double)index_d - 1.0) / (double)abbe / (1.0 / (f * f) - 1.0 / (c * c));
    return (double)index_d + b * (1.0 / (wavelength_nm * wavelength_nm) - 1.0 / (d * d));
}

/* How much a ray turns that meets the first face under angle. */
static double deviation(double n, double angle)
{
    const double first = asin(sin(angle) / n), second = asin(n * sin(apex - first));
    return angle + second - apex;
}

/* The direction in which a ray comes that meets the left face under angle, from below its normal.
 */
static ppmi_vec3 incoming(double angle)
{
    /* the left face's inward normal is (cos 30, -sin 30), the base lies on its right */
    const double direction = -M_PI / 6.0 + angle;
    return vec3((float)cos(direction), (float)sin(direction), 0.0f);
}

/* Through the prism by the transmitted branches, in one wavelength (0: drawn on the way). */
static ppmi_vec3 through(const test_world *world, ppmi_walker *walker, double angle,
                         float wavelength_nm, uint64_t index)
{
    walker->world = &world->world;
    ppmi_walker_start(walker, ppmi_rng_start(1, PPMI_STREAM_PHOTON, index), 1, (uint32_t)index, 0,
                      0);
    walker->wavelength_nm = wavelength_nm;
    const ppmi_vec3 on_face = vec3(-0.25f, 0.4330127f, 0.01f);
    ppmi_vec3 direction = incoming(angle);
    ppmi_ray ray = {
        .origin = vec3_mad(on_face, direction, -1.0f), .t_max = INFINITY, .direction = direction};
    for (int i = 0; i < 2; i++) {
        ppmi_vertex vertex;
        assert_int_equal(ppmi_walk(walker, ray, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(walker, &vertex, ray.direction, &bsdf);
        ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
        const uint32_t count = ppmi_bsdf_branches(&bsdf, walker->world->albedo, PPMI_LOBE_ALL,
                                                  PPMI_TRANSPORT_POWER, samples);
        assert_int_equal(count, 2);
        ppmi_vec3 throughput = vec3_splat(1.0f);
        ray = ppmi_walk_leave(walker, &vertex, &samples[1], &throughput);
    }
    return ray.direction;
}

static double turned(ppmi_vec3 from, ppmi_vec3 to)
{
    return atan2((double)vec3_length(vec3_cross(from, to)), (double)vec3_dot(from, to));
}

static void light_of_one_colour_turns_as_snell_says(void **state)
{
    (void)state;
    add_prism();
    test_world world;
    world_open(&world, &test);
    const float wavelengths[3] = {450.0f, 550.0f, 650.0f};
    const double angles[3] = {1.05, 1.15, 1.25};
    ppmi_walker walker = {0};
    for (int a = 0; a < 3; a++) {
        for (int w = 0; w < 3; w++) {
            const ppmi_vec3 out = through(&world, &walker, angles[a], wavelengths[w], 0);
            const double n = cauchy((double)wavelengths[w]);
            assert_near(turned(incoming(angles[a]), out), deviation(n, angles[a]), 2e-6);
            assert_near(walker.wavelength_nm, wavelengths[w], 0.0);
        }
    }
    world_close(&world);
}

/* White light takes a wavelength at the first face and keeps it. */
static void white_light_turns_as_the_colour_it_becomes(void **state)
{
    (void)state;
    add_prism();
    test_world world;
    world_open(&world, &test);
    ppmi_walker walker = {0};
    float least = INFINITY, most = 0.0f;
    for (uint64_t i = 0; i < 200; i++) {
        const ppmi_vec3 out = through(&world, &walker, 1.05, 0.0f, i);
        const double n = cauchy((double)walker.wavelength_nm);
        assert_near(turned(incoming(1.05), out), deviation(n, 1.05), 2e-6);
        least = ppmi_min(least, walker.wavelength_nm);
        most = ppmi_max(most, walker.wavelength_nm);
    }
    assert_true(least < 470.0f && most > 620.0f);
    world_close(&world);
}

/* ---- photons on a screen --------------------------------------------------------------------- */

/* Sunlight through the prism onto a screen: photons land where Snell's law puts
 * their colours, as dense as the spectrum's table has them. */
static void photons_land_where_their_colours_should(void **state)
{
    (void)state;
    add_prism();
    const double angle = 1.2;
    const ppmi_vec3 direction = incoming(angle);
    /* the screen stands square to green light behind the prism; a black plate keeps the base dark
     */
    const double middle = -M_PI / 6.0 + angle - deviation(cauchy(550.0), angle);
    const ppmi_vec3 axis = vec3((float)cos(middle), (float)sin(middle), 0.0f);
    const ppmi_vec3 across = vec3((float)-sin(middle), (float)cos(middle), 0.0f);
    const ppmi_vec3 corner =
        vec3_add(vec3_scale(axis, 1.5f), vec3_add(vec3_scale(across, -1.5f), vec3(0, 0, -1.5f)));
    add_quad(test.scene, material_lambert(test.scene, 0.01f), corner, vec3_scale(across, 3.0f),
             vec3(0, 0, 3.0f));
    add_quad(test.scene, material_lambert(test.scene, 0.0f), vec3(-0.51f, -0.01f, -1.1f),
             vec3(0, 0, 2.2f), vec3(1.02f, 0, 0));
    light_directional(test.scene, direction, vec3_splat(1.0f));
    test_world world;
    world_open(&world, &test);
    atomic_bool cancel = false;
    const ppmi_photon_walk walk = {.world = &world.world,
                                   .seed = 1,
                                   .count = TEST_EFFORT(400000),
                                   .max_depth = 3,
                                   .first_depth = 2, /* into the prism, out of it, screen */
                                   .threads = 1,
                                   .cancel = &cancel};
    ppmi_photon_scratch scratch = {0};
    ppmi_photon_list lists[PPMI_PHOTON_KINDS] = {{0}};
    uint64_t rays = 0;
    assert_int_equal(ppmi_photon_walk_run(test.context, &walk, &scratch, lists, &rays),
                     PPM_STATUS_OK);
    const ppmi_photon_list *list = &lists[PPMI_PHOTONS_SURFACE];
    assert_true(list->count > walk.count / 50);

    /* bins of 10 nm by the direction of flight; lost on the way: Fresnel, which changes little */
    enum { STEP = 10, BINS = (PPMI_SPECTRUM_LAST_NM - PPMI_SPECTRUM_FIRST_NM) / STEP };
    double observed[BINS] = {0.0}, expected[BINS] = {0.0}, sum = 0.0;
    test_mean colours[BINS] = {{0}};
    for (size_t i = 0; i < list->count; i++) {
        const double turn = turned(direction, vec3_neg(list->photons[i].wi));
        int bin = 0; /* blue turns most */
        while (bin + 1 < BINS &&
               deviation(cauchy(PPMI_SPECTRUM_FIRST_NM + STEP * (bin + 1.0)), angle) > turn) {
            bin++;
        }
        observed[bin] += 1.0;
        const ppmi_vec3 p = list->photons[i].power;
        mean_add(&colours[bin], (double)(p.x / (p.x + p.y + p.z)));
    }
    const ppmi_spectrum *spectrum = world.world.spectrum;
    for (int b = 0; b < BINS; b++) {
        const double n = cauchy(PPMI_SPECTRUM_FIRST_NM + STEP * (b + 0.5));
        const double first = asin(sin(angle) / n), second = asin(n * sin(apex - first));
        double through_both = 1.0;
        const double cosines[2][2] = {{cos(angle), cos(first)}, {cos(apex - first), cos(second)}};
        for (int face = 0; face < 2; face++) {
            const double i = cosines[face][0], t = cosines[face][1], eta = face ? 1.0 / n : n;
            const double s = (i - eta * t) / (i + eta * t), p = (eta * i - t) / (eta * i + t);
            through_both *= 1.0 - 0.5 * (s * s + p * p);
        }
        expected[b] = through_both * (double)(spectrum->cumulative[STEP * (b + 1)] -
                                              spectrum->cumulative[STEP * b]);
        sum += expected[b];
    }
    for (int b = 0; b < BINS; b++)
        expected[b] *= (double)list->count / sum;
    family_add(&family, p_counts(observed, expected, BINS), "colours");
    family_check(&family);
    assert_true(colours[6].mean < 0.2);        /* 450 nm: little red */
    assert_true(colours[BINS - 7].mean > 0.8); /* 660 nm: hardly anything else */
    ppmi_photon_scratch_deinit(test.context, &scratch);
    ppmi_photon_list_deinit(test.context, &lists[PPMI_PHOTONS_SURFACE]);
    world_close(&world);
}

/* ---- white ----------------------------------------------------------------------------------- */

static double measure_channels(const float *rgba, const ppm_render_options *options, void *user)
{
    test_mean *means = user;
    const uint32_t pixels = options->width * options->height;
    for (uint32_t channel = 0; channel < 3; channel++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < pixels; i++)
            sum += (double)rgba[4 * i + channel];
        mean_add(&means[channel], sum / pixels);
    }
    return 0.0;
}

/* What reflects at steep angles keeps its whole light though its Fresnel term is that of one
 * wavelength: channels differ by the spread of the reflectance over the spectrum, d R / d n times
 * half of n(blue) - n(red), once or twice a path. */
static void a_dispersive_ball_in_an_even_sky_is_white(void **state)
{
    (void)state;
    shape_place(test.scene, shape_sphere(test.scene, dispersive_glass(), 1.0f, 64, true));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 1.1f);
    const double r_blue = pow((cauchy(430) - 1) / (cauchy(430) + 1), 2.0);
    const double r_red = pow((cauchy(650) - 1) / (cauchy(650) + 1), 2.0);
    const double bias = 2.0 * (r_blue - r_red);
    assert_true(bias < 0.025);
    const render_method methods[3] = {path_method, photon_methods[0], photon_methods[4]};
    for (int m = 0; m < 3; m++) {
        ppm_render_options options = method_options(&methods[m], 32, 100);
        options.max_depth = 1000;
        test_mean means[3] = {{0}};
        render_means(test.scene, &options, 8, SEEDS, measure_channels, means);
        for (int k = 0; k < 3; k++) {
            mean_check_power(&means[k], 0.01);
            /* and rays absorbed where smooth normals leave the facets, at the rim */
            family_add_mean(&family, &means[k], 1.0, bias + 3e-3, "%s, channel %d", methods[m].name,
                            k);
        }
    }
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(light_of_one_colour_turns_as_snell_says),
        WITH_SCENE(white_light_turns_as_the_colour_it_becomes),
        WITH_SCENE(photons_land_where_their_colours_should),
        WITH_SCENE(a_dispersive_ball_in_an_even_sky_is_white),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
