/* What lights visible places may lie far outside of what is seen: the ground around a table lights
 * its underside. Photons are few there unless they are sent there. */
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

static const double ground = 0.5, table = 0.02, illuminance = 10.0;

/* A table of 2 m, 1 m above a ground of 1 km, under a sun straight above. The camera sees the
 * underside, and nothing else. */
static void add_table(void)
{
    add_quad(test.scene, material_lambert(test.scene, (float)ground), vec3(-500, 0, -500),
             vec3(0, 0, 1000), vec3(1000, 0, 0));
    add_quad(test.scene, material_lambert(test.scene, (float)table), vec3(-1, 1, -1), vec3(2, 0, 0),
             vec3(0, 0, 2));
    light_directional(test.scene, vec3(0, -1, 0), vec3_splat((float)illuminance));
    camera_orthographic(test.scene, vec3(0, 0.9f, 0), vec3(0, 1, 0), 1.0f);
}

/* The underside sees even light from all but the table's shadow, a square of its own size: the form
 * factor of two equal, parallel, directly opposed squares (Howell, "A Catalog of Radiation Heat
 * Transfer Configuration Factors", C-11). Light between table and shadow is less than half a per
 * cent. */
static double expected_radiance(void)
{
    const double x = 2.0, y2 = 1.0 + x * x, root = sqrt(y2); /* side by distance */
    const double shadow = 2.0 / (M_PI * x * x) *
                          (0.5 * log(y2 * y2 / (1.0 + 2.0 * x * x)) +
                           2.0 * x * root * atan(x / root) - 2.0 * x * atan(x));
    return table / M_PI * illuminance * ground * (1.0 - shadow);
}

static void sunny_ground_lights_what_it_is_not_seen_from(void **state)
{
    (void)state;
    add_table();
    const double expected = expected_radiance();
    const ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, 8, 32768);
    const test_mean found = render_green(test.scene, &options, 128, 4);
    print_message("expected %g, found %g +- %g\n", expected, found.mean, mean_error(&found));
    assert_near(found.mean, expected, 0.05 * expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(sunny_ground_lights_what_it_is_not_seen_from, open_scene,
                                        close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
