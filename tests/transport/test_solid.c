/* Nested solids: which indices light meets where surfaces touch, overlap, or stand alone.
 *
 * Paths are followed deterministically: at each surface the transmitted branch is taken, and the
 * product of the branches' weights is held against Fresnel's formulas. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"
#include "transport/solid.h"

static test_scene test;
static test_world world;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    world = (test_world){0};
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    world_close(&world);
    scene_close(&test);
    return 0;
}

static void begin_again(void)
{
    world_close(&world);
    world = (test_world){0};
    scene_close(&test);
    scene_open(&test);
}

static ppm_material_id solid(float ior, int32_t priority)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    desc.ior = ior;
    desc.nested_priority = priority;
    return material_add(test.scene, &desc);
}

static void add_box(ppm_material_id material, ppmi_vec3 low, ppmi_vec3 high)
{
    shape_place(test.scene, shape_box(test.scene, material, low, high, 1, false));
}

static double fresnel(double cosine, double eta)
{
    const double sine = sqrt(1.0 - cosine * cosine) / eta;
    if (sine >= 1.0) return 1.0;
    const double t = sqrt(1.0 - sine * sine);
    const double s = (cosine - eta * t) / (cosine + eta * t);
    const double p = (eta * cosine - t) / (eta * cosine + t);
    return 0.5 * (s * s + p * p);
}

typedef struct straight_path {
    uint32_t surfaces;
    double power;        /* of a photon that is transmitted everywhere */
    ppmi_vec3 direction; /* at last */
    bool escaped;
    uint32_t material; /* of the surface that ended it, else irrelevant */
    ppmi_interior interior;
} straight_path;

/* Follows the transmitted branch until there is none. */
static straight_path follow(ppmi_vec3 origin, ppmi_vec3 direction)
{
    ppmi_walker walker = {.world = &world.world};
    ppmi_walker_start(&walker, ppmi_rng_start(1, PPMI_STREAM_PHOTON, 0), 1, 0, 0, 0);
    straight_path path = {.power = 1.0, .direction = vec3_normalize(direction)};
    ppmi_ray ray = {.origin = origin, .t_max = INFINITY, .direction = path.direction};
    for (int i = 0; i < 20; i++) {
        ppmi_vertex vertex;
        path.interior = walker.interior;
        path.escaped = ppmi_walk(&walker, ray, PPMI_RAY_OTHER, &vertex) == PPMI_ESCAPED;
        path.interior = walker.interior;
        if (path.escaped) break;
        path.material = vertex.surface.primitive->material;
        ppmi_bsdf bsdf;
        ppmi_walk_bsdf(&walker, &vertex, ray.direction, &bsdf);
        ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
        const uint32_t count = ppmi_bsdf_branches(&bsdf, walker.world->albedo, PPMI_LOBE_ALL,
                                                  PPMI_TRANSPORT_POWER, samples);
        if (count == 0 || !samples[count - 1].is_transmission) break;
        ppmi_vec3 throughput = vec3_splat(1.0f);
        ray = ppmi_walk_leave(&walker, &vertex, &samples[count - 1], &throughput);
        path.power *= (double)(samples[count - 1].weight.y * throughput.y);
        path.direction = ray.direction;
        path.surfaces++;
    }
    return path;
}

/* Through parallel interfaces between the given indices, beginning in the first. */
static double layers_power(const double *indices, int count, double sine)
{
    double power = 1.0;
    for (int i = 0; i + 1 < count; i++) {
        const double inside = sine * indices[0] / indices[i];
        power *= 1.0 - fresnel(sqrt(1.0 - inside * inside), indices[i + 1] / indices[i]);
    }
    return power;
}

/* Holds paths at several angles, through several places, against layers of the given indices; the
 * path goes along -y, or against it, through horizontal faces and ends outside of everything. */
static void check_layers(const double *indices, int count, float y, bool upwards)
{
    for (float sine = 0.0f; sine < 0.95f; sine += 0.1f) {
        for (int place = 0; place < 40; place++) {
            const float x = -0.2f + 0.011f * (float)place, z = 0.17f - 0.0083f * (float)place;
            const float turn = 0.4f * (float)place;
            const float along = upwards ? 1.0f : -1.0f;
            const ppmi_vec3 d =
                vec3(sine * cosf(turn), along * sqrtf(1.0f - sine * sine), sine * sinf(turn));
            /* it goes through the place at the middle of the layers */
            const straight_path path = follow(vec3(x, y, z), d);
            if (!path.escaped || (int)path.surfaces != count - 1) {
                fail_msg("sine %g, place %d: %u surfaces instead of %d, escaped %d", (double)sine,
                         place, path.surfaces, count - 1, path.escaped);
            }
            const double expected = layers_power(indices, count, (double)sine);
            assert_near(path.power, expected, 1e-4);
            const double out = (double)sine * indices[0] / indices[count - 1];
            assert_near(hypot((double)path.direction.x, (double)path.direction.z), out, 1e-4);
            assert_int_equal(path.interior.count, 0);
        }
    }
}

/* A floor of glass with water on it, both boxes wide, in awkward numbers. water_low: where the
 * water's own bottom is; the glass's top is at 0.3. */
static void add_water_on_glass(float water_low, int32_t glass_priority, bool is_glass_first)
{
    const ppm_material_id glass = solid(1.5f, glass_priority), water = solid(1.33f, 0);
    const ppmi_vec3 glass_low = vec3(-9.1f, 0.1f, -8.7f), glass_high = vec3(9.3f, 0.3f, 8.9f);
    if (is_glass_first) add_box(glass, glass_low, glass_high);
    add_box(water, vec3(-9.1f, water_low, -8.7f), vec3(9.3f, 0.7f, 8.9f));
    if (!is_glass_first) add_box(glass, glass_low, glass_high);
    world_open(&world, &test);
}

static const double down_through[4] = {1.0, 1.33, 1.5, 1.0}, up_through[4] = {1.0, 1.5, 1.33, 1.0};

static void water_that_touches_its_glass_is_one_interface(void **state)
{
    (void)state;
    for (int order = 0; order < 2; order++) {
        if (order) begin_again();
        add_water_on_glass(0.3f, 0, order == 0);
        check_layers(down_through, 4, 1.0f, false);
        check_layers(up_through, 4, -0.2f, true);
    }
}

/* Faces that should be at one place and differ by rounding. */
static void water_that_almost_touches_its_glass_is_one_interface(void **state)
{
    (void)state;
    const float steps[4] = {-2e-7f, -6e-8f, 6e-8f, 2e-7f};
    for (int i = 0; i < 4; i++) {
        begin_again();
        add_water_on_glass(0.3f + steps[i], 0, true);
        check_layers(down_through, 4, 1.0f, false);
        check_layers(up_through, 4, -0.2f, true);
    }
}

static void water_that_overlaps_its_glass_is_one_interface(void **state)
{
    (void)state;
    const int32_t priorities[3] = {0, 1, -1};
    for (int i = 0; i < 3; i++) {
        begin_again();
        add_water_on_glass(0.299f, priorities[i], true);
        check_layers(down_through, 4, 1.0f, false);
        check_layers(up_through, 4, -0.2f, true);
    }
}

/* Water with a gap of air to the glass is something else: the other tests can fail. */
static void a_gap_of_air_is_seen(void **state)
{
    (void)state;
    add_water_on_glass(0.301f, 0, true);
    const double down[5] = {1.0, 1.33, 1.0, 1.5, 1.0};
    check_layers(down, 5, 1.0f, false);
}

/* A box of air in the glass: its faces point inwards, of the same material. */
static void a_hollow_in_glass_is_air(void **state)
{
    (void)state;
    const ppm_material_id glass = solid(1.5f, 0);
    add_box(glass, vec3_splat(-9), vec3_splat(9));
    shape_place(test.scene,
                shape_box(test.scene, glass, vec3(-8, -0.1f, -8), vec3(8, 0.1f, 8), 1, true));
    world_open(&world, &test);
    const double layers[5] = {1.0, 1.5, 1.0, 1.5, 1.0};
    const straight_path path = follow(vec3(0.1f, 10, 0.2f), vec3(0.3f, -1, 0.1f));
    const double sine = sqrt(0.1 / 1.1);
    assert_int_equal(path.surfaces, 4);
    assert_near(path.power, layers_power(layers, 5, sine), 1e-4);
}

/* A bubble as a solid of its own, of index 1, entered last. */
static void a_bubble_of_its_own_material_is_air(void **state)
{
    (void)state;
    add_box(solid(1.5f, 0), vec3(-90, -9, -90), vec3(90, 9, 90));
    add_box(solid(1.0f, 0), vec3(-80, -0.1f, -80), vec3(80, 0.1f, 80));
    world_open(&world, &test);
    const double layers[5] = {1.0, 1.5, 1.0, 1.5, 1.0};
    check_layers(layers, 5, 9.5f, false);
}

/* What counts for less is not there inside of what counts for more: no surface is seen. */
static void a_low_priority_inside_a_high_one_is_not_seen(void **state)
{
    (void)state;
    add_box(solid(1.5f, 1), vec3(-90, -9, -90), vec3(90, 9, 90));
    add_box(solid(1.1f, 0), vec3(-80, -0.1f, -80), vec3(80, 0.1f, 80));
    world_open(&world, &test);
    const double layers[3] = {1.0, 1.5, 1.0};
    check_layers(layers, 3, 9.5f, false);
}

/* An open sheet with its normal up: water below, whatever ends it. */
static void an_open_sheet_has_water_on_one_side(void **state)
{
    (void)state;
    const ppm_material_id water = solid(1.33f, 0), floor = material_lambert(test.scene, 0.5f);
    add_quad(test.scene, water, vec3(-9, 0, -9), vec3(0, 0, 18), vec3(18, 0, 0));
    add_quad(test.scene, floor, vec3(-9, -1, -9), vec3(0, 0, 18), vec3(18, 0, 0));
    world_open(&world, &test);
    const straight_path down = follow(vec3(0, 1, 0), vec3(0.6f, -0.8f, 0));
    assert_int_equal(down.surfaces, 1);
    assert_false(down.escaped);
    assert_near(down.direction.x, 0.6 / 1.33, 1e-5);
    assert_near(down.power, 1.0 - fresnel(0.8, 1.33), 1e-5);
    assert_int_equal(down.interior.count, 1);
    const straight_path up = follow(vec3(0, -0.5f, 0), vec3(0.6f, 0.8f, 0));
    assert_true(up.escaped);
    assert_near(up.direction.x, 0.6 * 1.33, 1e-5);
    assert_near(up.power, 1.0 - fresnel(0.8, 1.0 / 1.33), 1e-5);
    assert_int_equal(up.interior.count, 0);
}

/* Beyond the critical angle nothing goes through, and the path stays inside. */
static void a_camera_in_water_sees_total_reflection(void **state)
{
    (void)state;
    add_box(solid(1.33f, 0), vec3_splat(-5), vec3_splat(5));
    world_open(&world, &test);
    const straight_path steep = follow(vec3(0, 0, 0), vec3(0.7f, 0.714f, 0));
    assert_true(steep.escaped);
    const straight_path flat = follow(vec3(0, 4.9f, 0), vec3(0.8f, 0.6f, 0));
    assert_false(flat.escaped);
    assert_int_equal(flat.surfaces, 0);
    assert_int_equal(flat.interior.count, 1); /* the surface told it */
}

/* ---- glass on a table ------------------------------------------------------------------------ */

static void what_stands_in_a_solid_is_known_to(void **state)
{
    (void)state;
    add_box(solid(1.33f, 0), vec3_splat(-5), vec3_splat(5));
    add_box(solid(1.5f, 0), vec3_splat(-1), vec3_splat(1));
    add_quad(test.scene, solid(1.3f, 0), vec3(20, 0, 20), vec3(0, 0, 9), vec3(9, 0, 0));
    world_open(&world, &test);
    assert_int_equal(ppmi_solids_around(&world.world, vec3(0.1f, -7, 0.2f)).count, 0);
    assert_int_equal(ppmi_solids_around(&world.world, vec3(0.1f, 7, 0.2f)).count, 0);
    assert_int_equal(ppmi_solids_around(&world.world, vec3(0.1f, -3, 0.2f)).count, 1);
    const ppmi_interior both = ppmi_solids_around(&world.world, vec3(0.1f, 0.3f, 0.2f));
    assert_int_equal(both.count, 2);
    /* the inner one counts, as the one that was entered last */
    assert_near(test.scene->materials[ppmi_interior_material(&both, test.scene)].desc.ior, 1.5,
                1e-6);
    /* under an open sheet and above it */
    assert_int_equal(ppmi_solids_around(&world.world, vec3(24, -1, 24)).count, 1);
    assert_int_equal(ppmi_solids_around(&world.world, vec3(24, 1, 24)).count, 0);
}

/* Photons ask for what is around them only where there may be something. */
static void photons_know_the_solids_that_they_begin_in(void **state)
{
    (void)state;
    ppmi_rng rng = ppmi_rng_start(8, PPMI_STREAM_PHOTON, 0);
    for (int i = 0; i < 30; i++) { /* more than are told apart */
        const ppmi_vec3 low =
            vec3(20 * ppmi_rng_float(&rng), 9 * ppmi_rng_float(&rng), 20 * ppmi_rng_float(&rng));
        add_box(solid(1.4f, 0), low, vec3_add(low, vec3(1, 2, 1.5f)));
    }
    add_quad(test.scene, solid(1.3f, 0), vec3(22, 3, 2), vec3(0, 0, 9), vec3(9, 0, 0));
    world_open(&world, &test);
    ppmi_solids_memory memory = {.is_known = false};
    uint32_t inside = 0, outside = 0;
    for (int i = 0; i < 4000; i++) {
        const ppmi_ray ray = {.origin =
                                  vec3(32 * ppmi_rng_float(&rng), 14 * ppmi_rng_float(&rng) - 2,
                                       22 * ppmi_rng_float(&rng))};
        const ppmi_interior expected = ppmi_solids_around(&world.world, ray.origin);
        const ppmi_interior found = ppmi_solids_around_photon(&world.world, &ray, false, &memory);
        const ppmi_interior again = ppmi_solids_around_photon(&world.world, &ray, false, &memory);
        assert_int_equal(found.count, expected.count);
        assert_int_equal(again.count, expected.count);
        for (uint32_t k = 0; k < found.count; k++)
            assert_int_equal(found.materials[k], expected.materials[k]);
        inside += found.count > 0;
        outside += found.count == 0;
        assert_int_equal(ppmi_solids_around_photon(&world.world, &ray, true, &memory).count, 0);
    }
    assert_true(inside > 100 && outside > 100);
}

/* Rays down through the glass end on the table below it, in optical contact, wherever the faces lie
 * by rounding; rays up from the table are in the glass. */
static void check_table(float glass_low, ppmi_vec3 moved)
{
    begin_again();
    const ppm_material_id table = material_lambert(test.scene, 0.5f);
    const ppm_material_id glass = solid(1.5f, 0);
    shape_place_at(test.scene,
                   shape_box(test.scene, table, vec3(-3, -0.2f, -3), vec3(3, 0, 3), 1, false),
                   moved);
    shape_place_at(
        test.scene,
        shape_box(test.scene, glass, vec3(-1, glass_low, -1), vec3(1, 0.5f, 1), 1, false), moved);
    world_open(&world, &test);
    const uint32_t table_index =
        world.world.scene->meshes[world.world.scene->instances[0].mesh].primitives[0].material;
    ppmi_walker walker = {.world = &world.world};
    for (int i = 0; i < 400; i++) {
        const float x = -0.6f + 0.00301f * (float)i, z = 0.55f - 0.00277f * (float)i;
        const ppmi_vec3 d = vec3(0.3f * sinf((float)i), -1.0f, 0.3f * cosf((float)i));
        const straight_path path = follow(vec3_add(moved, vec3(x, 0.8f, z)), d);
        if (path.escaped || path.material != table_index || path.surfaces != 1) {
            fail_msg(
                "glass at %g moved by %g: ray %d ends on material %u after %u surfaces, escaped %d",
                (double)glass_low, (double)moved.y, i, path.material, path.surfaces, path.escaped);
        }
        /* on from the table: straight to the glass's other faces */
        ppmi_walker_start(&walker, ppmi_rng_start(1, PPMI_STREAM_PHOTON, 0), 1, 0, 0, 0);
        ppmi_ray ray = {.origin = vec3_add(moved, vec3(x, 0.8f, z)),
                        .t_max = INFINITY,
                        .direction = vec3_normalize(d)};
        ppmi_vertex vertex;
        ppmi_bsdf bsdf;
        ppmi_bsdf_sample samples[PPMI_BSDF_MAX_BRANCHES];
        assert_int_equal(ppmi_walk(&walker, ray, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
        ppmi_walk_bsdf(&walker, &vertex, ray.direction, &bsdf);
        const uint32_t count = ppmi_bsdf_branches(&bsdf, walker.world->albedo, PPMI_LOBE_ALL,
                                                  PPMI_TRANSPORT_POWER, samples);
        ppmi_vec3 throughput = vec3_splat(1.0f);
        ray = ppmi_walk_leave(&walker, &vertex, &samples[count - 1], &throughput);
        assert_int_equal(ppmi_walk(&walker, ray, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
        const ppmi_bsdf_sample up = {
            .wi = vec3_normalize(vec3(0.8f * cosf((float)i), 0.6f, 0.8f * sinf((float)i)))};
        ray = ppmi_walk_leave(&walker, &vertex, &up, &throughput);
        assert_int_equal(ppmi_walk(&walker, ray, PPMI_RAY_OTHER, &vertex), PPMI_AT_SURFACE);
        if (!(vertex.distance > 0.01f)) {
            fail_msg(
                "glass at %g moved by %g: ray %d goes up from the table into the glass's bottom",
                (double)glass_low, (double)moved.y, i);
        }
    }
}

static void a_glass_on_a_table_does_not_leak(void **state)
{
    (void)state;
    check_table(0.0f, vec3(0, 0, 0));
    check_table(0.0f, vec3(0.3f, 0.7f, -0.1f));
    check_table(0.0f, vec3(33.3f, 70.1f, -10.7f));
    const float steps[6] = {-1e-6f, -3e-7f, -6e-8f, 6e-8f, 3e-7f, 1e-6f};
    for (int i = 0; i < 6; i++)
        check_table(steps[i], vec3(0.3f, 0.7f, -0.1f));
}

/* ---- absorption ------------------------------------------------------------------------------ */

static ppm_material_id coloured_solid(float ior)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    desc.ior = ior;
    desc.attenuation_color[0] = 0.5f;
    desc.attenuation_color[1] = 0.25f;
    desc.attenuation_color[2] = 1.0f;
    desc.attenuation_distance_m = 0.4f;
    return material_add(test.scene, &desc);
}

static double measure_red(const float *rgba, const ppm_render_options *options, void *user)
{
    (void)user;
    double sum = 0.0;
    for (uint32_t i = 0; i < options->width * options->height; i++)
        sum += (double)rgba[4 * i];
    return sum / (options->width * options->height);
}

/* A lamp in coloured glass is dimmed by the glass between it and the eye, from outside and from a
 * camera within the glass; index 1: nothing else happens. */
static void a_lamp_inside_coloured_glass_is_dimmed(void **state)
{
    (void)state;
    add_box(coloured_solid(1.0f), vec3_splat(-1), vec3_splat(1));
    add_quad(test.scene, material_emitter(test.scene, 2.0f, 0.0f, true), vec3(-0.5f, -0.5f, 0.2f),
             vec3(1, 0, 0), vec3(0, 1, 0));
    camera_orthographic(test.scene, vec3(0, 0, 3), vec3(0, 0, 0), 0.1f);
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i++) {
        const ppm_render_options options = render_options(i, 4, 100);
        const test_mean red = render_means(test.scene, &options, 2, 2, measure_red, NULL);
        const test_mean green = render_green(test.scene, &options, 2, 2);
        assert_near(red.mean, 2.0 * pow(0.5, 0.8 / 0.4), 1e-4);
        assert_near(green.mean, 2.0 * pow(0.25, 0.8 / 0.4), 1e-4);
    }
}

/* A white ball under a sky, all in coloured glass of index 1: light that comes straight goes
 * through the glass twice. */
static void a_thing_inside_coloured_glass_is_lit_through_it(void **state)
{
    (void)state;
    /* wide and flat: rays from above have 0.3 m of glass each way over their cosine */
    add_box(coloured_solid(1.0f), vec3(-20, 0, -20), vec3(20, 0.3f, 20));
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-20, 0.1f, -20), vec3(0, 0, 40),
             vec3(40, 0, 0));
    light_directional(test.scene, vec3(0.6f, -0.8f, 0), vec3_splat(2.0f));
    camera_orthographic(test.scene, vec3(0, 2, 0), vec3(0, 0, 0), 0.5f);
    const double way = 0.2 / 0.8 + 0.2, lambert = 2.0 * 0.8 * 0.5 / M_PI;
    test_family family = {0};
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PPM; i += 2) {
        ppm_render_options options = render_options(i, 16, 40000);
        options.radius_m = 1.0f;
        const test_mean red = render_means(test.scene, &options, 2, 12, measure_red, NULL);
        const test_mean green = render_green(test.scene, &options, 2, 12);
        mean_check_power(&green, 0.02);
        family_add_mean(&family, &red, lambert * pow(0.5, way / 0.4), 1e-5, "red %d", i);
        family_add_mean(&family, &green, lambert * pow(0.25, way / 0.4), 1e-5, "green %d", i);
    }
    family_check(&family);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(water_that_touches_its_glass_is_one_interface),
        WITH_SCENE(water_that_almost_touches_its_glass_is_one_interface),
        WITH_SCENE(water_that_overlaps_its_glass_is_one_interface),
        WITH_SCENE(a_gap_of_air_is_seen),
        WITH_SCENE(a_hollow_in_glass_is_air),
        WITH_SCENE(a_bubble_of_its_own_material_is_air),
        WITH_SCENE(a_low_priority_inside_a_high_one_is_not_seen),
        WITH_SCENE(an_open_sheet_has_water_on_one_side),
        WITH_SCENE(a_camera_in_water_sees_total_reflection),
        WITH_SCENE(what_stands_in_a_solid_is_known_to),
        WITH_SCENE(photons_know_the_solids_that_they_begin_in),
        WITH_SCENE(a_glass_on_a_table_does_not_leak),
        WITH_SCENE(a_lamp_inside_coloured_glass_is_dimmed),
        WITH_SCENE(a_thing_inside_coloured_glass_is_lit_through_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
