/* Ids of several files are ranked as those of one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "merge/ranks.h"

static void nothing_gives_nothing(void **state)
{
    (void)state;
    merge_rank ranks[2] = {{0, 0}, {7, 0}};
    assert_int_equal(merge_ranks(ranks, 0), 0);
    assert_int_equal(merge_ranks(ranks, 2), 0);
}

static void equal_ids_are_added_up(void **state)
{
    (void)state;
    merge_rank ranks[5] = {{7, 0.25}, {3, 0.5}, {0, 0}, {7, 0.5}, {3, 0.125}};
    assert_int_equal(merge_ranks(ranks, 5), 2);
    assert_int_equal(ranks[0].id, 7);
    assert_true(ranks[0].coverage == 0.75);
    assert_int_equal(ranks[1].id, 3);
    assert_true(ranks[1].coverage == 0.625);
}

static void equal_coverage_is_ranked_by_id_in_any_order(void **state)
{
    (void)state;
    merge_rank ranks[3] = {{9, 0.5}, {2, 0.5}, {5, 0.5}};
    merge_rank turned[3] = {{5, 0.5}, {2, 0.5}, {9, 0.5}};
    assert_int_equal(merge_ranks(ranks, 3), 3);
    assert_int_equal(merge_ranks(turned, 3), 3);
    for (int i = 0; i < 3; i++)
        assert_int_equal(ranks[i].id, turned[i].id);
    assert_int_equal(ranks[0].id, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_gives_nothing),
        cmocka_unit_test(equal_ids_are_added_up),
        cmocka_unit_test(equal_coverage_is_ranked_by_id_in_any_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
