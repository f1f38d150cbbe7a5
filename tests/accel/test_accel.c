/* Hits on instances against geometry by hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/scenes.h"

static ppmi_ray ray_from(ppmi_vec3 origin, ppmi_vec3 direction)
{
    return (ppmi_ray){.origin = origin, .t_max = INFINITY, .direction = direction};
}

static void an_empty_scene_is_never_hit(void **state)
{
    (void)state;
    test_scene test;
    scene_open(&test);
    const ppm_mesh_desc nothing = {.size = sizeof nothing};
    ppm_mesh_id mesh;
    assert_int_equal(ppm_scene_add_mesh(test.scene, &nothing, &mesh), PPM_STATUS_OK);
    shape_place(test.scene, mesh);
    test_world world;
    world_open(&world, &test);
    const ppmi_ray ray = ray_from(vec3_splat(0.0f), vec3(0, 0, 1));
    ppmi_hit hit;
    assert_false(ppmi_accel_intersect(world.accel, &ray, &hit));
    assert_false(ppmi_accel_occluded(world.accel, &ray));
    world_close(&world);
    scene_close(&test);
}

/* Hits name instance, primitive and triangle, and u, v belong to the second and third vertex. */
static void hits_name_what_they_hit(void **state)
{
    (void)state;
    test_scene test;
    scene_open(&test);
    static const float positions[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 3, 0, 0, 2, 1, 0};
    static const uint32_t first[3] = {0, 1, 2};
    static const uint32_t both[6] = {0, 1, 2, 3, 4, 5};
    const ppm_primitive_desc primitives[2] = {
        {.vertex_count = 6, .triangle_count = 1, .positions = positions, .indices = first},
        {.vertex_count = 6, .triangle_count = 2, .positions = positions, .indices = both}};
    const ppm_primitive_desc away = primitives[0];
    const ppm_mesh_id one = shape_mesh(test.scene, &away);
    const ppm_mesh_desc desc = {
        .size = sizeof desc, .primitive_count = 2, .primitives = primitives};
    ppm_mesh_id two;
    assert_int_equal(ppm_scene_add_mesh(test.scene, &desc, &two), PPM_STATUS_OK);
    shape_place_at(test.scene, one, vec3(0, 0, 10));
    shape_place_at(test.scene, two, vec3(0, 0, -10));
    test_world world;
    world_open(&world, &test);
    ppmi_hit hit;
    ppmi_ray ray = ray_from(vec3(2.25f, 0.5f, 0.0f), vec3(0, 0, -2));
    assert_true(ppmi_accel_intersect(world.accel, &ray, &hit));
    assert_int_equal(hit.instance, 1);
    assert_int_equal(hit.primitive, 1);
    assert_int_equal(hit.triangle, 1);
    assert_near(hit.u, 0.25, 1e-6);
    assert_near(hit.v, 0.5, 1e-6);
    assert_near(hit.t, 5.0, 1e-5);
    ray.t_max = 4.9f;
    assert_false(ppmi_accel_intersect(world.accel, &ray, &hit));
    assert_false(ppmi_accel_occluded(world.accel, &ray));
    ray.t_max = 5.1f;
    assert_true(ppmi_accel_occluded(world.accel, &ray));
    ray = ray_from(vec3(0.25f, 0.25f, 0.0f), vec3(0, 0, 1));
    assert_true(ppmi_accel_intersect(world.accel, &ray, &hit));
    assert_int_equal(hit.instance, 0);
    world_close(&world);
    scene_close(&test);
}

/* A unit box under a transform: the ray, taken into the box's own space, against its slabs. */
static double box_distance(const ppmi_transform *m, ppmi_vec3 origin, ppmi_vec3 direction,
                           ppmi_vec3 *normal)
{
    const double columns[3][3] = {{(double)m->x.x, (double)m->x.y, (double)m->x.z},
                                  {(double)m->y.x, (double)m->y.y, (double)m->y.z},
                                  {(double)m->z.x, (double)m->z.y, (double)m->z.z}};
    const ppmi_vec3 from = vec3_sub(origin, m->origin);
    const double o[3] = {(double)from.x, (double)from.y, (double)from.z};
    const double d[3] = {(double)direction.x, (double)direction.y, (double)direction.z};
    double near = -INFINITY, far = INFINITY;
    for (int k = 0; k < 3; k++) {
        /* the cofactor row gives the local coordinate */
        const double *a = columns[(k + 1) % 3], *b = columns[(k + 2) % 3], *c = columns[k];
        const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                             a[0] * b[1] - a[1] * b[0]};
        const double det = n[0] * c[0] + n[1] * c[1] + n[2] * c[2];
        const double lo = (n[0] * o[0] + n[1] * o[1] + n[2] * o[2]) / det;
        const double ld = (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]) / det;
        const double t0 = (-copysign(1.0, ld) - lo) / ld, t1 = (copysign(1.0, ld) - lo) / ld;
        if (t0 > near) {
            near = t0;
            const double sign = -copysign(1.0, ld) * copysign(1.0, det);
            *normal = vec3_normalize(
                vec3((float)(sign * n[0]), (float)(sign * n[1]), (float)(sign * n[2])));
        }
        far = fmin(far, t1);
    }
    return near < far && near > 0.0 ? near : INFINITY;
}

static float random_signed(ppmi_rng *rng)
{
    return 2.0f * ppmi_rng_float(rng) - 1.0f;
}

static ppmi_vec3 random_vector(ppmi_rng *rng)
{
    const float x = random_signed(rng), y = random_signed(rng);
    return vec3(x, y, random_signed(rng));
}

/* Any affine transform, mirrored or not: distance, and normals that point outwards. */
static void sheared_and_mirrored_boxes_are_hit_where_they_are(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(3, PPMI_STREAM_EYE, 0);
    uint32_t hits = 0, mirrored = 0;
    for (int trial = 0; trial < 40; trial++) {
        test_scene test;
        scene_open(&test);
        const ppmi_transform m = {
            vec3_add(vec3(1, 0, 0), vec3_scale(random_vector(&rng), 0.5f)),
            vec3_add(vec3(0, 2, 0), vec3_scale(random_vector(&rng), 0.5f)),
            vec3_scale(vec3_add(vec3(0, 0, 1), vec3_scale(random_vector(&rng), 0.5f)),
                       trial % 2 ? -1.0f : 1.0f),
            random_vector(&rng)};
        float columns[16] = {0.0f};
        vec3_store(columns, m.x);
        vec3_store(columns + 4, m.y);
        vec3_store(columns + 8, m.z);
        vec3_store(columns + 12, m.origin);
        columns[15] = 1.0f;
        shape_place_by(test.scene,
                       shape_box(test.scene, 0, vec3_splat(-1.0f), vec3_splat(1.0f), 3, false),
                       columns);
        mirrored += test.scene->instances[0].is_mirrored;
        test_world world;
        world_open(&world, &test);
        for (int i = 0; i < 500; i++) {
            const ppmi_vec3 origin = vec3_scale(vec3_normalize(random_vector(&rng)), 8.0f);
            const ppmi_vec3 target = vec3_add(m.origin, vec3_scale(random_vector(&rng), 2.0f));
            const ppmi_vec3 direction = vec3_normalize(vec3_sub(target, origin));
            const ppmi_ray ray = ray_from(origin, direction);
            ppmi_vec3 normal = vec3_splat(0.0f);
            const double expected = box_distance(&m, origin, direction, &normal);
            ppmi_hit hit;
            const bool is_hit = ppmi_accel_intersect(world.accel, &ray, &hit);
            assert_int_equal(is_hit, isfinite(expected));
            assert_int_equal(ppmi_accel_occluded(world.accel, &ray), is_hit);
            if (!is_hit) continue;
            hits++;
            /* off the plane, not along the ray: grazing hits are no worse */
            const float cosine = fabsf(vec3_dot(normal, direction));
            assert_near(hit.t * cosine, expected * (double)cosine, 1e-5);
            ppmi_surface surface;
            ppmi_surface_from_hit(test.scene, &hit, &surface);
            assert_near(vec3_dot(surface.ng, normal), 1.0, 1e-5);
            assert_near(vec3_length(vec3_sub(surface.position, vec3_mad(origin, direction, hit.t))),
                        0.0, 2e-5);
        }
        world_close(&world);
        scene_close(&test);
    }
    assert_int_equal(mirrored, 20);
    assert_true(hits > 5000);
}

/* Smooth normals follow the surface, also where the instance is squeezed and mirrored. */
static void smooth_normals_are_those_of_the_ellipsoid(void **state)
{
    (void)state;
    test_scene test;
    scene_open(&test);
    const float columns[16] = {-3, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    shape_place_by(test.scene, shape_sphere(test.scene, 0, 1.0f, 64, true), columns);
    test_world world;
    world_open(&world, &test);
    ppmi_rng rng = ppmi_rng_start(4, PPMI_STREAM_EYE, 0);
    for (int i = 0; i < 1000; i++) {
        const ppmi_vec3 target = vec3_normalize(random_vector(&rng));
        const ppmi_vec3 p = vec3(-3 * target.x, 0.5f * target.y, target.z);
        const ppmi_vec3 gradient = vec3_normalize(vec3(p.x / 9.0f, p.y / 0.25f, p.z));
        const ppmi_surface surface =
            world_hit(&world, vec3_mad(p, gradient, 1.0f), vec3_neg(gradient));
        /* linear interpolation of normals over a facet of pi / 64, stretched by 6 */
        assert_true(vec3_dot(surface.ns, gradient) > 0.999f);
        assert_true(vec3_dot(surface.ng, gradient) > 0.97f);
    }
    world_close(&world);
    scene_close(&test);
}

/* Sheets at one place are all found, and the order is that of the distance. */
static void all_hits_are_found_nearest_first(void **state)
{
    (void)state;
    test_scene test;
    scene_open(&test);
    const float heights[5] = {2.0f, 1.0f, 1.0f, 1.0f, 3.0f};
    for (int i = 0; i < 5; i++)
        add_quad(test.scene, 0, vec3(-1, -1, heights[i]), vec3(3, 0, 0), vec3(0, 3, 0));
    test_world world;
    world_open(&world, &test);
    ppmi_ray ray = ray_from(vec3(0.3f, 0.1f, 0), vec3(0, 0, 1));
    ppmi_hit hits[8];
    assert_int_equal(ppmi_accel_intersect_all(world.accel, &ray, hits, 8), 5);
    uint32_t seen = 0;
    for (uint32_t i = 0; i < 5; i++) {
        assert_near(hits[i].t, heights[hits[i].instance], 1e-6);
        assert_true(i == 0 || hits[i].t >= hits[i - 1].t);
        seen |= 1u << hits[i].instance;
    }
    assert_int_equal(seen, 31);
    assert_int_equal(ppmi_accel_intersect_all(world.accel, &ray, hits, 2), 2);
    ray.t_max = 1.5f;
    assert_int_equal(ppmi_accel_intersect_all(world.accel, &ray, hits, 8), 3);
    ray.t_max = 0.5f;
    assert_int_equal(ppmi_accel_intersect_all(world.accel, &ray, hits, 8), 0);
    world_close(&world);
    scene_close(&test);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_scene_is_never_hit),
        cmocka_unit_test(hits_name_what_they_hit),
        cmocka_unit_test(all_hits_are_found_nearest_first),
        cmocka_unit_test(sheared_and_mirrored_boxes_are_hit_where_they_are),
        cmocka_unit_test(smooth_normals_are_those_of_the_ellipsoid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
