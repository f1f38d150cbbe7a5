/* strtod and strtoull accept more than a command line should: leading blanks, signs on unsigned
 * numbers, hexadecimal, "inf", "nan", trailing letters. */
#include "values.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_digit(char letter)
{
    return letter >= '0' && letter <= '9';
}

/* Reads digits from *cursor and moves it behind them. */
static bool take_digits(const char **cursor, uint64_t *out_value)
{
    if (!is_digit(**cursor)) return false;
    char *end = NULL;
    errno = 0;
    const unsigned long long value = strtoull(*cursor, &end, 10);
    if (errno != 0) return false;
    *cursor = end;
    *out_value = value;
    return true;
}

bool value_parse_integer(const char *text, uint64_t *out_value)
{
    uint64_t value = 0;
    if (!take_digits(&text, &value) || *text != '\0') return false;
    *out_value = value;
    return true;
}

bool value_parse_count(const char *text, uint64_t *out_value)
{
    uint64_t value = 0;
    if (!take_digits(&text, &value)) return false;
    unsigned shift = 0;
    switch (*text) {
    case 'k':
    case 'K':
        shift = 10;
        break;
    case 'M':
        shift = 20;
        break;
    case 'G':
        shift = 30;
        break;
    }
    if (shift > 0) text++;
    if (*text != '\0' || value > (UINT64_MAX >> shift)) return false;
    *out_value = value << shift;
    return true;
}

bool value_parse_real(const char *text, double *out_value)
{
    if (*text == '\0' || text[strspn(text, "0123456789+-.eE")] != '\0') return false;
    char *end = NULL;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(value)) return false;
    *out_value = value;
    return true;
}

bool value_parse_reals(const char *text, double *out_values, size_t count)
{
    enum { COUNT_MAX = 8 };
    double values[COUNT_MAX];
    if (count > COUNT_MAX) return false;
    for (size_t i = 0; i < count; i++) {
        char word[64];
        const size_t length = strcspn(text, ",");
        const bool is_last = text[length] == '\0';
        if (length >= sizeof word || is_last != (i + 1 == count)) return false;
        memcpy(word, text, length);
        word[length] = '\0';
        if (!value_parse_real(word, &values[i])) return false;
        text += length + 1;
    }
    memcpy(out_values, values, count * sizeof *values);
    return true;
}

bool value_parse_size(const char *text, uint32_t *out_width, uint32_t *out_height)
{
    uint64_t width = 0, height = 0;
    if (!take_digits(&text, &width)) return false;
    if (*text != 'x' && *text != 'X') return false;
    text++;
    if (!take_digits(&text, &height) || *text != '\0') return false;
    if (width > UINT32_MAX || height > UINT32_MAX) return false;
    *out_width = (uint32_t)width;
    *out_height = (uint32_t)height;
    return true;
}
