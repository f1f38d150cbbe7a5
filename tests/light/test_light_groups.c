/* Which lights make a group. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "light/light_groups.h"
#include "ppm/render.h"
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

static ppm_light_id add_light(const char *name, const char *group)
{
    const ppm_light_desc desc = {.size = sizeof desc,
                                 .name = name,
                                 .kind = PPM_LIGHT_POINT,
                                 .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1},
                                 .intensity = {1, 1, 1},
                                 .light_group = group};
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

static void add_panel(const char *name, const char *group, float radiance)
{
    const ppm_material_id material = radiance > 0.0f
                                         ? material_emitter(test.scene, radiance, 0.5f, false)
                                         : material_lambert(test.scene, 0.5f);
    const ppm_instance_desc desc = {
        .size = sizeof desc,
        .name = name,
        .mesh = shape_quad(test.scene, material, vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)),
        .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
        .light_group = group};
    ppm_instance_id id;
    assert_int_equal(ppm_scene_add_instance(test.scene, &desc, &id), PPM_STATUS_OK);
}

static void set_environment(const char *group)
{
    const ppm_environment_desc desc = {
        .size = sizeof desc, .radiance = {1, 1, 1}, .light_group = group};
    assert_int_equal(ppm_scene_set_environment(test.scene, &desc), PPM_STATUS_OK);
}

static ppmi_light_groups *make(int32_t mode)
{
    ppmi_light_groups *groups = NULL;
    assert_int_equal(ppmi_light_groups_create(test.context, test.scene, mode, &groups),
                     PPM_STATUS_OK);
    return groups;
}

static void too_many_groups_are_refused(void **state)
{
    (void)state;
    char name[32];
    for (int i = 0; i < 4097; i++) {
        snprintf(name, sizeof name, "lamp %d", i);
        add_light(name, NULL);
    }
    ppmi_light_groups *groups = NULL;
    assert_int_equal(
        ppmi_light_groups_create(test.context, test.scene, PPM_LIGHT_GROUPS_NAMED, &groups),
        PPM_STATUS_INVALID_ARGUMENT);
    assert_null(groups);
    groups = make(PPM_LIGHT_GROUPS_GIVEN);
    assert_int_equal(groups->count, 1);
    ppmi_light_groups_destroy(test.context, groups);
}

static void memory_that_is_out_is_told(void **state)
{
    (void)state;
    add_light("a", "one");
    add_panel("b", "two", 1.0f);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    for (size_t n = 1; status != PPM_STATUS_OK; n++) {
        ppmi_light_groups *groups = NULL;
        ppmi_alloc_fail_at(test.context, n);
        status =
            ppmi_light_groups_create(test.context, test.scene, PPM_LIGHT_GROUPS_NAMED, &groups);
        ppmi_alloc_fail_at(test.context, 0);
        if (status != PPM_STATUS_OK) assert_int_equal(status, PPM_STATUS_OUT_OF_MEMORY);
        ppmi_light_groups_destroy(test.context, groups);
    }
}

static void given_groups_are_shared_and_all_else_is_the_rest(void **state)
{
    (void)state;
    add_light("a", "warm");
    add_light("b", NULL);
    add_light("c", "");
    add_panel("dark", "unused", 0.0f);
    add_panel("d", "warm", 1.0f);
    set_environment("sky");
    ppmi_light_groups *groups = make(PPM_LIGHT_GROUPS_GIVEN);
    assert_int_equal(groups->count, 3);
    assert_string_equal(groups->names[0], "warm");
    assert_string_equal(groups->names[1], "rest");
    assert_string_equal(groups->names[2], "sky");
    assert_int_equal(groups->of_punctual[0], 0);
    assert_int_equal(groups->of_punctual[1], 1);
    assert_int_equal(groups->of_punctual[2], 1);
    assert_int_equal(groups->of_instance[1], 0);
    assert_int_equal(groups->of_environment, 2);
    ppmi_light_groups_destroy(test.context, groups);
}

static void named_lights_have_groups_of_their_own(void **state)
{
    (void)state;
    add_light("lamp", NULL);
    add_light("lamp", NULL);
    add_light("", NULL);
    add_panel("lamp", NULL, 1.0f);
    add_panel("key", "lamp 2", 1.0f);
    set_environment(NULL);
    ppmi_light_groups *groups = make(PPM_LIGHT_GROUPS_NAMED);
    static const char *const names[] = {"lamp 2", "lamp",   "lamp 3",
                                        "light",  "lamp 4", "environment"};
    assert_int_equal(groups->count, 6);
    for (uint32_t i = 0; i < 6; i++)
        assert_string_equal(groups->names[i], names[i]);
    assert_int_equal(groups->of_punctual[0], 1);
    assert_int_equal(groups->of_punctual[1], 2);
    assert_int_equal(groups->of_instance[0], 4);
    assert_int_equal(groups->of_instance[1], 0);
    ppmi_light_groups_destroy(test.context, groups);
}

static void a_light_that_is_replaced_has_the_new_group(void **state)
{
    (void)state;
    const ppm_light_id id = add_light("a", "old");
    const ppm_light_desc desc = {.size = sizeof desc,
                                 .kind = PPM_LIGHT_POINT,
                                 .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                                 .light_group = "new"};
    assert_int_equal(ppm_scene_set_light(test.scene, id, &desc), PPM_STATUS_OK);
    set_environment("morning");
    set_environment("evening");
    ppmi_light_groups *groups = make(PPM_LIGHT_GROUPS_GIVEN);
    assert_int_equal(groups->count, 2);
    assert_string_equal(groups->names[0], "new");
    assert_string_equal(groups->names[1], "evening");
    ppmi_light_groups_destroy(test.context, groups);
}

#define WITH_SCENE(test) cmocka_unit_test_setup_teardown(test, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_SCENE(too_many_groups_are_refused),
        WITH_SCENE(memory_that_is_out_is_told),
        WITH_SCENE(given_groups_are_shared_and_all_else_is_the_rest),
        WITH_SCENE(named_lights_have_groups_of_their_own),
        WITH_SCENE(a_light_that_is_replaced_has_the_new_group),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
