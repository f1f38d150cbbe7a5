/* OpenEXR files whose headers claim more than there is. */
#ifndef PPMI_IMAGEIO_EXR_CHECK_H
#define PPMI_IMAGEIO_EXR_CHECK_H

#include <stddef.h>

#include "base/context.h"

/* Whether each attribute of the headers lies within the file: OpenEXR takes memory for what one
 * claims, up to 2 GiB, before it reads it. Returns OK, INPUT_INVALID. */
ppm_status ppmi_imageio_exr_check(ppm_context *context, const void *bytes, size_t byte_count,
                                  const char *name);

#endif
