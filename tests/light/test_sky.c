/* The sun and the sky against published daylight, and the public call that puts them into a scene.
 *
 * Published: the IESNA Lighting Handbook (9th edition, chapter 8) gives for a clear day, h being
 * the sun's elevation, 127.5 klx exp(-0.21 / sin h) on a plane that faces the sun and
 * 0.8 + 15.5 sqrt(sin h) klx on level ground from the sky alone. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "light/sky.h"
#include "support/near.h"
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

static ppmi_sky sky_at(double elevation_deg, double azimuth_deg, double turbidity)
{
    return ppmi_sky_of((float)(elevation_deg * M_PI / 180.0), (float)(azimuth_deg * M_PI / 180.0),
                       (float)turbidity);
}

static double published_sun(double sine)
{
    return 127500.0 * exp(-0.21 / sine);
}

static double published_sky(double sine)
{
    return 800.0 + 15500.0 * sqrt(sine);
}

static const double elevations[] = {10, 20, 30, 45, 60, 75, 90};
enum { ELEVATIONS = sizeof elevations / sizeof elevations[0] };

/* ---- the model ------------------------------------------------------------------------------- */

static void the_sun_stands_where_a_map_and_a_sextant_say(void **state)
{
    (void)state;
    const ppmi_vec3 north = sky_at(0, 0, 3).to_sun, east = sky_at(0, 90, 3).to_sun;
    assert_near(north.z, -1.0, 1e-6);
    assert_near(east.x, 1.0, 1e-6);
    assert_near(sky_at(90, 77, 3).to_sun.y, 1.0, 1e-6);
    const ppmi_vec3 south_west = sky_at(45, 225, 3).to_sun;
    assert_near(south_west.x, -0.5, 1e-6);
    assert_near(south_west.y, sqrt(0.5), 1e-6);
    assert_near(south_west.z, 0.5, 1e-6);
}

/* Very clear air is what the published curve is for. */
static void a_clear_sun_has_the_published_illuminance(void **state)
{
    (void)state;
    for (int i = 0; i < ELEVATIONS; i++) {
        const ppmi_sky sky = sky_at(elevations[i], 0, 2);
        const double published = published_sun(sin(elevations[i] * M_PI / 180.0));
        assert_near((double)vec3_luminance(sky.sun_lux) / published, 1.0, 0.06);
    }
}

/* The default turbidity. The model gives the sky more and the sun less than the published mean day,
 * but on level ground they come to the same. */
static void a_clear_day_has_the_published_illuminance(void **state)
{
    (void)state;
    for (int i = 1; i < ELEVATIONS; i++) {
        const double sine = sin(elevations[i] * M_PI / 180.0);
        const ppmi_sky sky = sky_at(elevations[i], 120, 3);
        const double sun = (double)vec3_luminance(ppmi_sky_sun_ground_lux(&sky));
        const double total = sun + (double)vec3_luminance(ppmi_sky_ground_lux(&sky));
        const double published = sine * published_sun(sine) + published_sky(sine);
        assert_near(total / published, 1.0, 0.12);
    }
}

/* Zenith luminance as the paper's own formula has it; by hand for T = 3 and the sun at 60 degrees:
 * chi = (4/9 - 3/120)(pi - 2 pi/6), 7.1649 tan(chi) + 1.7727 kcd/m2. */
static void the_zenith_has_the_luminance_of_the_paper(void **state)
{
    (void)state;
    const ppmi_sky sky = sky_at(60, 0, 3);
    const double chi = (4.0 / 9.0 - 3.0 / 120.0) * (M_PI - M_PI / 3.0);
    const double expected = 1000.0 * (7.1649 * tan(chi) + 1.7727);
    assert_near((double)vec3_luminance(ppmi_sky_radiance(&sky, vec3(0, 1, 0))) / expected, 1.0,
                1e-3);
}

/* Chromaticity of the zenith, T = 3, sun at 90 degrees (angle 0): the constant terms alone. */
static void the_zenith_has_the_colour_of_the_paper(void **state)
{
    (void)state;
    const ppmi_sky sky = sky_at(90, 0, 3);
    const ppmi_vec3 c = ppmi_sky_radiance(&sky, vec3(0, 1, 0));
    /* IEC 61966-2-1, from linear Rec.709 */
    const double x = 0.4124 * (double)c.x + 0.3576 * (double)c.y + 0.1805 * (double)c.z;
    const double y = 0.2126 * (double)c.x + 0.7152 * (double)c.y + 0.0722 * (double)c.z;
    const double z = 0.0193 * (double)c.x + 0.1192 * (double)c.y + 0.9505 * (double)c.z;
    assert_near(x / (x + y + z), 0.00394 * 3 + 0.25886, 2e-4);
    assert_near(y / (x + y + z), 0.00516 * 3 + 0.26688, 2e-4);
}

static void haze_takes_from_the_sun_and_gives_to_the_sky(void **state)
{
    (void)state;
    double sun_before = INFINITY, sky_before = 0.0;
    for (int turbidity = 2; turbidity <= 10; turbidity++) {
        const ppmi_sky sky = sky_at(50, 0, turbidity);
        const double sun = (double)vec3_luminance(sky.sun_lux);
        const double diffuse = (double)vec3_luminance(ppmi_sky_ground_lux(&sky));
        assert_true(sun < sun_before && diffuse > sky_before);
        sun_before = sun;
        sky_before = diffuse;
    }
}

static void a_low_sun_is_red_and_a_high_sky_blue(void **state)
{
    (void)state;
    const ppmi_vec3 low = sky_at(4, 0, 3).sun_lux, high = sky_at(80, 0, 3).sun_lux;
    assert_true(low.x > 2.0f * low.y && low.y > 2.0f * low.z);
    assert_true(high.x < 1.5f * high.z);
    const ppmi_sky sky = sky_at(60, 0, 2);
    const ppmi_vec3 zenith = ppmi_sky_radiance(&sky, vec3(0, 1, 0));
    assert_true(zenith.z > 1.5f * zenith.y && zenith.y > 1.1f * zenith.x);
}

static void the_sky_is_finite_and_never_negative(void **state)
{
    (void)state;
    for (int i = 0; i <= 90; i += 5) {
        for (int turbidity = 2; turbidity <= 10; turbidity += 2) {
            const ppmi_sky sky = sky_at(i, 30, turbidity);
            assert_true(vec3_is_finite(sky.sun_lux));
            for (int k = 0; k < 400; k++) {
                const ppmi_vec3 d = ppmi_sample_sphere((float)k / 400.0f, (float)(k % 20) / 20.0f);
                const ppmi_vec3 c = ppmi_sky_radiance(&sky, d);
                assert_true(vec3_is_finite(c) && c.x >= 0.0f && c.y >= 0.0f && c.z >= 0.0f);
                assert_true(vec3_is_black(c) == (d.y < 0.0f));
            }
            assert_false(vec3_is_black(ppmi_sky_radiance(&sky, vec3(1, 0, 0))));
        }
    }
}

/* ---- the public call ------------------------------------------------------------------------- */

static ppm_sun_sky_desc good(void)
{
    ppm_sun_sky_desc desc;
    ppm_sun_sky_desc_init(&desc);
    return desc;
}

static void what_is_out_of_range_is_refused(void **state)
{
    (void)state;
    ppm_sun_sky_desc bad[9];
    for (int i = 0; i < 9; i++)
        bad[i] = good();
    bad[0].size = 4;
    bad[1].elevation_rad = -0.01f;
    bad[2].elevation_rad = 1.6f;
    bad[3].azimuth_rad = NAN;
    bad[4].turbidity = 1.9f;
    bad[5].turbidity = 10.5f;
    bad[6].factor = -1.0f;
    bad[7].ground_albedo = 1.1f;
    bad[8].turbidity = NAN;
    ppm_light_id id = 77;
    for (int i = 0; i < 9; i++) {
        assert_int_equal(ppm_scene_add_sun_sky(test.scene, &bad[i], &id),
                         PPM_STATUS_INVALID_ARGUMENT);
    }
    assert_int_equal(ppm_scene_add_sun_sky(test.scene, NULL, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(id, 77);
    assert_false(ppmi_scene_has_light(test.scene));
    const ppm_sun_sky_desc desc = good();
    test.scene->is_frozen = true;
    assert_int_equal(ppm_scene_add_sun_sky(test.scene, &desc, &id), PPM_STATUS_WRONG_STATE);
    test.scene->is_frozen = false;
    assert_int_equal(ppm_scene_add_sun_sky(test.scene, &desc, NULL), PPM_STATUS_OK);
}

static void a_failed_allocation_leaves_nothing_behind(void **state)
{
    (void)state;
    const ppm_sun_sky_desc desc = good();
    size_t n = 1;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    for (; status != PPM_STATUS_OK; n++) {
        ppmi_alloc_fail_at(test.context, n);
        status = ppm_scene_add_sun_sky(test.scene, &desc, NULL);
        ppmi_alloc_fail_at(test.context, 0);
        assert_true(status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY);
        if (status != PPM_STATUS_OK) assert_int_equal(test.scene->punctual_count, 0);
    }
    assert_true(n > 4);
}

/* The image, seen through the lights: the sky above, the lit ground below, the disk in its place.
 */
static void the_scene_is_lit_by_sky_ground_and_sun(void **state)
{
    (void)state;
    ppm_sun_sky_desc desc = good();
    desc.factor = 0.5f;
    desc.elevation_rad = 0.6f;
    desc.azimuth_rad = 2.0f;
    desc.ground_albedo = 0.3f;
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_sun_sky(test.scene, &desc, &id), PPM_STATUS_OK);
    test_world world;
    world_open(&world, &test);
    const ppmi_sky sky = ppmi_sky_of(0.6f, 2.0f, 3.0f);
    const ppmi_vec3 views[] = {{0, 1, 0}, {0.6f, 0.8f, 0}, {0, 0.1f, -0.995f}, {-0.5f, 0.5f, 0.7f}};
    for (int i = 0; i < 4; i++) {
        const ppmi_vec3 d = vec3_normalize(views[i]);
        const ppmi_vec3 seen = ppmi_lights_environment(world.lights, d);
        const ppmi_vec3 model = vec3_scale(ppmi_sky_radiance(&sky, d), 0.5f);
        assert_near(seen.x / model.x, 1.0, 5e-3); /* texels of a third of a degree */
        assert_near(seen.z / model.z, 1.0, 5e-3);
    }
    const ppmi_vec3 lux = vec3_add(ppmi_sky_ground_lux(&sky), ppmi_sky_sun_ground_lux(&sky));
    const ppmi_vec3 ground = ppmi_lights_environment(world.lights, vec3(0.6f, -0.8f, 0));
    assert_near(ground.y / (0.5f * 0.3f * PPMI_INV_PI * lux.y), 1.0, 1e-4);
    const float sine = sinf(PPMI_SUN_ANGULAR_RADIUS_RAD);
    const ppmi_vec3 disk = ppmi_lights_environment(world.lights, sky.to_sun);
    const float radiance = 0.5f * sky.sun_lux.y * PPMI_INV_PI / (sine * sine);
    assert_near(disk.y / radiance, 1.0, 1e-3);
    world_close(&world);
}

static void the_sun_alone_leaves_the_environment(void **state)
{
    (void)state;
    light_environment(test.scene, vec3_splat(2.0f), 0, 0.0f);
    ppm_sun_sky_desc desc = good();
    desc.sun_only = 1;
    assert_int_equal(ppm_scene_add_sun_sky(test.scene, &desc, NULL), PPM_STATUS_OK);
    assert_int_equal(test.scene->environment.image, 0);
    assert_near(test.scene->environment.radiance.x, 2.0, 0.0);
    assert_int_equal(test.scene->punctual_count, 1);
}

static void the_backdrop_stays(void **state)
{
    (void)state;
    const ppm_environment_desc before = {
        .size = sizeof before, .has_backdrop = 1, .backdrop = {0.1f, 0.2f, 0.3f}};
    assert_int_equal(ppm_scene_set_environment(test.scene, &before), PPM_STATUS_OK);
    const ppm_sun_sky_desc desc = good();
    assert_int_equal(ppm_scene_add_sun_sky(test.scene, &desc, NULL), PPM_STATUS_OK);
    assert_true(test.scene->environment.has_backdrop && test.scene->environment.image > 0);
    assert_near(test.scene->environment.backdrop.z, 0.3, 1e-7);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sun_stands_where_a_map_and_a_sextant_say),
        cmocka_unit_test(a_clear_sun_has_the_published_illuminance),
        cmocka_unit_test(a_clear_day_has_the_published_illuminance),
        cmocka_unit_test(the_zenith_has_the_luminance_of_the_paper),
        cmocka_unit_test(the_zenith_has_the_colour_of_the_paper),
        cmocka_unit_test(haze_takes_from_the_sun_and_gives_to_the_sky),
        cmocka_unit_test(a_low_sun_is_red_and_a_high_sky_blue),
        cmocka_unit_test(the_sky_is_finite_and_never_negative),
        WITH_SCENE(what_is_out_of_range_is_refused),
        WITH_SCENE(a_failed_allocation_leaves_nothing_behind),
        WITH_SCENE(the_scene_is_lit_by_sky_ground_and_sun),
        WITH_SCENE(the_sun_alone_leaves_the_environment),
        WITH_SCENE(the_backdrop_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
