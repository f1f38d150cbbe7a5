/* The options about colour: what is refused before rendering, what --view auto takes, what the
 * files say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/auto_view.h"
#include "cli/program.h"

#define SMALL "-s 16x8 -n 1 -p 1024 "

/* A configuration whose views are called as Blender's; one of them cannot be built. */
static const char blender_like[] = "ocio_profile_version: 1\n"
                                   "search_path: .\n"
                                   "roles: {scene_linear: Linear, default: Linear}\n"
                                   "displays:\n"
                                   "  sRGB:\n"
                                   "    - !<View> {name: Standard, colorspace: Linear}\n"
                                   "    - !<View> {name: Filmic, colorspace: Linear}\n"
                                   "    - !<View> {name: AgX, colorspace: gone}\n"
                                   "looks:\n"
                                   "  - !<Look> {name: Gone, process_space: Linear, transform: "
                                   "!<FileTransform> {src: gone.cube}}\n"
                                   "colorspaces:\n"
                                   "  - !<ColorSpace> {name: Linear}\n"
                                   "  - !<ColorSpace>\n"
                                   "    name: gone\n"
                                   "    from_reference: !<FileTransform> {src: gone.cube}\n";

static void write_text(const char *name, const char *text)
{
    FILE *const file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
}

/* tiny.gltf as if another program had written it. */
static void write_scene_of(const char *name, const char *generator)
{
    char command[256];
    snprintf(command, sizeof command, "sed 's|ppm tests|%s|' tiny.gltf > %s", generator, name);
    assert_int_equal(system(command), 0);
}

static int setup(void **state)
{
    const int status = folder_setup(state);
    if (status != 0) return status;
    unsetenv("OCIO");
    write_text("blender.ocio", blender_like);
    write_scene_of("old.gltf", "Khronos glTF Blender I/O v3.4.50");
    write_scene_of("new.gltf", "Khronos glTF Blender I/O v4.2.0");
    return 0;
}

static void what_is_wrong_is_told_before_rendering(void **state)
{
    (void)state;
    static const struct {
        const char *arguments;
        int status;
        const char *message;
    } cases[] = {
        {"--working-space ACEScgg", 1, "did you mean \"ACEScg\""},
        {"--working-space ACEScct", 2, "\"ACEScct\" cannot be the working space"},
        {"--working-space Raw", 2, "\"Raw\" cannot be the working space"},
        {"--texture-space '*.png'", 1, "PATTERN=SPACE"},
        {"--texture-space '=sRGB'", 1, "PATTERN=SPACE"},
        {"--texture-space '*.png='", 1, "PATTERN=SPACE"},
        {"--texture-space '*.png=sRGB - Textur'", 1, "did you mean \"sRGB - Texture"},
        {"--display Rec1886", 1, "did you mean \"Rec.1886\""},
        {"--view Filmic", 1, "no view \"Filmic\""},
        {"--look Contrast", 1, "no look \"Contrast\"; there are none"},
        {"--ocio blender.ocio --look Gonne", 1, "did you mean \"Gone\""},
        {"--ocio blender.ocio --look Gone", 2, "gone.cube"},
        {"--ocio blender.ocio --view AgX", 2, "gone.cube"},
        {"--gamma 0", 1, "--gamma: '0'"},
        {"--bits 12", 1, "--bits: '12' is not one of 8, 16"},
        {"--jpeg-quality 101", 1, "--jpeg-quality: '101'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char arguments[256];
        snprintf(arguments, sizeof arguments, SMALL "%s -o no.png tiny.gltf", cases[i].arguments);
        const outcome result = run_program(arguments);
        assert_contains(result.err, cases[i].message);
        assert_int_equal(result.status, cases[i].status);
        assert_int_equal(access("no.png", F_OK), -1);
    }
}

static void the_generator_tells_blenders_default(void **state)
{
    (void)state;
    static const struct {
        const char *generator, *view;
    } cases[] = {
        {"Khronos glTF Blender I/O v1.2.75", "Filmic"},
        {"Khronos glTF Blender I/O v3.6.28", "Filmic"},
        {"Khronos glTF Blender I/O v4.0.44", "AgX"},
        {"Khronos glTF Blender I/O v10.0.1", "AgX"},
        {"Khronos glTF Blender I/O vx", NULL},
        {"Khronos glTF Blender I/O v", NULL},
        {"Houdini GLTF 2.0 Exporter", NULL},
        {"", NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *const view = auto_view_of_generator(cases[i].generator);
        if (!cases[i].view) assert_null(view);
        if (cases[i].view) assert_string_equal(view, cases[i].view);
    }
}

static void assert_in_file(const char *name, const char *text)
{
    static char bytes[1 << 20];
    FILE *const file = fopen(name, "rb");
    assert_non_null(file);
    const size_t count = fread(bytes, 1, sizeof bytes, file), length = strlen(text);
    fclose(file);
    for (size_t i = 0; i + length <= count; i++) {
        if (memcmp(bytes + i, text, length) == 0) return;
    }
    fail_msg("'%s' is not in %s", text, name);
}

static void an_automatic_view_is_taken_where_it_is(void **state)
{
    (void)state;
    static const struct {
        const char *arguments, *message, *view;
    } cases[] = {
        {"--ocio blender.ocio old.gltf", "--view auto: Filmic, as", "Filmic"},
        {"--ocio blender.ocio new.gltf", "which the colour configuration blender.ocio does not",
         "Standard"},
        {"new.gltf", "--view auto: AgX, as", "AgX"},
        {"old.gltf", "which the colour configuration built-in does not", "ACES 1.0"},
        {"tiny.gltf", "not written by Blender (but by ppm tests)", "ACES 1.0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char arguments[256];
        snprintf(arguments, sizeof arguments, SMALL "--view auto -o auto.exr %s",
                 cases[i].arguments);
        const outcome result = run_program(arguments);
        assert_contains(result.err, cases[i].message);
        assert_int_equal(result.status, 0);
        assert_in_file("auto.exr", cases[i].view);
    }
}

static void the_header_tells_how_it_is_meant_to_be_seen(void **state)
{
    (void)state;
    assert_int_equal(run_program(SMALL
                                 "--working-space acescg --display 'rec.1886' --view standard "
                                 "--gamma 1.5 -o meant.exr tiny.gltf")
                         .status,
                     0);
    static const char *const texts[] = {"ppm:workingSpace", "ACEScg",   "lin_ap1_scene",
                                        "ppm:colorConfig",  "built-in", "ppm:display",
                                        "Rec.1886",         "ppm:view", "Standard",
                                        "ppm:exposure",     "ppm:gamma"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        assert_in_file("meant.exr", texts[i]);
}

static void files_for_display_say_what_they_are(void **state)
{
    (void)state;
    assert_int_equal(run_program(SMALL "-o a.png -o a.jpg -o a.tif tiny.gltf").status, 0);
    assert_in_file("a.png", "sRGB");
    assert_in_file("a.png", "cICP\x01\x0d");
    assert_in_file("a.jpg", "ICC_PROFILE");
    assert_in_file("a.tif", "acsp");
    assert_int_equal(run_program(SMALL "--display 'Display P3' -o p3.png tiny.gltf").status, 0);
    assert_in_file("p3.png", "cICP\x0c\x0d");
    assert_in_file("p3.png", "iCCP");
    const outcome pq = run_program(SMALL "--display Rec.2100-PQ -o pq.png -o pq.jpg tiny.gltf");
    assert_int_equal(pq.status, 0);
    assert_in_file("pq.png", "cICP\x09\x10");
    assert_contains(pq.err, "pq.jpg: only .png can say that it is Rec.2100 PQ");
}

static void bits_and_quality_are_as_asked_for(void **state)
{
    (void)state;
    assert_int_equal(
        run_program(SMALL "--bits 16 --jpeg-quality 30 -o b.png -o b.jpg tiny.gltf").status, 0);
    FILE *const file = fopen("b.png", "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 24, SEEK_SET), 0);
    assert_int_equal(fgetc(file), 16); /* IHDR: bit depth */
    fclose(file);
    assert_in_file("b.jpg", "\xff\xd8");
}

static void views_spaces_and_looks_are_listed(void **state)
{
    (void)state;
    const outcome result = run_program("--list-views --ocio blender.ocio");
    assert_int_equal(result.status, 0);
    assert_contains(result.out, "Looks (--look):\n  Gone\n");
    assert_contains(result.out, "  Linear (working space)\n");
    const outcome other = run_program("--list-views --working-space ACEScg");
    assert_contains(other.out, "  ACEScg (working space)\n");
    assert_contains(other.out, "Looks (--look): none\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_wrong_is_told_before_rendering),
        cmocka_unit_test(the_generator_tells_blenders_default),
        cmocka_unit_test(an_automatic_view_is_taken_where_it_is),
        cmocka_unit_test(the_header_tells_how_it_is_meant_to_be_seen),
        cmocka_unit_test(files_for_display_say_what_they_are),
        cmocka_unit_test(bits_and_quality_are_as_asked_for),
        cmocka_unit_test(views_spaces_and_looks_are_listed),
    };
    return cmocka_run_group_tests(tests, setup, folder_teardown);
}
