/* importers/obj/obj_polygon.c: triangles that cover the polygon once. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "obj/obj_polygon.h"

enum { MOST = 600 };

typedef struct polygon {
    uint32_t count;
    float positions[3 * MOST];
    ppmi_obj_corner corners[MOST];
    uint32_t triangles[3 * MOST];
} polygon;

/* A corner at (x, y) of a plane that turn = 0 .. 5 puts in space: three axes, two sides. */
static void add(polygon *p, int turn, double x, double y)
{
    const double xyz[3] = {turn < 3 ? x : y, turn < 3 ? y : x, 0.25 * x - 0.125 * y + 7.0};
    for (int k = 0; k < 3; ++k) {
        p->positions[3 * p->count + (size_t)((k + turn) % 3)] = (float)xyz[k];
    }
    p->corners[p->count] = (ppmi_obj_corner){(int32_t)p->count, -1, -1};
    p->count++;
}

static void cross(const float *a, const float *b, const float *c, double out[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = (double)b[k] - (double)a[k];
        v[k] = (double)c[k] - (double)a[k];
    }
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void find_normal(const polygon *p, double normal[3])
{
    normal[0] = normal[1] = normal[2] = 0.0;
    for (uint32_t i = 1; i + 1 < p->count; ++i) {
        double n[3];
        cross(p->positions, p->positions + 3 * i, p->positions + 3 * (i + 1), n);
        for (int k = 0; k < 3; ++k) {
            normal[k] += n[k];
        }
    }
}

static uint64_t triangulate(polygon *p, const double normal[3])
{
    ppm_context *context = NULL;
    ppmi_obj_polygon_workspace workspace = {0};
    assert_int_equal(ppm_context_create(NULL, &context), 0);
    assert_true(ppmi_obj_triangulate(context, &workspace, p->positions, p->corners, p->count,
                                     normal, p->triangles));
    const uint64_t forced = workspace.forced;
    ppmi_obj_polygon_deinit(context, &workspace);
    assert_int_equal(ppmi_alloc_live(context), 0);
    ppm_context_destroy(context);
    return forced;
}

/* No triangle is reversed and their areas add up: no overlap, no gap. */
static void check_cover(polygon *p)
{
    double normal[3], sum = 0.0;
    find_normal(p, normal);
    const double area = sqrt(dot(normal, normal));
    assert_int_equal(triangulate(p, normal), 0);
    for (uint32_t i = 0; i < p->count - 2; ++i) {
        const uint32_t *t = p->triangles + 3 * i;
        double n[3];
        assert_true(t[0] < p->count && t[1] < p->count && t[2] < p->count);
        cross(p->positions + 3 * t[0], p->positions + 3 * t[1], p->positions + 3 * t[2], n);
        const double part = dot(n, normal) / area;
        if (part < -1e-4 * area) fail_msg("triangle %u is reversed: %g of %g", i, part, area);
        sum += sqrt(dot(n, n));
    }
    if (fabs(sum - area) > 1e-4 * area) fail_msg("triangles have area %g of %g", sum, area);
}

/* Coordinates x, y of a polygon, counter-clockwise, in all six turns and from every corner on. */
static void check_shape(const double *xy, uint32_t count)
{
    static polygon p;
    for (int turn = 0; turn < 6; ++turn) {
        for (uint32_t first = 0; first < count; ++first) {
            p.count = 0;
            for (uint32_t i = 0; i < count; ++i) {
                const uint32_t k = (first + i) % count;
                add(&p, turn, xy[2 * k], xy[2 * k + 1]);
            }
            check_cover(&p);
        }
    }
}

static void a_convex_polygon_is_covered(void **state)
{
    (void)state;
    const double square[] = {0, 0, 1, 0, 1, 1, 0, 1};
    const double with_straight_corners[] = {0, 0, 1, 0, 2, 0, 2, 1, 2, 2, 0, 2, 0, 1};
    check_shape(square, 4);
    check_shape(with_straight_corners, 7);
}

static void a_concave_polygon_is_covered(void **state)
{
    (void)state;
    const double arrow[] = {0, 0, 2, 2, 0, 1, -2, 2};
    const double l_shape[] = {0, 0, 2, 0, 2, 1, 1, 1, 1, 2, 0, 2};
    const double u_shape[] = {0, 0, 3, 0, 3, 3, 2, 3, 2, 1, 1, 1, 1, 3, 0, 3};
    check_shape(arrow, 4);
    check_shape(l_shape, 6);
    check_shape(u_shape, 8);
}

static void a_hole_that_is_reached_by_a_bridge_is_left_open(void **state)
{
    (void)state;
    const double frame[] = {0, 0, 4, 0, 4, 4, 0, 4, 0, 0, 1, 1, 1, 3, 3, 3, 3, 1, 1, 1};
    check_shape(frame, 10);
}

static void combs_and_stars_are_covered(void **state)
{
    (void)state;
    static polygon p;
    p.count = 0;
    add(&p, 0, 0.0, -1.0);
    add(&p, 0, 250.0, -1.0);
    for (int i = 250; i > 0; --i) {
        add(&p, 0, i - 0.5, 10.0);
        add(&p, 0, i - 1.0, 0.0);
    }
    check_cover(&p);
    srand(7);
    for (int round = 0; round < 50; ++round) {
        p.count = 0;
        for (int i = 0; i < 200; ++i) {
            const double angle = 2.0 * 3.14159265358979 * i / 200.0;
            const double radius = 0.1 + rand() / (double)RAND_MAX;
            add(&p, round % 6, radius * cos(angle), radius * sin(angle));
        }
        check_cover(&p);
    }
}

static void a_polygon_that_crosses_itself_ends_in_as_many_triangles(void **state)
{
    (void)state;
    static polygon p;
    double normal[3];
    p.count = 0;
    srand(3);
    for (int i = 0; i < 60; ++i) {
        add(&p, 0, rand() % 100, rand() % 100);
    }
    find_normal(&p, normal);
    for (uint32_t i = 0; i < 3 * MOST; ++i) {
        p.triangles[i] = UINT32_MAX;
    }
    assert_int_equal(triangulate(&p, normal), 1);
    for (uint32_t i = 0; i < 3 * 58; ++i) {
        assert_true(p.triangles[i] < 60);
    }
    assert_int_equal(p.triangles[3 * 58], UINT32_MAX);
}

static void a_polygon_without_a_plane_is_a_fan(void **state)
{
    (void)state;
    static polygon p;
    const double none[3] = {0, 0, 0}, nan[3] = {NAN, 0, 0};
    p.count = 0;
    for (int i = 0; i < 5; ++i) {
        add(&p, 0, i, 0);
    }
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(triangulate(&p, i ? none : nan), 0);
        assert_int_equal(p.triangles[6], 0);
        assert_int_equal(p.triangles[7], 3);
        assert_int_equal(p.triangles[8], 4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_convex_polygon_is_covered),
        cmocka_unit_test(a_concave_polygon_is_covered),
        cmocka_unit_test(a_hole_that_is_reached_by_a_bridge_is_left_open),
        cmocka_unit_test(combs_and_stars_are_covered),
        cmocka_unit_test(a_polygon_that_crosses_itself_ends_in_as_many_triangles),
        cmocka_unit_test(a_polygon_without_a_plane_is_a_fan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
