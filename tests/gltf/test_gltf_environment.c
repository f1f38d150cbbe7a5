/* importers/gltf/gltf_environment.c: EXT_lights_image_based; importers/gltf/gltf_environment_map.c.
 */
#include <math.h>
#include <stdio.h>

#include "gltf_fixture.h"
#include "ktx2_file.h"
#include "support/near.h"

/* 1 x 1, white; the second with an alpha of a fifth */
#define WHITE                                                                                      \
    "{'uri':'data:;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4//8/"        \
    "AAX+Av4N"                                                                                     \
    "70a4AAAAAElFTkSuQmCC'}"
#define WHITE_FIFTH                                                                                \
    "{'uri':'data:;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGP4//+/"        \
    "MQAJLwMx"                                                                                     \
    "Q43umAAAAABJRU5ErkJggg=='}"

static ppm_status import(gltf_fixture *f, const char *light, const char *images)
{
    return gltf_importf(f,
                        "{'asset':{'version':'2.0'},'nodes':[{}],'images':[%s],"
                        "'scenes':[{'nodes':[0],'extensions':{'EXT_lights_image_based':"
                        "{'light':0}}}],"
                        "'extensions':{'EXT_lights_image_based':{'lights':[%s]}}}",
                        images, light);
}

#define FACES(index)                                                                               \
    "'specularImages':[[" index "," index "," index "," index "," index "," index "]]"

static const float *environment_pixels(const gltf_fixture *f, uint32_t *out_count)
{
    const ppmi_image *image = &f->scene->images[f->scene->environment.image - 1];
    *out_count = image->width * image->height;
    assert_non_null(image->f32);
    return image->f32;
}

static void broken_lights_leave_no_environment_but_a_warning(void **state)
{
    gltf_fixture *f = *state;
    static const char *const lights[] = {
        "{}",
        "7",
        "{'intensity':-1," FACES("0") "}",
        "{'intensity':2}",
        "{'specularImages':[]}",
        "{'specularImages':[[0,0,0]]}",
        "{'specularImages':'all'}",
        "{" FACES("5") "}",
        "{" FACES("'x'") "}",
        "{" FACES("1") "}",
        "{'irradianceCoefficients':[[1,1,1]]}",
        "{'irradianceCoefficients':[1,2,3,4,5,6,7,8,9]}",
    };
    for (size_t i = 0; i < sizeof lights / sizeof lights[0]; ++i) {
        assert_gltf_status(f, import(f, lights[i], WHITE ",{'uri':'absent.png'}"), PPM_STATUS_OK);
        assert_false(f->scene->environment.is_set);
        assert_gltf_logged(f, 'W', "EXT_lights_image_based");
        gltf_reset(f);
    }
}

static void a_cube_becomes_the_environment(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import(f, "{'intensity':3,'rotation':[0,1,0,1]," FACES("0") "}", WHITE),
                       PPM_STATUS_OK);
    assert_true(f->scene->environment.is_set);
    assert_float_equal(f->scene->environment.radiance.y, 3.0f, 0.0f);
    uint32_t count;
    const float *pixels = environment_pixels(f, &count);
    for (uint32_t i = 0; i < 3 * count; ++i)
        assert_near(pixels[i], 1.0, 1e-5);
}

static void png_files_with_alpha_are_packed(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import(f, "{" FACES("0") "}", WHITE_FIFTH), PPM_STATUS_OK);
    uint32_t count;
    assert_near(environment_pixels(f, &count)[0], 5.0, 1e-4);
}

/* A constant radiance of 1 is an irradiance of pi; one that grows towards +X shows there. */
static void harmonics_stand_in_for_missing_images(void **state)
{
    gltf_fixture *f = *state;
    const double e0 = 3.14159265358979 / 0.282095, e1 = 2.0 * 3.14159265358979 / 3.0 / 0.488603;
    char light[1024];
    snprintf(light, sizeof light,
             "{'intensity':2," FACES("1") ",'irradianceCoefficients':[[%g,%g,%g],[0,0,0],[0,0,0],"
                                          "[%g,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]}",
             e0, e0, e0, 0.5 * e1);
    assert_gltf_status(f, import(f, light, WHITE ",{'uri':'absent.png'}"), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "lit by its harmonics");
    assert_float_equal(f->scene->environment.radiance.y, 2.0f, 0.0f);
    const ppmi_image *image = &f->scene->images[f->scene->environment.image - 1];
    const uint32_t row = image->height / 2, plus_x = 3 * image->width / 4;
    const float *at = image->f32 + 3 * (row * image->width + plus_x);
    assert_near(at[0], 1.5, 0.01);
    assert_near(at[1], 1.0, 1e-4);
}

static void scenes_without_one_have_no_environment(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_importf(f, "{'asset':{'version':'2.0'},'nodes':[{}],"
                                       "'scenes':[{'nodes':[0]}],'extensions':"
                                       "{'EXT_lights_image_based':{'lights':[{}]}}}"),
                       PPM_STATUS_OK);
    assert_false(f->scene->environment.is_set);
}

/* ---- KHR_environment_map --------------------------------------------------------------------- */

static unsigned char ktx2[1024];

/* A cube of faces of one pixel in E5B9G9R9, or two pixels a side; written to sub/cube.ktx2. */
static void write_cube(gltf_fixture *f, uint32_t size, uint32_t layers, const void *data)
{
    const ktx2_spec spec = {.format = 123,
                            .width = size,
                            .height = size,
                            .layers = layers,
                            .faces = 6,
                            .data = data,
                            .count = (size_t)24 * size * size * (layers ? layers : 1)};
    gltf_write(f, "sub/cube.ktx2", ktx2, ktx2_make(&spec, ktx2));
}

static ppm_status import_map(gltf_fixture *f, const char *cubemap, const char *map)
{
    return gltf_importf(f,
                        "{'asset':{'version':'2.0'},'nodes':[{}],"
                        "'images':[{'uri':'cube.ktx2','mimeType':'image/ktx2'},"
                        "{'uri':'absent.ktx2'}],"
                        "'scenes':[{'nodes':[0],'extensions':{'KHR_environment_map':"
                        "{'environment_map':0}}}],'extensions':{'KHR_environment_map':"
                        "{'cubemaps':[%s],'environment_maps':[%s]}}}",
                        cubemap, map);
}

/* radiance in E5B9G9R9: 2^(exponent - 24) times the mantissas */
static uint32_t shared_exponent(uint32_t red, uint32_t green, uint32_t blue, uint32_t exponent)
{
    return red | green << 9 | blue << 18 | exponent << 27;
}

static const float *towards(const gltf_fixture *f, double u, double v)
{
    const ppmi_image *image = &f->scene->images[f->scene->environment.image - 1];
    const uint32_t x = (uint32_t)(u * image->width), y = (uint32_t)(v * image->height);
    return image->f32 + 3 * ((size_t)y * image->width + x);
}

static void broken_maps_leave_no_environment_but_a_warning(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *cubemap, *map;
    } cases[] = {
        {"{'source':1}", "{'cubemap':0}"},
        {"{'source':7}", "{'cubemap':0}"},
        {"{}", "{'cubemap':0}"},
        {"{'source':0}", "{'cubemap':4}"},
        {"{'source':0}", "{}"},
        {"{'source':0}", "3"},
        {"{'source':0,'layer':1}", "{'cubemap':0}"},
        {"{'source':0,'intensity':-1}", "{'cubemap':0}"},
        {"{'source':0}", "{'irradianceCoefficients':[[1,2,3]]}"},
    };
    const uint32_t faces[6] = {0};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        write_cube(f, 1, 0, faces);
        assert_gltf_status(f, import_map(f, cases[i].cubemap, cases[i].map), PPM_STATUS_OK);
        assert_false(f->scene->environment.is_set);
        assert_gltf_logged(f, 'W', "KHR_environment_map");
        gltf_reset(f);
    }
}

static void a_ktx2_cube_becomes_the_environment(void **state)
{
    gltf_fixture *f = *state;
    uint32_t faces[6];
    for (uint32_t i = 0; i < 6; ++i)
        faces[i] = shared_exponent(256 + i, 128, 64, 16); /* red 1 + i / 256, green a half */
    write_cube(f, 1, 0, faces);
    assert_gltf_status(f, import_map(f, "{'source':0,'intensity':3}", "{'cubemap':0}"),
                       PPM_STATUS_OK);
    assert_true(f->scene->environment.is_set);
    assert_float_equal(f->scene->environment.radiance.y, 3.0f, 0.0f);
    /* the middle column is -Z, to its right +X; row 0 is up */
    static const struct {
        double u, v;
        int face;
    } looks[] = {{0.751, 0.5, 0}, {0.251, 0.5, 1}, {0.5, 0.01, 2},
                 {0.5, 0.99, 3},  {0.001, 0.5, 4}, {0.501, 0.5, 5}};
    for (int i = 0; i < 6; ++i) {
        const float *at = towards(f, looks[i].u, looks[i].v);
        assert_near(at[0], 1.0 + looks[i].face / 256.0, 1e-5);
        assert_near(at[1], 0.5, 1e-5);
        assert_near(at[2], 0.25, 1e-5);
    }
}

/* Vulkan 1.3, 16.5.4: on the face -Z, s grows towards -X, so that the left column is +X. */
static void faces_lie_as_graphics_interfaces_sample_them(void **state)
{
    gltf_fixture *f = *state;
    uint32_t texels[24] = {0};
    for (int row = 0; row < 2; ++row)
        texels[20 + 2 * row] = shared_exponent(256, 0, 0, 16);
    write_cube(f, 2, 0, texels);
    assert_gltf_status(f, import_map(f, "{'source':0}", "{'cubemap':0}"), PPM_STATUS_OK);
    assert_near(towards(f, 0.6, 0.5)[0], 1.0, 0.15);
    assert_near(towards(f, 0.4, 0.5)[0], 0.0, 0.15);
}

static void layers_are_chosen(void **state)
{
    gltf_fixture *f = *state;
    uint32_t faces[12];
    for (uint32_t i = 0; i < 12; ++i)
        faces[i] = shared_exponent(i < 6 ? 256 : 384, 0, 0, 16);
    write_cube(f, 1, 2, faces);
    assert_gltf_status(f, import_map(f, "{'source':0,'layer':1}", "{'cubemap':0}"), PPM_STATUS_OK);
    assert_near(towards(f, 0.5, 0.5)[0], 1.5, 1e-5);
}

static void what_a_map_has_beyond_its_cube_is_said(void **state)
{
    gltf_fixture *f = *state;
    const uint32_t faces[6] = {0};
    write_cube(f, 1, 0, faces);
    assert_gltf_status(f,
                       import_map(f, "{'source':0}",
                                  "{'cubemap':0,'boundingBoxMin':[-1,-1,-1],"
                                  "'boundingBoxMax':[1,1,1],'ior':1.33}"),
                       PPM_STATUS_OK);
    assert_true(f->scene->environment.is_set);
    assert_gltf_logged(f, 'W', "bounding box is not used");
    assert_gltf_logged(f, 'W', "ior is not used");
}

static void harmonics_stand_in_for_a_missing_cube(void **state)
{
    gltf_fixture *f = *state;
    const double e0 = 3.14159265358979 / 0.282095;
    char map[512];
    snprintf(map, sizeof map,
             "{'cubemap':0,'irradianceFactor':2,'irradianceCoefficients':[[%g,0,%g],[0,0,0],"
             "[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]}",
             e0, 3 * e0);
    assert_gltf_status(f, import_map(f, "{'source':1}", map), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "lit by its harmonics");
    assert_float_equal(f->scene->environment.radiance.y, 2.0f, 0.0f);
    assert_near(towards(f, 0.5, 0.5)[0], 1.0, 1e-4);
    assert_near(towards(f, 0.3, 0.7)[2], 3.0, 1e-4);
}

/* Two scenes, each with surroundings of its own. */
static void the_chosen_scene_brings_its_own_surroundings(void **state)
{
    gltf_fixture *f = *state;
    const uint32_t faces[6] = {0};
    static const struct {
        const char *scene;
        float intensity;
    } cases[] = {{NULL, 3.0f}, {"0", 2.0f}, {"1", 3.0f}, {"2", 5.0f}, {"3", 0.0f}};
    write_cube(f, 1, 0, faces);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        gltf_reset(f);
        f->options.scene = cases[i].scene;
        assert_gltf_status(
            f,
            gltf_importf(f,
                         "{'asset':{'version':'2.0'},'nodes':[{}],'scene':1,"
                         "'images':[%s,{'uri':'cube.ktx2'}],"
                         "'scenes':[{'name':'A','nodes':[0],'extensions':{"
                         "'EXT_lights_image_based':{'light':0}}},"
                         "{'name':'B','nodes':[0],'extensions':{"
                         "'EXT_lights_image_based':{'light':1}}},"
                         "{'name':'C','nodes':[0],'extensions':{'KHR_environment_map':"
                         "{'environment_map':0}}},{'name':'D','nodes':[0]}],"
                         "'extensions':{'EXT_lights_image_based':{'lights':["
                         "{'intensity':2," FACES("0") "},{'intensity':3," FACES(
                             "0") "}]},"
                                  "'KHR_environment_map':{'cubemaps':[{'source':1,'intensity':5}],"
                                  "'environment_maps':[{'cubemap':0}]}}}",
                         WHITE),
            PPM_STATUS_OK);
        assert_int_equal(f->scene->environment.is_set, cases[i].intensity > 0.0f);
        if (cases[i].intensity > 0.0f) {
            assert_float_equal(f->scene->environment.radiance.y, cases[i].intensity, 0.0f);
        }
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(broken_lights_leave_no_environment_but_a_warning),
        TEST(a_cube_becomes_the_environment),
        TEST(png_files_with_alpha_are_packed),
        TEST(harmonics_stand_in_for_missing_images),
        TEST(scenes_without_one_have_no_environment),
        TEST(broken_maps_leave_no_environment_but_a_warning),
        TEST(a_ktx2_cube_becomes_the_environment),
        TEST(faces_lie_as_graphics_interfaces_sample_them),
        TEST(layers_are_chosen),
        TEST(what_a_map_has_beyond_its_cube_is_said),
        TEST(harmonics_stand_in_for_a_missing_cube),
        TEST(the_chosen_scene_brings_its_own_surroundings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
