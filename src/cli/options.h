/* The command line of ppm-render, as values that have been checked. */
#ifndef PPM_CLI_OPTIONS_H
#define PPM_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Exit statuses; they are part of the program's contract (docs/command-line.md). */
enum {
    EXIT_DONE = 0,
    EXIT_USAGE = 1,
    EXIT_INPUT = 2,
    EXIT_OUTPUT = 3,
    EXIT_RESOURCES = 4,
    EXIT_SIGNAL = 130
};

/* The exit status for what a library call returned. by_step is for the codes whose meaning depends
 * on what was being done: a wrong argument is wrong usage while options are checked, but not while
 * a file is read. */
int exit_status_of(int32_t status, int by_step);

enum { ACTION_RENDER = 0, ACTION_HELP, ACTION_VERSION, ACTION_LIST_VIEWS };
enum { VERBOSITY_QUIET = -1, VERBOSITY_NORMAL = 0, VERBOSITY_VERBOSE = 1 };

typedef struct image_size {
    uint32_t width, height; /* 0: not said */
} image_size;

/* A part of the picture: x0, y0, x1, y1, in pixels, or in shares of the picture's sides. */
typedef struct crop_window {
    bool is_given, is_in_shares;
    double sides[4];
} crop_window;

typedef struct shutter_times {
    double open, close; /* frames */
} shutter_times;

typedef struct filter_choice {
    int32_t kind; /* PPM_PIXEL_FILTER_ */
    double width; /* pixels; 0: not said */
} filter_choice;

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
    double aperture;   /* f-number */
    const char *focus; /* metres, or the name of a node */
    shutter_times shutter;
    crop_window crop;
    filter_choice filter;

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
