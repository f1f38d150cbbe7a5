/* --stats: what was rendered and what it cost, as JSON (docs/command-line.md lists the fields). */
#ifndef PPM_CLI_STATS_JSON_H
#define PPM_CLI_STATS_JSON_H

#include "console.h"
#include "options.h"
#include "outputs.h"
#include "pictures.h"
#include "ppm/ppm.h"

/* One file for all pictures, or one for each if the name has a place for them. */
typedef struct cli_stats {
    const char *pattern; /* NULL: not asked for */
    pattern_use use;
    bool is_list;            /* of several pictures */
    struct json_t *pictures; /* so far, of a list */
    double seconds_begin;    /* of the program, on the clock */
} cli_stats;

typedef struct stats_source {
    const ppm_asset *asset;
    const ppm_setup *setup; /* or NULL */
    const ppm_scene *scene;
    const cli_picture *picture;
    const cli_outputs *outputs;
    const ppm_render *render;
    uint64_t skipped; /* pictures so far */
    double import_s;  /* of the file, the environment and the poses so far */
} stats_source;

/* The strings of options must outlive stats; seconds_begin is when the program began. */
void stats_init(cli_stats *stats, const cli_options *options, double seconds_begin);
void stats_deinit(cli_stats *stats);

/* Whether the name is one, and a file could be written there. Returns EXIT_DONE, EXIT_USAGE,
 * EXIT_OUTPUT or EXIT_RESOURCES. */
int stats_check(const cli_stats *stats, cli_console *console, const cli_picture *first);

/* Takes a rendered picture in, and writes the file: beside its name, to be renamed when complete.
 * Returns EXIT_DONE, EXIT_OUTPUT or EXIT_RESOURCES. */
int stats_add(cli_stats *stats, cli_console *console, const stats_source *source);

#endif
