/* The hash grid against looking at every photon. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "photon/grid.h"
#include "support/near.h"
#include "support/statistics.h"

enum { MOST = 20000 };

static ppm_context *context;
static ppmi_rng rng;
static ppmi_photon photons[MOST];

static int open_context(void **state)
{
    (void)state;
    rng = ppmi_rng_start(1, PPMI_STREAM_PHOTON, 0);
    return ppm_context_create(NULL, &context);
}

static int close_context(void **state)
{
    (void)state;
    const size_t live = ppmi_alloc_live(context);
    ppm_context_destroy(context);
    return live == 0 ? 0 : -1;
}

static float random_signed(void)
{
    return 2.0f * ppmi_rng_float(&rng) - 1.0f;
}

static ppmi_vec3 random_vector(void)
{
    const float x = random_signed(), y = random_signed();
    return vec3(x, y, random_signed());
}

/* ---- clouds ---------------------------------------------------------------------------------- */

typedef struct cloud {
    const char *name;
    ppmi_vec3 (*point)(void);
    float least_radius, most_radius;
    ppmi_vec3 offset;
    float scale;
} cloud;

static ppmi_vec3 cube(void)
{
    return random_vector();
}

static ppmi_vec3 plane(void)
{
    const float x = random_signed();
    return vec3(x, 0.25f, random_signed());
}

static ppmi_vec3 line(void)
{
    return vec3_scale(vec3(0.3f, -0.5f, 0.8f), random_signed());
}

static ppmi_vec3 one_point(void)
{
    return vec3(0.1f, 0.2f, 0.3f);
}

/* Ten kilometres with heaps of a few millimetres. */
static ppmi_vec3 heaps(void)
{
    const ppmi_vec3 centers[3] = {{-4e3f, 10.0f, 3e3f}, {5e3f, 0.0f, -5e3f}, {12.0f, 3.0f, 4.0f}};
    if (ppmi_rng_u32(&rng) % 16 == 0) return vec3_scale(random_vector(), 5e3f);
    return vec3_mad(centers[ppmi_rng_u32(&rng) % 3], random_vector(), 4e-3f);
}

static const cloud clouds[] = {
    {"cube", cube, 1e-3f, 0.7f, {0, 0, 0}, 1.0f},
    {"cube, radii beyond its size", cube, 2.0f, 50.0f, {0, 0, 0}, 1.0f},
    {"millimetre cube", cube, 1e-6f, 1e-3f, {0, 0, 0}, 1e-3f},
    {"far cube", cube, 1e-3f, 0.5f, {1000, -2000, 500}, 1.0f},
    {"plane", plane, 1e-3f, 0.3f, {0, 0, 0}, 1.0f},
    {"line", line, 1e-4f, 0.3f, {0, 0, 0}, 1.0f},
    {"one point", one_point, 1e-6f, 10.0f, {0, 0, 0}, 1.0f},
    {"one point at the origin", one_point, 1e-6f, 10.0f, {0, 0, 0}, 0.0f},
    {"heaps", heaps, 1e-4f, 2000.0f, {0, 0, 0}, 1.0f},
};
enum { CLOUDS = sizeof clouds / sizeof clouds[0] };

static void fill(const cloud *c, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        photons[i] = (ppmi_photon){.position = vec3_mad(c->offset, c->point(), c->scale),
                                   .power = {(float)i, 1.0f, 1.0f},
                                   .ng = {0.0f, 1.0f, 0.0f}};
    }
}

/* From the least to the most, evenly in the logarithm. */
static float random_radius(const cloud *c)
{
    return c->least_radius * powf(c->most_radius / c->least_radius, ppmi_rng_float(&rng));
}

/* Every photon that should be found is in exactly one run; each run is within the grid. */
static void check_lookup(const ppmi_photon_grid *grid, ppmi_vec3 p, float radius, ppmi_vec3 n,
                         float thickness, uint64_t *found)
{
    static uint8_t covered[MOST];
    ppmi_photon_run runs[PPMI_GRID_MAX_RUNS];
    const uint32_t count = ppmi_photon_grid_lookup(grid, p, radius, n, thickness, runs);
    assert_true(count <= PPMI_GRID_MAX_RUNS);
    memset(covered, 0, sizeof covered);
    for (uint32_t r = 0; r < count; r++) {
        assert_true(runs[r].begin < runs[r].end && runs[r].end <= grid->count);
        for (uint32_t i = runs[r].begin; i < runs[r].end; i++) {
            assert_int_equal(covered[i], 0);
            covered[i] = 1;
        }
    }
    for (uint32_t i = 0; i < grid->count; i++) {
        const ppmi_vec3 d = vec3_sub(vec3(grid->x[i], grid->y[i], grid->z[i]), p);
        if (vec3_length2(d) < radius * radius && fabsf(vec3_dot(d, n)) <= thickness) {
            assert_int_equal(covered[i], 1);
            (*found)++;
        }
    }
}

static void check_lookups(const cloud *c, const ppmi_photon_grid *grid, uint32_t count,
                          uint64_t *found)
{
    const uint32_t lookups = TEST_EFFORT(300);
    for (uint32_t i = 0; i < lookups; i++) {
        const float radius = random_radius(c);
        ppmi_vec3 p = photons[ppmi_rng_u32(&rng) % count].position;
        if (i % 3 == 1) p = vec3_mad(p, random_vector(), radius);
        if (i % 3 == 2) p = vec3_mad(c->offset, random_vector(), 3.0f * c->scale);
        const ppmi_vec3 n = i % 4 == 0 ? vec3(0, 1, 0) : vec3_normalize(random_vector());
        const float thickness = i % 5 == 0 ? INFINITY : 0.3f * radius;
        check_lookup(grid, p, radius, n, thickness, found);
    }
}

static void every_photon_near_a_point_is_in_exactly_one_run(void **state)
{
    (void)state;
    const uint32_t counts[] = {1, 2, 17, 3000, MOST};
    ppmi_photon_grid grid = {0}; /* one for all: memory is kept */
    for (int c = 0; c < CLOUDS; c++) {
        uint64_t found = 0;
        for (int k = 0; k < 5; k++) {
            fill(&clouds[c], counts[k]);
            assert_int_equal(ppmi_photon_grid_build(context, &grid, photons, counts[k],
                                                    random_radius(&clouds[c]), 2),
                             PPM_STATUS_OK);
            assert_int_equal(grid.count, counts[k]);
            check_lookups(&clouds[c], &grid, counts[k], &found);
        }
        assert_true(found > 100);
    }
    ppmi_photon_grid_deinit(context, &grid);
}

/* The payload goes with its position. */
static void photons_keep_what_they_carry(void **state)
{
    (void)state;
    fill(&clouds[0], MOST);
    ppmi_photon_grid grid = {0};
    assert_int_equal(ppmi_photon_grid_build(context, &grid, photons, MOST, 0.1f, 3), PPM_STATUS_OK);
    uint8_t seen[MOST] = {0};
    for (uint32_t i = 0; i < MOST; i++) {
        const uint32_t from = (uint32_t)grid.payloads[i].power.x;
        assert_int_equal(seen[from]++, 0);
        assert_true(grid.x[i] == photons[from].position.x &&
                    grid.y[i] == photons[from].position.y && grid.z[i] == photons[from].position.z);
    }
    ppmi_photon_grid_deinit(context, &grid);
}

static void the_order_does_not_depend_on_the_threads(void **state)
{
    (void)state;
    const uint32_t threads[] = {1, 2, 7, 16};
    for (int c = 0; c < CLOUDS; c++) {
        fill(&clouds[c], MOST);
        ppmi_photon_grid first = {0};
        assert_int_equal(ppmi_photon_grid_build(context, &first, photons, MOST, 0.01f, 1),
                         PPM_STATUS_OK);
        for (int t = 1; t < 4; t++) {
            ppmi_photon_grid grid = {0};
            assert_int_equal(
                ppmi_photon_grid_build(context, &grid, photons, MOST, 0.01f, threads[t]),
                PPM_STATUS_OK);
            assert_memory_equal(grid.x, first.x, MOST * sizeof *grid.x);
            assert_memory_equal(grid.payloads, first.payloads, MOST * sizeof *grid.payloads);
            for (int i = 0; i < 50; i++) {
                const ppmi_vec3 p = photons[ppmi_rng_u32(&rng) % MOST].position;
                const float radius = random_radius(&clouds[c]);
                ppmi_photon_run a[PPMI_GRID_MAX_RUNS], b[PPMI_GRID_MAX_RUNS];
                const uint32_t count =
                    ppmi_photon_grid_lookup(&first, p, radius, vec3(0, 1, 0), radius, a);
                assert_int_equal(
                    ppmi_photon_grid_lookup(&grid, p, radius, vec3(0, 1, 0), radius, b), count);
                assert_memory_equal(a, b, count * sizeof *a);
            }
            ppmi_photon_grid_deinit(context, &grid);
        }
        ppmi_photon_grid_deinit(context, &first);
    }
}

static void an_empty_grid_finds_nothing(void **state)
{
    (void)state;
    ppmi_photon_grid grid = {0};
    ppmi_photon_run runs[PPMI_GRID_MAX_RUNS];
    assert_int_equal(ppmi_photon_grid_lookup(&grid, vec3(0, 0, 0), 1.0f, vec3(0, 1, 0), 1.0f, runs),
                     0);
    fill(&clouds[0], 10);
    assert_int_equal(ppmi_photon_grid_build(context, &grid, photons, 10, 0.1f, 2), PPM_STATUS_OK);
    assert_int_equal(ppmi_photon_grid_build(context, &grid, photons, 0, 0.1f, 2), PPM_STATUS_OK);
    assert_int_equal(ppmi_photon_grid_lookup(&grid, vec3(0, 0, 0), 9.0f, vec3(0, 1, 0), 9.0f, runs),
                     0);
    ppmi_photon_grid_deinit(context, &grid);
}

/* Candidates are few more than needed: else the grid would be right and useless. */
static void runs_hold_few_photons_too_many(void **state)
{
    (void)state;
    fill(&clouds[4], MOST); /* a plane of 2 by 2 */
    ppmi_photon_grid grid = {0};
    assert_int_equal(ppmi_photon_grid_build(context, &grid, photons, MOST, 0.02f, 2),
                     PPM_STATUS_OK);
    uint64_t candidates = 0, within = 0;
    for (int i = 0; i < 500; i++) {
        ppmi_photon_run runs[PPMI_GRID_MAX_RUNS];
        const ppmi_vec3 p = photons[ppmi_rng_u32(&rng) % MOST].position;
        const uint32_t count =
            ppmi_photon_grid_lookup(&grid, p, 0.05f, vec3(0, 1, 0), 0.015f, runs);
        for (uint32_t r = 0; r < count; r++)
            candidates += runs[r].end - runs[r].begin;
        for (uint32_t k = 0; k < MOST; k++)
            within += vec3_length(vec3_sub(photons[k].position, p)) < 0.05f;
    }
    /* three by three cells of up to twice the radius a side, by the disk: 36 / pi */
    assert_true(within > 10000 && (double)candidates < 11.5 * (double)within);
    ppmi_photon_grid_deinit(context, &grid);
}

static void every_failed_allocation_is_reported_and_the_grid_goes_on(void **state)
{
    (void)state;
    fill(&clouds[0], 5000);
    ppmi_photon_grid grid = {0};
    assert_int_equal(ppmi_photon_grid_build(context, &grid, photons, 100, 0.01f, 1), PPM_STATUS_OK);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 1;
    for (; status != PPM_STATUS_OK; n++) {
        assert_true(n < 30);
        ppmi_alloc_fail_at(context, n);
        status = ppmi_photon_grid_build(context, &grid, photons, 5000, 0.001f, 3);
        ppmi_alloc_fail_at(context, 0);
        if (status == PPM_STATUS_OK) break;
        assert_int_equal(status, PPM_STATUS_OUT_OF_MEMORY);
        ppmi_photon_run runs[PPMI_GRID_MAX_RUNS];
        assert_int_equal(
            ppmi_photon_grid_lookup(&grid, vec3(0, 0, 0), 0.1f, vec3(0, 1, 0), 0.1f, runs), 0);
        /* each failure from a fresh start, so that all of the allocations take place */
        ppmi_photon_grid_deinit(context, &grid);
    }
    assert_true(n > 5);
    uint64_t found = 0;
    check_lookup(&grid, vec3_splat(0.0f), 0.5f, vec3(0, 1, 0), 1.0f, &found);
    assert_true(found > 100);
    ppmi_photon_grid_deinit(context, &grid);
}

int main(void)
{
#define WITH_CONTEXT(f) cmocka_unit_test_setup_teardown(f, open_context, close_context)
    const struct CMUnitTest tests[] = {
        WITH_CONTEXT(every_photon_near_a_point_is_in_exactly_one_run),
        WITH_CONTEXT(photons_keep_what_they_carry),
        WITH_CONTEXT(the_order_does_not_depend_on_the_threads),
        WITH_CONTEXT(an_empty_grid_finds_nothing),
        WITH_CONTEXT(runs_hold_few_photons_too_many),
        WITH_CONTEXT(every_failed_allocation_is_reported_and_the_grid_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
