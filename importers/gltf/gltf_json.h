/* A scanner for JSON text (RFC 8259): tokens and their places, no tree. gltf_check.c walks a
 * document with it before tinygltf sees the text. */
#ifndef PPMI_GLTF_JSON_H
#define PPMI_GLTF_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A part of the text. */
typedef struct ppmi_gltf_span {
    size_t begin, end;
} ppmi_gltf_span;

typedef struct ppmi_gltf_json {
    const char *text; /* not ended by a zero */
    size_t length;
    size_t at;
    const char *error; /* the first thing wrong, at `at`; NULL so far */
} ppmi_gltf_json;

typedef struct ppmi_gltf_number {
    double value;    /* to about 15 digits; for checks, not for geometry */
    bool is_integer; /* written without point and exponent */
    bool overflows;  /* as a double */
} ppmi_gltf_number;

/* Finds the first byte that is not UTF-8; true when there is none. */
bool ppmi_gltf_json_is_utf8(const char *text, size_t length, size_t *out_bad);

/* Line and column, from 1, of a place in the text. */
void ppmi_gltf_json_place(const ppmi_gltf_json *json, size_t *out_line, size_t *out_column);

/* Sets error at the present place and returns false. The first error stays. */
bool ppmi_gltf_json_fail(ppmi_gltf_json *json, const char *error);

/* Skips white space; the next character, or 0 at the end of the text. */
char ppmi_gltf_json_peek(ppmi_gltf_json *json);

/* Takes one punctuation character if it is the next one. */
bool ppmi_gltf_json_take(ppmi_gltf_json *json, char wanted);

/* A string; the span is what stands between the quotes, escapes and all. */
bool ppmi_gltf_json_string(ppmi_gltf_json *json, ppmi_gltf_span *out_inside);

bool ppmi_gltf_json_number(ppmi_gltf_json *json, ppmi_gltf_number *out_number);

/* true, false or null: the first letter. */
bool ppmi_gltf_json_literal(ppmi_gltf_json *json, char *out_letter);

/* Decodes the inside of a string to UTF-8 in buffer, which holds at least span.end - span.begin
 * bytes and gets no zero at its end. Returns the number of bytes: never more than the span. */
size_t ppmi_gltf_json_unescape(const char *text, ppmi_gltf_span span, char *buffer);

#endif
