/* From checked options to a scene and the settings of its render. */
#ifndef PPM_CLI_SETUP_H
#define PPM_CLI_SETUP_H

#include "console.h"
#include "options.h"
#include "ppm/ppm.h"

/* Imports INPUT into scene, and adds the environment and the sun that are asked for. Returns an
 * exit status; the library has said what is wrong. */
int setup_scene(ppm_scene *scene, const cli_options *options);

/* Fills in the settings, with the camera looked up. Returns EXIT_DONE, EXIT_USAGE (no such camera)
 * or EXIT_RESOURCES. */
int setup_render_options(cli_console *console, const ppm_scene *scene, const cli_options *options,
                         ppm_render_options *out_render_options);

#endif
