/* Nodes of a setup file: visibility, material, priority; and what is read back of a scene. */
#include <string.h>

#include "setup/setup_fixture.h"

#define RULE(words) "{ \"nodes\": [ { " words " } ] }"

static void what_is_not_there_is_refused(void **state)
{
    setup_fixture *f = *state;
    assert_refused(f, RULE("\"visible\": true"), "nodes[0]: no \"match\"");
    assert_int_equal(setup_apply(f, RULE("\"match\": \"Box\", \"material\": \"Flor\"")),
                     PPM_STATUS_INPUT_INVALID);
    assert_setup_logged(
        f, 'E', "nodes[0].material: there is no material \"Flor\"; did you mean \"Floor\"?");
    assert_int_equal(setup_apply(f, RULE("\"match\": \"Bax\", \"visible\": false")), PPM_STATUS_OK);
    assert_setup_logged(f, 'W', "nodes[0].match: \"Bax\" fits no node");
}

static void unknown_primitives_and_materials_are_refused(void **state)
{
    setup_fixture *f = *state;
    ppm_material_desc desc = {.size = sizeof desc};
    f->scene = setup_make_room(f->context);
    assert_int_equal(ppm_scene_material_count(f->scene), 4);
    assert_int_equal(ppm_scene_get_material(f->scene, 0, &desc), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_get_material(f->scene, 5, &desc), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_instance_mesh(f->scene, 4), 0);
    assert_int_equal(ppm_scene_instance_mesh(f->scene, 3), 2);
    assert_int_equal(ppm_scene_primitive_count(f->scene, 3), 0);
    assert_int_equal(ppm_scene_primitive_count(f->scene, 2), 1);
    assert_int_equal(ppm_scene_primitive_material(f->scene, 2, 1), 0);
    assert_int_equal(ppm_scene_primitive_material(f->scene, 2, 0), 2);
    assert_int_equal(ppm_scene_set_primitive_material(f->scene, 2, 1, 1),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_set_primitive_material(f->scene, 2, 0, 5),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_set_primitive_material(f->scene, 2, 0, 0),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_scene_primitive_material(f->scene, 2, 0), 2);
}

static void materials_are_not_exchanged_during_a_render(void **state)
{
    setup_fixture *f = *state;
    ppm_render *render = NULL;
    const ppm_render_options options = {.size = sizeof options, .width = 4, .height = 4};
    f->scene = setup_make_room(f->context);
    assert_int_equal(ppm_render_create(f->scene, &options, &render), PPM_STATUS_OK);
    ppm_environment_desc assumed = {.size = sizeof assumed};
    assert_int_equal(ppm_scene_get_environment(f->scene, &assumed), PPM_STATUS_OK);
    assert_true(assumed.radiance[0] == 0.0f);
    assert_int_equal(ppm_scene_set_primitive_material(f->scene, 2, 0, 1), PPM_STATUS_WRONG_STATE);
    ppm_render_destroy(render);
}

static void compare(setup_fixture *f, ppm_scene *other)
{
    ppm_camera_id id;
    const ppm_camera_desc desc = {.size = sizeof desc,
                                  .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.8f, 3, 1},
                                  .y_fov_rad = 1.0f};
    assert_int_equal(ppm_scene_add_camera(f->scene, &desc, &id), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_add_camera(other, &desc, &id), PPM_STATUS_OK);
    assert_same_picture(f, other, 1);
}

static void a_hidden_node_is_not_there(void **state)
{
    setup_fixture *f = *state;
    ppm_scene *other = setup_make_room(f->context);
    assert_int_equal(setup_apply(f, RULE("\"match\": \"C*\", \"visible\": false")), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_instance_visible(other, 3, 0), PPM_STATUS_OK);
    compare(f, other);
}

static void a_catcher_is_one_or_not(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(setup_apply(f, RULE("\"match\": \"C*\", \"catcher\": true")), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_catcher_count(f->scene), 1);
    assert_int_equal(setup_apply(f, RULE("\"match\": \"C*\", \"catcher\": false")), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_catcher_count(f->scene), 0);
}

static void a_material_is_that_of_the_mesh(void **state)
{
    setup_fixture *f = *state;
    ppm_scene *other = setup_make_room(f->context);
    assert_int_equal(setup_apply(f, RULE("\"match\": \"Box\", \"material\": \"Lamp\"")),
                     PPM_STATUS_OK);
    assert_setup_logged(f, 'W', "node \"Copy\" shows the same mesh as \"Box\"");
    assert_int_equal(ppm_scene_set_primitive_material(other, 2, 0, 4), PPM_STATUS_OK);
    compare(f, other);
}

static void a_priority_goes_to_a_copy_of_the_material(void **state)
{
    setup_fixture *f = *state;
    ppm_material_desc desc = {.size = sizeof desc};
    assert_int_equal(
        setup_apply(f, "{ \"nodes\": [ { \"match\": [\"Box\", \"Copy\"], \"nested_priority\": 2 }, "
                       "{ \"match\": \"Floor\", \"nested_priority\": 0 } ] }"),
        PPM_STATUS_OK);
    assert_int_equal(ppm_scene_material_count(f->scene), 5);
    assert_int_equal(ppm_scene_primitive_material(f->scene, 2, 0), 5);
    assert_int_equal(ppm_scene_primitive_material(f->scene, 1, 0), 1);
    assert_int_equal(ppm_scene_get_material(f->scene, 5, &desc), PPM_STATUS_OK);
    assert_string_equal(desc.name, "Glass");
    assert_int_equal(desc.nested_priority, 2);
    assert_int_equal(ppm_scene_get_material(f->scene, 2, &desc), PPM_STATUS_OK);
    assert_int_equal(desc.nested_priority, 0);
}

static void visibility_is_put_back_after_a_pose(void **state)
{
    setup_fixture *f = *state;
    assert_int_equal(setup_apply(f, RULE("\"match\": \"Copy\", \"visible\": false")),
                     PPM_STATUS_OK);
    assert_int_equal(ppm_scene_set_instance_visible(f->scene, 3, 1), PPM_STATUS_OK);
    assert_int_equal(ppm_setup_reapply(f->setup, f->scene), PPM_STATUS_OK);
    assert_true(f->scene->instances[2].is_hidden);
    assert_false(f->scene->instances[1].is_hidden);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup_setup, setup_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_is_not_there_is_refused),
        TEST(unknown_primitives_and_materials_are_refused),
        TEST(materials_are_not_exchanged_during_a_render),
        TEST(a_hidden_node_is_not_there),
        TEST(a_catcher_is_one_or_not),
        TEST(a_material_is_that_of_the_mesh),
        TEST(a_priority_goes_to_a_copy_of_the_material),
        TEST(visibility_is_put_back_after_a_pose),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
