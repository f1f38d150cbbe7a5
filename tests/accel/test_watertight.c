/* No ray slips out of a closed mesh, and no ray that leaves a surface meets it again: from
 * millimetres to ten kilometres, near the origin and far from it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static const float scales[] = {1e-3f, 1.0f, 1e2f, 1e4f};
/* Distance from the origin in sizes of the object. */
static const float offsets[] = {0.0f, 10.0f, 1000.0f};

static ppmi_vec3 random_direction(ppmi_rng *rng)
{
    const float u = ppmi_rng_float(rng), v = ppmi_rng_float(rng);
    return vec3_normalize(ppmi_sample_sphere(u, v));
}

typedef struct closed_mesh {
    test_scene test;
    test_world world;
    ppmi_vec3 center;
    float size;
} closed_mesh;

enum { BOX, BALL, SHAPES };

/* The mesh is scaled in its own coordinates or by the instance, and moved by the instance. */
static void open_mesh(closed_mesh *mesh, int shape, float scale, float offset, bool by_instance)
{
    scene_open(&mesh->test);
    ppm_scene *scene = mesh->test.scene;
    const float own = by_instance ? 1.0f : scale, factor = by_instance ? scale : 1.0f;
    const ppm_mesh_id id = shape == BOX ? shape_box(scene, 0, vec3_splat(-0.5f * own),
                                                    vec3_splat(0.5f * own), 20, true)
                                        : shape_sphere(scene, 0, 0.5f * own, 40, false);
    mesh->center = vec3_scale(vec3(0.6f, -0.64f, 0.48f), offset * scale);
    mesh->size = scale;
    const float c = cosf(0.3f) * factor, s = sinf(0.3f) * factor;
    const float transform[16] = {
        c, s, 0, 0, -s, c, 0, 0, 0, 0, factor, 0, mesh->center.x, mesh->center.y, mesh->center.z,
        1};
    shape_place_by(scene, id, transform);
    world_open(&mesh->world, &mesh->test);
}

static void close_mesh(closed_mesh *mesh)
{
    world_close(&mesh->world);
    scene_close(&mesh->test);
}

typedef void (*check)(closed_mesh *mesh, ppmi_rng *rng);

static void for_all_meshes(check run)
{
    ppmi_rng rng = ppmi_rng_start(17, PPMI_STREAM_EYE, 0);
    for (int shape = 0; shape < SHAPES; shape++) {
        for (int s = 0; s < 4; s++) {
            for (int o = 0; o < 3; o++) {
                closed_mesh mesh;
                open_mesh(&mesh, shape, scales[s], offsets[o], (s + o) % 2 == 0);
                run(&mesh, &rng);
                close_mesh(&mesh);
            }
        }
    }
}

static void check_rays_from_inside(closed_mesh *mesh, ppmi_rng *rng)
{
    const uint32_t count = TEST_EFFORT(100000);
    for (uint32_t i = 0; i < count; i++) {
        /* from the middle to the middle: edges and corners of the tessellation are all met */
        const ppmi_vec3 from = vec3_scale(random_direction(rng), 0.1f * mesh->size);
        const ppmi_ray ray = {.origin = vec3_add(mesh->center, from),
                              .t_max = INFINITY,
                              .direction = random_direction(rng)};
        ppmi_hit hit;
        assert_true(ppmi_accel_intersect(mesh->world.accel, &ray, &hit));
    }
}

static void rays_from_inside_never_escape(void **state)
{
    (void)state;
    for_all_meshes(check_rays_from_inside);
}

/* A point of an edge, in the world. Vertices themselves are left out: of rays that meet one to the
 * last bit Embree lets about one in 10^4 through, its robust mode too. */
static ppmi_vec3 point_on_edge(const ppm_scene *scene, ppmi_rng *rng)
{
    const ppmi_primitive *primitive = &scene->meshes[0].primitives[0];
    const uint32_t triangle = ppmi_rng_u32(rng) % primitive->triangle_count;
    const uint32_t corner = ppmi_rng_u32(rng) % 3;
    const uint32_t *indices = primitive->indices + 3 * (size_t)triangle;
    const ppmi_vec3 a = vec3_load(primitive->positions + 3 * (size_t)indices[corner]);
    const ppmi_vec3 b = vec3_load(primitive->positions + 3 * (size_t)indices[(corner + 1) % 3]);
    const float t = 0.01f + 0.98f * ppmi_rng_float(rng);
    return ppmi_transform_point(&scene->instances[0].to_world, vec3_lerp(a, b, t));
}

static void check_rays_at_edges(closed_mesh *mesh, ppmi_rng *rng)
{
    const uint32_t count = TEST_EFFORT(100000);
    for (uint32_t i = 0; i < count; i++) {
        const ppmi_vec3 from = vec3_scale(random_direction(rng), 0.1f * mesh->size);
        const ppmi_vec3 origin = vec3_add(mesh->center, from);
        const ppmi_vec3 target = point_on_edge(mesh->test.scene, rng);
        const ppmi_ray ray = {.origin = origin,
                              .t_max = INFINITY,
                              .direction = vec3_normalize(vec3_sub(target, origin))};
        ppmi_hit hit;
        assert_true(ppmi_accel_intersect(mesh->world.accel, &ray, &hit));
    }
}

static void rays_at_edges_never_escape(void **state)
{
    (void)state;
    for_all_meshes(check_rays_at_edges);
}

/* Distance of a hit from the nearest edge of its triangle. */
static float distance_to_edge(const ppmi_surface *surface)
{
    const uint32_t *indices = surface->primitive->indices + 3 * (size_t)surface->triangle;
    ppmi_vec3 p[3];
    for (int k = 0; k < 3; k++) {
        p[k] = ppmi_transform_point(&surface->instance->to_world,
                                    vec3_load(surface->primitive->positions + 3 * indices[k]));
    }
    const float doubled_area = vec3_length(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0])));
    const float weights[3] = {1.0f - surface->u - surface->v, surface->u, surface->v};
    float least = INFINITY;
    for (int k = 0; k < 3; k++) {
        const float side = vec3_length(vec3_sub(p[(k + 1) % 3], p[(k + 2) % 3]));
        least = ppmi_min(least, weights[k] * doubled_area / side);
    }
    return least;
}

/* From a point on the inside, to the inside: the triangle itself must not be met again, and the
 * other side must. Closer to an edge than the error bound two walls meet, and the offset of one
 * does not clear the other: such points are left out. */
static void check_leaving_rays(closed_mesh *mesh, ppmi_rng *rng)
{
    const uint32_t count = TEST_EFFORT(50000);
    for (uint32_t i = 0; i < count; i++) {
        const ppmi_ray first = {
            .origin = mesh->center, .t_max = INFINITY, .direction = random_direction(rng)};
        ppmi_hit hit;
        assert_true(ppmi_accel_intersect(mesh->world.accel, &first, &hit));
        ppmi_surface surface;
        ppmi_surface_from_hit(mesh->test.scene, &hit, &surface);
        if (distance_to_edge(&surface) < 2.0f * surface.error) continue;
        const float side = vec3_dot(surface.ng, first.direction) < 0.0f ? 1.0f : -1.0f;
        const ppmi_frame frame = ppmi_frame_from_normal(vec3_scale(surface.ng, side));
        const float grazing = i % 4 == 0 ? 1e-3f : i % 4 == 1 ? 0.05f : 1.0f;
        const float cosine = grazing * (0.1f + 0.9f * ppmi_rng_float(rng));
        const ppmi_vec3 inwards = ppmi_direction_at(cosine, ppmi_rng_float(rng));
        const ppmi_ray ray =
            ppmi_surface_ray(&surface, vec3_normalize(ppmi_frame_to_world(&frame, inwards)));
        ppmi_hit again;
        assert_true(ppmi_accel_intersect(mesh->world.accel, &ray, &again));
        assert_int_not_equal(again.triangle, hit.triangle);
        /* and to the outside: nothing there */
        const ppmi_vec3 outwards = vec3(inwards.x, inwards.y, -inwards.z);
        const ppmi_ray out =
            ppmi_surface_ray(&surface, vec3_normalize(ppmi_frame_to_world(&frame, outwards)));
        assert_false(ppmi_accel_intersect(mesh->world.accel, &out, &again) &&
                     again.triangle == hit.triangle);
    }
}

static void rays_that_leave_a_surface_do_not_meet_it_again(void **state)
{
    (void)state;
    for_all_meshes(check_leaving_rays);
}

/* The offset must stay small against what is there to be seen. */
static void check_offset(closed_mesh *mesh, ppmi_rng *rng)
{
    for (int i = 0; i < 100; i++) {
        const ppmi_ray ray = {
            .origin = mesh->center, .t_max = INFINITY, .direction = random_direction(rng)};
        ppmi_hit hit;
        assert_true(ppmi_accel_intersect(mesh->world.accel, &ray, &hit));
        ppmi_surface surface;
        ppmi_surface_from_hit(mesh->test.scene, &hit, &surface);
        const float extent = ppmi_max(vec3_max_abs(mesh->center), mesh->size);
        assert_true(surface.error > 0.0f && surface.error <= 1e-5f * extent);
    }
}

static void the_offset_follows_the_coordinates(void **state)
{
    (void)state;
    for_all_meshes(check_offset);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_from_inside_never_escape),
        cmocka_unit_test(rays_at_edges_never_escape),
        cmocka_unit_test(rays_that_leave_a_surface_do_not_meet_it_again),
        cmocka_unit_test(the_offset_follows_the_coordinates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
