/* importers/gltf/gltf_node.c: scenes, hierarchies, transforms, instancing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf_fixture.h"

/* Where instance i puts a point. */
static ppmi_vec3 place(const gltf_fixture *f, uint32_t i, float x, float y, float z)
{
    assert_true(i < f->scene->instance_count);
    return ppmi_transform_point(&f->scene->instances[i].to_world, vec3(x, y, z));
}

static void assert_place(const gltf_fixture *f, uint32_t i, ppmi_vec3 from, ppmi_vec3 to)
{
    const ppmi_vec3 got = place(f, i, from.x, from.y, from.z);
    if (!(vec3_length(vec3_sub(got, to)) < 1e-5f)) {
        fail_msg("instance %u: %g %g %g, expected %g %g %g", i, (double)got.x, (double)got.y,
                 (double)got.z, (double)to.x, (double)to.y, (double)to.z);
    }
}

static void translation_rotation_and_scale_apply_in_that_order(void **state)
{
    gltf_fixture *f = *state;
    /* a quarter turn about +Z takes +X to +Y */
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0,'translation':[10,20,30],"
                                      "'rotation':[0,0,0.7071067811865476,0.7071067811865476],"
                                      "'scale':[2,3,-4]}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_OK);
    assert_place(f, 0, vec3(1, 0, 0), vec3(10, 22, 30));
    assert_place(f, 0, vec3(0, 1, 0), vec3(7, 20, 30));
    assert_place(f, 0, vec3(0, 0, 1), vec3(10, 20, 26));
    assert_true(ppmi_transform_determinant(&f->scene->instances[0].to_world) < 0.0f);
}

static void matrices_are_column_major(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0,'matrix':"
                                      "[0,2,0,0, -3,0,0,0, 0,0,4,0, 5,6,7,1]}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_OK);
    assert_place(f, 0, vec3(1, 0, 0), vec3(5, 8, 7));
    assert_place(f, 0, vec3(0, 1, 0), vec3(2, 6, 7));
    assert_place(f, 0, vec3(0, 0, 1), vec3(5, 6, 11));
}

static void matrices_that_are_not_affine_are_refused(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0,'matrix':"
                                      "[1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "nodes[0].matrix");
}

static void children_are_placed_in_their_parents(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(
            f,
            "{" GLTF_HEAD "'nodes':[{'children':[1,2],'scale':[2,2,2]},"
            "{'mesh':0,'translation':[1,0,0]},"
            "{'translation':[0,1,0],'children':[3]},{'mesh':0,'name':'deep'}]," GLTF_TRIANGLE "}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->mesh_count, 1);
    assert_int_equal(f->scene->instance_count, 2);
    assert_place(f, 0, vec3(0, 0, 0), vec3(2, 0, 0));
    assert_place(f, 1, vec3(1, 0, 0), vec3(2, 2, 0));
    assert_string_equal(f->scene->instances[0].name, "M"); /* the mesh's, for want of its own */
    assert_string_equal(f->scene->instances[1].name, "deep");
}

static void quaternions_need_not_have_unit_length(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0,'rotation':[0,0,5,5],"
                       "'children':[1]},{'mesh':0,'rotation':[0,0,0,0]}]," GLTF_TRIANGLE "}"),
        PPM_STATUS_OK);
    assert_place(f, 0, vec3(1, 0, 0), vec3(0, 1, 0));
    assert_place(f, 1, vec3(1, 0, 0), vec3(0, 1, 0));
}

static void only_the_default_scene_is_read(void **state)
{
    gltf_fixture *f = *state;
#define SCENES                                                                                     \
    "'asset':{'version':'2.0'},'scenes':[{'nodes':[0]},{'nodes':[1]}],"                            \
    "'nodes':[{'mesh':0,'name':'a'},{'mesh':0,'name':'b'},{'mesh':0,'name':'c'}]," GLTF_TRIANGLE
    assert_gltf_status(f, gltf_import(f, "{'scene':1," SCENES "}"), PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 1);
    assert_string_equal(f->scene->instances[0].name, "b");
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "{" SCENES "}"), PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 1);
    assert_string_equal(f->scene->instances[0].name, "a");
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "{'scene':2," SCENES "}"), PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "scene: scenes[2] does not exist");
}

static void without_scenes_all_roots_are_read(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{'asset':{'version':'2.0'},'nodes':[{'mesh':0},"
                                      "{'children':[0]},{'mesh':0}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 2);
}

static void cyclic_hierarchies_are_refused(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'nodes':[{'children':[1]},{'children':[2]},"
                                      "{'children':[1],'mesh':0}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "nodes[2].children[0]: nodes[1] is its own ancestor");
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "{" GLTF_HEAD "'nodes':[{'children':[0]}]}"),
                       PPM_STATUS_INPUT_INVALID);
    gltf_reset(f); /* without a root to start from */
    assert_gltf_status(
        f,
        gltf_import(f, "{'asset':{'version':'2.0'},'nodes':[{'children':[1]},{'children':[0]}]}"),
        PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "cyclic");
}

static void a_node_with_two_parents_is_refused(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'nodes':[{'children':[1,2]},{'children':[3]},"
                                      "{'children':[3]},{'mesh':0}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "nodes[2].children[0]: nodes[3] is reached twice");
}

static void references_to_nodes_and_meshes_are_checked(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import(f, "{" GLTF_HEAD "'nodes':[{'children':[9]}]}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "nodes[0].children[0]: nodes[9] does not exist");
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':9}]}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "nodes[0].mesh: meshes[9] does not exist");
}

static void very_deep_hierarchies_are_walked(void **state)
{
    gltf_fixture *f = *state;
    enum { DEPTH = 100000 };
    char *text = malloc(DEPTH * 32 + 2048);
    assert_non_null(text);
    size_t n = (size_t)sprintf(text, "{" GLTF_HEAD "'nodes':[");
    for (int i = 1; i < DEPTH; ++i) {
        n += (size_t)sprintf(text + n, "{'children':[%d]},", i);
    }
    sprintf(text + n, "{'mesh':0}]," GLTF_TRIANGLE "}");
    assert_gltf_status(f, gltf_import(f, text), PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 1);
    free(text);
}

static void transforms_that_overflow_are_refused(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'nodes':[{'scale':[1e30,1,1],'children':[1]},"
                                      "{'mesh':0,'scale':[1e30,1,1]}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "nodes[1]");
}

static void instancing_repeats_the_mesh(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        float positions[9], translations[6];
        int16_t rotations[8]; /* none; a half turn about +Y */
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 2, 0, 0}, {0, 0, 0, 32767, 0, 32767, 0, 0}};
    assert_gltf_status(
        f,
        gltf_importf(
            f,
            "{" GLTF_HEAD "'extensionsUsed':['EXT_mesh_gpu_instancing'],"
            "'extensionsRequired':['EXT_mesh_gpu_instancing'],"
            "'nodes':[{'mesh':0,'translation':[0,0,5],'extensions':{"
            "'EXT_mesh_gpu_instancing':{'attributes':{'TRANSLATION':1,'ROTATION':2,"
            "'_ID':77}}}}],"
            "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
            "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
            "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':2,'type':'VEC3'},"
            "{'bufferView':0,'byteOffset':60,'componentType':5122,'normalized':true,"
            "'count':2,'type':'VEC4'}],"
            "'bufferViews':[{'buffer':0,'byteLength':76}],"
            "'buffers':[{'byteLength':76,'uri':'%s'}]}",
            gltf_data_uri(&data, sizeof data)),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 2);
    assert_place(f, 0, vec3(1, 0, 0), vec3(2, 0, 5));
    assert_place(f, 1, vec3(1, 0, 0), vec3(1, 0, 5));
}

static void animations_are_reported(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0}],'animations':[{}]," GLTF_TRIANGLE "}"),
        PPM_STATUS_OK);
    assert_gltf_logged(f, 'D', "honoured: animations: 1 animation");
}

static void a_scene_is_chosen_by_name_or_number(void **state)
{
    gltf_fixture *f = *state;
    static const char text[] =
        "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'name':'day','nodes':[0]},"
        "{'name':'night','nodes':[1]}],"
        "'nodes':[{'mesh':0,'name':'a'},{'mesh':0,'name':'b'}]," GLTF_TRIANGLE "}";
    static const char *const choices[] = {"night", "1"};
    f->options.scene = "nihgt";
    assert_gltf_status(f, gltf_import(f, text), PPM_STATUS_INVALID_ARGUMENT);
    assert_gltf_logged(f, 'E',
                       "no scene 'nihgt'; did you mean 'night'?; there are 2: 'day', 'night'");
    gltf_reset(f);
    f->options.scene = "2";
    assert_gltf_status(f, gltf_import(f, text), PPM_STATUS_INVALID_ARGUMENT);
    for (size_t i = 0; i < 2; ++i) {
        gltf_reset(f);
        f->options.scene = choices[i];
        assert_gltf_status(f, gltf_import(f, text), PPM_STATUS_OK);
        assert_int_equal(f->scene->instance_count, 1);
        assert_string_equal(f->scene->instances[0].name, "b");
    }
}

/* KHR_node_visibility hides what hangs on a node and below it, whatever that says itself. */
static void hidden_nodes_show_neither_meshes_nor_lights(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{'asset':{'version':'2.0'},"
                       "'extensionsUsed':['KHR_node_visibility','KHR_lights_punctual'],"
                       "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point'}]}},"
                       "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':1}}],"
                       "'nodes':[{'mesh':0,'name':'seen'},"
                       "{'children':[2],'extensions':{'KHR_node_visibility':{'visible':false}}},"
                       "{'mesh':0,'camera':0,'name':'below','extensions':{"
                       "'KHR_lights_punctual':{'light':0},"
                       "'KHR_node_visibility':{'visible':true}}}]," GLTF_TRIANGLE "}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 1);
    assert_string_equal(f->scene->instances[0].name, "seen");
    assert_int_equal(f->scene->punctual_count, 0);
    assert_int_equal(f->scene->camera_count, 1);
}

/* ---- far from the point 0 -------------------------------------------------------------------- */

/* Children a centimetre apart below a turned root at 6,300 km, where floats are half a metre apart:
 * meshes, the camera and the lamp stand to each other as the file says, and the origin says where.
 */
static void a_far_site_is_as_fine_as_one_at_the_origin(void **state)
{
    gltf_fixture *f = *state;
    double origin[3];
    assert_gltf_status(
        f,
        gltf_import(
            f,
            "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_lights_punctual'],"
            "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point'}]}},"
            "'scenes':[{'nodes':[0]}],'nodes':["
            "{'children':[1,2,3,4],'rotation':[0,0.6,0,0.8],"
            "'translation':[3133805.3125,5447440.5625,-992858.6875]},"
            "{'mesh':0},{'mesh':0,'translation':[0.01,0,0]},"
            "{'camera':0,'translation':[0,0.25,0]},"
            "{'translation':[0,0.5,0],'extensions':{'KHR_lights_punctual':{'light':0}}}],"
            "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':1}}]," GLTF_TRIANGLE
            "}"),
        PPM_STATUS_OK);
    ppm_scene_get_origin(f->scene, origin);
    assert_float_equal(origin[0], 3133805.0, 0.0);
    assert_float_equal(origin[1], 5447441.0, 0.0);
    assert_float_equal(origin[2], -992859.0, 0.0);
    assert_place(f, 0, vec3(0, 0, 0), vec3(0.3125f, -0.4375f, 0.3125f));
    /* turned by 2 acos(0.8) about Y */
    assert_place(f, 1, vec3(0, 0, 0), vec3(0.3125f + 0.0028f, -0.4375f, 0.3125f - 0.0096f));
    const ppmi_vec3 eye = f->scene->cameras[0].origin, lamp = f->scene->punctuals[0].position;
    assert_float_equal((double)eye.y, -0.1875, 1e-7);
    assert_float_equal((double)lamp.y, 0.0625, 1e-7);
    assert_gltf_logged(f, 'I', "which is the point 0 of the scene");
}

/* A second file of the scene counts from the same point, and a near site from its own. */
static void the_origin_is_that_of_the_first_file(void **state)
{
    gltf_fixture *f = *state;
    double origin[3];
    static const char *const format =
        "{" GLTF_HEAD "'nodes':[{'mesh':0,'translation':[%s,0,0]}]," GLTF_TRIANGLE "}";
    assert_gltf_status(f, gltf_importf(f, format, "900"), PPM_STATUS_OK);
    ppm_scene_get_origin(f->scene, origin);
    assert_float_equal(origin[0], 0.0, 0.0);
    assert_gltf_status(f, gltf_importf(f, format, "500000"), PPM_STATUS_OK);
    assert_place(f, 1, vec3(0, 0, 0), vec3(500000, 0, 0));
    gltf_reset(f);
    assert_gltf_status(f, gltf_importf(f, format, "500000"), PPM_STATUS_OK);
    assert_gltf_status(f, gltf_importf(f, format, "900"), PPM_STATUS_OK);
    ppm_scene_get_origin(f->scene, origin);
    assert_float_equal(origin[0], 500000.0, 0.0);
    assert_place(f, 1, vec3(0, 0, 0), vec3(900 - 500000, 0, 0));
    assert_int_equal(ppm_scene_set_origin(f->scene, origin), PPM_STATUS_WRONG_STATE);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(translation_rotation_and_scale_apply_in_that_order),
        TEST(a_far_site_is_as_fine_as_one_at_the_origin),
        TEST(the_origin_is_that_of_the_first_file),
        TEST(matrices_are_column_major),
        TEST(matrices_that_are_not_affine_are_refused),
        TEST(children_are_placed_in_their_parents),
        TEST(quaternions_need_not_have_unit_length),
        TEST(only_the_default_scene_is_read),
        TEST(without_scenes_all_roots_are_read),
        TEST(cyclic_hierarchies_are_refused),
        TEST(a_node_with_two_parents_is_refused),
        TEST(references_to_nodes_and_meshes_are_checked),
        TEST(very_deep_hierarchies_are_walked),
        TEST(transforms_that_overflow_are_refused),
        TEST(instancing_repeats_the_mesh),
        TEST(animations_are_reported),
        TEST(a_scene_is_chosen_by_name_or_number),
        TEST(hidden_nodes_show_neither_meshes_nor_lights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
