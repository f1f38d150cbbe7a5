/* Facts about what the camera sees, in scenes where they are known. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/layer_fixture.h"
#include "support/near.h"

static test_scene test;

enum { WIDTH = 8, PIXELS = WIDTH * WIDTH };

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

static void reopen(void)
{
    scene_close(&test);
    scene_open(&test);
}

static void add_sky(void)
{
    light_environment(test.scene, vec3_splat(1.0f), 0, 0.0f);
}

/* The layer of the scene after some passes of the path tracer. */
static float *layer(int32_t kind, uint32_t passes)
{
    const ppm_render_options options = layers_options(WIDTH, kind);
    return layers_picture(test.scene, &options, passes, kind);
}

static void assert_vector(const float *actual, ppmi_vec3 expected, double tolerance)
{
    assert_near(actual[0], expected.x, tolerance);
    assert_near(actual[1], expected.y, tolerance);
    assert_near(actual[2], expected.z, tolerance);
}

/* Every pixel of a layer of three channels. */
static void assert_all(int32_t kind, ppmi_vec3 expected, double tolerance)
{
    float *values = layer(kind, 4);
    for (size_t i = 0; i < PIXELS; i++)
        assert_vector(values + 3 * i, expected, tolerance);
    free(values);
}

/* The place of a pixel's centre in the picture, -1 .. 1 to the right and up. */
static ppmi_vec2 centre_of(size_t pixel)
{
    return (ppmi_vec2){2.0f * ((float)(pixel % WIDTH) + 0.5f) / WIDTH - 1.0f,
                       1.0f - 2.0f * ((float)(pixel / WIDTH) + 0.5f) / WIDTH};
}

/* A wall at z = 0 that faces +z, 20 m wide, and one of 0.5 m at z = 1 before its lower left. */
static ppm_instance_id add_wall(void)
{
    add_sky();
    return layers_add_quad(test.scene, "wall", material_lambert(test.scene, 0.5f),
                           vec3(-10, -10, 0), vec3(20, 0, 0), vec3(0, 20, 0));
}

/* ---- of one ray ------------------------------------------------------------------------------ */

static void depth_is_along_the_axis_of_the_camera(void **state)
{
    (void)state;
    add_wall();
    camera_perspective(test.scene, vec3(1, 2, 5), vec3(1, 2, 0), 1.2f);
    float *values = layer(PPM_LAYER_DEPTH, 1);
    for (size_t i = 0; i < PIXELS; i++)
        assert_near(values[i], 5.0, 1e-5);
    free(values);
    reopen();
    add_wall();
    camera_orthographic(test.scene, vec3(1, 2, 7), vec3(1, 2, 0), 2.0f);
    values = layer(PPM_LAYER_DEPTH, 1);
    for (size_t i = 0; i < PIXELS; i++)
        assert_near(values[i], 7.0, 1e-5);
    free(values);
}

/* Half of the wall, of the layers that tell something of a place. */
static void nothing_is_far_and_of_no_number(void **state)
{
    (void)state;
    add_sky();
    layers_add_quad(test.scene, "half", material_lambert(test.scene, 0.5f), vec3(-4, -4, 0),
                    vec3(8, 0, 0), vec3(0, 4, 0));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    for (int32_t kind = PPM_LAYER_ALBEDO; kind <= PPM_LAYER_MOTION; kind++) {
        ppm_render_options options = layers_options(WIDTH, kind);
        options.shutter_close = 0.5f;
        ppm_render *render = layers_render(test.scene, &options, 4);
        ppm_layer_info info = {.size = sizeof info};
        assert_int_equal(ppm_render_get_layer(render, 1, &info), PPM_STATUS_OK);
        assert_int_equal(info.kind, kind);
        float *values = layers_read(render, kind, 0);
        for (size_t i = 0; i < info.channel_count * PIXELS / 2; i++)
            assert_true(values[i] == (kind == PPM_LAYER_DEPTH ? 1e10f : 0.0f));
        free(values);
        ppm_render_destroy(render);
    }
}

/* By the ray through the pixel's centre that the test makes itself; the second time far from the
 * origin, where the scene is moved for the session, the third time with an origin elsewhere. */
static void positions_are_those_of_the_world(void **state)
{
    (void)state;
    const double origin[3] = {1024.0, 2048.0, -512.0};
    for (int i = 0; i < 3; i++) {
        const ppmi_vec3 at = i != 1 ? vec3_splat(0.0f) : vec3(4e5f, 1e3f, -2e5f);
        const ppmi_vec3 file = i != 2 ? vec3_splat(0.0f) : vec3(1024.0f, 2048.0f, -512.0f);
        reopen();
        if (i == 2) assert_int_equal(ppm_scene_set_origin(test.scene, origin), PPM_STATUS_OK);
        add_sky();
        layers_add_quad(test.scene, "wall", material_lambert(test.scene, 0.5f),
                        vec3_add(at, vec3(-10, -10, 0)), vec3(20, 0, 0), vec3(0, 20, 0));
        camera_perspective(test.scene, vec3_add(at, vec3(0, 0, 5)), at, 1.0f);
        float *values = layer(PPM_LAYER_POSITION, 2);
        for (size_t pixel = 0; pixel < PIXELS; pixel++) {
            const ppmi_vec2 centre = centre_of(pixel);
            const float reach = 5.0f * tanf(0.5f);
            const ppmi_vec3 expected = vec3(reach * centre.x, reach * centre.y, 0);
            assert_vector(values + 3 * pixel, vec3_add(vec3_add(at, file), expected),
                          i == 0   ? 1e-5
                          : i == 1 ? 0.04
                                   : 2e-4);
        }
        free(values);
    }
}

/* The picture shows the quad as it is: u to the right, v up. The file's v is down. */
static void uv_is_as_compositors_look_textures_up(void **state)
{
    (void)state;
    add_sky();
    layers_add_quad(test.scene, "quad", material_lambert(test.scene, 0.5f), vec3(-1, 1, 0),
                    vec3(2, 0, 0), vec3(0, -2, 0));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    float *values = layer(PPM_LAYER_UV, 1);
    for (size_t pixel = 0; pixel < PIXELS; pixel++) {
        const ppmi_vec2 centre = centre_of(pixel);
        assert_near(values[2 * pixel], 0.5f + 0.5f * centre.x, 1e-5);
        assert_near(values[2 * pixel + 1], 0.5f + 0.5f * centre.y, 1e-5);
    }
    free(values);
}

static void a_mesh_without_coordinates_has_uv_0(void **state)
{
    (void)state;
    add_sky();
    const ppm_mesh_id box = shape_box(test.scene, material_lambert(test.scene, 0.5f),
                                      vec3(-5, -5, -1), vec3(5, 5, 0), 1, false);
    shape_place(test.scene, box);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    float *values = layer(PPM_LAYER_UV, 1);
    for (size_t i = 0; i < 2 * PIXELS; i++)
        assert_true(values[i] == 0.0f);
    free(values);
}

static void indices_are_the_ids_of_the_scene(void **state)
{
    (void)state;
    add_sky();
    material_lambert(test.scene, 0.1f);
    const ppm_material_id materials[2] = {material_lambert(test.scene, 0.5f),
                                          material_lambert(test.scene, 0.6f)};
    ppm_instance_id ids[2];
    for (int i = 0; i < 2; i++) {
        ids[i] = layers_add_quad(test.scene, "quad", materials[i], vec3((float)i - 1, -2, 0),
                                 vec3(1, 0, 0), vec3(0, 4, 0));
    }
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    float *objects = layer(PPM_LAYER_OBJECT_INDEX, 3);
    float *indices = layer(PPM_LAYER_MATERIAL_INDEX, 3);
    for (size_t pixel = 0; pixel < PIXELS; pixel++) {
        const int side = pixel % WIDTH >= WIDTH / 2;
        assert_true(objects[pixel] == (float)ids[side]);
        assert_true(indices[pixel] == (float)materials[side]);
    }
    free(objects);
    free(indices);
}

static void alpha_counts_from_a_half_on(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        reopen();
        ppm_material_desc veil;
        ppm_material_desc_init(&veil);
        veil.base_color[3] = i == 0 ? 0.49f : 0.5f;
        veil.alpha_mode = PPM_ALPHA_BLEND;
        add_wall();
        layers_add_quad(test.scene, "veil", material_add(test.scene, &veil), vec3(-9, -9, 1),
                        vec3(18, 0, 0), vec3(0, 18, 0));
        camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
        float *values = layer(PPM_LAYER_DEPTH, 1);
        for (size_t pixel = 0; pixel < PIXELS; pixel++)
            assert_near(values[pixel], i == 0 ? 5.0 : 4.0, 1e-5);
        free(values);
    }
}

/* Far out of focus: mattes are blurred as the picture is, distances are not. */
static void a_lens_blurs_mattes_but_no_depth(void **state)
{
    (void)state;
    add_wall();
    layers_add_quad(test.scene, "near", material_lambert(test.scene, 0.5f), vec3(0, -9, 4),
                    vec3(9, 0, 0), vec3(0, 18, 0));
    camera_perspective(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    ppm_render_options options = layers_options(WIDTH, PPM_LAYER_DEPTH);
    options.layers |= PPM_LAYER_BIT(PPM_LAYER_CRYPTO_OBJECT);
    options.aperture_f_number = 0.1f;
    options.focus_distance_m = 5.0f;
    ppm_render *render = layers_render(test.scene, &options, 64);
    float *depth = layers_read(render, PPM_LAYER_DEPTH, 0);
    float *mattes = layers_read(render, PPM_LAYER_CRYPTO_OBJECT, 0);
    uint32_t blurred = 0;
    for (size_t pixel = 0; pixel < PIXELS; pixel++) {
        assert_near(depth[pixel], pixel % WIDTH < WIDTH / 2 ? 5.0 : 1.0, 1e-5);
        blurred += mattes[4 * pixel + 3] > 0.0f;
    }
    assert_in_range(blurred, PIXELS / 4, PIXELS);
    free(depth);
    free(mattes);
    ppm_render_destroy(render);
}

/* ---- normals --------------------------------------------------------------------------------- */

/* A quad through the middle that leans by 30 degrees about the x axis. */
static ppmi_vec3 add_leaning(ppm_material_id material, bool is_turned)
{
    const float c = cosf(0.5235988f), s = sinf(0.5235988f);
    const ppmi_vec3 right = vec3(8, 0, 0), up = vec3(0, 8 * c, -8 * s);
    const ppmi_vec3 corner = vec3_scale(vec3_add(right, up), -0.5f);
    layers_add_quad(test.scene, "leaning", material, corner, is_turned ? up : right,
                    is_turned ? right : up);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    add_sky();
    return vec3(0, s, c);
}

static void normals_are_of_the_world_and_on_the_side_of_the_eye(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        reopen();
        ppm_material_desc both;
        ppm_material_desc_init(&both);
        both.double_sided = 1;
        const ppmi_vec3 n = add_leaning(material_add(test.scene, &both), i == 1);
        assert_all(PPM_LAYER_NORMAL, n, 1e-6);
    }
}

static void a_mirrored_instance_keeps_its_outside(void **state)
{
    (void)state;
    add_sky();
    const float mirrored[16] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const float c = cosf(0.3f), s = sinf(0.3f);
    ppm_material_desc single;
    ppm_material_desc_init(&single);
    single.double_sided = 0;
    const ppm_mesh_id quad =
        shape_quad(test.scene, material_add(test.scene, &single), vec3(-4 * c, -4, 4 * s),
                   vec3(8 * c, 0, -8 * s), vec3(0, 8, 0));
    shape_place_by(test.scene, quad, mirrored);
    camera_orthographic(test.scene, vec3(0, 0, 9), vec3_splat(0.0f), 1.0f);
    assert_all(PPM_LAYER_NORMAL, vec3(-s, 0, c), 1e-6);
}

static void normals_of_the_camera_look_back_at_it(void **state)
{
    (void)state;
    add_wall();
    /* from the upper right: x runs to the right of the picture, y up, z to the eye */
    camera_orthographic(test.scene, vec3(3, 0, 4), vec3_splat(0.0f), 1.0f);
    ppm_render_options options = layers_options(WIDTH, PPM_LAYER_NORMAL);
    options.normals_of_camera = 1;
    float *values = layers_picture(test.scene, &options, 2, PPM_LAYER_NORMAL);
    for (size_t pixel = 0; pixel < PIXELS; pixel++)
        assert_vector(values + 3 * pixel, vec3(-0.6f, 0, 0.8f), 1e-6);
    free(values);
}

static void normal_maps_count(void **state)
{
    (void)state;
    static const float pixels[3] = {0.8f, 0.5f, 0.9f}; /* (0.6, 0, 0.8) */
    const ppm_image_desc image = {.size = sizeof image,
                                  .role = PPM_IMAGE_DATA,
                                  .pixels = pixels,
                                  .pixel_type = PPM_PIXELS_F32,
                                  .width = 1,
                                  .height = 1,
                                  .channels = 3};
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    assert_int_equal(ppm_scene_add_image(test.scene, &image, &desc.normal_texture.image),
                     PPM_STATUS_OK);
    add_sky();
    layers_add_quad(test.scene, "quad", material_add(test.scene, &desc), vec3(-4, -4, 0),
                    vec3(8, 0, 0), vec3(0, 8, 0));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    assert_all(PPM_LAYER_NORMAL, vec3(0.6f, 0, 0.8f), 1e-6);
}

/* What covers a part of a pixel has a part of the length. */
static void means_are_weighed_by_coverage(void **state)
{
    (void)state;
    add_sky();
    layers_add_quad(test.scene, "part", material_lambert(test.scene, 0.5f), vec3(-4, -4, 0),
                    vec3(4.0625f, 0, 0), vec3(0, 8, 0)); /* 1/4 of column 4 */
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    enum { PASSES = 256 };
    float *normals = layer(PPM_LAYER_NORMAL, PASSES), *albedos = layer(PPM_LAYER_ALBEDO, PASSES);
    const double independent = sqrt(0.25 * 0.75 / PASSES);
    for (size_t row = 0; row < WIDTH; row++) {
        const size_t edge = 3 * (row * WIDTH + 4);
        assert_near(normals[edge + 2], 0.25, independent);
        assert_near(albedos[edge], 0.5 * (double)normals[edge + 2], 1e-5);
        assert_near(normals[edge - 1], 1.0, 1e-6);
    }
    free(normals);
    free(albedos);
}

/* ---- albedo ---------------------------------------------------------------------------------- */

static void assert_albedo(const ppm_material_desc *desc, ppmi_vec3 expected, double tolerance)
{
    reopen();
    add_sky();
    layers_add_quad(test.scene, "quad", material_add(test.scene, desc), vec3(-9, -9, 0),
                    vec3(18, 0, 0), vec3(0, 18, 0));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    assert_all(PPM_LAYER_ALBEDO, expected, tolerance);
}

static void albedo_is_the_share_of_light_that_is_returned(void **state)
{
    (void)state;
    const ppmi_vec3 color = vec3(0.2f, 0.5f, 0.8f);
    ppm_material_desc desc;
    ppm_material_desc_init(&desc);
    vec3_store(desc.base_color, color);
    desc.specular = 0.0f;
    assert_albedo(&desc, color, 1e-6); /* Lambert */
    vec3_store(desc.emission, vec3_splat(100.0f));
    assert_albedo(&desc, color, 1e-6); /* a lamp: that of its surface */
    vec3_store(desc.emission, vec3_splat(0.0f));
    desc.specular = 1.0f;
    desc.metallic = 1.0f;
    desc.roughness = 0.0f;
    assert_albedo(&desc, color, 1e-3); /* a mirror, straight on; the table's error */
    desc.metallic = 0.0f;              /* plastic: 4 % by the coat, the rest of the base */
    assert_albedo(&desc, vec3_lerp(color, vec3_splat(1.0f), 0.04f), 1e-3);
    ppm_material_desc_init(&desc);
    for (int i = 0; i < 3; i++) {
        desc.roughness = 0.5f * (float)i;
        assert_albedo(&desc, vec3_splat(1.0f), 1e-5); /* white plastic, of any roughness */
    }
    desc.transmission = 1.0f;
    desc.ior = 1.5f;
    assert_albedo(&desc, vec3_splat(1.0f), 1e-6); /* clear glass */
}

/* ---- behind mirrors and glass ---------------------------------------------------------------- */

/* The camera looks down into a mirror that leans by 45 degrees and shows a red wall at x = 5. */
static void add_mirror(float roughness)
{
    ppm_material_desc mirror;
    ppm_material_desc_init(&mirror);
    vec3_store(mirror.base_color, vec3(0.8f, 0.5f, 0.25f));
    mirror.metallic = 1.0f;
    mirror.roughness = roughness;
    add_sky();
    layers_add_quad(test.scene, "mirror", material_add(test.scene, &mirror), vec3(-2, 2, -2),
                    vec3(0, 0, 4), vec3(4, -4, 0));
    layers_add_quad(test.scene, "wall", material_lambert_rgb(test.scene, vec3(0.5f, 0.2f, 0.4f)),
                    vec3(5, -9, -9), vec3(0, 0, 18), vec3(0, 18, 0));
    camera_orthographic(test.scene, vec3(0, 8, 0), vec3_splat(0.0f), 1.0f);
}

static void mirrors_show_themselves_or_what_is_in_them(void **state)
{
    (void)state;
    const float half = sqrtf(0.5f);
    add_mirror(0.0f);
    for (uint32_t follows = 0; follows < 2; follows++) {
        ppm_render_options options = layers_options(WIDTH, PPM_LAYER_NORMAL);
        options.layers |= PPM_LAYER_BIT(PPM_LAYER_ALBEDO) | PPM_LAYER_BIT(PPM_LAYER_CRYPTO_OBJECT);
        options.follows_specular = follows;
        ppm_render *render = layers_render(test.scene, &options, 4);
        float *normals = layers_read(render, PPM_LAYER_NORMAL, 0);
        float *albedos = layers_read(render, PPM_LAYER_ALBEDO, 0);
        float *mattes = layers_read(render, PPM_LAYER_CRYPTO_OBJECT, 0);
        const ppmi_vec3 metal = vec3(0.8f, 0.5f, 0.25f), wall = vec3(0.5f, 0.2f, 0.4f);
        /* Schlick at 45 degrees */
        const ppmi_vec3 mirror = vec3_lerp(metal, vec3_splat(1.0f), powf(1.0f - sqrtf(0.5f), 5.0f));
        for (size_t i = 0; i < PIXELS; i++) {
            assert_vector(normals + 3 * i, follows ? vec3(-1, 0, 0) : vec3(half, half, 0), 1e-5);
            assert_vector(albedos + 3 * i, follows ? vec3_mul(mirror, wall) : mirror, 2e-3);
            assert_memory_equal(mattes + 4 * i, mattes, sizeof *mattes);
        }
        free(normals);
        free(albedos);
        free(mattes);
        ppm_render_destroy(render);
    }
}

/* Plastic over a floor: a part is the floor's own base, a part what it mirrors, here the sky, which
 * has no albedo. Means over many passes. */
static void a_share_that_mirrors_is_followed_by_its_share(void **state)
{
    (void)state;
    ppm_material_desc plastic;
    ppm_material_desc_init(&plastic);
    vec3_store(plastic.base_color, vec3(0.2f, 0.5f, 0.8f));
    plastic.roughness = 0.0f;
    add_sky();
    layers_add_quad(test.scene, "floor", material_add(test.scene, &plastic), vec3(-9, -9, 0),
                    vec3(18, 0, 0), vec3(0, 18, 0));
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    ppm_render_options options = layers_options(WIDTH, PPM_LAYER_ALBEDO);
    options.follows_specular = 1;
    float *albedos = layers_picture(test.scene, &options, 64, PPM_LAYER_ALBEDO);
    test_mean means[3] = {{0}};
    for (size_t i = 0; i < 3 * PIXELS; i++)
        mean_add(&means[i % 3], (double)albedos[i]);
    test_family family = {0};
    const double color[3] = {0.2, 0.5, 0.8};
    for (int c = 0; c < 3; c++)
        family_add_mean(&family, &means[c], 0.96 * color[c], 5e-4, "channel %d", c);
    family_check(&family);
    mean_check_power(&means[1], 0.01);
    free(albedos);
}

/* A pane of thin glass before a wall that leans: what goes through is the wall, 2 R / (1 + R) of
 * the light is the sky in the pane. */
static void glass_shows_what_is_behind_it(void **state)
{
    (void)state;
    ppm_material_desc pane;
    ppm_material_desc_init(&pane);
    pane.transmission = 1.0f;
    pane.transmission_kind = PPM_TRANSMISSION_THIN;
    pane.roughness = 0.0f;
    layers_add_quad(test.scene, "pane", material_add(test.scene, &pane), vec3(-9, -9, 4.5f),
                    vec3(18, 0, 0), vec3(0, 18, 0));
    const ppmi_vec3 n = add_leaning(material_lambert(test.scene, 0.5f), false);
    ppm_render_options options = layers_options(WIDTH, PPM_LAYER_NORMAL);
    options.layers |= PPM_LAYER_BIT(PPM_LAYER_ALBEDO);
    options.follows_specular = 1;
    ppm_render *render = layers_render(test.scene, &options, 64);
    float *normals = layers_read(render, PPM_LAYER_NORMAL, 0);
    float *albedos = layers_read(render, PPM_LAYER_ALBEDO, 0);
    test_mean lengths = {0}, albedo = {0};
    for (size_t i = 0; i < PIXELS; i++) {
        const double length = (double)vec3_dot(vec3_load(normals + 3 * i), n);
        assert_vector(normals + 3 * i, vec3_scale(n, (float)length), 1e-5);
        mean_add(&lengths, length);
        mean_add(&albedo, (double)albedos[3 * i]);
    }
    const double through = 1.0 - 2.0 * 0.04 / 1.04;
    test_family family = {0};
    family_add_mean(&family, &lengths, through, 1e-5, "normal");
    family_add_mean(&family, &albedo, 0.5 * through, 1e-5, "albedo");
    family_check(&family);
    free(normals);
    free(albedos);
    ppm_render_destroy(render);
}

/* ---- sessions -------------------------------------------------------------------------------- */

/* Something for every layer to tell: edges, glass, a veil, a texture's worth of triangles, motion,
 * and fog. */
static void add_all_sorts(void)
{
    ppm_material_desc veil;
    ppm_material_desc_init(&veil);
    veil.base_color[3] = 0.4f;
    veil.alpha_mode = PPM_ALPHA_BLEND;
    add_sky();
    layers_add_moving_wall(test.scene, vec3(0, 0, -4), vec3(0.5f, 0, -3));
    const ppm_material_id glass = material_glass(test.scene, 1.5f, 0.0f);
    shape_place_at(test.scene, shape_sphere(test.scene, glass, 0.8f, 8, true), vec3(0.5f, 0, 0));
    layers_add_quad(test.scene, "veil", material_add(test.scene, &veil), vec3(-1.2f, -0.7f, 1),
                    vec3(1.5f, 0.3f, 0), vec3(0, 1.1f, 0));
    scene_fog(test.scene, vec3_splat(0.02f), vec3_splat(0.01f), 0.3f);
    camera_perspective(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 0.5f);
}

static uint64_t all_features(void)
{
    uint64_t layers = 0;
    for (int32_t kind = PPM_LAYER_ALBEDO; kind <= PPM_LAYER_CRYPTO_ASSET; kind++)
        layers |= PPM_LAYER_BIT(kind);
    return layers;
}

static ppm_render_options all_options(int32_t integrator)
{
    ppm_render_options options = render_options(integrator, 20, 1000);
    options.layers = all_features();
    options.follows_specular = 1;
    options.shutter_close = 0.5f;
    options.radius_m = 0.2f;
    return options;
}

/* Every layer of two sessions, of which the second shows a part of the first. */
static void assert_same_layers(const ppm_render_options *one, const ppm_render_options *two,
                               const uint32_t crop[4])
{
    ppm_render *renders[2] = {layers_render(test.scene, one, 3), layers_render(test.scene, two, 3)};
    const uint32_t width = crop[2] - crop[0];
    for (uint32_t i = 0; i < ppm_render_layer_count(renders[0]); i++) {
        ppm_layer_info info = {.size = sizeof info};
        assert_int_equal(ppm_render_get_layer(renders[0], i, &info), PPM_STATUS_OK);
        const size_t channels = info.channel_count, row = channels * 20;
        float whole[4 * 20 * 20], part[4 * 20 * 20];
        assert_int_equal(ppm_render_read_layer(renders[0], i, whole, row * 20), PPM_STATUS_OK);
        assert_int_equal(
            ppm_render_read_layer(renders[1], i, part, channels * width * (crop[3] - crop[1])),
            PPM_STATUS_OK);
        if (info.kind == PPM_LAYER_COMBINED && width != 20) continue; /* has statistics */
        for (uint32_t y = crop[1]; y < crop[3]; y++) {
            assert_memory_equal(whole + y * row + channels * crop[0],
                                part + channels * width * (y - crop[1]),
                                channels * width * sizeof *part);
        }
    }
    ppm_render_destroy(renders[0]);
    ppm_render_destroy(renders[1]);
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    add_all_sorts();
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        const ppm_render_options one = all_options(i);
        ppm_render_options three = one;
        three.threads = 3;
        assert_same_layers(&one, &three, (const uint32_t[4]){0, 0, 20, 20});
    }
}

static void a_crop_shows_what_the_whole_shows(void **state)
{
    (void)state;
    add_all_sorts();
    const uint32_t window[4] = {3, 7, 16, 20};
    const ppm_render_options whole = all_options(PPM_INTEGRATOR_PATH);
    ppm_render_options crop = whole;
    memcpy(crop.crop, window, sizeof window);
    assert_same_layers(&whole, &crop, window);
}

static void layers_do_not_change_the_picture(void **state)
{
    (void)state;
    add_all_sorts();
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        const ppm_render_options with = all_options(i);
        ppm_render_options without = with;
        without.layers = 0;
        float *one = render_picture(test.scene, &with, 3);
        float *two = render_picture(test.scene, &without, 3);
        assert_memory_equal(one, two, 4 * 20 * 20 * sizeof *one);
        free(one);
        free(two);
    }
}

/* Fog is no surface: what is in it counts as if the air was clear. */
static void fog_hides_nothing(void **state)
{
    (void)state;
    add_wall();
    scene_fog(test.scene, vec3_splat(0.5f), vec3_splat(0.5f), 0.0f);
    camera_orthographic(test.scene, vec3(0, 0, 5), vec3_splat(0.0f), 1.0f);
    assert_all(PPM_LAYER_NORMAL, vec3(0, 0, 1), 0.0);
    assert_all(PPM_LAYER_ALBEDO, vec3_splat(0.5f), 1e-6);
}

int main(void)
{
#define WITH_SCENE(f) cmocka_unit_test_setup_teardown(f, open_scene, close_scene)
    const struct CMUnitTest tests[] = {
        WITH_SCENE(depth_is_along_the_axis_of_the_camera),
        WITH_SCENE(nothing_is_far_and_of_no_number),
        WITH_SCENE(positions_are_those_of_the_world),
        WITH_SCENE(uv_is_as_compositors_look_textures_up),
        WITH_SCENE(a_mesh_without_coordinates_has_uv_0),
        WITH_SCENE(indices_are_the_ids_of_the_scene),
        WITH_SCENE(alpha_counts_from_a_half_on),
        WITH_SCENE(a_lens_blurs_mattes_but_no_depth),
        WITH_SCENE(normals_are_of_the_world_and_on_the_side_of_the_eye),
        WITH_SCENE(a_mirrored_instance_keeps_its_outside),
        WITH_SCENE(normals_of_the_camera_look_back_at_it),
        WITH_SCENE(normal_maps_count),
        WITH_SCENE(means_are_weighed_by_coverage),
        WITH_SCENE(albedo_is_the_share_of_light_that_is_returned),
        WITH_SCENE(mirrors_show_themselves_or_what_is_in_them),
        WITH_SCENE(a_share_that_mirrors_is_followed_by_its_share),
        WITH_SCENE(glass_shows_what_is_behind_it),
        WITH_SCENE(threads_do_not_matter),
        WITH_SCENE(a_crop_shows_what_the_whole_shows),
        WITH_SCENE(layers_do_not_change_the_picture),
        WITH_SCENE(fog_hides_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
