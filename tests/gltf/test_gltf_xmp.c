/* importers/gltf/gltf_xmp.c */
#include <string.h>

#include "gltf/gltf_reader.h"
#include "gltf_fixture.h"

/* What is read from a document, JSON with '. Free with ppmi_free. */
static char *read_xmp(gltf_fixture *f, const char *json, int32_t packet)
{
    char text[1024];
    const size_t length = strlen(json);
    assert_true(length < sizeof text);
    for (size_t i = 0; i <= length; ++i) {
        text[i] = (char)(json[i] == '\'' ? '"' : json[i]);
    }
    const ppmi_gltf_document document = {.xmp_packet = packet};
    ppmi_gltf_reader reader = {.context = f->context,
                               .path = "x.gltf",
                               .json = text,
                               .json_length = length,
                               .document = &document};
    assert_int_equal(ppmi_gltf_read_xmp(&reader), PPM_STATUS_OK);
    return reader.xmp;
}

static void assert_xmp(gltf_fixture *f, const char *json, int32_t packet, const char *expected)
{
    char *xmp = read_xmp(f, json, packet);
    if (expected) {
        assert_non_null(xmp);
        assert_string_equal(xmp, expected);
    } else {
        assert_null(xmp);
    }
    ppmi_free(f->context, xmp);
}

#define PACKETS(list) "{'a':[{'extensions':1}],'extensions':{'b':{},'KHR_xmp_json_ld':" list "}}"

static void the_packet_is_taken_as_it_stands_in_the_file(void **state)
{
    gltf_fixture *f = *state;
    static const char json[] =
        PACKETS("{'x':[true,-1.5,null],'packets':[{'k':'a]}'}, { 'dc:title' :[1, {}] } ,{}]}");
    assert_xmp(f, json, 0, "{\"k\":\"a]}\"}");
    assert_xmp(f, json, 1, "{ \"dc:title\" :[1, {}] }");
    assert_xmp(f, json, 2, "{}");
    assert_false(gltf_logged(f, 'W', ""));
}

static void a_file_without_metadata_has_none(void **state)
{
    gltf_fixture *f = *state;
    assert_xmp(f, "{}", -1, NULL);
    assert_false(gltf_logged(f, 'W', ""));
}

static void a_packet_that_is_not_there_is_told(void **state)
{
    gltf_fixture *f = *state;
    static const char *const cases[] = {"{}",
                                        "{'extensions':7}",
                                        PACKETS("{}"),
                                        PACKETS("[]"),
                                        PACKETS("{'packets':{}}"),
                                        PACKETS("{'packets':[]}"),
                                        PACKETS("{'packets':[{}]}"),
                                        PACKETS("{'packets':[{},'text']}")};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        gltf_reset(f);
        assert_xmp(f, cases[i], 1, NULL);
        assert_gltf_logged(f, 'W', "x.gltf: asset.extensions.KHR_xmp_json_ld.packet: packet 1");
    }
}

static void memory_may_end(void **state)
{
    gltf_fixture *f = *state;
    static const char text[] = "{\"extensions\":{\"KHR_xmp_json_ld\":{\"packets\":[{}]}}}";
    const ppmi_gltf_document document = {.xmp_packet = 0};
    ppmi_gltf_reader reader = {.context = f->context,
                               .path = "x.gltf",
                               .json = text,
                               .json_length = strlen(text),
                               .document = &document};
    ppmi_alloc_fail_at(f->context, 1);
    assert_int_equal(ppmi_gltf_read_xmp(&reader), PPM_STATUS_OUT_OF_MEMORY);
    ppmi_alloc_fail_at(f->context, 0);
    assert_null(reader.xmp);
}

/* Through the whole import: the packet that the asset names, and one that it names in vain. */
static void metadata_does_not_disturb_the_import(void **state)
{
    gltf_fixture *f = *state;
    static const char format[] =
        "{'asset':{'version':'2.0','extensions':{'KHR_xmp_json_ld':{'packet':%d}}},"
        "'extensionsUsed':['KHR_xmp_json_ld'],'extensions':{'KHR_xmp_json_ld':{'packets':[{}]}}}";
    assert_gltf_status(f, gltf_importf(f, format, 0), PPM_STATUS_OK);
    assert_gltf_logged(f, 'D', "honoured: KHR_xmp_json_ld");
    assert_false(gltf_logged(f, 'W', "packet"));
    gltf_reset(f);
    assert_gltf_status(f, gltf_importf(f, format, 1), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "packet 1 does not exist");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_packet_that_is_not_there_is_told),           TEST(a_file_without_metadata_has_none),
        TEST(the_packet_is_taken_as_it_stands_in_the_file), TEST(memory_may_end),
        TEST(metadata_does_not_disturb_the_import),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
