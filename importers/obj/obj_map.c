#include "obj/obj_map.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "obj/obj_lines.h"
#include "obj/obj_number.h"
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

/* What the options of a statement say together. */
typedef struct options {
    ppmi_obj_map *map;
    bool is_off_u, is_off_v; /* blending */
    bool is_behind;          /* the name came already */
} options;

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

/* A number in points or with a decimal comma, made finite. */
static bool read_number(rest word, ppmi_obj_map *map, float *out)
{
    char text[64];
    const int kind = ppmi_obj_number_kind(word.text, word.length);
    if (kind != PPMI_OBJ_NUMBER && kind != PPMI_OBJ_DECIMAL_COMMA) return false;
    if (word.length >= sizeof text) return false;
    memcpy(text, word.text, word.length);
    if (ppmi_obj_mend_commas(text, word.length)) map->has_comma = true;
    float value = 0.0f;
    const bool is_read = ppmi_obj_parse_floats(text, word.length, &value, 1) == 1;
    *out = is_read && isfinite(value) ? value : 0.0f;
    return true;
}

/* Up to count numbers, which may be fewer; how many there were. Finite. */
static int take_numbers(rest *r, ppmi_obj_map *map, float *out, int count)
{
    int found = 0;
    while (found < count) {
        rest ahead = *r;
        if (!read_number(take_word(&ahead), map, &out[found])) break;
        ++found;
        *r = ahead;
    }
    return found;
}

/* on or off; with neither behind it, what is there is the name, and the option means on. */
static bool take_switch(rest *r)
{
    rest ahead = *r;
    const rest word = take_word(&ahead);
    const bool is_on = equals(word, "on") || equals(word, "1") || equals(word, "true");
    const bool is_off = equals(word, "off") || equals(word, "0") || equals(word, "false");
    if (is_on || is_off) *r = ahead;
    return !is_off;
}

static void take_channel(rest *r, ppmi_obj_map *map)
{
    rest ahead = *r;
    const rest word = take_word(&ahead);
    const char c = word.length == 1 ? (char)(word.text[0] | 0x20) : 0;
    if (c == 0 || !strchr("rgbmlz", c)) return;
    if (c != 'z') map->channel = c;
    *r = ahead;
}

/* An argument that may be any word: not the last one, which is the name. */
static rest take_argument(rest *r, const options *o)
{
    rest ahead = *r;
    const rest word = take_word(&ahead);
    if (ahead.length == 0 && !o->is_behind) return (rest){r->text, 0};
    *r = ahead;
    return word;
}

/* Options that change nothing: -cc corrects for screens of then, -boost sharpens filtered images,
 * -texres rescales them, -type is of reflection maps. */
static bool take_idle(rest word, rest *r, options *o)
{
    float number;
    if (equals(word, "-cc")) {
        take_switch(r);
    } else if (equals(word, "-boost") || equals(word, "-texres")) {
        take_numbers(r, o->map, &number, 1);
    } else if (equals(word, "-type")) {
        take_argument(r, o);
    } else {
        return false;
    }
    return true;
}

/* Options of numbers. */
static bool take_values(rest word, rest *r, ppmi_obj_map *map)
{
    float numbers[3] = {0.0f, 0.0f, 0.0f};
    if (equals(word, "-s")) {
        const int count = take_numbers(r, map, numbers, 3);
        map->scale[0] = count > 0 ? numbers[0] : 1.0f;
        map->scale[1] = count > 1 ? numbers[1] : 1.0f;
    } else if (equals(word, "-o")) {
        take_numbers(r, map, numbers, 3);
        memcpy(map->offset, numbers, sizeof map->offset);
    } else if (equals(word, "-t")) {
        take_numbers(r, map, numbers, 3);
        map->has_turbulence = numbers[0] != 0.0f || numbers[1] != 0.0f || numbers[2] != 0.0f;
    } else if (equals(word, "-mm")) {
        const int count = take_numbers(r, map, numbers, 2);
        map->base = numbers[0];
        map->gain = count > 1 ? numbers[1] : 1.0f;
    } else if (equals(word, "-bm")) {
        if (take_numbers(r, map, numbers, 1) == 1) map->bump = numbers[0];
    } else {
        return false;
    }
    return true;
}

/* Takes an option off the statement; false where the name begins. */
static bool take_option(rest *r, options *o)
{
    rest ahead = *r;
    const rest word = take_word(&ahead);
    if (equals(word, "-imfchan")) {
        take_channel(&ahead, o->map);
    } else if (equals(word, "-clamp")) {
        o->map->clamp = take_switch(&ahead);
    } else if (equals(word, "-blendu")) {
        o->is_off_u = !take_switch(&ahead);
    } else if (equals(word, "-blendv")) {
        o->is_off_v = !take_switch(&ahead);
    } else if (equals(word, "-colorspace")) {
        o->map->is_linear = equals(take_argument(&ahead, o), "linear");
    } else if (!take_values(word, &ahead, o->map) && !take_idle(word, &ahead, o)) {
        return false;
    }
    *r = ahead;
    return true;
}

static bool take_options(rest *r, options *o)
{
    while (r->length > 0 && take_option(r, o)) {
    }
    return r->length == 0;
}

/* ---- names ----------------------------------------------------------------------------------- */

/* Where options behind a name begin: nothing but options follows. The length where there are none;
 * takes them. */
static size_t find_options_behind(rest r, options *o)
{
    for (size_t i = 1; i < r.length; ++i) {
        if (r.text[i] != '-' || !ppmi_obj_is_blank(r.text[i - 1])) continue;
        ppmi_obj_map tried = *o->map;
        options trial = {&tried, o->is_off_u, o->is_off_v, true};
        rest tail = {r.text + i, r.length - i};
        if (!take_options(&tail, &trial)) continue;
        *o->map = tried;
        o->is_off_u = trial.is_off_u;
        o->is_off_v = trial.is_off_v;
        return i;
    }
    return r.length;
}

/* Takes the name in quotes that a statement begins with; what follows it is looked through for
 * options. False where there is none. */
static bool take_quoted(rest *r, options *o)
{
    const char *end =
        r->length > 2 && r->text[0] == '"' ? memchr(r->text + 1, '"', r->length - 1) : NULL;
    if (!end) return false;
    rest tail = {end + 1, r->length - (size_t)(end + 1 - r->text)};
    if (tail.length > 0 && !ppmi_obj_is_blank(tail.text[0])) return false;
    *r = (rest){r->text + 1, (size_t)(end - r->text) - 1};
    take_word(&tail); /* of no length: what is blank goes */
    o->is_behind = true;
    take_options(&tail, o);
    return true;
}

static bool read_map(ppm_context *context, const char *text, size_t length, bool is_behind,
                     ppmi_obj_map *map)
{
    rest r = {text, length};
    options o = {.map = map};
    ppmi_obj_map_deinit(context, map);
    *map = (ppmi_obj_map){.scale = {1.0f, 1.0f}, .gain = 1.0f, .bump = 1.0f};
    take_options(&r, &o);
    if (!take_quoted(&r, &o) && is_behind) r.length = find_options_behind(r, &o);
    while (r.length > 0 && ppmi_obj_is_blank(r.text[r.length - 1])) {
        --r.length;
    }
    map->is_sharp = o.is_off_u && o.is_off_v;
    if (r.length == 0) return true;
    map->name = ppmi_obj_utf8(context, r.text, r.length);
    return map->name != NULL;
}

bool ppmi_obj_map_read(ppm_context *context, const char *text, size_t length, ppmi_obj_map *map)
{
    return read_map(context, text, length, false, map);
}

bool ppmi_obj_map_read_behind(ppm_context *context, const char *text, size_t length,
                              ppmi_obj_map *map)
{
    return read_map(context, text, length, true, map);
}

bool ppmi_obj_map_may_hold_more(const ppmi_obj_map *map)
{
    for (const char *at = map->name; at && *at; ++at) {
        if (at > map->name && (*at == '#' || *at == '-') && ppmi_obj_is_blank(at[-1])) return true;
    }
    return false;
}

void ppmi_obj_map_deinit(ppm_context *context, ppmi_obj_map *map)
{
    ppmi_free(context, map->name);
    map->name = NULL;
}
