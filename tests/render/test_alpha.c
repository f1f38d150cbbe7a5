/* What is not quite there: masks, blends, single-sided walls. */
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

static void compare(const char *name, double expected, double resolution)
{
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        ppm_render_options options = render_options(i, 16, 2000);
        options.radius_m = 0.1f;
        const test_mean mean = render_green(test.scene, &options, 16, SEEDS);
        if (expected > 0.0) mean_check_power(&mean, resolution);
        family_add_mean(&family, &mean, expected, 1e-5 * expected, "%s, integrator %d", name, i);
    }
}

/* A level quad that faces up, around the y axis. */
static void add_level(const ppm_material_desc *desc, float y, float half)
{
    add_quad(test.scene, material_add(test.scene, desc), vec3(-half, y, -half),
             vec3(0, 0, 2 * half), vec3(2 * half, 0, 0));
}

/* A black sheet, transparent by its alpha. */
static ppm_material_desc veil(int32_t mode, float alpha)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.base_color[0] = desc.base_color[1] = desc.base_color[2] = 0.0f;
    desc.base_color[3] = alpha;
    desc.specular = 0.0f;
    desc.alpha_mode = mode;
    return desc;
}

static ppm_material_desc lambert(float reflectance)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.base_color[0] = desc.base_color[1] = desc.base_color[2] = reflectance;
    desc.specular = 0.0f;
    return desc;
}

static void shadows_of_veils_let_their_share_through(void **state)
{
    (void)state;
    const struct {
        int32_t mode;
        float alpha;
        double through;
    } cases[] = {{PPM_ALPHA_BLEND, 0.3f, 0.7},
                 {PPM_ALPHA_MASK, 0.4f, 1.0},
                 {PPM_ALPHA_MASK, 0.6f, 0.0},
                 {PPM_ALPHA_OPAQUE, 0.3f, 0.0}};
    for (int i = 0; i < 4; i++) {
        scene_close(&test);
        scene_open(&test);
        const ppm_material_desc floor = lambert(0.5f), sheet = veil(cases[i].mode, cases[i].alpha);
        add_level(&floor, 0.0f, 2.0f);
        add_level(&sheet, 1.0f, 3.0f);
        light_directional(test.scene, vec3(0, -1, 0), vec3_splat(2.0f));
        camera_orthographic(test.scene, vec3(0, 0.5f, 0), vec3(0, 0, 0), 0.5f);
        compare("shadow", 2.0 * 0.5 / M_PI * cases[i].through, 0.01);
    }
    family_check(&family);
}

/* Photons meet the veil by chance, light samples by its share: two sheets of a half. */
static void light_that_bounced_goes_through_veils_too(void **state)
{
    (void)state;
    const ppm_material_desc sheet = veil(PPM_ALPHA_BLEND, 0.5f);
    add_level(&sheet, 1.0f, 5.0f);
    add_level(&sheet, 1.1f, 5.0f);
    ppm_material_desc lamp = lambert(0.0f);
    vec3_store(lamp.emission, vec3_splat(4.0f));
    add_level(&lamp, 0.0f, 5.0f);
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    compare("through two sheets", 1.0, 0.02);
    family_check(&family);
}

/* Its emission is covered as it is: seen directly and by what it lights. */
static void a_lamp_of_part_opacity_shines_in_part(void **state)
{
    (void)state;
    ppm_material_desc lamp = veil(PPM_ALPHA_BLEND, 0.25f);
    vec3_store(lamp.emission, vec3_splat(4.0f));
    const ppm_material_desc floor = lambert(0.5f);
    add_level(&lamp, 1.0f, 50.0f);
    add_level(&floor, 0.0f, 1.0f);
    camera_orthographic(test.scene, vec3(0, 0.5f, 0), vec3(0, 0, 0), 0.5f);
    /* of the sky, by cosine, the lamp leaves uncovered less than 1 / 50^2 */
    compare("lit by the lamp", 0.5 * (1.0 - 1.0 / 2500.0), 0.02);
    family_check(&family);
}

/* Only the camera looks through the backs of single-sided walls: light does not. */
static void walls_are_seen_through_from_behind_but_let_no_light_in(void **state)
{
    (void)state;
    ppm_material_desc wall = lambert(0.5f), inside = lambert(0.0f);
    wall.double_sided = 0;
    vec3_store(inside.emission, vec3_splat(3.0f));
    add_level(&inside, 0.0f, 1.0f);
    /* faces down, so that the camera above it sees its back */
    add_quad(test.scene, material_add(test.scene, &wall), vec3(-1, 1, -1), vec3(2, 0, 0),
             vec3(0, 0, 2));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    compare("through the ceiling", 3.0, 0.001);
    family_check(&family);
    scene_close(&test);
    scene_open(&test);
    const ppm_material_desc floor = lambert(0.5f);
    add_level(&floor, 0.0f, 1.0f);
    add_quad(test.scene, material_add(test.scene, &wall), vec3(-2, 1, -2), vec3(4, 0, 0),
             vec3(0, 0, 4));
    light_directional(test.scene, vec3(0, -1, 0), vec3_splat(2.0f));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    compare("its shadow", 0.0, 0.0);
    family_check(&family);
}

static void an_opaque_back_is_seen(void **state)
{
    (void)state;
    ppm_material_desc wall = lambert(0.5f);
    wall.double_sided = 1;
    add_quad(test.scene, material_add(test.scene, &wall), vec3(-1, 1, -1), vec3(2, 0, 0),
             vec3(0, 0, 2));
    light_directional(test.scene, vec3(0, -1, 0), vec3_splat(2.0f));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    compare("back", 2.0 * 0.5 / M_PI, 0.001);
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(shadows_of_veils_let_their_share_through),
        WITH_SCENE(light_that_bounced_goes_through_veils_too),
        WITH_SCENE(a_lamp_of_part_opacity_shines_in_part),
        WITH_SCENE(walls_are_seen_through_from_behind_but_let_no_light_in),
        WITH_SCENE(an_opaque_back_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
