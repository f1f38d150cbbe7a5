/* What a layer of light holds does not depend on the integrator: photons and paths find the same
 * classes and groups of light, quarter by quarter of the picture. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

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

enum { SIDE = 16, QUARTERS = 4, MAX_LAYERS = 24 };

/* Of green, layer by layer, in the quarters of the picture. */
typedef struct layer_means {
    test_mean of[MAX_LAYERS][QUARTERS];
    int32_t kinds[MAX_LAYERS];
    uint32_t count;
} layer_means;

static void add_quarters(const float *values, uint32_t channels, test_mean means[QUARTERS])
{
    double sums[QUARTERS] = {0};
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint32_t quarter = (i % SIDE >= SIDE / 2) + 2 * (i / SIDE >= SIDE / 2);
        sums[quarter] += (double)values[channels * i + 1];
    }
    for (int i = 0; i < QUARTERS; i++)
        mean_add(&means[i], sums[i] * QUARTERS / (SIDE * SIDE));
}

static void add_session(const ppm_render_options *options, uint32_t passes, layer_means *means)
{
    layered_picture picture = layered_open(test.scene, options, passes);
    means->count = ppm_render_layer_count(picture.render);
    assert_true(means->count <= MAX_LAYERS);
    for (uint32_t i = 0; i < means->count; i++) {
        float values[4 * SIDE * SIDE];
        ppm_layer_info info = {.size = sizeof info};
        assert_int_equal(ppm_render_get_layer(picture.render, i, &info), PPM_STATUS_OK);
        const size_t count = info.channel_count * picture.pixels;
        assert_int_equal(ppm_render_read_layer(picture.render, i, values, count), PPM_STATUS_OK);
        add_quarters(values, info.channel_count, means->of[i]);
        means->kinds[i] = info.kind;
    }
    layered_close(&picture);
}

static layer_means means_of(const render_method *method, uint32_t passes, uint64_t photons,
                            float radius_m, uint32_t seeds)
{
    layer_means means = {0};
    ppm_render_options options = method_options(method, SIDE, photons);
    options.radius_m = radius_m;
    options.alpha = 1.0f;
    options.layers = ALL_LIGHT_LAYERS | ALL_GROUP_LAYERS;
    options.light_groups = PPM_LIGHT_GROUPS_NAMED;
    for (options.seed = 1; options.seed <= (seeds < 5 ? 5 : seeds); options.seed++)
        add_session(&options, passes, &means);
    return means;
}

/* bias: of density estimation, relative to what is in the layer; edges of shadows and caustics
 * that are blurred across quarters count as a share of the picture. */
static void compare(const layer_means *paths, const layer_means *photons, double bias,
                    const char *name, test_family *family)
{
    const double edges = 2e-3;
    assert_int_equal(paths->count, photons->count);
    for (uint32_t i = 0; i < paths->count; i++) {
        for (int k = 0; k < QUARTERS; k++) {
            const test_mean *a = &paths->of[i][k], *b = &photons->of[i][k];
            const double error = hypot(mean_error(a), mean_error(b));
            const double systematic = bias * a->mean + edges * paths->of[0][k].mean;
            const double off = fmax(0.0, fabs(a->mean - b->mean) - systematic);
            if (off == 0.0) continue;
            family_add(family, error > 0.0 ? p_student(off / error, (double)a->count - 1.0) : 0.0,
                       "%s, layer %u of kind %d, quarter %d: paths %.5g, photons %.5g, error %.2g",
                       name, i, paths->kinds[i], k, a->mean, b->mean, error);
        }
    }
}

static void layers_agree(const char *name, float radius_m, double bias)
{
    static const int which[] = {0, 2, 5}; /* of photon_methods */
    const uint32_t seeds = TEST_EFFORT(8);
    const layer_means paths = means_of(&path_method, TEST_EFFORT(300), 0, 0.0f, seeds);
    test_family family = {0};
    for (size_t i = 0; i < sizeof which / sizeof which[0]; i++) {
        const render_method *method = &photon_methods[which[i]];
        const layer_means photons = means_of(method, 8, TEST_EFFORT(20000), radius_m, seeds);
        char label[128];
        snprintf(label, sizeof label, "%s, %s", name, method->name);
        compare(&paths, &photons, bias, label, &family);
    }
    mean_check_power(&paths.of[PPM_LAYER_DIFFUSE_DIRECT][2], 0.02);
    mean_check_power(&paths.of[PPM_LAYER_CAUSTICS][2], 0.12); /* small lamps are seldom met */
    family_check(&family);
}

static void layers_of_the_caustic_box_agree(void **state)
{
    (void)state;
    const char *path = PPM_SOURCE_DIR "/sample_scenes/caustic_box.glb";
    assert_int_equal(ppm_scene_import(test.scene, path, NULL), PPM_STATUS_OK);
    layers_agree("caustic box", 0.03f, 0.02);
}

static ppm_material_id material_plastic(float roughness, float metallic, float clearcoat)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.base_color[0] = desc.base_color[1] = desc.base_color[2] = 0.6f;
    desc.roughness = roughness;
    desc.metallic = metallic;
    desc.clearcoat = clearcoat;
    desc.clearcoat_roughness = 0.2f;
    return material_add(test.scene, &desc);
}

static void add_ball(ppm_material_id material, ppmi_vec3 position, float radius)
{
    shape_place_at(test.scene, shape_sphere(test.scene, material, radius, 12, true), position);
}

/* Fog; plastics and metals whose highlights are wide and narrow, glass smooth and rough, under two
 * lamps. */
static void layers_of_mixed_materials_in_fog_agree(void **state)
{
    (void)state;
    ppm_scene *scene = test.scene;
    add_quad(scene, material_plastic(0.4f, 0.0f, 0.0f), vec3(-2, 0, -2), vec3(0, 0, 4),
             vec3(4, 0, 0));
    add_quad(scene, material_plastic(0.6f, 0.0f, 0.5f), vec3(-2, 0, -2), vec3(4, 0, 0),
             vec3(0, 2, 0));
    add_ball(material_glass(scene, 1.5f, 0.0f), vec3(-0.8f, 0.6f, 0.3f), 0.45f);
    add_ball(material_glass(scene, 1.5f, 0.35f), vec3(0.0f, 0.4f, 0.8f), 0.3f);
    add_ball(material_plastic(0.35f, 1.0f, 0.0f), vec3(0.8f, 0.5f, 0.2f), 0.45f);
    scene_fog(scene, vec3(0.1f, 0.1f, 0.1f), vec3(0, 0, 0), 0.3f);
    ppm_light_desc lamp = {.size = sizeof lamp,
                           .name = "ball",
                           .kind = PPM_LIGHT_POINT,
                           .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 2.2f, 0.5f, 1},
                           .intensity = {4, 4, 4},
                           .radius_m = 0.4f};
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(scene, &lamp, &id), PPM_STATUS_OK);
    light_environment(scene, vec3(0.3f, 0.3f, 0.3f), 0, 0.0f);
    camera_perspective(scene, vec3(0, 1.4f, 3.2f), vec3(0, 0.5f, 0), 0.8f);
    layers_agree("mixed materials", 0.08f, 0.02);
}

/* A tinted pane that is a fifth opaque. */
static ppm_material_id material_pane(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.base_color[0] = desc.base_color[1] = 0.8f;
    desc.metallic = desc.roughness = 0.0f;
    desc.transmission = 0.8f;
    desc.transmission_kind = PPM_TRANSMISSION_THIN;
    return material_add(test.scene, &desc);
}

/* What comes straight through panes is direct; what they reflect, and what then meets glass, is
 * not. One pane is in the way of the camera, two are in that of the lamps. */
static void layers_behind_panes_agree(void **state)
{
    (void)state;
    ppm_scene *scene = test.scene;
    const ppm_material_id pane = material_pane();
    add_quad(scene, material_plastic(0.4f, 0.0f, 0.0f), vec3(-2, 0, -2), vec3(0, 0, 4),
             vec3(4, 0, 0));
    add_quad(scene, material_plastic(0.35f, 1.0f, 0.0f), vec3(-2, 0, -2), vec3(4, 0, 0),
             vec3(0, 2, 0));
    add_ball(material_glass(scene, 1.5f, 0.0f), vec3(-0.6f, 0.5f, 0.2f), 0.4f);
    add_quad(scene, pane, vec3(-2, 1.3f, -2), vec3(0, 0, 4), vec3(4, 0.2f, 0));
    add_quad(scene, pane, vec3(-2, 1.5f, -2), vec3(0, 0, 4), vec3(4, 0, 0));
    add_quad(scene, pane, vec3(-0.2f, -0.1f, 1.2f), vec3(1.5f, 0, 0), vec3(0, 1.2f, 0.2f));
    ppm_light_desc lamp = {.size = sizeof lamp,
                           .name = "ball",
                           .kind = PPM_LIGHT_POINT,
                           .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 2.4f, 0.5f, 1},
                           .intensity = {6, 6, 6},
                           .radius_m = 0.4f};
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(scene, &lamp, &id), PPM_STATUS_OK);
    light_environment(scene, vec3(0.3f, 0.3f, 0.3f), 0, 0.0f);
    camera_perspective(scene, vec3(0, 1.0f, 3.2f), vec3(0, 0.4f, 0), 0.8f);
    layers_agree("panes", 0.08f, 0.02);
}

/* Twice the light of a lamp is twice its layer. */
static void a_group_twice_as_bright_is_its_layer_twice(void **state)
{
    (void)state;
    ppm_light_id lamps[2];
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-1, 0, -1), vec3(0, 0, 2),
             vec3(2, 0, 0));
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-1, 0, -1), vec3(2, 0, 0),
             vec3(0, 2, 0));
    ppm_light_desc lamp = {.size = sizeof lamp,
                           .name = "lamp",
                           .kind = PPM_LIGHT_POINT,
                           .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5f, 1, 0, 1},
                           .intensity = {1, 1, 1}};
    assert_int_equal(ppm_scene_add_light(test.scene, &lamp, &lamps[0]), PPM_STATUS_OK);
    lamp.transform[12] = 0.5f;
    assert_int_equal(ppm_scene_add_light(test.scene, &lamp, &lamps[1]), PPM_STATUS_OK);
    camera_perspective(test.scene, vec3(0, 1, 3), vec3(0, 0.5f, 0), 0.6f);
    const layer_means before = means_of(&photon_methods[0], 8, 20000, 0.05f, TEST_EFFORT(8));
    lamp.intensity[0] = lamp.intensity[1] = lamp.intensity[2] = 2.0f;
    assert_int_equal(ppm_scene_set_light(test.scene, lamps[1], &lamp), PPM_STATUS_OK);
    const layer_means after = means_of(&photon_methods[0], 8, 20000, 0.05f, TEST_EFFORT(8));
    test_family family = {0};
    for (uint32_t group = 0; group < 2; group++) {
        const uint32_t layer = PPM_LAYER_LIGHT_GROUP + group;
        assert_int_equal(before.kinds[layer], PPM_LAYER_LIGHT_GROUP);
        for (int k = 0; k < QUARTERS; k++) {
            const test_mean *a = &before.of[layer][k], *b = &after.of[layer][k];
            const double factor = group == 0 ? 1.0 : 2.0;
            const double error = hypot(factor * mean_error(a), mean_error(b));
            mean_check_power(a, 0.02);
            family_add(
                &family, p_student((factor * a->mean - b->mean) / error, (double)a->count - 1.0),
                "group %u, quarter %d: %g times %.5g, %.5g", group, k, factor, a->mean, b->mean);
        }
    }
    family_check(&family);
}

#define WITH_SCENE(test) cmocka_unit_test_setup_teardown(test, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_SCENE(layers_of_the_caustic_box_agree),
        WITH_SCENE(layers_of_mixed_materials_in_fog_agree),
        WITH_SCENE(layers_behind_panes_agree),
        WITH_SCENE(a_group_twice_as_bright_is_its_layer_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
