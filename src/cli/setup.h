/* From checked options to a scene and the settings of its render. */
#ifndef PPM_CLI_SETUP_H
#define PPM_CLI_SETUP_H

#include "console.h"
#include "options.h"
#include "ppm/ppm.h"

/* Imports INPUT into scene, and adds the environment and the sun that are asked for. Returns an
 * exit status; the library has said what is wrong. */
int setup_scene(ppm_scene *scene, const cli_options *options);

/* Fills in the settings, with camera and focus looked up. A scene without a camera gets one if
 * something in it is to be in focus. Returns an exit status; what is wrong has been said. */
int setup_render_options(cli_console *console, ppm_scene *scene, const cli_options *options,
                         ppm_render_options *out_render_options);

#endif
