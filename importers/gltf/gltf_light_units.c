/* Khronos' Blender exporter: until Blender 3.3 it wrote watts as they stood, since 3.4 it
 * multiplies by 683 lm/W and divides point and spot lights by 4 pi (its pull request 1760).
 * From 5.0 on every lamp has a node tree; until the change of 5.1.2 (its pull request 2684, issue
 * 2709) a sun's strength was then that of the node, 1 unless somebody changed it. The add-on's
 * version does not tell 5.1.0 from 5.1.2. */
#include "gltf/gltf_light_units.h"

#include <stddef.h>
#include <string.h>

#include "gltf/gltf_shim.h"
#include "ppm/import.h"

#define PI 3.14159265358979323846
/* what Blender's exporter takes for the luminous efficacy of a watt */
#define LUMENS_PER_WATT 683.0

#define BLENDER "Khronos glTF Blender I/O"
enum { ANY_LATER = 1 << 20 };

static const ppmi_gltf_unit_row rows[] = {
    {BLENDER, {0, 0}, {3, 4}, PPM_LIGHT_UNITS_RAW, false, "Blender's exporter before 3.4"},
    {BLENDER, {3, 4}, {5, 0}, PPM_LIGHT_UNITS_BLENDER, false, "Blender's exporter, 3.4 to 4.5"},
    {BLENDER, {5, 0}, {5, 2}, PPM_LIGHT_UNITS_BLENDER, true, "Blender's exporter, 5.0 and 5.1"},
    {BLENDER,
     {5, 2},
     {ANY_LATER, 0},
     PPM_LIGHT_UNITS_BLENDER,
     false,
     "Blender's exporter since 5.2"},
};

/* A version's next number; at most six digits, since more is no version. */
static bool take_number(const char **text, int32_t *out)
{
    int digits = 0;
    *out = 0;
    for (; **text >= '0' && **text <= '9'; ++*text) {
        if (++digits > 6) return false;
        *out = 10 * *out + (**text - '0');
    }
    return digits > 0;
}

/* major.minor behind a "v"; what has none is as new as can be. */
static void read_version(const char *text, int32_t out[2])
{
    out[0] = ANY_LATER - 1;
    out[1] = 0;
    int32_t major, minor;
    while (*text == ' ' || *text == 'v')
        ++text;
    if (!take_number(&text, &major) || *text++ != '.' || !take_number(&text, &minor)) return;
    out[0] = major;
    out[1] = minor;
}

static bool is_before(const int32_t a[2], const int32_t b[2])
{
    return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
}

const ppmi_gltf_unit_row *ppmi_gltf_find_units(const char *generator)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
        const char *found = strstr(generator, rows[i].generator);
        int32_t version[2];
        if (!found) continue;
        read_version(found + strlen(rows[i].generator), version);
        if (!is_before(version, rows[i].from) && is_before(version, rows[i].to)) return &rows[i];
    }
    return NULL;
}

double ppmi_gltf_unit_factor(int32_t units, int32_t kind)
{
    switch (units) {
    case PPM_LIGHT_UNITS_BLENDER:
        return 1.0 / LUMENS_PER_WATT;
    case PPM_LIGHT_UNITS_RAW:
        return kind == PPMI_GLTF_LIGHT_DIRECTIONAL ? 1.0 : 0.25 / PI;
    default:
        return 1.0;
    }
}

double ppmi_gltf_watt_factor(int32_t units)
{
    return units == PPM_LIGHT_UNITS_GLTF ? LUMENS_PER_WATT : 1.0;
}

double ppmi_gltf_candela_factor(int32_t units)
{
    return units == PPM_LIGHT_UNITS_GLTF ? 1.0 : 1.0 / LUMENS_PER_WATT;
}
