/* A ball of white rough glass in light that is the same from all sides cannot be seen: not in its
 * middle, where paths go straight, nor at its rim, where facets shadow each other most. */
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

enum { SEEDS = 12, RINGS = 2 };

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

/* The mean of green over the pixels of a ring, all of them within the ball. */
static double measure_ring(const float *rgba, const ppm_render_options *options, void *user)
{
    static const double radii[RINGS + 1] = {0.0, 0.7, 0.97};
    const int ring = *(const int *)user;
    const double width = (double)options->width, half_pixel = sqrt(2.0) / width;
    double sum = 0.0;
    int count = 0;
    for (uint32_t y = 0; y < options->height; y++) {
        for (uint32_t x = 0; x < options->width; x++) {
            const double dx = 2.0 * (x + 0.5) / width - 1.0, dy = 2.0 * (y + 0.5) / width - 1.0;
            const double radius = sqrt(dx * dx + dy * dy);
            if (radius < radii[ring] || radius >= radii[ring + 1]) continue;
            if (radius + half_pixel > 0.99) continue;
            sum += (double)rgba[4 * (y * options->width + x) + 1];
            count++;
        }
    }
    assert_true(count > 8);
    return sum / count;
}

static void add_ball(float index, float roughness, bool is_thin)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = roughness;
    desc.ior = index;
    desc.transmission_kind = is_thin ? PPM_TRANSMISSION_THIN : PPM_TRANSMISSION_SOLID;
    /* faceted: smooth normals that lean from the facets absorb a little */
    shape_place(test.scene,
                shape_sphere(test.scene, material_add(test.scene, &desc), 1.0f, 48, false));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 1.0f);
}

static void check_ball(test_family *family, int32_t integrator, float index, float roughness,
                       bool is_thin)
{
    scene_close(&test);
    scene_open(&test);
    add_ball(index, roughness, is_thin);
    ppm_render_options options = render_options(integrator, 24, 500);
    options.radius_m = 0.05f;
    options.max_depth = 200;
    for (int ring = 0; ring < RINGS; ring++) {
        const test_mean mean = render_means(test.scene, &options, 8, SEEDS, measure_ring, &ring);
        mean_check_power(&mean, 0.007);
        family_add_mean(family, &mean, 1.0, 0.01,
                        "index %g, roughness %g, thin %d, integrator %d, ring %d", (double)index,
                        (double)roughness, is_thin, integrator, ring);
    }
}

static void a_ball_of_rough_glass_is_not_seen(void **state)
{
    (void)state;
    test_family family = {0};
    check_ball(&family, PPM_INTEGRATOR_PATH, 1.5f, 0.35f, false);
    check_ball(&family, PPM_INTEGRATOR_SPPM, 1.5f, 0.35f, false);
    check_ball(&family, PPM_INTEGRATOR_PATH, 1.05f, 0.6f, false);
    check_ball(&family, PPM_INTEGRATOR_PATH, 2.0f, 0.5f, false);
    check_ball(&family, PPM_INTEGRATOR_PATH, 1.5f, 0.8f, false);
    check_ball(&family, PPM_INTEGRATOR_PATH, 1.5f, 1.0f, true);
    check_ball(&family, PPM_INTEGRATOR_SPPM, 1.5f, 1.0f, true);
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_ball_of_rough_glass_is_not_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
