/* Names of files as text. */
#ifndef PPMI_BASE_PATH_H
#define PPMI_BASE_PATH_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a relative path names something below the folder that it starts from: none of its parts
 * goes above that, and it does not end there. Links are not looked at. */
bool ppmi_path_stays_inside(const char *path);

#ifdef __cplusplus
}
#endif

#endif
