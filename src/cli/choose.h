/* Things of a file that are asked for by name: found, or refused with the names that there are. */
#ifndef PPM_CLI_CHOOSE_H
#define PPM_CLI_CHOOSE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "console.h"

/* What there is to choose from. */
typedef struct choice_list {
    const char *option; /* "--camera" */
    const char *thing;  /* "camera" */
    bool has_numbers;   /* a number from 1 will do as well; a name wins: one may be called "2" */
    uint32_t count;
    const char *(*name_of)(const void *user, uint32_t index); /* index from 0 */
    const void *user;
} choice_list;

/* Returns EXIT_DONE, EXIT_USAGE (none such; said on the console) or EXIT_RESOURCES. */
int choose(cli_console *console, const choice_list *list, const char *text, uint32_t *out_index);

#endif
