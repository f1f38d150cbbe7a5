/* Light through glass, against formulas: what photons bring is what the glass lets through. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static test_scene test;
static test_family family;

enum { SEEDS = 16 };
static const float reflectance = 0.5f;

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

/* Small enough to lie in the shadow of all glass above it: else it would light the glass. */
static void add_floor(float y)
{
    add_quad(test.scene, material_lambert(test.scene, reflectance), vec3(-2, y, -2), vec3(0, 0, 4),
             vec3(4, 0, 0));
}

/* Fresnel's equations, unpolarised. */
static double fresnel(double cosine, double eta)
{
    const double sine = sqrt(1.0 - cosine * cosine) / eta;
    if (sine >= 1.0) return 1.0;
    const double t = sqrt(1.0 - sine * sine);
    const double s = (cosine - eta * t) / (cosine + eta * t);
    const double p = (eta * cosine - t) / (eta * cosine + t);
    return 0.5 * (s * s + p * p);
}

/* Paths of just so many vertices: into the glass, out of it, and the landing. */
static ppm_render_options caustic_options(uint32_t width, uint64_t photons, float radius)
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, width, photons);
    options.radius_m = radius;
    options.max_depth = 3;
    options.alpha = 1.0f; /* the radius stays: each disk keeps the flux that it blurs */
    return options;
}

static void add_slab(const ppm_material_desc *desc, float thickness)
{
    const ppm_material_id glass = material_add(test.scene, desc);
    shape_place(test.scene,
                shape_box(test.scene, glass, vec3(-4, 0, -4), vec3(4, thickness, 4), 1, false));
}

static ppm_material_desc clear_glass(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    return desc;
}

static void a_slab_lets_through_what_fresnel_leaves(void **state)
{
    (void)state;
    const double cosines[2] = {1.0, 0.6};
    for (int i = 0; i < 2; i++) {
        scene_close(&test);
        scene_open(&test);
        add_floor(-0.5f);
        const ppm_material_desc desc = clear_glass();
        add_slab(&desc, 0.3f);
        light_directional(test.scene,
                          vec3((float)sqrt(1.0 - cosines[i] * cosines[i]), (float)-cosines[i], 0),
                          vec3_splat(2.0f));
        camera_orthographic(test.scene, vec3(0, -0.1f, 0), vec3(0, -0.5f, 0), 0.8f);
        const ppm_render_options options = caustic_options(16, 20000, 0.1f);
        const test_mean mean = render_green(test.scene, &options, 4, SEEDS);
        mean_check_power(&mean, 0.005);
        const double through = pow(1.0 - fresnel(cosines[i], 1.5), 2.0);
        family_add_mean(&family, &mean, 2.0 * cosines[i] * through * (double)reflectance / M_PI,
                        1e-5, "cosine %g", cosines[i]);
    }
    family_check(&family);
}

static void a_slab_absorbs_as_beer_and_lambert_say(void **state)
{
    (void)state;
    add_floor(-0.5f);
    ppm_material_desc desc = clear_glass();
    desc.attenuation_color[1] = 0.4f;
    desc.attenuation_distance_m = 0.25f;
    add_slab(&desc, 0.3f);
    light_directional(test.scene, vec3(0.8f, -0.6f, 0), vec3_splat(2.0f));
    camera_orthographic(test.scene, vec3(0, -0.1f, 0), vec3(0, -0.5f, 0), 0.8f);
    const ppm_render_options options = caustic_options(16, 40000, 0.1f);
    const test_mean mean = render_green(test.scene, &options, 4, SEEDS);
    mean_check_power(&mean, 0.005);
    const double inside = sqrt(1.0 - 0.64 / 2.25); /* cosine in the glass */
    const double through = pow(1.0 - fresnel(0.6, 1.5), 2.0) * pow(0.4, 0.3 / inside / 0.25);
    family_add_mean(&family, &mean, 2.0 * 0.6 * through * (double)reflectance / M_PI, 1e-6, "slab");
    family_check(&family);
}

/* The other way: the eye looks through the slab at a wall that shines. */
static void the_eye_sees_through_a_slab_what_is_left(void **state)
{
    (void)state;
    add_quad(test.scene, material_emitter(test.scene, 1.0f, 0.0f, true), vec3(-4, -0.5f, -4),
             vec3(0, 0, 8), vec3(8, 0, 0));
    ppm_material_desc desc = clear_glass();
    desc.attenuation_color[1] = 0.4f;
    desc.attenuation_distance_m = 0.25f;
    add_slab(&desc, 0.3f);
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.8f);
    const double r = 0.04, inside = pow(0.4, 0.3 / 0.25);
    const double through = (1 - r) * (1 - r) * inside / (1 - r * r * inside * inside);
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
        const ppm_render_options options = render_options(i, 32, 1000);
        const test_mean mean = render_green(test.scene, &options, 8, SEEDS);
        mean_check_power(&mean, 0.005);
        /* rays begin off both faces by the bound of their rounding error, 24 ulps of 4 m: 2.3e-5 m
         * less glass, of ln(1 / 0.4) / 0.25 m */
        family_add_mean(&family, &mean, through, 1e-4 * through, "integrator %d", i);
    }
    family_check(&family);
}

/* ---- a ball as a lens ------------------------------------------------------------------------ */

typedef struct ball_lens {
    double floor_depth, window,
        power; /* below the centre; radius of the window; what lands in it */
} ball_lens;

/* A ray of the beam at distance b from the axis, through two faces of a unit ball. */
static void add_ring(ball_lens *lens, double b, double db)
{
    const double eta = 1.5, theta_i = asin(b), theta_t = asin(b / eta);
    const double angle = 2.0 * (theta_i - theta_t); /* from the axis, inwards */
    const double leaves = 2.0 * theta_t - theta_i;  /* where it leaves, from the axis */
    const double x = -sin(leaves), y = -cos(leaves);
    if (angle >= 0.5 * M_PI) return;
    /* goes on across the axis: from (b, up) it leaves at the far side of the bend */
    const double landing = -x - tan(angle) * (lens->floor_depth + y);
    if (fabs(landing) > lens->window) return;
    const double t = 1.0 - fresnel(cos(theta_i), eta);
    lens->power += t * t * 2.0 * M_PI * b * db;
}

static double measure_window(const float *rgba, const ppm_render_options *options, void *user)
{
    const ball_lens *lens = user;
    const double side = 2.0 / options->width; /* the picture is 2 by 2 metres */
    double sum = 0.0;
    for (uint32_t i = 0; i < options->width * options->height; i++) {
        const double x = (i % options->width + 0.5) * side - 1.0;
        const double z = (i / options->width + 0.5) * side - 1.0;
        if (x * x + z * z < lens->window * lens->window) sum += (double)rgba[4 * i + 1];
    }
    return sum * side * side;
}

static void a_ball_gathers_the_light_that_falls_on_it(void **state)
{
    (void)state;
    ball_lens lens = {.floor_depth = 1.3, .window = 0.85};
    const int rings = 100000;
    for (int i = 0; i < rings; i++)
        add_ring(&lens, (i + 0.5) / rings, 1.0 / rings);
    assert_true(lens.power > 0.7 * M_PI);
    add_floor((float)-lens.floor_depth);
    shape_place(test.scene,
                shape_sphere(test.scene, material_glass(test.scene, 1.5f, 0.0f), 1.0f, 200, true));
    light_directional(test.scene, vec3(0, -1, 0), vec3_splat(1.0f));
    camera_orthographic(test.scene, vec3(0, -1.1f, 0), vec3(0, -1.3f, 0), 1.0f);
    const double expected = lens.power * (double)reflectance / M_PI;
    /* facets of pi / 200 (their area is 1e-4 less), and at the window's rim, where little light
     * lands, pixels of 1 / 32 and disks of 0.04 */
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i += 2) {
        ppm_render_options options = caustic_options(64, 100000, 0.04f);
        options.integrator = i;
        const test_mean mean = render_means(test.scene, &options, 2, SEEDS, measure_window, &lens);
        /* eye paths that are kept: pixels by one place each */
        mean_check_power(&mean, i == PPM_INTEGRATOR_PPM ? 0.02 : 0.01);
        family_add_mean(&family, &mean, expected, 2e-3 * expected, "ball, integrator %d", i);
    }
    family_check(&family);
}

/* ---- under water ----------------------------------------------------------------------------- */

/* A floor that shines, under water, seen from above: L (1 - R) / n^2 leaves; what the surface
 * throws back is lost on the black floor. Open sheet: above is outside. */
static void a_floor_under_water_is_darker_by_the_square_of_the_index(void **state)
{
    (void)state;
    add_quad(test.scene, material_emitter(test.scene, 5.0f, 0.0f, true), vec3(-9, -1, -9),
             vec3(0, 0, 18), vec3(18, 0, 0));
    const ppm_material_id water = material_glass(test.scene, 1.33f, 0.0f);
    add_quad(test.scene, water, vec3(-9, 0, -9), vec3(0, 0, 18), vec3(18, 0, 0));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    camera_orthographic(test.scene, vec3(2.4f, 3.2f, 0), vec3(0, 0, 0), 0.5f);
    const double cosines[2] = {1.0, 0.8};
    for (uint32_t camera = 0; camera < 2; camera++) {
        const double expected = 5.0 / (1.33 * 1.33) * (1.0 - fresnel(cosines[camera], 1.33));
        for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
            ppm_render_options options = render_options(i, 16, 1000);
            options.camera = camera + 1;
            const test_mean mean = render_green(test.scene, &options, 8, SEEDS);
            mean_check_power(&mean, 0.005);
            family_add_mean(&family, &mean, expected, 1e-5, "camera %u, integrator %d", camera, i);
        }
    }
    family_check(&family);
}

/* The same with a floor that is lit through the water by the sun: power goes in without the square,
 * radiance comes out with it. */
static void sunlight_on_a_floor_under_water_is_right(void **state)
{
    (void)state;
    add_floor(-1.0f);
    const ppm_material_id water = material_glass(test.scene, 1.33f, 0.0f);
    add_quad(test.scene, water, vec3(-4, 0, -4), vec3(0, 0, 8), vec3(8, 0, 0));
    light_directional(test.scene, vec3(0.6f, -0.8f, 0), vec3_splat(10.0f));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    ppm_render_options options = caustic_options(16, 40000, 0.1f);
    options.max_depth = 2; /* surface and floor: nothing comes back from the surface */
    const test_mean mean = render_green(test.scene, &options, 8, SEEDS);
    mean_check_power(&mean, 0.01);
    const double irradiance = 10.0 * 0.8 * (1.0 - fresnel(0.8, 1.33));
    const double radiance = irradiance * (double)reflectance / M_PI;
    family_add_mean(&family, &mean, radiance / (1.33 * 1.33) * (1.0 - fresnel(1.0, 1.33)), 1e-6,
                    "floor");
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_slab_lets_through_what_fresnel_leaves),
        WITH_SCENE(a_slab_absorbs_as_beer_and_lambert_say),
        WITH_SCENE(the_eye_sees_through_a_slab_what_is_left),
        WITH_SCENE(a_ball_gathers_the_light_that_falls_on_it),
        WITH_SCENE(a_floor_under_water_is_darker_by_the_square_of_the_index),
        WITH_SCENE(sunlight_on_a_floor_under_water_is_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
