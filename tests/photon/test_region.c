/* The region of gathering: its measure is that of the places that it holds, and it ends at walls.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "photon/region.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/shapes.h"
#include "support/statistics.h"

enum { MOST = 4096 };

/* All triangles of a scene, for whoever samples its surface. */
static test_scene test;
static test_world world;
static ppmi_vec3 corners[MOST][3];
static uint32_t triangle_count;
static ppm_material_id grey;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    grey = material_lambert(test.scene, 0.5f);
    triangle_count = 0;
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    world_close(&world);
    scene_close(&test);
    return 0;
}

static void add(ppmi_vec3 a, ppmi_vec3 b, ppmi_vec3 c)
{
    assert_true(triangle_count < MOST);
    corners[triangle_count][0] = a;
    corners[triangle_count][1] = b;
    corners[triangle_count++][2] = c;
}

static void add_parallelogram(ppmi_vec3 origin, ppmi_vec3 u, ppmi_vec3 v)
{
    add(origin, vec3_add(origin, u), vec3_add(origin, vec3_add(u, v)));
    add(origin, vec3_add(origin, vec3_add(u, v)), vec3_add(origin, v));
}

/* Its front is outside. */
static void add_box(ppmi_vec3 low, ppmi_vec3 high)
{
    const ppmi_vec3 d = vec3_sub(high, low);
    const ppmi_vec3 x = {d.x, 0, 0}, y = {0, d.y, 0}, z = {0, 0, d.z};
    add_parallelogram(low, y, x);
    add_parallelogram(low, x, z);
    add_parallelogram(low, z, y);
    add_parallelogram(high, vec3_neg(x), vec3_neg(y));
    add_parallelogram(high, vec3_neg(z), vec3_neg(x));
    add_parallelogram(high, vec3_neg(y), vec3_neg(z));
}

static void open_world(void)
{
    uint32_t indices[3 * MOST];
    for (uint32_t i = 0; i < 3 * triangle_count; i++)
        indices[i] = i;
    const ppm_primitive_desc primitive = {.vertex_count = 3 * triangle_count,
                                          .triangle_count = triangle_count,
                                          .positions = &corners[0][0].x,
                                          .indices = indices,
                                          .material = grey};
    shape_place(test.scene, shape_mesh(test.scene, &primitive));
    light_point(test.scene, vec3(0, 0, 5), vec3_splat(1.0f));
    world_open(&world, &test);
}

static ppmi_gather_region region_at(ppmi_vec3 position, ppmi_vec3 normal, float radius)
{
    ppmi_visible_point point = {.position = position};
    point.bsdf.ng = normal;
    ppmi_gather_region region;
    ppmi_region_find(world.world.accel, &point, radius, 0.0f, NULL, &region);
    return region;
}

/* What the triangle adds to the region's share by a line along the point's normal, through a place
 * that is drawn evenly from the disk. */
static double share_by(const ppmi_gather_region *region, const ppmi_vec3 corner[3], ppmi_vec3 start)
{
    const ppmi_vec3 a = vec3_sub(corner[1], corner[0]), b = vec3_sub(corner[2], corner[0]);
    const ppmi_vec3 n = region->n, cross = vec3_cross(a, b), from = vec3_sub(start, corner[0]);
    const float volume = vec3_dot(cross, n), length = vec3_length(cross);
    if (fabsf(volume) < PPMI_REGION_COSINE * length) return 0.0;
    const float u = vec3_dot(vec3_cross(from, b), n) / volume;
    const float v = vec3_dot(vec3_cross(a, from), n) / volume;
    if (u < 0.0f || v < 0.0f || u + v > 1.0f) return 0.0;
    const ppmi_vec3 place = vec3_mad(vec3_mad(corner[0], a, u), b, v);
    const ppmi_vec3 way = vec3_sub(place, region->center), flat = vec3_sub(start, region->center);
    if (fabsf(vec3_dot(way, n)) > PPMI_REGION_BELOW * region->radius ||
        !ppmi_region_holds(region, place)) {
        return 0.0;
    }
    const float radius2 = region->radius * region->radius;
    return 2.0 * (1.0 - (double)(vec3_dot(flat, flat) / radius2)) *
           (double)(length / fabsf(volume));
}

/* The share against a mean over the disk. */
static void check_share(test_family *family, ppmi_vec3 position, ppmi_vec3 normal, float radius,
                        const char *what)
{
    const ppmi_gather_region region = region_at(position, normal, radius);
    ppmi_rng rng = ppmi_rng_start(3, 1, (uint64_t)family->count);
    test_mean mean = {0};
    const uint32_t samples = TEST_EFFORT(4000);
    for (uint32_t i = 0; i < samples; i++) {
        const float r = region.radius * sqrtf(ppmi_rng_float(&rng));
        const float turn = 2.0f * PPMI_PI * ppmi_rng_float(&rng);
        const ppmi_vec3 start =
            vec3_mad(vec3_mad(region.center, region.s, r * cosf(turn)), region.t, r * sinf(turn));
        double sum = 0.0;
        for (uint32_t k = 0; k < triangle_count; k++)
            sum += share_by(&region, (const ppmi_vec3 *)corners[k], start);
        mean_add(&mean, sum);
    }
    family_add_mean(family, &mean, (double)region.share, 1e-4, "%s, radius %g", what,
                    (double)radius);
}

static void a_disk_on_a_wide_plane_is_whole(void **state)
{
    (void)state;
    add_parallelogram(vec3(-5, -5, 0), vec3(10, 0, 0), vec3(0, 10, 0));
    open_world();
    const ppmi_gather_region region = region_at(vec3(0.1f, 0.1f, 0), vec3(0, 0, 1), 1.0f);
    assert_true(region.is_whole);
    assert_near((double)region.share, 1.0, 1e-6);
    const ppmi_gather_region edge = region_at(vec3(5, 1, 0), vec3(0, 0, 1), 1.0f);
    assert_near((double)edge.share, 0.5, 1e-6);
    const ppmi_gather_region corner = region_at(vec3(5, 5, 0), vec3(0, 0, 1), 1.0f);
    assert_near((double)corner.share, 0.25, 1e-6);
}

/* As a point on a ball or a segment finds it. */
static void a_large_triangle_that_passes_by_is_not_the_surface(void **state)
{
    (void)state;
    add_parallelogram(vec3(-5, -5, -3.75f), vec3(10, 0, 7.5f), vec3(0, 10, 0));
    open_world();
    const ppmi_gather_region region = region_at(vec3(0, 0.1f, 1), vec3(0, 0, 1), 0.05f);
    assert_false(region.is_known);
    assert_near((double)region.share, 1.0, 1e-6);
}

/* At walls of any thickness, below the plane and above, from close and from afar. */
static void nothing_beyond_a_wall_is_held(void **state)
{
    (void)state;
    const float walls_x[3] = {1.0f, -0.7f, 0.3f};
    add_parallelogram(vec3(-9, -9, 0), vec3(18, 0, 0), vec3(0, 18, 0));
    for (int i = 0; i < 3; i++)
        add_box(vec3(walls_x[i], -9, -0.001f), vec3(walls_x[i] + 0.001f, 9, 2));
    open_world();
    ppmi_rng rng = ppmi_rng_start(1, 2, 3);
    for (int i = 0; i < 200; i++) {
        const float x = 2.0f * ppmi_rng_float(&rng) - 1.0f, radius = 3.0f * ppmi_rng_float(&rng);
        const ppmi_gather_region region = region_at(vec3(x, 0, 0), vec3(0, 0, 1), radius);
        for (int k = 0; k < 200; k++) {
            const float to = x + radius * (2.0f * ppmi_rng_float(&rng) - 1.0f);
            const float y = radius * (2.0f * ppmi_rng_float(&rng) - 1.0f);
            bool is_between = false;
            for (int w = 0; w < 3; w++)
                is_between = is_between || (x < walls_x[w]) != (to < walls_x[w]);
            const float way2 = (to - x) * (to - x) + y * y;
            if (is_between && way2 < radius * radius) {
                assert_false(ppmi_region_holds(&region, vec3(to, y, 0)));
            }
        }
    }
}

static void the_share_is_that_of_the_places_that_are_held(void **state)
{
    (void)state;
    add_box(vec3(-2, -2, -1), vec3(2, 2, 0));              /* a floor */
    add_box(vec3(0.5f, -2, 0), vec3(0.6f, 2, 3));          /* a wall on it */
    add_box(vec3(-0.05f, -9, 0.8f), vec3(0.05f, 9, 0.9f)); /* a wire */
    add_box(vec3(-1.5f, -1, 0), vec3(-1, 1, 0.02f));       /* a plate on the floor */
    open_world();
    test_family family = {0};
    const ppmi_vec3 up = {0, 0, 1};
    for (int i = 0; i < 6; i++) {
        const float radius = 0.05f * (float)(1 << i);
        check_share(&family, vec3(0.45f, 0.1f, 0), up, radius, "beside the wall");
        check_share(&family, vec3(1.97f, 1.96f, 0), up, radius, "at the floor's corner");
        check_share(&family, vec3(0.01f, 0.1f, 0.9f), up, radius, "on the wire");
        check_share(&family, vec3(0.5f, 0.1f, 0.2f), vec3(-1, 0, 0), radius, "on the wall");
        check_share(&family, vec3(-1.01f, 0.1f, 0.02f), up, 0.1f * radius, "on the plate");
    }
    family_check(&family);
}

/* Tilted triangles, whose area is larger than what the kernel sees of it. */
static void the_share_on_a_ball_is_that_of_its_facets(void **state)
{
    (void)state;
    enum { RINGS = 8, AROUND = 16 };
    ppmi_vec3 grid[RINGS + 1][AROUND];
    for (int i = 0; i <= RINGS; i++) {
        for (int k = 0; k < AROUND; k++) {
            const float polar = PPMI_PI * (float)i / RINGS,
                        turn = 2.0f * PPMI_PI * (float)k / AROUND;
            grid[i][k] = vec3(sinf(polar) * cosf(turn), sinf(polar) * sinf(turn), cosf(polar));
        }
    }
    for (int i = 0; i < RINGS; i++) {
        for (int k = 0; k < AROUND; k++) {
            const int next = (k + 1) % AROUND;
            if (i < RINGS - 1) add(grid[i][k], grid[i + 1][k], grid[i + 1][next]);
            if (i > 0) add(grid[i][k], grid[i + 1][next], grid[i][next]);
        }
    }
    open_world();
    test_family family = {0};
    ppmi_rng rng = ppmi_rng_start(5, 2, 3);
    for (int i = 0; i < 24; i++) {
        const uint32_t k = ppmi_rng_u32(&rng) % triangle_count;
        const float u = ppmi_rng_float(&rng), v = ppmi_rng_float(&rng) * (1.0f - u);
        const ppmi_vec3 a = vec3_sub(corners[k][1], corners[k][0]);
        const ppmi_vec3 b = vec3_sub(corners[k][2], corners[k][0]);
        const ppmi_vec3 normal = vec3_normalize(vec3_cross(a, b));
        const ppmi_vec3 position = vec3_mad(vec3_mad(corners[k][0], a, u), b, v);
        check_share(&family, position, normal, 0.05f * (float)(1 + i), "outside");
        check_share(&family, position, vec3_neg(normal), 0.05f * (float)(1 + i), "inside");
    }
    family_check(&family);
}

/* Around a box on a floor, with disks that shrink as they do from pass to pass. */
static void what_is_known_changes_no_region(void **state)
{
    (void)state;
    add_parallelogram(vec3(-5, -5, 0), vec3(10, 0, 0), vec3(0, 10, 0));
    add_box(vec3(-0.5f, -0.5f, 0), vec3(0.5f, 0.5f, 1));
    open_world();
    ppmi_rng rng = ppmi_rng_start(7, 1, 1);
    uint32_t known_count = 0, whole_count = 0;
    for (int pixel = 0; pixel < 200; pixel++) {
        ppmi_plain_disk known = {0};
        const float x = 4.0f * ppmi_rng_float(&rng) - 2.0f, y = 4.0f * ppmi_rng_float(&rng) - 2.0f;
        for (float radius = 0.5f; radius > 0.02f; radius *= 0.9f) {
            const float dx = 0.1f * ppmi_rng_float(&rng), dy = 0.1f * ppmi_rng_float(&rng);
            ppmi_visible_point point = {.position = vec3(x + dx, y + dy, 0)};
            point.bsdf.ng = vec3(0, 0, 1);
            known_count += known.radius > 0.0f ? 1 : 0;
            const ppmi_gather_region plain = region_at(point.position, point.bsdf.ng, radius);
            ppmi_gather_region region;
            ppmi_region_find(world.world.accel, &point, radius, 0.0f, &known, &region);
            assert_int_equal(region.is_whole, plain.is_whole);
            assert_memory_equal(&region.share, &plain.share, sizeof plain.share);
            assert_memory_equal(&region.radius, &plain.radius, sizeof plain.radius);
            assert_memory_equal(region.limits, plain.limits, sizeof plain.limits);
            whole_count += region.is_whole ? 1 : 0;
        }
    }
    assert_in_range(known_count, 1000, 6000);
    assert_in_range(whole_count, 1000, 5900);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_disk_on_a_wide_plane_is_whole, open_scene, close_scene),
        cmocka_unit_test_setup_teardown(a_large_triangle_that_passes_by_is_not_the_surface,
                                        open_scene, close_scene),
        cmocka_unit_test_setup_teardown(nothing_beyond_a_wall_is_held, open_scene, close_scene),
        cmocka_unit_test_setup_teardown(the_share_is_that_of_the_places_that_are_held, open_scene,
                                        close_scene),
        cmocka_unit_test_setup_teardown(the_share_on_a_ball_is_that_of_its_facets, open_scene,
                                        close_scene),
        cmocka_unit_test_setup_teardown(what_is_known_changes_no_region, open_scene, close_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
