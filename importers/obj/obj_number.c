/* Microsoft's C library wrote -1.#IND and 1.#QNAN for what is no number until 2015, and 1.#INF for
 * infinity, each with zeros behind. */
#include "obj/obj_number.h"

#include <string.h>
#include <strings.h>

#include "obj/obj_lines.h"

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Whether the '#' at i is that of 1.#IND. */
static bool is_in_number(const char *text, size_t length, size_t i)
{
    return i >= 2 && i + 1 < length && (text[i - 1] == '.' || text[i - 1] == ',') &&
           text[i - 2] == '1' && (i == 2 || !is_digit(text[i - 3])) &&
           strchr("IQSJiqsj", text[i + 1]) != NULL;
}

size_t ppmi_obj_comment_of_numbers(const char *text, size_t length)
{
    const char *at = memchr(text, '#', length);
    while (at && is_in_number(text, length, (size_t)(at - text))) {
        ++at;
        at = memchr(at, '#', length - (size_t)(at - text));
    }
    return at ? (size_t)(at - text) : length;
}

static size_t skip_digits(const char *word, size_t length, size_t i)
{
    while (i < length && is_digit(word[i])) {
        ++i;
    }
    return i;
}

/* Whether word[i ..] is digits with at most one mark among them, and an exponent. */
static bool is_decimal(const char *word, size_t length, size_t i, char mark)
{
    const size_t whole = skip_digits(word, length, i);
    size_t digits = whole - i, at = whole;
    if (at < length && word[at] == mark) {
        at = skip_digits(word, length, whole + 1);
        digits += at - whole - 1;
    }
    if (digits == 0) return false;
    if (at < length && (word[at] == 'e' || word[at] == 'E')) {
        size_t from = at + 1;
        from += from < length && (word[from] == '-' || word[from] == '+');
        at = skip_digits(word, length, from);
        if (at == from) return false;
    }
    return at == length;
}

int ppmi_obj_number_kind(const char *word, size_t length)
{
    const size_t sign = length > 0 && (word[0] == '-' || word[0] == '+');
    const char *rest = word + sign;
    const size_t left = length - sign;
    if (is_decimal(word, length, sign, '.')) return PPMI_OBJ_NUMBER;
    if (is_decimal(word, length, sign, ',')) return PPMI_OBJ_DECIMAL_COMMA;
    if (left >= 3 && (strncasecmp(rest, "nan", 3) == 0 || strncasecmp(rest, "inf", 3) == 0 ||
                      is_in_number(rest, left, 2))) {
        return PPMI_OBJ_NOT_FINITE;
    }
    return PPMI_OBJ_NO_NUMBER;
}

/* One word, whose last commas part it from the next. */
static bool mend_word(char *word, size_t length)
{
    size_t end = length;
    while (end > 0 && word[end - 1] == ',') {
        word[--end] = ' ';
    }
    const bool is_decimal = ppmi_obj_number_kind(word, end) == PPMI_OBJ_DECIMAL_COMMA;
    bool is_mended = end < length;
    for (size_t i = 0; i < end; ++i) {
        if (word[i] != ',') continue;
        word[i] = is_decimal ? '.' : ' ';
        is_mended = true;
    }
    return is_mended;
}

bool ppmi_obj_mend_commas(char *text, size_t length)
{
    bool is_any = false;
    for (size_t i = 0; i < length;) {
        size_t end = i;
        while (end < length && !ppmi_obj_is_blank(text[end])) {
            ++end;
        }
        if (mend_word(text + i, end - i)) is_any = true;
        i = end + 1;
    }
    return is_any;
}

/* ---- names ----------------------------------------------------------------------------------- */

static size_t without_blanks(const char *text, size_t length)
{
    while (length > 0 && ppmi_obj_is_blank(text[length - 1])) {
        --length;
    }
    return length;
}

size_t ppmi_obj_name_without_comment(const char *text, size_t length)
{
    for (size_t i = length; i-- > 1;) {
        if (text[i] == '#' && ppmi_obj_is_blank(text[i - 1])) return without_blanks(text, i);
    }
    return length;
}

size_t ppmi_obj_plain_name_length(const char *text, size_t length)
{
    for (size_t i = 0; i < length; ++i) {
        const bool begins = text[i] == '#' && (i == 0 || ppmi_obj_is_blank(text[i - 1]));
        const bool is_count = i + 1 < length && is_digit(text[i + 1]);
        if (begins && !is_count) return without_blanks(text, i);
    }
    return length;
}
