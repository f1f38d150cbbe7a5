/* The statements of an OBJ file, as "Object Files (.obj)", Alias|Wavefront, Advanced Visualizer,
 * appendix B, has them, and vertex colours behind the coordinates. Numbers and faces go through
 * tinyobjloader; names and state are read here. */
#include <math.h>
#include <string.h>

#include "obj/obj_number.h"
#include "obj/obj_reader.h"

static void fail(ppmi_obj_reader *r, ppm_status status, const char *reason)
{
    if (r->status != PPM_STATUS_OK) return;
    r->status = ppmi_fail(r->context, status, "%s: line %zu: %s", r->path, r->lines.number, reason);
}

static void invalid(ppmi_obj_reader *r, const char *reason)
{
    fail(r, PPM_STATUS_INPUT_INVALID, reason);
}

static void out_of_memory(ppmi_obj_reader *r)
{
    fail(r, PPM_STATUS_OUT_OF_MEMORY, "out of memory");
}

/* Room for one element of count floats; NULL after a failure. Indices are 32 bits with a sign. */
static float *push_floats(ppmi_obj_reader *r, ppmi_obj_array *array, size_t count)
{
    if (array->count >= INT32_MAX) {
        fail(r, PPM_STATUS_INPUT_UNSUPPORTED, "more than 2^31 elements of one kind");
        return NULL;
    }
    float *added = ppmi_obj_push(r->context, array, 1, count * sizeof *added);
    if (!added) out_of_memory(r);
    return added;
}

/* ---- vertices -------------------------------------------------------------------------------- */

/* A word that is not what it should be. */
static void invalid_word(ppmi_obj_reader *r, const char *what, const char *word, size_t length)
{
    if (r->status != PPM_STATUS_OK) return;
    const bool has_comma = ppmi_obj_number_kind(word, length) == PPMI_OBJ_DECIMAL_COMMA;
    r->status = ppmi_fail(r->context, PPM_STATUS_INPUT_INVALID,
                          "%s: line %zu: %s is not a number: '%.*s'%s", r->path, r->lines.number,
                          what, length < 40 ? (int)length : 40, word,
                          has_comma ? "; a decimal comma? OBJ has points" : "");
}

/* The next word of a statement; false at its end. */
static bool next_word(const char **at, const char **out_word, size_t *out_length)
{
    while (ppmi_obj_is_blank(**at)) {
        ++*at;
    }
    *out_word = *at;
    while (**at != '\n' && !ppmi_obj_is_blank(**at)) {
        ++*at;
    }
    *out_length = (size_t)(*at - *out_word);
    return *out_length > 0;
}

/* Looks through up to count numbers at *at, which moves behind them, since the parser takes what it
 * cannot read for 0: what is not finite becomes NaN. How many there are, -1 after a failure. */
static int check_numbers(ppmi_obj_reader *r, const char *what, const char **at, float *values,
                         int count)
{
    const char *word;
    size_t length;
    for (int i = 0; i < count; ++i) {
        if (!next_word(at, &word, &length)) return i;
        const int kind = ppmi_obj_number_kind(word, length);
        if (kind == PPMI_OBJ_NOT_FINITE) {
            values[i] = NAN;
        } else if (kind != PPMI_OBJ_NUMBER) {
            invalid_word(r, what, word, length);
            return -1;
        }
    }
    return count;
}

/* Whether a word is a number with a decimal comma. */
static bool has_comma(const char *text, size_t length)
{
    const char *word;
    size_t word_length;
    if (!memchr(text, ',', length)) return false;
    while (next_word(&text, &word, &word_length)) {
        if (ppmi_obj_number_kind(word, word_length) == PPMI_OBJ_DECIMAL_COMMA) return true;
    }
    return false;
}

/* Colours of three or more numbers behind the coordinates; one number is a weight of free-form
 * geometry. White for vertices without one, once a vertex had one. */
static void read_color(ppmi_obj_reader *r, const char *text)
{
    float color[3];
    const size_t left = (size_t)(r->text + r->text_length - text);
    const bool has_color = left > 0 && ppmi_obj_parse_floats(text, left, color, 3) == 3;
    if (left > 0 && !has_color && has_comma(text, left)) {
        invalid_word(r, "a vertex colour", text + 1, left - 1);
        return;
    }
    if (!has_color && r->colors.count == 0) return;
    const size_t missing = r->positions.count - r->colors.count;
    float *colors = ppmi_obj_push(r->context, &r->colors, missing, 3 * sizeof *colors);
    if (!colors) {
        out_of_memory(r);
        return;
    }
    for (size_t i = 0; i < 3 * missing; ++i) {
        colors[i] = 1.0f;
    }
    if (has_color) memcpy(colors + 3 * (missing - 1), color, sizeof color);
}

static void receive_position(void *user, const float xyz[3])
{
    ppmi_obj_reader *r = user;
    float checked[3] = {xyz[0], xyz[1], xyz[2]};
    const char *rest = r->text + 1;
    const int count = check_numbers(r, "a coordinate", &rest, checked, 3);
    if (count >= 0 && count < 3) invalid(r, "a vertex needs three coordinates");
    float *position = count == 3 ? push_floats(r, &r->positions, 3) : NULL;
    if (!position) return;
    memcpy(position, checked, sizeof checked);
    read_color(r, rest);
}

static void receive_uv(void *user, const float uv[2])
{
    ppmi_obj_reader *r = user;
    float checked[2] = {uv[0], uv[1]};
    const char *rest = r->text + 2;
    if (check_numbers(r, "a texture coordinate", &rest, checked, 2) < 0) return;
    if (isnan(checked[0]) || isnan(checked[1])) {
        r->tally.no_number_uvs++;
        memset(checked, 0, sizeof checked);
    }
    float *added = push_floats(r, &r->uvs, 2);
    if (added) memcpy(added, checked, sizeof checked);
}

/* One that is not finite has no length, and faces have their own in its place. */
static void receive_normal(void *user, const float xyz[3])
{
    ppmi_obj_reader *r = user;
    float checked[3] = {xyz[0], xyz[1], xyz[2]};
    const char *rest = r->text + 2;
    if (check_numbers(r, "a normal", &rest, checked, 3) < 0) return;
    if (isnan(checked[0]) || isnan(checked[1]) || isnan(checked[2])) {
        r->tally.no_number_normals++;
        memset(checked, 0, sizeof checked);
    }
    float *added = push_floats(r, &r->normals, 3);
    if (added) memcpy(added, checked, sizeof checked);
}

/* ---- faces ----------------------------------------------------------------------------------- */

/* The first fault of a kind. */
static void note_fault(const ppmi_obj_reader *r, ppmi_obj_fault *fault, const char *what)
{
    if (fault->line == 0) *fault = (ppmi_obj_fault){r->lines.number, what, r->kind};
}

/* From as written to from 0; 0, which is none, to -1. An index beyond the last element so far is
 * noted: it may still come. */
static void resolve(const ppmi_obj_reader *r, int32_t *index, size_t count, ppmi_obj_reach *reach,
                    ppmi_obj_fault *fault)
{
    if (*index > 0) {
        if ((size_t)*index > count && *index > reach->most) {
            *reach = (ppmi_obj_reach){*index, r->lines.number, r->kind};
        }
        --*index;
    } else if (*index == 0) {
        *index = -1;
    } else {
        const int64_t absolute = (int64_t)count + *index;
        if (absolute < 0)
            note_fault(r, fault, "a negative index that points before the first element");
        *index = absolute < 0 ? PPMI_OBJ_NOWHERE : (int32_t)absolute;
    }
}

static void resolve_corner(ppmi_obj_reader *r, ppmi_obj_corner *corner)
{
    if (corner->position == 0) {
        note_fault(r, &r->position_fault, "an index of 0 or one that is not a number");
    }
    resolve(r, &corner->position, r->positions.count, &r->position_reach, &r->position_fault);
    resolve(r, &corner->uv, r->uvs.count, &r->uv_reach, &r->uv_fault);
    resolve(r, &corner->normal, r->normals.count, &r->normal_reach, &r->normal_fault);
}

/* The number of the current node's name: "object", "group" or "object/group". */
static bool find_object(ppmi_obj_reader *r, uint32_t *out_index)
{
    const char *object = r->object ? r->object : "", *group = r->group ? r->group : "";
    const size_t object_length = strlen(object), group_length = strlen(group);
    const size_t slash = object_length > 0 && group_length > 0;
    const size_t length = object_length + slash + group_length;
    char *name = ppmi_alloc(r->context, length + 1, 1);
    if (!name) return false;
    memcpy(name, object, object_length);
    if (slash) name[object_length] = '/';
    memcpy(name + object_length + slash, group, group_length);
    const uint32_t known = ppmi_obj_names_count(&r->objects);
    const bool ok = ppmi_obj_names_add(r->context, &r->objects, name, length, out_index);
    ppmi_free(r->context, name);
    if (!ok || *out_index < known) return ok;
    size_t *kept = ppmi_obj_push(r->context, &r->object_lengths, 1, sizeof *kept);
    if (kept) *kept = object_length;
    return kept != NULL;
}

static bool begin_run(ppmi_obj_reader *r)
{
    uint32_t object;
    if (!find_object(r, &object)) return false;
    ppmi_obj_run *run = ppmi_obj_push(r->context, &r->runs, 1, sizeof *run);
    if (!run) return false;
    *run = (ppmi_obj_run){.object = object,
                          .material = r->material,
                          .smoothing = r->smoothing,
                          .kind = r->kind,
                          .first_face = r->faces.count,
                          .first_corner = r->corners.count,
                          .end_face = r->faces.count};
    r->is_new_run = false;
    return true;
}

/* Adds a face, a line or a row of points. */
static void add_element(ppmi_obj_reader *r, int32_t kind, const ppmi_obj_corner *corners,
                        size_t count)
{
    if (kind != r->kind) r->is_new_run = true;
    r->kind = kind;
    const bool has_run = !r->is_new_run || begin_run(r);
    uint32_t *face = has_run ? ppmi_obj_push(r->context, &r->faces, 1, sizeof *face) : NULL;
    ppmi_obj_corner *added =
        face ? ppmi_obj_push(r->context, &r->corners, count, sizeof *added) : NULL;
    if (!added) {
        out_of_memory(r);
        return;
    }
    *face = (uint32_t)count;
    ((ppmi_obj_run *)r->runs.items)[r->runs.count - 1].end_face = r->faces.count;
    for (size_t i = 0; i < count; ++i) {
        added[i] = corners[i];
        resolve_corner(r, &added[i]);
    }
}

static void receive_face(void *user, const ppmi_obj_corner *corners, size_t count)
{
    ppmi_obj_reader *r = user;
    if (r->status != PPM_STATUS_OK) return;
    if (r->is_broken_face) {
        r->tally.broken++;
        return;
    }
    if (count < 3) {
        r->tally.small_faces++;
        return;
    }
    if (r->smoothing != 0) r->has_smoothing = true;
    add_element(r, PPM_PRIMITIVE_TRIANGLES, corners, count);
}

static const char not_an_index[] = "an index that is not a number of at most nine digits";

/* An l or p statement, without its word. */
static void read_element(ppmi_obj_reader *r, int32_t kind, char *text, size_t length)
{
    bool is_valid;
    ppmi_obj_cut(text, &length, ppmi_obj_comment_of_numbers(text, length));
    if (!ppmi_obj_read_corners(r, text, length, &r->element, &is_valid)) {
        out_of_memory(r);
        return;
    }
    const size_t count = r->element.count;
    if (!is_valid) {
        r->tally.broken++;
        if (r->position_fault.line == 0) {
            r->position_fault = (ppmi_obj_fault){r->lines.number, not_an_index, kind};
        }
    } else if (count >= (kind == PPM_PRIMITIVE_LINES ? 2u : 1u)) {
        add_element(r, kind, r->element.items, count);
    } else {
        r->tally.short_lines++;
    }
}

/* ---- state ----------------------------------------------------------------------------------- */

static void set_name(ppmi_obj_reader *r, char **name, const char *text, size_t length)
{
    ppmi_free(r->context, *name);
    *name = NULL;
    r->is_new_run = true;
    if (length == 0) return;
    *name = ppmi_obj_utf8(r->context, text, length);
    if (!*name) out_of_memory(r);
}

static void set_group(ppmi_obj_reader *r, const char *text, size_t length)
{
    length = ppmi_obj_plain_name_length(text, length);
    const bool is_none = length == 7 && memcmp(text, "default", 7) == 0;
    set_name(r, &r->group, text, is_none ? 0 : length);
}

static void set_smoothing(ppmi_obj_reader *r, const char *text, size_t length)
{
    uint32_t group = 0;
    for (size_t i = 0; i < length && text[i] >= '0' && text[i] <= '9'; ++i) {
        group = group * 10u + (uint32_t)(text[i] - '0');
    }
    if (length >= 2 && memcmp(text, "on", 2) == 0) group = 1;
    r->smoothing = group;
    r->is_new_run = true;
}

static void set_material(ppmi_obj_reader *r, const char *text, size_t length)
{
    uint32_t index;
    char *name = ppmi_obj_utf8(r->context, text, length);
    if (!name || !ppmi_obj_names_add(r->context, &r->used_materials, name, strlen(name), &index)) {
        out_of_memory(r);
    } else {
        r->material = index + 1;
    }
    ppmi_free(r->context, name);
    r->is_new_run = true;
}

static void note_libraries(ppmi_obj_reader *r, const char *text, size_t length)
{
    uint32_t index;
    char *names = ppmi_obj_utf8(r->context, text, length);
    if (!names ||
        !ppmi_obj_names_add(r->context, &r->library_names, names, strlen(names), &index)) {
        out_of_memory(r);
    }
    ppmi_free(r->context, names);
}

/* ---- the rest -------------------------------------------------------------------------------- */

/* Statements that say nothing about polygons, or what a curve or surface counts for already. */
static bool is_harmless(const char *word)
{
    static const char *const words[] = {
        "vp",       "cstype", "deg",    "bmat",       "step",      "parm",  "trim",  "hole",
        "scrv",     "sp",     "end",    "con",        "mg",        "bevel", "lod",   "c_interp",
        "d_interp", "maplib", "usemap", "shadow_obj", "trace_obj", "ctech", "stech", "call",
        "csh",      "bsp",    "bzp",    "cdc",        "cdp",       "res",   "t"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; ++i) {
        if (strcmp(word, words[i]) == 0) return true;
    }
    return false;
}

static bool is_free_form(const char *word)
{
    return strcmp(word, "curv") == 0 || strcmp(word, "curv2") == 0 || strcmp(word, "surf") == 0;
}

static void note_unknown(ppmi_obj_reader *r, const char *word)
{
    ppmi_obj_tally *tally = &r->tally;
    if (is_harmless(word)) return;
    if (tally->unknown++ > 0) return;
    tally->unknown_line = r->lines.number;
    for (size_t i = 0; word[i]; ++i) {
        const bool is_plain = word[i] >= 0x20 && word[i] < 0x7f;
        tally->unknown_word[i] = (char)(is_plain ? word[i] : '?');
    }
}

/* What is not for the parser. word ends with a zero; one that was longer is cut. */
static void read_state(ppmi_obj_reader *r, const char *word, char *text, size_t length)
{
    if (strcmp(word, "usemtl") == 0) {
        set_material(r, text, length);
    } else if (strcmp(word, "s") == 0) {
        set_smoothing(r, text, length);
    } else if (strcmp(word, "g") == 0) {
        set_group(r, text, length);
    } else if (strcmp(word, "o") == 0) {
        set_name(r, &r->object, text, ppmi_obj_plain_name_length(text, length));
        set_name(r, &r->group, NULL, 0);
    } else if (strcmp(word, "mtllib") == 0) {
        note_libraries(r, text, length);
    } else if (strcmp(word, "l") == 0) {
        read_element(r, PPM_PRIMITIVE_LINES, text, length);
    } else if (strcmp(word, "p") == 0) {
        read_element(r, PPM_PRIMITIVE_POINTS, text, length);
    } else if (is_free_form(word)) {
        r->tally.free_forms++;
    } else {
        note_unknown(r, word);
    }
}

static bool is_for_parser(const char *text, size_t word)
{
    if (word == 1) return text[0] == 'v' || text[0] == 'f';
    return word == 2 && text[0] == 'v' && (text[1] == 't' || text[1] == 'n');
}

/* Looks through an f statement for what the parser would misread: slashes with nothing behind them
 * ("1//"), behind which it would go on in the next corner, are taken away; one with numbers that
 * wrap around in 32 bits is left out. */
static void check_face_text(ppmi_obj_reader *r, char *text, size_t length)
{
    size_t digits = 0;
    r->is_broken_face = false;
    for (size_t i = length; i-- > 0;) {
        const bool is_open = text[i] == '/' && (i + 1 == length || ppmi_obj_is_blank(text[i + 1]));
        if (is_open) text[i] = ' ';
        digits = text[i] >= '0' && text[i] <= '9' ? digits + 1 : 0;
        if (digits > 9) r->is_broken_face = true;
    }
    if (r->is_broken_face && r->position_fault.line == 0) {
        r->position_fault = (ppmi_obj_fault){r->lines.number, "an index of more than nine digits",
                                             PPM_PRIMITIVE_TRIANGLES};
    }
}

/* ppmi_obj_next_fn: reads state until there is something for the parser. */
static char *next_for_parser(void *user, size_t *out_length)
{
    ppmi_obj_reader *r = user;
    char *text, short_word[sizeof r->tally.unknown_word];
    size_t length;
    while (r->status == PPM_STATUS_OK && (text = ppmi_obj_lines_next(&r->lines, &length))) {
        char *rest = text;
        size_t rest_length = length;
        const size_t word = ppmi_obj_take_word(&rest, &rest_length);
        if (is_for_parser(text, word)) {
            const size_t comment = ppmi_obj_comment_of_numbers(text, length);
            if (comment < length) ppmi_obj_cut(text, &length, comment);
            if (text[0] == 'f') check_face_text(r, text, length);
            if (text[0] == 'f' && length == 1) r->tally.small_faces++;
            r->text = text;
            r->text_length = *out_length = length;
            return text;
        }
        const size_t cut = word < sizeof short_word ? word : sizeof short_word - 1;
        memcpy(short_word, text, cut);
        short_word[cut] = 0;
        read_state(r, short_word, rest, rest_length);
    }
    return NULL;
}

ppm_status ppmi_obj_read_statements(ppmi_obj_reader *r)
{
    const ppmi_obj_events events = {.user = r,
                                    .next = next_for_parser,
                                    .position = receive_position,
                                    .uv = receive_uv,
                                    .normal = receive_normal,
                                    .face = receive_face};
    r->is_new_run = true;
    ppm_status status = ppmi_obj_lines_open(r->context, r->path, &r->lines);
    if (status == PPM_STATUS_OK) status = ppmi_obj_parse(r->context, r->path, &events);
    if (status == PPM_STATUS_OK) status = r->lines.status;
    if (status == PPM_STATUS_OK) status = r->status;
    ppmi_obj_lines_close(&r->lines);
    return status == PPM_STATUS_OK ? ppmi_obj_settle_indices(r) : status;
}
