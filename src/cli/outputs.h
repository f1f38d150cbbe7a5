/* The pictures that are asked for: checked before rendering, refreshed while it runs, written at
 * its end. */
#ifndef PPM_CLI_OUTPUTS_H
#define PPM_CLI_OUTPUTS_H

#include <stdbool.h>
#include <stddef.h>

#include "console.h"
#include "file_pattern.h"
#include "options.h"
#include "pictures.h"
#include "ppm/ppm.h"

typedef struct cli_outputs {
    size_t count;
    char **patterns; /* names as they are asked for */
    char **paths;    /* of the present picture */
    pattern_use use;
    char *command; /* the command line, for the pictures' metadata */
    ppm_output_options options;
    const ppm_color *color;
    uint32_t width, height; /* that are asked for; 0: not said */
    bool is_cropped;
    double seconds_refreshed; /* elapsed at the end of the last refresh; 0: none */
    double refresh_cost_s;    /* of the last refresh */
} cli_outputs;

/* The files of options, or INPUT's name as .exr and .png in the current folder. color and the
 * strings of options must outlive the outputs. Returns EXIT_DONE or EXIT_RESOURCES; outputs_deinit
 * is due in every case. */
int outputs_init(cli_outputs *outputs, const cli_options *options, const ppm_color *color, int argc,
                 char **argv);
void outputs_deinit(cli_outputs *outputs);

/* Whether the names have the places that they need, and no others; says what is wrong, and where a
 * frame's number is put in. Returns EXIT_DONE or EXIT_USAGE. */
int outputs_check_names(const cli_outputs *outputs, cli_console *console);

/* Turns to a picture: fills in the names. Returns EXIT_DONE or EXIT_RESOURCES. */
int outputs_select(cli_outputs *outputs, const cli_picture *picture);

/* Takes over for the metadata what the file says about itself. asset must outlive the writing. */
void outputs_set_origin(cli_outputs *outputs, const ppm_asset *asset);

/* Whether all files of the present picture are there, whole and of the size that is asked for. */
bool outputs_exist(const cli_outputs *outputs);

/* Whether each could be written. The library has said what is wrong. Returns an exit status. */
int outputs_check(const cli_outputs *outputs, ppm_context *context);

/* Writes each; goes on to the next when one fails. Returns an exit status. */
int outputs_write(const cli_outputs *outputs, const ppm_render *render);

/* The same at the end. Where a file fails and no .exr of the picture is written, it is saved beside
 * as one (rescue.h). */
int outputs_finish(const cli_outputs *outputs, cli_console *console, const ppm_render *render);

/* Writes each if it is time to: at growing intervals, and never for more than a twentieth of the
 * time. A failure is reported by the library, but is not final: the disk may have room later. */
void outputs_refresh(cli_outputs *outputs, const ppm_render *render, double elapsed);

#endif
