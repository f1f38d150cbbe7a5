/* --stats: what was rendered and what it cost, as JSON (docs/command-line.md lists the fields). */
#ifndef PPM_CLI_STATS_JSON_H
#define PPM_CLI_STATS_JSON_H

#include "console.h"
#include "ppm/ppm.h"

typedef struct stats_times {
    double total_s;  /* of the program so far */
    double import_s; /* of the file and the environment */
} stats_times;

/* Whether a file could be written at path. Returns EXIT_DONE or EXIT_OUTPUT. */
int stats_json_check(cli_console *console, const char *path);

/* Writes the file beside its name and renames it when complete. Returns EXIT_DONE, EXIT_OUTPUT or
 * EXIT_RESOURCES. */
int stats_json_write(cli_console *console, const char *path, const ppm_scene *scene,
                     const ppm_render *render, const stats_times *times);

#endif
