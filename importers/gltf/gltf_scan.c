/* The check has bounded the depth of nesting; still the walk over a value only counts brackets. */
#include "gltf/gltf_scan.h"

#include <string.h>

/* A scanner that ends where value ends. */
static ppmi_gltf_json scan_within(const char *text, ppmi_gltf_span value)
{
    return (ppmi_gltf_json){.text = text, .length = value.end, .at = value.begin};
}

ppmi_gltf_span ppmi_gltf_scan_root(size_t length)
{
    return (ppmi_gltf_span){0, length};
}

/* Moves behind the next value; false at anything that is none. */
static bool skip_value(ppmi_gltf_json *json, ppmi_gltf_span *out_value)
{
    ppmi_gltf_span inside;
    size_t depth = 0;
    ppmi_gltf_json_peek(json);
    out_value->begin = json->at;
    do {
        const char next = ppmi_gltf_json_peek(json);
        if (next == 0) return false;
        if (next == '"') {
            if (!ppmi_gltf_json_string(json, &inside)) return false;
            continue;
        }
        if (depth == 0 && strchr(",:]}", next)) return false;
        depth += next == '{' || next == '[';
        depth -= next == '}' || next == ']';
        ++json->at;
        if (strchr("{}[],:", next)) continue;
        while (json->at < json->length && !strchr("{}[],:\" \t\r\n", json->text[json->at])) {
            ++json->at; /* a number or a literal */
        }
    } while (depth > 0);
    out_value->end = json->at;
    return true;
}

static bool key_is(const char *text, ppmi_gltf_span written, const char *key)
{
    const size_t length = strlen(key);
    return written.end - written.begin == length && memcmp(text + written.begin, key, length) == 0;
}

/* A member, with the first of the keys that it is; *out_key is count when it is none of them. */
static bool next_member(ppmi_gltf_json *json, const char *const *keys, size_t count,
                        size_t *out_key, ppmi_gltf_span *out_value)
{
    ppmi_gltf_span written;
    if (ppmi_gltf_json_peek(json) != '"' || !ppmi_gltf_json_string(json, &written) ||
        !ppmi_gltf_json_take(json, ':') || !skip_value(json, out_value)) {
        return false;
    }
    for (*out_key = 0; *out_key < count; ++*out_key) {
        if (key_is(json->text, written, keys[*out_key])) break;
    }
    return true;
}

void ppmi_gltf_scan_members(const char *text, ppmi_gltf_span value, const char *const *keys,
                            size_t count, ppmi_gltf_span *out_values)
{
    ppmi_gltf_json json = scan_within(text, value);
    ppmi_gltf_span found;
    size_t key = 0, missing = count;
    for (size_t i = 0; i < count; ++i) {
        out_values[i] = (ppmi_gltf_span){0, 0};
    }
    if (!ppmi_gltf_json_take(&json, '{')) return;
    while (missing > 0 && next_member(&json, keys, count, &key, &found)) {
        if (key < count && out_values[key].end == 0) {
            out_values[key] = found;
            --missing;
        }
        if (!ppmi_gltf_json_take(&json, ',')) return;
    }
}

ppmi_gltf_span ppmi_gltf_scan_member(const char *text, ppmi_gltf_span value, const char *key)
{
    ppmi_gltf_span found;
    ppmi_gltf_scan_members(text, value, &key, 1, &found);
    return found;
}

bool ppmi_gltf_scan_next(const char *text, ppmi_gltf_span value, size_t *cursor,
                         ppmi_gltf_span *out_element)
{
    ppmi_gltf_json json = scan_within(text, value);
    if (*cursor > 0) {
        json.at = *cursor;
        if (!ppmi_gltf_json_take(&json, ',')) return false;
    } else if (!ppmi_gltf_json_take(&json, '[')) {
        return false;
    }
    if (!skip_value(&json, out_element)) return false;
    *cursor = json.at;
    return true;
}

double ppmi_gltf_scan_number(const char *text, ppmi_gltf_span value, double otherwise)
{
    ppmi_gltf_json json = scan_within(text, value);
    ppmi_gltf_number number;
    const char next = ppmi_gltf_json_peek(&json);
    const bool is_number = next == '-' || (next >= '0' && next <= '9');
    return is_number && ppmi_gltf_json_number(&json, &number) ? number.value : otherwise;
}

/* The bytes of the letter at `at`: an escape (\n, \u00fc, two of them for what is beyond 16
 * bits), or UTF-8. */
static size_t letter_bytes(const char *at)
{
    const unsigned char lead = (unsigned char)*at;
    if (lead == '\\' && at[1] != 'u') return 2;
    if (lead == '\\') {
        const bool is_first_of_two = (at[2] == 'd' || at[2] == 'D') && strchr("89abAB", at[3]);
        return is_first_of_two ? 12 : 6;
    }
    return lead < 0xc0 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
}

const char *ppmi_gltf_scan_string(const char *text, ppmi_gltf_span value, char *buffer, size_t size)
{
    ppmi_gltf_json json = scan_within(text, value);
    ppmi_gltf_span inside;
    buffer[0] = 0;
    if (ppmi_gltf_json_peek(&json) != '"' || !ppmi_gltf_json_string(&json, &inside)) return buffer;
    const size_t most = inside.begin + size - 1;
    if (inside.end > most) {
        size_t at = inside.begin;
        for (size_t next = at; next <= most; next += letter_bytes(text + next)) {
            at = next;
        }
        inside.end = at;
    }
    buffer[ppmi_gltf_json_unescape(text, inside, buffer)] = 0;
    return buffer;
}
