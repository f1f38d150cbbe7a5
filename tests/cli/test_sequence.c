/* Several pictures in one run: frames and cameras, the names of their files, and what is left when
 * a run ends early. */
#include <setjmp.h>
#include <signal.h>
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

#define QUICK "-s 16x8 -n 1 -i path "

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

static bool is_there(const char *path)
{
    return access(path, F_OK) == 0;
}

/* names, ended by NULL, are there; removes them, so that the next test finds none */
static void assert_there(const char *const *names)
{
    for (; *names; names++) {
        if (remove(*names) != 0) fail_msg("there is no %s", *names);
    }
}

static ppmi_pixels read_picture(const char *path)
{
    ppmi_pixels pixels = {0};
    const ppm_status status = ppmi_imageio_read_file(NULL, path, path, &pixels);
    if (status != PPM_STATUS_OK) fail_msg("%s: %s", path, ppm_status_name(status));
    return pixels;
}

static bool has_same_pixels(const char *path_a, const char *path_b)
{
    ppmi_pixels a = read_picture(path_a), b = read_picture(path_b);
    const size_t bytes = (size_t)a.width * a.height * a.channels * sizeof *a.f32;
    assert_true(a.width == b.width && a.height == b.height && a.channels == b.channels);
    const bool is_same = memcmp(a.f32, b.f32, bytes) == 0;
    ppmi_imageio_pixels_free(NULL, &a);
    ppmi_imageio_pixels_free(NULL, &b);
    return is_same;
}

/* ---- what is refused ------------------------------------------------------------------------- */

static void bad_values_name_option_and_value(void **state)
{
    (void)state;
    assert_refused("--frame 1.5 moving.gltf", "--frame: '1.5' is not a whole number");
    assert_refused("--frame 1-5 moving.gltf", "--frame: '1-5'");
    assert_refused("--frames 1-5/0 moving.gltf", "--frames: '1-5/0' is not frames like 1-24");
    assert_refused("--frames all moving.gltf", "--frames: 'all'");
    assert_refused("--frames 0-9999999 moving.gltf", "at most a million");
    assert_refused("--frame 1 --fps 0 moving.gltf", "--fps: '0' is not a number from 0.001");
    assert_refused("--frame 1 --fps 24/0 moving.gltf", "--fps: '24/0' is not a rate like 24");
    assert_refused("--frame 1 --fps 1/2/3 moving.gltf", "--fps: '1/2/3' is not a rate like 24");
    assert_refused("--frame 1 --shutter 0,1 --motion-steps 1 moving.gltf",
                   "--motion-steps: '1' is not a whole number from 2 to 129");
}

static void options_that_would_do_nothing_are_refused(void **state)
{
    (void)state;
    assert_refused("--frame 1 --frames 1-2 moving.gltf", "--frame and --frames both");
    assert_refused("--fps 25 moving.gltf", "--fps is about --frame and --frames");
    assert_refused("--animation Slide moving.gltf", "--animation is played by --frame");
    assert_refused("--motion-steps 4 --frame 1 moving.gltf", "--motion-steps is about --shutter");
}

static void bad_patterns_are_refused_before_anything_is_read(void **state)
{
    (void)state;
    assert_refused("--frames 1-2 -o a_%x.exr missing.gltf", "--output: 'a_%x.exr': a '%' is not");
    assert_refused("--frames 1-2 -o %d_%d.exr missing.gltf", "more than one place for the frame");
    assert_refused("--camera all -o a_%04d.exr missing.gltf", "neither --frame nor --frames");
    assert_refused("--frames 1-2 -o a_%c.exr missing.gltf", "no --camera all");
    assert_refused("--frames 1-2 --stats %d%d.json missing.gltf", "--stats: '%d%d.json'");
}

static void names_that_only_the_file_knows_are_answered_with_its_own(void **state)
{
    (void)state;
    assert_refused(QUICK "--frame 1 --animation Slid moving.gltf", "no animation 'Slid'; ");
    assert_refused(QUICK "--scene Hall moving.gltf", "--scene: no scene 'Hall'; there is 1");
    assert_refused(QUICK "--scene 2 moving.gltf", "--scene: no scene '2'");
    assert_refused(QUICK "--variant Red moving.gltf", "no variant 'Red': the file has none");
    assert_refused(QUICK "--camera Fron moving.gltf",
                   "no camera 'Fron'; there are 2: 'Front', 'Side'; did you mean 'Front'?");
}

/* ---- names of files -------------------------------------------------------------------------- */

static void every_output_of_every_frame_is_written(void **state)
{
    (void)state;
    run_well(QUICK "--frames 3-1/2 -o a.%04d.exr -o b_##.png moving.gltf");
    assert_there((const char *const[]){"a.0003.exr", "a.0001.exr", "b_03.png", "b_01.png", NULL});
    assert_false(is_there("a.0002.exr"));
}

static void a_number_is_put_into_a_name_without_a_place_and_said(void **state)
{
    (void)state;
    const outcome result = run_well(QUICK "--frames -1-0 -o a.exr moving.gltf");
    assert_contains(result.err, "'a.exr' has no place for the frame");
    assert_contains(result.err, "as in a.-001.exr");
    assert_there((const char *const[]){"a.-001.exr", "a.0000.exr", NULL});
}

static void one_frame_fills_a_pattern_and_needs_none(void **state)
{
    (void)state;
    run_well(QUICK "--frame 12 -o a%04d.exr -o plain.exr moving.gltf");
    assert_there((const char *const[]){"a0012.exr", "plain.exr", NULL});
}

static void a_still_picture_takes_names_as_they_are(void **state)
{
    (void)state;
    run_well(QUICK "-o '100%_#1_%04d.exr' moving.gltf");
    assert_there((const char *const[]){"100%_#1_%04d.exr", NULL});
}

static void all_cameras_have_files_by_their_names(void **state)
{
    (void)state;
    run_well(QUICK "--camera all moving.gltf");
    run_well(QUICK "--camera all --frames 1-2 -o a_%d.exr -o %c-%d.png moving.gltf");
    run_well(QUICK "--camera Side -o side.exr moving.gltf");
    assert_true(has_same_pixels("side.exr", "moving.Side.exr"));
    assert_false(has_same_pixels("side.exr", "moving.Front.exr"));
    assert_there((const char *const[]){"moving.Front.exr", "moving.Side.exr", "moving.Front.png",
                                       "moving.Side.png", "side.exr", NULL});
    assert_there((const char *const[]){"a_Front_1.exr", "a_Side_1.exr", "a_Front_2.exr",
                                       "a_Side_2.exr", "Front-1.png", "Side-1.png", "Front-2.png",
                                       "Side-2.png", NULL});
}

/* ---- frames ---------------------------------------------------------------------------------- */

static void a_frame_alone_has_the_bits_that_it_has_in_a_sequence(void **state)
{
    (void)state;
    run_well("-s 16x8 -n 2 -p 4096 --frames 1-3 -o all_%d.exr moving.gltf");
    run_well("-s 16x8 -n 2 -p 4096 --frame 3 -o alone.exr --threads 1 moving.gltf");
    assert_true(has_same_pixels("all_3.exr", "alone.exr"));
    assert_false(has_same_pixels("all_2.exr", "all_3.exr")); /* the noise, at least */
    assert_there((const char *const[]){"all_1.exr", "all_2.exr", "all_3.exr", "alone.exr", NULL});
}

/* The moving scene without the use of its cameras. */
static void write_bare_scene(void)
{
    static char text[8192];
    FILE *const from = fopen("moving.gltf", "r"), *const to = fopen("bare.gltf", "w");
    assert_true(from && to);
    const size_t length = fread(text, 1, sizeof text, from);
    for (char *use = text; (use = memmem(use, length - (size_t)(use - text), "\"camera\"", 8));)
        use[1] = 'k';
    assert_int_equal(fwrite(text, 1, length, to), length);
    fclose(from);
    fclose(to);
}

/* What moves changes the box around the scene: the camera that frames it must not follow. */
static void all_frames_are_framed_alike(void **state)
{
    (void)state;
    write_bare_scene();
    run_well(QUICK "--frames 0-24/24 --animation Slide -o b%d.exr bare.gltf");
    run_well(QUICK "--frame 24 --animation Slide -o alone.exr bare.gltf");
    run_well(QUICK "--camera all -o still.exr bare.gltf");
    assert_true(has_same_pixels("b24.exr", "alone.exr"));
    assert_there((const char *const[]){"b0.exr", "b24.exr", "alone.exr", "still.camera.exr", NULL});
}

/* The first 4096 bytes of a file hold an EXR's header. */
static void assert_header_holds(const char *path, const void *bytes, size_t count)
{
    char header[4096];
    FILE *const file = fopen(path, "rb");
    assert_non_null(file);
    const size_t length = fread(header, 1, sizeof header, file);
    fclose(file);
    if (!memmem(header, length, bytes, count)) fail_msg("%s: not in the header", path);
}

/* name, type and size as OpenEXR stores them, all little-endian. */
static void the_header_says_which_frame_it_is(void **state)
{
    (void)state;
    static const char frame[] = "ppm:frame\0int\0\4\0\0\0\xfd\xff\xff\xff";            /* -3 */
    static const char time[] = "ppm:time\0float\0\4\0\0\0\0\0\0\xbf";                  /* -0.5 */
    static const char rate[] = "framesPerSecond\0rational\0\10\0\0\0\6\0\0\0\1\0\0\0"; /* 6/1 */
    run_well(QUICK "--frame -3 --fps 6 -o frame.exr moving.gltf");
    assert_header_holds("frame.exr", frame, sizeof frame - 1);
    assert_header_holds("frame.exr", time, sizeof time - 1);
    assert_header_holds("frame.exr", rate, sizeof rate - 1);
    run_well(QUICK "-o still.exr moving.gltf");
    static const char film[] = "framesPerSecond\0rational\0\10\0\0\0\xc0\x5d\0\0\xe9\3\0\0";
    run_well(QUICK "--frame 1 --fps 24000/1001 -o film.exr moving.gltf");
    assert_header_holds("film.exr", film, sizeof film - 1);
    assert_there((const char *const[]){"film.exr", "frame.exr", "still.exr", NULL});
}

static void pictures_carry_what_the_file_says_about_itself(void **state)
{
    (void)state;
    static const char owner[] = "owner\0string\0\13\0\0\0002026 nobody";
    static const char xmp[] = "ppm:xmp\0string\0\24\0\0\0{\"dc:title\": \"Tiny\"}";
    run_well(QUICK "-o owned.exr tiny.gltf");
    assert_header_holds("owned.exr", owner, sizeof owner - 1);
    assert_header_holds("owned.exr", xmp, sizeof xmp - 1);
    assert_there((const char *const[]){"owned.exr", NULL});
}

static void a_file_of_a_camera_alone_has_pictures(void **state)
{
    (void)state;
    FILE *file = fopen("camera.gltf", "w");
    assert_non_null(file);
    fputs("{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],"
          "\"nodes\":[{\"camera\":0}],\"cameras\":[{\"type\":\"perspective\","
          "\"perspective\":{\"yfov\":1,\"znear\":0.1}}]}",
          file);
    assert_int_equal(fclose(file), 0);
    run_well(QUICK "--frames 1-2 -o empty.%04d.exr camera.gltf");
    assert_there((const char *const[]){"empty.0001.exr", "empty.0002.exr", NULL});
    remove("camera.gltf");
}

static void animations_that_are_not_played_are_told(void **state)
{
    (void)state;
    const outcome still = run_well(QUICK "-o still.exr moving.gltf");
    assert_contains(still.err, "2 animations not played");
    assert_contains(still.err, "--frames 0-24 (0 to 1 s)");
    const outcome moved = run_well(QUICK "--frame 1 -o still.exr moving.gltf");
    assert_contains(moved.err, "2 animations are played together");
    const outcome none = run_well(QUICK "--frame 1 -o still.exr tiny.gltf");
    assert_contains(none.err, "has no animation");
    assert_there((const char *const[]){"still.exr", NULL});
}

/* ---- what is there already ------------------------------------------------------------------- */

static void only_missing_pictures_are_rendered(void **state)
{
    (void)state;
    static const char command[] =
        QUICK "--skip-existing --frames 1-3 -o a.%d.exr -o a.%d.png moving.gltf";
    run_well(command);
    assert_int_equal(remove("a.2.png"), 0); /* one of the two files is enough */
    const outcome again = run_well(command);
    assert_contains(again.err, "frame 1 (1 of 3): a.1.exr is there already");
    assert_contains(again.err, "frame 2 (2 of 3): 1 pass");
    assert_contains(again.err, "1 picture rendered, 2 skipped");
    assert_true(is_there("a.2.png"));
    /* with nothing to do, the scene is not even read */
    const outcome none =
        run_well(QUICK "--skip-existing --frames 1-3 -o a.%d.exr -o a.%d.png missing.gltf");
    assert_contains(none.err, "0 pictures rendered, 3 skipped");
    assert_there((const char *const[]){"a.1.exr", "a.2.exr", "a.3.exr", "a.1.png", "a.2.png",
                                       "a.3.png", NULL});
}

/* An empty file, the beginning of one, one of another size. */
static void what_is_not_whole_is_rendered_again(void **state)
{
    (void)state;
    static const char *const endings[] = {"exr", "png", "jpg", "tif"};
    for (int i = 0; i < 4; i++) {
        char command[160], name[16];
        snprintf(command, sizeof command,
                 QUICK "--skip-existing --frames 1-4 -o w.%%d.%s moving.gltf", endings[i]);
        run_well(command);
        struct stat facts;
        snprintf(name, sizeof name, "w.1.%s", endings[i]);
        assert_int_equal(truncate(name, 0), 0);
        snprintf(name, sizeof name, "w.2.%s", endings[i]);
        assert_int_equal(stat(name, &facts), 0);
        assert_int_equal(truncate(name, facts.st_size / 2), 0);
        snprintf(name, sizeof name, "w.3.%s", endings[i]);
        assert_int_equal(stat(name, &facts), 0);
        assert_int_equal(truncate(name, facts.st_size - 1), 0);
        const outcome again = run_well(command);
        assert_contains(again.err, "3 pictures rendered, 1 skipped");
        assert_contains(run_well(command).err, "0 pictures rendered, 4 skipped");
        snprintf(command, sizeof command,
                 QUICK "-s 40x20 --skip-existing --frames 1-4 -o w.%%d.%s moving.gltf", endings[i]);
        assert_contains(run_well(command).err, "4 pictures rendered, 0 skipped");
        for (int frame = 1; frame <= 4; frame++) {
            snprintf(name, sizeof name, "w.%d.%s", frame, endings[i]);
            assert_int_equal(remove(name), 0);
        }
    }
}

static void cameras_that_are_there_are_skipped(void **state)
{
    (void)state;
    run_well(QUICK "--camera all -o a.exr moving.gltf");
    assert_int_equal(remove("a.Side.exr"), 0);
    const outcome again = run_well(QUICK "--camera all --skip-existing -o a.exr moving.gltf");
    assert_contains(again.err, "a.Front.exr is there already");
    assert_contains(again.err, "1 picture rendered, 1 skipped");
    assert_there((const char *const[]){"a.Front.exr", "a.Side.exr", NULL});
}

/* ---- ends ------------------------------------------------------------------------------------ */

/* Frames of seconds at least, so that the signal comes within one. */
static void an_interrupted_frame_is_not_written(void **state)
{
    (void)state;
    test_process process;
    start_program(&process,
                  "--frames 1-3 -s 32x16 -n 1000000000 -t 1000 -p 4096 -o cut.%d.exr moving.gltf");
    wait_for_text(&process, "rendering 32 x 16");
    kill(process.pid, SIGINT);
    const int status = wait_for_end(&process);
    if (status != 130) fail_msg("status %d: %s", status, process.err);
    assert_contains(process.err, "of frame 1 (1 of 3); that picture is not written");
    assert_contains(process.err, "0 of 3 pictures are there");
    assert_false(is_there("cut.1.exr"));
}

static void a_frame_to_be_skipped_when_there_is_whole(void **state)
{
    (void)state;
    test_process process;
    start_program(&process, "--frame 1 --skip-existing -s 32x16 -n 1000000000 -p 4096 -o cut.exr "
                            "moving.gltf");
    wait_for_text(&process, "pass 4/");
    kill(process.pid, SIGINT);
    const int status = wait_for_end(&process);
    if (status != 130) fail_msg("status %d: %s", status, process.err);
    assert_false(is_there("cut.exr"));
}

static void a_lost_folder_ends_the_sequence(void **state)
{
    (void)state;
    const outcome result = run_program(QUICK "--frames 1-2 -o no/such/a.exr moving.gltf");
    assert_int_equal(result.status, 3);
    assert_contains(result.err, "no/such/a.0001.exr");
}

/* ---- statistics ------------------------------------------------------------------------------ */

static json_t *read_json(const char *path)
{
    json_error_t error;
    json_t *const root = json_load_file(path, 0, &error);
    if (!root) fail_msg("%s: %s", path, error.text);
    return root;
}

static void one_file_of_statistics_holds_all_pictures(void **state)
{
    (void)state;
    run_well(QUICK "--frames 5-7/2 --fps 10 -o a.exr --stats all.json moving.gltf");
    json_t *const root = read_json("all.json");
    json_t *const pictures = json_object_get(root, "pictures");
    assert_int_equal(json_array_size(pictures), 2);
    json_t *const last = json_array_get(pictures, 1);
    assert_int_equal(json_integer_value(json_object_get(last, "frame")), 7);
    assert_true(json_real_value(json_object_get(last, "time_s")) == 0.7);
    assert_string_equal(json_string_value(json_object_get(last, "camera")), "Front");
    json_t *const files = json_object_get(last, "files");
    assert_string_equal(json_string_value(json_array_get(files, 0)), "a.0007.exr");
    json_t *const render = json_object_get(last, "render");
    assert_int_equal(json_integer_value(json_object_get(render, "passes")), 1);
    assert_null(json_object_get(root, "render"));
    json_decref(root);
    assert_there((const char *const[]){"a.0005.exr", "a.0007.exr", "all.json", NULL});
}

static void a_pattern_gives_each_picture_its_statistics(void **state)
{
    (void)state;
    run_well(QUICK "--frames 1-2 -o a.exr --stats s%02d.json moving.gltf");
    json_t *const root = read_json("s02.json");
    assert_int_equal(json_integer_value(json_object_get(root, "frame")), 2);
    assert_non_null(json_object_get(root, "render"));
    assert_true(json_is_array(json_object_get(root, "features")));
    json_decref(root);
    assert_there((const char *const[]){"a.0001.exr", "a.0002.exr", "s01.json", "s02.json", NULL});
}

static int setup(void **state)
{
    return folder_setup(state) == 0 && tiny_scene_write_moving("moving.gltf") ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_values_name_option_and_value),
        cmocka_unit_test(options_that_would_do_nothing_are_refused),
        cmocka_unit_test(bad_patterns_are_refused_before_anything_is_read),
        cmocka_unit_test(names_that_only_the_file_knows_are_answered_with_its_own),
        cmocka_unit_test(every_output_of_every_frame_is_written),
        cmocka_unit_test(a_number_is_put_into_a_name_without_a_place_and_said),
        cmocka_unit_test(one_frame_fills_a_pattern_and_needs_none),
        cmocka_unit_test(a_still_picture_takes_names_as_they_are),
        cmocka_unit_test(all_cameras_have_files_by_their_names),
        cmocka_unit_test(a_frame_alone_has_the_bits_that_it_has_in_a_sequence),
        cmocka_unit_test(all_frames_are_framed_alike),
        cmocka_unit_test(the_header_says_which_frame_it_is),
        cmocka_unit_test(pictures_carry_what_the_file_says_about_itself),
        cmocka_unit_test(a_file_of_a_camera_alone_has_pictures),
        cmocka_unit_test(animations_that_are_not_played_are_told),
        cmocka_unit_test(only_missing_pictures_are_rendered),
        cmocka_unit_test(what_is_not_whole_is_rendered_again),
        cmocka_unit_test(cameras_that_are_there_are_skipped),
        cmocka_unit_test(an_interrupted_frame_is_not_written),
        cmocka_unit_test(a_frame_to_be_skipped_when_there_is_whole),
        cmocka_unit_test(a_lost_folder_ends_the_sequence),
        cmocka_unit_test(one_file_of_statistics_holds_all_pictures),
        cmocka_unit_test(a_pattern_gives_each_picture_its_statistics),
    };
    return cmocka_run_group_tests(tests, setup, folder_teardown);
}
