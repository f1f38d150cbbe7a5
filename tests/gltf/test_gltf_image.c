/* importers/gltf/gltf_image.c: where images come from, and what happens without them. */
#include <stdio.h>

#include "gltf_fixture.h"

/* 1 x 1, black, 8 bits of RGB */
static const unsigned char png[] = {
    0x89, 'P',  'N',  'G',  '\r', '\n', 0x1a, '\n', 0,   0,    0,    13,   'I',  'H',
    'D',  'R',  0,    0,    0,    1,    0,    0,    0,   1,    8,    2,    0,    0,
    0,    0x90, 0x77, 0x53, 0xde, 0,    0,    0,    12,  'I',  'D',  'A',  'T',  0x78,
    0x9c, 0x63, 0x60, 0x60, 0x60, 0,    0,    0,    4,   0,    1,    0xf6, 0x17, 0x38,
    0x55, 0,    0,    0,    0,    'I',  'E',  'N',  'D', 0xae, 0x42, 0x60, 0x82};

/* Imports a triangle whose material has a base colour texture. */
static ppm_status import_images(gltf_fixture *f, const char *material, const char *textures,
                                const char *images)
{
    gltf_reset(f);
    return gltf_importf(
        f,
        "{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],'materials':[{%s}],"
        "'textures':[%s],'images':[%s],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
        "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':1,'byteLength':%zu},"
        "{'buffer':1,'byteLength':%zu}],"
        "'buffers':[{'byteLength':36,'uri':'data:;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'},{'byteLength':%zu,'uri':'%s'}]}",
        material, textures, images, sizeof png, sizeof png + 1, sizeof png,
        gltf_data_uri(png, sizeof png));
}

#define BASE_COLOR "'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}"

static uint32_t base_color_image(const gltf_fixture *f)
{
    assert_int_equal(f->scene->instance_count, 1);
    return f->scene->materials[0].desc.base_color_texture.image;
}

static void images_come_from_buffer_views_data_and_files(void **state)
{
    gltf_fixture *f = *state;
    char data_image[256];
    snprintf(data_image, sizeof data_image, "{'uri':'%s'}", gltf_data_uri(png, sizeof png));
    gltf_write(f, "sub/a b.png", png, sizeof png);
    const char *images[] = {"{'bufferView':1,'mimeType':'image/png'}", data_image,
                            "{'uri':'a%20b.png'}", "{'uri':'a b.png'}"};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; ++i) {
        assert_gltf_status(f, import_images(f, BASE_COLOR, "{'source':0}", images[i]),
                           PPM_STATUS_OK);
        assert_int_equal(base_color_image(f), 1);
        assert_int_equal(f->scene->images[0].width, 1);
        assert_true(f->scene->images[0].is_srgb);
    }
}

static void an_image_is_added_once_per_role(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        import_images(f,
                      "'pbrMetallicRoughness':{'baseColorTexture':{'index':0},"
                      "'metallicRoughnessTexture':{'index':1}},'emissiveTexture':{'index':2},"
                      "'normalTexture':{'index':0}",
                      "{'source':0},{'source':0},{'source':0}", "{'bufferView':1}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->image_count, 2);
    const ppm_material_desc *m = &f->scene->materials[0].desc;
    assert_int_equal(m->base_color_texture.image, m->emission_texture.image);
    assert_int_equal(m->metallic_roughness_texture.image, m->normal_texture.image);
    assert_int_not_equal(m->base_color_texture.image, m->normal_texture.image);
    assert_false(f->scene->images[m->normal_texture.image - 1].is_srgb);
}

static void images_that_nothing_uses_are_not_decoded(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f, import_images(f, "", "{'source':0}", "{'bufferView':1},{'uri':'absent.png'}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->image_count, 0);
    assert_false(gltf_logged(f, 'W', "images["));
}

static void images_that_cannot_be_had_are_left_out_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    gltf_write(f, "up.png", png, sizeof png);
    gltf_write(f, "sub/broken.png", png, 40);
    gltf_write(f, "sub/empty.png", png, 0);
    char absolute[200];
    snprintf(absolute, sizeof absolute, "{'uri':'%s/up.png'}", f->folder);
    const char *images[] = {"{'uri':'absent.png'}",
                            "{'uri':'../up.png'}",
                            "{'uri':'%2e%2e/up.png'}",
                            "{'uri':'broken.png'}",
                            "{'uri':'empty.png'}",
                            "{'uri':'.'}",
                            "{'bufferView':2}",
                            "{'bufferView':99}",
                            "{'bufferView':0}",
                            "{}",
                            "{'uri':7}",
                            "5",
                            "{'uri':'http://x/a.png'}",
                            "{'uri':'data:;base64,AAAA'}",
                            "{'uri':'data:;base64,'}",
                            absolute};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; ++i) {
        assert_gltf_status(f, import_images(f, BASE_COLOR, "{'source':0}", images[i]),
                           PPM_STATUS_OK);
        assert_int_equal(base_color_image(f), 0);
        assert_true(gltf_logged(f, 'W', "images[0]") || gltf_logged(f, 'W', "textures[0]"));
    }
}

/* All of the file but the last bytes, which say that it ends. */
static void a_png_without_its_end_is_shown_unless_strict(void **state)
{
    gltf_fixture *f = *state;
    for (size_t lost = 1; lost <= 12; lost += 11) {
        gltf_write(f, "sub/cut.png", png, sizeof png - lost);
        f->options.strict = 0;
        assert_gltf_status(f, import_images(f, BASE_COLOR, "{'source':0}", "{'uri':'cut.png'}"),
                           PPM_STATUS_OK);
        assert_int_not_equal(base_color_image(f), 0);
        assert_gltf_logged(f, 'W', "images[0]: the PNG file ends at byte ");
        f->options.strict = 1;
        assert_gltf_status(f, import_images(f, BASE_COLOR, "{'source':0}", "{'uri':'cut.png'}"),
                           PPM_STATUS_INPUT_UNSUPPORTED);
    }
}

static void a_strict_import_refuses_what_is_left_out_of_a_material(void **state)
{
    gltf_fixture *f = *state;
    f->options.strict = 1;
    assert_gltf_status(f, import_images(f, BASE_COLOR, "{'source':0}", "{'uri':'absent.png'}"),
                       PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'W', "textures without an image that can be read: textures[0]");
}

static void a_webp_source_that_fails_gives_way_to_the_plain_one(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       import_images(f, BASE_COLOR,
                                     "{'source':1,'extensions':{'EXT_texture_webp':{'source':0}}}",
                                     "{'uri':'absent.webp'},{'bufferView':1}"),
                       PPM_STATUS_OK);
    assert_int_equal(base_color_image(f), 1);
}

static void a_plain_source_is_taken_before_ktx2(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        import_images(f, BASE_COLOR,
                      "{'source':1,'extensions':{'KHR_texture_basisu':{'source':0}}}",
                      "{'uri':'absent.ktx2'},{'bufferView':1}"),
        PPM_STATUS_OK);
    assert_int_equal(base_color_image(f), 1);
    assert_false(gltf_logged(f, 'W', "images[0]"));
}

static void textures_that_are_missing_or_empty_are_warned_about(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_images(f, BASE_COLOR, "{}", "{'bufferView':1}"), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "textures[0]: left out: the texture names no image");
    assert_gltf_status(f, import_images(f, BASE_COLOR, "", ""), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "baseColorTexture: left out: textures[0] does not exist");
    assert_gltf_status(f, import_images(f, BASE_COLOR, "{'source':4}", ""), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "textures[0]: left out: images[4] does not exist");
}

static void a_sampler_that_does_not_exist_is_warned_about(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       import_images(f, BASE_COLOR, "{'source':0,'sampler':3}", "{'bufferView':1}"),
                       PPM_STATUS_OK);
    assert_int_equal(base_color_image(f), 1);
    assert_gltf_logged(f, 'W', "samplers[3] does not exist");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(images_come_from_buffer_views_data_and_files),
        TEST(an_image_is_added_once_per_role),
        TEST(images_that_nothing_uses_are_not_decoded),
        TEST(images_that_cannot_be_had_are_left_out_with_a_warning),
        TEST(a_webp_source_that_fails_gives_way_to_the_plain_one),
        TEST(a_png_without_its_end_is_shown_unless_strict),
        TEST(a_strict_import_refuses_what_is_left_out_of_a_material),
        TEST(a_plain_source_is_taken_before_ktx2),
        TEST(textures_that_are_missing_or_empty_are_warned_about),
        TEST(a_sampler_that_does_not_exist_is_warned_about),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
