/* importers/obj/obj_material.c: the mapping that docs/obj.md states. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "obj_fixture.h"

static void assert_color(const float *color, double r, double g, double b)
{
    assert_obj_near(color[0], r);
    assert_obj_near(color[1], g);
    assert_obj_near(color[2], b);
}

/* The reflectance at normal incidence and at grazing angles that a description stands for. */
static double f0(const ppm_material_desc *d, int channel)
{
    const double at_normal = (double)((d->ior - 1.0f) / (d->ior + 1.0f));
    return at_normal * at_normal * (double)(d->specular_color[channel] * d->specular);
}

static void kd_is_the_colour_of_a_dielectric(void **state)
{
    const ppm_material_desc *d =
        obj_import_material(*state, "Kd 0.25 0.5 0.75\nKs 0 0 0\nillum 2\n");
    assert_color(d->base_color, 0.25, 0.5, 0.75);
    assert_obj_near(d->base_color[3], 1.0);
    assert_obj_near(d->metallic, 0.0);
    assert_obj_near(d->transmission, 0.0);
    assert_int_equal(d->alpha_mode, PPM_ALPHA_OPAQUE);
    assert_int_equal(d->double_sided, 1);
    assert_obj_quiet((obj_fixture *)*state);
}

static void a_material_without_kd_is_grey(void **state)
{
    assert_color(obj_import_material(*state, "illum 1\n")->base_color, 0.8, 0.8, 0.8);
}

static void without_ks_a_material_is_lambert(void **state)
{
    const char *const dull[] = {"Kd 1 1 1\n", "Ks 0 0 0\n", "Ks 1 1 1\nillum 1\n",
                                "Ks 1 1 1\nillum 0\n"};
    for (size_t i = 0; i < 4; ++i) {
        assert_obj_near(obj_import_material(*state, dull[i])->specular, 0.0);
    }
}

static void ks_is_reflectance_in_steps_of_eight_percent(void **state)
{
    const ppm_material_desc *d = obj_import_material(*state, "Ks 0.5 0.5 0.5\n");
    assert_obj_near(f0(d, 0), 0.04);
    assert_obj_near(d->specular, 1.0);
    d = obj_import_material(*state, "Ks 1 0.5 0.25\n");
    assert_obj_near(f0(d, 0), 0.08);
    assert_obj_near(f0(d, 1), 0.04);
    assert_obj_near(f0(d, 2), 0.02);
    assert_obj_near(d->specular, 1.0);
    d = obj_import_material(*state, "Ks 0.05 0.05 0.05\nNi 2.5\n");
    assert_obj_near(f0(d, 0), 0.004);
    assert_obj_near(d->specular, 0.1); /* the reflectance at grazing angles */
}

static void ns_is_roughness_by_walter(void **state)
{
    assert_obj_near(obj_import_material(*state, "Ns 6\n")->roughness, sqrt(0.5));
    assert_obj_near(obj_import_material(*state, "Ns 0\n")->roughness, 1.0);
    assert_obj_near(obj_import_material(*state, "Ns 198\n")->roughness, sqrt(0.1));
    assert_obj_near(obj_import_material(*state, "Ns 1000\n")->roughness, 0.0);
    assert_obj_near(obj_import_material(*state, "Kd 1 1 1\n")->roughness, 0.5);
}

static void illum_3_and_5_are_mirrors_of_ks(void **state)
{
    const char *const mirrors[] = {"Kd 1 0 0\nKs 0.9 0.8 0.7\nNs 10\nillum 3\n",
                                   "Ks 0.9 0.8 0.7\nillum 5\nNi 2\n"};
    for (size_t i = 0; i < 2; ++i) {
        const ppm_material_desc *d = obj_import_material(*state, mirrors[i]);
        assert_obj_near(d->metallic, 1.0);
        assert_obj_near(d->roughness, 0.0);
        assert_color(d->base_color, 0.9, 0.8, 0.7);
    }
    const ppm_material_desc *d = obj_import_material(*state, "Kd 1 0 0\nKs 0 0 0\nillum 3\n");
    assert_obj_near(d->metallic, 0.0); /* it reflects nothing */
    assert_color(d->base_color, 1, 0, 0);
}

static void a_color_of_one_number_is_a_grey(void **state)
{
    const ppm_material_desc *d =
        obj_import_material(*state, "Kd 0.1 0.2 0.3\nKd 0.25\nKe 2\nKs 0 0 0\nillum 1\n");
    assert_color(d->base_color, 0.25, 0.25, 0.25);
    assert_color(d->emission, 2, 2, 2);
    d = obj_import_material(*state, "Kd 0.25\nKd 0.1 0.2 0.3\nillum 1\n");
    assert_color(d->base_color, 0.1, 0.2, 0.3);
}

static void a_color_by_spectrum_or_xyz_is_left_out(void **state)
{
    const ppm_material_desc *d =
        obj_import_material(*state, "Kd 0.1 0.2 0.3\nKd spectral red.rfl 1\nKd xyz 1 1 1\n");
    assert_color(d->base_color, 0.1, 0.2, 0.3);
}

static void illum_4_6_7_and_9_are_solid_glass(void **state)
{
    const char *const glasses[] = {
        "illum 4\nTf 1 0.5 0.25\nNi 1.33\n", "illum 6\nKd 0 0 0\nNi 1.33\nTf 1 0.5 0.25\nd 0\n",
        "illum 7\nTf 1 0.5 0.25\nNi 1.33\nd 0.1\n", "illum 9\nNi 1.33\nTf 1 0.5 0.25\n",
        "illum 2\nNi 1.33\nTf 1 0.5 0.25\nd 0.3\n"};
    for (size_t i = 0; i < 5; ++i) {
        const ppm_material_desc *d = obj_import_material(*state, glasses[i]);
        assert_obj_near(d->transmission, 1.0);
        assert_int_equal(d->transmission_kind, PPM_TRANSMISSION_SOLID);
        assert_obj_near(d->ior, 1.33);
        assert_obj_near(d->roughness, 0.0);
        assert_color(d->base_color, 1, 0.5, 0.25);
        assert_obj_near(d->base_color[3], 1.0);
        assert_int_equal(d->alpha_mode, PPM_ALPHA_OPAQUE);
    }
}

static void glass_without_ni_and_tf_is_clear_and_of_index_one_and_a_half(void **state)
{
    const char *const glasses[] = {"illum 4\n", "illum 7\nNi 1.0\nTf 0 0 0\n",
                                   "illum 9\nNi 0.001\n"};
    for (size_t i = 0; i < 3; ++i) {
        const ppm_material_desc *d = obj_import_material(*state, glasses[i]);
        assert_obj_near(d->ior, 1.5);
        assert_color(d->base_color, 1, 1, 1);
    }
    assert_obj_near(obj_import_material(*state, "illum 4\nNs 6\n")->roughness, sqrt(0.5));
}

static void an_opaque_material_with_tf_is_no_glass(void **state)
{
    assert_obj_near(obj_import_material(*state, "Tf 1 1 1\nd 1\nillum 2\n")->transmission, 0.0);
    assert_obj_near(obj_import_material(*state, "Tf 0 0 0\nd 0.5\n")->transmission, 0.0);
}

static void d_and_tr_are_alpha(void **state)
{
    const char *const alphas[] = {"d 0.25\n", "Tr 0.75\n", "d 0.25\nTr 0.5\n", "Tr 0.5\nd 0.25\n"};
    for (size_t i = 0; i < 4; ++i) {
        const ppm_material_desc *d = obj_import_material(*state, alphas[i]);
        assert_obj_near(d->base_color[3], 0.25);
        assert_int_equal(d->alpha_mode, PPM_ALPHA_BLEND);
    }
}

static void a_material_that_would_be_invisible_is_opaque(void **state)
{
    const char *const alphas[] = {"d 0\n", "Tr 1\n", "d -3\n"};
    for (size_t i = 0; i < 3; ++i) {
        const ppm_material_desc *d = obj_import_material(*state, alphas[i]);
        assert_obj_near(d->base_color[3], 1.0);
        assert_int_equal(d->alpha_mode, PPM_ALPHA_OPAQUE);
        assert_obj_logged((obj_fixture *)*state, 'W', "line 1: material 'm': d 0 or Tr 1");
    }
}

static void ke_is_radiance_in_nit(void **state)
{
    obj_fixture *f = *state;
    assert_color(obj_import_material(f, "Ke 10 20.5 1e3\nillum 2\n")->emission, 10, 20.5, 1000);
    assert_true(f->scene->materials[0].emits);
    assert_color(obj_import_material(f, "Ke -1 0 0\n")->emission, 0, 0, 0);
}

static void pr_and_pm_win_over_ns_and_illum(void **state)
{
    const ppm_material_desc *d =
        obj_import_material(*state, "Kd 0.9 0.5 0.1\nKs 1 1 1\nNs 3\nillum 3\nPr 0.25\nPm 1\n");
    assert_obj_near(d->metallic, 1.0);
    assert_obj_near(d->roughness, 0.25);
    assert_color(d->base_color, 0.9, 0.5, 0.1);
    d = obj_import_material(*state, "Pr 0\nNs 3\nPm 0\n");
    assert_obj_near(d->roughness, 0.0);
    assert_obj_near(d->metallic, 0.0);
    assert_obj_near(obj_import_material(*state, "Pr 0.5\nillum 4\n")->roughness, 0.5);
}

static void values_out_of_range_are_brought_into_it(void **state)
{
    const ppm_material_desc *d =
        obj_import_material(*state, "Kd 20 -1 1e999\nKs 9 9 9\nNs -5\nPm 7\nKe 1e999 0 0\nd 3\n");
    assert_color(d->base_color, 1, 0, 1);
    assert_obj_near(d->metallic, 1.0);
    assert_obj_near(d->roughness, 1.0);
    assert_obj_near(f0(d, 0), 0.08);
    assert_true(isfinite(d->emission[0]));
    assert_obj_near(d->base_color[3], 1.0);
}

static void mayas_materials_are_opaque(void **state)
{
    const ppm_material_desc *d =
        obj_import_material(*state, "illum 4\nKd 0.5 0.5 0.5\nKa 0 0 0\nTf 1 1 1\nNi 1.00\n");
    assert_obj_near(d->transmission, 0.0);
    assert_int_equal(d->alpha_mode, PPM_ALPHA_OPAQUE);
    d = obj_import_material(*state, "illum 4\nKd 0.5 0.5 0.5\nTf 0.25 0.25 0.25\nNi 1.00\n");
    assert_obj_near(d->transmission, 0.0);
    assert_obj_near(d->base_color[3], 0.25);
    assert_int_equal(d->alpha_mode, PPM_ALPHA_BLEND);
    /* any of the three says that it is meant */
    assert_obj_near(obj_import_material(*state, "illum 4\nTf 1 1 1\nNi 1.5\n")->transmission, 1.0);
    assert_obj_near(obj_import_material(*state, "illum 4\nTf 1 1 1\nNi 1\nd 0.5\n")->transmission,
                    1.0);
}

static void the_pbr_extension_has_sheen_and_a_clear_coat(void **state)
{
    const ppm_material_desc *d = obj_import_material(*state, "Ps 0.25\nPc 0.5\nPcr 0.125\n");
    assert_color(d->sheen_color, 0.25, 0.25, 0.25);
    assert_obj_near(d->sheen_roughness, 0.5);
    assert_obj_near(d->clearcoat, 0.5);
    assert_obj_near(d->clearcoat_roughness, 0.125);
    d = obj_import_material(*state, "Ps 0\nPc 0\nPcr 0.03\naniso 0\nanisor 0\n");
    assert_obj_near(d->sheen_color[0], 0.0);
    assert_obj_near(d->clearcoat, 0.0);
    assert_obj_near(d->anisotropy, 0.0);
    d = obj_import_material(*state, "Ps 7\nPc -1\n");
    assert_color(d->sheen_color, 1, 1, 1);
    assert_obj_near(d->clearcoat, 0.0);
}

static void anisotropy_is_turned_in_turns(void **state)
{
    const double pi = 3.14159265358979;
    const ppm_material_desc *d = obj_import_material(*state, "aniso 0.75\nanisor 0.125\n");
    assert_obj_near(d->anisotropy, 0.75);
    assert_obj_near(d->anisotropy_rotation_rad, 0.25 * pi);
    d = obj_import_material(*state, "aniso -0.5\n"); /* across */
    assert_obj_near(d->anisotropy, 0.5);
    assert_obj_near(d->anisotropy_rotation_rad, 0.5 * pi);
}

static void what_has_no_effect_is_told_once(void **state)
{
    obj_fixture *f = *state;
    obj_import_material(f, "decal a.png\nKa 1 1 1\nmap_Ka k.png\ndecal b.png\nodd 3\n");
    assert_obj_logged(f, 'W', "have no effect: decal, odd");
}

static void a_material_that_no_library_has_is_the_default(void **state)
{
    obj_fixture *f = *state;
    assert_obj_status(f, obj_import(f, OBJ_TRIANGLE "usemtl none\nf 1 2 3\ng a\nf 1 2 3\n"),
                      PPM_STATUS_OK);
    assert_int_equal(f->scene->material_count, 1);
    assert_string_equal(f->scene->materials[0].name, "(default)");
    const char *told = strstr(f->log, "usemtl 'none'");
    assert_non_null(told);
    assert_null(strstr(told + 1, "usemtl 'none'"));
}

/* The value that is meant, and a word about it. */
static void decimal_commas_are_read_with_a_warning(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d =
        obj_import_material(f, "Kd 0,5 0,25 1\nd 0,5\nNs 96,07\nKe 2,0,0,5,0\n");
    assert_obj_near(d->base_color[0], 0.5);
    assert_obj_near(d->base_color[1], 0.25);
    assert_obj_near(d->base_color[2], 1.0);
    assert_obj_near(d->base_color[3], 0.5);
    assert_obj_near(d->roughness, pow(2.0 / 98.07, 0.25));
    assert_obj_logged(f, 'W',
                      "scene.mtl: line 2: '0,5 0,25 1' is read as '0.5 0.25 1': 4 statements");
    assert_obj_near(obj_import_material(f, "Kd 1,0,0\n")->base_color[1], 0.0);
    assert_obj_logged(f, 'W', "'1,0,0' is read as '1 0 0'");
    assert_obj_near(obj_import_material(f, "Kd 0,5\n")->base_color[2], 0.5);
}

static void values_that_are_no_numbers_are_left_out(void **state)
{
    obj_fixture *f = *state;
    const char *const words[] = {"nan", "1.#IND", "x", "-1.#INF00"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        char text[256];
        snprintf(text, sizeof text, "Kd %s %s %s\nd %s\nNs %s\nPm %s\n", words[i], words[i],
                 words[i], words[i], words[i], words[i]);
        const ppm_material_desc *d = obj_import_material(f, text);
        assert_obj_near(d->base_color[0], 0.8); /* as without the statement */
        assert_obj_near(d->base_color[3], 1.0);
        assert_obj_near(d->roughness, 0.5);
        assert_obj_logged(f, 'W', "no effect: Kd ");
        assert_false(obj_logged(f, 'W', "opaque"));
    }
}

static void d_may_have_a_halo(void **state)
{
    obj_fixture *f = *state;
    assert_obj_near(obj_import_material(f, "d -halo 0.3\n")->base_color[3], 0.3);
    assert_obj_logged(f, 'W', "no effect: d -halo");
    assert_obj_near(obj_import_material(f, "d -halo 0,3 # thin\n")->base_color[3], 0.3);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, obj_setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(kd_is_the_colour_of_a_dielectric),
        TEST(a_material_without_kd_is_grey),
        TEST(without_ks_a_material_is_lambert),
        TEST(ks_is_reflectance_in_steps_of_eight_percent),
        TEST(ns_is_roughness_by_walter),
        TEST(illum_3_and_5_are_mirrors_of_ks),
        TEST(a_color_of_one_number_is_a_grey),
        TEST(a_color_by_spectrum_or_xyz_is_left_out),
        TEST(illum_4_6_7_and_9_are_solid_glass),
        TEST(glass_without_ni_and_tf_is_clear_and_of_index_one_and_a_half),
        TEST(an_opaque_material_with_tf_is_no_glass),
        TEST(d_and_tr_are_alpha),
        TEST(a_material_that_would_be_invisible_is_opaque),
        TEST(ke_is_radiance_in_nit),
        TEST(pr_and_pm_win_over_ns_and_illum),
        TEST(values_out_of_range_are_brought_into_it),
        TEST(mayas_materials_are_opaque),
        TEST(the_pbr_extension_has_sheen_and_a_clear_coat),
        TEST(anisotropy_is_turned_in_turns),
        TEST(what_has_no_effect_is_told_once),
        TEST(a_material_that_no_library_has_is_the_default),
        TEST(decimal_commas_are_read_with_a_warning),
        TEST(values_that_are_no_numbers_are_left_out),
        TEST(d_may_have_a_halo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
