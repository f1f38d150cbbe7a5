/* importers/obj/obj_bump.c and obj_tangent.c: heights as normal maps, and their tangents. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "obj_fixture.h"

enum { SIDE = 8 };

/* A grey PGM of SIDE x SIDE pixels that rise by `across` codes a column and `down` a row. */
static void write_ramp(obj_fixture *f, const char *name, int across, int down)
{
    unsigned char file[32 + SIDE * SIDE];
    const int header = snprintf((char *)file, sizeof file, "P5 %d %d 255\n", SIDE, SIDE);
    for (int y = 0; y < SIDE; ++y) {
        for (int x = 0; x < SIDE; ++x) {
            file[header + y * SIDE + x] = (unsigned char)(x * across + y * down);
        }
    }
    obj_write(f, name, file, (size_t)header + SIDE * SIDE);
}

static int setup(void **state)
{
    static const char blue[] = "P6 1 1 255\n\x80\x80\xff", grey[] = "P6 1 1 255\n\x80\x80\x80";
    const int result = obj_setup(state);
    if (result != 0) return result;
    write_ramp(*state, "sub/right.pgm", 30, 0);
    write_ramp(*state, "sub/below.pgm", 0, 30);
    obj_write(*state, "sub/blue.ppm", blue, sizeof blue - 1);
    obj_write(*state, "sub/grey.ppm", grey, sizeof grey - 1);
    return 0;
}

/* The normal in the middle of the material's normal map. */
static void middle_normal(obj_fixture *f, const ppm_material_desc *d, double out[3])
{
    float row[4 * SIDE];
    assert_int_not_equal(d->normal_texture.image, 0);
    assert_int_equal(ppm_scene_read_image_row(f->scene, d->normal_texture.image, SIDE / 2, row),
                     PPM_STATUS_OK);
    for (size_t i = 0; i < 3; ++i) {
        out[i] = 2.0 * (double)row[4 * (SIDE / 2) + i] - 1.0;
    }
}

/* 30 codes a pixel of a width of 8, at a hundredth of the width for a height of 1. */
static const double slope = 30.0 / 255.0 * 8.0 * 0.01;

static void heights_that_rise_to_the_right_lean_to_the_left(void **state)
{
    obj_fixture *f = *state;
    double n[3];
    middle_normal(f, obj_import_material(f, "bump right.pgm\n"), n);
    assert_obj_near(n[0] / n[2], -slope);
    assert_obj_near(n[1], 0.0);
    assert_obj_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0);
}

/* Y of a normal map points up, as v does in the file: rows that rise downwards lean up. */
static void heights_that_rise_downwards_lean_up(void **state)
{
    obj_fixture *f = *state;
    double n[3];
    middle_normal(f, obj_import_material(f, "map_Bump below.pgm\n"), n);
    assert_obj_near(n[1] / n[2], slope);
    assert_obj_near(n[0], 0.0);
}

static void bm_and_mm_scale_the_heights(void **state)
{
    obj_fixture *f = *state;
    double n[3];
    const ppm_material_desc *d = obj_import_material(f, "bump -bm 3 -mm 0 2 right.pgm\n");
    middle_normal(f, d, n);
    assert_obj_near(n[0] / n[2], -2.0 * slope);
    assert_obj_near(d->normal_scale, 3.0);
}

static void an_even_image_and_its_clamped_edge_are_flat(void **state)
{
    obj_fixture *f = *state;
    float row[4 * SIDE];
    const ppm_material_desc *d = obj_import_material(f, "bump grey.ppm\n");
    assert_int_equal(ppm_scene_read_image_row(f->scene, d->normal_texture.image, 0, row),
                     PPM_STATUS_OK);
    assert_obj_near(row[0], 0.5);
    assert_obj_near(row[2], 1.0);
    /* clamped, the edge has the slope of its neighbour; repeated, that of the jump to 0 */
    d = obj_import_material(f, "bump -clamp on right.pgm\n");
    ppm_scene_read_image_row(f->scene, d->normal_texture.image, 0, row);
    assert_obj_near((row[0] - 0.5f) / (row[2] - 0.5f), -slope);
    d = obj_import_material(f, "bump right.pgm\n");
    ppm_scene_read_image_row(f->scene, d->normal_texture.image, 0, row);
    assert_obj_near((row[0] - 0.5f) / (row[2] - 0.5f), 3.0 * slope);
}

static void what_looks_like_a_normal_map_is_one(void **state)
{
    obj_fixture *f = *state;
    float row[4];
    const ppm_material_desc *d = obj_import_material(f, "map_Bump -bm 0.5 blue.ppm\n");
    assert_obj_logged(f, 'I', "taken as the normal map it looks like");
    assert_int_equal(ppm_scene_read_image_row(f->scene, d->normal_texture.image, 0, row),
                     PPM_STATUS_OK);
    assert_obj_near(row[2], 1.0);
    assert_obj_near(row[0], 128.0 / 255.0);
    assert_obj_near(d->normal_scale, 0.5);
    /* one channel of it is a height */
    d = obj_import_material(f, "map_Bump -imfchan b blue.ppm\n");
    ppm_scene_read_image_row(f->scene, d->normal_texture.image, 0, row);
    assert_obj_near(row[0], 0.5);
}

static void norm_goes_before_bump_and_bump_before_disp(void **state)
{
    obj_fixture *f = *state;
    const ppm_material_desc *d =
        obj_import_material(f, "disp right.pgm\nbump below.pgm\nnorm -bm 2 blue.ppm\n");
    assert_int_equal(f->scene->image_count, 1);
    assert_obj_near(d->normal_scale, 2.0);
    assert_obj_logged(f, 'W', "bump has no effect beside norm");
    assert_obj_logged(f, 'W', "disp has no effect beside norm or bump");
    double n[3];
    middle_normal(f, obj_import_material(f, "disp right.pgm\n"), n);
    assert_obj_near(n[0] / n[2], -slope);
    assert_obj_logged(f, 'W', "1 displacement maps (disp) that are shown as bumps");
}

static void a_missing_bump_is_left_out(void **state)
{
    obj_fixture *f = *state;
    assert_int_equal(obj_import_material(f, "bump none.pgm\n")->normal_texture.image, 0);
    assert_int_equal(obj_import_material(f, "bump scene.mtl\n")->normal_texture.image, 0);
    assert_obj_logged(f, 'W', "scene.mtl: line 2: map_Bump 'scene.mtl': left out");
}

/* A square whose u grows along +y and whose v along -x. */
static const char turned[] =
    "mtllib scene.mtl\nusemtl m\n" OBJ_SQUARE "vt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
    "f 1/1/1 2/2/1 3/3/1 4/4/1\n";

static void tangents_point_along_growing_u(void **state)
{
    obj_fixture *f = *state;
    const char *const materials[] = {"newmtl m\nbump right.pgm\n", "newmtl m\naniso 0.5\n"};
    for (size_t i = 0; i < 2; ++i) {
        obj_write_text(f, "sub/scene.mtl", materials[i]);
        assert_obj_status(f, obj_import(f, turned), PPM_STATUS_OK);
        const ppmi_primitive *p = obj_only_primitive(f);
        assert_non_null(p->tangents);
        assert_obj_near(p->tangents[1], 1.0);
        assert_obj_near(p->tangents[3], 1.0); /* cross(+z, +y) is -x, where v grows */
    }
}

static void materials_without_a_use_for_tangents_have_none(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/scene.mtl", "newmtl m\nKd 1 1 1\n");
    assert_obj_status(f, obj_import(f, turned), PPM_STATUS_OK);
    assert_null(obj_only_primitive(f)->tangents);
}

/* Two squares with mirrored coordinates share an edge: its vertices have two tangents. */
static void vertices_are_split_where_coordinates_are_mirrored(void **state)
{
    obj_fixture *f = *state;
    obj_write_text(f, "sub/scene.mtl", "newmtl m\nbump right.pgm\n");
    assert_obj_status(f,
                      obj_import(f, "mtllib scene.mtl\nusemtl m\n" OBJ_SQUARE
                                    "v 2 0 0 1 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                    "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"
                                    "f 2/2/1 5/1/1 6/4/1 3/3/1\n"),
                      PPM_STATUS_OK);
    const ppmi_primitive *p = obj_only_primitive(f);
    assert_int_equal(p->vertex_count, 8);
    for (uint32_t i = 0; i < 3 * p->triangle_count; ++i) {
        const size_t v = p->indices[i];
        const bool is_right = p->positions[3 * (size_t)p->indices[3 * (i / 3)]] > 1.5f ||
                              p->positions[3 * (size_t)p->indices[3 * (i / 3) + 1]] > 1.5f ||
                              p->positions[3 * (size_t)p->indices[3 * (i / 3) + 2]] > 1.5f;
        assert_obj_near(p->tangents[4 * v], is_right ? -1.0 : 1.0);
        assert_obj_near(p->colors[4 * v], 1.0);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, obj_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(heights_that_rise_to_the_right_lean_to_the_left),
        TEST(heights_that_rise_downwards_lean_up),
        TEST(bm_and_mm_scale_the_heights),
        TEST(an_even_image_and_its_clamped_edge_are_flat),
        TEST(what_looks_like_a_normal_map_is_one),
        TEST(norm_goes_before_bump_and_bump_before_disp),
        TEST(a_missing_bump_is_left_out),
        TEST(tangents_point_along_growing_u),
        TEST(materials_without_a_use_for_tangents_have_none),
        TEST(vertices_are_split_where_coordinates_are_mirrored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
