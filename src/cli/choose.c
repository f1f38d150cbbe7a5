/* The refusal names the nearest, and as many as fit a line. */
#include "choose.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggest.h"
#include "options.h"
#include "values.h"

static int refuse_all(cli_console *console, const choice_list *list, const char *text)
{
    console_message(console, PPM_LOG_ERROR, "%s: no %s '%s': the file has none", list->option,
                    list->thing, text);
    return EXIT_USAGE;
}

/* "'Front', 'Side', ..." */
static void write_names(const char *const *names, uint32_t count, char *buffer, size_t size)
{
    size_t length = 0;
    buffer[0] = '\0';
    for (uint32_t i = 0; i < count; i++) {
        const size_t needed = strlen(names[i]) + sizeof ", '', ...";
        if (length + needed > size) {
            snprintf(buffer + length, size - length, "%s...", i ? ", " : "");
            return;
        }
        length +=
            (size_t)snprintf(buffer + length, size - length, "%s'%s'", i ? ", " : "", names[i]);
    }
}

static int refuse(cli_console *console, const choice_list *list, const char *text)
{
    char all[200];
    const char **const names = calloc(list->count, sizeof *names);
    if (!names) return EXIT_RESOURCES;
    for (uint32_t i = 0; i < list->count; i++)
        names[i] = list->name_of(list->user, i);
    write_names(names, list->count, all, sizeof all);
    const char *const nearest = ppmi_suggest(text, names, list->count);
    console_message(console, PPM_LOG_ERROR, "%s: no %s '%s'; there %s %u: %s%s%s%s", list->option,
                    list->thing, text, list->count == 1 ? "is" : "are", list->count, all,
                    nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
    free(names);
    return EXIT_USAGE;
}

int choose(cli_console *console, const choice_list *list, const char *text, uint32_t *out_index)
{
    if (list->count == 0) return refuse_all(console, list, text);
    for (uint32_t i = 0; i < list->count; i++) {
        if (strcmp(list->name_of(list->user, i), text) == 0) {
            *out_index = i;
            return EXIT_DONE;
        }
    }
    uint64_t number = 0;
    if (list->has_numbers && value_parse_integer(text, &number) && number >= 1 &&
        number <= list->count) {
        *out_index = (uint32_t)number - 1;
        return EXIT_DONE;
    }
    return refuse(console, list, text);
}
