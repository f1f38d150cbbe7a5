/* importers/obj/obj_crease.c: normals by crease angle. */
#include <math.h>
#include <stdio.h>

#include "obj_fixture.h"

#define DEGREE (float)(3.14159265358979323846 / 180.0)

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

static const ppmi_primitive *import_at(obj_fixture *f, float degrees, const char *text)
{
    f->options.crease_rad = degrees * DEGREE;
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
    return obj_only_primitive(f);
}

static void an_edge_is_smooth_up_to_the_angle(void **state)
{
    obj_fixture *f = *state;
    const ppmi_primitive *p = import_at(f, 91.0f, ROOF FLOOR WALL);
    assert_int_equal(p->vertex_count, 6);
    assert_normal(p, 0, 1, 0, 1); /* on the edge */
    assert_normal(p, 1, 0, 0, 1); /* of the floor alone */
    p = import_at(f, 89.0f, ROOF FLOOR WALL);
    assert_int_equal(p->vertex_count, 8);
    assert_normal(p, 0, 0, 0, 1);
    assert_normal(p, 6, 1, 0, 0);
    p = import_at(f, 180.0f, ROOF FLOOR "f 1 2 3 4\n");
    assert_normal(p, 0, 0, 0, 1);
}

static void vertices_at_one_place_count_as_one(void **state)
{
    obj_fixture *f = *state;
    const ppmi_primitive *p =
        import_at(f, 91.0f, ROOF FLOOR "v -0 0 0\nv 0 1 0\nv 0 1 1\nv 0 0 1\nf 7 8 9 10\n");
    assert_normal(p, 0, 1, 0, 1);
    assert_normal(p, 6, 1, 0, 1);
}

/* A fan of steps of 20 degrees around the y axis: smooth from each to the next, though the first
 * and the last one differ by far more. */
static void smoothness_goes_on_from_face_to_face(void **state)
{
    obj_fixture *f = *state;
    char text[2048];
    size_t used = 0;
    for (int i = 0; i <= 6; ++i) {
        const double a = 20.0 * i * 3.14159265358979323846 / 180.0;
        used += (size_t)snprintf(text + used, sizeof text - used, "v %.9f 0 %.9f\nv %.9f 1 %.9f\n",
                                 cos(a), sin(a), cos(a), sin(a));
    }
    for (int i = 0; i < 6; ++i) {
        used += (size_t)snprintf(text + used, sizeof text - used, "f %d %d %d %d\n", 2 * i + 1,
                                 2 * i + 2, 2 * i + 4, 2 * i + 3);
    }
    const ppmi_primitive *p = import_at(f, 25.0f, text);
    assert_int_equal(p->vertex_count, 14);
    assert_int_equal(import_at(f, 15.0f, text)->vertex_count, 24);
}

static void groups_and_normals_of_the_file_win(void **state)
{
    obj_fixture *f = *state;
    /* a file that has groups has said what is smooth */
    const ppmi_primitive *p = import_at(f, 180.0f, ROOF "s 1\n" FLOOR "s off\n" WALL);
    assert_normal(p, 0, 0, 0, 1);
    /* "off" alone says nothing: some programs always write it */
    assert_normal(import_at(f, 91.0f, ROOF "s off\n" FLOOR WALL), 0, 1, 0, 1);
    p = import_at(f, 180.0f, ROOF "vn 0 1 1\nf 1//1 2//1 3//1 4//1\n" WALL);
    assert_normal(p, 0, 0, 1, 1);
}

static void faces_without_area_and_places_that_are_not_finite_do_no_harm(void **state)
{
    obj_fixture *f = *state;
    f->options.crease_rad = 60.0f * DEGREE;
    assert_obj_status(f,
                      obj_import(f, ROOF "v nan 0 0\nv 1e38 1e38 1e38\n" FLOOR
                                         "f 1 2 2\nf 1 1 1 1\nf 1 2 7\nf 5 6 8\nl 1 2\n"),
                      PPM_STATUS_OK);
    assert_normal(&f->scene->meshes[0].primitives[0], 0, 0, 0, 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, obj_setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(an_edge_is_smooth_up_to_the_angle),
        TEST(vertices_at_one_place_count_as_one),
        TEST(smoothness_goes_on_from_face_to_face),
        TEST(groups_and_normals_of_the_file_win),
        TEST(faces_without_area_and_places_that_are_not_finite_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
