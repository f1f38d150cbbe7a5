/* importers/gltf/gltf_meshopt.c, gltf_meshopt_v1.c and gltf_decoded.c: meshopt compression. Streams
 * are made by meshoptimizer's encoders, and those of version 1 by the writer below. */
#include <math.h>
#include <meshoptimizer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/gltf_meshopt.h"
#include "gltf_fixture.h"

/* ---- version 1 ------------------------------------------------------------------------------- */

enum { BLOCK = 256, GROUP = 16 };

/* Writes streams of version 1 after appendix A of KHR_meshopt_compression. */
typedef struct writer {
    unsigned char bytes[1 << 16];
    size_t count;
} writer;

static void put(writer *w, unsigned byte)
{
    w->bytes[w->count++] = (unsigned char)byte;
}

static uint32_t zigzag(uint32_t value, unsigned bits)
{
    const uint32_t mask = bits == 32 ? UINT32_MAX : (1u << bits) - 1;
    const bool is_negative = value >> (bits - 1) & 1;
    return (is_negative ? ~(value << 1) : value << 1) & mask;
}

static uint32_t load(const unsigned char *bytes, size_t size)
{
    uint32_t value = 0;
    memcpy(&value, bytes, size);
    return value;
}

/* The delta bytes of a channel's four byte positions. */
static void make_deltas(const unsigned char *now, const unsigned char *before, unsigned channel,
                        unsigned char out[4])
{
    const size_t size = (channel & 15) == 0 ? 1 : (channel & 15) == 1 ? 2 : 4;
    for (size_t k = 0; k < 4; k += size) {
        const uint32_t a = load(now + k, size), b = load(before + k, size);
        uint32_t delta = zigzag(a - b, (unsigned)(8 * size));
        if (size == 4) { /* the inverse of a rotation to the left */
            const unsigned r = channel >> 4;
            delta = a ^ b;
            delta = delta >> r | delta << ((32 - r) & 31);
        }
        memcpy(out + k, &delta, size);
    }
}

static void put_group(writer *w, const unsigned char *deltas, unsigned bits)
{
    const unsigned sentinel = (1u << bits) - 1;
    for (unsigned i = 0; bits == 8 && i < GROUP; ++i) {
        put(w, deltas[i]);
    }
    if (bits == 8 || bits == 0) return;
    for (unsigned at = 0; at < GROUP; at += 8 / bits) {
        unsigned byte = 0;
        for (unsigned k = 0; k < 8 / bits; ++k) {
            const unsigned value = deltas[at + k] < sentinel ? deltas[at + k] : sentinel;
            byte |= value << (bits == 1 ? k : 8 - bits - k * bits);
        }
        put(w, byte);
    }
    for (unsigned i = 0; i < GROUP; ++i) {
        if (deltas[i] >= sentinel) put(w, deltas[i]);
    }
}

/* One byte position of a block; mode is that of all groups under controls 0 and 1. */
static void put_deltas(writer *w, const unsigned char *deltas, size_t count, unsigned control,
                       unsigned mode)
{
    static const unsigned lengths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    const size_t groups = (count + GROUP - 1) / GROUP;
    if (control == 3) {
        for (size_t i = 0; i < count; ++i) {
            put(w, deltas[i]);
        }
    }
    if (control > 1) return;
    for (size_t i = 0; i < (groups + 3) / 4; ++i) {
        put(w, mode * 0x55u);
    }
    for (size_t i = 0; i < groups; ++i) {
        put_group(w, deltas + GROUP * i, lengths[control][mode]);
    }
}

/* values: count elements of stride bytes. channels and controls: one for each channel, the control
 * for all its four bytes. */
static void encode_v1(writer *w, const unsigned char *values, size_t count, size_t stride,
                      const unsigned char *channels, const unsigned char *controls, unsigned mode)
{
    static const unsigned char zeros[256];
    w->count = 0;
    put(w, 0xa1);
    for (size_t begin = 0; begin < count; begin += BLOCK) {
        const size_t now = count - begin < BLOCK ? count - begin : BLOCK;
        for (size_t k = 0; k < stride; k += 4) {
            put(w, controls[k / 4] * 0x55u);
        }
        for (size_t k = 0; k < stride; k += 4) {
            unsigned char deltas[4][BLOCK] = {{0}};
            for (size_t i = 0; i < now; ++i) {
                const unsigned char *element = values + (begin + i) * stride + k;
                unsigned char bytes[4];
                make_deltas(element, begin + i > 0 ? element - stride : zeros, channels[k / 4],
                            bytes);
                for (size_t j = 0; j < 4; ++j) {
                    deltas[j][i] = bytes[j];
                }
            }
            for (size_t j = 0; j < 4; ++j) {
                put_deltas(w, deltas[j], now, controls[k / 4], mode);
            }
        }
    }
    for (size_t i = stride + stride / 4; i < 24; ++i) {
        put(w, 0);
    }
    for (size_t i = 0; i < stride; ++i) { /* the element before the first */
        put(w, 0);
    }
    for (size_t i = 0; i < stride / 4; ++i) {
        put(w, channels[i]);
    }
}

enum { V1_COUNT = 300, V1_STRIDE = 12 };

static void make_values(unsigned char *values)
{
    uint32_t state = 1;
    for (size_t i = 0; i < V1_COUNT * V1_STRIDE; ++i) {
        state = state * 1664525u + 1013904223u;
        /* mostly small steps, some large ones */
        const unsigned step = state >> 28 == 0 ? state >> 20 : state >> 30;
        values[i] = (unsigned char)((i < V1_STRIDE ? 0u : values[i - V1_STRIDE]) + step);
    }
}

static void version_1_of_every_control_and_channel_is_read(void **state)
{
    (void)state;
    static const unsigned char channel_sets[][3] = {
        {0, 1, 2}, {1, 2 | 5 << 4, 0}, {2 | 15 << 4, 0, 1}};
    unsigned char values[V1_COUNT * V1_STRIDE], out[V1_COUNT * V1_STRIDE];
    writer w;
    make_values(values);
    for (size_t set = 0; set < 3; ++set) {
        for (unsigned combination = 0; combination < 3 * 4; ++combination) {
            const unsigned control = combination / 4 == 2 ? 3 : combination / 4;
            const unsigned mode = combination % 4;
            const unsigned char controls[3] = {(unsigned char)control, 3, (unsigned char)control};
            if (control == 0 && mode == 0) continue; /* deltas are not 0 */
            encode_v1(&w, values, V1_COUNT, V1_STRIDE, channel_sets[set], controls, mode);
            memset(out, 0xee, sizeof out);
            assert_true(ppmi_gltf_meshopt_decode_v1(out, V1_COUNT, V1_STRIDE, w.bytes, w.count));
            assert_memory_equal(out, values, sizeof out);
        }
    }
}

static void version_1_without_deltas_repeats_an_element(void **state)
{
    (void)state;
    static const unsigned char channels[1] = {0}, controls[2][1] = {{2}, {0}};
    unsigned char values[4 * 40] = {0}, out[4 * 40];
    writer w;
    for (int i = 0; i < 2; ++i) {
        encode_v1(&w, values, 40, 4, channels, controls[i], 0);
        memset(out, 0xee, sizeof out);
        assert_true(ppmi_gltf_meshopt_decode_v1(out, 40, 4, w.bytes, w.count));
        assert_memory_equal(out, values, sizeof out);
    }
}

static void version_1_that_is_cut_or_too_long_is_broken(void **state)
{
    (void)state;
    static const unsigned char channels[3] = {0, 1, 2}, controls[3] = {1, 0, 3};
    unsigned char values[V1_COUNT * V1_STRIDE], out[V1_COUNT * V1_STRIDE];
    writer w;
    make_values(values);
    encode_v1(&w, values, V1_COUNT, V1_STRIDE, channels, controls, 2);
    for (size_t length = 0; length < w.count; ++length) {
        /* a copy of just that size, so that a sanitizer sees a read behind it */
        unsigned char *cut = malloc(length + (length == 0));
        assert_non_null(cut);
        memcpy(cut, w.bytes, length);
        assert_false(ppmi_gltf_meshopt_decode_v1(out, V1_COUNT, V1_STRIDE, cut, length));
        free(cut);
    }
    assert_false(ppmi_gltf_meshopt_decode_v1(out, V1_COUNT, V1_STRIDE, w.bytes, w.count + 1));
    w.bytes[w.count - 1] = 3; /* a channel mode that does not exist */
    assert_false(ppmi_gltf_meshopt_decode_v1(out, V1_COUNT, V1_STRIDE, w.bytes, w.count));
}

/* ---- filters --------------------------------------------------------------------------------- */

static void colors_are_decoded_to_all_their_bits(void **state)
{
    (void)state;
    /* K = 8: luma, chromas and alpha of red, white at half alpha and black. In YCoCg of integers
     * red 255 0 0 has co 255 / 2, cg -255 / 4 and y 255 / 4, all of them up to rounding. */
    static const unsigned char stored[12] = {
        63, 127, (unsigned char)-64, 0xff, 255, 0, 0, 0xc0, 0, 0, 0, 0x80};
    static const unsigned char expected[12] = {254, 0, 0, 255, 255, 255, 255, 128, 0, 0, 0, 0};
    unsigned char stream[256], padded[64] = {0}, out[12];
    memcpy(padded, stored, sizeof stored);
    const size_t length = meshopt_encodeVertexBuffer(stream, sizeof stream, padded, 3, 4);
    const ppmi_gltf_meshopt view = {.is_given = true,
                                    .byte_length = length,
                                    .byte_stride = 4,
                                    .count = 3,
                                    .mode = "ATTRIBUTES",
                                    .filter = "COLOR"};
    assert_null(ppmi_gltf_meshopt_fault(&view, stream));
    assert_true(ppmi_gltf_meshopt_decode(&view, stream, out));
    for (int i = 0; i < 12; ++i) {
        if (abs(out[i] - expected[i]) > 1) {
            fail_msg("byte %d is %d, expected %d", i, out[i], expected[i]);
        }
    }
}

static void colors_of_few_bits_fill_the_whole_range(void **state)
{
    (void)state;
    /* K = 4 in 16 bits: white is 15; alpha has 3 bits below its mark */
    uint16_t stored[4] = {15, 0, 0, 0xf}, out[4];
    unsigned char stream[256];
    const size_t length = meshopt_encodeVertexBuffer(stream, sizeof stream, stored, 1, 8);
    const ppmi_gltf_meshopt view = {.is_given = true,
                                    .byte_length = length,
                                    .byte_stride = 8,
                                    .count = 1,
                                    .mode = "ATTRIBUTES",
                                    .filter = "COLOR"};
    assert_true(ppmi_gltf_meshopt_decode(&view, stream, (unsigned char *)out));
    for (int k = 0; k < 4; ++k) {
        assert_int_equal(out[k], 65535);
    }
}

/* ---- files ----------------------------------------------------------------------------------- */

enum { VERTICES = 6 };
static const uint16_t positions[VERTICES][4] = {{0, 0, 0, 0},    {100, 0, 0, 0},
                                                {0, 100, 0, 0},  {100, 100, 0, 0},
                                                {0, 200, 50, 0}, {100, 200, 7, 0}};
static const uint16_t triangles[12] = {0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5};

/* A file of compressed positions and indices in buffer 0; buffer 1 is the plain one, of which json
 * is what follows its length. Changes to the extension come in by its text. */
typedef struct file {
    unsigned char bytes[1024];
    size_t positions_length, indices_length;
} file;

static void encode_file(file *out)
{
    unsigned wide[12];
    for (int i = 0; i < 12; ++i) {
        wide[i] = triangles[i];
    }
    memset(out->bytes, 0, sizeof out->bytes);
    out->positions_length = meshopt_encodeVertexBuffer(out->bytes, 512, positions, VERTICES, 8);
    out->indices_length = meshopt_encodeIndexBuffer(out->bytes + 512, 512, wide, 12);
    assert_true(out->positions_length > 0 && out->indices_length > 0);
}

static ppm_status import_with(gltf_fixture *f, const file *data, const char *extension,
                              const char *positions_view, const char *plain_buffer)
{
    return gltf_importf(
        f,
        "{" GLTF_HEAD "'extensionsUsed':['%s'],'extensionsRequired':['%s'],'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],"
        "'accessors':[{'bufferView':0,'componentType':5123,'count':6,'type':'VEC3'},"
        "{'bufferView':1,'componentType':5123,'count':12,'type':'SCALAR'}],"
        "'bufferViews':[{'buffer':1,'byteLength':48,'byteStride':8,'extensions':{'%s':{%s}}},"
        "{'buffer':1,'byteOffset':48,'byteLength':24,'extensions':{'%s':{'buffer':0,"
        "'byteOffset':512,'byteLength':%zu,'byteStride':2,'count':12,'mode':'TRIANGLES'}}}],"
        "'buffers':[{'byteLength':1024,'uri':'%s'},{'byteLength':72%s}]}",
        extension, extension, extension, positions_view, extension, data->indices_length,
        gltf_data_uri(data->bytes, sizeof data->bytes), plain_buffer);
}

static void check_geometry(const gltf_fixture *f)
{
    assert_int_equal(f->scene->mesh_count, 1);
    const ppmi_primitive *p = &f->scene->meshes[0].primitives[0];
    assert_int_equal(p->vertex_count, VERTICES);
    assert_int_equal(p->triangle_count, 4);
    for (int i = 0; i < 12; ++i) { /* the codec may turn a triangle, so corners are compared */
        const float *corner = p->positions + 3 * p->indices[i];
        const int first = i / 3 * 3;
        bool is_there = false;
        for (int k = first; k < first + 3; ++k) {
            is_there = is_there || (corner[0] == positions[triangles[k]][0] &&
                                    corner[1] == positions[triangles[k]][1] &&
                                    corner[2] == positions[triangles[k]][2]);
        }
        assert_true(is_there);
    }
}

static const char *view_text(const file *data, const char *changed)
{
    static char text[200];
    snprintf(text, sizeof text, "'buffer':0,'byteLength':%zu,'mode':'ATTRIBUTES',%s",
             data->positions_length, changed);
    return text;
}

static void compressed_views_equal_plain_ones(void **state)
{
    gltf_fixture *f = *state;
    static const char *const names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
    file data;
    encode_file(&data);
    for (int i = 0; i < 2; ++i) {
        assert_gltf_status(
            f, import_with(f, &data, names[i], view_text(&data, "'byteStride':8,'count':6"), ""),
            PPM_STATUS_OK);
        check_geometry(f);
        gltf_reset(f);
    }
}

static void what_a_stream_cannot_be_is_refused_with_its_place(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *view, *message;
    } cases[] = {
        {"'byteStride':6,'count':8", "multiple of 4"},
        {"'byteStride':8,'count':5", "not the buffer view's byteLength"},
        {"'byteStride':8,'count':4000000000", "more than a stream of byteLength can hold"},
        {"'byteStride':8,'count':9007199254740992", "more than a stream of byteLength can hold"},
        {"'byteStride':8,'count':6.5", "more than a stream"},
        {"'byteStride':0,'count':6", "byteStride: out of range"},
        {"'byteStride':8", "count: missing"},
        {"'byteStride':8,'count':6,'byteOffset':9007199254740991", "do not fit in"},
        {"'byteStride':8,'count':6,'byteOffset':1", "unknown version"},
        {"'byteStride':4,'count':12,'filter':'QUATERNION'", "QUATERNION needs"},
        {"'byteStride':12,'count':4,'filter':'OCTAHEDRAL'", "OCTAHEDRAL needs"},
        {"'byteStride':12,'count':4,'filter':'COLOR'", "COLOR needs"},
        {"'byteStride':8,'count':6,'filter':'ZSTD'", "filter: unknown value"},
        {"'byteStride':4,'count':12", "the compressed stream is broken"},
    };
    file data;
    encode_file(&data);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_gltf_status(
            f,
            import_with(f, &data, "EXT_meshopt_compression", view_text(&data, cases[i].view), ""),
            PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', "bufferViews[0].extensions.EXT_meshopt_compression");
        assert_gltf_logged(f, 'E', cases[i].message);
        gltf_reset(f);
    }
}

static void a_broken_stream_falls_back_to_plain_data(void **state)
{
    gltf_fixture *f = *state;
    struct {
        uint16_t positions[VERTICES][4], triangles[12];
    } plain;
    char buffer[256];
    file data;
    encode_file(&data);
    memcpy(plain.positions, positions, sizeof positions);
    memcpy(plain.triangles, triangles, sizeof triangles);
    snprintf(buffer, sizeof buffer, ",'uri':'%s'", gltf_data_uri(&plain, sizeof plain));
    data.bytes[0] = 0xaf;
    assert_gltf_status(f,
                       import_with(f, &data, "KHR_meshopt_compression",
                                   view_text(&data, "'byteStride':8,'count':6"), buffer),
                       PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "the plain data are used");
    check_geometry(f);
}

static void memory_that_is_out_is_told(void **state)
{
    gltf_fixture *f = *state;
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 0;
    file data;
    encode_file(&data);
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        gltf_reset(f);
        ppmi_alloc_fail_at(f->context, ++n);
        status = import_with(f, &data, "EXT_meshopt_compression",
                             view_text(&data, "'byteStride':8,'count':6"), "");
        ppmi_alloc_fail_at(f->context, 0);
    }
    assert_gltf_status(f, status, PPM_STATUS_OK);
    assert_true(n > 20);
    check_geometry(f);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(version_1_that_is_cut_or_too_long_is_broken),
        TEST(version_1_of_every_control_and_channel_is_read),
        TEST(version_1_without_deltas_repeats_an_element),
        TEST(colors_are_decoded_to_all_their_bits),
        TEST(colors_of_few_bits_fill_the_whole_range),
        TEST(what_a_stream_cannot_be_is_refused_with_its_place),
        TEST(memory_that_is_out_is_told),
        TEST(compressed_views_equal_plain_ones),
        TEST(a_broken_stream_falls_back_to_plain_data),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
