/* Light on a Lambert plane, against formulas: the whole way through both integrators. */
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
static const float reflectance = 0.5f;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    family = (test_family){0};
    /* a floor of 40 by 40 metres that faces up */
    add_quad(test.scene, material_lambert(test.scene, reflectance), vec3(-20, 0, -20),
             vec3(0, 0, 40), vec3(40, 0, 0));
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

/* Adds a camera that looks straight down on the floor around (x, z). */
static ppm_camera_id look_down(float x, float z, float half_width)
{
    return camera_orthographic(test.scene, vec3(x, 0.5f, z), vec3(x, 0, z), half_width);
}

static void compare(const char *name, ppm_camera_id camera, double irradiance, double systematic)
{
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        ppm_render_options options = render_options(i, 8, 2000);
        options.camera = camera;
        options.radius_m = 0.05f;
        const test_mean mean = render_green(test.scene, &options, 24, SEEDS);
        const double expected = irradiance * (double)reflectance / M_PI;
        if (expected > 0.0) mean_check_power(&mean, 0.01);
        family_add_mean(&family, &mean, expected, systematic * expected, "%s, integrator %d", name,
                        i);
    }
}

/* Irradiance on the floor from a level rectangle of radiance 1 above it: Lambert's sum of edges. */
static double rectangle_irradiance(ppmi_vec3 low, ppmi_vec3 high, double x, double z)
{
    const double cx[4] = {low.x, high.x, high.x, low.x}, cz[4] = {low.z, low.z, high.z, high.z};
    double sum = 0.0;
    for (int i = 0; i < 4; i++) {
        const int k = (i + 1) % 4;
        const double a[3] = {cx[i] - x, (double)low.y, cz[i] - z};
        const double b[3] = {cx[k] - x, (double)low.y, cz[k] - z};
        const double la = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        const double lb = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
        const double dot = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / (la * lb);
        const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                             a[0] * b[1] - a[1] * b[0]};
        sum += acos(dot) * n[1] / sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return 0.5 * fabs(sum);
}

/* Over the square that the camera sees. */
static double mean_rectangle_irradiance(ppmi_vec3 low, ppmi_vec3 high, double x, double z,
                                        double half_width)
{
    double sum = 0.0;
    const int steps = 20;
    for (int i = 0; i < steps * steps; i++) {
        sum += rectangle_irradiance(low, high,
                                    x + half_width * (2.0 * (i % steps + 0.5) / steps - 1.0),
                                    z + half_width * (2.0 * (i / steps + 0.5) / steps - 1.0));
    }
    return sum / (steps * steps);
}

static void a_rectangular_light_gives_its_form_factor(void **state)
{
    (void)state;
    const ppmi_vec3 low = {-0.5f, 1.0f, -1.0f}, high = {0.5f, 1.0f, 1.0f};
    add_quad(test.scene, material_emitter(test.scene, 3.0f, 0.0f, false), low, vec3(1, 0, 0),
             vec3(0, 0, 2));
    const float points[4][2] = {{0, 0}, {0.7f, 0.3f}, {2, 1}, {-5, 3}};
    for (int i = 0; i < 4; i++)
        look_down(points[i][0], points[i][1], 0.1f); /* before the scene is frozen */
    for (uint32_t i = 0; i < 4; i++) {
        compare("rectangle", i + 1,
                3.0 * mean_rectangle_irradiance(low, high, (double)points[i][0],
                                                (double)points[i][1], 0.1),
                1e-4);
    }
    family_check(&family);
}

static void a_light_that_faces_away_gives_nothing(void **state)
{
    (void)state;
    add_quad(test.scene, material_emitter(test.scene, 3.0f, 0.0f, false), vec3(-0.5f, 1, -1),
             vec3(0, 0, 2), vec3(1, 0, 0));
    compare("away", look_down(0.2f, 0.3f, 0.1f), 0.0, 0.0);
    family_check(&family);
}

/* Pixels are small: means over them differ from the middle by less than 1e-4. */
static void a_point_light_falls_off_by_the_square_and_the_cosine(void **state)
{
    (void)state;
    light_point(test.scene, vec3(0, 2, 0), vec3_splat(8.0f));
    const ppm_camera_id below = look_down(0.0f, 0.0f, 0.01f);
    const ppm_camera_id aside = look_down(2.0f, 0.0f, 0.01f);
    compare("below the point", below, 2.0, 1e-4);
    compare("aside of the point", aside, 8.0 * 2.0 / pow(8.0, 1.5), 1e-4);
    family_check(&family);
}

static void a_spot_light_lights_its_cone(void **state)
{
    (void)state;
    light_spot(test.scene, vec3(0, 3, 0), vec3(0, 0, 0), vec3_splat(9.0f), 0.3f, 0.5f);
    const ppm_camera_id inside = look_down(0.0f, 0.0f, 0.01f);
    const ppm_camera_id outside = look_down(3.0f, 0.0f, 0.01f);
    compare("inside", inside, 1.0, 1e-4);
    compare("outside", outside, 0.0, 0.0);
    family_check(&family);
}

static void a_shadow_is_black(void **state)
{
    (void)state;
    light_directional(test.scene, vec3(0, -1, 0), vec3_splat(10.0f));
    add_quad(test.scene, material_lambert(test.scene, 0.0f), vec3(-1, 3, -1), vec3(0, 0, 2),
             vec3(2, 0, 0));
    const ppm_camera_id below = look_down(0.0f, 0.0f, 0.5f);
    const ppm_camera_id aside = look_down(2.0f, 0.0f, 0.5f);
    compare("shadow", below, 0.0, 0.0);
    compare("light", aside, 10.0, 1e-6);
    family_check(&family);
}

/* Two floors of the same tilt, one by geometry, one by shading normals: Lambert's cosine follows
 * the shading normal. What a photon brings and what a light sample brings must agree on it. */
static void leaning_shading_normals_agree_between_photons_and_light_samples(void **state)
{
    (void)state;
    /* above the floor: a ceiling that is lit by the sun through bouncing from the floor only */
    static const float positions[12] = {-20, 2, -20, 20, 2, -20, 20, 2, 20, -20, 2, 20};
    static const float normals[12] = {0.5f, -1, 0, 0.5f, -1, 0, 0.5f, -1, 0, 0.5f, -1, 0};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const ppm_primitive_desc ceiling = {.vertex_count = 4,
                                        .triangle_count = 2,
                                        .positions = positions,
                                        .normals = normals,
                                        .indices = indices,
                                        .material = material_lambert(test.scene, 0.8f)};
    shape_place(test.scene, shape_mesh(test.scene, &ceiling));
    light_point(test.scene, vec3(0.5f, 1, 0.3f), vec3_splat(8.0f));
    const ppm_camera_id up =
        camera_orthographic(test.scene, vec3(0.2f, 1, 0.1f), vec3(0.2f, 2, 0.1f), 0.4f);
    test_mean means[2];
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        ppm_render_options options = render_options(i, 8, 20000);
        options.camera = up;
        options.radius_m = 0.1f;
        options.max_depth = 4;
        means[i - 1] =
            render_green(test.scene, &options, i == PPM_INTEGRATOR_PATH ? 200 : 8, SEEDS);
        mean_check_power(&means[i - 1], 0.005);
    }
    const double error = hypot(mean_error(&means[0]), mean_error(&means[1]));
    family_add(&family,
               p_student((means[0].mean - means[1].mean) / error, (double)means[0].count - 1.0),
               "photons %g, paths %g +- %g", means[0].mean, means[1].mean, error);
    family_check(&family);
}

/* ---- light through a clearcoat --------------------------------------------------------------- */

/* Irradiance at the middle of the floor from a level strip of radiance 1, 1 m above it, 4 m by 0.5
 * m, under a coat with KHR_materials_clearcoat's Fresnel term. */
static double coated_irradiance(void)
{
    double sum = 0.0;
    const int steps = 200;
    for (int i = 0; i < steps * steps; i++) {
        const double x = 2.0 * (2.0 * (i % steps + 0.5) / steps - 1.0);
        const double z = 0.25 * (2.0 * (i / steps + 0.5) / steps - 1.0);
        const double d2 = x * x + z * z + 1.0, cosine = 1.0 / sqrt(d2);
        sum += cosine * cosine / d2 * (1.0 - 0.04 - 0.96 * pow(1.0 - cosine, 5.0));
    }
    return sum * 4.0 * 0.5 / (steps * steps);
}

/* The eye's paths, light sampling and photons alike. At the ends of the strip the coat holds
 * back 0.09. Paths end before the coat can return any
 * of the floor's light. */
static void light_through_a_clearcoat_is_dimmed_whichever_way_it_is_found(void **state)
{
    (void)state;
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    vec3_store(desc.emission, vec3_splat(3.0f));
    vec3_store(desc.base_color, vec3_splat(0.0f));
    desc.clearcoat = 1.0f;
    desc.double_sided = 0;
    add_quad(test.scene, material_add(test.scene, &desc), vec3(-2, 1, -0.25f), vec3(4, 0, 0),
             vec3(0, 0, 0.5f));
    look_down(0.0f, 0.0f, 0.05f);
    const double expected = 3.0 * coated_irradiance() * (double)reflectance / M_PI;
    for (int way = 0; way < 3; way++) {
        const bool is_path = way == 0;
        ppm_render_options options = render_options(
            is_path ? PPM_INTEGRATOR_PATH : PPM_INTEGRATOR_SPPM, 8, way == 2 ? 10000 : 500);
        options.alpha = 1.0f; /* the radius stays */
        options.direct = way == 2 ? PPM_DIRECT_PHOTONS : PPM_DIRECT_SAMPLE;
        options.radius_m = 0.1f;
        options.max_depth = 2;
        const test_mean mean = render_green(test.scene, &options, 24, SEEDS);
        mean_check_power(&mean, 0.01); /* the coat holds back 0.045 of all */
        /* the radius reaches to where the irradiance is 1 - 2 r^2 of the middle's at most */
        family_add_mean(&family, &mean, expected, (is_path ? 0.002 : 0.01) * expected, "way %d",
                        way);
    }
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_rectangular_light_gives_its_form_factor),
        WITH_SCENE(a_light_that_faces_away_gives_nothing),
        WITH_SCENE(a_point_light_falls_off_by_the_square_and_the_cosine),
        WITH_SCENE(a_spot_light_lights_its_cone),
        WITH_SCENE(a_shadow_is_black),
        WITH_SCENE(leaning_shading_normals_agree_between_photons_and_light_samples),
        WITH_SCENE(light_through_a_clearcoat_is_dimmed_whichever_way_it_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
