/* One table says what the kinds are called, for people and for programs. The keys of the JSON are
 * part of the program's contract (docs/command-line.md). */
#include "list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/printable.h"
#include "features_json.h"
#include "options.h"

/* In the order in which they are shown. */
static const struct {
    int32_t kind;
    const char *key;     /* of the JSON */
    const char *heading; /* with the option that chooses one */
} kinds[] = {
    {PPM_ASSET_SCENES, "scenes", "Scenes (--scene)"},
    {PPM_ASSET_CAMERAS, "cameras", "Cameras (--camera)"},
    {PPM_ASSET_LIGHTS, "lights", "Lights"},
    {PPM_ASSET_VARIANTS, "variants", "Variants (--variant)"},
    {PPM_ASSET_ANIMATIONS, "animations", "Animations (--animation)"},
    {PPM_ASSET_NODES, "nodes", "Nodes (--focus)"},
    {PPM_ASSET_MESHES, "meshes", "Meshes"},
    {PPM_ASSET_MATERIALS, "materials", "Materials"},
    {PPM_ASSET_IMAGES, "images", "Images"},
};
enum { KIND_COUNT = sizeof kinds / sizeof kinds[0], NAME_COLUMN_MOST = 32 };

static int finish(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) return EXIT_DONE;
    perror("ppm-render: error: standard output");
    return EXIT_OUTPUT;
}

/* ---- the table ------------------------------------------------------------------------------- */

/* Letters of UTF-8, each taken as one column wide. */
static int columns(const char *text)
{
    int count = 0;
    for (; *text; text++)
        count += ((unsigned char)*text & 0xc0) != 0x80;
    return count;
}

static int name_column(const ppm_asset *asset, int32_t kind)
{
    int widest = 0;
    const uint32_t count = ppm_asset_count(asset, kind);
    for (uint32_t i = 0; i < count; i++) {
        ppm_asset_item item = {.size = sizeof item};
        if (ppm_asset_get_item(asset, kind, i, &item) != PPM_STATUS_OK) continue;
        const int width = columns(item.name);
        if (width > widest && width <= NAME_COLUMN_MOST) widest = width;
    }
    return widest;
}

static void print_padded(const char *text, int width)
{
    const int missing = width - columns(text);
    ppmi_print(stdout, "%s%*s", text, missing > 0 ? missing : 0, "");
}

static void print_kind(const ppm_asset *asset, int32_t kind, const char *heading)
{
    const uint32_t count = ppm_asset_count(asset, kind);
    const int width = name_column(asset, kind);
    if (count == 0) return;
    ppmi_print(stdout, "\n%s: %u\n", heading, count);
    for (uint32_t i = 0; i < count; i++) {
        ppm_asset_item item = {.size = sizeof item};
        if (ppm_asset_get_item(asset, kind, i, &item) != PPM_STATUS_OK) continue;
        ppmi_print(stdout, "%5u  ", i + 1);
        if (*item.detail) {
            print_padded(item.name, width);
            ppmi_print(stdout, "  %s\n", item.detail);
        } else {
            ppmi_print(stdout, "%s\n", item.name);
        }
    }
}

static void print_features(const ppm_asset *asset, int32_t verdict, bool *has_heading)
{
    const uint32_t count = ppm_asset_feature_count(asset);
    for (uint32_t i = 0; i < count; i++) {
        ppm_asset_feature feature = {.size = sizeof feature};
        if (ppm_asset_get_feature(asset, i, &feature) != PPM_STATUS_OK) continue;
        if (feature.verdict != verdict) continue;
        if (!*has_heading) ppmi_print(stdout, "\nWhat of it is understood:\n");
        *has_heading = true;
        ppmi_print(stdout, "  %-13s %s%s%s\n", feature_verdict(verdict), feature.name,
                   *feature.note ? ": " : "", feature.note);
    }
}

static const char *part_name(uint32_t part)
{
    switch (part) {
    case PPM_SETUP_CAMERAS:
        return "camera";
    case PPM_SETUP_LIGHTS:
        return "light";
    case PPM_SETUP_ENVIRONMENT:
        return "environment";
    case PPM_SETUP_FOG:
        return "fog";
    case PPM_SETUP_MATERIALS:
        return "material";
    case PPM_SETUP_NODES:
        return "node";
    }
    return "render";
}

static void print_setup(const ppm_setup *setup)
{
    if (!setup) return;
    ppmi_print(stdout, "\nSetup file (--setup): %s\n", ppm_setup_path(setup));
    for (uint32_t i = 0; i < ppm_setup_count(setup); i++) {
        ppm_setup_item item = {.size = sizeof item};
        if (ppm_setup_get_item(setup, i, &item) != PPM_STATUS_OK) continue;
        ppmi_print(stdout, "  %-11s  %s%s%s\n", part_name(item.part), item.name,
                   *item.name && *item.detail ? ": " : "", item.detail);
    }
}

static void print_table(const ppm_asset *asset, const ppm_setup *setup, const char *path)
{
    const char *const generator = ppm_asset_generator(asset);
    const char *const units = ppm_asset_light_units(asset);
    bool has_heading = false;
    ppmi_print(stdout, "%s%s%s\n", path, *generator ? ", written by " : "", generator);
    ppmi_print(stdout, "Units: metres, radians, seconds%s%s\n", *units ? "; lights: " : "", units);
    for (size_t i = 0; i < KIND_COUNT; i++)
        print_kind(asset, kinds[i].kind, kinds[i].heading);
    print_setup(setup);
    print_features(asset, PPM_FEATURE_IGNORED, &has_heading);
    print_features(asset, PPM_FEATURE_APPROXIMATED, &has_heading);
    print_features(asset, PPM_FEATURE_HONOURED, &has_heading);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static json_t *kind_json(const ppm_asset *asset, int32_t kind)
{
    const uint32_t count = ppm_asset_count(asset, kind);
    json_t *const list = json_array();
    for (uint32_t i = 0; list && i < count; i++) {
        ppm_asset_item item = {.size = sizeof item};
        if (ppm_asset_get_item(asset, kind, i, &item) != PPM_STATUS_OK) continue;
        json_t *const object = json_object();
        json_object_set_new(object, "number", json_integer(i + 1));
        json_object_set_new(object, "name", text_json(item.name));
        json_object_set_new(object, "detail", text_json(item.detail));
        if (kind == PPM_ASSET_ANIMATIONS) {
            json_object_set_new(object, "begin_s", json_real(item.begin_s));
            json_object_set_new(object, "end_s", json_real(item.end_s));
        }
        json_array_append_new(list, object);
    }
    return list;
}

/* null without a setup file. */
static json_t *setup_json(const ppm_setup *setup)
{
    if (!setup) return json_null();
    json_t *const root = json_object(), *const items = json_array();
    for (uint32_t i = 0; items && i < ppm_setup_count(setup); i++) {
        ppm_setup_item item = {.size = sizeof item};
        if (ppm_setup_get_item(setup, i, &item) != PPM_STATUS_OK) continue;
        json_t *const object = json_object();
        json_object_set_new(object, "part", json_string(part_name(item.part)));
        json_object_set_new(object, "name", text_json(item.name));
        json_object_set_new(object, "detail", text_json(item.detail));
        json_array_append_new(items, object);
    }
    json_object_set_new(root, "file", text_json(ppm_setup_path(setup)));
    json_object_set_new(root, "items", items);
    return root;
}

static int print_json(const ppm_asset *asset, const ppm_setup *setup, const char *path)
{
    json_t *const root = json_object();
    json_object_set_new(root, "version", json_string(ppm_version()));
    json_object_set_new(root, "file", text_json(path));
    json_object_set_new(root, "generator", text_json(ppm_asset_generator(asset)));
    json_object_set_new(root, "light_units", text_json(ppm_asset_light_units(asset)));
    for (size_t i = 0; i < KIND_COUNT; i++)
        json_object_set_new(root, kinds[i].key, kind_json(asset, kinds[i].kind));
    json_object_set_new(root, "setup", setup_json(setup));
    json_object_set_new(root, "features", features_json(asset));
    if (!root) return EXIT_RESOURCES;
    json_dumpf(root, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    fputc('\n', stdout);
    json_decref(root);
    return EXIT_DONE;
}

int list_print(const ppm_asset *asset, const ppm_setup *setup, const char *path, int32_t format)
{
    int result = EXIT_DONE;
    if (format == LIST_JSON) {
        result = print_json(asset, setup, path);
    } else {
        print_table(asset, setup, path);
    }
    return result == EXIT_DONE ? finish() : result;
}
