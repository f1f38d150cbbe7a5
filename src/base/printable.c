#include "base/printable.h"

#include <stdbool.h>
#include <string.h>

/* How many bytes at text are a control character: 0, 1 or 2. */
static size_t control_length(const unsigned char *text)
{
    if (text[0] < 0x20 || text[0] == 0x7f) return 1;
    return text[0] == 0xc2 && text[1] >= 0x80 && text[1] < 0xa0 ? 2 : 0;
}

void ppmi_printable(const char *text, char *out, size_t size)
{
    const size_t most = 2 * sizeof "\\xNN"; /* of one character, with its zero */
    size_t length = 0;
    const unsigned char *from = (const unsigned char *)text;
    while (*from && length + most <= size) {
        const size_t control = control_length(from);
        if (control == 0) out[length++] = (char)*from++;
        for (size_t i = 0; i < control; i++)
            length += (size_t)snprintf(out + length, size - length, "\\x%02x", *from++);
    }
    out[length] = '\0';
}

/* On the stack: what is said when memory is out must not want any. */
void ppmi_vprint(FILE *stream, const char *format, va_list arguments)
{
    enum { ROOM = 8192 }; /* two paths and more */
    char text[ROOM], shown[2 * ROOM];
    for (; *format == '\n'; format++)
        fputc('\n', stream);
    const size_t format_length = strlen(format);
    const bool ends_line = format_length > 0 && format[format_length - 1] == '\n';
    const int whole = vsnprintf(text, sizeof text, format, arguments);
    const size_t length = whole < 0 ? 0 : strlen(text);
    text[length] = '\0';
    if (ends_line && length > 0 && (size_t)whole == length) text[length - 1] = '\0';
    ppmi_printable(text, shown, sizeof shown);
    fputs(shown, stream);
    if (ends_line) fputc('\n', stream);
}

void ppmi_print(FILE *stream, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    ppmi_vprint(stream, format, arguments);
    va_end(arguments);
}
