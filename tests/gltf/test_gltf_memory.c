/* The importer's ways out when memory ends: the n-th allocation fails, for every n. */
#include <stdio.h>

#include "gltf_fixture.h"

static const char document[] =
    "{'asset':{'version':'2.0'},'nodes':[{'mesh':0,'name':'a','children':[1,2]},"
    "{'camera':0},{'extensions':{'KHR_lights_punctual':{'light':0},'EXT_lights_area':{'light':0},"
    "'EXT_lights_ies':{'light':0}},'extras':{'ppm_area':{'shape':'disk','size':1,'radiance':1}}}],"
    "'scenes':[{'nodes':[0],'extensions':{'EXT_lights_image_based':{'light':0}}}],"
    "'extensionsUsed':['EXT_unknown','KHR_lights_punctual','KHR_materials_variants'],"
    "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':1}},{'type':'x'}],"
    "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point'}]},"
    "'EXT_lights_area':{'lights':[{'type':'disk'},{'type':'x'}]},"
    "'EXT_lights_ies':{'lights':[{'uri':'data:,TILT=NONE%0A1%201%201%202%201%202%202%200%200%200%20"
    "1%201%201%0A0%2090%0A0%0A5%205'}]},"
    "'EXT_lights_image_based':{'lights':[{'irradianceCoefficients':[[1,1,1],[0,0,0],[0,0,0],[0,0,0]"
    ","
    "[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]}]},"
    "'KHR_materials_variants':{'variants':[{'name':'a'},{}]}},"
    "'materials':[{'name':'m','emissiveFactor':'x'},{'extensions':{'KHR_materials_unlit':{}}}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':0},'indices':1,'material':0,"
    "'extensions':{'KHR_materials_variants':{'mappings':[{'material':1,'variants':[0]}]}}}]}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
    "{'componentType':5121,'count':3,'type':'SCALAR','sparse':{'count':2,"
    "'indices':{'bufferView':1,'componentType':5121},'values':{'bufferView':1}}}],"
    "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':1,'byteLength':2}],"
    "'buffers':[{'byteLength':36,'uri':'data:;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'},"
    "{'byteLength':2,'uri':'data:;base64,A\\u0051I='}]}";

static void every_allocation_may_fail(void **state)
{
    gltf_fixture *f = *state;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 0;
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        gltf_reset(f);
        f->options.variant = "a";
        ppmi_alloc_fail_at(f->context, ++n);
        status = gltf_import(f, document);
        ppmi_alloc_fail_at(f->context, 0);
        assert_true(n < 1000);
    }
    assert_gltf_status(f, status, PPM_STATUS_OK);
    assert_true(n > 20);
    assert_int_equal(f->scene->meshes[0].primitives[0].triangle_count, 1);
    assert_int_not_equal(f->scene->materials[0].desc.emission_takes_vertex_color, 0);
    assert_int_equal(f->scene->punctual_count, 4);
    assert_int_equal(f->scene->profile_count, 1);
    assert_true(f->scene->environment.is_set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_allocation_may_fail, gltf_setup, gltf_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
