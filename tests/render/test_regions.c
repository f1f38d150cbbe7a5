/* Photon light in corners, on wires and behind walls: right with any radius, from the first pass.
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
#include "support/shapes.h"

static test_scene test;

enum { SEEDS = 16, WIDTH = 16 };

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

static ppm_render_options options_of(int32_t integrator, float radius)
{
    ppm_render_options options = render_options(integrator, WIDTH, 20000);
    options.direct = PPM_DIRECT_PHOTONS;
    options.radius_m = radius;
    options.max_depth = 64;
    return options;
}

/* All that is in a closed box glows and reflects alike: the radiance is 1 / (1 - rho) everywhere.
 */
static void check_furnace(const char *what, float radius, double systematic)
{
    test_family family = {0};
    for (int i = 0; i < 2; i++) {
        const int32_t integrator = i == 0 ? PPM_INTEGRATOR_SPPM : PPM_INTEGRATOR_PPM;
        const ppm_render_options options = options_of(integrator, radius);
        const test_mean mean = render_green(test.scene, &options, 1, SEEDS);
        mean_check_power(&mean, 0.02);
        family_add_mean(&family, &mean, 2.0, 2.0 * systematic, "%s, integrator %d", what,
                        integrator);
    }
    family_check(&family);
}

static ppm_material_id open_furnace(void)
{
    const ppm_material_id glow = material_emitter(test.scene, 1.0f, 0.5f, false);
    shape_place(test.scene, shape_box(test.scene, glow, vec3_splat(0), vec3_splat(1), 1, true));
    return glow;
}

static void a_corner_of_a_furnace_is_as_bright_as_its_walls(void **state)
{
    (void)state;
    open_furnace();
    camera_perspective(test.scene, vec3(0.4f, 0.45f, 0.5f), vec3(0, 0, 0), 0.5f);
    check_furnace("corner", 0.2f, 1e-5);
}

/* Much thinner than the disk is wide. */
static void a_wire_in_a_furnace_is_as_bright_as_its_walls(void **state)
{
    (void)state;
    const ppm_material_id glow = open_furnace();
    shape_place(test.scene, shape_box(test.scene, glow, vec3(0.2f, 0.49f, 0.49f),
                                      vec3(0.8f, 0.51f, 0.51f), 1, false));
    camera_orthographic(test.scene, vec3(0.5f, 0.5f, 0.9f), vec3(0.5f, 0.5f, 0), 0.02f);
    check_furnace("wire", 0.2f, 1e-5);
}

/* Far more facets than are measured at once: the disk is made smaller. Facets that lean by an angle
 * a see (1 - cos a) / 2 less of what the point's sees; here a is at most asin(radius / 0.2). */
static void a_dense_ball_in_a_furnace_is_as_bright_as_its_walls(void **state)
{
    (void)state;
    const ppm_material_id glow = open_furnace();
    shape_place_at(test.scene, shape_sphere(test.scene, glow, 0.2f, 80, false), vec3_splat(0.5f));
    camera_orthographic(test.scene, vec3(0.5f, 0.5f, 0.95f), vec3(0.5f, 0.5f, 0), 0.22f);
    check_furnace("ball", 0.05f, 0.016);
}

/* Walls of a millimetre, a radius of half the room, and the light close by outside. */
static void no_light_comes_into_a_closed_room(void **state)
{
    (void)state;
    const ppm_material_id grey = material_lambert(test.scene, 0.7f);
    const float wall = 0.001f;
    shape_place(test.scene, shape_box(test.scene, grey, vec3_splat(0), vec3_splat(1), 1, true));
    shape_place(test.scene,
                shape_box(test.scene, grey, vec3_splat(-wall), vec3_splat(1 + wall), 1, false));
    add_quad(test.scene, grey, vec3(-9, -wall, 9), vec3(18, 0, 0), vec3(0, 0, -18));
    light_point(test.scene, vec3(-0.3f, 0.3f, 0.5f), vec3_splat(100.0f));
    light_point(test.scene, vec3(0.5f, 1.5f, 1.3f), vec3_splat(100.0f));
    camera_perspective(test.scene, vec3(0.9f, 0.8f, 0.9f), vec3(0, 0, 0.3f), 1.0f);
    for (int i = 0; i < 2; i++) {
        const int32_t integrator = i == 0 ? PPM_INTEGRATOR_SPPM : PPM_INTEGRATOR_PPM;
        const ppm_render_options options = options_of(integrator, 0.5f);
        float *rgba = render_picture(test.scene, &options, 2);
        for (uint32_t k = 0; k < WIDTH * WIDTH; k++)
            assert_near((double)rgba[4 * k + 1], 0.0, 0.0);
        free(rgba);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_corner_of_a_furnace_is_as_bright_as_its_walls, open_scene,
                                        close_scene),
        cmocka_unit_test_setup_teardown(a_wire_in_a_furnace_is_as_bright_as_its_walls, open_scene,
                                        close_scene),
        cmocka_unit_test_setup_teardown(a_dense_ball_in_a_furnace_is_as_bright_as_its_walls,
                                        open_scene, close_scene),
        cmocka_unit_test_setup_teardown(no_light_comes_into_a_closed_room, open_scene, close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
