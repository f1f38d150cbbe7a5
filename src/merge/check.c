/* The average of different pictures is no picture, and that of equal noise no better than one. */
#include "merge/check.h"

#include <inttypes.h>
#include <string.h>

/* ---- the header ------------------------------------------------------------------------------ */

static ppm_status check_attributes(ppm_context *context, const merge_source *a,
                                   const merge_source *b)
{
    static const struct {
        const char *name, *what;
    } attributes[] = {
        {"ppm:workingSpace", "colour spaces"}, /* first: all colours of the scene differ with it */
        {"colorInteropID", "colour spaces"},
        {"ppm:frame", "frames"}, /* likewise: what moves is elsewhere */
        {"ppm:sceneDigest", "scenes"},
        {"ppm:cameraDigest", "cameras"},
        {"ppm:camera", "cameras"},
        {"ppm:integrator", "integrators"},
    };
    char a_buffer[32], b_buffer[32];
    for (size_t i = 0; i < sizeof attributes / sizeof attributes[0]; i++) {
        const char *const name = attributes[i].name;
        const char *const a_text = merge_source_text(a, name, a_buffer, sizeof a_buffer);
        const char *const b_text = merge_source_text(b, name, b_buffer, sizeof b_buffer);
        if (strcmp(a_text, b_text) == 0) continue;
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s and %s are of different %s: %s is '%s' and '%s'", a->path, b->path,
                         attributes[i].what, name, a_text, b_text);
    }
    return PPM_STATUS_OK;
}

/* The length of the word that text begins with. */
static size_t word_length(const char *text)
{
    return strcspn(text, " ");
}

/* The word of text that begins like key, "width=": NULL if there is none. */
static const char *find_option(const char *text, const char *key, size_t key_length)
{
    while (*text) {
        if (strncmp(text, key, key_length) == 0) return text;
        text += word_length(text);
        text += strspn(text, " ");
    }
    return NULL;
}

/* Whether each word of a is in b; seeds may differ. *out_word is the first that is not. */
static bool has_options(const char *a, const char *b, const char **out_word)
{
    for (const char *word = a; *word; word += strspn(word, " ")) {
        const size_t length = word_length(word), key_length = strcspn(word, "= ") + 1;
        const char *const other = find_option(b, word, key_length);
        const bool is_equal =
            other && word_length(other) == length && strncmp(word, other, length) == 0;
        *out_word = word;
        if (!is_equal && strncmp(word, "seed=", 5) != 0) return false;
        word += length;
    }
    return true;
}

static ppm_status check_options(ppm_context *context, const merge_source *a, const merge_source *b)
{
    char a_buffer[32], b_buffer[32];
    const char *const a_text = merge_source_text(a, "ppm:options", a_buffer, sizeof a_buffer);
    const char *const b_text = merge_source_text(b, "ppm:options", b_buffer, sizeof b_buffer);
    const char *word = NULL;
    if (has_options(a_text, b_text, &word) && has_options(b_text, a_text, &word)) {
        return PPM_STATUS_OK;
    }
    const size_t key_length = strcspn(word, "= ") + 1;
    const char *const in_a = find_option(a_text, word, key_length);
    const char *const in_b = find_option(b_text, word, key_length);
    return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                     "%s and %s are of different options: %.*s and %.*s", a->path, b->path,
                     in_a ? (int)word_length(in_a) : 7, in_a ? in_a : "nothing",
                     in_b ? (int)word_length(in_b) : 7, in_b ? in_b : "nothing");
}

static ppm_status check_seeds(ppm_context *context, const merge_source *a, const merge_source *b)
{
    for (size_t i = 0; i < a->seed_count; i++) {
        for (size_t k = 0; k < b->seed_count; k++) {
            if (a->seeds[i] != b->seeds[k]) continue;
            return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                             "%s and %s both hold seed %" PRIu64 ": the same noise twice", a->path,
                             b->path, a->seeds[i]);
        }
    }
    return PPM_STATUS_OK;
}

/* ---- pixels ---------------------------------------------------------------------------------- */

static ppm_status check_windows(ppm_context *context, const merge_source *a, const merge_source *b)
{
    const ppmi_layered_info *const x = &a->info, *const y = &b->info;
    if (x->full_width != y->full_width || x->full_height != y->full_height) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s and %s are of different sizes: %u x %u and %u x %u pixels", a->path,
                         b->path, x->full_width, x->full_height, y->full_width, y->full_height);
    }
    if (x->x != y->x || x->y != y->y || x->width != y->width || x->height != y->height) {
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s and %s are different parts of the picture: %u x %u pixels at %d,%d "
                         "and %u x %u at %d,%d",
                         a->path, b->path, x->width, x->height, x->x, x->y, y->width, y->height,
                         y->x, y->y);
    }
    return PPM_STATUS_OK;
}

static ppm_status check_has_channels(ppm_context *context, const merge_source *a,
                                     const merge_source *b)
{
    for (uint32_t i = 0; i < a->info.channel_count; i++) {
        const char *const name = ppmi_layered_input_channel(a->input, i);
        if (merge_source_channel(b, name) != UINT32_MAX) continue;
        return ppmi_fail(context, PPM_STATUS_INPUT_INVALID,
                         "%s has the channel '%s', %s has not: both need the same layers", a->path,
                         name, b->path);
    }
    return PPM_STATUS_OK;
}

static ppm_status check_pair(ppm_context *context, const merge_source *a, const merge_source *b)
{
    ppm_status status = check_attributes(context, a, b);
    if (status == PPM_STATUS_OK) status = check_options(context, a, b);
    if (status == PPM_STATUS_OK) status = check_windows(context, a, b);
    if (status == PPM_STATUS_OK) status = check_has_channels(context, a, b);
    if (status == PPM_STATUS_OK) status = check_has_channels(context, b, a);
    return status;
}

static void warn_of_versions(ppm_context *context, const merge_source *a, const merge_source *b)
{
    char a_buffer[32], b_buffer[32];
    const char *const a_text = merge_source_text(a, "ppm:version", a_buffer, sizeof a_buffer);
    const char *const b_text = merge_source_text(b, "ppm:version", b_buffer, sizeof b_buffer);
    if (strcmp(a_text, b_text) == 0) return;
    ppmi_log(context, PPM_LOG_WARNING, "%s and %s are by different versions: %s and %s", a->path,
             b->path, a_text, b_text);
}

ppm_status merge_check(ppm_context *context, const merge_source *sources, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        const ppm_status status = check_pair(context, &sources[0], &sources[i]);
        if (status != PPM_STATUS_OK) return status;
        warn_of_versions(context, &sources[0], &sources[i]);
    }
    for (size_t i = 0; i < count; i++) {
        for (size_t k = i + 1; k < count; k++) {
            const ppm_status status = check_seeds(context, &sources[i], &sources[k]);
            if (status != PPM_STATUS_OK) return status;
        }
    }
    return PPM_STATUS_OK;
}
