/* The environment: which way is which, and sampling by its density. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "light/environment.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

enum { WIDTH = 16, HEIGHT = 8 };

static test_scene test;
static ppmi_environment_map map;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    ppmi_environment_map_deinit(test.context, &map);
    scene_close(&test);
    return 0;
}

static void open_map(const float *pixels, float rotation)
{
    light_environment(test.scene, vec3_splat(1.0f),
                      pixels ? image_rgb(test.scene, WIDTH, HEIGHT, pixels) : 0, rotation);
    assert_int_equal(ppmi_environment_map_init(test.context, test.scene, &map), PPM_STATUS_OK);
}

/* r tells the column, g the row. */
static void fill_with_places(float *pixels)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        pixels[3 * i] = (float)(i % WIDTH);
        pixels[3 * i + 1] = (float)(i / WIDTH);
        pixels[3 * i + 2] = 0.0f;
    }
}

static ppmi_vec3 look(float x, float y, float z)
{
    return ppmi_environment_map_radiance(&map, vec3_normalize(vec3(x, y, z)));
}

static void row_0_is_up_and_the_middle_column_is_ahead(void **state)
{
    (void)state;
    float pixels[3 * WIDTH * HEIGHT];
    fill_with_places(pixels);
    open_map(pixels, 0.0f);
    assert_near(look(0, 1, 0).y, 0.0, 1e-4);
    assert_near(look(0, -1, 0).y, HEIGHT - 1, 1e-4);
    assert_near(look(0, 0, -1).x, WIDTH / 2 - 0.5, 1e-3);
    assert_near(look(0, 0, -1).y, HEIGHT / 2 - 0.5, 1e-3);
    /* columns run to the right as seen from inside, looking along -Z */
    assert_near(look(1, 0, 0).x, 3 * WIDTH / 4 - 0.5, 1e-3);
    assert_near(look(-1, 0, 0).x, WIDTH / 4 - 0.5, 1e-3);
}

static void rotation_turns_the_image_counter_clockwise_from_above(void **state)
{
    (void)state;
    float pixels[3 * WIDTH * HEIGHT];
    fill_with_places(pixels);
    open_map(pixels, 0.5f * PPMI_PI);
    /* from above (+Y down to the eye) -Z turns counter-clockwise to -X */
    assert_near(look(-1, 0, 0).x, WIDTH / 2 - 0.5, 1e-3);
    assert_near(look(0, 0, -1).x, 3 * WIDTH / 4 - 0.5, 1e-3);
}

static void fill_with_sun(float *pixels)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float value = i == 3 * WIDTH + 5 ? 1000.0f : i % 3 == 0 ? 0.0f : (float)(i % 7);
        pixels[3 * i] = pixels[3 * i + 1] = pixels[3 * i + 2] = value;
    }
}

/* Bins of a quarter texel each, in the image's own frame: the density is even in each of them. */
enum { FINE = 2, COLUMNS = FINE * WIDTH, ROWS = FINE * HEIGHT, CELLS = COLUMNS * ROWS };

static ppmi_vec3 direction_at(double column, double row, double rotation)
{
    const double phi = (column / COLUMNS - 0.5) * 2.0 * M_PI - rotation, theta = row / ROWS * M_PI;
    return vec3((float)(sin(theta) * sin(phi)), (float)cos(theta), (float)(-sin(theta) * cos(phi)));
}

static int cell_of(ppmi_vec3 d, double rotation)
{
    double turn = atan2((double)d.x, -(double)d.z) / (2.0 * M_PI) + 0.5 + rotation / (2.0 * M_PI);
    turn -= floor(turn);
    const int column = (int)(turn * COLUMNS), row = (int)(acos((double)d.y) / M_PI * ROWS);
    return (row < ROWS ? row : ROWS - 1) * COLUMNS + (column < COLUMNS ? column : COLUMNS - 1);
}

static void directions_are_drawn_with_their_density(void **state)
{
    (void)state;
    const double rotation = 0.4;
    float pixels[3 * WIDTH * HEIGHT];
    fill_with_sun(pixels);
    open_map(pixels, (float)rotation);
    double observed[CELLS] = {0.0}, expected[CELLS], total = 0.0;
    const uint32_t count = TEST_EFFORT(400000);
    for (int i = 0; i < CELLS; i++) {
        const int row = i / COLUMNS, column = i % COLUMNS;
        const double solid_angle =
            2.0 * M_PI / COLUMNS * (cos(M_PI * row / ROWS) - cos(M_PI * (row + 1) / ROWS));
        const ppmi_vec3 middle = direction_at(column + 0.5, row + 0.5, rotation);
        expected[i] = (double)ppmi_environment_map_pdf(&map, middle) * solid_angle;
        total += expected[i];
        expected[i] *= count;
    }
    assert_near(total, 1.0, 1e-4);
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 0);
    for (uint32_t i = 0; i < count; i++) {
        const double cell = ppmi_rng_double(&rng);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_vec3 d;
        const float pdf = ppmi_environment_map_sample(&map, cell, u, v, &d);
        observed[cell_of(d, rotation)] += 1.0;
        /* at the rim of a cell rounding decides which one it is */
        const bool is_inside = u > 0.01f && u < 0.99f && v > 0.01f && v < 0.99f;
        if (is_inside) assert_near(ppmi_environment_map_pdf(&map, d) / pdf, 1.0, 1e-4);
    }
    test_family family = {0};
    family_add(&family, p_counts(observed, expected, CELLS), "cells");
    family_check(&family);
}

/* Irradiance by importance sampling is that of even sampling. */
static void radiance_by_density_has_the_right_mean(void **state)
{
    (void)state;
    float pixels[3 * WIDTH * HEIGHT];
    fill_with_sun(pixels);
    open_map(pixels, -1.0f);
    const ppmi_vec3 n = vec3_normalize(vec3(1, 1, 1));
    test_mean by_power = {0};
    double even = 0.0;
    const int grid = 2000;
    for (int i = 0; i < grid * grid; i++) {
        const ppmi_vec3 d = ppmi_sample_sphere(((float)(i / grid) + 0.5f) / (float)grid,
                                               ((float)(i % grid) + 0.5f) / (float)grid);
        const float cosine = vec3_dot(d, n);
        if (cosine > 0.0f) even += (double)(ppmi_environment_map_radiance(&map, d).x * cosine);
    }
    even *= 4.0 * M_PI / grid / grid;
    ppmi_rng rng = ppmi_rng_start(2, PPMI_STREAM_EYE, 0);
    const uint32_t count = TEST_EFFORT(200000);
    for (uint32_t i = 0; i < count; i++) {
        const double cell = ppmi_rng_double(&rng);
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        ppmi_vec3 d;
        const float pdf = ppmi_environment_map_sample(&map, cell, u, v, &d);
        const float cosine = ppmi_max(vec3_dot(d, n), 0.0f);
        mean_add(&by_power, (double)(ppmi_environment_map_radiance(&map, d).x * cosine / pdf));
    }
    mean_check_power(&by_power, 0.01);
    test_family family = {0};
    /* the grid of 4 million directions: texels are smooth over its steps */
    family_add_mean(&family, &by_power, even, 1e-4 * even, "irradiance");
    family_check(&family);
}

/* Filtering takes a sun's light into the pixels around it. What a direction then brings by its
 * density is at most 16 times the mean (at the corner of the pixel across: a quarter of the sun,
 * where the pixel has 1/64 of it in the mean) over the share that follows the image. */
static void no_direction_outshines_its_density(void **state)
{
    (void)state;
    float pixels[3 * WIDTH * HEIGHT];
    fill_with_sun(pixels);
    open_map(pixels, 0.0f);
    const int grid = 1000;
    double most = 0.0;
    for (int i = 0; i < grid * grid; i++) {
        const ppmi_vec3 d = ppmi_sample_sphere(((float)(i / grid) + 0.5f) / (float)grid,
                                               ((float)(i % grid) + 0.5f) / (float)grid);
        const float radiance = ppmi_environment_map_radiance(&map, d).x;
        most = fmax(most, (double)(radiance / ppmi_environment_map_pdf(&map, d)));
    }
    const double mean = (double)map.integral.x;
    assert_true(most > 2.0 * mean);
    assert_true(most < 18.0 * mean);
}

static void a_constant_map_is_drawn_evenly(void **state)
{
    (void)state;
    open_map(NULL, 0.0f);
    assert_true(ppmi_environment_map_is_constant(&map));
    ppmi_vec3 d;
    assert_near(ppmi_environment_map_sample(&map, 0.3, 0.2f, 0.7f, &d), 0.25 / M_PI, 1e-7);
    assert_near(ppmi_environment_map_pdf(&map, d), 0.25 / M_PI, 1e-7);
    assert_near(map.integral.x, 4.0 * M_PI, 1e-5);
}

static void a_black_map_is_no_fault(void **state)
{
    (void)state;
    const float pixels[3 * WIDTH * HEIGHT] = {0.0f};
    open_map(pixels, 0.0f);
    assert_near(map.integral.x, 0.0, 0.0);
    ppmi_vec3 d;
    ppmi_environment_map_sample(&map, 0.3, 0.2f, 0.7f, &d);
    assert_true(vec3_is_finite(d));
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(row_0_is_up_and_the_middle_column_is_ahead),
        WITH_SCENE(rotation_turns_the_image_counter_clockwise_from_above),
        WITH_SCENE(directions_are_drawn_with_their_density),
        WITH_SCENE(radiance_by_density_has_the_right_mean),
        WITH_SCENE(no_direction_outshines_its_density),
        WITH_SCENE(a_constant_map_is_drawn_evenly),
        WITH_SCENE(a_black_map_is_no_fault),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
