/* All pictures of a run, one after the other. */
#ifndef PPM_CLI_SEQUENCE_H
#define PPM_CLI_SEQUENCE_H

#include "console.h"
#include "input.h"
#include "options.h"
#include "outputs.h"
#include "pictures.h"
#include "ppm/ppm.h"
#include "stats_json.h"

typedef struct cli_sequence {
    cli_console *console;
    const cli_options *options;
    ppm_context *context;
    const ppm_color *color;
    cli_input *input;
    cli_outputs *outputs;
    cli_pictures *pictures;
    cli_stats *stats;
} cli_sequence;

/* Checks, before anything is read, that the first picture could be written. Returns an exit status;
 * what is wrong has been said. */
int sequence_check(const cli_sequence *sequence);

/* Opens INPUT, renders and writes what is not to be skipped. Returns an exit status: EXIT_SIGNAL
 * when a signal came before all pictures of a sequence were written. */
int sequence_run(const cli_sequence *sequence);

#endif
