/* Material libraries (MTL): found beside the OBJ and cut into materials, each of which
 * tinyobjloader reads. What it would lose is seen to here: which statements there were, as the
 * default of a value is not the value. Maps are read by obj_map.c. */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "obj/obj_number.h"
#include "obj/obj_reader.h"

/* ---- statements of a material ---------------------------------------------------------------- */

/* One library on its way in. */
typedef struct library {
    ppmi_obj_reader *reader;
    ppmi_obj_lines lines;
    char *name; /* of the next material, as UTF-8; NULL: there is none */
    size_t name_line;
    uint32_t given;            /* by the statements of the current material */
    uint32_t greys;            /* those of them that are colours of one number */
    size_t stray;              /* statements before the first newmtl */
    size_t commas, comma_line; /* statements with decimal commas; the first one */
    char comma_before[48], comma_after[48];
    ppmi_obj_map maps[PPMI_OBJ_MAP_COUNT]; /* of the current material */
    ppm_status status;                     /* the first failure */
} library;

static void set_status(library *l, ppm_status status)
{
    if (l->status == PPM_STATUS_OK) l->status = status;
}

static uint32_t given_by(const char *word)
{
    static const struct {
        const char *word;
        uint32_t bit;
    } table[] = {
        {"Kd", PPMI_OBJ_HAS_KD},       {"Ks", PPMI_OBJ_HAS_KS},        {"Ke", PPMI_OBJ_HAS_KE},
        {"Tf", PPMI_OBJ_HAS_TF},       {"Kt", PPMI_OBJ_HAS_TF},        {"Ns", PPMI_OBJ_HAS_NS},
        {"d", PPMI_OBJ_HAS_D},         {"Tr", PPMI_OBJ_HAS_D},         {"Pr", PPMI_OBJ_HAS_PR},
        {"Pm", PPMI_OBJ_HAS_PM},       {"illum", PPMI_OBJ_HAS_ILLUM},  {"Ni", PPMI_OBJ_HAS_NI},
        {"Ps", PPMI_OBJ_HAS_PS},       {"Pc", PPMI_OBJ_HAS_PC},        {"Pcr", PPMI_OBJ_HAS_PCR},
        {"aniso", PPMI_OBJ_HAS_ANISO}, {"anisor", PPMI_OBJ_HAS_ANISOR}};
    for (size_t i = 0; i < sizeof table / sizeof table[0]; ++i) {
        if (strcmp(word, table[i].word) == 0) return table[i].bit;
    }
    return 0;
}

/* Whether nothing is lost: Ka is light that the renderer computes, sharpness is of reflection maps,
 * and antialiasing of textures is always on. */
static bool is_understood(const char *word)
{
    static const char *const words[] = {"Ka", "map_Ka", "sharpness", "map_aat"};
    if (given_by(word) != 0) return true;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        if (strcmp(word, words[i]) == 0) return true;
    }
    return false;
}

static void note_ignored(library *l, const char *word, size_t length)
{
    ppmi_obj_reader *r = l->reader;
    uint32_t index;
    char *text = ppmi_obj_utf8(r->context, word, length);
    if (!text || !ppmi_obj_names_add(r->context, &r->ignored, text, strlen(text), &index)) {
        set_status(l, ppmi_obj_out_of_memory(r));
    }
    ppmi_free(r->context, text);
}

/* Whether the first of up to count words is a number and none is what C writes for none. */
static bool are_numbers(char *text, size_t length, int count)
{
    for (int i = 0; i < count && length > 0; ++i) {
        char *rest = text;
        const size_t word = ppmi_obj_take_word(&rest, &length);
        const int kind = ppmi_obj_number_kind(text, word);
        if (kind == PPMI_OBJ_NOT_FINITE || (i == 0 && kind != PPMI_OBJ_NUMBER)) return false;
        if (kind != PPMI_OBJ_NUMBER) break;
        text = rest;
    }
    return true;
}

/* Whether a statement's values are numbers, which the parser would read as 0. A colour of one
 * number is a grey (MTL, "If only r is specified, then g, and b are assumed to be equal to r"); a
 * spectrum's file or a colour by CIE XYZ is no RGB, and is left out. */
static bool check_values(library *l, uint32_t bit, char *text, size_t length)
{
    const uint32_t colors = PPMI_OBJ_HAS_KD | PPMI_OBJ_HAS_KS | PPMI_OBJ_HAS_KE | PPMI_OBJ_HAS_TF;
    float rgb[3];
    if (bit == 0 || length == 0) return bit == 0 || !(bit & colors);
    if (!are_numbers(text, length, bit & colors ? 3 : 1)) return false;
    if (!(bit & colors)) return true;
    if (ppmi_obj_parse_floats(text, length, rgb, 3) == 1) {
        l->greys |= bit;
    } else {
        l->greys &= ~bit;
    }
    return true;
}

static void spread_grey(uint32_t greys, uint32_t bit, float color[3])
{
    if (greys & bit) color[1] = color[2] = color[0];
}

static void spread_greys(uint32_t greys, ppmi_obj_mtl *mtl)
{
    spread_grey(greys, PPMI_OBJ_HAS_KD, mtl->diffuse);
    spread_grey(greys, PPMI_OBJ_HAS_KS, mtl->specular);
    spread_grey(greys, PPMI_OBJ_HAS_KE, mtl->emission);
    spread_grey(greys, PPMI_OBJ_HAS_TF, mtl->transmittance);
}

/* Takes in a newmtl statement. */
static void begin_material(library *l, const char *text, size_t length)
{
    l->name = ppmi_obj_utf8(l->reader->context, text, length);
    l->name_line = l->lines.number;
    if (!l->name) set_status(l, ppmi_obj_out_of_memory(l->reader));
}

/* ---- values ---------------------------------------------------------------------------------- */

static void note_comma(library *l, const char *before, const char *after)
{
    if (l->commas++ > 0) return;
    l->comma_line = l->lines.number;
    snprintf(l->comma_before, sizeof l->comma_before, "%s", before);
    snprintf(l->comma_after, sizeof l->comma_after, "%s", after);
}

/* Brings the statement of a value, rest its words behind the first, to what the parser reads. */
static void mend_values(library *l, uint32_t bit, const char *text, char *rest, size_t *length)
{
    const size_t comment = ppmi_obj_comment_of_numbers(rest, *length);
    char before[48];
    if (comment < *length) ppmi_obj_cut(rest, length, comment);
    /* how opaque it is by the angle: the value alone is taken */
    const bool has_halo = bit == PPMI_OBJ_HAS_D && *length > 6 && memcmp(rest, "-halo ", 6) == 0;
    if (has_halo) {
        note_ignored(l, text, (size_t)(rest + 5 - text));
        memset(rest, ' ', 5);
    }
    snprintf(before, sizeof before, "%.*s", (int)(*length < 40 ? *length : 40), rest);
    if (memchr(rest, ',', *length) && ppmi_obj_mend_commas(rest, *length)) {
        char after[48];
        snprintf(after, sizeof after, "%.*s", (int)(*length < 40 ? *length : 40), rest);
        note_comma(l, before, after);
    }
}

static void warn_of_commas(const library *l)
{
    if (l->commas == 0) return;
    ppmi_log(l->reader->context, PPM_LOG_WARNING,
             "%s: line %zu: '%s' is read as '%s': %zu statement%s with commas in numbers, which "
             "MTL does not have",
             l->lines.path, l->comma_line, l->comma_before, l->comma_after, l->commas,
             l->commas == 1 ? "" : "s");
}

/* ---- maps ------------------------------------------------------------------------------------ */

/* Whether there is the file that a map names. */
static bool is_there(library *l, const ppmi_obj_map *map)
{
    char *path;
    bool is_elsewhere;
    if (!map->name) return false;
    set_status(l, ppmi_obj_find_file(l->reader, l->lines.path, map->name, &path, &is_elsewhere));
    ppmi_free(l->reader->context, path);
    return path != NULL;
}

typedef bool (*read_map_fn)(ppm_context *, const char *, size_t, ppmi_obj_map *);

/* Reads a map; whether there is its file. */
static bool try_map(library *l, read_map_fn read, const char *text, size_t length,
                    ppmi_obj_map *map)
{
    if (!read(l->reader->context, text, length, map)) {
        set_status(l, ppmi_obj_out_of_memory(l->reader));
    }
    return is_there(l, map);
}

/* A name may hold blanks, '#' and '-': it is taken as it stands where there is such a file, else
 * with options behind it, else the same without the last comment, and so on. */
static void take_map(library *l, ppmi_obj_map *map, const char *text, size_t length)
{
    if (!ppmi_obj_map_read(l->reader->context, text, length, map)) {
        set_status(l, ppmi_obj_out_of_memory(l->reader));
    }
    for (size_t end = length, next; l->status == PPM_STATUS_OK; end = next) {
        if (!ppmi_obj_map_may_hold_more(map) || try_map(l, ppmi_obj_map_read, text, end, map) ||
            try_map(l, ppmi_obj_map_read_behind, text, end, map)) {
            break;
        }
        next = ppmi_obj_name_without_comment(text, end);
        if (next == end) {
            try_map(l, ppmi_obj_map_read, text, length, map); /* missing, as it stands */
            break;
        }
        try_map(l, ppmi_obj_map_read, text, next, map);
    }
    map->line = l->lines.number;
    if (map->has_comma) note_comma(l, "-o 0,5 and the like", "-o 0.5");
}

/* ---- statements ------------------------------------------------------------------------------ */

/* Takes in a statement; *out_text is what is left for the parser, NULL for nothing. */
static void take_statement(library *l, char *text, size_t *length, char **out_text)
{
    char *rest = text, word[16] = {0};
    size_t rest_length = *length;
    const size_t word_length = ppmi_obj_take_word(&rest, &rest_length);
    memcpy(word, text, word_length < sizeof word ? word_length : sizeof word - 1);
    *out_text = NULL;
    if (strcmp(word, "newmtl") == 0) {
        begin_material(l, rest, rest_length);
        return;
    }
    l->stray++;
    const int32_t map = ppmi_obj_map_find(word);
    if (map >= 0) {
        take_map(l, &l->maps[map], rest, rest_length);
        return;
    }
    const uint32_t bit = given_by(word);
    if (bit != 0) mend_values(l, bit, text, rest, &rest_length);
    *length = (size_t)(rest - text) + rest_length;
    while (rest_length > 0 && ppmi_obj_is_blank(*rest)) { /* where an option was */
        ++rest;
        --rest_length;
    }
    if (!check_values(l, bit, rest, rest_length)) {
        note_ignored(l, text, *length);
        return;
    }
    l->given |= bit;
    if (!is_understood(word)) note_ignored(l, text, word_length);
    *out_text = text;
}

/* ppmi_obj_next_fn: the statements up to the next newmtl or the end. */
static char *next_of_material(void *user, size_t *out_length)
{
    library *l = user;
    while (l->status == PPM_STATUS_OK) {
        char *left, *text = ppmi_obj_lines_next(&l->lines, out_length);
        if (!text) return NULL;
        take_statement(l, text, out_length, &left);
        if (left) return left;
        if (l->name) return NULL;
    }
    return NULL;
}

static void forget_maps(library *l)
{
    for (int i = 0; i < PPMI_OBJ_MAP_COUNT; ++i) {
        ppmi_obj_map_deinit(l->reader->context, &l->maps[i]);
    }
}

/* ---- names with comments --------------------------------------------------------------------- */

/* The length of a name without all of its comments. */
static size_t shortest(const char *name, size_t length)
{
    for (size_t next; (next = ppmi_obj_name_without_comment(name, length)) < length;) {
        length = next;
    }
    return length;
}

static bool find_commented(const ppmi_obj_reader *r, const char *name, uint32_t *out_index)
{
    uint32_t number;
    if (!ppmi_obj_names_find(&r->commented, name, &number)) return false;
    *out_index = ((const uint32_t *)r->commented_ids.items)[number];
    return true;
}

bool ppmi_obj_find_material(const ppmi_obj_reader *r, const char *name, uint32_t *out_index)
{
    if (ppmi_obj_names_find(&r->library_materials, name, out_index)) return true;
    if (find_commented(r, name, out_index)) return true;
    char *copy = ppmi_string_copy(r->context, name);
    size_t length = copy ? strlen(copy) : 0;
    bool is_found = false;
    for (size_t next; !is_found && length > 0; length = next) {
        next = ppmi_obj_name_without_comment(copy, length);
        if (next == length) break;
        copy[next] = 0;
        is_found = ppmi_obj_names_find(&r->library_materials, copy, out_index) ||
                   find_commented(r, copy, out_index);
    }
    ppmi_free(r->context, copy);
    return is_found;
}

size_t ppmi_obj_material_name_length(const ppmi_obj_reader *r, uint32_t index)
{
    const char *name = ppmi_obj_names_get(&r->library_materials, index);
    const size_t all = strlen(name), length = ppmi_obj_plain_name_length(name, all);
    char *plain = length > 0 && length < all ? ppmi_string_copy(r->context, name) : NULL;
    if (!plain) return all;
    uint32_t other;
    plain[length] = 0;
    const bool is_taken = ppmi_obj_names_find(&r->library_materials, plain, &other) ||
                          (find_commented(r, plain, &other) && other != index);
    ppmi_free(r->context, plain);
    return is_taken ? all : length;
}

/* ---- a library ------------------------------------------------------------------------------- */

/* Notes the name of a library's material without its comment, where it has one and no other has
 * that name. False when memory is out. */
static bool note_commented(ppmi_obj_reader *r, const char *name, uint32_t index)
{
    const size_t all = strlen(name), length = shortest(name, all);
    if (length == all || length == 0) return true;
    uint32_t number;
    const uint32_t known = ppmi_obj_names_count(&r->commented);
    if (!ppmi_obj_names_add(r->context, &r->commented, name, length, &number)) return false;
    if (number < known) return true;
    uint32_t *id = ppmi_obj_push(r->context, &r->commented_ids, 1, sizeof *id);
    if (id) *id = index;
    return id != NULL;
}

/* Keeps a material, unless one of its name was there before. */
static ppm_status keep_material(ppmi_obj_reader *r, const char *name,
                                const ppmi_obj_material *material, bool *out_is_kept)
{
    uint32_t index;
    const uint32_t known = ppmi_obj_names_count(&r->library_materials);
    if (!ppmi_obj_names_add(r->context, &r->library_materials, name, strlen(name), &index)) {
        return ppmi_obj_out_of_memory(r);
    }
    if (index < known) {
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: line %zu: material '%s' left out: there was one of that name before",
                 ppmi_obj_names_get(&r->libraries, material->library), material->line, name);
        return PPM_STATUS_OK;
    }
    ppmi_obj_material *added = ppmi_obj_push(r->context, &r->materials, 1, sizeof *added);
    if (!added || !note_commented(r, name, index)) return ppmi_obj_out_of_memory(r);
    *added = *material;
    *out_is_kept = true;
    return PPM_STATUS_OK;
}

void ppmi_obj_material_deinit(ppm_context *context, ppmi_obj_material *material)
{
    ppmi_obj_mtl_destroy(material->mtl);
    for (int i = 0; i < PPMI_OBJ_MAP_COUNT; ++i) {
        ppmi_obj_map_deinit(context, &material->maps[i]);
    }
}

/* Reads the statements behind a newmtl; name becomes the next material's. */
static ppm_status read_material(library *l, uint32_t index)
{
    ppmi_obj_reader *r = l->reader;
    char *name = l->name;
    ppmi_obj_material material = {.library = index, .line = l->name_line};
    l->name = NULL;
    l->given = l->greys = 0;
    ppmi_obj_mtl *mtl = NULL;
    ppm_status status = ppmi_obj_mtl_create(r->context, l->lines.path, next_of_material, l, &mtl);
    if (status == PPM_STATUS_OK) spread_greys(l->greys, mtl);
    material.mtl = mtl;
    material.given = l->given;
    memcpy(material.maps, l->maps, sizeof material.maps);
    memset(l->maps, 0, sizeof l->maps);
    bool is_kept = false;
    if (status == PPM_STATUS_OK) status = keep_material(r, name, &material, &is_kept);
    if (!is_kept) ppmi_obj_material_deinit(r->context, &material);
    ppmi_free(r->context, name);
    set_status(l, status);
    set_status(l, l->lines.status);
    return l->status;
}

/* Skips what is before the first newmtl. */
static void skip_stray(library *l)
{
    size_t length;
    while (!l->name && next_of_material(l, &length)) {
    }
    forget_maps(l);
    if (l->stray > 0) {
        ppmi_log(l->reader->context, PPM_LOG_WARNING,
                 "%s: %zu statements before the first newmtl left out", l->lines.path, l->stray);
    }
    set_status(l, l->lines.status);
}

static ppm_status read_library(ppmi_obj_reader *r, const char *path)
{
    uint32_t index;
    const uint32_t known = ppmi_obj_names_count(&r->libraries);
    if (!ppmi_obj_names_add(r->context, &r->libraries, path, strlen(path), &index)) {
        return ppmi_obj_out_of_memory(r);
    }
    if (index < known) return PPM_STATUS_OK; /* it was read before */
    library l = {.reader = r};
    l.status = ppmi_obj_lines_open(r->context, path, &l.lines);
    if (l.status == PPM_STATUS_OK) skip_stray(&l);
    while (l.status == PPM_STATUS_OK && l.name) {
        read_material(&l, index);
    }
    ppmi_free(r->context, l.name);
    forget_maps(&l);
    warn_of_commas(&l);
    ppmi_obj_lines_close(&l.lines);
    return l.status;
}

/* ---- mtllib ---------------------------------------------------------------------------------- */

/* Reads the file of a name if there is one. */
static ppm_status try_library(ppmi_obj_reader *r, const char *name, bool *out_is_found)
{
    char *path;
    bool is_elsewhere;
    ppm_status status = ppmi_obj_find_file(r, r->path, name, &path, &is_elsewhere);
    *out_is_found = path != NULL;
    if (!path) return status;
    if (is_elsewhere) {
        ppmi_log(r->context, PPM_LOG_WARNING, "%s: mtllib '%s': read from %s", r->path, name, path);
    }
    status = read_library(r, path);
    ppmi_free(r->context, path);
    return status;
}

/* Length of the first name of a list: up to a blank behind ".mtl", since names may hold blanks. */
static size_t name_length(const char *names)
{
    const size_t all = strlen(names);
    for (size_t i = 4; i < all; ++i) {
        if (ppmi_obj_is_blank(names[i]) && strncasecmp(names + i - 4, ".mtl", 4) == 0) return i;
    }
    return all;
}

static void warn_of_missing(const ppmi_obj_reader *r, const char *name)
{
    ppmi_log(r->context, PPM_LOG_WARNING,
             "%s: mtllib '%s' left out: there is no such file in the folder of the OBJ, nor in a "
             "texture path",
             r->path, name);
}

/* A name; if there is no such file, each of its words but those of a comment. */
static ppm_status read_named(ppmi_obj_reader *r, char *name)
{
    bool is_found, is_any = false;
    ppm_status status = try_library(r, name, &is_found);
    if (is_found || status != PPM_STATUS_OK || *name == '#') return status;
    name[shortest(name, strlen(name))] = 0;
    char *word = strchr(name, ' ') ? name : NULL;
    while (word && status == PPM_STATUS_OK) {
        char *end = strchr(word, ' ');
        if (end) *end = 0;
        status = *word ? try_library(r, word, &is_found) : PPM_STATUS_OK;
        is_any = is_any || is_found;
        if (end) *end = ' ';
        word = end ? end + 1 : NULL;
    }
    if (!is_any && status == PPM_STATUS_OK) warn_of_missing(r, name);
    return status;
}

static ppm_status read_list(ppmi_obj_reader *r, char *names)
{
    ppm_status status = PPM_STATUS_OK;
    if (!*names) warn_of_missing(r, "");
    while (*names && status == PPM_STATUS_OK) {
        char *end = names + name_length(names);
        const bool is_last = *end == 0;
        *end = 0;
        status = read_named(r, names);
        if (*names == '#') break; /* a comment, but for a file of that name */
        names = end + !is_last;
        while (ppmi_obj_is_blank(*names)) {
            ++names;
        }
    }
    return status;
}

ppm_status ppmi_obj_read_libraries(ppmi_obj_reader *r)
{
    ppm_status status = PPM_STATUS_OK;
    const uint32_t count = ppmi_obj_names_count(&r->library_names);
    for (uint32_t i = 0; i < count && status == PPM_STATUS_OK; ++i) {
        char *names = ppmi_string_copy(r->context, ppmi_obj_names_get(&r->library_names, i));
        if (!names) return ppmi_obj_out_of_memory(r);
        status = read_list(r, names);
        ppmi_free(r->context, names);
    }
    return status;
}
