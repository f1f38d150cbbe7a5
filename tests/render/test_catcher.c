/* Catchers: over the plate a picture with catchers is the picture without; what the rest of the
 * scene neither lights nor shades is transparent. */
#include "render/catcher.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/layer_fixture.h"
#include "support/near.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE, PASSES = 16 };

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

/* ---- scenes ---------------------------------------------------------------------------------- */

static ppm_instance_id add_floor(void)
{
    return layers_add_quad(
        test.scene, "floor", material_lambert_rgb(test.scene, vec3(0.8f, 0.4f, 0.2f)),
        vec3(-200.0f, 0.0f, 200.0f), vec3(400.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -400.0f));
}

/* A black square of side 2 at height 1. */
static void add_lid(void)
{
    layers_add_quad(test.scene, "lid", material_lambert(test.scene, 0.0f), vec3(-1.0f, 1.0f, 1.0f),
                    vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
}

/* The floor is a catcher, in the light of an even sky. */
static void open_floor(float y_fov_rad)
{
    const ppm_instance_id floor = add_floor();
    assert_int_equal(ppm_scene_set_instance_catcher(test.scene, floor, 1), PPM_STATUS_OK);
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_perspective(test.scene, vec3(0.0f, 6.0f, 8.0f), vec3(0.0f, 0.0f, 0.0f), y_fov_rad);
}

/* ---- renders --------------------------------------------------------------------------------- */

static ppm_render *finished(int32_t integrator)
{
    ppm_render_options options = layers_options(SIDE, PPM_LAYER_CATCHER);
    options.height = SIDE;
    options.integrator = integrator;
    options.photons_per_pass = 4096;
    return layers_render(test.scene, &options, PASSES);
}

/* The layer of the catchers alone. */
static float *plate_of(int32_t integrator)
{
    assert_int_equal(ppm_scene_show_catchers_alone(test.scene, 1), PPM_STATUS_OK);
    ppm_render *render = finished(integrator);
    float *plate = layers_read(render, PPM_LAYER_CATCHER, 0);
    ppm_render_destroy(render);
    assert_int_equal(ppm_scene_show_catchers_alone(test.scene, 0), PPM_STATUS_OK);
    return plate;
}

typedef struct pictures {
    float whole[4 * PIXELS], caught[4 * PIXELS];
    float *plate;
} pictures;

/* The picture before it is given the plate, and after. */
static void render_both(int32_t integrator, pictures *out)
{
    out->plate = plate_of(integrator);
    ppm_render *render = finished(integrator);
    assert_int_equal(ppm_render_read_image(render, out->whole, 4 * PIXELS), PPM_STATUS_OK);
    assert_int_equal(ppm_render_set_plate(render, out->plate, 4 * PIXELS), PPM_STATUS_OK);
    assert_int_equal(ppm_render_read_image(render, out->caught, 4 * PIXELS), PPM_STATUS_OK);
    ppm_render_destroy(render);
}

/* ---- tests ----------------------------------------------------------------------------------- */

static void a_plate_needs_a_catcher_and_the_right_size(void **state)
{
    (void)state;
    float plate[4 * PIXELS] = {0.0f};
    const ppm_instance_id floor = add_floor();
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    assert_int_equal(ppm_scene_catcher_count(test.scene), 0);
    ppm_render *render = finished(PPM_INTEGRATOR_PATH);
    assert_int_equal(ppm_render_set_plate(render, plate, 4 * PIXELS), PPM_STATUS_WRONG_STATE);
    assert_int_equal(ppm_scene_set_instance_catcher(test.scene, floor, 1), PPM_STATUS_WRONG_STATE);
    ppm_render_destroy(render);
    assert_int_equal(ppm_scene_set_instance_catcher(test.scene, 7, 1), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_set_instance_catcher(test.scene, floor, 1), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_catcher_count(test.scene), 1);
    render = finished(PPM_INTEGRATOR_PATH);
    assert_int_equal(ppm_render_set_plate(render, plate, PIXELS), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_render_set_plate(render, NULL, 4 * PIXELS), PPM_STATUS_INVALID_ARGUMENT);
    ppm_render_destroy(render);
}

static void catchers_alone_are_not_seen(void **state)
{
    (void)state;
    static const int32_t integrators[] = {PPM_INTEGRATOR_PATH, PPM_INTEGRATOR_SPPM,
                                          PPM_INTEGRATOR_PPM};
    open_floor(0.8f);
    for (size_t k = 0; k < 3; k++) {
        pictures both;
        render_both(integrators[k], &both);
        for (size_t i = 0; i < 4 * PIXELS; i++) {
            assert_true(both.whole[i] > 0.0f);
            assert_near(both.caught[i], 0.0, 1e-5);
        }
        free(both.plate);
    }
}

static void over_the_plate_the_picture_is_what_it_was(void **state)
{
    (void)state;
    static const int32_t integrators[] = {PPM_INTEGRATOR_PATH, PPM_INTEGRATOR_SPPM,
                                          PPM_INTEGRATOR_PPM};
    open_floor(0.8f);
    add_lid();
    for (size_t k = 0; k < 3; k++) {
        pictures both;
        bool is_seen = false;
        render_both(integrators[k], &both);
        for (size_t i = 0; i < PIXELS; i++) {
            const float through = 1.0f - both.caught[4 * i + 3];
            is_seen = is_seen || through < 0.5f;
            for (size_t c = 0; c < 3; c++) {
                const float over = both.caught[4 * i + c] + through * both.plate[4 * i + c];
                assert_near(over, both.whole[4 * i + c], 1e-4);
            }
        }
        assert_true(is_seen);
        free(both.plate);
    }
}

/* Of a point below the middle of a square of side 2 h at height h, the square hides
 * 4 / (pi sqrt 2) atan(1 / sqrt 2) of an even sky's light (view factor of a parallel rectangle). */
static void a_shadow_is_alpha(void **state)
{
    (void)state;
    const double hidden = 4.0 / (3.14159265358979 * sqrt(2.0)) * atan(1.0 / sqrt(2.0));
    open_floor(0.01f);
    add_lid();
    pictures both;
    render_both(PPM_INTEGRATOR_PATH, &both);
    double whole = 0.0, plate = 0.0, alpha = 0.0;
    for (size_t i = 0; i < PIXELS; i++) {
        whole += (double)both.whole[4 * i + 1];
        plate += (double)both.plate[4 * i + 1];
        alpha += (double)both.caught[4 * i + 3] / PIXELS;
    }
    assert_near(1.0 - whole / plate, hidden, 0.02);
    assert_near(alpha, hidden, 0.03);
    free(both.plate);
}

/* The light of what shines is the photograph's: it is there in the plate too. */
static void shining_things_light_the_plate(void **state)
{
    (void)state;
    const ppm_instance_id floor = add_floor();
    assert_int_equal(ppm_scene_set_instance_catcher(test.scene, floor, 1), PPM_STATUS_OK);
    layers_add_quad(test.scene, "lamp", material_emitter(test.scene, 10.0f, 0.0f, true),
                    vec3(-1.0f, 9.0f, 1.0f), vec3(2.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -2.0f));
    camera_perspective(test.scene, vec3(0.0f, 6.0f, 8.0f), vec3(0.0f, 0.0f, 0.0f), 0.3f);
    float *plate = plate_of(PPM_INTEGRATOR_PATH);
    double sum = 0.0;
    for (size_t i = 0; i < PIXELS; i++)
        sum += (double)plate[4 * i];
    assert_true(sum > 0.0);
    free(plate);
}

static void added_light_is_colour_without_alpha(void **state)
{
    (void)state;
    const float catchers[8] = {0.6f, 0.3f, 0.2f, 1.0f, 0.2f, 0.1f, 0.1f, 0.5f};
    const float plate[8] = {0.5f, 0.2f, 0.2f, 1.0f, 0.8f, 0.4f, 0.2f, 1.0f};
    float rgba[8] = {0.6f, 0.3f, 0.2f, 1.0f, 0.9f, 0.9f, 0.9f, 1.0f};
    ppmi_catcher_take_plate(catchers, plate, 2, rgba);
    const float added[4] = {0.1f, 0.1f, 0.0f, 0.0f};
    for (int c = 0; c < 4; c++)
        assert_near(rgba[c], added[c], 1e-6);
    /* half covered; light is 0.4 0.2 0.1 there: half of it is kept at least */
    const float half[4] = {0.7f, 0.8f, 0.85f, 0.75f};
    for (int c = 0; c < 4; c++)
        assert_near(rgba[4 + c], half[c], 1e-6);
}

#define WITH_SCENE(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_plate_needs_a_catcher_and_the_right_size),
        WITH_SCENE(catchers_alone_are_not_seen),
        WITH_SCENE(over_the_plate_the_picture_is_what_it_was),
        WITH_SCENE(a_shadow_is_alpha),
        WITH_SCENE(shining_things_light_the_plate),
        cmocka_unit_test(added_light_is_colour_without_alpha),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
