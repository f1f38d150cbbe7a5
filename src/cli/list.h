/* --list: what is in a file, on standard output. */
#ifndef PPM_CLI_LIST_H
#define PPM_CLI_LIST_H

#include <stdint.h>

#include "ppm/asset.h"
#include "ppm/setup.h"

/* format is LIST_TABLE or LIST_JSON; path is INPUT; setup may be NULL. Returns EXIT_DONE,
 * EXIT_RESOURCES, or EXIT_OUTPUT when standard output does not take the text. */
int list_print(const ppm_asset *asset, const ppm_setup *setup, const char *path, int32_t format);

#endif
