/* A name is read into pieces: letters, the place of the frame, the place of the camera. Missing
 * places are then put in, and the pieces written out. printf never sees the name. */
#include "file_pattern.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAME_DIGITS = 4, WIDTH_MOST = 20, NAME_BYTES_MOST = 80 };

typedef enum piece_kind {
    PIECE_END,
    PIECE_LETTER,
    PIECE_FRAME,
    PIECE_CAMERA,
    PIECE_BAD
} piece_kind;

typedef struct piece {
    piece_kind kind;
    const char *begin, *end; /* in the name */
    char letter;
    int width; /* of a frame's number, at least */
} piece;

static const char *last_part(const char *path)
{
    const char *const slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* %d, %04d, %c, %%, %#; anything else is bad. */
static piece read_percent(const char *at)
{
    piece result = {.kind = PIECE_BAD, .begin = at, .end = at + 1, .width = 1};
    const char *letter = at + 1;
    if (*letter == '0' && letter[1] >= '1' && letter[1] <= '9') {
        char *end = NULL;
        const long width = strtol(letter, &end, 10);
        if (*end != 'd' || width > WIDTH_MOST) return result;
        result.width = (int)width;
        letter = end;
    }
    if (*letter == 'd') result.kind = PIECE_FRAME;
    if (letter == at + 1 && *letter == 'c') result.kind = PIECE_CAMERA;
    if (letter == at + 1 && (*letter == '%' || *letter == '#')) {
        result.kind = PIECE_LETTER;
        result.letter = *letter;
    }
    if (*letter) result.end = letter + 1;
    return result;
}

static piece read_piece(const char *at)
{
    if (*at == '%') return read_percent(at);
    if (*at == '#') {
        const size_t width = strspn(at, "#");
        const piece_kind kind = width <= WIDTH_MOST ? PIECE_FRAME : PIECE_BAD;
        return (piece){.kind = kind, .begin = at, .end = at + width, .width = (int)width};
    }
    return (piece){.kind = *at ? PIECE_LETTER : PIECE_END,
                   .begin = at,
                   .end = *at ? at + 1 : at,
                   .letter = *at};
}

/* How many pieces of a kind there are; *out_first is the first of them. */
static int count_pieces(const char *path, piece_kind kind, piece *out_first)
{
    int count = 0;
    piece each = read_piece(last_part(path));
    for (; each.kind != PIECE_END; each = read_piece(each.end)) {
        if (each.kind == kind && count++ == 0) *out_first = each;
    }
    return count;
}

bool pattern_has_frame(const char *path)
{
    piece first;
    return count_pieces(path, PIECE_FRAME, &first) > 0;
}

bool pattern_has_place(const char *path)
{
    piece first;
    return pattern_has_frame(path) || count_pieces(path, PIECE_CAMERA, &first) > 0;
}

static bool is_used(const pattern_use *use)
{
    return use->has_frame || use->has_camera;
}

const char *pattern_fault(const char *path, const pattern_use *use)
{
    piece first;
    if (!is_used(use)) return NULL;
    if (count_pieces(path, PIECE_BAD, &first) > 0) {
        return "a '%' is not followed by d, 0Nd such as 04d, c, or % and # for themselves";
    }
    const int frames = count_pieces(path, PIECE_FRAME, &first);
    if (frames > 1) return "there is more than one place for the frame's number (%d, %04d, ####)";
    if (frames > 0 && !use->has_frame) {
        return "there is a place for a frame's number, but neither --frame nor --frames";
    }
    const int cameras = count_pieces(path, PIECE_CAMERA, &first);
    if (cameras > 1) return "there is more than one place for the camera's name (%c)";
    if (cameras > 0 && !use->has_camera) {
        return "there is a place for a camera's name (%c), but no --camera all";
    }
    return NULL;
}

/* ---- filling in ------------------------------------------------------------------------------ */

static const char *ending_of(const char *name)
{
    const char *const dot = strrchr(name, '.');
    return dot && dot != name ? dot : name + strlen(name);
}

static bool is_separator(char letter)
{
    return letter == '.' || letter == '_' || letter == '-';
}

/* text with insert before place, which points into it. */
static char *insert_at(const char *text, const char *place, const char *insert)
{
    char *const result = malloc(strlen(text) + strlen(insert) + 1);
    if (!result) return NULL;
    const size_t before = (size_t)(place - text);
    memcpy(result, text, before);
    strcpy(stpcpy(result + before, insert), place);
    return result;
}

/* The frame's number goes before the ending: "walk.exr" is "walk.0007.exr". */
static char *with_frame(const char *path)
{
    char place[16];
    snprintf(place, sizeof place, ".%%0%dd", FRAME_DIGITS);
    return insert_at(path, ending_of(last_part(path)), place);
}

/* The camera's name goes before the frame's number, or before the ending: "walk_####.exr" is
 * "walk_Front_0007.exr". */
static char *with_camera(const char *path)
{
    piece frame;
    const char *const name = last_part(path);
    if (count_pieces(path, PIECE_FRAME, &frame) == 0) {
        return insert_at(path, ending_of(name), ".%c");
    }
    if (frame.begin == name) return insert_at(path, name, "%c.");
    const char before = frame.begin[-1];
    if (!is_separator(before)) return insert_at(path, frame.begin, ".%c.");
    const char place[] = {before, '%', 'c', '\0'};
    return insert_at(path, frame.begin - 1, place);
}

/* The path with all places that it needs. */
static char *complete(const char *path, const pattern_use *use)
{
    piece first;
    const bool lacks_frame = use->needs_frame && !pattern_has_frame(path);
    char *const numbered = lacks_frame ? with_frame(path) : strdup(path);
    if (!numbered || !use->has_camera || count_pieces(path, PIECE_CAMERA, &first) > 0) {
        return numbered;
    }
    char *const named = with_camera(numbered);
    free(numbered);
    return named;
}

char *pattern_fill(const char *path, const pattern_use *use, int32_t frame, const char *camera)
{
    if (!is_used(use)) return strdup(path);
    char *const whole = complete(path, use);
    char *text = NULL;
    size_t size = 0;
    FILE *const stream = whole ? open_memstream(&text, &size) : NULL;
    if (!stream) {
        free(whole);
        return NULL;
    }
    fprintf(stream, "%.*s", (int)(last_part(whole) - whole), whole);
    piece each = read_piece(last_part(whole));
    for (; each.kind != PIECE_END; each = read_piece(each.end)) {
        if (each.kind == PIECE_LETTER) fputc(each.letter, stream);
        if (each.kind == PIECE_FRAME) fprintf(stream, "%0*d", each.width, (int)frame);
        if (each.kind == PIECE_CAMERA) fputs(camera, stream);
    }
    free(whole);
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}

char *pattern_escape(const char *path, const pattern_use *use)
{
    char *const result = malloc(2 * strlen(path) + 1);
    char *end = result;
    for (const char *letter = path; result && *letter; letter++) {
        if (is_used(use) && (*letter == '%' || *letter == '#')) *end++ = '%';
        *end++ = *letter;
    }
    if (result) *end = '\0';
    return result;
}

/* ---- names ----------------------------------------------------------------------------------- */

static bool is_safe(unsigned char letter)
{
    return letter >= 0x80 || (letter >= '0' && letter <= '9') || (letter >= 'A' && letter <= 'Z') ||
           (letter >= 'a' && letter <= 'z') || letter == '-' || letter == '_' || letter == '.';
}

char *pattern_safe_name(const char *name)
{
    size_t length = strlen(name);
    if (length > NAME_BYTES_MOST) {
        length = NAME_BYTES_MOST; /* not within a letter of UTF-8 */
        while (length > 0 && ((unsigned char)name[length] & 0xc0) == 0x80)
            length--;
    }
    char *const result = strndup(name, length);
    for (char *letter = result; result && *letter; letter++) {
        const bool is_hidden = letter == result && *letter == '.';
        if (is_hidden || !is_safe((unsigned char)*letter)) *letter = '_';
    }
    return result;
}
