/* The list of solids that a path is in, and which of them counts. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/scenes.h"

static test_scene test;

/* Materials 0 .. 7 of priority 0, then 8 with 1 and 9 with -1. */
static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    for (int i = 0; i < 10; i++) {
        ppm_material_desc desc;
        ppm_material_desc_init(&desc);
        desc.transmission = 1.0f;
        desc.nested_priority = i == 8 ? 1 : i == 9 ? -1 : 0;
        material_add(test.scene, &desc);
    }
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

/* Indices in the scene are those of the ids, which count from 1, wherever a default material lies.
 */
static uint32_t index_of(int material)
{
    for (uint32_t i = 0, found = 0; i < test.scene->material_count; i++) {
        if (test.scene->materials[i].desc.transmission > 0.0f && found++ == (uint32_t)material) {
            return i;
        }
    }
    fail_msg("no material %d", material);
    return 0;
}

static void nothing_is_outside(void **state)
{
    (void)state;
    const ppmi_interior interior = {0};
    assert_true(ppmi_interior_material(&interior, test.scene) == PPMI_OUTSIDE);
    assert_false(ppmi_interior_has(&interior, index_of(0)));
}

static void the_last_one_entered_counts(void **state)
{
    (void)state;
    ppmi_interior interior = {0};
    ppmi_interior_enter(&interior, index_of(0));
    ppmi_interior_enter(&interior, index_of(1));
    assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(1));
    ppmi_interior_leave(&interior, index_of(1));
    assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(0));
    ppmi_interior_enter(&interior, index_of(1));
    ppmi_interior_leave(&interior, index_of(0)); /* in any order */
    assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(1));
    ppmi_interior_leave(&interior, index_of(1));
    assert_true(ppmi_interior_material(&interior, test.scene) == PPMI_OUTSIDE);
}

static void the_highest_priority_counts_whatever_the_order(void **state)
{
    (void)state;
    for (int order = 0; order < 2; order++) {
        ppmi_interior interior = {0};
        ppmi_interior_enter(&interior, index_of(order ? 8 : 0));
        ppmi_interior_enter(&interior, index_of(order ? 0 : 8));
        assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(8));
        ppmi_interior_enter(&interior, index_of(9));
        assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(8));
        ppmi_interior_leave(&interior, index_of(8));
        assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(0));
    }
}

static void leaving_what_was_not_entered_changes_nothing(void **state)
{
    (void)state;
    ppmi_interior interior = {0};
    ppmi_interior_leave(&interior, index_of(0));
    ppmi_interior_enter(&interior, index_of(1));
    ppmi_interior_leave(&interior, index_of(0));
    assert_int_equal(interior.count, 1);
    assert_true(ppmi_interior_has(&interior, index_of(1)));
}

static void a_material_is_in_the_list_once(void **state)
{
    (void)state;
    ppmi_interior interior = {0};
    ppmi_interior_enter(&interior, index_of(0));
    ppmi_interior_enter(&interior, index_of(1));
    ppmi_interior_enter(&interior, index_of(0));
    assert_int_equal(interior.count, 2);
    assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(0));
    ppmi_interior_leave(&interior, index_of(0));
    assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(1));
}

static void a_full_list_forgets_the_oldest(void **state)
{
    (void)state;
    ppmi_interior interior = {0};
    for (int i = 0; i <= PPMI_INTERIOR_MAX; i++)
        ppmi_interior_enter(&interior, index_of(i));
    assert_int_equal(interior.count, PPMI_INTERIOR_MAX);
    assert_false(ppmi_interior_has(&interior, index_of(0)));
    for (int i = 1; i <= PPMI_INTERIOR_MAX; i++)
        assert_true(ppmi_interior_has(&interior, index_of(i)));
    assert_int_equal(ppmi_interior_material(&interior, test.scene), index_of(PPMI_INTERIOR_MAX));
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(nothing_is_outside),
        WITH_SCENE(the_last_one_entered_counts),
        WITH_SCENE(the_highest_priority_counts_whatever_the_order),
        WITH_SCENE(leaving_what_was_not_entered_changes_nothing),
        WITH_SCENE(a_material_is_in_the_list_once),
        WITH_SCENE(a_full_list_forgets_the_oldest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
