/* A lamp that glows by a texture lights like the same patches as geometry, however its light is
 * found: by light sampling, by rays that happen to meet it, by photons. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "support/renders.h"
#include "support/scenes.h"

static test_scene test;

enum { CELLS = 16, PATCHES = 5 };
static const int patches[PATCHES][2] = {{1, 2}, {7, 12}, {8, 8}, {13, 3}, {14, 14}};

static ppm_material_id material_glow(ppm_image_id image)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    for (int k = 0; k < 3; k++) {
        desc.base_color[k] = 0.0f;
        desc.emission[k] = 60.0f;
    }
    desc.specular = 0.0f;
    desc.emission_texture = (ppm_texture){.image = image, .filter = PPM_FILTER_NEAREST};
    return material_add(test.scene, &desc);
}

static void add_textured_lamp(void)
{
    static float pixels[3 * CELLS * CELLS];
    memset(pixels, 0, sizeof pixels);
    for (int i = 0; i < PATCHES; i++) {
        for (int k = 0; k < 3; k++)
            pixels[3 * (patches[i][1] * CELLS + patches[i][0]) + k] = 1.0f;
    }
    const ppm_material_id glow = material_glow(image_rgb(test.scene, CELLS, CELLS, pixels));
    add_quad(test.scene, glow, vec3(-1, 0.5f, -1), vec3(2, 0, 0), vec3(0, 0, 2));
}

static void add_patches(void)
{
    const ppm_material_id glow = material_glow(0);
    const float size = 2.0f / CELLS;
    for (int i = 0; i < PATCHES; i++) {
        const ppmi_vec3 at =
            vec3(-1 + size * (float)patches[i][0], 0.5f, -1 + size * (float)patches[i][1]);
        add_quad(test.scene, glow, at, vec3(size, 0, 0), vec3(0, 0, size));
    }
    const ppm_material_id black = material_lambert(test.scene, 0.0f);
    add_quad(test.scene, black, vec3(-1, 0.5001f, -1), vec3(2, 0, 0), vec3(0, 0, 2));
}

/* A floor under the lamp, with a wall that brings light back; the lamp is not in the picture. */
static test_mean light_of(bool is_textured, int32_t integrator, int32_t direct, uint32_t passes)
{
    scene_open(&test);
    const ppm_material_id grey = material_lambert(test.scene, 0.6f);
    add_quad(test.scene, grey, vec3(-1, 0, 1), vec3(2, 0, 0), vec3(0, 0, -2));
    add_quad(test.scene, grey, vec3(-1, 0, -1), vec3(2, 0, 0), vec3(0, 0.5f, 0));
    if (is_textured) {
        add_textured_lamp();
    } else {
        add_patches();
    }
    camera_orthographic(test.scene, vec3(0, 0.49f, 0), vec3(0, 0, 0), 0.8f);
    ppm_render_options options = render_options(integrator, 12, 5000);
    options.direct = direct;
    const test_mean mean = render_green(test.scene, &options, passes, 12);
    scene_close(&test);
    return mean;
}

static void a_texture_lights_like_its_patches(void **state)
{
    (void)state;
    const struct {
        const char *name;
        int32_t integrator, direct;
        uint32_t passes;
    } ways[3] = {{"path", PPM_INTEGRATOR_PATH, PPM_DIRECT_SAMPLE, 96},
                 {"sppm", PPM_INTEGRATOR_SPPM, PPM_DIRECT_SAMPLE, 48},
                 {"photons", PPM_INTEGRATOR_SPPM, PPM_DIRECT_PHOTONS, 16}};
    test_family family = {0};
    for (int i = 0; i < 3; i++) {
        const test_mean geometry =
            light_of(false, ways[i].integrator, ways[i].direct, ways[i].passes);
        const test_mean texture =
            light_of(true, ways[i].integrator, ways[i].direct, ways[i].passes);
        mean_check_power(&texture, 0.01);
        mean_check_power(&geometry, 0.01);
        const double error = hypot(mean_error(&texture), mean_error(&geometry));
        const double z = (texture.mean - geometry.mean) / error;
        family_add(&family, p_normal(z), "%s", ways[i].name);
    }
    family_check(&family);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texture_lights_like_its_patches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
