/* Layers by the command line: what is asked for is in the file, and what makes no sense is told. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/program.h"
#include "imageio/layered_input.h"

#define QUICK "-q -s 24x16 -n 2 -p 2000 "

typedef struct refusal {
    const char *arguments;
    const char *text;
} refusal;

static void wrong_options_are_explained(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"--aov caustic tiny.gltf", "there is no layer 'caustic'; did you mean 'caustics'?"},
        {"--aov albedo,,uv tiny.gltf", "there is no layer ''"},
        {"--aov zzzzzzzz tiny.gltf", "Layers: all, crypto, light_variance, combined"},
        {"--aov", "--aov needs a value"},
        {"--light-groups=gven tiny.gltf", "did you mean 'given'?"},
        {"--normals worl tiny.gltf", "did you mean 'world'?"},
        {"--normals camera tiny.gltf", "which --aov does not name"},
        {"--follow-specular tiny.gltf", "which --aov does not name"},
        {"--cryptomatte-levels 4 tiny.gltf", "which --aov does not name"},
        {"--aov crypto --cryptomatte-levels 3 tiny.gltf", "'3' is not an even number"},
        {"--aov crypto --cryptomatte-levels 34 tiny.gltf", "from 2 to 32"},
        {"--depth quarter tiny.gltf", "--depth: 'quarter' is not one of half, float"},
        {"--exr-compression zop tiny.gltf", "did you mean 'zip'?"},
        {"--exr-compression zip:9 tiny.gltf", "only dwaa and dwab have a level"},
        {"--exr-compression dwaa:0 tiny.gltf", "only dwaa and dwab have a level"},
        {"--exr-compression dwaa: tiny.gltf", "only dwaa and dwab have a level"},
        {"--exr-tiles=8 tiny.gltf", "from 16 to 4096"},
        {"--exr-multipart=1 tiny.gltf", "takes no value"},
        {"--aov albedo -o a.png tiny.gltf", "layers of an .exr, which is not among the outputs"},
        {"--exr-multipart -o a.png tiny.gltf", "about an .exr, which is not among the outputs"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const outcome result = run_program(cases[i].arguments);
        if (result.status != 1 || !strstr(result.err, cases[i].text)) {
            fail_msg("%s\nstatus %d\nexpected: %s\nsaid: %s", cases[i].arguments, result.status,
                     cases[i].text, result.err);
        }
    }
}

static void assert_done(const char *arguments)
{
    const outcome result = run_program(arguments);
    if (result.status != 0) fail_msg("%s\nstatus %d: %s", arguments, result.status, result.err);
}

static bool has_channel(const ppmi_layered_input *input, const ppmi_layered_info *info,
                        const char *name)
{
    for (uint32_t i = 0; i < info->channel_count; i++) {
        if (strcmp(ppmi_layered_input_channel(input, i), name) == 0) return true;
    }
    return false;
}

static void assert_channels(const char *path, uint32_t count, const char *const *names)
{
    ppmi_layered_input *input = NULL;
    ppmi_layered_info info;
    assert_int_equal(ppmi_layered_input_open(NULL, path, &input, &info), PPM_STATUS_OK);
    for (size_t i = 0; names[i]; i++) {
        if (!has_channel(input, &info, names[i])) fail_msg("%s has no %s", path, names[i]);
    }
    if (count > 0) assert_int_equal(info.channel_count, count);
    ppmi_layered_input_close(NULL, input);
}

static void without_aov_there_is_the_picture_alone(void **state)
{
    (void)state;
    assert_done(QUICK "-o plain.exr tiny.gltf");
    assert_channels("plain.exr", 4, (const char *const[]){"R", "G", "B", "A", NULL});
}

static void layers_have_names_that_compositors_know(void **state)
{
    (void)state;
    assert_done(QUICK "--aov depth,albedo --aov CryptoObject --cryptomatte-levels 2 -o some.exr "
                      "tiny.gltf");
    assert_channels("some.exr", 4 + 1 + 3 + 4,
                    (const char *const[]){"R", "A", "Z", "albedo.G", "CryptoObject00.r",
                                          "CryptoObject00.a", NULL});
}

static void caustics_of_groups_come_with_both(void **state)
{
    (void)state;
    assert_done(QUICK "--light-groups=named -o groups.exr tiny.gltf");
    assert_done(QUICK "--light-groups=named --aov caustics -o both.exr tiny.gltf");
    assert_channels("groups.exr", 4 + 3, (const char *const[]){"light.Lamp.R", NULL});
    assert_channels("both.exr", 4 + 9,
                    (const char *const[]){"light.Lamp.R", "caustics.Lamp.R", "caustics.R", NULL});
}

static void all_is_all_in_one_part_or_many(void **state)
{
    (void)state;
    static const char *const names[] = {"R",        "Z",        "variance.r",      "uv.U",
                                        "normal.X", "radius.V", "CryptoAsset02.a", NULL};
    assert_done(QUICK "--aov all -o all.exr tiny.gltf");
    assert_done(QUICK
                "--aov all --exr-multipart --exr-tiles=16 --depth half -o parts.exr tiny.gltf");
    assert_channels("all.exr", 0, names);
    assert_channels("parts.exr", 0, names);
}

/* A file-size limit stands for the disk; nothing half-written remains, not even a hidden file. */
static void a_full_disk_is_told(void **state)
{
    (void)state;
    test_process process;
    start_wrapped_program(&process, "ulimit -f 4; ", QUICK "--aov all -o full.exr tiny.gltf");
    assert_int_equal(wait_for_end(&process), 3);
    assert_contains(process.err, "full.exr: cannot be written");
    assert_int_not_equal(access("full.exr", F_OK), 0);
    assert_int_not_equal(system("ls -a | grep -q tmp$"), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_options_are_explained),
        cmocka_unit_test(without_aov_there_is_the_picture_alone),
        cmocka_unit_test(layers_have_names_that_compositors_know),
        cmocka_unit_test(caustics_of_groups_come_with_both),
        cmocka_unit_test(all_is_all_in_one_part_or_many),
        cmocka_unit_test(a_full_disk_is_told),
    };
    return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
