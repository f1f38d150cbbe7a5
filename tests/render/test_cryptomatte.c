/* Mattes by name: ids, coverage, ranks, manifests. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/crypto_layer.h"
#include "render/crypto_name.h"
#include "render/layer_fixture.h"
#include "support/near.h"

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

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Coverage of an id in a pixel, by its pairs of ranks. */
typedef struct mattes {
    float *pairs[PPMI_CRYPTO_MAX_RANKS / 2];
    uint32_t count;
} mattes;

static mattes read_mattes(const ppm_render *render, int32_t kind)
{
    mattes result = {.count = ppm_render_get_options(render)->cryptomatte_ranks / 2};
    for (uint32_t i = 0; i < result.count; i++)
        result.pairs[i] = layers_read(render, kind, i);
    return result;
}

static void free_mattes(mattes *all)
{
    for (uint32_t i = 0; i < all->count; i++)
        free(all->pairs[i]);
}

static double coverage_of(const mattes *all, size_t pixel, const char *name)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < all->count; i++) {
        for (int k = 0; k < 2; k++) {
            const float *entry = all->pairs[i] + 4 * pixel + 2 * k;
            if (bits_of(entry[0]) == ppmi_crypto_id(name)) sum += (double)entry[1];
        }
    }
    return sum;
}

static double coverage_sum(const mattes *all, size_t pixel)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < all->count; i++)
        sum += (double)all->pairs[i][4 * pixel + 1] + (double)all->pairs[i][4 * pixel + 3];
    return sum;
}

/* ---- bad input ------------------------------------------------------------------------------- */

static void odd_or_too_many_ranks_are_refused(void **state)
{
    (void)state;
    layers_add_quad(test.scene, "a", material_lambert(test.scene, 0.5f), vec3(-1, -1, 0),
                    vec3(2, 0, 0), vec3(0, 2, 0));
    const uint32_t ranks[] = {1, 7, 33, 34, UINT32_MAX};
    for (size_t i = 0; i < sizeof ranks / sizeof ranks[0]; i++) {
        ppm_render_options options = layers_options(4, PPM_LAYER_CRYPTO_OBJECT);
        options.cryptomatte_ranks = ranks[i];
        ppm_render *render = NULL;
        assert_int_equal(ppm_render_create(test.scene, &options, &render),
                         PPM_STATUS_INVALID_ARGUMENT);
        assert_null(render);
    }
}

static void a_manifest_is_only_of_what_the_session_has(void **state)
{
    (void)state;
    layers_add_quad(test.scene, "a", material_lambert(test.scene, 0.5f), vec3(-1, -1, 0),
                    vec3(2, 0, 0), vec3(0, 2, 0));
    const ppm_render_options options = layers_options(4, PPM_LAYER_CRYPTO_OBJECT);
    ppm_render *render = layers_render(test.scene, &options, 0);
    const char *json = NULL;
    assert_int_equal(ppm_render_cryptomatte_manifest(NULL, PPM_LAYER_CRYPTO_OBJECT, &json),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_int_equal(ppm_render_cryptomatte_manifest(render, PPM_LAYER_CRYPTO_OBJECT, NULL),
                     PPM_STATUS_INVALID_ARGUMENT);
    const int32_t kinds[] = {PPM_LAYER_CRYPTO_MATERIAL, PPM_LAYER_CRYPTO_ASSET, PPM_LAYER_UV,
                             PPM_LAYER_KINDS, -1};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        assert_int_equal(ppm_render_cryptomatte_manifest(render, kinds[i], &json),
                         PPM_STATUS_INVALID_ARGUMENT);
    }
    assert_null(json);
    ppm_render_destroy(render);
}

static void any_failed_allocation_leaves_nothing(void **state)
{
    (void)state;
    layers_add_quad(test.scene, "a", material_lambert(test.scene, 0.5f), vec3(-1, -1, 0),
                    vec3(2, 0, 0), vec3(0, 2, 0));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    ppm_render_options options = layers_options(4, PPM_LAYER_CRYPTO_OBJECT);
    options.layers = 0;
    for (int32_t kind = PPM_LAYER_ALBEDO; kind <= PPM_LAYER_CRYPTO_ASSET; kind++)
        options.layers |= PPM_LAYER_BIT(kind);
    /* what the scene keeps from session to session is there then */
    ppm_render_destroy(layers_render(test.scene, &options, 0));
    const size_t before = ppmi_alloc_live(test.context);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    for (size_t n = 1; status == PPM_STATUS_OUT_OF_MEMORY; n++) {
        ppm_render *render = NULL;
        ppmi_alloc_fail_at(test.context, n);
        status = ppm_render_create(test.scene, &options, &render);
        ppmi_alloc_fail_at(test.context, 0);
        ppm_render_destroy(render);
        assert_int_equal(ppmi_alloc_live(test.context), before);
    }
    assert_int_equal(status, PPM_STATUS_OK);
}

/* ---- coverage -------------------------------------------------------------------------------- */

/* Left of x = edge one quad, right of it, nearer, another; nothing above y = top. */
static void add_two(float edge, float top)
{
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    layers_add_quad(test.scene, "behind", grey, vec3(-3, -3, 0), vec3(6, 0, 0),
                    vec3(0, top + 3, 0));
    layers_add_quad(test.scene,
                    "m\xc3\xa4"
                    "dchen",
                    grey, vec3(edge, -3, 1), vec3(3, 0, 0), vec3(0, top + 3, 0));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
}

enum { WIDTH = 4, PASSES = 256 };

/* Pixels are 0.5 m wide, the edge is 0.3 of a pixel from the left of column 2. The samples of a
 * pixel are stratified: they are off by much less than independent ones. */
static void coverage_is_the_share_of_the_pixel(void **state)
{
    (void)state;
    add_two(0.15f, 3.0f);
    const double independent = sqrt(0.3 * 0.7 / PASSES);
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        ppm_render_options options = layers_options(WIDTH, PPM_LAYER_CRYPTO_OBJECT);
        options.integrator = i;
        options.radius_m = 0.1f;
        ppm_render *render = layers_render(test.scene, &options, PASSES);
        mattes all = read_mattes(render, PPM_LAYER_CRYPTO_OBJECT);
        for (size_t pixel = 0; pixel < WIDTH * WIDTH; pixel++) {
            const size_t column = pixel % WIDTH;
            const double behind = column < 2 ? 1.0 : column == 2 ? 0.3 : 0.0;
            assert_near(coverage_of(&all, pixel, "behind"), behind, column == 2 ? independent : 0);
            assert_near(coverage_sum(&all, pixel), 1.0, 1e-6);
        }
        free_mattes(&all);
        ppm_render_destroy(render);
    }
}

static void the_larger_share_has_the_first_rank(void **state)
{
    (void)state;
    add_two(0.15f, 3.0f);
    const ppm_render_options options = layers_options(WIDTH, PPM_LAYER_CRYPTO_OBJECT);
    float *values = layers_picture(test.scene, &options, 64, PPM_LAYER_CRYPTO_OBJECT);
    const float *edge = values + 4 * 2, *flat = values;
    assert_int_equal(bits_of(edge[0]), ppmi_crypto_id("m\xc3\xa4"
                                                      "dchen"));
    assert_int_equal(bits_of(edge[2]), ppmi_crypto_id("behind"));
    assert_true(edge[1] > edge[3] && edge[3] > 0.0f);
    assert_int_equal(bits_of(flat[0]), ppmi_crypto_id("behind"));
    assert_true(flat[1] == 1.0f && flat[2] == 0.0f && flat[3] == 0.0f);
    free(values);
}

static void where_nothing_is_hit_there_is_no_id(void **state)
{
    (void)state;
    add_two(0.15f, 0.0f); /* the upper half is empty, rows 0 and 1 */
    const ppm_render_options options = layers_options(WIDTH, PPM_LAYER_CRYPTO_OBJECT);
    ppm_render *render = layers_render(test.scene, &options, 16);
    mattes all = read_mattes(render, PPM_LAYER_CRYPTO_OBJECT);
    for (size_t pixel = 0; pixel < WIDTH * WIDTH; pixel++)
        assert_near(coverage_sum(&all, pixel), pixel / WIDTH < 2 ? 0.0 : 1.0, 1e-6);
    for (uint32_t i = 0; i < all.count; i++)
        for (int k = 0; k < 4; k++)
            assert_true(all.pairs[i][k] == 0.0f);
    free_mattes(&all);
    ppm_render_destroy(render);
}

/* A black veil before a lamp of 1: light is seen where the matte says that the lamp is, sample by
 * sample, which is more than the same on average. */
static void a_veil_covers_as_in_the_picture(void **state)
{
    (void)state;
    ppm_material_desc veil;
    ppm_material_desc_init(&veil);
    veil.base_color[0] = veil.base_color[1] = veil.base_color[2] = 0.0f;
    veil.base_color[3] = 0.3f;
    veil.specular = 0.0f;
    veil.alpha_mode = PPM_ALPHA_BLEND;
    const ppm_material_id lamp = material_emitter(test.scene, 1.0f, 0.0f, true);
    layers_add_quad(test.scene, "veil", material_add(test.scene, &veil), vec3(-2, -2, 1),
                    vec3(4, 0, 0), vec3(0, 4, 0));
    layers_add_quad(test.scene, "lamp", lamp, vec3(-2, -2, 0), vec3(4, 0, 0), vec3(0, 4, 0));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    test_mean mean = {0};
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        for (int mode = 0; mode < 2; mode++) {
            ppm_render_options options = layers_options(8, PPM_LAYER_CRYPTO_OBJECT);
            options.integrator = i;
            options.radius_m = 0.1f;
            if (i == PPM_INTEGRATOR_PPM && mode == 1) options.photons_per_epoch = 4000;
            ppm_render *render = layers_render(test.scene, &options, 64);
            mattes all = read_mattes(render, PPM_LAYER_CRYPTO_OBJECT);
            float *picture = layers_read(render, PPM_LAYER_COMBINED, 0);
            for (size_t pixel = 0; pixel < 64; pixel++) {
                const double lamp_coverage = coverage_of(&all, pixel, "lamp");
                assert_near(lamp_coverage, picture[4 * pixel], 1e-4);
                assert_near(coverage_of(&all, pixel, "veil"), 1.0 - lamp_coverage, 1e-6);
                if (i == PPM_INTEGRATOR_PATH) mean_add(&mean, lamp_coverage);
            }
            free(picture);
            free_mattes(&all);
            ppm_render_destroy(render);
        }
    }
    test_family family = {0};
    family_add_mean(&family, &mean, 0.7, 0.0, "the lamp");
    family_check(&family);
}

/* ---- names ----------------------------------------------------------------------------------- */

static void equal_names_share_an_id(void **state)
{
    (void)state;
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    layers_add_quad(test.scene, "leaf", grey, vec3(-2, -2, 0), vec3(2, 0, 0), vec3(0, 4, 0));
    layers_add_quad(test.scene, "leaf", grey, vec3(0, -2, 0), vec3(2, 0, 0), vec3(0, 4, 0));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    const ppm_render_options options = layers_options(3, PPM_LAYER_CRYPTO_OBJECT);
    ppm_render *render = layers_render(test.scene, &options, 8);
    float *values = layers_read(render, PPM_LAYER_CRYPTO_OBJECT, 0);
    for (size_t pixel = 0; pixel < 9; pixel++) {
        assert_true(values[4 * pixel + 1] == 1.0f);
        assert_true(values[4 * pixel + 3] == 0.0f);
    }
    const char *json = NULL;
    assert_int_equal(ppm_render_cryptomatte_manifest(render, PPM_LAYER_CRYPTO_OBJECT, &json),
                     PPM_STATUS_OK);
    char expected[64];
    snprintf(expected, sizeof expected, "{\"leaf\":\"%08x\"}", (unsigned)ppmi_crypto_id("leaf"));
    assert_string_equal(json, expected);
    free(values);
    ppm_render_destroy(render);
}

static ppm_instance_id add_part(const char *name, const char *asset, ppm_material_id material,
                                float x)
{
    const ppm_instance_desc desc = {
        .size = sizeof desc,
        .name = name,
        .asset = asset,
        .mesh = shape_quad(test.scene, material, vec3(x, -2, 0), vec3(1, 0, 0), vec3(0, 4, 0)),
        .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    ppm_instance_id id = 0;
    assert_int_equal(ppm_scene_add_instance(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

static ppm_material_id add_named_material(const char *name)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.name = name;
    return material_add(test.scene, &desc);
}

/* Columns of 1 m: two parts of a car, one thing by itself, one without any name. */
static void objects_materials_and_assets_are_told_apart(void **state)
{
    (void)state;
    const ppm_material_id paint = add_named_material("pa\"int"), none = add_named_material(NULL);
    add_part("wheel", "car", paint, -2);
    add_part("door", "car", none, -1);
    add_part("tree", NULL, paint, 0);
    const ppm_instance_id unnamed = add_part(NULL, NULL, paint, 1);
    assert_int_equal(ppm_scene_set_instance_visible(
                         test.scene, add_part("hidden", "hidden", add_named_material("h"), 2), 0),
                     PPM_STATUS_OK);
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 2.0f);
    ppm_render_options options = layers_options(4, PPM_LAYER_CRYPTO_OBJECT);
    options.layers |=
        PPM_LAYER_BIT(PPM_LAYER_CRYPTO_MATERIAL) | PPM_LAYER_BIT(PPM_LAYER_CRYPTO_ASSET);
    ppm_render *render = layers_render(test.scene, &options, 2);
    char made[32], made_material[32];
    snprintf(made, sizeof made, "unnamed.%u", unnamed);
    snprintf(made_material, sizeof made_material, "unnamed.%u", none);
    const char *expected[3][4] = {{"wheel", "door", "tree", made},
                                  {"pa\"int", made_material, "pa\"int", "pa\"int"},
                                  {"car", "car", "tree", made}};
    for (int32_t i = 0; i < 3; i++) {
        mattes all = read_mattes(render, PPM_LAYER_CRYPTO_OBJECT + i);
        for (size_t pixel = 0; pixel < 4; pixel++)
            assert_near(coverage_of(&all, pixel, expected[i][pixel]), 1.0, 0.0);
        free_mattes(&all);
    }
    const char *json = NULL;
    char text[160];
    assert_int_equal(ppm_render_cryptomatte_manifest(render, PPM_LAYER_CRYPTO_ASSET, &json),
                     PPM_STATUS_OK);
    snprintf(text, sizeof text, "{\"car\":\"%08x\",\"tree\":\"%08x\",\"%s\":\"%08x\"}",
             (unsigned)ppmi_crypto_id("car"), (unsigned)ppmi_crypto_id("tree"), made,
             (unsigned)ppmi_crypto_id(made));
    assert_string_equal(json, text);
    assert_int_equal(ppm_render_cryptomatte_manifest(render, PPM_LAYER_CRYPTO_MATERIAL, &json),
                     PPM_STATUS_OK);
    snprintf(text, sizeof text, "{\"pa\\\"int\":\"%08x\",\"%s\":\"%08x\"}",
             (unsigned)ppmi_crypto_id("pa\"int"), made_material,
             (unsigned)ppmi_crypto_id(made_material));
    assert_string_equal(json, text);
    ppm_render_destroy(render);
}

static void the_asset_stays_when_an_instance_moves(void **state)
{
    (void)state;
    const ppm_instance_id id = add_part("wheel", "car", add_named_material("m"), 0);
    const ppm_instance_desc moved = {
        .size = sizeof moved,
        .asset = "other",
        .transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}};
    assert_int_equal(ppm_scene_set_instance(test.scene, id, &moved), PPM_STATUS_OK);
    assert_string_equal(test.scene->instances[id - 1].asset, "car");
}

/* ---- many ids in one pixel ------------------------------------------------------------------- */

static void fill(ppmi_crypto_layer *layer, const uint32_t *indices, size_t count)
{
    for (size_t i = 0; i < count; i++)
        ppmi_crypto_layer_add(layer, 0, indices[i]);
}

static void a_full_pixel_keeps_what_covers_much_and_the_sum(void **state)
{
    (void)state;
    enum { NAMES = 40, SAMPLES = 1000, RANKS = 2 };
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    for (int i = 0; i < NAMES; i++) {
        char name[16];
        snprintf(name, sizeof name, "n%d", i);
        add_part(name, NULL, grey, 0);
    }
    ppmi_crypto_layer layer;
    assert_int_equal(
        ppmi_crypto_layer_init(test.context, test.scene, PPM_LAYER_CRYPTO_OBJECT, RANKS, 1, &layer),
        PPM_STATUS_OK);
    /* half are of one name, a third of another, the rest of all others in turn */
    uint32_t indices[SAMPLES], others = 0;
    for (uint32_t i = 0; i < SAMPLES; i++)
        indices[i] = i % 2 ? 7 : i % 3 ? 9 : 10 + others++ % 30;
    fill(&layer, indices, SAMPLES);
    float values[4];
    ppmi_crypto_layer_read(&layer, 1, 0, SAMPLES, values);
    assert_int_equal(bits_of(values[0]), ppmi_crypto_id("n7"));
    assert_int_equal(bits_of(values[2]), ppmi_crypto_id("n9"));
    assert_near(values[1], 0.5, 0.02);
    assert_near(values[3], 0.333, 0.02);
    float rest[4];
    ppmi_crypto_layer_read(&layer, 1, 1, SAMPLES, rest);
    assert_near(values[1] + values[3] + rest[1] + rest[3], 1.0, 1e-6);
    ppmi_crypto_layer_deinit(test.context, &layer);
}

static void ranks_do_not_depend_on_the_order_of_samples(void **state)
{
    (void)state;
    const ppm_material_id grey = material_lambert(test.scene, 0.5f);
    add_part("a", NULL, grey, 0);
    add_part("b", NULL, grey, 0);
    add_part("c", NULL, grey, 0);
    const uint32_t orders[2][4] = {{0, 1, 2, 2}, {2, 1, 2, 0}};
    float values[2][4], last[2][4];
    for (int i = 0; i < 2; i++) {
        ppmi_crypto_layer layer;
        assert_int_equal(
            ppmi_crypto_layer_init(test.context, test.scene, PPM_LAYER_CRYPTO_OBJECT, 4, 1, &layer),
            PPM_STATUS_OK);
        fill(&layer, orders[i], 4);
        ppmi_crypto_layer_read(&layer, 1, 0, 4, values[i]);
        ppmi_crypto_layer_read(&layer, 1, 1, 4, last[i]);
        ppmi_crypto_layer_deinit(test.context, &layer);
    }
    assert_memory_equal(values[0], values[1], sizeof values[0]);
    assert_memory_equal(last[0], last[1], sizeof last[0]);
    assert_int_equal(bits_of(values[0][0]), ppmi_crypto_id("c"));
    assert_near(values[0][1], 0.5, 0.0);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(odd_or_too_many_ranks_are_refused),
        WITH_SCENE(a_manifest_is_only_of_what_the_session_has),
        WITH_SCENE(any_failed_allocation_leaves_nothing),
        WITH_SCENE(coverage_is_the_share_of_the_pixel),
        WITH_SCENE(the_larger_share_has_the_first_rank),
        WITH_SCENE(where_nothing_is_hit_there_is_no_id),
        WITH_SCENE(a_veil_covers_as_in_the_picture),
        WITH_SCENE(equal_names_share_an_id),
        WITH_SCENE(objects_materials_and_assets_are_told_apart),
        WITH_SCENE(the_asset_stays_when_an_instance_moves),
        WITH_SCENE(a_full_pixel_keeps_what_covers_much_and_the_sum),
        WITH_SCENE(ranks_do_not_depend_on_the_order_of_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
