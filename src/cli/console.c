/* Messages and the progress line share standard error: a message first wipes the line, the next
 * progress draws it again. Library messages arrive while the main thread waits in the library, so
 * no lock is needed. */
#include "console.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/printable.h"
#include "options.h"

void console_init(cli_console *console, int32_t verbosity)
{
    const char *const kind = getenv("TERM");
    console->verbosity = verbosity;
    console->is_terminal = isatty(STDERR_FILENO) && kind && strcmp(kind, "dumb") != 0;
    console->line_is_shown = false;
    console->is_repeating = false;
}

static ppm_log_level loudest_shown(const cli_console *console)
{
    if (console->verbosity == VERBOSITY_QUIET) return PPM_LOG_ERROR;
    return console->verbosity == VERBOSITY_VERBOSE ? PPM_LOG_DEBUG : PPM_LOG_INFO;
}

static const char *prefix(ppm_log_level level)
{
    switch (level) {
    case PPM_LOG_ERROR:
        return "ppm-render: error: ";
    case PPM_LOG_WARNING:
        return "ppm-render: warning: ";
    default:
        return "";
    }
}

void console_log(void *user, ppm_log_level level, const char *message)
{
    cli_console *const console = user;
    const bool is_note = level == PPM_LOG_INFO && console->verbosity != VERBOSITY_VERBOSE;
    if (level > loudest_shown(console) || (is_note && console->is_repeating)) return;
    console_clear_line(console);
    ppmi_print(stderr, "%s%s\n", prefix(level), message);
}

void console_message(cli_console *console, ppm_log_level level, const char *format, ...)
{
    if (level > loudest_shown(console)) return;
    console_clear_line(console);
    fputs(prefix(level), stderr);
    va_list arguments;
    va_start(arguments, format);
    ppmi_vprint(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

void console_always(cli_console *console, const char *format, ...)
{
    console_clear_line(console);
    fputs("ppm-render: ", stderr);
    va_list arguments;
    va_start(arguments, format);
    ppmi_vprint(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

void console_progress(cli_console *console, const char *text)
{
    if (console->verbosity == VERBOSITY_QUIET) return;
    if (!console->is_terminal) {
        ppmi_print(stderr, "%s\n", text);
        return;
    }
    fputc('\r', stderr);
    ppmi_print(stderr, "%s", text);
    fputs("\033[K", stderr);
    fflush(stderr);
    console->line_is_shown = true;
}

void console_clear_line(cli_console *console)
{
    if (!console->line_is_shown) return;
    fputs("\r\033[K", stderr);
    console->line_is_shown = false;
}
