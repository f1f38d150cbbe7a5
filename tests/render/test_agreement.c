/* The two integrators against each other, and how photon mapping converges. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static test_scene test;

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

/* A closed box with a lamp, coloured walls and a block in it, of materials that gather and do not.
 */
static int open_box(void **state)
{
    (void)state;
    scene_open(&test);
    ppm_scene *scene = test.scene;
    const ppm_material_id grey = material_lambert(scene, 0.6f);
    shape_place(scene, shape_box(scene, grey, vec3_splat(-1), vec3_splat(1), 1, true));
    add_quad(scene, material_emitter(scene, 10.0f, 0.0f, false), vec3(-0.4f, 0.99f, -0.4f),
             vec3(0.8f, 0, 0), vec3(0, 0, 0.8f));
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.roughness = 0.35f;
    desc.base_color[0] = 0.2f;
    shape_place(scene, shape_box(scene, material_add(scene, &desc), vec3(-0.6f, -1, -0.7f),
                                 vec3(0.0f, -0.2f, -0.1f), 1, false));
    desc.metallic = 1.0f;
    desc.roughness = 0.7f;
    shape_place_at(scene, shape_sphere(scene, material_add(scene, &desc), 0.35f, 32, true),
                   vec3(0.5f, -0.6f, -0.3f));
    camera_perspective(scene, vec3(0, 0, 0.95f), vec3(0, -0.1f, -1), 1.3f);
    return 0;
}

enum { SIDE = 4, BLOCKS = SIDE * SIDE, SEEDS = 12 };

/* Adds each block's mean to its own statistics. */
static double measure_blocks(const float *rgba, const ppm_render_options *options, void *user)
{
    test_mean *means = user;
    const uint32_t side = options->width / SIDE;
    for (uint32_t block = 0; block < BLOCKS; block++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < side * side; i++) {
            const uint32_t x = block % SIDE * side + i % side, y = block / SIDE * side + i / side;
            sum += (double)rgba[4 * (y * options->width + x) + 1];
        }
        mean_add(&means[block], sum / (side * side));
    }
    return 0.0;
}

/* Photon mapping's bias: within a radius (2 cm, shrinking) of an edge a disk reaches beyond its
 * wall, and on average loses a quarter of its photons there. A block has up to 2 m of edges a
 * square metre: at most 2 * 0.02 / 4 = 1 % of its indirect light. */
static const double density_bias = 0.01;

static void photons_and_paths_agree_block_by_block(void **state)
{
    (void)state;
    test_family family = {0};
    const ppm_render_options path = render_options(PPM_INTEGRATOR_PATH, 32, 0);
    ppm_render_options sppm = render_options(PPM_INTEGRATOR_SPPM, 32, 50000);
    sppm.radius_m = 0.02f;
    test_mean a[BLOCKS] = {{0}}, p[BLOCKS] = {{0}};
    render_means(test.scene, &path, 128, SEEDS, measure_blocks, a);
    render_means(test.scene, &sppm, 8, SEEDS, measure_blocks, p);
    for (uint32_t i = 0; i < BLOCKS; i++) {
        mean_check_power(&a[i], 0.015);
        mean_check_power(&p[i], 0.015);
        const double error = hypot(mean_error(&a[i]), mean_error(&p[i]));
        const double off = fmax(0.0, fabs(a[i].mean - p[i].mean) - density_bias * a[i].mean);
        family_add(&family, p_student(off / error, (double)a[i].count - 1.0),
                   "block %u: paths %g, photons %g, error %g", i, a[i].mean, p[i].mean, error);
    }
    family_check(&family);
}

/* ---- convergence ----------------------------------------------------------------------------- */

/* A floor that is lit by a wall beside it: indirect light only, smooth. */
static int open_floor(void **state)
{
    (void)state;
    scene_open(&test);
    ppm_scene *scene = test.scene;
    const ppm_material_id grey = material_lambert(scene, 0.5f);
    shape_place(scene, shape_box(scene, grey, vec3_splat(-1), vec3_splat(1), 1, true));
    light_point(scene, vec3(0, 0.2f, 0), vec3_splat(1.0f));
    camera_orthographic(scene, vec3(0, 0, 0), vec3(0, -1, 0), 0.4f);
    return 0;
}

/* Variance of the pixels by their squared mean: the light there is nearly even, so this is noise.
 */
static double measure_noise(const float *rgba, const ppm_render_options *options, void *user)
{
    (void)user;
    const uint32_t pixels = options->width * options->height;
    double sum = 0.0, squares = 0.0;
    for (uint32_t i = 0; i < pixels; i++) {
        sum += (double)rgba[4 * i + 1];
        squares += (double)(rgba[4 * i + 1] * rgba[4 * i + 1]);
    }
    const double mean = sum / pixels;
    return (squares / pixels - mean * mean) / (mean * mean);
}

static test_mean noise(float alpha, uint32_t passes)
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, 16, 2000);
    options.radius_m = 0.06f;
    options.alpha = alpha;
    return render_means(test.scene, &options, passes, SEEDS, measure_noise, NULL);
}

/* Variance by passes n: n^-alpha (photons n, area n^(alpha - 1)). At alpha 1 the radius stays and
 * the variance goes as 1 / n; at 2 / 3 it falls more slowly. */
static void squared_error_falls_with_the_passes_by_alpha(void **state)
{
    (void)state;
    const float alphas[2] = {1.0f, 2.0f / 3.0f};
    double ratios[2];
    for (int i = 0; i < 2; i++) {
        const test_mean few = noise(alphas[i], 4), many = noise(alphas[i], 64);
        ratios[i] = few.mean / many.mean;
        const double error =
            ratios[i] * hypot(mean_error(&few) / few.mean, mean_error(&many) / many.mean);
        const double expected = pow(16.0, (double)alphas[i]);
        /* what does not fall: the floor's own gradient, and at the start the first pass, whose
         * photons shrink the radius without having been gathered in the shrunk one */
        const double systematic = 0.2 * expected;
        const double off = fmax(0.0, fabs(ratios[i] - expected) - systematic);
        if (p_student(off / error, (double)few.count - 1.0) < 1e-4) {
            fail_msg("alpha %g: the variance falls by %g +- %g, expected %g", (double)alphas[i],
                     ratios[i], error, expected);
        }
    }
    assert_true(ratios[0] > ratios[1]);
}

/* At alpha 1 the picture is the mean of its passes: nothing that a pass does depends on others. */
static void with_alpha_1_the_radius_stays(void **state)
{
    (void)state;
    /* twice the radius: a quarter of the variance, at any number of passes */
    ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, 16, 2000);
    options.alpha = 1.0f;
    options.radius_m = 0.04f;
    const test_mean narrow = render_means(test.scene, &options, 16, SEEDS, measure_noise, NULL);
    options.radius_m = 0.08f;
    const test_mean wide = render_means(test.scene, &options, 16, SEEDS, measure_noise, NULL);
    const double ratio = narrow.mean / wide.mean;
    const double error =
        ratio * hypot(mean_error(&narrow) / narrow.mean, mean_error(&wide) / wide.mean);
    const double off = fmax(0.0, fabs(ratio - 4.0) - 0.4); /* the floor's gradient */
    if (p_student(off / error, (double)wide.count - 1.0) < 1e-4) {
        fail_msg("twice the radius changes the variance by %g +- %g, not 4", ratio, error);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(photons_and_paths_agree_block_by_block, open_box,
                                        close_scene),
        cmocka_unit_test_setup_teardown(squared_error_falls_with_the_passes_by_alpha, open_floor,
                                        close_scene),
        cmocka_unit_test_setup_teardown(with_alpha_1_the_radius_stays, open_floor, close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
