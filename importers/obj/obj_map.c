#include "obj/obj_map.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "obj/obj_lines.h"
#include "obj/obj_shim.h"
#include "obj/obj_tables.h"

/* The first word of each map is its usual one. */
static const struct {
    const char *word;
    int32_t map;
} words[] = {{"map_Kd", PPMI_OBJ_MAP_KD},       {"map_Ks", PPMI_OBJ_MAP_KS},
             {"map_Ke", PPMI_OBJ_MAP_KE},       {"map_Ns", PPMI_OBJ_MAP_NS},
             {"map_d", PPMI_OBJ_MAP_D},         {"map_opacity", PPMI_OBJ_MAP_D},
             {"map_Tf", PPMI_OBJ_MAP_TF},       {"map_Pr", PPMI_OBJ_MAP_PR},
             {"map_Pm", PPMI_OBJ_MAP_PM},       {"map_Ps", PPMI_OBJ_MAP_PS},
             {"map_Pc", PPMI_OBJ_MAP_PC},       {"map_Pcr", PPMI_OBJ_MAP_PCR},
             {"map_aniso", PPMI_OBJ_MAP_ANISO}, {"map_anisor", PPMI_OBJ_MAP_ANISOR},
             {"norm", PPMI_OBJ_MAP_NORM},       {"map_norm", PPMI_OBJ_MAP_NORM},
             {"map_Kn", PPMI_OBJ_MAP_NORM},     {"map_Bump", PPMI_OBJ_MAP_BUMP},
             {"bump", PPMI_OBJ_MAP_BUMP},       {"disp", PPMI_OBJ_MAP_DISP},
             {"map_disp", PPMI_OBJ_MAP_DISP},   {"refl", PPMI_OBJ_MAP_REFL},
             {"map_refl", PPMI_OBJ_MAP_REFL}};

int32_t ppmi_obj_map_find(const char *word)
{
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        if (strcasecmp(word, words[i].word) == 0) return words[i].map;
    }
    return -1;
}

const char *ppmi_obj_map_word(int32_t map)
{
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        if (words[i].map == map) return words[i].word;
    }
    return "";
}

/* ---- options --------------------------------------------------------------------------------- */

/* What is left of a statement. */
typedef struct rest {
    const char *text;
    size_t length;
} rest;

static rest take_word(rest *r)
{
    rest word = {r->text, 0};
    while (word.length < r->length && !ppmi_obj_is_blank(word.text[word.length])) {
        ++word.length;
    }
    r->text += word.length;
    r->length -= word.length;
    while (r->length > 0 && ppmi_obj_is_blank(*r->text)) {
        ++r->text;
        --r->length;
    }
    return word;
}

static bool equals(rest word, const char *text)
{
    return word.length == strlen(text) && strncasecmp(word.text, text, word.length) == 0;
}

static bool is_number(rest word)
{
    for (size_t i = 0; i < word.length; ++i) {
        if (!memchr("0123456789+-.eE", word.text[i], 15)) return false;
    }
    return word.length > 0;
}

/* Up to count numbers, which may be fewer; how many there were. Finite. */
static int take_numbers(rest *r, float *out, int count)
{
    int found = 0;
    while (found < count) {
        rest ahead = *r;
        const rest word = take_word(&ahead);
        float value;
        if (!is_number(word) || ppmi_obj_parse_floats(word.text, word.length, &value, 1) != 1) {
            break;
        }
        out[found++] = isfinite(value) ? value : 0.0f;
        *r = ahead;
    }
    return found;
}

static bool take_switch(rest *r)
{
    const rest word = take_word(r);
    return equals(word, "on") || equals(word, "1") || equals(word, "true");
}

static void take_channel(rest *r, ppmi_obj_map *map)
{
    const rest word = take_word(r);
    const char c = word.length == 1 ? (char)(word.text[0] | 0x20) : 0;
    if (c != 0 && strchr("rgbml", c)) map->channel = c;
}

/* Options of one argument that change nothing: -cc corrects for screens of then, -boost sharpens
 * filtered images, -texres rescales them, -type is of reflection maps. */
static bool is_idle(rest word)
{
    return equals(word, "-cc") || equals(word, "-boost") || equals(word, "-texres") ||
           equals(word, "-type");
}

/* Whether blending is off in both directions is known at the end. */
typedef struct blending {
    bool is_off_u, is_off_v;
} blending;

/* Takes an option off the statement; false where the name begins. */
static bool take_option(rest *r, ppmi_obj_map *map, blending *blend)
{
    rest ahead = *r;
    const rest word = take_word(&ahead);
    float numbers[3] = {0.0f, 0.0f, 0.0f};
    if (equals(word, "-s")) {
        const int count = take_numbers(&ahead, numbers, 3);
        map->scale[0] = count > 0 ? numbers[0] : 1.0f;
        map->scale[1] = count > 1 ? numbers[1] : 1.0f;
    } else if (equals(word, "-o")) {
        take_numbers(&ahead, numbers, 3);
        memcpy(map->offset, numbers, sizeof map->offset);
    } else if (equals(word, "-t")) {
        take_numbers(&ahead, numbers, 3);
        map->has_turbulence = numbers[0] != 0.0f || numbers[1] != 0.0f || numbers[2] != 0.0f;
    } else if (equals(word, "-mm")) {
        const int count = take_numbers(&ahead, numbers, 2);
        map->base = numbers[0];
        map->gain = count > 1 ? numbers[1] : 1.0f;
    } else if (equals(word, "-bm")) {
        if (take_numbers(&ahead, numbers, 1) == 1) map->bump = numbers[0];
    } else if (equals(word, "-imfchan")) {
        take_channel(&ahead, map);
    } else if (equals(word, "-clamp")) {
        map->clamp = take_switch(&ahead);
    } else if (equals(word, "-blendu")) {
        blend->is_off_u = !take_switch(&ahead);
    } else if (equals(word, "-blendv")) {
        blend->is_off_v = !take_switch(&ahead);
    } else if (equals(word, "-colorspace")) {
        map->is_linear = equals(take_word(&ahead), "linear");
    } else if (is_idle(word)) {
        take_word(&ahead);
    } else {
        return false;
    }
    *r = ahead;
    return true;
}

bool ppmi_obj_map_read(ppm_context *context, const char *text, size_t length, ppmi_obj_map *map)
{
    rest r = {text, length};
    blending blend = {false, false};
    ppmi_obj_map_deinit(context, map);
    *map = (ppmi_obj_map){.scale = {1.0f, 1.0f}, .gain = 1.0f, .bump = 1.0f};
    while (take_option(&r, map, &blend)) {
    }
    map->is_sharp = blend.is_off_u && blend.is_off_v;
    const bool is_quoted = r.length > 2 && r.text[0] == '"' && r.text[r.length - 1] == '"';
    if (is_quoted) r = (rest){r.text + 1, r.length - 2};
    if (r.length == 0) return true;
    map->name = ppmi_obj_utf8(context, r.text, r.length);
    return map->name != NULL;
}

void ppmi_obj_map_deinit(ppm_context *context, ppmi_obj_map *map)
{
    ppmi_free(context, map->name);
    map->name = NULL;
}
