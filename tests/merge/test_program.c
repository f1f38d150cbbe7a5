/* ppm-merge as a user would use it, with files whose values are known. */
#include <math.h>
#include <setjmp.h>
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
#include "imageio/layered.h"
#include "imageio/layered_input.h"

enum { WIDTH = 5, HEIGHT = 3, CHANNELS = 10, PIXELS = WIDTH * HEIGHT };

static const char *const names[CHANNELS] = {"R",          "caustics.R", "variance.r", "Z",
                                            "Crypto00.r", "Crypto00.g", "Crypto00.b", "Crypto00.a",
                                            "normal.X",   "position.X"};

/* What a render's file says; values are the same in all pixels. */
typedef struct render_file {
    const char *options, *scene, *view, *integrator, *working_space;
    int64_t frame;
    int64_t passes, photons, seed;
    float seconds;
    float values[CHANNELS];
    uint32_t channel_count, width;
    bool is_in_parts;
} render_file;

static ppm_context *context;

static float id_of(uint32_t bits)
{
    float id;
    memcpy(&id, &bits, sizeof id);
    return id;
}

static render_file plain(int64_t seed)
{
    return (render_file){.options = "integrator=sppm width=5 seed=9 crop=0,0,5,3",
                         .scene = "abc",
                         .view = "def",
                         .integrator = "sppm",
                         .working_space = "lin_rec709",
                         .passes = 8,
                         .photons = 1000,
                         .seed = seed,
                         .seconds = 1.5f,
                         .channel_count = CHANNELS,
                         .width = WIDTH};
}

static ppm_status fill_rows(void *user, uint32_t part, uint32_t y, uint32_t row_count,
                            float *values)
{
    const render_file *const file = user;
    const uint32_t begin = file->is_in_parts ? part : 0;
    const uint32_t count = file->is_in_parts ? 1 : file->channel_count;
    (void)y;
    for (uint32_t i = 0; i < row_count * file->width; i++) {
        for (uint32_t c = 0; c < count; c++)
            values[i * count + c] = file->values[begin + c];
    }
    return PPM_STATUS_OK;
}

static void write_render(const char *path, render_file file)
{
    ppmi_layered_channel channels[CHANNELS];
    ppmi_layered_part parts[CHANNELS];
    const ppmi_image_attribute attributes[] = {
        {.name = "ppm:options", .type = PPMI_ATTRIBUTE_STRING, .text = file.options},
        {.name = "ppm:sceneDigest", .type = PPMI_ATTRIBUTE_STRING, .text = file.scene},
        {.name = "ppm:cameraDigest", .type = PPMI_ATTRIBUTE_STRING, .text = file.view},
        {.name = "ppm:integrator", .type = PPMI_ATTRIBUTE_STRING, .text = file.integrator},
        {.name = "ppm:workingSpace", .type = PPMI_ATTRIBUTE_STRING, .text = file.working_space},
        {.name = "ppm:frame", .type = PPMI_ATTRIBUTE_INT, .integer = file.frame},
        {.name = "ppm:passes", .type = PPMI_ATTRIBUTE_INT, .integer = file.passes},
        {.name = "ppm:photons", .type = PPMI_ATTRIBUTE_INT, .integer = file.photons},
        {.name = "ppm:seed", .type = PPMI_ATTRIBUTE_INT, .integer = file.seed},
        {.name = "ppm:seconds", .type = PPMI_ATTRIBUTE_FLOAT, .floats = &file.seconds},
    };
    for (uint32_t i = 0; i < CHANNELS; i++) {
        channels[i] = (ppmi_layered_channel){names[i], PPMI_STORE_FLOAT};
        parts[i] = (ppmi_layered_part){names[i], 1, &channels[i], NULL};
    }
    const ppmi_layered_part whole = {NULL, file.channel_count, channels, NULL};
    const ppmi_layered_file layered = {
        .width = file.width,
        .height = HEIGHT,
        .compression = "zip",
        .part_count = file.is_in_parts ? file.channel_count : 1,
        .parts = file.is_in_parts ? parts : &whole,
        .attribute_count = sizeof attributes / sizeof attributes[0],
        .attributes = attributes,
        .read_rows = fill_rows,
        .user = &file,
    };
    assert_int_equal(ppmi_imageio_write_layered(context, path, &layered), PPM_STATUS_OK);
}

/* All pixels, channels in the order of names. */
static void read_merged(const char *path, float values[CHANNELS])
{
    float all[PIXELS * CHANNELS];
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    assert_int_equal(ppmi_layered_input_open(context, path, &input, &info), PPM_STATUS_OK);
    assert_int_equal(info.channel_count, CHANNELS);
    assert_int_equal(ppmi_layered_input_read(context, input, 0, HEIGHT, all), PPM_STATUS_OK);
    for (uint32_t c = 0; c < CHANNELS; c++) {
        const char *const name = ppmi_layered_input_channel(input, c);
        uint32_t at = 0;
        while (strcmp(names[at], name) != 0)
            at++;
        values[at] = all[c];
        for (uint32_t i = 0; i < PIXELS; i++)
            assert_memory_equal(&all[i * CHANNELS + c], &all[c], sizeof *all);
    }
    ppmi_layered_input_close(context, input);
}

static void assert_merged(const char *arguments)
{
    const outcome result = run_program(arguments);
    if (result.status != 0) fail_msg("%s\nstatus %d: %s", arguments, result.status, result.err);
}

/* ---- refusals -------------------------------------------------------------------------------- */

static void assert_refused(const char *arguments, int status, const char *text)
{
    const outcome result = run_program(arguments);
    if (result.status != status || !strstr(result.err, text)) {
        fail_msg("%s\nstatus %d, expected %d\nexpected: %s\nsaid: %s", arguments, result.status,
                 status, text, result.err);
    }
    if (access("all.exr", F_OK) == 0) fail_msg("%s wrote something", arguments);
}

static void wrong_usage_is_explained(void **state)
{
    (void)state;
    assert_refused("a.exr b.exr", 1, "no output; give -o FILE.exr");
    assert_refused("-o all.png a.exr b.exr", 1, "'all.png' is not an .exr file");
    assert_refused("-o all.exr a.exr", 1, "two or more files are merged; there is 1");
    assert_refused("-o all.exr", 1, "there are 0");
    assert_refused("--ouput all.exr a.exr b.exr", 1, "did you mean '--output'?");
    assert_refused("-o all.exr --depth hlf a.exr b.exr", 1, "did you mean 'half'?");
    assert_refused("-o all.exr --exr-compression dwaa a.exr b.exr", 1, "not one of zips");
    assert_refused("-o b.exr a.exr b.exr", 1, "b.exr is the input b.exr, too");
    assert_refused("-o ./link.exr a.exr b.exr", 1, "link.exr is the input b.exr, too");
}

static void unusable_files_are_named(void **state)
{
    (void)state;
    assert_refused("-o all.exr a.exr none.exr", 2, "none.exr: cannot be opened");
    assert_refused("-o all.exr a.exr tiny.gltf", 2, "tiny.gltf: not an OpenEXR file");
    assert_refused("-o all.exr a.exr foreign.exr", 2, "foreign.exr: not a picture of ppm-render's");
    assert_refused("-o all.exr a.exr nan.exr", 2, "nan.exr: channel 'R' is nan at pixel 0,0");
    assert_refused("-o none/all.exr a.exr b.exr", 3, "none/all.exr");
    assert_refused("-o all.exr a.exr passless.exr", 2, "a picture of no pass");
}

static void files_that_do_not_belong_together_are_told_apart(void **state)
{
    (void)state;
    assert_refused("-o all.exr a.exr scene.exr", 2,
                   "different scenes: ppm:sceneDigest is 'abc' and 'xyz'");
    assert_refused("-o all.exr a.exr view.exr", 2,
                   "different cameras: ppm:cameraDigest is 'def' and 'xyz'");
    assert_refused("-o all.exr a.exr space.exr", 2,
                   "different colour spaces: ppm:workingSpace is 'lin_rec709' and 'ACEScg'");
    assert_refused("-o all.exr a.exr frame.exr", 2, "different frames: ppm:frame is '0' and '7'");
    assert_refused("-o all.exr a.exr options.exr", 2, "different options: width=5 and width=6");
    assert_refused("-o all.exr a.exr more.exr", 2,
                   "different options: nothing and transparent=yes");
    assert_refused("-o all.exr more.exr a.exr", 2,
                   "different options: nothing and transparent=yes");
    assert_refused("-o all.exr a.exr small.exr", 2, "different sizes: 5 x 3 and 4 x 3 pixels");
    assert_refused("-o all.exr a.exr few.exr", 2,
                   "a.exr has the channel 'position.X', few.exr has");
    assert_refused("-o all.exr b.exr same.exr a.exr", 2, "both hold seed 2: the same noise twice");
}

static void what_is_in_a_merged_file_is_not_merged_again(void **state)
{
    (void)state;
    assert_merged("-o ab.exr a.exr b.exr");
    assert_refused("-o all.exr ab.exr b.exr", 2, "ab.exr and b.exr both hold seed 2");
    assert_merged("-o abc.exr ab.exr c.exr");
    assert_refused("-o all.exr abc.exr c.exr", 2, "both hold seed 3");
}

static void a_full_disk_leaves_nothing(void **state)
{
    (void)state;
    test_process process;
    start_wrapped_program(&process, "ulimit -f 1; ", "-o all.exr a.exr b.exr");
    assert_int_equal(wait_for_end(&process), 3);
    assert_contains(process.err, "all.exr: cannot be written");
    assert_int_not_equal(access("all.exr", F_OK), 0);
}

/* ---- merging --------------------------------------------------------------------------------- */

static void each_layer_is_merged_by_its_rule(void **state)
{
    (void)state;
    float values[CHANNELS];
    assert_merged("-o rules.exr a.exr b.exr"); /* 1000 and 3000 photons */
    read_merged("rules.exr", values);
    assert_true(values[0] == 1.75f);                       /* 1, 2 */
    assert_true(values[1] == 0.75f);                       /* 0, 1 */
    assert_true(fabsf(values[2] - 1.25f / 16.0f) < 1e-7f); /* 0.125 / 16 + 9 * 0.125 / 16 */
    assert_true(values[3] == 10.0f);                       /* the first */
    assert_true(values[4] == id_of(0x3f000002));           /* 2 covers 0.25 * 0.25 + 0.75 * 0.75 */
    assert_true(values[5] == 0.625f);
    assert_true(values[6] ==
                id_of(0x3f000001)); /* 1: 0.25 * 0.75; 3 has 0.75 * 0.25, a higher id */
    assert_true(values[7] == 0.1875f);
    assert_true(values[9] == 5.0f);
}

static void the_order_does_not_matter(void **state)
{
    (void)state;
    float values[CHANNELS], others[CHANNELS];
    assert_merged("-o abc.exr a.exr b.exr c.exr");
    assert_merged("-o cba.exr c.exr b.exr a.exr");
    read_merged("abc.exr", values);
    read_merged("cba.exr", others);
    assert_memory_equal(values, others, sizeof values);
}

static void merging_in_steps_gives_the_same(void **state)
{
    (void)state;
    float values[CHANNELS], others[CHANNELS];
    assert_merged("-o abc.exr a.exr b.exr c.exr");
    assert_merged("-o ab.exr a.exr b.exr");
    assert_merged("-o ab_c.exr ab.exr c.exr");
    read_merged("abc.exr", values);
    read_merged("ab_c.exr", others);
    for (int i = 0; i < 3; i++)
        assert_true(fabsf(values[i] - others[i]) <= 2e-7f * fabsf(values[i]));
}

static void parts_are_merged_with_plain_files(void **state)
{
    (void)state;
    float values[CHANNELS], others[CHANNELS];
    assert_merged("-o plain.exr a.exr b.exr");
    assert_merged("-o mixed.exr a.exr b_parts.exr");
    read_merged("plain.exr", values);
    read_merged("mixed.exr", others);
    assert_memory_equal(values, others, sizeof values);
}

static void assert_attribute(const char *path, const char *name, const char *expected)
{
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    char text[64];
    assert_int_equal(ppmi_layered_input_open(context, path, &input, &info), PPM_STATUS_OK);
    const ppmi_image_attribute *const attribute = ppmi_layered_input_find(input, name);
    if (!attribute) fail_msg("%s has no %s", path, name);
    switch (attribute->type) {
    case PPMI_ATTRIBUTE_STRING:
        snprintf(text, sizeof text, "%s", attribute->text);
        break;
    case PPMI_ATTRIBUTE_INT:
        snprintf(text, sizeof text, "%lld", (long long)attribute->integer);
        break;
    default:
        snprintf(text, sizeof text, "%g", (double)attribute->floats[0]);
    }
    ppmi_layered_input_close(context, input);
    assert_string_equal(text, expected);
}

static void the_header_adds_up(void **state)
{
    (void)state;
    assert_merged("-o abc.exr c.exr a.exr b.exr");
    assert_attribute("abc.exr", "ppm:passes", "24");
    assert_attribute("abc.exr", "ppm:photons", "9000000000");
    assert_attribute("abc.exr", "ppm:seconds", "4.5");
    assert_attribute("abc.exr", "ppm:seeds", "1 2 3");
    assert_attribute("abc.exr", "ppm:sceneDigest", "abc");
    assert_attribute("abc.exr", "ppm:options", "integrator=sppm width=5 crop=0,0,5,3");
    assert_attribute("abc.exr", "ppm:merge", "ppm-merge -o abc.exr c.exr a.exr b.exr");
}

static void paths_are_weighted_by_passes(void **state)
{
    (void)state;
    float values[CHANNELS];
    render_file one = plain(1), other = plain(2);
    one.integrator = other.integrator = "path";
    one.photons = other.photons = 0;
    one.passes = 8;
    other.passes = 24;
    one.values[0] = 1;
    other.values[0] = 2;
    write_render("p.exr", one);
    write_render("q.exr", other);
    assert_merged("-o pq.exr p.exr q.exr");
    read_merged("pq.exr", values);
    assert_true(values[0] == 1.75f);
}

/* ---- the files ------------------------------------------------------------------------------- */

static render_file known(int64_t seed)
{
    const uint32_t low = 0x3f000001;
    render_file file = plain(seed);
    const bool is_first = seed == 1;
    const float values[CHANNELS] = {is_first ? 1.0f : 2.0f,
                                    is_first ? 0.0f : 1.0f,
                                    0.125f,
                                    10.0f * (float)seed,
                                    is_first ? id_of(low) : id_of(low + 1),
                                    0.75f,
                                    is_first ? id_of(low + 1) : id_of(low + 2),
                                    0.25f,
                                    1.0f,
                                    5.0f * (float)seed};
    memcpy(file.values, values, sizeof values);
    file.photons = is_first ? 1000 : 3000;
    return file;
}

static void write_odd_ones(void)
{
    render_file file = known(5);
    file.scene = "xyz";
    write_render("scene.exr", file);
    file.working_space = "ACEScg";
    write_render("space.exr", file);
    file = known(5);
    file.scene = "xyz";
    file.frame = 7;
    write_render("frame.exr", file);
    file = known(5);
    file.view = "xyz";
    write_render("view.exr", file);
    file = known(5);
    file.options = "integrator=sppm width=6 seed=9 crop=0,0,5,3";
    write_render("options.exr", file);
    file.options = "integrator=sppm width=5 seed=9 crop=0,0,5,3 transparent=yes";
    write_render("more.exr", file);
    file = known(5);
    file.width = 4;
    write_render("small.exr", file);
    file = known(5);
    file.channel_count = CHANNELS - 1;
    write_render("few.exr", file);
    file = known(5);
    file.scene = "";
    write_render("foreign.exr", file);
    file = known(5);
    file.passes = 0;
    write_render("passless.exr", file);
    file = known(5);
    file.values[0] = NAN;
    write_render("nan.exr", file);
}

static int files_setup(void **state)
{
    if (folder_setup(state) != 0) return -1;
    if (ppm_context_create(NULL, &context) != PPM_STATUS_OK) return -1;
    render_file many = known(3), parts = known(2);
    many.photons = INT64_C(9000000000) - 4000;
    parts.is_in_parts = true;
    write_render("a.exr", known(1));
    write_render("b.exr", known(2));
    write_render("same.exr", known(2));
    write_render("b_parts.exr", parts);
    write_render("c.exr", many);
    write_odd_ones();
    return symlink("b.exr", "link.exr");
}

static int files_teardown(void **state)
{
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    return folder_teardown(state) == 0 && live == 0 ? 0 : -1;
}

static void control_characters_of_names_are_shown(void **state)
{
    (void)state;
    static const char *const cases[] = {"-o x.exr \"$E.exr\" \"$E.exr\"",
                                        "-o \"no/$E.exr\" a.exr b.exr", "--\"$E\""};
    setenv("E", "\x1b[2Jx", 1);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const outcome result = run_program(cases[i]);
        if (result.status == 0 || strchr(result.err, '\x1b') || !strstr(result.err, "\\x1b[2Jx")) {
            fail_msg("%s\nstatus %d, said: %s", cases[i], result.status, result.err);
        }
    }
    unsetenv("E");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(control_characters_of_names_are_shown),
        cmocka_unit_test(wrong_usage_is_explained),
        cmocka_unit_test(unusable_files_are_named),
        cmocka_unit_test(files_that_do_not_belong_together_are_told_apart),
        cmocka_unit_test(what_is_in_a_merged_file_is_not_merged_again),
        cmocka_unit_test(a_full_disk_leaves_nothing),
        cmocka_unit_test(each_layer_is_merged_by_its_rule),
        cmocka_unit_test(the_order_does_not_matter),
        cmocka_unit_test(merging_in_steps_gives_the_same),
        cmocka_unit_test(parts_are_merged_with_plain_files),
        cmocka_unit_test(the_header_adds_up),
        cmocka_unit_test(paths_are_weighted_by_passes),
    };
    return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
