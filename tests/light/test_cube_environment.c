/* Surroundings given as a cube: which way is which, packed colours, and one light with the constant
 * environment. */
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
static test_world world;

static int open_scene(void **state)
{
    (void)state;
    scene_open(&test);
    add_quad(test.scene, material_lambert(test.scene, 0.5f), vec3(-2, 0, -2), vec3(0, 0, 4),
             vec3(4, 0, 0));
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    scene_close(&test);
    return 0;
}

static ppm_image_id image_u8(uint32_t channels, const uint8_t *pixel)
{
    const ppm_image_desc desc = {.size = sizeof desc,
                                 .role = PPM_IMAGE_COLOR,
                                 .pixels = pixel,
                                 .pixel_type = PPM_PIXELS_U8,
                                 .width = 1,
                                 .height = 1,
                                 .channels = channels};
    ppm_image_id id;
    assert_int_equal(ppm_scene_add_image(test.scene, &desc, &id), PPM_STATUS_OK);
    return id;
}

static ppm_cube_environment_desc cube_of(const ppm_image_id faces[6])
{
    ppm_cube_environment_desc desc = {.size = sizeof desc, .radiance = {1, 1, 1}};
    for (int i = 0; i < 6; i++)
        desc.faces[i] = faces[i];
    return desc;
}

static void set_cube(const ppm_cube_environment_desc *desc)
{
    assert_int_equal(ppm_scene_set_cube_environment(test.scene, desc), PPM_STATUS_OK);
}

/* A face of 8 x 8: red grows to the right, green downwards, blue is the face's number. */
static ppm_image_id ramp_face(int number)
{
    float pixels[8 * 8 * 3];
    for (int i = 0; i < 64; i++) {
        pixels[3 * i] = (float)(i % 8) / 7.0f;
        pixels[3 * i + 1] = (float)(i / 8) / 7.0f;
        pixels[3 * i + 2] = (float)number;
    }
    return image_rgb(test.scene, 8, 8, pixels);
}

static ppmi_vec3 seen(ppmi_vec3 direction)
{
    return ppmi_lights_environment(world.lights, vec3_normalize(direction));
}

static void bad_cubes_are_refused(void **state)
{
    (void)state;
    const uint8_t white[3] = {255, 255, 255};
    const ppm_image_id image = image_u8(3, white);
    const ppm_image_id faces[6] = {image, image, image, image, image, image};
    ppm_cube_environment_desc desc = cube_of(faces);
    desc.faces[3] = 0;
    assert_int_equal(ppm_scene_set_cube_environment(test.scene, &desc),
                     PPM_STATUS_INVALID_ARGUMENT);
    desc.faces[3] = image + 1;
    assert_int_equal(ppm_scene_set_cube_environment(test.scene, &desc),
                     PPM_STATUS_INVALID_ARGUMENT);
    desc = cube_of(faces);
    desc.radiance[1] = -1.0f;
    assert_int_equal(ppm_scene_set_cube_environment(test.scene, &desc),
                     PPM_STATUS_INVALID_ARGUMENT);
    desc = cube_of(faces);
    desc.rotation[0] = NAN;
    assert_int_equal(ppm_scene_set_cube_environment(test.scene, &desc),
                     PPM_STATUS_INVALID_ARGUMENT);
    assert_false(test.scene->environment.is_set);
}

static void mirrored_faces_are_turned_about_their_middle(void **state)
{
    (void)state;
    ppm_image_id images[6];
    for (int i = 0; i < 6; i++)
        images[i] = ramp_face(i);
    ppm_cube_environment_desc desc = cube_of(images);
    desc.is_mirrored = 1;
    set_cube(&desc);
    world_open(&world, &test);
    /* to the right of -Z is +X: three quarters of the way, which is a quarter of the mirrored one
     */
    const ppmi_vec3 color = seen(vec3(0.5f, 0.25f, -1.0f));
    assert_near(color.x, (0.25 * 8 - 0.5) / 7, 0.03);
    assert_near(color.y, (0.375 * 8 - 0.5) / 7, 0.03);
    assert_near(color.z, 5.0, 1e-5);
    world_close(&world);
}

/* Middles, and points right of and below them as one looks from inside, up as the header says. */
static void each_face_lies_where_it_should(void **state)
{
    (void)state;
    static const struct {
        ppmi_vec3 ahead, right, up;
    } faces[6] = {
        {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
        {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {-1, 0, 0}, {0, 0, 1}},
        {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
    };
    ppm_image_id images[6];
    for (int i = 0; i < 6; i++)
        images[i] = ramp_face(i);
    const ppm_cube_environment_desc desc = cube_of(images);
    set_cube(&desc);
    world_open(&world, &test);
    for (int i = 0; i < 6; i++) {
        const ppmi_vec3 cross = vec3_cross(faces[i].ahead, faces[i].up);
        assert_near(vec3_dot(cross, faces[i].right), 1.0, 0.0); /* as an eye sees it */
        const ppmi_vec3 off =
            vec3_mad(vec3_mad(faces[i].ahead, faces[i].right, 0.5f), faces[i].up, 0.25f);
        const ppmi_vec3 color = seen(off);
        /* pixel centres: 8 (1 + x) / 2 - 0.5 of 7 steps; smoothing over the pixels of the image */
        assert_near(color.x, (0.75 * 8 - 0.5) / 7, 0.03);
        assert_near(color.y, (0.375 * 8 - 0.5) / 7, 0.03);
        assert_near(color.z, i, 1e-5);
    }
    world_close(&world);
}

/* A quarter turn about +Y takes what was at -Z to -X. */
static void the_rotation_turns_the_cube(void **state)
{
    (void)state;
    ppm_image_id images[6];
    for (int i = 0; i < 6; i++)
        images[i] = ramp_face(i);
    ppm_cube_environment_desc desc = cube_of(images);
    desc.rotation[1] = desc.rotation[3] = 3.0f; /* any length */
    set_cube(&desc);
    world_open(&world, &test);
    assert_near(seen(vec3(-1, 0, 0)).z, 5.0, 1e-4);
    assert_near(seen(vec3(0, 0, -1)).z, 0.0, 1e-4);
    assert_near(seen(vec3(0, 1, 0)).z, 2.0, 1e-4);
    world_close(&world);
}

static void packed_colours_are_divided_by_their_alpha(void **state)
{
    (void)state;
    const uint8_t packed[4] = {255, 188, 0, 51};
    const ppm_image_id image = image_u8(4, packed);
    const ppm_image_id faces[6] = {image, image, image, image, image, image};
    ppm_cube_environment_desc desc = cube_of(faces);
    desc.is_rgbd = 1;
    desc.radiance[1] = 2.0f;
    set_cube(&desc);
    world_open(&world, &test);
    const ppmi_vec3 color = seen(vec3(0.3f, 0.5f, -0.2f));
    assert_near(color.x, 5.0, 1e-4);
    assert_near(color.y, 10.0 * (double)test.scene->srgb_to_linear[188], 1e-4);
    assert_near(color.z, 0.0, 0.0);
    world_close(&world);
}

/* Under a sky of radiance 1 a Lambert floor sends its reflectance back, whatever brings the sky. */
static void a_constant_cube_lights_as_the_constant_does(void **state)
{
    (void)state;
    const uint8_t white[3] = {255, 255, 255};
    const ppm_image_id image = image_u8(3, white);
    const ppm_image_id faces[6] = {image, image, image, image, image, image};
    const ppm_cube_environment_desc desc = cube_of(faces);
    camera_orthographic(test.scene, vec3(0, 1, 0), vec3_splat(0.0f), 0.2f);
    test_family family = {0};
    for (int32_t i = PPM_INTEGRATOR_SPPM; i <= PPM_INTEGRATOR_PATH; i++) {
        set_cube(&desc);
        ppm_render_options options = render_options(i, 8, 2000);
        options.radius_m = 0.05f;
        const test_mean mean = render_green(test.scene, &options, 8, 8);
        family_add_mean(&family, &mean, 0.5, 1e-3, "integrator %d", (int)i);
        close_scene(NULL);
        open_scene(NULL);
        camera_orthographic(test.scene, vec3(0, 1, 0), vec3_splat(0.0f), 0.2f);
        image_u8(3, white);
    }
    family_check(&family);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, open_scene, close_scene)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(bad_cubes_are_refused),
        CASE(each_face_lies_where_it_should),
        CASE(mirrored_faces_are_turned_about_their_middle),
        CASE(the_rotation_turns_the_cube),
        CASE(packed_colours_are_divided_by_their_alpha),
        CASE(a_constant_cube_lights_as_the_constant_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
