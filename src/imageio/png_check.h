/* Is a PNG file whole? Asked before the decoder sees it. */
#ifndef PPMI_IMAGEIO_PNG_CHECK_H
#define PPMI_IMAGEIO_PNG_CHECK_H

#include <stddef.h>

#include "base/context.h"

/* bytes begin with PNG's signature. Returns OK or INPUT_INVALID (the message says what is wrong and
 * at which byte). */
ppm_status ppmi_imageio_png_check(ppm_context *context, const void *bytes, size_t byte_count,
                                  const char *name);

#endif
