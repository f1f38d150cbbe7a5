/* Coding-independent code points in a PNG file. */
#ifndef PPMI_IMAGEIO_PNG_CICP_H
#define PPMI_IMAGEIO_PNG_CICP_H

#include <stddef.h>
#include <stdint.h>

enum { PPMI_PNG_CICP_BYTES = 16 };

/* Copies a whole PNG file with a cICP chunk behind its header (W3C PNG, third edition, 11.3.2.6):
 * primaries, transfer, matrix, full range (ITU-T H.273). out has room for byte_count +
 * PPMI_PNG_CICP_BYTES; that many are written. */
void ppmi_png_add_cicp(const uint8_t *png, size_t byte_count, const uint8_t cicp[4], uint8_t *out);

#endif
