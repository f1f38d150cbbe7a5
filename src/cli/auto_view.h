/* --view auto: the view that the program which wrote INPUT shows by default. */
#ifndef PPM_CLI_AUTO_VIEW_H
#define PPM_CLI_AUTO_VIEW_H

#include "console.h"
#include "options.h"
#include "ppm/ppm.h"

/* The default view of the Blender that is named in asset.generator: "Filmic" up to 3.x, "AgX" from
 * 4.0; NULL for what Blender's exporter did not write. */
const char *auto_view_of_generator(const char *generator);

/* The view to use: the above where the configuration has it for the display and can build it; else
 * NULL, its default. Says which, and why. */
const char *auto_view_choose(cli_console *console, ppm_context *context, const ppm_color *color,
                             const cli_options *options, const char *generator);

#endif
