/* Whole files: read at once, and replaced all at once or not at all. */
#ifndef PPMI_IMAGEIO_FILE_H
#define PPMI_IMAGEIO_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "base/context.h"

/* Reads a regular file. *out_bytes is freed with ppmi_free; never NULL on success.
 * Returns OK, INPUT_NOT_FOUND, INPUT_INVALID (empty, not a file), OUT_OF_MEMORY. */
ppm_status ppmi_imageio_file_read(ppm_context *context, const char *path, const char *name,
                                  void **out_bytes, size_t *out_byte_count);

/* Writes bytes to a new file in the folder of path, flushes it to the disk and renames it to path.
 * A symbolic link is followed, also to where no file is yet; anything at path that is not a regular
 * file, and a file that may not be written, is refused. On failure
 * path is as it was and the new file is gone. Returns OK, OUTPUT_NOT_WRITABLE, OUT_OF_MEMORY. */
ppm_status ppmi_imageio_file_replace(ppm_context *context, const char *path, const void *bytes,
                                     size_t byte_count);

/* The same in steps, for files that are too large to be held in memory. */
typedef struct ppmi_file_replacement ppmi_file_replacement;

/* Makes the new file beside path, empty. *out_replacement ends in finish or cancel. Returns as
 * ppmi_imageio_file_replace. */
ppm_status ppmi_imageio_file_begin(ppm_context *context, const char *path,
                                   ppmi_file_replacement **out_replacement);
/* Writes bytes at an offset of the new file. Returns 0, or the errno of what went wrong; nothing is
 * reported. */
int ppmi_imageio_file_write_at(const ppmi_file_replacement *replacement, const void *bytes,
                               size_t byte_count, uint64_t offset);
/* Where the new file is meanwhile, for writers that know nothing but paths. */
const char *ppmi_imageio_file_temporary(const ppmi_file_replacement *replacement);
/* Flushes the new file and renames it to path; or removes it, and path is as it was. Both free
 * replacement. */
ppm_status ppmi_imageio_file_finish(ppm_context *context, ppmi_file_replacement *replacement);
void ppmi_imageio_file_cancel(ppm_context *context, ppmi_file_replacement *replacement);

/* Whether ppmi_imageio_file_replace could begin: makes and removes an empty file. */
ppm_status ppmi_imageio_file_check(ppm_context *context, const char *path);

#endif
