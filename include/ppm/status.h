/* Status codes: every function of the API that can fail returns one. */
#ifndef PPM_STATUS_H
#define PPM_STATUS_H

#include <stdint.h>

#include "ppm/export.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A status is one of the PPM_STATUS_ constants below; 0 is success. */
typedef int32_t ppm_status;

/* name, number, default text. Numbers are final: they are part of the binary interface. */
#define PPM_STATUS_LIST(X)                                                                         \
    X(OK, 0, "success")                                                                            \
    X(INVALID_ARGUMENT, 1, "an argument is not usable")                                            \
    X(WRONG_STATE, 2, "the object is not in a state that allows this call")                        \
    X(OUT_OF_MEMORY, 3, "out of memory")                                                           \
    X(INPUT_NOT_FOUND, 10, "an input file cannot be opened")                                       \
    X(INPUT_INVALID, 11, "an input file is broken")                                                \
    X(INPUT_UNSUPPORTED, 12, "an input file needs something that is not supported")                \
    X(OUTPUT_NOT_WRITABLE, 20, "an output file cannot be written")                                 \
    X(NOT_FOUND, 30, "no object of that name")                                                     \
    X(CANCELLED, 40, "cancelled")                                                                  \
    X(INTERNAL, 50, "internal error")

enum {
#define PPM_STATUS_ENUM(name, number, text) PPM_STATUS_##name = number,
    PPM_STATUS_LIST(PPM_STATUS_ENUM)
#undef PPM_STATUS_ENUM
};

/* The name of a status ("OUT_OF_MEMORY"), or "UNKNOWN". Static storage; any thread. */
PPM_API const char *ppm_status_name(ppm_status status);

/* One plain sentence for a status. Static storage; any thread. The message that the failing call
 * gave to the context's log callback says more: which file, which place, which value. */
PPM_API const char *ppm_status_text(ppm_status status);

#ifdef __cplusplus
}
#endif

#endif
