/* Lamps of all kinds inside of a coloured solid: photons know that they begin in it, so that their
 * light is absorbed from the start, whatever it ends at. The path tracer is the judge, channel by
 * channel; red is absorbed most. */
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

typedef enum lamp_kind { POINT, BALL, RECTANGLE, TRIANGLES, BULB, LAMP_KINDS } lamp_kind;
static const char *const names[LAMP_KINDS] = {"point", "ball", "rectangle", "triangles", "bulb"};

static ppm_material_id coloured_solid(float ior, ppmi_vec3 color, float distance_m)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    desc.transmission = 1.0f;
    desc.roughness = 0.0f;
    desc.ior = ior;
    vec3_store(desc.attenuation_color, color);
    desc.attenuation_distance_m = distance_m;
    return material_add(test.scene, &desc);
}

static void add_light(int32_t kind, float radius_m, float side_m)
{
    ppm_light_desc desc = {.size = sizeof desc, .kind = kind};
    const float down[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0.1f, 0.5f, -0.2f, 1};
    memcpy(desc.transform, down, sizeof down);
    vec3_store(desc.intensity, side_m > 0.0f ? vec3_splat(40.0f) : vec3_splat(5.0f));
    desc.radius_m = radius_m;
    if (side_m > 0.0f) desc.width_m = desc.height_m = side_m;
    desc.is_hidden = 1;
    ppm_light_id id;
    assert_int_equal(ppm_scene_add_light(test.scene, &desc, &id), PPM_STATUS_OK);
}

static void add_lamp(lamp_kind kind)
{
    const ppm_material_id glow = material_emitter(test.scene, 20.0f, 0.0f, false);
    switch (kind) {
    case POINT:
        add_light(PPM_LIGHT_POINT, 0.0f, 0.0f);
        break;
    case BALL:
        add_light(PPM_LIGHT_POINT, 0.05f, 0.0f);
        break;
    case RECTANGLE:
        add_light(PPM_LIGHT_RECTANGLE, 0.0f, 0.3f);
        break;
    case BULB: /* a filament in coloured glass that fills it: nested solids, and refraction */
        shape_place_at(test.scene,
                       shape_sphere(test.scene, coloured_solid(1.33f, vec3(0.9f, 0.4f, 0.2f), 0.2f),
                                    0.2f, 8, false),
                       vec3(0.1f, 0.5f, -0.2f));
        /* fallthrough */
    default:
        shape_place(test.scene, shape_box(test.scene, glow, vec3(0, 0.45f, -0.3f),
                                          vec3(0.2f, 0.55f, -0.1f), 1, false));
    }
}

/* A room that is cut into coloured water: all that light ends at lies in it. */
static void build_room(lamp_kind kind)
{
    const ppm_material_id grey = material_lambert(test.scene, 0.7f);
    const ppm_material_id water = coloured_solid(1.33f, vec3(0.1f, 0.5f, 0.9f), 1.0f);
    shape_place(test.scene, shape_box(test.scene, grey, vec3_splat(-1), vec3_splat(1), 1, true));
    shape_place(test.scene,
                shape_box(test.scene, water, vec3_splat(-1.1f), vec3_splat(1.1f), 1, false));
    shape_place(test.scene, shape_box(test.scene, grey, vec3(-0.5f, -0.9f, -0.6f),
                                      vec3(0.5f, -0.2f, 0.3f), 1, false));
    add_lamp(kind);
    camera_perspective(test.scene, vec3(0, 0.2f, 0.9f), vec3(0, -0.4f, -0.3f), 0.7f);
}

/* Adds the mean of each channel over the picture to user's three means. */
static double measure_channels(const float *rgba, const ppm_render_options *options, void *user)
{
    test_mean *means = user;
    const uint32_t pixels = options->width * options->height;
    for (uint32_t channel = 0; channel < 3; channel++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < pixels; i++)
            sum += (double)rgba[4 * i + channel];
        mean_add(&means[channel], sum / pixels);
    }
    return 0.0;
}

static void light_of(lamp_kind kind, int32_t integrator, int32_t direct, test_mean out_means[3])
{
    const bool is_path = integrator == PPM_INTEGRATOR_PATH;
    scene_open(&test);
    build_room(kind);
    ppm_render_options options = render_options(integrator, 8, 10000);
    options.direct = direct;
    options.radius_m = is_path ? 0.0f : 0.05f;
    for (int channel = 0; channel < 3; channel++)
        out_means[channel] = (test_mean){0};
    const uint32_t passes = is_path ? (kind == BULB ? 400 : 48) : 6;
    render_means(test.scene, &options, passes, is_path ? 8 : 5, measure_channels, out_means);
    scene_close(&test);
}

static void photons_begin_in_the_solid_around_their_lamp(void **state)
{
    (void)state;
    for (int kind = 0; kind < LAMP_KINDS; kind++) {
        test_mean path[3], other[3];
        light_of(kind, PPM_INTEGRATOR_PATH, PPM_DIRECT_DEFAULT, path);
        for (int direct = PPM_DIRECT_SAMPLE; direct <= PPM_DIRECT_PHOTONS; direct++) {
            if (kind == BULB && direct == PPM_DIRECT_SAMPLE) continue; /* no other than photons' */
            light_of(kind, PPM_INTEGRATOR_SPPM, direct, other);
            for (int channel = 0; channel < 3; channel++) {
                const double error = hypot(mean_error(&path[channel]), mean_error(&other[channel]));
                const double off = other[channel].mean - path[channel].mean;
                if (fabs(off) > 0.03 * path[channel].mean + 3.0 * error) {
                    fail_msg("%s, direct %d, channel %d: %g, path %g, error %g", names[kind],
                             direct, channel, other[channel].mean, path[channel].mean, error);
                }
                if (error > 0.04 * path[channel].mean) {
                    fail_msg("%s, channel %d: %g is too noisy by %g", names[kind], channel,
                             path[channel].mean, error);
                }
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photons_begin_in_the_solid_around_their_lamp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
