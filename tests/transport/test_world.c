/* Steps of paths: visibility, surfaces with alpha, attenuation, the walker's numbers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/solid.h"

static test_scene test;
static test_world world;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    world_close(&world);
    scene_close(&test);
    return 0;
}

static void add_veil(float z, float alpha, uint32_t double_sided)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.alpha_mode = alpha < 1.0f ? PPM_ALPHA_BLEND : PPM_ALPHA_OPAQUE;
    desc.base_color[3] = alpha;
    desc.double_sided = double_sided;
    add_quad(test.scene, material_add(test.scene, &desc), vec3(-1, -1, z), vec3(2, 0, 0),
             vec3(0, 2, 0));
}

static ppmi_walker walker_of(uint64_t index)
{
    ppmi_walker walker = {.world = &world.world};
    ppmi_walker_start(&walker, ppmi_rng_start(1, PPMI_STREAM_EYE, index), 1, (uint32_t)index, 0, 2);
    return walker;
}

static const ppmi_ray ahead = {
    .origin = {0.3f, 0.2f, 0.0f}, .t_max = INFINITY, .direction = {0.0f, 0.0f, -1.0f}};

static void visibility_is_the_product_of_what_veils_leave(void **state)
{
    (void)state;
    add_veil(-1.0f, 0.5f, 1);
    add_veil(-2.0f, 0.2f, 1);
    add_veil(-5.0f, 1.0f, 1);
    world_open(&world, &test);
    ppmi_walker walker = walker_of(0);
    const float ends[] = {0.5f, 1.5f, 4.5f, 6.0f, INFINITY};
    const double expected[] = {1.0, 0.5, 0.4, 0.0, 0.0};
    for (int i = 0; i < 5; i++) {
        ppmi_ray ray = ahead;
        ray.t_max = ends[i];
        assert_near(ppmi_walk_visibility(&walker, ray, &walker.interior).x, expected[i], 1e-6);
    }
}

/* Straight light through a thin sheet of index 1.5: 1 - 2 R / (1 + R), R = 0.04. */
static void visibility_has_what_sheets_let_straight_through(void **state)
{
    (void)state;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission_kind = PPM_TRANSMISSION_THIN;
    desc.metallic = 0.0f;
    const float roughness[] = {0.0f, 0.0f, 0.0f, 0.4f}, transmission[] = {1.0f, 1.0f, 0.5f, 1.0f};
    for (int i = 0; i < 4; i++) {
        desc.roughness = roughness[i];
        desc.transmission = transmission[i];
        desc.base_color[1] = 0.5f;
        desc.base_color[2] = i == 1 ? 0.0f : 1.0f;
        desc.alpha_mode = i == 2 ? PPM_ALPHA_BLEND : PPM_ALPHA_OPAQUE;
        desc.base_color[3] = 0.25f;
        add_quad(test.scene, material_add(test.scene, &desc), vec3(-1, -1, -1.0f - (float)i),
                 vec3(2, 0, 0), vec3(0, 2, 0));
    }
    world_open(&world, &test);
    const double clear = 1.0 - 0.08 / 1.04, half = 0.75 + 0.25 * 0.5 * clear,
                 green = 0.75 + 0.25 * 0.25 * clear;
    const double expected[4][3] = {{clear, 0.5 * clear, clear},
                                   {clear * clear, 0.25 * clear * clear, 0.0},
                                   {clear * clear * half, 0.25 * clear * clear * green, 0.0},
                                   {0.0, 0.0, 0.0}};
    ppmi_walker walker = walker_of(0);
    for (int i = 0; i < 4; i++) {
        ppmi_ray ray = ahead;
        ray.t_max = 1.5f + (float)i;
        const ppmi_vec3 seen = ppmi_walk_visibility(&walker, ray, &walker.interior);
        assert_near(seen.x, expected[i][0], 1e-6);
        assert_near(seen.y, expected[i][1], 1e-6);
        assert_near(seen.z, expected[i][2], 1e-6);
    }
}

static void paths_stop_at_a_veil_as_often_as_it_is_opaque(void **state)
{
    (void)state;
    add_veil(-1.0f, 0.5f, 1);
    add_veil(-2.0f, 0.2f, 1);
    add_veil(-5.0f, 1.0f, 1);
    world_open(&world, &test);
    const uint32_t count = TEST_EFFORT(50000);
    double observed[3] = {0.0};
    const double expected[3] = {0.5 * count, 0.1 * count, 0.4 * count};
    for (uint32_t i = 0; i < count; i++) {
        ppmi_walker walker = walker_of(i);
        ppmi_vertex vertex;
        assert_int_equal(ppmi_walk(&walker, ahead, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
        observed[vertex.hit.instance] += 1.0;
        const double depth = vertex.hit.instance == 2 ? 5.0 : vertex.hit.instance + 1.0;
        assert_near(vertex.distance, depth, 1e-4); /* along all segments */
    }
    test_family family = {0};
    family_add(&family, p_counts(observed, expected, 3), "veils");
    family_check(&family);
}

static void only_camera_rays_see_through_backs(void **state)
{
    (void)state;
    add_veil(-1.0f, 1.0f, 0); /* faces +z */
    world_open(&world, &test);
    const ppmi_ray from_behind = {
        .origin = {0.3f, 0.2f, -2.0f}, .t_max = INFINITY, .direction = {0.0f, 0.0f, 1.0f}};
    ppmi_walker walker = walker_of(0);
    ppmi_vertex vertex;
    assert_int_equal(ppmi_walk(&walker, ahead, PPMI_RAY_CAMERA, &vertex), PPMI_AT_SURFACE);
    assert_int_equal(ppmi_walk(&walker, from_behind, PPMI_RAY_CAMERA, &vertex), PPMI_ESCAPED);
    assert_int_equal(ppmi_walk(&walker, from_behind, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
    assert_near(ppmi_walk_visibility(&walker, from_behind, &walker.interior).x, 0.0, 0.0);
}

/* One sheet that faces the camera and one that faces away, in the very same place. */
static void add_shell(float alpha)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.alpha_mode = alpha < 1.0f ? PPM_ALPHA_BLEND : PPM_ALPHA_OPAQUE;
    desc.base_color[3] = alpha;
    desc.double_sided = 0;
    const uint32_t material = material_add(test.scene, &desc);
    const ppmi_vec3 corner = vec3(-1.1f, -0.9f, -3.3f), a = vec3(2.3f, 0.2f, 1.1f),
                    b = vec3(-0.1f, 2.1f, 0.7f);
    add_quad(test.scene, material, corner, b, a); /* faces away */
    add_quad(test.scene, material, corner, a, b);
}

/* How many of count camera rays through the shell end at it; all that do see its front. */
static double count_stopped_by_shell(uint32_t count)
{
    double stopped = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        ppmi_walker walker = walker_of(i);
        const float u = ppmi_rng_float(&walker.rng), v = ppmi_rng_float(&walker.rng);
        ppmi_ray ray = {.origin = {0.0f, 0.0f, 1.0f}, .t_max = INFINITY};
        ray.direction = vec3_normalize(vec3(0.4f * u - 0.2f, 0.4f * v - 0.2f, -1.0f));
        ppmi_vertex vertex;
        if (ppmi_walk(&walker, ray, PPMI_RAY_CAMERA, &vertex) == PPMI_ESCAPED) continue;
        assert_true(vec3_dot(vertex.surface.ng, ray.direction) < 0.0f);
        const ppmi_vec3 there = vec3_mad(ray.origin, ray.direction, vertex.distance);
        assert_near(vec3_length(vec3_sub(there, vertex.surface.position)), 0.0, 1e-5);
        stopped += 1.0;
    }
    return stopped;
}

static void the_camera_sees_the_front_that_lies_on_a_back(void **state)
{
    (void)state;
    add_shell(1.0f);
    world_open(&world, &test);
    assert_near(count_stopped_by_shell(2000), 2000.0, 0.0);
}

static void a_front_that_lies_on_a_back_stops_as_often_as_it_is_opaque(void **state)
{
    (void)state;
    const uint32_t count = TEST_EFFORT(20000);
    double observed[2];
    const double expected[2] = {0.3 * count, 0.7 * count};
    add_shell(0.3f);
    world_open(&world, &test);
    observed[0] = count_stopped_by_shell(count);
    observed[1] = count - observed[0];
    test_family family = {0};
    family_add(&family, p_counts(observed, expected, 2), "stopped");
    family_check(&family);
}

static ppm_material_id masked(float alpha)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.alpha_mode = PPM_ALPHA_MASK;
    desc.base_color[3] = alpha;
    desc.double_sided = 1;
    return material_add(test.scene, &desc);
}

/* A clear sheet on a wall, nearer than a float knows, and far from the origin. */
static void nothing_is_jumped_over_behind_what_is_clear(void **state)
{
    const float gaps[] = {0.0f, 1e-7f, 1e-5f, 1e-3f}, offsets[] = {0.0f, 1000.0f};
    for (int i = 0; i < 8; i++) {
        if (i > 0) {
            close_scene(state);
            open_scene(state);
        }
        const float x = offsets[i / 4], gap = gaps[i % 4];
        const ppmi_vec3 a = vec3(2.1f, 0.2f, 0.3f), b = vec3(-0.1f, 2.2f, 0.4f);
        add_quad(test.scene, masked(0.0f), vec3(x - 1.1f, -1.2f, gap), a, b);
        add_quad(test.scene, masked(1.0f), vec3(x - 1.1f, -1.2f, 0.0f), a, b);
        /* keeps the offset: a scene that is far for its size is moved */
        add_quad(test.scene, masked(1.0f), vec3(-x, -500, -500), vec3(0, 0.1f, 0),
                 vec3(0, 0, 0.1f));
        world_open(&world, &test);
        for (uint32_t k = 0; k < 500; k++) {
            ppmi_walker walker = walker_of(k);
            const float u = ppmi_rng_float(&walker.rng), v = ppmi_rng_float(&walker.rng);
            const ppmi_ray ray = {.origin = {x, 0.0f, 4.0f},
                                  .t_max = INFINITY,
                                  .direction =
                                      vec3_normalize(vec3(0.3f * u - 0.15f, 0.3f * v, -1.0f))};
            ppmi_vertex vertex;
            assert_int_equal(
                ppmi_walk(&walker, ray, k % 2 ? PPMI_RAY_CAMERA : PPMI_RAY_OTHER, &vertex),
                PPMI_AT_SURFACE);
            assert_int_equal(vertex.hit.instance, 1);
            assert_near(ppmi_walk_visibility(&walker, ray, &walker.interior).x, 0.0, 0.0);
        }
    }
}

static void any_number_of_clear_layers_is_passed(void **state)
{
    (void)state;
    for (int i = 0; i < 3000; i++)
        add_veil(-1.0f - 1e-3f * (float)i, i % 1000 == 999 ? 0.5f : 0.0f, 1);
    add_veil(-5.0f, 1.0f, 1);
    world_open(&world, &test);
    ppmi_walker walker = walker_of(0);
    ppmi_ray ray = ahead;
    ray.t_max = 4.5f;
    assert_near(ppmi_walk_visibility(&walker, ray, &walker.interior).x, 0.125, 1e-6);
    uint32_t arrived = 0;
    for (uint32_t k = 0; k < 800; k++) {
        ppmi_vertex vertex;
        walker = walker_of(k);
        assert_int_equal(ppmi_walk(&walker, ahead, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
        arrived += vertex.hit.instance == 3000;
    }
    assert_true(arrived > 55 && arrived < 150); /* 100 of 800, within five deviations */
}

/* Neither entered, nor one that the camera stands in. */
static void a_solid_that_is_cut_away_is_not_there(void **state)
{
    (void)state;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.transmission_kind = PPM_TRANSMISSION_SOLID;
    desc.attenuation_color[0] = 0.5f;
    desc.attenuation_distance_m = 2.0f;
    desc.alpha_mode = PPM_ALPHA_MASK;
    desc.base_color[3] = 0.0f;
    shape_place(test.scene, shape_box(test.scene, material_add(test.scene, &desc), vec3(-1, -1, -5),
                                      vec3(1, 1, -1), 1, false));
    add_veil(-3.0f, 1.0f, 1);
    world_open(&world, &test);
    ppmi_walker walker = walker_of(0);
    ppmi_vertex vertex;
    assert_int_equal(ppmi_walk(&walker, ahead, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
    assert_int_equal(vertex.hit.instance, 1);
    assert_near(vertex.transmittance.x, 1.0, 0.0);
    assert_int_equal(walker.interior.count, 0);
    assert_int_equal(ppmi_solids_around(&world.world, vec3(0, 0, -4)).count, 0);
}

static void a_solid_attenuates_on_the_way_out_only(void **state)
{
    (void)state;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.attenuation_color[0] = 0.5f;
    desc.attenuation_distance_m = 2.0f;
    shape_place(test.scene, shape_box(test.scene, material_add(test.scene, &desc), vec3(-1, -1, -5),
                                      vec3(1, 1, -1), 1, false));
    world_open(&world, &test);
    ppmi_walker walker = walker_of(0);
    ppmi_vertex vertex;
    assert_int_equal(ppmi_walk(&walker, ahead, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
    assert_near(vertex.transmittance.x, 1.0, 0.0);
    const ppmi_ray inside = ppmi_surface_ray(&vertex.surface, ahead.direction);
    assert_int_equal(ppmi_walk(&walker, inside, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
    assert_near(vertex.transmittance.x, 0.25, 1e-5);
    assert_near(vertex.transmittance.y, 1.0, 0.0);
}

/* Paths of one index draw the same numbers; the stratified ones come first. */
static void a_walker_draws_the_same_numbers_again(void **state)
{
    (void)state;
    add_veil(-1.0f, 1.0f, 1);
    world_open(&world, &test);
    ppmi_walker a = walker_of(7), b = walker_of(7), c = walker_of(8);
    const ppmi_sample4 first = ppmi_sobol4(7, 0, 1);
    int differences = 0;
    for (int i = 0; i < 20; i++) {
        const uint32_t x = ppmi_walker_u32(&a);
        assert_int_equal(x, ppmi_walker_u32(&b));
        differences += x != ppmi_walker_u32(&c);
        if (i < 4) assert_int_equal(x, first.bits[i]);
    }
    assert_true(differences >= 19);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(visibility_is_the_product_of_what_veils_leave),
        WITH_SCENE(visibility_has_what_sheets_let_straight_through),
        WITH_SCENE(paths_stop_at_a_veil_as_often_as_it_is_opaque),
        WITH_SCENE(only_camera_rays_see_through_backs),
        WITH_SCENE(the_camera_sees_the_front_that_lies_on_a_back),
        WITH_SCENE(a_front_that_lies_on_a_back_stops_as_often_as_it_is_opaque),
        WITH_SCENE(nothing_is_jumped_over_behind_what_is_clear),
        WITH_SCENE(any_number_of_clear_layers_is_passed),
        WITH_SCENE(a_solid_that_is_cut_away_is_not_there),
        WITH_SCENE(a_solid_attenuates_on_the_way_out_only),
        WITH_SCENE(a_walker_draws_the_same_numbers_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
