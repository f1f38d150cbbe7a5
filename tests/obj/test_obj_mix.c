/* importers/obj/obj_mix.c, obj_picture.c and obj_material_maps.c: images made of maps. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "obj_fixture.h"

/* Pixels of 8 bits as a Targa file, row 0 on top; channels 1, 3 or 4. */
static void write_image(obj_fixture *f, const char *name, int width, int height, int channels,
                        const unsigned char *rgba)
{
    unsigned char file[18 + 4 * 64] = {0};
    size_t at = 18;
    file[2] = channels == 1 ? 3 : 2;
    file[12] = (unsigned char)width;
    file[14] = (unsigned char)height;
    file[16] = (unsigned char)(8 * channels);
    file[17] = channels == 4 ? 0x28 : 0x20; /* the first row is on top */
    for (int i = 0; i < width * height; ++i, rgba += channels) {
        if (channels == 1) {
            file[at++] = rgba[0];
            continue;
        }
        file[at++] = rgba[2];
        file[at++] = rgba[1];
        file[at++] = rgba[0];
        if (channels == 4) file[at++] = rgba[3];
    }
    obj_write(f, name, file, at);
}

static int setup(void **state)
{
    static const unsigned char colors[] = {200, 100, 50, 255, 0, 0}, greys[] = {51, 204};
    static const unsigned char others[] = {102, 255}, wide[] = {0, 0, 255, 255};
    static const unsigned char matte[] = {255, 255, 255, 51, 255, 255, 255, 204};
    const int result = obj_setup(state);
    if (result != 0) return result;
    write_image(*state, "sub/colors.tga", 2, 1, 3, colors);
    write_image(*state, "sub/greys.tga", 2, 1, 1, greys);
    write_image(*state, "sub/others.tga", 2, 1, 1, others);
    write_image(*state, "sub/wide.tga", 4, 1, 1, wide);
    write_image(*state, "sub/matte.tga", 2, 1, 4, matte);
    return 0;
}

static void assert_pixel(obj_fixture *f, ppm_image_id id, size_t x, double r, double g, double b,
                         double a)
{
    float row[4 * 8];
    const double expected[] = {r, g, b, a};
    assert_int_equal(ppm_scene_read_image_row(f->scene, id, 0, row), PPM_STATUS_OK);
    for (size_t i = 0; i < 4; ++i) {
        const double got = (double)row[4 * x + i];
        if (fabs(got - expected[i]) > 1.2 / 255.0) { /* half a step of sRGB near white */
            fail_msg("pixel %zu, channel %zu: %g, expected %g", x, i, got, expected[i]);
        }
    }
}

static double linear(int code)
{
    return pow((code / 255.0 + 0.055) / 1.055, 2.4);
}

static void map_d_is_the_alpha_of_the_colour(void **state)
{
    obj_fixture *f = *state;
    const char *const maps[] = {"map_Kd colors.tga\nmap_d greys.tga\n",
                                "map_Kd colors.tga\nmap_d matte.tga\n",
                                "map_Kd colors.tga\nmap_d -imfchan m matte.tga\n"};
    for (size_t i = 0; i < 3; ++i) {
        const ppm_material_desc *d = obj_import_material(f, maps[i]);
        assert_int_equal(d->alpha_mode, PPM_ALPHA_BLEND);
        assert_int_equal(f->scene->image_count, 1);
        assert_true(f->scene->images[0].is_srgb);
        assert_pixel(f, d->base_color_texture.image, 0, linear(200), linear(100), linear(50), 0.2);
        assert_pixel(f, d->base_color_texture.image, 1, 1, 0, 0, 0.8);
        assert_obj_quiet(f);
    }
}

static void map_d_alone_has_the_colour_of_kd(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d = obj_import_material(f, "Kd 0.5 0.25 0\nmap_d greys.tga\n");
    assert_pixel(f, d->base_color_texture.image, 0, 1, 1, 1, 0.2);
    assert_obj_near(d->base_color[0], 0.5);
}

static void map_d_of_the_colours_own_image_is_its_matte(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d = obj_import_material(f, "map_Kd matte.tga\nmap_d matte.tga\n");
    assert_pixel(f, d->base_color_texture.image, 0, 1, 1, 1, 0.2);
    d = obj_import_material(f, "map_Kd colors.tga\nmap_d colors.tga\n"); /* it has none */
    assert_pixel(f, d->base_color_texture.image, 1, 1, 0, 0, 1);
}

static void a_cut_out_is_no_glass(void **state)
{
    const ppm_material_desc *d =
        obj_import_material(*state, "illum 4\nTf 1 1 1\nd 1\nmap_Kd colors.tga\nmap_d greys.tga\n");
    assert_obj_near(d->transmission, 0.0);
    assert_int_equal(d->alpha_mode, PPM_ALPHA_BLEND);
}

static void roughness_and_metal_are_mixed_into_one_image(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d =
        obj_import_material(f, "map_Pr greys.tga\nmap_Pm others.tga\nPr 0.5\n");
    assert_pixel(f, d->metallic_roughness_texture.image, 0, 1, 0.2, 0.4, 1);
    assert_pixel(f, d->metallic_roughness_texture.image, 1, 1, 0.8, 1, 1);
    assert_obj_near(d->roughness, 0.5);
    assert_obj_near(d->metallic, 1.0);
    d = obj_import_material(f, "map_Pm others.tga\nPm 0.5\nPr 0.25\n");
    assert_pixel(f, d->metallic_roughness_texture.image, 0, 1, 1, 0.4, 1);
    assert_obj_near(d->roughness, 0.25);
    assert_obj_near(d->metallic, 0.5);
    d = obj_import_material(f, "map_Pm others.tga\nmap_Pr none.tga\n"); /* the value alone */
    assert_pixel(f, d->metallic_roughness_texture.image, 0, 1, 0.5, 0.4, 1);
    assert_obj_near(d->roughness, 1.0);
}

static void one_image_for_both_is_taken_as_it_is(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d = obj_import_material(f, "map_Pr colors.tga\nmap_Pm colors.tga\n");
    assert_pixel(f, d->metallic_roughness_texture.image, 0, 200 / 255.0, 100 / 255.0, 50 / 255.0,
                 1);
    assert_obj_near(d->metallic, 1.0);
    d = obj_import_material(f, "map_Pr -imfchan r colors.tga\nmap_Pm -imfchan g colors.tga\n");
    assert_pixel(f, d->metallic_roughness_texture.image, 0, 1, 200 / 255.0, 100 / 255.0, 1);
    d = obj_import_material(f, "map_Pr greys.tga\n"); /* grey, and nothing is metal */
    assert_pixel(f, d->metallic_roughness_texture.image, 1, 0.8, 0.8, 0.8, 1);
    assert_obj_near(d->metallic, 0.0);
}

static void map_ns_is_a_share_of_the_exponent(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d = obj_import_material(f, "Ns 100\nmap_Ns greys.tga\n");
    assert_pixel(f, d->metallic_roughness_texture.image, 0, 1, pow(2.0 / (20.0 + 2.0), 0.25), 1e-9,
                 1);
    assert_obj_near(d->roughness, 1.0);
    assert_obj_near(d->metallic, 0.0);
    d = obj_import_material(f, "Ns 100\nPr 0.25\nmap_Ns greys.tga\n"); /* Pr wins */
    assert_int_equal(d->metallic_roughness_texture.image, 0);
    assert_obj_near(d->roughness, 0.25);
}

static void mm_is_a_base_and_a_gain(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d = obj_import_material(f, "map_Kd -mm 0.1 0.5 colors.tga\n");
    assert_pixel(f, d->base_color_texture.image, 1, 0.6, 0.1, 0.1, 1);
    d = obj_import_material(f, "map_Pr -mm 1 -1 greys.tga\n"); /* turned round */
    assert_pixel(f, d->metallic_roughness_texture.image, 0, 1, 0.8, 0, 1);
}

static void imfchan_chooses_what_is_used(void **state)
{
    obj_fixture *f = *state;
    const double expected[] = {linear(200), linear(100), linear(50), 1.0,
                               0.2126 * linear(200) + 0.7152 * linear(100) + 0.0722 * linear(50)};
    for (size_t i = 0; i < 5; ++i) {
        char text[64];
        snprintf(text, sizeof text, "map_Kd -imfchan %c colors.tga\n", "rgbml"[i]);
        const ppm_material_desc *d = obj_import_material(f, text);
        const double x = expected[i];
        assert_pixel(f, d->base_color_texture.image, 0, x, x, x, 1);
    }
}

static void the_smaller_image_is_enlarged(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d = obj_import_material(f, "map_Pr wide.tga\nmap_Pm greys.tga\n");
    const ppm_image_id id = d->metallic_roughness_texture.image;
    assert_int_equal(f->scene->images[id - 1].width, 4);
    assert_pixel(f, id, 0, 1, 0, 0.2, 1);
    assert_pixel(f, id, 1, 1, 0, 0.2 * 0.75 + 0.8 * 0.25, 1);
    assert_pixel(f, id, 2, 1, 1, 0.2 * 0.25 + 0.8 * 0.75, 1);
    assert_pixel(f, id, 3, 1, 1, 0.8, 1);
}

static void maps_that_lie_differently_are_told(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d =
        obj_import_material(f, "map_Kd -s 2 2 colors.tga\nmap_d greys.tga\n");
    assert_true(d->base_color_texture.has_transform);
    assert_obj_logged(f, 'W', "map_d 'greys.tga': -s, -o and -clamp are taken from the map");
}

static void sheen_and_coat_have_maps(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d =
        obj_import_material(f, "map_Ps greys.tga\nmap_Pc greys.tga\nmap_Pcr greys.tga\nPcr 0.5\n");
    assert_int_equal(f->scene->image_count, 1);
    assert_int_equal(d->sheen_color_texture.image, 1);
    assert_int_equal(d->clearcoat_texture.image, 1);
    assert_int_equal(d->clearcoat_roughness_texture.image, 1);
    assert_obj_near(d->sheen_color[0], 1.0);
    assert_obj_near(d->clearcoat, 1.0);
    assert_obj_near(d->clearcoat_roughness, 0.5);
    d = obj_import_material(f, "map_Pc -imfchan g colors.tga\n");
    assert_pixel(f, d->clearcoat_texture.image, 0, 100 / 255.0, 100 / 255.0, 100 / 255.0, 1);
}

static void anisotropy_has_maps_of_strength_and_turn(void **state)
{
    obj_fixture *f = *state;
    const double pi = 3.14159265358979;
    const ppm_material_desc *d =
        obj_import_material(f, "map_aniso greys.tga\nmap_anisor others.tga\nanisor 0.5\n");
    const double angle = 2.0 * pi * 0.5 * 0.4;
    assert_pixel(f, d->anisotropy_texture.image, 0, 0.5 + 0.5 * cos(angle), 0.5 + 0.5 * sin(angle),
                 0.2, 1);
    assert_obj_near(d->anisotropy, 1.0);
    assert_obj_near(d->anisotropy_rotation_rad, 0.0);
    d = obj_import_material(f, "map_aniso greys.tga\naniso 0.5\nanisor 0.25\n");
    assert_pixel(f, d->anisotropy_texture.image, 1, 1, 0.5, 0.8, 1);
    assert_obj_near(d->anisotropy, 0.5);
    assert_obj_near(d->anisotropy_rotation_rad, 0.5 * pi);
}

static void glass_is_tinted_by_map_tf(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d = obj_import_material(f, "illum 7\nNi 1.4\nmap_Tf colors.tga\n");
    assert_obj_near(d->transmission, 1.0);
    assert_int_equal(d->base_color_texture.image, 1);
}

static void materials_of_the_same_maps_share_an_image(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/two.mtl",
                   "newmtl a\nmap_Kd colors.tga\nmap_d greys.tga\nnewmtl b\nmap_Kd colors.tga\n"
                   "map_d greys.tga\nnewmtl c\nmap_Kd colors.tga\nmap_d -mm 0 0.5 greys.tga\n");
    assert_obj_status(f,
                      obj_import(f, "mtllib two.mtl\n" OBJ_TRIANGLE "usemtl a\nf 1 2 3\nusemtl b\n"
                                    "f 1 2 3\nusemtl c\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->image_count, 2);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(map_d_is_the_alpha_of_the_colour),
        TEST(map_d_alone_has_the_colour_of_kd),
        TEST(map_d_of_the_colours_own_image_is_its_matte),
        TEST(a_cut_out_is_no_glass),
        TEST(roughness_and_metal_are_mixed_into_one_image),
        TEST(one_image_for_both_is_taken_as_it_is),
        TEST(map_ns_is_a_share_of_the_exponent),
        TEST(mm_is_a_base_and_a_gain),
        TEST(imfchan_chooses_what_is_used),
        TEST(the_smaller_image_is_enlarged),
        TEST(maps_that_lie_differently_are_told),
        TEST(sheen_and_coat_have_maps),
        TEST(anisotropy_has_maps_of_strength_and_turn),
        TEST(glass_is_tinted_by_map_tf),
        TEST(materials_of_the_same_maps_share_an_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
