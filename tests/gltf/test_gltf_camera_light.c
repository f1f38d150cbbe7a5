/* importers/gltf/gltf_camera.c, gltf_light.c: cameras and punctual lights. */
#include <math.h>
#include <stdio.h>

#include "gltf_fixture.h"

#define PI 3.14159265358979323846f

/* Documents of nodes, and of cameras or lights. */
static ppm_status import_cameras(gltf_fixture *f, const char *nodes, const char *cameras)
{
    return gltf_importf(f, "{'asset':{'version':'2.0'},'nodes':[%s],'cameras':[%s]}", nodes,
                        cameras);
}

static ppm_status import_lights(gltf_fixture *f, const char *generator, const char *nodes,
                                const char *lights)
{
    return gltf_importf(f,
                        "{'asset':{'version':'2.0','generator':'%s'},"
                        "'extensionsUsed':['KHR_lights_punctual'],'nodes':[%s],"
                        "'extensions':{'KHR_lights_punctual':{'lights':[%s]}}}",
                        generator, nodes, lights);
}

#define LIGHT(index) "'extensions':{'KHR_lights_punctual':{'light':" index "}}"

static void perspective_cameras_are_read(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        import_cameras(f,
                       "{'camera':0,'name':'node','translation':[1,2,3]},{'camera':1,'name':'n'}",
                       "{'type':'perspective','name':'main','perspective':"
                       "{'yfov':0.5,'znear':0.1,'aspectRatio':1.5}},"
                       "{'type':'perspective','perspective':{'yfov':1,'znear':0.1}}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->camera_count, 2);
    const ppmi_camera *camera = f->scene->cameras;
    assert_string_equal(camera[0].name, "main");
    assert_float_equal(camera[0].y_fov_rad, 0.5f, 1e-7f);
    assert_float_equal(camera[0].aspect, 1.5f, 0.0f);
    assert_float_equal(camera[0].origin.y, 2.0f, 0.0f);
    assert_float_equal(camera[0].forward.z, -1.0f, 1e-6f);
    assert_string_equal(camera[1].name, "n");
    assert_float_equal(camera[1].aspect, 0.0f, 0.0f);
}

static void a_shift_comes_from_the_extras_of_a_camera(void **state)
{
    gltf_fixture *f = *state;
    static const char camera[] =
        "{'type':'perspective','extras':{'ppm_shift':%s},'perspective':{'yfov':1,'znear':1}}";
    static const char *const unusable[] = {"7", "[1]", "['a','b']", "[1,1e9]"};
    char text[256];
    for (size_t i = 0; i < sizeof unusable / sizeof unusable[0]; ++i) {
        snprintf(text, sizeof text, camera, unusable[i]);
        assert_gltf_status(f, import_cameras(f, "{'camera':0}", text), PPM_STATUS_OK);
        assert_int_equal(f->scene->camera_count, 1);
        assert_float_equal(f->scene->cameras[0].shift[0], 0.0f, 0.0f);
        if (i == 3) assert_gltf_logged(f, 'W', "extras.ppm_shift [1, 1e+09] left out");
        gltf_reset(f);
    }
    snprintf(text, sizeof text, camera, "[0.25,-0.5]");
    assert_gltf_status(f, import_cameras(f, "{'camera':0}", text), PPM_STATUS_OK);
    assert_float_equal(f->scene->cameras[0].shift[0], 0.25f, 0.0f);
    assert_float_equal(f->scene->cameras[0].shift[1], -0.5f, 0.0f);
}

static void orthographic_cameras_show_twice_their_magnification(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       import_cameras(f, "{'camera':0}",
                                      "{'type':'orthographic','orthographic':"
                                      "{'xmag':3,'ymag':-2,'znear':0,'zfar':9}}"),
                       PPM_STATUS_OK);
    assert_int_equal(f->scene->cameras[0].kind, PPM_CAMERA_ORTHOGRAPHIC);
    assert_float_equal(f->scene->cameras[0].half_width_m, 3.0f, 0.0f);
    assert_float_equal(f->scene->cameras[0].half_height_m, 2.0f, 0.0f);
}

static void invalid_cameras_are_left_out_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    static const char *const cameras[] = {
        "{'type':'perspective','perspective':{'yfov':0,'znear':1}}",
        "{'type':'perspective','perspective':{'yfov':4,'znear':1}}",
        "{'type':'perspective','perspective':{'znear':1}}",
        "{'type':'perspective'}",
        "{'type':'orthographic','perspective':{'yfov':1,'znear':1}}",
        "{'type':'orthographic','orthographic':{'xmag':0,'ymag':1,'znear':0,'zfar':1}}",
        "{'type':'fisheye'}",
        "7",
    };
    for (size_t i = 0; i < sizeof cameras / sizeof cameras[0]; ++i) {
        assert_gltf_status(f, import_cameras(f, "{'camera':0}", cameras[i]), PPM_STATUS_OK);
        assert_int_equal(f->scene->camera_count, 0);
        assert_gltf_logged(f, 'W', "nodes[0].camera: left out");
        gltf_reset(f);
    }
    assert_gltf_status(f, import_cameras(f, "{'camera':3}", ""), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "cameras[3] does not exist");
}

static void a_node_of_no_size_has_no_camera(void **state)
{
    gltf_fixture *f = *state;
    static const char camera[] = "{'type':'perspective','perspective':{'yfov':1,'znear':1}}";
    assert_gltf_status(f, import_cameras(f, "{'camera':0,'scale':[0,0,0]}", camera), PPM_STATUS_OK);
    assert_int_equal(f->scene->camera_count, 0);
    gltf_reset(f); /* but scale as such is no harm */
    assert_gltf_status(f, import_cameras(f, "{'camera':0,'scale':[1e-25,1e-25,1e-25]}", camera),
                       PPM_STATUS_OK);
    assert_int_equal(f->scene->camera_count, 1);
}

static void lights_have_the_defaults_of_the_extension(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        import_lights(f, "x", "{" LIGHT("0") ",'name':'lamp'},{" LIGHT("1") "},{" LIGHT("2") "}",
                      "{'type':'point'},{'type':'spot','spot':{}},"
                      "{'type':'directional','name':'sun','color':[1,0.5,0],"
                      "'intensity':4}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->punctual_count, 3);
    const ppmi_punctual *light = f->scene->punctuals;
    assert_string_equal(light[0].name, "lamp");
    assert_int_equal(light[0].kind, PPM_LIGHT_POINT);
    assert_float_equal(light[0].intensity.y, 1.0f, 0.0f);
    assert_int_equal(light[1].kind, PPM_LIGHT_SPOT);
    assert_float_equal(light[1].cos_inner, 1.0f, 0.0f);
    assert_float_equal(light[1].cos_outer, cosf(PI / 4), 1e-6f);
    assert_string_equal(light[2].name, "sun");
    assert_float_equal(light[2].intensity.y, 2.0f, 0.0f);
    assert_float_equal(light[2].direction.z, -1.0f, 1e-6f);
}

/* The intensities of a point light of 683 and a sun of 683. */
static void check_units(gltf_fixture *f, const char *generator, int32_t option, float point,
                        float sun, const char *message)
{
    f->options.light_units = option;
    gltf_reset(f);
    assert_gltf_status(f,
                       import_lights(f, generator, "{" LIGHT("0") "},{" LIGHT("1") "}",
                                     "{'type':'point','intensity':683},"
                                     "{'type':'directional','intensity':683}"),
                       PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].intensity.x, point, 1e-4f * point);
    assert_float_equal(f->scene->punctuals[1].intensity.x, sun, 1e-4f * sun);
    assert_gltf_logged(f, 'I', message);
    assert_gltf_logged(f, 'I', "--light-units");
}

static void light_units_follow_generator_and_option(void **state)
{
    gltf_fixture *f = *state;
    static const char blender[] = "Khronos glTF Blender I/O v3.4.50";
    check_units(f, "other", PPM_LIGHT_UNITS_AUTO, 683.0f, 683.0f, "as written");
    check_units(f, blender, PPM_LIGHT_UNITS_AUTO, 1.0f, 1.0f, "683 lm/W");
    check_units(f, blender, PPM_LIGHT_UNITS_GLTF, 683.0f, 683.0f, "as written");
    check_units(f, "other", PPM_LIGHT_UNITS_BLENDER, 1.0f, 1.0f, "683 lm/W");
    check_units(f, blender, PPM_LIGHT_UNITS_RAW, 683.0f / (4 * PI), 683.0f, "watts");
}

static void light_units_are_not_mentioned_without_lights(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_lights(f, "x", "{}", "{'type':'point'}"), PPM_STATUS_OK);
    assert_false(gltf_logged(f, 'I', "--light-units"));
}

static void a_spot_of_blend_0_and_one_of_180_degrees_are_read(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        import_lights(
            f, "x", "{" LIGHT("0") "}",
            "{'type':'spot','spot':{'innerConeAngle':1.5707964,'outerConeAngle':1.5707964}}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->punctual_count, 1);
    assert_float_equal(f->scene->punctuals[0].cos_outer, 0.0f, 1e-6f);
}

static void invalid_lights_are_left_out_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    static const char *const lights[] = {
        "{'type':'area'}",
        "{'type':'spot'}",
        "{}",
        "{'type':'point','intensity':-1}",
        "{'type':'point','color':[-1,0,0]}",
        "{'type':'spot','spot':{'outerConeAngle':2}}",
        "{'type':'spot','spot':{'innerConeAngle':0.5,'outerConeAngle':0.4}}",
        "'point'",
    };
    for (size_t i = 0; i < sizeof lights / sizeof lights[0]; ++i) {
        assert_gltf_status(f, import_lights(f, "x", "{" LIGHT("0") "}", lights[i]), PPM_STATUS_OK);
        assert_int_equal(f->scene->punctual_count, 0);
        assert_gltf_logged(f, 'W', "nodes[0].extensions.KHR_lights_punctual.light: left out");
        gltf_reset(f);
    }
}

/* The proposal's lens of 35 mm at 2.8 on 36 x 24 mm, and the same lens in front of a sensor of half
 * the size whose picture is the same: both are 12.5 mm wide. */
static void a_physical_camera_has_a_lens(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *lens;
        double diameter_m; /* 0: a pinhole */
        float focus_m;
    } cases[] = {
        {"'focalLength':0.035,'sensorSize':[0.036,0.024],'fStop':2.8,'focusDistance':5", 0.0125, 5},
        {"'focalLength':0.0175,'sensorSize':[0.018,0.012],'fStop':2.8,'focusDistance':2", 0.00625,
         2},
        {"'focalLength':0.035,'sensorSize':[0.036,0.024],'fStop':1", 0.035, 0},
        {"'focalLength':0.035,'sensorSize':[0.036,0.024],'focusDistance':5", 0, 0},
        {"'focalLength':0.035,'sensorSize':[0.036,0.024],'fStop':-1", 0, 0},
        {"'focalLength':0,'sensorSize':[0.036,0.024],'fStop':2", 0, 0},
        {"'focalLength':0.035,'fStop':2", 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char camera[400];
        snprintf(
            camera, sizeof camera,
            "{'type':'perspective','perspective':{'yfov':0.66059,'aspectRatio':1.5,'znear':0.01},"
            "'extensions':{'EXT_camera_physical':{%s}}}",
            cases[i].lens);
        assert_gltf_status(f, import_cameras(f, "{'camera':0}", camera), PPM_STATUS_OK);
        const ppmi_camera *c = &f->scene->cameras[0];
        const double focal_36_m = 0.018 / (1.5 * tan(0.5 * 0.66059));
        if (cases[i].diameter_m == 0.0) {
            assert_float_equal(c->f_number, 0.0f, 0.0f);
        } else {
            assert_float_equal((float)(focal_36_m / (double)c->f_number),
                               (float)cases[i].diameter_m, 1e-6f);
            assert_float_equal(c->focus_distance_m, cases[i].focus_m, 0.0f);
        }
        if (i > 3) assert_gltf_logged(f, 'W', "nodes[0].camera: EXT_camera_physical left out");
        gltf_reset(f);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

static void cameras_clip_by_znear_and_zfar_unless_they_are_told_not_to(void **state)
{
    gltf_fixture *f = *state;
    static const char cameras[] =
        "{'type':'perspective','perspective':{'yfov':1,'znear':2,'zfar':50}},"
        "{'type':'perspective','perspective':{'yfov':1,'znear':0.5}},"
        "{'type':'orthographic','orthographic':{'xmag':3,'ymag':2,'znear':0,'zfar':9}},"
        "{'type':'perspective','perspective':{'yfov':1,'znear':5,'zfar':4}}";
    static const char nodes[] = "{'camera':0},{'camera':1},{'camera':2},{'camera':3}";
    for (int i = 0; i < 2; ++i) {
        f->options.no_clip = i == 1;
        assert_gltf_status(f, import_cameras(f, nodes, cameras), PPM_STATUS_OK);
        assert_int_equal(f->scene->camera_count, 4);
        const ppmi_camera *c = f->scene->cameras;
        assert_float_equal((double)c[0].near_m, i == 0 ? 2.0 : 0.0, 0.0);
        assert_float_equal((double)c[0].far_m, i == 0 ? 50.0 : 0.0, 0.0);
        assert_float_equal((double)c[1].near_m, i == 0 ? 0.5 : 0.0, 0.0);
        assert_float_equal((double)c[1].far_m, 0.0, 0.0);
        assert_float_equal((double)c[2].far_m, i == 0 ? 9.0 : 0.0, 0.0);
        assert_float_equal((double)c[3].near_m, 0.0, 0.0);
        assert_int_equal(gltf_logged(f, 'W', "znear 5 and zfar 4 left out"), i == 0);
        gltf_reset(f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_physical_camera_has_a_lens),
        TEST(perspective_cameras_are_read),
        TEST(a_shift_comes_from_the_extras_of_a_camera),
        TEST(orthographic_cameras_show_twice_their_magnification),
        TEST(invalid_cameras_are_left_out_with_a_warning),
        TEST(cameras_clip_by_znear_and_zfar_unless_they_are_told_not_to),
        TEST(a_node_of_no_size_has_no_camera),
        TEST(lights_have_the_defaults_of_the_extension),
        TEST(light_units_follow_generator_and_option),
        TEST(light_units_are_not_mentioned_without_lights),
        TEST(a_spot_of_blend_0_and_one_of_180_degrees_are_read),
        TEST(invalid_lights_are_left_out_with_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
