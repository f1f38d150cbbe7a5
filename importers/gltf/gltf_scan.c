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

ppmi_gltf_span ppmi_gltf_scan_member(const char *text, ppmi_gltf_span value, const char *key)
{
    ppmi_gltf_json json = scan_within(text, value);
    ppmi_gltf_span written, found;
    if (!ppmi_gltf_json_take(&json, '{')) return (ppmi_gltf_span){0, 0};
    while (ppmi_gltf_json_peek(&json) == '"') {
        if (!ppmi_gltf_json_string(&json, &written) || !ppmi_gltf_json_take(&json, ':') ||
            !skip_value(&json, &found)) {
            break;
        }
        if (key_is(text, written, key)) return found;
        if (!ppmi_gltf_json_take(&json, ',')) break;
    }
    return (ppmi_gltf_span){0, 0};
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

const char *ppmi_gltf_scan_string(const char *text, ppmi_gltf_span value, char *buffer, size_t size)
{
    ppmi_gltf_json json = scan_within(text, value);
    ppmi_gltf_span inside;
    buffer[0] = 0;
    if (ppmi_gltf_json_peek(&json) != '"' || !ppmi_gltf_json_string(&json, &inside)) return buffer;
    if (inside.end - inside.begin >= size) {
        inside.end = inside.begin + size - 1;
        /* not within a letter or an escape, which has at most 12 bytes */
        const size_t least = inside.end > inside.begin + 12 ? inside.end - 12 : inside.begin;
        for (size_t at = inside.end; at-- > least;) {
            if (text[at] == '\\') inside.end = at;
        }
        while (inside.end > inside.begin && ((unsigned char)text[inside.end] & 0xc0) == 0x80) {
            --inside.end;
        }
    }
    buffer[ppmi_gltf_json_unescape(text, inside, buffer)] = 0;
    return buffer;
}
