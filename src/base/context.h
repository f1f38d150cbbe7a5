/* What every module needs of a context: reporting, and memory that can be counted. */
#ifndef PPMI_BASE_CONTEXT_H
#define PPMI_BASE_CONTEXT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include "ppm/context.h"

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define PPMI_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define PPMI_PRINTF(format_index, first)
#endif

/* Sends a message to the context's log. Any thread. context may be NULL (dropped). */
void ppmi_log(ppm_context *context, ppm_log_level level, const char *format, ...) PPMI_PRINTF(3, 4);

/* Reports a failure (log at ERROR, last error) and returns status, so that failing is one line:
 * return ppmi_fail(context, PPM_STATUS_INPUT_INVALID, "%s: %s: ...", file, json_path); */
ppm_status ppmi_fail(ppm_context *context, ppm_status status, const char *format, ...)
    PPMI_PRINTF(3, 4);

/* A context for one task among several that run at once: its memory is the parent's, its messages
 * wait. NULL when memory is out. */
ppm_context *ppmi_context_fork(ppm_context *parent);
/* Delivers the messages to the parent, in their order, and destroys the fork. Called for one task
 * after the other, it makes the log the same however the tasks ran. NULL is fine. */
void ppmi_context_join(ppm_context *fork);
/* The same with its errors as warnings: of a task that may fail without harm to the whole. */
void ppmi_context_join_as_warnings(ppm_context *fork);

/* count * element_size bytes, aligned to 64, not initialised. NULL when memory is out (or all
 * blocks of the context together would be more than the machine has), when the product overflows,
 * or for a count of 0. Nothing is reported: the caller knows what it was for. Free with ppmi_free;
 * NULL is fine there. */
void *ppmi_alloc(ppm_context *context, size_t count, size_t element_size);
void *ppmi_alloc_zeroed(ppm_context *context, size_t count, size_t element_size);
void ppmi_free(ppm_context *context, void *memory);

/* A copy of a string; NULL for NULL or when memory is out. */
char *ppmi_string_copy(ppm_context *context, const char *text);

/* Makes the n-th allocation from now on fail, once (1: the next one); 0 switches that off. For
 * tests of the ways out. */
void ppmi_alloc_fail_at(ppm_context *context, size_t n);

/* Number of blocks that are allocated now: 0 at the end of a test without leaks. */
size_t ppmi_alloc_live(const ppm_context *context);

#ifdef __cplusplus
}
#endif

#endif
