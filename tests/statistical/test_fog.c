/* Light in fog, against closed forms, line integrals and the path tracer.
 *
 * The fog fills the ball around the scene's bounding box: two small black squares at opposite
 * corners set its size. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "statistical/methods.h"
#include "support/scenes.h"

static test_scene test;
static test_family family;

enum { SEEDS = 10 };

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

static void begin_again(void)
{
    scene_close(&test);
    scene_open(&test);
}

/* The corners of a cube from -1 to 1: a ball of radius sqrt(3), but for the bound's margin. */
static const double ball_radius = 1.7320508 * 1.0001;

static void add_corners(void)
{
    const ppm_material_id black = material_lambert(test.scene, 0.0f);
    add_quad(test.scene, black, vec3_splat(-1), vec3(0.001f, 0, 0), vec3(0, 0.001f, 0));
    add_quad(test.scene, black, vec3_splat(1), vec3(-0.001f, 0, 0), vec3(0, -0.001f, 0));
}

/* A light that keeps the scene from getting a sky of its own, and adds nothing to be seen. */
static void add_no_light(void)
{
    light_point(test.scene, vec3(0.1f, 0.2f, 0.3f), vec3_splat(1e-12f));
}

/* The mean of each channel over the picture. */
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

typedef struct fog_check {
    const char *name;
    double expected[3];
    uint32_t width, passes, max_depth;
    uint64_t photons;
    float radius_m;
    double bias, photon_bias; /* bounds, relative: of all methods, of photons at an eye vertex */
    double resolution;
} fog_check;

static void check_method(const fog_check *check, const render_method *method, bool has_photons)
{
    ppm_render_options options = method_options(method, check->width, check->photons);
    options.radius_m = check->radius_m;
    options.max_depth = check->max_depth;
    test_mean means[3] = {{0}};
    render_means(test.scene, &options, check->passes, SEEDS, measure_channels, means);
    for (int k = 0; k < 3; k++) {
        mean_check_power(&means[k], check->resolution);
        const double bias = has_photons ? check->photon_bias : check->bias;
        family_add_mean(&family, &means[k], check->expected[k], bias * check->expected[k],
                        "%s, %s, channel %d", check->name, method->name, k);
    }
}

/* The path tracer and the first count photon methods. */
static void check_methods(const fog_check *check, int count)
{
    check_method(check, &path_method, false);
    for (int m = 0; m < count; m++)
        check_method(check, &photon_methods[m], true);
}

/* ---- transmittance --------------------------------------------------------------------------- */

/* The camera sees a backdrop that lights nothing through the middle of the ball. */
static void a_backdrop_is_dimmed_by_the_whole_ball(void **state)
{
    (void)state;
    add_corners();
    add_no_light();
    const ppm_environment_desc backdrop = {
        .size = sizeof backdrop, .has_backdrop = 1, .backdrop = {2.0f, 2.0f, 2.0f}};
    assert_int_equal(ppm_scene_set_environment(test.scene, &backdrop), PPM_STATUS_OK);
    scene_fog(test.scene, vec3(0.2f, 0.1f, 0.0f), vec3(0.1f, 0.3f, 0.15f), 0.3f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 1e-3f);
    const double way = 2.0 * ball_radius;
    const fog_check check = {
        .name = "backdrop",
        .expected = {2.0 * exp(-0.3 * way), 2.0 * exp(-0.4 * way), 2.0 * exp(-0.15 * way)},
        .width = 24,
        .passes = 8,
        .photons = 100,
        .radius_m = 0.1f,
        .bias = 1e-5,
        .photon_bias = 1e-5,
        .resolution = 0.05};
    check_methods(&check, PHOTON_METHODS);
    family_check(&family);
}

/* A camera in the fog before a wall that shines, in fog that only absorbs: no noise at all. */
static void an_emitter_is_dimmed_by_the_way_to_it(void **state)
{
    (void)state;
    add_quad(test.scene, material_emitter(test.scene, 3.0f, 0.0f, true), vec3(-1, -1, 0),
             vec3(2, 0, 0), vec3(0, 2, 0));
    scene_fog(test.scene, vec3_splat(0.0f), vec3(0.5f, 1.0f, 0.0f), 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 0.7f), vec3(0, 0, 0), 1e-3f);
    camera_orthographic(test.scene, vec3(0, 0, 7), vec3(0, 0, 0), 1e-3f);
    const double ways[2] = {0.7, sqrt(2.0) * 1.0001};
    for (uint32_t camera = 0; camera < 2; camera++) {
        for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
            ppm_render_options options = render_options(i, 4, 100);
            options.camera = camera + 1;
            test_mean means[3] = {{0}};
            render_means(test.scene, &options, 2, SEEDS, measure_channels, means);
            const double sigma[3] = {0.5, 1.0, 0.0};
            for (int k = 0; k < 3; k++) {
                family_add_mean(&family, &means[k], 3.0 * exp(-sigma[k] * ways[camera]), 1e-5,
                                "camera %u, integrator %d, channel %d", camera, i, k);
            }
        }
    }
    family_check(&family);
}

/* Solids have no fog in them: a box of index 1 cuts its thickness out of the way. */
static void solids_displace_the_fog(void **state)
{
    (void)state;
    add_corners();
    add_no_light();
    shape_place(test.scene, shape_box(test.scene, material_glass(test.scene, 1.0f, 0.0f),
                                      vec3(-0.5f, -0.5f, -0.3f), vec3(0.5f, 0.5f, 0.5f), 1, false));
    const ppm_environment_desc backdrop = {.size = sizeof backdrop, .radiance = {1.0f, 1.0f, 1.0f}};
    assert_int_equal(ppm_scene_set_environment(test.scene, &backdrop), PPM_STATUS_OK);
    scene_fog(test.scene, vec3_splat(0.0f), vec3(0.5f, 1.0f, 0.0f), 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 7), vec3(0, 0, 0), 1e-3f);
    const double way = 2.0 * ball_radius - 0.8;
    const fog_check check = {.name = "box",
                             .expected = {exp(-0.5 * way), exp(-way), 1.0},
                             .width = 4,
                             .passes = 2,
                             .photons = 100,
                             .radius_m = 0.1f,
                             .bias = 1e-4, /* the backdrop's light on the squares */
                             .photon_bias = 1e-4,
                             .resolution = 0.05};
    check_methods(&check, PHOTON_METHODS);
    family_check(&family);
}

/* ---- single scattering ----------------------------------------------------------------------- */

static double henyey_greenstein(double g, double cosine)
{
    return (1.0 - g * g) / (4.0 * M_PI * pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

/* Light of a point light of 1 candela at height h over a line through the ball's middle, scattered
 * once into the line: midpoint rule. */
static double single_scattering(double sigma_s, double sigma_t, double g, double height)
{
    const int steps = 100000;
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        const double t = (i + 0.5) / steps * 2.0 * ball_radius;
        const double z = ball_radius - t; /* the camera looks along -z */
        const double distance = hypot(height, z);
        /* from the light down to the line at z, then on along +z to the camera */
        const double cosine = z / distance;
        sum += sigma_s * henyey_greenstein(g, cosine) * exp(-sigma_t * (t + distance)) /
               (distance * distance);
    }
    return sum / steps * 2.0 * ball_radius;
}

static void light_is_scattered_once_as_the_line_integral_says(void **state)
{
    (void)state;
    const float asymmetries[3] = {0.0f, 0.7f, -0.5f};
    for (int i = 0; i < 3; i++) {
        begin_again();
        add_corners();
        light_point(test.scene, vec3(0, 0.6f, 0), vec3_splat(1.0f));
        scene_fog(test.scene, vec3(0.3f, 0.5f, 0.2f), vec3(0.0f, 0.4f, 0.2f), asymmetries[i]);
        camera_orthographic(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 1e-3f);
        const double g = (double)asymmetries[i];
        /* photons lie in balls of 8 cm: the fluence falls as the square of 60 cm at least, and
         * its mean over the ball is off by r^2 / 14 times its Laplacian, 2 / 0.6^2, with three
         * times as much for the phase function and extinction */
        const fog_check check = {.name = "point light",
                                 .expected = {single_scattering(0.3, 0.3, g, 0.6),
                                              single_scattering(0.5, 0.9, g, 0.6),
                                              single_scattering(0.2, 0.4, g, 0.6)},
                                 .width = 32,
                                 .passes = 8,
                                 .max_depth = 1,
                                 .photons = 20000,
                                 .radius_m = 0.08f,
                                 .bias = 1e-4,
                                 .photon_bias = 0.01,
                                 .resolution = 0.09};
        check_methods(&check, i == 0 ? PHOTON_METHODS : 2);
    }
    family_check(&family);
}

/* ---- furnaces -------------------------------------------------------------------------------- */

/* Within a radius r of the fog's border, or of a wall, a ball of Epanechnikov's kernel loses on
 * average 0.16 of its photons (E|z| / 2 r). Such eye vertices are at most 2 (1 - exp(-r sigma / c))
 * of all, at cosines c to the border above 0.7: with 4 cm and 1.5 / m a sixth. */
static const double border_bias = 0.16 / 6.0;

static void fog_that_only_scatters_vanishes_in_an_even_sky(void **state)
{
    (void)state;
    const float asymmetries[3] = {0.0f, 0.7f, -0.5f};
    for (int i = 0; i < 3; i++) {
        begin_again();
        shape_place(test.scene, shape_box(test.scene, material_glass(test.scene, 1.0f, 0.0f),
                                          vec3_splat(-0.5f), vec3_splat(0.5f), 1, false));
        light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
        scene_fog(test.scene, vec3(1.5f, 0.8f, 0.2f), vec3_splat(0.0f), asymmetries[i]);
        camera_orthographic(test.scene, vec3(1, 2, 5), vec3(0, 0, 0), 0.6f);
        const fog_check check = {.name = "sky",
                                 .expected = {1.0, 1.0, 1.0},
                                 .width = 32,
                                 .passes = 4,
                                 .max_depth = 400,
                                 .photons = 5000,
                                 .radius_m = 0.04f,
                                 .bias = 1e-5,
                                 .photon_bias = border_bias,
                                 .resolution = 0.05};
        check_methods(&check, i == 0 ? PHOTON_METHODS : 2);
    }
    family_check(&family);
}

static void fog_that_only_scatters_vanishes_in_a_box_that_shines(void **state)
{
    (void)state;
    const ppm_material_id wall = material_emitter(test.scene, 1.0f, 0.5f, false);
    shape_place(test.scene, shape_box(test.scene, wall, vec3_splat(-1), vec3_splat(1), 1, true));
    scene_fog(test.scene, vec3(0.8f, 0.5f, 0.2f), vec3_splat(0.0f), 0.6f);
    camera_perspective(test.scene, vec3(0.1f, 0.0f, 0.5f), vec3(0, 0, -1), 0.6f);
    const fog_check check = {.name = "box",
                             .expected = {2.0, 2.0, 2.0},
                             .width = 32,
                             .passes = 10,
                             .max_depth = 100,
                             .photons = 10000,
                             .radius_m = 0.04f,
                             .bias = 1e-5,
                             .photon_bias = border_bias,
                             .resolution = 0.05};
    check_methods(&check, PHOTON_METHODS);
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_backdrop_is_dimmed_by_the_whole_ball),
        WITH_SCENE(an_emitter_is_dimmed_by_the_way_to_it),
        WITH_SCENE(solids_displace_the_fog),
        WITH_SCENE(light_is_scattered_once_as_the_line_integral_says),
        WITH_SCENE(fog_that_only_scatters_vanishes_in_an_even_sky),
        WITH_SCENE(fog_that_only_scatters_vanishes_in_a_box_that_shines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
