/* src/api/asset_api.c: files that are opened, imported and posed through the public calls. */
#include <math.h>
#include <string.h>

#include "gltf_motion.h"
#include "ppm/asset.h"

static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
static const char gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

static void write_both(gltf_fixture *f)
{
    gltf_write(f, "a.obj", obj, strlen(obj));
    gltf_write(f, "a.GLTF", gltf, strlen(gltf));
}

static ppm_asset *open_file(gltf_fixture *f, const char *name)
{
    ppm_asset *asset = NULL;
    assert_gltf_status(f, ppm_asset_open(f->context, gltf_path(f, name), NULL, &asset),
                       PPM_STATUS_OK);
    return asset;
}

static void arguments_are_checked(void **state)
{
    gltf_fixture *f = *state;
    ppm_asset *asset = NULL;
    const ppm_import_options small = {.size = 4};
    const char *path = gltf_path(f, "a.obj");
    assert_int_equal(ppm_asset_open(NULL, path, NULL, &asset), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_open(f->context, NULL, NULL, &asset), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_open(f->context, path, NULL, NULL), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_open(f->context, path, &small, &asset), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_open(f->context, path, NULL, &asset), PPM_STATUS_INPUT_NOT_FOUND);
    assert_int_equal(ppm_asset_open(f->context, gltf_path(f, "a.stl"), NULL, &asset),
                     PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'E', "the ending is none of .gltf, .glb and .obj");
    assert_null(asset);
    assert_int_equal(ppm_asset_import(NULL, f->scene), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_set_pose(NULL, NULL), PPM_STATUS_INVALID_ARGUMENT);
    ppm_asset_close(NULL);
}

static void poses_are_checked(void **state)
{
    gltf_fixture *f = *state;
    static const ppm_pose cases[] = {
        {1, NAN, 0, 0}, {1, 0, INFINITY, 0}, {1, 2, 1, 0}, {1, 0, 1, 130}};
    write_both(f);
    ppm_asset *asset = open_file(f, "a.GLTF");
    assert_int_equal(ppm_asset_import(asset, f->scene), PPM_STATUS_OK);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_int_equal(ppm_asset_set_pose(asset, &cases[i]), PPM_STATUS_INVALID_ARGUMENT);
        ppm_import_options options = {.size = sizeof options, .pose = cases[i]};
        ppm_asset *other = NULL;
        assert_int_equal(ppm_asset_open(f->context, gltf_path(f, "a.GLTF"), &options, &other),
                         PPM_STATUS_INVALID_ARGUMENT);
    }
    ppm_asset_close(asset);
}

static void an_asset_is_imported_once_and_then_posed(void **state)
{
    gltf_fixture *f = *state;
    static const char *const names[] = {"a.GLTF", "a.obj"};
    const ppm_pose when = {.is_animated = 1, .open_s = 1, .close_s = 2};
    write_both(f);
    for (size_t i = 0; i < 2; ++i) {
        ppm_asset *asset = open_file(f, names[i]);
        assert_int_equal(ppm_asset_set_pose(asset, &when), PPM_STATUS_WRONG_STATE);
        assert_int_equal(f->scene->instance_count, i);
        assert_int_equal(ppm_asset_import(asset, f->scene), PPM_STATUS_OK);
        assert_int_equal(f->scene->instance_count, i + 1);
        assert_int_equal(ppm_asset_import(asset, f->scene), PPM_STATUS_WRONG_STATE);
        assert_int_equal(ppm_asset_set_pose(asset, &when), PPM_STATUS_OK);
        ppm_asset_close(asset);
    }
}

static void a_scene_that_is_being_rendered_is_not_posed(void **state)
{
    gltf_fixture *f = *state;
    const ppm_pose when = {.is_animated = 1};
    write_both(f);
    ppm_asset *asset = open_file(f, "a.GLTF");
    assert_int_equal(ppm_asset_import(asset, f->scene), PPM_STATUS_OK);
    ppmi_scene_freeze(f->scene);
    assert_int_equal(ppm_asset_set_pose(asset, &when), PPM_STATUS_WRONG_STATE);
    ppmi_scene_thaw(f->scene);
    assert_int_equal(ppm_asset_set_pose(asset, &when), PPM_STATUS_OK);
    ppm_asset_close(asset);
}

static void every_allocation_may_fail(void **state)
{
    gltf_fixture *f = *state;
    static const char *const names[] = {"a.GLTF", "a.obj"};
    write_both(f);
    for (size_t i = 0; i < 2; ++i) {
        ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
        size_t n = 0;
        const ppm_import_options options = {.size = sizeof options, .scene = i == 0 ? NULL : "x"};
        while (status == PPM_STATUS_OUT_OF_MEMORY) {
            ppm_asset *asset = NULL;
            gltf_reset(f);
            ppmi_alloc_fail_at(f->context, ++n);
            status = ppm_asset_open(f->context, gltf_path(f, names[i]), &options, &asset);
            if (status == PPM_STATUS_OK) status = ppm_asset_import(asset, f->scene);
            ppmi_alloc_fail_at(f->context, 0);
            ppm_asset_close(asset);
            assert_true(n < 1000);
        }
        assert_gltf_status(f, status, PPM_STATUS_OK);
        assert_true(n > 20);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(arguments_are_checked),
        TEST(poses_are_checked),
        TEST(an_asset_is_imported_once_and_then_posed),
        TEST(a_scene_that_is_being_rendered_is_not_posed),
        TEST(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
