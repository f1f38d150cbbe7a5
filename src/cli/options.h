/* The command line of ppm-render, as values that have been checked. */
#ifndef PPM_CLI_OPTIONS_H
#define PPM_CLI_OPTIONS_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "exit_status.h"

enum { ACTION_RENDER = 0, ACTION_HELP, ACTION_VERSION, ACTION_LIST_VIEWS };
enum { VERBOSITY_QUIET = -1, VERBOSITY_NORMAL = 0, VERBOSITY_VERBOSE = 1 };

typedef struct image_size {
    uint32_t width, height; /* 0: not said */
} image_size;

/* 0 or NULL: not given, unless a comment says otherwise. Strings belong to argv. */
typedef struct cli_options {
    int32_t action;    /* ACTION_ */
    int32_t verbosity; /* VERBOSITY_ */
    const char *input;
    const char **outputs; /* output_count paths; owned */
    size_t output_count;
    const char *stats;

    uint64_t passes; /* a default has been filled in unless there is a time */
    double seconds;

    int32_t integrator; /* PPM_INTEGRATOR_ */
    image_size size;
    uint64_t photons;
    double radius_m;
    double alpha;
    uint64_t max_depth;
    uint64_t seed;
    uint64_t threads;

    const char *camera;
    const char *environment;
    int32_t light_units;  /* PPM_LIGHT_UNITS_ */
    int32_t transmission; /* PPM_TRANSMISSION_POLICY_ */

    double exposure_ev;
    const char *display;
    const char *view;
    const char *ocio;
} cli_options;

/* Reads argv. What is wrong is said on standard error. Returns EXIT_DONE, EXIT_USAGE or
 * EXIT_RESOURCES; cli_options_deinit is due in every case. */
int cli_options_parse(int argc, char **argv, cli_options *out_options);
void cli_options_deinit(cli_options *options);

void cli_options_print_help(FILE *stream);

#endif
