/* The camera's options: what is refused, and what they do to the picture. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <jansson.h>

#include "cli/program.h"
#include "imageio/imageio.h"

#define QUICK "-s 32x16 -n 2 -i path "

static void assert_refused(const char *arguments, const char *text)
{
    const outcome result = run_program(arguments);
    if (result.status != 1 || !strstr(result.err, text)) {
        fail_msg("%s\nstatus %d, expected 1\nexpected: %s\nsaid: %s", arguments, result.status,
                 text, result.err);
    }
}

static outcome run_well(const char *arguments)
{
    const outcome result = run_program(arguments);
    if (result.status != 0) fail_msg("%s\nstatus %d: %s", arguments, result.status, result.err);
    return result;
}

static void bad_values_are_refused(void **state)
{
    (void)state;
    assert_refused("--aperture 0 tiny.gltf", "--aperture: '0' is not a number from 0.001");
    assert_refused("--aperture f/2 tiny.gltf", "--aperture: 'f/2'");
    assert_refused("--shutter 1 tiny.gltf", "--shutter: '1'");
    assert_refused("--shutter 0.5,-0.5 tiny.gltf", "--shutter: '0.5,-0.5'");
    assert_refused("--crop 1,2,3 tiny.gltf", "--crop: '1,2,3'");
    assert_refused("--crop 5,0,5,9 tiny.gltf", "--crop: '5,0,5,9'");
    assert_refused("--crop 0,0,0.5,0.5 tiny.gltf", "--crop: '0,0,0.5,0.5'");
    assert_refused("--crop 0.0,0.0,0.5,1.5 tiny.gltf", "--crop: '0.0,0.0,0.5,1.5'");
    assert_refused("--crop -1,0,5,5 tiny.gltf", "--crop: '-1,0,5,5'");
    assert_refused("--filter bx tiny.gltf", "'bx' is not one of box, gaussian, blackman-harris; "
                                            "did you mean 'box'?");
    assert_refused("--filter box,0 tiny.gltf", "--filter: 'box,0'");
    assert_refused("--filter box, tiny.gltf", "--filter: 'box,'");
    assert_refused("--filter gaussian,wide tiny.gltf", "--filter: 'gaussian,wide'");
}

static void what_only_the_scene_can_tell_is_refused(void **state)
{
    (void)state;
    assert_refused("--aperture 2 --focus Flor tiny.gltf", "did you mean 'Floor'?");
    assert_refused("--aperture 2 --focus Front tiny.gltf", "'Front' is neither a distance nor");
    assert_refused("--aperture 2 --focus 0 tiny.gltf", "'0' is not a distance");
    assert_refused("--aperture 2 --focus -3 tiny.gltf", "'-3' is not a distance");
    assert_refused(QUICK "--crop 0,0,33,4 tiny.gltf", "crop 0,0,33,4");
    assert_refused(QUICK "--crop 0.001,0.0,0.002,1.0 tiny.gltf", "crop 0,0,0,16");
}

/* The camera stands at (0, 1, 3), turned down by a = 2 asin(0.1305262): the middle of the floor,
 * the origin, is sin(a) + 3 cos(a) along its axis, that of the lamp, (0, 1.5, 0), 3 cos(a) - sin(a)
 * / 2.
 */
static void a_node_is_focused_on_by_name(void **state)
{
    (void)state;
    run_well(QUICK "--aperture 0.05 --focus Floor -o floor.exr tiny.gltf");
    run_well(QUICK "--aperture 0.05 --focus Lamp -o lamp.exr tiny.gltf");
    const double a = 2.0 * asin(0.1305262);
    const double expected[] = {sin(a) + 3.0 * cos(a), 3.0 * cos(a) - 0.5 * sin(a)};
    const char *const names[] = {"floor.exr", "lamp.exr"};
    for (int i = 0; i < 2; i++) {
        char bytes[4096] = "";
        FILE *const file = fopen(names[i], "rb");
        assert_non_null(file);
        const size_t count = fread(bytes, 1, sizeof bytes - 1, file);
        fclose(file);
        const char *const mark = memmem(bytes, count, "focus_m=", 8);
        assert_non_null(mark);
        double focus = 0.0;
        assert_int_equal(sscanf(mark, "focus_m=%lf", &focus), 1);
        assert_true(fabs(focus - expected[i]) < 1e-4);
    }
}

static void a_scene_without_a_camera_has_one_to_focus_from(void **state)
{
    (void)state;
    FILE *const file = fopen("bare.obj", "w");
    assert_non_null(file);
    fputs("o Plate\nv 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n", file);
    fclose(file);
    const outcome result = run_well(QUICK "--aperture 2 --focus Plate -o bare.exr bare.obj");
    assert_contains(result.err, "no camera in the scene");
}

static void the_distance_that_was_found_is_said(void **state)
{
    (void)state;
    const outcome found = run_well(QUICK "--aperture 2 -o middle.exr tiny.gltf");
    assert_contains(found.err, "focused on what is in the middle of the picture, at 3.");
    const outcome useless = run_well(QUICK "--focus 2 -o sharp.exr tiny.gltf");
    assert_contains(useless.err, "changes nothing");
}

static ppmi_pixels read_picture(const char *path)
{
    ppmi_pixels pixels = {0};
    const ppm_status status = ppmi_imageio_read_file(NULL, path, path, &pixels);
    if (status != PPM_STATUS_OK) fail_msg("%s: %s", path, ppm_status_name(status));
    return pixels;
}

/* Whether two pictures are the same where part_of says so, as x0 y0 x1 y1. */
static bool is_same_within(const char *path_a, const char *path_b, const uint32_t part[4])
{
    ppmi_pixels a = read_picture(path_a), b = read_picture(path_b);
    assert_true(a.width == b.width && a.height == b.height && a.channels == b.channels);
    bool is_same = true;
    for (uint32_t y = part[1]; y < part[3]; y++) {
        const size_t first = ((size_t)y * a.width + part[0]) * a.channels;
        const size_t bytes = (size_t)(part[2] - part[0]) * a.channels * sizeof *a.f32;
        is_same = is_same && memcmp(a.f32 + first, b.f32 + first, bytes) == 0;
    }
    ppmi_imageio_pixels_free(NULL, &a);
    ppmi_imageio_pixels_free(NULL, &b);
    return is_same;
}

static void a_crop_is_a_part_of_the_picture(void **state)
{
    (void)state;
    static const uint32_t part[4] = {8, 4, 20, 12}, all[4] = {0, 0, 32, 16};
    run_well(QUICK "-o whole.exr tiny.gltf");
    run_well(QUICK "--crop 8,4,20,12 -o part.exr -o part.png tiny.gltf");
    run_well(QUICK "--crop 0.25,0.25,0.625,0.75 -o share.exr tiny.gltf");
    assert_true(is_same_within("whole.exr", "part.exr", part));
    assert_false(is_same_within("whole.exr", "part.exr", all));
    assert_true(is_same_within("share.exr", "part.exr", all));
    ppmi_pixels png = read_picture("part.png");
    assert_true(png.width == 12 && png.height == 8);
    ppmi_imageio_pixels_free(NULL, &png);
}

static double number(const json_t *object, const char *name)
{
    const json_t *const value = json_object_get(object, name);
    if (!json_is_number(value)) fail_msg("no number '%s'", name);
    return json_number_value(value);
}

static void statistics_are_about_the_crop(void **state)
{
    (void)state;
    run_well(QUICK "--crop 8,4,20,12 --stats crop.json -o crop.exr tiny.gltf");
    json_t *const root = json_load_file("crop.json", 0, NULL);
    assert_non_null(root);
    const json_t *const render = json_object_get(root, "render");
    assert_true(number(render, "width") == 12.0 && number(render, "height") == 8.0);
    assert_true(number(render, "full_width") == 32.0 && number(render, "full_height") == 16.0);
    assert_true(number(render, "eye_paths") == 2.0 * 12.0 * 8.0);
    const json_t *const crop = json_object_get(render, "crop");
    static const json_int_t sides[4] = {8, 4, 20, 12};
    assert_int_equal(json_array_size(crop), 4);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(json_integer_value(json_array_get(crop, i)), sides[i]);
    json_decref(root);
}

static void filter_and_aperture_change_the_picture_and_the_shutter_does_not(void **state)
{
    (void)state;
    static const uint32_t all[4] = {0, 0, 32, 16};
    run_well(QUICK "-o base.exr tiny.gltf");
    run_well(QUICK "--filter box -o box.exr tiny.gltf");
    run_well(QUICK "--filter blackman-harris,3 -o same.exr tiny.gltf");
    run_well(QUICK "--aperture 0.1 --focus 1.5 -o blurred.exr tiny.gltf");
    run_well(QUICK "--shutter -0.25,0.25 -o open.exr tiny.gltf");
    assert_false(is_same_within("base.exr", "box.exr", all));
    assert_true(is_same_within("base.exr", "same.exr", all));
    assert_false(is_same_within("base.exr", "blurred.exr", all));
    assert_true(is_same_within("base.exr", "open.exr", all)); /* nothing moves */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(what_only_the_scene_can_tell_is_refused),
        cmocka_unit_test(a_node_is_focused_on_by_name),
        cmocka_unit_test(a_scene_without_a_camera_has_one_to_focus_from),
        cmocka_unit_test(the_distance_that_was_found_is_said),
        cmocka_unit_test(a_crop_is_a_part_of_the_picture),
        cmocka_unit_test(statistics_are_about_the_crop),
        cmocka_unit_test(filter_and_aperture_change_the_picture_and_the_shutter_does_not),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
