/* importers/obj/obj_elements.c: lines and points; and what an OBJ cannot say: unit and up axis. */
#include <math.h>
#include <stdio.h>

#include "obj_fixture.h"

static void broken_lines_and_points_are_refused_with_their_line(void **state)
{
    obj_fixture *f = *state;
    static const struct {
        const char *statement, *message;
    } cases[] = {
        {"l 1 0\n", "line 4: a line has an index of 0"},
        {"l 1 9\n", "line 4: a line has vertex 9, of 3 in the file"},
        {"l 1 -4\n", "line 4: a line has a negative index that points before the first element"},
        {"l 1 x\n", "line 4: a line has an index that is not a number"},
        {"l 1 2.5\n", "line 4: a line has an index that is not a number"},
        {"l 1 1234567890\n", "line 4: a line has an index that is not a number of at most nine"},
        {"l 1 -\n", "line 4: a line has an index that is not a number"},
        {"p 4\n", "line 4: a point has vertex 4, of 3 in the file"},
        {"p /1\n", "line 4: a point has an index that is not a number"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[256];
        snprintf(text, sizeof text, OBJ_TRIANGLE "%s", cases[i].statement);
        assert_obj_status(f, obj_import(f, text), PPM_STATUS_INPUT_INVALID);
        assert_obj_logged(f, 'E', cases[i].message);
    }
}

static void a_line_whose_texture_vertex_is_not_there_goes_without(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "vt 0.5 0.5\nl 1/1 2/7\n"), PPM_STATUS_OK);
    assert_obj_logged(f, 'W', "line 5: a line has texture vertex 7, of 1 in the file");
    assert_null(obj_only_primitive(f)->uvs[0]);
}

static void a_line_is_a_segment_from_each_vertex_to_the_next(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "l 1 2 -1 # closed\nl 3 1\n"), PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    const uint32_t expected[] = {0, 1, 1, 2, 2, 0};
    assert_int_equal(p->kind, PPM_PRIMITIVE_LINES);
    assert_int_equal(p->element_count, 3);
    assert_int_equal(p->vertex_count, 3);
    assert_memory_equal(p->indices, expected, sizeof expected);
    assert_obj_quiet(f);
}

static void every_vertex_of_a_point_statement_is_a_point(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "p 1 3\np 2\n"), PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_int_equal(p->kind, PPM_PRIMITIVE_POINTS);
    assert_int_equal(p->element_count, 3);
    assert_obj_near(p->positions[3 * (size_t)p->indices[1] + 1], 1.0); /* the file's third */
}

static void lines_have_texture_coordinates_and_colours(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, "v 0 0 0 1 0 0\nv 1 0 0 1 1 1\nvt 0.5 1\nl 1/1 2/1\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_obj_near(p->uvs[0][0], 0.5);
    assert_obj_near(p->uvs[0][1], 0.0);
    assert_obj_near(p->colors[1], 0.0);
    assert_obj_near(p->colors[5], 1.0);
}

static void faces_lines_and_points_of_a_node_are_parts_of_one_mesh(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "o a\nf 1 2 3\nl 1 2\np 1\nf 3 2 1\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->mesh_count, 1);
    const ppmi_mesh *mesh = &f->scene->meshes[0];
    assert_int_equal(mesh->primitive_count, 3);
    assert_int_equal(mesh->primitives[0].triangle_count, 2);
    assert_int_equal(mesh->primitives[1].kind, PPM_PRIMITIVE_POINTS);
    assert_int_equal(mesh->primitives[2].kind, PPM_PRIMITIVE_LINES);
}

static void the_radius_is_that_of_the_option_or_a_share_of_the_box(void **state)
{
    obj_fixture *f = *state;
    const char *const text = "v 0 0 0\nv 3 0 0\nv 3 4 0\nv nan 1 0\nl 1 2\n";
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
    assert_obj_near(obj_only_primitive(f)->radius_m, 0.01); /* 0.2 % of 5 */
    assert_obj_status(f, obj_import(f, "v 1 1 1\np 1\n"), PPM_STATUS_OK);
    assert_obj_near(obj_only_primitive(f)->radius_m, 0.001);
    f->options.line_radius_m = 0.25f;
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
    assert_obj_near(obj_only_primitive(f)->radius_m, 0.25);
}

static void assert_corner(const ppm_scene *scene, size_t vertex, double x, double y, double z)
{
    const float *p = scene->meshes[0].primitives[0].positions + 3 * vertex;
    const ppmi_vec3 at =
        ppmi_transform_point(&scene->instances[0].to_world, (ppmi_vec3){p[0], p[1], p[2]});
    assert_obj_near(at.x, x);
    assert_obj_near(at.y, y);
    assert_obj_near(at.z, z);
}

static void coordinates_are_metres_with_y_up_unless_asked_otherwise(void **state)
{
    obj_fixture *f = *state;
    const char *const text = "v 1 2 3\nv 2 2 3\nv 1 3 3\nf 1 2 3\n";
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
    assert_corner(f->scene, 0, 1, 2, 3);
    f->options.unit_scale = 0.01f;
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
    assert_corner(f->scene, 0, 0.01, 0.02, 0.03);
    f->options.up = PPM_UP_Z; /* +Z of the file is up, +Y goes away from who looks along -Z */
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
    assert_corner(f->scene, 0, 0.01, 0.03, -0.02);
    assert_false(f->scene->instances[0].is_mirrored);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, obj_setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(broken_lines_and_points_are_refused_with_their_line),
        TEST(a_line_whose_texture_vertex_is_not_there_goes_without),
        TEST(a_line_is_a_segment_from_each_vertex_to_the_next),
        TEST(every_vertex_of_a_point_statement_is_a_point),
        TEST(lines_have_texture_coordinates_and_colours),
        TEST(faces_lines_and_points_of_a_node_are_parts_of_one_mesh),
        TEST(the_radius_is_that_of_the_option_or_a_share_of_the_box),
        TEST(coordinates_are_metres_with_y_up_unless_asked_otherwise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
