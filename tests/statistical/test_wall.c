/* Photons on the other side of a thin wall must not count: they bring nothing, and if they entered
 * N they would shrink the radius and make the dim side noisy (the defect of
 * mitsuba-renderer/mitsuba#145). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static test_scene test;

enum { SIDE = 12, PASSES = 16 };

/* A wall with a dim light before it and a bright one behind, and between the wall and the bright
 * one a shield or not. The photons before the wall are the same in both cases. */
static float *render_wall(int32_t integrator, bool has_shield)
{
    scene_open(&test);
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    add_quad(test.scene, grey, vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0));
    /* elsewhere where it is no shield, for the same bounds */
    add_quad(test.scene, grey, vec3(has_shield ? -3 : 7, -3, -0.5f), vec3(6, 0, 0), vec3(0, 6, 0));
    add_quad(test.scene, grey, vec3(has_shield ? 7 : -3, -3, -1.5f), vec3(6, 0, 0), vec3(0, 6, 0));
    light_point(test.scene, vec3(0, 0, 1), vec3_splat(1.0f));
    light_point(test.scene, vec3(0, 0, -1), vec3_splat(500.0f));
    camera_orthographic(test.scene, vec3(0, 0, 0.5f), vec3(0, 0, 0), 0.3f);
    ppm_render_options options = render_options(integrator, SIDE, 20000);
    options.direct = PPM_DIRECT_PHOTONS;
    options.radius_m = 0.1f;
    options.max_depth = 1;
    float *rgba = render_picture(test.scene, &options, PASSES);
    scene_close(&test);
    return rgba;
}

/* Nothing changes but the order of sums. If photons behind counted, the radius would be 16^(-1/6)
 * of what it was, and hardly a photon the same. */
static void light_behind_a_wall_changes_nothing_before_it(void **state)
{
    (void)state;
    const int32_t integrators[2] = {PPM_INTEGRATOR_SPPM, PPM_INTEGRATOR_PPM};
    for (int i = 0; i < 2; i++) {
        float *lit = render_wall(integrators[i], false);
        float *shielded = render_wall(integrators[i], true);
        double sum = 0.0;
        for (uint32_t k = 0; k < SIDE * SIDE; k++) {
            assert_near(lit[4 * k], shielded[4 * k], 1e-4 * (double)shielded[4 * k]);
            sum += (double)lit[4 * k];
        }
        /* and the wall is not dark: I rho / pi at the middle */
        assert_near(sum / (SIDE * SIDE), 0.5 / M_PI, 0.3 * 0.5 / M_PI);
        free(lit);
        free(shielded);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_behind_a_wall_changes_nothing_before_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
