/* importers/obj/obj_texture.c: maps, their files and their options. */
#include <stdio.h>
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

static void what_is_behind_a_name_is_no_part_of_it_where_there_is_no_such_file(void **state)
{
    obj_fixture *f = *state;
    const char *const statements[] = {
        "norm a.ppm -bm 2\n",    "norm a.ppm # fine\n",       "norm a.ppm -bm 2 # fine\n",
        "norm b #1.ppm\n",       "norm b #1.ppm -bm 2\n",     "norm b #1.ppm -bm 2 # fine\n",
        "norm c -bm 3\n",        "norm \"b #1.ppm\" -bm 2\n", "norm -bm 2 a.ppm -clamp on # x\n",
        "norm b 2.ppm # a # b\n"};
    const float scales[] = {2, 1, 2, 1, 2, 2, 1, 2, 2, 1};
    obj_write(f, "sub/b #1.ppm", image, sizeof image - 1);
    obj_write(f, "sub/c -bm 3", image, sizeof image - 1);
    for (size_t i = 0; i < sizeof statements / sizeof statements[0]; ++i) {
        const ppm_material_desc *d = obj_import_material(f, statements[i]);
        if (d->normal_texture.image != 1) fail_msg("%s%s", statements[i], f->log);
        assert_obj_near(d->normal_scale, scales[i]);
        assert_obj_quiet(f);
    }
    obj_import_material(f, "norm missing.ppm -bm 2 # fine\n");
    assert_obj_logged(f, 'W', "line 2: norm 'missing.ppm -bm 2 # fine': left out");
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
    obj_import_material(*state, "map_Kd -t 1 1 1 a.ppm\n");
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
        assert_obj_logged(f, 'W', "sub/scene.mtl: line 2: map_Kd");
        assert_obj_logged(f, 'W', "left out");
    }
}

static void images_and_libraries_are_looked_for_in_the_texture_paths(void **state)
{
    obj_fixture *f = *state;
    char folders[2][96];
    snprintf(folders[0], sizeof folders[0], "%s", obj_path(f, "nowhere"));
    snprintf(folders[1], sizeof folders[1], "%s", obj_path(f, ""));
    const char *const list[] = {folders[0], folders[1]};
    const char *const names[] = {"map_Kd outside.ppm\n", "map_Kd D:\\maps\\OUTSIDE.PPM\n",
                                 "map_Kd /home/x/outside.ppm\n"};
    for (size_t i = 0; i < 3; ++i) {
        f->options.texture_folders = list;
        f->options.texture_folder_count = 2;
        assert_int_equal(obj_import_material(f, names[i])->base_color_texture.image, 1);
        assert_obj_logged(f, 'W', "read from");
        f->options.texture_folder_count = 1;
        assert_int_equal(obj_import_material(f, names[i])->base_color_texture.image, 0);
    }
    /* what a library there names lies beside it */
    obj_write_text(f, "other.mtl", "newmtl m\nmap_Kd outside.ppm\n");
    f->options.texture_folder_count = 2;
    assert_obj_status(f, obj_import(f, "mtllib other.mtl\nusemtl m\n" OBJ_TRIANGLE "f 1 2 3\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->image_count, 1);
    assert_obj_logged(f, 'W', "mtllib 'other.mtl': read from");
}

static void the_end_of_a_path_is_looked_for_with_its_folders(void **state)
{
    obj_fixture *f = *state;
    obj_write(f, "sub/C.ppm", image, sizeof image - 1);
    assert_int_equal(
        obj_import_material(f, "map_Kd C:\\project\\maps\\c.ppm\n")->base_color_texture.image, 1);
    assert_obj_logged(f, 'W', "sub/Maps/C.ppm");
}

static void paths_outside_are_read_only_if_allowed(void **state)
{
    obj_fixture *f = *state;
    char absolute[128];
    snprintf(absolute, sizeof absolute, "map_Kd %s\n", obj_path(f, "outside.ppm"));
    const char *const names[] = {"map_Kd ../outside.ppm\n", absolute};
    for (size_t i = 0; i < 2; ++i) {
        f->options.allow_outside = 0;
        assert_int_equal(obj_import_material(f, names[i])->base_color_texture.image, 0);
        f->options.allow_outside = 1;
        assert_int_equal(obj_import_material(f, names[i])->base_color_texture.image, 1);
        assert_obj_quiet(f);
    }
}

static void blending_that_is_off_shows_the_pixels(void **state)
{
    const char *const maps[] = {"map_Kd -blendu off -blendv off a.ppm\n",
                                "map_Kd -blendu off a.ppm\n", "map_Kd -blendv on a.ppm\n"};
    for (size_t i = 0; i < 3; ++i) {
        assert_int_equal(obj_import_material(*state, maps[i])->base_color_texture.filter,
                         i == 0 ? PPM_FILTER_NEAREST : PPM_FILTER_LINEAR);
    }
}

static void a_map_that_is_missing_leaves_the_value(void **state)
{
    obj_fixture *f = *state;
    assert_obj_near(obj_import_material(f, "Kd 0 0 0\nmap_Kd no.ppm\n")->base_color[0], 0.0);
    const ppm_material_desc *d =
        obj_import_material(f, "Pr 0.25\nmap_Pm no.ppm\nmap_Pc no.ppm\nmap_aniso no.ppm\n");
    assert_obj_near(d->metallic, 0.0);
    assert_obj_near(d->roughness, 0.25);
    assert_obj_near(d->clearcoat, 0.0);
    assert_obj_near(d->anisotropy, 0.0);
    assert_int_equal(obj_import_material(f, "map_d no.ppm\n")->alpha_mode, PPM_ALPHA_OPAQUE);
}

static void reflection_maps_are_told(void **state)
{
    obj_import_material(*state, "refl -type sphere -mm 0 1 clouds.mpc\n");
    assert_obj_logged((obj_fixture *)*state, 'W', "reflections are traced");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(maps_have_the_role_of_their_statement),
        TEST(a_map_on_black_kd_shows),
        TEST(names_may_hold_blanks),
        TEST(what_is_behind_a_name_is_no_part_of_it_where_there_is_no_such_file),
        TEST(scale_and_offset_are_of_coordinates_with_v_up),
        TEST(options_with_fewer_numbers_do_not_eat_the_name),
        TEST(options_without_effect_are_told),
        TEST(a_map_that_is_elsewhere_is_found_in_the_folder),
        TEST(maps_are_relative_to_their_library_first),
        TEST(missing_and_broken_images_are_left_out),
        TEST(images_and_libraries_are_looked_for_in_the_texture_paths),
        TEST(the_end_of_a_path_is_looked_for_with_its_folders),
        TEST(paths_outside_are_read_only_if_allowed),
        TEST(blending_that_is_off_shows_the_pixels),
        TEST(a_map_that_is_missing_leaves_the_value),
        TEST(reflection_maps_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
