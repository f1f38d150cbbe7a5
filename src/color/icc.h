/* ICC profiles of displays: matrix and curve, version 4. */
#ifndef PPMI_COLOR_ICC_H
#define PPMI_COLOR_ICC_H

#include <stddef.h>
#include <stdint.h>

#include "color/display_tag.h"

enum { PPMI_ICC_BYTES_MAX = 1024 };

/* Writes the profile; returns its size, or 0 where no such profile can say what tag does. */
size_t ppmi_icc_write(const ppmi_display_tag *tag, uint8_t out[PPMI_ICC_BYTES_MAX]);

#endif
