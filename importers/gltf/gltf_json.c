/* A scanner for JSON text, strict after RFC 8259: what it accepts, any JSON parser reads alike. */
#include "gltf/gltf_json.h"

#include <math.h>
#include <string.h>

/* Length of the UTF-8 sequence at s (1..4), or 0 when it is malformed, overlong, a surrogate or
 * above U+10FFFF (RFC 3629). */
static size_t utf8_length(const unsigned char *s, size_t left)
{
    if (s[0] < 0x80) return 1;
    const size_t length = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
    if (s[0] < 0xc2 || s[0] > 0xf4 || length > left) return 0;
    for (size_t i = 1; i < length; ++i) {
        if ((s[i] & 0xc0) != 0x80) return 0;
    }
    if (s[0] == 0xe0 && s[1] < 0xa0) return 0;
    if (s[0] == 0xed && s[1] > 0x9f) return 0;
    if (s[0] == 0xf0 && s[1] < 0x90) return 0;
    if (s[0] == 0xf4 && s[1] > 0x8f) return 0;
    return length;
}

bool ppmi_gltf_json_is_utf8(const char *text, size_t length, size_t *out_bad)
{
    const unsigned char *bytes = (const unsigned char *)text;
    for (size_t i = 0; i < length;) {
        const size_t step = utf8_length(bytes + i, length - i);
        if (step == 0) {
            *out_bad = i;
            return false;
        }
        i += step;
    }
    return true;
}

void ppmi_gltf_json_place(const ppmi_gltf_json *json, size_t *out_line, size_t *out_column)
{
    size_t line = 1, begin = 0;
    for (size_t i = 0; i < json->at && i < json->length; ++i) {
        if (json->text[i] == '\n') {
            ++line;
            begin = i + 1;
        }
    }
    *out_line = line;
    *out_column = json->at - begin + 1;
}

bool ppmi_gltf_json_fail(ppmi_gltf_json *json, const char *error)
{
    if (!json->error) json->error = error;
    return false;
}

char ppmi_gltf_json_peek(ppmi_gltf_json *json)
{
    while (json->at < json->length) {
        const char c = json->text[json->at];
        if (c != ' ' && c != '\t' && c != '\n' && c != '\r') return c;
        ++json->at;
    }
    return 0;
}

bool ppmi_gltf_json_take(ppmi_gltf_json *json, char wanted)
{
    if (ppmi_gltf_json_peek(json) != wanted) return false;
    ++json->at;
    return true;
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/* What follows a backslash. */
static bool scan_escape(ppmi_gltf_json *json)
{
    if (json->at >= json->length) return ppmi_gltf_json_fail(json, "the string has no end");
    const char c = json->text[json->at];
    if (c == 0 || !strchr("\"\\/bfnrtu", c)) return ppmi_gltf_json_fail(json, "unknown escape");
    ++json->at;
    if (c != 'u') return true;
    for (int i = 0; i < 4; ++i, ++json->at) {
        if (json->at >= json->length || hex_digit(json->text[json->at]) < 0) {
            return ppmi_gltf_json_fail(json, "\\u needs four hexadecimal digits");
        }
    }
    return true;
}

bool ppmi_gltf_json_string(ppmi_gltf_json *json, ppmi_gltf_span *out_inside)
{
    if (!ppmi_gltf_json_take(json, '"')) return ppmi_gltf_json_fail(json, "expected a string");
    out_inside->begin = json->at;
    while (json->at < json->length) {
        const unsigned char c = (unsigned char)json->text[json->at];
        if (c < 0x20) return ppmi_gltf_json_fail(json, "control character in a string");
        if (c == '"') {
            out_inside->end = json->at++;
            return true;
        }
        ++json->at;
        if (c == '\\' && !scan_escape(json)) return false;
    }
    return ppmi_gltf_json_fail(json, "the string has no end");
}

/* Names what writers put in place of numbers that JSON does not have. */
static bool fail_no_value(ppmi_gltf_json *json, const char *error)
{
    static const char *const words[] = {"nan", "inf"};
    const size_t at = json->at;
    for (size_t i = 0; i < 2; ++i) {
        size_t same = 0;
        while (same < 3 && at + same < json->length &&
               (json->text[at + same] | 0x20) == words[i][same])
            ++same;
        if (same < 3) continue;
        error = i == 0 ? "NaN is no number of JSON" : "Infinity is no number of JSON";
    }
    return ppmi_gltf_json_fail(json, error);
}

static bool is_digit_at(const ppmi_gltf_json *json)
{
    return json->at < json->length && json->text[json->at] >= '0' && json->text[json->at] <= '9';
}

static bool is_char_at(const ppmi_gltf_json *json, char c)
{
    return json->at < json->length && json->text[json->at] == c;
}

/* Digits after the point or exponent, or before them; appends to *value, counts. */
static size_t scan_digits(ppmi_gltf_json *json, double *value)
{
    size_t count = 0;
    for (; is_digit_at(json); ++json->at, ++count) {
        *value = *value * 10.0 + (json->text[json->at] - '0');
    }
    return count;
}

static bool scan_exponent(ppmi_gltf_json *json, double *exponent)
{
    bool negative = is_char_at(json, '-');
    if (negative || is_char_at(json, '+')) ++json->at;
    double value = 0.0;
    if (scan_digits(json, &value) == 0) return ppmi_gltf_json_fail(json, "expected a digit");
    *exponent += negative ? -value : value;
    return true;
}

bool ppmi_gltf_json_number(ppmi_gltf_json *json, ppmi_gltf_number *out_number)
{
    const bool negative = ppmi_gltf_json_take(json, '-');
    if (!is_digit_at(json)) return fail_no_value(json, "expected a digit");
    const bool leading_zero = is_char_at(json, '0');
    double value = 0.0, exponent = 0.0;
    const size_t digits = scan_digits(json, &value);
    if (leading_zero && digits > 1) {
        return ppmi_gltf_json_fail(json, "a number cannot begin with 0 and go on with digits");
    }
    out_number->is_integer = true;
    if (is_char_at(json, '.')) {
        ++json->at;
        const size_t places = scan_digits(json, &value);
        if (places == 0) return ppmi_gltf_json_fail(json, "expected a digit");
        exponent = -(double)places;
        out_number->is_integer = false;
    }
    if (is_char_at(json, 'e') || is_char_at(json, 'E')) {
        ++json->at;
        if (!scan_exponent(json, &exponent)) return false;
        out_number->is_integer = false;
    }
    const double scaled = value == 0.0 ? 0.0 : value * pow(10.0, exponent);
    out_number->overflows = !(scaled < 1e308); /* also where value or the power overflowed */
    out_number->value = negative ? -scaled : scaled;
    return true;
}

bool ppmi_gltf_json_literal(ppmi_gltf_json *json, char *out_letter)
{
    static const char *const words[] = {"true", "false", "null"};
    *out_letter = ppmi_gltf_json_peek(json);
    for (size_t i = 0; i < 3; ++i) {
        const size_t length = strlen(words[i]);
        if (json->length - json->at >= length &&
            memcmp(json->text + json->at, words[i], length) == 0) {
            json->at += length;
            return true;
        }
    }
    return fail_no_value(json, "expected a value");
}

static unsigned long unescape_unit(const char *digits)
{
    unsigned long unit = 0;
    for (int i = 0; i < 4; ++i) {
        unit = unit << 4 | (unsigned long)hex_digit(digits[i]);
    }
    return unit;
}

static size_t put_utf8(unsigned long code, char *out)
{
    if (code < 0x80) {
        out[0] = (char)code;
        return 1;
    }
    const size_t length = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    static const unsigned char lead[] = {0, 0, 0xc0, 0xe0, 0xf0};
    for (size_t i = length - 1; i > 0; --i, code >>= 6) {
        out[i] = (char)(0x80 | (code & 0x3f));
    }
    out[0] = (char)(lead[length] | code);
    return length;
}

/* The character of a backslash and one letter. */
static char simple_escape(char letter)
{
    switch (letter) {
    case 'b':
        return '\b';
    case 'f':
        return '\f';
    case 'n':
        return '\n';
    case 'r':
        return '\r';
    case 't':
        return '\t';
    default:
        return letter;
    }
}

size_t ppmi_gltf_json_unescape(const char *text, ppmi_gltf_span span, char *buffer)
{
    size_t count = 0;
    for (size_t i = span.begin; i < span.end;) {
        if (text[i] != '\\') {
            buffer[count++] = text[i++];
        } else if (text[i + 1] != 'u') {
            buffer[count++] = simple_escape(text[i + 1]);
            i += 2;
        } else {
            unsigned long code = unescape_unit(text + i + 2);
            i += 6;
            const bool is_high = code >= 0xd800 && code < 0xdc00;
            if (is_high && span.end - i >= 6 && text[i] == '\\' && text[i + 1] == 'u') {
                const unsigned long low = unescape_unit(text + i + 2);
                if (low >= 0xdc00 && low < 0xe000) {
                    code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
                    i += 6;
                }
            }
            if (code >= 0xd800 && code < 0xe000) code = 0xfffd; /* half a pair */
            count += put_utf8(code, buffer + count);
        }
    }
    return count;
}
