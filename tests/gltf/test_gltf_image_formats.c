/* importers/gltf/gltf_image.c: formats of image files, their names, and where they may lie. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf_fixture.h"
#include "image_files.h"
#include "imageio/imageio.h"

/* Imports a triangle with these textures; the material has texture 0 as base colour and as normal
 * map, so that images come in both roles. */
static ppm_status import_here(gltf_fixture *f, const char *textures, const char *images)
{
    return gltf_importf(
        f,
        "{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],"
        "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}},"
        "'normalTexture':{'index':0}}],'textures':[%s],'images':[%s],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
        "'bufferViews':[{'buffer':0,'byteLength':36}],"
        "'buffers':[{'byteLength':36,'uri':'data:;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}",
        textures, images);
}

static ppm_status import_images(gltf_fixture *f, const char *textures, const char *images)
{
    gltf_reset(f);
    return import_here(f, textures, images);
}

static ppm_status import_image(gltf_fixture *f, const char *image)
{
    return import_images(f, "{'source':0}", image);
}

/* The image in a role, or NULL where it was left out. */
static const ppmi_image *image_of(const gltf_fixture *f, bool is_data)
{
    assert_int_equal(f->scene->instance_count, 1);
    const ppm_material_desc *desc = &f->scene->materials[0].desc;
    const uint32_t id = is_data ? desc->normal_texture.image : desc->base_color_texture.image;
    return id > 0 ? &f->scene->images[id - 1] : NULL;
}

/* Formats with losses are off by a few codes. */
static void assert_is_even(const gltf_fixture *f, uint32_t size)
{
    static const int color[3] = {200, 100, 50};
    for (int role = 0; role < 2; ++role) {
        const ppmi_image *image = image_of(f, role == 1);
        if (!image) fail_msg("no image\nlog:\n%s", f->log);
        assert_int_equal(image->width, size);
        assert_int_equal(image->is_srgb, role == 0);
        assert_non_null(image->u8);
        for (uint32_t c = 0; c < 3; ++c)
            assert_in_range(image->u8[c] + 5 - color[c], 0, 10);
    }
}

static bool can_read_avif(const gltf_fixture *f)
{
    if (!gltf_logged(f, 'W', "this build of OpenImageIO cannot read")) return true;
    assert_gltf_logged(f, 'W', "images[0]: left out");
    print_message("OpenImageIO reads no AVIF here\n");
    return false;
}

/* ---- formats --------------------------------------------------------------------------------- */

static void extensions_name_webp_dds_and_avif_images(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "sub/a", even_webp, sizeof even_webp);
    assert_gltf_status(f,
                       import_images(f,
                                     "{'source':1,'extensions':{'EXT_texture_webp':{'source':0}}}",
                                     "{'uri':'a'},{'uri':'absent.png'}"),
                       PPM_STATUS_OK);
    assert_is_even(f, 4);
    gltf_write(f, "sub/a", even_dds, sizeof even_dds);
    assert_gltf_status(f,
                       import_images(f,
                                     "{'source':1,'extensions':{'MSFT_texture_dds':{'source':0}}}",
                                     "{'uri':'a'},{'uri':'absent.png'}"),
                       PPM_STATUS_OK);
    assert_is_even(f, 4);
    gltf_write(f, "sub/a", even_avif, sizeof even_avif);
    assert_gltf_status(f,
                       import_images(f,
                                     "{'source':1,'extensions':{'EXT_texture_avif':{'source':0}}}",
                                     "{'uri':'a'},{'uri':'absent.png'}"),
                       PPM_STATUS_OK);
    if (can_read_avif(f)) assert_is_even(f, 4);
}

static void a_source_that_cannot_be_read_gives_way_to_the_plain_one(void **state)
{
    gltf_fixture *f = *state;
    static const char *const names[] = {"EXT_texture_webp", "MSFT_texture_dds", "EXT_texture_avif"};
    gltf_write(f, "sub/a", even_avif, 60);
    gltf_write(f, "sub/b", even_jpg, sizeof even_jpg);
    for (int i = 0; i < 3; ++i) {
        char texture[128];
        snprintf(texture, sizeof texture, "{'source':1,'extensions':{'%s':{'source':0}}}",
                 names[i]);
        assert_gltf_status(f, import_images(f, texture, "{'uri':'a'},{'uri':'b'}"), PPM_STATUS_OK);
        assert_is_even(f, 4);
        assert_gltf_logged(f, 'W', "images[0]: left out");
    }
}

static void broken_ktx2_is_left_out_unless_there_is_another_image(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "sub/a.ktx2", even_ktx2, sizeof even_ktx2);
    gltf_write(f, "sub/b.jpg", even_jpg, sizeof even_jpg);
    assert_gltf_status(
        f,
        import_images(f, "{'extensions':{'KHR_texture_basisu':{'source':0}}}", "{'uri':'a.ktx2'}"),
        PPM_STATUS_OK);
    assert_null(image_of(f, false));
    assert_gltf_logged(f, 'W', "images[0]: left out (\"a.ktx2\"): it ends within its header");
    assert_gltf_status(
        f,
        import_images(f, "{'source':1,'extensions':{'KHR_texture_basisu':{'source':0}}}",
                      "{'uri':'a.ktx2'},{'uri':'b.jpg'}"),
        PPM_STATUS_OK);
    assert_is_even(f, 4);
}

static void bytes_decide_and_not_ending_or_type(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "sub/a.png", even_jpg, sizeof even_jpg);
    assert_gltf_status(f, import_image(f, "{'uri':'a.png','mimeType':'image/webp'}"),
                       PPM_STATUS_OK);
    assert_is_even(f, 4);
    char image[2048];
    snprintf(image, sizeof image, "{'uri':'data:image/png;base64,%s'}",
             gltf_data_uri(even_webp, sizeof even_webp) + strlen("data:;base64,"));
    assert_gltf_status(f, import_image(f, image), PPM_STATUS_OK);
    assert_is_even(f, 4);
}

static void write_floats(gltf_fixture *f, const char *name, float value, int32_t store)
{
    float pixels[2 * 2 * 3];
    for (int i = 0; i < 12; ++i)
        pixels[i] = value;
    const ppmi_image_file file = {
        .width = 2, .height = 2, .channels = 3, .pixels = pixels, .store = store};
    assert_int_equal(ppmi_imageio_write_file(f->context, gltf_path(f, name), &file), PPM_STATUS_OK);
}

static void sixteen_bits_keep_their_precision(void **state)
{
    gltf_fixture *f = *state;
    const float value = 4660.0f / 65535.0f;
    write_floats(f, "sub/a.png", value, PPMI_STORE_U16);
    assert_gltf_status(f, import_image(f, "{'uri':'a.png'}"), PPM_STATUS_OK);
    assert_true(fabsf(image_of(f, true)->f32[0] - value) < 0.01f / 65535.0f);
    const float linear = powf((value + 0.055f) / 1.055f, 2.4f); /* IEC 61966-2-1 */
    assert_true(fabsf(image_of(f, false)->f32[0] - linear) < 1e-5f);
}

static void openexr_images_hold_light_as_it_is(void **state)
{
    gltf_fixture *f = *state;
    write_floats(f, "sub/a.exr", 4.5f, PPMI_STORE_FLOAT);
    assert_gltf_status(f, import_image(f, "{'uri':'a.exr'}"), PPM_STATUS_OK);
    assert_true(image_of(f, false)->f32[0] == 4.5f);
    assert_true(image_of(f, true)->f32[0] == 4.5f);
}

/* ---- names and places ------------------------------------------------------------------------ */

static void names_may_be_encoded_or_not_or_in_part(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "sub/gr\xc3\xbcn \xe6\x9c\xa8 100%.jpg", even_jpg, sizeof even_jpg);
    static const char *const uris[] = {
        "gr\xc3\xbcn \xe6\x9c\xa8 100%.jpg", "gr%C3%BCn%20%E6%9C%A8%20100%25.jpg",
        "gr%c3%bcn \xe6\x9c\xa8%20100%.jpg", "gr\\u00fcn \\u6728 100%25.jpg",
        "./gr\xc3\xbcn%20\xe6\x9c\xa8 100%.jpg"};
    for (size_t i = 0; i < sizeof uris / sizeof uris[0]; ++i) {
        char image[128];
        snprintf(image, sizeof image, "{'uri':'%s'}", uris[i]);
        assert_gltf_status(f, import_image(f, image), PPM_STATUS_OK);
        assert_is_even(f, 4);
    }
}

static void files_outside_are_read_only_if_that_is_allowed(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "up.jpg", even_jpg, sizeof even_jpg);
    char images[5][160];
    snprintf(images[0], sizeof images[0], "{'uri':'../up.jpg'}");
    snprintf(images[1], sizeof images[1], "{'uri':'%s/up.jpg'}", f->folder);
    snprintf(images[2], sizeof images[2], "{'uri':'file://%s/up.jpg'}", f->folder);
    snprintf(images[3], sizeof images[3], "{'uri':'FILE:%s/%%75p.jpg'}", f->folder);
    snprintf(images[4], sizeof images[4], "{'uri':'file://localhost%s/up.jpg'}", f->folder);
    for (int i = 0; i < 5; ++i) {
        f->options.allow_outside = 0;
        assert_gltf_status(f, import_image(f, images[i]), PPM_STATUS_OK);
        assert_null(image_of(f, false));
        assert_gltf_logged(f, 'W', "files outside are allowed");
        f->options.allow_outside = 1;
        assert_gltf_status(f, import_image(f, images[i]), PPM_STATUS_OK);
        assert_is_even(f, 4);
    }
}

static void nothing_is_fetched_from_a_network(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *uri, *reason;
    } cases[] = {{"http://example.org/a.png", "save it beside the asset"},
                 {"HTTPS://example.org/a.png", "save it beside the asset"},
                 {"ftp://example.org/a.png", "only files are read"},
                 {"file://example.org/a.png", "no path of this machine"},
                 {"file:a.png", "no path of this machine"},
                 {"file:", "no path of this machine"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        for (uint32_t allowed = 0; allowed < 2; ++allowed) {
            char image[80];
            f->options.allow_outside = allowed;
            snprintf(image, sizeof image, "{'uri':'%s'}", cases[i].uri);
            assert_gltf_status(f, import_image(f, image), PPM_STATUS_OK);
            assert_null(image_of(f, false));
            if (allowed || i < 3) assert_gltf_logged(f, 'W', cases[i].reason);
        }
    }
}

/* ---- lies ------------------------------------------------------------------------------------ */

static void a_size_that_the_bytes_cannot_hold_is_refused(void **state)
{
    gltf_fixture *f = *state;
    unsigned char dds[sizeof even_dds];
    memcpy(dds, even_dds, sizeof dds);
    dds[13] = dds[17] = 0x75; /* 29956 x 29956 */
    gltf_write(f, "sub/a.dds", dds, sizeof dds);
    assert_gltf_status(f, import_image(f, "{'uri':'a.dds'}"), PPM_STATUS_OK);
    assert_null(image_of(f, false));
    assert_gltf_logged(f, 'W', "more than its 192 bytes can hold");

    unsigned char avif[sizeof even_avif];
    memcpy(avif, even_avif, sizeof avif);
    for (size_t i = 0; i + 16 < sizeof avif; ++i) {
        if (memcmp(avif + i, "ispe", 4) != 0) continue;
        memset(avif + i + 10, 0x7f, 2);
        memset(avif + i + 14, 0x7f, 2);
    }
    gltf_write(f, "sub/a.avif", avif, sizeof avif);
    assert_gltf_status(f, import_image(f, "{'uri':'a.avif'}"), PPM_STATUS_OK);
    assert_null(image_of(f, false));
    assert_gltf_logged(f, 'W', "2^26");
}

static void files_that_end_anywhere_are_survived(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const unsigned char *bytes;
        size_t count;
    } files[] = {{even_webp, sizeof even_webp},
                 {even_avif, sizeof even_avif},
                 {even_dds, sizeof even_dds},
                 {even_jpg, sizeof even_jpg}};
    for (int i = 0; i < 4; ++i) {
        for (size_t count = 0; count < files[i].count; count += 1 + files[i].count / 23) {
            gltf_write(f, "sub/a", files[i].bytes, count);
            assert_gltf_status(f, import_image(f, "{'uri':'a'}"), PPM_STATUS_OK);
        }
    }
}

/* ---- several at once ------------------------------------------------------------------------- */

/* Images of different sizes, good and bad ones in turn: ids and messages keep their order. */
static void ids_and_messages_do_not_depend_on_which_image_is_ready_first(void **state)
{
    gltf_fixture *f = *state;
    enum { COUNT = 24 };
    char images[COUNT * 40] = "", textures[COUNT * 20] = "", materials[COUNT * 90] = "",
                        primitives[COUNT * 60] = "";
    for (int i = 0; i < COUNT; ++i) {
        char name[32], part[96];
        const char *comma = i > 0 ? "," : "";
        snprintf(name, sizeof name, "sub/%d", i);
        if (i % 3 == 2) {
            gltf_write(f, name, even_jpg, 30);
        } else {
            gltf_write(f, name, i % 3 ? even_webp : even_jpg,
                       i % 3 ? sizeof even_webp : sizeof even_jpg);
        }
        snprintf(part, sizeof part, "%s{'uri':'%d'}", comma, i);
        strcat(images, part);
        snprintf(part, sizeof part, "%s{'source':%d}", comma, i);
        strcat(textures, part);
        snprintf(part, sizeof part, "%s{'pbrMetallicRoughness':{'baseColorTexture':{'index':%d}}}",
                 comma, i);
        strcat(materials, part);
        snprintf(part, sizeof part, "%s{'attributes':{'POSITION':0},'material':%d}", comma, i);
        strcat(primitives, part);
    }
    static char log[GLTF_LOG_SIZE];
    for (int round = 0; round < 8; ++round) {
        gltf_reset(f);
        assert_gltf_status(
            f,
            gltf_importf(f,
                         "{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],'materials':[%s],"
                         "'textures':[%s],'images':[%s],'meshes':[{'primitives':[%s]}],"
                         "'accessors':[{'bufferView':0,'componentType':5126,'count':3,"
                         "'type':'VEC3'}],'bufferViews':[{'buffer':0,'byteLength':36}],"
                         "'buffers':[{'byteLength':36,'uri':'data:;base64,"
                         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}]}",
                         materials, textures, images, primitives),
            PPM_STATUS_OK);
        assert_int_equal(f->scene->image_count, 2 * COUNT / 3);
        for (uint32_t i = 0; i < COUNT; ++i) {
            assert_int_equal(f->scene->materials[i].desc.base_color_texture.image,
                             i % 3 == 2 ? 0 : i - i / 3 + 1);
        }
        if (round > 0) assert_string_equal(f->log, log);
        memcpy(log, f->log, sizeof log);
    }
}

static void every_allocation_may_fail(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "sub/a", even_webp, sizeof even_webp);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 0;
    while (status == PPM_STATUS_OUT_OF_MEMORY) {
        gltf_reset(f);
        ppmi_alloc_fail_at(f->context, ++n);
        status = import_here(f, "{'source':1,'extensions':{'EXT_texture_webp':{'source':0}}}",
                             "{'uri':'a'},{'uri':'absent'}");
        ppmi_alloc_fail_at(f->context, 0);
        assert_true(n < 1000);
    }
    assert_gltf_status(f, status, PPM_STATUS_OK);
    assert_true(n > 30);
    assert_is_even(f, 4);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_size_that_the_bytes_cannot_hold_is_refused),
        TEST(files_that_end_anywhere_are_survived),
        TEST(every_allocation_may_fail),
        TEST(nothing_is_fetched_from_a_network),
        TEST(files_outside_are_read_only_if_that_is_allowed),
        TEST(names_may_be_encoded_or_not_or_in_part),
        TEST(extensions_name_webp_dds_and_avif_images),
        TEST(a_source_that_cannot_be_read_gives_way_to_the_plain_one),
        TEST(broken_ktx2_is_left_out_unless_there_is_another_image),
        TEST(bytes_decide_and_not_ending_or_type),
        TEST(sixteen_bits_keep_their_precision),
        TEST(openexr_images_hold_light_as_it_is),
        TEST(ids_and_messages_do_not_depend_on_which_image_is_ready_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
