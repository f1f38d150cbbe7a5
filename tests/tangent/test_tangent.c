/* importers/tangent/tangent.c and weld.c */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <omp.h>

#include "tangent/tangent.h"

enum { MOST = 4096 };

typedef struct fixture {
    ppm_context *context;
    float positions[3 * MOST], normals[3 * MOST], uvs[2 * MOST];
    uint32_t indices[6 * MOST];
    ppmi_tangent_mesh mesh;
    ppmi_tangent_result result;
} fixture;

static int setup(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    if (!f || ppm_context_create(NULL, &f->context) != PPM_STATUS_OK) return -1;
    f->mesh = (ppmi_tangent_mesh){
        .positions = f->positions, .normals = f->normals, .uvs = f->uvs, .indices = f->indices};
    *state = f;
    return 0;
}

static int teardown(void **state)
{
    fixture *f = *state;
    ppmi_tangent_result_deinit(f->context, &f->result);
    const size_t live = ppmi_alloc_live(f->context);
    ppm_context_destroy(f->context);
    free(f);
    return live == 0 ? 0 : -1;
}

static uint32_t add_vertex(fixture *f, float x, float y, float z, float u, float v)
{
    const size_t i = f->mesh.vertex_count;
    const float p[3] = {x, y, z}, n[3] = {0.0f, 0.0f, 2.0f}, uv[2] = {u, v};
    memcpy(f->positions + 3 * i, p, sizeof p);
    memcpy(f->normals + 3 * i, n, sizeof n);
    memcpy(f->uvs + 2 * i, uv, sizeof uv);
    return f->mesh.vertex_count++;
}

static void add_triangle(fixture *f, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    memcpy(f->indices + 3 * (size_t)f->mesh.triangle_count++, corners, sizeof corners);
}

static void compute(fixture *f)
{
    ppmi_tangent_result_deinit(f->context, &f->result);
    assert_int_equal(ppmi_tangent_compute(f->context, &f->mesh, &f->result), PPM_STATUS_OK);
}

static void assert_tangent(const fixture *f, uint32_t vertex, float x, float y, float z, float w)
{
    const float *t = f->result.tangents + 4 * (size_t)vertex;
    const float error = fabsf(t[0] - x) + fabsf(t[1] - y) + fabsf(t[2] - z) + fabsf(t[3] - w);
    if (!(error < 1e-5f)) {
        fail_msg("vertex %u: %g %g %g %g, expected %g %g %g %g", (unsigned)vertex, (double)t[0],
                 (double)t[1], (double)t[2], (double)t[3], (double)x, (double)y, (double)z,
                 (double)w);
    }
}

static void nothing_has_no_tangents(void **state)
{
    fixture *f = *state;
    compute(f);
    assert_int_equal(f->result.vertex_count, 0);
    add_vertex(f, 0, 0, 0, 0, 0);
    compute(f);
    assert_int_equal(f->result.vertex_count, 0);
}

static void memory_that_is_out_is_told(void **state)
{
    fixture *f = *state;
    for (int i = 0; i < 3; ++i) {
        add_vertex(f, (float)(i == 1), (float)(i == 2), 0, (float)(i == 1), (float)(i == 2));
    }
    add_triangle(f, 0, 1, 2);
    size_t n = 1;
    for (ppm_status status = PPM_STATUS_OUT_OF_MEMORY; status != PPM_STATUS_OK; ++n) {
        ppmi_alloc_fail_at(f->context, n);
        status = ppmi_tangent_compute(f->context, &f->mesh, &f->result);
        ppmi_alloc_fail_at(f->context, 0);
        assert_true(status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY);
        ppmi_tangent_result_deinit(f->context, &f->result);
    }
    assert_true(n > 8);
}

static void the_tangent_is_where_u_grows(void **state)
{
    fixture *f = *state;
    add_vertex(f, 0, 0, 0, 0, 0);
    add_vertex(f, 1, 0, 0, 0, 1); /* v along x, u against y */
    add_vertex(f, 0, 1, 0, -1, 0);
    add_triangle(f, 0, 1, 2);
    compute(f);
    assert_int_equal(f->result.vertex_count, 3);
    assert_tangent(f, 0, 0, -1, 0, 1); /* z cross -y is x, where v grows */
    f->mesh.v_runs_down = true;
    compute(f);
    assert_tangent(f, 0, 0, -1, 0, -1);
}

static void mirrored_coordinates_split_the_seam(void **state)
{
    fixture *f = *state;
    /* two squares that mirror each other's coordinates about their common side x = 0 */
    const uint32_t low = add_vertex(f, 0, 0, 0, 0, 0), high = add_vertex(f, 0, 1, 0, 0, 1);
    const uint32_t right = add_vertex(f, 1, 0, 0, 1, 0), left = add_vertex(f, -1, 0, 0, 1, 0);
    add_triangle(f, low, right, high);
    add_triangle(f, low, high, left);
    compute(f);
    assert_int_equal(f->result.vertex_count, 6);
    assert_tangent(f, low, 1, 0, 0, 1);
    assert_tangent(f, high, 1, 0, 0, 1);
    assert_tangent(f, left, -1, 0, 0, -1);
    assert_int_equal(f->result.indices[0], low);
    for (uint32_t i = 3; i < 5; ++i) { /* corners of the second triangle at the seam */
        const uint32_t copy = f->result.indices[i];
        assert_true(copy >= 4);
        assert_int_equal(f->result.sources[copy], f->indices[i]);
        assert_tangent(f, copy, -1, 0, 0, -1);
    }
}

static void vertices_that_differ_by_number_only_are_one(void **state)
{
    fixture *f = *state;
    /* two triangles with a common edge and no index in common; u has another direction in each */
    add_vertex(f, 0, 0, 0, 0, 0);
    add_vertex(f, 1, 0, 0, 1, 0);
    add_vertex(f, 0, 1, 0, 0, 1);
    add_vertex(f, 0, -0.0f, 0, 0, 0);
    add_vertex(f, 0, 1, 0, 0, 1);
    add_vertex(f, -1, 0, 0, -0.5f, 1); /* the same turn, another direction */
    add_triangle(f, 0, 1, 2);
    add_triangle(f, 3, 4, 5);
    compute(f);
    assert_int_equal(f->result.vertex_count, 6);
    assert_memory_equal(f->result.tangents, f->result.tangents + 12, 4 * sizeof(float));
    assert_memory_equal(f->result.tangents + 8, f->result.tangents + 16, 4 * sizeof(float));
    assert_true(fabsf(f->result.tangents[1]) > 0.1f); /* a mean of both */
}

static void a_seam_in_the_coordinates_is_kept(void **state)
{
    fixture *f = *state;
    add_vertex(f, 0, 0, 0, 0, 0);
    add_vertex(f, 1, 0, 0, 1, 0);
    add_vertex(f, 0, 1, 0, 0, 1);
    add_vertex(f, 0, 0, 0, 5, 5); /* other coordinates in the same places, turned by 90 degrees */
    add_vertex(f, 0, 1, 0, 6, 5);
    add_vertex(f, -1, 0, 0, 5, 6);
    add_triangle(f, 0, 1, 2);
    add_triangle(f, 3, 4, 5);
    compute(f);
    assert_tangent(f, 0, 1, 0, 0, 1);
    assert_tangent(f, 2, 1, 0, 0, 1);
    assert_tangent(f, 3, 0, 1, 0, 1);
    assert_tangent(f, 4, 0, 1, 0, 1);
}

static void directions_are_weighted_by_angles(void **state)
{
    fixture *f = *state;
    /* at the origin a corner of 90 degrees with u along x and one of 45 degrees with u along the
     * diagonal between x and y: the coordinates agree on the common edge, along y */
    const uint32_t o = add_vertex(f, 0, 0, 0, 0, 0), y = add_vertex(f, 0, 1, 0, 0, 1);
    const uint32_t x = add_vertex(f, 1, 0, 0, 1, 0);
    const uint32_t d = add_vertex(f, -1, 1, 0, -2, 0);
    add_triangle(f, o, x, y);
    add_triangle(f, o, y, d);
    compute(f);
    /* of the second: u = 2 x, v = x + y, and u grows fastest along (1, 0), where v is kept: in
     * MikkTSpace the direction is that of constant v, (1, -1) / sqrt 2 */
    const float a = acosf(0.0f), b = acosf(sqrtf(0.5f)), r = sqrtf(0.5f);
    const float tx = a + b * r, ty = -b * r, length = sqrtf(tx * tx + ty * ty);
    assert_tangent(f, o, tx / length, ty / length, 0, 1);
}

static void triangles_without_area_change_nothing(void **state)
{
    fixture *f = *state;
    add_vertex(f, 0, 0, 0, 0, 0);
    add_vertex(f, 1, 0, 0, 1, 0);
    add_vertex(f, 0, 1, 0, 0, 1);
    add_vertex(f, 1, 0, 0, 0.3f, 0.9f); /* in the place of vertex 1 */
    add_vertex(f, 1, 1, 0, 0, 0);
    add_triangle(f, 0, 1, 2);
    compute(f);
    float expected[12];
    memcpy(expected, f->result.tangents, sizeof expected);
    add_triangle(f, 0, 1, 3); /* no area in space */
    add_triangle(f, 2, 1, 4);
    f->uvs[8] = 0.5f; /* no area in the coordinates: on the edge of 1 and 2 */
    f->uvs[9] = 0.5f;
    compute(f);
    assert_int_equal(f->result.vertex_count, 5);
    assert_memory_equal(f->result.tangents, expected, sizeof expected);
    assert_tangent(f, 3, 0, 0, 0, 0); /* no direction at all */
}

static void not_finite_values_do_no_harm(void **state)
{
    fixture *f = *state;
    add_vertex(f, 0, 0, 0, 0, 0);
    add_vertex(f, NAN, 0, 0, INFINITY, 0);
    add_vertex(f, 0, 1e38f, 0, 0, 1e38f);
    add_vertex(f, 1, 0, 0, 1, 0);
    add_vertex(f, 0, 1, 0, 0, 1);
    add_triangle(f, 0, 1, 2);
    add_triangle(f, 0, 3, 4);
    compute(f);
    assert_int_equal(f->result.vertex_count, 5);
    assert_tangent(f, 3, 1, 0, 0, 1);
    for (uint32_t i = 0; i < 4 * f->result.vertex_count; ++i) {
        assert_true(isfinite(f->result.tangents[i]));
    }
}

/* A sphere's globe coordinates, with the order of triangles turned around for is_reversed. */
static void make_globe(fixture *f, bool is_reversed)
{
    enum { WIDE = 40, HIGH = 20 };
    f->mesh.vertex_count = f->mesh.triangle_count = 0;
    for (int j = 0; j <= HIGH; ++j) {
        for (int i = 0; i <= WIDE; ++i) {
            const float a = 6.2831853f * (float)i / WIDE, b = 3.1415927f * (float)j / HIGH;
            const float p[3] = {cosf(a) * sinf(b), sinf(a) * sinf(b), cosf(b)};
            const uint32_t v = add_vertex(f, p[0], p[1], p[2], 0.1f * (float)i, -0.1f * (float)j);
            memcpy(f->normals + 3 * (size_t)v, p, sizeof p);
        }
    }
    for (int k = 0; k < WIDE * HIGH; ++k) {
        const int cell = is_reversed ? WIDE * HIGH - 1 - k : k;
        const uint32_t a = (uint32_t)(cell / WIDE * (WIDE + 1) + cell % WIDE);
        const uint32_t b = a + WIDE + 1;
        if (is_reversed) add_triangle(f, b, b + 1, a + 1);
        add_triangle(f, a, b, a + 1);
        if (!is_reversed) add_triangle(f, b, b + 1, a + 1);
    }
}

static void a_globe_has_its_circles_of_latitude(void **state)
{
    fixture *f = *state;
    make_globe(f, false);
    compute(f);
    assert_int_equal(f->result.vertex_count, f->mesh.vertex_count);
    for (uint32_t v = 41; v < f->mesh.vertex_count - 41; ++v) {
        const float *p = f->positions + 3 * (size_t)v, *t = f->result.tangents + 4 * (size_t)v;
        const float r = sqrtf(p[0] * p[0] + p[1] * p[1]);
        const float cosine = (-p[1] * t[0] + p[0] * t[1]) / r;
        /* the ends of the seam see one side only: half a cell, 4.5 degrees */
        const bool is_end = v % 41 == 0 || v % 41 == 40;
        if (!(cosine > (is_end ? 0.995f : 0.9999f)) || t[3] != 1.0f) {
            fail_msg("vertex %u: cosine %g, w %g", (unsigned)v, (double)cosine, (double)t[3]);
        }
    }
}

static void the_order_of_triangles_does_not_matter(void **state)
{
    fixture *f = *state;
    make_globe(f, false);
    compute(f);
    const size_t count = 4 * (size_t)f->result.vertex_count;
    float *expected = malloc(count * sizeof *expected);
    assert_non_null(expected);
    memcpy(expected, f->result.tangents, count * sizeof *expected);
    make_globe(f, true);
    compute(f);
    assert_int_equal(4 * (size_t)f->result.vertex_count, count);
    for (size_t i = 0; i < count; ++i) { /* sums in another order: up to rounding */
        assert_float_equal(f->result.tangents[i], expected[i], 2e-6f);
    }
    free(expected);
}

static void the_number_of_threads_does_not_matter(void **state)
{
    fixture *f = *state;
    const int threads = omp_get_max_threads();
    make_globe(f, false);
    omp_set_num_threads(1);
    compute(f);
    const size_t size = 4 * (size_t)f->result.vertex_count * sizeof(float);
    float *expected = malloc(size);
    assert_non_null(expected);
    memcpy(expected, f->result.tangents, size);
    omp_set_num_threads(5);
    compute(f);
    omp_set_num_threads(threads);
    assert_memory_equal(f->result.tangents, expected, size);
    free(expected);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(nothing_has_no_tangents),
        TEST(memory_that_is_out_is_told),
        TEST(not_finite_values_do_no_harm),
        TEST(triangles_without_area_change_nothing),
        TEST(the_tangent_is_where_u_grows),
        TEST(mirrored_coordinates_split_the_seam),
        TEST(vertices_that_differ_by_number_only_are_one),
        TEST(a_seam_in_the_coordinates_is_kept),
        TEST(directions_are_weighted_by_angles),
        TEST(a_globe_has_its_circles_of_latitude),
        TEST(the_order_of_triangles_does_not_matter),
        TEST(the_number_of_threads_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
