/* jansson parses; numbers that are no finite doubles are errors of its own. */
#include "setup/setup_json.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/suggest.h"
#include "setup/setup_file.h"

/* ---- places and messages --------------------------------------------------------------------- */

ppmi_setup_value ppmi_setup_member(const ppmi_setup_value *object, const char *key,
                                   const json_t *json)
{
    ppmi_setup_value value = {.setup = object->setup, .json = json};
    const char *dot = object->place[0] ? "." : "";
    snprintf(value.place, sizeof value.place, "%.100s%s%.50s", object->place, dot, key);
    return value;
}

ppmi_setup_value ppmi_setup_element(const ppmi_setup_value *array, size_t index)
{
    ppmi_setup_value value = {.setup = array->setup, .json = json_array_get(array->json, index)};
    snprintf(value.place, sizeof value.place, "%.130s[%zu]", array->place, index);
    return value;
}

ppm_status ppmi_setup_fail(const ppmi_setup_value *value, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return ppmi_fail(value->setup->context, PPM_STATUS_INPUT_INVALID, "%s: %s%s%s",
                     value->setup->path, value->place, value->place[0] ? ": " : "", message);
}

void ppmi_setup_warn(const ppmi_setup_value *value, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    ppmi_log(value->setup->context, PPM_LOG_WARNING, "%s: %s%s%s", value->setup->path, value->place,
             value->place[0] ? ": " : "", message);
}

/* The value as one finds it in the file, cut off where it is long. */
static void show(const json_t *json, char *buffer, size_t size)
{
    const size_t length =
        json_dumpb(json, buffer, size - 1, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(9));
    buffer[length < size ? length : size - 1] = 0;
    if (length >= size) strcpy(buffer + size - 4, "...");
}

ppm_status ppmi_setup_refuse(const ppmi_setup_value *value, const char *expected)
{
    char found[60];
    show(value->json, found, sizeof found);
    return ppmi_setup_fail(value, "%s found, expected %s", found, expected);
}

/* ---- values ---------------------------------------------------------------------------------- */

static ppm_status refuse_range(const ppmi_setup_value *value, const char *what,
                               const ppmi_setup_key *key)
{
    char expected[120];
    snprintf(expected, sizeof expected, "%s from %g to %g", what, key->low, key->high);
    return ppmi_setup_refuse(value, expected);
}

static bool take_number(const json_t *json, const ppmi_setup_key *key, double *out)
{
    if (!json_is_number(json)) return false;
    const double number = json_number_value(json);
    if (!isfinite(number) || number < key->low || number > key->high) return false;
    *out = number;
    return true;
}

static void store(void *field, size_t index, bool is_double, double number)
{
    if (is_double) {
        ((double *)field)[index] = number;
    } else {
        ((float *)field)[index] = (float)number;
    }
}

static ppm_status read_numbers(const ppmi_setup_value *value, const ppmi_setup_key *key,
                               void *field)
{
    const bool is_double = key->kind == PPMI_SETUP_REALS;
    double numbers[16];
    char what[40];
    snprintf(what, sizeof what, "%u numbers, each", (unsigned)key->count);
    if (json_array_size(value->json) != key->count) return refuse_range(value, what, key);
    for (uint32_t i = 0; i < key->count; i++) {
        if (!take_number(json_array_get(value->json, i), key, &numbers[i])) {
            return refuse_range(value, what, key);
        }
    }
    for (uint32_t i = 0; i < key->count; i++)
        store(field, i, is_double, numbers[i]);
    return PPM_STATUS_OK;
}

static ppm_status read_color(const ppmi_setup_value *value, const ppmi_setup_key *key, float *field)
{
    double rgb[3];
    const bool is_array = json_array_size(value->json) == 3;
    for (size_t i = 0; i < 3; i++) {
        const json_t *each = is_array ? json_array_get(value->json, i) : value->json;
        if (!take_number(each, key, &rgb[i])) {
            return refuse_range(value, "linear RGB, or one number for all three, each", key);
        }
    }
    for (size_t i = 0; i < 3; i++)
        field[i] = (float)rgb[i];
    return PPM_STATUS_OK;
}

static ppm_status read_word(const ppmi_setup_value *value, const ppmi_setup_key *key,
                            int32_t *field)
{
    enum { WORDS_MAX = 16 };
    const char *names[WORDS_MAX], *text = json_string_value(value->json);
    char list[200] = "";
    size_t count = 0, used = 0;
    for (const ppmi_setup_word *word = key->words; word->name && count < WORDS_MAX; word++) {
        if (text && strcmp(text, word->name) == 0) {
            *field = word->value;
            return PPM_STATUS_OK;
        }
        names[count] = word->name;
        used += (size_t)snprintf(list + used, sizeof list - used, "%s\"%s\"", count ? ", " : "",
                                 word->name);
        count++;
    }
    const char *nearest = ppmi_suggest(text, names, count);
    char found[60];
    show(value->json, found, sizeof found);
    return ppmi_setup_fail(value, "%s found, expected one of %s%s%s%s", found, list,
                           nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                           nearest ? "\"?" : "");
}

static ppm_status read_integer(const ppmi_setup_value *value, const ppmi_setup_key *key,
                               int32_t *field)
{
    double number;
    if (!json_is_integer(value->json) || !take_number(value->json, key, &number)) {
        return refuse_range(value, "a whole number", key);
    }
    *field = (int32_t)number;
    return PPM_STATUS_OK;
}

/* Strings with a zero byte end there for C; json_string_length would tell. */
static ppm_status read_text(const ppmi_setup_value *value, const char **field)
{
    const char *text = json_string_value(value->json);
    if (!text || !*text || strlen(text) != json_string_length(value->json)) {
        return ppmi_setup_refuse(value, "a text that is not empty");
    }
    *field = text;
    return PPM_STATUS_OK;
}

ppm_status ppmi_setup_read_value(const ppmi_setup_value *value, const ppmi_setup_key *key,
                                 void *target)
{
    void *field = (char *)target + key->field;
    double number;
    switch (key->kind) {
    case PPMI_SETUP_REAL:
    case PPMI_SETUP_FLOAT:
        if (!take_number(value->json, key, &number)) return refuse_range(value, "a number", key);
        store(field, 0, key->kind == PPMI_SETUP_REAL, number);
        return PPM_STATUS_OK;
    case PPMI_SETUP_REALS:
    case PPMI_SETUP_FLOATS:
        return read_numbers(value, key, field);
    case PPMI_SETUP_COLOR:
        return read_color(value, key, field);
    case PPMI_SETUP_INTEGER:
        return read_integer(value, key, field);
    case PPMI_SETUP_FLAG:
        if (!json_is_boolean(value->json)) return ppmi_setup_refuse(value, "true or false");
        *(uint32_t *)field = json_is_true(value->json);
        return PPM_STATUS_OK;
    case PPMI_SETUP_TEXT:
        return read_text(value, field);
    case PPMI_SETUP_WORD:
        return read_word(value, key, field);
    }
    return key->read(value, key, target);
}

/* ---- objects --------------------------------------------------------------------------------- */

static ppm_status refuse_key(const ppmi_setup_value *object, const char *name,
                             const ppmi_setup_key *keys, size_t count)
{
    enum { KEYS_MAX = 96 };
    const char *names[KEYS_MAX];
    size_t used = 0;
    for (size_t i = 0; i < count && used < KEYS_MAX; i++)
        names[used++] = keys[i].name;
    const char *nearest = ppmi_suggest(name, names, used);
    return ppmi_setup_fail(object, "unknown key \"%.60s\"%s%s%s", name,
                           nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                           nearest ? "\"?" : "");
}

ppm_status ppmi_setup_read_object(const ppmi_setup_value *object, const ppmi_setup_key *keys,
                                  size_t key_count, void *target, uint64_t *out_given)
{
    const char *name;
    json_t *json;
    uint64_t given = 0;
    if (!json_is_object(object->json)) {
        return ppmi_setup_refuse(object, "an object: { \"key\": value, ... }");
    }
    json_object_foreach((json_t *)object->json, name, json)
    {
        size_t i = 0;
        if (name[0] == '_') continue;
        while (i < key_count && strcmp(keys[i].name, name) != 0)
            i++;
        if (i == key_count) return refuse_key(object, name, keys, key_count);
        const ppmi_setup_value value = ppmi_setup_member(object, name, json);
        const ppm_status status = ppmi_setup_read_value(&value, &keys[i], target);
        if (status != PPM_STATUS_OK) return status;
        if (out_given) given |= UINT64_C(1) << i;
    }
    if (out_given) *out_given = given;
    return PPM_STATUS_OK;
}

/* ---- keys that exclude each other ------------------------------------------------------------ */

static void list_keys(const ppmi_setup_key *keys, size_t count, uint64_t mask, char *buffer,
                      size_t size)
{
    size_t used = 0;
    buffer[0] = 0;
    for (size_t i = 0; i < count; i++) {
        if (!(mask >> i & 1) || used + 1 >= size) continue;
        const int n =
            snprintf(buffer + used, size - used, "%s\"%s\"", used > 0 ? ", " : "", keys[i].name);
        used += n > 0 ? (size_t)n : 0;
    }
}

ppm_status ppmi_setup_check_one(const ppmi_setup_value *object, const ppmi_setup_key *keys,
                                size_t key_count, uint64_t given, uint64_t mask, bool may_lack)
{
    char wanted[200], found[200];
    const uint64_t there = given & mask;
    if (there == 0 ? may_lack : (there & (there - 1)) == 0) return PPM_STATUS_OK;
    list_keys(keys, key_count, mask, wanted, sizeof wanted);
    list_keys(keys, key_count, there, found, sizeof found);
    return ppmi_setup_fail(object, "%s found, expected %s of %s", there ? found : "none",
                           may_lack ? "at most one" : "one", wanted);
}

ppm_status ppmi_setup_check_none(const ppmi_setup_value *object, const ppmi_setup_key *keys,
                                 size_t key_count, uint64_t given, uint64_t mask,
                                 const char *reason)
{
    char found[200];
    if ((given & mask) == 0) return PPM_STATUS_OK;
    list_keys(keys, key_count, given & mask, found, sizeof found);
    return ppmi_setup_fail(object, "%s: %s", found, reason);
}
