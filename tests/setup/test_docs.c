/* The examples of docs/setup.md are whole setup files: each is opened and applied. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "setup/setup_fixture.h"

static char *read_reference(void)
{
    FILE *file = fopen(PPM_SOURCE_DIR "/docs/setup.md", "rb");
    char *text = calloc(1, 1 << 16);
    assert_non_null(file);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 16) - 1, file) > 1000);
    fclose(file);
    return text;
}

static void the_examples_of_the_reference_can_be_applied(void **state)
{
    static const char begin[] = "```json\n", end[] = "\n```";
    setup_fixture *f = *state;
    char *text = read_reference(), *cursor = text;
    uint32_t examples = 0, items = 0;
    setup_write_picture(f, "inner/studio.hdr");
    setup_write_picture(f, "inner/wood.hdr");
    setup_write(f, "inner/downlight.ies",
                "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 100\n0 45 90\n0\n"
                "100 50 10\n");
    while ((cursor = strstr(cursor, begin))) {
        char *close = strstr(cursor, end);
        assert_non_null(close);
        *close = '\0';
        assert_int_equal(setup_apply(f, cursor + strlen(begin)), PPM_STATUS_OK);
        assert_false(setup_logged(f, 'E', ""));
        items += ppm_setup_count(f->setup);
        examples++;
        cursor = close + 1;
    }
    assert_int_equal(examples, 2);
    assert_true(items > 20);
    free(text);
}

/* A key that is not described is not known. */
static void every_key_is_in_the_reference(void **state)
{
    static const char *const words[] = {"`position`",
                                        "`target`",
                                        "`direction`",
                                        "`up`",
                                        "`matrix`",
                                        "`fov`",
                                        "`focal_mm`",
                                        "`sensor_mm`",
                                        "`f_number`",
                                        "`focus_distance`",
                                        "`focus_node`",
                                        "`shift`",
                                        "`aspect`",
                                        "`candela`",
                                        "`lumen`",
                                        "`watt`",
                                        "`lux`",
                                        "`nit`",
                                        "`factor`",
                                        "`kelvin`",
                                        "`color`",
                                        "`inner_cone`",
                                        "`outer_cone`",
                                        "`angular_diameter`",
                                        "`elevation`",
                                        "`azimuth`",
                                        "`radius`",
                                        "`profile`",
                                        "`visible`",
                                        "`light_group`",
                                        "`catcher`",
                                        "`image`",
                                        "`rotation`",
                                        "`intensity`",
                                        "`backdrop`",
                                        "`sun_sky`",
                                        "`turbidity`",
                                        "`ground_albedo`",
                                        "`sigma_s`",
                                        "`sigma_a`",
                                        "`g`",
                                        "`match`",
                                        "`preset`",
                                        "`material`",
                                        "`nested_priority`",
                                        "`scale`",
                                        "`offset`"};
    char *text = read_reference();
    (void)state;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (!strstr(text, words[i])) fail_msg("%s is not in docs/setup.md", words[i]);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_examples_of_the_reference_can_be_applied, setup_setup,
                                        setup_teardown),
        cmocka_unit_test(every_key_is_in_the_reference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
