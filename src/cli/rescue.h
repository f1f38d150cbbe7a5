/* A picture that could not be written as it was asked for must not be lost with the program. */
#ifndef PPM_CLI_RESCUE_H
#define PPM_CLI_RESCUE_H

#include <stdbool.h>

#include "console.h"
#include "ppm/ppm.h"

bool rescue_is_exr(const char *path);

/* Saves the picture as OpenEXR beside path, a file that could not be written: under its name with
 * .exr in place of its ending (.picture.exr if it is .exr), or behind it where that file exists. In
 * half precision, and without layers, where there is no room for more; in the current folder, or in
 * that of temporary files, where it cannot be beside. Says where it is, or that it is lost. */
void rescue_picture(cli_console *console, const ppm_render *render, const ppm_color *color,
                    const char *path, const ppm_output_options *options);

#endif
