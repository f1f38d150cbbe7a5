/* Imports every glTF of the development assets: nothing crashes, what is valid is read, and its
 * geometry is what another implementation found (geometry.tsv). Skipped where they are absent. */
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "gltf_motion.h"

enum { MAX_PATH = 512 };

typedef void (*visit_fn)(gltf_fixture *f, const char *path);

static bool is_gltf(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && (strcasecmp(dot, ".gltf") == 0 || strcasecmp(dot, ".glb") == 0);
}

/* Calls visit for every glTF below a folder of the assets; path is relative to them. Returns how
 * many there were. */
static size_t visit_all(gltf_fixture *f, const char *folder, visit_fn visit)
{
    char full[MAX_PATH], path[MAX_PATH];
    size_t count = 0;
    snprintf(full, sizeof full, PPM_ASSETS_DIR "/%s", folder);
    DIR *directory = opendir(full);
    assert_non_null(directory);
    for (const struct dirent *entry; (entry = readdir(directory));) {
        struct stat info;
        if (entry->d_name[0] == '.') continue;
        assert_true((size_t)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) <
                    sizeof path);
        assert_true((size_t)snprintf(full, sizeof full, PPM_ASSETS_DIR "/%s", path) < sizeof full);
        if (stat(full, &info) != 0) continue;
        if (S_ISDIR(info.st_mode)) {
            count += visit_all(f, path, visit);
        } else if (is_gltf(entry->d_name)) {
            visit(f, path);
            ++count;
        }
    }
    closedir(directory);
    return count;
}

static ppm_status import_asset(gltf_fixture *f, const char *path)
{
    char full[3 * MAX_PATH];
    snprintf(full, sizeof full, PPM_ASSETS_DIR "/%s", path);
    gltf_reset(f);
    return ppmi_gltf_import(f->context, f->scene, full, &f->options);
}

/* ---- any file -------------------------------------------------------------------------------- */

static void import_anything(gltf_fixture *f, const char *path)
{
    const ppm_status status = import_asset(f, path);
    const bool is_known = status == PPM_STATUS_OK || status == PPM_STATUS_INPUT_INVALID ||
                          status == PPM_STATUS_INPUT_NOT_FOUND ||
                          status == PPM_STATUS_INPUT_UNSUPPORTED;
    if (!is_known) fail_msg("%s: %s\n%s", path, ppm_status_name(status), f->log);
    if (status != PPM_STATUS_OK && !gltf_logged(f, 'E', path)) {
        fail_msg("%s: no error names it\n%s", path, f->log);
    }
}

static void broken_and_odd_files_end_in_a_status_and_a_message(void **state)
{
    assert_true(visit_all(*state, "bad", import_anything) > 30);
    assert_true(visit_all(*state, "odd", import_anything) > 5);
    assert_true(visit_all(*state, "validator", import_anything) > 50);
}

/* ---- valid files ----------------------------------------------------------------------------- */

typedef struct expected {
    unsigned long long triangles, lines, points;
    float low[3], high[3];
} expected;

/* The row of geometry.tsv, or false. */
static bool find_expected(const char *path, expected *e)
{
    char line[1024];
    bool is_found = false;
    FILE *file = fopen(PPM_ASSETS_DIR "/geometry.tsv", "r");
    assert_non_null(file);
    while (!is_found && fgets(line, sizeof line, file)) {
        const size_t length = strlen(path);
        if (strncmp(line, path, length) != 0 || line[length] != '\t') continue;
        is_found = sscanf(line + length, "\t%llu\t%llu\t%llu\t%f,%f,%f\t%f,%f,%f", &e->triangles,
                          &e->lines, &e->points, &e->low[0], &e->low[1], &e->low[2], &e->high[0],
                          &e->high[1], &e->high[2]) == 9;
    }
    fclose(file);
    return is_found;
}

static unsigned long long count_triangles(const ppm_scene *scene)
{
    unsigned long long count = 0;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const ppmi_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        for (uint32_t k = 0; k < mesh->primitive_count; ++k) {
            count += mesh->primitives[k].triangle_count;
        }
    }
    return count;
}

static void compare_bounds(gltf_fixture *f, const char *path, const expected *e)
{
    ppm_scene_info info = {.size = sizeof info};
    assert_int_equal(ppm_scene_get_info(f->scene, &info), PPM_STATUS_OK);
    float size = 0.0f;
    for (int i = 0; i < 3; ++i) {
        size = fmaxf(size, e->high[i] - e->low[i]);
    }
    for (int i = 0; i < 3; ++i) {
        const float error =
            fmaxf(fabsf(info.bounds_min[i] - e->low[i]), fabsf(info.bounds_max[i] - e->high[i]));
        if (!(error <= 1e-3f * size)) {
            fail_msg("%s: axis %d is %g .. %g, expected %g .. %g", path, i,
                     (double)info.bounds_min[i], (double)info.bounds_max[i], (double)e->low[i],
                     (double)e->high[i]);
        }
    }
}

/* Whether the file has skins or morph targets, which the table leaves out. */
static bool is_deformed(const char *path)
{
    static const char *const words[] = {"\"JOINTS_0\"", "\"targets\""};
    char full[MAX_PATH];
    static char text[1 << 20]; /* descriptions are shorter than this */
    snprintf(full, sizeof full, PPM_ASSETS_DIR "/%s", path);
    FILE *file = fopen(full, "rb");
    assert_non_null(file);
    const size_t count = fread(text, 1, sizeof text, file);
    fclose(file);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        const size_t length = strlen(words[i]);
        for (size_t k = 0; k + length <= count; ++k) {
            if (memcmp(text + k, words[i], length) == 0) return true;
        }
    }
    return false;
}

static void import_valid(gltf_fixture *f, const char *path)
{
    expected e;
    const ppm_status status = import_asset(f, path);
    if (status == PPM_STATUS_INPUT_UNSUPPORTED && gltf_logged(f, 'E', "is not supported")) return;
    if (status != PPM_STATUS_OK) fail_msg("%s: %s\n%s", path, ppm_status_name(status), f->log);
    if (!find_expected(path, &e)) return;
    /* the table counts triangles of no area, which the scene drops */
    const unsigned long long got = count_triangles(f->scene);
    const bool has_dropped =
        gltf_logged(f, 'D', "of no area left out") || gltf_logged(f, 'W', "not a finite number");
    if (has_dropped ? got > e.triangles : got != e.triangles) {
        fail_msg("%s: %llu triangles, expected %llu", path, got, e.triangles);
    }
    /* in the table's boxes are points and lines, but not what EXT_mesh_gpu_instancing places */
    const bool is_instanced = strstr(path, "nstanc") && f->scene->instance_count > 100;
    if (e.lines == 0 && e.points == 0 && !is_instanced && !is_deformed(path)) {
        compare_bounds(f, path, &e);
    }
}

static void valid_files_are_read_as_others_read_them(void **state)
{
    assert_true(visit_all(*state, "gltf", import_valid) > 80);
    assert_true(visit_all(*state, "gltf-blender", import_valid) > 30);
    assert_true(visit_all(*state, "scenes", import_valid) > 1);
}

/* ---- animated files -------------------------------------------------------------------------- */

static void animate_anything(gltf_fixture *f, const char *path)
{
    f->options.pose = gltf_between(0.1, 0.2);
    import_anything(f, path);
}

static void broken_animations_end_in_a_status_and_a_message(void **state)
{
    visit_all(*state, "bad", animate_anything);
    visit_all(*state, "odd", animate_anything);
    visit_all(*state, "validator", animate_anything);
}

/* At one time, at another and back again. */
static void pose_and_return(gltf_fixture *f, const char *path)
{
    char full[MAX_PATH];
    ppmi_gltf_asset *asset;
    snprintf(full, sizeof full, PPM_ASSETS_DIR "/%s", path);
    gltf_reset(f);
    f->options.pose = gltf_between(0.4, 0.5);
    const ppm_status status = gltf_open_path(f, full, &asset);
    if (status == PPM_STATUS_INPUT_UNSUPPORTED && gltf_logged(f, 'E', "is not supported")) return;
    if (status != PPM_STATUS_OK) fail_msg("%s: %s\n%s", path, ppm_status_name(status), f->log);
    const uint64_t hash = gltf_scene_hash(f->scene);
    const uint32_t meshes = f->scene->mesh_count, instances = f->scene->instance_count;
    const ppm_pose when = gltf_at(0.9);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &when), PPM_STATUS_OK);
    assert_int_equal(ppmi_gltf_asset_set_pose(asset, &f->options.pose), PPM_STATUS_OK);
    if (gltf_scene_hash(f->scene) != hash) fail_msg("%s: another pose than before", path);
    assert_int_equal(f->scene->mesh_count, meshes);
    assert_int_equal(f->scene->instance_count, instances);
    ppmi_gltf_asset_close(asset);
}

static void valid_files_are_posed_and_return(void **state)
{
    visit_all(*state, "gltf", pose_and_return);
    visit_all(*state, "gltf-blender", pose_and_return);
}

/* ---- the validator's corpus ------------------------------------------------------------------ */

/* A file that is refused, and a part of why. */
typedef struct refusal {
    const char *path, *message;
} refusal;

/* As they are, most files have a fault in a part that no scene uses, or that does not show. These
 * cannot be read, or their scene is not what it says. named_objects is valid, but the bytes of its
 * mesh are in no file. */
static const refusal refused[] = {
    {"base/asset/1_0_version.gltf", "asset.version"},
    {"base/asset/min_version_invalid.gltf", "asset.minVersion"},
    {"base/glb/chunk_too_big.glb", "chunk 0"},
    {"base/glb/empty_json_object.glb", "asset: missing"},
    {"base/glb/invalid_version.glb", "header"},
    {"base/glb/only_header.glb", "chunk 0"},
    {"base/glb/two_bin_chunks.glb", "chunk 0"},
    {"base/glb/zero_chunk_header.glb", "chunk 0"},
    {"base/json/invalid_syntax.gltf", "line 1, column 2"},
    {"base/mesh_data/joints_no_weights.gltf", "bufferViews[0]: 32 bytes"},
    {"base/node/matrix_indecomposable.gltf", "nodes[0].matrix"},
    {"base/node/node_loop_scene.gltf", "nodes[0].children[0]"},
    {"base/root/named_objects.gltf", "buffers[0]: it has no bytes"},
    {"base/root/undefined_used_extensions.gltf", "extensionsRequired[0]"},
    {"base/scene/unresolved_node.gltf", "scenes[0].nodes[0]"},
};

/* What of the files that have meshes and no nodes is refused once a node shows the first mesh. */
static const refusal refused_when_shown[] = {
    {"base/mesh/accessor_without_bytestride.gltf", "buffers[0]: it has no bytes"},
    {"base/mesh/empty_object.gltf", "meshes[0].primitives: missing"},
    {"base/mesh/position_accessor_invalid_format.gltf",
     "meshes[0].primitives[0].attributes.POSITION (accessors[0])"},
    {"base/mesh/unresolved_indices.gltf", "meshes[0].primitives[0].indices: accessors[1]"},
    {"base/mesh/unresolved_positions.gltf",
     "meshes[0].primitives[0].attributes.POSITION: accessors[0]"},
    {"base/mesh_data/colors_non_clamped.gltf", "cannot be opened"}, /* moved from its .bin */
};

#define VALIDATOR PPM_ASSETS_DIR "/validator/"

static void check_verdict(const gltf_fixture *f, const char *path, ppm_status status,
                          const refusal *table, size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(table[i].path, path) != 0) continue;
        if (status == PPM_STATUS_OK || !gltf_logged(f, 'E', table[i].message)) {
            fail_msg("%s: %s, expected \"%s\"\n%s", path, ppm_status_name(status), table[i].message,
                     f->log);
        }
        return;
    }
    if (status != PPM_STATUS_OK) fail_msg("%s: %s\n%s", path, ppm_status_name(status), f->log);
}

/* Calls visit with every path of expected.tsv. */
static size_t visit_expected(gltf_fixture *f, visit_fn visit)
{
    char line[1024];
    size_t count = 0;
    FILE *file = fopen(VALIDATOR "expected.tsv", "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file)); /* the names of the columns */
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\t\n")] = 0;
        visit(f, line);
        ++count;
    }
    fclose(file);
    return count;
}

static void check_as_it_is(gltf_fixture *f, const char *path)
{
    char full[2 * MAX_PATH];
    snprintf(full, sizeof full, "validator/%s", path);
    check_verdict(f, path, import_asset(f, full), refused, sizeof refused / sizeof *refused);
}

/* A copy of the file with a node for the first mesh in front of everything else. */
static void check_shown(gltf_fixture *f, const char *path)
{
    char full[3 * MAX_PATH], text[16384], shown[17000];
    snprintf(full, sizeof full, VALIDATOR "%s", path);
    FILE *file = fopen(full, "rb");
    assert_non_null(file);
    const size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[length] = 0;
    const char *brace = strchr(text, '{');
    if (!is_gltf(path) || length == sizeof text - 1 || strstr(path, ".glb") || !brace ||
        !strstr(text, "\"meshes\"") || strstr(text, "\"nodes\"")) {
        return;
    }
    const char *scenes = strstr(text, "\"scenes\"") ? "" : "\"scenes\":[{\"nodes\":[0]}],";
    const int count = snprintf(shown, sizeof shown, "%.*s\"nodes\":[{\"mesh\":0}],%s%s",
                               (int)(brace + 1 - text), text, scenes, brace + 1);
    gltf_reset(f);
    gltf_write(f, "sub/shown.gltf", shown, (size_t)count);
    check_verdict(f, path, gltf_import_file(f, "sub/shown.gltf"), refused_when_shown,
                  sizeof refused_when_shown / sizeof *refused_when_shown);
}

static void faults_that_make_the_picture_wrong_are_refused_and_no_others(void **state)
{
    assert_true(visit_expected(*state, check_as_it_is) > 100);
    visit_expected(*state, check_shown);
}

static void the_helmet_has_the_images_of_its_material(void **state)
{
    gltf_fixture *f = *state;
    assert_gltf_status(f, import_asset(f, "gltf/DamagedHelmet.glb"), PPM_STATUS_OK);
    const ppm_material_desc *m = &f->scene->materials[0].desc;
    assert_int_equal(f->scene->material_count, 1);
    assert_int_equal(f->scene->image_count, 4); /* the fifth is the occlusion map */
    assert_int_not_equal(m->base_color_texture.image, 0);
    assert_int_not_equal(m->metallic_roughness_texture.image, 0);
    assert_int_not_equal(m->normal_texture.image, 0);
    assert_int_not_equal(m->emission_texture.image, 0);
}

/* The name of the material of the first primitive. */
static const char *variant_material(gltf_fixture *f, const char *variant)
{
    f->options.variant = variant;
    assert_gltf_status(f, import_asset(f, "gltf-blender/roundtrip/18_variants/18_variants.gltf"),
                       PPM_STATUS_OK);
    return f->scene->materials[f->scene->meshes[0].primitives[0].material].name;
}

static void blenders_variants_change_materials(void **state)
{
    gltf_fixture *f = *state;
    char red[64], blue[64];
    snprintf(red, sizeof red, "%s", variant_material(f, "Variant_Red"));
    snprintf(blue, sizeof blue, "%s", variant_material(f, "Variant_Blue"));
    assert_string_not_equal(red, blue);
}

/* What each file is there for (MANIFEST.md) arrives in one of its materials. */
static void files_of_extensions_have_their_values_in_their_materials(void **state)
{
    gltf_fixture *f = *state;
    static const struct {
        const char *path;
        size_t at; /* of a float in the material that is not 0 */
    } cases[] = {
#define AT(member) offsetof(ppm_material_desc, member)
        {"gltf/ClearCoatTest/ClearCoatTest.gltf", AT(clearcoat)},
        {"gltf/SheenCloth.glb", AT(sheen_color)},
        {"gltf/AnisotropyStrengthTest.glb", AT(anisotropy)},
        {"gltf/ExtIridescence/ExtIridescence.gltf", AT(iridescence)},
        {"gltf/ExtVolumeScatterDiffuseTransmission/ExtVolumeScatterDiffuseTransmission.gltf",
         AT(diffuse_transmission)},
        {"gltf/ExtVolumeScatterDiffuseTransmission/ExtVolumeScatterDiffuseTransmission.gltf",
         AT(multiscatter_color)},
        {"gltf-blender/roundtrip/19_sheen/19_sheen.gltf", AT(sheen_color)},
        {"gltf-blender/roundtrip/25_anisotropy/25_anisotropy.gltf", AT(anisotropy)},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        float greatest = 0.0f;
        assert_gltf_status(f, import_asset(f, cases[i].path), PPM_STATUS_OK);
        for (uint32_t k = 0; k < f->scene->material_count; ++k) {
            float value;
            memcpy(&value, (const char *)&f->scene->materials[k].desc + cases[i].at, sizeof value);
            greatest = fmaxf(greatest, value);
        }
        if (!(greatest > 0.0f)) fail_msg("%s: nothing arrived", cases[i].path);
    }
}

int main(void)
{
    struct stat info;
    if (stat(PPM_ASSETS_DIR "/geometry.tsv", &info) != 0) {
        printf("skipped: no development assets at %s\n", PPM_ASSETS_DIR);
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(broken_and_odd_files_end_in_a_status_and_a_message,
                                        gltf_setup, gltf_teardown),
        cmocka_unit_test_setup_teardown(valid_files_are_read_as_others_read_them, gltf_setup,
                                        gltf_teardown),
        cmocka_unit_test_setup_teardown(broken_animations_end_in_a_status_and_a_message, gltf_setup,
                                        gltf_teardown),
        cmocka_unit_test_setup_teardown(valid_files_are_posed_and_return, gltf_setup,
                                        gltf_teardown),
        cmocka_unit_test_setup_teardown(
            faults_that_make_the_picture_wrong_are_refused_and_no_others, gltf_setup,
            gltf_teardown),
        cmocka_unit_test_setup_teardown(the_helmet_has_the_images_of_its_material, gltf_setup,
                                        gltf_teardown),
        cmocka_unit_test_setup_teardown(blenders_variants_change_materials, gltf_setup,
                                        gltf_teardown),
        cmocka_unit_test_setup_teardown(files_of_extensions_have_their_values_in_their_materials,
                                        gltf_setup, gltf_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
