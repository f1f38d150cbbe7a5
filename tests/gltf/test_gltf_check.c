/* importers/gltf/gltf_check.c, seen from an import: what is broken, and what that breaks. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf_fixture.h"

static void text_that_is_not_json_is_refused_with_its_place(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import(f, "{'asset':{'version':'2.0'},\n 'nodes':[1 2]}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "line 2, column 13");
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "{'asset':{'version':'2.0'}} x"),
                       PPM_STATUS_INPUT_INVALID);
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "{'asset':{'version':'2.0'}"), PPM_STATUS_INPUT_INVALID);
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "[]"), PPM_STATUS_INPUT_INVALID);
}

static void text_that_is_not_utf8_is_refused(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import(f, "{'asset':{'version':'2.0','generator':'\xff'}}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "not UTF-8");
}

static void a_key_that_occurs_twice_is_refused(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f, gltf_import(f, "{'asset':{'version':'2.0'},'nodes':[{'mesh':0,'m\\u0065sh':1}]}"),
        PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "twice");
}

static void deep_nesting_is_refused(void **state)
{
    gltf_fixture *f = *state;
    enum { DEPTH = 200000 };
    char *text = malloc(2 * DEPTH + 64);
    assert_non_null(text);
    size_t n = (size_t)sprintf(text, "{'asset':{'version':'2.0'},'extras':");
    memset(text + n, '[', DEPTH);
    memset(text + n + DEPTH, ']', DEPTH);
    strcpy(text + n + 2 * DEPTH, "}");
    assert_gltf_status(f, gltf_import(f, text), PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "nested too deeply");
    free(text);
}

static void other_versions_are_named(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import(f, "{'meshes':{},'asset':{'version':'1.0'}}"),
                       PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'E', "glTF 1.0 is not supported");
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "{'asset':{'version':'2.0','minVersion':'2.1'}}"),
                       PPM_STATUS_INPUT_UNSUPPORTED);
    gltf_reset(f);
    assert_gltf_status(f, gltf_import(f, "{'scenes':[]}"), PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "asset: missing");
}

static void a_broken_element_that_nothing_uses_is_no_error(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0},{'matrix':[1]}],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]},{'primitives':7}],"
                       "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                       "{'count':-1}, 5, {'componentType':5126,'count':1,'type':'VEC9'}],"
                       "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':8,'byteLength':1},"
                       "{'buffer':0,'byteLength':36,'byteStride':3}],"
                       "'buffers':[{'byteLength':36,'uri':'data:;base64,"
                       "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'},{'uri':3}],"
                       "'cameras':[{'type':'fisheye'}],'images':[{'uri':1}],'textures':[3],"
                       "'animations':[{'channels':4}],'skins':[{'joints':'x'}]}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 1);
}

static void a_broken_element_in_use_is_an_error_that_names_both_places(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0}],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                       "'accessors':[{'componentType':5126,'count':'3','type':'VEC3'}]}"),
        PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E',
                       "meshes[0].primitives[0].attributes.POSITION: broken: "
                       "accessors[0].count: expected a number");
}

static void a_broken_optional_value_becomes_its_default(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f,
                    "{" GLTF_HEAD "'nodes':[{'mesh':0,'name':5}],"
                    "'materials':[{'pbrMetallicRoughness':{'metallicFactor':'x',"
                    "'roughnessFactor':0.25,'baseColorFactor':[1,1]},'normalTexture':{}}],"
                    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
                    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
                    "'bufferViews':[{'buffer':0,'byteLength':36}],"
                    "'buffers':[{'byteLength':36,'uri':'data:;base64,"
                    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}"),
        PPM_STATUS_OK);
    assert_gltf_logged(f, 'W',
                       "materials[0].pbrMetallicRoughness.metallicFactor: expected a number");
    assert_gltf_logged(f, 'W', "materials[0].normalTexture.index: missing");
    assert_float_equal(f->scene->materials[0].desc.metallic, 1.0f, 0.0f);
    assert_float_equal(f->scene->materials[0].desc.roughness, 0.25f, 0.0f);
    assert_float_equal(f->scene->materials[0].desc.base_color[0], 1.0f, 0.0f);
}

static void integers_may_be_written_with_a_point(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0.0}],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0.0},'mode':4.0}]}],"
                       "'accessors':[{'bufferView':0e0,'componentType':5126.0,'count':3.0,"
                       "'type':'VEC3'}],"
                       "'bufferViews':[{'buffer':0,'byteLength':3.6e1}],"
                       "'buffers':[{'byteLength':36,'uri':'data:;base64,"
                       "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->meshes[0].primitives[0].triangle_count, 1);
}

static void numbers_that_overflow_do_no_harm(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'extras':{'big':1e999},"
                                      "'nodes':[{'mesh':0,'extras':[-1e400]}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_OK);
    gltf_reset(f);
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0,'scale':[1e39,1,1]}]," GLTF_TRIANGLE "}"),
        PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "nodes[0].scale: the number is too large");
}

static void large_integers_in_extensions_keep_their_value(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f,
                    "{" GLTF_HEAD "'extensionsUsed':['KHR_materials_emissive_strength'],"
                    "'materials':[{'emissiveFactor':[1,1,1],'extensions':{"
                    "'KHR_materials_emissive_strength':{'emissiveStrength':3000000000}}}],"
                    "'nodes':[{'mesh':0}],"
                    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
                    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
                    "'bufferViews':[{'buffer':0,'byteLength':36}],"
                    "'buffers':[{'byteLength':36,'uri':'data:;base64,"
                    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}"),
        PPM_STATUS_OK);
    assert_float_equal(f->scene->materials[0].desc.emission[0], 3e9f, 1e3f);
}

static void required_extensions_that_are_unknown_are_named(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f, gltf_import(f, "{'asset':{'version':'2.0'},'extensionsRequired':['EXT_of_tomorrow']}"),
        PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'E', "EXT_of_tomorrow");
    gltf_reset(f);
    assert_gltf_status(f,
                       gltf_import(f, "{'asset':{'version':'2.0'},'extensionsRequired':["
                                      "'NV_materials_mdl']}"),
                       PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'E', "the glTF material beside it is shown");
    gltf_reset(f);
    assert_gltf_status(
        f, gltf_import(f, "{'asset':{'version':'2.0'},'extensionsRequired':'KHR_materials_ior'}"),
        PPM_STATUS_INPUT_INVALID);
}

static void used_extensions_that_are_unknown_are_warned_about(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'extensionsUsed':['EXT_a','KHR_materials_ior',"
                                      "'EXT_b'],'nodes':[{'mesh':0}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "EXT_a");
    assert_gltf_logged(f, 'W', "EXT_b");
    assert_false(gltf_logged(f, 'W', "KHR_materials_ior"));
}

static void a_file_without_meshes_says_that_there_is_nothing_to_render(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import(f, "{'asset':{'version':'2.0'}}"), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "nothing to render");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

static void numbers_that_json_does_not_have_are_named(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *json, *message;
    } cases[] = {
        {"{'asset':{'version':'2.0'},\n'nodes':[{'translation':[0,NaN,0]}]}",
         "line 2, column 28: NaN is no number of JSON, in nodes[0].translation"},
        {"{'asset':{'version':'2.0'},\n'nodes':[{'translation':[0,-Infinity,0]}]}",
         "line 2, column 29: Infinity is no number of JSON, in nodes[0].translation"},
        {"{'asset':{'version':'2.0'},'extras':{'a':inf}}",
         "line 1, column 42: Infinity is no number of JSON"},
        {"{'asset':{'version':'2.0'},'extras':[-nan]}",
         "line 1, column 39: NaN is no number of JSON"},
        {"{'asset':{'version':'2.0'},'extras':[na]}", "line 1, column 38: expected a value"},
        {"{'asset':{'version':'2.0'},'extras':[in", "line 1, column 38: expected a value"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_gltf_status(f, gltf_import(f, cases[i].json), PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', cases[i].message);
        gltf_reset(f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(numbers_that_json_does_not_have_are_named),
        TEST(text_that_is_not_json_is_refused_with_its_place),
        TEST(text_that_is_not_utf8_is_refused),
        TEST(a_key_that_occurs_twice_is_refused),
        TEST(deep_nesting_is_refused),
        TEST(other_versions_are_named),
        TEST(a_broken_element_that_nothing_uses_is_no_error),
        TEST(a_broken_element_in_use_is_an_error_that_names_both_places),
        TEST(a_broken_optional_value_becomes_its_default),
        TEST(integers_may_be_written_with_a_point),
        TEST(numbers_that_overflow_do_no_harm),
        TEST(large_integers_in_extensions_keep_their_value),
        TEST(required_extensions_that_are_unknown_are_named),
        TEST(used_extensions_that_are_unknown_are_warned_about),
        TEST(a_file_without_meshes_says_that_there_is_nothing_to_render),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
