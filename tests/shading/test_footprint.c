/* Footprints of eye paths, against what neighbouring paths really do: differences of traced rays.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "camera/camera.h"
#include "support/near.h"
#include "support/scenes.h"

static test_scene test;
static test_world world;
static ppmi_camera_view view;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    world_close(&world);
    scene_close(&test);
    return 0;
}

/* A camera at the origin that looks along -Z, 100 pixels wide. */
static void start_world(void)
{
    camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 0.8f);
    world_open(&world, &test);
    ppmi_camera_view_init(&test.scene->cameras[0], 100, 100, &view);
}

static ppm_material_id mirror(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.metallic = 1.0f;
    desc.roughness = 0.0f;
    return material_add(test.scene, &desc);
}

static ppm_material_id thin_glass(void)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.roughness = 0.0f;
    desc.transmission = 1.0f;
    desc.transmission_kind = PPM_TRANSMISSION_THIN;
    return material_add(test.scene, &desc);
}

/* A triangle, large around (0, 0, z), whose normals spread by spread (below 0: come together). */
static void add_lens_face(ppm_material_id material, float z, float spread)
{
    const float positions[9] = {-3, -2, z, 3, -2, z - 0.4f, 0, 4, z + 0.3f};
    float normals[9];
    static const uint32_t indices[3] = {0, 1, 2};
    for (int i = 0; i < 3; i++) {
        const ppmi_vec3 n =
            vec3(spread * positions[3 * i], 0.6f * spread * positions[3 * i + 1], 1);
        vec3_store(normals + 3 * i, vec3_normalize(n));
    }
    const ppm_primitive_desc primitive = {.vertex_count = 3,
                                          .triangle_count = 1,
                                          .positions = positions,
                                          .normals = normals,
                                          .indices = indices,
                                          .material = material};
    shape_place(test.scene, shape_mesh(test.scene, &primitive));
}

/* A target that is met at last, across the way. */
static void add_target(float z)
{
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-20, -20, z), vec3(40, 0, 0),
             vec3(0, 40, 0));
}

typedef struct path_end {
    ppmi_vec3 position;
    ppmi_differential differential;
    uint32_t bounces;
} path_end;

/* Follows a pixel's path; off what is smooth by reflection or transmission. */
static path_end follow(float x, float y, bool transmits)
{
    const ppmi_camera_ray start = ppmi_camera_view_ray(&view, x, y);
    ppmi_walker walker = {.world = &world.world};
    ppmi_walker_start(&walker, ppmi_rng_start(1, PPMI_STREAM_EYE, 0), 1, 0, 0, 0);
    walker.differential = (ppmi_differential){.is_known = true,
                                              .direction = start.ray.direction,
                                              .position_dx = start.position_dx,
                                              .position_dy = start.position_dy,
                                              .direction_dx = start.direction_dx,
                                              .direction_dy = start.direction_dy};
    ppmi_ray ray = start.ray;
    for (uint32_t bounces = 0; bounces < 10; bounces++) {
        ppmi_vertex vertex;
        assert_int_equal(ppmi_walk(&walker, ray, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(&walker, &vertex, ray.direction, &bsdf);
        ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
        const uint32_t count = ppmi_bsdf_branches(&bsdf, world.world.albedo, PPMI_LOBE_ALL,
                                                  PPMI_TRANSPORT_RADIANCE, samples);
        const ppmi_bsdf_sample *taken = NULL;
        for (uint32_t i = 0; i < count; i++) {
            if (samples[i].is_transmission == transmits) taken = &samples[i];
        }
        const bool is_target = (bsdf.lobes & PPMI_LOBE_GLASS) == 0 && bsdf.roughness > 0.0f;
        if (is_target || !taken) {
            return (path_end){vertex.surface.position, walker.differential, bounces};
        }
        ppmi_vec3 cost = vec3_splat(1.0f);
        ray = ppmi_walk_leave(&walker, &vertex, taken, &cost);
    }
    fail_msg("the path does not end");
    return (path_end){0};
}

/* The differential at a pixel is the difference of the paths a little beside it. */
static void check_pixel(float x, float y, bool transmits, uint32_t bounces)
{
    const float h = 0.2f;
    const path_end end = follow(x, y, transmits);
    assert_int_equal(end.bounces, bounces);
    const ppmi_vec3 dx = vec3_scale(
        vec3_sub(follow(x + h, y, transmits).position, follow(x - h, y, transmits).position),
        0.5f / h);
    const ppmi_vec3 dy = vec3_scale(
        vec3_sub(follow(x, y + h, transmits).position, follow(x, y - h, transmits).position),
        0.5f / h);
    const float tolerance = 3e-3f * ppmi_max(vec3_length(dx), vec3_length(dy));
    assert_true(tolerance > 0.0f);
    assert_near(vec3_length(vec3_sub(end.differential.position_dx, dx)), 0.0, tolerance);
    assert_near(vec3_length(vec3_sub(end.differential.position_dy, dy)), 0.0, tolerance);
}

static void check_pixels(bool transmits, uint32_t bounces)
{
    start_world();
    for (int i = 0; i < 5; i++)
        check_pixel(30.0f + 9.3f * (float)i, 35.0f + 7.1f * (float)i, transmits, bounces);
}

static void what_is_seen_straight(void **state)
{
    (void)state;
    add_lens_face(material_lambert(test.scene, 0.5f), -4.0f, 0.0f);
    check_pixels(false, 0);
}

static void an_orthographic_view(void **state)
{
    (void)state;
    add_lens_face(material_lambert(test.scene, 0.5f), -4.0f, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 0), vec3(0, 0, -1), 1.0f);
    world_open(&world, &test);
    ppmi_camera_view_init(&test.scene->cameras[0], 100, 100, &view);
    for (int i = 0; i < 5; i++)
        check_pixel(20.0f + 13.0f * (float)i, 42.0f, false, 0);
}

static void a_flat_mirror(void **state)
{
    (void)state;
    add_lens_face(mirror(), -4.0f, 0.0f);
    add_target(2.0f);
    check_pixels(false, 1);
}

static void a_mirror_that_spreads(void **state)
{
    (void)state;
    add_lens_face(mirror(), -4.0f, 0.2f);
    add_target(2.0f);
    check_pixels(false, 1);
}

static void a_mirror_that_collects(void **state)
{
    (void)state;
    add_lens_face(mirror(), -4.0f, -0.04f);
    add_target(2.0f);
    check_pixels(false, 1);
}

static void a_thin_sheet(void **state)
{
    (void)state;
    add_lens_face(thin_glass(), -4.0f, 0.1f);
    add_target(-6.0f);
    check_pixels(true, 1);
}

static void a_lens_of_glass(void **state)
{
    (void)state;
    add_lens_face(material_glass(test.scene, 1.5f, 0.0f), -4.0f, 0.15f);
    add_target(-9.0f);
    check_pixels(true, 1);
}

static void two_faces_of_glass(void **state)
{
    (void)state;
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    add_lens_face(glass, -4.0f, 0.1f);
    const float positions[9] = {-9, -9, -6, 0, 12, -6, 9, -9, -6.5f}; /* seen from behind */
    static const uint32_t indices[3] = {0, 1, 2};
    const ppm_primitive_desc back = {.vertex_count = 3,
                                     .triangle_count = 1,
                                     .positions = positions,
                                     .indices = indices,
                                     .material = glass};
    shape_place(test.scene, shape_mesh(test.scene, &back));
    add_target(-9.0f);
    check_pixels(true, 2);
}

/* Behind a sheet or off a mirror footprints go on growing as if there was nothing: on a wall at
 * twice the distance they are twice as large. */
static void footprints_go_on_growing(void **state)
{
    (void)state;
    add_lens_face(thin_glass(), -4.0f, 0.0f);
    add_target(-10.0f);
    start_world();
    const path_end behind = follow(50.0f, 50.0f, true);
    assert_int_equal(behind.bounces, 1);
    assert_near(vec3_length(behind.differential.position_dx), 10.0f * view.spread, 1e-4);
    assert_near(vec3_length(behind.differential.position_dy), 10.0f * view.spread, 1e-4);
}

/* A surface's own coordinates: uv runs once along each edge of the quad. */
static void a_surface_knows_its_footprint(void **state)
{
    (void)state;
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-4, -2, -5), vec3(8, 0, 0),
             vec3(0, 4, 0));
    start_world();
    for (int i = 0; i < 4; i++) { /* both triangles */
        const path_end end = follow(35.0f + 10.0f * (float)i, 45.0f + 3.0f * (float)i, false);
        ppmi_surface surface = world_hit(&world, vec3(0, 0, 0), vec3_normalize(end.position));
        ppmi_surface_set_footprint(&surface, end.differential.position_dx,
                                   end.differential.position_dy);
        const ppmi_vec2 here = ppmi_surface_uv(&surface, 0);
        surface.u += surface.uv_dx.x;
        surface.v += surface.uv_dx.y;
        const ppmi_vec2 right = ppmi_surface_uv(&surface, 0);
        assert_near(right.x - here.x, end.differential.position_dx.x / 8.0f, 1e-6);
        assert_near(right.y - here.y, end.differential.position_dx.y / 4.0f, 1e-6);
    }
}

static void photons_have_no_footprint(void **state)
{
    (void)state;
    add_target(-3.0f);
    start_world();
    const ppmi_surface surface = world_hit(&world, vec3(0, 0, 0), vec3(0, 0, -1));
    assert_near(surface.uv_dx.x, 0.0, 0.0);
    assert_near(surface.uv_dy.y, 0.0, 0.0);
}

static void rough_bounces_widen_with_the_breadth_of_the_lobe(void **state)
{
    (void)state;
    add_target(-3.0f);
    start_world();
    const float densities[] = {1e6f, 100.0f, 1.0f, 0.3f, 1e-4f, 0.0f};
    float before = 0.0f;
    for (int i = 0; i < 5; i++) {
        ppmi_differential d = {.is_known = true,
                               .direction = {0, 0, -1},
                               .direction_dx = {1e-3f, 0, 0},
                               .direction_dy = {0, 1e-3f, 0}};
        ppmi_differential_scatter(&d, vec3(0, 0, 1), densities[i]);
        const float spread = vec3_length(d.direction_dx);
        assert_true(spread >= before && spread >= 0.999e-3f && spread <= 1.0f);
        assert_near(vec3_dot(d.direction_dx, d.direction_dy), 0.0, 1e-6);
        before = spread;
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(what_is_seen_straight),
        TEST(an_orthographic_view),
        TEST(a_flat_mirror),
        TEST(a_mirror_that_spreads),
        TEST(a_mirror_that_collects),
        TEST(a_thin_sheet),
        TEST(a_lens_of_glass),
        TEST(two_faces_of_glass),
        TEST(footprints_go_on_growing),
        TEST(a_surface_knows_its_footprint),
        TEST(photons_have_no_footprint),
        TEST(rough_bounces_widen_with_the_breadth_of_the_lobe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
