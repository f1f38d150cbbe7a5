/* Nodes with a surface, by name. */
#ifndef PPM_CLI_NODES_H
#define PPM_CLI_NODES_H

#include "console.h"
#include "ppm/scene.h"

/* Says that what option names (text) is not what was expected, with the nearest name that there
 * is: "--focus: 'Bal' is neither a distance nor a node with a surface; did you mean 'Ball'?".
 * Returns EXIT_USAGE or EXIT_RESOURCES. */
int nodes_complain(cli_console *console, const ppm_scene *scene, const char *option,
                   const char *what_it_is, const char *text);

#endif
