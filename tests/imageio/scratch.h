/* A folder of its own for a test's files, and small files in it. */
#ifndef PPM_TESTS_IMAGEIO_SCRATCH_H
#define PPM_TESTS_IMAGEIO_SCRATCH_H

#include <stddef.h>

/* Makes a new empty folder; the path is valid until scratch_remove. One at a time. */
const char *scratch_create(void);
/* The path of name in the folder. Valid until the eighth call after this one. */
const char *scratch_path(const char *name);
void scratch_write(const char *name, const void *bytes, size_t byte_count);
void scratch_write_text(const char *name, const char *text);
/* The number of files in the folder, hidden ones too. */
int scratch_count(void);
/* Removes the folder and its files. */
void scratch_remove(void);

#endif
