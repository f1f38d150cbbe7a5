/* src/scene/regular.c, freeze.c: flat, tiny and far instances, which no ray may choke on. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scene/regular.h"
#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static ppmi_transform turned(float angle, float x, float y, float z)
{
    const float c = cosf(angle), s = sinf(angle);
    return (ppmi_transform){
        {c * x, s * x, 0.0f}, {-s * y, c * y, 0.0f}, {0.0f, 0.0f, z}, {0.0f, 0.0f, 0.0f}};
}

static void regular_ones_stay_to_the_bit(void **state)
{
    (void)state;
    static const float scales[][3] = {{1, 1, 1},     {1, -1, 1},   {1e-9f, 1e-9f, 1e-9f},
                                      {1, 1, 1e-6f}, {1e6f, 1, 1}, {1e12f, 1e12f, 1e12f}};
    for (size_t i = 0; i < sizeof scales / sizeof scales[0]; i++) {
        const ppmi_transform m = turned(0.3f, scales[i][0], scales[i][1], scales[i][2]);
        ppmi_transform kept = m;
        assert_true(ppmi_make_regular(&kept));
        assert_memory_equal(&kept, &m, sizeof m);
    }
}

/* What lies in the plane stays, and the direction that is lost leads out of it. */
static void a_flat_one_gets_a_thickness_across_its_plane(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        const float scale[3] = {axis == 0 ? 0.0f : 2.0f, axis == 1 ? 1e-18f : 3.0f,
                                axis == 2 ? 0.0f : 4.0f};
        const ppmi_transform flat = turned(0.7f, scale[0], scale[1], scale[2]);
        const ppmi_transform wide = turned(0.7f, 1.0f, 1.0f, 1.0f);
        const ppmi_vec3 axes[3] = {wide.x, wide.y, wide.z};
        ppmi_transform m = flat;
        assert_true(ppmi_make_regular(&m));
        const ppmi_vec3 columns[3] = {m.x, m.y, m.z};
        for (int i = 0; i < 3; i++) {
            const float along = fabsf(vec3_dot(columns[i], axes[i]));
            assert_near(along / vec3_length(columns[i]), 1.0, 1e-3);
            if (i != axis) assert_near(along, (i == 0 ? 2.0f : i == 1 ? 3.0f : 4.0f), 1e-5);
            if (i == axis) assert_true(along > 1e-6f && along < 1e-5f);
        }
        assert_true(ppmi_least_stretch(&m) > 1e-6);
    }
}

static void of_lines_and_points_nothing_is_left(void **state)
{
    (void)state;
    ppmi_transform line = turned(0.2f, 1.0f, 0.0f, 0.0f), point = turned(0.2f, 0.0f, 0.0f, 0.0f);
    ppmi_transform thread = turned(0.2f, 1.0f, 1e-18f, 1e-18f);
    assert_false(ppmi_make_regular(&line));
    assert_false(ppmi_make_regular(&point));
    assert_false(ppmi_make_regular(&thread));
}

static void half_turns_and_mirrorings_pass_through_a_flat_one(void **state)
{
    (void)state;
    const ppmi_transform one = turned(0.0f, 1, 1, 1), half = turned(PPMI_PI, 1, 1, 1);
    const ppmi_transform less = turned(PPMI_PI * 0.98f, 1, 1, 1), mirror = turned(0, 1, 1, -1);
    const ppmi_transform both = turned(0, -1, -1, 1), small = turned(0, 1e-6f, 1e-6f, 1e-6f);
    assert_false(ppmi_stays_regular(&one, &half));
    assert_true(ppmi_stays_regular(&one, &less));
    assert_false(ppmi_stays_regular(&one, &mirror));
    assert_false(ppmi_stays_regular(&one, &both));
    assert_true(ppmi_stays_regular(&one, &small));
    assert_true(ppmi_stays_regular(&one, &one));
}

/* ---- pictures -------------------------------------------------------------------------------- */

static test_scene test;
static ppm_mesh_id box;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    box = shape_box(test.scene, material_lambert(test.scene, 0.5f), vec3_splat(-1), vec3_splat(1),
                    1, true);
    camera_perspective(test.scene, vec3(0, 0, 6), vec3(0, 0, 0), 0.8f);
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static ppm_status put(float x, float scale_x, float scale_y, float scale_z, ppm_instance_id *out_id)
{
    const ppm_instance_desc desc = {
        .size = sizeof desc,
        .name = "Box",
        .mesh = box,
        .transform = {scale_x, 0, 0, 0, 0, scale_y, 0, 0, 0, 0, scale_z, 0, x, 0, 0, 1}};
    return ppm_scene_add_instance(test.scene, &desc, out_id);
}

/* The share of the picture that something covers. */
static double coverage(void)
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 32, 1000);
    options.is_transparent = 1;
    options.shutter_close = 1.0f;
    float *picture = render_picture(test.scene, &options, 4);
    double sum = 0.0;
    for (size_t i = 0; i < 4 * 32 * 32; i += 4) {
        assert_true(isfinite(picture[i]));
        sum += (double)picture[i + 3] / (32.0 * 32.0);
    }
    free(picture);
    return sum;
}

/* A square of 2 m, 6 m away, in a view of 0.8 rad. */
static void a_scale_of_0_along_the_view_is_a_square(void **state)
{
    (void)state;
    ppm_instance_id id = 0;
    assert_int_equal(put(0, 1, 1, 0, &id), PPM_STATUS_OK);
    const double side = 2.0 / (2.0 * 6.0 * tan(0.4));
    assert_near(coverage(), side * side, 0.01);
}

static void what_cannot_be_traced_is_left_out_by_name(void **state)
{
    (void)state;
    ppm_instance_id id = 0;
    assert_int_equal(put(0, 1, 1, 1, &id), PPM_STATUS_OK);
    const double alone = coverage();
    const uint32_t before = test.warnings;
    assert_int_equal(put(2e18f, 1, 1, 1, &id), PPM_STATUS_OK);
    assert_int_equal(put(3, 1e-18f, 1e-18f, 1e-18f, &id), PPM_STATUS_OK);
    assert_near(coverage(), alone, 0.0);
    assert_int_equal(test.warnings, before + 2);
    assert_int_equal(put(0, 1, 1e-18f, 1e-18f, &id), PPM_STATUS_OK);
    assert_int_equal(id, 0);
    assert_int_equal(test.warnings, before + 3);
}

static void one_that_grows_from_nothing_or_turns_over_is_blurred_or_told(void **state)
{
    (void)state;
    static const float ends[][6] = {{0, 0, 0, 1, 1, 1},
                                    {1, 1, 1, 0, 0, 0},
                                    {-1, 1, 1, 1, 1, 1},
                                    {-1, 1, -1, 1, 1, 1},
                                    {1, 0, 1, 1, 1, 1}};
    ppm_instance_id id = 0;
    assert_int_equal(put(0, 1, 1, 1, &id), PPM_STATUS_OK);
    for (int i = 0; i < 5; i++) {
        float motion[32] = {0};
        for (int k = 0; k < 6; k++)
            motion[16 * (k / 3) + 5 * (k % 3)] = ends[i][k];
        motion[15] = motion[31] = 1.0f;
        const ppm_instance_desc desc = {
            .size = sizeof desc, .mesh = box, .motion_steps = 2, .motion = motion};
        const uint32_t before = test.warnings;
        assert_int_equal(ppm_scene_set_instance(test.scene, id, &desc), PPM_STATUS_OK);
        assert_int_equal(test.warnings - before, i == 2 || i == 3);
        assert_true(coverage() > 0.0);
    }
}

static void a_camera_beyond_is_refused(void **state)
{
    (void)state;
    ppm_camera_id id = 0;
    const ppm_camera_desc desc = {.size = sizeof desc,
                                  .name = "Far",
                                  .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1e19f, 1},
                                  .y_fov_rad = 1.0f};
    assert_int_equal(ppm_scene_add_camera(test.scene, &desc, &id), PPM_STATUS_INVALID_ARGUMENT);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(regular_ones_stay_to_the_bit),
        cmocka_unit_test(a_flat_one_gets_a_thickness_across_its_plane),
        cmocka_unit_test(of_lines_and_points_nothing_is_left),
        cmocka_unit_test(half_turns_and_mirrorings_pass_through_a_flat_one),
        WITH_SCENE(a_scale_of_0_along_the_view_is_a_square),
        WITH_SCENE(what_cannot_be_traced_is_left_out_by_name),
        WITH_SCENE(one_that_grows_from_nothing_or_turns_over_is_blurred_or_told),
        WITH_SCENE(a_camera_beyond_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
