/* What a finished render leaves: pictures, statistics, messages. */
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>
#include <jansson.h>

#include "cli/program.h"
#include "cli/tiny_scene.h"
#include "imageio/imageio.h"
#include "math/vec.h"
#include "support/near.h"

#define QUICK "-s 32x16 -n 3 -p 4096 "

static ppmi_pixels read_picture(const char *path)
{
    ppmi_pixels pixels = {0};
    const ppm_status status = ppmi_imageio_read_file(NULL, path, path, &pixels);
    if (status != PPM_STATUS_OK) fail_msg("%s: %s", path, ppm_status_name(status));
    return pixels;
}

static void assert_size(const char *path, uint32_t width, uint32_t height)
{
    ppmi_pixels pixels = read_picture(path);
    assert_int_equal(pixels.width, width);
    assert_int_equal(pixels.height, height);
    ppmi_imageio_pixels_free(NULL, &pixels);
}

static void assert_done(const char *arguments)
{
    const outcome result = run_program(arguments);
    if (result.status != 0) fail_msg("%s\nstatus %d: %s", arguments, result.status, result.err);
}

/* ---- pictures -------------------------------------------------------------------------------- */

static void default_outputs_are_named_after_the_input(void **state)
{
    (void)state;
    assert_done(QUICK "\"$PWD/tiny.gltf\"");
    assert_size("tiny.exr", 32, 16);
    assert_size("tiny.png", 32, 16);
}

static void every_output_is_written(void **state)
{
    (void)state;
    assert_done(QUICK "-o a.exr -o 'b c.png' --output=d.jpg -o e.tif tiny.gltf");
    assert_size("a.exr", 32, 16);
    assert_size("b c.png", 32, 16);
    assert_size("d.jpg", 32, 16);
    assert_size("e.tif", 32, 16);
}

static void the_default_size_follows_the_camera(void **state)
{
    (void)state;
    assert_done("-n 1 -p 1 -o default.png tiny.gltf"); /* the first camera's aspect is 2 */
    assert_size("default.png", 1280, 640);
}

static bool is_equal(const ppmi_pixels *a, const ppmi_pixels *b)
{
    assert_true(a->width == b->width && a->height == b->height && a->channels == b->channels);
    const size_t bytes = sizeof(float) * a->width * a->height * a->channels;
    return memcmp(a->f32, b->f32, bytes) == 0;
}

static bool pictures_are_equal(const char *path_a, const char *path_b)
{
    ppmi_pixels a = read_picture(path_a), b = read_picture(path_b);
    const bool result = is_equal(&a, &b);
    ppmi_imageio_pixels_free(NULL, &a);
    ppmi_imageio_pixels_free(NULL, &b);
    return result;
}

static void the_number_of_threads_does_not_change_a_bit(void **state)
{
    (void)state;
    assert_done(QUICK "--threads 1 -o one.exr tiny.gltf");
    assert_done(QUICK "--threads 2 -o two.exr tiny.gltf");
    assert_done(QUICK "--threads 7 -o seven.exr tiny.gltf");
    assert_true(pictures_are_equal("one.exr", "two.exr"));
    assert_true(pictures_are_equal("one.exr", "seven.exr"));
}

static void seed_and_camera_change_the_picture(void **state)
{
    (void)state;
    assert_done(QUICK "-o base.exr tiny.gltf");
    assert_done(QUICK "--seed 1 -o seed.exr tiny.gltf");
    assert_done(QUICK "--camera Side -o side.exr tiny.gltf");
    assert_done(QUICK "--camera 2 -o second.exr tiny.gltf");
    assert_false(pictures_are_equal("base.exr", "seed.exr"));
    assert_false(pictures_are_equal("base.exr", "side.exr"));
    assert_true(pictures_are_equal("side.exr", "second.exr"));
}

static double mean_code(const char *path)
{
    ppmi_pixels pixels = read_picture(path);
    assert_non_null(pixels.u8);
    const size_t count = (size_t)pixels.width * pixels.height;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += pixels.u8[i * pixels.channels];
    ppmi_imageio_pixels_free(NULL, &pixels);
    return sum / (double)count;
}

static void exposure_changes_display_files_only(void **state)
{
    (void)state;
    assert_done(QUICK "-o as-is.exr -o as-is.png tiny.gltf");
    assert_done(QUICK "--exposure 2 -o brighter.exr -o brighter.png tiny.gltf");
    assert_true(pictures_are_equal("as-is.exr", "brighter.exr"));
    assert_true(mean_code("brighter.png") > 1.2 * mean_code("as-is.png"));
}

static void a_path_tracer_can_be_chosen(void **state)
{
    (void)state;
    assert_done(QUICK "-i path -o path.exr --stats path.json tiny.gltf");
    assert_size("path.exr", 32, 16);
}

/* ---- statistics ------------------------------------------------------------------------------ */

static json_t *read_json(const char *path)
{
    json_error_t error;
    json_t *const root = json_load_file(path, 0, &error);
    if (!root) fail_msg("%s:%d: %s", path, error.line, error.text);
    return root;
}

static double number(const json_t *object, const char *name)
{
    const json_t *const value = json_object_get(object, name);
    if (!json_is_number(value)) fail_msg("no number '%s'", name);
    return json_number_value(value);
}

static void statistics_have_every_field(void **state)
{
    (void)state;
    static const char *const scene_fields[] = {"triangles", "instances", "materials", "textures",
                                               "lights"};
    static const char *const render_fields[] = {"width",
                                                "height",
                                                "passes",
                                                "photons_emitted",
                                                "photons_stored",
                                                "eye_paths",
                                                "rays",
                                                "seconds_total",
                                                "seconds_import",
                                                "seconds_build",
                                                "seconds_render",
                                                "seconds_eye",
                                                "seconds_photons",
                                                "seconds_gather",
                                                "threads",
                                                "photons_per_second",
                                                "rays_per_second",
                                                "peak_memory_bytes",
                                                "seed"};
    assert_done(QUICK "--stats all.json tiny.gltf");
    json_t *const root = read_json("all.json");
    assert_true(json_is_string(json_object_get(root, "version")));
    const json_t *const scene = json_object_get(root, "scene");
    for (size_t i = 0; i < sizeof scene_fields / sizeof scene_fields[0]; i++) {
        assert_true(number(scene, scene_fields[i]) >= 0.0);
    }
    const json_t *const render = json_object_get(root, "render");
    for (size_t i = 0; i < sizeof render_fields / sizeof render_fields[0]; i++) {
        assert_true(number(render, render_fields[i]) >= 0.0);
    }
    const double used = number(render, "photons_used_share");
    assert_true(used > 0.0 && used <= 1.0);
    const json_t *const lights = json_object_get(render, "photons_by_light");
    double sent = 0.0;
    for (size_t i = 0; i < json_array_size(lights); i++)
        sent += number(json_array_get(lights, i), "sent_share");
    assert_true(sent > 0.999 && sent < 1.001);
    json_decref(root);
}

static void statistics_say_what_was_done(void **state)
{
    (void)state;
    assert_done(QUICK "--threads 2 --seed 9223372036854775807 --stats some.json tiny.gltf");
    json_t *const root = read_json("some.json");
    const json_t *const scene = json_object_get(root, "scene");
    assert_true(number(scene, "triangles") == TINY_SCENE_TRIANGLES);
    assert_true(number(scene, "instances") == TINY_SCENE_INSTANCES);
    assert_true(number(scene, "materials") == TINY_SCENE_MATERIALS);
    assert_true(number(scene, "lights") == 2.0); /* the lamp's triangles */
    const json_t *const render = json_object_get(root, "render");
    assert_string_equal(json_string_value(json_object_get(render, "integrator")), "sppm");
    assert_true(number(render, "width") == 32.0);
    assert_true(number(render, "height") == 16.0);
    assert_true(number(render, "passes") == 3.0);
    assert_true(number(render, "photons_emitted") == 3.0 * 4096.0);
    assert_true(number(render, "threads") == 2.0);
    assert_int_equal(json_integer_value(json_object_get(render, "seed")), INT64_MAX);
    const double rate = number(render, "photons_emitted") / number(render, "seconds_render");
    assert_true(fabs(number(render, "photons_per_second") / rate - 1.0) < 1e-6);
    assert_true(number(render, "seconds_total") >= number(render, "seconds_render"));
    assert_true(number(render, "peak_memory_bytes") > 1e6);
    json_decref(root);
}

/* Renamed over, a device or a pipe would be lost to everyone else. */
static void statistics_are_written_into_a_pipe_not_over_it(void **state)
{
    (void)state;
    assert_int_equal(mkfifo("pipe.json", 0666), 0);
    const int pipe_end = open("pipe.json", O_RDWR); /* so that opening it does not wait */
    assert_done(QUICK "--stats pipe.json tiny.gltf");
    struct stat info;
    assert_int_equal(stat("pipe.json", &info), 0);
    assert_true(S_ISFIFO(info.st_mode));
    json_t *const root = json_loadfd(pipe_end, JSON_DISABLE_EOF_CHECK, NULL);
    assert_non_null(root);
    json_decref(root);
    close(pipe_end);
}

static double lights_with(const char *arguments)
{
    assert_done(arguments);
    json_t *const root = read_json("lights.json");
    const double lights = number(json_object_get(root, "scene"), "lights");
    json_decref(root);
    return lights;
}

static void an_environment_adds_to_the_lights_of_the_file(void **state)
{
    (void)state;
    const float white[4 * 2 * 3] = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
    const ppmi_image_file sky = {
        .width = 4, .height = 2, .channels = 3, .pixels = white, .store = PPMI_STORE_FLOAT};
    assert_int_equal(ppmi_imageio_write_file(NULL, "sky.exr", &sky), PPM_STATUS_OK);
    const double without = lights_with(QUICK "--stats lights.json tiny.gltf");
    const double with = lights_with(QUICK "--env sky.exr --stats lights.json tiny.gltf");
    assert_true(with == without + 1.0);
}

/* ---- surroundings ---------------------------------------------------------------------------- */

/* Radiance where the first camera, which looks north, sees nothing of the scene. */
static ppmi_vec3 sky_seen(const char *options)
{
    char arguments[256];
    snprintf(arguments, sizeof arguments, "-s 32x16 -n 1 -p 64 -o sky-seen.exr %s tiny.gltf",
             options);
    assert_done(arguments);
    ppmi_pixels pixels = read_picture("sky-seen.exr");
    const ppmi_vec3 color = vec3_load(pixels.f32 + (size_t)16 * pixels.channels); /* top middle */
    ppmi_imageio_pixels_free(NULL, &pixels);
    return color;
}

/* By direction: 1 north, 4 east, 3 south, 2 west. */
static void write_compass(void)
{
    static const float columns[8] = {3, 2, 2, 1, 1, 4, 4, 3};
    float pixels[2 * 8 * 3];
    for (int i = 0; i < 2 * 8 * 3; i++)
        pixels[i] = columns[i / 3 % 8];
    const ppmi_image_file file = {
        .width = 8, .height = 2, .channels = 3, .pixels = pixels, .store = PPMI_STORE_FLOAT};
    assert_int_equal(ppmi_imageio_write_file(NULL, "compass.exr", &file), PPM_STATUS_OK);
}

static void an_environment_turns_counter_clockwise_and_scales(void **state)
{
    (void)state;
    write_compass();
    assert_near(sky_seen("--env compass.exr").y, 1.0, 1e-5);
    assert_near(sky_seen("--env compass.exr --env-rotation 90").y, 4.0, 1e-4);
    assert_near(sky_seen("--env compass.exr --env-rotation=-90").y, 2.0, 1e-4);
    assert_near(sky_seen("--env compass.exr --env-rotation 180").y, 3.0, 1e-4);
    assert_near(sky_seen("--env compass.exr --env-intensity 2.5").y, 2.5, 1e-4);
}

static void a_background_hides_the_environment_from_the_camera_only(void **state)
{
    (void)state;
    write_compass();
    assert_near(sky_seen("--env compass.exr --background black").y, 0.0, 0.0);
    assert_near(sky_seen("--env compass.exr --background 0.5").y, 0.5, 1e-6);
    assert_near(sky_seen("--env compass.exr --background 0.1,0.2,0.3").z, 0.3, 1e-6);
    assert_near(sky_seen("--env compass.exr --background env").y, 1.0, 1e-5);
    assert_near(sky_seen("--background 0.5").y, 0.5, 1e-6);
    assert_true(lights_with(QUICK "--background 1 --stats lights.json tiny.gltf") ==
                lights_with(QUICK "--stats lights.json tiny.gltf"));
}

static void a_sun_brings_its_sky_unless_there_is_an_environment(void **state)
{
    (void)state;
    write_compass();
    const ppmi_vec3 sky = sky_seen("--sun 60,180");
    assert_true(sky.y > 1e3f && sky.y < 1e5f); /* nit */
    assert_near(sky_seen("--sun 60,180 --env-intensity 0.5").y / sky.y, 0.5, 1e-4);
    assert_near(sky_seen("--sun 60,180 --background black").y, 0.0, 0.0);
    assert_near(sky_seen("--sun 60,180 --env compass.exr").y, 1.0, 1e-5);
    const double without = lights_with(QUICK "--stats lights.json tiny.gltf");
    assert_true(lights_with(QUICK "--sun 60,180 --stats lights.json tiny.gltf") == without + 2.0);
}

static void a_time_of_nothing_still_gives_one_pass(void **state)
{
    (void)state;
    assert_done("-s 32x16 -p 4096 -t 1e-9 --stats time.json tiny.gltf");
    json_t *const root = read_json("time.json");
    assert_true(number(json_object_get(root, "render"), "passes") == 1.0);
    json_decref(root);
}

/* ---- messages -------------------------------------------------------------------------------- */

static void quiet_says_nothing(void **state)
{
    (void)state;
    const outcome result = run_program(QUICK "-q tiny.gltf");
    assert_int_equal(result.status, 0);
    assert_string_equal(result.out, "");
    assert_string_equal(result.err, "");
}

static void progress_is_plain_lines_where_there_is_no_terminal(void **state)
{
    (void)state;
    const outcome result = run_program(QUICK "tiny.gltf");
    assert_int_equal(result.status, 0);
    assert_string_equal(result.out, "");
    assert_contains(result.err, "pass 1/3   33%");
    assert_contains(result.err, "pass 2/3   66%");
    assert_contains(result.err, "3 passes in");
    assert_null(strchr(result.err, '\r'));
}

static void verbose_says_more(void **state)
{
    (void)state;
    const size_t normal = strlen(run_program(QUICK "tiny.gltf").err);
    const outcome verbose = run_program(QUICK "-v tiny.gltf");
    assert_int_equal(verbose.status, 0);
    assert_true(strlen(verbose.err) > normal);
}

/* ---- running out ----------------------------------------------------------------------------- */

/* The sanitizer reserves terabytes of addresses, so it gets a limit of its own instead. */
#if defined(__SANITIZE_ADDRESS__)
#define LITTLE_MEMORY "ASAN_OPTIONS=allocator_may_return_null=1:max_allocation_size_mb=1024"
#else
#define LITTLE_MEMORY "ulimit -v 4000000;"
#endif

static void too_large_a_picture_ends_with_four(void **state)
{
    (void)state;
    test_process process;
    start_wrapped_program(&process, LITTLE_MEMORY, "-s 65536x65536 -n 1 -o large.exr tiny.gltf");
    const int status = wait_for_end(&process);
    if (status != 4) fail_msg("status %d: %s", status, process.err);
    assert_contains(process.err, "memory");
    assert_int_equal(access("large.exr", F_OK), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(default_outputs_are_named_after_the_input),
        cmocka_unit_test(every_output_is_written),
        cmocka_unit_test(the_default_size_follows_the_camera),
        cmocka_unit_test(the_number_of_threads_does_not_change_a_bit),
        cmocka_unit_test(seed_and_camera_change_the_picture),
        cmocka_unit_test(exposure_changes_display_files_only),
        cmocka_unit_test(a_path_tracer_can_be_chosen),
        cmocka_unit_test(statistics_have_every_field),
        cmocka_unit_test(statistics_say_what_was_done),
        cmocka_unit_test(statistics_are_written_into_a_pipe_not_over_it),
        cmocka_unit_test(an_environment_adds_to_the_lights_of_the_file),
        cmocka_unit_test(an_environment_turns_counter_clockwise_and_scales),
        cmocka_unit_test(a_background_hides_the_environment_from_the_camera_only),
        cmocka_unit_test(a_sun_brings_its_sky_unless_there_is_an_environment),
        cmocka_unit_test(a_time_of_nothing_still_gives_one_pass),
        cmocka_unit_test(quiet_says_nothing),
        cmocka_unit_test(progress_is_plain_lines_where_there_is_no_terminal),
        cmocka_unit_test(verbose_says_more),
        cmocka_unit_test(too_large_a_picture_ends_with_four),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
