/* The statements of an OBJ file, as "Object Files (.obj)", Alias|Wavefront, Advanced Visualizer,
 * appendix B, has them, and vertex colours behind the coordinates. Numbers and faces go through
 * tinyobjloader; names and state are read here. */
#include <math.h>
#include <string.h>

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

static bool may_be_in_number(char c)
{
    return (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '+' || c == 'e' || c == 'E';
}

/* NaN and infinity, which the parser reads as 0. */
static bool is_not_finite(const char *word, size_t length)
{
    const size_t sign = length > 1 && (word[0] == '-' || word[0] == '+');
    return length > 0 && word[sign] != 0 && strchr("nNiI", word[sign]) != NULL;
}

/* Looks through the coordinates of a v statement, since the parser takes what it cannot read for 0.
 * Returns what follows the third, NULL after a failure. */
static const char *check_coordinates(ppmi_obj_reader *r, float xyz[3])
{
    const char *at = r->text + 1;
    for (int i = 0; i < 3; ++i) {
        while (ppmi_obj_is_blank(*at)) {
            ++at;
        }
        const char *word = at;
        while (may_be_in_number(*at)) {
            ++at;
        }
        if (*at == '\n' && at == word) {
            invalid(r, "a vertex needs three coordinates");
            return NULL;
        }
        if (ppmi_obj_is_blank(*at) || *at == '\n') continue;
        while (!ppmi_obj_is_blank(*at) && *at != '\n') {
            ++at;
        }
        if (!is_not_finite(word, (size_t)(at - word))) {
            invalid(r, "a coordinate is not a number");
            return NULL;
        }
        xyz[i] = NAN;
    }
    return at;
}

/* Colours of three or more numbers behind the coordinates; one number is a weight of free-form
 * geometry. White for vertices without one, once a vertex had one. */
static void read_color(ppmi_obj_reader *r, const char *text)
{
    float color[3];
    const size_t left = (size_t)(r->text + r->text_length - text);
    const bool has_color = left > 0 && ppmi_obj_parse_floats(text, left, color, 3) == 3;
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
    const char *rest = check_coordinates(r, checked);
    float *position = rest ? push_floats(r, &r->positions, 3) : NULL;
    if (!position) return;
    memcpy(position, checked, sizeof checked);
    read_color(r, rest);
}

static void receive_uv(void *user, const float uv[2])
{
    ppmi_obj_reader *r = user;
    float *added = push_floats(r, &r->uvs, 2);
    if (added) memcpy(added, uv, 2 * sizeof *uv);
}

static void receive_normal(void *user, const float xyz[3])
{
    ppmi_obj_reader *r = user;
    float *added = push_floats(r, &r->normals, 3);
    if (added) memcpy(added, xyz, 3 * sizeof *xyz);
}

/* ---- faces ----------------------------------------------------------------------------------- */

/* From as written to from 0; 0, which is none, to -1. False for one before the first element. An
 * index beyond the last one so far is noted: the element may still come. */
static bool resolve(const ppmi_obj_reader *r, int32_t *index, size_t count, ppmi_obj_reach *reach)
{
    if (*index > 0) {
        if ((size_t)*index > count && *index > reach->most) {
            *reach = (ppmi_obj_reach){*index, r->lines.number, r->kind};
        }
        --*index;
        return true;
    }
    if (*index == 0) {
        *index = -1;
        return true;
    }
    const int64_t absolute = (int64_t)count + *index;
    *index = (int32_t)absolute;
    return absolute >= 0;
}

static const char *kind_name(int32_t kind)
{
    return kind == PPM_PRIMITIVE_TRIANGLES ? "face"
           : kind == PPM_PRIMITIVE_LINES   ? "line"
                                           : "point";
}

static void invalid_index(ppmi_obj_reader *r, const char *what)
{
    if (r->status != PPM_STATUS_OK) return;
    r->status = ppmi_fail(r->context, PPM_STATUS_INPUT_INVALID, "%s: line %zu: a %s has %s",
                          r->path, r->lines.number, kind_name(r->kind), what);
}

static bool resolve_corner(ppmi_obj_reader *r, ppmi_obj_corner *corner)
{
    if (corner->position == 0) {
        invalid_index(r, "an index of 0 or one that is not a number");
        return false;
    }
    if (!resolve(r, &corner->position, r->positions.count, &r->position_reach) ||
        !resolve(r, &corner->uv, r->uvs.count, &r->uv_reach) ||
        !resolve(r, &corner->normal, r->normals.count, &r->normal_reach)) {
        invalid_index(r, "a negative index that points before the first element");
        return false;
    }
    return true;
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
        if (!resolve_corner(r, &added[i])) return;
    }
}

static void receive_face(void *user, const ppmi_obj_corner *corners, size_t count)
{
    ppmi_obj_reader *r = user;
    if (r->status != PPM_STATUS_OK) return;
    if (count < 3) {
        r->tally.small_faces++;
        return;
    }
    if (r->smoothing != 0) r->has_smoothing = true;
    add_element(r, PPM_PRIMITIVE_TRIANGLES, corners, count);
}

/* An l or p statement, without its word. */
static void read_element(ppmi_obj_reader *r, int32_t kind, char *text, size_t length)
{
    bool is_valid;
    const char *comment = memchr(text, '#', length);
    if (comment) ppmi_obj_cut(text, &length, (size_t)(comment - text));
    if (!ppmi_obj_read_corners(r, text, length, &r->element, &is_valid)) {
        out_of_memory(r);
        return;
    }
    const size_t count = r->element.count;
    if (!is_valid) {
        invalid(r, kind == PPM_PRIMITIVE_LINES
                       ? "a line has an index that is not a number of at most nine digits"
                       : "a point has an index that is not a number of at most nine digits");
    } else if (count >= (kind == PPM_PRIMITIVE_LINES ? 2u : 1u)) {
        add_element(r, kind, r->element.items, count);
    } else {
        r->tally.short_lines++;
    }
}

static ppm_status check_reach(ppmi_obj_reader *r, const ppmi_obj_reach *reach, size_t count,
                              const char *what)
{
    if (reach->most <= 0 || (size_t)reach->most <= count) return PPM_STATUS_OK;
    return ppmi_fail(r->context, PPM_STATUS_INPUT_INVALID,
                     "%s: line %zu: a %s has %s %d, of %zu in the file", r->path, reach->line,
                     kind_name(reach->kind), what, (int)reach->most, count);
}

/* Programs that strip texture vertices or normals may leave their indices behind: where there are
 * none at all, such indices mean nothing. */
static void drop_indices_of_nothing(ppmi_obj_reader *r)
{
    const bool drops_uvs = r->uvs.count == 0 && r->uv_reach.most > 0;
    const bool drops_normals = r->normals.count == 0 && r->normal_reach.most > 0;
    ppmi_obj_corner *corners = r->corners.items;
    for (size_t i = 0; (drops_uvs || drops_normals) && i < r->corners.count; ++i) {
        if (drops_uvs) corners[i].uv = -1;
        if (drops_normals) corners[i].normal = -1;
    }
    if (drops_uvs) {
        r->uv_reach.most = 0;
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: faces have texture vertices, of which there are none", r->path);
    }
    if (drops_normals) {
        r->normal_reach.most = 0;
        ppmi_log(r->context, PPM_LOG_WARNING,
                 "%s: faces have vertex normals, of which there are none", r->path);
    }
}

static ppm_status check_indices(ppmi_obj_reader *r)
{
    drop_indices_of_nothing(r);
    ppm_status status = check_reach(r, &r->position_reach, r->positions.count, "vertex");
    if (status == PPM_STATUS_OK) {
        status = check_reach(r, &r->uv_reach, r->uvs.count, "texture vertex");
    }
    if (status == PPM_STATUS_OK) {
        status = check_reach(r, &r->normal_reach, r->normals.count, "vertex normal");
    }
    return status;
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
        set_name(r, &r->object, text, length);
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
 * ("1//"), behind which it would go on in the next corner, are taken away; numbers that wrap around
 * in 32 bits are refused. */
static void check_face_text(ppmi_obj_reader *r, char *text, size_t length)
{
    size_t digits = 0;
    for (size_t i = length; i-- > 0;) {
        const bool is_open = text[i] == '/' && (i + 1 == length || ppmi_obj_is_blank(text[i + 1]));
        if (is_open) text[i] = ' ';
        digits = text[i] >= '0' && text[i] <= '9' ? digits + 1 : 0;
        if (digits > 9) invalid(r, "a face has an index of more than nine digits");
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
            const char *comment = memchr(text, '#', length);
            if (comment) ppmi_obj_cut(text, &length, (size_t)(comment - text));
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
    return status == PPM_STATUS_OK ? check_indices(r) : status;
}
