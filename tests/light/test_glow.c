/* Lamps with textures: places are drawn by brightness, with the density that is stated for them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "light/tables.h"
#include "scene/mipmap.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;
static test_family family;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    world = (test_world){0};
    family = (test_family){0};
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    world_close(&world);
    scene_close(&test);
    return 0;
}

/* ---- trees ----------------------------------------------------------------------------------- */

enum { SIDE = 64 };

typedef struct test_lattice {
    float corners[(SIDE + 1) * (SIDE + 2) / 2], middles[SIDE * SIDE];
    ppmi_glow_lattice lattice;
} test_lattice;

static void lattice_clear(test_lattice *values, float value)
{
    values->lattice = (ppmi_glow_lattice){SIDE, values->corners, values->middles};
    for (size_t i = 0; i < ppmi_glow_corner_count(SIDE); i++)
        values->corners[i] = value;
    for (size_t i = 0; i < SIDE * SIDE; i++)
        values->middles[i] = value;
}

/* Draws places and counts them by squares of the triangle; the expectation is the integral of the
 * stated density over each square. */
static void counts_follow_density(const ppmi_glow *glow, uint32_t root)
{
    enum { BINS = 16, FINE = 32 };
    const uint32_t draws = TEST_EFFORT(200000);
    uint32_t rounded = 0;
    double counts[BINS * BINS] = {0}, expected[BINS * BINS] = {0};
    ppmi_rng rng = ppmi_rng_start(7, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < draws; i++) {
        float density;
        const double u = ppmi_rng_double(&rng), v = ppmi_rng_double(&rng);
        const ppmi_vec2 at = ppmi_glow_sample(glow, root, u, v, &density);
        assert_true(at.x >= 0.0f && at.y >= 0.0f && at.x + at.y <= 1.00001f);
        const float again = ppmi_glow_density(glow, root, at.x, at.y);
        rounded += fabsf(again / density - 1.0f) > 1e-6f; /* over the border of a part */
        const int column = (int)fminf(at.x * BINS, BINS - 1),
                  row = (int)fminf(at.y * BINS, BINS - 1);
        counts[row * BINS + column] += 1.0;
    }
    assert_true(rounded < 1e-4 * draws);
    /* each fine square is two triangles with middles at a third and two thirds of it */
    const int cells = BINS * FINE;
    for (int j = 0; j < cells; j++) {
        for (int i = 0; i + j < cells; i++) {
            const double scale = draws / ((double)cells * cells);
            double *bin = &expected[j / FINE * BINS + i / FINE];
            const float third = 1.0f / 3, size = 1.0f / (float)cells;
            *bin += scale * (double)ppmi_glow_density(glow, root, ((float)i + third) * size,
                                                      ((float)j + third) * size);
            if (i + j == cells - 1) continue;
            *bin += scale * (double)ppmi_glow_density(glow, root, ((float)i + 1 - third) * size,
                                                      ((float)j + 1 - third) * size);
        }
    }
    double total = 0.0;
    for (int i = 0; i < BINS * BINS; i++)
        total += expected[i];
    assert_near(total / draws, 1.0, 1e-4);
    family_add(&family, p_counts(counts, expected, BINS * BINS), "places");
    family_check(&family);
}

static void a_tree_draws_with_the_density_that_it_states(void **state)
{
    (void)state;
    static test_lattice values;
    lattice_clear(&values, 0.0f);
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_EYE, 0);
    for (int i = 0; i < SIDE * SIDE; i++) {
        if (ppmi_rng_float(&rng) < 0.02f) values.middles[i] = ppmi_rng_float(&rng);
    }
    ppmi_glow glow = {0};
    uint32_t root;
    assert_int_equal(ppmi_glow_add(test.context, &glow, &values.lattice, 1e-6, &root),
                     PPM_STATUS_OK);
    assert_true(root != PPMI_GLOW_EVEN);
    counts_follow_density(&glow, root);
    ppmi_glow_deinit(test.context, &glow);
}

static void what_is_even_or_dark_has_no_tree(void **state)
{
    (void)state;
    static test_lattice values;
    ppmi_glow glow = {0};
    for (int i = 0; i < 2; i++) {
        uint32_t root = 0;
        lattice_clear(&values, i == 0 ? 0.0f : 3.0f);
        assert_int_equal(ppmi_glow_add(test.context, &glow, &values.lattice, 1e-6, &root),
                         PPM_STATUS_OK);
        assert_int_equal(root, PPMI_GLOW_EVEN);
        assert_near(ppmi_glow_mean_of_corners(&values.lattice), i == 0 ? 0.0 : 3.0, 1e-6);
        assert_near(ppmi_glow_mean_of_middles(&values.lattice), i == 0 ? 0.0 : 3.0, 1e-6);
    }
    assert_int_equal(glow.count, 0);
    ppmi_glow_deinit(test.context, &glow);
}

/* A dot costs one node a level, and has nearly all of the density. */
static void a_dot_is_found_by_few_nodes(void **state)
{
    (void)state;
    static test_lattice values;
    lattice_clear(&values, 0.0f);
    values.middles[ppmi_glow_middle_at(SIDE, 11, 23, false)] = 1.0f;
    ppmi_glow glow = {0};
    uint32_t root;
    assert_int_equal(ppmi_glow_add(test.context, &glow, &values.lattice, 1e-4, &root),
                     PPM_STATUS_OK);
    assert_true(glow.count <= 6);
    const float inside =
        ppmi_glow_density(&glow, root, (11 + 1.0f / 3) / SIDE, (23 + 1.0f / 3) / SIDE);
    assert_true(inside > 0.95f * SIDE * SIDE);
    assert_true(ppmi_glow_density(&glow, root, 0.7f, 0.1f) > 0.01f);
    ppmi_glow_deinit(test.context, &glow);
}

/* ---- lamps ----------------------------------------------------------------------------------- */

enum { IMAGE = 16 };

/* Mostly dark, with some bright texels. */
static ppm_image_id speckled_image(void)
{
    float pixels[3 * IMAGE * IMAGE];
    ppmi_rng rng = ppmi_rng_start(5, PPMI_STREAM_EYE, 0);
    for (int i = 0; i < IMAGE * IMAGE; i++) {
        const float value = ppmi_rng_float(&rng) < 0.1f ? ppmi_rng_float(&rng) : 0.0f;
        for (int k = 0; k < 3; k++)
            pixels[3 * i + k] = value * (float)(k + 1);
    }
    return image_rgb(test.scene, IMAGE, IMAGE, pixels);
}

static ppm_material_id lamp_material(ppm_texture texture)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    for (int k = 0; k < 3; k++) {
        desc.base_color[k] = 0.0f;
        desc.emission[k] = 10.0f;
    }
    desc.specular = 0.0f;
    desc.double_sided = 1;
    desc.emission_texture = texture;
    return material_add(test.scene, &desc);
}

/* Irradiance at the origin from below, and the flux, of instance 0's two triangles, by many places.
 */
static void integrate(double *out_irradiance, double *out_flux)
{
    enum { STEPS = 512 };
    *out_irradiance = *out_flux = 0.0;
    for (uint32_t t = 0; t < 2; t++) {
        for (int k = 0; k < STEPS * STEPS; k++) {
            const ppmi_vec2 at = ppmi_sample_triangle(((float)(k % STEPS) + 0.37f) / STEPS,
                                                      ((float)(k / STEPS) + 0.61f) / STEPS);
            const ppmi_hit hit = {.triangle = t, .u = at.x, .v = at.y};
            ppmi_surface surface;
            ppmi_surface_from_hit(test.scene, &hit, &surface);
            const double area = (double)ppmi_surface_area(&surface) / (STEPS * STEPS);
            const ppmi_vec3 light = ppmi_surface_emission(test.scene, &surface, surface.ng);
            const ppmi_vec3 way = surface.position;
            const float distance = vec3_length(way);
            const float factor = fabsf(vec3_dot(way, surface.ng)) * ppmi_max(way.y, 0.0f) /
                                 (distance * distance * distance * distance);
            *out_irradiance += (double)(vec3_mean(light) * factor) * area;
            *out_flux += (double)vec3_mean(light) * area * 2.0 * M_PI;
        }
    }
}

/* Light sampling against the integral; and each sample's density against what MIS asks for when the
 * way to it meets the lamp. */
static void check_samples(double irradiance, const char *name)
{
    test_mean mean = {0};
    uint32_t met = 0, lit = 0;
    ppmi_rng rng = ppmi_rng_start(9, PPMI_STREAM_EYE, family.count);
    const ppmi_vec3 origin = vec3_splat(0.0f), up = vec3(0, 1, 0);
    const ppmi_receiver at = {.position = origin, .normal = up};
    for (uint32_t i = 0; i < TEST_EFFORT(40000); i++) {
        const double pick = ppmi_rng_double(&rng);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_light_sample s;
        double value = 0.0;
        if (ppmi_lights_sample(world.lights, origin, up, pick, u, v, &s)) {
            lit++;
            value = (double)(vec3_mean(s.radiance) * ppmi_max(s.wi.y, 0.0f) / s.pdf);
            const ppmi_ray ray = {.origin = origin, .t_max = INFINITY, .direction = s.wi};
            ppmi_hit hit;
            ppmi_surface surface;
            if (ppmi_accel_intersect(world.accel, &ray, &hit)) {
                ppmi_surface_from_hit(test.scene, &hit, &surface);
                const float pdf =
                    ppmi_lights_pdf_surface(world.lights, &at, &hit, &surface, s.wi, hit.t);
                met += fabs((double)(pdf / s.pdf) - 1.0) < 1e-3;
            }
        }
        mean_add(&mean, value);
    }
    assert_true(lit > mean.count / 4 && met > 0.99 * lit); /* but for rounding at borders */
    mean_check_power(&mean, 0.02);
    family_add_mean(&family, &mean, irradiance, 2e-3 * irradiance, "%s", name);
}

static void check_photons(double flux, const char *name)
{
    test_mean mean = {0};
    ppmi_rng rng = ppmi_rng_start(10, PPMI_STREAM_PHOTON, family.count);
    for (uint32_t i = 0; i < TEST_EFFORT(40000); i++) {
        const double pick = ppmi_rng_double(&rng);
        const float u[4] = {ppmi_rng_float(&rng), ppmi_rng_float(&rng), ppmi_rng_float(&rng),
                            ppmi_rng_float(&rng)};
        ppmi_emission emission;
        const bool is_sent = ppmi_lights_emit(world.lights, pick, u, &emission);
        mean_add(&mean, is_sent ? (double)vec3_mean(emission.power) : 0.0);
    }
    mean_check_power(&mean, 0.02);
    family_add_mean(&family, &mean, flux, 2e-3 * flux, "%s: photons", name);
}

static void check_lamp(ppm_material_id material, const char *name)
{
    add_quad(test.scene, material, vec3(-1, 1, -1), vec3(2.2f, 0.3f, 0), vec3(0, 0, 1.9f));
    assert_int_equal(ppmi_scene_build_mipmaps(test.scene), PPM_STATUS_OK);
    world_open(&world, &test);
    double irradiance, flux;
    integrate(&irradiance, &flux);
    assert_true(irradiance > 0.0);
    check_samples(irradiance, name);
    check_photons(flux, name);
    world_close(&world);
    world = (test_world){0};
    scene_close(&test);
    scene_open(&test);
}

static void samples_and_densities_agree_however_a_texture_lies(void **state)
{
    (void)state;
    const int32_t filters[2] = {PPM_FILTER_NEAREST, PPM_FILTER_LINEAR};
    const int32_t wraps[3] = {PPM_WRAP_REPEAT, PPM_WRAP_MIRROR, PPM_WRAP_CLAMP};
    for (int i = 0; i < 6; i++) {
        const ppm_texture texture = {.image = speckled_image(),
                                     .filter = filters[i % 2],
                                     .wrap_u = wraps[i % 3],
                                     .wrap_v = wraps[i / 2],
                                     .has_transform = i > 0,
                                     .uv_transform = {1.7f, 0.6f, -0.4f, -0.5f, 1.3f, 0.2f}};
        check_lamp(lamp_material(texture), "wrapped");
    }
    family_check(&family);
}

/* A texture that is tiled more often than is looked at, all of one texel, and none at all. */
static void samples_are_right_for_odd_coordinates(void **state)
{
    (void)state;
    const float transforms[3][6] = {{170, 0, 3, 0, 190, -7}, {1e-6f, 0, 0.5f, 0, 0, 0.46f}, {0}};
    for (int i = 0; i < 3; i++) {
        ppm_texture texture = {.image = speckled_image(), .has_transform = i < 2};
        texture.uv_set = i == 2 ? 1 : 0;
        if (i == 2) texture.filter = PPM_FILTER_LINEAR;
        for (int k = 0; k < 6; k++)
            texture.uv_transform[k] = transforms[i][k];
        if (i > 0) { /* the one texel has to shine */
            float pixels[3 * IMAGE * IMAGE];
            for (int k = 0; k < 3 * IMAGE * IMAGE; k++)
                pixels[k] = 0.3f;
            texture.image = image_rgb(test.scene, IMAGE, IMAGE, pixels);
        }
        check_lamp(lamp_material(texture), "odd");
    }
    family_check(&family);
}

/* ---- a screen -------------------------------------------------------------------------------- */

enum { SCREEN = 512, DOT = 3 };

static test_mean irradiance_of_scene(void)
{
    test_mean mean = {0};
    ppmi_rng rng = ppmi_rng_start(2, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < TEST_EFFORT(20000); i++) {
        const double pick = ppmi_rng_double(&rng);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_light_sample s;
        const bool is_lit =
            ppmi_lights_sample(world.lights, vec3_splat(0.0f), vec3(0, 1, 0), pick, u, v, &s);
        mean_add(&mean,
                 is_lit ? (double)(vec3_mean(s.radiance) * ppmi_max(s.wi.y, 0.0f) / s.pdf) : 0.0);
    }
    return mean;
}

/* The root of the mean square of the estimates, by their mean. */
static double spread(const test_mean *mean)
{
    return sqrt(mean->squares / (double)mean->count + mean->mean * mean->mean) / mean->mean;
}

/* A dot of 3 x 3 texels on 512 x 512 that are dark is light much like a quad of its size: most
 * samples find it, where one even place in 29,000 would. */
static void a_bright_dot_on_a_dark_screen_is_found(void **state)
{
    (void)state;
    for (int filter = 0; filter < 2; filter++) {
        float *pixels = calloc(3 * SCREEN * SCREEN, sizeof *pixels);
        for (int k = 0; k < DOT * DOT; k++) {
            const int at = (217 + k / DOT) * SCREEN + 139 + k % DOT;
            for (int c = 0; c < 3; c++)
                pixels[3 * at + c] = 1.0f;
        }
        ppm_texture texture = {.image = image_rgb(test.scene, SCREEN, SCREEN, pixels)};
        free(pixels);
        texture.filter = filter == 0 ? PPM_FILTER_NEAREST : PPM_FILTER_LINEAR;
        add_quad(test.scene, lamp_material(texture), vec3(-1, 1, -1), vec3(2, 0, 0), vec3(0, 0, 2));
        world_open(&world, &test);
        const test_mean mean = irradiance_of_scene();
        const ppmi_vec3 dot = vec3(-1 + 2 * 140.5f / SCREEN, 1, -1 + 2 * 218.5f / SCREEN);
        const double expected =
            10.0 * pow(2.0 * DOT / SCREEN, 2) / pow((double)vec3_length2(dot), 2);
        mean_check_power(&mean, 0.02);
        family_add_mean(&family, &mean, expected, 1e-3 * expected, "filter %d", filter);
        assert_true(spread(&mean) < 1.2);
        world_close(&world);
        world = (test_world){0};
        scene_close(&test);
        scene_open(&test);
    }
    family_check(&family);
}

/* What a mesh shines is what its triangles are chosen by: those on dark texels hardly are. */
static void dark_triangles_are_hardly_chosen(void **state)
{
    (void)state;
    float pixels[3 * 4] = {1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    const ppm_texture texture = {.image = image_rgb(test.scene, 4, 1, pixels),
                                 .filter = PPM_FILTER_NEAREST,
                                 .wrap_u = PPM_WRAP_CLAMP};
    enum { COLUMNS = 64 };
    static float positions[6 * (COLUMNS + 1)], uvs[4 * (COLUMNS + 1)];
    static uint32_t indices[6 * COLUMNS];
    for (int i = 0; i <= COLUMNS; i++) {
        for (int k = 0; k < 2; k++) {
            positions[6 * i + 3 * k] = (float)i / COLUMNS;
            positions[6 * i + 3 * k + 1] = 1.0f;
            positions[6 * i + 3 * k + 2] = (float)k;
            uvs[4 * i + 2 * k] = (float)i / COLUMNS;
            uvs[4 * i + 2 * k + 1] = (float)k;
        }
    }
    for (uint32_t i = 0; i < COLUMNS; i++) {
        const uint32_t quad[6] = {2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 2, 2 * i + 1, 2 * i + 3};
        for (int k = 0; k < 6; k++)
            indices[6 * i + (uint32_t)k] = quad[k];
    }
    const ppm_primitive_desc strip = {.vertex_count = 2 * (COLUMNS + 1),
                                      .triangle_count = 2 * COLUMNS,
                                      .positions = positions,
                                      .uvs = {uvs},
                                      .indices = indices,
                                      .material = lamp_material(texture)};
    shape_place(test.scene, shape_mesh(test.scene, &strip));
    world_open(&world, &test);
    const test_mean mean = irradiance_of_scene();
    double dark = 0.0, all = 0.0;
    for (uint32_t i = 0; i < world.lights->triangle_count; i++) {
        const ppmi_emitter *e = &world.lights->emitters[i];
        const double power = (double)(e->radiance * e->area);
        assert_true(power > 0.0);
        all += power;
        if (i >= COLUMNS / 2) dark += power;
    }
    assert_true(dark < 0.03 * all);
    assert_true(spread(&mean) < 1.6);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_tree_draws_with_the_density_that_it_states),
        WITH_SCENE(what_is_even_or_dark_has_no_tree),
        WITH_SCENE(a_dot_is_found_by_few_nodes),
        WITH_SCENE(samples_and_densities_agree_however_a_texture_lies),
        WITH_SCENE(samples_are_right_for_odd_coordinates),
        WITH_SCENE(a_bright_dot_on_a_dark_screen_is_found),
        WITH_SCENE(dark_triangles_are_hardly_chosen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
