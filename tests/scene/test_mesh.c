/* Meshes and instances: what is refused, what is left out, what is kept. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/scenes.h"

static test_scene test;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static const float corner_positions[12] = {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f,
                                           0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f};
static const uint32_t corner_indices[9] = {0, 1, 2, 0, 2, 3, 0, 3, 1};

static ppm_primitive_desc corner(void)
{
    return (ppm_primitive_desc){.vertex_count = 4,
                                .triangle_count = 3,
                                .positions = corner_positions,
                                .indices = corner_indices};
}

static ppm_status add(const ppm_primitive_desc *primitives, uint32_t count, ppm_mesh_id *id)
{
    const ppm_mesh_desc desc = {
        .size = sizeof desc, .primitive_count = count, .primitives = primitives};
    return ppm_scene_add_mesh(test.scene, &desc, id);
}

static void assert_refused(const ppm_primitive_desc *primitive)
{
    ppm_mesh_id id = 77;
    assert_int_equal(add(primitive, 1, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(id, 77);
}

static const ppmi_primitive *kept(ppm_mesh_id id)
{
    return &test.scene->meshes[id - 1].primitives[0];
}

static void missing_arguments_are_refused(void **state)
{
    (void)state;
    ppm_mesh_id id;
    const ppm_mesh_desc too_small = {.size = 4};
    const ppm_mesh_desc no_primitives = {.size = sizeof no_primitives, .primitive_count = 1};
    assert_int_equal(ppm_scene_add_mesh(NULL, &no_primitives, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_add_mesh(test.scene, NULL, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_add_mesh(test.scene, &too_small, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_add_mesh(test.scene, &no_primitives, &id),
                     PPM_STATUS_INVALID_ARGUMENT);
    ppm_primitive_desc primitive = corner();
    primitive.positions = NULL;
    assert_refused(&primitive);
    primitive = corner();
    primitive.indices = NULL;
    assert_refused(&primitive);
}

static void an_index_out_of_range_is_refused(void **state)
{
    (void)state;
    const uint32_t bad_values[] = {4, UINT32_MAX, UINT32_MAX / 3};
    for (size_t i = 0; i < 3; i++) {
        for (size_t place = 0; place < 9; place++) {
            uint32_t indices[9];
            memcpy(indices, corner_indices, sizeof indices);
            indices[place] = bad_values[i];
            ppm_primitive_desc primitive = corner();
            primitive.indices = indices;
            assert_refused(&primitive);
        }
    }
    ppm_primitive_desc none = corner();
    none.vertex_count = 0;
    assert_refused(&none);
}

static void an_unknown_material_is_refused(void **state)
{
    (void)state;
    ppm_primitive_desc primitive = corner();
    primitive.material = 1;
    assert_refused(&primitive);
    primitive.material = UINT32_MAX;
    assert_refused(&primitive);
}

static void an_unknown_material_is_refused_beside_the_default_one(void **state)
{
    (void)state;
    ppm_primitive_desc primitives[2] = {corner(), corner()};
    primitives[1].material = 1;
    ppm_mesh_id id = 77;
    assert_int_equal(add(primitives, 2, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(id, 77);
}

static void the_default_material_is_grey_whatever_others_are_called(void **state)
{
    (void)state;
    ppm_material_desc red;
    ppm_material_desc_init(&red);
    red.name = "(default)";
    red.base_color[1] = red.base_color[2] = 0.0f;
    material_add(test.scene, &red);
    const ppm_primitive_desc primitive = corner();
    ppm_mesh_id id;
    assert_int_equal(add(&primitive, 1, &id), PPM_STATUS_OK);
    const float *color = test.scene->materials[kept(id)->material].desc.base_color;
    assert_true(color[0] == color[1] && color[1] == color[2]);
}

static void positions_that_are_not_finite_drop_their_triangles(void **state)
{
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY, 1e30f};
    for (size_t b = 0; b < 4; b++) {
        for (size_t axis = 0; axis < 3; axis++) {
            float positions[12];
            memcpy(positions, corner_positions, sizeof positions);
            positions[3 + axis] = bad[b]; /* vertex 1: in the first and the last triangle */
            ppm_primitive_desc primitive = corner();
            primitive.positions = positions;
            const uint32_t warnings = test.warnings;
            ppm_mesh_id id;
            assert_int_equal(add(&primitive, 1, &id), PPM_STATUS_OK);
            assert_int_equal(kept(id)->triangle_count, 1);
            assert_int_equal(kept(id)->indices[1], 2);
            assert_int_equal(test.warnings, warnings + 1);
            const ppmi_mesh *mesh = &test.scene->meshes[id - 1];
            assert_near(mesh->bounds_min.x, 0.0, 0.0);
            assert_near(mesh->bounds_max.x, 0.0, 0.0);
            assert_near(mesh->bounds_max.y, 1.0, 0.0);
        }
    }
}

static void triangles_of_no_area_are_dropped(void **state)
{
    (void)state;
    const float positions[15] = {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f,
                                 0.0f, 2.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f};
    /* two equal indices, two equal positions, three on a line, one good */
    const uint32_t indices[12] = {0, 0, 1, 0, 1, 4, 0, 1, 3, 0, 1, 2};
    const ppm_primitive_desc primitive = {
        .vertex_count = 5, .triangle_count = 4, .positions = positions, .indices = indices};
    ppm_mesh_id id;
    assert_int_equal(add(&primitive, 1, &id), PPM_STATUS_OK);
    assert_int_equal(kept(id)->triangle_count, 1);
    assert_int_equal(kept(id)->indices[2], 2);
    assert_near(test.scene->meshes[id - 1].bounds_max.x, 1.0, 0.0);
}

static void tiny_triangles_are_kept(void **state)
{
    (void)state;
    float positions[12];
    for (int i = 0; i < 12; i++)
        positions[i] = corner_positions[i] * 1e-9f;
    ppm_primitive_desc primitive = corner();
    primitive.positions = positions;
    ppm_mesh_id id;
    assert_int_equal(add(&primitive, 1, &id), PPM_STATUS_OK);
    assert_int_equal(kept(id)->triangle_count, 3);
}

static void normals_without_direction_become_the_faces(void **state)
{
    (void)state;
    const float normals[12] = {0.0f, 0.0f,     0.0f, NAN,  0.0f, 1.0f,
                               0.0f, INFINITY, 0.0f, 0.0f, 3.0f, 4.0f};
    ppm_primitive_desc primitive = corner();
    primitive.normals = normals;
    ppm_mesh_id id;
    assert_int_equal(add(&primitive, 1, &id), PPM_STATUS_OK);
    assert_int_equal(test.warnings, 1);
    for (int i = 0; i < 9; i++)
        assert_near(kept(id)->normals[i], 0.0, 0.0);
    assert_near(kept(id)->normals[10], 0.6, 1e-6);
    assert_near(kept(id)->normals[11], 0.8, 1e-6);
}

static void attributes_that_are_not_finite_are_replaced(void **state)
{
    (void)state;
    const float uvs[8] = {NAN, 0.5f, INFINITY, 0.5f, 0.0f, 0.0f, 0.0f, 0.0f};
    const float colors[16] = {NAN, 0.5f, 0.5f, -INFINITY};
    ppm_primitive_desc primitive = corner();
    primitive.uvs[7] = uvs;
    primitive.colors = colors;
    ppm_mesh_id id;
    assert_int_equal(add(&primitive, 1, &id), PPM_STATUS_OK);
    assert_true(isfinite(kept(id)->uvs[7][0]) && isfinite(kept(id)->uvs[7][2]));
    assert_near(kept(id)->uvs[7][1], 0.5, 0.0);
    assert_true(isfinite(kept(id)->colors[0]) && isfinite(kept(id)->colors[3]));
}

static void empty_meshes_are_fine(void **state)
{
    (void)state;
    const ppm_primitive_desc nothing = {0};
    ppm_mesh_id id = 0;
    assert_int_equal(add(NULL, 0, &id), PPM_STATUS_OK);
    assert_int_equal(add(&nothing, 1, &id), PPM_STATUS_OK);
    shape_place(test.scene, id);
    ppmi_vec3 low, high;
    assert_false(ppmi_scene_bounds(test.scene, &low, &high));
}

static void instances_need_a_mesh_and_a_finite_transform(void **state)
{
    (void)state;
    const ppm_primitive_desc primitive = corner();
    ppm_mesh_id mesh;
    assert_int_equal(add(&primitive, 1, &mesh), PPM_STATUS_OK);
    ppm_instance_desc desc = {.size = sizeof desc, .mesh = mesh};
    for (int i = 0; i < 16; i += 5)
        desc.transform[i] = 1.0f;
    ppm_instance_id id = 77;
    ppm_instance_desc bad = desc;
    bad.mesh = 0;
    assert_int_equal(ppm_scene_add_instance(test.scene, &bad, &id), PPM_STATUS_INVALID_ARGUMENT);
    bad.mesh = mesh + 1;
    assert_int_equal(ppm_scene_add_instance(test.scene, &bad, &id), PPM_STATUS_INVALID_ARGUMENT);
    for (int column = 0; column < 4; column++) {
        for (int row = 0; row < 3; row++) {
            bad = desc;
            bad.transform[4 * column + row] = (column + row) % 2 ? NAN : INFINITY;
            assert_int_equal(ppm_scene_add_instance(test.scene, &bad, &id),
                             PPM_STATUS_INVALID_ARGUMENT);
        }
    }
    assert_int_equal(id, 77);
    assert_int_equal(ppm_scene_add_instance(test.scene, &desc, &id), PPM_STATUS_OK);
    assert_int_equal(id, 1);
}

static void a_transform_that_leaves_no_area_is_left_out_with_a_warning(void **state)
{
    (void)state;
    const ppm_primitive_desc primitive = corner();
    ppm_mesh_id mesh;
    assert_int_equal(add(&primitive, 1, &mesh), PPM_STATUS_OK);
    for (int kept = 0; kept < 3; kept++) {
        ppm_instance_desc desc = {.size = sizeof desc, .mesh = mesh};
        desc.transform[5 * kept] = desc.transform[15] = 1.0f;
        ppm_instance_id id = 77;
        assert_int_equal(ppm_scene_add_instance(test.scene, &desc, &id), PPM_STATUS_OK);
        assert_int_equal(id, 0);
    }
    assert_int_equal(test.scene->instance_count, 0);
    assert_int_equal(test.warnings, 3);
}

/* Arrays that are overwritten as soon as they may be. */
typedef struct given_arrays {
    float positions[12], normals[12], uvs[8], colors[16];
    uint32_t indices[9];
    int calls;
} given_arrays;

static void overwrite(void *user, const void *array)
{
    given_arrays *given = user;
    void *const all[] = {given->positions, given->normals, given->uvs, given->colors,
                         given->indices};
    const size_t sizes[] = {sizeof given->positions, sizeof given->normals, sizeof given->uvs,
                            sizeof given->colors, sizeof given->indices};
    for (int i = 0; i < 5; i++) {
        if (all[i] != array) continue;
        memset(all[i], 0xff, sizes[i]);
        given->calls++;
        return;
    }
    fail_msg("an array that was not given");
}

static void each_array_is_let_go_when_it_has_been_copied(void **state)
{
    (void)state;
    given_arrays given = {.uvs = {0.25f}, .colors = {0.5f}};
    memcpy(given.positions, corner_positions, sizeof corner_positions);
    memcpy(given.indices, corner_indices, sizeof corner_indices);
    for (int i = 0; i < 4; i++)
        given.normals[3 * i + 2] = 1.0f;
    ppm_primitive_desc primitive = corner();
    primitive.positions = given.positions;
    primitive.normals = given.normals;
    primitive.uvs[0] = given.uvs;
    primitive.colors = given.colors;
    primitive.indices = given.indices;
    ppm_mesh_desc desc = {.size = sizeof desc,
                          .primitive_count = 1,
                          .primitives = &primitive,
                          .release = overwrite,
                          .release_user = &given};
    ppm_mesh_id id;
    given.indices[4] = 4; /* refused before anything is copied */
    assert_int_equal(ppm_scene_add_mesh(test.scene, &desc, &id), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(given.calls, 0);
    given.indices[4] = corner_indices[4];
    assert_int_equal(ppm_scene_add_mesh(test.scene, &desc, &id), PPM_STATUS_OK);
    assert_int_equal(given.calls, 5);
    const ppmi_primitive *p = kept(id);
    assert_memory_equal(p->positions, corner_positions, sizeof corner_positions);
    assert_memory_equal(p->indices, corner_indices, sizeof corner_indices);
    assert_float_equal(p->normals[11], 1.0f, 0.0f);
    assert_float_equal(p->uvs[0][0], 0.25f, 0.0f);
    assert_float_equal(p->colors[0], 0.5f, 0.0f);
}

/* A caller that was built before there was a release. */
static void an_older_desc_has_no_release(void **state)
{
    (void)state;
    given_arrays given = {.calls = 0};
    const ppm_primitive_desc primitive = corner();
    const ppm_mesh_desc desc = {.size = offsetof(ppm_mesh_desc, release),
                                .primitive_count = 1,
                                .primitives = &primitive,
                                .release = overwrite,
                                .release_user = &given};
    ppm_mesh_id id;
    assert_int_equal(ppm_scene_add_mesh(test.scene, &desc, &id), PPM_STATUS_OK);
    assert_int_equal(given.calls, 0);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(missing_arguments_are_refused),
        WITH_SCENE(an_index_out_of_range_is_refused),
        WITH_SCENE(an_unknown_material_is_refused),
        WITH_SCENE(an_unknown_material_is_refused_beside_the_default_one),
        WITH_SCENE(the_default_material_is_grey_whatever_others_are_called),
        WITH_SCENE(positions_that_are_not_finite_drop_their_triangles),
        WITH_SCENE(triangles_of_no_area_are_dropped),
        WITH_SCENE(tiny_triangles_are_kept),
        WITH_SCENE(normals_without_direction_become_the_faces),
        WITH_SCENE(attributes_that_are_not_finite_are_replaced),
        WITH_SCENE(empty_meshes_are_fine),
        WITH_SCENE(each_array_is_let_go_when_it_has_been_copied),
        WITH_SCENE(an_older_desc_has_no_release),
        WITH_SCENE(instances_need_a_mesh_and_a_finite_transform),
        WITH_SCENE(a_transform_that_leaves_no_area_is_left_out_with_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
