/* What a compositor does with the files that the program writes: lamps apart, and things over a
 * photograph. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/program.h"
#include "cli/tiny_scene.h"
#include "imageio/layered_input.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE };
#define QUICK "-q -s 16x16 -n 2 -p 4096 "

/* The setup makes two groups of two lamps, beside the shining square that has none. */
static const char lamps[] = "{\"lights\":["
                            "{\"name\":\"A\",\"kind\":\"point\",\"position\":[-0.5,1,0],"
                            "\"candela\":2,\"color\":[1,0.5,0.1],\"light_group\":\"warm\"},"
                            "{\"name\":\"B\",\"kind\":\"point\",\"position\":[0.5,1,0],"
                            "\"candela\":1,\"color\":[0.1,0.5,1],\"light_group\":\"cold\"}]}";

static void write_text(const char *path, const char *text)
{
    FILE *const file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void run_well(const char *arguments)
{
    const outcome result = run_program(arguments);
    if (result.status != 0) fail_msg("%s\nstatus %d: %s", arguments, result.status, result.err);
}

/* One channel of a file of SIDE * SIDE pixels. */
static void read_channel(const char *path, const char *name, float out[PIXELS])
{
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    assert_int_equal(ppmi_layered_input_open(NULL, path, &input, &info), PPM_STATUS_OK);
    uint32_t channel = 0;
    while (channel < info.channel_count &&
           strcmp(ppmi_layered_input_channel(input, channel), name) != 0)
        channel++;
    if (channel == info.channel_count) fail_msg("%s has no channel %s", path, name);
    float *const values = malloc(sizeof *values * info.channel_count * PIXELS);
    assert_non_null(values);
    assert_int_equal(ppmi_layered_input_read(NULL, input, 0, SIDE, values), PPM_STATUS_OK);
    for (uint32_t i = 0; i < PIXELS; i++)
        out[i] = values[i * info.channel_count + channel];
    free(values);
    ppmi_layered_input_close(NULL, input);
}

static float largest(const float values[PIXELS])
{
    float most = 0.0f;
    for (uint32_t i = 0; i < PIXELS; i++)
        most = fmaxf(most, values[i]);
    return most;
}

static void groups_of_a_file_add_up_to_its_picture(void **state)
{
    (void)state;
    write_text("lamps.json", lamps);
    run_well(QUICK "--light-groups --setup lamps.json -o groups.exr tiny.gltf");
    static const char *const colours[] = {"R", "G", "B"};
    static const char *const groups[] = {"light.warm", "light.cold", "light.rest"};
    for (int c = 0; c < 3; c++) {
        float picture[PIXELS], sum[PIXELS] = {0}, part[PIXELS];
        read_channel("groups.exr", colours[c], picture);
        for (int g = 0; g < 3; g++) {
            char name[32];
            snprintf(name, sizeof name, "%s.%s", groups[g], colours[c]);
            read_channel("groups.exr", name, part);
            assert_true(largest(part) > 0.0f);
            for (uint32_t i = 0; i < PIXELS; i++)
                sum[i] += part[i];
        }
        for (uint32_t i = 0; i < PIXELS; i++)
            assert_true(fabsf(sum[i] - picture[i]) <= 4e-6f * fabsf(picture[i]) + 1e-12f);
    }
}

static void a_catcher_that_is_not_there_is_refused(void **state)
{
    (void)state;
    const outcome result = run_program(QUICK "--catcher Flor -o no.exr tiny.gltf");
    assert_int_equal(result.status, 1);
    assert_contains(result.err, "'Flor' is no node with a surface; did you mean 'Floor'?");
}

static void read_text(const char *path, const char *name, char out[64])
{
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    assert_int_equal(ppmi_layered_input_open(NULL, path, &input, &info), PPM_STATUS_OK);
    const ppmi_image_attribute *const found = ppmi_layered_input_find(input, name);
    assert_non_null(found);
    snprintf(out, 64, "%s", found->text);
    ppmi_layered_input_close(NULL, input);
}

/* A board stands on a wide floor. The plate has no board to frame, nor to focus on. */
static void the_view_is_that_of_all_things(void **state)
{
    (void)state;
    char plain[64], caught[64];
    write_text("board.obj", "v -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\n"
                            "v 7 0 0\nv 9 0 0\nv 9 8 0\nv 7 8 0\n"
                            "o Floor\nf 1 2 3 4\no Board\nf 5 6 7 8\n");
    run_well(QUICK "-i path -o plain.exr board.obj");
    run_well(QUICK "-i path --catcher Floor -o caught.exr board.obj");
    read_text("plain.exr", "ppm:cameraDigest", plain);
    read_text("caught.exr", "ppm:cameraDigest", caught);
    assert_string_equal(caught, plain);

    /* the board is in the middle; behind it the floor is farther off */
    write_text("board.ppm.json", "{\"cameras\":[{\"name\":\"C\",\"position\":[8,4,6],"
                                 "\"target\":[8,3,0],\"fov\":20}]}");
    const outcome lens =
        run_program("-s 16x16 -n 2 -i path --aperture 2 --catcher Floor -o caught.exr board.obj");
    assert_int_equal(lens.status, 0);
    assert_contains(lens.err, "focused on what is in the middle of the picture, at 6.");
    assert_null(strstr(strstr(lens.err, "focused on") + 1, "focused on"));
}

static void a_catchers_layer_without_a_catcher_is_refused(void **state)
{
    (void)state;
    const outcome result = run_program(QUICK "--aov caustics,catcher -o no.exr tiny.gltf");
    assert_int_equal(result.status, 1);
    assert_contains(result.err, "--aov catcher: there is no catcher in the scene");
    run_well(QUICK "--aov all -o all.exr tiny.gltf");
}

static void variances_of_light_layers_go_by_a_word(void **state)
{
    (void)state;
    float values[PIXELS];
    run_well("-q -s 16x16 -n 4 -i path --aov light_variance -o variance.exr tiny.gltf");
    read_channel("variance.exr", "variance.diffuse_direct.g", values);
    assert_true(largest(values) > 0.0f);
}

/* The floor has nothing on it: of both renders it is the same, but for the lamp's mesh before it.
 */
static void an_empty_catcher_is_clear(void **state)
{
    (void)state;
    run_well(QUICK "-i path --catcher Floor --aov catcher -o caught.exr tiny.gltf");
    float alpha[PIXELS], green[PIXELS], covered[PIXELS];
    read_channel("caught.exr", "A", alpha);
    read_channel("caught.exr", "G", green);
    read_channel("caught.exr", "catcher.A", covered);
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        if (covered[i] < 0.999f) continue;
        count++;
        assert_true(fabsf(alpha[i]) < 1e-5f);
        assert_true(fabsf(green[i]) < 1e-5f);
    }
    assert_true(count > 10);
}

/* ppm-merge goes by the digest: it would mix a picture with what lies over a photograph. */
static void with_a_catcher_it_is_another_scene(void **state)
{
    (void)state;
    char without[64], with[64];
    run_well(QUICK "--transparent -o without.exr tiny.gltf");
    run_well(QUICK "--catcher Floor -o with.exr tiny.gltf");
    read_text("without.exr", "ppm:sceneDigest", without);
    read_text("with.exr", "ppm:sceneDigest", with);
    assert_string_not_equal(with, without);
}

/* What is to lie over a photograph is as bright as that. */
static void a_catchers_brightness_is_not_judged(void **state)
{
    (void)state;
    static const char advice[] = "middle grey";
    const char *const dark = "-i path -s 16x16 -n 1 --exposure -20 -o dark.exr tiny.gltf";
    char arguments[256];
    assert_contains(run_program(dark).err, advice);
    snprintf(arguments, sizeof arguments, "--catcher Floor %s", dark);
    const outcome result = run_program(arguments);
    assert_int_equal(result.status, 0);
    assert_null(strstr(result.err, advice));
}

/* Of layers a file is much larger than of the picture alone; the disk has room for the latter. */
static void layers_without_room_cost_the_layers_only(void **state)
{
    (void)state;
    test_process process;
    start_wrapped_program(
        &process, "ulimit -f 256;",
        "-q -i path -s 64x64 -n 1 --aov all --exr-compression none -o full.exr tiny.gltf");
    assert_int_equal(wait_for_end(&process), 3);
    assert_contains(process.err, "full.exr: not written; the picture is saved as full.picture.exr");
    assert_int_equal(access("full.exr", F_OK), -1);
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    assert_int_equal(ppmi_layered_input_open(NULL, "full.picture.exr", &input, &info),
                     PPM_STATUS_OK);
    assert_int_equal(info.channel_count, 4);
    assert_null(ppmi_layered_input_find(input, "cryptomatte/3ae39a5/manifest"));
    ppmi_layered_input_close(NULL, input);
}

/* The folder is gone when the picture is to be written. */
static void a_picture_without_its_folder_is_saved_in_the_current_one(void **state)
{
    (void)state;
    assert_int_equal(mkdir("gone", 0777), 0);
    test_process process;
    start_program(&process, "-i path -s 16x16 -n 1000000 -o gone/away.png tiny.gltf");
    wait_for_text(&process, "pass 4/");
    assert_int_equal(rename("gone", "moved"), 0);
    assert_int_equal(kill(process.pid, SIGINT), 0);
    assert_int_equal(wait_for_end(&process), 3);
    assert_contains(process.err, "gone/away.png: not written; the picture is saved as away.exr");
    assert_int_equal(access("away.exr", F_OK), 0);
    remove("moved/away.png"); /* may have been refreshed before */
    assert_int_equal(rmdir("moved"), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_catcher_that_is_not_there_is_refused),
        cmocka_unit_test(the_view_is_that_of_all_things),
        cmocka_unit_test(a_catchers_layer_without_a_catcher_is_refused),
        cmocka_unit_test(variances_of_light_layers_go_by_a_word),
        cmocka_unit_test(groups_of_a_file_add_up_to_its_picture),
        cmocka_unit_test(an_empty_catcher_is_clear),
        cmocka_unit_test(with_a_catcher_it_is_another_scene),
        cmocka_unit_test(a_catchers_brightness_is_not_judged),
        cmocka_unit_test(layers_without_room_cost_the_layers_only),
        cmocka_unit_test(a_picture_without_its_folder_is_saved_in_the_current_one),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
