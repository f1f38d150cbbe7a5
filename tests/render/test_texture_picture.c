/* Textures in whole pictures: filtering keeps means, takes noise away, and leaves no blur in the
 * end. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

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

enum { TEXELS = 64 };

/* A material that shines with a texture of black and white fields and reflects nothing. */
static ppm_material_id shining_fields(uint32_t width, uint32_t height, const float uv_scale[2],
                                      int32_t alpha_mode)
{
    static float pixels[TEXELS * TEXELS * 4];
    for (uint32_t y = 0; y < TEXELS; y++) {
        for (uint32_t x = 0; x < TEXELS; x++) {
            const float value = (float)((x / width + y / height) % 2);
            for (uint32_t c = 0; c < 4; c++)
                pixels[4 * (y * TEXELS + x) + c] = value;
        }
    }
    const ppm_image_desc image = {.size = sizeof image,
                                  .role = PPM_IMAGE_DATA,
                                  .pixels = pixels,
                                  .pixel_type = PPM_PIXELS_F32,
                                  .width = TEXELS,
                                  .height = TEXELS,
                                  .channels = 4};
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    ppm_texture texture = {.has_transform = 1, .uv_transform = {uv_scale[0], 0, 0, 0, uv_scale[1]}};
    assert_int_equal(ppm_scene_add_image(test.scene, &image, &texture.image), PPM_STATUS_OK);
    for (int i = 0; i < 3; i++) {
        desc.base_color[i] = 0.0f;
        desc.emission[i] = 1.0f;
    }
    desc.specular = 0.0f;
    desc.roughness = 1.0f;
    desc.alpha_mode = alpha_mode;
    if (alpha_mode == PPM_ALPHA_OPAQUE) {
        desc.emission_texture = texture;
    } else {
        desc.base_color_texture = texture;
    }
    return material_add(test.scene, &desc);
}

/* The variance of green within the picture. */
static double variance_of(const float *rgba, uint32_t pixels)
{
    test_mean mean = {0};
    for (uint32_t i = 0; i < pixels; i++)
        mean_add(&mean, (double)rgba[4 * i + 1]);
    return mean.squares / pixels;
}

enum { SIDE = 16, PIXELS = SIDE * SIDE };

/* A plane of fields, seen from a slant by an orthographic camera whose picture holds whole periods:
 * its mean is 1/2 whatever filter there is. */
static void add_slanted_plane(float slant_rad)
{
    const float scale[2] = {128.0f, 128.0f};
    add_quad(test.scene, shining_fields(8, 8, scale, PPM_ALPHA_OPAQUE), vec3(-32, 0, 32),
             vec3(64, 0, 0), vec3(0, 0, -64));
    camera_orthographic(test.scene, vec3(0, 10.0f * cosf(slant_rad), 10.0f * sinf(slant_rad)),
                        vec3(0, 0, 0), 1.0f);
}

static void a_distant_pattern_is_even_from_the_first_pass_on(void **state)
{
    (void)state;
    const float slants[] = {0.0f, acosf(0.5f), acosf(0.125f)};
    test_family family = {0};
    for (int i = 0; i < 3; i++) {
        scene_close(&test);
        scene_open(&test);
        add_slanted_plane(slants[i]);
        const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 1000);
        float *rgba = render_picture(test.scene, &options, 1);
        /* unfiltered it is that of a coin, 1/4 */
        assert_true(variance_of(rgba, PIXELS) < 0.02);
        free(rgba);
        const test_mean mean = render_green(test.scene, &options, 4, 12);
        family_add_mean(&family, &mean, 0.5, 0.0, "slant %g", (double)slants[i]);
        mean_check_power(&mean, 0.01);
    }
    family_check(&family);
}

/* Pixels of the picture are the means over their areas of a picture 16 times as fine, in which a
 * texel is larger than a pixel: nothing is filtered there. Blocks of 4 x 4 pixels, from near to
 * far. What filtering in the first passes has moved over the border of a block is a systematic
 * error: the mean side of the footprints, 0.7 * 2 / sqrt(passes) pixels times sqrt(3), of which a
 * quarter goes over each border, by the contrast of neighbouring blocks. */
static void the_picture_is_that_of_many_samples(void **state)
{
    (void)state;
    enum { FINE = 16, PASSES = 64, BLOCK = 4, BLOCKS = SIDE / BLOCK };
    const float scale[2] = {8.0f, 8.0f};
    add_quad(test.scene, shining_fields(32, 32, scale, PPM_ALPHA_OPAQUE), vec3(-8, -1, 0),
             vec3(16, 0, 0), vec3(0, 0, -16));
    camera_perspective(test.scene, vec3(0, 0, 0), vec3(0, -0.5f, -1), 0.7f);
    const ppm_render_options fine = render_options(PPM_INTEGRATOR_PATH, FINE * SIDE, 1000);
    float *reference = render_picture(test.scene, &fine, 4);
    test_mean blocks[BLOCKS * BLOCKS] = {0};
    double expected[BLOCKS * BLOCKS] = {0};
    for (uint32_t i = 0; i < FINE * SIDE * FINE * SIDE; i++) {
        const uint32_t x = i % (FINE * SIDE) / (FINE * BLOCK), y = i / (FINE * SIDE * FINE * BLOCK);
        expected[y * BLOCKS + x] += (double)reference[4 * i + 1] / (FINE * BLOCK * FINE * BLOCK);
    }
    free(reference);
    ppm_render_options coarse = render_options(PPM_INTEGRATOR_PATH, SIDE, 1000);
    for (uint64_t seed = 1; seed <= 8; seed++) {
        coarse.seed = seed;
        float *rgba = render_picture(test.scene, &coarse, PASSES);
        double sums[BLOCKS * BLOCKS] = {0};
        for (uint32_t i = 0; i < PIXELS; i++)
            sums[i / (SIDE * BLOCK) * BLOCKS + i % SIDE / BLOCK] += (double)rgba[4 * i + 1];
        free(rgba);
        for (int i = 0; i < BLOCKS * BLOCKS; i++)
            mean_add(&blocks[i], sums[i] / (BLOCK * BLOCK));
    }
    test_family family = {0};
    const double blur = 0.7 * 2.0 / sqrt(PASSES) * sqrt(3.0) / 4.0 / BLOCK;
    for (int i = 0; i < BLOCKS * BLOCKS; i++)
        family_add_mean(&family, &blocks[i], expected[i], 2.0 * blur, "block %d", i);
    family_check(&family);
}

/* Stripes as wide as pixels, and just upon them. */
static double contrast_after(uint32_t passes)
{
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 1000);
    float *rgba = render_picture(test.scene, &options, passes);
    double contrast = 0.0;
    for (uint32_t x = 0; x < SIDE; x++)
        contrast += (x % 2 ? 1.0 : -1.0) * (double)rgba[4 * (SIDE / 2 * SIDE + x) + 1];
    free(rgba);
    return fabs(contrast) / (SIDE / 2);
}

static void blur_goes_away_with_the_passes(void **state)
{
    (void)state;
    const float scale[2] = {8.0f, 1.0f}; /* 16 stripes, each of 32 texels */
    add_quad(test.scene, shining_fields(32, TEXELS, scale, PPM_ALPHA_OPAQUE), vec3(-1, -1, 0),
             vec3(2, 0, 0), vec3(0, 2, 0));
    camera_orthographic(test.scene, vec3(0, 0, 2), vec3(0, 0, 0), 1.0f);
    double before = 0.2; /* two pixels would be seen as one at 0 */
    for (uint32_t passes = 1; passes <= 256; passes *= 4) {
        const double contrast = contrast_after(passes);
        assert_true(contrast > before);
        before = contrast;
    }
    assert_true(before > 0.92);
}

/* A mask cuts by the image itself: from afar as much is left of a leaf as from near. */
static void masks_do_not_shrink_from_afar(void **state)
{
    (void)state;
    const float scales[] = {1.0f, 8.0f, 64.0f};
    test_family family = {0};
    for (int mode = PPM_ALPHA_MASK; mode <= PPM_ALPHA_BLEND; mode++) {
        for (int i = 0; i < 3; i++) {
            scene_close(&test);
            scene_open(&test);
            const float scale[2] = {scales[i], scales[i]};
            add_quad(test.scene, shining_fields(8, 8, scale, mode), vec3(-1, -1, 0), vec3(2, 0, 0),
                     vec3(0, 2, 0));
            camera_orthographic(test.scene, vec3(0, 0, 2), vec3(0, 0, 0), 1.0f);
            const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 1000);
            const test_mean mean = render_green(test.scene, &options, 16, 8);
            family_add_mean(&family, &mean, 0.5, 0.0, "mode %d, %g times", mode, (double)scales[i]);
            mean_check_power(&mean, 0.02);
        }
    }
    family_check(&family);
}

/* A board with bumps under a lamp from the side. The transform is the normal map's, over given
 * tangents, or is in the coordinates, without any. */
static void add_bumpy_board(const float m[6], bool is_in_texture)
{
    float pixels[8 * 8 * 3];
    for (int i = 0; i < 64; i++) {
        pixels[3 * i] = 0.5f + 0.3f * sinf(0.785f * (float)(i % 8));
        pixels[3 * i + 1] = 0.5f + 0.15f * sinf(1.9f * (float)(i / 8) + (float)(i % 8));
        pixels[3 * i + 2] = 0.9f;
    }
    const ppm_image_desc image = {.size = sizeof image,
                                  .role = PPM_IMAGE_DATA,
                                  .pixels = pixels,
                                  .pixel_type = PPM_PIXELS_F32,
                                  .width = 8,
                                  .height = 8,
                                  .channels = 3};
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    ppm_texture *texture = &desc.normal_texture;
    assert_int_equal(ppm_scene_add_image(test.scene, &image, &texture->image), PPM_STATUS_OK);
    texture->has_transform = is_in_texture;
    for (int i = 0; i < 6; i++)
        texture->uv_transform[i] = m[i];
    desc.roughness = 0.6f;
    shape_add_board(test.scene, &desc, is_in_texture ? NULL : m, is_in_texture);
    light_directional(test.scene, vec3(-1, 0.3f, -1), vec3(3, 3, 3));
    camera_orthographic(test.scene, vec3(0, 0, 2), vec3(0, 0, 0), 1.0f);
}

/* The largest difference of a pixel from what it is with the transform in the coordinates. */
static double difference_of(const float in_texture[6], const float in_coordinates[6])
{
    const ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 1000);
    float *pictures[2];
    for (int i = 0; i < 2; i++) {
        scene_close(&test);
        scene_open(&test);
        add_bumpy_board(i == 0 ? in_texture : in_coordinates, i == 0);
        pictures[i] = render_picture(test.scene, &options, 4);
    }
    double largest = 0.0;
    for (uint32_t i = 0; i < PIXELS; i++)
        largest = fmax(largest, fabs((double)(pictures[0][4 * i + 1] - pictures[1][4 * i + 1])));
    free(pictures[0]);
    free(pictures[1]);
    return largest;
}

/* KHR_texture_transform by a quarter turn: the bumps are lit from where the lamp is, not from where
 * it would be if the board were turned. A half turn has another picture. */
static void bumps_that_are_turned_in_the_file_are_lit_as_turned_coordinates(void **state)
{
    (void)state;
    static const float quarter[6] = {0, 1, 0, -1, 0, 1}, half[6] = {-1, 0, 1, 0, -1, 1};
    assert_near(difference_of(quarter, quarter), 0.0, 1e-3);
    assert_near(difference_of(half, half), 0.0, 1e-3);
    assert_true(difference_of(quarter, half) > 0.1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_distant_pattern_is_even_from_the_first_pass_on),
        TEST(the_picture_is_that_of_many_samples),
        TEST(blur_goes_away_with_the_passes),
        TEST(masks_do_not_shrink_from_afar),
        TEST(bumps_that_are_turned_in_the_file_are_lit_as_turned_coordinates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
