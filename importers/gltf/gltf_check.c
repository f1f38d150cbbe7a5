/* One walk over a document's JSON along the tables of gltf_schema.c. See gltf_check.h for why.
 *
 * Faults are of three kinds: text that is not JSON ends the walk; a wrong vital value marks the
 * element of a list (or the document) as broken; a wrong optional value is warned about and
 * becomes null, so that its default is used. */
#include "gltf/gltf_check.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gltf/gltf_patch.h"
#include "gltf/gltf_reader.h"
#include "gltf/gltf_schema.h"

enum {
    MAX_DEPTH = 512,   /* nesting: bounds our recursion and that of the parser behind us */
    MAX_WARNINGS = 16, /* about optional values, per file */
    MAX_FIELDS = 32,   /* members of one table */
    MAX_KEY = 64,      /* longer keys are none of ours */
    MAX_PATH = 200
};
#define LARGEST_NUMBER 3.4e38 /* what a float holds */

typedef struct checker {
    ppm_context *context;
    const char *file;
    ppmi_gltf_json json;
    ppmi_gltf_outline *outline;
    size_t depth;
    char path[MAX_PATH];
    size_t path_length;
    char **reason; /* where the present element's fault goes; *reason is NULL while it is fine */
    ppmi_gltf_source *source; /* the buffer or image that is being walked, or NULL */
    ppmi_gltf_patches patches;
    unsigned warnings;
    char version[16], min_version[16];
    bool out_of_memory;
} checker;

static bool check_members(checker *c, const gltf_field *fields);
static bool check_value(checker *c, const gltf_field *field);

/* ---- memory and paths ------------------------------------------------------------------------ */

static bool fail_memory(checker *c)
{
    c->out_of_memory = true;
    return ppmi_gltf_json_fail(&c->json, "out of memory");
}

/* Both return the length to go back to. A path that is too long is cut. */
static size_t push_key(checker *c, const char *key)
{
    const size_t before = c->path_length;
    const int n = snprintf(c->path + before, sizeof c->path - before, before ? ".%s" : "%s", key);
    if (n > 0) c->path_length = before + (size_t)n;
    if (c->path_length >= sizeof c->path) c->path_length = sizeof c->path - 1;
    return before;
}

static size_t push_index(checker *c, size_t index)
{
    const size_t before = c->path_length;
    const int n = snprintf(c->path + before, sizeof c->path - before, "[%zu]", index);
    if (n > 0) c->path_length = before + (size_t)n;
    if (c->path_length >= sizeof c->path) c->path_length = sizeof c->path - 1;
    return before;
}

static void pop(checker *c, size_t before)
{
    c->path_length = before;
    c->path[before] = 0;
}

/* Replaces begin..end by a text that lives on. */
static bool add_patch(checker *c, size_t begin, size_t end, const char *text)
{
    return ppmi_gltf_patch(c->context, &c->patches, begin, end, text) || fail_memory(c);
}

/* ---- faults ---------------------------------------------------------------------------------- */

static void warn(checker *c, const char *what)
{
    if (++c->warnings > MAX_WARNINGS) return;
    ppmi_log(c->context, PPM_LOG_WARNING, "%s: %s: %s; the default is used%s", c->file, c->path,
             what, c->warnings == MAX_WARNINGS ? " (further ones are not listed)" : "");
}

/* The element around the present place is broken; its first fault is kept. */
static bool break_element(checker *c, const char *what)
{
    if (*c->reason) return true;
    const size_t size = c->path_length + strlen(what) + 3;
    *c->reason = ppmi_alloc(c->context, size, 1);
    if (!*c->reason) return fail_memory(c);
    snprintf(*c->reason, size, "%s: %s", c->path, what);
    return true;
}

/* A value that began at begin and has been walked is wrong. */
static bool complain(checker *c, const gltf_field *field, size_t begin, const char *what)
{
    if (field->flags & GLTF_VITAL) return break_element(c, what);
    warn(c, what);
    return add_patch(c, begin, c->json.at, "null");
}

/* ---- values that nobody looks at ------------------------------------------------------------- */

static bool enter(checker *c)
{
    if (++c->depth > MAX_DEPTH) return ppmi_gltf_json_fail(&c->json, "nested too deeply");
    return true;
}

static bool skip_value(checker *c);

/* After [ or {: items up to the closing bracket. */
static bool skip_items(checker *c, char close)
{
    if (!enter(c)) return false;
    for (bool first = true; !ppmi_gltf_json_take(&c->json, close); first = false) {
        if (!first && !ppmi_gltf_json_take(&c->json, ',')) {
            return ppmi_gltf_json_fail(&c->json, "expected a comma or the closing bracket");
        }
        ppmi_gltf_span key;
        if (close == '}' && !ppmi_gltf_json_string(&c->json, &key)) return false;
        if (close == '}' && !ppmi_gltf_json_take(&c->json, ':')) {
            return ppmi_gltf_json_fail(&c->json, "expected a colon");
        }
        if (!skip_value(c)) return false;
    }
    --c->depth;
    return true;
}

static bool skip_value(checker *c)
{
    ppmi_gltf_span span;
    ppmi_gltf_number number;
    char letter;
    const char next = ppmi_gltf_json_peek(&c->json);
    const size_t begin = c->json.at;
    if (next == '{' || next == '[') {
        ++c->json.at;
        return skip_items(c, next == '{' ? '}' : ']');
    }
    if (next == '"') return ppmi_gltf_json_string(&c->json, &span);
    if (next != '-' && (next < '0' || next > '9')) {
        return ppmi_gltf_json_literal(&c->json, &letter);
    }
    if (!ppmi_gltf_json_number(&c->json, &number)) return false;
    /* the parser behind us would refuse the whole document for this number */
    return !number.overflows || add_patch(c, begin, c->json.at, "0");
}

/* ---- values of a kind ------------------------------------------------------------------------ */

static bool is_number_next(checker *c)
{
    const char next = ppmi_gltf_json_peek(&c->json);
    return next == '-' || (next >= '0' && next <= '9');
}

/* Gives tinygltf a number in a form that it does not misread: an integer as digits; a number that
 * int does not hold with a point. */
static bool normalise(checker *c, size_t begin, const ppmi_gltf_number *number, bool is_integer)
{
    if (is_integer && number->is_integer && c->json.text[begin] != '-') return true;
    if (!is_integer && (!number->is_integer || fabs(number->value) < 2147483648.0)) return true;
    char text[PPMI_GLTF_PATCH_SHORT];
    const size_t length = c->json.at - begin;
    if (is_integer) {
        snprintf(text, sizeof text, "%" PRIu64, (uint64_t)number->value);
    } else if (length + 3 <= sizeof text) {
        snprintf(text, sizeof text, "%.*s.0", (int)length, c->json.text + begin);
    } else {
        return true; /* more digits than an int64 has: read as double anyway */
    }
    return ppmi_gltf_patch_short(c->context, &c->patches, begin, c->json.at, text) ||
           fail_memory(c);
}

/* NULL when the number fits the field. */
static const char *number_fault(const gltf_field *field, const ppmi_gltf_number *number)
{
    const double v = number->value;
    const bool is_integer = field->kind == GLTF_INTEGER || field->kind == GLTF_INTEGERS ||
                            field->kind == GLTF_INDEX_MAP;
    if (number->overflows || fabs(v) > LARGEST_NUMBER) return "the number is too large";
    if (!is_integer) return NULL;
    if (v < 0.0 || v != floor(v)) return "expected an integer that is not negative";
    if (v < field->min || (field->max > 0.0 && v > field->max)) return "out of range";
    if (field->step > 0.0 && fmod(v, field->step) != 0.0) return "not a multiple of 4";
    return NULL;
}

/* Among 5120 .. 5131 there are numbers of no type. */
static bool check_component_type(checker *c, const gltf_field *field, size_t begin,
                                 const ppmi_gltf_number *number)
{
    const int type = (int)number->value;
    if (type == PPMI_GLTF_HALF) {
        char text[PPMI_GLTF_PATCH_SHORT];
        snprintf(text, sizeof text, "%d", PPMI_GLTF_HALF_FOR_TINYGLTF);
        return ppmi_gltf_patch_short(c->context, &c->patches, begin, c->json.at, text) ||
               fail_memory(c);
    }
    const bool is_type = type <= PPMI_GLTF_UNSIGNED_SHORT || type == PPMI_GLTF_UNSIGNED_INT ||
                         type == PPMI_GLTF_FLOAT || type == PPMI_GLTF_DOUBLE;
    return is_type ? normalise(c, begin, number, true) : complain(c, field, begin, "out of range");
}

static bool check_number(checker *c, const gltf_field *field, ppmi_gltf_number *number)
{
    number->value = 0.0;
    ppmi_gltf_json_peek(&c->json);
    const size_t begin = c->json.at;
    if (!is_number_next(c)) {
        return skip_value(c) && complain(c, field, begin, "expected a number");
    }
    if (!ppmi_gltf_json_number(&c->json, number)) return false;
    const char *fault = number_fault(field, number);
    if (fault) return complain(c, field, begin, fault);
    if (field->flags & GLTF_COMPONENT_TYPE) return check_component_type(c, field, begin, number);
    return normalise(c, begin, number, field->kind != GLTF_NUMBER && field->kind != GLTF_NUMBERS);
}

static bool check_boolean(checker *c, const gltf_field *field)
{
    ppmi_gltf_json_peek(&c->json);
    const size_t begin = c->json.at;
    const char letter = ppmi_gltf_json_peek(&c->json);
    if (!skip_value(c)) return false;
    return letter == 't' || letter == 'f' || complain(c, field, begin, "expected true or false");
}

/* " word " is in choices; the word goes to chosen. */
static bool is_choice(const char *choices, const char *text, ppmi_gltf_span span, char *chosen)
{
    char padded[MAX_KEY];
    const size_t length = span.end - span.begin;
    if (length == 0 || length + 3 > sizeof padded || memchr(text + span.begin, ' ', length)) {
        return false;
    }
    snprintf(padded, sizeof padded, " %.*s ", (int)length, text + span.begin);
    if (!strstr(choices, padded)) return false;
    snprintf(chosen, MAX_KEY, "%.*s", (int)length, text + span.begin);
    return true;
}

static bool check_string(checker *c, const gltf_field *field, ppmi_gltf_span *span, char *chosen)
{
    *span = (ppmi_gltf_span){0, 0};
    const bool is_string = ppmi_gltf_json_peek(&c->json) == '"';
    const size_t begin = c->json.at;
    if (!is_string) return skip_value(c) && complain(c, field, begin, "expected a string");
    if (!ppmi_gltf_json_string(&c->json, span)) return false;
    if (!field->choices || is_choice(field->choices, c->json.text, *span, chosen)) return true;
    return complain(c, field, begin, "unknown value");
}

/* ---- arrays ---------------------------------------------------------------------------------- */

/* Opens an array; *is_open is false after any other value, which is skipped and complained about.
 */
static bool open_array(checker *c, const gltf_field *field, bool *is_open)
{
    *is_open = ppmi_gltf_json_peek(&c->json) == '[';
    const size_t begin = c->json.at;
    if (!*is_open) return skip_value(c) && complain(c, field, begin, "expected an array");
    ++c->json.at;
    return enter(c);
}

/* True when there is another item; false at the closing bracket or after an error. */
static bool next_item(checker *c, size_t index)
{
    if (ppmi_gltf_json_take(&c->json, ']')) {
        --c->depth;
        return false;
    }
    if (index > 0 && !ppmi_gltf_json_take(&c->json, ',')) {
        return ppmi_gltf_json_fail(&c->json, "expected a comma or ]");
    }
    return true;
}

/* NUMBERS, INTEGERS and STRINGS. A wrong item makes the whole array wrong. */
static bool check_scalars(checker *c, const gltf_field *field)
{
    ppmi_gltf_json_peek(&c->json);
    const size_t begin = c->json.at;
    const char *fault = NULL;
    bool is_open;
    size_t count = 0;
    if (!open_array(c, field, &is_open) || !is_open) return !c->json.error;
    for (; next_item(c, count); ++count) {
        ppmi_gltf_number number = {0};
        const bool is_string = ppmi_gltf_json_peek(&c->json) == '"';
        const size_t item = c->json.at;
        if (field->kind == GLTF_STRINGS || !is_number_next(c)) {
            if (!skip_value(c)) return false;
            if (field->kind != GLTF_STRINGS) fault = "expected numbers";
            if (field->kind == GLTF_STRINGS && !is_string) fault = "expected strings";
            continue;
        }
        if (!ppmi_gltf_json_number(&c->json, &number)) return false;
        const char *item_fault = number_fault(field, &number);
        if (item_fault) fault = item_fault;
        if (!item_fault && !normalise(c, item, &number, field->kind == GLTF_INTEGERS)) return false;
    }
    if (c->json.error) return false;
    if (!fault && field->max_items > 0 && (count < field->min_items || count > field->max_items)) {
        fault = "wrong number of items";
    }
    return !fault || complain(c, field, begin, fault);
}

/* An object, or a complaint. */
static bool check_object(checker *c, const gltf_field *field)
{
    const bool is_object = ppmi_gltf_json_peek(&c->json) == '{';
    const size_t begin = c->json.at;
    if (!is_object && (field->flags & GLTF_FREE_FORM)) return skip_value(c);
    if (!is_object) return skip_value(c) && complain(c, field, begin, "expected an object");
    return check_members(c, field->fields);
}

static bool check_objects(checker *c, const gltf_field *field)
{
    const gltf_field item = {
        .key = field->key, .flags = field->flags & GLTF_VITAL, .fields = field->fields};
    bool is_open;
    ppmi_gltf_json_peek(&c->json);
    const size_t begin = c->json.at;
    if (!open_array(c, field, &is_open) || !is_open) return !c->json.error;
    size_t count = 0;
    for (; next_item(c, count); ++count) {
        const size_t before = push_index(c, count);
        if (!check_object(c, &item)) return false;
        pop(c, before);
    }
    if (c->json.error) return false;
    return count >= field->min_items || complain(c, field, begin, "expected at least one item");
}

/* Makes the buffer or image of a new element the present one; NULL for other lists. */
static bool add_source(checker *c, uint8_t list)
{
    ppmi_gltf_sources *sources = list == PPMI_GLTF_BUFFERS  ? &c->outline->buffers
                                 : list == PPMI_GLTF_IMAGES ? &c->outline->images
                                                            : NULL;
    c->source = NULL;
    if (!sources) return true;
    ppmi_gltf_source *items = ppmi_gltf_grow(c->context, sources->items, sources->count,
                                             &sources->capacity, sizeof *items);
    if (!items) return fail_memory(c);
    sources->items = items;
    c->source = &sources->items[sources->count++];
    *c->source = (ppmi_gltf_source){.buffer_view = -1};
    return true;
}

/* Puts a member in front of those of the object that comes next. */
static bool add_member(checker *c)
{
    if (ppmi_gltf_json_peek(&c->json) != '{') return true;
    const size_t begin = c->json.at;
    ppmi_gltf_json inside = c->json;
    inside.at++;
    const bool is_empty = ppmi_gltf_json_peek(&inside) == '}';
    return add_patch(c, begin, begin + 1, is_empty ? "{\"_\":0" : "{\"_\":0,");
}

/* One element of a list: what breaks it stays its own affair. */
static bool check_element(checker *c, const gltf_field *field, ppmi_gltf_list *list)
{
    const gltf_field item = {.key = field->key, .flags = GLTF_VITAL, .fields = field->fields};
    char **outer = c->reason;
    ppmi_gltf_json_peek(&c->json);
    const size_t begin = c->json.at;
    char **broken =
        ppmi_gltf_grow(c->context, list->broken, list->count, &list->capacity, sizeof *broken);
    if (!broken) return fail_memory(c);
    list->broken = broken;
    if (!add_source(c, field->list)) return false;
    c->reason = &list->broken[list->count++];
    *c->reason = NULL;
    if ((field->flags & GLTF_KEEPS_EMPTY) && !add_member(c)) return false;
    if (!check_object(c, &item)) return false;
    if (*c->reason && !add_patch(c, begin, c->json.at, field->placeholder)) return false;
    c->reason = outer;
    c->source = NULL;
    return true;
}

static bool check_list(checker *c, const gltf_field *field)
{
    ppmi_gltf_list *list = &c->outline->lists[field->list];
    bool is_open;
    ppmi_gltf_json_peek(&c->json);
    const size_t begin = c->json.at;
    if (!open_array(c, field, &is_open) || !is_open) return !c->json.error;
    for (size_t i = 0; next_item(c, i); ++i) {
        const size_t before = push_index(c, i);
        if (!check_element(c, field, list)) return false;
        pop(c, before);
    }
    if (c->json.error) return false;
    return !(field->flags & GLTF_EMPTY_FOR_TINYGLTF) || add_patch(c, begin, c->json.at, "[]");
}

/* ---- objects --------------------------------------------------------------------------------- */

/* Keeps what the outline wants to know. */
static void keep_string(checker *c, const gltf_field *field, ppmi_gltf_span span)
{
    const int length = (int)(span.end - span.begin);
    if (c->source && strcmp(field->key, "uri") == 0) {
        c->source->has_uri = true;
        c->source->uri = span;
    } else if (c->source && strcmp(field->key, "name") == 0) {
        c->source->name = span;
    } else if (length < (int)sizeof c->version && strcmp(c->path, "asset.version") == 0) {
        snprintf(c->version, sizeof c->version, "%.*s", length, c->json.text + span.begin);
    } else if (length < (int)sizeof c->version && strcmp(c->path, "asset.minVersion") == 0) {
        snprintf(c->min_version, sizeof c->min_version, "%.*s", length, c->json.text + span.begin);
    }
}

static void keep_integer(checker *c, const gltf_field *field, double value)
{
    if (!c->source) return;
    if (strcmp(field->key, "byteLength") == 0) c->source->byte_length = (uint64_t)value;
    if (strcmp(field->key, "bufferView") == 0) c->source->buffer_view = (int32_t)value;
}

static bool check_map(checker *c, const gltf_field *field)
{
    const gltf_field item = {
        .key = field->key, .kind = GLTF_INDEX_MAP, .flags = field->flags, .max = 2147483647.0};
    const bool is_object = ppmi_gltf_json_peek(&c->json) == '{';
    const size_t begin = c->json.at;
    if (!is_object) return skip_value(c) && complain(c, field, begin, "expected an object");
    ++c->json.at;
    if (!enter(c)) return false;
    for (bool first = true; !ppmi_gltf_json_take(&c->json, '}'); first = false) {
        ppmi_gltf_span key;
        ppmi_gltf_number number;
        if (!first && !ppmi_gltf_json_take(&c->json, ',')) {
            return ppmi_gltf_json_fail(&c->json, "expected a comma or }");
        }
        if (!ppmi_gltf_json_string(&c->json, &key)) return false;
        if (!ppmi_gltf_json_take(&c->json, ':')) {
            return ppmi_gltf_json_fail(&c->json, "expected a colon");
        }
        char name[MAX_KEY];
        ppmi_gltf_printable(c->json.text + key.begin, key.end - key.begin, name, sizeof name);
        const size_t before = push_key(c, name);
        if (!check_number(c, &item, &number)) return false;
        pop(c, before);
    }
    --c->depth;
    return true;
}

static bool check_maps(checker *c, const gltf_field *field)
{
    const gltf_field item = {.key = field->key, .flags = field->flags};
    bool is_open;
    if (!open_array(c, field, &is_open) || !is_open) return !c->json.error;
    for (size_t i = 0; next_item(c, i); ++i) {
        const size_t before = push_index(c, i);
        if (!check_map(c, &item)) return false;
        pop(c, before);
    }
    return !c->json.error;
}

/* One member's value. chosen receives the string of a field with choices. */
static bool check_member(checker *c, const gltf_field *field, char *chosen)
{
    ppmi_gltf_number number;
    ppmi_gltf_span span;
    if (field->kind == GLTF_INTEGER) {
        if (!check_number(c, field, &number)) return false;
        if (!*c->reason) keep_integer(c, field, number.value);
        return true;
    }
    if (field->kind == GLTF_STRING) {
        if (!check_string(c, field, &span, chosen)) return false;
        if (span.begin > 0) keep_string(c, field, span);
        return true;
    }
    return check_value(c, field);
}

static bool check_value(checker *c, const gltf_field *field)
{
    ppmi_gltf_number number;
    switch (field->kind) {
    case GLTF_NUMBER:
        return check_number(c, field, &number);
    case GLTF_BOOLEAN:
        return check_boolean(c, field);
    case GLTF_OBJECT:
        return check_object(c, field);
    case GLTF_LIST:
        return check_list(c, field);
    case GLTF_OBJECTS:
        return check_objects(c, field);
    case GLTF_NUMBERS:
    case GLTF_INTEGERS:
    case GLTF_STRINGS:
        return check_scalars(c, field);
    case GLTF_INDEX_MAP:
        return check_map(c, field);
    case GLTF_INDEX_MAPS:
        return check_maps(c, field);
    default:
        return skip_value(c);
    }
}

/* The number of the field of that key, or MAX_FIELDS. */
static size_t find_field(const gltf_field *fields, const char *key, size_t length)
{
    for (size_t i = 0; fields[i].key; ++i) {
        if (strlen(fields[i].key) == length && memcmp(fields[i].key, key, length) == 0) return i;
    }
    return MAX_FIELDS;
}

/* Required members that are absent. */
static bool check_absent(checker *c, const gltf_field *fields, uint32_t seen, const char *chosen)
{
    for (size_t i = 0; fields[i].key; ++i) {
        const bool is_named = chosen[0] && strcmp(chosen, fields[i].key) == 0;
        if (seen >> i & 1 || !(is_named || fields[i].flags & GLTF_REQUIRED)) continue;
        const size_t before = push_key(c, fields[i].key);
        if (!(fields[i].flags & GLTF_VITAL)) {
            warn(c, "missing");
        } else if (!break_element(c, "missing")) {
            return false;
        }
        pop(c, before);
    }
    return true;
}

/* A key and its colon; its field's number, or MAX_FIELDS for one that we do not use. */
static bool check_key(checker *c, const gltf_field *fields, uint32_t *seen, size_t *index)
{
    char key[MAX_KEY];
    ppmi_gltf_span span;
    if (!ppmi_gltf_json_string(&c->json, &span)) return false;
    *index = MAX_FIELDS;
    if (span.end - span.begin <= sizeof key) {
        *index = find_field(fields, key, ppmi_gltf_json_unescape(c->json.text, span, key));
    }
    if (*index < MAX_FIELDS) {
        /* parsers differ in which of two they take */
        if (*seen >> *index & 1) return ppmi_gltf_json_fail(&c->json, "the key occurs twice");
        *seen |= (uint32_t)1 << *index;
        const char *rename = fields[*index].rename;
        if (rename && !add_patch(c, span.begin, span.end, rename)) return false;
    }
    return ppmi_gltf_json_take(&c->json, ':') || ppmi_gltf_json_fail(&c->json, "expected a colon");
}

/* From { to }. */
static bool check_members(checker *c, const gltf_field *fields)
{
    char chosen[MAX_KEY] = "", dropped[MAX_KEY];
    uint32_t seen = 0;
    ++c->json.at;
    if (!enter(c)) return false;
    for (bool first = true; !ppmi_gltf_json_take(&c->json, '}'); first = false) {
        size_t index;
        if (!first && !ppmi_gltf_json_take(&c->json, ',')) {
            return ppmi_gltf_json_fail(&c->json, "expected a comma or }");
        }
        if (!check_key(c, fields, &seen, &index)) return false;
        if (index == MAX_FIELDS) {
            if (!skip_value(c)) return false;
            continue;
        }
        const size_t before = push_key(c, fields[index].key);
        const bool names_member = fields[index].flags & GLTF_NAMES_MEMBER;
        if (!check_member(c, &fields[index], names_member ? chosen : dropped)) return false;
        pop(c, before);
    }
    --c->depth;
    return check_absent(c, fields, seen, chosen);
}

/* ---- the document ---------------------------------------------------------------------------- */

static bool walk(checker *c)
{
    size_t bad;
    if (!ppmi_gltf_json_is_utf8(c->json.text, c->json.length, &bad)) {
        c->json.at = bad;
        return ppmi_gltf_json_fail(&c->json, "not UTF-8");
    }
    if (ppmi_gltf_json_peek(&c->json) != '{') {
        return ppmi_gltf_json_fail(&c->json, "expected a JSON object");
    }
    if (!check_members(c, ppmi_gltf_schema)) return false;
    if (ppmi_gltf_json_peek(&c->json) != 0 || c->json.at < c->json.length) {
        return ppmi_gltf_json_fail(&c->json, "something follows the end of the document");
    }
    return true;
}

static ppm_status report_syntax(checker *c)
{
    size_t line, column;
    if (c->out_of_memory) {
        return ppmi_fail(c->context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", c->file);
    }
    ppmi_gltf_json_place(&c->json, &line, &column);
    return ppmi_fail(c->context, PPM_STATUS_INPUT_INVALID, "%s: line %zu, column %zu: %s%s%s",
                     c->file, line, column, c->json.error, c->path_length ? ", in " : "", c->path);
}

/* asset.version and asset.minVersion: we read every 2.x that asks for no more than 2.0. */
static ppm_status check_version(checker *c)
{
    if (c->version[0] && strncmp(c->version, "2.", 2) != 0) {
        return ppmi_fail(c->context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: asset.version: glTF %s is not supported, only glTF 2.0", c->file,
                         c->version);
    }
    if (c->min_version[0] && strcmp(c->min_version, "2.0") != 0) {
        return ppmi_fail(c->context, PPM_STATUS_INPUT_UNSUPPORTED,
                         "%s: asset.minVersion: the file needs glTF %s; this reads 2.0", c->file,
                         c->min_version);
    }
    return PPM_STATUS_OK;
}

ppm_status ppmi_gltf_check(ppm_context *context, const char *file, const char *text, size_t length,
                           ppmi_gltf_outline *out_outline)
{
    char *root_fault = NULL;
    checker c = {.context = context,
                 .file = file,
                 .json = {.text = text, .length = length},
                 .outline = out_outline,
                 .reason = &root_fault};
    *out_outline = (ppmi_gltf_outline){0};
    ppm_status status = walk(&c) ? check_version(&c) : report_syntax(&c);
    if (status == PPM_STATUS_OK && root_fault) {
        status = ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: %s", file, root_fault);
    }
    if (status == PPM_STATUS_OK &&
        !ppmi_gltf_apply_patches(context, &c.patches, text, length, &out_outline->text,
                                 &out_outline->text_length)) {
        status = ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", file);
    }
    ppmi_free(context, root_fault);
    ppmi_free(context, c.patches.items);
    return status;
}

void ppmi_gltf_outline_deinit(ppm_context *context, ppmi_gltf_outline *outline)
{
    for (size_t i = 0; i < PPMI_GLTF_LIST_COUNT; ++i) {
        for (size_t k = 0; k < outline->lists[i].count; ++k) {
            ppmi_free(context, outline->lists[i].broken[k]);
        }
        ppmi_free(context, outline->lists[i].broken);
    }
    ppmi_free(context, outline->buffers.items);
    ppmi_free(context, outline->images.items);
    ppmi_free(context, outline->text);
    *outline = (ppmi_gltf_outline){0};
}
