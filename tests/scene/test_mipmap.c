/* Mipmaps: sizes, means, where things are, rounding, memory. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "scene/mipmap.h"
#include "support/near.h"
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

static const ppmi_image *add_image(const void *pixels, int32_t type, int32_t role, uint32_t width,
                                   uint32_t height, uint32_t channels)
{
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = role,
                                 .pixels = pixels,
                                 .pixel_type = type,
                                 .width = width,
                                 .height = height,
                                 .channels = channels};
    ppm_image_id id = 0;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
    assert_int_equal(ppmi_scene_build_mipmaps(test.scene), PPM_STATUS_OK);
    return &test.scene->images[id - 1];
}

/* Linear value of a channel. */
static double value(const ppmi_image *image, const ppmi_image_level *level, size_t texel,
                    uint32_t channel)
{
    const size_t at = texel * image->channels + channel;
    if (level->f32) return (double)level->f32[at];
    const bool is_color = channel < (image->channels >= 3 ? 3u : 1u);
    return image->is_srgb && is_color ? (double)test.scene->srgb_to_linear[level->u8[at]]
                                      : level->u8[at] / 255.0;
}

static double mean_of(const ppmi_image *image, uint32_t index, uint32_t channel)
{
    const ppmi_image_level level = ppmi_image_level_at(image, index);
    const size_t texels = (size_t)level.width * level.height;
    double sum = 0.0;
    for (size_t i = 0; i < texels; i++)
        sum += value(image, &level, i, channel);
    return sum / (double)texels;
}

enum { MOST_TEXELS = 64 * 64 };
static float noise_f32[4 * MOST_TEXELS];
static uint8_t noise_u8[4 * MOST_TEXELS];

static void make_noise(void)
{
    ppmi_rng rng = ppmi_rng_start(1, PPMI_STREAM_EYE, 7);
    for (size_t i = 0; i < sizeof noise_f32 / sizeof noise_f32[0]; i++) {
        noise_f32[i] = ppmi_rng_float(&rng);
        noise_u8[i] = (uint8_t)(256.0f * ppmi_rng_float(&rng));
    }
}

static const struct {
    uint32_t width, height, levels;
} sizes[] = {{1, 1, 0}, {2, 1, 1},   {1, 7, 2},   {5, 3, 2},   {8, 8, 3},
             {9, 4, 3}, {13, 64, 6}, {63, 31, 5}, {37, 41, 5}, {64, 2, 6}};

static void levels_halve_the_sides_down_to_one_texel(void **state)
{
    (void)state;
    make_noise();
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const ppmi_image *image =
            add_image(noise_u8, PPM_PIXELS_U8, PPM_IMAGE_COLOR, sizes[i].width, sizes[i].height, 3);
        assert_int_equal(image->mip_count, sizes[i].levels);
        const ppmi_image_level last = ppmi_image_level_at(image, image->mip_count);
        assert_int_equal(last.width, 1);
        assert_int_equal(last.height, 1);
    }
}

static void every_level_of_floats_has_the_mean_of_the_image(void **state)
{
    (void)state;
    make_noise();
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        for (uint32_t channels = 1; channels <= 4; channels++) {
            const ppmi_image *image = add_image(noise_f32, PPM_PIXELS_F32, PPM_IMAGE_DATA,
                                                sizes[i].width, sizes[i].height, channels);
            for (uint32_t level = 1; level <= image->mip_count; level++)
                assert_near(mean_of(image, level, channels - 1), mean_of(image, 0, channels - 1),
                            2e-6);
        }
    }
}

/* Each texel is rounded once, to the nearest code: by less than half of the largest step. */
static void every_level_of_bytes_has_the_mean_in_linear_light(void **state)
{
    (void)state;
    make_noise();
    const double largest_step =
        (double)(test.scene->srgb_to_linear[255] - test.scene->srgb_to_linear[254]);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const ppmi_image *color =
            add_image(noise_u8, PPM_PIXELS_U8, PPM_IMAGE_COLOR, sizes[i].width, sizes[i].height, 4);
        for (uint32_t level = 1; level <= color->mip_count; level++) {
            assert_near(mean_of(color, level, 0), mean_of(color, 0, 0), 0.51 * largest_step);
            assert_near(mean_of(color, level, 3), mean_of(color, 0, 3), 0.51 / 255.0);
        }
        const ppmi_image *data =
            add_image(noise_u8, PPM_PIXELS_U8, PPM_IMAGE_DATA, sizes[i].width, sizes[i].height, 2);
        for (uint32_t level = 1; level <= data->mip_count; level++)
            assert_near(mean_of(data, level, 0), mean_of(data, 0, 0), 0.51 / 255.0);
    }
}

static void even_colours_stay_what_they_are(void **state)
{
    (void)state;
    uint8_t pixels[3 * 7 * 5];
    for (int code = 0; code < 256; code++) {
        for (size_t i = 0; i < sizeof pixels; i++)
            pixels[i] = (uint8_t)code;
        const ppmi_image *image = add_image(pixels, PPM_PIXELS_U8, PPM_IMAGE_COLOR, 7, 5, 3);
        for (uint32_t level = 1; level <= image->mip_count; level++)
            assert_int_equal(ppmi_image_level_at(image, level).u8[0], code);
    }
}

static void black_and_white_make_half_the_light_and_not_half_the_code(void **state)
{
    (void)state;
    const uint8_t pixels[4] = {0, 255, 255, 0};
    const ppmi_image *color = add_image(pixels, PPM_PIXELS_U8, PPM_IMAGE_COLOR, 2, 2, 1);
    assert_int_equal(color->mips[0].u8[0], 188);
    const ppmi_image *data = add_image(pixels, PPM_PIXELS_U8, PPM_IMAGE_DATA, 2, 2, 1);
    assert_int_equal(data->mips[0].u8[0], 128);
}

/* A ramp has its mean in the middle of every box, but for what a texel that lies in two of them is
 * even: less than a sixteenth of a texel of the level. */
static void levels_of_odd_sizes_show_things_at_their_place(void **state)
{
    (void)state;
    enum { WIDTH = 37 };
    float ramp[WIDTH];
    for (int i = 0; i < WIDTH; i++)
        ramp[i] = ((float)i + 0.5f) / WIDTH;
    const ppmi_image *image = add_image(ramp, PPM_PIXELS_F32, PPM_IMAGE_DATA, WIDTH, 1, 1);
    for (uint32_t i = 1; i <= image->mip_count; i++) {
        const ppmi_image_level level = ppmi_image_level_at(image, i);
        for (uint32_t x = 0; x < level.width; x++)
            assert_near(level.f32[x], (x + 0.5) / level.width, 0.0625 / level.width);
    }
}

static void the_environment_has_no_levels(void **state)
{
    (void)state;
    const float pixels[12] = {0};
    const ppm_image_id image = image_rgb(test.scene, 2, 2, pixels);
    light_environment(test.scene, vec3(1, 1, 1), image, 0.0f);
    assert_int_equal(ppmi_scene_build_mipmaps(test.scene), PPM_STATUS_OK);
    assert_int_equal(test.scene->images[image - 1].mip_count, 0);
}

static void a_lack_of_memory_is_reported_and_can_be_made_good(void **state)
{
    (void)state;
    make_noise();
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = PPM_IMAGE_COLOR,
                                 .pixels = noise_u8,
                                 .pixel_type = PPM_PIXELS_U8,
                                 .width = 9,
                                 .height = 9,
                                 .channels = 3};
    ppm_image_id id;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
    for (size_t n = 1; n <= 5; n++) {
        ppmi_alloc_fail_at(test.context, n);
        assert_int_equal(ppmi_scene_build_mipmaps(test.scene), PPM_STATUS_OUT_OF_MEMORY);
        assert_int_equal(test.scene->images[id - 1].mip_count, 0);
    }
    ppmi_alloc_fail_at(test.context, 0);
    assert_int_equal(ppmi_scene_build_mipmaps(test.scene), PPM_STATUS_OK);
    assert_int_equal(test.scene->images[id - 1].mip_count, 3);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_lack_of_memory_is_reported_and_can_be_made_good),
        TEST(levels_halve_the_sides_down_to_one_texel),
        TEST(every_level_of_floats_has_the_mean_of_the_image),
        TEST(every_level_of_bytes_has_the_mean_in_linear_light),
        TEST(even_colours_stay_what_they_are),
        TEST(black_and_white_make_half_the_light_and_not_half_the_code),
        TEST(levels_of_odd_sizes_show_things_at_their_place),
        TEST(the_environment_has_no_levels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
