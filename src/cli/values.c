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

bool value_parse_reals(const char *text, size_t most, double *values, size_t *out_count)
{
    enum { MOST = 8, LETTERS_MAX = 64 };
    double found[MOST];
    size_t count = 0;
    for (const char *end = text; end; text = end + 1) {
        char word[LETTERS_MAX];
        end = strchr(text, ',');
        const size_t length = end ? (size_t)(end - text) : strlen(text);
        if (count == most || count == MOST || length >= sizeof word) return false;
        memcpy(word, text, length);
        word[length] = '\0';
        if (!value_parse_real(word, &found[count++])) return false;
        if (!end) break;
    }
    memcpy(values, found, count * sizeof *found);
    *out_count = count;
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
