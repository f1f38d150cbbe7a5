/* importers/gltf/gltf_variants.c */
#include <string.h>

#include "gltf_fixture.h"

/* Two primitives of three materials; rest is more of a primitive's extension, or "". */
#define FILE_WITH(variants, mappings)                                                              \
    "{" GLTF_HEAD "'extensionsUsed':['KHR_materials_variants'],'extensions':{"                     \
    "'KHR_materials_variants':{'variants':[" variants "]}},'nodes':[{'mesh':0}],"                  \
    "'materials':[{'name':'plain'},{'name':'red'},{'name':'blue'}],"                               \
    "'meshes':[{'primitives':["                                                                    \
    "{'attributes':{'POSITION':0},'material':0,'extensions':{'KHR_materials_variants':{"           \
    "'mappings':[" mappings "]}}},{'attributes':{'POSITION':0},'material':0}]}],"                  \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"                 \
    "'bufferViews':[{'buffer':0,'byteLength':36}],"                                                \
    "'buffers':[{'byteLength':36,'uri':'data:;base64,"                                             \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}"
#define NAMES "{'name':'Midnight'},{'name':'Sunrise'},{'name':'Noon'}"
#define MAPPINGS "{'material':2,'variants':[0,2]},{'material':1,'variants':[1]}"

/* The name of the material of a primitive. */
static const char *material_name(const gltf_fixture *f, uint32_t primitive)
{
    const uint32_t material = f->scene->meshes[0].primitives[primitive].material;
    return f->scene->materials[material].name;
}

static void import_variant(gltf_fixture *f, const char *json, const char *variant)
{
    gltf_reset(f);
    f->options.variant = variant;
    assert_gltf_status(f, gltf_import(f, json), PPM_STATUS_OK);
    assert_int_equal(f->scene->meshes[0].primitive_count, 2);
}

static void a_variant_replaces_the_materials_that_it_maps(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *variant, *material;
    } cases[] = {{NULL, "plain"}, {"Midnight", "blue"}, {"Sunrise", "red"}, {"Noon", "blue"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        import_variant(f, FILE_WITH(NAMES, MAPPINGS), cases[i].variant);
        assert_string_equal(material_name(f, 0), cases[i].material);
        assert_string_equal(material_name(f, 1), "plain"); /* it has no mappings */
    }
}

/* The twin: the same file in which the mapped material stands plainly. */
static void a_variant_equals_its_plain_twin(void **state)
{
    gltf_fixture *f = *state;
    ppm_material_desc variant;
    import_variant(f,
                   "{" GLTF_HEAD "'nodes':[{'mesh':0}],'extensions':{'KHR_materials_variants':{"
                   "'variants':[{'name':'a'}]}},"
                   "'materials':[{},{'pbrMetallicRoughness':{'roughnessFactor':0.5}}],"
                   "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0,"
                   "'extensions':{'KHR_materials_variants':{'mappings':[{'material':1,"
                   "'variants':[0]}]}}},{'attributes':{'POSITION':0},'material':1}]}],"
                   "'accessors':[{'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':1,"
                   "'indices':{'bufferView':0,'componentType':5121},'values':{'bufferView':1}}}],"
                   "'bufferViews':[{'buffer':0,'byteLength':1},{'buffer':0,'byteOffset':4,"
                   "'byteLength':12}],'buffers':[{'byteLength':16,'uri':'data:;base64,"
                   "AQAAAAAAgD8AAAAAAAAAAA=='}]}",
                   "a");
    assert_int_equal(f->scene->meshes[0].primitives[0].material,
                     f->scene->meshes[0].primitives[1].material);
    assert_int_equal(f->scene->material_count, 1);
    variant = f->scene->materials[0].desc;
    assert_true(variant.roughness == 0.5f);
}

static void an_unknown_variant_is_an_error_with_a_suggestion(void **state)
{
    gltf_fixture *f = *state;
    f->options.variant = "midnigth";
    assert_gltf_status(f, gltf_import(f, FILE_WITH(NAMES, MAPPINGS)), PPM_STATUS_INVALID_ARGUMENT);
    assert_gltf_logged(f, 'E',
                       "no variant 'midnigth'; did you mean 'Midnight'?; there are 3: 'Midnight', "
                       "'Sunrise', 'Noon'");
}

static void a_variant_of_a_file_without_any_is_an_error(void **state)
{
    gltf_fixture *f = *state;
    f->options.variant = "x";
    assert_gltf_status(f, gltf_import(f, "{" GLTF_HEAD "'nodes':[{'mesh':0}]," GLTF_TRIANGLE "}"),
                       PPM_STATUS_INVALID_ARGUMENT);
    assert_gltf_logged(f, 'E', "no variant 'x': the file has none");
}

/* A broken name must not move the others up. */
static void broken_names_keep_their_places(void **state)
{
    gltf_fixture *f = *state;
    import_variant(f, FILE_WITH("{},null,{'name':'Noon'}", MAPPINGS), "Noon");
    assert_string_equal(material_name(f, 0), "blue");
}

static void broken_mappings_are_told_and_left_out(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *json, *warning, *material;
    } cases[] = {
        {FILE_WITH(NAMES, "7," MAPPINGS), "mappings[0]: expected an object", "blue"},
        {FILE_WITH(NAMES, "{'material':1,'variants':'x'}," MAPPINGS),
         "mappings[0].variants: expected an array", "blue"},
        {FILE_WITH(NAMES, "{'material':1}," MAPPINGS), "variants: missing", "blue"},
        {FILE_WITH(NAMES, "{'material':9,'variants':[0]}"), "materials[9] does not exist",
         "(glTF default)"},
        {FILE_WITH(NAMES, "{'material':2,'variants':[99]}"), "", "plain"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        import_variant(f, cases[i].json, "Midnight");
        assert_string_equal(material_name(f, 0), cases[i].material);
        if (cases[i].warning[0]) assert_gltf_logged(f, 'W', cases[i].warning);
    }
}

static void the_report_says_which_variant_is_shown(void **state)
{
    gltf_fixture *f = *state;
    import_variant(f, FILE_WITH(NAMES, MAPPINGS), "Noon");
    assert_gltf_logged(f, 'D', "honoured: KHR_materials_variants: 'Noon' is shown");
    import_variant(f, FILE_WITH(NAMES, MAPPINGS), NULL);
    assert_gltf_logged(f, 'D',
                       "honoured: KHR_materials_variants: the plain materials are shown; "
                       "--variant chooses one of 3: 'Midnight', 'Sunrise', 'Noon'");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(an_unknown_variant_is_an_error_with_a_suggestion),
        TEST(a_variant_of_a_file_without_any_is_an_error),
        TEST(broken_names_keep_their_places),
        TEST(broken_mappings_are_told_and_left_out),
        TEST(a_variant_replaces_the_materials_that_it_maps),
        TEST(a_variant_equals_its_plain_twin),
        TEST(the_report_says_which_variant_is_shown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
