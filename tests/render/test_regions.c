/* Photon light in corners, on wires and behind walls: right with any radius, from the first pass.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "math/sampling.h"
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

/* A room of 10 cm walls on 100 m of sunny ground, and one that a wall of 1 cm divides, with a lamp
 * on the other side: radii are the program's own. */

static void check_is_dark(float *const *pictures, const char *what)
{
    for (int i = 0; i < 2; i++) {
        float most = 0.0f;
        for (uint32_t k = 0; k < WIDTH * WIDTH; k++)
            most = fmaxf(most, pictures[i][4 * k + 1]);
        if (most > 0.0f) fail_msg("%s: %g, integrator %d", what, (double)most, i);
        free(pictures[i]);
    }
}

static void check_darkness(const char *what)
{
    ppm_render_options sppm = options_of(PPM_INTEGRATOR_SPPM, 0.0f);
    ppm_render_options ppm = options_of(PPM_INTEGRATOR_PPM, 0.0f);
    sppm.direct = ppm.direct = 0; /* as by default */
    float *pictures[2] = {render_picture(test.scene, &sppm, 4),
                          render_picture(test.scene, &ppm, 4)};
    check_is_dark(pictures, what);
}

static void no_sunlight_comes_into_a_house(void **state)
{
    (void)state;
    const ppm_material_id inside = material_lambert(test.scene, 0.7f);
    const ppm_material_id outside = material_lambert(test.scene, 0.5f);
    const ppm_material_id ground = material_lambert(test.scene, 0.3f);
    shape_place(test.scene,
                shape_box(test.scene, inside, vec3(-1.5f, 0, -1.5f), vec3(1.5f, 2, 1.5f), 1, true));
    shape_place(test.scene, shape_box(test.scene, outside, vec3(-1.6f, -0.1f, -1.6f),
                                      vec3(1.6f, 2.1f, 1.6f), 1, false));
    add_quad(test.scene, ground, vec3(-50, -0.1f, 50), vec3(100, 0, 0), vec3(0, 0, -100));
    light_sun(test.scene, vec3(-0.26f, -0.64f, -0.72f), vec3_splat(80000.0f), 0.00465f);
    light_environment(test.scene, vec3(4000, 5000, 7000), 0, 0.0f);
    camera_perspective(test.scene, vec3(0, 1.2f, 1.45f), vec3(0.1f, 0.1f, 0), 0.785f);
    check_darkness("house");
}

static void no_light_passes_a_wall_of_a_centimetre(void **state)
{
    (void)state;
    const ppm_material_id grey = material_lambert(test.scene, 0.6f);
    shape_place(test.scene, shape_box(test.scene, grey, vec3(-1, 0, -1), vec3(1, 1, 1), 1, true));
    shape_place(test.scene,
                shape_box(test.scene, grey, vec3(-0.005f, 0, -1), vec3(0.005f, 1, 1), 1, false));
    light_point(test.scene, vec3(-0.5f, 0.7f, 0), vec3_splat(20.0f));
    camera_perspective(test.scene, vec3(0.9f, 0.7f, 0.9f), vec3(0, 0.2f, -0.2f), 1.05f);
    check_darkness("wall");
}

/* ---- wires in indirect light ----------------------------------------------------------------- */

enum { WIRES = 12, SIDES = 8, WIRE_WIDTH = 40, WIRE_HEIGHT = 30 };

/* A prism that leans a little, with smooth normals and without ends. */
static void place_wire(ppm_material_id material, ppmi_vec3 foot, ppmi_vec3 top, float radius)
{
    float positions[6 * SIDES], normals[6 * SIDES];
    uint32_t indices[6 * SIDES];
    const ppmi_frame frame = ppmi_frame_from_normal(vec3_normalize(vec3_sub(top, foot)));
    for (uint32_t i = 0; i < SIDES; i++) {
        const float angle = 2.0f * PPMI_PI * (float)i / SIDES;
        const ppmi_vec3 n = ppmi_frame_to_world(&frame, vec3(cosf(angle), sinf(angle), 0.0f));
        vec3_store(positions + 6 * i, vec3_mad(foot, n, radius));
        vec3_store(positions + 6 * i + 3, vec3_mad(top, n, radius));
        vec3_store(normals + 6 * i, n);
        vec3_store(normals + 6 * i + 3, n);
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % SIDES);
        const uint32_t two[6] = {a, b, b + 1, a, b + 1, a + 1};
        memcpy(indices + 6 * i, two, sizeof two);
    }
    const ppm_primitive_desc primitive = {.vertex_count = 2 * SIDES,
                                          .triangle_count = 2 * SIDES,
                                          .positions = positions,
                                          .normals = normals,
                                          .indices = indices,
                                          .material = material};
    shape_place(test.scene, shape_mesh(test.scene, &primitive));
}

/* Twelve wires of 4 to 48 mm in a room that is lit from above a board. */
static void build_wires(float wall, float wire, float glow)
{
    const ppm_material_id walls = material_lambert(test.scene, wall);
    const ppm_material_id wires = glow > 0.0f ? material_emitter(test.scene, glow, wire, false)
                                              : material_lambert(test.scene, wire);
    shape_place(test.scene,
                shape_box(test.scene, walls, vec3(-1.5f, 0, -1.5f), vec3(1.5f, 2, 1.5f), 1, true));
    shape_place(test.scene, shape_box(test.scene, walls, vec3(-1.2f, 1.55f, -1.2f),
                                      vec3(1.2f, 1.6f, 1.2f), 1, false));
    for (int i = 0; i < WIRES; i++) {
        const float x = -0.8f + 0.143f * (float)i;
        place_wire(wires, vec3(x, 0.1f, 0), vec3(x + 0.05f, 1.54f, 0), 0.002f * (float)(i + 1));
    }
    camera_perspective(test.scene, vec3(0, 0.9f, 1.4f), vec3(0, 0.85f, 0), 0.785f);
}

static ppm_render_options wire_options(int32_t integrator)
{
    ppm_render_options options = render_options(integrator, WIRE_WIDTH, 20000);
    options.height = WIRE_HEIGHT;
    options.max_depth = 64;
    return options;
}

/* The mean over all pixels with a wire in them. */
static double measure_wires(const float *rgba, const ppm_render_options *options, void *user)
{
    const float *mask = user;
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < (size_t)options->width * options->height; i++) {
        if (!(mask[4 * i + 1] > 0.0f)) continue;
        sum += (double)rgba[4 * i + 1];
        count += 1.0;
    }
    return sum / count;
}

static void wires_in_indirect_light_are_as_by_path_tracing(void **state)
{
    (void)state;
    build_wires(0.0f, 0.0f, 1.0f);
    const ppm_render_options mask_options = wire_options(PPM_INTEGRATOR_PATH);
    float *mask = render_picture(test.scene, &mask_options, 16);
    scene_close(&test);

    scene_open(&test);
    build_wires(0.5f, 0.7f, 0.0f);
    light_point(test.scene, vec3(0, 1.8f, 0), vec3_splat(100.0f));
    const test_mean path =
        render_means(test.scene, &mask_options, TEST_EFFORT(160), 8, measure_wires, mask);
    mean_check_power(&path, 0.0125);
    test_family family = {0};
    for (int i = 0; i < 2; i++) {
        const ppm_render_options options =
            wire_options(i == 0 ? PPM_INTEGRATOR_SPPM : PPM_INTEGRATOR_PPM);
        const test_mean mean = render_means(test.scene, &options, 16, 12, measure_wires, mask);
        mean_check_power(&mean, 0.025);
        family_add_mean(&family, &mean, path.mean, 0.03 * path.mean + 3.0 * mean_error(&path),
                        "wires, integrator %d", i);
    }
    family_check(&family);
    free(mask);
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
        cmocka_unit_test_setup_teardown(no_sunlight_comes_into_a_house, open_scene, close_scene),
        cmocka_unit_test_setup_teardown(no_light_passes_a_wall_of_a_centimetre, open_scene,
                                        close_scene),
        cmocka_unit_test_setup_teardown(wires_in_indirect_light_are_as_by_path_tracing, open_scene,
                                        close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
