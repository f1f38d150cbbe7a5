/* src/api/output_layers.c: what a lossy compression may touch. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "imageio/layered_input.h"
#include "imageio/scratch.h"
#include "ppm/ppm.h"
#include "support/renders.h"
#include "support/scenes.h"

static ppm_context *color_context;
static ppm_color *color;

enum { WIDTH = 24, HEIGHT = 18 };

/* A floor that leans and a lamp; all layers. */
static ppm_render *open_render(test_scene *test)
{
    scene_open(test);
    const ppm_material_id grey = material_lambert(test->scene, 0.5f);
    add_quad(test->scene, grey, vec3(-1, -1, 0.3f), vec3(2, 0.3f, 0.4f), vec3(0.2f, 2, -0.7f));
    camera_perspective(test->scene, vec3(0, 0, 3), vec3(0, 0, 0), 0.8f);
    ppm_light_id id = 0;
    ppm_light_desc lamp = {
        .size = sizeof lamp, .name = "Key", .kind = PPM_LIGHT_POINT, .intensity = {90, 70, 50}};
    for (int i = 0; i < 4; i++)
        lamp.transform[5 * i] = 1;
    lamp.transform[14] = 1;
    assert_int_equal(ppm_scene_add_light(test->scene, &lamp, &id), PPM_STATUS_OK);
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, WIDTH, 100);
    options.height = HEIGHT;
    options.light_groups = PPM_LIGHT_GROUPS_NAMED;
    options.layers = ~(uint64_t)0 >> (64 - PPM_LAYER_KINDS);
    options.layers &= ~PPM_LAYER_BIT(PPM_LAYER_DENOISED);
    ppm_render *render = NULL;
    assert_int_equal(ppm_render_create(test->scene, &options, &render), PPM_STATUS_OK);
    assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
    assert_int_equal(ppm_render_advance(render), PPM_STATUS_OK);
    return render;
}

typedef struct file_values {
    ppmi_layered_input *input;
    ppmi_layered_info info;
    float *values;
} file_values;

static file_values write_and_read(const test_scene *test, const ppm_render *render,
                                  const ppm_output_options *options, const char *name)
{
    file_values file = {0};
    const char *const path = scratch_path(name);
    assert_int_equal(ppm_render_write(render, color, path, options), PPM_STATUS_OK);
    assert_int_equal(ppmi_layered_input_open(test->context, path, &file.input, &file.info),
                     PPM_STATUS_OK);
    file.values = calloc((size_t)WIDTH * HEIGHT * file.info.channel_count, sizeof(float));
    assert_int_equal(ppmi_layered_input_read(test->context, file.input, 0, HEIGHT, file.values),
                     PPM_STATUS_OK);
    return file;
}

static void close_file(const test_scene *test, file_values *file)
{
    ppmi_layered_input_close(test->context, file->input);
    free(file->values);
}

/* A part puts its name before that of a channel without a layer: depth.Z is Z. */
static uint32_t find(const file_values *file, const char *name)
{
    for (uint32_t i = 0; i < file->info.channel_count; i++) {
        const char *const other = ppmi_layered_input_channel(file->input, i);
        if (strcmp(other, name) == 0) return i;
        if (strcmp(name, "Z") == 0 && strcmp(other, "depth.Z") == 0) return i;
    }
    fail_msg("there is no channel %s", name);
    return 0;
}

static bool is_of_light(const char *name)
{
    const char *const dot = strrchr(name, '.');
    return strchr("RGBA", dot ? dot[1] : name[0]) != NULL;
}

static void assert_data_is_kept(const file_values *expected, const file_values *got)
{
    const uint32_t count = expected->info.channel_count;
    assert_int_equal(got->info.channel_count, count);
    uint32_t data = 0;
    for (uint32_t c = 0; c < count; c++) {
        const char *const name = ppmi_layered_input_channel(expected->input, c);
        const uint32_t at = find(got, name);
        data += !is_of_light(name);
        for (size_t i = 0; i < WIDTH * HEIGHT && !is_of_light(name); i++) {
            const float a = expected->values[i * count + c], b = got->values[i * count + at];
            if (memcmp(&a, &b, sizeof a) != 0) {
                fail_msg("%s: pixel %zu is %g, not %g", name, i, (double)b, (double)a);
            }
        }
    }
    assert_true(data > 20);
}

static void layers_that_are_no_light_are_exact_with_every_compression(void **state)
{
    (void)state;
    test_scene test;
    ppm_render *const render = open_render(&test);
    for (int is_half = 0; is_half < 2; is_half++) {
        ppm_output_options options = {.size = sizeof options, .exposure_ev = 0};
        options.depth = is_half ? PPM_DEPTH_HALF : PPM_DEPTH_FLOAT;
        file_values plain = write_and_read(&test, render, &options, "plain.exr");
        for (int i = 0; i < 6; i++) {
            options.compression = PPM_COMPRESSION_PXR24 + i % 3;
            options.compression_level = i % 3 ? 3000.0f : 0.0f;
            options.is_multipart = i >= 3;
            file_values packed = write_and_read(&test, render, &options, "packed.exr");
            assert_data_is_kept(&plain, &packed);
            close_file(&test, &packed);
        }
        close_file(&test, &plain);
    }
    ppm_render_destroy(render);
    scene_close(&test);
}

static int setup(void **state)
{
    (void)state;
    unsetenv("OCIO");
    scratch_create();
    assert_int_equal(ppm_context_create(NULL, &color_context), PPM_STATUS_OK);
    return ppm_color_create(color_context, NULL, &color);
}

static int teardown(void **state)
{
    (void)state;
    ppm_color_destroy(color);
    ppm_context_destroy(color_context);
    scratch_remove();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_that_are_no_light_are_exact_with_every_compression),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
