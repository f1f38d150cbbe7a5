/* The camera of a session: depth of field, filters, crop, shutter, focus. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/integrator.h"
#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static test_scene test;

enum { SIDE = 32 };

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

/* ---- edges ----------------------------------------------------------------------------------- */

/* A picture of 32 x 32 pixels whose tangent is 1 from side to side, of a half plane at depth z that
 * shines with 1 nit where x is below edge. */
static void build_edge(float z, float edge)
{
    camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 2.0f * atanf(0.5f));
    add_quad(test.scene, material_emitter(test.scene, 1.0f, 0.0f, true),
             vec3(edge - 10 * z, -5 * z, -z), vec3(10 * z, 0, 0), vec3(0, 10 * z, 0));
}

/* A share of the light at distance x inside of an edge; all lengths in pixels. */
typedef double (*edge_profile)(double x, double width);

/* Every row is a sample of its own. */
static void compare_columns(const ppm_render_options *options, double edge_px, edge_profile profile,
                            double width)
{
    const uint32_t passes = TEST_EFFORT(256);
    const double samples = (double)SIDE * passes; /* of a column */
    float *rgba = render_picture(test.scene, options, passes);
    test_family family = {0};
    for (int x = 0; x < SIDE; x++) {
        test_mean mean = {0};
        for (int y = 0; y < SIDE; y++)
            mean_add(&mean, (double)rgba[4 * (y * SIDE + x) + 1]);
        const double expected = profile(edge_px - (x + 0.5), width);
        const double minor = fmin(expected, 1.0 - expected);
        if (minor * samples >= 50.0) {
            family_add_mean(&family, &mean, expected, 1e-4, "column %d", x);
        } else { /* too rare for a mean's statistics: within 5 binomial errors */
            assert_near(mean.mean, expected, 5.0 * sqrt(minor / samples) + 1e-5);
        }
    }
    assert_true(family.count >= 1);
    family_check(&family);
    free(rgba);
}

static double box_edge(double x, double width)
{
    return ppmi_pixel_filter_cdf(PPM_PIXEL_FILTER_BOX, width, x);
}

static double gaussian_edge(double x, double width)
{
    return ppmi_pixel_filter_cdf(PPM_PIXEL_FILTER_GAUSSIAN, width, x);
}

static double blackman_harris_edge(double x, double width)
{
    return ppmi_pixel_filter_cdf(PPM_PIXEL_FILTER_BLACKMAN_HARRIS, width, x);
}

/* The share of a disk of that width before a line at distance x from its middle, averaged over a
 * pixel. */
static double blurred_edge(double x, double width)
{
    enum { STEPS = 500 };
    const double r = 0.5 * width, pi = 3.14159265358979323846;
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++) {
        const double s = fmax(-1.0, fmin(1.0, (x - 0.5 + (i + 0.5) / STEPS) / r));
        sum += 0.5 + (s * sqrt(1.0 - s * s) + asin(s)) / pi;
    }
    return sum / STEPS;
}

static ppm_render_options edge_options(void)
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 0);
    options.max_depth = 1;
    return options;
}

static void an_edge_is_the_integral_of_the_filter(void **state)
{
    (void)state;
    const float z = 4.0f, edge_px = 15.3f;
    build_edge(z, z * (edge_px / SIDE - 0.5f));
    const struct {
        int32_t kind;
        float width; /* 0: the default */
        double in_effect;
        edge_profile profile;
    } cases[] = {
        {PPM_PIXEL_FILTER_BOX, 0.0f, 1.0, box_edge},
        {PPM_PIXEL_FILTER_BOX, 6.5f, 6.5, box_edge},
        {PPM_PIXEL_FILTER_GAUSSIAN, 0.0f, 3.0, gaussian_edge},
        {PPM_PIXEL_FILTER_GAUSSIAN, 9.0f, 9.0, gaussian_edge},
        {PPM_PIXEL_FILTER_BLACKMAN_HARRIS, 12.0f, 12.0, blackman_harris_edge},
        {PPM_PIXEL_FILTER_DEFAULT, 0.0f, 3.0, blackman_harris_edge},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ppm_render_options options = edge_options();
        options.pixel_filter = cases[i].kind;
        options.pixel_filter_width = cases[i].width;
        compare_columns(&options, (double)edge_px, cases[i].profile, cases[i].in_effect);
    }
}

/* A lens of 36 mm (the picture's tangent is 1 over 36 mm) and diameter 0.4 m, focused at 1 m: the
 * disk of what is at z is 0.4 |z - 1| wide there, where a pixel is z / 32 wide. */
static void the_blur_of_an_edge_is_that_of_a_thin_lens(void **state)
{
    (void)state;
    const float depths[] = {3.0f, 0.6f, 100.0f};
    for (int i = 0; i < 3; i++) {
        if (i > 0) {
            scene_close(&test);
            scene_open(&test);
        }
        const float z = depths[i], edge_px = 16.8f;
        build_edge(z, z * (edge_px / SIDE - 0.5f));
        ppm_render_options options = edge_options();
        options.aperture_f_number = 0.036f / 0.4f;
        options.focus_distance_m = 1.0f;
        const double disk_px = 0.4 * fabs((double)z - 1.0) / ((double)z / SIDE);
        compare_columns(&options, (double)edge_px, blurred_edge, disk_px);
    }
}

static void the_plane_of_focus_is_sharp(void **state)
{
    (void)state;
    const float z = 3.0f, edge_px = 16.8f;
    build_edge(z, z * (edge_px / SIDE - 0.5f));
    ppm_render_options options = edge_options();
    options.aperture_f_number = 0.036f / 0.4f;
    options.focus_distance_m = z;
    compare_columns(&options, (double)edge_px, box_edge, 1.0);
}

/* ---- where the focus is ---------------------------------------------------------------------- */

/* A wall across the whole view, seen from its front or its back. */
static void add_wall(ppm_material_id material, float z, bool from_behind)
{
    const ppmi_vec3 u = vec3(2 * z, 0, 0), v = vec3(0, 2 * z, 0);
    add_quad(test.scene, material, vec3(-z, -z, -z), from_behind ? v : u, from_behind ? u : v);
}

static ppm_material_id veil(float alpha)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.alpha_mode = PPM_ALPHA_BLEND;
    desc.base_color[3] = alpha;
    return material_add(test.scene, &desc);
}

static ppm_material_id single_sided(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.double_sided = 0;
    return material_add(test.scene, &desc);
}

static float focus_in_effect(const ppm_render_options *options)
{
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(test.scene, options, &render), PPM_STATUS_OK);
    const float focus = ppm_render_get_options(render)->focus_distance_m;
    ppm_render_destroy(render);
    return focus;
}

static void without_a_distance_the_middle_of_the_picture_is_in_focus(void **state)
{
    (void)state;
    camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 1.0f);
    add_wall(veil(0.3f), 1.0f, false);
    add_wall(single_sided(), 1.5f, true);
    add_wall(veil(0.8f), 2.0f, false);
    add_wall(material_lambert(test.scene, 0.5f), 3.0f, false);
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 9, 0);
    options.aperture_f_number = 2.8f;
    assert_near(focus_in_effect(&options), 2.0, 1e-5);
    options.crop[2] = options.crop[3] = 1; /* the middle of the whole picture all the same */
    assert_near(focus_in_effect(&options), 2.0, 1e-5);
    options.focus_distance_m = 7.0f;
    assert_near(focus_in_effect(&options), 7.0, 0.0);
    ppm_render_options resolved;
    assert_int_equal(ppm_render_options_resolve(test.scene, &options, &resolved), PPM_STATUS_OK);
    assert_near(resolved.aperture_f_number, 2.8, 1e-6);
}

static void an_empty_middle_cannot_be_focused_on(void **state)
{
    (void)state;
    camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 1.0f);
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(1, 1, -3), vec3(1, 0, 0),
             vec3(0, 1, 0));
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 9, 0);
    options.aperture_f_number = 2.8f;
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_INVALID_ARGUMENT);
    assert_null(render);
    options.aperture_f_number = INFINITY; /* a pinhole does not mind */
    assert_near(focus_in_effect(&options), 0.0, 0.0);
}

static void the_camera_of_the_scene_has_a_lens_of_its_own(void **state)
{
    (void)state;
    const ppm_camera_desc desc = {.size = sizeof desc,
                                  .y_fov_rad = 1.0f,
                                  .transform = {[0] = 1, [5] = 1, [10] = 1, [15] = 1},
                                  .f_number = 4.0f,
                                  .focus_distance_m = 2.5f};
    ppm_camera_id id = 0;
    assert_int_equal(ppm_scene_add_camera(test.scene, &desc, &id), PPM_STATUS_OK);
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 9, 0), resolved;
    assert_int_equal(ppm_render_options_resolve(test.scene, &options, &resolved), PPM_STATUS_OK);
    assert_near(resolved.aperture_f_number, 4.0, 0.0);
    assert_near(resolved.focus_distance_m, 2.5, 0.0);
    options.aperture_f_number = INFINITY;
    assert_int_equal(ppm_render_options_resolve(test.scene, &options, &resolved), PPM_STATUS_OK);
    assert_true(isinf(resolved.aperture_f_number));
}

static void apertures_that_change_nothing_are_warned_about(void **state)
{
    (void)state;
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 2.0f);
    add_wall(material_lambert(test.scene, 0.5f), 1.0f, false);
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 9, 0);
    float *sharp = render_picture(test.scene, &options, 2);
    assert_int_equal(test.warnings, 0);
    options.aperture_f_number = 1.0f;
    float *asked = render_picture(test.scene, &options, 2);
    assert_int_equal(test.warnings, 1);
    assert_memory_equal(sharp, asked, 4 * 9 * 9 * sizeof *sharp);
    options.aperture_f_number = 0.0f;
    options.focus_distance_m = 1.0f;
    focus_in_effect(&options);
    assert_int_equal(test.warnings, 2);
    free(sharp);
    free(asked);
}

/* ---- options --------------------------------------------------------------------------------- */

static void bad_camera_options_are_refused(void **state)
{
    (void)state;
    build_edge(1.0f, 0.0f);
    enum { BAD = 14 };
    ppm_render_options bad[BAD];
    for (int i = 0; i < BAD; i++)
        bad[i] = edge_options();
    bad[0].aperture_f_number = -1.0f;
    bad[1].aperture_f_number = NAN;
    bad[2].aperture_f_number = 1e-9f;
    bad[3].focus_distance_m = -1.0f;
    bad[4].focus_distance_m = INFINITY;
    bad[5].shutter_open = NAN;
    bad[6].shutter_open = 1.0f;
    bad[7].shutter_close = INFINITY;
    bad[8].pixel_filter = 4;
    bad[9].pixel_filter_width = -1.0f;
    bad[10].pixel_filter_width = NAN;
    bad[11].pixel_filter_width = 1000.0f;
    memcpy(bad[12].crop, (uint32_t[4]){4, 0, 4, 9}, sizeof bad[12].crop);
    memcpy(bad[13].crop, (uint32_t[4]){0, 0, SIDE + 1, 9}, sizeof bad[13].crop);
    for (int i = 0; i < BAD; i++) {
        ppm_render_options resolved;
        const ppm_status status = ppm_render_options_resolve(test.scene, &bad[i], &resolved);
        if (status != PPM_STATUS_INVALID_ARGUMENT) fail_msg("case %d was taken", i);
    }
}

/* ---- crop ------------------------------------------------------------------------------------ */

/* Something to see at every depth, and light on it. */
static void build_clutter(void)
{
    camera_perspective(test.scene, vec3(0, 0, 4), vec3(0, 0, 0), 0.7f);
    light_point(test.scene, vec3(2, 3, 4), vec3(30, 30, 30));
    for (int i = 0; i < 12; i++) {
        const float x = 0.8f * sinf(2.4f * (float)i), y = 0.8f * cosf(2.4f * (float)i);
        shape_place_at(test.scene,
                       shape_sphere(test.scene, material_lambert(test.scene, 0.8f), 0.2f, 8, true),
                       vec3(x, y, 0.3f * (float)(i - 6)));
    }
}

/* With a lens and a filter that reach over the edges of the crop. */
static void a_crop_has_the_bits_of_the_whole(void **state)
{
    (void)state;
    build_clutter();
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 0);
    options.pixel_filter = PPM_PIXEL_FILTER_DEFAULT;
    options.aperture_f_number = 0.5f;
    options.focus_distance_m = 4.0f;
    options.shutter_close = 0.5f;
    float *whole = render_picture(test.scene, &options, 4);
    const uint32_t crops[][4] = {{0, 0, SIDE, 1}, {5, 7, 29, 18}, {31, 31, SIDE, SIDE}};
    for (int i = 0; i < 3; i++) {
        const uint32_t *crop = crops[i], width = crop[2] - crop[0];
        memcpy(options.crop, crop, sizeof options.crop);
        float *part = render_picture(test.scene, &options, 4);
        for (uint32_t y = crop[1]; y < crop[3]; y++) {
            assert_memory_equal(part + 4 * (size_t)(y - crop[1]) * width,
                                whole + 4 * ((size_t)y * SIDE + crop[0]), 4 * width * sizeof *part);
        }
        free(part);
    }
    free(whole);
}

/* ---- shutter --------------------------------------------------------------------------------- */

/* Time takes no numbers from the rest of the path. */
static void an_open_shutter_leaves_what_does_not_move_as_it_is(void **state)
{
    (void)state;
    build_clutter();
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 0);
    float *moment = render_picture(test.scene, &options, 4);
    options.shutter_open = -0.25f;
    options.shutter_close = 0.25f;
    float *open = render_picture(test.scene, &options, 4);
    assert_memory_equal(moment, open, 4 * SIDE * SIDE * sizeof *open);
    free(open);
    free(moment);
}

enum { PASSES = 64 };

/* As many strata of time as paths: each has one. */
static void the_paths_of_a_pixel_spread_evenly_over_the_shutter(void **state)
{
    (void)state;
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 0);
    options.seed = 5;
    const ppm_camera_id id = camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 1.0f);
    ppmi_job job = {.options = &options, .film = {0, 0, SIDE, SIDE}};
    ppmi_camera_view_init(&test.scene->cameras[id - 1], SIDE, SIDE, &job.view);
    ppmi_pixel_filter_init(&job.filter, PPM_PIXEL_FILTER_BOX, 1.0f);
    ppmi_walker walker = {.world = &job.world};
    assert_near(ppmi_start_camera_path(&job, &walker, 3, 4, 0).ray.time, 0.0, 0.0);
    options.shutter_close = 0.5f;
    float first[2] = {0.0f, 0.0f};
    for (uint32_t pixel = 0; pixel < 2; pixel++) {
        int counts[PASSES] = {0};
        for (uint64_t pass = 0; pass < PASSES; pass++) {
            const float time = ppmi_start_camera_path(&job, &walker, pixel, 4, pass).ray.time;
            assert_true(time >= 0.0f && time <= 1.0f);
            counts[(int)(time * (PASSES - 1e-3f))]++;
            if (pass == 0) first[pixel] = time;
        }
        for (int i = 0; i < PASSES; i++)
            assert_int_equal(counts[i], 1);
    }
    assert_true(first[0] < first[1] || first[0] > first[1]);
}

/* A wall at 3 m, before a lamp at 6 m, between which nothing is but a surface that alpha takes
 * away: a near plane behind the wall shows the lamp, a far one before the lamp nothing. */
static void the_camera_sees_what_is_between_its_planes(void **state)
{
    (void)state;
    static const float planes[][2] = {{0, 0}, {4, 0}, {4, 5.5f}, {0, 2}, {2, 4}};
    static const double green[] = {0, 2, 0, 0, 0}, alpha[] = {1, 1, 0, 0, 1};
    for (int i = 0; i < 5 * 3; i++) {
        test_scene own;
        scene_open(&own);
        ppm_material_desc nothing;
        ppm_material_desc_init(&nothing);
        nothing.alpha_mode = PPM_ALPHA_BLEND;
        nothing.base_color[3] = 0.0f;
        add_quad(own.scene, material_lambert(own.scene, 0.0f), vec3(-5, -5, 3), vec3(10, 0, 0),
                 vec3(0, 10, 0));
        add_quad(own.scene, material_add(own.scene, &nothing), vec3(-5, -5, 1), vec3(10, 0, 0),
                 vec3(0, 10, 0));
        add_quad(own.scene, material_emitter(own.scene, 2.0f, 0.0f, false), vec3(-5, -5, 0),
                 vec3(10, 0, 0), vec3(0, 10, 0));
        camera_perspective(own.scene, vec3(0, 0, 6), vec3(0, 0, 0), 0.5f);
        own.scene->cameras[0].near_m = planes[i / 3][0];
        own.scene->cameras[0].far_m = planes[i / 3][1];
        ppm_render_options options = render_options(1 + i % 3, 4, 1000);
        options.is_transparent = 1;
        float *picture = render_picture(own.scene, &options, 2);
        for (int k = 0; k < 4 * 4 * 4; k += 4) {
            assert_near(picture[k + 1], green[i / 3], 1e-5);
            assert_near(picture[k + 3], alpha[i / 3], 1e-6);
        }
        free(picture);
        scene_close(&own);
    }
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(bad_camera_options_are_refused),
        WITH_SCENE(an_edge_is_the_integral_of_the_filter),
        WITH_SCENE(the_blur_of_an_edge_is_that_of_a_thin_lens),
        WITH_SCENE(the_plane_of_focus_is_sharp),
        WITH_SCENE(the_camera_sees_what_is_between_its_planes),
        WITH_SCENE(without_a_distance_the_middle_of_the_picture_is_in_focus),
        WITH_SCENE(an_empty_middle_cannot_be_focused_on),
        WITH_SCENE(the_camera_of_the_scene_has_a_lens_of_its_own),
        WITH_SCENE(apertures_that_change_nothing_are_warned_about),
        WITH_SCENE(a_crop_has_the_bits_of_the_whole),
        WITH_SCENE(an_open_shutter_leaves_what_does_not_move_as_it_is),
        WITH_SCENE(the_paths_of_a_pixel_spread_evenly_over_the_shutter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
