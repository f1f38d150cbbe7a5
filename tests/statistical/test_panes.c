/* Thin sheets do not bend light: shadow rays pass them, and what comes through them is counted once
 * by every integrator, as light sampling, as paths that go on, and as photons. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "statistical/methods.h"
#include "support/light_layers.h"
#include "support/near.h"
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

/* A tinted pane of index 1.5; opaque: share of a grey base in it. */
static ppm_material_id pane_material(ppmi_vec3 tint, float opaque)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.metallic = 0.0f;
    desc.roughness = 0.0f;
    desc.transmission = 1.0f - opaque;
    desc.transmission_kind = PPM_TRANSMISSION_THIN;
    desc.double_sided = 1;
    vec3_store(desc.base_color, tint);
    return material_add(test.scene, &desc);
}

/* What one goes through, at a cosine: both faces, with all reflections between them. */
static double pane_passing(double cosine)
{
    const double index = 1.5, cos_t = sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const double s = (cosine - index * cos_t) / (cosine + index * cos_t);
    const double p = (index * cosine - cos_t) / (index * cosine + cos_t);
    const double face = 0.5 * (s * s + p * p);
    return 1.0 - 2.0 * face / (1.0 + face);
}

/* A floor, a row of panes above it, and a camera between the two. */
static void add_panes(uint32_t count, float opaque)
{
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-20, 0, -20), vec3(0, 0, 40),
             vec3(40, 0, 0));
    const ppm_material_id pane = pane_material(vec3(0.9f, 0.6f, 0.3f), opaque);
    for (uint32_t i = 0; i < count; i++) {
        add_quad(test.scene, pane, vec3(-20, 1.0f + 0.1f * (float)i, -20), vec3(0, 0, 40),
                 vec3(40, 0, 0));
    }
    camera_orthographic(test.scene, vec3(0, 0.5f, 0), vec3(0, 0, 0), 0.001f);
}

/* Nothing is left to chance: one pass of each method takes one sample of a lamp without size. What
 * panes send back to the floor is not in the layer of direct light. */
static void check_direct(uint32_t panes, double irradiance, double cosine)
{
    const double tint[3] = {0.9, 0.6, 0.3};
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        ppm_render_options options = render_options(i, 4, 100);
        options.layers = ALL_LIGHT_LAYERS;
        layered_picture picture = layered_open(test.scene, &options, 1);
        for (uint32_t k = 0; k < 3; k++) {
            const double passing = pow(tint[k] * pane_passing(cosine), panes);
            const double expected = irradiance * passing * 0.5 / M_PI;
            assert_near(layered_mean(&picture, PPM_LAYER_DIFFUSE_DIRECT, 0, k), expected,
                        2e-4 * expected);
        }
        layered_close(&picture);
    }
}

static void a_point_lamp_behind_panes_is_sampled_exactly(void **state)
{
    for (uint32_t panes = 1; panes <= 3; panes += 2) {
        if (panes > 1) {
            close_scene(state);
            open_scene(state);
        }
        add_panes(panes, 0.0f);
        light_point(test.scene, vec3(2, 2, 0), vec3_splat(8.0f));
        check_direct(panes, 8.0 * 2.0 / pow(8.0, 1.5), sqrt(0.5));
    }
}

static void a_sun_behind_panes_is_sampled_exactly(void **state)
{
    (void)state;
    add_panes(3, 0.0f);
    light_directional(test.scene, vec3(3, -4, 0), vec3_splat(10.0f));
    check_direct(3, 10.0 * 0.8, 0.8);
}

/* ---- a room ---------------------------------------------------------------------------------- */

/* Closed but for its ceiling, which is count panes that are partly opaque; one wall is a metal of
 * some roughness, whose lobe may be narrow. The camera looks in through the panes from above, and
 * sees lamps' light on both sides. */
static void add_room(uint32_t count, float roughness, bool is_outside)
{
    const ppm_material_id wall = material_lambert(test.scene, 0.5f);
    const ppm_material_id pane = pane_material(vec3(0.9f, 0.7f, 0.5f), 0.2f);
    ppm_material_desc glossy;
    ppm_material_desc_init(&glossy);
    glossy.metallic = 1.0f;
    glossy.roughness = roughness;
    add_quad(test.scene, wall, vec3(-1, 0, -1), vec3(0, 0, 2), vec3(2, 0, 0));
    add_quad(test.scene, wall, vec3(-1, 0, -1), vec3(0, 1, 0), vec3(0, 0, 2));
    add_quad(test.scene, wall, vec3(1, 0, -1), vec3(0, 0, 2), vec3(0, 1, 0));
    add_quad(test.scene, wall, vec3(-1, 0, 1), vec3(0, 1, 0), vec3(2, 0, 0));
    add_quad(test.scene, material_add(test.scene, &glossy), vec3(-1, 0, -1), vec3(2, 0, 0),
             vec3(0, 1, 0));
    for (uint32_t i = 0; i < count; i++) {
        add_quad(test.scene, pane, vec3(-1, 1.0f + 0.05f * (float)i, -1), vec3(0, 0, 2),
                 vec3(2, 0, 0));
    }
    if (is_outside) {
        camera_perspective(test.scene, vec3(0.3f, 2.5f, 1.5f), vec3(0, 0.4f, -0.3f), 0.6f);
    } else {
        camera_perspective(test.scene, vec3(0.3f, 0.8f, 0.8f), vec3(0, 0.2f, -0.6f), 0.9f);
    }
}

static const method_comparison how = {.width = 12,
                                      .path_passes = TEST_EFFORT(1000),
                                      .passes = 16,
                                      .photons = TEST_EFFORT(8000),
                                      .radius_m = 0.1f,
                                      .bias = 0.012,
                                      .resolution = 0.03,
                                      .seeds = TEST_EFFORT(8) + 2,
                                      .left_out = METHODS_OF_OTHER_RADII};

static void methods_agree_under_lamps_of_all_kinds_behind_a_pane(void **state)
{
    (void)state;
    add_room(1, 0.6f, false);
    light_environment(test.scene, vec3(0.3f, 0.4f, 0.6f), 0, 0.0f);
    light_sun(test.scene, vec3(0.3f, -1, -0.2f), vec3_splat(2.0f), 0.1f);
    light_point(test.scene, vec3(-0.4f, 1.8f, 0.3f), vec3_splat(1.0f));
    add_quad(test.scene, material_emitter(test.scene, 4.0f, 0.3f, false), vec3(-0.9f, 1.5f, -0.9f),
             vec3(0.5f, 0, 0), vec3(0, 0, 0.5f));
    methods_agree(test.scene, &how);
}

static void methods_agree_behind_three_panes(void **state)
{
    (void)state;
    add_room(3, 0.35f, true);
    light_environment(test.scene, vec3(0.3f, 0.4f, 0.6f), 0, 0.0f);
    light_directional(test.scene, vec3(0.3f, -1, -0.2f), vec3_splat(3.0f));
    methods_agree(test.scene, &how);
}

/* ---- a furnace ------------------------------------------------------------------------------- */

/* Clear panes in even light neither add nor take anything. */
static void panes_in_even_light_are_not_seen(void **state)
{
    (void)state;
    const ppm_material_id clear = pane_material(vec3_splat(1.0f), 0.0f);
    for (int i = 0; i < 3; i++) {
        add_quad(test.scene, clear, vec3(-1, 0.3f + 0.3f * (float)i, -1), vec3(0, 0, 2),
                 vec3(2, 0, 0));
    }
    add_quad(test.scene, material_lambert(test.scene, 1.0f), vec3(-1, 0, -1), vec3(0, 0, 2),
             vec3(2, 0, 0));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_perspective(test.scene, vec3(0.3f, 2.5f, 1.5f), vec3(0, 0, 0), 0.3f);
    test_family family = {0};
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        ppm_render_options options = render_options(i, 8, 4000);
        options.radius_m = 0.1f;
        const test_mean mean = render_green(test.scene, &options, 16, 8);
        mean_check_power(&mean, 0.01);
        family_add_mean(&family, &mean, 1.0, 0.002, "integrator %d", i);
    }
    family_check(&family);
}

#define WITH_SCENE(test) cmocka_unit_test_setup_teardown(test, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_point_lamp_behind_panes_is_sampled_exactly),
        WITH_SCENE(a_sun_behind_panes_is_sampled_exactly),
        WITH_SCENE(methods_agree_under_lamps_of_all_kinds_behind_a_pane),
        WITH_SCENE(methods_agree_behind_three_panes),
        WITH_SCENE(panes_in_even_light_are_not_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
