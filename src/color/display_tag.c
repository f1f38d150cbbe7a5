/* Names of display spaces in the configurations in use: "sRGB - Display", "Rec.1886 Rec.709 -
 * Display" (ASWF), "Output - P3D65 ST2084 (1000 nits)" (ACES 1.x), "Filmic sRGB" (Blender). */
#include "color/display_tag.h"

#include <ctype.h>
#include <string.h>

#include "color/handle.h"

/* Letters and digits in lower case. */
static void simplify(const char *name, char *out, size_t size)
{
    size_t length = 0;
    for (; *name && length + 1 < size; name++) {
        if (isalnum((unsigned char)*name)) out[length++] = (char)tolower((unsigned char)*name);
    }
    out[length] = '\0';
}

/* The first row counts whose words are all in the name. */
static const ppmi_display_tag *find(const char *name)
{
    static const struct {
        const char *words[2];
        ppmi_display_tag tag;
    } rows[] = {
        {{"lin", NULL}, {.name = NULL}}, /* scene-linear: not of a display */
        {{"st2084", "p3"},
         {"P3-D65 PQ", &ppmi_primaries_p3_d65, PPMI_CURVE_HDR, 0, {12, 16, 0, 1}, false}},
        {{"pq", "p3"},
         {"P3-D65 PQ", &ppmi_primaries_p3_d65, PPMI_CURVE_HDR, 0, {12, 16, 0, 1}, false}},
        {{"st2084", NULL},
         {"Rec.2100 PQ", &ppmi_primaries_rec2020, PPMI_CURVE_HDR, 0, {9, 16, 0, 1}, false}},
        {{"pq", NULL},
         {"Rec.2100 PQ", &ppmi_primaries_rec2020, PPMI_CURVE_HDR, 0, {9, 16, 0, 1}, false}},
        {{"hlg", NULL},
         {"Rec.2100 HLG", &ppmi_primaries_rec2020, PPMI_CURVE_HDR, 0, {9, 18, 0, 1}, false}},
        {{"displayp3", NULL},
         {"Display P3", &ppmi_primaries_p3_d65, PPMI_CURVE_SRGB, 0, {12, 13, 0, 1}, false}},
        {{"p3d65", NULL},
         {"P3-D65 gamma 2.6", &ppmi_primaries_p3_d65, PPMI_CURVE_POWER, 2.6, {0}, false}},
        {{"p3", NULL}, {.name = NULL}}, /* of another white */
        {{"2020", NULL},
         {"Rec.2020 gamma 2.4",
          &ppmi_primaries_rec2020,
          PPMI_CURVE_POWER,
          2.4,
          {9, 14, 0, 1},
          false}},
        {{"gamma22", NULL},
         {"Rec.709 gamma 2.2", &ppmi_primaries_rec709, PPMI_CURVE_POWER, 2.2, {1, 4, 0, 1}, false}},
        {{"1886", NULL},
         {"Rec.709 gamma 2.4", &ppmi_primaries_rec709, PPMI_CURVE_POWER, 2.4, {1, 1, 0, 1}, false}},
        {{"rec709", NULL},
         {"Rec.709 gamma 2.4", &ppmi_primaries_rec709, PPMI_CURVE_POWER, 2.4, {1, 1, 0, 1}, false}},
        {{"srgb", NULL}, {"sRGB", &ppmi_primaries_rec709, PPMI_CURVE_SRGB, 0, {1, 13, 0, 1}, true}},
    };
    char simple[128];
    simplify(name, simple, sizeof simple);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const char *const second = rows[i].words[1];
        if (strstr(simple, rows[i].words[0]) && (!second || strstr(simple, second))) {
            return &rows[i].tag;
        }
    }
    return NULL;
}

const ppmi_display_tag *ppmi_display_tag_of_names(const char *space, const char *display)
{
    const ppmi_display_tag *tag = find(space);
    if (!tag && display) tag = find(display);
    return tag && tag->name ? tag : NULL;
}

const ppmi_display_tag *ppmi_color_display_tag(const ppm_color *color,
                                               const ppmi_view_choice *choice)
{
    ppmi_view_names names;
    if (ppmi_color_choose_view(NULL, color, choice, &names) != PPM_STATUS_OK) return NULL;
    const char *const space = ppmi_ocio_view_space(color->config, names.display, names.view);
    if (!space || ppmi_ocio_space_is_data(color->config, space)) return NULL;
    return ppmi_display_tag_of_names(space, names.display);
}
