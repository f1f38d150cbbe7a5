/* Nearest name by edit distance: insertions, deletions, replacements and swaps of neighbours, each
 * at a cost of one ("optimal string alignment", the restricted form of Damerau 1964). */
#include "base/suggest.h"

#include <ctype.h>
#include <string.h>

/* Names are short; a longer word is a path or an accident, and gets no suggestion. */
enum { LENGTH_MAX = 63, NO_MATCH = 2 * LENGTH_MAX + 2 };

static char lower(char letter)
{
    return (char)tolower((unsigned char)letter);
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Three rows of the table are enough: a swap looks back two. */
static int edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    int rows[3][LENGTH_MAX + 1];
    int *before = rows[0], *previous = rows[1], *current = rows[2];
    for (size_t j = 0; j <= b_length; j++)
        previous[j] = (int)j;
    for (size_t i = 1; i <= a_length; i++) {
        current[0] = (int)i;
        for (size_t j = 1; j <= b_length; j++) {
            const int replaced = previous[j - 1] + (lower(a[i - 1]) != lower(b[j - 1]));
            current[j] = least(replaced, 1 + least(previous[j], current[j - 1]));
            const int is_swap = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                                lower(a[i - 2]) == lower(b[j - 1]);
            if (is_swap) current[j] = least(current[j], 1 + before[j - 2]);
        }
        int *const oldest = before;
        before = previous;
        previous = current;
        current = oldest;
    }
    return previous[b_length];
}

static int begins_with(const char *text, const char *word, size_t word_length)
{
    for (size_t i = 0; i < word_length; i++) {
        if (lower(text[i]) != lower(word[i])) return 0; /* also at the end of text */
    }
    return word_length > 0;
}

/* Distances are doubled so that a shared beginning can count as half a mistake: a name cut short
 * ("ACES" for "ACES 1.0 - SDR Video") ranks behind a single slip and before anything else. */
static int badness(const char *word, size_t word_length, const char *candidate)
{
    const size_t length = strlen(candidate);
    if (length > LENGTH_MAX) return NO_MATCH;
    const int distance = edit_distance(word, word_length, candidate, length);
    if (distance > 1 && begins_with(candidate, word, word_length)) return 3;
    return distance <= (int)(word_length / 3 + 1) ? 2 * distance : NO_MATCH;
}

const char *ppmi_suggest(const char *word, const char *const *candidates, size_t count)
{
    if (!word || !candidates) return NULL;
    const size_t word_length = strlen(word);
    if (word_length == 0 || word_length > LENGTH_MAX) return NULL;
    const char *best = NULL;
    int best_badness = NO_MATCH;
    for (size_t i = 0; i < count; i++) {
        if (!candidates[i]) continue;
        const int candidate_badness = badness(word, word_length, candidates[i]);
        if (candidate_badness < best_badness) {
            best_badness = candidate_badness;
            best = candidates[i];
        }
    }
    return best;
}
