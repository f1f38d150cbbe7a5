/* importers/gltf/ktx2.c and its parts: KTX files as textures. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if PPM_HAS_ZLIB
#include <zlib.h>
#endif
#if PPM_HAS_ZSTD
#include <zstd.h>
#endif

#include "gltf/ktx2.h"
#include "gltf_fixture.h"
#include "ktx2_file.h"
#include "support/near.h"

static unsigned char made[1024];

/* Opens a copy that ends where the file ends. */
static ppm_status open_copy(gltf_fixture *f, const unsigned char *bytes, size_t count,
                            char reason[PPMI_KTX2_REASON])
{
    ppmi_ktx2 file;
    unsigned char *copy = malloc(count ? count : 1);
    assert_non_null(copy);
    memcpy(copy, bytes, count);
    const ppm_status status = ppmi_ktx2_open(f->context, copy, count, &file);
    for (uint32_t i = 0; status == PPM_STATUS_OK && i < file.faces; ++i) {
        ppm_image_desc desc = {.size = sizeof desc, .role = PPM_IMAGE_COLOR};
        void *owned = NULL;
        ppmi_ktx2_picture(f->context, &file, file.layers - 1, i, &desc, &owned);
        ppmi_free(f->context, owned);
    }
    memcpy(reason, file.reason, PPMI_KTX2_REASON);
    ppmi_ktx2_close(f->context, &file);
    free(copy);
    return status;
}

static const unsigned char texels[] = {0,  10, 20,  255, 30,  40,  50,  255, 60,  70,  80,  255,
                                       90, 99, 110, 128, 120, 130, 140, 200, 150, 160, 170, 7};

/* ---- bad files ------------------------------------------------------------------------------- */

static void a_file_that_ends_early_is_refused(void **state)
{
    gltf_fixture *f = *state;
    char reason[PPMI_KTX2_REASON];
    const ktx2_spec spec = {
        .format = 43, .width = 3, .height = 2, .swizzle = "rgba", .data = texels, .count = 24};
    const size_t count = ktx2_make(&spec, made);
    assert_int_equal(open_copy(f, made, count, reason), PPM_STATUS_OK);
    for (size_t i = 0; i < count; ++i) {
        assert_int_equal(open_copy(f, made, i, reason), PPM_STATUS_INPUT_INVALID);
        assert_true(reason[0] != 0);
    }
}

/* Every field of header, index and descriptions in turn, with values that overflow sums. */
static void sizes_that_lie_are_refused_or_harmless(void **state)
{
    gltf_fixture *f = *state;
    static const uint32_t lies[] = {0, 1, 5, 0x7fffffff, 0x80000000, 0xfffffff0, 0xffffffff};
    char reason[PPMI_KTX2_REASON];
    const ktx2_spec spec = {.format = 43,
                            .width = 3,
                            .height = 2,
                            .swizzle = "rgba",
                            .orientation = "rd",
                            .data = texels,
                            .count = 24};
    for (size_t at = 12; at < 170; at += 4) {
        for (size_t i = 0; i < sizeof lies / sizeof lies[0]; ++i) {
            const size_t count = ktx2_make(&spec, made);
            ktx2_put(made + at, lies[i], 4);
            const ppm_status status = open_copy(f, made, count, reason);
            if (at >= 20 && at < 28) assert_true(status != PPM_STATUS_OK);
            if (status != PPM_STATUS_OK) assert_true(reason[0] != 0);
        }
    }
}

static void shapes_that_are_no_picture_are_refused(void **state)
{
    gltf_fixture *f = *state;
    static const ktx2_spec specs[] = {
        {.format = 43, .width = 0, .height = 2, .data = texels, .count = 0},
        {.format = 43, .width = 6, .height = 0, .data = texels, .count = 24},
        {.format = 43, .width = 3, .height = 1, .faces = 2, .data = texels, .count = 24},
        {.format = 43, .width = 3, .height = 3, .data = texels, .count = 24},
        {.format = 43, .width = 1u << 20, .height = 1u << 20, .data = texels, .count = 24},
        {.format = 43, .width = 1, .height = 1, .layers = 0xffffffff, .data = texels, .count = 24},
        {.format = 43, .width = 3, .height = 2, .flags = 1, .data = texels, .count = 24},
        {.format = 43, .width = 3, .height = 2, .scheme = 9, .data = texels, .count = 24},
        {.format = 139, .width = 4, .height = 4, .data = texels, .count = 8},
        {.format = 999, .width = 3, .height = 2, .data = texels, .count = 24},
    };
    char reason[PPMI_KTX2_REASON];
    for (size_t i = 0; i < sizeof specs / sizeof specs[0]; ++i) {
        const size_t count = ktx2_make(&specs[i], made);
        assert_true(open_copy(f, made, count, reason) != PPM_STATUS_OK);
        assert_true(reason[0] != 0);
    }
}

static void basis_universal_that_is_not_read_has_a_name(void **state)
{
    gltf_fixture *f = *state;
    char reason[PPMI_KTX2_REASON];
    ktx2_spec spec = {.width = 4, .height = 4, .color_model = 167, .data = texels, .count = 16};
    size_t count = ktx2_make(&spec, made);
    assert_int_equal(open_copy(f, made, count, reason), PPM_STATUS_INPUT_UNSUPPORTED);
    assert_non_null(strstr(reason, "UASTC HDR"));
    spec.color_model = 163;
    count = ktx2_make(&spec, made);
    assert_int_equal(open_copy(f, made, count, reason), PPM_STATUS_INPUT_INVALID);
    assert_non_null(strstr(reason, "not packed by BasisLZ"));
    spec = (ktx2_spec){.format = 1000066000, .width = 4, .height = 4, .data = texels, .count = 16};
    count = ktx2_make(&spec, made);
    assert_int_equal(open_copy(f, made, count, reason), PPM_STATUS_INPUT_UNSUPPORTED);
    assert_non_null(strstr(reason, "ASTC HDR"));
}

/* ---- formats --------------------------------------------------------------------------------- */

/* Opens the first picture; desc's pixels are *owned. */
static void read_made(gltf_fixture *f, const ktx2_spec *spec, ppm_image_desc *desc, void **owned)
{
    ppmi_ktx2 file;
    const size_t count = ktx2_make(spec, made);
    *owned = NULL;
    if (ppmi_ktx2_open(f->context, made, count, &file) != PPM_STATUS_OK)
        fail_msg("%s", file.reason);
    assert_int_equal(ppmi_ktx2_picture(f->context, &file, 0, 0, desc, owned), PPM_STATUS_OK);
    ppmi_ktx2_close(f->context, &file);
}

/* One texel in each format; the expected values are those of Vulkan's definitions, by hand. */
static void each_format_gives_the_values_that_it_stores(void **state)
{
    gltf_fixture *f = *state;
    const double linear_128 = pow((128 / 255.0 + 0.055) / 1.055, 2.4);
    const struct {
        uint32_t format;
        size_t count;
        const char *bytes;
        double expected[4];
    } cases[] = {
        {9, 1, "\x80", {128 / 255.0, 0, 0, 1}},
        {15, 1, "\x80", {linear_128, 0, 0, 1}},
        {16, 2, "\x80\x33", {128 / 255.0, 0.2, 0, 1}},
        {23, 3, "\x80\x33\xff", {128 / 255.0, 0.2, 1, 1}},
        {29, 3, "\x80\x80\xff", {linear_128, linear_128, 1, 1}},
        {30, 3, "\x80\x33\xff", {1, 0.2, 128 / 255.0, 1}},
        {37, 4, "\x80\x33\xff\x66", {128 / 255.0, 0.2, 1, 0.4}},
        {43, 4, "\x80\x80\xff\x80", {linear_128, linear_128, 1, 128 / 255.0}},
        {44, 4, "\x80\x33\xff\x66", {1, 0.2, 128 / 255.0, 0.4}},
        {70, 2, "\x00\x80", {32768 / 65535.0, 0, 0, 1}},
        {91, 8, "\xff\xff\x00\x80\x00\x00\x01\x00", {1, 32768 / 65535.0, 0, 1 / 65535.0}},
        /* 1.5, -2, the least number, 65504 */
        {97, 8, "\x00\x3e\x00\xc0\x01\x00\xff\x7b", {1.5, -2, 0x1p-24, 65504}},
        {90, 6, "\x00\x3c\x00\x40\x00\x44", {1, 2, 4, 1}},
        {109, 16, "\0\0\xc0\x3f\0\0\0\xc0\0\0\x80\x44\0\0\0\x3e", {1.5, -2, 1024, 0.125}},
        /* red 1 = exponent 15, green 2 = 16, blue 0.5 = 14 with half a mantissa: 0.75 */
        {122, 4, "\xc0\x03\x20\x74", {1, 2, 0.75, 1}},
        /* exponent 16: 2^(16-24) times 256, 128, 511 */
        {123, 4, "\x00\x01\xfd\x87", {1, 0.5, 511 / 256.0, 1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const bool is_srgb =
            cases[i].format == 15 || cases[i].format == 29 || cases[i].format == 43;
        /* the role that takes 8 bits as floats */
        ppm_image_desc desc = {.size = sizeof desc,
                               .role = is_srgb ? PPM_IMAGE_DATA : PPM_IMAGE_COLOR};
        void *owned;
        const ktx2_spec spec = {.format = cases[i].format,
                                .width = 1,
                                .height = 1,
                                .data = cases[i].bytes,
                                .count = cases[i].count};
        read_made(f, &spec, &desc, &owned);
        assert_int_equal(desc.pixel_type, PPM_PIXELS_F32);
        const float *values = desc.pixels;
        for (uint32_t c = 0; c < desc.channels; ++c) {
            const double wanted = cases[i].expected[c];
            if (!(fabs(values[c] - wanted) <= 1e-6 * fmax(fabs(wanted), 0.01)))
                fail_msg("format %u channel %u: %g, not %g", cases[i].format, c, values[c], wanted);
        }
        if (desc.channels == 3) assert_near(cases[i].expected[3], 1.0, 0.0);
        ppmi_free(f->context, owned);
    }
}

static void values_of_eight_bits_stay_what_they_are(void **state)
{
    gltf_fixture *f = *state;
    ppm_image_desc desc = {.size = sizeof desc, .role = PPM_IMAGE_COLOR};
    void *owned;
    ktx2_spec spec = {.format = 43, .width = 3, .height = 2, .data = texels, .count = 24};
    read_made(f, &spec, &desc, &owned);
    assert_int_equal(desc.pixel_type, PPM_PIXELS_U8);
    assert_int_equal(desc.channels, 4);
    assert_memory_equal(desc.pixels, texels, 24);
    ppmi_free(f->context, owned);
    spec.format = 37;
    desc.role = PPM_IMAGE_DATA;
    read_made(f, &spec, &desc, &owned);
    assert_int_equal(desc.pixel_type, PPM_PIXELS_U8);
    assert_memory_equal(desc.pixels, texels, 24);
    ppmi_free(f->context, owned);
}

static void channels_and_axes_are_turned_as_the_file_says(void **state)
{
    gltf_fixture *f = *state;
    ppm_image_desc desc = {.size = sizeof desc, .role = PPM_IMAGE_COLOR};
    void *owned;
    const ktx2_spec grey = {
        .format = 15, .width = 2, .height = 2, .swizzle = "rrr1", .data = texels, .count = 4};
    read_made(f, &grey, &desc, &owned);
    assert_int_equal(desc.channels, 3);
    assert_memory_equal(desc.pixels, "\0\0\0\x0a\x0a\x0a\x14\x14\x14\xff\xff\xff", 12);
    ppmi_free(f->context, owned);
    const ktx2_spec turned = {.format = 43,
                              .width = 3,
                              .height = 2,
                              .swizzle = "b0ra",
                              .orientation = "lu",
                              .data = texels,
                              .count = 24};
    read_made(f, &turned, &desc, &owned);
    const uint8_t first[4] = {170, 0, 150, 7}, last[4] = {20, 0, 0, 255};
    assert_memory_equal(desc.pixels, first, 4);
    assert_memory_equal((const uint8_t *)desc.pixels + 20, last, 4);
    ppmi_free(f->context, owned);
}

/* ---- packed ---------------------------------------------------------------------------------- */

static void check_packed(gltf_fixture *f, uint32_t scheme, const unsigned char *packed,
                         size_t count)
{
    ppm_image_desc desc = {.size = sizeof desc, .role = PPM_IMAGE_COLOR};
    char reason[PPMI_KTX2_REASON];
    unsigned char broken[256];
    void *owned;
    ktx2_spec spec = {.format = 43,
                      .width = 3,
                      .height = 2,
                      .scheme = scheme,
                      .data = packed,
                      .count = count,
                      .unpacked = 24};
    read_made(f, &spec, &desc, &owned);
    assert_memory_equal(desc.pixels, texels, 24);
    ppmi_free(f->context, owned);
    for (size_t i = 0; i < count; ++i) {
        spec.count = i; /* ends early */
        const size_t file_count = ktx2_make(&spec, made);
        assert_int_equal(open_copy(f, made, file_count, reason), PPM_STATUS_INPUT_INVALID);
    }
    for (size_t i = 0; i < count; ++i) { /* no crash, whatever comes out */
        memcpy(broken, packed, count);
        broken[i] ^= 0x55;
        spec.data = broken;
        spec.count = count;
        const size_t file_count = ktx2_make(&spec, made);
        open_copy(f, made, file_count, reason);
    }
    spec = (ktx2_spec){.format = 43,
                       .width = 3,
                       .height = 1, /* holds more */
                       .scheme = scheme,
                       .data = packed,
                       .count = count,
                       .unpacked = 12};
    assert_int_equal(open_copy(f, made, ktx2_make(&spec, made), reason), PPM_STATUS_INPUT_INVALID);
}

static void pictures_packed_by_zlib_are_read(void **state)
{
#if PPM_HAS_ZLIB
    unsigned char packed[256];
    uLongf count = sizeof packed;
    assert_int_equal(compress(packed, &count, texels, sizeof texels), Z_OK);
    check_packed(*state, 3, packed, count);
#else
    (void)state;
    skip();
#endif
}

static void pictures_packed_by_zstandard_are_read(void **state)
{
#if PPM_HAS_ZSTD
    unsigned char packed[256];
    const size_t count = ZSTD_compress(packed, sizeof packed, texels, sizeof texels, 3);
    assert_false(ZSTD_isError(count));
    check_packed(*state, 2, packed, count);
#else
    (void)state;
    skip();
#endif
}

/* ---- as textures ----------------------------------------------------------------------------- */

static ppm_status import_texture(gltf_fixture *f, const char *head, const char *texture,
                                 const char *images)
{
    gltf_reset(f);
    return gltf_importf(
        f,
        "{'asset':{'version':'2.0'},%s'nodes':[{'mesh':0}],"
        "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}},"
        "'normalTexture':{'index':0}}],'textures':[%s],'images':[%s],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
        "'bufferViews':[{'buffer':0,'byteLength':36}],"
        "'buffers':[{'byteLength':36,'uri':'data:;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}",
        head, texture, images);
}

#define BASISU "{'extensions':{'KHR_texture_basisu':{'source':0}}}"
#define REQUIRED                                                                                   \
    "'extensionsUsed':['KHR_texture_basisu'],'extensionsRequired':['KHR_texture_basisu'],"

static const ppmi_image *color_image(const gltf_fixture *f)
{
    const uint32_t id = f->scene->materials[0].desc.base_color_texture.image;
    if (id == 0) fail_msg("no image\nlog:\n%s", f->log);
    return &f->scene->images[id - 1];
}

/* ---- ASTC ------------------------------------------------------------------------------------ */

#if PPM_HAS_ASTC
/* A void-extent block: one colour, in 16 bits each, and no limits of where it holds (Khronos Data
 * Format specification, "Void-Extent Blocks"). */
static void put_even_block(unsigned char *at, uint8_t red, uint8_t green, uint8_t blue,
                           uint8_t alpha)
{
    const uint8_t values[4] = {red, green, blue, alpha};
    memset(at, 0xff, 8);
    at[0] = 0xfc;
    at[1] = 0xfd;
    for (int i = 0; i < 4; ++i)
        ktx2_put(at + 8 + 2 * (size_t)i, 257 * (uint64_t)values[i], 2);
}

/* Three blocks across and two down, of each size, with cut ones at the edges. */
static void astc_blocks_of_every_size_are_where_they_belong(void **state)
{
    gltf_fixture *f = *state;
    static const uint32_t sizes[14][2] = {{4, 4},  {5, 4},   {5, 5},   {6, 5},  {6, 6},
                                          {8, 5},  {8, 6},   {8, 8},   {10, 5}, {10, 6},
                                          {10, 8}, {10, 10}, {12, 10}, {12, 12}};
    unsigned char blocks[6 * 16];
    for (uint8_t i = 0; i < 6; ++i)
        put_even_block(blocks + 16 * (size_t)i, (uint8_t)(40 * i), (uint8_t)(200 - i), 7,
                       (uint8_t)(255 - i));
    for (uint32_t k = 0; k < 28; ++k) {
        const uint32_t x = sizes[k / 2][0], y = sizes[k / 2][1];
        const ktx2_spec spec = {.format = 157 + k,
                                .width = 3 * x - 2,
                                .height = 2 * y - 1,
                                .data = blocks,
                                .count = sizeof blocks};
        ppm_image_desc desc = {.size = sizeof desc,
                               .role = k % 2 == 1 ? PPM_IMAGE_COLOR : PPM_IMAGE_DATA};
        void *owned = NULL;
        read_made(f, &spec, &desc, &owned);
        assert_int_equal(desc.pixel_type, PPM_PIXELS_U8);
        assert_int_equal(desc.channels, 4);
        const uint8_t *texel = desc.pixels;
        for (uint32_t i = 0; i < desc.width * desc.height; ++i, texel += 4) {
            const uint32_t at = i / desc.width / y * 3 + i % desc.width / x;
            assert_int_equal(texel[0], 40 * at);
            assert_int_equal(texel[1], 200 - at);
            assert_int_equal(texel[2], 7);
            assert_int_equal(texel[3], 255 - at);
        }
        ppmi_free(f->context, owned);
    }
}

/* Any bits: a picture, of the error colour where the format has none. */
static void any_astc_bits_are_a_picture(void **state)
{
    gltf_fixture *f = *state;
    char reason[PPMI_KTX2_REASON];
    unsigned char blocks[16 * 9];
    uint32_t seed = 1;
    for (int round = 0; round < 200; ++round) {
        for (size_t i = 0; i < sizeof blocks; ++i) {
            seed = seed * 1664525 + 1013904223;
            blocks[i] = (unsigned char)(seed >> 24);
        }
        const ktx2_spec spec = {.format = 157 + (uint32_t)round % 2,
                                .width = 12,
                                .height = 12,
                                .data = blocks,
                                .count = sizeof blocks};
        assert_int_equal(open_copy(f, made, ktx2_make(&spec, made), reason), PPM_STATUS_OK);
    }
    const ktx2_spec lie = {.format = 157, .width = 13, .height = 12, .data = blocks, .count = 144};
    assert_int_equal(open_copy(f, made, ktx2_make(&lie, made), reason), PPM_STATUS_INPUT_INVALID);
}

static void a_texture_in_astc_is_shown_after_the_plain_one(void **state)
{
    gltf_fixture *f = *state;
    unsigned char blocks[16];
    put_even_block(blocks, 10, 20, 30, 255);
    const ktx2_spec spec = {.format = 158, .width = 4, .height = 4, .data = blocks, .count = 16};
    gltf_write(f, "sub/a.ktx2", made, ktx2_make(&spec, made));
    assert_gltf_status(f,
                       import_texture(f, "'extensionsRequired':['EXT_texture_astc'],",
                                      "{'extensions':{'EXT_texture_astc':{'source':0}}}",
                                      "{'uri':'a.ktx2'}"),
                       PPM_STATUS_OK);
    const ppmi_image *shown = color_image(f);
    assert_int_equal(shown->width, 4);
    assert_true(shown->is_srgb);
    assert_int_equal(shown->u8[1], 20);
    assert_gltf_status(f,
                       import_texture(f, "",
                                      "{'source':1,'extensions':{'EXT_texture_astc':{'source':0}}}",
                                      "{'uri':'a.ktx2'},{'uri':'absent.png'}"),
                       PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "absent.png");
    assert_int_equal(color_image(f)->u8[1], 20);
}
#endif

static void a_required_texture_in_uastc_hdr_refuses_the_file(void **state)
{
    gltf_fixture *f = *state;
    const ktx2_spec spec = {
        .width = 4, .height = 4, .color_model = 167, .data = texels, .count = 16};
    gltf_write(f, "sub/a.ktx2", made, ktx2_make(&spec, made));
    assert_gltf_status(f, import_texture(f, REQUIRED, BASISU, "{'uri':'a.ktx2'}"),
                       PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'E', "images[0] is Basis Universal (UASTC HDR)");
    assert_gltf_status(f, import_texture(f, "", BASISU, "{'uri':'a.ktx2'}"), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "Basis Universal (UASTC HDR)");
    assert_int_equal(f->scene->materials[0].desc.base_color_texture.image, 0);
}

static void a_required_plain_texture_is_shown(void **state)
{
    gltf_fixture *f = *state;
    char image[2048];
    const ktx2_spec spec = {.format = 43, .width = 3, .height = 2, .data = texels, .count = 24};
    const size_t count = ktx2_make(&spec, made);
    gltf_write(f, "sub/a.ktx2", made, count);
    assert_gltf_status(f, import_texture(f, REQUIRED, BASISU, "{'uri':'a.ktx2'}"), PPM_STATUS_OK);
    const ppmi_image *shown = color_image(f);
    assert_int_equal(shown->width, 3);
    assert_int_equal(shown->height, 2);
    assert_true(shown->is_srgb);
    assert_memory_equal(shown->u8, texels, 24);
    /* the normal map takes the numbers that the format stands for */
    const uint32_t normal = f->scene->materials[0].desc.normal_texture.image;
    assert_non_null(f->scene->images[normal - 1].f32);
    snprintf(image, sizeof image, "{'mimeType':'image/ktx2','uri':'%s'}",
             gltf_data_uri(made, count));
    assert_gltf_status(f, import_texture(f, REQUIRED, BASISU, image), PPM_STATUS_OK);
    assert_memory_equal(color_image(f)->u8, texels, 24);
}

static void a_cube_is_no_texture(void **state)
{
    gltf_fixture *f = *state;
    const ktx2_spec spec = {
        .format = 43, .width = 1, .height = 1, .faces = 6, .data = texels, .count = 24};
    gltf_write(f, "sub/a.ktx2", made, ktx2_make(&spec, made));
    assert_gltf_status(f, import_texture(f, "", BASISU, "{'uri':'a.ktx2'}"), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "it has 6 faces, and 1 are needed");
}

/* Blocks of one colour: red in BC1 to BC3, and in BC7 mode 5 with all 128 bits of its endpoints 1:
 * white. BC6H mode 11 (bits 00011) with endpoints 0 is black. */
static void blocks_are_decoded(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        uint32_t format;
        size_t count;
        const char *block;
        int red, green;
    } cases[] = {
        {132, 8, "\x00\xf8\x1f\x00\0\0\0\0", 255, 0},
        {134, 8, "\x00\xf8\x1f\x00\0\0\0\0", 255, 0},
        {136, 16, "\xff\xff\xff\xff\xff\xff\xff\xff\x00\xf8\x1f\x00\0\0\0\0", 255, 0},
        {138, 16, "\xff\xff\0\0\0\0\0\0\x00\xf8\x1f\x00\0\0\0\0", 255, 0},
        {146, 16, "\x20\xff\xff\xff\xff\xff\xff\xff\x03\0\0\0\0\0\0\0", 255, 255},
        {143, 16, "\x03\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const ktx2_spec spec = {.format = cases[i].format,
                                .width = 4,
                                .height = 4,
                                .data = cases[i].block,
                                .count = cases[i].count};
        gltf_write(f, "sub/a.ktx2", made, ktx2_make(&spec, made));
        assert_gltf_status(f, import_texture(f, "", BASISU, "{'uri':'a.ktx2'}"), PPM_STATUS_OK);
        const ppmi_image *image = color_image(f);
        assert_int_equal(image->width, 4);
        for (uint32_t k = 0; k < 16; ++k) {
            const double scale = image->u8 ? 1.0 : 255.0;
            const uint32_t at = k * image->channels;
            assert_near(scale * (image->u8 ? image->u8[at] : image->f32[at]), cases[i].red, 0.5);
            assert_near(scale * (image->u8 ? image->u8[at + 1] : image->f32[at + 1]),
                        cases[i].green, 0.5);
        }
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
#if PPM_HAS_ASTC
        TEST(astc_blocks_of_every_size_are_where_they_belong),
        TEST(any_astc_bits_are_a_picture),
        TEST(a_texture_in_astc_is_shown_after_the_plain_one),
#endif
        TEST(a_file_that_ends_early_is_refused),
        TEST(sizes_that_lie_are_refused_or_harmless),
        TEST(shapes_that_are_no_picture_are_refused),
        TEST(basis_universal_that_is_not_read_has_a_name),
        TEST(each_format_gives_the_values_that_it_stores),
        TEST(values_of_eight_bits_stay_what_they_are),
        TEST(channels_and_axes_are_turned_as_the_file_says),
        TEST(pictures_packed_by_zlib_are_read),
        TEST(pictures_packed_by_zstandard_are_read),
        TEST(a_required_texture_in_uastc_hdr_refuses_the_file),
        TEST(a_required_plain_texture_is_shown),
        TEST(a_cube_is_no_texture),
        TEST(blocks_are_decoded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
