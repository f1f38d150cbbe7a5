/* The parts of the core format that not every file uses, counted over the whole document, for the
 * import report. Extensions are in gltf_extensions.c. */
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_extensions.h"
#include "gltf/gltf_reader.h"

typedef enum feature {
    ALPHA_BLEND,
    ALPHA_MASK,
    ANIMATIONS,
    LIGHT_RANGES,
    LINES,
    MORE_COLORS,
    MORE_UV_SETS,
    MORPH_TARGETS,
    OCCLUSION,
    POINTS,
    SKINS,
    VERTEX_COLORS,
    FEATURE_COUNT
} feature;

/* name, verdict, and the note behind the count: "3 primitives" + note. */
static const struct {
    const char *name;
    int32_t verdict;
    const char *counted;
    const char *note;
} rows[FEATURE_COUNT] = {
    [ALPHA_BLEND] = {"alpha BLEND", PPM_FEATURE_HONOURED, "materials", ""},
    [ALPHA_MASK] = {"alpha MASK", PPM_FEATURE_HONOURED, "materials", ""},
    [ANIMATIONS] = {"animations", PPM_FEATURE_HONOURED, "animations", ""},
    [LIGHT_RANGES] = {"light ranges", PPM_FEATURE_IGNORED, "lights",
                      ": light falls off with the square of the distance without end"},
    [LINES] = {"lines", PPM_FEATURE_APPROXIMATED, "primitives",
               ": round segments, as thick as 0.4 % of their mesh's diagonal"},
    [MORE_COLORS] = {"COLOR_1 and further", PPM_FEATURE_IGNORED, "primitives",
                     ": the specification gives them no meaning"},
    [MORE_UV_SETS] = {"TEXCOORD_8 and further", PPM_FEATURE_IGNORED, "primitives",
                      ": TEXCOORD_7 is the last that is read"},
    [MORPH_TARGETS] = {"morph targets", PPM_FEATURE_HONOURED, "primitives", ""},
    [OCCLUSION] = {"occlusion textures", PPM_FEATURE_APPROXIMATED, "materials",
                   ": not used; the light that surfaces keep from each other is computed"},
    [POINTS] = {"points", PPM_FEATURE_APPROXIMATED, "primitives",
                ": balls, as wide as 0.4 % of their mesh's diagonal"},
    [SKINS] = {"skins", PPM_FEATURE_HONOURED, "skins", ""},
    [VERTEX_COLORS] = {"vertex colours", PPM_FEATURE_HONOURED, "primitives", ""},
};

/* Whether the primitive has an attribute PREFIX_n with n of at least first. */
static bool has_set(const ppmi_gltf_primitive *primitive, const char *prefix, int first)
{
    const size_t length = strlen(prefix);
    for (uint32_t i = 0; i < primitive->attribute_count; ++i) {
        int set;
        if (strncmp(primitive->attributes[i].name, prefix, length) != 0) continue;
        if (sscanf(primitive->attributes[i].name + length, "%4d", &set) == 1 && set >= first) {
            return true;
        }
    }
    return false;
}

static void count_primitive(const ppmi_gltf_primitive *primitive, size_t counts[FEATURE_COUNT])
{
    const bool is_point = primitive->mode == 0;
    counts[POINTS] += is_point;
    counts[LINES] += !is_point && primitive->mode < PPMI_GLTF_TRIANGLES;
    counts[MORPH_TARGETS] += primitive->target_count > 0;
    counts[VERTEX_COLORS] += has_set(primitive, "COLOR_", 0);
    counts[MORE_COLORS] += has_set(primitive, "COLOR_", 1);
    counts[MORE_UV_SETS] += has_set(primitive, "TEXCOORD_", PPM_MAX_UV_SETS);
}

static void count_material(const ppmi_gltf_material *material, size_t counts[FEATURE_COUNT])
{
    counts[ALPHA_BLEND] += strcmp(material->alpha_mode, "BLEND") == 0;
    counts[ALPHA_MASK] += strcmp(material->alpha_mode, "MASK") == 0;
    counts[OCCLUSION] += material->has_occlusion;
}

void ppmi_gltf_note_core_features(ppmi_gltf_reader *reader)
{
    const ppmi_gltf_document *document = reader->document;
    size_t counts[FEATURE_COUNT] = {0};
    char note[160];
    for (size_t i = 0; i < document->mesh_count; ++i) {
        for (uint32_t k = 0; k < document->meshes[i].primitive_count; ++k) {
            count_primitive(&document->meshes[i].primitives[k], counts);
        }
    }
    for (size_t i = 0; i < document->material_count; ++i) {
        count_material(&document->materials[i], counts);
    }
    for (size_t i = 0; i < document->light_count; ++i) {
        counts[LIGHT_RANGES] += document->lights[i].range_m > 0.0;
    }
    counts[ANIMATIONS] = reader->outline.lists[PPMI_GLTF_ANIMATIONS].count;
    counts[SKINS] = reader->outline.lists[PPMI_GLTF_SKINS].count;
    for (size_t i = 0; i < FEATURE_COUNT; ++i) {
        if (counts[i] == 0) continue;
        const int length = (int)strlen(rows[i].counted) - (counts[i] == 1); /* without the s */
        snprintf(note, sizeof note, "%zu %.*s%s", counts[i], length, rows[i].counted, rows[i].note);
        ppmi_gltf_note_feature(reader, rows[i].name, rows[i].verdict, note);
    }
}
