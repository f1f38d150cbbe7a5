/* Moving and round shapes: where rays meet them, and that rays which leave them do not meet them
 * again where they began. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "accel/round.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

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

static ppmi_vec3 random_direction(ppmi_rng *rng)
{
    for (;;) {
        const ppmi_vec3 v =
            vec3(2.0f * ppmi_rng_float(rng) - 1.0f, 2.0f * ppmi_rng_float(rng) - 1.0f,
                 2.0f * ppmi_rng_float(rng) - 1.0f);
        const float length2 = vec3_length2(v);
        if (length2 > 1e-3f && length2 < 1.0f) return vec3_scale(v, 1.0f / sqrtf(length2));
    }
}

/* A turn about (1, 1, 0), sizes that differ, and a place, by columns. */
static void pose(float angle, ppmi_vec3 scale, ppmi_vec3 place, float columns[16])
{
    const ppmi_vec3 axis = vec3_normalize(vec3(1, 1, 0));
    const float c = cosf(angle), s = sinf(angle);
    const ppmi_vec3 units[3] = {vec3(scale.x, 0, 0), vec3(0, scale.y, 0), vec3(0, 0, scale.z)};
    for (int i = 0; i < 3; i++) { /* Rodrigues */
        const ppmi_vec3 v = units[i];
        const ppmi_vec3 turned = vec3_mad(vec3_mad(vec3_scale(v, c), vec3_cross(axis, v), s), axis,
                                          vec3_dot(axis, v) * (1.0f - c));
        vec3_store(columns + 4 * i, turned);
        columns[4 * i + 3] = 0.0f;
    }
    vec3_store(columns + 12, place);
    columns[15] = 1.0f;
}

enum { STEPS = 5 };

static void place_moving(ppm_mesh_id mesh, ppmi_vec3 center)
{
    float motion[16 * STEPS];
    for (int i = 0; i < STEPS; i++) {
        const float x = (float)i / (STEPS - 1);
        pose(0.3f + 1.3f * x, vec3(1.0f, 0.5f + x, 0.7f), vec3_add(center, vec3(3 * x, x * x, -x)),
             motion + 16 * (size_t)i);
    }
    const ppm_instance_desc desc = {
        .size = sizeof desc, .mesh = mesh, .motion_steps = STEPS, .motion = motion};
    ppm_instance_id id;
    assert_int_equal(ppm_scene_add_instance(test.scene, &desc, &id), PPM_STATUS_OK);
}

/* Rays from around at random times: what they meet is on the ray, within the bounds of both, and
 * what leaves a convex shape outwards escapes. */
static void assert_rays_agree(ppmi_vec3 center, float reach, uint32_t count)
{
    test_world world;
    world_open(&world, &test);
    ppmi_rng rng = ppmi_rng_start(7, 1, 0);
    uint32_t hits = 0;
    for (uint32_t i = 0; i < count; i++) {
        const ppmi_vec3 from = vec3_mad(center, random_direction(&rng), reach);
        const ppmi_vec3 to = vec3_mad(center, random_direction(&rng), 0.4f * reach);
        const ppmi_ray ray = {.origin = from,
                              .t_max = INFINITY,
                              .direction = vec3_normalize(vec3_sub(to, from)),
                              .time = ppmi_rng_float(&rng)};
        ppmi_hit hit, again;
        if (!ppmi_accel_intersect(world.accel, &ray, &hit)) continue;
        hits++;
        ppmi_surface surface;
        ppmi_surface_from_hit(test.scene, &hit, &surface);
        assert_near(hit.time, ray.time, 0.0);
        const ppmi_vec3 met = vec3_mad(ray.origin, ray.direction, hit.t);
        const float cosine = ppmi_max(-vec3_dot(ray.direction, surface.ng), 0.02f);
        const float rounding = (surface.error + 4e-6f * reach) / cosine;
        assert_near(vec3_length(vec3_sub(met, surface.position)), 0.0, rounding);
        assert_true(vec3_dot(ray.direction, surface.ng) < 1e-3f);
        ppmi_vec3 outwards = random_direction(&rng);
        if (vec3_dot(outwards, surface.ng) < 0.0f) outwards = vec3_neg(outwards);
        const ppmi_ray leaving = ppmi_surface_ray(&surface, outwards);
        assert_near(leaving.time, ray.time, 0.0);
        assert_false(ppmi_accel_occluded(world.accel, &leaving));
        assert_false(ppmi_accel_intersect(world.accel, &leaving, &again));
    }
    assert_true(hits > count / 20);
    world_close(&world);
}

static void rays_meet_a_turning_box_where_it_is_and_leave_it_for_good(void **state)
{
    (void)state;
    place_moving(shape_box(test.scene, 0, vec3_splat(-1), vec3_splat(1), 2, false),
                 vec3_splat(0.0f));
    assert_rays_agree(vec3(1.5f, 0.5f, -0.5f), 6.0f, TEST_EFFORT(20000));
}

static void so_do_they_far_from_the_origin(void **state)
{
    (void)state;
    const ppmi_vec3 far = vec3(900, -700, 1200);
    place_moving(shape_box(test.scene, 0, vec3_splat(-1), vec3_splat(1), 2, false), far);
    assert_rays_agree(vec3_add(far, vec3(1.5f, 0.5f, -0.5f)), 6.0f, TEST_EFFORT(20000));
}

/* A tetrahedron whose corners go different ways at three times, in a moving instance. */
static void rays_meet_a_deforming_shape_where_it_is_and_leave_it_for_good(void **state)
{
    (void)state;
    static const float positions[3 * 4 * 3] = {
        -1, -1, -1, 1, -1,    -1,    0, -1, 1, 0,    1,    0,    /* opening */
        -2, -1, -1, 1, -1,    -1.5f, 0, -1, 2, 0.5f, 1.5f, 0.2f, /* middle */
        -1, -2, -1, 1, -1.2f, -1.2f, 0, -1, 1, 0,    2,    1};   /* closing */
    static const uint32_t indices[12] = {0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0};
    const ppm_primitive_desc primitive = {.vertex_count = 4,
                                          .triangle_count = 4,
                                          .positions = positions,
                                          .indices = indices,
                                          .motion_steps = 3};
    place_moving(shape_mesh(test.scene, &primitive), vec3_splat(0.0f));
    assert_rays_agree(vec3(1.5f, 0.5f, -0.5f), 7.0f, TEST_EFFORT(20000));
}

static ppm_mesh_id round_mesh(int32_t kind, const float *positions, uint32_t vertices,
                              const uint32_t *indices, uint32_t elements, float radius,
                              uint32_t steps)
{
    const ppm_primitive_desc primitive = {.vertex_count = vertices,
                                          .positions = positions,
                                          .indices = indices,
                                          .kind = kind,
                                          .element_count = elements,
                                          .radius_m = radius,
                                          .motion_steps = steps};
    return shape_mesh(test.scene, &primitive);
}

static void rays_meet_a_moving_ball_where_it_is_and_leave_it_for_good(void **state)
{
    (void)state;
    static const float positions[6] = {0.1f, 0, 0, 0.3f, -0.6f, 0.2f};
    static const uint32_t index = 0;
    place_moving(round_mesh(PPM_PRIMITIVE_POINTS, positions, 1, &index, 1, 1.1f, 2),
                 vec3_splat(0.0f));
    assert_rays_agree(vec3(1.5f, 0.5f, -0.5f), 6.0f, TEST_EFFORT(20000));
}

static void rays_meet_a_moving_segment_where_it_is_and_leave_it_for_good(void **state)
{
    (void)state;
    static const float positions[12] = {-1, 0, 0.2f, 1.2f, 0.4f,  -0.3f,
                                        -1, 1, 0.2f, 1.4f, -0.4f, 0.3f};
    static const uint32_t indices[2] = {1, 0};
    place_moving(round_mesh(PPM_PRIMITIVE_LINES, positions, 2, indices, 1, 0.6f, 2),
                 vec3_splat(0.0f));
    assert_rays_agree(vec3(1.5f, 0.5f, -0.5f), 6.0f, TEST_EFFORT(20000));
}

/* From inside the far side is met, with the normal outwards: solids need that. */
static void balls_and_segments_are_met_from_inside(void **state)
{
    (void)state;
    static const float positions[9] = {0, 0, 0, 5, 0, 0, 7, 0, 0};
    static const uint32_t ball = 0, line[2] = {1, 2};
    shape_place(test.scene, round_mesh(PPM_PRIMITIVE_POINTS, positions, 3, &ball, 1, 1.0f, 1));
    shape_place(test.scene, round_mesh(PPM_PRIMITIVE_LINES, positions, 3, line, 1, 1.0f, 1));
    test_world world;
    world_open(&world, &test);
    const ppmi_vec3 centers[2] = {vec3_splat(0.0f), vec3(6, 0, 0)};
    for (int i = 0; i < 2; i++) {
        const ppmi_vec3 up = vec3_normalize(vec3(0, 1, 0.2f));
        const ppmi_ray ray = {.origin = centers[i], .t_max = INFINITY, .direction = up};
        ppmi_hit hit;
        ppmi_surface surface;
        assert_true(ppmi_accel_intersect(world.accel, &ray, &hit));
        ppmi_surface_from_hit(test.scene, &hit, &surface);
        assert_near(hit.t, 1.0, 1e-5);
        assert_near(vec3_dot(surface.ng, up), 1.0, 1e-5);
        ppmi_hit all[8];
        const ppmi_ray through = {
            .origin = vec3_mad(centers[i], up, -3.0f), .t_max = INFINITY, .direction = up};
        const uint32_t count = ppmi_accel_intersect_all(world.accel, &through, all, 8);
        assert_int_equal(count, 2);
        assert_near(all[0].t, 2.0, 1e-5);
        assert_near(all[1].t, 4.0, 1e-5);
    }
    world_close(&world);
}

/* Whatever the element: places are even over the area. By the mean of the position and its square
 * on a segment, whose integrals are known. */
static void places_on_segments_are_drawn_evenly(void **state)
{
    (void)state;
    static const float positions[6] = {0, 0, 0, 0, 0, 2};
    static const uint32_t line[2] = {0, 1};
    const float radius = 0.5f;
    round_mesh(PPM_PRIMITIVE_LINES, positions, 2, line, 1, radius, 1);
    const ppmi_round round = ppmi_round_of(&test.scene->meshes[0].primitives[0], 0, 0.0f);
    assert_near(ppmi_round_area(&round), 2 * PPMI_PI * 0.5 * 3.0, 1e-5);
    test_mean along = {0}, square = {0};
    ppmi_rng rng = ppmi_rng_start(3, 1, 0);
    for (uint32_t i = 0; i < TEST_EFFORT(40000); i++) {
        float u, v;
        ppmi_round_sample(&round, ppmi_rng_float(&rng), ppmi_rng_float(&rng), &u, &v);
        const ppmi_round_point point = ppmi_round_at(&round, u, v);
        const float z = point.position.z - 1.0f;
        mean_add(&along, (double)z);
        mean_add(&square, (double)(z * z));
        assert_true(vec3_length(vec3_sub(point.position, vec3(0, 0, point.along * 2.0f))) <
                    radius * 1.0001f);
    }
    test_family family = {0};
    /* Archimedes: z is even over -1.5 .. 1.5 */
    family_add_mean(&family, &along, 0.0, 0.0, "z");
    family_add_mean(&family, &square, 0.75, 0.0, "z squared");
    family_check(&family);
}

static void structures_are_built_for_what_changes_only(void **state)
{
    (void)state;
    const ppm_mesh_id box = shape_box(test.scene, 0, vec3_splat(-1), vec3_splat(1), 1, false);
    const ppm_mesh_id ball = shape_sphere(test.scene, 0, 1.0f, 8, true);
    const ppm_mesh_id unseen = shape_sphere(test.scene, 0, 1.0f, 8, true);
    const ppm_instance_id first = shape_place(test.scene, box);
    shape_place_at(test.scene, ball, vec3(4, 0, 0));
    const ppm_instance_id later = shape_place_at(test.scene, unseen, vec3(8, 0, 0));
    assert_int_equal(ppm_scene_set_instance_visible(test.scene, later, 0), PPM_STATUS_OK);
    const uint64_t expected[] = {2, 2, 3, 4, 4};
    const ppmi_primitive *primitive = &test.scene->meshes[box - 1].primitives[0];
    for (int frame = 0; frame < 5; frame++) {
        if (frame == 1) {
            ppm_instance_desc moved = {.size = sizeof moved};
            pose(1.0f, vec3_splat(1.0f), vec3(0, 2, 0), moved.transform);
            assert_int_equal(ppm_scene_set_instance(test.scene, first, &moved), PPM_STATUS_OK);
        } else if (frame == 2) {
            const ppm_primitive_desc vertices = {.vertex_count = primitive->vertex_count,
                                                 .positions = primitive->positions};
            assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, box, 0, &vertices),
                             PPM_STATUS_OK);
        } else if (frame == 3) {
            assert_int_equal(ppm_scene_set_instance_visible(test.scene, later, 1), PPM_STATUS_OK);
        }
        ppmi_accel *accel = NULL;
        ppmi_scene_freeze(test.scene);
        assert_int_equal(ppmi_accel_create(test.context, test.scene, &accel), PPM_STATUS_OK);
        assert_int_equal(ppmi_accel_builds(test.scene), expected[frame]);
        ppmi_accel_destroy(accel);
        ppmi_scene_thaw(test.scene);
    }
}

/* Within the hull of the steps, but never less than where it goes. */
static void bounds_hold_what_moves_over_the_whole_shutter(void **state)
{
    (void)state;
    static const float positions[6] = {0, 0, 0, 0, 4, 0};
    static const uint32_t index = 0;
    float motion[32];
    pose(0.0f, vec3_splat(1.0f), vec3(-3, 0, 0), motion);
    pose(0.0f, vec3_splat(1.0f), vec3(5, 0, 0), motion + 16);
    const ppm_instance_desc desc = {
        .size = sizeof desc,
        .mesh = round_mesh(PPM_PRIMITIVE_POINTS, positions, 1, &index, 1, 0.5f, 2),
        .motion_steps = 2,
        .motion = motion};
    ppm_instance_id id;
    assert_int_equal(ppm_scene_add_instance(test.scene, &desc, &id), PPM_STATUS_OK);
    float low[3], high[3];
    assert_int_equal(ppm_scene_instance_bounds(test.scene, id, low, high), PPM_STATUS_OK);
    assert_near(low[0], -3.5, 1e-6);
    assert_near(high[0], 5.5, 1e-6);
    assert_near(low[1], -0.5, 1e-6);
    assert_near(high[1], 4.5, 1e-6);
    assert_true(ppmi_scene_moves(test.scene));
    assert_int_equal(ppm_scene_set_instance_visible(test.scene, id, 0), PPM_STATUS_OK);
    assert_false(ppmi_scene_moves(test.scene));
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(rays_meet_a_turning_box_where_it_is_and_leave_it_for_good),
        WITH_SCENE(so_do_they_far_from_the_origin),
        WITH_SCENE(rays_meet_a_deforming_shape_where_it_is_and_leave_it_for_good),
        WITH_SCENE(rays_meet_a_moving_ball_where_it_is_and_leave_it_for_good),
        WITH_SCENE(rays_meet_a_moving_segment_where_it_is_and_leave_it_for_good),
        WITH_SCENE(balls_and_segments_are_met_from_inside),
        WITH_SCENE(places_on_segments_are_drawn_evenly),
        WITH_SCENE(structures_are_built_for_what_changes_only),
        WITH_SCENE(bounds_hold_what_moves_over_the_whole_shutter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
