/* Scenes whose radiance is the same everywhere, and known. */
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

enum { SEEDS = 16 };

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

static void compare(const char *name, int32_t integrator, uint64_t photons, float radius,
                    double expected, double systematic, double resolution)
{
    ppm_render_options options = render_options(integrator, 16, photons);
    options.radius_m = radius;
    const test_mean mean = render_green(test.scene, &options, 4, SEEDS);
    mean_check_power(&mean, resolution);
    family_add_mean(&family, &mean, expected, systematic * expected, "%s, integrator %d", name,
                    integrator);
}

/* Every wall shines with 1 and reflects half: 1 + 1/2 + 1/4 ... = 2. The camera looks at the middle
 * of a wall, so that no disk of photons reaches round a corner. */
static void a_closed_box_that_shines_has_twice_its_emission(void **state)
{
    (void)state;
    const ppm_material_id wall = material_emitter(test.scene, 1.0f, 0.5f, false);
    shape_place(test.scene, shape_box(test.scene, wall, vec3_splat(-1), vec3_splat(1), 1, true));
    camera_perspective(test.scene, vec3(0.1f, 0.0f, 0.5f), vec3(0, 0, -1), 0.6f);
    compare("box", PPM_INTEGRATOR_PATH, 0, 0.0f, 2.0, 1e-6, 0.003);
    compare("box, radius given", PPM_INTEGRATOR_SPPM, 20000, 0.1f, 2.0, 1e-6, 0.003);
    compare("box, kept eye paths", PPM_INTEGRATOR_PPM, 20000, 0.1f, 2.0, 1e-6, 0.005);
    compare("box, radius by footprint", PPM_INTEGRATOR_SPPM, 20000, 0.0f, 2.0, 1e-6, 0.01);
    family_check(&family);
}

/* Nothing but roulette ends the paths: with 32 bounces 3.9 of 5 would be there (emission 0.25 and
 * albedo 0.95). */
static void a_bright_room_has_all_its_bounces_by_default(void **state)
{
    (void)state;
    const ppm_material_id wall = material_emitter(test.scene, 0.25f, 0.95f, false);
    shape_place(test.scene, shape_box(test.scene, wall, vec3_splat(-1), vec3_splat(1), 1, true));
    camera_perspective(test.scene, vec3(0.1f, 0.0f, 0.5f), vec3(0, 0, -1), 0.6f);
    compare("bright", PPM_INTEGRATOR_PATH, 0, 0.0f, 5.0, 1e-5, 0.02);
    compare("bright", PPM_INTEGRATOR_SPPM, 2000, 0.2f, 5.0, 1e-5, 0.02);
    compare("bright, kept eye paths", PPM_INTEGRATOR_PPM, 2000, 0.2f, 5.0, 1e-5, 0.02);
    family_check(&family);
}

/* Walls of albedo 1 around a lamp have no picture, but paths must end: after 187 vertices on
 * average, and photons after 105. */
static void a_room_without_loss_ends(void **state)
{
    (void)state;
    const ppm_material_id wall = material_emitter(test.scene, 1.0f, 1.0f, false);
    shape_place(test.scene, shape_box(test.scene, wall, vec3_splat(-1), vec3_splat(1), 1, true));
    camera_perspective(test.scene, vec3(0.1f, 0.0f, 0.5f), vec3(0, 0, -1), 0.6f);
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
        ppm_render_options options = render_options(i, 16, 2000);
        options.aim = PPM_AIM_EVEN; /* photons that are learnt from are not counted as emitted */
        ppm_render *render = NULL;
        assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
        assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
        ppm_render_stats stats = {.size = sizeof stats};
        assert_int_equal(ppm_render_get_stats(render, &stats), PPM_STATUS_OK);
        /* a ray and a shadow ray a vertex; pilots send photons too */
        const uint64_t paths = stats.eye_paths + 3 * stats.photons_emitted;
        assert_true(stats.rays < 3 * 187 * paths);
        ppm_render_destroy(render);
    }
}

static void the_box_is_the_same_memoryless_and_in_epochs(void **state)
{
    (void)state;
    const ppm_material_id wall = material_emitter(test.scene, 1.0f, 0.5f, false);
    shape_place(test.scene, shape_box(test.scene, wall, vec3_splat(-1), vec3_splat(1), 1, true));
    camera_perspective(test.scene, vec3(0.1f, 0.0f, 0.5f), vec3(0, 0, -1), 0.6f);
    for (int i = 0; i < 4; i++) {
        const bool is_ppm = i % 2 == 1;
        ppm_render_options options =
            render_options(is_ppm ? PPM_INTEGRATOR_PPM : PPM_INTEGRATOR_SPPM, 16, 20000);
        options.radius_m = 0.1f;
        options.direct = i < 2 ? PPM_DIRECT_SAMPLE : PPM_DIRECT_PHOTONS;
        if (is_ppm) {
            options.photons_per_epoch = 40000;
        } else {
            options.schedule = PPM_SCHEDULE_MEMORYLESS;
        }
        const test_mean mean = render_green(test.scene, &options, 4, SEEDS);
        mean_check_power(&mean, 0.005);
        family_add_mean(&family, &mean, 2.0, 2e-6, "case %d", i);
    }
    family_check(&family);
}

/* White light on rough glass and on ceramic, at every roughness: never more than comes in. */
static void rough_glass_and_ceramic_are_not_brighter_than_the_sky(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        for (int step = 0; step <= 4; step++) {
            scene_close(&test);
            scene_open(&test);
            ppm_material_desc desc;
            ppm_material_desc_init(&desc);
            desc.transmission = kind == 0 ? 1.0f : 0.0f;
            desc.roughness = 0.25f * (float)step;
            shape_place(test.scene,
                        shape_sphere(test.scene, material_add(test.scene, &desc), 1.0f, 64, true));
            light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
            camera_orthographic(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 0.9f);
            for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
                ppm_render_options options = render_options(i, 16, 1000);
                options.radius_m = 0.05f;
                options.max_depth = 100;
                const test_mean mean = render_green(test.scene, &options, 4, SEEDS);
                mean_check_power(&mean, 0.02);
                /* 1 %: the albedo table (tests/shading) */
                family_add_at_most(&family, &mean, 1.01, "kind %d, roughness %g, integrator %d",
                                   kind, (double)desc.roughness, i);
                assert_true(mean.mean > 0.1); /* it may lose some: not all */
            }
        }
    }
    family_check(&family);
}

/* A convex body sees nothing but the surroundings. */
static void a_ball_in_the_open_has_its_reflectance(void **state)
{
    (void)state;
    const ppm_material_id grey = material_lambert(test.scene, 0.6f);
    shape_place(test.scene, shape_sphere(test.scene, grey, 1.0f, 64, true));
    light_environment(test.scene, vec3_splat(2.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 0.5f);
    /* smooth normals lean by up to pi / 128 from the facets: directions between the two planes are
     * lost, and the facets are no convex body with those normals */
    compare("ball", PPM_INTEGRATOR_PATH, 0, 0.0f, 1.2, 2e-3, 0.003);
    compare("ball", PPM_INTEGRATOR_SPPM, 1000, 0.05f, 1.2, 2e-3, 0.003);
    family_check(&family);
}

static void plastic_and_metal_that_are_white_vanish(void **state)
{
    (void)state;
    for (int metal = 0; metal < 2; metal++) {
        for (int rough = 0; rough < 3; rough++) {
            scene_close(&test);
            scene_open(&test);
            ppm_material_desc desc;
            ppm_material_desc_init(&desc);
            desc.metallic = (float)metal;
            desc.roughness = 0.5f * (float)rough;
            const ppm_material_id white = material_add(test.scene, &desc);
            shape_place(test.scene, shape_sphere(test.scene, white, 1.0f, 64, true));
            light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
            camera_orthographic(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 0.6f);
            /* 1 %: the albedo table (tests/shading) */
            compare(metal ? "metal" : "plastic", PPM_INTEGRATOR_PATH, 0, 0.0f, 1.0, 0.01, 0.005);
            compare(metal ? "metal" : "plastic", PPM_INTEGRATOR_SPPM, 1000, 0.05f, 1.0, 0.01,
                    0.005);
        }
    }
    family_check(&family);
}

/* Radiance in and out of glass: what is lost by 1 / n^2 going in comes back going out. */
static void glass_in_the_open_is_not_seen(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        scene_close(&test);
        scene_open(&test);
        ppm_material_desc desc;
        ppm_material_desc_init(&desc);
        desc.transmission = 1.0f;
        desc.roughness = 0.0f;
        desc.transmission_kind = kind == 2 ? PPM_TRANSMISSION_THIN : PPM_TRANSMISSION_SOLID;
        const ppm_material_id glass = material_add(test.scene, &desc);
        shape_place(test.scene, kind == 1 ? shape_box(test.scene, glass, vec3_splat(-1),
                                                      vec3_splat(1), 1, false)
                                          : shape_sphere(test.scene, glass, 1.0f, 64, true));
        light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
        camera_orthographic(test.scene, vec3(1, 2, 5), vec3(0, 0, 0), 1.5f);
        ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 16, 1000);
        for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
            options.integrator = i;
            options.max_depth = 1000; /* rays that are totally reflected in a cube stay long */
            const test_mean mean = render_green(test.scene, &options, 4, SEEDS);
            mean_check_power(&mean, 0.01);
            /* of the ball, rays absorbed where its smooth normals leave the facets: at the rim */
            const double lost = kind == 1 ? 0.0 : 3e-3;
            family_add_mean(&family, &mean, 1.0, lost, "kind %d, integrator %d", kind, i);
        }
    }
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_closed_box_that_shines_has_twice_its_emission),
        WITH_SCENE(a_bright_room_has_all_its_bounces_by_default),
        WITH_SCENE(a_room_without_loss_ends),
        WITH_SCENE(the_box_is_the_same_memoryless_and_in_epochs),
        WITH_SCENE(rough_glass_and_ceramic_are_not_brighter_than_the_sky),
        WITH_SCENE(a_ball_in_the_open_has_its_reflectance),
        WITH_SCENE(plastic_and_metal_that_are_white_vanish),
        WITH_SCENE(glass_in_the_open_is_not_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
