/* Statements out of a buffer of the file: continuations are joined in place, so a line is copied
 * only where it lies across the end of the buffer. */
#include "obj/obj_lines.h"

#include <errno.h>
#include <string.h>

enum { CHUNK = 1 << 18 };
static const size_t max_line = (size_t)1 << 28;

ppm_status ppmi_obj_lines_open(ppm_context *context, const char *path, ppmi_obj_lines *out_lines)
{
    *out_lines =
        (ppmi_obj_lines){.context = context, .path = path, .capacity = CHUNK, .next_number = 1};
    out_lines->file = fopen(path, "rb");
    if (!out_lines->file) {
        return ppmi_fail(context, PPM_STATUS_INPUT_NOT_FOUND, "%s: %s", path, strerror(errno));
    }
    setvbuf(out_lines->file, NULL, _IONBF, 0); /* there is a buffer already */
    out_lines->buffer = ppmi_alloc(context, CHUNK + 1, 1);
    if (!out_lines->buffer) {
        return ppmi_fail(context, PPM_STATUS_OUT_OF_MEMORY, "%s: out of memory", path);
    }
    return PPM_STATUS_OK;
}

void ppmi_obj_lines_close(ppmi_obj_lines *lines)
{
    if (lines->file) fclose(lines->file);
    ppmi_free(lines->context, lines->buffer);
    lines->file = NULL;
    lines->buffer = NULL;
}

/* ---- the buffer ------------------------------------------------------------------------------ */

static bool grow(ppmi_obj_lines *l)
{
    if (l->capacity >= max_line) {
        l->status = ppmi_fail(l->context, PPM_STATUS_INPUT_INVALID,
                              "%s: line %zu: it is longer than %zu bytes", l->path, l->next_number,
                              max_line);
        return false;
    }
    char *buffer = ppmi_alloc(l->context, 2 * l->capacity + 1, 1);
    if (!buffer) {
        l->status = ppmi_fail(l->context, PPM_STATUS_OUT_OF_MEMORY, "%s: line %zu: out of memory",
                              l->path, l->next_number);
        return false;
    }
    memcpy(buffer, l->buffer, l->end);
    ppmi_free(l->context, l->buffer);
    l->buffer = buffer;
    l->capacity *= 2;
    return true;
}

/* Reads on behind end, keeping what is not handed out. False after a failure. */
static bool refill(ppmi_obj_lines *l)
{
    memmove(l->buffer, l->buffer + l->start, l->end - l->start);
    l->end -= l->start;
    l->start = 0;
    if (l->end == l->capacity && !grow(l)) return false;
    const size_t wanted = l->capacity - l->end;
    const size_t count = fread(l->buffer + l->end, 1, wanted, l->file);
    if (count < wanted && ferror(l->file)) {
        l->status = ppmi_fail(l->context, PPM_STATUS_INPUT_INVALID, "%s: it cannot be read: %s",
                              l->path, strerror(errno));
        return false;
    }
    l->at_end = count < wanted;
    l->end += count;
    return true;
}

/* Makes newline right for a line that is known up to `from` bytes behind start. False after a
 * failure. */
static bool find_newline(ppmi_obj_lines *l, size_t from)
{
    if (l->newline >= l->start + from && l->newline < l->end) return true;
    for (;;) {
        const char *hit = memchr(l->buffer + l->start + from, '\n', l->end - l->start - from);
        l->newline = hit ? (size_t)(hit - l->buffer) : l->end;
        if (hit || l->at_end) return true;
        from = l->end - l->start;
        if (!refill(l)) return false;
    }
}

/* ---- lines ----------------------------------------------------------------------------------- */

bool ppmi_obj_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

static bool is_comment(const char *line, size_t length)
{
    size_t i = 0;
    while (i < length && ppmi_obj_is_blank(line[i])) {
        ++i;
    }
    return i < length && line[i] == '#';
}

/* Length of the line, of which `from` bytes are known to be inside; *out_step is the length with
 * its end. False after a failure. */
static bool find_line_end(ppmi_obj_lines *l, size_t from, size_t *out_length, size_t *out_step)
{
    if (!find_newline(l, from)) return false;
    const char *line = l->buffer + l->start;
    const size_t length = l->newline - l->start;
    const char *cr = memchr(line + from, '\r', length - from);
    *out_length = cr ? (size_t)(cr - line) : length;
    /* a return right before the line feed belongs to it; any other one ends a line itself */
    const bool is_alone = cr && *out_length + 1 < length;
    *out_step = is_alone ? *out_length + 1 : length + (l->newline < l->end);
    return true;
}

/* One line with those that continue it; the marks of continuation become blanks. */
static bool next_line(ppmi_obj_lines *l, char **out_text, size_t *out_length)
{
    size_t length, step, from = 0;
    l->number = l->next_number;
    for (;;) {
        if (!find_line_end(l, from, &length, &step)) return false;
        char *text = l->buffer + l->start;
        ++l->next_number;
        const bool is_continued =
            length > from && text[length - 1] == '\\' && step > length && !is_comment(text, length);
        if (!is_continued) {
            *out_text = text;
            *out_length = length;
            break;
        }
        memset(text + length - 1, ' ', step - length + 1);
        from = step;
    }
    l->start += step;
    return true;
}

void ppmi_obj_cut(char *text, size_t *length, size_t at)
{
    while (at > 0 && ppmi_obj_is_blank(text[at - 1])) {
        --at;
    }
    *length = at;
    text[at] = '\n';
}

static bool is_done(const ppmi_obj_lines *l)
{
    return l->status != PPM_STATUS_OK || (l->at_end && l->start == l->end);
}

char *ppmi_obj_lines_next(ppmi_obj_lines *lines, size_t *out_length)
{
    while (!is_done(lines)) {
        char *text;
        size_t length;
        if (!next_line(lines, &text, &length)) return NULL;
        if (lines->number == 1 && length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
            text += 3; /* UTF-8's byte order mark */
            length -= 3;
        }
        while (length > 0 && ppmi_obj_is_blank(*text)) {
            ++text;
            --length;
        }
        if (length == 0 || *text == '#') continue;
        ppmi_obj_cut(text, &length, length);
        *out_length = length;
        return text;
    }
    return NULL;
}

size_t ppmi_obj_take_word(char **text, size_t *length)
{
    size_t word = 0;
    while (word < *length && !ppmi_obj_is_blank((*text)[word])) {
        ++word;
    }
    size_t next = word;
    while (next < *length && ppmi_obj_is_blank((*text)[next])) {
        ++next;
    }
    *text += next;
    *length -= next;
    return word;
}
