/* importers/obj/obj_texture.c: maps, their files and their options. */
#include <string.h>

#include "obj_fixture.h"

static const char image[] = "P6 1 1 255\nabc";

static int setup(void **state)
{
    const int result = obj_setup(state);
    if (result == 0) {
        obj_write(*state, "sub/a.ppm", image, sizeof image - 1);
        obj_write(*state, "sub/b 2.ppm", image, sizeof image - 1);
        obj_write(*state, "sub/Maps/C.ppm", image, sizeof image - 1);
        obj_write(*state, "outside.ppm", image, sizeof image - 1);
    }
    return result;
}

static void maps_have_the_role_of_their_statement(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d =
        obj_import_material(f, "Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nmap_Kd a.ppm\nmap_Ks a.ppm\nmap_Ke "
                               "a.ppm\nnorm -bm 2 a.ppm\n");
    assert_int_equal(f->scene->image_count, 2); /* once as colour, once as data */
    assert_int_equal(d->base_color_texture.image, 1);
    assert_int_equal(d->specular_color_texture.image, 1);
    assert_int_equal(d->emission_texture.image, 1);
    assert_int_equal(d->normal_texture.image, 2);
    assert_true(f->scene->images[0].is_srgb);
    assert_false(f->scene->images[1].is_srgb);
    assert_obj_near(d->normal_scale, 2.0);
    assert_obj_near(d->base_color[0], 0.5);
    assert_obj_near(d->emission[0], 1.0); /* no Ke: the map alone */
    assert_obj_quiet(f);
}

static void a_map_on_black_kd_shows(void **state)
{
    assert_obj_near(obj_import_material(*state, "Kd 0 0 0\nmap_Kd a.ppm\n")->base_color[1], 1.0);
    assert_obj_near(obj_import_material(*state, "map_Kd a.ppm\n")->base_color[1], 1.0);
}

static void names_may_hold_blanks(void **state)
{
    const ppm_material_desc *d = obj_import_material(*state, "map_Kd -clamp on b 2.ppm \n");
    assert_int_equal(d->base_color_texture.image, 1);
    assert_int_equal(d->base_color_texture.wrap_u, PPM_WRAP_CLAMP);
    assert_int_equal(d->base_color_texture.wrap_v, PPM_WRAP_CLAMP);
    assert_int_equal(obj_import_material(*state, "map_Kd a.ppm\n")->base_color_texture.wrap_u,
                     PPM_WRAP_REPEAT);
}

static void scale_and_offset_are_of_coordinates_with_v_up(void **state)
{
    const char *const forms[] = {"map_Kd -s 2 4 1 -o 0.25 0.5 0 a.ppm\n",
                                 "map_Kd -s 2 4 -o 0.25 0.5 a.ppm\n"};
    for (size_t i = 0; i < 2; ++i) {
        const ppm_texture t = obj_import_material(*state, forms[i])->base_color_texture;
        assert_int_equal(t.image, 1);
        assert_true(t.has_transform);
        /* the point (0.5, 0.75) of the file: 2 u + 0.25, 4 v + 0.5 */
        const float u = 0.5f, v = 1.0f - 0.75f, *m = t.uv_transform;
        assert_obj_near(m[0] * u + m[1] * v + m[2], 1.25);
        assert_obj_near(m[3] * u + m[4] * v + m[5], 1.0 - 3.5);
    }
}

static void options_with_fewer_numbers_do_not_eat_the_name(void **state)
{
    const char *const forms[] = {"map_Kd -s 2 a.ppm\n", "map_Kd -o 1 a.ppm\n",
                                 "map_Kd -t 0 0 a.ppm\n", "map_Kd -s 2 -o 1 1 -clamp off a.ppm\n"};
    for (size_t i = 0; i < 4; ++i) {
        assert_int_equal(obj_import_material(*state, forms[i])->base_color_texture.image, 1);
    }
}

static void options_without_effect_are_told(void **state)
{
    obj_import_material(*state, "map_Kd -mm 0.5 2 -t 1 1 1 a.ppm\n");
    assert_obj_logged((obj_fixture *)*state, 'W', "-mm has no effect");
    assert_obj_logged((obj_fixture *)*state, 'W', "-t (turbulence) has no effect");
}

static void a_map_that_is_elsewhere_is_found_in_the_folder(void **state)
{
    obj_fixture *f = *state;
    const char *const names[] = {"map_Kd C:\\textures\\a.ppm\n", "map_Kd /x/A.PPM\n",
                                 "map_Kd ..\\a.ppm\n", "map_Kd maps\\c.PPM\n"};
    for (size_t i = 0; i < 4; ++i) {
        assert_int_equal(obj_import_material(f, names[i])->base_color_texture.image, 1);
        assert_obj_logged(f, 'W', "read from");
    }
    assert_int_equal(obj_import_material(f, "map_Kd Maps\\C.ppm\n")->base_color_texture.image, 1);
    assert_obj_quiet(f);
}

static void maps_are_relative_to_their_library_first(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/Maps/l.mtl", "newmtl m\nmap_Kd C.ppm\nmap_Ke ../a.ppm\n");
    assert_obj_status(f, obj_import(f, "mtllib Maps/l.mtl\nusemtl m\n" OBJ_TRIANGLE "f 1 2 3\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->image_count, 2);
    assert_obj_quiet(f);
}

static void missing_and_broken_images_are_left_out(void **state)
{
    obj_fixture *f = *state;
    const char *const names[] = {"map_Kd none.png\n", "map_Kd ../outside.ppm\n", "map_Kd Maps\n",
                                 "map_Kd scene.mtl\n"};
    for (size_t i = 0; i < 4; ++i) {
        assert_int_equal(obj_import_material(f, names[i])->base_color_texture.image, 0);
        assert_obj_logged(f, 'W', "sub/scene.mtl: line 1: map_Kd");
        assert_obj_logged(f, 'W', "left out");
    }
}

static void the_alpha_of_map_kd_is_used_if_map_d_names_it(void **state)
{
    obj_fixture *f = *state;
    assert_int_equal(obj_import_material(f, "map_Kd a.ppm\nmap_d a.ppm\n")->alpha_mode,
                     PPM_ALPHA_BLEND);
    assert_obj_quiet(f);
    assert_int_equal(obj_import_material(f, "map_Kd a.ppm\nmap_d b 2.ppm\n")->alpha_mode,
                     PPM_ALPHA_OPAQUE);
    assert_obj_logged(f, 'W', "map_d has no effect");
    assert_int_equal(obj_import_material(f, "map_Kd a.ppm\n")->alpha_mode, PPM_ALPHA_OPAQUE);
}

static void roughness_and_metal_come_from_one_image(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d = obj_import_material(f, "map_Pr a.ppm\n");
    assert_int_equal(d->metallic_roughness_texture.image, 1);
    assert_obj_near(d->roughness, 1.0);
    assert_obj_near(d->metallic, 0.0);
    d = obj_import_material(f, "map_Pr a.ppm\nmap_Pm a.ppm\nPr 0.5\n");
    assert_int_equal(d->metallic_roughness_texture.image, 1);
    assert_obj_near(d->roughness, 0.5);
    assert_obj_near(d->metallic, 1.0);
    d = obj_import_material(f, "map_Pr a.ppm\nmap_Pm b 2.ppm\nPm 0.5\nPr 0.5\n");
    assert_int_equal(d->metallic_roughness_texture.image, 0);
    assert_obj_near(d->metallic, 0.5);
    assert_obj_logged(f, 'W', "map_Pr and map_Pm have no effect");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(maps_have_the_role_of_their_statement),
        TEST(a_map_on_black_kd_shows),
        TEST(names_may_hold_blanks),
        TEST(scale_and_offset_are_of_coordinates_with_v_up),
        TEST(options_with_fewer_numbers_do_not_eat_the_name),
        TEST(options_without_effect_are_told),
        TEST(a_map_that_is_elsewhere_is_found_in_the_folder),
        TEST(maps_are_relative_to_their_library_first),
        TEST(missing_and_broken_images_are_left_out),
        TEST(the_alpha_of_map_kd_is_used_if_map_d_names_it),
        TEST(roughness_and_metal_come_from_one_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
