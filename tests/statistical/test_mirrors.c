/* Mirrors that face each other: no pixel stays black where the sky is not, in any integrator. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "statistical/methods.h"
#include "support/scenes.h"

static test_scene test;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    ppm_scene *scene = test.scene;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.metallic = 1.0f;
    desc.roughness = 0.0f;
    desc.base_color[0] = desc.base_color[1] = desc.base_color[2] = 0.95f;
    const ppm_material_id mirror = material_add(scene, &desc);
    add_quad(scene, mirror, vec3(-1.2f, -0.8f, -1), vec3(2.4f, 0, 0), vec3(0, 1.6f, 0));
    add_quad(scene, mirror, vec3(1.2f, -0.8f, 1), vec3(-2.4f, 0, 0), vec3(0, 1.6f, 0));
    shape_place(scene, shape_sphere(scene, mirror, 0.5f, 48, true));
    light_environment(scene, vec3_splat(1.0f), 0, 0.0f);
    camera_perspective(scene, vec3(1.1f, 0.3f, 0.9f), vec3(0, 0, -0.2f), 1.0f);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static void no_pixel_is_black_between_mirrors(void **state)
{
    (void)state;
    enum { SIDE = 48 };
    const render_method methods[4] = {path_method, photon_methods[0], photon_methods[4],
                                      photon_methods[5]};
    for (int m = 0; m < 4; m++) {
        ppm_render_options options = method_options(&methods[m], SIDE, 100);
        float *rgba = render_picture(test.scene, &options, 8);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            if (!(rgba[4 * i + 1] > 0.0f)) {
                fail_msg("%s: pixel %u,%u is black", methods[m].name, i % SIDE, i / SIDE);
            }
        }
        free(rgba);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(no_pixel_is_black_between_mirrors, open_scene, close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
