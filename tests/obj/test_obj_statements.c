/* importers/obj/obj_statements.c: vertices, faces and the state between them. */
#include <math.h>
#include <stdio.h>

#include "obj_fixture.h"

/* The position of a triangle's corner. */
static const float *corner(const ppmi_primitive *p, uint32_t i)
{
    assert_true(i < 3 * p->triangle_count);
    return p->positions + 3 * (size_t)p->indices[i];
}

static void assert_corner(const ppmi_primitive *p, uint32_t i, float x, float y, float z)
{
    const float *c = corner(p, i);
    if (c[0] != x || c[1] != y || c[2] != z) {
        fail_msg("corner %u is %g %g %g, expected %g %g %g", i, (double)c[0], (double)c[1],
                 (double)c[2], (double)x, (double)y, (double)z);
    }
}

static void assert_refused(obj_fixture *f, const char *text, const char *message)
{
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_INPUT_INVALID);
    assert_obj_logged(f, 'E', message);
    assert_obj_logged(f, 'E', "sub/scene.obj");
}

/* ---- vertices -------------------------------------------------------------------------------- */

static void numbers_are_read_in_all_their_forms(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, "v -1.5e1 +.25 2E-2\nv\t1\t 0 \t0\r\n"
                                    "v 0 1 0 1 # a weight, and a comment\nf\t1 2  3 # end\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_corner(p, 0, -15.0f, 0.25f, 0.02f);
    assert_corner(p, 1, 1.0f, 0.0f, 0.0f);
    assert_corner(p, 2, 0.0f, 1.0f, 0.0f);
    assert_null(p->colors);
    assert_null(p->normals);
    assert_null(p->uvs[0]);
    assert_obj_quiet(f);
}

static void other_numbers_that_are_none_are_refused_with_their_line(void **state)
{
    obj_fixture *f = *state;
    assert_refused(f, OBJ_TRIANGLE "vt 0,5 0,5\n",
                   "line 4: a texture coordinate is not a number: "
                   "'0,5'; a decimal comma?");
    assert_refused(f, OBJ_TRIANGLE "vn 0 0,0 1\n", "line 4: a normal is not a number: '0,0'");
    assert_refused(f, "v 0 0 0 0,5 0,5 0,5\n", "line 1: a vertex colour is not a number");
}

/* As Microsoft's library wrote them. The '#' begins no comment there. */
static void numbers_that_are_not_finite_are_known_in_all_their_forms(void **state)
{
    obj_fixture *f = *state;
    const char *const forms[] = {"nan", "-nan(ind)", "1.#QNAN", "-1.#IND00", "1.#INF", "inf"};
    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; ++i) {
        char text[512];
        snprintf(text, sizeof text,
                 OBJ_SQUARE "v %s 0 0 # not there\nvn 0 %s 1#no blank\nvt %s 1\n"
                            "f 1/1/1 2/1/1 3/1/1 # 4\nf 1/1/1 2/1/1 5/1/1\n",
                 forms[i], forms[i], forms[i]);
        assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
        const ppmi_primitive *p = obj_only_primitive(f);
        assert_int_equal(p->triangle_count, 1);
        assert_obj_near(p->uvs[0][0], 0.0f);
        assert_obj_logged(f, 'W', "not a finite number");
        assert_obj_logged(f, 'W', "1 texture vertices that are not finite numbers");
        assert_obj_logged(f, 'W', "1 vertex normals that are not finite numbers");
        for (int k = 0; k < 3; ++k) { /* no length: the surface takes the face's */
            assert_obj_near(p->normals[k], 0.0f);
        }
    }
}

static void coordinates_that_are_missing_or_no_numbers_are_refused_with_their_line(void **state)
{
    obj_fixture *f = *state;
    assert_refused(f, "v 0 0 0\n\nv 1 0\n", "line 3: a vertex needs three coordinates");
    assert_refused(f, "v 0 0 0\nv 1,5 0 0\n", "line 2: a coordinate is not a number");
    assert_refused(f, "v 0 abc 0\n", "line 1: a coordinate is not a number");
    assert_refused(f, "v 0 0 \\\n\\\n\nv x\n", "line 1: a vertex needs three coordinates");
}

static void triangles_at_a_vertex_that_is_not_finite_are_left_out(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_SQUARE "v nan 0 0\nv 0 -inf 0\nf 1 2 5\nf 1 2 3\n"
                                               "f 1 6 2\nf 1 2 5 3 4\n"),
                      PPM_STATUS_OK);
    assert_true(obj_only_primitive(f)->triangle_count < 4);
    assert_corner(obj_only_primitive(f), 2, 1.0f, 1.0f, 0.0f);
    assert_obj_logged(f, 'W', "not a finite number");
}

static void colours_behind_the_coordinates_are_decoded(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, "v 0 0 0\nv 1 0 0 0.5 0 1.0\nv 0 1 0 1 0 0 1\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    const float expected[] = {1, 1, 1, 1, 0.21404114f, 0, 1, 1, 1, 0, 0, 1};
    for (size_t i = 0; i < 12; ++i) {
        assert_obj_near(p->colors[i], expected[i]);
    }
    assert_obj_quiet(f);
}

static void colours_up_to_255_are_read_as_such(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, "v 0 0 0 255 0 0\nv 1 0 0 0 0 0\nv 0 1 0 0 0 51\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_obj_near(p->colors[0], 1.0f);
    assert_obj_near(p->colors[10], 0.033104766f);
    assert_obj_logged(f, 'W', "0 .. 255");
}

/* Only colours that can be nothing else are of 0 .. 255. */
static void colours_a_little_or_seldom_beyond_1_are_cut(void **state)
{
    obj_fixture *f = *state;
    static const struct {
        const char *colours[3];
        float first, third;
        int is_told;
    } cases[] = {{{"1.001 0.5 0.5", "1 0.5 0.5", "1 0.5 0.5"}, 1.0f, 0.21404114f, 0},
                 {{"1.5 0 0", "0 0 0", "0.5 0.5 0.5"}, 1.0f, 0.21404114f, 1},
                 {{"300.5 0 0", "0.25 0 0", "0.5 0.5 0.5"}, 1.0f, 0.21404114f, 1},
                 {{"2 0 0", "0 0 0", "1 1 1"}, 1.0f, 1.0f, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[256];
        snprintf(text, sizeof text, "v 0 0 0 %s\nv 1 0 0 %s\nv 0 1 0 %s\nf 1 2 3\n",
                 cases[i].colours[0], cases[i].colours[1], cases[i].colours[2]);
        assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
        const ppmi_primitive *p = obj_only_primitive(f);
        assert_obj_near(p->colors[0], cases[i].first);
        assert_obj_near(p->colors[10], cases[i].third);
        assert_int_equal(obj_logged(f, 'W', "is cut"), cases[i].is_told);
        assert_false(obj_logged(f, 'W', "0 .. 255"));
    }
    /* with fractions, but beyond doubt */
    assert_obj_status(
        f, obj_import(f, "v 0 0 0 255 0 0\nv 1 0 0 127.5 9 9\nv 0 1 0 0 0 51\nf 1 2 3\n"),
        PPM_STATUS_OK);
    assert_obj_near(obj_only_primitive(f)->colors[10], 0.033104766f);
}

/* ---- faces ----------------------------------------------------------------------------------- */

static void negative_indices_count_from_the_latest_element(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_TRIANGLE "vt 0 0\nvt 1 0\nvn 0 0 1\nf -3/-2/-1 -2/-1/-1 "
                                                 "-1/-2/-1\nv 5 0 0\nvn 0 1 0\nf -1//-1 -3//-1 "
                                                 "-2//-1\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_int_equal(p->triangle_count, 2);
    assert_corner(p, 0, 0.0f, 0.0f, 0.0f);
    assert_corner(p, 2, 0.0f, 1.0f, 0.0f);
    assert_corner(p, 3, 5.0f, 0.0f, 0.0f);
    assert_corner(p, 5, 0.0f, 1.0f, 0.0f);
    assert_obj_near(p->normals[3 * p->indices[0] + 2], 1.0f);
    assert_obj_near(p->normals[3 * p->indices[3] + 1], 1.0f);
    assert_obj_near(p->uvs[0][2 * p->indices[1]], 1.0f);
}

static void a_face_may_come_before_its_vertices(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, "f 1 2 3\n" OBJ_TRIANGLE), PPM_STATUS_OK);
    assert_corner(obj_only_primitive(f), 1, 1.0f, 0.0f, 0.0f);
}

static void a_face_whose_vertex_is_not_there_is_left_out(void **state)
{
    obj_fixture *f = *state;
    static const struct {
        const char *face, *message;
    } cases[] = {{"f 1 2 4\n", "line 4: a face has vertex 4, of 3"},
                 {"f 1 2 -4\n", "line 4: a face has a negative index that points before"},
                 {"f 1 2 0\n", "line 4: a face has an index of 0"},
                 {"f 1 2 x\n", "line 4: a face has an index of 0"},
                 {"f 1 2 999999999\n", "line 4: a face has vertex 999999999"},
                 {"f 1 2 4294967297\n", "line 4: a face has an index of more"},
                 {"l 1 x\n", "line 4: a line has an index that is not a number"},
                 {"l 1 9\n", "line 4: a line has vertex 9, of 3"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[256];
        snprintf(text, sizeof text, OBJ_TRIANGLE "%s", cases[i].face);
        assert_refused(f, text, cases[i].message); /* nothing is left */
        assert_obj_logged(f, 'E', "nothing is left");
        snprintf(text, sizeof text, OBJ_TRIANGLE "%sg other\ns 1\nf 3 1 2\n", cases[i].face);
        assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
        assert_obj_logged(f, 'W', cases[i].message);
        assert_int_equal(obj_only_primitive(f)->triangle_count, 1);
        assert_corner(obj_only_primitive(f), 0, 0.0f, 1.0f, 0.0f);
        f->options.strict = 1;
        assert_refused(f, text, cases[i].message);
        assert_obj_logged(f, 'E', "strict");
        f->options.strict = 0;
    }
}

static void a_face_whose_normal_or_texture_vertex_is_not_there_goes_without(void **state)
{
    obj_fixture *f = *state;
    const char *const normals = OBJ_SQUARE "vn 0 1 0\nf 1//1 2//1 3//2\nf 1//1 3//1 4//-7\n";
    const char *const uvs = OBJ_SQUARE "vt 1 1\nf 1/1 2/1 3/-2\nf 1/1 3/1 4/1\n";
    assert_obj_status(f, obj_import(f, normals), PPM_STATUS_OK);
    assert_obj_logged(f, 'W', "line 6: a face has vertex normal 2, of 1");
    assert_obj_logged(f, 'W', "2 faces, lines and points with such a vertex normal");
    assert_int_equal(obj_only_primitive(f)->triangle_count, 2);
    assert_null(obj_only_primitive(f)->normals);
    assert_obj_status(f, obj_import(f, uvs), PPM_STATUS_OK);
    assert_obj_logged(f, 'W', "1 faces, lines and points with such a texture vertex");
    const ppmi_primitive *p = obj_only_primitive(f);
    for (int i = 0; i < 3; ++i) { /* the whole face */
        assert_obj_near(p->uvs[0][2 * p->indices[i]], 0.0f);
        assert_obj_near(p->uvs[0][2 * p->indices[3 + i]], 1.0f);
    }
    f->options.strict = 1;
    assert_refused(f, normals, "strict");
    assert_refused(f, uvs, "strict");
}

/* With the normal of another face beside it, a face without one is flat. */
static void a_face_without_its_normal_is_flat_among_others(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_SQUARE "vn 0 1 0\nf 1//1 2//1 3//2\nf 1//1 3//1 4//1\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    for (int i = 0; i < 3; ++i) {
        assert_obj_near(p->normals[3 * p->indices[i] + 2], 1.0f);
        assert_obj_near(p->normals[3 * p->indices[3 + i] + 1], 1.0f);
    }
}

static void indices_into_elements_of_which_there_are_none_are_dropped(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "f 1/1/4 2/2/5 3/3/6\n"), PPM_STATUS_OK);
    assert_null(obj_only_primitive(f)->normals);
    assert_null(obj_only_primitive(f)->uvs[0]);
    assert_obj_logged(f, 'W', "texture vertices, of which there are none");
    assert_obj_logged(f, 'W', "vertex normals, of which there are none");
}

static void slashes_with_nothing_behind_them_are_no_indices(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "vn 0 0 1\nf 1// 2// 3//\nf 1/ 2/ 3/\n"),
                      PPM_STATUS_OK);
    assert_int_equal(obj_only_primitive(f)->triangle_count, 2);
    assert_null(obj_only_primitive(f)->normals);
    assert_obj_quiet(f);
}

static void faces_of_fewer_than_three_corners_are_counted(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "f 1 2 3\nf 1 2\nf 1\nf\n"), PPM_STATUS_OK);
    assert_int_equal(obj_only_primitive(f)->triangle_count, 1);
    assert_obj_logged(f, 'W', "3 faces of fewer than three corners");
}

static void polygons_of_many_corners_are_split(void **state)
{
    obj_fixture *f = *state;
    static char text[1 << 16];
    size_t used = 0;
    for (int i = 0; i < 700; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / 700.0;
        used += (size_t)sprintf(text + used, "v %.9f %.9f 0\n", cos(angle), sin(angle));
    }
    used += (size_t)sprintf(text + used, "f");
    for (int i = 1; i <= 700; ++i) {
        used += (size_t)sprintf(text + used, " %d", i);
    }
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
    assert_int_equal(obj_only_primitive(f)->triangle_count, 698);
    assert_int_equal(obj_only_primitive(f)->vertex_count, 700);
}

/* ---- state ----------------------------------------------------------------------------------- */

static void objects_and_groups_are_named_nodes(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_TRIANGLE "f 1 2 3\no  a cube \nf 1 2 3\ng left   side\n"
                                                 "f 1 2 3\no other\nf 1 2 3\no\ng free\nf 1 2 3\n"
                                                 "g default\nf 1 2 3\ng\nf 1 2 3\ng free\nf 1 2 "
                                                 "3\n"),
                      PPM_STATUS_OK);
    const char *const names[] = {"scene", "a cube", "a cube/left   side", "other", "free"};
    const uint32_t triangles[] = {3, 1, 1, 1, 2};
    assert_int_equal(f->scene->instance_count, 5);
    for (uint32_t i = 0; i < 5; ++i) {
        assert_string_equal(f->scene->instances[i].name, names[i]);
        assert_int_equal(f->scene->instances[i].mesh, i);
        assert_string_equal(f->scene->meshes[i].name, names[i]);
        assert_int_equal(f->scene->meshes[i].primitives[0].triangle_count, triangles[i]);
    }
    assert_obj_quiet(f);
}

static void comments_behind_names_are_not_of_them(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_TRIANGLE "o Thing # a comment\nf 1 2 3\no Part#3\nf 1 2 3\n"
                                                 "o Box #2\nf 1 2 3\no Thing\ng left #side\n"
                                                 "f 1 2 3\ng # none\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    const char *const names[] = {"Thing", "Part#3", "Box #2", "Thing/left"};
    assert_int_equal(f->scene->instance_count, 4);
    for (uint32_t i = 0; i < 4; ++i) {
        assert_string_equal(f->scene->instances[i].name, names[i]);
    }
}

static void names_are_utf8_whatever_the_file_is(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_TRIANGLE "o K\xe4se\nf 1 2 3\no K\xc3\xa4se\nf 1 2 3\n"
                                                 "o \x01-\xed\xa0\x80\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 2);
    assert_string_equal(f->scene->instances[0].name, "K\xc3\xa4se");
    assert_string_equal(f->scene->instances[1].name, "?-\xc3\xad\xc2\xa0\xc2\x80");
}

static void what_is_not_drawn_is_counted(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_TRIANGLE "f 1 2 3\nl 1\nl\np\ncstype bezier\n"
                                                 "curv 0 1 1 2\nend\nwhat is this\nVT 1 2\n"),
                      PPM_STATUS_OK);
    assert_obj_logged(f, 'W', "3 lines and points of too few vertices left out");
    assert_obj_logged(f, 'W', "1 free-form curves and surfaces left out");
    assert_obj_logged(f, 'W', "2 unknown statements left out, the first is 'what' in line 11");
}

static void a_file_without_vertices_is_refused(void **state)
{
    obj_fixture *f = *state;
    static const char zeros[1000];
    assert_refused(f, "", "no vertices");
    assert_refused(f, "# nothing\n", "no vertices");
    assert_refused(f, "{\"asset\": {}}", "no vertices");
    assert_obj_status(f, obj_import_bytes(f, zeros, sizeof zeros), PPM_STATUS_INPUT_INVALID);
}

static void a_file_without_faces_has_nothing_to_render(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "l 1\n"), PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 0);
    assert_obj_logged(f, 'W', "nothing to render");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, obj_setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(numbers_are_read_in_all_their_forms),
        TEST(coordinates_that_are_missing_or_no_numbers_are_refused_with_their_line),
        TEST(other_numbers_that_are_none_are_refused_with_their_line),
        TEST(numbers_that_are_not_finite_are_known_in_all_their_forms),
        TEST(triangles_at_a_vertex_that_is_not_finite_are_left_out),
        TEST(colours_behind_the_coordinates_are_decoded),
        TEST(colours_up_to_255_are_read_as_such),
        TEST(colours_a_little_or_seldom_beyond_1_are_cut),
        TEST(negative_indices_count_from_the_latest_element),
        TEST(a_face_may_come_before_its_vertices),
        TEST(a_face_whose_vertex_is_not_there_is_left_out),
        TEST(a_face_whose_normal_or_texture_vertex_is_not_there_goes_without),
        TEST(a_face_without_its_normal_is_flat_among_others),
        TEST(indices_into_elements_of_which_there_are_none_are_dropped),
        TEST(slashes_with_nothing_behind_them_are_no_indices),
        TEST(faces_of_fewer_than_three_corners_are_counted),
        TEST(polygons_of_many_corners_are_split),
        TEST(objects_and_groups_are_named_nodes),
        TEST(comments_behind_names_are_not_of_them),
        TEST(names_are_utf8_whatever_the_file_is),
        TEST(what_is_not_drawn_is_counted),
        TEST(a_file_without_vertices_is_refused),
        TEST(a_file_without_faces_has_nothing_to_render),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
