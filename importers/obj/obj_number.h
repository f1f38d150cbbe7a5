/* Words that should be numbers: what programs of several languages and C libraries write, and what
 * is none. */
#ifndef PPMI_OBJ_NUMBER_H
#define PPMI_OBJ_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

enum {
    PPMI_OBJ_NUMBER,
    PPMI_OBJ_NOT_FINITE,    /* nan, -inf, -1.#IND00, 1.#QNAN */
    PPMI_OBJ_DECIMAL_COMMA, /* 0,5 */
    PPMI_OBJ_NO_NUMBER
};

/* Which of these a word is. */
int ppmi_obj_number_kind(const char *word, size_t length);

/* Where the comment of a statement of numbers begins: at a '#' that is in no number. length where
 * there is none. */
size_t ppmi_obj_comment_of_numbers(const char *text, size_t length);

/* Makes decimal commas points, in place, and commas between numbers blanks: "0,5" becomes "0.5",
 * and "1,0,0" and "0.5, 0.2" become "1 0 0" and "0.5  0.2". Whether there were any. */
bool ppmi_obj_mend_commas(char *text, size_t length);

/* The length of a name without the last comment in it, which begins with a '#' behind a blank;
 * length where there is none. */
size_t ppmi_obj_name_without_comment(const char *text, size_t length);

/* The length of a name that nothing else refers to, without its comment: as above for all comments,
 * but "Box #2" is a name. */
size_t ppmi_obj_plain_name_length(const char *text, size_t length);

#endif
