/* The command line of ppm-compare, as values that have been checked. */
#ifndef PPM_COMPARE_OPTIONS_H
#define PPM_COMPARE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "cli/exit_status.h"

enum { ACTION_COMPARE = 0, ACTION_HELP, ACTION_VERSION };
/* What a heat map can show. */
enum { HEAT_FLIP = 0, HEAT_RELATIVE, HEAT_SQUARED };
/* What --fail-above can be about. */
enum { LIMIT_MSE, LIMIT_RELATIVE_MSE, LIMIT_FLIP, LIMIT_BROKEN, LIMIT_COUNT };
extern const char *const limit_names[LIMIT_COUNT];

typedef struct real_option {
    bool is_given;
    double value;
} real_option;

/* 0 or NULL: not given, unless a comment says otherwise. Strings belong to argv. */
typedef struct compare_options {
    int32_t action; /* ACTION_ */
    const char *test, *reference;
    int32_t json; /* 1: print JSON */
    real_option trim, peak, exposure_ev;
    real_option pixels_per_degree; /* a default has been filled in */
    const char *heat;
    int32_t heat_of; /* HEAT_ */
    real_option heat_top;
    real_option limits[LIMIT_COUNT];
} compare_options;

/* Reads argv. What is wrong is said on standard error. Returns EXIT_DONE or EXIT_USAGE. */
int compare_options_parse(int argc, char **argv, compare_options *out_options);

void compare_options_print_help(FILE *stream);

#endif
