/* A sun's disk on a floor, straight and by a mirror, through both integrators: what light sampling,
 * BSDF sampling and photons bring is the same light. */
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

enum { SEEDS = 12 };
static const float reflectance = 0.5f;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    family = (test_family){0};
    add_quad(test.scene, material_lambert(test.scene, reflectance), vec3(-4, 0, -4), vec3(0, 0, 8),
             vec3(8, 0, 0));
    camera_orthographic(test.scene, vec3(0.8f, 0.5f, 0), vec3(0.8f, 0, 0), 0.1f);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

/* A wall at x = 1 that mirrors everything; it faces west. */
static void add_mirror(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.metallic = 1.0f;
    desc.roughness = 0.0f;
    add_quad(test.scene, material_add(test.scene, &desc), vec3(1, 0, -4), vec3(0, 0, 8),
             vec3(0, 4, 0));
}

static void compare(const char *name, double irradiance, double resolution)
{
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        ppm_render_options options = render_options(i, 8, 20000);
        options.radius_m = 0.05f;
        const test_mean mean = render_green(test.scene, &options, 16, SEEDS);
        const double expected = irradiance * (double)reflectance / M_PI;
        mean_check_power(&mean, resolution);
        family_add_mean(&family, &mean, expected, 1e-4 * expected, "%s, integrator %d", name, i);
    }
    family_check(&family);
}

static void a_disk_lights_by_the_sine_of_its_height(void **state)
{
    (void)state;
    light_sun(test.scene, vec3(3, -4, 0), vec3_splat(10.0f), 0.3f);
    compare("disk", 8.0, 0.005);
}

static void the_sun_of_the_sky_is_found_by_light_sampling(void **state)
{
    (void)state;
    light_sun(test.scene, vec3(3, -4, 0), vec3_splat(1e5f), 0.00465f);
    compare("sun", 8e4, 0.005);
}

/* The mirrored disk stands as high as the disk. Photons bring it in one integrator, rays that the
 * floor's BSDF draws in the other. */
static void a_mirror_doubles_the_disk(void **state)
{
    (void)state;
    add_mirror();
    light_sun(test.scene, vec3(3, -4, 0), vec3_splat(10.0f), 0.3f);
    compare("mirror", 16.0, 0.02);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_disk_lights_by_the_sine_of_its_height),
        WITH_SCENE(the_sun_of_the_sky_is_found_by_light_sampling),
        WITH_SCENE(a_mirror_doubles_the_disk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
