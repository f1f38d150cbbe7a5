/* importers/gltf/basis_etc1s.c: pictures in Basis Universal are those of its own transcoder, and
 * broken ones are refused. tests/gltf/basisu/README.md says what the files are. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/ktx2.h"
#include "gltf_fixture.h"

static const char *const names[] = {"disk",       "edges", "edges_alpha", "gradient", "gray",
                                    "gray_alpha", "noise", "noise_alpha", "solid"};
enum { NAMES = sizeof names / sizeof names[0] };

typedef struct bytes {
    unsigned char *at;
    size_t count;
} bytes;

static bytes read_file(const char *name, const char *ending)
{
    char path[512];
    bytes out = {malloc(1 << 16), 0};
    snprintf(path, sizeof path, PPM_SOURCE_DIR "/tests/gltf/basisu/etc1s_%s.%s", name, ending);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_non_null(out.at);
    out.count = fread(out.at, 1, 1 << 16, file);
    fclose(file);
    return out;
}

/* Opens a file and decodes its first picture; *owned is the caller's. */
static ppm_status decode(gltf_fixture *f, const unsigned char *at, size_t count,
                         ppm_image_desc *desc, void **owned, char reason[PPMI_KTX2_REASON])
{
    ppmi_ktx2 file;
    *desc = (ppm_image_desc){.size = sizeof *desc, .role = PPM_IMAGE_COLOR};
    *owned = NULL;
    ppm_status status = ppmi_ktx2_open(f->context, at, count, &file);
    if (status == PPM_STATUS_OK) {
        status = ppmi_ktx2_picture(f->context, &file, 0, 0, desc, owned);
    }
    memcpy(reason, file.reason, PPMI_KTX2_REASON);
    ppmi_ktx2_close(f->context, &file);
    return status;
}

static void pictures_are_those_of_the_transcoder(void **state)
{
    gltf_fixture *f = *state;
    char reason[PPMI_KTX2_REASON];
    for (size_t i = 0; i < NAMES; ++i) {
        const bytes file = read_file(names[i], "ktx2"), expected = read_file(names[i], "rgba");
        ppm_image_desc desc;
        void *owned;
        if (decode(f, file.at, file.count, &desc, &owned, reason) != PPM_STATUS_OK)
            fail_msg("%s: %s", names[i], reason);
        assert_int_equal(desc.pixel_type, PPM_PIXELS_U8);
        assert_int_equal(desc.channels, 4);
        assert_int_equal((size_t)desc.width * desc.height * 4, expected.count);
        assert_memory_equal(owned, expected.at, expected.count);
        ppmi_free(f->context, owned);
        free(file.at);
        free(expected.at);
    }
}

/* ---- broken files ---------------------------------------------------------------------------- */

/* Decodes a copy that ends where the file ends. A failure has a reason. */
static ppm_status decode_copy(gltf_fixture *f, const unsigned char *at, size_t count)
{
    char reason[PPMI_KTX2_REASON];
    ppm_image_desc desc;
    void *owned;
    unsigned char *copy = malloc(count ? count : 1);
    assert_non_null(copy);
    memcpy(copy, at, count);
    const ppm_status status = decode(f, copy, count, &desc, &owned, reason);
    if (status != PPM_STATUS_OK) assert_true(reason[0] != 0);
    ppmi_free(f->context, owned);
    free(copy);
    return status;
}

static void files_that_end_early_are_refused(void **state)
{
    gltf_fixture *f = *state;
    for (size_t i = 0; i < NAMES; ++i) {
        const bytes file = read_file(names[i], "ktx2");
        for (size_t count = 0; count < file.count; ++count)
            assert_int_not_equal(decode_copy(f, file.at, count), PPM_STATUS_OK);
        free(file.at);
    }
}

/* Every bit in turn: what is then claimed holds or is refused. Of the header width and height
 * alone can make a picture larger, and it stays below the bound of what so few bytes may claim. */
static void any_bit_may_be_wrong(void **state)
{
    gltf_fixture *f = *state;
    size_t refused = 0, tried = 0;
    for (size_t i = 0; i < NAMES; ++i) {
        const bytes file = read_file(names[i], "ktx2");
        for (size_t bit = 8 * 28; bit < 8 * file.count; ++bit) {
            file.at[bit / 8] ^= (unsigned char)(1u << bit % 8);
            refused += decode_copy(f, file.at, file.count) != PPM_STATUS_OK;
            ++tried;
            file.at[bit / 8] ^= (unsigned char)(1u << bit % 8);
        }
        free(file.at);
    }
    print_message("%zu of %zu refused\n", refused, tried);
    assert_true(refused > tried / 10 && refused < tried);
}

static void a_picture_too_large_for_its_bytes_is_refused(void **state)
{
    gltf_fixture *f = *state;
    const bytes file = read_file("solid", "ktx2");
    file.at[21] = file.at[25] = 0x30; /* 12,288 and some on each side */
    assert_int_equal(decode_copy(f, file.at, file.count), PPM_STATUS_INPUT_INVALID);
    free(file.at);
}

static void memory_that_is_out_is_reported(void **state)
{
    gltf_fixture *f = *state;
    const bytes file = read_file("noise_alpha", "ktx2");
    size_t n = 0;
    ppm_status status;
    do {
        ppmi_alloc_fail_at(f->context, ++n);
        status = decode_copy(f, file.at, file.count);
        ppmi_alloc_fail_at(f->context, 0);
        if (status != PPM_STATUS_OK) assert_int_equal(status, PPM_STATUS_OUT_OF_MEMORY);
    } while (status != PPM_STATUS_OK);
    assert_true(n > 6);
    free(file.at);
}

/* ---- in a model ------------------------------------------------------------------------------ */

static const char model[] =
    "{'asset':{'version':'2.0'},%s'nodes':[{'mesh':0}],"
    "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}],"
    "'textures':[{%s'extensions':{'KHR_texture_basisu':{'source':0}}}],"
    "'images':[{'uri':'a.ktx2'},{'uri':'absent.png'}],"
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
    "'bufferViews':[{'buffer':0,'byteLength':36}],"
    "'buffers':[{'byteLength':36,'uri':'data:;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}";

static void a_model_that_requires_it_is_shown(void **state)
{
    gltf_fixture *f = *state;
    const bytes file = read_file("disk", "ktx2"), expected = read_file("disk", "rgba");
    gltf_write(f, "sub/a.ktx2", file.at, file.count);
    assert_gltf_status(f,
                       gltf_importf(f, model, "'extensionsRequired':['KHR_texture_basisu'],", ""),
                       PPM_STATUS_OK);
    const uint32_t id = f->scene->materials[0].desc.base_color_texture.image;
    const ppmi_image *shown = &f->scene->images[id - 1];
    assert_true(shown->is_srgb);
    assert_memory_equal(shown->u8, expected.at, expected.count);
    free(file.at);
    free(expected.at);
}

static void a_broken_one_gives_way_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    const bytes file = read_file("disk", "ktx2");
    gltf_write(f, "sub/a.ktx2", file.at, file.count - 40);
    assert_gltf_status(f, gltf_importf(f, model, "", "'source':1,"), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "a.ktx2");
    assert_int_equal(f->scene->materials[0].desc.base_color_texture.image, 0);
    free(file.at);
}

#define GLTF_TEST(test) cmocka_unit_test_setup_teardown(test, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        GLTF_TEST(pictures_are_those_of_the_transcoder),
        GLTF_TEST(files_that_end_early_are_refused),
        GLTF_TEST(any_bit_may_be_wrong),
        GLTF_TEST(a_picture_too_large_for_its_bytes_is_refused),
        GLTF_TEST(memory_that_is_out_is_reported),
        GLTF_TEST(a_model_that_requires_it_is_shown),
        GLTF_TEST(a_broken_one_gives_way_with_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
