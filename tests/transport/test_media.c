/* Which part of a ray lies in which medium. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/media.h"

static test_scene test;
static test_world world;
static uint32_t glass_index;

static const ppmi_interior outside = {0};

/* Fog in the ball around a cube from (9, -1, -1) to (11, 1, 1) of glass that absorbs. */
static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.attenuation_color[0] = 0.5f;
    desc.attenuation_distance_m = 2.0f;
    shape_place(test.scene, shape_box(test.scene, material_add(test.scene, &desc), vec3(9, -1, -1),
                                      vec3(11, 1, 1), 1, false));
    scene_fog(test.scene, vec3(0.1f, 0.2f, 0.3f), vec3(0.3f, 0.1f, 0.0f), 0.0f);
    world_open(&world, &test);
    const ppm_scene *scene = test.scene;
    glass_index = scene->meshes[scene->instances[0].mesh].primitives[0].material;
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    world_close(&world);
    scene_close(&test);
    return 0;
}

static const float fog_radius = 1.7320508f;

static ppmi_medium_span span_of(const ppmi_interior *interior, ppmi_vec3 origin, float t_max)
{
    const ppmi_ray ray = {.origin = origin, .t_max = t_max, .direction = {1.0f, 0.0f, 0.0f}};
    return ppmi_media_span(&world.world, interior, &ray, t_max);
}

static void fog_fills_its_ball_and_no_more(void **state)
{
    (void)state;
    const ppmi_medium_span whole = span_of(&outside, vec3(0, 0, 0), INFINITY);
    assert_ptr_equal(whole.medium, &test.scene->fog);
    assert_near(whole.begin, 10.0f - fog_radius, 1e-3);
    assert_near(whole.end, 10.0f + fog_radius, 1e-3);
    const ppmi_medium_span chord = span_of(&outside, vec3(0, 1, 0), INFINITY);
    assert_near(chord.end - chord.begin, 2.0 * sqrt(2.0), 1e-3);
}

static void rays_beside_before_or_behind_the_ball_are_clear(void **state)
{
    (void)state;
    assert_null(span_of(&outside, vec3(0, 1.74f, 0), INFINITY).medium);
    assert_null(span_of(&outside, vec3(0, 0, 0), 8.2f).medium);
    assert_null(span_of(&outside, vec3(11.8f, 0, 0), INFINITY).medium);
}

static void spans_begin_and_end_with_the_ray(void **state)
{
    (void)state;
    const ppmi_medium_span inside = span_of(&outside, vec3(10, 0, 0), 0.5f);
    assert_ptr_equal(inside.medium, &test.scene->fog);
    assert_near(inside.begin, 0.0, 0.0);
    assert_near(inside.end, 0.5, 0.0);
}

/* From far away the ball is where it was: no difference of large squares. */
static void a_far_origin_keeps_the_chord(void **state)
{
    (void)state;
    const ppmi_medium_span far = span_of(&outside, vec3(-20000, 1, 0), INFINITY);
    assert_near(far.end - far.begin, 2.0 * sqrt(2.0), 0.01);
}

static void there_is_no_fog_in_solids(void **state)
{
    (void)state;
    ppmi_interior interior = {0};
    ppmi_interior_enter(&interior, glass_index);
    const ppmi_medium_span span = span_of(&interior, vec3(9.5f, 0, 0), 1.0f);
    assert_ptr_equal(span.medium, &test.scene->materials[glass_index].inside);
    assert_near(span.end - span.begin, 1.0, 0.0);
    const ppmi_vec3 transmittance = ppmi_medium_transmittance(span.medium, 1.0f);
    assert_near(transmittance.x, sqrt(0.5), 1e-6);
    assert_near(transmittance.y, 1.0, 0.0);
}

/* An open water sheet has no far side: what never ends is taken as empty. */
static void a_solid_without_an_end_is_empty(void **state)
{
    (void)state;
    ppmi_interior interior = {0};
    ppmi_interior_enter(&interior, glass_index);
    assert_null(span_of(&interior, vec3(9.5f, 0, 0), INFINITY).medium);
}

/* Shadow rays go through the same media as paths, up to their end. */
static void visibility_has_the_transmittance_of_the_way(void **state)
{
    (void)state;
    ppmi_walker walker = {.world = &world.world};
    ppmi_walker_start(&walker, ppmi_rng_start(1, PPMI_STREAM_EYE, 0), 1, 0, 0, 0);
    const ppmi_ray ray = {.origin = {0, 0, 1.2f}, .t_max = INFINITY, .direction = {1, 0, 0}};
    const double chord = 2.0 * sqrt(3.0 * 1.0002 - 1.44);
    const ppmi_vec3 all = ppmi_walk_visibility(&walker, ray, &outside);
    assert_near(all.x, exp(-0.4 * chord), 1e-4);
    assert_near(all.y, exp(-0.3 * chord), 1e-4);
    assert_near(all.z, exp(-0.3 * chord), 1e-4);
    ppmi_ray half = ray;
    half.t_max = 10.0f;
    assert_near(ppmi_walk_visibility(&walker, half, &outside).x, exp(-0.2 * chord), 1e-4);
}

/* Paths are scattered with the same law: as many arrive as light does, by their weights. */
static void walks_arrive_as_light_does(void **state)
{
    (void)state;
    const ppmi_ray ray = {.origin = {0, 0, 1.2f}, .t_max = INFINITY, .direction = {1, 0, 0}};
    const double chord = 2.0 * sqrt(3.0 * 1.0002 - 1.44);
    const double sigma_t[3] = {0.4, 0.3, 0.3};
    test_mean arrived[3] = {{0}}, fluence[3] = {{0}};
    test_family family = {0};
    for (uint32_t i = 0; i < TEST_EFFORT(60000); i++) {
        ppmi_walker walker = {.world = &world.world};
        ppmi_walker_start(&walker, ppmi_rng_start(1, PPMI_STREAM_EYE, i), 1, i, 0, 0);
        ppmi_vertex vertex;
        const bool escaped = ppmi_walk(&walker, ray, PPMI_RAY_OTHER, &vertex) == PPMI_ESCAPED;
        const float w[3] = {vertex.transmittance.x, vertex.transmittance.y, vertex.transmittance.z};
        if (!escaped) {
            assert_true(vertex.surface.position.x > 8.2f && vertex.surface.position.x < 11.8f);
            assert_near(vertex.surface.position.z, 1.2, 1e-6);
            assert_near(vertex.distance, vertex.surface.position.x, 1e-4);
        }
        for (int k = 0; k < 3; k++) {
            mean_add(&arrived[k], escaped ? (double)w[k] : 0.0);
            mean_add(&fluence[k], escaped ? 0.0 : (double)w[k]);
        }
    }
    for (int k = 0; k < 3; k++) {
        const double through = exp(-sigma_t[k] * chord);
        mean_check_power(&arrived[k], 0.01);
        mean_check_power(&fluence[k], 0.01);
        family_add_mean(&family, &arrived[k], through, 1e-4, "arrived, channel %d", k);
        family_add_mean(&family, &fluence[k], (1.0 - through) / sigma_t[k], 1e-4, "fluence %d", k);
    }
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(fog_fills_its_ball_and_no_more),
        WITH_SCENE(rays_beside_before_or_behind_the_ball_are_clear),
        WITH_SCENE(spans_begin_and_end_with_the_ray),
        WITH_SCENE(a_far_origin_keeps_the_chord),
        WITH_SCENE(there_is_no_fog_in_solids),
        WITH_SCENE(a_solid_without_an_end_is_empty),
        WITH_SCENE(visibility_has_the_transmittance_of_the_way),
        WITH_SCENE(walks_arrive_as_light_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
