/* Motion blur and round shapes in whole pictures. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static test_scene test, other;

static int open_scenes(void **state)
{
    (void)state;
    scene_open(&test);
    scene_open(&other);
    return 0;
}

static int close_scenes(void **state)
{
    (void)state;
    scene_close(&other);
    scene_close(&test);
    return 0;
}

static void at_place(ppmi_vec3 p, float columns[16])
{
    const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, p.x, p.y, p.z, 1};
    memcpy(columns, identity, sizeof identity);
}

/* From one place to another while the shutter is open. */
static ppm_instance_id place_moving(ppm_scene *scene, ppm_mesh_id mesh, ppmi_vec3 from,
                                    ppmi_vec3 to)
{
    float motion[32];
    at_place(from, motion);
    at_place(to, motion + 16);
    const ppm_instance_desc desc = {
        .size = sizeof desc, .mesh = mesh, .motion_steps = 2, .motion = motion};
    ppm_instance_id id = 0;
    assert_int_equal(ppm_scene_add_instance(scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

static ppm_render_options with_shutter(int32_t integrator, uint32_t width, uint64_t photons)
{
    ppm_render_options options = render_options(integrator, width, photons);
    options.shutter_close = 0.5f;
    return options;
}

/* ---- coverage -------------------------------------------------------------------------------- */

enum { COLUMNS = 16, SEEDS = 8, PASSES = 32 };

/* A picture 4 m wide of something 1 m wide and of radiance 1 whose left edge goes evenly from -1.5
 * m to 0.5 m: the share of the time that it is at x. */
static double coverage_at(double x)
{
    const double first = (x + 0.5) / 2, last = (x + 1.5) / 2;
    return fmax(0.0, fmin(last, 1.0) - fmax(first, 0.0));
}

static double column_coverage(int column)
{
    const int points = 1000;
    double sum = 0.0;
    for (int i = 0; i < points; i++)
        sum += coverage_at(-2.0 + 4.0 * (column + (i + 0.5) / points) / COLUMNS);
    return sum / points;
}

static void assert_blurred(int32_t integrator)
{
    test_mean means[COLUMNS] = {{0}};
    ppm_render_options options = with_shutter(integrator, COLUMNS, 1000);
    for (uint32_t seed = 1; seed <= SEEDS; seed++) {
        options.seed = seed;
        float *picture = render_picture(test.scene, &options, PASSES);
        for (int x = 0; x < COLUMNS; x++) {
            double sum = 0.0;
            for (int y = 0; y < COLUMNS; y++)
                sum += (double)picture[4 * (y * COLUMNS + x)];
            mean_add(&means[x], sum / COLUMNS);
        }
        free(picture);
    }
    test_family family = {0};
    for (int x = 0; x < COLUMNS; x++)
        family_add_mean(&family, &means[x], column_coverage(x), 1e-6, "column %d", x);
    family_check(&family);
    mean_check_power(&means[COLUMNS / 2], 0.03);
}

static ppm_material_id bright(ppm_scene *scene)
{
    return material_emitter(scene, 1.0f, 0.0f, true);
}

static void look_at_the_stage(ppm_scene *scene)
{
    camera_orthographic(scene, vec3(0, 0, 5), vec3_splat(0.0f), 2.0f);
}

static void a_moving_instance_covers_a_pixel_for_its_share_of_the_time(void **state)
{
    (void)state;
    const ppm_mesh_id quad =
        shape_quad(test.scene, bright(test.scene), vec3(0, -3, 0), vec3(1, 0, 0), vec3(0, 6, 0));
    place_moving(test.scene, quad, vec3(-1.5f, 0, 0), vec3(0.5f, 0, 0));
    look_at_the_stage(test.scene);
    assert_blurred(PPM_INTEGRATOR_PATH);
    assert_blurred(PPM_INTEGRATOR_SPPM);
}

static void so_do_moving_vertices(void **state)
{
    (void)state;
    static const float positions[24] = {-1.5f, -3, 0, -0.5f, -3, 0, -0.5f, 3, 0, -1.5f, 3, 0,
                                        0.5f,  -3, 0, 1.5f,  -3, 0, 1.5f,  3, 0, 0.5f,  3, 0};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const ppm_primitive_desc primitive = {.vertex_count = 4,
                                          .triangle_count = 2,
                                          .positions = positions,
                                          .indices = indices,
                                          .material = bright(test.scene),
                                          .motion_steps = 2};
    shape_place(test.scene, shape_mesh(test.scene, &primitive));
    look_at_the_stage(test.scene);
    assert_blurred(PPM_INTEGRATOR_PATH);
    assert_blurred(PPM_INTEGRATOR_SPPM);
}

static void so_does_what_a_moving_camera_sees(void **state)
{
    (void)state;
    shape_place(test.scene, shape_quad(test.scene, bright(test.scene), vec3(-1.5f, -3, 0),
                                       vec3(1, 0, 0), vec3(0, 6, 0)));
    float motion[32];
    at_place(vec3(0, 0, 5), motion);
    at_place(vec3(-2, 0, 5), motion + 16);
    const ppm_camera_desc camera = {.size = sizeof camera,
                                    .kind = PPM_CAMERA_ORTHOGRAPHIC,
                                    .half_width_m = 2.0f,
                                    .half_height_m = 2.0f,
                                    .motion_steps = 2,
                                    .motion = motion};
    ppm_camera_id id;
    assert_int_equal(ppm_scene_add_camera(test.scene, &camera, &id), PPM_STATUS_OK);
    assert_blurred(PPM_INTEGRATOR_PATH);
    assert_blurred(PPM_INTEGRATOR_SPPM);
}

static void a_closed_shutter_shows_the_opening(void **state)
{
    (void)state;
    const ppm_mesh_id quad =
        shape_quad(test.scene, bright(test.scene), vec3(0, -3, 0), vec3(1, 0, 0), vec3(0, 6, 0));
    place_moving(test.scene, quad, vec3(-1.5f, 0, 0), vec3(0.5f, 0, 0));
    look_at_the_stage(test.scene);
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, COLUMNS, 0);
    float *picture = render_picture(test.scene, &options, 2);
    for (int x = 0; x < COLUMNS; x++) /* pixels are 1/4 m wide */
        assert_near(picture[4 * x], x >= 2 && x < 6 ? 1.0 : 0.0, 1e-6);
    free(picture);
}

/* ---- a turning camera ------------------------------------------------------------------------ */

/* A turn about y by columns. */
static void turned(float angle, float columns[16])
{
    at_place(vec3_splat(0.0f), columns);
    columns[0] = columns[10] = cosf(angle);
    columns[8] = sinf(angle);
    columns[2] = -columns[8];
}

/* Two steps of the camera turn it evenly. A world that turns the other way needs many: its matrices
 * go on chords. */
static void a_turning_camera_sees_what_a_still_one_sees_of_a_turning_world(void **state)
{
    (void)state;
    enum { STEPS = 65, SIDE = 24 };
    const float angle = 1.2f;
    ppm_scene *scenes[2] = {test.scene, other.scene};
    for (int i = 0; i < 2; i++) {
        float camera_motion[32], world_motion[16 * STEPS];
        turned(0.0f, camera_motion);
        turned(i == 0 ? angle : 0.0f, camera_motion + 16);
        for (int k = 0; k < STEPS; k++)
            turned(i == 0 ? 0.0f : -angle * (float)k / (STEPS - 1), world_motion + 16 * (size_t)k);
        const ppm_camera_desc camera = {
            .size = sizeof camera, .y_fov_rad = 0.9f, .motion_steps = 2, .motion = camera_motion};
        const ppm_instance_desc world = {.size = sizeof world,
                                         .mesh = shape_quad(scenes[i], bright(scenes[i]),
                                                            vec3(-1, -0.7f, -4), vec3(1.4f, 0, 0),
                                                            vec3(0, 1.9f, 0)),
                                         .motion_steps = STEPS,
                                         .motion = world_motion};
        uint32_t id;
        assert_int_equal(ppm_scene_add_camera(scenes[i], &camera, &id), PPM_STATUS_OK);
        assert_int_equal(ppm_scene_add_instance(scenes[i], &world, &id), PPM_STATUS_OK);
    }
    /* the same numbers draw the same times: only rounding differs, at edges */
    const ppm_render_options options = with_shutter(PPM_INTEGRATOR_PATH, SIDE, 0);
    float *camera_turns = render_picture(test.scene, &options, 16);
    float *world_turns = render_picture(other.scene, &options, 16);
    double difference = 0.0, sum = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        difference += fabs((double)camera_turns[4 * i] - (double)world_turns[4 * i]);
        sum += (double)camera_turns[4 * i];
    }
    free(camera_turns);
    free(world_turns);
    assert_true(sum > 10.0);
    /* chords of 65 steps are off by (1 - cos(angle / 128)) = 4.4e-5 of the distance, which shifts
     * edges by less than a hundredth of a pixel */
    assert_true(difference < 0.003 * sum);
}

/* ---- light ----------------------------------------------------------------------------------- */

static void assert_methods_agree(ppm_scene *scene, double resolution)
{
    ppm_render_options options[3] = {with_shutter(PPM_INTEGRATOR_PATH, 12, 0),
                                     with_shutter(PPM_INTEGRATOR_SPPM, 12, 8000),
                                     with_shutter(PPM_INTEGRATOR_SPPM, 12, 8000)};
    options[2].direct = PPM_DIRECT_PHOTONS;
    test_mean path = render_green(scene, &options[0], 64, SEEDS);
    mean_check_power(&path, resolution);
    test_family family = {0};
    for (int i = 1; i < 3; i++) {
        options[i].radius_m = 0.05f;
        test_mean sppm = render_green(scene, &options[i], 32, SEEDS);
        mean_check_power(&sppm, resolution);
        const double error = hypot(mean_error(&path), mean_error(&sppm));
        family_add(&family, p_student((sppm.mean - path.mean) / error, SEEDS - 1),
                   "sppm %d: %g, path: %g", i, sppm.mean, path.mean);
    }
    family_check(&family);
}

static void floor_and_camera(ppm_scene *scene)
{
    const ppm_material_id grey = material_lambert(scene, 0.7f);
    add_quad(scene, grey, vec3(-4, 0, 4), vec3(8, 0, 0), vec3(0, 0, -8));
    add_quad(scene, grey, vec3(-4, 0, -1.5f), vec3(8, 0, 0), vec3(0, 4, 0));
    camera_perspective(scene, vec3(0, 1.5f, 3), vec3(0, 0.3f, -1), 0.5f);
}

/* It moves and opens, so that its area and its place are those of the path's time. */
static void a_moving_lamp_lights_as_photons_and_paths_say_alike(void **state)
{
    (void)state;
    static const float positions[24] = {-0.2f, 0,     -0.2f, 0.2f, 0,     -0.2f, 0.2f,  0,
                                        0.2f,  -0.2f, 0,     0.2f, -0.9f, 0,     -0.3f, 0.2f,
                                        0,     -0.2f, 0.3f,  0,    0.4f,  -0.4f, 0,     0.2f};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const ppm_primitive_desc primitive = {.vertex_count = 4,
                                          .triangle_count = 2,
                                          .positions = positions,
                                          .indices = indices,
                                          .material =
                                              material_emitter(test.scene, 10.0f, 0.0f, true),
                                          .motion_steps = 2};
    floor_and_camera(test.scene);
    place_moving(test.scene, shape_mesh(test.scene, &primitive), vec3(-1, 1.2f, -0.5f),
                 vec3(1.2f, 0.6f, -0.3f));
    assert_methods_agree(test.scene, 0.03);
}

/* A moving ball that hides a light and gathers its light itself. */
static void a_moving_receiver_is_lit_as_photons_and_paths_say_alike(void **state)
{
    (void)state;
    floor_and_camera(test.scene);
    light_point(test.scene, vec3(0.5f, 3, 0.5f), vec3_splat(20.0f));
    place_moving(test.scene,
                 shape_sphere(test.scene, material_lambert(test.scene, 0.8f), 0.4f, 24, true),
                 vec3(-0.6f, 0.5f, -0.4f), vec3(0.7f, 0.7f, 0.2f));
    assert_methods_agree(test.scene, 0.03);
}

static ppm_mesh_id round_mesh(ppm_scene *scene, int32_t kind, const float *positions,
                              uint32_t elements, float radius, ppm_material_id material)
{
    static const uint32_t indices[4] = {0, 1, 2, 3};
    const ppm_primitive_desc primitive = {.vertex_count =
                                              kind == PPM_PRIMITIVE_LINES ? 2 * elements : elements,
                                          .positions = positions,
                                          .indices = indices,
                                          .material = material,
                                          .kind = kind,
                                          .element_count = elements,
                                          .radius_m = radius};
    return shape_mesh(scene, &primitive);
}

/* Balls that an uneven scale makes ellipsoids, and rods. */
static void glowing_points_and_lines_light_as_photons_and_paths_say_alike(void **state)
{
    (void)state;
    static const float points[6] = {-0.5f, 0.4f, -0.5f, 0.5f, 0.9f, -0.3f};
    static const float lines[6] = {-0.2f, 0.2f, 0.2f, 0.6f, 0.3f, 0};
    const ppm_material_id lamp = material_emitter(test.scene, 10.0f, 0.0f, true);
    const float stretched[16] = {1.5f, 0, 0, 0, 0, 0.7f, 0.3f, 0, 0, 0, 1, 0, 0, 0.2f, 0, 1};
    floor_and_camera(test.scene);
    shape_place_by(test.scene, round_mesh(test.scene, PPM_PRIMITIVE_POINTS, points, 2, 0.12f, lamp),
                   stretched);
    shape_place(test.scene, round_mesh(test.scene, PPM_PRIMITIVE_LINES, lines, 1, 0.05f, lamp));
    ppm_scene_info info = {.size = sizeof info};
    assert_int_equal(ppm_scene_get_info(test.scene, &info), PPM_STATUS_OK);
    assert_int_equal(info.has_light, 1);
    assert_methods_agree(test.scene, 0.03);
}

/* ---- points and lines against triangles -------------------------------------------------------
 */

static double relative_difference(ppm_scene *a, ppm_scene *b, uint32_t passes)
{
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 32, 0);
    float *first = render_picture(a, &options, passes),
          *second = render_picture(b, &options, passes);
    double difference = 0.0, sum = 0.0;
    for (int i = 0; i < 32 * 32; i++) {
        difference += fabs((double)first[4 * i + 1] - (double)second[4 * i + 1]);
        sum += (double)second[4 * i + 1];
    }
    free(first);
    free(second);
    assert_true(sum > 1.0);
    return difference / sum;
}

/* The same numbers give the same paths, but for facets: lit by a lamp, so that shading shows. */
static void a_point_looks_like_the_ball_of_triangles(void **state)
{
    (void)state;
    static const float center[3] = {0, 0, 0};
    ppm_scene *scenes[2] = {test.scene, other.scene};
    for (int i = 0; i < 2; i++) {
        const ppm_material_id grey = material_lambert(scenes[i], 0.6f);
        const ppm_mesh_id mesh =
            i == 0 ? round_mesh(scenes[i], PPM_PRIMITIVE_POINTS, center, 1, 0.8f, grey)
                   : shape_sphere(scenes[i], grey, 0.8f, 96, true);
        const float stretched[16] = {1.2f, 0.3f, 0,  0, 0,    0.6f, 0, 0,
                                     0,    0.1f, -1, 0, 0.1f, 0,    0, 1};
        shape_place_by(scenes[i], mesh, stretched);
        light_point(scenes[i], vec3(2, 3, 2), vec3_splat(30.0f));
        camera_perspective(scenes[i], vec3(0, 0, 4), vec3_splat(0.0f), 0.6f);
    }
    assert_true(relative_difference(test.scene, other.scene, 4) < 0.005);
}

/* Refraction by the way in and out, at balls that are Embree's. */
static void a_glass_point_refracts_like_the_ball_of_triangles(void **state)
{
    (void)state;
    static const float center[3] = {0, 0, 0};
    ppm_scene *scenes[2] = {test.scene, other.scene};
    double means[2];
    for (int i = 0; i < 2; i++) {
        const ppm_material_id glass = material_glass(scenes[i], 1.5f, 0.0f);
        const ppm_mesh_id mesh =
            i == 0 ? round_mesh(scenes[i], PPM_PRIMITIVE_POINTS, center, 1, 0.8f, glass)
                   : shape_sphere(scenes[i], glass, 0.8f, 128, true);
        shape_place(scenes[i], mesh);
        add_quad(scenes[i], material_emitter(scenes[i], 1.0f, 0.0f, true), vec3(-2, -2, -3),
                 vec3(2.2f, 0, 0), vec3(0, 4, 0));
        camera_perspective(scenes[i], vec3(0, 0, 4), vec3_splat(0.0f), 0.5f);
        const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 32, 0);
        test_mean mean = render_green(scenes[i], &options, 32, 4);
        means[i] = mean.mean;
    }
    /* 128 rings: facets are off by 1 - cos(pi / 256) = 8e-5 of the radius, normals are smooth */
    assert_near(means[0] / means[1], 1.0, 0.01);
}

static void bad_points_and_motion_are_refused(void **state)
{
    (void)state;
    static const float positions[6] = {0, 0, 0, 1, 0, 0};
    static const uint32_t indices[2] = {0, 1};
    const ppm_primitive_desc good = {.vertex_count = 2,
                                     .positions = positions,
                                     .indices = indices,
                                     .kind = PPM_PRIMITIVE_LINES,
                                     .element_count = 1,
                                     .radius_m = 0.1f};
    ppm_primitive_desc bad[6] = {good, good, good, good, good, good};
    bad[0].kind = 3;
    bad[1].radius_m = 0.0f;
    bad[2].radius_m = NAN;
    bad[3].motion_steps = PPM_MAX_MOTION_STEPS + 1;
    bad[4].vertex_count = 1;
    bad[5].positions = NULL;
    ppm_mesh_id id = 77;
    for (int i = 0; i < 6; i++) {
        const ppm_mesh_desc mesh = {
            .size = sizeof mesh, .primitive_count = 1, .primitives = &bad[i]};
        assert_int_equal(ppm_scene_add_mesh(test.scene, &mesh, &id), PPM_STATUS_INVALID_ARGUMENT);
    }
    assert_int_equal(id, 77);
    float motion[32];
    at_place(vec3_splat(0.0f), motion);
    at_place(vec3(INFINITY, 0, 0), motion + 16);
    const ppm_camera_desc cameras[3] = {
        {.size = sizeof *cameras, .y_fov_rad = 1.0f, .motion_steps = 2, .motion = motion},
        {.size = sizeof *cameras, .y_fov_rad = 1.0f, .motion_steps = 2},
        {.size = sizeof *cameras,
         .y_fov_rad = 1.0f,
         .motion_steps = PPM_MAX_MOTION_STEPS + 1,
         .motion = motion}};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(ppm_scene_add_camera(test.scene, &cameras[i], &id),
                         PPM_STATUS_INVALID_ARGUMENT);
    }
    assert_int_equal(id, 77);
}

int main(void)
{
#define WITH_SCENES(f) cmocka_unit_test_setup_teardown(f, open_scenes, close_scenes)
    const struct CMUnitTest tests[] = {
        WITH_SCENES(bad_points_and_motion_are_refused),
        WITH_SCENES(a_moving_instance_covers_a_pixel_for_its_share_of_the_time),
        WITH_SCENES(so_do_moving_vertices),
        WITH_SCENES(so_does_what_a_moving_camera_sees),
        WITH_SCENES(a_closed_shutter_shows_the_opening),
        WITH_SCENES(a_turning_camera_sees_what_a_still_one_sees_of_a_turning_world),
        WITH_SCENES(a_moving_lamp_lights_as_photons_and_paths_say_alike),
        WITH_SCENES(a_moving_receiver_is_lit_as_photons_and_paths_say_alike),
        WITH_SCENES(glowing_points_and_lines_light_as_photons_and_paths_say_alike),
        WITH_SCENES(a_point_looks_like_the_ball_of_triangles),
        WITH_SCENES(a_glass_point_refracts_like_the_ball_of_triangles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
