/* importers/gltf/gltf_list.c, by the public calls. */
#include "gltf/gltf_fixture.h"

#include <stdio.h>
#include <string.h>

#include "ppm/asset.h"

/* Writes JSON, in which ' stands for ", and opens it. */
static ppm_asset *open_text(gltf_fixture *f, const char *json)
{
    char text[8192];
    ppm_asset *asset = NULL;
    const size_t length = strlen(json);
    assert_true(length < sizeof text);
    for (size_t i = 0; i <= length; ++i) {
        text[i] = json[i] == '\'' ? '"' : json[i];
    }
    gltf_write(f, "list.gltf", text, length);
    assert_gltf_status(f,
                       ppm_asset_open(f->context, gltf_path(f, "list.gltf"), &f->options, &asset),
                       PPM_STATUS_OK);
    return asset;
}

static ppm_asset_item item_at(const ppm_asset *asset, int32_t kind, uint32_t index)
{
    ppm_asset_item item = {.size = sizeof item};
    assert_int_equal(ppm_asset_get_item(asset, kind, index, &item), PPM_STATUS_OK);
    return item;
}

static void assert_item(const ppm_asset *asset, int32_t kind, uint32_t index, const char *name,
                        const char *detail)
{
    const ppm_asset_item item = item_at(asset, kind, index);
    assert_string_equal(item.name, name);
    assert_string_equal(item.detail, detail);
}

/* Two scenes: in the second, the deeper camera comes first. */
#define SCENES                                                                                     \
    "{'asset':{'version':'2.0','generator':'by hand'},'scene':0,"                                  \
    "'scenes':[{'name':'day','nodes':[0]},{'name':'night','nodes':[1,3]}],"                        \
    "'nodes':[{'name':'A','camera':0},{'name':'B','children':[2]},{'name':'C','camera':1},"        \
    "{'name':'D','camera':0,'extensions':{'KHR_lights_punctual':{'light':0}}}],"                   \
    "'cameras':[{'type':'perspective','perspective':{'yfov':1.5707963,'znear':1}},"                \
    "{'name':'flat','type':'orthographic','orthographic':{'xmag':2,'ymag':-1,'znear':0,'zfar':9}}" \
    "],"                                                                                           \
    "'extensionsUsed':['KHR_lights_punctual','KHR_materials_variants'],"                           \
    "'extensions':{'KHR_lights_punctual':{'lights':[{'name':'L','type':'spot','intensity':1366,"   \
    "'spot':{'outerConeAngle':0.7853982}}]},"                                                      \
    "'KHR_materials_variants':{'variants':[{'name':'red'},{'name':'blue'}]}}}"

static void bad_arguments_are_refused(void **state)
{
    gltf_fixture *f = *state;
    ppm_asset *asset = open_text(f, SCENES);
    ppm_asset_item item = {.size = sizeof item}, small = {.size = 4};
    ppm_asset_feature feature = {.size = sizeof feature}, small_feature = {.size = 4};
    assert_int_equal(ppm_asset_count(NULL, PPM_ASSET_NODES), 0);
    assert_int_equal(ppm_asset_count(asset, -1), 0);
    assert_int_equal(ppm_asset_count(asset, PPM_ASSET_KINDS), 0);
    assert_int_equal(ppm_asset_get_item(NULL, 0, 0, &item), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_get_item(asset, 0, 0, NULL), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_get_item(asset, 0, 0, &small), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_get_item(asset, -1, 0, &item), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_get_item(asset, PPM_ASSET_NODES, 4, &item),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_feature_count(NULL), 0);
    assert_int_equal(ppm_asset_get_feature(asset, 0, NULL), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_get_feature(asset, 0, &small_feature), PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_asset_get_feature(asset, 999, &feature), PPM_STATUS_INVALID_ARGUMENT);
    assert_string_equal(ppm_asset_generator(NULL), "");
    assert_string_equal(ppm_asset_light_units(NULL), "");
    ppm_asset_close(asset);
}

static void every_kind_is_described(void **state)
{
    gltf_fixture *f = *state;
    ppm_asset *asset = open_text(f, SCENES);
    assert_string_equal(ppm_asset_generator(asset), "by hand");
    assert_item(asset, PPM_ASSET_SCENES, 0, "day", "1 root node, the file's default");
    assert_item(asset, PPM_ASSET_SCENES, 1, "night", "2 root nodes");
    assert_item(asset, PPM_ASSET_CAMERAS, 0, "A", "perspective, 90.0 degrees high");
    assert_item(asset, PPM_ASSET_NODES, 1, "B", "1 child");
    assert_item(asset, PPM_ASSET_NODES, 2, "C", "camera 'flat', below 'B'");
    assert_item(asset, PPM_ASSET_NODES, 3, "D", "camera 1, light 'L'");
    assert_item(asset, PPM_ASSET_VARIANTS, 1, "blue", "");
    assert_int_equal(ppm_asset_count(asset, PPM_ASSET_CAMERAS), 1);
    assert_int_equal(ppm_asset_count(asset, PPM_ASSET_LIGHTS), 0);
    assert_string_equal(ppm_asset_light_units(asset), ""); /* no light in this scene */
    ppm_asset_close(asset);
}

/* --camera N is the N-th of the list. */
static void cameras_are_in_the_order_of_the_import(void **state)
{
    gltf_fixture *f = *state;
    static const char *const names[] = {"flat", "D"};
    f->options.scene = "night";
    ppm_asset *asset = open_text(f, SCENES);
    assert_gltf_status(f, ppm_asset_import(asset, f->scene), PPM_STATUS_OK);
    assert_int_equal(ppm_asset_count(asset, PPM_ASSET_CAMERAS), 2);
    assert_int_equal(ppm_scene_camera_count(f->scene), 2);
    for (uint32_t i = 0; i < 2; ++i) {
        assert_string_equal(item_at(asset, PPM_ASSET_CAMERAS, i).name, names[i]);
        assert_string_equal(ppm_scene_camera_name(f->scene, i + 1), names[i]);
    }
    assert_item(asset, PPM_ASSET_CAMERAS, 0, "flat", "orthographic, 4 x 2 m");
    ppm_asset_close(asset);
}

static void lights_are_listed_in_the_units_that_they_are_read_in(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        int32_t units;
        const char *light, *phrase;
    } cases[] = {
        {PPM_LIGHT_UNITS_AUTO, "spot, 1366 cd, 90.0 degrees wide", "candela and lux as written"},
        {PPM_LIGHT_UNITS_BLENDER, "spot, 2 cd, 90.0 degrees wide", "683 lm/W"},
        {PPM_LIGHT_UNITS_RAW, "spot, 108.7 cd, 90.0 degrees wide", "watts"}};
    f->options.scene = "1"; /* the second: numbers count from 0 here */
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        f->options.light_units = cases[i].units;
        ppm_asset *asset = open_text(f, SCENES);
        assert_item(asset, PPM_ASSET_LIGHTS, 0, "L", cases[i].light);
        assert_non_null(strstr(ppm_asset_light_units(asset), cases[i].phrase));
        ppm_asset_close(asset);
    }
}

static void area_lights_are_listed_too(void **state)
{
    gltf_fixture *f = *state;
    ppm_asset *asset = open_text(
        f, "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0,1]}],'nodes':["
           "{'name':'A','extensions':{'EXT_lights_area':{'light':0}}},"
           "{'name':'B','extras':{'ppm_area':{'shape':'rect','size':[2,0.5],'radiance':1}}}],"
           "'extensionsUsed':['EXT_lights_area'],'extensions':{'EXT_lights_area':{'lights':["
           "{'name':'L','type':'disk','intensity':3,'size':1}]}}}");
    assert_item(asset, PPM_ASSET_LIGHTS, 0, "L", "area, disk, 3 nit");
    assert_item(asset, PPM_ASSET_LIGHTS, 1, "B", "area, rect, 2 x 0.5 m");
    ppm_asset_close(asset);
}

/* The import refuses such files; the list must come to an end before that. */
static void hierarchies_that_are_none_are_listed_all_the_same(void **state)
{
    gltf_fixture *f = *state;
    static const char *const nodes[] = {
        "{'children':[0]}", "{'children':[1]},{'children':[0]}",
        "{'children':[1,1,1,99,-1]},{'children':[2,2]},{'children':[0]}",
        "{'children':[1,2]},{'children':[3]},{'children':[3]},{'camera':7,'mesh':7,'skin':7}"};
    for (size_t i = 0; i < sizeof nodes / sizeof nodes[0]; ++i) {
        char text[512];
        snprintf(text, sizeof text,
                 "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,0,77]}],'nodes':[%s]}",
                 nodes[i]);
        ppm_asset *asset = open_text(f, text);
        assert_true(ppm_asset_count(asset, PPM_ASSET_NODES) > 0);
        assert_int_equal(ppm_asset_count(asset, PPM_ASSET_CAMERAS), 0);
        ppm_asset_close(asset);
    }
}

/* So that numbers stay those of the file. */
static void what_is_broken_keeps_its_place(void **state)
{
    gltf_fixture *f = *state;
    ppm_asset *asset = open_text(f, "{'asset':{'version':'2.0'},'materials':[{'name':7},"
                                    "{'name':'B','emissiveFactor':'red'},{'name':'C'}]}");
    const uint32_t count = ppm_asset_count(asset, PPM_ASSET_MATERIALS);
    assert_int_equal(count, 3);
    assert_string_equal(item_at(asset, PPM_ASSET_MATERIALS, 2).name, "C");
    ppm_asset_close(asset);
}

static void every_allocation_of_an_opening_may_fail(void **state)
{
    gltf_fixture *f = *state;
    ppm_asset_close(open_text(f, SCENES));
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    ppm_asset *asset = NULL;
    size_t n = 0;
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        ppmi_alloc_fail_at(f->context, ++n);
        status = ppm_asset_open(f->context, gltf_path(f, "list.gltf"), &f->options, &asset);
        ppmi_alloc_fail_at(f->context, 0);
        assert_true(n < 1000);
    }
    assert_gltf_status(f, status, PPM_STATUS_OK);
    assert_true(n > 30); /* some for each name and phrase */
    assert_int_equal(ppm_asset_count(asset, PPM_ASSET_VARIANTS), 2);
    ppm_asset_close(asset);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(bad_arguments_are_refused),
        TEST(every_kind_is_described),
        TEST(cameras_are_in_the_order_of_the_import),
        TEST(lights_are_listed_in_the_units_that_they_are_read_in),
        TEST(area_lights_are_listed_too),
        TEST(hierarchies_that_are_none_are_listed_all_the_same),
        TEST(what_is_broken_keeps_its_place),
        TEST(every_allocation_of_an_opening_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
