/* Library status to exit status. */
#include "exit_status.h"

#include "ppm/status.h"

int exit_status_of(int32_t status, int by_step)
{
    switch (status) {
    case PPM_STATUS_OK:
        return EXIT_DONE;
    case PPM_STATUS_INPUT_NOT_FOUND:
    case PPM_STATUS_INPUT_INVALID:
    case PPM_STATUS_INPUT_UNSUPPORTED:
        return EXIT_INPUT;
    case PPM_STATUS_OUTPUT_NOT_WRITABLE:
        return EXIT_OUTPUT;
    case PPM_STATUS_OUT_OF_MEMORY:
        return EXIT_RESOURCES;
    default:
        return by_step;
    }
}
