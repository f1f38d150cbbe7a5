/* The session: options, determinism, cancelling, statistics. */
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static test_scene test;

/* A box with a lamp, a glass ball and something half transparent: all that draws numbers. */
static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    ppm_scene *scene = test.scene;
    const ppm_material_id wall = material_lambert_rgb(scene, vec3(0.7f, 0.5f, 0.3f));
    shape_place(scene, shape_box(scene, wall, vec3_splat(-1), vec3_splat(1), 1, true));
    add_quad(scene, material_emitter(scene, 10.0f, 0.0f, false), vec3(-0.3f, 0.99f, -0.3f),
             vec3(0.6f, 0, 0), vec3(0, 0, 0.6f));
    shape_place_at(scene, shape_sphere(scene, material_glass(scene, 1.5f, 0.0f), 0.3f, 16, true),
                   vec3(0.2f, -0.5f, 0.0f));
    ppm_material_desc veil;
    ppm_material_desc_init(&veil);
    veil.alpha_mode = PPM_ALPHA_BLEND;
    veil.base_color[3] = 0.5f;
    add_quad(scene, material_add(scene, &veil), vec3(-0.9f, -0.9f, -0.5f), vec3(0.8f, 0, 0),
             vec3(0, 0.8f, 0));
    camera_perspective(scene, vec3(0, 0, 0.95f), vec3(0, -0.1f, -1), 1.2f);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static void bad_options_are_refused(void **state)
{
    (void)state;
    ppm_render *render = NULL;
    ppm_render_options bad[14];
    for (int i = 0; i < 14; i++)
        bad[i] = render_options(PPM_INTEGRATOR_SPPM, 8, 1000);
    bad[0].size = 4;
    bad[1].integrator = 99;
    bad[2].alpha = 1.5f;
    bad[3].alpha = NAN;
    bad[4].radius_m = -1.0f;
    bad[5].camera = 2;
    bad[6].width = 1u << 20;
    bad[7].photons_per_pass = UINT64_MAX;
    bad[8].integrator = PPM_INTEGRATOR_PPM;
    bad[8].schedule = PPM_SCHEDULE_MEMORYLESS;
    bad[9].photons_per_epoch = 1000; /* of sppm */
    bad[10].split_depth = 99;
    bad[11].schedule = 9;
    bad[12].direct = -1;
    bad[13].integrator = PPM_INTEGRATOR_PATH;
    bad[13].schedule = PPM_SCHEDULE_MEMORYLESS;
    for (int i = 0; i < 14; i++) {
        assert_int_equal(ppm_render_create(test.scene, &bad[i], &render),
                         PPM_STATUS_INVALID_ARGUMENT);
        assert_null(render);
    }
    assert_int_equal(ppm_render_create(NULL, NULL, &render), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_render_create(test.scene, NULL, NULL), PPM_STATUS_INVALID_ARGUMENT);
}

static void an_empty_scene_cannot_be_rendered(void **state)
{
    (void)state;
    test_scene empty;
    scene_open(&empty);
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(empty.scene, NULL, &render), PPM_STATUS_WRONG_STATE);
    assert_null(render);
    scene_close(&empty);
}

/* Hidden, with its lamp: an empty frame has the surroundings, and no surroundings are made up. */
static void an_empty_frame_is_a_picture(void **state)
{
    (void)state;
    static const int32_t integrators[] = {PPM_INTEGRATOR_PATH, PPM_INTEGRATOR_SPPM,
                                          PPM_INTEGRATOR_PPM};
    light_point(test.scene, vec3(0, 0.5f, 0), vec3_splat(1.0f));
    light_directional(test.scene, vec3(0, -1, 0), vec3_splat(1.0f));
    for (uint32_t i = 1; i <= test.scene->instance_count; i++)
        assert_int_equal(ppm_scene_set_instance_visible(test.scene, i, 0), PPM_STATUS_OK);
    for (int k = 0; k < 6; k++) {
        ppm_render_options options = render_options(integrators[k / 2], 8, 1000);
        options.is_transparent = k == 0;
        if (k == 1) light_environment(test.scene, vec3(0.5f, 0.25f, 2.0f), 0, 0.0f);
        if (k == 2) scene_fog(test.scene, vec3_splat(0.1f), vec3_splat(0.1f), 0.0f);
        float *picture = render_picture(test.scene, &options, 2);
        for (size_t i = 0; i < 4 * 8 * 8; i += 4) {
            assert_float_equal(picture[i], k == 0 ? 0.0 : 0.5, 1e-6);
            assert_float_equal(picture[i + 2], k == 0 ? 0.0 : 2.0, 1e-6);
            assert_float_equal(picture[i + 3], k == 0 ? 0.0 : 1.0, 0.0);
        }
        free(picture);
    }
}

static void defaults_are_resolved(void **state)
{
    (void)state;
    ppm_render_options resolved;
    assert_int_equal(ppm_render_options_resolve(test.scene, NULL, &resolved), PPM_STATUS_OK);
    assert_int_equal(resolved.integrator, PPM_INTEGRATOR_SPPM);
    assert_int_equal(resolved.width, 1280);
    assert_int_equal(resolved.height, 720);
    assert_int_equal(resolved.photons_per_pass, 1280 * 720);
    assert_int_equal(resolved.max_depth, 4096);
    assert_int_equal(resolved.camera, 1);
    assert_near(resolved.alpha, 2.0 / 3.0, 1e-6);
    assert_true(resolved.threads >= 1);
}

static void a_scene_without_camera_and_light_gets_both(void **state)
{
    (void)state;
    test_scene bare;
    scene_open(&bare);
    shape_place(bare.scene,
                shape_sphere(bare.scene, material_lambert(bare.scene, 1.0f), 1.0f, 32, true));
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 8, 0);
    float *rgba = render_picture(bare.scene, &options, 16);
    assert_near(rgba[4 * (4 * 8 + 4)], 1.0, 0.05); /* a white ball under 1 nit, by eye */
    assert_int_equal(ppm_scene_camera_count(bare.scene), 1);
    free(rgba);
    scene_close(&bare);
}

enum { SIDE = 24, FLOATS = 4 * SIDE * SIDE };

static void assert_same_picture(const float *a, const float *b, bool same)
{
    assert_int_equal(memcmp(a, b, FLOATS * sizeof *a) == 0, same);
}

static void the_same_seed_gives_the_same_bits_with_any_threads(void **state)
{
    (void)state;
    for (int32_t integrator = PPM_INTEGRATOR_SPPM; integrator <= PPM_INTEGRATOR_PPM; integrator++) {
        ppm_render_options options = render_options(integrator, SIDE, 5000);
        options.threads = 1;
        float *one = render_picture(test.scene, &options, 3);
        const uint32_t threads[] = {1, 2, 7};
        for (int i = 0; i < 3; i++) {
            options.threads = threads[i];
            float *other = render_picture(test.scene, &options, 3);
            assert_same_picture(one, other, true);
            free(other);
        }
        options.seed = 1;
        float *other_seed = render_picture(test.scene, &options, 3);
        assert_same_picture(one, other_seed, false);
        free(other_seed);
        free(one);
    }
}

/* Ways that the loop above does not go: epochs, the memoryless schedule, photons for direct light,
 * each in fog and through dispersive glass. */
enum { WAYS = 5 };

static ppm_render_options way(int i, uint64_t photons)
{
    ppm_render_options options =
        render_options(i < 3 ? PPM_INTEGRATOR_PPM : PPM_INTEGRATOR_SPPM, SIDE, photons);
    if (i == 1 || i == 2) options.photons_per_epoch = 2 * photons;
    if (i == 2 || i == 4) options.direct = PPM_DIRECT_PHOTONS;
    if (i == 3) options.schedule = PPM_SCHEDULE_MEMORYLESS;
    return options;
}

static void add_fog_and_a_prism(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    desc.dispersion = 0.8f;
    shape_place_at(test.scene,
                   shape_sphere(test.scene, material_add(test.scene, &desc), 0.3f, 16, true),
                   vec3(-0.4f, 0.3f, -0.2f));
    scene_fog(test.scene, vec3(0.3f, 0.2f, 0.1f), vec3_splat(0.1f), 0.4f);
}

static void fog_epochs_and_dispersion_are_the_same_with_any_threads(void **state)
{
    (void)state;
    add_fog_and_a_prism();
    for (int i = 0; i < WAYS; i++) {
        ppm_render_options options = way(i, 3000);
        float *one = render_picture(test.scene, &options, 5);
        const uint32_t threads[] = {2, 7};
        for (int k = 0; k < 2; k++) {
            options.threads = threads[k];
            float *other = render_picture(test.scene, &options, 5);
            assert_same_picture(one, other, true);
            free(other);
        }
        free(one);
    }
}

/* Memory that runs out, in the making or in a pass, is a status; what was finished stays, and the
 * next pass goes on as if nothing had been. */
static void failing_memory_is_reported_in_fog_too(void **state)
{
    (void)state;
    add_fog_and_a_prism();
    static float before[FLOATS], after[FLOATS];
    for (int i = 0; i < WAYS; i++) {
        const ppm_render_options options = way(i, 500);
        ppm_render *render = NULL;
        ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
        for (size_t n = 1; status != PPM_STATUS_OK; n++) {
            ppmi_alloc_fail_at(test.context, n);
            status = ppm_render_create(test.scene, &options, &render);
            ppmi_alloc_fail_at(test.context, 0);
            assert_true(status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY);
        }
        /* three passes, the third begins an epoch; each may fail at any allocation */
        for (int pass = 0; pass < 3; pass++) {
            if (pass > 0) {
                assert_int_equal(ppm_render_read_image(render, before, FLOATS), PPM_STATUS_OK);
            }
            status = PPM_STATUS_OUT_OF_MEMORY;
            for (size_t n = 1; status != PPM_STATUS_OK; n++) {
                ppmi_alloc_fail_at(test.context, n);
                status = ppm_render_advance(render);
                ppmi_alloc_fail_at(test.context, 0);
                assert_true(status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY);
                if (pass == 0 || status == PPM_STATUS_OK) continue;
                assert_int_equal(ppm_render_read_image(render, after, FLOATS), PPM_STATUS_OK);
                assert_same_picture(before, after, true);
            }
        }
        assert_int_equal(ppm_render_read_image(render, after, FLOATS), PPM_STATUS_OK);
        ppm_render_destroy(render);
        float *whole = render_picture(test.scene, &options, 3);
        assert_same_picture(after, whole, true);
        free(whole);
    }
}

/* A pass has to differ from the one before, and reading must not change anything. */
static void passes_go_on_whether_the_picture_is_read_or_not(void **state)
{
    (void)state;
    const ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, SIDE, 5000);
    ppm_render *render = NULL;
    static float pictures[3][FLOATS];
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    assert_int_equal(ppm_render_read_image(render, pictures[0], FLOATS), PPM_STATUS_WRONG_STATE);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
        assert_int_equal(ppm_render_read_image(render, pictures[i], FLOATS), PPM_STATUS_OK);
    }
    assert_int_equal(ppm_render_read_image(render, pictures[0], FLOATS - 1),
                     PPM_STATUS_INVALID_ARGUMENT);
    ppm_render_destroy(render);
    assert_same_picture(pictures[0], pictures[1], false);
    float *unread = render_picture(test.scene, &options, 3);
    assert_same_picture(pictures[2], unread, true);
    for (int i = 0; i < FLOATS; i++)
        assert_true(isfinite(pictures[2][i]) && pictures[2][i] >= 0.0f);
    free(unread);
}

static void statistics_count(void **state)
{
    (void)state;
    const ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, SIDE, 5000);
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    for (int i = 0; i < 3; i++)
        assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
    ppm_render_stats stats = {.size = sizeof stats};
    assert_int_equal(ppm_render_get_stats(render, &stats), PPM_STATUS_OK);
    assert_int_equal(stats.passes, 3);
    assert_int_equal(stats.photons_emitted, 15000);
    assert_int_equal(stats.eye_paths, 3 * SIDE * SIDE);
    assert_true(stats.photons_stored > 5000 && stats.rays > stats.photons_stored);
    assert_int_equal(stats.threads, 1);
    ppm_render_destroy(render);
}

static void a_cancelled_session_stays_so(void **state)
{
    (void)state;
    const ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, SIDE, 5000);
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    ppm_render_cancel(render);
    assert_int_equal(ppm_render_advance(render), PPM_STATUS_CANCELLED);
    assert_int_equal(ppm_render_advance(render), PPM_STATUS_CANCELLED);
    ppm_render_destroy(render);
    ppm_render_cancel(NULL);
    ppm_render_destroy(NULL);
}

static void *cancel_soon(void *render)
{
    const struct timespec while_ = {.tv_nsec = 20 * 1000 * 1000};
    nanosleep(&while_, NULL);
    ppm_render_cancel(render);
    return NULL;
}

/* Whenever the cancellation comes, the picture is that of the finished passes. */
static void cancelling_from_a_thread_leaves_the_picture(void **state)
{
    (void)state;
    for (int32_t integrator = PPM_INTEGRATOR_SPPM; integrator <= PPM_INTEGRATOR_PPM; integrator++) {
        ppm_render_options options = render_options(integrator, 160, 1u << 16);
        /* each pass of ppm begins an epoch */
        if (integrator == PPM_INTEGRATOR_PPM) options.photons_per_epoch = 1;
        options.threads = 2;
        const size_t floats = 4 * 160 * 160;
        ppm_render *render = NULL;
        assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
        assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
        pthread_t thread;
        assert_int_equal(pthread_create(&thread, NULL, cancel_soon, render), 0);
        ppm_status status = PPM_STATUS_OK;
        while (status == PPM_STATUS_OK)
            status = ppm_render_advance(render);
        pthread_join(thread, NULL);
        assert_int_equal(status, PPM_STATUS_CANCELLED);
        ppm_render_stats stats = {.size = sizeof stats};
        assert_int_equal(ppm_render_get_stats(render, &stats), PPM_STATUS_OK);
        float *left = malloc(floats * sizeof *left);
        assert_non_null(left);
        assert_int_equal(ppm_render_read_image(render, left, floats), PPM_STATUS_OK);
        ppm_render_destroy(render);
        float *whole = render_picture(test.scene, &options, (uint32_t)stats.passes);
        assert_memory_equal(left, whole, floats * sizeof *left);
        free(whole);
        free(left);
    }
}

static void several_sessions_share_a_scene(void **state)
{
    (void)state;
    const ppm_render_options options = render_options(PPM_INTEGRATOR_SPPM, SIDE, 5000);
    float *alone = render_picture(test.scene, &options, 2);
    ppm_render *first = NULL, *second = NULL;
    static float picture[FLOATS];
    assert_int_equal(ppm_render_create(test.scene, &options, &first), PPM_STATUS_OK);
    assert_int_equal(ppm_render_create(test.scene, &options, &second), PPM_STATUS_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ppm_render_advance(first), PPM_STATUS_OK);
        assert_int_equal(ppm_render_advance(second), PPM_STATUS_OK);
    }
    ppm_render_destroy(first);
    assert_int_equal(ppm_render_read_image(second, picture, FLOATS), PPM_STATUS_OK);
    assert_same_picture(alone, picture, true);
    ppm_render_destroy(second);
    free(alone);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(bad_options_are_refused),
        WITH_SCENE(an_empty_scene_cannot_be_rendered),
        WITH_SCENE(an_empty_frame_is_a_picture),
        WITH_SCENE(defaults_are_resolved),
        WITH_SCENE(a_scene_without_camera_and_light_gets_both),
        WITH_SCENE(the_same_seed_gives_the_same_bits_with_any_threads),
        WITH_SCENE(fog_epochs_and_dispersion_are_the_same_with_any_threads),
        WITH_SCENE(failing_memory_is_reported_in_fog_too),
        WITH_SCENE(passes_go_on_whether_the_picture_is_read_or_not),
        WITH_SCENE(statistics_count),
        WITH_SCENE(a_cancelled_session_stays_so),
        WITH_SCENE(cancelling_from_a_thread_leaves_the_picture),
        WITH_SCENE(several_sessions_share_a_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
