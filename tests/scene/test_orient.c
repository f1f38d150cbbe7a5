/* Solids that are wound inside out. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

static test_scene test;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

/* A cube around the origin of half a side, moved along x. */
typedef struct cube {
    float half, x;
    bool is_inward, is_open;
} cube;

enum { MOST_CUBES = 300, VERTICES = 24, TRIANGLES = 12 };

static float positions[3 * VERTICES * MOST_CUBES];
static uint32_t indices[3 * TRIANGLES * MOST_CUBES];

/* Each face has corners of its own, as exporters write them. */
static uint32_t add_face(const cube *c, int face, uint32_t first, uint32_t *out)
{
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const float side = face % 2 ? 1.0f : -1.0f;
    for (uint32_t i = 0; i < 4; i++) {
        float *p = positions + 3 * (first + i);
        p[axis] = side * c->half;
        p[u] = i & 1 ? c->half : -c->half;
        p[v] = i & 2 ? c->half : -c->half;
        p[0] += c->x;
    }
    const bool turned = (face % 2 == 0) != c->is_inward;
    const uint32_t order[2][6] = {{0, 1, 2, 1, 3, 2}, {0, 2, 1, 1, 2, 3}};
    for (int i = 0; i < 6; i++)
        out[i] = first + order[turned][i];
    return 2;
}

static ppm_mesh_id add_cubes(const cube *cubes, uint32_t count, ppm_material_id material)
{
    uint32_t triangles = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (int face = 0; face < (cubes[i].is_open ? 5 : 6); face++) {
            triangles += add_face(&cubes[i], face, VERTICES * i + 4 * (uint32_t)face,
                                  indices + 3 * triangles);
        }
    }
    const ppm_primitive_desc primitive = {.vertex_count = VERTICES * count,
                                          .triangle_count = triangles,
                                          .positions = positions,
                                          .indices = indices,
                                          .material = material};
    return shape_mesh(test.scene, &primitive);
}

/* Of the cube's faces as the scene has them; first: its first triangle. */
static double volume(ppm_mesh_id mesh, uint32_t first, uint32_t count)
{
    const ppmi_primitive *primitive = &test.scene->meshes[mesh - 1].primitives[0];
    double sum = 0.0;
    for (uint32_t i = first; i < first + count; i++) {
        const uint32_t *t = primitive->indices + 3 * (size_t)i;
        const ppmi_vec3 a = vec3_load(primitive->positions + 3 * (size_t)t[0]);
        const ppmi_vec3 b = vec3_load(primitive->positions + 3 * (size_t)t[1]);
        const ppmi_vec3 c = vec3_load(primitive->positions + 3 * (size_t)t[2]);
        sum += (double)vec3_dot(a, vec3_cross(b, c)) / 6.0;
    }
    return sum;
}

/* Signs of the cubes' volumes, as "+-+". */
static void assert_signs(const cube *cubes, uint32_t count, ppm_material_id material,
                         const char *expected)
{
    const ppm_mesh_id mesh = add_cubes(cubes, count, material);
    uint32_t first = 0, turned;
    assert_int_equal(ppm_scene_turn_solids(test.scene, &turned), PPM_STATUS_OK);
    char found[MOST_CUBES + 1] = "";
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t triangles = cubes[i].is_open ? 10 : 12;
        found[i] = volume(mesh, first, triangles) > 0.0 ? '+' : '-';
        first += triangles;
    }
    assert_string_equal(found, expected);
}

static void a_closed_solid_that_is_inside_out_is_turned(void **state)
{
    (void)state;
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    assert_signs((const cube[]){{1, 0, true, false}}, 1, glass, "+");
    assert_signs((const cube[]){{1, 5, true, false}}, 1, glass, "+");
    assert_signs((const cube[]){{1, 0, false, false}}, 1, glass, "+");
    uint32_t turned;
    add_cubes((const cube[]){{1, 0, true, false}}, 1, glass);
    assert_int_equal(ppm_scene_turn_solids(test.scene, &turned), PPM_STATUS_OK);
    assert_int_equal(turned, 1);
    assert_int_equal(ppm_scene_turn_solids(test.scene, &turned), PPM_STATUS_OK);
    assert_int_equal(turned, 0);
}

static void open_surfaces_and_other_materials_stay(void **state)
{
    (void)state;
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    assert_signs((const cube[]){{1, 0, true, true}}, 1, glass, "-");
    assert_signs((const cube[]){{1, 0, true, false}}, 1, material_lambert(test.scene, 0.5f), "-");
}

static void cavities_stay_cavities(void **state)
{
    (void)state;
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    const cube hollow[] = {{1, 0, false, false}, {0.5f, 0, true, false}};
    assert_signs(hollow, 2, glass, "+-");
    const cube hollow_inside_out[] = {{0.5f, 0, false, false}, {1, 0, true, false}};
    assert_signs(hollow_inside_out, 2, glass, "-+");
    /* a drop in a bubble in glass, and a cube beside it that is wound the other way */
    const cube nested[] = {{0.25f, 0.1f, true, false},
                           {1, 4, false, false},
                           {1, 0, true, false},
                           {0.5f, 0, false, false},
                           {1, -4, true, false}};
    assert_signs(nested, 5, glass, "+++-+");
    /* an open one around it does not count */
    const cube in_open[] = {{2, 0, false, true}, {1, 0, true, false}};
    assert_signs(in_open, 2, glass, "++");
}

static void a_cavity_that_is_a_mesh_of_its_own_stays_one(void **state)
{
    (void)state;
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    const ppm_mesh_id outer = add_cubes((const cube[]){{1, 0, true, false}}, 1, glass);
    const ppm_mesh_id hollow = add_cubes((const cube[]){{0.5f, 0, true, false}}, 1, glass);
    const ppm_mesh_id beside = add_cubes((const cube[]){{0.5f, 0, true, false}}, 1, glass);
    shape_place_at(test.scene, outer, vec3(3, 0, 0));
    shape_place_at(test.scene, hollow, vec3(3.2f, 0.1f, 0));
    shape_place_at(test.scene, beside, vec3(4.6f, 0, 0));
    uint32_t turned;
    assert_int_equal(ppm_scene_turn_solids(test.scene, &turned), PPM_STATUS_OK);
    assert_int_equal(turned, 2);
    assert_true(volume(outer, 0, 12) > 0.0);
    assert_true(volume(hollow, 0, 12) < 0.0);
    assert_true(volume(beside, 0, 12) > 0.0);
}

/* Many bubbles, each of which asks which shell it is in. */
static void a_row_of_bubbles_stays(void **state)
{
    (void)state;
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    static cube cubes[MOST_CUBES];
    char expected[MOST_CUBES + 1] = "";
    cubes[0] = (cube){100, 0, true, false};
    expected[0] = '+';
    for (int i = 1; i < MOST_CUBES; i++) {
        cubes[i] = (cube){0.2f, (float)i * 0.5f - 75.0f, false, false};
        expected[i] = '-';
    }
    assert_signs(cubes, MOST_CUBES, glass, expected);
}

static void new_vertices_and_materials_are_looked_at_again(void **state)
{
    (void)state;
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    const ppm_mesh_id mesh = add_cubes((const cube[]){{1, 0, false, false}}, 1, glass);
    shape_place(test.scene, mesh);
    ppm_primitive_desc mirrored = {.vertex_count = VERTICES, .positions = positions};
    for (int i = 0; i < VERTICES; i++)
        positions[3 * i] *= -1.0f;
    assert_int_equal(ppm_scene_set_mesh_vertices(test.scene, mesh, 0, &mirrored), PPM_STATUS_OK);
    camera_perspective(test.scene, vec3(0, 0, 5), vec3(0, 0, 0), 0.6f);
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 4, 0);
    ppm_render *render;
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    ppm_render_destroy(render);
    assert_near(volume(mesh, 0, 12), 8.0, 1e-6);

    const ppm_material_id other = material_lambert(test.scene, 0.5f);
    const ppm_mesh_id grey = add_cubes((const cube[]){{1, 0, true, false}}, 1, other);
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.transmission_kind = PPM_TRANSMISSION_SOLID;
    assert_int_equal(ppm_scene_set_material(test.scene, other, &desc), PPM_STATUS_OK);
    assert_int_equal(ppm_render_create(test.scene, &options, &render), PPM_STATUS_OK);
    ppm_render_destroy(render);
    assert_near(volume(grey, 0, 12), 8.0, 1e-6);
}

/* Coloured glass before a sky, with the camera outside and inside. */
static void it_looks_as_if_it_were_wound_right(void **state)
{
    (void)state;
    double means[2][2];
    for (int inward = 0; inward < 2; inward++) {
        for (int inside = 0; inside < 2; inside++) {
            scene_close(&test);
            scene_open(&test);
            ppm_material_desc desc;
            ppm_material_desc_init(&desc);
            desc.transmission = 1.0f;
            desc.transmission_kind = PPM_TRANSMISSION_SOLID;
            desc.attenuation_distance_m = 1.0f;
            desc.attenuation_color[1] = 0.5f;
            const cube one = {1, 0, inward == 1, false};
            shape_place(test.scene, add_cubes(&one, 1, material_add(test.scene, &desc)));
            light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
            camera_perspective(test.scene, vec3(0.1f, 0.2f, inside ? 0.0f : 4.0f), vec3(0, 0, -2),
                               0.3f);
            const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 8, 0);
            means[inward][inside] = render_green(test.scene, &options, 16, 4).mean;
        }
    }
    for (int inside = 0; inside < 2; inside++)
        assert_near(means[0][inside], means[1][inside], 0.02);
    assert_near(means[1][0], 0.3, 0.06);               /* two metres, and reflections */
    assert_near(means[1][1], 0.5 * 2.25 * 0.96, 0.08); /* one, and radiance in glass */
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_closed_solid_that_is_inside_out_is_turned),
        WITH_SCENE(open_surfaces_and_other_materials_stay),
        WITH_SCENE(cavities_stay_cavities),
        WITH_SCENE(a_cavity_that_is_a_mesh_of_its_own_stays_one),
        WITH_SCENE(a_row_of_bubbles_stays),
        WITH_SCENE(new_vertices_and_materials_are_looked_at_again),
        WITH_SCENE(it_looks_as_if_it_were_wound_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
