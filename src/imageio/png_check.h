/* Is a PNG file whole? Asked before the decoder sees it. */
#ifndef PPMI_IMAGEIO_PNG_CHECK_H
#define PPMI_IMAGEIO_PNG_CHECK_H

#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

/* The chunk that ends every file. */
enum { PPMI_PNG_END_BYTES = 12 };
extern const uint8_t ppmi_imageio_png_end[PPMI_PNG_END_BYTES];

/* bytes begin with PNG's signature. *out_cut_at becomes 0, or where ppmi_imageio_png_end is missing
 * behind whole pixels: viewers show such a file. Returns OK or INPUT_INVALID (the message says what
 * is wrong and at which byte). */
ppm_status ppmi_imageio_png_check(ppm_context *context, const void *bytes, size_t byte_count,
                                  const char *name, size_t *out_cut_at);

#endif
