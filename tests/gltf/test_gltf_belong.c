/* importers/gltf/gltf_belong.c: assets and light groups of nodes. */
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_asset.h"
#include "gltf/gltf_belong.h"
#include "gltf_fixture.h"

/* ---- assets ---------------------------------------------------------------------------------- */

static void an_asset_is_the_topmost_name_above_a_mesh(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f,
                                   "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,4]}],'nodes':["
                                   "{'children':[1]},"
                                   "{'name':'car','children':[2],'mesh':0},"
                                   "{'name':'axle','children':[3],'mesh':0},"
                                   "{'name':'wheel','mesh':0},"
                                   "{'name':'tree','mesh':0}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_OK);
    static const char *const expected[][2] = {
        {"car", "car"}, {"axle", "car"}, {"wheel", "car"}, {"tree", "tree"}};
    assert_int_equal(f->scene->instance_count, 4);
    for (size_t i = 0; i < 4; ++i) {
        assert_string_equal(f->scene->instances[i].name, expected[i][0]);
        assert_string_equal(f->scene->instances[i].asset, expected[i][1]);
    }
}

/* Nodes that may move are added at rest first. */
static void an_asset_is_that_of_moving_nodes_too(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'nodes':[{'name':'car','children':[1]},"
                       "{'name':'wheel','mesh':0}],"
                       "'animations':[{'samplers':[{'input':1,'output':2}],"
                       "'channels':[{'sampler':0,'target':{'node':1,'path':'translation'}}]}],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                       "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                       "{'bufferView':1,'componentType':5126,'count':2,'type':'SCALAR','min':[0],"
                       "'max':[1]},{'bufferView':2,'componentType':5126,'count':2,'type':'VEC3'}],"
                       "'bufferViews':[{'buffer':0,'byteLength':36},"
                       "{'buffer':1,'byteLength':8},{'buffer':1,'byteOffset':8,'byteLength':24}],"
                       "'buffers':[{'byteLength':36,'uri':'data:;base64,"
                       "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'},"
                       "{'byteLength':32,'uri':'data:;base64,"
                       "AAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAA='}]}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->instance_count, 1);
    assert_string_equal(f->scene->instances[0].asset, "car");
}

/* ---- light groups ---------------------------------------------------------------------------- */

/* The reader of a file after its import, to be closed. */
static ppmi_gltf_asset *open_file(gltf_fixture *f, const char *json, char *path, size_t size)
{
    static const ppm_import_options options = {.size = sizeof options};
    assert_gltf_status(f, gltf_import(f, json), PPM_STATUS_OK);
    gltf_reset(f);
    snprintf(path, size, "%s", gltf_path(f, "sub/scene.gltf"));
    ppmi_gltf_asset *asset = NULL;
    assert_int_equal(ppmi_gltf_asset_open(f->context, path, &options, &asset), PPM_STATUS_OK);
    assert_int_equal(ppmi_gltf_asset_import(asset, f->scene), PPM_STATUS_OK);
    return asset;
}

static void assert_group(const ppmi_gltf_asset *asset, int32_t node, const char *own,
                         const char *expected)
{
    char buffer[PPMI_GLTF_PLACE];
    const char *group =
        ppmi_gltf_light_group(ppmi_gltf_asset_reader(asset), node, own, buffer, sizeof buffer);
    if (!expected) {
        assert_null(group);
    } else {
        assert_non_null(group);
        assert_string_equal(group, expected);
    }
}

static void a_light_group_is_the_nearest_ones(void **state)
{
    gltf_fixture *f = *state;
    char path[256];
    ppmi_gltf_asset *asset =
        open_file(f,
                  "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,3]}],'nodes':["
                  "{'children':[1,2],'extras':{'ppm_light_group':'key'}},"
                  "{'mesh':0},{'mesh':0,'extras':{'ppm_light_group':'rim \xc3\xa4'}},"
                  "{'mesh':0}]," GLTF_TRIANGLE "}",
                  path, sizeof path);
    assert_group(asset, 0, "", "key");
    assert_group(asset, 1, "", "key");
    assert_group(asset, 2, "", "rim \xc3\xa4");
    assert_group(asset, 2, "lamp's own", "lamp's own");
    assert_group(asset, 3, "", NULL);
    assert_group(asset, 3, "lamp's own", "lamp's own");
    ppmi_gltf_asset_close(asset);
}

static void a_lamp_may_say_its_group_itself(void **state)
{
    gltf_fixture *f = *state;
    char path[256];
    ppmi_gltf_asset *asset = open_file(
        f,
        "{" GLTF_HEAD "'extensionsUsed':['KHR_lights_punctual'],"
        "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point',"
        "'extras':{'ppm_light_group':'bulbs'}},{'type':'point'}]}},"
        "'nodes':[{'children':[1],'mesh':0,'extensions':{'KHR_lights_punctual':{'light':0}}},"
        "{'extensions':{'KHR_lights_punctual':{'light':1}}}]," GLTF_TRIANGLE "}",
        path, sizeof path);
    const ppmi_gltf_document *document = ppmi_gltf_asset_reader(asset)->document;
    assert_int_equal(document->light_count, 2);
    assert_string_equal(document->lights[0].lamp.light_group, "bulbs");
    assert_string_equal(document->lights[1].lamp.light_group, "");
    assert_int_equal(f->scene->punctual_count, 2);
    ppmi_gltf_asset_close(asset);
}

/* From the file to what is rendered: lamps and meshes, at rest and under a node that has the group,
 * and the catcher beside them. */
static void groups_and_catchers_come_into_the_scene(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'extensionsUsed':['KHR_lights_punctual'],"
                       "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point',"
                       "'extras':{'ppm_light_group':'bulbs'}},{'type':'point'}]}},"
                       "'nodes':[{'children':[1,2,3],'extras':{'ppm_light_group':'key'}},"
                       "{'extensions':{'KHR_lights_punctual':{'light':0}}},"
                       "{'extensions':{'KHR_lights_punctual':{'light':1}}},"
                       "{'mesh':0,'children':[4]},"
                       "{'mesh':0,'extras':{'ppm_light_group':'rim','ppm_catcher':true}}]"
                       "," GLTF_TRIANGLE "}"),
        PPM_STATUS_OK);
    const ppm_scene *const scene = f->scene;
    assert_int_equal(scene->punctual_count, 2);
    assert_string_equal(scene->punctuals[0].light_group, "bulbs");
    assert_string_equal(scene->punctuals[1].light_group, "key");
    assert_int_equal(scene->instance_count, 2);
    assert_string_equal(scene->instances[0].light_group, "key");
    assert_string_equal(scene->instances[1].light_group, "rim");
    assert_false(scene->instances[0].is_catcher);
    assert_true(scene->instances[1].is_catcher);
    assert_int_equal(ppm_scene_catcher_count(scene), 1);
}

static void what_is_no_catcher_is_none(void **state)
{
    gltf_fixture *f = *state;
    static const char *const extras[] = {"true", "{'ppm_catcher':false}", "{'ppm_catcher':null}",
                                         "{'ppm_catcher':'yes'}", "{'ppm_catcher':[true]}"};
    for (size_t i = 0; i < sizeof extras / sizeof extras[0]; ++i) {
        char json[1024];
        snprintf(json, sizeof json,
                 "{" GLTF_HEAD "'nodes':[{'mesh':0,'extras':%s}]," GLTF_TRIANGLE "}", extras[i]);
        assert_gltf_status(f, gltf_import(f, json), PPM_STATUS_OK);
        assert_int_equal(ppm_scene_catcher_count(f->scene), 0);
        gltf_reset(f);
    }
}

static void what_is_no_name_is_no_group(void **state)
{
    gltf_fixture *f = *state;
    static const char *const extras[] = {"7",
                                         "'key'",
                                         "{'ppm_light_group':7}",
                                         "{'ppm_light_group':['key']}",
                                         "{'ppm_light_group':null}",
                                         "{'ppm_light_group':''}"};
    for (size_t i = 0; i < sizeof extras / sizeof extras[0]; ++i) {
        char path[256], json[1024];
        snprintf(json, sizeof json,
                 "{" GLTF_HEAD "'nodes':[{'mesh':0,'extras':%s}]," GLTF_TRIANGLE "}", extras[i]);
        ppmi_gltf_asset *asset = open_file(f, json, path, sizeof path);
        assert_group(asset, 0, "", NULL);
        ppmi_gltf_asset_close(asset);
        gltf_reset(f);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(an_asset_is_the_topmost_name_above_a_mesh),
        TEST(an_asset_is_that_of_moving_nodes_too),
        TEST(a_light_group_is_the_nearest_ones),
        TEST(a_lamp_may_say_its_group_itself),
        TEST(groups_and_catchers_come_into_the_scene),
        TEST(what_is_no_catcher_is_none),
        TEST(what_is_no_name_is_no_group),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
