/* importers/obj/obj_library.c and obj_path.c: which files are read, and how they are cut. */
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "obj_fixture.h"

/* Imports a triangle of material m with a mtllib statement. */
static void import_with(obj_fixture *f, const char *libraries)
{
    char text[512];
    snprintf(text, sizeof text, "%s\nusemtl m\n" OBJ_TRIANGLE "f 1 2 3\n", libraries);
    assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
}

/* Whether the triangle has the material m of a library, not the default. */
static int has_material(const obj_fixture *f)
{
    return strcmp(f->scene->materials[obj_only_primitive(f)->material].name, "m") == 0;
}

static void assert_read(obj_fixture *f, const char *libraries)
{
    import_with(f, libraries);
    if (!has_material(f)) fail_msg("%s was not read\n%s", libraries, f->log);
}

static void assert_not_read(obj_fixture *f, const char *libraries)
{
    import_with(f, libraries);
    if (has_material(f)) fail_msg("%s was read\n%s", libraries, f->log);
    assert_obj_logged(f, 'W', "mtllib");
}

static void names_may_hold_blanks_and_stand_in_a_row(void **state)
{
    obj_fixture *f = *state;
    const char *const lists[] = {"mtllib a b.mtl", "mtllib other.mtl a b.mtl",
                                 "mtllib a b.mtl x y.mtl", "mtllib x y.mtl\nmtllib a b.mtl"};
    obj_write_text(f, "sub/a b.mtl", "newmtl m\nKd 1 0 0\n");
    obj_write_text(f, "sub/other.mtl", "newmtl n\n");
    for (size_t i = 0; i < 4; ++i) {
        assert_read(f, lists[i]);
    }
    obj_write_text(f, "sub/plain", "newmtl m\n");
    assert_read(f, "mtllib missing plain");
    assert_obj_quiet(f);
}

static void a_library_that_is_elsewhere_is_found_by_its_last_part(void **state)
{
    obj_fixture *f = *state;
    const char *const names[] = {"mtllib C:\\models\\Scene.mtl",
                                 "mtllib /home/me/Scene.mtl",
                                 "mtllib ../Scene.mtl",
                                 "mtllib lib/Scene.mtl",
                                 "mtllib sCENE.MTL",
                                 "mtllib maps\\..\\Scene.mtl",
                                 "mtllib Maps/../../../../Scene.mtl"};
    obj_write_text(f, "sub/Scene.mtl", "newmtl m\nKd 1 0 0\n");
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        assert_read(f, names[i]);
        assert_obj_logged(f, 'W', "read from");
    }
    assert_read(f, "mtllib Scene.mtl");
    assert_obj_quiet(f);
}

static void nothing_outside_of_the_folder_is_read(void **state)
{
    obj_fixture *f = *state;
    char absolute[200];
    obj_write_text(f, "outside.mtl", "newmtl m\nKd 1 0 0\n");
    snprintf(absolute, sizeof absolute, "mtllib %s", obj_path(f, "outside.mtl"));
    assert_not_read(f, absolute);
    assert_not_read(f, "mtllib ../outside.mtl");
    assert_not_read(f, "mtllib ..\\outside.mtl");
    assert_not_read(f, "mtllib Maps/../../outside.mtl");
    assert_not_read(f, "mtllib Maps"); /* a folder */
    assert_not_read(f, "mtllib ..");
    assert_not_read(f, "mtllib .");
    assert_not_read(f, "mtllib");
}

static void comments_behind_names_are_cut_where_there_is_no_such_name(void **state)
{
    obj_fixture *f = *state;
    static const struct {
        const char *in_library, *used, *shown;
    } cases[] = {{"Red", "Red # body paint", "Red"},
                 {"Red # red paint", "Red", "Red"},
                 {"Red # red paint", "Red # body", "Red"},
                 {"Red #1", "Red #1", "Red #1"},
                 {"Red #1", "Red #1 # one", "Red #1"},
                 {"Red #1 # one", "Red #1", "Red #1"},
                 {"Red # a # b", "Red", "Red"},
                 {"Red#1", "Red#1", "Red#1"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char text[256];
        snprintf(text, sizeof text, "newmtl Other\nnewmtl %s\nKd 1 0 0 # red\nd 1# opaque\n",
                 cases[i].in_library);
        obj_write_text(f, "sub/scene.mtl", text);
        snprintf(text, sizeof text,
                 "mtllib scene.mtl # the library\nusemtl %s\n" OBJ_TRIANGLE "f 1 2 3\n",
                 cases[i].used);
        assert_obj_status(f, obj_import(f, text), PPM_STATUS_OK);
        assert_obj_quiet(f);
        assert_int_equal(f->scene->material_count, 1);
        assert_string_equal(f->scene->materials[0].name, cases[i].shown);
        assert_obj_near(f->scene->materials[0].desc.base_color[1], 0.0);
    }
}

static void a_name_as_it_stands_comes_before_one_without_comment(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/scene.mtl", "newmtl Red\nKd 1 0 0\nnewmtl Red # 2\nKd 0 1 0\n");
    assert_obj_status(f,
                      obj_import(f, "mtllib scene.mtl\n" OBJ_TRIANGLE "usemtl Red # 2\nf 1 2 3\n"
                                    "usemtl Red # 3\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->material_count, 2);
    assert_string_equal(f->scene->materials[0].name, "Red # 2");
    assert_obj_near(f->scene->materials[0].desc.base_color[1], 1.0);
    assert_string_equal(f->scene->materials[1].name, "Red");
}

static void a_library_whose_name_has_a_mark_is_read(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/#a #1.mtl", "newmtl m\n");
    assert_read(f, "mtllib #a #1.mtl");
    assert_read(f, "mtllib #a #1.mtl # one");
    assert_obj_quiet(f);
    assert_not_read(f, "mtllib missing # one");
}

static void an_obj_without_a_folder_in_its_path_finds_its_library(void **state)
{
    obj_fixture *f = *state;
    char here[512];
    obj_write_text(f, "sub/Scene.mtl", "newmtl m\n");
    obj_write_text(f, "sub/s.obj", "mtllib scene.mtl\nusemtl m\n" OBJ_TRIANGLE "f 1 2 3\n");
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(obj_path(f, "sub")), 0);
    const ppm_status status = ppmi_obj_import(f->context, f->scene, "s.obj", &f->options);
    assert_int_equal(chdir(here), 0);
    assert_obj_status(f, status, PPM_STATUS_OK);
    assert_true(has_material(f));
}

static void materials_may_have_no_name_blanks_or_another_encoding(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(
        f, "sub/scene.mtl",
        "newmtl\nKd 1 0 0\nnewmtl  two words \nKd 0 1 0\r\n\tnewmtl K\xc3\xa4se\nKd 0 0 1");
    assert_obj_status(f,
                      obj_import(f, "mtllib scene.mtl\n" OBJ_TRIANGLE "usemtl\nf 1 2 3\n"
                                    "usemtl two words\t\nf 1 2 3\nusemtl K\xe4se\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->material_count, 3);
    for (uint32_t i = 0; i < 3; ++i) {
        assert_obj_near(f->scene->materials[i].desc.base_color[i], 1.0);
        assert_obj_near(f->scene->materials[i].desc.base_color[(i + 1) % 3], 0.0);
    }
    assert_obj_quiet(f);
}

static void of_two_materials_of_one_name_the_first_counts(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/scene.mtl", "newmtl m\nKd 1 0 0\n\nnewmtl m\nKd 0 1 0\n");
    assert_read(f, "mtllib scene.mtl scene.mtl\nmtllib scene.mtl");
    assert_obj_near(f->scene->materials[0].desc.base_color[0], 1.0);
    assert_obj_logged(f, 'W', "scene.mtl: line 4: material 'm' left out");
}

static void statements_before_the_first_material_are_left_out(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/scene.mtl", "Kd 1 0 0\nd 0.5\nnewmtl m\nKs 0 0 0\n");
    assert_read(f, "mtllib scene.mtl");
    assert_obj_near(f->scene->materials[0].desc.base_color[1], 0.8);
    assert_int_equal(f->scene->materials[0].desc.alpha_mode, PPM_ALPHA_OPAQUE);
    assert_obj_logged(f, 'W', "2 statements before the first newmtl");
}

static void a_library_of_something_else_does_no_harm(void **state)
{
    obj_fixture *f = *state;
    char bytes[4096];
    for (size_t i = 0; i < sizeof bytes; ++i) {
        bytes[i] = (char)(i * 2654435761u >> 13);
    }
    obj_write(f, "sub/scene.mtl", bytes, sizeof bytes);
    import_with(f, "mtllib scene.mtl");
    obj_write_text(f, "sub/scene.mtl",
                   "newmtl m\nmap_Kd\nKd\nNs\nillum x\nmap_Ke -s\nmap_Kd -s -o -t");
    assert_read(f, "mtllib scene.mtl");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, obj_setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(names_may_hold_blanks_and_stand_in_a_row),
        TEST(a_library_that_is_elsewhere_is_found_by_its_last_part),
        TEST(nothing_outside_of_the_folder_is_read),
        TEST(comments_behind_names_are_cut_where_there_is_no_such_name),
        TEST(a_name_as_it_stands_comes_before_one_without_comment),
        TEST(a_library_whose_name_has_a_mark_is_read),
        TEST(an_obj_without_a_folder_in_its_path_finds_its_library),
        TEST(materials_may_have_no_name_blanks_or_another_encoding),
        TEST(of_two_materials_of_one_name_the_first_counts),
        TEST(statements_before_the_first_material_are_left_out),
        TEST(a_library_of_something_else_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
