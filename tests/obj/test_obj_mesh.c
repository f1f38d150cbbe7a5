/* importers/obj/obj_mesh.c: nodes, primitives and shared vertices. */
#include "obj_fixture.h"

static void a_square_shares_its_vertices(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_SQUARE "vt 0 0\nvt 1 1\nvn 0 0 1\n"
                                               "f 1/1/1 2/1/1 3/1/1 4/1/1\nf 1/2/1 2/1/1 3/1/1\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_int_equal(p->triangle_count, 3);
    assert_int_equal(p->vertex_count, 5); /* the first corner has two texture coordinates */
}

static void texture_coordinates_point_down(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_TRIANGLE "vt 0.25 0.125\nvt 0.5\nvt 2 3 4\n"
                                                 "f 1/1 2/2 3/3\n"),
                      PPM_STATUS_OK);
    const float *uvs = obj_only_primitive(f)->uvs[0];
    const float expected[] = {0.25f, 0.875f, 0.5f, 1.0f, 2.0f, -2.0f};
    for (size_t i = 0; i < 6; ++i) {
        assert_obj_near(uvs[i], expected[i]);
    }
}

static void corners_without_texture_coordinates_have_zero_beside_others(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "vt 1 0\nf 1/1 2 3/1\n"), PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_obj_near(p->uvs[0][0], 1.0f);
    assert_obj_near(p->uvs[0][2], 0.0f);
    assert_obj_near(p->uvs[0][3], 0.0f);
}

static void an_asset_is_the_object_or_else_the_file(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f,
                      obj_import(f, OBJ_TRIANGLE "f 1 2 3\ng lid\nf 1 2 3\no pot\nf 1 2 3\n"
                                                 "g handle\nf 1 2 3\no m\xc3\xa4"
                                                 "dchen\ng hat\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    static const char *const expected[][2] = {{"scene", "scene"},
                                              {"lid", "scene"},
                                              {"pot", "pot"},
                                              {"pot/handle", "pot"},
                                              {"m\xc3\xa4"
                                               "dchen/hat",
                                               "m\xc3\xa4"
                                               "dchen"}};
    assert_int_equal(f->scene->instance_count, 5);
    for (size_t i = 0; i < 5; ++i) {
        assert_string_equal(f->scene->instances[i].name, expected[i][0]);
        assert_string_equal(f->scene->instances[i].asset, expected[i][1]);
    }
}

static void a_node_has_one_primitive_per_material(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/scene.mtl", "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
    assert_obj_status(f,
                      obj_import(f, "mtllib scene.mtl\n" OBJ_SQUARE "usemtl a\nf 1 2 3\n"
                                    "usemtl b\nf 1 3 4\nusemtl a\nf 2 3 4\no second\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->mesh_count, 2);
    const ppmi_mesh *mesh = &f->scene->meshes[0];
    assert_int_equal(mesh->primitive_count, 2);
    assert_int_equal(mesh->primitives[0].triangle_count, 2);
    assert_int_equal(mesh->primitives[1].triangle_count, 1);
    assert_int_equal(mesh->primitives[0].vertex_count, 4);
    assert_string_equal(f->scene->materials[mesh->primitives[0].material].name, "a");
    assert_string_equal(f->scene->materials[mesh->primitives[1].material].name, "b");
    assert_int_equal(f->scene->meshes[1].primitives[0].material, mesh->primitives[0].material);
    assert_int_equal(f->scene->material_count, 2);
}

static void a_concave_face_keeps_its_shape_and_winding(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, "v 0 0 0\nv 0 2 2\nv 0 0 1\nv 0 -2 2\nf 1 2 3 4\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    float area = 0.0f;
    assert_int_equal(p->triangle_count, 2);
    for (uint32_t i = 0; i < 2; ++i) {
        const float *a = p->positions + 3 * p->indices[3 * i];
        const float *b = p->positions + 3 * p->indices[3 * i + 1];
        const float *c = p->positions + 3 * p->indices[3 * i + 2];
        const float x = (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]);
        assert_true(x > 0.0f);
        area += 0.5f * x;
    }
    assert_obj_near(area, 2.0f);
}

static void coordinates_are_metres_with_y_up(void **state)
{
    obj_fixture *f = *state;
    ppm_scene_info info = {.size = sizeof info};
    assert_obj_status(f, obj_import(f, "v 0 0 0\nv 1 2 0\nv 0 0 3\nf 1 2 3\n"), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_get_info(f->scene, &info), PPM_STATUS_OK);
    assert_obj_near(info.bounds_max[0], 1.0f);
    assert_obj_near(info.bounds_max[1], 2.0f);
    assert_obj_near(info.bounds_max[2], 3.0f);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, obj_setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_square_shares_its_vertices),
        TEST(texture_coordinates_point_down),
        TEST(corners_without_texture_coordinates_have_zero_beside_others),
        TEST(an_asset_is_the_object_or_else_the_file),
        TEST(a_node_has_one_primitive_per_material),
        TEST(a_concave_face_keeps_its_shape_and_winding),
        TEST(coordinates_are_metres_with_y_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
