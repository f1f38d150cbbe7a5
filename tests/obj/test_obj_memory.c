/* The importer's ways out when memory ends: the n-th allocation fails, for every n. */
#include "obj_fixture.h"

static const char document[] =
    "mtllib scene.mtl\no a\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0.1 0.2 0\nvt 0 0\nvn 0 0 1\n"
    "usemtl m\ns 1\nf 1/1 2/1 3/1 4/1\ng b\ns 0\nf 1//1 2//1 3\nusemtl n\nf 1 2 3\n";

static void every_allocation_may_fail(void **state)
{
    obj_fixture *f = *state;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 0;
    obj_write_text(f, "sub/scene.mtl",
                   "Kd 1 1 1\nnewmtl m\nmap_Kd -s 2 x.ppm\ndisp y\nnewmtl m\nnewmtl n\n");
    obj_write_text(f, "sub/X.ppm", "P6 1 1 255\nabc");
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        obj_reset(f);
        obj_write_text(f, "sub/scene.obj", document);
        ppmi_alloc_fail_at(f->context, ++n);
        status = ppmi_obj_import(f->context, f->scene, obj_path(f, "sub/scene.obj"), &f->options);
        ppmi_alloc_fail_at(f->context, 0);
        assert_true(n < 1000);
    }
    assert_obj_status(f, status, PPM_STATUS_OK);
    assert_true(n > 50);
    assert_int_equal(f->scene->mesh_count, 2);
    assert_int_equal(f->scene->image_count, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_allocation_may_fail, obj_setup, obj_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
