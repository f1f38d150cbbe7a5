/* All integrators agree on materials with layers, and a white world stays white. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "statistical/methods.h"
#include "support/scenes.h"

static test_scene test;

/* Balls in boxes are cut flat: a photon along a facet whose normals are bent away from it counts up
 * to a hundred times, and one such photon is a picture's noise. */
static bool is_smooth;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    is_smooth = false;
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static void place(const ppm_material_desc *desc, float radius, float x, float y, float z)
{
    ppm_scene *scene = test.scene;
    shape_place_at(scene, shape_sphere(scene, material_add(scene, desc), radius, 24, is_smooth),
                   vec3(x, y, z));
}

/* As for the box of plastic and metal (test_methods_agree.c): 1 % from edges; diffusely lit balls
 * have none. */
static const method_comparison how = {.width = 60,
                                      .path_passes = 16,
                                      .passes = 8,
                                      .photons = 6000,
                                      .radius_m = 0.02f,
                                      .bias = 0.01,
                                      .resolution = 0.05,
                                      .seeds = 5,
                                      .left_out = METHODS_OF_OTHER_RADII};

/* Ceramic, velvet under varnish, a film on plastic, brushed metal, a retroreflector. */
static void a_box_of_layered_things(void **state)
{
    (void)state;
    add_lit_box(test.scene, vec3(0.6f, 0.5f, 0.4f), vec3(0, -0.1f, -1));
    ppm_material_desc ceramic = material_desc_rgb(vec3(0.7f, 0.2f, 0.1f), 0.0f, 0.5f);
    ceramic.clearcoat = 1.0f;
    place(&ceramic, 0.3f, -0.5f, -0.7f, -0.2f);
    ppm_material_desc velvet = material_desc_rgb(vec3(0.2f, 0.1f, 0.4f), 0.0f, 0.8f);
    for (int i = 0; i < 3; i++)
        velvet.sheen_color[i] = 0.8f;
    velvet.sheen_roughness = 0.5f;
    velvet.clearcoat = 0.5f;
    velvet.clearcoat_roughness = 0.6f;
    place(&velvet, 0.3f, 0.4f, -0.7f, -0.3f);
    ppm_material_desc film = material_desc_rgb(vec3(0.1f, 0.1f, 0.1f), 0.0f, 0.5f);
    film.iridescence = 1.0f;
    film.iridescence_ior = 1.8f;
    place(&film, 0.25f, -0.5f, 0.2f, -0.4f);
    ppm_material_desc reflector = material_desc_rgb(vec3(0.9f, 0.8f, 0.7f), 1.0f, 0.6f);
    reflector.retroreflection = 0.7f;
    place(&reflector, 0.25f, 0.5f, 0.2f, -0.4f);
    ppm_material_desc brushed = material_desc_rgb(vec3(0.8f, 0.8f, 0.9f), 1.0f, 0.6f);
    brushed.anisotropy = 0.8f;
    add_quad(test.scene, material_add(test.scene, &brushed), vec3(-0.9f, -0.95f, -0.95f),
             vec3(1.8f, 0, 0), vec3(0, 1.8f, 0.1f));
    methods_agree(test.scene, &how);
}

/* A sheet that hangs between the lamp and the camera: what is seen of it has come through. */
static void a_leaf_before_the_lamp(void **state)
{
    (void)state;
    add_lit_box(test.scene, vec3(0.6f, 0.5f, 0.4f), vec3(0, -0.1f, -1));
    ppm_material_desc leaf = material_desc_rgb(vec3(0.3f, 0.6f, 0.2f), 0.0f, 0.6f);
    leaf.diffuse_transmission = 0.6f;
    leaf.diffuse_transmission_color[0] = 0.5f;
    add_quad(test.scene, material_add(test.scene, &leaf), vec3(-0.7f, -0.5f, -0.6f),
             vec3(1.4f, 0, 0), vec3(0, 1.2f, 0.7f));
    methods_agree(test.scene, &how);
}

/* Light goes in diffusely, is scattered inside, and comes out diffusely. */
static void a_ball_of_wax(void **state)
{
    (void)state;
    add_lit_box(test.scene, vec3(0.6f, 0.5f, 0.4f), vec3(0, -0.1f, -1));
    ppm_material_desc wax = material_desc_rgb(vec3(0.8f, 0.7f, 0.6f), 0.0f, 0.5f);
    wax.diffuse_transmission = 0.8f;
    wax.attenuation_distance_m = 0.3f;
    for (int i = 0; i < 3; i++) {
        wax.attenuation_color[i] = 0.5f;
        wax.multiscatter_color[i] = 0.3f + 0.2f * (float)i;
    }
    wax.scatter_anisotropy_g = 0.3f;
    place(&wax, 0.5f, 0.0f, -0.3f, -0.3f);
    methods_agree(test.scene, &how);
}

/* Whatever is white returns what falls on it: a ball can not be seen before a white sky. A ball of
 * triangles with smooth normals loses a little at its rim, where normals are bent towards the eye.
 */
static void white_layered_balls_vanish_before_a_white_sky(void **state)
{
    (void)state;
    ppm_material_desc kinds[4];
    for (int i = 0; i < 4; i++)
        kinds[i] = material_desc_rgb(vec3(1, 1, 1), 0, 0.5f);
    kinds[0].clearcoat = 1.0f;
    kinds[1].sheen_color[0] = kinds[1].sheen_color[1] = kinds[1].sheen_color[2] = 1.0f;
    kinds[1].sheen_roughness = 0.6f;
    kinds[2].diffuse_transmission = 0.5f;
    kinds[3].diffuse_transmission = 1.0f; /* wax that takes nothing away */
    kinds[3].attenuation_distance_m = 0.2f;
    for (int c = 0; c < 3; c++) {
        kinds[3].attenuation_color[c] = 0.3f;
        kinds[3].multiscatter_color[c] = 1.0f;
    }
    is_smooth = true;
    for (int i = 0; i < 4; i++)
        place(&kinds[i], 0.45f, (float)(i % 2) - 0.5f, (float)(i / 2) - 0.5f, 0.0f);
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 4), vec3(0, 0, 0), 1.0f);
    ppm_render_options options = method_options(&path_method, 16, 1000);
    options.max_depth = 2000;
    const test_mean mean = render_green(test.scene, &options, 24, 8);
    test_family family = {0};
    mean_check_power(&mean, 0.003);
    family_add_mean(&family, &mean, 1.0, 0.005, "white balls");
    family_check(&family);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_box_of_layered_things, open_scene, close_scene),
        cmocka_unit_test_setup_teardown(a_leaf_before_the_lamp, open_scene, close_scene),
        cmocka_unit_test_setup_teardown(a_ball_of_wax, open_scene, close_scene),
        cmocka_unit_test_setup_teardown(white_layered_balls_vanish_before_a_white_sky, open_scene,
                                        close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
