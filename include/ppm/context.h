/* The context: log callback, last error and memory of everything made from it.
 *
 * The library has no global state, never prints and never ends the process. Two contexts are
 * independent of each other. */
#ifndef PPM_CONTEXT_H
#define PPM_CONTEXT_H

#include <stddef.h>
#include <stdint.h>

#include "ppm/export.h"
#include "ppm/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PPM_VERSION_MAJOR 0
#define PPM_VERSION_MINOR 1
#define PPM_VERSION_PATCH 0

typedef struct ppm_context ppm_context;

typedef int32_t ppm_log_level;
enum {
    PPM_LOG_ERROR = 1,   /* a call failed; its message */
    PPM_LOG_WARNING = 2, /* something in the input was left out or guessed */
    PPM_LOG_INFO = 3,    /* a choice that the user may want to know */
    PPM_LOG_DEBUG = 4    /* details and timings */
};

/* Receives one message, UTF-8 without a line end. Called on the thread that has the news, one call
 * at a time per context. It must not call back into the same context. */
typedef void (*ppm_log_fn)(void *user, ppm_log_level level, const char *message);

typedef struct ppm_context_desc {
    uint32_t size;  /* sizeof(ppm_context_desc) */
    ppm_log_fn log; /* NULL: messages are dropped */
    void *log_user; /* handed to log */
} ppm_context_desc;

/* Makes a context. desc may be NULL (no log). *out_context is untouched on failure.
 * Returns OK, INVALID_ARGUMENT or OUT_OF_MEMORY. */
PPM_API ppm_status ppm_context_create(const ppm_context_desc *desc, ppm_context **out_context);

/* Frees a context; NULL is fine. Everything made from it must have been destroyed before. */
PPM_API void ppm_context_destroy(ppm_context *context);

/* Copies the message of the latest failure on this context into buffer (at most buffer_size bytes,
 * always ended by a zero). Empty if nothing has failed. Returns the full length without the zero.
 * Any thread; where several threads fail at once, the log callback has all messages. */
PPM_API size_t ppm_context_last_error(ppm_context *context, char *buffer, size_t buffer_size);

/* "0.1.0". Static storage; any thread. */
PPM_API const char *ppm_version(void);

/* A line that names version, Embree, OpenImageIO, OpenColorIO and the instruction set that this
 * build of the library was compiled for. Static storage after the first call; any thread. */
PPM_API const char *ppm_build_info(void);

#ifdef __cplusplus
}
#endif

#endif
