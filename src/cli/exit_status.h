/* Exit statuses; they are part of the programs' contract (docs/command-line.md). */
#ifndef PPM_CLI_EXIT_STATUS_H
#define PPM_CLI_EXIT_STATUS_H

#include <stdint.h>

enum {
    EXIT_DONE = 0,
    EXIT_USAGE = 1,
    EXIT_INPUT = 2,
    EXIT_OUTPUT = 3,
    EXIT_RESOURCES = 4,
    EXIT_ABOVE = 5, /* ppm-compare: an error is above its --fail-above */
    EXIT_SIGNAL = 130
};

/* The exit status for what a library call returned. by_step is for the codes whose meaning depends
 * on what was being done: a wrong argument is wrong usage while options are checked, but not while
 * a file is read. */
int exit_status_of(int32_t status, int by_step);

#endif
