/* Normals that differ from the geometry, by interpolation over coarse meshes or by normal maps: the
 * photon methods render what the path tracer does. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "statistical/methods.h"
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

/* Left are sppm, and ppm with photons for direct light. */
enum { LEFT_OUT = METHODS_OF_OTHER_RADII | 1 << 2 | 1 << 5 };

/* A quad whose normals lean over by an angle, as by a normal map of one colour. */
static void add_leaning_quad(ppm_material_id material, ppmi_vec3 origin, ppmi_vec3 edge_u,
                             ppmi_vec3 edge_v, float angle_rad)
{
    const ppmi_vec3 up = vec3_normalize(vec3_cross(edge_u, edge_v)), along = vec3_normalize(edge_u);
    const ppmi_vec3 n = vec3_mad(vec3_scale(up, cosf(angle_rad)), along, sinf(angle_rad));
    const ppmi_vec3 corners[4] = {origin, vec3_add(origin, edge_u),
                                  vec3_add(vec3_add(origin, edge_u), edge_v),
                                  vec3_add(origin, edge_v)};
    float positions[12], normals[12];
    for (int i = 0; i < 4; i++) {
        vec3_store(positions + 3 * i, corners[i]);
        vec3_store(normals + 3 * i, n);
    }
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const ppm_primitive_desc primitive = {.positions = positions,
                                          .normals = normals,
                                          .vertex_count = 4,
                                          .indices = indices,
                                          .triangle_count = 2,
                                          .material = material};
    shape_place(test.scene, shape_mesh(test.scene, &primitive));
}

static void agree_in_box(uint64_t photons, double resolution)
{
    const method_comparison how = {.width = 60,
                                   .path_passes = 32,
                                   .passes = 8,
                                   .photons = photons,
                                   .radius_m = 0.02f,
                                   .bias = 0.01,
                                   .resolution = resolution,
                                   .seeds = 8,
                                   .left_out = LEFT_OUT};
    methods_agree(test.scene, &how);
}

/* Floor and walls of the box are covered by leaning quads. */
static void lean_everywhere(const ppm_material_desc *desc, float angle_rad)
{
    add_lit_box(test.scene, vec3(0.6f, 0.5f, 0.7f), vec3(0, -0.2f, -1));
    const ppm_material_id material = material_add(test.scene, desc);
    const float a = 0.98f, b = 2.0f * a;
    add_leaning_quad(material, vec3(-a, -a, a), vec3(b, 0, 0), vec3(0, 0, -b), angle_rad);
    add_leaning_quad(material, vec3(-a, -a, a), vec3(0, 0, -b), vec3(0, b, 0), angle_rad);
    add_leaning_quad(material, vec3(a, -a, -a), vec3(0, 0, b), vec3(0, b, 0), angle_rad);
}

static void matte_walls_lean_by_12_degrees(void **state)
{
    (void)state;
    const ppm_material_desc desc = material_desc_rgb(vec3(0.8f, 0.6f, 0.7f), 0.0f, 1.0f);
    lean_everywhere(&desc, 0.21f);
    agree_in_box(20000, 0.03);
}

static void matte_walls_lean_by_45_degrees(void **state)
{
    (void)state;
    ppm_material_desc desc = material_desc_rgb(vec3(0.8f, 0.6f, 0.7f), 0.0f, 1.0f);
    desc.specular = 0.0f;
    lean_everywhere(&desc, 0.785f);
    agree_in_box(20000, 0.03);
}

static void rough_metal_leans_by_30_degrees(void **state)
{
    (void)state;
    const ppm_material_desc desc = material_desc_rgb(vec3(0.9f, 0.7f, 0.5f), 1.0f, 0.6f);
    lean_everywhere(&desc, 0.52f);
    agree_in_box(40000, 0.05);
}

static void a_coarse_smooth_ball_under_a_sky(void **state)
{
    (void)state;
    ppm_scene *scene = test.scene;
    light_environment(scene, vec3_splat(1.0f), 0, 0.0f);
    add_quad(scene, material_lambert_rgb(scene, vec3(0.7f, 0.6f, 0.5f)), vec3(-2, 0, -2),
             vec3(0, 0, 4), vec3(4, 0, 0));
    shape_place_at(scene, shape_sphere(scene, material_lambert(scene, 0.8f), 0.5f, 6, true),
                   vec3(0, 0.6f, 0));
    camera_perspective(scene, vec3(0, 0.6f, 2.0f), vec3(0, 0.5f, 0), 0.7f);
    const method_comparison how = {.width = 60,
                                   .path_passes = 32,
                                   .passes = 8,
                                   .photons = 40000,
                                   .radius_m = 0.02f,
                                   .bias = 0.01,
                                   .resolution = 0.03,
                                   .seeds = 8,
                                   .left_out = LEFT_OUT};
    methods_agree(scene, &how);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(a_coarse_smooth_ball_under_a_sky),
        WITH_SCENE(matte_walls_lean_by_12_degrees),
        WITH_SCENE(matte_walls_lean_by_45_degrees),
        WITH_SCENE(rough_metal_leans_by_30_degrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
