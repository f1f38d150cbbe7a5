/* Text for a terminal: names come from strangers, and a terminal obeys some control characters. */
#ifndef PPMI_BASE_PRINTABLE_H
#define PPMI_BASE_PRINTABLE_H

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Copies text to out, of size bytes (at least 1), with each byte of a control character (of C0, DEL
 * or, in UTF-8, C1) as \xNN. What has no room is cut off, between characters. Any thread. */
void ppmi_printable(const char *text, char *out, size_t size);

/* fprintf of text that is shown as ppmi_printable has it, but for newlines at the beginning and the
 * end of format, and cut off after some thousand characters. */
__attribute__((format(printf, 2, 3))) void ppmi_print(FILE *stream, const char *format, ...);
/* The same with a list of arguments. */
__attribute__((format(printf, 2, 0))) void ppmi_vprint(FILE *stream, const char *format,
                                                       va_list arguments);

#ifdef __cplusplus
}
#endif

#endif
