/* The size that an AVIF or HEIC file claims, before it is decoded. */
#ifndef PPMI_IMAGEIO_HEIF_CHECK_H
#define PPMI_IMAGEIO_HEIF_CHECK_H

#include "base/context.h"

/* OpenImageIO decodes these files when it opens them: too late to look at their size. Returns OK,
 * INPUT_INVALID (no size, or one of 0), INPUT_UNSUPPORTED (more than 2^26 pixels; reported). */
ppm_status ppmi_imageio_heif_check(ppm_context *context, const void *bytes, size_t byte_count,
                                   const char *name);

#endif
