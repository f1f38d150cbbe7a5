/* What the program says on standard error: messages, and one line that is rewritten. */
#ifndef PPM_CLI_CONSOLE_H
#define PPM_CLI_CONSOLE_H

#include <stdbool.h>
#include <stdint.h>

#include "ppm/context.h"

typedef struct cli_console {
    int32_t verbosity;  /* VERBOSITY_ */
    bool is_terminal;   /* standard error is a terminal that can rewrite a line */
    bool line_is_shown; /* a progress line stands there now */
    bool is_repeating;  /* the library says again what it has said: its notes are left out */
} cli_console;

void console_init(cli_console *console, int32_t verbosity);

/* The context's log callback; user is the console. */
void console_log(void *user, ppm_log_level level, const char *message);

__attribute__((format(printf, 3, 4))) void
console_message(cli_console *console, ppm_log_level level, const char *format, ...);

/* A message that is said even with --quiet, though it is no error. */
__attribute__((format(printf, 2, 3))) void console_always(cli_console *console, const char *format,
                                                          ...);

/* Shows text as the line that is rewritten (terminal), or as a line of its own. */
void console_progress(cli_console *console, const char *text);

/* Takes the rewritten line away. */
void console_clear_line(cli_console *console);

#endif
