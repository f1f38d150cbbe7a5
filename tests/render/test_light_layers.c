/* Layers of light: they part the picture, by class and by group. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "ppm/import.h"
#include "statistical/methods.h"
#include "support/light_layers.h"
#include "support/scenes.h"

static test_scene test;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

/* ---- sums ------------------------------------------------------------------------------------ */

/* Sums of floats in another order: relative to what is summed, at some 30 steps of rounding. */
static const float rounding = 4e-6f;

static void check_sum(const layered_picture *picture, int32_t first, int32_t last, const char *name)
{
    float *combined = layered_read(picture, PPM_LAYER_COMBINED, 0);
    float *sum = layered_sum(picture, first, last);
    for (size_t i = 0; i < 3 * picture->pixels; i++) {
        const float expected = combined[4 * (i / 3) + i % 3];
        if (!(fabsf(sum[i] - expected) <= rounding * fabsf(expected) + 1e-12f)) {
            fail_msg("%s: layers %d..%d add up to %.9g in value %zu of the picture's %.9g", name,
                     first, last, (double)sum[i], i, (double)expected);
        }
    }
    free(combined);
    free(sum);
}

static void check_group_caustics(const layered_picture *picture, const char *name)
{
    float *caustics = layered_read(picture, PPM_LAYER_CAUSTICS, 0);
    float *sum = layered_sum(picture, PPM_LAYER_GROUP_CAUSTICS, PPM_LAYER_GROUP_CAUSTICS);
    for (size_t i = 0; i < 3 * picture->pixels; i++) {
        if (!(fabsf(sum[i] - caustics[i]) <= rounding * fabsf(caustics[i]) + 1e-12f)) {
            fail_msg("%s: the groups' caustics add up to %.9g of %.9g", name, (double)sum[i],
                     (double)caustics[i]);
        }
    }
    free(caustics);
    free(sum);
}

static void check_picture_is_the_same(const ppm_render_options *options, uint32_t passes,
                                      const layered_picture *picture, const char *name)
{
    ppm_render_options plain = *options;
    plain.layers = 0;
    float *without = render_picture(test.scene, &plain, passes);
    float *with = layered_read(picture, PPM_LAYER_COMBINED, 0);
    if (memcmp(with, without, 4 * picture->pixels * sizeof *with) != 0) {
        fail_msg("%s: layers change the picture", name);
    }
    free(with);
    free(without);
}

static void check_method(const render_method *method, const char *scene_name)
{
    enum { PASSES = 3 };
    char name[128];
    snprintf(name, sizeof name, "%s, %s", scene_name, method->name);
    ppm_render_options options = method_options(method, 0, 1000);
    options.width = 16;
    options.height = 12;
    options.layers = ALL_LIGHT_LAYERS | ALL_GROUP_LAYERS | PPM_LAYER_BIT(PPM_LAYER_VARIANCE);
    options.light_groups = PPM_LIGHT_GROUPS_NAMED;
    layered_picture picture = layered_open(test.scene, &options, PASSES);
    check_sum(&picture, PPM_LAYER_DIFFUSE_DIRECT, PPM_LAYER_VOLUME, name);
    check_sum(&picture, PPM_LAYER_LIGHT_GROUP, PPM_LAYER_LIGHT_GROUP, name);
    check_group_caustics(&picture, name);
    check_picture_is_the_same(&options, PASSES, &picture, name);
    layered_close(&picture);
}

static void check_sample_scene(const char *name)
{
    char path[512];
    snprintf(path, sizeof path, PPM_SOURCE_DIR "/sample_scenes/%s.glb", name);
    scene_open(&test);
    assert_int_equal(ppm_scene_import(test.scene, path, NULL), PPM_STATUS_OK);
    check_method(&path_method, name);
    const int step = TEST_EFFORT_PERCENT < 100 ? 5 : 1; /* slow: sppm, and ppm with epochs */
    for (int i = 0; i < PHOTON_METHODS; i += step)
        check_method(&photon_methods[i], name);
    scene_close(&test);
}

static void layers_and_groups_add_up_to_the_picture_which_stays_the_same(void **state)
{
    (void)state;
    static const char *const names[] = {
        "caustic_box", "ceramic_box", "enclosed_lamp", "fog_ball", "glass_of_water", "glass_table",
        "interior",    "mirrors",     "pool",          "prism",    "turntable"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        check_sample_scene(names[i]);
}

/* ---- groups ---------------------------------------------------------------------------------- */

static void add_light(const ppm_light_desc *desc)
{
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(test.scene, desc, &id), PPM_STATUS_OK);
}

/* Shining downwards from y. */
static ppm_light_desc light_above(int32_t kind, float x, float y, const char *group)
{
    return (ppm_light_desc){.size = sizeof(ppm_light_desc),
                            .name = "lamp",
                            .kind = kind,
                            .transform = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, x, y, 0, 1},
                            .outer_cone_rad = 0.7f,
                            .light_group = group};
}

/* A glossy floor, a glass ball, a mirror and grey fog, under lights of every kind of which each
 * group has one colour: red, green, blue. */
static void build_coloured_lights(void)
{
    ppm_scene *scene = test.scene;
    ppm_material_desc glossy;
    ppm_material_desc_init(&glossy);
    glossy.roughness = 0.35f; /* narrow, but no mirror */
    glossy.base_color[0] = glossy.base_color[1] = glossy.base_color[2] = 0.5f;
    glossy.metallic = 0.0f;
    add_quad(scene, material_add(scene, &glossy), vec3(-2, 0, -2), vec3(0, 0, 4), vec3(4, 0, 0));
    shape_place_at(scene, shape_sphere(scene, material_glass(scene, 1.5f, 0.0f), 0.5f, 12, true),
                   vec3(-0.6f, 0.8f, 0));
    glossy.metallic = 1.0f;
    glossy.roughness = 0.0f;
    shape_place_at(scene, shape_sphere(scene, material_add(scene, &glossy), 0.4f, 12, true),
                   vec3(0.7f, 0.4f, 0));
    scene_fog(scene, vec3(0.05f, 0.05f, 0.05f), vec3(0, 0, 0), 0.2f);

    ppm_light_desc ball = light_above(PPM_LIGHT_POINT, 0.3f, 2.5f, "red");
    ball.radius_m = 0.3f;
    ball.intensity[0] = 9.0f;
    add_light(&ball);
    ppm_light_desc panel = light_above(PPM_LIGHT_RECTANGLE, -0.5f, 3.0f, "green");
    panel.width_m = panel.height_m = 0.5f;
    panel.intensity[1] = 20.0f;
    add_light(&panel);
    ppm_light_desc point = light_above(PPM_LIGHT_SPOT, 0.0f, 2.0f, "green");
    point.intensity[1] = 4.0f;
    add_light(&point);
    ppm_light_desc sun = light_above(PPM_LIGHT_DIRECTIONAL, 0.0f, 0.0f, "red");
    sun.angular_radius_rad = 0.2f; /* before the blue sky */
    sun.intensity[0] = 1.5f;
    add_light(&sun);
    const ppm_environment_desc sky = {
        .size = sizeof sky, .radiance = {0, 0, 0.4f}, .light_group = "blue"};
    assert_int_equal(ppm_scene_set_environment(scene, &sky), PPM_STATUS_OK);

    ppm_material_desc shining;
    ppm_material_desc_init(&shining);
    shining.emission[2] = 5.0f;
    const ppm_mesh_id quad = shape_quad(scene, material_add(scene, &shining), vec3(1.2f, 0.2f, -1),
                                        vec3(0, 0.6f, 0), vec3(0, 0, 0.6f));
    const ppm_instance_desc placed = {.size = sizeof placed,
                                      .name = "panel",
                                      .mesh = quad,
                                      .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                      .light_group = "blue"};
    ppm_instance_id id;
    assert_int_equal(ppm_scene_add_instance(scene, &placed, &id), PPM_STATUS_OK);
    camera_perspective(scene, vec3(0, 1.6f, 3.2f), vec3(0, 0.5f, 0), 0.9f);
}

static void check_one_colour(const layered_picture *picture, uint32_t group, const char *name)
{
    float *combined = layered_read(picture, PPM_LAYER_COMBINED, 0);
    float *layer = layered_read(picture, PPM_LAYER_LIGHT_GROUP, group);
    float *caustics = layered_read(picture, PPM_LAYER_GROUP_CAUSTICS, group);
    double sum = 0.0;
    for (size_t i = 0; i < 3 * picture->pixels; i++) {
        const bool is_own = i % 3 == group;
        const float expected = is_own ? combined[4 * (i / 3) + group] : 0.0f;
        if (!(fabsf(layer[i] - expected) <= rounding * expected)) {
            fail_msg("%s: group %u has %.9g where it brings %.9g", name, group, (double)layer[i],
                     (double)expected);
        }
        if (!is_own) assert_float_equal(caustics[i], 0.0f, 0.0f);
        sum += (double)caustics[i];
    }
    assert_true(sum > 0.0);
    free(combined);
    free(layer);
    free(caustics);
}

/* Red light that went to another group would be seen there. */
static void each_light_shines_in_its_own_group_only(void **state)
{
    (void)state;
    build_coloured_lights();
    for (int i = -1; i < PHOTON_METHODS; i++) {
        const render_method *method = i < 0 ? &path_method : &photon_methods[i];
        ppm_render_options options = method_options(method, 24, 8000);
        options.layers = ALL_LIGHT_LAYERS | ALL_GROUP_LAYERS;
        layered_picture picture = layered_open(test.scene, &options, 4);
        ppm_layer_info info = {.size = sizeof info};
        assert_int_equal(ppm_render_get_layer(picture.render, 10, &info), PPM_STATUS_OK);
        assert_string_equal(info.name, "light.red");
        for (uint32_t group = 0; group < 3; group++)
            check_one_colour(&picture, group, method->name);
        check_sum(&picture, PPM_LAYER_DIFFUSE_DIRECT, PPM_LAYER_VOLUME, method->name);
        layered_close(&picture);
    }
}

/* ---- classes --------------------------------------------------------------------------------- */

/* Fails unless the picture has light, and all of it is in the layers of the mask. */
static void check_only(uint64_t kinds, const char *name)
{
    for (int i = -1; i < PHOTON_METHODS; i++) {
        const render_method *method = i < 0 ? &path_method : &photon_methods[i];
        ppm_render_options options = method_options(method, 12, 8000);
        options.layers = ALL_LIGHT_LAYERS;
        layered_picture picture = layered_open(test.scene, &options, 4);
        assert_true(layered_mean(&picture, PPM_LAYER_COMBINED, 0, 1) > 0.0);
        for (int32_t kind = PPM_LAYER_DIFFUSE_DIRECT; kind <= PPM_LAYER_VOLUME; kind++) {
            const double mean = layered_mean(&picture, kind, 0, 1);
            const bool is_expected = (kinds & PPM_LAYER_BIT(kind)) != 0;
            if (is_expected != (mean > 0.0)) {
                fail_msg("%s, %s: %g in layer %d", name, method->name, mean, kind);
            }
        }
        layered_close(&picture);
    }
}

static void add_floor(float half)
{
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-half, 0, -half),
             vec3(0, 0, 2 * half), vec3(2 * half, 0, 0));
}

static void a_lamp_on_a_plain_floor_is_diffuse_and_direct(void **state)
{
    (void)state;
    add_floor(1.0f);
    light_point(test.scene, vec3(0, 1, 0), vec3(1, 1, 1));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    check_only(PPM_LAYER_BIT(PPM_LAYER_DIFFUSE_DIRECT), "floor");
}

/* One that paths can meet, and hidden from the camera. */
static void add_ball_lamp(float y)
{
    ppm_light_desc lamp = light_above(PPM_LIGHT_POINT, 0.0f, y, NULL);
    lamp.radius_m = 0.3f;
    lamp.is_hidden = 1;
    lamp.intensity[0] = lamp.intensity[1] = lamp.intensity[2] = 1.0f;
    add_light(&lamp);
}

/* The glass hides the floor from the lamp but not from the camera, which looks from the side. */
static void light_through_glass_onto_the_floor_is_a_caustic_and_nothing_else(void **state)
{
    (void)state;
    add_floor(1.0f);
    shape_place(test.scene, shape_box(test.scene, material_glass(test.scene, 1.5f, 0.0f),
                                      vec3(-3, 1.0f, -3), vec3(3, 1.2f, 3), 1, false));
    add_ball_lamp(2.0f);
    camera_orthographic(test.scene, vec3(0, 0.5f, 0), vec3(0, 0, 0), 0.3f);
    check_only(PPM_LAYER_BIT(PPM_LAYER_CAUSTICS), "glass");
}

/* Seen through the same glass, a floor that has a lamp of its own. */
static void a_floor_behind_glass_is_transmission(void **state)
{
    (void)state;
    add_floor(1.0f);
    shape_place(test.scene, shape_box(test.scene, material_glass(test.scene, 1.5f, 0.0f),
                                      vec3(-3, 1.0f, -3), vec3(3, 1.2f, 3), 1, false));
    add_ball_lamp(0.6f);
    camera_orthographic(test.scene, vec3(0.6f, 2, 0), vec3(0.6f, 0, 0), 0.2f);
    /* what the glass mirrors back onto the floor is a caustic */
    check_only(PPM_LAYER_BIT(PPM_LAYER_TRANSMISSION) | PPM_LAYER_BIT(PPM_LAYER_CAUSTICS), "behind");
}

static void a_lamp_in_a_mirror_is_glossy_and_one_seen_straight_is_emission(void **state)
{
    (void)state;
    ppm_material_desc mirror;
    ppm_material_desc_init(&mirror);
    mirror.metallic = 1.0f;
    mirror.roughness = 0.0f;
    add_quad(test.scene, material_add(test.scene, &mirror), vec3(-1, 0, -1), vec3(0, 0, 2),
             vec3(2, 0, 0));
    add_quad(test.scene, material_emitter(test.scene, 2.0f, 0.0f, false), vec3(-1, 3, -1),
             vec3(2, 0, 0), vec3(0, 0, 2));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.3f);
    check_only(PPM_LAYER_BIT(PPM_LAYER_GLOSSY_DIRECT), "mirror");
}

static void fog_that_a_lamp_lights_is_volume(void **state)
{
    (void)state;
    add_quad(test.scene, material_lambert(test.scene, 0.0f), vec3(-1, 0, -1), vec3(0, 0, 2),
             vec3(2, 0, 0));
    scene_fog(test.scene, vec3(0.2f, 0.2f, 0.2f), vec3(0, 0, 0), 0.0f);
    light_point(test.scene, vec3(0, 0.5f, 0), vec3(1, 1, 1));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    check_only(PPM_LAYER_BIT(PPM_LAYER_VOLUME), "fog");
}

/* ---- alpha ----------------------------------------------------------------------------------- */

static void check_alpha(const float *rgba, size_t first, size_t end, float expected, float off,
                        const char *name)
{
    for (size_t i = first; i < end; i++) {
        if (!(fabsf(rgba[4 * i + 3] - expected) <= off)) {
            fail_msg("%s: alpha %g of pixel %zu, expected %g", name, (double)rgba[4 * i + 3], i,
                     (double)expected);
        }
    }
}

/* The upper half of the picture is empty. */
static void what_the_camera_sees_of_the_sky_is_transparent(void **state)
{
    (void)state;
    enum { SIDE = 12, HALF = SIDE * SIDE / 2 };
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-2, -2, 0), vec3(4, 0, 0),
             vec3(0, 2, 0));
    light_environment(test.scene, vec3(1, 1, 1), 0, 0.0f);
    light_sun(test.scene, vec3(0, 0, -1), vec3(1, 1, 1), 0.3f);
    camera_orthographic(test.scene, vec3(0, 0, 1), vec3(0, 0, 0), 1.0f);
    for (int i = -1; i < PHOTON_METHODS; i++) {
        const render_method *method = i < 0 ? &path_method : &photon_methods[i];
        ppm_render_options options = method_options(method, SIDE, 2000);
        options.is_transparent = 1;
        options.layers = ALL_LIGHT_LAYERS | ALL_GROUP_LAYERS;
        layered_picture picture = layered_open(test.scene, &options, 3);
        float *rgba = layered_read(&picture, PPM_LAYER_COMBINED, 0);
        check_alpha(rgba, 0, HALF, 0.0f, 0.0f, method->name);
        check_alpha(rgba, HALF, SIDE * SIDE, 1.0f, 0.0f, method->name);
        for (size_t k = 0; k < HALF; k++)
            assert_float_equal(rgba[4 * k], 0.0f, 0.0f);
        assert_true(rgba[4 * (SIDE * SIDE - 1)] > 0.1f);
        assert_true(layered_mean(&picture, PPM_LAYER_ENVIRONMENT, 0, 1) == 0.0);
        check_sum(&picture, PPM_LAYER_DIFFUSE_DIRECT, PPM_LAYER_VOLUME, method->name);
        check_sum(&picture, PPM_LAYER_LIGHT_GROUP, PPM_LAYER_LIGHT_GROUP, method->name);
        free(rgba);
        options.is_transparent = 0;
        layered_close(&picture);
        picture = layered_open(test.scene, &options, 1);
        rgba = layered_read(&picture, PPM_LAYER_COMBINED, 0);
        check_alpha(rgba, 0, SIDE * SIDE, 1.0f, 0.0f, method->name);
        assert_true(layered_mean(&picture, PPM_LAYER_ENVIRONMENT, 0, 1) > 0.4);
        free(rgba);
        layered_close(&picture);
    }
}

static double measure_alpha(const float *rgba, const ppm_render_options *options, void *user)
{
    (void)user;
    double sum = 0.0;
    for (uint32_t i = 0; i < options->width * options->height; i++)
        sum += (double)rgba[4 * i + 3];
    return sum / (options->width * options->height);
}

/* A veil of opacity 0.3 across fog: alpha is 1 - 0.7 times the fog's transmittance over the chord
 * of its ball, whose radius is half of the diagonal of the bounds. */
static void veils_and_fog_are_as_transparent_as_they_are(void **state)
{
    (void)state;
    ppm_material_desc veil;
    ppm_material_desc_init(&veil);
    veil.base_color[3] = 0.3f;
    veil.alpha_mode = PPM_ALPHA_BLEND;
    veil.double_sided = 1;
    add_quad(test.scene, material_add(test.scene, &veil), vec3(-3, -4, 0), vec3(6, 0, 0),
             vec3(0, 8, 0));
    scene_fog(test.scene, vec3(0.05f, 0.05f, 0.05f), vec3(0.02f, 0.02f, 0.02f), 0.0f);
    light_environment(test.scene, vec3(1, 1, 1), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 20), vec3(0, 0, 0), 0.05f);
    const double expected = 1.0 - 0.7 * exp(-0.07 * 10.0);
    test_family family = {0};
    for (int i = -1; i < PHOTON_METHODS; i++) {
        const render_method *method = i < 0 ? &path_method : &photon_methods[i];
        ppm_render_options options = method_options(method, 12, 1000);
        options.is_transparent = 1;
        if (method->has_epochs || i != 4) { /* ppm without epochs has one eye pass */
            const test_mean mean = render_means(test.scene, &options, 8, 12, measure_alpha, NULL);
            mean_check_power(&mean, 0.02);
            family_add_mean(&family, &mean, expected, 2e-4, "%s", method->name);
        }
    }
    family_check(&family);
}

/* ---- estimates ------------------------------------------------------------------------------- */

/* The layer's mean against the variance of the picture's pixels from seed to seed. */
static void variance_is_that_of_the_picture(void **state)
{
    (void)state;
    enum { SIDE = 8, PIXELS = SIDE * SIDE, PASSES = 8 };
    const uint32_t seeds = TEST_EFFORT(30);
    build_coloured_lights();
    static const int32_t integrators[] = {PPM_INTEGRATOR_PATH, PPM_INTEGRATOR_SPPM};
    for (int k = 0; k < 2; k++) {
        test_mean pixels[PIXELS] = {{0}};
        double told = 0.0, diffuse_told = 0.0;
        for (uint32_t seed = 1; seed <= seeds; seed++) {
            ppm_render_options options = render_options(integrators[k], SIDE, 1000);
            options.seed = seed;
            options.layers =
                PPM_LAYER_BIT(PPM_LAYER_VARIANCE) | PPM_LAYER_BIT(PPM_LAYER_LIGHT_VARIANCE);
            layered_picture picture = layered_open(test.scene, &options, PASSES);
            float *rgba = layered_read(&picture, PPM_LAYER_COMBINED, 0);
            for (int i = 0; i < PIXELS; i++)
                mean_add(&pixels[i], (double)rgba[4 * i]);
            told += layered_mean(&picture, PPM_LAYER_VARIANCE, 0, 0) / seeds;
            for (uint32_t i = 0; i < PPM_LAYER_VOLUME; i++)
                diffuse_told += layered_mean(&picture, PPM_LAYER_LIGHT_VARIANCE, i, 0) / seeds;
            free(rgba);
            layered_close(&picture);
        }
        double is = 0.0;
        for (int i = 0; i < PIXELS; i++)
            is += pixels[i].squares / (double)(pixels[i].count - 1) / PIXELS;
        /* too large where passes are stratified, and never far too small */
        if (!(told > 0.8 * is && told < 2.5 * is)) {
            fail_msg("integrator %d: variance %g, told %g", integrators[k], is, told);
        }
        assert_true(diffuse_told > 0.3 * told && diffuse_told < 3.0 * told);
    }
}

/* On an evenly lit floor: so many photons came by area, and the radius is what was asked for. */
static void photon_density_and_radius_are_those_of_the_gathering(void **state)
{
    (void)state;
    add_floor(1.0f);
    light_directional(test.scene, vec3(0, -1, 0), vec3(1, 1, 1));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.3f);
    ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, 8, 20000);
    options.direct = PPM_DIRECT_PHOTONS;
    options.aim = PPM_AIM_EVEN;
    options.radius_m = 0.1f;
    options.layers = PPM_LAYER_BIT(PPM_LAYER_PHOTON_DENSITY) | PPM_LAYER_BIT(PPM_LAYER_RADIUS);
    for (int32_t integrator = PPM_INTEGRATOR_SPPM; integrator <= PPM_INTEGRATOR_PPM; integrator++) {
        options.integrator = integrator;
        layered_picture picture = layered_open(test.scene, &options, 1);
        const double density = layered_mean(&picture, PPM_LAYER_PHOTON_DENSITY, 0, 0);
        const double radius = layered_mean(&picture, PPM_LAYER_RADIUS, 0, 0);
        if (integrator == PPM_INTEGRATOR_PATH) {
            assert_true(density == 0.0 && radius == 0.0);
        } else {
            /* parallel light over the floor's 4 m2 */
            assert_true(fabs(density - 5000.0) < 0.05 * 5000.0);
            assert_true(fabs(radius - 0.1) < 1e-6);
        }
        layered_close(&picture);
    }
}

/* ---- sessions -------------------------------------------------------------------------------- */

static float *read_all(const layered_picture *picture, size_t *out_floats)
{
    const uint32_t count = ppm_render_layer_count(picture->render);
    float *all = calloc(4 * picture->pixels * count, sizeof *all);
    assert_non_null(all);
    for (uint32_t i = 0; i < count; i++) {
        ppm_layer_info info = {.size = sizeof info};
        assert_int_equal(ppm_render_get_layer(picture->render, i, &info), PPM_STATUS_OK);
        assert_int_equal(ppm_render_read_layer(picture->render, i, all + 4 * picture->pixels * i,
                                               info.channel_count * picture->pixels),
                         PPM_STATUS_OK);
    }
    *out_floats = 4 * picture->pixels * count;
    return all;
}

static ppm_render_options options_of_all_layers(const render_method *method)
{
    ppm_render_options options = method_options(method, 36, 4000);
    options.layers = ALL_LIGHT_LAYERS | ALL_GROUP_LAYERS | PPM_LAYER_BIT(PPM_LAYER_VARIANCE) |
                     PPM_LAYER_BIT(PPM_LAYER_PHOTON_DENSITY) | PPM_LAYER_BIT(PPM_LAYER_RADIUS) |
                     PPM_LAYER_BIT(PPM_LAYER_LIGHT_VARIANCE);
    options.is_transparent = 1;
    return options;
}

static void layers_are_the_same_with_any_number_of_threads(void **state)
{
    (void)state;
    build_coloured_lights();
    for (int i = -1; i < PHOTON_METHODS; i++) {
        ppm_render_options options =
            options_of_all_layers(i < 0 ? &path_method : &photon_methods[i]);
        size_t floats;
        layered_picture one = layered_open(test.scene, &options, 3);
        float *of_one = read_all(&one, &floats);
        layered_close(&one);
        options.threads = 3;
        layered_picture three = layered_open(test.scene, &options, 3);
        float *of_three = read_all(&three, &floats);
        assert_memory_equal(of_one, of_three, floats * sizeof *of_one);
        layered_close(&three);
        free(of_one);
        free(of_three);
    }
}

static void check_unchanged(const layered_picture *picture, const float *before, size_t floats)
{
    float *now = read_all(picture, &floats);
    assert_memory_equal(before, now, floats * sizeof *now);
    free(now);
}

/* By a lack of memory somewhere on its way, and cancelled. */
static void a_pass_that_does_not_finish_leaves_the_layers(void **state)
{
    (void)state;
    build_coloured_lights();
    for (int i = -1; i < PHOTON_METHODS; i++) {
        const ppm_render_options options =
            options_of_all_layers(i < 0 ? &path_method : &photon_methods[i]);
        layered_picture picture = layered_open(test.scene, &options, 2);
        size_t floats;
        float *before = read_all(&picture, &floats);
        ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
        for (size_t n = 1; status != PPM_STATUS_OK; n++) {
            ppmi_alloc_fail_at(test.context, n);
            status = ppm_render_advance(picture.render);
            ppmi_alloc_fail_at(test.context, 0);
            if (status != PPM_STATUS_OK) check_unchanged(&picture, before, floats);
        }
        free(before);
        before = read_all(&picture, &floats);
        ppm_render_cancel(picture.render);
        assert_int_equal(ppm_render_advance(picture.render), PPM_STATUS_CANCELLED);
        check_unchanged(&picture, before, floats);
        layered_close(&picture);
        free(before);
    }
}

static void memory_that_is_out_is_told(void **state)
{
    (void)state;
    build_coloured_lights();
    const ppm_render_options options = options_of_all_layers(&photon_methods[5]);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    for (size_t n = 1; status != PPM_STATUS_OK; n++) {
        ppm_render *render = NULL;
        ppmi_alloc_fail_at(test.context, n);
        status = ppm_render_create(test.scene, &options, &render);
        ppmi_alloc_fail_at(test.context, 0);
        if (status != PPM_STATUS_OK) assert_int_equal(status, PPM_STATUS_OUT_OF_MEMORY);
        ppm_render_destroy(render);
    }
}

static void layers_that_there_are_not_are_refused(void **state)
{
    (void)state;
    add_floor(1.0f);
    light_point(test.scene, vec3(0, 1, 0), vec3(1, 1, 1));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    ppm_render *render = NULL;
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 4, 100);
    options.layers = PPM_LAYER_BIT(PPM_LAYER_KINDS);
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_INVALID_ARGUMENT);
    options.layers = PPM_LAYER_BIT(PPM_LAYER_CAUSTICS);
    options.light_groups = 3;
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_INVALID_ARGUMENT);
    options.light_groups = PPM_LIGHT_GROUPS_GIVEN;
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    float values[3 * 16];
    assert_int_equal(ppm_render_read_layer(render, 1, values, 3 * 16), PPM_STATUS_WRONG_STATE);
    assert_int_equal(ppm_render_read_layer(render, 1, values, 16), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_render_read_layer(render, 2, values, 3 * 16), PPM_STATUS_INVALID_ARGUMENT);
    ppm_render_destroy(render);
}

#define WITH_SCENE(test) cmocka_unit_test_setup_teardown(test, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_SCENE(layers_that_there_are_not_are_refused),
        WITH_SCENE(memory_that_is_out_is_told),
        cmocka_unit_test(layers_and_groups_add_up_to_the_picture_which_stays_the_same),
        WITH_SCENE(each_light_shines_in_its_own_group_only),
        WITH_SCENE(a_lamp_on_a_plain_floor_is_diffuse_and_direct),
        WITH_SCENE(light_through_glass_onto_the_floor_is_a_caustic_and_nothing_else),
        WITH_SCENE(a_floor_behind_glass_is_transmission),
        WITH_SCENE(a_lamp_in_a_mirror_is_glossy_and_one_seen_straight_is_emission),
        WITH_SCENE(fog_that_a_lamp_lights_is_volume),
        WITH_SCENE(what_the_camera_sees_of_the_sky_is_transparent),
        WITH_SCENE(veils_and_fog_are_as_transparent_as_they_are),
        WITH_SCENE(variance_is_that_of_the_picture),
        WITH_SCENE(photon_density_and_radius_are_those_of_the_gathering),
        WITH_SCENE(layers_are_the_same_with_any_number_of_threads),
        WITH_SCENE(a_pass_that_does_not_finish_leaves_the_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
