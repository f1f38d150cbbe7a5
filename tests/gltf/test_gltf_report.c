/* importers/gltf/gltf_report.c, gltf_features.c and gltf_extensions.c */
#include <stdio.h>

#include "gltf/gltf_reader.h"
#include "gltf/gltf_report.h"
#include "gltf_fixture.h"

/* A reader with nothing but a report. */
static ppmi_gltf_reader bare_reader(gltf_fixture *f)
{
    return (ppmi_gltf_reader){.context = f->context, .options = &f->options, .path = "x.gltf"};
}

static void assert_feature(const ppmi_gltf_reader *reader, const char *name, int32_t verdict,
                           const char *note)
{
    const ppmi_gltf_feature *feature = ppmi_gltf_find_feature(reader, name);
    assert_non_null(feature);
    assert_int_equal(feature->verdict, verdict);
    assert_string_equal(feature->note, note);
}

/* ---- the table ------------------------------------------------------------------------------- */

static void a_name_has_one_line_with_its_worst_verdict(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_reader reader = bare_reader(f);
    ppmi_gltf_note_feature(&reader, "a", PPM_FEATURE_APPROXIMATED, "roughly");
    ppmi_gltf_note_feature(&reader, "b", PPM_FEATURE_HONOURED, "");
    ppmi_gltf_note_feature(&reader, "a", PPM_FEATURE_HONOURED, "");
    assert_int_equal(reader.report.count, 2);
    assert_feature(&reader, "a", PPM_FEATURE_APPROXIMATED, "roughly");
    ppmi_gltf_note_feature(&reader, "a", PPM_FEATURE_APPROXIMATED, "in another way");
    assert_feature(&reader, "a", PPM_FEATURE_APPROXIMATED, "in another way");
    ppmi_gltf_note_feature(&reader, "a", PPM_FEATURE_IGNORED, "not at all");
    assert_feature(&reader, "a", PPM_FEATURE_IGNORED, "not at all");
    assert_null(ppmi_gltf_find_feature(&reader, "c"));
    ppmi_gltf_report_deinit(f->context, &reader.report);
}

static void each_verdict_is_logged_at_its_level(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_reader reader = bare_reader(f);
    ppmi_gltf_note_feature(&reader, "a", PPM_FEATURE_HONOURED, "");
    ppmi_gltf_note_feature(&reader, "b", PPM_FEATURE_APPROXIMATED, "roughly");
    ppmi_gltf_note_feature(&reader, "c", PPM_FEATURE_IGNORED, "not at all");
    assert_int_equal(ppmi_gltf_report_finish(&reader), PPM_STATUS_OK);
    assert_gltf_logged(f, 'D', "x.gltf: honoured: a");
    assert_gltf_logged(f, 'I', "x.gltf: approximated: b: roughly");
    assert_gltf_logged(f, 'W', "x.gltf: ignored: c: not at all");
    ppmi_gltf_report_deinit(f->context, &reader.report);
}

static void many_ignored_features_are_cut_in_the_error_but_all_logged(void **state)
{
    gltf_fixture *f = *state;
    ppmi_gltf_reader reader = bare_reader(f);
    char name[64];
    f->options.strict = 1;
    for (int i = 0; i < 40; ++i) {
        snprintf(name, sizeof name, "EXT_a_rather_long_name_of_an_extension_%d", i);
        ppmi_gltf_note_feature(&reader, name, PPM_FEATURE_IGNORED, "");
    }
    assert_int_equal(ppmi_gltf_report_finish(&reader), PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'W', "extension_39");
    assert_gltf_logged(f, 'E', "extension_0, EXT_a");
    assert_gltf_logged(f, 'E', " more");
    ppmi_gltf_report_deinit(f->context, &reader.report);
}

static void a_lost_note_is_an_error(void **state)
{
    gltf_fixture *f = *state;
    for (size_t n = 1; n <= 4; ++n) { /* the table, the name, no note, the note */
        ppmi_gltf_reader reader = bare_reader(f);
        ppmi_alloc_fail_at(f->context, n);
        ppmi_gltf_note_feature(&reader, "a", PPM_FEATURE_IGNORED, "b");
        ppmi_alloc_fail_at(f->context, 0);
        for (size_t i = 0; i < reader.report.count; ++i) { /* whoever reads it finds text */
            assert_non_null(reader.report.items[i].name);
            assert_non_null(reader.report.items[i].note);
        }
        assert_int_equal(ppmi_gltf_report_finish(&reader), PPM_STATUS_OUT_OF_MEMORY);
        ppmi_gltf_report_deinit(f->context, &reader.report);
    }
}

/* ---- files ----------------------------------------------------------------------------------- */

#define SMALL "'nodes':[{'mesh':0}]," GLTF_TRIANGLE "}"

static void every_used_extension_gets_one_line(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'extensionsUsed':['EXT_of_tomorrow',"
                                      "'KHR_materials_ior','KHR_materials_unlit']," SMALL),
                       PPM_STATUS_OK);
    assert_gltf_logged(f, 'D', "honoured: KHR_materials_ior");
    assert_gltf_logged(f, 'I', "approximated: KHR_materials_unlit: ");
    assert_gltf_logged(f, 'W', "ignored: EXT_of_tomorrow: the extension is not known");
}

static void a_list_of_extensions_without_end_is_cut(void **state)
{
    gltf_fixture *f = *state;
    char list[4096];
    size_t length = 0;
    for (int i = 0; i < 100; ++i) {
        length += (size_t)snprintf(list + length, sizeof list - length, "%s'EXT_%d'",
                                   i == 0 ? "" : ",", i);
    }
    assert_gltf_status(f, gltf_importf(f, "{" GLTF_HEAD "'extensionsUsed':[%s]," SMALL, list),
                       PPM_STATUS_OK);
    assert_gltf_logged(f, 'W', "ignored: EXT_63");
    assert_false(gltf_logged(f, 'W', "ignored: EXT_64"));
    assert_gltf_logged(f, 'W', "ignored: further extensions");
}

static void strict_refuses_what_is_ignored_after_the_whole_report(void **state)
{
    gltf_fixture *f = *state;
    f->options.strict = 1;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'extensionsUsed':['EXT_a','EXT_b',"
                                      "'KHR_materials_unlit']," SMALL),
                       PPM_STATUS_INPUT_UNSUPPORTED);
    assert_gltf_logged(f, 'W', "ignored: EXT_a");
    assert_gltf_logged(f, 'W', "ignored: EXT_b");
    assert_gltf_logged(f, 'E', "strict: the file uses what is ignored: EXT_a, EXT_b");
}

static void strict_accepts_what_is_honoured_or_approximated(void **state)
{
    gltf_fixture *f = *state;
    f->options.strict = 1;
    assert_gltf_status(f,
                       gltf_import(f, "{" GLTF_HEAD "'extensionsUsed':['KHR_materials_ior',"
                                      "'KHR_materials_unlit']," SMALL),
                       PPM_STATUS_OK);
}

static void parts_of_the_core_format_are_counted(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(
        f,
        gltf_import(f, "{" GLTF_HEAD "'nodes':[{}],'meshes':[{'primitives':["
                       "{'attributes':{'POSITION':0,'COLOR_0':0,'TEXCOORD_12':0}},"
                       "{'attributes':{'POSITION':0,'COLOR_0':0,'COLOR_1':0}}]}],"
                       "'materials':[{'alphaMode':'BLEND'},{'alphaMode':'MASK'},"
                       "{'occlusionTexture':{'index':0}}],"
                       "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','range':2},"
                       "{'type':'point'}]}}}"),
        PPM_STATUS_OK);
    assert_gltf_logged(f, 'D', "honoured: vertex colours: 2 primitives");
    assert_gltf_logged(f, 'W', "ignored: COLOR_1 and further: 1 primitive");
    assert_gltf_logged(f, 'W', "ignored: TEXCOORD_8 and further: 1 primitive");
    assert_gltf_logged(f, 'D', "honoured: alpha BLEND: 1 material");
    assert_gltf_logged(f, 'D', "honoured: alpha MASK: 1 material");
    assert_gltf_logged(f, 'I', "approximated: occlusion textures: 1 material");
    assert_gltf_logged(f, 'W', "ignored: light ranges: 1 light");
}

static void what_a_file_does_not_use_is_not_mentioned(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, gltf_import(f, "{" GLTF_HEAD SMALL), PPM_STATUS_OK);
    assert_false(gltf_logged(f, 'D', "honoured"));
    assert_false(gltf_logged(f, 'I', "approximated"));
    assert_false(gltf_logged(f, 'W', "ignored"));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, gltf_setup, gltf_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_name_has_one_line_with_its_worst_verdict),
        TEST(each_verdict_is_logged_at_its_level),
        TEST(many_ignored_features_are_cut_in_the_error_but_all_logged),
        TEST(a_lost_note_is_an_error),
        TEST(every_used_extension_gets_one_line),
        TEST(a_list_of_extensions_without_end_is_cut),
        TEST(strict_refuses_what_is_ignored_after_the_whole_report),
        TEST(strict_accepts_what_is_honoured_or_approximated),
        TEST(parts_of_the_core_format_are_counted),
        TEST(what_a_file_does_not_use_is_not_mentioned),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
