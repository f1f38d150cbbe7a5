/* A table that describes every option of a program; parsing, checking, help and suggestions all
 * come from it. What is wrong is said on standard error. */
#ifndef PPM_CLI_OPTION_TABLE_H
#define PPM_CLI_OPTION_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "exit_status.h"

/* What an option's value is. */
enum {
    OPTION_SET,     /* no argument: stores .set in an int32_t */
    OPTION_TEXT,    /* const char * */
    OPTION_INTEGER, /* uint64_t */
    OPTION_COUNT,   /* uint64_t, with k, M, G */
    OPTION_REAL,    /* double */
    OPTION_CHOICE,  /* int32_t, from a list of names */
    OPTION_OWN      /* from here on the program's own */
};

typedef struct option_choice {
    const char *name; /* NULL ends a list */
    int32_t value;
} option_choice;

typedef struct option_row {
    const char *name;
    char letter;  /* 0: none */
    int32_t kind; /* OPTION_ */
    size_t field; /* offset in the program's options */
    int32_t set;
    uint64_t least, most;         /* INTEGER, COUNT */
    double low, high;             /* REAL */
    const option_choice *choices; /* CHOICE */
    bool may_lack_value;          /* --name and --name=VALUE; argument is shown as "[=VALUE]" */
    const char *argument;         /* as the help shows it */
    const char *help;             /* is broken into lines; \n\n begins one */
    const char *group;            /* a heading, where a group begins */
} option_row;

typedef struct option_table {
    const char *program;
    const char *source; /* a setup file that the values come from; NULL: the command line */
    int help_column;    /* where the texts of the help begin */
    const option_row *rows;
    size_t count;
    /* Stores a value of one of the program's own kinds; text is NULL where it is missing. Returns
     * an exit status. */
    int (*store_own)(const struct option_table *table, const option_row *row, const char *text,
                     void *options);
    /* Whether the rest of the words does not matter, as after --help. */
    bool (*is_settled)(const void *options);
} option_table;

/* Reads the options among the words of argv into options; getopt's optind is then the first of the
 * other words. Returns EXIT_DONE, EXIT_USAGE or EXIT_RESOURCES. */
int option_table_parse(const option_table *table, int argc, char **argv, void *options);

/* Stores one value by the long name of its option, as the command line would; "" is none. What is
 * wrong is told as of "render" in table->source. Returns EXIT_DONE, EXIT_INPUT or EXIT_RESOURCES.
 */
int option_table_store(const option_table *table, const char *name, const char *value,
                       void *options);

void option_table_print_help(const option_table *table, FILE *stream);

/* Each says what is wrong and returns EXIT_USAGE, of a setup file EXIT_INPUT. expected completes
 * "'value' is not ...". */
int option_complain(const option_table *table, const option_row *row, const char *value,
                    const char *expected);
int option_complain_of_all(const option_table *table, const char *message);
int option_give_hint(const option_table *table);

/* Values of the common kinds; *field is written only on success. length letters of text are the
 * name. */
int option_store_integer(const option_table *table, const option_row *row, const char *text,
                         uint64_t *field);
int option_store_real(const option_table *table, const option_row *row, const char *text,
                      double *field);
int option_store_choice(const option_table *table, const option_row *row, const char *text,
                        size_t length, int32_t *field);

#endif
