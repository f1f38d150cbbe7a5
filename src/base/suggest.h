/* "Did you mean ...?": the nearest of a list of names. */
#ifndef PPMI_BASE_SUGGEST_H
#define PPMI_BASE_SUGGEST_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The candidate that word was most likely meant to be, or NULL when none is near: at most
 * strlen(word) / 3 + 1 typing mistakes away (letter case is not counted), or beginning with word.
 * Of equally near ones the first. NULL candidates are skipped. Any thread. */
const char *ppmi_suggest(const char *word, const char *const *candidates, size_t count);

#ifdef __cplusplus
}
#endif

#endif
