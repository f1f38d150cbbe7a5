/* Names of files with a place for the number of the frame and one for the camera's name. */
#ifndef PPM_CLI_FILE_PATTERN_H
#define PPM_CLI_FILE_PATTERN_H

#include <stdbool.h>
#include <stdint.h>

/* In the last part of a path, %d, %04d or #### stands for the frame, %c for the camera, %% for a
 * percent sign and %# for a number sign. Folders are taken as they are. */

/* What a name is used for. */
typedef struct pattern_use {
    bool has_frame;   /* there is a frame's number to fill in */
    bool needs_frame; /* one is put before the ending where the name has no place for it */
    bool has_camera;  /* there is a camera's name to fill in; it is put in where none is */
} pattern_use;

/* Whether a name can be filled in; NULL when it can, otherwise what is wrong with it. */
const char *pattern_fault(const char *path, const pattern_use *use);

/* Whether the name has a place for the frame. */
bool pattern_has_frame(const char *path);

/* Whether it has a place for the frame or the camera. */
bool pattern_has_place(const char *path);

/* The path with all places filled in; camera may be NULL where use has none. Without any use the
 * path itself. The caller frees it; NULL when memory is out. path has no fault. */
char *pattern_fill(const char *path, const pattern_use *use, int32_t frame, const char *camera);

/* The pattern whose name is path as it stands. The caller frees it; NULL when memory is out. */
char *pattern_escape(const char *path, const pattern_use *use);

/* A name made safe for a file's: letters, digits, '-', '_', a '.' that is not at the beginning, and
 * what is not ASCII stay; all else becomes '_'. At most 80 bytes. The caller frees it; NULL when
 * memory is out. */
char *pattern_safe_name(const char *name);

#endif
