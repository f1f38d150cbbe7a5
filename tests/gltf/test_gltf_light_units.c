/* importers/gltf/gltf_light_units.c: which exporter wrote what. */
#include "gltf/gltf_light_units.h"
#include "gltf/gltf_shim.h"
#include "gltf_fixture.h"
#include "support/near.h"

#define PI 3.14159265358979323846

static void other_generators_have_no_row(void **state)
{
    (void)state;
    static const char *const generators[] = {"", "Blender", "Khronos Blender glTF 2.0 I/O",
                                             "khronos gltf blender i/o v3.4.50", "v3.4"};
    for (size_t i = 0; i < sizeof generators / sizeof generators[0]; ++i) {
        assert_null(ppmi_gltf_find_units(generators[i]));
    }
}

static void the_version_decides(void **state)
{
    (void)state;
    const struct {
        const char *generator;
        int32_t units;
        bool suns_are_doubtful;
    } rows[] = {
        {"Khronos glTF Blender I/O v0.9.2", PPM_LIGHT_UNITS_RAW, false},
        {"Khronos glTF Blender I/O v1.2.75", PPM_LIGHT_UNITS_RAW, false},
        {"Khronos glTF Blender I/O v3.3.27", PPM_LIGHT_UNITS_RAW, false},
        {"Khronos glTF Blender I/O v3.4.50", PPM_LIGHT_UNITS_BLENDER, false},
        {"Khronos glTF Blender I/O v4.5.48 with hand-edits", PPM_LIGHT_UNITS_BLENDER, false},
        {"Khronos glTF Blender I/O v5.0.16", PPM_LIGHT_UNITS_BLENDER, true},
        {"Khronos glTF Blender I/O v5.1.19", PPM_LIGHT_UNITS_BLENDER, true},
        {"Khronos glTF Blender I/O v5.2.20", PPM_LIGHT_UNITS_BLENDER, false},
        {"Khronos glTF Blender I/O v10.0.1", PPM_LIGHT_UNITS_BLENDER, false},
        {"Khronos glTF Blender I/O", PPM_LIGHT_UNITS_BLENDER, false},
        {"Khronos glTF Blender I/O vX", PPM_LIGHT_UNITS_BLENDER, false},
        {"Khronos glTF Blender I/O v3", PPM_LIGHT_UNITS_BLENDER, false},
        {"Khronos glTF Blender I/O v99999999999999999999.1", PPM_LIGHT_UNITS_BLENDER, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        const ppmi_gltf_unit_row *row = ppmi_gltf_find_units(rows[i].generator);
        assert_non_null(row);
        assert_int_equal(row->units, rows[i].units);
        assert_int_equal(row->suns_are_doubtful, rows[i].suns_are_doubtful);
    }
}

/* A lamp of 100 W, a sun of 3 W/m2, a panel of 30 W: whatever the exporter writes for them, one
 * scale comes out; as lumens it is 683 times that. */
static void the_factors_bring_all_to_one_scale(void **state)
{
    (void)state;
    const double candela = 100 / (4 * PI);
    const int point = PPMI_GLTF_LIGHT_POINT, sun = PPMI_GLTF_LIGHT_DIRECTIONAL;
    assert_near(100 * ppmi_gltf_unit_factor(PPM_LIGHT_UNITS_RAW, point), candela, 1e-6);
    assert_near(683 * candela * ppmi_gltf_unit_factor(PPM_LIGHT_UNITS_BLENDER, point),
                        candela, 1e-6);
    assert_near(3 * ppmi_gltf_unit_factor(PPM_LIGHT_UNITS_RAW, sun), 3, 1e-6);
    assert_near(2049 * ppmi_gltf_unit_factor(PPM_LIGHT_UNITS_BLENDER, sun), 3, 1e-6);
    assert_near(ppmi_gltf_watt_factor(PPM_LIGHT_UNITS_RAW), 1, 0);
    assert_near(ppmi_gltf_watt_factor(PPM_LIGHT_UNITS_BLENDER), 1, 0);
    assert_near(ppmi_gltf_watt_factor(PPM_LIGHT_UNITS_GLTF) *
                            ppmi_gltf_candela_factor(PPM_LIGHT_UNITS_BLENDER),
                        1, 1e-9);
    assert_near(ppmi_gltf_candela_factor(PPM_LIGHT_UNITS_GLTF), 1, 0);
}

static ppm_status import_lamps(gltf_fixture *f, const char *version, const char *lights)
{
    return gltf_importf(f,
                        "{'asset':{'version':'2.0','generator':'Khronos glTF Blender I/O v%s'},"
                        "'nodes':[{'extensions':{'KHR_lights_punctual':{'light':0}}}],"
                        "'extensions':{'KHR_lights_punctual':{'lights':[%s]}}}",
                        version, lights);
}

static void the_row_is_reported(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_lamps(f, "3.3.27", "{'type':'point','intensity':100}"),
                       PPM_STATUS_OK);
    assert_float_equal(f->scene->punctuals[0].intensity.x, (float)(100 / (4 * PI)), 1e-4f);
    assert_gltf_logged(f, 'I', "watts as Blender's raw mode writes them");
    assert_gltf_logged(f, 'I', "Blender's exporter before 3.4");
}

static void suns_that_lost_their_strength_are_told(void **state)
{
    gltf_fixture *f = *state;
    static const char sun[] = "{'type':'directional','intensity':683}";
    assert_gltf_status(f, import_lamps(f, "5.1.19", sun), PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "1 suns of 683 lux");
    gltf_reset(f);
    assert_gltf_status(f, import_lamps(f, "5.1.19", "{'type':'directional','intensity':6830}"),
                       PPM_STATUS_OK);
    assert_false(gltf_logged(f, 'W', "suns of 683"));
    gltf_reset(f);
    assert_gltf_status(f, import_lamps(f, "5.2.20", sun), PPM_STATUS_OK);
    assert_false(gltf_logged(f, 'W', "suns of 683"));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(other_generators_have_no_row),           TEST(the_version_decides),
        TEST(the_factors_bring_all_to_one_scale),     TEST(the_row_is_reported),
        TEST(suns_that_lost_their_strength_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
