/* importers/gltf/gltf_draco_shim.cpp and gltf_decoded.c: KHR_draco_mesh_compression */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draco_encoder.h"
#include "gltf/gltf_draco_shim.h"
#include "gltf_fixture.h"

enum { SIDE = 8, VERTICES = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };

/* A bent grid. */
typedef struct grid {
    float positions[VERTICES][3];
    uint8_t colors[VERTICES][4];
    uint16_t joints[VERTICES][4];
    uint32_t indices[TRIANGLES][3];
} grid;

static void make_grid(grid *g)
{
    size_t t = 0;
    for (uint32_t i = 0; i < VERTICES; ++i) {
        const float x = (float)(i % SIDE), y = (float)(i / SIDE);
        g->positions[i][0] = x;
        g->positions[i][1] = y;
        g->positions[i][2] = 0.1f * x * y + 0.003f * y;
        for (uint32_t k = 0; k < 4; ++k) {
            g->colors[i][k] = (uint8_t)(3 * i + k);
            g->joints[i][k] = (uint16_t)(500 * k + i);
        }
    }
    for (uint32_t y = 0; y + 1 < SIDE; ++y) {
        for (uint32_t x = 0; x + 1 < SIDE; ++x) {
            const uint32_t a = y * SIDE + x, b = a + 1, c = a + SIDE, d = c + 1;
            const uint32_t two[2][3] = {{a, b, c}, {c, b, d}};
            memcpy(g->indices[t], two, sizeof two);
            t += 2;
        }
    }
    assert_int_equal(t, TRIANGLES);
}

static size_t encode(const grid *g, int method, unsigned char *out, size_t size)
{
    const size_t length = draco_encode(method, g->positions[0], g->colors[0], g->joints[0],
                                       VERTICES, g->indices[0], TRIANGLES, out, size);
    assert_true(length > 0);
    return length;
}

/* A file with that stream; the accessors have no buffer views. */
static ppm_status import_stream(gltf_fixture *f, const unsigned char *stream, size_t length,
                                size_t vertices, size_t indices, int mode, int color_id)
{
    gltf_write(f, "sub/mesh.bin", stream, length);
    return gltf_importf(
        f,
        "{" GLTF_HEAD "'extensionsUsed':['KHR_draco_mesh_compression'],"
        "'extensionsRequired':['KHR_draco_mesh_compression'],'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[{'attributes':{'COLOR_0':1,'POSITION':0},'indices':2,'mode':%d,"
        "'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,"
        "'attributes':{'POSITION':0,'COLOR_0':%d}}}}]}],"
        "'accessors':[{'componentType':5126,'count':%zu,'type':'VEC3'},"
        "{'componentType':5121,'normalized':true,'count':%zu,'type':'VEC4'},"
        "{'componentType':5123,'count':%zu,'type':'SCALAR'}],"
        "'bufferViews':[{'buffer':0,'byteLength':%zu}],"
        "'buffers':[{'byteLength':%zu,'uri':'mesh.bin'}]}",
        mode, color_id, vertices, vertices, indices, length, length);
}

/* Draco renumbers vertices and triangles, so each vertex is found again by its place. */
static void check_equal(const gltf_fixture *f, const grid *g)
{
    assert_int_equal(f->scene->mesh_count, 1);
    const ppmi_primitive *p = &f->scene->meshes[0].primitives[0];
    assert_int_equal(p->vertex_count, VERTICES);
    assert_int_equal(p->triangle_count, TRIANGLES);
    uint32_t original[VERTICES];
    for (uint32_t i = 0; i < VERTICES; ++i) {
        const float *at = p->positions + 3 * i;
        original[i] = (uint32_t)lroundf(at[1]) * SIDE + (uint32_t)lroundf(at[0]);
        assert_true(original[i] < VERTICES);
        assert_memory_equal(at, g->positions[original[i]], 3 * sizeof *at);
        for (int k = 0; k < 4; ++k) {
            assert_float_equal(p->colors[4 * i + k], g->colors[original[i]][k] / 255.0f, 1e-6f);
        }
    }
    bool seen[TRIANGLES] = {false};
    for (uint32_t t = 0; t < TRIANGLES; ++t) {
        const uint32_t *corner = p->indices + 3 * t;
        bool is_found = false;
        for (uint32_t k = 0; k < TRIANGLES && !is_found; ++k) {
            for (int turn = 0; turn < 3 && !is_found; ++turn) {
                is_found = !seen[k] && original[corner[0]] == g->indices[k][turn] &&
                           original[corner[1]] == g->indices[k][(turn + 1) % 3] &&
                           original[corner[2]] == g->indices[k][(turn + 2) % 3];
                if (is_found) seen[k] = true;
            }
        }
        assert_true(is_found);
    }
}

static void a_compressed_mesh_equals_the_plain_one(void **state)
{
    gltf_fixture *f = *state;
    unsigned char stream[8192];
    grid g;
    make_grid(&g);
    for (int method = DRACO_EDGEBREAKER; method <= DRACO_SEQUENTIAL; ++method) {
        const size_t length = encode(&g, method, stream, sizeof stream);
        assert_gltf_status(f,
                           import_stream(f, stream, length, VERTICES, 3 * (size_t)TRIANGLES, 4, 1),
                           PPM_STATUS_OK);
        check_equal(f, &g);
        gltf_reset(f);
    }
}

static void strips_come_as_lists(void **state)
{
    gltf_fixture *f = *state;
    unsigned char stream[8192];
    grid g;
    make_grid(&g);
    const size_t length = encode(&g, DRACO_EDGEBREAKER, stream, sizeof stream);
    assert_gltf_status(f, import_stream(f, stream, length, VERTICES, 140, 5, 1), PPM_STATUS_OK);
    check_equal(f, &g);
}

/* A file of count meshes with one stream each; the nodes show the first shown of them. Stream
 * number broken is changed. */
static ppm_status import_many(gltf_fixture *f, size_t count, size_t shown, size_t broken)
{
    enum { ROOM = 1 << 16 };
    static unsigned char bytes[ROOM];
    static char meshes[ROOM], accessors[ROOM], views[ROOM], nodes[ROOM], roots[ROOM];
    size_t length = 0, m = 0, a = 0, v = 0, n = 0, r = 0;
    grid g;
    make_grid(&g);
    for (size_t i = 0; i < count; ++i) {
        const char *comma = i > 0 ? "," : "";
        g.positions[0][2] = -(float)i; /* tells the meshes apart */
        const size_t size = encode(&g, DRACO_EDGEBREAKER, bytes + length, ROOM - length);
        if (i == broken) memset(bytes + length + 20, 0xff, size / 2);
        m += (size_t)snprintf(
            meshes + m, ROOM - m,
            "%s{'primitives':[{'attributes':{'POSITION':%zu},'indices':%zu,'extensions':{"
            "'KHR_draco_mesh_compression':{'bufferView':%zu,'attributes':{'POSITION':0}}}}]}",
            comma, 2 * i, 2 * i + 1, i);
        a += (size_t)snprintf(accessors + a, ROOM - a,
                              "%s{'componentType':5126,'count':%d,'type':'VEC3'},"
                              "{'componentType':5125,'count':%d,'type':'SCALAR'}",
                              comma, VERTICES, 3 * TRIANGLES);
        v += (size_t)snprintf(views + v, ROOM - v,
                              "%s{'buffer':0,'byteOffset':%zu,'byteLength':%zu}", comma, length,
                              size);
        if (i < shown) n += (size_t)snprintf(nodes + n, ROOM - n, "%s{'mesh':%zu}", comma, i);
        if (i < shown) r += (size_t)snprintf(roots + r, ROOM - r, "%s%zu", comma, i);
        length += size;
    }
    gltf_write(f, "sub/mesh.bin", bytes, length);
    return gltf_importf(f,
                        "{'asset':{'version':'2.0'},'scenes':[{'nodes':[%s]}],'nodes':[%s],"
                        "'meshes':[%s],'accessors':[%s],'bufferViews':[%s],"
                        "'buffers':[{'byteLength':%zu,'uri':'mesh.bin'}]}",
                        roots, nodes, meshes, accessors, views, length);
}

static void many_streams_are_decoded_ahead_and_none_is_mixed_up(void **state)
{
    gltf_fixture *f = *state;
    enum { COUNT = 20 }; /* more than are decoded at once */
    assert_gltf_status(f, import_many(f, COUNT, COUNT, COUNT), PPM_STATUS_OK);
    assert_int_equal(f->scene->mesh_count, COUNT);
    for (uint32_t i = 0; i < COUNT; ++i) {
        const ppmi_primitive *p = &f->scene->meshes[i].primitives[0];
        float low = 1.0f;
        assert_int_equal(p->triangle_count, TRIANGLES);
        for (uint32_t v = 0; v < p->vertex_count; ++v) {
            low = fminf(low, p->positions[3 * v + 2]);
        }
        assert_float_equal(low, -(float)i, 0.0f);
    }
}

static void a_broken_stream_is_an_error_only_where_it_is_used(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_many(f, 4, 2, 2), PPM_STATUS_OK);
    assert_false(gltf_logged(f, 'E', "Draco"));
    gltf_reset(f);
    assert_gltf_status(f, import_many(f, 4, 4, 2), PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "meshes[2].primitives[0]");
}

/* As the first encoders did, which merged vertices and dropped triangles without area. */
static void counts_of_the_stream_win_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    const size_t indices = 3 * (size_t)TRIANGLES;
    const struct {
        size_t vertices, indices;
        const char *message;
    } cases[] = {
        {VERTICES + 1, indices, "64 vertices in the Draco stream are used, accessors[1] has 65"},
        {VERTICES - 9, indices, "64 vertices in the Draco stream are used, accessors[1] has 55"},
        {VERTICES, indices + 3, "294 indices in the Draco stream are used, accessors[2] has 297"},
        {VERTICES, indices - 3, "294 indices in the Draco stream are used, accessors[2] has 291"},
    };
    unsigned char stream[8192];
    grid g;
    make_grid(&g);
    const size_t length = encode(&g, DRACO_EDGEBREAKER, stream, sizeof stream);
    for (size_t i = 0; i < 2 * sizeof cases / sizeof cases[0]; ++i) {
        f->options.strict = i % 2;
        assert_gltf_status(
            f, import_stream(f, stream, length, cases[i / 2].vertices, cases[i / 2].indices, 4, 1),
            i % 2 == 0 ? PPM_STATUS_OK : PPM_STATUS_INPUT_UNSUPPORTED);
        assert_gltf_logged(f, 'W', cases[i / 2].message);
        assert_gltf_logged(f, 'W', "meshes[0].primitives[0]");
        if (i % 2 == 0) check_equal(f, &g);
        gltf_reset(f);
    }
}

/* COLOR_0, which is read, or another attribute, which is not, of 16 bits in 8. */
static void what_nobody_uses_of_a_stream_may_be_wrong(void **state)
{
    gltf_fixture *f = *state;
    unsigned char stream[8192];
    grid g;
    make_grid(&g);
    const size_t length = encode(&g, DRACO_EDGEBREAKER, stream, sizeof stream);
    for (int i = 0; i < 2; ++i) {
        const char *name = i == 0 ? "_BATCH" : "COLOR_0";
        gltf_write(f, "sub/mesh.bin", stream, length);
        assert_gltf_status(
            f,
            gltf_importf(f,
                         "{" GLTF_HEAD "'nodes':[{'mesh':0}],"
                         "'meshes':[{'primitives':[{'attributes':{'%s':1,'POSITION':0},'indices':2,"
                         "'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,"
                         "'attributes':{'POSITION':0,'%s':2}}}}]}],"
                         "'accessors':[{'componentType':5126,'count':%d,'type':'VEC3'},"
                         "{'componentType':5121,'count':%d,'type':'VEC4'},"
                         "{'componentType':5123,'count':%d,'type':'SCALAR'}],"
                         "'bufferViews':[{'buffer':0,'byteLength':%zu}],"
                         "'buffers':[{'byteLength':%zu,'uri':'mesh.bin'}]}",
                         name, name, VERTICES, VERTICES, 3 * TRIANGLES, length, length),
            i == 0 ? PPM_STATUS_OK : PPM_STATUS_INPUT_INVALID);
        if (i == 0) assert_int_equal(f->scene->meshes[0].primitives[0].triangle_count, TRIANGLES);
        if (i == 1) assert_gltf_logged(f, 'E', "does not fit componentType 5121");
        gltf_reset(f);
    }
}

static void ids_that_disagree_are_refused(void **state)
{
    gltf_fixture *f = *state;
    const size_t indices = 3 * (size_t)TRIANGLES;
    const struct {
        size_t vertices, indices;
        int mode, color_id;
        const char *message;
    } cases[] = {
        {VERTICES, indices, 6, 1, "mode 6"},
        {VERTICES, indices, 4, 7, "attribute 7 of the Draco stream does not suit it"},
        {VERTICES, indices, 4, 0, "attribute 0 of the Draco stream does not suit it"},
        {VERTICES, indices, 4, 2, "does not fit componentType 5121"}, /* 16 bits in 8 */
    };
    unsigned char stream[8192];
    grid g;
    make_grid(&g);
    const size_t length = encode(&g, DRACO_EDGEBREAKER, stream, sizeof stream);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_gltf_status(f,
                           import_stream(f, stream, length, cases[i].vertices, cases[i].indices,
                                         cases[i].mode, cases[i].color_id),
                           PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', "meshes[0].primitives[0]");
        assert_gltf_logged(f, 'E', cases[i].message);
        gltf_reset(f);
    }
}

/* A stream that claims a number of triangles and vertices, and then ends. */
static size_t claim(unsigned char method, const unsigned char *counts, size_t count_length,
                    unsigned char *out)
{
    static const unsigned char head[] = {'D', 'R', 'A', 'C', 'O', 2, 2, 1};
    size_t length = sizeof head;
    memcpy(out, head, sizeof head);
    out[length++] = method;
    out[length++] = 0;
    out[length++] = 0;
    if (method == 1) out[length++] = 0; /* how the mesh is walked */
    memcpy(out + length, counts, count_length);
    length += count_length;
    memset(out + length, 1, 32);
    return length + 32;
}

static void a_stream_that_claims_billions_is_refused_before_room_is_made(void **state)
{
    gltf_fixture *f = *state;
    static const unsigned char most[] = {0xff, 0xff, 0xff, 0xff, 0x0f, /* 2^32 - 1 */
                                         0xff, 0xff, 0xff, 0xff, 0x0f};
    unsigned char stream[128];
    for (unsigned char method = 0; method < 2; ++method) {
        const size_t length = claim(method, most, sizeof most, stream);
        const size_t live = ppmi_alloc_live(f->context);
        /* whatever the accessors say */
        assert_gltf_status(f, import_stream(f, stream, length, VERTICES, 3000000000u, 4, 1),
                           PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', "more triangles than");
        assert_int_equal(ppmi_alloc_live(f->context), live);
        gltf_reset(f);
    }
}

static void a_stream_that_is_cut_or_changed_ends_in_a_status(void **state)
{
    gltf_fixture *f = *state;
    unsigned char stream[8192];
    grid g;
    make_grid(&g);
    for (int method = DRACO_EDGEBREAKER; method <= DRACO_SEQUENTIAL; ++method) {
        const size_t length = encode(&g, method, stream, sizeof stream);
        for (size_t i = 0; i < length; i += 1 + length / 300) {
            ppmi_gltf_draco *draco = NULL;
            const char *reason;
            unsigned char *copy = malloc(length);
            assert_non_null(copy);
            memcpy(copy, stream, length);
            assert_int_not_equal(ppmi_gltf_draco_create(copy, i, TRIANGLES, &reason, &draco),
                                 PPM_STATUS_OK);
            copy[i] ^= 0x55;
            if (ppmi_gltf_draco_create(copy, length, TRIANGLES, &reason, &draco) == PPM_STATUS_OK) {
                assert_true(ppmi_gltf_draco_face_count(draco) <= TRIANGLES);
            }
            ppmi_gltf_draco_destroy(draco);
            free(copy);
        }
    }
    assert_gltf_status(f, import_stream(f, stream, 40, VERTICES, 3 * (size_t)TRIANGLES, 4, 1),
                       PPM_STATUS_INPUT_INVALID);
}

static void memory_that_is_out_is_told(void **state)
{
    gltf_fixture *f = *state;
    unsigned char stream[8192];
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 0;
    grid g;
    make_grid(&g);
    const size_t length = encode(&g, DRACO_EDGEBREAKER, stream, sizeof stream);
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        gltf_reset(f);
        ppmi_alloc_fail_at(f->context, ++n);
        status = import_stream(f, stream, length, VERTICES, 3 * (size_t)TRIANGLES, 4, 1);
        ppmi_alloc_fail_at(f->context, 0);
    }
    assert_gltf_status(f, status, PPM_STATUS_OK);
    assert_true(n > 20);
    check_equal(f, &g);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_stream_that_claims_billions_is_refused_before_room_is_made),
        TEST(a_stream_that_is_cut_or_changed_ends_in_a_status),
        TEST(ids_that_disagree_are_refused),
        TEST(counts_of_the_stream_win_with_a_warning),
        TEST(what_nobody_uses_of_a_stream_may_be_wrong),
        TEST(a_broken_stream_is_an_error_only_where_it_is_used),
        TEST(many_streams_are_decoded_ahead_and_none_is_mixed_up),
        TEST(memory_that_is_out_is_told),
        TEST(a_compressed_mesh_equals_the_plain_one),
        TEST(strips_come_as_lists),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
