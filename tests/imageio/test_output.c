/* Pictures of a session as files. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "color/color.h"
#include "imageio/file.h"
#include "imageio/imageio.h"
#include "imageio/scratch.h"
#include "ppm/ppm.h"

enum { WIDTH = 6, HEIGHT = 4, VALUES = WIDTH * HEIGHT * 4 };

static ppm_context *context;
static ppm_color *color;
static ppm_scene *scene;
static ppm_render *render;

/* A triangle under a sky of 0.5 nit. */
static void build_scene(void)
{
    static const float positions[9] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    static const uint32_t indices[3] = {0, 1, 2};
    const ppm_primitive_desc primitive = {
        .vertex_count = 3, .triangle_count = 1, .positions = positions, .indices = indices};
    const ppm_mesh_desc mesh = {
        .size = sizeof mesh, .primitive_count = 1, .primitives = &primitive};
    ppm_instance_desc instance = {.size = sizeof instance};
    for (int i = 0; i < 4; i++)
        instance.transform[5 * i] = 1;
    const ppm_environment_desc sky = {.size = sizeof sky, .radiance = {0.5f, 0.4f, 0.3f}};
    ppm_instance_id id = 0;
    assert_int_equal(ppm_scene_create(context, color, &scene), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_mesh(scene, &mesh, &instance.mesh), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_instance(scene, &instance, &id), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_environment(scene, &sky), PPM_STATUS_OK);
}

static int setup(void **state)
{
    (void)state;
    unsetenv("OCIO");
    scratch_create();
    assert_int_equal(ppm_context_create(NULL, &context), PPM_STATUS_OK);
    assert_int_equal(ppm_color_create(context, NULL, &color), PPM_STATUS_OK);
    build_scene();
    const ppm_render_options options = {.size = sizeof options,
                                        .width = WIDTH,
                                        .height = HEIGHT,
                                        .photons_per_pass = 100,
                                        .seed = UINT64_MAX,
                                        .threads = 1};
    return ppm_render_create(scene, &options, &render);
}

static int teardown(void **state)
{
    (void)state;
    ppm_render_destroy(render);
    ppm_scene_destroy(scene);
    ppm_color_destroy(color);
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    scratch_remove();
    return live == 0 ? 0 : 1;
}

static void advance(void)
{
    assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
}

static ppm_status write_picture(const char *name, const ppm_output_options *options)
{
    return ppm_render_write(render, color, scratch_path(name), options);
}

static ppmi_pixels read_picture(const char *name)
{
    ppmi_pixels pixels = {0};
    assert_int_equal(ppmi_imageio_read_file(context, scratch_path(name), name, &pixels),
                     PPM_STATUS_OK);
    assert_int_equal(pixels.width, WIDTH);
    assert_int_equal(pixels.height, HEIGHT);
    return pixels;
}

static bool file_contains(const char *name, const char *text)
{
    void *bytes = NULL;
    size_t byte_count = 0;
    assert_int_equal(ppmi_imageio_file_read(context, scratch_path(name), name, &bytes, &byte_count),
                     PPM_STATUS_OK);
    bool is_found = false;
    for (size_t i = 0; !is_found && i + strlen(text) <= byte_count; i++) {
        is_found = memcmp((const char *)bytes + i, text, strlen(text)) == 0;
    }
    ppmi_free(context, bytes);
    return is_found;
}

static void assert_file_contains(const char *name, const char *text)
{
    if (!file_contains(name, text)) fail_msg("%s does not contain \"%s\"", name, text);
}

static void assert_file_lacks(const char *name, const char *text)
{
    if (file_contains(name, text)) fail_msg("%s contains \"%s\"", name, text);
}

static void without_a_pass_there_is_no_file(void **state)
{
    (void)state;
    assert_int_equal(write_picture("a.exr", NULL), PPM_STATUS_WRONG_STATE);
    assert_int_equal(write_picture("a.png", NULL), PPM_STATUS_WRONG_STATE);
    assert_int_equal(scratch_count(), 0);
}

static void exr_holds_the_picture_as_it_is(void **state)
{
    (void)state;
    advance();
    float picture[VALUES];
    assert_int_equal(ppm_render_read_image(render, picture, VALUES), PPM_STATUS_OK);
    assert_int_equal(ppm_render_write(render, NULL, scratch_path("a.exr"), NULL), PPM_STATUS_OK);
    ppmi_pixels pixels = read_picture("a.exr");
    assert_int_equal(pixels.channels, 4);
    assert_memory_equal(pixels.f32, picture, sizeof picture);
    ppmi_imageio_pixels_free(context, &pixels);
}

static void exr_of_half_depth_is_near(void **state)
{
    (void)state;
    advance();
    const ppm_output_options half = {.size = sizeof half, .depth = PPM_DEPTH_HALF};
    assert_int_equal(write_picture("half.exr", &half), PPM_STATUS_OK);
    float picture[VALUES];
    assert_int_equal(ppm_render_read_image(render, picture, VALUES), PPM_STATUS_OK);
    ppmi_pixels pixels = read_picture("half.exr");
    float largest_error = 0;
    for (int i = 0; i < VALUES; i++) {
        largest_error = fmaxf(largest_error, fabsf(pixels.f32[i] - picture[i]) / picture[i]);
    }
    ppmi_imageio_pixels_free(context, &pixels);
    assert_true(largest_error > 0); /* 0.4 is no half */
    assert_true(largest_error <= 1.0f / 2048);
}

static void exr_header_tells_how_it_was_made(void **state)
{
    (void)state;
    advance();
    advance();
    const ppm_output_options options = {.size = sizeof options, .command = "ppm-render scene.glb"};
    assert_int_equal(write_picture("a.exr", &options), PPM_STATUS_OK);
    static const char *const texts[] = {
        "chromaticities",
        "ppm-render 0.",
        "ppm:version",
        "ppm:options",
        "width=6",
        "height=4",
        "photons_per_pass=100",
        "ppm:photons",
        "ppm:integrator",
        "sppm",
        "ppm:seed",
        "18446744073709551615",
        "ppm:command",
        "scene.glb",
        "ppm:passes",
        "lin_rec709",
        "crop=0,0,6,4",
        "filter=blackman-harris,3",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_file_contains("a.exr", texts[i]);
    }
}

static void all_formats_tell_whose_the_scene_is(void **state)
{
    (void)state;
    static const char *const names[] = {"of.exr", "of.png", "of.jpg", "of.tif"};
    const ppm_output_options options = {
        .size = sizeof options, .copyright = "(c) 2026 A Potter", .xmp = "{\"dc:title\":\"Cup\"}"};
    const ppm_output_options nothing = {.size = sizeof nothing, .copyright = "", .xmp = ""};
    advance();
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        assert_int_equal(write_picture(names[i], &options), PPM_STATUS_OK);
        assert_file_contains(names[i], "(c) 2026 A Potter");
    }
    assert_file_contains("of.exr", "owner"); /* OpenEXR's standard name */
    assert_file_contains("of.exr", "ppm:xmp");
    assert_file_contains("of.exr", "{\"dc:title\":\"Cup\"}");
    assert_int_equal(write_picture("of.exr", &nothing), PPM_STATUS_OK);
    assert_file_lacks("of.exr", "owner");
    assert_file_lacks("of.exr", "ppm:xmp");
}

/* What a session of its own with these options says in its header. */
static void assert_header_contains(ppm_render_options options, const char *text)
{
    options.size = sizeof options;
    options.width = options.height = 4;
    options.integrator = PPM_INTEGRATOR_PATH;
    ppm_render *other = NULL;
    assert_int_equal(ppm_render_create(scene, &options, &other), PPM_STATUS_OK);
    assert_int_equal(ppm_render_advance(other), PPM_STATUS_OK);
    assert_int_equal(ppm_render_write(other, color, scratch_path("header.exr"), NULL),
                     PPM_STATUS_OK);
    assert_file_contains("header.exr", text);
    ppm_render_destroy(other);
}

static void exr_header_tells_about_the_camera(void **state)
{
    (void)state;
    assert_header_contains((ppm_render_options){.crop = {1, 0, 4, 2}}, "crop=1,0,4,2");
    assert_header_contains((ppm_render_options){.pixel_filter = PPM_PIXEL_FILTER_BOX},
                           "filter=box,1");
    assert_header_contains(
        (ppm_render_options){.pixel_filter = PPM_PIXEL_FILTER_GAUSSIAN, .pixel_filter_width = 2.5f},
        "filter=gaussian,2.5");
    assert_header_contains((ppm_render_options){.shutter_open = -0.5f, .shutter_close = 0.25f},
                           "shutter=-0.5,0.25");
    assert_header_contains(
        (ppm_render_options){.aperture_f_number = 4.0f, .focus_distance_m = 2.0f},
        "aperture=4 focus_m=2");
}

/* Read back, the rest of the picture is there and black. */
static void a_crop_is_the_data_window_of_its_exr_and_all_of_its_png(void **state)
{
    (void)state;
    const ppm_render_options options = {.size = sizeof options,
                                        .width = WIDTH,
                                        .height = HEIGHT,
                                        .photons_per_pass = 10,
                                        .crop = {1, 2, 4, 4}};
    enum { PART = 3 * 2 };
    float part[4 * PART];
    ppm_render *other = NULL;
    assert_int_equal(ppm_render_create(scene, &options, &other), PPM_STATUS_OK);
    assert_int_equal(ppm_render_advance(other), PPM_STATUS_OK);
    assert_int_equal(ppm_render_read_image(other, part, 4 * PART), PPM_STATUS_OK);
    const char *const names[] = {"part.exr", "part.png", "part.jpg", "part.tif"};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(ppm_render_write(other, color, scratch_path(names[i]), NULL),
                         PPM_STATUS_OK);
        ppmi_pixels pixels;
        assert_int_equal(ppmi_imageio_read_file(context, scratch_path(names[i]), names[i], &pixels),
                         PPM_STATUS_OK);
        assert_int_equal(pixels.width, i == 0 ? WIDTH : 3);
        assert_int_equal(pixels.height, i == 0 ? HEIGHT : 2);
        for (uint32_t p = 0; i == 0 && p < WIDTH * HEIGHT; p++) {
            const uint32_t x = p % WIDTH, y = p / WIDTH;
            const bool is_in_part = x >= 1 && x < 4 && y >= 2;
            const float expected = is_in_part ? part[4 * ((y - 2) * 3 + x - 1)] : 0.0f;
            assert_true(pixels.f32[4 * p] >= expected && pixels.f32[4 * p] <= expected);
        }
        ppmi_imageio_pixels_free(context, &pixels);
    }
    ppm_render_destroy(other);
}

/* A file of code values against the view of the picture. */
static void assert_shows_picture(const char *name, const ppm_output_options *options,
                                 float tolerance)
{
    float picture[VALUES];
    assert_int_equal(ppm_render_read_image(render, picture, VALUES), PPM_STATUS_OK);
    const ppmi_view_choice choice = {.display = options->display,
                                     .view = options->view,
                                     .look = options->look,
                                     .exposure_ev = options->exposure_ev,
                                     .gamma = options->gamma};
    assert_int_equal(ppmi_color_show(context, color, &choice, &ppmi_working_space_rec709, picture,
                                     WIDTH * HEIGHT),
                     PPM_STATUS_OK);
    assert_int_equal(write_picture(name, options), PPM_STATUS_OK);
    ppmi_pixels pixels = read_picture(name);
    assert_int_equal(pixels.channels, 3);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        for (int c = 0; c < 3; c++) {
            const float expected = fminf(fmaxf(picture[4 * i + c], 0), 1);
            const float value =
                pixels.u8 ? (float)pixels.u8[3 * i + c] / 255 : pixels.f32[3 * i + c];
            assert_float_equal(value, expected, tolerance);
        }
    }
    ppmi_imageio_pixels_free(context, &pixels);
}

static void display_files_go_through_the_view(void **state)
{
    (void)state;
    advance();
    ppm_output_options options = {.size = sizeof options, .dither = PPM_DITHER_OFF};
    assert_shows_picture("a.png", &options, 0.51f / 255);
    options.view = "Standard";
    options.exposure_ev = 0.5f;
    assert_shows_picture("b.png", &options, 0.51f / 255);
    assert_shows_picture("b.tif", &options, 0.51f / 65535);
    assert_shows_picture("b.jpg", &options, 12.0f / 255);
}

static void wrong_arguments_write_nothing(void **state)
{
    (void)state;
    advance();
    ppm_output_options options = {.size = sizeof options};
    assert_int_equal(ppm_render_write(NULL, color, scratch_path("a.exr"), NULL),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_render_write(render, color, NULL, NULL), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_render_write(render, NULL, scratch_path("a.png"), NULL),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(write_picture("a.gif", NULL), PPM_STATUS_INVALID_ARGUMENT);
    options.exposure_ev = NAN;
    assert_int_equal(write_picture("a.png", &options), PPM_STATUS_INVALID_ARGUMENT);
    options = (ppm_output_options){.size = sizeof options, .depth = 3};
    assert_int_equal(write_picture("a.exr", &options), PPM_STATUS_INVALID_ARGUMENT);
    options = (ppm_output_options){.size = 4};
    assert_int_equal(write_picture("a.exr", &options), PPM_STATUS_INVALID_ARGUMENT);
    options = (ppm_output_options){.size = sizeof options, .view = "Standrad"};
    assert_int_equal(write_picture("a.png", &options), PPM_STATUS_NOT_FOUND);
    assert_int_equal(write_picture("none/a.png", NULL), PPM_STATUS_OUTPUT_NOT_WRITABLE);
    assert_int_equal(scratch_count(), 0);
}

static void a_path_can_be_checked_beforehand(void **state)
{
    (void)state;
    assert_int_equal(ppm_output_check(context, scratch_path("a.JPEG")), PPM_STATUS_OK);
    assert_int_equal(ppm_output_check(context, scratch_path("a.txt")), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_output_check(context, scratch_path("none/a.exr")),
                     PPM_STATUS_OUTPUT_NOT_WRITABLE);
    assert_int_equal(ppm_output_check(context, NULL), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(scratch_count(), 0);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    advance();
    static const char *const names[] = {"a.exr", "a.png"};
    for (int i = 0; i < 2; i++) {
        ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
        for (size_t n = 1; status == PPM_STATUS_OUT_OF_MEMORY; n++) {
            ppmi_alloc_fail_at(context, n);
            status = write_picture(names[i], NULL);
            assert_true(status == PPM_STATUS_OK ? n > 3 : n < 20);
            assert_int_equal(scratch_count(), i + (status == PPM_STATUS_OK));
        }
        ppmi_alloc_fail_at(context, 0);
        assert_int_equal(status, PPM_STATUS_OK);
    }
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(without_a_pass_there_is_no_file),
        TEST(exr_holds_the_picture_as_it_is),
        TEST(exr_of_half_depth_is_near),
        TEST(exr_header_tells_how_it_was_made),
        TEST(all_formats_tell_whose_the_scene_is),
        TEST(exr_header_tells_about_the_camera),
        TEST(a_crop_is_the_data_window_of_its_exr_and_all_of_its_png),
        TEST(display_files_go_through_the_view),
        TEST(wrong_arguments_write_nothing),
        TEST(a_path_can_be_checked_beforehand),
        TEST(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
