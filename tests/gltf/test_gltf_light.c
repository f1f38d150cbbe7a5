/* importers/gltf/gltf_light.c, gltf_area.c, gltf_blend.c, gltf_ies.c: lights with an extent, or a
 * profile. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf_fixture.h"
#include "light/punctual.h"

#define PI 3.14159265358979323846f

static const char blender[] = "Khronos glTF Blender I/O v3.4.50";

/* A document of nodes, with a root "extensions" object's inside. */
static ppm_status import(gltf_fixture *f, const char *generator, const char *nodes,
                         const char *extensions)
{
    return gltf_importf(f,
                        "{'asset':{'version':'2.0','generator':'%s'},'nodes':[%s],"
                        "'extensions':{%s}}",
                        generator, nodes, extensions);
}

static ppm_status import_area(gltf_fixture *f, const char *node, const char *light)
{
    char nodes[1024], lights[1024];
    snprintf(nodes, sizeof nodes, "{'extensions':{'EXT_lights_area':{'light':0}}%s}", node);
    snprintf(lights, sizeof lights, "'EXT_lights_area':{'lights':[%s]}", light);
    return import(f, "x", nodes, lights);
}

static ppm_status import_extras(gltf_fixture *f, const char *generator, const char *extras)
{
    char node[1024];
    snprintf(node, sizeof node, "{'name':'Area','scale':[2,3,1],'extras':%s}", extras);
    return import(f, generator, node, "");
}

#define PUNCTUAL(light) "'KHR_lights_punctual':{'lights':[" light "]}"
#define NODE(extras) "{'extensions':{'KHR_lights_punctual':{'light':0}}" extras "}"

/* ---- extras of punctual lights --------------------------------------------------------------- */

static void a_radius_comes_from_the_light_or_else_its_node(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       import(f, "x", NODE(",'extras':{'ppm_radius':0.25,'ppm_visible':true}"),
                              PUNCTUAL("{'type':'point','extras':{'ppm_radius':0.125}}")),
                       PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].radius_m, 0.125f, 0.0f);
    assert_false(f->scene->punctuals[0].is_hidden);
    gltf_reset(f);
    assert_gltf_status(f,
                       import(f, "x", NODE(",'scale':[9,9,9],'extras':{'ppm_radius':0.25}"),
                              PUNCTUAL("{'type':'spot','spot':{}}")),
                       PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].radius_m, 0.25f, 0.0f);
    assert_true(f->scene->punctuals[0].is_hidden);
}

static void an_angle_is_the_diameter_of_a_sun(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       import(f, "x", NODE(",'extras':{'ppm_angle':0.01,'ppm_radius':3}"),
                              PUNCTUAL("{'type':'directional'}")),
                       PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].angular_radius_rad, 0.005f, 1e-9f);
    assert_float_equal(f->scene->punctuals[0].radius_m, 0.0f, 0.0f);
}

/* Both values by Blender 3.4: an angle of 1.2 rad and a blend of 0.5, 0.45 rad from the axis. */
static void a_blend_gives_a_spot_the_falloff_of_blender(void **state)
{
    gltf_fixture *f = *state;
    static const char spot[] =
        PUNCTUAL("{'type':'spot','spot':{'innerConeAngle':0.3,'outerConeAngle':0.6},"
                 "'extras':{'ppm_blend':0.5}}");
    assert_gltf_status(f, import(f, "x", NODE("") "," NODE(""), spot), PPM_STATUS_OK);
    assert_int_equal(f->scene->punctual_count, 2);
    assert_int_equal(f->scene->profile_count, 1);
    const ppmi_punctual *light = &f->scene->punctuals[1];
    const ppmi_vec3 ahead = light->direction;
    const ppmi_vec3 aside = vec3_mad(vec3_scale(ahead, cosf(0.45f)), light->right, sinf(0.45f));
    const ppmi_vec3 beyond = vec3_mad(vec3_scale(ahead, cosf(0.61f)), light->up, sinf(0.61f));
    assert_float_equal(ppmi_punctual_intensity(f->scene, light, ahead).y, 1.0f, 1e-5f);
    assert_float_equal(ppmi_punctual_intensity(f->scene, light, aside).y, 0.85f, 0.005f);
    assert_float_equal(ppmi_punctual_intensity(f->scene, light, beyond).y, 0.0f, 0.0f);
}

static void a_blend_out_of_range_leaves_the_spot_as_it_is(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       import(f, "x", NODE(",'extras':{'ppm_blend':1.5}"),
                              PUNCTUAL("{'type':'spot','spot':{'innerConeAngle':0.3}}")),
                       PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "extras.ppm_blend 1.5 left out");
    assert_float_equal(f->scene->punctuals[0].cos_inner, cosf(0.3f), 1e-6f);
    assert_int_equal(f->scene->profile_count, 0);
}

static void extras_of_any_form_do_no_harm(void **state)
{
    gltf_fixture *f = *state;
    static const char *const extras[] = {
        "7",
        "[1,2]",
        "'text'",
        "null",
        "{}",
        "{'ppm_radius':'wide'}",
        "{'ppm_radius':-3}",
        "{'ppm_radius':1e30}",
        "{'ppm_radius':[1],'ppm_visible':'yes','ppm_area':3}",
    };
    for (size_t i = 0; i < sizeof extras / sizeof extras[0]; ++i) {
        char node[256], light[256];
        snprintf(node, sizeof node, NODE(",'extras':%s"), extras[i]);
        snprintf(light, sizeof light, PUNCTUAL("{'type':'point','extras':%s}"), extras[i]);
        assert_gltf_status(f, import(f, "x", node, light), PPM_STATUS_OK);
        assert_int_equal(f->scene->punctual_count, 1);
        assert_float_equal(f->scene->punctuals[0].radius_m, 0.0f, 0.0f);
        gltf_reset(f);
    }
    assert_gltf_status(
        f, import(f, "x", NODE(",'extras':{'ppm_angle':3.2}"), PUNCTUAL("{'type':'directional'}")),
        PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "extras.ppm_angle 3.2 left out");
}

static void a_range_is_said_not_to_be_used_once(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f, import(f, "x", NODE("") "," NODE(""), PUNCTUAL("{'type':'point','range':2}")),
        PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "ignored: light ranges: 1 light: light falls off");
}

/* ---- EXT_lights_area ------------------------------------------------------------------------- */

static void area_lights_have_the_defaults_of_the_extension(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_area(f, "", "{'type':'rect','rect':{}}"), PPM_STATUS_OK);
    const ppmi_punctual *light = f->scene->punctuals;
    assert_int_equal(f->scene->punctual_count, 1);
    assert_int_equal(light->kind, PPM_LIGHT_RECTANGLE);
    assert_float_equal(light->half_width_m, 0.5f, 0.0f);
    assert_float_equal(light->half_height_m, 0.5f, 0.0f);
    assert_float_equal(light->intensity.y, 1000.0f, 0.0f);
    assert_float_equal(light->direction.z, -1.0f, 1e-6f);
    assert_true(light->is_hidden);
}

static void area_lights_scale_by_the_largest_component(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       import_area(f, ",'scale':[1,-4,2],'extras':{'ppm_visible':1}",
                                   "{'type':'rect','size':0.5,'rect':{'aspect':3},'intensity':20,"
                                   "'color':[1,0.5,0]}"),
                       PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].half_width_m, 3.0f, 1e-6f);
    assert_float_equal(f->scene->punctuals[0].half_height_m, 1.0f, 1e-6f);
    assert_float_equal(f->scene->punctuals[0].intensity.y, 10.0f, 1e-6f);
    assert_false(f->scene->punctuals[0].is_hidden);
    gltf_reset(f);
    assert_gltf_status(f, import_area(f, "", "{'type':'disk','size':3}"), PPM_STATUS_OK);
    assert_int_equal(f->scene->punctuals[0].kind, PPM_LIGHT_DISK);
    assert_float_equal(f->scene->punctuals[0].half_width_m, 1.5f, 1e-6f);
}

static void invalid_area_lights_are_left_out_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    static const char *const lights[] = {
        "{}",
        "{'type':'sphere'}",
        "{'type':'rect','size':0}",
        "{'type':'rect','size':-1}",
        "{'type':'disk','size':1e20}",
        "{'type':'rect','rect':{'aspect':0}}",
        "{'type':'rect','intensity':-1}",
        "{'type':'disk','color':[1,-1,1]}",
        "4",
    };
    for (size_t i = 0; i < sizeof lights / sizeof lights[0]; ++i) {
        assert_gltf_status(f, import_area(f, "", lights[i]), PPM_STATUS_OK);
        assert_int_equal(f->scene->punctual_count, 0);
        assert_gltf_logged(f, 'W', "nodes[0].extensions.EXT_lights_area.light: left out");
        gltf_reset(f);
    }
}

/* It is off: the surroundings of files without a light would be wrong, and another frame may have
 * another scale. */
static void lights_that_are_scaled_to_nothing_are_told_and_dark(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_area(f, ",'scale':[0,0,0]", "{'type':'disk'}"), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "nodes[0].extensions.EXT_lights_area.light: left out: its size");
    assert_int_equal(f->scene->punctual_count, 1);
    assert_float_equal(vec3_max_component(f->scene->punctuals[0].intensity), 0.0f, 0.0f);
    assert_true(ppmi_scene_has_light(f->scene));
    for (int i = 0; i < 2; ++i) {
        gltf_reset(f);
        assert_gltf_status(
            f,
            gltf_importf(f,
                         "{" GLTF_HEAD "'nodes':[{'children':[1],'scale':[%d,0,0]},"
                         "{'mesh':0,'extensions':{'KHR_lights_punctual':{'light':0}}}],"
                         "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'%s','spot':{}}]}}"
                         "," GLTF_TRIANGLE "}",
                         i, i == 0 ? "directional" : "spot"),
            PPM_STATUS_OK);
        assert_gltf_logged(f, 'W',
                           "nodes[1].extensions.KHR_lights_punctual.light: left out: "
                           "lights[0]: zero scale");
        assert_int_equal(f->scene->punctual_count, 1);
        assert_float_equal(vec3_max_component(f->scene->punctuals[0].intensity), 0.0f, 0.0f);
    }
}

/* ---- extras.ppm_area ------------------------------------------------------------------------- */

static void area_extras_are_scaled_with_their_node(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       import_extras(f, "x",
                                     "{'ppm_area':{'shape':'ellipse','size':[1,2],'radiance':5,"
                                     "'color':[1,0.5,0]},'ppm_visible':1}"),
                       PPM_STATUS_OK);
    const ppmi_punctual *light = f->scene->punctuals;
    assert_int_equal(f->scene->punctual_count, 1);
    assert_string_equal(light->name, "Area");
    assert_int_equal(light->kind, PPM_LIGHT_DISK);
    assert_float_equal(light->half_width_m, 1.0f, 1e-6f);
    assert_float_equal(light->half_height_m, 3.0f, 1e-6f);
    assert_float_equal(light->intensity.y, 2.5f, 1e-6f);
    assert_false(light->is_hidden);
}

/* P / (pi A): in watts beside Blender's lamps, in lumens where those are read as lumens. */
static void power_is_spread_over_the_area(void **state)
{
    gltf_fixture *f = *state;
    static const char area[] = "{'ppm_area':{'shape':'square','size':0.5,'power_w':30}}";
    const float exact = 30.0f / (PI * 1.0f * 1.5f);
    assert_gltf_status(f, import_extras(f, blender, area), PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].intensity.x, exact, 1e-5f);
    gltf_reset(f);
    f->options.light_units = PPM_LIGHT_UNITS_GLTF;
    assert_gltf_status(f, import_extras(f, blender, area), PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].intensity.x, 683.0f * exact, 1e-2f);
}

static void invalid_area_extras_are_left_out_with_a_warning(void **state)
{
    gltf_fixture *f = *state;
    static const char *const areas[] = {
        "{'shape':'star','size':1,'radiance':1}",
        "{'shape':7,'size':1,'radiance':1}",
        "{'shape':'rect','radiance':1}",
        "{'shape':'rect','size':[1,0],'radiance':1}",
        "{'shape':'rect','size':[1,2,3],'radiance':1}",
        "{'shape':'rect','size':1}",
        "{'shape':'rect','size':1,'radiance':1,'power_w':1}",
        "{'shape':'rect','size':1,'radiance':-1}",
        "{'shape':'rect','size':1,'power_w':1e300}",
        "{'shape':'rect','size':1e-300,'power_w':1}",
    };
    for (size_t i = 0; i < sizeof areas / sizeof areas[0]; ++i) {
        char extras[256];
        snprintf(extras, sizeof extras, "{'ppm_area':%s}", areas[i]);
        assert_gltf_status(f, import_extras(f, "x", extras), PPM_STATUS_OK);
        assert_int_equal(f->scene->punctual_count, 0);
        assert_gltf_logged(f, 'W', "nodes[0].extras.ppm_area");
        gltf_reset(f);
    }
}

/* ---- EXT_lights_ies -------------------------------------------------------------------------- */

#define IES_HEAD "IESNA:LM-63-2002\n[TEST] x\nTILT=NONE\n"

static ppm_status import_ies(gltf_fixture *f, const char *generator, const char *node,
                             const char *profile)
{
    char nodes[512], lights[4096];
    snprintf(nodes, sizeof nodes, "{'extensions':{'EXT_lights_ies':{'light':0%s}}}", node);
    snprintf(lights, sizeof lights, "'EXT_lights_ies':{'lights':[%s]}", profile);
    return import(f, generator, nodes, lights);
}

static void a_profile_comes_from_a_file_beside_the_asset(void **state)
{
    gltf_fixture *f = *state;
    static const char ies[] = IES_HEAD "1 -1 2 3 1 1 2 0 0 0 1 1 50\n0 45 90\n0\n10 5 0\n";
    gltf_write(f, "sub/lamp.ies", ies, sizeof ies - 1);
    assert_gltf_status(
        f, import_ies(f, "x", ",'multiplier':3,'color':[1,2,0.5]", "{'uri':'lamp.ies','name':'L'}"),
        PPM_STATUS_OK);
    assert_int_equal(f->scene->punctual_count, 1);
    assert_int_equal(f->scene->profile_count, 1);
    const ppmi_punctual *light = f->scene->punctuals;
    assert_string_equal(light->name, "L");
    assert_int_equal(light->profile, 1);
    assert_float_equal(light->intensity.x, 3.0f, 0.0f);
    assert_float_equal(light->intensity.y, 3.0f, 0.0f); /* clamped */
    assert_float_equal(light->intensity.z, 1.5f, 0.0f);
    assert_float_equal(f->scene->profiles[0].candela[0], 20.0f, 1e-5f);
    /* beside lamps that are divided by 683 lm/W, measured candela are too */
    gltf_reset(f);
    gltf_write(f, "sub/lamp.ies", ies, sizeof ies - 1);
    assert_gltf_status(f, import_ies(f, blender, "", "{'uri':'lamp.ies'}"), PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].intensity.x, 1.0f / 683.0f, 1e-9f);
}

static void a_profile_is_read_once_for_all_its_lights(void **state)
{
    gltf_fixture *f = *state;
    static const char ies[] = IES_HEAD "1 -1 1 2 1 1 2 0 0 0 1 1 50\n0 90\n0\n10 5\n";
    char profile[1024];
    snprintf(profile, sizeof profile, "'EXT_lights_ies':{'lights':[{'uri':'%s'}]}",
             gltf_data_uri(ies, sizeof ies - 1));
    assert_gltf_status(f,
                       import(f, "x",
                              "{'extensions':{'EXT_lights_ies':{'light':0}}},"
                              "{'extensions':{'EXT_lights_ies':{'light':0}}}",
                              profile),
                       PPM_STATUS_OK);
    assert_int_equal(f->scene->punctual_count, 2);
    assert_int_equal(f->scene->profile_count, 1);
}

static void a_profile_comes_from_a_buffer_view(void **state)
{
    gltf_fixture *f = *state;
    static const char ies[] = IES_HEAD "1 -1 1 2 1 1 2 0 0 0 1 1 50\n0 90\n0\n10 5\n";
    assert_gltf_status(f,
                       gltf_importf(f,
                                    "{'asset':{'version':'2.0'},"
                                    "'nodes':[{'extensions':{'EXT_lights_ies':{'light':0}}}],"
                                    "'extensions':{'EXT_lights_ies':{'lights':[{'bufferView':0,"
                                    "'mimeType':'application/x-ies-lm-63'}]}},"
                                    "'bufferViews':[{'buffer':0,'byteLength':%d}],"
                                    "'buffers':[{'byteLength':%d,'uri':'%s'}]}",
                                    (int)sizeof ies - 1, (int)sizeof ies - 1,
                                    gltf_data_uri(ies, sizeof ies - 1)),
                       PPM_STATUS_OK);
    assert_int_equal(f->scene->profile_count, 1);
}

static void without_its_profile_a_light_shines_evenly_and_a_warning_says_so(void **state)
{
    gltf_fixture *f = *state;
    static const char *const profiles[] = {
        "{'uri':'missing.ies'}",     "{'uri':'../outside.ies'}",
        "{'uri':'/etc/passwd'}",     "{'uri':'http://host/a.ies'}",
        "{'uri':'data:,TILT=NONE'}", "{'bufferView':3}",
        "{'uri':'data:,'}",          "{}",
    };
    for (size_t i = 0; i < sizeof profiles / sizeof profiles[0]; ++i) {
        gltf_write(f, "outside.ies", IES_HEAD, sizeof IES_HEAD - 1);
        assert_gltf_status(f, import_ies(f, "x", ",'multiplier':4", profiles[i]), PPM_STATUS_OK);
        assert_int_equal(f->scene->punctual_count, 1);
        assert_int_equal(f->scene->punctuals[0].profile, 0);
        assert_float_equal(f->scene->punctuals[0].intensity.x, 4.0f, 0.0f);
        assert_gltf_logged(f, 'W', "extensions.EXT_lights_ies.lights[0]: its lights shine evenly");
        gltf_reset(f);
    }
    assert_gltf_status(f, import_ies(f, "x", "", "{'uri':7}"), PPM_STATUS_OK);
    assert_int_equal(f->scene->punctual_count, 0);
    assert_gltf_logged(f, 'W', "left out");
}

static void a_negative_multiplier_leaves_the_light_out(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_ies(f, "x", ",'multiplier':-1", "{'uri':'data:,x'}"),
                       PPM_STATUS_OK);
    assert_int_equal(f->scene->punctual_count, 0);
    assert_gltf_logged(f, 'W', "left out: lights[0]: intensity must not be negative");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(lights_that_are_scaled_to_nothing_are_told_and_dark),
        TEST(a_radius_comes_from_the_light_or_else_its_node),
        TEST(an_angle_is_the_diameter_of_a_sun),
        TEST(a_blend_gives_a_spot_the_falloff_of_blender),
        TEST(a_blend_out_of_range_leaves_the_spot_as_it_is),
        TEST(extras_of_any_form_do_no_harm),
        TEST(a_range_is_said_not_to_be_used_once),
        TEST(area_lights_have_the_defaults_of_the_extension),
        TEST(area_lights_scale_by_the_largest_component),
        TEST(invalid_area_lights_are_left_out_with_a_warning),
        TEST(area_extras_are_scaled_with_their_node),
        TEST(power_is_spread_over_the_area),
        TEST(invalid_area_extras_are_left_out_with_a_warning),
        TEST(a_profile_comes_from_a_file_beside_the_asset),
        TEST(a_profile_is_read_once_for_all_its_lights),
        TEST(a_profile_comes_from_a_buffer_view),
        TEST(without_its_profile_a_light_shines_evenly_and_a_warning_says_so),
        TEST(a_negative_multiplier_leaves_the_light_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
