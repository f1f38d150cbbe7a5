/* From checked options to a scene and the settings of its render. */
#ifndef PPM_CLI_SETUP_H
#define PPM_CLI_SETUP_H

#include "console.h"
#include "options.h"
#include "pictures.h"
#include "ppm/ppm.h"

/* Adds the environment, the sun and the fog that are asked for to an imported scene. */
ppm_status setup_surroundings(ppm_scene *scene, const cli_options *options);

/* Frames a scene without a camera as it is now. Returns an exit status; what is wrong has been
 * said.
 */
int setup_missing_camera(cli_console *console, ppm_scene *scene, const cli_options *options);

/* Fills in the settings of a picture, with camera and focus looked up. A scene without a camera
 * gets one if something in it is to be in focus. Returns an exit status; what is wrong has been
 * said. */
int setup_render_options(cli_console *console, ppm_scene *scene, const cli_options *options,
                         const cli_picture *picture, ppm_render_options *out_render_options);

#endif
