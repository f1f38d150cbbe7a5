/* importers/gltf/gltf_accessor.c: matrices, as skins use them */
#include <math.h>
#include <string.h>

#include "gltf/gltf_reader.h"
#include "gltf_fixture.h"

static const ppmi_gltf_format mat4 = {16, 16, 16, false};
static const ppmi_gltf_format mat3 = {9, 9, 9, false};
static const ppmi_gltf_format vec4 = {4, 4, 4, false};

/* A reader with one accessor over one view of bytes, as after the parsing of a file. */
typedef struct one_accessor {
    ppmi_gltf_reader reader;
    ppmi_gltf_document document;
    ppmi_gltf_accessor accessor;
    ppmi_gltf_buffer_view view;
    ppmi_gltf_bytes buffer;
    ppmi_gltf_source source;
    char *broken[1];
} one_accessor;

static void init(one_accessor *o, gltf_fixture *f, int32_t type, uint32_t components,
                 uint32_t columns, size_t count, const void *bytes, size_t byte_count)
{
    *o = (one_accessor){
        .accessor = {.component_type = type,
                     .component_count = components,
                     .column_count = columns,
                     .count = count},
        .view = {.byte_length = byte_count},
        .buffer = {.data = bytes, .count = byte_count},
        .source = {.byte_length = byte_count, .buffer_view = -1},
    };
    o->document.accessor_count = o->document.buffer_view_count = 1;
    o->document.accessors = &o->accessor;
    o->document.buffer_views = &o->view;
    o->reader.context = f->context;
    o->reader.path = "test.gltf";
    o->reader.document = &o->document;
    o->reader.buffers = &o->buffer;
    static const int lists[] = {PPMI_GLTF_ACCESSORS, PPMI_GLTF_BUFFER_VIEWS, PPMI_GLTF_BUFFERS};
    for (size_t i = 0; i < 3; ++i) {
        o->reader.outline.lists[lists[i]] = (ppmi_gltf_list){1, 1, o->broken};
    }
    o->reader.outline.buffers = (ppmi_gltf_sources){1, 1, &o->source};
}

static ppm_status read(one_accessor *o, const ppmi_gltf_format *format, float **values,
                       size_t *count)
{
    return ppmi_gltf_read_floats(&o->reader, 0, "skins[0].inverseBindMatrices", format, values,
                                 count);
}

static void a_matrix_is_no_vector_and_no_smaller_matrix(void **state)
{
    gltf_fixture *f = *state;
    static const float data[16];
    one_accessor o;
    float *values;
    size_t count;
    init(&o, f, PPMI_GLTF_FLOAT, 4, 2, 1, data, sizeof data); /* MAT2 */
    assert_gltf_status(f, read(&o, &vec4, &values, &count), PPM_STATUS_INPUT_INVALID);
    init(&o, f, PPMI_GLTF_FLOAT, 9, 3, 1, data, sizeof data);
    assert_gltf_status(f, read(&o, &mat4, &values, &count), PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "9 components");
}

static void a_matrix_beyond_its_view_is_refused(void **state)
{
    gltf_fixture *f = *state;
    static const uint8_t data[20]; /* without alignment two of nine bytes would fit */
    one_accessor o;
    float *values;
    size_t count;
    init(&o, f, PPMI_GLTF_UNSIGNED_BYTE, 9, 3, 2, data, sizeof data);
    assert_gltf_status(f, read(&o, &mat3, &values, &count), PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "2 elements of 12 bytes");
}

static void matrices_of_floats_are_read_column_by_column(void **state)
{
    gltf_fixture *f = *state;
    float data[32], *values;
    size_t count;
    one_accessor o;
    for (int i = 0; i < 32; ++i) {
        data[i] = (float)i;
    }
    init(&o, f, PPMI_GLTF_FLOAT, 16, 4, 2, data, sizeof data);
    assert_gltf_status(f, read(&o, &mat4, &values, &count), PPM_STATUS_OK);
    assert_int_equal(count, 2);
    assert_memory_equal(values, data, sizeof data);
    ppmi_free(f->context, values);
}

static void columns_begin_at_multiples_of_four_bytes(void **state)
{
    gltf_fixture *f = *state;
    static const uint8_t bytes[12] = {1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99};
    static const uint16_t words[12] = {1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99};
    for (int is_word = 0; is_word < 2; ++is_word) {
        one_accessor o;
        float *values;
        size_t count;
        init(&o, f, is_word ? PPMI_GLTF_UNSIGNED_SHORT : PPMI_GLTF_UNSIGNED_BYTE, 9, 3, 1,
             is_word ? (const void *)words : bytes, is_word ? sizeof words : sizeof bytes);
        assert_gltf_status(f, read(&o, &mat3, &values, &count), PPM_STATUS_OK);
        for (int i = 0; i < 9; ++i) {
            assert_float_equal(values[i], (float)(i + 1), 0.0f);
        }
        ppmi_free(f->context, values);
    }
}

static void matrices_without_a_buffer_view_are_zeros_and_bounded(void **state)
{
    gltf_fixture *f = *state;
    one_accessor o;
    float *values;
    size_t count;
    init(&o, f, PPMI_GLTF_FLOAT, 16, 4, 3, "x", 1);
    o.accessor.buffer_view = -1;
    assert_gltf_status(f, read(&o, &mat4, &values, &count), PPM_STATUS_OK);
    for (int i = 0; i < 48; ++i) {
        assert_float_equal(values[i], 0.0f, 0.0f);
    }
    ppmi_free(f->context, values);
    o.accessor.count = (size_t)1 << 23; /* as vectors they would be allowed */
    assert_gltf_status(f, read(&o, &mat4, &values, &count), PPM_STATUS_INPUT_INVALID);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_matrix_is_no_vector_and_no_smaller_matrix),
        TEST(a_matrix_beyond_its_view_is_refused),
        TEST(matrices_of_floats_are_read_column_by_column),
        TEST(columns_begin_at_multiples_of_four_bytes),
        TEST(matrices_without_a_buffer_view_are_zeros_and_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
