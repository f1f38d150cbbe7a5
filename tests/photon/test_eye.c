/* Eye paths: what they see, where they gather, and that following all branches means the same as
 * drawing one. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "photon/eye.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;
static ppmi_visible_points points;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    ppmi_visible_points_deinit(test.context, &points);
    points = (ppmi_visible_points){0};
    world_close(&world);
    scene_close(&test);
    return 0;
}

/* A ceiling, a floor, and a horizontal sheet or slab of glass between them; the ray comes from the
 * left at a slant and goes to both. */
static void open_sheet(int32_t kind, float radiance_up, float radiance_down)
{
    ppm_scene *scene = test.scene;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    desc.transmission_kind = kind;
    add_quad(scene, material_add(scene, &desc), vec3(-9, 0, -9), vec3(0, 0, 18), vec3(18, 0, 0));
    add_quad(scene, material_emitter(scene, radiance_up, 0.4f, true), vec3(-90, 2, -90),
             vec3(180, 0, 0), vec3(0, 0, 180));
    add_quad(scene, material_emitter(scene, radiance_down, 0.4f, true), vec3(-90, -2, -90),
             vec3(0, 0, 180), vec3(180, 0, 0));
    world_open(&world, &test);
}

static const ppmi_camera_ray slanting = {
    .ray = {.origin = {-1.9f, 1.0f, 0.0f}, .t_max = INFINITY, .direction = {0.8f, -0.6f, 0.0f}},
    .base_width = 1e-3f,
    .spread = 1e-3f};

static ppmi_vec3 look(uint64_t index, const ppmi_eye_settings *settings)
{
    ppmi_walker walker = {.world = &world.world};
    ppmi_walker_start(&walker, ppmi_rng_start(1, PPMI_STREAM_EYE, index), 1, (uint32_t)index, 0, 2);
    ppmi_vec3 radiance = vec3_splat(0.0f);
    assert_true(
        ppmi_eye_path(test.context, &walker, &slanting, settings, 7, &points, &radiance, NULL));
    return radiance;
}

static float total_throughput(float below_scale)
{
    float sum = 0.0f;
    for (size_t i = 0; i < points.count; i++) {
        const ppmi_visible_point *p = &points.points[i];
        assert_int_equal(p->owner, 7);
        sum += p->throughput.y * (p->position.y < 0.0f ? below_scale : 1.0f);
    }
    return sum;
}

/* Thin glass takes nothing: the branches' throughputs add up to 1. In solid glass the refracted
 * radiance is divided by the square of the index. */
static void branches_share_the_whole_throughput(void **state)
{
    (void)state;
    for (int32_t kind = PPM_TRANSMISSION_SOLID; kind <= PPM_TRANSMISSION_THIN; kind++) {
        if (kind != PPM_TRANSMISSION_SOLID) {
            close_scene(NULL);
            open_scene(NULL);
        }
        open_sheet(kind, 0.0f, 0.0f);
        const ppmi_eye_settings settings = {.max_depth = 10, .split_depth = 4};
        look(0, &settings);
        assert_int_equal(points.count, 2);
        assert_near(total_throughput(kind == PPM_TRANSMISSION_SOLID ? 2.25f : 1.0f), 1.0, 1e-5);
        const float y0 = points.points[0].position.y, y1 = points.points[1].position.y;
        assert_near(ppmi_max(y0, y1), 2.0, 1e-4);
        assert_near(ppmi_min(y0, y1), -2.0, 1e-4);
    }
}

static void without_splitting_there_is_one_point(void **state)
{
    (void)state;
    open_sheet(PPM_TRANSMISSION_THIN, 0.0f, 0.0f);
    const ppmi_eye_settings settings = {.max_depth = 10};
    double observed[2] = {0.0};
    const uint32_t count = TEST_EFFORT(20000);
    for (uint32_t i = 0; i < count; i++) {
        points.count = 0;
        look(i, &settings);
        assert_int_equal(points.count, 1);
        assert_near(points.points[0].throughput.y, 1.0, 1e-5);
        observed[points.points[0].position.y < 0.0f] += 1.0;
    }
    const double cosine = 0.6, inside = sqrt(1.0 - 0.64 / 2.25);
    const double s = (cosine - 1.5 * inside) / (cosine + 1.5 * inside);
    const double p = (1.5 * cosine - inside) / (1.5 * cosine + inside);
    const double r = 0.5 * (s * s + p * p), sheet = 2.0 * r / (1.0 + r);
    const double expected[2] = {sheet * count, (1.0 - sheet) * count};
    test_family family = {0};
    family_add(&family, p_counts(observed, expected, 2), "up and down");
    family_check(&family);
}

/* Emission through both branches: exactly their sum when split, as a mean when drawn. */
static void split_paths_have_the_mean_of_drawn_ones(void **state)
{
    (void)state;
    open_sheet(PPM_TRANSMISSION_SOLID, 8.0f, 3.0f);
    const ppmi_eye_settings split = {.max_depth = 10, .split_depth = 4};
    const ppmi_eye_settings drawn = {.max_depth = 10};
    const ppmi_vec3 both = look(0, &split);
    test_mean mean = {0};
    for (uint32_t i = 0; i < TEST_EFFORT(50000); i++)
        mean_add(&mean, (double)look(i, &drawn).y);
    mean_check_power(&mean, 0.01);
    test_family family = {0};
    family_add_mean(&family, &mean, (double)both.y, 1e-5, "radiance");
    family_check(&family);
}

/* A glossy coat over a diffuse base, with lights sampled: gathering and going on at once, or one of
 * them by chance. Emission is all that is met. */
static void split_coats_have_the_mean_of_drawn_ones(void **state)
{
    (void)state;
    ppm_scene *scene = test.scene;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.roughness = 0.3f; /* narrow: not gathered, not a mirror */
    add_quad(scene, material_add(scene, &desc), vec3(-9, 0, -9), vec3(0, 0, 18), vec3(18, 0, 0));
    add_quad(scene, material_emitter(scene, 4.0f, 0.0f, true), vec3(-1, 2, -3), vec3(6, 0, 0),
             vec3(0, 0, 6));
    world_open(&world, &test);
    test_mean means[2] = {{0}};
    double throughput[2] = {0.0};
    const uint32_t count = TEST_EFFORT(60000);
    for (int k = 0; k < 2; k++) {
        const ppmi_eye_settings settings = {
            .max_depth = 10, .split_depth = k == 0 ? 4 : 0, .samples_lights = true};
        points.count = 0;
        for (uint32_t i = 0; i < count; i++)
            mean_add(&means[k], (double)look(i, &settings).y);
        throughput[k] = (double)total_throughput(1.0f) / count;
        mean_check_power(&means[k], 0.01);
    }
    const double error = hypot(mean_error(&means[0]), mean_error(&means[1]));
    test_family family = {0};
    family_add(&family, p_normal((means[0].mean - means[1].mean) / error),
               "split %g, drawn %g, error %g", means[0].mean, means[1].mean, error);
    family_check(&family);
    assert_near(throughput[0], 1.0, 1e-5);
    assert_near(throughput[1], 1.0, 0.02); /* by chance: 1 / p as often as p */
}

/* No more branches than may wait: a stack of sheets, deeper than any split. */
static void a_stack_of_sheets_does_not_overflow(void **state)
{
    (void)state;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    desc.ior = 3.0f;
    desc.transmission_kind = PPM_TRANSMISSION_THIN;
    const ppm_material_id glass = material_add(test.scene, &desc);
    for (int i = 0; i < 8; i++)
        add_quad(test.scene, glass, vec3(-90, -0.1f * (float)i, -90), vec3(0, 0, 180),
                 vec3(180, 0, 0));
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-90, -2, -90), vec3(0, 0, 180),
             vec3(180, 0, 0));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    world_open(&world, &test);
    const ppmi_eye_settings settings = {.max_depth = 200, .split_depth = PPMI_MAX_SPLIT_DEPTH};
    /* what goes back to the sky and what reaches the floor is all there is; roulette ends some */
    test_mean mean = {0};
    for (uint32_t i = 0; i < TEST_EFFORT(16000); i++) {
        points.count = 0;
        const float sky = look(i, &settings).y;
        mean_add(&mean, (double)(sky + total_throughput(1.0f)));
    }
    mean_check_power(&mean, 0.01);
    test_family family = {0};
    family_add_mean(&family, &mean, 1.0, 1e-4, "sky and floor");
    family_check(&family);
}

static void memory_that_is_out_is_reported(void **state)
{
    (void)state;
    open_sheet(PPM_TRANSMISSION_THIN, 0.0f, 0.0f);
    const ppmi_eye_settings settings = {.max_depth = 10, .split_depth = 4};
    ppmi_walker walker = {.world = &world.world};
    ppmi_walker_start(&walker, ppmi_rng_start(1, PPMI_STREAM_EYE, 0), 1, 0, 0, 2);
    ppmi_vec3 radiance = vec3_splat(0.0f);
    ppmi_alloc_fail_at(test.context, 1);
    assert_false(
        ppmi_eye_path(test.context, &walker, &slanting, &settings, 7, &points, &radiance, NULL));
    ppmi_alloc_fail_at(test.context, 0);
}

/* Photons of a pass times the area of the disk that they are gathered in: of a given radius it is
 * that one's, or shares would be of other densities than there are. */
static void narrow_lobes_share_by_the_disk_that_gathers(void **state)
{
    (void)state;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.metallic = 1.0f;
    desc.roughness = 0.3f;
    add_quad(test.scene, material_add(test.scene, &desc), vec3(-9, 0, -9), vec3(0, 0, 18),
             vec3(18, 0, 0));
    world_open(&world, &test);
    ppmi_eye_settings settings = {.max_depth = 10, .photons = 1000.0f, .radius_m = 0.05f};
    look(0, &settings);
    assert_int_equal(points.count, 1);
    assert_near(points.points[0].merge_area_m2, 1000.0 * 3.14159265 * 0.05 * 0.05, 1e-4);
    settings.radius_m = 0.0f;
    look(0, &settings);
    assert_int_equal(points.count, 2);
    const double radius_m = 2.0 * (double)points.points[1].footprint;
    assert_near(points.points[1].merge_area_m2, 1000.0 * 3.14159265 * radius_m * radius_m, 1e-6);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(branches_share_the_whole_throughput),
        WITH_SCENE(without_splitting_there_is_one_point),
        WITH_SCENE(split_paths_have_the_mean_of_drawn_ones),
        WITH_SCENE(split_coats_have_the_mean_of_drawn_ones),
        WITH_SCENE(a_stack_of_sheets_does_not_overflow),
        WITH_SCENE(narrow_lobes_share_by_the_disk_that_gathers),
        WITH_SCENE(memory_that_is_out_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
