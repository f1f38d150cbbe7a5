/* An OBJ or MTL file as statements: lines without blanks around them, comments and empty lines left
 * out, continued lines joined. Line ends are LF, CRLF or CR. */
#ifndef PPMI_OBJ_LINES_H
#define PPMI_OBJ_LINES_H

#include <stdio.h>

#include "base/context.h"

typedef struct ppmi_obj_lines {
    ppm_context *context;
    const char *path; /* the caller's */
    FILE *file;
    char *buffer;    /* one byte more than capacity */
    size_t capacity; /* grows only for a line that is longer */
    size_t start;    /* of what is not yet handed out */
    size_t end;      /* of what was read */
    size_t newline;  /* a line feed is here, and none between start and here; or end */
    bool at_end;     /* of the file */
    size_t next_number;
    size_t number;     /* line of the latest statement, from 1: where it begins */
    ppm_status status; /* why there are no more statements; OK at the end of the file */
} ppmi_obj_lines;

/* Returns OK, INPUT_NOT_FOUND, OUT_OF_MEMORY, all reported. Close in any case. */
ppm_status ppmi_obj_lines_open(ppm_context *context, const char *path, ppmi_obj_lines *out_lines);
void ppmi_obj_lines_close(ppmi_obj_lines *lines);

/* The next statement: text[*out_length] is a line feed, and text may be changed up to there; valid
 * until the next call. NULL at the end and after a failure (lines->status, reported). */
char *ppmi_obj_lines_next(ppmi_obj_lines *lines, size_t *out_length);

/* Takes the first word off a statement: its length. *text and *length become what follows it,
 * without blanks before it. */
size_t ppmi_obj_take_word(char **text, size_t *length);

bool ppmi_obj_is_blank(char c);

/* Cuts a statement at length, with the blanks before that. */
void ppmi_obj_cut(char *text, size_t *length, size_t at);

#endif
