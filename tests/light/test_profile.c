/* Light profiles: what they are between their entries, how they are drawn, what they send. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "light/profile.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;
static test_family family;

static const float quarter = 0.5f * PPMI_PI;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    family = (test_family){0};
    add_quad(test.scene, 0, vec3(-2, 0, -2), vec3(0, 0, 4), vec3(4, 0, 0));
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static ppm_light_profile_id add_profile(uint32_t polar_count, const float *polar,
                                        uint32_t azimuth_count, const float *azimuth,
                                        const float *candela)
{
    const ppm_light_profile_desc desc = {.size = sizeof desc,
                                         .polar_count = polar_count,
                                         .azimuth_count = azimuth_count,
                                         .polar_rad = polar,
                                         .azimuth_rad = azimuth,
                                         .candela = candela};
    ppm_light_profile_id id = 0;
    assert_int_equal(ppm_scene_add_light_profile(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

/* Towards a polar angle from -z and an azimuth from +x. */
static ppmi_vec3 towards(double polar, double azimuth)
{
    return vec3((float)(sin(polar) * cos(azimuth)), (float)(sin(polar) * sin(azimuth)),
                (float)-cos(polar));
}

static double value(double polar, double azimuth)
{
    return (double)ppmi_light_profile_value(&test.scene->profiles[0], towards(polar, azimuth));
}

static void bad_profiles_are_refused(void **state)
{
    (void)state;
    const float angles[2] = {0.0f, 1.0f}, falling[2] = {1.0f, 0.5f}, far[2] = {0.0f, 7.0f};
    const float fine[4] = {1, 2, 3, 4}, negative[4] = {1, -2, 3, 4}, nan[4] = {1, NAN, 3, 4};
    const float late[2] = {0.5f, 1.0f};
    const struct {
        uint32_t polar_count, azimuth_count;
        const float *polar, *azimuth, *candela;
    } rows[] = {
        {0, 1, angles, angles, fine},        {2, 0, angles, angles, fine},
        {2, 2, NULL, angles, fine},          {2, 2, angles, NULL, fine},
        {2, 2, angles, angles, NULL},        {2, 2, falling, angles, fine},
        {2, 2, angles, falling, fine},       {2, 2, far, angles, fine},
        {2, 2, angles, far, fine},           {2, 2, angles, late, fine},
        {2, 2, angles, angles, negative},    {2, 2, angles, angles, nan},
        {1u << 20, 2, angles, angles, fine},
    };
    ppm_light_profile_id id = 9;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const ppm_light_profile_desc desc = {.size = sizeof desc,
                                             .polar_count = rows[i].polar_count,
                                             .azimuth_count = rows[i].azimuth_count,
                                             .polar_rad = rows[i].polar,
                                             .azimuth_rad = rows[i].azimuth,
                                             .candela = rows[i].candela};
        assert_int_equal(ppm_scene_add_light_profile(test.scene, &desc, &id),
                         PPM_STATUS_INVALID_ARGUMENT);
    }
    assert_int_equal(id, 9);
    assert_int_equal(test.scene->profile_count, 0);
}

static void values_are_linear_in_the_angles_and_0_beyond(void **state)
{
    (void)state;
    const float polar[3] = {0.0f, 0.5f, 1.0f}, azimuth[1] = {0.0f}, candela[3] = {10, 20, 0};
    add_profile(3, polar, 1, azimuth, candela);
    assert_near(value(0.0, 0.0), 10.0, 1e-4);
    assert_near(value(0.25, 3.0), 15.0, 1e-4);
    assert_near(value(0.5, 5.0), 20.0, 1e-4);
    assert_near(value(0.75, 1.0), 10.0, 1e-4);
    assert_near(value(1.1, 1.0), 0.0, 0.0);
    assert_near(value(M_PI, 1.0), 0.0, 0.0);
}

static void quarters_and_halves_are_mirrored(void **state)
{
    (void)state;
    const float polar[2] = {0.0f, PPMI_PI}, azimuth[2] = {0.0f, quarter};
    const float candela[4] = {0, 0, 90, 90};
    add_profile(2, polar, 2, azimuth, candela);
    const double degree = M_PI / 180.0;
    const double quarters[][2] = {{0, 0},   {30, 30},  {90, 90}, {150, 30},
                                  {180, 0}, {210, 30}, {300, 60}};
    for (size_t i = 0; i < sizeof quarters / sizeof quarters[0]; i++)
        assert_near(value(1.0, quarters[i][0] * degree), quarters[i][1], 1e-3);
}

static void halves_and_whole_turns_are_told_apart(void **state)
{
    (void)state;
    const float polar[1] = {quarter}, half[2] = {0.0f, PPMI_PI}, candela[3] = {0, 180, 0};
    const float turn[3] = {0.0f, PPMI_PI, 2.0f * PPMI_PI}, lopsided[3] = {0, 180, 360};
    const ppm_light_profile_id mirrored = add_profile(1, polar, 2, half, candela);
    const ppm_light_profile_id whole = add_profile(1, polar, 3, turn, lopsided);
    const double degree = M_PI / 180.0;
    const ppmi_light_profile *profiles = test.scene->profiles;
    const ppmi_vec3 at = towards((double)quarter, 270.0 * degree);
    assert_near(ppmi_light_profile_value(&profiles[mirrored - 1], at), 90.0, 1e-3);
    assert_near(ppmi_light_profile_value(&profiles[whole - 1], at), 270.0, 1e-3);
}

/* Counts of draws by cells of another grid, against their density's integral. */
static void draws_follow_their_density(void **state)
{
    (void)state;
    enum { ROWS = 8, COLUMNS = 6, CELLS = ROWS * COLUMNS, TAPS = 24 };
    const float polar[4] = {0.0f, 0.3f, 0.5f, 2.0f}, azimuth[2] = {0.0f, PPMI_PI};
    const float candela[8] = {100, 80, 5, 2, 100, 10, 1, 0};
    add_profile(4, polar, 2, azimuth, candela);
    ppmi_profile_table table;
    assert_int_equal(ppmi_profile_table_init(test.context, &test.scene->profiles[0], &table),
                     PPM_STATUS_OK);
    double observed[CELLS] = {0}, expected[CELLS] = {0};
    test_mean power = {0};
    const uint32_t count = TEST_EFFORT(200000);
    double area = 0.0;
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_PHOTON, 0);
    for (uint32_t i = 0; i < count; i++) {
        ppmi_vec3 local;
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng);
        const float pdf = ppmi_profile_table_sample(&table, u, v, &local);
        assert_true(pdf > 0.0f);
        const int row = (int)ppmi_min(0.5f * (1.0f + local.z) * ROWS, ROWS - 1);
        const float turn = atan2f(local.y, local.x) / (2.0f * PPMI_PI);
        const int column = (int)((turn < 0.0f ? turn + 1.0f : turn) * COLUMNS) % COLUMNS;
        observed[row * COLUMNS + column] += 1.0;
        mean_add(&power, (double)(ppmi_light_profile_value(&test.scene->profiles[0], local) / pdf));
        area += 1.0 / (double)pdf / count;
    }
    /* the density by itself: its inverse's mean is the sphere */
    assert_near(area / (4.0 * M_PI), 1.0, 0.05);
    double flux = 0.0;
    for (int cell = 0; cell < CELLS; cell++) {
        for (int k = 0; k < TAPS * TAPS; k++) {
            const double z = -1.0 + 2.0 * (cell / COLUMNS + (k / TAPS + 0.5) / TAPS) / ROWS;
            const double phi = 2.0 * M_PI * (cell % COLUMNS + (k % TAPS + 0.5) / TAPS) / COLUMNS;
            expected[cell] += value(acos(-z), phi);
        }
        expected[cell] *= 4.0 * M_PI / (CELLS * TAPS * TAPS);
        flux += expected[cell];
    }
    /* nine tenths by the profile, one tenth evenly */
    for (int cell = 0; cell < CELLS; cell++)
        expected[cell] = count * (0.9 * expected[cell] / flux + 0.1 / CELLS);
    family_add(&family, p_counts(observed, expected, CELLS), "directions");
    family_add_mean(&family, &power, flux, 0.004 * flux, "flux");
    family_check(&family);
    assert_near((double)table.flux / flux, 1.0, 0.004);
    ppmi_profile_table_deinit(test.context, &table);
}

static ppm_light_id add_light(int32_t kind, float radius, ppm_light_profile_id profile)
{
    const ppm_light_desc lamp = {.size = sizeof lamp,
                                 .kind = kind,
                                 .transform = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 1.5f, 0, 1},
                                 .intensity = {1, 2, 3},
                                 .inner_cone_rad = 0.8f,
                                 .outer_cone_rad = 1.2f,
                                 .radius_m = radius,
                                 .profile = profile};
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(test.scene, &lamp, &id), PPM_STATUS_OK);
    return id;
}

/* Power that photons bring to a square of the floor, against intensity over distance squared. */
static void photons_land_where_the_profile_sends_them(void **state)
{
    (void)state;
    const float polar[3] = {0.0f, 0.4f, quarter}, azimuth[3] = {0.0f, quarter, PPMI_PI};
    const float candela[9] = {50, 40, 3, 50, 20, 1, 50, 5, 0};
    const ppmi_vec3 low = vec3(0.2f, 0, -0.7f), high = vec3(0.9f, 0, -0.1f);
    for (int k = 0; k < 4; k++) {
        const int32_t kind = k & 1 ? PPM_LIGHT_SPOT : PPM_LIGHT_POINT;
        add_light(kind, k & 2 ? 0.01f : 0.0f, add_profile(3, polar, 3, azimuth, candela));
        world_open(&world, &test);
        test_mean mean = {0};
        for (uint64_t seed = 1; seed <= 16; seed++) {
            double sum = 0.0;
            const uint32_t count = TEST_EFFORT(16384);
            for (uint32_t i = 0; i < count; i++) {
                const ppmi_sample4 at = ppmi_sobol4(i, 0, seed);
                const float u[4] = {ppmi_unit_float(at.bits[0]), ppmi_unit_float(at.bits[1]),
                                    ppmi_unit_float(at.bits[2]), ppmi_unit_float(at.bits[3])};
                ppmi_emission e;
                if (!ppmi_lights_emit(world.lights, 0.5, u, &e)) continue;
                if (!(e.ray.direction.y < 0.0f)) continue;
                const ppmi_vec3 p =
                    vec3_mad(e.ray.origin, e.ray.direction, -e.ray.origin.y / e.ray.direction.y);
                if (p.x > low.x && p.x < high.x && p.z > low.z && p.z < high.z)
                    sum += (double)e.power.y;
            }
            mean_add(&mean, sum / count);
        }
        enum { STEPS = 200 };
        double exact = 0.0;
        for (int i = 0; i < STEPS * STEPS; i++) {
            const double x = 0.2 + 0.7 * (i % STEPS + 0.5) / STEPS;
            const double z = -0.7 + 0.6 * (i / STEPS + 0.5) / STEPS;
            const double d2 = x * x + z * z + 2.25, d = sqrt(d2);
            const ppmi_vec3 local = vec3((float)(x / d), (float)(-z / d), (float)(-1.5 / d));
            double cd = 2.0 * (double)ppmi_light_profile_value(&test.scene->profiles[0], local);
            if (kind == PPM_LIGHT_SPOT) {
                const double f = (1.5 / d - cos(1.2)) / (cos(0.8) - cos(1.2));
                cd *= fmin(fmax(f, 0.0), 1.0) * fmin(fmax(f, 0.0), 1.0);
            }
            exact += cd * 1.5 / (d2 * d) * 0.7 * 0.6 / (STEPS * STEPS);
        }
        mean_check_power(&mean, 0.02);
        family_add_mean(&family, &mean, exact, 0.003 * exact, "light %d", k);
        world_close(&world);
        close_scene(NULL);
        const test_family kept = family;
        open_scene(NULL);
        family = kept;
    }
    family_check(&family);
}

/* Light sampling asks the same profile: a point's is exact. */
static void light_sampling_sees_the_profile(void **state)
{
    (void)state;
    const float polar[2] = {0.0f, quarter}, azimuth[2] = {0.0f, PPMI_PI};
    const float candela[4] = {10, 10, 10, 0};
    add_light(PPM_LIGHT_POINT, 0.0f, add_profile(2, polar, 2, azimuth, candela));
    world_open(&world, &test);
    for (int side = -1; side <= 1; side += 2) {
        ppmi_light_sample sample;
        assert_true(ppmi_lights_sample(world.lights, vec3(1.5f * (float)side, 0, 0), vec3(0, 1, 0),
                                       0.5, 0.5f, 0.5f, &sample));
        const double cd = side > 0 ? 10.0 : 5.0; /* half way along the azimuth 180 */
        assert_near(sample.radiance.y, 2.0 * cd / 4.5, 1e-4);
    }
    world_close(&world);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(bad_profiles_are_refused),         CASE(values_are_linear_in_the_angles_and_0_beyond),
        CASE(quarters_and_halves_are_mirrored), CASE(halves_and_whole_turns_are_told_apart),
        CASE(draws_follow_their_density),       CASE(photons_land_where_the_profile_sends_them),
        CASE(light_sampling_sees_the_profile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
