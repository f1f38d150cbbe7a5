/* importers/tangent/fan.c */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tangent/fan.h"

enum { MOST = 100 };

typedef struct fan {
    ppmi_tangent_corner corners[MOST];
    ppmi_tangent_edge edges[MOST];
    uint32_t left[MOST], right[MOST], stack[MOST];
    ppmi_tangent_workspace workspace;
} fan;

/* count corners around a vertex: corner i lies between ring vertices i and i + 1; a closed ring
 * comes back to vertex 0. */
static void init_ring(fan *f, uint32_t count, int is_closed)
{
    for (uint32_t i = 0; i < count; ++i) {
        f->corners[i] = (ppmi_tangent_corner){.next = i,
                                              .previous = is_closed ? (i + 1) % count : i + 1,
                                              .turn = PPMI_TANGENT_POSITIVE};
    }
    f->workspace = (ppmi_tangent_workspace){f->corners, f->edges, f->left, f->right, f->stack};
}

static void nothing_has_no_groups(void **state)
{
    (void)state;
    fan f;
    init_ring(&f, 0, 0);
    assert_int_equal(ppmi_tangent_group_fan(&f.workspace, 0), 0);
}

static void a_ring_is_one_group_whatever_its_size(void **state)
{
    (void)state;
    fan f;
    for (uint32_t count = 3; count < MOST; count += 7) { /* beyond what insertion sorts */
        init_ring(&f, count, count % 2);
        assert_int_equal(ppmi_tangent_group_fan(&f.workspace, count), 1);
        for (uint32_t i = 0; i < count; ++i) {
            assert_int_equal(f.corners[i].group, 0);
        }
    }
}

static void another_turn_parts_groups(void **state)
{
    (void)state;
    fan f;
    init_ring(&f, 6, 1);
    f.corners[2].turn = f.corners[3].turn = PPMI_TANGENT_NEGATIVE;
    assert_int_equal(ppmi_tangent_group_fan(&f.workspace, 6), 2);
    static const uint32_t expected[] = {0, 0, 1, 1, 0, 0}; /* joined over the ring's end */
    for (uint32_t i = 0; i < 6; ++i) {
        assert_int_equal(f.corners[i].group, expected[i]);
    }
}

static void triangles_that_share_no_edge_are_groups_of_their_own(void **state)
{
    (void)state;
    fan f;
    init_ring(&f, 6, 0);
    f.corners[3].next = 77; /* a gap between 2 and 3 */
    assert_int_equal(ppmi_tangent_group_fan(&f.workspace, 6), 2);
    assert_int_equal(f.corners[2].group, 0);
    assert_int_equal(f.corners[3].group, 1);
}

static void corners_of_no_turn_join_and_pass_on(void **state)
{
    (void)state;
    fan f;
    init_ring(&f, 5, 0);
    f.corners[2].turn = PPMI_TANGENT_ANY;
    assert_int_equal(ppmi_tangent_group_fan(&f.workspace, 5), 1);
    assert_int_equal(f.corners[2].group, 0);
    assert_int_equal(f.corners[4].group, 0);
    for (uint32_t i = 0; i < 5; ++i) {
        f.corners[i].turn = PPMI_TANGENT_ANY;
    }
    assert_int_equal(ppmi_tangent_group_fan(&f.workspace, 5), 0);
    assert_int_equal(f.corners[0].group, PPMI_TANGENT_NO_GROUP);
}

static void an_edge_of_three_triangles_joins_two(void **state)
{
    (void)state;
    fan f;
    init_ring(&f, 3, 0);
    f.corners[2] = f.corners[1]; /* twice the same triangle behind the first's edge */
    assert_int_equal(ppmi_tangent_group_fan(&f.workspace, 3), 2);
    assert_int_equal(f.corners[0].group, 0);
    assert_int_equal(f.corners[1].group + f.corners[2].group, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_has_no_groups),
        cmocka_unit_test(a_ring_is_one_group_whatever_its_size),
        cmocka_unit_test(another_turn_parts_groups),
        cmocka_unit_test(triangles_that_share_no_edge_are_groups_of_their_own),
        cmocka_unit_test(corners_of_no_turn_join_and_pass_on),
        cmocka_unit_test(an_edge_of_three_triangles_joins_two),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
