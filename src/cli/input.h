/* INPUT: opened, with what is asked for in it, and brought to the moment of each picture. */
#ifndef PPM_CLI_INPUT_H
#define PPM_CLI_INPUT_H

#include "console.h"
#include "options.h"
#include "pictures.h"
#include "ppm/ppm.h"

typedef struct cli_input {
    ppm_setup *setup; /* owned; NULL: none */
    ppm_asset *asset; /* NULL: not opened */
    ppm_scene *scene; /* NULL: not imported */
    ppm_pose pose;    /* of the scene */
    double seconds;   /* that opening, import and poses took */
} cli_input;

void input_deinit(cli_input *input);

/* Opens the file of options, to be imported at the moment of picture, and looks up the scene,
 * variant and animation that they name. Returns an exit status; what is wrong has been said. */
int input_open(cli_input *input, cli_console *console, ppm_context *context,
               const cli_options *options, const cli_picture *picture);

/* Says what a user may want to know of the file's animations. */
void input_say_animations(const cli_input *input, cli_console *console, const cli_options *options);

/* Brings the scene to the moment of picture; the first time it is imported, with the environment,
 * the sun and the fog that are asked for, after what the setup file says. No render of the scene
 * may be alive. Returns an exit status; the library has said what is wrong. */
int input_set_moment(cli_input *input, cli_console *console, const ppm_color *color,
                     ppm_context *context, const cli_options *options, const cli_picture *picture);

#endif
