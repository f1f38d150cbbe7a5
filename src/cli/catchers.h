/* --catcher: which things are those of a photograph. */
#ifndef PPM_CLI_CATCHERS_H
#define PPM_CLI_CATCHERS_H

#include "console.h"
#include "options.h"
#include "ppm/ppm.h"

/* Makes all nodes of the names that are given catchers, and says so of those of the file and of the
 * setup. Returns EXIT_DONE, EXIT_USAGE (no such node; said on the console) or EXIT_RESOURCES. */
int catchers_choose(cli_console *console, ppm_scene *scene, const cli_options *options);

/* What the session shows of catchers: *out_values, *out_count of them, are to be freed. Returns an
 * exit status; the library has said what is wrong. */
int catchers_read(const ppm_render *render, float **out_values, size_t *out_count);

#endif
