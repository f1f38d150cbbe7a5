/* importers/gltf/basis_etc1s.c and basis_uastc.c: pictures in Basis Universal are those of its own
 * transcoder, and broken ones are refused. tests/gltf/basisu/README.md says what the files are. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/ktx2.h"
#include "gltf_fixture.h"
#include "ktx2_file.h"

static const char *const names[] = {
    "etc1s_disk",        "etc1s_edges",      "etc1s_edges_alpha", "etc1s_gradient",
    "etc1s_gray",        "etc1s_gray_alpha", "etc1s_noise",       "etc1s_noise_alpha",
    "etc1s_solid",       "uastc_disk",       "uastc_edges",       "uastc_edges_alpha",
    "uastc_gradient",    "uastc_gray",       "uastc_gray_alpha",  "uastc_noise",
    "uastc_noise_alpha", "uastc_solid",      "uastc_modes",
#if PPM_HAS_ZSTD
    "uastc_zstd",
#endif
};
enum { NAMES = sizeof names / sizeof names[0] };

typedef struct bytes {
    unsigned char *at;
    size_t count;
} bytes;

static bytes read_file(const char *name, const char *ending)
{
    char path[512];
    bytes out = {malloc(1 << 16), 0};
    snprintf(path, sizeof path, PPM_SOURCE_DIR "/tests/gltf/basisu/%s.%s", name, ending);
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

/* What a block of each mode begins with: the code's bits, the bits of hints, and those of the
 * number of its pattern or second channel, of which there are so many (UASTC specification). */
static const struct {
    uint8_t code, code_bits, hint_bits, choice_bits, choices;
} modes[] = {{0x01, 4, 15, 0, 1},  {0x35, 6, 15, 0, 1},  {0x1d, 5, 15, 5, 30}, {0x03, 5, 15, 4, 11},
             {0x13, 5, 15, 5, 30}, {0x0b, 5, 15, 0, 1},  {0x1b, 5, 15, 2, 4},  {0x07, 5, 15, 5, 19},
             {0x17, 5, 0, 0, 1},   {0x0f, 5, 23, 5, 30}, {0x02, 3, 17, 0, 1},  {0x00, 2, 17, 2, 4},
             {0x06, 3, 17, 0, 1},  {0x1f, 5, 23, 2, 4},  {0x0d, 5, 23, 0, 1},  {0x05, 7, 23, 0, 1},
             {0x15, 6, 23, 5, 30}, {0x25, 6, 23, 0, 1},  {0x09, 4, 15, 0, 1}};
enum { MODES = sizeof modes / sizeof modes[0] };

static void the_files_have_every_mode_and_pattern(void **state)
{
    (void)state;
    uint32_t seen[MODES] = {0};
    const bytes file = read_file("uastc_modes", "ktx2");
    const size_t level = file.at[80] | (size_t)file.at[81] << 8;
    for (size_t at = level; at + 16 <= file.count; at += 16) {
        uint64_t begin = 0;
        for (int i = 0; i < 8; ++i)
            begin |= (uint64_t)file.at[at + i] << (8 * i);
        for (size_t m = 0; m < MODES; ++m) {
            if ((begin & ((1u << modes[m].code_bits) - 1)) != modes[m].code) continue;
            const uint64_t rest = begin >> (modes[m].code_bits + modes[m].hint_bits);
            seen[m] |= 1u << (rest & ((1u << modes[m].choice_bits) - 1));
        }
    }
    for (size_t m = 0; m < MODES; ++m)
        assert_int_equal(seen[m], (1u << modes[m].choices) - 1);
    free(file.at);
}

/* The file of the solid picture, declared to hold one channel or two (RRR 4, RRRG 5). */
static void channels_that_are_not_colours_are_taken_apart(void **state)
{
    gltf_fixture *f = *state;
    char reason[PPMI_KTX2_REASON];
    const bytes file = read_file("uastc_solid", "ktx2");
    const size_t channel_at = file.at[48] + 31u;
    for (int channels = 1; channels <= 2; ++channels) {
        ppm_image_desc desc;
        void *owned;
        file.at[channel_at] = (unsigned char)(3 + channels);
        assert_int_equal(decode(f, file.at, file.count, &desc, &owned, reason), PPM_STATUS_OK);
        const uint8_t *texel = desc.pixels;
        assert_int_equal(desc.channels, 3);
        assert_int_equal(texel[0], 12);
        assert_int_equal(texel[1], channels == 2 ? 130 : 0);
        assert_int_equal(texel[2], 0);
        ppmi_free(f->context, owned);
    }
    free(file.at);
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
 * alone can make a picture larger, and it stays below the bound of what so few bytes may claim. The
 * file of all modes, whose bits are by chance already, would only take long. */
static void any_bit_may_be_wrong(void **state)
{
    gltf_fixture *f = *state;
    size_t refused = 0, tried = 0;
    for (size_t i = 0; i < NAMES; ++i) {
        if (strcmp(names[i], "uastc_modes") == 0) continue;
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
    static const char *const solid[] = {"etc1s_solid", "uastc_solid"};
    for (int i = 0; i < 2; ++i) {
        const bytes file = read_file(solid[i], "ktx2");
        file.at[21] = file.at[25] = 0x30; /* 12,288 and some on each side */
        assert_int_equal(decode_copy(f, file.at, file.count), PPM_STATUS_INPUT_INVALID);
        free(file.at);
    }
}

/* The code that no mode has; then, after code and hints, the first pattern that is none. */
static void blocks_that_are_none_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        uint32_t begin;
        const char *reason;
    } blocks[] = {{0x45, "no mode"},
                  {0x1d | 30u << 20, "no pattern"},
                  {0x03 | 11u << 20, "no pattern"},
                  {0x07 | 19u << 20, "no pattern"}};
    for (size_t i = 0; i < sizeof blocks / sizeof blocks[0]; ++i) {
        unsigned char block[16] = {0}, made[512];
        char reason[PPMI_KTX2_REASON];
        ppm_image_desc desc;
        void *owned;
        for (int k = 0; k < 4; ++k)
            block[k] = (unsigned char)(blocks[i].begin >> (8 * k));
        const ktx2_spec spec = {
            .width = 4, .height = 4, .color_model = 166, .data = block, .count = sizeof block};
        const size_t count = ktx2_make(&spec, made);
        assert_int_equal(decode(f, made, count, &desc, &owned, reason), PPM_STATUS_INPUT_INVALID);
        assert_non_null(strstr(reason, blocks[i].reason));
    }
}

/* Lets each allocation of a picture fail in turn; there are so many at least. */
static void fail_each(gltf_fixture *f, const char *name, size_t least)
{
    const bytes file = read_file(name, "ktx2");
    size_t n = 0;
    ppm_status status;
    do {
        ppmi_alloc_fail_at(f->context, ++n);
        status = decode_copy(f, file.at, file.count);
        ppmi_alloc_fail_at(f->context, 0);
        if (status != PPM_STATUS_OK) assert_int_equal(status, PPM_STATUS_OUT_OF_MEMORY);
    } while (status != PPM_STATUS_OK);
    assert_true(n > least);
    free(file.at);
}

static void memory_that_is_out_is_reported(void **state)
{
    fail_each(*state, "etc1s_noise_alpha", 6);
    fail_each(*state, "uastc_noise_alpha", 2);
#if PPM_HAS_ZSTD
    fail_each(*state, "uastc_zstd", 3);
#endif
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
    for (size_t i = 0; i < NAMES; ++i) {
        const bytes file = read_file(names[i], "ktx2"), expected = read_file(names[i], "rgba");
        gltf_reset(f);
        gltf_write(f, "sub/a.ktx2", file.at, file.count);
        assert_gltf_status(
            f, gltf_importf(f, model, "'extensionsRequired':['KHR_texture_basisu'],", ""),
            PPM_STATUS_OK);
        const uint32_t id = f->scene->materials[0].desc.base_color_texture.image;
        const ppmi_image *shown = &f->scene->images[id - 1];
        assert_true(shown->is_srgb);
        assert_memory_equal(shown->u8, expected.at, expected.count);
        free(file.at);
        free(expected.at);
    }
}

static void a_broken_one_gives_way_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    for (size_t i = 0; i < NAMES; ++i) {
        const bytes file = read_file(names[i], "ktx2");
        gltf_reset(f);
        gltf_write(f, "sub/a.ktx2", file.at, file.count - 40);
        assert_gltf_status(f, gltf_importf(f, model, "", "'source':1,"), PPM_STATUS_OK);
        assert_gltf_logged(f, 'W', "a.ktx2");
        assert_int_equal(f->scene->materials[0].desc.base_color_texture.image, 0);
        free(file.at);
    }
}

#define GLTF_TEST(test) cmocka_unit_test_setup_teardown(test, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        GLTF_TEST(pictures_are_those_of_the_transcoder),
        GLTF_TEST(the_files_have_every_mode_and_pattern),
        GLTF_TEST(channels_that_are_not_colours_are_taken_apart),
        GLTF_TEST(files_that_end_early_are_refused),
        GLTF_TEST(any_bit_may_be_wrong),
        GLTF_TEST(a_picture_too_large_for_its_bytes_is_refused),
        GLTF_TEST(blocks_that_are_none_are_refused),
        GLTF_TEST(memory_that_is_out_is_reported),
        GLTF_TEST(a_model_that_requires_it_is_shown),
        GLTF_TEST(a_broken_one_gives_way_with_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
