/* The working space: every colour enters it, and the picture is in it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "color/color.h"
#include "imageio/imageio.h"
#include "imageio/scratch.h"
#include "shading/iridescence.h"
#include "shading/spectrum.h"
#include "support/near.h"
#include "support/renders.h"
#include "support/scenes.h"

/* Linear Rec.709 to ACEScg, Bradford (ACES TB-2014-004, TB-2014-012). */
static const double to_acescg[9] = {0.613097, 0.339523, 0.047379, 0.070194, 0.916354,
                                    0.013452, 0.020616, 0.109570, 0.869815};

/* A configuration of version 1 whose textures have a curve of their own, and whose working space
 * has primaries that nobody knows. White stays white. */
static const char user_config[] = "ocio_profile_version: 1\n"
                                  "roles: {scene_linear: house, default: house}\n"
                                  "displays:\n"
                                  "  screen:\n"
                                  "    - !<View> {name: plain, colorspace: house}\n"
                                  "colorspaces:\n"
                                  "  - !<ColorSpace> {name: house}\n"
                                  "  - !<ColorSpace>\n"
                                  "    name: lin_srgb\n"
                                  "    to_reference: !<MatrixTransform> {matrix: [0.7, 0.2, 0.1, "
                                  "0, 0.1, 0.8, 0.1, 0, 0.05, 0.15, "
                                  "0.8, 0, 0, 0, 0, 1]}\n"
                                  "  - !<ColorSpace>\n"
                                  "    name: srgb_tx\n"
                                  "    to_reference: !<GroupTransform>\n"
                                  "      children:\n"
                                  "        - !<ExponentTransform> {value: [2, 2, 2, 1]}\n"
                                  "        - !<ColorSpaceTransform> {src: lin_srgb, dst: house}\n";
static const double to_house[9] = {0.7, 0.2, 0.1, 0.1, 0.8, 0.1, 0.05, 0.15, 0.8};

typedef struct fixture {
    ppm_context *context;
    ppm_color *color;
    ppm_scene *scene;
    int notes;
    char note[512];
} fixture;

static fixture test;

static void keep_note(void *user, ppm_log_level level, const char *message)
{
    (void)user;
    if (level == PPM_LOG_DEBUG) return;
    test.notes++;
    snprintf(test.note, sizeof test.note, "%s", message);
}

static int setup(void **state)
{
    (void)state;
    test = (fixture){0};
    unsetenv("OCIO");
    scratch_create();
    const ppm_context_desc desc = {.size = sizeof desc, .log = keep_note};
    return ppm_context_create(&desc, &test.context);
}

static int teardown(void **state)
{
    (void)state;
    ppm_scene_destroy(test.scene);
    ppm_color_destroy(test.color);
    const size_t live = ppmi_alloc_live(test.context);
    ppm_context_destroy(test.context);
    scratch_remove();
    return live == 0 ? 0 : 1;
}

/* Opens a scene in a working space of config (NULL: the built-in one), with a rule for textures. */
static void open_scene(const char *config, const char *space, const ppm_texture_space *rule)
{
    const ppm_color_options options = {.size = sizeof options,
                                       .config_path = config ? config : "",
                                       .working_space = space,
                                       .texture_space_count = rule ? 1 : 0,
                                       .texture_spaces = rule};
    ppm_scene_destroy(test.scene);
    ppm_color_destroy(test.color);
    test.scene = NULL;
    test.color = NULL;
    assert_int_equal(ppm_color_create_with(test.context, &options, &test.color), PPM_STATUS_OK);
    assert_int_equal(ppm_scene_create(test.context, test.color, &test.scene), PPM_STATUS_OK);
    test.notes = 0;
}

static double srgb_decoded(double code)
{
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}

static void convert(const double m[9], const double in[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[3 * i] * in[0] + m[3 * i + 1] * in[1] + m[3 * i + 2] * in[2];
}

/* ---- a plane in flat light ------------------------------------------------------------------- */

enum { SIDE = 8, PIXELS = SIDE * SIDE };

/* Adds a plane that fills the picture, lambertian, with a texture or none (0), in white light of 1
 * from everywhere. */
static void add_plane(const float color[3], ppm_image_id image)
{
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    memcpy(desc.base_color, color, 3 * sizeof *color);
    desc.specular = 0.0f;
    desc.roughness = 1.0f;
    desc.base_color_texture.image = image;
    add_quad(test.scene, material_add(test.scene, &desc), vec3(-2, -2, 0), vec3(4, 0, 0),
             vec3(0, 4, 0));
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 3), vec3(0, 0, 0), 1.0f);
}

/* The mean of the picture. */
static void render_mean(double out[3])
{
    ppm_render_options options = render_options(PPM_INTEGRATOR_PATH, SIDE, 0);
    float *rgba = render_picture(test.scene, &options, 16);
    for (int c = 0; c < 3; c++) {
        out[c] = 0.0;
        for (int i = 0; i < PIXELS; i++)
            out[c] += (double)rgba[4 * i + c] / PIXELS;
    }
    free(rgba);
}

/* An 8-bit texture of one colour on a white plane against the plane alone: both renders draw the
 * same directions, so that the quotient is the texture's value without noise. */
static void assert_texture_returns(const char *config, const char *space, const uint8_t code[3],
                                   const double expected[3])
{
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    double plain[3], textured[3];
    uint8_t pixels[4 * 3];
    for (int i = 0; i < 12; i++)
        pixels[i] = code[i % 3];
    open_scene(config, space, NULL);
    add_plane(white, 0);
    render_mean(plain);
    open_scene(config, space, NULL);
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = PPM_IMAGE_COLOR,
                                 .pixels = pixels,
                                 .pixel_type = PPM_PIXELS_U8,
                                 .width = 2,
                                 .height = 2,
                                 .channels = 3};
    ppm_image_id image = 0;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &image), PPM_STATUS_OK);
    add_plane(white, image);
    render_mean(textured);
    for (int c = 0; c < 3; c++) {
        assert_near(plain[c], 1.0, 0.1); /* the light is there; noise is not the question */
        assert_near(textured[c] / plain[c], expected[c], 1e-3);
    }
}

static void a_texture_returns_its_value(void **state)
{
    (void)state;
    static const uint8_t codes[][3] = {{200, 30, 90}, {10, 240, 128}, {255, 255, 255}, {0, 0, 255}};
    scratch_write_text("user.ocio", user_config);
    for (int k = 0; k < 4; k++) {
        double code[3], linear[3], squared[3], expected[3];
        for (int c = 0; c < 3; c++) {
            code[c] = codes[k][c] / 255.0;
            linear[c] = srgb_decoded(code[c]);
            squared[c] = code[c] * code[c];
        }
        assert_texture_returns(NULL, NULL, codes[k], linear);
        convert(to_acescg, linear, expected);
        assert_texture_returns(NULL, "ACEScg", codes[k], expected);
        convert(to_house, squared, expected);
        assert_texture_returns(scratch_path("user.ocio"), NULL, codes[k], expected);
    }
}

static void the_aswf_configuration_works_in_acescg_by_its_role(void **state)
{
    (void)state;
    static const char path[] = PPM_ASSETS_DIR "/ocio/cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio";
    FILE *const file = fopen(path, "rb");
    if (!file) {
        print_message("skipped: %s is not here\n", path);
        skip();
    }
    fclose(file);
    static const uint8_t code[3] = {200, 30, 90};
    double linear[3], expected[3];
    for (int c = 0; c < 3; c++)
        linear[c] = srgb_decoded(code[c] / 255.0);
    convert(to_acescg, linear, expected);
    assert_texture_returns(path, NULL, code, expected);
    assert_string_equal(ppm_color_working_space(test.color), "ACEScg");
}

/* ---- constants ------------------------------------------------------------------------------- */

static const float sample[3] = {0.9f, 0.1f, 0.02f};

static void assert_is_acescg(const float value[3], double scale)
{
    const double in[3] = {(double)sample[0], (double)sample[1], (double)sample[2]};
    double expected[3];
    convert(to_acescg, in, expected);
    for (int c = 0; c < 3; c++)
        assert_near(value[c], scale * expected[c], 2e-5 * scale);
}

static void constants_of_materials_are_converted(void **state)
{
    (void)state;
    open_scene(NULL, "ACEScg", NULL);
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    float *const colors[] = {desc.base_color,        desc.emission,
                             desc.specular_color,    desc.attenuation_color,
                             desc.sheen_color,       desc.diffuse_transmission_color,
                             desc.multiscatter_color};
    for (int i = 0; i < 7; i++)
        memcpy(colors[i], sample, sizeof sample);
    material_add(test.scene, &desc);
    const ppm_material_desc *const kept = &test.scene->materials[0].desc;
    const float *const found[] = {kept->base_color,        kept->emission,
                                  kept->specular_color,    kept->attenuation_color,
                                  kept->sheen_color,       kept->diffuse_transmission_color,
                                  kept->multiscatter_color};
    for (int i = 0; i < 7; i++)
        assert_is_acescg(found[i], 1.0);
}

static void lights_are_converted(void **state)
{
    (void)state;
    open_scene(NULL, "ACEScg", NULL);
    float value[3];
    light_point(test.scene, vec3(0, 0, 0), vec3_scale(vec3_load(sample), 1000.0f));
    vec3_store(value, test.scene->punctuals[0].intensity);
    assert_is_acescg(value, 1000.0);
    light_environment(test.scene, vec3_scale(vec3_load(sample), 50.0f), 0, 0.0f);
    vec3_store(value, test.scene->environment.radiance);
    assert_is_acescg(value, 50.0);
}

static void vertex_colours_are_converted(void **state)
{
    (void)state;
    open_scene(NULL, "ACEScg", NULL);
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t indices[3] = {0, 1, 2};
    float colors[12];
    for (int i = 0; i < 12; i++)
        colors[i] = i % 4 == 3 ? 0.5f : sample[i % 4];
    const ppm_primitive_desc primitive = {.vertex_count = 3,
                                          .positions = positions,
                                          .colors = colors,
                                          .indices = indices,
                                          .triangle_count = 1};
    const ppm_mesh_desc mesh = {
        .size = sizeof mesh, .primitive_count = 1, .primitives = &primitive};
    ppm_mesh_id id;
    assert_int_equal(ppm_scene_add_mesh(test.scene, &mesh, &id), PPM_STATUS_OK);
    const float *kept = test.scene->meshes[0].primitives[0].colors;
    for (int i = 0; i < 3; i++) {
        assert_is_acescg(kept + 4 * i, 1.0);
        assert_near(kept[4 * i + 3], 0.5, 0.0);
    }
}

static void grey_fog_stays_and_coloured_fog_keeps_what_it_leaves(void **state)
{
    (void)state;
    open_scene(NULL, "ACEScg", NULL);
    scene_fog(test.scene, vec3_splat(0.3f), vec3_splat(0.1f), 0.0f);
    for (int c = 0; c < 3; c++) {
        const float s[3] = {test.scene->fog.sigma_s.x, test.scene->fog.sigma_s.y,
                            test.scene->fog.sigma_s.z};
        assert_near(s[c], 0.3, 1e-5);
    }
    assert_near(test.scene->fog.sigma_a.y, 0.1, 1e-5);
    scene_fog(test.scene, vec3_splat(0.0f), vec3(0.1f, 0.5f, 0.9f), 0.0f);
    double left[3], expected[3];
    for (int c = 0; c < 3; c++)
        left[c] = exp(-(0.1 + 0.4 * c) / 0.5); /* after a mean free path: 2 m */
    convert(to_acescg, left, expected);
    assert_near(exp(-2.0 * (double)test.scene->fog.sigma_a.x), expected[0], 1e-4);
    assert_near(exp(-2.0 * (double)test.scene->fog.sigma_a.y), expected[1], 1e-4);
    assert_near(exp(-2.0 * (double)test.scene->fog.sigma_a.z), expected[2], 1e-4);
}

static void a_sky_is_converted(void **state)
{
    (void)state;
    ppmi_vec3 sun[2];
    float zenith[2][3];
    for (int k = 0; k < 2; k++) {
        open_scene(NULL, k == 0 ? NULL : "ACEScg", NULL);
        const ppm_environment_desc backdrop = {
            .size = sizeof backdrop, .has_backdrop = 1, .backdrop = {0.9f, 0.1f, 0.02f}};
        assert_int_equal(ppm_scene_set_environment(test.scene, &backdrop), PPM_STATUS_OK);
        ppm_sun_sky_desc desc;
        ppm_sun_sky_desc_init(&desc);
        assert_int_equal(ppm_scene_add_sun_sky(test.scene, &desc, NULL), PPM_STATUS_OK);
        sun[k] = test.scene->punctuals[0].intensity;
        memcpy(zenith[k], test.scene->images[0].f32, sizeof zenith[k]);
    }
    float kept[3]; /* converted once, when it was set */
    vec3_store(kept, test.scene->environment.backdrop);
    assert_is_acescg(kept, 1.0);
    const double sky_in[3] = {(double)zenith[0][0], (double)zenith[0][1], (double)zenith[0][2]};
    const double sun_in[3] = {(double)sun[0].x, (double)sun[0].y, (double)sun[0].z};
    double expected[3];
    convert(to_acescg, sky_in, expected);
    for (int c = 0; c < 3; c++)
        assert_near(zenith[1][c], expected[c], 1e-4 * expected[c]);
    convert(to_acescg, sun_in, expected);
    assert_near(sun[1].x, expected[0], 1e-4 * expected[0]);
}

/* ---- textures of other spaces ---------------------------------------------------------------- */

/* The value of a texture of one colour that is read from a file. */
static ppmi_image *add_file(const char *name)
{
    const ppm_image_desc desc = {
        .size = sizeof desc, .role = PPM_IMAGE_COLOR, .path = scratch_path(name)};
    ppm_image_id id = 0;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
    return &test.scene->images[id - 1];
}

static void write_colour(const char *name, int32_t store, const float rgb[3],
                         const float chromaticities[8])
{
    const ppmi_image_attribute attribute = {.name = "chromaticities",
                                            .type = PPMI_ATTRIBUTE_FLOATS,
                                            .floats = chromaticities,
                                            .float_count = 8};
    const ppmi_image_file file = {.width = 1,
                                  .height = 1,
                                  .channels = 3,
                                  .pixels = rgb,
                                  .store = store,
                                  .attribute_count = chromaticities ? 1 : 0,
                                  .attributes = &attribute};
    assert_int_equal(ppmi_imageio_write_file(test.context, scratch_path(name), &file),
                     PPM_STATUS_OK);
}

static const float ap1[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};

static void a_pattern_gives_a_texture_its_space(void **state)
{
    (void)state;
    static const float rgb[3] = {0.8f, 0.4f, 0.2f};
    const ppm_texture_space rule = {"*_ap1.p?g", "lin_ap1"};
    write_colour("wood_ap1.png", PPMI_STORE_U8, rgb, NULL);
    write_colour("wood.png", PPMI_STORE_U8, rgb, NULL);
    open_scene(NULL, "ACEScg", &rule);
    const ppmi_image *image = add_file("wood_ap1.png");
    assert_non_null(image->f32);
    for (int c = 0; c < 3; c++)
        assert_near(image->f32[c], rgb[c], 1e-5);
    image = add_file("wood.png");
    assert_non_null(image->u8); /* stays as it is, and is converted where it is looked up */
    assert_true(image->is_srgb && image->is_rec709);
}

/* As in a .glb. */
static void an_embedded_texture_goes_by_its_label(void **state)
{
    (void)state;
    static const float rgb[3] = {0.8f, 0.4f, 0.2f};
    const ppm_texture_space rule = {"wood_*", "lin_ap1"};
    static const char *const labels[] = {"wood_ap1", NULL};
    static uint8_t bytes[4096];
    write_colour("a.png", PPMI_STORE_U8, rgb, NULL);
    FILE *const file = fopen(scratch_path("a.png"), "rb");
    assert_non_null(file);
    const size_t count = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    open_scene(NULL, "ACEScg", &rule);
    for (int i = 0; i < 2; i++) {
        const ppm_image_desc desc = {.size = sizeof desc,
                                     .name = "a.glb: images[0]",
                                     .role = PPM_IMAGE_COLOR,
                                     .bytes = bytes,
                                     .byte_count = count,
                                     .label = labels[i]};
        ppm_image_id id = 0;
        assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
        assert_true((test.scene->images[id - 1].f32 != NULL) == (i == 0));
    }
}

static void a_space_of_data_leaves_a_texture_alone(void **state)
{
    (void)state;
    static const float rgb[3] = {0.8f, 0.4f, 0.2f};
    const ppm_texture_space rule = {"*", "Raw"};
    write_colour("mask.png", PPMI_STORE_U8, rgb, NULL);
    open_scene(NULL, "ACEScg", &rule);
    const ppmi_image *image = add_file("mask.png");
    assert_true(!image->is_srgb && !image->is_rec709);
    assert_int_equal(image->u8[0], 204);
}

static void an_unknown_space_of_a_pattern_is_named(void **state)
{
    (void)state;
    const ppm_texture_space rule = {"*", "ACESgc"};
    const ppm_color_options options = {.size = sizeof options,
                                       .config_path = "",
                                       .texture_space_count = 1,
                                       .texture_spaces = &rule};
    ppm_color *color = NULL;
    assert_int_equal(ppm_color_create_with(test.context, &options, &color), PPM_STATUS_NOT_FOUND);
    assert_null(color);
    assert_non_null(strstr(test.note, "did you mean \"ACEScg\""));
}

static void a_float_picture_has_the_primaries_that_it_says(void **state)
{
    (void)state;
    static const float rgb[3] = {2.0f, 0.5f, 0.1f};
    write_colour("env.exr", PPMI_STORE_FLOAT, rgb, ap1);
    write_colour("plain.exr", PPMI_STORE_FLOAT, rgb, NULL);
    open_scene(NULL, "ACEScg", NULL);
    const ppmi_image *image = add_file("env.exr");
    for (int c = 0; c < 3; c++)
        assert_near(image->f32[c], rgb[c], 2e-5);
    const double in[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]};
    double expected[3];
    convert(to_acescg, in, expected);
    image = add_file("plain.exr");
    for (int c = 0; c < 3; c++)
        assert_near(image->f32[c], expected[c], 2e-5);
}

static void what_the_working_space_does_not_hold_is_clamped_with_a_note(void **state)
{
    (void)state;
    static const float green[3] = {0.0f, 1.0f, 0.0f}; /* of ACEScg: outside of Rec.709 */
    write_colour("green.exr", PPMI_STORE_FLOAT, green, ap1);
    open_scene(NULL, NULL, NULL);
    const ppmi_image *image = add_file("green.exr");
    assert_near(image->f32[0], 0.0, 0.0);
    assert_true(image->f32[1] > 1.0f);
    assert_near(image->f32[2], 0.0, 0.0);
    assert_int_equal(test.notes, 1);
    assert_non_null(strstr(test.note, "100 % of its pixels"));
}

static void primaries_on_a_line_are_a_warning(void **state)
{
    (void)state;
    static const float line[8] = {0.1f, 0.1f, 0.2f, 0.2f, 0.3f, 0.3f, 0.33f, 0.33f};
    static const float rgb[3] = {2.0f, 0.5f, 0.1f};
    write_colour("line.exr", PPMI_STORE_FLOAT, rgb, line);
    open_scene(NULL, NULL, NULL);
    const ppmi_image *image = add_file("line.exr");
    assert_near(image->f32[0], 2.0, 1e-6);
    assert_non_null(strstr(test.note, "chromaticities"));
}

static void a_rule_of_the_configuration_applies_unless_it_is_the_default(void **state)
{
    (void)state;
    static const float rgb[3] = {0.8f, 0.4f, 0.2f};
    static const char config[] =
        "ocio_profile_version: 2\n"
        "roles: {aces_interchange: ap0, scene_linear: ap0, default: ap0}\n"
        "file_rules:\n"
        "  - !<Rule> {name: Scans, colorspace: ap0, pattern: \"*scan*\", extension: png}\n"
        "  - !<Rule> {name: Default, colorspace: default}\n"
        "displays:\n"
        "  screen:\n"
        "    - !<View> {name: plain, colorspace: ap0}\n"
        "colorspaces:\n"
        "  - !<ColorSpace> {name: ap0}\n";
    scratch_write_text("rules.ocio", config);
    write_colour("scan1.png", PPMI_STORE_U8, rgb, NULL);
    write_colour("photo.png", PPMI_STORE_U8, rgb, NULL);
    open_scene(scratch_path("rules.ocio"), NULL, NULL);
    const ppmi_image *image = add_file("scan1.png");
    assert_non_null(image->f32);
    assert_near(image->f32[0], 0.8, 1e-5);
    assert_true(add_file("photo.png")->is_srgb);
}

static void a_mean_is_told_in_rec709(void **state)
{
    (void)state;
    static const float rgb[3] = {0.8f, 0.4f, 0.2f};
    write_colour("a.exr", PPMI_STORE_FLOAT, rgb, NULL);
    open_scene(NULL, "ACEScg", NULL);
    add_file("a.exr");
    float mean[4];
    assert_int_equal(ppm_scene_image_mean(test.scene, 1, mean), PPM_STATUS_OK);
    for (int c = 0; c < 3; c++)
        assert_near(mean[c], rgb[c], 1e-5);
    assert_near(mean[3], 1.0, 0.0);
}

/* ---- spectra --------------------------------------------------------------------------------- */

static void the_whole_spectrum_is_white_in_any_space(void **state)
{
    (void)state;
    static ppmi_spectrum spectrum;
    open_scene(NULL, "ACEScg", NULL);
    ppmi_spectrum_init(&spectrum, &test.scene->working);
    double sum[3] = {0.0};
    float blue = 0.0f;
    for (int i = 0; i < PPMI_SPECTRUM_BINS; i++) {
        const double p = (double)(spectrum.cumulative[i + 1] - spectrum.cumulative[i]);
        sum[0] += p * (double)spectrum.weight[i].x;
        sum[1] += p * (double)spectrum.weight[i].y;
        sum[2] += p * (double)spectrum.weight[i].z;
        if (PPMI_SPECTRUM_FIRST_NM + i == 510) blue = spectrum.weight[i].x;
    }
    for (int c = 0; c < 3; c++)
        assert_near(sum[c], 1.0, 1e-3);
    assert_near(blue, 0.0, 0.1); /* cyan green has next to no red of AP1 */
}

/* Which primaries a reflectance is told in does not change what it is. */
static void a_film_has_the_same_colour_in_any_space(void **state)
{
    (void)state;
    open_scene(NULL, "ACEScg", NULL);
    for (int nm = 100; nm <= 600; nm += 100) {
        const ppmi_vec3 f0 = vec3_splat(0.04f);
        const ppmi_vec3 a =
            ppmi_film_reflectance(1.3f, (float)nm, f0, 0.9f, &ppmi_working_space_rec709);
        const ppmi_vec3 b = ppmi_film_reflectance(1.3f, (float)nm, f0, 0.9f, &test.scene->working);
        if (a.x <= 0.0f || a.y <= 0.0f || a.z <= 0.0f) continue; /* clamped */
        const double in[3] = {(double)a.x, (double)a.y, (double)a.z};
        double expected[3];
        convert(to_acescg, in, expected);
        assert_near(b.x, expected[0], 2e-3);
        assert_near(b.y, expected[1], 2e-3);
        assert_near(b.z, expected[2], 2e-3);
    }
}

/* ---- the space itself ------------------------------------------------------------------------ */

static void known_spaces_are_recognised(void **state)
{
    (void)state;
    open_scene(NULL, "acescg", NULL);
    assert_string_equal(test.scene->working.interop_id, "lin_ap1_scene");
    for (int i = 0; i < 8; i++)
        assert_near(test.scene->working.chromaticities[i], ap1[i], 1e-6);
    open_scene(NULL, "aces_interchange", NULL);
    assert_string_equal(test.scene->working.interop_id, "lin_ap0_scene");
    open_scene(NULL, NULL, NULL);
    assert_string_equal(test.scene->working.interop_id, "lin_rec709_scene");
    assert_false(test.scene->working.differs);
    scratch_write_text("user.ocio", user_config);
    open_scene(scratch_path("user.ocio"), NULL, NULL);
    assert_string_equal(test.scene->working.interop_id, "");
    assert_near(test.scene->working.chromaticities[6], 0.3127, 1e-4); /* white is D65 */
}

static void spaces_that_are_not_scene_linear_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"ACEScct", "sRGB - Texture", "Raw"};
    for (int i = 0; i < 3; i++) {
        const ppm_color_options options = {
            .size = sizeof options, .config_path = "", .working_space = names[i]};
        ppm_color *color = NULL;
        assert_int_equal(ppm_color_create_with(test.context, &options, &color),
                         PPM_STATUS_INPUT_INVALID);
        assert_null(color);
        assert_non_null(strstr(test.note, names[i]));
    }
}

static void white_stays_white_to_the_bit(void **state)
{
    (void)state;
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    float out[3];
    open_scene(NULL, "ACEScg", NULL);
    ppmi_working_light(&test.scene->working, white, out);
    for (int c = 0; c < 3; c++)
        assert_near(out[c], 1.0, 1e-7);
    ppmi_working_reflectance(&test.scene->working, white, out);
    for (int c = 0; c < 3; c++)
        assert_true(out[c] <= 1.0f);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(a_texture_returns_its_value),
        TEST(the_aswf_configuration_works_in_acescg_by_its_role),
        TEST(constants_of_materials_are_converted),
        TEST(lights_are_converted),
        TEST(vertex_colours_are_converted),
        TEST(grey_fog_stays_and_coloured_fog_keeps_what_it_leaves),
        TEST(a_sky_is_converted),
        TEST(a_pattern_gives_a_texture_its_space),
        TEST(an_embedded_texture_goes_by_its_label),
        TEST(a_space_of_data_leaves_a_texture_alone),
        TEST(an_unknown_space_of_a_pattern_is_named),
        TEST(a_float_picture_has_the_primaries_that_it_says),
        TEST(what_the_working_space_does_not_hold_is_clamped_with_a_note),
        TEST(primaries_on_a_line_are_a_warning),
        TEST(a_rule_of_the_configuration_applies_unless_it_is_the_default),
        TEST(a_mean_is_told_in_rec709),
        TEST(the_whole_spectrum_is_white_in_any_space),
        TEST(a_film_has_the_same_colour_in_any_space),
        TEST(known_spaces_are_recognised),
        TEST(spaces_that_are_not_scene_linear_are_refused),
        TEST(white_stays_white_to_the_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
