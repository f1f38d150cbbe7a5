/* Lights with an extent through whole renders: both integrators, light seen and light that bounces.
 */
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
static test_family family;

enum { SEEDS = 12 };

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

static void add_lamp(int32_t kind, ppmi_vec3 at, float intensity, float size, bool is_hidden)
{
    const ppm_light_desc lamp = {
        .size = sizeof lamp,
        .kind = kind,
        .transform = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, at.x, at.y, at.z, 1},
        .intensity = {intensity, intensity, intensity},
        .radius_m = size,
        .width_m = size,
        .height_m = size,
        .is_hidden = is_hidden};
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(test.scene, &lamp, &id), PPM_STATUS_OK);
}

static void compare(const char *name, ppm_render_options *options, double expected,
                    double systematic)
{
    const test_mean mean = render_green(test.scene, options, 16, SEEDS);
    family_add_mean(&family, &mean, expected, systematic * expected, "%s, integrator %d", name,
                    (int)options->integrator);
}

/* Within a closed ball of reflectance p the walls' irradiance is even but for what comes straight
 * from the lamp: phi / (4 pi R^2) / (1 - p) for a lamp in the middle. Facets make the ball a little
 * smaller. */
static void a_lamp_in_a_closed_ball_fills_it(void **state)
{
    (void)state;
    const float reflectance = 0.6f, radius = 2.0f;
    shape_place(test.scene, shape_sphere(test.scene, material_lambert(test.scene, reflectance),
                                         radius, 48, false));
    add_lamp(PPM_LIGHT_POINT, vec3_splat(0.0f), 3.0f, 0.5f, true);
    camera_perspective(test.scene, vec3(0, 0, 1.0f), vec3(0.3f, 0.2f, 2.0f), 0.5f);
    const double irradiance = 3.0 / (double)(radius * radius) / (1.0 - (double)reflectance);
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        ppm_render_options options = render_options(i, 8, 4000);
        options.radius_m = 0.2f;
        options.max_depth = 64;
        compare("closed ball", &options, irradiance * (double)reflectance / M_PI, 0.01);
    }
    family_check(&family);
}

/* All light by photons, or sampled, or met by chance: one picture. */
static void all_ways_to_a_lamp_agree(void **state)
{
    (void)state;
    const float reflectance = 0.5f;
    add_quad(test.scene, material_lambert(test.scene, reflectance), vec3(-4, 0, -4), vec3(0, 0, 8),
             vec3(8, 0, 0));
    add_lamp(PPM_LIGHT_DISK, vec3(0, 0.5f, 0), 2.0f, 1.0f, false);
    camera_orthographic(test.scene, vec3(0, 0.25f, 0), vec3_splat(0.0f), 0.04f);
    const double exact = M_PI * 2.0 * 0.25 / (0.25 + 0.25) * (double)reflectance / M_PI;
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
        for (int32_t direct = PPM_DIRECT_SAMPLE; direct <= PPM_DIRECT_PHOTONS; direct++) {
            if (i == PPM_INTEGRATOR_PATH && direct == PPM_DIRECT_PHOTONS) continue;
            ppm_render_options options = render_options(i, 8, 4000);
            options.radius_m = 0.05f;
            options.direct = direct;
            compare(direct == PPM_DIRECT_SAMPLE ? "sampled" : "photons", &options, exact, 0.01);
        }
    }
    family_check(&family);
}

/* The camera looks at the lamp from below: straight, and by way of a mirror. */
static void a_lamp_is_seen_unless_it_is_hidden(void **state)
{
    (void)state;
    ppm_material_desc mirror;
    ppm_material_desc_init(&mirror);
    mirror.metallic = 1.0f;
    mirror.roughness = 0.0f;
    add_quad(test.scene, material_add(test.scene, &mirror), vec3(-4, 0, -4), vec3(0, 0, 8),
             vec3(8, 0, 0));
    add_lamp(PPM_LIGHT_RECTANGLE, vec3(0, 2, 0), 5.0f, 1.0f, false);
    add_lamp(PPM_LIGHT_RECTANGLE, vec3(0, 3, 0), 7.0f, 1.0f, true);
    camera_orthographic(test.scene, vec3(0, 1, 0), vec3(0, 2, 0), 0.1f);
    camera_orthographic(test.scene, vec3(0, 1, 0), vec3(0, 0, 0), 0.1f);
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
        ppm_render_options options = render_options(i, 4, 500);
        for (ppm_camera_id camera = 1; camera <= 2; camera++) {
            options.camera = camera;
            float *picture = render_picture(test.scene, &options, 2);
            for (int k = 0; k < 16; k++)
                assert_near(picture[4 * k + 1], camera == 1 ? 5.0 : 12.0, 1e-3);
            free(picture);
        }
    }
}

/* Fog before a lamp dims it by its transmittance; what scatters is more, and none here. */
static void fog_dims_a_lamp_by_the_way_to_it(void **state)
{
    (void)state;
    add_quad(test.scene, material_lambert(test.scene, 0.0f), vec3(-4, 0, -4), vec3(0, 0, 8),
             vec3(8, 0, 0));
    add_lamp(PPM_LIGHT_RECTANGLE, vec3(0, 1, 0), 5.0f, 1.0f, false);
    add_lamp(PPM_LIGHT_POINT, vec3(0, 2.5f, 0), 9.0f, 0.5f, false);
    scene_fog(test.scene, vec3_splat(0.0f), vec3_splat(0.7f), 0.0f);
    camera_orthographic(test.scene, vec3(0, 0.2f, 0), vec3(0, 1, 0), 0.02f);
    const double expected = 5.0 * exp(-0.56) + 9.0 / (M_PI * 0.25) * exp(-1.26);
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
        ppm_render_options options = render_options(i, 4, 500);
        float *picture = render_picture(test.scene, &options, 2);
        for (int k = 0; k < 16; k++)
            assert_near(picture[4 * k + 1] / expected, 1.0, 2e-3);
        free(picture);
    }
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(a_lamp_in_a_closed_ball_fills_it),
        CASE(all_ways_to_a_lamp_agree),
        CASE(a_lamp_is_seen_unless_it_is_hidden),
        CASE(fog_dims_a_lamp_by_the_way_to_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
