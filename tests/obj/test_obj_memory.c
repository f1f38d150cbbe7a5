/* The importer's ways out when memory ends: the n-th allocation fails, for every n. */
#include <stdio.h>

#include "obj_fixture.h"

static const char document[] =
    "mtllib scene.mtl\no a\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0.1 0.2 0\nvt 0 0\nvn 0 0 1\n"
    "usemtl m\ns 1\nf 1/1 2/1 3/1 4/1\ng b\ns 0\nf 1//1 2//1 3\nusemtl n\nf 1 2 3\n";

/* Without groups, with a crease angle; lines and points; a mixture, a height map and tangents; a
 * file in a texture path. */
static const char creased[] =
    "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
    "usemtl m\nf 1/1 2/2 3/3\nf 1/1 3/3 4/2\nl 1 2 3\np 4\n";

/* Imports the document with a failure at every allocation, until it succeeds. */
static void fail_at_every_allocation(obj_fixture *f, const char *text, const char *library,
                                     size_t least)
{
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 0;
    obj_write_text(f, "sub/scene.obj", text);
    obj_write_text(f, "sub/scene.mtl", library);
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        obj_reset(f);
        ppmi_alloc_fail_at(f->context, ++n);
        status = ppmi_obj_import(f->context, f->scene, obj_path(f, "sub/scene.obj"), &f->options);
        ppmi_alloc_fail_at(f->context, 0);
        assert_true(n < 1000);
    }
    assert_obj_status(f, status, PPM_STATUS_OK);
    assert_true(n > least);
}

static void every_allocation_may_fail(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/X.ppm", "P6 1 1 255\nabc");
    fail_at_every_allocation(
        f, document, "Kd 1 1 1\nnewmtl m\nmap_Kd -s 2 x.ppm\ndisp y\nnewmtl m\nnewmtl n\n", 50);
    assert_int_equal(f->scene->mesh_count, 2);
    assert_int_equal(f->scene->image_count, 1);
}

static void every_allocation_of_creases_lines_and_mixtures_may_fail(void **state)
{
    obj_fixture *f = *state;
    char folder[96];
    const char *const folders[] = {folder};
    snprintf(folder, sizeof folder, "%s", obj_path(f, "sub/Maps"));
    f->options.texture_folders = folders;
    f->options.texture_folder_count = 1;
    f->options.crease_rad = 1.0f;
    obj_write_text(f, "sub/X.ppm", "P6 1 1 255\nabc");
    obj_write_text(f, "sub/Maps/y.ppm", "P6 1 2 255\nabcdef");
    fail_at_every_allocation(f, creased,
                             "newmtl m\nmap_Kd x.ppm\nmap_d y.ppm\nmap_Pr y.ppm\nmap_Pm x.ppm\n"
                             "bump y.ppm\nmap_Pc -mm 0 0.5 y.ppm\n",
                             100);
    assert_int_equal(f->scene->image_count, 4);
    assert_int_equal(f->scene->meshes[0].primitive_count, 3);
    assert_non_null(f->scene->meshes[0].primitives[0].tangents);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_allocation_may_fail, obj_setup, obj_teardown),
        cmocka_unit_test_setup_teardown(every_allocation_of_creases_lines_and_mixtures_may_fail,
                                        obj_setup, obj_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
