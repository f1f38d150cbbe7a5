/* Runs ppm-render as a user would: as a process of its own, in a folder of its own. */
#ifndef TESTS_CLI_PROGRAM_H
#define TESTS_CLI_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

/* A program that was started; its standard error can be followed while it runs. */
typedef struct test_process {
    pid_t pid;
    int err_fd;
    char err[65536]; /* what has come so far, ended by a zero */
    size_t err_length;
} test_process;

/* What a program left behind. */
typedef struct outcome {
    int status; /* exit status; 1000 + number when a signal killed it */
    char out[65536];
    char err[65536];
} outcome;

/* cmocka group fixtures: makes a new folder with the scene tiny.gltf in it and goes there; goes
 * back and removes it. */
int folder_setup(void **state);
int folder_teardown(void **state);

/* Runs "ppm-render ARGUMENTS" by the shell, so that quotes work, to its end. */
outcome run_program(const char *arguments);

/* Starts it in the background; before is shell text to put in front. */
void start_program(test_process *process, const char *arguments);
void start_wrapped_program(test_process *process, const char *before, const char *arguments);
/* Waits until standard error contains text; fails the test when the program ends before. */
void wait_for_text(test_process *process, const char *text);
/* Whether it has ended by itself, without waiting. */
bool has_ended(const test_process *process);
/* Waits for the end; returns the exit status as in outcome. err is complete then. */
int wait_for_end(test_process *process);

/* Asserts that text contains part, showing both if not. */
void assert_contains(const char *text, const char *part);

#endif
