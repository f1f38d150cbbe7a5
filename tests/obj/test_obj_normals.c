/* importers/obj/obj_normals.c: where normals come from. */
#include <math.h>

#include "obj_fixture.h"

/* Two squares that meet at a right angle along the y axis: one in z = 0, one in x = 0. */
#define ROOF                                                                                       \
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"                                                         \
    "v 0 0 1\nv 0 1 1\n"
#define FLOOR "f 1 2 3 4\n"
#define WALL "f 1 4 6 5\n"

static void assert_normal(const ppmi_primitive *p, uint32_t corner, double x, double y, double z)
{
    assert_non_null(p->normals);
    const float *n = p->normals + 3 * (size_t)p->indices[corner];
    const double size = sqrt(x * x + y * y + z * z);
    assert_obj_near(n[0], x / size);
    assert_obj_near(n[1], y / size);
    assert_obj_near(n[2], z / size);
}

static void without_normals_and_groups_faces_are_flat(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, ROOF FLOOR WALL), PPM_STATUS_OK);
    assert_null(obj_only_primitive(f)->normals);
    assert_obj_status(f, obj_import(f, ROOF "s 1\ns off\n" FLOOR "s 0\n" WALL), PPM_STATUS_OK);
    assert_null(obj_only_primitive(f)->normals);
}

static void faces_of_one_group_are_smooth(void **state)
{
    obj_fixture *f = *state;
    const char *const groups[] = {ROOF "s 1\n" FLOOR WALL, ROOF "s on\n" FLOOR WALL,
                                  ROOF "s 7\n" FLOOR "s 7\n" WALL};
    for (size_t i = 0; i < 3; ++i) {
        assert_obj_status(f, obj_import(f, groups[i]), PPM_STATUS_OK);
        const ppmi_primitive *p = obj_only_primitive(f);
        assert_int_equal(p->vertex_count, 6);
        assert_normal(p, 0, 1, 0, 1); /* on the edge */
        assert_normal(p, 1, 0, 0, 1); /* of the floor alone */
    }
}

static void different_groups_meet_at_a_sharp_edge(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, ROOF "s 1\n" FLOOR "s 2\n" WALL), PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_int_equal(p->vertex_count, 8);
    assert_normal(p, 0, 0, 0, 1);
    assert_normal(p, 6, 1, 0, 0);
}

static void the_mean_is_weighted_by_angle_not_by_split(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, ROOF "s 1\nf 1 2 3\nf 1 3 4\n" WALL), PPM_STATUS_OK);
    assert_normal(obj_only_primitive(f), 0, 1, 0, 1);
}

static void a_group_is_smooth_across_materials_and_nodes(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, ROOF "s 1\ng a\n" FLOOR "g b\n" WALL), PPM_STATUS_OK);
    assert_int_equal(f->scene->mesh_count, 2);
    assert_normal(&f->scene->meshes[0].primitives[0], 0, 1, 0, 1);
    assert_normal(&f->scene->meshes[1].primitives[0], 0, 1, 0, 1);
}

static void the_files_normals_win_over_groups(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, ROOF "vn 0 1 1\ns 1\nf 1//1 2//1 3//1 4//1\n" WALL),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_normal(p, 0, 0, 1, 1);
    assert_normal(p, 6, 1, 0, 0);
}

static void corners_without_a_normal_beside_others_have_the_faces(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, ROOF "vn 0 1 1\nf 1//1 2 3//1\n" WALL), PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_normal(p, 0, 0, 1, 1);
    assert_normal(p, 1, 0, 0, 1);
    assert_normal(p, 3, 1, 0, 0);
    assert_obj_quiet(f);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, obj_setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(without_normals_and_groups_faces_are_flat),
        TEST(faces_of_one_group_are_smooth),
        TEST(different_groups_meet_at_a_sharp_edge),
        TEST(the_mean_is_weighted_by_angle_not_by_split),
        TEST(a_group_is_smooth_across_materials_and_nodes),
        TEST(the_files_normals_win_over_groups),
        TEST(corners_without_a_normal_beside_others_have_the_faces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
