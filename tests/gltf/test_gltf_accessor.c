/* importers/gltf/gltf_accessor.c, gltf_triangles.c, gltf_compact.c and gltf_mesh.c */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf_fixture.h"

#define POSITION "'attributes':{'POSITION':0}"

static const ppmi_primitive *first(const gltf_fixture *f)
{
    assert_int_equal(f->scene->mesh_count, 1);
    return &f->scene->meshes[0].primitives[0];
}

static void assert_floats(const float *got, const float *expected, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (!(fabsf(got[i] - expected[i]) < 1e-6f)) {
            fail_msg("value %zu is %g, expected %g", i, (double)got[i], (double)expected[i]);
        }
    }
}

/* ---- attributes that nothing uses ------------------------------------------------------------ */

/* Three vertices with an attribute of a wrong type, and a material with more members. */
static ppm_status import_odd(gltf_fixture *f, const char *name, const char *type, int component,
                             const char *material)
{
    return gltf_importf(
        f,
        "{" GLTF_HEAD "'nodes':[{'mesh':0}],'materials':[{'doubleSided':true%s}],"
        "'images':[{'uri':'data:image/png;base64,iVBORw0KGgo='}],'textures':[{'source':0}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':0,'%s':1},'material':0}]}],"
        "'accessors':[{'componentType':5126,'count':3,'type':'VEC3'},"
        "{'componentType':%d,'count':3,'type':'%s'}]}",
        material, name, component, type);
}

static void an_unused_attribute_of_a_wrong_type_is_left_out(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *name, *type;
        int component;
        const char *user, *message;
    } cases[] = {
        {"TEXCOORD_1", "VEC3", 5126, ",'emissiveTexture':{'index':0,'texCoord':1}",
         "attributes.TEXCOORD_1 (accessors[1]): type: 3 components"},
        {"TEXCOORD_0", "VEC2", 5125, ",'emissiveTexture':{'index':0}",
         "attributes.TEXCOORD_0 (accessors[1]): componentType 5125"},
        {"TANGENT", "VEC3", 5126, ",'normalTexture':{'index':0}",
         "attributes.TANGENT (accessors[1]): type: 3 components"},
    };
    for (size_t i = 0; i < 3 * sizeof cases / sizeof cases[0]; ++i) {
        const size_t k = i / 3, way = i % 3; /* 1: strict, 2: something uses it */
        f->options.strict = way == 1;
        assert_gltf_status(f,
                           import_odd(f, cases[k].name, cases[k].type, cases[k].component,
                                      way == 2 ? cases[k].user : ""),
                           way == 0   ? PPM_STATUS_OK
                           : way == 1 ? PPM_STATUS_INPUT_UNSUPPORTED
                                      : PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, way == 2 ? 'E' : 'W', cases[k].message);
        if (way == 0) assert_int_equal(first(f)->vertex_count, 3);
        gltf_reset(f);
    }
}

/* ---- component types ------------------------------------------------------------------------- */

static void positions_of_every_component_type_are_read(void **state)
{
    gltf_fixture *f = *state;
    static const float f32[] = {0, 0, 0, 3, 0, 0, 0, 5, 0};
    static const int8_t i8[] = {0, 0, 0, 127, 0, 0, 0, -127, 0};
    static const uint8_t u8[] = {0, 0, 0, 255, 0, 0, 0, 51, 0};
    static const int16_t i16[] = {0, 0, 0, 32767, 0, 0, 0, -32767, 0};
    static const uint16_t u16[] = {0, 0, 0, 65535, 0, 0, 0, 13107, 0};
    static const struct {
        int type;
        const char *normalized;
        const void *bytes;
        size_t size;
        float expected[9];
    } cases[] = {
        {5126, "false", f32, sizeof f32, {0, 0, 0, 3, 0, 0, 0, 5, 0}},
        {5120, "false", i8, sizeof i8, {0, 0, 0, 127, 0, 0, 0, -127, 0}},
        {5120, "true", i8, sizeof i8, {0, 0, 0, 1, 0, 0, 0, -1, 0}},
        {5121, "false", u8, sizeof u8, {0, 0, 0, 255, 0, 0, 0, 51, 0}},
        {5121, "true", u8, sizeof u8, {0, 0, 0, 1, 0, 0, 0, 0.2f, 0}},
        {5122, "false", i16, sizeof i16, {0, 0, 0, 32767, 0, 0, 0, -32767, 0}},
        {5122, "true", i16, sizeof i16, {0, 0, 0, 1, 0, 0, 0, -1, 0}},
        {5123, "false", u16, sizeof u16, {0, 0, 0, 65535, 0, 0, 0, 13107, 0}},
        {5123, "true", u16, sizeof u16, {0, 0, 0, 1, 0, 0, 0, 0.2f, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char accessor[160], view[80];
        snprintf(accessor, sizeof accessor,
                 "{'bufferView':0,'componentType':%d,'normalized':%s,'count':3,'type':'VEC3'}",
                 cases[i].type, cases[i].normalized);
        snprintf(view, sizeof view, "{'buffer':0,'byteLength':%zu}", cases[i].size);
        assert_gltf_status(
            f, gltf_import_primitive(f, POSITION, accessor, view, cases[i].bytes, cases[i].size),
            PPM_STATUS_OK);
        assert_floats(first(f)->positions, cases[i].expected, 9);
        gltf_reset(f);
    }
}

static void the_lowest_signed_integer_is_minus_one(void **state)
{
    gltf_fixture *f = *state;
    static const int8_t i8[] = {0, 0, 0, -128, 0, 0, 0, 127, 0};
    assert_gltf_status(
        f,
        gltf_import_primitive(f, POSITION,
                              "{'bufferView':0,'componentType':5120,'normalized':true,"
                              "'count':3,'type':'VEC3'}",
                              "{'buffer':0,'byteLength':9}", i8, sizeof i8),
        PPM_STATUS_OK);
    assert_float_equal(first(f)->positions[3], -1.0f, 0.0f);
}

static void indices_of_every_component_type_are_read(void **state)
{
    gltf_fixture *f = *state;
    struct {
        float positions[12];
        uint32_t u32[3];
        uint16_t u16[3];
        uint8_t u8[3];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {3, 2, 0}, {3, 2, 0}, {3, 2, 0}};
    static const int types[] = {5125, 5123, 5121};
    static const int offsets[] = {48, 60, 66};
    for (int i = 0; i < 3; ++i) {
        char accessors[240];
        snprintf(accessors, sizeof accessors,
                 "{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
                 "{'bufferView':0,'byteOffset':%d,'componentType':%d,'count':3,'type':'SCALAR'}",
                 offsets[i], types[i]);
        assert_gltf_status(f,
                           gltf_import_primitive(f, POSITION ",'indices':1", accessors,
                                                 "{'buffer':0,'byteLength':69}", &data, 69),
                           PPM_STATUS_OK);
        /* vertex 1 is not used and dropped: 0 2 3 are 0 1 2 now */
        static const float kept[] = {0, 0, 0, 0, 1, 0, 1, 1, 0};
        static const uint32_t expected[] = {2, 1, 0};
        assert_int_equal(first(f)->vertex_count, 3);
        assert_floats(first(f)->positions, kept, 9);
        assert_memory_equal(first(f)->indices, expected, sizeof expected);
        gltf_reset(f);
    }
}

static void interleaved_attributes_are_read(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        float position[3], normal[3];
        uint16_t uv[2];
        uint8_t color[4];
    } vertices[3] = {{{0, 0, 0}, {0, 0, 1}, {0, 0}, {255, 0, 0, 255}},
                     {{1, 0, 0}, {0, 0, 1}, {65535, 0}, {0, 255, 0, 51}},
                     {{0, 1, 0}, {0, 0, 1}, {0, 13107}, {0, 0, 255, 0}}};
    assert_gltf_status(
        f,
        gltf_import_primitive(
            f, "'attributes':{'POSITION':0,'NORMAL':1,'TEXCOORD_3':2,'COLOR_0':3}",
            "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
            "{'bufferView':0,'byteOffset':12,'componentType':5126,'count':3,'type':'VEC3'},"
            "{'bufferView':0,'byteOffset':24,'componentType':5123,'normalized':true,'count':3,"
            "'type':'VEC2'},"
            "{'bufferView':0,'byteOffset':28,'componentType':5121,'normalized':true,'count':3,"
            "'type':'VEC4'}",
            "{'buffer':0,'byteLength':96,'byteStride':32}", vertices, sizeof vertices),
        PPM_STATUS_OK);
    static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, normals[] = {0, 0, 1, 0, 0, 1};
    static const float uvs[] = {0, 0, 1, 0, 0, 0.2f};
    static const float colors[] = {1, 0, 0, 1, 0, 1, 0, 0.2f, 0, 0, 1, 0};
    assert_floats(first(f)->positions, positions, 9);
    assert_floats(first(f)->normals, normals, 6);
    assert_floats(first(f)->uvs[3], uvs, 6);
    assert_floats(first(f)->colors, colors, 12);
    assert_null(first(f)->uvs[0]);
}

static void colors_of_three_components_are_opaque(void **state)
{
    gltf_fixture *f = *state;
    static const float data[] = {0,   0,   0,   1,   0,   0,   0,   1,   0,
                                 .1f, .2f, .3f, .4f, .5f, .6f, .7f, .8f, .9f};
    assert_gltf_status(
        f,
        gltf_import_primitive(f, "'attributes':{'POSITION':0,'COLOR_0':1}",
                              "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                              "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':3,"
                              "'type':'VEC3'}",
                              "{'buffer':0,'byteLength':72}", data, sizeof data),
        PPM_STATUS_OK);
    static const float expected[] = {.1f, .2f, .3f, 1, .4f, .5f, .6f, 1};
    assert_floats(first(f)->colors, expected, 8);
}

/* Coordinates of every type that the core and KHR_mesh_quantization allow. */
static void coordinates_of_every_component_type_are_read(void **state)
{
    gltf_fixture *f = *state;
    static const int8_t i8[] = {0, 0, 0, 0, -127, 64, 0, 0, 3, 127, 0, 0}; /* stride 4 */
    static const uint8_t u8[] = {0, 0, 0, 0, 255, 51, 0, 0, 3, 128, 0, 0};
    static const int16_t i16[] = {0, 0, -32767, 300, 3, 32767};
    static const uint16_t u16[] = {0, 0, 65535, 13107, 3, 300};
    static const struct {
        int type;
        const char *normalized;
        const void *bytes;
        float expected[6];
    } cases[] = {
        {5120, "false", i8, {0, 0, -127, 64, 3, 127}},
        {5120, "true", i8, {0, 0, -1, 64.0f / 127, 3.0f / 127, 1}},
        {5121, "false", u8, {0, 0, 255, 51, 3, 128}},
        {5121, "true", u8, {0, 0, 1, 0.2f, 3.0f / 255, 128.0f / 255}},
        {5122, "false", i16, {0, 0, -32767, 300, 3, 32767}},
        {5122, "true", i16, {0, 0, -1, 300.0f / 32767, 3.0f / 32767, 1}},
        {5123, "false", u16, {0, 0, 65535, 13107, 3, 300}},
        {5123, "true", u16, {0, 0, 1, 0.2f, 3.0f / 65535, 300.0f / 65535}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        struct {
            float positions[9];
            unsigned char uvs[12];
        } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0}};
        char accessors[320];
        memcpy(data.uvs, cases[i].bytes, sizeof data.uvs);
        snprintf(accessors, sizeof accessors,
                 "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                 "{'bufferView':1,'componentType':%d,'normalized':%s,'count':3,'type':'VEC2'}",
                 cases[i].type, cases[i].normalized);
        assert_gltf_status(
            f,
            gltf_import_primitive(f, "'attributes':{'POSITION':0,'TEXCOORD_7':1}", accessors,
                                  "{'buffer':0,'byteLength':36},"
                                  "{'buffer':0,'byteOffset':36,'byteLength':12,'byteStride':4}",
                                  &data, sizeof data),
            PPM_STATUS_OK);
        assert_floats(first(f)->uvs[7], cases[i].expected, 6);
        gltf_reset(f);
    }
}

static void sets_that_are_not_used_are_told(void **state)
{
    gltf_fixture *f = *state;
    static const float data[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    assert_gltf_status(
        f,
        gltf_import_primitive(f,
                              "'attributes':{'POSITION':0,'COLOR_1':0,'COLOR_0':0,"
                              "'TEXCOORD_8':1,'TEXCOORD_11':1}",
                              "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                              "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC2'}",
                              "{'buffer':0,'byteLength':36}", data, sizeof data),
        PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "ignored: COLOR_1 and further: 1 primitive:");
    assert_gltf_logged(f, 'W', "ignored: TEXCOORD_8 and further: 1 primitive:");
    assert_non_null(first(f)->colors);
}

static void tangents_without_normals_are_ignored(void **state)
{
    gltf_fixture *f = *state;
    static const float data[21] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    assert_gltf_status(
        f,
        gltf_import_primitive(f, "'attributes':{'POSITION':0,'TANGENT':1}",
                              "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                              "{'bufferView':0,'byteOffset':36,'componentType':5126,'count':3,"
                              "'type':'VEC4'}",
                              "{'buffer':0,'byteLength':84}", data, sizeof data),
        PPM_STATUS_OK);
    assert_null(first(f)->tangents);
    assert_null(first(f)->normals);
}

/* ---- sparse ---------------------------------------------------------------------------------- */

#define SPARSE(base, index_type, count)                                                            \
    "{" base "'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':" count ","           \
    "'indices':{'bufferView':1,'componentType':" index_type "},'values':{'bufferView':2}}}"
#define SPARSE_VIEWS                                                                               \
    "{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36,'byteLength':4},"                    \
    "{'buffer':0,'byteOffset':40,'byteLength':24}"

static const struct {
    float base[9];
    uint8_t indices[4];
    float values[6];
} sparse_data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 2, 0, 0}, {7, 0, 0, 0, 9, 0}};

static void sparse_accessors_replace_elements(void **state)
{
    gltf_fixture *f = *state;
    static const float expected[] = {0, 0, 0, 7, 0, 0, 0, 9, 0};
    assert_gltf_status(f,
                       gltf_import_primitive(f, POSITION, SPARSE("'bufferView':0,", "5121", "2"),
                                             SPARSE_VIEWS, &sparse_data, 64),
                       PPM_STATUS_OK);
    assert_floats(first(f)->positions, expected, 9);
}

static void sparse_accessors_without_a_buffer_view_start_from_zeros(void **state)
{
    gltf_fixture *f = *state;
    static const float expected[] = {0, 0, 0, 7, 0, 0, 0, 9, 0};
    assert_gltf_status(
        f,
        gltf_import_primitive(f, POSITION, SPARSE("", "5121", "2"), SPARSE_VIEWS, &sparse_data, 64),
        PPM_STATUS_OK);
    assert_floats(first(f)->positions, expected, 9);
}

static void sparse_faults_are_errors(void **state)
{
    gltf_fixture *f = *state;
    const struct {
        const char *accessor, *message;
    } cases[] = {
        {SPARSE("'bufferView':0,", "5121", "3"), "do not fit in bufferViews[2]"},
        {SPARSE("'bufferView':0,", "5123", "2"), "sparse index 513"}, /* bytes 1 2 as one */
        {SPARSE("'bufferView':0,", "5126", "1"), "sparse.indices.componentType"},
        {SPARSE("'bufferView':0,", "5121", "2000000000"), "do not fit in bufferViews[1]"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_gltf_status(
            f,
            gltf_import_primitive(f, POSITION, cases[i].accessor, SPARSE_VIEWS, &sparse_data, 64),
            PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', cases[i].message);
        gltf_reset(f);
    }
}

/* ---- bounds ---------------------------------------------------------------------------------- */

static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

static void what_does_not_fit_is_refused_with_its_place(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *accessor, *view, *message;
    } cases[] = {
        {"{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'}",
         "{'buffer':0,'byteLength':36}", "do not fit in bufferViews[0]"},
        {"{'bufferView':0,'byteOffset':4,'componentType':5126,'count':3,'type':'VEC3'}",
         "{'buffer':0,'byteLength':36}", "do not fit in bufferViews[0]"},
        {"{'bufferView':0,'componentType':5126,'count':3000000000000000,'type':'VEC3'}",
         "{'buffer':0,'byteLength':36}", "do not fit in bufferViews[0]"},
        {"{'bufferView':0,'byteOffset':9007199254740991,'componentType':5126,'count':3,"
         "'type':'VEC3'}",
         "{'buffer':0,'byteLength':36}", "do not fit in bufferViews[0]"},
        {"{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}",
         "{'buffer':0,'byteLength':37}", "do not fit in 36 of buffers[0]"},
        {"{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}",
         "{'buffer':0,'byteOffset':9007199254740991,'byteLength':36}", "buffers[0]"},
        {"{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}",
         "{'buffer':1,'byteLength':36}", "buffers[1] does not exist"},
        {"{'bufferView':1,'componentType':5126,'count':3,'type':'VEC3'}",
         "{'buffer':0,'byteLength':36}", "bufferViews[1] does not exist"},
        {"{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}",
         "{'buffer':0,'byteLength':36,'byteStride':8}", "byteStride 8"},
        {"{'bufferView':0,'componentType':5126,'count':3,'type':'VEC2'}",
         "{'buffer':0,'byteLength':36}", "2 components"},
        {"{'bufferView':0,'componentType':5126,'count':1,'type':'MAT3'}",
         "{'buffer':0,'byteLength':36}", "9 components"},
        {"{'bufferView':0,'componentType':5125,'count':3,'type':'VEC3'}",
         "{'buffer':0,'byteLength':36}", "componentType 5125"},
        {"{'bufferView':0,'componentType':5126,'count':0,'type':'VEC3'}",
         "{'buffer':0,'byteLength':36}", "accessors[0].count: out of range"},
        {"{'componentType':5126,'count':1000000000,'type':'VEC3'}", "{'buffer':0,'byteLength':36}",
         "without a buffer view are too many"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_gltf_status(f,
                           gltf_import_primitive(f, POSITION, cases[i].accessor, cases[i].view,
                                                 triangle, sizeof triangle),
                           PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', cases[i].message);
        gltf_reset(f);
    }
}

static void an_accessor_that_does_not_exist_is_refused(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import_primitive(f, "'attributes':{'POSITION':7}",
                                             "{'componentType':5126,'count':3,'type':'VEC3'}",
                                             "{'buffer':0,'byteLength':36}", triangle, 36),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E',
                       "meshes[0].primitives[0].attributes.POSITION: accessors[7] does not exist");
}

static void attributes_of_another_length_are_refused(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import_primitive(f, "'attributes':{'POSITION':0,'NORMAL':1}",
                              "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                              "{'bufferView':0,'componentType':5126,'count':2,'type':'VEC3'}",
                              "{'buffer':0,'byteLength':36}", triangle, 36),
        PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "attributes.NORMAL: 2 elements, POSITION has 3");
}

static void an_index_out_of_range_is_refused_with_its_place(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        float positions[9];
        uint8_t indices[4];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 3, 0}};
    assert_gltf_status(
        f,
        gltf_import_primitive(f, POSITION ",'indices':1",
                              "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                              "{'bufferView':0,'byteOffset':36,'componentType':5121,'count':3,"
                              "'type':'SCALAR'}",
                              "{'buffer':0,'byteLength':40}", &data, 40),
        PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "meshes[0].primitives[0].indices: index 2 is 3");
}

static void indices_without_a_buffer_view_are_zeros(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import_primitive(f, POSITION ",'indices':1,'extras':{'indices':0}",
                              "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'},"
                              "{'componentType':5121,'count':3,'type':'SCALAR'}",
                              "{'buffer':0,'byteLength':36}", triangle, 36),
        PPM_STATUS_OK);
    assert_int_equal(first(f)->triangle_count, 0); /* all corners are vertex 0 */
}

static void positions_that_are_not_finite_are_dropped_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    const float data[18] = {0, 0, 0, NAN, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    assert_gltf_status(
        f,
        gltf_import_primitive(f, POSITION,
                              "{'bufferView':0,'componentType':5126,'count':6,'type':'VEC3'}",
                              "{'buffer':0,'byteLength':72}", data, 72),
        PPM_STATUS_OK);
    assert_int_equal(first(f)->triangle_count, 1);
    assert_gltf_logged(f, 'W', "not a finite number");
}

/* ---- modes ----------------------------------------------------------------------------------- */

static const float five[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};

static void import_mode(gltf_fixture *f, int mode)
{
    char primitive[80];
    snprintf(primitive, sizeof primitive, POSITION ",'mode':%d", mode);
    assert_gltf_status(
        f,
        gltf_import_primitive(f, primitive,
                              "{'bufferView':0,'componentType':5126,'count':5,'type':'VEC3'}",
                              "{'buffer':0,'byteLength':60}", five, 60),
        PPM_STATUS_OK);
}

static void strips_keep_their_winding(void **state)
{
    gltf_fixture *f = *state;
    static const uint32_t expected[] = {0, 1, 2, 1, 3, 2, 2, 3, 4};
    import_mode(f, 5);
    assert_int_equal(first(f)->triangle_count, 3);
    assert_memory_equal(first(f)->indices, expected, sizeof expected);
}

static void fans_turn_about_their_first_vertex(void **state)
{
    gltf_fixture *f = *state;
    static const uint32_t expected[] = {1, 2, 0, 2, 3, 0}; /* the third, 3 4 0, follows */
    import_mode(f, 6);
    assert_int_equal(first(f)->triangle_count, 3);
    assert_memory_equal(first(f)->indices, expected, sizeof expected);
}

static void an_incomplete_triangle_is_left_out_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    import_mode(f, 4);
    assert_int_equal(first(f)->triangle_count, 1);
    assert_int_equal(first(f)->vertex_count, 3);
    assert_gltf_logged(f, 'W', "incomplete triangle");
}

/* ---- half and double floats ------------------------------------------------------------------ */

/* The numbers of IEEE 754 binary16 by hand: 1, -2, the largest, the least, 1/3 rounded, 2^-14. */
static void halves_are_read_exactly(void **state)
{
    gltf_fixture *f = *state;
    static const uint16_t halves[] = {0x3c00, 0xc000, 0x7bff, 0x0001, 0x3555,
                                      0x0400, 0x8000, 0x03ff, 0xbc00, 0x4248};
    static const float expected[] = {1.0f,     -2.0f, 65504.0f,   0x1p-24f, 0.333251953125f,
                                     0x1p-14f, -0.0f, 0x3ffp-24f, -1.0f};
    assert_gltf_status(
        f,
        gltf_import_primitive(f, POSITION,
                              "{'bufferView':0,'componentType':5131,'count':3,'type':'VEC3'}",
                              "{'buffer':0,'byteLength':18}", halves, sizeof halves),
        PPM_STATUS_OK);
    assert_memory_equal(first(f)->positions, expected, sizeof expected);
}

static void halves_may_be_sparse(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        uint16_t base[9];
        uint8_t index, pad;
        uint16_t value[3];
    } data = {{0, 0, 0, 0x3c00, 0, 0, 0, 0x3c00, 0}, 2, 0, {0x4000, 0x4200, 0x4400}};
    assert_gltf_status(
        f,
        gltf_import_primitive(f, POSITION,
                              "{'bufferView':0,'componentType':5131,'count':3,'type':'VEC3',"
                              "'sparse':{'count':1,'indices':{'bufferView':1,'componentType':5121},"
                              "'values':{'bufferView':2}}}",
                              "{'buffer':0,'byteLength':18},"
                              "{'buffer':0,'byteOffset':18,'byteLength':1},"
                              "{'buffer':0,'byteOffset':20,'byteLength':6}",
                              &data, sizeof data),
        PPM_STATUS_OK);
    assert_floats(first(f)->positions, (const float[]){0, 0, 0, 1, 0, 0, 2, 3, 4}, 9);
}

static void types_between_are_none(void **state)
{
    gltf_fixture *f = *state;
    static const float zeros[9];
    static const int types[] = {5124, 5127, 5128, 5129, 5132};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; ++i) {
        char accessor[120];
        snprintf(accessor, sizeof accessor,
                 "{'bufferView':0,'componentType':%d,'count':3,'type':'VEC3'}", types[i]);
        assert_gltf_status(f,
                           gltf_import_primitive(f, POSITION, accessor,
                                                 "{'buffer':0,'byteLength':36}", zeros,
                                                 sizeof zeros),
                           PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', "accessors[0].componentType: out of range");
        gltf_reset(f);
    }
}

/* Where vertex v is in the file's coordinates: in single precision these are half a metre apart. */
static void double_place(const gltf_fixture *f, uint32_t v, double out[3])
{
    const ppmi_vec3 at = vec3_load(f->scene->meshes[0].primitives[0].positions + 3 * (size_t)v);
    const ppmi_vec3 p = vec3_add(f->scene->instances[0].to_world.origin, at); /* not turned */
    double origin[3];
    ppm_scene_get_origin(f->scene, origin);
    out[0] = origin[0] + (double)p.x;
    out[1] = origin[1] + (double)p.y;
    out[2] = origin[2] + (double)p.z;
}

/* A triangle on the earth's surface in geocentric coordinates, in the vertices or in the node. */
static void doubles_keep_millimetres_at_the_radius_of_the_earth(void **state)
{
    gltf_fixture *f = *state;
    static const double places[3][3] = {{4202123.0625, 171456.03125, 4780333.765625},
                                        {4202123.5625, 171456.03125, 4780333.765625},
                                        {4202123.0625, 171457.28125, 4780334.015625}};
    static const char *const nodes[] = {
        "'nodes':[{'mesh':0}]", /* moved to the point 0 */
        "'nodes':[{'mesh':0,'translation':[-4202123,-171456,-4780333]}]"};
    for (int way = 0; way < 2; ++way) {
        assert_gltf_status(
            f,
            gltf_importf(
                f,
                "{'asset':{'version':'2.0'},'extensionsUsed':['KHR_accessor_float64'],"
                "'extensionsRequired':['KHR_accessor_float64'],%s,"
                "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
                "'accessors':[{'bufferView':0,'componentType':5130,'count':3,'type':'VEC3'}],"
                "'bufferViews':[{'buffer':0,'byteLength':72}],"
                "'buffers':[{'byteLength':72,'uri':'%s'}]}",
                nodes[way], gltf_data_uri(places, sizeof places)),
            PPM_STATUS_OK);
        const double shift[3] = {4202123, 171456, 4780333};
        for (uint32_t v = 0; v < 3; ++v) {
            double at[3];
            double_place(f, v, at);
            for (int i = 0; i < 3; ++i) {
                const double expected = places[v][i] - (way == 1 ? shift[i] : 0.0);
                if (!(fabs(at[i] - expected) < 1e-4)) {
                    fail_msg("way %d, vertex %u: %.6f, expected %.6f", way, v, at[i], expected);
                }
            }
        }
        gltf_reset(f);
    }
}

/* ---- restarts -------------------------------------------------------------------------------- */

/* Seven vertices on a line bent upwards; the indices are of a size in bytes. */
static ppm_status import_joined(gltf_fixture *f, int mode, size_t size, const uint32_t *indices,
                                size_t count, const char *extension)
{
    static const int types[] = {[1] = 5121, [2] = 5123, [4] = 5125};
    unsigned char data[7 * 12 + 64] = {0};
    for (int v = 0; v < 7; ++v) {
        const float at[3] = {(float)v, (float)(v * v), 0.0f};
        memcpy(data + 12 * v, at, sizeof at);
    }
    for (size_t i = 0; i < count; ++i)
        memcpy(data + 84 + size * i, &indices[i], size);
    return gltf_importf(
        f,
        "{" GLTF_HEAD "'nodes':[{'mesh':0}],%s"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,'mode':%d}]}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':7,'type':'VEC3'},"
        "{'bufferView':1,'componentType':%d,'count':%zu,'type':'SCALAR'}],"
        "'bufferViews':[{'buffer':0,'byteLength':84},{'buffer':0,'byteOffset':84,"
        "'byteLength':%zu}],'buffers':[{'byteLength':%zu,'uri':'%s'}]}",
        extension, mode, types[size], count, count * size, sizeof data,
        gltf_data_uri(data, sizeof data));
}

#define NAMED                                                                                      \
    "'extensionsUsed':['KHR_mesh_primitive_restart'],"                                             \
    "'extensionsRequired':['KHR_mesh_primitive_restart'],"

/* x of each corner in turn: vertices keep their order. */
static void assert_corners(const gltf_fixture *f, const float *expected, size_t count)
{
    const ppmi_primitive *p = first(f);
    for (size_t i = 0; i < count; ++i) {
        const float x = p->positions[3 * p->indices[i]];
        if (x != expected[i])
            fail_msg("corner %zu: %g, expected %g", i, (double)x, (double)expected[i]);
    }
}

static void strips_fans_and_loops_start_anew(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        int mode;
        size_t elements, corners;
        float expected[18];
    } cases[] = {
        /* 0 1 2 3 R 4 5 R R 4 5 6 */
        {5, 3, 9, {0, 1, 2, 1, 3, 2, 4, 5, 6}},
        {6, 3, 9, {1, 2, 0, 2, 3, 0, 5, 6, 4}},
        {3, 6, 12, {0, 1, 1, 2, 2, 3, 4, 5, 4, 5, 5, 6}},
        {2, 9, 18, {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 4, 4, 5, 5, 6, 6, 4}},
    };
    for (size_t size = 1; size <= 4; size *= 2) {
        const uint32_t r = UINT32_MAX >> (32 - 8 * size);
        const uint32_t indices[] = {0, 1, 2, 3, r, 4, 5, r, r, 4, 5, 6};
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
            assert_gltf_status(f, import_joined(f, cases[i].mode, size, indices, 12, NAMED),
                               PPM_STATUS_OK);
            const ppmi_primitive *p = first(f);
            assert_int_equal(cases[i].mode >= 5 ? p->triangle_count : p->element_count,
                             cases[i].elements);
            assert_corners(f, cases[i].expected, cases[i].corners);
            assert_false(gltf_logged(f, 'W', "restart"));
            gltf_reset(f);
        }
    }
}

static void restarts_that_are_not_announced_are_told(void **state)
{
    gltf_fixture *f = *state;
    static const uint32_t indices[] = {0, 1, 2, 255, 3, 4, 5};
    assert_gltf_status(f, import_joined(f, 5, 1, indices, 7, ""), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "meshes[0].primitives[0].indices: 1 indices are 255");
    assert_corners(f, (const float[]){0, 1, 2, 3, 4, 5}, 6);
    gltf_reset(f);
    f->options.strict = 1;
    assert_gltf_status(f, import_joined(f, 5, 1, indices, 7, ""), PPM_STATUS_INPUT_UNSUPPORTED);
    gltf_reset(f);
    f->options.strict = 0;
    /* lists have nothing to start anew */
    assert_gltf_status(f, import_joined(f, 4, 1, indices, 6, NAMED), PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "index 3 is 255");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(halves_are_read_exactly),
        TEST(halves_may_be_sparse),
        TEST(types_between_are_none),
        TEST(doubles_keep_millimetres_at_the_radius_of_the_earth),
        TEST(strips_fans_and_loops_start_anew),
        TEST(restarts_that_are_not_announced_are_told),
        TEST(an_unused_attribute_of_a_wrong_type_is_left_out),
        TEST(positions_of_every_component_type_are_read),
        TEST(the_lowest_signed_integer_is_minus_one),
        TEST(indices_of_every_component_type_are_read),
        TEST(interleaved_attributes_are_read),
        TEST(colors_of_three_components_are_opaque),
        TEST(coordinates_of_every_component_type_are_read),
        TEST(sets_that_are_not_used_are_told),
        TEST(tangents_without_normals_are_ignored),
        TEST(sparse_accessors_replace_elements),
        TEST(sparse_accessors_without_a_buffer_view_start_from_zeros),
        TEST(sparse_faults_are_errors),
        TEST(what_does_not_fit_is_refused_with_its_place),
        TEST(an_accessor_that_does_not_exist_is_refused),
        TEST(attributes_of_another_length_are_refused),
        TEST(an_index_out_of_range_is_refused_with_its_place),
        TEST(indices_without_a_buffer_view_are_zeros),
        TEST(positions_that_are_not_finite_are_dropped_with_a_warning),
        TEST(strips_keep_their_winding),
        TEST(fans_turn_about_their_first_vertex),
        TEST(an_incomplete_triangle_is_left_out_with_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
