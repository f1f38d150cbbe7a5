/* Several images at once: ppm_scene_add_images. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

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

enum { COUNT = 40 };
static uint8_t pixels[COUNT];

static ppm_image_desc good(uint32_t width)
{
    return (ppm_image_desc){.size = sizeof(ppm_image_desc),
                            .role = PPM_IMAGE_DATA,
                            .pixels = pixels,
                            .pixel_type = PPM_PIXELS_U8,
                            .width = width,
                            .height = 1,
                            .channels = 1};
}

static ppm_image_desc bad(void)
{
    return (ppm_image_desc){
        .size = sizeof(ppm_image_desc), .role = PPM_IMAGE_DATA, .bytes = pixels, .byte_count = 9};
}

static void bad_arguments_are_refused_and_nothing_is_added(void **state)
{
    (void)state;
    ppm_image_desc descs[3] = {good(1), good(2), good(3)};
    ppm_image_id ids[3];
    ppm_status statuses[3];
    assert_int_equal(ppm_scene_add_images(NULL, descs, 3, ids, statuses),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_add_images(test.scene, NULL, 3, ids, statuses),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_add_images(test.scene, descs, 3, NULL, statuses),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_add_images(test.scene, descs, 3, ids, NULL),
                     PPM_STATUS_INVALID_ARGUMENT);
    descs[2].role = 9;
    assert_int_equal(ppm_scene_add_images(test.scene, descs, 3, ids, statuses),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(test.scene->image_count, 0);
    test.scene->is_frozen = true;
    assert_int_equal(ppm_scene_add_images(test.scene, descs, 2, ids, statuses),
                     PPM_STATUS_WRONG_STATE);
    test.scene->is_frozen = false;
    assert_int_equal(ppm_scene_add_images(test.scene, NULL, 0, NULL, NULL), PPM_STATUS_OK);
}

static void images_that_fail_do_not_keep_others_out(void **state)
{
    (void)state;
    ppm_image_desc descs[COUNT];
    ppm_image_id ids[COUNT];
    ppm_status statuses[COUNT];
    for (uint32_t i = 0; i < COUNT; i++)
        descs[i] = i % 3 == 1 ? bad() : good(i + 1);
    assert_int_equal(ppm_scene_add_images(test.scene, descs, COUNT, ids, statuses), PPM_STATUS_OK);
    uint32_t added = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        if (i % 3 == 1) {
            assert_int_equal(statuses[i], PPM_STATUS_INPUT_UNSUPPORTED);
            assert_int_equal(ids[i], 0);
            continue;
        }
        assert_int_equal(statuses[i], PPM_STATUS_OK);
        assert_int_equal(ids[i], ++added);
        assert_int_equal(test.scene->images[ids[i] - 1].width, i + 1);
    }
    assert_int_equal(test.scene->image_count, added);
}

/* Ids are counted on over the images that were added. Returns their number. */
static uint32_t count_added(const ppm_image_id *ids, const ppm_status *statuses)
{
    uint32_t added = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_true(statuses[i] == PPM_STATUS_OK || statuses[i] == PPM_STATUS_OUT_OF_MEMORY);
        assert_int_equal(ids[i], statuses[i] == PPM_STATUS_OK ? ++added : 0);
    }
    assert_int_equal(test.scene->image_count, added);
    return added;
}

static void each_allocation_that_fails_costs_one_image_or_all(void **state)
{
    (void)state;
    ppm_image_desc descs[COUNT];
    ppm_image_id ids[COUNT];
    ppm_status statuses[COUNT];
    uint32_t added = 0, n = 0;
    for (uint32_t i = 0; i < COUNT; i++)
        descs[i] = good(i + 1);
    while (added < COUNT) {
        scene_close(&test); /* nothing is left */
        scene_open(&test);
        ppmi_alloc_fail_at(test.context, ++n);
        const ppm_status status = ppm_scene_add_images(test.scene, descs, COUNT, ids, statuses);
        ppmi_alloc_fail_at(test.context, 0);
        assert_true(status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY);
        added = status == PPM_STATUS_OK ? count_added(ids, statuses) : 0;
        if (status == PPM_STATUS_OK) assert_true(added >= COUNT - 1);
    }
    assert_true(n > 2 * COUNT); /* pixels and names */
}

/* Infinite is what was too bright for the file: as bright as halves are, or as its brightest. */
static void floats_that_no_picture_can_have_are_mended(void **state)
{
    (void)state;
    static const float values[2][6] = {{INFINITY, NAN, -2.0f, 0.5f, -INFINITY, 4.0f},
                                       {INFINITY, 1e6f, 3e38f, 0.5f, -1e-6f, 4.0f}};
    static const float color[2][6] = {{65504, 0, 0, 0.5f, 0, 4}, {1e6f, 1e6f, 1e6f, 0.5f, 0, 4}};
    static const float data[2][6] = {{65504, 0, -2, 0.5f, -65504, 4},
                                     {1e6f, 1e6f, 1e6f, 0.5f, -1e-6f, 4}};
    for (int i = 0; i < 4; i++) {
        ppm_image_id id = 0;
        const ppm_image_desc desc = {.size = sizeof desc,
                                     .name = "sky.exr",
                                     .role = i < 2 ? PPM_IMAGE_COLOR : PPM_IMAGE_DATA,
                                     .pixels = values[i % 2],
                                     .pixel_type = PPM_PIXELS_F32,
                                     .width = 2,
                                     .height = 1,
                                     .channels = 3};
        assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
        const float *const got = test.scene->images[id - 1].f32;
        const float *const expected = i < 2 ? color[i % 2] : data[i % 2];
        for (int k = 0; k < 6; k++) {
            if (got[k] != expected[k]) {
                fail_msg("%d, %d: %g, not %g", i, k, (double)got[k], (double)expected[k]);
            }
        }
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(floats_that_no_picture_can_have_are_mended),
        TEST(bad_arguments_are_refused_and_nothing_is_added),
        TEST(images_that_fail_do_not_keep_others_out),
        TEST(each_allocation_that_fails_costs_one_image_or_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
