/* Whether a file that is there is a finished picture. */
#ifndef PPMI_IMAGEIO_WHOLE_H
#define PPMI_IMAGEIO_WHOLE_H

#include <stdbool.h>
#include <stdint.h>

/* A regular file of the format that its ending says, whose end was written: the last rows of all
 * parts of an OpenEXR, the last chunk of a PNG, the end mark of a JPEG, all pixels of others. The
 * size is of the whole picture, of which the file may hold a part. Reports nothing. */
bool ppmi_imageio_is_whole(const char *path, uint32_t *out_width, uint32_t *out_height);

#endif
