/* All layers of a session as one OpenEXR file. */
#ifndef PPMI_API_OUTPUT_LAYERS_H
#define PPMI_API_OUTPUT_LAYERS_H

#include "api/output_header.h"
#include "ppm/output.h"

/* Whether the options for OpenEXR files are in range. Returns OK, INVALID_ARGUMENT. */
ppm_status ppmi_output_layers_check(ppm_context *context, const ppm_output_options *options);

/* Writes the file, with what header says. Returns as ppm_render_write. */
ppm_status ppmi_output_layers_write(ppm_context *context, const ppm_render *render,
                                    const char *path, const ppm_output_options *options,
                                    ppmi_output_header *header);

#endif
