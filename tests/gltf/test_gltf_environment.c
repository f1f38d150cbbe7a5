/* importers/gltf/gltf_environment.c: EXT_lights_image_based. */
#include <math.h>
#include <stdio.h>

#include "gltf_fixture.h"
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

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(broken_lights_leave_no_environment_but_a_warning),
        TEST(a_cube_becomes_the_environment),
        TEST(png_files_with_alpha_are_packed),
        TEST(harmonics_stand_in_for_missing_images),
        TEST(scenes_without_one_have_no_environment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
