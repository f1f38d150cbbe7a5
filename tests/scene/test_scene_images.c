/* Several images at once: ppm_scene_add_images. */
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

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(bad_arguments_are_refused_and_nothing_is_added),
        TEST(images_that_fail_do_not_keep_others_out),
        TEST(each_allocation_that_fails_costs_one_image_or_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
