/* Texture look-ups over a footprint. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/sampler.h"
#include "scene/mipmap.h"
#include "shading/texture.h"
#include "support/near.h"
#include "support/scenes.h"

enum { SIDE = 64 };

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

static ppm_image_id add_gray(const uint8_t *pixels, uint32_t width, uint32_t height)
{
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = PPM_IMAGE_COLOR,
                                 .pixels = pixels,
                                 .pixel_type = PPM_PIXELS_U8,
                                 .width = width,
                                 .height = height,
                                 .channels = 1};
    ppm_image_id id = 0;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
    assert_int_equal(ppmi_scene_build_mipmaps(test.scene), PPM_STATUS_OK);
    return id;
}

/* Squares of cells x cells texels; cells_y as high as the image: stripes. */
static ppm_image_id add_checkers(uint32_t cell_x, uint32_t cell_y)
{
    static uint8_t pixels[SIDE * SIDE];
    for (uint32_t y = 0; y < SIDE; y++) {
        for (uint32_t x = 0; x < SIDE; x++)
            pixels[y * SIDE + x] = (x / cell_x + y / cell_y) % 2 ? 255 : 0;
    }
    return add_gray(pixels, SIDE, SIDE);
}

static float filtered(const ppm_texture *texture, ppmi_vec2 uv, ppmi_vec2 dx, ppmi_vec2 dy)
{
    return ppmi_texture_filtered(test.scene, texture, uv, dx, dy).r;
}

/* One code of 8 bits, in linear light, and what rounding in floats leaves. */
static const double one_code = 0.009;

static void a_checkerboard_from_afar_is_half_of_the_light(void **state)
{
    (void)state;
    const ppm_texture texture = {.image = add_checkers(4, 4)};
    const float steps[] = {0.5f, 1.0f, 3.0f, 1e3f, 1e9f, INFINITY};
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 8; k++) {
            const ppmi_vec2 uv = {0.13f * (float)k, 0.29f * (float)k};
            assert_near(filtered(&texture, uv, (ppmi_vec2){steps[i], 0}, (ppmi_vec2){0, steps[i]}),
                        0.5, one_code);
        }
    }
}

static void a_footprint_within_a_texel_changes_nothing(void **state)
{
    (void)state;
    ppm_texture texture = {.image = add_checkers(1, 1)};
    for (int32_t filter = PPM_FILTER_LINEAR; filter <= PPM_FILTER_NEAREST; filter++) {
        texture.filter = filter;
        for (int k = 0; k < 50; k++) {
            const ppmi_vec2 uv = {0.0137f * (float)k, 0.0293f * (float)k};
            const float step = 0.7f / SIDE;
            assert_near(filtered(&texture, uv, (ppmi_vec2){step, 0}, (ppmi_vec2){0, step}),
                        ppmi_texture_lookup(test.scene, &texture, uv).r, 0.0);
            assert_near(filtered(&texture, uv, (ppmi_vec2){0, 0}, (ppmi_vec2){0, 0}),
                        ppmi_texture_lookup(test.scene, &texture, uv).r, 0.0);
        }
    }
}

/* What a floor that is seen at a grazing angle needs. */
static void a_long_footprint_blurs_along_itself_only(void **state)
{
    (void)state;
    const ppm_texture texture = {.image = add_checkers(8, SIDE)}; /* upright stripes */
    const float thin = 1.0f / SIDE, tall = 12.0f / SIDE;
    const ppmi_vec2 along = {0, tall}, across = {thin, 0};
    for (int i = 0; i < 8; i++) { /* the middles of stripes */
        const ppmi_vec2 uv = {(8.0f * (float)i + 4.0f) / SIDE, 0.4f};
        assert_near(filtered(&texture, uv, across, along), i % 2, 1e-6);
        assert_near(filtered(&texture, uv, along, across), i % 2, 1e-6);
    }
    const ppmi_vec2 wide = {16.0f / SIDE, 0}, low = {0, thin};
    for (int i = 0; i < 20; i++)
        assert_near(filtered(&texture, (ppmi_vec2){0.037f * (float)i, 0.4f}, wide, low), 0.5, 0.07);
}

/* The same ellipse, however its two axes are told. */
static void only_the_ellipse_of_a_footprint_counts(void **state)
{
    (void)state;
    const ppm_texture texture = {.image = add_checkers(5, 3)};
    const ppmi_vec2 a = {0.06f, 0.01f}, b = {-0.01f, 0.02f};
    for (int i = 1; i < 12; i++) {
        const float c = cosf(0.5f * (float)i), s = sinf(0.5f * (float)i);
        const ppmi_vec2 turned_a = {c * a.x + s * b.x, c * a.y + s * b.y};
        const ppmi_vec2 turned_b = {c * b.x - s * a.x, c * b.y - s * a.y};
        const ppmi_vec2 uv = {0.31f, 0.07f * (float)i};
        assert_near(filtered(&texture, uv, turned_a, turned_b), filtered(&texture, uv, a, b), 1e-4);
    }
}

static void a_transform_of_the_texture_is_one_of_place_and_footprint(void **state)
{
    (void)state;
    const ppm_texture plain = {.image = add_checkers(5, 3)};
    ppm_texture transformed = plain;
    const float m[6] = {1.5f, -0.7f, 0.2f, 0.4f, 2.5f, -0.3f};
    transformed.has_transform = 1;
    for (int i = 0; i < 6; i++)
        transformed.uv_transform[i] = m[i];
    const ppmi_vec2 dx = {0.05f, 0.01f}, dy = {0.004f, 0.02f};
    const ppmi_vec2 mdx = {m[0] * dx.x + m[1] * dx.y, m[3] * dx.x + m[4] * dx.y};
    const ppmi_vec2 mdy = {m[0] * dy.x + m[1] * dy.y, m[3] * dy.x + m[4] * dy.y};
    for (int i = 0; i < 20; i++) {
        const ppmi_vec2 uv = {0.1f * (float)i, 0.07f * (float)i};
        const ppmi_vec2 muv = {m[0] * uv.x + m[1] * uv.y + m[2], m[3] * uv.x + m[4] * uv.y + m[5]};
        assert_near(filtered(&transformed, uv, dx, dy), filtered(&plain, muv, mdx, mdy), 1e-5);
    }
}

/* The look-up as a filter: over random places it has the mean of the texture, and less variance the
 * larger the footprint. */
static void footprints_keep_the_mean_and_smooth(void **state)
{
    (void)state;
    const ppm_texture texture = {.image = add_checkers(2, 2)};
    double before = 1.0;
    for (float texels = 1.5f; texels < 24.0f; texels *= 2.0f) {
        const float step = texels / SIDE;
        enum { GRID = 128 };
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < GRID * GRID; i++) {
            const ppmi_vec2 uv = {((float)(i % GRID) + 0.5f) / GRID,
                                  ((float)(i / GRID) + 0.5f) / GRID};
            const double value =
                (double)filtered(&texture, uv, (ppmi_vec2){step, 0}, (ppmi_vec2){0, 1.5f * step});
            sum += value / (GRID * GRID);
            squares += value * value / (GRID * GRID);
        }
        assert_near(sum, 0.5, one_code);
        const double variance = squares - sum * sum;
        assert_true(variance < before);
        before = variance + 1e-9;
    }
}

static void wrap_modes_hold_at_every_level(void **state)
{
    (void)state;
    uint8_t pixels[SIDE] = {0};
    for (int i = SIDE / 2; i < SIDE; i++)
        pixels[i] = 255; /* black left, white right */
    ppm_texture texture = {.image = add_gray(pixels, SIDE, 1)};
    const ppmi_vec2 dx = {8.0f / SIDE, 0}, dy = {0, 8.0f};
    texture.wrap_u = PPM_WRAP_CLAMP;
    assert_near(filtered(&texture, (ppmi_vec2){-3.3f, 0.5f}, dx, dy), 0.0, 1e-6);
    assert_near(filtered(&texture, (ppmi_vec2){4.3f, 0.5f}, dx, dy), 1.0, 1e-6);
    texture.wrap_u = PPM_WRAP_REPEAT;
    assert_near(filtered(&texture, (ppmi_vec2){4.25f, 0.5f}, dx, dy), 0.0, 1e-6);
    assert_near(filtered(&texture, (ppmi_vec2){4.0f, 0.5f}, dx, dy), 0.5, one_code);
    texture.wrap_u = PPM_WRAP_MIRROR;
    assert_near(filtered(&texture, (ppmi_vec2){1.25f, 0.5f}, dx, dy), 1.0, 1e-6);
    assert_near(filtered(&texture, (ppmi_vec2){1.0f, 0.5f}, dx, dy), 1.0, 1e-6);
}

static void broken_footprints_give_numbers(void **state)
{
    (void)state;
    const ppm_texture texture = {.image = add_checkers(1, 1)};
    const float values[] = {NAN, INFINITY, -INFINITY, 1e38f, 1e-38f};
    for (int i = 0; i < 5; i++) {
        const ppmi_vec2 odd = {values[i], 0.1f}, even = {0.1f, 0.2f};
        assert_true(isfinite(filtered(&texture, even, odd, even)));
        assert_true(isfinite(filtered(&texture, even, even, odd)));
        assert_true(isfinite(filtered(&texture, odd, even, even)));
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(broken_footprints_give_numbers),
        TEST(a_checkerboard_from_afar_is_half_of_the_light),
        TEST(a_footprint_within_a_texel_changes_nothing),
        TEST(a_long_footprint_blurs_along_itself_only),
        TEST(only_the_ellipse_of_a_footprint_counts),
        TEST(a_transform_of_the_texture_is_one_of_place_and_footprint),
        TEST(footprints_keep_the_mean_and_smooth),
        TEST(wrap_modes_hold_at_every_level),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
