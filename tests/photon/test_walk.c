/* The photon pass: energy is kept, threads do not matter, memory may run out. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "photon/walk.h"
#include "support/near.h"
#include "support/scenes.h"
#include "support/statistics.h"

static test_scene test;
static test_world world;
static atomic_bool cancel;

static int open_scene(void **state)
{
    (void)state;
    atomic_store(&cancel, false);
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

/* A closed unit box with a point light of 4 pi lumen inside. */
static void open_box(ppmi_vec3 reflectance)
{
    const ppm_material_id wall = material_lambert_rgb(test.scene, reflectance);
    shape_place(test.scene, shape_box(test.scene, wall, vec3_splat(0), vec3_splat(1), 2, true));
    light_point(test.scene, vec3(0.4f, 0.6f, 0.3f), vec3_splat(1.0f));
    world_open(&world, &test);
}

static ppmi_photon_walk walk_of(uint64_t seed, uint32_t count, uint32_t depth, uint32_t threads)
{
    return (ppmi_photon_walk){.world = &world.world,
                              .seed = seed,
                              .count = count,
                              .max_depth = depth,
                              .first_depth = 1,
                              .threads = threads,
                              .cancel = &cancel};
}

static ppmi_photon_list run(const ppmi_photon_walk *walk)
{
    ppmi_photon_scratch scratch = {0};
    ppmi_photon_list lists[PPMI_PHOTON_KINDS] = {{0}};
    uint64_t rays = 0;
    assert_int_equal(ppmi_photon_walk_run(test.context, walk, &scratch, lists, &rays),
                     PPM_STATUS_OK);
    assert_true(rays >= walk->count);
    assert_int_equal(lists[PPMI_PHOTONS_VOLUME].count, 0); /* nothing scatters here */
    ppmi_photon_scratch_deinit(test.context, &scratch);
    return lists[PPMI_PHOTONS_SURFACE];
}

static ppmi_vec3 total_power(const ppmi_photon_list *list)
{
    double sum[3] = {0.0};
    for (size_t i = 0; i < list->count; i++) {
        sum[0] += (double)list->photons[i].power.x;
        sum[1] += (double)list->photons[i].power.y;
        sum[2] += (double)list->photons[i].power.z;
    }
    return vec3((float)sum[0], (float)sum[1], (float)sum[2]);
}

/* Landings after the first carry rho + rho^2 + ... of the flux; by depth, rho^(depth - 1). */
static void stored_power_follows_the_reflectance(void **state)
{
    (void)state;
    const ppmi_vec3 reflectance = {0.5f, 0.25f, 0.75f};
    open_box(reflectance);
    const float rho[3] = {reflectance.x, reflectance.y, reflectance.z};
    const uint32_t count = TEST_EFFORT(4000);
    test_family family = {0};
    for (uint32_t depth = 1; depth <= 24; depth += depth < 4 ? 1 : 20) {
        test_mean means[3] = {{0}};
        for (uint64_t seed = 1; seed <= 24; seed++) {
            const ppmi_photon_walk walk = walk_of(seed, count, depth, 2);
            ppmi_photon_list list = run(&walk);
            const ppmi_vec3 power = vec3_scale(total_power(&list), 1.0f / (float)count);
            mean_add(&means[0], (double)power.x);
            mean_add(&means[1], (double)power.y);
            mean_add(&means[2], (double)power.z);
            ppmi_photon_list_deinit(test.context, &list);
        }
        for (int k = 0; k < 3; k++) {
            double series = 0.0;
            for (uint32_t i = 1; i < depth; i++)
                series += pow((double)rho[k], i);
            if (depth > 1) mean_check_power(&means[k], 0.005);
            family_add_mean(&family, &means[k], 4.0 * M_PI * series, 1e-5 * series,
                            "depth %u, channel %d", depth, k);
        }
    }
    family_check(&family);
}

/* From depth 0 on, what comes straight from the light is kept too: all of it, once. */
static void direct_light_is_kept_from_depth_0_only(void **state)
{
    (void)state;
    open_box(vec3_splat(0.5f));
    ppmi_photon_walk walk = walk_of(1, 2000, 1, 1);
    ppmi_photon_list list = run(&walk);
    assert_int_equal(list.count, 0);
    ppmi_photon_list_deinit(test.context, &list);
    walk.first_depth = 0;
    list = run(&walk);
    assert_int_equal(list.count, 2000);
    assert_near(total_power(&list).y / 2000.0f, 4.0 * M_PI, 1e-4);
    ppmi_photon_list_deinit(test.context, &list);
}

/* A point light in the middle of a ball of fog: the fluence of light that was not scattered,
 * integrated over the ball, is 4 pi I (1 - exp(-sigma R)) / sigma, and what the photons at their
 * first vertices stand for. */
static void photons_in_fog_stand_for_the_fluence(void **state)
{
    (void)state;
    const ppm_material_id black = material_lambert(test.scene, 0.0f);
    add_quad(test.scene, black, vec3_splat(-1), vec3(1e-3f, 0, 0), vec3(0, 1e-3f, 0));
    add_quad(test.scene, black, vec3_splat(1), vec3(-1e-3f, 0, 0), vec3(0, -1e-3f, 0));
    light_point(test.scene, vec3_splat(0), vec3_splat(1.0f));
    scene_fog(test.scene, vec3(0.5f, 0.2f, 1.0f), vec3(0.0f, 0.4f, 0.3f), 0.6f);
    world_open(&world, &test);
    const double sigma[3] = {0.5, 0.6, 1.3}, radius = sqrt(3.0) * 1.0001;
    test_mean means[3] = {{0}};
    const uint32_t count = TEST_EFFORT(4000);
    for (uint64_t seed = 1; seed <= 16; seed++) {
        ppmi_photon_walk walk = walk_of(seed, count, 1, 2);
        walk.first_depth = 0;
        ppmi_photon_scratch scratch = {0};
        ppmi_photon_list lists[PPMI_PHOTON_KINDS] = {{0}};
        uint64_t rays = 0;
        assert_int_equal(ppmi_photon_walk_run(test.context, &walk, &scratch, lists, &rays),
                         PPM_STATUS_OK);
        const ppmi_photon_list *list = &lists[PPMI_PHOTONS_VOLUME];
        for (size_t i = 0; i < list->count; i++) {
            assert_true(vec3_is_black(list->photons[i].ng));
            const ppmi_vec3 flight = vec3_normalize(list->photons[i].position);
            assert_true(vec3_dot(flight, list->photons[i].wi) < -0.999f);
        }
        const ppmi_vec3 power = total_power(list);
        mean_add(&means[0], (double)power.x / count);
        mean_add(&means[1], (double)power.y / count);
        mean_add(&means[2], (double)power.z / count);
        ppmi_photon_scratch_deinit(test.context, &scratch);
        ppmi_photon_list_deinit(test.context, &lists[PPMI_PHOTONS_SURFACE]);
        ppmi_photon_list_deinit(test.context, &lists[PPMI_PHOTONS_VOLUME]);
    }
    test_family family = {0};
    for (int k = 0; k < 3; k++) {
        mean_check_power(&means[k], 0.01);
        const double expected = 4.0 * M_PI * (1.0 - exp(-sigma[k] * radius)) / sigma[k];
        family_add_mean(&family, &means[k], expected, 2e-3 * expected, "channel %d", k);
    }
    family_check(&family);
}

/* Roulette: numbers fall by the reflectance, powers stay. */
static void roulette_keeps_the_power_of_photons(void **state)
{
    (void)state;
    open_box(vec3_splat(0.5f));
    const uint32_t count = TEST_EFFORT(50000);
    const ppmi_photon_walk walk = walk_of(3, count, 64, 2);
    ppmi_photon_list list = run(&walk);
    for (size_t i = 0; i < list.count; i++)
        assert_near(list.photons[i].power.y, 4.0 * M_PI, 1e-4);
    /* landings after the first: geometric, mean 1, variance 2 a photon */
    const double z = ((double)list.count - count) / sqrt(2.0 * count);
    assert_true(p_normal(z) > 1e-4);
    ppmi_photon_list_deinit(test.context, &list);
}

static void photons_lie_on_walls_and_come_from_inside(void **state)
{
    (void)state;
    open_box(vec3_splat(0.8f));
    const ppmi_photon_walk walk = walk_of(1, 2000, 64, 1);
    ppmi_photon_list list = run(&walk);
    assert_true(list.count > 1000);
    for (size_t i = 0; i < list.count; i++) {
        const ppmi_photon *p = &list.photons[i];
        const float off[3] = {fabsf(p->position.x - 0.5f), fabsf(p->position.y - 0.5f),
                              fabsf(p->position.z - 0.5f)};
        const float most = fmaxf(off[0], fmaxf(off[1], off[2]));
        assert_near(most, 0.5, 1e-6);
        assert_true(vec3_dot(p->wi, p->ng) > 0.0f);
        assert_near(vec3_length(p->wi), 1.0, 1e-5);
        const ppmi_vec3 inwards = vec3_sub(vec3_splat(0.5f), p->position);
        assert_true(vec3_dot(inwards, p->ng) > 0.0f);
    }
    ppmi_photon_list_deinit(test.context, &list);
}

static void assert_same(const ppmi_photon_list *a, const ppmi_photon_list *b)
{
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->photons, b->photons, a->count * sizeof *a->photons);
}

static void the_list_does_not_depend_on_the_threads(void **state)
{
    (void)state;
    open_box(vec3(0.5f, 0.6f, 0.7f));
    ppmi_photon_walk walk = walk_of(5, 10000, 32, 1);
    ppmi_photon_list first = run(&walk);
    const uint32_t threads[] = {2, 3, 7};
    for (int i = 0; i < 3; i++) {
        walk.threads = threads[i];
        ppmi_photon_list list = run(&walk);
        assert_same(&list, &first);
        ppmi_photon_list_deinit(test.context, &list);
    }
    walk.seed = 6;
    ppmi_photon_list other = run(&walk);
    assert_false(other.count == first.count &&
                 memcmp(other.photons, first.photons, sizeof *first.photons) == 0);
    ppmi_photon_list_deinit(test.context, &other);
    ppmi_photon_list_deinit(test.context, &first);
}

/* A pass is a range of the whole sequence: two passes are one of twice the length. */
static void passes_continue_each_other(void **state)
{
    (void)state;
    open_box(vec3_splat(0.5f));
    ppmi_photon_walk walk = walk_of(5, 2000, 32, 2);
    ppmi_photon_list whole = run(&walk);
    walk.count = 1000;
    ppmi_photon_scratch scratch = {0};
    ppmi_photon_list halves[PPMI_PHOTON_KINDS] = {{0}};
    uint64_t rays = 0;
    for (int half = 0; half < 2; half++) {
        walk.first_index = 1000 * (uint64_t)half;
        assert_int_equal(ppmi_photon_walk_run(test.context, &walk, &scratch, halves, &rays),
                         PPM_STATUS_OK);
    }
    for (size_t i = 0; i < halves[PPMI_PHOTONS_SURFACE].count; i++) /* numbered by their walk */
        halves[PPMI_PHOTONS_SURFACE].photons[i].path = whole.photons[i].path;
    assert_same(&halves[PPMI_PHOTONS_SURFACE], &whole);
    ppmi_photon_scratch_deinit(test.context, &scratch);
    ppmi_photon_list_deinit(test.context, &halves[PPMI_PHOTONS_SURFACE]);
    ppmi_photon_list_deinit(test.context, &whole);
}

/* Through smooth glass into a closed black box: what lands has gone through two faces. */
static void smooth_glass_keeps_energy(void **state)
{
    (void)state;
    const ppm_material_id wall = material_lambert(test.scene, 0.5f);
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    shape_place(test.scene, shape_box(test.scene, wall, vec3_splat(-2), vec3_splat(2), 1, true));
    shape_place(test.scene, shape_sphere(test.scene, glass, 1.0f, 32, true));
    light_point(test.scene, vec3(0.2f, 0.1f, 0.3f), vec3_splat(1.0f));
    world_open(&world, &test);
    /* depth 40: internal reflections die out below 2^-40; the light sits in the glass, so nothing
     * lands at depth 0, and all landings are stored: 4 pi (1 + 1/2 + ...) */
    test_mean mean = {0};
    const uint32_t count = TEST_EFFORT(4000);
    for (uint64_t seed = 1; seed <= 16; seed++) {
        const ppmi_photon_walk walk = walk_of(seed, count, 200, 2);
        ppmi_photon_list list = run(&walk);
        mean_add(&mean, (double)total_power(&list).x / count);
        ppmi_photon_list_deinit(test.context, &list);
    }
    mean_check_power(&mean, 0.005);
    test_family family = {0};
    /* rays that total reflection keeps inside: at most what leaning shading normals absorb */
    family_add_mean(&family, &mean, 8.0 * M_PI, 2e-3 * 8.0 * M_PI, "flux");
    family_check(&family);
}

static void cancelling_ends_the_walk(void **state)
{
    (void)state;
    open_box(vec3_splat(0.5f));
    atomic_store(&cancel, true);
    const ppmi_photon_walk walk = walk_of(1, 100000, 32, 2);
    ppmi_photon_scratch scratch = {0};
    ppmi_photon_list lists[PPMI_PHOTON_KINDS] = {{0}};
    uint64_t rays = 0;
    assert_int_equal(ppmi_photon_walk_run(test.context, &walk, &scratch, lists, &rays),
                     PPM_STATUS_CANCELLED);
    assert_int_equal(lists[PPMI_PHOTONS_SURFACE].count, 0);
    ppmi_photon_scratch_deinit(test.context, &scratch);
    ppmi_photon_list_deinit(test.context, &lists[PPMI_PHOTONS_SURFACE]);
}

static void every_failed_allocation_is_reported(void **state)
{
    (void)state;
    open_box(vec3_splat(0.8f));
    const size_t live = ppmi_alloc_live(test.context);
    const ppmi_photon_walk walk = walk_of(1, 5000, 32, 3);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 1;
    for (; status != PPM_STATUS_OK; n++) {
        ppmi_photon_scratch scratch = {0};
        ppmi_photon_list lists[PPMI_PHOTON_KINDS] = {{0}};
        uint64_t rays = 0;
        ppmi_alloc_fail_at(test.context, n);
        status = ppmi_photon_walk_run(test.context, &walk, &scratch, lists, &rays);
        ppmi_alloc_fail_at(test.context, 0);
        assert_true(status == PPM_STATUS_OK || status == PPM_STATUS_OUT_OF_MEMORY);
        ppmi_photon_scratch_deinit(test.context, &scratch);
        ppmi_photon_list_deinit(test.context, &lists[PPMI_PHOTONS_SURFACE]);
        assert_int_equal(ppmi_alloc_live(test.context), live);
    }
    assert_true(n > 5);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(stored_power_follows_the_reflectance),
        WITH_SCENE(direct_light_is_kept_from_depth_0_only),
        WITH_SCENE(photons_in_fog_stand_for_the_fluence),
        WITH_SCENE(roulette_keeps_the_power_of_photons),
        WITH_SCENE(photons_lie_on_walls_and_come_from_inside),
        WITH_SCENE(the_list_does_not_depend_on_the_threads),
        WITH_SCENE(passes_continue_each_other),
        WITH_SCENE(smooth_glass_keeps_energy),
        WITH_SCENE(cancelling_ends_the_walk),
        WITH_SCENE(every_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
