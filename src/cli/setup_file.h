/* The setup file of INPUT (docs/setup.md): found, opened, and its render options stored before
 * those of the command line. */
#ifndef PPM_CLI_SETUP_FILE_H
#define PPM_CLI_SETUP_FILE_H

#include "console.h"
#include "option_table.h"
#include "options.h"
#include "ppm/ppm.h"

/* Opens the file of --setup, or the one beside INPUT; *out_setup is NULL without either. Returns
 * an exit status; what is wrong has been said. */
int setup_file_open(cli_console *console, ppm_context *context, const cli_options *options,
                    ppm_setup **out_setup);

/* Stores the render options of a setup by the table of the command line, but for those in whose
 * place words, the command line alone, has others. Returns an exit status; what is wrong has been
 * said. */
int setup_file_store(const option_table *table, const ppm_setup *setup, const cli_options *words,
                     cli_options *options);

/* What of the setup is applied: what the command line says itself is left out. */
uint32_t setup_file_parts(const cli_options *options);

bool setup_file_has_cameras(const ppm_setup *setup);

#endif
