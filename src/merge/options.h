/* The command line of ppm-merge, as values that have been checked. */
#ifndef PPMI_MERGE_OPTIONS_H
#define PPMI_MERGE_OPTIONS_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { MERGE_ACTION_MERGE = 0, MERGE_ACTION_HELP, MERGE_ACTION_VERSION };

typedef struct merge_options {
    int32_t action; /* MERGE_ACTION_ */
    char *const *inputs;
    size_t input_count;
    const char *output;
    int32_t is_half;
    int32_t packing;         /* row of the names of compressions */
    const char *compression; /* as OpenImageIO calls it */
    int32_t is_quiet;
} merge_options;

/* Reads argv, whose words may be moved. What is wrong is said on standard error. Returns an exit
 * status. */
int merge_options_parse(int argc, char **argv, merge_options *out_options);
void merge_options_print_help(FILE *stream);

#endif
