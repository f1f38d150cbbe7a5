/* Names of channels: no two are equal, and no light's name splits one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "api/layer_channels.h"
#include "support/renders.h"
#include "support/scenes.h"

static const char long_name[] = "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"
                                "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"
                                "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\xc3"
                                "\xa4\xc3\xa4\xc3\xa4\xc3\xa4";

static void add_light(ppm_scene *scene, const char *name)
{
    ppm_light_id id = 0;
    ppm_light_desc desc = {
        .size = sizeof desc, .name = name, .kind = PPM_LIGHT_POINT, .intensity = {1, 1, 1}};
    for (int i = 0; i < 4; i++)
        desc.transform[5 * i] = 1;
    desc.transform[14] = 1;
    assert_int_equal(ppm_scene_add_light(scene, &desc, &id), PPM_STATUS_OK);
}

/* A session with a layer for each of six lights. */
static ppm_render *open_render(test_scene *test)
{
    scene_open(test);
    const ppm_material_id grey = material_lambert(test->scene, 0.5f);
    add_quad(test->scene, grey, vec3(-1, -1, 0), vec3(2, 0, 0), vec3(0, 2, 0));
    camera_perspective(test->scene, vec3(0, 0, 3), vec3(0, 0, 0), 0.8f);
    add_light(test->scene, "Key.001");
    add_light(test->scene, "Key_001");
    add_light(test->scene, "Key.001_");
    add_light(test->scene, "a\nb");
    add_light(test->scene, long_name);
    char other[sizeof long_name];
    memcpy(other, long_name, sizeof other);
    other[strlen(other) - 1] ^= 1; /* the last of so many */
    add_light(test->scene, other);
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, 4, 100);
    options.light_groups = PPM_LIGHT_GROUPS_NAMED;
    options.layers = PPM_LAYER_BIT(PPM_LAYER_LIGHT_GROUP) | PPM_LAYER_BIT(PPM_LAYER_VARIANCE) |
                     PPM_LAYER_BIT(PPM_LAYER_DEPTH) | PPM_LAYER_BIT(PPM_LAYER_CRYPTO_OBJECT);
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(test->scene, &options, &render), PPM_STATUS_OK);
    return render;
}

static const ppmi_layered_channel *find(const ppmi_layer_channels *all, const char *name)
{
    for (uint32_t i = 0; i < all->first[all->layer_count]; i++) {
        if (strcmp(all->channels[i].name, name) == 0) return &all->channels[i];
    }
    fail_msg("there is no channel %s", name);
    return NULL;
}

static void names_are_whole_and_differ(void **state)
{
    (void)state;
    test_scene test;
    ppmi_layer_channels all;
    ppm_render *const render = open_render(&test);
    assert_int_equal(ppmi_layer_channels_init(test.context, render, false, true, false, &all),
                     PPM_STATUS_OK);
    find(&all, "R");
    find(&all, "Z");
    find(&all, "variance.r");
    find(&all, "CryptoObject02.a");
    find(&all, "light.Key_001.R");
    find(&all, "light.Key_001_2.B");
    find(&all, "light.Key_001_.R");
    find(&all, "light.a_b.R");
    const uint32_t count = all.first[all.layer_count];
    for (uint32_t i = 0; i < count; i++) {
        const char *const name = all.channels[i].name;
        assert_true(strlen(name) < 64); /* Blender reads no longer ones */
        assert_true(strncmp(name, "light.aaaa", 10) != 0 || !strstr(name, "\xc3~"));
        for (uint32_t k = 0; k < i; k++)
            assert_string_not_equal(name, all.channels[k].name);
    }
    ppmi_layer_channels_deinit(test.context, &all);
    ppm_render_destroy(render);
    scene_close(&test);
}

/* Which is which is in the header. */
static void names_that_are_changed_are_in_a_manifest(void **state)
{
    (void)state;
    test_scene test;
    ppmi_layer_channels all;
    ppm_render *const render = open_render(&test);
    char *text = NULL;
    assert_int_equal(ppmi_layer_channels_init(test.context, render, false, true, false, &all),
                     PPM_STATUS_OK);
    assert_int_equal(ppmi_layer_channels_manifest(test.context, &all, &text), PPM_STATUS_OK);
    assert_non_null(strstr(text, "\"light.Key_001\":\"light.Key.001\""));
    assert_non_null(strstr(text, long_name));
    assert_null(strstr(text, "variance"));
    assert_int_equal(text[0], '{');
    assert_int_equal(text[strlen(text) - 1], '}');
    ppmi_free(test.context, text);
    ppmi_layer_channels_deinit(test.context, &all);
    ppm_render_destroy(render);
    scene_close(&test);
}

static void half_floats_are_for_what_bears_them(void **state)
{
    (void)state;
    test_scene test;
    ppmi_layer_channels all;
    ppm_render *const render = open_render(&test);
    assert_int_equal(ppmi_layer_channels_init(test.context, render, true, true, false, &all),
                     PPM_STATUS_OK);
    assert_int_equal(find(&all, "R")->store, PPMI_STORE_HALF);
    assert_int_equal(find(&all, "light.Key_001.R")->store, PPMI_STORE_HALF);
    assert_int_equal(find(&all, "Z")->store, PPMI_STORE_FLOAT);
    assert_int_equal(find(&all, "variance.r")->store, PPMI_STORE_FLOAT);
    assert_int_equal(find(&all, "CryptoObject00.r")->store, PPMI_STORE_FLOAT);
    ppmi_layer_channels_deinit(test.context, &all);
    ppm_render_destroy(render);
    scene_close(&test);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    test_scene test;
    ppmi_layer_channels all;
    ppm_render *const render = open_render(&test);
    ppm_status status = PPM_STATUS_OUT_OF_MEMORY;
    size_t n = 1;
    for (; status == PPM_STATUS_OUT_OF_MEMORY; n++) {
        ppmi_alloc_fail_at(test.context, n);
        status = ppmi_layer_channels_init(test.context, render, false, true, false, &all);
        ppmi_alloc_fail_at(test.context, 0);
        ppmi_layer_channels_deinit(test.context, &all);
    }
    assert_int_equal(status, PPM_STATUS_OK);
    assert_true(n > 20);
    ppm_render_destroy(render);
    scene_close(&test);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_whole_and_differ),
        cmocka_unit_test(names_that_are_changed_are_in_a_manifest),
        cmocka_unit_test(half_floats_are_for_what_bears_them),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
