/* Texture look-ups: wrapping, filters, decoding, transforms. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shading/texture.h"
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

static ppm_image_id add_image(const void *pixels, int32_t type, int32_t role, uint32_t width,
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
    return id;
}

static ppmi_texel look_up(const ppm_texture *texture, float u, float v)
{
    return ppmi_texture_lookup(test.scene, texture, (ppmi_vec2){u, v});
}

static const float ramp[4] = {0.0f, 1.0f, 2.0f, 3.0f};

static void nearest_takes_the_texel_that_is_hit(void **state)
{
    (void)state;
    ppm_texture texture = {.image = add_image(ramp, PPM_PIXELS_F32, PPM_IMAGE_DATA, 4, 1, 1),
                           .filter = PPM_FILTER_NEAREST};
    static const struct {
        float u, repeat, clamp, mirror;
    } cases[] = {{0.1f, 0, 0, 0},   {0.3f, 1, 1, 1},  {0.99f, 3, 3, 3}, {1.1f, 0, 3, 3},
                 {1.3f, 1, 3, 2},   {1.9f, 3, 3, 0},  {2.1f, 0, 3, 0},  {-0.1f, 3, 0, 0},
                 {-0.3f, 2, 0, 1},  {-1.1f, 3, 0, 3}, {-7.9f, 0, 0, 0}, {100.3f, 1, 3, 1},
                 {-101.3f, 2, 0, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        texture.wrap_u = PPM_WRAP_REPEAT;
        assert_near(look_up(&texture, cases[i].u, 0.5f).r, cases[i].repeat, 0.0);
        texture.wrap_u = PPM_WRAP_CLAMP;
        assert_near(look_up(&texture, cases[i].u, 0.5f).r, cases[i].clamp, 0.0);
        texture.wrap_u = PPM_WRAP_MIRROR;
        assert_near(look_up(&texture, cases[i].u, 0.5f).r, cases[i].mirror, 0.0);
    }
}

static void u_runs_right_and_v_runs_down(void **state)
{
    (void)state;
    const float pixels[6] = {1, 2, 3, 4, 5, 6}; /* two rows of three */
    const ppm_texture texture = {.image =
                                     add_image(pixels, PPM_PIXELS_F32, PPM_IMAGE_DATA, 3, 2, 1),
                                 .filter = PPM_FILTER_NEAREST};
    assert_near(look_up(&texture, 0.1f, 0.1f).r, 1.0, 0.0);
    assert_near(look_up(&texture, 0.9f, 0.1f).r, 3.0, 0.0);
    assert_near(look_up(&texture, 0.1f, 0.9f).r, 4.0, 0.0);
}

static void linear_filtering_goes_from_centre_to_centre(void **state)
{
    (void)state;
    ppm_texture texture = {.image = add_image(ramp, PPM_PIXELS_F32, PPM_IMAGE_DATA, 4, 1, 1),
                           .wrap_u = PPM_WRAP_CLAMP,
                           .wrap_v = PPM_WRAP_CLAMP};
    for (int i = 0; i < 4; i++)
        assert_near(look_up(&texture, ((float)i + 0.5f) / 4.0f, 0.5f).r, i, 1e-6);
    assert_near(look_up(&texture, 0.5f, 0.3f).r, 1.5, 1e-6);
    assert_near(look_up(&texture, 0.0f, 0.5f).r, 0.0, 1e-6);
    assert_near(look_up(&texture, 1.0f, 0.5f).r, 3.0, 1e-6);
    texture.wrap_u = PPM_WRAP_REPEAT;
    assert_near(look_up(&texture, 0.0f, 0.5f).r, 1.5, 1e-6);
    assert_near(look_up(&texture, 1.0f, 0.5f).r, 1.5, 1e-6);
    texture.wrap_u = PPM_WRAP_MIRROR;
    assert_near(look_up(&texture, 1.0f, 0.5f).r, 3.0, 1e-6);
    assert_near(look_up(&texture, 2.0f, 0.5f).r, 0.0, 1e-6);
}

static double srgb_to_linear(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static void colour_is_decoded_before_filtering_and_data_is_not(void **state)
{
    (void)state;
    uint8_t all[256];
    for (int i = 0; i < 256; i++)
        all[i] = (uint8_t)i;
    ppm_texture color = {.image = add_image(all, PPM_PIXELS_U8, PPM_IMAGE_COLOR, 256, 1, 1),
                         .filter = PPM_FILTER_NEAREST};
    ppm_texture data = {.image = add_image(all, PPM_PIXELS_U8, PPM_IMAGE_DATA, 256, 1, 1),
                        .filter = PPM_FILTER_NEAREST};
    for (int i = 0; i < 256; i++) {
        const float u = ((float)i + 0.5f) / 256.0f;
        assert_near(look_up(&color, u, 0.5f).g, srgb_to_linear(i / 255.0), 1e-5);
        assert_near(look_up(&data, u, 0.5f).g, i / 255.0, 1e-6);
    }
    const uint8_t black_and_white[2] = {0, 255};
    const ppm_texture two = {
        .image = add_image(black_and_white, PPM_PIXELS_U8, PPM_IMAGE_COLOR, 2, 1, 1)};
    assert_near(look_up(&two, 0.5f, 0.5f).r, 0.5, 1e-6);
}

static void channels_mean_what_they_are(void **state)
{
    (void)state;
    const uint8_t bytes[4] = {255, 0, 128, 64};
    const float floats[4] = {1.0f, 0.0f, 5.0f, 0.25f};
    ppm_texture texture = {0};
    for (uint32_t channels = 1; channels <= 4; channels++) {
        texture.image = add_image(bytes, PPM_PIXELS_U8, PPM_IMAGE_COLOR, 1, 1, channels);
        ppmi_texel texel = look_up(&texture, 0.5f, 0.5f);
        assert_near(texel.r, 1.0, 1e-6);
        assert_near(texel.g, channels >= 3 ? 0.0 : 1.0, 1e-6);
        assert_near(texel.b, channels >= 3 ? srgb_to_linear(128 / 255.0) : 1.0, 1e-5);
        assert_near(texel.a, channels == 2 ? 0.0 : channels == 4 ? 64 / 255.0 : 1.0, 1e-6);
        texture.image = add_image(floats, PPM_PIXELS_F32, PPM_IMAGE_COLOR, 1, 1, channels);
        texel = look_up(&texture, 0.5f, 0.5f);
        assert_near(texel.b, channels >= 3 ? 5.0 : 1.0, 0.0);
        assert_near(texel.a, channels == 2 ? 0.0 : channels == 4 ? 0.25 : 1.0, 0.0);
    }
}

static void transforms_move_the_coordinates(void **state)
{
    (void)state;
    const float pixels[6] = {1, 2, 3, 4, 5, 6};
    ppm_texture texture = {.image = add_image(pixels, PPM_PIXELS_F32, PPM_IMAGE_DATA, 3, 2, 1),
                           .filter = PPM_FILTER_NEAREST,
                           .has_transform = 1,
                           .uv_transform = {0.0f, 1.0f, 0.0f, 1.0f, 0.0f, 0.0f}};
    assert_near(look_up(&texture, 0.9f, 0.1f).r, 4.0, 0.0); /* swapped: (0.1, 0.9) */
    const float shifted[6] = {1.0f, 0.0f, 1.0f / 3.0f, 0.0f, 2.0f, 0.5f};
    for (int i = 0; i < 6; i++)
        texture.uv_transform[i] = shifted[i];
    assert_near(look_up(&texture, 0.1f, 0.1f).r, 5.0, 0.0); /* (0.43, 0.7) */
    texture.has_transform = 0;
    assert_near(look_up(&texture, 0.1f, 0.1f).r, 1.0, 0.0);
}

static void absurd_coordinates_stay_in_the_image(void **state)
{
    (void)state;
    ppm_texture texture = {.image = add_image(ramp, PPM_PIXELS_F32, PPM_IMAGE_DATA, 4, 1, 1)};
    const float absurd[] = {1e30f, -1e30f, NAN, INFINITY, -INFINITY, 9.9e6f};
    for (int wrap = 0; wrap < 3; wrap++) {
        texture.wrap_u = texture.wrap_v = wrap;
        for (int filter = 0; filter < 2; filter++) {
            texture.filter = filter;
            for (int i = 0; i < 6; i++) {
                const ppmi_texel texel = look_up(&texture, absurd[i], absurd[5 - i]);
                assert_true(texel.r >= 0.0f && texel.r <= 3.0f);
            }
        }
    }
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(nearest_takes_the_texel_that_is_hit),
        WITH_SCENE(u_runs_right_and_v_runs_down),
        WITH_SCENE(linear_filtering_goes_from_centre_to_centre),
        WITH_SCENE(colour_is_decoded_before_filtering_and_data_is_not),
        WITH_SCENE(channels_mean_what_they_are),
        WITH_SCENE(transforms_move_the_coordinates),
        WITH_SCENE(absurd_coordinates_stay_in_the_image),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
