/* Whole files: read at once, and replaced all at once or not at all. */
#ifndef PPMI_IMAGEIO_FILE_H
#define PPMI_IMAGEIO_FILE_H

#include <stddef.h>

#include "base/context.h"

/* Reads a regular file. *out_bytes is freed with ppmi_free; never NULL on success.
 * Returns OK, INPUT_NOT_FOUND, INPUT_INVALID (empty, not a file), OUT_OF_MEMORY. */
ppm_status ppmi_imageio_file_read(ppm_context *context, const char *path, const char *name,
                                  void **out_bytes, size_t *out_byte_count);

/* Writes bytes to a new file in the folder of path, flushes it to the disk and renames it to path.
 * A symbolic link is followed; anything at path that is not a regular file is refused. On failure
 * path is as it was and the new file is gone. Returns OK, OUTPUT_NOT_WRITABLE, OUT_OF_MEMORY. */
ppm_status ppmi_imageio_file_replace(ppm_context *context, const char *path, const void *bytes,
                                     size_t byte_count);

/* Whether ppmi_imageio_file_replace could begin: makes and removes an empty file. */
ppm_status ppmi_imageio_file_check(ppm_context *context, const char *path);

#endif
