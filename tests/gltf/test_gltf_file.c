/* importers/gltf/gltf_file.c and gltf_uri.c: GLB framing, buffers, URIs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "gltf_fixture.h"

static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

#define TAIL                                                                                       \
    "'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"              \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"                 \
    "'bufferViews':[{'buffer':0,'byteLength':36}],"

/* ---- GLB ------------------------------------------------------------------------------------- */

static const char glb_json[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36}]}";

static void put_u32(unsigned char *at, size_t value)
{
    for (int i = 0; i < 4; ++i) {
        at[i] = (unsigned char)(value >> (8 * i));
    }
}

/* A sound file, which tests then spoil. Returns its size. */
static size_t make_glb(unsigned char *out, size_t *bin_at)
{
    const size_t json = (sizeof glb_json - 1 + 3) / 4 * 4, total = 12 + 8 + json + 8 + 36;
    memcpy(out, "glTF", 4);
    put_u32(out + 4, 2);
    put_u32(out + 8, total);
    put_u32(out + 12, json);
    memcpy(out + 16, "JSON", 4);
    memset(out + 20, ' ', json);
    memcpy(out + 20, glb_json, sizeof glb_json - 1);
    *bin_at = 20 + json;
    put_u32(out + *bin_at, 36);
    memcpy(out + *bin_at + 4, "BIN\0", 4);
    memcpy(out + *bin_at + 8, triangle, 36);
    return total;
}

static ppm_status import_glb(gltf_fixture *f, const unsigned char *bytes, size_t size)
{
    gltf_reset(f);
    gltf_write(f, "a.glb", bytes, size);
    return gltf_import_file(f, "a.glb");
}

static void a_glb_is_read(void **state)
{
    gltf_fixture *f = *state;
    unsigned char bytes[1024];
    size_t bin;
    const size_t size = make_glb(bytes, &bin);
    assert_gltf_status(f, import_glb(f, bytes, size), PPM_STATUS_OK);
    assert_memory_equal(f->scene->meshes[0].primitives[0].positions, triangle, 36);
}

/* Three bytes before the JSON and some behind it, in a chunk that is longer by four. */
static void what_writers_put_around_the_json_is_told(void **state)
{
    gltf_fixture *f = *state;
    unsigned char bytes[1024];
    size_t bin;
    const size_t size = make_glb(bytes, &bin) + 4, text = sizeof glb_json - 1;
    memmove(bytes + bin + 4, bytes + bin, 44);
    put_u32(bytes + 8, size);
    put_u32(bytes + 12, bin + 4 - 20);
    memset(bytes + 20, 0, bin + 4 - 20);
    memcpy(bytes + 20, "\xef\xbb\xbf", 3);
    memcpy(bytes + 23, glb_json, text);
    for (int i = 0; i < 2; ++i) {
        f->options.strict = i == 1;
        assert_gltf_status(f, import_glb(f, bytes, size),
                           i == 0 ? PPM_STATUS_OK : PPM_STATUS_INPUT_UNSUPPORTED);
        assert_gltf_logged(f, 'W', "byte order mark in chunk 0");
        assert_gltf_logged(f, 'W', "NUL bytes behind the JSON of chunk 0");
    }
    bytes[40] = 0; /* inside of the JSON it stays an error */
    assert_gltf_status(f, import_glb(f, bytes, size), PPM_STATUS_INPUT_INVALID);
}

static void every_truncation_of_a_glb_is_refused(void **state)
{
    gltf_fixture *f = *state;
    unsigned char bytes[1024];
    size_t bin;
    const size_t size = make_glb(bytes, &bin);
    for (size_t cut = 0; cut < size; ++cut) {
        assert_gltf_status(f, import_glb(f, bytes, cut), PPM_STATUS_INPUT_INVALID);
    }
    /* the same with a header that does not give it away */
    for (size_t cut = 12; cut < size; ++cut) {
        put_u32(bytes + 8, cut);
        assert_gltf_status(f, import_glb(f, bytes, cut), PPM_STATUS_INPUT_INVALID);
    }
}

static void lies_in_glb_headers_are_refused(void **state)
{
    gltf_fixture *f = *state;
    unsigned char bytes[1024];
    size_t bin;
    const size_t size = make_glb(bytes, &bin);
    const struct {
        size_t at, value;
    } lies[] = {{8, 0},    {8, size + 4}, {8, 0xffffffff},      {12, 0xffffffff},
                {12, 0},   {12, size},    {16, 0x004e4942},     {bin, 0xffffffff},
                {bin, 32}, {bin, 40},     {bin + 4, 0x4e4f534a}};
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; ++i) {
        make_glb(bytes, &bin);
        put_u32(bytes + lies[i].at, lies[i].value);
        assert_gltf_status(f, import_glb(f, bytes, size), PPM_STATUS_INPUT_INVALID);
    }
}

static void binary_gltf_1_is_named(void **state)
{
    gltf_fixture *f = *state;
    unsigned char bytes[1024];
    size_t bin;
    const size_t size = make_glb(bytes, &bin);
    put_u32(bytes + 4, 1);
    assert_gltf_status(f, import_glb(f, bytes, size), PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'E', "glTF 1.0");
}

static void bytes_behind_the_length_of_a_glb_are_ignored(void **state)
{
    gltf_fixture *f = *state;
    unsigned char bytes[1024] = {0};
    size_t bin;
    const size_t size = make_glb(bytes, &bin);
    assert_gltf_status(f, import_glb(f, bytes, size + 7), PPM_STATUS_OK);
}

static void a_missing_file_is_not_found(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import_file(f, "absent.gltf"), PPM_STATUS_INPUT_NOT_FOUND);
    assert_gltf_logged(f, 'E', "absent.gltf");
    assert_gltf_status(f, gltf_import_file(f, "sub"), PPM_STATUS_INPUT_NOT_FOUND); /* a folder */
}

static void a_byte_order_mark_is_skipped(void **state)
{
    gltf_fixture *f = *state;
    static const char text[] = "\xef\xbb\xbf{\"asset\":{\"version\":\"2.0\"}}";
    gltf_write(f, "bom.gltf", text, sizeof text - 1);
    assert_gltf_status(f, gltf_import_file(f, "bom.gltf"), PPM_STATUS_OK);
}

/* ---- buffer URIs ----------------------------------------------------------------------------- */

static ppm_status import_with_uri(gltf_fixture *f, const char *uri)
{
    gltf_reset(f);
    return gltf_importf(f, "{" GLTF_HEAD TAIL "'buffers':[{'byteLength':36,'uri':'%s'}]}", uri);
}

static void buffers_are_read_from_files_below_the_asset(void **state)
{
    gltf_fixture *f = *state;
    static const char *const uris[] = {"a b.bin", "a%20b.bin", "./x/../a%20b.bin",
                                       "x\\/..\\/a b.bin", "x\\\\..\\\\a b.bin", "%61 b.bin",
                                       /* a folder that is not there; queries and fragments */
                                       "none/../a b.bin", "none/../x/./no//more/../../../a b.bin",
                                       "a b.bin?v=2", "a%20b.bin#part", "a b.bin#x?y",
                                       "none/../a b.bin?a/../../b"};
    gltf_write(f, "sub/a b.bin", triangle, sizeof triangle);
    char command[160];
    snprintf(command, sizeof command, "mkdir '%s/sub/x'", f->folder);
    assert_int_equal(system(command), 0);
    for (size_t i = 0; i < sizeof uris / sizeof uris[0]; ++i) {
        assert_gltf_status(f, import_with_uri(f, uris[i]), PPM_STATUS_OK);
        assert_int_equal(f->scene->instance_count, 1);
    }
}

/* Not escaped, as many writers leave it; a file of the whole name goes before its beginning. */
static void marks_of_queries_may_be_of_a_name(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "sub/a#1?.bin", triangle, sizeof triangle);
    gltf_write(f, "sub/a", triangle, 4);
    assert_gltf_status(f, import_with_uri(f, "a#1?.bin"), PPM_STATUS_OK);
    assert_gltf_status(f, import_with_uri(f, "a%231%3f.bin"), PPM_STATUS_OK);
    assert_gltf_status(f, import_with_uri(f, "a#2.bin"), PPM_STATUS_INPUT_INVALID);
    assert_gltf_status(f, import_with_uri(f, "b%23"), PPM_STATUS_INPUT_NOT_FOUND);
}

static void uris_that_leave_the_folder_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const char *const uris[] = {"../up.bin",          "%2e%2e/up.bin", "x/../../up.bin",
                                       "..\\\\up.bin",       "./../up.bin",   "..%2Fup.bin",
                                       "a/b/../../../up.bin"};
    gltf_write(f, "up.bin", triangle, sizeof triangle);
    for (size_t i = 0; i < sizeof uris / sizeof uris[0]; ++i) {
        assert_gltf_status(f, import_with_uri(f, uris[i]), PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', "buffers[0].uri");
        assert_gltf_logged(f, 'E', "leaves the asset's folder");
    }
}

static void absolute_paths_and_other_schemes_are_refused(void **state)
{
    gltf_fixture *f = *state;
    char absolute[160], file_uri[160];
    gltf_write(f, "sub/a.bin", triangle, sizeof triangle);
    snprintf(absolute, sizeof absolute, "%s/sub/a.bin", f->folder);
    snprintf(file_uri, sizeof file_uri, "file://%s/sub/a.bin", f->folder);
    const char *uris[] = {absolute,   file_uri,         "http://localhost/a.bin", "%2Ftmp/a.bin",
                          "c:/a.bin", "//server/a.bin", "a.bin%00.txt",           ""};
    for (size_t i = 0; i < sizeof uris / sizeof uris[0]; ++i) {
        assert_gltf_status(f, import_with_uri(f, uris[i]), PPM_STATUS_INPUT_INVALID);
    }
}

static void buffer_files_that_are_missing_or_short_are_errors(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "sub/short.bin", triangle, 35);
    assert_gltf_status(f, import_with_uri(f, "short.bin"), PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "shorter than byteLength");
    assert_gltf_status(f, import_with_uri(f, "absent.bin"), PPM_STATUS_INPUT_NOT_FOUND);
    assert_gltf_logged(f, 'E', "absent.bin");
    assert_gltf_status(f, import_with_uri(f, "."), PPM_STATUS_INPUT_INVALID);
}

static void a_link_in_the_folder_is_followed(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "up.bin", triangle, sizeof triangle);
    assert_int_equal(symlink("../up.bin", gltf_path(f, "sub/link.bin")), 0);
    assert_gltf_status(f, import_with_uri(f, "link.bin"), PPM_STATUS_OK);
}

static void data_uris_of_all_forms_are_read(void **state)
{
    gltf_fixture *f = *state;
    static const char base64[] = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    char uri[256];
    snprintf(uri, sizeof uri, "data:application/octet-stream;base64,%s", base64);
    assert_gltf_status(f, import_with_uri(f, uri), PPM_STATUS_OK);
    snprintf(uri, sizeof uri, "DATA:;BASE64,%s=", base64); /* too much padding does no harm */
    assert_gltf_status(f, import_with_uri(f, uri), PPM_STATUS_OK);
    assert_gltf_status(f,
                       import_with_uri(f, "data:,%00%00%00%00%00%00%00%00%00%00%00%00"
                                          "%00%00%80%3f%00%00%00%00%00%00%00%00"
                                          "%00%00%00%00%00%00%80%3f%00%00%00%00"),
                       PPM_STATUS_OK);
    assert_memory_equal(f->scene->meshes[0].primitives[0].positions, triangle, 36);
}

static void broken_data_uris_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const char *const uris[] = {"data:;base64", "data:;base64,", "data:;base64,AAAA",
                                       "data:;base64,A*AA", "data:"};
    for (size_t i = 0; i < sizeof uris / sizeof uris[0]; ++i) {
        assert_gltf_status(f, import_with_uri(f, uris[i]), PPM_STATUS_INPUT_INVALID);
        assert_gltf_logged(f, 'E', "buffers[0]");
    }
}

static void a_buffer_without_bytes_is_an_error_when_used(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import(f, "{" GLTF_HEAD TAIL "'buffers':[{'byteLength':36}]}"),
                       PPM_STATUS_INPUT_INVALID);
    assert_gltf_logged(f, 'E', "buffers[0]: it has no bytes");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(marks_of_queries_may_be_of_a_name),
        TEST(a_glb_is_read),
        TEST(what_writers_put_around_the_json_is_told),
        TEST(every_truncation_of_a_glb_is_refused),
        TEST(lies_in_glb_headers_are_refused),
        TEST(binary_gltf_1_is_named),
        TEST(bytes_behind_the_length_of_a_glb_are_ignored),
        TEST(a_missing_file_is_not_found),
        TEST(a_byte_order_mark_is_skipped),
        TEST(buffers_are_read_from_files_below_the_asset),
        TEST(uris_that_leave_the_folder_are_refused),
        TEST(absolute_paths_and_other_schemes_are_refused),
        TEST(buffer_files_that_are_missing_or_short_are_errors),
        TEST(a_link_in_the_folder_is_followed),
        TEST(data_uris_of_all_forms_are_read),
        TEST(broken_data_uris_are_refused),
        TEST(a_buffer_without_bytes_is_an_error_when_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
